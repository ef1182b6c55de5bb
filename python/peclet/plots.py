"""Figures, with matplotlib."""
import re

import numpy as np

from peclet.program import PecletError, cure_for
from peclet.table import Table, cell_of

# What is swept, as axes name it; beside these the parameter's own name.
NAMES = {
    "peclet": "Pe",
    "volume_fraction": r"$\varphi$",
    "alpha": r"$\alpha$",
    "base_volume_fraction": r"$\varphi_0$",
    "friction": r"$\mu$",
    "kinetic_friction": r"$\mu_k$",
    "rolling_friction": r"$\mu_r$",
    "shear_rate": r"$\dot\gamma$",
    "normal_stiffness": r"$k_n$",
    "extension_rate": r"$\dot\varepsilon$",
    "uniaxial_rate": r"$\dot\varepsilon$",
    "stress": r"$\sigma$",
    "amplitude": r"$\gamma_0$",
    "frequency": r"$\omega$",
    "thermal_energy": r"$k_B T$",
    "inner_gap": "inner gap",
    "outer_gap": "outer gap",
    "particles_count": "$N$",
}
# Units that are those of the scene, and the scale of stresses of a flow at a given rate.
DIMENSIONS = re.compile(r"(1|(stress|energy|time|length|mass|force|viscosity)(\^\d+)?)( [/*] |$)")
UNITS = {"1": "", "viscosity * shear_rate": r"$\eta\dot\gamma$"}
GREEK = "alpha beta gamma delta eta theta kappa lambda mu rho sigma tau phi omega".split()
# Told apart in grey and by eyes that see few colours: Okabe & Ito (2008).
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
MARKS = "os^Dv<>"


def formula_of(symbol):
    """A symbol as quantities have it, such as eta_r or sigma^noise_xy, in matplotlib's mathematics."""
    text = re.sub(r"^<(.*)>$", r"\\langle \1\\rangle", symbol)
    text = re.sub(r"([_^])([A-Za-z0-9]{2,})", r"\1{\\mathrm{\2}}", text)
    text = re.sub(r"(?<![\\A-Za-z])rate(?![A-Za-z])", r"\\dot\\gamma", text)
    text = re.sub(r"(?<![\\A-Za-z])(" + "|".join(GREEK) + r")(?![A-Za-z])", r"\\\1", text)
    return f"${text}$"


def unit_text(unit):
    """As axes have it; the words of a scene's own units say no more than that."""
    return UNITS.get(unit, "scene units" if DIMENSIONS.sub("", unit) == "" and unit else unit)


def spans_a_decade(values):
    values = np.asarray(values, float)
    values = values[np.isfinite(values)]
    return len(values) > 1 and values.min() > 0 and values.max() >= 10 * values.min()


def swept(table):
    """Names of the parameters of a table of estimates, those with most values first."""
    axes = list(table.columns)[: list(table.columns).index("label")]
    return sorted(axes, key=lambda name: -len(set(table[name].tolist())))


def label_of(results, quantity):
    """The symbol and unit of a quantity, or of an element of one, such as stress/total/xy."""
    for row in results.quantities():
        if (quantity + "/").startswith(row["quantity"] + "/"):
            element = quantity[len(row["quantity"]) + 1 :].replace("/", ", ")
            unit = unit_text(row["unit"])
            return formula_of(row["symbol"]) + (f", {element}" if element else "") + (f"  [{unit}]" if unit else "")
    return quantity


def numbered(table, x):
    """The table with places 0, 1 ... for the values of column x, and these values as text, if some are words; else the
    table as it is, and None."""
    values = table[x].tolist()
    if not any(isinstance(value, str) for value in values):
        return table, None
    ticks = list(dict.fromkeys(values))
    return Table({**table.columns, x: [ticks.index(value) for value in values]}), [cell_of(value) for value in ticks]


