#!/usr/bin/python3
"""Colloids and grains with noise and friction: flow curves as grains are added to colloids, and colloids to grains
(Li 2023, Figs 5.2, 5.3 a, b and 5.6)."""
import itertools
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.compositions import ALIKE, ALIKE_NOISE, MIXTURE_SCENE, NOISE, STIFFNESS, THERMAL_ENERGY, alike
from studies.compositions import colloids_added, composition_row, grains_added, mean_peclet, setting_of, windows
from studies.driver import BLUE, Check, Figure, Finding, FLOWING, GREEN, GREY, JAMMED, ORANGE, PURPLE, RED, Statement
from studies.driver import decades_of_rise, difference, estimate, in_brownian_times, log_minimum, log_of_rise
from studies.driver import log_of_share, logarithm, main, merged, number, over, place_of_largest, propagated
from studies.driver import propagated_lists, quotient, read_numbers, read_rows, row_ratio, viscosity_row, where
from studies.driver import write_numbers, write_table
import numpy as np

TITLE = "Colloids and grains with noise"
SCENE = merged(MIXTURE_SCENE, contact={"friction": 1})
NOISY = merged(SCENE, NOISE)
STIFFER = 4  # factor between the stiffnesses of two parts that are compared
SOFTER = STIFFNESS / STIFFER
# Number of spheres with about thirty grains (20 at 0.4, 13 at 0.3), by the share of the grains in the spheres' volume.
COUNTS = {0: 1000, 0.3: 4000, 0.4: 4000, 0.5: 4000, 0.6: 3000, 0.7: 2000, 0.8: 1500, 0.9: 1000, 1: 1000}
COLLOIDS_ADDED, GRAINS_ADDED = (1, 0.9, 0.8, 0.7, 0.6, 0.5), (0, 0.3, 0.4, 0.5)
SLOW_ADDED = COLLOIDS_ADDED[:4]  # shares at the smallest Peclet number, at which a strain takes ten times as long
BASE, DENSE = 0.55, 0.60  # volume fractions before addition
NUMBERS = (0.1, 1, 10, 100, 1e3, 1e5)  # Peclet numbers of the colloids
FRACTION, SHARES = 0.565, (0, 0.5, 0.7, 1)  # a constant volume fraction, and its shares of grains
SLOW_MEANS = (0.3, 1)  # Peclet numbers of the mean radius, for single groups only: a strain of mixtures takes long
MEANS = (3, 10, 30, 100, 1e3, 1e5)  # Peclet numbers of the mean radius at this volume fraction
HARD, HARD_SHARES = {f"dense-{factor}": factor for factor in (STIFFER, STIFFER**2)}, (1, 0.8, 0.7)
# A point that is jammed here and flows in print, and a later and longer window of it.
DISPUTED, LATE = (0.7, 100), {"/duration/equilibration/strain": 3, "/duration/production/strain": 3}
SEEDS, BARE_SEEDS = 4, 16  # the second without noise
# Seeds at one volume fraction, and at Peclet numbers of the colloids that are compared with other contacts; errors from
# four seeds of few grains are too small.
FRACTION_SEEDS, MORE_SEEDS, MORE_NUMBERS = 8, 12, (1, 1e3)
# The first steps as colloids are added are small: more seeds, and more spheres, because 1000 have few grains.
FIRST, FIRST_TIMES = (1, 0.9), 4
# Stiffness, Peclet numbers, and seeds with noise and without.
FIRST_PARTS = {"first": (STIFFNESS, NUMBERS[1:], 16, 32), "first-hard": (STIFFER * STIFFNESS, NUMBERS[1:-1], 8, 16)}
FAST, FAST_SEEDS = (1e4, 1e5), 64  # Peclet numbers between which colloids alone no longer thicken


def rows_of(program, part, cases, stiffness=STIFFNESS, count_times=1, besides=None, seeds=SEEDS):
    """Yields rows for cases (share of grains, volume fraction, Peclet number of the colloids)."""
    settings = []
    for alpha, fraction, peclet in cases:
        more, count = {**windows(alpha, peclet), **(besides or {})}, round(count_times * COUNTS[alpha])
        settings.append(setting_of(alpha, count, round(fraction, 4), stiffness, peclet, more))
    scene = NOISY if math.isfinite(cases[0][2]) else SCENE
    for case, setting, point in zip(cases, settings, program.run(part, scene, settings, seeds)):
        yield {
            "part": part,
            **composition_row(setting),
            **dict(zip(("alpha", "fraction", "peclet"), case)),
            "mean peclet": mean_peclet(case[0], case[2]),
            **viscosity_row(point, "contacts_per_particle"),
            "overlap": max((r["largest_overlap"] for r in point.results), default=math.nan),
        }


