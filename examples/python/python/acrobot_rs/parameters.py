"""What the single and the vector environment share: parameters, the observation space and reset bounds."""

from __future__ import annotations

import copy
import dataclasses
import difflib
import functools
import math
import reprlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
from gymnasium import logger, spaces
from gymnasium.envs.classic_control.utils import maybe_parse_reset_bounds
from numpy.typing import NDArray

from acrobot_rs._native import Acrobot, Batch

#: The names of the parameters. The class below defines them.
_NAMES: tuple[str, ...] = ()
_EQUATIONS = "the equations are in Rust: change parameters, or use gymnasium.envs.classic_control.AcrobotEnv"
#: What Gymnasium's environment calls or reads, but ours does not, and what to do instead.
_IGNORED = {
    "_dsdt": _EQUATIONS,
    "rk4": _EQUATIONS,
    "wrap": _EQUATIONS,
    "bound": _EQUATIONS,
    "_get_ob": "change observations with a wrapper",
    "_terminal": "change the end of episodes with a wrapper",
    "SCREEN_DIM": "pictures have 500 x 500 pixels: resize what render returns",
}


@dataclasses.dataclass(frozen=True)
class Uniform:
    """A parameter of a vector environment that each reset draws uniformly between two bounds, in each environment.

    >>> import acrobot_rs
    >>> envs = acrobot_rs.AcrobotVectorEnv(1024)
    >>> envs.LINK_MASS_1 = acrobot_rs.Uniform(0.8, 1.2)
    """

    low: Any
    high: Any


def _fixed(name: str, value: Any) -> Any:
    """A valid value, as an object that cannot change: a change of an array would have no effect."""
    if isinstance(value, Uniform):
        return Uniform(_fixed(name, value.low), _fixed(name, value.high))
    if name == "book_or_nips":
        return value
    return tuple(map(float, value)) if name == "AVAIL_TORQUE" else float(value)


def _reject_ignored(cls: type, name: str) -> None:
    if name in _IGNORED:
        raise TypeError(f"{name} would have no effect on {cls.__name__}; {_IGNORED[name]}")
    if meant := _meant(name):
        raise AttributeError(f"{cls.__name__} has no parameter {name}; did you mean {meant}?")


@functools.cache
def _meant(name: str) -> str | None:
    """The parameter that a name resembles."""
    if name.startswith("_") or name in _NAMES:
        return None
    names = {each.lower(): each for each in _NAMES}
    close = difflib.get_close_matches(name.lower(), names, n=1, cutoff=0.8)
    return names[close[0]] if close else None


