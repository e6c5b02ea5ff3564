"""SIMPACK: positions, stiffness and mass as substitution variables in a `.subvar` file.

A model that names the variables takes the values of the file. As SIMPACK and others write it:
first the file version, then one ``subvar($_name, str= 'value')`` a line; "!" begins a comment.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.statement import (
    comment_lines,
    commented,
    dof_labels,
    element_of,
    statement,
    text_of,
)
from fe_drivetrain.export.superelement import Superelement

HEADER = "!file.version=3.5! Removing this line will make the file unreadable"
_LINE = re.compile(r"^subvar\(\$_(?P<name>\w+), str= '(?P<value>[^']*)'\)")


def write(path: Path, element: Superelement) -> None:
    """Write a variable for each coordinate and each entry of the upper triangles.

    ``$_NAME_K_3_9`` is the stiffness between the degrees of freedom 3 and 9 of the superelement
    NAME, and ``$_NAME_M_3_9`` their mass; ``$_NAME_x_2`` is x of its second point. Numbers keep
    every digit.
    """
    entries = statement(element)
    labels = dof_labels(element)
    lines = [HEADER, "", *comment_lines(entries, "!"), ""]

    def add(name: str, value: float, comment: str) -> None:
        lines.append(f"subvar($_{element.name}_{name}, str= '{float(value)!r}') ! {comment}")

    for number, (name, position) in enumerate(
        zip(element.points, element.positions, strict=True), start=1
    ):
        for axis, value in zip("xyz", position, strict=True):
            add(f"{axis}_{number}", value, f"[m] {name}")
    for letter, matrix, units in (
        ("K", element.stiffness, ("N/m", "N/rad", "N m/rad")),
        ("M", element.mass, ("kg", "kg m", "kg m^2")),
    ):
        if matrix is None:
            continue
        matrix = 0.5 * (matrix + matrix.T)
        for i, j in zip(*np.triu_indices(len(matrix)), strict=True):
            turns = int(i % 6 > 2) + int(j % 6 > 2)
            comment = f"[{units[turns]}] {labels[i]}, {labels[j]}"
            add(f"{letter}_{i + 1}_{j + 1}", matrix[i, j], comment)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def read(path: Path) -> Superelement:
    """Read a superelement.

    Raises
    ------
    InputError
        The file is no `.subvar` file of a superelement, or one of its variables is missing.
    """
    text = text_of(path, "SIMPACK subvar file")
    if not text.startswith("!file.version="):
        raise InputError(f"{path} is no SIMPACK subvar file: its first line must state its version")
    entries = commented(text.splitlines()[1:], "!")
    n = 6 * sum(key.startswith("point ") for key in entries)
    values = {m["name"]: m["value"] for m in map(_LINE.match, text.splitlines()) if m}
    prefix = entries.get("superelement", "")
    stiffness = _matrix(path, values, f"{prefix}_K", n)
    mass = _matrix(path, values, f"{prefix}_M", n) if f"{prefix}_M_1_1" in values else None
    return element_of(path, entries, stiffness, mass)


def _matrix(path: Path, values: dict[str, str], prefix: str, n: int) -> Floats:
    upper = np.zeros((n, n))
    try:
        for i, j in zip(*np.triu_indices(n), strict=True):
            upper[i, j] = float(values[f"{prefix}_{i + 1}_{j + 1}"])
    except KeyError as error:
        raise InputError(
            f"{path} has no variable {error}: it may be truncated; export it again"
        ) from error
    except ValueError as error:
        raise InputError(f"{path}: a variable is no number: {error}") from error
    return upper + np.triu(upper, 1).T
