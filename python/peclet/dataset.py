"""Arranges the estimates of a campaign on the grid of its swept parameters, as an xarray.Dataset."""
import itertools
import math

import numpy as np

from peclet.drawing import cure_for
from peclet.program import PecletError
from peclet.table import column_of, rank_of

# Values in places of the grid that are not a point, by the kind of an array.
BLANK = {"f": np.nan, "U": "", "b": False, "O": ""}


def dataset_of(swept, points, quantities, attributes):
    """Returns an xarray.Dataset, as Results.to_xarray() describes it.

    swept       pointers of the swept parameters, by their names
    points      a dictionary for each point, with label, swept parameters, and what else is known, by name
    quantities  by name: "attributes"; "axes", pairs of name and unit; and "rows", dictionaries with "label", "at" (a
                tuple of values of the axes) and numbers by the ending of their array: "" for the mean, "_count" ...
    attributes  attributes of the data set

    Raises PecletError if xarray is not installed.
    """
    try:
        import xarray
    except ImportError as missing:
        raise PecletError(f"data sets need xarray: {cure_for('xarray', 'python3-xarray')}") from missing
    grid = grid_of(swept, points)
    places = {point["label"]: tuple(point[name] for name in grid) for point in points}
    coordinates = {name: (name, column_of(list(numbers))) for name, numbers in grid.items()}
    arrays = {}
    for name in points[0] if points else ():
        values = [point[name] for point in points]
        if name not in swept:
            arrays[name] = (list(grid), spread(grid.values(), places.values(), values))
        elif name not in grid:
            coordinates[name] = dependent(grid, list(places.values()), values)
    axes = axes_of(quantities, swept)
    coordinates |= {axis.name: axis.coordinate(grid, places) for own in axes.values() for axis in own}
    taken = {*swept, *arrays, *coordinates}
    for quantity, known in quantities.items():
        rows, own = known["rows"], axes[quantity]
        where = [
            places[row["label"]] + tuple(axis.place(row["label"], value) for axis, value in zip(own, row["at"]))
            for row in rows
        ]
        name = quantity.replace("/", "_")
        name = f"measured_{name}" if name in taken else name
        for ending in [key for key in rows[0] if key not in ("label", "at")]:
            values = spread([*grid.values(), *(axis.numbers for axis in own)], where, [row[ending] for row in rows])
            described = {} if ending == "_count" else known["attributes"]
            arrays[name + ending] = ([*grid, *(axis.dimension for axis in own)], values, described)
            taken.add(name + ending)
    return xarray.Dataset(arrays, coordinates, attributes)


def grid_of(swept, points):
    """Returns for each parameter that is a dimension its sorted values, numbered from 0, as dictionaries.

    The dimensions are the fewest parameters that tell all points apart; of several choices the one with the smallest
    grid, and then with the shortest pointers.
    """
    values = {name: {point[name] for point in points} for name in swept}

    def tells_apart(names):
        return len({tuple(point[name] for name in names) for point in points}) == len(points)

    def cost(names):
        return math.prod(len(values[name]) for name in names), sum(swept[name].count("/") for name in names)

    choices = (list(itertools.combinations(swept, count)) for count in range(len(swept) + 1))
    found = next(filter(None, (list(filter(tells_apart, names)) for names in choices)))
    return {name: numbered(sorted(values[name], key=rank_of)) for name in min(found, key=cost)}


def numbered(values):
    """Returns the numbers of the values, from 0, by value."""
    return {value: k for k, value in enumerate(values)}


def spread(grid, places, values):
    """Returns an array over the dimensions `grid`, with each value at its place and blanks elsewhere."""
    column, grid = column_of(list(values)), list(grid)
    array = np.full([len(numbers) for numbers in grid], BLANK[column.dtype.kind], column.dtype)
    for place, value in zip(places, column):
        array[tuple(numbers[one] for numbers, one in zip(grid, place))] = value
    return array


def dependent(grid, places, values):
    """Returns dimensions and values of a parameter that follows from others: from none, from one, or from all."""
    names = list(grid)
    for kept in ([], *([k] for k in range(len(names))), range(len(names))):
        own = [tuple(place[k] for k in kept) for place in places]
        if len(set(own)) == len(set(zip(own, values))):
            break
    return [names[k] for k in kept], spread([grid[names[k]] for k in kept], own, values)


class Axis:
    """An axis of quantities, such as strain. Points may differ in their values.

    quantity    name of the first quantity that has it
    unit        unit of the values
    of_label    values, by the label of the point

    If the values of each point are some of the longest ones, they are those of the dimension. Otherwise the dimension
    NAME_element counts them, and the coordinate NAME depends on the point.
    """

    def __init__(self, quantity, unit, of_label):
        self.quantity, self.unit, self.of_label, self.name = quantity, unit, of_label, None
        longest = max(of_label.values(), key=len)
        self.is_common = all(set(values) <= set(longest) for values in of_label.values())
        self.numbers = numbered(longest if self.is_common else range(len(longest)))
        self.key = tuple(longest) if self.is_common else tuple(sorted(of_label.items()))

    @property
    def dimension(self):
        return self.name if self.is_common else f"{self.name}_element"

    def place(self, label, value):
        """Returns the key in `numbers` of a value of this point."""
        return rounded(value) if self.is_common else self.of_label[label].index(rounded(value))

    def coordinate(self, grid, places):
        """Returns dimensions, values and attributes of the coordinate."""
        if self.is_common:
            return [self.name], list(self.numbers), {"units": self.unit}
        where = [(*places[label], k) for label, values in self.of_label.items() for k in range(len(values))]
        values = [value for values in self.of_label.values() for value in values]
        return [*grid, self.dimension], spread([*grid.values(), self.numbers], where, values), {"units": self.unit}


def axes_of(quantities, swept):
    """Returns a list of Axis for each quantity, the same for quantities with the same values.

    The name of an axis comes behind that of its quantity if other quantities have other values under this name.
    """
    axes, alike = {}, {}
    for quantity, known in quantities.items():
        axes[quantity] = []
        for k, (name, unit) in enumerate(known["axes"]):
            of_label = {}
            for row in known["rows"]:
                of_label.setdefault(row["label"], {})[rounded(row["at"][k])] = None
            axis = Axis(quantity, unit, {label: tuple(values) for label, values in of_label.items()})
            axes[quantity].append(alike.setdefault(name, {}).setdefault(axis.key, axis))
    for name, same in alike.items():
        for axis in same.values():
            behind = f"{axis.quantity}/{name}".replace("/", "_")
            axis.name = behind if len(same) > 1 else f"axis_{name}" if name in swept else name
    return axes


def rounded(value):
    """Returns a number with twelve significant digits, so that those of different points agree; words as they are."""
    return float(f"{value:.12g}") if isinstance(value, float) else value
