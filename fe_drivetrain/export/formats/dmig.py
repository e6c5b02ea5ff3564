"""Nastran: points as GRID, stiffness and mass as symmetric DMIG, for an INCLUDE in the bulk data.

Large field format in double precision; of a symmetric matrix one triangle stands in the file, as
Nastran wants it (MSC Nastran Quick Reference Guide, DMIG, remarks 3 and 6). Nastran takes a real
number in any form with a point: the exponent is written short, so that sixteen characters keep
eleven digits of nearly all numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.bulk_data import BulkData, bulk_data
from fe_drivetrain.export.formats.labelled_matrices import (
    TAKEN_AS_IT_IS,
    Naming,
    superelement_of,
)
from fe_drivetrain.export.formats.statement import (
    comment_lines,
    commented,
    element_of,
    statement,
    text_of,
)
from fe_drivetrain.export.superelement import Superelement

_WIDTH = 16
_SYMMETRIC, _DOUBLE = 6, 2
_END = "end"


def write(path: Path, element: Superelement) -> None:
    """Write a superelement as bulk data."""
    lines = "".join(f"{line}\n" for line in _lines(element))
    path.write_bytes(lines.encode("ascii", "replace"))


def read(path: Path, naming: Naming = TAKEN_AS_IT_IS) -> Superelement:
    """Read GRID and DMIG, those of a file that was written here or of another program.

    Parameters
    ----------
    path : Path
        The file.
    naming : Naming
        What it leaves open; the comments of a file that was written here say all.

    Raises
    ------
    InputError
        The file is no bulk data, is cut off, leaves something open, or is no superelement's.
    """
    text = text_of(path, "Nastran bulk data")
    entries = commented(text.splitlines(), "$")
    ours = "superelement" in entries and naming.says_nothing
    if ours and _END not in entries:
        raise InputError(f"{path} is no superelement in Nastran bulk data, or is cut off")
    try:
        found = bulk_data(text)
    except InputError as error:
        raise InputError(f"{path} is no Nastran bulk data: {error}") from None
    if not found.matrices:
        raise InputError(
            f"{path} is no superelement in Nastran bulk data: it has no square DMIG entries, or is "
            "cut off"
        )
    if ours:
        return _of_statement(path, entries, found)
    places = {**found.places, **places_of(naming).places}
    stated = (found.stiffness, found.mass)
    return superelement_of(path, found.matrices, places, naming, stated)


def places_of(naming: Naming) -> BulkData:
    """Points in the bulk data that a user gives beside a file; none where there is none.

    Raises
    ------
    InputError
        It cannot be read, or is no bulk data.
    """
    if not naming.grids:
        return BulkData()
    try:
        return bulk_data(text_of(Path(naming.grids), "Nastran bulk data"))
    except InputError as error:
        raise InputError(f"{argument('grids', naming.grids)}: {error}") from None


def _of_statement(path: Path, entries: dict[str, str], found: BulkData) -> Superelement:
    """The superelement that comments state, with the matrices and points of the cards."""
    numbers = list(range(1, len(found.places) + 1))
    if sorted(found.places) != numbers:
        raise InputError(f"{path}: its GRID entries must be numbered from 1, as its points are")
    element = element_of(path, entries, *_matrices(path, found, entries))
    grids = np.array([found.places[number].position for number in numbers])
    if not np.allclose(grids, element.positions, rtol=1e-9, atol=1e-9):
        raise InputError(f"{path}: its GRID entries are not at the points that its comments name")
    return element


def double(value: float) -> str:
    """A real of double precision in at most sixteen characters, with all digits that fit."""
    for digits in range(_WIDTH, 0, -1):
        mantissa, exponent = f"{value:.{digits}e}".split("e")
        text = f"{mantissa}D{int(exponent)}"
        if len(text) <= _WIDTH:
            return text
    raise ValueError(f"{value} has no form of {_WIDTH} characters")


def matrix_name(element: Superelement, kind: str) -> str:
    """At most eight letters and digits: K or M, and the superelement's name."""
    return (kind[0] + element.name.replace("_", ""))[:8].upper()


_KINDS = {"K": "stiffness", "M": "mass"}


def _lines(element: Superelement) -> Iterator[str]:
    matrices = {"K": element.stiffness} | ({} if element.mass is None else {"M": element.mass})
    names = {letter: matrix_name(element, letter) for letter in matrices}
    entries = statement(element)
    entries |= {f"matrix {letter}": name for letter, name in names.items()}
    entries["in the case control"] = ", ".join(f"{k}2GG = {name}" for k, name in names.items())
    entries["grid points"] = "point 1 is GRID 1, and so on; each has its six degrees of freedom"
    yield from comment_lines(entries, "$")
    for number, position in enumerate(element.positions.tolist(), 1):
        x, y, z = (double(value).replace("D", "E") for value in position)
        yield f"{'GRID*':<8}{number:>16}{'':16}{x:>16}{y:>16}"
        yield f"{'*':<8}{z:>16}"
    for letter, matrix in matrices.items():
        yield from _matrix_lines(names[letter], 0.5 * (matrix + matrix.T))
    yield from comment_lines({_END: "of the superelement"}, "$")


def _matrix_lines(name: str, matrix: Floats) -> Iterator[str]:
    """Header, and for each column its rows from the diagonal down; zeros are left out."""
    yield f"{'DMIG':<8}{name:<8}{0:>8}{_SYMMETRIC:>8}{_DOUBLE:>8}{0:>8}"
    for j in range(len(matrix)):
        rows = [i for i in range(j, len(matrix)) if matrix[i, j] or i == j]
        yield f"{'DMIG*':<8}{name:<16}{j // 6 + 1:>16}{j % 6 + 1:>16}{'':16}"
        for i in rows:
            value = double(float(matrix[i, j]))
            yield f"{'*':<8}{i // 6 + 1:>16}{i % 6 + 1:>16}{value:>16}{'':16}"


def _matrices(path: Path, found: BulkData, entries: dict[str, str]) -> tuple[Floats, Floats | None]:
    matrices: dict[str, Floats] = {}
    degrees = [(grid, c) for grid in sorted(found.places) for c in range(1, 7)]
    for letter, kind in _KINDS.items():
        name = entries.get(f"matrix {letter}", "")
        if name not in found.matrices:
            if letter == "K" or name:
                raise InputError(f"{path} has no DMIG {name!r}: it must hold its {kind}")
            continue
        if found.matrices[name].degrees != degrees:
            raise InputError(f"{path}: DMIG {name} has not the six degrees of freedom of each GRID")
        matrices[letter] = found.matrices[name].values
    return matrices["K"], matrices.get("M")
