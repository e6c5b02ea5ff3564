"""The stiffness of a scene in files beside its results, read again and built upon."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain import export
from fe_drivetrain.common import largest_difference, symmetry_error
from fe_drivetrain.export import SEATS, SHAFT, Superelement, superelement_of
from fe_drivetrain.fidelity import Quantity, shaft_level
from fe_drivetrain.report import Results, Section, Table, Text, Verdict, judge
from fe_drivetrain.scene import Scene
from fe_drivetrain.solve import Condensed

#: Level of the shaft that is written: exact elasticity of a body of revolution.
LEVEL = 2

#: One for programs, one for spreadsheets; each holds all that a superelement is.
FORMATS = ("json", "csv")

#: Of products of matrices of some twenty rows, with levers of some metres in them.
_ROUND_OFF = 1e-12

#: Twice what solvers stop at, and the supports that are added to a free shaft cost three digits.
_SOLVED_TWICE = 1e-6


def stiffness_files(
    folder: Path, scene: Scene, quantity: Quantity, results: Results
) -> tuple[Section, list[Verdict]]:
    """Write the free shaft and the bearings on the ground, read them again, and build on them."""
    written = {what: superelement_of(scene, what) for what in (SHAFT, SEATS)}
    verdicts, rows, read = [], [], {}
    for what, element in written.items():
        names = []
        worst = 0.0
        for format in FORMATS:
            path = folder / f"{element.name}{export.FORMATS[format].suffix}"
            export.write(path, element, format)
            names.append(path.name)
            again = read[what] = export.read(path, format)
            worst = max(worst, largest_difference(again.stiffness, element.stiffness))
        rows.append(_row(names, element))
        verdicts += [
            _identity(
                f"{what}: stiffness read less stiffness written, of a unit diagonal",
                worst,
                "the matrix before it was written",
                "seventeen digits name every double",
                1e-15,
            ),
            _identity(
                f"{what}: asymmetry of what is read, of a unit diagonal",
                symmetry_error(again.stiffness),
                "Betti",
                "round-off of small matrices",
            ),
        ]
    verdicts.append(
        _identity(
            "shaft: force against a rigid motion, of the forces that it is a sum of",
            read[SHAFT].rigid_error(),
            "a free body",
            "round-off of small matrices",
        )
    )
    rung = _rung(results)
    verdicts.append(_rebuilt(scene, quantity, read[SHAFT], read[SEATS], rung["values"]))
    items: list[Text | Table] = [
        Text(
            text="Files beside these results, for other programs: the free shaft at its reference "
            "points, with the rings that stand on it, and every bearing with its housing on the "
            "ground. Put together, with the gearbox's springs, they are level 2 of the ladder: "
            f"{100 * rung['error']:.2g} % from its top for {quantity.name}. fe-drivetrain export "
            "writes them in further formats, and with fixed-interface modes."
        ),
        Table(
            caption="Stiffness for other models; bands are of any entry, relative to the diagonal "
            "entries of its row and column: of the shaft, the difference to elements of one order "
            "less; of bearings, that between a face held in shape and one that moves on average",
            columns=["files", "points", "level", "mesh", "band ± [%]", "mass [kg]"],
            rows=rows,
        ),
        _numbers(read[SHAFT], read[SEATS]),
    ]
    return Section(title="Stiffness for other models", items=items), verdicts


def _rung(results: Results) -> Any:
    """What the ladder says of the level that is written, its housings as springs."""
    (rung,) = [rung for rung in results.figures["rungs"] if rung["level"] == LEVEL]
    return rung


def _identity(
    quantity: str, value: float, source: str, reason: str, tolerance: float = _ROUND_OFF
) -> Verdict:
    return judge(
        quantity,
        value,
        0.0,
        tolerance=tolerance,
        relative=False,
        source=source,
        reason=reason,
        measure="identity",
    )


def _row(names: list[str], element: Superelement) -> list[str | float | None]:
    inertia = element.inertia()
    return [
        ", ".join(names),
        ", ".join(element.points),
        element.origin.level,
        element.origin.mesh,
        None if element.band is None else 100 * element.band,
        None if inertia is None else float(inertia[0, 0]),
    ]


def _rebuilt(
    scene: Scene,
    quantity: Quantity,
    shaft: Superelement,
    seats: Superelement,
    expected: Sequence[float],
) -> Verdict:
    """The quantity, of a model that knows the files and the gearbox's springs alone."""
    body = Condensed(
        shaft.points,
        shaft.positions,
        shaft.stiffness,
        np.zeros((len(shaft.stiffness), 3)),
        shaft.mass,
    )
    blocks = {
        name: seats.stiffness[6 * k : 6 * k + 6, 6 * k : 6 * k + 6]
        for k, name in enumerate(seats.points)
    }
    found = quantity.of(shaft_level(scene, LEVEL, blocks, body), scene.shaft.length)
    return _identity(
        f"{quantity.name} of a model made of the files, less that of level {LEVEL}, relative",
        float(np.linalg.norm(found - expected) / np.linalg.norm(expected)),
        f"level {LEVEL} of the ladder",
        "housings solved twice to 1e-9, and the digits that supports on a free body cost",
        _SOLVED_TWICE,
    )


def _numbers(shaft: Superelement, seats: Superelement) -> Table:
    """The few that beam and multibody models ask for."""
    rows: list[list[str | float | None]] = []
    for component, what in ((0, "tension"), (3, "torsion")):
        value = _between(shaft, component, shaft.points[0], shaft.points[-1])
        unit = "N/m" if component == 0 else "N m/rad"
        rows.append([f"shaft, {what} from hub to gearbox", value, unit])
    names = (
        ("along x", "along y", "along z", "", "about y (tilt)", "about z (yaw)"),
        ("N/m", "N/m", "N/m", "", "N m/rad", "N m/rad"),
    )
    for k, name in enumerate(seats.points):
        for c, (motion, unit) in enumerate(zip(*names, strict=True)):
            value = float(seats.stiffness[6 * k + c, 6 * k + c])
            if motion and value > 0:
                rows.append([f"{name} with its housing, {motion}", value, unit])
    return Table(
        caption="Some of its numbers; other motions of the same bearing held",
        columns=["stiffness", "value", "unit"],
        rows=rows,
    )


def _between(element: Superelement, component: int, first: str, last: str) -> float:
    """Stiffness between two points of a free body in one motion along or about x, others free."""
    rows = 6 * np.arange(len(element.points)) + component
    K = element.stiffness[np.ix_(rows, rows)]
    i, j = element.points.index(first), element.points.index(last)
    load = np.zeros(len(rows))
    load[i], load[j] = 1.0, -1.0
    others = np.delete(np.arange(len(rows)), j)
    motion = np.linalg.solve(K[np.ix_(others, others)], load[others])
    return float(1.0 / motion[others.tolist().index(i)])
