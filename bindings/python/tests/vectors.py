"""What the tests of environments share."""

import contextlib
import pickle
import warnings

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from gymnasium.envs.classic_control import AcrobotEnv as Gymnasiums
from acrobot_rs.arrays import warn_of_other_sines

KINDS = [getattr(acrobot_rs, name) for name in acrobot_rs.__all__ if name.endswith("Env")]
SINGLE_KINDS = [kind for kind in KINDS if issubclass(kind, gymnasium.Env)]
V1 = "acrobot_rs/Acrobot-v1"
#: The parameters that Gymnasium's environment has, too. `gravity` has no name there.
SHARED = [name for name in acrobot_rs.AcrobotEnv._NAMES if hasattr(Gymnasiums, name)]


with warnings.catch_warnings(record=True) as OTHER_SINES:
    warnings.simplefilter("always")
    warn_of_other_sines()


def make_vec(num_envs, **kwargs):
    return gymnasium.make_vec(
        V1, num_envs=num_envs, vectorization_mode="vector_entry_point", **kwargs
    )


def pair(num_envs, mode="NextStep", **kwargs):
    """Gymnasium's SyncVectorEnv of its environments, and ours like it."""
    if OTHER_SINES:
        pytest.skip(str(OTHER_SINES[0].message))
    sync = {"vectorization_mode": "sync", "vector_kwargs": {"autoreset_mode": mode}}
    return (
        gymnasium.make_vec("Acrobot-v1", num_envs, **sync, **kwargs),
        make_vec(num_envs, autoreset_mode=mode, gymnasium_episodes=True, **kwargs),
    )


def assert_equal(one, other):
    """Compares what `reset` or `step` returned: values, types and infos."""
    for a, b in zip(one[:-1], other[:-1], strict=True):
        assert a.dtype == b.dtype
        np.testing.assert_array_equal(a, b)
    # Lists, because NumPy does not compare arrays of arrays.
    np.testing.assert_equal(
        *({key: list(value) for key, value in each[-1].items()} for each in (one, other))
    )


def assert_resets_equal(*envs, seed=None, options=None):
    """Resets both, each with its own options, because SyncVectorEnv removes some."""
    assert_equal(*(each.reset(seed=seed, options=options and {**options}) for each in envs))


@contextlib.contextmanager
def rejects(env, error, message=None):
    """Expects an error, and that nothing changes."""
    before = pickle.dumps(env)
    with pytest.raises(error, match=message):
        yield env
    assert pickle.dumps(env) == before


def different(count, seed):
    """A value of each parameter for each of these environments."""
    rng = np.random.default_rng(seed)
    values = {
        name: list(rng.uniform(0.8, 1.2, count)) for name in SHARED if name.startswith("LINK")
    }
    values["dt"] = tuple(rng.uniform(0.05, 0.25, count).tolist())
    values["MAX_VEL_1"] = rng.uniform(2, 12, count)
    values["MAX_VEL_2"] = rng.uniform(2, 28, count).astype(np.float32)
    values["AVAIL_TORQUE"] = rng.uniform(-2, 2, (count, 3))
    values["torque_noise_max"] = rng.choice([0.0, 0.5], count)
    values["book_or_nips"] = rng.choice(["book", "nips"], count).tolist()
    assert values.keys() == set(SHARED)
    return values
