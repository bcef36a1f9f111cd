"""Parameters of each environment: values, draws, and what reads them."""

import math
import statistics

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from acrobot_rs import LogUniform, Normal, Uniform
from acrobot_rs.vector import AcrobotContinuousVectorEnv
from vectors import CONTINUOUS, MODES, assert_equal, make_vec, reset_ended


#: All parameters that can be drawn, in the order of their draws.
DRAWN = (
    *("LINK_LENGTH_1", "LINK_LENGTH_2", "LINK_MASS_1", "LINK_MASS_2", "LINK_COM_POS_1", "LINK_COM_POS_2"),
    *("gravity", "dt", "MAX_VEL_1", "MAX_VEL_2", "AVAIL_TORQUE", "torque_noise_max"),
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
    assert getattr(envs, first) == 1.0 and (envs.get_parameter(first) == 1.0).all()


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
        ("MAX_VEL_2", LogUniform(1.0, 1e300), ValueError, "MAX_VEL_2 must be "),
        ("LINK_COM_POS_2", Uniform(0.0, 1.0), ValueError, "LINK_MOI must be above 0 kg m² if the centre of mass"),
        ("AVAIL_TORQUE", Uniform(0.0, 1.0), TypeError, r"AVAIL_TORQUE must be a sequence of 3 numbers, got 0\.0"),
        ("AVAIL_TORQUE", Normal(0.0, 1.0, -1.0, 1.0), ValueError, "AVAIL_TORQUE must be a value, an array or a Uniform, got Norm"),
        ("book_or_nips", Uniform(0.0, 1.0), ValueError, "book_or_nips must be a value or an array, got Uniform"),
    ],
)  # fmt: skip
def test_a_rejected_parameter_changes_nothing(name, value, error, message, gymnasium_episodes):
    envs = make_vec(3, gymnasium_episodes=gymnasium_episodes)
    envs.LINK_MOI = 0.0
    for mass in (1.0, [1.0, 1.5, 2.0], Uniform(1.0, 2.0), LogUniform(1.0, 2.0)):
        envs.LINK_MASS_1 = mass
        envs.reset(seed=1)
        before = envs._native.__getstate__(), envs.get_attr(name)
        for attempt in (setattr, acrobot_rs.AcrobotVectorEnv.set_attr):
            with pytest.raises(error, match=f"^{message}"):
                attempt(envs, name, value)
            assert (envs._native.__getstate__(), envs.get_attr(name)) == before


def normal(rng, draw):
    """A draw from the bounds, or from 8 standard deviations, accepted by its density."""
    low, high = max(draw.low, draw.mean - 8 * draw.std), min(draw.high, draw.mean + 8 * draw.std)
    while True:
        drawn = rng.uniform(low, high)
        if rng.uniform() < math.exp(-0.5 * ((drawn - draw.mean) / draw.std) ** 2):
            return drawn


#: How to draw as Rust does.
DRAWS = {
    Uniform: lambda rng, draw: rng.uniform(draw.low, draw.high),
    LogUniform: lambda rng, draw: math.exp(rng.uniform(math.log(draw.low), math.log(draw.high))),
    Normal: normal,
}


@pytest.mark.parametrize(
    "draws",
    [
        {"LINK_MASS_2": LogUniform(0.5, 2.0)},
        {"LINK_MASS_2": Normal(1.0, 0.125, 0.5, 2.0), "gravity": Normal(9.5, 4.0, 9.0, 12.0), "dt": Uniform(0.125, 0.25)},
        {"LINK_MOI": Uniform(0.5, 2.0)},
        # Beside different values, also a Uniform.
        {"LINK_MASS_2": Uniform(0.5, 2.0), "LINK_MASS_1": 1.0 + np.arange(20), "book_or_nips": ["book", "nips"] * 10},
    ],
)
@pytest.mark.parametrize("gymnasium_episodes", [False, True])
@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_other_draws_follow_the_initial_state(draws, gymnasium_episodes, mode):
    """Of all environments, of those with a mask, and within steps. What is not drawn stays."""
    count = 20
    envs = make_vec(
        count, max_episode_steps=2, autoreset_mode=mode, gymnasium_episodes=gymnasium_episodes, **dict(reversed(draws.items()))
    )
    seeds = [*range(50, 50 + count)]
    streams = [np.random.default_rng(seed) for seed in seeds]
    mask = np.arange(count) % 3 == 0

    def check(which):
        before = {name: envs.get_parameter(name) for name in draws}
        yield
        for i in range(count):
            if which[i]:
                assert (envs.state[i] == np.float32(streams[i].uniform(-0.1, 0.1, 4))).all()
            for name, value in draws.items():
                expected = DRAWS[type(value)](streams[i], value) if which[i] and type(value) in DRAWS else before[name][i]
                found = envs.get_parameter(name)[i]
                # The platform's logarithms may round differently.
                assert found == expected or found == pytest.approx(expected, rel=2e-7 if not gymnasium_episodes else 1e-15)

    def checked(which, call):
        steps = check(which)
        next(steps)
        call()
        next(steps, None)

    checked(np.ones(count, bool), lambda: envs.reset(seed=seeds))
    checked(mask, lambda: envs.reset(options={"reset_mask": mask}))
    for step in range(6):
        last = envs.elapsed_steps
        checked(last == (2 if mode == "NextStep" else 1), lambda: envs.step(np.ones(count, int)))
    twin = make_vec(count, gymnasium_episodes=gymnasium_episodes)
    envs.reset(seed=seeds), twin.reset(seed=seeds)
    assert (envs.state == twin.state).all(), "draws do not change the initial states"
    for name, value in draws.items():
        if isinstance(value, Uniform | LogUniform | Normal):
            setattr(envs, name, value.low)
    before = envs.get_parameter("LINK_MASS_1")
    envs.reset()
    assert all((envs.get_parameter(name) == draws[name].low).all() for name in draws if type(draws[name]) in DRAWS)
    assert (envs.get_parameter("LINK_MASS_1") == before).all()


