"""A step of the acrobot that PyTorch differentiates. It needs ``pip install torch``.

The native code computes on the CPU in ``float64``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
import torch
from torch.autograd.function import once_differentiable

from acrobot_rs.control.model import linearize_step, steps


def step(
    state: Any,
    torque: Any,
    params: Mapping[str, Any] | None = None,
    env: gymnasium.Env[Any, Any] | None = None,
) -> torch.Tensor:
    """The state one ``dt`` later, ``(..., 4)``, on the device and with the type of ``state``.

    Tensors broadcast as in :mod:`acrobot_rs.control`. ``params`` replaces parameters of ``env``.
    Gradients are by the state, the torque and each parameter.

    >>> import torch
    >>> import acrobot_rs.torch
    >>> torque = torch.zeros((), requires_grad=True)
    >>> acrobot_rs.torch.step(torch.zeros(4), torque)[3].backward()
    >>> round(torque.grad.item(), 2)  # rad/s per N m
    0.33
    """
    given = {} if params is None else params
    state = torch.as_tensor(state)
    others = [torch.as_tensor(x).to(state) for x in (torque, *given.values())]
    shape = torch.broadcast_shapes(state.shape[:-1], *(x.shape for x in others))
    others = [x.expand(shape) for x in others]
    return _Step.apply(env, (*given,), state.expand(*shape, 4), *others)


class _Step(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, env: Any, names: Any, state: torch.Tensor, *others: Any) -> torch.Tensor:
        ctx.env, ctx.names = env, names
        ctx.save_for_backward(state, *others)
        numbers, torque, *values = _arrays(state, *others)
        return torch.from_numpy(steps(numbers, torque, env, dict(zip(names, values)))).to(state)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, slope: torch.Tensor) -> tuple[torch.Tensor | None, ...]:
        state, torque, *values = _arrays(*ctx.saved_tensors)
        A, B, by_params = linearize_step(state, torque, ctx.env, dict(zip(ctx.names, values)))
        columns = np.concatenate([A, B, *(x[..., None] for x in by_params.values())], axis=-1)
        slopes = np.einsum("...ij,...i->...j", columns, *_arrays(slope))
        found = torch.from_numpy(slopes).to(slope)
        return None, None, found[..., :4], *found[..., 4:].unbind(-1)


def _arrays(*tensors: torch.Tensor) -> list[Any]:
    return [tensor.detach().cpu().double().numpy() for tensor in tensors]
