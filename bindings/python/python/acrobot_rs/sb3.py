"""The vector environment for Stable-Baselines3, which does not take Gymnasium's.

This module needs ``stable-baselines3``, which the package does not install.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from numbers import Integral
from typing import Any

import cloudpickle
import gymnasium
import numpy as np
from gymnasium.error import NoAsyncCallError
from gymnasium.vector import AutoresetMode, VectorEnv
from numpy.typing import NDArray
from stable_baselines3.common.vec_env import VecEnv

from acrobot_rs.arrays import is_one_of, must_be, require
from acrobot_rs.native_vector import NativeVectorEnv
from acrobot_rs.parameters import Drawn

Indices = int | Iterable[int] | None


class AcrobotVecEnv(VecEnv):
    """A vector environment of this package, of either task, as Stable-Baselines3's ``VecEnv``.

    Its results are those of ``DummyVecEnv``: a step that ends an episode also resets, and the
    environment's info has ``"terminal_observation"`` and ``"TimeLimit.truncated"``.
    Stable-Baselines3's ``VecMonitor`` logs the returns of episodes. The differences:

    - ``envs`` is one vector environment, which has the ``metadata``. There are no buffers such as
      ``buf_obs``.
    - ``set_attr`` sets parameters and states, and the spaces follow. In ``DummyVecEnv`` it sets
      attributes of the outermost wrappers.
    - ``get_attr`` and ``has_attr`` know what ``envs.get_attr`` knows, and ``env_method`` only
      ``render``. There are no wrappers, so ``env_is_wrapped`` returns ``False``.
    - The options of ``set_options`` must be the same for all environments.
    - ``step_wait`` needs new actions from ``step_async``. A call after ``close`` raises an error.

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
        self.metadata = envs.metadata

    def reset(self) -> NDArray[np.float32]:
        """Begin all episodes, with new seeds of :meth:`seed` and options of ``set_options``."""
        # Their bytes, because a comparison with an array is no bool.
        if (
            len({*map(cloudpickle.dumps, self._options)}) != 1
            or len(self._options) != self.num_envs
        ):
            raise must_be("options", "the same for all environments", self._options)
        observations, _ = self.envs.reset(seed=self._seeds, options=self._options[0])
        self.reset_infos = self._infos()
        self._reset_seeds()
        self._reset_options()
        return observations

    def _infos(self) -> list[dict[str, Any]]:
        """The parameters that infos have."""
        names = self.envs.info_parameters
        columns = {name: self.envs.get_parameter(name).tolist() for name in names}
        return [{name: columns[name][index] for name in names} for index in range(self.num_envs)]

    def step_async(self, actions: NDArray[Any]) -> None:
        self._actions = actions

    def step_wait(
        self,
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.bool_], list[dict[str, Any]]]:
        if self._actions is None:
            raise NoAsyncCallError("call step_async with the actions before each step_wait", "step")
        actions, self._actions = self._actions, None
        # Those of the ended episode, if one ends, as in DummyVecEnv.
        each = self._infos()
        observations, rewards, terminated, truncated, infos = self.envs.step(actions)
        ended = terminated | truncated
        for info, only in zip(each, (truncated & ~terminated).tolist(), strict=True):
            info["TimeLimit.truncated"] = only
        new = self._infos() if ended.any() else []
        for index in np.flatnonzero(ended):
            each[index]["terminal_observation"] = infos["final_obs"][index]
            self.reset_infos[index] = new[index]
        return observations, rewards.astype(np.float32, copy=False), ended, each

    def _get_indices(self, indices: Indices) -> list[int]:
        if indices is None:
            return list(range(self.num_envs))
        rule = f"None or integers from {-self.num_envs} to {self.num_envs - 1}"
        require(Iterable | Integral, rule, indices=indices)
        chosen = [indices] if isinstance(indices, Integral) else list(indices)
        for index in chosen:
            require(Integral, rule, indices=index)
            if not -self.num_envs <= index < self.num_envs:
                raise must_be("indices", rule, index, IndexError)
        return chosen

    def get_attr(self, attr_name: str, indices: Indices = None) -> list[Any]:
        chosen, values = self._get_indices(indices), self.envs.get_attr(attr_name)
        return [values[index] for index in chosen]

    def set_attr(self, attr_name: str, value: Any, indices: Indices = None) -> None:
        """Set a parameter or the state of these environments. See :meth:`NativeVectorEnv.set_attr`.

        A parameter that is or will be drawn can only be set in all.
        """
        indices, values = self._get_indices(indices), self.envs.get_attr(attr_name)
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
        chosen = self._get_indices(indices)
        if not is_one_of(method_name, ["render"]):
            raise must_be("method_name", '"render"', repr(method_name), AttributeError)
        values = self.envs.call("render", *args, **kwargs)
        return [values[index] for index in chosen]

    def env_is_wrapped(
        self, wrapper_class: type[gymnasium.Wrapper], indices: Indices = None
    ) -> list[bool]:
        return [False for _ in self._get_indices(indices)]  # they have no wrappers

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        if self.render_mode == "rgb_array":
            return self.env_method("render")
        rule = "but this method assumes it is `rgb_array` to obtain images."
        warnings.warn(f"The render mode is {self.render_mode}, {rule}", stacklevel=2)
        return [None] * self.num_envs

    def close(self) -> None:
        self.envs.close()
