"""`acrobot_rs.control` has the bits of environments, and agrees with other people's programs."""

import copy
import pickle
import signal
from zlib import crc32

import acrobot_rs
import control as python_control
import gymnasium
import numpy as np
import pytest
from acrobot_rs import control
from numpy.testing import assert_allclose
from scipy.differentiate import jacobian

PARAMS = {"LINK_MASS_1": 1.3, "dt": 0.05, "AVAIL_TORQUE": (-1.0, 0.0, 1.0)}
ENV = acrobot_rs.AcrobotSwingupEnv(DAMPING_1=0.2, LINK_MOI_1=0.3, **PARAMS)
ONE = np.eye(4)


def agree(ours, theirs):
    """Within 1e-10 of the largest element."""
    assert_allclose(ours, theirs, rtol=0, atol=1e-10 * np.abs(theirs).max())


@pytest.mark.parametrize(
    "env", [gymnasium.make("acrobot_rs/AcrobotContinuous-v0", **PARAMS), ENV, None]
)
def test_simulate_has_the_bits_of_an_environment(env):
    stepped = (env or acrobot_rs.AcrobotContinuousEnv()).unwrapped
    stepped.reset(options={"state": [2.5, 0.1, 0.0, 0.0]})  # a goal of Gymnasium's task
    torques, states = np.random.default_rng(0).uniform(-1, 1, 400), [stepped.state]
    for torque in torques:
        stepped.step([torque])
        states.append(stepped.state)
    assert control.simulate(states[0], torques, env).tobytes() == np.array(states).tobytes()


def test_regulators_are_those_of_python_control_and_scipy():
    rng = np.random.default_rng(0)
    for _ in range(200):
        state = rng.uniform(-1, 1, 4)
        factor = rng.normal(size=(4, 4))
        Q, R = factor @ factor.T + ONE, rng.uniform(0.1, 1)
        A, B = control.linearize(state, 0.5, ENV)
        pairs = [*zip(control.lqr(A, B, Q, R), python_control.lqr(A, B, Q, R, method="scipy"))]
        A, B = control.linearize_step(state, 0.5, ENV)
        K, P = control.dlqr(A, B, Q, R)
        pairs += zip((K, P), python_control.dlqr(A, B, Q, R, method="scipy"))
        for ours, theirs in pairs:
            agree(ours, theirs)
    assert (control.dlqr(A, B[:, 0], Q, [[R]])[0] == K).all()
    A, B = control.linearize_step(control.UPRIGHT, 0.0, ENV)
    agree(control.regulator(ONE, 0.1, env=ENV)[0], python_control.dlqr(A, B, ONE, 0.1)[0])


def test_linear_models_are_derivatives():
    x = np.random.default_rng(0).uniform(-1, 1, (5, 200))
    for linearize, function in (
        (control.linearize, lambda x: control.derivative(x.T[..., :4], x.T[..., 4], ENV).T),
        (
            control.linearize_step,
            lambda x: control.simulate(x.T[..., :4], x.T[..., 4:], ENV).T[:, 1],
        ),
    ):
        A, B = linearize(x[:4].T, x[4], ENV)
        agree(
            np.concatenate([A, B], axis=-1),
            jacobian(function, x, initial_step=0.1).df.transpose(2, 0, 1),
        )


def test_motions_obey_mechanics():
    states = np.random.default_rng(0).uniform(-1, 1, (2, 3, 4))
    accelerations = control.derivative(states, [0.1, 0.2, 0.3], ENV)[..., 2:]
    torques = control.inverse_dynamics(states, accelerations, ENV)
    assert_allclose(torques, [[[0, 0.1], [0, 0.2], [0, 0.3]]] * 2, atol=1e-13)
    momenta = control.mass_matrix(states, ENV) @ states[..., 2:, None]
    kinetic = control.energy(states, ENV) - control.energy(states * [1, 1, 0, 0], ENV)
    assert_allclose(kinetic, (states[..., 2:] * momenta[..., 0]).sum(axis=-1) / 2)


@pytest.mark.parametrize(
    "function, arguments, message",
    [
        ("energy", ([0.0] * 3,), r"state must be .* shape \(\.\.\., 4\), got \(3,\)"),
        ("simulate", ([0.0] * 4, [np.inf]), "torque must be a finite number of N m, got inf"),
        ("regulator", (ONE, 1, [1, 0, 0, 0]), "the state must be in equilibrium"),
        ("Planner", (0,), "the largest torque must be finite and above 0 N m, got 0"),
        ("SwingUp", (0,), "the largest torque must be finite and above 0 N m, got 0"),
    ],
)
def test_errors_say_what_is_valid(function, arguments, message):
    with pytest.raises(ValueError, match=message):
        getattr(control, function)(*arguments)


