"""Our controller for RealAIGym's board of robustness, in their own harness, at 1e8544e.

git clone https://github.com/dfki-ric-underactuated-lab/double_pendulum
cp con_acrobot.py double_pendulum/leaderboard/acrobot/robustness_v2
cd double_pendulum/leaderboard/acrobot/robustness_v2
PYTHONPATH=../../../src/python python benchmark_controller.py con_acrobot.py

It needs pip install acrobot-rs pandas pyyaml matplotlib, and half an hour.
"""

import numpy as np
from acrobot_rs import AcrobotEnv
from acrobot_rs.control import Estimator, Plan, Planner, simulate
from double_pendulum.controller.abstract_controller import AbstractController
from sim_parameters import dt, mpar

LIMIT = 6.0  # N m
DECISION, PLANNING, MODEL = 5, 10, 200  # ticks between decisions, plans and models
# Estimators for delays of so many ticks. The likeliest one stays.
DELAYS = range(0, 21, 2)
CHOOSING = 1500  # ticks
(MASS1, MASS2), (COM1, COM2), (INERTIA1, INERTIA2) = mpar.m, mpar.r, mpar.I
PARAMS = {
    "LINK_LENGTH_1": mpar.l[0],
    "LINK_LENGTH_2": mpar.l[1],
    "LINK_MASS_1": MASS1,
    "LINK_MASS_2": MASS2,
    "LINK_COM_POS_1": COM1,
    "LINK_COM_POS_2": COM2,
    "LINK_MOI_1": INERTIA1 - MASS1 * COM1**2,
    "LINK_MOI_2": INERTIA2 - MASS2 * COM2**2,
    "gravity": mpar.g,
    "MAX_VEL_1": np.inf,
    "MAX_VEL_2": np.inf,
    "dt": dt,
}
PARAMETER_STD = {
    "LINK_MASS_1": 0.2 * MASS1,
    "LINK_MASS_2": 0.2 * MASS2,
    "LINK_MOI_1": 0.2 * INERTIA1,
    "LINK_MOI_2": 0.2 * INERTIA2,
    "DAMPING_1": 0.03,
    "DAMPING_2": 0.03,
    "COULOMB_1": 0.08,
    "COULOMB_2": 0.08,
}


def plan_of_zeros(steps):
    rows, torques = np.zeros((steps, 4), np.float32), np.zeros(steps, np.float32)
    return Plan(rows, torques, rows, DECISION * dt, None)  # it is followed for one step


class Acrobot(AbstractController):
    def init_(self):
        noise = {"angle_std": 2e-4, "torque_std": 0.15, "parameter_std": PARAMETER_STD}
        self.estimators = {delay: Estimator(AcrobotEnv(**PARAMS), **noise) for delay in DELAYS}
        self.loss = dict.fromkeys(DELAYS, 0.0)
        self.predicted = {}
        self.delay, self.tick = 0, 0
        self.torques = [0.0] * (DELAYS[-1] + 1)  # of the last ticks
        self.take_model()
        self.plan, self.decision = plan_of_zeros(100), plan_of_zeros(1)

    def take_model(self):
        params = self.estimators[self.delay].params
        self.model = AcrobotEnv(**params)
        try:
            self.planner = Planner(0.9 * LIMIT, AcrobotEnv(**params | {"dt": DECISION * dt}))
        except (RuntimeError, ValueError):
            pass  # no regulator: the model before stays

    def improve_plan(self, state):
        end = plan_of_zeros(100 - len(self.plan.torques))
        parts = [(getattr(self.plan, x), getattr(end, x)) for x in ("states", "torques", "gains")]
        plan = Plan(*map(np.concatenate, parts), DECISION * dt, None)
        try:
            self.plan, _ = self.planner.improve(state, plan, 10)
        except (RuntimeError, ValueError):
            pass  # it overflows: the plan before stays

    def get_control_output_(self, x, t=None):
        states = {delay: each.correct(x[:2]) for delay, each in self.estimators.items()}
        for delay, angles in self.predicted.items():
            error = np.sum((angles - states[delay][:2]) ** 2)
            self.loss[delay] = 0.999 * self.loss[delay] + error
        likeliest = min(self.loss, key=self.loss.get)
        if self.loss[likeliest] < 0.5 * self.loss[self.delay]:
            self.delay = likeliest
        state = states[self.delay]
        if self.delay:
            state = simulate(state, self.torques[-self.delay :], self.model)[-1]

        if self.tick % MODEL == 0 < self.tick:
            self.take_model()
        if self.tick % PLANNING == 0:
            self.improve_plan(state)
        torque = self.torques[-1]
        if self.tick % DECISION == 0:
            if len(self.plan.torques):
                self.decision, self.plan = self.plan[:1], self.plan[1:]
            torque = np.clip(self.decision.torque(0, state), -LIMIT, LIMIT)
        self.tick += 1
        self.torques = [*self.torques[1:], float(torque)]

        if self.tick == CHOOSING:
            self.estimators = {self.delay: self.estimators[self.delay]}
            self.loss, self.predicted = {self.delay: 0.0}, {}
        for delay, estimator in self.estimators.items():
            torque = self.torques[-1 - delay]
            estimator.predict(torque)
            if self.tick < CHOOSING:
                self.predicted[delay] = simulate(states[delay], [torque], self.model)[-1][:2]
        return [0.0, self.torques[-1]]


controller = Acrobot()
controller.init()
