#!/usr/bin/python3
"""How the viscosity of frictionless spheres diverges with their volume fraction, at rest, at Pe = 4.6 and at Pe = 10^4.

study.py BIN [FOLDER] [--quick]
"""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from campaigns import (
    TABLE_SCENE,
    columns_of,
    merged,
    number,
    propagated,
    quotient,
    viscosity_row,
    write_table,
)  # noqa: E402
from green_kubo import table_at_rest  # noqa: E402
from studies import Statement, data_block, gnuplot, main  # noqa: E402

TITLE = "Divergence of the viscosity with volume fraction"
PECLET = (4.6, 1e4)
FRACTIONS = (0.40, 0.45, 0.48, 0.50, 0.52, 0.54, 0.56, 0.58, 0.59, 0.60, 0.61)
SHEARED = merged(TABLE_SCENE, {"duration": {"production": {"strain": 3}}})
SEEDS = 5

# At rest: what the zero-shear study has of these volume fractions, and lubrication at a small Peclet number.
REST_FRACTIONS = FRACTIONS[:7]
SLOW = merged(
    TABLE_SCENE,
    {"peclet": 0.22, "duration": {"equilibration": {"brownian_times": 20}, "production": {"brownian_times": 20}}},
)
SLOW_SEEDS = 3

PUBLISHED = {0: (0.587, 1.5), 4.6: (None, 1.5), 1e4: (0.642, 1.5)}


def fitted(fractions, values):
    """phi_J and lambda of (1 - phi / phi_J)^-lambda: least squares in the logarithm, all points with the same weight; phi_J by a search in
    steps of 0.0005, lambda as the linear coefficient."""
    best = None
    for step in range(1, 401):
        jammed = max(fractions) + 0.0005 * step
        x = [-math.log(1 - f / jammed) for f in fractions]
        y = [math.log(max(v, 1e-9)) for v in values]
        exponent = sum(a * b for a, b in zip(x, y)) / sum(a * a for a in x)
        misfit = sum((b - exponent * a) ** 2 for a, b in zip(x, y))
        if best is None or misfit < best[0]:
            best = misfit, jammed, exponent
    return best[1:]


def fit_with_error(rows, quantity):
    """The fit, and of both numbers the standard error: that of the viscosities by drawing them again, and what leaving out one volume
    fraction at a time does (jackknife), in quadrature."""
    fractions, numbers = [r["fraction"] for r in rows], [number(r, quantity) for r in rows]
    whole = fitted(fractions, [v for v, _ in numbers])
    errors, n = [], len(rows)
    parts = [
        fitted(fractions[:k] + fractions[k + 1 :], [v for v, _ in numbers[:k] + numbers[k + 1 :]]) for k in range(n)
    ]
    for which in range(2):
        drawn = propagated(numbers, lambda values, which=which: fitted(fractions, values)[which], 100)[1]
        middle = sum(p[which] for p in parts) / n
        errors.append((drawn, math.sqrt((n - 1) / n * sum((p[which] - middle) ** 2 for p in parts))))
    return [(value, math.hypot(*error), *error) for value, error in zip(whole, errors)]


def other_forms(rows, quantity, lowest):
    """Of the points from `lowest` on: phi_J with lambda = 1.5; and phi_J, lambda and prefactor of c (1 - phi / phi_J)^-lambda. Least squares in
    the logarithm as above, with the root of the mean square of what is left."""
    points = [(r["fraction"], math.log(r[quantity])) for r in rows if r["fraction"] >= lowest]
    fixed = free = None
    for step in range(1, 401):
        jammed = max(f for f, _ in points) + 0.0005 * step
        x, y = [-math.log(1 - f / jammed) for f, _ in points], [v for _, v in points]
        mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
        slope = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)
        rest = math.sqrt(sum((b - 1.5 * a) ** 2 for a, b in zip(x, y)) / len(x))
        fixed = min(fixed or (rest, jammed), (rest, jammed))
        rest = math.sqrt(sum((b - mean_y - slope * (a - mean_x)) ** 2 for a, b in zip(x, y)) / len(x))
        candidate = rest, jammed, slope, math.exp(mean_y - slope * mean_x)
        free = min(free or candidate, candidate)
    return {
        "fixed_jammed": fixed[1],
        "fixed_rest": fixed[0],
        "free_jammed": free[1],
        "free_exponent": free[2],
        "free_prefactor": free[3],
        "free_rest": free[0],
    }


def sheared(program, name, cases, seeds, patch=None):
    """Rows of (Peclet number, volume fraction)."""
    settings = [{"/peclet": p, "/volume_fraction": f} for p, f in cases]
    return [
        {"peclet": p, "fraction": f, **viscosity_row(point)}
        for (p, f), point in zip(cases, program.run(name, merged(SHEARED, patch or {}), settings, seeds))
    ]


