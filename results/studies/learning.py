"""Maps between local quantities of inhomogeneous flows: methods that are fitted to bins of some flows and predict the
bins of others.

A table is a dictionary of columns, arrays (n,). Methods work on logarithms of J, mu, Theta and the lag, and on volume
fractions. `published` works on min-max scaled values, as in the publication. Tests leave out whole flows, never bins.
"""
import json
import math
import warnings

import numpy as np
import sklearn
import xgboost
from scipy.optimize import least_squares
from sklearn.ensemble import HistGradientBoostingRegressor, RandomForestRegressor
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel
from sklearn.neural_network import MLPRegressor
from xgboost import XGBRegressor

LOGARITHMIC = {"J", "mu", "Theta", "lag"}
SEED = 1


def columns_of_rows(rows, names):
    return {name: np.array([row[name] for row in rows], float) for name in names}


def taken(table, chosen):
    """Returns the table of the chosen rows, by index or a boolean array."""
    return {name: values[chosen] for name, values in table.items()}


def in_logarithms(name, values):
    return np.log(np.maximum(values, 1e-12)) if name in LOGARITHMIC else values


def out_of_logarithms(name, values):
    return np.exp(values) if name in LOGARITHMIC else values


def matrix(table, names):
    """Returns the columns as a matrix (n, columns), those of LOGARITHMIC as logarithms."""
    return np.column_stack([in_logarithms(name, table[name]) for name in names])


def relative_error(found, true, lowest, highest):
    """Returns |y' - y^'| / |y'| (Euclidean norms) of min-max scaled values (Li, Eqs 6.4 and 6.6)."""
    scaled = [(np.asarray(values) - lowest) / (highest - lowest) for values in (found, true)]
    return math.sqrt(float(np.sum((scaled[0] - scaled[1]) ** 2) / np.sum(scaled[1] ** 2)))


def not_zero(spans):
    """Returns the spans with 1 for 0, so that constant columns can be divided by them."""
    return np.where(spans > 0, spans, 1.0)


class Method:
    """A map from columns `inputs` of a table to the column `output`.

    fit(table)       fits it and returns it
    predict(table)   returns the output (n,)
    """

    def __init__(self, inputs, output):
        self.inputs, self.output = inputs, output

    def fit(self, table):
        x = matrix(table, self.inputs)
        self.lowest, self.highest = x.min(axis=0), x.max(axis=0)
        self._fit(table)
        return self

    def beyond(self, table):
        """Returns how far the inputs of each row lie outside of the training range, in units of that range (n,)."""
        x = matrix(table, self.inputs)
        outside = np.maximum(self.lowest - x, x - self.highest) / not_zero(self.highest - self.lowest)
        return np.maximum(outside.max(axis=1), 0)


class Regression(Method):
    """A regressor with scikit-learn's interface on standardised inputs and output; make() returns it."""

    def __init__(self, inputs, output, make):
        super().__init__(inputs, output)
        self._make = make

    def _fit(self, table):
        x, y = matrix(table, self.inputs), in_logarithms(self.output, table[self.output])
        self._shift, self._scale = x.mean(axis=0), not_zero(x.std(axis=0))
        self._mean, self._spread = y.mean(), not_zero(y.std())
        with warnings.catch_warnings():
            # A Gaussian process warns of irrelevant inputs with unbounded lengths, a network of its number of steps.
            warnings.simplefilter("ignore", ConvergenceWarning)
            self._model = self._make().fit((x - self._shift) / self._scale, (y - self._mean) / self._spread)

    def predict(self, table):
        x = (matrix(table, self.inputs) - self._shift) / self._scale
        return out_of_logarithms(self.output, self._mean + self._spread * self._model.predict(x))


class Published(Method):
    """XGBoost with default settings on min-max scaled values."""

    def _fit(self, table):
        x, y = self._values(table), table[self.output]
        self._from, self._span = x.min(axis=0), not_zero(np.ptp(x, axis=0))
        self._bottom, self._height = y.min(), not_zero(np.ptp(y))
        self._model = XGBRegressor(objective="reg:squarederror", random_state=SEED, n_jobs=1)
        self._model.fit((x - self._from) / self._span, (y - self._bottom) / self._height)

    def _values(self, table):
        return np.column_stack([table[name] for name in self.inputs])

    def predict(self, table):
        return self._bottom + self._height * self._model.predict((self._values(table) - self._from) / self._span)


class LawOfFraction(Method):
    """mu = J / (alpha (phi_J - phi_loc)^2) (Eq. 6.7), with alpha and phi_J from least squares in ln mu."""

    def _fit(self, table):
        def left(parameters):
            return self._logarithm(table, parameters) - np.log(table["mu"])

        self._found = least_squares(left, (math.log(4.0), 0.66), loss="soft_l1", f_scale=0.1).x

    @staticmethod
    def _logarithm(table, parameters):
        distance = np.maximum(parameters[1] - table["fraction"], 1e-3)
        return np.log(np.maximum(table["J"], 1e-12)) - parameters[0] - 2 * np.log(distance)

    def predict(self, table):
        return np.exp(self._logarithm(table, self._found))


