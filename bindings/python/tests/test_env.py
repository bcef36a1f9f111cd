"""The single environment passes Gymnasium's checks, and rejects what Gymnasium's rejects."""

import unittest.mock

import gymnasium
import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousEnv, AcrobotEnv, Uniform
from gymnasium.error import InvalidAction
from gymnasium.utils.env_checker import check_env
from vectors import BALANCE, CONTINUOUS, KINDS, SWINGUPS, V1, rejects


@pytest.fixture
def env():
    """A single environment without wrappers, in an initial state."""
    env = AcrobotEnv()
    env.reset(seed=42)
    return env


@pytest.mark.parametrize("name", [V1, CONTINUOUS, BALANCE, *SWINGUPS])
@pytest.mark.filterwarnings("ignore:.*infinity", "ignore:.*normalized space")  # N m, as Pendulum
def test_gymnasium_checks_pass_without_a_warning(name):
    check_env(gymnasium.make(name, render_mode="rgb_array").unwrapped)


def test_the_observation_space_contains_initial_states_above_the_bounds_of_velocity():
    check_env(AcrobotEnv(MAX_VEL_1=1e-30, MAX_VEL_2=0.05), skip_render_check=True)
    env = AcrobotEnv(MAX_VEL_1=np.inf, MAX_VEL_2=1e300)  # beyond float32
    assert (env.observation_space.high[4:] == np.inf).all()


def test_registration_and_spaces_are_those_of_gymnasium():
    ours, theirs = gymnasium.make(V1), gymnasium.make("Acrobot-v1")
    for name in ("observation_space", "action_space"):
        assert getattr(ours, name) == getattr(theirs, name)
    assert ours.metadata["render_fps"] == theirs.metadata["render_fps"]
    assert AcrobotEnv(dt=0.04).metadata["render_fps"] == 25, "real time"
    limits = {V1: 500, CONTINUOUS: 500, BALANCE: 500} | dict.fromkeys(SWINGUPS, 1000)
    for name, limit in limits.items():
        env = gymnasium.make(name)
        assert env.spec.reward_threshold == (-100 if name in (V1, CONTINUOUS) else None)
        env.reset(seed=1)
        ends = [env.step(1 if name == V1 else [0.0])[2:4] for _ in range(limit)]
        assert ends == [(False, False)] * (limit - 1) + [(False, True)]


def test_pictures(env):
    pictures = AcrobotEnv(render_mode="rgb_array")
    pictures.reset(seed=42)
    hanging = pictures.render()
    assert hanging.shape == (500, 500, 3) and hanging.dtype == np.uint8
    # Gymnasium's colour of a link: the first link hangs below the joint.
    assert list(hanging[300, 250]) == [0, 204, 204]
    pictures.LINK_LENGTH_2 = 0.5
    assert (pictures.render() != hanging).any()
    pictures.state = [np.pi, 0, 0, 0]
    assert list(pictures.render()[200, 250]) == [0, 204, 204]

    texts = AcrobotEnv(render_mode="ansi")
    texts.reset(seed=42)
    assert len(texts.render().splitlines()) == 21

    with pytest.warns(UserWarning, match="without a render mode"):
        assert env.render() is None
    with pytest.raises(ValueError, match="render_mode must be .*, got 'text'"):
        AcrobotEnv("text")
    with pytest.warns(UserWarning, match="HumanRendering wrapper is being applied"):
        assert gymnasium.make(V1, render_mode="human").unwrapped.render_mode == "rgb_array"


@pytest.mark.parametrize(
    ("kind", "message", "actions"),
    [
        (AcrobotEnv, "action must be an integer from 0 to 3, got ",
         [4, -1, 2**70, np.array([1]), np.timedelta64(1)]),
        (AcrobotContinuousEnv, r"action must be a torque in N m, as an array of shape \(1,\), got ",
         [np.float32(1.0), ["1"], [[1.0]], [np.nan], np.float32([np.nan]), [10**400],
          np.zeros(2, np.float32), np.zeros((), np.float32), [[1], [2, 3]]]),
    ],
)  # fmt: skip
def test_invalid_actions_are_rejected(kind, message, actions):
    env = kind(AVAIL_TORQUE=[-1, 0, 1, 2], torque_noise_max=0.5)
    env.reset(seed=1)
    for action in (*actions, 1.0, None):
        with rejects(env, InvalidAction, message):
            env.step(action)
    if kind is AcrobotEnv:
        for action in (2, np.int64(2), np.uint8(2), np.array(2)):
            env.step(action)


@pytest.mark.parametrize(
    ("error", "name", "value"),
    [
        (ValueError, "AVAIL_TORQUE", []),
        (ValueError, "book_or_nips", "paper"),
        (TypeError, "AVAIL_TORQUE", {-1.0, 0.0, 1.0}),
        (TypeError, "book_or_nips", None),
        (TypeError, "LINK_MASS_1", Uniform(1.0, 2.0)),
    ],
)
def test_invalid_parameters_are_rejected_by_their_names(env, name, value, error):
    with rejects(env, error, f"^{name}.* must "):
        setattr(env, name, value)


