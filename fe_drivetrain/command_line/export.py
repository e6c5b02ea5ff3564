"""The command ``export``: matrices, CalculiX model or mesh of a scene or component."""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.answer_text import answer_text, write_json
from fe_drivetrain.command_line.names import complete_scene
from fe_drivetrain.command_line.option_names import result_with_options
from fe_drivetrain.command_line.options import with_options
from fe_drivetrain.command_line.output_options import wants_json
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.settings import SceneSettings, parse_settings
from fe_drivetrain.command_line.terminal import PASSED, write
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import check_writable
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import named_drivetrain_or_component

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.component import Component
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.studies.export_content import ExportResult, Kind

_ENDINGS = (".inp", ".vtu", ".msh")
_AUTO, _SHAFT, _SUMMARY, _TURNING = "auto", "shaft", "summary", "turning"
_TORSIONAL = "torsional"


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
            "(gmsh) are the mesh.",
        ),
    ] = None
    format_: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="Condense to points, and write stiffness and mass in this format; --list shows "
            "the formats.",
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

    Matrices are of a part, condensed to points, or with --what turning of all that turns. A
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
        asked.format_,
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
    if wanted.what is None and wanted.format is not None and without_sections(found):
        wanted = replace(wanted, what=_TURNING)
        wanted.check()
    if out.exists() and not asked.overwrite:
        raise InputError(f"--out {out} exists: give another file, or add --overwrite")
    if out.exists() and Path(scene).exists() and out.samefile(scene):
        raise InputError(f"--out {out} is the scene itself: give another file")
    result = _written(found, wanted)
    if wants_json():
        write_json(result.to_dict())
    else:
        write(
            sys.stdout, f"{answer_text(result.answer, result.notes)}\n{result.details[0]}\n{out}\n"
        )
    return PASSED


@dataclass(frozen=True)
class Export:
    """What to export, and where; the options of the command.

    Attributes
    ----------
    out : Path
        The file.
    format : str or None
        Of condensed matrices; None for a mesh or a model, by the ending of the file.
    what, at, level : str or None
        Part, points and model level; None for the default.
    modes : int or None
        Number of fixed-interface modes; None for a superelement without modes.
    overwrite : bool
        Whether to replace an existing file.
    generator : str or None
        Whether it turns: "free" or "held", of all that turns; None for the default.
    template : Path or None
        An ElastoDyn file to be copied with other values.
    """

    out: Path
    format: str | None = None
    what: str | None = None
    at: str | None = None
    level: str | None = None
    modes: int | None = None
    overwrite: bool = False
    generator: str | None = None
    template: Path | None = None

    def check(self) -> None:
        """Check what does not depend on the scene.

        Raises
        ------
        InputError
            The format or the file's ending is unknown, options contradict each other, or the file
            cannot be created.
        """
        condensing = {
            "--what": self.what,
            "--at": self.at,
            "--level": self.level,
            "--modes": self.modes,
            "--generator": self.generator,
            "--template": self.template,
        }
        if self.format is None:
            given = [option for option, value in condensing.items() if value is not None]
            if given:
                raise InputError(f"{given[0]} needs --format: give one that --list shows")
            if self.out.suffix not in _ENDINGS:
                raise InputError(
                    f"--out {self.out} ends in {self.out.suffix!r}: use {', '.join(_ENDINGS)}, or "
                    "give --format"
                )
        else:
            self._check_format(self.format)
        if self.out.is_dir() or not self.out.resolve().parent.is_dir():
            raise InputError(
                f"--out {self.out} must be a file in an existing folder: give such a file"
            )
        check_writable(self.out)

    def _check_format(self, name: str) -> None:
        """Refuse a format that is unknown, or not of what is asked for."""
        from fe_drivetrain.export.files import FORMATS
        from fe_drivetrain.export.turning_files import ELASTODYN, TURNING_FORMATS

        if name not in (*FORMATS, *TURNING_FORMATS):
            known = ", ".join(dict.fromkeys((*FORMATS, *TURNING_FORMATS)))
            raise InputError(f"--format {name!r} is unknown: use {known}")
        known = ", ".join(TURNING_FORMATS if self.is_turning else FORMATS)
        if name not in (TURNING_FORMATS if self.is_turning else FORMATS):
            of = f"--what {self.what or _SHAFT}"
            raise InputError(f"--format {name} cannot hold {of}: use one of {known}")
        if (self.template is not None) != (name == ELASTODYN):
            raise InputError(
                f"--format {name} does not use --template: leave it out"
                if self.template is not None
                else f"--format {name} changes two values of an ElastoDyn file: add --template FILE"
            )
        if name == ELASTODYN and (self.level not in (None, _TORSIONAL) or self.generator):
            raise InputError(
                f"--format {name} is one spring of level {_TORSIONAL}, and holds neither another "
                "level nor a state of the generator: leave --level and --generator out"
            )

    @property
    def is_turning(self) -> bool:
        """Whether all that turns is written: asked for, or by a format that holds nothing else."""
        from fe_drivetrain.export.files import FORMATS

        if self.what is not None or self.format is None:
            return self.what == _TURNING
        return self.generator is not None or self.format not in FORMATS

    @property
    def left_out(self) -> str:
        """What the format leaves out of all that turns; empty where it holds all."""
        from fe_drivetrain.export.turning_files import TURNING_FORMATS

        return TURNING_FORMATS[self.format or ""].left_out if self.is_turning else ""

    @property
    def points(self) -> list[str] | None:
        """Names of the points to keep; None for the default."""
        if self.at is None:
            return None
        return [name.strip() for name in self.at.split(",") if name.strip()]

    @property
    def level_number(self) -> int | str | None:
        """The level; None for the default; a word of all that turns.

        Raises
        ------
        InputError
            It is no number.
        """
        if self.level in (None, _AUTO):
            return _TORSIONAL if self.template is not None else None
        if self.is_turning:
            return self.level
        if not re.fullmatch("[0-9]+", self.level):
            raise InputError(
                f"--level {self.level!r} must be {_AUTO} or a number: write it as in --level 2"
            )
        return int(self.level)

    @property
    def kind(self) -> Kind:
        """What is written."""
        if self.is_turning:
            return "turning"
        if self.modes is not None:
            return "modes"
        if self.format is None:
            return "model" if self.out.suffix == ".inp" else "mesh"
        return "summary" if self.what == _SUMMARY else "superelement"


