"""Measures this crate and other Acrobots from PyPI and crates.io, as README.md says.

Each implementation plays in its own process: this file in the virtual environment of a Python
package, or `src/main.rs`.
"""

import argparse
import importlib.metadata
import os
import pathlib
import statistics
import subprocess
import sys
import time

PAGE = pathlib.Path("../../docs/benchmarks.md")
HEAD = "| one core | version | M steps/s | times Gymnasium |"
CARGO = ["--quiet", "--release", "--locked"]
# Steps of an episode. Vector environments play a whole episode between two readings of the clock,
# because their episodes are in phase and sines of larger angles can take longer: gymnax begins an
# episode at 3.8 M steps/s and ends it at 2.3.
LIMIT = 500


def make(environment="Acrobot-v1"):
    import gymnasium

    return alone(gymnasium.make(environment))


def sync_vector_env():
    import gymnasium

    return together(gymnasium.make_vec("Acrobot-v1", num_envs=64, vectorization_mode="sync"), 64)


def acrobot_make():
    import acrobot_rs  # noqa: F401 registers

    return make("acrobot_rs/Acrobot-v1")


def acrobot_make_vec():
    import acrobot_rs  # noqa: F401 registers
    import gymnasium

    return together(gymnasium.make_vec("acrobot_rs/Acrobot-v1", num_envs=1024), 1024)


def envpool():
    import envpool

    return together(envpool.make_gymnasium("Acrobot-v1", num_envs=1024, num_threads=1), 1024)


def gymnax():
    """As in its documentation: vmap over environments and scan over steps, in one jit."""
    import gymnax
    import jax

    environments = 4096
    env, params = gymnax.make("Acrobot-v1")
    reset = jax.vmap(env.reset, in_axes=(0, None))
    step = jax.vmap(env.step, in_axes=(0, 0, 0, None))

    def turn(carry, _):
        key, _, state = carry
        key, action_key, step_key = jax.random.split(key, 3)
        actions = jax.random.randint(action_key, (environments,), 0, 3)
        keys = jax.random.split(step_key, environments)
        observation, state, *signals, _ = step(keys, state, actions, params)
        # Whatever is carried or returned must be computed.
        return (key, observation, state), signals

    @jax.jit
    def play(carry):
        return jax.lax.scan(turn, carry, length=LIMIT)

    key = jax.random.key(0)
    carry = key, *reset(jax.random.split(key, environments), params)

    def run():
        nonlocal carry
        carry, signals = jax.block_until_ready(play(carry))
        return environments * LIMIT

    return run


def alone(env):
    import numpy

    actions = numpy.random.default_rng(0).integers(3, size=10_000).tolist()
    env.reset(seed=0)

    def run():
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        return len(actions)

    return run


def together(envs, count):
    import numpy

    # EnvPool takes no other integers.
    actions = numpy.random.default_rng(0).integers(3, size=(LIMIT, count), dtype=numpy.int32)
    envs.reset()

    def run():
        for each in actions:
            envs.step(each)  # the step after an end resets
        return actions.size

    return run


# For each implementation: its name in the table and, for one in Python, a function that returns one
# that plays some steps, and its packages, the key of `REQUIREMENTS` first.
GYMNAX = "gymnax and jax on the CPU, 4,096 in `jit`, `vmap` and `scan`"
MAKE_VEC = "acrobot_rs for Python, `make_vec` of 1,024"
IMPLEMENTATIONS = {
    "make": ("Gymnasium, `make`", make, ["gymnasium"]),
    "sync_vector_env": ("Gymnasium, `SyncVectorEnv` of 64", sync_vector_env, ["gymnasium"]),
    "envpool": ("EnvPool of 1,024", envpool, ["envpool"]),
    "gymnax": (GYMNAX, gymnax, ["gymnax", "jax"]),
    "acrobot_make": ("acrobot_rs for Python, `make`", acrobot_make, ["acrobot_rs"]),
    "acrobot_make_vec": (MAKE_VEC, acrobot_make_vec, ["acrobot_rs"]),
    "rlevo": ("rlevo-environments, f32",),
    "fast": ("acrobot, `Fast`",),
    "batch": ("acrobot, batch of 1,024 `Fast`",),
}


