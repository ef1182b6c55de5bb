"""What a campaign has found so far."""
import csv
import io
import json
import os

from peclet.drawing import cure_for, draw_panel, legend_of, over_sweep, plain
from peclet.program import PecletError, ask
from peclet.table import Table, cell_of, is_same

ESTIMATE = ("mean", "standard_error", "half_width")
# Columns of the exports that are text, also where it looks like a number.
TEXTS = ("label", "hash", "verdict", "quantity", "symbol", "unit", "estimator")
OF_POINTS = ("label", "verdict", "seeds", "lost", "count", *ESTIMATE, "provisional", "jammed")
OF_SEEDS = ("label", "seed", "deciding", "ending", "cpu_seconds")


def open_results(campaign, program=None):
    """The results of a campaign: of its file NAME.json, of its folder NAME.peclet, also while it runs. Nothing is read
    before it is asked for, and every question reads what is there then."""
    path = os.fspath(campaign)
    if not os.path.exists(path):
        raise PecletError(f"{path}: no such file or folder; must be a campaign file, or its .peclet folder")
    return Results(path, program)


def short_names(pointers):
    """Of each JSON pointer into the scene its last word, and as many before it as tell it from the others and from
    columns of every table."""
    words = {pointer: pointer.strip("/").split("/") for pointer in pointers}
    names = {}
    for pointer, own in words.items():
        others = [w for p, w in words.items() if p != pointer]
        count = 1
        while count < len(own) and (
            any(w[-count:] == own[-count:] for w in others) or "_".join(own[-count:]) in (*OF_POINTS, *OF_SEEDS, *TEXTS)
        ):
            count += 1
        names[pointer] = "_".join(own[-count:])
    return names


def apart(name, swept, prefix):
    """The name of a column that is not the name of a swept parameter."""
    return prefix + name if name in swept else name


def value_of(text):
    """The number, truth or word in a cell of a CSV table; None if it is empty."""
    if text == "":
        return None
    try:
        return float(text)
    except ValueError:
        return {"true": True, "false": False}.get(text, text)


def elements(rows, wanted):
    """The rows of the long export that are the element `wanted` of a list, one a point: by its places, as in
    transient/shear_stress/3, or by its words, as in stress/total/xy."""
    places, chosen = {}, []
    for row in rows:
        if not wanted.startswith(row["quantity"] + "/"):
            continue
        names = [row[f"axis_{k}_value"] for k in (1, 2, 3) if row.get(f"axis_{k}")]
        seen = [places.setdefault((row["label"], row["quantity"], k), {}) for k in range(len(names))]
        numbers = [str(known.setdefault(name, len(known))) for known, name in zip(seen, names)]
        words = [name for name in names if isinstance(value_of(name), str)]
        if wanted[len(row["quantity"]) + 1 :].split("/") in (numbers, words):
            chosen.append(row)
    return chosen


def cell_value(value):
    """What the tables of the program have for a value of a scene."""
    return json.dumps(value, separators=(",", ":")) if isinstance(value, (dict, list)) else value


