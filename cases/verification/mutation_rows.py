"""Faults that somebody could make, as rows of a table, and a copy of the clone that has one."""

import os
import re
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import yaml

from fe_drivetrain.common import InputError, MissingToolError

PACKAGE = "fe_drivetrain"
TOP_LEVEL = ("geometry", "cases")  # beside the package in a clone, inside it where installed
NEEDED = ("pytest", "filelock", "hypothesis", "xdist")  # by all tests


@dataclass(frozen=True)
class Fault:
    """One line of the program, the same line with a fault, and the tests that ought to catch it.

    Attributes
    ----------
    what : str
        The fault in words.
    file : str
        Module, below the package.
    line : str
        Text that stands in the module exactly once.
    fault : str
        What stands there in its place.
    tests : tuple of str
        Files or tests of ``tests/``, as pytest takes them.
    quick : bool
        Whether a quick run tries it.
    survives : str
        Why no test catches it, where none does.
    """

    what: str
    file: str
    line: str
    fault: str
    tests: tuple[str, ...]
    quick: bool = False
    survives: str = ""

    @property
    def room(self) -> str:
        """Room of the module."""
        return self.file.partition("/")[0]

    @property
    def module(self) -> str:
        """Name of the module below the package."""
        return self.file.removesuffix(".py").replace("/", ".")


def clone() -> Path:
    """Folder of the clone that this program runs from.

    Raises
    ------
    MissingToolError
        It runs from an installed wheel, which has no tests, or what these need is not installed.
    """
    root = Path(__file__).parents[2]
    if not (root / "tests" / "mutations").is_dir():
        raise MissingToolError(
            "faults are caught by tests, and an installed wheel has none: run this case from a "
            "clone of the repository"
        )
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        raise MissingToolError(
            f"the tests need {', '.join(missing)}: python -m pip install -e '.[test]' in the clone"
        )
    return root


def faults_of(root: Path) -> list[Fault]:
    """All rows of ``tests/mutations/*.yaml``, in order.

    Parameters
    ----------
    root : Path
        Folder of a clone.

    Returns
    -------
    list of Fault

    Raises
    ------
    InputError
        A row has other keys than those of `Fault`.
    """
    found = []
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # which takes a tenth of the time
    for path in sorted((root / "tests" / "mutations").glob("*.yaml")):
        for row in yaml.load(path.read_text(encoding="utf-8"), loader):
            try:
                found.append(Fault(**{**row, "tests": tuple(row["tests"].split())}))
            except (KeyError, TypeError) as error:
                raise InputError(f"{path}: a row is no fault ({error}): {row}") from error
    return found


def source_of(root: Path, fault: Fault) -> Path:
    """The module of a fault in a clone."""
    top = fault.room in TOP_LEVEL
    return root / fault.file if top else root / PACKAGE / fault.file


def is_there_once(root: Path, fault: Fault) -> bool:
    """Whether the line of a fault stands in its module exactly once, and the fault changes it."""
    text = source_of(root, fault).read_text(encoding="utf-8")
    return text.count(fault.line) == 1 and fault.line != fault.fault


def copy_of(root: Path, folder: Path) -> None:
    """Copy program, tests and what these read, compiled loops among them, as if installed.

    Parameters
    ----------
    root : Path
        The clone, in which nothing is changed.
    folder : Path
        An empty folder.
    """
    for name in (PACKAGE, "tests", "docs"):
        if (root / name).is_dir():
            shutil.copytree(root / name, folder / name)
    for name in TOP_LEVEL:
        shutil.copytree(root / name, folder / PACKAGE / name)
        (folder / name).symlink_to(Path(PACKAGE) / name)
    for file in (root / "pyproject.toml", *root.glob("*.md")):
        shutil.copy2(file, folder)


def with_fault(base: Path, folder: Path, fault: Fault) -> None:
    """Make a copy that has a fault, and in which every loop that has it in it is compiled again.

    Parameters
    ----------
    base : Path
        Made by `copy_of`. Its files are linked, and none of them is changed: Python, numba and
        pytest exchange files whole.
    folder : Path
        The new copy, which is not there yet.
    fault : Fault
        What to put in.
    """
    shutil.copytree(base, folder, symlinks=True, copy_function=os.link)
    path = folder / PACKAGE / fault.file
    text = path.read_text(encoding="utf-8")
    path.unlink()
    path.write_text(text.replace(fault.line, fault.fault), encoding="utf-8")
    for kept in (path.parent / "__pycache__").glob(f"{path.stem}.cpython*"):
        kept.unlink()
    for module in with_loops(base / PACKAGE):
        if fault.module in reached(base / PACKAGE, module):
            file = folder / PACKAGE / f"{module.replace('.', '/')}.py"
            for kept in (file.parent / "__pycache__").glob(f"{file.stem}.*.nb?"):
                kept.unlink()


@cache
def with_loops(package: Path) -> tuple[str, ...]:
    """Modules of which compiled loops are kept, or would be."""
    return tuple(
        _name(package, path)
        for path in package.rglob("*.py")
        if re.search(r"^\s*(from|import) .*numba", path.read_text("utf-8"), re.M)
    )


@cache
def reached(package: Path, module: str) -> frozenset[str]:
    """A module and all that it imports, by whatever way: numba compiles what they hold into it."""
    found, left = set(), [module]
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            left.extend(_imports(package, name))
    return frozenset(found)


_IMPORT = re.compile(r"^\s*from fe_drivetrain\.?([\w.]*) import (\([^)]*\)|.*)$", re.MULTILINE)


def _imports(package: Path, module: str) -> Iterator[str]:
    file = package / f"{module.replace('.', '/')}.py"
    for target, names in _IMPORT.findall(file.read_text(encoding="utf-8")):
        place = package / target.replace(".", "/")
        if place.is_dir():  # modules of a room, or its face, which may take any of them
            listed = set(re.findall(r"\w+", names))
            inside = {path.stem: path for path in place.glob("*.py") if path.stem != "__init__"}
            taken = [inside[name] for name in listed & inside.keys()]
            yield from (_name(package, path) for path in taken or inside.values())
        else:
            yield target


def _name(package: Path, path: Path) -> str:
    return ".".join(path.relative_to(package).with_suffix("").parts)
