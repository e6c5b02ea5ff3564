"""Matrices of other programs: by points and components, made a superelement as the user says.

What a file leaves open is said by a `Naming`: which matrix is the stiffness, which points are kept
and how they are called, where they are, and in which units. All other degrees of freedom, as the
modal ones of Craig and Bampton (AIAA J. 6, 1968), are condensed (Guyan, AIAA J. 3, 1965).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.export.superelement import LARGEST, RIGID, Superelement

Degree = tuple[int, int]
"""Number of a point, and its component: 1 to 6 as in `MOTIONS`, or 0 of a scalar one."""

_SINGULAR = 1e13  # condition of a stiffness with a unit diagonal
_POINT = re.compile(r"([A-Za-z]\w*)=(.+)", re.ASCII)
_NUMBERED = re.compile(r"(\d{1,9})(?:\+(\d{1,9}))?", re.ASCII)
_SETS = ("GG", "AA", "XX", "AAX")  # of degrees of freedom, as Nastran names its matrices
#: Length of a file's unit [m], and its mass [kg]: forces are in newtons.
UNITS = {"m": (1.0, 1.0), "mm": (1e-3, 1e3)}


class Matrix(NamedTuple):
    """A square matrix and the degrees of freedom of its rows, empty where the file has none."""

    degrees: list[Degree]
    values: Floats


class Place(NamedTuple):
    """Where a point is (3,), and the axes (3, 3) of its motions, as columns."""

    position: Floats
    axes: Floats


@dataclass(frozen=True)
class Naming:
    """What a file of matrices leaves open, in a user's words.

    Attributes
    ----------
    points : tuple of str
        Points that are kept, in the order that is wanted: "hub=101" by the number of a point,
        "hub=0,0,1.5" by the position of the next six rows, "hub=101,0,0,1.5" by both; and
        "hub=101+102,0,0,1.5" where the rotations are the motions of a second node, as those of a
        rigid body in CalculiX. Without any, all points of six degrees of freedom are kept.
    stiffness_name, mass_name : str
        Names of the matrices, where the file has several.
    grids : str
        Bulk data with the points of a file that has none.
    units : str
        "m" for metres, newtons and kilograms; "mm" for millimetres, newtons and tonnes.
    """

    points: tuple[str, ...] = ()
    stiffness_name: str = ""
    mass_name: str = ""
    grids: str = ""
    units: str = "m"

    @property
    def says_nothing(self) -> bool:
        """Whether the file is taken as it is."""
        return self == Naming()

    @property
    def given(self) -> dict[str, str | list[str]]:
        """What is said, by name."""
        said = {
            k: getattr(self, k) for k, usual in vars(Naming()).items() if vars(self)[k] != usual
        }
        return {k: list(value) if k == "points" else value for k, value in said.items()}


TAKEN_AS_IT_IS = Naming()
"""Nothing is said of a file: it must say all itself."""


class _Point(NamedTuple):
    name: str
    number: int | None
    turning: int | None
    position: Floats | None


def superelement_of(
    path: Path,
    matrices: Mapping[str, Matrix],
    places: Mapping[int, Place],
    naming: Naming,
    stated: tuple[str, str] = ("", ""),
) -> Superelement:
    """The superelement that matrices of another program are.

    Parameters
    ----------
    path : Path
        The file, for messages.
    matrices : Mapping of Matrix
        Matrices by name.
    places : Mapping of Place
        Places of points by number.
    naming : Naming
        What the user says.
    stated : tuple of str
        Names of stiffness and mass that the file itself states, empty where it does not.

    Returns
    -------
    Superelement
        Free where no rigid motion is resisted, else on its supports.

    Raises
    ------
    InputError
        Something is left open, is not in the file, or is no superelement.
    """
    try:
        if naming.units not in UNITS:
            raise InputError(
                f"{argument('units', naming.units)} must be one of {', '.join(UNITS)}: correct it"
            )
        K = _chosen("stiffness", naming.stiffness_name or stated[0], matrices)
        M = _chosen("mass", naming.mass_name or stated[1], matrices)
        assert K is not None
        points = [_point(text) for text in naming.points]
        K = Matrix(_degrees(K, points), K.values)
        mass = None if M is None else _in_order(Matrix(_degrees(M, points), M.values), K.degrees)
        return _assembled(K, mass, places, points, naming.units)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _chosen(kind: str, name: str, matrices: Mapping[str, Matrix]) -> Matrix | None:
    """The matrix of that name, or the only one whose name is that of its kind, or begins so."""
    square = {n: m for n, m in matrices.items() if m.values.shape == (len(m.values),) * 2}
    names = ", ".join(square) or "none"
    if name:
        if name.upper() not in square:
            raise InputError(f"it has no {kind} {name!r}: name one of {names}")
        return _bounded(kind, square[name.upper()])
    letter = {"stiffness": "K", "mass": "M"}[kind]
    found = [n for n in square if n.upper() in {letter + of for of in _SETS}]
    found = found or [n for n in square if n.upper().startswith(letter)]
    if len(found) == 1:
        return _bounded(kind, square[found[0]])
    if kind == "mass" and not found:
        return None
    raise InputError(
        f"it has {len(found)} matrices that may be its {kind}: name one by "
        f"{argument(f'{kind}_name')}, of {names}"
    )


def _bounded(kind: str, matrix: Matrix) -> Matrix:
    if not (np.abs(matrix.values) <= LARGEST).all():
        raise InputError(f"its {kind} must be finite, at most {LARGEST:g}: write it again")
    return matrix


def _point(text: str) -> _Point:
    """A point in the user's words, see `Naming`."""
    parts = _POINT.fullmatch(text.strip())
    try:
        if parts is None:
            raise ValueError
        cells = [cell.strip() for cell in parts[2].split(",")]
        numbered = _NUMBERED.fullmatch(cells[0]) if len(cells) in (1, 4) else None
        place = np.array([float(cell) for cell in cells[numbered is not None :]])
        if place.size not in (0, 3) or not np.isfinite(place).all():
            raise ValueError
    except ValueError:
        raise InputError(
            f"{argument('points', [text])} must be as in 'hub=101' (number of a point), "
            "'hub=0,0,1.5' (its position) or 'hub=101,0,0,1.5' (both): correct it"
        ) from None
    number, turning = (None, None) if numbered is None else (numbered[1], numbered[2])
    return _Point(
        parts[1],
        None if number is None else int(number),
        None if turning is None else int(turning),
        place if place.size else None,
    )


