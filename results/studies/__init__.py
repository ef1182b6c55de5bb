"""What the drivers of studies share.

    driver         what most drivers use of the others, in one place
    scenes         scenes that several studies start from, and patches of them
    campaigns      campaigns made, run and read by the program; viscosities of their points, split by term
    estimates      means, quotients and other numbers with their standard errors; control variates
    fits           lines and curves through such numbers
    published      fits and models of packings that others have published
    at_rest        the viscosity at rest; storage and loss
    costs          processor time that was planned, that was taken, and that an estimate costs
    configurations    final configurations, and contacts in trajectories
    tables         csv files
    figure         pictures
    verdicts       statements, checks and findings, the verdict of a study, and its page
    command_line   the command lines of the drivers
    monti          scenes of the suspensions of Monti et al. (2021)
    compositions   mixtures of colloids and grains
    inhomogeneous, learning, learned_maps, profile_solver    flows that vary along their gradient
    speed_accuracy    the panels of results/speed-accuracy, and the columns of its tables

A study is a folder beside this one with study.py, README.md, table.csv, a picture, and study.json: what was found,
which run.py beside this folder lists. What only the seeds tell is in numbers.csv, so that rows can be judged again from
the tables alone.
"""
import sys
from pathlib import Path

# Drivers import this package before NumPy, so that they can say what is missing.
try:
    import numpy  # noqa: F401
    import scipy  # noqa: F401
except ModuleNotFoundError as missing:
    sys.exit(f"studies need the Python module {missing.name}: install python3-numpy and python3-scipy")
ROOT = Path(__file__).resolve().parents[2]
# The package peclet, of the source or installed.
sys.path += [str(ROOT / "python"), str(ROOT.parents[1] / "lib" / "python3" / "dist-packages")]
