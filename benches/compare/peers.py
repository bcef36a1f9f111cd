"""Plays one Python package with a random policy for some seconds of processor time.

    python peers.py NAME SECONDS    prints name, version, steps and seconds

`compare.py` runs it in the virtual environment of the package.
"""

import importlib.metadata
import sys
import time

# Steps of an episode. Vector environments play a whole episode between two readings of the clock, because their
# episodes are in phase and sines of larger angles can take longer: gymnax begins an episode at 3.8 M steps/s and ends
# it at 2.3.
LIMIT = 500


def make():
    import gymnasium

    return alone(gymnasium.make("Acrobot-v1"))


def unwrapped():
    import gymnasium

    return alone(gymnasium.make("Acrobot-v1").unwrapped)


def sync_vector_env():
    import gymnasium

    return together(gymnasium.make_vec("Acrobot-v1", num_envs=64, vectorization_mode="sync"), 64)


def acrobot_make():
    import acrobot_rs  # noqa: F401 registers
    import gymnasium

    return alone(gymnasium.make("acrobot_rs/Acrobot-v1"))


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
    length = 0

    def run():
        nonlocal length
        for action in actions:
            _, _, terminated, _, _ = env.step(action)
            length += 1
            if terminated or length == LIMIT:  # `unwrapped` has no limit
                env.reset()
                length = 0
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


# For each implementation: a function that makes it and returns a function that plays some steps, and its packages.
PEERS = {
    "make": (make, ["gymnasium"]),
    "unwrapped": (unwrapped, ["gymnasium"]),
    "sync_vector_env": (sync_vector_env, ["gymnasium"]),
    "acrobot_make": (acrobot_make, ["acrobot-rs"]),
    "acrobot_make_vec": (acrobot_make_vec, ["acrobot-rs"]),
    "envpool": (envpool, ["envpool"]),
    "gymnax": (gymnax, ["gymnax", "jax"]),
}


def main():
    name, seconds = sys.argv[1], float(sys.argv[2])
    new, packages = PEERS[name]
    run = new()
    run()  # compiles, and warms up
    steps, start = 0, time.process_time()
    while (elapsed := time.process_time() - start) < seconds:
        steps += run()
    versions = [importlib.metadata.version(package) for package in packages]
    print(name, *versions, steps, elapsed)


main()
