"""Clusters of spheres that touch: the share of the largest one, and the number of clusters."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

quantities = {"largest_cluster": {"symbol": "S_max / N"}, "clusters": {"symbol": "N_c / N"}}


def measure(frame):
    first, second = frame.contacts.first, frame.contacts.second
    links = coo_array((np.ones(len(first)), (first, second)), shape=(frame.count, frame.count))
    number, cluster = connected_components(links, directed=False)
    return {"largest_cluster": np.bincount(cluster).max() / frame.count, "clusters": number / frame.count}
