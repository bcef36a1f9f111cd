"""Staying upright: a task without an end."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from acrobot_rs._native import BALANCE_BOUND, BALANCE_MAX_STEPS
from acrobot_rs.env import AcrobotContinuousEnv
from acrobot_rs.parameters import Each, EachEquations, EachTorques, Equations, Parameters, Torques
from acrobot_rs.vector import AcrobotContinuousVectorEnv, Floats
from acrobot_rs.vector import ManyEquations, ManyTorques, Numbers


class Balance(Parameters[Each, EachTorques, EachEquations]):
    """The parameters of the first task, stepped every 0.02 s, with a motor of 10 N m."""

    dt: Each = 0.02
    AVAIL_TORQUE: EachTorques = (-10.0, 0.0, 10.0)

    _TASK = "balance"
    _BOUND = BALANCE_BOUND


class AcrobotBalanceEnv(Balance[float, Torques, Equations], AcrobotContinuousEnv):
    """Stay upright: Gymnasium's acrobot with a torque of up to 10 N m as its action.

    The reward is ``(2 - cos(theta1) - cos(theta1 + theta2)) / 4``: 1 upright, 0 hanging.

    An episode begins upright, plus a uniform draw from -0.05 to 0.05 for each number of the state,
    or from ``options["low"]`` to ``options["high"]`` of ``reset``. No state ends it;
    ``gymnasium.make`` truncates it after 500 steps, 10 s.

    All else is as in :class:`acrobot_rs.AcrobotContinuousEnv`. It computes in ``float64`` with the
    same bits on every machine.

    >>> import gymnasium as gym
    >>> import acrobot_rs
    >>> gym.register_envs(acrobot_rs)
    >>> env = gym.make("acrobot_rs/AcrobotBalance-v0")
    >>> observation, info = env.reset(seed=42)
    >>> observation, reward, terminated, truncated, info = env.step([0.5])
    >>> 0.99 < reward <= 1.0
    True
    """

    def _begin(self, low: float, high: float, given: NDArray[Any] | None) -> NDArray[np.float32]:
        drawn = self.np_random.uniform(low, high, 4).astype(np.float32)
        drawn[0] += np.float32(np.pi)
        self.state = drawn if given is None else given
        return self._native.observation()


class AcrobotBalanceVectorEnv(
    Balance[Numbers, ManyTorques, ManyEquations],
    AcrobotContinuousVectorEnv,
    VectorEnv[Floats, NDArray[Any], np.ndarray],
):
    """Many :class:`AcrobotBalanceEnv`, with actions of shape ``(num_envs, 1)``.

    All else is as in :class:`acrobot_rs.AcrobotVectorEnv`, without ``gymnasium_episodes``.
    """

    def __init__(
        self, num_envs: int = 1, max_episode_steps: int | None = BALANCE_MAX_STEPS, **others: Any
    ) -> None:
        """Make environments. Other arguments are those of :class:`acrobot_rs.AcrobotVectorEnv`."""
        super().__init__(num_envs, max_episode_steps, gymnasium_episodes=False, **others)
