"""Motions to an equilibrium: by a plan, or without one."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import _native
from acrobot_rs.arrays import float32, independent, integer, must_be, numbers
from acrobot_rs.control.model import Env, acrobot_of


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


@dataclass(frozen=True, eq=False)
class Plan:
    """Steps of ``dt``, s, and the feedback after them. ``plan[10:]`` is the plan after ten steps.

    It is plain data, so it can be pickled and needs no planner.
    """

    states: NDArray[np.float32]  #: before each step, (n, 4)
    torques: NDArray[np.float32]  #: (n,), N m
    gains: NDArray[np.float32]  #: (n, 4): K in u = torque - K x for the deviation x from the state
    dt: float
    after: Feedback

    def __len__(self) -> int:
        """The number of steps."""
        return len(self.torques)

    def __eq__(self, other: object) -> bool:
        def values(plan: Plan) -> tuple[Any, ...]:
            return plan._rows().tolist(), plan.dt, plan.after

        return isinstance(other, Plan) and values(self) == values(other)

    def __getitem__(self, steps: slice) -> Plan:
        if not isinstance(steps, slice) or steps.step not in (None, 1):
            rule = "a slice without gaps, such as plan[10:]"
            raise must_be("the index of a plan", rule, repr(steps), TypeError)
        states, torques, gains = self.states[steps], self.torques[steps], self.gains[steps]
        return replace(self, states=states, torques=torques, gains=gains)

    def torque(self, step: int, state: ArrayLike) -> float:
        """The torque at a step, counted from 0, or after the plan, N m. It is not limited."""
        knot = None
        if integer("step", step, 0, 2**63 - 1) < len(self):
            torque = self.torques[step].item()
            knot = [*self.states[step].tolist(), torque, *self.gains[step].tolist()]
        return _native.plan_torque(knot, self.after, _four(state))

    def save(self, path: str | Path) -> None:
        """Write the plan as a constant of Rust or C: see :func:`acrobot_rs.control.save`."""
        from acrobot_rs.control.save import save  # which imports this file

        save(path, plan=self)

    def _rows(self) -> NDArray[np.float32]:
        return np.column_stack([self.states, self.torques, self.gains])


class Planner:
    """Plans motions to an equilibrium in ``float32``, for a motor of at most ``max_torque``, N m.

    The acrobot ends upright, or balances with a bent elbow: ``elbow`` is its theta2, rad. Or it
    ends in ``target``, any state in which it stays under a constant torque, such as hanging at
    rest. ``q`` to ``arrival`` are the weights of what a plan costs: see ``Cost`` in Rust, which has
    the defaults. ``q`` and ``qf`` have the shape ``(4, 4)``, or are the four numbers of a diagonal;
    with them, ``torque``, and 0 for ``below`` and ``arrival`` the cost is quadratic. No velocity of
    a plan reaches a bound of the parameters. With ``velocity_clamp`` it may: environments clamp it
    there.
    """

    def __init__(
        self,
        max_torque: float,
        env: Env = None,
        *,
        elbow: float = 0.0,
        target: ArrayLike | None = None,
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
        matrix = "numbers of shape (4, 4) or (4,)"
        weights = [
            *_weights("q", q, matrix, (4, 4)),
            *_weights("qf", qf, matrix, (4, 4)),
            *_weights("angles", angles, "two numbers per s", (2,)),
            *_weights("torque", torque, "a number per (N m)² s"),
            *_weights("torque_change", torque_change, "a number per (N m)²"),
            *_weights("power", power, "a number per J"),
            *_weights("below", below, "a number per s"),
            *_weights("height", height, "a number of m"),
            *_weights("margin", margin, "a number of m"),
            *_weights("arrival", arrival, "a number"),
        ]
        acrobot, bent = acrobot_of(env), float32("elbow", "a number of rad", elbow)
        clamp = bool(numbers("velocity_clamp", "True or False", velocity_clamp, (), "b"))
        end = None if target is None else _four(target, "target")
        if bent and end:
            raise must_be("elbow", "0 with a target", elbow)
        arguments = _largest(max_torque), bent, end, clamp, weights
        self._native = _native.Planner(acrobot._native, *arguments)
        end, held, moving, resting, reach = self._native.after()
        self._after = Feedback(end, held, Region(*moving), Region(*resting), reach)
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
        """A plan of at most ``steps``, from 1 to 65,535, after which its feedback holds the target.

        A seed, an integer from 0 of any size, gives the same plan everywhere, also in Rust. There
        are 1 to 2^32 - 1 ``tries``. After each 40 of them ``progress`` is called with the number of
        all so far, and Ctrl-C acts. A ``RuntimeError`` says that no try found a plan.
        """
        search = _search(steps, tries, seed, progress)
        return self._plan(self._native.plan(_four(state), *search))

    def plan_each(
        self,
        states: ArrayLike,
        *,
        steps: int,
        tries: int = 1000,
        seed: int = 0,
        progress: Callable[[int], object] | None = None,
    ) -> tuple[list[Plan | None], NDArray[np.bool_]]:
        """Plan from each of many states, ``(n, 4)``. Return plans, and which states have one.

        Each plan is that of :meth:`plan`, with the same arguments, or ``None``; but 16 tries are
        computed at once, by one core. Ten times a second Ctrl-C acts and ``progress`` is called
        with the number of states that have a plan, and once more at the end.
        """
        search = _search(steps, tries, seed, progress)
        states = numbers("states", "numbers of shape (n, 4), rad and rad/s", states, None)
        plans = self._native.plan_each(_each(states, states.size // 4), *search)
        found = [None if rows is None else self._plan(rows) for rows in plans]
        return found, np.array([plan is not None for plan in found], np.bool_)

    def improve(self, state: ArrayLike, plan: Plan, iterations: int = 150) -> tuple[Plan, float]:
        """Improve a plan, from a state on. Return the new one, and what it costs."""
        iterations = integer("iterations", iterations, 0, 2**32 - 1)
        rows, cost = self._native.improve(_four(state), rows_of("plan", plan), iterations)
        return self._plan(rows), cost

    def improve_each(
        self, states: ArrayLike, plans: Sequence[Plan], iterations: int = 150
    ) -> tuple[list[Plan], NDArray[np.float32]]:
        """Improve many plans, each from its state. A cost is infinite where numbers overflow."""
        if not isinstance(plans, Sequence):
            raise must_be("plans", "a list of plans", repr(plans), TypeError)
        rows, given = [rows_of("plans", plan) for plan in plans], _each(states, len(plans))
        iterations = integer("iterations", iterations, 0, 2**32 - 1)
        rows, costs = self._native.improve_each(given, rows, iterations)
        return [self._plan(each) for each in rows], np.array(costs, np.float32)

    def _plan(self, rows: list[list[float]]) -> Plan:
        array = np.array(rows, np.float32).reshape(-1, 9)
        return Plan(array[:, :4], array[:, 4], array[:, 5:], self._dt, self._after)


def _weights(name: str, value: Any, rule: str, shape: tuple[int, ...] = ()) -> list[float | None]:
    """The elements of a weight, of a matrix also from its diagonal. ``None`` for the default."""
    if value is None:
        return [None] * math.prod(shape)
    is_diagonal = shape == (4, 4) and numbers(name, rule, value, None).shape == (4,)
    given = float32(name, rule, value, (4,) if is_diagonal else shape)
    return np.ravel(np.diag(given) if is_diagonal else given).tolist()


def _search(
    steps: int, tries: int, seed: int, progress: Callable[[int], object] | None
) -> tuple[Any, ...]:
    """What a search is given beside states."""
    if not (progress is None or callable(progress)):
        raise must_be("progress", "a function or None", repr(progress), TypeError)
    steps, tries = integer("steps", steps, 1, 2**16 - 1), integer("tries", tries, 1, 2**32 - 1)
    return steps, tries, integer("seed", seed, 0, math.inf), progress


def _each(states: ArrayLike, count: int) -> list[list[float]]:
    rule = f"numbers of shape ({count}, 4), rad and rad/s"
    return float32("states", rule, states, (count, 4))


def _largest(max_torque: float) -> float:
    return float32("max_torque", "a number of N m above 0", max_torque)


def _four(state: ArrayLike, name: str = "state") -> list[float]:
    return float32(name, "four numbers, rad and rad/s", state, (4,))


def rows_of(name: str, plan: Plan) -> list[list[float]]:
    if not isinstance(plan, Plan):
        raise must_be(name, "a Plan, such as Planner.plan returns", repr(plan), TypeError)
    return float32(name, "a Plan of finite numbers", plan._rows(), (len(plan), 9))


class SwingUp:
    """Swings up without a plan, in ``float32``: pumps energy, and holds once it can."""

    __copy__ = independent

    def __init__(self, max_torque: float, env: Env = None) -> None:
        self._native = _native.SwingUp(acrobot_of(env)._native, _largest(max_torque))

    def torque(self, state: ArrayLike) -> float:
        """The torque, N m, at most the largest. Call it at each ``dt``."""
        return self._native.torque(_four(state))
