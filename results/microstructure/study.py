#!/usr/bin/python3
"""The distribution of neighbours in the plane of flow and gradient, from weak to strong flow."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREEN, RED, REFERENCE_SCENE, Statement, at_peclet, difference
from studies.driver import entries, estimate, in_brownian_times, in_strains, main, merged, number, over, propagated
from studies.driver import quotient, read_numbers, read_rows, row_ratio, where, write_numbers, write_rows
import numpy as np

TITLE = "Microstructure in the flow"
FRACTION, BIN = 0.5, 0.05
SCENE = merged(
    REFERENCE_SCENE,
    particles={"count": 500},
    volume_fraction=FRACTION,
    observables=["stress", "pair_distribution"],
    pair_distribution={"range": 5, "bin": BIN, "slab": 0.1},
)
RINGS = (2.0, 2.4, 2.8)  # contact distances: two small spheres, a small and a large one, two large ones
BROWNIAN = in_brownian_times(40, 20)
SHEARED = in_strains(2, 6)
RUNS = ((0.01, 32, BROWNIAN), (1, 48, BROWNIAN), (1e4, 64, SHEARED))
QUICK_RUNS = ((0.01, 16, in_brownian_times(4, 8)), (1e4, 16, in_strains(1, 8)))
SECTORS = 12  # of the angle from the flow direction to its opposite
MAP_COLOURS = {0: "#ffffff", 0.5: "#c8daf0", 1: "#7fb0d8", 2: "#2060b0", 4: "#301860", 8: "#100020"}


def contact_value(fraction):
    """Returns g of all pairs at the contact distance of two small hard spheres: the share of such pairs times

        g_ij = 1 / (1 - z3) + 3 z2 / (1 - z3)^2 d + 2 z2^2 / (1 - z3)^3 d^2,    d = s_i s_j / (s_i + s_j)

    (Boublik 1970; Mansoori, Carnahan, Starling & Leland 1971). s are the diameters, z3 the volume fraction,
    z2 = z3 sum x s^2 / sum x s^3 with number shares x.
    """
    diameters, volumes = np.array([2.0, 2.8]), np.array([0.5, 0.5])
    shares = volumes / diameters**3 / (volumes / diameters**3).sum()
    z2 = fraction * (shares @ diameters**2) / (shares @ diameters**3)
    x, void = z2 * diameters[0] / 2, 1 - fraction
    return float(shares[0] ** 2 * (1 / void + 3 * x / void**2 + 2 * x**2 / void**3))


class Structure:
    """Pair counts and ideal counts of one point by seed: in shells, and in cells (y, x) of a slice in the plane of flow
    and gradient."""

    def __init__(self, point):
        found = [mean["pair_distribution"] for mean in point.means]
        self.seeds = len(found)
        radial, slices = [f["radial"] for f in found], [f["slice"] for f in found]
        self.distance = np.array(radial[0]["r"])
        self.counts, self.ideal = (np.array([r[name] for r in radial], float) for name in ("counts", "ideal"))
        self.x, self.y = np.array(slices[0]["x"]), np.array(slices[0]["y"])
        self.cells = np.array([s["counts"] for s in slices], float)
        self.ideal_of_cell = np.array([s["ideal"] for s in slices], float)
        columns, rows = np.meshgrid(self.x, self.y)
        self.radius, self.angle = np.hypot(columns, rows), np.arctan2(rows, columns)

    def shell(self, low, high):
        """Returns g averaged over the shell between two distances (seeds,)."""
        chosen = (low < self.distance) & (self.distance < high)
        return self.counts[:, chosen].sum(axis=1) / self.ideal[:, chosen].sum(axis=1)

    def sectors(self, ring, count):
        """Returns g of the slice at a ring (seeds, count), in equal sectors of the angle from the flow direction
        through the gradient direction to the opposite of the flow."""
        at_ring = abs(self.radius - ring) < BIN
        sector = np.floor(self.angle / np.pi * count)
        parts = [at_ring & (sector == k) for k in range(count)]
        g = [self.cells[:, part].sum(axis=1) / (part.sum() * self.ideal_of_cell) for part in parts]
        return np.array(g).T

    def ring(self, ring):
        """Returns numbers about a ring by seed:

        height        g within 0.05 a of the ring
        prominence    g just outside of the ring over the larger of g 0.1 a before and after it
        sharpness     height over g from 0.05 to 0.15 a beyond
        difference    g of the slice in the compressive quadrant (x y < 0) minus that in the extensional one
        anisotropy    this difference over the sum of both
        """
        height, beyond = self.shell(ring - BIN, ring + BIN), self.shell(ring + BIN, ring + 3 * BIN)
        edge = self.shell(ring, ring + BIN)
        around = self.shell(ring - 2 * BIN, ring - BIN), self.shell(ring + 2 * BIN, ring + 3 * BIN)
        extends, compresses = self.sectors(ring, 2).T
        return {
            "height": height,
            "prominence": edge / np.maximum(*around),
            "sharpness": height / beyond,
            "difference": compresses - extends,
            "anisotropy": (compresses - extends) / (compresses + extends),
        }

    def rings(self):
        return {ring: {name: estimate(values) for name, values in self.ring(ring).items()} for ring in RINGS}


def point_of(program, number, seeds, duration, patch=None, name=None):
    scene = merged(SCENE, at_peclet(number), duration, patch or {})
    return Structure(program.run(name or f"microstructure-{number:g}", scene, [{"/peclet": number}], seeds)[0])


def sharpness_rows(found, degrees):
    weak, *between, strong = sorted(found)
    for ring in RINGS:
        lowest = min(found, key=lambda n: found[n][ring]["prominence"])
        text = f"ring at {ring:g} a: g there over that 0.1 a before and after, the least of all Pe (Pe = {lowest:g})"
        yield Statement(text, "L4.8", *number(found[lowest][ring], "prominence"), 1, degrees=degrees)
    for ring in RINGS:
        for peclet in (strong, *between):
            text = f"ring at {ring:g} a: sharpness at Pe = {peclet:g} over that at {weak:g}"
            ratio = row_ratio(found[peclet][ring], found[weak][ring], "sharpness")
            yield Statement(text, "L4.8", *ratio, 1, degrees=degrees)


def variation(sectors):
    """Returns the relative rms variation of g over the angle, without that of noise, and its standard error."""
    numbers = [(r["g"], r["standard_error"]) for r in sectors]
    noise = np.mean([error**2 for _, error in numbers])

    def relative(values):
        return math.sqrt(max(0, np.var(values) - noise)) / float(np.mean(values))

    # Values that are drawn again have the noise twice.
    value, _ = propagated(numbers, relative)
    _, error = propagated(numbers, lambda values: float(np.std(values) / np.mean(values)))
    return value, error


def anisotropy_rows(found, sectors, degrees):
    """Yields rows about anisotropy over the whole angle, because quadrants miss pairs along the flow."""
    peclets = weak, *_, strong = sorted(found)
    for ring in RINGS:
        name = f"ring at {ring:g} a: relative rms of g over the angle"
        varied = {p: variation(where(sectors, peclet=p, distance=ring)) for p in peclets}
        yield Statement(f"{name}, at Pe = {weak:g}: isotropic", "L4.8", *varied[weak], high=0.05, degrees=degrees)
        for low, high in zip(peclets, peclets[1:]):
            text = f"{name}, at Pe = {high:g} less that at {low:g}: anisotropy grows"
            yield Statement(text, "L4.8", *difference(varied[high], varied[low]), 0, degrees=degrees)
    for ring in RINGS[:2]:
        for low, high in zip(peclets, peclets[1:]):
            for quantity, words in (("difference", "g"), ("anisotropy", "quadrant over their sum")):
                risen = difference(*(number(found[p][ring], quantity) for p in (high, low)))
                ends = f"at Pe = {high:g} less that at {low:g}"
                text = f"ring at {ring:g} a: compressive less extensional {words}, {ends}"
                yield Finding(text, "quadrants", *risen, degrees)


TOUCHING = "Pe = 0.01: g up to 0.05 a beyond contact over that of hard spheres in contact at rest, from which it falls"


def touching(structure):
    """Returns g just beyond contact, overlaps included, over that of hard spheres, and the degrees of freedom."""
    r, edge = structure.distance, 2 + BIN
    counts = structure.counts[:, r < edge].sum(axis=1)
    ideal = structure.ideal[:, (2 < r) & (r < edge)].sum(axis=1)
    return (*over(estimate(counts / ideal), contact_value(FRACTION)), structure.seeds - 1)


def method_row(peclet, implicit, explicit):
    text = f"Pe = {peclet}: ring at 2 a by implicit steps over that by explicit ones"
    return Check(text, "method", *row_ratio(implicit, explicit, "height"), 0.9, 1.1, explicit["seeds"] - 1)


def judge():
    table, sectors = read_rows(HERE / "table.csv"), read_rows(HERE / "sectors.csv")
    of = {(r["method"], r["peclet"], r["distance"]): r for r in table}
    found = {p: {ring: of["implicit", p, ring] for ring in RINGS} for p, _, _ in RUNS}
    degrees = min(r["seeds"] for rings in found.values() for r in rings.values()) - 1
    yield from sharpness_rows(found, degrees)
    yield from anisotropy_rows(found, sectors, degrees)
    *value, degrees = read_numbers(HERE / "numbers.csv")[TOUCHING]
    yield Check(TOUCHING, "Mansoori et al.", *value, 0.8, 1, degrees)
    yield method_row("10^4", of["implicit", 1e4, 2], of["explicit", 1e4, 2])
    short = (of[f"{method}, 10 Brownian times", 0.01, 2] for method in ("implicit", "explicit"))
    yield method_row("0.01", *short)


def ring_rows(method, peclet, structure):
    for ring, quantities in structure.rings().items():
        row = {"method": method, "peclet": peclet, "seeds": structure.seeds, "distance": ring}
        for name, found in quantities.items():
            row |= entries(name, found)
        yield row


def row_of_g(values, **place):
    return place | dict(zip(("g", "standard_error"), estimate(values)))


def measure(program):
    structures = {peclet: point_of(program, peclet, seeds, duration) for peclet, seeds, duration in RUNS}
    explicit = {"integrator": {"method": "explicit"}}
    strong = point_of(program, 1e4, 4, SHEARED, explicit, "microstructure-explicit-10000")
    # Explicit steps do not reach equilibrium here. Both methods start from the same packings and run equally long.
    short = in_brownian_times(5, 5)
    weak = point_of(program, 0.01, 8, short, explicit, "microstructure-explicit-0.01")
    weak_implicit = point_of(program, 0.01, 16, short, None, "microstructure-short-0.01")
    table, radial, sectors = [], [], []
    for peclet, structure in structures.items():
        table += ring_rows("implicit", peclet, structure)
        shells = zip(structure.distance.tolist(), (structure.counts / structure.ideal).T)
        radial += [row_of_g(values, peclet=peclet, distance=r) for r, values in shells]
        for ring in RINGS:
            for k, values in enumerate(structure.sectors(ring, SECTORS).T):
                place = {"peclet": peclet, "distance": ring, "from_degrees": 180 * k / SECTORS}
                sectors.append(row_of_g(values, **place))
    table += ring_rows("explicit", 1e4, strong)
    table += ring_rows("explicit, 10 Brownian times", 0.01, weak)
    table += ring_rows("implicit, 10 Brownian times", 0.01, weak_implicit)
    for name, rows in (("table", table), ("radial", radial), ("sectors", sectors)):
        write_rows(HERE / f"{name}.csv", rows, 5)
    draw(structures, radial)
    write_numbers(HERE / "numbers.csv", {TOUCHING: touching(structures[0.01])})


def map_rows(structure):
    """Returns rows (x, y, g) of the slice within 4 a, line by line."""
    g = structure.cells.sum(axis=0) / structure.ideal_of_cell.sum()
    wide = abs(structure.x) < 4
    half = [(x, y, v) for y, row in zip(structure.y, g) if y < 4 for x, v in zip(structure.x[wide], row[wide])]
    # The other half is the point reflection of this one.
    return [(-x, -y, v) for x, y, v in reversed(half)] + half


def draw(structures, radial):
    figure = Figure(HERE / "chart.png", columns=1, size=(1200, 760))
    square = {"x_range": (-4, 4), "y_range": (-4, 4), "grid": False}
    for k, (peclet, structure) in enumerate(structures.items()):
        place = 0.05 + 0.3 * k, 0.315 + 0.3 * k, 0.52, 0.94
        gradient = "" if k else "y / a (gradient)"
        panel = figure.panel("x / a (flow)", gradient, f"Pe = {peclet:g}", place=place, **square)
        scale = "g(x, y), |z| < 0.1 a" if k == len(structures) - 1 else None
        panel.image(map_rows(structure), MAP_COLOURS, scale)
    ends = {"x_range": (1.8, 5), "y_range": (0, None)}
    panel = figure.panel("r / a", "g(r)", "all directions", place=(0.05, 0.97, 0.08, 0.39), **ends)
    for ring in RINGS:
        panel.upright(ring)
    for peclet, colour in zip(structures, (BLUE, GREEN, RED)):
        rows = [(r["distance"], r["g"], 2 * r["standard_error"]) for r in radial if r["peclet"] == peclet]
        panel.points(rows, f"Pe = {peclet:g}", colour, size=0.5, joined=True)
    figure.draw()


def quick_measure(program):
    small = {"particles": {"count": 200}, "pair_distribution": {"range": 4}}
    weak, strong = (point_of(program, *run, small).rings()[2.0] for run in QUICK_RUNS)
    sharper = quotient(strong["sharpness"], weak["sharpness"])
    yield Statement("ring at 2 a: sharpness at Pe = 10^4 over that at 0.01", "L4.8", *sharper, 2, degrees=15)
    height = over(weak["height"], 0.5 * contact_value(FRACTION))
    text = "Pe = 0.01: height of the ring at 2 a over that of hard spheres in contact at rest"
    yield Statement(f"{text}, half of it within contact", "Mansoori et al.", *height, 0.6, 1.6, 15)
    text = "ring at 2 a, Pe = 0.01: compressive less extensional quadrant over their sum"
    yield Statement(text, "L4.8", *weak["anisotropy"], -0.2, 0.2, 15)
    yield Statement("ring at 2 a, Pe = 10^4: the same", "L4.8", *strong["anisotropy"], 0.05, 0.8, 15)


main(HERE, TITLE, measure, quick_measure, judge)
