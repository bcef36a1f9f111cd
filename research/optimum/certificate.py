"""Finds P, the function of bound.rs, by a linear program, and writes it to certificate.rs.

    pip install numpy==2.4.6 scipy==1.17.1
    python certificate.py    # ten minutes

A linear program finds the coefficients with the most progress between the initial states and the
target, so that no step from sampled states makes more than 1. Where hill climbing finds states with
longer steps, they join the sample, until none is longer than 1.01.
"""

import itertools
import pathlib
import subprocess

import numpy as np
from scipy.optimize import linprog

FILE = pathlib.Path(__file__).with_name("src") / "certificate.rs"
MOST, UNIT = 30.0, 1.02
# The target of the linear program is larger, by so much in height, m, and in energy, J, so that
# boxes need not be small there.
NEAR = 0.05, 0.5
# On the sum of the magnitudes of the coefficients: smaller ones need fewer boxes.
PENALTY = 2e-4
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


def is_target(y, near=(0, 0)):
    height, energy = -np.cos(y[0]) - np.cos(y[1]), kinetic(*y) + potential(*y[:2])
    return (height > 1 - near[0]) | (energy > MOST - near[1])


def features(y):
    """The functions of which P is a sum, a row each, in the order of certificate.rs."""
    alpha, beta, v, w = y
    r = np.sqrt(kinetic(*y) + potential(alpha, beta) + 0.3)
    x = [np.sin(alpha), np.sin(beta), v, w]
    cosines = [np.ones_like(r), np.cos(alpha), np.cos(beta), np.cos(alpha) * np.cos(beta)]
    products = lambda n: itertools.combinations_with_replacement(x, n)
    pairs, fours = ([np.prod(xs, 0) for xs in products(n)] for n in (2, 4))
    quadratic = [pair * cosine / r**n for n in range(3) for cosine in cosines for pair in pairs]
    quartic = [four / r ** (n + 1) for n in range(3) for four in fours]
    return np.array([r, r**2, r**3, r**4, 1 / r, *quadratic, *quartic])


def progress(coefficients, y):
    parts = np.array_split(y, y.shape[1] // 20_000 + 1, axis=1)
    return np.concatenate([coefficients @ features(part) for part in parts])


def excess(coefficients, at_target, y, torque):
    """How far each state is from the statement: more than 0 refutes it."""
    after = step(y, torque)
    before, change = progress(coefficients, y), progress(coefficients, after)
    late = at_target - 1 - before
    long = np.where(is_target(after), -np.inf, change - before - 1)
    either = np.where(is_target(after, NEAR), late, np.minimum(late, long))
    return np.where(is_target(y), -np.inf, either)


def sample(count):
    """States outside of the target: of low and of high energy, in any phase."""
    states = np.empty((4, 0))
    while states.shape[1] < count:
        energy = MOST * rng.uniform(0.005, 1, count) ** rng.choice([0.5, 2], count)
        reach = np.sqrt(energy) * 1.1 / np.sqrt([[14.7 / 2], [4.9 / 2]])
        alpha, beta = rng.uniform(-1, 1, (2, count)) * np.minimum(np.pi, reach)
        turn = rng.uniform(0, 2 * np.pi, count)
        missing = energy - potential(alpha, beta)
        v, w = np.cos(turn), np.sin(turn)
        scale = np.sqrt(np.maximum(missing, 0) / kinetic(alpha, beta, v, w))
        y = np.array([alpha, beta, v * scale, w * scale])[:, missing > 0]
        states = np.hstack([states, y[:, ~is_target(y)]])
    return states[:, :count]


def worst(excess, y, cell, count):
    """The states of most excess, one in each cell."""
    order = np.argsort(-excess)
    cells = np.round(y[:, order] / (cell * np.array([[1], [1], [3], [3]])))
    _, first = np.unique(cells, axis=1, return_index=True)
    return order[np.sort(first)[:count]]


def climb(found, y, torque):
    """The worst states of a sample, and their excess, after random steps uphill."""
    best = excess(*found, y, torque)
    chosen = worst(best, y, 0.15, 1500)
    y, best = y[:, chosen], best[chosen]
    for size in 0.1 * 0.85 ** np.arange(25):
        change = rng.normal(0, size, y.shape) * np.array([[1], [1], [2.5], [2.5]])
        near = y + change * rng.choice([0, 1, 1], y.shape)
        value = excess(*found, near, torque)
        y, best = np.where(value > best, near, y), np.maximum(value, best)
    return y, best


def rows(y, torque, scale):
    """Inequalities: each row times (coefficients, P of the target) is at most 1."""
    after = step(y, torque)
    before, change = -features(y) / scale, features(after) / scale
    steps = np.vstack([change + before, np.zeros(len(before[0]))])[:, ~is_target(after)]
    arrivals = np.vstack([before, np.ones(len(before[0]))])[:, is_target(after, NEAR)]
    return np.hstack([steps, arrivals]).T


def find(initial):
    y = sample(20_000)
    scale = np.abs(features(step(y, 1.0)) - features(y)).max(1, keepdims=True)
    start = (features(initial) / scale).mean(1)
    table = np.vstack([rows(sample(3000), torque, scale) for torque in (-1, 1)])
    while True:
        # Each coefficient is the difference of two that are not negative, for the penalty.
        goal = np.concatenate([start + PENALTY, PENALTY - start, [-1]])
        split = np.hstack([table[:, :-1], -table])
        split[:, -1] = table[:, -1]
        bounds = [(0, None)] * (len(goal) - 1) + [(None, None)]
        x = linprog(goal, split, np.ones(len(table)), bounds=bounds).x
        x, at_target = x[: len(start)] - x[len(start) : -1], x[-1]
        found = x / scale[:, 0], at_target
        climbs = [(torque, *climb(found, sample(200_000), torque)) for torque in (-1, 0, 1)]
        longest = max(values.max() for _, _, values in climbs)
        print(f"{at_target - start @ x:.3f} steps, with {len(table)} inequalities", end="; ")
        print(f"the longest found is {1 + longest:.3f}", flush=True)
        if longest < 0.01:
            return found
        for torque, y, values in climbs:
            y, values = y[:, values > 0.005], values[values > 0.005]
            table = np.vstack([table, rows(y[:, worst(values, y, 0.05, 1500)], torque, scale)])


def write(coefficients, at_target):
    numbers = iter(f"{x:.6g}" if "." in f"{x:.6g}" else f"{x:.6g}.0" for x in coefficients)

    def array(length):
        return f"[f64; {length}] = [{', '.join(itertools.islice(numbers, length))}]"

    FILE.write_text(f"""//! The function P of bound.rs, written by certificate.py.

/// P of the target.
pub const AT_TARGET: f64 = {at_target:.6g};
/// The largest increase of P by a step, with a margin: a proof of less needs more boxes.
pub const UNIT: f64 = {UNIT};
/// The factors of r, r², r³, r⁴ and 1 / r.
pub const RADIAL: {array(5)};
/// The factors of the ten products of two, for three powers of 1 / r and four cosines each.
pub const QUADRATIC: {array(120)};
/// The factors of the 35 products of four, for each power of 1 / r.
pub const QUARTIC: {array(105)};
""")
    subprocess.run(["rustfmt", FILE], check=True)


theta1, theta2, *velocities = rng.uniform(-0.1, 0.1, (4, 1000))
write(*find(np.array([theta1, theta1 + theta2, velocities[0], sum(velocities)])))
