"""Learns with `swing_up` over several seeds, and compares the figures with the table in docs/learning.md.

    python3 figures.py             fails if they differ: learning is bit-identical everywhere
    python3 figures.py --update    writes the table again

It takes two minutes on two cores.
"""

import concurrent.futures
import os
import pathlib
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/learning.md"
SEEDS = range(3000, 3020)
RUNS = [
    ("fast", "64k", 0),
    ("fast", "64k", 2000),
    ("fast", "32k", 2000),
    ("fast", "16k", 2000),
    ("fast", "8k", 2000),
    ("quality", "64k", 2000),
    ("quality", "64k", 10000),
    ("quality", "64k", 30000),
    ("quality", "32k", 10000),
    ("quality", "16k", 10000),
]
HEAD = "| preset | weights | episodes | solved at: median, worst | greedy return: mean ± sd of the seeds | worst seed | misses |"


def learn(run, seed):
    """The episode at which this seed solved the task (infinity: never), the mean of its greedy returns, its misses."""
    preset, memory, episodes = run
    command = [ROOT / "target/release/examples/swing_up", "--quiet", "--preset", preset, "--memory", memory]
    command += ["--episodes", str(episodes), "--seed", str(seed)]
    words = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.split()
    line = dict(zip(words[::2], words[1::2]))
    solved_at = line["solved_at"].replace("never", "inf")
    return float(solved_at), float(line["greedy_mean"]), int(line["misses"])


def row(run, results):
    preset, memory, episodes = run
    solved_at, means, misses = zip(*results)
    solved = [f"{n:g}".replace("inf", "never") for n in (statistics.median(solved_at), max(solved_at))]
    spread = f"{statistics.mean(means):.1f} ± {statistics.stdev(means):.1f}"
    cells = [f"`{preset}`", f"{memory[:-1]} KiB", f"{episodes:,}", ", ".join(solved), spread, f"{min(means):.1f}"]
    return "| " + " | ".join(cells + [f"{sum(misses)} of {1000 * len(means):,}"]) + " |"


def measure():
    subprocess.run(["cargo", "build", "--quiet", "--release", "--locked", "--example", "swing_up"], check=True, cwd=ROOT)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        futures = [[pool.submit(learn, run, seed) for seed in SEEDS] for run in RUNS]
        yield HEAD
        yield "|---|---|---|---|---|---|---|"
        for run, of_seeds in zip(RUNS, futures):
            yield row(run, [future.result() for future in of_seeds])


def main():
    table = []
    for line in measure():
        print(line, flush=True)
        table.append(line)
    lines = PAGE.read_text().splitlines()
    start = lines.index(HEAD)
    end = next(i for i in range(start, len(lines)) if not lines[i].startswith("|"))
    if sys.argv[1:] == ["--update"]:
        lines[start:end] = table
        PAGE.write_text("\n".join(lines) + "\n")
    elif lines[start:end] != table:
        sys.exit("The table in docs/learning.md differs. If that is intended: python3 figures.py --update")


main()
