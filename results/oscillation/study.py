#!/usr/bin/python3
"""Storage and loss moduli of a Brownian suspension in oscillatory shear, compared with linear response, and the
amplitude at which they differ."""
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.driver import BLUE, Check, Figure, Finding, GREEN, ORANGE, RED, REFERENCE_SCENE, difference, entries
from studies.driver import estimate, groups, main, merged, number, over, quotient, read_rows, where, write_rows

TITLE = "Oscillating shear beside linear response"
AT_REST = HERE.parent / "at-rest" / "curves.csv"
VISCOSITY, THERMAL_ENERGY, FRACTION = 0.1, 0.017, 0.45
BROWNIAN_TIME = VISCOSITY / THERMAL_ENERGY
SCENE = merged(
    REFERENCE_SCENE,
    particles={"count": 100},
    volume_fraction=FRACTION,
    fluid={"thermal_energy": THERMAL_ENERGY},
    flow={"shear_rate": None, "oscillation": {"amplitude": 0.1, "frequency": 1}},
    observables=["stress", "oscillation"],
    duration={"equilibration": None, "production": None},
)
# Frequencies over the Brownian one, from the table at rest; cycles of the window, and seeds.
FREQUENCIES = {0.86806: (32, 96), 3.4722: (64, 24), 6.9444: (128, 24)}
MIDDLE, SMALL = 3.4722, 0.1
AMPLITUDES = {0.05: 48, 0.1: 24, 0.3: 12, 1.0: 12}  # amplitudes at the middle frequency, with seeds
NAMES = "storage", "loss", "third_storage", "third_loss"


def settings_of(frequency, amplitude):
    # Forty Brownian times before the window.
    before = max(2, math.ceil(40 * frequency / (2 * math.pi)))
    return {
        "/flow/oscillation/amplitude": amplitude,
        "/flow/oscillation/frequency": frequency / BROWNIAN_TIME,
        "/duration/equilibration": {"cycles": before},
        "/duration/production": {"cycles": FREQUENCIES[frequency][0]},
    }


def row_of(program, frequency, amplitude, seeds):
    """Returns the row of a frequency and an amplitude, with moduli in units of kT / a^3, a = 1."""
    name = f"{frequency:g}-{amplitude:g}"
    (point,) = program.run(name, SCENE, [settings_of(frequency, amplitude)], seeds, "loss_modulus")
    row = {"frequency": frequency, "amplitude": amplitude, "seeds": len(point.results)}
    for name in NAMES:
        row |= entries(name, over(point.measured(f"{name}_modulus"), THERMAL_ENERGY))
    return row


def measure(program):
    rows = [row_of(program, MIDDLE, amplitude, seeds) for amplitude, seeds in AMPLITUDES.items()]
    rows += [row_of(program, f, SMALL, seeds) for f, (_, seeds) in FREQUENCIES.items() if f != MIDDLE]
    write_rows(HERE / "table.csv", rows, 5)


def read():
    return {(r["frequency"], r["amplitude"]): r for r in read_rows(HERE / "table.csv")}


def at_rest():
    """Returns storage and loss of linear response, by frequency."""
    curves = groups(where(read_rows(AT_REST), fraction=FRACTION), "curve")
    return {name: {row["at"]: number(row, "value") for row in curves[name]} for name in ("storage", "loss")}


def size_of_third(row):
    """Returns the size of the third harmonic over that of the first, and its standard error."""
    (storage, its), (loss, of_loss) = number(row, "third_storage"), number(row, "third_loss")
    size = math.hypot(storage, loss)
    error = math.hypot(storage * its, loss * of_loss) / size
    return over((size, error), math.hypot(row["storage"], row["loss"]))


