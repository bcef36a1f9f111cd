"""The adapter for Stable-Baselines3 does what its DummyVecEnv does.

Torch, which Stable-Baselines3 imports and which takes 5 GB, is not necessary: ``pip install
--no-deps stable-baselines3``.
"""

import importlib.util
import sys
import types
import unittest.mock
from pathlib import Path

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from vectors import rejects

if (SPEC := importlib.util.find_spec("stable_baselines3")) is None:
    pytest.skip("needs stable-baselines3", allow_module_level=True)
# Packages that import nothing, and instead of torch an object that nothing calls.
PACKAGES = [".".join(["stable_baselines3", "common", "vec_env"][:count]) for count in (1, 2, 3)]
for package in PACKAGES:
    sys.modules[package] = types.ModuleType(package)
    sys.modules[package].__path__ = [str(Path(SPEC.origin).parents[1] / package.replace(".", "/"))]
with unittest.mock.patch.dict(sys.modules):
    sys.modules["torch"] = sys.modules["torch.nn"] = unittest.mock.MagicMock()
    from stable_baselines3.common.vec_env.base_vec_env import VecEnv
    from stable_baselines3.common.vec_env.dummy_vec_env import DummyVecEnv
    from stable_baselines3.common.vec_env.vec_monitor import VecMonitor

    names = {"VecEnv": VecEnv, "DummyVecEnv": DummyVecEnv, "SubprocVecEnv": None}
    vars(sys.modules[PACKAGES[-1]]).update(names)
    from acrobot_rs.sb3 import AcrobotVecEnv
    from stable_baselines3.common import env_util, monitor  # noqa: F401 others import them later

    LOADED = {name: each for name, each in sys.modules.items() if PACKAGES[0] in name}
sys.modules.update(LOADED)


def make(num_envs, **kwargs):
    return AcrobotVecEnv(acrobot_rs.AcrobotVectorEnv(num_envs, autoreset_mode="SameStep", **kwargs))


def test_an_episode_that_reaches_the_goal_at_the_limit_is_not_truncated():
    envs = make(2, max_episode_steps=1)
    envs.reset()
    envs.set_attr("state", np.array([np.pi, 0.0, 0.0, 0.0]), indices=0)
    _, rewards, ended, infos = envs.step(np.array([1, 1]))
    assert list(ended) == [True, True] and list(rewards) == [0.0, -1.0]
    assert infos[0]["TimeLimit.truncated"] is False and infos[1]["TimeLimit.truncated"] is True


class Settable(gymnasium.Wrapper):
    """``set_attr`` of DummyVecEnv sets the wrapped environment's parameters."""

    SETTINGS = "dt", "LINK_MASS_1", "book_or_nips", "torque_noise_max"

    def __setattr__(self, name, value):
        if name in self.SETTINGS:
            setattr(self.unwrapped, name, value)
        else:
            super().__setattr__(name, value)


def outcome(call, envs):
    """What a call returns, or the type of its error."""
    try:
        result = call(envs)
    except Exception as error:
        return type(error)
    for info in result[3] if isinstance(result, tuple) else ():
        info.get("episode", {}).pop("t", None)  # the time
    return result


