"""Numbers of maps learned from the bins of the study inhomogeneous-flow: errors of every map and method, and numbers
for the statements of Li's section 6.2."""
import math
import time
from pathlib import Path

from studies import inhomogeneous
from studies.estimates import jackknife, quotient
from studies.learning import METHODS, Regression, all_methods, boosted, columns_of_rows, left_out, relative_error, taken
from studies.profile_solver import Law, solve, stress_of_drag
from studies.tables import columns_of, entries, groups, read_rows

import numpy as np

BINS_FOLDER = Path(__file__).resolve().parents[1] / "inhomogeneous-flow"
NAMES = ("mean", "y", "height", "fraction", "rate", "shear stress", "normal stress", "pressure", "J", "mu", "Theta")
NAMES += ("lag", "driving", "velocity", "largest share", "mu_error", "fraction_error")
KINDS = "TRAINING", "PUBLISHED", "UNSEEN", "BEYOND", "OTHER"
TRAINING, PUBLISHED, UNSEEN, BEYOND, OTHER = ([f.name for f in getattr(inhomogeneous, kind)] for kind in KINDS)
# Flows that maps are tested with, by names of columns in errors.csv.
TESTED = {"published": PUBLISHED, "unseen": UNSEEN, "beyond": BEYOND, **{name: [name] for name in PUBLISHED + OTHER}}
# Inputs, and outputs with their published errors.
MAPS = {
    1: (("J", "fraction", "mean"), {"mu": 0.085}),
    2: (("J", "Theta", "mean"), {"fraction": 0.007, "mu": 0.064}),
    3: (("J", "lag", "mean"), {"fraction": 0.01, "mu": 0.086}),
}
CASES = [(map_, output) for map_, (_, outputs) in MAPS.items() for output in outputs]
BALANCE = "momentum balance"
PIECES = 4  # parts of each flow for jackknife errors
DEGREES = 2 * PIECES - 1  # degrees of freedom of numbers from two flows


def bins_by_flow(path):
    """Returns the bins in a table, columns by name, by flow."""
    return {flow: columns_of_rows(rows, NAMES) for flow, rows in groups(read_rows(path), "flow").items()}


def joined(*tables):
    return {name: np.concatenate([table[name] for table in tables]) for name in NAMES}


def together(tables, flows):
    """Returns one table with the rows of these flows."""
    return joined(*(tables[flow] for flow in flows))


