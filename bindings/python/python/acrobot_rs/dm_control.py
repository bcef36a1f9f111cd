"""dm_control's domain ``acrobot`` with its interface, that of ``dm_env``, and without MuJoCo.

This module needs ``dm-env``, which the package does not install.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acrobot_rs.arrays import must_be
from acrobot_rs.swingup import AcrobotSwingupEnv, AcrobotSwingupSparseEnv

try:
    import dm_env
    from dm_env import specs
except ImportError as error:
    raise ImportError("dm_env is not installed, run `pip install dm-env`") from error

_TASKS = {"swingup": AcrobotSwingupEnv, "swingup_sparse": AcrobotSwingupSparseEnv}


def load(
    domain_name: str,
    task_name: str,
    task_kwargs: Mapping[str, Any] | None = None,
    environment_kwargs: Mapping[str, Any] | None = None,
    visualize_reward: bool = False,
) -> Environment:
    """Make an environment as ``dm_control.suite.load("acrobot", "swingup")`` does.

    Both kinds of arguments are those of :class:`Environment`. ``visualize_reward`` changes only
    colours, and this environment draws nothing.
    """
    if domain_name != "acrobot":
        raise must_be("domain_name", '"acrobot"', repr(domain_name))
    return Environment(task_name, **(task_kwargs or {}), **(environment_kwargs or {}))


class Environment(dm_env.Environment):
    """dm_control's environment: its states and observations within 1e-12 a step, rewards 1e-6.

    Its seeds give dm_control's initial states.
    """

    def __init__(
        self,
        task_name: str,
        *,
        random: int | np.random.RandomState | None = None,
        time_limit: float = 10.0,
        control_timestep: float | None = None,
        n_sub_steps: float | None = None,
        flat_observation: bool = False,
        legacy_step: bool = True,
        **parameters: Any,
    ) -> None:
        """Make an environment.

        Args:
            task_name: ``"swingup"`` or ``"swingup_sparse"``.
            random: The seed of the initial states, or their generator.
            time_limit: The length of an episode, s; ``math.inf`` for no limit.
            control_timestep: The duration of a step, s: a multiple of ``dt``, by default ``dt``.
            n_sub_steps: Instead, this multiple.
            flat_observation: Whether the observation is one array, ``"observations"``.
            legacy_step: ``True``: observations and rewards are of the new state.
            **parameters: Those of :class:`acrobot_rs.AcrobotSwingupEnv`.
        """
        if task_name not in _TASKS:
            raise must_be("task_name", f"one of {list(_TASKS)}", repr(task_name))
        if not time_limit > 0:
            raise must_be("time_limit", "above 0 s", time_limit)
        if not legacy_step:
            raise must_be("legacy_step", "True, for observations of the new state", legacy_step)
        if control_timestep is not None and n_sub_steps is not None:
            raise must_be("n_sub_steps", "None with control_timestep", n_sub_steps)
        is_generator = isinstance(random, np.random.RandomState)
        self._random = random if is_generator else np.random.RandomState(random)
        #: The same environment for Gymnasium, which has the parameters and ``state``.
        self.gymnasium = _TASKS[task_name](**parameters)
        if n_sub_steps is None:
            n_sub_steps = 1 if control_timestep is None else control_timestep / self.gymnasium.dt
        self._sub_steps = round(n_sub_steps)
        if self._sub_steps < 1 or abs(n_sub_steps - self._sub_steps) > 1e-8:
            name = "n_sub_steps or control_timestep / dt"
            raise must_be(name, "an integer of at least 1", n_sub_steps)
        self._time_limit = time_limit
        self._flat = flat_observation
        self._steps = 0
        self._is_over = True

    def reset(self) -> dm_env.TimeStep:
        """Begin an episode at rest, with both angles drawn from -pi to pi."""
        shoulder, elbow = self._random.uniform(-np.pi, np.pi, 2)
        self.gymnasium.reset(options={"state": [shoulder + np.pi, elbow, 0.0, 0.0]})
        self._steps, self._is_over = 0, False
        return dm_env.restart(self._observation())

    def step(self, action: ArrayLike) -> dm_env.TimeStep:
        """Apply a torque, from -1 to 1 times the largest. After an episode's end, reset instead."""
        if self._is_over:
            return self.reset()
        for _ in range(self._sub_steps):
            _, reward, *_ = self.gymnasium.step(np.atleast_1d(action))
        self._steps += 1
        self._is_over = self._steps >= self._time_limit / self.control_timestep()
        result = dm_env.truncation if self._is_over else dm_env.transition
        return result(reward, self._observation(), discount=1.0)

    def _observation(self) -> dict[str, NDArray[np.float64]]:
        theta1, theta2, *velocity = self.gymnasium.state
        angles = np.array([theta1, theta1 + theta2])  # 0 hangs; dm_control's 0 is upright
        orientations = -np.concatenate([np.sin(angles), np.cos(angles)])
        if self._flat:
            return {"observations": np.concatenate([orientations, velocity])}
        return {"orientations": orientations, "velocity": np.array(velocity)}

    def observation_spec(self) -> dict[str, specs.Array]:
        shapes = {"observations": 6} if self._flat else {"orientations": 4, "velocity": 2}
        return {name: specs.Array((size,), float, name) for name, size in shapes.items()}

    def action_spec(self) -> specs.BoundedArray:
        return specs.BoundedArray((1,), float, [-1.0], [1.0])

    def control_timestep(self) -> float:
        """The duration of a step, s."""
        return self.gymnasium.dt * self._sub_steps