class Parameters:
    """The parameters of the physics, with Gymnasium's names. Set them on an environment or in a subclass.

    A value is checked immediately and acts from the next step. An invalid value raises a ``ValueError`` or a ``TypeError``
    that says what is valid, and a misspelt name an ``AttributeError``. An environment takes over the values that its class
    has when it is made.
    """

    #: Duration of one step, s; above 0.
    dt: float = 0.2
    #: Length of link 1, m; above 0.
    LINK_LENGTH_1: float = 1.0
    #: Length of link 2, m; above 0. It changes pictures only: neither the equations of motion nor the goal contain it.
    LINK_LENGTH_2: float = 1.0
    #: Mass of link 1, kg; above 0.
    LINK_MASS_1: float = 1.0
    #: Mass of link 2, kg; above 0.
    LINK_MASS_2: float = 1.0
    #: Distance of link 1's centre of mass from its joint, m; 0 or more.
    LINK_COM_POS_1: float = 0.5
    #: Distance of link 2's centre of mass from its joint, m; 0 or more.
    LINK_COM_POS_2: float = 0.5
    #: Moment of inertia of each link about its centre of mass, kg m²; 0 or more.
    LINK_MOI: float = 1.0
    #: Bound of link 1's velocity after a step, rad/s; above 0.
    MAX_VEL_1: float = 4 * math.pi
    #: Bound of link 2's velocity, relative to link 1, after a step, rad/s; above 0.
    MAX_VEL_2: float = 9 * math.pi
    #: Torques of the actions 0, 1 and 2, N m. A single environment may have another number of actions.
    AVAIL_TORQUE: Sequence[float] = (-1.0, 0.0, 1.0)
    #: Each step adds a uniform draw from [-torque_noise_max, torque_noise_max) to the torque, N m; 0 or more. 0 draws nothing.
    torque_noise_max: float = 0.0
    #: The equations of motion: those of Sutton and Barto's book, or those printed in the 1996 paper.
    book_or_nips: Literal["book", "nips"] = "book"

    #: The width and the height of pictures, in pixels. It cannot be changed.
    SCREEN_DIM = 500

    metadata: dict[str, Any]
    spec: Any
    render_mode: str | None
    _native: Acrobot | Batch
    #: Whether actions are torques.
    _CONTINUOUS = False

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        for name, value in list(vars(cls).items()):
            if name in _NAMES:
                (Batch() if isinstance(value, Uniform) else Acrobot()).set(name, value)
                setattr(cls, name, _fixed(name, value))
        # Also what a class inherits from one without parameters.
        for base in cls.__mro__:
            for name, value in vars(base).items() if base is cls or not issubclass(base, Parameters) else ():
                if name in _IGNORED or not callable(value):
                    _reject_ignored(cls, name)

    def __init__(self, native: Acrobot | Batch, render_mode: str | None) -> None:
        """Pass the class's parameters, which a subclass may have changed, to the native part."""
        modes = self.metadata["render_modes"]
        # A comparison with an array is no bool.
        if render_mode is not None and not (isinstance(render_mode, str) and render_mode in modes):
            raise ValueError(f"render_mode must be None or one of {modes}, got {render_mode!r}")
        self._native = native
        self.render_mode = render_mode
        # LINK_MOI, which may be 0 with some centres of mass only, comes after them.
        for name in _NAMES:
            setattr(self, name, getattr(self, name))

    def _pass(self, name: str, value: Any) -> Any:
        """Pass a parameter to the native part, which checks it. Return it as an object that cannot change."""
        self._native.set(name, value)
        return _fixed(name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        """Check a parameter and set it."""
        if name in _NAMES:
            value = self._pass(name, value)
        else:
            _reject_ignored(type(self), name)
        super().__setattr__(name, value)

    def __delattr__(self, name: str) -> None:
        """Set a parameter back to the value of its class."""
        if name in _NAMES:
            setattr(self, name, getattr(type(self), name))
        else:
            super().__delattr__(name)

    def __copy__(self) -> Parameters:
        """As ``copy.deepcopy``: two objects with the same states would be no copies."""
        return copy.deepcopy(self)

    def _warn_of_no_render_mode(self) -> None:
        logger.warn(
            "render returns None, because the environment was made without a render mode. Make it with one: "
            f'gymnasium.make("{self.spec.id if self.spec else "acrobot_rs/Acrobot-v1"}", render_mode="rgb_array")'
        )

    @property
    def _highest_velocities(self) -> list[float]:
        """The largest velocities after a step, or after a reset with the default bounds of 0.1, rad/s."""
        return [max(getattr(bound, "high", bound), 0.1) for bound in (self.MAX_VEL_1, self.MAX_VEL_2)]

    @property
    def _action_space(self) -> spaces.Space[Any]:
        """That of a single environment."""
        lows, highs = (getattr(self.AVAIL_TORQUE, bound, self.AVAIL_TORQUE) for bound in ("low", "high"))
        if self._CONTINUOUS:
            return spaces.Box(min(lows), max(highs), (1,), np.float32)
        return spaces.Discrete(len(lows))

    @property
    def _observation_space(self) -> spaces.Box[np.float32]:
        high = np.array([1.0, 1.0, 1.0, 1.0, *self._highest_velocities], dtype=np.float32)
        return spaces.Box(-high, high, dtype=np.float32)


_NAMES = tuple(name for name in Parameters.__annotations__ if hasattr(Parameters, name))


def reset_bounds(options: dict[str, Any] | None, others: Iterable[str] = ("reset_mask",)) -> tuple[float, float]:
    """The bounds of initial states, rad and rad/s: ``options["low"]`` and ``options["high"]``, or -0.1 and 0.1.

    Raises:
        ValueError: If a bound is not a finite number in the range of float32, if low is above high, or if the options have
            another key, except ``others``.
    """
    keys = ["low", "high", *others]
    for key in options or ():
        if key not in keys:
            raise ValueError(f"the keys of options must be among {keys}, got {key!r}")
    low, high = maybe_parse_reset_bounds(options, -0.1, 0.1)
    largest = np.finfo(np.float32).max
    if not (abs(low) <= largest and abs(high) <= largest):
        raise ValueError(f"low and high must be finite numbers in the range of float32, got {low} and {high}")
    return low, high


def numbers(
    name: str, rule: str, value: Any, shape: tuple[int, ...], kinds: str = "fiu", error: type[Exception] = ValueError
) -> NDArray[Any]:
    """Actions or states as an array.

    They may be an array, or a list or another sequence that NumPy converts to one, of this shape, and of integers (``iu``) or
    floats (``f``). Texts, bytes, bools, complex numbers, other objects, sets, mappings and iterators are rejected.
    """
    array = None
    # NumPy takes the bytes of a bytearray, and the keys of some mappings.
    if not isinstance(value, bytearray | Mapping):
        try:
            array = np.asarray(value)
        except (TypeError, ValueError):  # rows of different lengths
            pass
    if array is not None and array.dtype.kind in kinds and array.shape == shape:
        return array
    is_numeric = array is not None and array.dtype.kind in "biufc"
    found = f"{array.dtype} of shape {array.shape}" if is_numeric else reprlib.repr(value)
    raise error(f"{name} must be {rule}, got {found}")
