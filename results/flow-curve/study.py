#!/usr/bin/python3
"""The published flow curves, split by term, at three volume fractions, and with other contact stiffnesses.

study.py BIN [FOLDER] [--quick] [--long]
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import (
    TABLE_SCENE,
    columns_of,
    completed,
    estimate,
    log_minimum,
    merged,
    number,
    pair_viscosity,
    propagated,
    quotient,
    term,
    viscosity_row,
    write_table,
)  # noqa: E402
from green_kubo import table_at_rest  # noqa: E402
from studies import Statement, data_block, gnuplot, main  # noqa: E402

TITLE = "Flow curves of Brownian suspensions"
FRACTIONS = (0.45, 0.50, 0.55)
# Campaigns: Peclet numbers, seeds, seeds with --long, and Brownian times of production; those without seeds take hours.
CAMPAIGNS = {
    "flow-curve": ((1, 4.6, 22, 100, 460, 2200, 1e4), 8, 16, 40),
    "flow-curve-0.22": ((0.22,), 6, 16, 60),
    "flow-curve-0.046": ((0.046,), 0, 16, 200),
    "flow-curve-0.01": ((0.01,), 0, 8, 400),
}
STIFFNESSES, STIFFNESS_PECLET = (2.5e3, 1e4, 4e4), (1, 1e4)


def structural_over(means, contact_of):
    """Ratio of the means of the structural Brownian stress and of a contact stress; its error from the seeds' pairs of values."""
    contact = [contact_of(m) for m in means]
    structural = [m["brownian_structural"][3] for m in means]
    ratio = sum(structural) / sum(contact)
    return ratio, estimate([s - ratio * c for c, s in zip(contact, structural)])[1] / abs(sum(contact) / len(contact))


def controlled_contact(mean):
    """The contact stress with the control variate, whose mean is zero: all that the pairs have beside lubrication."""
    return pair_viscosity(mean) - term(mean, "lubrication")


def rows_of(program, name, cases, seeds, patch=None):
    """Rows of (fraction, stiffness, Peclet number)."""
    settings = [{"/volume_fraction": f, "/contact/normal_stiffness": k, "/peclet": p} for f, k, p in cases]
    rows = []
    for (fraction, stiffness, peclet), point in zip(
        cases, program.run(name, merged(TABLE_SCENE, patch or {}), settings, seeds)
    ):
        row = {"fraction": fraction, "stiffness": stiffness, "peclet": peclet, **viscosity_row(point)}
        row["controlled_contact"], row["controlled_contact_error"] = estimate(
            [controlled_contact(m) for m in completed(point)]
        )
        for ratio, contact_of in (
            ("structural_over_contact", controlled_contact),
            ("structural_over_plain_contact", lambda m: term(m, "contact_normal")),
        ):
            row[ratio], row[f"{ratio}_error"] = structural_over(completed(point), contact_of)
        rows.append(row)
    return rows


def at_rest():
    """By volume fraction: the structural Brownian viscosity at rest over the solvent's, by Green and Kubo, and its standard error."""
    rows = {fraction: number(row, "viscosity") for fraction, row in table_at_rest().items()}
    # 0.55 lies between two: their geometric mean.
    (low, low_error), (high, high_error) = rows[0.54], rows[0.56]
    middle = math.sqrt(low * high)
    return {**rows, 0.55: (middle, middle / 2 * math.hypot(low_error / low, high_error / high))}


def pick(rows, **keys):
    return next((r for r in rows if all(r[k] == v for k, v in keys.items())), None)


