"""The command line: list the cases, run them, and say what came out.

Exit status: 0 when every check passes, 1 when one fails, 2 for what the user can mend, 130 when
stopped with Ctrl-C. Nothing heavy is imported before a case is looked for, so help is quick.
"""

from __future__ import annotations

import os
import re
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TextIO

import typer

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import sentence_about
from fe_drivetrain.common.processes import hold_threads

if TYPE_CHECKING:
    from types import FrameType

    from rich.progress import TaskID

    from fe_drivetrain.common.processes import Report
    from fe_drivetrain.report.results import Problem, Results, Verdict
    from fe_drivetrain.scene.component import Component
    from fe_drivetrain.scene.scene import Scene
    from fe_drivetrain.suite.case import AnyCase as Case
    from fe_drivetrain.suite.case import OldCase, Run

PASSED, FAILED, MISTAKE, STOPPED, TERMINATED = 0, 1, 2, 130, 143

_SUMMARY_SENTENCES = 3
_EXPORTS = (".inp", ".vtu", ".msh")
_KEPT = "results of an earlier run are as they were"

_app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

_OutOption = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        help="Result folder: new, empty, or with results of an earlier run, which it replaces. "
        "Left out, reports/GROUP/NAME below the current folder. Of several cases, the folder above "
        "theirs: DIR/GROUP/NAME.",
    ),
]
_SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a setting of the case; the value is a YAML number, word or list, as in "
        "--set gearbox.weight=4e5. May be given several times.",
    ),
]
_SceneSetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a value of the scene, as in --set shaft.sections.0.inner_diameter=0.2. "
        "May be given several times.",
    ),
]
_QuickOption = Annotated[
    bool, typer.Option("--quick", help="Coarser and smaller, for a first look.")
]


def main(arguments: list[str] | None = None) -> None:
    """Entry point of ``fe-drivetrain``; with the words of the shell where none are given."""
    _forgive_narrow_encodings()
    warnings.showwarning = _show_warning
    _app(arguments, prog_name="fe-drivetrain")


def main_of_case(case: Case) -> None:
    """Entry point of a case's own script, with the options of ``fe-drivetrain run``."""
    app = typer.Typer(
        add_completion=False,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )

    @app.command(help=f"{case.title}\n\nSource: {case.source}")
    def run(out: _OutOption = None, set_: _SetOption = None, quick: _QuickOption = False) -> None:
        raise typer.Exit(_run(lambda: [case], out, set_ or (), quick))

    _forgive_narrow_encodings()
    warnings.showwarning = _show_warning
    app()


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    """What the library warns of, as one sentence and without its line of code."""
    _write(sys.stderr, f"fe-drivetrain: warning: {message}\n")


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        _write(sys.stdout, f"fe-drivetrain {version('fe-drivetrain')}\n")
        raise typer.Exit


@_app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    """Finite-element validation cases for wind-turbine drivetrains."""


@_app.command("list")
def _list() -> None:
    """List the validation cases."""
    from itertools import groupby

    lines: list[str] = []

    def collect() -> int:
        from fe_drivetrain.suite.case import all_cases

        cases = all_cases()
        width = max((len(name) for name in cases), default=0)
        for group, names in groupby(cases, lambda name: name.partition("/")[0]):
            lines.extend(["", group] if lines else [group])
            lines.extend(f"  {name:<{width}}  {cases[name].title}" for name in names)
        return PASSED

    status = _guarded(collect)
    _write(sys.stdout, "".join(f"{line}\n" for line in lines))
    raise typer.Exit(status)


