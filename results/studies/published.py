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
