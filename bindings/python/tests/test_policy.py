"""Policies in files for the crate `crates/policy`: what is written, and what is rejected.

Stand-ins have the attributes of torch's modules.
"""

from pathlib import Path
from types import SimpleNamespace as Attributes

import acrobot_rs
import gymnasium as gym
import numpy as np
import pytest
from acrobot_rs import policy

RNG = np.random.default_rng(7)


class Tensor(np.ndarray):
    def detach(self):
        return self

    cpu = detach

    def numpy(self):
        return np.asarray(self)


class Linear:
    def __init__(self, inputs, outputs):
        self.weight, self.bias = (
            RNG.normal(size=size).view(Tensor) for size in [(outputs, inputs), (outputs,)]
        )

    def __call__(self, x):
        return x @ np.asarray(self.weight).T + np.asarray(self.bias)


class Tanh:
    __call__ = staticmethod(np.tanh)


class ReLU:
    def __call__(self, x):
        return np.maximum(x, 0)


class GELU:
    pass


class Dropout:
    training = True


class Model:
    """A model of Stable-Baselines3: `kind` names its network."""

    def __init__(self, kind, modules, space=gym.spaces.Discrete(3), quantiles=1, normalize=None):
        quantile_net = Attributes(quantile_net=modules, n_quantiles=quantiles)
        actor = Attributes(policy_net=modules[:-1])
        networks = {
            "ppo": {"mlp_extractor": actor, "action_net": modules[-1]},
            "dqn": {"q_net": Attributes(q_net=modules)},
            "qrdqn": {"quantile_net": quantile_net},
        }
        seen = acrobot_rs.AcrobotEnv().observation_space
        self.policy = Attributes(action_space=space, observation_space=seen, **networks[kind])
        self.modules, self.quantiles, self.normalize = modules, quantiles, normalize

    def get_vec_normalize_env(self):
        return self.normalize

    def predict(self, x, deterministic):
        assert deterministic
        for module in self.modules:
            x = module(x)
        scores = x.reshape(len(x), self.quantiles, -1).mean(1)
        if scores.shape[1] > 1:
            return scores.argmax(1), None
        return np.clip(scores, self.policy.action_space.low, self.policy.action_space.high), None


def actor(bound):
    """A model whose action is from minus this bound to it."""
    return Model("ppo", [Linear(6, 4), Tanh(), Linear(4, 1)], gym.spaces.Box(-bound, bound, (1,)))


def swingup_actor():
    model = actor(1.0)
    model.policy.observation_space = acrobot_rs.AcrobotSwingupEnv().observation_space
    return model


class Normalize:
    norm_obs, epsilon, clip_obs = True, 1e-8, 100.0
    obs_rms = Attributes(mean=RNG.normal(size=6) / 4, var=RNG.uniform(0.2, 3, 6))

    def normalize_obs(self, x):
        return (x - self.obs_rms.mean) / np.sqrt(self.obs_rms.var + self.epsilon)


@pytest.mark.parametrize("normalize", [None, Normalize()])
@pytest.mark.parametrize("kind", ["ppo", "dqn", "qrdqn"])
def test_models_of_stable_baselines3_are_saved_with_their_own_actions(kind, normalize, tmp_path):
    quantiles = 5 if kind == "qrdqn" else 1
    modules = [Linear(6, 8), Tanh(), Linear(8, 8), ReLU(), Linear(8, 3 * quantiles)]
    model = Model(kind, modules, quantiles=quantiles, normalize=normalize)
    policy.save(model, tmp_path / "p")  # compares the actions
    first, *others = policy.load(tmp_path / "p").layers
    assert [(weights.shape, name) for weights, _, name in (first, *others)] == [
        *(((8, 6), "tanh"), ((8, 8), "relu"), ((3, 8), "none"))
    ]
    if normalize is None:
        np.testing.assert_array_equal(first[0], np.float32(modules[0].weight))
        np.testing.assert_array_equal(first[1], np.float32(modules[0].bias))
    # A model that answers otherwise is found.
    model.predict = lambda x, deterministic: ((Model.predict(model, x, True)[0] + 1) % 3, None)
    with pytest.raises(ValueError, match="they differ on .* of 2000 observations"):
        policy.save(model, tmp_path / "other")
    assert not (tmp_path / "other").exists()


