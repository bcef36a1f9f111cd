"""Makes NumPy use the C library's sines, as ours does, and not its own for AVX-512.

Hypothesis tries the same 200 examples in each run, or with ``--hypothesis-profile=long`` 10,000
random ones.
"""

import os
from pathlib import Path

from hypothesis import settings

cpu = Path("/proc/cpuinfo")
if cpu.exists() and "avx512f" in cpu.read_text():
    features = "AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL X86_V4 AVX512_SPR"
    os.environ["NPY_DISABLE_CPU_FEATURES"] = features  # read by the import

settings.register_profile("short", max_examples=200, deadline=None, derandomize=True)
settings.register_profile("long", max_examples=10_000, deadline=None)
settings.load_profile("short")
