"""Energy, linear models, regulators and simulations: functions for many states at once."""

from __future__ import annotations

import itertools
import math
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import _native
from acrobot_rs.arrays import finite, must_be
from acrobot_rs.env import AcrobotEnv

Env = gymnasium.Env[Any, Any] | None
Floats = NDArray[np.float64]
Pair = tuple[Floats, Floats]

#: Standing upright at rest.
UPRIGHT = (math.pi, 0.0, 0.0, 0.0)


def energy(state: ArrayLike, env: Env = None) -> Floats:
    """The mechanical energy, J. Its potential part is 0 at the height of the fixed joint."""
    return _call("energy", (), env, state=state)


def mass_matrix(state: ArrayLike, env: Env = None) -> Floats:
    """M, ``(..., 2, 2)``, kg m². The kinetic energy is q̇ᵀ M q̇ / 2."""
    return _call("mass_matrix", (2, 2), env, state=state)


def derivative(state: ArrayLike, torque: ArrayLike, env: Env = None) -> Floats:
    """The velocities and accelerations, ``(..., 4)``, under a torque, N m."""
    return _call("derivative", (4,), env, state=state, torque=torque)


def inverse_dynamics(state: ArrayLike, accelerations: ArrayLike, env: Env = None) -> Floats:
    """The torques of both joints, N m, for two accelerations, rad/s². The motor has the second."""
    return _call("inverse_dynamics", (2,), env, state=state, accelerations=accelerations)


def deviation(state: ArrayLike, target: ArrayLike = UPRIGHT) -> Floats:
    """The state minus the target, with differences of angles from -pi to pi."""
    return _call("deviation", (4,), None, state=state, target=target)


def linearize(state: ArrayLike, torque: ArrayLike = 0.0, env: Env = None) -> Pair:
    """A, ``(..., 4, 4)``, and B, ``(..., 4, 1)``, of ẋ = A x + B u."""
    rows = _call("linearize", (5, 4), env, state=state, torque=torque)
    return rows[..., :4, :], rows[..., 4, :, None]


def linearize_step(state: ArrayLike, torque: ArrayLike = 0.0, env: Env = None) -> Pair:
    """A and B of one step of ``dt``, after which x is A x + B u."""
    rows = _call("linearize_step", (5, 4), env, state=state, torque=torque)
    return rows[..., :4, :], rows[..., 4, :, None]


def lqr(A: ArrayLike, B: ArrayLike, Q: ArrayLike, R: ArrayLike) -> Pair:
    """K and P as :func:`dlqr`, for a model ẋ = A x + B u: xᵀ P x is the integral of the cost."""
    rows = _call("lqr", (5, 4), None, A=A, B=B, Q=Q, R=R)
    return rows[..., :1, :], rows[..., 1:, :]


def dlqr(A: ArrayLike, B: ArrayLike, Q: ArrayLike, R: ArrayLike) -> Pair:
    """The linear-quadratic regulator of a model of one step.

    Q weights the state and R, a number or ``(..., 1, 1)``, the torque. Returns K, ``(..., 1, 4)``,
    of u = -K x, and P, ``(..., 4, 4)``: xᵀ P x is the cost of all steps.
    """
    rows = _call("dlqr", (5, 4), None, A=A, B=B, Q=Q, R=R)
    return rows[..., :1, :], rows[..., 1:, :]


def dlqe(A: ArrayLike, W: ArrayLike, S: ArrayLike) -> Pair:
    """The steady-state Kalman filter of a model of one step whose angles are measured.

    W is the covariance of the noise that a step adds to the state, and S, ``(..., 2)``, are the
    variances of both measurements, rad². Returns L, ``(..., 4, 2)``, by which a measurement
    corrects the state, and P, ``(..., 4, 4)``, the covariance of its errors before the correction.
    python-control's L is A L.
    """
    rows = _call("dlqe", (6, 4), None, A=A, W=W, S=S)
    return rows[..., :2, :].reshape(*rows.shape[:-2], 4, 2), rows[..., 2:, :]


def tvlqr(A: ArrayLike, B: ArrayLike, Q: ArrayLike, R: ArrayLike, Qf: ArrayLike) -> Pair:
    """The linear-quadratic regulator of ``n`` steps, each with its own model.

    A has the shape ``(..., n, 4, 4)`` and B ``(..., n, 4, 1)``. Qf weights the
    state after the last step. Returns K of each step, ``(..., n, 1, 4)``, and P before the first
    one, ``(..., 4, 4)``: xᵀ P x is the cost of all steps.
    """
    rows = _call("tvlqr", (4, 4), None, A=A, B=B, Q=Q, Qf=Qf, R=R)
    return rows[..., 4:, None, :], rows[..., :4, :]


def regulator(
    Q: ArrayLike, R: ArrayLike, state: ArrayLike = UPRIGHT, torque: ArrayLike = 0.0, env: Env = None
) -> Pair:
    """K and P of :func:`dlqr` for an acrobot in equilibrium under a torque, N m."""
    rows = _call("regulator", (5, 4), env, state=state, Q=Q, torque=torque, R=R)
    return rows[..., :1, :], rows[..., 1:, :]