def plot(results, quantity=None, x=None, by=None, axes=None, label=None, log=None, where=None):
    """Draws an estimate of every point over one swept parameter, with 95 % intervals, and returns matplotlib's Axes.

    quantity  the campaign's target unless given
    x         the swept parameter on the axis; the one with most values unless given. If it has words, such as "auto",
              its values stand side by side
    by        another one, of which each value is a series; all others that vary unless given
    axes      matplotlib's Axes to draw in; new ones unless given
    label     of the series, where it is a single one
    log       logarithmic axes: "", "x", "y" or "xy"; those that span a decade unless given
    where     values of swept parameters by name: of the points that have them

    Open marks are points that have not converged; without a bar they have had no look yet. Crosses have jammed: at
    their number, or at the edge of the frame where they have none.
    """
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as missing:
        raise PecletError(f"plots need matplotlib: {cure_for('matplotlib', 'python3-matplotlib')}") from missing
    table = results.estimates(quantity).where(**(where or {}))
    parameters = swept(table)
    if x is None and not parameters:
        raise PecletError("nothing is swept in this campaign: no axis to draw over")
    x = x or parameters[0]
    varying = [name for name in parameters if len(set(table[name].tolist())) > 1]
    others = [name for name in varying if name != x] if by is None else [by]
    table, ticks = numbered(table, x)
    if ticks and "x" in (log or ""):
        raise PecletError(f"{x}: has words, and no logarithmic axis")
    axes = axes or pyplot.subplots(figsize=(4.5, 3.4), layout="constrained")[1]
    table = without_survivors(table)
    table = table.take(np.isfinite(table["mean"]) | table["jammed"]).sorted_by(*others, x)
    groups = [tuple(row[name] for name in others) for row in table]
    for k, group in enumerate(sorted(set(groups), key=groups.index)):
        rows = table.take([g == group for g in groups])
        names = ", ".join(f"{NAMES.get(name, name)} = {cell_of(value)}" for name, value in zip(others, group))
        draw_series(axes, rows, x, COLOURS[k % len(COLOURS)], MARKS[k % len(MARKS)], names or label)
    if log is None:
        flowing = table.take(~table["jammed"])
        log = "".join(n for n, values in (("x", table[x]), ("y", flowing["mean"])) if spans_a_decade(values))
    axes.set_xscale("log" if "x" in log else "linear")
    axes.set_yscale("log" if "y" in log else "linear")
    if ticks:
        axes.set_xticks(range(len(ticks)), ticks)
    axes.set_xlabel(NAMES.get(x, x.replace("_", " ")))
    axes.set_ylabel(label_of(results, (quantity or results.target["observable"]).lstrip("/")))
    axes.tick_params(which="both", direction="in", top=True, right=True)
    jammed = table.take(table["jammed"])
    draw_jams(axes, jammed, x, [groups[k] for k in np.flatnonzero(table["jammed"])], groups)
    if others or label or len(jammed):
        axes.legend(frameon=False)
    return axes


def without_survivors(table):
    """At a point that has jammed a mean of half of its seeds or fewer is that of those which happened to flow."""
    # Before the first look nothing says how many have ended.
    ended = np.array([row["count" if row["provisional"] else "seeds"] for row in table], float)
    survivors = table["jammed"] & ~(2 * table["count"] > ended)
    hidden = {name: np.where(survivors, np.nan, table[name]) for name in ("mean", "standard_error", "half_width")}
    return Table(table.columns | hidden)


def draw_jams(axes, rows, x, own, groups):
    """Crosses; `own` are the groups of the rows, whose colours they have."""
    order = sorted(set(groups), key=groups.index)
    for k, (row, group) in enumerate(zip(rows, own)):
        mean, edge = row["mean"], None
        if not np.isfinite(mean):
            edge = 1
        elif axes.get_yscale() == "log" and mean <= 0:
            edge = 0
        place = {"transform": axes.get_xaxis_transform(), "clip_on": False} if edge is not None else {}
        colour = COLOURS[order.index(group) % len(COLOURS)]
        label = None if k else "jammed"
        axes.plot(row[x], mean if edge is None else edge, "x", color=colour, markersize=6, label=label, **place)


def draw_series(axes, rows, x, colour, mark, label):
    """Joined by a line, without what has jammed; filled marks where the point has converged."""
    rows = rows.take(~rows["jammed"])
    bars = np.nan_to_num(rows["half_width"])
    axes.errorbar(rows[x], rows["mean"], bars, color=colour, capsize=2, linewidth=1, marker="none")
    axes.plot(rows[x], rows["mean"], mark, color=colour, markersize=4.5, label=label)
    still = ~np.isin(rows["verdict"], ("converged", "complete"))
    axes.plot(rows[x][still], rows["mean"][still], mark, color=colour, markersize=4.5, markerfacecolor="white")
