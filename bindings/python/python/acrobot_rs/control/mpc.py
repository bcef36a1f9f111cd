"""Model-predictive control: from encoder counts to torques."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from acrobot_rs import _native
from acrobot_rs.arrays import LARGEST, finite, float32, integer, must_be
from acrobot_rs.control.model import Env, Floats, acrobot_of


class Report(NamedTuple):
    """What a :class:`Controller` knows beside the state and the parameters."""

    zeros: tuple[float, float]  #: what the encoders say where the angles are 0, rad
    torque_factor: float  #: the torque that acts, divided by the one that is sent
    #: of the last hundred ticks, those whose angles no motion explains, and 4 for each radian that
    #: a joint has turned since the other one's encoder counted
    misses: float
    plan_age: float  #: the time since the last plan, s; 0 before the first one


def _checked_counts(counts: Sequence[int]) -> list[int]:
    if not isinstance(counts, Sequence | np.ndarray) or len(counts) != 2:
        raise must_be("counts", "two integers", repr(counts))
    return [integer("counts", count, -(2**31), 2**31 - 1) for count in counts]


class _WithSettings:
    """What a :class:`Controller` and a :class:`Replanner` are made from."""

    _kind: Any  #: the native class

    def __init__(
        self,
        env: Env = None,
        *,
        limit: float,
        counts: Sequence[int],
        delay: float = 0.0,
        plan_timeout: float = 1.0,
    ) -> None:
        timeout = finite("plan_timeout", "a number of s above 0", plan_timeout, largest=np.inf)
        numbers = [
            float32("limit", "a finite number of N m above 0", limit),
            float32("delay", "a finite number of s", delay),
            min(float(timeout), LARGEST),
        ]
        acrobot = acrobot_of(env)._native
        self._native = self._kind(acrobot, numbers, _checked_counts(counts))


class Controller(_WithSettings):
    """Takes a machine from encoder counts to torques, with the plans of a :class:`Replanner`.

    ``env`` has the parameters, and its ``dt`` is the time from a tick to the next. ``limit`` is the
    motor's largest torque, N m; ``counts`` are those of each encoder for a turn; ``delay``, s, is
    the time from a torque until it acts, with the time constant of the motor. While the plan is
    older than ``plan_timeout``, s, the torque is 0.

    In each ``dt`` call :meth:`tick`, in a thread of its own or not. It estimates velocities and,
    while the machine moves, parameters, the encoders' zeros and the part of the torque that acts.
    """

    _kind = _native.Controller

    def tick(self, counts: Sequence[int]) -> float:
        """Return the torque until the next tick, N m, from what both encoders count.

        If it raises, switch the motor off: a number is not finite, or no motion of the machine
        explains what the encoders count.
        """
        return self._native.tick(_checked_counts(counts))

    @property
    def state(self) -> Floats:
        """The estimated state."""
        return np.array(self._native.state(), np.float64)

    @property
    def params(self) -> dict[str, Any]:
        """The estimated parameters, as arguments of an environment."""
        return dict(self._native.params())

    @property
    def report(self) -> Report:
        """What the controller knows beside the state and the parameters."""
        return Report(*self._native.report())


class Replanner(_WithSettings):
    """Plans for a :class:`Controller` while the machine moves, with the same arguments.

    Call :meth:`exchange` and :meth:`work` again and again, in another thread than ``tick`` or after
    every few ticks.
    """

    _kind = _native.Replanner

    def exchange(self, controller: Controller) -> None:
        """Give the controller the plan once it is due, and take its estimates. It is short."""
        if not isinstance(controller, Controller):
            raise must_be("controller", "a Controller", repr(controller), TypeError)
        self._native.exchange(controller._native)

    def work(self) -> None:
        """Plan for one slice, about half a millisecond on a desktop, while other threads run."""
        self._native.work()