def test_the_state_can_be_set_from_any_four_numbers(env):
    with pytest.raises(AssertionError, match="reset"):  # as Gymnasium's
        AcrobotEnv().step(0)
    for state in ([0.1, 0.2, 0.3, 0.4], np.arange(8, dtype=np.float32)[::2], (1, 2, 3, 4)):
        env.state = state
        assert env.state.dtype == np.float64 and list(env.state) == list(state)
    for bad in ([1, 2, 3], None, [True] * 4):
        with rejects(env, ValueError, "state must be four finite numbers, got "):
            env.state = bad
    with pytest.raises(ValueError, match="read-only"):
        env.state[0] = 0.0


@pytest.mark.parametrize("kind", KINDS)
def test_an_unknown_name_is_rejected(kind):
    env = kind()
    with pytest.raises(AttributeError, match="no attribute 'mass_1'; .*, LINK_MASS_1, "):
        env.mass_1 = 2.0
    # In Python's words, which torchrl recognises.
    words = rf"{kind.__name__}.__init__\(\) got an unexpected keyword argument 'mass_1'"
    with pytest.raises(TypeError, match=f"{words}; .*, LINK_MASS_1, "):
        kind(mass_1=2.0)
    # What Gymnasium and users set, also in their own classes.
    env.np_random, env.render_mode = np.random.default_rng(1), "ansi"
    env.metadata, env.spec = {**env.metadata}, None
    type("Own", (kind,), {})().curriculum_level = 3


def test_spaces_follow_the_parameters():
    env, samples = AcrobotContinuousEnv(), []
    for _ in range(2):
        env.AVAIL_TORQUE = [-1.0, 0.0, 1.0]
        before = env.action_space
        before.seed(1)
        env.AVAIL_TORQUE, env.LINK_MASS_1 = [1.0, 0.0, -1.0], 2.0
        assert env.action_space is before, "and its generator"
        env.AVAIL_TORQUE = [-3.0, 2.0]
        assert env.action_space == gymnasium.spaces.Box(-3.0, 2.0, (1,), np.float32)
        samples.append(env.action_space.sample())
    assert samples[0] == samples[1], "a seeded space is followed by a seeded one"
    env.AVAIL_TORQUE = [-1e300, 0.0, 3.402823466385289e38]  # beyond float32, also by rounding
    assert -env.action_space.low == env.action_space.high == np.finfo(np.float32).max


def test_a_new_environment_copies_its_class_s_parameters():
    class Heavy(AcrobotEnv):
        LINK_MASS_1 = 3.0

    heavy = Heavy()
    with unittest.mock.patch.object(Heavy, "LINK_MASS_1", 2.0):
        later = Heavy()
    for env, mass in {heavy: 3.0, later: 2.0, Heavy(LINK_MASS_1=6.0): 6.0}.items():
        assert env.LINK_MASS_1 == mass
        other = AcrobotEnv(LINK_MASS_1=mass)
        assert env._native.__getstate__() == other._native.__getstate__()
    with unittest.mock.patch.object(Heavy, "LINK_MASS_1", 0.0):
        with pytest.raises(ValueError, match="LINK_MASS_1 must be "):
            Heavy()


def test_values_cannot_change_in_place(env):
    """A change would have no effect."""
    mass, torques = np.array(2.0), [-2.0, 0.0, 2.0]
    env.LINK_MASS_1 = mass
    env.AVAIL_TORQUE = torques
    mass[...], torques[0] = 3.0, 0.0
    assert env.LINK_MASS_1 == 2.0 and env.AVAIL_TORQUE == (-2.0, 0.0, 2.0)


def test_continuous_torques_are_those_of_the_discrete_environment():
    """Between and at the bounds. Torques outside are clipped."""
    torques = [0.5, -3.0, 2.0]
    actions = {-np.inf: -3.0, -4.0: -3.0, -3.0: -3.0, 0.25: 0.25, 2.0: 2.0, 3.0: 2.0, np.inf: 2.0}
    ours = AcrobotContinuousEnv(AVAIL_TORQUE=torques, torque_noise_max=0.1)
    discrete = AcrobotEnv(AVAIL_TORQUE=list(actions.values()), torque_noise_max=0.1)
    assert (ours.reset(seed=2)[0] == discrete.reset(seed=2)[0]).all()
    kinds = [
        *(list, np.float32, np.float64),
        # A number after a header of one byte is not aligned.
        lambda action: np.frombuffer(b"h" + np.float32(action).tobytes(), np.float32, offset=1),
    ]
    for step in range(100):
        index = step % len(actions)
        action = kinds[step % len(kinds)]([list(actions)[index]])
        found, expected = ours.step(action), discrete.step(index)
        assert (found[0] == expected[0]).all() and found[1:] == expected[1:], step
