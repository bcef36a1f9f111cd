"""dm_control's swing-up in Gymnasium: the steps of `tests/data/swingup.txt`, and Gymnasium's rules."""

import copy
import pickle
from pathlib import Path

import acrobot_rs
import gymnasium as gym
import numpy as np
import pytest
from acrobot_rs import AcrobotSwingupEnv, AcrobotSwingupVectorEnv, Uniform
from acrobot_rs._native import Acrobot, Batch
from gymnasium.error import InvalidAction, ResetNeeded
from gymnasium.utils.env_checker import check_env
from vectors import rejects

NAMES = ["acrobot_rs/AcrobotSwingup-v0", "acrobot_rs/AcrobotSwingupSparse-v0"]
BOTH = pytest.mark.parametrize("kind", [AcrobotSwingupEnv, AcrobotSwingupVectorEnv])
PARAMETERS = AcrobotSwingupEnv._NAMES
RECORDED = np.loadtxt(Path(__file__).parents[3] / "tests/data/swingup.txt")


def ours(states):
    """dm_control's states, whose angles are from upright."""
    return states + np.array([np.pi, 0.0, 0.0, 0.0])


@pytest.mark.parametrize("name", NAMES)
def test_steps_are_dm_controls(name):
    env = gym.make(name).unwrapped
    rewards = RECORDED[:, 15 if name == NAMES[0] else 16]
    for before, action, after, seen, expected in zip(
        ours(RECORDED[:, :4]),
        RECORDED[:, 4:5],
        ours(RECORDED[:, 5:9]),
        RECORDED[:, 9:15],
        rewards,
        strict=True,
    ):
        env.state = before
        observation, reward, terminated, truncated, _ = env.step(action)
        difference = env.state - after
        difference[:2] = (difference[:2] + np.pi) % (2 * np.pi) - np.pi
        assert np.abs(difference).max() < 1e-12
        assert np.abs(observation - seen).max() < 1e-6
        assert abs(reward - expected) < 1e-6
        assert not terminated and not truncated


def test_steps_in_float64_are_dm_controls():
    envs = AcrobotSwingupVectorEnv(num_envs=len(RECORDED), float64=True)
    envs.reset(seed=0)
    envs.state = ours(RECORDED[:, :4])
    envs.step(RECORDED[:, 4:5])
    difference = envs.state - ours(RECORDED[:, 5:9])
    difference[:, :2] = (difference[:, :2] + np.pi) % (2 * np.pi) - np.pi
    assert np.abs(difference).max() < 1e-12


@pytest.mark.parametrize("number", [float, np.float64, lambda x: np.float64(x).astype(">f8")])
def test_an_action_is_not_rounded(number):
    """dm_control 1.0.50 with MuJoCo 3.17.0 stepped so by 0.1, -0.7 and 1/3, which are no ``float32``."""
    env = AcrobotSwingupEnv()
    env.state = ours(np.array([0.3, -0.5, 0.7, -1.1]))
    for action in 0.1, -0.7, 1 / 3:
        env.step([number(action)])
    expected = ours(
        np.array([0.3243404730465862, -0.5419455946447316, 0.9135917678870124, -1.6651809763179526])
    )
    assert np.abs((env.state - expected + np.pi) % (2 * np.pi) - np.pi).max() < 1e-12


@pytest.mark.parametrize("name", NAMES)
def test_a_vector_environment_is_as_near(name):
    envs = gym.make_vec(name, num_envs=len(RECORDED))
    envs.reset(seed=1)
    envs.unwrapped.state = ours(RECORDED[:, :4])
    observations, rewards, terminated, truncated, _ = envs.step(RECORDED[:, 4:5])
    assert np.abs(observations - RECORDED[:, 9:15]).max() < 1e-5
    assert np.abs(rewards - RECORDED[:, 15 if name == NAMES[0] else 16]).max() < 1e-5
    assert not terminated.any() and not truncated.any()


