"""Gymnasium's Acrobot in Rust: bit-identical episodes, and a much faster vector environment.

Importing this package registers ``Acrobot-v1``, ``AcrobotContinuous-v0`` and ``AcrobotBalance-v0``,
and dm_control's ``AcrobotSwingup-v0`` and ``AcrobotSwingupSparse-v0``, all after ``acrobot_rs/``:

    >>> import gymnasium as gym
    >>> import acrobot_rs
    >>> gym.register_envs(acrobot_rs)  # does nothing, but keeps linters from deleting the import
    >>> env = gym.make("acrobot_rs/Acrobot-v1", render_mode="rgb_array")
    >>> envs = gym.make_vec("acrobot_rs/Acrobot-v1", num_envs=1024)

``gym.make("acrobot_rs:acrobot_rs/Acrobot-v1")`` works without that import.
"""

from importlib.metadata import version

from gymnasium.envs.registration import register

from acrobot_rs import control, policy
from acrobot_rs._native import MAX_STEPS, REWARD_THRESHOLD, SWINGUP_MAX_STEPS
from acrobot_rs.env import AcrobotBalanceEnv, AcrobotContinuousEnv, AcrobotEnv
from acrobot_rs.parameters import LogUniform, Normal, Uniform
from acrobot_rs.swingup import (
    AcrobotSwingupEnv,
    AcrobotSwingupSparseEnv,
    AcrobotSwingupSparseVectorEnv,
    AcrobotSwingupVectorEnv,
)
from acrobot_rs.vector import AcrobotBalanceVectorEnv, AcrobotContinuousVectorEnv, AcrobotVectorEnv

__all__ = [
    "AcrobotBalanceEnv",
    "AcrobotBalanceVectorEnv",
    "AcrobotContinuousEnv",
    "AcrobotContinuousVectorEnv",
    "AcrobotEnv",
    "AcrobotSwingupEnv",
    "AcrobotSwingupSparseEnv",
    "AcrobotSwingupSparseVectorEnv",
    "AcrobotSwingupVectorEnv",
    "AcrobotVectorEnv",
    "LogUniform",
    "Normal",
    "Uniform",
    "control",
    "policy",
]
__version__ = version("acrobot-rs")

for _kind, _id, _steps, _threshold in (
    ("Acrobot", "Acrobot-v1", MAX_STEPS, REWARD_THRESHOLD),
    ("AcrobotContinuous", "AcrobotContinuous-v0", MAX_STEPS, REWARD_THRESHOLD),
    ("AcrobotBalance", "AcrobotBalance-v0", MAX_STEPS, None),
    ("AcrobotSwingup", "AcrobotSwingup-v0", SWINGUP_MAX_STEPS, None),
    ("AcrobotSwingupSparse", "AcrobotSwingupSparse-v0", SWINGUP_MAX_STEPS, None),
):
    register(
        id=f"acrobot_rs/{_id}",
        entry_point=f"acrobot_rs:{_kind}Env",
        vector_entry_point=f"acrobot_rs:{_kind}VectorEnv",
        reward_threshold=_threshold,
        max_episode_steps=_steps,
    )
