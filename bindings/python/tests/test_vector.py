"""The vector environment is used as SyncVectorEnv is."""

import collections
import contextlib
import copy
import multiprocessing
import pickle
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousVectorEnv, AcrobotEnv, AcrobotSwingupVectorEnv
from acrobot_rs import AcrobotVectorEnv, Uniform
from gymnasium.error import ClosedEnvironmentError, InvalidAction
from gymnasium.vector import AutoresetMode
from vectors import NO_NAMES, assert_equal, assert_resets_equal, different, make_vec, pair, rejects


def test_attributes_and_types_are_those_of_sync_vector_env():
    theirs, ours = pair(5)
    names = "num_envs", "autoreset_mode", "render_mode", "copy", "closed"
    spaces = [f"{kind}_space" for kind in ("observation", "action")]
    for name in (*names, *spaces, *(f"single_{space}" for space in spaces)):
        assert getattr(ours, name) == getattr(theirs, name)
    assert repr(ours) == "AcrobotVectorEnv(acrobot_rs/Acrobot-v1, num_envs=5)"
    assert ours.unwrapped is ours and ours.spec.max_episode_steps == 500
    for name in ("max_episode_steps", "num_envs", "copy", "autoreset_mode"):
        with pytest.raises(AttributeError):  # an assignment would have no effect
            setattr(ours, name, getattr(ours, name))
    for mode in AutoresetMode:
        envs = make_vec(5, autoreset_mode=mode)
        assert envs.metadata["autoreset_mode"] is mode
        observations, infos = envs.reset(seed=1)
        assert observations in envs.observation_space and infos == {}
        observations, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
        assert observations in envs.observation_space and infos == {}
        for signals in (rewards, terminated, truncated):
            assert signals.shape == (5,)
        assert rewards.dtype == np.float32 and terminated.dtype == truncated.dtype == np.bool_
    assert AcrobotVectorEnv.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP


def test_observations_are_copies_or_one_array():
    for copies in (True, False):
        envs = make_vec(4, copy=copies)
        first, _ = envs.reset(seed=1)
        second = envs.step([0, 1, 2, 0])[0]
        third = envs.step([0, 1, 2, 0])[0]
        fourth, _ = envs.reset()
        for one, other in [(first, second), (second, third), (third, fourth)]:
            assert np.shares_memory(one, other) != copies
            assert (one != other).any() == copies


#: `test_env.py` tries what is no array of numbers.
INVALID = {
    AcrobotVectorEnv: [
        [0, 1, 2, 3], [0, 0, 0, -1], [0, 0, 256, 0], [2**32] * 4, [0, 1, 2], [[0, 1, 2, 0]],
        [0.0, 1.0, 2.0, 0.0], 1, [True] * 4, [0, 1, np.True_, 0],
        collections.UserList([False, 1, 2, 0]),
        *(np.array([2, number, 0, number], np.uint64) for number in (2**64 - 1, 2**63, 3)),
        b"\0\1\2\0", np.zeros((4, 1), np.float32)],
    AcrobotContinuousVectorEnv: [
        [[0.5]], [0.5] * 4, [[0.5, 0.5]] * 4, [[np.nan], [0.0], [0.0], [0.0]], [["0"]] * 4,
        [[True]] * 4, [[0.5], [True], [0.5], [0.5]], [[1j]] * 4, np.zeros(4, np.int64),
        np.zeros(4, np.float32), np.zeros((4, 1), object)],
}  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "actions"), [(kind, each) for kind in INVALID for each in INVALID[kind]]
)
def test_invalid_actions_are_rejected(kind, actions):
    """The message has the action itself, not what it becomes as int64."""
    envs = kind(4)
    envs.reset(seed=1)
    message = r"actions must be \w+ of shape \(4, ?1?\), got |actions\[\d\] must be (0|a number)"
    if getattr(actions, "dtype", None) == np.uint64:
        message = rf"actions\[1\] must be 0, 1 or 2, got {actions[1]}$"
    with rejects(envs, InvalidAction, message):
        envs.step(actions)


