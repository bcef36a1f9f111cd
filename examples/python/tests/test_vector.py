"""The vector environment has the documented streams, resets as SyncVectorEnv does, and steps as Gymnasium does within float32."""

import collections
import contextlib
import copy
import itertools
import multiprocessing
import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from acrobot_rs import Uniform
from acrobot_rs.parameters import _NAMES as NAMES
from acrobot_rs.vector import AcrobotContinuousVectorEnv
from gymnasium.error import ClosedEnvironmentError, InvalidAction, ResetNeeded
from gymnasium.vector import AutoresetMode

V1 = "acrobot_rs/Acrobot-v1"
CONTINUOUS = "acrobot_rs/AcrobotContinuous-v0"
MODES = pytest.mark.parametrize("mode", AutoresetMode)


def make_vec(num_envs, **kwargs):
    return gymnasium.make_vec(V1, num_envs=num_envs, vectorization_mode="vector_entry_point", **kwargs)


def pair(num_envs, mode="NextStep", **kwargs):
    """Gymnasium's SyncVectorEnv of Gymnasium's Acrobot, and ours with the same episodes."""
    theirs = gymnasium.make_vec(
        "Acrobot-v1", num_envs=num_envs, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode}, **kwargs
    )
    return theirs, make_vec(num_envs, autoreset_mode=mode, gymnasium_episodes=True, **kwargs)


def assert_equal(one, other):
    """Compares what `reset` or `step` returned: values, types and infos."""
    for a, b in zip(one[:-1], other[:-1], strict=True):
        assert a.dtype == b.dtype
        np.testing.assert_array_equal(a, b)
    # Lists, because NumPy does not compare arrays of arrays.
    np.testing.assert_equal(*({key: list(value) for key, value in each[-1].items()} for each in (one, other)))


def reset_ended(envs, ended):
    """Resets environments whose episode has ended, if they have no autoreset."""
    if ended.any() and envs.metadata["autoreset_mode"] is AutoresetMode.DISABLED:
        envs.reset(options={"reset_mask": ended.copy()})


def test_attributes_and_types_are_those_of_sync_vector_env():
    theirs, ours = pair(5)
    names = ("num_envs", "observation_space", "action_space", "single_observation_space", "single_action_space")
    for name in (*names, "autoreset_mode", "render_mode", "copy", "closed"):
        assert getattr(ours, name) == getattr(theirs, name)
    assert repr(ours) == "AcrobotVectorEnv(acrobot_rs/Acrobot-v1, num_envs=5)"
    assert ours.unwrapped is ours and ours.spec.max_episode_steps == 500
    with pytest.raises(AttributeError):  # an assignment would have no effect
        ours.max_episode_steps = 5
    for mode in AutoresetMode:
        envs = make_vec(5, autoreset_mode=mode)
        assert envs.metadata["autoreset_mode"] is mode
        observations, infos = envs.reset(seed=1)
        assert observations in envs.observation_space and infos == {}
        observations, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
        assert observations in envs.observation_space and infos == {}
        for signals, dtype in [(rewards, np.float32), (terminated, np.bool_), (truncated, np.bool_)]:
            assert signals.shape == (5,) and signals.dtype == dtype
    assert acrobot_rs.AcrobotVectorEnv.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP


def test_a_step_in_float32_is_gymnasium_s_within_rounding():
    envs, single = make_vec(64), gymnasium.make("Acrobot-v1").unwrapped
    single.reset(seed=0)
    envs.reset(seed=3)
    reached = 0
    for actions in np.random.default_rng(1).integers(3, size=(50, 64)):
        envs.reset(options={"low": -3.0, "high": 3.0})
        states = envs.state
        observations, rewards, terminated, *_ = envs.step(actions)
        for i, action in enumerate(actions):
            single.state = states[i].astype(np.float64)
            observation, reward, goal, _, _ = single.step(action)
            np.testing.assert_allclose(observations[i], observation, atol=2e-3)
            height = -np.cos(single.state[0]) - np.cos(single.state[0] + single.state[1])
            assert (terminated[i] == goal and rewards[i] == reward) or abs(height - 1.0) < 1e-3
            reached += goal
    assert reached > 20


