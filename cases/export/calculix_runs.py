"""Results of CalculiX for an exported superelement: a deck includes it, and ccx runs the deck."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.calculix_results import read_dat
from fe_drivetrain.export.formats.calculix_springs import write as write_springs
from fe_drivetrain.export.programs.ccx import run_calculix
from fe_drivetrain.export.superelement import Superelement

#: Degrees of freedom that the eigenvalue solver of ccx (ARPACK) wants for every frequency; found by
#: trial.
DOFS_PER_FREQUENCY = 6

_FREQUENCY = re.compile(r"^ +\d+ +(\S+) +\S+ +(\S+) +\S+ *$", re.MULTILINE)


def held(element: Superelement) -> int:
    """How many degrees of freedom the runs hold: the first point's six, where the body is free."""
    return 0 if element.supported else 6


def compliance_by_calculix(element: Superelement, folder: Path) -> Floats:
    """The compliance of a superelement's file, from unit forces and moments in ccx, a step each.

    Parameters
    ----------
    element : Superelement
        The superelement; a free one is held at its first point, and loaded at the others.
    folder : Path
        For the decks and what ccx writes.

    Returns
    -------
    (m, m) of the m degrees of freedom that are not held [m/N, rad/N, rad/(N m)], in the digits of a
    .dat.
    """
    write_springs(folder / "element.inp", element)
    start, size = held(element), 6 * len(element.points)
    lines = ["*INCLUDE, INPUT=element.inp", *_support(element)]
    for dof in range(start, size):
        lines += ["*STEP", "*STATIC", "*CLOAD, OP=NEW", f"{dof // 3 + 1},{dof % 3 + 1},1."]
        lines += [f"*NODE PRINT, NSET={element.name.upper()}_POINTS", "U", "*END STEP"]
    dat = _run(folder / "loads.inp", lines)
    found = np.full((size, size - start), np.nan)
    for table in read_dat(dat):
        rows = 3 * (table.nodes[:, None] - 1) + np.arange(3)
        found[rows.ravel(), round(table.time) - 1] = table.values.ravel()
    return found[start:]


def frequencies_by_calculix(element: Superelement, folder: Path, count: int) -> Floats:
    """The lowest natural frequencies of a superelement with mass in ccx [Hz].

    Parameters
    ----------
    element : Superelement
        The superelement; a free one is held at its first point.
    folder : Path
        For the deck and what ccx writes.
    count : int
        How many.

    Raises
    ------
    InputError
        There is no mass, or there are not `DOFS_PER_FREQUENCY` for each frequency.
    """
    free = 6 * len(element.points) - held(element)
    if element.mass is None or free < DOFS_PER_FREQUENCY * count:
        raise InputError(
            f"superelement {element.name!r} must have mass and {DOFS_PER_FREQUENCY} degrees of "
            f"freedom for each of {count} frequencies: it has {free}"
        )
    write_springs(folder / "element.inp", element)
    lines = ["*INCLUDE, INPUT=element.inp", *_support(element)]
    lines += ["*STEP", "*FREQUENCY", str(count), "*END STEP"]
    text = _run(folder / "frequencies.inp", lines).read_text("ascii")
    table = text.partition("P A R T I C I P A T I O N")[0]
    return np.array([float(cycles) for _, cycles in _FREQUENCY.findall(table)])


def _run(deck: Path, lines: list[str]) -> Path:
    deck.write_bytes("".join(f"{line}\n" for line in lines).encode("ascii", "replace"))
    return run_calculix(deck)


def _support(element: Superelement) -> list[str]:
    return ["*BOUNDARY", "1,1,3", "2,1,3"] if held(element) else []
