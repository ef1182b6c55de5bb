#!/usr/bin/env python3
"""Draws figures with matplotlib: python3 THIS.py [FILE.pdf | FILE.png | FILE.svg]

Without a file the figure is shown. This file is a module of the Python package peclet. It is also the script that
`peclet plot` writes and the page of a campaign saves; the script ends with its numbers, FIGURE. `peclet plot` replaces
a script only if it has not been changed.

A figure is a dictionary with panels, or the output of `peclet plot --json`, which figure_of() turns into panels:
x, y     {about: {words, symbol, unit}, log, categories: words at 0, 1 ... instead of numbers}
panels   [{title, marks, lines, bands, columns, levels}]
         marks {series, x, y, half, x_half, kind, small}; kind: decided, undecided, provisional, jammed (y may be null)
         lines {series, style, places: [x, y]}; style: guide, line, dashed, provisional
         bands {series, places: [x, low, high]}; columns, which are boxes {series, from, to, low, high}
         levels {series, value, across}
legend   [{series, name, kind}], kind: column, line or that of a mark; kinds: of the marks; hasBand, bandName
notes    texts about omitted points
Series, lines and bands may have a shade from 0 to 1 in place of the colour of their series.
Symbols, names and titles are lists of parts {text, level}: level -1 is a subscript, 1 a superscript.
"""
import json
import math
import os
import re
import shlex
import sys

# Colours that can be distinguished in grey and with colour blindness.
COLOURS = ("#0072b2", "#c44e00", "#00805c", "#a8487f", "#b07700", "#3a8fc0", "#6b6b00", "#1b1b1b")
MARKERS = "osD^vPH"
STYLE = {
    "font.family": "sans-serif",
    "font.sans-serif": ["Helvetica", "Arial", "Liberation Sans", "DejaVu Sans"],
    "font.size": 9,
    "axes.labelsize": 10,
    "savefig.dpi": 200,
    "svg.hashsalt": "peclet",
}
DASHES = (0, (3, 2))


def cure_for(module, package):
    """Returns the command that installs `module` (for conda and pip) or `package` (Debian) for this Python."""
    if os.path.exists(os.path.join(sys.prefix, "conda-meta")):
        return f"conda install -c conda-forge {module}"
    if sys.prefix == "/usr" and os.path.exists("/etc/debian_version"):
        return f"apt install {package}"
    return f"{shlex.quote(sys.executable)} -m pip install {module}"


# Names


def parts_of(symbol, element=""):
    """Returns the parts of a symbol in the notation of engines, such as η_r or σ_xy^{contact normal}.

    _ begins a subscript and ^ a superscript, of letters and digits or of all between braces. `element` is added to the
    subscript behind the name.
    """
    if element:

        def named(found):
            below = [(found[2] or "").strip("{}"), element]
            return f"{found[1]}_{{{' '.join(filter(None, below))}}}"

        symbol = re.sub(r"^([^_^(]*)(?:_([^\W_]+|\{[^}]*\}))?", named, symbol)
    parts = re.split(r"([_^](?:[^\W_]+|\{[^}]*\}))", symbol)
    levels = {"_": -1, "^": 1}
    found = ((part[1:].strip("{}"), levels[part[0]]) if k % 2 else (part, 0) for k, part in enumerate(parts))
    return [{"text": text, "level": level} for text, level in found if text]


def plain(text):
    """Returns the text as parts without sub- and superscripts."""
    return [{"text": text, "level": 0}]


def words_of(name):
    """Returns the name of a quantity or key as words."""
    return name.replace("/", ", ").replace("_", " ")


def about_quantity(quantity):
    """Returns {words, symbol, unit} of a quantity {name, element, symbol, unit, scale}."""
    words = words_of(quantity["name"]) + (f", {quantity['element']}" if quantity["element"] else "")
    symbol = parts_of(quantity["symbol"], quantity["element"]) if quantity["symbol"] else []
    symbol += scale_of(quantity, symbol)
    return {"words": words, "symbol": symbol, "unit": unit_of(quantity["unit"])}


def scale_of(one, symbol):
    """Returns the parts of the scale of a quantity, key or axis, " / τ_B"; without blanks if no symbol precedes."""
    scale = one.get("scale", "")
    return parts_of(scale if symbol else scale.strip())


def short_of(about):
    """Returns the symbol of a description, or its words if it has none."""
    return about["symbol"] or plain(about["words"])


def joined(names, between=", "):
    """Returns lists of parts as one, with a text between them."""
    return [part for at, name in enumerate(names) for part in (plain(between) if at else []) + name]