def test_streams_are_the_seed_s_children_whatever_the_number_of_environments():
    small, large = make_vec(5), make_vec(100)
    for seed in [0, 42, 2**100 + 3]:
        small.reset(seed=seed), large.reset(seed=seed)
        states = [np.random.default_rng(child).uniform(-0.1, 0.1, 4) for child in np.random.SeedSequence(seed).spawn(100)]
        assert (large.state == np.float32(states)).all()
        assert large.np_random_seed == seed
        for actions in np.random.default_rng(0).integers(3, size=(700, 100)):
            small.step(actions[:5])
            large.step(actions)
            assert (small.state == large.state[:5]).all()
    assert (make_vec(5).reset()[0] != make_vec(5).reset()[0]).any(), "without a seed initial states are random"


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


@pytest.mark.parametrize(
    ("kind", "actions"),
    [*((acrobot_rs.AcrobotVectorEnv, actions) for actions in (
        [0, 1, 2, 3], [0, 0, 0, -1], [0, 0, 256, 0], [2**32] * 4, [0, 1, 2], [[0, 1, 2, 0]], [0.0, 1.0, 2.0, 0.0], 1,
        np.array([0, 0, 0, 2**63], dtype=np.uint64), b"\0\1\2\0", np.zeros((4, 1), np.float32))),
     *((AcrobotContinuousVectorEnv, actions) for actions in (
        [[0.5]], [0.5] * 4, [[0.5, 0.5]] * 4, [[np.nan], [0.0], [0.0], [0.0]], [["0"]] * 4, [[True]] * 4, [[1j]] * 4,
        np.zeros(4, np.int64), np.zeros(4, np.float32), np.zeros((4, 1), object))),
     *((kind, actions) for kind in (acrobot_rs.AcrobotVectorEnv, AcrobotContinuousVectorEnv) for actions in (
        "0120", bytearray(4), dict.fromkeys(range(4), 1), {0, 1, 2}, iter([0] * 4), collections.UserDict.fromkeys(range(4), 1),
        [True] * 4, [1j] * 4, [None] * 4, np.zeros(4, object), [[0], [1, 2]], None))],
)  # fmt: skip
def test_invalid_actions_are_rejected(kind, actions):
    envs = kind(4)
    envs.reset(seed=1)
    before = envs._native.__getstate__()
    with pytest.raises(
        InvalidAction, match=r"actions must be \w+ of shape \(4, ?1?\), got |actions\[\d\] must be (0|a number)"
    ):
        envs.step(actions)
    assert envs._native.__getstate__() == before


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


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *(("num_envs", count) for count in (0, -1, 2**40)),
        *(("max_episode_steps", count) for count in (0, 2**32)),
        *(("autoreset_mode", mode) for mode in ("nextstep", None, 1, [])),
        ("threads", 0),
        ("render_mode", "human"),
    ],
)
def test_invalid_arguments_are_rejected(name, value):
    with pytest.raises(ValueError, match=f"^{name} must be "):
        acrobot_rs.AcrobotVectorEnv(**{"num_envs": 2, name: value})


@pytest.mark.parametrize(
    ("call", "message"),
    [("acrobot_rs.AcrobotVectorEnv(2**32 - 1)", "num_envs must be so few that they fit into memory, got 4294967295"),
     ("batch.step(None, actions, observations)", "a step does not fit into memory")],
)  # fmt: skip
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


def test_rejected_seeds_and_bounds_change_nothing():
    envs = make_vec(2)
    envs.reset(seed=True)  # Gymnasium accepts it as 1
    assert envs.np_random_seed == 1
    before = envs._native.__getstate__(), envs.np_random_seed, envs.np_random.bit_generator.state
    bad_seeds = (-1, "4", 4.0, np.int64(4), 10**5000)
    bad_options = ({"low": 1, "high": 0}, {"high": np.inf}, {"lo": 1}, {"low": 1, "reset_mask": [True, False]})
    for seed in (*bad_seeds, [1], (1,) * 3, *([1, bad] for bad in bad_seeds), None):
        for options in bad_options if seed is None else ({},):
            with pytest.raises((ValueError, gymnasium.error.Error)):
                envs.reset(seed=seed or 1, options=options)
            assert (envs._native.__getstate__(), envs.np_random_seed, envs.np_random.bit_generator.state) == before


