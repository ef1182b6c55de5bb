#!/usr/bin/python3
"""Relative spread of the viscosity against the number of samples, with and without the control variate.

study.py BIN [FOLDER] [--quick]
"""
import math
import os
import statistics
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import REFERENCE_SCENE, at_peclet, estimate, merged, write_table  # noqa: E402
from studies import Statement, data_block, gnuplot, line_through, main  # noqa: E402

TITLE = "Convergence of the viscosity"
SCENE = merged(REFERENCE_SCENE, {"particles": {"count": 250}})
BLOCKS, SET = 32, 16  # averages that a result has of consecutive parts of its window; seeds that are left out together
WINDOWS = [2**k for k in range(6)]  # blocks that are averaged together
GROUPS = (1, 2, 4, 8)  # seeds that are
BROWNIAN = {"duration": {"equilibration": {"brownian_times": 2}, "production": {"brownian_times": 16}}}
SHEARED = {"duration": {"equilibration": {"strain": 1}, "production": {"strain": 4}}}
# Pe, seeds, durations; log10 of the published number of samples for 10 %, a sample being an explicit step of one realisation with N = 1000.
RUNS = ((0.01, 96, BROWNIAN, 8), (1, 96, BROWNIAN, None), (1e4, 192, SHEARED, 5))
TARGET = 0.1
# At Pe = 0.01 the mean of such windows is not known to 10 %: spreads there are relative to the published viscosity at rest, (1 - phi / 0.587)^-1.5.
PUBLISHED_MEAN = {0.01: (1 - 0.5 / 0.587) ** -1.5}


class Series:
    """Of one campaign of one point: by seed, the 32 block means of the plain viscosity of the pairs, and of that with the control variate."""

    def __init__(self, results, published=None):
        self.plain = [r["blocks"]["relative_viscosity_pair"] for r in results]
        control = [r["blocks"]["control_variates"]["brownian_pairwise"] for r in results]
        self.controlled = [[a + b for a, b in zip(*rows)] for rows in zip(self.plain, control)]
        self.control = [statistics.fmean(row) for row in control]
        first = results[0]
        self.steps, self.strain, self.time = (
            first["steps"]["production"],
            first["strain"]["production"],
            first["time"]["production"],
        )
        share = first["steps"]["production"] / sum(first["steps"].values())
        self.seconds = share * statistics.fmean(r["cost"]["cpu_seconds"] for r in results)
        self.published = published
        self.measured, self.measured_error = estimate([statistics.fmean(row) for row in self.controlled])

    def mean(self, seeds=None):
        """What spreads are relative to: the better estimate of the mean, of these seeds."""
        return self.published or statistics.fmean(
            statistics.fmean(self.controlled[s]) for s in (seeds or range(len(self.controlled)))
        )

    def of(self, kind):
        return getattr(self, kind)


def averaged(row, together):
    return [statistics.fmean(row[k : k + together]) for k in range(0, len(row), together)]


def variance_over_seeds(rows):
    """Of rows by seed: the variance over the seeds, averaged over the places in the row."""
    return statistics.fmean(statistics.variance(column) for column in zip(*rows))


def grouped(rows, size):
    """Means of consecutive groups of seeds, place by place."""
    return [
        [statistics.fmean(column) for column in zip(*rows[k : k + size])] for k in range(0, len(rows) - size + 1, size)
    ]


