"""One function for each law. Sources as in engine/PHYSICS.md: L is Li, Royer & Ness (2023), M is Monti et al. (2021).

A law of pairs takes Pairs and its own parameters, and returns the force on i; with it, where it has torques, those on i
and on j. The force on j is the opposite one.
"""
import numpy as np

from evaluator.geometry import across, along

PI = np.pi


def column(values):
    return np.asarray(values)[:, None]


# Contact.


def contact_normal(pairs, stiffness):
    """F_i = -k_n delta n (L 3, M 4a)."""
    return -stiffness * column(pairs.overlap) * pairs.normal


def contact_damping(pairs, damping):
    """F_i = gamma_n n n.(U_j - U_i) while the spheres overlap (M 4a)."""
    touching = column(pairs.overlap > 0)
    return damping * touching * along(pairs.normal, pairs.velocity_j - pairs.velocity_i)


def levers(pairs):
    """l = a - delta / 2, from each centre to the middle of the overlap: with them the torques of a pair balance."""
    return pairs.radius_i - pairs.overlap / 2, pairs.radius_j - pairs.overlap / 2


def slip_velocity(pairs):
    """v_t = (1 - nn).(U_j - U_i) - (l_i Omega_i + l_j Omega_j) x n (L 4, M 5)."""
    lever_i, lever_j = levers(pairs)
    turning = np.cross(column(lever_i) * pairs.spin_i + column(lever_j) * pairs.spin_j, pairs.normal)
    return across(pairs.normal, pairs.velocity_j - pairs.velocity_i) - turning


def rolling_radius(pairs):
    """a_ij = 2 a_i a_j / (a_i + a_j) (M B.1)."""
    return 2 * pairs.radius_i * pairs.radius_j / (pairs.radius_i + pairs.radius_j)


def rolling_velocity(pairs):
    """v_r = a_ij n x (Omega_i - Omega_j) (M B.1)."""
    return column(rolling_radius(pairs)) * np.cross(pairs.normal, pairs.spin_i - pairs.spin_j)


def held_spring(pairs, spring, velocity, time, longest):
    """A tangential spring after a time: turned into the tangent plane with its length kept, stretched by the velocity
    there, and shortened to what Coulomb's law lets it be (M 5)."""
    length = np.linalg.norm(spring, axis=1, keepdims=True)
    flat = across(pairs.normal, spring)
    flat_length = np.linalg.norm(flat, axis=1, keepdims=True)
    turned = np.divide(flat * length, flat_length, out=np.zeros_like(flat), where=flat_length > 1e-14 * length)
    stretched = turned + time * velocity
    length = np.linalg.norm(stretched, axis=1)
    return stretched * column(np.minimum(1, np.divide(longest, length, out=np.ones_like(length), where=length > 0)))


def friction(pairs, spring, stiffness):
    """F_i = k_t s, T = l n x F_i on both (L 3 and 4, M 4)."""
    force = stiffness * spring
    moment = np.cross(pairs.normal, force)
    lever_i, lever_j = levers(pairs)
    return force, column(lever_i) * moment, column(lever_j) * moment


def rolling(pairs, spring, stiffness):
    """T_i = a_ij n x k_r s_r = -T_j, without a force (M B.1)."""
    torque = column(rolling_radius(pairs)) * np.cross(pairs.normal, stiffness * spring)
    return np.zeros_like(torque), torque, -torque


# Lubrication, as a matrix, and its noise, as a root of it.


def resistances(pairs, viscosity, inner_gap):
    """X_A, Y_A, Y_B11, Y_B21, Y_C11, Y_C12, Y_C22 (L 9-12, 15-18) at xi = 2 h / (a_i + a_j), or at the inner gap where
    that is larger; with eta in them. Y_B times q and Y_C times q^2, q = r / (a_i + a_j), so that rigid motion meets no
    resistance.
    """
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
    """N = nn, T = 1 - nn, and the matrix X of v -> v x n."""
    x, y, z = normal.T
    zero = np.zeros_like(x)
    turn = np.array([[zero, z, -y], [-z, zero, x], [y, -x, zero]]).transpose(2, 0, 1)
    square = normal[:, :, None] * normal[:, None, :]
    return square, np.eye(3) - square, turn


def blocks(rows):
    """Matrices of a row of blocks of 3 x 3 for each pair, and a scalar in front of each."""
    return np.concatenate([np.concatenate(row, axis=2) for row in rows], axis=1)


