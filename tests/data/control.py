"""Differentiates the equations of motion automatically and solves Riccati equations: writes control.txt to its folder.

    pip install -r tests/data/requirements.txt
    python tests/data/control.py

The equations are those that truth.py integrates, for any parameters, and autograd differentiates them and a Runge-Kutta
step of them. The torques are Lagrange's equations from positions and energies alone, and the forces Newton's law from the
second derivatives of positions in time.

The gains are those of SciPy's solve_discrete_are after Newton's method in 50 digits (G. A. Hewer, 1971), because SciPy's own
error is up to 3e-6.
"""

import os
from importlib.metadata import version
from pathlib import Path

# OpenBLAS and NumPy have other code, and so another rounding, for each processor. This chooses code with FMA.
os.environ["OPENBLAS_CORETYPE"] = "Haswell"
if "avx512f" in Path("/proc/cpuinfo").read_text():
    os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"

import autograd.numpy as np
import mpmath
from autograd import grad, jacobian
from scipy.linalg import solve_discrete_are

NAMES = "length1 length2 mass1 mass2 center_of_mass1 center_of_mass2 inertia1 inertia2 gravity dt".split()
LOW = [0.3, 0.3, 0.3, 0.3, 0.0, 0.0, 0.1, 0.1, -15.0, 0.002]
HIGH = [2.0, 2.0, 3.0, 3.0, 1.0, 1.0, 2.0, 2.0, 15.0, 0.2]
DEFAULT = [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 1.0, 1.0, 9.8, 0.2]
STATES = np.array([3.2, 3.2, 6.0, 8.0])


def derivative(p, y, torque, dynamics):
    theta1, theta2, dtheta1, dtheta2 = y
    l1, _, m1, m2, lc1, lc2, i1, i2, g, _ = p
    sin2, arm = np.sin(theta2), m2 * l1 * lc2
    d1 = m1 * lc1**2 + m2 * (l1**2 + lc2**2) + 2 * arm * np.cos(theta2) + i1 + i2
    d2 = m2 * lc2**2 + arm * np.cos(theta2) + i2
    phi2 = m2 * lc2 * g * np.sin(theta1 + theta2)
    phi1 = -arm * dtheta2**2 * sin2 - 2 * arm * dtheta2 * dtheta1 * sin2 + (m1 * lc1 + m2 * l1) * g * np.sin(theta1) + phi2
    centrifugal = arm * dtheta1**2 * sin2 if dynamics == "book" else 0.0
    mass = np.array([[d1, d2], [d2, m2 * lc2**2 + i2]])
    rates = np.linalg.solve(mass, np.array([-phi1, torque - centrifugal - phi2]))
    return np.array([dtheta1, dtheta2, rates[0], rates[1]])


def step(p, y, torque, dynamics):
    dt = p[-1]
    k1 = derivative(p, y, torque, dynamics)
    k2 = derivative(p, y + dt / 2 * k1, torque, dynamics)
    k3 = derivative(p, y + dt / 2 * k2, torque, dynamics)
    k4 = derivative(p, y + dt * k3, torque, dynamics)
    return y + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def linear(f, p, y, torque, dynamics):
    """The derivatives of f by the state and by the torque."""
    by = [jacobian(f, argument)(p, y, torque, dynamics) for argument in (1, 2)]
    return by[0], by[1].reshape(4)


def point(theta, distance1, distance2):
    """The point at these distances along link 1 and along link 2."""
    along = lambda angle, distance: np.array([distance * np.sin(angle), -distance * np.cos(angle)])
    return along(theta[0], distance1) + along(theta[0] + theta[1], distance2)


def lagrangian(p, theta, dtheta):
    l1, _, m1, m2, lc1, lc2, i1, i2, g, _ = p
    energy = i1 * dtheta[0] ** 2 / 2 + i2 * (dtheta[0] + dtheta[1]) ** 2 / 2
    for mass, distances in ((m1, (lc1, 0.0)), (m2, (l1, lc2))):
        velocity = jacobian(point)(theta, *distances) @ dtheta
        energy = energy + mass * (velocity @ velocity) / 2 - mass * g * point(theta, *distances)[1]
    return energy


