"""Steps per second of this package and of Gymnasium, arrays included, on one core and in one run.

    python figures.py

All play in turns by random actions drawn in advance, with resets; the medians are printed.
"""

import statistics
import time

import acrobot_rs  # noqa: F401 registers
import gymnasium
import numpy as np

ROUNDS, SECONDS = 5, 1.0


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


def together(name, mode, count, steps):
    envs = gymnasium.make_vec(name, num_envs=count, vectorization_mode=mode)
    envs.reset(seed=0)
    actions = np.random.default_rng(0).integers(3, size=(steps, count))

    def play():
        for each in actions:
            envs.step(each)
        return actions.size

    return play


def speed(play):
    """Steps per second of processor time."""
    steps, start = 0, time.process_time()
    while (elapsed := time.process_time() - start) < SECONDS:
        steps += play()
    return steps / elapsed


def main():
    pairs = {
        "make": (alone("acrobot_rs/Acrobot-v1"), alone("Acrobot-v1")),
        "make_vec of 1,024": (
            together("acrobot_rs/Acrobot-v1", "vector_entry_point", 1024, 500),
            together("Acrobot-v1", "sync", 1024, 10),
        ),
    }
    speeds = {name: ([], []) for name in pairs}
    for _ in range(ROUNDS):
        for name, plays in pairs.items():
            for play, measured in zip(plays, speeds[name], strict=True):
                measured.append(speed(play))
    print(f"{'steps/s':20}{'acrobot_rs':>14}{'Gymnasium':>14}{'ratio':>8}")
    for name, measured in speeds.items():
        ours, theirs = map(statistics.median, measured)
        print(f"{name:20}{ours:14,.0f}{theirs:14,.0f}{ours / theirs:8,.0f}")


if __name__ == "__main__":
    main()
