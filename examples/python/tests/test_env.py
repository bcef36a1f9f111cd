"""The single environment passes Gymnasium's own checks, and rejects what Gymnasium's environment rejects."""

import abc
import collections
import copy
import itertools
import pickle
import re
import sys
import unittest.mock

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from acrobot_rs.parameters import _NAMES
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


@pytest.mark.parametrize(("name", "limit"), [(V1, 500), (V0, 200), (CONTINUOUS, 500)])
def test_episodes_are_truncated(name, limit):
    env = make(name)
    env.reset(seed=1)
    steps = 1
    while not env.step([0.0] if name == CONTINUOUS else 1)[3]:
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


def test_an_unknown_render_mode_warns_as_in_gymnasium_and_render_rejects_it():
    with pytest.warns(UserWarning, match="render_mode='text' that is not in the possible render_modes"):
        env = gymnasium.make(V1, render_mode="text")
    assert env.render_mode == "text"
    env.reset()
    with pytest.raises(ValueError, match='render_mode must be .*, got "text"'):
        env.unwrapped.render()


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
    twin.step(0)
    assert shown.call_count == 7
    twin.render_mode = None
    twin.step(0)
    assert shown.call_count == 7
    env.close()
    assert pygame.quit.called and env.unwrapped.screen is None and not env.unwrapped.isopen


@pytest.mark.parametrize(
    "action",
    [3, -1, 256, 2**70, 1.0, "1", None, np.array([1]), np.array([1, 2]), b"\1", bytearray(b"\1"), [1], {1}, {1: 1}, 1j,
     np.True_, np.array(True), np.timedelta64(1), iter([1])],
)  # fmt: skip
def test_invalid_actions_are_rejected(env, action):
    env.unwrapped.torque_noise_max = 0.5
    before, drawn = env.state, env.np_random.bit_generator.state
    with pytest.raises(InvalidAction, match="action must be an integer from 0 to 2, got "):
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
        ("AVAIL_TORQUE", []),
        ("AVAIL_TORQUE", range(10**9)),
        ("torque_noise_max", -0.1),
        ("book_or_nips", "paper"),
        ("state", [0.0, 0.0, 0.0]),
        ("state", [0.0, 0.0, 0.0, np.nan]),
    ],
)
def test_invalid_values_are_rejected(env, name, value):
    before = np.copy(getattr(env, name))
    with pytest.raises(ValueError, match=f"^{name}.* must |^dtheta2 must "):
        setattr(env, name, value)
    assert (getattr(env, name) == before).all()
    if name != "state":
        with pytest.raises(ValueError, match=f"^{name}.* must "):
            type("Changed", (acrobot_rs.AcrobotEnv,), {name: value})


@pytest.mark.parametrize("name", [name for name in _NAMES if name != "AVAIL_TORQUE"])
def test_a_value_of_another_type_is_rejected_by_the_name_of_the_parameter(env, name):
    for value in ("two", None, [1.0], 1j) if name != "book_or_nips" else (1, None):
        with pytest.raises(TypeError, match=f"^{name} must be .*, got "):
            setattr(env, name, value)


@pytest.mark.parametrize("torques", [{-1.0, 0.0, 1.0}, iter([-1.0, 0.0, 1.0]), itertools.repeat(0.0, 10**6)])
def test_torques_must_be_a_sequence(env, torques):
    """A set has no order, and an iterator may have no end."""
    with pytest.raises(TypeError, match="^AVAIL_TORQUE must be a sequence of numbers, got "):
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
    "options", [{"low": 1, "high": 0}, {"low": "x"}, {"high": None}, {"high": np.inf}, {"low": np.nan}, {"lo": 0.1}]
)
def test_invalid_bounds_are_rejected(env, options):
    state, rng = env.state, env.np_random.bit_generator.state
    with pytest.raises(ValueError):
        env.reset(seed=1, options=options)
    assert (env.state == state).all() and env.np_random.bit_generator.state == rng


def test_unknown_options_are_rejected_with_the_valid_ones(env):
    for key in ("lo", "reset_mask"):
        with pytest.raises(ValueError, match=re.escape(f"the keys of options must be among ['low', 'high'], got '{key}'")):
            env.reset(options={key: -0.2, "high": 0.2})


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


def test_an_invalid_element_of_the_state_is_rejected_by_the_step(env):
    before = env.state[1]
    env.state[1] = np.nan
    for call in (lambda: env.step(0), lambda: pickle.dumps(env)):
        with pytest.raises(ValueError, match="theta2 must be a finite number of rad, got NaN"):
            call()
    env.state[1] = before
    env.step(0)


