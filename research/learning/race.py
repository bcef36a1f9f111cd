"""Trains Stable-Baselines3's agents with RL Zoo's settings, and evaluates them as docs/learning.md
evaluates this project's learner.

    pip install stable-baselines3 sb3-contrib ../../bindings/python
    python race.py qrdqn 0 1 2    # an agent of AGENTS, and seeds

Prints for each seed the mean return of 1,000 greedy episodes, those that missed the goal, and the
seconds of one core.
"""

import sys
import time

import acrobot_rs  # noqa: F401 registers
import gymnasium as gym
import numpy as np
import torch
from acrobot_rs.sb3 import AcrobotVecEnv
from sb3_contrib import QRDQN
from stable_baselines3 import DQN, PPO
from stable_baselines3.common.vec_env import VecMonitor, VecNormalize

NAME = "acrobot_rs/Acrobot-v1"
# Settings of rl-baselines3-zoo's files in `hyperparams`: the class, environments, steps, settings.
Q = {
    "gamma": 0.99,
    "learning_starts": 0,
    "learning_rate": 6.3e-4,
    "batch_size": 128,
    "buffer_size": 50_000,
    "target_update_interval": 250,
    "train_freq": 4,
    "gradient_steps": -1,
    "exploration_fraction": 0.12,
    "exploration_final_eps": 0.1,
}
NET = {"net_arch": [256, 256]}
P = {"n_steps": 256, "gae_lambda": 0.94, "gamma": 0.99, "n_epochs": 4, "ent_coef": 0.0}
AGENTS = {
    "qrdqn": (QRDQN, 1, 100_000, Q | {"policy_kwargs": NET | {"n_quantiles": 25}}),
    "dqn": (DQN, 1, 100_000, Q | {"policy_kwargs": NET}),
    "ppo": (PPO, 16, 1_000_000, P),
}


def evaluate(model, normalize, seed):
    """The returns of greedy episodes, one in each environment."""
    envs = gym.make_vec(NAME, num_envs=1000)
    observations, _ = envs.reset(seed=seed)
    returns, running = np.zeros(1000), np.ones(1000, bool)
    while running.any():
        actions, _ = model.predict(normalize(observations), deterministic=True)
        observations, rewards, terminated, truncated, _ = envs.step(actions)
        returns += rewards * running
        running &= ~(terminated | truncated)
    return returns


def main():
    torch.set_num_threads(1)
    name, *seeds = sys.argv[1:]
    kind, count, steps, settings = AGENTS[name]
    for seed in map(int, seeds):
        envs = gym.make_vec(NAME, num_envs=count, autoreset_mode="SameStep", threads=1)
        envs = VecMonitor(AcrobotVecEnv(envs))
        normalize = np.asarray
        if kind is PPO:
            envs = VecNormalize(envs, gamma=settings["gamma"])
            normalize = envs.normalize_obs
        model = kind("MlpPolicy", envs, seed=seed, device="cpu", **settings)
        began = time.process_time()
        model.learn(steps)
        seconds = time.process_time() - began
        returns = evaluate(model, normalize, 10**9 + seed)
        missed = (returns <= -500).sum()
        print(f"{name} seed {seed}: {returns.mean():.1f}, {missed} missed, {seconds:.0f} s")


main()
