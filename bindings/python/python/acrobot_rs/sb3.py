"""The vector environment for Stable-Baselines3, which does not take Gymnasium's.

This module needs ``stable-baselines3``, which the package does not install.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.error import NoAsyncCallError
from gymnasium.vector import AutoresetMode, VectorEnv
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv

from acrobot_rs.arrays import must_be
from acrobot_rs.native_vector import NativeVectorEnv
from acrobot_rs.parameters import Drawn

Indices = int | Iterable[int] | None


class AcrobotVecEnv(VecEnv):
    """A vector environment of this package, of either task, as Stable-Baselines3's ``VecEnv``.

    Its results are those of ``DummyVecEnv``: a step that ends an episode also resets, and the
    environment's info has ``"terminal_observation"`` and ``"TimeLimit.truncated"``.
    Stable-Baselines3's ``VecMonitor`` logs the returns of episodes.

    >>> import acrobot_rs
    >>> from acrobot_rs.sb3 import AcrobotVecEnv
    >>> envs = acrobot_rs.AcrobotVectorEnv(num_envs=64, autoreset_mode="SameStep")
    >>> AcrobotVecEnv(envs).reset().shape
    (64, 6)
    """

    def __init__(self, envs: VectorEnv[Any, Any, Any]) -> None:
        """Take over environments of this package with ``autoreset_mode="SameStep"``."""
        if not isinstance(envs, NativeVectorEnv):
            message = "AcrobotVecEnv needs an AcrobotVectorEnv from gym.make_vec"
            raise TypeError(f"{message}, got {type(envs).__name__}")
        if (mode := envs.autoreset_mode) is not AutoresetMode.SAME_STEP:
            raise must_be("autoreset_mode", '"SameStep"', f'"{mode.value}"')
        self.envs = envs
        self._actions: NDArray[Any] | None = None
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)

    def reset(self) -> NDArray[np.float32]:
        """Begin all episodes, with new seeds of :meth:`seed` and options of ``set_options``."""
        if any(options != self._options[0] for options in self._options):
            raise ValueError("options must be the same for all environments")
        observations, _ = self.envs.reset(seed=self._seeds, options=dict(self._options[0]))
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: NDArray[Any]) -> None:
        self._actions = actions

    def step_wait(
        self,
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.bool_], list[dict[str, Any]]]:
        if self._actions is None:
            raise NoAsyncCallError("call step_async with the actions before each step_wait", "step")
        actions, self._actions = self._actions, None
        # Those of the ended episode, if one ends, as in DummyVecEnv.
        names = self.envs.info_parameters
        parameters = {name: self.envs.get_parameter(name).tolist() for name in names}
        observations, rewards, terminated, truncated, infos = self.envs.step(actions)
        ended = terminated | truncated
        each: list[dict[str, Any]] = [
            {"TimeLimit.truncated": only, **{name: parameters[name][index] for name in names}}
            for index, only in enumerate((truncated & ~terminated).tolist())
        ]
        for index in np.flatnonzero(ended):
            each[index]["terminal_observation"] = infos["final_obs"][index]
        return observations, rewards.astype(np.float32, copy=False), ended, each

    def get_attr(self, attr_name: str, indices: Indices = None) -> list[Any]:
        return self.env_method(attr_name, indices=indices)

    def set_attr(self, attr_name: str, value: Any, indices: Indices = None) -> None:
        """Set a parameter or the state of these environments. See :meth:`NativeVectorEnv.set_attr`.

        A parameter that is or will be drawn can only be set in all.
        """
        values = self.envs.get_attr(attr_name)
        indices = list(self._get_indices(indices))
        chosen = np.zeros(self.num_envs, np.bool_)
        chosen[indices] = True
        if isinstance(value, Drawn) and chosen.all():
            self.envs.set_attr(attr_name, value)
        elif chosen.any():
            is_drawn = isinstance(value, Drawn) or isinstance(getattr(self.envs, attr_name), Drawn)
            if is_drawn and not chosen.all():
                rule = "set in all environments, if it is or will be drawn"
                raise must_be(attr_name, rule, f"indices {indices}")
            both = zip(chosen, values, strict=True)
            self.envs.set_attr(attr_name, [value if new else old for new, old in both])
        self.observation_space = self.envs.single_observation_space
        self.action_space = self.envs.single_action_space

    def env_method(
        self, method_name: str, *args: Any, indices: Indices = None, **kwargs: Any
    ) -> list[Any]:
        """The results of a method, which can only be ``render``, for each of these."""
        values = self.envs.call(method_name, *args, **kwargs)
        return [values[index] for index in self._get_indices(indices)]

    def env_is_wrapped(
        self, wrapper_class: type[gymnasium.Wrapper], indices: Indices = None
    ) -> list[bool]:
        return [False for _ in self._get_indices(indices)]  # they have no wrappers

    def get_images(self) -> Sequence[NDArray[np.uint8] | str | None]:
        return self.envs.render() or [None] * self.num_envs

    def close(self) -> None:
        self.envs.close()
