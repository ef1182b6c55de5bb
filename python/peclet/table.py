"""Columns of equal length."""
import html

import numpy as np


class Table:
    """Columns by name, each a NumPy array of the same length. Iteration gives the rows, as dictionaries."""

    def __init__(self, columns):
        self.columns = {name: np.asarray(values) for name, values in columns.items()}
        if len({len(values) for values in self.columns.values()}) > 1:
            raise ValueError("columns of different lengths")

    @classmethod
    def of_rows(cls, names, rows):
        """Of rows that are dictionaries; numbers that a row lacks are NaN, texts empty."""
        return cls({name: column_of([row.get(name) for row in rows]) for name in names})

    def __len__(self):
        return len(next(iter(self.columns.values()), ()))

    def __getitem__(self, name):
        if name not in self.columns:
            raise KeyError(f"{name}: no such column; there are {', '.join(self.columns)}")
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
        return Table({name: values[indices] for name, values in self.columns.items()})

    def where(self, **wanted):
        """The rows in which these columns have these values; numbers to nine digits."""
        chosen = np.ones(len(self), bool)
        for name, value in wanted.items():
            column = self[name]
            chosen &= column == value if isinstance(value, str) or column.dtype.kind == "U" else close(column, value)
        return self.take(chosen)

    def sorted_by(self, *names):
        """Of several names the first counts most."""
        return self.take(np.lexsort([self[name] for name in reversed(names)]))

    def to_dict(self):
        return {name: values.tolist() for name, values in self.columns.items()}

    def to_pandas(self):
        """A pandas.DataFrame; pandas has to be installed."""
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


def close(column, value):
    return np.isclose(column.astype(float), float(value), rtol=1e-9, atol=0)


def column_of(values):
    """Texts where one of them is one, truths where all are, else numbers."""
    if any(isinstance(v, str) for v in values):
        return np.array(["" if v is None else str(v) for v in values])
    if values and all(isinstance(v, bool) for v in values):
        return np.array(values)
    return np.array([np.nan if v is None else v for v in values], float)


def cell_of(value):
    return f"{value:.6g}" if isinstance(value, (float, np.floating)) else str(value)
