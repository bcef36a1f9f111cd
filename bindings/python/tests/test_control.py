"""`acrobot_rs.control` has the bits of environments, and agrees with other people's programs."""

import copy
import inspect
import pickle
import re
import signal
import threading
import time
from zlib import crc32

import acrobot_rs
import control as python_control
import gymnasium
import numpy as np
import pytest
from acrobot_rs import control
from numpy.testing import assert_allclose

PARAMS = {"LINK_MASS_1": 1.3, "dt": 0.05, "AVAIL_TORQUE": (-1.0, 0.0, 1.0)}
ENV = acrobot_rs.AcrobotSwingupEnv(DAMPING_1=0.2, LINK_MOI_1=0.3, **PARAMS)
ONE = np.eye(4)


@pytest.mark.parametrize(
    ("env", "torques"),
    [
        (gymnasium.make("acrobot_rs/AcrobotContinuous-v0", **PARAMS), [0.5, -3.0, 2.0]),
        *((ENV, torques) for torques in ([-1.0, 3.0], [1.0, 3.0])),
        (None, [-1.0, 0.0, 1.0]),
    ],
)
def test_simulate_has_the_bits_of_an_environment(env, torques):
    """An action is a torque, or in a swing-up a part of one. Torques are clipped."""
    stepped = (env or acrobot_rs.AcrobotContinuousEnv()).unwrapped
    stepped.AVAIL_TORQUE, low, high = torques, min(torques), max(torques)
    stepped.reset(options={"state": [2.5, 0.1, 0.0, 0.0]})  # a goal of Gymnasium's task
    actions, states = [*np.random.default_rng(0).uniform(-4, 4, 400), 0.0, np.inf], [stepped.state]
    for action in actions:
        stepped.step([action])
        states.append(stepped.state)
    if env is ENV:
        actions = np.clip(actions, -1, 1) * np.where(np.less(actions, 0), -low, high)
    simulated = control.simulate(states[0], np.clip(actions, low, high), env)
    assert simulated.tobytes() == np.array(states).tobytes()


def test_arrays_broadcast():
    states = np.random.default_rng(0).uniform(-1, 1, (2, 3, 4))
    accelerations = control.derivative(states, [0.1, 0.2, 0.3], ENV)[..., 2:]
    torques = control.inverse_dynamics(states, accelerations, ENV)
    assert_allclose(torques, [[[0, 0.1], [0, 0.2], [0, 0.3]]] * 2, atol=1e-13)


def test_a_step_is_linearized_by_any_parameter():
    states = np.random.default_rng(0).uniform(-2, 2, (2, 3, 4))
    given = {"LINK_MOI": 0.4, "dt": np.array([0.05, 0.1, 0.15]), "MAX_VEL_2": 2.0}
    A, B, by_params = control.linearize_step(states, 0.5, ENV, given)
    assert A.shape == (2, 3, 4, 4) and B.shape == (2, 3, 4, 1) and [*by_params] == [*given]
    for name, slopes in by_params.items():
        more, less = ({**given, name: given[name] + h} for h in (1e-6, -1e-6))
        rise = control.model.steps(states, 0.5, ENV, more) - control.model.steps(
            states, 0.5, ENV, less
        )
        assert_allclose(slopes, rise / 2e-6, rtol=1e-6, atol=1e-8)
    clamped = np.abs(control.model.steps(states, 0.5, ENV, given)[..., 3]) == 2.0
    assert clamped.any() and (by_params["MAX_VEL_2"][clamped, 3] ** 2 == 1.0).all()
    assert not A[clamped, 3].any() and A[~clamped, 3].all() and not B[clamped, 3].any()
    assert control.linearize_step(np.zeros((0, 4)))[0].shape == (0, 4, 4)