def _degrees(matrix: Matrix, points: Sequence[_Point]) -> list[Degree]:
    """Degrees of freedom of a matrix's rows; without any, six for each point and then scalars."""
    size = len(matrix.values)
    if matrix.degrees:
        if len(matrix.degrees) != size:
            raise InputError(
                f"a matrix has {size} rows, but its points have {len(matrix.degrees)} degrees of "
                "freedom: give the points of this file"
            )
        return matrix.degrees
    if not points:
        raise InputError(
            f"it does not say which points its {size} rows are of: give {argument('points')}, as "
            f"in 'hub=0,0,1.5', in the order of the rows, or their bulk data by {argument('grids')}"
        )
    if 6 * len(points) > size:
        raise InputError(
            f"a matrix has {size} rows but must have six for each of {len(points)} points: name "
            "fewer of them"
        )
    numbers = [k if p.number is None else p.number for k, p in enumerate(points, 1)]
    scalars = [(0, k) for k in range(size - 6 * len(points))]
    return [(n, c) for n in numbers for c in range(1, 7)] + scalars


def _in_order(matrix: Matrix, degrees: list[Degree]) -> Floats:
    """A mass in the order of the stiffness; degrees of freedom without mass have none."""
    at = {degree: k for k, degree in enumerate(degrees)}
    unknown = [f for k, f in enumerate(matrix.degrees) if f not in at and matrix.values[k].any()]
    if unknown:
        raise InputError(
            f"its mass has the degree of freedom {unknown[0]}, for which it has no stiffness: "
            "correct it"
        )
    known = [k for k, f in enumerate(matrix.degrees) if f in at]
    rows = [at[matrix.degrees[k]] for k in known]
    found = np.zeros((len(degrees), len(degrees)))
    found[np.ix_(rows, rows)] = matrix.values[np.ix_(known, known)]
    return found


