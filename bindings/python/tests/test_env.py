"""The single environment passes Gymnasium's checks, and rejects what Gymnasium's rejects."""

import gymnasium
import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousEnv, AcrobotEnv, AcrobotSwingupEnv
from gymnasium.error import InvalidAction, ResetNeeded
from gymnasium.utils.env_checker import check_env
from vectors import BALANCE, CONTINUOUS, KINDS, SWINGUPS, V1, rejects


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


def test_pictures():
    pictures = AcrobotEnv(render_mode="rgb_array")
    pictures.reset(seed=42)
    hanging = pictures.render()
    assert hanging.shape == (500, 500, 3) and hanging.dtype == np.uint8
    # Gymnasium's colour of a link: the first link hangs below the joint.
    assert list(hanging[300, 250]) == [0, 204, 204]
    texts = AcrobotEnv(render_mode="ansi")
    texts.reset(seed=42)
    assert len(texts.render().splitlines()) == 21
    with pytest.warns(UserWarning, match="without a render mode"):
        assert AcrobotEnv().render() is None
    with pytest.raises(ValueError, match="render_mode must be .*, got 'text'"):
        AcrobotEnv("text")
    with pytest.warns(UserWarning, match="HumanRendering wrapper is being applied"):
        assert gymnasium.make(V1, render_mode="human").unwrapped.render_mode == "rgb_array"


@pytest.mark.parametrize(
    ("kind", "message", "actions"),
    [
        (AcrobotEnv, "action must be an integer from 0 to 3, got ",
         [4, -1, 2**70, np.array([1]), np.timedelta64(1)]),
        (AcrobotSwingupEnv, "action must be a number from -1 to 1, as an array", []),
        (AcrobotContinuousEnv, r"action must be a torque in N m, as an array of shape \(1,\), got ",
         [np.float32(1.0), ["1"], [[1.0]], np.float32([np.nan]), [10**400],
          np.zeros(2, np.float32), np.zeros((), np.float32), [[1], [2, 3]]]),
    ],
)  # fmt: skip
def test_invalid_actions_are_rejected(kind, message, actions):
    env = kind(AVAIL_TORQUE=[-1, 0, 1, 2], torque_noise_max=0.5)
    env.reset(seed=1)
    for action in (*actions, 1.0, None, [np.nan]):
        with rejects(env, InvalidAction, message):
            env.step(action)
    if kind is AcrobotEnv:
        for action in (2, np.int64(2), np.uint8(2), np.array(2)):
            env.step(action)


def test_the_state_can_be_set_from_any_four_numbers():
    for kind, error in (AcrobotEnv, AssertionError), (AcrobotSwingupEnv, ResetNeeded):
        with pytest.raises(error, match="call reset before step"):  # the first is Gymnasium's
            kind().step([0])
    env = AcrobotEnv()
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
    Heavy.LINK_MASS_1 = 2.0
    for env, mass in {heavy: 3.0, Heavy(): 2.0, Heavy(LINK_MASS_1=6.0): 6.0}.items():
        other = AcrobotEnv(LINK_MASS_1=mass)
        assert env.LINK_MASS_1 == mass
        assert env._native.__getstate__() == other._native.__getstate__()
    Heavy.LINK_MASS_1 = 0.0
    with pytest.raises(ValueError, match="LINK_MASS_1 must be "):
        Heavy()


def test_values_cannot_change_in_place():
    """A change would have no effect."""
    env, mass, torques = AcrobotEnv(), np.array(2.0), [-2.0, 0.0, 2.0]
    env.LINK_MASS_1 = mass
    env.AVAIL_TORQUE = torques
    mass[...], torques[0] = 3.0, 0.0
    assert env.LINK_MASS_1 == 2.0 and env.AVAIL_TORQUE == (-2.0, 0.0, 2.0)
