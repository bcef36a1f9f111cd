"""`acrobot_rs.control` has the bits of environments, and agrees with other people's programs."""

import acrobot_rs
import control as python_control
import gymnasium
import numpy as np
import pytest
from acrobot_rs import control
from numpy.testing import assert_allclose
from scipy.linalg import solve_discrete_are

PARAMS = {"LINK_MASS_1": 1.3, "LINK_LENGTH_1": 1.1, "gravity": 8.0, "dt": 0.05}
FRICTION = {**PARAMS, "LINK_MOI_1": 0.3, "FRICTION_1": 0.2, "FRICTION_2": 0.1}
SWINGUP = {**FRICTION, "AVAIL_TORQUE": (-1.0, 0.0, 1.0)}
HANGING = [0.0] * 4


@pytest.fixture
def rng():
    return np.random.default_rng(0)


def agree(ours, theirs):
    """Within 1e-10 of the largest element."""
    assert_allclose(ours, theirs, rtol=0, atol=1e-10 * np.abs(theirs).max())


@pytest.mark.parametrize(
    "env",
    [
        gymnasium.make("acrobot_rs/AcrobotContinuous-v0", book_or_nips="nips", **PARAMS),
        acrobot_rs.AcrobotSwingupEnv(**SWINGUP),
        acrobot_rs.AcrobotContinuousVectorEnv(3, **PARAMS),
        acrobot_rs.AcrobotContinuousVectorEnv(3, float64=True, **PARAMS),
        acrobot_rs.AcrobotContinuousVectorEnv(3, gymnasium_episodes=True, **PARAMS),
        acrobot_rs.AcrobotSwingupVectorEnv(3, **SWINGUP),
        acrobot_rs.AcrobotSwingupVectorEnv(3, float64=True, **SWINGUP),
    ],
)
def test_simulate_has_the_bits_of_an_environment(env, rng):
    env.reset(seed=1)
    expected = [env.unwrapped.state]
    torques = rng.uniform(-1, 1, (40, *env.action_space.shape)).astype(np.float32)
    for action in torques:
        env.step(action)
        expected.append(env.unwrapped.state)
    states = control.simulate(expected[0], np.moveaxis(torques[..., 0], 0, -1), env)
    assert (states == np.stack(expected, axis=-2)).all()


def test_a_mapping_has_the_arithmetic_of_the_first_environment(rng):
    torques = rng.uniform(-1, 1, 100)
    env = acrobot_rs.AcrobotEnv(**PARAMS)
    states = control.simulate(HANGING, torques, env)
    for params in PARAMS, env.parameters:
        assert control.simulate(HANGING, torques, params).tobytes() == states.tobytes()
    assert (control.simulate(HANGING, torques)[1:] != states[1:]).any(axis=-1).all()


def test_regulators_are_those_of_scipy_and_python_control(rng):
    for _ in range(200):
        A, B = control.linearize_step(rng.uniform(-1, 1, 4), 0.5, FRICTION)
        factor = rng.normal(size=(4, 4))
        Q, R = factor.T @ factor + np.eye(4), rng.uniform(0.1, 1)
        Q = (Q + Q.T) / 2
        K, P = control.lqr(A, B, Q, R)
        agree(P, solve_discrete_are(A, B, Q, R))
        agree(K, python_control.dlqr(A, B, Q, R)[0])
    assert (control.lqr(A, B[:, 0], Q, [[R]])[0] == K).all()
    model = control.linearize_step(control.UPRIGHT, 0.0, FRICTION)
    ours = np.vstack(control.regulator(Q, R, params=FRICTION))
    assert (ours == np.vstack(control.lqr(*model, Q, R))).all()


def test_linear_models_are_finite_differences(rng):
    """Of five points, about 200 states and torques."""
    points = rng.uniform(-1, 1, (200, 1, 5))

    def derivative(x):
        return control.derivative(x[..., :4], x[..., 4], FRICTION)

    def step(x):
        return control.simulate(x[..., :4], x[..., 4:], FRICTION)[..., 1, :]

    for linearize, function in (control.linearize, derivative), (control.linearize_step, step):
        models = linearize(points[:, 0, :4], points[:, 0, 4], FRICTION)
        moved = (w * function(points + k * 5e-4 * np.eye(5)) for k, w in WEIGHTS.items())
        agree(np.concatenate(models, axis=-1), np.swapaxes(sum(moved) / (12 * 5e-4), -1, -2))


WEIGHTS = {-2: 1, -1: -8, 1: 8, 2: -1}


def test_motions_obey_mechanics(rng):
    states = rng.uniform(-1, 1, (2, 3, 4))
    rates = control.derivative(states, [0.1, 0.2, 0.3], FRICTION)
    torques = control.inverse_dynamics(states, rates[..., 2:], FRICTION)
    assert_allclose(torques, [[[0, 0.1], [0, 0.2], [0, 0.3]]] * 2, atol=1e-13)
    velocity = states[..., 2:]
    kinetic = np.einsum(
        "...i,...ij,...j", velocity, control.mass_matrix(states, FRICTION), velocity
    )
    potential = control.energy(states * [1, 1, 0, 0], FRICTION)
    assert_allclose(control.energy(states, FRICTION), potential + kinetic / 2)


def test_differences_are_wrapped():
    assert_allclose(control.difference([-3.0, 7.0, 1.0, 2.0]), [np.pi - 3, 7 - 2 * np.pi, 1, 2])


@pytest.mark.parametrize(
    "function, arguments, message",
    [
        ("energy", ([0.0] * 3,), r"state must be .* shape \(\.\.\., 4\), got \(3,\)"),
        ("energy", ([np.nan] * 4,), "theta1 must be a finite number of rad, got NaN"),
        ("energy", (HANGING, {"dt": 0}), "dt must be finite and above 0 s, got 0"),
        ("energy", (HANGING, {"LINK_MOI": -1}), "LINK_MOI must be .* kg m², got -1"),
        ("energy", (HANGING, {"mass": 1}), "params must be .*LINK_LENGTH_1, .*got {'mass': 1}"),
        ("simulate", (HANGING, [np.inf]), "torque must be a finite number of N m, got inf"),
        ("lqr", (np.eye(4), [1] * 3, np.eye(4), 1), r"B must be .* \(\.\.\., 4, 1\), got \(3,\)"),
        ("lqr", (np.eye(4), [1] * 4, np.eye(4), 0), r"r must be .* \(N m\)², got 0"),
        ("regulator", (np.eye(4), 1, [1, 0, 0, 0]), "the state must be in equilibrium"),
    ],
)
def test_errors_say_what_is_valid(function, arguments, message):
    with pytest.raises(ValueError, match=message):
        getattr(control, function)(*arguments)


@pytest.mark.parametrize("dt, frames", [(0.01, 76), (0.2, 16)])
def test_an_animation_is_in_real_time(dt, frames, tmp_path):
    """Of one turn a second for 3 s, and a still picture for 2 s."""
    angles = np.arange(0, 3 + dt / 2, dt) * 2 * np.pi
    states = np.outer((angles + np.pi) % (2 * np.pi) - np.pi, [1, 0, 0, 0])
    control.Animation(states, {"dt": dt}).save(tmp_path / "turns.svg")
    text = (tmp_path / "turns.svg").read_text()
    values = text.split('values="')[1].split('"')[0].split(";")
    assert 'dur="5.000s"' in text and values[frames:] == ["-1080.0"] * round(2 / max(dt, 0.04))
    assert_allclose(np.float64(values[:frames]), np.linspace(0, -1080, frames), atol=0.06)
