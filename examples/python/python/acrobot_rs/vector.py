"""Many environments in one step."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from numbers import Integral
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.error import ClosedEnvironmentError, InvalidAction, ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import arrays
from acrobot_rs._native import Batch
from acrobot_rs.arrays import Seed, numbers, read_only, require
from acrobot_rs.parameters import Drawn, Parameters, _fixed, _hint

Floats = NDArray[np.float32]
Bools = NDArray[np.bool_]

#: What ``get_attr`` and ``call`` know beside the parameters. ``set_attr`` knows these and ``state``.
_ATTRIBUTES = (
    *("action_space", "elapsed_steps", "max_episode_steps", "metadata", "observation_space"),
    *("render", "render_mode", "spec", "state"),
)


class NativeVectorEnv(VectorEnv[Floats, NDArray[Any], np.ndarray]):
    """What the vector environments of both tasks share."""

    _native: Batch
    #: Whether states and rewards are ``float64``.
    _gymnasium_episodes = False
    #: Whether it was reset and not closed.
    _ready = False
    #: Without autoreset: the environments that must be reset before the next step.
    _ended: Bools | None
    #: The array that all calls return, or ``None`` if each returns a new one.
    _observations: Floats | None = None

    def _make(
        self, num_envs: int, max_episode_steps: int, autoreset_mode: Any, engine: str, continuous: bool, threads: int | None
    ) -> Batch:
        """The native part. Checks its arguments and keeps them."""
        modes = [mode.value for mode in AutoresetMode]
        if not isinstance(autoreset_mode, AutoresetMode) and autoreset_mode not in modes:
            raise ValueError(f"autoreset_mode must be one of {modes}, got {autoreset_mode!r}")
        if threads is None:
            threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        counts = {"num_envs": num_envs, "max_episode_steps": max_episode_steps, "threads": threads}
        require(Integral, "an integer", **counts)
        for name, count in counts.items():
            if not 0 < count < 2**32:
                raise ValueError(f"{name} must be an integer from 1 to {2**32 - 1}, got {count}")
        mode = AutoresetMode(autoreset_mode)
        native = Batch(num_envs, str(self.np_random_seed), max_episode_steps, mode.value, engine, continuous, threads)
        self.autoreset_mode = mode
        self.metadata = {**self.metadata, "autoreset_mode": mode}
        self.num_envs = num_envs
        self._same_step = mode is AutoresetMode.SAME_STEP
        self._ended = np.zeros(num_envs, np.bool_) if mode is AutoresetMode.DISABLED else None
        return native

    def _reset(self, seed: Seed, options: dict[str, Any] | None, low: float, high: float) -> Floats:
        """Seed and reset the environments that the options select, within these bounds, and observe all."""
        self._check_open()
        mask = arrays.reset_mask(options, self.num_envs)
        child_of, seeds = arrays.seeds_of(seed, self.num_envs, self._gymnasium_episodes)
        if seeds is not None:
            every = np.ones(self.num_envs, np.bool_) if mask is None else mask
            self._native.seed([each if some else None for each, some in zip(seeds, every, strict=True)])
        self._native.reset(child_of, low, high, mask)
        if not isinstance(seed, list | tuple):
            super().reset(seed=arrays.plain_seed(seed))
        if mask is not None and options is not None:
            del options["reset_mask"]
        if self._ended is not None:
            self._ended[slice(None) if mask is None else mask] = False
        self._ready = True
        observations = self._empty() if self._observations is None else self._observations
        self._native.observe(observations)
        return observations

    def _step(self, inputs: ArrayLike) -> tuple[Floats, Floats, Bools, Bools, Floats | None]:
        """Step: observations, rewards, terminated, truncated, and in mode ``SameStep`` the episodes' last observations."""
        self._check_ready()
        observations = self._empty() if self._observations is None else self._observations
        finals = self._empty() if self._same_step else None
        rewards, terminated, truncated = self._native.step(self, inputs, observations, finals)
        if self._ended is not None:
            np.logical_or(terminated, truncated, out=self._ended)
        return observations, rewards, terminated, truncated, finals

    @property
    def state(self) -> NDArray[np.floating[Any]]:
        """theta1, theta2 (rad) and their velocities (rad/s) of each environment, of shape ``(num_envs, 4)``: a read-only copy.

        To set the states, assign an array of this shape. To set some, change rows of ``state.copy()`` and assign it. Episodes
        and numbers of steps continue. In mode ``NextStep`` the next step resets the ended episodes all the same.

        Raises:
            ValueError: If the shape is another one, or if a number is not finite. No state changes then.
        """
        states = np.empty((self.num_envs, 4), np.float64)
        self._native.states(states)
        return read_only(states if self._gymnasium_episodes else states.astype(np.float32))

    @state.setter
    def state(self, states: ArrayLike) -> None:
        dtype = np.float64 if self._gymnasium_episodes else np.float32
        self._native.set_states(arrays.finite_states(states, self.num_envs, dtype))

    @property
    def elapsed_steps(self) -> NDArray[np.int64]:
        """The number of steps of each environment's episode, of shape ``(num_envs,)``."""
        elapsed = np.empty(self.num_envs, np.int64)
        self._native.elapsed(elapsed)
        return read_only(elapsed)

    def close_extras(self, **kwargs: Any) -> None:
        """Called by ``close``. Later calls raise ``ClosedEnvironmentError``."""
        self._ready = False

    def _check_open(self) -> None:
        if self.closed:
            raise ClosedEnvironmentError("the environments were closed; make new ones")

    def _check_ready(self) -> None:
        if not self._ready:
            self._check_open()
            raise ResetNeeded("the environments have no states yet; call reset before step")
        if self._ended is not None and self._ended.any():
            raise ResetNeeded(
                f"the episode of environment {np.flatnonzero(self._ended)[0]} has ended; "
                'reset it before the next step, with options={"reset_mask": terminated | truncated}'
            )

    def _empty(self) -> Floats:
        return np.empty((self.num_envs, 6), np.float32)


