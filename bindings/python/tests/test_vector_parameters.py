"""Parameters of each environment: values, draws, and what reads them."""

import gymnasium
import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousVectorEnv, AcrobotVectorEnv, LogUniform, Uniform
from vectors import make_vec


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
