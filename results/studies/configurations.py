"""Reads final configurations and the contacts in trajectories; lifetimes and clusters of contacts."""
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


def read_final(path):
    """Returns the edges of the cell (3,), the positions of the spheres (3 arrays, x, y, z) and their radii."""
    with open(path) as f:
        f.readline()
        lattice = [float(x) for x in f.readline().split('Lattice="')[1].split('"')[0].split()]
        *places, radii = np.loadtxt(f, usecols=(1, 2, 3, 4)).T
    return lattice[::4], places, radii


def frames_of(path):
    """Returns, for each frame of a trajectory with contacts, the pairs of touching spheres (n, 2) and their overlaps
    (n,) over the mean radius of the pair."""
    import gsd.hoomd  # Debian's python3-gsd: only studies of trajectories need it

    with gsd.hoomd.open(path, "rb") as trajectory:
        return [
            (np.asarray(frame.bonds.group, dtype=int).reshape(-1, 2), -np.asarray(frame.log["bonds/gap"]))
            for frame in trajectory
        ]


def lifetime(frames):
    """Returns the mean lifetime of a contact [frames]: the mean number of contacts over the mean number that begin
    between two frames. `frames` are arrays of pairs. Infinite if no contact begins."""
    sets = [set(map(tuple, pairs.tolist())) for pairs in frames]
    begun = sum(len(after - before) for before, after in zip(sets, sets[1:]))
    held = sum(map(len, sets[1:]))
    return held / begun if begun else float("inf")


def largest_cluster(pairs, count):
    """Returns the share of `count` spheres in the largest cluster of touching spheres."""
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    _, labels = connected_components(graph, directed=False)
    return np.bincount(labels).max() / count


def contacts_per_sphere(pairs, count):
    return 2 * len(pairs) / count
