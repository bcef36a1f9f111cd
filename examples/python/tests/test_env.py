"""The single environment passes Gymnasium's own checks, and rejects what Gymnasium's environment rejects."""

import collections
import copy
import pickle
import sys
import unittest.mock

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from gymnasium.error import InvalidAction
from gymnasium.utils.env_checker import check_env

V1, V0, CONTINUOUS = "acrobot_rs/Acrobot-v1", "acrobot_rs/Acrobot-v0", "acrobot_rs/AcrobotContinuous-v0"


@pytest.fixture
def env():
    """A single environment without wrappers, in an initial state."""
    env = acrobot_rs.AcrobotEnv()
    env.reset(seed=42)
    return env


def make(name, **kwargs):
    if name != V0:
        return gymnasium.make(name, **kwargs)
    with pytest.warns(DeprecationWarning, match="out of date"):  # because there is a v1
        return gymnasium.make(name, **kwargs)


@pytest.mark.parametrize("name", [V1, V0, CONTINUOUS])
def test_gymnasium_checks_pass_without_a_warning(name, monkeypatch):
    monkeypatch.setitem(sys.modules, "pygame", unittest.mock.MagicMock())  # the check opens a window
    check_env(make(name, render_mode="rgb_array").unwrapped)


@pytest.mark.parametrize("base", [acrobot_rs.AcrobotEnv, acrobot_rs.AcrobotV0Env])
def test_the_observation_space_contains_initial_states_above_the_bounds_of_velocity(base):
    check_env(type("Slow", (base,), {"MAX_VEL_1": 1e-30, "MAX_VEL_2": 0.05})(), skip_render_check=True)


def test_registration_and_spaces_are_those_of_gymnasium():
    ours, theirs = gymnasium.make(V1), gymnasium.make("Acrobot-v1")
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    assert ours.metadata["render_fps"] == theirs.metadata["render_fps"]
    for name, limit in [(V1, 500), (V0, 200), (CONTINUOUS, 500)]:
        env = make(name)
        assert env.spec.reward_threshold == theirs.spec.reward_threshold
        env.reset(seed=1)
        ends = [env.step([0.0] if name == CONTINUOUS else 1)[3] for _ in range(limit)]
        assert ends == [False] * (limit - 1) + [True]
    assert make(V0).observation_space.contains(np.float32([np.pi, np.pi, 4 * np.pi, 9 * np.pi]))


def test_pictures(env):
    pictures = acrobot_rs.AcrobotEnv(render_mode="rgb_array")
    pictures.reset(seed=42)
    hanging = pictures.render()
    assert hanging.shape == (500, 500, 3) and hanging.dtype == np.uint8
    # Gymnasium's colour of a link: the first link hangs below the joint.
    assert list(hanging[300, 250]) == [0, 204, 204]
    pictures.LINK_LENGTH_2 = 0.5
    assert (pictures.render() != hanging).any()
    pictures.state = [np.pi, 0, 0, 0]
    assert list(pictures.render()[200, 250]) == [0, 204, 204]

    texts = acrobot_rs.AcrobotEnv(render_mode="ansi")
    texts.reset(seed=42)
    assert len(texts.render().splitlines()) == 21

    with pytest.warns(UserWarning, match="without a render mode"):
        assert env.render() is None
    with pytest.warns(UserWarning, match="render_mode='text' that is not in the possible render_modes"):
        unknown = gymnasium.make(V1, render_mode="text")
    assert unknown.render_mode == "text"
    unknown.reset()
    with pytest.raises(ValueError, match='render_mode must be .*, got "text"'):
        unknown.unwrapped.render()


def test_a_window_shows_each_reset_and_step(monkeypatch):
    """Without a display: pygame is replaced by an object that records the calls."""
    monkeypatch.setitem(sys.modules, "pygame", None)
    with pytest.raises(gymnasium.error.DependencyNotInstalled, match="pygame is not installed"):
        acrobot_rs.AcrobotEnv("human").reset()

    env = gymnasium.make(V1, render_mode="human")  # with Gymnasium's wrapper for windows this would warn

    pygame = unittest.mock.MagicMock()
    pygame.display.set_mode.return_value = window = object()
    monkeypatch.setitem(sys.modules, "pygame", pygame)
    picture = acrobot_rs.AcrobotEnv("rgb_array")
    shown = pygame.surfarray.blit_array
    env.reset(seed=1)
    for calls in range(1, 5):
        assert shown.call_count == pygame.display.flip.call_count == calls
        picture.state = env.unwrapped.state
        assert shown.call_args[0][0] is window
        assert (shown.call_args[0][1] == picture.render().swapaxes(0, 1)).all()
        env.step(2)
    assert env.render() is None and shown.call_count == 6
    pygame.display.set_mode.assert_called_once_with((500, 500))
    pygame.time.Clock.return_value.tick.assert_called_with(15)
    twin = copy.deepcopy(env).unwrapped
    assert twin.screen is None
    twin.render_mode = None
    twin.step(0)
    assert shown.call_count == 6
    env.close()
    assert pygame.quit.called and env.unwrapped.screen is None and not env.unwrapped.isopen


