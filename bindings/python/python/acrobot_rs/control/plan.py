"""Motions to an equilibrium: by a plan, or without one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import _native
from acrobot_rs.arrays import integer, must_be, numbers
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
        acrobot = acrobot_of(env)
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
        self._native = _native.SwingUp(acrobot_of(env)._native, max_torque)

    def torque(self, state: ArrayLike) -> float:
        """The torque, N m, at most the largest. Call it at each ``dt``."""
        return self._native.torque(_four(state))
