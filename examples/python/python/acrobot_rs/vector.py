"""Many environments in one step."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces
from gymnasium.error import InvalidAction
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import arrays
from acrobot_rs.arrays import numbers, read_only, require
from acrobot_rs.native_vector import Floats, NativeVectorEnv
from acrobot_rs.parameters import Drawn, Parameters, _fixed, _hint

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from acrobot_rs.parameters import Arguments, Each, EachEquations, EachTorques


class AcrobotVectorEnv(Parameters, NativeVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]):
    """Many ``Acrobot-v1`` environments, thousands of times as fast as ``SyncVectorEnv``.

    They are computed in ``float32``, or with ``float64=True`` in ``float64``, bit-identically on
    every machine. Each step differs from Gymnasium's by rounding only, but whole episodes drift
    apart, because an Acrobot is chaotic.

    Environment ``i`` draws from the ``i``-th child of the seed, ``numpy.random.SeedSequence(seed).spawn(num_envs)[i]``.
    So more environments do not change the first ones, and two seeds share no stream. ``SyncVectorEnv`` seeds environment
    ``i`` with ``seed + i``.

    A parameter has one value for all environments, a list or an array with one for each, or an :class:`acrobot_rs.Uniform`,
    :class:`acrobot_rs.LogUniform` or :class:`acrobot_rs.Normal`, from which each reset draws. Reading it gives what was set,
    different values as an array, and :meth:`get_parameter` what each environment has. ``book_or_nips`` cannot be drawn.

    >>> import gymnasium as gym
    >>> import acrobot_rs
    >>> envs = gym.make_vec("acrobot_rs/Acrobot-v1", num_envs=1024, autoreset_mode="SameStep")
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
        max_episode_steps: int | None = 500,
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
            num_envs: The number of environments, at least 1.
            max_episode_steps: The steps after which an episode is truncated, at least 1. With
                ``None`` there is no limit below 2**32 - 1.
            render_mode: ``None``, ``"rgb_array"`` or ``"ansi"``.
            autoreset_mode: ``NextStep``: the step after an episode's end resets, ignores its action and returns a reward of 0.
                ``SameStep``: the step that ends an episode also resets, and ``infos["final_obs"]`` has the episode's last
                observation. ``Disabled``: a ``reset`` of all, or one with a ``"reset_mask"``, must reset an environment whose
                episode has ended before the next step.
            copy: Whether each call returns observations in a new array. Otherwise all calls return the same array.
            gymnasium_episodes: Whether to play the episodes of Gymnasium's ``Acrobot-v1`` in ``SyncVectorEnv``: computed in
                ``float64``, environment ``i`` seeded with ``seed + i``, and rewards as ``float64``. All results are
                bit-identical where those of :class:`acrobot_rs.AcrobotEnv` are. Steps take longer.
            threads: The threads that compute a step; ``None``: as many as the process has cores. They change no bit. More
                than one is faster only for more than 16,384 environments, or 1,024 in ``float64``.
            info_parameters: Parameters that ``infos`` have, as arrays from :meth:`get_parameter`.
            float64: Whether to compute in ``float64``, with correctly rounded sines. Steps take
                longer.
            **parameters: Parameters, for example ``LINK_MASS_1=2.0``.

        Raises:
            TypeError: If a parameter is unknown or of a wrong type.
            ValueError: If a number is out of its range, if a mode or a name in ``info_parameters``
                is unknown, or if both ``gymnasium_episodes`` and ``float64`` are set.
            MemoryError: If the environments do not fit into memory.
        """
        require(Iterable, "a sequence of names of parameters", info_parameters=info_parameters)
        for name in (each for each in info_parameters if each not in self._NAMES):
            hint = _hint(str(name), self._NAMES)
            raise ValueError(f"info_parameters must be names of parameters, got {name!r}; {hint}")
        self.info_parameters = tuple(info_parameters)
        require(bool, "True or False", gymnasium_episodes=gymnasium_episodes, float64=float64)
        engine = f"{self._TASK}_float64" if float64 else self._TASK
        if gymnasium_episodes:
            if float64:
                rule = "must be False with gymnasium_episodes, which computes in float64"
                raise ValueError(f"float64 {rule}, got True")
            arrays.warn_of_other_sines()
            engine = "gymnasium"
        native = self._make(
            num_envs, max_episode_steps, autoreset_mode, copy, engine, self._CONTINUOUS, threads
        )
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
            each = arrays.values_of_each(name, value)
            if each is None:
                self._native.set(name, value)
                return _fixed(name, value)
            self._native.set_each(name, each)
        values = np.array([_fixed(name, one) for one in each])
        # By their bits: -0.0 is another value than 0.0.
        if values.tobytes() != np.full_like(values, values[0]).tobytes():
            return read_only(values)
        return _fixed(name, each[0])

    def _inputs(self, actions: ArrayLike) -> NDArray[Any]:
        """The actions, checked and converted to an array that the native part reads. It calls this where necessary."""
        what, kinds, dtype = ("numbers", "fiu", np.float32) if self._CONTINUOUS else ("integers", "iu", np.int64)
        shape = self.action_space.shape
        actions = numbers("actions", f"{what} of shape {shape}", actions, shape, kinds, InvalidAction)
        if actions.dtype.kind == "u" and (actions > 2).any():  # which int64 may not have
            index = int(np.argmax(actions > 2))
            raise InvalidAction(f"actions[{index}] must be 0, 1 or 2, got {actions[index]}")
        with np.errstate(over="ignore"):  # an infinite torque acts as the bound
            # An array over packed bytes is not aligned, which Rust requires.
            return np.ascontiguousarray(actions if actions.flags.aligned else actions.copy(), dtype)


class AcrobotContinuousVectorEnv(AcrobotVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]):
    """As :class:`AcrobotVectorEnv`, but the actions are torques: ``float32`` of shape ``(num_envs, 1)``, in N m.

    A torque beyond the bounds of the action space, which are the smallest and the largest of ``AVAIL_TORQUE``, acts as the
    nearest bound.

    >>> import acrobot_rs.vector
    >>> envs = acrobot_rs.vector.AcrobotContinuousVectorEnv(num_envs=1024)
    >>> envs.action_space.shape
    (1024, 1)
    """

    _CONTINUOUS = True
