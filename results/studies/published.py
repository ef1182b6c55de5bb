"""Fits to viscosities that others have published."""


def mari_fit(fraction, friction):
    """Relative viscosity without noise, with solvent and stresslet: Mari et al. (2014) without friction and with a
    coefficient of 1, as Monti et al. (2021) quote them."""
    return 0.71 * (1 - fraction / 0.575) ** -2.3 if friction else 1.4 * (1 - fraction / 0.66) ** -1.6


def diverging(fraction, jammed, exponent=1.5):
    """(1 - phi / phi_J)^-lambda, the form of the fits of Li's thesis to viscosities of the pairs."""
    return (1 - fraction / jammed) ** -exponent


JAMMED_AT_REST, JAMMED_IN_STRONG_FLOW = 0.587, 0.642  # phi_J of these fits without friction, with lambda = 1.5
