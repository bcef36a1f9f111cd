"""Measures this crate and other Acrobots from PyPI and crates.io, on one core of a Linux machine.

    python3 compare.py             prints the table
    python3 compare.py --update    also writes it into docs/benchmarks.md
    python3 compare.py --quick     one short round, to try it

Each implementation runs once a round in its own process, from `peers.py` or `src/main.rs`, and reports
steps and processor time. Results are medians. Python packages are installed into `.venv`, 2 GB.
"""

import argparse
import os
import pathlib
import statistics
import subprocess
import sys

PAGE = pathlib.Path("../../docs/benchmarks.md")
HEAD = "| one core | version | M steps/s | times Gymnasium |"
BASE = "make"
# The package of each Python implementation, and the names of all implementations in the table.
PACKAGES = {
    "make": "gymnasium",
    "unwrapped": "gymnasium",
    "sync_vector_env": "gymnasium",
    "acrobot_make": "acrobot_rs",
    "acrobot_make_vec": "acrobot_rs",
    "envpool": "envpool",
    "gymnax": "gymnax",
}
PEERS = {
    "make": "Gymnasium, `make`",
    "unwrapped": "Gymnasium, `unwrapped`",
    "sync_vector_env": "Gymnasium, `SyncVectorEnv` of 64",
    "envpool": "EnvPool of 1,024",
    "gymnax": "gymnax and jax on the CPU, 4,096 in `jit`, `vmap` and `scan`",
    "acrobot_make": "acrobot_rs for Python, `make`",
    "acrobot_make_vec": "acrobot_rs for Python, `make_vec` of 1,024",
    "ogym": "ogym, f64",
    "gmgn": "gmgn, f64",
    "rlevo": "rlevo-environments, f32",
    "host": "acrobot, `Host`",
    "reference": "acrobot, `Reference`",
    "portable": "acrobot, `Portable`",
    "fast": "acrobot, `Fast`",
    "batch": "acrobot, batch of 1,024 `Fast`, without observations",
    "observations": "acrobot, the same with observations",
}
CARGO = ["--quiet", "--release", "--locked"]


def install(package):
    """A Python with this package. Each package has its own virtual environment, because gymnax needs an older Gymnasium.
    EnvPool needs Python 3.12."""
    folder = pathlib.Path(".venv", package)
    python = folder / "bin" / "python"
    requirements = f"requirements/{package}.txt"
    subprocess.run(["uv", "venv", "--quiet", "--clear", "--python", "3.12", folder], check=True)
    # uv would not notice that the source of ours has changed.
    command = ["uv", "pip", "install", "--quiet", "--refresh-package", "acrobot-rs", "--python", python]
    subprocess.run([*command, "--requirement", requirements], check=True)
    return python


def run(*command):
    line = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    print(line, end="", file=sys.stderr)
    return line.split()


def measure(commands, rounds, seconds):
    """The version and the median rate of each implementation, and how many times as long as `Fast` rlevo takes."""
    versions, rates, ratios = {}, {name: [] for name in commands}, []
    for _ in range(rounds):
        for name, command in commands.items():
            _, *version, steps, elapsed = run(*command, name, seconds)
            versions[name] = ", ".join(version)
            rates[name].append(int(steps) / float(elapsed))
        _, ratio = run("cargo", "run", *CARGO, "rlevo/fast", seconds)
        ratios.append(float(ratio))
    rates = {name: statistics.median(values) for name, values in rates.items()}
    return versions, rates, statistics.median(ratios)


def digits(number):
    """A number with three digits."""
    return f"{float(f'{number:.3g}'):,g}"


def table(versions, rates):
    yield HEAD
    yield "|---|---|---|---|"
    for name, words in PEERS.items():
        yield f"| {words} | {versions[name]} | {digits(rates[name] / 1e6)} | {digits(rates[name] / rates[BASE])} |"


def update(rows):
    lines = PAGE.read_text().splitlines()
    start = lines.index(HEAD)
    end = next(i for i in range(start, len(lines)) if not lines[i].startswith("|"))
    lines[start:end] = rows
    PAGE.write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--update", action="store_true", help="write the table into docs/benchmarks.md")
    parser.add_argument("--quick", action="store_true", help="one short round")
    options = parser.parse_args()

    subprocess.run(["cargo", "build", *CARGO], check=True)
    pythons = {package: install(package) for package in sorted(set(PACKAGES.values()))}
    commands = {
        name: [pythons[PACKAGES[name]], "-W", "ignore", "peers.py"] if name in PACKAGES else ["cargo", "run", *CARGO]
        for name in PEERS
    }

    # One core for everything below, also for XLA's threads.
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    rounds, seconds = (1, "0.1") if options.quick else (7, "1")
    versions, rates, ratio = measure(commands, rounds, seconds)
    rows = list(table(versions, rates))
    print("\n".join(rows))
    print(f"interleaved in one process, `Fast` is {ratio:.2f} times as fast as rlevo-environments")
    if options.update:
        update(rows)


main()
