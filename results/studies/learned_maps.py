"""Numbers of maps learned from the bins of the study inhomogeneous-flow: errors of every map and method, and numbers
for the statements of Li's section 6.2.

A training is one seed of each training flow. All numbers are means over the trainings, or ratios of such means, and
their standard errors are those of the scatter of the trainings. Tests are the means over the seeds of their flows.
"""
import concurrent.futures
import functools
import math
import time
from pathlib import Path

from studies import inhomogeneous
from studies.estimates import estimate, jackknife
from studies.learning import METHODS, Regression, all_methods, boosted, columns_of_rows, relative_error, taken
from studies.profile_solver import Law, solve, stress_of_drag
from studies.tables import columns_of, entries, groups, read_rows

import numpy as np
from threadpoolctl import threadpool_limits

BINS_FOLDER = Path(__file__).resolve().parents[1] / "inhomogeneous-flow"
NAMES = ("mean", "y", "height", "fraction", "rate", "shear stress", "normal stress", "pressure", "J", "mu", "Theta")
NAMES += ("lag", "driving", "velocity", "largest share", "mu_error", "fraction_error")
KINDS = "TRAINING", "PUBLISHED", "UNSEEN", "BEYOND", "OTHER"
TRAINING, PUBLISHED, UNSEEN, BEYOND, OTHER = ([f.name for f in getattr(inhomogeneous, kind)] for kind in KINDS)
# Flows that maps are tested with, by names of columns in errors.csv.
TESTED = {"published": PUBLISHED, "unseen": UNSEEN, **{name: [name] for name in PUBLISHED + OTHER}}
# Inputs, and outputs with their published errors.
MAPS = {
    1: (("J", "fraction", "mean"), {"mu": 0.085}),
    2: (("J", "Theta", "mean"), {"fraction": 0.007, "mu": 0.064}),
    3: (("J", "lag", "mean"), {"fraction": 0.01, "mu": 0.086}),
}
CASES = [(map_, output) for map_, (_, outputs) in MAPS.items() for output in outputs]
BALANCE = "momentum balance"
DEGREES = inhomogeneous.LEARNED_SEEDS - 1  # degrees of freedom of numbers with errors


def bins_by_flow(name):
    """Returns the bins in a table of inhomogeneous-flow, columns by name, by flow."""
    return {flow: columns_of_rows(rows, NAMES) for flow, rows in groups(read_rows(BINS_FOLDER / name), "flow").items()}


def trainings_of(tables, name):
    """Returns a dictionary of tables by flow for each training. Columns that the table of bins by seed lacks are those
    of the means, `tables`."""
    by_seed = groups(read_rows(BINS_FOLDER / name), "seed").values()
    quantities = inhomogeneous.LEARNED_QUANTITIES
    return [
        {flow: tables[flow] | columns_of_rows(own, quantities) for flow, own in groups(rows, "flow").items()}
        for rows in by_seed
    ]


def joined(*tables):
    return {name: np.concatenate([table[name] for table in tables]) for name in NAMES}


def together(tables, flows):
    """Returns one table with the rows of these flows."""
    return joined(*(tables[flow] for flow in flows))


def floor_of(table, output, scale):
    """Returns the error that an exact map would have, from the noise of the tested bins."""
    noise, true = table[f"{output}_error"] / (scale[1] - scale[0]), (table[output] - scale[0]) / (scale[1] - scale[0])
    return math.sqrt(float(np.sum(noise**2) / np.sum(true**2)))


def ends_of(table, output):
    """Returns the smallest and the largest value of an output."""
    return float(table[output].min()), float(table[output].max())


def balance_of_momentum(tables):
    """Returns a function of flows that gives mu in their bins from u and phi along y, without a fit."""

    def of(flows):
        chosen = (tables[flow] for flow in flows)
        return np.concatenate([np.abs(stress_of_drag(t, inhomogeneous.BIN)) / t["pressure"] for t in chosen])

    return of


def errors_of(tables, training, output, found_of, left):
    """Returns errors and noise floors of a method by name.

    found_of(flows)    returns the method's values for flows
    left               its values for each training flow, fitted to the others
    """
    scale, row = ends_of(together(training, TRAINING), output), {}
    for what, flows in TESTED.items():
        test = together(tables, flows)
        row[what] = relative_error(found_of(flows), test[output], *scale)
        row[f"{what} floor"] = floor_of(test, output, scale)
    test, found = together(tables, PUBLISHED), found_of(PUBLISHED)
    row["own scale"] = relative_error(found, test[output], *ends_of(test, output))
    row["raw"], row["raw floor"] = relative_error(found, test[output], 0, 1), floor_of(test, output, (0, 1))
    train = together(tables, TRAINING)
    row["left out"], row["left out floor"] = relative_error(left, train[output], *scale), floor_of(train, output, scale)
    return row