@_app.command("run")
def _run_named(
    cases: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="CASE", help="GROUP/NAME, NAME where it is unique, or GROUP for all of it."
        ),
    ] = None,
    all_: Annotated[bool, typer.Option("--all", help="Run every case.")] = False,
    out: _OutOption = None,
    set_: _SetOption = None,
    quick: _QuickOption = False,
    junit: Annotated[
        Path | None,
        typer.Option(
            "--junit", metavar="FILE", help="Write the verdicts as JUnit XML, for CI servers."
        ),
    ] = None,
) -> None:
    """Run validation cases and write their reports.

    Several cases run in processes side by side, as many as there are cores, but those that measure
    time: these come last, one by one. An index.html lists them.

    The exit status is 0 when every check passes, 1 when one fails, 2 for a wrong option or
    setting, and 130 when stopped. A case that needs a program that is not installed is listed as
    skipped.
    """
    names = cases or []

    def several() -> list[Case]:
        from fe_drivetrain.suite.case import all_cases, find_cases

        if all_ and names:
            raise InputError(f"--all runs {', '.join(names)} too: leave out either")
        if not all_ and not names:
            raise InputError("Missing CASE: name one or more, or give --all")
        if all_:
            return list(all_cases().values())
        found = [case for name in names for case in find_cases(name)]
        return list({case.name: case for case in found}.values())

    raise typer.Exit(_run(several, out, set_ or (), quick, junit))


@_app.command("export")
def _export(
    scene: Annotated[
        str | None,
        typer.Argument(
            metavar="SCENE",
            help="A scene file, or a scene of the library by its name: main_bearing_bonded, "
            "main_bearing_spherical; or a component: gearbox_housing, planet_carrier.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="The file. Without --format its ending says what it is: .inp is the whole model "
            "for CalculiX, with interfaces, supports and unit loads; .vtu (ParaView) and .msh "
            "(gmsh) are the mesh.",
        ),
    ] = None,
    format_: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="Condense to points, and write stiffness and mass in this format: see --list.",
        ),
    ] = None,
    what: Annotated[
        str | None,
        typer.Option(
            "--what",
            metavar="NAME",
            help="Which part is condensed: shaft, the free shaft, where left out; drivetrain, the "
            "shaft on its supports; a bearing by its name, with its housing on the ground; seats, "
            "all of these; or summary, in json: stiffness of the shaft, K_R, reaction matrices, "
            "masses. Of a component: body, where left out, or supported.",
        ),
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(
            "--at",
            metavar="POINTS",
            help="Points that are kept, as in hub,gearbox: hub, gearbox and bearings by name. Left "
            "out, all points of the shaft, and the hub of the drivetrain.",
        ),
    ] = None,
    level: Annotated[
        str | None,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="1 beam, 2 meridian, 3 solid shaft, 4 assembly of solids (drivetrain at its hub, "
            "and bearings); auto, where left out, is 2, and 4 of a bearing.",
        ),
    ] = None,
    modes: Annotated[
        int | None,
        typer.Option(
            "--modes",
            metavar="COUNT",
            min=0,
            help="Add so many fixed-interface modes to the free shaft (Craig-Bampton), in json.",
        ),
    ] = None,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace a file that is there.")
    ] = False,
    formats: Annotated[bool, typer.Option("--list", help="List the formats, and exit.")] = False,
    set_: _SceneSetOption = None,
) -> None:
    """Write a scene for other programs: condensed matrices, a model for CalculiX, or its mesh."""

    def work() -> int:
        if formats:
            _write(sys.stdout, _formats_table())
            return PASSED
        hold_threads()
        changes = parse_settings(set_ or ())
        if scene is None or out is None:
            missing = "SCENE" if scene is None else "--out FILE"
            raise InputError(f"Missing {missing}: name it, or give --list for the formats")
        condensing = {"--what": what, "--at": at, "--level": level, "--modes": modes}
        if format_ is None:
            given = [option for option, value in condensing.items() if value is not None]
            if given:
                raise InputError(f"{given[0]} needs --format: name one that --list shows")
            if out.suffix not in _EXPORTS:
                raise InputError(
                    f"--out {out} ends in {out.suffix!r}: use {', '.join(_EXPORTS)}, or give "
                    "--format"
                )
        else:
            from fe_drivetrain.export.files import FORMATS

            if format_ not in FORMATS:
                raise InputError(f"--format {format_!r} is unknown: use {', '.join(FORMATS)}")
        if out.is_dir() or not out.resolve().parent.is_dir():
            raise InputError(f"--out {out} must be a file in a folder that exists: name one")
        from fe_drivetrain.scene.scene import Scene

        found = _component_of(scene, changes) or _scene_of(scene, changes)
        if out.exists() and not overwrite:
            raise InputError(f"--out {out} exists: name another file, or add --overwrite")
        if not isinstance(found, Scene):
            if modes is not None:
                raise InputError("--modes are of the shaft of a scene: leave them out")
            said = _export_component(found, out, format_, what, at, level, overwrite)
        elif format_ is None:
            said = _export_model(found, out)
        else:
            if modes is not None:
                if format_ != "json" or what not in (None, "shaft") or level not in (None, "auto"):
                    raise InputError("--modes are of the shaft at level 2, in json: leave out more")
                said = _export_modes(found, out, at, modes)
            else:
                said = _export_condensed(found, out, format_, what, at, level, overwrite)
        _write(sys.stdout, f"{out}: {said}\n")
        return PASSED

    with _stopped_by_terminate():
        raise typer.Exit(_guarded(work, lambda: "a file of that name is as it was"))


