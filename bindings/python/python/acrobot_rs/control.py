"""Energy, linear models, regulators, simulations, plans and estimates of the acrobot.

A state is the last axis: theta1, theta2 (rad) and their velocities (rad/s). Arrays broadcast in the
axes before it. ``env`` is a single environment of this package, whose parameters count, or ``None``
for Gymnasium's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

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


def dlqr(A: ArrayLike, B: ArrayLike, Q: ArrayLike, R: ArrayLike) -> Pair:
    """The linear-quadratic regulator of a model of one step.

    Q weights the state and R, a number or ``(..., 1, 1)``, the torque. Returns K, ``(..., 1, 4)``,
    of u = -K x, and P, ``(..., 4, 4)``: xᵀ P x is the cost of all steps.
    """
    rows = _call("dlqr", (5, 4), None, A=A, B=B, Q=Q, R=R)
    return rows[..., :1, :], rows[..., 1:, :]


def regulator(
    Q: ArrayLike, R: ArrayLike, state: ArrayLike = UPRIGHT, torque: ArrayLike = 0.0, env: Env = None
) -> Pair:
    """K and P of :func:`dlqr` for an acrobot in equilibrium under a torque, N m."""
    rows = _call("regulator", (5, 4), env, state=state, Q=Q, torque=torque, R=R)
    return rows[..., :1, :], rows[..., 1:, :]


def simulate(state: ArrayLike, torques: ArrayLike, env: Env = None) -> Floats:
    """The state and those after each of ``n`` torques, N m: ``(..., n + 1, 4)``.

    They are bit-identical to those of the environment, but nothing clips the torques or ends the
    simulation.
    """
    states = 1 + math.prod(np.shape(torques)[-1:])
    return _call("simulate", (states, 4), env, state=state, torques=torques)


class Region(NamedTuple):
    """A gain, and the region in which its torque lasts."""

    gain: list[float]  #: K in u = -K x, N m per rad and per rad/s
    factor: list[list[float]]  #: F: a deviation x is in the region if the norm of F x is below 1


class Feedback(NamedTuple):
    """What holds an equilibrium after a plan. With dry friction there are two gains."""

    target: list[float]
    torque: float  #: that holds the target, N m
    moving: Region
    resting: Region  #: used where the squared norm of its F x is below ``reach``
    reach: float


@dataclass(frozen=True)
class Plan:
    """Steps of ``dt``, s, and the feedback after them. ``plan[10:]`` is the plan after ten steps.

    It is plain data, so it can be pickled and needs no planner.
    """

    states: NDArray[np.float32]  #: before each step, (n, 4)
    torques: NDArray[np.float32]  #: (n,), N m
    gains: NDArray[np.float32]  #: (n, 4): K in u = torque - K x for the deviation x from the state
    dt: float
    after: Feedback

    def __getitem__(self, steps: slice) -> Plan:
        states, torques, gains = self.states[steps], self.torques[steps], self.gains[steps]
        return replace(self, states=states, torques=torques, gains=gains)

    def torque(self, step: int, state: ArrayLike) -> float:
        """The torque at a step, counted from 0, or after the plan, N m. It is not limited."""
        knot = None
        if integer("step", step, 0, 2**63 - 1) < len(self.torques):
            knot = [*self.states[step], self.torques[step], *self.gains[step]]
        return _native.plan_torque(knot, self.after, _four(state))

    def _rows(self) -> list[list[float]]:
        return np.column_stack([self.states, self.torques, self.gains]).tolist()


class Planner:
    """Plans motions to an equilibrium in ``float32``, for a motor of at most ``max_torque``, N m.

    The acrobot ends upright, or balances with a bent elbow: ``elbow`` is its theta2, rad. ``q`` to
    ``arrival`` are the weights of what a plan costs: see ``Cost`` in Rust, which has the defaults.
    ``q`` and ``qf`` have the shape ``(4, 4)``, or are the four numbers of a diagonal. No velocity
    of a plan reaches a bound of the parameters. With ``velocity_clamp`` it may: environments clamp
    it there.
    """

    def __init__(
        self,
        max_torque: float,
        env: Env = None,
        *,
        elbow: float = 0.0,
        q: ArrayLike | None = None,
        qf: ArrayLike | None = None,
        angles: tuple[float, float] | None = None,
        torque: float | None = None,
        torque_change: float | None = None,
        power: float | None = None,
        below: float | None = None,
        height: float | None = None,
        margin: float | None = None,
        arrival: float | None = None,
        velocity_clamp: bool = False,
    ) -> None:
        weights = {
            **{"q": _weights("q", q), "qf": _weights("qf", qf), "angles": angles},
            **{"torque": torque, "torque_change": torque_change, "power": power},
            **{"below": below, "height": height, "margin": margin, "arrival": arrival},
        }
        acrobot = _acrobot(env)
        native = acrobot._native
        self._native = _native.Planner(native, max_torque, elbow, velocity_clamp, weights)
        target, held, moving, resting, reach = self._native.after()
        self._after = Feedback(target, held, Region(*moving), Region(*resting), reach)
        self._dt = acrobot.dt

    def holds_from(self, state: ArrayLike) -> bool:
        """Whether the feedback after a plan takes the machine from a state to the target."""
        return self._native.holds_from(_four(state))

    def plan(
        self,
        state: ArrayLike,
        *,
        steps: int,
        tries: int = 1000,
        seed: int = 0,
        progress: Callable[[int], object] | None = None,
    ) -> Plan:
        """A plan of at most ``steps``, up to 65,535, after which its feedback holds the target.

        A seed gives the same plan everywhere, also in Rust. After each 40 tries ``progress`` is
        called with the number of all so far, and Ctrl-C acts. A ``RuntimeError`` says that no try
        found a plan.
        """
        steps = integer("steps", steps, 0, 2**16 - 1)
        tries, seed = integer("tries", tries, 0, 2**32 - 1), integer("seed", seed, 0, 2**64 - 1)
        return self._plan(self._native.plan(_four(state), steps, tries, seed, progress))

    def improve(self, state: ArrayLike, plan: Plan, iterations: int = 150) -> tuple[Plan, float]:
        """Improve a plan, from a state on. Return the new one, and what it costs."""
        iterations = integer("iterations", iterations, 0, 2**32 - 1)
        rows, cost = self._native.improve(_four(state), plan._rows(), iterations)
        return self._plan(rows), cost

    def improve_each(
        self, states: ArrayLike, plans: Sequence[Plan], iterations: int = 150
    ) -> tuple[list[Plan], NDArray[np.float32]]:
        """Improve many plans, each from its state. A cost is infinite where numbers overflow."""
        shape = len(plans), 4
        given = numbers("states", f"numbers of shape {shape}", states, shape).tolist()
        iterations = integer("iterations", iterations, 0, 2**32 - 1)
        rows = [plan._rows() for plan in plans]
        rows, costs = self._native.improve_each(given, rows, iterations)
        return [self._plan(each) for each in rows], np.array(costs, np.float32)

    def _plan(self, rows: list[list[float]]) -> Plan:
        array = np.array(rows, np.float32).reshape(-1, 9)
        return Plan(array[:, :4], array[:, 4], array[:, 5:], self._dt, self._after)


def _weights(name: str, value: ArrayLike | None) -> list[list[float]] | None:
    """A matrix, or that with a diagonal."""
    if value is None:
        return None
    rule = "numbers of shape (4, 4) or (4,)"
    array = numbers(name, rule, value, None)
    if array.shape not in ((4, 4), (4,)):
        raise must_be(name, rule, array.shape)
    return (np.diag(array) if array.ndim == 1 else array).tolist()


def _four(state: ArrayLike) -> list[float]:
    return numbers("state", "four numbers", state, (4,)).tolist()


class SwingUp:
    """Swings up without a plan, in ``float32``: pumps energy, and holds once it can."""

    def __init__(self, max_torque: float, env: Env = None) -> None:
        self._native = _native.SwingUp(_acrobot(env)._native, max_torque)

    def torque(self, state: ArrayLike) -> float:
        """The torque, N m, at most the largest. Call it at each ``dt``."""
        return self._native.torque(_four(state))


class Estimator:
    """Estimates the state of a machine from its angles alone: an extended Kalman filter.

    The model has the parameters of ``env``. ``angle_std``, rad, and ``torque_std``, N m, are the
    standard deviations of the noise; an encoder of n counts a turn has 1.8 / n. Parameters that
    are named in ``parameter_std``, with their standard deviations, are estimated too: masses,
    moments of inertia, the length of link 1, frictions and ``ROTOR``.

    In each ``dt`` call :meth:`correct`, decide, and call :meth:`predict`.
    """

    def __init__(
        self,
        env: Env = None,
        *,
        angle_std: float,
        torque_std: float,
        parameter_std: Mapping[str, float] | None = None,
    ) -> None:
        named = parameter_std or {}
        if unknown := named.keys() - set(_ESTIMATED):
            raise must_be("parameter_std", f"of {', '.join(_ESTIMATED)}", sorted(unknown))
        given = [named.get(name, 0.0) for name in _ESTIMATED]
        self._native = _native.Estimator(_acrobot(env)._native, angle_std, torque_std, given)

    def correct(self, angles: ArrayLike) -> Floats:
        """Correct the estimate by measured theta1 and theta2, rad. Return the state."""
        measured = numbers("angles", "two numbers", angles, (2,)).tolist()
        return np.array(self._native.correct(measured))

    def predict(self, torque: float) -> None:
        """Predict the state after one ``dt`` under a torque, N m."""
        self._native.predict(torque)

    @property
    def state_std(self) -> Floats | None:
        """The standard deviations of the state. ``None`` before a measurement."""
        found = self._native.state_std()
        return None if found is None else np.array(found)

    @property
    def params(self) -> dict[str, Any]:
        """The parameters, estimated and known, as arguments of an environment."""
        return dict(self._native.params())


@dataclass(frozen=True)
class Fit:
    """What :func:`identify` finds.

    ``values`` are ten numbers that a motion tells, by name, with ``std_errors``: ``Fit::NAMES`` in
    Rust has them. ``rank_deficiency`` combinations of them are not determined, and ``weakest`` has
    the parts of the one that is determined worst.
    """

    params: dict[str, Any]  #: arguments of an environment, each a number
    values: dict[str, float]
    std_errors: dict[str, float]
    weakest: dict[str, float]
    rank_deficiency: int


def identify(angles: Sequence[ArrayLike], torques: Sequence[ArrayLike], env: Env) -> Fit:
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
    params, found, rank_deficiency = _native.identify(_acrobot(env)._native, recordings)
    values, std_errors, weakest = ({name: row[i] for name, row in found} for i in range(3))
    return Fit(dict(params), values, std_errors, weakest, rank_deficiency)


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
#: The parameters that an estimator can find, in the order of the native part.
_ESTIMATED = (
    *("LINK_MASS_1", "LINK_MASS_2", "LINK_LENGTH_1", "LINK_MOI_1", "LINK_MOI_2"),
    *("DAMPING_1", "DAMPING_2", "COULOMB_1", "COULOMB_2", "ROTOR"),
)
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
