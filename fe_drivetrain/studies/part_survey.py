"""What is in a user's part: bores and planes of solids or meshes, stiffness of superelements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.export.condensed_housing import condensed_housing
from fe_drivetrain.export.formats.labelled_matrices import Naming
from fe_drivetrain.export.limited_reading import read_limited
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.foreign.survey import Survey, surveyed
from fe_drivetrain.geometry import CondensedHousing
from fe_drivetrain.report.charts import bars, stiffness_chart
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.shown_units import in_large_unit

SUPERELEMENTS = {
    ".json": "json",
    ".csv": "csv",
    ".h5": "hdf5",
    ".bdf": "dmig",
    ".pch": "dmig",
    ".op4": "op4",
    ".mtx": "substructure",
    ".matrix": "harwell-boeing",
}
"""Format of a superelement by the ending of its file."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class PartResult(Result):
    """A part before a scene takes it as a housing.

    Attributes
    ----------
    survey : Survey or None
        Volume, bores and planes of solids or a mesh; its surface is not part of the JSON.
    element : Superelement or None
        The superelement of another file.
    housing : CondensedHousing or None
        Its stiffness at the bore, as a scene takes it.
    """

    STUDY: ClassVar[str] = "part"

    survey: Survey | None = field(repr=False)
    element: Superelement | None = field(repr=False)
    housing: CondensedHousing | None

    def chart(self) -> Chart:
        """Radius of each bore; of a superelement its stiffness at the bore, of a unit diagonal."""
        if self.housing is not None:
            stiffness = np.array(self.housing.stiffness, dtype=np.float64)
            return stiffness_chart(self.housing.source, ("bore",), stiffness)
        assert self.survey is not None
        radii = {one.name: one.radius for one in reversed(self.survey.bores)}
        unit = self.survey.unit or "the file's unit"
        return bars("Radius of each bore", {"radius": radii}, f"radius [{unit}]")


def part(
    file: Path,
    bore: str = "",
    held: Sequence[str] = (),
    *,
    points: Sequence[str] = (),
    stiffness_name: str = "",
    mass_name: str = "",
    grids: str = "",
    units: str = "m",
    report: Progress = silent,
) -> PartResult:
    """Find what is in a file of a part: what a scene may pick of it, or its stiffness.

    Parameters
    ----------
    file : Path
        Solids (.step, .stp, .igs, .iges, .brep), mesh (.msh, .inp, .vtu, .unv, .med, .stl), or
        superelement (.json, .csv, .h5, .bdf, .pch, .op4, .mtx, .matrix).
    bore : str
        Point in the middle of a superelement's bore; may be left out where it has but one point.
    held : sequence of str
        Points of a superelement that stand on the ground.
    points : sequence of str
        Points of another program's matrices that are kept: "hub=101" by its number, "hub=0,0,1.5"
        by its position, in the order of the rows, or "hub=101,0,0,1.5" by both.
    stiffness_name, mass_name : str
        Names of the matrices, where the file has several that may be meant.
    grids : str
        Nastran bulk data with the points of an OUTPUT4 file.
    units : str
        Units of another program's matrices: "m" for m, N and kg, or "mm" for mm, N and t.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The file cannot be read, a point is unknown or of no superelement, or what is left of one
        moves freely.
    """
    found, steps = Findings(), Steps(report)
    found.seed = None
    survey, element, housing = None, None, None
    naming = Naming(tuple(points), stiffness_name, mass_name, grids, units)
    if file.suffix.lower() not in SUPERELEMENTS:
        _refuse_points(file, {"bore": bore, "held": list(held), **naming.given})
    with steps.step("read"):
        if file.suffix.lower() in SUPERELEMENTS:
            element = read_limited(file, SUPERELEMENTS[file.suffix.lower()], naming=naming)
            housing = condensed_housing(element, bore, held)
        else:
            survey = surveyed(file)
    if survey is not None:
        _find_survey(found, file, survey)
    elif element is not None and housing is not None:
        _find_stiffness(found, file, element, housing)
    return PartResult(
        survey=survey,
        element=element,
        housing=housing,
        **found.frozen(steps.times, file=file.name, bore=bore, held=list(held), **naming.given),
    )


