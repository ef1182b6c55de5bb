#!/usr/bin/python3
"""The jamming map of colloids and grains: the jamming volume fraction of mixtures of radii 1, 1.4, 5 and 7, over the
share of grains and the Peclet number of the mean radius, found by bisection (Li 2023, Figs 5.4, 5.5 and 5.6)."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.compositions import ALIKE, ALIKE_NOISE, DENSITY, MIXTURE_SCENE, NOISE, STIFFNESS, THERMAL_ENERGY, alike
from studies.compositions import composition_row, draw_models, from_nearer_model, mean_peclet, setting_of, windows
from studies.driver import BLACK, BLUE, Check, Figure, Finding, GREEN, Hours, ORANGE, PURPLE, RED, Statement, difference
from studies.driver import entries, estimate, first, main, merged, number, over, place_of_largest, propagated, quotient
from studies.driver import read_numbers, read_rows, row_ratio, viscosity_row, where, write_numbers, write_rows
from studies.driver import write_table
import numpy as np

TITLE = "The jamming map of colloids and grains"
SCENE, NOISY = MIXTURE_SCENE, merged(MIXTURE_SCENE, NOISE)
# Factor of the stiffness with friction, by the share of the grains: if grains carry the stress, softer contacts of
# colloids would give way long before jamming.
STIFFER = {0.7: 2, 0.8: 4, 0.9: 10}
# Number of spheres with about thirty grains (20 at 0.4), by the share of the grains in the volume of all spheres.
COUNTS = {0: 1000, 0.4: 4000, 0.6: 3000, 0.7: 2000, 0.8: 1500, 0.9: 1000, 1: 1000}
SEEDS = 3
# Rows of the map: without noise, without and with friction; with noise and friction, called by the Peclet number of the
# mean radius; and at Peclet number 1 of the colloids.
SMOOTH, ROUGH, FIXED = "smooth", "rough", "colloids-1"
NOISY_ROWS = {100: (*COUNTS,), 1: (0, 1), 0.1: (0,), 10: (0, 0.4, 0.7, 1)}
FIXED_SHARES, COMMON = (0.4, 0.7), 0.69
# Runs with diffusion faster than the flow, for grains, too: shares and volume fractions.
SLOW, SLOWEST, SLOW_CASES = "slow", 0.01, ((1, 0.6), (1, 0.62))
# Cases at the edge of the jam, again with contacts four times as stiff: colloids at a published volume fraction, at
# Peclet number 1, and grains there, whose own Peclet number is 1.25; a mixture at 100 at the least volume fraction that
# jams with the stiffness of the map, and up to there without noise.
EDGE, EDGE_CASE, EDGE_SEEDS, HARDER, HARD_CASE = "edge", (0, 0.62), 8, 4, (0.4, 0.67)
FINER = {16: 8, 64: 4}  # at the edge, again with steps so many times shorter: seeds
HARD_ROUGH = (0.4, 0.65), (0.4, 0.66), HARD_CASE
# First volume fractions of the search, those at which the study mixtures has jamming without noise, and its steps.
START = {
    SMOOTH: {0: 0.63, 0.4: 0.71, 0.6: 0.755, 0.7: 0.77, 0.8: 0.75, 0.9: 0.69, 1: 0.63},
    ROUGH: {0: 0.585, 0.4: 0.66, 0.6: 0.685, 0.7: 0.68, 0.8: 0.645, 0.9: 0.605, 1: 0.585},
}
ABOUT, SLOWER = (-0.02, 0, 0.02), (0, 0.03, 0.06)
ALONE = {100: (0.55, 0.58, 0.6), 10: (0.55, 0.6, 0.63), 1: (0.55, 0.6, 0.63), 0.1: (0.55, 0.6, 0.63)}
NARROW, ROUNDS = 0.0101, 6  # width at which the search ends; largest number of rounds
SOFTEST = 0.003  # mean overlap from which on a point counts as jammed; noise alone gives 0.0009 at most


def setting(alpha, fraction, row, harder=1):
    """Returns the settings of a point, with `harder` times the stiffness of the map.

    Grains alone have the hardness of colloids alone, in other units.
    """
    alike, peclet = alpha == 1, colloids_peclet(row, alpha)
    stiffer = 5 if alike else 1 if row == SMOOTH else STIFFER.get(alpha, 1)
    besides = {"/particles/density": DENSITY, **(ALIKE if alike else {}), **windows(alpha, peclet)}
    if math.isfinite(peclet):
        besides |= {"/limits/thermal_energy": THERMAL_ENERGY, **(ALIKE_NOISE if alike else {})}
    return setting_of(alpha, COUNTS[alpha], fraction, STIFFNESS * stiffer * harder, peclet, besides)


def colloids_peclet(row, alpha):
    if row in (SMOOTH, ROUGH):
        return math.inf
    if row == SLOW:
        return SLOWEST
    return 1 if row in (FIXED, EDGE) else row / mean_peclet(alpha, 1)


def first_fractions(row, alpha):
    if row in ALONE and alpha in (0, 1):
        return list(ALONE[row])
    steps = SLOWER if row in (10, FIXED) else ABOUT
    found = [round(START[SMOOTH if row == SMOOTH else ROUGH][alpha] + step, 4) for step in steps]
    # A volume fraction in common: without it the fraction would determine the share, as along a line of addition.
    return found + [COMMON] if row == FIXED and COMMON not in found else found


def bracket(points):
    """Returns the largest volume fraction at which most seeds flow, and the smallest one beyond it at which they do
    not, or contacts are soft; None for either if absent."""
    hard = (p for p in points if p["state"] in ("flowing", "partly jammed") and p["overlap"] <= SOFTEST)
    flowing = max((p["fraction"] for p in hard), default=None)
    return flowing, min((p["fraction"] for p in points if p["seeds"] and p["fraction"] > (flowing or 0)), default=None)


def next_fraction(fractions, flowing, stuck):
    """Returns the middle of a bracket, or a fraction beyond those that were tried; None if the bracket is narrow."""
    if stuck is None:
        return round(max(fractions) + 0.02, 4)
    if flowing is None:
        return round(min(fractions) - 0.02, 4)
    middle = round((flowing + stuck) / 2, 4)
    return None if stuck - flowing < NARROW or middle in fractions else middle


def curves_of(program, name, only=None):
    """Returns the curves of `peclet jamming` by the share of grains; `only` is the share if it is not swept."""
    found = program.asked("jamming", name, "--by", "steepest", "--softest", str(SOFTEST))["curves"]
    return {curve["settings"].get("/particles/mixture/alpha", only): curve for curve in found}


def search(program, hours, row, shares):
    """Returns rows of the table and of the map, found by rounds of runs that bisect between flowing and jammed."""
    fractions = {alpha: first_fractions(row, alpha) for alpha in shares}
    for turn in range(ROUNDS):
        cases = [(alpha, fraction) for alpha in shares for fraction in fractions[alpha]]
        rows, curves = run_row(program, row, cases, hours if turn == 0 else None)
        brackets = {alpha: bracket(curve["points"]) for alpha, curve in curves.items()}
        more = {alpha: next_fraction(fractions[alpha], *brackets[alpha]) for alpha in shares}
        if not any(more.values()):
            break
        for alpha, fraction in more.items():
            fractions[alpha] += [fraction] if fraction else []
    return rows, [map_entry(row, alpha, brackets[alpha]) for alpha in shares]


def hard(row):
    """Returns the name of a row with contacts HARDER times as stiff."""
    return f"{row}-{HARDER}"


def fine(row, finer):
    """Returns the name of a row with steps so many times shorter."""
    return f"{row}-fine-{finer}"


def run_row(program, row, cases, hours=None, seeds=SEEDS, harder=1, finer=1):
    """Runs cases (share of grains, volume fraction) of a row of the map; returns rows of the table, and curves_of()."""
    name = hard(row) if harder > 1 else fine(row, finer) if finer > 1 else str(row)
    scene = merged(SCENE if row in (SMOOTH, ROUGH) else NOISY, contact={"friction": 0 if row == SMOOTH else 1})
    settings = [setting(alpha, fraction, row, harder) for alpha, fraction in cases]
    if finer > 1:
        for one in settings:
            one["/integrator"] = program.part_of_step(1 / finer, scene, "relative_viscosity", one)
    if hours:
        hours.plan(name, scene, settings, seeds)
    points = program.run(name, scene, settings, seeds)
    if hours:
        hours.add(points)
    curves, rows = curves_of(program, name, cases[0][0]), []
    for (alpha, fraction), one, point in zip(cases, settings, points):
        state = first(curves[alpha]["points"], fraction=fraction)["state"]
        found = {"row": name, **composition_row(one), "peclet": colloids_peclet(row, alpha), "state": state}
        rows.append(found | viscosity_row(point, "mean_overlap", "contacts_per_particle"))
    return rows, curves


def jammed_share(program, name):
    """Returns the share of seeds of a campaign's only point that are jammed or soft, its error, degrees of freedom. A
    seed without means has ended with an overlap, and is jammed."""
    (results,) = program.stored_results(name)
    means = [result.get("mean") for result in results]
    jammed = [float(not mean or mean["mean_overlap"] > SOFTEST) for mean in means]
    return (*estimate(jammed), len(jammed) - 1)


def map_entry(row, alpha, bracket):
    flowing, stuck = (math.nan if x is None else x for x in bracket)
    peclet = colloids_peclet(row, alpha)
    found = {"row": row, "alpha": alpha, "peclet": peclet, "mean peclet": mean_peclet(alpha, peclet)}
    jammed = (flowing + stuck) / 2, abs(stuck - flowing) / math.sqrt(12)
    return found | {"flowing": flowing, "stuck": stuck, **entries("jammed", jammed)}


def measure(program):
    table, jams, hours = [], [], Hours(program)
    everything = {SMOOTH: (*COUNTS,), ROUGH: (*COUNTS,), **NOISY_ROWS, FIXED: FIXED_SHARES}
    for row, shares in everything.items():
        rows, found = search(program, hours, row, shares)
        table += rows
        jams += found
    table += run_row(program, SLOW, SLOW_CASES)[0]
    for harder in (1, HARDER):
        table += run_row(program, EDGE, [EDGE_CASE], seeds=EDGE_SEEDS, harder=harder)[0]
    for finer, seeds in FINER.items():
        table += run_row(program, EDGE, [EDGE_CASE], seeds=seeds, finer=finer)[0]
    table += run_row(program, SLOW, SLOW_CASES[1:], seeds=EDGE_SEEDS, harder=HARDER)[0]
    for row, cases in ((100, [HARD_CASE]), (ROUGH, HARD_ROUGH)):
        table += run_row(program, row, cases, harder=HARDER)[0]
    names = "row, alpha, fraction, peclet, count, grains, state, seeds, lost, transient, viscosity±, pairs±, "
    names += "lubrication±, contact±, mean_overlap±, contacts_per_particle±"
    write_table(HERE / "table.csv", names, table, 5)
    write_rows(HERE / "map.csv", jams, 6)
    shares = {"slow and hard": jammed_share(program, hard(SLOW))}
    shares |= {fine(EDGE, finer): jammed_share(program, fine(EDGE, finer)) for finer in FINER}
    write_numbers(HERE / "numbers.csv", hours.numbers() | shares)


class Map:
    """Jamming volume fractions, by row of the map and share of grains, and viscosities."""

    def __init__(self):
        self._entries = {(str(e["row"]), e["alpha"]): e for e in read_rows(HERE / "map.csv")}
        self._rows = read_rows(HERE / "table.csv")
        numbers = read_numbers(HERE / "numbers.csv")
        # Shares of seeds that jam: slow grains alone, and colloids alone at the edge by FINER.
        self.jammed_of_hard = numbers["slow and hard"]
        self.jammed_of_fine = {finer: numbers[fine(EDGE, finer)] for finer in FINER}

    @staticmethod
    def name(row):
        return row if isinstance(row, str) else str(float(row))

    def jammed(self, row, alpha):
        return number(self._entries[self.name(row), alpha], "jammed")

    def shift(self, row, other, alpha):
        return difference(self.jammed(row, alpha), self.jammed(other, alpha))

    def shares(self, row):
        return sorted(alpha for name, alpha in self._entries if name == self.name(row))

    def curve(self, row, alpha):
        here = [r for r in self._rows if (str(r["row"]), r["alpha"]) == (self.name(row), alpha)]
        return sorted(here, key=lambda r: r["fraction"])

    def viscosity(self, row, alpha, fraction):
        return number(first(self.curve(row, alpha), fraction=fraction), "viscosity")

    def ratio(self, row, other, alpha, fraction):
        return quotient(self.viscosity(row, alpha, fraction), self.viscosity(other, alpha, fraction))

    def flowing(self, row, alpha):
        return [r["fraction"] for r in self.curve(row, alpha) if r["state"] == "flowing"]

    def jams(self, row, case):
        """Returns 1.0 if a case (share of grains, volume fraction) does not flow, else 0.0."""
        alpha, fraction = case
        return float(first(self.curve(row, alpha), fraction=fraction)["state"] != "flowing")

    def largest_jump(self, row, alpha):
        """Returns the largest ratio of viscosities between neighbours up to 0.01 apart; infinite for a jammed one."""
        curve = self.curve(row, alpha)
        near = [(a, b) for a, b in zip(curve, curve[1:]) if b["fraction"] - a["fraction"] < 0.0101 and a["seeds"]]
        return max(row_ratio(b, a, "viscosity") if b["seeds"] else (math.inf, 0.0) for a, b in near)


DEGREES = SEEDS - 1
# Rows of the map: jamming volume fraction of either group alone, and name.
NAMES = {SMOOTH: (0.64, "μ = 0, no noise"), ROUGH: (0.57, "no noise"), 100: (0.57, "Pe_cg = 100")}


def rows_of_curves(jams):
    """Yields statements about Fig. 5.4 a: viscosities at one share of grains, and of colloids alone."""
    both = max(set(jams.flowing(ROUGH, 0.4)) & set(jams.flowing(100, 0.4)))
    text = f"α = 0.4, φ = {both:g}, the densest that flows in both: η_r at Pe_cg = 100 over that without noise"
    yield Statement(text, "L5.4a", *jams.ratio(100, ROUGH, 0.4, both), high=1 / 3, degrees=DEGREES)
    # In print φ_m without noise is that of a power, and with noise the place of the jump.
    power = first(read_rows(HERE.parent / "mixtures" / "jamming.csv"), friction=1, alpha=0.4)
    shift = difference(jams.jammed(100, 0.4), number(power, "jammed"))
    text = "α = 0.4: φ_m at Pe_cg = 100, of the jump, less that without noise, of a power"
    # φ_m with noise goes with the stiffness, which is not in print.
    yield Statement(text, "L5.4a", *shift, -0.01, 0.01, essential=False)
    for row, words in ((100, ""), (hard(100), f", contacts {HARDER} times as stiff")):
        text = f"α = 0.4, φ = {HARD_CASE[1]:g}, Pe_cg = 100{words}: 1 for jammed"
        yield Finding(text, "stiffness", jams.jams(row, HARD_CASE), 0)
    text = "α = 0.4: φ_m at Pe_cg = 100 less that without noise, both by bisection"
    yield Finding(text, "L5.4a", *jams.shift(100, ROUGH, 0.4))
    text = "α = 0.4: largest factor of η_r within Δφ = 0.01,"
    yield Statement(f"{text} Pe_cg = 100", "L5.4a", *jams.largest_jump(100, 0.4), 5, degrees=DEGREES)
    # A power has any such factor near enough to φ_m; `mixtures` judges the power by its fit.
    yield Finding(f"{text} without noise", "L5.4a", *jams.largest_jump(ROUGH, 0.4), DEGREES)
    for alpha, rows in ((0, (100, 10, 1, 0.1)), (0.4, (100, 10))):
        for fast, slow in zip(rows, rows[1:]):
            text = f"α = {alpha:g}: φ_m at Pe_cg = {slow:g} less that at {fast:g}"
            yield Statement(text, "L5.4a", *jams.shift(slow, fast, alpha), 0)
    # Print says of α = 0.4 that viscosities rise below Pe_cg = 10; colloids alone are jammed at 10 and φ = 0.6.
    for fraction, slow, fast in ((0.55, 0.1, 1), (0.55, 1, 10), (0.6, 0.1, 1)):
        text = f"α = 0, φ = {fraction:g}: η_r at Pe_cg = {slow:g} over that at {fast:g}"
        yield Finding(text, "L5.4a", *jams.ratio(slow, fast, 0, fraction), DEGREES)
    lowered = jams.shift(1, ROUGH, 0)
    yield Statement("α = 0: φ_m at Pe_cg = 1 less that without noise", "L 2.5", *lowered, 0.04)


def rows_of_branches(jams):
    """Yields statements about Fig. 5.4 b."""
    names = {row: name for row, (_, name) in NAMES.items()} | {row: f"Pe_cg = {row:g}" for row in (10, 1)}
    for row, name in names.items():
        yield alike(
            f"{name}: φ_m of colloids alone less that of grains alone",
            "L5.4b",
            jams.jammed(row, 0),
            jams.jammed(row, 1),
        )
    for row, (alone, name) in NAMES.items():
        left = [from_nearer_model(jams.jammed(row, alpha), alpha, alone) for alpha in jams.shares(row)]
        distance = propagated(left, lambda values: math.sqrt(float(np.mean(np.square(values)))))
        text = f"{name}: rms distance of φ_m(α) from the nearer packing model"
        yield Finding(text, "L5.4b", *distance)
    for row in (*NAMES, 10):
        shares = jams.shares(row)
        text = f"{names[row]}: share α of grains, of those measured, at which φ_m is largest"
        yield Statement(text, "L5.3", *place_of_largest(shares, [jams.jammed(row, a) for a in shares]), 0.6, 0.8)


def interpolated(jams, alpha):
    """Returns phi_m at Peclet number 1 of the colloids, interpolated in the logarithm of that of the mean radius."""
    ends = jams.jammed(10, alpha), jams.jammed(100, alpha)
    share = math.log10(mean_peclet(alpha, 1) / 10)
    return propagated(ends, lambda v: v[0] + share * (v[1] - v[0]))


def rows_of_fixed_number(jams):
    """Yields statements about Fig. 5.5: Pe_c = 1."""
    start, other = jams.shift(1, SMOOTH, 0), jams.shift(1, ROUGH, 0)
    text = "Pe_c = 1, α = 0: how far φ_m is from that without friction, over how far from that with it"
    yield Statement(text, "L5.5", *quotient((abs(start[0]), start[1]), other), high=1)
    below = {alpha: jams.shift(SMOOTH, FIXED, alpha) for alpha in FIXED_SHARES}
    low, high = FIXED_SHARES
    yield Statement(f"Pe_c = 1, α = {low:g}: how far φ_m is below that without friction", "L5.5", *below[low], 0)
    further = difference(below[high], below[low])
    yield Statement(f"Pe_c = 1: how much further below at α = {high:g} than at {low:g}", "L5.5", *further, 0)
    text = "Pe_c = 1 (Pe_cg = 100), α = {}: φ_m less that with friction without noise".format
    yield Statement(text("1"), "L5.5", *jams.shift(100, ROUGH, 1), -0.01, 0.01)
    yield Finding(text("0.9"), "L5.5", *jams.shift(100, ROUGH, 0.9))  # print says as α → 1
    for alpha in FIXED_SHARES:
        off = difference(interpolated(jams, alpha), jams.jammed(FIXED, alpha))
        text = f"Pe_c = 1, α = {alpha:g}: φ_m by interpolation of the map less that measured"
        yield Finding(text, "L5.5", *off)


def rows_of_addition(jams):
    """Yields statements about Fig. 5.6: the jammed states before addition."""
    for fraction in (0.6, 0.62):
        room = over(jams.jammed(100, 0), fraction)
        yield Statement(f"colloids alone, Pe_c = 100: φ_m/{fraction:g} (below 1: jammed)", "L5.6", *room, high=1)
        for row in (0.1,) if fraction == EDGE_CASE[1] else (1, 0.1):
            room = over(jams.jammed(row, 0), fraction)
            yield Statement(f"colloids alone, Pe_c = {row:g}: φ_m/{fraction:g} (above 1: flows)", "L5.6", *room, 1)
    text = f"colloids alone, Pe_c = 1, φ = {EDGE_CASE[1]:g}"
    # The stiffness is not in print; that of the harder contacts decides. With that of the map it goes with the step.
    found = jams.jams(hard(EDGE), EDGE_CASE)
    yield Statement(f"{text}, contacts {HARDER} times as stiff: 1 for jammed (flows)", "L5.6", found, 0, 0, 0)
    for finer, (share, error, degrees) in jams.jammed_of_fine.items():
        yield Finding(f"{text}, 1/{finer} of the step: share of seeds that jam", "step", share, error, degrees)
    yield Finding(f"{text}, the automatic step: 1 for jammed", "step", jams.jams(EDGE, EDGE_CASE), 0)
    yield Statement("grains alone, Pe_cg = 1: φ_m", "L5.6", *jams.jammed(1, 1), 0.6, 0.625)
    for fraction in (0.55, 0.6):
        text = f"colloids alone, φ = {fraction:g}: η_r at Pe_c = 1 over that at 0.1"
        yield Statement(text, "L5.6", *jams.ratio(1, 0.1, 0, fraction), high=1, degrees=DEGREES)
    # Grains alone at the smallest Peclet number of the colloids.
    name, dense = f"Pe_c = {SLOWEST:g}", jams.viscosity(SLOW, 1, 0.6)
    yield Finding(f"{name}: η_r of grains alone, φ = 0.6 (flows)", "L5.6", *dense, DEGREES)
    yield Statement(f"{name}: grains alone, φ = 0.62, 1 for jammed", "L5.6", jams.jams(SLOW, SLOW_CASES[1]), 0, 1, 1)
    text = f"{name}: grains alone, φ = 0.62, contacts {HARDER} times as stiff: share of seeds that jam"
    yield Finding(text, "L5.6", *jams.jammed_of_hard)


def judge():
    jams, numbers = Map(), read_numbers(HERE / "numbers.csv")
    for some in (rows_of_curves, rows_of_branches, rows_of_fixed_number, rows_of_addition):
        yield from some(jams)
    widest = max(abs(e["stuck"] - e["flowing"]) for e in read_rows(HERE / "map.csv"))
    yield Check("widest bracket of a φ_m", "bisection", widest, 0, high=0.0101)
    ratio = numbers["planned"][0] / numbers["taken"][0]
    yield Check("hours of the first rounds: planned over taken", "`peclet plan`", ratio, 0, 0.5, 2)


def draw():
    jams = Map()
    figure = Figure(HERE / "chart.png", columns=2)
    ends = {"x_range": (-0.02, 1.02), "y_range": (0.53, 0.82)}
    panel = figure.panel("share of grains α", "φ_m", "the map", key="top left", **ends)
    for alone, colour in ((0.64, BLUE), (0.57, RED)):
        draw_models(panel, alone, colour, titled=alone == 0.57)
    styles = {
        SMOOTH: ("μ = 0, no noise", BLUE, 7),
        0.1: ("Pe_{cg} = 0.1", PURPLE, 13),
        1: ("Pe_{cg} = 1", BLACK, 9),
        10: ("Pe_{cg} = 10", GREEN, 5),
        100: ("Pe_{cg} = 100", ORANGE, 11),
        ROUGH: ("μ = 1, no noise", RED, 7),
        FIXED: ("Pe_c = 1", BLACK, 4),
    }
    for row, (title, colour, mark) in styles.items():
        panel.points([(a, *jams.jammed(row, a)) for a in jams.shares(row)], title, colour, mark)
    range_ = {"x_range": (0.54, 0.76), "y_range": (10, 1e4)}
    title = "α = 0.4 (filled) and 0 (open); × and +: these jam"
    panel = figure.panel("φ", "η_r", title, log="y", key="center right", **range_)
    for alpha, mark, jam_mark in ((0.4, 7, 2), (0, 6, 1)):
        for row in (0.1, 1, 10, 100, ROUGH):
            title, colour, _ = styles[row]
            flowing = where(jams.curve(row, alpha), state="flowing")
            panel.rows(flowing, "fraction", "viscosity", None if alpha else title, colour, mark, joined=True)
            jammed = [r["fraction"] for r in jams.curve(row, alpha) if r["state"] != "flowing"]
            panel.points([(min(jammed), 8e3, 0)] if jammed else [], None, colour, jam_mark, 1.3)
    figure.draw()


def quick_measure(program):
    """Yields statements about colloids alone at a volume fraction at which friction jams them: without noise, and with
    noise that separates them."""
    for name, scene, row, jammed in (("without noise", SCENE, ROUGH, 1), ("Pe_c = 1", NOISY, FIXED, 0)):
        rough = merged(scene, contact={"friction": 1})
        program.run(f"quick-{row}", rough, [{**setting(0, 0.605, row), "/particles/count": 200}], 4)
        (point,) = curves_of(program, f"quick-{row}", 0)[0]["points"]
        text = f"colloids alone, φ = 0.605, {name}: 1 for jammed"
        yield Statement(text, "L5.4b", float(point["state"] != "flowing"), 0, jammed, jammed)


main(HERE, TITLE, measure, quick_measure, judge, draw)