def exponent_of(sets, over):
    """d ln(spread) / d ln(samples) of sets of seeds: over steps by averages of 1 to 32 blocks, over seeds by means of 1 to 8 seeds in every
    block. Variances are averaged over the sets before the logarithm; what counts over seeds is how many groups a set has, less one.
    """

    def point(size):
        if over == "steps":
            return size, [variance_over_seeds([averaged(row, size) for row in rows]) for rows in sets], 1
        return size, [variance_over_seeds(grouped(rows, size)) for rows in sets], 1 / math.sqrt(SET // size - 1)

    points = [
        (math.log(size), 0.5 * math.log(statistics.fmean(variances)), error)
        for size, variances, error in map(point, WINDOWS if over == "steps" else GROUPS)
    ]
    return line_through(*zip(*points))[1]


def jackknife(function, count):
    """A function of a list of numbers below `count`, and its standard error by leaving out one at a time."""
    parts = [function([*range(k), *range(k + 1, count)]) for k in range(count)]
    middle = statistics.fmean(parts)
    return function([*range(count)]), math.sqrt((count - 1) / count * sum((p - middle) ** 2 for p in parts))


def exponent(series, kind, over):
    """With its standard error, by leaving out one set of seeds at a time, and degrees of freedom."""
    rows = series.of(kind)
    sets = [rows[k : k + SET] for k in range(0, len(rows), SET)]
    return *jackknife(lambda chosen: exponent_of([sets[k] for k in chosen], over), len(sets)), len(sets) - 1


def whole(series, kind):
    return [statistics.fmean(row) for row in series.of(kind)]


def spread(series, kind):
    """Relative standard deviation of the whole window over seeds, with its error."""
    values = whole(series, kind)
    return jackknife(lambda seeds: statistics.stdev([values[s] for s in seeds]) / series.mean(seeds), len(values))


def saving(series, blocks=BLOCKS):
    """Variance with the control variate over that without, of averages over so many blocks; and its error."""

    def squares(kind):
        rows = [averaged(row, blocks) for row in series.of(kind)]
        means = [statistics.fmean(column) for column in zip(*rows)]
        return [sum((value - mean) ** 2 for value, mean in zip(row, means)) for row in rows]

    controlled, plain = squares("controlled"), squares("plain")
    return jackknife(lambda seeds: sum(controlled[s] for s in seeds) / sum(plain[s] for s in seeds), len(plain))


def samples_for_target(program, number, series, kind, particles):
    """log10 of explicit steps of N = 1000 spheres in the units of Table 4.1, by 1 / sqrt(samples) from the whole window; and its error."""
    table = merged(
        REFERENCE_SCENE,
        {
            **at_peclet(number),
            "limits": {"shear_rate": 0.009, "thermal_energy": 0.017},
            "integrator": {"method": "explicit"},
        },
    )
    answer = program.derived(table)
    rate = min(0.009, number * 0.017 / (6 * math.pi * 0.1))
    steps = series.strain / rate / answer["timestep"] * particles / 1000  # of the whole window
    value, error = spread(series, kind)
    return math.log10(steps * (value / TARGET) ** 2), 2 * error / value / math.log(10), steps


def run(program, number, seeds, duration, patch=None, name=None):
    name = name or f"convergence-{number:g}"
    program.run(name, merged(SCENE, {**at_peclet(number), **duration, **(patch or {})}), [{"/peclet": number}], seeds)
    return Series(program.stored_results(name)[0], PUBLISHED_MEAN.get(number))


def exponent_statements(number, series, over, width, essential):
    for kind in ("plain", "controlled"):
        value, error, degrees = exponent(series, kind, over)
        yield Statement(
            f"Pe = {number:g}: exponent of the spread over {over}, {'without' if kind == 'plain' else 'with'} the control variate",
            "L4.3a",
            value,
            error,
            -0.5 - width,
            -0.5 + width,
            degrees,
            essential,
        )


def saving_statement(number, series, high, low=-math.inf):
    value, error = saving(series)
    return Statement(
        f"Pe = {number:g}: variance with the control variate over that without",
        "results/control-variates",
        value,
        error,
        low,
        high,
        len(series.plain) - 1,
    )


def measure(program):
    statements, table, curves, savings, summary, found = [], [], {}, {}, [], {}
    for number, seeds, duration, published in RUNS:
        series = found[number] = run(program, number, seeds, duration)
        statements += exponent_statements(number, series, "seeds", 0.1, True)
        statements += exponent_statements(number, series, "steps", 0.1, False)
        statements.append(
            saving_statement(number, series, 0.75) if number <= 1 else saving_statement(number, series, 1.1, 0.9)
        )
        curves[number], savings[number] = [], []
        for kind in ("plain", "controlled"):
            value, error, steps = samples_for_target(program, number, series, kind, 250)
            if published and kind == "plain":
                statements.append(
                    Statement(
                        f"Pe = {number:g}: log10 of explicit steps for 10 %, N = 1000",
                        "L4.3a",
                        value,
                        error,
                        published - 1,
                        published + 1,
                        seeds - 1,
                    )
                )
            relative, relative_error = spread(series, kind)
            summary.append(
                {
                    "peclet": number,
                    "estimate": kind,
                    "seeds": len(series.plain),
                    "viscosity": series.measured,
                    "viscosity_error": series.measured_error,
                    "relative_to": series.mean(),
                    "window_steps": series.steps,
                    "window_strain": series.strain,
                    "spread": relative,
                    "spread_error": relative_error,
                    "implicit_steps_for_10_percent": series.steps * (relative / TARGET) ** 2,
                    "seconds_for_10_percent": series.seconds * (relative / TARGET) ** 2,
                    "log10_explicit_steps_1000": value,
                    "log10_error": error,
                }
            )
        for over, sizes in (("steps", WINDOWS), ("seeds", GROUPS[1:])):
            for size in sizes:
                row = {
                    "peclet": number,
                    "over": over,
                    "blocks": size if over == "steps" else BLOCKS * size,
                    "samples": steps * (size / BLOCKS if over == "steps" else size),
                }
                for kind in ("plain", "controlled"):
                    rows = (
                        [averaged(r, size) for r in series.of(kind)]
                        if over == "steps"
                        else grouped([[v] for v in whole(series, kind)], size)
                    )
                    row[kind] = math.sqrt(variance_over_seeds(rows)) / series.mean()
                    row[f"{kind}_error"] = row[kind] / math.sqrt(2 * (len(rows) - 1))
                curves[number].append(row)
                table.append(row)
        savings[number] = [(blocks * series.steps / BLOCKS, *saving(series, blocks)) for blocks in WINDOWS]
    write_table(os.path.join(HERE, "table.csv"), list(summary[0]), summary, 5)
    write_table(os.path.join(HERE, "spread.csv"), list(table[0]), table, 5)
    draw(curves, savings)
    return [*statements, *comparisons(program, found)]


def comparisons(program, found):
    """That spreads are those of another number of spheres, and of explicit steps, as the samples for 10 % suppose."""
    large = run(program, 1e4, 48, SHEARED, {"particles": {"count": 1000}}, "convergence-1000")
    (a, da), (b, db) = spread(found[1e4], "plain"), spread(large, "plain")
    value = (b / a) ** 2 * 4
    yield Statement(
        "Pe = 10^4: variance times N, N = 1000 over N = 250",
        "method",
        value,
        2 * value * math.hypot(da / a, db / b),
        0.5,
        2,
        47,
    )
    short = {"duration": {"equilibration": {"brownian_times": 1}, "production": {"brownian_times": 4}}}
    explicit = run(program, 1, 32, short, {"integrator": {"method": "explicit"}}, "convergence-explicit")
    values = whole(explicit, "plain")
    a = math.sqrt(variance_over_seeds([averaged(row, 8) for row in found[1].plain]))
    b, db = jackknife(lambda seeds: statistics.stdev([values[s] for s in seeds]), len(values))
    yield Statement(
        "Pe = 1: standard deviation over four Brownian times, implicit steps over explicit ones",
        "method",
        a / b,
        a / b * db / b,
        0.5,
        2,
        31,
    )


def draw(curves, savings):
    lines = [
        "set terminal pngcairo size 1100, 480 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot layout 1, 2",
        "set grid lc rgb '#d8d8d8'",
    ]
    colours = ("#2060b0", "#308030", "#c03028")
    for k, (number, rows) in enumerate(curves.items()):
        lines += data_block(
            f"c{k}",
            [
                (r["samples"], r["plain"], 2 * r["plain_error"], r["controlled"], 2 * r["controlled_error"])
                for r in rows
            ],
        )
        lines += data_block(f"s{k}", [(steps, value, 2 * error) for steps, value, error in savings[number]])
    published = [(10**log, TARGET) for _, _, _, log in RUNS if log]
    lines += data_block("published", published)
    lines += [
        "set logscale xy; set format '10^{%L}'; set xlabel 'samples: explicit steps of N = 1000 that take as long'; set ylabel 'standard deviation of η_r over its mean'",
        "set key top right; set yrange [0.003:100]",
        "plot "
        + ", ".join(
            f"$c{k} using 1:2:3 with yerrorbars pt 7 ps 0.8 lc rgb '{colour}' title 'Pe = {number:g}', $c{k} using 1:4:5 with yerrorbars pt 6 ps 0.8 lc rgb '{colour}' title '  with the control variate', "
            f"{next(r['plain'] * math.sqrt(r['samples']) for r in curves[number] if r['blocks'] == BLOCKS):.6g} / sqrt(x) lc rgb '{colour}' notitle"
            for k, (number, colour) in enumerate(zip(curves, colours))
        )
        + ", 0.1 lc rgb 'black' dt 3 notitle, $published with points pt 2 ps 2 lw 2 lc rgb 'black' title 'published, for 10 %'",
        "unset logscale y; set format y '%g'; set xlabel 'implicit steps of a window'; set ylabel 'variance with the control variate over that without'; set yrange [0:1.2]; set key at graph 0.98, 0.75",
        "plot 1 lc rgb 'black' notitle, "
        + ", ".join(
            f"$s{k} using 1:2:3 with yerrorlines pt 7 ps 0.8 lc rgb '{colour}' title 'Pe = {number:g}'"
            for k, (number, colour) in enumerate(zip(curves, colours))
        ),
    ]
    gnuplot(lines)


def quick_measure(program):
    small = {"particles": {"count": 50}}
    brownian = run(
        program,
        1,
        96,
        {"duration": {"equilibration": {"brownian_times": 1}, "production": {"brownian_times": 8}}},
        small,
    )
    sheared = run(program, 1e4, 96, {"duration": {"equilibration": {"strain": 1}, "production": {"strain": 2}}}, small)
    statements = []
    for number, series in ((1, brownian), (1e4, sheared)):
        statements += exponent_statements(number, series, "seeds", 0.2, True)
    mean, error = estimate(brownian.control)
    value, value_error, _ = samples_for_target(program, 1e4, sheared, "plain", 50)
    return [
        *statements,
        saving_statement(1, brownian, 0.8),
        Statement(
            "Pe = 1: mean of the control variate over η_r",
            "PHYSICS.md",
            mean / brownian.mean(),
            error / brownian.mean(),
            -0.2,
            0.2,
            95,
        ),
        Statement("Pe = 10^4: log10 of explicit steps for 10 %, N = 1000", "L4.3a", value, value_error, 4, 6, 95),
    ]


main(HERE, TITLE, measure, quick_measure)
