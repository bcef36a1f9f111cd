"""train_ppo.py computes advantages correctly, and learns."""

import re
import subprocess
import sys

import jax
import numpy as np
import train_ppo


def test_advantages_are_the_discounted_errors_until_the_end_of_the_episode():
    rng = np.random.default_rng(0)
    shape = (train_ppo.STEPS, 3)
    observations, seen = rng.normal(size=(2, *shape, 6)).astype(np.float32)
    rewards = -np.ones(shape, np.float32)
    terminated, truncated = rng.random((2, *shape)) < 0.1
    ended = terminated | truncated
    parameters = train_ppo.initial(jax.random.key(0))
    value, following = (
        np.asarray(train_ppo.values(parameters, each)) for each in (observations, seen)
    )

    expected = np.zeros(shape)
    for step, env in np.ndindex(shape):
        weight = 1.0
        for later in range(step, train_ppo.STEPS):
            rest = 0.0 if terminated[later, env] else train_ppo.DISCOUNT * following[later, env]
            expected[step, env] += weight * (rewards[later, env] + rest - value[later, env])
            if ended[later, env]:
                break
            weight *= train_ppo.DISCOUNT * train_ppo.LAMBDA

    advantages = train_ppo.advantages(parameters, observations, seen, rewards, terminated, ended)
    np.testing.assert_allclose(advantages, expected, rtol=1e-4, atol=1e-4)


def test_it_learns():
    command = [sys.executable, train_ppo.__file__, "1", "2", "3"]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    means = [float(mean) for mean in re.findall(r"seed \d: (-[\d.]+) after", run.stdout)]
    assert len(means) == 3 and min(means) > -100, run.stdout
    assert "mean return" in run.stderr
