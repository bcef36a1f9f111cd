"""The reference's sines: on a CPU with AVX-512 NumPy would take some of its own, so it is told not to before it is imported.

And how many examples Hypothesis tries: a few, the same with each run, or many with ``--hypothesis-profile=long``.
"""

import os
from pathlib import Path

from hypothesis import settings

cpu = Path("/proc/cpuinfo")
if cpu.exists() and "avx512f" in cpu.read_text():
    os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"

settings.register_profile("short", max_examples=200, deadline=None, derandomize=True)
settings.register_profile("long", max_examples=10_000, deadline=None)
settings.load_profile("short")
