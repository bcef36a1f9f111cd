"""Costs by RealAIGym's own code: of the test in realaigym/score.rs, and of trajectories.

git clone https://github.com/dfki-ric-underactuated-lab/double_pendulum
python realaigym_scores.py double_pendulum V1.csv V2.csv V3_200.csv
"""

import sys

import numpy as np

sys.path.insert(0, sys.argv[1] + "/src/python")
from double_pendulum.analysis import leaderboard
from double_pendulum.model.model_parameters import model_parameters
from double_pendulum.utils.csv_trajectory import load_trajectory_full

i = np.arange(41)
angles = [np.where(i < 24, i * 7 % 13 / 4, 3.125), (i * 5 % 7 - 3) / 16]
X = np.array([*angles, i * 11 % 9 - 4.0, i * 3 % 8 - 3.5]).T
U = np.array([i % 3 / 8, (i * 5 % 11 - 5) / 4]).T
data = {"test": {"T": i / 4, "X_meas": X, "U_con": U}}
data |= {name: load_trajectory_full(name) for name in sys.argv[2:]}
line = {"mpar": model_parameters(length=[0.2, 0.3]), "height": 0.9}
for name, trajectory in data.items():
    T, X, U = (trajectory[key] for key in ["T", "X_meas", "U_con"])
    print(
        name,
        leaderboard.get_swingup_time(T=T, X=X, **line),
        leaderboard.get_energy(X, U),
        leaderboard.get_max_tau(U),
        leaderboard.get_integrated_torque(T, U),
        leaderboard.get_torque_cost(T, U),
        leaderboard.get_tau_smoothness(U),
        leaderboard.get_velocity_cost(T, X),
        leaderboard.get_uptime(T, X, **line),
    )
