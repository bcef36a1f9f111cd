"""Steps of dm_control's swing-up per second of processor time: dm_control, MuJoCo's own batch,
EnvPool, MuJoCo Playground and this package.

    pip install dm_control==1.0.50 mujoco==3.17.0 envpool==1.2.7 playground==0.2.0
    pip install bindings/python
    MUJOCO_GL=disable python benches/compare/swingup.py

Interleaved, the best of five. `mujoco.rollout` computes states alone; the others also observations
and rewards, and all but Playground reset.
"""

import time

import acrobot_rs
import envpool
import jax
import numpy as np
from dm_control import suite
from mujoco import MjData, rollout
from mujoco_playground import registry

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
in_float64 = acrobot_rs.AcrobotSwingupVectorEnv(num_envs=ENVS, float64=True)
env = acrobot_rs.AcrobotSwingupEnv()
for each in envs, in_float64, env:
    each.reset(seed=0)
pool = envpool.make_gymnasium("AcrobotSwingup-v1", num_envs=256, num_threads=1)
pool.reset()
playground = registry.load("AcrobotSwingup", config_overrides={"impl": "jax"})
keys = jax.random.split(jax.random.key(0), ENVS)
begin = jax.jit(jax.vmap(playground.reset))(keys)


@jax.jit
def play(state, actions):
    step = lambda state, each: (jax.vmap(playground.step)(state, each), None)
    return jax.lax.scan(step, state, actions)[0]


play(begin, actions[:20]).reward.block_until_ready()  # compiles


def dm_control():
    for each in actions[:, :10].reshape(-1, 1):
        if dense.step(each).last():
            dense.reset()
    return STEPS * 10


def mujoco_rollout():
    rollout.rollout(model, data, states, controls)
    return STEPS * ENVS


def mujoco_playground():
    play(begin, actions[:20]).reward.block_until_ready()
    return 20 * ENVS


def stepped(env, actions):
    for each in actions:
        env.step(each)
    return actions.size


def rate(run):
    began = time.process_time()
    return run() / (time.process_time() - began)


runs = {
    "dm_control": dm_control,
    "mujoco_rollout": mujoco_rollout,
    "envpool_256": lambda: stepped(pool, actions[:20, :256]),
    "mujoco_playground": mujoco_playground,
    "single": lambda: stepped(env, actions[:, :10].reshape(-1, 1)),
    "vector": lambda: stepped(envs, actions),
    "vector_float64": lambda: stepped(in_float64, actions),
}
best = np.max([[rate(run) for run in runs.values()] for _ in range(5)], axis=0)
for name, each in zip(runs, best, strict=True):
    print(f"{name:17} {each:14,.0f} steps per second", end=", ")
    print(f"{each / best[0]:,.1f} times dm_control, {each / best[1]:,.1f} times mujoco.rollout")
