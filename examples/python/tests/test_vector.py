"""The vector environment has the documented streams, resets as SyncVectorEnv does, and steps as Gymnasium does within float32."""

import collections
import contextlib
import copy
import functools
import multiprocessing
import pickle
import subprocess
import sys
import threading
import time
import unittest.mock
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
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.wrappers.vector import RecordEpisodeStatistics

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


def play(envs, steps, seed):
    """Plays random actions and returns all results."""
    rng = np.random.default_rng(seed)
    played = []
    for _ in range(steps):
        *results, infos = envs.step(rng.integers(3, size=envs.num_envs))
        played.append([results, {key: list(value) for key, value in infos.items()}, envs.state])
        reset_ended(envs, results[2] | results[3])
    return played


def reset_ended(envs, ended):
    """Resets environments whose episode has ended, if they have no autoreset."""
    if ended.any() and envs.metadata["autoreset_mode"] is AutoresetMode.DISABLED:
        return envs.reset(options={"reset_mask": ended.copy()})
    return None


def test_make_vec_gives_no_warning_and_gymnasium_s_spaces():
    envs = make_vec(5)
    theirs = gymnasium.make_vec("Acrobot-v1", num_envs=5, vectorization_mode="sync")
    assert envs.observation_space == theirs.observation_space
    assert envs.action_space == theirs.action_space
    assert envs.single_observation_space == theirs.single_observation_space
    assert envs.single_action_space == theirs.single_action_space
    assert envs.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    assert envs.spec.max_episode_steps == 500
    observations, infos = envs.reset(seed=1)
    assert observations in envs.observation_space and infos == {}
    observations, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
    assert observations in envs.observation_space and infos == {}
    for signals, dtype in [(rewards, np.float32), (terminated, np.bool_), (truncated, np.bool_)]:
        assert signals.shape == (5,) and signals.dtype == dtype
    envs.close()


@MODES
def test_resets_are_those_of_sync_vector_env(mode):
    """Compares with Gymnasium's Acrobot in Gymnasium's vector environment, with the same streams. Episodes are so short that
    float32 and float64 stay close."""
    count, seed, limit = 33, 7, 5
    theirs = SyncVectorEnv([lambda: gymnasium.make("Acrobot-v1", max_episode_steps=limit)] * count, autoreset_mode=mode)
    children = np.random.SeedSequence(seed).spawn(count)
    for env, child in zip(theirs.envs, children, strict=True):
        env.unwrapped.np_random = np.random.default_rng(child)
    ours = make_vec(count, max_episode_steps=limit, autoreset_mode=mode)
    assert ours.metadata["autoreset_mode"] is theirs.metadata["autoreset_mode"]
    assert acrobot_rs.AcrobotVectorEnv.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    expected, found = theirs.reset(), ours.reset(seed=seed)
    rng = np.random.default_rng(0)
    ends = 0
    for step in range(60):
        np.testing.assert_allclose(found[0], expected[0], atol=1e-5)
        np.testing.assert_equal(found[1:-1], expected[1:-1])
        np.testing.assert_equal(list(found[-1]), list(expected[-1]))
        for key, value in expected[-1].items():
            if key == "final_obs":
                for one, other in zip(found[-1][key], value, strict=True):
                    assert (one is None) == (other is None)
                    if one is not None:
                        np.testing.assert_allclose(one, other, atol=1e-5)
            else:
                np.testing.assert_equal(found[-1][key], value)
        # Resets continue the streams. Their bounds are for one reset.
        bounds = {"low": -0.5, "high": 1.0}
        if step % 20 == 10:
            expected, found = theirs.reset(options=bounds), ours.reset(options=bounds)
        elif mode is AutoresetMode.DISABLED and len(expected) == 5 and (ended := expected[2] | expected[3]).any():
            found = ours.reset(options=bounds | {"reset_mask": ended.copy()})
            expected = theirs.reset(options=bounds | {"reset_mask": ended})
        else:
            actions = rng.integers(3, size=count)
            expected, found = theirs.step(actions), ours.step(actions)
        ends += len(expected) == 5 and int(expected[3].sum())
    assert ends > 200


