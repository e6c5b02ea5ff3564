"""Atomic files, scratch folders, and clean-up of interrupted ones.

What is being written stands beside its target under a hidden name, and its writer holds a lock on
it. The system lets go of the lock when the writer ends, however it ends: so what is not locked was
abandoned, by a kill or a power cut, and the next writer of the same thing removes it.
"""

import errno
import os
import re
import shutil
import stat
import sys
import tempfile
import uuid
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from fe_drivetrain.common.errors import InputError

if sys.platform == "win32":
    fcntl = None
else:
    import fcntl

TRIES = 100
"""To hold something new before another takes it for abandoned."""

_SCRATCH = "fe-drivetrain-scratch-"  # whoever has this name has it from here

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


_NO_FILES = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
    (stat.S_ISFIFO, "a named pipe"),
    (stat.S_ISSOCK, "a socket"),
)


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


class UnwritableError(InputError, OSError):
    """A file that cannot be written: the user's to fix, unless the program goes on without it."""

    def __init__(self, message: str, strerror: str | None) -> None:
        super().__init__(message)
        self.strerror = strerror


def file_to_write(target: Path) -> Path:
    """The file that a path leads to, through links, if a file may be written there.

    Parameters
    ----------
    target : Path
        A regular file, or nothing yet.

    Raises
    ------
    InputError
        There is something else: a folder, a device, a pipe, a socket.
    """
    try:
        file = target.resolve()
        mode = file.stat().st_mode
    except FileNotFoundError:
        return file
    except (OSError, RuntimeError) as error:  # a loop of links is the latter before Python 3.13
        raise _unwritable(target, error) from error
    if not stat.S_ISREG(mode):
        what = next((word for is_it, word in _NO_FILES if is_it(mode)), "no regular file")
        raise UnwritableError(f"{target} is {what}: name a file, existing or new", what)
    return file


def check_writable(target: Path) -> None:
    """Refuse a file that cannot be written, before any work.

    Raises
    ------
    InputError
        The same as for `atomic_path`.
    """
    file = file_to_write(target)
    try:
        with tempfile.TemporaryFile(dir=file.parent):
            pass
    except OSError as error:
        raise _unwritable(target, error) from error


@contextmanager
def atomic_path(target: Path) -> Iterator[Path]:
    """Hand out a temporary path beside ``target`` and put it in place only if all went well.

    A link to a file stays; the file that it leads to is replaced, and keeps its mode.

    Raises
    ------
    InputError
        The target is no regular file, or its folder is not there or cannot be written.
    """
    file = file_to_write(target)
    remove_abandoned(file.parent, rf"\.{re.escape(file.name)}\.[0-9a-f]{{32}}\.tmp")
    try:
        temporary, lock = _held_file(file)
    except OSError as error:
        raise _unwritable(target, error) from error
    try:
        yield temporary
        if file_to_write(file).exists():
            with suppress(OSError):
                shutil.copymode(file, temporary)
        os.replace(temporary, file)
    except OSError as error:
        if file.parent.is_dir() or isinstance(error, InputError):
            raise
        raise _unwritable(target, error) from error  # removed meanwhile
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        let_go(lock)


@contextmanager
def atomic_paths(targets: Sequence[Path]) -> Iterator[list[Path]]:
    """`atomic_path` of several files: they are put in place only if all went well."""
    with ExitStack() as stack:
        yield [stack.enter_context(atomic_path(target)) for target in targets]


def _held_file(file: Path) -> tuple[Path, int | None]:
    """An empty file beside another, and the lock on it."""
    for _ in range(TRIES):
        temporary = file.with_name(f".{file.name}.{uuid.uuid4().hex}.tmp")
        temporary.touch(exist_ok=False)
        lock = hold(temporary)
        if lock is not None:
            break
    return temporary, lock


def _unwritable(target: Path, error: OSError | RuntimeError) -> UnwritableError:
    why = getattr(error, "strerror", None) or str(error)
    return UnwritableError(
        f"cannot write {target}: {why}: name a file in a folder that is there and can be written",
        why,
    )


@contextmanager
def scratch_folder(parent: Path | None = None) -> Iterator[Path]:
    """A folder for a while; what killed runs have left of theirs goes first.

    Parameters
    ----------
    parent : Path, optional
        Where; the system's folder for temporary files where left out.
    """
    with ExitStack() as stack:
        path, end = lasting_scratch_folder(parent)
        stack.callback(end)
        yield path


def lasting_scratch_folder(parent: Path | None = None) -> tuple[Path, Callable[[], None]]:
    """A scratch folder as of `scratch_folder`, with the function that ends it."""
    where = Path(tempfile.gettempdir()) if parent is None else parent
    remove_abandoned(where, rf"{re.escape(_SCRATCH)}[a-z0-9_]{{8}}")
    for _ in range(TRIES):
        path = Path(tempfile.mkdtemp(prefix=_SCRATCH, dir=where))
        lock = hold(path)
        if lock is not None:
            break

    def end() -> None:
        shutil.rmtree(path, ignore_errors=True)
        let_go(lock)

    return path, end


def remove_abandoned(folder: Path, pattern: str) -> None:
    """Remove files and folders of such names that no writer holds.

    Nothing here is an error: what cannot be looked at or removed stays.
    """
    for path in abandoned(folder, pattern):
        with suppress(OSError):
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink()


def abandoned(folder: Path, pattern: str) -> Iterator[Path]:
    """Files and folders of such names that no writer holds, each held while it is looked at."""
    if fcntl is None:
        return
    with suppress(OSError):
        for name in sorted(filter(re.compile(pattern).fullmatch, os.listdir(folder))):
            with suppress(OSError):
                lock = os.open(folder / name, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
                try:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    yield folder / name
                finally:
                    os.close(lock)


def hold(path: Path) -> int | None:
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


def let_go(lock: int | None) -> None:
    """Release what `hold` locked."""
    if lock is not None and lock >= 0:
        os.close(lock)
