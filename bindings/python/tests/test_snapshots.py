"""Copies and pickles continue bit-identically, share nothing, and damaged ones are rejected."""

import copy
import pickle

import numpy as np
import pytest
from acrobot_rs import AcrobotBalanceVectorEnv, AcrobotContinuousVectorEnv, AcrobotEnv
from acrobot_rs import AcrobotSwingupVectorEnv, AcrobotVectorEnv, LogUniform, Normal, Uniform
from vectors import SINGLE_KINDS, rejects

DRAWN = {"DAMPING_1": np.linspace(0, 0.1, 37), "LINK_MOI_2": Uniform(0.1, 0.2)}
OWN = {"LINK_MASS_1": np.linspace(0.5, 1.5, 37), "dt": Uniform(0.1, 0.2)}
#: Vector environments: the type, the mode, the noise and other arguments.
VECTOR = (
    (AcrobotVectorEnv, "SameStep", np.linspace(0, 0.3, 37)),
    (AcrobotVectorEnv, "Disabled", Normal(0.1, 0.2, 0.0, 0.3)),
    (AcrobotContinuousVectorEnv, "NextStep", Uniform(0.0, 0.3)),
    (AcrobotVectorEnv, "NextStep", 0.0, {"gymnasium_episodes": True, "copy": False}),
    (AcrobotVectorEnv, "NextStep", 0.0, {"float64": True}),
    (AcrobotVectorEnv, "SameStep", LogUniform(0.1, 0.3), OWN),
    (AcrobotSwingupVectorEnv, "SameStep", 0.1, DRAWN),
    (AcrobotBalanceVectorEnv, "NextStep", 0.1, DRAWN),
    (AcrobotContinuousVectorEnv, "NextStep", 0.1, DRAWN),
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
        lists = {key: list(value) for key, value in infos.items()}
        played.append([*map(np.copy, results), envs.state.tobytes(), lists])
        ended = results[2] | results[3]
        if np.any(ended) and isinstance(envs, AcrobotEnv):
            envs.reset()
        elif np.any(ended) and envs.metadata["autoreset_mode"].value == "Disabled":
            envs.reset(options={"reset_mask": ended.copy()})
    return played


AGAIN = [
    copy.copy,
    copy.deepcopy,
    *(lambda env, p=p: pickle.loads(pickle.dumps(env, p)) for p in (0, pickle.HIGHEST_PROTOCOL)),
]


@pytest.mark.parametrize("again", AGAIN)
@pytest.mark.parametrize("kind", [*((kind,) for kind in SINGLE_KINDS), *VECTOR])
def test_copies_continue_bit_identically(kind, again):
    envs = made(*kind)
    twin = again(envs)
    assert twin._native.__getstate__() == envs._native.__getstate__()
    np.testing.assert_equal(play(envs, 100), play(twin, 100))
    for name in envs._NAMES:
        np.testing.assert_equal(getattr(envs, name), getattr(twin, name))
    again(kind[0]())  # also before the first reset
