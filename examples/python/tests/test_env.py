"""The single environment passes Gymnasium's own checks, and rejects what Gymnasium's environment rejects."""

import copy
import itertools
import pickle
import unittest.mock

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from gymnasium.error import InvalidAction
from gymnasium.utils.env_checker import check_env

V1, V0 = "acrobot_rs/Acrobot-v1", "acrobot_rs/Acrobot-v0"


@pytest.fixture
def env():
    """A single environment without wrappers, in an initial state."""
    env = acrobot_rs.AcrobotEnv()
    env.reset(seed=42)
    return env


def make(name, **kwargs):
    if name == V1:
        return gymnasium.make(name, **kwargs)
    with pytest.warns(DeprecationWarning, match="out of date"):  # because there is a v1
        return gymnasium.make(name, **kwargs)


@pytest.mark.parametrize("name", [V1, V0])
def test_gymnasium_checks_pass_without_a_warning(name):
    check_env(make(name, render_mode="rgb_array").unwrapped)


@pytest.mark.parametrize("base", [acrobot_rs.AcrobotEnv, acrobot_rs.AcrobotV0Env])
def test_the_observation_space_contains_initial_states_above_the_bounds_of_velocity(base):
    check_env(type("Slow", (base,), {"MAX_VEL_1": 1e-30, "MAX_VEL_2": 0.05})(), skip_render_check=True)


@pytest.mark.parametrize(("name", "limit"), [(V1, 500), (V0, 200)])
def test_episodes_are_truncated(name, limit):
    env = make(name)
    env.reset(seed=1)
    steps = 1
    while not env.step(1)[3]:
        steps += 1
    assert steps == limit


def test_spaces_and_registration_are_those_of_gymnasium():
    ours, theirs = gymnasium.make(V1), gymnasium.make("Acrobot-v1")
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    assert ours.spec.reward_threshold == theirs.spec.reward_threshold
    assert ours.metadata["render_fps"] == theirs.metadata["render_fps"]
    assert make(V0).observation_space.contains(np.float32([np.pi, np.pi, 4 * np.pi, 9 * np.pi]))


def test_frames(env):
    pictures = acrobot_rs.AcrobotEnv(render_mode="rgb_array")
    pictures.reset(seed=42)
    hanging = pictures.render()
    assert hanging.shape == (500, 500, 3) and hanging.dtype == np.uint8
    # Gymnasium's colour of a link: the first link hangs below the joint.
    assert list(hanging[300, 250]) == [0, 204, 204]
    pictures.state = [np.pi, 0, 0, 0]
    assert list(pictures.render()[200, 250]) == [0, 204, 204]

    texts = acrobot_rs.AcrobotEnv(render_mode="ansi")
    texts.reset(seed=42)
    assert len(texts.render().splitlines()) == 21

    with pytest.warns(UserWarning, match="without a render mode"):
        assert env.render() is None
    with pytest.raises(ValueError, match="render_mode must be None or one of .*, got 'human'"):
        acrobot_rs.AcrobotEnv(render_mode="human")


@pytest.mark.parametrize("action", [3, -1, 256, 2**70, 1.0, "1", None, np.array([1, 2])])
def test_invalid_actions_are_rejected(env, action):
    env.unwrapped.torque_noise_max = 0.5
    before, drawn = env.state, env.np_random.bit_generator.state
    with pytest.raises(InvalidAction, match=r"action must be 0 \(negative torque\), 1 \(none\) or 2 \(positive\), got "):
        env.step(action)
    assert (env.state == before).all()
    assert env.np_random.bit_generator.state == drawn


@pytest.mark.parametrize("action", [2, np.int64(2), np.uint8(2), np.array(2)])
def test_actions_can_be_integers_of_any_type(env, action):
    assert env.action_space.contains(2)
    env.step(action)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("dt", 0.0),
        ("dt", np.nan),
        ("LINK_MASS_1", -1.0),
        ("LINK_MOI", np.inf),
        ("MAX_VEL_2", 1e300),
        ("AVAIL_TORQUE", [0.0, 1.0, np.inf]),
        ("AVAIL_TORQUE", [0.0, 1.0]),
        ("torque_noise_max", -0.1),
        ("book_or_nips", "paper"),
        ("state", [0.0, 0.0, 0.0]),
        ("state", [0.0, 0.0, 0.0, np.nan]),
    ],
)
def test_invalid_values_are_rejected(env, name, value):
    before = np.copy(getattr(env, name))
    with pytest.raises(ValueError):
        setattr(env, name, value)
    assert (getattr(env, name) == before).all()


