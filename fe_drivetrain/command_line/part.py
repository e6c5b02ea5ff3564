"""The command ``part``: what is in a file of a part, before a scene takes it as a housing."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.answer_text import answer_text, write_json
from fe_drivetrain.command_line.option_names import result_with_options
from fe_drivetrain.command_line.output_options import wants_json
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.terminal import PASSED, guarded, write
from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.export.superelement import Superelement
    from fe_drivetrain.foreign.survey import Survey
    from fe_drivetrain.geometry import CondensedHousing


def part_command(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="Solids (.step, .stp, .igs, .iges, .brep), mesh (.msh, .inp, .vtu, .unv, .med, "
            ".stl), or superelement (.json, .csv, .h5; .bdf, .pch, .op4, .mtx, .matrix "
            "of others, too).",
        ),
    ],
    bore: Annotated[
        str, typer.Option("--bore", help="Of a superelement: the point in the middle of its bore.")
    ] = "",
    held: Annotated[
        str,
        typer.Option("--held", help="Of a superelement: points on the ground, as in left,right."),
    ] = "",
    point: Annotated[
        list[str] | None,
        typer.Option(
            "--point",
            metavar="NAME=WHERE",
            help="Point of another program's matrices that is kept: hub=101 by its number, "
            "hub=0,0,1.5 by its position, in the order of the rows, hub=101,0,0,1.5 by both, or "
            "hub=101+102,... where the node 102 has its rotations as motions (CalculiX). May be "
            "repeated; all others are condensed.",
        ),
    ] = None,
    stiffness: Annotated[
        str,
        typer.Option(
            "--stiffness", metavar="NAME", help="The matrix that is the stiffness, of several."
        ),
    ] = "",
    mass: Annotated[
        str, typer.Option("--mass", metavar="NAME", help="The matrix that is the mass, of several.")
    ] = "",
    grids: Annotated[
        str,
        typer.Option(
            "--grids", metavar="FILE", help="Bulk data with the points of an OUTPUT4 file."
        ),
    ] = "",
    units: Annotated[
        str,
        typer.Option(
            "--units",
            metavar="m|mm",
            help="Of another program's matrices: m, N and kg, or mm, N and t.",
        ),
    ] = "m",
    picture: Annotated[
        Path | None,
        typer.Option("--picture", metavar="PNG", help="Write a picture with the names of faces."),
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="With --picture: replace an existing file.")
    ] = False,
) -> None:
    """Show what is in a file of solids or a mesh: volume, bores that may be seats, planes, labels.

    The last lines are a housing for a scene, with the widest bore as its seat. Of a superelement
    they are its stiffness at the bore.
    """

    def work() -> int:
        from fe_drivetrain.studies.part_survey import SUPERELEMENTS, part

        if overwrite and picture is None:
            raise InputError("--overwrite is for the file of --picture: give --picture PNG, too")
        if picture is not None and file.suffix.lower() in SUPERELEMENTS:
            raise InputError(
                f"--picture {picture} is of solids or a mesh, and {file} is a superelement, "
                "which has no faces: leave --picture out"
            )
        if picture is not None:
            _check_picture(picture, overwrite)
        with show_steps() as report:
            result = part(
                file,
                bore,
                [name for name in held.split(",") if name],
                points=point or (),
                stiffness_name=stiffness,
                mass_name=mass,
                grids=grids,
                units=units,
                report=report,
            )
        drawn = result.survey is not None and picture is not None and _draw(result.survey, picture)
        if wants_json():
            write_json(result_with_options(result).to_dict())
            return PASSED
        write(sys.stdout, f"{answer_text(result.answer, result.notes)}\n")
        if result.survey is not None:
            write(sys.stdout, result.survey.text)
        elif result.element is not None and result.housing is not None:
            write(sys.stdout, _stiffness_text(file, result.element, result.housing))
        if drawn:
            write(sys.stdout, f"\npicture: {picture}\n")
        return PASSED

    raise typer.Exit(guarded(work, "nothing is changed"))


def _check_picture(picture: Path, overwrite: bool) -> None:
    """Refuse a file that cannot be written, or that is there already, before any work."""
    from fe_drivetrain.common.files import check_writable

    if picture.suffix != ".png" or not picture.absolute().parent.is_dir():
        raise InputError(f"{picture} must end in .png, in an existing folder")
    check_writable(picture)
    if picture.exists() and not overwrite:
        raise InputError(f"--picture {picture} exists: give another file, or add --overwrite")


def _draw(found: Survey, picture: Path) -> bool:
    """Draw what was found; the file appears whole or not at all. Whether it did."""
    if not len(found.triangles):
        return False
    from fe_drivetrain.common.files import atomic_path, scratch_folder
    from fe_drivetrain.report.pictures import NoPictureError
    from fe_drivetrain.report.pictures.part import picture_of_part

    with scratch_folder() as scratch:
        drawn = scratch / "picture.png"
        try:
            picture_of_part(found.points, found.triangles, found.marks, drawn).wait()
        except NoPictureError as error:
            write(sys.stderr, f"fe-drivetrain: no picture: {error}\n")
            return False
        with atomic_path(picture) as unfinished:
            unfinished.write_bytes(drawn.read_bytes())
    return True


def _stiffness_text(file: Path, element: Superelement, housing: CondensedHousing) -> str:
    """Points of a superelement, and the housing that it is in a scene."""
    lines = [f"{file.name}: superelement {element.name}, its points [m]:"]
    lines += [
        f"  {name}  ({x:.6g}, {y:.6g}, {z:.6g})"
        for name, (x, y, z) in zip(element.points, element.positions.tolist(), strict=True)
    ]
    lines.append("on its supports" if element.supported else "free")
    lines += ["", "In a scene, for a bearing whose centre is the bore's point:", "    housing:"]
    lines += [f"      source: {housing.source}", "      stiffness:"]
    lines += [f"        - [{', '.join(f'{k:.15e}' for k in row)}]" for row in housing.stiffness]
    return "\n".join(lines) + "\n"