@MODES
def test_goals_end_episodes_as_in_sync_vector_env(mode):
    """Compares each step with a step of Gymnasium's environment from the same state."""
    envs = make_vec(64, autoreset_mode=mode)
    envs.reset(seed=3, options={"low": -3.0, "high": 3.0})
    single = gymnasium.make("Acrobot-v1").unwrapped
    single.reset(seed=0)
    resets, reached = np.zeros(64, bool), 0
    for actions in np.random.default_rng(1).integers(3, size=(50, 64)):
        states = envs.state
        observations, rewards, terminated, truncated, infos = envs.step(actions)
        for i in np.flatnonzero(~resets):
            single.state = states[i].astype(np.float64)
            observation, reward, goal, _, _ = single.step(actions[i])
            height = -np.cos(single.state[0]) - np.cos(single.state[0] + single.state[1])
            if abs(height - 1.0) < 1e-3:
                continue
            assert terminated[i] == goal and rewards[i] == reward
            seen = infos["final_obs"][i] if goal and mode is AutoresetMode.SAME_STEP else observations[i]
            np.testing.assert_allclose(seen, observation, atol=2e-3)
            reached += goal
        assert not rewards[resets].any() and not terminated[resets].any()
        if mode is AutoresetMode.NEXT_STEP:
            resets = terminated | truncated
        reset_ended(envs, terminated | truncated)
    assert reached > 20


def test_streams_are_the_seed_s_children_whatever_the_number_of_environments():
    small, large = make_vec(5), make_vec(100)
    for seed in [0, 42, 2**100 + 3]:
        small.reset(seed=seed), large.reset(seed=seed)
        states = [
            np.random.default_rng(child).uniform(-0.1, 0.1, 4) for child in np.random.SeedSequence(seed).spawn(100)
        ]
        assert (large.state == np.float32(states)).all()
        assert large.np_random_seed == seed
        for actions in np.random.default_rng(0).integers(3, size=(700, 100)):
            small.step(actions[:5])
            large.step(actions)
            assert (small.state == large.state[:5]).all()
    assert (make_vec(5).reset()[0] != make_vec(5).reset()[0]).any(), "without a seed initial states are random"
    with pytest.raises(gymnasium.error.Error):
        small.reset(seed=-1)


PROTOCOLS = [functools.partial(pickle.dumps, protocol=protocol) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]


@pytest.mark.parametrize("noise", [0.3, np.linspace(0, 0.3, 37), Uniform(0.0, 0.3)], ids=["shared", "each", "drawn"])
@pytest.mark.parametrize("again", [copy.deepcopy, *(lambda envs, dumps=dumps: pickle.loads(dumps(envs)) for dumps in PROTOCOLS)])
@MODES
def test_copies_continue_bit_identically(mode, again, noise):
    envs = make_vec(37, autoreset_mode=mode, max_episode_steps=90)
    envs.torque_noise_max = noise
    envs.book_or_nips = "nips"
    envs.reset(seed=1, options={"low": -1.0, "high": 0.5})
    play(envs, 90, 2)  # in mode NEXT_STEP the next step resets all
    twin = again(envs)
    np.testing.assert_equal(play(envs, 300, 3), play(twin, 300, 3))
    for name in NAMES:
        assert envs.get_attr(name) == twin.get_attr(name)


def test_true_is_the_seed_1_as_in_gymnasium():
    envs = make_vec(3)
    assert (envs.reset(seed=True)[0] == envs.reset(seed=1)[0]).all()


def test_damaged_snapshots_are_rejected():
    envs = make_vec(3)
    native = envs._native
    good = native.__getstate__()
    not_finite = good.replace(np.float64(envs.state[2, 3]).tobytes(), np.float64(np.nan).tobytes())
    reasons = "snapshot is damaged|no bytes after its end, got 1|dtheta2 must be a finite number"
    for bad in [b"", good[:-1], good + b"\0", b"\xff" * len(good), not_finite]:
        with pytest.raises(ValueError, match=reasons):
            native.__setstate__(bad)
    assert native.__getstate__() == good


def test_a_snapshot_with_different_values_of_a_shared_parameter_is_rejected():
    envs = make_vec(3)
    envs.LINK_MASS_2 = 1.5
    good = envs._native.__getstate__()
    first, *rest = good.split(np.float64(1.5).tobytes())
    bad = first + np.float64(1.5).tobytes() + np.float64(1.25).tobytes().join(rest)
    with pytest.raises(ValueError, match="a batch must have memory for the parameters of each acrobot"):
        envs._native.__setstate__(bad)
    assert envs._native.__getstate__() == good


@pytest.mark.parametrize("masses", [1.5, [1.5, 1.0, 2.0], Uniform(1.0, 2.0)])
def test_a_copy_has_the_same_snapshot(masses):
    """Also the sign of 0."""
    envs = make_vec(3)
    envs.LINK_MASS_2 = masses
    if not isinstance(masses, Uniform):
        envs.AVAIL_TORQUE = [[-2.0, 0.0, 2.0], [-1.0, -0.0, 1.0], [-1.0, 0.0, 1.0]]
    envs.reset(seed=1)
    assert copy.deepcopy(envs._native).__getstate__() == envs._native.__getstate__()


