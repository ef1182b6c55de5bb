#!/usr/bin/python3
"""Relative spread of the viscosity against the number of samples, with and without the control variate."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLACK, BLUE, Check, Figure, Finding, GREEN, JAMMED_AT_REST, RED, REFERENCE_SCENE, Statement
from studies.driver import at_peclet, difference, diverging, entries, estimate, in_brownian_times, in_strains, jackknife
from studies.driver import line_through, main, merged, number, over, quotient, read_numbers, read_rows
from studies.driver import weighted_mean, where, write_numbers
from studies.driver import write_rows
import numpy as np

TITLE = "Convergence of the viscosity"
SCENE = merged(REFERENCE_SCENE, particles={"count": 250})
# Blocks of a window; seeds of a set for the jackknife.
BLOCKS, SET = 32, 16
WINDOWS = [2**k for k in range(6)]  # numbers of blocks that are averaged
GROUPS = (1, 2, 4, 8)  # numbers of seeds that are averaged
BROWNIAN = in_brownian_times(2, 16)
SHEARED = in_strains(1, 4)
# Pe, seeds, durations, log10 of the published number of samples for 10 %. A sample is an explicit step of one
# realisation with N = 1000.
RUNS = ((0.01, 96, BROWNIAN, 8), (1, 96, BROWNIAN, None), (1e4, 192, SHEARED, 5))
TARGET = 0.1
# Means that spreads are relative to: at Pe = 0.01 the published viscosity at rest, because the measured mean has an
# error above 10 %.
PUBLISHED_MEAN = {0.01: diverging(0.5, JAMMED_AT_REST)}
KINDS = {"plain": "without", "controlled": "with"}


class Series:
    """Block means of the viscosity of pairs of one point, arrays (seeds, 32): `plain` without the stress of the random
    forces, `controlled` with it."""

    def __init__(self, results, published=None):
        blocks = [r["blocks"] for r in results]
        self.controlled = np.array([b["relative_viscosity_pair"] for b in blocks])
        # The stress of random forces is absent without noise.
        control = np.array([b["shear_stress"].get("brownian_lubrication", [0] * 32) for b in blocks])
        self.plain = self.controlled - control
        self.control = control.mean(axis=1)
        first = results[0]
        self.steps, self.strain = first["steps"]["production"], first["strain"]["production"]
        share = self.steps / sum(first["steps"].values())
        self.seconds = share * np.mean([r["cost"]["cpu_seconds"] for r in results])
        self.published = published
        self.measured = estimate(self.controlled.mean(axis=1))

    def mean(self, seeds=slice(None)):
        """Returns the mean that spreads are relative to, the published one or that of these seeds."""
        return self.published or self.controlled[seeds].mean()

    def of(self, kind):
        return getattr(self, kind)

    def whole(self, kind):
        """Returns the averages over the window (seeds,)."""
        return self.of(kind).mean(axis=1)


def averaged(rows, together):
    """Returns averages over `together` consecutive blocks of each seed."""
    return rows.reshape(len(rows), -1, together).mean(axis=2)


def grouped(rows, size):
    """Returns means over consecutive groups of `size` seeds, block by block."""
    whole = len(rows) // size * size
    return rows[:whole].reshape(-1, size, rows.shape[1]).mean(axis=1)


def variance_over_seeds(rows):
    """Returns the variance over seeds, averaged over blocks, of rows (seeds, blocks)."""
    return rows.var(axis=0, ddof=1).mean()


def exponent_of(sets, over_what):
    """Returns d ln(spread) / d ln(samples) of sets of seeds.

    Over steps it is from averages of 1 to 32 blocks, over seeds from means of 1 to 8 seeds in every block. Variances
    are averaged over the sets before the logarithm. Over seeds the weights are the number of groups in a set, less one.
    """
    sizes = np.array(WINDOWS if over_what == "steps" else GROUPS)
    parts = averaged if over_what == "steps" else grouped
    errors = np.ones(len(sizes)) if over_what == "steps" else 1 / np.sqrt(SET // sizes - 1)
    variances = [np.mean([variance_over_seeds(parts(rows, size)) for rows in sets]) for size in sizes]
    return line_through(np.log(sizes), 0.5 * np.log(variances), errors)[1]


def exponent(series, kind, over_what):
    """Returns exponent_of() all sets, its jackknife error over sets, and the degrees of freedom."""
    rows = series.of(kind)
    sets = [rows[k : k + SET] for k in range(0, len(rows), SET)]
    return *jackknife(lambda chosen: exponent_of([sets[k] for k in chosen], over_what), len(sets)), len(sets) - 1


def spread(series, kind):
    """Returns the relative standard deviation of window averages over seeds, and its error."""
    values = series.whole(kind)
    return jackknife(lambda seeds: values[seeds].std(ddof=1) / series.mean(seeds), len(values))


def saving(series, blocks=BLOCKS):
    """Returns the variance with the control variate over that without, for averages over `blocks`, and its error."""

    def squares(kind):
        rows = averaged(series.of(kind), blocks)
        return np.square(rows - rows.mean(axis=0)).sum(axis=1)

    controlled, plain = squares("controlled"), squares("plain")
    return jackknife(lambda seeds: controlled[seeds].sum() / plain[seeds].sum(), len(plain))


def explicit_steps(program, peclet, series, particles):
    """Returns the window's length in explicit steps of N = 1000 spheres, in the units of Table 4.1."""
    limits = {"limits": {"shear_rate": 0.009, "thermal_energy": 0.017}, "integrator": {"method": "explicit"}}
    answer = program.derived(merged(REFERENCE_SCENE, at_peclet(peclet), limits))
    rate = min(0.009, peclet * 0.017 / (6 * math.pi * 0.1))
    return series.strain / rate / answer["timestep"] * particles / 1000