def about_quantities(quantities):
    """Returns the description of an axis of quantities that have one unit, and the name of each in a legend.

    The axis of several has the words that their names begin with alike, if any, and the symbol of each.
    """
    abouts = [about_quantity(one) for one in quantities]
    if len(abouts) == 1:
        return abouts[0], [[]]
    steps = [one["name"].split("/") for one in quantities]
    alike = 0
    while all(len(own) > alike and own[alike] == steps[0][alike] for own in steps):
        alike += 1
    scale, symbols = parts_of(quantities[0].get("scale", "")), [
        parts_of(one["symbol"], one["element"]) for one in quantities
    ]
    if all(symbols):
        symbol = joined(symbols)
        symbol = plain("(") + symbol + plain(")") + scale if scale else symbol
    else:
        symbol = scale
    words = words_of("/".join(steps[0][:alike])) or (
        "" if all(symbols) else " and ".join(one["words"] for one in abouts)
    )
    names = [short_of({"symbol": own, "words": one["words"]}) for own, one in zip(symbols, abouts)]
    if len({json.dumps(name) for name in names}) < len(names):
        names = [plain(one["words"]) for one in abouts]
    return {"words": words, "symbol": symbol, "unit": abouts[0]["unit"]}, names


def about_key(key):
    """Returns {words, symbol, unit} of a key {pointer, words, symbol, unit}.

    Without words of the engine, the words are the last step of the pointer, or the last two for an element of a list.
    """
    steps = key["pointer"].strip("/").split("/")
    words = key["words"] or words_of(" ".join(steps[-2:] if steps[-1].isdigit() else steps[-1:]))
    symbol = parts_of(key["symbol"])
    symbol += scale_of(key, symbol)
    return {"words": words, "symbol": symbol, "unit": unit_of(key["unit"])}


def unit_of(unit):
    return "" if unit == "1" else unit


def title_of(about, longest=math.inf):
    """Returns the title of an axis: words, symbol and unit. A title of more than `longest` characters has two lines."""
    symbol = [*plain(" "), *about["symbol"]] if about["symbol"] else []
    unit = [*plain(" ["), *parts_of(about["unit"]), *plain("]")] if about["unit"] else []
    title = plain(about["words"]) + symbol + unit if about["words"] else about["symbol"] + unit
    if len(title) > 1 and len("".join(part["text"] for part in title)) > longest:
        title[1:2] = plain(title[1]["text"].replace(" ", "\n", 1))
    return title


def mathtext(parts):
    """Returns parts as a text with matplotlib's mathtext."""
    text, before = "", 0
    for part in parts:
        level = part["level"]
        if level == 0:
            text += part["text"].replace("$", r"\$")
        else:
            inner = re.sub(r"[\\${}^_%#&~]", "", part["text"]).replace(" ", r"\ ")
            # A subscript and a superscript share one place.
            text = text[:-1] if before else text + "$"
            text += ("^" if level > 0 else "_") + r"{\mathrm{" + inner + "}}$"
        before = level
    return text


def plain_number(value):
    """Returns a number with at most four significant digits: 0.01, 2000, 5·10⁶."""
    size = abs(value)
    if value == 0 or 1e-3 <= size < 1e5:
        digits = f"{value:.4g}"
        return f"{float(digits):.0f}" if "e" in digits else digits
    power = math.floor(math.log10(size) + 1e-9)
    leading = value / 10.0**power
    raised = str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return ("10" if abs(leading - 1) < 1e-9 else f"{leading:.4g}·10") + raised


# A quantity over swept parameters


def is_number(value):
    """Returns True for a finite number that is not a truth value."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def widest_gap(numbers):
    """Returns the widest gap between neighbours of sorted numbers, as a fraction of their range."""
    return max((b - a for a, b in zip(numbers, numbers[1:])), default=0) / (numbers[-1] - numbers[0])


def is_logarithmic(values):
    """Returns True for positive numbers over a factor of 5 or more that a logarithmic axis spaces more evenly."""
    numbers, least_ratio = sorted(values), 5  # below this ratio there are too few round numbers for ticks
    if not numbers or numbers[0] <= 0 or numbers[-1] < least_ratio * numbers[0]:
        return False
    return widest_gap([math.log(n) for n in numbers]) < widest_gap(numbers)


def word_of(value, distinct):
    """Returns a value of a parameter as text; if that is too long, its place among the distinct values, from #1."""
    longest = 26
    if value is None:
        return "–"
    if is_number(value):
        return plain_number(value)
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"))
    if len(text) > longest:
        return f"#{distinct.index(value) + 1}"
    return value if isinstance(value, str) else text


