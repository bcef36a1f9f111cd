"""train_ppo.py computes advantages and rollouts correctly, and learns."""

import re
import subprocess
import sys

import gymnasium
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


def test_a_rollout_contains_the_last_observation_of_an_episode_and_then_the_next_episode():
    mode = gymnasium.vector.AutoresetMode.SAME_STEP
    envs = gymnasium.make_vec(train_ppo.NAME, num_envs=4, autoreset_mode=mode, max_episode_steps=10)
    first, _ = envs.reset(seed=0)
    parameters = train_ppo.initial(jax.random.key(0))
    rollout, last, _ = train_ppo.roll_out(envs, parameters, jax.random.key(0), first)
    observations, actions, seen, rewards, terminated, ended = rollout

    assert actions.shape == rewards.shape == terminated.shape == (train_ppo.STEPS, 4)
    assert (ended == (np.arange(train_ppo.STEPS) % 10 == 9)[:, None]).all() and not terminated.any()
    before, after = seen[:-1][ended[:-1]], observations[1:][ended[:-1]]
    assert (before != after).any(axis=1).all()
    # Initial velocities are within 0.1 rad/s.
    assert (np.abs(after[:, 4:]) <= 0.1).all()
    assert (seen[:-1][~ended[:-1]] == observations[1:][~ended[:-1]]).all()
    assert (observations[0] == first).all() and (seen[-1] == last).all()


def test_an_evaluation_counts_one_episode_of_each_environment():
    envs = gymnasium.make_vec(train_ppo.NAME, num_envs=2, max_episode_steps=7)
    envs.reset(seed=0)
    assert train_ppo.evaluate(envs, train_ppo.initial(jax.random.key(0)), jax.random.key(0)) == -7


def test_it_learns():
    command = [sys.executable, train_ppo.__file__, "1", "2", "3"]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    means = [float(mean) for mean in re.findall(r"seed \d: (-[\d.]+) after", run.stdout)]
    assert len(means) == 3 and min(means) > -100, run.stdout
    assert "mean return" in run.stderr
