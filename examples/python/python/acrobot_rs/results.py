"""What vector environments return: infos, and copies that are read-only."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """An assignment to its elements, which would have no effect, raises."""
    array.flags.writeable = False
    return array


def final_infos(finals: NDArray[np.float32], ended: NDArray[np.bool_], last: dict[str, Any]) -> dict[str, Any]:
    """Infos as in ``SyncVectorEnv``: last observations and infos, and which episodes ended.

    An observation is ``None`` where no episode ended.
    """
    if not ended.any():
        return {}
    final_obs = np.full(len(ended), None, dtype=object)
    for index in np.flatnonzero(ended):
        final_obs[index] = finals[index].copy()
    final_info = {name: ended.copy() if name.startswith("_") else value for name, value in last.items()}
    return {"final_obs": final_obs, "_final_obs": ended, "final_info": final_info, "_final_info": ended.copy()}
