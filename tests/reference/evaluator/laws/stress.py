"""Stresses, tension positive."""
import numpy as np

from evaluator.laws.flow import strain_rate

PI = np.pi


def pair_stress(pairs, force, volume):
    """Returns (1/V) sum over pairs of (r F_i + F_i r) / 2."""
    tensor = np.einsum("pa,pb->ab", pairs.separation, force) / volume
    return (tensor + tensor.T) / 2


def solvent_stress(viscosity, shear_rate):
    """Returns 2 eta E."""
    return 2 * viscosity * strain_rate(shear_rate)


def stresslet(radius, height, viscosity, flow, volume):
    """Returns (1/V) sum of 20/3 pi eta a^3 E: 2.5 phi times 2 eta E in simple shear (M 9)."""
    return 20 / 3 * PI * viscosity * np.tensordot(radius**3, strain_rate(flow.gradient(height, radius)), 1) / volume
