"""Errors of the levels of a ladder, as step 2 of a validation reads them from results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.shafts.fidelity.quantity import ERROR_AGAINST_LAST, LEVEL_ERRORS, OWN_ERROR


class Errors(NamedTuple):
    """Relative errors of levels for one quantity.

    Attributes
    ----------
    against_last : sequence of float
        Error of each level against the last one; infinite where it has no such value.
    own : float
        Error of the last level itself.
    """

    against_last: Sequence[float]
    own: float


def state_level_errors(
    found: Findings, levels: Sequence[str], quantities: Mapping[str, Errors]
) -> None:
    """Keep the errors of levels, by quantity, so that a project may rest its level on them.

    Parameters
    ----------
    found : Findings
        Takes them.
    levels : sequence of str
        Names of the levels, from the simplest to the finest.
    quantities : Mapping[str, Errors]
        Errors of these levels, by what they are of.
    """
    found.data(
        LEVEL_ERRORS,
        {
            name: {
                "levels": list(levels),
                ERROR_AGAINST_LAST: [e if np.isfinite(e) else None for e in of.against_last],
                OWN_ERROR: of.own,
            }
            for name, of in quantities.items()
        },
    )
