"""A step of the acrobot that JAX differentiates. It needs ``pip install jax``.

The native code computes on the CPU in ``float64``, and compiled functions call it.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np

from acrobot_rs.control.model import linearize_step, steps

Names = tuple[str, ...]


def step(
    state: Any,
    torque: Any,
    params: Mapping[str, Any] | None = None,
    env: gymnasium.Env[Any, Any] | None = None,
) -> jax.Array:
    """The state one ``dt`` later, ``(..., 4)``.

    Arrays broadcast as in :mod:`acrobot_rs.control`. ``params`` replaces parameters of ``env``. It
    works in ``jit``, ``vmap``, ``grad`` and ``jvp``, by the state, the torque and each parameter.

    >>> import jax
    >>> import acrobot_rs.jax
    >>> slope = jax.grad(lambda torque: acrobot_rs.jax.step(4 * [0.0], torque)[3])
    >>> round(float(slope(0.0)), 2)  # rad/s per N m
    0.33
    """
    given = {} if params is None else params
    others = tuple(jnp.asarray(x) for x in (torque, *given.values()))
    state = jnp.asarray(state)
    dtype = jnp.result_type(float, state, *others)
    shape = jnp.broadcast_shapes(state.shape[:-1], *(x.shape for x in others))
    others = tuple(jnp.broadcast_to(x, shape).astype(dtype) for x in others)
    return _step(env, (*given,), jnp.broadcast_to(state, (*shape, 4)).astype(dtype), others)


@functools.partial(jax.custom_jvp, nondiff_argnums=(0, 1))
def _step(env: Any, names: Names, state: jax.Array, others: tuple[jax.Array, ...]) -> jax.Array:
    def native(state: Any, torque: Any, *values: Any) -> Any:
        return steps(state, torque, env, dict(zip(names, values))).astype(dtype)

    dtype = state.dtype
    return _call(native, state.shape, state, others)


@_step.defjvp
def _jvp(env: Any, names: Names, primals: Any, tangents: Any) -> tuple[jax.Array, jax.Array]:
    def native(state: Any, torque: Any, *values: Any) -> Any:
        A, B, by_params = linearize_step(state, torque, env, dict(zip(names, values)))
        columns = [A, B, *(by_params[name][..., None] for name in names)]
        return np.concatenate(columns, axis=-1).astype(dtype)

    (state, others), (dstate, dothers) = primals, tangents
    dtype = state.dtype
    columns = _call(native, (*state.shape, 4 + len(others)), state, others)
    change = jnp.concatenate([dstate, *(x[..., None] for x in dothers)], axis=-1)
    return _step(env, names, state, others), jnp.einsum("...ij,...j->...i", columns, change)


def _call(native: Any, shape: tuple[int, ...], state: jax.Array, others: Any) -> jax.Array:
    def wide(*arrays: Any) -> Any:
        return native(*(np.asarray(x, np.float64) for x in arrays))

    result = jax.ShapeDtypeStruct(shape, state.dtype)
    return jax.pure_callback(wide, result, state, *others, vmap_method="broadcast_all")
