"""Draws initial states and then parameters by NumPy, as resets with ranges of parameters do: writes
draws.json to its folder. A row an acrobot: mass2 in [0.8, 1.2], gravity in [9, 10], the state.
"""

import json
from pathlib import Path

import numpy as np

LOW, HIGH = np.float32([0.8, 9.0]), np.float32([1.2, 10.0])

rows = []
for seed in np.random.SeedSequence(42).spawn(3):
    rng = np.random.default_rng(seed)
    state = rng.uniform(-0.1, 0.1, 4)
    params = [rng.uniform(low, high) for low, high in zip(LOW.astype(float), HIGH.astype(float))]
    rows.append([float(str(np.float32(x))) for x in (*params, *state)])
(Path(__file__).parent / "draws.json").write_text(json.dumps(rows) + "\n")
