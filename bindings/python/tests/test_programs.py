"""Other people's programs find in our environments what they read of Gymnasium's."""

import gymnasium
import numpy as np
import pytest
from acrobot_rs import LogUniform, Normal, Uniform
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import VectorEnv

TASKS = [name for name in gymnasium.registry if name.startswith("acrobot_rs/")]
pytestmark = pytest.mark.filterwarnings("ignore:.*infinity")
tasks = pytest.mark.parametrize("name", TASKS)


def make(name, **kwargs):
    return gymnasium.make_vec(name, num_envs=3, vectorization_mode="vector_entry_point", **kwargs)


@tasks
def test_gymnasium_s_class_is_a_direct_base(name):
    """skrl looks at nothing else."""
    assert len(TASKS) == 5, "edit this count if you registered an environment"
    assert VectorEnv in type(make(name)).__bases__


@tasks
def test_options_of_other_programs_pass(name):
    """Minari's collector passes its own key on."""
    for env in (gymnasium.make(name), make(name)):
        expected = env.reset(seed=1)[0]
        others = {"minari_autoseed": False, "seed": 3, ("a",): None}
        np.testing.assert_array_equal(env.reset(seed=1, options=others)[0], expected)


@tasks
def test_specs_and_parameters_make_the_same_environment_again(name):
    """Also a spec from its JSON, which data sets store."""
    env = gymnasium.make(name, LINK_MASS_1=2.0, MAX_VEL_1=9.0)
    assert env.observation_space.high[-2] == (np.inf if "Swingup" in name else 9.0)
    parameters, native = env.unwrapped.parameters, env.unwrapped._native.__getstate__()
    unset = {"LINK_MOI"} if "Swingup" in name else {"LINK_MOI_1", "LINK_MOI_2"}
    assert parameters.keys() == set(env.unwrapped._NAMES) - unset
    specs = env.spec, EnvSpec.from_json(env.spec.to_json())
    for twin in (*(spec.make() for spec in specs), type(env.unwrapped)(**parameters)):
        assert twin.unwrapped._native.__getstate__() == native
    draws = {"dt": LogUniform(0.1, 0.2), "gravity": Normal(9.8, 0.1, 9.0, 10.0)}
    draws["AVAIL_TORQUE"] = Uniform([-2, 0, 1], [-1, 0, 2])
    draws |= {"DAMPING_2": Uniform(0.0, 0.1), "LINK_MOI_2": Uniform(0.9, 1.1)}
    envs = make(name, LINK_MASS_1=[1, 2, 3], max_episode_steps=7, **draws)
    for twin in (gymnasium.make_vec(envs.spec), type(envs)(3, 7, **envs.parameters)):
        assert (twin.reset(seed=1)[0] == envs.reset(seed=1)[0]).all()
        np.testing.assert_equal(twin.parameters, envs.parameters)
        assert twin.num_envs == 3 and twin.max_episode_steps == 7


@tasks
def test_attributes_of_each_environment(name):
    """Trainers and adapters read them."""
    envs = make(name, render_mode="ansi", copy=False, max_episode_steps=20)
    first, _ = envs.reset(seed=1)
    assert envs.copy is False and envs.step(envs.action_space.sample())[0] is first
    get = envs.get_attr
    assert get("max_episode_steps") == (20,) * 3 and get("elapsed_steps") == (1,) * 3
    assert np.array_equal(get("state"), envs.state) and get("render") == envs.render()
    assert get("action_space") == (envs.single_action_space,) * 3
    with pytest.raises(AttributeError, match="no attribute 'length'; they have .*state.*, dt"):
        get("length")
    state = [0.5, 0.25, 0.75, 1.0]
    for states in state, [state] * 3, np.array(state):
        envs.set_attr("state", states)
        assert (envs.state == state).all() and get("elapsed_steps") == (1,) * 3


@tasks
def test_episodes_begin_in_given_states(name):
    """A planner copies a state into all, and begins again where episodes have ended."""
    envs, env, twin = make(name), gymnasium.make(name), gymnasium.make(name)
    states = np.random.default_rng(0).uniform(-1, 1, (3, 4)).astype(np.float32)
    envs.reset(seed=1, options={"state": states})
    assert (envs.state == states).all() and (envs.elapsed_steps == 0).all()
    envs.step(envs.action_space.sample())
    before, options = envs.state, {"state": states[1], "reset_mask": np.array([True, False, True])}
    observations, _ = envs.reset(options=options)
    assert (envs.state == [states[1], before[1], states[1]]).all()
    assert envs.elapsed_steps.tolist() == [0, 1, 0]
    observation, _ = env.reset(seed=1, options={"state": states[1]})
    assert (env.unwrapped.state == states[1]).all() and env.unwrapped.state.dtype == np.float64
    assert np.abs(observations[[0, 2]] - observation).max() < 1e-6
    twin.reset(seed=1)  # the generator draws as without a state
    assert env.unwrapped.np_random.random() == twin.unwrapped.np_random.random()


def test_without_a_limit_no_episode_is_truncated():
    envs = make("acrobot_rs/Acrobot-v1", max_episode_steps=None)
    envs.reset(seed=1)
    assert envs.get_attr("max_episode_steps") == (None,) * 3
    assert not any(envs.step([1] * 3)[3].any() for _ in range(600))
