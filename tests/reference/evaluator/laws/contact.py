"""Contact, friction and rolling."""
import numpy as np

from evaluator.geometry import across, along, column, harmonic_mean


def contact_normal(pairs, stiffness):
    """Returns F_i = -k_n delta n (L 3, M 4a)."""
    return -stiffness * column(pairs.overlap) * pairs.normal


def contact_damping(pairs, damping):
    """Returns F_i = gamma_n n n.(U_j - U_i) while the spheres overlap (M 4a)."""
    touching = column(pairs.overlap > 0)
    return damping * touching * along(pairs.normal, pairs.velocity_j - pairs.velocity_i)


def levers(pairs):
    """Returns l = a - delta / 2, from each centre to the middle of the overlap; torques then balance."""
    return pairs.radius_i - pairs.overlap / 2, pairs.radius_j - pairs.overlap / 2


def slip_velocity(pairs):
    """Returns v_t = (1 - nn).(U_j - U_i) - (l_i Omega_i + l_j Omega_j) x n (L 4, M 5)."""
    lever_i, lever_j = levers(pairs)
    turning = np.cross(column(lever_i) * pairs.spin_i + column(lever_j) * pairs.spin_j, pairs.normal)
    return across(pairs.normal, pairs.velocity_j - pairs.velocity_i) - turning


def rolling_velocity(pairs):
    """Returns v_r = a_ij n x (Omega_i - Omega_j) (M B.1)."""
    return column(harmonic_mean(pairs)) * np.cross(pairs.normal, pairs.spin_i - pairs.spin_j)


def held_spring(pairs, spring, velocity, time, longest):
    """Returns a tangential spring after a time: turned into the tangent plane at constant length, stretched
    by the velocity there, and shortened to Coulomb's limit (M 5)."""
    length = np.linalg.norm(spring, axis=1, keepdims=True)
    flat = across(pairs.normal, spring)
    flat_length = np.linalg.norm(flat, axis=1, keepdims=True)
    turned = np.divide(flat * length, flat_length, out=np.zeros_like(flat), where=flat_length > 1e-14 * length)
    return shortened(turned + time * velocity, longest)


def shortened(vectors, longest):
    length = np.linalg.norm(vectors, axis=1)
    return vectors * column(np.minimum(1, np.divide(longest, length, out=np.ones_like(length), where=length > 0)))


def friction(pairs, spring, stiffness, damping=0.0, limit=np.inf):
    """Returns F_i = k_t s + gamma_t v_t within Coulomb's limit, and T = l n x F_i (L 3 and 4, M 4)."""
    force = shortened(stiffness * spring + damping * slip_velocity(pairs), limit)
    moment = np.cross(pairs.normal, force)
    lever_i, lever_j = levers(pairs)
    return force, column(lever_i) * moment, column(lever_j) * moment


def rolling(pairs, spring, stiffness):
    """Returns T_i = a_ij n x k_r s_r = -T_j and no force (M B.1)."""
    torque = column(harmonic_mean(pairs)) * np.cross(pairs.normal, stiffness * spring)
    return np.zeros_like(torque), torque, -torque
