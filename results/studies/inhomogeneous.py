"""Suspensions driven by a flow u(y) through the drag on the spheres: the flows of the studies, and local quantities in
bins (Li 2023, ch. 6).

A bin is 2 a high. From the stress sigma of pairs, the velocity u of the spheres and their rate du/dy:

    P = -tr sigma / 3,  J = eta |du/dy| / P,  mu = |sigma_xy| / P,  Theta = eta du' / (a P)
    lag = |u_driving - u| / (|u_driving| + 1e-5)

a is the smaller radius, eta the solvent's viscosity, du' the root of the variance of u_x about its mean in slabs of
a / 5. The largest share is the share of the largest spheres in the spheres' volume.
"""
import math

import numpy as np

from studies.estimates import estimate, jackknife
from studies.scenes import REFERENCE_SCENE, merged
from studies.tables import entries

VISCOSITY, RADIUS, LARGER_RADIUS, BIN = 0.1, 1.0, 1.4, 2.0
MEAN_RADIUS, MEAN_VOLUME = 1.2, 4 * math.pi / 3 * (1 + 1.4**3) / 2
WIDTH = 17.7  # of the cell along x and z: that of 1000 spheres at 0.5 with a height of 50

SCENE = merged(
    REFERENCE_SCENE,
    particles={"species": [{"radius": 1.0, "number_share": 1}, {"radius": 1.4, "number_share": 1}]},
    flow={"shear_rate": 0, "waves": [{"periods": 1, "sine": 0.1, "cosine": 0}], "faxen": False},
    box={"height": 50},
    observables=["stress", "profiles"],
    profiles={"bins": 25},
)


def wave(sine, periods=1, cosine=0):
    return {"periods": periods, "sine": sine, "cosine": cosine}


def waves_of(velocities):
    """Returns the waves of a scene that interpolate velocities (n,) at equal distances over the height, from y = 0.

    An odd n gives (n - 1) / 2 waves; an even one loses the shortest sine. Raises ValueError unless the mean is 0,
    because a uniform drift has no effect.
    """
    values = np.asarray(velocities, float)
    parts = np.fft.rfft(values) / len(values)
    largest = np.max(np.abs(values))
    if abs(parts[0].real) > 1e-9 * largest:
        raise ValueError(f"the mean is {parts[0].real:.6g}: must be 0")
    factor = np.full(len(parts), 2.0)
    if len(values) % 2 == 0:
        factor[-1] = 1
    return [
        wave(float(-2 * part.imag), k, float(f * part.real))
        for k, (part, f) in enumerate(zip(parts, factor))
        if k > 0 and abs(part) > 1e-12 * largest
    ]


class Driving:
    """A driving flow.

    name        of the flow
    waves       as in a scene
    height      of the cell
    fraction    mean volume fraction
    bins        number of equal bins over the height
    viscosity   of the solvent
    radius      of reference of the spheres
    """

    def __init__(self, name, waves, height, fraction, bins, viscosity=VISCOSITY, radius=RADIUS):
        self.name, self.waves, self.height, self.fraction = name, waves, height, fraction
        self.bins, self.viscosity, self.radius = bins, viscosity, radius

    def driving(self, y):
        """Returns the driving velocity at heights y."""
        return sum(
            w.get("sine", 0) * np.sin(2 * math.pi * w["periods"] * y / self.height)
            + w.get("cosine", 0) * np.cos(2 * math.pi * w["periods"] * y / self.height)
            for w in self.waves
        )

    def driving_of_bins(self):
        """Returns the means of the driving velocity over the bins (bins,)."""
        fine = (np.arange(20 * self.bins) + 0.5) * self.height / (20 * self.bins)
        return self.driving(fine).reshape(self.bins, 20).mean(axis=1)

    def largest_rate(self):
        y = np.linspace(0, self.height, 2001)
        return float(np.max(np.abs(np.gradient(self.driving(y), y))))


def driving_of_scene(name, scene):
    """Returns the Driving of a scene, such as that of a point in an export. Raises ValueError for other flows."""

    def of(pointer):
        value = scene
        for word in pointer.strip("/").split("/"):
            if not isinstance(value, dict) or word not in value:
                raise ValueError(f"{name}: {pointer}: missing; bins need it")
            value = value[word]
        return value

    if scene.get("peclet") or of("/flow").get("shear_rate", 0) != 0:
        raise ValueError(f"{name}: /flow/shear_rate: must be 0, with waves alone")
    particles = of("/particles")
    radius = particles.get("reference_radius") or of("/particles/species")[0].get("radius")
    if radius is None:
        raise ValueError(f"{name}: /particles/reference_radius: missing; bins need it")
    return Driving(
        name,
        of("/flow/waves"),
        of("/box/height"),
        of("/volume_fraction"),
        scene.get("profiles", {}).get("bins", 20),
        of("/fluid/viscosity"),
        radius,
    )


