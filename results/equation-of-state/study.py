#!/usr/bin/python3
"""The pressure of Brownian spheres at rest, compared with the equation of state of hard spheres."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, RED, REFERENCE_SCENE, column, entries, groups
from studies.driver import in_brownian_times, main, merged, number, over, read_rows, weighted_mean, where, write_rows

TITLE = "The pressure at rest"
FRACTIONS = (0.20, 0.30, 0.40, 0.45, 0.50)
THERMAL_ENERGY, STIFFNESS = 0.017, 1e4  # of the published table
SIZES = {"one": (1.0,), "1 : 1.4": (1.0, 1.4)}  # radii, in equal volumes
STEPS = (1, 0.25)  # in units of the automatic step
SEEDS = {1: 32, 0.25: 16}
DENSEST = 4  # factor of the seeds at the largest volume fraction and the automatic step, which deviates most
WIDTH = 0.01  # bound of the relative deviation
SCENE = merged(
    REFERENCE_SCENE,
    in_brownian_times(30, 60),
    particles={"count": 250},
    flow={"shear_rate": 0},
    fluid={"thermal_energy": THERMAL_ENERGY},
    contact={"normal_stiffness": STIFFNESS},
)


def species(radii):
    return [{"radius": a, "volume_share": 1 / len(radii)} for a in radii]


def hard_pressure(fraction, radii, softness=0.0):
    """Returns P / (n kT) of hard spheres of these radii in equal volumes, to 0.3 % up to a volume fraction of 0.5:
    Boublik (1970), J. Chem. Phys. 53, 471; Mansoori, Carnahan, Starling & Leland (1971), J. Chem. Phys. 54, 1523.

    All diameters are reduced by `softness`, at the same number density.
    """
    weights = [a**-3 for a in radii]
    shares = [w / sum(weights) for w in weights]
    full = sum(x * (2 * a) ** 3 for x, a in zip(shares, radii))
    m1, m2, m3 = (sum(x * (2 * a - softness) ** k for x, a in zip(shares, radii)) for k in (1, 2, 3))
    packed = fraction * m3 / full
    void = 1 - packed
    pairs = 3 * packed * m1 * m2 / (m3 * void**2)
    return 1 / void + pairs + packed**2 * (3 - packed) * m2**3 / (m3**2 * void**3)


def softness():
    """Returns the reduction of the effective diameter by soft contacts: the integral of exp(-U / kT) over the overlap,
    U = k_n overlap^2 / 2 (Barker & Henderson 1967, J. Chem. Phys. 47, 4714)."""
    return math.sqrt(math.pi * THERMAL_ENERGY / (2 * STIFFNESS))


def number_density(fraction, radii):
    weights = [a**-3 for a in radii]
    return fraction / sum(w / sum(weights) * 4 / 3 * math.pi * a**3 for w, a in zip(weights, radii))


def row_of(program, sizes, fraction, step, seeds, patch):
    radii = SIZES[sizes]
    scene = merged(SCENE, patch, particles={"species": species(radii)}, volume_fraction=fraction)
    if step != 1:
        # The automatic step of this scene, not shortened to its windows.
        scene["integrator"] = program.part_of_step(step, scene, "pressure")
    name = f"{'one' if len(radii) == 1 else 'two'}-{fraction:g}-{step:g}"
    (point,) = program.run(name, scene, [{"/volume_fraction": fraction}], seeds, "pressure")
    expected = number_density(fraction, radii) * THERMAL_ENERGY * hard_pressure(fraction, radii, softness())
    row = {"sizes": sizes, "fraction": fraction, "step": step, "seeds": len(point.results)}
    row |= {"hard": hard_pressure(fraction, radii), "soft": hard_pressure(fraction, radii, softness())}
    return row | entries("ratio", over(point.measured("pressure"), expected))


def measure(program):
    rows = [
        row_of(program, sizes, fraction, step, SEEDS[step] * (DENSEST if fraction == 0.50 and step == 1 else 1), {})
        for step in STEPS
        for sizes in SIZES
        for fraction in FRACTIONS
    ]
    write_rows(HERE / "table.csv", rows, 5)


def named(step):
    return "automatic step" if step == 1 else "a quarter of the step"


def judged(row, width):
    text = f"sizes {row['sizes']}, φ = {row['fraction']:g}, {named(row['step'])}: pressure over that of the equation"
    return Check(text, "exact", *number(row, "ratio"), 1 - width, 1 + width, row["seeds"] - 1)


def judge():
    table = read_rows(HERE / "table.csv")
    for row in table:
        yield judged(row, WIDTH)
    for step, of_step in groups(table, "step").items():
        for words, rows in {"": of_step, **{f", sizes {s}": where(of_step, sizes=s) for s in SIZES}}.items():
            mean, error = weighted_mean(column(rows, "ratio"), column(rows, "ratio_error"))
            text = f"{named(step)}{words}: pressure above that of the equation, %, weighted mean of {len(rows)}"
            yield Finding(text, "exact", 100 * (mean - 1), 100 * error, len(rows) - 1)


def draw():
    table = read_rows(HERE / "table.csv")
    figure = Figure(HERE / "chart.png", columns=2, size=(1000, 420))
    for sizes in SIZES:
        panel = figure.panel("φ", "P over that of the equation of state", f"sizes {sizes}", y_range=(0.97, 1.03))
        panel.box(None, None, 0.99, 1.01, "#eef4e8")
        for step, colour, shift in ((1, BLUE, -0.002), (0.25, RED, 0.002)):
            rows = where(table, sizes=sizes, step=step)
            points = [(r["fraction"] + shift, *number(r, "ratio")) for r in rows]
            panel.points(points, "automatic step" if step == 1 else "a quarter of it", colour)
    figure.draw()


def quick_measure(program):
    yield judged(row_of(program, "1 : 1.4", 0.30, 1, 8, in_brownian_times(15, 60)), 0.03)


main(HERE, TITLE, measure, quick_measure, judge, draw)
