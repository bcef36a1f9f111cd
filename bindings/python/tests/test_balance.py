"""The task to stay upright. The program `bits` compares its bits in Rust."""

import numpy as np
import pytest
from acrobot_rs import AcrobotBalanceEnv, AcrobotBalanceVectorEnv


@pytest.mark.parametrize(("bound", "options"), [(0.05, {}), (0.2, {"low": -0.2, "high": 0.2})])
def test_episodes_begin_near_upright_alone_and_among_many(bound, options):
    env, envs = AcrobotBalanceEnv(), AcrobotBalanceVectorEnv(2)
    one, many = env.reset(seed=7, options=options), envs.reset(seed=[1, 7], options=options)
    drawn = np.random.default_rng(7).uniform(-bound, bound, 4) + [np.pi, 0, 0, 0]
    assert (env.state == envs.state[1]).all() and np.abs(env.state - drawn).max() < 1e-6
    assert np.abs(one[0] - many[0][1]).max() < 1e-6
    one, many = env.step([-3.0]), envs.step([[0.0], [-3.0]])
    assert np.abs(np.append(one[0] - many[0][1], one[1] - many[1][1])).max() < 1e-6
