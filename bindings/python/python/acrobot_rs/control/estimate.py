"""The state of a machine from its angles alone, and its parameters."""

from __future__ import annotations

import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from acrobot_rs import _native
from acrobot_rs.arrays import finite, independent, must_be
from acrobot_rs.control.model import Env, Floats, acrobot_of, simulate
from acrobot_rs.control.save import save
from acrobot_rs.env import AcrobotEnv

#: The parameters that an estimator can find, in the order of the native part: derive.py writes
#: them.
_ESTIMATED = (
    "LINK_MASS_1",
    "LINK_MASS_2",
    "LINK_LENGTH_1",
    "LINK_MOI_1",
    "LINK_MOI_2",
    "DAMPING_1",
    "DAMPING_2",
    "COULOMB_1",
    "COULOMB_2",
    "ROTOR",
    "ZERO_1",
    "ZERO_2",
    "TORQUE_FACTOR",
)


class Estimator:
    """Estimates the state of a machine from its angles alone: an extended Kalman filter.

    The model has the parameters of ``env``. ``angle_std``, rad, and ``torque_std``, N m, are the
    standard deviations of the noise; an encoder of n counts a turn has 1.8 / n. Parameters that
    are named in ``parameter_std``, with their standard deviations, are estimated too: masses,
    moments of inertia, the length of link 1, frictions, ``ROTOR``, and the instruments: ``ZERO_1``
    and ``ZERO_2``, what the encoders say where the angles are 0, and ``TORQUE_FACTOR``, the torque
    that acts, divided by the one of :meth:`predict`.

    In each ``dt`` call :meth:`correct`, decide, and call :meth:`predict`.
    """

    __copy__ = independent

    def __init__(
        self,
        env: Env = None,
        *,
        angle_std: float,
        torque_std: float,
        parameter_std: Mapping[str, float] | None = None,
    ) -> None:
        named = {} if parameter_std is None else parameter_std
        if not isinstance(named, Mapping) or named.keys() - set(_ESTIMATED):
            rule = f"a dict of {', '.join(_ESTIMATED)}"
            raise must_be("parameter_std", rule, repr(parameter_std))
        rule, known = "a finite number of its unit, at least 0", dict.fromkeys(_ESTIMATED, 0.0)
        given = [
            finite(f"parameter_std[{x!r}]", rule, std) for x, std in {**known, **named}.items()
        ]
        angle = finite("angle_std", "a number of rad, above 0 and at most 2", angle_std)
        torque = finite("torque_std", "a finite number of N m above 0", torque_std)
        self._native = _native.Estimator(acrobot_of(env)._native, angle, torque, given)

    def correct(self, angles: ArrayLike) -> Floats:
        """Correct the estimate by measured theta1 and theta2, rad. Return the state."""
        measured = finite("angles", "two finite numbers of rad", angles, (2,)).tolist()
        return np.array(self._native.correct(measured))

    def predict(self, torque: float) -> None:
        """Predict the state after one ``dt`` under a torque, N m."""
        self._native.predict(finite("torque", "a finite number of N m", torque))

    @property
    def state_std(self) -> Floats | None:
        """The standard deviations of the state. ``None`` before a measurement."""
        found = self._native.state_std()
        return None if found is None else np.array(found)

    @property
    def zeros(self) -> Floats:
        """What the encoders are estimated to say where the angles are 0, rad."""
        return np.array(self._native.zeros())

    @property
    def torque_factor(self) -> float:
        """The torque that is estimated to act, divided by the one of :meth:`predict`."""
        return self._native.torque_factor()

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

    def save(self, path: str | Path) -> None:
        """Write ``params`` as a constant of Rust or C: see :func:`acrobot_rs.control.save`."""
        save(path, params=self.params)


def identify(angles: Sequence[ArrayLike], torques: Sequence[ArrayLike], env: Env) -> Fit:
    """Identify a machine from recordings in which both links move, for ten seconds or so.

    A recording has angles, ``(n, 2)``, rad, without jumps by whole turns, and the motor's torques,
    ``(n,)``, N m, or those of both joints, ``(n, 2)``, each until the next sample. ``env`` has
    ``dt``, gravity and the centres of mass; its lengths should be about right.

    It believes the recording. A wrong sign, a zero that is off, an absolute theta2, a torque that
    acts late or is in another unit, and lost rows give wrong numbers without an error:
    :func:`calibrate` finds or names them.
    """
    for name, given in (("angles", angles), ("torques", torques)):
        if not (isinstance(given, Sequence | np.ndarray) and len(given) == len(angles)):
            raise must_be(name, "a list of as many arrays", reprlib.repr(given), TypeError)
    recordings = [_rows(*recording) for recording in zip(angles, torques, strict=True)]
    return _fit(*_native.identify(acrobot_of(env)._native, recordings))