class AcrobotVectorEnv(Parameters, NativeVectorEnv):
    """Many ``Acrobot-v1`` environments, thousands of times as fast as ``SyncVectorEnv``.

    They are computed in ``float32``, bit-identically on every machine. Each step is as close to Gymnasium's as ``float32``
    is, but whole episodes drift apart, because an Acrobot is chaotic.

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
        max_episode_steps: int = 500,
        render_mode: str | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        gymnasium_episodes: bool = False,
        threads: int | None = 1,
        info_parameters: Sequence[str] = (),
        **parameters: Any,
    ) -> None:
        """Make environments. Reset them before their first step.

        Args:
            num_envs: The number of environments, at least 1.
            max_episode_steps: The steps after which an episode is truncated, at least 1.
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
                than one is faster only for more than 16,384 environments, or 1,024 with ``gymnasium_episodes``.
            info_parameters: Parameters that ``infos`` have, as arrays from :meth:`get_parameter`.
            **parameters: Parameters, for example ``LINK_MASS_1=2.0``.

        Raises:
            TypeError: If a parameter is unknown or of a wrong type.
            ValueError: If a number is out of its range, or if a mode or a name in ``info_parameters`` is unknown.
            MemoryError: If the environments do not fit into memory.
        """
        require(Iterable, "a sequence of names of parameters", info_parameters=info_parameters)
        for name in (each for each in info_parameters if each not in self._NAMES):
            hint = _hint(str(name), self._NAMES)
            raise ValueError(f"info_parameters must be names of parameters, got {name!r}; {hint}")
        self.info_parameters = tuple(info_parameters)
        require(bool, "True or False", copy=copy, gymnasium_episodes=gymnasium_episodes)
        if gymnasium_episodes:
            arrays.warn_of_other_sines()
        engine = "gymnasium" if gymnasium_episodes else self._TASK
        native = self._make(num_envs, max_episode_steps, autoreset_mode, engine, self._CONTINUOUS, threads)
        super().__init__(native, render_mode, parameters)
        self.max_episode_steps = max_episode_steps
        self._gymnasium_episodes = gymnasium_episodes
        self.copy = copy
        self._observations = None if copy else self._empty()
        self._made = True

    def _spaces(self) -> dict[str, spaces.Space[Any]]:
        single = super()._spaces()
        batched = {name: batch_space(space, self.num_envs) for name, space in single.items()}
        return {f"single_{name}": space for name, space in single.items()} | batched

    def reset(self, *, seed: Seed = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """Begin an episode in each environment.

        Args:
            seed: An integer of at least 0 with at most 4,300 digits. Its children seed the environments' streams; with
                ``gymnasium_episodes``, ``seed + i`` seeds environment ``i``. Or a list with an integer or ``None`` for each
                environment: its element seeds environment ``i`` as it seeds a single one. Where the seed is ``None`` the
                stream continues. A list does not change ``np_random``.
            options: ``"low"`` and ``"high"``: the bounds of these initial states, rad and rad/s; by default -0.1 and 0.1.
                Autoresets always use -0.1 and 0.1. ``"reset_mask"``: an array of ``bool`` of shape ``(num_envs,)``;
                environments whose element is false are neither seeded nor reset. As in ``SyncVectorEnv``, it is removed from
                ``options``.

        Returns:
            The observations of all environments, of shape ``(num_envs, 6)``, and infos, empty without ``info_parameters``.

        Raises:
            TypeError: If the mask is not an array of ``bool``. Nothing changes then.
            ValueError: If a bound is not a finite number, if low is above high, if the mask has another shape or no true
                element, or if the list of seeds has another length. Nothing changes then.
            gymnasium.error.Error: If a seed is not an integer of at least 0. Nothing changes then.
        """
        observations = self._reset(seed, options, *arrays.reset_bounds(options, self._BOUND))
        if self._gymnasium_episodes:
            self._observe_initial_states(observations, self.elapsed_steps == 0)
        return observations, self._parameter_infos()

    def step(self, actions: ArrayLike) -> tuple[Floats, NDArray[np.floating[Any]], Bools, Bools, dict[str, Any]]:
        """Step each environment. Other Python threads can run meanwhile.

        Args:
            actions: 0, 1 or 2: integers of shape ``(num_envs,)``. Continuous: torques of shape ``(num_envs, 1)``, N m.

        Returns:
            Observations, of shape ``(num_envs, 6)``; rewards, -1, or 0 where the step reaches the goal; where the goal was
            reached; where the limit of steps was reached; and infos. In mode ``SameStep``, if an episode ended, they have
            ``"final_obs"`` and ``"final_info"`` as in ``SyncVectorEnv``. They have the ``info_parameters`` of the new states.

        Raises:
            gymnasium.error.InvalidAction: If an action is invalid, or the type or shape of the array. No environment steps
                then.
            gymnasium.error.ResetNeeded: Before the first reset. In mode ``Disabled`` also if an episode has ended and its
                environment was not reset. No environment steps then.
            gymnasium.error.ClosedEnvironmentError: After ``close``.
        """
        last = self._parameter_infos() if self._same_step else {}
        observations, rewards, terminated, truncated, finals = self._step(actions)
        infos = self._parameter_infos()
        if finals is not None:
            infos |= arrays.final_infos(finals, terminated | truncated, last)
        if not self._gymnasium_episodes:
            return observations, rewards, terminated, truncated, infos
        if self._same_step:
            self._observe_initial_states(observations, terminated | truncated)
        elif self._ended is None:
            self._observe_initial_states(observations, (rewards == 0) & ~terminated)
        return observations, rewards.astype(np.float64), terminated, truncated, infos

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """The value of an attribute for each environment, or the results of its method ``render``.

        Args:
            name: A parameter, ``"state"``, ``"elapsed_steps"`` or another attribute that the error message lists.
            *args: The arguments of the method.
            **kwargs: The keyword arguments of the method.

        Raises:
            AttributeError: If the name is unknown.
        """
        self._check_open()
        if name not in (names := (*_ATTRIBUTES, *self._NAMES)):
            raise AttributeError(f"the environments have no attribute {name!r}; they have {', '.join(names)}")
        if name in ("action_space", "observation_space"):
            name = f"single_{name}"
        value = getattr(self, name)
        if name in self._NAMES and isinstance(value, Drawn | np.ndarray):
            values = self.get_parameter(name).tolist()
            return tuple(map(tuple, values) if name == "AVAIL_TORQUE" else values)
        if name == "render":
            frames = self.render(*args, **kwargs)
            return (None,) * self.num_envs if frames is None else frames
        return tuple(value) if name in ("state", "elapsed_steps") else (value,) * self.num_envs

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """The value of an attribute for each environment. As :meth:`call`."""
        return self.call(name)

    def get_parameter(self, name: str) -> NDArray[Any]:
        """A parameter of each environment: a new array of shape ``(num_envs,)``, for ``AVAIL_TORQUE`` ``(num_envs, 3)``."""
        self._check_open()
        if name not in self._NAMES:
            raise AttributeError(f"the environments have no parameter {name!r}; {_hint(name, self._NAMES)}")
        value, is_row = getattr(self, name), name == "AVAIL_TORQUE"
        if not isinstance(value, Drawn):
            return np.full((self.num_envs, 3) if is_row else self.num_envs, value)
        rows = np.empty((self.num_envs, 3 if is_row else 1))
        self._native.get(name, rows)
        return rows if is_row else rows[:, 0]

    def _parameter_infos(self) -> dict[str, Any]:
        """The parameters that infos have, as SyncVectorEnv collects the infos of environments."""
        if not self.info_parameters:
            return {}
        infos = {name: self.get_parameter(name) for name in self.info_parameters}
        return infos | {f"_{name}": np.ones(self.num_envs, np.bool_) for name in infos}

    def set_attr(self, name: str, values: Any) -> None:
        """Set a parameter or the state.

        Args:
            name: A parameter or ``"state"``.
            values: One value for all environments, or a list, tuple or array with a value for each. A parameter can also
                be drawn, for example an :class:`acrobot_rs.Uniform`.

        Raises:
            AttributeError: If the name is neither a parameter nor ``"state"``.
            TypeError: If a value is of a wrong type. Nothing changes then.
            ValueError: If a value is invalid, or if a list has another length. Nothing changes then.
        """
        self._check_open()
        if name not in (*self._NAMES, "state"):
            raise AttributeError(f"set_attr cannot set {name!r}; it can set state, {', '.join(self._NAMES)}")
        if name == "state" and np.shape(values) == (4,):
            values = np.tile(values, (self.num_envs, 1))
        setattr(self, name, values)

    def render(self) -> tuple[NDArray[np.uint8] | str, ...] | None:
        """For each environment an array of shape ``(500, 500, 3)`` or a text, depending on the render mode.

        Without a render mode, warns and returns ``None``.
        """
        self._check_open()
        if self.render_mode is None:
            self._warn_of_no_render_mode()
            return None
        if not self._ready:
            raise ResetNeeded("the environments have no states yet; call reset before render")
        return tuple(self._native.render(index, self.render_mode) for index in range(self.num_envs))

    def _pass(self, name: str, value: Any) -> Any:
        if isinstance(value, Drawn):
            self._native.set_drawn(name, value)
            return value
        each = arrays.values_of_each(name, value)
        if each is None:
            self._native.set(name, value)
        else:
            self._native.set_each(name, each)
            value = np.array([_fixed(name, one) for one in each])
            if (value != value[0]).any():
                return read_only(value)
            value = each[0]
        return _fixed(name, value)

    def _inputs(self, actions: ArrayLike) -> NDArray[Any]:
        """The actions, checked and converted to an array that the native part reads. It calls this where necessary."""
        what, kinds, dtype = ("numbers", "fiu", np.float32) if self._CONTINUOUS else ("integers", "iu", np.int64)
        shape = self.action_space.shape
        actions = numbers("actions", f"{what} of shape {shape}", actions, shape, kinds, InvalidAction)
        # An array over packed bytes is not aligned, which Rust requires.
        return np.ascontiguousarray(actions if actions.flags.aligned else actions.copy(), dtype)

    def _observe_initial_states(self, observations: Floats, which: Bools) -> None:
        """Write the observations of initial states. Gymnasium computes their sines with NumPy in ``float32``."""
        if which.any():
            angles = self.state[which, :2].astype(np.float32)
            cosines, sines = np.cos(angles), np.sin(angles)
            observations[which, :4] = np.stack([cosines, sines], axis=2).reshape(-1, 4)


class AcrobotContinuousVectorEnv(AcrobotVectorEnv):
    """As :class:`AcrobotVectorEnv`, but the actions are torques: ``float32`` of shape ``(num_envs, 1)``, in N m.

    A torque beyond the bounds of the action space, which are the smallest and the largest of ``AVAIL_TORQUE``, acts as the
    nearest bound.

    >>> import acrobot_rs.vector
    >>> envs = acrobot_rs.vector.AcrobotContinuousVectorEnv(num_envs=1024)
    >>> envs.action_space.shape
    (1024, 1)
    """

    _CONTINUOUS = True
