"""Compares NumPy's sines and cosines with those of the C library, on a million arguments. `Host` calls the C library, so
it has Gymnasium's bits as long as they are equal. Fails if any result differs.

    pip install -r tests/data/requirements.txt
    python tests/data/canary.py

On a CPU with AVX-512 NumPy uses its own sines, so this script disables them.
"""

import os
from pathlib import Path

if "avx512f" in Path("/proc/cpuinfo").read_text():
    os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"

import math
import sys

import numpy as np

x = np.random.default_rng(0).uniform(-30.0, 30.0, 1_000_000)
for name in ["sin", "cos"]:
    ours = np.fromiter(map(getattr(math, name), x.tolist()), float, len(x))
    # Gymnasium passes single numbers. Whole arrays can take other code.
    single = np.fromiter(map(getattr(np, name), x), float, len(x))
    differ = np.count_nonzero(single.view("<u8") != ours.view("<u8"))
    print(f"{differ} of {len(x)} results of np.{name} differ from the C library's")
    if differ:
        sys.exit(f"NumPy {np.__version__} no longer has the C library's {name}, so `Host` no longer has Gymnasium's bits")