@pytest.mark.parametrize(
    ("mask", "error"),
    [(None, TypeError), ([1, 0], TypeError), (True, ValueError), ([False, False], ValueError), ([True], ValueError),
     ([True, False, True], ValueError), ([[True, False]], ValueError)],
)  # fmt: skip
def test_invalid_masks_are_rejected_with_the_errors_of_sync_vector_env(mask, error):
    theirs, ours = pair(2)
    with pytest.raises((error, AssertionError)):  # the latter with Gymnasium 1.1
        theirs.reset(seed=1, options={"reset_mask": mask and np.array(mask)})
    before, options = ours._native.__getstate__(), {"reset_mask": mask}
    with pytest.raises(error, match=r"reset_mask must (be an array of bool|have shape \(2,\) and a true element), got"):
        ours.reset(seed=1, options=options)
    assert ours._native.__getstate__() == before and options == {"reset_mask": mask}


def test_a_mask_selects_the_environments_to_seed_and_reset():
    """In float32. With Gymnasium's episodes another test compares with SyncVectorEnv."""
    envs = make_vec(40)
    envs.reset(seed=1)
    envs.step([2] * 40)
    mask = np.arange(80) % 3 == 0
    seeds = [None if i == 3 else 2**70 + i for i in range(40)]
    children = np.random.SeedSequence(5).spawn(40)
    for seed, streams in [(5, children), (seeds, seeds)]:
        before, twin = envs.state, copy.deepcopy(envs)
        observations, infos = envs.reset(seed=seed, options={"reset_mask": mask[::2], "low": -0.5})
        twin.reset(options={"low": -0.5})
        seeded = np.float32([np.random.default_rng(stream).uniform(-0.5, 0.1, 4) for stream in streams])
        if streams is seeds:
            seeded[3] = twin.state[3]  # continues its stream
        assert infos == {} and envs.np_random_seed == 5
        assert (envs.state == np.where(mask[::2, None], seeded, before)).all()
        assert (observations[:, 4:] == envs.state[:, 2:]).all()


def test_other_bytes_than_0_and_1_in_a_mask_become_1():
    """A NumPy bool can be any byte. In Rust a bool that is not 0 or 1 is undefined behaviour."""
    mask = make_vec(4)._mask({"reset_mask": np.array([2, 0, 255, 0], np.uint8).view(np.bool_)})
    assert mask.tobytes() == b"\1\0\1\0"


def test_pictures_are_those_of_single_environments():
    envs = make_vec(2, render_mode="rgb_array")
    envs.LINK_LENGTH_1 = [1.0, 0.3]
    envs.reset(seed=1, options={"low": -2.0, "high": 2.0})
    for frame, state, length in zip(envs.render(), envs.state, (1.0, 0.3), strict=True):
        single = acrobot_rs.AcrobotEnv("rgb_array")
        single.LINK_LENGTH_1, single.state = length, state
        assert (frame == single.render()).all()
    with pytest.warns(UserWarning, match="without a render mode"):
        assert make_vec(2).render() is None


def different(count, seed):
    """A value of each parameter for each of these environments."""
    rng = np.random.default_rng(seed)
    values = {name: list(rng.uniform(0.8, 1.2, count)) for name in NAMES if name.startswith("LINK")}
    values["dt"] = tuple(rng.uniform(0.05, 0.25, count).tolist())
    values["MAX_VEL_1"] = rng.uniform(2, 12, count)
    values["MAX_VEL_2"] = rng.uniform(2, 28, count).astype(np.float32)
    values["AVAIL_TORQUE"] = rng.uniform(-2, 2, (count, 3))
    values["torque_noise_max"] = rng.choice([0.0, 0.5], count)
    values["book_or_nips"] = rng.choice(["book", "nips"], count).tolist()
    assert values.keys() == set(NAMES)
    return values


