"""Single and vector environments of all tasks with torques are alike."""

import acrobot_rs
import numpy as np
import pytest
from acrobot_rs import AcrobotEnv
from acrobot_rs._native import Acrobot

BOTH = pytest.mark.parametrize(
    ("kind", "many"),
    [
        [getattr(acrobot_rs, f"Acrobot{task}{kind}") for kind in ("Env", "VectorEnv")]
        for task in ("Continuous", "Swingup", "SwingupSparse", "Balance")
    ],
)


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


@BOTH
@pytest.mark.parametrize("name", AcrobotEnv._NAMES)
def test_each_parameter_changes_both_environments_alike(name, kind, many):
    """`test_dm_control.py` has the steps of single environments."""
    changes = {"book_or_nips": "nips", "AVAIL_TORQUE": [-0.5, 0.4, 0.2], "dt": 0.1, "ROTOR": 0.1}
    states = [[1.0, 0.5, 2.0, -1.5], [3.1, 0.02, 0.0, 0.0], [2.9, 0.1, 0.0, 1.0]]
    actions, all_states = np.float32([[0.6], [-0.9], [0.3]]), []
    for change in {}, {name: changes.get(name, 0.25)}:
        env, rows = kind(**change), []
        env.reset(seed=2)
        for env.state, action in zip(states, actions):
            rows.append([*env.step(action)[:3], env.state])
        *expected, expected_states = map(np.array, zip(*rows))
        all_states.append(expected_states)
        for float64, tolerance in (False, 2e-5), (True, 1e-12):
            envs = many(3, float64=float64, **change)
            assert env.observation_space == envs.single_observation_space
            assert env.action_space == envs.single_action_space
            envs.reset(seed=2)
            envs.state = states
            results = envs.step(actions)
            if name != "torque_noise_max":
                np.testing.assert_allclose(envs.state, expected_states, rtol=0, atol=tolerance)
                for found, each in zip(results, expected):
                    np.testing.assert_allclose(found, each, rtol=0, atol=2e-5)
    # Neither the equations of motion nor the rewards of the recording contain it.
    assert (all_states[0] == all_states[1]).all() == (name == "LINK_LENGTH_2")
