"""OpenFAST's ExtPtfm: reduced mass, stiffness and damping as a superelement file.

The first point is the interface; the motions of the others are counted from where a static motion
of the interface alone takes them. So K has no terms between interface and the rest, for which
ExtPtfm has no place (OpenFAST 5 manual, ExtPtfm, "Guyan/Craig-Bampton superelement input file").
OpenFAST up to release 4 has another form of the file, with a line more before each matrix and the
weight as a load over time ("Superelement input file (FlexASCII)" in its manual).
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import require_readable
from fe_drivetrain.export.formats.openfast_inputs import openfast_reader
from fe_drivetrain.export.formats.statement import comment_lines, statement, text_of
from fe_drivetrain.export.superelement import ALLOWED, Superelement

_BLOCKS = {
    "mass": "!Mass Matrix (Units (kg,m))",
    "stiffness": "!Stiffness Matrix (Units (N,m))",
    "damping": "!Damping Matrix (Units (N,m,kg))",
    "weight": "!Weight constant (Units (N,m))",
    "weight_stiffness": "!Weight stiffness (Units (N,m))",
}


class Reduced(NamedTuple):
    """What ExtPtfm takes, of n interface and relative motions, all symmetric but ``weight``.

    Attributes
    ----------
    mass, stiffness, damping : Floats
        (n, n).
    weight : Floats
        (n,) forces of the own weight, along -z.
    """

    mass: Floats
    stiffness: Floats
    damping: Floats
    weight: Floats


def reduced(
    element: Superelement, damping: Floats | None = None, gravity: float = GRAVITY
) -> Reduced:
    """A superelement in interface and relative motions.

    Parameters
    ----------
    element : Superelement
        With its mass; the first point is the interface.
    damping : Floats or None
        (6 n, 6 n) of the points' motions [N s/m, N s, N m s/rad]; none where not given.
    gravity : float
        [m/s^2], along -z of the frame.

    Raises
    ------
    InputError
        The superelement has no mass, or the damping another shape.
    """
    K, M = element.stiffness, element.mass
    if M is None:
        raise InputError(
            f"superelement {element.name!r} has no mass, and ExtPtfm needs one: condense the shaft "
            "at level 2 or 3"
        )
    C = np.zeros_like(K) if damping is None else np.asarray(damping, dtype=float)
    if C.shape != K.shape or not np.isfinite(C).all():
        raise InputError(f"damping of shape {C.shape} must be {K.shape} and finite")
    T = np.eye(len(K))
    if len(K) > 6:
        T[6:, :6] = -np.linalg.solve(K[6:, 6:], K[6:, :6])
        if not element.supported:
            # the rest follows the interface as a rigid body; the solution has that but for rounding
            T[6:, :6] = element.rigid_motions[6:]
    stiffness = T.T @ K @ T
    stiffness[6:, :6] = stiffness[:6, 6:] = 0.0
    if not element.supported:
        stiffness[:6, :6] = 0.0
    rise = element.rigid_motions[:, 2]
    mass, damped = T.T @ M @ T, T.T @ C @ T
    return Reduced(
        0.5 * (mass + mass.T),
        0.5 * (stiffness + stiffness.T),
        0.5 * (damped + damped.T),
        -gravity * T.T @ (M @ rise),
    )


def write(
    path: Path,
    element: Superelement,
    damping: Floats | None = None,
    gravity: float = GRAVITY,
    release: Literal[4, 5] = 5,
) -> None:
    """Write the superelement file of a release of OpenFAST; numbers keep every digit.

    Release 4 stands for 2.3 to 4. See `reduced` for the other arguments and what it refuses.
    """
    found = reduced(element, damping, gravity)
    first, *others = element.points
    entries = statement(element) | {
        "degrees_of_freedom": f"ux uy uz rx ry rz of {first}, the interface"
        + "".join(f"; of {name}, relative to its static share in that" for name in others),
        "gravity": f"{gravity!r} m/s^2 along -z",
        "damping": "none" if damping is None else "as given",
    }
    # a blank after the mark keeps a comment from being a keyword
    comments = list(comment_lines(entries, "!"))
    lines = _release_5(found, comments) if release == 5 else _release_4(found, comments)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _release_5(found: Reduced, comments: list[str]) -> list[str]:
    n = len(found.weight)
    blocks = [*found[:3], found.weight[None], np.zeros((n, n))]
    lines = [*comments, f"!Dimension: {n}"]
    for title, matrix in zip(_BLOCKS.values(), blocks, strict=True):
        lines += ["", title, *_rows(matrix)]
    return lines


def _release_4(found: Reduced, comments: list[str]) -> list[str]:
    """The weight is a constant load, at the times 0 and 1 s; there are no waves."""
    n = len(found.weight)
    size = f"!Dimension: {n}"
    lines = [
        comments[0],
        "! Flex 5 Format",
        *comments[1:],
        size,
        "!Time increment in simulation: 1.0",
        "!Total simulation time in file: 1.0",
    ]
    for name in ("mass", "stiffness", "damping"):
        lines += [_BLOCKS[name], size, *_rows(getattr(found, name))]
    times = np.array([[0.0], [1.0]])
    load = np.hstack([times, np.tile(found.weight, (2, 1)), np.zeros((2, 1))])
    columns = f"!Dimension: 1 time column - {n} force columns - 1 wave elevation column"
    return [*lines, "!Loading and Wave Elevation (Units (N,m))", columns, *_rows(load)]


def _rows(matrix: Floats) -> list[str]:
    return [" ".join(f"{value:24.16e}" for value in row) for row in matrix]


def read_reduced(path: str | Path) -> Reduced:
    """The matrices of a superelement file, as openfast_io reads them.

    Raises
    ------
    MissingToolError
        openfast_io is not installed.
    InputError
        openfast_io cannot read it, or a matrix is missing or not symmetric.
    """
    require_readable(path, "ExtPtfm superelement")
    reader = openfast_reader()
    reader.fst_vt["ExtPtfm"]["FlexASCII"] = {}
    try:
        reader.read_Superelement(str(path))
        blocks = reader.fst_vt["ExtPtfm"]["FlexASCII"]
        found = Reduced(
            np.asarray(blocks["MassMatrix"]),
            np.asarray(blocks["StiffnessMatrix"]),
            np.asarray(blocks["DampingMatrix"]),
            np.asarray(blocks["WeightConstant"]).ravel(),
        )
    # whatever a line that cannot be read makes openfast_io raise
    except Exception as error:
        raise InputError(
            f"openfast_io cannot read {path} as ExtPtfm superelement: {type(error).__name__} "
            f"{error}"
        ) from error
    for name, matrix in zip(found._fields[:3], found[:3], strict=True):
        if not np.abs(matrix - matrix.T).max() <= ALLOWED * np.abs(matrix).max():
            raise InputError(f"{path}: the {name} matrix is not symmetric")
    return found


def read_release_4(path: str | Path) -> Reduced:
    """The matrices and the first load of a superelement file of OpenFAST 2.3 to 4.

    Read as OpenFAST does (ExtPtfm_MCKF_IO, ReadFlexASCII): keywords at the start of a line, one
    line after them left out.

    Raises
    ------
    InputError
        A block is missing or cut off.
    """
    lines = text_of(Path(path), "ExtPtfm superelement").splitlines()
    found: dict[str, Floats] = {}
    n = 0
    at = 0
    try:
        while at < len(lines):
            line = lines[at].lower()
            at += 1
            if line.startswith("!dimension"):
                n = int(line[11:])
                continue
            for key in ("!mass matrix", "!stiffness matrix", "!damping matrix", "!loading"):
                if line.startswith(key):
                    count, width = (n, n) if key != "!loading" else (1, n + 1)
                    rows = lines[at + 1 : at + 1 + count]
                    block = np.array([[float(v) for v in row.split()[:width]] for row in rows])
                    found[key] = block.reshape(count, width)
                    at += 1 + count
        return Reduced(
            found["!mass matrix"],
            found["!stiffness matrix"],
            found["!damping matrix"],
            found["!loading"][0, 1:],
        )
    except (KeyError, ValueError) as error:
        raise InputError(
            f"{path} is no ExtPtfm superelement of OpenFAST 4: {type(error).__name__} {error}"
        ) from error