def line(base, numbers, shares=COLLOIDS_ADDED, fraction=colloids_added):
    return [(alpha, fraction(alpha, base), peclet) for peclet in numbers for alpha in shares]


def disputed_rows(program):
    """Yields rows of the disputed point with twice the spheres, a sixteenth of the step, and a late window."""
    alpha, peclet = DISPUTED
    cases, stiffness = [(alpha, colloids_added(alpha, DENSE), peclet)], STIFFER * STIFFNESS
    yield from rows_of(program, "disputed-size", cases, stiffness, count_times=2)
    particles, contact = {"count": COUNTS[alpha], "mixture": {"alpha": alpha}}, {"normal_stiffness": stiffness}
    scene = merged(NOISY, particles=particles, contact=contact, volume_fraction=cases[0][1], peclet=peclet)
    fine = {"/integrator": program.part_of_step(1 / 16, scene)}
    yield from rows_of(program, "disputed-step", cases, stiffness, besides=fine)
    yield from rows_of(program, "disputed-late", cases, stiffness, besides=LATE)


def first_steps(program):
    """Yields rows of grains alone and of the first colloids among them."""
    for name, (stiffness, numbers, seeds, bare_seeds) in FIRST_PARTS.items():
        cases, bare = line(BASE, numbers, FIRST), line(BASE, (math.inf,), FIRST)
        yield from rows_of(program, name, cases, stiffness, FIRST_TIMES, seeds=seeds)
        yield from rows_of(program, f"{name}-bare", bare, stiffness, FIRST_TIMES, seeds=bare_seeds)


def parts(program):
    fast = NUMBERS[1:]
    middle = (0.7, colloids_added(0.7, BASE))
    yield from rows_of(program, "colloids-added", line(BASE, [p for p in fast if p not in MORE_NUMBERS]))
    yield from rows_of(program, "colloids-added-more", line(BASE, MORE_NUMBERS), seeds=MORE_SEEDS)
    yield from rows_of(program, "colloids-added-soft", line(BASE, (1,)), SOFTER, seeds=MORE_SEEDS)
    for stiffness, name in ((STIFFNESS, "dense"), (SOFTER, "dense-soft")):
        yield from rows_of(program, name, line(DENSE, (1, 100)), stiffness)
    # Mixtures that flow with hard contacts may look jammed with soft ones.
    for name, factor in HARD.items():
        yield from rows_of(program, name, line(DENSE, (1, 100), HARD_SHARES), factor * STIFFNESS)
    yield from disputed_rows(program)
    yield from rows_of(program, "no-noise", line(BASE, (math.inf,)), seeds=BARE_SEEDS)
    yield from first_steps(program)
    # Grains alone are colloids in other units, with the same hardness and inertia.
    for name, fraction, peclets, seeds in (
        ("grains-alone", BASE, (*NUMBERS, 1e4), SEEDS),
        ("fraction-grains", FRACTION, (*SLOW_MEANS, *MEANS, 125), FRACTION_SEEDS),
    ):
        alone = [(1, fraction, peclet / 125) for peclet in peclets]
        yield from rows_of(program, name, alone, 5 * STIFFNESS, besides=ALIKE | ALIKE_NOISE, seeds=seeds)
    yield from rows_of(program, "fast", [(0, BASE, peclet) for peclet in FAST], seeds=FAST_SEEDS)
    yield from rows_of(program, "grains-added", line(BASE, (*fast, 1e4), GRAINS_ADDED[:-1], grains_added))
    mixed = [(alpha, FRACTION, mean / mean_peclet(alpha, 1)) for alpha in SHARES[1:-1] for mean in MEANS]
    alone = [(0, FRACTION, mean) for mean in (*SLOW_MEANS, *MEANS)]
    yield from rows_of(program, "fraction", alone + mixed, seeds=FRACTION_SEEDS)
    yield from rows_of(program, "size", [(*middle, 1)], count_times=2, seeds=2 * SEEDS)
    yield from rows_of(program, "stiff", [(*middle, p) for p in MORE_NUMBERS], STIFFER * STIFFNESS, seeds=MORE_SEEDS)
    for stiffness, name in ((STIFFNESS, "smooth"), (SOFTER, "smooth-soft")):
        yield from rows_of(program, name, [(*middle, 1)], stiffness, besides={"/contact/friction": 0})
    yield from rows_of(program, "colloids-added-slow", line(BASE, NUMBERS[:1], SLOW_ADDED))
    yield from rows_of(program, "grains-added-slow", line(BASE, NUMBERS[:1], (0, 0.4), grains_added))


