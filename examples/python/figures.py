"""Measures steps per second of this package, Gymnasium and EnvPool on one core, and prints the table of docs/python.md.

    pip install envpool==1.2.7    # needs Python 3.12
    python figures.py             prints the table
    python figures.py --update    also writes it into docs/python.md

Each environment plays random actions, drawn in advance, and resets after each episode. The time includes NumPy's arrays.
Measurements are interleaved, because other programs may use the machine too, and medians count. EnvPool runs with
several sizes, synchronously and asynchronously, and its fastest setting counts.
"""

import argparse
import os
import pathlib
import statistics
import time

import acrobot_rs  # noqa: F401 registers
import envpool
import gymnasium
import numpy as np
from tqdm import tqdm

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/python.md"
HEAD = "| on one core | steps/s | `acrobot_rs` is faster by a factor of |"
ROUNDS, SECONDS = 9, 0.5
SINGLE, VECTOR = "`acrobot_rs`, `make`", "`acrobot_rs`, `make_vec` of 1,024"
POOLS = [16, 64, 256, 1024, 4096]


def single(name):
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


def vector(envs, steps):
    envs.reset()
    actions = np.random.default_rng(0).integers(3, size=(steps, envs.num_envs))

    def play():
        for each in actions:
            envs.step(each)
        return actions.size

    return play


def pool(count):
    return vector(envpool.make_gymnasium("Acrobot-v1", num_envs=count, num_threads=1), 500_000 // count)


def asynchronous_pool(count, batch):
    """EnvPool's fastest mode according to its documentation: each step takes the environments that are ready."""
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


def measure(plays):
    measured = {name: [] for name in plays}
    for _ in tqdm(range(ROUNDS), unit="round"):
        for name, play in plays.items():
            measured[name].append(speed(play))
    return {name: statistics.median(each) for name, each in measured.items()}


def rounded(number):
    """With three digits."""
    return f"{float(f'{number:.3g}'):,.0f}"


def table(speeds, pools):
    best = max(pools, key=pools.get)
    rows = {**speeds, f"EnvPool {envpool.__version__}, {best} (the fastest of {len(pools)} settings)": pools[best]}
    yield HEAD
    yield "|---|---|---|"
    for name, speed in rows.items():
        if name in (SINGLE, VECTOR):
            ours, factor = speed, ""
        else:
            factor = rounded(ours / speed)
        yield f"| {name} | {rounded(speed)} | {factor} |"


def update(rows):
    lines = PAGE.read_text().splitlines()
    start = lines.index(HEAD)
    end = next(i for i in range(start, len(lines)) if not lines[i].startswith("|"))
    lines[start:end] = rows
    PAGE.write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--update", action="store_true", help="write the table into docs/python.md")
    options = parser.parse_args()

    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    gymnasiums = f"Gymnasium {gymnasium.__version__}"
    plays = {
        SINGLE: single("acrobot_rs/Acrobot-v1"),
        f"{gymnasiums}, `make`": single("Acrobot-v1"),
        VECTOR: vector(gymnasium.make_vec("acrobot_rs/Acrobot-v1", num_envs=1024), 500),
        f"{gymnasiums}, `SyncVectorEnv` of 1,024": vector(
            gymnasium.make_vec("Acrobot-v1", num_envs=1024, vectorization_mode="sync"), 10
        ),
    }
    pools = {
        **{f"{count:,} environments, synchronous": pool(count) for count in POOLS},
        **{
            f"{2 * count:,} environments, asynchronous, {count:,} per step": asynchronous_pool(2 * count, count)
            for count in POOLS
        },
    }
    medians = measure(plays | pools)
    rows = list(table({name: medians[name] for name in plays}, {name: medians[name] for name in pools}))
    print("\n".join(rows))
    if options.update:
        update(rows)


if __name__ == "__main__":
    main()