def _export_model(scene: Scene, out: Path) -> str:
    """Write the whole model, or its mesh; what that is."""
    from fe_drivetrain.export.calculix_deck import write_inp
    from fe_drivetrain.mesh.mesh import write
    from fe_drivetrain.response.model import build_model, mesh_scene

    with _progress() as report:
        report("mesh")
        mesh = mesh_scene(scene)
        if out.suffix == ".inp":
            report("model")
            model = build_model(scene, mesh)
            for warning in model.warnings:
                report(f"warning: {warning}")
            report("write")
            write_inp(model, out)
        else:
            report("write")
            write(mesh, out)
        report("")
    return f"{len(mesh.cells):,} elements, {len(mesh.points):,} nodes"


def _export_condensed(
    scene: Scene,
    out: Path,
    format: str,
    what: str | None,
    at: str | None,
    level: str | None,
    overwrite: bool,
) -> str:
    """Write the condensed part of a scene; what that is."""
    from fe_drivetrain import export
    from fe_drivetrain.export.scene_export import AUTO, SHAFT, superelement_of

    if what == "summary":
        return _export_summary(scene, out, format, level)
    points = _points(at)
    wanted = AUTO if level is None else level
    with _progress() as report:
        report("condense")
        element = superelement_of(
            scene, what or SHAFT, points, int(wanted) if re.fullmatch("[0-9]", wanted) else wanted
        )
        report("write")
        export.write(out, element, format, overwrite)
        report("")
    supports = "on its supports" if element.supported else "free"
    return (
        f"{element.name} at {', '.join(element.points)}, {supports}, level {element.origin.level}, "
        f"{'with' if element.mass is not None else 'without'} mass"
    )


def _export_component(
    component: Component,
    out: Path,
    format: str | None,
    what: str | None,
    at: str | None,
    level: str | None,
    overwrite: bool,
) -> str:
    """Write a component's mesh, or it condensed; what that is."""
    from fe_drivetrain import export
    from fe_drivetrain.export.from_component import BODY, component_superelement
    from fe_drivetrain.fidelity.component_solid import component_mesh
    from fe_drivetrain.mesh.mesh import write

    if format is None and out.suffix == ".inp":
        raise InputError(f"--out {out}: a component is written as .vtu or .msh, or with --format")
    if level not in (None, "auto", "1", "3"):
        raise InputError(f"--level {level!r} of a component is unknown: use auto, 1 or 3")
    with _progress() as report:
        if format is None:
            report("mesh")
            mesh, _ = component_mesh(component)
            write(mesh, out)
            report("")
            return f"{len(mesh.cells):,} elements, {len(mesh.points):,} nodes"
        report("condense")
        chosen = 3 if level in (None, "auto") else int(str(level))
        element = component_superelement(component, what or BODY, _points(at), chosen)
        report("write")
        export.write(out, element, format, overwrite)
        report("")
    supports = "on its supports" if element.supported else "free"
    return (
        f"{element.name} at {', '.join(element.points)}, {supports}, level {element.origin.level}, "
        f"{'with' if element.mass is not None else 'without'} mass"
    )


