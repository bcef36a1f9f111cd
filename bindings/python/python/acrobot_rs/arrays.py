"""Checks of what users pass: bounds, masks, arrays and seeds. Arrays and infos that they get."""

from __future__ import annotations

import contextlib
import difflib
import functools
import math
import reprlib
import warnings
from collections.abc import Iterable, Mapping, Sequence
from numbers import Integral
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from gymnasium.error import Error
from numpy.typing import NDArray

from acrobot_rs._native import check_bounds

Seed = int | list[int | None] | tuple[int | None, ...] | None

#: The options of ``reset``. Not all environments have all.
OPTIONS = ("low", "high", "reset_mask", "state")
#: A Box, a reset and a policy have float32, which rounds other numbers with a warning.
LARGEST = float(np.finfo(np.float32).max)


def must_be(name: str, rule: str, got: Any, error: type[Exception] = ValueError) -> Exception:
    """An error in the form of the crate's."""
    return error(f"{name} must be {rule}, got {got}")


def reset_bounds(
    options: dict[str, Any] | None, bound: float, known: tuple[str, ...]
) -> tuple[float, float]:
    """The bounds of initial states, rad and rad/s: the options, or ``-bound`` and ``bound``."""
    check_keys(options, known)
    bounds = {"low": -bound, "high": bound}
    given = {name: options[name] for name in bounds if name in options} if options else {}
    for name, value in given.items():
        bounds[name] = float(numbers(name, "a number", value, ()))
    check_bounds(**bounds)
    if options and given and "state" in options:
        raise ValueError(f"options must have either state or low and high, got {list(options)}")
    return bounds["low"], bounds["high"]


def check_keys(options: dict[str, Any] | None, known: tuple[str, ...]) -> None:
    """Reject misspelt options of ``reset``, and those that only other environments here have.

    Keys that resemble none of them belong to other programs.
    """
    require(Mapping | None, "a dict or None", options=options)
    for key in options or ():
        name = key.lower() if isinstance(key, str) else ""
        near = difflib.get_close_matches(name, OPTIONS, n=1, cutoff=0.52)
        if near and key not in known:
            meant = f"; did you mean {near[0]!r}?" if near[0] in known else ""
            raise must_be("the keys of options", f"among {list(known)}", f"{key!r}{meant}")


def is_one_of(value: Any, names: Iterable[str]) -> bool:
    """Whether a value of any type is one of these names.

    Some values have no hash, and a comparison with an array is no bool.
    """
    return isinstance(value, str) and value in names


def render_mode(mode: str | None, metadata: dict[str, Any]) -> str | None:
    """A render mode, if it is one of these environments."""
    modes = metadata["render_modes"]
    if mode is not None and not is_one_of(mode, modes):
        raise must_be("render_mode", f"None or one of {modes}", repr(mode))
    return mode


def reset_mask(options: dict[str, Any], num_envs: int) -> NDArray[np.bool_] | None:
    """The environments to reset: ``options["reset_mask"]``."""
    if "reset_mask" not in options:
        return None
    mask = np.asarray(options["reset_mask"])
    if mask.dtype != np.bool_:
        raise must_be("reset_mask", "an array of bool", repr(mask), TypeError)
    if mask.shape != (num_envs,):
        raise ValueError(f"reset_mask must have shape ({num_envs},), got shape {mask.shape}")
    if not mask.any():
        raise ValueError("reset_mask must have a true element, got none")
    return mask.view(np.uint8) != 0  # a NumPy bool can be any byte, but Rust's only 0 or 1


def numbers(
    name: str,
    rule: str,
    value: Any,
    shape: tuple[int, ...] | None,
    kinds: str = "fiu",
    error: type[Exception] = ValueError,
) -> NDArray[Any]:
    """Actions or states as an array.

    They may be an array, a list or another sequence that NumPy converts to one, of this shape, if
    it is not ``None``, and of integers (``iu``) or floats (``f``).
    """
    array = None
    # NumPy takes the bytes of a bytearray, and the keys of some mappings.
    if not isinstance(value, bytearray | Mapping):
        with contextlib.suppress(TypeError, ValueError):  # rows of different lengths
            array = np.asarray(value)
            # NumPy makes numbers of bools that are beside numbers. The test for an array comes
            # first because it takes no time.
            if array is not value and isinstance(value, Sequence) and array.dtype.kind != "b":
                types = set(map(type, np.asarray(value, object).flat))
                array = array if types.isdisjoint((bool, np.bool_)) else None
    if array is not None and array.dtype.kind in kinds and shape in (None, array.shape):
        return array
    is_numeric = array is not None and array.dtype.kind in "biufc"
    found = f"{array.dtype} of shape {array.shape}" if is_numeric else reprlib.repr(value)
    raise must_be(name, rule, found, error)


