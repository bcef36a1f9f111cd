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


def change(rng, envs):
    """Sets each parameter with a probability of a quarter."""
    changes = {
        "dt": lambda: 10 ** rng.uniform(-2.5, 0),
        "torque_noise_max": lambda: rng.choice([0.0, 0.1, 3.0]),
        "book_or_nips": lambda: str(rng.choice(["book", "nips"])),
        "AVAIL_TORQUE": lambda: rng.normal(0, 3, rng.choice([1, 2, 3, 4, 300])).tolist(),
        "MAX_VEL_1": lambda: rng.uniform(0.05, 50),
        "MAX_VEL_2": lambda: rng.uniform(0.05, 50),
    }
    for name in [name for name in SHARED if name.startswith("LINK")]:
        changes[name] = lambda: 10 ** rng.uniform(-1, 1)
    for name, draw in changes.items():
        if rng.random() < 0.25:
            value = draw()
            for env in envs:
                setattr(env, name, value)


def set_state(rng, envs):
    """In float64 or float32."""
    state = rng.normal(0, 5, 4).astype(rng.choice([np.float32, np.float64]))
    for env in envs:
        env.state = state


def compare(seed):
    """Plays a configuration in both, and returns how many steps had too many turns."""
    rng = np.random.default_rng(seed)
    envs = theirs, ours = gymnasium.make("Acrobot-v1").unwrapped, acrobot_rs.AcrobotEnv()
    default = seed % 10 == 0  # as to its parameters

    def assert_same(observation, our_observation, where="after a reset"):
        assert our_observation.dtype == observation.dtype
        assert our_observation.tobytes() == observation.tobytes(), f"seed {seed}, {where}"
        assert ours.state.tobytes() == np.float64(theirs.state).tobytes(), f"seed {seed}, {where}"

    def reset(seed=None):
        width = 10 ** rng.uniform(-2, 1.5)
        options = None if rng.random() < 0.5 else {"low": -width, "high": width * rng.random()}
        (first, info), (our_first, our_info) = [
            env.reset(seed=seed, options=options) for env in envs
        ]
        assert_same(first, our_first)
        assert our_info == info

    skipped = 0
    if not default:
        change(rng, envs)
    reset(seed=int(rng.integers(2**63)) << int(rng.integers(64)))
    for env in envs:
        env.action_space.seed(seed)
    for step in range(STEPS):
        event = rng.random()
        if event < 0.01 and not default:
            change(rng, envs)
            for env in envs:  # ours may have a new space
                env.action_space.seed(step)
        elif event < 0.02:
            reset()
        elif event < 0.03:
            set_state(rng, envs)
        elif event < 0.04:
            state = theirs.state.copy()
            state[step % 4] = event
            theirs.state = ours.state = state
        action, count = theirs.action_space.sample(), len(theirs.AVAIL_TORQUE)
        assert ours.action_space == gymnasium.spaces.Discrete(count)
        if count == 3:  # Gymnasium's space does not follow AVAIL_TORQUE
            assert ours.action_space.sample() == action
        if count < 3 or rng.random() < 0.5:
            action = int(rng.integers(count))
        try:
            observation, *signals = theirs.step(action)
        except TooManyTurns:
            skipped += 1
            ours.step(action)
            set_state(rng, envs)
            continue
        our_observation, *our_signals = ours.step(action)
        assert_same(observation, our_observation, f"step {step}")
        assert our_signals == signals and list(map(type, our_signals)) == list(map(type, signals))
        assert ours.np_random.bit_generator.state == theirs.np_random.bit_generator.state
    return skipped


def test_configurations(monkeypatch):
    """All parameters, changed during episodes too, resets with and without bounds, and states set
    by hand."""
    monkeypatch.setattr(acrobot, "wrap", wrap)
    count = 2000 if settings.get_current_profile_name() == "long" else 100
    skipped = sum(compare(seed) for seed in range(count))
    assert skipped < 0.1 * count * STEPS
