"""Many environments in one step."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from numbers import Integral
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces
from gymnasium.error import InvalidAction
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import arrays
from acrobot_rs._native import MAX_STEPS, Batch
from acrobot_rs.arrays import is_one_of, must_be, numbers, read_only, require
from acrobot_rs.native_vector import Alone, Floats, NativeVectorEnv
from acrobot_rs.parameters import Drawn, Parameters, _fixed, _hint

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from acrobot_rs.parameters import Arguments, Each, EachEquations, EachTorques


class AcrobotVectorEnv(Parameters, NativeVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]):
    """Many ``Acrobot-v1`` environments, thousands of times as fast as ``SyncVectorEnv``.

    They are computed in ``float32``, or with ``float64=True`` in ``float64``, bit-identically on
    every machine. Each step differs from Gymnasium's by rounding only, but whole episodes drift
    apart, because an acrobot is chaotic.

    Environment ``i`` draws from the ``i``-th child of the seed,
    ``numpy.random.SeedSequence(seed).spawn(num_envs)[i]``.

    A parameter has one value for all environments, a list or an array with one for each, or an
    :class:`acrobot_rs.Uniform`, :class:`acrobot_rs.LogUniform` or :class:`acrobot_rs.Normal`, from
    which each reset draws. Reading it gives what was set, and :meth:`get_parameter` what each
    environment has.

    >>> import acrobot_rs
    >>> envs = acrobot_rs.AcrobotVectorEnv(num_envs=1024, autoreset_mode="SameStep")
    >>> envs.reset(seed=42)[0].shape
    (1024, 6)
    """

    metadata: dict[str, Any] = {
        "render_modes": ["rgb_array", "ansi"],
        "render_fps": 15,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    _CHOSEN = ("autoreset_mode", "copy", "info_parameters", "max_episode_steps", "num_envs")

    def __init__(
        self,
        num_envs: int = 1,
        max_episode_steps: int | None = MAX_STEPS,
        render_mode: str | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        gymnasium_episodes: bool = False,
        threads: int | None = 1,
        info_parameters: Sequence[str] = (),
        float64: bool = False,
        **parameters: Unpack[Arguments[Each, EachTorques, EachEquations]],
    ) -> None:
        """Make environments. Reset them before their first step.

        Args:
            num_envs: The number of environments.
            max_episode_steps: The steps after which an episode is truncated. ``None``: no limit.
            render_mode: ``None``, ``"rgb_array"`` or ``"ansi"``.
            autoreset_mode: ``NextStep``: the step after an episode's end resets, ignores its action
                and returns a reward of 0. ``SameStep``: the step that ends an episode also resets.
                ``Disabled``: an ended environment must be reset before the next step.
            copy: Whether each call returns observations in a new array, not in the same one.
            gymnasium_episodes: Whether to play the episodes of Gymnasium's ``Acrobot-v1`` in
                ``SyncVectorEnv``, bit-identical where those of :class:`acrobot_rs.AcrobotEnv` are.
            threads: The threads that compute a step; ``None``: as many as the process has cores.
                They help above 16,384 environments, or 1,024 in ``float64``.
            info_parameters: Parameters that ``infos`` have, as arrays from :meth:`get_parameter`.
            float64: Whether to compute in ``float64``, with correctly rounded sines. Steps take
                longer.
            **parameters: Parameters, for example ``LINK_MASS_1=2.0``.

        Raises:
            TypeError, ValueError: If an argument is invalid.
            MemoryError: If the environments do not fit into memory.
        """
        require(Iterable, "a sequence of names of parameters", info_parameters=info_parameters)
        info_parameters = tuple(info_parameters)
        for name in (each for each in info_parameters if not is_one_of(each, self._NAMES)):
            hint = _hint(str(name), self._NAMES)
            raise must_be("info_parameters", "names of parameters", f"{name!r}; {hint}")
        modes = [mode.value for mode in AutoresetMode]
        if not (isinstance(autoreset_mode, AutoresetMode) or is_one_of(autoreset_mode, modes)):
            raise must_be("autoreset_mode", f"one of {modes}", repr(autoreset_mode))
        flags = {"copy": copy, "gymnasium_episodes": gymnasium_episodes, "float64": float64}
        require(bool, "True or False", **flags)
        if threads is None:
            has_affinity = hasattr(os, "sched_getaffinity")
            threads = len(os.sched_getaffinity(0)) if has_affinity else os.cpu_count() or 1
        limit = 2**32 - 1 if max_episode_steps is None else max_episode_steps
        counts = {"num_envs": num_envs, "max_episode_steps": limit, "threads": threads}
        require(Integral, "an integer", **counts)
        for name, count in counts.items():
            if not 0 < count < 2**32:
                no_limit = ", or None for no limit" if name == "max_episode_steps" else ""
                raise must_be(name, f"an integer from 1 to {2**32 - 1}{no_limit}", count)
        if gymnasium_episodes:
            if float64:
                rule = "False with gymnasium_episodes, which computes in float64"
                raise must_be("float64", rule, True)
            arrays.warn_of_other_sines()
        mode = AutoresetMode(autoreset_mode)
        own = f"{self._TASK}_float64" if float64 else self._TASK
        engine = "gymnasium" if gymnasium_episodes else own
        native = Batch(
            *(num_envs, str(self.np_random_seed), limit, mode.value, engine),
            *(self._CONTINUOUS, threads),
        )
        self._alone = Alone()
        self.autoreset_mode = mode
        self.metadata = {**self.metadata, "autoreset_mode": mode}
        self.num_envs = num_envs
        self.max_episode_steps = max_episode_steps
        self.copy = copy
        self.info_parameters = info_parameters
        #: The array that all calls return, or ``None`` if each returns a new one.
        self._observations = None if copy else self._empty()
        self._same_step = mode is AutoresetMode.SAME_STEP
        self._disabled = mode is AutoresetMode.DISABLED
        super().__init__(native, render_mode, parameters)
        self._gymnasium_episodes = gymnasium_episodes
        self._float64 = gymnasium_episodes or float64
        self._made = True

    def _spaces(self) -> dict[str, spaces.Space[Any]]:
        single = super()._spaces()
        batched = {name: batch_space(space, self.num_envs) for name, space in single.items()}
        return {f"single_{name}": space for name, space in single.items()} | batched

    def _pass(self, name: str, value: Any) -> Any:
        with self._alone:
            if isinstance(value, Drawn):
                self._native.set_drawn(name, value)
                return value
            each = arrays.values_of_each(name, value, self.num_envs)
            self._native.set(name, [value] if each is None else each)
        if each is None:
            return _fixed(name, value)
        values = np.array([_fixed(name, one) for one in each])
        # By their bits: -0.0 is another value than 0.0.
        if values.tobytes() != np.full_like(values, values[0]).tobytes():
            return read_only(values)
        return _fixed(name, each[0])

    def _inputs(self, actions: ArrayLike) -> NDArray[Any]:
        """The actions as an array that the native part reads. It calls this where necessary."""
        what, kinds, dtype = (
            ("numbers", "fiu", np.float32) if self._CONTINUOUS else ("integers", "iu", np.int64)
        )
        shape = self.action_space.shape
        actions = numbers(
            "actions", f"{what} of shape {shape}", actions, shape, kinds, InvalidAction
        )
        if actions.dtype.kind == "u" and (actions > 2).any():  # which int64 may not have
            index = int(np.argmax(actions > 2))
            raise must_be(f"actions[{index}]", "0, 1 or 2", actions[index], InvalidAction)
        with np.errstate(over="ignore"):  # an infinite torque acts as the bound
            # An array over packed bytes is not aligned, which Rust requires.
            return np.ascontiguousarray(actions if actions.flags.aligned else actions.copy(), dtype)


class AcrobotContinuousVectorEnv(AcrobotVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]):
    """:class:`AcrobotVectorEnv` with the actions of :class:`acrobot_rs.AcrobotContinuousEnv`.

    They have the shape ``(num_envs, 1)``.
    """

    _CONTINUOUS = True
