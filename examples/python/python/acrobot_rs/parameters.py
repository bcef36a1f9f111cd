"""What the single and the vector environment have in common: parameters, spaces, bounds of a start, actions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from gymnasium import logger, spaces
from gymnasium.envs.classic_control.utils import maybe_parse_reset_bounds

from acrobot_rs._native import Acrobot, Batch, check_start_bounds


class Parameters:
    """The physics, by Gymnasium's names, to be set on a class or at any time on an environment.

    A value is checked where it is set, and refused with a ``ValueError`` that says what is allowed. Those set on an
    environment hold from its next step on; those set on a class, as in a subclass, from the next environment on.
    """

    #: Time that one step lasts, s; above 0.
    dt: float = 0.2
    #: Length of link 1, m; above 0.
    LINK_LENGTH_1: float = 1.0
    #: Length of link 2, m; above 0. It is only drawn: the equations of motion and the goal do not contain it.
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
    #: Bound of the first velocity after a step, rad/s; above 0.
    MAX_VEL_1: float = 4 * math.pi
    #: Bound of the second velocity after a step, rad/s; above 0.
    MAX_VEL_2: float = 9 * math.pi
    #: Torques of the three actions, N m.
    AVAIL_TORQUE: Sequence[float] = (-1.0, 0.0, 1.0)
    #: Each step adds a uniform draw from [-torque_noise_max, torque_noise_max) to the torque, N m; 0 draws nothing.
    torque_noise_max: float = 0.0
    #: The equations of motion: those of Sutton and Barto's book, or those printed in the paper of 1996.
    book_or_nips: Literal["book", "nips"] = "book"

    metadata: dict[str, Any]
    spec: Any
    render_mode: str | None
    _native: Acrobot | Batch

    def __init__(self, native: Acrobot | Batch, render_mode: str | None) -> None:
        """Take over what a subclass may have set."""
        modes = self.metadata["render_modes"]
        if render_mode is not None and render_mode not in modes:
            raise ValueError(f"render_mode is {render_mode!r}; allowed is None or one of {modes}")
        self.render_mode = render_mode
        self._native = native
        for name in _NAMES:
            native.set(name, getattr(self, name))

    def __setattr__(self, name: str, value: Any) -> None:
        """Check a parameter and hand it on."""
        if name in _NAMES:
            # A list that is changed in place would not be noticed.
            value = tuple(value) if name == "AVAIL_TORQUE" else value
            self._native.set(name, value)
        super().__setattr__(name, value)

    def _warn_of_no_render_mode(self) -> None:
        logger.warn(
            "render was called without a render mode, and shows nothing; choose one when the environment is made, as "
            f'gymnasium.make("{self.spec.id if self.spec else "acrobot_rs/Acrobot-v1"}", render_mode="rgb_array")'
        )

    @property
    def _observation_space(self) -> spaces.Box[np.float32]:
        high = np.array([1.0, 1.0, 1.0, 1.0, self.MAX_VEL_1, self.MAX_VEL_2], dtype=np.float32)
        return spaces.Box(-high, high, dtype=np.float32)


_NAMES = tuple(name for name in Parameters.__annotations__ if hasattr(Parameters, name))


def start_bounds(options: dict[str, Any] | None) -> tuple[float, float]:
    """The bounds of a start, rad and rad/s, that ``options`` may have as ``low`` and ``high``.

    Raises:
        ValueError: For what is no number that float32 holds, and for a low above high.
    """
    low, high = maybe_parse_reset_bounds(options, -0.1, 0.1)
    check_start_bounds(low, high)
    return low, high