def simulate(state: ArrayLike, torques: ArrayLike, env: Env = None) -> Floats:
    """The state and those after each of ``n`` torques, N m: ``(..., n + 1, 4)``.

    They are bit-identical to those of the environment, but nothing clips the torques or ends the
    simulation. A warning says that a velocity was clamped at ``MAX_VEL_1`` or ``MAX_VEL_2``.
    """
    return _call("simulate", (1, 4), env, state=state, torques=torques)


def with_rotor(inertia: float, gear: float, env: Env = None) -> dict[str, Any]:
    """The parameters with the rotor of a geared motor in the elbow: arguments of an environment.

    The rotor has the moment of inertia ``inertia`` about its axis, kg m². It stands on link 1 and
    turns by ``gear`` for each turn of link 2 against it, in the opposite direction; a negative
    ``gear`` is in the same direction.
    """
    rule = "a finite number of kg m²"
    rotor = [finite("inertia", rule, inertia), finite("gear", "a finite number", gear)]
    return _params_with(env, rotor, None)


def with_inertias_about_joints(inertias: ArrayLike, env: Env = None) -> dict[str, Any]:
    """The parameters with these moments of inertia, kg m²: arguments of an environment.

    Each is that of a link about its own joint, as papers and RealAIGym have it. One that is too
    small for the centre of mass of link 2 moves this centre and masses, without a change of the
    motion.
    """
    rule = "two finite numbers of kg m²"
    return _params_with(env, None, finite("inertias", rule, inertias, (2,)).tolist())


def _params_with(env: Env, *changes: list[float] | None) -> dict[str, Any]:
    acrobot = acrobot_of(env)
    changed = dict(_native.params_with(acrobot._native, *changes))
    return {name: x for name, x in acrobot.parameters.items() if name != "LINK_MOI"} | changed


_GYMNASIUM = AcrobotEnv()
#: The last axes of inputs, and what their numbers are.
_STATE = (4,), "finite numbers, rad and rad/s"
_MATRIX = (4, 4), "finite numbers"
_INPUTS = {
    **{"state": _STATE, "target": _STATE, "A": _MATRIX, "Q": _MATRIX, "Qf": _MATRIX},
    **{"W": _MATRIX, "S": ((2,), "finite numbers of rad²")},
    **{"B": ((4, 1), "finite numbers"), "R": ((1, 1), "finite numbers")},
    **{"torque": ((), "a finite number of N m"), "torques": ((), "finite numbers of N m")},
    "accelerations": ((2,), "finite numbers of rad/s²"),
}
#: The inputs that have a first axis of ``n`` steps.
_OF_STEPS = {"simulate": ("torques",), "tvlqr": ("A", "B")}


def acrobot_of(env: Env, name: str = "env") -> AcrobotEnv:
    acrobot = _GYMNASIUM if env is None else getattr(env, "unwrapped", env)
    if not isinstance(acrobot, AcrobotEnv):
        rule = "a single environment of acrobot_rs, such as acrobot_rs.AcrobotEnv()"
        raise must_be(name, rule, repr(env), TypeError)
    return acrobot


def _call(function: str, shape: tuple[int, ...], env: Env, **inputs: ArrayLike) -> Floats:
    """Call a native function for each state. A result has this shape, and a row for each step."""
    arrays = {name: finite(name, _INPUTS[name][1], x, None) for name, x in inputs.items()}
    names, steps, parts = _OF_STEPS.get(function, ()), 0, []
    for name in names[:1]:
        axes = _INPUTS[name][0]
        steps = math.prod(arrays[name].shape[: arrays[name].ndim - len(axes)][-1:])
        shape = (shape[0] + steps, *shape[1:])
    for name, array in arrays.items():
        axes = (steps,) * (name in names) + _INPUTS[name][0]
        if array.ndim < len(axes) and array.size == math.prod(axes):
            array = array.reshape(axes)  # a number or a vector for a matrix
        others = array.shape[: array.ndim - len(axes)]
        if array.shape != (*others, *axes):
            rule = f"an array of shape (..., {', '.join(map(str, axes))})"
            raise must_be(name, rule, array.shape)
        parts.append(array.reshape(*others, math.prod(axes)))
    acrobot = acrobot_of(env)._native
    if all(part.ndim == 1 for part in parts):  # one state: 6 µs, not 9
        return _native.compute(function, acrobot, np.concatenate(parts)[None]).reshape(shape)
    try:
        others = np.broadcast_shapes(*(part.shape[:-1] for part in parts))
    except ValueError:
        shapes = [array.shape for array in arrays.values()]
        raise must_be(", ".join(arrays), "arrays that broadcast", shapes) from None
    ends = [*itertools.accumulate(part.shape[-1] for part in parts)]
    rows = np.empty((math.prod(others), ends[-1]))
    for part, end in zip(parts, ends):
        rows.reshape(*others, ends[-1])[..., end - part.shape[-1] : end] = part
    return _native.compute(function, acrobot, rows).reshape((*others, *shape))
