"""Learns with `swing_up` over several seeds, and compares the figures with the tables in
docs/learning.md.

    python3 figures.py             fails if they differ: learning is bit-identical everywhere
    python3 figures.py --update    writes the tables again

It takes four minutes on two cores.
"""

import concurrent.futures
import os
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/learning.md"
CARGO = "--quiet --release --locked --package=desktop --bin=swing_up".split()
# The learner was tuned with seeds from 1000 to 1999.
FIRST_SEED = 4000
EVALUATE = 5000
GOALS = [-80, -75, -70]
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
RETURNS = "| memory | steps | seeds | return: mean ± sd "
RETURNS += "| 95 % interval of the mean | worst seed | misses |"
TIMES = "| memory | steps | steps to −80: median, worst seed | to −75 | to −70 |"


def learn(run, seed):
    """The steps at which this seed's greedy policy reached each of the goals, its mean return in
    the end, and its misses."""
    memory, steps, _ = run
    options = f"--quiet --memory {memory} --steps {steps} --seed {seed} --evaluate {EVALUATE}"
    command = ["cargo", "run", *CARGO, "--", *options.split()]
    *curve, last = subprocess.check_output(command, text=True, cwd=ROOT).splitlines()
    points = [(int(line.split()[1]), float(line.split()[3])) for line in curve]
    first = lambda goal: min((at for at, mean in points if mean >= goal), default=float("inf"))
    reached = [first(goal) for goal in GOALS]
    words = last.split()
    line = dict(zip(words[::2], words[1::2]))
    return reached, float(line["greedy_mean"]), int(line["misses"])


def measure():
    """The results of all seeds of each run."""
    subprocess.run(["cargo", "build", *CARGO], check=True, cwd=ROOT)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        learning = [(run, range(FIRST_SEED, FIRST_SEED + run[-1])) for run in RUNS]
        futures = [(run, [pool.submit(learn, run, seed) for seed in all]) for run, all in learning]
        return [(run, [future.result() for future in of_seeds]) for run, of_seeds in futures]


def returns(run, results):
    memory, steps, seeds = run
    _, means, misses = zip(*results)
    mean, sd = statistics.mean(means), statistics.stdev(means)
    error = STUDENT[seeds] * sd / seeds**0.5
    cells = [f"{memory[:-1]} KiB", f"{steps:,}", f"{seeds}", f"{mean:.1f} ± {sd:.1f}"]
    cells += [f"{mean - error:.1f} to {mean + error:.1f}", f"{min(means):.1f}"]
    return cells + [f"{sum(misses)} of {1000 * seeds:,}"]


def times(run, results):
    memory, steps, _ = run
    reached, _, _ = zip(*results)
    cells = [f"{memory[:-1]} KiB", f"{steps:,}"]
    ends = [(statistics.median_low(at), max(at)) for at in zip(*reached)]
    return cells + [f"{thousands(median)}, {thousands(worst)}" for median, worst in ends]


def thousands(steps):
    """The evaluation's steps, without those of the episode that it waited for."""
    return "never" if steps == float("inf") else f"{int(steps) // EVALUATE * EVALUATE:,}"


def main():
    begin = time.monotonic()
    results = measure()
    print(f"{time.monotonic() - begin:.0f} s", file=sys.stderr)
    largest = [(run, of_seeds) for run, of_seeds in results if run[0] == "64k" and run[1] > 0]
    before = lines = PAGE.read_text().splitlines()
    for head, row, results in [(RETURNS, returns, results), (TIMES, times, largest)]:
        rows = [f"| {' | '.join(row(*result))} |".replace("-", "−") for result in results]
        table = [head, "|---" * (head.count("|") - 1) + "|", *rows]
        print("\n".join(table))
        start = lines.index(head)
        end = next(i for i in range(start, len(lines)) if not lines[i].startswith("|"))
        lines = lines[:start] + table + lines[end:]
    if sys.argv[1:] == ["--update"]:
        PAGE.write_text("\n".join(lines) + "\n")
    elif lines != before:
        sys.exit("The tables in docs/learning.md differ; python3 figures.py --update writes them")


main()