@pytest.mark.parametrize(
    ("model", "given", "limit", "factor"),
    [(actor(2.5), None, 2.5, 1.0), (swingup_actor(), 3.0, 3.0, 3.0)],
)
def test_an_action_is_a_torque_or_in_a_swing_up_becomes_one(model, given, limit, factor, tmp_path):
    policy.save(model, tmp_path / "p", torque_limit=given)
    loaded = policy.load(tmp_path / "p")
    assert loaded.torque_limit == limit
    weights, biases, _ = loaded.layers[-1]
    np.testing.assert_allclose(weights, factor * model.modules[-1].weight, rtol=1e-6)
    np.testing.assert_allclose(biases, factor * model.modules[-1].bias, rtol=1e-6)


def test_a_file_acts_as_its_model(tmp_path):
    # A model with all three actions, whatever the other tests draw.
    RNG.bit_generator.state = np.random.default_rng(7).bit_generator.state
    model = Model("ppo", [Linear(6, 8), Tanh(), Linear(8, 8), ReLU(), Linear(8, 3)])
    policy.save(model, tmp_path / "p")
    seen = RNG.normal(size=(50, 6)).astype(np.float32)
    loaded = policy.load(tmp_path / "p")
    assert len({*loaded.act(seen)}) == 3
    assert (loaded.act(seen) == model.predict(seen, deterministic=True)[0]).all()
    env = acrobot_rs.AcrobotEnv()
    env.step(loaded.act(env.reset(seed=1)[0]))
    model = swingup_actor()
    policy.save(model, tmp_path / "p", torque_limit=2.0)
    torques, loaded = model.predict(seen, deterministic=True)[0], policy.load(tmp_path / "p")
    np.testing.assert_allclose(loaded.act(seen), 2 * torques, rtol=1e-5, atol=1e-5)
    assert (abs(loaded.act(10 * seen)) == 2).any() and loaded.act(seen[0]).shape == (1,)
    for wrong in seen[:, :5], np.full(6, np.nan), np.zeros((1, 1, 6)), [1e39] * 6, ["1"] * 6:
        with pytest.raises(ValueError, match="^observation must be finite numbers of shape"):
            loaded.act(wrong)


def test_sums_that_overflow_play_no_torque(tmp_path):
    """As the crate's: alone and among other observations, with its recording."""
    recording = Path(__file__).parents[3] / "crates/policy/overflow.txt"
    lines = [line.split() for line in recording.read_text().splitlines()]
    for file in dict.fromkeys(line[-1] for line in lines):
        (tmp_path / "p").write_bytes(bytes.fromhex(file))
        loaded = policy.load(tmp_path / "p")
        names, *columns = zip(*(line[:-1] for line in lines if line[-1] == file), strict=True)
        seen = np.float32(columns[:6]).T
        column = 6 if loaded.torque_limit is None else 7
        expected = np.float32(columns[column]).reshape(4, *[1] * (column - 6))
        np.testing.assert_array_equal(loaded.act(seen), expected, names[0])
        np.testing.assert_array_equal([*map(loaded.act, seen)], expected, names[0])


def test_other_files_are_rejected(tmp_path):
    policy.write(tmp_path / "p", [(np.ones((3, 6)), np.ones(3), "relu")])
    file = (tmp_path / "p").read_bytes()
    assert policy.load(tmp_path / "p").act(np.zeros(6)) == 0  # the first of equal scores
    damaged = [file[:i] + bytes([byte ^ 1]) + file[i + 1 :] for i, byte in enumerate(file)]
    for other in (*damaged, *(file[:size] for size in range(len(file))), file + b"x"):
        (tmp_path / "p").write_bytes(other)
        with pytest.raises(ValueError, match="p must be what acrobot_rs.policy.save or write"):
            policy.load(tmp_path / "p")


