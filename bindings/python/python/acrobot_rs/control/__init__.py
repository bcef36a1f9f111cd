"""Energy, linear models, regulators, simulations, plans and estimates of the acrobot.

A state is the last axis: theta1, theta2 (rad) and their velocities (rad/s). Arrays broadcast in the
axes before it. ``env`` is a single environment of this package, whose parameters count, or ``None``
for Gymnasium's.
"""

from acrobot_rs.control.animation import Animation
from acrobot_rs.control.estimate import Calibration, Estimator, Fit, calibrate, identify
from acrobot_rs.control.model import (
    UPRIGHT,
    derivative,
    deviation,
    dlqe,
    dlqr,
    energy,
    inverse_dynamics,
    linearize,
    linearize_step,
    lqr,
    mass_matrix,
    regulator,
    simulate,
    tvlqr,
    with_inertias_about_joints,
    with_rotor,
)
from acrobot_rs.control.mpc import Controller, Replanner, Report
from acrobot_rs.control.plan import Feedback, Plan, Planner, Region, SwingUp
from acrobot_rs.control.save import save

__all__ = [
    "UPRIGHT",
    "Animation",
    "Calibration",
    "Controller",
    "Estimator",
    "Feedback",
    "Fit",
    "Plan",
    "Planner",
    "Region",
    "Replanner",
    "Report",
    "SwingUp",
    "calibrate",
    "derivative",
    "deviation",
    "dlqe",
    "dlqr",
    "energy",
    "identify",
    "inverse_dynamics",
    "linearize",
    "linearize_step",
    "lqr",
    "mass_matrix",
    "regulator",
    "save",
    "simulate",
    "tvlqr",
    "with_inertias_about_joints",
    "with_rotor",
]
