"""What made a result, as plain data: code, packages, threads and machine, for the key of a cache.

Two results with the same inputs and the same maker are the same to the last digit.
"""

from __future__ import annotations

import hashlib
import platform
import re
from collections.abc import Iterator, Mapping, Sequence, Set
from functools import cache as once
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from fe_drivetrain.common.regular_files import opened

#: Which choose kernels by the processor. MKL is loaded by a solver, in the course of a process.
_CHOOSE = ("openblas", "blis")


def source_hash(rooms: Mapping[str, Set[str] | None]) -> str:
    """SHA-256 of the sources of packages.

    Parameters
    ----------
    rooms : mapping
        Modules by the name of their package, as in {"fe_drivetrain.elasticity.mesh": {"mesh.py"}};
        all of a package where None.

    Returns
    -------
    str
        64 hexadecimal digits.
    """
    code = hashlib.sha256()
    for package, names in rooms.items():
        for file in sorted(files(package).iterdir(), key=lambda file: file.name):
            if file.name.endswith(".py") and (names is None or file.name in names):
                code.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    return code.hexdigest()


@lru_cache(maxsize=256)
def _digest(path: str, *_state: int) -> str:
    with opened(path) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def file_digest(path: str) -> str:
    """SHA-256 of a regular file; "" where there is none that can be read.

    Parameters
    ----------
    path : str
        The file.
    """
    try:
        found = Path(path).stat()
        # a copy may have taken over the first two, and no program sets the last
        state = found.st_mtime_ns, found.st_size, found.st_ino, found.st_ctime_ns
        return _digest(str(path), *state)
    except OSError:
        return ""


@once
def program_hash() -> str:
    """SHA-256 of all sources and tables of this program, cases and geometry included."""
    code = hashlib.sha256()
    found: dict[str, Traversable] = {}
    # in an installation the last two lie in the first, in the repository beside it
    for package in ("fe_drivetrain", "fe_drivetrain.geometry", "fe_drivetrain.cases"):
        found |= dict(_sources(files(package), package.replace(".", "/")))
    for name in sorted(found):
        code.update(name.encode() + b"\0" + found[name].read_bytes() + b"\0")
    return code.hexdigest()


@once
def program_commit() -> str:
    """The commit of the clone that the program runs from; empty where it is installed.

    What was changed since is in `program_hash` alone.
    """
    return commit_of(Path(str(files("fe_drivetrain"))).parent)


def commit_of(clone: Path) -> str:
    """The commit that is checked out in a clone, or in a worktree of one; empty where none is.

    Parameters
    ----------
    clone : Path
        Its upper folder. Files of git are read; git itself need not be there.
    """
    try:
        folder = clone / ".git"
        if folder.is_file():  # of a worktree
            folder = clone / folder.read_text("utf-8").removeprefix("gitdir:").strip()
        common = folder
        if (named := folder / "commondir").is_file():
            common = folder / named.read_text("utf-8").strip()
        head = (folder / "HEAD").read_text("utf-8").strip()
        if not head.startswith("ref:"):
            return _digits(head)
        name = head.removeprefix("ref:").strip()
        for at in (folder, common):
            if (at / name).is_file():
                return _digits((at / name).read_text("utf-8").strip())
        for line in (common / "packed-refs").read_text("utf-8").splitlines():
            digits, _, what = line.partition(" ")
            if what.strip() == name:
                return _digits(digits)
    except (OSError, UnicodeDecodeError):
        pass
    return ""


def _digits(text: str) -> str:
    return text if re.fullmatch("[0-9a-f]{40}|[0-9a-f]{64}", text) else ""


def _sources(folder: Traversable, name: str) -> Iterator[tuple[str, Traversable]]:
    for entry in folder.iterdir():
        inner = f"{name}/{entry.name}"
        if entry.is_dir():
            yield from _sources(entry, inner)
        elif entry.name.endswith((".py", ".yaml")):
            yield inner, entry


def versions(packages: Sequence[str]) -> dict[str, str | None]:
    """Versions of installed packages by name; None of one that is not installed.

    Parameters
    ----------
    packages : sequence of str
        As they are called in an index of packages.

    Returns
    -------
    dict
    """
    return {name: _version(name) for name in packages}


def machine() -> str:
    """System and processor: a home folder may be shared by machines whose last digits differ."""
    return f"{platform.system()} {platform.machine()}"


def arithmetic() -> dict[str, Any]:
    """What decides the order of sums: threads, and the kernels that a BLAS chose for the processor.

    Returns
    -------
    dict
        Read again each time: threads may be limited in the course of a process.
    """
    import numba
    import scipy.linalg  # noqa: F401 - loads its BLAS, which else comes with the first solution
    from threadpoolctl import threadpool_info  # type: ignore[import-untyped]

    libraries = [
        [str(found.get(key)) for key in ("internal_api", "version", "num_threads", "architecture")]
        for found in threadpool_info()
        if found.get("internal_api") in _CHOOSE
    ]
    return {
        "machine": machine(),
        "numba threads": numba.get_num_threads(),
        "blas": sorted(map(list, {tuple(library) for library in libraries})),
    }


@once
def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None
