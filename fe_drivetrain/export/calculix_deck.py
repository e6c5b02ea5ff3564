"""CalculiX: a scene's model as an input deck of its own, run by ccx, and its answers read back.

The deck is complete: elements, materials, interfaces as linear equations, supports, springs, and
the ten unit loads as ten steps. Its keywords are those that CalculiX shares with Abaqus; it is
tested with CalculiX.

A reference point becomes two nodes: of the first, freedoms 1 to 3 are the displacements of the
point, of the second its rotations. Constraints are written as they are eliminated: each equation
gives one freedom by freedoms that are in no other equation's first place, so nothing is chained.
"""

import math
import os
import re
import shutil
import subprocess
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.spatial import resultant, wrench_transport
from fe_drivetrain.export.superelement import FRAME
from fe_drivetrain.interfaces.constraints import Constraint, eliminate
from fe_drivetrain.mesh.shapes import element_kind
from fe_drivetrain.operator import kernels
from fe_drivetrain.operator.elasticity import sparsity
from fe_drivetrain.operator.incompressible import warn_of_averaging
from fe_drivetrain.response.model import LOADS, Model

INSTALL = "apt-get install calculix-ccx"

DIGITS = 7
"""Significant digits in a .dat file (Fortran's 1p,e13.6)."""

ROUNDING = 0.5 * 10.0 ** (1 - DIGITS)
"""Largest relative rounding error of a number in a .dat file."""

_TERMS = 4  # of an equation on a line: the most that are read
_NODES = 16  # of a set on a line
_LEAST = 1e-14  # coefficients below, relative to the largest of their row, are round-off
_PRINTED = re.compile(
    r"^ (displacements|forces|total internal energy)(?: \(.*\))? for set (\S+) and time +(\S+)\s*$",
    re.MULTILINE,
)
_NO_LETTER = re.compile(r"(?<=\d)([-+]\d{3})(?=\s|$)")  # Fortran's 1.234567-123


@dataclass(frozen=True)
class Printed:
    """One table of a .dat file.

    Attributes
    ----------
    quantity
        "displacements", "forces" or "total internal energy".
    set_name
        Of the nodes or elements.
    time
        Total time, which counts the steps.
    nodes
        (n,) node numbers of the deck, from 1 on; empty for totals.
    values
        (n, 3) [m, N], or (1, 1) [J].
    """

    quantity: str
    set_name: str
    time: float
    nodes: Ints
    values: Floats


@dataclass(frozen=True)
class DeckResponse:
    """What ccx answers to the m unit loads of a deck, one load a column.

    As in `response.Response`, in the digits of the .dat file.

    Attributes
    ----------
    displacements
        (n_nodes, 3, m) [m].
    motions
        (6, m) by reference point [m, rad].
    reactions
        (6, m) by name, "NAME" of each bearing and "gearbox": what the drivetrain puts on its
        surroundings [N, N m]; moments about the bearing's centre, or the gearbox.
    base_forces
        (n, 3, m) by bearing: forces that the support puts on the nodes of the housing's base,
        in the order of ``mesh.face_nodes`` [N].
    strain_energy
        (m,) by part [J].
    """

    displacements: Floats
    motions: Mapping[str, Floats]
    reactions: Mapping[str, Floats]
    base_forces: Mapping[str, Floats]
    strain_energy: Mapping[str, Floats]


