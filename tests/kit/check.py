"""Compares a port's steps with Gymnasium's. docs/ports.md describes both files.

    python3 check.py acrobot-kit.jsonl answers.jsonl [TOLERANCE]

The tolerance is the largest difference of an angle in rad or a velocity in rad/s: 1e-9, or 1e-3 for
a port in single precision.
"""

import json
import math
import sys
from itertools import zip_longest
from statistics import median

NAMES = ["theta1", "theta2", "dtheta1", "dtheta2"]


def number(x):
    return float.fromhex(x) if isinstance(x, str) else float(x)


def turned(angle):
    """The same angle in [-pi, pi]: at this edge a rounding can add a turn."""
    return math.remainder(angle, 2 * math.pi)


def difference(got, expected):
    """How far each number is from Gymnasium's. An angle must be wrapped, too."""
    angles = [
        abs(turned(a - b)) if abs(a) < math.pi + 1e-3 else abs(a - b)
        for a, b in zip(got[:2], expected[:2])
    ]
    distances = [*angles, *(abs(a - b) for a, b in zip(got[2:], expected[2:]))]
    return [math.inf if math.isnan(distance) else distance for distance in distances]


def step(state, torque, p, equations, swapped=False, euler=False):
    """One step, with one of the faults that ports have had."""

    def derivative(state):
        t1, t2, w1, w2 = state
        d1 = (
            p["m1"] * p["lc1"] ** 2
            + p["m2"] * (p["l1"] ** 2 + p["lc2"] ** 2 + 2 * p["l1"] * p["lc2"] * math.cos(t2))
            + p["I1"]
            + p["I2"]
        )
        d2 = p["m2"] * (p["lc2"] ** 2 + p["l1"] * p["lc2"] * math.cos(t2)) + p["I2"]
        h = p["m2"] * p["l1"] * p["lc2"] * math.sin(t2)
        phi2 = p["m2"] * p["lc2"] * p["g"] * math.sin(t1 + t2)
        phi1 = (
            -h * w2 * (w2 + 2 * w1)
            + (p["m1"] * p["lc1"] + p["m2"] * p["l1"]) * p["g"] * math.sin(t1)
            + phi2
        )
        coriolis = h * w1**2 if equations == "book" else 0.0
        a2 = (torque + d2 / d1 * phi1 - coriolis - phi2) / (
            p["m2"] * p["lc2"] ** 2 + p["I2"] - d2**2 / d1
        )
        a1 = -(d2 * a2 + phi1) / d1
        return (w1, w2, a2, a1) if swapped else (w1, w2, a1, a2)

    def moved(slope, time):
        return [x + time * dx for x, dx in zip(state, slope)]

    dt = p["dt"]
    k1 = derivative(state)
    k2 = derivative(moved(k1, dt / 2))
    k3 = derivative(moved(k2, dt / 2))
    k4 = derivative(moved(k3, dt))
    slope = k1 if euler else [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k1, k2, k3, k4)]
    new = moved(slope, dt)
    limits = [p["max_vel_1"], p["max_vel_2"]]
    return [
        turned(new[0]),
        turned(new[1]),
        *(max(-limit, min(limit, w)) for w, limit in zip(new[2:], limits)),
    ]


FAULTS = {
    "the two accelerations are swapped": lambda s, i, p, e: step(
        s, p["torques"][i], p, e, swapped=True
    ),
    "the other set of equations": lambda s, i, p, e: step(
        s, p["torques"][i], p, "nips" if e == "book" else "book"
    ),
    "Euler's method, not Runge-Kutta of order 4": lambda s, i, p, e: step(
        s, p["torques"][i], p, e, euler=True
    ),
    "the actions are mirrored": lambda s, i, p, e: step(s, p["torques"][2 - i], p, e),
    "gravity is 9.81": lambda s, i, p, e: step(s, p["torques"][i], {**p, "g": 9.81}, e),
}


def main(kit, answers, tolerance="1e-9"):
    total, wrong, worst, first, samples = (
        0,
        dict.fromkeys([*NAMES, "reward", "terminated"], 0),
        [0.0] * 4,
        None,
        [],
    )
    with open(kit) as expected_lines, open(answers) as answer_lines:
        for row, (expected, answer) in enumerate(zip_longest(expected_lines, answer_lines), 1):
            if expected is None or answer is None:
                sys.exit(f"both files must have as many lines; one ends before line {row}")
            run, answer = json.loads(expected), json.loads(answer)
            if answer is None:  # the port has no such parameters
                continue
            states = [[number(x) for x in state] for state in run["states"]]
            got = [[number(x) for x in state] for state in answer["states"]]
            if len(got) != len(run["actions"]):
                rule = f"{len(run['actions'])} states, one for each action"
                sys.exit(f"line {row} must have {rule}, got {len(got)}")
            for i, action in enumerate(run["actions"]):
                total += 1
                distances = difference(got[i], states[i + 1])
                worst = [max(pair) for pair in zip(worst, distances)]
                failed = [
                    name for name, distance in zip(NAMES, distances) if distance > float(tolerance)
                ]
                failed += [
                    name
                    for name, key in (("reward", "rewards"), ("terminated", "terminated"))
                    if key in run and answer[key][i] != run[key][i]
                ]
                for name in failed:
                    wrong[name] += 1
                if failed and first is None:
                    first = (
                        f"first: line {row}, step {i}, {failed[0]}: from {states[i]} by action "
                        f"{action}\n  expected {states[i + 1]}\n  got      {got[i]}"
                    )
                if failed and len(samples) < 1000:
                    samples.append(
                        (states[i], action, run["params"], run["equations"], got[i], distances)
                    )
    for name, distance in zip(NAMES, worst):
        print(
            f"{name:10} {total - wrong[name]} of {total} steps, largest difference {distance:.2g}"
        )
    for name in ("reward", "terminated"):
        print(f"{name:10} {wrong[name]} wrong")
    if total == 0:
        sys.exit("no line was answered")
    if first is None:
        return print("passed")
    print(first)
    plain = median(max(distances) for *_, distances in samples)
    for fault, model in FAULTS.items():
        if (
            median(
                max(difference(got, model(state, action, params, equations)))
                for state, action, params, equations, got, _ in samples
            )
            < plain / 10
        ):
            print(f"likely: {fault}")
    sys.exit("failed")


main(*sys.argv[1:])
