"""The vector environment for Stable-Baselines3, which does not take Gymnasium's.

This module needs ``stable-baselines3``, which the package does not install.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv

from acrobot_rs.arrays import must_be
from acrobot_rs.parameters import Drawn
from acrobot_rs.vector import AcrobotVectorEnv

Indices = int | Iterable[int] | None


class AcrobotVecEnv(VecEnv):
    """A vector environment of this package, of either task, as Stable-Baselines3's ``VecEnv``.

    Its results are those of ``DummyVecEnv``: a step that ends an episode also resets, and the
    environment's info has ``"terminal_observation"`` and ``"TimeLimit.truncated"``.
    Stable-Baselines3's ``VecMonitor`` logs the returns of episodes. The differences:

    - ``envs`` is one vector environment, which has the ``metadata``. There are no buffers such as
      ``buf_obs``.
    - ``set_attr`` sets parameters and states, and the spaces follow. ``get_attr`` and ``has_attr``
      know what ``envs.get_attr`` knows, and ``env_method`` only ``render``.
    - There are no wrappers, so ``env_is_wrapped`` returns ``False``.
    - The options of ``set_options`` must be the same for all environments.

    >>> import acrobot_rs
    >>> from acrobot_rs.sb3 import AcrobotVecEnv
    >>> envs = acrobot_rs.AcrobotVectorEnv(num_envs=64, autoreset_mode="SameStep")
    >>> AcrobotVecEnv(envs).reset().shape
    (64, 6)
    """

    def __init__(self, envs: VectorEnv[Any, Any, Any]) -> None:
        """Take over environments of this package with ``autoreset_mode="SameStep"``."""
        if not isinstance(envs, AcrobotVectorEnv):
            raise must_be("envs", "an AcrobotVectorEnv", type(envs).__name__, TypeError)
        if (mode := envs.autoreset_mode) is not AutoresetMode.SAME_STEP:
            raise must_be("autoreset_mode", '"SameStep"', f'"{mode.value}"')
        self.envs = envs
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)
        self.metadata = envs.metadata

    def reset(self) -> NDArray[np.float32]:
        """Begin all episodes, with new seeds of :meth:`seed` and options of ``set_options``."""
        options, *others = self._options
        if any(each != options for each in others):
            raise must_be("options", "the same for all environments", self._options)
        observations, _ = self.envs.reset(seed=self._seeds, options=options)
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: NDArray[Any]) -> None:
        self._actions = actions

    def step_wait(
        self,
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.bool_], list[dict[str, Any]]]:
        observations, rewards, terminated, truncated, infos = self.envs.step(self._actions)
        dones = terminated | truncated
        each: list[dict[str, Any]] = [
            {"TimeLimit.truncated": only} for only in (truncated & ~terminated).tolist()
        ]
        for index in np.flatnonzero(dones):
            each[index]["terminal_observation"] = infos["final_obs"][index]
        return observations, rewards.astype(np.float32, copy=False), dones, each

    def get_attr(self, attr_name: str, indices: Indices = None) -> list[Any]:
        values = self.envs.get_attr(attr_name)
        return [values[index] for index in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Indices = None) -> None:
        """Set a parameter or the state of these environments, see :class:`AcrobotVectorEnv`.

        A parameter that is or will be drawn can only be set in all.
        """
        values = list(self.envs.get_attr(attr_name))
        chosen = np.arange(self.num_envs)[list(self._get_indices(indices))]
        is_drawn = isinstance(value, Drawn) or isinstance(getattr(self.envs, attr_name), Drawn)
        if is_drawn and 0 < len(set(chosen)) < self.num_envs:
            rule = "set in all environments, if it is or will be drawn"
            raise must_be(attr_name, rule, f"indices {indices}")
        for index in chosen:
            values[index] = value
        if len(chosen):
            self.envs.set_attr(attr_name, value if isinstance(value, Drawn) else values)
        self.observation_space = self.envs.single_observation_space
        self.action_space = self.envs.single_action_space

    def env_method(
        self, method_name: str, *args: Any, indices: Indices = None, **kwargs: Any
    ) -> list[Any]:
        """The results of a method, which can only be ``render``, for each of these."""
        if method_name != "render":
            raise must_be("method_name", '"render"', repr(method_name), AttributeError)
        values = self.envs.call("render", *args, **kwargs)
        return [values[index] for index in self._get_indices(indices)]

    def env_is_wrapped(
        self, wrapper_class: type[gymnasium.Wrapper], indices: Indices = None
    ) -> list[bool]:
        wrapped = [False] * self.num_envs  # they have no wrappers
        return [wrapped[index] for index in self._get_indices(indices)]

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        return self.env_method("render")

    def close(self) -> None:
        self.envs.close()