@pytest.mark.parametrize("name", ["lqr", "dlqr"])
def test_regulators_have_the_shapes_of_python_control(name):
    """`test_recorded.py` has the numbers."""
    A, B = control.linearize(control.UPRIGHT, 0.0, ENV)
    ours, theirs = getattr(control, name), getattr(python_control, name)
    for found, expected in zip(ours(A, B, ONE, 0.1), theirs(A, B, ONE, 0.1, method="scipy")):
        assert_allclose(found, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


REST, NAN = [0.0] * 4, np.nan
FRICTION = acrobot_rs.AcrobotEnv(dt=0.02, DAMPING_1=0.1, COULOMB_2=0.02)
PLANNER = control.Planner(6.0, FRICTION)
PLAN = PLANNER.plan(REST, steps=250)
NOISE = {"angle_std": 1e-3, "torque_std": 0.05}
ESTIMATED, ESTIMATOR = control.estimate._ESTIMATED, control.Estimator(**NOISE)
SETTINGS = {"limit": 6.0, "counts": [4096, 4096], "delay": 0.01, "plan_timeout": 1.0}
CONTROLLER = control.Controller(ENV, **SETTINGS)
REPLANNER = control.Replanner(ENV, **SETTINGS)
MODEL = dict(zip("AB", control.linearize_step(control.UPRIGHT)), Q=ONE, R=1.0)
#: Valid values of all arguments, by their names.
WEIGHTS = "torque", "torque_change", "power", "below", "height", "margin", "arrival"
VALUES = dict.fromkeys((*WEIGHTS, "max_torque", "inertia", "gear"), 1.0) | NOISE | MODEL
VALUES |= dict.fromkeys(("state", "target"), REST) | dict.fromkeys(("q", "qf", "Qf"), ONE)
VALUES |= {"accelerations": [0.0] * 2, "torques": [1.0], "angles": [0.0] * 2, "env": ENV}
VALUES |= {"W": ONE, "S": [1.0] * 2}
VALUES |= {"step": 0, "steps": 9, "tries": 1, "seed": 0, "progress": print, "iterations": 1}
VALUES |= {"plan": PLAN, "plans": [PLAN], "states": [REST]}
VALUES |= {"velocity_clamp": True, "parameter_std": {}, "elbow": 0.0, "inertias": [1.0] * 2}
VALUES |= {"path": "plan.rs", "gain": REST, "params": {}}
VALUES |= SETTINGS | {"controller": CONTROLLER}
CALLS = [
    *(getattr(control, each) for each in control.__all__ if each[0].islower()),
    *(control.Animation, control.Estimator, ESTIMATOR.correct, ESTIMATOR.predict),
    *(
        control.Planner,
        PLANNER.plan,
        PLANNER.plan_each,
        PLANNER.improve,
        PLANNER.improve_each,
        PLANNER.holds_from,
    ),
    *(control.Controller, CONTROLLER.tick, control.Replanner, REPLANNER.exchange),
    *(PLAN.torque, control.SwingUp, control.SwingUp(6.0).torque),
]
NO_ARRAYS = "plan", "plans", "parameter_std", "controller", "path", "params"
RECORDING = {"angles": [[[0.0, 0.1]] * 9], "torques": [[0.0] * 9]}
OTHERS = gymnasium.make("Acrobot-v1"), acrobot_rs.AcrobotVectorEnv(2), acrobot_rs.AcrobotEnv


@pytest.mark.parametrize(
    "call, name", [(call, name) for call in CALLS for name in inspect.signature(call).parameters]
)
def test_an_error_names_the_argument_the_rule_and_the_value(call, name):
    names = inspect.signature(call).parameters
    values = VALUES | (RECORDING if call == control.identify else {})
    for bad in (NAN, -np.inf, "a", {}, *OTHERS * (name == "env")):
        is_array = isinstance(bad, float) and name not in NO_ARRAYS
        value = np.full(np.shape(values[name]), bad) if is_array else bad
        if (name, value) not in (("parameter_std", {}), ("params", {})):
            with pytest.raises((ValueError, TypeError)) as error:
                call(**{each: values[each] for each in names} | {name: value})
            assert re.match(rf"{name} must be .*, got .*{re.escape(repr(bad))}", str(error.value))


def std(**parameter_std):
    return control.Estimator(**NOISE, parameter_std=parameter_std)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: control.energy([0.0] * 3), r"state must be .* \(\.\.\., 4\), got \(3,\)"),
        (lambda: control.energy([0, 0, 0, 1e300]), "numbers must be .* energy is finite, got inf"),
        (lambda: control.simulate([REST] * 2, [[0]] * 3), "state, torques must be arrays that br"),
        (lambda: control.lqr(**MODEL | {"Q": -ONE}), "Q must be positive semidefinite"),
        (lambda: control.Planner(1e-60), "max_torque .* in the range of float32, got 1e-60"),
        (lambda: control.Planner(6, power=-0.3), "power must be .* at least 0 per J, got -0.3$"),
        (lambda: control.Planner(6, qf=ONE + 0.1 * np.eye(4, k=1)), "symmetric, got 0.1 and 0 on"),
        (lambda: PLAN.torque(0, [0, 0, 1e39, 0]), r"state .* float32, got 1e\+39 at \[2\]"),
        (lambda: PLAN.torque(0, [0, 0, 0, 1e38]), "state must be so near the plan"),
        *((lambda x=x: PLAN.torque(x, REST), f"step .*, got {x}") for x in (-1, True, 1.5, 2**70)),
        *((lambda x=x: PLANNER.plan(REST, steps=x), "steps .* 1 to 65535") for x in (0, 2**16)),
        *((lambda x=x: PLANNER.plan(REST, steps=9, tries=x), "tries .* 1 to") for x in (0, 2**32)),
        *((lambda x=x: PLANNER.plan(REST, steps=9, seed=x), "seed .* least 0") for x in (-1, True)),
        *((lambda x=x: PLAN[x], "a slice without gaps") for x in (5, slice(None, None, 2))),
        *((lambda x=x: std(**{x: -1}), rf"\['{x}'\] must .*, got -1") for x in ESTIMATED),
        *(
            (
                lambda x=x: control.linearize_step(REST, params={x: 1.0}),
                "params must be a dict of LI",
            )
            for x in ("AVAIL_TORQUE", "torque_noise_max", "book_or_nips")
        ),
        (lambda: control.linearize_step(REST, params={"dt": [0.1, -1]}), r"dt\[1\] must .* got -1"),
        (lambda: control.linearize_step(REST, params={"dt": "x"}), "dt must be a finite number"),
        (
            lambda: control.linearize_step([0, 0, 1e200, 0]),
            "a must be finite in each element, got NaN",
        ),
        (lambda: std(dt=1), r"parameter_std must be a dict of LINK_MASS_1, .* got \{'dt': 1\}"),
    ],
)
def test_an_error_shows_the_number_as_given(call, message):
    with pytest.raises((ValueError, TypeError), match=message):
        call()


