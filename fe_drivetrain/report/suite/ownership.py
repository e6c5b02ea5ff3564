"""Whose a folder is: of an earlier run, which may be replaced, or of somebody else."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from pathlib import Path

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.folders import is_hidden
from fe_drivetrain.common.manifest import (
    MANIFEST,
    Manifest,
    is_plain_file,
    listed_file,
    read_manifest,
)


def own_files(folder: Path) -> Manifest | None:
    """What an earlier run of a case wrote into a folder; None where it was no such run.

    Parameters
    ----------
    folder : Path
        With a manifest; or of a version that wrote none: then it is known by its results.json, and
        its own are that, its page, its history, and the pictures that the page shows.

    Raises
    ------
    InputError
        As in `fe_drivetrain.common.manifest.read_manifest`.
    """
    manifest = read_manifest(folder)
    if manifest is not None:
        return manifest if manifest.kind == "results" else None
    names = list(_named_by_results(folder))
    files = {name: listed_file(folder / name) for name in names if is_plain_file(folder / name)}
    return Manifest("results", files) if names else None


def _named_by_results(folder: Path) -> Iterator[str]:
    """Files of a folder without manifest that are known to be of a run; none if it was none."""
    from fe_drivetrain.report.history import FILE
    from fe_drivetrain.report.results import Image, Solid, read_results

    if not is_plain_file(folder / "results.json"):
        return
    try:
        results = read_results(folder / "results.json")
    except (OSError, ValueError):
        return
    yield from ("results.json", "report.html", FILE)
    for section in results.sections:
        for item in section.items:
            if isinstance(item, Image | Solid) and Path(item.file).name == item.file:
                yield item.file


def check_result_folder(out: Path) -> None:
    """Refuse a folder into which no results may go, before any work.

    Parameters
    ----------
    out : Path
        The result folder of one case. It must not exist, be empty, or be of an earlier run.

    Raises
    ------
    InputError
        It is something else.
    """
    try:
        before = out.stat()
        names = _names_in(out, before)
    except FileNotFoundError:
        return  # new; or replaced this moment by another run
    except OSError as error:
        raise not_writable(out, error) from error
    if not names or own_files(out) is not None:
        return
    try:
        replaced = not os.path.samestat(before, out.stat())
    except FileNotFoundError:
        return
    if replaced:  # meanwhile, by another run
        check_result_folder(out)
        return
    if read_manifest(out) is not None:
        raise InputError(
            f"--out {out} is the folder above the results of several cases: give one below it"
        )
    raise InputError(
        f"--out {out} holds files that are not results of an earlier run ({_some(names)}), and "
        "stays as it is: give a new or empty folder"
    )


def _names_in(out: Path, status: os.stat_result) -> list[str]:
    if not stat.S_ISDIR(status.st_mode):
        raise InputError(f"--out {out} is a file: give a folder")
    if os.path.ismount(out):
        raise InputError(
            f"--out {out} is where a disk is mounted, and cannot be replaced: give a folder in it"
        )
    return sorted(os.listdir(out))


def _some(names: list[str]) -> str:
    return ", ".join(names[:3]) + (", ..." if len(names) > 3 else "")


def claim_reports(folder: Path) -> bool:
    """Make a folder one above the results of several cases, if it is new, empty, or one already.

    Parameters
    ----------
    folder : Path
        Where their pages and their history stand.

    Returns
    -------
    bool
        Whether it is one now; if not, nothing in it was touched.

    Raises
    ------
    InputError
        It cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        names = os.listdir(folder)
    except OSError as error:
        raise not_writable(folder, error) from error
    try:
        manifest = read_manifest(folder)
    except InputError:
        return False
    if manifest is not None:
        return manifest.kind == "reports"
    if any(not is_hidden(name) for name in names) and not _has_results(folder):
        return False
    with atomic_path(folder / MANIFEST) as unfinished:
        unfinished.write_text(Manifest("reports").text(), encoding="utf-8")
    return True


def require_reports(folder: Path) -> None:
    """Refuse a folder that is no place for the results of several cases; see `claim_reports`.

    Raises
    ------
    InputError
        It holds something else, or cannot be written.
    """
    if not claim_reports(folder):
        names = sorted(os.listdir(folder))
        raise InputError(
            f"--out {folder} holds files that are not results of earlier runs "
            f"({_some(names)}), and stays as it is: give a new or empty folder"
        )


def _has_results(folder: Path) -> bool:
    """Whether there are results of a case, in a folder or below one, as versions before wrote."""
    files = (file for pattern in ("*", "*/*") for file in folder.glob(f"{pattern}/results.json"))
    try:
        return any(own_files(file.parent) is not None for file in files)
    except (InputError, OSError):
        return False


def not_writable(where: Path, error: OSError) -> InputError:
    """What to tell the user of a folder that cannot be written."""
    return InputError(
        f"cannot write to {where}: {error.strerror}: give a writable folder with --out"
    )
