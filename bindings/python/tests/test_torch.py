"""A step in PyTorch: its gradients are those of differences and of exact Jacobians."""

import acrobot_rs
import numpy as np
import pytest
from acrobot_rs import control
from numpy.testing import assert_allclose

torch = pytest.importorskip("torch")
from acrobot_rs.torch import step  # noqa: E402

ENV = acrobot_rs.AcrobotEnv(dt=0.05, DAMPING_1=0.1, MAX_VEL_1=3.0)
WEIGHTS = np.arange(1.0, 5.0)


def tensors(*shape):
    generator = torch.Generator().manual_seed(len(shape))
    numbers = torch.rand(shape, generator=generator, dtype=torch.float64)
    return (4.0 * numbers - 2.0).requires_grad_()


def test_gradients_through_50_steps_are_those_of_a_chain_of_jacobians():
    given, torques = tensors(8, 4), tensors(50, 8, 1)[..., 0]
    torques.retain_grad()
    mass = torch.tensor(1.2, dtype=torch.float64, requires_grad=True)
    states, models = given, []
    for torque in torques:
        arrays = states.detach().numpy(), torque.detach().numpy()
        models.append(control.linearize_step(*arrays, ENV, {"LINK_MASS_2": 1.2}))
        states = step(states, torque, {"LINK_MASS_2": mass}, ENV)
    (states @ torch.from_numpy(WEIGHTS)).sum().backward()
    slope, by_mass, by_torques = np.tile(WEIGHTS, (8, 1)), 0.0, []
    for A, B, by_params in models[::-1]:
        by_torques.insert(0, np.einsum("ij,ijk->i", slope, B))
        by_mass += np.sum(slope * by_params["LINK_MASS_2"])
        slope = np.einsum("ij,ijk->ik", slope, A)
    for ours, exact in zip((given, torques, mass), (slope, by_torques, by_mass)):
        assert_allclose(ours.grad, exact, rtol=1e-10, atol=1e-10 * np.abs(exact).max())


def test_gradients_are_those_of_differences():
    def call(state, torque, length):
        return step(state, torque, {"LINK_LENGTH_1": length}, ENV)

    length = torch.tensor(0.9, dtype=torch.float64, requires_grad=True)
    assert torch.autograd.gradcheck(call, (tensors(3, 4), tensors(3), length), atol=1e-6)


def test_a_result_has_the_type_of_the_state():
    state = torch.zeros(4, requires_grad=True)
    found = step(state, 1)
    found.sum().backward()
    assert found.dtype == state.grad.dtype == torch.float32
    assert found.tolist() == np.float32(control.model.steps([0.0] * 4, 1, None, None)).tolist()
