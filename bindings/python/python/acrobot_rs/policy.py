"""Saves a trained perceptron for the crate ``crates/policy``: on a microcontroller, in a browser.

:func:`save` takes a model, :func:`write` arrays, and :func:`load` plays a file. None needs torch
beside the model.
"""

from __future__ import annotations

import reprlib
import struct
import zlib
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import ArrayLike, NDArray

from acrobot_rs.arrays import LARGEST, must_be, numbers

Layer = tuple[Any, Any, str]
"""Weights ``(outputs, inputs)``, biases, and ``"none"``, ``"tanh"`` or ``"relu"``."""

_ACTIVATIONS = ["none", "tanh", "relu"]
_KINDS = {"Linear": None, "Tanh": "tanh", "ReLU": "relu"} | dict.fromkeys(
    ("Identity", "Flatten", "Dropout"), "none"
)


class Policy:
    """The policy in a file, without torch. Outputs differ from the crate's in the last digits.

    A policy whose outputs are not all finite, because its sums overflow, plays no torque: action 1,
    or 0 N m.
    """

    def __init__(self, layers: list[Layer], torque_limit: float | None) -> None:
        """Keep the layers, and the largest torque, N m, or ``None`` if the outputs are scores.

        They are those of :func:`write`, which rejects the same.
        """
        _content(layers, torque_limit)
        self.layers = layers
        self.torque_limit = torque_limit

    def act(self, observation: ArrayLike) -> NDArray[Any]:
        """The action for an observation of shape ``(6,)``, or the actions for ``(n, 6)``.

        With scores an action, ``0`` to ``2``, for each observation; otherwise a torque, N m, in an
        array whose last axis has the length 1. The actions of a swing-up are torques divided by the
        largest.
        """
        rule = "finite numbers of shape (6,) or (n, 6)"
        seen = _floats("observation", rule, observation)
        if seen.shape[-1:] != (6,) or seen.ndim > 2 or not np.isfinite(seen).all():
            raise must_be("observation", rule, reprlib.repr(observation))
        outputs = _outputs(self.layers, seen)
        no_torque = np.float32([0, 1, 0] if self.torque_limit is None else [0])
        outputs = np.where(np.isfinite(outputs).all(-1, keepdims=True), outputs, no_torque)
        if self.torque_limit is None:
            return outputs.argmax(-1)
        return np.clip(outputs, -self.torque_limit, self.torque_limit)


def load(path: str | Path) -> Policy:
    """Read a file of :func:`save` or :func:`write`."""
    file = Path(path).read_bytes()
    try:
        policy = _read(file)
        is_valid = _content(policy.layers, policy.torque_limit) == file
    except (IndexError, ValueError, struct.error):
        is_valid = False
    if not is_valid:
        rule = "what acrobot_rs.policy.save or write wrote"
        raise must_be(str(path), rule, f"{len(file)} other bytes")
    return policy


def _read(file: bytes) -> Policy:
    """The layers of a file that need not be valid."""
    count, kind, inputs, limit = struct.unpack_from("<4xBBHf", file)
    layers: list[Layer] = []
    at = 12 + 4 * count
    for i in range(count):
        outputs, activation = struct.unpack_from("<HB", file, 12 + 4 * i)
        rows = np.frombuffer(file, "<f4", outputs * (1 + inputs), at).reshape(outputs, -1)
        layers.append((rows[:, 1:], rows[:, 0], _ACTIVATIONS[activation]))
        at += rows.nbytes
        inputs = outputs
    return Policy(layers, limit if kind else None)


def _floats(name: str, rule: str, value: Any) -> NDArray[np.float32]:
    """Numbers in ``float32``. Larger ones become infinite."""
    with np.errstate(over="ignore"):
        return numbers(name, rule, value, None).astype("<f4")


