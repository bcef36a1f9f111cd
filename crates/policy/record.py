"""Records torch's actions on 10,000 observations: writes actions.bin beside policy.bin, which it
reads.

Each byte has four actions, the first in its lowest bits. 3 stands for a tie, two scores that differ
by less than 1e-4. The observations are those of child 0 of seed 1 under random actions with seed 1.
"""

from pathlib import Path

import gymnasium as gym
import numpy as np
import torch

from acrobot_rs import policy

HERE = Path(__file__).parent


def observations(count):
    envs = gym.make_vec("acrobot_rs/Acrobot-v1", num_envs=1, autoreset_mode="SameStep")
    actions = envs.single_action_space
    actions.seed(1)
    seen, _ = envs.reset(seed=1)
    for _ in range(count):
        yield seen[0].copy()
        seen, *_ = envs.step(np.array([actions.sample()]))


model = policy.load(HERE / "policy.bin").sequential()
with torch.no_grad():
    scores = model(torch.tensor(np.array(list(observations(10_000)))))
two, actions = scores.topk(2).values, scores.argmax(1)
actions[two[:, 0] - two[:, 1] < 1e-4] = 3
quarters = actions.numpy().astype("u1").reshape(-1, 4)
(HERE / "actions.bin").write_bytes((quarters << [0, 2, 4, 6]).sum(1).astype("u1").tobytes())
print(f"{np.bincount(actions, minlength=4).tolist()} times action 0, 1 and 2, and a tie")
