"""Energy, linear models, regulators, simulations, plans and estimates of the acrobot.

A state is the last axis: theta1, theta2 (rad) and their velocities (rad/s). Arrays broadcast in the
axes before it. ``env`` is a single environment of this package, whose parameters count, or ``None``
for Gymnasium's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import _native
from acrobot_rs.arrays import integer, must_be, numbers
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


def difference(state: ArrayLike, target: ArrayLike = UPRIGHT) -> Floats:
    """The state minus the target, with differences of angles from -pi to pi."""
    return _call("difference", (4,), None, state=state, target=target)


def linearize(state: ArrayLike, torque: ArrayLike = 0.0, env: Env = None) -> Pair:
    """A, ``(..., 4, 4)``, and B, ``(..., 4, 1)``, of ẋ = A x + B u."""
    rows = _call("linearize", (5, 4), env, state=state, torque=torque)
    return rows[..., :4, :], rows[..., 4, :, None]


def linearize_step(state: ArrayLike, torque: ArrayLike = 0.0, env: Env = None) -> Pair:
    """A and B of one step of ``dt``, after which x is A x + B u."""
    rows = _call("linearize_step", (5, 4), env, state=state, torque=torque)
    return rows[..., :4, :], rows[..., 4, :, None]


def lqr(A: ArrayLike, B: ArrayLike, Q: ArrayLike, R: ArrayLike) -> Pair:
    """The linear-quadratic regulator of a model of one step.

    Q weights the state and R, a number or ``(..., 1, 1)``, the torque. Returns K, ``(..., 1, 4)``,
    of u = -K x, and P, ``(..., 4, 4)``: xᵀ P x is the cost of all steps.
    """
    rows = _call("lqr", (5, 4), None, A=A, B=B, Q=Q, R=R)
    return rows[..., :1, :], rows[..., 1:, :]


def regulator(
    Q: ArrayLike, R: ArrayLike, state: ArrayLike = UPRIGHT, torque: ArrayLike = 0.0, env: Env = None
) -> Pair:
    """K and P of :func:`lqr` for an acrobot in equilibrium under a torque, N m."""
    rows = _call("regulator", (5, 4), env, state=state, Q=Q, torque=torque, R=R)
    return rows[..., :1, :], rows[..., 1:, :]


def simulate(state: ArrayLike, torques: ArrayLike, env: Env = None) -> Floats:
    """The state and those after each of ``n`` torques, N m: ``(..., n + 1, 4)``.

    They are bit-identical to those of the environment, but nothing clips the torques or ends the
    simulation.
    """
    states = 1 + math.prod(np.shape(torques)[-1:])
    return _call("simulate", (states, 4), env, state=state, torques=torques)


@dataclass(frozen=True)
class Plan:
    """Steps of ``dt``, s. ``plan[10:]`` is the plan after ten steps."""

    states: NDArray[np.float32]  #: before each step, (n, 4)
    torques: NDArray[np.float32]  #: (n,), N m
    gains: NDArray[np.float32]  #: (n, 4): what deviations from the states add to the torques
    dt: float

    def __getitem__(self, steps: slice) -> Plan:
        return Plan(self.states[steps], self.torques[steps], self.gains[steps], self.dt)


class Planner:
    """Plans swing-ups in ``float32``, for a motor of at most ``max_torque``, N m.

    ``angles`` to ``arrival`` are the weights of what a plan costs: see ``Cost`` in Rust. By default
    ``torque`` and ``below`` follow from the size of the machine, ``height`` is that of the upright
    tip, and ``margin`` a tenth of it. No velocity of a plan reaches a bound of the parameters. With
    ``clamps`` it may: environments clamp it there.
    """

    def __init__(
        self,
        max_torque: float,
        env: Env = None,
        *,
        angles: tuple[float, float] = (0.0, 0.0),
        velocities: tuple[float, float] = (0.0, 0.0),
        torque: float | None = None,
        torque_change: float = 0.0,
        power: float = 0.0,
        below: float | None = None,
        height: float | None = None,
        margin: float | None = None,
        arrival: float = 20.0,
        clamps: bool = False,
    ) -> None:
        acrobot = _acrobot(env)
        given, weights = [torque, below, height, margin], [torque_change, power, arrival]
        self._native = _native.Planner(
            acrobot._native, max_torque, clamps, given, [angles, velocities], weights
        )
        self._dt = acrobot.dt

    def plan(
        self,
        state: ArrayLike,
        *,
        steps: int,
        tries: int = 1000,
        seed: int = 0,
        progress: Callable[[int], object] | None = None,
    ) -> Plan:
        """A plan of at most ``steps``, up to 65,535, after which the regulator holds upright.

        A seed gives the same plan everywhere. After each 40 tries, which are one ``search`` of
        Rust's, ``progress`` is called with the number of all so far, and Ctrl-C acts. A
        ``RuntimeError`` says that no try found a plan.
        """
        steps = integer("steps", steps, 0, 2**16 - 1)
        tries, seed = integer("tries", tries, 0, 2**32 - 1), integer("seed", seed, 0, 2**64 - 1)
        return self._plan(self._native.plan(_four(state), steps, tries, seed, progress))

    def improve(self, state: ArrayLike, plan: Plan, iterations: int = 150) -> tuple[Plan, float]:
        """Improve a plan, from a state on. Return the new one, and what it costs."""
        rows = np.column_stack([plan.states, plan.torques, plan.gains]).tolist()
        iterations = integer("iterations", iterations, 0, 2**32 - 1)
        rows, cost = self._native.improve(_four(state), rows, iterations)
        return self._plan(rows), cost

    def follow(self, plan: Plan, step: int, state: ArrayLike) -> float:
        """The torque at a step, N m, not limited: the plan's, or after it the regulator's."""
        knot = None
        if step < len(plan.torques):
            knot = [*plan.states[step], plan.torques[step], *plan.gains[step]]
        return self._native.follow(knot, _four(state))

    def decide(self, state: ArrayLike) -> float:
        """The torque without a plan, N m: it pumps energy, and then holds."""
        return self._native.decide(_four(state))

    def _plan(self, rows: list[list[float]]) -> Plan:
        array = np.array(rows, np.float32).reshape(-1, 9)
        return Plan(array[:, :4], array[:, 4], array[:, 5:], self._dt)


def _four(state: ArrayLike) -> list[float]:
    return numbers("state", "four numbers", state, (4,)).tolist()


class Estimator:
    """Estimates the state of a machine from its angles alone: an extended Kalman filter.

    The model has the parameters of ``env``. ``angle_noise``, rad, and ``torque_noise``, N m, are
    standard deviations; an encoder of n counts a turn has 1.8 / n. Parameters that are named in
    ``deviations``, with their standard deviations, are estimated too: masses, the length and the
    moment of inertia of link 1, the latter of link 2, frictions and ``ROTOR``.

    In each ``dt`` call :meth:`measure`, decide, and call :meth:`step`.
    """

    def __init__(
        self,
        env: Env = None,
        *,
        angle_noise: float,
        torque_noise: float,
        deviations: Mapping[str, float] | None = None,
    ) -> None:
        named = dict(deviations or {})
        if unknown := named.keys() - _ESTIMATED:
            raise must_be("deviations", f"of {', '.join(sorted(_ESTIMATED))}", sorted(unknown))
        native = _acrobot(env)._native
        self._native = _native.Estimator(native, angle_noise, torque_noise, list(named.items()))

    def measure(self, angles: ArrayLike) -> Floats:
        """Correct the estimate by theta1 and theta2, rad. Return the state."""
        measured = numbers("angles", "two numbers", angles, (2,)).tolist()
        return np.array(self._native.measure(measured))

    def step(self, torque: float) -> None:
        """Predict the state after one ``dt`` under a torque, N m."""
        self._native.step(torque)

    @property
    def deviations(self) -> Floats | None:
        """The standard deviations of the state. ``None`` before a measurement."""
        found = self._native.deviations()
        return None if found is None else np.array(found)

    @property
    def params(self) -> dict[str, Any]:
        """The parameters, estimated and known, as arguments of an environment."""
        return dict(self._native.params())


@dataclass(frozen=True)
class Identified:
    """What :func:`identify` finds.

    ``values`` and their standard ``errors`` are ten numbers that a motion tells, by name:
    ``Identified::NAMES`` in Rust has them. ``undetermined`` combinations of them are not told, and
    ``weakest`` has the parts of the one that is told worst.
    """

    params: dict[str, Any]  #: arguments of an environment, each a number
    values: dict[str, float]
    errors: dict[str, float]
    weakest: dict[str, float]
    undetermined: int


def identify(angles: Sequence[ArrayLike], torques: Sequence[ArrayLike], env: Env) -> Identified:
    """Identify a machine from recordings in which both links move, for ten seconds or so.

    A recording has angles, ``(n, 2)``, rad, without jumps by whole turns, and the motor's torques,
    ``(n,)``, N m, or those of both joints, ``(n, 2)``, each until the next sample. ``env`` has
    ``dt``, gravity and the centres of mass; its lengths should be about right.
    """
    recordings = []
    for angle, torque in zip(angles, torques, strict=True):
        columns = np.asarray(torque, np.float64)
        if columns.ndim == 1:
            columns = np.column_stack([np.zeros_like(columns), columns])
        rule = f"an array of shape {columns.shape}, as the torques have"
        angle = numbers("angles", rule, angle, columns.shape)
        recordings.append(np.column_stack([angle, columns]).tolist())
    params, found, undetermined = _native.identify(_acrobot(env)._native, recordings)
    values, errors, weakest = ({name: row[i] for name, row in found} for i in range(3))
    return Identified(dict(params), values, errors, weakest, undetermined)


class Animation:
    """An animated SVG of states, ``(n, 4)``, one each ``dt``, in real time. Notebooks show it."""

    def __init__(self, states: ArrayLike, env: Env = None) -> None:
        acrobot = _acrobot(env)
        dt, lengths = acrobot.dt, (acrobot.LINK_LENGTH_1, acrobot.LINK_LENGTH_2)
        steps = max(1, round(0.04 / dt))  # of a frame; up to 25 frames a second
        angles = np.unwrap(np.reshape(states, (-1, 4))[:, :2], axis=0)[::steps]
        seconds = (len(angles) - 1) * steps * dt
        first, second = (
            '<animateTransform attributeName="transform" type="rotate" repeatCount="indefinite" '
            f'dur="{seconds:.3f}s" values="{";".join(f"{angle:.1f}" for angle in column)}"/>'
            f'<path d="M-.1 0h.2v{length}h-.2z" fill="#0cc"/><circle r=".1" fill="#cc0"/>'
            for column, length in zip(-np.degrees(angles.T), lengths)
        )
        reach = sum(lengths) + 0.2
        self.svg = (
            '<svg xmlns="http://www.w3.org/2000/svg" width="300" '
            f'viewBox="{-reach} {-reach} {2 * reach} {2 * reach}">'
            f'<g>{first}<g transform="translate(0 {lengths[0]})"><g>{second}</g></g></g></svg>\n'
        )

    def save(self, path: str | Path) -> None:
        Path(path).write_text(self.svg)

    def _repr_html_(self) -> str:
        return self.svg


_GYMNASIUM = AcrobotEnv()
_ESTIMATED = {"LINK_LENGTH_1", "ROTOR"} | {
    f"{name}_{link}" for name in ("LINK_MASS", "LINK_MOI", "DAMPING", "COULOMB") for link in (1, 2)
}
#: The last axes of inputs. Others have 4, and ``torques`` any number.
_AXES = {"torque": (), "accelerations": (2,), "A": (4, 4), "B": (4, 1), "Q": (4, 4), "R": (1, 1)}


def _acrobot(env: Env) -> Any:
    return _GYMNASIUM if env is None else env.unwrapped


def _call(function: str, shape: tuple[int, ...], env: Env, **inputs: ArrayLike) -> Floats:
    """Call a native function for each state. A result has this shape."""
    parts = []
    for name, value in inputs.items():
        array = numbers(name, "numbers", value, None)
        axes = array.shape[-1:] if name == "torques" else _AXES.get(name, (4,))
        if array.ndim < len(axes) and array.size == math.prod(axes):
            array = array.reshape(axes)  # a number or a vector for a matrix
        others = array.shape[: array.ndim - len(axes)]
        if array.shape != (*others, *axes):
            rule = f"an array of shape (..., {', '.join(map(str, axes))})"
            raise must_be(name, rule, array.shape)
        parts.append(array.reshape(*others, math.prod(axes)))
    others = np.broadcast_shapes(*(part.shape[:-1] for part in parts))
    rows = np.concatenate([np.broadcast_to(x, (*others, x.shape[-1])) for x in parts], axis=-1)
    rows = np.ascontiguousarray(rows.reshape(-1, rows.shape[-1]), np.float64)
    return _native.compute(function, _acrobot(env)._native, rows).reshape((*others, *shape))
