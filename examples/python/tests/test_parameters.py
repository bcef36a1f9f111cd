"""Parameters of a single environment: arguments, attributes, classes, and the spaces that follow them."""

import abc
import copy
import itertools
import pickle
import re
import unittest.mock

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from acrobot_rs.parameters import _NAMES
from gymnasium.error import InvalidAction
from test_env import CONTINUOUS, V0, V1, env, make  # noqa: F401 a fixture


@pytest.mark.parametrize(
    ("error", "name", "values"),
    [
        (ValueError, "dt", (0.0, np.nan)),
        (ValueError, "LINK_MASS_1", (-1.0,)),
        (ValueError, "LINK_MOI", (np.inf,)),
        (ValueError, "MAX_VEL_2", (1e300,)),
        (ValueError, "AVAIL_TORQUE", ([0.0, 1.0, np.inf], [])),
        (ValueError, "torque_noise_max", (-0.1,)),
        (ValueError, "book_or_nips", ("paper",)),
        # A set has no order, and an iterator may have no end.
        (TypeError, "AVAIL_TORQUE", (None, {-1.0, 0.0, 1.0}, iter([-1.0, 0.0, 1.0]), itertools.repeat(0.0, 10**6))),
        (TypeError, "book_or_nips", (1, None)),
        *((TypeError, name, ("two", None, [1.0], 1j)) for name in _NAMES if name not in ("AVAIL_TORQUE", "book_or_nips")),
    ],
)
def test_invalid_parameters_are_rejected_by_their_names(env, name, values, error):
    for value in values:
        before = getattr(env, name)
        with pytest.raises(error, match=f"^{name}.* must "):
            setattr(env, name, value)
        with pytest.raises(error, match=f"^{name}.* must "):
            type("Changed", (acrobot_rs.AcrobotEnv,), {name: value})
        assert getattr(env, name) == before


UNKNOWN = {
    "LINK_MAS_1": "LINK_MASS_1", "link_moi": "LINK_MOI", "torque_noise": "torque_noise_max", "Dt": "dt", "Gravity": "gravity",
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "value", "error", "message"),
    [
        *((name, 2.0, AttributeError, f"has no parameter {name}; did you mean {meant}?") for name, meant in UNKNOWN.items()),
        *((name, lambda self: None, TypeError, f"{name} would have no effect on ") for name in (
            "_dsdt", "_terminal", "_get_ob", "rk4", "wrap", "bound", "SCREEN_DIM")),
    ],
)  # fmt: skip
def test_what_would_have_no_effect_is_rejected(env, name, value, error, message):
    """Misspelt parameters, and methods that are not called."""
    wrapped, own = make(V1), type("Own", (acrobot_rs.AcrobotEnv,), {})()
    changes = (
        lambda: setattr(env, name, value),
        lambda: setattr(own, name, value),
        lambda: wrapped.set_wrapper_attr(name, value),
        lambda: type("Changed", (acrobot_rs.AcrobotEnv,), {name: value}),
        lambda: type("Changed", (type("Mixin", (), {name: value}), acrobot_rs.AcrobotEnv), {}),
    )
    for change in changes:
        with pytest.raises(error, match=re.escape(message)):
            change()
    # Subclasses and users may keep their own attributes.
    own.curriculum_level = 3
    env._LINK_MAS_1 = 2.0


@pytest.mark.parametrize("kind", [acrobot_rs.AcrobotEnv, acrobot_rs.AcrobotContinuousEnv, acrobot_rs.AcrobotVectorEnv])
def test_an_unknown_name_is_rejected(kind):
    """Gymnasium and its wrappers set other names, which tests of copies, checks and wrappers cover."""
    env = kind()
    for name, hint in [("mass_1", "did you mean LINK_MASS_1?"), ("damping", "it has dt, LINK_"), ("tau", "it has dt, LINK_")]:
        with pytest.raises(AttributeError, match=re.escape(f"{kind.__name__} has no parameter {name}; {hint}")):
            setattr(env, name, 2.0)
        with pytest.raises(TypeError, match=f"{kind.__name__} has no argument {name}; "):
            kind(**{name: 2.0})
    with pytest.raises(TypeError, match="^AcrobotEnv has no argument rendermode; did you mean render_mode?"):
        make(V1, rendermode="ansi")
    with pytest.raises(TypeError, match="^AcrobotVectorEnv has no argument autoreset; did you mean autoreset_mode?"):
        gymnasium.make_vec(V1, num_envs=2, autoreset="SameStep")


def test_wrappers_set_what_they_need():
    env = make(V1, render_mode="rgb_array")
    env = gymnasium.wrappers.RecordEpisodeStatistics(env)
    env = gymnasium.wrappers.TimeAwareObservation(gymnasium.wrappers.AddRenderObservation(env))
    env.reset(seed=1)
    env.step(1)
    env.unwrapped.np_random = np.random.default_rng(1)
    env.unwrapped.render_mode, env.unwrapped.metadata = "ansi", {**env.unwrapped.metadata}
    assert not env.set_wrapper_attr("_private", 1, force=False)