def _outputs(layers: Sequence[Layer], x: NDArray[Any]) -> NDArray[Any]:
    """What the last layer answers, in ``float32``."""
    with np.errstate(all="ignore"):
        for weights, biases, activation in layers:
            inputs, x = x.T[..., np.newaxis], np.asarray(biases, np.float32)
            # In the crate's order, by which some sums overflow and others do not.
            for value, column in zip(inputs, np.asarray(weights, np.float32).T, strict=True):
                x = x + value * column
            if activation != "none":
                x = np.tanh(x) if activation == "tanh" else np.maximum(x, 0)
    return x


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
        weights = _floats(f"the weights of layer {i}", "numbers", weights)
        biases = _floats(f"the biases of layer {i}", "numbers", biases)
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
    limit = 0.0 if torque_limit is None else _checked(torque_limit)
    content = struct.pack("<4sBBHf", b"MLP1", len(layers), not scores, 6, limit) + head + body
    return content + struct.pack("<I", zlib.crc32(content))


def _checked(torque_limit: float) -> float:
    # Up to 2^-150 it is 0 in float32.
    if not 2.0**-150 < torque_limit <= LARGEST:
        raise must_be("torque_limit", "finite and above 0 N m in float32", torque_limit)
    return float(torque_limit)


def save(
    model: Any,
    path: str | Path,
    observations: NDArray[np.float32] | None = None,
    torque_limit: float | None = None,
) -> None:
    """Write a model's greedy or mean policy, with what its ``VecNormalize`` does.

    Args:
        model: A model of Stable-Baselines3 (PPO, A2C, DQN) or sb3-contrib (QR-DQN) with
            ``MlpPolicy``, or a ``torch.nn.Sequential`` of linear layers, tanh and ReLU.
        path: The file.
        observations: On which the file's actions are compared with the model's: an array of shape
            ``(n, 6)``. By default 2,000 of random episodes.
        torque_limit: The largest torque, N m, of a ``Sequential`` with one output. Of a model of
            Stable-Baselines3, the torque of its largest action: by default this action itself, and
            of a swing-up no default.
    """
    policy = getattr(model, "policy", None)
    if policy is None and not isinstance(model, Iterable):
        rule = "one of Stable-Baselines3 or a torch.nn.Sequential"
        raise must_be("model", rule, repr(model), TypeError)
    modules, quantiles = (model, 1) if policy is None else _modules_of(policy)
    layers = _layers(modules, quantiles)
    if policy is None and any(type(each).__name__ == "Dropout" and each.training for each in model):
        what = "it has Dropout in training mode; call model.eval() before"
        raise ValueError(f"the model must be in evaluation mode: {what}")
    is_swingup = (
        policy is not None
        and bool(np.isinf(policy.observation_space.high).any())
        and policy.action_space == gym.spaces.Box(-1.0, 1.0, (1,), np.float32)
    )
    scale = 1.0
    if policy is not None and isinstance(policy.action_space, gym.spaces.Box):
        low, high = float(policy.action_space.low[0]), float(policy.action_space.high[0])
        if not 0 < high == -low < np.inf:
            name, got = "the bounds of the action space", f"{low} and {high}"
            raise must_be(name, "finite and opposite", got)
        if torque_limit is None and is_swingup:
            raise must_be("torque_limit", "the torque of the swing-up's action 1, N m", None)
        torque_limit = high if torque_limit is None else torque_limit
        scale = _checked(torque_limit) / high
        weights, biases, activation = layers[-1]
        layers[-1] = (weights * scale, biases * scale, activation)
    normalize = model.get_vec_normalize_env() if policy is not None else None
    note = ""
    if normalize is not None and normalize.norm_obs:
        mean, deviation = normalize.obs_rms.mean, np.sqrt(normalize.obs_rms.var + normalize.epsilon)
        note = f". VecNormalize clips at clip_obs={normalize.clip_obs:g}, and the file does not"
        weights, biases, activation = layers[0]
        layers[0] = (weights / deviation, biases - weights @ (mean / deviation), activation)
    content = _content(layers, torque_limit)
    if observations is None:
        observations = _observations("AcrobotSwingup-v0" if is_swingup else "Acrobot-v1")
    rule = "finite numbers of shape (n, 6)"
    seen = _floats("observations", rule, observations)
    if seen.shape[1:] != (6,) or not seen.size or not np.isfinite(seen).all():
        raise must_be("observations", rule, reprlib.repr(observations))
    if policy is None:
        import torch

        with torch.no_grad():
            expected = modules(torch.as_tensor(seen)).numpy()
        expected = expected if torque_limit is not None else expected.argmax(1)
    else:
        inputs = seen if normalize is None else normalize.normalize_obs(seen)
        expected = scale * np.asarray(model.predict(inputs, deterministic=True)[0])
    differ = _differ(_outputs(layers, seen), expected, torque_limit)
    if differ.any():
        where = f"they differ on {differ.sum()} of {len(seen)} observations{note}"
        raise ValueError(f"the file's actions must be those of the model; {where}")
    Path(path).write_bytes(content)


