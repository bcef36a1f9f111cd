"""Policies in files for the crate `crates/policy`: what is written, and what is rejected.

Stand-ins have the attributes of torch's modules.
"""

import sys
from pathlib import Path
from types import SimpleNamespace as Attributes

import acrobot_rs
import numpy as np
import pytest
from acrobot_rs import policy

RNG = np.random.default_rng(7)
POLICY = Path(__file__).parents[3] / "crates/policy/policy.bin"


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


class Model:
    """A model of Stable-Baselines3: `kind` names its network."""

    def __init__(self, kind, modules, env=None, quantiles=1, normalize=None):
        env = env or acrobot_rs.AcrobotEnv()
        quantile_net = Attributes(quantile_net=modules, n_quantiles=quantiles)
        actor = Attributes(policy_net=modules[:-1])
        networks = {
            "ppo": {"mlp_extractor": actor, "action_net": modules[-1]},
            "dqn": {"q_net": Attributes(q_net=modules)},
            "qrdqn": {"quantile_net": quantile_net},
        }
        spaces = {"action_space": env.action_space, "observation_space": env.observation_space}
        self.policy = Attributes(**spaces, **networks[kind])
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


class Normalize:
    norm_obs, epsilon = True, 1e-8
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
    if normalize is None and quantiles == 1:
        linear = ((each.weight, each.bias) for each in modules[::2])
        layers = [(*each, name) for each, name in zip(linear, ("tanh", "relu", "none"))]
        policy.write(tmp_path / "own", layers)
        assert (tmp_path / "own").read_bytes() == (tmp_path / "p").read_bytes()
    # A model that answers otherwise is found.
    model.predict = lambda x, deterministic: ((Model.predict(model, x, True)[0] + 1) % 3, None)
    with pytest.raises(ValueError, match="they differ on .* of 2000 observations"):
        policy.save(model, tmp_path / "other")
    assert not (tmp_path / "other").exists()


def actor(env):
    return Model("ppo", [Linear(6, 4), Tanh(), Linear(4, 1)], env)


STRONG = acrobot_rs.AcrobotContinuousEnv(AVAIL_TORQUE=(-2.5, 0, 2.5))
SWINGUP = acrobot_rs.AcrobotSwingupEnv()


@pytest.mark.parametrize(
    ("env", "given", "limit", "factor"), [(STRONG, None, 2.5, 1.0), (SWINGUP, 3.0, 3.0, 3.0)]
)
def test_an_action_is_a_torque_or_in_a_swing_up_becomes_one(env, given, limit, factor, tmp_path):
    model = actor(env)
    policy.save(model, tmp_path / "p", given)
    first, _, last = model.modules
    last = factor * last.weight, factor * last.bias
    policy.write(tmp_path / "own", [(first.weight, first.bias, "tanh"), (*last, "none")], limit)
    assert (tmp_path / "own").read_bytes() == (tmp_path / "p").read_bytes()


def test_a_file_is_the_one_that_rust_plays(tmp_path):
    """The test of `crates/policy` plays it."""
    policy.write(tmp_path / "p", [([[3e38, 0, 3e38, 0, -3e38, 0]], [0], "none")], 2.0)
    assert (tmp_path / "p").read_bytes() == POLICY.with_name("torque.bin").read_bytes()


