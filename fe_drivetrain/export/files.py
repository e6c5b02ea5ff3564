"""Superelements out, and back in: one module a format, all behind one reader and one writer."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from importlib import import_module
from inspect import signature
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_paths
from fe_drivetrain.common.reading import require_readable
from fe_drivetrain.export.formats.labelled_matrices import TAKEN_AS_IT_IS, Naming
from fe_drivetrain.export.superelement import Superelement


class Format(NamedTuple):
    """A file format: its name, usual ending, what reads it, its module, the digits it keeps, the
    extra it needs, and what of a superelement it has no room for.

    The module has ``write(path, element)``, and ``read(path)`` where the file holds enough for it.
    """

    name: str
    suffix: str
    reader: str
    module: str
    digits: int = 15
    extra: str = ""
    left_out: str = ""


FORMATS: dict[str, Format] = {
    f.name: f
    for f in (
        Format("json", ".json", "anything: docs/superelement.schema.json", "superelement_json"),
        Format("csv", ".csv", "spreadsheets, pandas", "superelement_csv"),
        Format("mtx", ".mtx", "Matrix Market readers: the stiffness", "matrix_market"),
        Format("mtx-mass", ".mtx", "Matrix Market readers: the mass", "matrix_market_mass"),
        Format("hdf5", ".h5", "HDF5 readers", "hdf5", extra="hdf5"),
        Format("dmig", ".bdf", "Nastran, as bulk data: GRID, DMIG", "dmig", 10),
        Format(
            "op4",
            ".op4",
            "Nastran INPUTT4, as text",
            "op4",
            left_out="names and source, and bound, rollers and band of the stiffness",
        ),
        Format("calculix", ".inp", "CalculiX: springs and equations", "calculix_springs", 11),
        Format("extptfm", ".dat", "OpenFAST 5, ExtPtfm superelement", "extptfm"),
        Format("subdyn", ".dat", "OpenFAST 5, SubDyn spring element: one point", "subdyn"),
        Format("rexs", ".rexs", "REXS 1.6, gearbox programs: reduced stiffness", "rexs", 14),
        Format("simpack", ".subvar", "SIMPACK substitution variables", "simpack"),
    )
}


READ_ALONE = {"substructure": "substructure", "harwell-boeing": "harwell_boeing"}
"""Modules of formats of other programs, which nothing is written in."""


def write_superelement(
    path: str | Path, element: Superelement, format: str, overwrite: bool = False
) -> None:
    """Write a superelement; the file appears whole or not at all.

    Parameters
    ----------
    path : str or Path
        The file.
    element : Superelement
        What is written.
    format : str
        A name of `FORMATS`.
    overwrite : bool
        Whether an existing file is replaced.

    Raises
    ------
    InputError
        The format is unknown, the file exists, or the format cannot hold this superelement.
    """
    write_superelements({format: Path(path)}, element, overwrite)


def write_superelements(
    files: Mapping[str, Path], element: Superelement, overwrite: bool = False
) -> None:
    """Write a superelement in several formats; all files appear whole, or none does.

    Parameters
    ----------
    files : Mapping[str, Path]
        A file for each format, by its name in `FORMATS`.
    element, overwrite : Superelement, bool
        The same as for `write_superelement`, and so is what is refused.
    """
    writers = [_function(format, "write") for format in files]
    refuse_existing(files.values(), overwrite)
    with atomic_paths(list(files.values())) as unfinished:
        for writer, path in zip(writers, unfinished, strict=True):
            writer(path, element)


def refuse_existing(paths: Iterable[Path], overwrite: bool) -> None:
    """Refuse files that are there, unless they may be overwritten.

    Raises
    ------
    InputError
    """
    for path in paths:
        if path.exists() and not overwrite:
            raise InputError(f"{path} exists: name another file, or allow to overwrite it")


def read_superelement(
    path: str | Path, format: str, naming: Naming = TAKEN_AS_IT_IS
) -> Superelement:
    """Read a superelement back, or one of another program.

    Parameters
    ----------
    path : str or Path
        The file.
    format : str
        A name of `FORMATS` or `READ_ALONE`.
    naming : Naming
        What a file of another program leaves open.

    Raises
    ------
    InputError
        The format is unknown or cannot be read back, or the file cannot be read, is too large, is
        not of that format, or says itself what is named.
    """
    reader = _function(format, "read")
    require_readable(path, "superelement")
    if naming.says_nothing:
        found = reader(Path(path))
    elif "naming" in signature(reader).parameters:
        found = reader(Path(path), naming)
    else:
        raise InputError(
            f"{path} names its points and matrices itself: leave out "
            f"{', '.join(argument(name, value) for name, value in naming.given.items())}"
        )
    assert isinstance(found, Superelement)
    return found


def format_module(format: str) -> ModuleType:
    """The module of a format.

    Raises
    ------
    InputError
        The format is unknown.
    """
    modules = {name: one.module for name, one in FORMATS.items()} | READ_ALONE
    if format not in modules:
        raise InputError(f"format {format!r} is unknown: use one of {', '.join(FORMATS)}")
    return import_module(f"fe_drivetrain.export.formats.{modules[format]}")


def _function(format: str, name: str) -> Callable[..., object]:
    module = format_module(format)
    if not hasattr(module, name):
        only, instead = ("read", "write") if name == "write" else ("written", "read back")
        raise InputError(f"format {format!r} can be {only} only: {instead} another one")
    return getattr(module, name)  # type: ignore[no-any-return]
