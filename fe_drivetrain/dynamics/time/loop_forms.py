"""What the loop in time takes and keeps, in the form of compiled code.

Few arrays with many rows: each that is handed on takes time to compile.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import places
from fe_drivetrain.dynamics.time.law_loops import Laws
from fe_drivetrain.dynamics.time.turning_rows import Matrices


class Drive(NamedTuple):
    """Loads: patterns (1, n, p), times (s,) and histories (s, p)."""

    patterns: Floats
    times: Floats
    histories: Floats


class Stop(NamedTuple):
    """The steps end where one ``sign * (row . q')`` is no longer positive; rows (b, n)."""

    rows: Floats
    signs: Floats


class Span(NamedTuple):
    """Number of steps, after how many a record is made, time of the beginning [s], tolerance.

    The tolerance is that of Newton's method: change of an elongation over its maximum so far, and
    of a phase in periods.
    """

    steps: int
    every: int
    begin: float
    tolerance: float


PHASE_ROW, MOVED_ROW, TILTED_ROW = places(3)
"""Kinds of rows: phases, displacements and tilts of bearings."""


class Model(NamedTuple):
    """Matrices, laws, and flags ``kinds`` (3, r) of the rows: 1 where they are of a kind.

    ``bearing`` is the first row of the bearings.
    """

    matrices: Matrices
    laws: Laws
    kinds: Floats
    bearing: int


class Kept(NamedTuple):
    """Records (k, ...).

    ``places`` and ``rates`` (k, n); ``forces`` (k, q) of laws, ``along`` (k, m) of linear springs
    where rows turn, ``bearings`` (2, k, 5 b) motions and loads, ``gripped`` (k, h) accelerations
    along held motions by all forces, ``energies`` (k, 5) as `KINETIC` ...
    """

    times: Floats
    places: Floats
    rates: Floats
    forces: Floats
    along: Floats
    bearings: Floats
    gripped: Floats
    energies: Floats


(
    U, V, A, U0, V0, A0,
    MV, CV, KU, DU, OUTSIDE, OUTSIDE0, INSIDE, STEP, RHS, TERM, TERM2,
) = places(17)  # fmt: skip
"""Vectors of n: displacements, velocities, accelerations now and before the last step; M v, C v,
K u, the drift of dampers; loads at the end and the beginning of a step, forces inside, the step,
and what is summed."""


class Work(NamedTuple):
    """Memory of the loop.

    ``vectors`` (17, n), ``rows`` (13, r) and ``laws`` (4, q) as `U` ..., `Z` ... and `DAMPER` ...;
    ``squares`` (2, r, r) tangent and Jacobian; ``bearings`` (2, b, 5, 5) tangents and dampers,
    ``resisted`` (2, 5 b) by dampers at the beginning and the end of a step; ``sums`` (2, 9) now
    and at its beginning, as `STORED` ...
    """

    load: Floats
    vectors: Floats
    rows: Floats
    laws: Floats
    squares: Floats
    bearings: Floats
    resisted: Floats
    along: Floats
    sums: Floats
    scratch: Floats


def memory(model: Model, bearings: int, springs: int, loads: int) -> Work:
    """Memory for a model with so many bearings, springs whose rows turn, and loads."""
    n, r, q = len(model.matrices.constant), model.kinds.shape[1], model.laws.numbers.shape[1]
    return Work(
        np.zeros((1, loads)),
        np.zeros((17, n)),
        np.zeros((13, r)),
        np.zeros((4, q)),
        np.zeros((2, r, r)),
        np.zeros((2, bearings, 5, 5)),
        np.zeros((2, 5 * bearings)),
        np.zeros((1, springs)),
        np.zeros((2, 9)),
        np.zeros(14),
    )
