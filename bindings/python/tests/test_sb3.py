"""The adapter for Stable-Baselines3 does what its DummyVecEnv does.

Without Stable-Baselines3, which takes 5 GB, a base class stands in, and one test is skipped.
"""

import importlib.util
import sys
import types
import unittest.mock

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from vectors import rejects

HAS_SB3 = importlib.util.find_spec("stable_baselines3") is not None


class VecEnv:
    """What the adapter uses of Stable-Baselines3 2.9's VecEnv."""

    def __init__(self, num_envs, observation_space, action_space):
        self.num_envs = num_envs
        self.observation_space, self.action_space = observation_space, action_space
        self._reset_seeds()
        self._reset_options()
        self.render_mode = self.get_attr("render_mode")[0]

    def _reset_seeds(self):
        self._seeds = [None] * self.num_envs

    def _reset_options(self):
        self._options = [{} for _ in range(self.num_envs)]

    def _get_indices(self, indices):
        all_or_some = range(self.num_envs) if indices is None else indices
        return [indices] if isinstance(indices, int) else all_or_some

    def seed(self, seed):
        self._seeds = [seed + index for index in range(self.num_envs)]
        return self._seeds

    def set_options(self, options):
        is_one = isinstance(options, dict)
        self._options = [options] * self.num_envs if is_one else options

    def step(self, actions):
        self.step_async(actions)
        return self.step_wait()


if HAS_SB3:
    from acrobot_rs.sb3 import AcrobotVecEnv
else:
    stand_in = {"stable_baselines3.common.vec_env": types.SimpleNamespace(VecEnv=VecEnv)}
    with unittest.mock.patch.dict(sys.modules, stand_in):  # only for this import
        from acrobot_rs.sb3 import AcrobotVecEnv


def make(num_envs, **kwargs):
    return AcrobotVecEnv(acrobot_rs.AcrobotVectorEnv(num_envs, autoreset_mode="SameStep", **kwargs))


def test_the_swing_up_is_taken_too():
    envs = AcrobotVecEnv(acrobot_rs.AcrobotSwingupVectorEnv(2, 3, autoreset_mode="SameStep"))
    envs.reset()
    envs.set_attr("FRICTION_1", 0.2, 1)
    assert envs.get_attr("FRICTION_1") == [0.05, 0.2]
    ends = [envs.step(np.ones((2, 1)))[2].tolist() for _ in range(3)]
    assert ends == [[False] * 2] * 2 + [[True] * 2]


def test_steps_are_those_of_the_vector_environment():
    """With the infos of DummyVecEnv."""
    envs = make(8, max_episode_steps=90)
    twin = acrobot_rs.AcrobotVectorEnv(8, 90, autoreset_mode="SameStep")
    assert envs.seed(5) == list(range(5, 13))
    envs.set_options({"low": -0.5})
    assert (envs.reset() == twin.reset(seed=list(range(5, 13)), options={"low": -0.5})[0]).all()
    assert (envs.reset() == twin.reset()[0]).all(), "seeds and options count once"
    ends = np.zeros(2, int)
    observations, _ = envs.reset(), twin.reset()
    for _ in range(400):
        actions = np.where(observations[:, 4] > 0, 0, 2)
        found = envs.step(actions)
        observations, rewards, terminated, truncated, last = twin.step(actions)
        ended = terminated | truncated
        infos = [{"TimeLimit.truncated": each} for each in truncated & ~terminated]
        for i in np.flatnonzero(ended):
            infos[i]["terminal_observation"] = last["final_obs"][i]
        np.testing.assert_equal(found, (observations, rewards, ended, infos))
        assert found[1].dtype == np.float32
        ends += terminated.sum(), truncated.sum()
    assert (ends > 5).all()


def test_an_episode_that_reaches_the_goal_at_the_limit_is_not_truncated():
    envs = make(2, max_episode_steps=1)
    envs.reset()
    envs.set_attr("state", np.array([np.pi, 0.0, 0.0, 0.0]), indices=0)
    _, rewards, ended, infos = envs.step(np.array([1, 1]))
    assert list(ended) == [True, True] and list(rewards) == [0.0, -1.0]
    assert infos[0]["TimeLimit.truncated"] is False and infos[1]["TimeLimit.truncated"] is True