LAG = 20  # Brownian times; the inertia of the grains changes displacements by 0.2 of them, a hundredth
# Published volume fractions as the other group is added: its share is 0, 0.1 ... 0.5.
PRINTED = (0.550, 0.576, 0.604, 0.636, 0.671, 0.710)


def composition_numbers(program):
    """Yields the largest deviations of compositions of 10000 spheres from the published ones."""
    off_fraction, off_share = [], []
    for added in ("grains", "colloids"):
        for tenths, printed in enumerate(PRINTED):
            alpha = tenths / 10 if added == "grains" else 1 - tenths / 10
            addition = {"volume_fraction": None, "addition": {"added": added, "base_volume_fraction": BASE}}
            scene = merged(SCENE, addition, particles={"count": 10000, "mixture": {"alpha": alpha}})
            made = program.derived(scene)["derived"]
            off_fraction.append(abs(made["volume_fraction"] - printed))
            off_share.append(abs(made["alpha"] - alpha))
    yield "fraction off", (max(off_fraction), 0.0, 30)
    yield "share off", (max(off_share), 0.0, 30)


def diffusion_numbers(program):
    """Yields a^2/D of dilute spheres of radius 5 over that of radius 1."""
    ones, fives = ([{"radius": radius, "number_share": 1}] for radius in (1, 5))
    equal_numbers = {"colloids": ones, "grains": fives, "alpha": 125 / 126}
    scene = merged(
        SCENE,
        {"duration": None, "volume_fraction": 0.002, "observables": ["mean_squared_displacement"]},
        in_brownian_times(2, 200),
        particles={"count": 1000, "mixture": equal_numbers},
        fluid={"thermal_energy": THERMAL_ENERGY},
        flow={"shear_rate": 0},
    )
    program.run("dilute", scene, [{"/particles/count": 1000}], 4 * SEEDS, observable="self_diffusion")
    ratios = []
    for result in program.stored_results("dilute")[0]:
        displacement = result["mean"]["mean_squared_displacement"]
        place = int(np.searchsorted(displacement["time"], LAG * result["derived"]["brownian_time"]))
        small, large = (sum(of[axis][place] for axis in "xyz") for of in displacement["species"])
        ratios.append(25 * small / large)
    yield "times of diffusion", (*estimate(ratios), len(ratios) - 1)


def measure(program):
    names = "part, alpha, fraction, peclet, mean peclet, count, grains, stiffness, seeds, lost, transient, overlap, "
    names += "viscosity±, pairs±, lubrication±, contact±, contacts_per_particle±"
    write_table(HERE / "table.csv", names, list(parts(program)), 5)
    write_numbers(HERE / "numbers.csv", dict([*composition_numbers(program), *diffusion_numbers(program)]))


