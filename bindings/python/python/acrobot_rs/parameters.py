"""What the single and the vector environment share: parameters, their draws, and the spaces."""

from __future__ import annotations

import copy
import dataclasses
import difflib
import functools
import inspect
import math
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar

import numpy as np
from gymnasium import logger, spaces
from numpy.typing import NDArray

from acrobot_rs import arrays
from acrobot_rs._native import BOUND, Acrobot, Batch
from acrobot_rs.arrays import LARGEST, must_be, numbers

_EQUATIONS = (
    "the equations are in Rust: change parameters, or use gymnasium.envs.classic_control.AcrobotEnv"
)
#: What Gymnasium's environment calls or reads, but ours does not, and what to do instead.
_IGNORED = dict.fromkeys(("_dsdt", "rk4", "wrap", "bound"), _EQUATIONS) | {
    "_get_ob": "change observations with a wrapper",
    "_terminal": "change the end of episodes with a wrapper",
    "SCREEN_DIM": "pictures have 500 x 500 pixels: resize what render returns",
}


class Drawn:
    """A parameter that each reset draws between two bounds, in each environment that it resets."""

    low: Any
    high: Any
    #: The name of the class, which the JSON of a ``gymnasium.envs.registration.EnvSpec`` needs.
    kind: str

    def __post_init__(self) -> None:
        """Check the types, and keep the numbers as Python's. What draws them checks the numbers."""
        for name, value in list(vars(self).items()):
            if name == "kind":
                continue
            is_row = self.kind == "Uniform" and (
                isinstance(value, list | tuple) or np.ndim(value) > 0
            )
            rule = "three numbers" if is_row else "a number"
            array = numbers(name, rule, value, (3,) if is_row else (), error=TypeError)
            object.__setattr__(self, name, tuple(map(float, array)) if is_row else float(array))
        if np.shape(self.low) != np.shape(self.high):
            raise must_be("low", "of the same length as high", self)


@dataclasses.dataclass(frozen=True)
class Uniform(Drawn):
    """A parameter that each reset draws uniformly.

    The bounds of ``AVAIL_TORQUE`` are three numbers each.

    >>> import acrobot_rs
    >>> envs = acrobot_rs.AcrobotVectorEnv(1024, LINK_MASS_1=acrobot_rs.Uniform(0.8, 1.2))
    """

    low: Any
    high: Any
    kind: str = dataclasses.field(default="Uniform", init=False, repr=False)


@dataclasses.dataclass(frozen=True)
class LogUniform(Drawn):
    """A parameter whose logarithm each reset draws uniformly. ``low`` is above 0."""

    low: float
    high: float
    kind: str = dataclasses.field(default="LogUniform", init=False, repr=False)


@dataclasses.dataclass(frozen=True)
class Normal(Drawn):
    """A parameter that each reset draws from a normal distribution, truncated at the bounds.

    ``mean`` and ``std`` are those before the truncation. ``mean`` is between the bounds.
    """

    mean: float
    std: float
    low: float
    high: float
    kind: str = dataclasses.field(default="Normal", init=False, repr=False)


def _from_json(value: Any) -> Any:
    """A draw, if the value is what the JSON of a spec has for it."""
    for kind in (Uniform, LogUniform, Normal) if isinstance(value, dict) else ():
        names = {field.name for field in dataclasses.fields(kind)}
        if value.keys() == names and arrays.is_one_of(value["kind"], (kind.__name__,)):
            return kind(**{name: value[name] for name in names - {"kind"}})
    return value


def _fixed(name: str, value: Any) -> Any:
    """A valid value, as an object that cannot change: a change of an array would have no effect."""
    if name == "book_or_nips" or isinstance(value, Drawn):
        return value
    return tuple(map(float, value)) if name == "AVAIL_TORQUE" else float(value)


def _reject_ignored(cls: type[Parameters], name: str) -> None:
    if name in _IGNORED:
        raise TypeError(f"{name} would have no effect on {cls.__name__}; {_IGNORED[name]}")
    is_known = name in cls._NAMES or name.startswith("_")
    if not is_known and _near(name, cls._NAMES, 0.8):
        raise _unknown(cls, name)


@functools.cache
def _near(name: str, names: tuple[str, ...], cutoff: float) -> str | None:
    """The name that this one resembles."""
    lower = {each.lower(): each for each in names}
    close = difflib.get_close_matches(name.lower(), lower, n=1, cutoff=cutoff)
    return lower[close[0]] if close else None


def _hint(name: str, names: tuple[str, ...]) -> str:
    """What an unknown name may mean: one of these names."""
    bound = re.search("(?i)torque_?(max|limit)|(max|limit)_?torque", name)
    meant = "AVAIL_TORQUE" if bound else _near(name, names, 0.5)
    return f"did you mean {meant}?" if meant else f"it has {', '.join(names)}"


