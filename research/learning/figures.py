"""Learns with `swing_up` over several seeds, and compares the figures with the table in
docs/learning.md.

    python3 figures.py             fails if they differ: learning is bit-identical everywhere
    python3 figures.py --update    writes the table again

It takes four minutes on two cores.
"""

import concurrent.futures
import os
import pathlib
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/learning.md"
CARGO = "--quiet --release --locked --package=desktop --bin=swing_up".split()
# The learner was tuned with seeds from 1000 to 1999.
FIRST_SEED = 4000
# The 97.5 % quantiles of Student's t distribution, by the number of seeds.
STUDENT = {20: 2.093, 100: 1.984}
RUNS = [
    ("64k", 0, 20),
    ("64k", 50_000, 20),
    ("16k", 100_000, 20),
    ("32k", 100_000, 20),
    ("64k", 100_000, 100),
    ("64k", 300_000, 20),
    ("16k", 1_000_000, 20),
    ("64k", 1_000_000, 20),
    ("64k", 2_000_000, 20),
]
HEAD = "| memory | steps | seeds | return: mean ± std "
HEAD += "| 95 % interval of the mean | worst seed | misses |"


def learn(run, seed):
    """The mean return of this seed's greedy policy, and its misses."""
    memory, steps, _ = run
    options = f"--quiet --memory {memory} --steps {steps} --seed {seed}"
    command = ["cargo", "run", *CARGO, "--", *options.split()]
    words = subprocess.check_output(command, text=True, cwd=ROOT).splitlines()[-1].split()
    line = dict(zip(words[::2], words[1::2]))
    return float(line["greedy_mean"]), int(line["misses"])


def measure():
    """The results of all seeds of each run."""
    subprocess.run(["cargo", "build", *CARGO], check=True, cwd=ROOT)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        learning = [(run, range(FIRST_SEED, FIRST_SEED + run[-1])) for run in RUNS]
        futures = [(run, [pool.submit(learn, run, seed) for seed in all]) for run, all in learning]
        return [(run, [future.result() for future in of_seeds]) for run, of_seeds in futures]


def row(run, results):
    memory, steps, seeds = run
    means, misses = zip(*results)
    mean, std = statistics.mean(means), statistics.stdev(means)
    error = STUDENT[seeds] * std / seeds**0.5
    cells = [f"{memory[:-1]} KiB", f"{steps:,}", f"{seeds}", f"{mean:.1f} ± {std:.1f}"]
    cells += [f"{mean - error:.1f} to {mean + error:.1f}", f"{min(means):.1f}"]
    return cells + [f"{sum(misses)} of {1000 * seeds:,}"]


def main():
    rows = [f"| {' | '.join(row(*result))} |".replace("-", "−") for result in measure()]
    table = [HEAD, "|---" * (HEAD.count("|") - 1) + "|", *rows]
    print("\n".join(table))
    lines = PAGE.read_text().splitlines()
    start = lines.index(HEAD)
    end = next(i for i in range(start, len(lines)) if not lines[i].startswith("|"))
    if sys.argv[1:] == ["--update"]:
        PAGE.write_text("\n".join(lines[:start] + table + lines[end:]) + "\n")
    elif lines[start:end] != table:
        sys.exit("The table in docs/learning.md differs; python3 figures.py --update writes it")


main()
