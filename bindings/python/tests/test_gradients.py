"""A step in JAX: its gradients are those of differences and of exact Jacobians.

``test_torch.py`` has the same for PyTorch.
"""

import acrobot_rs
import numpy as np
import pytest
from acrobot_rs import control
from numpy.testing import assert_allclose

jax = pytest.importorskip("jax")
jnp = jax.numpy
jax.config.update("jax_enable_x64", True)
from acrobot_rs.jax import step  # noqa: E402
from jax.test_util import check_grads  # noqa: E402

ENV = acrobot_rs.AcrobotEnv(dt=0.05, DAMPING_1=0.1, MAX_VEL_1=3.0)
PARAMS = {"LINK_MASS_2": 1.2, "COULOMB_2": 0.1}
STATES = np.random.default_rng(0).uniform(-3.0, 3.0, (8, 4))
TORQUES = np.random.default_rng(1).uniform(-2.0, 2.0, (50, 8))


def rollout(states, torques, params):
    for torque in torques:
        states = step(states, torque, params, ENV)
    return jnp.sum(states * jnp.arange(1.0, 5.0))


def chain():
    """The gradient of `rollout`, by exact Jacobians backwards."""
    states, models = STATES, []
    for torque in TORQUES:
        models.append(control.linearize_step(states, torque, ENV, PARAMS))
        states = control.model.steps(states, torque, ENV, PARAMS)
    slope, by_torques, by_params = (
        np.tile(np.arange(1.0, 5.0), (8, 1)),
        [],
        dict.fromkeys(PARAMS, 0),
    )
    for A, B, by_step in models[::-1]:
        by_torques.insert(0, np.einsum("ij,ijk->i", slope, B))
        by_params = {name: by_params[name] + np.sum(slope * x) for name, x in by_step.items()}
        slope = np.einsum("ij,ijk->ik", slope, A)
    return slope, np.array(by_torques), by_params


def test_gradients_through_50_steps_are_those_of_a_chain_of_jacobians():
    found = jax.jit(jax.grad(rollout, (0, 1, 2)))(STATES, TORQUES, PARAMS)
    for ours, exact in zip(jax.tree.leaves(found), jax.tree.leaves(chain()), strict=True):
        assert_allclose(ours, exact, rtol=1e-10, atol=1e-10 * np.abs(exact).max())


def test_gradients_are_those_of_differences():
    check_grads(rollout, (STATES, TORQUES[:3], PARAMS), 1, atol=1e-5)


def test_vmap_over_anything():
    one = jax.vmap(lambda state, torque, mass: step(state, torque, {"LINK_MASS_2": mass}, ENV))
    masses = np.linspace(0.5, 1.5, 8)
    each = control.model.steps(STATES, TORQUES[0], ENV, {"LINK_MASS_2": masses})
    assert_allclose(one(STATES, TORQUES[0], masses), each, rtol=0)
    shared = jax.vmap(lambda state: step(state, 0.5, None, ENV))
    assert_allclose(shared(STATES), control.model.steps(STATES, 0.5, ENV, None), rtol=0)
    by_state = jax.jit(jax.vmap(jax.jacfwd(lambda state: step(state, 0.5, PARAMS, ENV))))
    A, _, _ = control.linearize_step(STATES, 0.5, ENV, PARAMS)
    assert_allclose(by_state(STATES), A, rtol=0)


def test_a_clamped_velocity_has_no_gradient_and_nothing_is_nan():
    states = np.random.default_rng(2).uniform(-1.0, 1.0, (1000, 4)) * [1e6, 1e6, 1e3, 1e3]
    slopes = jax.vmap(jax.jacrev(lambda state: step(state, 1.0, None, ENV)))(states)
    assert np.isfinite(slopes).all()
    fast = np.abs(control.model.steps(states, 1.0, ENV, None)[:, 2]) == 3.0
    assert fast.sum() > 900 and not slopes[fast, 2].any()
