"""Prints the constants of polynomial.rs and table.rs in src/math/sines, as bits of f32, and the
error of each polynomial. Fails if the source has other constants.

    pip install -r tests/data/requirements.txt
    python tests/data/polynomials.py

Minimax by linear programming. Each coefficient is rounded to f32 in turn, the one of the lowest
power first, and the remaining ones are fitted again to compensate.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.optimize import linprog

SOURCES = Path(__file__).parents[2] / "src/math/sines"


def fit(r, target, powers):
    coefficients = []
    for i in range(len(powers)):
        basis = np.stack([r**power for power in powers[i:]], axis=1)
        # The largest error is the last unknown, in units of 1e-7 so that all unknowns have a
        # similar size.
        bound = np.full((len(r), 1), 1e-7)
        constraints = np.block([[basis, -bound], [-basis, -bound]]) * 1e6
        limits = np.concatenate([target, -target]) * 1e6
        cost = [0.0] * basis.shape[1] + [1.0]
        tolerances = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
        fitted = linprog(
            cost, constraints, limits, bounds=(None, None), method="highs", options=tolerances
        )
        coefficients.append(np.float32(fitted.x[0]))
        target = target - float(coefficients[-1]) * basis[:, 0]
    return coefficients, np.abs(target).max()


def bits(values):
    return [f"0x{np.float32(value).view(np.uint32):08x}" for value in values]


def check(name, what, constants, error=""):
    print(name, what, *constants, error)
    source = (SOURCES / f"{name}.rs").read_text().replace("_", "")
    if missing := [constant for constant in constants if constant not in source]:
        sys.exit(f"src/math/sines/{name}.rs has no {', '.join(missing)}")


for name, end, sin_powers, cos_powers in [
    ("polynomial", np.pi / 4, (3, 5, 7), (2, 4, 6)),
    ("table", np.pi / 32, (3,), (2,)),
]:
    r = np.linspace(1e-4, end + 1e-6, 3000)
    for function, target, powers in [
        ("S", np.sin(r) - r, sin_powers),
        ("C", np.cos(r) - 1, cos_powers),
    ]:
        coefficients, error = fit(r, target, powers)
        check(name, function, bits(coefficients), f"within {error:.1e}")
check("table", "sines", bits(np.sin(np.arange(9) * np.pi / 16)))
