"""Reads the results of a campaign."""
import csv
import difflib
import html
import io
import json
import os

from peclet.dataset import dataset_of
from peclet.drawing import cure_for, draw_panel, figure_of, legend_of, move_series, plain
from peclet.program import PecletError, ask
from peclet.table import Table, cell_of

ESTIMATE = ("mean", "standard_error", "half_width")
# Columns of the exports that are texts, even if they look like numbers.
TEXTS = ("label", "hash", "verdict", "quantity", "symbol", "unit", "estimator")
OF_POINTS = ("label", "verdict", "seeds", "lost", "count", *ESTIMATE, "provisional", "jammed")
OF_SEEDS = ("label", "seed", "deciding", "ending", "cpu_seconds")
OF_STATE = ("label", "verdict", "ended", "wanted", "running", "lost", "mean", "standard_error")
OF_TESTS = ("tested_mean", "half_width", "reservations", "cpu_seconds")
NAMES = {*OF_POINTS, *OF_SEEDS, *OF_STATE, *OF_TESTS, *TEXTS}


def open_results(campaign, program=None):
    """Opens the results of a campaign, which may be running. Called peclet.open.

    campaign   path of the campaign file NAME.json or of its folder NAME.peclet
    program    path or name of the program peclet; by default the environment variable PECLET, or else PATH

    Returns Results, whose methods read the present state at each call. Raises PecletError if the path does not exist.
    """
    path = os.fspath(campaign)
    if not os.path.exists(path):
        raise PecletError(f"{path}: no such file or folder; must be a campaign file, or its .peclet folder")
    return Results(path, program)


def short_names(pointers):
    """Returns a short name for each JSON pointer into the scene, by pointer.

    The name is the last word, with as many words before it as make it differ from the other names and columns.
    """
    words = {pointer: pointer.strip("/").split("/") for pointer in pointers}
    names = {}
    for pointer, own in words.items():
        others = [w for p, w in words.items() if p != pointer]
        count = 1
        while count < len(own) and (any(w[-count:] == own[-count:] for w in others) or "_".join(own[-count:]) in NAMES):
            count += 1
        names[pointer] = "_".join(own[-count:])
    return names


def apart(name, swept, prefix):
    """Returns the name of a column, with `prefix` if a swept parameter has this name."""
    return prefix + name if name in swept else name


def value_of(text):
    """Returns the number, truth value or text in a cell of a CSV table; None if it is empty."""
    if text == "":
        return None
    try:
        return float(text)
    except ValueError:
        return {"true": True, "false": False}.get(text, text)


def elements(rows, wanted):
    """Returns the rows of the long export for one element of a list, one a point.

    `wanted` names the element by its indices, as in transient/shear_stress/3, or by its words, as in stress/total/xy.
    """
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
    """Returns a value of a scene as tables show it: lists and objects as JSON texts."""
    return json.dumps(value, separators=(",", ":")) if isinstance(value, (dict, list)) else value


def pointer_of(name, pointers):
    """Returns the pointer of the swept parameter with this short name."""
    if name not in pointers:
        raise PecletError(f"{name}: is not swept; there are {', '.join(pointers)}")
    return pointers[name]


def read_status(path, program=None):
    """Returns the output of `peclet status --json`, a dictionary. Raises PecletError."""
    # Exit codes: 3 if some points have not converged, 4 if the campaign has not finished.
    return json.loads(ask(program, "status", "--json", "--", path, allowed=(0, 3, 4)))


def status_table(status):
    """Returns the points in the output of `peclet status --json` as a Table, as Results.status() describes it."""
    names = short_names(sorted({pointer for point in status["points"] for pointer in point["settings"]}))
    rows = []
    for point in status["points"]:
        test, seeds = point["stop_test"] or {}, point["seeds"]
        own = {names[pointer]: cell_value(value) for pointer, value in point["settings"].items()}
        own |= {"label": point["label"], "verdict": point["verdict"] or ("cancelled" if point["cancelled"] else "")}
        own |= {"ended": seeds["wanted_ended"], "wanted": seeds["wanted"], "running": seeds["running"]}
        own |= {"lost": sum(point["losses"].values()), "cpu_seconds": point["cpu_seconds"]}
        own |= {name: point["all_seeds"][name] for name in ("mean", "standard_error")}
        own |= {"tested_mean": test.get("mean"), "half_width": test.get("half_width")}
        rows.append(own | {"reservations": ", ".join(point["reservations"])})
    return Table.of_rows([*names.values(), *OF_STATE, *OF_TESTS], rows)


