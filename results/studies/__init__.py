"""What the drivers of studies share.

    scenes         scenes that several studies start from, and patches of them
    campaigns      campaigns made, run and read by the program
    viscosities    viscosities of a point of an export, split by term, as rows of a table
    estimates      means, quotients and other numbers with their standard errors
    fits           lines and curves through such numbers
    published      fits that others have published
    speed_accuracy    the panels of results/speed-accuracy, and the columns of its tables
    monti          scenes of the suspensions of Monti et al. (2021)
    green_kubo     the viscosity at rest from the correlation of the structural Brownian stress
    controls       control variates with coefficients by regression
    networks       contacts in trajectories
    at_rest        the viscosity at rest, of the study of it or of slow shear
    tables         csv files
    figure         pictures
    verdicts       statements, checks and findings, and the verdict of a study
    pages          these on the page of a study
    command_line   the command lines of the drivers

A study is a folder beside this one with study.py, README.md, table.csv, a picture, and study.json: what was found,
which run.py beside this folder lists. What only the seeds tell is in numbers.csv, so that rows can be judged again from
the tables alone.
"""
import sys

# Drivers import this package before NumPy, so that they can say what is missing.
try:
    import numpy  # noqa: F401
    import scipy  # noqa: F401
except ModuleNotFoundError as missing:
    sys.exit(f"studies need the Python module {missing.name}: install python3-numpy and python3-scipy")
