"""The command ``export``: matrices, CalculiX model or mesh of a scene or component."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.answer_text import answer_text, write_json
from fe_drivetrain.command_line.export_options import SHAFT, TURNING, Export
from fe_drivetrain.command_line.names import complete_scene
from fe_drivetrain.command_line.option_names import result_with_options
from fe_drivetrain.command_line.options import with_options
from fe_drivetrain.command_line.output_options import wants_json
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.settings import SceneSettings, parse_settings
from fe_drivetrain.command_line.terminal import PASSED, write
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import named_drivetrain_or_component

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.component import Component
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.studies.export_content import ExportResult, Kind


@dataclass(frozen=True)
class ExportRequest:
    """Arguments and options of ``export`` as typed; each help text says what one is."""

    scene: Annotated[
        str | None,
        typer.Argument(
            metavar="SCENE",
            autocompletion=complete_scene,
            help="A drivetrain or component: a file, or a name of the library, such as "
            "main_bearing_bonded, nrel_5mw, gearbox_housing, planet_carrier.",
        ),
    ] = None
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="The file to write. Without --format its ending decides: .inp is the whole model "
            "for CalculiX, with interfaces, supports and unit loads; .vtu (ParaView) and .msh "
            "(gmsh) are the mesh. With several --format the beginning of the files' names, as in "
            "--out shaft for shaft-dmig.bdf and shaft-csv.csv, or an existing folder, where they "
            "begin with the part.",
        ),
    ] = None
    format_: Annotated[
        list[str] | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="Condense to points, and write stiffness and mass in this format; --list shows "
            "the formats. May be repeated: what is condensed once is written in each.",
        ),
    ] = None
    what: Annotated[
        str | None,
        typer.Option(
            "--what",
            metavar="NAME",
            help="Part to condense. Of a scene: shaft (the free shaft, default); drivetrain (the "
            "shaft on its supports); the name of a bearing (with its housing on the ground); seats "
            "(all bearings); or, in json, summary (stiffness of the shaft, K_R, reaction matrices, "
            "masses). Of a drivetrain with a rotor and a generator: turning (mass, stiffness, "
            "damping and gyroscopic matrices of all that turns, and its torsion as one spring). "
            "Of a component: body (default) or supported.",
        ),
    ] = None
    at: Annotated[
        str | None,
        typer.Option(
            "--at",
            metavar="POINTS",
            help="Points to keep, as in hub,gearbox: hub, gearbox, and bearings by name. Default: "
            "all points of the shaft; of the drivetrain the hub.",
        ),
    ] = None
    level: Annotated[
        str | None,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="1 beam, 2 meridian, 3 solid shaft, 4 assembly of solids (for bearings, and for "
            "the drivetrain at its hub), or auto (default): 4 for bearings, 2 for all else of a "
            "scene, 3 for a component. Of all that turns: torsional, rigid or flexible.",
        ),
    ] = None
    modes: Annotated[
        int | None,
        typer.Option(
            "--modes",
            metavar="COUNT",
            min=0,
            help="Add this many fixed-interface modes to the free shaft (Craig-Bampton), in json.",
        ),
    ] = None
    generator: Annotated[
        str | None,
        typer.Option(
            "--generator",
            metavar="free|held",
            help="Whether the generator turns, with --what turning. Default: free.",
        ),
    ] = None
    template: Annotated[
        Path | None,
        typer.Option(
            "--template",
            metavar="FILE",
            help="An ElastoDyn file, of which --format elastodyn writes a copy with another "
            "DTTorSpr and DTTorDmp.",
        ),
    ] = None
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace an existing file.")] = (
        False
    )
    formats: Annotated[bool, typer.Option("--list", help="List the formats and exit.")] = False
    set_: SceneSettings = None


@with_options(ExportRequest, kept="an existing file of that name is unchanged")
def export_command(context: typer.Context, asked: ExportRequest) -> int:
    """Write a drivetrain for other programs: matrices, a model for CalculiX, or its mesh.

    Matrices are those of a part, condensed to points, or, with --what turning, of all that turns. A
    drivetrain whose main shaft has no sections has the latter alone.
    """
    if asked.formats:
        if wants_json():
            from fe_drivetrain.export.turning_files import format_rows

            write_json(format_rows())
        else:
            write(sys.stdout, formats_table())
        return PASSED
    hold_threads()
    changes = parse_settings(asked.set_ or ())
    scene, out = asked.scene, asked.out
    if scene is None or out is None:
        missing = "SCENE" if scene is None else "--out FILE"
        raise InputError(f"Missing {missing}: give it, or --list to see the formats")
    wanted = Export(
        out,
        tuple(asked.format_ or ()),
        asked.what,
        asked.at,
        asked.level,
        asked.modes,
        asked.overwrite,
        asked.generator,
        asked.template,
    )
    wanted.check()
    found = named_drivetrain_or_component(scene, changes)
    if wanted.what is None and wanted.formats and without_sections(found):
        wanted = replace(wanted, what=TURNING)
        wanted.check()
    files = wanted.files(found)
    for file in files.values():
        if file.exists() and not asked.overwrite:
            raise InputError(f"--out {file} exists: give another file, or add --overwrite")
        if file.exists() and Path(scene).exists() and file.samefile(scene):
            raise InputError(f"--out {file} is the scene itself: give another file")
    result = _written(found, wanted, files)
    if wants_json():
        write_json(result.to_dict())
    else:
        lines = (answer_text(result.answer, result.notes), result.details[0], *files.values())
        write(sys.stdout, "".join(f"{line}\n" for line in lines))
    return PASSED


def without_sections(found: Drivetrain | Component) -> bool:
    """Whether it is a drivetrain whose main shaft has no sections."""
    from fe_drivetrain.drivetrain_file.lumped import LumpedDrivetrain

    return isinstance(found, LumpedDrivetrain)


def _written(found: Drivetrain | Component, wanted: Export, files: dict[str, Path]) -> ExportResult:
    """Write the files; returns what is in them."""
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.studies.export_content import prepare_export

    is_scene = isinstance(found, Drivetrain)
    kind = "superelement" if wanted.kind == "summary" and not is_scene else wanted.kind
    if kind == "model" and not is_scene:
        raise InputError(
            f"--out {wanted.out}: a component is written as .vtu or .msh, or with --format"
        )
    if is_scene:
        _check_format(wanted, kind)
    what = "" if kind in ("summary", "turning") else wanted.what or ""
    with show_steps() as report:
        result = prepare_export(
            found,
            kind,
            what,
            wanted.points,
            wanted.level_number,
            wanted.modes or 0,
            generator=wanted.generator or "free",
            report=report,
        )
        report("write")
        _write(result, wanted, files)
    result = result_with_options(result)
    notes = (
        f"Format {names} leaves out {text}."
        if "," not in names
        else f"Each of the formats {names} leaves out {text}."
        for text, names in wanted.left_out.items()
    )
    return replace(result, notes=(*notes, *result.notes))


def _check_format(wanted: Export, kind: Kind) -> None:
    """Refuse a format that cannot hold modes or a summary of a scene."""
    others = [name for name in wanted.formats if name != "json"]
    if kind == "modes" and wanted.what in (None, SHAFT) and others:
        raise InputError(
            f"--modes is written in json, not as --format {others[0]}: give --format json"
        )
    if kind == "summary" and others:
        raise InputError(f"--what summary is json, not {others[0]}: give --format json")


def _write(result: ExportResult, wanted: Export, files: dict[str, Path]) -> None:
    """Write the files in the formats of their content."""
    from fe_drivetrain import export
    from fe_drivetrain.elasticity.mesh.files import write as write_mesh
    from fe_drivetrain.elasticity.mesh.mesh import Mesh
    from fe_drivetrain.export.craig_bampton import CraigBampton
    from fe_drivetrain.export.files import write_superelements
    from fe_drivetrain.export.formats.craig_bampton_json import write_craig_bampton
    from fe_drivetrain.export.formats.summary import SummaryFile, write_summary
    from fe_drivetrain.export.superelement import Superelement
    from fe_drivetrain.export.turning import Turning
    from fe_drivetrain.export.turning_files import write_turning_files

    content = result.content
    if isinstance(content, Turning):
        write_turning_files(files, content, wanted.overwrite, wanted.template)
    elif isinstance(content, Superelement):
        write_superelements(files, content, wanted.overwrite)
    elif isinstance(content, CraigBampton):
        write_craig_bampton(wanted.out, content)
    elif isinstance(content, SummaryFile):
        write_summary(wanted.out, content)
    elif isinstance(content, Mesh):
        write_mesh(content, wanted.out)
    else:
        export.write_inp(content, wanted.out)


def formats_table() -> str:
    """Formats: name, usual ending, programs that read it, and the extra that it needs.

    Returns
    -------
    str
        A heading, and a line for each format.
    """
    from fe_drivetrain.export.turning_files import format_rows

    found = format_rows()
    rows = [list(found[0]), *(list(one.values()) for one in found)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
    return "".join(f"{line}\n" for line in lines)