def swept(parameter, points):
    """Returns a parameter with its value at each point (cells, words), and its distinct values."""
    cells = [point["settings"].get(parameter["pointer"]) for point in points]
    values = [cell for k, cell in enumerate(cells) if cell not in cells[:k]]
    about = about_key(parameter)
    return {
        "pointer": parameter["pointer"],
        "about": about,
        "name": short_of(about_key(parameter | {"scale": ""})),
        "numeric": all(map(is_number, cells)),
        "cells": cells,
        "values": values,
        "words": [word_of(cell, values) for cell in cells],
    }


def follows(other, axis):
    """Returns True if the value of the parameter `axis` determines that of `other` at every point."""
    pairs = {(axis["values"].index(a), other["values"].index(o)) for a, o in zip(axis["cells"], other["cells"])}
    return len(pairs) == len(axis["values"])


def tells_apart(other, axis):
    """Returns True if the parameter `other` must be in the names of curves over `axis`; the campaign always is."""
    return other["pointer"] == "campaign" or not follows(other, axis)


def kind_of(point):
    """Returns the kind of a point's mark: decided, undecided, provisional or jammed."""
    kinds = {"converged": "decided"}
    return "jammed" if point["jammed"] else kinds.get(point["state"], point["state"])


def ends(mark):
    """Returns the values of y that must be visible for a mark. Bars of provisional marks may be large and are not."""
    if mark["y"] is None:
        return []
    if mark["kind"] == "provisional" or mark["half"] is None:
        return [mark["y"]]
    return [mark["y"], mark["y"] - mark["half"], mark["y"] + mark["half"]]


def is_certain(mark):
    """Returns True for a number of a point that flows whose interval is narrower than the number itself."""
    return mark["kind"] != "jammed" and mark["half"] is not None and mark["half"] < abs(mark["y"])


def reached(panels, log):
    """Returns the numbers along y that the frame must show.

    A number is uncertain if its point has jammed, or if its interval is wider than the number itself, as the mean of
    seeds of which a few have nearly jammed. Uncertain numbers stretch the axis to ten times the others at most, and
    those of curves a logarithmic axis to a tenth of the others.
    """
    factor, certain, uncertain, along_curves, always = 10, [], [], [], []
    for panel in panels:
        for mark in panel["marks"]:
            if mark["y"] is not None:
                (certain if is_certain(mark) else uncertain).extend(ends(mark))
        for _, low, high in (place for band in panel.get("bands", []) for place in band["places"]):
            (certain if high - low < abs(high + low) else along_curves).extend((low, high))
        for line in panel.get("lines", []):
            along_curves += [y for _, y in line["places"] if line["style"] != "guide"]
        for box in panel.get("columns", []):
            certain += [box["low"], box["high"]]
        always += [level["value"] for level in panel.get("levels", []) if level["across"]]
    certain, uncertain, along_curves, always = (
        [y for y in ys if is_number(y) and (y > 0 or not log)] for ys in (certain, uncertain, along_curves, always)
    )
    sizes = [abs(y) for y in certain]
    if any(sizes):
        uncertain = [y for y in uncertain if abs(y) <= factor * max(sizes)]
        least = min(sizes) / factor if log else -math.inf
        along_curves = [y for y in along_curves if least <= y and abs(y) <= factor * max(sizes)]
    return always + certain + uncertain + along_curves


def figure_of(data):
    """Returns the figure of `peclet plot`, whose numbers `data` are the output of `peclet plot --json`."""
    return over_axis(data) if "axis" in data else over_sweep(data)


def names_by(columns, points, names):
    """Returns the name of the curve of each point: the name of its quantity and its values of `columns`."""
    at = {one["path"]: name for one, name in names}
    named = []
    for k, point in enumerate(points):
        own = [plain(one["words"][k]) for one in columns if one["pointer"] == "campaign"]
        own += [one["name"] + plain(" = " + one["words"][k]) for one in columns if one["pointer"] != "campaign"]
        named.append(joined([*filter(None, [at[point["quantity"]]]), *own]))
    return named


def columns_of(data):
    """Returns the swept parameters with their values at each point; the points themselves if nothing is swept."""
    points = data["points"]
    if data["parameters"]:
        return [swept(parameter, points) for parameter in data["parameters"]]
    itself = {"pointer": "", "words": "point", "symbol": "", "unit": ""}
    return [swept(itself, [{"settings": {"": point["label"]}} for point in points])]


