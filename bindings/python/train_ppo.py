"""Trains PPO with JAX on the vector environment until the mean return of 100 episodes passes -100.

    pip install -r requirements-train.txt .
    python train_ppo.py                        seeds 1, 2 and 3
    python train_ppo.py 3 --save policy.bin    also saves the last policy, for a microcontroller

Prints for each seed the mean return, the steps and the seconds, and the policy's mean return in
Gymnasium's own environment. Fails if a seed has not learnt after a million steps.
"""

import argparse
import sys
import time

import acrobot_rs
import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
import optax
from acrobot_rs import policy

gymnasium.register_envs(acrobot_rs)
NAME = "acrobot_rs/Acrobot-v1"
THRESHOLD = gymnasium.spec(NAME).reward_threshold
ENVS, STEPS = 64, 64  # per update
UPDATES = 1_000_000 // (ENVS * STEPS)
EPOCHS, MINIBATCHES = 4, 4
LEARNING_RATE, MAX_GRADIENT = 2.5e-3, 0.5
DISCOUNT, LAMBDA = 0.99, 0.95
CLIP, ENTROPY, VALUE = 0.2, 0.01, 0.5
EPISODES, EVALUATE_EVERY = 100, 5  # per evaluation; updates between two
# The bounds of observations, which are divided by them.
SCALE = jnp.array([1, 1, 1, 1, 4 * jnp.pi, 9 * jnp.pi])

optimizer = optax.chain(
    optax.clip_by_global_norm(MAX_GRADIENT), optax.adam(LEARNING_RATE, eps=1e-5)
)


def layers(key, outputs, gain):
    """Weights and biases of a perceptron with two hidden layers of 64 units."""
    sizes = [6, 64, 64, outputs]
    gains = [2**0.5, 2**0.5, gain]
    return [
        (jax.nn.initializers.orthogonal(gain)(key, shape), jnp.zeros(shape[1]))
        for key, gain, *shape in zip(jax.random.split(key, 3), gains, sizes, sizes[1:])
    ]


def perceptron(layers, observations):
    *hidden, (weights, biases) = layers
    x = observations / SCALE
    for w, b in hidden:
        x = jnp.tanh(x @ w + b)
    return x @ weights + biases


def initial(key):
    """The untrained actor and critic."""
    actor, critic = jax.random.split(key)
    return {"actor": layers(actor, 3, 0.01), "critic": layers(critic, 1, 1.0)}


def log_probabilities(parameters, observations):
    return jax.nn.log_softmax(perceptron(parameters["actor"], observations))


def values(parameters, observations):
    return perceptron(parameters["critic"], observations)[..., 0]


@jax.jit
def act(parameters, key, observations):
    """Actions that the policy draws, and the key of the next draw."""
    key, draw = jax.random.split(key)
    return jax.random.categorical(draw, log_probabilities(parameters, observations)), key


def roll_out(envs, parameters, key, observations):
    """Plays STEPS in each environment.

    Returns arrays of shape (STEPS, ENVS, ...), the last observations, and the key of the next draw.
    """
    rollout = []
    for _ in range(STEPS):
        actions, key = act(parameters, key, observations)
        actions = np.asarray(actions)
        following, rewards, terminated, truncated, infos = envs.step(actions)
        ended = terminated | truncated
        # If an episode ended, its last observation follows, not the first one of the next episode.
        seen = following.copy()
        if ended.any():
            seen[ended] = np.stack(infos["final_obs"][ended])
        rollout.append((observations, actions, seen, rewards, terminated, ended))
        observations = following
    return [np.stack(each) for each in zip(*rollout)], observations, key


def advantages(parameters, observations, seen, rewards, terminated, ended):
    """Generalized advantage estimates."""
    # The value of a truncated episode's last observation estimates the rest.
    following = DISCOUNT * ~terminated * values(parameters, seen)
    errors = rewards + following - values(parameters, observations)

    def back(advantage, step):
        error, ended = step
        advantage = error + DISCOUNT * LAMBDA * ~ended * advantage
        return advantage, advantage

    return jax.lax.scan(back, jnp.zeros_like(errors[0]), (errors, ended), reverse=True)[1]


def loss(parameters, batch):
    """PPO's clipped loss on a minibatch."""
    observations, actions, old, advantage, targets = batch
    log_all = log_probabilities(parameters, observations)
    log = jnp.take_along_axis(log_all, actions[:, None], axis=1)[:, 0]
    ratio = jnp.exp(log - old)
    advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
    gain = jnp.minimum(ratio * advantage, jnp.clip(ratio, 1 - CLIP, 1 + CLIP) * advantage).mean()
    entropy = -(jnp.exp(log_all) * log_all).sum(axis=1).mean()
    error = jnp.square(values(parameters, observations) - targets).mean()
    return VALUE * error - gain - ENTROPY * entropy


