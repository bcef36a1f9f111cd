"""Differentiates the equations of motion and solves Riccati equations, in 200 digits: writes
control.txt to its folder.

The equations are those of truth.py, also in a Runge-Kutta step. The torques are Lagrange's
equations from positions and energies alone, and the forces Newton's law from the second derivatives
of positions in time. SciPy's solve_discrete_are finds the same solutions of the Riccati equation,
with an error of up to 3e-6. The Riccati equation in continuous time is solved by eigenvectors.
SciPy's solve_continuous_are and python-control's dlqe find the same for most models.
"""

import os
import sys
from importlib.metadata import version
from pathlib import Path

# OpenBLAS and NumPy have other code, and so another rounding, for each processor. This chooses code
# with FMA.
os.environ["OPENBLAS_CORETYPE"] = "Haswell"
if "avx512f" in Path("/proc/cpuinfo").read_text():
    os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"

sys.path.pop(0)  # this file is not the package of its name

import control
import mpmath
import numpy as np
from scipy.linalg import LinAlgError, solve_continuous_are, solve_discrete_are

NAMES = "length1 length2 mass1 mass2 center_of_mass1 center_of_mass2 inertia1 inertia2"
NAMES += " gravity dt damping1 damping2 coulomb1 coulomb2 rotor"
LOW = [0.3, 0.3, 0.3, 0.3, 0.0, 0.0, 0.1, 0.1, -15.0, 0.002]
HIGH = [2.0, 2.0, 3.0, 3.0, 1.0, 1.0, 2.0, 2.0, 15.0, 0.2]
NONE = [0.0] * 5
PACKAGES = "mpmath", "numpy", "scipy"
DEFAULT = [1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 1.0, 1.0, 9.8, 0.2, *NONE]
STATES = np.array([3.2, 3.2, 6.0, 8.0])


def derivative(p, y, torque, dynamics):
    theta1, theta2, dtheta1, dtheta2 = y
    l1, _, m1, m2, lc1, lc2, i1, i2, g, *_, rotor = p
    sin2, arm = mpmath.sin(theta2), m2 * l1 * lc2
    d1 = m1 * lc1**2 + m2 * (l1**2 + lc2**2) + 2 * arm * mpmath.cos(theta2) + i1 + i2
    d2 = m2 * lc2**2 + arm * mpmath.cos(theta2) + i2
    phi2 = m2 * lc2 * g * mpmath.sin(theta1 + theta2)
    phi1 = -arm * dtheta2**2 * sin2 - 2 * arm * dtheta2 * dtheta1 * sin2
    phi1 += (m1 * lc1 + m2 * l1) * g * mpmath.sin(theta1) + phi2
    centrifugal = arm * dtheta1**2 * sin2 if dynamics == "book" else 0
    mass = mpmath.matrix([[d1 - 2 * rotor, d2 - rotor], [d2 - rotor, m2 * lc2**2 + i2]])
    forces = np.array([-phi1, torque - centrifugal - phi2]) - friction(p, y[2:])
    return np.array([dtheta1, dtheta2, *mpmath.lu_solve(mass, forces.tolist())])


def friction(p, dtheta):
    """Viscous friction, and Coulomb's. Both rates are at most 2.5 / dt with the elbow straight
    and folded."""
    l1, _, m1, m2, lc1, lc2, i1, i2, _, dt, *viscous, coulomb1, coulomb2, rotor = p
    upper, link2 = m1 * lc1**2 + i1 + m2 * l1**2, m2 * lc2**2 + i2
    width = mpmath.mpf(1) / 50
    for coupling in m2 * l1 * lc2 - rotor, -m2 * l1 * lc2 - rotor:
        determinant = upper * link2 - coupling**2
        inverse = np.array([link2, upper + link2 + 2 * coupling]) / determinant * dt
        rest = 2.5 - viscous @ inverse
        width = max(width, 1.5 * np.array([coulomb1, coulomb2]) @ inverse / rest)
    x = np.array([min(max(x / width, -1), 1) for x in dtheta])
    return viscous * dtheta + np.array([coulomb1, coulomb2]) * (1.5 * x - x**3 / 2)


