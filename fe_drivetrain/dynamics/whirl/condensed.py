"""Rotors condensed to the nodes of their bearings, with some modes of what is between.

Static shapes of the kept nodes (Guyan 1965, AIAA J. 3, 380) and modes with these held (Craig and
Bampton 1968, AIAA J. 6, 1313-1319). Both reduce mass, gyroscopic terms and stiffness of one plane
by the same shapes, so that frequencies at rest come from above.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import linalg

from fe_drivetrain.dynamics.whirl.rotor import Rotor


def condensed_rotor(rotor: Rotor, modes: int = 0) -> Rotor:
    """A rotor condensed to the nodes of its bearings.

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    modes : int
        Modes with these nodes held that are kept, the lowest; none is Guyan's condensation. More
        than there are keeps all, which is the rotor itself.

    Returns
    -------
    Rotor
        Its coordinates are w and dw/dx of each kept node, then one of each mode, which has no
        station.
    """
    nodes = sorted({bearing.node for bearing in rotor.bearings})
    kept = np.array([2 * node + k for node in nodes for k in (0, 1)], dtype=np.int64)
    size = len(rotor.mass)
    inner = np.setdiff1d(np.arange(size), kept)
    count = min(modes, len(inner))
    T = np.zeros((size, len(kept) + count))
    T[kept, np.arange(len(kept))] = 1.0
    if len(inner):
        K = rotor.stiffness[np.ix_(inner, inner)]
        T[inner, : len(kept)] = -linalg.solve(
            K, rotor.stiffness[np.ix_(inner, kept)], assume_a="pos"
        )
    if count:
        M = rotor.mass[np.ix_(inner, inner)]
        # as reciprocals, so that coordinates without mass come last
        _, shapes = linalg.eigh(M, K)
        T[inner, len(kept) :] = shapes[:, ::-1][:, :count]
    number = {node: k for k, node in enumerate(nodes)}
    return replace(
        rotor,
        stations=rotor.stations[nodes],
        mass=np.asarray(T.T @ rotor.mass @ T),
        gyroscopic=np.asarray(T.T @ rotor.gyroscopic @ T),
        stiffness=np.asarray(T.T @ rotor.stiffness @ T),
        bearings=tuple(replace(one, node=number[one.node]) for one in rotor.bearings),
    )