def curve_statements(rows, fraction):
    curve = sorted((r for r in rows if r["fraction"] == fraction), key=lambda r: r["peclet"])
    at = {r["peclet"]: r for r in curve}
    known = [r for r in curve if r["peclet"] >= 0.22]  # below, errors are as large as the differences
    source = {0.45: "L4.5a", 0.50: "L4.5b", 0.55: "L4.5c"}[fraction]

    def statement(text, numbers, low=-math.inf, high=math.inf, peclet=1e4, essential=True):
        return Statement(f"φ = {fraction:g}: {text}", source, *numbers, low, high, at[peclet]["seeds"] - 1, essential)

    yield statement(
        "η_r of pairs at Pe = 0.22 over that at 1 (thinning)",
        quotient(number(at[0.22], "pairs"), number(at[1], "pairs")),
        low=1,
    )
    yield statement(
        "at Pe = 1 over that at 4.6 (thinning)", quotient(number(at[1], "pairs"), number(at[4.6], "pairs")), low=1
    )
    yield statement(
        "log10 Pe of the minimum (4.6 within a step of the table)",
        propagated([number(r, "pairs") for r in known], lambda v: log_minimum([r["peclet"] for r in known], v)),
        0,
        math.log10(22),
    )
    yield statement(
        "at Pe = 10⁴ over that at 4.6 (thickening)", quotient(number(at[1e4], "pairs"), number(at[4.6], "pairs")), low=1
    )
    yield statement(
        "lubrication at Pe = 10⁴ over that at 1 (rises weakly: at most twice)",
        quotient(number(at[1e4], "lubrication"), number(at[1], "lubrication")),
        1,
        2,
        essential=False,
    )
    unknown = math.nan, math.inf
    yield statement(
        "structural Brownian stress over contact stress at Pe = 0.22",
        number(at[0.22], "structural_over_contact"),
        0.8,
        1.2,
        0.22,
        essential=False,
    )
    yield statement(
        "structural Brownian stress over contact stress at Pe = 0.01",
        number(at[0.01], "structural_over_contact") if 0.01 in at else unknown,
        0.8,
        1.2,
        curve[0]["peclet"],
    )
    yield statement(
        "the same with the contact stress as it is, without the control variate, at Pe = 0.01",
        number(at[0.01], "structural_over_plain_contact") if 0.01 in at else unknown,
        0.8,
        1.2,
        curve[0]["peclet"],
        essential=False,
    )
    rest = at_rest()
    for peclet in (0.22, 0.046):
        if peclet in at:
            share = quotient(number(at[peclet], "structural"), rest[fraction])
            name = f"structural Brownian stress at Pe = {peclet} over that at rest by Green and Kubo"
            if fraction == 0.55:
                yield statement(f"{name} (still rising)", share, high=0.9, peclet=peclet, essential=False)
            else:
                yield statement(f"{name} (plateau)", share, 0.8, 1.2, peclet, essential=False)
    ratio = quotient(number(at[0.01], "pairs"), number(at[0.046], "pairs")) if 0.01 in at else unknown
    if fraction == 0.55:
        yield statement("at Pe = 0.01 over that at 0.046 (still rising)", ratio, low=1.1, peclet=curve[0]["peclet"])
    else:
        yield statement("at Pe = 0.01 over that at 0.046 (plateau)", ratio, 0.9, 1.1, curve[0]["peclet"])


def measure(program):
    rows = []
    for name, (peclets, few, many, times) in CAMPAIGNS.items():
        seeds = many if program.long else few
        if seeds:
            rows += rows_of(
                program,
                name,
                [(f, 1e4, p) for f in FRACTIONS for p in peclets],
                seeds,
                {"duration": {"production": {"brownian_times": times}}},
            )
    stiffness = rows_of(
        program,
        "stiffness",
        [(0.5, k, p) for k in STIFFNESSES if k != 1e4 for p in STIFFNESS_PECLET],
        16 if program.long else 8,
    )
    large = rows_of(program, "large", [(0.45, 1e4, p) for p in (100, 1e4)], 8, {"particles": {"count": 1000}})
    faster = {"limits": {"shear_rate": 0.045}}
    methods = {
        m: rows_of(program, m, [(0.45, 1e4, 100)], 6, merged(faster, {"integrator": {"method": m}}))[0]
        for m in ("implicit", "explicit")
    }

    statements = [s for f in FRACTIONS for s in curve_statements(rows, f)]
    for row in stiffness:
        standard = pick(rows, fraction=0.5, peclet=row["peclet"])
        statements.append(
            Statement(
                f"φ = 0.5, Pe = {row['peclet']:g}: η_r at k_n = {row['stiffness']:g} over that at 10⁴",
                "L4.5b",
                *quotient(number(row, "viscosity"), number(standard, "viscosity")),
                0.95,
                1.05,
                row["seeds"] - 1,
            )
        )
    for row in large:
        statements.append(
            Statement(
                f"φ = 0.45, Pe = {row['peclet']:g}: η_r with N = 1000 over that with 250",
                "method",
                *quotient(
                    number(row, "viscosity"), number(pick(rows, fraction=0.45, peclet=row["peclet"]), "viscosity")
                ),
                0.95,
                1.05,
                row["seeds"] - 1,
                essential=False,
            )
        )
    statements.append(
        Statement(
            "φ = 0.45, Pe = 100, rate 0.045: η_r with implicit steps over that with explicit ones",
            "method",
            *quotient(number(methods["implicit"], "viscosity"), number(methods["explicit"], "viscosity")),
            0.9,
            1.1,
            methods["explicit"]["seeds"] - 1,
        )
    )

    table = [{"method": "implicit", "count": 250, **r} for r in rows + stiffness] + [
        {"method": "implicit", "count": 1000, **r} for r in large
    ]
    table += [{"method": f"{m} at rate 0.045", "count": 250, **r} for m, r in methods.items()]
    write_table(
        os.path.join(HERE, "table.csv"),
        [
            "method",
            "count",
            "fraction",
            "stiffness",
            "peclet",
            "seeds",
            "lost",
            "transient",
            *columns_of(
                "viscosity",
                "pairs",
                "lubrication",
                "contact",
                "controlled_contact",
                "structural",
                "structural_over_contact",
                "structural_over_plain_contact",
            ),
        ],
        table,
        4,
    )
    draw(rows)
    return statements


