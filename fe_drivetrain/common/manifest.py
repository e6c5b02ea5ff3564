"""The manifest of a folder: which files in it a run of this program wrote, and with what content.

What it does not list, or lists with another content, belongs to somebody else and is never removed.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import stat
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.plain_json import plain_json

MANIFEST = "fe-drivetrain-files.json"
"""Its name, in the folder."""

Kind = Literal["results", "reports"]
"""The results of one case, or the folder above those of several."""

_SCHEMA, _VERSION = "fe-drivetrain folder", 1
_MAXIMUM = 50_000_000  # bytes; of a manifest of ours some hundred a file
_PIECE = 1 << 20


class Listed(NamedTuple):
    """A file as it was written: its size, and the SHA-256 of its content."""

    bytes: int
    sha256: str


@dataclass(frozen=True)
class Manifest:
    """What a run wrote into a folder.

    Attributes
    ----------
    kind : Kind
        What the folder is for.
    files : mapping
        By path below the folder, with "/" between its parts.
    folders : frozenset of str
        Paths of the folders below that the run made.
    """

    kind: Kind
    files: Mapping[str, Listed] = field(default_factory=dict)
    folders: frozenset[str] = frozenset()

    def has(self, name: str, file: Path) -> bool:
        """Whether a file is the one of that name, unchanged since it was written."""
        listed = self.files.get(name)
        if listed is None or not is_plain_file(file) or file.stat().st_size != listed.bytes:
            return False
        return listed_file(file) == listed

    def text(self) -> str:
        """It as JSON, for `read_manifest`."""
        files = {name: listed._asdict() for name, listed in self.files.items()}
        content = {"schema": _SCHEMA, "version": _VERSION, "kind": self.kind, "files": files}
        return json.dumps({**content, "folders": sorted(self.folders)}, indent=1)


def is_plain_file(path: Path) -> bool:
    """Whether it is a regular file, and no link to one."""
    return path.is_file() and not path.is_symlink()


def listed_file(file: Path) -> Listed:
    """Size and SHA-256 of a file as it is now."""
    digest, size = hashlib.sha256(), 0
    with file.open("rb") as stream:
        while piece := stream.read(_PIECE):
            digest.update(piece)
            size += len(piece)
    return Listed(size, digest.hexdigest())


def manifest_of(folder: Path, kind: Kind) -> Manifest:
    """The manifest of all that is in a folder now.

    Parameters
    ----------
    folder : Path
        With nothing in it but what the run wrote.
    kind : Kind
        What it is for.

    Raises
    ------
    OSError
        Some of it cannot be read: what is not listed would be taken for another program's.
    """
    files, folders = {}, set()
    for path in _below(folder):
        name, mode = path.relative_to(folder).as_posix(), path.lstat().st_mode
        if stat.S_ISREG(mode) and name != MANIFEST:
            files[name] = listed_file(path)
        elif stat.S_ISDIR(mode):
            folders.add(name)
    return Manifest(kind, files, frozenset(folders))


def _below(folder: Path) -> list[Path]:
    """All that is below a folder; `Path.rglob` passes by what it cannot read, since Python 3.13."""

    def refuse(error: OSError) -> None:
        raise error

    walk = os.walk(folder, onerror=refuse)
    return sorted(Path(at, name) for at, inner, files in walk for name in (*inner, *files))


def read_manifest(folder: Path) -> Manifest | None:
    """The manifest of a folder; None where there is none.

    Raises
    ------
    InputError
        It is damaged, of another version, or names anything outside of the folder.
    """
    file = folder / MANIFEST
    try:
        if file.is_symlink() or file.stat().st_size > _MAXIMUM or not file.is_file():
            raise _damaged(file)
        content = plain_json(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise _damaged(file) from error
    found = _from_json(content)
    if found is None:
        raise _damaged(file)
    return found


def _from_json(content: Any) -> Manifest | None:
    """The manifest that such JSON is; None where it is none."""
    keys = {"schema", "version", "kind", "files", "folders"}
    if not isinstance(content, dict) or content.keys() != keys:
        return None
    kind, files, folders = (content[key] for key in ("kind", "files", "folders"))
    ours = content["schema"] == _SCHEMA and content["version"] == _VERSION
    if not ours or kind not in get_args(Kind):
        return None
    if not isinstance(files, dict) or not isinstance(folders, list):
        return None
    if not all(map(_is_inside, [*files, *folders])) or not all(map(_is_listed, files.values())):
        return None
    listed = {name: Listed(**entry) for name, entry in files.items()}
    return Manifest(kind, listed, frozenset(folders))


def _is_inside(name: object) -> bool:
    """Whether a name is a path below a folder, as this program writes it."""
    if not isinstance(name, str) or "\0" in name:
        return False
    return all(part not in ("", ".", "..") for part in name.split("/"))


def _is_listed(entry: object) -> bool:
    if not isinstance(entry, dict) or entry.keys() != {"bytes", "sha256"}:
        return False
    size, digest = entry["bytes"], entry["sha256"]
    return (
        type(size) is int and isinstance(digest, str) and bool(re.fullmatch("[0-9a-f]{64}", digest))
    )


def _damaged(file: Path) -> InputError:
    return InputError(
        f"{file} is damaged, or of another version of this program, so it does not say which files "
        "of the folder may be replaced: move the folder away, or give another"
    )
