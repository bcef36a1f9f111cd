"""Records Gymnasium's Acrobot: writes episodes.txt, episodes.bin, steps.bin and seeds.txt to its
folder.

The files hold the bits of one C library's sin, cos and pow: they were recorded with glibc 2.36 on
x86-64 with FMA. On a CPU with AVX-512 NumPy uses its own sines, so this script disables them.
"""

import os
import platform
from itertools import product
from pathlib import Path

if "avx512f" in Path("/proc/cpuinfo").read_text():
    os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"

import gymnasium
import numpy as np
from gymnasium.spaces import Discrete

HERE = Path(__file__).parent
STEPS = 500
VERSIONS = (
    f"gymnasium {gymnasium.__version__}, numpy {np.__version__}, "
    f"{' '.join(platform.libc_ver())}, {platform.machine()}"
)
FNV_OFFSET, FNV_PRIME = 0xCBF29CE484222325, 0x100000001B3


def digest(words):
    """FNV-1a over 64-bit words instead of bytes."""
    value = FNV_OFFSET
    for word in words:
        value = (value ^ int(word)) * FNV_PRIME % 2**64
    return value


def bits(numbers):
    return np.asarray(numbers, dtype="<f8").view("<u8")


def library():
    """A digest of the functions that the episodes depend on, which identifies the C library."""
    x = np.random.default_rng(0).uniform(-30.0, 30.0, 100_000)
    return digest(bits([f(v) for v in x for f in (np.sin, np.cos, lambda v: v**2)]))


def pump(state, rng):
    """Torque against the first link's velocity, with one action in ten at random."""
    return rng.integers(3) if rng.random() < 0.1 else (0 if state[2] > 0 else 2)


def episode(seed, low, high, dynamics, noise, dt, policy):
    """The initial state and 500 steps, also past the goal."""
    env = gymnasium.make("Acrobot-v1").unwrapped
    env.book_or_nips, env.torque_noise_max, env.dt = dynamics, noise, dt
    env.action_space.seed(seed)
    rng = np.random.default_rng(seed)
    initial_observation, _ = env.reset(seed=seed, options={"low": low, "high": high})
    actions, states, rewards, ends, observations = [], [env.state.astype("<f8")], [], [], []
    for _ in range(STEPS):
        action = env.action_space.sample() if policy == "random" else pump(env.state, rng)
        observation, reward, terminated, truncated, _ = env.step(action)
        assert not truncated
        actions.append(action)
        states.append(env.state)
        rewards.append(reward)
        ends.append(terminated)
        observations.append(observation)
    seen = np.asarray(observations, dtype="<f4").view("<u4").ravel()
    return b"".join(
        [
            np.asarray(actions, dtype="u1").tobytes(),
            np.asarray(states, dtype="<f8").tobytes(),
            np.asarray(rewards, dtype="i1").tobytes(),
            np.asarray(ends, dtype="u1").tobytes(),
            initial_observation.astype("<f4").tobytes(),
            np.asarray(digest(seen), dtype="<u8").tobytes(),
        ]
    )


def write_episodes():
    bounds = [(-0.1, 0.1), (-0.5, 1.0), (-1.5, -0.5), (-3.0, 3.0)]
    kinds = list(product(["book", "nips"], bounds, [0.0, 0.3], [0.2, 0.05]))
    # Each kind with a seed of up to 64 bits and one beyond.
    rows = [(7 + 1000003 * i, *kind, "random") for i, kind in enumerate(kinds)]
    rows += [(2**64 + 3**i * 5**60, *kind, "pump") for i, kind in enumerate(kinds)]
    # And eight whose initial states are far outside the bounds.
    wild = product(["book", "nips"], [(-30.0, 30.0)], [0.0, 0.3], [0.2, 0.05])
    rows += [(2**32 + i, *kind, "random") for i, kind in enumerate(wild)]
    lines = [
        f"# {VERSIONS}",
        "# Each row stands for a record in episodes.bin: 500 actions (u8), 501 states of 4 (f64), "
        "500 rewards",
        "# (i8), 500 terminated (u8), the initial observation (6 f32), a digest of the steps' "
        "observations (u64).",
        f"library {library():016x}",
        "# seed low high dynamics noise dt",
    ]
    with open(HERE / "episodes.bin", "wb") as file:
        for seed, dynamics, (low, high), noise, dt, policy in rows:
            file.write(episode(seed, low, high, dynamics, noise, dt, policy))
            lines.append(f"{seed} {low} {high} {dynamics} {noise} {dt}")
    (HERE / "episodes.txt").write_text("\n".join(lines) + "\n")


