"""Makes the output of `peclet fit`, as text or JSON, and its figure.

The program asks by answer.py, with a document of points and options.
"""
import math

import numpy as np

from peclet import laws, spectrum
from peclet.drawing import about_key, about_quantity, follows, is_logarithmic, plain, swept, word_of
from peclet.jamming import FEWEST_SEEDS, NotDetermined
from peclet.jamming_report import counted, folded, given_or_measured, in_json, with_error

STRESS = "/flow/stress"
PLACES = 120  # of a curve in the figure
RATE_UNIT = "η γ̇"  # of stresses at a given rate


class Refused(Exception):
    """An option or the campaign does not suit the law: option, value, and the rule that it breaks."""


class Series:
    """The points of one fit: what else is swept, and the numbers of each quantity.

    x         values of the axis (n,)
    numbers   means, standard errors and counts (quantities, 3, n); NaN if unknown
    """

    def __init__(self, name, settings, points, x, numbers):
        self.name, self.settings, self.points, self.x, self.numbers = name, settings, points, x, numbers
        self.why = [self.why_left_out(k) for k in range(len(points))]

    def why_left_out(self, k):
        """Returns why a point is not fitted, or ""."""
        if self.points[k]["jammed"]:
            return "jammed"
        for mean, error, count in self.numbers[:, :, k]:
            if math.isnan(mean):
                return "no number yet"
            if count < FEWEST_SEEDS or not error > 0:
                return f"no error yet, {FEWEST_SEEDS} seeds with a value are needed"
        return ""

    def used(self):
        return np.array([not why for why in self.why])


def series_of(document):
    """Returns the Series of a document, one for each combination of values of what is swept besides the axes."""
    data = document["quantities"]
    points = data[0]["points"]
    columns = [swept(parameter, points) for parameter in data[0]["parameters"]]
    axes = [one for one in columns if one["pointer"] in (document["over"], document["beside"])]
    for one in axes:
        if not one["numeric"]:
            raise Refused("--over", one["pointer"], "must be a swept number")
    if document["beside"] and len(axes) < 2:
        raise Refused("--law", document["law"], f"is a law of the given stress, too: the sweep must have {STRESS}")
    axis = next(one for one in axes if one["pointer"] == document["over"])
    others = [c for c in columns if c not in axes and len(c["values"]) > 1 and not any(follows(c, a) for a in axes)]
    groups = {}
    low, high = (math.inf if end is None else end for end in (document["from"], document["to"]))
    for k, x in enumerate(axis["cells"]):
        if (low == math.inf or x >= low) and x <= high:
            groups.setdefault(tuple(one["words"][k] for one in others), []).append(k)
    found = []
    for words, places in groups.items():
        names = [
            part for one, word in zip(others, words) for part in (*plain(", "), *one["name"], *plain(f" = {word}"))
        ]
        settings = {one["pointer"]: one["cells"][places[0]] for one in others}
        chosen = sorted(places, key=lambda k: axis["cells"][k])
        keys = ("mean", "standard_error", "count")
        numbers = [
            [[math.nan if p[key] is None else p[key] for p in (of["points"][k] for k in chosen)] for key in keys]
            for of in data
        ]
        x = np.array([axis["cells"][k] for k in chosen], float)
        found.append(Series(names[1:], settings, [points[k] for k in chosen], x, np.array(numbers, float)))
    return found


# Fits: each takes a Series and the document, and returns the Fitted and the marks and lines of its curves.


def places_between(x, logarithmic):
    return (np.geomspace if logarithmic else np.linspace)(x.min(), x.max(), PLACES)


def line(x, curve):
    return {"x": x.tolist(), "y": curve[0].tolist(), "low": curve[1].tolist(), "high": curve[2].tolist()}


def of_one_curve(function, series, document):
    """Fits a law of one quantity over one axis."""
    used = series.used()
    x, (mean, error, count) = series.x[used], series.numbers[0][:, used]
    factor = np.ones(len(series.x))
    if function is laws.herschel_bulkley and "viscosity" in document["quantities"][0]["quantities"][0]["path"]:
        factor = series.x
    options = {"fixed": document["fixed"], "free": document["free"]}
    fit = function(x, mean * factor[used], error * factor[used], count, **options)
    drawn = places_between(x, is_logarithmic(x.tolist()))
    return fit, [curve_of("", series, series.x, series.numbers[0][:2] * factor, line(drawn, fit.curve(drawn)))]


