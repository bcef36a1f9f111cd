"""The vector environment is used as SyncVectorEnv is, and has parameters of each environment."""

import functools
import multiprocessing
import pickle
from concurrent.futures import ThreadPoolExecutor

import gymnasium
import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousEnv, AcrobotContinuousVectorEnv, AcrobotEnv
from acrobot_rs import AcrobotVectorEnv, LogUniform, Uniform
from gymnasium.vector import AutoresetMode
from vectors import assert_equal, assert_resets_equal, different, make_vec, pair


def test_attributes_and_types_are_those_of_sync_vector_env():
    theirs, ours = pair(5)
    names = "num_envs", "autoreset_mode", "render_mode", "copy", "closed"
    spaces = [f"{kind}_space" for kind in ("observation", "action")]
    for name in (*names, *spaces, *(f"single_{space}" for space in spaces)):
        assert getattr(ours, name) == getattr(theirs, name)
    assert repr(ours) == "AcrobotVectorEnv(acrobot_rs/Acrobot-v1, num_envs=5)"
    assert ours.unwrapped is ours and ours.spec.max_episode_steps == 500
    for mode in AutoresetMode:
        assert make_vec(5, autoreset_mode=mode).metadata["autoreset_mode"] is mode
    assert AcrobotVectorEnv.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    assert ours.reset()[0] is not ours.reset()[0], "a copy"


@pytest.mark.parametrize("numbers", [np.float32, np.float64])
def test_states_are_read_only_copies(numbers):
    envs = make_vec(3, gymnasium_episodes=numbers is np.float64)
    assert (envs.reset()[0] != envs.reset()[0]).any(), "random without a seed"
    for env in envs, AcrobotEnv():
        assert (env.reset(seed=np.uint8(255))[0] == env.reset(seed=255)[0]).all()
        assert env.np_random_seed == 255
        env.state = numbers([0, 1, 2, 3, 4, 5, np.finfo(numbers).max, 7])[::2]
        for array in env.state, getattr(env, "elapsed_steps", env.state):
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 1
        assert (env.state == [0, 2, 4, np.finfo(numbers).max]).all()
        assert env.state.dtype == (numbers if env is envs else np.float64)


@pytest.mark.parametrize(
    "convert",
    [
        *(np.uint8, np.int32, np.ndarray.tolist),
        *(lambda actions: actions.astype(">i8"), lambda x: np.stack([x, x], -1)[..., 0]),
        # Numbers after a header of one byte are not aligned. Gymnasium accepts them.
        lambda x: np.frombuffer(b"h" + x.tobytes(), x.dtype, offset=1).reshape(x.shape),
    ],
)
@pytest.mark.parametrize(
    ("kind", "actions"),
    [
        *((AcrobotEnv, np.array(2)), (AcrobotContinuousEnv, np.float32([1]))),
        (functools.partial(AcrobotVectorEnv, 4), np.array([0, 1, 2, 0])),
        (functools.partial(AcrobotContinuousVectorEnv, 4), np.float32([[0], [1], [2], [0]])),
    ],
)
def test_actions_can_be_numbers_of_any_type(kind, actions, convert):
    envs, twin = kind(), kind()
    for each in (envs, twin):
        each.reset(seed=1)
    np.testing.assert_equal(envs.step(convert(actions)), twin.step(actions))


def test_pictures_are_those_of_single_environments():
    envs = make_vec(2, render_mode="rgb_array")
    envs.LINK_LENGTH_1 = [1.0, 0.3]
    envs.reset(seed=1, options={"low": -2.0, "high": 2.0})
    for frame, state, length in zip(envs.render(), envs.state, (1.0, 0.3), strict=True):
        single = AcrobotEnv("rgb_array")
        single.LINK_LENGTH_1, single.state = length, state
        assert (frame == single.render()).all()


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
            for actions in np.random.default_rng(0).integers(3, size=(70, 30)):
                chosen = kind[np.arange(30), actions][:, None]
                assert_equal(discrete.step(actions), torques.step(chosen))


