"""The flow and its force and torque on single particles, given as arrays of radii, positions and so on."""
import numpy as np

from evaluator.geometry import column

PI = np.pi


class Flow:
    """u_x(y) = rate y + sum of sine sin(k y) + cosine cos(k y), k = 2 pi periods / Ly. M's flows, sin^3
    included, have this form. `faxen`: particles feel the curvature."""

    def __init__(self, scene_flow, length):
        self.shear_rate, self.faxen = scene_flow["shear_rate"], scene_flow.get("faxen", False)
        waves = scene_flow.get("waves", [])
        self._k, self._sine, self._cosine = (
            np.array([[2 * PI * w["periods"] / length, w["sine"], w["cosine"]] for w in waves], float).reshape(-1, 3).T
        )

    def _derivative(self, height, order):
        """Returns a derivative of the waves: each order multiplies by k and shifts by a quarter period."""
        phase = self._k * np.asarray(height)[..., None] + order * PI / 2
        return np.sum(self._k**order * (self._sine * np.sin(phase) + self._cosine * np.cos(phase)), axis=-1)

    def speed(self, height, radius=0.0):
        """Returns u_x, or with a radius Faxen's first law: (1 + a^2/6 d^2/dy^2) u_x."""
        curvature = self._derivative(height, 2) if self.faxen else 0.0
        return self.shear_rate * np.asarray(height) + self._derivative(height, 0) + radius**2 / 6 * curvature

    def gradient(self, height, radius=0.0):
        """Returns du_x/dy, or with a radius that of the stresslet: (1 + a^2/10 d^2/dy^2) du_x/dy."""
        curvature = self._derivative(height, 3) if self.faxen else 0.0
        return self.shear_rate + self._derivative(height, 1) + radius**2 / 10 * curvature

    def velocity(self, height, radius=0.0):
        return self.speed(height, radius)[..., None] * np.array([1.0, 0, 0])

    def spin(self, height):
        """Returns half the vorticity, (0, 0, -du_x/dy / 2)."""
        return self.gradient(height)[..., None] * np.array([0, 0, -0.5])


def strain_rate(gradient):
    """Returns E, whose xy and yx are half the gradient."""
    tensor = np.zeros((*np.shape(gradient), 3, 3))
    tensor[..., 0, 1] = tensor[..., 1, 0] = np.asarray(gradient) / 2
    return tensor


def drag(radius, position, velocity, spin, viscosity, flow):
    """Returns F = 6 pi eta a (U_inf - U), T = 8 pi eta a^3 (Omega_inf - Omega) (L 5, 6; M A.1)."""
    height = position[:, 1]
    force = 6 * PI * viscosity * column(radius) * (flow.velocity(height, radius) - velocity)
    return force, 8 * PI * viscosity * column(radius**3) * (flow.spin(height) - spin)


def drag_noise(radius, viscosity, amplitude, psi, phi):
    """Returns sqrt(2 kT / dt) times sqrt(6 pi eta a) psi and sqrt(8 pi eta a^3) phi (L 20, 21)."""
    force = amplitude * np.sqrt(6 * PI * viscosity * column(radius)) * psi
    return force, amplitude * np.sqrt(8 * PI * viscosity * column(radius**3)) * phi
