"""Copies and pickles continue bit-identically, share nothing, and damaged ones are rejected."""

import copy
import pickle

import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousEnv, AcrobotEnv, AcrobotV0Env, AcrobotVectorEnv, LogUniform, Normal, Uniform
from acrobot_rs.swingup import AcrobotSwingupEnv, AcrobotSwingupSparseEnv, AcrobotSwingupVectorEnv
from acrobot_rs.vector import AcrobotContinuousVectorEnv
from vectors import rejects

SINGLE = (
    *(AcrobotEnv, AcrobotV0Env, AcrobotContinuousEnv),
    *(AcrobotSwingupEnv, AcrobotSwingupSparseEnv),
)
DRAWN = {"FRICTION_1": np.linspace(0, 0.1, 37), "LINK_MOI_2": Uniform(0.1, 0.2)}
#: Vector environments: the type, the mode, the noise and other arguments.
VECTOR = (
    (AcrobotVectorEnv, "NextStep", 0.3),
    (AcrobotVectorEnv, "SameStep", np.linspace(0, 0.3, 37)),
    (AcrobotVectorEnv, "Disabled", Uniform(0.0, 0.3)),
    (AcrobotContinuousVectorEnv, "NextStep", Uniform(0.0, 0.3)),
    (AcrobotVectorEnv, "NextStep", 0.0, {"gymnasium_episodes": True, "copy": False}),
    (AcrobotVectorEnv, "NextStep", 0.0, {"float64": True}),
    (AcrobotVectorEnv, "SameStep", LogUniform(0.1, 0.3), {"LINK_MASS_1": np.linspace(0.5, 1.5, 37), "dt": Uniform(0.1, 0.2)}),
    (AcrobotSwingupVectorEnv, "SameStep", 0.1, DRAWN),
    (AcrobotVectorEnv, "NextStep", 0.0, {"gravity": Normal(9.8, 1.0, 5.0, 12.0), "info_parameters": ["gravity"]}),
)


def made(kind, mode=None, noise=0.3, others=None):
    """Environments after so many steps that in mode NextStep the next step resets all."""
    envs = kind() if mode is None else kind(37, 90, autoreset_mode=mode, **(others or {}))
    envs.torque_noise_max = noise
    envs.book_or_nips = "nips"
    envs.AVAIL_TORQUE = [-1.0, -0.0, 1.5] if mode else [-1.0, -0.0, 1.5, 2.5]
    envs.action_space.seed(1)
    envs.reset(seed=1, options={"low": -1.0, "high": 0.5})
    play(envs, 90)
    return envs


def play(envs, steps):
    """Plays random actions and returns all results."""
    played = []
    for _ in range(steps):
        *results, infos = envs.step(envs.action_space.sample())
        played.append([*map(np.copy, results), envs.state.tobytes(), {key: list(value) for key, value in infos.items()}])
        ended = results[2] | results[3]
        if np.any(ended) and isinstance(envs, AcrobotEnv):
            envs.reset()
        elif np.any(ended) and envs.metadata["autoreset_mode"].value == "Disabled":
            envs.reset(options={"reset_mask": ended.copy()})
    return played


PROTOCOLS = range(pickle.HIGHEST_PROTOCOL + 1)
AGAIN = [copy.copy, copy.deepcopy, *(lambda env, p=p: pickle.loads(pickle.dumps(env, p)) for p in PROTOCOLS)]


@pytest.mark.parametrize("again", AGAIN)
@pytest.mark.parametrize("kind", [*((kind,) for kind in SINGLE), *VECTOR])
def test_copies_continue_bit_identically(kind, again):
    envs = made(*kind)
    twin = again(envs)
    assert twin._native.__getstate__() == envs._native.__getstate__()
    np.testing.assert_equal(play(envs, 300), play(twin, 300))
    for name in envs._NAMES:
        np.testing.assert_equal(getattr(envs, name), getattr(twin, name))
    again(kind[0]())  # also before the first reset


def number(value):
    return np.float64(value).tobytes()


NAN, TORQUES = number(np.nan), number([-1, 0, 1])


@pytest.mark.parametrize(
    ("kind", "damage", "message"),
    [
        *((kind, lambda good: b"", "the snapshot is damaged") for kind in (AcrobotEnv, AcrobotVectorEnv)),
        (AcrobotEnv, lambda good: good[:-1], "the snapshot is damaged"),
        (AcrobotEnv, lambda good: good + b"\0", "the snapshot must have no bytes after its end, got 1"),
        (AcrobotEnv, lambda good: b"\2" + good[1:], "the snapshot's version must be 1, got 2"),
        (AcrobotEnv, lambda good: good.replace(number(0.25), NAN), "the snapshot is damaged"),
        (AcrobotEnv, lambda good: good.replace(b"\3" + TORQUES, b"\0"), "AVAIL_TORQUE must be one or more"),
        (AcrobotEnv, lambda good: good.replace(b"\3" + TORQUES, b"\3" + TORQUES[:-8] + NAN), "AVAIL_TORQUE must be one or more"),
        (AcrobotEnv, lambda good: good.replace(b"\3" + TORQUES + number(0), b"\3" + TORQUES + number(-1)), "torque_noise_max must"),
        (AcrobotVectorEnv, lambda good: good.replace(b"\0\0\x80\x3e", b"\0\0\xc0\x7f"), "the snapshot is damaged"),  # 0.25 and NaN
    ],
)  # fmt: skip
def test_damaged_snapshots_are_rejected(kind, damage, message):
    env = kind() if kind is AcrobotEnv else kind(3)
    env.reset(seed=1)
    env.state = [0.0, 0.0, 0.0, 0.25] if kind is AcrobotEnv else [[0.0, 0.0, 0.0, 0.25]] * 3
    good = env._native.__getstate__()
    assert damage(good) != good
    with rejects(env, ValueError, message):
        env._native.__setstate__(damage(good))


def test_a_damaged_state_beyond_float32_is_one_of_float64():
    env = AcrobotEnv()
    env.state = np.float32([1, 2, 3, 4])
    env._native.__setstate__(env._native.__getstate__().replace(number(3), number(1e300)))
    assert list(env.state) == [1, 2, 1e300, 4]