def samples_for_target(steps, found):
    """Returns log10 of the steps after which a spread, found with `steps`, falls to 10 % as 1 / sqrt(samples), and its
    error."""
    value, error = found
    return math.log10(steps * (value / TARGET) ** 2), 2 * error / value / math.log(10)


def run(program, peclet, seeds, duration, patch=None, name=None):
    name = name or f"convergence-{peclet:g}"
    program.run(name, merged(SCENE, at_peclet(peclet), duration, patch or {}), [{"/peclet": peclet}], seeds)
    return Series(program.stored_results(name)[0], PUBLISHED_MEAN.get(peclet))


def exponents(peclet, series):
    """Yields names and exponents of the spread over seeds and over steps, without and with the control variate."""
    for over_what in ("seeds", "steps"):
        for kind, word in KINDS.items():
            name = f"Pe = {peclet:g}: exponent of the spread over {over_what}, {word} the control variate"
            yield name, exponent(series, kind, over_what)


def saving_of(peclet, series):
    name = f"Pe = {peclet:g}: variance with the control variate over that without"
    return name, (*saving(series), len(series.plain) - 1)


def summary_row(peclet, kind, series, steps):
    found = spread(series, kind)
    more = (found[0] / TARGET) ** 2
    log10_samples, log10_error = samples_for_target(steps, found)
    row = {"peclet": peclet, "estimate": kind, "seeds": len(series.plain), **entries("viscosity", series.measured)}
    row |= {"relative_to": series.mean(), "window_steps": series.steps, "window_strain": series.strain}
    row |= {**entries("spread", found), "implicit_steps_for_10_percent": series.steps * more}
    row |= {"seconds_for_10_percent": series.seconds * more, "log10_explicit_steps_1000": log10_samples}
    return row | {"log10_error": log10_error}


def spread_rows(peclet, series, steps):
    """Yields rows of spreads of averages over parts of the window, and over several seeds."""
    for over_what, sizes in (("steps", WINDOWS), ("seeds", GROUPS[1:])):
        for size in sizes:
            parts = over_what == "steps"
            row = {"peclet": peclet, "over": over_what, "blocks": size if parts else BLOCKS * size}
            row["samples"] = steps * (size / BLOCKS if parts else size)
            for kind in KINDS:
                rows = averaged(series.of(kind), size) if parts else grouped(series.whole(kind)[:, None], size)
                value = math.sqrt(variance_over_seeds(rows)) / series.mean()
                row.update(entries(kind, (value, value / math.sqrt(2 * (len(rows) - 1)))))
            yield row