def at_rest(program):
    """Rows of eta_phi / eta (zero-shear's), the lubrication viscosity, and their sum."""
    measured = table_at_rest()
    settings = [{"/volume_fraction": f} for f in REST_FRACTIONS]
    rows = []
    for fraction, slow in zip(REST_FRACTIONS, program.run("slow", SLOW, settings, SLOW_SEEDS)):
        rest = measured[fraction]
        (brownian, brownian_error), (tau, tau_error) = number(rest, "viscosity"), number(rest, "time")
        lubrication = number(viscosity_row(slow), "lubrication")
        pairs, error = brownian + lubrication[0], math.hypot(brownian_error, lubrication[1])
        rows.append(
            {
                "peclet": 0,
                "fraction": fraction,
                "seeds": round(rest["seeds"]),
                "lost": 0,
                "transient": 0,
                "brownian": brownian,
                "brownian_error": brownian_error,
                "time": tau,
                "time_error": tau_error,
                "lubrication": lubrication[0],
                "lubrication_error": lubrication[1],
                "pairs": pairs,
                "pairs_error": error,
                "viscosity": 1 + 2.5 * fraction + pairs,
                "viscosity_error": error,
            }
        )
    return rows


def statements_of(curves, fits):
    names = {0: "Pe → 0", 4.6: "Pe = 4.6", 1e4: "Pe = 10⁴"}
    for peclet, (jammed, exponent) in PUBLISHED.items():
        degrees = len(curves[peclet]) - 2
        for quantity, text, essential in (("pairs", "η_r of pairs", True), ("viscosity", "η_r with 1 + 2.5 φ", False)):
            fit = fits[peclet, quantity]
            if jammed:
                yield Statement(
                    f"{names[peclet]}: φ_J of {text} (published: {jammed})",
                    "L4.9a",
                    *fit[0][:2],
                    jammed - 0.01,
                    jammed + 0.01,
                    degrees,
                    essential,
                )
            yield Statement(
                f"{names[peclet]}: λ of {text} (published: 1.5)",
                "L4.9a",
                *fit[1][:2],
                exponent - 0.2,
                exponent + 0.2,
                degrees,
                essential,
            )
    shift = [fits[4.6, "pairs"][0], fits[1e4, "pairs"][0]]
    yield Statement(
        "φ_J at Pe = 4.6 less that at 10⁴ (marginally above)",
        "L4.9a",
        shift[0][0] - shift[1][0],
        math.hypot(shift[0][1], shift[1][1]),
        0,
        0.02,
        len(FRACTIONS) - 2,
        essential=False,
    )
    for peclet in (0, 1e4):
        ratios = {
            r["fraction"]: quotient(
                number(next(m for m in curves[4.6] if m["fraction"] == r["fraction"]), "pairs"), number(r, "pairs")
            )
            for r in curves[peclet]
        }
        fraction = max(ratios, key=lambda f: ratios[f][0])
        yield Statement(
            f"largest η_r of pairs at Pe = 4.6 over that at {names[peclet]} (at φ = {fraction:g})",
            "L4.9a",
            *ratios[fraction],
            high=1,
            degrees=min(r["seeds"] for r in curves[4.6]) - 1,
        )