def test_plans_are_cut_compared_and_improved():
    rest, start = PLAN[50:], PLAN.states[50] + 0.01
    assert not PLANNER.holds_from(PLAN.states[0])
    for lean in 1e-3, 3e-5:  # the latter with the gain at rest
        near = [np.pi - lean, 0.0, 0.0, 0.0]
        assert PLANNER.holds_from(near) and rest.torque(1, near) == PLAN.torque(51, near)
        assert control.SwingUp(6.0, FRICTION).torque(near) == PLAN.torque(len(PLAN), near)
    assert PLAN == copy.deepcopy(pickle.loads(pickle.dumps(PLAN))) != rest
    improved, cost = PLANNER.improve(start, rest, 5)
    plans, costs = PLANNER.improve_each([start, PLAN.states[0]], [rest, PLAN], 5)
    assert plans[0] == improved != rest and costs[0] == cost < PLANNER.improve(start, rest, 0)[1]


def test_weights_and_portions_of_tries_have_the_effect_of_rusts():
    env = acrobot_rs.AcrobotEnv(dt=0.02, DAMPING_1=0.1, MAX_VEL_1=4)
    weights = {"torque": 0.2, "torque_change": 0.1, "power": 0.3, "below": 3, "height": 1.9}
    weights |= {"margin": 0.3, "arrival": 10, "angles": (0.1, 0.2), "q": [0, 0, 0.01, 0.02]}
    weights |= {"qf": np.diag([0.3, 0, 0, 0])}
    planner = control.Planner(12, env, velocity_clamp=True, **weights)
    calls = []
    plan = planner.plan([0.1, 0.2, 0.3, 0.4], steps=130, seed=2, progress=calls.append)
    assert calls == [40], "the second portion has it"
    twin = pickle.loads(pickle.dumps(planner))
    assert twin.plan([0.1, 0.2, 0.3, 0.4], steps=130, seed=2) == plan
    digests = [crc32(each.tobytes()) for each in (plan.states, plan.torques, plan.gains)]
    assert digests == [3593896818, 2751133738, 2782251845]  # of Rust's `plan`