@pytest.mark.parametrize("noise", [0.0, 0.5])
@MODES
def test_gymnasium_s_episodes_bit_identically(mode, noise):
    """Resets with seeds, bounds and masks, parameters of each environment, and thousands of steps of each."""
    theirs, ours = pair(6, mode, max_episode_steps=150)
    for envs in (theirs, ours):
        envs.set_attr("torque_noise_max", noise)
    assert_equal(expected := theirs.reset(seed=2**70), ours.reset(seed=2**70))
    rng = np.random.default_rng(0)
    ends = np.zeros(2, int)
    for step in range(3000):
        actions = np.where(rng.random(6) < 0.3, rng.integers(3, size=6), np.where(expected[0][:, 4] > 0, 0, 2))
        expected, found = theirs.step(actions), ours.step(actions)
        assert_equal(expected, found)
        np.testing.assert_array_equal(np.array(theirs.get_attr("state"), np.float64), ours.state)
        np.testing.assert_array_equal(theirs.get_attr("_elapsed_steps"), ours.elapsed_steps)
        ended = expected[2] | expected[3]
        ends += expected[2].sum(), expected[3].sum()
        if step in (2400, 2550, 2700, 2850):
            for name, values in different(6, step).items():
                theirs.set_attr(name, list(values))
                ours.set_attr(name, values) if step == 2400 else setattr(ours, name, values)
                np.testing.assert_array_equal(getattr(ours, name), values)
                np.testing.assert_array_equal(ours.get_attr(name), theirs.get_attr(name))
            assert not ours.LINK_MASS_1.flags.writeable
        options = {"low": -0.4, "high": 0.7}
        if step == 1000:
            assert_equal(theirs.reset(options=options), ours.reset(options=options))
        elif step == 1200:
            for envs in (theirs, ours):
                envs.set_attr("LINK_MASS_2", 1.5)
                envs.set_attr("book_or_nips", "nips")
        elif step == 1400:
            seeds = [5, None, 7, 2**80, None, 5]
            assert_equal(theirs.reset(seed=seeds), ours.reset(seed=seeds))
        elif step in (1600, 1601) or (mode is AutoresetMode.DISABLED and ended.any()):
            mask = ended | (np.arange(6) % 3 == step % 3)
            options, twins = options | {"reset_mask": mask}, options | {"reset_mask": mask}
            assert_equal(theirs.reset(seed=step, options=options), ours.reset(seed=step, options=twins))
            assert options == twins, "the mask is removed"
    assert (ends > 20).all()
    ours.dt = 0.1
    assert ours.dt == 0.1 and ours.get_attr("dt") == (0.1,) * 6


@MODES
def test_observations_of_initial_states_bit_identically(mode):
    """Gymnasium computes them in float32. One in 500 differs from the rounded sines of float64, so this takes thousands."""
    theirs, ours = pair(500, mode, max_episode_steps=1)
    assert_equal(theirs.reset(seed=1), ours.reset(seed=1))
    mask = np.arange(500) % 2 == 0
    for bounds in ({"low": -0.4, "high": 0.7}, {"low": -9.0, "high": 9.0}):
        assert_equal(theirs.reset(options={**bounds}), ours.reset(options={**bounds}))
        for some in (mask, ~mask):
            one, other = ({**bounds, "reset_mask": some.copy()} for _ in range(2))
            assert_equal(theirs.reset(options=one), ours.reset(options=other))
    for actions in np.random.default_rng(0).integers(3, size=(20, 500)):
        assert_equal(theirs.step(actions), ours.step(actions))
        if mode is AutoresetMode.DISABLED:
            one, other = ({"reset_mask": np.ones(500, bool)} for _ in range(2))
            assert_equal(theirs.reset(options=one), ours.reset(options=other))


def test_a_step_before_the_first_reset_is_rejected():
    for envs in pair(2, render_mode="rgb_array"):
        for call in (lambda: envs.step(np.array([0, 1])), envs.render):  # noqa: B023
            with pytest.raises(ResetNeeded):
                call()
        envs.reset()
        envs.step(np.array([0, 1]))


def test_without_autoreset_an_ended_episode_must_be_reset():
    theirs, ours = pair(3, "Disabled", max_episode_steps=5)
    for envs in (theirs, ours, pickle.loads(pickle.dumps(ours))):
        envs.reset(seed=1)
        for _ in range(5):
            envs.step(np.array([0, 1, 2]))
        both = (envs,) if envs is theirs else (envs, copy.deepcopy(envs))
        for each, mask in itertools.product(both, ([True, True, False], [False, False, True])):
            with pytest.raises((AssertionError, ResetNeeded)):
                each.step(np.array([0, 1, 2]))
            each.reset(options={"reset_mask": np.array(mask)})
        assert not envs.step(np.array([0, 1, 2]))[3].any()
    for _ in range(4):
        ours.step([0, 1, 2])
    before = ours._native.__getstate__()
    with pytest.raises(ResetNeeded, match="the episode of environment 0 has ended; reset it before the next step"):
        ours.step([0, 1, 2])
    assert ours._native.__getstate__() == before


