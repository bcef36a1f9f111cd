"""Energy, linear models, regulators and simulations of the acrobot, for control courses.

A state is the last axis, of length 4: theta1, theta2 (rad) and their velocities (rad/s). Arrays
broadcast in the axes before it.

``params`` is ``None`` for Gymnasium's parameters, a mapping of those that differ, such as
``{"dt": 0.01, "FRICTION_1": 0.1}``, or an environment.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import ArrayLike, NDArray

from acrobot_rs._native import compute
from acrobot_rs.arrays import must_be, numbers
from acrobot_rs.parameters import Parameters
from acrobot_rs.swingup import Swingup
from acrobot_rs.vector import AcrobotVectorEnv

Floats = NDArray[np.float64]
Pair = tuple[Floats, Floats]
Params = Mapping[str, Any] | gymnasium.Env[Any, Any] | VectorEnv[Any, Any, Any] | None

#: Standing upright at rest.
UPRIGHT = (math.pi, 0.0, 0.0, 0.0)


def energy(state: ArrayLike, params: Params = None) -> Floats:
    """The mechanical energy, J, which is 0 at rest at the height of the fixed joint."""
    return _call("energy", (), params, state=state)


def mass_matrix(state: ArrayLike, params: Params = None) -> Floats:
    """M, ``(..., 2, 2)``, kg m². The kinetic energy is q̇ᵀ M q̇ / 2."""
    return _call("mass_matrix", (2, 2), params, state=state)


def derivative(state: ArrayLike, torque: ArrayLike, params: Params = None) -> Floats:
    """The velocities and accelerations, ``(..., 4)``, under a torque, N m."""
    return _call("derivative", (4,), params, state=state, torque=torque)


def inverse_dynamics(state: ArrayLike, accelerations: ArrayLike, params: Params = None) -> Floats:
    """The torques of both joints, N m, for two accelerations, rad/s². The motor has the second."""
    return _call("inverse_dynamics", (2,), params, state=state, accelerations=accelerations)


def difference(state: ArrayLike, target: ArrayLike = UPRIGHT) -> Floats:
    """The state minus the target, with differences of angles from -pi to pi."""
    return _call("difference", (4,), None, state=state, target=target)


def linearize(state: ArrayLike, torque: ArrayLike = 0.0, params: Params = None) -> Pair:
    """A, ``(..., 4, 4)``, and B, ``(..., 4, 1)``, of ẋ = A x + B u."""
    rows = _call("linearize", (5, 4), params, state=state, torque=torque)
    return rows[..., :4, :], rows[..., 4, :, None]


def linearize_step(state: ArrayLike, torque: ArrayLike = 0.0, params: Params = None) -> Pair:
    """A and B of one step of ``dt``, after which x is A x + B u."""
    rows = _call("linearize_step", (5, 4), params, state=state, torque=torque)
    return rows[..., :4, :], rows[..., 4, :, None]


def lqr(A: ArrayLike, B: ArrayLike, Q: ArrayLike, R: ArrayLike) -> Pair:
    """The linear-quadratic regulator of a model of one step.

    Q weights the state and R, a number or ``(..., 1, 1)``, the torque. Returns K, ``(..., 1, 4)``,
    of u = -K x, and P, ``(..., 4, 4)``: xᵀ P x is the cost of all steps.
    """
    rows = _call("lqr", (5, 4), None, A=A, B=B, Q=Q, R=R)
    return rows[..., :1, :], rows[..., 1:, :]


def regulator(
    Q: ArrayLike,
    R: ArrayLike,
    state: ArrayLike = UPRIGHT,
    torque: ArrayLike = 0.0,
    params: Params = None,
) -> Pair:
    """K and P of :func:`lqr` for an acrobot in equilibrium under a torque, N m."""
    rows = _call("regulator", (5, 4), params, state=state, Q=Q, torque=torque, R=R)
    return rows[..., :1, :], rows[..., 1:, :]


def simulate(state: ArrayLike, torques: ArrayLike, params: Params = None) -> Floats:
    """The state and those after each of ``n`` torques, N m: ``(..., n + 1, 4)``.

    They are bit-identical to those of :class:`acrobot_rs.AcrobotContinuousEnv`, or of the
    environment that is passed as ``params``. Nothing clips the torques or ends the simulation.
    """
    env, arithmetic = getattr(params, "unwrapped", None), "host"
    if isinstance(env, AcrobotVectorEnv) and not env._gymnasium_episodes:
        arithmetic = "reference" if env._float64 else "fast"
    elif isinstance(env, Parameters) and env._TASK != "acrobot":
        arithmetic = "portable"
    count = math.prod(np.shape(torques)[-1:])
    return _call(arithmetic, (count + 1, 4), params, state=state, torques=torques)


class Animation:
    """An animated SVG of states, ``(n, 4)``, one each ``dt``, in real time. Notebooks show it."""

    def __init__(self, states: ArrayLike, params: Params = None) -> None:
        given = {**vars(Parameters), **_parameters(params)}
        dt, length, length2 = (given[name] for name in ("dt", "LINK_LENGTH_1", "LINK_LENGTH_2"))
        steps = max(1, round(0.04 / dt))  # of a frame; up to 25 frames a second
        angles = np.unwrap(_array("states", states, (4,)).reshape(-1, 4)[:, :2], axis=0)[::steps]
        still = max(1, round(2 / (steps * dt)))  # shows the last frame for 2 s
        angles = np.degrees(np.pad(angles, ((0, still), (0, 0)), mode="edge"))
        first, second = (
            '<animateTransform attributeName="transform" type="rotate" repeatCount="indefinite" '
            f'dur="{(len(angles) - 1) * steps * dt:.3f}s" '
            f'values="{";".join(f"{-angle:.1f}" for angle in column)}"/>'
            f'<path d="M-.1 0h.2v{each}h-.2z" fill="#0cc"/><circle r=".1" fill="#cc0"/>'
            for column, each in zip(angles.T, (length, length2))
        )
        reach = length + length2 + 0.2
        self.svg = (
            '<svg xmlns="http://www.w3.org/2000/svg" width="300" '
            f'viewBox="{-reach} {-reach} {2 * reach} {2 * reach}">'
            f'<g>{first}<g transform="translate(0 {length})"><g>{second}</g></g></g></svg>\n'
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        Path(path).write_text(self.svg)

    def _repr_html_(self) -> str:
        return self.svg


def _parameters(params: Params) -> dict[str, Any]:
    """The parameters that differ from Gymnasium's."""
    given = getattr(getattr(params, "unwrapped", None), "parameters", params or {})
    names = dict.fromkeys((*Parameters._NAMES, *Swingup._NAMES))
    if not isinstance(given, Mapping) or not given.keys() <= names.keys():
        rule = f"None, an environment of acrobot_rs or a mapping of {', '.join(names)}"
        raise must_be("params", rule, repr(params))
    return dict(given)


