"""The single environment is bit-identical to Gymnasium's, which runs beside it.

With 2,000 configurations instead of 100: ``python -m pytest --hypothesis-profile=long
tests/test_parity.py``.
"""

import acrobot_rs
import gymnasium
import numpy as np
from gymnasium.envs.classic_control import acrobot
from hypothesis import settings
from vectors import SHARED

STEPS = 500


class TooManyTurns(Exception):
    """Beyond 64 turns in a step, ours takes one remainder."""


def wrap(x, low, high):
    """Gymnasium's, which does not end for infinity."""
    if not abs(x) < 64 * 2 * np.pi:
        raise TooManyTurns
    return gymnasiums_wrap(x, low, high)


gymnasiums_wrap = acrobot.wrap


def change(env, rng):
    """Sets each parameter with a probability of a quarter."""
    values = {name: 10 ** rng.uniform(-1, 1) for name in SHARED if name.startswith("LINK")}
    values["dt"] = 10 ** rng.uniform(-2.5, 0)
    values["torque_noise_max"] = rng.choice([0.0, 0.1, 3.0])
    values["book_or_nips"] = str(rng.choice(["book", "nips"]))
    values["AVAIL_TORQUE"] = rng.normal(0, 3, rng.choice([1, 2, 3, 4, 300])).tolist()
    values |= {name: rng.uniform(0.05, 50) for name in ("MAX_VEL_1", "MAX_VEL_2")}
    for name, value in values.items():
        if rng.random() < 0.25:
            setattr(env, name, value)


def begin(env, rng, is_seeded=True):
    width = 10 ** rng.uniform(-2, 1.5)
    options = None if rng.random() < 0.5 else {"low": -width, "high": width * rng.random()}
    seed = int(rng.integers(2**63)) << int(rng.integers(64)) if is_seeded else None
    return env.reset(seed=seed, options=options)


def begin_again(env, rng):
    return begin(env, rng, is_seeded=False)


def set_state(env, rng):
    """In float64 or float32."""
    env.state = rng.normal(0, 5, 4).astype(rng.choice([np.float32, np.float64]))


def set_a_velocity(env, rng):
    env.state = np.append(env.state[:3], rng.random())


def step(env, rng):
    return env.step(int(rng.integers(len(env.AVAIL_TORQUE))))


def compare(seed):
    """Plays a configuration in both, and returns how many steps had too many turns."""
    rng, skipped = np.random.default_rng(seed), 0
    envs = gymnasium.make("Acrobot-v1").unwrapped, acrobot_rs.AcrobotEnv()
    events = [change, begin_again, set_state, set_a_velocity][seed % 10 == 0 :]

    def both(call):
        draws, seen = int(rng.integers(2**32)), []
        for env in envs:
            observation, *others = call(env, np.random.default_rng(draws)) or [np.empty(0)]
            types = observation.dtype, [*map(type, others)]
            state = np.float64(env.state).tobytes(), env.np_random.bit_generator.state
            seen.append((observation.tobytes(), others, types, state))
        assert seen[0] == seen[1], f"seed {seed}, {call.__name__}"

    both(begin)
    for event in rng.integers(100, size=STEPS):
        if event < len(events):
            both(events[event])
        try:
            both(step)
        except TooManyTurns:
            skipped += 1
            both(begin)
    return skipped


def test_configurations(monkeypatch):
    """All parameters, changed during episodes too, resets with and without bounds, and states set
    by hand."""
    monkeypatch.setattr(acrobot, "wrap", wrap)
    count = 2000 if settings.get_current_profile_name() == "long" else 100
    skipped = sum(compare(seed) for seed in range(count))
    assert skipped < 0.1 * count * STEPS
