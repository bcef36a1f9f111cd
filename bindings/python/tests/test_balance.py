"""The task to stay upright. The program `bits` compares its bits in Rust."""

import gymnasium
import numpy as np
import pytest
from acrobot_rs import AcrobotBalanceEnv, AcrobotBalanceVectorEnv
from vectors import BALANCE


@pytest.mark.parametrize(("low", "high"), [(-0.05, 0.05), (-0.2, 0.1)])
def test_episodes_begin_near_upright_and_are_one_alone_and_among_many(low, high):
    env, envs = AcrobotBalanceEnv(), AcrobotBalanceVectorEnv(2)
    options = {} if high == 0.05 else {"low": low, "high": high}
    results = [env.reset(seed=7, options=options), envs.reset(seed=[1, 7], options=options)]
    drawn = np.random.default_rng(7).uniform(low, high, 4) + [np.pi, 0, 0, 0]
    assert (env.state == envs.state[1]).all() and np.abs(env.state - drawn).max() < 1e-6
    results += [env.step([-3.0]), envs.step([[0.0], [-3.0]])]
    for one, many in results[:2], results[2:]:
        assert np.abs(one[0] - many[0][1]).max() < 1e-6
    assert abs(results[2][1] - results[3][1][1]) < 1e-6


def test_no_state_ends_an_episode():
    """It falls."""
    env = gymnasium.make(BALANCE)
    env.reset(seed=1)
    steps = [env.step([0.0]) for _ in range(500)]
    assert not any(step[2] for step in steps) and min(step[1] for step in steps) < 0.5
    with pytest.raises(ValueError, match="gymnasium_episodes must be False"):
        AcrobotBalanceVectorEnv(gymnasium_episodes=True)