class Table:
    """The rows by part, share of grains and Peclet number. A viscosity without any seed is infinite."""

    def __init__(self, rows):
        # A part, its slow part and that with more seeds have different Peclet numbers.
        names = {r["part"]: r["part"].removesuffix("-slow").removesuffix("-more") for r in rows}
        self._rows = {(names[r["part"]], r["alpha"], f"{r['peclet']:.4g}"): r for r in rows}

    def degrees(self, part):
        """Returns the degrees of freedom of the least seeds of a part, of points that have any."""
        return min(r["seeds"] for r in self._rows.values() if r["part"] == part and r["seeds"]) - 1

    def viscosity(self, part, alpha, peclet):
        row = self._rows[part, alpha, f"{peclet:.4g}"]
        return number(row, "viscosity") if row["seeds"] else (math.inf, 0.0)

    def ratio(self, part, alphas, peclet):
        return quotient(*(self.viscosity(part, alpha, peclet) for alpha in alphas))

    def curve(self, part, alpha, numbers):
        """Returns the logarithms of viscosities at these Peclet numbers."""
        return [logarithm(self.viscosity(part, alpha, peclet)) for peclet in numbers]

    def grains_added(self, alpha, peclet):
        part = "colloids-added" if alpha == 0.5 else "grains-added"
        return self.viscosity(part, alpha, peclet)

    def of_means(self, alpha):
        """Returns ln eta with its error at FRACTION, by the Peclet number of the mean radius."""
        rows = where(self._rows.values(), part="fraction-grains" if alpha == 1 else "fraction", alpha=alpha)
        rows.sort(key=lambda r: r["mean peclet"])
        return {r["mean peclet"]: logarithm(number(r, "viscosity")) for r in rows}

    def stiffening(self, soft, hard, alpha, peclet):
        """Returns d ln eta / d ln k_n of two parts; 1, that of a jammed point, if either has no seed with means."""
        values = [self.viscosity(part, alpha, peclet) for part in (soft, hard)]
        if math.inf in (value for value, _ in values):
            return 1.0, 0.0
        return over(logarithm(quotient(*values[::-1])), math.log(STIFFER))


DEGREES = SEEDS - 1


def drops(table, peclet, part="colloids-added"):
    """Returns ln of eta of grains alone over that with colloids added, by share of grains."""
    shares = SLOW_ADDED if peclet == NUMBERS[0] else COLLOIDS_ADDED
    alone, *mixed = (logarithm(table.viscosity(part, alpha, peclet)) for alpha in shares)
    return [difference(alone, one) for one in mixed]


def factor(numbers):
    """Returns exp of the largest of some numbers."""
    return propagated(numbers, lambda values: math.exp(max(values)))


def minimum_of(curve):
    """Returns log_minimum() of a curve, with an infinite error if the lowest point is an end."""
    places, numbers = list(curve), list(curve.values())
    value, error = propagated(numbers, lambda values: log_minimum(places, np.exp(values)))
    return value, math.inf if min(numbers) in (numbers[0], numbers[-1]) else error


def smallest_step(viscosities):
    """Returns the smallest ratio of successive viscosities up to jamming; 0 if a point beyond a jammed one flows."""
    jammed = next((k for k, (value, _) in enumerate(viscosities) if math.isinf(value)), len(viscosities))
    if any(math.isfinite(value) for value, _ in viscosities[jammed:]):
        return 0.0, 0.0
    flowing = [logarithm(v) for v in viscosities[:jammed]]
    return propagated(flowing, lambda values: math.exp(float(np.min(np.diff(values)))))


def rows_of_grains_added(table):
    """Yields statements about Fig. 5.2 a, c: grains added to colloids."""
    thinning = propagated(table.curve("grains-added", 0, NUMBERS), lambda v: math.exp(v[0] - min(v)))
    text = "colloids alone, φ = 0.55: η_r at Pe_c = 0.1 over its minimum"
    yield Statement(text, "L5.2a", *thinning, 1, math.inf, DEGREES)
    slope = propagated(table.curve("fast", 0, FAST), lambda v: (v[1] - v[0]) / math.log(FAST[1] / FAST[0]))
    text = "colloids alone: d ln η_r/d ln Pe_c from 10⁴ to 10⁵"
    yield Statement(text, "L5.2a", *slope, high=0.05, degrees=table.degrees("fast"))
    for peclet in NUMBERS:
        shares = (0, 0.4) if peclet == NUMBERS[0] else GRAINS_ADDED
        found = [table.grains_added(alpha, peclet) for alpha in shares]
        text = f"Pe_c = {peclet:g}: smallest step of η_r as grains are added, α = 0 to {shares[-1]:g}"
        yield Statement(text, "L5.2a", *smallest_step(found), 1, math.inf, DEGREES)
    curves = [table.curve("grains-added", alpha, NUMBERS[1:]) for alpha in GRAINS_ADDED[:-1]]

    def onsets(curves):
        return [log_of_rise(NUMBERS[1:], np.exp(values), 0.2) for values in curves]

    shift = propagated_lists(curves, lambda v: onsets(v)[-1] - onsets(v)[0])
    text = "decades by which thickening begins earlier at α = 0.4 than at 0"
    yield Statement(text, "L5.2a", *over(shift, -1), 0.87, math.inf)
    later = propagated_lists(curves, lambda v: float(np.max(np.diff(onsets(v)))))
    yield Statement("largest step of the onset in decades as grains are added", "L5.2a", *later, high=0)
    steeper = propagated_lists([curves[1], curves[0]], lambda v: steepness(v[0]) / steepness(v[1]))
    yield Statement("steepest d ln η_r/d ln Pe_c at α = 0.3 over that at 0", "L5.2a", *steeper, 1)
    both = [[logarithm(table.grains_added(a, p)) for a in (0, 0.3)] for p in NUMBERS[1:]]
    place = place_of_largest(np.log10(NUMBERS[1:]), [propagated(ends, lambda v: v[1] - v[0]) for ends in both])
    yield Statement("lg Pe_c at which η_r rises most from α = 0 to 0.3", "L5.2c", *place, 0, 3)


