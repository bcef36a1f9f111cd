"""Records dm_control's acrobot: writes swingup.txt to its folder.

Each line is a step: the angles from upright and their velocities, the action, the same after the
step, the observation, and the rewards of swingup and of swingup_sparse. Ten episodes of 100 steps
with random actions. Every other one begins near upright, where rewards are high. NumPy and OpenBLAS
must not use their own functions for AVX-512.
"""

import os
from importlib.metadata import version
from pathlib import Path

os.environ["MUJOCO_GL"] = "disable"  # no graphics are needed
os.environ["OPENBLAS_CORETYPE"] = "Haswell"
if "avx512f" in Path("/proc/cpuinfo").read_text():
    os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"

import numpy as np
from dm_control import suite


def main():
    texts = lambda numbers: " ".join(repr(float(x)) for x in numbers)
    packages = "dm_control", "mujoco", "numpy"
    tasks = "swingup", "swingup_sparse"
    dense, sparse = (suite.load("acrobot", task, task_kwargs={"random": 1}) for task in tasks)
    inertias = dense.physics.named.model.body_inertia[["upper_arm", "lower_arm"], 1]
    lines = ["# " + ", ".join(f"{name} {version(name)}" for name in packages)]
    lines.append("# inertias " + texts(inertias))
    rng = np.random.default_rng(1)
    for episode in range(10):
        dense.reset()
        sparse.reset()
        if episode % 2:
            near = np.concatenate([rng.uniform(-0.3, 0.3, 2), rng.uniform(-1, 1, 2)])
            with dense.physics.reset_context():
                dense.physics.set_state(near)
        for _ in range(100):
            before = dense.physics.get_state().copy()
            action = float(np.float32(rng.uniform(-1, 1)))  # as in an action space of float32
            step = dense.step(action)
            after = dense.physics.get_state().copy()
            with sparse.physics.reset_context():
                sparse.physics.set_state(after)
            seen = (step.observation[name] for name in ("orientations", "velocity"))
            rewards = step.reward, sparse.task.get_reward(sparse.physics)
            lines.append(texts([*before, action, *after, *np.concatenate([*seen]), *rewards]))
    (Path(__file__).parent / "swingup.txt").write_text("\n".join(lines) + "\n")


main()