@dataclass(frozen=True)
class _Plan:
    """A model in the freedoms of its deck: three a node, reference points included.

    Attributes
    ----------
    positions
        (n, 3) of all nodes; those of the mesh come first [m].
    names
        What each node beyond the mesh is, by its index.
    references
        Indices of the two nodes of each reference point.
    groups
        Equations: what they are, and the (m,) freedoms that they give.
    T
        (3 n, 3 n) all freedoms from those that no equation gives.
    held
        (m,) freedoms of reference points that are zero.
    springs
        Freedom and stiffness of springs to ground [N/m, N m/rad].
    loads
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


def write_inp(
    model: Model,
    path: str | Path,
    loads: Sequence[str] = LOADS,
    solver: str = "",
    fields: bool = True,
) -> None:
    """Write a model with its unit loads as an input deck; the same model gives the same bytes.

    Parameters
    ----------
    model
        The model.
    path
        The file, which appears whole or not at all; CalculiX wants it to end in ``.inp``.
    loads
        Which of `model.LOADS`, a step each: ccx factorises anew for every step.
    solver
        Of CalculiX, as in "SPOOLES"; its own choice where not given.
    fields
        Whether displacements and stresses go to a .frd file, too, to look at.

    Raises
    ------
    InputError
        There is no such folder or load, names of bearings are the same once written in capitals,
        or the gearbox's springs are not along the axes.

    Warns
    -----
    UserWarning
        A part is nearly incompressible: CalculiX's elements lock there, this program's do not.
    """
    for part in model.mesh.part_names:
        if warn_of_averaging(part, model.scene.material_of(part).lame):
            warnings.warn(
                f"{part} is nearly incompressible (nu = "
                f"{model.scene.material_of(part).poisson_ratio:g}): the deck's C3D10 elements lock "
                "there, and CalculiX will find it too stiff",
                stacklevel=2,
            )
    target = Path(path)
    if not target.parent.is_dir():
        raise InputError(f"deck {target}: there is no folder {target.parent}: create it first")
    plan = _plan(model, loads)
    head = "".join(f"{line}\n" for line in _model_lines(model, plan))
    steps = "".join(_steps(model, plan, loads, solver, fields))
    with atomic_path(target) as temporary:
        temporary.write_bytes((head + steps).encode("ascii", "replace"))


def find_calculix(executable: str = "ccx") -> str:
    """Path of CalculiX's solver.

    Raises
    ------
    MissingToolError
        There is no such program.
    """
    found = shutil.which(executable)
    if found is None:
        raise MissingToolError(
            f"CalculiX: there is no program {executable!r} on the path: install it with {INSTALL}"
        )
    return found


def run_calculix(path: str | Path, executable: str = "ccx", threads: int = 1) -> Path:
    """Run ccx on a deck; its output stands beside it.

    Parameters
    ----------
    path
        The deck.
    executable
        Name or path of CalculiX's solver.
    threads
        That it may use.

    Returns
    -------
    dat
        The .dat file, for `read_dat` and `read_response`.

    Raises
    ------
    MissingToolError
        There is no such program.
    RuntimeError
        It did not come to its end; the message has what it said last.
    """
    found = find_calculix(executable)
    deck = Path(path).resolve()
    dat = deck.with_suffix(".dat")
    dat.unlink(missing_ok=True)
    wanted = {name: str(threads) for name in ("OMP_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER")}
    done = subprocess.run(
        [found, "-i", deck.stem],
        cwd=deck.parent,
        env=os.environ | wanted,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        check=False,
    )
    if done.returncode != 0 or "*ERROR" in done.stdout or not dat.is_file():
        said = " ".join(line.strip() for line in done.stdout.splitlines()[-12:] if line.strip())
        raise RuntimeError(f"ccx ended with status {done.returncode}: {said}")
    return dat


def read_dat(path: str | Path) -> list[Printed]:
    """Displacements, forces and energies of a .dat file, in the order in which they stand there."""
    text = Path(path).read_text("ascii")
    headers = list(_PRINTED.finditer(text))
    starts = [*(header.start() for header in headers), len(text)]
    found = []
    for header, end in zip(headers, starts[1:], strict=True):
        quantity, name, time = header.groups()
        body = text[header.end() : end]
        width = 1 if quantity.startswith("total") else 4
        # what the project does not ask for may follow: tables begin with words
        body = re.split(r"^ +[A-Za-z]", body, maxsplit=1, flags=re.MULTILINE)[0]
        numbers = np.array(_NO_LETTER.sub(r"E\1", body).split(), dtype=float).reshape(-1, width)
        nodes = numbers[:, 0].astype(np.int64) if width > 1 else np.empty(0, dtype=np.int64)
        values = numbers[:, 1:] if width > 1 else numbers
        found.append(Printed(quantity, name, float(time), nodes, values))
    return found


def read_response(model: Model, path: str | Path, loads: Sequence[str] = LOADS) -> DeckResponse:
    """What a .dat file says about a model, for comparison with `response.unit_load_response`.

    Parameters
    ----------
    model
        The model that the deck was written from.
    path
        The .dat file.
    loads
        Those of its deck.

    Raises
    ------
    InputError
        The file is not complete, or not of this model.
    """
    plan = _plan(model, loads)
    n, n_loads = len(plan.positions), len(loads)
    U, forces = np.zeros((n, 3, n_loads)), np.zeros((n, 3, n_loads))
    energy = {part: np.full(n_loads, np.nan) for part in model.mesh.part_names}
    part_of = {_label(part): part for part in energy}
    seen = np.zeros((n, n_loads), dtype=bool)
    for table in read_dat(path):
        step = round(table.time) - 1
        if not 0 <= step < n_loads or table.nodes.max(initial=0) > n:
            raise InputError(f"{path} is not of this model: write its deck and run it again")
        if table.quantity == "total internal energy":
            if table.set_name in part_of:
                energy[part_of[table.set_name]][step] = table.values[0, 0]
        elif table.quantity == "forces":
            forces[table.nodes - 1, :, step] = table.values
        else:
            U[table.nodes - 1, :, step] = table.values
            seen[table.nodes - 1, step] = True
    wanted = [
        *range(len(model.mesh.points)),
        *(i for pair in plan.references.values() for i in pair),
    ]
    if not seen[wanted].all() or any(np.isnan(values).any() for values in energy.values()):
        raise InputError(f"{path} is not complete: run its deck again, to its last step")
    motions = {
        name: np.concatenate([U[first], U[second]])
        for name, (first, second) in plan.references.items()
    }
    # ccx prints the internal forces of elements, whatever else acts on a node. Less the loads, what
    # is left at freedoms that follow a held one by an equation is carried there.
    flat = plan.T.T @ (forces.reshape(3 * n, n_loads) - plan.loads)
    forces = flat.reshape(forces.shape)
    reactions, base_forces = {}, {}
    for unit in model.scene.bearing_units:
        name = unit.bearing.name
        centre = model.points[f"{name}.seat"].position
        if unit.bedplate is None:
            base = model.mesh.face_nodes(f"{name}.housing.base")
            base_forces[name] = forces[base]
            reactions[name] = -resultant(model.mesh.points[base], forces[base], centre)
        else:
            arm = model.points[f"{name}.base"].position - centre
            carried = _carried_at(model, plan, f"{name}.base", motions, flat)
            reactions[name] = wrench_transport(arm) @ carried
    reactions["gearbox"] = _carried_at(model, plan, "gearbox", motions, flat)
    return DeckResponse(U[: len(model.mesh.points)], motions, reactions, base_forces, energy)


def _carried_at(
    model: Model, plan: _Plan, name: str, motions: Mapping[str, Floats], flat: Floats
) -> Floats:
    """(6, m) what springs to ground and rigid holds carry at a reference point."""
    total = np.zeros_like(motions[name])
    for point, k in model.springs:
        if point.name == name:
            total += k @ motions[name]
    first = np.concatenate([3 * node + np.arange(3) for node in plan.references[name]])
    rigid = list(model.held.get(name, ()))
    total[rigid] -= flat[first[rigid]]
    return total


def four_point_model(model: Model) -> Model:
    """The model with its elements integrated as ccx integrates its C3D10: at four points.

    Four points (degree 2) are exact where edges are straight. In curved elements they are not, so
    that two programs agree to round-off only if both use them.
    """
    mesh = model.mesh
    return replace(
        model,
        part_stiffness={
            part: _four_points(
                mesh.points,
                mesh.cells[mesh.part_cells(part)],
                model.scene.material_of(part).lame,
                model.n_freedoms,
            )
            for part in mesh.part_names
        },
    )


def _four_points(
    points: Floats, cells: Ints, lame: tuple[float, float], n_freedoms: int
) -> sparse.bsr_array:
    gradients, weights = element_kind(cells.shape[1]).table(2)
    pattern = sparsity(cells, n_freedoms // 3)
    data = np.zeros((len(pattern.indices), 3, 3))
    nodes = np.ascontiguousarray(cells, dtype=np.int32)
    every = np.arange(len(cells))
    kernels.add_curved(points, nodes, every, gradients, weights, *lame, pattern.slots, data)
    shape = (n_freedoms, n_freedoms)
    return sparse.bsr_array((data, pattern.indices, pattern.indptr), shape=shape)


def _plan(model: Model, loads: Sequence[str]) -> _Plan:
    """Number the freedoms of the deck, and solve all constraints for the freedoms they give."""
    unknown = [load for load in loads if load not in LOADS]
    if unknown or not loads:
        raise InputError(
            f"{f'load {unknown[0]!r} is unknown' if unknown else 'there is no load'}: use some of "
            f"{', '.join(LOADS)}"
        )
    n_mesh = len(model.mesh.points)
    rigid = {c.name for c in model.constraints if c.name in model.points}
    averaged = [point for name, point in model.points.items() if name not in rigid]
    coupled = [
        (point, value, vector)
        for point, k in model.springs
        if np.abs(k - np.diag(k.diagonal())).max() > 0.0
        for value, vector in zip(*_stretched(k), strict=True)
    ]
    along = model.n_freedoms + 6 * len(averaged)  # first of the coupled springs' own freedoms
    n_freedoms = along + 3 * math.ceil(len(coupled) / 3)
    first = {p.name: model.n_freedoms + 6 * k for k, p in enumerate(averaged)}
    first |= {name: int(model.points[name].motion.indices.min()) for name in rigid}
    reactions = {f"{name} reaction": name for name in model.held}

    constraints = []
    for constraint in model.constraints:
        if constraint.name in reactions:
            # The reference point's own freedom is held, and a freedom of the face follows it.
            name = reactions[constraint.name]
            if name not in rigid:
                own = first[name] + np.array(model.held[name])
                constraints.append(_tied(constraint, own, n_freedoms))
        elif constraint.name not in _fixed_bases(model):
            constraints.append(replace(constraint, rows=_widened(constraint.rows, n_freedoms)))
    for point in averaged:
        free = [c for c in range(6) if c not in model.held.get(point.name, ())]
        own = first[point.name] + np.array(free)
        rows = Constraint(f"{point.name}: mean motion of its face", point.motion[free], own)
        constraints.append(_tied(rows, own, n_freedoms))
    springs = [s for point, k in model.springs for s in _axial(k, first[point.name])]
    for number, (point, value, vector) in enumerate(coupled):
        stretched = sparse.csr_array(vector[None]) @ point.motion
        own = np.array([along + number])
        rows = Constraint(f"{point.name}: what its spring is stretched by", stretched, own)
        constraints.append(_tied(rows, own, n_freedoms))
        springs.append((along + number, value))

    references = {name: (first[name] // 3, first[name] // 3 + 1) for name in model.points}
    names, positions = _extra_nodes(model, references, n_freedoms // 3)
    F = np.zeros((n_freedoms, len(LOADS)))
    F[: model.n_freedoms, 6:9] = model.unit_loads()[:, 6:9]
    F[first["hub"] + np.arange(6), np.arange(6)] = 1.0
    F[first["gearbox"] + 2, 9] = -1.0
    return _Plan(
        positions=np.vstack([model.mesh.points, positions]),
        names={n_mesh + k: name for k, name in enumerate(names)},
        references=references,
        groups=[(c.name, np.asarray(c.pivots)) for c in constraints],
        T=eliminate(constraints, n_freedoms).T,
        held=np.array(
            [first[name] + c for name, some in model.held.items() for c in some], dtype=np.int64
        ),
        springs=springs,
        loads=F[:, [LOADS.index(load) for load in loads]],
    )


def _widened(rows: sparse.csr_array, n_freedoms: int) -> sparse.csr_array:
    return sparse.csr_array((rows.data, rows.indices, rows.indptr), (rows.shape[0], n_freedoms))


def _tied(constraint: Constraint, own: Ints, n_freedoms: int) -> Constraint:
    """Rows that were to vanish equal freedoms of their own instead."""
    m = len(own)
    ties = sparse.csr_array((np.ones(m), (np.arange(m), own)), shape=(m, n_freedoms))
    rows = _widened(constraint.rows.tocsr(), n_freedoms) - ties
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
    kept = np.flatnonzero(values > _LEAST * values[-1])
    return values[kept].tolist(), list(vectors.T[kept])


def _fixed_bases(model: Model) -> list[str]:
    """The housing bases that stand on the ground."""
    return [
        f"{unit.bearing.name}.housing.base"
        for unit in model.scene.bearing_units
        if unit.bedplate is None
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
                    unit.bearing.name
                    for unit in model.scene.bearing_units
                    if re.match(rf"{re.escape(unit.bearing.name)}[ .]", constraint.name)
                ]
                positions[node - n_mesh] = model.points[f"{owners[0]}.seat"].position
    return [name or "auxiliary, of springs" for name in names], positions


def _label(name: str) -> str:
    """A name as the deck has it: capitals, beginning with a letter."""
    label = re.sub(r"[^A-Z0-9_-]", "_", name.upper())
    return label if label[:1].isalpha() else f"N{label}"


def _labels(names: Sequence[str]) -> dict[str, str]:
    """All names as the deck has them.

    Raises
    ------
    InputError
        Two are the same there.
    """
    found: dict[str, str] = {}
    for name in names:
        label = _label(name)
        twin = next((other for other, taken in found.items() if taken == label), None)
        if twin is not None:
            raise InputError(
                f"{twin!r} and {name!r} are both {label!r} in the deck, which has capitals only: "
                "give the bearings names that differ in more than case and punctuation"
            )
        found[name] = label
    return found


def _model_lines(model: Model, plan: _Plan) -> Iterator[str]:
    """The deck up to its first step."""
    mesh = model.mesh
    n_mesh = len(mesh.points)
    rotation = {name: f"{name}.rotation" for name in plan.references}
    own = ["nall", "nreference", "supports", *(f"spring{k + 1}" for k in range(len(plan.springs)))]
    _labels([*own, *mesh.part_names, *mesh.faces, *rotation, *rotation.values()])
    yield from _header(model, plan)
    yield "*NODE, NSET=NALL"
    yield from _node_lines(plan.positions[:n_mesh], 1)
    if n_mesh < len(plan.positions):
        yield "** reference points: displacements and rotations; and what joints need"
        yield "*NODE, NSET=NREFERENCE"
        yield from _node_lines(plan.positions[n_mesh:], n_mesh + 1)
    for part in mesh.part_names:
        chosen = mesh.part_cells(part)
        yield f"*ELEMENT, TYPE=C3D10, ELSET={_label(part)}"
        # VTK's order of the ten nodes is that of C3D10, too
        for row in np.column_stack([chosen + 1, mesh.cells[chosen] + 1]).tolist():
            yield ",".join(map(str, row))
    for number, (freedom, stiffness) in enumerate(plan.springs, 1):
        yield f"*ELEMENT, TYPE=SPRING1, ELSET=SPRING{number}"
        yield f"{len(mesh.cells) + number},{freedom // 3 + 1}"
        yield f"*SPRING, ELSET=SPRING{number}"
        yield f"{freedom % 3 + 1}"
        yield f"{stiffness:.13e}"
    for face in mesh.faces:
        yield from _set_lines(face, mesh.face_nodes(face))
    for name, (move, turn) in plan.references.items():
        yield from _set_lines(name, [move])
        yield from _set_lines(rotation[name], [turn])
    bases = [mesh.face_nodes(face) for face in _fixed_bases(model)]
    following = plan.T.tocsc()[:, plan.held].indices // 3
    yield from _set_lines("supports", np.unique(np.concatenate([*bases, following])))
    for part in mesh.part_names:
        material = model.scene.material_of(part)
        yield f"*MATERIAL, NAME={_label(part)}"
        yield "*ELASTIC"
        yield f"{material.youngs_modulus:.13e},{material.poisson_ratio:.13e}"
        yield "*DENSITY"
        yield f"{material.density:.13e}"
        yield f"*SOLID SECTION, ELSET={_label(part)}, MATERIAL={_label(part)}"
    for name, pivots in plan.groups:
        yield f"** {name}: {len(pivots)} equations"
        if len(pivots):
            yield "*EQUATION"
        for pivot in pivots.tolist():
            yield from _equation(plan.T, pivot)
    yield "*BOUNDARY"
    for face in _fixed_bases(model):
        yield f"{_label(face)},1,3"
    for freedom in plan.held.tolist():
        yield f"{freedom // 3 + 1},{freedom % 3 + 1}"


def _header(model: Model, plan: _Plan) -> Iterator[str]:
    yield f"** {' '.join(model.scene.title.split())}"
    yield f"** written by fe-drivetrain {version('fe-drivetrain')}"
    yield "** units: m, kg, s, N, Pa, rad"
    yield f"** frame: {FRAME}"
    yield "** nodes beside the mesh, whose freedoms 1 to 3 are what is named, along x, y, z:"
    for node, name in plan.names.items():
        if not name.startswith("auxiliary"):
            what = "" if name.endswith("rotations") else ": displacements"
            yield f"**   {node + 1} {name}{what}"
    yield "** every equation gives its first freedom by freedoms that no equation gives"
    yield "** each step is a unit load: hub.F of 1 N, hub.M of 1 N m, gravity of 1 m/s^2 on all"
    yield "**   parts, gearbox.weight of 1 N along -z"
    yield "** forces printed at supports are those of the elements: loads on these nodes are in"
    yield "**   them, and what holds a reference point shows at the nodes that its equations give"


def _node_lines(positions: Floats, first: int) -> Iterator[str]:
    for number, (x, y, z) in enumerate(positions.tolist(), first):
        yield f"{number},{x:.13e},{y:.13e},{z:.13e}"


def _set_lines(name: str, nodes: Ints | Sequence[int]) -> Iterator[str]:
    yield f"*NSET, NSET={_label(name)}"
    numbers = [str(int(node) + 1) for node in nodes]
    for start in range(0, len(numbers), _NODES):
        yield ",".join(numbers[start : start + _NODES])


def _equation(T: sparse.csr_array, pivot: int) -> Iterator[str]:
    """One freedom less what the others make of it is zero."""
    row = slice(T.indptr[pivot], T.indptr[pivot + 1])
    order = np.argsort(T.indices[row])
    columns, values = T.indices[row][order], T.data[row][order]
    kept = np.abs(values) > _LEAST * np.abs(values).max(initial=0.0)
    terms = [(pivot, 1.0), *zip(columns[kept].tolist(), (-values[kept]).tolist(), strict=True)]
    yield str(len(terms))
    texts = [f"{f // 3 + 1},{f % 3 + 1},{value:.13e}" for f, value in terms]
    for start in range(0, len(texts), _TERMS):
        yield ",".join(texts[start : start + _TERMS])


def _steps(
    model: Model, plan: _Plan, loads: Sequence[str], solver: str, fields: bool
) -> Iterator[str]:
    asked = ["*NODE PRINT, NSET=NALL", "U", "*NODE PRINT, NSET=NREFERENCE", "U"]
    asked += ["*NODE PRINT, NSET=SUPPORTS", "RF"]
    for part in model.mesh.part_names:
        asked += [f"*EL PRINT, ELSET={_label(part)}, TOTALS=ONLY", "ELSE"]
    if fields:
        asked += ["*NODE FILE", "U", "*EL FILE", "S"]
    static = f"*STATIC, SOLVER={solver}" if solver else "*STATIC"
    for number, load in enumerate(loads):
        lines = ["*STEP", f"** {load}", static, "*CLOAD, OP=NEW"]
        column = plan.loads[:, number]
        where = np.flatnonzero(column)
        for freedom, value in zip(where.tolist(), column[where].tolist(), strict=True):
            lines.append(f"{freedom // 3 + 1},{freedom % 3 + 1},{value:.13e}")
        yield "\n".join([*lines, *asked, "*END STEP", ""])
