"""The sheared cell, and pairs of particles in it."""
import dataclasses
import itertools

import numpy as np

# Shifts from the nearest lattice vector by which two particles may interact; the tilt extends x.
SHIFTS = np.array([*itertools.product((-2, -1, 0, 1, 2), (-1, 0, 1), (-1, 0, 1))])


def lattice(box):
    """Returns the rows (Lx, 0, 0), (tilt, Ly, 0), (0, 0, Lz)."""
    vectors = np.diag(np.array(box["lengths"], float))
    vectors[1, 0] = box["tilt"]
    return vectors


def shifts_within(vectors, reach):
    """Returns the SHIFTS by which an image may be nearer than `reach`. From the nearest lattice vector a
    particle lies within half of each vector. A further one along y or z is at least half of that edge away,
    one along x half of Lx less half of the tilt."""
    x, y, z = np.abs(SHIFTS).T
    half = 0.5 * np.diag(vectors)
    least = np.where(y + z > 0, np.minimum(np.where(y > 0, half[1], np.inf), np.where(z > 0, half[2], np.inf)), 0)
    along_x = np.where((y == 0) & (x > 0), (2 * x - 1) * half[0] - 0.5 * abs(vectors[1, 0]), 0)
    return SHIFTS[np.maximum(least, along_x) < reach]


def along(normal, vector):
    """Returns the part of each vector along the unit vector of its row."""
    return normal * np.sum(normal * vector, axis=-1, keepdims=True)


def across(normal, vector):
    return vector - along(normal, vector)


def column(values):
    return np.asarray(values)[:, None]


def harmonic_mean(pairs):
    """Returns the harmonic mean of the radii, a_ij = 2 a_i a_j / (a_i + a_j)."""
    return 2 * pairs.radius_i * pairs.radius_j / (pairs.radius_i + pairs.radius_j)


@dataclasses.dataclass
class Pairs:
    """Rows of pairs of particles i < j; r leads from i to an image of j, F_i acts on i."""

    i: np.ndarray
    j: np.ndarray
    image: np.ndarray  # lattice vectors added to the given position of j
    separation: np.ndarray
    radius_i: np.ndarray
    radius_j: np.ndarray
    velocity_i: np.ndarray
    velocity_j: np.ndarray  # of the image: U_j + rate Ly k_y in x
    spin_i: np.ndarray
    spin_j: np.ndarray
    height_i: np.ndarray  # y of i, which gives the flow at i and at the image of j

    def __len__(self):
        return len(self.i)

    @property
    def distance(self):
        return np.linalg.norm(self.separation, axis=1)

    @property
    def normal(self):
        return self.separation / self.distance[:, None]

    @property
    def height_j(self):
        return self.height_i + self.separation[:, 1]

    @property
    def surface_distance(self):
        """Returns h = r - a_i - a_j, negative in overlap."""
        return self.distance - self.radius_i - self.radius_j

    @property
    def overlap(self):
        return np.maximum(-self.surface_distance, 0)

    def names(self):
        return [(int(i), int(j), tuple(map(int, k))) for i, j, k in zip(self.i, self.j, self.image)]

    def where(self, chosen):
        parts = [getattr(self, field.name)[chosen] for field in dataclasses.fields(self)]
        return Pairs(*parts)


def near_ones(i, position, radius, vectors, shifts, reach):
    """Returns i, j, image and separation of all later particles in all images near particle i."""
    apart = position[i + 1 :] - position[i]
    images = -np.rint(apart @ np.linalg.inv(vectors))[:, None, :] + shifts
    separation = apart[:, None, :] + images @ vectors
    near = np.linalg.norm(separation, axis=2) < reach(radius[i], radius[i + 1 :])[:, None]
    j, image = np.nonzero(near)[0] + i + 1, images[near].astype(int)
    return np.full(len(j), i), j, image, separation[near]


def pairs_within(state, shear_rate, reach):
    """Returns all pairs in all images whose centres are closer than reach(a_i, a_j). Every pair is tried in
    every image that could be near."""
    vectors = lattice(state["box"])
    position, radius = np.array(state["position"], float), np.array(state["radius"], float)
    own = np.linalg.norm(SHIFTS[np.any(SHIFTS != 0, axis=1)] @ vectors, axis=1).min()
    if own < reach(radius, radius).max():
        raise ValueError("the box is too small: a particle acts on its own image")
    shifts = shifts_within(vectors, reach(radius, radius).max())
    found = [near_ones(k, position, radius, vectors, shifts, reach) for k in range(len(radius) - 1)]
    i, j, image, separation = (np.concatenate(parts) for parts in zip(*found))
    velocity, spin = np.array(state["velocity"], float), np.array(state["angular_velocity"], float)
    velocity_j = velocity[j]
    velocity_j[:, 0] += shear_rate * vectors[1, 1] * image[:, 1]
    bodies = radius[i], radius[j], velocity[i], velocity_j, spin[i], spin[j], position[i, 1]
    return Pairs(i, j, image, separation, *bodies)