def _unknown(cls: type[Parameters], name: str) -> AttributeError:
    return AttributeError(f"{cls.__name__} has no parameter {name}; {_hint(name, cls._NAMES)}")


#: What parameters can be: of a single environment, besides floats, and of many.
Torques = Sequence[float] | NDArray[Any]
Equations = Literal["book", "nips"]
Each = float | Sequence[float] | NDArray[Any] | Drawn
EachTorques = Torques | Sequence[Sequence[float]] | Drawn
EachEquations = Equations | Sequence[str] | NDArray[Any]

if TYPE_CHECKING:
    from typing_extensions import TypedDict

    _Number = TypeVar("_Number")
    _Torques = TypeVar("_Torques")
    _Equations = TypeVar("_Equations")

    class Arguments(TypedDict, Generic[_Number, _Torques, _Equations], total=False):
        """Parameters as arguments."""

        dt: _Number
        LINK_LENGTH_1: _Number
        LINK_LENGTH_2: _Number
        LINK_MASS_1: _Number
        LINK_MASS_2: _Number
        LINK_COM_POS_1: _Number
        LINK_COM_POS_2: _Number
        LINK_MOI: _Number
        gravity: _Number
        MAX_VEL_1: _Number
        MAX_VEL_2: _Number
        AVAIL_TORQUE: _Torques
        torque_noise_max: _Number
        book_or_nips: _Equations

    class SwingupArguments(Arguments[_Number, _Torques, _Equations], total=False):
        """Those of the swing-up."""

        LINK_MOI_1: _Number
        LINK_MOI_2: _Number
        FRICTION_1: _Number
        FRICTION_2: _Number


