"""Writes overflow.txt beside it: policies whose sums overflow, and what they play, found by hand.

A line has a name, six numbers of an observation, the action, the torque in N m or `-`, and the file
in hexadecimal.
"""

import tempfile
from pathlib import Path

from acrobot_rs import policy

#: A sum of it and itself is infinite in float32.
HUGE = 3e38
UP, DOWN = [HUGE, 0, HUGE, 0, -HUGE, 0], [-HUGE, 0, -HUGE, 0, HUGE, 0]
#: Where UP is HUGE; infinite; infinite, but HUGE in another order; no number.
HALF, REST = (0.5, 0, 0.5, 0, 0, 0), (1, 0, 1, 0, 0, 0)
SLOW, FAST = (1, 0, 1, 0, 1, 0), (1, 0, 1, 0, 2, 0)


def scores(unit):
    """A layer whose last score is that unit."""
    return [([[0] * 6, [0] * 6, unit], [0, 0, 0], "none")]


def hidden(unit, activation):
    """That unit, and three scores of which it changes the last, which is otherwise the highest."""
    return [([unit], [0], activation), ([[0], [0], [1]], [0, 0, 0.5], "none")]


def torque(unit):
    return [([unit], [0], "none")]


#: For each policy: the observations, actions and torques.
CASES = {
    "score": (scores(UP), [(HALF, 2), (REST, 1), (SLOW, 1), (FAST, 1)]),
    "low_score": (scores(DOWN), [(HALF, 0), (REST, 1), (SLOW, 1), (FAST, 1)]),
    "relu": (hidden(UP, "relu"), [(HALF, 2), (REST, 1), (SLOW, 1), (FAST, 1)]),
    "low_relu": (hidden(DOWN, "relu"), [(HALF, 2), (REST, 2), (SLOW, 2), (FAST, 1)]),
    "tanh": (hidden(UP, "tanh"), [(HALF, 2), (REST, 2), (SLOW, 2), (FAST, 1)]),
    "low_tanh": (hidden(DOWN, "tanh"), [(HALF, 0), (REST, 0), (SLOW, 0), (FAST, 1)]),
    "torque": (torque(UP), [(HALF, 2, 2), (REST, 1, 0), (SLOW, 1, 0), (FAST, 1, 0)]),
    "low_torque": (torque(DOWN), [(HALF, 0, -2), (REST, 1, 0), (SLOW, 1, 0), (FAST, 1, 0)]),
}

lines = []
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "file"
    for name, (layers, rows) in CASES.items():
        for observation, action, *newton_metres in rows:
            policy.write(file, layers, 2.0 if newton_metres else None)
            numbers = [*observation, action, *(newton_metres or "-")]
            lines.append(f"{name} {' '.join(map(str, numbers))} {file.read_bytes().hex()}\n")
Path(__file__).with_name("overflow.txt").write_text("".join(lines))
