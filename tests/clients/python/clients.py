"""Runs other people's programs with our environments, and with Gymnasium's in their place.

The results of both must have the same types and shapes. `bash .ci/run clients` installs the
programs, which `requirements.txt` beside this file pins.
"""

import os
import sys
import tempfile

import acrobot_rs
import gymnasium as gym
from acrobot_rs.sb3 import AcrobotVecEnv

#: Gymnasium's environment, and ours with the same kind of actions.
PAIRS = [
    ("Acrobot-v1", "acrobot_rs/Acrobot-v1"),
    ("Pendulum-v1", "acrobot_rs/AcrobotContinuous-v0"),
    ("Pendulum-v1", "acrobot_rs/AcrobotSwingup-v0"),
]


def many(name, count, mode):
    """A vector environment. Gymnasium's takes the mode elsewhere."""
    if name.startswith("acrobot_rs/"):
        return gym.make_vec(name, num_envs=count, autoreset_mode=mode)
    kwargs = {"autoreset_mode": mode}
    return gym.make_vec(name, num_envs=count, vectorization_mode="sync", vector_kwargs=kwargs)


def torchrl(name):
    """Rollouts of one environment, and of many that reset themselves."""
    from torchrl.envs.libs.gym import GymEnv, GymWrapper
    from torchrl.envs.utils import check_env_specs

    envs = [GymEnv(name), GymWrapper(many(name, 3, "SameStep"))]
    check_env_specs(envs[0])
    return [env.rollout(250, break_when_any_done=False)["next", "reward"].shape for env in envs]


def skrl(name):
    """PPO of skrl's runner, with the wrapper that skrl chooses by the classes."""
    from skrl.envs.wrappers.torch import wrap_env
    from skrl.utils.runner.torch import Runner

    env = wrap_env(many(name, 3, "NextStep"), verbose=False)
    discrete = isinstance(env.action_space, gym.spaces.Discrete)
    layers = [{"name": "net", "input": "OBSERVATIONS", "layers": [8], "activations": "tanh"}]
    policy = {"class": "CategoricalMixin" if discrete else "GaussianMixin", "output": "ACTIONS"}
    value = {"class": "DeterministicMixin", "output": "ONE"}
    models = {"policy": policy | {"network": layers}, "value": value | {"network": layers}}
    no_files = {"write_interval": 0, "checkpoint_interval": 0}
    configuration = {
        "seed": 1,
        "models": {"separate": True, **models},
        "memory": {"class": "RandomMemory", "memory_size": -1},
        "agent": {"class": "PPO", "rollouts": 16, "experiment": no_files},
        "trainer": {"class": "SequentialTrainer", "timesteps": 64, "disable_progressbar": True},
    }
    Runner(env, configuration).run()
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
    collected = collector.collect(n_step=300, random=True)
    return collected.n_collected_steps, buffer.rew.shape, set(collected.lens.tolist())


def stable_baselines3(name):
    """PPO learns, and its policy is evaluated."""
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env
    from stable_baselines3.common.evaluation import evaluate_policy
    from stable_baselines3.common.vec_env import VecMonitor

    def learn(envs):
        model = PPO("MlpPolicy", envs, n_steps=64, n_epochs=1, seed=1, device="cpu").learn(512)
        env = gym.make(name, max_episode_steps=20)
        _, lengths = evaluate_policy(model, env, 2, warn=False, return_episode_rewards=True)
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
        first = data.recover_environment().reset(seed=1)[0]
        return data.total_episodes, data.total_steps, (data[0].observations[0] == first).all()


def wrappers(name):
    """Gymnasium's own, around many environments."""
    from gymnasium.wrappers import vector

    envs = vector.RecordEpisodeStatistics(many(name, 3, "NextStep"))
    envs = vector.DictInfoToList(vector.NormalizeObservation(vector.ClipReward(envs, -1.0, 1.0)))
    envs.reset(seed=1)
    steps = [envs.step(envs.action_space.sample()) for _ in range(1100)]
    episodes = [info["episode"] for *_, infos in steps for info in infos if "episode" in info]
    return [each.dtype for each in steps[0][2:4]], bool(episodes)


def main():
    """Runs the clients that the command names, or all."""
    clients = (torchrl, skrl, tianshou, stable_baselines3, minari, wrappers)
    failed = 0
    for client in clients:
        if sys.argv[1:] and client.__name__ not in sys.argv:
            continue
        for names in PAIRS:
            results = []
            for name in names:
                try:
                    results.append(client(name))
                except Exception as error:  # the other programs run all the same
                    results.append(f"{name}: {type(error).__name__}: {error}")
            same = results[0] == results[1]
            failed += not same
            verdict = "passed" if same else f"FAILED: {results}"
            print(f"{client.__name__:18} {names[1]:32} {verdict}", flush=True)
    print(f"acrobot_rs {acrobot_rs.__version__}, Gymnasium {gym.__version__}: {failed} failed")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