def test_the_state_can_be_set_from_any_four_numbers(env):
    env.state = np.array([0.1, 0.2, 0.3, 0.4])
    assert list(env.state) == [0.1, 0.2, 0.3, 0.4]
    env.state = np.arange(8, dtype=np.float32)[::2]
    assert env.state.dtype == np.float32 and list(env.state) == [0.0, 2.0, 4.0, 6.0]
    env.state = (1, 2, 3, 4)
    assert env.state.dtype == np.float64 and list(env.state) == [1.0, 2.0, 3.0, 4.0]
    others = (["1", "2", "3", "4"], [True] * 4, bytearray(4), {1: 1}, np.ones(4, complex), np.zeros(4, "M8[s]"))
    for state in ([1, 2, 3], "abcd", None, [[1], [2, 3]], 5.0, np.zeros((4, 1)), *others):
        with pytest.raises(ValueError, match="state must be .*four .*numbers, got "):
            env.state = state


@pytest.mark.parametrize(
    ("name", "meant"),
    [("LINK_MAS_1", "LINK_MASS_1"), ("link_moi", "LINK_MOI"), ("torque_noise", "torque_noise_max"), ("Dt", "dt")],
)
def test_misspelt_parameters_are_rejected(env, name, meant):
    message = f"AcrobotEnv has no parameter {name}; did you mean {meant}?"
    for target in (env, acrobot_rs.AcrobotEnv):
        with pytest.raises(AttributeError, match=re.escape(message)):
            setattr(target, name, 2.0)
        assert not hasattr(target, name)
    for bases in [(acrobot_rs.AcrobotEnv,), (type("Mixin", (), {name: 2.0}), acrobot_rs.AcrobotEnv)]:
        with pytest.raises(AttributeError, match=f"did you mean {meant}?"):
            type("Changed", bases, {} if len(bases) == 2 else {name: 2.0})
    # Wrappers and users may keep their own attributes.
    env.curriculum_level = 3
    env._LINK_MAS_1 = 2.0


@pytest.mark.parametrize("name", ["_dsdt", "_terminal", "_get_ob", "rk4", "wrap", "bound", "SCREEN_DIM"])
def test_overriding_what_is_not_called_is_rejected(env, name):
    own = {name: lambda self: None}
    with pytest.raises(TypeError, match=f"{name} would have no effect on Changed; "):
        type("Changed", (acrobot_rs.AcrobotEnv,), own)
    with pytest.raises(TypeError, match=name):
        type("Changed", (type("Mixin", (), own), acrobot_rs.AcrobotEnv), {})
    for target in (env, acrobot_rs.AcrobotEnv):
        with pytest.raises(TypeError, match=f"{name} would have no effect on AcrobotEnv; "):
            setattr(target, name, None)


def test_class_attributes_act_from_the_next_step():
    class Base(acrobot_rs.AcrobotEnv):
        pass

    class Derived(Base, abc.ABC):
        LINK_MOI = 0.5

    class Heavy(Base):
        LINK_MASS_1 = 3.0

    live, derived, heavy, own = Base(), Derived(), Heavy(), Base()
    own.LINK_MASS_1 = 4.0

    def masses():
        """What each computes with, found by comparing with environments that were made with a mass."""
        return [next(m for m in (1.0, 2.0, 3.0, 4.0, 5.0) if moves(env, m)) for env in (live, derived, heavy, own)]

    def moves(env, mass):
        other = acrobot_rs.AcrobotEnv()
        other.LINK_MASS_1, other.LINK_MOI = mass, env.LINK_MOI
        for each in (env, other):
            each.state = [1.0, 1.0, 0.0, 0.0]
            each.step(2)
        return (env.state == other.state).all()

    assert masses() == [1.0, 1.0, 3.0, 4.0]
    pickled = pickle.dumps(acrobot_rs.AcrobotEnv())
    with unittest.mock.patch.object(Base, "LINK_MASS_1", 2.0):
        assert masses() == [2.0, 2.0, 3.0, 4.0]
        Derived.LINK_MASS_1 = 5.0
        assert masses() == [2.0, 5.0, 3.0, 4.0]
        del Derived.LINK_MASS_1, own.LINK_MASS_1
        assert masses() == [2.0, 2.0, 3.0, 2.0]
    assert masses() == [1.0, 1.0, 3.0, 1.0]
    with unittest.mock.patch.object(acrobot_rs.AcrobotEnv, "LINK_MASS_1", 2.0):
        assert moves(pickle.loads(pickled), 2.0), "a pickle takes the class's values"
    # In whatever order: no link may be without inertia meanwhile.
    no_moment = acrobot_rs.AcrobotEnv()
    no_moment.LINK_MOI = 0.0
    state = {**no_moment.__getstate__(), "LINK_MOI": 1.0, "LINK_COM_POS_1": 0.0}
    no_moment.__setstate__(state)
    # An error changes nothing.
    with pytest.raises(ValueError, match="LINK_MASS_1 must be finite and above 0 kg, got 0"):
        Base.LINK_MASS_1 = 0.0
    own.LINK_COM_POS_2 = 0.0
    with pytest.raises(ValueError, match="LINK_MOI must be above 0"):
        Base.LINK_MOI = 0.0
    del own.LINK_COM_POS_2
    assert Base.LINK_MOI == 1.0 and masses() == [1.0, 1.0, 3.0, 1.0]


