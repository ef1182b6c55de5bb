#!/usr/bin/python3
"""peclet export campaign.json | check.py

Compares the ensemble with the theory of Hookean dumbbells: viscosity over n kT lambda, and first normal stress
difference over 2 n kT (lambda rate)^2. Both are 1 at every rate; also compares with their values for the finite step of
dumbbells.in. Errors are standard errors.
"""
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from studies.tables import markdown_head, markdown_row

import numpy as np
from scipy.linalg import solve_discrete_lyapunov

# Parameters of dumbbells.in: friction zeta = 4 (kT = H = lambda = 1), mass of a bead, step.
FRICTION, MASS, STEP = 4.0, 0.5, 0.005
HEAD = [
    "rate λ",
    "seeds",
    "viscosity",
    "from theory with the step, errors",
    "normal stress",
    "from theory with the step, errors",
]


def unit_with(entries):
    matrix = np.eye(6)
    for place, value in entries.items():
        matrix[place] = value
    return matrix


def with_step(rate):
    """Returns both ratios for the step of LAMMPS: velocity Verlet with the friction of half-step velocities, then the
    displacement by the flow.

    The state is connector x, y, relative velocity x, y, relative force x, y. Its stationary covariance C obeys
    C = A C A' + Q.
    """
    kick = unit_with({(2, 4): STEP / 2 / MASS, (3, 5): STEP / 2 / MASS})
    drift = unit_with({(0, 2): STEP, (1, 3): STEP})
    force = unit_with({(4, 4): 0, (5, 5): 0, (4, 0): -2, (5, 1): -2, (4, 2): -FRICTION, (5, 3): -FRICTION})
    flow = unit_with({(0, 1): rate * STEP})
    noise = np.diag([0, 0, 0, 0, 1, 1]) * 4 * FRICTION / STEP
    # State at thermo output: after the second kick, with the force before the displacement by the flow.
    covariance = solve_discrete_lyapunov(kick @ force @ drift @ kick @ flow, kick @ noise @ kick.T)
    stress = covariance[:2, :2] - MASS / 2 * covariance[2:4, 2:4]
    return stress[0, 1] / rate, (stress[0, 0] - stress[1, 1]) / 2 / rate**2


def cells_of(estimate, expected):
    error = estimate["standard_error"]
    return f"{estimate['mean']:.3f} ± {error:.3f}", f"{(estimate['mean'] - expected) / error:+.1f}"


def main():
    print(markdown_head(HEAD))
    for point in json.load(sys.stdin)["points"]:
        rate = point["scene"]["variables"]["weissenberg"]
        viscosity, normal = with_step(rate)
        quantities = point["quantities"]
        cells = [f"{rate:g}", point["stop_test"]["seeds"], *cells_of(quantities["viscosity"], viscosity)]
        print(markdown_row([*cells, *cells_of(quantities["first_normal_difference"], normal)]))
    print(f"\nWith the step: viscosity {viscosity:.4f}, normal stress {normal:.4f}")


if __name__ == "__main__":
    main()
