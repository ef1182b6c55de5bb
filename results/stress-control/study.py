#!/usr/bin/python3
"""Flow at a given stress: comparison with a given rate, with and without noise; diffusion of the strain; and
discontinuous shear thickening, which a given rate skips."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREEN, ORANGE, RED, REFERENCE_SCENE, during, entries, estimate
from studies.driver import exact_rows, in_brownian_times, in_strains, main, merged, number, propagated, quotient
from studies.driver import read_numbers, read_rows, row_ratio, scaled, where, write_numbers, write_rows

TITLE = "Flow at a given stress"
# Lengths are in radii, viscosities over the solvent's. The unit of force is the critical load for grains; the unit of
# energy is kT for colloids.
COMMON = {"particles": {"count": 200, "density": 1e-3}, "fluid": {"viscosity": 1}, "flow": None, "duration": None}
GRAINS = merged(
    REFERENCE_SCENE, COMMON, contact={"normal_stiffness": 5e4, "friction": 1, "critical_load": 1}, volume_fraction=0.5
)
COLLOIDS = merged(
    REFERENCE_SCENE, COMMON, contact={"normal_stiffness": 5e5}, fluid={"thermal_energy": 1}, volume_fraction=0.45
)
SEEDS = {"grains": 10, "colloids": 10}
# Rates, and expected viscosities, which give the time for a strain of ten.
RATES = {
    "grains": {0.002: 25, 0.005: 35, 0.01: 50, 0.03: 60, 0.1: 65},
    "colloids": {0.3: 9, 1: 8.5, 3: 8, 10: 8, 30: 9},
}
STRAIN = 10
THICKENING = {0.50: (700, 3), 0.54: (2000, 3), 0.56: (4000, 3), 0.57: (4000, 3)}  # stress times of the window, seeds
JUMPING = 0.56  # volume fraction at which rates are given, too
STRESSES = (0.1, 0.2, 0.4, 0.8, 2)
# Published onset of discontinuous thickening for spheres of two sizes with a critical load and friction 1.
PUBLISHED_ONSET = 0.56
RATES_OF_THICKENING = (0.0003, 0.0005, 0.0008, 0.0012, 0.002, 0.004)
DIFFUSING, DIFFUSION_SEEDS, DIFFUSION_WINDOW = 0.30, 24, 200
THERMAL_ENERGY, VISCOSITY = 0.017, 0.1  # as in the study at-rest


def rate_row(program, kind, scene, rate, seeds):
    settings = {"/flow/shear_rate": rate}
    (point,) = program.run(f"{kind}-rate-{rate:g}", merged(scene, in_strains(3, STRAIN)), [settings], seeds)
    seeds = len(point.results)
    row = {"kind": kind, "fraction": scene["volume_fraction"], "control": "rate", "at": rate, "seeds": seeds}
    return row | entries("viscosity", point.measured("relative_viscosity")) | {"flowing": 1.0}


def stress_row(program, kind, scene, stress, times, seeds):
    """Returns the row of a stress. The viscosity includes all realisations; a jammed one has the rate 0."""
    name = f"{kind}-stress-{scene['volume_fraction']:g}-{stress:g}"
    scene = merged(scene, during({"stress_times": 0.3 * times}, {"stress_times": times}))
    (point,) = program.run(name, scene, [{"/flow/stress": stress}], seeds, "shear_rate")
    means, rate = point.means, point.measured("shear_rate")
    row = {"kind": kind, "fraction": scene["volume_fraction"], "control": "stress", "at": stress, "seeds": len(means)}
    row |= entries("viscosity", quotient((stress, 0), rate) if rate[0] > 0 else (math.inf, math.inf))
    flowing = [math.nan if m["flowing"] is None else m["flowing"] for m in means]  # null in short windows
    return row | {"flowing": sum(flowing) / len(means)}


def measure(program):
    rows = []
    for kind, scene in (("grains", GRAINS), ("colloids", COLLOIDS)):
        for rate, expected in RATES[kind].items():
            rows.append(rate_row(program, kind, scene, rate, SEEDS[kind]))
            stress = float(f"{rows[-1]['viscosity'] * rate:.4g}")
            rows.append(stress_row(program, kind, scene, stress, STRAIN * expected, SEEDS[kind]))
    measure_diffusion(program)
    for fraction, (times, seeds) in THICKENING.items():
        scene = merged(GRAINS, volume_fraction=fraction)
        for stress in STRESSES:
            rows.append(stress_row(program, "thickening", scene, stress, times, seeds))
    densest = merged(GRAINS, volume_fraction=JUMPING)
    for rate in RATES_OF_THICKENING:
        rows.append(rate_row(program, "thickening", densest, rate, 4))
    write_rows(HERE / "table.csv", rows, 5)


def measure_diffusion(program):
    """Measures the diffusion of the strain at almost zero stress from the strains of blocks, D = <strain^2> / (2 t)."""
    scene = merged(
        REFERENCE_SCENE,
        {"duration": None},
        in_brownian_times(50, DIFFUSION_WINDOW),
        particles={"count": 100},
        volume_fraction=DIFFUSING,
        flow=None,
        fluid={"thermal_energy": THERMAL_ENERGY},
    )
    program.run("diffusion", scene, [{"/flow/stress": 1e-9}], DIFFUSION_SEEDS, "shear_rate")
    (results,) = program.stored_results("diffusion")
    squares = []
    for result in results:
        time = result["time"]["production"] / 32
        squares.append(sum((rate * time) ** 2 for rate in result["blocks"]["shear_rate"]) / 32 / (2 * time))
    cubes = [r**3 for r in (1.0, 1.4)]
    # 100 spheres; each size has half of the volume.
    shares = [1 / c for c in cubes]
    volume = 100 * sum(shares[k] / sum(shares) * cubes[k] for k in range(2)) * 4 / 3 * math.pi / DIFFUSING
    diffusion = estimate([s * volume * VISCOSITY / THERMAL_ENERGY for s in squares])
    write_numbers(HERE / "diffusion.csv", {"diffusion": (*diffusion, len(squares) - 1)})


def pairs_of(rows, kind):
    """Returns pairs of rows at the same stress: at a given rate, and at a given stress."""
    mine = where(rows, kind=kind)
    return list(zip(mine[::2], mine[1::2]))


def curve_of(rows, fraction):
    return where(rows, kind="thickening", fraction=fraction, control="stress")


def flowing(curve):
    """Returns the rows of which no seed jams; a jammed one has no viscosity."""
    return [row for row in curve if row["flowing"] == 1]


def slopes(rows, fraction):
    """Yields stress, d ln viscosity / d ln stress and its error between neighbours of the curve at given stresses."""
    curve = flowing(curve_of(rows, fraction))
    for low, high in zip(curve, curve[1:]):
        width = math.log(high["at"] / low["at"])
        value = math.log(high["viscosity"] / low["viscosity"]) / width
        error = math.hypot(*(r["viscosity_error"] / r["viscosity"] for r in (low, high))) / width
        yield math.sqrt(low["at"] * high["at"]), value, error


def judge():
    rows = read_rows(HERE / "table.csv")
    for kind, unit in (("grains", "F_CL/ηa²"), ("colloids", "kT/ηa³")):
        for by_rate, by_stress in pairs_of(rows, kind):
            ratio = row_ratio(by_stress, by_rate, "viscosity")
            text = f"{kind}, rate {by_rate['at']:g} {unit}: viscosity at the stress over that at the rate"
            yield Check(text, "both controls", *ratio, 0.92, 1.08, by_rate["seeds"] - 1)
        ratios = [row_ratio(b, a, "viscosity") for a, b in pairs_of(rows, kind)]
        mean = propagated(ratios, lambda values: sum(values) / len(values))
        yield Finding(f"{kind}: mean of these five ratios", "both controls", *mean)
    value, error, degrees = read_numbers(HERE / "diffusion.csv")["diffusion"]
    exact = exact_rows()[DIFFUSING]
    product = value * exact["viscosity"], math.hypot(error * exact["viscosity"], value * exact["viscosity_error"])
    text = f"φ = {DIFFUSING:g}: D V η η_r / kT of the strain, η_r by linear response"
    yield Check(text, "fluctuation and dissipation", *product, 0.85, 1.15, degrees)
    steep = {fraction: max(slopes(rows, fraction), key=lambda slope: slope[1]) for fraction in THICKENING}
    onset = onset_of(steep)
    if onset:
        text = "discontinuous from this φ on, where d ln η / d ln σ is 1 at its steepest"
        source = "Mari et al. 2014: about 0.56"
        yield Check(text, source, *onset, PUBLISHED_ONSET - 0.015, PUBLISHED_ONSET + 0.015, 10)
    for fraction in sorted(THICKENING, key=lambda f: steep[f][1] >= 1):
        stress, value, error = steep[fraction]
        text = f"φ = {fraction:.2f}: largest d ln η / d ln σ, at σ = {stress:.2g} F_CL/a²"
        yield Finding(text, "steepness", value, error)
    for fraction in THICKENING:
        curve = curve_of(rows, fraction)
        seeds = sum(r["seeds"] for r in curve)
        share = sum(r["flowing"] * r["seeds"] for r in curve) / seeds
        error = math.sqrt(share * (1 - share) / seeds)
        yield Finding(f"φ = {fraction:.2f}: share of seeds that flow", "jamming", share, error)
    for row in flowing(where(rows, kind="thickening", fraction=JUMPING)):
        if row["seeds"] > 1:
            text = f"φ = {JUMPING:.2f}, at a {row['control']} of {row['at']:g}: viscosity"
            yield Finding(text, "jump", *number(row, "viscosity"), row["seeds"] - 1)


def onset_of(steep):
    """Returns the volume fraction at which the steepest slope is 1, interpolated linearly, and its error; or None."""
    fractions = sorted(steep)
    for low, high in zip(fractions, fractions[1:]):
        (_, a, of_a), (_, b, of_b) = steep[low], steep[high]
        if a < 1 <= b:
            part, width = (1 - a) / (b - a), high - low
            return low + part * width, width * math.hypot((1 - part) * of_a, part * of_b) / (b - a)
    return None


def draw():
    rows = read_rows(HERE / "table.csv")
    figure = Figure(HERE / "chart.png", columns=3, size=(1500, 480))
    ends = {"y_range": (10, 3e4), "key": "top left"}
    one = figure.panel("σ a²/F_{CL}", "η_r", "φ = 0.50 to 0.57, friction 1; above: seeds jam", log="xy", **ends)
    for fraction, colour, height in zip(THICKENING, (BLUE, GREEN, ORANGE, RED), (3e3, 6e3, 1.2e4, 2e4)):
        curve = curve_of(rows, fraction)
        one.rows(flowing(curve), "at", "viscosity", f"at a stress, {fraction:.2f}", colour, joined=True)
        one.points([(r["at"], height, 0) for r in curve if r not in flowing(curve)], None, colour, 9)
    by_rate = [(r["at"] * r["viscosity"], *number(r, "viscosity")) for r, _ in pairs_of(rows, "grains")]
    one.points(by_rate, "at a rate, 0.50", BLUE, 6)
    two = figure.panel("γ̇ ηa²/F_{CL}", "σ a²/F_{CL}", f"φ = {JUMPING:.2f}", log="xy", key="top left", powers="y")
    points = [(r["at"] / r["viscosity"], r["at"], 0) for r in flowing(curve_of(rows, JUMPING))]
    two.points(points, "at a stress", ORANGE, joined=True)
    by_rate = where(rows, kind="thickening", fraction=JUMPING, control="rate")
    two.points([(r["at"], *scaled(number(r, "viscosity"), r["at"])) for r in by_rate], "at a rate", BLUE, 6)
    title = "both controls"
    three = figure.panel(
        "Pe, and rate in 10⁻³ F_{CL}/ηa²", "η_r at the stress over at the rate", title, log="x", y_range=(0.9, 1.1)
    )
    three.level(1)
    for kind, factor, name, colour in (
        ("colloids", 6 * math.pi, "colloids, φ = 0.45, no friction", BLUE),
        ("grains", 1e3, "grains, φ = 0.50, friction 1", RED),
    ):
        points = [(a["at"] * factor, *row_ratio(b, a, "viscosity")) for a, b in pairs_of(rows, kind)]
        three.points(points, name, colour)
    figure.draw()


def quick_measure(program):
    """Yields checks of a short run: the mean stress is the given one, and the viscosity is that of shear."""
    scene = merged(GRAINS, particles={"count": 50}, volume_fraction=0.3)
    scene = merged(scene, during({"stress_times": 1}, {"stress_times": 10}))
    (point,) = program.run("quick", scene, [{"/flow/stress": 2}], 4, "shear_rate")
    means = [r["mean"] for r in point["realisations"]]
    held = estimate([m["stress"]["total"][3] / 2 for m in means])
    yield Check("σ over the stress that is asked", "stress control", *held, 0.999, 1.001, 3)
    viscosity = quotient((2, 0), estimate([m["shear_rate"] for m in means]))
    yield Check("φ = 0.3: η_r at a stress", "that of shear", *viscosity, 2.2, 4.5, 3)


main(HERE, TITLE, measure, quick_measure, judge, draw)