def judge():
    rows, rest = read(), at_rest()
    cases = [(frequency, SMALL) for frequency in FREQUENCIES] + [(MIDDLE, 0.05)]
    for frequency, amplitude in cases:
        row = rows[frequency, amplitude]
        name = f"ωτ_B = {frequency:.2g}, amplitude {amplitude:g}"
        ratio = quotient(number(row, "loss"), rest["loss"][frequency])
        yield Check(f"{name}: G″ over that of linear response", "linear response", *ratio, 0.97, 1.03, row["seeds"] - 1)
        size = math.hypot(row["storage"], row["loss"])
        less = over(difference(number(row, "storage"), rest["storage"][frequency]), size)
        text = f"{name}: G′ less that of linear response, over the size of G*"
        yield Check(text, "linear response", *less, -0.03, 0.03, row["seeds"] - 1)
    for frequency in FREQUENCIES:
        row, alone = rows[frequency, SMALL], frequency * (1 + 2.5 * FRACTION)  # without pairs, η = kT = a = 1
        (loss, error), (its, of_rest) = number(row, "loss"), rest["loss"][frequency]
        pairs = quotient((loss - alone, error), (its - alone, of_rest))
        storage = quotient(number(row, "storage"), rest["storage"][frequency])
        text = f"ωτ_B = {frequency:.2g}, amplitude {SMALL:g}: share of G″ without pairs, ηω(1 + 2.5 φ)"
        yield Finding(text, "linear response", *over((alone, alone * error / loss), loss), row["seeds"] - 1)
        for what, found in (("G″ of the pairs", pairs), ("G′", storage)):
            text = f"ωτ_B = {frequency:.2g}, amplitude {SMALL:g}: {what} over that of linear response"
            yield Finding(text, "linear response", *found, row["seeds"] - 1)
    for what, found in (
        ("third harmonic over the first", size_of_third),
        ("G″ over that of linear response", lambda row: quotient(number(row, "loss"), rest["loss"][MIDDLE])),
    ):
        for amplitude in AMPLITUDES:
            row, text = rows[MIDDLE, amplitude], f"ωτ_B = {MIDDLE:.2g}, amplitude {amplitude:g}: {what}"
            yield Finding(text, "onset", *found(row), row["seeds"] - 1)


def draw():
    rows, rest = read(), at_rest()
    figure = Figure(HERE / "chart.png", columns=2)
    one = figure.panel("ωτ_B", "G a³ / kT", "φ = 0.45, amplitude 0.1", log="xy", powers="y", key="top left")
    for name, symbol, colour, points in (("loss", "G″", BLUE, RED), ("storage", "G′", GREEN, ORANGE)):
        curve = [(w, *v) for w, v in sorted(rest[name].items()) if v[0] > 2 * v[1]]
        one.points(curve, f"{symbol}, linear response", colour, 6, joined=True)
        one.points([(w, *number(rows[w, SMALL], name)) for w in FREQUENCIES], f"{symbol}, oscillating", points, 7, 1.3)
    one = figure.panel("amplitude", "", f"ωτ_B = {MIDDLE:.2g}", log="xy", y_range=(1e-3, 10), key="top left")
    scale = rest["loss"][MIDDLE][0]
    loss = [(a, *over(number(rows[MIDDLE, a], "loss"), scale)) for a in AMPLITUDES]
    one.points(loss, "G″ over that of linear response", BLUE, joined=True)
    third = [(a, *size_of_third(rows[MIDDLE, a])) for a in AMPLITUDES]
    one.points(third, "third harmonic over the first", RED, joined=True)
    figure.draw()


def quick_measure(program):
    """Yields checks of a dilute suspension without noise: its loss is Einstein's, its storage is that of inertia, 0."""
    scene = merged(
        SCENE, particles={"count": 50, "density": 1e-3}, volume_fraction=0.05, fluid={"thermal_energy": None}
    )
    settings = settings_of(MIDDLE, 0.01) | {
        "/duration/equilibration": {"cycles": 0},
        "/duration/production": {"cycles": 1},
    }
    (point,) = program.run("quick", scene, [settings], 4, "loss_modulus")
    dynamic = point.measured("dynamic_viscosity")
    yield Check("φ = 0.05: η′/η", "1 + 2.5 φ and pairs", *dynamic, 1.124, 1.2, 3)
    storage = estimate([m["storage_modulus"] / m["loss_modulus"] for m in point.means])
    yield Check("φ = 0.05: G′ over G″", "inertia", *storage, -0.01, 0.01, 3)


main(HERE, TITLE, measure, quick_measure, judge, draw)
