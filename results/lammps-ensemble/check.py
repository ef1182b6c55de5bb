#!/usr/bin/python3
"""peclet export campaign.json | check.py

Compares the ensemble with the theory of Hookean dumbbells: viscosity and first normal stress difference over n kT lambda and
2 n kT (lambda rate)^2, which are 1 at every rate, and what they are with the finite step of dumbbells.in. Errors: standard ones.
"""
import json
import sys

# dumbbells.in: kT = H = lambda = 1, so zeta = 4; mass of a bead; step.
FRICTION, MASS, STEP = 4.0, 0.5, 0.005


def times(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def transposed(a):
    return [list(column) for column in zip(*a)]


def unit_with(entries):
    matrix = [[float(i == j) for j in range(6)] for i in range(6)]
    for (i, j), value in entries.items():
        matrix[i][j] = value
    return matrix


def with_step(rate):
    """Both ratios for the step of LAMMPS: velocity Verlet with the friction of half-step velocities, then the flow moves the beads.

    State: connector x, y, relative velocity x, y, relative force x, y. Its stationary covariance C = A C A' + Q is summed by doubling.
    """
    kick = unit_with({(2, 4): STEP / 2 / MASS, (3, 5): STEP / 2 / MASS})
    drift = unit_with({(0, 2): STEP, (1, 3): STEP})
    force = unit_with({(4, 4): 0, (5, 5): 0, (4, 0): -2, (5, 1): -2, (4, 2): -FRICTION, (5, 3): -FRICTION})
    flow = unit_with({(0, 1): rate * STEP})
    noise = [[4 * FRICTION / STEP * (i == j and i >= 4) for j in range(6)] for i in range(6)]
    after_noise = times(kick, times(noise, transposed(kick)))
    # As thermo output sees it: after the second kick, with the force from before the flow's displacement.
    turn = times(kick, times(force, times(drift, times(kick, flow))))
    covariance = after_noise
    for _ in range(20):
        added = times(turn, times(covariance, transposed(turn)))
        covariance = [[a + b for a, b in zip(*rows)] for rows in zip(covariance, added)]
        turn = times(turn, turn)
    stress = [[covariance[i][j] - MASS / 2 * covariance[i + 2][j + 2] for j in (0, 1)] for i in (0, 1)]
    return stress[0][1] / rate, (stress[0][0] - stress[1][1]) / 2 / rate**2


def cell(estimate, expected):
    error = estimate["standard_error"]
    return f"{estimate['mean']:.3f} ± {error:.3f} | {(estimate['mean'] - expected) / error:+.1f}"


def main():
    print(
        "| rate λ | seeds | viscosity | from theory with the step, errors | normal stress | from theory with the step, errors |"
    )
    print("|---|---|---|---|---|---|")
    for point in json.load(sys.stdin)["points"]:
        rate = point["scene"]["variables"]["weissenberg"]
        viscosity, normal = with_step(rate)
        estimates = point["estimates"]
        print(
            f"| {rate:g} | {point['look']['seeds']} | {cell(estimates['/viscosity'], viscosity)} | "
            f"{cell(estimates['/first_normal_difference'], normal)} |"
        )
    print(f"\nWith the step: viscosity {viscosity:.4f}, normal stress {normal:.4f}")


if __name__ == "__main__":
    main()