def over_sweep(data):
    """Returns the figure of numbers: every point of `data` over the parameter `over`.

    There is a curve for each value of the parameter `by`, or, without it, for each combination of all other parameters
    that vary independently of `over`, of each quantity. Curves over a measured number follow the parameter `along`.
    """
    points, columns = data["points"], columns_of(data)
    axis = next(one for one in columns if one["pointer"] == data["over"])
    along = next((one for one in columns if one["pointer"] == data.get("along")), axis)
    free = [one for one in columns if one is not axis and one is not along]
    others = [one for one in free if len(one["values"]) > 1 and tells_apart(one, along)]
    if data.get("by"):
        others = [one for one in columns if one["pointer"] == data["by"]]
    about, of_quantities = about_quantities(data["quantities"])
    named = names_by(others, points, list(zip(data["quantities"], of_quantities)))
    series, marks, absent = {}, [], data["absent"]
    for k, point in enumerate(points):
        if point["mean"] is None and not point["jammed"]:
            absent += 1
            continue
        place = series.setdefault(json.dumps(named[k]), {"series": len(series), "name": named[k]})["series"]
        x = axis["cells"][k] if axis["numeric"] else axis["values"].index(axis["cells"][k])
        mark = {"series": place, "x": x, "y": point["mean"], "half": point["half_width"], "kind": kind_of(point)}
        mark |= {"x_half": point.get("x_half_width"), "good_enough": point["good_enough"], "curve": point.get("curve")}
        marks.append(
            mark | {"place": along["cells"][k] if along["numeric"] else along["values"].index(along["cells"][k])}
        )
    marks.sort(key=lambda mark: mark["place"])
    log = data["log"]
    logs = {
        "x": axis["numeric"] and (is_logarithmic([mark["x"] for mark in marks]) if log is None else "x" in log),
        "y": is_logarithmic(reached([{"marks": marks}], False)) if log is None else "y" in log,
    }
    visible = [mark for mark in marks if not is_hidden(mark, logs)]
    panel = {"marks": visible, "lines": [], "bands": []}
    for one in series.values():
        flowing = [mark for mark in visible if mark["series"] == one["series"] and mark["kind"] != "jammed"]
        places = [[mark["x"], mark["y"]] for mark in flowing]
        panel["lines"].append({"series": one["series"], "style": "guide", "places": places})
        banded = [mark for mark in flowing if data["tolerance"] and mark["good_enough"] is not None]
        if banded:
            places = [[m["x"], m["y"] - m["good_enough"], m["y"] + m["good_enough"]] for m in banded]
            panel["bands"].append({"series": one["series"], "places": places})
        elif not data["tolerance"]:
            curved = [(mark["x"], mark["curve"]) for mark in flowing if mark["curve"]]
            if len(curved) > 1:
                places = [[x, curve["low"], curve["high"]] for x, curve in curved]
                panel["bands"].append({"series": one["series"], "places": places})
    categories = None if axis["numeric"] else list(dict.fromkeys(axis["words"]))
    return {
        "x": {"about": axis["about"], "log": logs["x"], "categories": categories},
        "y": {"about": about, "log": logs["y"]},
        "panels": [panel],
        "legend": list(series.values()) if others or len(of_quantities) > 1 else [],
        "kinds": [mark["kind"] for mark in visible],
        "hasBand": bool(panel["bands"]),
        "bandName": "tolerance" if data["tolerance"] else "band of the curve",
        "notes": notes(absent, len(marks) - len(visible), data["quantities"][0]["path"]),
    }


def distinguishing(columns):
    """Returns the parameters that vary, without those that follow from one of the others."""
    found = []
    for one in columns:
        if len(one["values"]) > 1 and all(tells_apart(one, other) for other in found):
            found = [other for other in found if tells_apart(other, one)] + [one]
    return found