def steepness(logarithms):
    return float(np.max(np.diff(logarithms) / np.diff(np.log(NUMBERS[1:]))))


def rows_of_colloids_added(table):
    """Yields statements about Figs 5.2 b, c and 5.6: colloids added to grains at 0.55."""
    of = {peclet: drops(table, peclet) for peclet in NUMBERS}
    degrees, of_bare = table.degrees("colloids-added-more"), table.degrees("no-noise")
    best, fast = factor(of[1]), factor(of[1000])
    text = (
        f"grains at φ₀ = 0.55, Pe_c = 1, {FIRST_TIMES * COUNTS[1]} spheres: η_r at α = 1 over that at 0.7 (printed: 7)"
    )
    most = quotient(table.viscosity("first", 1, 1), table.viscosity("size", 0.7, 1))
    # How much colloids lower it at Pe_c = 1, and at which share most, goes with k_n, which is not in print (README).
    yield Statement(text, "L5.2b", *most, 4, 12, table.degrees("size"), essential=False)
    text = "grains at φ₀ = 0.55, Pe_c = 1: α of the smallest η_r with colloids added"
    yield Statement(text, "L5.2b", *place_of_largest(COLLOIDS_ADDED[1:], of[1]), 0.6, 0.8, essential=False)
    decades = NUMBERS[:-1]
    strongest = propagated_lists(
        [of[peclet] for peclet in decades], lambda v: float(np.log10(decades[int(np.argmax([max(d) for d in v]))]))
    )
    drop = "η_r of grains alone over the smallest with colloids added"
    text = f"lg Pe_c at which {drop} is largest, of 0.1, 1, 10, 100, 1000"
    yield Statement(text, "L5.2b", *strongest, -1, 1)
    then = table.ratio("colloids-added", (0.6, 0.7), 1)
    yield Statement("Pe_c = 1: η_r at α = 0.6 over that at 0.7", "L5.2b", *then, 1, math.inf, degrees, essential=False)
    text = "Pe_c = 1, α = 0.5: d ln η_r/d ln k_n (jams: 1)"
    slope = table.stiffening("colloids-added-soft", "colloids-added", 0.5, 1)
    yield Statement(text, "L5.2b", *slope, JAMMED, math.inf, degrees)
    alone = quotient(*(table.viscosity("colloids-added", 1, peclet) for peclet in (1, 1e5)))
    yield Statement("grains alone: η_r at Pe_c = 1 over that at 10⁵", "L5.2b", *alone, 0.5, math.inf, DEGREES)
    near = propagated(table.curve("grains-added", 0, NUMBERS), lambda v: math.exp(v[1] - min(v)))
    yield Statement("colloids alone: η_r at Pe_c = 1 over its minimum", "L5.2b", *near, high=1.3, degrees=DEGREES)
    # Print has a drop at 1000 and without noise, but no number: a fifth is a bound of ours.
    yield Statement(f"Pe_c = 1000: {drop}", "L5.2b", *fast, 1.2, math.inf, degrees, essential=False)
    less = quotient(fast, best)
    yield Statement(f"{drop}: at Pe_c = 1000 over at 1", "L5.2c", *less, high=0.5, degrees=degrees)
    none = factor(drops(table, math.inf, "no-noise"))
    yield Statement(f"without noise: {drop}", "L5.2c", *none, 1.2, math.inf, of_bare, essential=False)
    # With the more spheres and seeds of the first step from Pe_c = 1 on; at 0.1 nothing has thickened.
    curves = [table.curve("colloids-added", a, NUMBERS[:1]) + table.curve("first", a, NUMBERS[1:]) for a in FIRST]

    def wider(curves):
        alone, mixed = (decades_of_rise(NUMBERS, np.exp(values)) for values in curves)
        return mixed - alone

    more = propagated_lists(curves, wider)
    text = "decades from a tenth to nine tenths of the thickening, α = 0.9 less grains alone"
    yield Statement(text, "L5.2b", *more, 0)
    less = quotient(none, best)
    yield Statement(f"{drop}: without noise over at Pe_c = 1", "L5.2c", *less, high=1, degrees=of_bare)
    further = table.ratio("no-noise", (0.8, 0.9), math.inf)
    text = "without noise: η_r at α = 0.8 over that at 0.9"
    # In print η_r falls at first; that it falls up to alpha = 0.8 is a reading.
    yield Statement(text, "L5.2", *further, high=1, degrees=of_bare, essential=False)
    for peclet in (1, 100):
        name = f"grains at φ₀ = 0.60, Pe_c = {peclet:g}: d ln η_r/d ln k_n at α"
        soft, hard = ("dense-soft", "dense"), tuple(HARD)
        for alpha, pair, words in ((1, soft, ""), (1, hard, ", hard contacts"), (0.5, soft, "")):
            slope = table.stiffening(*pair, alpha, peclet)
            yield Statement(f"{name} = {alpha:g}{words} (jams)", "L5.6", *slope, JAMMED, math.inf, DEGREES)
        # In print they flow at some share. The stiffness is not in print; that of the harder contacts decides.
        for pair, words, essential in ((hard, "hard contacts", True), (soft, "soft ones", False)):
            slopes = {alpha: table.stiffening(*pair, alpha, peclet) for alpha in HARD_SHARES[1:]}
            alpha = min(slopes, key=lambda share: slopes[share][0])
            text = f"{name} = {alpha:g}, where it is least, {words} (flows)"
            yield Statement(text, "L5.6", *slopes[alpha], high=FLOWING, degrees=DEGREES, essential=essential)
    (alpha, peclet), usual = DISPUTED, next(iter(HARD))
    text = f"grains at φ₀ = 0.60, Pe_c = {peclet:g}, α = {alpha:g}, k_n = 4·10⁵"
    for part, words in (
        ("size", "twice the spheres"),
        ("step", "a sixteenth of the step"),
        ("late", "the strains 3 to 6"),
    ):
        ratio = quotient(table.viscosity(f"disputed-{part}", alpha, peclet), table.viscosity(usual, alpha, peclet))
        yield Finding(f"{text}: η_r with {words} over η_r", "L5.6", *ratio, DEGREES)