class Results:
    """The results of a campaign, as of the time of each call. Made by peclet.open().

    path       path of the campaign
    program    path or name of the program peclet
    """

    def __init__(self, path, program=None):
        self.path, self.program = path, program

    def _rows(self, form):
        return list(csv.DictReader(io.StringIO(self._ask("export", "--" + form))))

    def _ask(self, verb, *options):
        return ask(self.program, verb, *options, "--", self.path)

    def _named(self, rows):
        """Returns the rows with short names of the swept parameters, and a list of these names."""
        names = short_names([key for key in (rows[0] if rows else {}) if key.startswith("/")])
        known = []
        for row in rows:
            others = {k: v if k in TEXTS else value_of(v) for k, v in row.items() if k not in names}
            known.append(others | {name: value_of(row[pointer]) for pointer, name in names.items()})
        return known, list(names.values())

    def export(self):
        """Returns the output of `peclet export`, a dictionary: the points, each with all its realisations."""
        return json.loads(self._ask("export"))

    @property
    def target(self):
        """The campaign's target, a dictionary: observable, tolerance, confidence."""
        return read_status(self.path, self.program)["target"]

    @property
    def name(self):
        """The campaign's name."""
        return read_status(self.path, self.program)["campaign"]

    def status(self):
        """Returns a Table of the state of each point, as `peclet status` shows it, also while the campaign runs.

        Columns: the swept parameters, label, verdict ("" while the point is open), seeds that have ended and that are
        wanted by the next stop test, running and lost seeds; mean and standard_error of all seeds that have ended,
        which is provisional; tested_mean and half_width of the last stop test; reservations against the estimate,
        separated by commas; cpu_seconds.
        """
        return status_table(read_status(self.path, self.program))

    def quantities(self):
        """Returns a Table of the measured quantities: quantity, symbol, unit, estimator, axes.

        `axes` lists the names of the axes; it is empty for a single number.
        """
        found = {}
        for row in self._rows("long"):
            axes = [row[f"axis_{k}"] for k in (1, 2, 3) if row.get(f"axis_{k}")]
            known = ("quantity", "symbol", "unit", "estimator")
            found.setdefault(row["quantity"], {name: row[name] for name in known} | {"axes": ", ".join(axes)})
        return Table.of_rows(["quantity", "symbol", "unit", "estimator", "axes"], list(found.values()))

    def estimates(self, quantity=None):
        """Returns a Table of estimates with a row for each point.

        quantity   name of a single number, such as pressure, stress/total/xy or transient/shear_stress/3; by default
                   the campaign's target

        Columns: the swept parameters, label, verdict, seeds, lost (seeds without a value), count (values), mean,
        standard_error, half_width of the confidence interval, provisional, jammed. Estimates are those of the point's
        last stop test, with the control variate if there is one. Half-widths of quantities other than the target are
        Student's, those of shares Clopper and Pearson's.

        provisional    True if the point has had no stop test; the mean is that of all seeds, without an interval
        jammed         True if at least half of the seeds have jammed; such a point has no viscosity

        Raises PecletError if the quantity was not measured, or is a list.
        """
        rows, axes = self._named(self._rows("csv"))
        for row in rows:
            row["provisional"] = row["mean"] is None
            row["jammed"] = row.get("jammed") == 1
            if row["provisional"]:
                row |= {name: row.get(f"all_seeds_{name}") for name in ("count", "mean", "standard_error")}
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
        """Returns a Table with a row for each point and each element of a quantity with axes.

        quantity   name of a profile, a distribution, a tensor or another quantity with axes; may name one element
        wanted     values of swept parameters by name; restricts the points

        Columns: the swept parameters, label, one for each axis, count, mean, standard_error, half_width. Raises
        PecletError if the quantity was not measured.
        """
        quantity, everything = quantity.lstrip("/"), self._rows("long")
        chosen = [row for row in everything if row["quantity"] == quantity] or elements(everything, quantity)
        if not chosen:
            there = sorted({row["quantity"] for row in everything})
            none = "no estimates before the first stop test of a point, except of the target"
            near = "".join(f"; did you mean {name}?" for name in difflib.get_close_matches(quantity, there, 1))
            raise PecletError(f"{quantity}: not measured; there are {', '.join(there) or none}{near}")
        rows, axes = self._named(chosen)
        names = [chosen[0][f"axis_{k}"] for k in (1, 2, 3) if chosen[0].get(f"axis_{k}")]
        names = [apart(name, axes, "axis_") for name in names]
        for row in rows:
            row |= {name: row[f"axis_{k + 1}_value"] for k, name in enumerate(names)}
        return Table.of_rows(axes + ["label", *names, "count", *ESTIMATE], rows).where(**wanted)

    def to_xarray(self):
        """Returns the estimates of all quantities as an xarray.Dataset.

        Dimensions are the swept parameters; one that follows from others, such as a duration that is set together with
        the volume fraction, is a coordinate along them. Axes of quantities are further dimensions; if the values on
        an axis differ between points, the dimension AXIS_element counts them. Places of the grid that are not a point
        have NaN, "" and False.

        Arrays, with _ in the place of /: for each quantity its mean under its name, and NAME_standard_error,
        NAME_half_width, NAME_count, with symbol, units and estimator as attributes; those of the target are the numbers
        of estimates(). For each point label, verdict, seeds, lost, provisional, jammed. A quantity with the name of
        another array is called measured_NAME. Raises PecletError if xarray is not installed.
        """
        target, columns = self.target, self.estimates().to_dict()
        points = [dict(zip(columns, values)) for values in zip(*columns.values())]
        endings = {"mean": "", "standard_error": "_standard_error", "half_width": "_half_width", "count": "_count"}
        quantities = {target["observable"]: {"attributes": {}, "axes": [], "rows": []}}
        for row in self._named(self._rows("long"))[0]:
            axes = [k for k in (1, 2, 3) if row.get(f"axis_{k}")]
            attributes = {"symbol": row["symbol"], "units": row["unit"], "estimator": row["estimator"]}
            known = quantities.setdefault(row["quantity"], {"attributes": attributes, "rows": []})
            known["axes"] = [(row[f"axis_{k}"], row[f"axis_{k}_unit"]) for k in axes]
            if row["quantity"] == target["observable"]:
                known["attributes"] = attributes
                continue
            at = {"label": row["label"], "at": tuple(row[f"axis_{k}_value"] for k in axes)}
            known["rows"].append(at | {ending: row[name] for name, ending in endings.items()})
        for point in points:
            own = {ending: point.pop(name) for name, ending in endings.items()}
            quantities[target["observable"]]["rows"].append({"label": point["label"], "at": ()} | own)
        about = {"campaign": self.name, "target": target["observable"], "confidence": target["confidence"]}
        return dataset_of(self._pointers(), points, quantities, about)

    def realisations(self, **wanted):
        """Returns a Table with a row for each seed that has ended.

        wanted     values of swept parameters by name; restricts the points

        Columns: the swept parameters, label, seed, deciding (True if the estimate includes the seed), ending (its
        cause), cpu_seconds, and every mean that is a single number, without control variate. A mean with the name of a
        swept parameter is called measured_NAME. Reads the whole export.
        """
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
        """Returns the paths of the files that realisations have left beside their results, as a list of texts.

        point      a point by its label, its values alone, or the first digits of its hash; by default all points
        wanted     values of swept parameters by name; restricts the points

        Raises PecletError if the point is not known.
        """
        return [file["path"] for file in self._files(point, wanted)]

    def _files(self, point, wanted):
        left = json.loads(ask(self.program, "files", "--json", "--", self.path, *([] if point is None else [point])))
        if not wanted:
            return left
        labels = set(self.estimates().where(**wanted)["label"].tolist())
        return [file for file in left if file["point"] in labels]

    def trajectory(self, point=None, seed=0, **wanted):
        """Opens the trajectory of one seed of a point, from a scene with the observable `trajectory`.

        point, wanted    name a single point, as for files()
        seed             number of the seed

        Returns a gsd.hoomd.HOOMDTrajectory, a sequence of frames. Raises PecletError if there is no trajectory, if
        there are several, or if the module gsd is not installed.
        """
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
        """Returns the jamming points of curves of viscosity over volume fraction, as `peclet jamming --json` does.

        options    further options of this verb, such as "--by=law"

        Returns a dictionary. The module peclet.jamming has the fits alone. Raises PecletError.
        """
        return json.loads(self._ask("jamming", "--json", *options))

    def fit(self, law, *options):
        """Returns the parameters of a law with intervals, as `peclet fit --json` does.

        law        "divergence", "wyart-cates", "mu-of-j", "herschel-bulkley", "cross" or "maxwell"
        options    further options of this verb, such as "--fix=exponent=2"

        Returns a dictionary. The modules peclet.laws and peclet.spectrum have the fits alone. Raises PecletError.
        """
        return json.loads(self._ask("fit", "--json", "--law", law, *options))

    def plot(
        self, quantity=None, x=None, by=None, axes=None, label=None, log=None, where=None, scale_x=None, scale_y=None
    ):
        """Plots estimates with their confidence intervals, as `peclet plot` does.

        quantity  name of a number, drawn over a swept parameter, or of a quantity with an axis, such as
                  transient/shear_stress, drawn along it with a curve for each point; by default the campaign's target.
                  A list draws quantities of one unit together
        x         name of the swept parameter on the axis, of a derived number such as "peclet", or of a measured one
                  such as "shear_rate"; by default the parameter with most values. Values that are words, such as
                  "auto", are placed side by side
        by        name of another swept parameter, with a curve for each value; by default all others that vary
        axes      matplotlib's Axes to draw in; by default new ones. Curves get other colours and marks than those of
                  earlier calls
        label     name of the curve in the legend, if there is a single one
        log       logarithmic axes: "", "x", "y" or "xy"; by default chosen by the values
        where     values of swept parameters by name, a dictionary; restricts the points
        scale_x, scale_y  number, or name of a derived number such as "brownian_time", by which an axis is divided

        Open marks are points that have not converged; those without a bar have had no stop test. Crosses are jammed
        points, at the edge of the frame if they have no value. Returns matplotlib's Axes. Raises PecletError if
        nothing is swept, a name is wrong, the curves need several panels, or matplotlib is not installed.
        """
        try:
            import matplotlib.pyplot as pyplot
        except ImportError as missing:
            raise PecletError(f"plots need matplotlib: {cure_for('matplotlib', 'python3-matplotlib')}") from missing
        data = json.loads(self._ask("plot", "--json", *self._plot_options(quantity, x, where, scale_x, scale_y)))
        if not data["parameters"] and "axis" not in data:
            raise PecletError("nothing is swept in this campaign: no axis to draw over")
        if by is not None and "axis" in data:
            raise PecletError(f"{by}: a quantity with an axis has a curve for each point")
        figure = figure_of(data | {"by": by and pointer_of(by, self._pointers()), "log": log})
        if len(figure["panels"]) > 1:
            raise PecletError(f"{len(figure['panels'])} panels: choose points with where")
        if figure["x"]["categories"] and "x" in (log or ""):
            raise PecletError(f"{x}: has words, and no logarithmic axis")
        if label and not figure["legend"]:
            figure["legend"] = [{"series": 0, "name": plain(label)}]
        axes = axes or pyplot.subplots(figsize=(4.5, 3.4), layout="constrained")[1]
        drawn = getattr(axes, "_peclet_series", 0)  # by earlier calls
        axes._peclet_series = drawn + move_series(figure, drawn)
        draw_panel(axes, figure, figure["panels"][0])
        if not figure["x"]["categories"]:
            axes.autoscale()  # includes other curves in these axes
        known = axes.get_legend_handles_labels()[1]
        handles, curves = legend_of(figure), len(figure["legend"])
        # Signs that all curves share, such as "not converged", are named once.
        handles[curves:] = [handle for handle in handles[curves:] if handle.get_label() not in known]
        for handle in handles:
            axes.add_line(handle)
        if handles:
            axes.legend(frameon=False)
        return axes

    def _plot_options(self, quantity, x, where, scale_x, scale_y):
        """Returns the options of `peclet plot` for the arguments of plot()."""
        quantities = [] if quantity is None else [quantity] if isinstance(quantity, str) else quantity
        options = [word for one in quantities for word in ("--quantity", one)]
        pointers = self._pointers() if x is not None or where else {}
        for option, value in (("--over", pointers.get(x, x)), ("--scale-x", scale_x), ("--scale-y", scale_y)):
            options += [] if value is None else [option, str(value)]
        for name, value in (where or {}).items():
            text = value if isinstance(value, str) else json.dumps(getattr(value, "item", lambda: value)())
            options += ["--where", f"{pointer_of(name, pointers)}={text}"]
        return options

    def _pointers(self):
        """Returns the pointers of the swept parameters, by their short names."""
        columns = next(iter(self._rows("csv")), {})
        return {short: key for key, short in short_names([key for key in columns if key.startswith("/")]).items()}

    def __repr__(self):
        return f"peclet.open({self.path!r})"

    def _repr_html_(self):
        status = read_status(self.path, self.program)
        title = f"{status['campaign']}: {status['target']['observable']}"
        return f"<p>{html.escape(title)}</p>{self.estimates()._repr_html_()}"