@pytest.mark.parametrize(
    ("draw", "distribution"),
    [
        (LogUniform(0.5, 8.0), lambda x: math.log(x / 0.5) / math.log(16)),
        *((draw, lambda x, draw=draw: (
            (cdf := statistics.NormalDist(draw.mean, draw.std).cdf)(x) - cdf(draw.low)) / (cdf(draw.high) - cdf(draw.low)))
          for draw in (Normal(1.0, 0.2, 0.1, 9.0), Normal(1.0, 0.2, 1.0, 1.5), Normal(1.0, 50.0, 0.5, 2.0), Normal(1.0, 0.01, 0.5, 9.0))),
    ],
)  # fmt: skip
def test_distributions(draw, distribution):
    """Kolmogorov's and Smirnov's test."""
    count = 20_000
    envs = make_vec(count, LINK_MASS_1=draw)
    envs.reset(seed=1)
    drawn = np.sort(envs.get_parameter("LINK_MASS_1"))
    assert draw.low <= drawn[0] and drawn[-1] <= draw.high
    expected = np.array([distribution(x) for x in drawn.tolist()])
    assert np.abs(expected - (np.arange(count) + 0.5) / count).max() < 1.95 / count**0.5


def test_extreme_draws_end_within_their_bounds():
    """A width that rounds to 0 in float32, and one of the largest numbers."""
    for draw in (Normal(0.1, 1e-300, 0.1, 0.1 + 1e-12), Normal(1.0, 1e300, 1e-30, 1e30), LogUniform(1e-30, 1e30), Uniform(2.0, 2.0)):
        envs = make_vec(50, LINK_MASS_1=draw, LINK_LENGTH_1=LogUniform(1.0, 2.0))
        envs.reset(seed=1)
        drawn = envs.get_parameter("LINK_MASS_1")
        assert (np.float32(draw.low) <= drawn).all() and (drawn <= np.float32(draw.high)).all()


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: Uniform(1.2, 0.8), ValueError, r"low must not be above high, got Uniform\(low=1.2, high=0.8\)"),
        (lambda: Uniform([-1, 0, 1], [-2, 0, 2]), ValueError, "low must not be above high"),
        (lambda: Uniform([-1, 0, 1], 2), ValueError, "low and high must have the same length"),
        (lambda: Uniform([-1, 1], [-1, 2]), TypeError, r"low must be a finite number, or three .*, got int64 of shape \(2,\)"),
        (lambda: Uniform(0.2, None), TypeError, "high must be a finite number, or three of them for AVAIL_TORQUE, got None"),
        (lambda: Uniform("book", "nips"), TypeError, "low must be a finite number"),
        (lambda: Uniform(0.0, np.inf), ValueError, "high must be a finite number"),
        (lambda: LogUniform(0.0, 1.0), ValueError, "low must be above 0, got LogUniform"),
        (lambda: LogUniform([1, 2, 3], 4.0), TypeError, "low must be a finite number, got"),
        (lambda: Normal(1.0, 0.0, 0.5, 2.0), ValueError, "std must be above 0"),
        (lambda: Normal(3.0, 0.1, 0.5, 2.0), ValueError, "mean must be from low to high"),
        (lambda: Normal(1.0, np.nan, 0.5, 2.0), ValueError, "std must be a finite number, got nan"),
    ],
)
def test_invalid_draws_are_rejected_when_they_are_made(make, error, message):
    with pytest.raises(error, match=f"^{message}"):
        make()


def test_draws_cannot_change_in_place():
    low = np.array([-3.0, 0.0, 1.0])
    draw = Uniform(low, [np.float32(-2.0), 0, 2])
    low[0] = 5.0
    assert draw == Uniform((-3.0, 0.0, 1.0), (-2.0, 0.0, 2.0)) and hash(draw)


class Telling(acrobot_rs.AcrobotEnv):
    """Has a parameter in its infos."""

    def reset(self, **kwargs):
        return super().reset(**kwargs)[0], {"LINK_MASS_1": self.LINK_MASS_1, "AVAIL_TORQUE": np.array(self.AVAIL_TORQUE)}

    def step(self, action):
        return *super().step(action)[:4], {"LINK_MASS_1": self.LINK_MASS_1, "AVAIL_TORQUE": np.array(self.AVAIL_TORQUE)}


