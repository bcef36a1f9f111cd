"""Makes NumPy use the C library's sines, as ours does. NumPy may have its own for AVX-512, which this disables before the import.

Sets how many examples Hypothesis tries: the same 200 in each run, or 10,000 random ones with ``--hypothesis-profile=long``.
"""

import os
from pathlib import Path

from hypothesis import settings

cpu = Path("/proc/cpuinfo")
if cpu.exists() and "avx512f" in cpu.read_text():
    os.environ["NPY_DISABLE_CPU_FEATURES"] = (
        "AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL X86_V4 AVX512_SPR"
    )

settings.register_profile("short", max_examples=200, deadline=None, derandomize=True)
settings.register_profile("long", max_examples=10_000, deadline=None)
settings.load_profile("short")
