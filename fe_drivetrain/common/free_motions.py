"""Motions that no restraint feels: found, reduced to the simplest ones, and put into words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import linalg

from fe_drivetrain.common.arrays import Floats

#: Relative to restraints of size one: far above round-off, far below any real restraint.
NULL = 1e-9

_AXES = ("x", "y", "z")


def null_space(restraints: Sequence[Floats], known: int = 0) -> Floats:
    """(n_null, m) orthonormal combinations of motions that no restraint (k, m) feels.

    None where there are no more of them than are `known`.
    """
    A = linalg.qr(np.vstack(restraints), mode="r")[0]
    sizes = linalg.svdvals(A) if A.size else np.zeros(0)
    rank = int((sizes > NULL * max(sizes[0], 1.0)).sum()) if sizes.size else 0
    if A.shape[1] - rank <= known:  # mostly, and vectors take ten times as long
        return np.zeros((0, A.shape[1]))
    return np.asarray(np.linalg.svd(A)[2][rank:])


def sparsest(null: Floats, n_columns: int | None = None) -> Floats:
    """Reduced row echelon form of a null space: each motion moves as few things as it can.

    Of ``n_columns`` columns, all where not given; the others go along.
    """
    basis = null.copy()
    rank = 0
    # Rotations first: "turns about x" says more than a translation that comes with it.
    columns = sorted(range(n_columns or basis.shape[1]), key=lambda c: (c // 6, c % 6 < 3, c))
    for column in columns:
        if rank == len(basis):
            break
        row = rank + int(np.argmax(np.abs(basis[rank:, column])))
        if abs(basis[row, column]) < 1e-6:
            continue
        basis[[rank, row]] = basis[[row, rank]]
        basis[rank] /= basis[rank, column]
        others = [r for r in range(len(basis)) if r != rank]
        basis[others] -= np.outer(basis[others, column], basis[rank])
        rank += 1
    return basis[:rank]


def described_motion(
    parts: Sequence[str], motion: Floats, centre: Floats, length: float, how: str
) -> str:
    """Who moves and how, as in "shaft can turn freely about x through (0, 0, 0) m".

    Parameters
    ----------
    parts : Sequence[str]
        Names of what moves.
    motion : Floats
        (6,) displacement of `centre` and rotation times `length`.
    centre : Floats
        (3,) of the parts [m].
    length : float
        Unit of `motion`'s rotation [m].
    how : str
        "freely" or "nearly".

    Returns
    -------
    str
    """
    subject = " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)
    translation, rotation = motion[:3], motion[3:] / length
    turn = np.linalg.norm(rotation)
    move, spin = (f"{v} freely" if how == "freely" else f"{how} {v}" for v in ("move", "turn"))
    if turn * length < 1e-6:
        return f"{subject} can {move} along {_direction(translation)}"
    # The point of the axis that is nearest to the body's centre.
    through = centre + np.cross(rotation, translation) / turn**2
    through = through - rotation * (rotation @ through) / turn**2
    at = ", ".join(f"{x:.3g}" for x in np.where(np.abs(through) < 1e-6 * length, 0.0, through))
    return f"{subject} can {spin} about {_direction(rotation)} through ({at}) m"


def _direction(vector: Floats) -> str:
    unit = vector / np.linalg.norm(vector)
    axis = int(np.argmax(np.abs(unit)))
    if abs(unit[axis]) > 1 - 1e-6:
        return _AXES[axis]
    return "the direction (" + ", ".join(f"{x:.3g}" for x in unit) + ")"
