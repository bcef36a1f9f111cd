"""Compares a port's steps with Gymnasium's. docs/ports.md describes both files.

    python3 check.py acrobot-kit.jsonl answers.jsonl [TOLERANCE]
    python3 check.py acrobot-kit.jsonl --answer [FAULT]

The tolerance is the largest difference of an angle in rad or a velocity in rad/s: 1e-9, or 1e-3 for
a port in single precision. `--answer` prints the answers of the equations in this file, right or
with one of the faults below.
"""

import json
import math
import sys
from itertools import zip_longest
from statistics import median

NAMES = ["theta1", "theta2", "dtheta1", "dtheta2"]
# Those that ports have had.
FAULTS = [
    "the two accelerations are swapped",
    "the other set of equations",
    "Euler's method, not Runge-Kutta of order 4",
    "the actions are mirrored",
    "gravity is 9.81",
]


def numbers(states):
    """Texts in hexadecimal, or numbers."""
    number = lambda x: float.fromhex(x) if isinstance(x, str) else float(x)
    return [[number(x) for x in state] for state in states]


def turned(angle):
    """The same angle in [-pi, pi]: at this edge a rounding can add a turn."""
    return math.remainder(angle, 2 * math.pi)


def difference(got, expected):
    """How far each number is from Gymnasium's. An angle must be wrapped, too."""
    near = [abs(a - b) for a, b in zip(got, expected)]
    for i in range(2):
        if abs(got[i]) < math.pi + 1e-3:
            near[i] = abs(turned(got[i] - expected[i]))
    return [math.inf if math.isnan(distance) else distance for distance in near]


def step(run, state, action, fault=""):
    p = run["params"]
    m1, m2, l1, lc1, lc2, dt = (p[name] for name in ("m1", "m2", "l1", "lc1", "lc2", "dt"))
    is_book = (run["equations"] == "book") != ("equations" in fault)
    torque = p["torques"][2 - action if "mirrored" in fault else action]
    g = 9.81 if "gravity" in fault else p["g"]

    def derivative(state):
        t1, t2, w1, w2 = state
        h = m2 * l1 * lc2
        d1 = m1 * lc1**2 + m2 * (l1**2 + lc2**2) + 2 * h * math.cos(t2) + p["I1"] + p["I2"]
        d2 = m2 * lc2**2 + h * math.cos(t2) + p["I2"]
        phi2 = m2 * lc2 * g * math.sin(t1 + t2)
        phi1 = (m1 * lc1 + m2 * l1) * g * math.sin(t1) + phi2
        phi1 -= h * math.sin(t2) * w2 * (w2 + 2 * w1)
        coriolis = h * math.sin(t2) * w1**2 if is_book else 0.0
        a2 = (torque + d2 / d1 * phi1 - coriolis - phi2) / (m2 * lc2**2 + p["I2"] - d2**2 / d1)
        a1 = -(d2 * a2 + phi1) / d1
        return (w1, w2, a2, a1) if "swapped" in fault else (w1, w2, a1, a2)

    def moved(slope, time):
        return [x + time * dx for x, dx in zip(state, slope)]

    k1 = derivative(state)
    k2 = derivative(moved(k1, dt / 2))
    k3 = derivative(moved(k2, dt / 2))
    k4 = derivative(moved(k3, dt))
    slope = [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k1, k2, k3, k4)]
    t1, t2, *velocities = moved(k1 if "Euler" in fault else slope, dt)
    limits = p["max_vel_1"], p["max_vel_2"]
    bounded = [max(-limit, min(limit, w)) for w, limit in zip(velocities, limits)]
    return [turned(t1), turned(t2), *bounded]


def answer(kit, word=""):
    fault = next(fault for fault in ["", *FAULTS] if word in fault)
    for run in map(json.loads, open(kit)):
        given = zip(numbers(run["states"]), run["actions"])
        states = [step(run, state, action, fault) for state, action in given]
        ends = [-math.cos(t1) - math.cos(t1 + t2) > 1 for t1, t2, _, _ in states]
        rewards = [0 if end else -1 for end in ends]
        print(json.dumps({"states": states, "rewards": rewards, "terminated": ends}))


def check(kit, answers, tolerance="1e-9"):
    total, wrong, worst = 0, dict.fromkeys([*NAMES, "rewards", "terminated"], 0), [0.0] * 4
    first, samples = None, []
    for row, pair in enumerate(zip_longest(open(kit), open(answers)), 1):
        if None in pair:
            sys.exit(f"both files must have as many lines; one ends before line {row}")
        run, answer = map(json.loads, pair)
        if answer is None:  # the port has no such parameters
            continue
        states, got, actions = numbers(run["states"]), numbers(answer["states"]), run["actions"]
        if len(got) != len(actions):
            must = f"{len(actions)} states, one for each action"
            sys.exit(f"line {row} must have {must}, got {len(got)}")
        for i, action in enumerate(actions):
            total += 1
            distances = difference(got[i], states[i + 1])
            worst = [max(pair) for pair in zip(worst, distances)]
            failed = [name for name, x in zip(NAMES, distances) if x > float(tolerance)]
            ends = [key for key in ("rewards", "terminated") if key in run]
            failed += [key for key in ends if answer[key][i] != run[key][i]]
            for name in failed:
                wrong[name] += 1
            if failed and first is None:
                first = f"first: line {row}, step {i}, {failed[0]}: from {states[i]} by action"
                first += f" {action}\n  expected {states[i + 1]}\n  got      {got[i]}"
            if failed and len(samples) < 1000:
                samples.append((run, states[i], action, got[i], max(distances)))
    for name, distance in zip(NAMES, worst):
        right = total - wrong[name]
        print(f"{name:10} {right} of {total} steps, largest difference {distance:.2g}")
    for name in ("rewards", "terminated"):
        print(f"{name:10} {wrong[name]} wrong")
    if total == 0:
        sys.exit("no line was answered")
    if first is None:
        return print("passed")
    print(first)
    plain = median(most for *_, most in samples)
    for fault in FAULTS:
        model = [max(difference(got, step(*given, fault))) for *given, got, _ in samples]
        if median(model) < plain / 10:
            print(f"likely: {fault}")
    sys.exit("failed")


kit, *rest = sys.argv[1:]
if rest[:1] == ["--answer"]:
    answer(kit, *rest[1:])
else:
    check(kit, *rest)