def of_wyart_cates(series, document):
    used, jammed = series.used(), np.array([why == "jammed" for why in series.why])
    stress = np.array([point["settings"][STRESS] for point in series.points], float)
    mean, error, count = series.numbers[0]
    bound = mean[used].max(initial=0)
    for k in np.flatnonzero(jammed):
        series.why[k] = f"jammed: its viscosity is above {bound:.4g}, the largest that was seen"
    censored = np.stack([series.x, stress, np.full(len(stress), bound)], axis=1)[jammed]
    arrays = (array[used] for array in (series.x, stress, mean, error, count))
    fit = laws.wyart_cates(*arrays, censored, fixed=document["fixed"], free=document["free"])
    curves = []
    for fraction in np.unique(series.x):
        own = series.x == fraction
        drawn = places_between(stress, True)
        name = plain(f"φ = {word_of(float(fraction), [])}")
        curves.append(
            curve_of(name, series, stress, series.numbers[0][:2], line(drawn, fit.curve(fraction, drawn)), own)
        )
    return fit, curves


def of_mu_of_j(series, document):
    """J = 1 / P and mu = eta_r / P, with the pressure P in units of viscosity times rate."""
    viscosity, pressure = series.numbers
    known = document["quantities"][1]["quantities"][0]
    if known["unit"] != RATE_UNIT:
        raise Refused("--law", document["law"], f"needs flow at a given rate, where {known['path']} is in {RATE_UNIT}")
    sign = -1 if known["path"].startswith("stress/") else 1
    relative, of_pressure = viscosity[1] / viscosity[0], pressure[1] / np.abs(pressure[0])
    viscous, friction = sign / pressure[0], sign * viscosity[0] / pressure[0]
    viscous, friction = (viscous, viscous * of_pressure), (friction, friction * np.hypot(relative, of_pressure))
    used = series.used()
    arrays = (array[used] for array in (series.x, *viscous, *friction, np.minimum(viscosity[2], pressure[2])))
    fit = laws.mu_of_j(*arrays, fixed=document["fixed"], free=document["free"])
    drawn = places_between(viscous[0][used], True)
    both = [np.split(part, 2) for part in fit.curve(drawn)]
    return fit, [
        curve_of(plain(name), series, viscous[0], numbers, line(drawn, [part[k] for part in both]))
        for k, (name, numbers) in enumerate((("μ", friction), ("φ", (series.x, np.zeros(len(series.x))))))
    ]


def of_maxwell(series, document):
    for name in [*document["fixed"], *document["free"]]:
        raise laws.WrongParameter(name, "is no parameter of maxwell, which has weights alone")
    used = series.used()
    storage, loss = series.numbers
    count = np.minimum(storage[2], loss[2])[used]
    fit = spectrum.maxwell_of_frequency(series.x[used], *storage[:2, used], *loss[:2, used], count)
    drawn = places_between(series.x[used], True)
    both = [np.split(part, 2) for part in fit.curve(drawn)]
    return fit, [
        curve_of(plain(name), series, series.x, of[:2], line(drawn, [part[k] for part in both]))
        for k, (name, of) in enumerate((("G′", storage), ("G″", loss)))
    ]


FITS = {
    "divergence": lambda *given: of_one_curve(laws.divergence, *given),
    "herschel-bulkley": lambda *given: of_one_curve(laws.herschel_bulkley, *given),
    "cross": lambda *given: of_one_curve(laws.cross, *given),
    "wyart-cates": of_wyart_cates,
    "mu-of-j": of_mu_of_j,
    "maxwell": of_maxwell,
}


# The figure


def curve_of(name, series, x, numbers, drawn, own=None):
    """Returns the marks and the line of one curve; `own` chooses points of the series."""
    chosen = range(len(x)) if own is None else np.flatnonzero(own)
    marks = []
    for k in chosen:
        y, error = (None if math.isnan(number[k]) else float(number[k]) for number in numbers)
        kind = "jammed" if series.points[k]["jammed"] else "undecided" if series.why[k] else "decided"
        if y is not None or kind == "jammed":
            half = None if error is None else 1.96 * error
            marks.append({"x": float(x[k]), "y": y, "half": half, "kind": kind})
    return {"name": name, "marks": marks, "line": drawn}