@pytest.mark.parametrize(
    "convert",
    [np.uint8, np.int8, np.int32, np.uint64, lambda actions: actions.astype(">i8"), list,
     lambda actions: np.repeat(actions, 2)[::2],
     # Numbers after a header of one byte are not aligned. Gymnasium accepts them.
     lambda actions: np.frombuffer(b"h" + actions.tobytes(), np.int64, offset=1)],
)  # fmt: skip
def test_actions_can_be_integers_of_any_type(convert):
    envs, twin = make_vec(4), make_vec(4)
    for each in (envs, twin):
        each.reset(seed=1)
    actions = np.array([0, 1, 2, 0])
    np.testing.assert_equal(envs.step(convert(actions)), twin.step(actions))


COUNTS = "num_envs", "max_episode_steps", "threads"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *(("num_envs", count) for count in (0, -1, 2**40)),
        *(("max_episode_steps", count) for count in (0, 2**32)),
        *(("autoreset_mode", mode) for mode in ("nextstep", *NO_NAMES)),
        ("threads", 0),
        *(("render_mode", mode) for mode in ("human", *NO_NAMES[1:])),
        *((name, value) for name in COUNTS for value in (2.0, "2", True)),
        *((name, value) for name in ("copy", "gymnasium_episodes") for value in (1, "False", None)),
        *(("info_parameters", value) for value in (True, None, "dt", [0], NO_NAMES)),
        ("float64", True),
    ],
)
def test_invalid_arguments_are_rejected(name, value):
    with pytest.raises((TypeError, ValueError), match=f"^{name} must be .*, got "):
        AcrobotVectorEnv(**{"num_envs": 2, "gymnasium_episodes": name == "float64", name: value})


@pytest.mark.parametrize("name", NO_NAMES)
def test_what_is_no_name_is_rejected(name):
    envs, single = AcrobotVectorEnv(2), AcrobotEnv()
    for call in (envs.call, envs.get_attr, envs.get_parameter, lambda name: envs.set_attr(name, 1)):
        with rejects(envs, AttributeError, re.escape(repr(name))):
            call(name)
    with rejects(single, TypeError, f"^name must be a string, got {re.escape(repr(name))}"):
        single.set_wrapper_attr(name, 1)
    if name is not None:
        with pytest.raises(TypeError, match=f"^render_mode must .*, got {re.escape(repr(name))}"):
            AcrobotEnv(render_mode=name)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ("acrobot_rs.AcrobotVectorEnv(2**32 - 1)", "num_envs must be so few that they fit into"),
        ("batch.step(None, actions, observations)", "a step does not fit into memory"),
    ],
)
def test_a_call_that_does_not_fit_into_memory_raises(call, message):
    """In a process that may use 2 MB more than it has when the call begins."""
    code = f"""if True:
        import resource
        import acrobot_rs
        import numpy as np
        batch = acrobot_rs._native.Batch(2_000_000)
        actions, observations = np.zeros(2_000_000, np.int64), np.empty((2_000_000, 6), np.float32)
        pages = int(open("/proc/self/statm").read().split()[0])
        resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + 2**21,) * 2)
        try:
            {call}
        except MemoryError as error:
            print(error)
    """
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert run.returncode == 0 and run.stdout.startswith(message), run.stderr


def test_pictures_are_those_of_single_environments():
    envs = make_vec(2, render_mode="rgb_array")
    envs.LINK_LENGTH_1 = [1.0, 0.3]
    envs.reset(seed=1, options={"low": -2.0, "high": 2.0})
    for frame, state, length in zip(envs.render(), envs.state, (1.0, 0.3), strict=True):
        single = AcrobotEnv("rgb_array")
        single.LINK_LENGTH_1, single.state = length, state
        assert (frame == single.render()).all()


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
def test_states_can_be_set(gymnasium_episodes):
    envs = make_vec(40, gymnasium_episodes=gymnasium_episodes)
    envs.reset(seed=1)
    envs.step([2] * 40)
    before, elapsed = envs._native.__getstate__(), envs.elapsed_steps
    envs.state = envs.state
    assert envs._native.__getstate__() == before
    states = envs.state.copy()
    states[3] = 1.0, -1.0, 0.5, 300.0
    states[5] = 7.0, 0.0, 0.0, 0.0
    envs.state = states
    assert (envs.state == states).all() and (envs.elapsed_steps == elapsed).all()
    for array in (envs.state, envs.elapsed_steps):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    with rejects(envs, ValueError, "state must be num"):
        envs.state = states[0]
    beyond = states.astype(float)
    beyond[39, 3] = 1e39
    if gymnasium_episodes:
        envs.state = beyond
    else:
        with rejects(envs, ValueError, r"state\[39, 3\] must be in the range of .*, got 1e39"):
            envs.state = beyond