def test_parameters_are_set_on_environments_and_by_subclasses():
    class Heavy(acrobot_rs.AcrobotVectorEnv):
        LINK_MASS_2 = 2.0

    live, heavy, plain = acrobot_rs.AcrobotVectorEnv(20), Heavy(20), acrobot_rs.AcrobotVectorEnv(20)
    live.LINK_MASS_2 = 2.0
    plays = []
    for envs in (live, heavy, plain):
        envs.reset(seed=4)
        plays.append(play(envs, 30, 4))
    np.testing.assert_equal(plays[0], plays[1])
    assert (plays[0][-1][2] != plays[2][-1][2]).any()
    with pytest.raises(ValueError, match="dt must be finite and above 0 s, got 0"):
        live.dt = 0.0
    assert live.dt == 0.2


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
    "actions",
    [[0, 1, 2, 3], [0, 0, 0, -1], [0, 0, 256, 0], [2**32] * 4, [0, 1, 2], [[0, 1, 2, 0]], [0.0, 1.0, 2.0, 0.0], "0120", 1,
     np.array([0, 0, 0, 2**63], dtype=np.uint64), b"\0\1\2\0", bytearray(4), dict.fromkeys(range(4), 1), {0, 1, 2}, iter([0] * 4),
     collections.UserDict.fromkeys(range(4), 1), [True] * 4, [1j] * 4, [None] * 4, np.zeros(4, object), [[0], [1, 2]],
     np.zeros((4, 1), np.float32), None],
)  # fmt: skip
def test_invalid_actions_are_rejected(actions):
    envs = make_vec(4)
    envs.reset(seed=1)
    before = envs.state
    with pytest.raises(InvalidAction, match=r"actions must be integers of shape \(4,\), got |actions\[\d\] must be "):
        envs.step(actions)
    assert (envs.state == before).all()


@pytest.mark.parametrize("dtype", [np.uint8, np.int8, np.int32, np.uint64, ">i8"])
def test_actions_can_be_integers_of_any_type(dtype):
    envs, twin = make_vec(4), make_vec(4)
    actions = np.array([[0, 1], [1, 1], [2, 1], [0, 1]])
    for each in (envs, twin):
        each.reset(seed=1)
    one = envs.step(actions[:, 0].copy())
    other = twin.step(actions.astype(dtype)[:, 0])  # also not contiguous
    np.testing.assert_equal(one, other)


def test_actions_may_be_in_packed_bytes():
    """Numbers after a header of one byte are not aligned. Gymnasium accepts them."""
    envs, twin = make_vec(4), make_vec(4)
    for each in (envs, twin):
        each.reset(seed=1)
    actions = np.array([0, 1, 2, 0])
    packed = np.frombuffer(b"h" + actions.tobytes(), np.int64, offset=1)
    assert not packed.flags.aligned
    np.testing.assert_equal(envs.step(packed), twin.step(actions))


@pytest.mark.parametrize(
    "kwargs",
    [
        {"num_envs": 0},
        {"num_envs": -1},
        {"num_envs": 2**40},
        {"num_envs": 2, "max_episode_steps": 0},
        {"num_envs": 2, "max_episode_steps": 2**32},
        {"num_envs": 2, "autoreset_mode": "Sometimes"},
        {"num_envs": 2, "render_mode": "human"},
    ],
)
def test_invalid_arguments_are_rejected(kwargs):
    with pytest.raises(ValueError):
        acrobot_rs.AcrobotVectorEnv(**kwargs)


def test_more_than_memory_is_rejected():
    """In a process that may use 8 GiB."""
    code = """if True:
        import resource
        import acrobot_rs
        resource.setrlimit(resource.RLIMIT_AS, (2**33, 2**33))
        acrobot_rs.AcrobotVectorEnv(2**32 - 1)
    """
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "MemoryError: num_envs must be so few that they fit into memory, got 4294967295" in run.stderr


@pytest.mark.parametrize(
    "call",
    ["envs.state", "envs.elapsed_steps", "pickle.dumps(envs)", "copy.deepcopy(envs)", "envs.step(actions)",
     "envs._native.__setstate__(snapshot)"],
)  # fmt: skip
def test_a_call_that_does_not_fit_into_memory_raises(call):
    """In a process that may use 2 MB more than it has when the call begins. The call used to abort the process."""
    code = f"""if True:
        import copy, pickle, resource
        import acrobot_rs
        import numpy as np
        envs = acrobot_rs.AcrobotVectorEnv(500_000)
        observations = envs.reset()  # kept, because the call could use memory that was freed
        actions, snapshot = np.zeros(envs.num_envs, np.int64), envs._native.__getstate__()
        pages = int(open("/proc/self/statm").read().split()[0])
        resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + 2**21,) * 2)
        try:
            {call}
        except MemoryError:
            print("a MemoryError")
    """
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (0, "a MemoryError\n"), run.stderr


