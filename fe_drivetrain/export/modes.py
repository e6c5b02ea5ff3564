"""Natural frequencies of a condensed shaft, free or on the supports of its scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy import linalg

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.solve.condensation import on_supports


def natural_frequencies(
    points: Sequence[str],
    stiffness: Floats,
    mass: Floats,
    supports: Mapping[str, Floats] | None = None,
) -> Floats:
    """Natural frequencies, ascending, those of free motions among them as about 0 [Hz].

    For the arguments see `condensation.on_supports`; mass is of the same degrees of freedom as
    stiffness.
    """
    K, left = on_supports(points, stiffness, supports or {})
    M = np.asarray(mass)[np.ix_(left, left)]
    # lengths and angles, points and modes equally: a unit diagonal keeps the digits of all
    values = linalg.eigh(
        scaled_to_unit_diagonal(K, M.diagonal()), scaled_to_unit_diagonal(M), eigvals_only=True
    )
    return np.asarray(np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi))