def test_attributes_of_each_environment():
    theirs, ours = pair(3, render_mode="rgb_array")
    states = np.random.default_rng(0).uniform(-1, 1, (3, 4))
    for envs in (theirs, ours):
        envs.reset(seed=1)
        for get in (envs.call, envs.get_attr):
            with pytest.raises(AttributeError):
                get("length")
        for values in ([1.0], (1.0,) * 4):
            with pytest.raises(ValueError, match="3"):
                envs.set_attr("LINK_MOI", values)
    for values in (list(states), tuple(states), states[0]):
        for envs in (theirs, ours):
            envs.set_attr("state", values)
        assert_equal(theirs.step(np.array([0, 1, 2])), ours.step([0, 1, 2]))
    for name in ("action_space", "observation_space", "render_mode", "state", *NAMES):
        for get in ("get_attr", "call"):
            expected, found = getattr(theirs, get)(name), getattr(ours, get)(name)
            assert isinstance(found, tuple)
            # A list in Gymnasium, where a change of it would have an effect.
            np.testing.assert_equal([list(x) if name == "AVAIL_TORQUE" else x for x in found], [*expected])
    assert ours.get_attr("elapsed_steps") == theirs.get_attr("_elapsed_steps")
    assert len(ours.call("render")) == 3 and (ours.call("render")[2] == ours.render()[2]).all()
    with pytest.raises(AttributeError, match="no attribute 'length'; they have .*elapsed_steps.*LINK_LENGTH_1"):
        ours.call("length")
    before = ours._native.__getstate__()
    for name, error in [("state", ValueError), ("length", AttributeError), ("elapsed_steps", AttributeError)]:
        with pytest.raises(error, match=name):
            ours.set_attr(name, [1.0] * 3)
        assert ours._native.__getstate__() == before


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
def test_states_can_be_set(gymnasium_episodes):
    envs = make_vec(40, gymnasium_episodes=gymnasium_episodes)
    envs.reset(seed=1)
    envs.step([2] * 40)
    before, elapsed = envs._native.__getstate__(), envs.elapsed_steps
    envs.state = envs.state
    assert envs._native.__getstate__() == before
    states = envs.state
    states[3] = 1.0, -1.0, 0.5, 300.0
    states[5] = 7.0, 0.0, 0.0, 0.0
    envs.state = states
    assert (envs.state == states).all() and (envs.elapsed_steps == elapsed).all()
    for row, column, number in [(39, 3, np.nan), (0, 2, -np.inf), *([] if gymnasium_episodes else [(7, 0, 1e39)])]:
        bad = states.astype(np.float64) + 1.0
        bad[row, column] = number
        with pytest.raises(ValueError, match=rf"state\[{row}, {column}\] must be a finite number, got "):
            envs.state = bad
    for bad in [states[:39], states.T, states[0], None, [["1"] * 4] * 40, states > 0]:
        with pytest.raises(ValueError, match=r"state must be numbers of shape \(40, 4\), got"):
            envs.state = bad
    assert (envs.state == states).all()


def test_after_close_nothing_works():
    envs = make_vec(2, render_mode="ansi")
    envs.reset()
    for _ in range(2):
        envs.close()
    assert envs.closed
    for call in (envs.reset, envs.render, lambda: envs.step([0, 1]), lambda: envs.call("dt"), lambda: envs.set_attr("dt", 0.1)):
        with pytest.raises(ClosedEnvironmentError, match="closed"):
            call()


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


@MODES
def test_continuous_torques_give_the_episodes_of_single_environments(mode):
    """Also if environments have different bounds of the torque."""
    theirs = gymnasium.make_vec(
        CONTINUOUS, num_envs=6, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode}, max_episode_steps=60
    )
    ours = gymnasium.make_vec(CONTINUOUS, num_envs=6, autoreset_mode=mode, gymnasium_episodes=True, max_episode_steps=60)
    assert isinstance(ours, AcrobotContinuousVectorEnv) and ours.action_space == theirs.action_space
    assert_equal(theirs.reset(seed=1), ours.reset(seed=1))
    for step, actions in enumerate(np.random.default_rng(0).uniform(-1.5, 1.5, (300, 6, 1)).astype(np.float32)):
        if step == 150:
            for envs in (theirs, ours):
                envs.set_attr("AVAIL_TORQUE", different(6, 0)["AVAIL_TORQUE"].tolist())
        expected = theirs.step(actions)
        assert_equal(expected, ours.step(actions))
        for envs in (theirs, ours):
            reset_ended(envs, expected[2] | expected[3])


