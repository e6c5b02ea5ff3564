"""Pages that say themselves that this program wrote them: a later run replaces these alone.

They stand in a folder that several runs write at the same time and that is never exchanged whole,
so each has the hash of its text in its last line. What has no such line, or was changed since, is
kept under another name.
"""

from __future__ import annotations

import hashlib
import re
import warnings
from collections.abc import Callable
from pathlib import Path

from fe_drivetrain.common.carrying import keep_aside
from fe_drivetrain.common.files import atomic_path, file_to_write

_SEAL = re.compile(r"<!-- fe-drivetrain, SHA-256 of all above: ([0-9a-f]{64}) -->\n")


def write_sealed(page: Path, text: str) -> None:
    """Write a page; it appears whole or not at all.

    Parameters
    ----------
    page : Path
        The file. What is there and was not written here is kept, with another name.
    text : str
        HTML.
    """
    clear_of_others(page, is_sealed)
    digest = hashlib.sha256(f"{text}\n".encode()).hexdigest()
    with atomic_path(page) as unfinished:
        sealed = f"{text}\n<!-- fe-drivetrain, SHA-256 of all above: {digest} -->\n"
        unfinished.write_text(sealed, encoding="utf-8", newline="\n")


def remove_sealed(page: Path) -> None:
    """Remove a page that was written here and not changed since; any other stays."""
    if is_sealed(page):
        page.unlink(missing_ok=True)


def is_sealed(page: Path) -> bool:
    """Whether a page was written here, and not changed since."""
    try:
        text = page.read_bytes().decode("utf-8") if page.is_file() else ""
    except (OSError, ValueError):
        return False
    seal = _SEAL.search(text, max(0, len(text) - 200))
    if seal is None or seal.end() != len(text):
        return False
    return seal.group(1) == hashlib.sha256(text[: seal.start()].encode()).hexdigest()


def clear_of_others(file: Path, is_ours: Callable[[Path], bool]) -> None:
    """Give a file of others that is in the way another name, and say so.

    Parameters
    ----------
    file : Path
        Where something is to be written.
    is_ours : callable
        Whether what is there was written by this program.

    Raises
    ------
    InputError
        It is no regular file.
    """
    if not file_to_write(file).exists() or is_ours(file):
        return
    kept = keep_aside(file)
    if kept is not None:
        warnings.warn(
            f"{file} was not written by this program, or was changed since: it is kept as "
            f"{kept.name}",
            stacklevel=3,
        )
