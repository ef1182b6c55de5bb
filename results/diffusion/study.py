#!/usr/bin/python3
"""Mean squared displacements of dilute spheres, and self-diffusion from dilute to dense suspensions."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLACK, BLUE, Check, Figure, Finding, GREEN, GREY, RED, REFERENCE_SCENE, Statement, difference
from studies.driver import during, estimate, groups, in_brownian_times, line_through, main, merged, over, quotient
from studies.driver import read_rows, weighted_mean, where, write_rows
import numpy as np

TITLE = "Mean squared displacement and self-diffusion"
AT_REST = merged(REFERENCE_SCENE, flow={"shear_rate": 0}, observables=["stress", "mean_squared_displacement"])

# tau_I = 0.1, tau_C = 1e-3; explicit steps, because inertia is studied.
VISCOSITY, DENSITY, STIFFNESS = 1.0, 0.1, 1e5
INERTIAL_TIME = DENSITY / VISCOSITY
RATIOS = (1.7, 0.17, 0.017)  # tau_I / tau_B
HOT, WARM, COLD = RATIOS
DILUTE_SEEDS, CROWDED_SEEDS = 128, 32
DILUTE = merged(
    AT_REST,
    during({"time": 0.5}, {"time": 6}),
    particles={"count": 100, "density": DENSITY},
    volume_fraction=0.001,
    fluid={"viscosity": VISCOSITY},
    contact={"normal_stiffness": STIFFNESS},
    integrator={"method": "explicit", "timestep": 2e-5},
    mean_squared_displacement={"interval": 5e-4},
)

# The published units, tau_I = 1.
FRACTIONS = (0.001, 0.1, 0.2, 0.3, 0.4, 0.45, 0.5, 0.55)
CROWDED = merged(AT_REST, in_brownian_times(10, 9), particles={"count": 250}, integrator={"method": "implicit"})

# By the window, the shorter of the two lags between which D is the slope of |Δr|² [Brownian times].
LAGS = {9: 1, 90: 12, 180: 24}
# Windows ten and twenty times longer, for the limit of long times: volume fractions and ratios by window.
LONG = {90: ((0.001, 0.1, 0.3, 0.5), (WARM, COLD)), 180: ((0.1, 0.3, 0.5), (COLD,))}
LONG_SEEDS = {0.001: 18, 0.1: 18, 0.3: 18, 0.5: 72}

# Volume fractions at short times, with the inertia of HOT.
BALLISTIC_FRACTIONS, BALLISTIC_SEEDS = (0.001, 0.1, 0.3, 0.5, 0.55), 32
BALLISTIC = merged(
    CROWDED,
    during({"brownian_times": 10}, {"time": 4}),
    integrator={"method": "explicit"},
    mean_squared_displacement={"interval": 0.005},
)
SHORT_LAG = 0.005  # over tau_I


def thermal_energy(ratio, viscosity, density):
    """Returns the kT at which tau_I / tau_B = (rho a^2 / eta) (kT / (eta a^3)) has this value, a = 1."""
    return ratio * viscosity**2 / density


def free_displacement(time, energy, radius):
    """Returns <x^2> of a free sphere along one axis, (2 kT m / zeta^2) (zeta t / m - 1 + exp(-zeta t / m)) (L4.1)."""
    mass, zeta = 4 / 3 * math.pi * DENSITY * radius**3, 6 * math.pi * VISCOSITY * radius
    return 2 * energy * mass / zeta**2 * (zeta * time / mass - 1 + np.exp(-zeta * time / mass))


def dilute_curves(program, ratios, seeds, patch=None):
    """Yields rows of time, measured and free displacement of the small spheres, for each ratio.

    `over_free` and its standard error are the measured over the free displacement, mean over both species.
    """
    energies = [thermal_energy(r, VISCOSITY, DENSITY) for r in ratios]
    settings = [{"/fluid/thermal_energy": energy} for energy in energies]
    points = program.run("dilute", merged(DILUTE, patch or {}), settings, seeds, "kinetic_temperature")
    for ratio, energy, point in zip(ratios, energies, points):
        displacements = [r["mean"]["mean_squared_displacement"] for r in point["realisations"]]
        times = np.array(displacements[0]["time"])
        by_species = np.array(
            [[small_of(s) / free_displacement(times, energy, s["radius"]) for s in d["species"]] for d in displacements]
        )
        for k, (time, free) in enumerate(zip(times.tolist(), free_displacement(times, energy, 1.0).tolist())):
            mean, error = estimate(by_species[:, :, k].mean(axis=1))
            displacement = estimate(by_species[:, 0, k])[0] * free
            row = {"ratio": ratio, "time": time, "displacement": displacement, "free": free}
            yield {**row, "over_free": mean, "standard_error": error}


def small_of(species):
    """Returns the mean displacement over the axes."""
    return np.mean([species[axis] for axis in "xyz"], axis=0)


def dilute_statements(curves, seeds, tolerance):
    """Yields a statement for each range of times, about the row furthest from the formula in standard errors."""
    for ratio, rows in curves.items():
        for name, low, high in (("before", 0, 0.1), ("around", 0.1, 1), ("beyond", 1, 30)):
            between = [r for r in rows if low * INERTIAL_TIME <= r["time"] <= high * INERTIAL_TIME]
            row = max(between, key=lambda r: abs(r["over_free"] - 1) / r["standard_error"])
            place = f"(t = {row['time'] / INERTIAL_TIME:.3g} τ_I)"
            text = f"τ_I/τ_B = {ratio}: displacement over L4.1 at its worst {name} τ_I {place}"
            found = row["over_free"], row["standard_error"]
            yield Statement(text, "L4.2a", *found, 1 - tolerance, 1 + tolerance, seeds - 1)


def slope_between(displacement, lag, brownian_time):
    """Returns the slope of |Δr|² of all spheres about their centre between `lag` and twice as much, in Brownian times,
    over that of a free sphere of radius 1, kT / (π η a).

    ln |Δr|² is interpolated over ln t, because the lags of a run go with its step.
    """
    times = np.array(displacement["time"]) / brownian_time
    squares = sum(np.subtract(displacement["all"][axis], displacement["centre"][axis]) for axis in "xyz")
    ends = np.log([lag, 2 * lag])
    near, far = np.exp(np.interp(ends, np.log(times), np.log(squares), np.nan, np.nan))
    return float(math.pi * (far - near) / lag)


def diffusion(program, ratios, fractions, seeds, window=9, patch=None, name="crowded"):
    """Returns rows of D / D_0 between the lags of a window [Brownian times]."""
    cases = [(r, f) for r in ratios for f in fractions]
    energies = [thermal_energy(r, 0.1, 0.1) for r, _ in cases]
    settings = [{"/volume_fraction": f, "/fluid/thermal_energy": e} for (_, f), e in zip(cases, energies)]
    scene = merged(CROWDED, {"duration": {"production": {"brownian_times": window}}}, patch or {})
    rows = []
    for case, energy, point in zip(cases, energies, program.run(name, scene, settings, seeds, "self_diffusion")):
        found = [slope_between(m["mean_squared_displacement"], LAGS[window], 0.1 / energy) for m in point.means]
        names = "ratio", "fraction", "seeds", "diffusion", "standard_error"
        rows.append(dict(zip(names, (*case, len(found), *estimate(found)))))
    return rows


def long_times(program):
    """Yields rows of diffusion with the windows of LONG."""
    for window, (fractions, ratios) in LONG.items():
        for fraction in fractions:
            name = f"crowded-{window}-{fraction:g}"
            for row in diffusion(program, ratios, [fraction], LONG_SEEDS[fraction], window, name=name):
                yield {"method": f"implicit, windows of {window}", **row}


def short_times(program):
    """Yields rows of the displacement of small spheres over the ballistic one, kT t^2 / m along each axis."""
    energy = thermal_energy(HOT, 0.1, 0.1)
    scene = merged(BALLISTIC, fluid={"thermal_energy": energy})
    settings = [{"/volume_fraction": f} for f in BALLISTIC_FRACTIONS]
    points = program.run("ballistic", scene, settings, BALLISTIC_SEEDS, "kinetic_temperature")
    for fraction, point in zip(BALLISTIC_FRACTIONS, points):
        found = [mean["mean_squared_displacement"] for mean in point.means]
        times = np.array(found[0]["time"])
        free = energy * times**2 / (4 / 3 * math.pi * 0.1)
        small = np.array([small_of(d["species"][0]) / free for d in found])
        for time, values in zip(times.tolist(), small.T):
            value, error = estimate(values)
            row = {"fraction": fraction, "seeds": len(small), "time": time, "over_ballistic": value}
            yield {**row, "standard_error": error}


def measured(row):
    return row["diffusion"], row["standard_error"]


def measured_ratio(a, b):
    return quotient(measured(a), measured(b))


def beside(a, b):
    """Returns the ratio of two rows that should be equal, with the error for a ratio of 1."""
    return a["diffusion"] / b["diffusion"], math.hypot(a["standard_error"], b["standard_error"]) / b["diffusion"]


def line_of(rows):
    """Returns the least-squares line D(phi): intercept, slope over intercept and its standard error, and residuals."""
    x, y, errors = (np.array([r[name] for r in rows]) for name in ("fraction", "diffusion", "standard_error"))
    intercept, slope, slope_error = line_through(x, y, errors)
    mean_x, mean_error = weighted_mean(x, errors)
    ratio = slope / intercept
    # The intercept is the value at the mean of x, with an independent error, minus mean_x times the slope.
    ratio_error = math.hypot(slope_error * (1 + ratio * mean_x), ratio * mean_error) / abs(intercept)
    return intercept, ratio, ratio_error, (y - intercept - slope * x).tolist()


def crossover_rows(curves, degrees):
    """Yields statements about the crossover, published at 0.01 for τ_I/τ_B of order 0.01, to half a decade.

    The thesis has two Brownian times, η a³ / kT (3.57) and one with 6π (2.3).
    """
    for ratio, words in ((COLD, f"{COLD:g}"), (WARM, f"{WARM / (6 * math.pi):.2g} with 6πηa³/kT (else {WARM:g})")):
        rows = curves[ratio]
        times, displacements = np.log([(r["time"], r["displacement"]) for r in rows]).T
        found = float(np.interp(math.log(INERTIAL_TIME), times, displacements)) / math.log(10)
        error = next(r for r in rows if r["time"] >= INERTIAL_TIME)["standard_error"] / math.log(10)
        text = f"τ_I/τ_B = {words}: log10 of ⟨x²⟩ / a² at t = τ_I (published: -2 for τ_I/τ_B of order 10⁻²)"
        yield Statement(text, "L 4.2.4", found, error, -2.5, -1.5, degrees, essential=ratio == WARM)


def temperature_rows(long, short):
    """Yields statements about long times, and findings about short times, with more volume fractions. A dependence on
    the temperature above 0.17 is not published."""
    text = "D / D_0 at τ_I/τ_B = 0.17 over that at 0.017"
    for warm, cold in zip(long[WARM], long[COLD]):
        name, degrees = f"φ = {cold['fraction']:g}, lags of 12 and 24 τ_B: {text}", cold["seeds"] - 1
        yield Statement(name, "L4.2d", *beside(warm, cold), 0.9, 1.1, degrees)
    for fraction in FRACTIONS:
        warm, cold = short[WARM, fraction], short[COLD, fraction]
        yield Finding(f"φ = {fraction:g}, lags of 1 and 2 τ_B: {text}", "L4.2d", *beside(warm, cold), cold["seeds"] - 1)
    text = "φ = 0.5, lags of 1 and 2 τ_B: D / D_0 at τ_I/τ_B = 1.7 over that at 0.017"
    yield Finding(text, "L4.2d", *measured_ratio(short[HOT, 0.5], short[COLD, 0.5]), short[HOT, 0.5]["seeds"] - 1)


def short_time_rows(of, degrees):
    """Yields findings for lags of 1 and 2 Brownian times, at which spheres have hardly met their neighbours."""
    intercept, slope, slope_error, residuals = line_of([of[COLD, f] for f in FRACTIONS])
    residual, fraction = max(zip(residuals, FRACTIONS), key=lambda r: abs(r[0]))
    text = (
        f"lags of 1 and 2 τ_B: largest distance of D / D_0 from a line in φ (at φ = {fraction:g}) over its dilute value"
    )
    yield Finding(text, "L4.2d", *over((residual, of[COLD, fraction]["standard_error"]), intercept), degrees)
    yield Finding("lags of 1 and 2 τ_B: slope of that line over the dilute value", "L4.2d", slope, slope_error, degrees)


def long_time_rows(table):
    """Yields statements about D(phi) at long times, and its distance from a line through the first and last points."""
    degrees = table[0]["seeds"] - 1
    for low, high in zip(table, table[1:]):
        text = f"lags of 12 and 24 τ_B: D / D_0 at φ = {high['fraction']:g} over that at {low['fraction']:g}: it falls"
        yield Statement(text, "L4.2c", *measured_ratio(high, low), high=1, degrees=degrees)
    thin, *middle, dense = table
    width, distances = dense["fraction"] - thin["fraction"], []
    for row in middle:
        part = (row["fraction"] - thin["fraction"]) / width
        on_line = thin["diffusion"] + part * (dense["diffusion"] - thin["diffusion"])
        errors = row["standard_error"], (1 - part) * thin["standard_error"], part * dense["standard_error"]
        distances.append((row["diffusion"] - on_line, math.hypot(*errors), row["fraction"]))
    *distance, fraction = max(distances, key=lambda d: abs(d[0]))
    text = "lags of 12 and 24 τ_B: largest distance of D / D_0 from the line through the first and the last φ"
    text += f" (at φ = {fraction:g}) over its dilute value"
    yield Statement(text, "L4.2d", *over(distance, thin["diffusion"]), -0.05, 0.05, degrees)
    slope = quotient(difference(measured(dense), measured(thin)), measured(thin))
    text = (
        "lags of 12 and 24 τ_B: slope of that line over the dilute value (hard spheres without hydrodynamics: about -2)"
    )
    yield Finding(text, "L4.2d", *over(slope, width), degrees)


def constant_rows(of):
    """Yields statements that D approaches a constant, within a tenth, which logarithmic axes do not resolve."""
    for fraction in LONG[180][0]:
        long, longer = of["implicit, windows of 90", fraction], of["implicit, windows of 180", fraction]
        text = f"φ = {fraction:g}: D between lags of 24 and 48 τ_B over that between 12 and 24"
        found = measured_ratio(longer, long)
        yield Statement(f"{text}: it approaches a constant", "L4.2c", *found, 0.9, 1.1, long["seeds"] - 1)
    for fraction in LONG[90][0]:
        short, long = of["implicit", fraction], of["implicit, windows of 90", fraction]
        text = f"φ = {fraction:g}: D between lags of 1 and 2 τ_B over that between 12 and 24"
        yield Finding(text, "L4.2c", *measured_ratio(short, long), long["seeds"] - 1)


def ballistic_rows(table):
    """Yields rows about short times. "Roughly independent" of φ is tested to a tenth, at a lag far below τ_I.

    At any lag the displacement depends on φ, by the friction of neighbours, and at none for t → 0.
    """
    for lag, kind in ((SHORT_LAG, Statement), (10 * SHORT_LAG, Finding)):
        of_fraction = groups(table, "fraction").values()
        dilute, *crowded = (min(rows, key=lambda r: abs(r["time"] - lag)) for rows in of_fraction)
        for row in crowded:
            text = f"φ = {row['fraction']:g}, τ_I/τ_B = 1.7: ⟨x²⟩ at t = {lag:g} τ_I over that at φ = 0.001"
            found = quotient(*((r["over_ballistic"], r["standard_error"]) for r in (row, dilute)))
            bounds = {} if kind is Finding else {"low": 0.9, "high": 1.1, "essential": False}
            yield kind(text, "L4.2b", *found, degrees=row["seeds"] - 1, **bounds)


def judge():
    curves, table = groups(read_rows(HERE / "displacement.csv"), "ratio"), read_rows(HERE / "table.csv")
    crowded, (explicit,) = (where(table, method=method) for method in ("implicit", "explicit"))
    of, seeds = {(r["ratio"], r["fraction"]): r for r in crowded}, min(r["seeds"] for r in crowded)
    long = {ratio: where(table, method="implicit, windows of 90", ratio=ratio) for ratio in (WARM, COLD)}
    yield from dilute_statements(curves, DILUTE_SEEDS, 0.02)
    yield from crossover_rows(curves, DILUTE_SEEDS - 1)
    yield from ballistic_rows(read_rows(HERE / "ballistic.csv"))
    yield from temperature_rows(long, of)
    yield from long_time_rows(long[COLD])
    yield from constant_rows({(r["method"], r["fraction"]): r for r in table if r["ratio"] == COLD})
    yield from short_time_rows(of, seeds - 1)
    # Mean of 1 / a over the spheres, 2.744 small ones for each large one.
    free = over(measured(of[COLD, FRACTIONS[0]]), (2.744 + 1 / 1.4) / 3.744)
    yield Check("dilute limit of D / D_0 over the mean of a / a_i", "formula", *free, 0.95, 1.05, seeds - 1)
    methods = beside(of[WARM, 0.3], explicit)
    yield Check("φ = 0.3: implicit steps over explicit ones", "method", *methods, 0.9, 1.1, explicit["seeds"] - 1)


def measure(program):
    displacements = list(dilute_curves(program, RATIOS, DILUTE_SEEDS))
    one = {"integrator": {"method": "explicit"}}
    rows = [{"method": "implicit", **row} for row in diffusion(program, RATIOS, FRACTIONS, CROWDED_SEEDS)]
    explicit = diffusion(program, [WARM], [0.3], 8, patch=one, name="crowded-explicit")
    rows += [{"method": "explicit", **row} for row in explicit]
    rows += long_times(program)
    write_rows(HERE / "table.csv", rows, 5)
    write_rows(HERE / "displacement.csv", displacements, 5)
    write_rows(HERE / "ballistic.csv", list(short_times(program)), 5)


def draw():
    curves, table = groups(read_rows(HERE / "displacement.csv"), "ratio"), read_rows(HERE / "table.csv")
    figure = Figure(HERE / "chart.png", columns=2)
    colours = dict(zip(RATIOS, (RED, GREEN, BLUE)))
    panel = figure.panel("t / τ_I", "⟨x²⟩ / a², φ = 0.001", log="xy", powers="xy", key="bottom right")
    for ratio, rows in curves.items():
        times = [r["time"] / INERTIAL_TIME for r in rows]
        panel.line(zip(times, (r["free"] for r in rows)), None if ratio != RATIOS[0] else "L4.1")
        panel.points(zip(times, (r["displacement"] for r in rows)), f"τ_I/τ_B = {ratio:g}", colours[ratio], size=0.7)
    panel = figure.panel("φ", "D / D_0", x_range=(-0.02, 0.6), y_range=(0, 1.1))

    def bars(**equal):
        return [(r["fraction"], r["diffusion"], 2 * r["standard_error"]) for r in where(table, **equal)]

    for ratio in (WARM, COLD):
        name = f"τ_I/τ_B = {ratio:g}, lags of 12 and 24 τ_B"
        long = bars(method="implicit, windows of 90", ratio=ratio)
        panel.points(long, name, colours[ratio], mark=6 if ratio == WARM else 7, size=1.2 if ratio == WARM else 0.7)
    panel.line([long[0][:2], long[-1][:2]], "line through the first and the last", BLACK)
    panel.points(
        bars(method="implicit", ratio=COLD), "τ_I/τ_B = 0.017, lags of 1 and 2 τ_B", GREY, size=0.5, joined=True
    )
    figure.draw()


def quick_measure(program):
    seeds = 8
    small = {"particles": {"count": 50}, "duration": {"production": {"time": 3}}}
    yield from dilute_statements({HOT: list(dilute_curves(program, [HOT], seeds, small))}, seeds, 0.1)
    free, dense = diffusion(program, [WARM], [0.001, 0.45], seeds, patch={"particles": {"count": 100}})
    yield Statement("D at φ = 0.45 over D at 0.001", "L4.2c", *measured_ratio(dense, free), 0.05, 0.5, seeds - 1)


main(HERE, TITLE, measure, quick_measure, judge, draw)