def test_the_observation_space_contains_all_observations():
    envs = AcrobotSwingupVectorEnv(num_envs=1024, MAX_VEL_1=1e-3)
    envs.action_space.seed(1)
    for seed in range(300):
        assert envs.observation_space.contains(envs.reset(seed=seed)[0])
        assert envs.observation_space.contains(envs.step(envs.action_space.sample())[0])


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
    assert (
        (states[:, 2:] == 0).all()
        and np.abs(states[:, :2]).max() > 3.1
        and np.abs(states[:, :2]).max() <= np.float32(np.pi)
    )
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
        env.reset(options={"lo": 0.0})
    with pytest.raises(ValueError, match="render_mode must be"):
        acrobot_rs.AcrobotSwingupVectorEnv(render_mode="human")
    envs = acrobot_rs.AcrobotSwingupVectorEnv(2)
    envs.reset()
    with rejects(envs, InvalidAction, r"actions\[1\] must be a number from -1 to 1, got NaN"):
        envs.step([[0.0], [np.nan]])


def test_no_state_before_a_reset():
    env = AcrobotSwingupEnv()
    assert env.state is None
    env.reset(seed=1, options={"low": -0.2, "high": 0.1})
    assert (
        env.state.dtype == np.float64
        and (env.state[:2] >= -0.2).all()
        and (env.state[:2] <= 0.1).all()
    )
    env.state[2] = 3.0
    assert env.step([0.0])[0][4] == pytest.approx(3.0, abs=0.2)
    envs = AcrobotSwingupVectorEnv(500)
    envs.reset(seed=1, options={"low": -0.2, "high": 0.1})
    assert (
        -0.2 <= envs.state[:, :2].min() < -0.19
        and 0.09 < envs.state[:, :2].max() <= 0.1
        and not envs.state[:, 2:].any()
    )


@BOTH
@pytest.mark.parametrize(
    ("error", "arguments", "message"),
    [
        (ValueError, {"dt": 0.0}, "dt must be finite and above 0 s, got 0"),
        (
            ValueError,
            {"LINK_MOI_2": -1.0},
            "LINK_MOI_2 must be finite and at least 0 kg m², got -1",
        ),
        (
            ValueError,
            {"FRICTION_1": -1e-3},
            "FRICTION_1 must be finite and at least 0 N m s/rad, got -0.001",
        ),
        (TypeError, {"FRICTION_2": "x"}, "FRICTION_2 must be a number, got 'x'"),
        (TypeError, {"LINK_MOI": 1.0}, "LINK_MOI.*; did you mean LINK_MOI_[12]"),
        (TypeError, {"friction1": 1.0}, "friction1.*; did you mean FRICTION_1"),
        (TypeError, {"gymnasium_episodes": True}, "gymnasium_episodes"),
        (TypeError, {"autoresetmode": "NextStep"}, "autoresetmode"),
    ],
)
def test_wrong_parameters_are_rejected(kind, error, arguments, message):
    with pytest.raises(error, match=message):
        kind(**arguments)
    ((name, value),) = arguments.items()
    env = kind()
    with rejects(env, (error, AttributeError), message):
        setattr(env, name, value)
    if name not in ("gymnasium_episodes", "autoresetmode"):  # a subclass may have other attributes
        with pytest.raises((error, AttributeError), match=message):
            type("Changed", (kind,), {name: value})


@BOTH
def test_what_would_have_no_effect_is_rejected(kind):
    for name in "_get_ob", "_terminal", "_dsdt":
        with pytest.raises(TypeError, match=f"{name} would have no effect"):
            type("Changed", (kind,), {name: lambda self: None})
    assert not hasattr(kind(), "LINK_MOI")
    with pytest.raises(TypeError, match="autoreset_mode"):
        AcrobotSwingupEnv(autoreset_mode="NextStep")
    with pytest.warns(UserWarning, match="without a render mode"):
        env = kind()
        env.reset()
        assert env.render() is None


def test_the_default_parameters_are_those_of_rust():
    untouched = Acrobot(continuous=True, task="swingup")
    assert AcrobotSwingupEnv()._native.__getstate__() == untouched.__getstate__()
    envs = AcrobotSwingupVectorEnv(1)
    untouched = Batch(1, str(envs.np_random_seed), 1000, "NextStep", "swingup", True)
    assert envs._native.__getstate__() == untouched.__getstate__()


