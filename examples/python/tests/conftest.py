"""The reference's sines: on a CPU with AVX-512 NumPy would take some of its own, so it is told not to before it is imported."""

import os
from pathlib import Path

cpu = Path("/proc/cpuinfo")
if cpu.exists() and "avx512f" in cpu.read_text():
    os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"
