"""Makes the output of `peclet jamming`, as text or JSON.

The program asks by answer.py, with a document of curves and options.
"""
import dataclasses
import json
import textwrap

from peclet.jamming import Refused, added_to_sweep, estimate_all, is_found, propose

WIDTH = 100  # of the text [characters]


def folded(text):
    """Returns the text with lines of at most WIDTH characters."""
    lines = text.split("\n")
    wrapped = (textwrap.wrap(line, WIDTH, break_long_words=False, break_on_hyphens=False) or [""] for line in lines)
    return "\n".join(part for parts in wrapped for part in parts)


def with_error(number):
    """Returns a pair as "8.93 ± 0.12": the error to two significant digits, the value to the same place."""
    value, error = number
    decimals = 1 - int(f"{error:.1e}".split("e")[1])

    def rounded(number, decimals):
        return f"{number:.{decimals}f}" if decimals >= 0 else f"{round(number, decimals):.0f}"

    if decimals <= 5 and max(abs(value), error) < 1e6:
        return f"{rounded(value, decimals)} ± {rounded(error, decimals)}"
    power = int(f"{max(abs(value), error):.1e}".split("e")[1])
    value, error = (rounded(number / 10.0**power, decimals + power) for number in number)
    return f"({value} ± {error})e{power}"


def given_or_measured(number):
    return with_error(number) if number[1] > 0 else f"{number[0]:.6g} (given)"


def counted(number, noun):
    return f"{number} {noun}{'' if number == 1 else 's'}"


def cells_of(one, options):
    """Returns the cells of the table for one Estimate, by title."""
    stuck = one.smallest_stuck
    row = {
        "curve": one.name,
        "flowing": str(one.flowing),
        "up to": "-" if one.largest_flowing is None else f"{one.largest_flowing:.6g}",
        "stuck at": f"{stuck['fraction']:.6g} {stuck['state']}" if stuck else "-",
    }
    if options["by"] != "steepest":
        law, titles = one.law, ("phi_m by law", "95 % interval", "exponent", "prefactor", "chi^2/degrees")
        row |= dict(zip(titles, ("not determined", "-", "-", "-", "-")))
        if is_found(law):
            texts = [with_error(law.phi_m), f"{law.interval[0]:.4f} to {law.interval[1]:.4f}"]
            texts += [given_or_measured(law.exponent), given_or_measured(law.prefactor)]
            row |= dict(zip(titles, [*texts, f"{law.chi_squared:.2f}/{law.degrees}"]))
    if options["by"] != "law":
        found = one.steepest
        text = with_error(found.phi_m) + (" *" if found.to_jammed else "") if is_found(found) else "not determined"
        row["phi_m by steepest rise"] = text
    return row


def aligned(rows):
    """Returns rows as a text with aligned columns, two blanks apart; numbers are aligned to the right."""
    titles = [title for title in rows[0] if title != "curve" or any(row["curve"] for row in rows)]
    lines = [titles, *([row[title] for title in titles] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*lines)]
    sides = [">" if title in ("flowing", "up to") else "<" for title in titles]
    return "\n".join(
        "  ".join(f"{cell:{side}{width}}" for cell, side, width in zip(line, sides, widths)).rstrip() for line in lines
    )


def remarks_text(estimates, options):
    """Returns the remarks, each once with its curves and points."""
    told = {}
    for k, one in enumerate(estimates):
        own = list(one.remarks)
        for name, answer in (("steepest", one.steepest), ("law", one.law)):
            if options["by"] in ("", name) and not is_found(answer):
                rise = "steepest rise" if name == "steepest" else name
                own.insert(0, (f"phi_m by {rise} is not determined, {answer}", ""))
        for what, place in own:
            told.setdefault(what, {}).setdefault(k, []).append(place)
    lines = []
    for what, places in told.items():
        placed = any(any(own) for own in places.values())
        if len(places) == len(estimates) and not placed:
            lines.append(what + (": every curve" if len(estimates) > 1 else ""))
        elif len(estimates) == 1:
            lines.append(f"{what}: {', '.join(places[0])}")
        else:
            lines.append(what + ":")
            named = ((estimates[k].name, ", ".join(own)) for k, own in places.items())
            lines += [f"  {name}: {own}" if own else f"  {name}" for name, own in named]
    return folded("\n".join(lines)) + "\n\n" if lines else ""