def test_torques_in_float32_are_those_of_actions():
    """Torques beyond the bounds, which are those of AVAIL_TORQUE, act as the bounds."""

    class Strong(AcrobotContinuousVectorEnv):
        AVAIL_TORQUE = (3.0, -2.0, 0.0)

    discrete, torques = make_vec(30, autoreset_mode="SameStep", max_episode_steps=60), Strong(30, 60, None, "SameStep")
    discrete.AVAIL_TORQUE = Strong.AVAIL_TORQUE
    assert torques.single_action_space == gymnasium.spaces.Box(-2.0, 3.0, (1,), np.float32)
    assert torques.action_space == gymnasium.spaces.Box(-2.0, 3.0, (30, 1), np.float32)
    assert_equal(discrete.reset(seed=1), torques.reset(seed=1))
    for kind in (np.float32([3, -2, 0]), np.float64([np.inf, -9.0, 0.0])):
        for actions in np.random.default_rng(0).integers(3, size=(100, 30)):
            assert_equal(discrete.step(actions), torques.step(kind[actions][:, None]))
    discrete.step([0] * 30)
    torques.step(np.full((30, 1), 0.5))
    assert (discrete.state != torques.state).any()


#: All parameters that can be drawn, in the order of their draws.
DRAWN = (
    *("LINK_LENGTH_1", "LINK_LENGTH_2", "LINK_MASS_1", "LINK_MASS_2", "LINK_COM_POS_1", "LINK_COM_POS_2"),
    *("dt", "MAX_VEL_1", "MAX_VEL_2", "AVAIL_TORQUE", "torque_noise_max"),
)


@pytest.mark.parametrize("names", [DRAWN, ("LINK_MASS_1",), ("dt", "AVAIL_TORQUE")])
@pytest.mark.parametrize("gymnasium_episodes", [False, True])
def test_resets_draw_parameters_as_numpy_does(names, gymnasium_episodes):
    """Those of all environments, those with a mask, and those within steps."""
    count, rounded = 20, np.float64 if gymnasium_episodes else np.float32
    envs = make_vec(count, max_episode_steps=2, gymnasium_episodes=gymnasium_episodes)
    envs.reset(seed=3)
    ranges = {}
    for name in names[::-1]:  # the order of draws is not that of the assignments
        low, high = ((-1.5, 0.0, 0.5), (-0.5, 0.0, 1.5)) if name == "AVAIL_TORQUE" else (0.3, 1.7)
        setattr(envs, name, Uniform(low, high))
        assert getattr(envs, name) == Uniform(low, high)
        ranges[name] = rounded(low).astype(float), rounded(high).astype(float)
        assert len(set(envs.get_attr(name))) == 1, "the next reset draws"
    if gymnasium_episodes:
        streams = [np.random.default_rng(42 + i) for i in range(count)]
    else:
        streams = [np.random.default_rng(child) for child in np.random.SeedSequence(42).spawn(count)]

    def check(which):
        for i in np.flatnonzero(which):
            for name in names:
                low, high = ranges[name]
                # What has equal bounds, here a torque, is not drawn.
                bounds = np.transpose([np.ravel(low), np.ravel(high)])
                drawn = [rounded(streams[i].uniform(*both)) if both[0] < both[1] else both[0] for both in bounds]
                assert (np.ravel(envs.get_attr(name)[i]) == drawn).all(), name
            assert (envs.state[i] == np.float32(streams[i].uniform(-0.1, 0.1, 4))).all()

    every = np.ones(count, bool)
    envs.reset(seed=42)
    check(every)
    envs.reset(options={"reset_mask": every & (np.arange(count) % 3 == 0)})
    check(np.arange(count) % 3 == 0)
    for _ in range(6):
        before = envs.elapsed_steps
        envs.step(np.ones(count, int))
        for i in np.flatnonzero(before < 2):
            streams[i].uniform(size=int("torque_noise_max" in names))
        check(before == 2)
    first = names[0]
    setattr(envs, first, 1.0)
    envs.reset()
    assert getattr(envs, first) == 1.0 and envs._native.get(first) == [1.0] * count


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
@pytest.mark.parametrize(
    ("name", "value", "error", "message"),
    [
        ("LINK_MASS_1", [1.0, 0.0, 2.0], ValueError, r"LINK_MASS_1\[1\] must be finite and above 0 kg, got 0"),
        ("LINK_MASS_1", [1.0, 2.0, None], TypeError, r"LINK_MASS_1\[2\] must be a number, got None"),
        ("LINK_MASS_1", [1.0, 2.0], ValueError, "LINK_MASS_1 must be one value, or one for each of 3 environments, got 2 values"),
        ("LINK_COM_POS_1", [0.1, 0.0, 0.0], ValueError, r"LINK_MOI\[1\] must be above 0 kg m² if the centre of mass"),
        ("AVAIL_TORQUE", [[1, 2, 3]] * 2 + [[1, np.inf, 3]], ValueError, r"AVAIL_TORQUE\[2\]\[1\] must be a finite number"),
        ("AVAIL_TORQUE", [[1, 2, 3], [1, 2], [1, 2, 3]], ValueError, r"AVAIL_TORQUE\[1\] must be 3 numbers, got 2"),
        ("book_or_nips", ["book", "nips", "bok"], ValueError, r'book_or_nips\[2\] must be "book" or "nips", got "bok"'),
        ("dt", Uniform(0.0, 1.0), ValueError, "dt must be finite and above 0 s, got 0"),
        ("dt", Uniform(0.2, None), TypeError, "dt must be a number, got None"),
        ("LINK_MASS_1", Uniform(1.2, 0.8), ValueError, "the lower LINK_MASS_1 must not be above the upper one, got 1.2"),
        ("LINK_MOI", Uniform(1.0, 2.0), ValueError, "LINK_MOI must be a value or an array, not a Uniform"),
        ("book_or_nips", Uniform("book", "nips"), ValueError, "book_or_nips must be a value or an array, not a Uniform"),
    ],
)  # fmt: skip
def test_a_rejected_parameter_changes_nothing(name, value, error, message, gymnasium_episodes):
    envs = make_vec(3, gymnasium_episodes=gymnasium_episodes)
    envs.LINK_MOI = 0.0
    for mass in (1.0, [1.0, 1.5, 2.0], Uniform(1.0, 2.0)):
        # A range and different values of another parameter are rejected together, for which there is another test.
        if isinstance(mass, Uniform if isinstance(value, list) else list) and name != "LINK_MASS_1":
            continue
        envs.LINK_MASS_1 = mass
        envs.reset(seed=1)
        before = envs._native.__getstate__(), envs.get_attr(name)
        for attempt in (setattr, acrobot_rs.AcrobotVectorEnv.set_attr):
            with pytest.raises(error, match=f"^{message}"):
                attempt(envs, name, value)
            assert (envs._native.__getstate__(), envs.get_attr(name)) == before