def left_out_of(tables, training, make):
    """Returns the values of a method in the bins `tables` of each training flow, fitted to the training of the others;
    make() returns the method."""
    return np.concatenate(
        [
            make().fit(together(training, [other for other in TRAINING if other != flow])).predict(tables[flow])
            for flow in TRAINING
        ]
    )


def made(method, inputs, output):
    return all_methods(inputs, output)[method]


def learned_errors(tables, training):
    """Returns errors_of() all methods that learn, by map, output and method."""
    train, found = together(training, TRAINING), {}
    for map_, output in CASES:
        inputs = MAPS[map_][0]
        for method in all_methods(inputs, output):
            make = functools.partial(made, method, inputs, output)
            begun = time.process_time()
            model = make().fit(train)
            model.predict(together(tables, PUBLISHED))
            seconds = time.process_time() - begun
            left = left_out_of(tables, training, make)
            row = errors_of(tables, training, output, lambda flows: model.predict(together(tables, flows)), left)
            found[map_, output, method] = row | {"seconds": seconds}
    return found


def balance_errors(tables, training):
    """Returns errors_of() momentum balance, which learns nothing; a training gives the scale."""
    balance = balance_of_momentum(tables)
    row = errors_of(tables, training, "mu", balance, balance(TRAINING)) | {"seconds": 0.0}
    return {(map_, output, BALANCE): row for map_, output in CASES if output == "mu"}


def on_one_core(function, tables, training):
    """Returns function(tables, training). Threads of several processes that wait for each other would take most of the
    time."""
    with threadpool_limits(1):
        return function(tables, training)


def of_each(function, tables, trainings):
    """Returns the dictionaries function(tables, training) as one, of lists over the trainings."""
    with concurrent.futures.ProcessPoolExecutor() as pool:
        found = list(pool.map(functools.partial(on_one_core, function, tables), trainings))
    return {name: [one[name] for one in found] for name in found[0]}


WITH_ERRORS = *TESTED, "left out", "raw"
ALONE = "own scale", "raw floor", "published floor", "unseen floor", "left out floor", "seconds"
ERRORS = ["map", "output", "method", *columns_of(*WITH_ERRORS), *ALONE]


def error_rows(tables, trainings, *functions):
    """Yields a row of mean errors for every map and method of the functions."""
    for function in functions:
        for case, found in of_each(function, tables, trainings).items():
            row = dict(zip(("map", "output", "method"), case))
            for name in WITH_ERRORS:
                row |= entries(name, estimate([one[name] for one in found]))
            yield row | {name: float(np.mean([one[name] for one in found])) for name in ALONE}


def fitted(training, method, inputs, output):
    return METHODS[method](inputs, output).fit(together(training, TRAINING))


def slow_bins(tables, flow):
    """Returns True for bins with a rate below a tenth of the largest."""
    rate = np.abs(tables[flow]["rate"])
    return rate < 0.1 * rate.max()


# Numbers of one training, by name: a value, or an error and the error that it is divided by.


def centre_numbers(tables, training):
    """Yields numbers about the slow bins of the second published flow."""
    flow = PUBLISHED[1]
    table, slow = tables[flow], slow_bins(tables, flow)
    off = fitted(training, "published", MAPS[1][0], "mu").predict(table) - table["mu"]
    yield "slow over fast", tuple(float(np.sqrt(np.mean(off[some] ** 2))) for some in (slow, ~slow))
    train = together(training, TRAINING)
    # Further slow bins, from flows that are not tested here.
    more = [taken(tables[f], slow_bins(tables, f)) for f in (*UNSEEN, BEYOND[0])]
    for name, table_of in (("signed where slow", train), ("signed with more slow bins", joined(train, *more))):
        less = METHODS["published"](MAPS[2][0], "mu").fit(table_of).predict(table) - table["mu"]
        yield name, float(less[slow].mean())


def comparison_numbers(tables, training):
    """Yields errors of maps 3 and 1 over those of map 2, and errors beyond the training range, in denser and in higher
    flows, over those within."""
    test = together(tables, PUBLISHED)
    for output in ("fraction", "mu"):
        scale = ends_of(together(training, TRAINING), output)
        models = {n: fitted(training, "published", MAPS[n][0], output) for n in MAPS if output in MAPS[n][1]}
        errors = {n: relative_error(model.predict(test), test[output], *scale) for n, model in models.items()}
        for n in errors.keys() - {2}:
            yield f"map {n} over map 2, {output}", (errors[n], errors[2])
            yield f"map 2 better than map {n}, {output}", float(errors[2] < errors[n])
        for name, flows in (("denser", BEYOND[:-1]), ("higher", BEYOND[-1:])):
            far = together(tables, flows)
            beyond = relative_error(models[2].predict(far), far[output], *scale)
            yield f"{name} over within, {output}", (beyond, errors[2])


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