class Flow(Driving):
    """A driving flow of the studies.

    before, during    strains, at the largest rate, before and in the window
    width             of the cell along x and z
    more              further settings
    """

    def __init__(self, name, waves, height, fraction, before, during, width=WIDTH, more=None):
        super().__init__(name, waves, height, fraction, round(height / BIN))
        self.before, self.during, self.more = before, during, more or {}
        self.count = round(fraction * width**2 * height / MEAN_VOLUME)

    def settings(self):
        rate = self.largest_rate()
        return {
            "/particles/count": self.count,
            "/volume_fraction": self.fraction,
            "/box/height": self.height,
            "/flow/waves": self.waves,
            "/profiles/bins": self.bins,
            "/duration/equilibration/time": round(self.before / rate, 1),
            "/duration/production/time": round(self.during / rate, 1),
            **self.more,
        }


# Strains at the largest rate: before the window at a height of 50 (it grows as height^2), and in the window.
BEFORE, DURING = 40, 100


def flow(name, waves, height, fraction, **more):
    """Returns a Flow with the usual strains."""
    return Flow(name, waves, height, fraction, BEFORE * (height / 50) ** 2, DURING, **more)


FRACTIONS = (0.50, 0.52, 0.54, 0.56)
FIGURE = [flow(f"figure-{height}", [wave(0.4)], height, 0.5) for height in (50, 100)]
TRAINING = [
    flow(f"sine-{height}-{100 * fraction:.0f}", [wave(0.1)], height, fraction)
    for height in (50, 100)
    for fraction in FRACTIONS
]
# 0.1 sin(x)^3 = 0.075 sin(x) - 0.025 sin(3 x)
PUBLISHED = [
    flow("sine-and-cosine", [wave(0.1, cosine=0.2)], 80, 0.54),
    flow("cube-of-sine", [wave(0.075), wave(-0.025, 3)], 100, 0.54),
]
UNSEEN = [
    flow("two-waves", [wave(0.1), wave(0.07, 2)], 80, 0.52),
    flow("square", [wave(0.1), wave(0.1 / 3, 3), wave(0.1 / 5, 5)], 100, 0.53),
]
BEYOND = [
    flow(f"sine-{height}-{100 * fraction:.0f}", [wave(0.1)], height, fraction)
    for height, fraction in ((50, 0.57), (50, 0.58), (120, 0.54))
]
# Variants of sine-50-52. The Peclet number at the largest rate is 10.
OTHER = [
    flow("friction", [wave(0.1)], 50, 0.52, more={"/contact/friction": 0.5}),
    flow("noise", [wave(0.1)], 50, 0.52, more={"/fluid/thermal_energy": 0.00237}),
]
# Seeds of a flow. A map is learned from one seed of each training flow, as many times as these flows have seeds, and is
# tested on the mean of all seeds, whose noise must be small.
SEEDS, LEARNED_SEEDS = 4, 16
FLOWS = FIGURE + TRAINING + PUBLISHED + UNSEEN + OTHER + BEYOND


def seeds_of(flow):
    return LEARNED_SEEDS if flow in TRAINING + PUBLISHED else SEEDS


def heights(flow):
    return (np.arange(flow.bins) + 0.5) * flow.height / flow.bins


class Profile:
    """The profiles of one realisation, or of the mean of several, by bin, in the units of the scene."""

    PARTS = "fraction", "velocity", "stress", "variance", "largest"

    def __init__(self, flow, fraction, velocity, stress, variance, largest):
        self.flow, self.fraction, self.velocity = flow, fraction, velocity
        self.stress, self.variance = stress, variance  # rows xx, yy, zz, xy; rows x, y, z
        self.largest = largest  # volume fraction of the spheres of the largest radius
        self.driving = flow.driving_of_bins()
        width = flow.height / flow.bins
        self.rate = (np.roll(velocity, -1) - np.roll(velocity, 1)) / (2 * width)
        self.pressure = -stress[:3].mean(axis=0)

    def columns(self):
        """Returns the local quantities by name, arrays (bins,)."""
        pressure = self.pressure
        return {
            "fraction": self.fraction,
            "velocity": self.velocity,
            "rate": self.rate,
            "shear stress": self.stress[3],
            "normal stress": -self.stress[1],
            "pressure": pressure,
            "J": self.flow.viscosity * np.abs(self.rate) / pressure,
            "mu": np.abs(self.stress[3]) / pressure,
            "Theta": self.flow.viscosity * np.sqrt(self.variance[0]) / (self.flow.radius * pressure),
            "lag": np.abs(self.driving - self.velocity) / (np.abs(self.driving) + 1e-5),
            "largest share": self.largest / self.fraction,
        }


QUANTITIES = (
    "fraction", "velocity", "rate", "shear stress", "normal stress", "pressure", "J", "mu", "Theta", "lag",
    "largest share"
)  # fmt: skip


