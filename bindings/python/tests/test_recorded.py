"""Draws and rejected calls are those of all packages: the recordings in `tests/data`."""

import json
import pickle
import re
from pathlib import Path

import acrobot_rs
import numpy as np
import pytest
from acrobot_rs import AcrobotVectorEnv, LogUniform, Normal, Uniform
from gymnasium.error import InvalidAction
from vectors import KINDS, SINGLE_KINDS, rejects

DATA = Path(__file__).parents[3] / "tests/data"


@pytest.mark.parametrize("children", [False, True])
def test_draws_are_those_of_numpy(children):
    """With a seed for each environment, and with the children of 42."""
    rows = [line.split(",") for line in (DATA / "draws.csv").read_text().splitlines()[1:]]
    rows = [row for row in rows if (row[1] != "") == children]
    draws = {
        "LINK_MASS_2": Uniform(0.8, 1.2),
        "LINK_MOI": LogUniform(0.5, 2.0),
        "gravity": Normal(9.8, 0.1, low=9.5, high=10.1),
    }
    envs = AcrobotVectorEnv(len(rows), 2, autoreset_mode="SameStep", **draws)

    def drawn(envs):
        """LINK_MOI of both links."""
        columns = [np.empty((len(rows), 2 if name == "LINK_MOI" else 1)) for name in draws]
        for name, column in zip(draws, columns, strict=True):
            envs._native.get(name, column)
        return np.hstack([*columns, envs.state]).astype(np.float32)

    envs.reset(seed=42 if children else [int(row[0]) for row in rows])
    first = drawn(envs)
    np.testing.assert_array_equal(first, np.array([row[2:] for row in rows], np.float32))
    twin = pickle.loads(pickle.dumps(envs))
    for each in (envs, twin) * 2:  # the second step resets
        each.step([0] * len(rows))
    assert (drawn(envs) == drawn(twin)).all() and (drawn(envs) != first).all()


#: Python's names of the crate's numbers.
NAMES = {
    **{f"length{link}": f"LINK_LENGTH_{link}" for link in (1, 2)},
    **{f"mass{link}": f"LINK_MASS_{link}" for link in (1, 2)},
    **{f"center_of_mass{link}": f"LINK_COM_POS_{link}" for link in (1, 2)},
    **{f"inertia{link}": f"LINK_MOI_{link}" for link in (1, 2)},
    **{f"max_velocity{link}": f"MAX_VEL_{link}" for link in (1, 2)},
    **{f"friction.joint{link}": f"FRICTION_{link}" for link in (1, 2)},
    **{name: name for name in ("gravity", "dt")},
    **{"torques": "AVAIL_TORQUE", "torque_noise": "torque_noise_max"},
}
STATE = ["theta1", "theta2", "dtheta1", "dtheta2"]
#: Also what computes in other numbers than the recording.
MAKERS = {
    **{kind.__name__: kind for kind in SINGLE_KINDS},
    **{kind.__name__: lambda kind=kind: kind(3) for kind in KINDS if kind not in SINGLE_KINDS},
    "gymnasium_episodes": lambda: AcrobotVectorEnv(3, gymnasium_episodes=True),
    "float64": lambda: acrobot_rs.AcrobotSwingupVectorEnv(3, float64=True),
}


def named(env, text):
    """Python's name of a number with which a text begins, its index, and the rest of the text."""
    name, index, rest = re.fullmatch(r"([\w.]+)((?:\[\d\])?)(.*)", text).groups()
    name = NAMES[name]
    return name if name in env._NAMES else name[:-2], index, rest  # one LINK_MOI for both links


def parameters(env, row, is_own):
    """The values of a row, in all environments or in one, and its message."""
    values = {}
    for text, number in row["set"].items():
        name, index, _ = named(env, text)
        old, new = getattr(env, name), float(number)
        if index:
            new = [new if f"[{i}]" == index else torque for i, torque in enumerate(old)]
        values[name] = [old, new, old] if is_own else new
    name, index, rest = named(env, row["message"])
    return values, name + "[1]" * is_own + index + rest


@pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS)
def test_rejected_calls_change_nothing_and_have_the_messages_of_all_packages(make):
    """A vector environment adds the index of an environment or an action."""
    tried = set()

    def check(env, attribute, value, message):
        with rejects(env, ValueError, f"^{re.escape(message)}$"):
            setattr(env, attribute, value)

    for row in map(json.loads, (DATA / "rejections.jsonl").read_text().splitlines()):
        env, given, message = make(), row.get("set"), row["message"]
        rest = message[message.index(" ") :]
        is_many = hasattr(env, "num_envs")
        env.reset(seed=1)
        match row["call"]:
            case "params" if "FRICTION_1" in env._NAMES or "friction" not in message:
                for is_own in (False, True)[: 1 + is_many]:
                    values, message = parameters(env, row, is_own)
                    for names in list(values), list(values)[::-1]:
                        env, last = make(), names.pop()
                        for name in names:  # which is valid without the last
                            setattr(env, name, values[name])
                        check(env, last, values[last], message)
            case "draw" if is_many:
                [(kind, numbers)] = given["mass2"].items()
                draw = getattr(acrobot_rs, kind)(*map(float, numbers))
                check(env, "LINK_MASS_2", draw, f"LINK_MASS_2{rest}")
            case "state":
                [(name, number)] = given.items()
                state, index = [0.0] * 4, STATE.index(name)
                state[index] = float(number)
                if is_many:
                    state, message = [[0.0] * 4, state, state], f"state[1, {index}]{rest}"
                    with rejects(env, ValueError, f"^{re.escape(message)}$"):
                        env.reset(seed=[2, 2, 2], options={"state": state})
                check(env, "state", state, message)
            case "bounds":
                options = {name: float(number) for name, number in given.items()}
                with rejects(env, ValueError, f"^{re.escape(message)}$"):
                    env.reset(seed=[2, 2, 2] if is_many else 2, options=options)
            case "action" if is_many and not env._CONTINUOUS:
                with rejects(env, InvalidAction, rf"^actions\[1\]{re.escape(rest)}$"):
                    env.step([0, row["value"], 0])
            case _:
                # A single environment has as many actions as torques, and no draws. An infinite
                # torque acts as the bound.
                continue
        tried.add(row["call"])
    assert tried >= {"params", "state", "bounds"} and ("draw" in tried) == is_many