def _array(name: str, value: ArrayLike, axes: tuple[int, ...]) -> NDArray[Any]:
    """An input whose last axes are these. A vector may be for a column, and a number for R."""
    array = numbers(name, "numbers", value, None)
    if array.ndim < len(axes) and array.size == math.prod(axes):
        return array.reshape(axes)
    if array.shape[array.ndim - len(axes) :] != axes:
        shape = ", ".join(map(str, ("...", *axes)))
        raise must_be(name, f"an array of shape ({shape})", array.shape)
    return array


#: The last axes of inputs. Others have 4, and ``torques`` any number.
_AXES = {"torque": (), "accelerations": (2,), "A": (4, 4), "B": (4, 1), "Q": (4, 4), "R": (1, 1)}


def _call(function: str, shape: tuple[int, ...], params: Params, **inputs: ArrayLike) -> Floats:
    """Call a native function for each state. A result has this shape."""
    parts = []
    for name, value in inputs.items():
        axes = np.shape(value)[-1:] if name == "torques" else _AXES.get(name, (4,))
        array = _array(name, value, axes)
        parts.append(array.reshape(*array.shape[: array.ndim - len(axes)], math.prod(axes)))
    others = np.broadcast_shapes(*(part.shape[:-1] for part in parts))
    rows = np.concatenate([np.broadcast_to(x, (*others, x.shape[-1])) for x in parts], axis=-1)
    rows = np.ascontiguousarray(rows.reshape(math.prod(others), rows.shape[-1]), np.float64)
    return compute(function, _parameters(params), rows).reshape((*others, *shape))
