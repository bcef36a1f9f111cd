"""Steps of dm_control's swing-up per second and core: dm_control, MuJoCo's own batch, and this
package.

    pip install dm_control==1.0.50 mujoco==3.17.0 && pip install bindings/python
    MUJOCO_GL=disable python benches/compare/swingup.py

Interleaved, the best of five. `mujoco.rollout` computes states alone; the others also observations,
rewards and resets.
"""

import time

import acrobot_rs
import numpy as np
from dm_control import suite
from mujoco import MjData, rollout

ENVS, STEPS = 1024, 200
rng = np.random.default_rng(0)
actions = rng.uniform(-1, 1, (STEPS, ENVS, 1))

dense = suite.load("acrobot", "swingup", task_kwargs={"random": 1})
model = dense.physics.model.ptr
states = np.zeros((ENVS, 5))  # time, then positions and velocities
states[:, 1:3] = rng.uniform(-np.pi, np.pi, (ENVS, 2))
controls = np.ascontiguousarray(actions.transpose(1, 0, 2))
data = [MjData(model)]
envs = acrobot_rs.AcrobotSwingupVectorEnv(num_envs=ENVS)
envs.reset(seed=0)
env = acrobot_rs.AcrobotSwingupEnv()
env.reset(seed=0)


def dm_control():
    if dense.step(actions[0, 0]).last():
        dense.reset()
    for each in actions[:, :10].reshape(-1, 1):
        if dense.step(each).last():
            dense.reset()
    return STEPS * 10


def mujoco_rollout():
    rollout.rollout(model, data, states, controls)
    return STEPS * ENVS


def single():
    for each in actions[:, :10].reshape(-1, 1):
        env.step(each)
    return STEPS * 10


def vector():
    for each in actions:
        envs.step(each)
    return STEPS * ENVS


def rate(run):
    began = time.perf_counter()
    return run() / (time.perf_counter() - began)


runs = dm_control, mujoco_rollout, single, vector
best = np.max([[rate(run) for run in runs] for _ in range(5)], axis=0)
for run, each in zip(runs, best, strict=True):
    print(
        f"{run.__name__:15} {each:14,.0f} steps per second,",
        f"{each / best[0]:9,.1f} times dm_control, {each / best[1]:7,.1f} times mujoco.rollout",
    )
