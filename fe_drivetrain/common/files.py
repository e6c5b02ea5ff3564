"""Atomic files and folders, and clean-up of interrupted ones.

What is being written stands beside its target under a hidden name, and its writer holds a lock on
it. The system lets go of the lock when the writer ends, however it ends: so what is not locked was
abandoned, by a kill or a power cut, and the next writer of the same thing removes it.
"""

import ctypes
import errno
import os
import re
import shutil
import sys
import tempfile
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from glob import escape
from pathlib import Path

if sys.platform == "win32":
    fcntl = None
else:
    import fcntl

# Whoever has these in the name of a hidden folder has it from here: others are never removed.
_NEW, _OLD = "unfinished", "replaced"
_TRIES = 100  # to hold something new before another takes it for abandoned
_EXCHANGE = 2  # RENAME_EXCHANGE, linux/fs.h
_HERE = -100  # AT_FDCWD, linux/fcntl.h

# what a user can fix about a folder or a disk; any other OSError is ours
_USERS_ERRORS = {
    errno.EACCES,
    errno.EDQUOT,
    errno.EFBIG,
    errno.ENAMETOOLONG,
    errno.ENOSPC,
    errno.ENOTDIR,
    errno.EPERM,
    errno.EROFS,
}


def sentence_about(error: OSError) -> str | None:
    """What to tell the user, where the user can fix it."""
    if "cannot open shared object file" in str(error):
        return (
            f"a system library is missing ({error}): install it, on Debian and Ubuntu with the "
            "packages libglu1-mesa, libxcursor1, libxft2, libxinerama1 and libxrender1"
        )
    if error.errno in _USERS_ERRORS:
        where = f" {error.filename}" if error.filename else ""
        return f"cannot write{where}: {error.strerror}: give a writable folder with --out"
    return None


@contextmanager
def atomic_path(target: Path) -> Iterator[Path]:
    """Hand out a temporary path beside ``target`` and put it in place only if all went well."""
    remove_abandoned(target.parent, rf"\.{re.escape(target.name)}\.[0-9a-f]{{32}}\.tmp")
    for _ in range(_TRIES):
        temporary = target.with_name(f".{target.name}.{uuid.uuid4().hex}.tmp")
        temporary.touch(exist_ok=False)
        lock = _hold(temporary)
        if lock is not None:
            break
    try:
        yield temporary
        os.replace(temporary, target)
    finally:
        temporary.unlink(missing_ok=True)
        _let_go(lock)


class HiddenFolder:
    """A folder beside its target, to be filled and then put in the target's place.

    Attributes
    ----------
    path
        Where it is.
    """

    def __init__(self, target: Path) -> None:
        """Make one beside a target, and remove what earlier ones left there.

        Raises
        ------
        OSError
            There it cannot be made.
        """
        self._target = target
        target.parent.mkdir(parents=True, exist_ok=True)
        _put_back(target)
        name = re.escape(target.name)
        remove_abandoned(target.parent, rf"\.{name}-({_NEW}|{_OLD})-[a-z0-9_]{{8}}")
        for _ in range(_TRIES):
            self.path = Path(_beside(target, _NEW))
            self._lock = _hold(self.path)
            if self._lock is not None:
                break

    def put_in_place(self) -> None:
        """Put it in the place of the target; at no moment is there neither, nor half of one.

        Raises
        ------
        OSError
            The target cannot be written; it is as it was.
        """
        self.path.chmod(0o755)
        for attempt in range(_TRIES):
            try:
                if not self._target.exists():
                    os.rename(self.path, self._target)
                elif not _exchange(self.path, self._target):
                    self._replace()
                return
            except OSError as error:
                # another run has put its own there, or has just taken it away
                meanwhile = (errno.ENOTEMPTY, errno.EEXIST, errno.ENOENT)
                if error.errno not in meanwhile or attempt == _TRIES - 1:
                    raise

    def _replace(self) -> None:
        """Where the system cannot exchange two folders in one go."""
        old = Path(_beside(self._target, _OLD))
        lock = _hold(old)
        try:
            os.rename(self._target, old / "results")
            os.rename(self.path, self._target)
        finally:
            # whatever went wrong, Ctrl-C between the two included
            if not self._target.exists() and (old / "results").exists():
                os.rename(old / "results", self._target)
            shutil.rmtree(old, ignore_errors=True)
            _let_go(lock)

    def discard(self) -> None:
        """Remove it, or what it has replaced."""
        shutil.rmtree(self.path, ignore_errors=True)
        _let_go(self._lock)
        self._lock = None


def empty(folder: Path) -> None:
    """Remove all that is in a folder."""
    for entry in folder.iterdir():
        if entry.is_dir() and not entry.is_symlink():
            shutil.rmtree(entry)
        else:
            entry.unlink()


def remove_abandoned(folder: Path, pattern: str) -> None:
    """Remove files and folders of such names that no writer holds.

    Nothing here is an error: what cannot be looked at or removed stays.
    """
    if fcntl is None:
        return
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if not re.fullmatch(pattern, entry.name):
                continue
            with suppress(OSError):
                lock = os.open(entry.path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
                try:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    if entry.is_dir(follow_symlinks=False):
                        shutil.rmtree(entry.path, ignore_errors=True)
                    else:
                        os.unlink(entry.path)
                finally:
                    os.close(lock)


def _beside(target: Path, what: str) -> str:
    return tempfile.mkdtemp(prefix=f".{target.name}-{what}-", dir=target.parent)


def _put_back(target: Path) -> None:
    """After a kill between the two renames of `HiddenFolder._replace`."""
    for old in sorted(target.parent.glob(f".{escape(target.name)}-{_OLD}-*/results")):
        if not target.exists():
            with suppress(OSError):
                os.rename(old, target)


def _hold(path: Path) -> int | None:
    """Lock what was just made; None where another has taken it for abandoned meanwhile.

    Where nothing can be locked, nothing is ever taken for abandoned: then -1.
    """
    if fcntl is None:
        return -1
    try:
        lock = os.open(path, os.O_RDONLY)
    except FileNotFoundError:
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
    except OSError:
        os.close(lock)
        return -1
    try:
        if os.path.samestat(os.stat(path), os.fstat(lock)):
            return lock
    except FileNotFoundError:
        pass
    os.close(lock)
    return None


def _let_go(lock: int | None) -> None:
    if lock is not None and lock >= 0:
        os.close(lock)


def _exchange(first: Path, second: Path) -> bool:
    """Exchange two paths in one go; False where the system or the disk cannot.

    renameat2 of Linux, man 2 rename.
    """
    if sys.platform != "linux":
        return False
    try:
        rename = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError):  # not in every C library
        return False
    paths = [os.fsencode(path) for path in (first, second)]
    return bool(rename(_HERE, paths[0], _HERE, paths[1], _EXCHANGE) == 0)