def _points(at: str | None) -> list[str] | None:
    return None if at is None else [name.strip() for name in at.split(",") if name.strip()]


def _export_modes(scene: Scene, out: Path, at: str | None, modes: int) -> str:
    """Write the shaft with its modes; what that is."""
    from fe_drivetrain.export.craig_bampton import craig_bampton_shaft
    from fe_drivetrain.export.formats.craig_bampton_json import write_craig_bampton

    with _progress() as report:
        report("condense")
        body = craig_bampton_shaft(scene, modes, _points(at))
        report("write")
        write_craig_bampton(out, body)
        report("")
    return f"shaft at {', '.join(body.points)}, free, with {len(body.omega)} modes"


def _export_summary(scene: Scene, out: Path, format: str, level: str | None) -> str:
    """Write the numbers of a drivetrain model; what they are."""
    if format != "json":
        raise InputError(f"--what summary is json, not {format}: give --format json")
    from fe_drivetrain.export.formats.summary import summary, write_summary

    chosen = "2" if level in (None, "auto") else str(level)
    if not re.fullmatch("[1-4]", chosen):
        raise InputError(f"--level {chosen!r} of a summary is unknown: use auto, 1, 2, 3 or 4")
    with _progress() as report:
        report("condense")
        content = summary(scene, int(chosen))
        report("write")
        write_summary(out, content)
        report("")
    return f"summary of {', '.join(content.parts)}, reactions of level {content.reactions.level}"


def _formats_table() -> str:
    """The formats: name, usual ending, what it is for, and the extra that it needs."""
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


_SceneArgument = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        help="A scene file, or a scene of the library by its name, as in main_bearing_bonded.",
    ),
]
_LoadOption = Annotated[
    list[str] | None,
    typer.Option(
        "--load",
        metavar="NAME=VALUE",
        help="The load of reactions: hub.Fx to hub.Mz in N and N m, gravity.x to gravity.z in "
        "m/s^2, gearbox.weight in N; may be given several times. Left out, all six hub loads "
        "count.",
    ),
]


@_app.command("advise")
def _advise(
    scene: _SceneArgument,
    quantity: Annotated[
        str,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="What has to be right: a reaction, as main_bearing.My or gearbox.Fz, or "
            "hub.stiffness.uz to hub.stiffness.rz.",
        ),
    ],
    tolerance: Annotated[
        str, typer.Option("--tolerance", metavar="SHARE", help="Allowed error, as in 1% or 0.01.")
    ] = "1%",
    load: _LoadOption = None,
    to_the_top: Annotated[
        bool,
        typer.Option("--to-the-top", help="Run every level, whether or not a cheaper is enough."),
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Result folder; reports/advise/SCENE where left out."
        ),
    ] = None,
    set_: _SceneSetOption = None,
) -> None:
    """Find the cheapest model of a scene that is good enough for a quantity.

    Runs the ladder from cheap to dear as far as needed: statics, beam, meridian in harmonics,
    assembly of solids; and ranks the details of the scene by what leaving each out does.

    The exit status is 0 where a level is known to be within the tolerance, 1 where none is.
    """

    def work() -> int:
        hold_threads()
        found = _scene_of(scene, parse_settings(set_ or ()))
        from fe_drivetrain.commands.advice_page import advised
        from fe_drivetrain.fidelity.adviser import Quantity

        asked = Quantity(quantity, _parse_load(load or ()))
        asked.check(found)
        share = _parse_share(tolerance)
        return _run_on_scene(
            "advise",
            scene,
            f"{found.title}: which level {quantity} needs",
            out,
            lambda case, run: advised(case, run, found, asked, share, to_the_top),
        )

    with _stopped_by_terminate():
        raise typer.Exit(_guarded(work))


