"""Storage and loss of linear response: what one says of the other, and published limits."""
import numpy as np
from scipy.interpolate import CubicSpline


def storage_by_loss(frequency, loss, samples=4001):
    """The storage modulus G' by Kramers and Kronig, from the loss modulus G'' at increasing frequencies w:

        G'(w) / w = -(2 w / pi) P int_0^inf eta'(x) / (x^2 - w^2) dx,    eta'(x) = G''(x) / x,

    with eta' a cubic spline over ln x, and constant beyond both ends. Since P int_0^inf dx / (x^2 - w^2) = 0, what is
    integrated is (eta'(x) - eta'(w)) / (x^2 - w^2), which has no pole."""
    viscosity = loss / frequency
    spline = CubicSpline(np.log(frequency), viscosity)
    places = np.linspace(np.log(frequency[0]), np.log(frequency[-1]), samples)
    x, values = np.exp(places), spline(places)
    storage = []
    for w, there in zip(frequency, viscosity):
        near = np.abs(x / w - 1) < 1e-9
        distance = np.where(near, 1, x**2 - w**2)
        inner = np.where(near, spline(np.log(w), 1) / (2 * w), (values - there) * x / distance)
        integral = np.sum((inner[1:] + inner[:-1]) / 2) * (places[1] - places[0])
        if w > frequency[0]:
            integral -= (viscosity[0] - there) * np.arctanh(frequency[0] / w) / w
        if w < frequency[-1]:
            integral += (viscosity[-1] - there) * np.arctanh(w / frequency[-1]) / w
        storage.append(-2 * w**2 / np.pi * integral)
    return np.array(storage)


def viscosity_at_high_frequency(fraction):
    """Of hard spheres with all their hydrodynamic interactions, over the fluid's: Lionberger & Russel (1994), (1 + 3/2
    phi S) / (1 - phi S), S = 1 + phi - 0.189 phi^2."""
    share = fraction * (1 + fraction - 0.189 * fraction**2)
    return (1 + 1.5 * share) / (1 - share)
