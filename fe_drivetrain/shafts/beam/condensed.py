"""A beam condensed to some of its stations, free of its supports."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.beam.beam import Beam, Support
from fe_drivetrain.shafts.beam.shaft import shaft_stiffness, unit_load_response


def condensed_beam(beam: Beam, names: Sequence[str], stations: Floats) -> Condensed:
    """Condense the beam without its supports to named stations, exact for loads at these.

    Parameters
    ----------
    beam : Beam
        The beam; what supports it has is left out.
    names : Sequence[str]
        Names of n stations.
    stations : Floats
        Axial place x (n,) of each [m], in any order, both ends of the beam among them.

    Returns
    -------
    body : Condensed
        Body: stiffness between the stations, and the weight as it is carried by clamps at all of
        them.
    """
    bare = replace(beam, supports=())
    n = len(names)
    order = np.argsort(stations)
    K = np.zeros((6 * n, 6 * n))
    for (i, j), (a, b) in zip(pairwise(order), pairwise(stations[order].tolist()), strict=True):
        rows = np.r_[6 * i : 6 * i + 6, 6 * j : 6 * j + 6]
        K[np.ix_(rows, rows)] += shaft_stiffness(bare, a, b)
    # clamped at every point, its weight is carried by these alone
    clamps = [Support(name, x, np.full(6, np.inf)) for name, x in zip(names, stations, strict=True)]
    clamped = replace(bare, supports=clamps)
    gravity = unit_load_response(clamped, bare.start).gravity_reaction.reshape(6 * n, 3)
    positions = np.column_stack([stations, np.zeros((n, 2))])
    return Condensed(tuple(names), positions, K, gravity)
