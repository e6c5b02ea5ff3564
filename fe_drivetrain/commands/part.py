"""The command ``part``: what is in a STEP or mesh file, before a scene takes it as a housing."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from fe_drivetrain.commands.terminal import PASSED, guarded, write
from fe_drivetrain.common.errors import InputError


def part_command(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", help="A STEP file (.step, .stp), or a mesh (.msh, .vtu, .inp)."
        ),
    ],
    picture: Annotated[
        Path | None,
        typer.Option("--picture", metavar="PNG", help="Write a picture with the names of faces."),
    ] = None,
) -> None:
    """Show what is in a STEP or mesh file: volume, bores that may be seats, planes, labels.

    The last lines are a housing for a scene, with the widest bore as its seat.
    """

    def work() -> int:
        from fe_drivetrain.foreign.survey import surveyed

        if picture is not None and (
            picture.suffix != ".png" or not picture.absolute().parent.is_dir()
        ):
            raise InputError(f"{picture} must end in .png, in a folder that there is")
        found = surveyed(file)
        write(sys.stdout, found.text)
        if picture is not None and len(found.triangles):
            from fe_drivetrain.report.pictures import NoPictureError
            from fe_drivetrain.report.pictures.part import picture_of_part

            try:
                picture_of_part(found.points, found.triangles, found.marks, picture)
                write(sys.stdout, f"\npicture: {picture}\n")
            except NoPictureError as error:
                write(sys.stderr, f"fe-drivetrain: no picture: {error}\n")
        return PASSED

    raise typer.Exit(guarded(work, "nothing is changed"))
