"""The vector environment has the documented streams, resets as SyncVectorEnv does, and steps as Gymnasium does within float32."""

import copy
import pickle
import subprocess
import sys
import threading
import time

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from gymnasium.error import InvalidAction
from gymnasium.vector import AutoresetMode, SyncVectorEnv

V1 = "acrobot_rs/Acrobot-v1"
MODES = pytest.mark.parametrize("mode", AutoresetMode)


def make_vec(num_envs, **kwargs):
    return gymnasium.make_vec(V1, num_envs=num_envs, vectorization_mode="vector_entry_point", **kwargs)


def play(envs, steps, seed):
    """Plays random actions and returns all results."""
    rng = np.random.default_rng(seed)
    played = []
    for _ in range(steps):
        *results, infos = envs.step(rng.integers(3, size=envs.num_envs))
        # Lists, because NumPy does not compare arrays of arrays.
        played.append([results, {key: list(value) for key, value in infos.items()}, envs.state])
    return played


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
            options = bounds | {"reset_mask": ended.copy()}
            found = ours.reset(options=options)
            expected = theirs.reset(options=options)  # last, because it removes the mask from the options
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


@pytest.mark.parametrize("again", [copy.deepcopy, lambda envs: pickle.loads(pickle.dumps(envs))])
@MODES
def test_copies_continue_bit_identically(mode, again):
    envs = make_vec(37, autoreset_mode=mode, max_episode_steps=90)
    envs.torque_noise_max = 0.3
    envs.book_or_nips = "nips"
    envs.reset(seed=1, options={"low": -1.0, "high": 0.5})
    play(envs, 90, 2)  # in mode NEXT_STEP the next step resets all
    twin = again(envs)
    np.testing.assert_equal(play(envs, 300, 3), play(twin, 300, 3))


def test_true_is_the_seed_1_as_in_gymnasium():
    envs = make_vec(3)
    assert (envs.reset(seed=True)[0] == envs.reset(seed=1)[0]).all()


def test_damaged_snapshots_are_rejected():
    envs = make_vec(3)
    native = envs._native
    good = native.__getstate__()
    not_finite = good.replace(envs.state[2, 3].tobytes(), np.float32(np.nan).tobytes())
    reasons = "snapshot is damaged|no bytes after its end, got 1|dtheta2 must be a finite number"
    for bad in [b"", good[:-1], good + b"\0", b"\xff" * len(good), not_finite]:
        with pytest.raises(ValueError, match=reasons):
            native.__setstate__(bad)
    assert native.__getstate__() == good


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
     np.array([0, 0, 0, 2**63], dtype=np.uint64)],
)  # fmt: skip
def test_invalid_actions_are_rejected(actions):
    envs = make_vec(4)
    envs.reset(seed=1)
    before = envs.state
    with pytest.raises(InvalidAction, match=r"actions(\[\d\])? must be "):
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


def test_the_limit_of_steps_is_read_only():
    """An assignment would have no effect."""
    envs = make_vec(2, max_episode_steps=3)
    with pytest.raises(AttributeError):
        envs.max_episode_steps = 5
    assert envs.max_episode_steps == 3
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


@pytest.mark.parametrize("mask", [None, True, [1, 0], [False, False], [True], [True, False, True], [[True, False]]])
def test_invalid_masks_are_rejected(mask):
    envs = make_vec(2)
    before = envs._native.__getstate__()
    with pytest.raises(ValueError, match=r"reset_mask must be an array of bool of shape \(2,\) with a true element, got"):
        envs.reset(seed=1, options={"reset_mask": mask})
    assert envs._native.__getstate__() == before


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


def test_without_autoreset_environments_continue_after_the_end():
    envs = make_vec(3, autoreset_mode="Disabled", max_episode_steps=5)
    envs.reset(seed=1)
    ends = [envs.step([0, 1, 2])[3].any() for _ in range(8)]
    assert ends == [False] * 4 + [True] * 4
    envs.reset(options={"reset_mask": [False, True, False]})
    assert list(envs.step([0, 1, 2])[3]) == [True, False, True]


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
        results = [np.empty(envs.num_envs, dtype) for dtype in (np.float32, np.bool_, np.bool_)]
        for _ in range(200):  # the other thread may wait for a core
            before = loops
            envs._native.step(actions, envs._observations, *results, None)
            if loops > before:
                break
        assert loops > before
    finally:
        done.set()
        thread.join()
        sys.setswitchinterval(interval)
