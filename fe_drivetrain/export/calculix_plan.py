"""Nodes and equations of a CalculiX deck of a model, before they are text.

A reference point becomes two nodes: degrees of freedom 1 to 3 of the first are the displacements of
the point, those of the second its rotations. Constraints are written as they are eliminated: each
equation determines one degree of freedom from others that no equation determines, so nothing is
chained.
"""

import math
import re
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.shared_parts import refuse_coupled
from fe_drivetrain.elasticity.interfaces.constraints import Constraint, eliminate
from fe_drivetrain.shafts.response.model import LOADS, Model

ROUND_OFF = 1e-14  # coefficients below, relative to the largest of their row, are round-off


@dataclass(frozen=True)
class DeckPlan:
    """A model in the degrees of freedom of its deck: three a node, reference points included.

    Attributes
    ----------
    positions : Floats
        (n, 3) of all nodes; those of the mesh come first [m].
    names : Mapping[int, str]
        What each node beyond the mesh is, by its index.
    references : Mapping[str, tuple[int, int]]
        Indices of the two nodes of each reference point.
    groups : Sequence[tuple[str, Ints]]
        Equations: what they are, and the (m,) degrees of freedom that they give.
    T : sparse.csr_array
        (3 n, 3 n) all degrees of freedom from those that no equation gives.
    held : Ints
        (m,) degrees of freedom of reference points that are zero.
    springs : Sequence[tuple[int, float]]
        Degree of freedom and stiffness of springs to ground [N/m, N m/rad].
    loads : Floats
        (3 n, m) the unit loads at nodes and reference points.
    """

    positions: Floats
    names: Mapping[int, str]
    references: Mapping[str, tuple[int, int]]
    groups: Sequence[tuple[str, Ints]]
    T: sparse.csr_array
    held: Ints
    springs: Sequence[tuple[int, float]]
    loads: Floats