def uniform_numbers(tables, training):
    """Yields the error of mu in the unseen flows by map 1, with uniform flow added to the training or replacing half of
    it, over the error without."""
    train, test = together(training, TRAINING), together(tables, UNSEEN)
    scale = ends_of(train, "mu")

    def error_with(table):
        return relative_error(METHODS["published"](MAPS[1][0], "mu").fit(table).predict(test), test["mu"], *scale)

    half = taken(train, np.arange(len(train["y"])) % 2 == 0)
    tables_of = {f"uniform added, {count}": joined(train, uniform_points(count)) for count in (25, 100, 300)}
    tables_of["uniform instead of half"] = joined(half, uniform_points(len(train["y"]) // 2))
    plain = error_with(train)
    for name, table in tables_of.items():
        yield name, (error_with(table), plain)


def tuning_numbers(tables, training):
    """Yields test errors of boosting with settings tuned by leaving out training flows, over those of the defaults."""
    train, test = together(training, TRAINING), together(tables, PUBLISHED)
    grid = [{"max_depth": d, "n_estimators": n, "learning_rate": 0.05} for d in (2, 3, 5) for n in (100, 300, 600)]
    for output in ("mu", "fraction"):
        inputs, scale = MAPS[2][0], ends_of(train, output)

        def tuned(settings, inputs=inputs, output=output):
            return Regression(inputs, output, lambda: boosted(**settings))

        def left(settings, output=output, scale=scale, tuned=tuned):
            found = left_out_of(training, training, lambda: tuned(settings))
            return relative_error(found, train[output], *scale)

        models = tuned(min(grid, key=left)).fit(train), fitted(training, "published", inputs, output)
        errors = tuple(relative_error(model.predict(test), test[output], *scale) for model in models)
        yield f"tuned over default, {output}", errors


def pair_numbers(tables, training):
    """Yields errors in the published flows of maps from two of Theta, mu, J, phi, and the mean fraction, to a third."""
    four = ("Theta", "mu", "J", "fraction")
    train, test = together(training, TRAINING), together(tables, PUBLISHED)
    for k, one in enumerate(four):
        for other in four[k + 1 :]:
            for output in (name for name in four if name not in (one, other)):
                found = fitted(training, "boosting on logarithms", (one, other, "mean"), output).predict(test)
                yield f"{one} and {other} to {output}", relative_error(found, test[output], *ends_of(train, output))


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


def with_candidate(tables, name):
    """Returns the tables with a candidate, which is positive, as the column of the lag."""
    return {f: t | {"lag": np.maximum(candidates_of(t)[name], 1e-6)} for f, t in tables.items()}


def candidate_numbers(tables, training):
    """Yields the error of map 3 with an alternative to the lag over the error with the lag."""
    for output in ("fraction", "mu"):
        scale = ends_of(together(training, TRAINING), output)

        def error_with(tables, training, output=output, scale=scale):
            model, test = fitted(training, "boosting on logarithms", MAPS[3][0], output), together(tables, PUBLISHED)
            return relative_error(model.predict(test), test[output], *scale)

        lag = error_with(tables, training)
        for name in CANDIDATES:
            error = error_with(with_candidate(tables, name), with_candidate(training, name))
            yield f"{name} over lag, {output}", (error, lag)


def numbers_of(tables, training):
    """Returns all numbers of a training by name."""
    numbers = {}
    for some in (centre_numbers, comparison_numbers, uniform_numbers, tuning_numbers, pair_numbers, candidate_numbers):
        numbers |= some(tables, training)
    return numbers


def ratio_of_means(pairs):
    """Returns the mean of the first numbers over that of the second, and its jackknife error."""
    pairs = np.array(pairs)

    def ratio(chosen):
        above, below = pairs[chosen].mean(axis=0)
        return float(above / below)

    return jackknife(ratio, len(pairs))


def momentum_number(tables):
    """Returns the relative rms difference of the integrated drag from the shear stress, without a fit, mean over four
    flows, its standard error, and degrees of freedom."""
    values = []
    for flow in PUBLISHED + UNSEEN:
        stress = tables[flow]["shear stress"]
        left = stress_of_drag(tables[flow], inhomogeneous.BIN) - stress
        values.append(math.sqrt(float(np.mean(left**2) / np.mean(stress**2))))
    return (*estimate(values), len(values) - 1)


def all_numbers(tables, trainings):
    """Yields all numbers as (name, (value, standard error, degrees of freedom))."""
    for name, found in of_each(numbers_of, tables, trainings).items():
        yield name, (*(ratio_of_means if isinstance(found[0], tuple) else estimate)(found), len(found) - 1)
    yield "momentum", momentum_number(tables)


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
