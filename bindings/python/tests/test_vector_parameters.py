"""Parameters of each environment: values, draws, and what reads them."""

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from acrobot_rs import AcrobotContinuousVectorEnv, LogUniform, Normal, Uniform
from vectors import make_vec, rejects


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
@pytest.mark.parametrize(
    ("error", "name", "value", "message"),
    [
        (TypeError, "LINK_MASS_1", [1, 2, None], r"\[2\] must be a number, got None"),
        (ValueError, "LINK_MASS_1", [1, 2], " must be .* each of 3 environments, .*, got 2 values"),
        (ValueError, "AVAIL_TORQUE", [-1, 1], r" must be 3 numbers, such as \[-2, 0, 2\], got 2"),
        (ValueError, "AVAIL_TORQUE", [[1, 2, 3], [1, 2], [1, 2, 3]], r"\[1\] must be 3 numbers, s"),
        (ValueError, "book_or_nips", ["book", "nips", "b"], r"\[2\] must be 'book' .*, got 'b'"),
        (ValueError, "LINK_COM_POS_2", Uniform(0, 1), "LINK_MOI must be above 0 if the centre"),
        (TypeError, "AVAIL_TORQUE", Uniform(0, 1), " must be a sequence of 3 numbers, got 0"),
        (TypeError, "book_or_nips", Uniform(0, 1), " must be 'book' or 'nips', got 0"),
    ],
)
def test_a_rejected_parameter_changes_nothing(error, name, value, message, gymnasium_episodes):
    envs = make_vec(3, gymnasium_episodes=gymnasium_episodes)
    envs.LINK_MOI = 0.0
    for mass in (1.0, [1.0, 1.5, 2.0], Uniform(1.0, 2.0), LogUniform(1.0, 2.0)):
        envs.LINK_MASS_1 = mass
        envs.reset(seed=1)
        for attempt in (setattr, acrobot_rs.AcrobotVectorEnv.set_attr):
            with rejects(envs, error, message if "LINK_MOI" in message else f"^{name}{message}"):
                attempt(envs, name, value)


TORQUES = [(-1.0, 0.0, 1.0), (-1.0, 1e300, 1.0)]


@pytest.mark.parametrize(
    ("name", "value", "number"),
    [
        *(("dt", 1e300, "1e300"), ("LINK_MASS_1", [1.0, 1e-300, 1.0], "1e-300")),
        *(("LINK_MASS_1", LogUniform(1e-300, 1.0), "1e-300"), ("LINK_MOI", 1e300, "1e300")),
        ("LINK_LENGTH_2", Uniform(1.0, 3.5e38), "3.5e38"),
        ("gravity", Normal(9.0, 1e300, 8.0, 10.0), "1e300"),
        *(
            ("AVAIL_TORQUE", torques, "1e300")
            for torques in ([*TORQUES, [0] * 3], Uniform(*TORQUES))
        ),
    ],
)
def test_the_number_given_is_in_the_message(name, value, number):
    """Not the infinity or the 0 that it becomes in float32."""
    envs = make_vec(3)
    with rejects(envs, ValueError, f"^{name}.* must be .*, got {number}$"):
        setattr(envs, name, value)


#: In the order of their draws, which is not that of the assignments. `test_recorded.py` has other
#: distributions, and LINK_MOI.
DRAWS = dict.fromkeys(
    (
        *(f"LINK_{name}_{link}" for name in ("LENGTH", "MASS", "COM_POS") for link in (1, 2)),
        *("gravity", "dt", "MAX_VEL_1", "MAX_VEL_2", "AVAIL_TORQUE", "torque_noise_max"),
    ),
    Uniform(0.3, 1.7),
)
DRAWS["AVAIL_TORQUE"] = Uniform((-1.5, 0.0, 0.5), (-0.5, 0.0, 1.5))  # equal bounds draw nothing
OWN = {"LINK_MOI": 1.0 + np.arange(20), "book_or_nips": ["book", "nips"] * 10}


@pytest.mark.parametrize("gymnasium_episodes", [False, True])
@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_resets_draw_parameters(gymnasium_episodes, mode):
    """Also with a mask and within steps, as NumPy between the rounded bounds. Others stay."""
    envs = make_vec(
        20, max_episode_steps=2, gymnasium_episodes=gymnasium_episodes, autoreset_mode=mode, **OWN
    )
    envs.reset(seed=3)
    for name, draw in reversed(DRAWS.items()):
        setattr(envs, name, draw)
        assert getattr(envs, name) == draw
        assert len(set(envs.get_attr(name))) == 1, "the next reset draws"
    rounded = np.float64 if gymnasium_episodes else np.float32
    streams, mask = [np.random.default_rng(seed) for seed in range(50, 70)], np.arange(20) % 3 == 0
    expected = {name: envs.get_parameter(name) for name in (*DRAWS, *OWN)}

    def check(which):
        for i in np.flatnonzero(which):
            assert (envs.state[i] == np.float32(streams[i].uniform(-0.1, 0.1, 4))).all()
            for name, draw in DRAWS.items():
                bounds = np.transpose([np.ravel(rounded(each)) for each in (draw.low, draw.high)])
                drawn = [a if a == b else streams[i].uniform(a, b) for a, b in bounds.astype(float)]
                expected[name][i] = np.squeeze(rounded(drawn))
        for name, values in expected.items():
            assert (envs.get_parameter(name) == values).all(), name

    envs.reset(seed=[*range(50, 70)])
    check(np.ones(20, bool))
    envs.reset(options={"reset_mask": mask.copy()})
    check(mask)
    for _ in range(6):
        before = envs.elapsed_steps
        envs.step(np.ones(20, int))
        for i in np.flatnonzero(before < 2):  # a step that resets in mode NextStep has no noise
            streams[i].uniform()
        check(before == (2 if mode == "NextStep" else 1))
    envs.dt = 1.0
    envs.reset()
    assert envs.dt == 1.0 and (envs.get_parameter("dt") == 1.0).all()
    assert (envs.get_parameter("gravity") != expected["gravity"]).all()


def test_drawn_parameters_in_infos_and_arrays():
    draws = {"dt": LogUniform(0.1, 0.3), "AVAIL_TORQUE": Uniform([-2, 0, 1], [-1, 0, 2])}
    arguments = {"autoreset_mode": "SameStep", "info_parameters": iter(draws), **draws}
    envs = make_vec(3, max_episode_steps=1, **arguments)
    _, before = envs.reset(seed=1)
    after = envs.step([1] * 3)[-1]
    final = after["final_info"]
    for name, shape in [("dt", (3,)), ("AVAIL_TORQUE", (3, 3))]:
        assert (final[name] == before[name]).all() and (after[name] != before[name]).any()
        assert all(infos[f"_{name}"].all() for infos in (before, after, final))
        array = envs.get_parameter(name)
        assert array.shape == shape
        assert (after[name] == array).all() and (array == envs.get_attr(name)).all()
    with pytest.raises(AttributeError, match="no attribute 'mass_1'"):
        make_vec(2, info_parameters=["mass_1"])


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
    assert envs.single_action_space == gymnasium.spaces.Box(-5.0, 4.0, (1,), np.float32)
    assert envs.action_space == gymnasium.spaces.Box(-5.0, 4.0, (50, 1), np.float32)