def pieces_of(tables, flows):
    """Returns the number of the piece that each row of together() belongs to: PIECES consecutive parts of each flow."""
    counts = [len(tables[flow]["y"]) for flow in flows]
    return np.concatenate([PIECES * k + np.arange(count) * PIECES // count for k, count in enumerate(counts)])


def by_pieces(value, pieces):
    """Returns value(rows) of all rows, and its jackknife error over the pieces."""
    names = np.unique(pieces)
    return jackknife(lambda chosen: value(np.isin(pieces, names[chosen])), len(names))


def errors(found, table, output, scale, pieces):
    """Returns the relative_error() of found values, scaled by the ends of `scale`, and its standard error."""
    return by_pieces(lambda rows: relative_error(found[rows], table[output][rows], *scale), pieces)


def error_ratio(found, other, table, output, scale, pieces):
    """Returns the error of some values over that of others, its standard error, and degrees of freedom."""

    def ratio(rows):
        one, base = (relative_error(values[rows], table[output][rows], *scale) for values in (found, other))
        return one / base

    return (*by_pieces(ratio, pieces), DEGREES)


def floor_of(table, output, scale):
    """Returns the error that an exact map would have, from the noise of the tested bins."""
    noise, true = table[f"{output}_error"] / (scale[1] - scale[0]), (table[output] - scale[0]) / (scale[1] - scale[0])
    return math.sqrt(float(np.sum(noise**2) / np.sum(true**2)))


def scale_of(tables, output):
    """Returns the smallest and the largest value of an output in the training flows."""
    values = together(tables, TRAINING)[output]
    return float(values.min()), float(values.max())


def balance_of_momentum(tables):
    """Returns a function of flows that gives mu in their bins from u and phi along y, without a fit."""

    def of(flows):
        chosen = (tables[flow] for flow in flows)
        return np.concatenate([np.abs(stress_of_drag(t, inhomogeneous.BIN)) / t["pressure"] for t in chosen])

    return of


def error_row(tables, found_of, left, map_, output, method):
    """Returns the row of errors of a method.

    found_of(flows)    returns the method's values for flows
    left               its values for each training flow, fitted to the others
    """
    scale = scale_of(tables, output)
    row = {"map": map_, "output": output, "method": method}
    for what, flows in TESTED.items():
        test, pieces, found = together(tables, flows), pieces_of(tables, flows), found_of(flows)
        row |= entries(what, errors(found, test, output, scale, pieces))
        row[f"{what} floor"] = floor_of(test, output, scale)
    test, found = together(tables, PUBLISHED), found_of(PUBLISHED)
    own = float(test[output].min()), float(test[output].max())
    row["own scale"] = relative_error(found, test[output], *own)
    row |= entries("raw", errors(found, test, output, (0.0, 1.0), pieces_of(tables, PUBLISHED)))
    row["raw floor"] = floor_of(test, output, (0.0, 1.0))
    train, pieces = together(tables, TRAINING), pieces_of(tables, TRAINING)
    row |= entries("left out", errors(left, train, output, scale, pieces))
    row["left out floor"] = floor_of(train, output, scale)
    return row


def left_out_of_training(tables, make):
    """Returns the values of a method for each training flow, fitted to the others; make() returns the method."""
    train, names = together(tables, TRAINING), [flow for flow in TRAINING for _ in tables[flow]["y"]]
    found = np.empty(len(names))
    for _, own, others in left_out(names):
        found[own] = make().fit(taken(train, others)).predict(taken(train, own))
    return found


def have_all_bins(tables):
    """Returns True if the tables have all bins, not only distinct ones, so that stresses can be integrated."""
    return all(len(t["y"]) * inhomogeneous.BIN == t["height"][0] for t in tables.values())


def error_rows(tables):
    """Yields a row of errors for every map and method. Momentum balance needs velocities along y, as map 3 has them."""
    train = together(tables, TRAINING)
    for map_, output in CASES:
        inputs = MAPS[map_][0]
        for method, model in all_methods(inputs, output).items():
            begun = time.process_time()
            model.fit(train)
            model.predict(together(tables, PUBLISHED))
            seconds = time.process_time() - begun
            left = left_out_of_training(tables, lambda method=method: all_methods(inputs, output)[method])
            row = error_row(tables, lambda flows: model.predict(together(tables, flows)), left, map_, output, method)
            yield row | {"seconds": seconds, "outside": float(np.mean(model.beyond(together(tables, BEYOND)) > 0))}
        if output == "mu" and have_all_bins(tables):
            balance = balance_of_momentum(tables)
            yield error_row(tables, balance, balance(TRAINING), map_, output, BALANCE)


ERRORS = ["map", "output", "method", *columns_of(*TESTED, "left out", "raw"), "own scale", "raw floor", "seconds"]
ERRORS += ["outside", *(f"{what} floor" for what in (*TESTED, "left out"))]


def fitted(tables, method, inputs, output):
    return METHODS[method](inputs, output).fit(together(tables, TRAINING))


def slow_bins(tables, flow):
    """Returns True for bins with a rate below a tenth of the largest."""
    rate = np.abs(tables[flow]["rate"])
    return rate < 0.1 * rate.max()


def centre_numbers(tables):
    """Yields numbers about the slow bins of the second published flow."""
    flow = PUBLISHED[1]
    table, slow, pieces = tables[flow], slow_bins(tables, flow), pieces_of(tables, [flow])
    off = fitted(tables, "published", MAPS[1][0], "mu").predict(table) - table["mu"]

    def ratio(rows):
        return float(np.sqrt(np.mean(off[rows & slow] ** 2) / np.mean(off[rows & ~slow] ** 2)))

    yield "slow over fast", (*by_pieces(ratio, pieces), PIECES - 1)
    train = together(tables, TRAINING)
    # Further slow bins, from flows that are not tested here.
    more = [taken(tables[f], slow_bins(tables, f)) for f in (*UNSEEN, BEYOND[0])]
    for name, table_of in (("signed where slow", train), ("signed with more slow bins", joined(train, *more))):
        less = METHODS["published"](MAPS[2][0], "mu").fit(table_of).predict(table) - table["mu"]
        yield name, (*by_pieces(lambda rows, less=less: float(less[rows & slow].mean()), pieces), PIECES - 1)


def comparison_numbers(tables):
    """Yields errors of maps 3 and 1 over those of map 2, and errors beyond the training range over those within."""
    test, pieces = together(tables, PUBLISHED), pieces_of(tables, PUBLISHED)
    far, its = together(tables, BEYOND), pieces_of(tables, BEYOND)
    for output in ("fraction", "mu"):
        scale = scale_of(tables, output)
        models = {n: fitted(tables, "published", MAPS[n][0], output) for n in MAPS if output in MAPS[n][1]}
        found = {n: model.predict(test) for n, model in models.items()}
        for n in found.keys() - {2}:
            yield f"map {n} over map 2, {output}", error_ratio(found[n], found[2], test, output, scale, pieces)
        near = errors(found[2], test, output, scale, pieces)
        beyond = errors(models[2].predict(far), far, output, scale, its)
        yield f"beyond over within, {output}", (*quotient(beyond, near), DEGREES)


def uniform_points(count):
    """Returns a table of `count` points of uniform flow, interpolated between measured volume fractions."""
    known = columns_of_rows(read_rows(BINS_FOLDER / "uniform.csv"), ("fraction", "J", "mu", "Theta"))
    order = np.argsort(known["fraction"])
    fraction = np.linspace(0.48, 0.60, count)
    table = {
        name: np.exp(np.interp(fraction, known["fraction"][order], np.log(known[name][order])))
        for name in ("J", "mu", "Theta")
    }
    zeros = np.zeros(count)
    return {name: table.get(name, fraction if name in ("fraction", "mean") else zeros) for name in NAMES}


def uniform_numbers(tables):
    """Yields the error of mu in the unseen flows by map 1, with uniform flow added to the training or replacing half of
    it, over the error without."""
    train, test, pieces = together(tables, TRAINING), together(tables, UNSEEN), pieces_of(tables, UNSEEN)
    scale = scale_of(tables, "mu")
    half = taken(train, np.arange(len(train["y"])) % 2 == 0)
    trainings = {f"uniform added, {count}": joined(train, uniform_points(count)) for count in (25, 100, 300)}
    trainings["uniform instead of half"] = joined(half, uniform_points(len(train["y"]) // 2))
    plain = fitted(tables, "published", MAPS[1][0], "mu").predict(test)
    for name, table in trainings.items():
        found = METHODS["published"](MAPS[1][0], "mu").fit(table).predict(test)
        yield name, error_ratio(found, plain, test, "mu", scale, pieces)


def tuning_numbers(tables):
    """Yields test errors of boosting with settings tuned by leaving out training flows, over those of the defaults."""
    train = together(tables, TRAINING)
    test, pieces = together(tables, PUBLISHED), pieces_of(tables, PUBLISHED)
    grid = [{"max_depth": d, "n_estimators": n, "learning_rate": 0.05} for d in (2, 3, 5) for n in (100, 300, 600)]
    for output in ("mu", "fraction"):
        inputs, scale = MAPS[2][0], scale_of(tables, output)

        def made(settings, inputs=inputs, output=output):
            return Regression(inputs, output, lambda: boosted(**settings))

        def left(settings, output=output, scale=scale, made=made):
            return relative_error(left_out_of_training(tables, lambda: made(settings)), train[output], *scale)

        tuned = made(min(grid, key=left)).fit(train).predict(test)
        plain = fitted(tables, "published", inputs, output).predict(test)
        yield f"tuned over default, {output}", error_ratio(tuned, plain, test, output, scale, pieces)


def pair_numbers(tables):
    """Yields errors in the published flows of maps from two of Theta, mu, J, phi, and the mean fraction, to a third."""
    four = ("Theta", "mu", "J", "fraction")
    test, pieces = together(tables, PUBLISHED), pieces_of(tables, PUBLISHED)
    for k, one in enumerate(four):
        for other in four[k + 1 :]:
            for output in (name for name in four if name not in (one, other)):
                found = fitted(tables, "boosting on logarithms", (one, other, "mean"), output).predict(test)
                value = errors(found, test, output, scale_of(tables, output), pieces)
                yield f"{one} and {other} to {output}", (*value, DEGREES)


def candidates_of(table):
    """Returns alternatives to the lag that measure how far a bin is from uniform flow, by name."""
    width = inhomogeneous.BIN
    slope = (np.roll(table["rate"], -1) - np.roll(table["rate"], 1)) / (2 * width)
    bend = (np.roll(table["driving"], -1) - 2 * table["driving"] + np.roll(table["driving"], 1)) / width**2
    turns = table["y"][np.nonzero(np.sign(table["rate"]) != np.sign(np.roll(table["rate"], -1)))[0]] + 0.5 * width
    away = np.abs(table["y"][:, None] - turns[None, :])
    away = np.minimum(away, table["height"][0] - away).min(axis=1)
    floor = 1e-3 * np.max(np.abs(table["rate"]))
    return {
        "curvature of u": np.abs(slope) / (np.abs(table["rate"]) + floor),
        "curvature of the driving": np.abs(bend) / (np.abs(table["driving"]) + 1e-5),
        "distance to where u turns": away,
    }


CANDIDATES = "curvature of u", "curvature of the driving", "distance to where u turns"


def candidate_numbers(tables):
    """Yields the error of map 3 with an alternative to the lag over the error with the lag."""
    test, pieces = together(tables, PUBLISHED), pieces_of(tables, PUBLISHED)
    for output in ("fraction", "mu"):
        scale, found = scale_of(tables, output), {}
        for name in ("lag", *CANDIDATES):
            # The candidate, which is positive, replaces the column of the lag.
            with_it = tables
            if name != "lag":
                with_it = {f: {**t, "lag": np.maximum(candidates_of(t)[name], 1e-6)} for f, t in tables.items()}
            model = fitted(with_it, "boosting on logarithms", MAPS[3][0], output)
            found[name] = model.predict(together(with_it, PUBLISHED))
        for name in CANDIDATES:
            yield f"{name} over lag, {output}", error_ratio(found[name], found["lag"], test, output, scale, pieces)


def momentum_numbers(tables):
    """Yields the relative rms difference of the integrated drag from the shear stress, without a fit, mean over four
    flows."""
    values = []
    for flow in PUBLISHED + UNSEEN:
        stress = tables[flow]["shear stress"]
        left = stress_of_drag(tables[flow], inhomogeneous.BIN) - stress
        values.append(math.sqrt(float(np.mean(left**2) / np.mean(stress**2))))
    yield "momentum", (float(np.mean(values)), float(np.std(values, ddof=1) / math.sqrt(len(values))), len(values) - 1)


def all_numbers(tables):
    """Yields all numbers as (name, (value, standard error, degrees of freedom))."""
    for some in (centre_numbers, comparison_numbers, uniform_numbers, tuning_numbers, pair_numbers):
        yield from some(tables)
    yield from candidate_numbers(tables)
    yield from momentum_numbers(tables)


def solver_rows(tables):
    """Yields rows of the profile solver and the simulation, for flows that its law was not fitted to."""
    uniform = columns_of_rows(read_rows(BINS_FOLDER / "uniform.csv"), ("fraction", "J", "mu", "Theta"))
    law = Law([tables[f] for f in TRAINING], uniform, [tables[f]["height"][0] for f in TRAINING])
    for flow in inhomogeneous.PUBLISHED + inhomogeneous.UNSEEN:
        begun = time.process_time()
        found = solve(flow, law)
        seconds = time.process_time() - begun
        table = tables[flow.name]
        simulated = (table[name] for name in ("fraction", "velocity", "normal stress", "driving"))
        for y, fraction, velocity, *those in zip(table["y"], found.fraction, found.velocity, *simulated):
            solved = (y, seconds, found.steps, law.reach, fraction, velocity, found.pressure)
            yield dict(zip(SOLVED, (flow.name, *solved, *those)))


SOLVED = ["flow", "y", "seconds", "steps", "reach", "fraction", "velocity", "pressure"]
SOLVED += ["simulated fraction", "simulated velocity", "simulated pressure", "driving"]
