"""STEP files of parts in the open gmsh model."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import gmsh

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path, scratch_folder

_MILLIMETRE = re.compile(
    r"(LENGTH_UNIT\(\s*\)\s*NAMED_UNIT\(\*\)\s*)SI_UNIT\(\.MILLI\.,\.METRE\.\)"
)
_TIME_STAMP = re.compile(r"(FILE_NAME\(\s*'[^']*'\s*,\s*)'[^']*'")
_COUNT = re.compile(r"('Open CASCADE STEP translator \S+ )\d+")  # of files of this process


@contextmanager
def _silent() -> Iterator[None]:
    """OpenCASCADE tells standard output what it writes, whatever gmsh's options are."""
    if sys.stdout is not None:
        sys.stdout.flush()
    before = os.dup(1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        os.dup2(before, 1)
        os.close(before)
        os.close(nowhere)


def write_step(path: str | os.PathLike[str], volumes: Sequence[int], unit: str = "m") -> None:
    """Write solids of the open gmsh model to a STEP file, which states its unit.

    Parameters
    ----------
    path : str or path-like
        The file, ending in .step or .stp; it appears whole or not at all.
    volumes : Sequence[int]
        Tags of the solids; all else of the model is removed.
    unit : str
        Unit of the model's lengths: "m" or "mm". gmsh itself writes any number as mm.

    Raises
    ------
    InputError
        The ending or the unit is another.
    """
    target = Path(path)
    if target.suffix.lower() not in (".step", ".stp") or unit not in ("m", "mm"):
        raise InputError(
            f"{target} in {unit!r} cannot be written: end the file in .step or .stp, and give the "
            "unit m or mm"
        )
    occ = gmsh.model.occ
    occ.synchronize()
    kept = {(3, tag) for tag in volumes}
    occ.remove([e for e in occ.getEntities(3) if e not in kept], recursive=True)
    for dim in (2, 1, 0):
        occ.remove(occ.getEntities(dim))  # those that no solid has
    occ.synchronize()
    with scratch_folder() as folder:
        made = folder / "part.step"
        with _silent():
            gmsh.write(str(made))
        text = made.read_text("utf-8")
    # the same solids are the same file: their meshes are then kept under its content
    text = _TIME_STAMP.sub(r"\1'1970-01-01T00:00:00'", text, count=1)
    text = _COUNT.sub(r"\g<1>1", text)
    if unit == "m":
        text, count = _MILLIMETRE.subn(r"\1SI_UNIT($,.METRE.)", text)
        if count < 1:
            raise RuntimeError("gmsh wrote no unit of length")
    with atomic_path(target) as unfinished:
        unfinished.write_text(text, "utf-8")
