"""dm_control's ``acrobot-swingup``: swing up from anywhere, with friction and a weak motor, and stay up."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.error import InvalidAction, ResetNeeded
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from acrobot_rs import arrays
from acrobot_rs._native import Batch
from acrobot_rs.arrays import numbers, plain_seed, read_only
from acrobot_rs.native_vector import Bools, Floats, NativeVectorEnv

#: The torque of an action of 1, N m.
_TORQUE = 2.0
_METADATA: dict[str, Any] = {"render_modes": ["rgb_array", "ansi"], "render_fps": 100}


def _spaces() -> tuple[spaces.Box[np.float32], spaces.Box[np.float32]]:
    """Of actions and of observations."""
    high = np.array([1.0, 1.0, 1.0, 1.0, np.inf, np.inf], np.float32)
    return spaces.Box(-1.0, 1.0, (1,), np.float32), spaces.Box(-high, high, dtype=np.float32)


def _torques(name: str, actions: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float32]:
    """The torques of actions, N m, a row for each environment. An action beyond 1 acts as 1, as in MuJoCo."""
    array = numbers(name, f"numbers of shape {shape}", actions, shape, error=InvalidAction)
    if np.isnan(array).any():
        raise InvalidAction(f"{name} must be numbers, got {array}")
    return (_TORQUE * np.clip(array, -1.0, 1.0)).astype(np.float32).reshape(-1, 1)


class AcrobotSwingupEnv(gymnasium.Env[Floats, Floats]):
    """dm_control's ``acrobot-swingup``, step by step within the rounding of ``float64``.

    The action is an array of one number from -1 to 1: a torque of up to 2 N m between the links, for 0.01 s. Both joints have
    friction.

    The observation, ``float32`` of shape ``(6,)``, has the sines of both links' angles from upright, their cosines, and the
    velocities of theta1 and theta2, rad/s: dm_control's ``orientations`` and ``velocity``.

    The reward is 1 up to 0.2 m from the target, 2 m above the joint, and falls to 0.1 at 1.2 m. An episode begins anywhere at
    rest. No state ends it; ``gymnasium.make`` truncates it after 1,000 steps.

    The parameters of the physics cannot be changed here; in Rust they can.

    >>> import gymnasium as gym
    >>> import acrobot_rs
    >>> env = gym.make("acrobot_rs/AcrobotSwingup-v0")
    >>> observation, info = env.reset(seed=42)
    >>> observation, reward, terminated, truncated, info = env.step([0.5])
    >>> 0.0 <= reward <= 1.0
    True
    """

    metadata = _METADATA
    _ENGINE = "swingup"

    def __init__(self, render_mode: str | None = None) -> None:
        """Make an environment. ``render_mode``: ``None``, ``"rgb_array"`` or ``"ansi"``."""
        self.render_mode = arrays.render_mode(render_mode, self.metadata)
        self.action_space, self.observation_space = _spaces()
        self._native = Batch(mode="Disabled", engine=f"exact_{self._ENGINE}", continuous=True)
        self._ready = False

    @property
    def state(self) -> NDArray[np.float64]:
        """theta1, theta2 (rad; 0 hangs down) and their velocities (rad/s), of shape ``(4,)``: a read-only copy. It can be set."""
        states = np.empty((1, 4))
        self._native.states(states)
        return read_only(states[0])

    @state.setter
    def state(self, state: ArrayLike) -> None:
        self._native.set_states(numbers("state", "four finite numbers", state, (4,)).astype(np.float64).reshape(1, 4))
        self._ready = True

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """Begin an episode at rest, with both angles drawn uniformly from -pi to pi. There are no options."""
        arrays.check_keys(options, ())
        super().reset(seed=plain_seed(seed))
        self.state = np.array([*self.np_random.uniform(-np.pi, np.pi, 2), 0.0, 0.0])
        observations = np.empty((1, 6), np.float32)
        self._native.observe(observations)
        return observations[0], {}

    def step(self, action: ArrayLike) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """Apply an action for 0.01 s.

        Raises:
            gymnasium.error.InvalidAction: If the action is not an array of one number. Nothing changes then.
            gymnasium.error.ResetNeeded: Before the first reset.
        """
        if not self._ready:
            raise ResetNeeded("the environment has no state yet; call reset before step")
        observations = np.empty((1, 6), np.float32)
        rewards, _, _ = self._native.step(self, _torques("action", action, (1,)), observations)
        return observations[0], float(rewards[0]), False, False, {}

    def render(self) -> NDArray[np.uint8] | str | None:
        """An array of shape ``(500, 500, 3)`` or a text, depending on the render mode."""
        return None if self.render_mode is None else self._native.render(0, self.render_mode)


class AcrobotSwingupSparseEnv(AcrobotSwingupEnv):
    """dm_control's ``acrobot-swingup_sparse``: :class:`AcrobotSwingupEnv` with a reward of 0 beyond 0.2 m from the target."""

    _ENGINE = "swingup_sparse"


class AcrobotSwingupVectorEnv(NativeVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]):
    """Many :class:`AcrobotSwingupEnv`, computed in ``float32``, bit-identically on every machine.

    Actions have the shape ``(num_envs, 1)``. Environment ``i`` draws from the ``i``-th child of the seed, as in
    :class:`acrobot_rs.AcrobotVectorEnv`.

    >>> import gymnasium as gym
    >>> import acrobot_rs
    >>> envs = gym.make_vec("acrobot_rs/AcrobotSwingup-v0", num_envs=1024)
    >>> envs.reset(seed=42)[0].shape
    (1024, 6)
    """

    metadata: dict[str, Any] = {**_METADATA, "autoreset_mode": AutoresetMode.NEXT_STEP}
    _ENGINE = "swingup"

    def __init__(
        self,
        num_envs: int = 1,
        max_episode_steps: int | None = 1000,
        render_mode: str | None = None,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        threads: int | None = 1,
    ) -> None:
        """Make environments. The arguments are those of :class:`acrobot_rs.AcrobotVectorEnv`."""
        self.render_mode = arrays.render_mode(render_mode, self.metadata)
        self._native = self._make(
            num_envs, max_episode_steps, autoreset_mode, copy, self._ENGINE, True, threads
        )
        self.single_action_space, self.single_observation_space = _spaces()
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)

    def _bounds(self, options: dict[str, Any] | None) -> tuple[float, float]:
        arrays.check_keys(options, ("reset_mask", "state"))
        return -np.pi, np.pi

    def step(
        self, actions: ArrayLike
    ) -> tuple[Floats, NDArray[np.floating[Any]], Bools, Bools, dict[str, Any]]:
        """Step each environment. Actions are from -1 to 1, and no state ends an episode."""
        return super().step(_torques("actions", actions, (self.num_envs, 1)))


class AcrobotSwingupSparseVectorEnv(
    AcrobotSwingupVectorEnv, VectorEnv[Floats, NDArray[Any], np.ndarray]
):
    """Many :class:`AcrobotSwingupSparseEnv`."""

    _ENGINE = "swingup_sparse"
