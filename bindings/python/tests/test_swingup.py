"""dm_control's swing-up in Gymnasium: the steps of `tests/data/swingup.txt`, and the same rules."""

from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from acrobot_rs import AcrobotBalanceEnv, AcrobotBalanceVectorEnv, AcrobotContinuousEnv
from acrobot_rs import AcrobotContinuousVectorEnv, AcrobotEnv, AcrobotSwingupEnv
from acrobot_rs import AcrobotSwingupVectorEnv
from acrobot_rs._native import Acrobot
from gymnasium.error import InvalidAction, ResetNeeded
from vectors import SWINGUPS, rejects

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


def assert_near(state, expected):
    """Compares states whose angles may differ by a turn."""
    difference = state - expected
    difference[..., :2] = (difference[..., :2] + np.pi) % (2 * np.pi) - np.pi
    assert np.abs(difference).max() < 1e-12


@TASKS
def test_steps_are_dm_controls(name, column):
    env = gym.make(name).unwrapped
    for row in RECORDED:
        env.state = ours(row[:4])
        observation, reward, terminated, truncated, _ = env.step(row[4:5])
        assert_near(env.state, ours(row[5:9]))
        assert np.abs(observation - row[9:15]).max() < 1e-6
        assert abs(reward - row[column]) < 1e-6
        assert not terminated and not truncated


def test_an_action_is_not_rounded():
    """By dm_control 1.0.50 with MuJoCo 3.17.0. These actions are no ``float32``."""
    env = AcrobotSwingupEnv()
    env.state = ours(np.array([0.3, -0.5, 0.7, -1.1]))
    for action in 0.1, -0.7, 1 / 3:
        env.step([action])
    expected = [0.3243404730465862, -0.5419455946447316, 0.9135917678870124, -1.6651809763179526]
    assert_near(env.state, ours(np.array(expected)))


@TASKS
@pytest.mark.parametrize("float64", [False, True])
def test_a_vector_environment_is_near_or_as_near(name, column, float64):
    envs = gym.make_vec(name, num_envs=len(RECORDED), float64=float64)
    envs.reset(seed=1)
    envs.unwrapped.state = ours(RECORDED[:, :4])
    observations, rewards, terminated, truncated, _ = envs.step(RECORDED[:, 4:5])
    if float64:
        assert_near(envs.unwrapped.state, ours(RECORDED[:, 5:9]))
    assert np.abs(observations - RECORDED[:, 9:15]).max() < 1e-5
    assert np.abs(rewards - RECORDED[:, column]).max() < 1e-5
    assert not terminated.any() and not truncated.any()


@pytest.mark.parametrize(("low", "high"), [(-np.pi, np.pi), (-0.2, 0.1)])
def test_episodes_begin_at_rest_at_angles_within_the_bounds(low, high):
    env, envs = AcrobotSwingupEnv(), AcrobotSwingupVectorEnv(400)
    options = None if high == np.pi else {"low": low, "high": high}
    draws = [np.random.default_rng(seed).uniform(low, high, 2) for seed in range(400)]
    expected = np.pad(draws, ((0, 0), (0, 2)))
    envs.reset(seed=[*range(400)], options=options)
    assert np.abs(envs.state - expected).max() < 1e-6
    env.reset(seed=7, options=options)
    assert env.state.dtype == np.float64 and (env.state == expected[7]).all()


def test_wrong_actions_are_rejected():
    env, envs = AcrobotSwingupEnv(), AcrobotSwingupVectorEnv(2)
    with pytest.raises(ResetNeeded, match="call reset"):
        env.step([0.0])
    for each in env, envs:
        each.reset(seed=0)
    with rejects(env, InvalidAction, "action must be a number from -1 to 1, as an array"):
        env.step([np.nan])
    with rejects(envs, InvalidAction, r"actions\[1\] must be a number from -1 to 1, got NaN"):
        envs.step([[0.0], [np.nan]])


@pytest.mark.parametrize("kind", [AcrobotSwingupVectorEnv, AcrobotBalanceVectorEnv])
def test_gymnasium_s_episodes_are_another_task(kind):
    with pytest.raises(ValueError, match="gymnasium_episodes must be False"):
        kind(gymnasium_episodes=True)


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
            env.step([action])
            envs.step([[action]] * 3)
        if name != "torque_noise_max":
            assert np.abs(envs.state - env.state).max() < 2e-5
        states.append(env.state)
    # Neither the equations of motion nor the rewards of the recording contain it.
    assert (states[0] == states[1]).all() == (name == "LINK_LENGTH_2")


@pytest.mark.parametrize(
    ("torques", "action", "torque"),
    [
        *(([-1.0, 3.0], *pair) for pair in [(np.inf, 3.0), (0.25, 0.75), (-0.5, -0.5), (-5, -1)]),
        ([1.0, 3.0], 0.0, 1.0),
    ],
)
def test_actions_are_parts_of_the_largest_and_the_smallest_torque(torques, action, torque):
    env, twin = AcrobotSwingupEnv(AVAIL_TORQUE=torques), AcrobotSwingupEnv(AVAIL_TORQUE=[-4, 4])
    env.state = twin.state = [1.0, 0.0, 0.0, 0.0]
    env.step([action])
    twin.step([torque / 4.0])
    assert (env.state == twin.state).all()