@_app.command("uncertainty")
def _uncertainty(
    scene: _SceneArgument,
    quantity: Annotated[
        list[str] | None,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="What is asked for beside every stiffness, which is always reported: a reaction, "
            "as main_bearing.My. The level must be good enough for it. May be given several times; "
            "left out, hub.stiffness.uz.",
        ),
    ] = None,
    load: _LoadOption = None,
    tolerance: Annotated[
        str,
        typer.Option("--tolerance", metavar="SHARE", help="Allowed error of the level, as in 5%."),
    ] = "5%",
    level: Annotated[
        int | None,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="1 beam or 2 meridian, without asking the adviser: the assembly of solids is not "
            "solved then, and the model's error is known between bounds only.",
        ),
    ] = None,
    samples: Annotated[
        int,
        typer.Option(
            "--samples", metavar="COUNT", min=40, max=100_000, help="Of the Latin hypercube."
        ),
    ] = 128,
    seed: Annotated[
        int, typer.Option("--seed", metavar="NUMBER", min=0, help="Of all samples.")
    ] = 0,
    sobol: Annotated[
        bool,
        typer.Option(
            "--sobol",
            help="Sobol's shares of the variance, too; the power of two at or below --samples, "
            "times the number of uncertain values and two, evaluations.",
        ),
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Result folder; reports/uncertainty/SCENE where left out."
        ),
    ] = None,
    set_: _SceneSetOption = None,
) -> None:
    """Say how certain reactions and stiffnesses are, from how certain a scene's values are.

    The scene says under 'uncertainty' which values are how certain. The adviser finds the cheapest
    level that is good enough; sensitivities, and the band of each number from a Latin hypercube,
    are of that level, and stand beside its own error.

    The exit status is 0 where the level is known to be within the tolerance, 1 where it is not.
    """

    def work() -> int:
        hold_threads()
        found = _scene_of(scene, parse_settings(set_ or ()))
        from fe_drivetrain.commands.uncertainty_page import uncertain

        factors = _parse_load(load or ())
        share = _parse_share(tolerance)
        shares = 2 ** (samples.bit_length() - 1) if sobol else 0
        return _run_on_scene(
            "uncertainty",
            scene,
            f"{found.title}: how certain the results are",
            out,
            lambda case, run: uncertain(
                case, run, found, quantity or (), factors, share, level, samples, seed, shares
            ),
        )

    with _stopped_by_terminate():
        raise typer.Exit(_guarded(work))


def _run_on_scene(
    command: str,
    scene: str,
    title: str,
    out: Path | None,
    study: Callable[[OldCase, Run], Results],
) -> int:
    """Run what a command makes of a scene as a case of its own, and say how it ended."""
    from fe_drivetrain.suite.case import OldCase as Case
    from fe_drivetrain.suite.case import run_case

    name = Path(scene).stem
    case = Case(
        name=f"{command}/{name}",
        title=title,
        source=f"the scene {name}",
        run=lambda run: study(case, run),
    )
    folder = Path("reports", command, name) if out is None else out
    with _progress() as report:
        results = run_case(case, folder.resolve(), report=report)
    _write(sys.stdout, _outcome(results, folder / "report.html"))
    return PASSED if results.passed else FAILED


def _component_of(scene: str, changes: Mapping[str, Any]) -> Component | None:
    """The component in a file, or the library's of that name, with changes; None of a scene."""
    from fe_drivetrain.scene.component import is_component, parse_component
    from fe_drivetrain.scene.scene import file_text, library_text

    is_file = Path(scene).suffix != "" or Path(scene).exists()
    text = file_text(scene) if is_file else library_text(scene)
    return parse_component(text, changes, scene) if is_component(text) else None


