"""The command ``export``: matrices, CalculiX model or mesh of a scene or component."""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.commands.progress import show_steps
from fe_drivetrain.commands.scenes import named_scene_or_component
from fe_drivetrain.commands.settings import SceneSettings, parse_settings
from fe_drivetrain.commands.terminal import PASSED, guarded, write
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import check_writable
from fe_drivetrain.common.threads import hold_threads

if TYPE_CHECKING:
    from fe_drivetrain.export.superelement import Superelement
    from fe_drivetrain.scene.component import Component
    from fe_drivetrain.scene.scene import Scene

_ENDINGS = (".inp", ".vtu", ".msh")
_AUTO, _SHAFT, _SUMMARY = "auto", "shaft", "summary"


def export_command(
    scene: Annotated[
        str | None,
        typer.Argument(
            metavar="SCENE",
            help="A scene or component: a file, or a name of the library, such as "
            "main_bearing_bonded, main_bearing_spherical, gearbox_housing, planet_carrier.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="The file to write. Without --format its ending decides: .inp is the whole model "
            "for CalculiX, with interfaces, supports and unit loads; .vtu (ParaView) and .msh "
            "(gmsh) are the mesh.",
        ),
    ] = None,
    format_: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="Condense to points, and write stiffness and mass in this format; --list shows "
            "the formats.",
        ),
    ] = None,
    what: Annotated[
        str | None,
        typer.Option(
            "--what",
            metavar="NAME",
            help="Part to condense. Of a scene: shaft (the free shaft, default); drivetrain (the "
            "shaft on its supports); the name of a bearing (with its housing on the ground); seats "
            "(all bearings); or, in json, summary (stiffness of the shaft, K_R, reaction matrices, "
            "masses). Of a component: body (default) or supported.",
        ),
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(
            "--at",
            metavar="POINTS",
            help="Points to keep, as in hub,gearbox: hub, gearbox, and bearings by name. Default: "
            "all points of the shaft; of the drivetrain the hub.",
        ),
    ] = None,
    level: Annotated[
        str | None,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="1 beam, 2 meridian, 3 solid shaft, 4 assembly of solids (for bearings, and for "
            "the drivetrain at its hub), or auto (default): 4 for bearings, 2 for all else of a "
            "scene, 3 for a component.",
        ),
    ] = None,
    modes: Annotated[
        int | None,
        typer.Option(
            "--modes",
            metavar="COUNT",
            min=0,
            help="Add this many fixed-interface modes to the free shaft (Craig-Bampton), in json.",
        ),
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace an existing file.")
    ] = False,
    formats: Annotated[bool, typer.Option("--list", help="List the formats and exit.")] = False,
    set_: SceneSettings = None,
) -> None:
    """Write a scene for other programs: condensed matrices, a model for CalculiX, or its mesh."""

    def work() -> int:
        if formats:
            write(sys.stdout, formats_table())
            return PASSED
        hold_threads()
        changes = parse_settings(set_ or ())
        if scene is None or out is None:
            missing = "SCENE" if scene is None else "--out FILE"
            raise InputError(f"Missing {missing}: give it, or --list to see the formats")
        wanted = Export(out, format_, what, at, level, modes, overwrite)
        wanted.check()
        found = named_scene_or_component(scene, changes)
        if out.exists() and not overwrite:
            raise InputError(f"--out {out} exists: give another file, or add --overwrite")
        if out.exists() and Path(scene).exists() and out.samefile(scene):
            raise InputError(f"--out {out} is the scene itself: give another file")
        write(sys.stdout, f"{out}: {_written(found, wanted)}\n")
        return PASSED

    raise typer.Exit(guarded(work, "an existing file of that name is unchanged"))


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
    """

    out: Path
    format: str | None = None
    what: str | None = None
    at: str | None = None
    level: str | None = None
    modes: int | None = None
    overwrite: bool = False

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
            from fe_drivetrain.export.files import FORMATS

            if self.format not in FORMATS:
                raise InputError(f"--format {self.format!r} is unknown: use {', '.join(FORMATS)}")
        if self.out.is_dir() or not self.out.resolve().parent.is_dir():
            raise InputError(
                f"--out {self.out} must be a file in an existing folder: give such a file"
            )
        check_writable(self.out)

    @property
    def points(self) -> list[str] | None:
        """Names of the points to keep; None for the default."""
        if self.at is None:
            return None
        return [name.strip() for name in self.at.split(",") if name.strip()]

    def level_number(self, automatic: int, known: str, of: str) -> int:
        """The level as a number.

        Parameters
        ----------
        automatic : int
            The default.
        known : str
            A digit for each level there is.
        of : str
            What is exported, for the message.

        Returns
        -------
        int

        Raises
        ------
        InputError
            There is no such level.
        """
        if self.level in (None, _AUTO):
            return automatic
        if self.level not in tuple(known):
            raise InputError(
                f"--level {self.level!r} of {of} is unknown: use {_AUTO}, "
                f"{', '.join(known[:-1])} or {known[-1]}"
            )
        return int(self.level)


def _written(found: Scene | Component, wanted: Export) -> str:
    """Write the file; returns what is in it."""
    from fe_drivetrain.scene.scene import Scene

    if wanted.modes is not None:
        return _write_modes(found, wanted, wanted.modes)
    if wanted.format is None:
        return _write_model(found, wanted.out)
    if wanted.what == _SUMMARY and isinstance(found, Scene):
        return _write_summary(found, wanted)
    return _write_superelement(found, wanted, wanted.format)


def _write_model(found: Scene | Component, out: Path) -> str:
    """Write the whole model, or the mesh, as the ending of the file says."""
    from fe_drivetrain.export.calculix_deck import write_inp
    from fe_drivetrain.fidelity.component_solid import component_mesh
    from fe_drivetrain.mesh.files import write as write_mesh
    from fe_drivetrain.response.model import build_model, mesh_scene
    from fe_drivetrain.scene.scene import Scene

    if not isinstance(found, Scene) and out.suffix == ".inp":
        raise InputError(f"--out {out}: a component is written as .vtu or .msh, or with --format")
    with show_steps() as report:
        report("mesh")
        mesh = mesh_scene(found) if isinstance(found, Scene) else component_mesh(found)[0]
        if isinstance(found, Scene) and out.suffix == ".inp":
            report("model")
            model = build_model(found, mesh)
            for warning in model.warnings:
                report(f"warning: {warning}")
            report("write")
            write_inp(model, out)
        else:
            report("write")
            write_mesh(mesh, out)
    return f"{len(mesh.cells):,} elements, {len(mesh.points):,} nodes"


def _write_superelement(found: Scene | Component, wanted: Export, format: str) -> str:
    """Write the part, condensed to its points."""
    from fe_drivetrain import export

    with show_steps() as report:
        report("condense")
        element = _superelement(found, wanted)
        report("write")
        export.write(wanted.out, element, format, wanted.overwrite)
    supports = "on its supports" if element.supported else "free"
    return (
        f"{element.name} at {', '.join(element.points)}, {supports}, level {element.origin.level}, "
        f"{'with' if element.mass is not None else 'without'} mass"
    )


def _superelement(found: Scene | Component, wanted: Export) -> Superelement:
    from fe_drivetrain.export.from_component import BODY, component_superelement
    from fe_drivetrain.export.scene_export import superelement_of
    from fe_drivetrain.scene.scene import Scene

    if isinstance(found, Scene):
        level = wanted.level or _AUTO
        number = int(level) if re.fullmatch("[0-9]", level) else level
        return superelement_of(found, wanted.what or _SHAFT, wanted.points, number)
    level_number = wanted.level_number(3, "13", "a component")
    return component_superelement(found, wanted.what or BODY, wanted.points, level_number)


def _write_modes(found: Scene | Component, wanted: Export, modes: int) -> str:
    """Write the free shaft with fixed-interface modes."""
    from fe_drivetrain.export.craig_bampton import craig_bampton_shaft
    from fe_drivetrain.export.formats.craig_bampton_json import write_craig_bampton
    from fe_drivetrain.scene.scene import Scene

    is_level_2_shaft = wanted.what in (None, _SHAFT) and wanted.level in (None, _AUTO, "2")
    if not isinstance(found, Scene) or not is_level_2_shaft or wanted.format != "json":
        raise InputError(_modes_fault(found, wanted))
    with show_steps() as report:
        report("condense")
        body = craig_bampton_shaft(found, modes, wanted.points)
        report("write")
        write_craig_bampton(wanted.out, body)
    return f"shaft at {', '.join(body.points)}, free, with {len(body.omega)} modes"


def _modes_fault(found: Scene | Component, wanted: Export) -> str:
    """Which option --modes cannot go with."""
    from fe_drivetrain.scene.scene import Scene

    if not isinstance(found, Scene):
        return "--modes is for the shaft of a scene, not for a component: leave --modes out"
    if wanted.what not in (None, _SHAFT):
        return f"--modes is for the free shaft, not for --what {wanted.what}: leave --what out"
    if wanted.format != "json":
        return f"--modes is written in json, not as --format {wanted.format}: give --format json"
    return f"--modes is for the shaft of level 2, not --level {wanted.level}: leave --level out"


def _write_summary(scene: Scene, wanted: Export) -> str:
    """Write the numbers of a drivetrain model."""
    from fe_drivetrain.export.formats.summary import summary, write_summary

    if wanted.format != "json":
        raise InputError(f"--what summary is json, not {wanted.format}: give --format json")
    if wanted.at is not None:
        raise InputError(
            f"--at {wanted.at} is not used by --what summary, which has all points of the scene: "
            "leave --at out"
        )
    level = wanted.level_number(2, "1234", "a summary")
    with show_steps() as report:
        report("condense")
        content = summary(scene, level)
        report("write")
        write_summary(wanted.out, content)
    return f"summary of {', '.join(content.parts)}, reactions of level {content.reactions.level}"


def formats_table() -> str:
    """Formats: name, usual ending, programs that read it, and the extra that it needs.

    Returns
    -------
    str
        A heading, and a line for each format.
    """
    from fe_drivetrain.export.files import FORMATS

    head = ("format", "ending", "read by", "needs")
    rows = [head] + [
        (f.name, f.suffix, f.reader, f"fe-drivetrain[{f.extra}]" if f.extra else "")
        for f in FORMATS.values()
    ]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
    return "".join(f"{line}\n" for line in lines)
