"""dm_control's ``acrobot-swingup``: swing up from anywhere, with friction, and stay up."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from numpy.typing import NDArray

from acrobot_rs._native import SWINGUP_BOUND, SWINGUP_MAX_STEPS
from acrobot_rs.env import AcrobotContinuousEnv
from acrobot_rs.native_vector import Floats
from acrobot_rs.parameters import Each, EachTorques, Parameters, _unknown
from acrobot_rs.vector import AcrobotContinuousVectorEnv

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from acrobot_rs.parameters import EachEquations, Equations, SwingupArguments, Torques


class Swingup(Parameters):
    """The parameters of the swing-up: those of the first task with dm_control's values, and others.

    The largest number in ``AVAIL_TORQUE`` is the torque of the action 1, and the smallest that of
    -1. The spaces do not change.
    """

    LINK_MOI_1: Each = 0.09557031250000002  #: about its centre of mass, kg m²; 0 or more
    LINK_MOI_2: Each = 0.09530365719649563  #: about its centre of mass, kg m²; 0 or more
    FRICTION_1: Each = 0.05  #: viscous, of the fixed joint, N m s/rad; 0 or more
    FRICTION_2: Each = 0.05  #: viscous, of the joint between the links, N m s/rad; 0 or more
    gravity: Each = 9.81
    dt: Each = 0.01
    MAX_VEL_1: Each = 1e30
    MAX_VEL_2: Each = 1e30
    AVAIL_TORQUE: EachTorques = (-2.0, 0.0, 2.0)

    _NAMES = (
        *(name for name in Parameters._NAMES if name != "LINK_MOI"),
        *("LINK_MOI_1", "LINK_MOI_2", "FRICTION_1", "FRICTION_2"),
    )
    _TASK = "swingup"
    _BOUND = SWINGUP_BOUND
    _ACTION = "a number from -1 to 1"

    @property
    def LINK_MOI(self) -> float:  # type: ignore[override]
        """Each link has its own."""
        raise _unknown(type(self), "LINK_MOI")

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

    >>> import gymnasium as gym
    >>> import acrobot_rs
    >>> gym.register_envs(acrobot_rs)
    >>> env = gym.make("acrobot_rs/AcrobotSwingup-v0", FRICTION_1=0.1)
    >>> observation, info = env.reset(seed=42)
    >>> observation, reward, terminated, truncated, info = env.step([0.5])
    >>> 0.0 <= reward <= 1.0
    True
    """

    metadata: dict[str, Any] = {**AcrobotContinuousEnv.metadata, "render_fps": 100}

    if TYPE_CHECKING:  # Many environments accept more.
        LINK_MOI_1: float
        LINK_MOI_2: float
        FRICTION_1: float
        FRICTION_2: float
        gravity: float
        dt: float
        MAX_VEL_1: float
        MAX_VEL_2: float
        AVAIL_TORQUE: Torques

        def __init__(
            self,
            render_mode: str | None = None,
            **parameters: Unpack[SwingupArguments[float, Torques, Equations]],
        ) -> None: ...

    def _begin(self, low: float, high: float, given: NDArray[Any] | None) -> NDArray[np.float32]:
        drawn = np.array([*self.np_random.uniform(low, high, 2), 0.0, 0.0])
        self.state = drawn if given is None else given
        return self._native.observation()


class AcrobotSwingupSparseEnv(AcrobotSwingupEnv):
    """dm_control's ``acrobot-swingup_sparse``: no reward beyond 0.2 m from the target."""

    _TASK = "swingup_sparse"


class AcrobotSwingupVectorEnv(
    Swingup, AcrobotContinuousVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]
):
    """Many :class:`AcrobotSwingupEnv`, with actions of shape ``(num_envs, 1)``.

    All else is as in :class:`acrobot_rs.AcrobotVectorEnv`, without ``gymnasium_episodes``.

    >>> import acrobot_rs
    >>> envs = acrobot_rs.AcrobotSwingupVectorEnv(num_envs=1024, FRICTION_1=0.1)
    >>> envs.reset(seed=42)[0].shape
    (1024, 6)
    """

    metadata: dict[str, Any] = {**AcrobotContinuousVectorEnv.metadata, "render_fps": 100}

    def __init__(
        self,
        num_envs: int = 1,
        max_episode_steps: int | None = SWINGUP_MAX_STEPS,
        render_mode: str | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        threads: int | None = 1,
        info_parameters: Sequence[str] = (),
        float64: bool = False,
        **parameters: Unpack[SwingupArguments[Each, EachTorques, EachEquations]],
    ) -> None:
        """Make environments. The arguments are those of :class:`acrobot_rs.AcrobotVectorEnv`."""
        self._check_arguments(parameters)  # gymnasium_episodes is none
        super().__init__(
            *(num_envs, max_episode_steps, render_mode, autoreset_mode, copy),
            *(False, threads, info_parameters, float64),
            **parameters,
        )


class AcrobotSwingupSparseVectorEnv(
    AcrobotSwingupVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]
):
    """Many :class:`AcrobotSwingupSparseEnv`."""

    _TASK = "swingup_sparse"
