"""RealAIGym's resets of ICRA 2025, by its own code: prints resets.rs of the program `realaigym`.

git clone https://github.com/dfki-ric-underactuated-lab/double_pendulum
git -C double_pendulum checkout 9bb3a03
python realaigym_resets.py double_pendulum >../../../examples/desktop/src/bin/realaigym/resets.rs

That commit is the board's: later ones draw more states before the times. With NumPy 2.4.6, whose
np.random is a Mersenne Twister.
"""

import sys

import numpy as np

sys.path.insert(0, sys.argv[1] + "/src/python")
from double_pendulum.controller import global_policy_testing_controller as testing
from double_pendulum.model.model_parameters import model_parameters

RESETS = 15

print("//! RealAIGym's resets. `tests/data/by_hand/realaigym_resets.py` prints this file.")
print("\n/// A time, s, and both angles, rad.\npub type Reset = [f64; 3];")
print("\n/// NumPy's seeds, and the resets that `np.random` draws after each.")
print(f"pub const OF_NUMPYS_SEEDS: [(u64, [Reset; {RESETS}]); 2] = [")
# That of the board's rules; that of a comment in the code, and of MC-PILCO's run on the board.
for seed in (777, 333):
    np.random.seed(seed)
    tester = testing.GlobalPolicyTestingControllerV2(
        None, n_disturbances=RESETS, t_max=60.0, mpar=model_parameters(torque_limit=[6.0, 6.0])
    )
    print(f"    (\n        {seed},\n        [")
    for time, (theta1, theta2, *_) in zip(tester.reset_times[:RESETS], tester.random_states):
        print(f"            [{time}, {theta1}, {theta2}],")
    print("        ],\n    ),")
print("];")
