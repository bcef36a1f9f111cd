"""Other people's programs find in our environments what they read of Gymnasium's.

`tests/clients/python` runs such programs.
"""

import copy

import gymnasium
import numpy as np
import pytest
from acrobot_rs import LogUniform, Normal, Uniform
from gymnasium.envs.registration import EnvSpec
from gymnasium.error import ResetNeeded
from gymnasium.vector import VectorEnv
from gymnasium.wrappers.vector import RecordEpisodeStatistics
from vectors import rejects

SINGLES = [name for name in gymnasium.registry if name.startswith("acrobot_rs/")]
VECTORS = [name for name in SINGLES if gymnasium.spec(name).vector_entry_point]
pytestmark = pytest.mark.filterwarnings("ignore:.*(out of date|infinity)")
vectors = pytest.mark.parametrize("name", VECTORS)


def make(name, **kwargs):
    return gymnasium.make_vec(name, num_envs=3, vectorization_mode="vector_entry_point", **kwargs)


@vectors
def test_gymnasium_s_class_is_a_direct_base(name):
    """skrl looks at nothing else."""
    assert len(SINGLES) == 5 and len(VECTORS) == 4
    assert VectorEnv in type(make(name)).__bases__


@vectors
@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_recorded_episodes_have_their_lengths_and_returns(name, mode):
    """Also if they begin at different times, with masks."""
    if mode == "SameStep" and gymnasium.__version__.startswith("1.1."):
        pytest.skip("its wrapper does not count the first step after a reset in a step")
    envs = RecordEpisodeStatistics(make(name, autoreset_mode=mode, max_episode_steps=10))
    envs.reset(seed=1)
    lengths, returns, total = [], [], np.zeros(3)
    for step in range(60):
        elapsed = envs.unwrapped.elapsed_steps
        _, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
        total = np.where(elapsed == 0, 0.0, total) + rewards
        ended = terminated | truncated
        for index in np.flatnonzero(ended):
            lengths.append((infos["episode"]["l"][index], elapsed[index] + 1))
            returns.append((infos["episode"]["r"][index], total[index]))
        mask = (ended & (mode == "Disabled")) | (np.arange(3) == {4: 1, 8: 2}.get(step))
        if mask.any():
            envs.reset(options={"reset_mask": mask.copy()})
    assert len(lengths) > 12 and len({*elapsed.tolist()}) == 3
    np.testing.assert_array_equal(*np.transpose(lengths))
    np.testing.assert_allclose(*np.transpose(returns), rtol=1e-6)


@pytest.mark.parametrize("name", SINGLES)
def test_options_of_other_programs_pass(name):
    """Minari's collector passes its own key on."""
    for env in gymnasium.make(name), *([make(name)] if name in VECTORS else []):
        expected = env.reset(seed=1)[0]
        others = {"minari_autoseed": False, "seed": 3, ("a",): None}
        np.testing.assert_array_equal(env.reset(seed=1, options=others)[0], expected)


@pytest.mark.parametrize("name", SINGLES)
def test_specs_and_parameters_make_the_same_environment_again(name):
    """Also a spec from its JSON, which data sets store."""
    env = gymnasium.make(name, LINK_MASS_1=2.0, MAX_VEL_1=9.0)
    assert env.observation_space.high[-2] == (np.inf if "Swingup" in name else 9.0)
    parameters, native = env.unwrapped.parameters, env.unwrapped._native.__getstate__()
    assert parameters.keys() == set(env.unwrapped._NAMES) and parameters["LINK_MASS_1"] == 2.0
    specs = env.spec, EnvSpec.from_json(env.spec.to_json())
    for twin in (*(spec.make() for spec in specs), type(env.unwrapped)(**parameters)):
        assert twin.unwrapped._native.__getstate__() == native
    if name in VECTORS:
        draws = {"dt": LogUniform(0.1, 0.2), "gravity": Normal(9.8, 0.1, 9.0, 10.0)}
        draws["AVAIL_TORQUE"] = Uniform([-2, 0, 1], [-1, 0, 2])
        envs = make(name, LINK_MASS_1=[1, 2, 3], max_episode_steps=7, **draws)
        for twin in (gymnasium.make_vec(envs.spec), type(envs)(3, 7, **envs.parameters)):
            assert (twin.reset(seed=1)[0] == envs.reset(seed=1)[0]).all()
            np.testing.assert_equal(twin.parameters, envs.parameters)
            assert twin.num_envs == 3 and twin.max_episode_steps == 7


