"""Repulsion and attraction by the surface distance."""
import numpy as np

from evaluator.geometry import column, harmonic_mean


def exponential_repulsion(pairs, strength, relative_length, cutoff_lengths):
    """Returns F_i = -(A / kappa) exp(-h / kappa) n, kappa = relative_length (a_i + a_j), for
    h < cutoff_lengths kappa (L 34)."""
    h, kappa = pairs.surface_distance, relative_length * (pairs.radius_i + pairs.radius_j)
    size = np.where(h < cutoff_lengths * kappa, strength / kappa * np.exp(-h / kappa), 0)
    return -column(size) * pairs.normal


def screened_repulsion(pairs, force, debye_length, reference_radius, cutoff_lengths):
    """Returns F_i = -F_ER (a / a_0) exp(-max(h, 0) / lambda) n, a the harmonic mean of the radii, for
    h < cutoff_lengths lambda (M 6)."""
    h = pairs.surface_distance
    size = force * harmonic_mean(pairs) / reference_radius * np.exp(-np.maximum(h, 0) / debye_length)
    return -column(np.where(h < cutoff_lengths * debye_length, size, 0)) * pairs.normal


def attraction(pairs, hamaker, regularisation, cutoff):
    """Returns F_i = A a / (12 (max(h, 0)^2 + eps^2)) n, a the harmonic mean of the radii and
    eps = regularisation a, for h < cutoff (M 7)."""
    h, mean = pairs.surface_distance, harmonic_mean(pairs)
    size = hamaker * mean / (12 * (np.maximum(h, 0) ** 2 + (regularisation * mean) ** 2))
    return column(np.where(h < cutoff, size, 0)) * pairs.normal