def test_a_search_can_be_interrupted_or_find_no_plan():
    planner, calls = control.Planner(1e-3), []

    def progress(tries):  # it and other threads may use the planner between portions
        calls.append((tries, planner.holds_from(control.UPRIGHT)))

    with pytest.raises(RuntimeError, match="no plan ends upright in 41 tries"):
        planner.plan([0, 0, 0, 0], steps=50, tries=41, seed=2**70, progress=progress)
    assert calls == [(40, True), (41, True)]
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in the background of a shell
    with pytest.raises(KeyboardInterrupt):
        planner.plan([0, 0, 0, 0], steps=50, progress=lambda _: signal.raise_signal(signal.SIGINT))


def test_plans_from_many_states_are_those_from_each():
    angles = np.linspace(-np.pi, np.pi, 8)
    states, calls = np.stack([angles, 0 * angles, 0 * angles, angles], axis=1), []
    arguments = {"steps": 80, "tries": 12, "seed": 3}
    plans, mask = PLANNER.plan_each(states, **arguments, progress=calls.append)
    for state, plan, has_plan in zip(states, plans, mask, strict=True):
        assert has_plan == (plan is not None)
        try:
            assert PLANNER.plan(state, **arguments) == plan
        except RuntimeError:
            assert plan is None
    assert 0 < mask.sum() < 8 and calls[-1] == mask.sum() and calls == sorted(calls)
    assert PLANNER.plan_each(np.zeros((0, 4)), steps=9)[0] == []