def over_axis(data):
    """Returns the figure of quantities along an axis of their own: a curve for each point and quantity.

    Beyond as many curves as there are colours, the parameter with the fewest values has a panel for each; if a single
    parameter of numbers distinguishes the curves, they have shades instead. A jammed point without a curve is a cross
    at the upper edge.
    """
    points, axis = data["points"], data["axis"]
    about, of_quantities = about_quantities(data["quantities"])
    by, panel_by = distinguishing(columns_of(data)), []
    is_shaded = len(points) > len(COLOURS) and len(by) == 1 and by[0]["numeric"] and len(of_quantities) == 1
    if len(points) > len(COLOURS) and len(by) > 1:
        panel_by = [min(by, key=lambda one: len(one["values"]))]
    by = [one for one in by if one not in panel_by]
    named = names_by(by, points, list(zip(data["quantities"], of_quantities)))
    titles = [joined([one["name"] + plain(" = " + one["words"][k]) for one in panel_by]) for k in range(len(points))]
    in_order = sorted(range(len(points)), key=lambda k: by[0]["cells"][k]) if is_shaded else range(len(points))
    series, panels, kinds, absent = {}, {}, [], data["absent"]
    for k in in_order:
        point, kind = points[k], kind_of(points[k])
        places = [one for one in zip(point["x"], point["mean"], point["half_width"]) if one[1] is not None]
        if not places and kind != "jammed":
            absent += 1
            continue
        own = series.setdefault(json.dumps(named[k]), {"series": len(series), "name": named[k], "kind": "line"})
        if is_shaded:
            own["shade"] = in_order.index(k) / (len(points) - 1)
        look = {name: own[name] for name in ("series", "shade") if name in own}
        panel = panels.setdefault(json.dumps(titles[k]), {"title": titles[k], "marks": [], "lines": [], "bands": []})
        style = "provisional" if kind == "provisional" else "line"
        panel["lines"].append({**look, "style": style, "places": [[x, y] for x, y, _ in places]})
        band = [[x, y - half, y + half] for x, y, half in places if half is not None]
        if band:
            panel["bands"].append({**look, "places": band})
        if kind == "jammed":
            x, y = places[-1][:2] if places else (None, None)
            panel["marks"].append({**look, "x": x, "y": y, "half": None, "kind": kind})
        kinds += [kind] if kind in ("provisional", "jammed") else []
    panels, log = list(panels.values()), data["log"]
    xs = [x for panel in panels for line in panel["lines"] for x, _ in line["places"]]
    logs = {
        "x": is_logarithmic(set(xs)) if log is None else "x" in log,
        "y": is_logarithmic(reached(panels, False)) if log is None else "y" in log,
    }
    for panel in panels:
        place_jams(panel["marks"], [x for x in xs if x > 0 or not logs["x"]], logs["x"])
    hidden = sum(
        is_hidden({"x": x, "y": y, "kind": "line"}, logs)
        for panel in panels
        for line in panel["lines"]
        for x, y in line["places"]
    )
    return {
        "x": {
            "about": {"words": words_of(axis["name"]), "symbol": scale_of(axis, []), "unit": unit_of(axis["unit"])},
            "log": logs["x"],
            "categories": None,
        },
        "y": {"about": about, "log": logs["y"]},
        "panels": panels,
        "legend": shown_in_legend(list(series.values())) if len(series) > 1 else [],
        "kinds": kinds,
        "hasBand": any(panel["bands"] for panel in panels),
        "bandName": "interval of the mean",
        "notes": notes(absent, hidden, data["quantities"][0]["path"]),
    }


