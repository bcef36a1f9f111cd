"""Streams, seeds, masks and autoresets are the documented ones, and with Gymnasium's episodes those
of SyncVectorEnv."""

import math
import types

import acrobot_rs
import gymnasium
import numpy as np
import pytest
from acrobot_rs.arrays import reset_mask, warn_of_other_sines
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode
from vectors import MODES, assert_equal, assert_resets_equal, different, make_vec, pair, rejects


def test_rejected_seeds_change_nothing():
    assert (make_vec(5).reset()[0] != make_vec(5).reset()[0]).any(), "random without a seed"
    envs, single = make_vec(2), acrobot_rs.AcrobotEnv()
    for each in (single, envs):
        assert (each.reset(seed=np.uint8(255))[0] == each.reset(seed=255)[0]).all()
        assert each.np_random_seed == 255
    bad_seeds = (-1, "4", 4.0, np.True_, 10**5000)
    for seed in (*bad_seeds, [1], (1,) * 3, *([1, bad] for bad in bad_seeds)):
        with rejects(envs, (ValueError, gymnasium.error.Error)):
            envs.reset(seed=seed)


def test_invalid_masks_are_rejected():
    envs = make_vec(2)
    for mask in (None, [1, 0], True, [False, False], [True], [True] * 3, [[True, False]]):
        with rejects(envs, ValueError, r"reset_mask must be .* of shape \(2,\) .*, got"):
            envs.reset(seed=1, options={"reset_mask": mask})


def test_other_bytes_than_0_and_1_in_a_mask_become_1():
    """A NumPy bool can be any byte. In Rust a bool that is not 0 or 1 is undefined behaviour."""
    mask = reset_mask({"reset_mask": np.array([2, 0, 255, 0], np.uint8).view(np.bool_)}, 4)
    assert mask.tobytes() == b"\1\0\1\0"


def test_other_sines_are_warned_of_once(monkeypatch):
    others = types.SimpleNamespace(sin=math.sin, cos=lambda x: math.cos(x) + (x > 0))
    monkeypatch.setattr(acrobot_rs.arrays, "math", others)
    warn_of_other_sines.cache_clear()
    message = "of [45],... of 10,000 angles differently .* are not bit-identical"
    with pytest.warns(UserWarning, match=message) as warned:
        acrobot_rs.AcrobotVectorEnv(gymnasium_episodes=True)
        acrobot_rs.AcrobotVectorEnv(gymnasium_episodes=True)
    assert len(warned) == 1 and warned[0].filename == __file__


@MODES
def test_gymnasium_s_episodes_bit_identically(mode):
    """Also with seeds, bounds, masks and parameters of each environment."""
    theirs, ours = pair(6, mode, max_episode_steps=150)
    for envs in (theirs, ours):
        envs.set_attr("torque_noise_max", 0.5)
    assert_equal(expected := theirs.reset(seed=2**70), ours.reset(seed=2**70))
    rng = np.random.default_rng(0)
    ends = np.zeros(2, int)
    for step in range(1500):
        energetic = np.where(expected[0][:, 4] > 0, 0, 2)
        actions = np.where(rng.random(6) < 0.3, rng.integers(3, size=6), energetic)
        expected, found = theirs.step(actions), ours.step(actions)
        assert_equal(expected, found)
        np.testing.assert_array_equal(np.array(theirs.get_attr("state"), np.float64), ours.state)
        np.testing.assert_array_equal(theirs.get_attr("_elapsed_steps"), ours.elapsed_steps)
        ended = expected[2] | expected[3]
        ends += expected[2].sum(), expected[3].sum()
        if step in (1100, 1200, 1300, 1400):
            for name, values in different(6, step).items():
                theirs.set_attr(name, list(values))
                ours.set_attr(name, values) if step == 1100 else setattr(ours, name, values)
                np.testing.assert_array_equal(getattr(ours, name), values)
                np.testing.assert_array_equal(ours.get_attr(name), theirs.get_attr(name))
            assert not ours.LINK_MASS_1.flags.writeable
        options = {"low": -0.4, "high": 0.7}
        if step == 600:
            assert_resets_equal(theirs, ours, options=options)
        elif step == 700:
            for envs in (theirs, ours):
                envs.set_attr("LINK_MASS_2", 1.5)
                envs.set_attr("book_or_nips", "nips")
        elif step == 800:
            assert_resets_equal(theirs, ours, seed=[5, None, 7, 2**80, None, 5])
        elif step in (900, 901) or (mode is AutoresetMode.DISABLED and ended.any()):
            mask = ended | (np.arange(6) % 3 == step % 3)
            assert_resets_equal(theirs, ours, seed=step, options={**options, "reset_mask": mask})
    assert (ends > 10).all()


@MODES
def test_observations_of_initial_states_bit_identically(mode):
    """Computed in float32: one in 500 differs from the rounded sines of float64."""
    theirs, ours = pair(500, mode, max_episode_steps=1)
    assert_resets_equal(theirs, ours, seed=1)
    options = {"low": -9.0, "high": 9.0, "reset_mask": np.arange(500) % 2 == 0}
    assert_resets_equal(theirs, ours, options=options)
    for actions in np.random.default_rng(0).integers(3, size=(5, 500)):
        assert_equal(theirs.step(actions), ours.step(actions))
        if mode is AutoresetMode.DISABLED:
            assert_resets_equal(theirs, ours, options={"reset_mask": np.ones(500, bool)})


def test_without_autoreset_an_ended_episode_must_be_reset():
    envs = make_vec(3, autoreset_mode="Disabled", max_episode_steps=5, render_mode="rgb_array")
    for call in (lambda: envs.step([0, 1, 2]), envs.render):
        with pytest.raises(ResetNeeded, match="call reset before"):
            call()
    envs.reset(seed=1)
    for _ in range(5):
        envs.step([0, 1, 2])
    for index, mask in ((0, [True, True, False]), (2, [False, False, True])):
        with rejects(envs, ResetNeeded, f"the episode of environment {index} has ended; reset it"):
            envs.step([0, 1, 2])
        envs.reset(options={"reset_mask": np.array(mask)})
    assert not envs.step([0, 1, 2])[3].any()
