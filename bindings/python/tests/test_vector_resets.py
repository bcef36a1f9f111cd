"""Streams, seeds, masks and autoresets are the documented ones, and with Gymnasium's episodes those
of SyncVectorEnv."""

import math
import types

import acrobot_rs
import numpy as np
import pytest
from acrobot_rs.arrays import reset_mask, warn_of_other_sines
from gymnasium.vector import AutoresetMode
from vectors import assert_equal, assert_resets_equal, different, make_vec, pair


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


@pytest.mark.parametrize("mode", AutoresetMode)
def test_gymnasium_s_episodes_bit_identically(mode):
    """Also with seeds, bounds, masks and parameters of each environment."""
    count, end, ends = 60, np.zeros(60, bool), np.zeros(2, int)
    theirs, ours = both = pair(count, mode, max_episode_steps=40)
    for name, value in {"torque_noise_max": 0.5, "AVAIL_TORQUE": [-4.0, 0.0, 4.0]}.items():
        theirs.set_attr(name, [value] * count)
        ours.set_attr(name, value)
    assert_resets_equal(*both, seed=2**70)
    for step in range(1, 400):
        rng, mask = np.random.default_rng(step), end | (np.arange(count) == step % count)
        options = {"low": -0.4, "high": 0.7}
        if step % 70 == 0:
            for name, values in different(count, step).items():
                theirs.set_attr(name, list(values))
                ours.set_attr(name, values) if step == 70 else setattr(ours, name, values)
                np.testing.assert_array_equal(getattr(ours, name), values)
                np.testing.assert_array_equal(ours.get_attr(name), theirs.get_attr(name))
            assert not ours.LINK_MASS_1.flags.writeable
        elif step % 100 == 99:
            assert_resets_equal(*both, options={"low": -9.0, "high": 9.0})
        elif step % 100 == 50:
            for name, value in {"LINK_MASS_2": 1.5, "book_or_nips": "nips"}.items():
                theirs.set_attr(name, value)
                ours.set_attr(name, value)
            assert_resets_equal(*both, seed=[5, None, 7, 2**80, None, 5] * 10)
        if step % 50 < 2 or (mode is AutoresetMode.DISABLED and end.any()):
            assert_resets_equal(*both, seed=step, options={**options, "reset_mask": mask})
        energetic = np.where(ours.state[:, 2] > 0, 0, 2)
        actions = np.where(rng.random(count) < 0.3, rng.integers(3, size=count), energetic)
        found = ours.step(actions)
        assert_equal(theirs.step(actions), found)
        np.testing.assert_array_equal(np.array(theirs.get_attr("state"), np.float64), ours.state)
        np.testing.assert_array_equal(theirs.get_attr("_elapsed_steps"), ours.elapsed_steps)
        ends, end = ends + [each.sum() for each in found[2:4]], found[2] | found[3]
    assert (ends > 100).all(), ends


def test_given_states_have_numpy_s_sines():
    states = np.random.default_rng(0).uniform(-3, 3, (1000, 4)).astype(np.float32)
    envs = make_vec(1000, gymnasium_episodes=True)
    observations, _ = envs.reset(options={"state": states})
    angles = states[:, :2].copy()
    sines = np.stack([np.cos(angles), np.sin(angles)], axis=2)
    assert (observations[:, :4] == sines.reshape(1000, 4)).all()