def _assembled(
    K: Matrix,
    mass: Floats | None,
    places: Mapping[int, Place],
    points: Sequence[_Point],
    unit: str,
) -> Superelement:
    at = {degree: k for k, degree in enumerate(K.degrees)}
    if not points:
        whole = sorted({n for n, c in K.degrees if c and all((n, d) in at for d in range(1, 7))})
        points = [_Point(f"grid_{n}", n, None, None) for n in whole if n in places]
    if not points:
        raise InputError(
            "none of its points has a position and six degrees of freedom: give "
            f"{argument('points')}, as in 'hub=101,0,0,1.5'"
        )
    kept, positions, turns = [], [], np.zeros((6 * len(points),) * 2)
    for k, point in enumerate(points):
        number = k + 1 if point.number is None else point.number
        six = [(number, c) for c in range(1, 7)]
        if point.turning is not None:
            six[3:] = [(point.turning, c) for c in range(1, 4)]
        if lost := [degree for degree in six if degree not in at]:
            raise InputError(
                f"its stiffness has no component {lost[0][1]} of the point {point.name} "
                f"({lost[0][0]}), which must have all six: name another point"
            )
        position, axes = _placed(point, number, places)
        positions.append(position)
        kept += [at[degree] for degree in six]
        for first in (6 * k, 6 * k + 3):
            turns[first : first + 3, first : first + 3] = axes
    condensed = _condensed(K.values, mass, np.array(kept))
    return _superelement(points, np.array(positions), turns, condensed, unit)


def _placed(point: _Point, number: int, places: Mapping[int, Place]) -> Place:
    own = places.get(number)
    if point.position is not None:
        return Place(point.position, np.eye(3) if own is None else own.axes)
    if own is None:
        raise InputError(
            f"it has no position of the point {point.name} ({number}): give it, as in "
            f"'{point.name}={number},0,0,1.5'"
        )
    return own


def _condensed(K: Floats, M: Floats | None, kept: Ints) -> tuple[Floats, Floats | None]:
    """Stiffness and mass of the kept degrees of freedom; all others follow them without force."""
    if len(set(kept.tolist())) < len(kept):
        raise InputError("two of the points named are the same one: name each once")
    rest = np.setdiff1d(np.arange(len(K)), kept)
    rest = rest[[bool(K[r].any() or (M is not None and M[r].any())) for r in rest]]
    own = np.ix_(kept, kept)
    if not rest.size:
        return K[own], None if M is None else M[own]
    inner = K[np.ix_(rest, rest)]
    if (np.diag(inner) <= 0).any() or np.linalg.cond(scaled_to_unit_diagonal(inner)) > _SINGULAR:
        raise InputError(
            "what is not kept of it moves without force: keep more of its points, or check its "
            "stiffness"
        )
    follow = -np.linalg.solve(inner, K[np.ix_(rest, kept)])
    stiffness = K[own] + K[np.ix_(kept, rest)] @ follow
    if M is None:
        return stiffness, None
    across = M[np.ix_(kept, rest)] @ follow
    mass = M[own] + across + across.T + follow.T @ M[np.ix_(rest, rest)] @ follow
    return stiffness, mass


def _superelement(
    points: Sequence[_Point],
    positions: Floats,
    turns: Floats,
    matrices: tuple[Floats, Floats | None],
    unit: str,
) -> Superelement:
    """In metres, newtons and kilograms, along the basic axes."""
    metre, kilogram = UNITS[unit]
    # motions of the file for those in metres and rad, in the file's axes
    lengths = np.tile([1.0, 1.0, 1.0, metre, metre, metre], len(points))
    change = lengths[:, None] * turns.T
    K, M = (None if m is None else change.T @ m @ change for m in matrices)
    assert K is not None
    K = 0.5 * (K + K.T) / metre if _symmetric(K) else K / metre
    M = None if M is None else kilogram * (0.5 * (M + M.T) if _symmetric(M) else M)
    names = tuple(point.name for point in points)
    made = Superelement("element", names, metre * positions, K, M, True)
    if made.rigid_error() > RIGID:
        return made
    return Superelement("element", names, metre * positions, K, M, False)


def _symmetric(matrix: Floats) -> bool:
    """Whether it is symmetric but for the digits of a file."""
    return bool(np.abs(matrix - matrix.T).max() <= 1e-6 * np.abs(matrix).max())