def test_the_limit_of_steps_is_read_only():
    """An assignment would have no effect."""
    envs = make_vec(2, max_episode_steps=3)
    with pytest.raises(AttributeError):
        envs.max_episode_steps = 5
    assert envs.max_episode_steps == 3
    envs.reset()
    assert [envs.step([1, 1])[3].all() for _ in range(3)] == [False, False, True]


def test_a_rejected_seed_changes_nothing():
    envs = make_vec(2)
    envs.reset(seed=1)
    before = envs._native.__getstate__(), envs.np_random_seed, envs.np_random.bit_generator.state
    for seed in [10**5000, -1, 1.0, "1", np.int64(1)]:
        with pytest.raises((ValueError, gymnasium.error.Error)):
            envs.reset(seed=seed)
        assert (envs._native.__getstate__(), envs.np_random_seed, envs.np_random.bit_generator.state) == before


@pytest.mark.parametrize("options", [{"low": 1, "high": 0}, {"high": np.inf}, {"low": 1, "reset_mask": [True, False]}])
def test_invalid_bounds_are_rejected(options):
    envs = make_vec(2)
    before = envs._native.__getstate__()
    with pytest.raises(ValueError):
        envs.reset(seed=1, options=options)
    assert envs._native.__getstate__() == before


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


@MODES
def test_a_mask_selects_the_environments_to_seed_and_reset(mode):
    envs = make_vec(40, autoreset_mode=mode)
    envs.reset(seed=1)
    play(envs, 20, 1)
    before = envs.state
    mask = np.arange(80) % 3 == 0
    observations, infos = envs.reset(seed=5, options={"reset_mask": mask[::2], "low": -0.5})
    children = np.random.SeedSequence(5).spawn(40)
    seeded = np.float32([np.random.default_rng(child).uniform(-0.5, 0.1, 4) for child in children])
    assert infos == {}
    assert (envs.state == np.where(mask[::2, None], seeded, before)).all()
    assert (observations[:, 4:] == envs.state[:, 2:]).all()


def test_other_bytes_than_0_and_1_in_a_mask_become_1():
    """A NumPy bool can be any byte. In Rust a bool that is not 0 or 1 is undefined behaviour."""
    mask = make_vec(4)._mask({"reset_mask": np.array([2, 0, 255, 0], np.uint8).view(np.bool_)})
    assert mask.tobytes() == b"\1\0\1\0"


def test_frames_are_those_of_single_environments():
    envs = make_vec(2, render_mode="rgb_array")
    envs.reset(seed=1, options={"low": -2.0, "high": 2.0})
    single = acrobot_rs.AcrobotEnv("rgb_array")
    for frame, state in zip(envs.render(), envs.state, strict=True):
        single.state = state
        assert (frame == single.render()).all()
    with pytest.warns(UserWarning, match="without a render mode"):
        assert make_vec(2).render() is None


def test_other_threads_run_while_it_steps():
    envs = make_vec(200_000, copy=False)
    envs.reset(seed=1)
    actions = np.ones(envs.num_envs, np.int64)
    done, loops = threading.Event(), 0

    def loop():
        nonlocal loops
        while not done.is_set():
            loops += 1
            time.sleep(0)

    interval = sys.getswitchinterval()
    sys.setswitchinterval(60)  # threads switch only where Python's lock is released
    thread = threading.Thread(target=loop)
    thread.start()
    try:
        for _ in range(200):  # the other thread may wait for a core
            before = loops
            envs._native.step(envs, actions, envs._observations)
            if loops > before:
                break
        assert loops > before
    finally:
        done.set()
        thread.join()
        sys.setswitchinterval(interval)


# SyncVectorEnv, row by row.


def test_the_attributes_of_sync_vector_env():
    theirs, ours = pair(3)
    names = ("num_envs", "observation_space", "action_space", "single_observation_space", "single_action_space")
    for name in (*names, "autoreset_mode", "render_mode", "copy", "closed"):
        assert getattr(ours, name) == getattr(theirs, name)
    assert repr(ours) == "AcrobotVectorEnv(acrobot_rs/Acrobot-v1, num_envs=3)"
    assert ours.unwrapped is ours


@pytest.mark.parametrize("noise", [0.0, 0.5])
@MODES
def test_gymnasium_s_episodes_bit_identically(mode, noise):
    """Resets with seeds, bounds and masks, a change of parameters, and thousands of steps of each environment."""
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


