#!/usr/bin/python3
"""Learns maps between local quantities from your own campaigns.

learn.py waves velocities.txt                     prints flow.waves through velocities at equal distances, one a line
learn.py bins CAMPAIGN.json ... > bins.csv        a row for each bin of every point, with errors over its seeds;
                                                  --symmetric: only bins that are distinct by symmetry, averaged
learn.py train bins.csv --inputs J Theta mean --output mu --model mu.json
learn.py errors bins.csv --inputs J Theta mean --output mu        errors by method, with each flow left out
learn.py predict mu.json bins.csv > predicted.csv

Campaigns need the observable `profiles`, /box/height, and flow.waves without shear. Outside of its training range a
model predicts with a warning; the column `beyond` has the distance in units of that range.
"""
import argparse
import csv
import hashlib
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from studies.estimates import student_quantile
from studies.inhomogeneous import QUANTITIES, bin_rows, driving_of_scene, growth, profile_of, symmetric_bin_rows
from studies.inhomogeneous import waves_of
from studies.learning import all_methods, columns_of_rows, left_out, open_model, relative_error, save_model, taken
from studies.tables import columns_of, read_rows, write_table

import numpy as np

MOST_WAVES = 64  # allowed in a scene
BINS = ["flow", "mean", "height", "y", "driving", *columns_of(*QUANTITIES)]


def refuse(text):
    print(f"learn.py: {text}", file=sys.stderr)
    sys.exit(2)


def warn(text):
    print(f"learn.py: warning: {text}", file=sys.stderr)


def asked(verb, campaign):
    program = os.environ.get("PECLET", "peclet")
    try:
        done = subprocess.run([program, verb, campaign], capture_output=True, text=True)
    except OSError as error:
        refuse(f"{program}: {error.strerror}; must be in PATH, or named by the variable PECLET")
    if done.returncode != 0:
        refuse(f"{campaign}: peclet {verb}: {done.stderr.strip()}")
    return done.stdout


def blocks_of(campaign):
    """Returns the volume fractions by quarter of the window, a list over seeds by point, if results have quarters."""
    quarters = {}
    for line in asked("results", campaign).splitlines():
        stored = json.loads(line)
        profiles = stored["result"].get("blocks", {}).get("profiles")
        if stored["deciding"] and profiles:
            quarters.setdefault(stored["label"], []).append(profiles["volume_fraction"])
    return quarters


def warn_of_growth(campaign):
    for label, quarters in blocks_of(campaign).items():
        if len(quarters) < 2:
            continue
        value, error = growth(quarters)
        if abs(value) > max(student_quantile(len(quarters) - 1, 0.999) * error, 0.05):
            warn(
                f"{campaign}: {label}: the profile of the volume fraction stands out {100 * value:+.0f} ± "
                f"{100 * error:.0f} % more in the second half of the window than in the first: it is not steady"
            )


def bins_of(campaign, rows_of):
    warn_of_growth(campaign)
    found = json.loads(asked("export", campaign))
    for point in found["points"]:
        results = [r for r in point["realisations"] if r.get("mean")]
        if len(results) < 2:
            refuse(f"{campaign}: {point['label']}: {len(results)} seeds with means; must have two or more")
        if "velocity_variance" not in results[0]["mean"].get("profiles", {}):
            refuse(f"{campaign}: {point['label']}: no profiles with stress; /observables must list profiles")
        try:
            flow = driving_of_scene(f"{found['campaign']} {point['label']}".strip(), point["scene"])
        except ValueError as error:
            refuse(f"{campaign}: {error}")
        yield from rows_of(flow, [profile_of(flow, r["mean"]["profiles"]) for r in results])


def table_of(path, names):
    try:
        rows = read_rows(path)
    except OSError as error:
        refuse(f"{path}: {error.strerror}")
    missing = [name for name in names if not rows or name not in rows[0]]
    if missing:
        refuse(f"{path}: no column {missing[0]}; must be a table of `learn.py bins`")
    words = [r[name] for r in rows for name in names if isinstance(r[name], str)]
    if words:
        refuse(f"{path}: {words[0]}: must be a number")
    whole = [r for r in rows if all(np.isfinite(r[name]) for name in names)]
    if len(whole) < len(rows):
        warn(f"{path}: {len(rows) - len(whole)} of {len(rows)} rows are left out: they lack a number")
    return columns_of_rows(whole, names), np.array([r["flow"] for r in whole])


def errors_of(path, name, count):
    """Returns the standard errors of a column, or None unless the table has them in all rows."""
    found = [row.get(f"{name}_error") for row in read_rows(path)]
    known = len(found) == count and all(isinstance(e, float) and np.isfinite(e) for e in found)
    return np.array(found) if known else None