def _rows(angles: ArrayLike, torques: ArrayLike) -> list[list[float]]:
    columns = finite("torques", "finite numbers of N m", torques, None)
    if columns.ndim == 1:
        columns = np.column_stack([np.zeros_like(columns), columns])
    if columns.ndim != 2 or columns.shape[1] != 2:
        raise must_be("torques", "arrays of shape (n,) or (n, 2)", columns.shape)
    rule = f"finite numbers of shape {columns.shape}, rad, as many as torques"
    return np.column_stack([finite("angles", rule, angles, columns.shape), columns]).tolist()


def _fit(params: Any, found: Any, rank_deficiency: int) -> Fit:
    values, std_errors, weakest = ({name: row[i] for name, row in found} for i in range(3))
    return Fit(dict(params), values, std_errors, weakest, rank_deficiency)


@dataclass(frozen=True)
class Calibration:
    """What :func:`calibrate` finds."""

    fit: Fit
    zeros: tuple[float, float]  #: the recorded angles where those of the machine are 0, rad
    delay: float  #: from a torque until it acts, with the time constant of the motor, s
    #: The root of the mean square of the errors of angles, rad, if parameters of the first two
    #: thirds predict the last third, for the square root of
    #: ``(LINK_LENGTH_1 + LINK_COM_POS_2) / gravity``.
    prediction_error: float
    #: The standard deviation of the noise of the angles, rad, which encoders add by counting. At
    #: ``dt`` above 5 ms it may be several times too large.
    angle_noise: float
    report: str  #: all this in words, and what the recording does not tell; ``print`` shows it

    def __str__(self) -> str:
        return self.report

    def plot(self, angles: ArrayLike, torques: ArrayLike, axes: Any = None) -> Any:
        """Plot a recording, and how the parameters predict each half second from its first state.

        The torques are those of the motor, ``(n,)``. Needs Matplotlib; returns its axes.
        """
        import matplotlib.pyplot as plt

        axes = plt.gca() if axes is None else axes
        rule = "finite numbers of N m, of shape (n,), as many as angles"
        torques = finite("torques", rule, torques, np.shape(angles)[:1])
        recorded = np.array(_rows(angles, torques))[:, :2] - self.zeros
        free = {"MAX_VEL_1": np.inf, "MAX_VEL_2": np.inf}  # a machine has no bounds
        env = AcrobotEnv(**{**self.fit.params, **free})
        times = env.dt * np.arange(len(recorded))
        acting = np.interp(times - self.delay, times, torques)
        for i, line in enumerate(axes.plot(times, recorded)):
            line.set_label(f"theta{i + 1}, recorded")
        half, length = max(3, round(0.01 / env.dt)), round(0.5 / env.dt)
        around = np.arange(-half, half + 1)
        for start in range(half, len(recorded) - half, length):
            *_, velocity, angle = np.polyfit(env.dt * around, recorded[start + around], 3)
            part = slice(start, start + length)
            states = simulate([*angle, *velocity], acting[part], env)[:-1]
            predicted = np.unwrap(states[:, :2], axis=0)
            lines = axes.plot(times[part], predicted, "k--", linewidth=1)
        lines[0].set_label("predicted")
        axes.set(xlabel="time, s", ylabel="angle, rad")
        axes.legend()
        return axes


def calibrate(angles: ArrayLike, torques: ArrayLike, env: Env) -> Calibration:
    """Calibrate a machine from one recording in which both links move, for ten seconds or so.

    As :func:`identify`, for angles whose zeros are unknown, up to 0.5 rad, and a torque that acts
    late. An error says which angle or torque has the wrong sign, that samples are lost, that the
    torques are in another unit, which link hardly moved, and what is not determined.
    """
    acrobot, rows = acrobot_of(env)._native, _rows(angles, torques)
    found, zeros, numbers, report = _native.calibrate(acrobot, rows)
    return Calibration(_fit(*found), tuple(zeros), *numbers, report)
