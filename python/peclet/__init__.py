"""Campaigns of peclet in Python.

    import peclet

    results = peclet.open("flow-curve.peclet")
    results.estimates()      # a row for each point: what was swept, verdict, mean, 95 % interval
    results.plot()           # the flow curve

Every number comes from `peclet export`, which has to be installed, or from what it wrote into a file.
"""
from peclet.campaign import Campaign
from peclet.program import PecletError
from peclet.results import Results, open_results as open
from peclet.table import Table

__all__ = ["Campaign", "PecletError", "Results", "Table", "open"]