def measure(program):
    spreads, savings, summary, found, numbers = [], [], [], {}, {}
    for peclet, seeds, duration, _ in RUNS:
        series = found[peclet] = run(program, peclet, seeds, duration)
        steps = explicit_steps(program, peclet, series, 250)
        summary += [summary_row(peclet, kind, series, steps) for kind in KINDS]
        spreads += spread_rows(peclet, series, steps)
        numbers |= dict([*exponents(peclet, series), saving_of(peclet, series)])
        mean = over(estimate(series.control), series.mean())
        numbers[f"Pe = {peclet:g}: {BROWNIAN_MEAN}"] = (*mean, seeds * program.times - 1)
        for blocks in WINDOWS:
            row = {"peclet": peclet, "implicit_steps": blocks * series.steps / BLOCKS}
            savings.append(row | entries("ratio", saving(series, blocks)))
    write_rows(HERE / "table.csv", summary, 5)
    write_rows(HERE / "spread.csv", spreads, 5)
    write_rows(HERE / "savings.csv", savings, 5)
    write_numbers(HERE / "numbers.csv", numbers | dict(comparisons(program, found)))


BROWNIAN_MEAN, ZERO = "mean of the pairs' Brownian stress over η_r of pairs", 0.1
OF_COUNT = "Pe = 10^4: variance times N, N = 1000 over N = 250"
OF_METHOD = "Pe = 1: standard deviation over four Brownian times, implicit steps over explicit ones"


def comparisons(program, found):
    """Yields ratios of spreads, for other particle numbers and explicit steps, that the samples for 10 % rely on."""
    large = run(program, 1e4, 48, SHEARED, {"particles": {"count": 1000}}, "convergence-1000")
    value, error = quotient(spread(large, "plain"), spread(found[1e4], "plain"))
    yield OF_COUNT, (4 * value**2, 4 * 2 * value * error, 47)
    method = {"integrator": {"method": "explicit"}}
    explicit = run(program, 1, 32, in_brownian_times(1, 4), method, "convergence-explicit")
    values = explicit.whole("plain")
    implicit = math.sqrt(variance_over_seeds(averaged(found[1].plain, 8))), 0
    yield OF_METHOD, (*quotient(implicit, jackknife(lambda seeds: values[seeds].std(ddof=1), len(values))), 31)


def sample_rows(table):
    """Yields statements about the number of samples for 10 %; published orders of magnitude are bounds of a decade."""
    rows = {r["peclet"]: r for r in table if r["estimate"] == "plain"}
    found = {p: (r["log10_explicit_steps_1000"], r["log10_error"]) for p, r in rows.items()}
    for peclet, _, _, published in RUNS:
        if published:
            text = f"Pe = {peclet:g}: log10 of explicit steps for 10 %, N = 1000 (published: {published})"
            degrees = rows[peclet]["seeds"] - 1
            yield Statement(text, "L4.3a", *found[peclet], published - 1, published + 1, degrees)
    for low, high in zip(sorted(rows), sorted(rows)[1:]):
        text = f"log10 of samples for 10 % at Pe = {low:g} less that at {high:g}: more are needed as Pe is reduced"
        yield Statement(text, "L4.3a", *difference(found[low], found[high]), 0, degrees=rows[low]["seeds"] - 1)


def brownian_rows(numbers):
    """Yields rows about the mean stress of the pairs' random forces, published as "averages to zero": to less than
    ZERO of the viscosity. At the smallest Peclet number the windows of this study are too short; there it is the
    difference between the contact stress with the control variate and without in the study flow-curve, with the error
    of independent ones, which is too large."""
    for peclet, *_ in RUNS:
        *found, degrees = numbers[f"Pe = {peclet:g}: {BROWNIAN_MEAN}"]
        if peclet in PUBLISHED_MEAN:
            yield Finding(f"Pe = {peclet:g}: {BROWNIAN_MEAN}", "L 3.6", *found, degrees)
        else:
            yield Statement(f"Pe = {peclet:g}: {BROWNIAN_MEAN}", "L 3.6", *found, -ZERO, ZERO, degrees)
    (lowest,) = PUBLISHED_MEAN
    rows = where(read_rows(HERE.parent / "flow-curve" / "table.csv"), method="implicit", count=1000, peclet=lowest)
    shares = [over(difference(number(r, "controlled_contact"), number(r, "contact")), r["pairs"]) for r in rows]
    text = f"Pe = {lowest:g}, N = 1000 (flow-curve): {BROWNIAN_MEAN}, mean over φ"
    yield Statement(text, "L 3.6", *weighted_mean(*zip(*shares)), -ZERO, ZERO, min(r["seeds"] for r in rows) - 1)


