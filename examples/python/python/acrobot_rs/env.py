"""The single environment, bit-identical to Gymnasium's."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike, NDArray

from acrobot_rs._native import Acrobot
from acrobot_rs.parameters import Parameters, reset_bounds


class AcrobotEnv(Parameters, gymnasium.Env[NDArray[np.float32], np.int64]):
    """Gymnasium's ``Acrobot-v1``: two links hang from a joint, and a motor between the links must swing them up.

    ## Description

    A seed gives the same initial states, torque noise and episode ends as in Gymnasium's environment. On x86-64 Linux
    with glibc, states, rewards and observations are bit-identical, except that the observation of an initial state may
    differ by one unit in the last place.

    ## Action Space

    ``Discrete(3)``: a torque of -1 (action 0), 0 (1) or 1 N m (2) between the links.

    ## Observation Space

    ``Box`` of shape ``(6,)``, ``float32``:

    | Num | Observation                        | Min   | Max  |
    |-----|------------------------------------|-------|------|
    | 0   | cosine of theta1                   | -1    | 1    |
    | 1   | sine of theta1                     | -1    | 1    |
    | 2   | cosine of theta2                   | -1    | 1    |
    | 3   | sine of theta2                     | -1    | 1    |
    | 4   | angular velocity of theta1, rad/s  | -4 pi | 4 pi |
    | 5   | angular velocity of theta2, rad/s  | -9 pi | 9 pi |

    theta1 is the angle of link 1, 0 hanging straight down. theta2 is the angle of link 2 relative to link 1.

    ## Rewards

    -1 for each step, and 0 for the step that reaches the goal. The threshold is -100.

    ## Starting State

    All four numbers of the state are drawn uniformly from -0.1 to 0.1 (rad, rad/s), or from ``options["low"]`` to
    ``options["high"]`` of ``reset``.

    ## Episode End

    1. Termination: ``-cos(theta1) - cos(theta1 + theta2) > 1``. The tip is then more than one link above the joint.
    2. Truncation: after 500 steps, by ``gymnasium.make``.

    ## Arguments

    ``render_mode``: ``None``, ``"rgb_array"`` (an array of shape ``(500, 500, 3)``, ``uint8``) or ``"ansi"`` (20 lines
    of braille characters and a line of numbers).

    >>> import gymnasium as gym
    >>> import acrobot_rs
    >>> env = gym.make("acrobot_rs/Acrobot-v1")
    >>> env.unwrapped.book_or_nips = "nips"
    >>> env.reset(seed=123, options={"low": -0.2, "high": 0.2})[0].shape
    (6,)
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "ansi"], "render_fps": 15}

    _native: Acrobot
    #: Whether the observation is the state itself, as in ``Acrobot-v0``.
    _ANGLES = False

    def __init__(self, render_mode: str | None = None) -> None:
        """Make an environment. Reset it before its first step.

        Raises:
            ValueError: If the render mode is unknown, or if a subclass sets an invalid parameter.
        """
        super().__init__(Acrobot(self._ANGLES), render_mode)
        self.action_space = spaces.Discrete(3)
        self.observation_space = self._observation_space

    @property
    def state(self) -> NDArray[np.float64] | None:
        """theta1, theta2 (rad) and their velocities (rad/s), of shape ``(4,)``; ``None`` before the first reset.

        This is a read-only copy. To set the state, assign four finite numbers.
        """
        state = self._native.state
        if state is not None:
            state.flags.writeable = False
        return state

    @state.setter
    def state(self, state: ArrayLike) -> None:
        self._native.state = np.asarray(state, dtype=np.float64)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: Seeds the generator: an integer of at least 0, of any size. With ``None`` its stream continues.
            options: ``"low"`` and ``"high"``, the bounds of the initial state, rad and rad/s; by default -0.1 and 0.1.

        Returns:
            The observation of the initial state, and an empty info.

        Raises:
            ValueError: If a bound is not a finite number, or if low is above high. Nothing changes then.
        """
        low, high = reset_bounds(options)
        super().reset(seed=seed)
        # Gymnasium rounds initial states to float32.
        self.state = self.np_random.uniform(low, high, 4).astype(np.float32)
        return self._native.observation(), {}

    def step(self, action: int | np.integer[Any]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Apply a torque for ``dt``.

        Args:
            action: 0, 1 or 2: a torque of -1, 0 or 1 N m.

        Returns:
            The observation; the reward, -1.0, or 0.0 if the step reaches the goal; whether it does; ``False``, because the
            wrapper of ``gymnasium.make`` counts the steps and truncates; and an empty info.

        Raises:
            gymnasium.error.InvalidAction: If the action is not 0, 1 or 2. Nothing changes then.
            AssertionError: If the environment was never reset.
        """
        noise = self.torque_noise_max
        if noise:
            # This rejects an invalid action before noise is drawn for it.
            self._native.torque(action)
            noise = self.np_random.uniform(-noise, noise)
        return self._native.step(action, noise)

    def render(self) -> NDArray[np.uint8] | str | None:
        """An array of shape ``(500, 500, 3)`` or a text, depending on the render mode.

        Without a render mode, warns and returns ``None``.
        """
        if self.render_mode is None:
            self._warn_of_no_render_mode()
            return None
        return self._native.render(self.render_mode)


class AcrobotV0Env(AcrobotEnv):
    """``Acrobot-v0``, which Gymnasium has removed: like :class:`AcrobotEnv`, but the observation is the state.

    The observation is theta1, theta2 (within pi, rad) and their velocities (within 4 pi and 9 pi, rad/s), ``float32`` of
    shape ``(4,)``. ``gymnasium.make`` truncates episodes after 200 steps.
    """

    _ANGLES = True

    @property
    def _observation_space(self) -> spaces.Box[np.float32]:
        high = np.array([np.pi, np.pi, *self._highest_velocities], dtype=np.float32)
        return spaces.Box(-high, high, dtype=np.float32)