def step(p, y, torque, dynamics):
    dt = p[9]
    k1 = derivative(p, y, torque, dynamics)
    k2 = derivative(p, y + dt / 2 * k1, torque, dynamics)
    k3 = derivative(p, y + dt / 2 * k2, torque, dynamics)
    k4 = derivative(p, y + dt * k3, torque, dynamics)
    return y + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def slope(f):
    """The derivative of f at 0. Three of them, nested, lose 120 of the 200 digits."""
    h = mpmath.mpf(10) ** -40
    return (f(h) - f(-h)) / (2 * h)


def gradient(f, size):
    """The derivatives of f at 0 by each element of its argument, the last axis."""
    return np.array([slope(lambda h: f(axis * h)) for axis in np.eye(size, dtype=int)]).T


def linear(f, p, y, torque, dynamics):
    """The derivatives of f by the state and by the torque."""
    by_all = gradient(lambda change: f(p, y + change[:4], torque + change[4], dynamics), 5)
    return by_all[:, :4], by_all[:, 4]


def point(theta, distance1, distance2):
    """The point at these distances along link 1 and along link 2."""
    along = lambda angle, length: length * np.array([mpmath.sin(angle), -mpmath.cos(angle)])
    return along(theta[0], distance1) + along(theta[0] + theta[1], distance2)


def lagrangian(p, theta, dtheta):
    l1, _, m1, m2, lc1, lc2, i1, i2, g, *_, rotor = p
    energy = i1 * dtheta[0] ** 2 / 2 + i2 * (dtheta[0] + dtheta[1]) ** 2 / 2
    energy -= rotor * dtheta[0] * (dtheta[0] + dtheta[1])
    for mass, distances in ((m1, (lc1, 0)), (m2, (l1, lc2))):
        velocity = slope(lambda t: point(theta + dtheta * t, *distances))
        energy += mass * (velocity @ velocity) / 2 - mass * g * point(theta, *distances)[1]
    return energy


def motion(p, y, accelerations, dynamics):
    """Torques, reaction, force in the elbow."""
    l1, l2, m1, m2, lc1, lc2, _, _, g, *_ = p
    theta, dtheta = y[:2], y[2:]
    path = lambda t: theta + dtheta * t + accelerations * t**2 / 2
    velocity = lambda t, *distances: slope(lambda h: point(path(t + h), *distances))
    acceleration = lambda *distances: slope(lambda t: velocity(t, *distances))
    weight = np.array([0, g])
    elbow = m2 * (acceleration(l1, lc2) + weight)
    reaction = elbow + m1 * (acceleration(lc1, 0) + weight)

    def momentum(t):
        then = dtheta + accelerations * t
        return gradient(lambda change: lagrangian(p, path(t), then + change), 2)

    force = gradient(lambda change: lagrangian(p, theta + change, dtheta), 2)
    torques = slope(momentum) - force + friction(p, dtheta)
    if dynamics == "nips":
        torques[1] -= m2 * l1 * lc2 * dtheta[0] ** 2 * mpmath.sin(theta[1])
    return torques, reaction, elbow


def regulator(a, b, q, r):
    """The solution of the Riccati equation: structured doubling, checked."""
    gain, cost = solution(a, b[:, None], q, np.array([[float(r)]]))
    return np.array(gain.tolist(), float)[0], np.array(cost.tolist(), float)


def solution(*model):
    a, b, q, r = (mpmath.matrix(m.tolist()) for m in model)
    power, reach, cost = a, b * r**-1 * b.T, q
    while mpmath.mnorm(power) > 1e-50:
        w = (mpmath.eye(4) + reach * cost) ** -1
        cost, reach = cost + power.T * cost * w * power, reach + power * w * reach * power.T
        power = power * w * power
    gain = (r + b.T * cost * b) ** -1 * b.T * cost * a
    closed = a - b * gain
    residual = closed.T * cost * closed + q + gain.T * r * gain - cost
    assert mpmath.mnorm(residual) < 1e-90 * mpmath.mnorm(cost)
    for _ in range(40):
        closed = closed * closed
    assert mpmath.mnorm(closed) < 1e-9
    return gain, cost


