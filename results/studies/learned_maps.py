"""Numbers of maps that are learned from the bins of the study inhomogeneous-flow: errors of every map and method, and
what Li's section 6.2 says of them in words."""
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
# What maps are asked of, by name of the columns in errors.csv.
TESTED = {"published": PUBLISHED, "unseen": UNSEEN, "beyond": BEYOND, **{name: [name] for name in PUBLISHED + OTHER}}
# Inputs and outputs, and the errors in print.
MAPS = {
    1: (("J", "fraction", "mean"), {"mu": 0.085}),
    2: (("J", "Theta", "mean"), {"fraction": 0.007, "mu": 0.064}),
    3: (("J", "lag", "mean"), {"fraction": 0.01, "mu": 0.086}),
}
CASES = [(map_, output) for map_, (_, outputs) in MAPS.items() for output in outputs]
BALANCE = "momentum balance"
PIECES = 4  # of each flow, which errors are drawn from
DEGREES = 2 * PIECES - 1  # of what is asked of two flows


def bins_by_flow(path):
    return {flow: columns_of_rows(rows, NAMES) for flow, rows in groups(read_rows(path), "flow").items()}


def joined(*tables):
    return {name: np.concatenate([table[name] for table in tables]) for name in NAMES}


def together(tables, flows):
    return joined(*(tables[flow] for flow in flows))


