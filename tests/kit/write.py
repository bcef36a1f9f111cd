"""Writes Gymnasium's recorded steps as JSON lines, for ports of the task in any language.
docs/ports.md describes the format.

python3 tests/kit/write.py acrobot-kit.jsonl
"""

import json
import math
import struct
import sys
from pathlib import Path

DATA = Path(__file__).resolve().parents[1] / "data"
STEPS = 500
PARAMS = ["l1", "l2", "m1", "m2", "lc1", "lc2", "I1", "dt", "max_vel_1", "max_vel_2", "torques"]
GYMNASIUM = [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 1.0, 0.2, 4 * math.pi, 9 * math.pi, [-1.0, 0.0, 1.0]]


def line(params, equations, actions, states, **ends):
    params = {**dict(zip(PARAMS, params)), "I2": params[PARAMS.index("I1")], "g": 9.8}
    states = [[x.hex() for x in state] for state in states]
    return json.dumps(
        {
            "params": params,
            "equations": equations,
            "actions": list(actions),
            "states": states,
            **ends,
        }
    )


def episodes():
    """Those without torque noise, which needs NumPy's generator."""
    rows = [
        row.split() for row in (DATA / "episodes.txt").read_text().splitlines() if row[0].isdigit()
    ]
    layout = struct.Struct(f"<{STEPS}B{4 * (STEPS + 1)}d{STEPS}b{STEPS}B6fQ")
    for row, record in zip(
        rows, layout.iter_unpack((DATA / "episodes.bin").read_bytes()), strict=True
    ):
        _, _, _, equations, noise, dt = row
        if float(noise) == 0:
            actions, record = record[:STEPS], record[STEPS:]
            states, record = record[: 4 * (STEPS + 1)], record[4 * (STEPS + 1) :]
            params = [*GYMNASIUM[:7], float(dt), *GYMNASIUM[8:]]
            terminated = [end == 1 for end in record[STEPS : 2 * STEPS]]
            yield line(
                params,
                equations,
                actions,
                zip(*[iter(states)] * 4),
                rewards=record[:STEPS],
                terminated=terminated,
            )


def single_steps():
    for record in struct.iter_unpack("<23d", (DATA / "steps.bin").read_bytes()):
        params = [*record[:10], list(record[10:13])]
        yield line(
            params,
            ["book", "nips"][int(record[13])],
            [int(record[18])],
            [record[14:18], record[19:]],
        )


Path(sys.argv[1]).write_text("".join(f"{each}\n" for each in [*episodes(), *single_steps()]))