def panel_of(curves, first):
    """Returns a panel of curves, whose series are numbered from `first`."""
    panel = {"marks": [], "lines": [], "bands": []}
    for place, one in enumerate(curves, first):
        panel["marks"] += [{"series": place, **mark} for mark in one["marks"]]
        if drawn := one["line"]:
            finite = [k for k, y in enumerate(drawn["y"]) if math.isfinite(y)]
            x, y = ([drawn[name][k] for k in finite] for name in "xy")
            panel["lines"].append({"series": place, "style": "line", "places": list(map(list, zip(x, y)))})
            ends = [[drawn[name][k] for name in ("x", "low", "high")] for k in finite]
            panel["bands"].append({"series": place, "places": [place for place in ends if np.isfinite(place).all()]})
    return panel


def about_axes(document):
    """Returns what the axes of the figure are called: {words, symbol, unit} of x and y."""
    data = document["quantities"]
    key = next(one for one in data[0]["parameters"] if one["pointer"] == document["over"])
    x, y = about_key(key), about_quantity(data[0]["quantities"][0])
    if document["law"] == "wyart-cates":
        x = about_key(next(one for one in data[0]["parameters"] if one["pointer"] == STRESS))
    if document["law"] == "mu-of-j":
        x = {"words": "viscous number", "symbol": plain("J"), "unit": ""}
        y = {"words": "friction and volume fraction", "symbol": [], "unit": ""}
    if document["law"] == "maxwell":
        y = {"words": "moduli", "symbol": [], "unit": y["unit"]}
    if document["law"] == "herschel-bulkley" and "viscosity" in data[0]["quantities"][0]["path"]:
        y = {"words": f"{y['words']} × {x['words']}", "symbol": [], "unit": ""}
    return x, y


def figure_of(document, fits):
    """Returns the figure of drawing.py for (Series, fit, curves)."""
    of_many = [curves for _, _, curves in fits if len(curves) > 1]
    if of_many:
        panels = [panel_of(curves, 0) | {"title": series.name} for series, _, curves in fits if curves]
        legend = [one["name"] for one in of_many[0]]
    else:
        panels = [panel_of([curve for _, _, curves in fits for curve in curves], 0)]
        legend = [series.name for series, _, curves in fits if curves and series.name]
    x, y = about_axes(document)
    marks = [mark for panel in panels for mark in panel["marks"]]
    numbers = [mark["y"] for mark in marks if mark["y"] is not None]
    return {
        "x": {"about": x, "log": is_logarithmic([mark["x"] for mark in marks]), "categories": None},
        "y": {"about": y, "log": is_logarithmic(numbers), "categories": None},
        "panels": panels,
        "legend": [{"series": k, "name": name} for k, name in enumerate(legend)],
        "kinds": sorted({"jammed" for mark in marks if mark["kind"] == "jammed"}),
        "hasBand": True,
        "bandName": "95 % of the law",
        "notes": [],
    }


# The text


def words_of(name):
    """Returns parts of a name as a text."""
    return "".join(part["text"] for part in name)


def number_text(number):
    if number.obstacle:
        return "not determined"
    return given_or_measured((number.value, number.standard_error))


def interval_text(number):
    """Returns the ends of an interval to the second digit of the error."""
    texts = [with_error((end, number.standard_error)) for end in number.interval]
    if any(text.startswith("(") for text in texts):  # with a power of ten
        return "{:.3g} to {:.3g}".format(*number.interval)
    return " to ".join(text.split(" ± ")[0] for text in texts)


def table(fits):
    """Returns the lines of a table of all parameters."""
    head = ["curve", "parameter", "value ± error", "95 % interval", "without the lowest", "without the highest"]
    rows = []
    for series, fit, _ in fits:
        if isinstance(fit, NotDetermined):
            rows.append([words_of(series.name), "not determined", "", "", "", ""])
            continue
        for name, number in {**fit.parameters, **fit.derived}.items():
            interval = interval_text(number) if number.interval else "-"
            ends = []
            for end in head[4:]:
                other = fit.ends.get(end)
                known = isinstance(other, laws.Fitted) and {**other.parameters, **other.derived}.get(name)
                ends.append(number_text(known) if known else "-")
            rows.append([words_of(series.name), name, number_text(number), interval, *ends])
    kept = [k for k in range(6) if any(row[k] not in ("", "-") for row in rows)]
    lines = [[row[k] for k in kept] for row in [head, *rows]]
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join("  ".join(f"{cell:{w}}" for cell, w in zip(row, widths)).rstrip() for row in lines)