@pytest.mark.parametrize("torques", [{-1.0, 0.0, 1.0}, iter([-1.0, 0.0, 1.0]), itertools.repeat(0.0, 10**6)])
def test_torques_must_be_a_sequence(env, torques):
    """A set has no order, and an iterator may have no end."""
    with pytest.raises(TypeError):
        env.AVAIL_TORQUE = torques
    assert env.AVAIL_TORQUE == (-1.0, 0.0, 1.0)


def test_a_deleted_parameter_gets_the_value_of_the_class(env):
    twin = acrobot_rs.AcrobotEnv()
    twin.state = env.state
    with unittest.mock.patch.object(env, "dt", 0.05):
        assert env.dt == 0.05
    assert env.dt == 0.2
    assert (env.step(2)[0] == twin.step(2)[0]).all()
    with pytest.raises(AttributeError):
        del env.dt


@pytest.mark.parametrize(
    "options", [{"low": 1, "high": 0}, {"low": "x"}, {"high": None}, {"high": np.inf}, {"low": np.nan}]
)
def test_invalid_bounds_are_rejected(env, options):
    state, rng = env.state, env.np_random.bit_generator.state
    with pytest.raises(ValueError):
        env.reset(seed=1, options=options)
    assert (env.state == state).all() and env.np_random.bit_generator.state == rng


def test_the_first_step_needs_a_reset():
    env = acrobot_rs.AcrobotEnv()
    assert env.state is None
    with pytest.raises(AssertionError, match="reset"):
        env.step(0)


def test_the_state_is_read_only_and_set_as_a_whole(env):
    with pytest.raises(ValueError, match="read-only"):
        env.state[0] = 1.0
    env.state = np.array([0.1, 0.2, 0.3, 0.4])
    assert list(env.state) == [0.1, 0.2, 0.3, 0.4]


def test_every_parameter_has_an_effect():
    """Each changes a step or a picture, also if a subclass sets it."""
    changes = {
        "dt": 0.05,
        "LINK_LENGTH_1": 1.5,
        "LINK_MASS_1": 1.5,
        "LINK_MASS_2": 1.5,
        "LINK_COM_POS_1": 0.6,
        "LINK_COM_POS_2": 0.6,
        "LINK_MOI": 1.5,
        "MAX_VEL_1": 0.1,
        "MAX_VEL_2": 0.1,
        "AVAIL_TORQUE": [-5.0, 0.0, 5.0],
        "torque_noise_max": 0.5,
        "book_or_nips": "nips",
    }

    def after_a_step(env):
        env.reset(seed=3)
        env.state = [0.5, 1.0, 2.0, -1.0]
        env.step(2)
        return env.state.tobytes()

    plain = after_a_step(acrobot_rs.AcrobotEnv())
    for name, value in changes.items():
        env = acrobot_rs.AcrobotEnv()
        setattr(env, name, value)
        changed = after_a_step(env)
        assert changed != plain, name
        assert after_a_step(type("Changed", (acrobot_rs.AcrobotEnv,), {name: value})()) == changed, name

    env.AVAIL_TORQUE = [-2.0, 0.0, 2.0]
    with pytest.raises(TypeError):
        env.AVAIL_TORQUE[0] = 0.0  # assigning an element would have no effect

    pictures = acrobot_rs.AcrobotEnv("rgb_array")
    pictures.reset(seed=3)
    before = pictures.render()
    pictures.LINK_LENGTH_2 = 0.5
    assert (pictures.render() != before).any()


@pytest.mark.parametrize("again", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
@pytest.mark.parametrize("name", [V1, V0])
def test_copies_continue_bit_identically(name, again):
    env = make(name)
    env.unwrapped.torque_noise_max = 0.3
    env.unwrapped.book_or_nips = "nips"
    again(env)  # also before the first reset
    env.reset(seed=5)
    env.action_space.seed(5)
    for _ in range(150):
        env.step(env.action_space.sample())
    twin = again(env)

    def play(env):
        played = []
        for _ in range(400):
            observation, *signals, _ = env.step(env.action_space.sample())
            played.append((observation.tobytes(), env.unwrapped.state.tobytes(), *signals))
            if signals[1] or signals[2]:
                env.reset()
        return played

    assert play(env) == play(twin)


def test_damaged_snapshots_are_rejected(env):
    native = env._native
    good = native.__getstate__()
    not_finite = good.replace(env.state[:1].tobytes(), np.float64(np.nan).tobytes())
    for bad in [b"", good[:-1], good + b"\0", b"\xff" * len(good), not_finite]:
        with pytest.raises(ValueError, match="snapshot"):
            native.__setstate__(bad)
    with pytest.raises(ValueError, match="the snapshot's version must be 1, got 2"):
        native.__setstate__(b"\x02" + good[1:])
    assert native.__getstate__() == good
