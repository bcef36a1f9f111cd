"""Integrates the published equations of motion by SciPy's DOP853: writes truth.txt to its folder.

The equations are those of docs/equations.md: here as two linear equations for the two
accelerations, which LAPACK solves, and with sines instead of the cosines of angles minus pi/2. The
work of the torques is integrated too.

A run at a quarter of the tolerance gives the uncertainty of each row, which the row contains. The
change of the energy, from the positions and velocities of the links, must equal the work.
"""

import math
import os
import platform
from itertools import product
from pathlib import Path

# OpenBLAS has other code, and so another rounding, for each processor. This chooses code with FMA,
# which glibc's sines use.
os.environ["OPENBLAS_CORETYPE"] = "Haswell"

import numpy as np
import scipy
from scipy.integrate import solve_ivp

TOLERANCE, FINER = 1e-13, 2.5e-14
HOLD = 0.2  # s, for which a torque is held
GRAVITY, LENGTH, CENTER, INERTIA = 9.8, 1.0, 0.5, 1.0  # of both links, whose masses are 1 kg
STARTS = {
    "rest": ([0.05, -0.03, 0.02, 0.01], [1, 10, 100]),
    "fast": ([1.2, -0.7, 3.0, 2.0], [1, 10]),
}
SWITCHING = np.random.default_rng(9).integers(-1, 2, 500).astype(float)
TORQUES = {"constant": np.ones(500), "switching": SWITCHING}
# Far above the difference that is found, far below the effect of a wrong sign.
BALANCE = 1e-8  # J


def derivative(_, y, torque, dynamics):
    theta1, theta2, dtheta1, dtheta2, _ = y
    sin2, arm = math.sin(theta2), LENGTH * CENTER
    d1 = CENTER**2 + LENGTH**2 + CENTER**2 + 2 * arm * math.cos(theta2) + INERTIA + INERTIA
    d2 = CENTER**2 + arm * math.cos(theta2) + INERTIA
    phi2 = CENTER * GRAVITY * math.sin(theta1 + theta2)
    phi1 = -arm * dtheta2**2 * sin2 - 2 * arm * dtheta2 * dtheta1 * sin2
    phi1 += (CENTER + LENGTH) * GRAVITY * math.sin(theta1) + phi2
    centrifugal = arm * dtheta1**2 * sin2
    if dynamics == "nips":
        # Without the term the pendulum moves as under a torque that cancels it.
        torque = torque + centrifugal
    mass = [[d1, d2], [d2, CENTER**2 + INERTIA]]
    rates = np.linalg.solve(mass, [-phi1, torque - centrifugal - phi2])
    return [dtheta1, dtheta2, *rates, torque * dtheta2]


def energy(theta1, theta2, dtheta1, dtheta2):
    """The energy of two rods, from the positions and velocities of their centres of mass."""
    along = lambda angle: np.array([np.cos(angle), np.sin(angle)])
    turning = dtheta1 + dtheta2
    first = CENTER * along(theta1) * dtheta1
    second = LENGTH * along(theta1) * dtheta1 + CENTER * along(theta1 + theta2) * turning
    kinetic = first @ first + second @ second + INERTIA * (dtheta1**2 + turning**2)
    heights = -CENTER * np.cos(theta1) - LENGTH * np.cos(theta1) - CENTER * np.cos(theta1 + theta2)
    return kinetic / 2 + GRAVITY * heights


def integrate(dynamics, start, torques, tolerance):
    """The states and the work after each torque."""
    rows = [np.array([*start, 0.0])]
    for torque in torques:
        options = {"rtol": tolerance, "atol": tolerance, "args": (torque, dynamics)}
        solution = solve_ivp(derivative, (0, HOLD), rows[-1], "DOP853", **options)
        assert solution.success
        rows.append(solution.y[:, -1])
    return np.array(rows)


def hexes(numbers):
    return " ".join(f"{int(word):016x}" for word in np.asarray(numbers, dtype="<f8").view("<u8"))


def main():
    lines, worst = [], 0.0
    for name, torques in TORQUES.items():
        lines.append(f"torques {name} {' '.join(f'{torque:.0f}' for torque in torques)}")
    for dynamics, start, plan in product(["book", "nips"], STARTS, TORQUES):
        y, times = STARTS[start]
        torques = TORQUES[plan][: round(times[-1] / HOLD)]
        found, finer = (integrate(dynamics, y, torques, each) for each in (TOLERANCE, FINER))
        balance = [energy(*row[:4]) - energy(*y) - row[4] for row in found]
        worst = np.maximum(worst, np.abs(balance).max())  # unlike `max` it keeps NaN
        lines.append(f"start {dynamics} {start} {plan} {hexes(y)}")
        for time in times:
            after = round(time / HOLD)
            uncertainty = np.abs(found - finer)[: after + 1, :4].max()
            wrapped = [math.remainder(angle, math.tau) for angle in found[after, :2]]
            lines.append(f"after {time} {hexes([*wrapped, *found[after, 2:4]])} {uncertainty:.1e}")
    assert worst <= BALANCE, worst
    versions = f"scipy {scipy.__version__}, numpy {np.__version__}"
    head = [
        f"# {versions}, {' '.join(platform.libc_ver())}, {platform.machine()}",
        f"# DOP853 at rtol = atol = {TOLERANCE}; energy and work differ by {worst:.0e} J or less.",
        "# torques NAME: N m, for 0.2 s each",
        "# start DYNAMICS START TORQUES, and the state (bits of f64)",
        "# after SECONDS, the state, and the largest difference until then from the run at "
        f"{FINER}",
    ]
    (Path(__file__).parent / "truth.txt").write_text("\n".join(head + lines) + "\n")


main()
