"""Steps per second of this package, of Gymnasium and of EnvPool, arrays included, on one core and in one run.

    pip install envpool==1.2.5
    python figures.py

All play the same kind of random actions, drawn in advance, with resets. Measurements are interleaved, and the medians are
printed. EnvPool runs with several sizes, synchronous and asynchronous.
"""

import os
import statistics
import time

import acrobot_rs  # noqa: F401 registers
import envpool
import gymnasium
import numpy as np

ROUNDS, SECONDS = 5, 0.5
POOLS = [16, 64, 256, 1024, 4096]


def alone(name):
    env = gymnasium.make(name)
    env.reset(seed=0)
    actions = np.random.default_rng(0).integers(3, size=1000).tolist()

    def play():
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        return len(actions)

    return play


def together(envs, steps):
    envs.reset()
    actions = np.random.default_rng(0).integers(3, size=(steps, envs.num_envs))

    def play():
        for each in actions:
            envs.step(each)
        return actions.size

    return play


def pool(count):
    return together(envpool.make_gymnasium("Acrobot-v1", num_envs=count, num_threads=1), 500_000 // count)


def pool_apart(count, batch):
    """EnvPool's asynchronous mode, its fastest by its documentation: each step takes the environments that are ready."""
    envs = envpool.make_gymnasium("Acrobot-v1", num_envs=count, batch_size=batch, num_threads=1)
    envs.async_reset()
    actions = np.random.default_rng(0).integers(3, size=(500_000 // batch, batch))

    def play():
        for each in actions:
            envs.send(each, envs.recv()[4]["env_id"])
        return actions.size

    return play


def speed(play):
    """Steps per second of processor time."""
    steps, start = 0, time.process_time()
    while (elapsed := time.process_time() - start) < SECONDS:
        steps += play()
    return steps / elapsed


def main():
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    vector = {"vectorization_mode": "vector_entry_point"}
    plays = {
        "acrobot_rs: make": alone("acrobot_rs/Acrobot-v1"),
        "Gymnasium: make": alone("Acrobot-v1"),
        "acrobot_rs: make_vec of 1,024": together(gymnasium.make_vec("acrobot_rs/Acrobot-v1", num_envs=1024, **vector), 500),
        "Gymnasium: SyncVectorEnv of 1,024": together(gymnasium.make_vec("Acrobot-v1", num_envs=1024), 10),
        **{f"EnvPool of {count:,}": pool(count) for count in POOLS},
        **{f"EnvPool of {2 * count:,}, {count:,} at once": pool_apart(2 * count, count) for count in POOLS},
    }
    measured = {name: [] for name in plays}
    for _ in range(ROUNDS):
        for name, play in plays.items():
            measured[name].append(speed(play))
    medians = {name: statistics.median(each) for name, each in measured.items()}
    for name, median in medians.items():
        ours = medians["acrobot_rs: make" if name.endswith("make") else "acrobot_rs: make_vec of 1,024"]
        print(f"{name:36}{median:14,.0f}{ours / median:8,.1f}")


if __name__ == "__main__":
    main()