@vectors
def test_attributes_of_each_environment(name):
    """Trainers and adapters read them."""
    envs = make(name, render_mode="ansi", copy=False, max_episode_steps=20)
    first, _ = envs.reset(seed=1)
    assert envs.copy is False and envs.step(envs.action_space.sample())[0] is first
    for get in (envs.call, envs.get_attr):
        assert get("max_episode_steps") == (20,) * 3 and get("elapsed_steps") == (1,) * 3
        assert np.array_equal(get("state"), envs.state) and get("render") == envs.render()
        assert get("action_space") == (envs.single_action_space,) * 3
        assert get("render_mode") == ("ansi",) * 3
        with pytest.raises(AttributeError, match="no attribute 'length'; they have .*state.*, dt"):
            get("length")
    state = [0.5, 0.25, 0.75, 1.0]
    for count, states in enumerate((state, [state] * 3, (state,) * 3, np.array(state))):
        envs.set_attr("state", states)
        assert (envs.state == state).all() and get("elapsed_steps") == (1 + count,) * 3
        envs.step(envs.action_space.sample())
    for unknown in ("length", "elapsed_steps"):
        with rejects(envs, AttributeError, unknown):
            envs.set_attr(unknown, 1.0)
    with pytest.warns(UserWarning, match="without a render mode"):
        assert make(name).render() is None


@vectors
def test_episodes_begin_in_given_states(name):
    """A planner copies a state into all, and begins again where episodes have ended."""
    envs, twin = (make(name, autoreset_mode="Disabled", max_episode_steps=2) for _ in range(2))
    states = np.random.default_rng(0).uniform(-1, 1, (3, 4)).astype(np.float32)
    observations, infos = envs.reset(seed=1, options={"state": states})
    twin.reset(seed=1)
    twin.state = states
    assert (envs.state == states).all() and infos == {} and (envs.elapsed_steps == 0).all()
    actions = envs.action_space.sample()
    for _ in range(2):
        for one, other in zip(envs.step(actions)[:4], twin.step(actions)[:4], strict=True):
            np.testing.assert_array_equal(one, other)
    with pytest.raises(ResetNeeded):
        envs.step(actions)
    before = envs.state
    options = {"state": states[1], "reset_mask": np.array([True, False, True])}
    given = copy.deepcopy(options)
    envs.reset(options=options)
    np.testing.assert_equal(options, given)
    assert (envs.state == [states[1], before[1], states[1]]).all()
    assert envs.elapsed_steps.tolist() == [0, 2, 0]
    envs.reset(options={"state": states[2]})
    assert (envs.state == states[2]).all() and (envs.elapsed_steps == 0).all()
    envs.step(actions)
    for bad in ([1.0] * 3, [[1.0] * 4] * 2, None, [0, 0, 0, 1e39]):
        message = r"state.* must be (numbers of shape \(3, 4\)|in the range of float32, .*), got"
        with rejects(envs, ValueError, message):
            envs.reset(seed=2, options={"state": bad})


@pytest.mark.parametrize("name", SINGLES)
def test_a_single_episode_begins_in_a_given_state(name):
    env, twin = (gymnasium.make(name, torque_noise_max=0.1) for _ in range(2))
    state = np.array([1.0, -2.0, 3.0, 0.1])
    observation, _ = env.reset(seed=1, options={"state": state})
    twin.reset(seed=1)
    twin.unwrapped.state = state
    assert (env.unwrapped.state == state).all() and env.unwrapped.state.dtype == np.float64
    assert observation in env.observation_space
    assert (observation[-2:] == np.float32(state[2:])).all()
    action = env.action_space.sample()
    assert (env.step(action)[0] == twin.step(action)[0]).all()
    if name == "acrobot_rs/Acrobot-v1":
        envs = gymnasium.make_vec(name, num_envs=1, gymnasium_episodes=True)
        assert (envs.reset(options={"state": state})[0] == observation).all()
    for bad in ([1.0] * 3, None, [np.nan] * 4):
        with rejects(env.unwrapped, ValueError, "^state must "):
            env.unwrapped.reset(seed=2, options={"state": bad})


def test_without_a_limit_no_episode_is_truncated():
    envs = make("acrobot_rs/Acrobot-v1", max_episode_steps=None)
    envs.reset(seed=1)
    assert envs.get_attr("max_episode_steps") == (None,) * 3
    assert not any(envs.step([1] * 3)[3].any() for _ in range(600))
    assert (envs.elapsed_steps == 600).all()
