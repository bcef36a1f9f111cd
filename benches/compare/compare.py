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
import venv

PAGE = pathlib.Path("../../docs/benchmarks.md")
HEAD = "| one core | version | M steps/s | times Gymnasium |"
BASE = "make"
# The package of each Python implementation, and the names of all implementations in the table.
PACKAGES = {
    "make": "gymnasium",
    "unwrapped": "gymnasium",
    "sync_vector_env": "gymnasium",
    "envpool": "envpool",
    "gymnax": "gymnax",
}
PEERS = {
    "make": "Gymnasium, `make`",
    "unwrapped": "Gymnasium, `unwrapped`",
    "sync_vector_env": "Gymnasium, `SyncVectorEnv` of 64",
    "envpool": "EnvPool of 1,024",
    "gymnax": "gymnax and jax on the CPU, 4,096 in `jit`, `vmap` and `scan`",
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
    """A Python with this package, and the error if it does not install. Each package has its own
    virtual environment, because gymnax needs an older Gymnasium."""
    folder = pathlib.Path(".venv", package)
    venv.create(folder, with_pip=True)
    python = folder / "bin" / "python"
    command = [python, "-m", "pip", "install", "--quiet", "--requirement", f"requirements/{package}.txt"]
    pip = subprocess.run(command, stderr=subprocess.PIPE, text=True)
    lines = pip.stderr.splitlines() or ["pip fails"]
    errors = [line.removeprefix("ERROR: ") for line in lines if line.startswith("ERROR: ")]
    return python, (errors or lines)[-1] if pip.returncode else None


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


def table(versions, rates, missing):
    yield HEAD
    yield "|---|---|---|---|"
    for name, words in PEERS.items():
        if reason := missing.get(PACKAGES.get(name)):
            yield f"| {words} | does not install: {reason} | | |"
            continue
        ratio = digits(rates[name] / rates[BASE]) if BASE in rates else ""
        yield f"| {words} | {versions[name]} | {digits(rates[name] / 1e6)} | {ratio} |"


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
    pythons, missing = {}, {}
    for package in sorted(set(PACKAGES.values())):
        pythons[package], missing[package] = install(package)
    commands = {}
    for name in PEERS:
        package = PACKAGES.get(name)
        if package is None:
            commands[name] = ["cargo", "run", *CARGO]
        elif not missing[package]:
            commands[name] = [pythons[package], "-W", "ignore", "peers.py"]

    # One core for everything below, also for XLA's threads.
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    rounds, seconds = (1, "0.1") if options.quick else (7, "1")
    versions, rates, ratio = measure(commands, rounds, seconds)
    rows = list(table(versions, rates, missing))
    print("\n".join(rows))
    print(f"interleaved in one process, `Fast` is {ratio:.2f} times as fast as rlevo-environments")
    if options.update:
        update(rows)


main()