def draw(rows):
    rest = at_rest()
    terms = {
        "pairs": ("#000000", 7, "all pairs"),
        "controlled_contact": ("#c03028", 5, "contact"),
        "lubrication": ("#2060b0", 9, "lubrication"),
        "structural": ("#308030", 4, "structural Brownian"),
    }
    lines = [
        "set terminal pngcairo size 1400, 460 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot layout 1, 3",
        "set grid lc rgb '#d8d8d8'; set logscale xy; set format x '10^{%L}'; set xlabel 'Pe'; set ylabel 'σ / (η γ̇)'; set xrange [5e-3:3e4]; set key top right",
    ]
    for fraction in FRACTIONS:
        curve = sorted((r for r in rows if r["fraction"] == fraction), key=lambda r: r["peclet"])
        parts = []
        for name, (colour, mark, title) in terms.items():
            lines += data_block(f"{name}{round(fraction * 100)}", [(r["peclet"], *number(r, name)) for r in curve])
            parts.append(
                f"${name}{round(fraction * 100)} using 1:2:3 with yerrorlines pt {mark} ps 0.8 lc rgb '{colour}' title '{title}'"
            )
        fits = [
            (f"(1 - {fraction:g} / {jammed})**-1.5", end) for jammed, end in ((0.587, "x < 0.02"), (0.642, "x > 3e3"))
        ]
        parts += [
            f"({end} ? {fit} : 1/0) lw 3 lc rgb '#a0a0a0' {'title `published fits of both ends`' if k == 0 else 'notitle'}".replace(
                "`", '"'
            )
            for k, (fit, end) in enumerate(fits)
        ]
        parts.append(
            f"(x < 0.1 ? {rest[fraction][0]:g} : 1/0) lw 2 dt 2 lc rgb '{terms['structural'][0]}' title 'structural Brownian at rest'"
        )
        largest = {0.45: 100, 0.50: 200, 0.55: 600}[fraction]
        lines += [
            f"set title 'φ = {fraction:g}'; set yrange [0.1:{largest}]; set samples 1000",
            "plot " + ", ".join(parts),
        ]
    gnuplot(lines)


def quick_measure(program):
    rows = rows_of(
        program,
        "quick",
        [(0.5, 1e4, p) for p in (0.22, 4.6, 1e4)],
        8,
        {
            "particles": {"count": 100},
            "duration": {"equilibration": {"brownian_times": 10}, "production": {"brownian_times": 20, "strain": 3}},
        },
    )
    low, middle, high = rows
    return [
        Statement(
            "φ = 0.5: η_r of pairs at Pe = 10⁴ over that at 4.6 (thickening)",
            "L4.5b",
            *quotient(number(high, "pairs"), number(middle, "pairs")),
            1.1,
            2.5,
            7,
        ),
        Statement("φ = 0.5: η_r of pairs at Pe = 4.6", "L4.5b", *number(middle, "pairs"), 4, 10, 7),
        Statement(
            "φ = 0.5: lubrication at Pe = 4.6 over that at 10⁴",
            "L4.5b",
            *quotient(number(middle, "lubrication"), number(high, "lubrication")),
            0.1,
            0.8,
            7,
        ),
        Statement(
            "φ = 0.5: structural Brownian stress over contact stress at Pe = 0.22",
            "L4.5b",
            *number(low, "structural_over_contact"),
            0.25,
            2,
            7,
        ),
    ]


main(HERE, TITLE, measure, quick_measure)
