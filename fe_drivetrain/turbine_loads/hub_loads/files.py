"""Hub loads from one file or many, of any supported format."""

from __future__ import annotations

import glob
import os
import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path

from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.turbine_loads.hub_loads.channels import is_load_unit, without_unit
from fe_drivetrain.turbine_loads.hub_loads.csv_table import read_csv
from fe_drivetrain.turbine_loads.hub_loads.histories import (
    MIN_SAMPLES,
    UNITS,
    LoadHistory,
    require_variation,
)
from fe_drivetrain.turbine_loads.hub_loads.openfast import LOAD_CHANNELS, read_openfast
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import (
    OPENFAST,
    is_found,
    is_table,
    of_one_run,
    require_kind,
)

_USUAL = (*OPENFAST, ".csv")  # what is looked for in a folder first


def read_hub_loads(path: str | os.PathLike[str], skip: float = 0.0) -> LoadHistory:
    """Read a history, of .out or .outb (OpenFAST), or a table of a kind of `history_table`.

    Parameters
    ----------
    path : str or path-like
        The file.
    skip : float
        What is left out at the beginning of the file [s]: a start-up transient.

    Raises
    ------
    InputError
        If the file is missing, of another kind, or unsound, if its loads never vary, or if nothing
        is left of it.
    """
    file = Path(path)
    require_kind(file)
    history = read_csv(file) if is_table(file) else read_openfast(file)
    if skip:
        first, last = float(history.time[0]), float(history.time[-1])
        if (history.time >= first + skip).sum() < MIN_SAMPLES:
            raise InputError(
                f"hub loads '{file}': it lasts {last - first:g} s, so that nothing is left without "
                f"the first {skip:g} s: skip less"
            )
        history = history.between(first + skip)
    require_variation(f"hub loads '{file}'", history.loads)
    return history


def read_hub_load_files(
    patterns: str | Sequence[str],
    skip: float = 0.0,
    read: Callable[[Path, float], LoadHistory] = read_hub_loads,
) -> list[LoadHistory]:
    """Read all histories that patterns find, each with a name of its own.

    A history is named after its file; where files of several folders have one name, after its
    folders, too.

    Parameters
    ----------
    patterns : str or sequence of str
        See `hub_load_files`; a file that several find is read once.
    skip : float
        What is left out at the beginning of each file [s].
    read : callable
        Reads a file, given `skip`.

    Raises
    ------
    InputError
        As `files_of_patterns` does, or a file cannot be read.
    """
    files = files_of_patterns([patterns] if isinstance(patterns, str) else patterns)
    histories = [read(file, skip) for file in files]
    return [replace(h, name=n) for h, n in zip(histories, _names(files), strict=True)]


def files_of_patterns(patterns: Sequence[str]) -> list[Path]:
    """Files that several patterns find, each once, by whichever path or link.

    Parameters
    ----------
    patterns : sequence of str
        See `hub_load_files`.

    Raises
    ------
    InputError
        None is found, or two are the .out and the .outb of one run.
    """
    found = [file for pattern in patterns for file in hub_load_files(pattern)]
    files = list({file.resolve(): file for file in reversed(found)}.values())[::-1]
    _check_runs(files)
    return files


def hub_load_files(pattern: str) -> list[Path]:
    """Files with hub loads, in order.

    Parameters
    ----------
    pattern : str
        A file; a folder, for the .out, .outb and .csv files in it, or for histories of other
        kinds where it has none of these; or a pattern with ``*``, ``?``
        or ``[...]`` in any part, and ``**`` for folders of any depth.

    Raises
    ------
    InputError
        None is found, or two are the .out and the .outb of one run.
    """
    path = Path(pattern)
    if os.path.exists(path) or not glob.has_magic(pattern):
        found = [path]
    else:
        found = sorted(Path(name) for name in glob.glob(pattern, recursive=True))
    if found == [path] and not os.path.isdir(path):
        return [path]  # named by the user: read, or refused with its suffix
    files = [
        file
        for place in found
        for file in (_in_folder(place) if place.is_dir() else [place])
        if is_found(file)
    ]
    files = _usual(list(dict.fromkeys(files)))
    if not files:
        raise InputError(
            f"loads = {pattern!r}: no {', '.join(_USUAL)} file is there, nor a history of another "
            "kind"
        )
    _check_runs(files)
    return files


def _in_folder(folder: Path) -> list[Path]:
    """Histories in a folder; of Bladed the project, and not each of its groups."""
    return [file for file in sorted(folder.iterdir()) if ".%" not in file.suffix]


