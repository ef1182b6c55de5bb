"""Lubrication as a matrix, and its noise as a root of it."""
import numpy as np

PI = np.pi


def resistances(pairs, viscosity, inner_gap):
    """Returns X_A, Y_A, Y_B11, Y_B21, Y_C11, Y_C12, Y_C22 (L 9-12, 15-18), with eta. They are taken at
    xi = 2 h / (a_i + a_j), or at the inner gap if that is larger. The factors q = r / (a_i + a_j) of Y_B and
    q^2 of Y_C leave rigid motion without resistance."""
    a_i, a_j = pairs.radius_i, pairs.radius_j
    b, c = a_j / a_i, a_i / a_j
    xi = np.maximum(2 * pairs.surface_distance / (a_i + a_j), inner_gap)
    log, q = np.log(1 / xi), pairs.distance / (a_i + a_j)
    drag, spin = 6 * PI * viscosity * a_i, 8 * PI * viscosity
    return (
        drag * (2 * b**2 / (1 + b) ** 3 / xi + b * (1 + 7 * b + b**2) / (5 * (1 + b) ** 3) * log),
        drag * 4 * b * (2 + b + 2 * b**2) / (15 * (1 + b) ** 3) * log,
        -4 * PI * viscosity * a_i**2 * b * (4 + b) / (5 * (1 + b) ** 2) * log * q,
        -4 * PI * viscosity * a_j**2 * c * (4 + c) / (5 * (1 + c) ** 2) * log * q,
        spin * a_i**3 * 2 * b / (5 * (1 + b)) * log * q**2,
        spin * a_i**3 * b**2 / (10 * (1 + b)) * log * q**2,
        spin * a_j**3 * 2 * c / (5 * (1 + c)) * log * q**2,
    )


def projectors(normal):
    """Returns N = nn, T = 1 - nn, and the matrix X of v -> v x n."""
    x, y, z = normal.T
    zero = np.zeros_like(x)
    turn = np.array([[zero, z, -y], [-z, zero, x], [y, -x, zero]]).transpose(2, 0, 1)
    square = normal[:, :, None] * normal[:, None, :]
    return square, np.eye(3) - square, turn


def blocks(rows):
    """Returns matrices of rows of 3 x 3 blocks for each pair."""
    return np.concatenate([np.concatenate(row, axis=2) for row in rows], axis=1)


def resistance_matrix(pairs, viscosity, inner_gap):
    """Returns R of (F_i, F_j, T_i, T_j) = -R (U_i, U_j, Omega_i, Omega_j), 12 x 12 each (L 8, 13, 14, 29)."""
    XA, YA, B1, B2, C11, C12, C22 = (v[:, None, None] for v in resistances(pairs, viscosity, inner_gap))
    N, T, X = projectors(pairs.normal)
    A = XA * N + YA * T
    return blocks(
        [
            [A, -A, -B1 * X, -B2 * X],
            [-A, A, B1 * X, B2 * X],
            [B1 * X, -B1 * X, C11 * T, C12 * T],
            [B2 * X, -B2 * X, C12 * T, C22 * T],
        ]
    )


def noise_matrix(pairs, viscosity, inner_gap):
    """Returns B of (F_i, F_j, T_i, T_j) = sqrt(2 kT / dt) B (theta, chi), 12 x 6 for each pair, B B' = R
    (L 22-28). The root in T_j has a minus, which B B' = R requires."""
    XA, YA, B1, B2, C11, _, C22 = (v[:, None, None] for v in resistances(pairs, viscosity, inner_gap))
    N, T, X = projectors(pairs.normal)
    A, zero = np.sqrt(XA) * N + np.sqrt(YA) * T, np.zeros_like(N)
    # The exact values are not negative: both are 6 pi eta a_i^3 b^3 L q^2 / ((1 + b) (2 + b + 2 b^2)).
    spin_i, spin_j = (np.sqrt(np.maximum(C - B**2 / YA, 0)) for C, B in ((C11, B1), (C22, B2)))
    pump_i, pump_j = B1 / np.sqrt(YA), B2 / np.sqrt(YA)
    return blocks([[A, zero], [-A, zero], [pump_i * X, spin_i * T], [pump_j * X, -spin_j * T]])


def parts_of(load):
    """Returns the force on i and both torques of a column of twelve; the force on j is opposite."""
    return load[:, 0:3], load[:, 6:9], load[:, 9:12]


def lubrication(pairs, viscosity, inner_gap):
    """Returns the loads of velocities in the laboratory frame (L 8, 13, 14)."""
    motion = np.concatenate((pairs.velocity_i, pairs.velocity_j, pairs.spin_i, pairs.spin_j), axis=1)
    return parts_of(-np.einsum("pab,pb->pa", resistance_matrix(pairs, viscosity, inner_gap), motion))


def lubrication_noise(pairs, viscosity, inner_gap, amplitude, theta, chi):
    """Returns the noise; `amplitude` is sqrt(2 kT / dt), theta and chi are normal vectors of the pair."""
    normals = np.concatenate((theta, chi), axis=1)
    return parts_of(amplitude * np.einsum("pab,pb->pa", noise_matrix(pairs, viscosity, inner_gap), normals))