def judge():
    numbers = read_numbers(HERE / "numbers.csv")
    yield from sample_rows(read_rows(HERE / "table.csv"))
    yield from brownian_rows(numbers)
    # Seeds are independent. Consecutive steps are not, and their exponent is not published.
    for name, (*found, degrees) in numbers.items():
        if "over seeds" in name:
            yield Check(name, "seeds", *found, -0.6, -0.4, degrees)
        elif "over steps" in name:
            yield Finding(name, "steps", *found, degrees)
    for peclet, *_ in RUNS:
        name = f"Pe = {peclet:g}: variance with the control variate over that without"
        *found, degrees = numbers[name]
        ends = (-math.inf, 0.75) if peclet <= 1 else (0.9, 1.1)
        yield Check(name, "control variate", *found, *ends, degrees)
    for name in (OF_COUNT, OF_METHOD):
        *found, degrees = numbers[name]
        yield Check(name, "conversion", *found, 0.5, 2, degrees)


def draw():
    spreads, savings = read_rows(HERE / "spread.csv"), read_rows(HERE / "savings.csv")
    figure = Figure(HERE / "chart.png", columns=2)
    published = [(10**log, TARGET) for _, _, _, log in RUNS if log]
    decades = np.log10([row["samples"] for row in spreads] + [samples for samples, _ in published])
    titles = "simulated time in explicit steps of N = 1000", "standard deviation of η_r over its mean"
    ends = {"x_range": (10 ** np.floor(decades.min()), 10 ** (np.floor(decades.max()) + 1)), "y_range": (0.003, 100)}
    panel = figure.panel(*titles, log="xy", powers="xy", **ends)
    titles = "implicit steps of a window", "variance with the control variate over that without"
    parts = figure.panel(*titles, log="x", powers="x", y_range=(0, 1.2), key=(0.98, 0.75))
    for (peclet, *_), colour in zip(RUNS, (BLUE, GREEN, RED)):
        rows = where(spreads, peclet=peclet)
        for kind, title, mark in (("plain", f"Pe = {peclet:g}", 7), ("controlled", "  with the control variate", 6)):
            bars = [(row["samples"], row[kind], 2 * row[f"{kind}_error"]) for row in rows]
            panel.points(bars, title, colour, mark, 0.8)
        middle = next(row["plain"] * math.sqrt(row["samples"]) for row in rows if row["blocks"] == BLOCKS)
        panel.curve(lambda n, middle=middle: middle / math.sqrt(n), None, colour)
        bars = [(row["implicit_steps"], row["ratio"], 2 * row["ratio_error"]) for row in where(savings, peclet=peclet)]
        parts.points(bars, f"Pe = {peclet:g}", colour, size=0.8, joined=True)
    panel.level(TARGET, dash=3)
    panel.points(published, "published, for 10 %", BLACK, mark=2, size=2, width=2)
    windows = [row["implicit_steps"] for row in savings]
    parts.level(1, span=(min(windows), max(windows)))
    figure.draw()


def quick_measure(program):
    small = {"particles": {"count": 50}}
    brownian = run(program, 1, 96, in_brownian_times(1, 8), small)
    sheared = run(program, 1e4, 96, in_strains(1, 2), small)
    for peclet, series in ((1, brownian), (1e4, sheared)):
        for name, (*found, degrees) in exponents(peclet, series):
            if "over seeds" in name:
                yield Check(name, "seeds", *found, -0.7, -0.3, degrees)
    name, (*found, degrees) = saving_of(1, brownian)
    yield Check(name, "control variate", *found, high=0.8, degrees=degrees)
    control = over(estimate(brownian.control), brownian.mean())
    yield Check("Pe = 1: mean of the control variate over η_r", "PHYSICS.md", *control, -0.2, 0.2, 95)
    samples = samples_for_target(explicit_steps(program, 1e4, sheared, 50), spread(sheared, "plain"))
    yield Statement("Pe = 10^4: log10 of explicit steps for 10 %, N = 1000", "L4.3a", *samples, 4, 6, 95)


main(HERE, TITLE, measure, quick_measure, judge, draw)