def test_a_plan_swings_an_environment_up_from_a_nearby_state():
    friction = {"DAMPING_1": 0.1, "COULOMB_2": 0.02}
    env = acrobot_rs.AcrobotContinuousEnv(dt=0.02, AVAIL_TORQUE=(-8, 0, 8), **friction)
    planner = control.Planner(6.0, env)
    plan = planner.plan([0, 0, 0, 0], steps=250)
    env.reset(options={"state": [0.05, -0.05, 0.1, 0.1]})
    for step in range(len(plan.torques) + 500):
        env.step([plan.torque(step, env.state)])
    assert np.abs(control.deviation(env.state)).max() < 0.01
    assert not planner.holds_from(plan.states[0])
    for lean in 1e-3, 3e-5:  # the latter with the gain at rest
        near = [np.pi - lean, 0.0, 0.0, 0.0]
        assert planner.holds_from(near)
        assert control.SwingUp(6.0, env).torque(near) == plan.torque(len(plan.torques), near)
    rest = plan[50:]
    assert rest.torque(1, near) == plan.torque(51, near) and rest.after is plan.after
    start = rest.states[0] + 0.01
    costs = [planner.improve(start, rest, n)[1] for n in (0, 1, 5)]
    assert costs[0] > costs[1] > costs[2]
    improved, cost = planner.improve(start, rest, 5)
    plans, costs = planner.improve_each([start, plan.states[0]], [rest, plan], 5)
    assert (plans[0].gains == improved.gains).all() and costs[0] == cost
    with pytest.raises(ValueError, match=r"states must be numbers of shape \(1, 4\), got"):
        planner.improve_each([start, start], [plan])


def test_a_plan_ends_with_a_bent_elbow():
    env = acrobot_rs.AcrobotEnv(dt=0.02)
    plan = control.Planner(12.0, env, elbow=1.0).plan([0, 0, 0, 0], steps=300)
    plan = copy.deepcopy(pickle.loads(pickle.dumps(plan)))
    state = plan.states[0]
    for step in range(len(plan.torques) + 300):
        torque = np.clip(plan.torque(step, state), -12, 12)
        state = control.simulate(state, [torque], env)[-1]
    assert np.abs(control.deviation(state, plan.after.target)).max() < 0.01
    assert plan.after.target[1] == 1.0
    with pytest.raises(ValueError, match="step must be an integer from 0 .* got -1"):
        plan.torque(-1, state)
    with pytest.raises(ValueError, match="dtheta1 must be a finite number of rad/s, got inf"):
        plan.torque(0, [0, 0, 1e300, 0])


def test_a_plan_has_the_bits_of_rust():
    """The digest of `tests/bits/src/plan.rs`, of a plan and of an acrobot that follows it."""
    params = {"dt": 0.01, "AVAIL_TORQUE": (-10, 0, 10)}
    envs = acrobot_rs.AcrobotContinuousVectorEnv(1, **params)
    env = acrobot_rs.AcrobotEnv(**params)
    env.reset(seed=0)
    plan = control.Planner(7, env).plan([0] * 4, steps=1100)
    state, words = env.state, [1]
    for step, (before, gain) in enumerate(zip(plan.states, plan.gains)):
        envs.reset(options={"state": state})  # it does not end beyond the target height
        envs.step([[plan.torque(step, state)]])
        [state] = envs.state
        numbers = np.concatenate([before, state, gain, plan.torques[[step] * 4]])
        words += [1, *numbers.view(np.uint32).tolist()]
    digest = 0xCBF29CE484222325
    for word in words:
        digest = (digest ^ word) * 0x100000001B3 % 2**64
    assert digest == 0x875C0DC9E0FB48AB


def test_weights_and_portions_of_tries_have_the_effect_of_rusts():
    env = acrobot_rs.AcrobotEnv(dt=0.02, DAMPING_1=0.1, MAX_VEL_1=4)
    weights = {"torque": 0.2, "torque_change": 0.1, "power": 0.3, "below": 3, "height": 1.9}
    weights |= {"margin": 0.3, "arrival": 10, "angles": (0.1, 0.2), "q": [0, 0, 0.01, 0.02]}
    weights |= {"qf": np.diag([0.3, 0, 0, 0])}
    planner = control.Planner(12, env, velocity_clamp=True, **weights)
    calls = []
    plan = planner.plan([0.1, 0.2, 0.3, 0.4], steps=130, seed=2, progress=calls.append)
    assert calls == [40], "the second portion has it"
    digests = [crc32(each.tobytes()) for each in (plan.states, plan.torques, plan.gains)]
    assert digests == [3593896818, 2751133738, 2782251845]  # of Rust's `plan`
    with pytest.raises(ValueError, match=r"q must be numbers of shape .* or \(4,\), got \(3,\)"):
        control.Planner(1, q=[1, 1, 1])
    with pytest.raises(ValueError, match="qf must be positive semidefinite"):
        control.Planner(1, qf=[1, 1, 1, -1])


