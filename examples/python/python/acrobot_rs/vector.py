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
    """Many ``Acrobot-v1``, a thousand times as fast as ``SyncVectorEnv``.

    All have the same parameters. They are computed in ``float32``, with the same bits on every machine. Each step is as
    close to Gymnasium's as ``float32`` is, but episodes differ because an acrobot is chaotic.

    Environment ``i`` draws from the ``i``-th child of the seed, ``numpy.random.SeedSequence(seed).spawn(num_envs)[i]``.
    So the number of environments does not change the first ones, and two seeds share no stream. ``SyncVectorEnv`` seeds
    environment ``i`` with ``seed + i``.

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
        """Make environments, in the initial states of a random seed, ``np_random_seed``.

        Args:
            num_envs: The number of environments, at least 1.
            max_episode_steps: The steps after which an episode is truncated, at least 1.
            render_mode: ``None``, ``"rgb_array"`` or ``"ansi"``.
            autoreset_mode: ``NextStep``: the step after an end resets, ignores its action and returns a reward of 0.
                ``SameStep``: the step that ends an episode resets, and ``infos["final_obs"]`` has its last observation.
                ``Disabled``: environments step on after an end, until a reset with a ``"reset_mask"`` or of all.
            copy: Whether each call returns observations in a new array. Otherwise all return the same array.

        Raises:
            ValueError: For numbers out of their range, and for other modes.
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
        """The steps after which an episode is truncated. They are chosen when the environments are made."""
        return self._max_episode_steps

    @property
    def state(self) -> Floats:
        """theta1, theta2 (rad) and their velocities (rad/s) of each, of shape ``(num_envs, 4)``. It is a copy."""
        return self._native.states().reshape(self.num_envs, 4)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """Begin an episode of each.

        Args:
            seed: An integer of at least 0 and up to 4,300 digits, whose children seed the streams. With ``None`` the
                streams go on.
            options: ``"low"`` and ``"high"``, the bounds of these initial states, rad and rad/s; by default, and for
                autoresets, -0.1 and 0.1. ``"reset_mask"``, an array of ``bool`` of shape ``(num_envs,)``: environments
                whose element is false are neither seeded nor reset.

        Returns:
            The observations of all, of shape ``(num_envs, 6)``, and empty infos.

        Raises:
            ValueError: For bounds that are not finite numbers in order, and for another mask or one without a true
                element. Nothing changes then.
        """
        low, high = reset_bounds(options)
        mask = self._mask(options)
        # True is a seed, too. Python rejects too many digits here, and Gymnasium other types below.
        digits = str(int(seed)) if isinstance(seed, int) else None
        super().reset(seed=seed)
        self._native.reset(digits, low, high, mask)
        observations = self._empty() if self.copy else self._observations
        self._native.observe(observations)
        return observations, {}

    def step(self, actions: ArrayLike) -> tuple[Floats, Floats, Bools, Bools, dict[str, Any]]:
        """Apply a torque to each for ``dt``. Other threads of Python run meanwhile.

        Args:
            actions: 0, 1 or 2 for each: integers of shape ``(num_envs,)``.

        Returns:
            Observations, of shape ``(num_envs, 6)``; rewards, -1, or 0 in the goal; whether each reached its goal;
            whether each reached its last step; and infos, empty or with ``"final_obs"`` and ``"final_info"`` as in
            ``SyncVectorEnv``.

        Raises:
            gymnasium.error.InvalidAction: For other actions. Nothing is stepped then.
        """
        actions = np.asarray(actions)
        if actions.dtype.kind not in "iu" or actions.shape != (self.num_envs,):
            raise InvalidAction(
                f"actions must be integers of shape ({self.num_envs},), got {actions.dtype} of shape {actions.shape}"
            )
        observations = self._empty() if self.copy else self._observations
        rewards = np.empty(self.num_envs, np.float32)
        # NumPy takes any byte for a bool, Rust only 0 and 1.
        terminated, truncated = np.zeros((2, self.num_envs), np.bool_)
        finals = self._empty() if self._same_step else None
        # Numbers within packed bytes are not aligned.
        actions = np.ascontiguousarray(actions if actions.flags.aligned else actions.copy(), np.int64)
        self._native.step(actions, observations, rewards, terminated, truncated, finals)
        infos = {} if finals is None else _final_infos(finals, terminated | truncated)
        return observations, rewards, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8] | str, ...] | None:
        """An array of shape ``(500, 500, 3)`` or a text for each, by the render mode. Without a mode it warns."""
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
        return mask.view(np.uint8) != 0  # NumPy takes any byte for a bool, Rust only 0 and 1

    def _empty(self) -> Floats:
        return np.empty((self.num_envs, 6), np.float32)


def _final_infos(finals: Floats, ended: Bools) -> dict[str, Any]:
    """As in ``SyncVectorEnv``: an array of arrays, with ``None`` where no episode ended, and which episodes ended."""
    if not ended.any():
        return {}
    final_obs = np.full(len(ended), None, dtype=object)
    for index in np.flatnonzero(ended):
        final_obs[index] = finals[index].copy()
    return {"final_obs": final_obs, "_final_obs": ended, "final_info": {}, "_final_info": ended.copy()}