def test_a_list_of_seeds_seeds_each_environment_as_a_single_one():
    theirs, envs = pair(4)
    with pytest.raises((ValueError, AssertionError), match="4"):  # the latter with Gymnasium 1.1
        theirs.reset(seed=[1, 2, 3])
    with pytest.raises(ValueError, match="seed must have one element for each of 4 environments, got 3"):
        envs.reset(seed=[1, 2, 3])
    envs = make_vec(4)
    envs.reset(seed=9)
    before = envs._native.__getstate__()
    for seeds in [[1, 2, 3], (1,) * 5, *([1, 2, 3, bad] for bad in (-1, "4", 4.0, np.int64(4), 10**5000))]:
        with pytest.raises((ValueError, gymnasium.error.Error)):
            envs.reset(seed=seeds)
        assert envs._native.__getstate__() == before
    twin = copy.deepcopy(envs)
    observations, _ = envs.reset(seed=[3, None, 3, 2**100])
    drawn = np.float32([np.random.default_rng(seed).uniform(-0.1, 0.1, 4) for seed in (3, 3, 2**100)])
    assert (envs.state[[0, 2, 3]] == drawn).all()
    twin.reset()
    assert (envs.state[1] == twin.state[1]).all(), "None continues the stream"
    assert envs.np_random_seed == 9


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
        envs.reset(options={"reset_mask": np.array([True, False, True])})
        for _ in range(5):
            envs.step(np.array([0, 1, 2]))
        twin = copy.deepcopy(envs) if envs is not theirs else envs
        for each in (envs, twin):
            with pytest.raises((AssertionError, ResetNeeded)):
                each.step(np.array([0, 1, 2]))
        envs.reset(options={"reset_mask": np.array([True, True, False])})
        with pytest.raises((AssertionError, ResetNeeded)):
            envs.step(np.array([0, 1, 2]))
        envs.reset(options={"reset_mask": np.array([False, False, True])})
        assert not envs.step(np.array([0, 1, 2]))[3].any()
    before = ours._native.__getstate__()
    for _ in range(4):
        ours.step([0, 1, 2])
    before = ours._native.__getstate__()
    with pytest.raises(ResetNeeded, match="the episode of environment 0 has ended; reset it before the next step"):
        ours.step([0, 1, 2])
    assert ours._native.__getstate__() == before
    ours.reset()
    ours.step([0, 1, 2])


def test_call_and_get_attr():
    theirs, ours = pair(3, render_mode="rgb_array")
    for envs in (theirs, ours):
        envs.reset(seed=1)
        envs.step(np.array([0, 1, 2]))
    for name in ("action_space", "observation_space", "render_mode", "state"):
        for get in ("get_attr", "call"):
            expected, found = getattr(theirs, get)(name), getattr(ours, get)(name)
            assert isinstance(found, tuple)
            np.testing.assert_equal(found, expected)
    for name in NAMES:
        np.testing.assert_equal([list(x) if name == "AVAIL_TORQUE" else x for x in ours.get_attr(name)],
                                [list(x) if name == "AVAIL_TORQUE" else x for x in theirs.get_attr(name)])  # fmt: skip
    assert ours.get_attr("elapsed_steps") == theirs.get_attr("_elapsed_steps")
    assert len(ours.call("render")) == 3 and (ours.call("render")[2] == ours.render()[2]).all()
    for envs in (theirs, ours):
        for get in (envs.call, envs.get_attr):
            with pytest.raises(AttributeError):
                get("length")
    with pytest.raises(AttributeError, match="no attribute 'length'; they have .*elapsed_steps.*LINK_LENGTH_1"):
        ours.call("length")


def test_set_attr():
    theirs, ours = pair(3)
    for envs in (theirs, ours):
        envs.reset(seed=1)
        envs.set_attr("dt", 0.1)
        envs.set_attr("LINK_MASS_1", [2.0, 2.0, 2.0])
        envs.set_attr("AVAIL_TORQUE", ([-2.0, 0.5, 2.0],) * 3)
        for values in ([1.0], (1.0,) * 4):
            with pytest.raises(ValueError, match="3"):
                envs.set_attr("LINK_MOI", values)
    states = np.random.default_rng(0).uniform(-1, 1, (3, 4))
    for values in (list(states), tuple(states), states[0]):
        for envs in (theirs, ours):
            envs.set_attr("state", values)
        assert_equal(theirs.step(np.array([0, 1, 2])), ours.step([0, 1, 2]))
    ours.set_attr("state", states)
    assert (ours.state == states).all()
    before = ours._native.__getstate__()
    for name, values, error in [
        ("dt", [0.0] * 3, ValueError),
        ("state", [1.0] * 3, ValueError),
        ("length", 1, AttributeError),
        ("elapsed_steps", 1, AttributeError),
    ]:
        with pytest.raises(error, match=name):
            ours.set_attr(name, values)
        assert ours._native.__getstate__() == before


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
def test_states_can_be_set(gymnasium_episodes):
    envs = make_vec(40, gymnasium_episodes=gymnasium_episodes, max_episode_steps=70)
    envs.reset(seed=1)
    play(envs, 100, 1)
    twin = copy.deepcopy(envs)
    envs.state = envs.state
    np.testing.assert_equal(play(envs, 100, 2), play(twin, 100, 2))
    elapsed = envs.elapsed_steps
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
    envs.close()
    envs.close()
    assert envs.closed
    calls = (lambda: envs.step([0, 1]), lambda: envs.call("dt"), lambda: envs.set_attr("dt", 0.1))
    for call in (envs.reset, envs.render, *calls):
        with pytest.raises(ClosedEnvironmentError, match="closed"):
            call()


