"""Saves a trained perceptron for the crate ``crates/policy``: on a microcontroller, in a browser.

:func:`save` takes a model, and :func:`write` arrays. :func:`load` reads a file.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
from numpy.typing import ArrayLike, NDArray

from acrobot_rs.arrays import LARGEST, finite, must_be, numbers

Layer = tuple[Any, Any, str]
"""Weights ``(outputs, inputs)``, biases, and ``"none"``, ``"tanh"`` or ``"relu"``."""

_ACTIVATIONS = ["none", "tanh", "relu"]


def write(path: str | Path, layers: Sequence[Layer], torque_limit: float | None = None) -> None:
    """Write a file of the layers, from the observation to the outputs.

    Args:
        path: The file.
        layers: The first has 6 inputs; the last has 3 outputs, the scores of the actions, or 1, a
            torque, N m.
        torque_limit: The largest torque, N m, of a policy with one output. ``None`` for scores.
    """
    Path(path).write_bytes(_content(layers, torque_limit))


def _content(layers: Sequence[Layer], torque_limit: float | None) -> bytes:
    inputs, head, body = 6, b"", b""
    for i, (weights, biases, activation) in enumerate(layers):
        weights = _float32(f"the weights of layer {i}", weights)
        biases = _float32(f"the biases of layer {i}", biases)
        outputs = len(biases) if biases.ndim == 1 else 0
        if not 1 <= outputs < 2**16 or weights.shape != (outputs, inputs):
            rule = f"weights of shape (outputs, {inputs}) and biases of shape (outputs,)"
            raise ValueError(f"layer {i} must have {rule}, got {weights.shape} and {biases.shape}")
        if activation not in _ACTIVATIONS:
            name = f"the activation of layer {i}"
            raise must_be(name, f"one of {_ACTIVATIONS}", repr(activation))
        rows = np.column_stack([biases, weights])
        if not np.isfinite(rows).all():
            raise ValueError(f"the numbers of layer {i} must be finite in float32")
        head += struct.pack("<HBB", outputs, _ACTIVATIONS.index(activation), 0)
        body += rows.tobytes()
        inputs = outputs
    scores = torque_limit is None
    if inputs != (3 if scores else 1) or not 1 <= len(layers) < 256:
        rule = "3 outputs, or 1 with a torque_limit" if scores else "1 output"
        raise ValueError(f"the last layer must have {rule}, got {inputs}")
    limit = 0.0 if torque_limit is None else torque_limit
    # Up to 2^-150 it is 0 in float32.
    if not (scores or 2.0**-150 < limit <= LARGEST):
        raise must_be("torque_limit", "finite and above 0 N m in float32", torque_limit)
    content = struct.pack("<4sBBHf", b"MLP1", len(layers), not scores, 6, limit) + head + body
    return content + struct.pack("<I", zlib.crc32(content))


class Policy(NamedTuple):
    """What a file has: ``write(path, *policy)`` writes it again."""

    layers: list[Layer]  #: arrays of ``float32``, which may be changed
    torque_limit: float | None  #: N m; ``None`` if the outputs are the scores of actions

    def act(self, observations: ArrayLike) -> NDArray[Any]:
        """The actions for finite observations, ``(..., 6)``: 0 to 2, or torques, N m.

        They have the shape ``(...)``. As in the crate, an output that is not finite gives no
        torque.
        """
        rule = "finite numbers of shape (..., 6)"
        seen = finite("observations", rule, observations, None)
        if seen.shape[-1:] != (6,):
            raise must_be("observations", rule, f"shape {seen.shape}")
        outputs = _outputs(self.layers, _float32("observations", seen))
        rest = [0, 1, 0] if self.torque_limit is None else [0]
        outputs = np.where(np.isfinite(outputs).all(-1, keepdims=True), outputs, np.float32(rest))
        if self.torque_limit is None:
            return outputs.argmax(-1)
        return np.clip(outputs[..., 0], -self.torque_limit, self.torque_limit)

    def sequential(self) -> Any:
        """A ``torch.nn.Sequential`` of these layers, to train on. :func:`save` takes it."""
        import torch

        modules: list[Any] = []
        for weights, biases, activation in self.layers:
            linear = torch.nn.Linear(weights.shape[1], len(weights))
            linear.weight, linear.bias = (
                torch.nn.Parameter(torch.as_tensor(each)) for each in (weights, biases)
            )
            kinds = {"none": [], "tanh": [torch.nn.Tanh()], "relu": [torch.nn.ReLU()]}
            modules += [linear, *kinds[activation]]
        return torch.nn.Sequential(*modules)


def load(path: str | Path) -> Policy:
    """Read a file of :func:`save` or :func:`write`."""
    file = Path(path).read_bytes()
    try:
        policy = _read(file)
        is_valid = _content(*policy) == file
    except (IndexError, ValueError, struct.error):
        is_valid = False
    if not is_valid:
        rule = "a file that acrobot_rs.policy.save or write wrote"
        raise must_be(str(path), rule, f"{len(file)} other bytes")
    return policy


def _read(file: bytes) -> Policy:
    """The policy in a file that need not be valid."""
    count, kind, inputs, limit = struct.unpack_from("<4xBBHf", file)
    layers: list[Layer] = []
    at = 12 + 4 * count
    for i in range(count):
        outputs, activation = struct.unpack_from("<HB", file, 12 + 4 * i)
        rows = np.frombuffer(file, "<f4", outputs * (1 + inputs), at).reshape(outputs, -1)
        layers.append((rows[:, 1:].copy(), rows[:, 0].copy(), _ACTIVATIONS[activation]))
        at += rows.nbytes
        inputs = outputs
    return Policy(layers, limit if kind else None)


def _float32(name: str, value: Any) -> NDArray[np.float32]:
    """Numbers in ``float32``. Larger ones become infinite."""
    with np.errstate(over="ignore"):
        return numbers(name, "numbers", value, None).astype("<f4")


def save(model: Any, path: str | Path, torque_limit: float | None = None) -> None:
    """Write a model's greedy or mean policy, with what its ``VecNormalize`` does.

    The file's actions are first compared with the model's on 2,000 observations.

    Args:
        model: A model of Stable-Baselines3 (PPO, A2C, DQN) or sb3-contrib (QR-DQN) with
            ``MlpPolicy``, or a ``torch.nn.Sequential`` of linear layers, tanh and ReLU.
        path: The file.
        torque_limit: The largest torque, N m, of a ``Sequential`` with one output. Of a model of
            Stable-Baselines3, the torque of its largest action: by default this action itself, and
            of a swing-up no default.
    """
    policy = getattr(model, "policy", None)
    if policy is None and not isinstance(model, Iterable):
        rule = "one of Stable-Baselines3 or a torch.nn.Sequential"
        raise must_be("model", rule, repr(model), TypeError)
    layers = _layers(model) if policy is None else _layers(*_modules_of(policy))
    task, scale, normalize = "Acrobot-v1", 1.0, None
    if policy is not None:
        normalize = model.get_vec_normalize_env()
        if isinstance(policy.action_space, gym.spaces.Box):
            high = float(policy.action_space.high[0])
            if high == 1.0 and np.isinf(policy.observation_space.high).any():
                task = "AcrobotSwingup-v0"
                if torque_limit is None:
                    rule = "the torque of the swing-up's action 1, N m"
                    raise must_be("torque_limit", rule, None)
            torque_limit = high if torque_limit is None else torque_limit
            scale = torque_limit / high
            weights, biases, activation = layers[-1]
            layers[-1] = (weights * scale, biases * scale, activation)
    if normalize is not None and normalize.norm_obs:
        mean, deviation = normalize.obs_rms.mean, np.sqrt(normalize.obs_rms.var + normalize.epsilon)
        weights, biases, activation = layers[0]
        layers[0] = (weights / deviation, biases - weights @ (mean / deviation), activation)
    content = _content(layers, torque_limit)
    seen = _observations(task)
    if policy is None:
        import torch

        with torch.no_grad():
            expected = model(torch.as_tensor(seen)).numpy()
        expected = expected if torque_limit is not None else expected.argmax(1)
    else:
        inputs = seen if normalize is None else normalize.normalize_obs(seen)
        expected = scale * np.asarray(model.predict(inputs, deterministic=True)[0])
    if count := _differing(_outputs(layers, seen), expected, torque_limit):
        where = f"they differ on {count} of {len(seen)} observations"
        raise ValueError(f"the file's actions must be those of the model; {where}")
    Path(path).write_bytes(content)


def _modules_of(policy: Any) -> tuple[list[Any], int]:
    """A policy's layers in Stable-Baselines3, and how many quantiles make each score."""
    if hasattr(policy, "mlp_extractor"):
        return [*policy.mlp_extractor.policy_net, policy.action_net], 1
    if hasattr(policy, "quantile_net"):
        return list(policy.quantile_net.quantile_net), policy.quantile_net.n_quantiles
    if hasattr(policy, "q_net"):
        return list(policy.q_net.q_net), 1
    rule = "that of PPO, A2C, DQN or QR-DQN"
    raise must_be("the policy", rule, type(policy).__name__, TypeError)


