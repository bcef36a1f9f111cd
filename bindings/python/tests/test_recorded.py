"""Draws and rejected calls are those of all packages: the recordings in `tests/data`."""

import functools
import json
import pickle
import re
from pathlib import Path

import acrobot_rs
import numpy as np
import pytest
from acrobot_rs import AcrobotEnv, AcrobotSwingupEnv, AcrobotSwingupVectorEnv, AcrobotVectorEnv
from gymnasium.error import InvalidAction
from vectors import rejects


class Mine(acrobot_rs.Normal):
    """A subclass draws as its base."""


DATA = Path(__file__).parents[3] / "tests/data"


@pytest.mark.parametrize("children", [False, True])
def test_draws_are_those_of_numpy(children):
    """With a seed for each environment, and with the children of 42."""
    rows = [line.split(",") for line in (DATA / "draws.csv").read_text().splitlines()[1:]]
    rows = [row for row in rows if (row[1] != "") == children]
    envs = AcrobotVectorEnv(
        *(len(rows), 2, None, "SameStep"),
        LINK_MASS_2=acrobot_rs.Uniform(0.8, 1.2),
        LINK_MOI_1=acrobot_rs.LogUniform(0.5, 2.0),
        gravity=Mine(9.8, 0.1, low=9.5, high=10.1),
    )

    def drawn(envs):
        names = "LINK_MASS_2", "LINK_MOI_1", "gravity"
        columns = [envs.get_parameter(name) for name in names]
        return np.column_stack([*columns, envs.state]).astype(np.float32)

    envs.reset(seed=42 if children else [int(row[0]) for row in rows])
    first = drawn(envs)
    np.testing.assert_array_equal(first, np.array([row[2:] for row in rows], np.float32))
    twin = pickle.loads(pickle.dumps(envs))
    for each in (envs, twin) * 2:  # the second step resets
        each.step([0] * len(rows))
    assert (drawn(envs) == drawn(twin)).all() and (drawn(envs) != first).all()


ROWS = [json.loads(line) for line in (DATA / "rejections.jsonl").read_text().splitlines()]
#: The crate's names of the numbers without indices, and Python's.
CRATES = [name.split("[")[0] for row in ROWS if row["call"] == "params" for name in row["set"]]
PYTHONS = [name for name in AcrobotEnv._NAMES if name not in ("LINK_MOI", "book_or_nips")]
NAMES = dict(zip(dict.fromkeys(CRATES), PYTHONS, strict=True))
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
                changes = []
                for crates, number in row["set"].items():
                    known, index = named(crates)
                    old, new = env.parameters.get(known, 1.0), float(number)
                    if index:
                        new = [new if f"[{i}]" == index else old[i] for i in range(3)]
                    changes.append((known, [old, new, old] if is_own else new))
                for change in changes[:-1]:  # valid without the last
                    setattr(env, *change)
                known, index = named(name)
                name = f"{known}{'[1]' * is_own}{index}"
                check(lambda: setattr(env, *changes[-1]), f"{name} {rest}")
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
