"""dm_control's swing-up in Gymnasium: the steps of `tests/data/swingup.txt`, and Gymnasium's rules."""

import copy
import pickle
from pathlib import Path

import acrobot_rs
import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import InvalidAction, ResetNeeded
from gymnasium.utils.env_checker import check_env
from vectors import rejects

NAMES = ["acrobot_rs/AcrobotSwingup-v0", "acrobot_rs/AcrobotSwingupSparse-v0"]
RECORDED = np.loadtxt(Path(__file__).parents[3] / "tests/data/swingup.txt")


def ours(states):
    """dm_control's states, whose angles are from upright."""
    return states + np.array([np.pi, 0.0, 0.0, 0.0])


@pytest.mark.parametrize("name", NAMES)
def test_steps_are_dm_controls(name):
    env = gym.make(name).unwrapped
    rewards = RECORDED[:, 15 if name == NAMES[0] else 16]
    for before, action, after, seen, expected in zip(
        ours(RECORDED[:, :4]), RECORDED[:, 4:5], ours(RECORDED[:, 5:9]), RECORDED[:, 9:15], rewards, strict=True
    ):
        env.state = before
        observation, reward, terminated, truncated, _ = env.step(action)
        difference = env.state - after
        difference[:2] = (difference[:2] + np.pi) % (2 * np.pi) - np.pi
        assert np.abs(difference).max() < 1e-12
        assert np.abs(observation - seen).max() < 1e-6
        assert abs(reward - expected) < 1e-6
        assert not terminated and not truncated


@pytest.mark.parametrize("name", NAMES)
def test_a_vector_environment_is_as_near(name):
    envs = gym.make_vec(name, num_envs=len(RECORDED))
    envs.reset(seed=1)
    envs.unwrapped.state = ours(RECORDED[:, :4])
    observations, rewards, terminated, truncated, _ = envs.step(RECORDED[:, 4:5])
    assert np.abs(observations - RECORDED[:, 9:15]).max() < 1e-5
    assert np.abs(rewards - RECORDED[:, 15 if name == NAMES[0] else 16]).max() < 1e-5
    assert not terminated.any() and not truncated.any()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.filterwarnings("ignore:.*infinity")
def test_gymnasiums_checks(name):
    check_env(gym.make(name).unwrapped, skip_render_check=True)
    assert gym.make(name).spec.max_episode_steps == 1000
    assert gym.make_vec(name, num_envs=3).single_action_space == gym.make(name).action_space


def test_episodes_begin_at_rest_anywhere_and_last_1000_steps():
    envs = acrobot_rs.AcrobotSwingupVectorEnv(num_envs=400, autoreset_mode="SameStep")
    envs.reset(seed=3)
    states = envs.state
    assert (states[:, 2:] == 0).all() and np.abs(states[:, :2]).max() > 3.1 and np.abs(states[:, :2]).max() <= np.float32(np.pi)
    assert np.abs(states[:, :2].mean(axis=0)).max() < 0.4
    env = gym.make(NAMES[0])
    env.reset(seed=3)
    assert (env.unwrapped.state[2:] == 0).all()
    for step in range(1, 1001):
        *_, truncated, infos = envs.step(np.ones((400, 1)))
        assert truncated.all() == truncated.any() == (step == 1000)
        assert env.step([1.0])[3] == (step == 1000)
    assert infos["final_obs"][0].shape == (6,) and (envs.elapsed_steps == 0).all()


def test_seeds_and_copies_repeat():
    def play(envs, steps):
        actions = np.random.default_rng(0).uniform(-1, 1, (steps, envs.num_envs, 1))
        return [envs.step(each)[0] for each in actions]

    many, few = (acrobot_rs.AcrobotSwingupVectorEnv(num_envs=count) for count in (5, 3))
    many.reset(seed=7)
    few.reset(seed=7, options={"reset_mask": np.ones(3, bool)})
    assert (many.state[:3] == few.state).all()
    few.reset(seed=[1, 2, 3])
    angles = [np.random.default_rng(seed).uniform(-np.pi, np.pi, 2) for seed in (1, 2, 3)]
    assert np.allclose(few.state[:, :2], angles, atol=1e-5)
    play(many, 20)
    twins = [copy.deepcopy(many), pickle.loads(pickle.dumps(many))]
    expected = play(many, 10)
    for twin in twins:
        assert np.array_equal(play(twin, 10), expected)


def test_an_action_beyond_1_acts_as_1():
    env = acrobot_rs.AcrobotSwingupEnv()
    states = []
    for action in 1.0, 5.0, np.inf:
        env.state = [1.0, 0.0, 0.0, 0.0]
        env.step([action])
        states.append(env.state)
    assert np.array_equal(states[0], states[1]) and np.array_equal(states[0], states[2])


def test_wrong_input_is_rejected():
    env = acrobot_rs.AcrobotSwingupEnv()
    with pytest.raises(ResetNeeded, match="call reset"):
        env.step([0.0])
    env.reset(seed=0)
    for action in 0.5, [0.5, 0.5], [np.nan], ["x"]:
        with rejects(env, InvalidAction, "action must be"):
            env.step(action)
    for state in [1.0, 2.0], [np.nan, 0.0, 0.0, 0.0]:
        with rejects(env, ValueError, "finite"):
            env.state = state
    with rejects(env, ValueError, "keys of options"):
        env.reset(options={"low": 0.0})
    with pytest.raises(ValueError, match="render_mode must be"):
        acrobot_rs.AcrobotSwingupEnv(render_mode="human")


def test_pictures():
    env = acrobot_rs.AcrobotSwingupEnv(render_mode="rgb_array")
    env.reset(seed=0)
    assert env.render().shape == (500, 500, 3)
    envs = acrobot_rs.AcrobotSwingupVectorEnv(num_envs=2, render_mode="ansi")
    envs.reset(seed=0)
    assert all(isinstance(text, str) for text in envs.render())