def text_of(document, fits):
    """Returns the output for people."""
    names = ", ".join(one["quantities"][0]["path"] for one in document["quantities"])
    equation = next((fit.equation for _, fit, _ in fits if isinstance(fit, laws.Fitted)), "")
    text = f"{document['campaign']}: {names} over {document['over']}, {counted(len(fits), 'curve')}\n"
    text += f"{document['law']}{': ' + equation if equation else ''}\n\n{table(fits)}\n"
    for series, fit, _ in fits:
        name = words_of(series.name)
        said = [f"not determined, {fit}"] if isinstance(fit, NotDetermined) else goodness(series, fit)
        said += left_out(series)
        text += "\n" + folded("\n".join(f"{name}: {one}" if name else one for one in said)) + "\n"
    meaning = (
        "intervals: of 95 %, by redraws of every point with the error of its seeds; they hold if the law does. "
        "without the lowest, the highest: the fits without the points at that end of the axis"
    )
    return f"{text}\n{folded(meaning)}\n"


def goodness(series, fit):
    """Returns sentences about a fit: its chi^2, what is not determined, remarks."""
    head = f"chi^2/degrees {fit.chi_squared:.2f}/{fit.degrees} (p = {fit.p_value:.2g}), "
    said = [head + f"{int(series.used().sum())} of {counted(len(series.points), 'point')}"]
    for name, number in {**fit.parameters, **fit.derived}.items():
        if number.obstacle:
            said.append(f"{name} is not determined: {number.obstacle}")
    return said + fit.remarks


def left_out(series):
    places = {}
    for point, why in zip(series.points, series.why):
        if why:
            places.setdefault(why, []).append(point["label"])
    return [f"{'censored' if ':' in why else 'left out'}, {why}: {', '.join(labels)}" for why, labels in places.items()]


# JSON


def number_json(number):
    return {
        "value": number.value,
        "standard_error": number.standard_error,
        "interval": number.interval,
        "obstacle": number.obstacle or None,
    }


def fit_json(fit):
    if isinstance(fit, NotDetermined):
        return {"obstacle": str(fit)}
    known = {name: {n: number_json(v) for n, v in getattr(fit, name).items()} for name in ("parameters", "derived")}
    known |= {"chi_squared": fit.chi_squared, "degrees": fit.degrees, "p_value": fit.p_value, "remarks": fit.remarks}
    known |= {"ends": {name: fit_json(end) for name, end in fit.ends.items()}, "obstacle": None}
    if isinstance(fit, spectrum.Spectrum):
        rows = zip(fit.times.tolist(), fit.weights.tolist(), fit.intervals.tolist())
        known["spectrum"] = [{"time": time, "weight": weight, "interval": ends} for time, weight, ends in rows]
    return known


def document_json(document, fits):
    curves = []
    for series, fit, drawn in fits:
        points = [{"label": point["label"], "left_out": why or None} for point, why in zip(series.points, series.why)]
        lines = [{"name": words_of(one["name"]), **one["line"]} for one in drawn]
        lines = [{k: [finite(v) for v in of] if k != "name" else of for k, of in one.items()} for one in lines]
        curves.append({"settings": series.settings, "law": fit_json(fit), "points": points, "lines": lines})
    given = {name: document[name] for name in ("fixed", "free", "from", "to")}
    head = {"schema_version": 1, "campaign": document["campaign"], "law": document["law"], "over": document["over"]}
    names = [one["quantities"][0]["path"] for one in document["quantities"]]
    return {**head, "quantities": names, "given": given, "curves": curves}


def finite(value):
    return value if math.isfinite(value) else None


def answer(document):
    """Returns the answer to a document of the program: {text, figure} or {refused}.

    `text` is the output, JSON if the document asks for it. `figure` is that of drawing.py; None if nothing was fitted.
    `refused` is the fault of an option: its name, its value, and the rule that it breaks.
    """
    fits = []
    try:
        for series in series_of(document):
            try:
                fit, curves = FITS[document["law"]](series, document)
            except NotDetermined as why:
                fit, curves = why, []
            fits.append((series, fit, curves))
    except Refused as fault:
        return {"refused": fault.args}
    except laws.WrongParameter as fault:
        name, rule = fault.args
        given = document["fixed"].get(name)
        option = ("--free", name) if given is None else ("--fix", f"{name}={given:g}")
        return {"refused": (*option, rule)}
    except ValueError as fault:
        return {"refused": ("--law", document["law"], str(fault))}
    write = document_json if document["json"] else text_of
    text = write(document, fits)
    figure = figure_of(document, fits) if any(curves for _, _, curves in fits) else None
    return {"text": in_json(text) if document["json"] else text, "figure": figure}
