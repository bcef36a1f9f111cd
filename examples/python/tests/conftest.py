"""Keeps NumPy to the C library's sines: with AVX-512 it has its own, so these are disabled before it is imported.

Sets how many examples Hypothesis tries: 200, the same in each run, or 10,000 random ones with ``--hypothesis-profile=long``.
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
