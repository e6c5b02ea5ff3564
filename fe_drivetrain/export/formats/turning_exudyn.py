"""Exudyn: all that turns of a drivetrain as a script that builds the model, with its matrices.

One `ObjectGenericODE2` on a node with all degrees of freedom; a marker for each takes loads and
connectors. The script needs Exudyn and numpy, and nothing of this project.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fe_drivetrain.export.formats.statement import comment_lines
from fe_drivetrain.export.turning import Turning

_SCRIPT = '''\
import exudyn
import exudyn.itemInterface as items
import numpy as np

NAMES = {names!r}
ENTRIES = {{
{entries}}}
"""Row, column and value of each entry that is not zero."""


def matrix(kind):
    found = np.zeros((len(NAMES), len(NAMES)))
    for row, column, value in ENTRIES[kind]:
        found[row, column] = value
    return found


def build(rotor_speed=0.0):
    """The container, the system before Assemble(), and a marker by degree of freedom.

    rotor_speed in rad/s, for the gyroscopic terms.
    """
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    still = [0.0] * len(NAMES)
    node = system.AddNode(
        items.NodeGenericODE2(
            referenceCoordinates=still,
            initialCoordinates=still,
            initialCoordinates_t=still,
            numberOfODE2Coordinates=len(NAMES),
        )
    )
    system.AddObject(
        items.ObjectGenericODE2(
            name="drivetrain",
            nodeNumbers=[node],
            massMatrix=matrix("mass"),
            stiffnessMatrix=matrix("stiffness"),
            dampingMatrix=matrix("damping") + rotor_speed * matrix("gyroscopic"),
        )
    )
    markers = {{
        name: system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=number))
        for number, name in enumerate(NAMES)
    }}
    return container, system, markers


if __name__ == "__main__":
    container, system, markers = build()
    system.Assemble()
    squares, _ = system.ComputeODE2Eigenvalues()
    print("natural frequencies, undamped [Hz]")
    for square in np.sort(np.asarray(squares)):
        print(max(float(square), 0.0) ** 0.5 / (2.0 * np.pi))
'''


def write(path: Path, turning: Turning) -> None:
    """Write the script; numbers keep every digit."""
    entries = []
    for kind, matrix in turning.matrices.items():
        entries.append(f"    {kind!r}: [\n")
        entries += [
            f"        ({i}, {j}, {float(matrix[i, j])!r}),\n"
            for i, j in zip(*np.nonzero(matrix), strict=True)
        ]
        entries.append("    ],\n")
    head = "\n".join(comment_lines(turning.statement(), "#"))
    script = _SCRIPT.format(names=list(turning.names), entries="".join(entries))
    path.write_text(f"{head}\n\n{script}", encoding="utf-8")