@MODES
def test_infos_have_parameters_as_those_of_sync_vector_env(mode):
    masses = np.linspace(0.5, 2.0, 4)
    theirs = gymnasium.vector.SyncVectorEnv(
        [lambda mass=mass: gymnasium.wrappers.TimeLimit(Telling(LINK_MASS_1=mass), 3) for mass in masses], autoreset_mode=mode
    )
    ours = make_vec(
        *(4,), max_episode_steps=3, autoreset_mode=mode, gymnasium_episodes=True, LINK_MASS_1=masses,
        info_parameters=["LINK_MASS_1", "AVAIL_TORQUE"],
    )  # fmt: skip
    assert_equal(theirs.reset(seed=1), ours.reset(seed=1))
    for _ in range(8):
        expected, found = theirs.step(np.ones(4, int)), ours.step(np.ones(4, int))
        finals = [each[-1].pop("final_info", {}) for each in (expected, found)]
        assert_equal(expected, found)
        np.testing.assert_equal(finals[1], finals[0])
        for envs in (theirs, ours):
            reset_ended(envs, expected[2] | expected[3])


def test_the_info_of_an_ended_episode_has_its_own_parameters():
    envs = make_vec(
        3, max_episode_steps=2, autoreset_mode="SameStep", LINK_MASS_1=LogUniform(0.5, 2.0), info_parameters=("LINK_MASS_1",)
    )
    _, infos = envs.reset(seed=1)
    envs.step([1] * 3)
    later = envs.step([1] * 3)[-1]
    assert (later["final_info"]["LINK_MASS_1"] == infos["LINK_MASS_1"]).all()
    assert (later["LINK_MASS_1"] == envs.get_parameter("LINK_MASS_1")).all()
    assert (later["LINK_MASS_1"] != infos["LINK_MASS_1"]).all()
    for names, wrong in [(["LINK_MAS_1"], "'LINK_MAS_1'; did you mean LINK_MASS_1"), ("dt", "'dt'")]:
        with pytest.raises(ValueError, match=f"info_parameters must be a sequence of names of parameters, got {wrong}"):
            make_vec(2, info_parameters=names)


def test_get_parameter():
    envs = make_vec(3)
    assert (envs.get_parameter("dt") == [0.2] * 3).all()
    assert (envs.get_parameter("AVAIL_TORQUE") == [[-1, 0, 1]] * 3).all()
    envs.book_or_nips = ["book", "nips", "book"]
    assert envs.get_parameter("book_or_nips").tolist() == ["book", "nips", "book"]
    envs.AVAIL_TORQUE = Uniform([-2, 0, 1], [-1, 0, 2])
    envs.reset()
    torques = envs.get_parameter("AVAIL_TORQUE")
    assert torques.shape == (3, 3) and envs.get_attr("AVAIL_TORQUE") == tuple(map(tuple, torques.tolist()))
    torques[:] = 0.0
    assert (envs.get_parameter("AVAIL_TORQUE") != 0.0).any(), "a new array"
    with pytest.raises(AttributeError, match="no parameter 'mass_1'; did you mean LINK_MASS_1"):
        envs.get_parameter("mass_1")


def test_spaces_follow_the_parameters():
    envs = gymnasium.make_vec(CONTINUOUS, num_envs=3, AVAIL_TORQUE=[-3.0, 0.0, 2.0])
    assert envs.single_action_space == gymnasium.spaces.Box(-3.0, 2.0, (1,), np.float32)
    envs.AVAIL_TORQUE = [[-1, 0, 1], [-5, 0, 1], [-1, 0, 4]]
    assert envs.single_action_space == gymnasium.spaces.Box(-5.0, 4.0, (1,), np.float32)
    assert envs.action_space == gymnasium.spaces.Box(-5.0, 4.0, (3, 1), np.float32)
    envs.MAX_VEL_1 = Uniform(20.0, 30.0)
    assert envs.single_observation_space.high[4] == 30.0 and (envs.observation_space.high[:, 4] == 30.0).all()


def test_subclasses_can_draw_parameters():
    class Random(AcrobotContinuousVectorEnv):
        MAX_VEL_1 = Uniform(20.0, 30.0)
        AVAIL_TORQUE = Uniform([-3.0, 0.0, 1.0], [-2.0, 0.0, 2.0])

    envs = Random(50)
    assert envs.single_observation_space.high[4] == 30
    assert envs.single_action_space == gymnasium.spaces.Box(-3.0, 2.0, (1,), np.float32)
    envs.reset(seed=1)
    assert len(set(envs.get_attr("MAX_VEL_1"))) == 50
    with pytest.raises(ValueError, match="MAX_VEL_1 must "):
        type("Wrong", (Random,), {"MAX_VEL_1": Uniform(-1.0, 2.0)})
    with pytest.raises(TypeError, match="LINK_MASS_1 must be a number, got Uniform"):
        acrobot_rs.AcrobotEnv().LINK_MASS_1 = Uniform(1.0, 2.0)