def _scene_of(scene: str, changes: Mapping[str, Any]) -> Scene:
    """The scene in a file, or the library's of that name, with the user's changes."""
    from fe_drivetrain.scene.scene import change_scene, library_scene, read_scene

    if Path(scene).suffix != "" or Path(scene).exists():
        return read_scene(scene, changes)
    return change_scene(library_scene(scene), changes)


def _parse_load(texts: Iterable[str]) -> Any:
    """(10,) factors of `model.LOADS`; None where there are none."""
    import numpy as np

    from fe_drivetrain.response.model import LOADS

    factors = np.zeros(len(LOADS))
    values = parse_settings(texts)
    for name, value in values.items():
        if name not in LOADS:
            raise InputError(f"--load {name!r} is unknown: use one of {', '.join(LOADS)}")
        if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e15:
            raise InputError(f"--load {name}: {value!r} must be a number, as in --load hub.Fz=-3e5")
        factors[LOADS.index(name)] = value
    if values and not factors.any():
        raise InputError("--load: all loads are zero: give at least one that is not")
    return factors if values else None


def _parse_share(text: str) -> float:
    number, percent, rest = text.partition("%")
    try:
        share = float(number) / (100.0 if percent else 1.0)
    except ValueError:
        share = 0.0
    if rest or not 0.0 < share < 1.0:
        raise InputError(
            f"--tolerance {text!r} must be a share between 0 and 100 %: write it as in 1% or 0.01"
        )
    return share


def parse_settings(texts: Iterable[str]) -> dict[str, Any]:
    """The values of ``--set KEY=VALUE``, parsed as YAML scalars and lists.

    A number is what YAML 1.2 says it is: 1e6 is one, 12:30 and 2026-01-31 are words.

    Raises
    ------
    InputError
        There is no "=", no key, or no such value.
    """
    import yaml

    from fe_drivetrain.common.strict_yaml import PlainLoader, shown

    settings = {}
    for text in texts:
        key, equals, value = text.partition("=")
        key = key.strip()
        if not equals or not key:
            raise InputError(
                f"--set {shown(text)} must be KEY=VALUE: write it as in --set gearbox.weight=4e5"
            )
        try:
            # To YAML an asterisk begins an alias; in a file pattern it is a letter.
            is_pattern = value.lstrip().startswith("*")
            parsed = value if is_pattern else yaml.load(value, Loader=PlainLoader)
            plain = _is_plain(parsed)
        except (yaml.YAMLError, ValueError, RecursionError) as error:
            reason = " ".join(str(getattr(error, "problem", None) or error).split())
            raise InputError(
                f"--set {key}: value {shown(value)} is no plain YAML ({reason}): put text in quotes"
            ) from error
        if not plain:
            raise InputError(
                f"--set {key}: value {shown(value)} must be a number, a word or a list of them: "
                "set the keys below it one by one, as in --set shaft.material=steel"
            )
        settings[key] = parsed
    return settings


def _is_plain(value: object) -> bool:
    if isinstance(value, list):
        return all(map(_is_plain, value))
    return value is None or isinstance(value, str | int | float | bool)


def _run(
    find: Callable[[], list[Case]],
    out: Path | None,
    settings: Sequence[str],
    quick: bool,
    junit: Path | None = None,
) -> int:
    """Run one case, or several side by side; the exit status."""
    several = False

    def work() -> int:
        nonlocal several
        hold_threads()
        parsed = parse_settings(settings)
        if junit is not None and not junit.resolve().parent.is_dir():
            raise InputError(f"--junit {junit}: there is no folder {junit.parent}: create it first")
        cases = find()
        several = len(cases) > 1
        do = _run_several if several else _run_one
        results, problems = do(cases, out, parsed, quick)
        if junit is not None:
            from fe_drivetrain.report.junit import write_junit

            write_junit(junit, [case.name for case in cases], results, problems)
        if any(not problem.is_missing_tool for problem in problems.values()):
            return MISTAKE
        return PASSED if all(found.passed for found in results.values()) else FAILED

    with _stopped_by_terminate():
        return _guarded(work, lambda: f"what was finished is kept, {_KEPT}" if several else _KEPT)


