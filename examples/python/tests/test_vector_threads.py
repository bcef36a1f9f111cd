"""Threads change no bit, and calls during a step are rejected."""

import contextlib
import copy
import multiprocessing
import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import acrobot_rs
import numpy as np
import pytest
from acrobot_rs import Uniform
from acrobot_rs.vector import AcrobotContinuousVectorEnv
from vectors import make_vec


@pytest.mark.parametrize("kind", [acrobot_rs.AcrobotVectorEnv, AcrobotContinuousVectorEnv])
@pytest.mark.parametrize(("count", "gymnasium_episodes"), [(40_003, False), (3_003, True)])
def test_threads_change_no_bit(kind, count, gymnasium_episodes):
    plays = []
    for threads in (1, 3, None):
        envs = kind(count, 9, None, "SameStep", gymnasium_episodes=gymnasium_episodes, threads=threads)
        envs.reset(seed=1)
        envs.torque_noise_max = 0.5
        envs.action_space.seed(1)
        plays.append([[*envs.step(envs.action_space.sample())[:4], envs.state] for _ in range(12)])
    np.testing.assert_equal(plays, [plays[0]] * 3)


def test_only_large_steps_start_threads():
    """In another process, because other tests start threads too."""
    if not Path("/proc/self/task").exists():
        pytest.skip("counts the threads of Linux")
    code = """if True:
        import pathlib, acrobot_rs
        tasks = pathlib.Path("/proc/self/task")
        before = len(list(tasks.iterdir()))
        for count in (512, 40_000):
            envs = acrobot_rs.AcrobotVectorEnv(count, threads=3)
            envs.reset(seed=1)
            envs.step([0] * count)
            print(len(list(tasks.iterdir())) - before)
    """
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert run.stdout.split() == ["0", "3"], run.stderr


def step_in_a_child(envs, connection):
    connection.send(envs.step(np.zeros(envs.num_envs, np.int64))[0])


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="needs fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.filterwarnings("ignore:os.fork:RuntimeWarning")
def test_threads_in_a_forked_process():
    """A child has none of its parent's threads. Waiting for them would take forever."""
    envs = make_vec(40_000, threads=2)
    envs.reset(seed=1)
    envs.step(np.zeros(envs.num_envs, np.int64))
    ours, theirs = multiprocessing.Pipe()
    child = multiprocessing.get_context("fork").Process(target=step_in_a_child, args=(envs, theirs))
    child.start()
    try:
        assert ours.poll(30), "the child hangs"
        assert (ours.recv() == envs.step(np.zeros(envs.num_envs, np.int64))[0]).all()
    finally:
        child.kill()
        child.join()


#: So many that a step takes long enough for other calls meanwhile.
MANY = 500_000


@contextlib.contextmanager
def stepping(envs):
    """While another thread steps these environments."""
    envs.reset()
    with ThreadPoolExecutor(1) as executor:
        step = executor.submit(envs.step, np.ones(envs.num_envs, np.int64))
        with contextlib.suppress(RuntimeError):
            while not step.done():
                len(envs._native)  # fails as soon as the step is under way
        yield
        assert not step.done(), "more environments are necessary"
        step.result()


BUSY = "^another thread is stepping or resetting an environment; change parameters and call methods between its steps$"


def test_a_call_during_a_step_is_rejected_and_changes_nothing():
    envs = acrobot_rs.AcrobotVectorEnv(MANY, gymnasium_episodes=True, render_mode="ansi")
    states, actions = np.zeros((MANY, 4)), np.ones(MANY, np.int64)
    calls = [
        *(lambda: envs.state, lambda: setattr(envs, "state", states), lambda: envs.elapsed_steps, lambda: envs.render()),
        *(lambda: setattr(envs, "dt", 0.1), lambda: setattr(envs, "dt", Uniform(0.1, 0.2)), lambda: setattr(envs, "dt", [0.1])),
        *(lambda: envs.step(actions), envs.reset, lambda: envs._native.seed(["1"])),
        *(lambda: pickle.dumps(envs), lambda: copy.deepcopy(envs), lambda: envs._native.__setstate__(b"")),
    ]
    for call in calls:
        with stepping(envs), pytest.raises(RuntimeError, match=BUSY):
            call()
        assert envs.dt == 0.2 and (envs.elapsed_steps == 1).all()
