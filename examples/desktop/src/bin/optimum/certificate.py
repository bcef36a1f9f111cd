"""Finds the coefficients of W in bound.rs by a linear program: the most progress between hanging at rest and the energy
of goal states, so that no step from sampled states makes more than 1. bound.rs proves slightly less for all states.

    pip install numpy==2.4.6 scipy==1.17.1
    python certificate.py
"""

import numpy as np
from scipy.optimize import linprog

GOAL, MOST = 24.5, 27.5
rng = np.random.default_rng(0)


def derivative(y, torque):
    alpha, beta, v, w = y
    sin2, cos2 = np.sin(beta - alpha), np.cos(beta - alpha)
    force1 = 0.5 * sin2 * w * w - 14.7 * np.sin(alpha) - torque
    force2 = torque - 4.9 * np.sin(beta) - 0.5 * sin2 * v * v
    determinant = 2.5625 + 0.25 * sin2**2
    dv = (1.25 * force1 - 0.5 * cos2 * force2) / determinant
    dw = (2.25 * force2 - 0.5 * cos2 * force1) / determinant
    return np.array([v, w, dv, dw])


def step(y, torque):
    k1 = derivative(y, torque)
    k2 = derivative(y + 0.1 * k1, torque)
    k3 = derivative(y + 0.1 * k2, torque)
    k4 = derivative(y + 0.2 * k3, torque)
    return y + 0.2 / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def potential(alpha, beta):
    return 14.7 * (1 - np.cos(alpha)) + 4.9 * (1 - np.cos(beta))


def kinetic(alpha, beta, v, w):
    return 1.125 * v * v + 0.625 * w * w + 0.5 * np.cos(beta - alpha) * v * w


def features(y):
    """The functions of which W is a sum."""
    alpha, beta, v, w = y
    r = np.sqrt(kinetic(*y) + potential(alpha, beta) + 0.3)
    sin1, sin_sum, sin2 = np.sin(alpha), np.sin(beta), np.sin(beta - alpha)
    products = [sin2 * (w - v), sin1 * v, sin_sum * w, sin1 * w, sin_sum * v]
    return np.array([r, r**2, r**3, r**4, 1 / r] + [p / d for p in products for d in (r, r**2, 1)])


def sample(energy):
    """A state for each energy, in any phase."""
    states = np.empty((4, 0))
    while states.shape[1] < len(energy):
        e = rng.choice(energy, len(energy))
        reach = np.sqrt(e) * 1.1 / np.sqrt([[14.7 / 2], [4.9 / 2]])
        alpha, beta = rng.uniform(-1, 1, (2, len(e))) * np.minimum(np.pi, reach)
        turn = rng.uniform(0, 2 * np.pi, len(e))
        missing = e - potential(alpha, beta)
        v, w = np.cos(turn), np.sin(turn)
        scale = np.sqrt(np.maximum(missing, 0) / kinetic(alpha, beta, v, w))
        states = np.hstack([states, np.array([alpha, beta, v * scale, w * scale])[:, missing > 0]])
    return states[:, : len(energy)]


def main():
    below = sample(rng.uniform(0, GOAL**0.5, 150_000) ** 2 + 1e-3)
    gains = np.hstack([features(step(below, torque)) - features(below) for torque in (-1, 1, 0)]).T
    scale = np.abs(gains).max(0)
    gains /= scale
    goals = features(sample(rng.uniform(GOAL, MOST, 10_000))).T / scale
    hanging = features(np.zeros((4, 1))).T / scale
    # The variables are the coefficients and W of the nearest goal state. Constraints join as they are violated.
    active = rng.choice(len(gains), 4000, replace=False)
    while True:
        steps = np.column_stack([gains[active], np.zeros(len(active))])
        rows = np.vstack([steps, np.column_stack([-goals, np.ones(len(goals))])])
        limits = np.concatenate([np.ones(len(active)), np.zeros(len(goals))])
        found = linprog(np.append(hanging[0], -1), rows, limits, bounds=[(-300, 300)] * len(scale) + [(None, None)])
        excess = gains @ found.x[:-1] - 1
        print(f"{-found.fun:.2f} steps, and a step of at most {1 + excess.max():.3f}")
        if excess.max() < 1e-6:
            break
        worst = np.argsort(-excess)[:4000]
        active = np.union1d(active, worst[excess[worst] > 1e-6])
    w = found.x[:-1] / scale
    print(f"LEAST {found.x[-1]:.3f}")
    print("RADIAL", [float(f"{x:.5g}") for x in w[:5]])
    print("PRODUCTS", [[float(f"{x:.5g}") for x in row] for row in w[5:].reshape(5, 3)])


main()