class Results:
    """`path` is that of the campaign, `program` the peclet that is asked."""

    def __init__(self, path, program=None):
        self.path, self.program = path, program

    def _rows(self, form):
        return list(csv.DictReader(io.StringIO(self._ask("export", "--" + form))))

    def _ask(self, verb, *options):
        return ask(self.program, verb, *options, "--", self.path)

    def _named(self, rows):
        """Rows with the short names of what is swept first, and these names."""
        names = short_names([key for key in (rows[0] if rows else {}) if key.startswith("/")])
        known = []
        for row in rows:
            others = {k: v if k in TEXTS else value_of(v) for k, v in row.items() if k not in names}
            known.append(others | {name: value_of(row[pointer]) for pointer, name in names.items()})
        return known, list(names.values())

    def export(self):
        """The whole export, as `peclet export` prints it: points, and every realisation of each."""
        return json.loads(self._ask("export"))

    @property
    def target(self):
        """Observable, tolerance and confidence, as the campaign has them."""
        return self._status()["target"]

    @property
    def name(self):
        return self._status()["campaign"]

    def _status(self):
        # The code of `status` is the state of the campaign: 3 some points are not converged, 4 not finished.
        return json.loads(ask(self.program, "status", "--json", "--", self.path, allowed=(0, 3, 4)))

    def quantities(self):
        """What was measured: quantity, symbol, unit, estimator, and the names of its axes (none of a single number)."""
        found = {}
        for row in self._rows("long"):
            axes = [row[f"axis_{k}"] for k in (1, 2, 3) if row.get(f"axis_{k}")]
            known = ("quantity", "symbol", "unit", "estimator")
            found.setdefault(row["quantity"], {name: row[name] for name in known} | {"axes": ", ".join(axes)})
        return Table.of_rows(["quantity", "symbol", "unit", "estimator", "axes"], list(found.values()))

    def estimates(self, quantity=None):
        """A row for each point: the swept parameters, label, verdict, seeds and lost ones; and `count`, `mean`,
        `standard_error` and `half_width` of the 95 % interval (of the campaign's confidence) at the point's last stop
        test, with the control variate where there is one. Those of the target, by which the campaign stops, or of another
        single number, such as pressure, stress/total/xy or transient/shear_stress/3; the half-width of such is
        Student's, or of shares Clopper and Pearson's. `provisional` rows have had no stop test yet: their mean is that
        of all seeds so far, and has no interval. `jammed`: half of the seeds or more have jammed, as `peclet jamming`
        counts them; such a point has no viscosity."""
        rows, axes = self._named(self._rows("csv"))
        for row in rows:
            row["provisional"] = row["mean"] is None
            row["jammed"] = row.get("jammed") == 1
            if row["provisional"]:
                row |= {name: row.get(f"so_far_{name}") for name in ("count", "mean", "standard_error")}
        if quantity not in (None, self.target["observable"]):
            self._replace_by(quantity, rows)
        return Table.of_rows([*axes, *OF_POINTS], rows)

    def _replace_by(self, quantity, rows):
        table = self.profile(quantity)
        of_label = {row["label"]: row for row in table}
        if len(of_label) < len(table):
            name = list(table.columns)[list(table.columns).index("label") + 1]
            raise PecletError(
                f"{quantity}: is a list by {name}; name one element, such as {quantity}/{cell_of(table[name][0])}"
            )
        for row in rows:
            other = of_label.get(row["label"], {})
            row |= {name: other.get(name) for name in ("count", *ESTIMATE)}

    def profile(self, quantity, **wanted):
        """A row for each point and each element of a quantity with axes, such as a profile, a distribution or the
        components of a stress: the swept parameters, label, the axes by their names, count, mean, standard error and
        half-width. Of the points with these values of swept parameters, of all without. `quantity` may name a single
        element."""
        quantity, everything = quantity.lstrip("/"), self._rows("long")
        chosen = [row for row in everything if row["quantity"] == quantity] or elements(everything, quantity)
        if not chosen:
            there = sorted({row["quantity"] for row in everything})
            raise PecletError(f"{quantity}: not measured; there are {', '.join(there) or 'no results yet'}")
        rows, axes = self._named(chosen)
        names = [chosen[0][f"axis_{k}"] for k in (1, 2, 3) if chosen[0].get(f"axis_{k}")]
        names = [apart(name, axes, "axis_") for name in names]
        for row in rows:
            row |= {name: row[f"axis_{k + 1}_value"] for k, name in enumerate(names)}
        return Table.of_rows(axes + ["label", *names, "count", *ESTIMATE], rows).where(**wanted)

    def realisations(self, **wanted):
        """A row for each seed that has ended: the swept parameters, label, seed, whether it is in the estimate
        (`deciding`), how it ended, processor seconds, and every mean that is a single number, without control
        variate; one with the name of a swept parameter is called measured_NAME. Reads the whole export."""
        document = self.export()
        names = short_names(sorted({pointer for point in document["points"] for pointer in point["settings"]}))
        rows, scalars = [], {}
        for point in document["points"]:
            settings = {names[pointer]: cell_value(value) for pointer, value in point["settings"].items()}
            for deciding, kind in ((True, "realisations"), (False, "extra")):
                for result in point[kind]:
                    means = {
                        apart(name, settings, "measured_"): value
                        for name, value in (result.get("mean") or {}).items()
                        if isinstance(value, (int, float))
                    }
                    scalars |= dict.fromkeys(means)
                    ending = result["ending"]["cause"] if result.get("ending") else ""
                    own = {"label": point["label"], "seed": result["seed"], "deciding": deciding, "ending": ending}
                    rows.append({**settings, **own, "cpu_seconds": result["cost"]["cpu_seconds"], **means})
        return Table.of_rows([*names.values(), *OF_SEEDS, *scalars], rows).where(**wanted)

    def files(self, point=None, **wanted):
        """Paths of what realisations have left beside their results: those of a point, named as the program does it (by
        its label, its values alone, digits of its hash), or of the points with these values of swept parameters.
        """
        return [file["path"] for file in self._files(point, wanted)]

    def _files(self, point, wanted):
        left = json.loads(ask(self.program, "files", "--json", "--", self.path, *([] if point is None else [point])))
        if not wanted:
            return left
        labels = set(self.estimates().where(**wanted)["label"].tolist())
        return [file for file in left if file["point"] in labels]

    def trajectory(self, point=None, seed=0, **wanted):
        """The frames that a seed of a point has left with the observable `trajectory`: gsd.hoomd's trajectory, a
        sequence of them. The point is named as for files(); it must be a single one."""
        try:
            import gsd.hoomd
        except ImportError as missing:
            raise PecletError(f"trajectories need the module gsd: {cure_for('gsd', 'python3-gsd')}") from missing
        own = [file for file in self._files(point, wanted) if file["name"] == "trajectory.gsd"]
        found = [file["path"] for file in own if file["seed"] == seed]
        if len(found) != 1:
            there = ", ".join(f"{file['point']} seed {file['seed']}" for file in own) or "none"
            what = "no trajectory" if not found else "several points"
            raise PecletError(f"seed {seed} of {point or wanted or 'all points'}: {what}; there are: {there}")
        return gsd.hoomd.open(found[0], "rb")

    def jamming(self, *options):
        """What `peclet jamming --json` says: where the curves of viscosity over volume fraction jam; `options` are more
        of its options, such as "--by=law". The fits alone are in peclet.jamming."""
        return json.loads(self._ask("jamming", "--json", *options))

    def plot(self, quantity=None, x=None, by=None, axes=None, label=None, log=None, where=None):
        """Draws an estimate of every point over one swept parameter, with intervals as bars, as `peclet plot` does, and
        returns matplotlib's Axes.

        quantity  the campaign's target unless given
        x         the swept parameter on the axis; the one with most values unless given. If it has words, such as
                  "auto", its values stand side by side
        by        another one, of which each value is a curve; all others that vary unless given
        axes      matplotlib's Axes to draw in; new ones unless given
        label     of the curve, where it is a single one
        log       logarithmic axes: "", "x", "y" or "xy"; those that fit unless given
        where     values of swept parameters by name: of the points that have them

        Open marks are points that have not converged; without a bar they have had no stop test yet. Crosses have jammed:
        at their number, or at the edge of the frame where they have none.
        """
        try:
            import matplotlib.pyplot as pyplot
        except ImportError as missing:
            raise PecletError(f"plots need matplotlib: {cure_for('matplotlib', 'python3-matplotlib')}") from missing
        data = json.loads(self._ask("plot", "--json", *(["--quantity", quantity] if quantity else [])))
        if not data["parameters"]:
            raise PecletError("nothing is swept in this campaign: no axis to draw over")
        pointers = {name: key for key, name in short_names([key["pointer"] for key in data["parameters"]]).items()}
        for name in [x, by, *(where or {})]:
            if name is not None and name not in pointers:
                raise PecletError(f"{name}: is not swept; there are {', '.join(pointers)}")
        for name, value in (where or {}).items():
            data["points"] = [p for p in data["points"] if is_same(cell_value(p["settings"][pointers[name]]), value)]
        figure = over_sweep(data | {"over": pointers.get(x, data["over"]), "by": pointers.get(by), "log": log})
        if figure["x"]["categories"] and "x" in (log or ""):
            raise PecletError(f"{x}: has words, and no logarithmic axis")
        if label and not figure["legend"]:
            figure["legend"] = [{"series": 0, "name": plain(label)}]
        axes = axes or pyplot.subplots(figsize=(4.5, 3.4), layout="constrained")[1]
        draw_panel(axes, figure, figure["panels"][0])
        if not figure["x"]["categories"]:
            axes.autoscale()  # with what else is drawn there
        handles = legend_of(figure)
        for handle in handles:
            axes.add_line(handle)
        if handles:
            axes.legend(frameon=False)
        return axes

    def __repr__(self):
        return f"peclet.open({self.path!r})"
