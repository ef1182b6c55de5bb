"""Fits to viscosities that others have published."""


# c, phi_J and lambda of c (1 - phi / phi_J)^-lambda, relative viscosities without noise, with solvent and stresslet, by
# friction coefficient: Mari et al. (2014), as Monti et al. (2021) quote them.
MARI_FITS = {0: (1.4, 0.66, 1.6), 1: (0.71, 0.575, 2.3)}


def mari_fit(fraction, friction):
    factor, jammed, exponent = MARI_FITS[friction]
    return factor * diverging(fraction, jammed, exponent)


def diverging(fraction, jammed, exponent=1.5):
    """(1 - phi / phi_J)^-lambda, the form of the fits of Li's thesis to viscosities of the pairs."""
    return (1 - fraction / jammed) ** -exponent


JAMMED_AT_REST, JAMMED_IN_STRONG_FLOW = 0.587, 0.642  # phi_J of these fits without friction, with lambda = 1.5

# Li's thesis, Table 4.1: Peclet number, shear rate, thermal energy; a = 1, density and viscosity 0.1, k_n = 10^4.
TABLE_4_1 = (
    (0.01, 9e-5, 0.017),
    (0.046, 4.2e-4, 0.017),
    (0.22, 1.9e-3, 0.017),
    (1, 9e-3, 0.017),
    (4.6, 9e-3, 3.7e-3),
    (22, 9e-3, 7.9e-4),
    (100, 9e-3, 1.7e-4),
    (460, 9e-3, 3.7e-5),
    (2200, 9e-3, 7.9e-6),
    (1e4, 9e-3, 1.7e-6),
)
DENSITY, VISCOSITY, STIFFNESS = 0.1, 0.1, 1e4
