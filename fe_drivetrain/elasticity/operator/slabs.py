"""Elements in slabs that share no node, so that threads add to a matrix without waiting."""

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats, Ints

# Fewer elements take less time than threads to start. Each cut leaves three layers of elements to
# a second round: so two slabs first, and more where they are large; an even number, so that two
# threads end together.
_MINIMUM, _LARGE, _MAXIMUM = 800, 3000, 8


def slabs(points: Floats, corners: Ints) -> list[list[Ints]]:
    """Elements in rounds: in each, parts that share no node with one another.

    First slabs across the longest side of the bounding box, then what lies around the cuts between
    them, last what is left. The same on every machine, whatever threads there are: so are the last
    digits of what is added up, part by part.

    Parameters
    ----------
    points : Floats
        Nodes (n, 3) [m].
    corners : Ints
        (n_cells, c) the corner nodes of each element; elements that share a node share a corner.

    Returns
    -------
    rounds : list of list of Ints
        Every element once; a small mesh is one part.
    """
    n = len(corners)
    if n < _MINIMUM:
        return [[np.arange(n)]]
    count = 2 * min(max(1, n // (2 * _LARGE)), _MAXIMUM // 2)
    along = max(points.T, key=np.ptp)
    place: Floats = np.add.reduce([along[corner] for corner in corners.T])
    # every second number is a cut of the first round, the others are in the midst of its slabs
    cuts = [k * n // (2 * count) for k in range(1, 2 * count)]
    number = np.searchsorted(np.partition(place, cuts)[cuts], place, side="right")
    rounds, rest = [], np.arange(n)
    for shift in (0, 1):
        slab = (number[rest] + shift) // 2
        alone = _alone(corners[rest], slab, len(points))
        rounds.append([rest[alone & (slab == k)] for k in range(count + shift)])
        rest = rest[~alone]
    return [*rounds, [rest]]


def _alone(corners: Ints, slab: Ints, n_points: int) -> Bools:
    """Which elements share no node with those of another slab."""
    # by columns: along so short rows NumPy takes several times as long
    columns = np.ascontiguousarray(corners.T)
    owner, shared = np.empty(n_points, dtype=slab.dtype), np.zeros(n_points, dtype=np.bool_)
    for column in columns:
        owner[column] = slab
    for column in columns:
        shared[column[owner[column] != slab]] = True
    met = np.logical_or.reduce([shared[column] for column in columns])
    return np.asarray(~met)
