#!/usr/bin/python3
"""Suspensions driven by flows that vary along their gradient: profiles with errors, momentum balance, and comparison
with uniform flow at the same local stress (Li 2023, ch. 6, Fig. 6.1 and Eqs 6.7 to 6.9)."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLACK, BLUE, Check, Figure, Finding, GREEN, GREY, Hours, ORANGE, PURPLE, RED, Statement
from studies.driver import column, difference, divergence, during, entries, estimate, groups, in_strains, jackknife
from studies.driver import main, merged, number, propagated, quotient, read_numbers, read_rows, write_numbers
from studies.driver import write_rows, write_table
from studies.inhomogeneous import FIGURE, FLOWS, Flow, LEARNED_SEEDS, OTHER, PUBLISHED, SCENE, SEEDS, TRAINING, UNSEEN
from studies.inhomogeneous import bin_rows, growth, profile_of, rows_by_seed, seeds_of, symmetric_bin_rows
from studies.inhomogeneous import symmetric_rows_by_seed, symmetries, wave
import numpy as np
from scipy.optimize import least_squares

TITLE = "Flows that vary along their gradient"
UNIFORM = (0.40, 0.44, 0.47, 0.50, 0.52, 0.54, 0.56, 0.58, 0.60, 0.61)
UNIFORM_RATE = 0.01
UNIFORM_QUANTITIES = "J", "mu", "Theta", "normal"


def uniform_quantities(mean):
    """Returns J, mu, Theta and normal = -sigma_yy / P of uniform flow. Stresses of the result are in units of
    viscosity * rate, variances in units of the scene."""
    stress = np.array(mean["profiles"]["stress"]["pairs"], float).mean(axis=1)
    pressure = -stress[:3].mean()
    scatter = math.sqrt(np.mean(mean["profiles"]["velocity_variance"][0])) / UNIFORM_RATE
    found = {"J": 1 / pressure, "mu": abs(stress[3]) / pressure, "Theta": scatter / pressure}
    return found | {"normal": -stress[1] / pressure}


def uniform_rows(program, hours):
    """Yields rows of steady shear without waves, one J for each volume fraction."""
    patch = {"flow": {"shear_rate": UNIFORM_RATE}, "particles": {"count": 1000}, "profiles": {"bins": 5}}
    scene = merged(SCENE, {"box": None, "flow": None}, patch, in_strains(4, 12))
    settings = [{"/volume_fraction": fraction} for fraction in UNIFORM]
    hours.plan("uniform", scene, settings, SEEDS)
    hours.add(program.run("uniform", scene, settings, SEEDS))
    for fraction, results in zip(UNIFORM, program.stored_results("uniform")):
        row = {"fraction": fraction, "seeds": len(results)}
        columns = [uniform_quantities(r["mean"]) for r in results]
        for name in UNIFORM_QUANTITIES:
            row |= entries(name, estimate([c[name] for c in columns]))
        yield row


def share_that_separates(profile):
    """Returns the share of the larger spheres in the fifth of the bins with the largest rates, minus that in the fifth
    with the smallest rates."""
    order = np.argsort(np.abs(profile.rate))
    some = max(1, len(order) // 5)
    share = profile.largest / profile.fraction
    return float(share[order[-some:]].mean() - share[order[:some]].mean())


def mirrored(profiles):
    """Returns the median over bins and quantities of |bin - image| over its error; NaN without symmetries."""
    found = []
    for image, velocity, shear in symmetries(profiles[0].driving)[1:]:
        others = image != np.arange(len(image))
        for name, sign in (("fraction", 1), ("velocity", velocity), ("shear stress", shear)):
            columns = np.array([p.columns()[name] for p in profiles])
            by_seed = (columns - sign * columns[:, image])[:, others]
            error = by_seed.std(axis=0, ddof=1) / math.sqrt(len(profiles))
            found.append(np.abs(by_seed.mean(axis=0)) / error)
    return float(np.median(np.concatenate(found))) if found else math.nan


MOST_BINS_WITH_QUARTERS = 64  # largest number of bins for which results have quarters


def flow_row(flow, results, profiles):
    """Returns the row of numbers about a whole flow."""
    row = {"flow": flow.name, "mean": flow.fraction, "height": flow.height, "count": flow.count, "seeds": len(results)}
    parts = {
        "lag": [np.sqrt(np.mean((p.driving - p.velocity) ** 2)) / np.max(np.abs(p.driving)) for p in profiles],
        "unevenness": [np.std(p.stress[1]) / np.mean(-p.stress[1]) for p in profiles],
        "densest": [np.max(p.fraction) for p in profiles],
        "contrast": [np.std(p.fraction) for p in profiles],
        "separation": [share_that_separates(p) for p in profiles],
        # Absent with noise, whose momentum is not measured.
        "imbalance": [r["mean"]["profiles"].get("momentum_imbalance", math.nan) for r in results],
    }
    for name, values in parts.items():
        row |= entries(name, estimate([float(v) for v in values]))
    row["mirrored"] = mirrored(profiles)
    quarters = {"change": [], "separation change": []}
    for blocks in (r["blocks"]["profiles"] for r in results):
        fraction = np.array(blocks.get("volume_fraction", math.nan))
        quarters["change"].append(fraction)
        quarters["separation change"].append(np.array(blocks["volume_fraction_by_radius"])[:, -1] / fraction)
    for name, of_seeds in quarters.items():
        row |= entries(name, growth(of_seeds) if flow.bins <= MOST_BINS_WITH_QUARTERS else (math.nan, math.nan))
    return row


IN_TIME = merged(SCENE, during({"strain": None, "time": 1}, {"strain": None, "time": 1}))


def results_of(program, flow):
    """Runs the campaign of a flow and returns its points, its whole results, and their Profiles."""
    points = program.run(flow.name, IN_TIME, [flow.settings()], seeds_of(flow), observable="pressure")
    (results,) = program.stored_results(flow.name)
    return points, results, [profile_of(flow, r["mean"]["profiles"]) for r in results]


def measure(program):
    bins, distinct, seeds, distinct_seeds, flows, hours = [], [], [], [], [], Hours(program)
    uniform = list(uniform_rows(program, hours))
    for one in FLOWS:
        hours.plan(one.name, IN_TIME, [one.settings()], seeds_of(one), "pressure")
        points, results, profiles = results_of(program, one)
        hours.add(points)
        bins += bin_rows(one, profiles)
        distinct += symmetric_bin_rows(one, profiles)
        if one in TRAINING:
            seeds += rows_by_seed(one, profiles)
            distinct_seeds += symmetric_rows_by_seed(one, profiles)
        flows.append(flow_row(one, results, profiles))
    write_rows(HERE / "bins.csv", bins, 6)
    write_rows(HERE / "distinct_bins.csv", distinct, 6)
    write_rows(HERE / "bins_by_seed.csv", seeds, 4)
    write_rows(HERE / "distinct_bins_by_seed.csv", distinct_seeds, 4)
    names = "flow, mean, height, count, seeds, mirrored, lag±, unevenness±, change±, densest±, contrast±, separation±, "
    write_table(HERE / "flows.csv", names + "separation change±, imbalance±", flows, 5)
    write_rows(HERE / "uniform.csv", uniform, 6)
    write_numbers(HERE / "numbers.csv", hours.numbers())


class Tables:
    def __init__(self):
        self.flows = {r["flow"]: r for r in read_rows(HERE / "flows.csv")}
        self.uniform = read_rows(HERE / "uniform.csv")
        self.numbers = read_numbers(HERE / "numbers.csv")
        self._bins = read_rows(HERE / "bins.csv")
        self._distinct = read_rows(HERE / "distinct_bins.csv")

    def bins(self, *flows, distinct=False):
        names = {flow.name for flow in flows}
        return [r for r in (self._distinct if distinct else self._bins) if r["flow"] in names]

    def largest(self, flows, name):
        """Returns the number of the flow whose absolute value is the largest."""
        return max((number(self.flows[f.name], name) for f in flows), key=lambda n: abs(n[0]))

    def mean(self, flows, name):
        """Returns the mean of a number over flows, with the standard error of their scatter."""
        return estimate([self.flows[f.name][name] for f in flows])


def law_of_fraction(rows):
    """Returns alpha, phi_J and the rms residual of ln(J / mu) by Eq. 6.7, sqrt(J / mu) = sqrt(alpha) (phi_J - phi)."""
    fraction, root = column(rows, "fraction"), np.sqrt(column(rows, "J") / column(rows, "mu"))

    def left(parameters):
        form = np.maximum(parameters[1] - fraction, 1e-4)
        return 2 * np.log(parameters[0] * form / root)

    found = least_squares(left, (math.sqrt(4.0), 0.66))
    return found.x[0] ** 2, float(found.x[1]), float(np.sqrt(np.mean(left(found.x) ** 2)))


def shift_of_jam(rows, uniform):
    """Returns phi_J of bins by Eq. 6.7 less that of uniform flow at the same volume fractions, because a form that does
    not fit has a phi_J that goes with the range of phi. Bins beyond the range of uniform flow are left out."""
    fractions, logs = column(uniform, "fraction"), np.log(column(uniform, "J") / column(uniform, "mu"))
    rows = [r for r in rows if fractions[0] <= r["fraction"] <= fractions[-1]]
    beside = np.exp(np.interp(column(rows, "fraction"), fractions, logs))
    there = [{"fraction": r["fraction"], "J": ratio, "mu": 1.0} for r, ratio in zip(rows, beside)]
    return law_of_fraction(rows)[1] - law_of_fraction(there)[1]


def by_flow(flows, tables, function):
    """Returns a function of the bins of flows, and its jackknife error over flows."""
    return jackknife(lambda chosen: function(tables.bins(*(flows[k] for k in chosen))), len(flows))


# Ranges of J in Eq. 6.8 with the published exponents. The range below 10^-3, with 1.22, has bins in which the rate
# changes its sign.
RANGES = ("above 10⁻²", (1e-2, 1), 2), ("10⁻³ to 10⁻²", (1e-3, 1e-2), 1.73)


def logarithms(rows, low, high):
    """Returns ln J and ln(Theta^1.44 mu^2.5) of sheared bins with J in [low, high)."""
    rows = [r for r in sheared(rows) if low <= r["J"] < high]
    combined = 1.44 * np.log(column(rows, "Theta")) + 2.5 * np.log(column(rows, "mu"))
    return np.log(column(rows, "J")), combined


def power_law(rows, low, high):
    """Returns slope and constant of ln(Theta^1.44 mu^2.5) as a line in ln J (Eq. 6.8), for J in [low, high)."""
    return np.polyfit(*logarithms(rows, low, high), 1)


def beyond(line, rows, low, high):
    """Returns ln(Theta^1.44 mu^2.5) of bins less that of a line in ln J."""
    place, value = logarithms(rows, low, high)
    return value - np.polyval(line, place)


def step(rows, above, below):
    """Returns the ratio of the power laws of two ranges where they meet, the upper one over the lower one."""
    meet = math.log(above[0])
    return float(np.exp(np.polyval(power_law(rows, *above), meet) - np.polyval(power_law(rows, *below), meet)))


def collapse(rows):
    """Returns the scatter of ln(J / (Theta^0.8 mu^1.2)) (Eq. 6.9) about a cubic in phi."""
    rows = sheared(rows)
    value = np.log(column(rows, "J")) - 0.8 * np.log(column(rows, "Theta")) - 1.2 * np.log(column(rows, "mu"))
    fraction = column(rows, "fraction")
    return float(np.std(value - np.polyval(np.polyfit(fraction, value, 3), fraction)))


def sheared(rows, least=0.05):
    """Returns the bins whose rate is above `least` of the largest in their flow."""
    largest = {flow: np.abs(column(of, "rate")).max() for flow, of in groups(rows, "flow").items()}
    return [r for r in rows if abs(r["rate"]) > least * largest[r["flow"]]]


def steady_rows(tables):
    for flow in FIGURE:
        text = f"k = 0.4, L_y = {flow.height:g}: rms of u∞ − u over k"
        yield Finding(text, "L6.1b", *number(tables.flows[flow.name], "lag"), SEEDS - 1)
    known = TRAINING + PUBLISHED
    text = "how much more φ(y) stands out in the second half of the window, relative: mean of ten flows"
    yield Statement(text, "L 6.1", *tables.mean(known, "change"), -0.1, 0.1, len(known) - 1)
    text = "how much more φ(y) stands out in the second half of the window, relative: the most of all flows"
    yield Statement(text, "L 6.1", *tables.largest(FLOWS, "change"), -0.1, 0.1, SEEDS - 1, essential=False)
    noiseless = [flow for flow in FLOWS if flow not in NOISY]
    text = "largest of all flows: dσ_xy and drag of a bin together, over the largest σ"
    yield Check(text, "momentum", *tables.largest(noiseless, "imbalance"), high=0.02, degrees=SEEDS - 1)
    text = "largest of all flows: scatter of σ_yy over y, relative"
    yield Check(text, "momentum", *tables.largest(noiseless, "unevenness"), high=0.02, degrees=SEEDS - 1)
    text = f"bins less their mirror images, in standard errors, median (0.69 expected of {LEARNED_SEEDS} seeds)"
    yield Check(text, "error bars", *tables.mean(TRAINING, "mirrored"), 0.5, 1.1, len(TRAINING) - 1)


NOISY = OTHER[1:]


def noise(rows, name):
    """Returns the relative error of a quantity, median over bins."""
    return float(np.median(column(rows, f"{name}_error") / np.abs(column(rows, name))))


def noise_rows(tables):
    seeds = f"{LEARNED_SEEDS} seeds"
    rows, distinct = tables.bins(*TRAINING), tables.bins(*TRAINING, distinct=True)
    symbols = {"mu": "μ", "fraction": "φ_loc", "Theta": "Θ", "lag": "Δ_v", "J": "J"}
    for name, symbol in symbols.items():
        text = f"noise of {symbol} in a bin, relative, median of {len(rows)}"
        yield Finding(text, seeds, noise(rows, name), 0)
    less = estimate([noise(distinct, name) / noise(rows, name) for name in symbols])
    text = f"the same of {len(distinct)} bins averaged over symmetries, over that: mean of the five"
    yield Finding(text, seeds, *less, len(symbols) - 1)


def law_rows(tables):
    uniform = law_of_fraction(tables.uniform)
    yield Finding("Eq. 6.7, uniform flow: φ_J", "L eq 6.7", uniform[1], 0)
    yield Finding("Eq. 6.7, uniform flow: rms of ln(J/μ)", "L eq 6.7", uniform[2], 0)
    # Where the flow turns, fluctuations come from the layers beside: the second reading leaves more of that out.
    for least in (0.05, 0.2):
        shift = by_flow(TRAINING, tables, lambda rows, least=least: shift_of_jam(sheared(rows, least), tables.uniform))
        text = f"Eq. 6.7: φ_J of the training flows, of rates above {least:g} of the largest, less that of uniform flow"
        degrees = len(TRAINING) - 1
        yield Statement(f"{text} at equal φ", "L eq 6.7", *shift, -0.005, 0.005, degrees, essential=False)
    everything = TRAINING + PUBLISHED
    degrees = len(everything) - 1
    for name, range_, printed in RANGES:
        found = by_flow(everything, tables, lambda rows, range_=range_: float(power_law(rows, *range_)[0]))
        text = f"Eq. 6.8: exponent of J, J {name} (printed: {printed:g})"
        yield Statement(text, "L eq 6.8", *found, printed - 0.1, printed + 0.1, degrees, essential=False)
    (_, high, _), (_, middle, _) = RANGES
    for range_, words in (((1e-2, 0.1), "10⁻² to 0.1"), ((0.1, 1), "0.1 to 1")):
        found = by_flow(everything, tables, lambda rows, range_=range_: float(power_law(rows, *range_)[0]))
        yield Finding(f"Eq. 6.8: exponent of J, J {words}", "L eq 6.8", *found, degrees)
    line = power_law(tables.bins(*everything), *high)
    for flows, words in ((everything, "of these ten flows"), (UNSEEN[1:], "of the square wave")):
        ratios = np.exp(beyond(line, tables.bins(*flows), *high))
        yield Finding(f"Eq. 6.8, J above 10⁻²: least of a bin {words} over the law", "L eq 6.8", ratios.min(), 0)
        yield Finding(f"Eq. 6.8, J above 10⁻²: most of a bin {words} over the law", "L eq 6.8", ratios.max(), 0)
    text = "Eq. 6.8: the law above J = 10⁻² over that below, there"
    found = by_flow(everything, tables, lambda rows: step(rows, high, middle))
    yield Statement(text, "L eq 6.8", *found, 0.8, 1.2, degrees, essential=False)
    few = sum(r["J"] < middle[0] for r in sheared(tables.bins(*everything)))
    yield Finding("Eq. 6.8: bins with J below 10⁻³ whose shear has a direction", "L eq 6.8", few, 0)
    text = "Eq. 6.9: scatter of J/(Θ^0.8 μ^1.2) at given φ, relative"
    scatter = by_flow(everything, tables, collapse)
    yield Statement(text, "L eq 6.9", *scatter, high=0.2, degrees=degrees, essential=False)


def intro_rows(tables):
    jammed = uniform_jam(tables)
    densest = number(tables.flows["sine-100-56"], "densest")
    text = "φ = 0.56, L_y = 100: largest φ_loc less φ_J of uniform flow"
    yield Statement(text, "L 6", *difference(densest, jammed), 0, degrees=LEARNED_SEEDS - 1, essential=False)
    yield Finding("φ_J of uniform flow, of c (1 − φ/φ_J)^−λ", "uniform flow", *jammed)
    text, degrees = "relative distance of μ from μ(J) of uniform flow, median of the", len(TRAINING) - 1
    slow, fast = residuals(tables, -1, 0.1), residuals(tables, 1, 0.5)
    yield Statement(f"{text} tenth with the smallest rates", "L 6", *slow, 0.1, degrees=degrees)
    yield Finding(f"{text} half with the largest rates", "L 6", *fast, degrees)


def uniform_jam(tables):
    """Returns the phi_J of uniform flow, from a fit to the pair stress over viscosity * rate, mu / J."""
    fractions = column(tables.uniform, "fraction")
    values = [propagated([number(r, "mu"), number(r, "J")], lambda v: v[0] / v[1]) for r in tables.uniform]
    return divergence(fractions, values, (1, 0.65, 1.6))[1]


def residuals(tables, side, share):
    """Returns the median of |mu / mu(J) - 1|, with mu(J) of uniform flow, and its jackknife error over flows.

    It is taken over a share of the bins of each flow, those with the largest (side 1) or smallest (-1) rates, without
    bins whose J is beyond the range of uniform flow.
    """
    order = sorted(tables.uniform, key=lambda r: r["J"])
    known = np.log(column(order, "J")), np.log(column(order, "mu"))

    def of(chosen):
        rows = []
        for flow in (TRAINING[k] for k in chosen):
            rows += sorted(tables.bins(flow), key=lambda r: -side * abs(r["rate"]))[: int(share * flow.bins) + 1]
        expected = np.exp(np.interp(np.log(column(rows, "J")), *known, np.nan, np.nan))
        return float(np.nanmedian(np.abs(column(rows, "mu") / expected - 1)))

    return jackknife(of, len(TRAINING))


def separation_rows(tables):
    text = "share of the larger spheres where the rate is large less that where it is small, mean of the training flows"
    yield Finding(text, "segregation", *tables.mean(TRAINING, "separation"), len(TRAINING) - 1)
    for height in sorted({flow.height for flow in TRAINING}):
        flows = [flow for flow in TRAINING if flow.height == height]
        text = f"how much more that stands out in the second half of the window, relative, L_y = {height:g}"
        yield Finding(text, "segregation", *tables.mean(flows, "separation change"), len(flows) - 1)


def other_rows(tables):
    plain = number(tables.flows["sine-50-52"], "contrast")
    for flow, words in zip(OTHER, ("friction of 0.5", "noise, Pe = 10 where the rate is largest")):
        text = f"φ = 0.52, L_y = 50, {words}: rms contrast of φ(y) over that without"
        yield Finding(text, "other physics", *quotient(number(tables.flows[flow.name], "contrast"), plain), SEEDS - 1)


def judge():
    tables = Tables()
    for some in (steady_rows, noise_rows, law_rows, intro_rows, separation_rows, other_rows):
        yield from some(tables)
    ratio = tables.numbers["planned"][0] / tables.numbers["taken"][0]
    yield Check("hours planned before over those taken", "`peclet plan`", ratio, 0, 0.5, 2)


def draw():
    tables = Tables()
    flows = {flow.name: flow for flow in FLOWS}

    def by_height(name, quantity):
        rows = tables.bins(flows[name])
        return [(r["y"] / r["height"], *number(r, quantity)) for r in rows]

    figure = Figure(HERE / "chart.png", columns=2, rows=3, size=(1100, 1300))
    one = figure.panel("y/L_y", "u, u∞", "velocity, k = 0.4, φ = 0.50, L_y = 50", key="top right")
    height = FIGURE[0].height
    one.curve(lambda x: FIGURE[0].driving(x * height), "u∞", GREY, span=(0, 1), samples=101)
    one.points(by_height("figure-50", "velocity"), "u", BLUE)
    for symbol, quantity, title, ends in (
        ("φ", "fraction", "volume fraction, k = 0.1", (0.38, 0.76)),
        ("share", "largest share", "share of the larger spheres", (0.4, 1.15)),
    ):
        one = figure.panel("y/L_y", symbol, title, y_range=ends, key="top right")
        for name, colour in zip(("sine-50-50", "sine-50-56", "sine-100-56", "square"), (BLUE, RED, ORANGE, GREEN)):
            one.points(by_height(name, quantity), name, colour)
    one = figure.panel("y/L_y", "over the mean −σ_{yy}", "stress, φ = 0.56, L_y = 50", key="bottom left")
    scale = float(np.mean(column(tables.bins(flows["sine-50-56"]), "normal stress")))
    parts = ("normal stress", "−σ_{yy}", BLUE), ("pressure", "P", PURPLE), ("shear stress", "σ_{xy}", RED)
    for name, title, colour in parts:
        one.points([(y, v / scale, e / scale) for y, v, e in by_height("sine-50-56", name)], title, colour)
    kinds = (TRAINING, "training", BLUE), (PUBLISHED, "tests", ORANGE), (UNSEEN, "others", GREEN)
    ends = {"x_range": (1e-5, 1), "y_range": (1e-3, 10), "log": "xy", "key": "top left"}
    one = figure.panel("J", "μ", "stress ratio", powers="x", **ends)
    one.rows(tables.uniform, "J", "mu", "uniform flow", BLACK, 7)
    for some, name, colour in kinds:
        one.rows(tables.bins(*some), "J", "mu", name, colour, 6)
    titles = "J", "Θ^{1.44} μ^{2.5}", "Eq. 6.8: where the shear has a direction"
    one = figure.panel(*titles, log="xy", powers="xy", key="top left")
    for some, name, colour in kinds:
        rows = sheared(tables.bins(*some))
        one.points([(r["J"], r["Theta"] ** 1.44 * r["mu"] ** 2.5) for r in rows], name, colour, 6)
    law = power_law(tables.bins(*TRAINING, *PUBLISHED), *RANGES[0][1])
    one.curve(lambda j: math.exp(np.polyval(law, math.log(j))), f"J^{{{law[0]:.2f}}}", BLACK, span=(1e-3, 0.5))
    figure.draw()


def quick_measure(program):
    """Runs a small box: spheres leave the layers of fast shear, and momentum is balanced."""
    small = Flow("quick", [wave(0.1)], 24, 0.5, 25, 40, width=12)
    _, results, profiles = results_of(program, small)
    slow = estimate([float((p.fraction[[2, 3, 8, 9]] - p.fraction[[0, 5, 6, 11]]).mean()) for p in profiles])
    yield Statement("φ where the flow turns less φ where it is fastest", "L6.1", *slow, 0.03, 0.3, 3)
    imbalance = estimate([r["mean"]["profiles"]["momentum_imbalance"] for r in results])
    yield Check("dσ_xy and drag of a bin together, over the largest σ", "momentum", *imbalance, high=0.03, degrees=3)


main(HERE, TITLE, measure, quick_measure, judge, draw)
