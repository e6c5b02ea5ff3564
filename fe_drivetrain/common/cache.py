"""Expensive results, cached on disk under a hash of their inputs.

One mechanism for meshes, made hub loads, solutions, and figures of long studies. They are kept in
the user's cache folder, which may be deleted at any time; the environment variable
``FE_DRIVETRAIN_CACHE`` names another folder, or switches keeping off ("off"). A kept file holds its
whole key and digests of all that is in it, which are compared when it is read (`kept_files`).
Nothing here ever fails a run: what cannot be read, is damaged, or is of something else is made
again, which the logger of this module says, and what cannot be written is not kept.
Processes that want the same solution at the same time make it once (`Cache.one_at_a_time`).
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args

from numpy.typing import NDArray

from fe_drivetrain.common.array_records import as_arrays, from_arrays
from fe_drivetrain.common.files import atomic_path, hold, let_go, remove_abandoned
from fe_drivetrain.common.kept_files import SUFFIX, UnfitError, read_kept, write_kept

CACHE_VARIABLE = "FE_DRIVETRAIN_CACHE"
"""Environment variable: a folder to keep things in, or "off"."""

LIMIT = 2 * 1024**3
"""Bytes; beyond it, what was used longest ago is dropped."""

Kind = Literal[
    "figures",
    "gear-spectra",
    "hub-loads",
    "life-digests",
    "load-digests",
    "meshes",
    "shaft-strength",
    "solutions",
]
"""What may be kept; each kind has a folder of its own."""

_OFF = ("off", "0", "no", "false")
# Only names of our own making are ever deleted: the user may have named any folder.
# Those of earlier versions of this program, which end in .npz, are dropped as they grow old.
_OURS = re.compile(r"[0-9a-f]{32,64}\.(arrays|npz)")
_UNFINISHED = r"\.[0-9a-f]{32,64}\.((arrays|npz)\.[0-9a-f]{32}\.tmp|lock)"

_log = logging.getLogger(__name__)

_T = TypeVar("_T")


@dataclass(frozen=True)
class Cache:
    """Arrays on disk, each set under a hash of what it was made from.

    Attributes
    ----------
    folder : Path or None
        Where they are kept, in one folder a kind; None keeps nothing.
    limit : int
        Most bytes of all that is kept.
    """

    folder: Path | None
    limit: int = LIMIT

    def has(self, kind: Kind, content: Mapping[str, Any]) -> bool:
        """Whether something is kept for this content, sound or not."""
        file = self._file(kind, content)
        return file is not None and file.is_file()

    def load(self, kind: Kind, content: Mapping[str, Any]) -> dict[str, NDArray[Any]] | None:
        """What is kept for this content, or None where there is nothing sound.

        Parameters
        ----------
        kind : Kind
            What it is.
        content : Mapping[str, Any]
            All that it depends on, as plain data that JSON can hold.
        """
        file = self._file(kind, content)
        if file is None:
            return None
        try:
            arrays = read_kept(file, kind, _text(content))
        except FileNotFoundError:
            return None
        except (OSError, UnfitError) as error:
            _say_made_again(kind, file, error)
            return None
        with suppress(OSError):
            os.utime(file)  # used now: dropped last
        return arrays

    def keep(
        self, kind: Kind, content: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]
    ) -> None:
        """Keep arrays for this content; a full or read-only disk keeps nothing."""
        file = self._file(kind, content)
        if file is None:
            return
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            remove_abandoned(file.parent, _UNFINISHED)
            with atomic_path(file) as temporary, temporary.open("wb") as stream:
                write_kept(stream, kind, _text(content), arrays)
            self._drop_oldest()
        except OSError:
            return

    @contextmanager
    def one_at_a_time(self, kind: Kind, content: Mapping[str, Any]) -> Iterator[None]:
        """Let no other process in here for the same content: who waits finds what was kept.

        A process that dies lets go. On a disk that knows no locks none is waited for.

        Parameters
        ----------
        kind : Kind
            What it is.
        content : Mapping[str, Any]
            All that it depends on.
        """
        file, lock = self._file(kind, content), None
        if file is not None:
            place = file.with_name(f".{file.stem}.lock")
            with suppress(OSError):
                place.parent.mkdir(parents=True, exist_ok=True)
                while lock is None:
                    place.touch(0o600)
                    lock = hold(place)
        try:
            yield
        finally:
            if lock is not None:
                place.unlink(missing_ok=True)
                let_go(lock)

    def load_record(self, kind: Kind, content: Mapping[str, Any], form: type[_T]) -> _T | None:
        """The dataclass that is kept for this content, or None where there is nothing sound.

        Parameters
        ----------
        kind : Kind
            What it is.
        content : Mapping[str, Any]
            All that it depends on, as plain data that JSON can hold.
        form : type
            The dataclass: what is kept in another form is made again.
        """
        arrays = self.load(kind, content)
        if arrays is None:
            return None
        try:
            return from_arrays(form, arrays)
        except UnfitError as error:
            file = self._file(kind, content)
            assert file is not None
            _say_made_again(kind, file, error)
            return None

    def keep_record(self, kind: Kind, content: Mapping[str, Any], record: Any) -> None:
        """Keep a dataclass for this content, as arrays; see `keep`."""
        self.keep(kind, content, as_arrays(record))

    def _file(self, kind: Kind, content: Mapping[str, Any]) -> Path | None:
        if self.folder is None:
            return None
        return self.folder / kind / f"{key(content)}{SUFFIX}"

    def _drop_oldest(self) -> None:
        """Delete what was used longest ago until the rest is within the limit."""
        entries = []
        for folder in (self.folder / kind for kind in get_args(Kind) if self.folder is not None):
            if not folder.is_dir():
                continue
            with os.scandir(folder) as found:
                for entry in found:
                    if _OURS.fullmatch(entry.name) and entry.is_file(follow_symlinks=False):
                        status = entry.stat(follow_symlinks=False)
                        entries.append((status.st_mtime_ns, status.st_size, entry.path))
        total = sum(size for _, size, _ in entries)
        for _, size, path in sorted(entries):
            if total <= self.limit:
                break
            Path(path).unlink(missing_ok=True)
            total -= size


def _say_made_again(kind: Kind, file: Path, reason: Exception) -> None:
    _log.info("kept %s are made again: %s of %s: %s", kind, file.name, file.parent, reason)


def key(content: Mapping[str, Any]) -> str:
    """SHA-256 of plain data, the same whatever the order of its keys; floats by all their digits.

    Raises
    ------
    TypeError
        JSON cannot hold the content.
    """
    return hashlib.sha256(_text(content).encode()).hexdigest()


def _text(content: Mapping[str, Any]) -> str:
    return json.dumps(content, sort_keys=True, ensure_ascii=True, separators=(",", ":"))


def user_cache() -> Cache:
    """The user's cache, as `CACHE_VARIABLE` says; where it is unset, in the system's place.

    Read again each time, so that a run can switch it off for itself and for its processes.
    """
    named = os.environ.get(CACHE_VARIABLE, "")
    if named.strip().lower() in _OFF:
        return Cache(None)
    if named:
        return Cache(Path(named).expanduser())
    from platformdirs import user_cache_path

    return Cache(user_cache_path("fe-drivetrain"))


@contextmanager
def switched_off() -> Iterator[None]:
    """Keep and take nothing in here, nor in processes started in here: for what measures time."""
    before = os.environ.get(CACHE_VARIABLE)
    os.environ[CACHE_VARIABLE] = _OFF[0]
    try:
        yield
    finally:
        if before is None:
            del os.environ[CACHE_VARIABLE]
        else:
            os.environ[CACHE_VARIABLE] = before
