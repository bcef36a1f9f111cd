"""Draws initial states, and then parameters, by NumPy: writes draws.csv to its folder.

A row is a reset: of an acrobot with a seed, or of one of three in a batch with seed 42. Mass 2 is
uniform, inertia 1 log-uniform, gravity normal.
"""

import csv
from pathlib import Path

import numpy as np

COLUMNS = "seed child mass2 inertia1 gravity theta1 theta2 dtheta1 dtheta2"


def normal(rng, mean, std, low, high):
    """By rejection: a uniform draw is accepted by the density."""
    low, high = max(low, mean - 8 * std), min(high, mean + 8 * std)
    while True:
        drawn = rng.uniform(low, high)
        if rng.uniform() < np.exp(-0.5 * ((drawn - mean) / std) ** 2):
            return drawn


def row(rng):
    state = rng.uniform(-0.1, 0.1, 4)
    single = lambda *numbers: np.float32(numbers).astype(float)
    mass2 = rng.uniform(*single(0.8, 1.2))
    inertia1 = np.exp(rng.uniform(*np.log(single(0.5, 2.0))))
    gravity = normal(rng, *single(9.8, 0.1, 9.5, 10.1))
    return [str(np.float32(x)) for x in (mass2, inertia1, gravity, *state)]


with (Path(__file__).parent / "draws.csv").open("w", newline="") as file:
    rows = csv.writer(file, lineterminator="\n")
    rows.writerow(COLUMNS.split())
    for seed in range(42, 52):
        rows.writerow([seed, "", *row(np.random.default_rng(seed))])
    for child, seed in enumerate(np.random.SeedSequence(42).spawn(3)):
        rows.writerow([42, child, *row(np.random.default_rng(seed))])
