"""Animations of states."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from acrobot_rs.arrays import finite
from acrobot_rs.control.model import Env, acrobot_of


class Animation:
    """An animated SVG of states, ``(n, 4)``, one each ``dt``, in real time. Notebooks show it."""

    def __init__(self, states: ArrayLike, env: Env = None) -> None:
        acrobot = acrobot_of(env)
        dt, lengths = acrobot.dt, (acrobot.LINK_LENGTH_1, acrobot.LINK_LENGTH_2)
        steps = max(1, round(0.04 / dt))  # of a frame; up to 25 frames a second
        rule = "finite numbers of shape (n, 4), rad and rad/s"
        given = finite("states", rule, states, (np.size(states) // 4, 4))
        angles = np.unwrap(given[:, :2], axis=0)[::steps]
        seconds = (len(angles) - 1) * steps * dt
        first, second = (
            '<animateTransform attributeName="transform" type="rotate" repeatCount="indefinite" '
            f'dur="{seconds:.3f}s" values="{";".join(f"{angle:.1f}" for angle in column)}"/>'
            f'<path d="M-.1 0h.2v{length}h-.2z" fill="#0cc"/><circle r=".1" fill="#cc0"/>'
            for column, length in zip(-np.degrees(angles.T), lengths)
        )
        reach = sum(lengths) + 0.2
        self.svg = (
            '<svg xmlns="http://www.w3.org/2000/svg" width="300" '
            f'viewBox="{-reach} {-reach} {2 * reach} {2 * reach}">'
            f'<g>{first}<g transform="translate(0 {lengths[0]})"><g>{second}</g></g></g></svg>\n'
        )

    def save(self, path: str | Path) -> None:
        Path(path).write_text(self.svg)

    def _repr_html_(self) -> str:
        return self.svg
