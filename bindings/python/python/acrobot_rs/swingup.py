"""dm_control's ``acrobot-swingup``: swing up from anywhere, with friction, and stay up."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import ArrayLike, NDArray

from acrobot_rs._native import SWINGUP_BOUND, SWINGUP_MAX_STEPS
from acrobot_rs.env import AcrobotContinuousEnv
from acrobot_rs.parameters import Parameters
from acrobot_rs.vector import AcrobotContinuousVectorEnv, Bools, Floats


class Swingup(Parameters):
    """The parameters of the swing-up: those of the first task with dm_control's values.

    The largest number in ``AVAIL_TORQUE`` is the torque of the action 1, and the smallest that of
    -1. The spaces do not change.
    """

    LINK_MOI = None
    LINK_MOI_1: Any = 0.09557031250000002
    LINK_MOI_2: Any = 0.09530365719649563
    DAMPING_1: Any = 0.05
    DAMPING_2: Any = 0.05
    gravity: Any = 9.81
    dt: Any = 0.01
    MAX_VEL_1: Any = 1e30
    MAX_VEL_2: Any = 1e30
    AVAIL_TORQUE: Any = (-2.0, 0.0, 2.0)

    _TASK = "swingup"
    _BOUND = SWINGUP_BOUND
    _ACTION = "a number from -1 to 1"

    def _limits(self) -> tuple[float, float, float, float]:
        return -1.0, 1.0, math.inf, math.inf


class AcrobotSwingupEnv(Swingup, AcrobotContinuousEnv):
    """dm_control's ``acrobot-swingup``, step by step within the rounding of ``float64``.

    The action is an array of one number from -1 to 1: a torque of up to 2 N m between the links,
    for 0.01 s. A number beyond acts as the nearest bound. Both joints have friction.

    The observation, ``float32`` of shape ``(6,)``, has the sines of both links' angles from
    upright, their cosines, and the velocities of theta1 and theta2, rad/s: dm_control's
    ``orientations`` and ``velocity``.

    The reward is 1 up to 0.2 m from the target, 2 m above the joint, and falls to 0.1 at 1.2 m. An
    episode begins anywhere at rest: both angles are drawn from -pi to pi, or from
    ``options["low"]`` to ``options["high"]`` of ``reset``, rad. No state ends it;
    ``gymnasium.make`` truncates it after 1,000 steps.

    All else is as in :class:`acrobot_rs.AcrobotEnv`. The parameters are those of :class:`Swingup`.
    """

    def _draw(self, low: float, high: float) -> NDArray[np.float64]:
        return np.array([*self.np_random.uniform(low, high, 2), 0.0, 0.0])


class AcrobotSwingupSparseEnv(AcrobotSwingupEnv):
    """dm_control's ``acrobot-swingup_sparse``: no reward beyond 0.2 m from the target."""

    def step(
        self, action: ArrayLike
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        observation, reward, *others = super().step(action)
        return observation, float(reward == 1.0), *others


class AcrobotSwingupVectorEnv(
    Swingup, AcrobotContinuousVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]
):
    """Many :class:`AcrobotSwingupEnv`, with actions of shape ``(num_envs, 1)``.

    All else is as in :class:`acrobot_rs.AcrobotVectorEnv`, without ``gymnasium_episodes``.
    """

    def __init__(
        self, num_envs: int = 1, max_episode_steps: int | None = SWINGUP_MAX_STEPS, **others: Any
    ) -> None:
        """Make environments. Other arguments are those of :class:`acrobot_rs.AcrobotVectorEnv`."""
        super().__init__(num_envs, max_episode_steps, **others)


class AcrobotSwingupSparseVectorEnv(
    AcrobotSwingupVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]
):
    """Many :class:`AcrobotSwingupSparseEnv`."""

    def step(
        self, actions: ArrayLike
    ) -> tuple[Floats, NDArray[np.floating[Any]], Bools, Bools, dict[str, Any]]:
        observations, rewards, *others = super().step(actions)
        return observations, (rewards == 1.0).astype(np.float32), *others