def legend(estimates, common, options):
    text = (
        "flowing: points that flow; stuck at: the smallest fraction beyond them that is jammed, or soft "
        f"(mean overlap above {options['softest']:g} radii); numbers ± standard error\n"
    )
    if options["by"] != "steepest":
        text += f"law: prefactor (1 - phi / phi_m)^-exponent through flowing points above {options['above']:g}\n"
    if common is not None:
        text += "exponent: "
        text += (
            f"{common}\n"
            if not is_found(common)
            else (
                f"common to {counted(common.curves, 'curve')}, {with_error(common.exponent)}; "
                f"chi^2/degrees {common.chi_squared:.2f}/{common.degrees}\n"
            )
        )
    if options["by"] != "law" and any(is_found(one.steepest) and one.steepest.to_jammed for one in estimates):
        text += "*: between the last point that flows and the first one that is jammed\n"
    return folded(
        text
        + "A single point cannot tell whether its viscosity grows with the stiffness, as that of a jammed point does: "
        "sweep the stiffness."
    )


def table(document, estimates, common, proposed):
    text = f"{document['campaign']}: {document['quantity']} over {document['over']}, "
    text += counted(len(estimates), "curve") + "\n\n"
    text += aligned([cells_of(one, document) for one in estimates]) + "\n\n"
    text += remarks_text(estimates, document) + legend(estimates, common, document) + "\n"
    if proposed is None:
        return text
    text += "\n"
    for point in proposed["points"]:
        text += folded(f"next: {point['fraction']:.6g}, {point['reason']}") + "\n"
    if proposed["obstacle"]:
        text += folded("next: " + proposed["obstacle"]) + "\n"
    if not proposed["points"]:
        return text
    text += f"each takes some {proposed['cpu_seconds']:.3g} s of processor time, over all curves\n"
    return text + "patch of the campaign file (RFC 6902):\n" + in_json(proposed["patch"])


def in_json(value):
    return json.dumps(value, indent=2, sort_keys=True, ensure_ascii=False) + "\n"


def answer_json(answer, *pairs):
    """Returns an answer as JSON: pairs as objects; or, if not determined, null for the first pair, and the obstacle."""
    if not is_found(answer):
        return {pairs[0]: None, "obstacle": str(answer)}
    found = {**dataclasses.asdict(answer), "obstacle": None}
    return found | {name: dict(zip(("value", "standard_error"), found[name])) for name in pairs}


def curve_json(one, options):
    fitted = {point[0] for point in one.fitted}
    stuck = one.smallest_stuck
    json_of = {
        "settings": one.settings,
        "flowing": one.flowing,
        "largest_flowing": one.largest_flowing,
        "smallest_stuck": stuck and {name: stuck[name] for name in ("fraction", "state")},
        "remarks": [f"{place}: {what}" if place else what for what, place in one.remarks],
        "points": [
            {name: value for name, value in point.items() if name != "cpu_seconds"}
            | {"fitted": point["fraction"] in fitted}
            for point in one.points
        ],
    }
    if options["by"] != "steepest":
        json_of["law"] = answer_json(one.law, "phi_m", "exponent", "prefactor")
    if options["by"] != "law":
        json_of["steepest"] = answer_json(one.steepest, "phi_m")
    return json_of


def document_json(document, estimates, common, proposed):
    given = {"exponent": document["exponent"], "prefactor": 1 if document["unit_prefactor"] else None}
    head = {name: document[name] for name in ("campaign", "quantity", "over", "above", "softest")}
    curves = [curve_json(one, document) for one in estimates]
    rest = {
        "given": given,
        "common": common and answer_json(common, "exponent"),
        "curves": curves,
        "proposed": proposed,
    }
    return {"schema_version": 1, **head, **rest}


def answer(document):
    """Returns the answer to a document of the program: {text, sweep} or {refused}.

    `text` is the output, JSON if the document asks for it. `sweep` is the campaign's sweep with the proposed points, or
    None. `refused` is the fault of the sweep: pointer, value, rule.
    """
    form = {name: document[name] for name in ("exponent", "unit_prefactor")}
    options = {name: document[name] for name in ("above", "common_exponent")}
    estimates, common = estimate_all(document["curves"], **form, **options)
    proposed = sweep = None
    if document["propose"]:
        points, cost, obstacle = propose(estimates, document["budget"], **form)
        patch = []
        if points:
            try:
                patch, sweep = added_to_sweep(document["sweep"], document["over"], [phi for phi, _ in points])
            except Refused as fault:
                return {"refused": fault.args}
        listed = [{"fraction": fraction, "reason": reason} for fraction, reason in points]
        proposed = {"points": listed, "cpu_seconds": cost, "patch": patch, "obstacle": obstacle or None}
    write = document_json if document["json"] else table
    text = write(document, estimates, common, proposed)
    return {"text": in_json(text) if document["json"] else text, "sweep": sweep}