def _run_one(
    cases: Sequence[Case], out: Path | None, settings: Mapping[str, Any], quick: bool
) -> tuple[dict[str, Results], dict[str, Problem]]:
    from fe_drivetrain.suite.case import run_case

    (case,) = cases
    folder = Path("reports", *case.name.split("/")) if out is None else out
    with _progress() as report:
        # a link, or ".", stands for the folder that it leads to
        results = run_case(case, folder.resolve(), settings, quick, report)
    _write(sys.stdout, _outcome(results, folder / "report.html"))
    return {case.name: results}, {}


def _run_several(
    cases: Sequence[Case], out: Path | None, settings: Mapping[str, Any], quick: bool
) -> tuple[dict[str, Results], dict[str, Problem]]:
    from fe_drivetrain.report.results import read_results
    from fe_drivetrain.suite.suite import result_folder, run_cases

    folder = Path("reports") if out is None else out
    with _progress() as report:
        problems = run_cases(cases, folder.resolve(), settings, quick, report)
    results = {
        case.name: read_results(result_folder(folder, case) / "results.json")
        for case in cases
        if case.name not in problems
    }
    _write(sys.stdout, _outcome_of_several(cases, results, problems, folder / "index.html"))
    return results, problems


def _outcome_of_several(
    cases: Sequence[Case],
    results: Mapping[str, Results],
    problems: Mapping[str, Problem],
    page: Path,
) -> str:
    """What the user sees at the end: a line for each case, and what failed in it."""
    lines = []
    for case in cases:
        if case.name in problems:
            problem = problems[case.name]
            kind = "skip" if problem.is_missing_tool else "none"
            lines.append(f"{kind}  {case.name}: {problem.message}")
            continue
        found = results[case.name]
        failed = [verdict for verdict in found.verdicts if not verdict.passed]
        checks = f"{len(found.verdicts) - len(failed)} of {len(found.verdicts)} checks pass"
        seconds = sum(found.times.values())
        lines.append(f"{'FAIL' if failed else 'pass'}  {case.name}: {checks}, {seconds:.1f} s")
        lines += [f"      {_line(verdict)}" for verdict in failed]
    passed = sum(found.passed for found in results.values())
    lines += ["", f"{passed} of {len(cases)} cases pass: {page}"]
    return "".join(f"{line}\n" for line in lines)


def _guarded(work: Callable[[], int], kept: Callable[[], str] = lambda: _KEPT) -> int:
    """Do the work; a user's mistake becomes one sentence and its exit status."""
    try:
        return work()
    except InputError as error:
        message, status = str(error), MISTAKE
    except KeyboardInterrupt:
        message, status = f"stopped; {kept()}", STOPPED
    except OSError as error:
        sentence = sentence_about(error)
        if sentence is None:
            raise
        message, status = sentence, MISTAKE
    except RuntimeError as error:
        # what Path.resolve raises before Python 3.13
        if "Symlink loop" not in str(error):
            raise
        message, status = f"cannot write: {error}: give another folder with --out", MISTAKE
    _write(sys.stderr, f"fe-drivetrain: {message}\n")
    return status


def _outcome(results: Results, page: Path) -> str:
    """What the user sees at the end: each check, the first sentences, and where to read on."""
    lines = [_line(verdict) for verdict in results.verdicts]
    passed = sum(verdict.passed for verdict in results.verdicts)
    lines += ["", *results.summary[:_SUMMARY_SENTENCES], ""]
    lines += [f"{passed} of {len(results.verdicts)} checks pass: {page}"]
    return "".join(f"{line}\n" for line in lines)