@pytest.mark.skipif(not HAS_SB3, reason="needs stable-baselines3")
def test_gymnasium_s_episodes_are_those_of_dummy_vec_env():
    """Also under VecMonitor."""
    from stable_baselines3.common.vec_env import DummyVecEnv, VecMonitor

    theirs = DummyVecEnv([lambda: gymnasium.make("Acrobot-v1", max_episode_steps=70)] * 8)
    ours = make(8, max_episode_steps=70, gymnasium_episodes=True)
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    theirs, ours = VecMonitor(theirs), VecMonitor(ours)
    for envs in (theirs, ours):
        envs.seed(5)
    observations = theirs.reset()
    assert (ours.reset() == observations).all()
    for _ in range(500):
        actions = np.where(observations[:, 4] > 0, 0, 2)
        expected, found = theirs.step(actions), ours.step(actions)
        observations = expected[0]
        for info in (*expected[3], *found[3]):
            info.get("episode", {}).pop("t", None)  # the time
        np.testing.assert_equal(found, expected)
        assert [each.dtype for each in found[:3]] == [each.dtype for each in expected[:3]]


def test_attributes_and_methods():
    envs = make(3, render_mode="rgb_array")
    envs.reset()
    for indices, count in ((None, 3), (1, 1), ([0, 2], 2)):
        assert envs.get_attr("dt", indices) == [0.2] * count
    envs.set_attr("dt", 0.1)
    assert envs.get_attr("dt") == [0.1] * 3
    before = envs.get_attr("state")
    envs.set_attr("state", np.array([1.0, 2.0, 3.0, 4.0]), indices=[1])
    after = envs.get_attr("state")
    np.testing.assert_array_equal(after, [before[0], [1.0, 2.0, 3.0, 4.0], before[2]])
    envs.set_attr("dt", 0.2, indices=0)
    envs.set_attr("AVAIL_TORQUE", [-2.0, 0.0, 2.0], indices=[0, 2])
    assert envs.get_attr("dt") == [0.2, 0.1, 0.1]
    envs.set_attr("MAX_VEL_1", 5.0)
    assert envs.observation_space.high[4] == 5.0, "spaces follow the parameters"
    assert envs.get_attr("AVAIL_TORQUE") == [(-2.0, 0.0, 2.0), (-1.0, 0.0, 1.0), (-2.0, 0.0, 2.0)]
    with pytest.raises(AttributeError):
        envs.get_attr("length")
    assert envs.env_is_wrapped(gymnasium.Wrapper) == [False] * 3
    assert envs.env_is_wrapped(gymnasium.Wrapper, 0) == [False]
    [frame] = envs.env_method("render", indices=2)
    assert (frame == envs.get_images()[2]).all() and frame.shape == (500, 500, 3)
    if HAS_SB3:
        assert envs.render().shape == (1000, 1000, 3)
    envs.set_options([{"low": -0.5}, {}, {}])
    with pytest.raises(ValueError, match="options must be the same"):
        envs.reset()
    envs.close()
    with pytest.raises(gymnasium.error.ClosedEnvironmentError):
        envs.step(np.zeros(3, int))


def test_a_range_is_for_all_environments():
    """Another value in one environment would end the draws of the others."""
    envs, drawn = make(3), acrobot_rs.Uniform(0.1, 0.3)
    message = "dt must be set in all environments, if it is or will be drawn, got"
    for indices in (None, [0, 1, -1]):
        envs.set_attr("dt", drawn, indices=indices)
        envs.reset()
        assert envs.envs.dt == drawn and len(set(envs.get_attr("dt"))) == 3
        for value, some in [(0.3, [0]), (0.3, 1), (drawn, [0]), (drawn, [0, 2])]:
            with rejects(envs.envs, ValueError, message):
                envs.set_attr("dt", value, indices=some)
        envs.set_attr("dt", 0.3, indices=[])
        assert envs.envs.dt == drawn
        envs.set_attr("dt", 0.2, indices=indices)
        assert envs.envs.dt == 0.2 and envs.get_attr("dt") == [0.2] * 3
    with pytest.raises(ValueError, match=message):
        envs.set_attr("dt", drawn, indices=[0])
    with pytest.raises(IndexError):
        envs.set_attr("dt", 0.1, indices=[3])


def test_infos_have_the_parameters_of_the_episode():
    envs = make(3, max_episode_steps=2, dt=acrobot_rs.LogUniform(0.1, 0.3), info_parameters=["dt"])
    envs.reset()
    for ended in (False, True):
        before = envs.get_attr("dt")
        infos = envs.step(np.ones(3, int))[3]
        assert [info["dt"] for info in infos] == before
        assert (envs.get_attr("dt") != before) == ended


def test_misuse_is_rejected():
    with pytest.raises(ValueError, match='autoreset_mode must be "SameStep", got "NextStep"'):
        AcrobotVecEnv(acrobot_rs.AcrobotVectorEnv(2))
    with pytest.raises(TypeError, match="needs an AcrobotVectorEnv .*, got TimeLimit"):
        AcrobotVecEnv(gymnasium.make("acrobot_rs/Acrobot-v1"))
    envs = make(2)
    envs.reset()
    for _ in range(2):
        with rejects(envs.envs, gymnasium.error.NoAsyncCallError, "call step_async with the act"):
            envs.step_wait()
        envs.step([0, 1])
