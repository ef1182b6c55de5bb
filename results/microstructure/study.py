#!/usr/bin/python3
"""Where neighbours are in the plane of flow and gradient, from weak to strong flow.

study.py BIN [FOLDER] [--quick]
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import REFERENCE_SCENE, at_peclet, estimate, merged, write_table  # noqa: E402
from studies import Statement, data_block, gnuplot, main  # noqa: E402

TITLE = "Microstructure in the flow"
FRACTION, BIN = 0.5, 0.05
SCENE = merged(
    REFERENCE_SCENE,
    {
        "particles": {"count": 500},
        "volume_fraction": FRACTION,
        "observables": ["stress", "pair_distribution"],
        "pair_distribution": {"range": 5, "bin": BIN, "slab": 0.1},
    },
)
RINGS = (2.0, 2.4, 2.8)  # distances at which two small spheres touch, a small and a large one, two large ones
BROWNIAN = {"duration": {"equilibration": {"brownian_times": 40}, "production": {"brownian_times": 20}}}
SHEARED = {"duration": {"equilibration": {"strain": 2}, "production": {"strain": 6}}}
RUNS = ((0.01, 32, BROWNIAN), (1, 48, BROWNIAN), (1e4, 64, SHEARED))
QUICK_RUNS = (
    (0.01, 16, {"duration": {"equilibration": {"brownian_times": 4}, "production": {"brownian_times": 8}}}),
    (1e4, 16, {"duration": {"equilibration": {"strain": 1}, "production": {"strain": 8}}}),
)


def contact_value(fraction):
    """g of all pairs at the distance at which two small hard spheres touch: Boublik (1970) and Mansoori, Carnahan, Starling & Leland (1971),
    g_ij = 1 / (1 - z3) + 3 z2 / (1 - z3)^2 d + 2 z2^2 / (1 - z3)^3 d^2 with d = s_i s_j / (s_i + s_j), times the share of such pairs.
    """
    diameters, volumes = (2.0, 2.8), (0.5, 0.5)
    numbers = [v / s**3 for v, s in zip(volumes, diameters)]
    shares = [n / sum(numbers) for n in numbers]
    second, third = (sum(x * s**k for x, s in zip(shares, diameters)) for k in (2, 3))
    z2, d = fraction * second / third, diameters[0] / 2
    return shares[0] ** 2 * (
        1 / (1 - fraction) + 3 * z2 / (1 - fraction) ** 2 * d + 2 * z2**2 / (1 - fraction) ** 3 * d**2
    )


class Structure:
    """Of one point: by seed, counts and ideal counts."""

    def __init__(self, point):
        found = [r["mean"]["pair_distribution"] for r in point["realisations"] if r.get("mean")]
        self.seeds = len(found)
        self.radial = [f["radial"] for f in found]
        self.slices = [f["slice"] for f in found]
        self.distance, self.x, self.y = self.radial[0]["r"], self.slices[0]["x"], self.slices[0]["y"]

    def shell(self, low, high):
        """By seed, g averaged over the shell between two distances."""
        chosen = [k for k, r in enumerate(self.distance) if low < r < high]
        return [sum(seed["counts"][k] for k in chosen) / sum(seed["ideal"][k] for k in chosen) for seed in self.radial]

    def quadrants(self, ring):
        """By seed, g of the slice at the ring where the flow compresses (x y < 0) and where it extends."""
        chosen = [
            (row, column, self.x[column] > 0)
            for row, y in enumerate(self.y)
            for column, x in enumerate(self.x)
            if abs(math.hypot(x, y) - ring) < BIN
        ]
        size = len(chosen) / 2
        return [
            tuple(
                sum(seed["counts"][row][column] for row, column, extends in chosen if extends == which)
                / (size * seed["ideal"])
                for which in (False, True)
            )
            for seed in self.slices
        ]

    def sectors(self, ring, count=12):
        """By seed, g of the slice at the ring in equal sectors of the angle from the flow to minus it, over the gradient."""
        chosen = [[] for _ in range(count)]
        for row, y in enumerate(self.y):
            for column, x in enumerate(self.x):
                if abs(math.hypot(x, y) - ring) < BIN:
                    chosen[int(math.atan2(y, x) / math.pi * count)].append((row, column))
        return [
            [
                sum(seed["counts"][row][column] for row, column in sector) / (len(sector) * seed["ideal"])
                for sector in chosen
            ]
            for seed in self.slices
        ]

    def ring(self, ring):
        """By seed: g within 0.05 a of the distance; that just outside of it over the larger one 0.1 a before and after; its sharpness, the first
        over g from 0.05 to 0.15 a beyond; and in the slice the compressive less the extensional quadrant, and that over their sum.
        """
        height, beyond = self.shell(ring - BIN, ring + BIN), self.shell(ring + BIN, ring + 3 * BIN)
        edge = self.shell(ring, ring + BIN)
        around = zip(self.shell(ring - 2 * BIN, ring - BIN), self.shell(ring + 2 * BIN, ring + 3 * BIN))
        quadrants = self.quadrants(ring)
        return {
            "height": height,
            "prominence": [e / max(pair) for e, pair in zip(edge, around)],
            "sharpness": [h / b for h, b in zip(height, beyond)],
            "difference": [c - e for c, e in quadrants],
            "anisotropy": [(c - e) / (c + e) for c, e in quadrants],
        }


def rings_of(structure):
    return {ring: {name: estimate(values) for name, values in structure.ring(ring).items()} for ring in RINGS}


def point_of(program, number, seeds, duration, patch=None, name=None):
    scene = merged(SCENE, {**at_peclet(number), **duration, **(patch or {})})
    return Structure(program.run(name or f"microstructure-{number:g}", scene, [{"/peclet": number}], seeds)[0])


def quotient(a, b):
    return a[0] / b[0], abs(a[0] / b[0]) * math.hypot(a[1] / a[0], b[1] / b[0])


def difference(a, b):
    return a[0] - b[0], math.hypot(a[1], b[1])


def growth_statements(found, degrees):
    """`found`: by Pe, the rings."""
    weak, strong = min(found), max(found)
    between = [n for n in found if weak < n < strong]
    for ring in RINGS:
        lowest = min(found, key=lambda n: found[n][ring]["prominence"][0])
        yield Statement(
            f"ring at {ring:g} a: g there over that 0.1 a before and after, the least of all Pe (Pe = {lowest:g})",
            "L4.8",
            *found[lowest][ring]["prominence"],
            1,
            degrees=degrees,
        )
    for ring in RINGS:
        yield Statement(
            f"ring at {ring:g} a: sharpness at Pe = {strong:g} over that at {weak:g}",
            "L4.8",
            *quotient(found[strong][ring]["sharpness"], found[weak][ring]["sharpness"]),
            1,
            degrees=degrees,
        )
        for middle in between:
            yield Statement(
                f"ring at {ring:g} a: sharpness at Pe = {middle:g} over that at {weak:g}",
                "L4.8",
                *quotient(found[middle][ring]["sharpness"], found[weak][ring]["sharpness"]),
                1,
                degrees=degrees,
                essential=False,
            )
    numbers = sorted(found)
    for ring in RINGS[:2]:
        yield Statement(
            f"ring at {ring:g} a, Pe = {weak:g}: compressive less extensional quadrant over their sum",
            "L4.8",
            *found[weak][ring]["anisotropy"],
            -0.05,
            0.05,
            degrees,
        )
        for low, high in zip(numbers, numbers[1:]):
            yield Statement(
                f"ring at {ring:g} a: compressive less extensional g at Pe = {high:g} less that at {low:g}",
                "L4.8",
                *difference(found[high][ring]["difference"], found[low][ring]["difference"]),
                0,
                degrees=degrees,
            )
        for middle in between:
            yield Statement(
                f"ring at {ring:g} a: the same over their sum at Pe = {strong:g} less that at {middle:g}",
                "L4.8",
                *difference(found[strong][ring]["anisotropy"], found[middle][ring]["anisotropy"]),
                0,
                degrees=degrees,
                essential=False,
            )


def measure(program):
    structures = {number: point_of(program, number, seeds, duration) for number, seeds, duration in RUNS}
    found = {number: rings_of(s) for number, s in structures.items()}
    explicit = {"integrator": {"method": "explicit"}}
    strong = rings_of(point_of(program, 1e4, 4, SHEARED, explicit, "microstructure-explicit-10000"))
    # Explicit steps do not reach equilibrium here; both methods from the same packings over the same time.
    short = {"duration": {"equilibration": {"brownian_times": 5}, "production": {"brownian_times": 5}}}
    weak = rings_of(point_of(program, 0.01, 8, short, explicit, "microstructure-explicit-0.01"))
    weak_implicit = rings_of(point_of(program, 0.01, 16, short, None, "microstructure-short-0.01"))
    table = [
        {
            "method": method,
            "peclet": number,
            "distance": ring,
            **{
                f"{name}{suffix}": value[k]
                for name, value in quantities.items()
                for k, suffix in enumerate(("", "_error"))
            },
        }
        for method, number, rings in (
            *(("implicit", number, rings) for number, rings in found.items()),
            ("explicit", 1e4, strong),
            ("explicit, 10 Brownian times", 0.01, weak),
            ("implicit, 10 Brownian times", 0.01, weak_implicit),
        )
        for ring, quantities in rings.items()
    ]
    write_table(os.path.join(HERE, "table.csv"), list(table[0]), table, 5)
    radial = []
    for number, structure in structures.items():
        for k, r in enumerate(structure.distance):
            mean, error = estimate([seed["counts"][k] / seed["ideal"][k] for seed in structure.radial])
            radial.append({"peclet": number, "distance": r, "g": mean, "standard_error": error})
    write_table(os.path.join(HERE, "radial.csv"), list(radial[0]), radial, 5)
    write_table(
        os.path.join(HERE, "sectors.csv"),
        ["peclet", "distance", "from_degrees", "g", "standard_error"],
        sectors_of(structures),
        5,
    )
    draw(structures, radial)
    touching, error = estimate(
        [
            sum(s["counts"][k] for k, r in enumerate(s["r"]) if r < 2 + BIN)
            / sum(s["ideal"][k] for k, r in enumerate(s["r"]) if 2 < r < 2 + BIN)
            for s in structures[0.01].radial
        ]
    )
    expected = contact_value(FRACTION)
    return [
        *growth_statements(found, min(s.seeds for s in structures.values()) - 1),
        Statement(
            "Pe = 0.01: g up to 0.05 a beyond contact over that of hard spheres in contact at rest, from which it falls",
            "Mansoori et al.",
            touching / expected,
            error / expected,
            0.8,
            1,
            structures[0.01].seeds - 1,
            essential=False,
        ),
        Statement(
            "Pe = 10^4: ring at 2 a by implicit steps over that by explicit ones",
            "method",
            *quotient(found[1e4][2.0]["height"], strong[2.0]["height"]),
            0.9,
            1.1,
            4 * program.times - 1,
        ),
        Statement(
            "Pe = 0.01: ring at 2 a by implicit steps over that by explicit ones",
            "method",
            *quotient(weak_implicit[2.0]["height"], weak[2.0]["height"]),
            0.9,
            1.1,
            8 * program.times - 1,
        ),
    ]


def sectors_of(structures):
    for number, structure in structures.items():
        for ring in RINGS:
            columns = [*zip(*structure.sectors(ring))]
            for k, values in enumerate(columns):
                mean, error = estimate(values)
                yield {
                    "peclet": number,
                    "distance": ring,
                    "from_degrees": 180 * k / len(columns),
                    "g": mean,
                    "standard_error": error,
                }


def draw(structures, radial):
    lines = [
        "set terminal pngcairo size 1200, 760 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot",
        "set palette defined (0 '#ffffff', 0.5 '#c8daf0', 1 '#7fb0d8', 2 '#2060b0', 4 '#301860', 8 '#100020')",
        "set cbrange [0:8]; set xrange [-4:4]; set yrange [-4:4]; set size ratio -1",
    ]
    for k, (number, structure) in enumerate(structures.items()):
        ideal = sum(s["ideal"] for s in structure.slices)
        total = [
            [sum(s["counts"][row][column] for s in structure.slices) / ideal for column in range(len(structure.x))]
            for row in range(len(structure.y))
        ]
        rows = [
            (x, y, g)
            for y, values in zip(structure.y, total)
            for x, g in zip(structure.x, values)
            if abs(x) < 4 and y < 4
        ]
        # The other half is the image in the origin; an image plot wants its rows in order.
        lines += data_block(f"m{k}", [*((-x, -y, g) for x, y, g in reversed(rows)), *rows])
    for k, number in enumerate(structures):
        lines += [
            f"set lmargin at screen {0.05 + 0.3 * k}; set rmargin at screen {0.315 + 0.3 * k}; set bmargin at screen 0.52; set tmargin at screen 0.94",
            f"set title 'Pe = {number:g}'; set xlabel 'x / a (flow)'; set ylabel '{'y / a (gradient)' if k == 0 else ''}'",
            f"{'set colorbox; set cblabel `g(x, y), |z| < 0.1 a`' if k == 2 else 'unset colorbox'}; plot $m{k} using 1:2:3 with image notitle".replace(
                "`", "'"
            ),
        ]
    colours = ("#2060b0", "#308030", "#c03028")
    for k, number in enumerate(structures):
        lines += data_block(
            f"r{k}", [(r["distance"], r["g"], 2 * r["standard_error"]) for r in radial if r["peclet"] == number]
        )
    lines += [
        "set lmargin at screen 0.05; set rmargin at screen 0.97; set bmargin at screen 0.08; set tmargin at screen 0.39; set size noratio; set title 'all directions'; set grid lc rgb '#d8d8d8'; set xlabel 'r / a'; set ylabel 'g(r)'; set xrange [1.8:5]; set yrange [0:*]"
    ]
    lines += [f"set arrow {k + 1} from {ring}, graph 0 to {ring}, graph 1 nohead dt 3" for k, ring in enumerate(RINGS)]
    lines.append(
        "plot "
        + ", ".join(
            f"$r{k} using 1:2:3 with yerrorlines pt 7 ps 0.5 lc rgb '{colour}' title 'Pe = {number:g}'"
            for k, (number, colour) in enumerate(zip(structures, colours))
        )
    )
    gnuplot(lines)


def quick_measure(program):
    small = {"particles": {"count": 200}, "pair_distribution": {"range": 4}}
    found = {
        number: rings_of(point_of(program, number, seeds, duration, small)) for number, seeds, duration in QUICK_RUNS
    }
    weak, strong = found[0.01][2.0], found[1e4][2.0]
    return [
        Statement(
            "ring at 2 a: sharpness at Pe = 10^4 over that at 0.01",
            "L4.8",
            *quotient(strong["sharpness"], weak["sharpness"]),
            2,
            degrees=15,
        ),
        Statement(
            "Pe = 0.01: height of the ring at 2 a over that of hard spheres in contact at rest, half of it within contact",
            "Mansoori et al.",
            weak["height"][0] / (0.5 * contact_value(FRACTION)),
            weak["height"][1] / (0.5 * contact_value(FRACTION)),
            0.6,
            1.6,
            15,
        ),
        Statement(
            "ring at 2 a, Pe = 0.01: compressive less extensional quadrant over their sum",
            "L4.8",
            *weak["anisotropy"],
            -0.2,
            0.2,
            15,
        ),
        Statement("ring at 2 a, Pe = 10^4: the same", "L4.8", *strong["anisotropy"], 0.05, 0.8, 15),
    ]


main(HERE, TITLE, measure, quick_measure)