def states_of(value: Any, num_envs: int) -> NDArray[np.float64]:
    """States of all environments. The native part checks the numbers."""
    shape = (num_envs, 4)
    states = numbers("state", f"numbers of shape {shape}", value, shape)
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(states, np.float64)


def require(kind: Any, rule: str, **arguments: Any) -> None:
    """Reject arguments of another type. A bool is no integer here, and a text no sequence."""
    for name, value in arguments.items():
        is_other = isinstance(value, bool) and kind is not bool
        is_other |= isinstance(value, str) and kind is Iterable
        if is_other or not isinstance(value, kind):
            raise must_be(name, rule, repr(value), TypeError)


def values_of_each(name: str, value: Any, num_envs: int) -> list[Any] | None:
    """The values of a parameter, if there is one for each environment."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, list | tuple):
        return None
    if name == "AVAIL_TORQUE" and not any(
        isinstance(one, list | tuple | np.ndarray) for one in value
    ):
        return None
    if len(value) != num_envs:
        draws = name not in ("AVAIL_TORQUE", "book_or_nips")
        draw = ", or a draw such as acrobot_rs.Uniform(low, high)" * draws
        rule = f"one value, or one for each of {num_envs} environments{draw}"
        raise must_be(name, rule, f"{len(value)} values")
    return list(value)


def seeds_of(
    seed: Seed, num_envs: int, gymnasium_episodes: bool
) -> tuple[str | None, list[str | None] | None]:
    """The digits of the seed whose children seed all environments, or of a seed for each."""
    if isinstance(seed, list | tuple):
        if len(seed) != num_envs:
            rule = f"one element for each of {num_envs} environments"
            raise ValueError(f"seed must have {rule}, got {len(seed)}")
        return None, [_digits(each) for each in seed]
    plain = plain_seed(seed)
    if plain is None or not gymnasium_episodes:
        return _digits(plain), None
    return None, [_digits(plain + i) for i in range(num_envs)]


def plain_seed(seed: Any) -> int | None:
    """A seed, also one of NumPy's integers, as Python's ``int``, which Gymnasium requires."""
    if seed is None:
        return None
    # Gymnasium accepts True as 1.
    if not isinstance(seed, Integral) or isinstance(seed, bool) or seed < 0:
        raise must_be("seed", "an integer of at least 0", repr(seed), Error)
    return int(seed)


def _digits(seed: Any) -> str | None:
    """The digits of a seed. `str` rejects more than 4,300."""
    return None if seed is None else str(plain_seed(seed))


class Missing:
    """An attribute of Gymnasium's environments that ours do not have: the error says what to use.

    It is no ``__getattr__``, which slows all attributes.
    """

    def __init__(self, use: str) -> None:
        self._use = use

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, env: object, kind: type) -> NoReturn:
        raise AttributeError(f"{kind.__name__} has no attribute {self._name!r}; {self._use}")


class Hints:
    """What programs read of Gymnasium's environments."""

    if not TYPE_CHECKING:  # a checker says that they do not exist
        _dsdt = Missing("the equations are in Rust: assign state and call step")
        _get_ob = Missing("use the observations that reset and step return")
        _terminal = Missing("use terminated, which step returns")
        actions_num = Missing("use action_space")
        envs = Missing("use get_attr and set_attr, or rows of state")


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """An assignment to its elements, which would have no effect, raises."""
    array.flags.writeable = False
    return array


@functools.cache
def warn_of_other_sines() -> None:
    """Warn, once, if NumPy does not round sines as the C library does.

    Gymnasium's episodes contain NumPy's.
    """
    angles = np.random.default_rng(0).uniform(-2 * np.pi, 2 * np.pi, 10_000)
    pairs = zip(angles.tolist(), np.sin(angles).tolist(), np.cos(angles).tolist(), strict=True)
    count = sum(
        (sine, cosine) != (math.sin(angle), math.cos(angle)) for angle, sine, cosine in pairs
    )
    if count:
        warnings.warn(
            f"gymnasium_episodes: NumPy rounds the sine or cosine of {count:,} of 10,000 angles "
            "differently from the C library here, so episodes follow Gymnasium's but are not "
            "bit-identical",
            stacklevel=3,
        )


def final_infos(
    finals: NDArray[np.float32], ended: NDArray[np.bool_], last: dict[str, Any]
) -> dict[str, Any]:
    """Infos as in ``SyncVectorEnv``: last observations and infos, and which episodes ended.

    An observation is ``None`` where no episode ended.
    """
    if not ended.any():
        return {}
    final_obs = np.full(len(ended), None, dtype=object)
    for index in np.flatnonzero(ended):
        final_obs[index] = finals[index].copy()
    infos = {name: ended.copy() if name[0] == "_" else value for name, value in last.items()}
    masks = {"_final_obs": ended, "_final_info": ended.copy()}
    return {"final_obs": final_obs, "final_info": infos, **masks}