def continuous_regulator(a, b, q, r):
    """The gain and the cost in continuous time, by the eigenvectors of the Hamiltonian, checked."""
    a, b, q = (mpmath.matrix(m.tolist()) for m in (a, b[:, None], q))
    r = mpmath.mpf(float(r))
    hamiltonian = mpmath.zeros(8)
    hamiltonian[:4, :4], hamiltonian[:4, 4:] = a, -b * b.T / r
    hamiltonian[4:, :4], hamiltonian[4:, 4:] = -q, -a.T
    values, vectors = mpmath.eig(hamiltonian)
    stable = [i for i in range(8) if values[i].real < 0]
    assert len(stable) == 4
    upper, lower = (mpmath.matrix(4), mpmath.matrix(4))
    for column, i in enumerate(stable):
        upper[:, column], lower[:, column] = vectors[:4, i], vectors[4:, i]
    cost = (lower * upper**-1).apply(mpmath.re)
    gain = b.T * cost / r
    residual = a.T * cost + cost * a + q - r * gain.T * gain
    assert mpmath.mnorm(residual) < 1e-90 * mpmath.mnorm(cost)
    return np.array(gain.tolist(), float)[0], np.array(cost.tolist(), float)


def filter_gain(a, w, s):
    """The gain and the covariance before the measurement: the dual of the regulator."""
    measured = np.eye(4)[:, :2]
    _, p = solution(a.T, measured, w, np.diag(s))
    c = mpmath.matrix(measured.T.tolist())
    gain = p * c.T * (c * p * c.T + mpmath.diag(s.tolist())) ** -1
    return np.array(gain.tolist(), float), np.array(p.tolist(), float)


def texts(*arrays):
    return " ".join(repr(float(x)) for array in arrays for x in np.ravel(array))


def weights(rng):
    """Q and R, from one weight on the angles alone to a full matrix."""
    square = rng.normal(size=(4, 4))
    diagonals = np.eye(4), np.diag([10.0, 10.0, 1.0, 1.0]), np.diag([1.0, 1.0, 0.0, 0.0])
    for q in *diagonals, square @ square.T:
        yield (q + q.T) / 2, 10.0 ** rng.integers(-2, 3)


def decades(rng, low, high, size=None):
    return 10.0 ** rng.uniform(low, high, size)


def resting(dt, angle):
    p = np.array([*DEFAULT[:9], dt, *NONE])
    y = np.array([angle, 0.0, 0.0, 0.0])
    a, b = linear(step, p * mpmath.mpf(1), y, 0, "book")
    return a.astype(float), b.astype(float)


def models(rng):
    """Models with weights: the acrobot with any weights, then anything over many decades."""
    for dt in 0.002, 0.01, 0.05:
        for angle in 0.0, np.pi:
            a, b = resting(dt, angle)
            for diagonal in [1.0] * 4, (1000.0, 1000.0, 10.0, 10.0), (1.0, 1.0, 0.0, 0.0):
                for r in 1e-8, 1e-4, 1.0, 1e6, 1e8:
                    yield "acrobot", a, b, np.diag(diagonal), r
    for number in range(150):
        spread = number % 4
        units = decades(rng, -spread, spread, 4)
        a = rng.normal(size=(4, 4)) * decades(rng, -1, 1)
        if rng.random() < 0.5:
            a = np.eye(4) + a * decades(rng, -3, 0)
        a = a * units[:, None] / units
        b = rng.normal(size=4) * decades(rng, -spread, spread, 4)
        root = np.float32(rng.normal(size=(4, 4)) * decades(rng, -spread, spread, 4))
        q = root.T @ root if rng.random() < 0.5 else np.diag(decades(rng, -6, 6, 4))
        yield "any", a, b, (q + q.T) / 2, decades(rng, -12, 8)


