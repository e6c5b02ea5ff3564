"""The stiffness of a scene in files beside its results, read again and built upon."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain import export
from fe_drivetrain.common import (
    Floats,
    max_difference,
    symmetry_error,
)
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.elasticity.solve import Condensed
from fe_drivetrain.export import (
    SEATS,
    SHAFT,
    Superelement,
    superelement_of,
)
from fe_drivetrain.report import Cell
from fe_drivetrain.report.suite import Page
from fe_drivetrain.shafts.fidelity import ERROR_AGAINST_LAST, Quantity, shaft_level

#: Level of the shaft that is written: exact elasticity of a body of revolution.
LEVEL = 2

#: One for programs, one for spreadsheets; each holds all that a superelement is.
FORMATS = ("json", "csv")

#: Of products of matrices of some twenty rows, with levers of some metres in them.
_ROUND_OFF = 1e-12

#: Twice what solvers stop at, and the supports that are added to a free shaft cost three digits.
_SOLVED_TWICE = 1e-6


def stiffness_files(page: Page, folder: Path, scene: Scene, quantity: Quantity) -> None:
    """Write the free shaft and the bearings on the ground, read them again, and build on them.

    Bearings on a nose are springs of the scene; what holds them is not written.

    Parameters
    ----------
    page : Page
        With what `fe_drivetrain.studies.advise` found of the scene; takes the checks and tables.
    folder : Path
        Where the files go.
    scene : Scene
        The scene.
    quantity : Quantity
        The quantity that a model made of the files must give as the level itself does.
    """
    kinds = (SHAFT, SEATS) if scene.bearing_units else (SHAFT,)
    written = [_Written.read_again(folder, what, superelement_of(scene, what)) for what in kinds]
    for one in written:
        _check(page, one)
    shaft, seats = written[0].again, written[1].again if len(written) > 1 else None
    page.vanishes(
        "shaft: force against a rigid motion, of the forces that it is a sum of",
        shaft.rigid_error(),
        within=_ROUND_OFF,
        why="round-off of small matrices",
        source="a free body",
    )
    (level_two,) = [level for level in page.tables["levels"] if level["level"] == LEVEL]
    found = _rebuilt(scene, quantity, shaft, seats)
    page.vanishes(
        f"{quantity.name} of a model made of the files, less that of level {LEVEL}, relative",
        float(np.linalg.norm(found - level_two["values"]) / np.linalg.norm(level_two["values"])),
        within=_SOLVED_TWICE,
        why="housings solved twice to 1e-9, and the digits that supports on a free body cost",
        source=f"level {LEVEL} of the ladder",
    )
    page.section("Stiffness for other models")
    page.text(
        "Files beside these results, for other programs: the free shaft at its reference "
        "points, with the rings that stand on it, and every bearing with its housing on the "
        "ground (the nose, where there is one, stays in the scene). Put together, with the "
        "gearbox's springs, they are level 2 of the ladder: "
        f"{100 * level_two[ERROR_AGAINST_LAST]:.2g} % from its top for {quantity.name}. "
        "fe-drivetrain export writes them in further formats, and with fixed-interface modes."
    )
    page.table(
        "Stiffness for other models; bands are of each kind of motion, relative to the diagonal "
        "entries of row and column: of the shaft, what elements of one order more change, "
        "continued as at a crack or at half the rate that is seen; of bearings, the difference "
        "between a face held in shape and one that moves on average, and what recovered stresses "
        "say of the mesh",
        [_row(one.files, one.element) for one in written],
        ["files", "points", "level", "mesh", "band ±", "mass [kg]"],
    )
    page.table(
        "Some of its numbers; other motions of the same bearing held",
        _numbers(shaft, seats),
        ["stiffness", "value", "unit"],
    )


@dataclass(frozen=True, eq=False)
class _Written:
    """A superelement in files, and read again.

    Attributes
    ----------
    what : str
        Part of the scene.
    element, again : Superelement
        As it was written, and as the last of its files has it.
    files : list[str]
        Names of the files.
    change : float
        Largest change of the stiffness by any of them, of a unit diagonal.
    """

    what: str
    element: Superelement
    again: Superelement
    files: list[str]
    change: float

    @classmethod
    def read_again(cls, folder: Path, what: str, element: Superelement) -> _Written:
        """Write a superelement in every format, and read it."""
        names, worst = [], 0.0
        for format in FORMATS:
            path = folder / f"{element.name}{export.FORMATS[format].suffix}"
            export.write_superelement(path, element, format)
            names.append(path.name)
            again = export.read_superelement(path, format)
            worst = max(worst, max_difference(again.stiffness, element.stiffness))
        return cls(what, element, again, names, worst)


def _check(page: Page, one: _Written) -> None:
    """What is read is what was written, and symmetric."""
    page.vanishes(
        f"{one.what}: stiffness read less stiffness written, of a unit diagonal",
        one.change,
        within=1e-15,
        why="seventeen digits name every double",
        source="the matrix before it was written",
    )
    page.vanishes(
        f"{one.what}: asymmetry of what is read, of a unit diagonal",
        symmetry_error(one.again.stiffness),
        within=_ROUND_OFF,
        why="round-off of small matrices",
        source="Betti",
    )


def _row(names: list[str], element: Superelement) -> list[Cell]:
    inertia = element.inertia()
    return [
        ", ".join(names),
        ", ".join(element.points),
        element.origin.level,
        element.origin.mesh,
        "not known" if element.band is None else element.band.in_percent,
        None if inertia is None else float(inertia[0, 0]),
    ]


def _rebuilt(
    scene: Scene, quantity: Quantity, shaft: Superelement, seats: Superelement | None
) -> Floats:
    """The quantity, of a model that knows the files, the gearbox's springs and the nose alone."""
    body = Condensed(
        shaft.points,
        shaft.positions,
        shaft.stiffness,
        np.zeros((len(shaft.stiffness), 3)),
        shaft.mass,
    )
    blocks = {}
    if seats is not None:
        for k, name in enumerate(seats.points):
            blocks[name] = seats.stiffness[6 * k : 6 * k + 6, 6 * k : 6 * k + 6]
    return quantity.of(shaft_level(scene, LEVEL, blocks, body), scene.shaft.length)


def _numbers(shaft: Superelement, seats: Superelement | None) -> list[list[Cell]]:
    """The few that beam and multibody models ask for."""
    rows: list[list[Cell]] = []
    for component, what in ((0, "tension"), (3, "torsion")):
        value = _between(shaft, component, shaft.points[0], shaft.points[-1])
        unit = "N/m" if component == 0 else "N m/rad"
        rows.append([f"shaft, {what} from hub to gearbox", value, unit])
    names = (
        ("along x", "along y", "along z", "", "about y (tilt)", "about z (yaw)"),
        ("N/m", "N/m", "N/m", "", "N m/rad", "N m/rad"),
    )
    if seats is None:
        return rows
    for k, name in enumerate(seats.points):
        for c, (motion, unit) in enumerate(zip(*names, strict=True)):
            value = float(seats.stiffness[6 * k + c, 6 * k + c])
            if motion and value > 0:
                rows.append([f"{name} with its housing, {motion}", value, unit])
    return rows


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