def shown_in_legend(series):
    """Returns at most ten of the series that have shades, at equal distances; all of those that have colours."""
    step = -(-(len(series) - 1) // 9) if "shade" in series[0] else 1
    return series[::step]


def place_jams(marks, xs, log):
    """Places jammed points without a curve side by side at the right end of the numbers `xs`."""
    along = [math.log10(x) for x in xs] if log else xs
    if not along:
        along = [0, 1]
    step = (max(along) - min(along)) / 30
    for at, mark in enumerate(mark for mark in marks if mark["y"] is None):
        x = max(along) - at * step
        mark["x"] = 10**x if log else x


def is_hidden(mark, logs):
    """Returns True if a mark has no place on a logarithmic axis. A jammed point is then drawn at the edge instead."""
    below = logs["y"] and mark["kind"] != "jammed" and mark["y"] <= 0
    return below or (logs["x"] and mark["x"] <= 0)


def notes(absent, hidden, quantity):
    """Returns texts about omitted points: `absent` ones without a number, `hidden` ones on logarithmic axes."""
    said = []
    if absent:
        said.append(f"left out: {absent} point{'' if absent == 1 else 's'} without a number of {quantity} yet")
    if hidden:
        words = "number that is" if hidden == 1 else "numbers that are"
        said.append(f"left out: {hidden} {words} not positive, for which a logarithmic axis has no place")
    return said


# Panels


def draw(figure):
    """Draws a figure with panels; returns matplotlib's Figure and a list with an Axes for each panel."""
    import matplotlib.pyplot as plt

    plt.rcParams.update(STYLE)
    panels = figure["panels"]
    columns = min(len(panels), 3)
    rows = -(-len(panels) // columns)
    size = (4.9 * columns, 3.4 * rows)
    drawing, grid = plt.subplots(
        rows, columns, squeeze=False, sharex=True, sharey=True, figsize=size, layout="constrained"
    )
    for axes, panel in zip(grid.flat, panels):
        draw_panel(axes, figure, panel)
    for axes in grid.flat[len(panels) :]:
        axes.set_visible(False)
    place_legend(grid.flat[0], figure)
    return drawing, list(grid.flat[: len(panels)])


def draw_panel(axes, figure, panel):
    """Draws one panel of a figure in matplotlib's `axes`."""
    for box in panel.get("columns", []):
        width, height = box["to"] - box["from"], box["high"] - box["low"]
        axes.bar(box["from"], height, width, box["low"], align="edge", color=colour_of(box), alpha=0.55)
    for level in panel.get("levels", []):
        line = axes.axhline if level["across"] else axes.axvline
        line(level["value"], color=colour_of(level), linestyle="--", linewidth=1)
    logs, frame = {name: figure[name]["log"] for name in "xy"}, span(figure, "y")
    styles = {
        "guide": {"linewidth": 0.8, "alpha": 0.6},
        "dashed": {"linewidth": 1, "linestyle": "--"},
        "provisional": {"linewidth": 1.2, "linestyle": DASHES},
    }
    for band in panel.get("bands", []):
        # A logarithmic axis has no place for an end below zero: the band is cut below the frame.
        least = 0.1 * frame[0] if logs["y"] and frame else -math.inf
        shown = [place for place in band["places"] if place[0] > 0 or not logs["x"]]
        x, low, high = (
            zip(*((x, max(low, least), max(high, least)) for x, low, high in shown)) if shown else ([], [], [])
        )
        axes.fill_between(x, low, high, color=colour_of(band), alpha=0.16, linewidth=0)
    for line in panel.get("lines", []):
        places = [(x, y) for x, y in line["places"] if not is_hidden({"x": x, "y": y, "kind": "line"}, logs)]
        if len(places) > 1:
            x, y = zip(*places)
            axes.plot(x, y, color=colour_of(line), **styles.get(line["style"], {"linewidth": 1.2}))
    alike, at_edge = {}, {}
    for mark in panel["marks"]:
        if is_hidden(mark, logs):
            continue
        if mark["kind"] == "jammed" or is_beyond(mark, frame):
            draw_at_edge(axes, mark, frame, at_edge)
        else:
            alike.setdefault((mark["series"], mark["kind"], mark.get("small")), []).append(mark)
    for marks in alike.values():
        draw_marks(axes, marks)
    for name, ends_of in (("x", span(figure, "x")), ("y", frame)):
        set_axis(axes, name, figure[name], ends_of)
    if panel.get("title"):
        axes.set_title(mathtext(panel["title"]), fontsize="medium")


def colour_of(one):
    """Returns the colour of a mark, line, band, column or level, by its shade or its series."""
    if "shade" in one:
        import matplotlib

        return matplotlib.colormaps["viridis"](0.92 * one["shade"])
    return COLOURS[one.get("series", 0) % len(COLOURS)]


def draw_marks(axes, marks):
    """Draws marks of one series and kind with their bars: open if not converged, dashed if provisional."""
    kind, colour = marks[0]["kind"], colour_of(marks[0])
    marker, face = MARKERS[marks[0]["series"] % len(MARKERS)], colour if kind == "decided" else "white"
    for half, error in (("half", "yerr"), ("x_half", "xerr")):
        barred = [mark for mark in marks if is_number(mark.get(half))]
        if not barred:
            continue
        x, y, halves = zip(*((mark["x"], mark["y"], mark[half]) for mark in barred))
        look = {"fmt": "none", "ecolor": colour, "elinewidth": 1, "capsize": 2.5, "zorder": 2}
        bars = axes.errorbar(x, y, **{error: halves}, **look)
        if kind == "provisional":
            bars[2][0].set_linestyle(DASHES)
    size, x, y = 3.5 if marks[0].get("small") else 5, [mark["x"] for mark in marks], [mark["y"] for mark in marks]
    axes.plot(x, y, marker, color=colour, markersize=size, markerfacecolor=face, zorder=3)


def is_beyond(mark, frame):
    """Returns True if the number of a mark lies outside of the frame, whose ends along y are `frame`."""
    return mark["y"] is not None and frame is not None and not frame[0] <= mark["y"] <= frame[1]


def draw_at_edge(axes, mark, frame, others):
    """Draws a cross for a jammed point, an arrow head for another one: at its number, or at the edge of the frame.

    A jammed point without a number is at the upper edge. `others` counts the signs at each place of the edges; further
    ones stand beside them, towards the middle.
    """
    colour, y, scale, sign = colour_of(mark), mark["y"], {}, "x"
    if y is None or is_beyond(mark, frame):
        above = y is None or y > frame[1]
        place = (mark["x"], above)
        shift, others[place] = 0.035 * others.get(place, 0), others.get(place, 0) + 1
        y, scale = 1 - shift if above else shift, {"transform": axes.get_xaxis_transform(), "clip_on": False}
        sign = "x" if mark["kind"] == "jammed" else "^" if above else "v"
    elif is_number(mark.get("half")):
        axes.errorbar(mark["x"], y, mark["half"], fmt="none", ecolor=colour, elinewidth=1, capsize=2.5, zorder=2)
    axes.plot(mark["x"], y, sign, color=colour, markersize=6, zorder=3, **scale)


def span(figure, name):
    """Returns the smallest and the largest number that must be visible along an axis, or None without numbers."""
    log, panels = figure[name]["log"], figure["panels"]
    numbers = reached(panels, log) if name == "y" else []
    for panel in panels if name == "x" else []:
        for mark in panel["marks"]:
            x, half = mark["x"], mark.get("x_half") or 0
            numbers += [x, max(x - half, x / 3) if log else x - half, x + half]
        numbers += [place[0] for kind in ("lines", "bands") for one in panel.get(kind, []) for place in one["places"]]
        numbers += [end for box in panel.get("columns", []) for end in (box["from"], box["to"])]
        numbers += [level["value"] for level in panel.get("levels", []) if not level["across"]]
    numbers = [number for number in numbers if is_number(number) and (number > 0 or not log)]
    if not numbers:
        return None
    low = min(numbers)
    # A bar that ends near zero is cut off, so that it does not compress the rest of a logarithmic axis.
    above = [mark["y"] for panel in panels for mark in panel["marks"] if mark["y"] is not None and mark["y"] > 0]
    if name == "y" and log and above:
        low = max(low, min(above) / 3)
    return low, max(numbers)


def set_axis(axes, name, about, ends):
    """Sets scale, limits, ticks and title of the axis `name` ("x" or "y"); `ends` are as from span()."""
    axis, words = getattr(axes, f"{name}axis"), about.get("categories")
    limits, scale = getattr(axes, f"set_{name}lim"), getattr(axes, f"set_{name}scale")
    scale("log" if about["log"] else "linear")
    axes.tick_params(axis=name, which="both", direction="in", top=True, right=True)
    longest = 40 if name == "y" else math.inf  # characters in the height of a panel
    getattr(axes, f"set_{name}label")(mathtext(title_of(about["about"], longest)))
    if words:
        step = -(-len(words) // 8)
        limits(-0.5, len(words) - 0.5)
        axis.set_ticks(range(len(words)), [word if k % step == 0 else "" for k, word in enumerate(words)])
        return
    if ends:
        low, high = map(math.log10, ends) if about["log"] else ends
        margin = 0.05 * (high - low if high - low > 1e-9 * max(abs(low), abs(high)) else max(abs(low), abs(high)) or 1)
        low, high = low - margin, high + margin
        ends = (10**low, 10**high) if about["log"] else (low, high)
        limits(*ends)
    set_ticks(axis, about["log"], ends)


def set_ticks(axis, log, ends):
    """Sets ticks with a few plain numbers for an axis with these ends."""
    from matplotlib import ticker

    decades = math.log10(max(ends) / min(ends)) if log and ends else 0
    axis.set_major_locator(ticker.MaxNLocator(7, steps=[1, 2, 5, 10]))
    if decades >= 1:
        axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5) if decades < 2.2 else (1,)))
    if log:
        axis.set_minor_locator(ticker.LogLocator(subs=range(2, 10)))
        axis.set_minor_formatter(ticker.NullFormatter())
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: plain_number(value)))


