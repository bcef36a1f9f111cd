"""The motor and the sensors of a real acrobot, beside environments without them."""

import copy
import re

import gymnasium as gym
import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousVectorEnv, AcrobotEnv, AcrobotVectorEnv
from acrobot_rs import LogUniform, Normal, Uniform
from gymnasium.utils.env_checker import check_env
from vectors import rejects

ALL = {
    **{"action_delay": Uniform(0, 8), "observation_delay": Uniform(1, 2), "encoder_counts": 4096},
    **{"motor_lag": LogUniform(0.01, 0.1), "torque_error": Normal(0, 0.1, -0.3, 0.3)},
    **{"angle_noise": Uniform(0, 0.01), "encoder_zero_1": Uniform(-0.02, 0.02)},
    **{"encoder_zero_2": [0.1, 0.2, 0.3], "velocity_filter": Uniform(0, 0.1)},
}
IDS = ["Acrobot-v1", "AcrobotContinuous-v0", "AcrobotBalance-v0", "AcrobotSwingup-v0"]


def test_torques_and_readings_come_later_and_wrong():
    late = AcrobotContinuousVectorEnv(
        3, action_delay=[0, 2, 8], observation_delay=3, encoder_zero_1=0.5, torque_error=-0.5
    )
    plain = AcrobotContinuousVectorEnv(3)
    rows, _ = late.reset(seed=1)
    first, _ = plain.reset(seed=1)
    # Three steps show the first reading.
    expected, torques = [first] * 3, np.random.default_rng(1).uniform(-1, 1, (100, 3, 1))
    for step in range(100):
        delays = [step - delay for delay in (0, 2, 8)]
        acting = [torques[at, i] * 0.5 if at >= 0 else [0.0] for i, at in enumerate(delays)]
        observation, reward, *ends, _ = plain.step(np.array(acting, np.float32))
        expected.append(observation)
        rows, rewards, *others, _ = late.step(torques[step].astype(np.float32))
        np.testing.assert_array_equal(late.state, plain.state)
        np.testing.assert_array_equal([rewards, *others], [reward, *ends])
        cos, sin = expected[step][:, 0], expected[step][:, 1]
        turned = [cos * np.cos(0.5) - sin * np.sin(0.5), sin * np.cos(0.5) + cos * np.sin(0.5)]
        np.testing.assert_allclose(rows[:, :2], np.transpose(turned), atol=1e-6)
        np.testing.assert_array_equal(rows[:, 2:], expected[step][:, 2:])


def test_resets_draw_what_get_attr_shows():
    envs = AcrobotVectorEnv(3, **ALL)
    envs.reset(seed=1)
    drawn = {name: envs.get_parameter(name) for name in ALL}
    assert set(drawn["action_delay"]) <= set(range(9)) and len(set(drawn["motor_lag"])) == 3
    assert envs.get_attr("encoder_zero_2") == (0.1, 0.2, 0.3)
    np.testing.assert_allclose(drawn["encoder_zero_2"], [0.1, 0.2, 0.3])
    assert (np.abs(drawn["encoder_zero_1"]) < 0.02).all()
    for _ in range(20):
        envs.step([2, 2, 2])
    same = copy.deepcopy(envs)
    for _ in range(20):
        np.testing.assert_array_equal(same.step([0, 1, 2])[0], envs.step([0, 1, 2])[0])
    envs.reset()
    assert (envs.get_parameter("motor_lag") != drawn["motor_lag"]).all()
    # Ideal again.
    for name in ALL:
        setattr(envs, name, None)
    observations, _ = envs.reset(seed=1)
    np.testing.assert_array_equal(observations, AcrobotVectorEnv(3).reset(seed=1)[0])


def test_instruments_can_come_to_environments_that_play():
    envs, plain = AcrobotVectorEnv(3), AcrobotVectorEnv(3)
    for each in (envs, plain):
        each.reset(seed=1)
        each.step([0, 1, 2])
    envs.encoder_zero_1 = 0.25
    for each in (envs, plain):
        each.step([2, 1, 0])
    np.testing.assert_array_equal(envs.state, plain.state)
    np.testing.assert_array_equal(envs.elapsed_steps, [2, 2, 2])


@pytest.mark.filterwarnings("ignore:.*(symmetric and normalized|-infinity|infinity).*:UserWarning")
@pytest.mark.parametrize("id", IDS)
def test_single_environments_are_measured(id):
    given = {**ALL, "encoder_zero_2": 0.1}
    env = gym.make(f"acrobot_rs/{id}", **given).unwrapped
    check_env(env)
    first, _ = env.reset(seed=7)
    again, _ = env.reset(seed=7)
    np.testing.assert_array_equal(first, again)
    assert 0.01 <= env.get_parameter("motor_lag") <= 0.1
    assert env.get_parameter("dt") == env.dt and "angle_noise" in env.parameters
    loaded = copy.deepcopy(env)
    action = env.action_space.sample()
    np.testing.assert_array_equal(loaded.step(action)[0], env.step(action)[0])


def test_the_space_contains_differences_of_readings():
    envs = AcrobotVectorEnv(2, velocity_filter=0.0, encoder_counts=2)
    assert envs.single_observation_space.high[4] > np.pi / 0.2
    envs.dt = 0.05
    assert envs.single_observation_space.high[4] > np.pi / 0.05
    envs.velocity_filter = None
    assert envs.single_observation_space.high[4] < 4.1 * np.pi


WHOLE = "a whole number of steps from 0 to 8, or Uniform of two"
BAD = [
    ("action_delay", 9, WHOLE, "9"),
    ("observation_delay", 0.5, WHOLE, "0.5"),
    ("action_delay", Normal(1, 1, 0, 2), WHOLE, "0"),
    ("motor_lag", Uniform(-1, 1), "from 0 to 1000 s", "-1"),
    ("torque_error", -1.5, "from -1 to 1000", "-1.5"),
    ("angle_noise", float("nan"), "from 0 to 10 rad", "NaN"),
    ("encoder_zero_1", 4, "from -π to π rad", "4"),
    ("encoder_counts", 0.5, "from 1 to 2²² a turn", "0.5"),
    ("velocity_filter", 1e39, "in the range of float32, from 1.2e-38 to 3.4e38", "1e39"),
]


@pytest.mark.parametrize(("name", "value", "rule", "got"), BAD)
def test_bad_instruments_are_rejected(name, value, rule, got):
    for env in (AcrobotVectorEnv(3), AcrobotVectorEnv(3, angle_noise=0.1), AcrobotEnv()):
        with rejects(env, ValueError, f"^{re.escape(f'{name} must be {rule}, got {got}')}$"):
            setattr(env, name, value)


def test_instruments_need_float32_and_a_number():
    for others in ({"float64": True}, {"gymnasium_episodes": True}):
        with rejects(
            AcrobotVectorEnv(3, **others), ValueError, "None with float64 and with gymnasium_epi"
        ) as env:
            env.angle_noise = 0.1
    with rejects(AcrobotVectorEnv(3), ValueError, r"encoder_zero_1\[1\] must be from") as env:
        env.encoder_zero_1 = [0, 4, 0]
    with rejects(AcrobotEnv(), TypeError, r"encoder_zero_1 must be a number, got \[1, 2") as env:
        env.encoder_zero_1 = [1, 2]