def test_attributes_and_methods_are_those_of_dummy_vec_env():
    """With Gymnasium's episodes, after random calls. The adapter's docstring names the others."""
    limit = {"max_episode_steps": 70}
    theirs = DummyVecEnv([lambda: Settable(gymnasium.make("Acrobot-v1", **limit))] * 5)
    ours = make(5, gymnasium_episodes=True, **limit)
    names = "action_space", "num_envs", "observation_space", "render_mode", "reset_infos"
    both = VecMonitor(theirs), VecMonitor(ours)

    def compare(call):
        expected, found = (outcome(call, envs) for envs in both)
        assert type(found) is type(expected)
        np.testing.assert_equal(found, expected)
        for each in (*names, "_seeds", "_options"):
            np.testing.assert_equal(getattr(ours, each), getattr(theirs, each), each)
        return expected

    def step(envs):
        """The parts of a step, and then the types of its arrays."""
        envs.step_async(actions)
        results = envs.step_wait()
        return *results, [each.dtype for each in results[:3]]

    rng, ends = np.random.default_rng(1), 0
    compare(lambda envs: envs.seed(5))
    observations = compare(lambda envs: envs.reset())
    for _ in range(500):
        actions = np.where(observations[:, 4] > 0, 0, 2)
        observations, _, ended, *_ = compare(step)
        ends += ended.sum()
        number = rng.uniform(0.1, 0.2)
        indices = [None, 3, -1, [0, 2], np.array([1, 4]), range(2), [], 5, [-6]]
        some = indices[rng.integers(len(indices))]
        attribute = ["dt", "book_or_nips", "render_mode", "action_space"][rng.integers(4)]
        calls = [
            ("seed", int(number * 1e9)),
            ("set_options", {"low": -number}),
            ("reset",),
            *(("set_attr", each, "nips" if each == "book_or_nips" else number, some)
              for each in Settable.SETTINGS),
            *(("get_attr", attribute, some), ("get_attr", "length"), ("env_method", "length")),
            *(("has_attr", each) for each in (attribute, "state", "spec", "length")),
            ("env_is_wrapped", gymnasium.wrappers.RecordVideo, some),
            ("get_images",), ("render",), ("render", "rgb_array"),  # without a mode they warn
        ]  # fmt: skip
        if rng.random() < 0.3:
            method, *given = calls[rng.integers(len(calls))]
            result = compare(lambda envs: getattr(envs, method)(*given))  # noqa: B023
            observations = result if method == "reset" else observations
    assert ends > 10


def test_what_dummy_vec_env_does_otherwise():
    envs = make(3, render_mode="rgb_array")
    envs.reset()
    [frame] = envs.env_method("render", indices=2)
    assert (frame == envs.get_images()[2]).all() and frame.shape == (500, 500, 3)
    envs.set_attr("AVAIL_TORQUE", [-2.0, 0.0, 2.0], indices=[0, 2])
    assert envs.get_attr("AVAIL_TORQUE") == [(-2.0, 0.0, 2.0), (-1.0, 0.0, 1.0), (-2.0, 0.0, 2.0)]
    envs.set_attr("MAX_VEL_1", 5.0)
    assert envs.observation_space.high[4] == 5.0, "spaces follow the parameters"
    envs.set_options([{"low": -0.5}, {}, {}])
    with pytest.raises(ValueError, match="options must be the same for all .*, got"):
        envs.reset()


def test_a_range_is_for_all_environments():
    """Another value in one environment would end the draws of the others."""
    envs, drawn = make(3), acrobot_rs.Uniform(0.1, 0.3)
    message = "dt must be set in all environments, if it is or will be drawn, got"
    for indices in (None, [0, 1, -1]):
        with pytest.raises(ValueError, match=message):
            envs.set_attr("dt", drawn, indices=[0])
        envs.set_attr("dt", drawn, indices=indices)
        assert envs.envs.dt == drawn
        with rejects(envs.envs, ValueError, message):
            envs.set_attr("dt", 0.3, indices=1)
        envs.set_attr("dt", 0.3, indices=[])
        assert envs.envs.dt == drawn
        envs.set_attr("dt", 0.2, indices=indices)
        assert envs.envs.dt == 0.2


def test_other_environments_are_rejected():
    with pytest.raises(ValueError, match='autoreset_mode must be "SameStep", got "NextStep"'):
        AcrobotVecEnv(acrobot_rs.AcrobotVectorEnv(2))
    with pytest.raises(TypeError, match="envs must be an AcrobotVectorEnv, got TimeLimit"):
        AcrobotVecEnv(gymnasium.make("acrobot_rs/Acrobot-v1"))
