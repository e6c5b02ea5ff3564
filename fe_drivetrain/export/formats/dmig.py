"""Nastran: points as GRID, stiffness and mass as symmetric DMIG, for an INCLUDE in the bulk data.

Large field format in double precision; of a symmetric matrix one triangle stands in the file, as
Nastran wants it (MSC Nastran Quick Reference Guide, DMIG, remarks 3 and 6). Nastran takes a real
number in any form with a point: the exponent is written short, so that sixteen characters keep
eleven digits of nearly all numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.nastran import pynastran, quietly
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


def read(path: Path) -> Superelement:
    """Read such a file by pyNastran: matrices from DMIG, positions from GRID.

    Raises
    ------
    InputError
        The file is no bulk data, is cut off, or its comments are not a superelement's.
    MissingToolError
        pyNastran is not installed.
    """
    bdf = pynastran("bdf.bdf")
    entries = commented(text_of(path, "Nastran bulk data").splitlines(), "$")
    if _END not in entries:
        raise InputError(f"{path} is no superelement in Nastran bulk data, or is cut off")
    model = bdf.BDF(debug=None)
    try:
        with quietly():
            model.read_bdf(str(path), punch=True, xref=False, validate=False)
    # whatever a card that cannot be read makes pyNastran raise
    except Exception as error:
        raise InputError(f"{path} is no Nastran bulk data: {error}") from error
    numbers = list(range(1, len(model.nodes) + 1))
    if sorted(model.nodes) != numbers:
        raise InputError(f"{path}: its GRID entries must be numbered from 1, as its points are")
    found = element_of(path, entries, *_matrices(path, model, entries))
    grids = np.array([model.nodes[number].xyz for number in numbers])
    if not np.allclose(grids, found.positions, rtol=1e-9, atol=1e-9):
        raise InputError(f"{path}: its GRID entries are not at the points that its comments name")
    return found


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


def _matrices(path: Path, model: Any, entries: dict[str, str]) -> tuple[Floats, Floats | None]:
    found: dict[str, Floats] = {}
    size = 6 * len(model.nodes)
    for letter in _KINDS:
        name = entries.get(f"matrix {letter}", "")
        if name not in model.dmig:
            if letter == "K" or name:
                raise InputError(f"{path} has no DMIG {name!r}: it must hold its {_KINDS[letter]}")
            continue
        values, rows, _ = model.dmig[name].get_matrix()
        # pyNastran's order of degrees of freedom is that in which they come up
        places = [6 * (grid - 1) + component - 1 for grid, component in map(tuple, rows.values())]
        if sorted(places) != list(range(size)):
            raise InputError(f"{path}: DMIG {name} has not the six degrees of freedom of each GRID")
        matrix = np.zeros((size, size))
        matrix[np.ix_(places, places)] = values
        found[letter] = matrix
    return found["K"], found.get("M")
