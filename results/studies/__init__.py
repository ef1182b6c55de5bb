"""Modules that the drivers of studies share.

    driver         imports the most used names of the other modules
    scenes         scenes that several studies start from, and patches of them
    campaigns      makes, runs and reads campaigns; viscosities of their points, split by term
    estimates      means, ratios and other numbers with standard errors; control variates
    fits           lines and curves through numbers with errors
    published      fits and models of packings that others have published
    at_rest        the viscosity at rest; storage and loss moduli
    costs          processor time, planned and used
    configurations    final configurations, and contacts in trajectories
    tables         csv files
    figure         figures
    verdicts       statements, checks and findings, the verdict of a study, and its page
    command_line   the command lines of the drivers
    monti          scenes of the suspensions of Monti et al. (2021)
    compositions   mixtures of colloids and grains
    inhomogeneous, learning, learned_maps, profile_solver    flows that vary along their gradient
    speed_accuracy    the panels of results/speed-accuracy, and the columns of its tables

A study is a folder beside this one with study.py, README.md, table.csv, a figure, and study.json with its result, which
run.py beside this folder lists. Numbers that need single seeds are in numbers.csv, so that --from-table can judge the
statements again from the tables alone.
"""
import sys
from pathlib import Path

# Drivers import this package before NumPy, so that a missing module gives a clear message.
try:
    import numpy  # noqa: F401
    import scipy  # noqa: F401
except ModuleNotFoundError as missing:
    sys.exit(f"studies need the Python module {missing.name}: install python3-numpy and python3-scipy")
ROOT = Path(__file__).resolve().parents[2]
# Path of the package peclet, in the source tree or the installation.
sys.path += [str(ROOT / "python"), str(ROOT.parents[1] / "lib" / "python3" / "dist-packages")]