def test_an_unknown_autoreset_mode_lists_the_known_ones():
    for mode in ("nextstep", None, 1, []):
        with pytest.raises(ValueError, match=r"autoreset_mode must be one of \['NextStep', 'SameStep', 'Disabled'\], got"):
            acrobot_rs.AcrobotVectorEnv(2, autoreset_mode=mode)


@MODES
def test_gymnasium_s_wrappers_see_the_same(mode):
    theirs, ours = (RecordEpisodeStatistics(envs) for envs in pair(3, mode, max_episode_steps=7))
    assert_equal(theirs.reset(seed=1), ours.reset(seed=1))
    ends = 0
    for actions in np.random.default_rng(0).integers(3, size=(40, 3)):
        expected, found = theirs.step(actions), ours.step(actions)
        if "episode" in expected[-1]:
            for infos in (expected[-1], found[-1]):
                infos["episode"].pop("t")  # the time
            np.testing.assert_equal(found[-1].pop("episode"), expected[-1].pop("episode"))
            ends += 1
        assert_equal(expected, found)
        if (ended := expected[3]).any() and mode is AutoresetMode.DISABLED:
            expected = theirs.reset(options={"reset_mask": ended.copy()})
            assert_equal(expected, ours.reset(options={"reset_mask": ended.copy()}))
    assert ends >= 5


# What SyncVectorEnv does not have.


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
    np.testing.assert_equal(plays[0], plays[1])
    np.testing.assert_equal(plays[0], plays[2])
    with pytest.raises(ValueError, match="threads must be an integer from 1"):
        kind(2, threads=0)


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


def test_a_thread_steps_while_the_program_does_something_else():
    """As AsyncVectorEnv's step_async and step_wait."""
    envs, twin = make_vec(8), make_vec(8)
    envs.reset(seed=1), twin.reset(seed=1)
    actions = np.arange(8) % 3
    with ThreadPoolExecutor(1) as executor:
        step = executor.submit(envs.step, actions)
        assert_equal(step.result(), twin.step(actions))


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


@pytest.mark.parametrize("value", [0.05, Uniform(0.05, 0.1)], ids=["value", "drawn"])
def test_a_class_changes_all_its_environments_or_none(value):
    class Some(acrobot_rs.AcrobotVectorEnv):
        dt = 0.3

    few, many, more = Some(2), Some(MANY, gymnasium_episodes=True), Some(2)
    before = few._native.__getstate__(), more._native.__getstate__()
    with stepping(many):
        for change in (lambda: setattr(Some, "dt", value), lambda: delattr(Some, "dt")):
            with pytest.raises(RuntimeError, match=BUSY):
                change()
            assert Some.dt == few.dt == 0.3 and before == (few._native.__getstate__(), more._native.__getstate__())
    assert set(many._native.get("dt")) == {0.3}
    few.LINK_MASS_1 = [1.0, 2.0]
    if isinstance(value, Uniform):
        before = many._native.__getstate__(), more._native.__getstate__()
        with pytest.raises(ValueError, match="LINK_MASS_1 must be one value for all environments, if dt has a Uniform"):
            Some.dt = value
        assert Some.dt == 0.3 and before == (many._native.__getstate__(), more._native.__getstate__())
        few.LINK_MASS_1 = 1.0
    Some.dt = value
    for envs in (few, many, more):
        envs.reset(seed=1)
        drawn = envs._native.get("dt")
        assert envs.dt == value and 0.049 < min(drawn) <= max(drawn) < 0.101
        assert (min(drawn) < max(drawn)) == isinstance(value, Uniform)
    del Some.dt
    assert few.get_attr("dt") == more.get_attr("dt") == (0.2, 0.2) and set(many.get_attr("dt")) == {0.2}