def wide_models(rng):
    """Models whose numbers span up to 24 decades, half of them zeros in many."""
    for number in range(100):
        spread = 2 + number % 11
        anything = lambda size: decades(rng, -spread / 2, spread / 2, size)
        sparse = lambda size, kept: (rng.random(size) < kept) * anything(size)
        a = rng.normal(size=(4, 4)) * sparse((4, 4), 0.7)
        a *= decades(rng, -1, 0.5) / max(1.0, np.abs(np.linalg.eigvals(a)).max())
        b = rng.normal(size=4) * sparse(4, 0.8) ** 2
        yield "wide", a, b, np.diag(decades(rng, -spread, spread, 4)), decades(rng, -spread, spread)


def rates(rng):
    """Models in continuous time with weights."""
    for angle in 0.0, np.pi:
        p = np.array([*DEFAULT[:9], 0.2, *NONE]) * mpmath.mpf(1)
        a, b = linear(derivative, p, np.array([angle, 0.0, 0.0, 0.0]), 0, "book")
        for diagonal in [1.0] * 4, (1000.0, 1000.0, 10.0, 10.0), (1.0, 1.0, 0.0, 0.0):
            for r in 1e-8, 1e-4, 1.0, 1e6, 1e8:
                yield "acrobot", a.astype(float), b.astype(float), np.diag(diagonal), r
    for number in range(170):
        spread = number % 4
        units = decades(rng, -spread, spread, 4)
        rate = decades(rng, -6, 6)
        a = rng.normal(size=(4, 4)) * units[:, None] / units * rate
        b = rng.normal(size=4) * decades(rng, -spread, spread, 4) * rate
        root = np.float32(rng.normal(size=(4, 4)) * decades(rng, -spread, spread, 4))
        q = root.T @ root if rng.random() < 0.5 else np.diag(decades(rng, -6, 6, 4))
        yield "any", a, b, (q + q.T) / 2, decades(rng, -12, 8)


def noisy(rng):
    """Models of steps with the covariance of the noise and the variances of both angles."""
    for dt in 0.002, 0.01, 0.05:
        for angle in 0.0, np.pi:
            a, _ = resting(dt, angle)
            for noise in 1e-9, 1e-5, 1e-1:
                for variances in (1e-8, 1e-8), (1e-4, 1e-10):
                    yield "acrobot", a, np.diag([0.0, 0.0, noise, 2 * noise]), np.array(variances)
    for number in range(164):
        spread = number % 4
        units = decades(rng, -spread, spread, 4)
        a = rng.normal(size=(4, 4)) * decades(rng, -1, 1)
        if rng.random() < 0.5:
            a = np.eye(4) + a * decades(rng, -3, 0)
        a = a * units[:, None] / units
        root = np.float32(rng.normal(size=(4, 4)) * decades(rng, -spread, spread, 4))
        w = root.T @ root if rng.random() < 0.5 else np.diag(decades(rng, -6, 6, 4))
        yield "any", a, (w + w.T) / 2, decades(rng, -10, 4, 2)


def distance(found, expected):
    return np.abs(found - expected).max() / np.abs(expected).max()


def usual(rng):
    """A state, a torque and accelerations."""
    return rng.uniform(-STATES, STATES), rng.uniform(-5, 5), rng.uniform(-20, 20, 2)


def case(number, *given):
    dynamics = ["book", "nips"][number % 2]
    yield f"case {dynamics} {texts(*given)}"
    p, y, torque, accelerations = (x * mpmath.mpf(1) for x in given)
    yield f"continuous {texts(*linear(derivative, p, y, torque, dynamics))}"
    yield f"discrete {texts(*linear(step, p, y, torque, dynamics))}"
    yield f"motion {texts(*motion(p, y, accelerations, dynamics))}"