class LawOfFluctuations(Method):
    """The output, or its logarithm, as a polynomial of second degree in ln J and the second input, linear in the mean
    fraction: seven parameters, instead of the pieces of Eqs 6.8 and 6.9."""

    def _terms(self, table):
        j = in_logarithms("J", table["J"])
        other = in_logarithms(self.inputs[1], table[self.inputs[1]])
        return np.column_stack([np.ones_like(j), j, j**2, other, other**2, j * other, table["mean"]])

    def _fit(self, table):
        y = in_logarithms(self.output, table[self.output])
        self._found = np.linalg.lstsq(self._terms(table), y, rcond=None)[0]

    def predict(self, table):
        return out_of_logarithms(self.output, self._terms(table) @ self._found)


class OfStressAlone(Method):
    """The output as a cubic in logarithms of J alone."""

    def _fit(self, table):
        y = in_logarithms(self.output, table[self.output])
        self._found = np.polyfit(np.log(np.maximum(table["J"], 1e-12)), y, 3)

    def predict(self, table):
        return out_of_logarithms(self.output, np.polyval(self._found, np.log(np.maximum(table["J"], 1e-12))))


def gaussian_process(count):
    kernel = ConstantKernel(1.0) * RBF(np.ones(count), (0.05, 50)) + WhiteKernel(1e-2, (1e-6, 1))
    return GaussianProcessRegressor(kernel, random_state=SEED)


def boosted(**settings):
    chosen = {"n_estimators": 300, "max_depth": 3, "learning_rate": 0.05, "subsample": 0.8, "reg_lambda": 5.0}
    return XGBRegressor(objective="reg:squarederror", random_state=SEED, n_jobs=1, **{**chosen, **settings})


def regression(make):
    """Returns a function that makes a Regression; make(n) returns a regressor of n inputs."""
    return lambda inputs, output: Regression(inputs, output, lambda: make(len(inputs)))


HISTOGRAM = {"max_iter": 200, "learning_rate": 0.05, "max_depth": 4, "random_state": SEED}
METHODS = {
    "published": Published,
    "boosting on logarithms": regression(lambda _: boosted()),
    "random forest": regression(lambda _: RandomForestRegressor(300, min_samples_leaf=2, random_state=SEED)),
    "histogram boosting": regression(lambda _: HistGradientBoostingRegressor(**HISTOGRAM)),
    "network": regression(lambda _: MLPRegressor((16, 16), alpha=1e-2, max_iter=5000, random_state=SEED)),
    "gaussian process": regression(gaussian_process),
}


def left_out(flows):
    """Yields each flow with boolean arrays of its rows and of the other rows; `flows` has the flow of each row."""
    for name in dict.fromkeys(flows):
        own = np.array([flow == name for flow in flows])
        yield name, own, ~own


def all_methods(inputs, output):
    """Returns the METHODS and fitted laws that can have these inputs and this output, by name."""
    made = {name: make(inputs, output) for name, make in METHODS.items()}
    if output == "mu" and {"J", "fraction"} <= set(inputs):
        made["Eq. 6.7"] = LawOfFraction(inputs, output)
    if "J" in inputs:
        made["J alone"] = OfStressAlone(inputs, output)
    if inputs[0] == "J" and len(inputs) > 1 and "mean" in inputs:
        made["quadratic in logarithms"] = LawOfFluctuations(inputs, output)
    return made


MODEL_FORMAT = "peclet-map-1"


def save_model(path, method, inputs, output, table, provenance):
    """Writes a model as JSON: its method and its training data.

    open_model() fits it again, in about a second, with the same numbers if the libraries are the same.
    """
    names = [*dict.fromkeys([*inputs, output, "mean"])]
    model = {
        "format": MODEL_FORMAT,
        "method": method,
        "inputs": list(inputs),
        "output": output,
        "libraries": {"numpy": np.__version__, "scikit-learn": sklearn.__version__, "xgboost": xgboost.__version__},
        "provenance": provenance,
        "training": {name: [float(v) for v in table[name]] for name in names},
    }
    with open(path, "w") as f:
        json.dump(model, f, indent=1)
        f.write("\n")


def open_model(path):
    """Returns the fitted method of a file, and the content of the file. Raises ValueError with the fault."""
    with open(path) as f:
        try:
            model = json.load(f)
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from error
    if not isinstance(model, dict) or model.get("format") != MODEL_FORMAT:
        raise ValueError(f"{path}: /format: must be {MODEL_FORMAT}")
    for name in ("method", "inputs", "output", "training"):
        if name not in model:
            raise ValueError(f"{path}: /{name}: missing")
    inputs, output = tuple(model["inputs"]), model["output"]
    table = {name: np.array(values, float) for name, values in model["training"].items()}
    methods = all_methods(inputs, output)
    if model["method"] not in methods:
        raise ValueError(f"{path}: /method: {model['method']}: must be one of: {', '.join(methods)}")
    return methods[model["method"]].fit(table), model