def _usual(files: Sequence[Path]) -> list[Path]:
    """Files of the usual kinds; those of others in folders that have none of these.

    The project of a run of Bladed stands for its groups.
    """
    with_usual = {file.parent for file in files if file.suffix.lower() in _USUAL}
    projects = {file.with_suffix("") for file in files if file.suffix.lower() == ".$pj"}
    groups = {f for f in files if ".%" in f.suffix and f.with_suffix("") in projects}
    others = {f for f in files if f.suffix.lower() not in _USUAL and f.parent in with_usual}
    return [file for file in files if file not in groups | others]


def _check_runs(files: Sequence[Path]) -> None:
    """Refuse both output files of one run: its loads would count twice."""
    runs: dict[Path, Path] = {}
    for file in files:
        if of_one_run(file):
            other = runs.setdefault(file.with_suffix("").resolve(), file)
            if other.resolve() != file.resolve():
                raise InputError(
                    f"loads: {other} and {file.name} are two files of one {_program(file)} "
                    "run, which would count twice: choose one kind, as in "
                    f"loads='{file.parent / ('*' + file.suffix)}'"
                )


def _program(file: Path) -> str:
    return "OpenFAST" if file.suffix.lower() in OPENFAST else "Bladed"


def require_points(histories: Sequence[LoadHistory], points: Sequence[str]) -> None:
    """Refuse histories with columns of loads at a point that a scene does not have.

    What is left of a table besides hub loads is looked through, too: a column that begins with the
    name of a load point and is a load by its unit or name, like ``brake_Fz [kN]`` or ``brake.Fq``,
    would be left out without a word. Others, like ``brake pressure [bar]``, are no loads.

    Parameters
    ----------
    histories : Sequence[LoadHistory]
        The histories.
    points : Sequence[str]
        Names of the scene's load points.

    Raises
    ------
    InputError
        There is none of that name.
    """
    known = f"{', '.join(points)}; components {', '.join(FORCES)}" if points else "it has none"
    for history in histories:
        for point, loads in history.at.items():
            if point in points:
                continue
            own = [f"{point}.{c}" for c, v in zip(FORCES, loads.T, strict=True) if v.any()]
            columns = f" ({', '.join(own)})" if own else ""
            close = get_close_matches(point.lower(), [name.lower() for name in points], n=1)
            meant = next((name for name in points if name.lower() in close), None)
            hint = f" as of '{meant}'" if meant else ""
            raise InputError(
                f"hub loads: {history.name} has columns of {shown(point)}{columns}, which is no "
                f"load point of the scene ({known}): rename the columns{hint}, or add it "
                "under load_points"
            )
        for title in history.unread:
            point, component = _meant(title, points)
            if point:
                raise InputError(
                    f"hub loads: {history.name} has the column {shown(title)}, which looks like a "
                    f"load at {point} and is not read (load points of the scene: {known}): write "
                    f"it like '{point}.{component} [{UNITS[FORCES.index(component)]}]', or rename "
                    "it"
                )


def _meant(title: str, points: Sequence[str]) -> tuple[str, str]:
    """The load point and component that a column that is not read seems to be of; "" if of none."""
    name = without_unit(title)
    if name.lower() in LOAD_CHANNELS:
        return "", ""
    for point in sorted(points, key=len, reverse=True):
        rest = name[len(point) :]
        if not name.lower().startswith(point.lower()) or rest[:1].islower():
            continue
        component = rest.lstrip("._- ").capitalize()
        if is_load_unit(title) or re.fullmatch(r"[FM]\w", component):
            return point, component if component in FORCES else "Fz"
    # brkae_Fz: a name that is nearly that of a load point, and a component
    parts = re.fullmatch(r"(.+?)[._\- ]*([FM][xyz])", name, re.IGNORECASE)
    lower = {point.lower(): point for point in points}
    close = get_close_matches(parts[1].lower(), lower, n=1, cutoff=0.75) if parts else []
    return (lower[close[0]], parts[2].capitalize()) if parts and close else ("", "")


def _names(files: Sequence[Path]) -> list[str]:
    """Names of histories that differ from each other, whether or not case counts."""
    names = [file.stem for file in files]
    if _differ(names):
        return names
    whole = [file.resolve() for file in files]
    above = Path(os.path.commonpath([file.parent for file in whole]))
    names = ["_".join(file.relative_to(above).with_suffix("").parts) for file in whole]
    if not _differ(names):  # of one folder, a.csv beside a.outb, or folders with underscores
        names = ["_".join(file.relative_to(above).parts).replace(".", "_") for file in whole]
    if not _differ(names):
        number = Counter(name.lower() for name in names)
        (twice, *_) = [name for name in names if number[name.lower()] > 1]
        raise InputError(
            f"hub loads: two files would both be called {twice!r} in tables and results: rename one"
        )
    return names


def _differ(names: Sequence[str]) -> bool:
    return len({name.lower() for name in names}) == len(names)
