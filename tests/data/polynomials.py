"""Prints the coefficients of src/arithmetic/fast.rs, as bits of f32, and the error of each polynomial.

    pip install numpy==2.4.6 scipy
    python tests/data/polynomials.py

Minimax over |r| <= pi/4 by linear programming. Each coefficient is rounded to f32 in turn, the one of the
lowest power first, and the rest are fitted again to make up for it.
"""

import numpy as np
from scipy.optimize import linprog

R = np.linspace(1e-4, np.pi / 4 + 1e-6, 3000)


def fit(target, powers):
    coefficients = []
    for i in range(len(powers)):
        basis = np.stack([R**power for power in powers[i:]], axis=1)
        # The largest error is the last unknown, counted in 1e-7 so that all are of one size.
        bound = np.full((len(R), 1), 1e-7)
        constraints = np.block([[basis, -bound], [-basis, -bound]]) * 1e6
        limits = np.concatenate([target, -target]) * 1e6
        cost = [0.0] * basis.shape[1] + [1.0]
        tolerances = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
        fitted = linprog(cost, constraints, limits, bounds=(None, None), method="highs", options=tolerances)
        coefficients.append(np.float32(fitted.x[0]))
        target = target - float(coefficients[-1]) * basis[:, 0]
    return coefficients, np.abs(target).max()


for name, target, powers in [("S", np.sin(R) - R, (3, 5, 7)), ("C", np.cos(R) - 1, (2, 4, 6))]:
    coefficients, error = fit(target, powers)
    print(name, *(f"0x{c.view(np.uint32):08x}" for c in coefficients), f"within {error:.1e}")