def test_a_range_and_different_values_are_rejected_together():
    """A reset would draw all parameters, also those with different values."""
    envs = make_vec(3)
    envs.LINK_MASS_1 = [1.0, 1.5, 2.0]
    message = "LINK_MASS_1 must be one value for all environments, if dt has a Uniform"
    with pytest.raises(ValueError, match=message):
        envs.dt = Uniform(0.1, 0.2)
    envs.LINK_MASS_1 = Uniform(1.0, 2.0)
    message = "LINK_MASS_1 must be a value or an array, not a Uniform, if dt has different values"
    with pytest.raises(ValueError, match=message):
        envs.dt = [0.1, 0.2, 0.3]
    envs.LINK_MASS_1 = 1.0
    envs.dt = [0.1, 0.2, 0.3]
    assert envs.get_attr("dt") == (0.1, 0.2, 0.3)


def test_subclasses_can_draw_parameters():
    class Random(AcrobotContinuousVectorEnv):
        MAX_VEL_1 = Uniform(20.0, 30.0)
        AVAIL_TORQUE = Uniform([-3.0, 0.0, 1.0], [-2.0, 0.0, 2.0])

    envs = Random(50)
    assert envs.single_observation_space.high[4] == 30
    assert envs.single_action_space == gymnasium.spaces.Box(-3.0, 2.0, (1,), np.float32)
    envs.reset(seed=1)
    assert len(set(envs.get_attr("MAX_VEL_1"))) == 50
    with pytest.raises(ValueError, match="the lower MAX_VEL_1 must not be above"):
        type("Wrong", (Random,), {"MAX_VEL_1": Uniform(3.0, 2.0)})
    with pytest.raises(TypeError, match="LINK_MASS_1 must be a number, got Uniform"):
        acrobot_rs.AcrobotEnv().LINK_MASS_1 = Uniform(1.0, 2.0)
