"""What the single and the vector environment share: parameters, the observation space and reset bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from gymnasium import logger, spaces
from gymnasium.envs.classic_control.utils import maybe_parse_reset_bounds

from acrobot_rs._native import Acrobot, Batch, check_reset_bounds


class Parameters:
    """The parameters of the physics, with Gymnasium's names. Set them on an environment or in a subclass.

    A value that is set on an environment is checked immediately and acts from the next step. A value that is set on a class
    is checked when an environment is made. An invalid value raises a ``ValueError`` that says what is valid.
    """

    #: Duration of one step, s; above 0.
    dt: float = 0.2
    #: Length of link 1, m; above 0.
    LINK_LENGTH_1: float = 1.0
    #: Length of link 2, m; above 0. It changes pictures only: neither the equations of motion nor the goal contain it.
    LINK_LENGTH_2: float = 1.0
    #: Mass of link 1, kg; above 0.
    LINK_MASS_1: float = 1.0
    #: Mass of link 2, kg; above 0.
    LINK_MASS_2: float = 1.0
    #: Distance of link 1's centre of mass from its joint, m; 0 or more.
    LINK_COM_POS_1: float = 0.5
    #: Distance of link 2's centre of mass from its joint, m; 0 or more.
    LINK_COM_POS_2: float = 0.5
    #: Moment of inertia of each link about its centre of mass, kg m²; 0 or more.
    LINK_MOI: float = 1.0
    #: Bound of link 1's velocity after a step, rad/s; above 0.
    MAX_VEL_1: float = 4 * math.pi
    #: Bound of link 2's velocity, relative to link 1, after a step, rad/s; above 0.
    MAX_VEL_2: float = 9 * math.pi
    #: Torques of the actions 0, 1 and 2, N m.
    AVAIL_TORQUE: Sequence[float] = (-1.0, 0.0, 1.0)
    #: Each step adds a uniform draw from [-torque_noise_max, torque_noise_max) to the torque, N m; 0 or more. 0 draws nothing.
    torque_noise_max: float = 0.0
    #: The equations of motion: those of Sutton and Barto's book, or those printed in the 1996 paper.
    book_or_nips: Literal["book", "nips"] = "book"

    metadata: dict[str, Any]
    spec: Any
    render_mode: str | None
    _native: Acrobot | Batch

    def __init__(self, native: Acrobot | Batch, render_mode: str | None) -> None:
        """Pass the class's parameters, which a subclass may have changed, to the native part."""
        modes = self.metadata["render_modes"]
        # A comparison with an array is no bool.
        if render_mode is not None and not (isinstance(render_mode, str) and render_mode in modes):
            raise ValueError(f"render_mode must be None or one of {modes}, got {render_mode!r}")
        self.render_mode = render_mode
        self._native = native
        for name in _NAMES:
            native.set(name, getattr(self, name))

    def __setattr__(self, name: str, value: Any) -> None:
        """Check a parameter and set it."""
        if name in _NAMES:
            self._native.set(name, value)
            # A tuple, because a changed element of a list would have no effect.
            value = tuple(value) if name == "AVAIL_TORQUE" else value
        super().__setattr__(name, value)

    def __delattr__(self, name: str) -> None:
        """Set a parameter back to the value of its class. ``unittest.mock.patch.object`` does this when it ends."""
        if name in _NAMES and name in vars(self):
            self._native.set(name, getattr(type(self), name))
        super().__delattr__(name)

    def _warn_of_no_render_mode(self) -> None:
        logger.warn(
            "render returns None, because the environment was made without a render mode. Make it with one: "
            f'gymnasium.make("{self.spec.id if self.spec else "acrobot_rs/Acrobot-v1"}", render_mode="rgb_array")'
        )

    @property
    def _highest_velocities(self) -> tuple[float, float]:
        """The largest velocities after a step, or after a reset with the default bounds of 0.1, rad/s."""
        return max(self.MAX_VEL_1, 0.1), max(self.MAX_VEL_2, 0.1)

    @property
    def _observation_space(self) -> spaces.Box[np.float32]:
        high = np.array([1.0, 1.0, 1.0, 1.0, *self._highest_velocities], dtype=np.float32)
        return spaces.Box(-high, high, dtype=np.float32)


_NAMES = tuple(name for name in Parameters.__annotations__ if hasattr(Parameters, name))


def reset_bounds(options: dict[str, Any] | None) -> tuple[float, float]:
    """The bounds of initial states, rad and rad/s: ``options["low"]`` and ``options["high"]``, or -0.1 and 0.1.

    Raises:
        ValueError: If a bound is not a finite number in the range of float32, or if low is above high.
    """
    low, high = maybe_parse_reset_bounds(options, -0.1, 0.1)
    check_reset_bounds(low, high)
    return low, high
