"""CSV for a spreadsheet: the statement in lines with "#", then one table with labelled rows.

The first column says which matrix a row is of, the second which degree of freedom: a row is the
forces and moments at that degree of freedom for unit motions of the degrees of freedom in the head.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.csv_cells import SafeWriter, cell_as_given
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.statement import dof_labels, element_of, statement, text_of
from fe_drivetrain.export.superelement import Superelement

_END = "# end"


def write(path: Path, element: Superelement) -> None:
    """Write a superelement; numbers keep every digit."""
    labels = dof_labels(element)
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = SafeWriter(file)
        rows.writerows((f"# {key}", value) for key, value in statement(element).items())
        rows.writerow(["matrix", "freedom", *labels])
        for kind, matrix in (("stiffness", element.stiffness), ("mass", element.mass)):
            if matrix is not None:
                for label, row in zip(labels, matrix.tolist(), strict=True):
                    rows.writerow([kind, label, *row])
        rows.writerow([_END])


def read(path: Path) -> Superelement:
    """Read a superelement.

    Raises
    ------
    InputError
        The file is not such a table, or is cut off.
    """
    entries: dict[str, str] = {}
    found: dict[str, list[list[float]]] = {}
    head: list[str] = []
    ended = False
    text = text_of(path, "superelement in CSV")
    for number, cells in enumerate(csv.reader(text.splitlines()), 1):
        row = [cell_as_given(cell) for cell in cells]
        try:
            if ended or not row:
                continue
            if row[0] == _END:
                ended = True
            elif row[0].startswith("# "):
                entries[row[0][2:]] = row[1]
            elif not head:
                if row[:2] != ["matrix", "freedom"]:
                    raise ValueError("the table's head must begin with matrix,freedom")
                head = row[2:]
            else:
                rows = found.setdefault(row[0], [])
                if len(row) != len(head) + 2 or row[1] != head[len(rows)]:
                    raise ValueError(
                        f"row {row[1]!r} must be that of the column {len(rows) + 1} and as long"
                    )
                rows.append([float(value) for value in row[2:]])
        except (ValueError, IndexError) as error:
            raise InputError(f"{path} is no superelement in CSV: line {number}: {error}") from error
    if not ended:
        raise InputError(f"{path} is no superelement in CSV, or cut off: its last line is {_END!r}")
    if "stiffness" not in found or not set(found) <= {"stiffness", "mass"}:
        raise InputError(
            f"{path} holds the matrices {', '.join(found) or 'none'}: it must hold a stiffness, "
            "and may hold a mass"
        )
    matrices: dict[str, Floats] = {kind: np.array(rows) for kind, rows in found.items()}
    return element_of(path, entries, matrices["stiffness"], matrices.get("mass"))
