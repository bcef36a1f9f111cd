"""Results and rejected calls are those of all packages: the recordings in `tests/data`."""

import functools
import inspect
import json
import re
from pathlib import Path

import acrobot_rs
import numpy as np
import pytest
from acrobot_rs import AcrobotBalanceVectorEnv, AcrobotContinuousVectorEnv, AcrobotEnv
from acrobot_rs import AcrobotSwingupEnv, AcrobotSwingupVectorEnv, AcrobotVectorEnv
from acrobot_rs import LogUniform, Normal, Uniform, control
from gymnasium.error import InvalidAction
from vectors import rejects

DATA = Path(__file__).parents[3] / "tests/data"
ROWS, RESULTS = (
    [json.loads(line) for line in (DATA / name).read_text().splitlines()]
    for name in ("rejections.jsonl", "results.jsonl")
)
#: The crate's names of the numbers without indices, and Python's.
CRATES = [name.split("[")[0] for row in ROWS if row["call"] == "params" for name in row["set"]]
PYTHONS = [name for name in AcrobotEnv._NAMES if name not in ("LINK_MOI", "book_or_nips")]
NAMES = dict(zip(dict.fromkeys(CRATES), PYTHONS, strict=True))
COLUMNS = [name for name in PYTHONS for _ in range(3 if name == "AVAIL_TORQUE" else 1)]
#: Python has no single acrobots in float32.
RESULTS = [row for row in RESULTS if row.get("arithmetic") != "fast"]
RESULTS = [row for row in RESULTS if row["call"] != "episode"]


class MyNormal(Normal):
    """A subclass draws as its base."""


def flat(*results):
    return np.concatenate([np.ravel(each) for each in results])


def draws_of(row, names):
    draws = {}
    for name, (kind, low, high, mean, std) in zip(names, np.reshape(row["draws"], (-1, 5))):
        if kind:
            others = {"mean": mean, "std": std} if kind == 3 else {}
            draws[name] = (Uniform, LogUniform, MyNormal)[int(kind) - 1](
                low=low, high=high, **others
            )
    return draws


def seed_of(row):
    return sum(word << 32 * i for i, word in enumerate(row["seed"]))


def batch(row, env):
    """Torques that are not clipped. In a swing-up the action 1 is 2 N m."""
    draws = draws_of(row, COLUMNS)
    kind = (AcrobotContinuousVectorEnv, AcrobotSwingupVectorEnv, AcrobotBalanceVectorEnv)[
        row["task"]
    ]
    envs = kind(row["count"], row["max_steps"], autoreset_mode="SameStep", **draws)
    torques = envs.AVAIL_TORQUE
    if row["task"] == 0:
        envs.AVAIL_TORQUE = [-2.0, 0.0, 2.0]
    envs.reset(seed=seed_of(row))
    scale = 2 if row["task"] == 1 else 1
    actions = np.float32(row["torques"]).reshape(-1, row["count"], 1) / scale
    results = [flat(*envs.step(action)[1::-1]) for action in actions]
    envs.AVAIL_TORQUE = torques
    snapshot = bytes(row["snapshot"][:-4])  # without its checksum
    assert snapshot in envs._native.__getstate__()
    return flat(*results)


def instruments(row, env):
    names = AcrobotEnv._INSTRUMENTS
    drawn = draws_of(row, names)
    envs = AcrobotBalanceVectorEnv(row["count"], **drawn, encoder_zero_2=row["zeros"])
    envs.reset(seed=seed_of(row))
    actions = np.float32(row["torques"]).reshape(-1, row["count"], 1)
    results = [flat(*envs.step(action)[1::-1]) for action in actions]
    assert bytes(row["snapshot"][:-4]) in envs._native.__getstate__()
    numbers = [envs.get_parameter(name) for name in names]
    return flat(*results, np.transpose(numbers))


def model(row, env):
    function, values = getattr(control, row["call"]), row | {"env": env, "params": None}
    if "w" in row:
        A, _ = control.linearize_step(row["state"], row["torque"], env)
        return flat(*function(A, np.reshape(row["w"], (4, 4)), row["s"]))
    if "q" in row:
        Q = np.reshape(row["q"], (4, 4))
        linearize = control.linearize if row["call"] == "lqr" else control.linearize_step
        model = linearize(row["state"], row["torque"], env)
        count = [3] if row["call"] == "tvlqr" else []
        A, B = (np.broadcast_to(each, (*count, *each.shape)) for each in model)
        values |= {"A": A, "B": B, "Q": Q, "Qf": Q, "R": row["r"]}
    results = function(**{name: values[name] for name in inspect.signature(function).parameters})
    return flat(*results) if isinstance(results, tuple) else flat(results)


def plan(row, env):
    planner = control.Planner(row["limit"], env, elbow=row["elbow"])
    others = {"steps": row["steps"], "tries": row["tries"], "seed": row["seed"][0]}
    first = planner.plan([0.0] * 4, **others)
    improved, cost = planner.improve(row["start"], first, row["iterations"])
    upright = np.float32(control.UPRIGHT)
    at = (0, row["start"]), (2, upright), (row["steps"], upright)
    return flat(first._rows(), cost, improved._rows(), [improved.torque(*each) for each in at])


def swing_up(row, env):
    swing_up = control.SwingUp(row["limit"], env)
    return [swing_up.torque(state) for state in np.reshape(row["states"], (-1, 4))]