@jax.jit
def learn(parameters, state, key, rollout):
    """The parameters and the optimizer's state after EPOCHS over the rollout."""
    observations, actions, seen, rewards, terminated, ended = rollout
    advantage = advantages(parameters, observations, seen, rewards, terminated, ended)
    targets = advantage + values(parameters, observations)
    old = jnp.take_along_axis(
        log_probabilities(parameters, observations), actions[..., None], axis=2
    )[..., 0]
    flat = [
        each.reshape(ENVS * STEPS, *each.shape[2:])
        for each in (observations, actions, old, advantage, targets)
    ]

    def minibatch(carry, indices):
        parameters, state = carry
        gradient = jax.grad(loss)(parameters, [each[indices] for each in flat])
        updates, state = optimizer.update(gradient, state)
        return (optax.apply_updates(parameters, updates), state), None

    keys = jax.random.split(key, EPOCHS)
    orders = jnp.concatenate(
        [jax.random.permutation(each, ENVS * STEPS).reshape(MINIBATCHES, -1) for each in keys]
    )
    return jax.lax.scan(minibatch, (parameters, state), orders)[0]


def evaluate(envs, parameters, key):
    """The mean return of one new episode in each environment. Counting the first 100 that end would
    favour short ones."""
    observations, _ = envs.reset()
    returns, running = np.zeros(envs.num_envs), np.ones(envs.num_envs, bool)
    while running.any():
        actions, key = act(parameters, key, observations)
        observations, rewards, terminated, truncated, _ = envs.step(np.asarray(actions))
        returns += rewards * running
        running &= ~(terminated | truncated)
    return returns.mean()


def train(seed):
    """The parameters, the steps and the mean return, as soon as an evaluation passes."""
    envs = gymnasium.make_vec(
        NAME, num_envs=ENVS, autoreset_mode=gymnasium.vector.AutoresetMode.SAME_STEP
    )
    others = gymnasium.make_vec(NAME, num_envs=EPISODES)
    of_envs, of_others, of_jax = (
        int(each) for each in np.random.SeedSequence(seed).generate_state(3)
    )
    observations, _ = envs.reset(seed=of_envs)
    others.reset(seed=of_others)
    init, key = jax.random.split(jax.random.key(of_jax))
    parameters = initial(init)
    state = optimizer.init(parameters)
    for update in range(UPDATES + 1):
        if update % EVALUATE_EVERY == 0:
            key, draw = jax.random.split(key)
            steps, mean = update * ENVS * STEPS, evaluate(others, parameters, draw)
            print(f"mean return {mean:.1f} after {steps:,} steps", file=sys.stderr)
            if mean > THRESHOLD:
                break
        rollout, observations, key = roll_out(envs, parameters, key, observations)
        key, order = jax.random.split(key)
        parameters, state = learn(parameters, state, order, rollout)
    return parameters, steps, mean


def save(parameters, path):
    """Writes the actor for `crates/policy`, with the observations' scale in its first layer."""
    *hidden, last = [(np.asarray(each[0]).T, np.asarray(each[1])) for each in parameters["actor"]]
    hidden[0] = (hidden[0][0] / np.asarray(SCALE), hidden[0][1])
    policy.write(path, [*((*layer, "tanh") for layer in hidden), (*last, "none")])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("seeds", nargs="*", type=int, default=[1, 2, 3])
    parser.add_argument("--save", help="file for the policy of the last seed")
    arguments = parser.parse_args()
    gymnasiums = gymnasium.make_vec("Acrobot-v1", num_envs=EPISODES, vectorization_mode="sync")
    learnt = True
    for seed in arguments.seeds:
        before = time.perf_counter()
        parameters, steps, mean = train(seed)
        seconds = time.perf_counter() - before
        gymnasiums.reset(seed=seed)
        there = evaluate(gymnasiums, parameters, jax.random.key(0))
        print(
            f"seed {seed}: {mean:.1f} after {steps:,} steps and {seconds:.1f} s;",
            f"in Gymnasium's own {there:.1f}",
            flush=True,
        )
        learnt &= mean > THRESHOLD
    if arguments.save:
        save(parameters, arguments.save)
    return 0 if learnt else "not all seeds have learnt"


if __name__ == "__main__":
    sys.exit(main())
