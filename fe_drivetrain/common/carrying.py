"""Files of others in a folder that is about to be replaced: none of them is lost at any moment.

They are linked into the folder that takes its place before the two are exchanged, so that a kill at
any moment leaves them where they were; what was replaced is removed file by file afterwards, each
only if it is known to be of the earlier run or to be in the new folder, too.
"""

from __future__ import annotations

import filecmp
import os
import re
import shutil
import stat
import uuid
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import takewhile
from pathlib import Path

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.manifest import MANIFEST, Manifest

KEPT = ".kept"
"""What is added to the name of a file that another took the place of."""

_ENDING = re.compile(rf"(?<=.){re.escape(KEPT)}(-\d+)?$")
_UNFINISHED = re.compile(r"\.fe-drivetrain-[0-9a-f]{32}\.tmp")  # a copy, of this module alone


def carry_over(old: Path, new: Path, own: Manifest, made: list[Path]) -> list[str]:
    """Put all that is not the earlier run's own into a new folder, too.

    Files become hard links, or copies where the disk has no such links, folders are made again with
    their modes and times, links stay links. What was there already stays: then a file of the same
    name has `KEPT` added to its name.

    Parameters
    ----------
    old, new : Path
        The folder to be replaced, and what takes its place.
    own : Manifest
        What the earlier run wrote into the old one.
    made : list of Path
        Takes what is made in the new one, for `take_back`.

    Returns
    -------
    list of str
        Paths below the new folder of what has another name there.

    Raises
    ------
    InputError
        Another disk is mounted in the old folder.
    OSError
        Something in it can be neither linked nor copied.
    """
    _carry_below(old, new, own, "", made)
    return [
        path.relative_to(new).as_posix()
        for path in made
        if KEPT in path.name and not os.path.lexists(old / path.relative_to(new))
    ]


def take_back(made: Sequence[Path]) -> None:
    """Remove what `carry_over` made."""
    for path in filter(_is_folder, made):
        path.chmod(stat.S_IRWXU)
    for path in reversed(made):
        if _is_folder(path):
            path.rmdir()
        else:
            path.unlink(missing_ok=True)


def _carry_below(old: Path, new: Path, own: Manifest, below: str, made: list[Path]) -> None:
    """Carry over, as `carry_over`, for a folder whose path below the whole is given."""
    with os.scandir(old) as entries:
        found = sorted(entries, key=lambda entry: entry.name)
    for entry in found:
        path, name = Path(entry.path), f"{below}{entry.name}"
        if entry.is_dir(follow_symlinks=False):
            _carry_folder(path, _folder_like(new / entry.name), own, name, made)
        elif not _goes(path, name, new, own):
            target = _free(new / entry.name, old)
            _link_or_copy(path, target)
            made.append(target)


def _carry_folder(path: Path, target: Path, own: Manifest, name: str, made: list[Path]) -> None:
    if os.lstat(path).st_dev != os.lstat(path.parent).st_dev:
        raise InputError(
            f"{path} is on another disk, which is mounted there, so its folder cannot be replaced: "
            "give another folder for the results"
        )
    if is_new := not target.is_dir():
        target.mkdir()
        made.append(target)
    _carry_below(path, target, own, f"{name}/", made)
    if not is_new:
        return
    if name in own.folders and not any(target.iterdir()):
        target.rmdir()
        made.remove(target)
    else:
        shutil.copystat(path, target)
        _set_owner(path, target)


def _goes(path: Path, name: str, new: Path, own: Manifest) -> bool:
    """Whether nothing is lost with a file: the run wrote it, or it is in the new folder, too."""
    return name == MANIFEST or own.has(name, path) or _is_there(path, new / path.name)


def remove_replaced(old: Path, new: Path, own: Manifest) -> bool:
    """Remove a folder that another has replaced, and nothing of others with it.

    A file goes if the earlier run wrote it, or if the new folder has it, too; what somebody has put
    there meanwhile goes into the new folder.

    Parameters
    ----------
    old, new : Path
        The replaced folder, and the one in its place.
    own : Manifest
        What the earlier run wrote into the old one.

    Returns
    -------
    bool
        Whether all of it is gone.
    """
    with suppress(OSError):
        _remove_below(old, new, own, "")
        if os.listdir(old) == [MANIFEST]:  # last, for who goes on after a kill
            (old / MANIFEST).unlink()
        old.rmdir()
    return not old.exists()