def resistance_matrix(pairs, viscosity, inner_gap):
    """R of (F_i, F_j, T_i, T_j) = -R (U_i, U_j, Omega_i, Omega_j), 12 x 12 for each pair (L 8, 13, 14, 29)."""
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
    """B of (F_i, F_j, T_i, T_j) = sqrt(2 kT / dt) B (theta, chi), 12 x 6 for each pair, B B' = R (L 22-28; the root in
    T_j has a minus, without which that does not hold)."""
    XA, YA, B1, B2, C11, _, C22 = (v[:, None, None] for v in resistances(pairs, viscosity, inner_gap))
    N, T, X = projectors(pairs.normal)
    A, zero = np.sqrt(XA) * N + np.sqrt(YA) * T, np.zeros_like(N)
    # Not negative in exact numbers: both are 6 pi eta a_i^3 b^3 L q^2 / ((1 + b) (2 + b + 2 b^2)).
    spin_i, spin_j = (np.sqrt(np.maximum(C - B**2 / YA, 0)) for C, B in ((C11, B1), (C22, B2)))
    pump_i, pump_j = B1 / np.sqrt(YA), B2 / np.sqrt(YA)
    return blocks([[A, zero], [-A, zero], [pump_i * X, spin_i * T], [pump_j * X, -spin_j * T]])


def parts_of(load):
    """Force on i and both torques of a column of twelve; the force on j is known."""
    return load[:, 0:3], load[:, 6:9], load[:, 9:12]


def lubrication(pairs, viscosity, inner_gap):
    """Of velocities in the laboratory's frame (L 8, 13, 14)."""
    motion = np.concatenate((pairs.velocity_i, pairs.velocity_j, pairs.spin_i, pairs.spin_j), axis=1)
    return parts_of(-np.einsum("pab,pb->pa", resistance_matrix(pairs, viscosity, inner_gap), motion))


def lubrication_noise(pairs, viscosity, inner_gap, amplitude, theta, chi):
    """`amplitude` is sqrt(2 kT / dt); theta and chi are normal vectors of the pair."""
    normals = np.concatenate((theta, chi), axis=1)
    return parts_of(amplitude * np.einsum("pab,pb->pa", noise_matrix(pairs, viscosity, inner_gap), normals))


# Repulsion.


def exponential_repulsion(pairs, strength, relative_length, cutoff_lengths):
    """F_i = -(A / kappa) exp(-h / kappa) n, kappa = relative_length (a_i + a_j), for h < cutoff_lengths kappa (L
    34)."""
    h, kappa = pairs.surface_distance, relative_length * (pairs.radius_i + pairs.radius_j)
    size = np.where(h < cutoff_lengths * kappa, strength / kappa * np.exp(-h / kappa), 0)
    return -column(size) * pairs.normal


def screened_repulsion(pairs, force, debye_length, reference_radius, cutoff_lengths):
    """F_i = -F_ER (a / a_0) exp(-max(h, 0) / lambda) n, a the harmonic mean of the radii, for h < cutoff_lengths lambda
    (M 6)."""
    h = pairs.surface_distance
    size = force * rolling_radius(pairs) / reference_radius * np.exp(-np.maximum(h, 0) / debye_length)
    return -column(np.where(h < cutoff_lengths * debye_length, size, 0)) * pairs.normal


def attraction(pairs, hamaker, regularisation, cutoff):
    """F_i = A a / (12 (max(h, 0)^2 + eps^2)) n, a the harmonic mean of the radii and eps = regularisation a, for h <
    cutoff (M 7)."""
    h, mean = pairs.surface_distance, rolling_radius(pairs)
    size = hamaker * mean / (12 * (np.maximum(h, 0) ** 2 + (regularisation * mean) ** 2))
    return column(np.where(h < cutoff, size, 0)) * pairs.normal


# Lubrication in a flow of any shape, by velocities relative to it and its rate of strain (M 3 and A.1 to A.7).