def _layers(modules: Iterable[Any], quantiles: int = 1) -> list[Layer]:
    layers: list[Layer] = []
    for module in modules:
        kind = type(module).__name__
        if kind == "Linear":
            both = module.weight, module.bias
            weights, biases = (
                0.0 if each is None else each.detach().cpu().numpy().astype(np.float64)
                for each in both
            )
            layers.append((weights, np.zeros(len(weights)) + biases, "none"))
        elif kind in ("Tanh", "ReLU") and layers and layers[-1][2] == "none":
            layers[-1] = (*layers[-1][:2], kind.lower())
        else:
            rule = "Linear, or Tanh or ReLU after Linear"
            raise must_be("a layer", rule, kind, TypeError)
    if quantiles > 1:
        weights, biases, activation = layers[-1]
        weights = weights.reshape(quantiles, -1, weights.shape[1]).mean(0)
        layers[-1] = (weights, biases.reshape(quantiles, -1).mean(0), activation)
    return layers


def _observations(task: str) -> NDArray[np.float32]:
    """Of random episodes."""
    envs = gym.make_vec(f"acrobot_rs/{task}", num_envs=20)
    envs.action_space.seed(1)
    seen = [envs.reset(seed=1)[0]]
    for _ in range(99):
        seen.append(envs.step(envs.action_space.sample())[0])
    return np.concatenate(seen)


@np.errstate(all="ignore")
def _outputs(layers: Sequence[Layer], x: NDArray[Any]) -> NDArray[Any]:
    """What the last layer answers, in ``float32``."""
    for weights, biases, activation in layers:
        x = x @ np.float32(weights).T + np.float32(biases)
        if activation != "none":
            x = np.tanh(x) if activation == "tanh" else np.maximum(x, 0)
    return x


@np.errstate(all="ignore")
def _differing(outputs: NDArray[Any], expected: NDArray[Any], torque_limit: float | None) -> int:
    """On how many observations the outputs give another action than the model."""
    if torque_limit is None:
        # Scores that differ by a rounding are a tie. NaN is none.
        chosen = np.take_along_axis(outputs, expected.reshape(-1, 1).astype(int), 1)[:, 0]
        equal = outputs.max(1) - chosen <= 1e-4 * np.maximum(1, abs(outputs).max(1))
    else:
        torques, others = np.clip([outputs[:, 0], expected[:, 0]], -torque_limit, torque_limit)
        equal = abs(torques - others) <= 1e-4 * torque_limit
    return int((~equal).sum())
