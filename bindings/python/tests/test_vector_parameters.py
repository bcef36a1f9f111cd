"""Parameters of each environment: values, draws, and what reads them."""

import gymnasium
import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousVectorEnv, AcrobotEnv, AcrobotVectorEnv
from acrobot_rs import LogUniform, Normal, Uniform
from vectors import make_vec, rejects


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
@pytest.mark.parametrize(
    ("error", "name", "value", "message"),
    [
        (TypeError, "LINK_MASS_1", [1, 2, None], r"\[2\] must be a number, got None"),
        (ValueError, "LINK_MASS_1", [1, 2], " must be .* each of 3 environments, .*, got 2 values"),
        (ValueError, "AVAIL_TORQUE", [-1, 1], r" must be 3 numbers, such as \[-2, 0, 2\], got 2"),
        (ValueError, "AVAIL_TORQUE", [[1, 2, 3], [1, 2], [1, 2, 3]], r"\[1\] must be 3 numbers, s"),
        (ValueError, "book_or_nips", ["book", "nips", "b"], r"\[2\] must be 'book' .*, got 'b'"),
        (ValueError, "LINK_COM_POS_2", Uniform(0, 1), "LINK_MOI_2 must be above 0 if the centre"),
        (TypeError, "AVAIL_TORQUE", Uniform(0, 1), " must be a sequence of 3 numbers, got 0"),
        (TypeError, "book_or_nips", Uniform(0, 1), " must be 'book' or 'nips', got 0"),
    ],
)
def test_a_rejected_parameter_changes_nothing(error, name, value, message, gymnasium_episodes):
    envs = make_vec(3, gymnasium_episodes=gymnasium_episodes)
    envs.LINK_MOI = 0.0
    for mass in (1.0, [1.0, 1.5, 2.0], Uniform(1.0, 2.0)):
        envs.LINK_MASS_1 = mass
        envs.reset(seed=1)
        with rejects(envs, error, message if "LINK_MOI" in message else f"^{name}{message}"):
            envs.set_attr(name, value)


def test_a_rejected_parameter_changes_no_single_environment():
    env = AcrobotEnv()
    for error, name, value in (
        (ValueError, "AVAIL_TORQUE", []),
        (ValueError, "book_or_nips", "paper"),
        (TypeError, "AVAIL_TORQUE", {-1.0, 0.0, 1.0}),
        (TypeError, "book_or_nips", None),
        (TypeError, "LINK_MASS_1", Uniform(1.0, 2.0)),
    ):
        with rejects(env, error, f"^{name}.* must "):
            setattr(env, name, value)


@pytest.mark.parametrize(
    ("name", "value", "number"),
    [
        ("LINK_MASS_1", [1.0, 1e-300, 1.0], "1e-300"),
        ("LINK_MASS_1", Uniform(0.4, 0.3), "0.4"),
        ("gravity", Normal(9.0, 1e300, 8.0, 10.0), "1e300"),
        ("AVAIL_TORQUE", Uniform((-1.0, 0.0, 1.0), (-1.0, 1e300, 1.0)), "1e300"),
    ],
)
def test_the_number_given_is_in_the_message(name, value, number):
    """Not the infinity, the 0 or the many digits that it becomes in float32."""
    envs = make_vec(3)
    with rejects(envs, ValueError, f"^{name}.* must be .*, got {number}$"):
        setattr(envs, name, value)


@pytest.mark.parametrize("name", sorted({*AcrobotVectorEnv._NAMES} - {"LINK_MOI", "book_or_nips"}))
def test_resets_draw_a_parameter_and_keep_others(name):
    """`test_recorded.py` has the order and the numbers of draws."""
    own = {each: np.linspace(0.5, 1.5, 20) for each in ("LINK_MASS_2", "dt")}
    envs, mask = make_vec(20, **own), np.arange(20) % 2 == 0
    draw = Uniform([0.1] * 3, [0.9, 0.9, 0.1]) if name == "AVAIL_TORQUE" else Uniform(0.1, 0.9)
    setattr(envs, name, draw)
    before = {each: envs.get_parameter(each) for each in envs._NAMES}
    assert getattr(envs, name) == draw
    envs.reset(options={"reset_mask": mask})
    after = {each: envs.get_parameter(each) for each in envs._NAMES}
    new, old = after.pop(name), before.pop(name)
    assert (0.0999 < new[mask]).all() and (new[mask] < 0.9001).all()
    assert (new != old).reshape(20, -1).any(axis=1).tolist() == mask.tolist()
    np.testing.assert_equal(after, before)
    setattr(envs, name, [1.0] * 3 if name == "AVAIL_TORQUE" else 1.0)
    envs.reset()
    assert (envs.get_parameter(name) == 1.0).all()


def test_links_can_have_their_own_inertias():
    envs = make_vec(3, LINK_MOI_1=0.5, LINK_MOI_2=LogUniform(1.0, 2.0))
    envs.reset(seed=1)
    assert (envs.get_parameter("LINK_MOI_1") == 0.5).all()
    assert (envs.get_parameter("LINK_MOI_2") > 1.0).all()
    with rejects(envs, TypeError, "LINK_MOI_1 must be a number, got None"):
        envs.LINK_MOI_1 = None
    with rejects(envs, TypeError, "LINK_MOI must be a number; a reset can .* LINK_MOI_2, got Unif"):
        envs.LINK_MOI = Uniform(1.0, 2.0)
    envs.LINK_MOI = 3.0
    assert envs.LINK_MOI_1 is None and (envs.get_parameter("LINK_MOI_1") == 3.0).all()


def test_subclasses_can_draw_parameters_which_spaces_follow():
    class Random(AcrobotContinuousVectorEnv):
        MAX_VEL_1 = Uniform(20.0, 30.0)
        AVAIL_TORQUE = Uniform([-3.0, 0.0, 1.0], [-2.0, 0.0, 2.0])

    envs = Random(50)
    assert envs.single_observation_space.high[4] == 30
    assert envs.single_action_space == gymnasium.spaces.Box(-3.0, 2.0, (1,), np.float32)
    envs.reset(seed=1)
    assert len(set(envs.get_attr("MAX_VEL_1"))) == 50
    envs.AVAIL_TORQUE = [[-1, 0, 1], [-5, 0, 1], [-1, 0, 4]] + [[0, 0, 0]] * 47
    assert envs.action_space == gymnasium.spaces.Box(-5.0, 4.0, (50, 1), np.float32)
