"""Shows a running campaign in a notebook: a bar and a table, kept up to date in place."""
import html
import math
import sys

from peclet.program import PecletError
from peclet.results import status_table
from peclet.table import Table, cell_of


def is_notebook():
    """Returns True in a Jupyter kernel, whose front end shows HTML."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return getattr(shell, "kernel", None) is not None


class LiveTable:
    """Shows the state of a campaign in the output of the notebook's cell at each call, in the place of the last one.

    read_status    function that returns the output of `peclet status --json`, or raises PecletError
    """

    def __init__(self, read_status):
        self._read_status, self._handle = read_status, None

    def __call__(self):
        from IPython.display import display

        try:
            status = self._read_status()
            seen = {"text/html": html_of(status), "text/plain": f"{summary_of(status)}\n{shown_table(status)!r}"}
        except PecletError as error:  # before the program has made the database
            seen = {"text/html": f"<pre>{html.escape(str(error))}</pre>", "text/plain": str(error)}
        if self._handle is None:
            self._handle = display(seen, raw=True, display_id=True)
        else:
            self._handle.update(seen, raw=True)


def html_of(status):
    """Returns bar, summary and table of a status as HTML."""
    bar = '<progress value="{}" max="{}" style="width: 20em"></progress>'.format(*seeds_of(status))
    return f"<div>{bar} {html.escape(summary_of(status))}</div>{shown_table(status)._repr_html_()}"


def seeds_of(status):
    """Returns the number of seeds that have ended, and of all that the next stop tests want."""
    return tuple(sum(point["seeds"][name] for point in status["points"]) for name in ("wanted_ended", "wanted"))


def summary_of(status):
    """Returns a line such as "2 of 4 points decided, 31 of 60 seeds, 20 s to go"."""
    points = status["points"]
    decided = sum(point["verdict"] is not None or point["cancelled"] for point in points)
    parts = [f"{decided} of {len(points)} points decided", "{} of {} seeds".format(*seeds_of(status))]
    if decided < len(points) and status["seconds_to_go"]:
        parts.append(f"{duration_of(status['seconds_to_go']['likely'])} to go")
    return ", ".join(parts)


def shown_table(status):
    """Returns a Table of texts: swept parameters, seeds, estimates with errors, and verdict, as in `peclet status`."""
    state = status_table(status)
    swept = list(state.columns)[: list(state.columns).index("label")]
    columns = {name: [cell_of(value) for value in state[name].tolist()] for name in swept or ["label"]}
    columns["seeds"] = [f"{row['ended']:.0f}/{row['wanted']:.0f}" for row in state]
    columns[f"{status['target']['observable']} ± standard error"] = [
        with_error(row["mean"], row["standard_error"]) for row in state
    ]
    columns["stop test ± half-width"] = [with_error(row["tested_mean"], row["half_width"]) for row in state]
    columns["verdict"] = [", ".join(filter(None, [row["verdict"] or "open", row["reservations"]])) for row in state]
    return Table(columns)


def duration_of(seconds):
    """Returns a duration in words, such as "3 min"."""
    for unit, length in (("h", 3600), ("min", 60)):
        if seconds >= 1.5 * length:
            return f"{seconds / length:.0f} {unit}"
    return f"{seconds:.0f} s"


def with_error(value, error):
    """Returns "8.93 ± 0.12": the error to two significant digits, the value to the same place; "" for NaN."""
    if math.isnan(value):
        return ""
    if math.isnan(error) or error <= 0:
        return f"{value:.4g}"
    decimals = 1 - int(f"{error:.1e}".split("e")[1])
    if -5 < decimals <= 6:
        return f"{round(value, decimals):.{max(decimals, 0)}f} ± {round(error, decimals):.{max(decimals, 0)}f}"
    return f"{value:.3e} ± {error:.1e}"
