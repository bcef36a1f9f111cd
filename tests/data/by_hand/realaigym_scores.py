"""Costs by RealAIGym's own code: of the test in realaigym/score.rs, and of trajectories.

    git clone https://github.com/dfki-ric-underactuated-lab/double_pendulum
    cargo run --release -p desktop --bin realaigym -- --out .
    python realaigym_scores.py double_pendulum V1.csv V2.csv icra2025_100.csv

Also prints how much the trajectories' steps differ from theirs.
"""

import sys
from pathlib import Path

import numpy as np

clone = Path(sys.argv[1])
sys.path.insert(0, str(clone / "src/python"))
from double_pendulum.analysis import leaderboard
from double_pendulum.model.model_parameters import model_parameters
from double_pendulum.model.plant import DoublePendulumPlant
from double_pendulum.utils.csv_trajectory import load_trajectory_full

i = np.arange(41)
angles = [np.where(i < 24, i * 7 % 13 / 4, 3.125), (i * 5 % 7 - 3) / 16]
X = np.array([*angles, i * 11 % 9 - 4.0, i * 3 % 8 - 3.5]).T
U = np.array([i % 3 / 8, (i * 5 % 11 - 5) / 4]).T
data = {"": {"T": i / 4, "X_meas": X, "U_con": U}}
data |= {name: load_trajectory_full(name) for name in sys.argv[2:]}
for name, trajectory in data.items():
    T, X, U = (trajectory[key] for key in ["T", "X_meas", "U_con"])
    design = "design_C.0/model_3.0" if "V1" in name else "design_C.1/model_1.1"
    folder = clone / "data/system_identification/identified_parameters" / design
    mpar = model_parameters(filepath=str(folder / "model_parameters.yml"))
    mpar.set_motor_inertia(0.0)
    mpar.set_damping([0.0, 0.0])
    mpar.set_cfric([0.0, 0.0])
    line = {"mpar": mpar, "method": "height", "height": 0.9}
    print(name, leaderboard.get_swingup_time(T=T, X=X, **line))
    print(leaderboard.get_energy(X, U), leaderboard.get_max_tau(U))
    print(leaderboard.get_integrated_torque(T, U), leaderboard.get_torque_cost(T, U))
    print(leaderboard.get_tau_smoothness(U), leaderboard.get_velocity_cost(T, X))
    print("uptime", leaderboard.get_uptime(T, X, **line))
    if name:
        plant = DoublePendulumPlant(model_pars=mpar)
        k = np.zeros((len(X), 4))
        after = X.copy()
        for ahead, weight in [(0, 6), (0.5, 3), (0.5, 3), (1, 6)]:
            k = np.array([plant.rhs(0, x, u) for x, u in zip(X + 0.002 * ahead * k, U)])
            after += 0.002 / weight * k
        print("steps differ by", np.abs(after[:-1] - X[1:]).max())
