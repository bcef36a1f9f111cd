"""Recordings of RealAIGym's double pendulum, design C.1: writes ../real/*.bin.

    git clone https://github.com/dfki-ric-underactuated-lab/double_pendulum
    python recordings.py double_pendulum    # in this folder

The motors send angles with 16 bits and torques with 12, a sample each 2 ms; so does a file: two
angles and two torques of 16 bits each. ../real/LICENSE is theirs. Missing recordings cannot be
downloaded any more.
"""

import sys
from pathlib import Path

import numpy as np

FOLDER = "data/experiment_records/design_C.1/sys_id/20230629"
for path in sorted((Path(sys.argv[1]) / FOLDER).glob("*/trajectory.csv")):
    columns = np.genfromtxt(path, delimiter=",", names=True)
    angles = [(columns[f"pos_meas{i}"] + 12.5) / 25 * 65535 for i in (1, 2)]
    torques = [(columns[f"tau_meas{i}"] / 12 + 1) / 2 * 4095 for i in (1, 2)]
    samples = np.column_stack(angles + torques)
    raw = samples.round().astype("<u2")
    assert np.abs(samples - raw).max() < 1e-6
    raw.tofile(f"../real/{path.parent.name[-6:]}.bin")