def _modules_of(policy: Any) -> tuple[list[Any], int]:
    """A policy's layers in Stable-Baselines3, and how many quantiles make each score."""
    extractor = type(getattr(policy, "features_extractor", None)).__name__
    if extractor not in ("FlattenExtractor", "NoneType"):
        raise TypeError(f"the features extractor must be FlattenExtractor, got {extractor}")
    if hasattr(policy, "mlp_extractor"):
        if getattr(policy, "squash_output", False):
            raise TypeError("the policy must not have squash_output")
        return [*policy.mlp_extractor.policy_net, policy.action_net], 1
    if hasattr(policy, "quantile_net"):
        return list(policy.quantile_net.quantile_net), policy.quantile_net.n_quantiles
    if hasattr(policy, "q_net"):
        return list(policy.q_net.q_net), 1
    rule = "that of PPO, A2C, DQN or QR-DQN"
    raise must_be("the policy", rule, type(policy).__name__, TypeError)


def _layers(modules: Iterable[Any], quantiles: int) -> list[Layer]:
    layers: list[Layer] = []
    for module in modules:
        kind = type(module).__name__
        if kind not in _KINDS:
            raise must_be("a layer", f"one of {', '.join(_KINDS)}", kind, TypeError)
        if kind == "Linear":
            both = module.weight, module.bias
            weights, biases = (
                0.0 if each is None else each.detach().cpu().numpy().astype(np.float64)
                for each in both
            )
            layers.append((weights, np.zeros(len(weights)) + biases, "none"))
        elif (activation := _KINDS[kind]) != "none":
            if not layers or layers[-1][2] != "none":
                raise TypeError(f"{kind} must follow a linear layer")
            layers[-1] = (*layers[-1][:2], activation)
    if quantiles > 1:
        weights, biases, activation = layers[-1]
        weights = weights.reshape(quantiles, -1, weights.shape[1]).mean(0)
        layers[-1] = (weights, biases.reshape(quantiles, -1).mean(0), activation)
    return layers


def _observations(task: str) -> NDArray[np.float32]:
    envs = gym.make_vec(f"acrobot_rs/{task}", num_envs=20)
    envs.action_space.seed(1)
    seen = [envs.reset(seed=1)[0]]
    for _ in range(99):
        seen.append(envs.step(envs.action_space.sample())[0])
    return np.concatenate(seen)


def _differ(
    outputs: NDArray[Any], expected: NDArray[Any], torque_limit: float | None
) -> NDArray[np.bool_]:
    """Where a file's outputs give another action than its model."""
    if wrong := (~np.isfinite(outputs)).any(1).sum():
        where = f"they are not on {wrong} of {len(outputs)} observations"
        raise ValueError(f"the outputs of the file must be finite; {where}")
    if torque_limit is None:
        # Scores that differ by a rounding are a tie.
        chosen = np.take_along_axis(outputs, expected.reshape(-1, 1).astype(int), 1)[:, 0]
        return outputs.max(1) - chosen > 1e-4 * np.maximum(1, abs(outputs).max(1))
    torques, others = np.clip([outputs[:, 0], expected[:, 0]], -torque_limit, torque_limit)
    return abs(torques - others) > 1e-4 * torque_limit