def rows_of_first_steps(table):
    """Yields statements about the first step as colloids are added to grains, and findings with harder contacts."""
    for peclet in (*NUMBERS[1:-1], math.inf):
        name, end = (f"Pe_c = {peclet:g}", "") if math.isfinite(peclet) else ("without noise", "-bare")
        text = f"{name}: η_r at α = 0.9 over that of grains alone, {FIRST_TIMES * COUNTS[1]} spheres"
        soft, hard = (f"{part}{end}" for part in FIRST_PARTS)
        ratio, of_hard = (table.ratio(part, (0.9, 1), peclet) for part in (soft, hard))
        yield Statement(text, "L5.2c", *ratio, high=1, degrees=table.degrees(soft))
        yield Finding(f"{text}, contacts {STIFFER} times as stiff", "stiffness", *of_hard, table.degrees(hard))


def rows_of_one_fraction(table):
    """Yields statements about Fig. 5.3 a, b."""
    curves, degrees = {alpha: table.of_means(alpha) for alpha in SHARES}, FRACTION_SEEDS - 1
    minima = [minimum_of(curve) for curve in curves.values()]
    shifts = [math.log10(mean_peclet(alpha, 1)) for alpha in SHARES]
    span = propagated(minima, lambda values: float(np.ptp(np.subtract(values, shifts))))
    yield Statement("φ = 0.565: decades of Pe_c over which the minima of η_r lie, α = 0 to 1", "L5.3a", *span, 2)
    # In print the points are a factor of eight apart, so that minima from 1.7 to 12 may look like one.
    for alpha, found in zip(SHARES, minima):
        text = f"φ = 0.565, α = {alpha:g}: lg of the Pe_cg of the minimum"
        yield Statement(text, "L5.3b", *found, math.log10(3), math.log10(30), essential=False)
    spread = propagated(minima, lambda values: max(values) - min(values))
    yield Statement("φ = 0.565: decades of Pe_cg over which these lie", "L5.3b", *spread, high=0.6, essential=False)

    def above(alpha, mean):
        return propagated([curves[alpha][mean], curves[0.5][mean]], lambda v: math.exp(v[0] - v[1]))

    for alpha, name in ((0, "colloids"), (1, "grains")):
        text = f"φ = 0.565, Pe_cg = 10⁵: η_r of {name} alone over that at α = 0.5"
        yield Statement(text, "L5.3b", *above(alpha, 1e5), 3, math.inf, degrees)
    for alpha, name in ((0, "colloids"), (1, "grains")):
        both = curves[alpha], curves[0.5]

        def later(values):
            one, mixed = (log_of_share([*curve], np.exp(v), 0.95) for curve, v in zip(both, values))
            return mixed - one

        text = f"φ = 0.565: lg of the Pe_cg of 95 % of the thickening, α = 0.5 less {name} alone"
        yield Statement(text, "L5.3b", *propagated_lists([[*curve.values()] for curve in both], later), 0.5)
    text = "φ = 0.565: η_r of colloids alone over that at α = 0.5, at Pe_cg = 10⁵ over at 3"
    yield Statement(text, "L5.3", *quotient(above(0, 1e5), above(0, 3)), 1, math.inf, degrees)
    grains = quotient(table.viscosity("fraction-grains", 1, 1), table.viscosity("fraction", 0, 1))
    text = "φ = 0.565, Pe_c = 1: η_r of grains alone over colloids alone"
    yield Statement(text, "L5.3", *grains, 2, math.inf, degrees)