class Parameters(arrays.Hints):
    """The parameters of the physics, with Gymnasium's names.

    Set them as arguments, on an environment or in a subclass, whose parameters a new environment
    copies. A value is checked immediately and acts from the next step. The spaces follow.
    """

    dt: Each = 0.2  #: duration of a step, s; above 0
    LINK_LENGTH_1: Each = 1.0  #: m; above 0
    LINK_LENGTH_2: Each = 1.0  #: m; above 0; changes pictures only
    LINK_MASS_1: Each = 1.0  #: kg; above 0
    LINK_MASS_2: Each = 1.0  #: kg; above 0
    LINK_COM_POS_1: Each = 0.5  #: centre of mass from the joint, m; 0 or more
    LINK_COM_POS_2: Each = 0.5  #: centre of mass from the joint, m; 0 or more
    LINK_MOI: Each = 1.0  #: moment of inertia of each link about its centre, kg m²; 0 or more
    gravity: Each = 9.8  #: acceleration, downwards, m/s²; finite; Gymnasium's cannot change
    MAX_VEL_1: Each = 4 * math.pi  #: bound of link 1's velocity after a step, rad/s; above 0
    MAX_VEL_2: Each = 9 * math.pi  #: bound of link 2's, relative to link 1, rad/s; above 0
    #: Torques of the actions 0, 1 and 2, N m. A single environment may have more or fewer.
    AVAIL_TORQUE: EachTorques = (-1.0, 0.0, 1.0)
    #: Each step adds a uniform draw within ± this to the torque, N m; 0 or more. 0 draws nothing.
    torque_noise_max: Each = 0.0
    #: The equations of motion: of Sutton and Barto's book, or as printed in the 1996 paper.
    book_or_nips: EachEquations = "book"

    SCREEN_DIM = 500  #: width and height of pictures, pixels; cannot change

    metadata: dict[str, Any]
    spec: Any
    render_mode: str | None
    _native: Acrobot | Batch
    #: The names of the parameters.
    _NAMES: tuple[str, ...] = ()
    #: The task, by its name in Rust.
    _TASK = "acrobot"
    #: The default bound of initial states, rad and rad/s.
    _BOUND: float = BOUND
    #: Whether actions are numbers in a ``Box``, and what they are.
    _CONTINUOUS = False
    _ACTION = "a torque in N m"
    #: Whether the observation is the state itself, as in ``Acrobot-v0``.
    _ANGLES = False
    #: What cannot change after the construction, and whether it has ended.
    _CHOSEN = ()
    _made = False

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        for name, value in list(vars(cls).items()):
            if name in cls._NAMES:
                if isinstance(value, Drawn):
                    Batch(engine=cls._TASK).set_drawn(name, value)
                else:
                    Acrobot(task=cls._TASK).set(name, value)
                setattr(cls, name, _fixed(name, value))
        cls._check_names()

    @classmethod
    def _check_names(cls) -> None:
        """Reject attributes of this class and its bases that would have no effect."""
        for base in cls.__mro__:
            # A class with names defines the parameters.
            ours = base is arrays.Hints or "_NAMES" in vars(base)
            for name, value in vars(base).items() if not ours else ():
                if name in _IGNORED or not callable(value):
                    _reject_ignored(cls, name)

    def __init__(
        self, native: Acrobot | Batch, render_mode: str | None, parameters: Mapping[str, Any]
    ) -> None:
        """Pass these parameters, and those of the class, to the native part."""
        self._check_names()
        self._check_arguments(parameters)
        self._native = native
        self.render_mode = arrays.render_mode(render_mode, self.metadata)
        # LINK_MOI, which may be 0 with some centres of mass only, comes after them.
        for name in self._NAMES:
            setattr(self, name, _from_json(parameters.get(name, getattr(self, name))))
        for name, space in self._spaces().items():
            setattr(self, name, space)

    @property
    def parameters(self) -> dict[str, Any]:
        """All parameters by their names: arguments that make the same environment again."""
        return {name: getattr(self, name) for name in self._NAMES}

    def _check_arguments(self, parameters: Mapping[str, Any]) -> None:
        """Reject arguments that are no parameters."""
        for name in parameters.keys() - set(self._NAMES):
            arguments = inspect.signature(type(self)).parameters.values()
            others = tuple(each.name for each in arguments if each.kind is not each.VAR_KEYWORD)
            hint = _hint(name, (*others, *self._NAMES))
            # Other programs, such as torchrl, look for Python's words.
            words = f"{type(self).__name__}.__init__() got an unexpected keyword argument {name!r}"
            raise TypeError(f"{words}; {hint}")

    def _pass(self, name: str, value: Any) -> Any:
        """Pass a parameter to the native part, which checks it. Return it unchangeable."""
        if isinstance(value, Drawn):
            reason = "because only gymnasium.make_vec draws parameters, also with num_envs=1"
            raise must_be(name, f"a number, {reason}", repr(value), TypeError)
        self._native.set(name, value)
        return _fixed(name, value)

    def _spaces(self) -> dict[str, spaces.Space[Any]]:
        """All spaces, by the names of their attributes. Here those of a single environment."""
        low, high, *velocities = self._limits()
        actions: spaces.Space[Any]
        if self._CONTINUOUS:
            actions = spaces.Box(low, high, (1,), np.float32)
        else:
            torques = getattr(self.AVAIL_TORQUE, "low", self.AVAIL_TORQUE)
            actions = spaces.Discrete(np.shape(torques)[-1])
        others = [np.pi] * 2 if self._ANGLES else [1.0] * 4
        highest = np.array([*others, *velocities], dtype=np.float32)
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
        # After a step, or after a reset with the default bounds.
        first, second = (max(each, self._BOUND) for each in velocities)
        return max(np.min(lows), -LARGEST), min(np.max(highs), LARGEST), first, second

    if not TYPE_CHECKING:  # a checker would accept all names

        def __setattr__(self, name: str, value: Any) -> None:
            """Check a parameter and set it."""
            if name not in self._NAMES:
                self._check_name(name)
                super().__setattr__(name, value)
                return
            changes_spaces = self._made and name in ("AVAIL_TORQUE", "MAX_VEL_1", "MAX_VEL_2")
            before = self._spaces() if changes_spaces else {}
            super().__setattr__(name, self._pass(name, value))
            for space, new in self._spaces().items() if before else ():
                current = getattr(self, space)
                # Another space is a user's.
                if current == before[space] != new:
                    new.seed(int(current.np_random.integers(2**32)))
                    super().__setattr__(space, new)

    def _check_name(self, name: str) -> None:
        """Reject an attribute that would have no effect. A subclass may have others."""
        cls = type(self)
        if self._made and name in self._CHOSEN:
            raise AttributeError(f"{name} cannot change after {cls.__name__} was made")
        _reject_ignored(cls, name)
        is_ours = cls.__module__.startswith("acrobot_rs.") and self._made
        if is_ours and not (name.startswith("_") or name in vars(self) or hasattr(cls, name)):
            raise _unknown(cls, name)

    def __delattr__(self, name: str) -> None:
        """Set a parameter back to the value of its class."""
        if name in self._NAMES:
            setattr(self, name, getattr(type(self), name))
        else:
            super().__delattr__(name)

    def __copy__(self) -> Parameters:
        """As ``copy.deepcopy``: two objects with the same states would be no copies."""
        return copy.deepcopy(self)

    def _warn_of_no_render_mode(self) -> None:
        call = f'gymnasium.make("{self.spec.id}", ' if self.spec else f"{type(self).__name__}("
        logger.warn(
            "render returns None, because the environment was made without a render mode. Make it "
            f'with one: {call}render_mode="rgb_array")'
        )


_PUBLIC = (name for name in Parameters.__annotations__ if not name.startswith("_"))
Parameters._NAMES = tuple(name for name in _PUBLIC if hasattr(Parameters, name))