def test_a_class_changes_while_other_environments_step():
    """Those of another class, and those whose own value or subclass hides the change."""

    class Hiding(acrobot_rs.AcrobotVectorEnv):
        dt = 0.3

    own = acrobot_rs.AcrobotVectorEnv(MANY, gymnasium_episodes=True)
    own.dt = 0.3
    single = acrobot_rs.AcrobotEnv()
    for envs in (Hiding(MANY, gymnasium_episodes=True), own):
        with (
            stepping(envs),
            unittest.mock.patch.object(acrobot_rs.AcrobotEnv, "dt", 0.1),
            unittest.mock.patch.object(acrobot_rs.AcrobotVectorEnv, "dt", 0.1),
        ):
            assert single.dt == 0.1 and envs.dt == 0.3


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


def test_environments_made_or_copied_while_their_class_changes_have_its_values():
    class Some(acrobot_rs.AcrobotVectorEnv):
        pass

    def make(first):
        made = []
        for _ in range(50):
            made += [Some(1), copy.copy(first)]
            made[-1].LINK_MASS_1 = 2.0
            del made[-1].LINK_MASS_1
        return made

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for last in range(20):
            with ThreadPoolExecutor(2) as executor:
                makers = [executor.submit(make, Some(2)) for _ in range(2)]
                for change in range(30):
                    Some.dt = Some.LINK_MASS_1 = 0.1 + 0.01 * change + 0.001 * last
            for envs in (envs for maker in makers for envs in maker.result()):
                assert (envs._native.get("dt")[0], envs._native.get("LINK_MASS_1")[0]) == (np.float32(Some.dt),) * 2
    finally:
        sys.setswitchinterval(interval)


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="needs fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.filterwarnings("ignore:os.fork:RuntimeWarning")
def test_a_forked_process_can_make_environments():
    """Also if a thread, which the child does not have, was changing a parameter."""
    envs, done = make_vec(1000), threading.Event()
    envs.dt = np.linspace(0.1, 0.2, 1000)

    def change():
        while not done.is_set():
            envs.LINK_MASS_1 = 1.5

    with ThreadPoolExecutor(1) as executor:
        executor.submit(change)
        try:
            for _ in range(10):
                child = multiprocessing.get_context("fork").Process(target=acrobot_rs.AcrobotEnv)
                child.start()
                child.join(30)
                child.kill()
                assert child.exitcode == 0, "the child hangs"
        finally:
            done.set()


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
def test_copy_copy_shares_nothing(gymnasium_episodes):
    for copies in (True, False):
        envs = make_vec(5, copy=copies, gymnasium_episodes=gymnasium_episodes, autoreset_mode="Disabled")
        observations, _ = envs.reset(seed=1)
        twin = copy.copy(envs)
        before, seen = envs.state, observations.copy()
        twin.dt = 0.1
        assert (twin.reset(seed=2)[0] != observations).any() and (twin.step([0, 1, 2, 0, 1])[0] != seen).any()
        assert envs.dt == 0.2 and (envs.state == before).all() and (observations == seen).all()


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
def test_continuous_torques(gymnasium_episodes):
    """Torques of -1, 0 and 1 N m are the actions 0, 1 and 2. Torques beyond the bounds act as the bounds."""
    kwargs = {"gymnasium_episodes": gymnasium_episodes, "autoreset_mode": "SameStep", "max_episode_steps": 60}
    discrete, torques = make_vec(30, **kwargs), AcrobotContinuousVectorEnv(30, **kwargs)
    assert torques.single_action_space == gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)
    assert torques.action_space == gymnasium.spaces.Box(-1.0, 1.0, (30, 1), np.float32)
    assert_equal(discrete.reset(seed=1), torques.reset(seed=1))
    for actions in np.random.default_rng(0).integers(3, size=(200, 30)):
        expected = discrete.step(actions)
        assert_equal(expected, torques.step(np.float32(actions[:, None] - 1)))
    discrete.step(np.array([0, 2] * 15))
    torques.step([[-3.0], [np.inf]] * 15)
    assert (discrete.state == torques.state).all()
    discrete.step([0] * 30)
    torques.step(np.full((30, 1), 0.5))
    assert (discrete.state != torques.state).any()


@MODES
def test_continuous_torques_give_the_episodes_of_single_environments(mode):
    theirs = gymnasium.make_vec(
        CONTINUOUS, num_envs=6, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode}, max_episode_steps=60
    )
    ours = gymnasium.make_vec(CONTINUOUS, num_envs=6, autoreset_mode=mode, gymnasium_episodes=True, max_episode_steps=60)
    assert isinstance(ours, AcrobotContinuousVectorEnv) and ours.action_space == theirs.action_space
    assert_equal(theirs.reset(seed=1), ours.reset(seed=1))
    for actions in np.random.default_rng(0).uniform(-1.5, 1.5, (300, 6, 1)).astype(np.float32):
        expected = theirs.step(actions)
        assert_equal(expected, ours.step(actions))
        for envs in (theirs, ours):
            reset_ended(envs, expected[2] | expected[3])


