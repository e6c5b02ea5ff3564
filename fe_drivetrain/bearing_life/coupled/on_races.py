"""Linear body on a bearing with elastic races: its rollers, as those of an assembly of solids.

The middle of a roller approaches by z = A q - C p: A q is from the motion of the inner ring, C p is
what the races give under all contact loads p. The body has K q + A^T p = L f for its loads f.
Without q, and as for solids, ``S z = G f - p`` is left, which
`fe_drivetrain.bearing_life.rings.assembly_equilibrium` solves.
"""

from __future__ import annotations

import numpy as np

from fe_drivetrain.bearing.races import Races, contact_compliance, roller_lengths, roller_motions
from fe_drivetrain.bearing_life.coupled.body import LinearBody
from fe_drivetrain.bearing_life.rings.assembly import RollerAssembly
from fe_drivetrain.common.errors import InputError

MINIMUM = 1e-6
"""Minimum compliance of races over that of a contact: stiffer ones get it, to have an inverse."""


def body_on_races(body: LinearBody, races: Races) -> RollerAssembly:
    """Put a body with one bearing on elastic races.

    Parameters
    ----------
    body : LinearBody
        A shaft of any level with one bearing, in a rigid housing; or `in_housings` of what carries
        the races, as a bedplate, whose compliance adds to theirs.
    races : Races
        The bearing and its races.

    Returns
    -------
    assembly : RollerAssembly
        Assembly for `fe_drivetrain.bearing_life.rings.assembly_equilibrium`; the inner ring is
        rigid, and reference points are not in it.

    Raises
    ------
    InputError
        The body has several bearings.
    """
    if len(body.bearings) != 1:
        raise InputError(
            f"a body on races has one bearing, and this one has {', '.join(body.bearings)}: take "
            "roller_assembly of its scene"
        )
    bearing = races.bearing
    lengths = roller_lengths(bearing)
    values, vectors = np.linalg.eigh(races.compliance * np.outer(lengths, lengths))
    values = np.maximum(values, MINIMUM * contact_compliance(bearing))
    stiffness = (vectors / values) @ vectors.T
    A = np.vstack(roller_motions(bearing)) * lengths[:, None]
    pushed = stiffness @ A
    follows = np.linalg.solve(body.stiffness + A.T @ pushed, np.hstack([pushed.T, body.loads]))
    size = len(lengths)
    S = stiffness - pushed @ follows[:, :size]
    return RollerAssembly(
        {body.bearings[0]: bearing},
        0.5 * (S + S.T) * np.outer(lengths, lengths),
        lengths[:, None] * (pushed @ follows[:, size:]),
        {},
        np.zeros(size),
        body.entrance,
    )