@pytest.mark.parametrize(
    ("kind", "count", "is_gymnasiums"),
    [(AcrobotVectorEnv, 40_003, False), (AcrobotContinuousVectorEnv, 3_003, True)],
)
def test_threads_change_no_bit(kind, count, is_gymnasiums):
    plays, arguments = [], {"autoreset_mode": "SameStep", "gymnasium_episodes": is_gymnasiums}
    for threads in (1, 3, None):
        envs = kind(count, 2, threads=threads, torque_noise_max=0.5, **arguments)
        envs.reset(seed=1)
        envs.action_space.seed(1)
        plays.append([[*envs.step(envs.action_space.sample())[:4], envs.state] for _ in range(3)])
    np.testing.assert_equal(plays, [plays[0]] * 3)


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


@pytest.mark.parametrize("kind", [AcrobotEnv, AcrobotVectorEnv])
def test_a_call_of_another_thread_during_a_call_is_rejected(kind):
    """A step of many lets other threads run, and so does this conversion of a number."""
    env, errors = kind(), []
    env.reset(seed=1)
    calls = [lambda: env.step([0]), lambda: env.state, env.reset, lambda: pickle.dumps(env)]
    calls.append(lambda: setattr(env, "dt", 0.1))

    class Mass:
        def __float__(self):
            with ThreadPoolExecutor(1) as executor:
                errors.extend(executor.submit(call).exception() for call in calls)
            return 2.0

    env._native.set("LINK_MASS_1", Mass() if kind is AcrobotEnv else [Mass()])
    assert [type(each) for each in errors] == [RuntimeError] * 5
    assert all(str(each).startswith("another thread is using this") for each in errors)
    assert env.dt == 0.2


@pytest.mark.parametrize("name", sorted({*AcrobotVectorEnv._NAMES} - {"LINK_MOI", "book_or_nips"}))
def test_resets_draw_a_parameter_and_keep_others(name):
    """`test_recorded.py` has the order and the numbers of draws."""
    own = {each: np.linspace(0.5, 1.5, 20) for each in ("LINK_MASS_2", "dt")}
    envs, mask = make_vec(20, **own), np.arange(20) % 2 == 0
    draw = Uniform([0.1] * 3, [0.9, 0.9, 0.1]) if name == "AVAIL_TORQUE" else Uniform(0.1, 0.9)
    setattr(envs, name, draw)
    before = {each: envs.get_parameter(each) for each in envs._NAMES}
    assert getattr(envs, name) == draw
    envs.reset(options={"reset_mask": mask})
    after = {each: envs.get_parameter(each) for each in envs._NAMES}
    new, old = after.pop(name), before.pop(name)
    assert (0.0999 < new[mask]).all() and (new[mask] < 0.9001).all()
    assert (new != old).reshape(20, -1).any(axis=1).tolist() == mask.tolist()
    np.testing.assert_equal(after, before)
    setattr(envs, name, [1.0] * 3 if name == "AVAIL_TORQUE" else 1.0)
    envs.reset()
    assert (envs.get_parameter(name) == 1.0).all()


def test_links_can_have_their_own_inertias():
    envs = make_vec(3, LINK_MOI_1=0.5, LINK_MOI_2=LogUniform(1.0, 2.0))
    envs.reset(seed=1)
    assert (envs.get_parameter("LINK_MOI_1") == 0.5).all()
    assert (envs.get_parameter("LINK_MOI_2") > 1.0).all()
    envs.LINK_MOI = 3.0
    assert envs.LINK_MOI_1 is None and (envs.get_parameter("LINK_MOI_1") == 3.0).all()


def test_subclasses_can_draw_parameters_which_spaces_follow():
    class Random(AcrobotContinuousVectorEnv):
        MAX_VEL_1 = Uniform(20.0, 30.0)
        AVAIL_TORQUE = Uniform([-3.0, 0.0, 1.0], [-2.0, 0.0, 2.0])

    envs = Random(50)
    assert envs.single_observation_space.high[4] == 30
    assert envs.single_action_space == gymnasium.spaces.Box(-3.0, 2.0, (1,), np.float32)
    envs.reset(seed=1)
    assert len(set(envs.get_attr("MAX_VEL_1"))) == 50
    envs.AVAIL_TORQUE = [[-1, 0, 1], [-5, 0, 1], [-1, 0, 4]] + [[0, 0, 0]] * 47
    assert envs.action_space == gymnasium.spaces.Box(-5.0, 4.0, (50, 1), np.float32)
