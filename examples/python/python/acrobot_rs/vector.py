"""Many environments in one step."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.error import InvalidAction
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from acrobot_rs._native import Batch
from acrobot_rs.parameters import Parameters, reset_bounds

Floats = NDArray[np.float32]
Bools = NDArray[np.bool_]


class AcrobotVectorEnv(Parameters, VectorEnv[Floats, NDArray[np.integer[Any]], np.ndarray]):
    """Many ``Acrobot-v1`` environments, thousands of times as fast as ``SyncVectorEnv``.

    All have the same parameters. They are computed in ``float32``, bit-identically on every machine. Each step is as close to
    Gymnasium's as ``float32`` is, but whole episodes drift apart, because an Acrobot is chaotic.

    Environment ``i`` draws from the ``i``-th child of the seed, ``numpy.random.SeedSequence(seed).spawn(num_envs)[i]``.
    So more environments do not change the first ones, and two seeds share no stream. ``SyncVectorEnv`` seeds environment
    ``i`` with ``seed + i``.

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

    _native: Batch

    def __init__(
        self,
        num_envs: int = 1,
        max_episode_steps: int = 500,
        render_mode: str | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        copy: bool = True,
    ) -> None:
        """Make environments and reset them with a random seed, ``np_random_seed``.

        Args:
            num_envs: The number of environments, at least 1.
            max_episode_steps: The steps after which an episode is truncated, at least 1.
            render_mode: ``None``, ``"rgb_array"`` or ``"ansi"``.
            autoreset_mode: ``NextStep``: the step after an episode's end resets, ignores its action and returns a reward of 0.
                ``SameStep``: the step that ends an episode also resets, and ``infos["final_obs"]`` has the episode's last
                observation. ``Disabled``: an environment continues to step after an episode's end, until it is reset by a
                ``reset`` of all or by one with a ``"reset_mask"``.
            copy: Whether each call returns observations in a new array. Otherwise all calls return the same array.

        Raises:
            ValueError: If a number is out of its range or a mode is unknown.
            MemoryError: If the environments do not fit into memory.
        """
        autoreset_mode = AutoresetMode(autoreset_mode)
        self._same_step = autoreset_mode is AutoresetMode.SAME_STEP
        native = Batch(num_envs, str(self.np_random_seed), max_episode_steps, autoreset_mode.value)
        super().__init__(native, render_mode)
        self.metadata = {**self.metadata, "autoreset_mode": autoreset_mode}
        self.num_envs = num_envs
        self._max_episode_steps = max_episode_steps
        self.copy = copy
        self.single_action_space = spaces.Discrete(3)
        self.single_observation_space = self._observation_space
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._observations = self._empty()

    @property
    def max_episode_steps(self) -> int:
        """The steps after which an episode is truncated. Read-only: chosen when the environments are made."""
        return self._max_episode_steps

    @property
    def state(self) -> Floats:
        """theta1, theta2 (rad) and their velocities (rad/s) of each environment: a copy, of shape ``(num_envs, 4)``."""
        return self._native.states().reshape(self.num_envs, 4)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """Begin an episode in each environment.

        Args:
            seed: An integer of at least 0 with at most 4,300 digits. Its children seed the environments' streams. With
                ``None`` the streams continue.
            options: ``"low"`` and ``"high"``: the bounds of these initial states, rad and rad/s; by default -0.1 and 0.1.
                Autoresets always use -0.1 and 0.1. ``"reset_mask"``: an array of ``bool`` of shape ``(num_envs,)``;
                environments whose element is false are neither seeded nor reset.

        Returns:
            The observations of all environments, of shape ``(num_envs, 6)``, and empty infos.

        Raises:
            ValueError: If a bound is not a finite number, if low is above high, or if the mask has another type or shape
                or no true element. Nothing changes then.
        """
        low, high = reset_bounds(options)
        mask = self._mask(options)
        # Gymnasium accepts True as 1. `str` rejects too many digits here, and `super().reset` rejects other types below.
        digits = str(int(seed)) if isinstance(seed, int) else None
        super().reset(seed=seed)
        self._native.reset(digits, low, high, mask)
        observations = self._empty() if self.copy else self._observations
        self._native.observe(observations)
        return observations, {}

    def step(self, actions: ArrayLike) -> tuple[Floats, Floats, Bools, Bools, dict[str, Any]]:
        """Step each environment. Other Python threads can run meanwhile.

        Args:
            actions: 0, 1 or 2 for each environment: integers of shape ``(num_envs,)``.

        Returns:
            Observations, of shape ``(num_envs, 6)``; rewards, -1, or 0 where the step reaches the goal; where the goal was
            reached; where the limit of steps was reached; and infos. In mode ``SameStep``, if an episode ended, they have
            ``"final_obs"`` and ``"final_info"`` as in ``SyncVectorEnv``. Otherwise they are empty.

        Raises:
            gymnasium.error.InvalidAction: If an action is invalid, or the type or shape of the array. No environment steps
                then.
        """
        actions = np.asarray(actions)
        if actions.dtype.kind not in "iu" or actions.shape != (self.num_envs,):
            raise InvalidAction(
                f"actions must be integers of shape ({self.num_envs},), got {actions.dtype} of shape {actions.shape}"
            )
        observations = self._empty() if self.copy else self._observations
        rewards = np.empty(self.num_envs, np.float32)
        # Zeros, not empty: a Rust bool must be 0 or 1, and another byte is undefined behaviour.
        terminated, truncated = np.zeros((2, self.num_envs), np.bool_)
        finals = self._empty() if self._same_step else None
        # An array over packed bytes is not aligned, which Rust requires.
        actions = np.ascontiguousarray(actions if actions.flags.aligned else actions.copy(), np.int64)
        self._native.step(actions, observations, rewards, terminated, truncated, finals)
        infos = {} if finals is None else _final_infos(finals, terminated | truncated)
        return observations, rewards, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8] | str, ...] | None:
        """For each environment an array of shape ``(500, 500, 3)`` or a text, depending on the render mode.

        Without a render mode, warns and returns ``None``.
        """
        if self.render_mode is None:
            self._warn_of_no_render_mode()
            return None
        return tuple(self._native.render(index, self.render_mode) for index in range(self.num_envs))

    def _mask(self, options: dict[str, Any] | None) -> Bools | None:
        if options is None or "reset_mask" not in options:
            return None
        mask = np.asarray(options["reset_mask"])
        if mask.dtype != np.bool_ or mask.shape != (self.num_envs,) or not mask.any():
            raise ValueError(
                f"reset_mask must be an array of bool of shape ({self.num_envs},) with a true element, got {mask!r}"
            )
        return mask.view(np.uint8) != 0  # a NumPy bool can be any byte, but Rust's only 0 or 1

    def _empty(self) -> Floats:
        return np.empty((self.num_envs, 6), np.float32)


def _final_infos(finals: Floats, ended: Bools) -> dict[str, Any]:
    """Infos as in ``SyncVectorEnv``: last observations, or ``None`` where no episode ended, and which episodes ended."""
    if not ended.any():
        return {}
    final_obs = np.full(len(ended), None, dtype=object)
    for index in np.flatnonzero(ended):
        final_obs[index] = finals[index].copy()
    return {"final_obs": final_obs, "_final_obs": ended, "final_info": {}, "_final_info": ended.copy()}