def move_series(figure, drawn):
    """Numbers the series of a figure of one panel from `drawn` on, for other colours and marks; returns how many."""
    parts = [one for of in figure["panels"][0].values() if isinstance(of, list) for one in of]
    numbered = [one for one in [*parts, *figure.get("legend", [])] if isinstance(one, dict) and "series" in one]
    count = 1 + max((one["series"] for one in numbered), default=-1)
    for one in {id(one): one for one in numbered}.values():
        one["series"] += drawn
    return count


def legend_of(figure):
    """Returns matplotlib's legend handles for the series, kinds of marks, and bands of a figure."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles = []

    def say(name, marker, **more):
        handles.append(Line2D([], [], marker=marker, markersize=5, label=name, **{"linestyle": "none", **more}))

    def say_area(name, colour, alpha):
        handles.append(Patch(color=colour, alpha=alpha, linewidth=0, label=name))

    for one in figure.get("legend", []):
        if one.get("kind") == "column":
            say_area(mathtext(one["name"]), colour_of(one), 0.55)
        elif one.get("kind") == "line":
            say(mathtext(one["name"]), "", color=colour_of(one), linestyle="-")
        else:
            say(mathtext(one["name"]), MARKERS[one["series"] % len(MARKERS)], color=colour_of(one))
    kinds, panels = figure.get("kinds", []), figure["panels"]
    marker = MARKERS[0] if any(mark["kind"] == "provisional" for panel in panels for mark in panel["marks"]) else ""
    for kind, name, sign, line in (
        ("undecided", "not converged", MARKERS[0], "none"),
        ("provisional", "provisional", marker, DASHES),
    ):
        if kind in kinds:
            say(name, sign, color=COLOURS[0], markerfacecolor="white", linestyle=line, linewidth=1)
    if "jammed" in kinds:
        say("jammed", "x", color=COLOURS[0])
    frame = span(figure, "y")
    if any(mark["kind"] != "jammed" and is_beyond(mark, frame) for panel in panels for mark in panel["marks"]):
        say("beyond the frame", "^", color=COLOURS[0])
    if figure.get("hasBand"):
        say_area(figure.get("bandName", "tolerance"), COLOURS[0], 0.16)
    return handles


def place_legend(axes, figure):
    """Places the legend in a corner where it covers nothing, or beside the frame if every corner is covered."""
    handles = legend_of(figure)
    if not handles:
        return
    for corner in ("upper right", "upper left", "lower right", "lower left"):
        legend = axes.legend(handles=handles, loc=corner, frameon=False)
        axes.figure.draw_without_rendering()
        box = legend.get_window_extent()
        drawn = [axes.transData.transform(place) for place in drawn_places(figure["panels"][0])]
        for line in axes.lines:  # with the signs at the edges
            if line.get_marker() in ("x", "^", "v") and len(line.get_xdata()):
                drawn += list(line.get_transform().transform(line.get_xydata()))
        if not any(box.contains(x, y) for x, y in drawn):
            return
    legend = axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1, 1.02), frameon=False)
    axes.figure.draw_without_rendering()
    width, height = axes.figure.get_size_inches()
    axes.figure.set_size_inches(width + legend.get_window_extent().width / axes.figure.dpi, height)


def drawn_places(panel):
    """Yields points (x, y) along everything that a panel shows, closely spaced on lines."""
    for mark in panel["marks"]:
        for end in ends(mark):
            yield mark["x"], end
    for line in panel.get("lines", []):
        for (x, y), (to_x, to_y) in zip(line["places"], line["places"][1:]):
            for part in range(21):
                yield x + part / 20 * (to_x - x), y + part / 20 * (to_y - y)
    for band in panel.get("bands", []):
        yield from ((x, end) for x, *ends_of in band["places"] for end in ends_of)
    for box in panel.get("columns", []):
        yield from ((x, y) for x in (box["from"], box["to"]) for y in (box["low"], box["high"]))


def main(figure):
    """Shows a figure, or saves it to the file on the command line. Exits if matplotlib is not installed."""
    try:
        import matplotlib
    except ImportError as missing:
        cure = cure_for("matplotlib", "python3-matplotlib")
        sys.exit(f"{sys.executable} cannot import matplotlib ({missing}); install it with {cure}")
    if len(sys.argv) > 1:
        matplotlib.use("Agg")
    figure = figure if "panels" in figure else figure_of(figure)
    drawing, _ = draw(figure)
    for note in figure.get("notes", []):
        print(note)
    if len(sys.argv) < 2:
        import matplotlib.pyplot

        matplotlib.pyplot.show()
        return
    # Without dates, so that equal numbers give equal files.
    dates = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
    drawing.savefig(sys.argv[1], metadata=dates.get(sys.argv[1].rpartition(".")[2]))
