"""Writes Gymnasium's recorded steps as JSON lines, for ports of the task in any language, as
docs/ports.md describes.

    python3 tests/kit/write.py acrobot-kit.jsonl
"""

import json
import math
import struct
import sys
from pathlib import Path

DATA = Path(__file__).resolve().parents[1] / "data"
STEPS = 500
PARAMS = "l1", "l2", "m1", "m2", "lc1", "lc2", "I1", "dt", "max_vel_1", "max_vel_2", "torques"
GYMNASIUM = [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 1.0]
LIMITS = [4 * math.pi, 9 * math.pi, [-1.0, 0.0, 1.0]]


def run(params, equations, actions, states):
    params = {**dict(zip(PARAMS, params, strict=True)), "I2": params[6], "g": 9.8}
    states = [[x.hex() for x in state] for state in states]
    return {"params": params, "equations": equations, "actions": list(actions), "states": states}


def episodes():
    """Those without torque noise, which needs NumPy's generator."""
    rows = (row.split() for row in open(DATA / "episodes.txt") if row[0].isdigit())
    layout = struct.Struct(f"<{STEPS}B{4 * (STEPS + 1)}d{STEPS}b{STEPS}B6fQ")
    records = layout.iter_unpack((DATA / "episodes.bin").read_bytes())
    for (_, _, _, equations, noise, dt), record in zip(rows, records, strict=True):
        if float(noise) == 0:
            actions, record = record[:STEPS], record[STEPS:]
            states, record = record[: 4 * (STEPS + 1)], record[4 * (STEPS + 1) :]
            params = [*GYMNASIUM, float(dt), *LIMITS]
            terminated = [end == 1 for end in record[STEPS : 2 * STEPS]]
            ends = {"rewards": record[:STEPS], "terminated": terminated}
            yield run(params, equations, actions, zip(*[iter(states)] * 4)) | ends


def single_steps():
    for record in struct.iter_unpack("<23d", (DATA / "steps.bin").read_bytes()):
        params = [*record[:10], record[10:13]]
        equations = ["book", "nips"][int(record[13])]
        yield run(params, equations, [int(record[18])], [record[14:18], record[19:]])


with open(sys.argv[1], "w") as file:
    file.writelines(json.dumps(each) + "\n" for each in [*episodes(), *single_steps()])
