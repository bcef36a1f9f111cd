"""What the single and the vector environment share: parameters, their draws, and the spaces."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from gymnasium import logger, spaces

from acrobot_rs._native import BOUND, Acrobot, Batch
from acrobot_rs.arrays import LARGEST, independent, must_be


@dataclasses.dataclass(frozen=True)
class Uniform:
    """A parameter that each reset draws uniformly, in each environment that it resets.

    The bounds of ``AVAIL_TORQUE`` are three numbers each.

    >>> import acrobot_rs
    >>> envs = acrobot_rs.AcrobotVectorEnv(1024, LINK_MASS_1=acrobot_rs.Uniform(0.8, 1.2))
    """

    _KIND: ClassVar = "uniform"

    low: Any
    high: Any


@dataclasses.dataclass(frozen=True)
class LogUniform:
    """A parameter whose logarithm each reset draws uniformly. ``low`` is above 0."""

    _KIND: ClassVar = "log_uniform"

    low: float
    high: float


@dataclasses.dataclass(frozen=True)
class Normal:
    """A parameter that each reset draws from a normal distribution, truncated at the bounds.

    ``mean`` and ``std`` are those before the truncation. ``mean`` is between the bounds.
    """

    _KIND: ClassVar = "normal"

    mean: float
    std: float
    low: float
    high: float


Drawn = Uniform | LogUniform | Normal

#: What people override in Gymnasium's acrobot, and what has the same effect here.
_PHYSICS = "set parameters, such as LINK_MASS_1 and DAMPING_1, or override step"
_OF_GYMNASIUM = {
    **dict.fromkeys(("_dsdt", "_rk4"), _PHYSICS),
    "_terminal": "override step, or use a gymnasium.Wrapper",
    "_get_ob": "override reset and step, or use a gymnasium.ObservationWrapper",
    "SCREEN_DIM": "resize the frames of render",
}


class Parameters:
    """The parameters of the physics, with Gymnasium's names.

    Set them as arguments, on an environment or in a subclass, whose parameters a new environment
    copies. An environment checks a value immediately, which acts from the next step. The spaces
    follow. A single environment may have any number of torques.

    The names in small letters from ``action_delay`` on are instruments: the motor and the sensors
    of a real acrobot. ``None`` is ideal, and delays are at most 8 steps. Rewards and ends use the
    true state. A number acts at once, and a draw from the next reset on.
    """

    # derive.py writes the parameters.
    #: Length of link 1, m; above 0.
    LINK_LENGTH_1: Any = 1.0
    #: Length of link 2, m; above 0. Only the tip's height and drawings depend on it.
    LINK_LENGTH_2: Any = 1.0
    #: Mass of link 1, kg; above 0.
    LINK_MASS_1: Any = 1.0
    #: Mass of link 2, kg; above 0.
    LINK_MASS_2: Any = 1.0
    #: Distance of link 1's centre of mass from its joint, m; 0 or more.
    LINK_COM_POS_1: Any = 0.5
    #: Distance of link 2's centre of mass from its joint, m; 0 or more.
    LINK_COM_POS_2: Any = 0.5
    LINK_MOI: Any = 1.0  #: of both links, kg m²; 0 or more
    #: Moment of inertia of link 1 about its centre of mass, kg m²; 0 or more, and above 0 if the
    #: centre of mass is on the joint. ``None``: ``LINK_MOI``.
    LINK_MOI_1: Any = None
    #: Moment of inertia of link 2 about its centre of mass, kg m²; as ``LINK_MOI_1``. ``None``:
    #: ``LINK_MOI``.
    LINK_MOI_2: Any = None
    #: Acceleration of gravity, m/s², downwards; finite, 0 for none.
    gravity: Any = 9.8
    #: Duration of one step, s; above 0.
    dt: Any = 0.2
    #: Bound of |θ̇1| after a step, rad/s; at least 1.2e-38. Infinity, for none, is stored as
    #: 3.4e38, the largest number in single precision, which observations have.
    MAX_VEL_1: Any = 4 * math.pi
    #: Bound of |θ̇2| after a step, rad/s; as ``MAX_VEL_1``.
    MAX_VEL_2: Any = 9 * math.pi
    #: Torques of the three actions, N m, in the order of their numbers; finite.
    AVAIL_TORQUE: Any = (-1.0, 0.0, 1.0)
    #: Torque noise, N m; 0 or more. Each step adds a uniform draw from [−noise, noise) to the
    #: torque; 0 draws nothing.
    torque_noise_max: Any = 0.0
    #: Viscous friction of the fixed joint, which resists θ̇1 with a torque in proportion to it,
    #: N m s/rad; 0 or more.
    DAMPING_1: Any = 0.0
    #: Viscous friction of the elbow, which resists θ̇2; as ``DAMPING_1``.
    DAMPING_2: Any = 0.0
    #: Coulomb friction of the fixed joint: its torque as soon as the joint turns, N m; 0 or more.
    COULOMB_1: Any = 0.0
    #: Coulomb friction of the elbow; as ``COULOMB_1``.
    COULOMB_2: Any = 0.0
    #: What a geared rotor in the elbow takes from the coupling of the links, kg m²; finite, and so
    #: small that the mass matrix is positive definite. A rotor of moment of inertia J behind a gear
    #: g adds (g + 1)² J to ``LINK_MOI_1``, g² J to ``LINK_MOI_2``, and (g + 1) g J here.
    ROTOR: Any = 0.0
    #: The equations of motion: of Sutton and Barto's book, or of the paper of 1996 (NIPS 8).
    book_or_nips: Any = "book"
    # The end of the parameters.

    # derive.py writes the instruments.
    #: How many steps later a torque acts: a whole number, each equally likely.
    action_delay: Any = None
    #: How many steps later an agent sees a reading: a whole number, each equally likely.
    observation_delay: Any = None
    #: The time constant of the motor, s, from 0 to 1000: the torque approaches the chosen one.
    motor_lag: Any = None
    #: The relative error of the motor's torque, from −1 to 1000: with 0.1 it is 10 % too large.
    torque_error: Any = None
    #: The standard deviation of a reading of an angle, rad, from 0 to 10.
    angle_noise: Any = None
    #: What encoder 1 reads where θ1 is 0, rad, from −π to π.
    encoder_zero_1: Any = None
    #: What encoder 2 reads where θ2 is 0, rad, from −π to π.
    encoder_zero_2: Any = None
    #: The counts of the encoders for a turn, from 1 to 2²²: readings are whole counts.
    encoder_counts: Any = None
    #: The time constant of a low-pass filter, s, from 0 to 1000. The agent sees filtered
    #: differences of readings as velocities, and not the true ones.
    velocity_filter: Any = None
    # The end of the instruments.

    metadata: dict[str, Any]
    spec: Any
    render_mode: str | None
    _native: Acrobot | Batch
    #: The names of the parameters, of the instruments, and of both.
    _NAMES: tuple[str, ...] = ()
    _INSTRUMENTS: tuple[str, ...] = ()
    _ALL: tuple[str, ...] = ()
    #: The task, by its name in Rust.
    _TASK = "gymnasium"
    #: The default bound of initial states, rad and rad/s.
    _BOUND: float = BOUND
    #: Whether actions are numbers in a ``Box``, and what they are.
    _CONTINUOUS = False
    _ACTION = "a torque in N m"

    def __init_subclass__(cls, **others: Any) -> None:
        """Reject what has an effect in a subclass of Gymnasium's acrobot only."""
        super().__init_subclass__(**others)
        for name, instead in _OF_GYMNASIUM.items():
            if hasattr(cls, name):
                raise TypeError(f"{cls.__name__}.{name} has no effect here; {instead}")

    def __init__(
        self, native: Acrobot | Batch, render_mode: str | None, parameters: Mapping[str, Any]
    ) -> None:
        """Pass these parameters, and those of the class, to the native part."""
        for name in parameters.keys() - set(self._ALL):
            # Other programs, such as torchrl, look for Python's words.
            words = f"{type(self).__name__}.__init__() got an unexpected keyword argument {name!r}"
            raise TypeError(f"{words}; the parameters are {', '.join(self._ALL)}")
        modes = self.metadata["render_modes"]
        if render_mode not in (None, *modes):
            raise must_be("render_mode", f"None or one of {modes}", repr(render_mode))
        self._native = native
        self.render_mode = render_mode
        # LINK_MOI, which may be 0 with some centres of mass only, comes after them.
        values = {name: getattr(self, name) for name in self._ALL}
        if "LINK_MOI" in parameters:
            values |= {"LINK_MOI_1": None, "LINK_MOI_2": None}
        for name, value in (values | {**parameters}).items():
            if value is not None or name in parameters:
                setattr(self, name, value)
        for name, space in self._spaces().items():
            setattr(self, name, space)

    @property
    def parameters(self) -> dict[str, Any]:
        """All parameters by their names: arguments that make the same environment again."""
        values = {name: getattr(self, name) for name in self._ALL}
        return {name: value for name, value in values.items() if value is not None}

    def _pass(self, name: str, value: Any) -> Any:
        """Pass a parameter to the native part, which checks it. Return it unchangeable."""
        if name in self._INSTRUMENTS:
            self._native.set_instrument(name, [] if value is None else [value])
            return value if value is None or isinstance(value, Drawn) else float(value)
        self._native.set(name, value)
        return self._fixed(name, value)

    @staticmethod
    def _fixed(name: str, value: Any) -> Any:
        """A valid value as an object that cannot change: a change of an array has no effect."""
        if name == "book_or_nips":
            return value
        return tuple(map(float, value)) if name == "AVAIL_TORQUE" else float(value)

    def _spaces(self) -> dict[str, spaces.Space[Any]]:
        """All spaces, by the names of their attributes. Here those of a single environment."""
        low, high, *velocities = self._limits()
        actions: spaces.Space[Any]
        if self._CONTINUOUS:
            actions = spaces.Box(low, high, (1,), np.float32)
        else:
            torques = getattr(self.AVAIL_TORQUE, "low", self.AVAIL_TORQUE)
            actions = spaces.Discrete(np.shape(torques)[-1])
        with np.errstate(over="ignore"):
            highest = np.array([1.0, 1.0, 1.0, 1.0, *velocities], dtype=np.float32)
        return {
            "action_space": actions,
            "observation_space": spaces.Box(-highest, highest, dtype=np.float32),
        }

    def _limits(self) -> tuple[float, float, float, float]:
        """What the spaces contain: actions from one number to another, and velocities, rad/s."""
        torque: Any = self.AVAIL_TORQUE
        lows, highs = (getattr(torque, each, torque) for each in ("low", "high"))
        bounds: tuple[Any, ...] = (self.MAX_VEL_1, self.MAX_VEL_2)
        velocities = (np.max(getattr(each, "high", each)) for each in bounds)
        # After a step, or after a reset with the default bounds; differences of readings within
        # half a turn.
        least = self._BOUND
        if self.velocity_filter is not None:
            least = max(least, 1.00001 * math.pi / np.min(getattr(self.dt, "low", self.dt)))
        first, second = (max(each, least) for each in velocities)
        return max(np.min(lows), -LARGEST), min(np.max(highs), LARGEST), first, second

    if not TYPE_CHECKING:  # a checker would accept all names

        def __setattr__(self, name: str, value: Any) -> None:
            """Check a parameter and set it."""
            is_made, cls = "observation_space" in vars(self), type(self)
            if name in self._ALL:
                value = self._pass(name, value)
            elif is_made and cls.__module__.startswith("acrobot_rs."):  # subclasses may have others
                if not (name.startswith("_") or name in vars(self) or hasattr(cls, name)):
                    rule = f"the parameters are {', '.join(self._ALL)}"
                    raise AttributeError(f"{cls.__name__} has no attribute {name!r}; {rule}")
            super().__setattr__(name, value)
            if name == "LINK_MOI":
                vars(self).update(LINK_MOI_1=None, LINK_MOI_2=None)
            if name == "dt" and isinstance(value, float):
                fps = 15 if value == 0.2 else 1 / value  # Gymnasium's, or real time
                self.metadata = {**self.metadata, "render_fps": fps}
            if is_made and name in _OF_SPACES:
                for space, new in self._spaces().items():
                    current = getattr(self, space)
                    if current != new:
                        new.seed(int(current.np_random.integers(2**32)))
                        super().__setattr__(space, new)

    __copy__ = independent

    def _warn_of_no_render_mode(self) -> None:
        what = 'it was made without a render mode, such as render_mode="rgb_array"'
        logger.warn(f"render of {type(self).__name__} returns None, because {what}")


#: What the spaces depend on.
_OF_SPACES = ("AVAIL_TORQUE", "MAX_VEL_1", "MAX_VEL_2", "dt", "velocity_filter")
_PUBLIC = (name for name in Parameters.__annotations__ if not name.startswith("_"))
Parameters._ALL = tuple(name for name in _PUBLIC if hasattr(Parameters, name))
_FIRST = Parameters._ALL.index("action_delay")
Parameters._NAMES, Parameters._INSTRUMENTS = Parameters._ALL[:_FIRST], Parameters._ALL[_FIRST:]
