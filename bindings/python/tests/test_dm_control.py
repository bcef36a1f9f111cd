"""`acrobot_rs.dm_control` plays dm_control's episodes: `tests/data/swingup.txt`, with its seed."""

from pathlib import Path

import numpy as np
import pytest

dm_env = pytest.importorskip("dm_env")
from absl.testing import absltest
from acrobot_rs import dm_control
from dm_env import test_utils

RECORDED = np.loadtxt(Path(__file__).parents[3] / "tests/data/swingup.txt")
SWINGUP = "acrobot", "swingup", None
TIMESTEP = {"control_timestep": 0.015}


def ours(states):
    """dm_control's states, whose angles are from upright."""
    return states + np.array([np.pi, 0.0, 0.0, 0.0])


@pytest.mark.parametrize(("task", "column"), [("swingup", 15), ("swingup_sparse", 16)])
def test_episodes_are_dm_controls(task, column):
    """From the same seed. Every other one of the recording begins in a state that was set."""
    env, flat = (
        dm_control.load("acrobot", task, {"random": 1}, {"flat_observation": is_flat})
        for is_flat in (False, True)
    )
    for episode in range(10):
        assert env.reset().first() and flat.reset().first()
        rows = RECORDED[100 * episode :][:100]
        if episode % 2:
            env.gymnasium.state = flat.gymnasium.state = ours(rows[0, :4])
        assert np.abs(env.gymnasium.state - ours(rows[0, :4])).max() < 1e-15
        for row in rows:
            step, seen = env.step(row[4:5]), flat.step(row[4]).observation["observations"]
            assert step.mid() and step.discount == 1.0
            assert np.abs(seen - row[9:15]).max() < 1e-11
            assert (np.concatenate([*step.observation.values()]) == seen).all()
            assert abs(step.reward - row[column]) < 1e-6


def test_a_step_after_the_time_limit_resets():
    env = dm_control.load("acrobot", "swingup")
    assert [int(env.step(0.0).step_type) for _ in range(1002)] == [0, *[1] * 999, 2, 0]
    short = dm_control.load("acrobot", "swingup", {"time_limit": 0.05}, {"dt": 0.025})
    steps = [short.step(0.0) for _ in range(4)]
    assert [step.step_type for step in steps] == [0, 1, 2, 0] and steps[2].discount == 1.0
    assert short.control_timestep() == 0.025


@pytest.mark.parametrize("options", [{"n_sub_steps": 3}, {"control_timestep": 0.03}])
def test_a_step_can_last_longer(options):
    kwargs = {"random": 3, "time_limit": 0.06}
    env, twin = (dm_control.load(*SWINGUP[:2], kwargs, each) for each in (options, None))
    assert env.reset().first() and twin.reset().first() and env.control_timestep() == 0.03
    for action in 0.5, -0.7:
        step, [*_, expected] = env.step(action), [twin.step(action) for _ in range(3)]
        assert step[:2] == expected[:2] and (env.gymnasium.state == twin.gymnasium.state).all()


@pytest.mark.parametrize(
    ("message", "arguments"),
    [
        ("domain_name must be .*, got 'reacher'", ["reacher", "swingup"]),
        ("task_name must be one of .*, got 'balance'", ["acrobot", "balance"]),
        ("time_limit must be above 0 s", ["acrobot", "swingup", {"time_limit": 0}]),
        ("legacy_step must be True", [*SWINGUP, {"legacy_step": False}]),
        ("n_sub_steps must be None", [*SWINGUP, {"n_sub_steps": 1, **TIMESTEP}]),
        ("control_timestep / dt must be .*, got 1.5", [*SWINGUP, TIMESTEP]),
    ],
)
def test_invalid_arguments_are_rejected(message, arguments):
    with pytest.raises(ValueError, match=message):
        dm_control.load(*arguments)


class TestInterface(test_utils.EnvironmentTestMixin, absltest.TestCase):
    """dm_env's own checks."""

    def make_object_under_test(self):
        return dm_control.load("acrobot", "swingup", {"time_limit": 1}, {"DAMPING_1": 0.1})
