"""CalculiX: full stiffness and mass as single springs and masses, tied to the points by equations.

CalculiX 2.20 takes no matrix as an element (*MATRIX ASSEMBLE came later, and its *USER ELEMENT is
the name of a compiled routine), and its springs join single degrees of freedom. But every symmetric
matrix without negative eigenvalues is a sum of squares of linear forms, K = sum k_i v_i v_i^T, its
eigenvectors with a unit diagonal: an auxiliary node moves by v_i^T u, by *EQUATION, and stands on a
spring k_i (SPRING1) to the ground. A mass does the same with MASS.

A point is two nodes, as in `calculix_plan`: degrees of freedom 1 to 3 of the first are its
displacements, of the second its rotations. The file is for an *INCLUDE in the model definition.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import diagonal_roots, scaled_to_unit_diagonal
from fe_drivetrain.export.formats.statement import (
    comment_lines,
    commented,
    element_of,
    statement,
    text_of,
)
from fe_drivetrain.export.superelement import Superelement

_TERMS = 4  # of an equation on a line: the most that ccx reads
_END = "end"
_TYPES = {"stiffness": "SPRING1", "mass": "MASS"}


def write(path: Path, element: Superelement) -> None:
    """Write a superelement as model definition, nodes and elements numbered from 1."""
    text = "".join(f"{line}\n" for line in model_lines(element))
    path.write_bytes(text.encode("ascii", "replace"))


def model_lines(
    element: Superelement, first_node: int = 1, first_element: int = 1
) -> Iterator[str]:
    """The lines of a superelement in the model definition.

    Parameters
    ----------
    element : Superelement
        The superelement.
    first_node, first_element : int
        Numbers that nothing else in the deck has, nor what follows them: 2 n nodes of the n points
        and up to 6 n of stiffness and mass each, and as many elements.
    """
    n = len(element.points)
    label = element.name.upper()
    auxiliary = first_node + 2 * n
    entries = statement(element)
    for k, name in enumerate(element.points):
        node = first_node + 2 * k
        entries[f"nodes of point {k + 1}"] = f"{node} displacements, {node + 1} rotations of {name}"
    yield from comment_lines(entries, "**")
    yield f"*NODE, NSET={label}_POINTS"
    for k, (x, y, z) in enumerate(element.positions.tolist()):
        for node in (first_node + 2 * k, first_node + 2 * k + 1):
            yield f"{node},{x:.13e},{y:.13e},{z:.13e}"
    terms: list[tuple[str, float, Floats]] = []
    for kind, matrix in (("stiffness", element.stiffness), ("mass", element.mass)):
        if matrix is not None:
            terms += [(kind, value, form) for value, form in zip(*squares(matrix), strict=True)]
    yield f"*NODE, NSET={label}_AUXILIARY"
    x, y, z = element.positions[0].tolist()
    for k in range(len(terms)):
        yield f"{auxiliary + k},{x:.13e},{y:.13e},{z:.13e}"
    for k, (kind, value, _) in enumerate(terms):
        name = f"{label}_{k + 1}"
        yield f"*ELEMENT, TYPE={_TYPES[kind]}, ELSET={name}"
        yield f"{first_element + k},{auxiliary + k}"
        yield f"*{'SPRING' if kind == 'stiffness' else 'MASS'}, ELSET={name}"
        if kind == "stiffness":
            yield "1"
        yield f"{value:.13e}"
    yield "*EQUATION"
    for k, (_, _, form) in enumerate(terms):
        yield from _equation(auxiliary + k, form, first_node)
    yield "*BOUNDARY"
    yield f"{label}_AUXILIARY,2,3"
    yield from comment_lines({_END: f"of {element.name}"}, "**")


def squares(matrix: Floats) -> tuple[Floats, Floats]:
    """A symmetric matrix without negative eigenvalues as a sum of squares of linear forms.

    Returns
    -------
    values
        (r,) positive factors.
    forms
        (r, m) of the m degrees of freedom; the matrix is ``forms.T @ diag(values) @ forms``, and
        what no form sees has neither stiffness nor mass.
    """
    size = diagonal_roots(matrix.diagonal())
    unit = scaled_to_unit_diagonal(matrix)
    values, vectors = np.linalg.eigh(0.5 * (unit + unit.T))
    vectors[np.abs(vectors) < np.finfo(float).eps] = 0.0
    # below this it is the round-off of an eigenvalue that is zero
    kept = values > len(values) * np.finfo(float).eps * values[-1]
    return values[kept], (vectors[:, kept] * size[:, None]).T


def read(path: Path) -> Superelement:
    """Read such a file back: its springs, masses and equations are summed up.

    Raises
    ------
    InputError
        The file is not of this form, or is cut off.
    """
    text = text_of(path, "superelement for CalculiX")
    entries = commented(text.splitlines(), "**")
    if _END not in entries:
        raise InputError(f"{path} is no superelement for CalculiX, or is cut off")
    try:
        with np.errstate(all="ignore"):  # the superelement must be finite
            matrices = _summed(text)
    except (ValueError, IndexError, KeyError, StopIteration) as error:
        raise InputError(f"{path} is no superelement for CalculiX: {error}") from error
    return element_of(path, entries, matrices["stiffness"], matrices.get("mass"))


def _equation(auxiliary: int, form: Floats, first_node: int) -> Iterator[str]:
    # All degrees of freedom stand in every equation, of zero factor too: ccx lays out its matrix
    # for springs only, and stops where a mass then couples degrees of freedom that no spring does.
    terms = [(auxiliary, 1, -1.0)]
    terms += [(first_node + f // 3, f % 3 + 1, value) for f, value in enumerate(form.tolist())]
    yield str(len(terms))
    texts = [f"{node},{dof},{value:.13e}" for node, dof, value in terms]
    for start in range(0, len(texts), _TERMS):
        yield ",".join(texts[start : start + _TERMS])


def _summed(text: str) -> dict[str, Floats]:
    """Stiffness and mass of the network."""
    cards: list[tuple[str, list[str]]] = []
    for line in text.splitlines():
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            cards.append((line, []))
        elif not cards:
            raise ValueError(f"{line!r} stands before any keyword")
        else:
            cards[-1][1].append(line)
    points = next(lines for card, lines in cards if card.endswith("_POINTS"))
    first = int(points[0].split(",")[0])
    size = 3 * len(points)
    forms: dict[int, Floats] = {}
    for card, lines in cards:
        if card == "*EQUATION":
            forms |= _forms(lines, first, size)
    nodes = {
        card.split("ELSET=")[1]: int(lines[0].split(",")[1])
        for card, lines in cards
        if card.startswith("*ELEMENT")
    }
    found: dict[str, Floats] = {"stiffness": np.zeros((size, size))}
    for card, lines in cards:
        if card.startswith(("*SPRING", "*MASS")):
            form = forms[nodes[card.split("ELSET=")[1]]]
            kind = "stiffness" if card.startswith("*SPRING") else "mass"
            matrix = found.setdefault(kind, np.zeros((size, size)))
            matrix += float(lines[-1]) * np.outer(form, form)
    return found


def _forms(lines: list[str], first: int, size: int) -> dict[int, Floats]:
    """Linear forms of the points' degrees of freedom, by auxiliary node."""
    found: dict[int, Floats] = {}
    rest = list(lines)
    while rest:
        n_terms = int(rest.pop(0))
        values: list[str] = []
        while len(values) < 3 * n_terms:
            values += rest.pop(0).split(",")
        numbers = np.array(values, dtype=float).reshape(-1, 3)
        form = np.zeros(size)
        where = 3 * (numbers[1:, 0].astype(int) - first) + numbers[1:, 1].astype(int) - 1
        form[where] = -numbers[1:, 2] / numbers[0, 2]
        found[int(numbers[0, 0])] = form
    return found
