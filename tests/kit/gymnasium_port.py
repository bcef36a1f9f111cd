"""Answers the kit with Gymnasium's own Acrobot.

python gymnasium_port.py acrobot-kit.jsonl > answers.jsonl
python gymnasium_port.py acrobot-kit.jsonl swapped > answers.jsonl    # a fault that ports have had
"""

import json
import sys

import gymnasium
import numpy as np

NAMES = {
    "l1": "LINK_LENGTH_1",
    "l2": "LINK_LENGTH_2",
    "m1": "LINK_MASS_1",
    "m2": "LINK_MASS_2",
    "lc1": "LINK_COM_POS_1",
    "lc2": "LINK_COM_POS_2",
}
NAMES |= {
    "I1": "LINK_MOI",
    "dt": "dt",
    "max_vel_1": "MAX_VEL_1",
    "max_vel_2": "MAX_VEL_2",
    "torques": "AVAIL_TORQUE",
}

env = gymnasium.make("Acrobot-v1").unwrapped
if sys.argv[2:] == ["swapped"]:
    dsdt = env._dsdt
    env._dsdt = lambda state: [dsdt(state)[i] for i in (0, 1, 3, 2, 4)]
for line in open(sys.argv[1]):
    run = json.loads(line)
    for name, attribute in NAMES.items():
        setattr(env, attribute, run["params"][name])
    env.book_or_nips = run["equations"]
    answer = {"states": [], "rewards": [], "terminated": []}
    for state, action in zip(run["states"], run["actions"]):
        env.state = np.array([float.fromhex(x) for x in state])
        _, reward, terminated, _, _ = env.step(action)
        answer["states"].append(env.state.tolist())
        answer["rewards"].append(reward)
        answer["terminated"].append(bool(terminated))
    print(json.dumps(answer))
