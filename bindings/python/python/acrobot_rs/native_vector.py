"""Resets, steps, states and attributes of the vector environments of both tasks."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
from gymnasium.error import ClosedEnvironmentError, ResetNeeded
from gymnasium.vector import VectorEnv
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import arrays
from acrobot_rs._native import BUSY
from acrobot_rs.arrays import Seed, read_only
from acrobot_rs.parameters import Drawn, _hint

Floats = NDArray[np.float32]
Bools = NDArray[np.bool_]

#: What ``get_attr`` and ``call`` know, with the parameters.
_ATTRIBUTES = (
    *("action_space", "elapsed_steps", "max_episode_steps", "metadata", "observation_space"),
    *("render", "render_mode", "spec", "state"),
)


class Alone:
    """Rejects a step or a reset beside that of another thread."""

    def __init__(self) -> None:
        lock = threading.RLock()
        self._acquire, self._release = lock.acquire, lock.release

    def __enter__(self) -> None:
        if not self._acquire(False):
            raise RuntimeError(BUSY)

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        self._release()

    def __reduce__(self) -> tuple[type[Alone], tuple[()]]:
        """A copy of the environment has its own lock."""
        with self:
            return Alone, ()


class NativeVectorEnv(arrays.Hints, VectorEnv[Floats, NDArray[Any], np.ndarray]):
    """What the vector environments of both tasks share. A rejected call changes nothing."""

    #: Whether it was reset and not closed.
    _ready = False
    #: Whether an environment may wait for a reset by the user: only then steps look for it.
    _may_wait = False

    def reset(
        self, *, seed: Seed = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Begin an episode in each environment.

        Args:
            seed: An integer of at least 0 with at most 4,300 digits, whose children seed the
                environments' streams; with ``gymnasium_episodes``, ``seed + i`` seeds environment
                ``i``. Or a list with an integer or ``None`` for each environment. With ``None``
                streams continue.
            options: As in a single environment, and ``"reset_mask"``: an array of ``bool``;
                environments whose element is false are neither seeded nor reset. ``"state"`` has
                the shape ``(num_envs, 4)``, or ``(4,)`` for the same one in all. Autoresets ignore
                all options.

        Returns:
            The observations of all environments, of shape ``(num_envs, 6)``, and infos, empty
            without ``info_parameters``.

        Raises:
            TypeError, ValueError, gymnasium.error.Error: If options or a seed are invalid.
            RuntimeError: If another thread uses the environments.
        """
        low, high = arrays.reset_bounds(options, self._BOUND, arrays.OPTIONS)
        self._check_open()
        options = options or {}
        mask = arrays.reset_mask(options, self.num_envs)
        states = None
        if "state" in options:
            states = arrays.states_of(self._each(options["state"]), self.num_envs)
        child_of, seeds = arrays.seeds_of(seed, self.num_envs, self._gymnasium_episodes)
        if seeds is not None and mask is not None:
            seeds = [each if some else None for each, some in zip(seeds, mask, strict=True)]
        with self._alone:
            self._native.reset(child_of, seeds, low, high, mask, states)
            if not isinstance(seed, list | tuple):
                super().reset(seed=arrays.plain_seed(seed))
            self._ready = True
            observations = self._empty() if self._observations is None else self._observations
            self._native.observe(observations)
            if self._gymnasium_episodes:
                self._observe_initial_states(observations, self.elapsed_steps == 0)
            return observations, self._parameter_infos()

    def step(
        self, actions: ArrayLike
    ) -> tuple[Floats, NDArray[np.floating[Any]], Bools, Bools, dict[str, Any]]:
        """Step each environment. Other Python threads can run meanwhile.

        Args:
            actions: An element of ``action_space``, as an array or a list.

        Returns:
            Observations, of shape ``(num_envs, 6)``; rewards; where the goal was reached; where the
            limit of steps was reached; and infos: the ``info_parameters`` of the new states, and in
            mode ``SameStep``, if an episode ended, ``"final_obs"`` and ``"final_info"`` as in
            ``SyncVectorEnv``.

        Raises:
            gymnasium.error.InvalidAction: If an action is invalid, or the type or shape of the
                array.
            gymnasium.error.ResetNeeded: Before the first reset. In mode ``Disabled`` also if an
                episode has ended and its environment was not reset.
            gymnasium.error.ClosedEnvironmentError: After ``close``.
            RuntimeError: If another thread uses the environments.
        """
        with self._alone:
            self._check_ready()
            last = self._parameter_infos() if self._same_step else {}
            observations = self._empty() if self._observations is None else self._observations
            finals = self._empty() if self._same_step else None
            rewards, terminated, truncated = self._native.step(self, actions, observations, finals)
            if self._disabled and np.count_nonzero(terminated | truncated):
                self._may_wait = True
            infos = self._parameter_infos()
            if finals is not None:
                infos |= arrays.final_infos(finals, terminated | truncated, last)
            if not self._gymnasium_episodes:
                return observations, rewards, terminated, truncated, infos
            if self._same_step:
                self._observe_initial_states(observations, terminated | truncated)
            elif not self._disabled:
                self._observe_initial_states(observations, (rewards == 0) & ~terminated)
            return observations, rewards.astype(np.float64), terminated, truncated, infos

    @property
    def state(self) -> NDArray[np.floating[Any]]:
        """theta1, theta2 (rad) and their velocities (rad/s) of each: a read-only ``(num_envs, 4)``.

        To set the states, assign an array of this shape. To set some, change rows of
        ``state.copy()`` and assign it. Episodes and numbers of steps continue:
        ``reset(options={"state": states})`` begins episodes instead. In mode ``NextStep`` the step
        after an episode's end still resets, even if you set its state.
        """
        states = np.empty((self.num_envs, 4), np.float64)
        self._native.states(states)
        return read_only(states if self._float64 else states.astype(np.float32))

    @state.setter
    def state(self, states: ArrayLike) -> None:
        checked = arrays.states_of(states, self.num_envs)
        with self._alone:
            self._native.set_states(checked)

    def _each(self, states: Any) -> Any:
        """A state for each environment, if there is one for all."""
        try:
            one = arrays.numbers("state", "four numbers", states, (4,))
        except ValueError:
            return states
        return np.tile(one, (self.num_envs, 1))

    @property
    def elapsed_steps(self) -> NDArray[np.int64]:
        """The number of steps of each environment's episode, of shape ``(num_envs,)``."""
        elapsed = np.empty(self.num_envs, np.int64)
        self._native.elapsed(elapsed)
        return read_only(elapsed)

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """The value of an attribute for each environment, or the results of its method ``render``.

        The error for an unknown name, an ``AttributeError``, lists the attributes.
        """
        self._check_open()
        known = (*_ATTRIBUTES, *self._NAMES)
        if not arrays.is_one_of(name, known):
            they_have = f"they have {', '.join(known)}"
            raise AttributeError(f"the environments have no attribute {name!r}; {they_have}")
        if name in ("action_space", "observation_space"):
            name = f"single_{name}"
        if name == "render":
            frames = self.render(*args, **kwargs)
            return (None,) * self.num_envs if frames is None else frames
        value = getattr(self, name)
        if name in self._NAMES and isinstance(value, Drawn | np.ndarray):
            values = self.get_parameter(name).tolist()
            return tuple(map(tuple, values) if name == "AVAIL_TORQUE" else values)
        return tuple(value) if name in ("state", "elapsed_steps") else (value,) * self.num_envs

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """As :meth:`call`."""
        return self.call(name)

    def get_parameter(self, name: str) -> NDArray[Any]:
        """A parameter of each environment, in a new array with a row of 3 of ``AVAIL_TORQUE``."""
        self._check_open()
        if not arrays.is_one_of(name, self._NAMES):
            hint = _hint(str(name), self._NAMES)
            raise AttributeError(f"the environments have no parameter {name!r}; {hint}")
        value, is_row = getattr(self, name), name == "AVAIL_TORQUE"
        if not isinstance(value, Drawn):
            return np.full((self.num_envs, 3) if is_row else self.num_envs, value)
        rows = np.empty((self.num_envs, 3 if is_row else 1))
        self._native.get(name, rows)
        return rows if is_row else rows[:, 0]

    def _parameter_infos(self) -> dict[str, Any]:
        """The parameters that infos have, as SyncVectorEnv collects the infos of environments."""
        infos = {name: self.get_parameter(name) for name in self.info_parameters}
        return infos | {f"_{name}": np.ones(self.num_envs, np.bool_) for name in infos}

    def set_attr(self, name: str, values: Any) -> None:
        """Set a parameter or ``"state"``.

        ``values`` is one value for all environments, or a list, tuple or array with a value for
        each. A parameter can also be drawn, for example by an :class:`acrobot_rs.Uniform`.
        """
        self._check_open()
        known = ("state", *self._NAMES)
        if not arrays.is_one_of(name, known):
            raise AttributeError(f"set_attr cannot set {name!r}; it can set {', '.join(known)}")
        setattr(self, name, self._each(values) if name == "state" else values)

    def render(self) -> tuple[NDArray[np.uint8] | str, ...] | None:
        """For each environment an array of shape ``(500, 500, 3)`` or a text, as the mode says.

        Without a render mode, warns and returns ``None``.
        """
        self._check_open()
        if self.render_mode is None:
            self._warn_of_no_render_mode()
            return None
        if not self._ready:
            raise ResetNeeded("the environments have no states yet; call reset before render")
        return tuple(self._native.render(index, self.render_mode) for index in range(self.num_envs))

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
        if self._may_wait:
            if (index := self._native.first_ended()) is not None:
                raise ResetNeeded(
                    f"the episode of environment {index} has ended; reset it before the next step, "
                    'with options={"reset_mask": terminated | truncated}'
                )
            self._may_wait = False

    def _empty(self) -> Floats:
        return np.empty((self.num_envs, 6), np.float32)

    def _observe_initial_states(self, observations: Floats, which: Bools) -> None:
        """Write the observations of initial states, whose sines are NumPy's in ``float32``."""
        if which.any():
            angles = self.state[which, :2].astype(np.float32)
            cosines, sines = np.cos(angles), np.sin(angles)
            observations[which, :4] = np.stack([cosines, sines], axis=2).reshape(-1, 4)