def test_after_close_nothing_works():
    envs = make_vec(2, render_mode="ansi")
    envs.reset()
    envs.close()
    envs.close()
    others = (lambda: envs.step([0, 1]), lambda: envs.call("dt"), lambda: envs.set_attr("dt", 0.1))
    for call in (envs.reset, envs.render, *others):
        with pytest.raises(ClosedEnvironmentError, match="closed"):
            call()


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
def test_torques_are_those_of_actions(gymnasium_episodes):
    """Those beyond the bounds, also beyond float32, act as the bounds of their environment."""
    arguments = {"max_episode_steps": 60, "gymnasium_episodes": gymnasium_episodes}
    discrete, torques = make_vec(30, **arguments), AcrobotContinuousVectorEnv(30, **arguments)
    assert_resets_equal(discrete, torques, seed=1)
    for bounds in ((3.0, -2.0, 0.0), np.float32(different(30, 0)["AVAIL_TORQUE"])):
        discrete.AVAIL_TORQUE = torques.AVAIL_TORQUE = bounds
        inside = np.broadcast_to(np.float32(bounds), (30, 3)).astype(float)
        is_end = [inside == end(axis=1, keepdims=True) for end in (inside.max, inside.min)]
        beyond = [np.select(is_end, ends, inside) for ends in ([np.inf, -9.0], [1e300, -1e39])]
        for kind in (np.float32(inside), *beyond):
            for actions in np.random.default_rng(0).integers(3, size=(100, 30)):
                chosen = kind[np.arange(30), actions][:, None]
                assert_equal(discrete.step(actions), torques.step(chosen))
    discrete.step([0] * 30)
    torques.step(np.full((30, 1), 0.5))
    assert (discrete.state != torques.state).any()


@pytest.mark.parametrize(
    ("kind", "count", "arguments"),
    [
        (AcrobotSwingupVectorEnv, 40_003, {}),
        *((kind, 40_003, {"torque_noise_max": 0.5}) for kind in INVALID),
        *((kind, 3_003, {"torque_noise_max": 0.5, "gymnasium_episodes": True}) for kind in INVALID),
    ],
)
def test_threads_change_no_bit(kind, count, arguments):
    plays = []
    for threads in (1, 3, None):
        envs = kind(count, 9, None, "SameStep", threads=threads, **arguments)
        envs.reset(seed=1)
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


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="needs fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.filterwarnings("ignore:os.fork:RuntimeWarning")
def test_threads_in_a_forked_process():
    """A child has none of its parent's threads. Waiting for them would take forever."""
    envs, actions = make_vec(40_000, threads=2), np.zeros(40_000, np.int64)
    envs.reset(seed=1)
    envs.step(actions)
    ours, theirs = multiprocessing.Pipe()
    child = multiprocessing.get_context("fork").Process(
        target=lambda: theirs.send(envs.step(actions)[0])
    )
    child.start()
    try:
        assert ours.poll(30), "the child hangs"
        assert (ours.recv() == envs.step(actions)[0]).all()
    finally:
        child.kill()
        child.join()


BUSY = (
    "another thread is stepping or resetting an environment; change parameters and "
    "call methods between its steps, or make an environment for each thread"
)


