"""The single environment, bit-identical to Gymnasium's."""

from __future__ import annotations

import math
from typing import Any

import gymnasium
import numpy as np
from gymnasium.error import InvalidAction
from numpy.typing import ArrayLike, NDArray

from acrobot_rs._native import BALANCE_BOUND, Acrobot
from acrobot_rs.arrays import LARGEST, finite, must_be, numbers, plain_seed, read_only, reset_bounds
from acrobot_rs.parameters import Parameters


class AcrobotEnv(Parameters, gymnasium.Env[NDArray[np.float32], np.int64]):
    """Gymnasium's ``Acrobot-v1``: a motor between two hanging links must swing them up.

    ## Description

    A seed gives the same episodes as in Gymnasium's environment. On Linux with glibc, states,
    rewards and observations are bit-identical.

    ## Action Space

    ``Discrete(3)``: a torque of -1 (action 0), 0 (1) or 1 N m (2) between the links. With ``n``
    numbers in ``AVAIL_TORQUE`` it is ``Discrete(n)``.

    ## Observation Space

    ``Box`` of shape ``(6,)``, ``float32``: the cosine and the sine of theta1, those of theta2, and
    the velocities of both, rad/s, within 4 pi and 9 pi. theta1 is the angle of link 1, 0 hanging
    straight down, theta2 that of link 2 from link 1.

    ## Rewards

    -1 for each step, and 0 for the step that reaches the goal. The threshold is -100.

    ## Starting State

    All four numbers of the state are drawn uniformly from -0.1 to 0.1 (rad, rad/s), or from
    ``options["low"]`` to ``options["high"]`` of ``reset``.

    ## Episode End

    1. Termination: ``-cos(theta1) - cos(theta1 + theta2) > 1``. The tip is then more than one link
       above the joint.
    2. Truncation: after 500 steps, by ``gymnasium.make``.

    ## Arguments

    ``render_mode``: ``None``, ``"rgb_array"`` or ``"ansi"`` (braille characters), and with
    ``gymnasium.make`` also ``"human"`` (a window, by pygame). And parameters, for example
    ``LINK_MASS_1=2.0``.

    A rejected call raises an error that says what is valid, and changes nothing.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "ansi"], "render_fps": 15}

    _native: Acrobot

    def __init__(self, render_mode: str | None = None, **parameters: Any) -> None:
        """Make an environment. Reset it before its first step."""
        super().__init__(Acrobot(self._CONTINUOUS, self._TASK), render_mode, parameters)

    @property
    def state(self) -> NDArray[np.float64] | None:
        """theta1, theta2 (rad) and their velocities (rad/s); ``None`` before the first reset.

        A read-only copy. Assigning four finite numbers sets the state.
        """
        state = self._native.state
        return None if state is None else read_only(np.array(state))

    @state.setter
    def state(self, state: ArrayLike) -> None:
        self._native.state = numbers("state", "four finite numbers", state, (4,)).tolist()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: Seeds the generator: an integer of at least 0, of any size. With ``None`` its
                stream continues.
            options: ``"low"`` and ``"high"``, the bounds of the initial state, rad and rad/s. Or
                ``"state"``, the initial state itself, which replaces the drawn one.

        Returns:
            The observation of the initial state, and an empty info.
        """
        options = options or {}
        low, high = reset_bounds(options, self._BOUND)
        seed = plain_seed(seed)
        given = None
        if "state" in options:
            rule = "four finite numbers in the range of float32"
            given = finite("state", rule, options["state"], (4,), LARGEST)
        super().reset(seed=seed)
        drawn = self._draw(low, high)
        is_measured = any(getattr(self, name) is not None for name in self._INSTRUMENTS)
        if is_measured:
            self._native.draw_instruments(int(self.np_random.integers(2**63)))
        self.state = state = drawn if given is None else given
        if self._TASK != "gymnasium" or is_measured:
            return self._native.observation(), {}
        s = state.astype(np.float32)
        # Gymnasium's calls of NumPy, whose float32 sines are its own.
        sines = [function(angle) for angle in s[:2] for function in (np.cos, np.sin)]
        return np.array([*sines, *s[2:]], dtype=np.float32), {}

    def _draw(self, low: float, high: float) -> NDArray[Any]:
        """An initial state, which Gymnasium rounds to float32."""
        return self.np_random.uniform(low, high, 4).astype(np.float32)

    def step(
        self, action: ArrayLike
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Apply a torque for ``dt``.

        Args:
            action: An element of the action space. ``Box``: an array of one torque, N m.

        Returns:
            The observation; the reward; whether the step reaches the goal; ``False``, because the
            wrapper of ``gymnasium.make`` truncates; and an empty info.
        """
        return self._native.step(self, action)

    def get_parameter(self, name: str) -> Any:
        """A parameter, or the number of an instrument that the last reset drew; 0 is ideal."""
        return self._native.instrument(name) if name in self._INSTRUMENTS else getattr(self, name)

    def render(self) -> NDArray[np.uint8] | str | None:
        """An array of shape ``(500, 500, 3)`` or a text.

        Without a render mode, warns and returns ``None``.
        """
        if self.render_mode is None:
            self._warn_of_no_render_mode()
            return None
        return self._native.render(self.render_mode)


class AcrobotContinuousEnv(AcrobotEnv):
    """:class:`AcrobotEnv` with any torque between two bounds as its action.

    The action space is a ``Box`` of shape ``(1,)``, ``float32``: a torque in N m. Its bounds are
    the smallest and the largest number in ``AVAIL_TORQUE``, by default -1 and 1. A torque outside
    is clipped.

    >>> import acrobot_rs
    >>> acrobot_rs.AcrobotContinuousEnv(AVAIL_TORQUE=[-2.0, 2.0]).action_space
    Box(-2.0, 2.0, (1,), float32)
    """

    _CONTINUOUS = True

    def _torque(self, action: ArrayLike) -> float:
        """The number in an action that is no array of one ``float32``, for the native part."""
        rule = f"{self._ACTION}, as an array of shape (1,)"
        torque = float(numbers("action", rule, action, (1,), error=InvalidAction)[0])
        if math.isnan(torque):
            raise must_be("action", rule, repr(action), InvalidAction)
        return torque


class Balance(Parameters):
    """The parameters of the task to stay upright."""

    dt = 0.02
    AVAIL_TORQUE = (-10.0, 0.0, 10.0)

    _TASK = "balance"
    _BOUND = BALANCE_BOUND


class AcrobotBalanceEnv(Balance, AcrobotContinuousEnv):
    """Stay upright: :class:`AcrobotContinuousEnv` with a motor of 10 N m and steps of 0.02 s.

    The reward is ``(2 - cos(theta1) - cos(theta1 + theta2)) / 4``: 1 upright, 0 hanging. An episode
    begins upright, plus a uniform draw from -0.05 to 0.05 for each number of the state. No state
    ends it; ``gymnasium.make`` truncates it after 500 steps.
    """

    def _draw(self, low: float, high: float) -> NDArray[Any]:
        drawn = super()._draw(low, high)
        drawn[0] += np.float32(np.pi)
        return drawn
