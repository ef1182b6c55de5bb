"""Final configurations, and contacts in the frames of a trajectory: how long they last, and what they connect."""
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


def read_final(path):
    """Returns the edges of the cell, the places of the spheres (a row for each axis) and their radii."""
    with open(path) as f:
        f.readline()
        lattice = [float(x) for x in f.readline().split('Lattice="')[1].split('"')[0].split()]
        *places, radii = np.loadtxt(f, usecols=(1, 2, 3, 4)).T
    return lattice[::4], places, radii


def frames_of(path):
    """Returns, for each frame of trajectory.gsd with contacts, the pairs of spheres that touch, in two columns,
    and by how much they overlap, over the mean of their radii."""
    import gsd.hoomd  # Debian's python3-gsd: only studies of trajectories need it

    with gsd.hoomd.open(path, "rb") as trajectory:
        return [
            (np.asarray(frame.bonds.group, dtype=int).reshape(-1, 2), -np.asarray(frame.log["bonds/gap"]))
            for frame in trajectory
        ]


def lifetime(frames):
    """Returns the mean time from the first to the last frame of a contact, in frames: the mean number of contacts over
    how many begin from one frame to the next. Infinite where none begins."""
    sets = [set(map(tuple, pairs.tolist())) for pairs in frames]
    begun = sum(len(after - before) for before, after in zip(sets, sets[1:]))
    held = sum(map(len, sets[1:]))
    return held / begun if begun else float("inf")


def largest_cluster(pairs, count):
    """Returns the share of so many spheres that the largest group has of which each touches another one."""
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    _, labels = connected_components(graph, directed=False)
    return np.bincount(labels).max() / count


def contacts_per_sphere(pairs, count):
    return 2 * len(pairs) / count
