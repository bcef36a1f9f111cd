# /// script
# requires-python = ">=3.11"
# dependencies = [
#   "crocoddyl==3.2.1", "pin==4.0.0", "diffilqrax==1.0.0", "gymnax==1.0.1", "jax==0.10.2", "six",
# ]
# ///
"""Times an iteration of planners, the best of 20: `uv run planner.py`."""

import os
import subprocess
import time
import timeit

os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})  # before JAX starts threads

import crocoddyl as croc
import jax
import numpy as np
import pinocchio as pin
from diffilqrax.ilqr import ilqr_solver
from diffilqrax.typs import ModelDims, System, iLQRParams
from gymnax.environments.classic_control import acrobot

DT, STEPS = 0.02, 100
START, GOAL = np.float32([1, 0, 0, 0]), np.float32([np.pi, 0, 0, 0])
guesses = np.random.default_rng(0).uniform(-1, 1, (16, STEPS, 1)).astype(np.float32)


def step(_, x, u, __):
    return acrobot.rk4(jax.numpy.append(x, u), acrobot.EnvParams(dt=DT))[:4]


def crocoddyl(integrate):
    model, joint = pin.Model(), 0
    # Crocoddyl gives a `root_joint` no motor.
    for name, height in [("root_joint", 0), ("elbow", -1)]:
        place = pin.SE3(np.eye(3), np.array([0, 0, height]))
        joint = model.addJoint(joint, pin.JointModelRX(), place, name)
        link = pin.Inertia(1, np.array([0, 0, -0.5]), np.eye(3))
        model.appendBodyToJoint(joint, link, pin.SE3.Identity())
    model.gravity.linear = np.array([0, 0, -9.8])
    state = croc.StateMultibody(model)
    motor = croc.ActuationModelFloatingBase(state)
    costs = croc.CostModelSum(state, 1)
    for name, residual in [
        ("state", croc.ResidualModelState(state, GOAL.astype(float), 1)),
        ("torque", croc.ResidualModelControl(state, 1)),
    ]:
        costs.addCost(name, croc.CostModelResidual(state, residual), 1)
    action = integrate(croc.DifferentialActionModelFreeFwdDynamics(state, motor, costs))
    action.u_lb, action.u_ub = -np.ones(1), np.ones(1)
    problem = croc.ShootingProblem(START.astype(float), [action] * STEPS, action)
    problem.nthreads = 1
    guess = list(guesses[0].astype(float))
    states = problem.rollout(guess)
    # With another version of Pinocchio there is no gravity.
    assert np.allclose(states[1], step(0, START, guess[0], 0), atol=0.01)
    solver = croc.SolverBoxDDP(problem)
    solver.solve(states, guess, 2, True)

    def run():
        for _ in range(8):
            solver.computeDirection(True)
            solver.tryStep(1)

    return run


def diffilqrax(iterations, guesses):
    system = System(
        lambda _, x, u, __: DT * ((x - GOAL) @ (x - GOAL) + u @ u),
        lambda x, _: (x - GOAL) @ (x - GOAL),
        step,
        ModelDims(4, 1, STEPS, DT),
    )
    start = iLQRParams(START, None)
    plan = lambda guess: ilqr_solver(system, start, guess, iterations, use_linesearch=False)
    run = jax.jit(jax.vmap(plan))
    return lambda: jax.block_until_ready(run(guesses))


runs = [
    crocoddyl(lambda motion: croc.IntegratedActionModelEuler(motion, DT)),
    crocoddyl(lambda motion: croc.IntegratedActionModelRK(motion, croc.RKType.four, DT)),
    *(diffilqrax(n, plans) for plans in [guesses[:1], guesses] for n in [1, 9]),
]
ours = "cargo run --quiet --release --locked --bin planner".split()
rounds = []
for _ in range(20):
    rounds.append([float(line) for line in subprocess.check_output(ours).split()])
    rounds[-1] += [timeit.timeit(run, timer=time.process_time, number=1) for run in runs]
a0, a8, s0, s8, euler, rk4, one1, one9, all1, all9 = np.min(rounds, axis=0) * 1e6 / 8
alone = (a8 - a0) / 160
for name, each in [
    ("acrobot, `improve`", alone),
    ("acrobot, `improve_all`, 16 side by side", (s8 - s0) / 160),
    ("Crocoddyl 3.2.1, Euler", euler),
    ("Crocoddyl 3.2.1, RK4", rk4),
    ("diffilqrax 1.0.0", one9 - one1),
    ("diffilqrax 1.0.0, 16 in `vmap`", (all9 - all1) / 16),
]:
    print(f"| {name} | {each:,.1f} | {each / alone:.2g} |")
