"""Records 64 frames of Gymnasium's rgb_array rendering: writes frames.png, eight rows of eight, and
frames.txt, the states, to its folder.

    pip install -r tests/data/requirements.txt
    python tests/data/frames.py
"""

import os
from pathlib import Path

os.environ["SDL_VIDEODRIVER"] = "dummy"

import gymnasium
import numpy as np
import pygame

HERE = Path(__file__).parent

env = gymnasium.make("Acrobot-v1", render_mode="rgb_array").unwrapped
env.reset(seed=0)
states = np.zeros((64, 4))
# Hanging, upright, and level; then anywhere; the last sixteen with other links.
states[:4, 0] = [0.0, np.pi, np.pi / 2, -np.pi / 2]
states[4:, :2] = np.random.default_rng(2).uniform(-np.pi, np.pi, (60, 2))
lengths = np.ones((64, 2))
lengths[48:] = np.random.default_rng(3).uniform(0.3, 2.0, (16, 2))
frames = []
for state, (length1, length2) in zip(states, lengths.tolist()):
    env.state = state
    (env.LINK_LENGTH_1, env.LINK_LENGTH_2) = (length1, length2)
    frames.append(env.render())
grid = np.asarray(frames).reshape(8, 8, 500, 500, 3).transpose(0, 2, 1, 3, 4).reshape(4000, 4000, 3)
pygame.image.save(pygame.surfarray.make_surface(grid.transpose(1, 0, 2)), HERE / "frames.png")
lines = [
    f"# gymnasium {gymnasium.__version__}, numpy {np.__version__}, pygame {pygame.version.ver}",
    "# theta1 theta2 length1 length2",
]
lines += [" ".join(map(repr, row)) for row in np.column_stack([states[:, :2], lengths]).tolist()]
(HERE / "frames.txt").write_text("\n".join(lines) + "\n")
