"""The command ``new``: write a scene to start from, or a drivetrain from a gearbox model."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import Annotated

import typer

from fe_drivetrain.command_line.answer_text import write_json
from fe_drivetrain.command_line.output_options import wants_json
from fe_drivetrain.command_line.terminal import PASSED, guarded, write
from fe_drivetrain.common.errors import InputError

SUFFIXES = (".yaml", ".yml")
"""Endings of files that a user edits."""
DEFAULT = "three-point"
"""Arrangement where none is given."""


def new_command(
    file: Annotated[
        Path | None,
        typer.Argument(metavar="FILE", help="The scene file to write, as in my.yaml."),
    ] = None,
    arrangement: Annotated[
        str,
        typer.Option(
            "--arrangement",
            metavar="NAME",
            help="How the shaft is supported; --list shows the arrangements.",
        ),
    ] = DEFAULT,
    source: Annotated[
        Path | None,
        typer.Option(
            "--from",
            metavar="MODEL",
            help="A gearbox model in REXS 1.0 to 1.6 (.rexs, .rexsj, .rexsz) to begin from. What "
            "it lacks is listed.",
        ),
    ] = None,
    bearing: Annotated[
        bool,
        typer.Option(
            "--bearing", help="A file of bearings instead, with the numbers of a catalogue's page."
        ),
    ] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace existing files.")] = False,
    list_: Annotated[bool, typer.Option("--list", help="List the arrangements and exit.")] = False,
) -> None:
    """Write a drivetrain to start from, with comments, and its schema for editors beside it."""

    def work() -> int:
        from fe_drivetrain.drivetrain_file.arrangements import (
            ARRANGEMENTS,
            SCHEMA_FILE,
            drivetrain_schema,
            starting_scene,
        )

        if list_:
            if source is not None:
                raise InputError("--list lists arrangements, and --from is a model: give one")
            return _listed()
        if file is None:
            raise InputError("Missing FILE: name the scene file to write, as in my.yaml, or --list")
        if file.suffix.lower() not in SUFFIXES:
            raise InputError(f"{file} must end in {' or '.join(SUFFIXES)}: name it as in my.yaml")
        if bearing:
            if source is not None or arrangement != DEFAULT:
                raise InputError(
                    "--bearing writes no drivetrain: leave --from and --arrangement out"
                )
            return _bearings(file, overwrite)
        if source is not None:
            if arrangement != DEFAULT:
                raise InputError("--from is a gearbox and --arrangement another: give one of them")
            return _from_model(file, source, overwrite)
        texts = {
            file: starting_scene(arrangement),
            file.with_name(SCHEMA_FILE): drivetrain_schema(),
        }
        write_all(texts, overwrite)
        if wants_json():
            write_json({"file": str(file), "title": ARRANGEMENTS[arrangement].title})
            return PASSED
        write(sys.stdout, f"{file}: {ARRANGEMENTS[arrangement].title}\n{_next(file)}")
        return PASSED

    raise typer.Exit(guarded(work, "existing files are unchanged"))


def _listed() -> int:
    """Print the arrangements."""
    from fe_drivetrain.drivetrain_file.arrangements import ARRANGEMENTS

    if wants_json():
        write_json({name: found.title for name, found in ARRANGEMENTS.items()})
        return PASSED
    width = max(map(len, ARRANGEMENTS))
    lines = [f"{name:<{width}}  {found.title}\n" for name, found in ARRANGEMENTS.items()]
    write(sys.stdout, "".join(lines))
    return PASSED


def _bearings(file: Path, overwrite: bool) -> int:
    """Write a file of bearings, and its schema beside it."""
    from fe_drivetrain.bearing.bearing_file import SCHEMA_FILE, bearing_schema, starting_bearings

    write_all({file: starting_bearings(), file.with_name(SCHEMA_FILE): bearing_schema()}, overwrite)
    title = "bearings by what a catalogue's page prints"
    if wants_json():
        write_json({"file": str(file), "title": title})
        return PASSED
    use = f"fe-drivetrain life SCENE --loads FILES --catalogue {shlex.quote(str(file))}"
    write(sys.stdout, f"{file}: {title}\nEdit it, then: {use} --bearing NAME=ENTRY\n")
    return PASSED


def _next(file: Path) -> str:
    return f"Edit it, then: fe-drivetrain check {shlex.quote(str(file))}\n"


def _from_model(file: Path, source: Path, overwrite: bool) -> int:
    """Write the drivetrain of a gearbox model, and say what it lacks and what is left over."""
    from fe_drivetrain.drivetrain_file.arrangements import SCHEMA_FILE, drivetrain_schema
    from fe_drivetrain.export.formats.rexs_reading import read_gear_unit

    unit = read_gear_unit(source)
    texts = {file: unit.text, file.with_name(SCHEMA_FILE): drivetrain_schema()}
    write_all(texts, overwrite)
    if wants_json():
        write_json(
            {
                "file": str(file),
                "title": unit.drivetrain.title,
                "source": f"{source}: {unit.origin}",
                "chain": unit.chain,
                "missing": [one._asdict() for one in unit.missing],
                "assumed": list(unit.assumed),
                "refused": list(unit.refused),
                "not_used": list(unit.not_used),
            }
        )
        return PASSED
    lists = {
        "Not in the model, to be filled in": [
            f"{one.key}: {one.example}  (for {one.commands})" for one in unit.missing
        ],
        "Refused as soon as that is there": unit.refused,
        "Assumed": unit.assumed,
        "In the model and not used": unit.not_used,
    }
    said = [f"{file}: {unit.drivetrain.title}, from {unit.origin}", f"  {unit.chain}"]
    for head, lines in lists.items():
        said += [f"{head}:", *(f"  {line}" for line in lines)] if lines else []
    write(sys.stdout, "\n".join(said) + "\n" + _next(file))
    return PASSED


def write_all(texts: dict[Path, str], overwrite: bool) -> None:
    """Write files; those of the same content stay, others only go with leave to overwrite.

    Parameters
    ----------
    texts : dict
        Content by path.
    overwrite : bool
        The leave.

    Raises
    ------
    InputError
        A file is there, or its folder is not.
    """
    from fe_drivetrain.common.files import atomic_path, check_writable

    changed = {
        path: text
        for path, text in texts.items()
        if not (path.is_file() and path.read_bytes() == text.encode("utf-8"))
    }
    for path in changed:
        if not path.parent.is_dir():
            raise InputError(f"cannot write {path}: there is no folder {path.parent}: create it")
        check_writable(path)
        if path.exists() and not overwrite:
            raise InputError(f"{path} exists: give another file, or add --overwrite")
    for path, text in changed.items():
        with atomic_path(path) as temporary:
            temporary.write_text(text, "utf-8")