def test_clipped_observations_are_found(tmp_path):
    normalize = Normalize()
    normalize.clip_obs = 0.5
    normalize.normalize_obs = lambda x: np.clip(Normalize().normalize_obs(x), -0.5, 0.5)
    message = "they differ on .* VecNormalize clips at clip_obs=0.5, and the file does not"
    with pytest.raises(ValueError, match=message):
        policy.save(Model("dqn", [Linear(6, 3)], normalize=normalize), tmp_path / "p")


def dqn(*modules):
    return Model("dqn", modules)


def overflowing():
    """1e30 times 1e30 is beyond float32, and infinity less infinity is no number."""
    model = dqn(Linear(6, 2), Linear(2, 3))
    model.modules[0].weight[:], model.modules[1].weight[:] = 1e30, [[1e30, -1e30]] * 3
    return model


LIMIT = "torque_limit must be "


@pytest.mark.parametrize(
    ("error", "message", "model", "arguments"),
    [
        (TypeError, "a layer must be one of Linear, Tanh.*, got GELU", dqn(GELU()), {}),
        (TypeError, "Tanh must follow a linear layer", dqn(Tanh(), Linear(6, 3)), {}),
        (TypeError, "the policy must be that of PPO, A2C, DQN or QR-DQN", Attributes(policy=1), {}),
        (TypeError, "model must be .*, got 5", 5, {}),
        (ValueError, r"layer 0 must have weights of shape \(outputs, 6\)", dqn(Linear(4, 3)), {}),
        (ValueError, "must have 3 outputs, or 1 with a torque_limit, got 2", dqn(Linear(6, 2)), {}),
        (ValueError, "must be finite; they are not on .* of 2000", overflowing(), {}),
        (ValueError, "it has Dropout in training mode", [Linear(6, 3), Dropout()], {}),
        (ValueError, f"{LIMIT}the torque of the swing-up's action 1", swingup_actor(), {}),
        *((ValueError, f"{LIMIT}finite and above 0 N m", swingup_actor(), {"torque_limit": limit})
          for limit in (np.nan, 1e39, 1e-50, -2.0)),
        *((ValueError, "observations must be .*, got", dqn(Linear(6, 3)), {"observations": seen})
          for seen in (np.zeros((0, 6)), np.zeros((5, 4)), np.full((3, 6), np.nan))),
        (ValueError, "bounds of the action space must be .*opposite, got -1.0 and 2.0",
         Model("ppo", [Linear(6, 1)], gym.spaces.Box(-1, 2, (1,))), {}),
    ],
)  # fmt: skip
def test_other_models_are_rejected(error, message, model, arguments, tmp_path):
    with pytest.raises(error, match=message):
        policy.save(model, tmp_path / "p", **arguments)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("message", "outputs", "weight", "activation", "limit"),
    [
        ("the activation of layer 0 must be one of", 3, 1.0, "elu", None),
        ("the weights of layer 0 must be numbers, got ", 3, "1", "none", None),
        ("numbers of layer 0 must be finite", 3, 1e300, "none", None),
        (f"{LIMIT}finite and above 0 N m", 1, 1.0, "none", -1),
    ],
)
def test_other_layers_are_rejected(message, outputs, weight, activation, limit, tmp_path):
    layer = np.full((outputs, 6), weight), np.ones(outputs), activation
    for call in lambda *arguments: policy.write(tmp_path / "p", *arguments), policy.Policy:
        with pytest.raises(ValueError, match=message):
            call([layer], limit)
    assert not list(tmp_path.iterdir())