def _line(verdict: Verdict) -> str:
    from fe_drivetrain.report.results import expectation

    unit = f" {verdict.unit}" if verdict.unit not in ("", "-") else ""
    return (
        f"{'pass' if verdict.passed else 'FAIL'}  {verdict.quantity}: "
        f"computed {verdict.computed:.5g}{unit}, {expectation(verdict)}"
    )


@contextmanager
def _progress() -> Iterator[Report]:
    """Show steps as they begin: live lines on a terminal, plain lines elsewhere."""
    shown = _live_steps() if sys.stderr.isatty() else _plain_steps()
    with shown as report:
        yield report


def _without_count(step: str) -> str:
    """The name of a step that says how far it is, as in "hub loads (12 of 144)"."""
    return re.sub(r" \(\d+ of \d+\)$", "", step)


@contextmanager
def _live_steps() -> Iterator[Report]:
    """A live line for each lane; the line of a step that has ended stays above them."""
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    console = Console(stderr=True, highlight=False)
    columns = (
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        TimeElapsedColumn(),
    )
    lock = threading.Lock()  # steps come from the threads of other processes, too
    with Progress(*columns, console=console, transient=True) as display:
        tasks: dict[int, TaskID] = {}

        def finish(lane: int) -> None:
            if lane in tasks:
                (task,) = (task for task in display.tasks if task.id == tasks[lane])
                line = f"{_without_count(task.description)} ... {task.elapsed or 0.0:.1f} s"
                console.print(line, markup=False, soft_wrap=True)
                display.remove_task(tasks.pop(lane))

        def report(step: str, lane: int = 0) -> None:
            with lock:
                for task in display.tasks:
                    if task.id == tasks.get(lane) and _without_count(step) == _without_count(
                        task.description
                    ):
                        display.update(task.id, description=step)
                        return
                finish(lane)
                if step:
                    tasks[lane] = display.add_task(step, total=None)

        yield report
        for lane in list(tasks):
            finish(lane)


@contextmanager
def _plain_steps() -> Iterator[Report]:
    """A line for each step: begun at once for this process, at its end for others beside it."""
    lock = threading.Lock()  # steps come from the threads of other processes, too
    current: dict[int, tuple[str, float]] = {}
    is_open = False  # a line that waits for its time

    def finish(lane: int) -> None:
        nonlocal is_open
        if lane not in current:
            return
        name, began = current.pop(lane)
        begun = lane == 0 and is_open
        if is_open and not begun:
            _write(sys.stderr, "\n")
        is_open = False
        prefix = "" if begun else f"{name} ... "
        _write(sys.stderr, f"{prefix}{time.perf_counter() - began:.1f} s\n")

    def report(step: str, lane: int = 0) -> None:
        nonlocal is_open
        name = _without_count(step)
        with lock:
            if lane in current and name == current[lane][0]:
                return
            finish(lane)
            if name:
                current[lane] = name, time.perf_counter()
                if len(current) == 1 and lane == 0:
                    _write(sys.stderr, f"{name} ... ")
                    is_open = True

    try:
        yield report
    except BaseException:
        for lane, (name, _) in current.items():
            prefix = "" if lane == 0 and is_open else f"{name} ... "
            _write(sys.stderr, f"{prefix}not finished\n")
        raise
    for lane in list(current):
        finish(lane)


@contextmanager
def _stopped_by_terminate() -> Iterator[None]:
    """Let a terminate signal unwind like Ctrl-C, so that nothing half-written is left."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise SystemExit(TERMINATED)

    try:
        before = signal.signal(signal.SIGTERM, stop)
    except ValueError:  # not in the main thread: signals are someone else's there
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _write(stream: TextIO, text: str) -> None:
    """Write and flush; a reader that has gone away (as in ``| head``) is no error."""
    try:
        stream.write(text)
        stream.flush()
    except BrokenPipeError:
        # so that nothing more is written there, at exit either
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


def _forgive_narrow_encodings() -> None:
    """Print what a terminal cannot show as "?" instead of failing at the end of a long run."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="replace")