def checks(table):
    ratios = [
        logarithm(quotient(table.viscosity("grains-alone", 1, p / 125), table.viscosity("grains-added", 0, p)))
        for p in (*NUMBERS, 1e4)
    ]
    mean = propagated(ratios, lambda values: math.exp(sum(values) / len(values)))
    yield alike("φ = 0.55: η_r of grains alone over that of colloids alone, mean of seven", "L5.2b", mean, (1, 0))
    base = table.viscosity("colloids-added", 0.7, 1)
    more = quotient(table.viscosity("size", 0.7, 1), base)
    text = "α = 0.7, Pe_c = 1: η_r of 4000 spheres over that of 2000"
    yield Check(text, "size", *more, 0.9, 1.1, table.degrees("size"))
    for peclet in (1, 1e3):
        stiff = quotient(table.viscosity("stiff", 0.7, peclet), table.viscosity("colloids-added", 0.7, peclet))
        text = f"α = 0.7, Pe_c = {peclet:g}: η_r with contacts {STIFFER} times as stiff over η_r"
        # No check: with noise k_n sets where friction begins.
        yield Finding(text, "stiffness", *stiff, table.degrees("stiff"))
    for steps, soft, hard, seeds in (
        ("2.5·10⁴ to 10⁵", "colloids-added-soft", "colloids-added", MORE_SEEDS),
        ("10⁵ to 4·10⁵", "colloids-added", "stiff", MORE_SEEDS),
        ("2.5·10⁴ to 10⁵, μ = 0", "smooth-soft", "smooth", SEEDS),
    ):
        text, slope = f"α = 0.7, Pe_c = 1: d ln η_r/d ln k_n from {steps}", table.stiffening(soft, hard, 0.7, 1)
        yield Finding(text, "stiffness", *slope, seeds - 1)


def rows_of_compositions(numbers):
    text = "largest distance of the volume fractions of 11 compositions from those in print"
    yield Statement(text, "L5.2", *numbers["fraction off"][:2], high=1e-3)
    yield Finding(
        "largest distance of α of 10 000 whole spheres from that asked for", "L5.2", *numbers["share off"][:2]
    )
    *times, degrees = numbers["times of diffusion"]
    yield Statement("dilute: a²/D of radius 5 over that of radius 1", "L 5.1", *times, 0.97 * 125, 1.03 * 125, degrees)


