"""The single environment is bit-identical to Gymnasium's, which runs beside it."""

import acrobot_rs
import gymnasium
import numpy as np
import pytest

STEPS = 500


def side_by_side(seed, book_or_nips="book", noise=0.0, dt=0.2, options=None):
    """Plays the same actions in both. A reset in the middle continues their streams."""
    theirs, ours = gymnasium.make("Acrobot-v1").unwrapped, gymnasium.make("acrobot_rs/Acrobot-v1").unwrapped
    for env in (theirs, ours):
        env.book_or_nips, env.torque_noise_max, env.dt = book_or_nips, noise, dt
        env.action_space.seed(seed)
    initial = [env.reset(seed=seed, options=options) for env in (theirs, ours)]
    for step in range(STEPS):
        if step == 300:
            initial = [env.reset(options=options) for env in (theirs, ours)]
        if initial:
            (first, _), (our_first, info) = initial
            assert (ours.state == theirs.state).all()
            np.testing.assert_array_max_ulp(our_first, first, maxulp=1)
            assert our_first.dtype == first.dtype and info == {}
            initial = None
        action = theirs.action_space.sample()
        assert ours.action_space.sample() == action
        observation, *signals = theirs.step(action)
        our_observation, *our_signals = ours.step(action)
        assert ours.state.tobytes() == theirs.state.tobytes(), f"step {step}"
        assert our_observation.tobytes() == observation.tobytes(), f"step {step}"
        assert our_signals == signals and list(map(type, our_signals)) == list(map(type, signals))
    assert ours.np_random.bit_generator.state == theirs.np_random.bit_generator.state


@pytest.mark.parametrize("seed", range(50))
def test_seeds(seed):
    side_by_side(seed)


@pytest.mark.parametrize("book_or_nips", ["book", "nips"])
@pytest.mark.parametrize("noise", [0.0, 0.3])
@pytest.mark.parametrize("dt", [0.2, 0.05])
def test_parameters_and_reset_bounds(book_or_nips, noise, dt):
    side_by_side(2**70 + 1, book_or_nips, noise, dt, {"low": -1.5, "high": 2.0})


def test_other_parameters():
    """Single steps with random masses, lengths, torques, bounds and states."""
    rng = np.random.default_rng(0)
    theirs, ours = gymnasium.make("Acrobot-v1").unwrapped, acrobot_rs.AcrobotEnv()
    names = ["LINK_LENGTH_1", "LINK_MASS_1", "LINK_MASS_2", "LINK_COM_POS_1", "LINK_COM_POS_2", "LINK_MOI"]
    for _ in range(500):
        for name in names:
            value = rng.uniform(0.3, 2.0)
            setattr(theirs, name, value)
            setattr(ours, name, value)
        theirs.AVAIL_TORQUE = ours.AVAIL_TORQUE = rng.uniform(-5, 5, 3).tolist()
        theirs.MAX_VEL_1 = ours.MAX_VEL_1 = rng.uniform(2, 20)
        theirs.state = ours.state = rng.uniform(-8, 8, 4)
        action = int(rng.integers(3))
        theirs.step(action)
        ours.step(action)
        assert ours.state.tobytes() == theirs.state.tobytes()


def test_v0_observes_the_state():
    env = acrobot_rs.AcrobotV0Env()
    twin = acrobot_rs.AcrobotEnv()
    observation, _ = env.reset(seed=9)
    twin.reset(seed=9)
    for action in np.random.default_rng(9).integers(3, size=100):
        assert (observation == twin.state.astype(np.float32)).all()
        observation = env.step(action)[0]
        twin.step(action)
