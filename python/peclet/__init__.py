"""Builds, runs and reads campaigns of Peclet in Python.

    import peclet

    results = peclet.open("flow-curve.peclet")
    results.estimates()      # a row for each point: swept parameters, verdict, mean, 95 % interval
    results.plot()           # the flow curve

All numbers come from the program peclet, which must be installed.
"""
from peclet.campaign import Campaign
from peclet.program import PecletError
from peclet.results import Results, open_results as open
from peclet.table import Table

__all__ = ["Campaign", "PecletError", "Results", "Table", "open"]
