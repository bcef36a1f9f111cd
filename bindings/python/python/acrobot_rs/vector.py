"""Many environments in one step."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.error import InvalidAction, ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import arrays
from acrobot_rs._native import MAX_STEPS, Batch
from acrobot_rs.arrays import Seed, must_be, numbers, read_only
from acrobot_rs.env import Balance
from acrobot_rs.parameters import Drawn, Parameters

Floats = NDArray[np.float32]
Bools = NDArray[np.bool_]

#: What ``get_attr`` and ``call`` know, with the parameters.
_ATTRIBUTES = (
    *("action_space", "elapsed_steps", "max_episode_steps", "metadata", "observation_space"),
    *("render", "render_mode", "spec", "state"),
)


class AcrobotVectorEnv(Parameters, VectorEnv[Floats, NDArray[Any], np.ndarray]):
    """Many ``Acrobot-v1`` environments, thousands of times as fast as ``SyncVectorEnv``.

    They are computed in ``float32``, bit-identically on every machine. Each step differs from
    Gymnasium's by rounding only, but whole episodes drift apart, because an acrobot is chaotic.

    Environment ``i`` draws from the ``i``-th child of the seed,
    ``numpy.random.SeedSequence(seed).spawn(num_envs)[i]``.

    A parameter has one value for all environments, a list, tuple or array with one for each, or an
    :class:`acrobot_rs.Uniform`, :class:`acrobot_rs.LogUniform` or :class:`acrobot_rs.Normal`, from
    which each reset draws. Reading it gives what was set, and :meth:`get_parameter` what each
    environment has.
    """

    metadata: dict[str, Any] = {
        "render_modes": ["rgb_array", "ansi"],
        "render_fps": 15,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    #: Whether it was reset.
    _ready = False

    def __init__(
        self,
        num_envs: int = 1,
        max_episode_steps: int | None = MAX_STEPS,
        render_mode: str | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        gymnasium_episodes: bool = False,
        threads: int | None = 1,
        float64: bool = False,
        **parameters: Any,
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
            float64: Whether to compute in ``float64``, which takes longer.
            **parameters: Parameters, for example ``LINK_MASS_1=2.0``.
        """
        if threads is None:
            has_affinity = hasattr(os, "sched_getaffinity")
            threads = len(os.sched_getaffinity(0)) if has_affinity else os.cpu_count() or 1
        limit = 2**32 - 1 if max_episode_steps is None else max_episode_steps
        counts = {"num_envs": num_envs, "max_episode_steps": limit, "threads": threads}
        for name, count in counts.items():
            arrays.integer(name, count, 1, 2**32 - 1)
        if gymnasium_episodes:
            if self._TASK != "gymnasium":
                raise must_be("gymnasium_episodes", "False in another task", True)
            if float64:
                rule = "False with gymnasium_episodes, which computes in float64"
                raise must_be("float64", rule, True)
            arrays.warn_of_other_sines()
        arithmetic = "host" if gymnasium_episodes else "float64" if float64 else "float32"
        mode = getattr(autoreset_mode, "value", autoreset_mode)
        native = Batch(
            *(num_envs, self.np_random_seed, limit, str(mode), (self._TASK, arithmetic)),
            *(self._CONTINUOUS, threads),
        )
        mode = AutoresetMode(mode)
        self.autoreset_mode = mode
        self.metadata = {**self.metadata, "autoreset_mode": mode}
        self.num_envs = num_envs
        self.max_episode_steps = max_episode_steps
        self.copy = copy
        #: The array that all calls return, or ``None`` if each returns a new one.
        self._observations = None if copy else self._empty()
        self._same_step = mode is AutoresetMode.SAME_STEP
        self._disabled = mode is AutoresetMode.DISABLED
        self._gymnasium_episodes = gymnasium_episodes
        self._float64 = gymnasium_episodes or float64
        super().__init__(native, render_mode, parameters)

    def _spaces(self) -> dict[str, spaces.Space[Any]]:
        single = super()._spaces()
        batched = {name: batch_space(space, self.num_envs) for name, space in single.items()}
        return {f"single_{name}": space for name, space in single.items()} | batched

    def _pass(self, name: str, value: Any) -> Any:
        is_instrument = name in self._INSTRUMENTS
        if is_instrument and (value is None or isinstance(value, Drawn)):
            return super()._pass(name, value)
        if isinstance(value, Drawn):
            self._native.set_drawn(name, value)
            return value
        each = arrays.values_of_each(name, value, self.num_envs)
        set_values = self._native.set_instrument if is_instrument else self._native.set
        set_values(name, [value] if each is None else each)
        if each is None:
            return self._fixed(name, value)
        values = np.array([self._fixed(name, one) for one in each])
        return self._fixed(name, each[0]) if (values == values[0]).all() else read_only(values)

    def _inputs(self, actions: ArrayLike) -> NDArray[Any]:
        """The actions as an array that the native part reads. It calls this where necessary."""
        what, kinds, dtype = (
            ("numbers", "fiu", np.float32) if self._CONTINUOUS else ("integers", "iu", np.int64)
        )
        shape = self.action_space.shape
        actions = numbers(
            "actions", f"{what} of shape {shape}", actions, shape, kinds, InvalidAction
        )
        with np.errstate(over="ignore"):  # an infinite torque acts as the bound
            return np.require(actions, dtype, "CA")

    def reset(
        self, *, seed: Seed = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Begin an episode in each environment.

        Args:
            seed: An integer of at least 0; with ``gymnasium_episodes``, ``seed + i`` seeds
                environment ``i``. Or a list with an integer or ``None`` for each environment. With
                ``None`` streams continue.
            options: As in a single environment, and ``"reset_mask"``: an array of ``bool``, true
                for environments to seed and reset. ``"state"`` may have the shape
                ``(num_envs, 4)``. Autoresets ignore all options.

        Returns:
            The observations of all environments, of shape ``(num_envs, 6)``, and empty infos.
        """
        options = options or {}
        bounds = arrays.reset_bounds(options, self._BOUND)
        mask = arrays.reset_mask(options, self.num_envs)
        states = None
        if "state" in options:
            states = arrays.states_of(options["state"], self.num_envs)
        child_of, seeds = arrays.seeds_of(seed, self.num_envs, self._gymnasium_episodes)
        if seeds is not None and mask is not None:
            seeds = [each if some else None for each, some in zip(seeds, mask, strict=True)]
        observations = self._empty() if self._observations is None else self._observations
        self._native.reset(child_of, seeds, bounds, mask, states, observations)
        if not isinstance(seed, list | tuple):
            super().reset(seed=arrays.plain_seed(seed))
        self._ready = True
        if self._gymnasium_episodes:
            self._observe_initial_states(observations, self.elapsed_steps == 0)
        return observations, {}

    def step(
        self, actions: ArrayLike
    ) -> tuple[Floats, NDArray[np.floating[Any]], Bools, Bools, dict[str, Any]]:
        """Step each environment. Other Python threads can run meanwhile.

        Args:
            actions: An element of ``action_space``, as an array or a list.

        Returns:
            Observations, of shape ``(num_envs, 6)``; rewards; where the goal was reached; where the
            limit of steps was reached; and infos: in mode ``SameStep``, if an episode ended,
            ``"final_obs"`` and ``"final_info"`` as in ``SyncVectorEnv``.
        """
        if not self._ready:
            raise ResetNeeded("the environments have no states yet; call reset before step")
        if self._disabled and (index := self._native.first_done()) is not None:
            raise ResetNeeded(
                f"the episode of environment {index} has ended; reset it before the next step, "
                'with options={"reset_mask": terminated | truncated}'
            )
        observations = self._empty() if self._observations is None else self._observations
        finals = self._empty() if self._same_step else None
        rewards, terminated, truncated = self._native.step(self, actions, observations, finals)
        infos = {} if finals is None else arrays.final_infos(finals, terminated | truncated)
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

        To set the states, assign an array of this shape, or one state for all. Episodes continue:
        ``reset(options={"state": states})`` begins episodes instead. In mode ``NextStep`` the step
        after an episode's end still resets.
        """
        states = self._native.states().reshape(-1, 4)
        return read_only(states if self._float64 else states.astype(np.float32))

    @state.setter
    def state(self, states: ArrayLike) -> None:
        self._native.set_states(arrays.states_of(states, self.num_envs))

    @property
    def elapsed_steps(self) -> NDArray[np.int64]:
        """The number of steps of each environment's episode, of shape ``(num_envs,)``."""
        return read_only(self._native.elapsed())

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """The value of an attribute for each environment, or what its method ``render`` returns."""
        known = (*_ATTRIBUTES, *self._ALL)
        if name not in known:
            they_have = f"they have {', '.join(known)}"
            raise AttributeError(f"the environments have no attribute {name!r}; {they_have}")
        if name == "render":
            frames = self.render(*args, **kwargs)
            return (None,) * self.num_envs if frames is None else frames
        if name in self._ALL:
            values = self.get_parameter(name).tolist()
            return tuple(map(tuple, values) if name == "AVAIL_TORQUE" else values)
        value = getattr(self, f"single_{name}" if name.endswith("_space") else name)
        return tuple(value) if name in ("state", "elapsed_steps") else (value,) * self.num_envs

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """As :meth:`call`."""
        return self.call(name)

    def get_parameter(self, name: str) -> NDArray[Any]:
        """A parameter of each environment, in a new array with a row of 3 of ``AVAIL_TORQUE``."""
        value, is_row = getattr(self, name), name == "AVAIL_TORQUE"
        if value is not None and not isinstance(value, Drawn):
            return np.full((self.num_envs, 3) if is_row else self.num_envs, value)
        native = self._native
        get = native.instrument if name in self._INSTRUMENTS else native.get
        rows = get(name).reshape(self.num_envs, -1)
        return rows if is_row else rows[:, 0]

    def set_attr(self, name: str, values: Any) -> None:
        """Set a parameter or ``"state"``, as an assignment does."""
        setattr(self, name, values)

    def render(self) -> tuple[NDArray[np.uint8] | str, ...] | None:
        """For each environment an array of shape ``(500, 500, 3)`` or a text, as the mode says.

        Without a render mode, warns and returns ``None``.
        """
        if self.render_mode is None:
            self._warn_of_no_render_mode()
            return None
        if not self._ready:
            raise ResetNeeded("the environments have no states yet; call reset before render")
        return tuple(self._native.render(index, self.render_mode) for index in range(self.num_envs))

    def _empty(self) -> Floats:
        return np.empty((self.num_envs, 6), np.float32)

    def _observe_initial_states(self, observations: Floats, which: Bools) -> None:
        """Write the observations of initial states, whose sines are NumPy's in ``float32``."""
        if which.any():
            angles = self.state[which, :2].astype(np.float32)
            cosines, sines = np.cos(angles), np.sin(angles)
            observations[which, :4] = np.stack([cosines, sines], axis=2).reshape(-1, 4)


class AcrobotContinuousVectorEnv(AcrobotVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]):
    """:class:`AcrobotVectorEnv` with the actions of :class:`acrobot_rs.AcrobotContinuousEnv`.

    They have the shape ``(num_envs, 1)``.
    """

    _CONTINUOUS = True


class AcrobotBalanceVectorEnv(
    Balance, AcrobotContinuousVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]
):
    """Many :class:`acrobot_rs.AcrobotBalanceEnv`, without ``gymnasium_episodes``."""