@pytest.mark.parametrize("again", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env)), lambda env: env.spec.make()])
def test_parameters_are_arguments(again):
    class Heavy(acrobot_rs.AcrobotEnv):
        LINK_MASS_1 = 3.0

    assert Heavy().LINK_MASS_1 == 3.0 and Heavy(LINK_MASS_1=4.0).LINK_MASS_1 == 4.0
    for name in (V1, CONTINUOUS, V0):
        env = make(name, LINK_MASS_1=2, AVAIL_TORQUE=[-2, 0, 3], MAX_VEL_1=9.0)
        assert env.spec.kwargs["LINK_MASS_1"] == 2
        other = again(env) if name != V0 else env
        assert other.unwrapped.LINK_MASS_1 == 2.0 and other.unwrapped.AVAIL_TORQUE == (-2.0, 0.0, 3.0)
        assert other.observation_space.high[-2] == 9.0
        assert (name == CONTINUOUS) == (other.action_space == gymnasium.spaces.Box(-2.0, 3.0, (1,), np.float32))
    with pytest.raises(ValueError, match="^LINK_MASS_1 must be finite and above 0 kg, got -1"):
        make(V1, LINK_MASS_1=-1)


def test_spaces_follow_the_parameters():
    env = acrobot_rs.AcrobotContinuousEnv()
    env.action_space.seed(1)
    same = env.action_space
    env.AVAIL_TORQUE, env.LINK_MASS_1 = [1.0, 0.0, -1.0], 2.0
    assert env.action_space is same, "and its generator"
    samples = []
    for _ in range(2):
        env.action_space = acrobot_rs.AcrobotContinuousEnv().action_space
        env.action_space.seed(1)
        env.AVAIL_TORQUE = [-3.0, 2.0]
        assert env.action_space == gymnasium.spaces.Box(-3.0, 2.0, (1,), np.float32)
        samples.append(env.action_space.sample())
        del env.AVAIL_TORQUE
    assert samples[0] == samples[1], "a seeded space is followed by a seeded one"
    env.MAX_VEL_2 = 3.0
    assert env.observation_space.high[5] == 3.0
    env.observation_space = mine = gymnasium.spaces.Box(-1.0, 1.0, (6,))
    env.MAX_VEL_2 = 4.0
    assert env.observation_space is mine


def test_an_environment_takes_over_the_values_that_its_class_has_when_it_is_made():
    class Heavy(acrobot_rs.AcrobotEnv, abc.ABC):
        LINK_MASS_1 = 3.0

    heavy, plain, restored = Heavy(), acrobot_rs.AcrobotEnv(), Heavy()
    restored.LINK_MASS_1 = 4.0
    del restored.LINK_MASS_1
    with unittest.mock.patch.object(Heavy, "LINK_MASS_1", 2.0):
        later = Heavy()
    plain.LINK_MASS_1 = 4.0
    with unittest.mock.patch.object(plain, "LINK_MASS_1", 5.0):
        patched = copy.copy(plain)
    for env, mass in [(heavy, 3.0), (later, 2.0), (plain, 4.0), (patched, 5.0), (restored, 3.0)]:
        other = acrobot_rs.AcrobotEnv()
        other.LINK_MASS_1 = mass
        assert env.LINK_MASS_1 == mass
        for each in (env, other):
            each.state = [1.0, 1.0, 0.0, 0.0]
            each.step(2)
        assert (env.state == other.state).all()
    with unittest.mock.patch.object(Heavy, "LINK_MASS_1", 0.0), pytest.raises(ValueError, match="LINK_MASS_1 must be "):
        Heavy()


def test_a_vector_environment_has_three_torques():
    envs = acrobot_rs.AcrobotVectorEnv(2)
    for change in (
        lambda: setattr(envs, "AVAIL_TORQUE", [-1.0, 1.0]),
        type("Two", (acrobot_rs.AcrobotVectorEnv,), {"AVAIL_TORQUE": [-1.0, 1.0]}),
    ):
        with pytest.raises(ValueError, match="AVAIL_TORQUE must be 3 numbers, got 2"):
            change()
    assert envs.AVAIL_TORQUE == (-1.0, 0.0, 1.0)


def test_parameters_can_be_set_through_wrappers():
    env = make(V1)
    env.set_wrapper_attr("LINK_MASS_1", 2.0)
    with pytest.raises(ValueError, match="LINK_MASS_1 must"):
        env.set_wrapper_attr("LINK_MASS_1", -2.0)
    assert env.unwrapped.LINK_MASS_1 == 2.0


def test_values_cannot_change_in_place(env):
    """A change would have no effect."""
    mass, torques = np.array(2.0), [-2.0, 0.0, 2.0]
    env.LINK_MASS_1 = mass
    env.AVAIL_TORQUE = torques
    changed = type("Changed", (acrobot_rs.AcrobotEnv,), {"LINK_MASS_1": mass, "AVAIL_TORQUE": torques})
    mass[...], torques[0] = 3.0, 0.0
    for each in (env, changed, changed()):
        assert each.LINK_MASS_1 == 2.0 and each.AVAIL_TORQUE == (-2.0, 0.0, 2.0)


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
    kinds = [
        *(list, np.float32, np.float64, lambda action: np.repeat(np.float32(action), 2)[::2]),
        # A number after a header of one byte is not aligned.
        lambda action: np.frombuffer(b"h" + np.float32(action).tobytes(), np.float32, offset=1),
    ]
    for step in range(300):
        index = step % len(actions)
        action = [list(actions)[index]]
        found, expected = ours.step(kinds[step % len(kinds)](action)), discrete.step(index)
        assert (found[0] == expected[0]).all() and found[1:] == expected[1:], step
    ours.AVAIL_TORQUE = [-0.1, 0.1]
    discrete.AVAIL_TORQUE = [0.1]
    assert (ours.step([1.0])[0] == discrete.step(0)[0]).all()
