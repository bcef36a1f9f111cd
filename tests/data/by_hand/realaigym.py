"""Steps of RealAIGym's double pendulum, by its own code: writes realaigym.txt to the folder above.

    git clone https://github.com/dfki-ric-underactuated-lab/double_pendulum
    python realaigym.py double_pendulum    # in this folder

Both machines of their leaderboards, with viscous friction and rotors, without Coulomb friction.
"""

import sys
from pathlib import Path

import numpy as np

clone = Path(sys.argv[1])
sys.path.insert(0, str(clone / "src/python"))
from double_pendulum.model.plant import DoublePendulumPlant

MACHINES = {
    "C.1": {
        "mass": [0.5234602302310271, 0.6255677234174437],
        "com": [0.2, 0.25569305436052964],
        "inertia": [0.031887199591513114, 0.05086984812807257],
        "motor_inertia": 6.287203962819607e-5,
    },
    "C.0": {
        "mass": [0.6416937799349799, 0.563935954099688],
        "com": [0.2, 0.3212669909674605],
        "inertia": [0.02671076499939512, 0.053878129629650884],
        "motor_inertia": 9.937281205437459e-5,
    },
}


def step(plant, x, torque, dt=0.002):
    """Their Runge-Kutta step, without noise."""
    rates = lambda x: plant.rhs(0.0, x, [0.0, torque])
    k1 = rates(x)
    k2 = rates(x + dt / 2 * k1)
    k3 = rates(x + dt / 2 * k2)
    k4 = rates(x + dt * k3)
    return x + dt / 6 * (k1 + 2 * (k2 + k3) + k4)


rng = np.random.default_rng(71)
lines = ["# RealAIGym's machines: masses, centres of mass, inertias about the joints, of a rotor"]
lines.append("# step: a state, the torque, and the state 0.002 s later")
for name, machine in MACHINES.items():
    numbers = np.concatenate([np.ravel(value) for value in machine.values()])
    lines.append(f"machine {name} {' '.join(map(repr, numbers.tolist()))}")
    plant = DoublePendulumPlant(
        **machine, length=[0.2, 0.3], damping=[0.001, 0.002], gravity=9.81, gear_ratio=6
    )
    for _ in range(20):
        state = rng.uniform(-1, 1, 4) * [np.pi, np.pi, 10, 20]
        torque = rng.uniform(-6, 6)
        numbers = [*state, torque, *step(plant, state, torque)]
        lines.append(f"step {' '.join(repr(float(x)) for x in numbers)}")
(Path(__file__).parents[1] / "realaigym.txt").write_text("\n".join(lines) + "\n")
