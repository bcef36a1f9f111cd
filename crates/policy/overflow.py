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
OBSERVATIONS = [(0.5, 0, 0.5, 0, 0, 0), (1, 0, 1, 0, 0, 0), (1, 0, 1, 0, 1, 0), (1, 0, 1, 0, 2, 0)]
#: Three scores. The unit before them changes the last, which is otherwise the highest.
LAST = ([[0], [0], [1]], [0, 0, 0.5], "none")

#: For each policy its layers, and the actions and torques.
CASES = {
    "score": ([([[0] * 6, [0] * 6, UP], [0, 0, 0], "none")], [2, 1, 1, 1], "----"),
    "low_relu": ([([DOWN], [0], "relu"), LAST], [2, 2, 2, 1], "----"),
    "low_tanh": ([([DOWN], [0], "tanh"), LAST], [0, 0, 0, 1], "----"),
    "torque": ([([UP], [0], "none")], [2, 1, 1, 1], "2000"),
}

lines = []
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "file"
    for name, (layers, actions, torques) in CASES.items():
        policy.write(file, layers, 2.0 if name == "torque" else None)
        for observation, *played in zip(OBSERVATIONS, actions, torques):
            numbers = " ".join(map(str, [*observation, *played]))
            lines.append(f"{name} {numbers} {file.read_bytes().hex()}\n")
Path(__file__).with_name("overflow.txt").write_text("".join(lines))