@pytest.mark.parametrize(
    "actions",
    [[[0.5]], [0.5, 0.5], [[0.5, 0.5]], [[np.nan], [0.0]], [["0"], ["1"]], [[True], [False]], None, [[1], [2, 3]], {0: [1], 1: [1]},
     [[1j], [1j]], np.zeros(2, np.int64), np.zeros(2, np.float32), b"ab", bytearray(2), np.zeros((2, 1), object)],
)  # fmt: skip
def test_invalid_torques_are_rejected(actions):
    envs = AcrobotContinuousVectorEnv(2)
    envs.reset(seed=1)
    before = envs._native.__getstate__()
    with pytest.raises(InvalidAction, match=r"actions(\[0\])? must be (numbers of shape \(2, 1\)|a number, N m), got"):
        envs.step(actions)
    assert envs._native.__getstate__() == before


def test_the_bounds_of_torques_are_those_of_avail_torque():
    class Strong(AcrobotContinuousVectorEnv):
        AVAIL_TORQUE = (3.0, -2.0, 0.0)

    envs, twin = Strong(2), Strong(2)
    assert envs.single_action_space == gymnasium.spaces.Box(-2.0, 3.0, (1,), np.float32)
    for each, actions in [(envs, [[-9.0], [9.0]]), (twin, [[-2.0], [3.0]])]:
        each.reset(seed=1)
        each.step(actions)
    assert (envs.state == twin.state).all()


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


@MODES
def test_parameters_of_each_environment(mode):
    """All of them, set before and during episodes. Gymnasium's environments have the same."""
    theirs, ours = pair(19, mode, max_episode_steps=60)
    for envs in (theirs, ours):
        envs.reset(seed=1)
    rng = np.random.default_rng(0)
    for seed in range(4):
        for name, values in different(19, seed).items():
            theirs.set_attr(name, list(values))
            ours.set_attr(name, values) if seed % 2 else setattr(ours, name, values)
            np.testing.assert_array_equal(getattr(ours, name), values)
            np.testing.assert_array_equal(ours.get_attr(name), theirs.get_attr(name))
        for actions in rng.integers(3, size=(70, 19)):
            expected = theirs.step(actions)
            assert_equal(expected, ours.step(actions))
            np.testing.assert_array_equal(ours.state, np.array(theirs.get_attr("state")))
            for envs in (theirs, ours):
                reset_ended(envs, expected[2] | expected[3])
    ours.dt = 0.1
    assert ours.dt == 0.1 and ours.get_attr("dt") == (0.1,) * 19 and not ours.LINK_MASS_1.flags.writeable


@pytest.mark.parametrize("kind", [acrobot_rs.AcrobotVectorEnv, AcrobotContinuousVectorEnv])
def test_float32_episodes_with_parameters_of_each_are_those_of_environments_that_share_them(kind):
    values = different(5, 0)
    envs = kind(5)
    envs.reset(seed=1)
    for name in NAMES:
        setattr(envs, name, values[name])
    played = play_any(envs)
    for i in range(5):
        alike = kind(5)
        alike.reset(seed=1)
        for name in NAMES:
            setattr(alike, name, values[name][i])
        assert (played[:, i] == play_any(alike)[:, i]).all()


def play_any(envs):
    """Plays actions or torques, and returns the observations."""
    envs.action_space.seed(1)
    return np.array([envs.step(envs.action_space.sample())[0] for _ in range(700)])


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
    Random.MAX_VEL_1 = 25.0
    assert envs.get_attr("MAX_VEL_1") == (25.0,) * 50
    with pytest.raises(ValueError, match="the lower MAX_VEL_1 must not be above"):
        Random.MAX_VEL_1 = Uniform(3.0, 2.0)
    with pytest.raises(TypeError, match="LINK_MASS_1 must be a number, got Uniform"):
        acrobot_rs.AcrobotEnv().LINK_MASS_1 = Uniform(1.0, 2.0)


def test_pictures_have_the_lengths_of_their_environment():
    envs = make_vec(2, render_mode="ansi")
    envs.LINK_LENGTH_1 = [1.0, 0.3]
    envs.reset(seed=1)
    envs.state = np.zeros((2, 4))
    for length, picture in zip((1.0, 0.3), envs.render(), strict=True):
        single = acrobot_rs.AcrobotEnv("ansi")
        single.LINK_LENGTH_1 = length
        single.state = np.zeros(4)
        assert single.render() == picture