def test_ctrl_c_ends_a_search_from_many_states():
    signal.signal(signal.SIGINT, signal.default_int_handler)
    begin = time.perf_counter()
    threading.Timer(0.3, signal.pthread_kill, (threading.get_ident(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        control.Planner(1e-3).plan_each(np.zeros((99, 4)), steps=65_535)
    assert time.perf_counter() - begin < 1.3


def test_a_plan_ends_in_the_target():
    bent = control.Planner(12.0, FRICTION, elbow=1.0).plan(REST, steps=200)
    again = control.Planner(12.0, FRICTION, target=bent.after.target).plan(REST, steps=200)
    assert_allclose(again.after.torque, bent.after.torque, rtol=1e-5)
    brake = control.Planner(6.0, FRICTION, target=REST, q=ONE, qf=ONE, below=0, arrival=0)
    plan = pickle.loads(pickle.dumps(brake)).plan([1.0, 0.5, -1.0, 0.0], steps=150)
    path = control.simulate([1.0, 0.5, -1.0, 0.0], plan.torques, FRICTION)
    assert_allclose(path[:-1], plan.states, atol=1e-3)
    assert plan.after.target == REST and brake.holds_from(path[-1])


def test_parameters_of_data_sheets():
    """A rotor on link 1 turns at θ̇1 - 6 θ̇2."""
    rotor = acrobot_rs.AcrobotEnv(**control.with_rotor(0.01, 6.0, ENV))
    state = [0.0, 0.7, 0.0, 0.0]
    added = control.mass_matrix(state, rotor) - control.mass_matrix(state, ENV)
    assert_allclose(added, 0.01 * np.outer([1.0, -6.0], [1.0, -6.0]), atol=1e-12)
    about = acrobot_rs.AcrobotEnv(**control.with_inertias_about_joints([0.9, 0.8], ENV))
    assert_allclose(control.mass_matrix(state, about)[1, 1], 0.8)
    assert about.parameters["DAMPING_1"] == 0.2 and about.dt == 0.05
    with pytest.raises(ValueError, match="LINK_MOI_1 must be .* got -"):
        control.with_inertias_about_joints([0.1, 0.8], ENV)


def test_what_is_found_is_saved_for_firmware(tmp_path):
    """`test_docs.py` has whole files, which firmware embeds."""
    nips = acrobot_rs.AcrobotEnv(**PARAMS, book_or_nips="nips")
    params = control.with_rotor(2.5e-8, 6.0, nips)
    control.Fit(params, {}, {}, {}, 0).save(tmp_path / "machine.rs")
    control.save(tmp_path / "machine.h", gain=ONE[0], params=acrobot_rs.AcrobotEnv(**params))
    rust, c = ((tmp_path / f"machine.{end}").read_text() for end in ("rs", "h"))
    for part in ("    mass1: 1.3,", "    rotor: 1.05e-6,", "[-1.0, 0.0, 1.0],", "Dynamics::Nips,"):
        assert f"{part}\n" in rust
    for part in ("GAIN[4] = {1.0, 0.0, 0.0, 0.0};", "    1.05e-6, // rotor", "_DYNAMICS_NIPS,"):
        assert f"{part}\n" in c
    PLAN.save(tmp_path / "plan.rs")
    assert f"[Knot<f32>; {len(PLAN)}]" in (tmp_path / "plan.rs").read_text()
    with pytest.raises(ValueError, match=r"path must be a file that ends in \.rs or \.h, got 'x'"):
        control.save("x", gain=REST)


def test_a_calibration_is_reported_and_plotted():
    env = acrobot_rs.AcrobotSwingupEnv(dt=0.01)
    torques = np.repeat(np.random.default_rng(0).uniform(-2.0, 2.0, 80), 25)
    late = np.concatenate([np.zeros(3), torques[:-3]])
    angles = np.unwrap(control.simulate([0, 0, 0, 0], late, env)[:-1, :2], axis=0)
    angles = np.round((angles + [0.1, -0.2]) / 1e-3) * 1e-3
    found = control.calibrate(angles, torques, env)
    assert found.angle_noise == pytest.approx(1e-3 / 12**0.5, rel=0.03)
    ratio = round(found.prediction_error / found.angle_noise)
    assert f"rad: {ratio} times the noise of the angles." in str(found)
    assert "coulomb1 is not told, only that it is below" in str(found)  # there is none
    assert "damping1 is not told" not in str(found)

    recorded, predicted = np.split(np.array(found.plot(angles, torques).lines), [2])
    for i, line in enumerate(predicted):
        expected = np.interp(line.get_xdata(), *recorded[i % 2].get_data())
        assert_allclose(line.get_ydata(), expected, atol=0.05)
    assert len(predicted) == 2 * 40  # half seconds
    with pytest.raises(ValueError, match="torques must be finite numbers of N m"):
        found.plot(angles, np.zeros((len(angles), 2)))


def test_a_clamped_velocity_is_said():
    env = acrobot_rs.AcrobotEnv(dt=0.05, MAX_VEL_2=3.0)
    with pytest.warns(UserWarning, match=r"at its bound, .*: MAX_VEL_2=3.0000 rad/s") as caught:
        control.simulate(REST, [9.0] * 20, env)
    assert caught[0].filename == __file__
    control.simulate(REST, [9.0], env)  # below the bound: without a warning


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


@pytest.mark.parametrize(
    "again", [copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))]
)
def test_copies_continue(again):
    swing_up, far = control.SwingUp(6.0, FRICTION), [np.pi - 0.3, 0.0, 0.0, 0.0]
    pumping = again(swing_up)
    swing_up.torque(control.UPRIGHT)  # from now on it holds, and pumps no energy
    assert again(swing_up).torque(far) == swing_up.torque(far) != pumping.torque(far)
    estimator = std(LINK_MASS_2=0.3)
    for tick in range(9):
        twin = again(estimator)
        for each in estimator, twin:
            each.correct([0.1 * tick, -0.1])
            each.predict(0.5)
        assert twin.params == estimator.params and (twin.state_std == estimator.state_std).all()
    assert estimator.params["LINK_MASS_2"] != 1.0