def test_parameters_can_be_set_through_wrappers():
    env = make(V1)
    env.set_wrapper_attr("LINK_MASS_1", 2.0)
    with pytest.raises(ValueError, match="LINK_MASS_1 must"):
        env.set_wrapper_attr("LINK_MASS_1", -2.0)
    assert env.unwrapped.LINK_MASS_1 == 2.0


def test_a_vector_environment_has_three_torques():
    envs = acrobot_rs.AcrobotVectorEnv(2)
    for target in (envs, acrobot_rs.AcrobotVectorEnv):
        with pytest.raises(ValueError, match="AVAIL_TORQUE must be 3 numbers, got 2"):
            target.AVAIL_TORQUE = [-1.0, 1.0]
        assert target.AVAIL_TORQUE == (-1.0, 0.0, 1.0)


def test_values_cannot_change_in_place(env):
    """A change would have no effect."""
    mass, torques = np.array(2.0), [-2.0, 0.0, 2.0]
    env.LINK_MASS_1 = mass
    env.AVAIL_TORQUE = torques
    changed = type("Changed", (acrobot_rs.AcrobotEnv,), {"LINK_MASS_1": mass, "AVAIL_TORQUE": torques})
    mass[...], torques[0] = 3.0, 0.0
    for each in (env, changed, changed()):
        assert each.LINK_MASS_1 == 2.0 and list(each.AVAIL_TORQUE) == [-2.0, 0.0, 2.0]
        with pytest.raises(TypeError, match="set AVAIL_TORQUE as a whole"):
            each.AVAIL_TORQUE[0] = 0.0


@pytest.mark.parametrize("count", [1, 2, 5, 300])
def test_any_number_of_torques(count):
    torques = np.linspace(-2, 2, count).tolist()
    ours = type("Ours", (acrobot_rs.AcrobotEnv,), {"AVAIL_TORQUE": torques})()
    theirs = gymnasium.make("Acrobot-v1").unwrapped
    theirs.AVAIL_TORQUE = torques
    assert ours.action_space == gymnasium.spaces.Discrete(count)
    for env in (ours, theirs):
        env.reset(seed=1)
        for action in range(count):
            env.step(action)
    assert ours.state.tobytes() == theirs.state.tobytes()
    with pytest.raises(InvalidAction, match=f"action must be an integer from 0 to {count - 1}, got {count}"):
        ours.step(count)
    twin = pickle.loads(pickle.dumps(ours._native))
    twin.step(ours, count - 1)
    ours.step(count - 1)
    assert (twin.state == ours.state).all()


@pytest.mark.parametrize("torques", [[-1.0, 0.0, 1.0], [0.5, -3.0, 2.0]])
def test_continuous_torques_are_those_of_the_discrete_environment(torques):
    """Between and at the bounds. Torques outside are clipped."""
    ours = type("Ours", (acrobot_rs.AcrobotContinuousEnv,), {"AVAIL_TORQUE": torques})()
    low, high = min(torques), max(torques)
    assert ours.action_space == gymnasium.spaces.Box(low, high, (1,), np.float32)
    assert ours.observation_space == acrobot_rs.AcrobotEnv().observation_space
    between = float(np.float32(0.3))
    actions = {-np.inf: low, low - 1: low, low: low, between: between, high: high, high + 1: high, np.inf: high}
    discrete = acrobot_rs.AcrobotEnv()
    discrete.AVAIL_TORQUE = list(actions.values())
    for env in (ours, discrete):
        env.torque_noise_max = 0.1
    assert (ours.reset(seed=2)[0] == discrete.reset(seed=2)[0]).all()
    kinds = [list, np.float32, np.float64, lambda action: np.repeat(np.float32(action), 2)[::2]]
    for step in range(300):
        index = step % len(actions)
        action = [list(actions)[index]]
        found, expected = ours.step(kinds[step % len(kinds)](action)), discrete.step(index)
        assert (found[0] == expected[0]).all() and found[1:] == expected[1:], step
    ours.AVAIL_TORQUE = [-0.1, 0.1]
    discrete.AVAIL_TORQUE = [0.1]
    assert (ours.step([1.0])[0] == discrete.step(0)[0]).all()