DISCRETE = "action must be an integer from 0 to 2, got "
TORQUE = r"action must be a torque in N m, as an array of shape \(1,\), got "


@pytest.mark.parametrize(
    ("kind", "message", "action"),
    [*((acrobot_rs.AcrobotEnv, DISCRETE, action) for action in (
        3, -1, 256, 2**70, np.array([1]), np.array([1, 2]), [1], np.True_, np.array(True), np.timedelta64(1), iter([1]))),
     *((acrobot_rs.AcrobotContinuousEnv, TORQUE, action) for action in (
        1, np.float32(1.0), ["1"], [], [1.0, 1.0], [[1.0]], [None], [np.nan], np.float32([np.nan]), np.zeros((1, 1), np.float32),
        np.zeros(2, np.float32), np.zeros(0, np.float32), np.zeros((), np.float32), {0: 0.5}, collections.UserDict({0: 0.5}),
        [True], np.array([True]), [1j], np.array([1j]), np.array(["0.5"]), np.array([0.5], object), np.array([1], "m8[s]"),
        [10**400], [[1], [2, 3]])),
     *((kind, message, action) for kind, message in (
        (acrobot_rs.AcrobotEnv, DISCRETE), (acrobot_rs.AcrobotContinuousEnv, TORQUE)) for action in (
        1.0, "1", None, b"\1", bytearray(b"\1"), {1}, {1: 1}, 1j, iter([0.5])))],
)  # fmt: skip
def test_invalid_actions_are_rejected(kind, message, action):
    env = kind()
    env.torque_noise_max = 0.5
    env.reset(seed=1)
    before = pickle.dumps(env)
    with pytest.raises(InvalidAction, match=message):
        env.step(action)
    assert pickle.dumps(env) == before


@pytest.mark.parametrize("action", [2, np.int64(2), np.uint8(2), np.array(2)])
def test_actions_can_be_integers_of_any_type(env, action):
    env.step(action)


@pytest.mark.parametrize(
    ("options", "message"),
    [({"low": 1, "high": 0}, "low"), ({"low": "x"}, "An option"), ({"high": None}, "An option"),
     ({"high": np.inf}, "high"), ({"low": np.nan}, "low"),
     *(({key: -0.2}, rf"the keys of options must be among \['low', 'high'\], got '{key}'") for key in ("lo", "reset_mask"))],
)  # fmt: skip
def test_invalid_options_are_rejected(env, options, message):
    state, rng = env.state, env.np_random.bit_generator.state
    with pytest.raises(ValueError, match=message):
        env.reset(seed=1, options=options)
    assert (env.state == state).all() and env.np_random.bit_generator.state == rng


def test_the_first_step_needs_a_reset():
    env = acrobot_rs.AcrobotEnv()
    assert env.state is None
    with pytest.raises(AssertionError, match="reset"):
        env.step(0)


@pytest.mark.parametrize("steps", [0, 1])
def test_elements_of_the_state_can_be_assigned_as_in_gymnasium(steps):
    ours, theirs = acrobot_rs.AcrobotEnv(), gymnasium.make("Acrobot-v1").unwrapped
    for env in (ours, theirs):
        env.reset(seed=4)
        for _ in range(steps):
            env.step(2)
        assert env.state is env.state
        assert env.state.dtype == (np.float64 if steps else np.float32)
        env.state[0] = 0.3
        env.state[1:] += [0.1, 0.2, 0.3]
        before = env.state
        if env is ours:  # before the step, which reads them too
            twin = pickle.loads(pickle.dumps(env))
        env.step(0)
        before[0] = 7.0  # no longer the state
    assert ours.state.tobytes() == theirs.state.tobytes()
    twin.step(0)
    assert twin.state.tobytes() == theirs.state.tobytes()
    ours.state[1] = np.nan
    for call in (lambda: ours.step(0), lambda: pickle.dumps(ours)):
        with pytest.raises(ValueError, match="theta2 must be a finite number of rad, got NaN"):
            call()
    ours.state[1] = 0.0
    ours.step(0)


def test_the_state_can_be_set_from_any_four_numbers(env):
    env.state = np.array([0.1, 0.2, 0.3, 0.4])
    assert list(env.state) == [0.1, 0.2, 0.3, 0.4]
    env.state = np.arange(8, dtype=np.float32)[::2]
    assert env.state.dtype == np.float32 and list(env.state) == [0.0, 2.0, 4.0, 6.0]
    env.state = (1, 2, 3, 4)
    assert env.state.dtype == np.float64 and list(env.state) == [1.0, 2.0, 3.0, 4.0]
    others = (["1", "2", "3", "4"], [True] * 4, bytearray(4), {1: 1}, np.ones(4, complex), np.zeros(4, "M8[s]"))
    for state in ([1, 2, 3], "abcd", None, [[1], [2, 3]], 5.0, np.zeros((4, 1)), [0.0, 0.0, 0.0, np.nan], *others):
        with pytest.raises(ValueError, match="state must be .*four .*numbers, got |^dtheta2 must "):
            env.state = state
    assert list(env.state) == [1.0, 2.0, 3.0, 4.0]
