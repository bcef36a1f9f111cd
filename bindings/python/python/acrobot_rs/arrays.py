"""Checks of what users pass: bounds, masks, arrays and seeds. Arrays and infos that they get."""

from __future__ import annotations

import copy
import functools
import math
import operator
import reprlib
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium.error import Error
from numpy.typing import NDArray

from acrobot_rs._native import check_bounds, first_beyond

Seed = int | list[int | None] | tuple[int | None, ...] | None

#: A Box, a reset and a policy have float32, which rounds other numbers with a warning.
LARGEST = float(np.finfo(np.float32).max)
#: The largest number of float64.
MAX = float(np.finfo(np.float64).max)


def must_be(name: str, rule: str, got: Any, error: type[Exception] = ValueError) -> Exception:
    """An error in the form of the crate's."""
    return error(f"{name} must be {rule}, got {got}")


def reset_bounds(options: Mapping[str, Any], bound: float) -> tuple[float, float]:
    """The bounds of initial states, rad and rad/s: the options, or ``-bound`` and ``bound``."""
    if not isinstance(options, Mapping):
        raise must_be("options", "a dict", reprlib.repr(options), TypeError)
    low, high = (
        float(numbers(name, "a number", options.get(name, default), ()))
        for name, default in (("low", -bound), ("high", bound))
    )
    check_bounds(low, high)
    return low, high


def reset_mask(options: Mapping[str, Any], num_envs: int) -> NDArray[np.bool_] | None:
    """The environments to reset: ``options["reset_mask"]``."""
    if "reset_mask" not in options:
        return None
    mask = np.asarray(options["reset_mask"])
    if mask.dtype != np.bool_ or mask.shape != (num_envs,) or not mask.any():
        rule = f"an array of bool of shape ({num_envs},) with a true element"
        raise must_be("reset_mask", rule, reprlib.repr(mask))
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

    They may be what NumPy converts to an array of this shape, if it is not ``None``, and of
    integers (``iu``) or floats (``f``).
    """
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        array = np.empty(0, object)
    if array.dtype.kind not in kinds or shape not in (None, array.shape):
        raise must_be(name, rule, reprlib.repr(value), error)
    return array


def finite(name: str, rule: str, value: Any, shape: Any = (), largest: float = MAX) -> Any:
    """As :func:`numbers`, in ``float64``: each is finite, and at most the largest."""
    given = numbers(name, rule, value, shape)
    floats = given.astype(np.float64, copy=False)
    if (place := first_beyond(floats.ravel(), largest)) is not None:
        index = tuple(map(int, np.unravel_index(place, given.shape)))
        raise must_be(name, rule, f"{given[index]}{f' at {[*index]}' if index else ''}")
    return floats


def float32(name: str, rule: str, value: Any, shape: tuple[int, ...] = ()) -> Any:
    """As :func:`finite`, for what the native part has in ``float32``. A number or lists."""
    rule = f"{rule}, in the range of float32"
    given = finite(name, rule, value, shape, LARGEST)
    if shape == () and given != 0 and np.float32(given) == 0:
        raise must_be(name, rule, value)
    return given.tolist()


def integer(name: str, value: Any, low: int, high: float, error: Any = ValueError) -> int:
    """An integer of Python or of NumPy, but neither ``True`` nor ``False``."""
    try:
        number = None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = None
    if number is None or not low <= number <= high:
        rule = f"of at least {low}" if high == math.inf else f"from {low} to {high}"
        raise must_be(name, f"an integer {rule}", repr(value), error)
    return number


def states_of(value: Any, num_envs: int) -> NDArray[np.float64]:
    """A state of each environment, or the same for all. The native part checks the numbers."""
    rule = f"numbers of shape ({num_envs}, 4) or (4,)"
    states = numbers("state", rule, value, None)
    if states.shape not in ((num_envs, 4), (4,)):
        raise must_be("state", rule, reprlib.repr(value))
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(np.broadcast_to(states, (num_envs, 4)), np.float64)


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
        rule = f"one value, one for each of {num_envs} environments, or a draw such as Uniform"
        raise must_be(name, rule, f"{len(value)} values")
    return list(value)


def seeds_of(
    seed: Seed, num_envs: int, gymnasium_episodes: bool
) -> tuple[int | None, list[int | None] | None]:
    """The seed whose children seed all environments, or a seed for each."""
    if isinstance(seed, list | tuple):
        if len(seed) != num_envs:
            rule = f"one element for each of {num_envs} environments"
            raise ValueError(f"seed must have {rule}, got {len(seed)}")
        return None, [plain_seed(each) for each in seed]
    plain = plain_seed(seed)
    if plain is None or not gymnasium_episodes:
        return plain, None
    return None, [plain + i for i in range(num_envs)]


def plain_seed(seed: Any) -> int | None:
    """A seed, also one of NumPy's integers, as Python's ``int``, which Gymnasium requires."""
    return None if seed is None else integer("seed", seed, 0, math.inf, Error)


def independent(self: Any) -> Any:
    """A copy for ``copy.copy`` that shares no native state."""
    return copy.deepcopy(self)


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


def final_infos(finals: NDArray[np.float32], dones: NDArray[np.bool_]) -> dict[str, Any]:
    """Infos as in ``SyncVectorEnv``: last observations, ``None`` where no episode ended."""
    if not dones.any():
        return {}
    final_obs = np.full(len(dones), None, dtype=object)
    for index in np.flatnonzero(dones):
        final_obs[index] = finals[index].copy()
    masks = {"_final_obs": dones, "_final_info": dones.copy()}
    return {"final_obs": final_obs, "final_info": {}, **masks}