def judge():
    table = Table(read_rows(HERE / "table.csv"))
    yield from rows_of_compositions(read_numbers(HERE / "numbers.csv"))
    yield from rows_of_grains_added(table)
    yield from rows_of_colloids_added(table)
    yield from rows_of_first_steps(table)
    yield from rows_of_one_fraction(table)
    yield from checks(table)


COLOURS = {0: BLUE, 0.3: GREEN, 0.4: ORANGE, 0.5: RED, 0.6: ORANGE, 0.7: GREEN, 0.8: PURPLE, 0.9: GREY, 1: BLUE}
ENDED, TOP = 8, 8e4  # mark and height of points without a seed that ended well


def draw():
    rows = read_rows(HERE / "table.csv")
    figure = Figure(HERE / "chart.png", columns=2, rows=2, size=(1100, 900))

    def panel(x, title, log="xy", y_range=(10, 1e5), **settings):
        return figure.panel(x, "η_r", title, log=log, y_range=y_range, **settings)

    def curve(one, parts, x, title, colour, **equal):
        """Draws the rows of these parts with these values over their column x; a later part replaces earlier ones."""
        here = {r[x]: r for part in parts for r in where(rows, part=part, **equal)}
        for ended_well, some in itertools.groupby(sorted(here.items()), lambda of: of[1]["seeds"] > 0):
            if ended_well:
                one.rows([row for _, row in some], x, "viscosity", title, colour, joined=True)
            else:
                one.points([(place, TOP) for place, _ in some], title, colour, ENDED, 1.3)
            title = None

    powers = {"powers": "x", "x_range": (0.05, 2e5), "key": "top left"}
    one = panel("Pe_c", "grains added to colloids of φ₀ = 0.55", **{**powers, "key": "center left"})
    for alpha in GRAINS_ADDED:
        part = "colloids-added" if alpha == 0.5 else "grains-added"
        title, parts_of = f"α = {alpha:g}, φ = {grains_added(alpha, BASE):.3f}", (f"{part}-slow", part, f"{part}-more")
        curve(one, parts_of, "peclet", title, COLOURS[alpha], alpha=alpha)
    one = panel("Pe_c", "colloids added to grains of φ₀ = 0.55", **{**powers, "key": "bottom right"})
    for alpha in COLLOIDS_ADDED:
        title = f"α = {alpha:g}, φ = {colloids_added(alpha, BASE):.3f}"
        parts_of = ("colloids-added-slow", "colloids-added", "colloids-added-more", "first")
        curve(one, parts_of, "peclet", title, COLOURS[alpha], alpha=alpha)
    title, ends = "colloids added to grains of φ₀ = 0.60", {"x_range": (1e4, 4e6), "y_range": (10, 1e6)}
    one = panel("k_n", title, powers="x", key="bottom left", **ends)
    for alpha, peclet, colour in ((1, 1, BLUE), (0.8, 1, PURPLE), (0.7, 1, GREEN), (0.7, 100, RED)):
        parts_of = "dense-soft", "dense", *HARD
        curve(one, parts_of, "stiffness", f"α = {alpha:g}, Pe_c = {peclet}", colour, alpha=alpha, peclet=peclet)
    one = panel("Pe_{cg}, of the mean radius", "φ = 0.565", **powers)
    for alpha, colour in zip(SHARES, (BLUE, RED, GREEN, GREY)):
        part = "fraction-grains" if alpha == 1 else "fraction"
        curve(one, (part,), "mean peclet", f"α = {alpha:g}", colour, alpha=alpha)
    figure.draw()


def quick_measure(program):
    """Yields the statement that colloids among grains with friction lower the viscosity, at Pe_c = 1."""
    cases = [(alpha, colloids_added(alpha, BASE), 1) for alpha in (1, 0.7)]
    of = {r["alpha"]: r for r in rows_of(program, "quick", cases, count_times=0.5)}
    ratio = row_ratio(of[0.7], of[1], "viscosity")
    yield Statement("Pe_c = 1: η_r at α = 0.7 over that of grains alone", "L5.2c", *ratio, 0, 0.5, DEGREES)


main(HERE, TITLE, measure, quick_measure, judge, draw)