def pieces_of(tables, flows):
    """A number for each row of together(): the part of its flow, one bin after the other."""
    counts = [len(tables[flow]["y"]) for flow in flows]
    return np.concatenate([PIECES * k + np.arange(count) * PIECES // count for k, count in enumerate(counts)])


def by_pieces(value, pieces):
    """value(rows) of all rows, and its standard error by leaving out a piece at a time."""
    names = np.unique(pieces)
    return jackknife(lambda chosen: value(np.isin(pieces, names[chosen])), len(names))


def errors(found, table, output, scale, pieces):
    """Of values that are scaled by the ends of `scale`, with the standard error."""
    return by_pieces(lambda rows: relative_error(found[rows], table[output][rows], *scale), pieces)


def error_ratio(found, other, table, output, scale, pieces):
    """Returns the error of some values over that of others, its standard error, and degrees of freedom."""

    def ratio(rows):
        one, base = (relative_error(values[rows], table[output][rows], *scale) for values in (found, other))
        return one / base

    return (*by_pieces(ratio, pieces), DEGREES)


def floor_of(table, output, scale):
    """What a map without an error of its own would be said to have: the noise of the tests' own bins."""
    noise, true = table[f"{output}_error"] / (scale[1] - scale[0]), (table[output] - scale[0]) / (scale[1] - scale[0])
    return math.sqrt(float(np.sum(noise**2) / np.sum(true**2)))


def scale_of(tables, output):
    values = together(tables, TRAINING)[output]
    return float(values.min()), float(values.max())


def balance_of_momentum(tables):
    """Returns mu, by flows, of bins whose u and phi are known all along y, without any fit."""

    def of(flows):
        chosen = (tables[flow] for flow in flows)
        return np.concatenate([np.abs(stress_of_drag(t, inhomogeneous.BIN)) / t["pressure"] for t in chosen])

    return of


def error_row(tables, found_of, left, map_, output, method):
    """`found_of(flows)` is what the method says of them, `left` what it says of each training flow without that."""
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
    """What a method says of each training flow when it is fitted to the others."""
    train, names = together(tables, TRAINING), [flow for flow in TRAINING for _ in tables[flow]["y"]]
    found = np.empty(len(names))
    for _, own, others in left_out(names):
        found[own] = make().fit(taken(train, others)).predict(taken(train, own))
    return found


def have_all_bins(tables):
    """Not of those alone that symmetries leave: no stress can be integrated through these."""
    return all(len(t["y"]) * inhomogeneous.BIN == t["height"][0] for t in tables.values())


def error_rows(tables):
    """Of every map and method. The rows of momentum balance need velocities all along y, as map 3 has them."""
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
    rate = np.abs(tables[flow]["rate"])
    return rate < 0.1 * rate.max()


def centre_numbers(tables):
    """Where the rate of the second published flow is below a tenth of its largest."""
    flow = PUBLISHED[1]
    table, slow, pieces = tables[flow], slow_bins(tables, flow), pieces_of(tables, [flow])
    off = fitted(tables, "published", MAPS[1][0], "mu").predict(table) - table["mu"]

    def ratio(rows):
        return float(np.sqrt(np.mean(off[rows & slow] ** 2) / np.mean(off[rows & ~slow] ** 2)))

    yield "slow over fast", (*by_pieces(ratio, pieces), PIECES - 1)
    train = together(tables, TRAINING)
    # As many slow bins again, of the flows that are no test here.
    more = [taken(tables[f], slow_bins(tables, f)) for f in (*UNSEEN, BEYOND[0])]
    for name, table_of in (("signed where slow", train), ("signed with more slow bins", joined(train, *more))):
        less = METHODS["published"](MAPS[2][0], "mu").fit(table_of).predict(table) - table["mu"]
        yield name, (*by_pieces(lambda rows, less=less: float(less[rows & slow].mean()), pieces), PIECES - 1)


def comparison_numbers(tables):
    """Maps 3 and 1 over map 2, flows beyond the training over those within."""
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
    """Of uniform flow, which has one J for each volume fraction, `count` points between those that were measured."""
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
    """Error of mu in the unseen flows, by map 1, with uniform flow added to the training or in the place of half of
    it, over that without."""
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
    """The settings of boosting that are best with each training flow left out, asked of the tests."""
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
    """Two of Theta, mu, J and phi given, and the mean fraction: error of each of the others in the published tests."""
    four = ("Theta", "mu", "J", "fraction")
    test, pieces = together(tables, PUBLISHED), pieces_of(tables, PUBLISHED)
    for k, one in enumerate(four):
        for other in four[k + 1 :]:
            for output in (name for name in four if name not in (one, other)):
                found = fitted(tables, "boosting on logarithms", (one, other, "mean"), output).predict(test)
                value = errors(found, test, output, scale_of(tables, output), pieces)
                yield f"{one} and {other} to {output}", (*value, DEGREES)


def candidates_of(table):
    """In the place of the lag: what else tells how far a bin is from uniform flow."""
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
    """Error of map 3 with a candidate in the place of the lag, over that with the lag."""
    test, pieces = together(tables, PUBLISHED), pieces_of(tables, PUBLISHED)
    for output in ("fraction", "mu"):
        scale, found = scale_of(tables, output), {}
        for name in ("lag", *CANDIDATES):
            # The column of the lag has the candidate, which is positive too.
            with_it = tables
            if name != "lag":
                with_it = {f: {**t, "lag": np.maximum(candidates_of(t)[name], 1e-6)} for f, t in tables.items()}
            model = fitted(with_it, "boosting on logarithms", MAPS[3][0], output)
            found[name] = model.predict(together(with_it, PUBLISHED))
        for name in CANDIDATES:
            yield f"{name} over lag, {output}", error_ratio(found[name], found["lag"], test, output, scale, pieces)


def momentum_numbers(tables):
    """The shear stress as the integral of the drag, without a fit: rms of its difference over that of the stress, mean
    of four flows."""
    values = []
    for flow in PUBLISHED + UNSEEN:
        stress = tables[flow]["shear stress"]
        left = stress_of_drag(tables[flow], inhomogeneous.BIN) - stress
        values.append(math.sqrt(float(np.mean(left**2) / np.mean(stress**2))))
    yield "momentum", (float(np.mean(values)), float(np.std(values, ddof=1) / math.sqrt(len(values))), len(values) - 1)


def all_numbers(tables):
    for some in (centre_numbers, comparison_numbers, uniform_numbers, tuning_numbers, pair_numbers):
        yield from some(tables)
    yield from candidate_numbers(tables)
    yield from momentum_numbers(tables)


def solver_rows(tables):
    """The profile solver and the simulation, of the flows that were not in its law."""
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