def test_a_search_can_be_interrupted_or_find_no_plan():
    planner, calls = control.Planner(1e-3), []
    with pytest.raises(ValueError, match="steps must be an integer from 0 to 65535, got 65536"):
        planner.plan([0, 0, 0, 0], steps=2**16)
    with pytest.raises(RuntimeError, match="no plan ends upright in 41 tries"):
        planner.plan([0, 0, 0, 0], steps=50, tries=41, progress=calls.append)
    assert calls == [40, 41]
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in the background of a shell
    with pytest.raises(KeyboardInterrupt):
        planner.plan([0, 0, 0, 0], steps=50, progress=lambda _: signal.raise_signal(signal.SIGINT))


@pytest.mark.parametrize("dt, frames", [(0.01, 76), (0.2, 16)])
def test_an_animation_is_in_real_time(dt, frames, tmp_path):
    """Three turns in 3 s, which pass the jump of the angle."""
    states = np.outer(np.arange(0, 3 + dt / 2, dt) * 2 * np.pi, [1, 0, 0, 0])
    animation = control.Animation(control.deviation(states), acrobot_rs.AcrobotEnv(dt=dt))
    animation.save(tmp_path / "turns.svg")
    text = (tmp_path / "turns.svg").read_text()
    values = np.float64(text.split('values="')[1].split('"')[0].split(";"))
    assert 'dur="3.000s"' in text
    assert_allclose(values - values[0], np.linspace(0, -1080, frames), atol=0.11)


def shaken():
    """Ten seconds of a machine with friction, its encoders and its motor."""
    env = acrobot_rs.AcrobotSwingupEnv(dt=0.002, COULOMB_1=0.1, LINK_MASS_2=1.2)
    torques = np.repeat(np.random.default_rng(0).uniform(-6, 6, 40), 125)
    states = control.simulate([0.0] * 4, torques, env)[:-1]
    count = 2 * np.pi / 4096
    return env, states, np.round(states[:, :2] / count) * count, torques


def test_a_recording_tells_the_machine():
    env, _, angles, torques = shaken()
    angles = np.unwrap(angles, axis=0)
    wrong = acrobot_rs.AcrobotSwingupEnv(dt=0.002)
    found = control.identify([angles], [torques], wrong)
    assert found.rank_deficiency == 0 and found.std_errors["mass22"] < 0.01
    assert_allclose(found.values["coulomb1"], 0.1, rtol=0.1)
    again = acrobot_rs.AcrobotSwingupEnv(**found.params)
    at = [0.3, 1.0, 0.0, 0.0]
    assert_allclose(control.mass_matrix(at, again), control.mass_matrix(at, env), rtol=0.01)
    with pytest.raises(ValueError, match=r"angles must be an array of shape \(5000, 2\)"):
        control.identify([angles[:-1]], [torques], wrong)


def test_angles_tell_the_state_and_a_mass():
    _, states, angles, torques = shaken()
    model = acrobot_rs.AcrobotSwingupEnv(dt=0.002, COULOMB_1=0.1)
    noise = {"angle_std": 1.8 / 4096, "torque_std": 0.05}
    known = control.Estimator(model, **noise)
    estimator = control.Estimator(model, **noise, parameter_std={"LINK_MASS_2": 0.3})
    assert estimator.state_std is None
    found = []
    for measured, torque in zip(angles, torques):
        found.append(estimator.correct(measured))
        known.correct(measured)
        estimator.predict(torque)
        known.predict(torque)
    assert known.params["LINK_MASS_2"] == 1.0
    assert_allclose(estimator.params["LINK_MASS_2"], 1.2, rtol=0.01)
    assert np.sqrt(np.mean(np.square((found - states)[2500:, 2:]))) < 0.1
    assert (estimator.state_std[2:] < 0.1).all()
    for name in control.estimate._ESTIMATED:
        with pytest.raises(ValueError, match=f"{name} must be finite and at least 0"):
            control.Estimator(model, **noise, parameter_std={name: -1.0})
    with pytest.raises(ValueError, match=r"parameter_std must be of LINK_MASS_1, .* \['dt'\]"):
        control.Estimator(model, **noise, parameter_std={"dt": 0.1})