def main():
    mpmath.mp.dps = 200
    rng = np.random.default_rng(5)
    lines = []
    for number in range(40):
        p = np.array(DEFAULT) if number < 8 else np.array([*rng.uniform(LOW, HIGH), *NONE])
        lines += case(number, p, *usual(rng))
    for dt in 0.001, 0.01, 0.05, 0.2:
        for angle in 0.0, np.pi:
            a, b = resting(dt, angle)
            for q, r in weights(rng):
                approximate = solve_discrete_are(a, b[:, None], q, np.array([[r]]))
                gain, cost = regulator(a, b, q, r)
                assert np.abs(approximate - cost).max() <= 3e-6 * np.abs(cost).max()
                lines.append(f"lqr {texts(angle, dt, a, b, q, r, gain, cost)}")
    for number in range(40):
        p = [*decades(rng, -3, 3, 8), rng.normal() * decades(rng, -3, 3), decades(rng, -5, -2)]
        p = np.array([*p, *NONE])
        y = rng.uniform(-STATES, STATES)
        torque = rng.normal() * decades(rng, -3, 3)
        given = p, y, torque, rng.normal(size=2) * decades(rng, -3, 3, 2)
        lines += case(number, *(np.float32(x).astype(float) for x in given))
    for kind, *model in [*models(rng), *wide_models(np.random.default_rng(6))]:
        given = [np.float32(x) for x in model]
        gain, _ = regulator(*(x.astype(float) for x in given))
        numbers = " ".join(str(x) for array in given for x in np.ravel(array))
        lines.append(f"model {kind} {numbers} {texts(gain)}")
    for number in range(40):
        p = np.array([*rng.uniform(LOW, HIGH), *decades(rng, -3, 0, 4), 0.0])
        p[-1] = rng.uniform(-1, 1) * np.sqrt(p[6] * p[7])
        y, *others = usual(rng)
        y[2:] *= 0.01 if number % 4 > 1 else 1  # where Coulomb friction is smooth
        lines += case(number, p, y, *others)
    head = [
        "# " + ", ".join(f"{name} {version(name)}" for name in PACKAGES),
        f"# case DYNAMICS {NAMES}, the state, the torque, two accelerations",
        "# continuous, discrete: A by rows, B",
        "# motion: torques, reaction, force in the elbow",
        "# lqr THETA1 DT: A, B, Q by rows, R, the gain, the cost by rows",
        "# the second 40 cases: parameters over six decades; the last 40: with friction",
        "# model KIND: A, B, Q by rows and R, all f32, and the gain",
    ]
    errors = []
    lines.append("# care KIND: A, B, Q by rows and R of continuous time, all f32, and the gain")
    for kind, *model in rates(np.random.default_rng(7)):
        given = [np.float32(x) for x in model]
        a, b, q, r = (x.astype(float) for x in given)
        gain, cost = continuous_regulator(a, b, q, r)
        try:
            errors.append(distance(solve_continuous_are(a, b[:, None], q, r[None, None]), cost))
        except LinAlgError:
            errors.append(1.0)
        numbers = " ".join(str(x) for array in given for x in np.ravel(array))
        lines.append(f"care {kind} {numbers} {texts(gain)}")
    assert np.quantile(errors, 0.8) < 1e-6
    errors = []
    lines.append(
        "# dlqe KIND: A, W by rows and the variances of both angles, all f32, the gain, and the"
        " covariance before the measurement, by rows"
    )
    for kind, *model in noisy(np.random.default_rng(8)):
        given = [np.float32(x) for x in model]
        a, w, s = (x.astype(float) for x in given)
        gain, covariance = filter_gain(a, w, s)
        found, *_ = control.dlqe(a, np.eye(4), np.eye(4)[:2], w, np.diag(s), method="scipy")
        errors.append(distance(found, a @ gain))  # python-control's gain also predicts the step
        numbers = " ".join(str(x) for array in given for x in np.ravel(array))
        lines.append(f"dlqe {kind} {numbers} {texts(gain, covariance)}")
    assert max(errors) < 1e-6
    (Path(__file__).parent / "control.txt").write_text("\n".join(head + lines) + "\n")


main()
