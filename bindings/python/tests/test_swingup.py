"""The swing-up in Gymnasium has the steps of `tests/data/swingup.txt`, and as the balance task its
own initial states, parameters and actions. With `dm_control`, `test_dm_control.py` plays episodes.
"""

from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from acrobot_rs import AcrobotBalanceEnv, AcrobotBalanceVectorEnv, AcrobotContinuousEnv
from acrobot_rs import AcrobotContinuousVectorEnv, AcrobotEnv, AcrobotSwingupEnv
from acrobot_rs import AcrobotSwingupVectorEnv, control
from acrobot_rs._native import Acrobot
from vectors import SWINGUPS

#: With the column of its rewards.
TASKS = pytest.mark.parametrize(("name", "column"), list(zip(SWINGUPS, (15, 16), strict=True)))
BOTH = pytest.mark.parametrize(
    ("kind", "many"),
    [
        (AcrobotContinuousEnv, AcrobotContinuousVectorEnv),
        (AcrobotSwingupEnv, AcrobotSwingupVectorEnv),
        (AcrobotBalanceEnv, AcrobotBalanceVectorEnv),
    ],
)
RECORDED = np.loadtxt(Path(__file__).parents[3] / "tests/data/swingup.txt")


def ours(states):
    """dm_control's states, whose angles are from upright."""
    return states + np.array([np.pi, 0.0, 0.0, 0.0])


@TASKS
@pytest.mark.parametrize("float64", [False, True])
def test_a_vector_environment_is_near_or_as_near(name, column, float64):
    envs = gym.make_vec(name, num_envs=len(RECORDED), float64=float64)
    envs.reset(seed=1)
    envs.unwrapped.state = ours(RECORDED[:, :4])
    observations, rewards, terminated, truncated, _ = envs.step(RECORDED[:, 4:5])
    if float64:
        difference = control.deviation(envs.unwrapped.state, ours(RECORDED[:, 5:9]))
        assert np.abs(difference).max() < 1e-12
    assert np.abs(observations - RECORDED[:, 9:15]).max() < 1e-5
    assert np.abs(rewards - RECORDED[:, column]).max() < 1e-5
    assert not terminated.any() and not truncated.any()


@BOTH
@pytest.mark.parametrize("bounds", [{}, {"low": -0.2, "high": 0.1}])
def test_episodes_begin_with_the_numbers_of_numpy(kind, many, bounds):
    """The swing-up draws two angles at rest; the balance task draws around upright."""
    env, envs = kind(), many(3)
    low, high = bounds.get("low", -env._BOUND), bounds.get("high", env._BOUND)
    drawn = np.random.default_rng(7).uniform(low, high, 2 if env._TASK == "swingup" else 4)
    expected = np.pad(drawn, (0, 4 - len(drawn))) + [np.pi * (env._TASK == "balance"), 0, 0, 0]
    one, many = env.reset(seed=7, options=bounds)[0], envs.reset(seed=[1, 7, 2], options=bounds)[0]
    assert np.abs(envs.state[1] - expected).max() < 1e-6 and np.abs(one - many[1]).max() < 1e-6
    assert (env.state == (expected if len(drawn) == 2 else envs.state[1])).all()


@BOTH
def test_the_default_parameters_are_those_of_rust(kind, many):
    untouched = Acrobot(continuous=True, task=kind._TASK)
    assert kind()._native.__getstate__() == untouched.__getstate__()
    assert many().parameters == kind().parameters
    with pytest.raises(ValueError, match="task must be one of .* got x"):
        Acrobot(task="x")


@BOTH
@pytest.mark.parametrize("name", AcrobotEnv._NAMES)
def test_each_parameter_changes_both_environments_alike(name, kind, many):
    changes = {"book_or_nips": "nips", "AVAIL_TORQUE": [-0.5, 0.4, 0.2], "dt": 0.1, "ROTOR": 0.1}
    states = []
    for change in {}, {name: changes.get(name, 0.25)}:
        env, envs = kind(**change), many(3, **change)
        assert env.observation_space == envs.single_observation_space
        assert env.action_space == envs.single_action_space
        for each, shape in (env, (4,)), (envs, (3, 4)):
            each.reset(seed=2)
            each.state = np.broadcast_to([1.0, 0.5, 2.0, -1.5], shape)
        for action in 0.6, -0.9, 0.3:
            (one, reward, *_), (each, rewards, *_) = env.step([action]), envs.step([[action]] * 3)
        if name != "torque_noise_max":
            assert np.abs(envs.state - env.state).max() < 2e-5
            assert np.abs(each - one).max() < 2e-5 and np.abs(rewards - reward).max() < 2e-5
        states.append(env.state)
    # Neither the equations of motion nor the rewards of the recording contain it.
    assert (states[0] == states[1]).all() == (name == "LINK_LENGTH_2")


@pytest.mark.parametrize(
    "convert",
    [list, np.float32, np.float64,
     # A number after a header of one byte is not aligned.
     lambda action: np.frombuffer(b"h" + np.float32(action).tobytes(), np.float32, offset=1)],
)  # fmt: skip
@pytest.mark.parametrize(
    ("kind", "torques", "action", "torque"),
    [
        *((AcrobotSwingupEnv, [-1.0, 3.0], action, torque)
          for action, torque in [(np.inf, 3.0), (0.25, 0.75), (-0.5, -0.5), (-5, -1)]),
        (AcrobotSwingupEnv, [1.0, 3.0], 0.0, 1.0),
        *((AcrobotContinuousEnv, [0.5, -3.0, 2.0], action, torque)
          for action, torque in [(-np.inf, -3.0), (-4, -3.0), (0.25, 0.25), (2.0, 2.0), (3.0, 2.0)]),
    ],
)  # fmt: skip
def test_actions_are_torques_or_parts_of_them(kind, torques, action, torque, convert):
    env = kind(AVAIL_TORQUE=torques)
    env.state = [1.0, 0.0, 0.0, 0.0]
    expected = control.simulate(env.state, [torque], env)[1]
    env.step(convert([action]))
    assert (env.state == expected).all()