def without_sections(found: Drivetrain | Component) -> bool:
    """Whether it is a drivetrain whose main shaft has no sections."""
    from fe_drivetrain.drivetrain_file.lumped import LumpedDrivetrain

    return isinstance(found, LumpedDrivetrain)


def _written(found: Drivetrain | Component, wanted: Export) -> ExportResult:
    """Write the file; returns what is in it."""
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
        _write(result, wanted)
    result = result_with_options(result)
    if not (left_out := wanted.left_out):
        return result
    note = f"Format {wanted.format} leaves out {left_out}."
    return replace(result, notes=(note, *result.notes))


def _check_format(wanted: Export, kind: Kind) -> None:
    """Refuse a format that cannot hold modes or a summary of a scene."""
    if kind == "modes" and wanted.what in (None, _SHAFT) and wanted.format != "json":
        raise InputError(
            f"--modes is written in json, not as --format {wanted.format}: give --format json"
        )
    if kind == "summary" and wanted.format != "json":
        raise InputError(f"--what summary is json, not {wanted.format}: give --format json")


def _write(result: ExportResult, wanted: Export) -> None:
    """Write the file in the format of its content."""
    from fe_drivetrain import export
    from fe_drivetrain.elasticity.mesh.files import write as write_mesh
    from fe_drivetrain.elasticity.mesh.mesh import Mesh
    from fe_drivetrain.export.craig_bampton import CraigBampton
    from fe_drivetrain.export.formats.craig_bampton_json import write_craig_bampton
    from fe_drivetrain.export.formats.summary import SummaryFile, write_summary
    from fe_drivetrain.export.superelement import Superelement
    from fe_drivetrain.export.turning import Turning
    from fe_drivetrain.export.turning_files import write_turning

    content = result.content
    if isinstance(content, Turning):
        write_turning(wanted.out, content, wanted.format or "", wanted.overwrite, wanted.template)
    elif isinstance(content, Superelement):
        export.write_superelement(wanted.out, content, wanted.format or "", wanted.overwrite)
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
