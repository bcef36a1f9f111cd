"""The task to stay upright. `test_recorded.py` compares its bits with those of Rust."""

import gymnasium
import numpy as np
import pytest
from acrobot_rs import AcrobotBalanceEnv, AcrobotBalanceVectorEnv
from vectors import BALANCE


@pytest.mark.parametrize("options", [{}, {"low": -0.2, "high": 0.1}])
def test_episodes_begin_near_upright_alike(options):
    env, envs = AcrobotBalanceEnv(), AcrobotBalanceVectorEnv(400)
    envs.reset(seed=[*range(400)], options=options)
    bounds = options.get("low", -0.05), options.get("high", 0.05)
    draws = [np.random.default_rng(seed).uniform(*bounds, 4) for seed in range(400)]
    assert np.abs(envs.state - draws - [np.pi, 0, 0, 0]).max() < 1e-6
    observation, _ = env.reset(seed=7, options=options)
    assert (env.state == envs.state[7]).all()
    theta1, theta2, *velocities = env.state
    angles = [np.cos(theta1), np.sin(theta1), np.cos(theta2), np.sin(theta2)]
    np.testing.assert_allclose(observation, [*angles, *velocities], atol=1e-6)
    for action in -3.0, 10.0, 0.5:
        _, reward, *_ = env.step([action])
        rewards = envs.step([[action]] * 400)[1]
        assert abs(rewards[7] - reward) < 1e-6
        height = -np.cos(env.state[0]) - np.cos(env.state[:2].sum())
        assert abs(reward - (2 + height) / 4) < 1e-6 and not np.isnan(rewards).any()


def test_no_state_ends_an_episode():
    """It falls."""
    env = gymnasium.make(BALANCE)
    env.reset(seed=1)
    steps = [env.step([0.0]) for _ in range(500)]
    assert [step[2] for step in steps] == [False] * 500
    assert [step[3] for step in steps] == [False] * 499 + [True]
    assert min(step[1] for step in steps) < 0.5


def test_gymnasium_s_episodes_are_another_task():
    with pytest.raises(TypeError, match="gymnasium_episodes"):
        AcrobotBalanceVectorEnv(gymnasium_episodes=True)
