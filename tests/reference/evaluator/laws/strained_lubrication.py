"""Lubrication in any flow, by velocities relative to it and its strain rates (M 3 and A.1 to A.7)."""
import numpy as np

from evaluator.geometry import across, along, column
from evaluator.laws.flow import strain_rate

PI = np.pi


def mari_coefficients(a_i, a_j):
    """Returns g of X_A, Y_A, Y_B, Y_C, X_G, Y_G, Y_H for ii, ij, ji, jj, with X = 6 pi eta g / d and
    Y = 6 pi eta g ln(1/d). b is the size ratio; those of j follow by exchanging the spheres, b to 1/b."""
    b, c, s = a_j / a_i, a_i / a_j, a_i + a_j

    def own(power, shape):
        return a_i**power * shape(b)

    def other(power, shape):
        return a_j**power * shape(c)

    def x_g(b):
        return 2 * b**2 / (1 + b) ** 3

    def y_a(b):
        return 4 / 15 * b * (2 + b + 2 * b**2) / (1 + b) ** 3

    def y_b(b):
        return -2 / 15 * b * (4 + b) / (1 + b) ** 2

    def y_c(b):
        return 8 / 15 * b / (1 + b)

    def y_g(b):
        return 1 / 15 * b * (4 - b + 7 * b**2) / (1 + b) ** 3

    def y_h(b):
        return 2 / 15 * b * (2 - b) / (1 + b) ** 2

    def mixed(b):
        return s**3 / 15 * b**2 * (1 + 7 * b) / (1 + b) ** 5

    force_x, force_y, cross = own(1, x_g), own(1, y_a), 2 * s**3 / 15 * b**2 / (1 + b) ** 4
    return {
        "XA": (force_x, -force_x, -force_x, force_x),
        "YA": (force_y, -force_y, -force_y, force_y),
        "YB": (own(2, y_b), -own(2, y_b), other(2, y_b), -other(2, y_b)),
        "YC": (own(3, y_c), cross, cross, other(3, y_c)),
        "XG": (own(2, x_g), -own(2, x_g), other(2, x_g), -other(2, x_g)),
        "YG": (own(2, y_g), -own(2, y_g), other(2, y_g), -other(2, y_g)),
        "YH": (own(3, y_h), mixed(b), mixed(c), other(3, y_h)),
    }


def mari_lubrication(pairs, viscosity, regularisation, flow):
    """Returns F_i, T_i and T_j. With u and w relative to the flow and P = n.E.n, Q = 2 E.n - 2 (n.E.n) n,
    H = 2 n x (E.n):

    F_i = -A_ii u_i - A_ij u_j - n x (YB_ii w_i + YB_ji w_j)
          + (XG_ii P_i + XG_ji P_j) n + YG_ii Q_i + YG_ji Q_j
    T_i = n x (YB_ii u_i + YB_ij u_j) - (1 - nn).(YC_ii w_i + YC_ij w_j) + YH_ii H_i + YH_ji H_j

    T_j has i and j exchanged in the indices. d = max(xi, 0) + regularisation. The print has 2 H."""
    n = pairs.normal
    d = np.maximum(2 * pairs.surface_distance / (pairs.radius_i + pairs.radius_j), 0) + regularisation
    size = {"X": 6 * PI * viscosity / d, "Y": 6 * PI * viscosity * np.log(1 / d)}
    g = {
        name: [column(size[name[0]] * value) for value in values]
        for name, values in mari_coefficients(pairs.radius_i, pairs.radius_j).items()
    }
    ends = ((pairs.height_i, pairs.velocity_i, pairs.spin_i), (pairs.height_j, pairs.velocity_j, pairs.spin_j))
    u = [velocity - flow.velocity(height) for height, velocity, _ in ends]
    w = [spin - flow.spin(height) for height, _, spin in ends]
    strained = [np.einsum("pab,pb->pa", strain_rate(flow.gradient(height)), n) for height, *_ in ends]

    def both(name, vectors, places):
        return sum(g[name][place] * vector for place, vector in zip(places, vectors))

    squeezed = both("XA", [along(n, v) for v in u], (0, 1)) + both("YA", [across(n, v) for v in u], (0, 1))
    force = -squeezed - np.cross(n, both("YB", w, (0, 2)))
    force += both("XG", [along(n, v) for v in strained], (0, 2)) + both(
        "YG", [2 * across(n, v) for v in strained], (0, 2)
    )
    torques = []
    for rows, columns in (((0, 1), (0, 2)), ((2, 3), (1, 3))):
        torque = np.cross(n, both("YB", u, rows)) - across(n, both("YC", w, rows))
        torques.append(torque + both("YH", [2 * np.cross(n, v) for v in strained], columns))
    return force, *torques
