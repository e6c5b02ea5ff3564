"""Folders that appear whole: filled under a hidden name, then put in the place of an older one.

Everything in the older folder goes over into the new one, except what its manifest lists as written
by the run that made it. At every moment, even after a kill, one whole folder is there, and no file
of others is missing.
"""

import ctypes
import errno
import os
import re
import shutil
import stat
import sys
import tempfile
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from fe_drivetrain.common.carrying import carry_over, remove_replaced, take_back
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import TRIES, abandoned, hold, let_go
from fe_drivetrain.common.manifest import MANIFEST, Manifest, manifest_of, read_manifest

# Whoever has these in the name of a hidden folder has it from here: others are never removed.
_NEW, _OLD = "unfinished", "replaced"
_HIDDEN = re.compile(rf"\..+(-({_NEW}|{_OLD})-[a-z0-9_]{{8}}|\.[0-9a-f]{{32}}\.tmp)")
_RESULTS = "results"  # in a folder of the second kind
_EXCHANGE = 2  # RENAME_EXCHANGE, linux/fs.h
_HERE = -100  # AT_FDCWD, linux/fcntl.h


def is_hidden(name: str) -> bool:
    """Whether a name is that of what this program has not finished or not put away yet."""
    return _HIDDEN.fullmatch(name) is not None


class HiddenFolder:
    """A folder beside its target, to be filled and then put in the target's place.

    Parameters
    ----------
    target : Path
        The folder whose place it takes.
    own : callable
        Returns what an earlier run wrote into a folder; None where nothing is known of it.

    Attributes
    ----------
    path
        Where it is.
    """

    def __init__(
        self, target: Path, own: Callable[[Path], Manifest | None] = read_manifest
    ) -> None:
        """Make one beside a target, and remove what earlier ones left there.

        Raises
        ------
        OSError
            There it cannot be made.
        """
        self._target = target.resolve()
        self._own = own
        self._target.parent.mkdir(parents=True, exist_ok=True)
        self._tidy()
        for _ in range(TRIES):
            self.path = Path(self._beside(_NEW))
            self._lock = hold(self.path)
            if self._lock is not None:
                break
        self._made = self.path.stat()

    def put_in_place(self) -> None:
        """Put it in the place of the target; at no moment is there neither, nor half of one.

        Raises
        ------
        OSError
            The target cannot be written; it is as it was.
        InputError
            What is in the target cannot go over into this one; it is as it was.
        """
        self.path.chmod(0o755)
        self._write_manifest(self.path, manifest_of(self.path, "results").text())
        for attempt in range(TRIES):
            try:
                if self._target.exists():
                    self._take_the_place()
                else:
                    os.rename(self.path, self._target)
                return
            except OSError as error:
                # another run has put its own there, or has just taken it away
                meanwhile = (errno.ENOTEMPTY, errno.EEXIST, errno.ENOENT)
                if error.errno not in meanwhile or attempt == TRIES - 1:
                    raise

    def discard(self) -> None:
        """Remove it, or what it has replaced."""
        if self._is_here():
            shutil.rmtree(self.path, ignore_errors=True)
        elif self.path.exists() and not _remove(self.path, self._target):
            warnings.warn(
                f"{self.path} holds what is left of the folder that {self._target} has replaced, "
                "and cannot be removed: take out what you need",
                stacklevel=2,
            )
        let_go(self._lock)
        self._lock = None

    def _take_the_place(self) -> None:
        """Exchange it for the target, after all that is of others has gone over."""
        before = self._target.stat()
        own = self._own(self._target) or Manifest("results")
        if not (self._target / MANIFEST).exists():
            # whoever tidies after a kill has to know what is whose
            self._write_manifest(self._target, own.text())
        made: list[Path] = []
        try:
            renamed = carry_over(self._target, self.path, own, made)
            if not os.path.samestat(before, self._target.stat()):
                raise FileNotFoundError(errno.ENOENT, "replaced meanwhile", str(self._target))
            self._like(before)
            if not _exchange(self.path, self._target):
                self._replace()
        except BaseException:
            if self._is_here():
                take_back(made)
            raise
        if renamed:
            warnings.warn(
                f"{self._target} held files that were changed since an earlier run, or are of "
                f"others, under names that this run writes: they are kept as {', '.join(renamed)}",
                stacklevel=2,
            )

    def _is_here(self) -> bool:
        """Whether it is under its hidden name still, and not what it has replaced."""
        return self.path.exists() and os.path.samestat(self.path.stat(), self._made)

    def _like(self, before: os.stat_result) -> None:
        """Give it the mode and the owner of the folder that it replaces."""
        self.path.chmod(stat.S_IMODE(before.st_mode))
        if hasattr(os, "chown"):
            with suppress(OSError):
                os.chown(self.path, before.st_uid, before.st_gid)

    def _write_manifest(self, folder: Path, text: str) -> None:
        unfinished = self.path / f"{MANIFEST}.new"
        unfinished.write_text(text, encoding="utf-8")
        os.replace(unfinished, folder / MANIFEST)

    def _replace(self) -> None:
        """Where the system cannot exchange two folders in one go."""
        old = Path(self._beside(_OLD))
        lock = hold(old)
        try:
            os.rename(self._target, old / _RESULTS)
            os.rename(self.path, self._target)
        finally:
            # whatever went wrong, Ctrl-C between the two included
            self._put_back_or_remove(old)
            let_go(lock)

    def _beside(self, what: str) -> str:
        return tempfile.mkdtemp(prefix=f".{self._target.name}-{what}-", dir=self._target.parent)

    def _tidy(self) -> None:
        """Put back or remove what kills have left."""
        name = re.escape(self._target.name)
        for old in abandoned(self._target.parent, rf"\.{name}-{_OLD}-[a-z0-9_]{{8}}"):
            self._put_back_or_remove(old)
        for new in abandoned(self._target.parent, rf"\.{name}-{_NEW}-[a-z0-9_]{{8}}"):
            _remove(new, self._target)

    def _put_back_or_remove(self, old: Path) -> None:
        """What `_replace` took away, which goes back if nothing has come into its place."""
        results = old / _RESULTS
        if results.exists() and not self._target.exists():
            with suppress(OSError):  # another run has put its own there this moment
                os.rename(results, self._target)
        if results.exists():
            _remove(results, self._target)
        with suppress(OSError):
            old.rmdir()


def _remove(folder: Path, target: Path) -> bool:
    """Remove a hidden folder, and nothing of others that its target does not have, too."""
    if folder.is_symlink() or not folder.is_dir():
        return True
    try:
        own = read_manifest(folder)
    except InputError:
        return False
    if own is not None and target.is_dir():
        return remove_replaced(folder, target, own)
    # one that was not finished, or whose target was removed: nothing of others is in it alone
    shutil.rmtree(folder, ignore_errors=True)
    return not folder.exists()


def empty(folder: Path) -> None:
    """Remove all that is in a folder."""
    for entry in folder.iterdir():
        if entry.is_dir() and not entry.is_symlink():
            shutil.rmtree(entry)
        else:
            entry.unlink()


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
