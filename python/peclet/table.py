"""A table of named columns."""
import html
import math

import numpy as np

from peclet.program import PecletError


class NoSuchColumn(PecletError, KeyError):
    """A table has no column of this name."""

    __str__ = PecletError.__str__  # KeyError would show quotes


class Table:
    """A table of columns by name, each a NumPy array of the same length. Iteration yields the rows as dictionaries.

    columns    sequences of equal length by name

    Raises ValueError if the lengths differ; table["name"] raises NoSuchColumn, a PecletError and KeyError.
    """

    def __init__(self, columns):
        self.columns = {name: np.asarray(values) for name, values in columns.items()}
        if len({len(values) for values in self.columns.values()}) > 1:
            raise ValueError("columns of different lengths")

    @classmethod
    def of_rows(cls, names, rows):
        """Returns a Table with the columns `names` from `rows`, a sequence of dictionaries.

        Missing numbers become NaN, missing texts "".
        """
        return cls({name: column_of([row.get(name) for row in rows]) for name in names})

    def __len__(self):
        return len(next(iter(self.columns.values()), ()))

    def __getitem__(self, name):
        if name not in self.columns:
            raise NoSuchColumn(f"{name}: no such column; there are {', '.join(self.columns)}")
        return self.columns[name]

    def __contains__(self, name):
        return name in self.columns

    def __iter__(self):
        for k in range(len(self)):
            yield {name: values[k] for name, values in self.columns.items()}

    def __eq__(self, other):
        return isinstance(other, Table) and self.to_dict() == other.to_dict()

    __hash__ = None

    def take(self, indices):
        """Returns a Table of the rows with these indices, or for which a boolean array is True."""
        return Table({name: values[indices] for name, values in self.columns.items()})

    def where(self, **wanted):
        """Returns a Table of the rows in which the named columns have these values; numbers are compared to 1e-9.

        Raises NoSuchColumn.
        """
        chosen = np.ones(len(self), bool)
        for name, value in wanted.items():
            chosen &= [is_same(cell, value) for cell in self[name].tolist()]
        return self.take(chosen)

    def sorted_by(self, *names):
        """Returns a Table sorted by these columns, the first one foremost. Numbers precede words; NaN is last.

        Raises NoSuchColumn.
        """
        keys = [[rank_of(cell) for cell in self[name].tolist()] for name in names]
        return self.take(sorted(range(len(self)), key=lambda row: [key[row] for key in keys]))

    def to_dict(self):
        """Returns the columns as lists, by name."""
        return {name: values.tolist() for name, values in self.columns.items()}

    def to_pandas(self):
        """Returns a pandas.DataFrame. Raises ImportError if pandas is not installed."""
        import pandas

        return pandas.DataFrame(self.columns)

    def _cells(self, rows):
        yield list(self.columns)
        for row in rows:
            yield [cell_of(value) for value in row.values()]

    def __repr__(self):
        cells = list(self._cells(self))
        widths = [max(len(row[k]) for row in cells) for k in range(len(self.columns))]
        return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in cells)

    def _repr_html_(self):
        rows = [
            "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in row)
            for row, tag in zip(self._cells(self), ["th"] + ["td"] * len(self))
        ]
        return "<table>" + "".join(f"<tr>{row}</tr>" for row in rows) + "</table>"


def is_same(cell, value):
    """Returns True if the values are equal; numbers are compared to a relative 1e-9."""
    if isinstance(cell, str) or isinstance(value, str):
        return cell == value
    return math.isclose(cell, value, rel_tol=1e-9)


def rank_of(cell):
    """Returns a key for sorting: numbers, then texts, then NaN."""
    return (2, 0) if cell != cell else (isinstance(cell, str), cell)


def column_of(values):
    """Returns the values as an array of texts, of truth values, of numbers, or, if mixed with texts, of objects.

    None becomes NaN, or "" in a column with texts.
    """
    texts = ["" if v is None else v for v in values]
    if any(isinstance(v, str) for v in values):
        if all(isinstance(v, str) for v in texts):
            return np.array(texts)
        column = np.empty(len(texts), object)
        column[:] = texts
        return column
    if values and all(isinstance(v, bool) for v in values):
        return np.array(values)
    return np.array([np.nan if v is None else v for v in values], float)


def cell_of(value):
    """Returns the value as a table shows it: numbers with six significant digits."""
    return f"{value:.6g}" if isinstance(value, (float, np.floating)) else str(value)