@pytest.mark.parametrize("name", PARAMETERS)
def test_each_parameter_changes_both_environments_alike(name):
    changed = {
        "book_or_nips": "nips",
        "AVAIL_TORQUE": [-1.0, 3.0, 0.5],
        "MAX_VEL_1": 1.0,
        "MAX_VEL_2": 1.0,
    }.get(name, 0.2)
    states = []
    for value in getattr(AcrobotSwingupEnv, name), changed:
        env, envs = AcrobotSwingupEnv(**{name: value}), AcrobotSwingupVectorEnv(3, **{name: value})
        assert (
            env.observation_space == envs.single_observation_space
            and env.action_space == envs.single_action_space
        )
        env.reset(seed=2)
        envs.reset(seed=2)
        for each, shape in (env, (4,)), (envs, (3, 4)):
            each.state = np.broadcast_to([1.0, 0.5, 2.0, -1.5], shape)
        for action in 0.6, -0.9, 0.3:
            env.step([action])
            envs.step([[action]] * 3)
        if name != "torque_noise_max":
            assert np.abs(envs.state - env.state).max() < 1e-5
        states.append(env.state)
        assert pickle.loads(pickle.dumps(env)).state.tobytes() == env.state.tobytes()
    # Neither the equations of motion nor the rewards of the recording contain it.
    assert (states[0] == states[1]).all() == (name == "LINK_LENGTH_2")


def test_actions_are_parts_of_the_largest_and_the_smallest_torque():
    env, twin = AcrobotSwingupEnv(AVAIL_TORQUE=[-1.0, 3.0]), AcrobotSwingupEnv()
    assert env.action_space == twin.action_space
    for action, torque in (
        (1.0, 3.0),
        (0.25, 0.75),
        (0.0, 0.0),
        (-0.5, -0.5),
        (-1.0, -1.0),
        (-np.inf, -1.0),
    ):
        twin.AVAIL_TORQUE = [-4.0, 4.0]
        env.state = twin.state = [1.0, 0.0, 0.0, 0.0]
        env.step([action])
        twin.step([torque / 4.0])
        assert (env.state == twin.state).all()
    env.AVAIL_TORQUE = [1.0, 3.0]
    env.state = twin.state = [1.0, 0.0, 0.0, 0.0]
    env.step([0.0])
    twin.step([1.0 / 4.0])
    assert (env.state == twin.state).all()


def test_resets_draw_parameters():
    names = ["FRICTION_1", "LINK_MOI_1", "LINK_MOI_2", "gravity"]
    envs = gym.make_vec(
        *(NAMES[0], 300), autoreset_mode="SameStep", max_episode_steps=2, info_parameters=names, copy=False,
        FRICTION_1=Uniform(0.0, 0.1), LINK_MOI_1=Uniform(0.05, 0.1), FRICTION_2=np.linspace(0, 0.1, 300),
        AVAIL_TORQUE=Uniform([-2.0, 0.0, 1.0], [-1.0, 0.0, 2.0]),
    )  # fmt: skip
    first = envs.reset(seed=1)[1]
    assert first["FRICTION_1"].min() < 0.01 and first["FRICTION_1"].max() > 0.09
    assert (
        first["LINK_MOI_1"].min() < 0.06
        and (first["LINK_MOI_2"] == AcrobotSwingupEnv.LINK_MOI_2).all()
    )
    assert (envs.get_parameter("FRICTION_2") == np.linspace(0, 0.1, 300)).all() and envs.get_attr(
        "dt"
    ) == (0.01,) * 300
    actions = envs.action_space.sample()
    assert envs.observation_space.contains(envs.step(actions)[0])
    last = envs.step(actions)[4]
    assert (last["final_info"]["FRICTION_1"] == first["FRICTION_1"]).all() and (
        last["FRICTION_1"] != first["FRICTION_1"]
    ).all()
    envs.set_attr("FRICTION_1", 0.3)
    assert envs.FRICTION_1 == 0.3 and envs.gravity == 9.81


def test_pictures():
    env = acrobot_rs.AcrobotSwingupEnv(render_mode="rgb_array")
    env.reset(seed=0)
    assert env.render().shape == (500, 500, 3)
    envs = acrobot_rs.AcrobotSwingupVectorEnv(num_envs=2, render_mode="ansi")
    envs.reset(seed=0)
    assert all(isinstance(text, str) for text in envs.render())