def profile_of(flow, profiles):
    """Returns the Profile of mean.profiles in a result."""
    fraction = np.array(profiles["volume_fraction"], float)
    velocity = np.array(profiles["velocity"]["flux"], float) / fraction
    stress, variance = (np.array(rows, float) for rows in (profiles["stress"]["pairs"], profiles["velocity_variance"]))
    return Profile(flow, fraction, velocity, stress, variance, np.array(profiles["volume_fraction_by_radius"][-1]))


def mean_profile(flow, profiles):
    """Returns the Profile with the means of several realisations."""
    return Profile(flow, *(np.mean([getattr(p, part) for p in profiles], axis=0) for part in Profile.PARTS))


def symmetries(driving):
    """Returns the maps of bins onto bins that leave a driving (bins,) unchanged except for its sign.

    A list of (bins, sign of velocities, sign of the shear stress), the identity first. The shear stress changes its
    sign with the velocity, and with the direction of y.
    """
    bins, tolerance = np.arange(len(driving)), 1e-9 * np.max(np.abs(driving))
    found = []
    for side in (1, -1):
        for shift in range(len(driving)):
            image = (side * bins + (shift if side > 0 else shift - 1)) % len(driving)
            for sign in (1, -1):
                if np.max(np.abs(driving[image] - sign * driving)) <= tolerance:
                    found.append((image, sign, sign * side))
    return found


def symmetric(profile):
    """Returns the mean of a Profile over the symmetries of its driving."""
    images = symmetries(profile.driving)

    def mean(values, signs):
        return np.mean([sign * values[..., image] for (image, *_), sign in zip(images, signs)], axis=0)

    even, velocity, shear = np.ones(len(images)), [s for _, s, _ in images], [s for *_, s in images]
    stress = np.vstack([mean(profile.stress[:3], even), mean(profile.stress[3], shear)])
    fraction, variance, largest = (mean(v, even) for v in (profile.fraction, profile.variance, profile.largest))
    return Profile(profile.flow, fraction, mean(profile.velocity, velocity), stress, variance, largest)


def distinct_bins(driving):
    """Returns the first bin of each set of bins that are images of each other.

    Bins that a symmetry maps onto themselves with the opposite shear stress are left out: their means have neither
    stress nor rate.
    """
    images = symmetries(driving)
    return [
        k
        for k in range(len(driving))
        if k == min(int(image[k]) for image, *_ in images)
        and not any(image[k] == k and s < 0 for image, _, s in images)
    ]


def symmetric_bin_rows(flow, profiles):
    """Returns bin_rows() of profiles averaged over the symmetries of the driving, one row for each distinct bin."""
    rows = list(bin_rows(flow, [symmetric(p) for p in profiles]))
    return [rows[k] for k in distinct_bins(flow.driving_of_bins())]


def bin_rows(flow, profiles):
    """Yields a row for each bin: the quantities of the mean Profile and their jackknife errors over realisations."""
    columns, errors = jackknife(
        lambda chosen: list(mean_profile(flow, [profiles[k] for k in chosen]).columns().values()), len(profiles)
    )
    driving = flow.driving_of_bins()
    for k, y in enumerate(heights(flow)):
        row = {"flow": flow.name, "mean": flow.fraction, "height": flow.height, "y": y, "driving": driving[k]}
        for name, values, error in zip(QUANTITIES, columns, errors):
            row |= entries(name, (float(values[k]), error[k]))
        yield row


# Columns of the tables by seed.
LEARNED_QUANTITIES = "fraction", "rate", "J", "mu", "Theta", "lag"


def rows_by_seed(flow, profiles, bins=None):
    """Yields a row for each seed and bin, or each of `bins`: its quantities without errors."""
    places = heights(flow)
    for seed, profile in enumerate(profiles):
        columns = profile.columns()
        for k in range(flow.bins) if bins is None else bins:
            row = {"flow": flow.name, "seed": seed, "y": places[k]}
            yield row | {name: float(columns[name][k]) for name in LEARNED_QUANTITIES}


def symmetric_rows_by_seed(flow, profiles):
    """Yields rows_by_seed() of profiles averaged over the symmetries of the driving, for each distinct bin."""
    return rows_by_seed(flow, [symmetric(p) for p in profiles], distinct_bins(flow.driving_of_bins()))


def growth(quarters):
    """Returns the relative growth of a profile from the first to the second half of the window, and its standard error.

    `quarters` has the profile by seed, quarter of the window, and bin. The change of each seed is projected on the mean
    profile less its mean over the bins, which removes noise of another shape.
    """
    values = np.asarray(quarters, float)
    shape = values.mean(axis=(0, 1))
    shape = shape - shape.mean()
    change = (values[:, 2:].mean(axis=1) - values[:, :2].mean(axis=1)) @ shape / (shape @ shape)
    return estimate(change.tolist())
