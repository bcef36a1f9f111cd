"""Gymnasium's Acrobot in Rust: bit-identical episodes, and a vector environment thousands of times as fast.

Importing this package registers ``acrobot_rs/Acrobot-v1``, ``acrobot_rs/AcrobotContinuous-v0`` and ``acrobot_rs/Acrobot-v0``, and dm_control's
``acrobot_rs/AcrobotSwingup-v0`` and ``acrobot_rs/AcrobotSwingupSparse-v0``:

    >>> import gymnasium as gym
    >>> import acrobot_rs
    >>> env = gym.make("acrobot_rs/Acrobot-v1", render_mode="rgb_array")
    >>> envs = gym.make_vec("acrobot_rs/Acrobot-v1", num_envs=1024)

``gym.make("acrobot_rs:acrobot_rs/Acrobot-v1")`` works without that import.
"""

from importlib.metadata import version

from gymnasium.envs.registration import register

from acrobot_rs.env import AcrobotContinuousEnv, AcrobotEnv, AcrobotV0Env
from acrobot_rs.parameters import LogUniform, Normal, Uniform
from acrobot_rs.swingup import (
    AcrobotSwingupEnv,
    AcrobotSwingupSparseEnv,
    AcrobotSwingupSparseVectorEnv,
    AcrobotSwingupVectorEnv,
)
from acrobot_rs.vector import AcrobotContinuousVectorEnv, AcrobotVectorEnv

__all__ = [
    "AcrobotContinuousEnv",
    "AcrobotContinuousVectorEnv",
    "AcrobotEnv",
    "AcrobotSwingupEnv",
    "AcrobotSwingupSparseEnv",
    "AcrobotSwingupSparseVectorEnv",
    "AcrobotSwingupVectorEnv",
    "AcrobotV0Env",
    "AcrobotVectorEnv",
    "LogUniform",
    "Normal",
    "Uniform",
]
__version__ = version("acrobot-rs")

for _name, _kind, _vector_kind, _steps in (
    ("Acrobot-v1", "AcrobotEnv", "AcrobotVectorEnv", 500),
    ("AcrobotContinuous-v0", "AcrobotContinuousEnv", "AcrobotContinuousVectorEnv", 500),
    ("Acrobot-v0", "AcrobotV0Env", None, 200),
):
    register(
        id=f"acrobot_rs/{_name}",
        entry_point=f"acrobot_rs.env:{_kind}",
        vector_entry_point=_vector_kind and f"acrobot_rs.vector:{_vector_kind}",
        reward_threshold=-100.0,
        max_episode_steps=_steps,
    )
for _kind in ("AcrobotSwingup", "AcrobotSwingupSparse"):
    register(
        id=f"acrobot_rs/{_kind}-v0",
        entry_point=f"acrobot_rs.swingup:{_kind}Env",
        vector_entry_point=f"acrobot_rs.swingup:{_kind}VectorEnv",
        max_episode_steps=1000,
    )
