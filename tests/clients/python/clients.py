"""Runs other people's programs end to end with our environments, and with Gymnasium's in their place: results must have the
same types and shapes. `bash .ci/jobs/clients-python` installs the programs that `requirements.txt` beside this file pins.
"""

import os
import sys
import tempfile

import acrobot_rs  # registers our environments
import gymnasium as gym
import numpy as np

#: Gymnasium's environment, and ours with the same kinds of actions.
PAIRS = [
    ("Acrobot-v1", "acrobot_rs/Acrobot-v1"),
    ("Pendulum-v1", "acrobot_rs/AcrobotContinuous-v0"),
    ("Pendulum-v1", "acrobot_rs/AcrobotSwingup-v0"),
]


def many(name, count, mode):
    """A vector environment. Gymnasium's takes the mode elsewhere."""
    if name.startswith("acrobot_rs/"):
        return gym.make_vec(name, num_envs=count, autoreset_mode=mode)
    return gym.make_vec(name, num_envs=count, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode})


def torchrl(name):
    """Rollouts of one environment, and of many that reset themselves."""
    from torchrl.envs.libs.gym import GymEnv, GymWrapper
    from torchrl.envs.utils import check_env_specs

    envs = [GymEnv(name), GymWrapper(many(name, 3, "SameStep"))]
    check_env_specs(envs[0])
    return [env.rollout(250, break_when_any_done=False)["next", "reward"].shape for env in envs]


def skrl(name):
    """PPO of skrl's runner, which chooses the wrapper by the classes."""
    from skrl.envs.wrappers.torch import wrap_env
    from skrl.utils.runner.torch import Runner

    env = wrap_env(many(name, 3, "NextStep"), verbose=False)
    network = [{"name": "net", "input": "OBSERVATIONS", "layers": [8], "activations": "tanh"}]
    actor = "CategoricalMixin" if isinstance(env.action_space, gym.spaces.Discrete) else "GaussianMixin"
    runner = Runner(env, {
        "seed": 1,
        "models": {"separate": True, "policy": {"class": actor, "network": network, "output": "ACTIONS"},
                   "value": {"class": "DeterministicMixin", "network": network, "output": "ONE"}},
        "memory": {"class": "RandomMemory", "memory_size": -1},
        "agent": {"class": "PPO", "rollouts": 16, "experiment": {"write_interval": 0, "checkpoint_interval": 0}},
        "trainer": {"class": "SequentialTrainer", "timesteps": 64, "disable_progressbar": True},
    })  # fmt: skip
    runner.run()
    return type(env).__name__, env.num_envs


def tianshou(name):
    """A collector of transitions."""
    from tianshou.algorithm.algorithm_base import RandomActionPolicy
    from tianshou.data import Collector, VectorReplayBuffer
    from tianshou.env import DummyVectorEnv

    envs = DummyVectorEnv([lambda: gym.make(name, max_episode_steps=20)] * 3)
    buffer = VectorReplayBuffer(300, 3)
    collector = Collector(RandomActionPolicy(envs.action_space[0]), envs, buffer)
    collector.reset()
    stats = collector.collect(n_step=300, random=True)
    return stats.n_collected_steps, buffer.rew.shape, sorted(set(stats.lens.tolist()))


def stable_baselines3(name):
    """PPO learns, and its policy is evaluated."""
    from acrobot_rs.sb3 import AcrobotVecEnv
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env
    from stable_baselines3.common.evaluation import evaluate_policy
    from stable_baselines3.common.vec_env import VecMonitor

    def learn(envs):
        model = PPO("MlpPolicy", envs, n_steps=64, batch_size=64, n_epochs=1, seed=1, device="cpu").learn(512)
        _, lengths = evaluate_policy(model, gym.make(name, max_episode_steps=20), 2, warn=False, return_episode_rewards=True)
        return model.num_timesteps, lengths

    result = learn(make_vec_env(name, 4))
    if name.startswith("acrobot_rs/"):
        assert learn(VecMonitor(AcrobotVecEnv(many(name, 4, "SameStep")))) == result
    return result


def minari(name):
    """A data set of two episodes, stored and read again, with its environment."""
    from minari import DataCollector, load_dataset

    with tempfile.TemporaryDirectory() as folder:
        os.environ["MINARI_DATASETS_PATH"] = folder
        env = DataCollector(gym.make(name, max_episode_steps=20))
        for options in (None, {"minari_autoseed": False}):
            env.reset(seed=1, options=options)
            while not any(env.step(env.action_space.sample())[2:4]):
                pass
        env.create_dataset("clients/test-v0", eval_env=name)
        data = load_dataset("clients/test-v0")
        again = data.recover_environment()
        first = data[0].observations[0]
        return data.total_episodes, data.total_steps, (again.reset(seed=1)[0] == first).all(), type(first)


def statistics(name):
    """Gymnasium's own wrappers around many environments with masked resets."""
    from gymnasium.wrappers.vector import ClipReward, DictInfoToList, NormalizeObservation, RecordEpisodeStatistics

    envs = DictInfoToList(NormalizeObservation(ClipReward(RecordEpisodeStatistics(many(name, 3, "NextStep")), -1.0, 1.0)))
    envs.reset(seed=1)
    envs.action_space.seed(1)
    steps = [envs.step(envs.action_space.sample()) for _ in range(1100)]
    lengths = {int(info["episode"]["l"]) for *_, infos in steps for info in infos if "episode" in info}
    return steps[0][0].dtype, bool(lengths)


def main():
    """Runs the clients that the command names, or all."""
    clients = {each.__name__: each for each in (torchrl, skrl, tianshou, stable_baselines3, minari, statistics)}
    failed = 0
    for name in sys.argv[1:] or clients:
        for theirs, ours in PAIRS:
            results = []
            for each in (theirs, ours):
                try:
                    results.append(clients[name](each))
                except Exception as error:  # noqa: BLE001 — one client's failure must not hide another's
                    results.append(f"{type(error).__name__}: {error}")
            same = results[0] == results[1] and not isinstance(results[0], str)
            failed += not same
            print(f"{name:18} {ours:32} {'passed' if same else f'FAILED: {results[1]}, {theirs}: {results[0]}'}", flush=True)
    print(f"acrobot_rs {acrobot_rs.__version__}, NumPy {np.__version__}, Gymnasium {gym.__version__}: {failed} failed")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