# What each package needs, with versions.
REQUIREMENTS = {
    "gymnasium": ["gymnasium==1.4.0", "numpy==2.4.6"],
    "envpool": ["envpool==1.2.7", "gymnasium==1.4.0", "numpy==2.4.6"],
    # gymnax imports six, and does not ask for it.
    "gymnax": ["gymnax==1.0.1", "jax==0.10.2", "jaxlib==0.10.2", "numpy==2.4.6", "six==1.17.0"],
    "acrobot_rs": ["../../bindings/python", "gymnasium==1.4.0", "numpy==2.4.6"],
}


def play(name, seconds):
    _, new, packages = IMPLEMENTATIONS[name]
    run = new()
    run()  # compiles, and warms up
    steps, start = 0, time.process_time()
    while (elapsed := time.process_time() - start) < seconds:
        steps += run()
    print(name, *map(importlib.metadata.version, packages), steps, elapsed)


def install(package):
    """A Python with this package. Each package has its own virtual environment, because gymnax
    needs an older Gymnasium. EnvPool needs Python 3.12."""
    folder = pathlib.Path(".venv", package)
    python = folder / "bin" / "python"
    subprocess.run(["uv", "venv", "--quiet", "--clear", "--python", "3.12", folder], check=True)
    # uv would not notice that the source of ours has changed.
    command = "uv pip install --quiet --refresh-package acrobot-rs --python".split()
    subprocess.run([*command, python, *REQUIREMENTS[package]], check=True)
    return python


def measure(commands, rounds, seconds):
    """The versions and the median rate of each implementation."""
    versions, rates = {}, {name: [] for name in commands}
    for _ in range(rounds):
        for name, command in commands.items():
            line = subprocess.check_output([*command, name, seconds], text=True)
            print(line, end="", file=sys.stderr)
            _, *version, steps, elapsed = line.split()
            versions[name] = ", ".join(version)
            rates[name].append(int(steps) / float(elapsed))
    return versions, {name: statistics.median(values) for name, values in rates.items()}


def digits(number):
    """A number with three digits."""
    return f"{float(f'{number:.3g}'):,g}"


def table(versions, rates):
    yield HEAD
    yield "|---|---|---|---|"
    for name, (words, *_) in IMPLEMENTATIONS.items():
        ratios = [digits(rates[name] / unit) for unit in (1e6, rates["make"])]
        yield f"| {' | '.join([words, versions[name], *ratios])} |"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--update", action="store_true", help="write the table into the page")
    parser.add_argument("--quick", action="store_true", help="one short round")
    parser.add_argument("name", nargs="?", help="play this alone", choices=IMPLEMENTATIONS)
    parser.add_argument("seconds", nargs="?", type=float)
    options = parser.parse_args()
    if options.name:
        return play(options.name, options.seconds)

    subprocess.run(["cargo", "build", *CARGO], check=True)
    commands = dict.fromkeys(IMPLEMENTATIONS, ["cargo", "run", *CARGO])
    pythons = {}
    for name, (_, *python) in IMPLEMENTATIONS.items():
        if python:
            package = python[1][0]
            pythons[package] = pythons.get(package) or install(package)
            commands[name] = [pythons[package], "-W", "ignore", __file__]

    # One core for everything below, also for XLA's threads.
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    rounds, seconds = (1, "0.1") if options.quick else (7, "1")
    rows = list(table(*measure(commands, rounds, seconds)))
    print("\n".join(rows))
    if options.update:
        lines = PAGE.read_text().splitlines()
        start = lines.index(HEAD)
        end = next(i for i in range(start, len(lines)) if not lines[i].startswith("|"))
        lines[start:end] = rows
        PAGE.write_text("\n".join(lines) + "\n")


main()