def measure(program):
    rows = sheared(program, "sheared", [(p, f) for p in PECLET for f in FRACTIONS], SEEDS)
    curves = {0: at_rest(program), **{p: [r for r in rows if r["peclet"] == p] for p in PECLET}}
    fits = {(p, q): fit_with_error(c, q) for p, c in curves.items() for q in ("pairs", "viscosity")}
    fast = {"limits": {"shear_rate": 0.045}, "duration": {"production": {"strain": 2}}}
    methods = {
        m: sheared(program, m, [(1e4, 0.5)], 6, merged(fast, {"integrator": {"method": m}}))[0]
        for m in ("implicit", "explicit")
    }
    write_table(
        os.path.join(HERE, "table.csv"),
        [
            "method",
            "peclet",
            "fraction",
            "seeds",
            "lost",
            "transient",
            *columns_of("viscosity", "pairs", "lubrication", "contact", "brownian", "time"),
        ],
        [{"method": "implicit", **r} for c in curves.values() for r in c]
        + [{"method": f"{m} at rate 0.045", **r} for m, r in methods.items()],
        4,
    )
    write_table(
        os.path.join(HERE, "fits.csv"),
        [
            "peclet",
            "quantity",
            "jammed",
            "jammed_error",
            "jammed_by_seeds",
            "jammed_by_fractions",
            "exponent",
            "exponent_error",
            "exponent_by_seeds",
            "exponent_by_fractions",
        ],
        [
            dict(
                zip(
                    [
                        "peclet",
                        "quantity",
                        "jammed",
                        "jammed_error",
                        "jammed_by_seeds",
                        "jammed_by_fractions",
                        "exponent",
                        "exponent_error",
                        "exponent_by_seeds",
                        "exponent_by_fractions",
                    ],
                    [p, q, *fit[0], *fit[1]],
                )
            )
            for (p, q), fit in fits.items()
        ],
        4,
    )
    forms = [
        {"peclet": p, "quantity": q, "lowest": f, **other_forms(curves[p], q, f)}
        for p in (0, *PECLET)
        for q in ("pairs", "viscosity")
        for f in (0.40, 0.48)
    ]
    write_table(os.path.join(HERE, "forms.csv"), list(forms[0]), forms, 4)
    draw(curves, fits)
    return [
        *statements_of(curves, fits),
        Statement(
            "φ = 0.5, Pe = 10⁴, rate 0.045: η_r with implicit steps over that with explicit ones",
            "method",
            *quotient(number(methods["implicit"], "viscosity"), number(methods["explicit"], "viscosity")),
            0.9,
            1.1,
            methods["explicit"]["seeds"] - 1,
        ),
    ]


def draw(curves, fits):
    colours = {0: "#2060b0", 4.6: "#308030", 1e4: "#c03028"}
    names = {0: "Pe → 0", 4.6: "Pe = 4.6", 1e4: "Pe = 10⁴"}
    lines = [
        "set terminal pngcairo size 1100, 480 font 'Sans,11'",
        f"set output '{os.path.join(HERE, 'chart.png')}'",
        "set multiplot layout 1, 2",
        "set grid lc rgb '#d8d8d8'; set samples 600",
    ]
    for k, rows in enumerate(curves.values()):
        lines += data_block(f"c{k}", [(r["fraction"], *number(r, "pairs")) for r in rows])
    for panel in ("η_r of pairs", "(η_r of pairs)^{-2/3}"):
        shape = "{}" if panel == "η_r of pairs" else "({})**(-1/1.5)"
        parts = []
        for k, peclet in enumerate(curves):
            jammed, exponent = (f[0] for f in fits[peclet, "pairs"])
            published = PUBLISHED[peclet][0]
            y, e = ("2", "3") if shape == "{}" else ("($2**(-1/1.5))", "($3/1.5*$2**(-1/1.5-1))")
            parts.append(
                f"$c{k} using 1:{y}:{e} with yerrorbars pt 7 ps 0.8 lc rgb '{colours[peclet]}' title '{names[peclet]}'"
            )
            parts.append(
                f"(x < {jammed} ? {shape.format(f'(1 - x / {jammed})**-{exponent}')} : 1/0) lc rgb '{colours[peclet]}' notitle"
            )
            if published:
                parts.append(
                    f"(x < {published} ? {shape.format(f'(1 - x / {published})**-1.5')} : 1/0) lc rgb '{colours[peclet]}' dt 2 title 'published, φ_J = {published}'"
                )
        lines += [f"set xlabel 'φ'; set ylabel '{panel}'; set xrange [0.38:0.66]"]
        lines += (
            ["set logscale y; set yrange [1:300]; set key top left"]
            if shape == "{}"
            else ["unset logscale y; set yrange [0:0.6]; set key top right"]
        )
        lines.append("plot " + ", ".join(parts))
    gnuplot(lines)


def quick_measure(program):
    fractions = (0.40, 0.50, 0.55)
    rows = sheared(program, "quick", [*((1e4, f) for f in fractions), (4.6, 0.5)], 8, {"particles": {"count": 150}})
    fast, slow = rows[:3], rows[3]
    numbers = [number(r, "pairs") for r in fast]
    jammed, exponent = (
        propagated(numbers, lambda values, which=which: fitted(fractions, values)[which], 100) for which in range(2)
    )
    return [
        Statement("Pe = 10⁴: φ_J of η_r of pairs", "L4.9a", *jammed, 0.58, 0.72, 7),
        Statement("Pe = 10⁴: its λ", "L4.9a", *exponent, 1, 2.2, 7),
        Statement(
            "φ = 0.5: η_r of pairs at Pe = 4.6 over that at 10⁴",
            "L4.9a",
            *quotient(number(slow, "pairs"), number(fast[1], "pairs")),
            0.3,
            0.9,
            7,
        ),
    ]


main(HERE, TITLE, measure, quick_measure)