def _refuse_points(file: Path, given: Mapping[str, object]) -> None:
    """Refuse points of a file that is no superelement, and so has none."""
    for name, value in given.items():
        if value:
            names = "names points" if name in ("bore", "held", "points") else "is of matrices"
            raise InputError(
                f"{argument(name, value)} {names} of a superelement, and {file} is none: "
                f"leave {argument(name)} out, or give a file that ends in "
                f"{', '.join(SUPERELEMENTS)}"
            )


def place_records(points: Sequence[str], positions: Floats) -> list[Record]:
    """Names and places (n, 3) [m] of points, as records."""
    return [
        {"point": name, "x [m]": x, "y [m]": y, "z [m]": z}
        for name, (x, y, z) in zip(points, positions.tolist(), strict=True)
    ]


def _find_survey(found: Findings, file: Path, survey: Survey) -> None:
    """Volume, bores and planes of a body."""
    unit = survey.unit or "unit of the file"
    if survey.volume is not None:
        found.found(f"volume [{unit}^3]", survey.volume, survey.volume_band)
    _answer_survey(found, file, survey)
    found.data("bores", [one._asdict() for one in survey.bores])
    found.data("planes", [one._asdict() for one in survey.planes])


def _answer_survey(found: Findings, file: Path, survey: Survey) -> None:
    """State how many bores may be seats; the widest is the one that a scene takes first."""
    holes = [one for one in survey.bores if one.hole]
    plural = "s" * (len(holes) != 1)
    figures = [
        found.value("bores that may be seats", len(holes), at_least=1),
        found.value("planes by which it may be held", len(survey.planes), at_least=1),
        found.value("round faces", len(survey.bores)),
    ]
    verdict = f"{file.name} has {len(holes)} bore{plural} that may be a seat"
    if holes:
        of_file = "" if survey.unit else ", in the unit of the file"
        name = f"diameter of the widest bore{of_file}"
        wide = found.value(f"{name} [{survey.unit}]" if survey.unit else name, 2 * holes[0].radius)
        figures.insert(0, wide)
        verdict = f"{file.name} has {len(holes)} bore{plural} that may be "
        verdict += f"{'seats, the widest' if plural else 'a seat,'} {certain_value(wide)} wide"
        verdict += of_file
    if survey.volume is None:
        verdict = f"Not usable: elements of {file.name} fold over; it has {len(holes)} bore{plural}"
    else:
        figures.append(found.judged("volume"))
    found.answer(f"What can a scene take of {file.name}?", f"{verdict}.", figures)


def _find_stiffness(
    found: Findings, file: Path, element: Superelement, housing: CondensedHousing
) -> None:
    """Points of a superelement, and its stiffness at the bore."""
    state = "on its supports" if element.supported else "free"
    points = ", ".join(element.points)
    found.say(f"Superelement {element.name} at {points}, {state}.")
    figures = []
    for k, motion in enumerate(MOTIONS):
        unit = "N/m" if k < 3 else "N m/rad"
        value = float(housing.stiffness[k][k])
        name = f"{motion} at the bore, other motions held"
        found.found(f"{name} [{unit}]", value)
        shown, large = in_large_unit(value, unit)
        figures.append(found.value(f"{name} [{large}]", shown))
    softest = min(figures[:3], key=lambda one: one.value)
    found.answer(
        f"How stiff is {file.name} as a housing?",
        f"{file.name} holds its bearing with {certain_value(softest)} in its softest direction, "
        f"along {softest.name[1]}.",
        figures,
    )
    found.data("points", place_records(element.points, element.positions))
    found.data(
        "stiffness [N/m, N, N m/rad]",
        [dict(zip(MOTIONS, row, strict=True)) for row in housing.stiffness],
    )