def motion(p, y, accelerations, dynamics):
    """Torques, reaction, force in the elbow, velocities of elbow and tip."""
    l1, l2, m1, m2, lc1, lc2, _, _, g, _ = p
    theta, dtheta = y[:2], y[2:]
    path = lambda t: theta + dtheta * t + accelerations * t**2 / 2
    velocity = lambda *distances: jacobian(lambda t: point(path(t), *distances))
    acceleration = lambda *distances: jacobian(velocity(*distances))(0.0)
    weight = np.array([0.0, g])
    elbow = m2 * (acceleration(l1, lc2) + weight)
    reaction = elbow + m1 * (acceleration(lc1, 0.0) + weight)

    momentum = lambda t: grad(lagrangian, 2)(p, path(t), dtheta + accelerations * t)
    torques = jacobian(momentum)(0.0) - grad(lagrangian, 1)(p, theta, dtheta)
    if dynamics == "nips":
        torques[1] -= m2 * l1 * lc2 * dtheta[0] ** 2 * np.sin(theta[1])
    return torques, reaction, elbow, velocity(l1, 0.0)(0.0), velocity(l1, l2)(0.0)


def newton(a, b, q, r, cost):
    """The gain and the cost to go that solve the Riccati equation, from an approximate cost."""
    a, b, q, cost = (mpmath.matrix(m.tolist()) for m in (a, b[:, None], q, cost))
    r = mpmath.mpf(float(r))
    for _ in range(5):
        gain = (b.T * cost * a) / (r + (b.T * cost * b)[0])
        closed, stage = a - b * gain, q + r * gain.T * gain
        # The cost of this gain: cost = closedᵀ cost closed + stage, element by element.
        pairs = [(i, j) for i in range(4) for j in range(4)]
        system = mpmath.matrix([[(k == n) - closed[i, m] * closed[j, o] for n, (i, j) in enumerate(pairs)]
                                for k, (m, o) in enumerate(pairs)])
        flat = mpmath.lu_solve(system, mpmath.matrix([stage[m, o] for m, o in pairs]))
        cost = mpmath.matrix(4, 4)
        for value, pair in zip(flat, pairs):
            cost[pair] = value
    return np.array(gain.tolist(), float)[0], np.array(cost.tolist(), float)


def texts(*arrays):
    return " ".join(repr(float(x)) for array in arrays for x in np.ravel(array))


def weights(rng):
    """Q and R, from one weight on the angles alone to a full matrix."""
    square = rng.normal(size=(4, 4))
    for q in np.eye(4), np.diag([10.0, 10.0, 1.0, 1.0]), np.diag([1.0, 1.0, 0.0, 0.0]), square @ square.T:
        yield (q + q.T) / 2, 10.0 ** rng.integers(-2, 3)


def main():
    mpmath.mp.dps = 50
    rng = np.random.default_rng(5)
    lines = []
    for number in range(40):
        dynamics = ["book", "nips"][number % 2]
        p = np.array(DEFAULT) if number < 8 else rng.uniform(LOW, HIGH)
        y, torque, accelerations = rng.uniform(-STATES, STATES), rng.uniform(-5, 5), rng.uniform(-20, 20, 2)
        lines.append(f"case {dynamics} {texts(p, y, torque, accelerations)}")
        lines.append(f"continuous {texts(*linear(derivative, p, y, torque, dynamics))}")
        lines.append(f"discrete {texts(*linear(step, p, y, torque, dynamics))}")
        lines.append(f"motion {texts(*motion(p, y, accelerations, dynamics))}")
    for dt in 0.001, 0.01, 0.05, 0.2:
        for angle in 0.0, np.pi:
            p = np.array([*DEFAULT[:-1], dt])
            a, b = linear(step, p, np.array([angle, 0.0, 0.0, 0.0]), 0.0, "book")
            for q, r in weights(rng):
                approximate = solve_discrete_are(a, b[:, None], q, np.array([[r]]))
                gain, cost = newton(a, b, q, r, approximate)
                assert np.abs(approximate - cost).max() <= 3e-6 * np.abs(cost).max()
                lines.append(f"lqr {texts(angle, dt, a, b, q, r, gain, cost)}")
    head = [
        f"# {', '.join(f'{name} {version(name)}' for name in ('autograd', 'mpmath', 'numpy', 'scipy'))}",
        f"# case DYNAMICS {' '.join(NAMES)}, the state, the torque, two accelerations",
        "# continuous, discrete: A by rows, B",
        "# motion: torques, reaction, force in the elbow, velocities of elbow and tip",
        "# lqr THETA1 DT: A, B, Q by rows, R, the gain, the cost by rows",
    ]
    (Path(__file__).parent / "control.txt").write_text("\n".join(head + lines) + "\n")


if __name__ == "__main__":
    main()