def write_steps():
    """Single steps from states all over the bounds: two thousand with the default parameters, four
    hundred with others, and two hundred from angles that take up to 64 turns to wrap, which rounds
    differently from one remainder. A record is l1, l2, m1, m2, lc1, lc2, I1 = I2, dt, the velocity
    bounds, the torques, NIPS (0 or 1), state, action, next state, in f64."""
    env = gymnasium.make("Acrobot-v1").unwrapped
    default = [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 1.0, 0.2, 4 * np.pi, 9 * np.pi, -1.0, 0.0, 1.0]
    rng = np.random.default_rng(1)
    records = []
    for i in range(2600):
        params = default
        if 2000 <= i < 2400:
            low = [0.3] * 7 + [0.01, 2.0, 5.0] + [-5.0] * 3
            high = [2.0] * 7 + [0.2, 20.0, 40.0] + [5.0] * 3
            params = rng.uniform(low, high).tolist()
        (env.LINK_LENGTH_1, env.LINK_LENGTH_2, env.LINK_MASS_1, env.LINK_MASS_2) = params[:4]
        (env.LINK_COM_POS_1, env.LINK_COM_POS_2, env.LINK_MOI, env.dt) = params[4:8]
        (env.MAX_VEL_1, env.MAX_VEL_2) = params[8:10]
        env.AVAIL_TORQUE = params[10:]
        env.book_or_nips = ["book", "nips"][i % 2]
        # The velocities are within 1/4, 1/2, 3/4 and all of their bounds, equally often.
        quarters = np.array([4 * np.pi, 9 * np.pi]) * (i // 2 % 4 + 1) / 4
        bounds = np.array([np.pi, np.pi, *quarters])
        if i >= 2400:
            bounds[:2] = 390.0
        state = rng.uniform(-bounds, bounds)
        action = int(rng.integers(3))
        env.state = state
        env.step(action)
        records.append([*params, i % 2, *state, action, *env.state])
    (HERE / "steps.bin").write_bytes(np.asarray(records, dtype="<f8").tobytes())


def hexes(words, digits):
    return " ".join(f"{int(word):0{digits}x}" for word in words)


def write_seeds():
    seeds = [0, 1, 2, 3, 7, 42, 123, 2**31, 2**32 - 1, 2**32, 2**32 + 1]
    seeds += [10**15, 2**63, 2**64 - 1, 2**64]
    seeds += [2**96 - 1, 2**96, 2**127 + 9, 2**128 - 1, 2**128, 2**160 + 5, 10**60, 2**1000 + 7]
    lines = [f"# {VERSIONS}", "# reset SEED: the initial state (bits of f32)"]
    env = gymnasium.make("Acrobot-v1").unwrapped
    for seed in seeds:
        env.reset(seed=seed)
        lines.append(f"reset {seed} {hexes(env.state.view('<u4'), 8)}")
    lines.append("# sample SEED N: twenty draws of Discrete(N).sample() after seed(SEED)")
    for seed, n in product(seeds, [3, 1, 2, 1000, 3 * 2**30, 2**32 - 1]):
        space = Discrete(n)
        space.seed(seed)
        lines.append(f"sample {seed} {n} {' '.join(str(space.sample()) for _ in range(20))}")
    lines.append(
        "# box SEED: three samples of Acrobot-v1's observation space after seed(SEED) (bits of f32)"
    )
    for seed in seeds:
        space = gymnasium.make("Acrobot-v1").observation_space
        space.seed(seed)
        samples = np.concatenate([space.sample() for _ in range(3)])
        lines.append(f"box {seed} {hexes(samples.view('<u4'), 8)}")
    lines.append(
        "# play ID SEED: 1000 random steps, a reset at each end: a digest of every step's "
        "observation (f32; for v0\n# the state), reward and ends, and the number of episodes"
    )
    for version, seed in product([0, 1], range(10)):
        # Gymnasium no longer has Acrobot-v0, which differed in its limit and its observation.
        played = gymnasium.make("Acrobot-v1", max_episode_steps=[200, 500][version])
        played.reset(seed=seed)
        played.action_space.seed(seed)
        words, episodes = [], 0
        for _ in range(1000):
            action = played.action_space.sample()
            observation, reward, terminated, truncated, _ = played.step(action)
            seen = [played.unwrapped.state, observation][version].astype("<f4").view("<u4")
            words += [*seen, reward == 0.0, terminated, truncated]
            if terminated or truncated:
                episodes += 1
                played.reset()
        lines.append(f"play Acrobot-v{version} {seed} {digest(words):016x} {episodes}")
    lines.append(
        "# mixed SEED: integers(3), uniform(-1, 2) (bits of f64), integers(5), four times over"
    )
    for seed in seeds:
        rng = np.random.default_rng(seed)
        uniform = lambda: hexes(bits([rng.uniform(-1, 2)]), 16)
        words = [f"{rng.integers(3)} {uniform()} {rng.integers(5)}" for _ in range(4)]
        lines.append(f"mixed {seed} {' '.join(words)}")
    lines.append(
        "# spawn SEED PATH: generate_state(4, uint64) of the descendant with that spawn_key"
    )
    paths = [(), (0,), (1,), (7,), (0, 0), (3, 2, 1), (2**32 - 1,), (2**32,), (2**40 + 1, 5)]
    for seed, path in product(seeds, paths):
        words = np.random.SeedSequence(seed, spawn_key=path).generate_state(4, np.uint64)
        lines.append(f"spawn {seed} {'/'.join(map(str, path)) or '-'} {hexes(words, 16)}")
    (HERE / "seeds.txt").write_text("\n".join(lines) + "\n")


write_episodes()
write_steps()
write_seeds()
print(VERSIONS)
