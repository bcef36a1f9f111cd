"""Records torch's actions on 10,000 observations: writes actions.bin beside policy.bin, which it
reads.

Each byte has four actions, the first in its lowest bits. 3 stands for a tie, two scores that differ
by less than 1e-4. The observations are those of child 0 of seed 1 under random actions with seed 1.
"""

import struct
from pathlib import Path

import acrobot_rs  # noqa: F401 registers
import gymnasium as gym
import numpy as np
import torch

HERE = Path(__file__).parent


def perceptron(content):
    """The file as a module of torch."""
    _, count, _, inputs, _ = struct.unpack_from("<4sBBHf", content)
    modules, at = [], 12 + 4 * count
    for i in range(count):
        outputs, activation, _ = struct.unpack_from("<HBB", content, 12 + 4 * i)
        numbers = np.frombuffer(content, "<f4", outputs * (1 + inputs), at)
        bias, weight = np.split(numbers.reshape(outputs, 1 + inputs), [1], axis=1)
        linear = torch.nn.Linear(inputs, outputs)
        linear.load_state_dict({"bias": torch.tensor(bias[:, 0]), "weight": torch.tensor(weight)})
        modules += [linear, [torch.nn.Identity(), torch.nn.Tanh(), torch.nn.ReLU()][activation]]
        inputs, at = outputs, at + numbers.nbytes
    return torch.nn.Sequential(*modules)


def observations(count):
    envs = gym.make_vec("acrobot_rs/Acrobot-v1", num_envs=1, autoreset_mode="SameStep")
    actions = envs.single_action_space
    actions.seed(1)
    seen, _ = envs.reset(seed=1)
    for _ in range(count):
        yield seen[0].copy()
        seen, *_ = envs.step(np.array([actions.sample()]))


with torch.no_grad():
    policy = perceptron((HERE / "policy.bin").read_bytes())
    scores = policy(torch.tensor(np.array(list(observations(10_000)))))
two, actions = scores.topk(2).values, scores.argmax(1)
actions[two[:, 0] - two[:, 1] < 1e-4] = 3
quarters = actions.numpy().astype("u1").reshape(-1, 4)
(HERE / "actions.bin").write_bytes((quarters << [0, 2, 4, 6]).sum(1).astype("u1").tobytes())
print(f"{np.bincount(actions, minlength=4).tolist()} times action 0, 1 and 2, and a tie")
