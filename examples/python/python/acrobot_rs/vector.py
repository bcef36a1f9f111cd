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
from acrobot_rs.parameters import Parameters, start_bounds

Floats = NDArray[np.float32]
Bools = NDArray[np.bool_]


class AcrobotVectorEnv(Parameters, VectorEnv[Floats, NDArray[np.integer[Any]], np.ndarray]):
    """As many ``Acrobot-v1`` as wanted, some thousand times as fast as ``SyncVectorEnv``.

    They have the parameters of all, and are computed in ``float32``, to the same bits on every machine: step by step as
    close to Gymnasium's as that is, but since an acrobot is chaotic not the same episodes.

    Environment ``i`` draws from the ``i``-th child of the seed, ``numpy.random.SeedSequence(seed).spawn(num_envs)[i]``:
    the first environments of more are those of fewer, and no streams of two seeds are the same, as they are for
    ``SyncVectorEnv``, which takes ``seed + i``.

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
        """Environments at the first starts of a random seed, which ``np_random_seed`` tells.

        Args:
            num_envs: How many, 1 or more.
            max_episode_steps: The steps after which an episode is truncated, 1 or more.
            render_mode: ``None``, ``"rgb_array"`` or ``"ansi"``.
            autoreset_mode: ``NextStep``: the step after an end resets, ignores its action and returns a reward of 0.
                ``SameStep``: the step that ends resets, and ``infos["final_obs"]`` has what was seen last.
            copy: Whether each call returns observations in an array of its own. Otherwise all return the same array.

        Raises:
            ValueError: For numbers out of their range, another render mode, and ``AutoresetMode.DISABLED``.
        """
        autoreset_mode = AutoresetMode(autoreset_mode)
        if autoreset_mode is AutoresetMode.DISABLED:
            raise ValueError("autoreset_mode is Disabled; allowed is NextStep or SameStep")
        self._same_step = autoreset_mode is AutoresetMode.SAME_STEP
        native = Batch(num_envs, str(self.np_random_seed), max_episode_steps, self._same_step)
        super().__init__(native, render_mode)
        self.metadata = {**self.metadata, "autoreset_mode": autoreset_mode}
        self.num_envs = num_envs
        self.max_episode_steps = max_episode_steps
        self.copy = copy
        self.single_action_space = spaces.Discrete(3)
        self.single_observation_space = self._observation_space
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._observations = self._empty()

    @property
    def state(self) -> Floats:
        """theta1, theta2 (rad) and their velocities (rad/s) of each, of shape ``(num_envs, 4)``; a copy."""
        return self._native.states().reshape(self.num_envs, 4)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """Begin an episode of each.

        Args:
            seed: An integer of up to 4,300 digits, 0 or more, whose children are the streams; by ``None`` they go on.
            options: ``"low"`` and ``"high"``, the bounds of these starts, rad and rad/s; -0.1 and 0.1 if not given,
                and for starts by autoreset.

        Returns:
            The observations, of shape ``(num_envs, 6)``, and empty infos.

        Raises:
            ValueError: For bounds that are no finite numbers in order, and for a ``"reset_mask"``, which goes with
                ``AutoresetMode.DISABLED``; nothing is changed then.
        """
        if options is not None and "reset_mask" in options:
            raise ValueError('options has "reset_mask"; allowed is "low" and "high": ended episodes reset themselves')
        low, high = start_bounds(options)
        super().reset(seed=seed)
        self._native.reset(None if seed is None else str(int(seed)), low, high)  # True is a seed, too
        observations = self._empty() if self.copy else self._observations
        self._native.observe(observations)
        return observations, {}

    def step(self, actions: ArrayLike) -> tuple[Floats, Floats, Bools, Bools, dict[str, Any]]:
        """Apply a torque to each for ``dt``. Other threads of Python run meanwhile.

        Args:
            actions: 0, 1 or 2 for each, integers of shape ``(num_envs,)``.

        Returns:
            Observations, of shape ``(num_envs, 6)``; rewards, -1, or 0 in the goal; whether each goal was
            reached; whether each episode had its steps; and infos, empty or of ``"final_obs"`` and ``"final_info"``
            as ``SyncVectorEnv`` has them.

        Raises:
            gymnasium.error.InvalidAction: For other actions; nothing is stepped then.
        """
        actions = np.asarray(actions)
        if actions.dtype.kind not in "iu" or actions.shape != (self.num_envs,):
            raise InvalidAction(
                f"actions are {actions.dtype} of shape {actions.shape}; allowed are integers of shape ({self.num_envs},)"
            )
        observations = self._empty() if self.copy else self._observations
        rewards = np.empty(self.num_envs, np.float32)
        terminated, truncated = np.empty((2, self.num_envs), np.bool_)
        finals = self._empty() if self._same_step else None
        actions = np.ascontiguousarray(actions, np.int64)
        self._native.step(actions, observations, rewards, terminated, truncated, finals)
        infos = {} if finals is None else _final_infos(finals, terminated | truncated)
        return observations, rewards, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8] | str, ...] | None:
        """What the render mode asks for, of each: arrays of shape ``(500, 500, 3)``, texts, or with a warning nothing."""
        if self.render_mode is None:
            self._warn_of_no_render_mode()
            return None
        return tuple(self._native.render(index, self.render_mode) for index in range(self.num_envs))

    def _empty(self) -> Floats:
        return np.empty((self.num_envs, 6), np.float32)


def _final_infos(finals: Floats, ended: Bools) -> dict[str, Any]:
    """As ``SyncVectorEnv`` has them: an array of arrays, ``None`` where no episode ended, and which did."""
    if not ended.any():
        return {}
    final_obs = np.full(len(ended), None, dtype=object)
    for index in np.flatnonzero(ended):
        final_obs[index] = finals[index].copy()
    return {"final_obs": final_obs, "_final_obs": ended, "final_info": {}, "_final_info": ended.copy()}
