"""Elements in slabs that share no node, so that threads add to a matrix without waiting."""

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints

# Fewer elements take less time than threads to start. Each cut leaves three layers of elements to
# one thread: so two slabs first, and more where they are large.
_LEAST, _LARGE, _MOST = 800, 3000, 8


def slabs(points: Floats, corners: Ints) -> tuple[list[Ints], Ints]:
    """Elements in slabs across the longest side of their bounding box, and those between two.

    The same on every machine, whatever threads there are: so are the last digits of what is added
    up, slab by slab.

    Parameters
    ----------
    points : Floats
        (n, 3) nodes [m].
    corners : Ints
        (n_cells, c) the corner nodes of each element; elements that share a node share a corner.

    Returns
    -------
    apart : list of Ints
        Elements of each slab that share no node with other slabs; none of a small mesh.
    between : Ints
        The others.
    """
    if len(corners) < _LEAST:
        return [], np.arange(len(corners))
    count = min(max(2, len(corners) // _LARGE), _MOST)
    axis = int(np.ptp(points, axis=0).argmax())
    order = np.argsort(points[corners, axis].sum(axis=1), kind="stable")
    parts = np.array_split(order, count)
    first, last = np.zeros((2, len(points)), dtype=np.int64)
    for number, part in enumerate(parts):
        last[corners[part]] = number
    for number in reversed(range(count)):
        first[corners[parts[number]]] = number
    alone = (first == last)[corners].all(axis=1)
    return [np.sort(part[alone[part]]) for part in parts], np.flatnonzero(~alone)