def _remove_below(old: Path, new: Path, own: Manifest, below: str) -> None:
    old.chmod(stat.S_IMODE(old.stat().st_mode) | stat.S_IRWXU)
    for entry in list(os.scandir(old)):
        path, name = Path(entry.path), f"{below}{entry.name}"
        with suppress(OSError):  # what cannot be removed stays, hidden
            if entry.is_dir(follow_symlinks=False):
                target = _folder_like(new / entry.name)
                _remove_below(path, target, own, f"{name}/")
                if name not in own.folders:
                    target.mkdir(parents=True, exist_ok=True)
                path.rmdir()
            elif name == MANIFEST:
                continue
            elif _UNFINISHED.fullmatch(entry.name) or _goes(path, name, new, own):
                path.unlink()
            else:
                new.mkdir(parents=True, exist_ok=True)
                path.rename(_free(new / entry.name, old))


def keep_aside(file: Path) -> Path | None:
    """Add `KEPT` to the name of a file; its new path, or None where it has gone meanwhile."""
    kept = _free(file, file.parent)
    try:
        os.link(file, kept, follow_symlinks=False)
    except FileNotFoundError:
        return None
    except (OSError, NotImplementedError):
        file.rename(kept)
    else:
        file.unlink(missing_ok=True)
    return kept


def _is_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _is_there(path: Path, place: Path) -> bool:
    """Whether the same is at a place, or beside it with `KEPT` in its name, or without it."""
    first = place.with_name(_ENDING.sub("", place.name))
    there = takewhile(os.path.lexists, _candidates(first))
    return any(_is_same(path, one) for one in (*there, place) if os.path.lexists(one))


def _folder_like(place: Path) -> Path:
    """Where the content of a folder of that name goes: into one that is there, or a new one."""
    return next(p for p in _candidates(place) if _is_folder(p) or not os.path.lexists(p))


def _free(place: Path, old: Path) -> Path:
    """The place, or the first beside it, with `KEPT` in its name, that nothing has or will have."""
    if not os.path.lexists(place):
        return place
    names = (other.name for other in _candidates(place))
    taken = (place.parent, old)
    return place.with_name(
        next(n for n in names if not any(os.path.lexists(folder / n) for folder in taken))
    )


def _candidates(place: Path) -> Iterator[Path]:
    yield place
    yield place.with_name(f"{place.name}{KEPT}")
    number = 2
    while True:
        yield place.with_name(f"{place.name}{KEPT}-{number}")
        number += 1


def _is_same(one: Path, other: Path) -> bool:
    first, second = os.lstat(one), os.lstat(other)
    if os.path.samestat(first, second):
        return True
    kind = stat.S_IFMT(first.st_mode)
    if kind != stat.S_IFMT(second.st_mode):
        return False
    if kind == stat.S_IFLNK:
        return os.readlink(one) == os.readlink(other)
    if kind != stat.S_IFREG or first.st_size != second.st_size:
        return False
    return filecmp.cmp(one, other, shallow=False)


def _link_or_copy(path: Path, target: Path) -> None:
    try:
        os.link(path, target, follow_symlinks=False)
    except (OSError, NotImplementedError):  # no such links on this disk, or of files of others
        if not (path.is_symlink() or path.is_file()):
            raise
        unfinished = target.with_name(f".fe-drivetrain-{uuid.uuid4().hex}.tmp")
        try:
            shutil.copy2(path, unfinished, follow_symlinks=False)
            _set_owner(path, unfinished)
            unfinished.rename(target)
        finally:
            unfinished.unlink(missing_ok=True)


def _set_owner(path: Path, target: Path) -> None:
    status = os.lstat(path)
    if hasattr(os, "chown"):
        with suppress(OSError):  # root alone may give files away
            os.chown(target, status.st_uid, status.st_gid, follow_symlinks=False)