@pytest.mark.parametrize(
    "action",
    [1, 1.0, np.float32(1.0), None, "1", ["1"], [], [1.0, 1.0], [[1.0]], [None], [np.nan], np.float32([np.nan]),
     np.zeros((1, 1), np.float32), np.zeros(2, np.float32), np.zeros(0, np.float32), np.zeros((), np.float32),
     b"a", bytearray(b"a"), {0: 0.5}, collections.UserDict({0: 0.5}), {0.5}, iter([0.5]), [True], np.array([True]), [1j],
     np.array([1j]), np.array(["0.5"]), np.array([0.5], object), np.array([1], "m8[s]"), [10**400], [[1], [2, 3]]],
)  # fmt: skip
def test_invalid_continuous_actions_are_rejected(action):
    env = acrobot_rs.AcrobotContinuousEnv()
    env.torque_noise_max = 0.5
    env.reset(seed=1)
    before = pickle.dumps(env)
    with pytest.raises(InvalidAction, match=r"action must be a torque in N m, as an array of shape \(1,\), got "):
        env.step(action)
    assert pickle.dumps(env) == before


def test_continuous_actions_may_be_in_packed_bytes():
    """Numbers after a header of one byte are not aligned."""
    env, twin = acrobot_rs.AcrobotContinuousEnv(), acrobot_rs.AcrobotContinuousEnv()
    action = np.float32([0.7])
    packed = np.frombuffer(b"h" + action.tobytes(), np.float32, offset=1)
    for each in (env, twin):
        each.reset(seed=1)
    assert not packed.flags.aligned
    assert (env.step(packed)[0] == twin.step(action)[0]).all()


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

    pictures = acrobot_rs.AcrobotEnv("rgb_array")
    pictures.reset(seed=3)
    before = pictures.render()
    pictures.LINK_LENGTH_2 = 0.5
    assert (pictures.render() != before).any()


AGAIN = [copy.deepcopy, *(lambda env, p=p: pickle.loads(pickle.dumps(env, p)) for p in range(pickle.HIGHEST_PROTOCOL + 1))]


@pytest.mark.parametrize("again", AGAIN)
@pytest.mark.parametrize("name", [V1, V0, CONTINUOUS])
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


def test_a_shallow_copy_has_its_own_state(env):
    """As in Gymnasium it shares the generator."""
    env.LINK_MASS_1 = 2.0
    twin, third = copy.copy(env), copy.deepcopy(env)
    before = env.state.copy()
    env.step(2)
    env.LINK_MASS_2 = 2.0
    assert (twin.state == before).all() and twin.LINK_MASS_1 == 2.0 and twin.LINK_MASS_2 == 1.0
    assert (twin.step(0)[0] == third.step(0)[0]).all()
    assert twin.np_random is env.np_random


def test_damaged_snapshots_are_rejected(env):
    native = env._native
    env.state = [0.1, 0.2, 0.3, 0.4]
    good = native.__getstate__()
    not_finite = good.replace(env.state[:1].tobytes(), np.float64(np.nan).tobytes())
    no_torques = good.replace(b"\3" + np.float64([-1, 0, 1]).tobytes(), b"\0")
    bad_torque = good.replace(b"\3" + np.float64(-1).tobytes(), b"\3" + np.float64(np.inf).tobytes())
    bad_noise = good.replace(b"\3" + np.float64([-1, 0, 1, 0]).tobytes(), b"\3" + np.float64([-1, 0, 1, -1]).tobytes())
    wrong = [not_finite, no_torques, bad_torque, bad_noise]
    assert len({good, *wrong}) == 5
    for bad in [b"", good[:-1], good + b"\0", b"\xff" * len(good), *wrong]:
        with pytest.raises(ValueError, match="snapshot|AVAIL_TORQUE|torque_noise_max"):
            native.__setstate__(bad)
    with pytest.raises(ValueError, match="the snapshot's version must be 1, got 2"):
        native.__setstate__(b"\x02" + good[1:])
    assert native.__getstate__() == good
    env.state = np.float32([1, 2, 3, 4])
    native.__setstate__(native.__getstate__().replace(np.float64(3).tobytes(), np.float64(1e300).tobytes()))
    assert list(env.state) == [1, 2, 1e300, 4]