def bins(arguments):
    rows_of = symmetric_bin_rows if arguments.symmetric else bin_rows
    write_table("/dev/stdout", BINS, [row for campaign in arguments.campaigns for row in bins_of(campaign, rows_of)], 6)


def waves(arguments):
    try:
        values = np.loadtxt(arguments.velocities, ndmin=1)
        found = waves_of(values) if values.ndim == 1 else refuse(f"{arguments.velocities}: must be one column")
    except (OSError, ValueError) as error:
        refuse(f"{arguments.velocities}: {error}")
    if len(found) > MOST_WAVES:
        refuse(f"{arguments.velocities}: makes {len(found)} waves: must be at most {MOST_WAVES}")
    print(json.dumps({"flow": {"shear_rate": 0, "waves": found, "faxen": False}}, indent=1))


def chosen(arguments):
    known = ("mean", *QUANTITIES)
    for name in (*arguments.inputs, arguments.output):
        if name not in known:
            refuse(f"{name}: must be one of: {', '.join(known)}")
    return tuple(arguments.inputs), arguments.output


def train(arguments):
    inputs, output = chosen(arguments)
    methods = all_methods(inputs, output)
    if arguments.method not in methods:
        refuse(f"--method: {arguments.method}: must be one of: {', '.join(methods)}")
    table, flows = table_of(arguments.table, [*dict.fromkeys([*inputs, output, "mean"])])
    with open(arguments.table, "rb") as f:
        digest = hashlib.sha256(f.read()).hexdigest()
    methods[arguments.method].fit(table)  # before anything is written
    provenance = {"table": os.path.abspath(arguments.table), "sha256": digest, "flows": sorted(set(flows))}
    save_model(arguments.model, arguments.method, inputs, output, table, provenance)


def errors(arguments):
    """Prints the error of each method, with each flow left out of the training."""
    inputs, output = chosen(arguments)
    table, flows = table_of(arguments.table, [*dict.fromkeys([*inputs, output, "mean"])])
    if len(set(flows)) < 2:
        refuse(f"{arguments.table}: bins of {len(set(flows))} flow; must have those of two or more")
    noise = errors_of(arguments.table, output, len(flows))
    scale = float(table[output].min()), float(table[output].max())
    print(f"{'method':28} error of {output}, min-max scaled, each flow left out")
    if noise is not None:
        floor = relative_error(table[output] + noise, table[output], *scale)
        print(f"{'noise of the bins':28} {floor:.4g}")
    for name, model in all_methods(inputs, output).items():
        found = np.empty(len(flows))
        for _, own, others in left_out(flows):
            found[own] = model.fit(taken(table, others)).predict(taken(table, own))
        print(f"{name:28} {relative_error(found, table[output], *scale):.4g}")


def predict(arguments):
    try:
        model, words = open_model(arguments.model)
    except OSError as error:
        refuse(f"{arguments.model}: {error.strerror}")
    except ValueError as error:
        refuse(str(error))
    table, flows = table_of(arguments.table, [*dict.fromkeys([*words["inputs"], "mean"])])
    found, beyond = model.predict(table), model.beyond(table)
    if np.any(beyond > 0):
        warn(
            f"{np.count_nonzero(beyond > 0)} of {len(beyond)} rows lie beyond what the model was trained on, by up to "
            f"{beyond.max():.2g} of its range"
        )
    writer = csv.writer(sys.stdout)
    writer.writerow(["flow", *words["inputs"], f"{words['output']} foretold", "beyond"])
    for k, flow in enumerate(flows):
        writer.writerow(
            [flow, *(f"{table[name][k]:.6g}" for name in words["inputs"]), f"{found[k]:.6g}", f"{beyond[k]:.3g}"]
        )


def main():
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # end silently if the reader of the output ends
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(dest="verb", required=True)
    verb = verbs.add_parser("waves")
    verb.add_argument("velocities")
    verb = verbs.add_parser("bins")
    verb.add_argument("campaigns", nargs="+")
    verb.add_argument("--symmetric", action="store_true")
    for name in ("train", "errors"):
        verb = verbs.add_parser(name)
        verb.add_argument("table")
        verb.add_argument("--inputs", nargs="+", required=True)
        verb.add_argument("--output", required=True)
    verbs.choices["train"].add_argument("--method", default="gaussian process")
    verbs.choices["train"].add_argument("--model", required=True)
    verb = verbs.add_parser("predict")
    verb.add_argument("model")
    verb.add_argument("table")
    arguments = parser.parse_args()
    {"waves": waves, "bins": bins, "train": train, "errors": errors, "predict": predict}[arguments.verb](arguments)


main()