def plan_deck(model: Model, loads: Sequence[str]) -> DeckPlan:
    """Number the degrees of freedom of the deck, and solve all constraints for those they give."""
    _check_loads(model, loads)
    n_mesh = len(model.mesh.points)
    rigid = {c.name for c in model.constraints if c.name in model.points}
    averaged = [point for name, point in model.points.items() if name not in rigid]
    coupled = [
        (point, value, vector)
        for point, k in model.springs
        if np.abs(k - np.diag(k.diagonal())).max() > 0.0
        for value, vector in zip(*_stretched(k), strict=True)
    ]
    along = model.n_dofs + 6 * len(averaged)  # first of the coupled springs' own degrees of freedom
    n_dofs = along + 3 * math.ceil(len(coupled) / 3)
    first = {p.name: model.n_dofs + 6 * k for k, p in enumerate(averaged)}
    first |= {name: int(model.points[name].motion.indices.min()) for name in rigid}
    constraints = _of_model(model, rigid, first, n_dofs)
    for point in averaged:
        free = [c for c in range(6) if c not in model.held.get(point.name, ())]
        own = first[point.name] + np.array(free, dtype=np.int64)
        rows = Constraint(f"{point.name}: mean motion of its face", point.motion[free], own)
        constraints.append(_tied(rows, own, n_dofs))
    springs = [s for point, k in model.springs for s in _axial(k, first[point.name])]
    for number, (point, value, vector) in enumerate(coupled):
        stretched = sparse.csr_array(vector[None]) @ point.motion
        own = np.array([along + number])
        rows = Constraint(f"{point.name}: what its spring is stretched by", stretched, own)
        constraints.append(_tied(rows, own, n_dofs))
        springs.append((along + number, value))

    references = {name: (first[name] // 3, first[name] // 3 + 1) for name in model.points}
    names, positions = _extra_nodes(model, references, n_dofs // 3)
    return DeckPlan(
        positions=np.vstack([model.mesh.points, positions]),
        names={n_mesh + k: name for k, name in enumerate(names)},
        references=references,
        groups=[(c.name, np.asarray(c.pivots)) for c in constraints],
        T=eliminate(constraints, n_dofs).T,
        held=np.array(
            [first[name] + c for name, some in model.held.items() for c in some], dtype=np.int64
        ),
        springs=springs,
        loads=_unit_loads(model, first, n_dofs)[:, [model.loads.index(load) for load in loads]],
    )


def _check_loads(model: Model, loads: Sequence[str]) -> None:
    known = model.loads
    unknown = [load for load in loads if load not in known]
    if unknown or not loads:
        raise InputError(
            f"{f'load {unknown[0]!r} is unknown' if unknown else 'there is no load'}: use some of "
            f"{', '.join(known)}"
        )


def _of_model(
    model: Model, rigid: Container[str], first: Mapping[str, int], n_dofs: int
) -> list[Constraint]:
    """The model's own constraints, but for those of bases that are fixed."""
    reactions = {f"{name} reaction": name for name in model.held}
    constraints = []
    for constraint in model.constraints:
        if constraint.name in reactions:
            # The reference point's own degree of freedom is held, and a degree of freedom of the
            # face follows it.
            name = reactions[constraint.name]
            if name not in rigid:
                own = first[name] + np.array(model.held[name])
                constraints.append(_tied(constraint, own, n_dofs))
        elif constraint.name not in fixed_bases(model):
            constraints.append(replace(constraint, rows=_widened(constraint.rows, n_dofs)))
    return constraints


def _unit_loads(model: Model, first: Mapping[str, int], n_dofs: int) -> Floats:
    """(n_dofs, n_loads) unit loads of the model, on the degrees of freedom of the deck."""
    F = np.zeros((n_dofs, len(model.loads)))
    F[: model.n_dofs, 6:9] = model.unit_loads()[:, 6:9]
    F[first["hub"] + np.arange(6), np.arange(6)] = 1.0
    F[first["gearbox"] + 2, 9] = -1.0
    for k, name in enumerate(model.scene.bands):
        F[first[name] + np.arange(6), len(LOADS) + 6 * k + np.arange(6)] = 1.0
    return F


def _widened(rows: sparse.csr_array, n_dofs: int) -> sparse.csr_array:
    return sparse.csr_array((rows.data, rows.indices, rows.indptr), (rows.shape[0], n_dofs))


def _tied(constraint: Constraint, own: Ints, n_dofs: int) -> Constraint:
    """Rows that were to vanish equal degrees of freedom of their own instead."""
    m = len(own)
    ties = sparse.csr_array((np.ones(m), (np.arange(m), own)), shape=(m, n_dofs))
    rows = _widened(constraint.rows.tocsr(), n_dofs) - ties
    return replace(constraint, rows=rows.tocsr())


def _axial(k: Floats, first: int) -> Iterator[tuple[int, float]]:
    """A spring for each axis of a reference point, where none is coupled with another."""
    if np.abs(k - np.diag(k.diagonal())).max() == 0.0:
        for component, stiffness in enumerate(k.diagonal().tolist()):
            if stiffness:
                yield first + component, stiffness


def _stretched(k: Floats) -> tuple[list[float], list[Floats]]:
    """Springs that make up a coupled (6, 6) stiffness: their size, and what stretches them."""
    values, vectors = np.linalg.eigh(k)
    kept = np.flatnonzero(values > ROUND_OFF * values[-1])
    return values[kept].tolist(), list(vectors.T[kept])


def fixed_bases(model: Model) -> list[str]:
    """The housing bases that stand on the ground."""
    for group in model.scene.coupled_units:
        refuse_coupled(model.scene.bearing_units, group[0])
    return [
        f"{unit.bearing.name}.housing.base"
        for unit in model.scene.bearing_units
        if not model.standing(unit.bearing.name)
    ]


def _extra_nodes(
    model: Model, references: Mapping[str, tuple[int, int]], n: int
) -> tuple[list[str], Floats]:
    """What the nodes beyond the mesh are, and where."""
    n_mesh = len(model.mesh.points)
    names = [""] * (n - n_mesh)
    positions = np.zeros((n - n_mesh, 3))
    for name, (move, turn) in references.items():
        names[move - n_mesh], names[turn - n_mesh] = name, f"{name}: rotations"
        positions[[move - n_mesh, turn - n_mesh]] = model.points[name].position
    for constraint in model.constraints:
        for node in np.unique(constraint.rows.indices // 3):
            if node >= n_mesh and not names[node - n_mesh]:
                names[node - n_mesh] = f"auxiliary, of {constraint.name}"
                owners = [
                    name
                    for name in model.scene.bearing_names
                    if re.match(rf"{re.escape(name)}[ .]", constraint.name)
                ]
                positions[node - n_mesh] = model.points[f"{owners[0]}.seat"].position
    return [name or "auxiliary, of springs" for name in names], positions


def deck_label(name: str) -> str:
    """A name as the deck has it: capitals, beginning with a letter."""
    label = re.sub(r"[^A-Z0-9_-]", "_", name.upper())
    return label if label[:1].isalpha() else f"N{label}"