def test_a_call_during_a_step_is_rejected_and_changes_nothing():
    count = 500_000  # so many that a step takes long enough for another call
    envs = AcrobotVectorEnv(count, gymnasium_episodes=True, render_mode="ansi")
    states, actions = np.zeros((count, 4)), np.ones(count, np.int64)
    attributes = [("state", states), ("dt", 0.1), ("dt", Uniform(0.1, 0.2)), ("dt", [0.1])]
    functions = [pickle.dumps, copy.deepcopy, lambda envs: envs._native.__setstate__(b"")]
    calls = [
        *((lambda pair=pair: setattr(envs, *pair)) for pair in attributes),
        *((lambda function=function: function(envs)) for function in functions),
        *(lambda: envs.state, lambda: envs.elapsed_steps, envs.render),
    ]
    for call in calls:
        envs.reset()
        with ThreadPoolExecutor(1) as executor:
            step = executor.submit(envs.step, actions)
            with contextlib.suppress(RuntimeError):
                while not step.done():
                    len(envs._native)  # fails as soon as the step is under way
            with pytest.raises(RuntimeError) as raised:
                call()
            assert str(raised.value) == BUSY
            assert not step.done(), "more environments are necessary"
        step.result()
        assert envs.dt == 0.2 and (envs.elapsed_steps == 1).all()


def test_a_call_during_a_conversion_is_rejected():
    """As any call is without Python's lock, in a single environment too."""
    env = AcrobotEnv()
    calls, errors = (lambda: env.step(0), lambda: env.state, lambda: pickle.dumps(env)), []

    class Mass:
        def __float__(self):
            with ThreadPoolExecutor(1) as executor:
                errors.extend(executor.submit(call).exception() for call in calls)
            return 2.0

    env._native.set("LINK_MASS_1", Mass())
    assert [(type(each), str(each)) for each in errors] == [(RuntimeError, BUSY)] * 3


@pytest.mark.parametrize("kind", [AcrobotEnv, AcrobotVectorEnv])
def test_threads_that_share_an_environment_step_one_after_the_other_or_not(kind):
    """Also without Python's lock: the steps that raised no error are those that were made."""
    (env, twin), action = (kind(), kind()), 2 if kind is AcrobotEnv else [2]
    for each in env, twin:
        each.reset(seed=1)

    def play(_):
        steps = 0
        for _ in range(500):
            with contextlib.suppress(RuntimeError):
                env.step(action)
                steps += 1
        return steps

    with ThreadPoolExecutor(4) as executor:
        steps = sum(executor.map(play, range(4)))
    for _ in range(steps):
        twin.step(action)
    assert steps > 100 and env._native.__getstate__() == twin._native.__getstate__()


MASK = {"reset_mask": np.ones(3, bool)}
RESETS = ({}, {"seed": 2}, {"seed": [2] * 3}, {"seed": [2] * 3, "options": MASK})


@pytest.mark.parametrize("copies", [True, False])
def test_a_step_or_reset_beside_a_step_changes_nothing(copies):
    """Neither seeds nor observations that all calls share."""
    envs = AcrobotVectorEnv(3, copy=copies, autoreset_mode="Disabled")
    envs.reset(seed=1)
    actions = np.ones(3, int)
    twin, native = copy.deepcopy(envs), envs._native
    resets = (*RESETS, {"seed": 2, "options": {"state": np.zeros(4)}})
    calls = [lambda: envs.step(actions), *(lambda each=each: envs.reset(**each) for each in resets)]

    def step(*arguments):
        """The part of a step in Rust, and then calls of another thread."""
        envs._native = native
        results = native.step(*arguments)
        before = native.__getstate__(), envs.np_random_seed
        for call in calls:
            with ThreadPoolExecutor(1) as executor, pytest.raises(RuntimeError, match=BUSY):
                executor.submit(call).result()
            assert before == (native.__getstate__(), envs.np_random_seed)
        return results

    envs._native = SimpleNamespace(step=step)
    assert_equal(envs.step(actions), twin.step(actions))
    assert native.__getstate__() == twin._native.__getstate__()


def test_steps_in_float64_are_gymnasiums_but_for_rounding():
    envs, twin = make_vec(500, float64=True), make_vec(500, gymnasium_episodes=True)
    states = np.random.default_rng(0).uniform([-3, -3, -10, -20], [3, 3, 10, 20], (500, 4))
    for each in (envs, twin):
        each.reset(seed=0)
        each.state = states
    found, expected = (each.step(np.arange(500) % 3) for each in (envs, twin))
    for one, other, bound in zip(found[:4], expected[:4], (1e-6, 0, 0, 0), strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=bound)
    assert np.abs(envs.state - twin.state).max() < 1e-12
    assert (envs.state == twin.state).all(axis=1).sum() > 480  # the C library rounds some sines
