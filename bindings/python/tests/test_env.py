"""The single environment passes Gymnasium's checks, and its spaces follow its parameters."""

import gymnasium
import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousEnv, AcrobotEnv
from gymnasium.utils.env_checker import check_env
from vectors import V1


@pytest.mark.parametrize(
    ("task", "threshold", "limit"),
    [
        *(("Acrobot-v1", -100, 500), ("AcrobotContinuous-v0", -100, 500)),
        *(("AcrobotBalance-v0", None, 500), ("AcrobotSwingup-v0", None, 1000)),
        ("AcrobotSwingupSparse-v0", None, 1000),
    ],
)
@pytest.mark.filterwarnings("ignore:.*infinity", "ignore:.*normalized space")  # N m, as Pendulum
def test_gymnasium_checks_pass_without_a_warning(task, threshold, limit):
    spec = gymnasium.spec(f"acrobot_rs/{task}")
    check_env(spec.make(render_mode="rgb_array").unwrapped)
    assert (spec.reward_threshold, spec.max_episode_steps) == (threshold, limit)
    assert gymnasium.make_vec(spec).get_attr("max_episode_steps") == (limit,)


def test_the_observation_space_contains_initial_states_above_the_bounds_of_velocity():
    check_env(AcrobotEnv(MAX_VEL_1=1e-30, MAX_VEL_2=0.05), skip_render_check=True)
    env = AcrobotEnv(MAX_VEL_1=np.inf, MAX_VEL_2=1e300)  # beyond float32
    assert (env.observation_space.high[4:] == np.inf).all()


def test_registration_and_spaces_are_those_of_gymnasium():
    ours, theirs = gymnasium.make(V1), gymnasium.make("Acrobot-v1")
    for name in ("observation_space", "action_space"):
        assert getattr(ours, name) == getattr(theirs, name)
    assert ours.metadata["render_fps"] == theirs.metadata["render_fps"]
    assert AcrobotEnv(dt=0.04).metadata["render_fps"] == 25, "real time"


def test_pictures():
    pictures, texts = AcrobotEnv(render_mode="rgb_array"), AcrobotEnv(render_mode="ansi")
    for env in pictures, texts:
        env.reset(seed=42)
    hanging = pictures.render()
    assert hanging.shape == (500, 500, 3) and hanging.dtype == np.uint8
    # Gymnasium's colour of a link: the first link hangs below the joint.
    assert list(hanging[300, 250]) == [0, 204, 204]
    assert len(texts.render().splitlines()) == 21
    with pytest.warns(UserWarning, match="without a render mode"):
        assert AcrobotEnv().render() is None
    with pytest.warns(UserWarning, match="HumanRendering wrapper is being applied"):
        assert gymnasium.make(V1, render_mode="human").unwrapped.render_mode == "rgb_array"


def test_spaces_follow_the_parameters():
    env, samples = AcrobotContinuousEnv(), []
    for _ in range(2):
        env.AVAIL_TORQUE = [-1.0, 0.0, 1.0]
        before = env.action_space
        before.seed(1)
        env.AVAIL_TORQUE, env.LINK_MASS_1 = [1.0, 0.0, -1.0], 2.0
        assert env.action_space is before, "and its generator"
        env.AVAIL_TORQUE = [-3.0, 2.0]
        assert env.action_space == gymnasium.spaces.Box(-3.0, 2.0, (1,), np.float32)
        samples.append(env.action_space.sample())
    assert samples[0] == samples[1], "a seeded space is followed by a seeded one"
    env.AVAIL_TORQUE = [-1e300, 0.0, 3.402823466385289e38]  # beyond float32, also by rounding
    assert -env.action_space.low == env.action_space.high == np.finfo(np.float32).max


def test_a_new_environment_copies_its_class_s_parameters():
    class Heavy(AcrobotEnv):
        LINK_MASS_1 = 3.0

    heavy = Heavy()
    Heavy.LINK_MASS_1 = 2.0
    for env, mass in {heavy: 3.0, Heavy(): 2.0, Heavy(LINK_MASS_1=6.0): 6.0}.items():
        assert env.parameters == AcrobotEnv(LINK_MASS_1=mass).parameters
    Heavy.LINK_MASS_1 = 0.0
    with pytest.raises(ValueError, match="LINK_MASS_1 must be "):
        Heavy()


def test_values_cannot_change_in_place():
    """A change would have no effect."""
    env, mass, torques = AcrobotEnv(), np.array(2.0), [-2.0, 0.0, 2.0]
    env.LINK_MASS_1 = mass
    env.AVAIL_TORQUE = torques
    mass[...], torques[0] = 3.0, 0.0
    assert env.LINK_MASS_1 == 2.0 and env.AVAIL_TORQUE == (-2.0, 0.0, 2.0)
