#!/usr/bin/python3
"""The viscosity of frictionless suspensions at rest, by linear response."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, ERROR, Figure, Finding, GREEN, JAMMED_AT_REST, RED, REFERENCE_SCENE, SLOWEST
from studies.driver import at_peclet, diverging, entries, estimate, first, flow_over_rest, in_brownian_times
from studies.driver import jackknife, main, merged, number, over, price, quotient, read_rows, row_ratio
from studies.driver import seconds_of_window, shade, slow_rows, storage_by_loss, table_at_rest
from studies.driver import viscosity_at_high_frequency, where, with_pairs, write_rows, write_table
import numpy as np

TITLE = "Viscosity at rest by linear response"
TARGET = "zero_shear_viscosity"
VISCOSITY, THERMAL_ENERGY = 0.1, 0.017
BROWNIAN_TIME = VISCOSITY / THERMAL_ENERGY
SCENE = merged(
    REFERENCE_SCENE,
    particles={"count": 100},
    flow={"shear_rate": 0},
    fluid={"thermal_energy": THERMAL_ENERGY},
    observables=["stress", "linear_response"],
)
# Window [Brownian times], some 70 to 170 times the viscosity, and seeds, by volume fraction.
WINDOWS = {
    0.30: (400, 60),
    0.40: (500, 40),
    0.45: (800, 60),
    0.48: (1200, 40),
    0.50: (1600, 64),
    0.52: (2400, 24),
    0.55: (10000, 16),
}
EQUILIBRATION = 1 / 8  # of the window
MIDDLE = 0.45
OTHERS = {0.30: ((1000, 16),), MIDDLE: ((250, 16), (50, 24)), 0.50: ((50, 16),)}  # other particle numbers and seeds
HALVED_SEEDS = 24
# Prices in the flow: volume fractions, Peclet numbers, seeds, equilibration and window [Brownian times].
PRICED, PECLETS, PRICE_SEEDS, PRICE_TIMES = (0.30, 0.45, 0.50), (0.001, 0.003, 0.01, 0.03, 0.1), 16, (100, 200)
USUAL = {"count": 100, "step": "automatic"}
FROZEN = 4  # frequency over the Brownian one; above it inertia matters
# Least upper limit of the correlation's integral [Brownian times] over the relative viscosity.
TIMES_OF_CORRELATION = 2.5
SETTLED = 0.95  # of the steady stress after a start
RISING = 3  # standard errors of the rise from which on the window is too short to show a steady stress
LATER = 1.5  # factor in time over which slopes are taken


def scene_at(fraction, patch=None):
    window, _ = WINDOWS[fraction]
    times = in_brownian_times(EQUILIBRATION * window, window)
    return merged(SCENE, {"volume_fraction": fraction, **times}, patch or {})


def point_of(program, name, scene, seeds):
    return program.run(name, scene, [{"/volume_fraction": scene["volume_fraction"]}], seeds, TARGET)[0]


def curve(point, axis, name):
    """Returns the axis of a curve of linear response in Brownian times, and its values by seed."""
    curves = [mean["linear_response"] for mean in point.means]
    return np.array(curves[0][axis]) / BROWNIAN_TIME, np.array([c[name] for c in curves])


def by_correlation(point):
    """Returns the viscosity by the correlation up to TIMES_OF_CORRELATION times the viscosity, and its ratio to that by
    momentum at the same time.

    Both are means over times up to LATER times that: the integral of the correlation up to t is d(t eta)/dt.
    """
    viscosity, _ = point.measured(TARGET)
    ends = TIMES_OF_CORRELATION * viscosity * np.array((1, LATER))
    lag, integrals = curve(point, "lag", "correlation")
    inner = np.array([ends[0], *lag[(ends[0] < lag) & (lag < ends[1])], ends[1]])
    up_to = [np.trapz(np.interp(inner, lag, seed), inner) / np.ptp(ends) for seed in integrals]
    time, moments = curve(point, "time", "viscosity")
    slopes = [np.diff(np.interp(ends, time, time * seed))[0] / np.ptp(ends) for seed in moments]
    up_to, slopes = np.array(up_to), np.array(slopes)
    ratio = jackknife(lambda k: up_to[k].mean() / slopes[k].mean(), len(slopes))
    return entries("viscosity", estimate(up_to)) | entries("over momentum", ratio)


def reached(time, viscosity, level):
    """Returns the time at which the stress after a start of slow shear over the steady one passes `level`.

    After a start the stress over the rate is d(t eta)/dt, with the eta(t) of Helfand's moment, here its mean from t to
    LATER t; it counts for the mean of both in log t. Before the minimum of eta(t) it is that of inertia.
    """
    begin = time[int(np.argmin(viscosity)) :]
    begin = begin[LATER * begin <= time[-1]]
    slope = np.diff([np.interp(t, time, time * viscosity) for t in (begin, LATER * begin)], axis=0)[0] / (LATER - 1)
    share = slope / begin / level
    place = int(np.argmax(share >= 1))
    if share[place] < 1:
        return math.nan
    near = slice(max(place - 1, 0), place + 1)
    return math.sqrt(LATER) * math.exp(np.interp(1, share[near], np.log(begin[near])))


def settling(point):
    """Returns the Brownian times after a start until the stress has SETTLED of its steady value, and its error."""
    time, curves = curve(point, "time", "viscosity")
    steady = np.array([*point.by_seed(TARGET).values()])
    return jackknife(lambda k: reached(time, curves[k].mean(axis=0), SETTLED * steady[k].mean()), len(steady))


def rows_of(fraction, count, step, point):
    head = {"fraction": fraction, "count": count, "step": step, "seeds": len(point.results)}
    more = entries("rise", point.measured("zero_shear_rise")) | entries("settling", settling(point))
    yield {**head, "by": "momentum", **entries("viscosity", point.measured(TARGET)), **more}
    yield {**head, "by": "correlation", **by_correlation(point)}


def curve_rows(fraction, point):
    """Yields rows of eta(t) and of the moduli, with their standard errors over seeds."""
    for axis, name in (("time", "viscosity"), ("frequency", "storage"), ("frequency", "loss")):
        scale = BROWNIAN_TIME if axis == "frequency" else 1 / BROWNIAN_TIME
        modulus = THERMAL_ENERGY if axis == "frequency" else 1  # in units of kT / a^3
        for k, place in enumerate(point.means[0]["linear_response"][axis]):
            value = over(point.measured(f"linear_response/{name}", k), modulus)
            yield {"fraction": fraction, "curve": name, "at": place * scale, **entries("value", value)}


def price_row(fraction, peclet, point, times, quantity, viscosity, foretold=1.0, count=100):
    """Returns the row of a price.

    `times` are proportional to the equilibration and the window; `foretold` is the estimate of `peclet plan` for the
    price over that at rest.
    """
    values = [*point.by_seed(quantity).values()]
    seconds = [seconds_of_window(result, *times) for result in point.results]
    row = {"fraction": fraction, "peclet": peclet, "count": count, "seeds": len(values), "foretold": foretold}
    return row | entries("viscosity", point.measured(quantity)) | entries("seconds", price(values, seconds, viscosity))


def price_rows(program, fraction, viscosity):
    """Yields the rows of prices in the flow."""
    for peclet in PECLETS:
        patch = {"fluid": {"thermal_energy": None}, "observables": None, "volume_fraction": fraction}
        scene = merged(SCENE, patch, at_peclet(peclet), in_brownian_times(*PRICE_TIMES))
        (point,) = program.run(f"price-{fraction:g}-{peclet:g}", scene, [{"/volume_fraction": fraction}], PRICE_SEEDS)
        foretold = flow_over_rest(peclet, fraction, SCENE["particles"]["species"])
        yield price_row(fraction, peclet, point, PRICE_TIMES, "relative_viscosity", viscosity, foretold)


def measure(program):
    rows, curves, prices = [], [], []
    at_rest_times = (EQUILIBRATION, 1)
    for fraction, (_, seeds) in WINDOWS.items():
        at_rest = point_of(program, f"rest-{fraction:g}", scene_at(fraction), seeds)
        rows += rows_of(fraction, 100, "automatic", at_rest)
        curves += curve_rows(fraction, at_rest)
        viscosity, _ = at_rest.measured(TARGET)
        if fraction in PRICED:
            prices.append(price_row(fraction, 0, at_rest, at_rest_times, TARGET, viscosity))
            prices += price_rows(program, fraction, viscosity)
        for count, other_seeds in OTHERS.get(fraction, ()):
            scene = scene_at(fraction, {"particles": {"count": count}})
            others = point_of(program, f"rest-{fraction:g}-{count}", scene, other_seeds)
            rows += rows_of(fraction, count, "automatic", others)
            if count < 100:
                prices.append(price_row(fraction, 0, others, at_rest_times, TARGET, viscosity, count=count))
    half = {"integrator": program.part_of_step(0.5, scene_at(MIDDLE), TARGET)}
    halved = point_of(program, "halved", scene_at(MIDDLE, half), HALVED_SEEDS)
    rows += rows_of(MIDDLE, 100, "half of it", halved)
    names = "fraction, count, step, by, seeds, viscosity±, rise±, settling±, over momentum±"
    write_table(HERE / "table.csv", names, rows, 5)
    write_rows(HERE / "curves.csv", curves, 5)
    write_table(HERE / "prices.csv", "fraction, peclet, count, seeds, viscosity±, seconds±, foretold", prices, 4)


def compared(table, label, **which):
    """Returns the check that both estimates of one point agree at the same time."""
    row = first(table, by="correlation", **which)
    when = f"{TIMES_OF_CORRELATION:g} to {TIMES_OF_CORRELATION * LATER:g} η_r τ_B"
    text = f"{label}: by correlation over by momentum, at {when}"
    return Check(text, "two forms", *number(row, "over momentum"), 0.9, 1.1, row["seeds"] - 1)


def two_forms(table):
    for fraction, row in usual_rows(table).items():
        found = number(row, "viscosity")
        yield Finding(f"φ = {fraction:g}: η_r at rest", "linear response", *found, row["seeds"] - 1)
        yield compared(table, f"φ = {fraction:g}", fraction=fraction, **USUAL)
        rise, error = number(row, "rise")
        if rise < RISING * error:
            text = f"φ = {fraction:g}: Brownian times after a start of slow shear until η_r has {SETTLED:g} of that"
            yield Finding(text, "linear response", *number(row, "settling"), row["seeds"] - 1)
        text = f"φ = {fraction:g}: rise from half of the time on, over η_r"
        yield Check(text, "the window", *quotient(number(row, "rise"), found), -0.1, 0.1, row["seeds"] - 1)


def usual_rows(table):
    """Returns the rows by momentum, by volume fraction."""
    return {r["fraction"]: r for r in where(table, by="momentum", **USUAL)}


def size_and_step(table):
    counts = [(fraction, count) for fraction, runs in OTHERS.items() for count, _ in runs]
    others = {(f, f"N = {n} over N = 100"): {"count": n, "step": "automatic"} for f, n in counts}
    others[MIDDLE, "half the step over the automatic one"] = {"count": 100, "step": "half of it"}
    for (fraction, text), which in others.items():
        usual, other = (first(table, fraction=fraction, by="momentum", **w) for w in (USUAL, which))
        text = f"φ = {fraction:g}, η_r: {text}"
        yield Check(text, "size and step", *row_ratio(other, usual, "viscosity"), 0.9, 1.1, other["seeds"] - 1)
    yield compared(table, "φ = 0.3, N = 1000", fraction=0.3, count=1000, step="automatic")


def beside_others(table):
    """Yields findings about the recipe in print and slow shear, of other studies."""
    for fraction, row in table_at_rest().items():
        if fraction in WINDOWS:
            exact = with_pairs(usual_rows(table)[fraction])
            text = f"φ = {fraction:g}: η_φ by the recipe in print, without lubrication, over η_r of pairs"
            yield Finding(
                text, "zero-shear", *quotient(number(row, "viscosity"), number(exact, "pairs")), exact["seeds"] - 1
            )
    for fraction, row in slow_rows().items():
        text = f"φ = {fraction:g}: η_r at Pe = {SLOWEST:g} over that at rest"
        yield Finding(text, "slow shear", *row_ratio(row, usual_rows(table)[fraction], "viscosity"), row["seeds"] - 1)


def modulus(curves, fraction, name):
    """Returns frequencies in increasing order, values and standard errors of the storage or the loss modulus."""
    return np.array(sorted((r["at"], *number(r, "value")) for r in where(curves, fraction=fraction, curve=name))).T


def moduli(curves, table):
    """Yields checks of the moduli: G'' at the lowest frequency against the viscosity at rest, G' against the
    Kramers-Kronig relation, and G'' at high frequency, with frozen structure, beside a formula for hard spheres."""
    for fraction, row in usual_rows(table).items():
        frequency, storage, storage_error = modulus(curves, fraction, "storage")
        _, loss, loss_error = modulus(curves, fraction, "loss")
        viscosity = np.array((loss, loss_error)) / frequency
        text = f"φ = {fraction:g}: G″/(ηω) at the lowest frequency over η_r"
        yield Check(text, "G″ = η_r ηω for ω → 0", *quotient(viscosity[:, 0], number(row, "viscosity")), 0.8, 1.1)
        inner = (frequency > frequency[0]) & (frequency < FROZEN)
        ratios = storage[inner] / storage_by_loss(frequency, loss)[inner]
        text = f"φ = {fraction:g}: G′ over that by Kramers and Kronig from G″, mean over frequencies"
        yield Check(text, "Kramers & Kronig", *estimate(ratios), 0.9, 1.1, len(ratios) - 1)
        steep = math.log(storage[1] / storage[0]) / math.log(frequency[1] / frequency[0])
        relative = math.hypot(*(storage_error / storage)[:2])
        text = f"φ = {fraction:g}: power of ω in G′ between the two lowest frequencies (2 for ω → 0)"
        yield Finding(text, "G′ ∝ ω²", steep, relative / math.log(frequency[1] / frequency[0]))
        place, value = np.searchsorted(frequency, FROZEN), viscosity_at_high_frequency(fraction)
        text = f"φ = {fraction:g}: G″/(ηω) at ωτ_B = {frequency[place]:.2g}; hard spheres, all interactions"
        yield Finding(f"{text}: {value:.2f}", "Lionberger & Russel 1994", *viscosity[:, place].tolist())


def saved(prices):
    for fraction in PRICED:
        rest = first(prices, fraction=fraction, peclet=0, count=100)
        for row in where(prices, fraction=fraction):
            ratio, text = row_ratio(row, rest, "seconds"), f"φ = {fraction:g}"
            if row["count"] < 100:
                text += f", at rest: processor time with N = {row['count']:g} over that with 100"
                yield Finding(text, "price", *ratio, row["seeds"] - 1)
            if row["peclet"] in (0.001, 0.01):
                text += f", Pe = {row['peclet']:g}: processor time over that at rest (foretold: {row['foretold']:.2g})"
                yield Finding(text, "price", *ratio, row["seeds"] - 1)


def judge():
    table, curves, prices = (read_rows(HERE / f"{name}.csv") for name in ("table", "curves", "prices"))
    yield from two_forms(table)
    yield from size_and_step(table)
    yield from beside_others(table)
    yield from moduli(curves, table)
    yield from saved(prices)


def draw_curves(figure, curves):
    rise = figure.panel("t / τ_B", "η(t) / η", log="xy", key="top left")
    moduli = figure.panel("ω τ_B", "G′, G″ (dashed) a³/kT", log="xy", key="top left", y_range=(1e-3, None))
    for fraction in WINDOWS:
        colour, label = colour_of(fraction), f"φ = {fraction:g}"
        rise.rows(where(curves, fraction=fraction, curve="viscosity")[::3], "at", "value", label, colour, size=0.4)
        storage, loss = (zip(*modulus(curves, fraction, name)) for name in ("storage", "loss"))
        moduli.points([row for row in storage if row[1] > row[2]], label, colour, size=0.6)
        moduli.line([row[:2] for row in loss], None, colour, dash=2)


def draw_viscosities(figure, table):
    divergence = figure.panel("φ", "η_r at rest", log="y", x_range=(0.25, 0.58), y_range=(1, 300), key="top left")
    divergence.rows(usual_rows(table).values(), "fraction", "viscosity", "at rest", BLUE)
    divergence.rows(slow_rows().values(), "fraction", "viscosity", f"Pe = {SLOWEST}", RED, size=0.8)
    title = "published fit of the limit"
    divergence.curve(lambda f: diverging(f, JAMMED_AT_REST, 1.5), title, GREEN, (0.26, 0.56), dash=2)


def draw_prices(figure, prices):
    ends = {"x_range": (min(PECLETS) / 2, max(PECLETS) * 2), "key": "top right"}
    panel = figure.panel("Pe", f"processor s to {100 * ERROR:g} % of η_r", log="xy", powers="x", **ends)
    for fraction in PRICED:
        rest, *rows = where(prices, fraction=fraction, count=100)
        colour = colour_of(fraction)
        panel.rows(rows, "peclet", "seconds", f"in the flow, φ = {fraction:g}", colour, joined=True)
        panel.level(rest["seconds"], f"at rest, φ = {fraction:g}", colour, dash=2)


def colour_of(fraction):
    return shade((fraction - min(WINDOWS)) / (max(WINDOWS) - min(WINDOWS)))


def draw():
    figure = Figure(HERE / "chart.png", columns=2, rows=2, size=(1100, 900))
    draw_curves(figure, read_rows(HERE / "curves.csv"))
    draw_viscosities(figure, read_rows(HERE / "table.csv"))
    draw_prices(figure, read_rows(HERE / "prices.csv"))
    figure.draw()


def quick_measure(program):
    scene = merged(SCENE, in_brownian_times(10, 60), volume_fraction=0.3)
    momentum = point_of(program, "quick", merged(scene, particles={"count": 60}), 12).measured(TARGET)
    # Bounds: Einstein's and Batchelor's 1 + 2.5 phi + 5.9 phi^2 below; 20 % above slow shear (2.3).
    return [Check("φ = 0.3: η_r at rest", "1 + 2.5 φ + 5.9 φ² (Batchelor 1977), ± 20 %", *momentum, 1.82, 2.9, 11)]


main(HERE, TITLE, measure, quick_measure, judge, draw)