def estimate(row, env):
    names = {"LINK_MASS_2": "mass2", "COULOMB_2": "coulomb2"}
    names |= {"ZERO_1": "zero1", "TORQUE_FACTOR": "torque_factor"}
    std = {name: row[f"{rust}_std"] for name, rust in names.items()}
    noise = {name: row[name] for name in ("angle_std", "torque_std")}
    estimator = control.Estimator(env, **noise, parameter_std=std)
    for angles, torque in zip(np.reshape(row["angles"], (-1, 2)), row["torques"]):
        estimator.correct(angles)
        estimator.predict(torque)
    del row["result"][:4], row["result"][-12:-9]  # the state, and the torques
    instruments = [*estimator.zeros, estimator.torque_factor]
    return flat(estimator.state_std, [*estimator.params.values()], instruments)


def identify(row, env):
    angles, torques = np.reshape(row["angles"], (-1, 2)), row["torques"]
    first = row["first"]
    calibrated = control.calibrate(angles, torques, env)
    angles, torques = ([each[:first], each[first:]] for each in (angles, torques))
    found = control.identify(angles, torques, env)
    row["result"] = row["calibrated"] + row["identified"]
    numbers = [*calibrated.zeros, calibrated.delay, calibrated.prediction_error]
    numbers.append(calibrated.angle_noise)
    parts = [
        each
        for fit in (calibrated.fit, found)
        for each in (fit.values, fit.std_errors, fit.weakest)
    ]
    return flat(numbers, *([*part.values()] for part in [*parts, found.params]))


def mpc(row, env):
    settings = {name: row[name] for name in ("limit", "delay", "plan_timeout")}
    settings["counts"] = row["per_turn"]
    controller = control.Controller(env, **settings)
    replanner = control.Replanner(env, **settings)
    torques = []
    for tick, counts in enumerate(np.reshape(row["counts"], (-1, 2))):
        torques.append(controller.tick(counts))
        if tick % row["every"] == 0:
            replanner.exchange(controller)
            replanner.work()
    return flat(torques, *controller.report)


REPLAYS = (batch, instruments, plan, swing_up, estimate, identify)
REPLAYS = {each.__name__: each for each in REPLAYS}
REPLAYS["control"] = mpc


@pytest.mark.parametrize("row", RESULTS, ids=lambda row: row["call"])
def test_results_are_those_of_rust(row):
    params = dict(zip(COLUMNS, row.get("params", ())))
    env = AcrobotEnv(**params | {"AVAIL_TORQUE": (-1.0, 0.0, 1.0)})
    results = REPLAYS.get(row["call"], model)(row, env)
    if row["call"] == "identify":
        del row["result"][-9:-6]  # the torques
    assert np.array_equal(results, row["result"])


STATE = ["theta1", "theta2", "dtheta1", "dtheta2"]
MANY = functools.partial(AcrobotVectorEnv, 3)
MAKERS = (
    *(AcrobotEnv, AcrobotSwingupEnv, MANY, functools.partial(AcrobotSwingupVectorEnv, 3)),
    functools.partial(MANY, gymnasium_episodes=True),
)


def named(name):
    """Python's name of a number, and its index."""
    name, *index = name.split("[")
    return NAMES[name], "".join(f"[{each}" for each in index)


@pytest.mark.parametrize("make", MAKERS)
def test_rejected_calls_change_nothing_and_have_the_messages_of_all_packages(make):
    """A vector environment adds the index of an environment or an action."""
    is_many, tried = hasattr(make(), "num_envs"), set()

    def check(call, message, error=ValueError):
        with rejects(env, error, f"^{re.escape(message)}$"):
            call()

    def reset(**options):
        env.reset(seed=[2, 2, 2] if is_many else 2, options=options)

    for row, is_own in [(row, is_own) for row in ROWS for is_own in (False, True)[: 1 + is_many]]:
        env, name, rest = make(), *row["message"].split(" ", 1)
        env.reset(seed=1)
        match row["call"]:
            case "params":
                for crates, number in row["set"].items():
                    known, index = named(crates)
                    old, new = env.parameters.get(known, 1.0), float(number)
                    if index:
                        new = [new if f"[{i}]" == index else old[i] for i in range(3)]
                    change = known, [old, new, old] if is_own else new
                    if crates != [*row["set"]][-1]:  # valid without the last
                        setattr(env, *change)
                known, index = named(name)
                name = f"{known}{'[1]' * is_own}{index}"
                check(lambda: setattr(env, *change), f"{name} {rest}")
            case "draw" if is_many:
                [(kind, numbers)] = row["set"]["mass2"].items()
                draw = getattr(acrobot_rs, kind)(*map(float, numbers))
                check(lambda: setattr(env, "LINK_MASS_2", draw), f"LINK_MASS_2 {rest}")
            case "state":
                state = [float(row["set"].get(each, 0.0)) for each in STATE]
                if is_many:
                    state, name = [[0.0] * 4, state, state], f"state[1, {STATE.index(name)}]"
                    check(lambda: reset(state=state), f"{name} {rest}")
                check(lambda: setattr(env, "state", state), f"{name} {rest}")
            case "bounds":
                bounds = {each: float(number) for each, number in row["set"].items()}
                check(lambda: reset(**bounds), f"{name} {rest}")
            case "action" if is_many and not env._CONTINUOUS:
                actions = [0, row["value"], 0]
                check(lambda: env.step(actions), f"actions[1] {rest}", InvalidAction)
            case _:
                # A single environment has as many actions as torques, and no draws. An infinite
                # torque acts as the bound.
                continue
        tried.add(row["call"])
    assert tried >= {"params", "state", "bounds"} and ("draw" in tried) == is_many