def mari_coefficients(a_i, a_j):
    """g of X_A, Y_A, Y_B, Y_C, X_G, Y_G, Y_H for ii, ij, ji, jj; X = 6 pi eta g / d and Y = 6 pi eta g ln(1/d). With b
    the ratio of the sizes; those of j follow by exchanging the spheres, which turns b into 1/b."""
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
    """With u and w relative to the flow, P = n.E.n, Q = 2 E.n - 2 (n.E.n) n, H = 2 n x (E.n):

    F_i = -A_ii u_i - A_ij u_j - n x (YB_ii w_i + YB_ji w_j) + (XG_ii P_i + XG_ji P_j) n + YG_ii Q_i + YG_ji Q_j
    T_i = n x (YB_ii u_i + YB_ij u_j) - (1 - nn).(YC_ii w_i + YC_ij w_j) + YH_ii H_i + YH_ji H_j

    and T_j with i and j exchanged in the indices. d = max(xi, 0) + regularisation. The print has H twice as large."""
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


# The flow, and single particles in it: arrays of radii, positions and so on. Force and torque on each.


class Flow:
    """u_x(y) = rate y + sum of sine sin(k y) + cosine cos(k y), k = 2 pi periods / Ly: M's flows, sin^3 among them, are
    of this kind. `faxen` says whether particles feel its curvature."""

    def __init__(self, scene_flow, length):
        self.shear_rate, self.faxen = scene_flow["shear_rate"], scene_flow.get("faxen", False)
        waves = scene_flow.get("waves", [])
        self._k, self._sine, self._cosine = (
            np.array([[2 * PI * w["periods"] / length, w["sine"], w["cosine"]] for w in waves], float).reshape(-1, 3).T
        )

    def _derivative(self, height, order):
        """Of the waves: each derivative multiplies by k and goes on a quarter of a period."""
        phase = self._k * np.asarray(height)[..., None] + order * PI / 2
        return np.sum(self._k**order * (self._sine * np.sin(phase) + self._cosine * np.cos(phase)), axis=-1)

    def speed(self, height, radius=0.0):
        """u_x, and with a radius what Faxen's first law makes of it: (1 + a^2/6 d^2/dy^2) u_x."""
        curvature = self._derivative(height, 2) if self.faxen else 0.0
        return self.shear_rate * np.asarray(height) + self._derivative(height, 0) + radius**2 / 6 * curvature

    def gradient(self, height, radius=0.0):
        """du_x/dy, and with a radius that of the stresslet: (1 + a^2/10 d^2/dy^2) of it."""
        curvature = self._derivative(height, 3) if self.faxen else 0.0
        return self.shear_rate + self._derivative(height, 1) + radius**2 / 10 * curvature

    def velocity(self, height, radius=0.0):
        return self.speed(height, radius)[..., None] * np.array([1.0, 0, 0])

    def spin(self, height):
        """Half the vorticity, (0, 0, -du_x/dy / 2)."""
        return self.gradient(height)[..., None] * np.array([0, 0, -0.5])


def strain_rate(gradient):
    """E, whose xy and yx are half the gradient."""
    tensor = np.zeros((*np.shape(gradient), 3, 3))
    tensor[..., 0, 1] = tensor[..., 1, 0] = np.asarray(gradient) / 2
    return tensor


def drag(radius, position, velocity, spin, viscosity, flow):
    """F = 6 pi eta a (U_inf - U), T = 8 pi eta a^3 (Omega_inf - Omega) (L 5, 6; M A.1)."""
    height = position[:, 1]
    force = 6 * PI * viscosity * column(radius) * (flow.velocity(height, radius) - velocity)
    return force, 8 * PI * viscosity * column(radius**3) * (flow.spin(height) - spin)


def drag_noise(radius, viscosity, amplitude, psi, phi):
    """sqrt(2 kT / dt) times sqrt(6 pi eta a) psi and sqrt(8 pi eta a^3) phi (L 20, 21)."""
    force = amplitude * np.sqrt(6 * PI * viscosity * column(radius)) * psi
    return force, amplitude * np.sqrt(8 * PI * viscosity * column(radius**3)) * phi


# Stresses, tension positive.


def pair_stress(pairs, force, volume):
    """(1/V) sum over pairs of (r F_i + F_i r) / 2."""
    tensor = np.einsum("pa,pb->ab", pairs.separation, force) / volume
    return (tensor + tensor.T) / 2


def solvent_stress(viscosity, shear_rate):
    """2 eta E."""
    return 2 * viscosity * strain_rate(shear_rate)


def stresslet(radius, height, viscosity, flow, volume):
    """(1/V) sum of 20/3 pi eta a^3 E: 2.5 phi of 2 eta E in simple shear (M 9)."""
    return 20 / 3 * PI * viscosity * np.tensordot(radius**3, strain_rate(flow.gradient(height, radius)), 1) / volume