def test_a_file_is_loaded_played_and_written_again(tmp_path):
    """`actions.bin` has torch's actions on the observations of `record.py`, 3 for a tie."""
    loaded = policy.load(POLICY)
    assert [weights.shape for weights, *_ in loaded.layers] == [(64, 6), (64, 64), (3, 64)]
    policy.write(tmp_path / "again", *loaded)
    assert (tmp_path / "again").read_bytes() == POLICY.read_bytes()
    env = acrobot_rs.AcrobotVectorEnv(1, autoreset_mode="SameStep")
    env.single_action_space.seed(1)
    seen = [env.reset(seed=1)[0]]
    seen += [env.step([env.single_action_space.sample()])[0] for _ in range(9_999)]
    expected = np.frombuffer(POLICY.with_name("actions.bin").read_bytes(), np.uint8)
    expected = (expected[:, None] >> [0, 2, 4, 6] & 3).ravel()
    actions = loaded.act(seen)[:, 0]
    assert ((actions == expected) | (expected == 3)).all()
    loaded.layers[0][0][:] = 0.0  # the arrays can be trained
    torque = policy.load(POLICY.with_name("torque.bin"))  # of 3e38 (x0 + x2 - x4), N m
    observations = [[[1, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [1, 0, 1, 0, 0, 0]]]
    assert torque.act(observations).tolist() == [[2.0, 0.0, 0.0]], "infinity is no torque"


def test_a_loaded_policy_becomes_modules_of_torch(monkeypatch):
    kinds = {"Linear": Linear, "Tanh": Tanh, "ReLU": ReLU, "Sequential": lambda *modules: modules}
    nn = Attributes(**kinds, Parameter=lambda x: x.view(Tensor))
    monkeypatch.setitem(sys.modules, "torch", Attributes(nn=nn, as_tensor=np.asarray))
    layers = policy._layers(policy.load(POLICY).sequential())
    for found, expected in zip(layers, policy.load(POLICY).layers, strict=True):
        assert (found[0] == expected[0]).all() and (found[1] == expected[1]).all()
        assert found[2] == expected[2]


@pytest.mark.parametrize("damage", [lambda x: x[:9], lambda x: x[:-1] + b"?", lambda x: x[:16]])
def test_other_files_are_rejected(damage, tmp_path):
    (tmp_path / "p").write_bytes(damage(POLICY.read_bytes()))
    with pytest.raises(ValueError, match="p must be a file that .* write wrote, got .* other byte"):
        policy.load(tmp_path / "p")


def dqn(*modules):
    return Model("dqn", modules)


def overflowing():
    """1e30 times 1e30 is beyond float32, and infinity less infinity is no number."""
    model = dqn(Linear(6, 2), Linear(2, 3))
    model.modules[0].weight[:], model.modules[1].weight[:] = 1e30, [[1e30, -1e30]] * 3
    return model


def saving(model):
    return lambda path: policy.save(model, path)


def writing(outputs=3, weight=1.0, activation="none", limit=None):
    layer = np.full((outputs, 6), weight), np.ones(outputs), activation
    return lambda path: policy.write(path, [layer], limit)


@pytest.mark.parametrize(
    ("error", "message", "call"),
    [
        (TypeError, "a layer must be Linear, or .*, got Normalize", saving(dqn(Normalize()))),
        (TypeError, "a layer must be .*, got Tanh", saving(dqn(Tanh(), Linear(6, 3)))),
        (TypeError, "policy must be that of PPO, A2C, DQN or QR-DQN", saving(Attributes(policy=1))),
        (TypeError, "model must be .*, got 5", saving(5)),
        (ValueError, r"layer 0 must have .* shape \(outputs, 6\)", saving(dqn(Linear(4, 3)))),
        (ValueError, "3 outputs, or 1 with a torque_limit, got 2", saving(dqn(Linear(6, 2)))),
        (ValueError, "they differ on .* of 2000", saving(overflowing())),
        (ValueError, "torque_limit must be the torque of the .* action 1", saving(actor(SWINGUP))),
        (ValueError, "the activation of layer 0 must be one of", writing(activation="elu")),
        (ValueError, "the weights of layer 0 must be numbers, got ", writing(weight="1")),
        (ValueError, "numbers of layer 0 must be finite", writing(weight=1e300)),
        *((ValueError, "torque_limit must be finite and above 0 N m", writing(1, limit=limit))
          for limit in (np.nan, 1e39, 1e-50, -2.0)),
    ],
)  # fmt: skip
def test_invalid_arguments_are_rejected(error, message, call, tmp_path):
    with pytest.raises(error, match=message):
        call(tmp_path / "p")
    assert not list(tmp_path.iterdir())
