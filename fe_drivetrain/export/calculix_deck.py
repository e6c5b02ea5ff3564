"""CalculiX: a model of a scene as a complete input deck.

The deck has elements, materials, interfaces as linear equations, supports, springs, and
each unit load as a step. Its keywords are those that CalculiX shares with Abaqus; it is tested with
CalculiX. Degrees of freedom and equations are those of `calculix_plan`.
"""

import warnings
from collections.abc import Iterator, Sequence
from importlib.metadata import version
from pathlib import Path

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.elasticity.operator.incompressible import warn_of_averaging
from fe_drivetrain.export.calculix_plan import (
    ROUND_OFF,
    DeckPlan,
    deck_label,
    fixed_bases,
    plan_deck,
)
from fe_drivetrain.export.superelement import FRAME
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.shafts.response.model import Model

_TERMS = 4  # of an equation on a line: the most that are read
_NODES = 16  # of a set on a line


def write_inp(
    model: Model,
    path: str | Path,
    loads: Sequence[str] | None = None,
    solver: str = "",
    fields: bool = True,
) -> None:
    """Write a model with its unit loads as an input deck; the same model gives the same bytes.

    Parameters
    ----------
    model : Model
        The model.
    path : str or Path
        The file, which appears whole or not at all; CalculiX wants it to end in ``.inp``.
    loads : Sequence[str] or None
        Which unit loads, a step each, all where not given: ccx factorises again for every step.
    solver : str
        Solver of CalculiX, as in "SPOOLES"; its own choice where not given.
    fields : bool
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
    loads = model.loads if loads is None else loads
    plan = plan_deck(model, loads)
    head = "".join(f"{line}\n" for line in _model_lines(model, plan))
    steps = "".join(_steps(model, plan, loads, solver, fields))
    with atomic_path(target) as temporary:
        temporary.write_bytes((head + steps).encode("ascii", "replace"))


def _labels(names: Sequence[str]) -> dict[str, str]:
    """All names as the deck has them.

    Raises
    ------
    InputError
        Two are the same there.
    """
    found: dict[str, str] = {}
    for name in names:
        label = deck_label(name)
        twin = next((other for other, taken in found.items() if taken == label), None)
        if twin is not None:
            raise InputError(
                f"{twin!r} and {name!r} are both {label!r} in the deck, which has capitals only: "
                "give the bearings names that differ in more than case and punctuation"
            )
        found[name] = label
    return found


def _model_lines(model: Model, plan: DeckPlan) -> Iterator[str]:
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
        yield f"*ELEMENT, TYPE=C3D10, ELSET={deck_label(part)}"
        # VTK's order of the ten nodes is that of C3D10, too
        for row in np.column_stack([chosen + 1, mesh.cells[chosen] + 1]).tolist():
            yield ",".join(map(str, row))
    for number, (dof, stiffness) in enumerate(plan.springs, 1):
        yield f"*ELEMENT, TYPE=SPRING1, ELSET=SPRING{number}"
        yield f"{len(mesh.cells) + number},{dof // 3 + 1}"
        yield f"*SPRING, ELSET=SPRING{number}"
        yield f"{dof % 3 + 1}"
        yield f"{stiffness:.13e}"
    for face in mesh.faces:
        yield from _set_lines(face, mesh.face_nodes(face))
    for name, (move, turn) in plan.references.items():
        yield from _set_lines(name, [move])
        yield from _set_lines(rotation[name], [turn])
    bases = [mesh.face_nodes(face) for face in fixed_bases(model)]
    following = plan.T.tocsc()[:, plan.held].indices // 3
    yield from _set_lines("supports", np.unique(np.concatenate([*bases, following])))
    for part in mesh.part_names:
        material = model.scene.material_of(part)
        yield f"*MATERIAL, NAME={deck_label(part)}"
        yield "*ELASTIC"
        yield f"{material.youngs_modulus:.13e},{material.poisson_ratio:.13e}"
        yield "*DENSITY"
        yield f"{material.density:.13e}"
        yield f"*SOLID SECTION, ELSET={deck_label(part)}, MATERIAL={deck_label(part)}"
    for name, pivots in plan.groups:
        yield f"** {name}: {len(pivots)} equations"
        if len(pivots):
            yield "*EQUATION"
        for pivot in pivots.tolist():
            yield from _equation(plan.T, pivot)
    yield "*BOUNDARY"
    for face in fixed_bases(model):
        yield f"{deck_label(face)},1,3"
    for dof in plan.held.tolist():
        yield f"{dof // 3 + 1},{dof % 3 + 1}"


def _header(model: Model, plan: DeckPlan) -> Iterator[str]:
    yield f"** {' '.join(model.scene.title.split())}"
    yield f"** scene hash: {drivetrain_hash(model.scene)}"
    yield f"** written by fe-drivetrain {version('fe-drivetrain')}"
    yield "** units: m, kg, s, N, Pa, rad"
    yield f"** frame: {FRAME}"
    yield "** nodes beside the mesh, whose degrees of freedom 1 to 3 are what is named, along x, y,"
    yield "** z:"
    for node, name in plan.names.items():
        if not name.startswith("auxiliary"):
            what = "" if name.endswith("rotations") else ": displacements"
            yield f"**   {node + 1} {name}{what}"
    yield "** every equation gives its first degree of freedom by ones that no equation gives"
    yield "** each step is a unit load: hub.F of 1 N, hub.M of 1 N m, gravity of 1 m/s^2 on all"
    yield "**   parts, gearbox.weight of 1 N along -z"
    yield "** forces printed at supports are those of the elements: loads on these nodes are in"
    yield "**   them, and what holds a reference point shows at the nodes that its equations give"


def _node_lines(positions: Floats, first: int) -> Iterator[str]:
    for number, (x, y, z) in enumerate(positions.tolist(), first):
        yield f"{number},{x:.13e},{y:.13e},{z:.13e}"


def _set_lines(name: str, nodes: Ints | Sequence[int]) -> Iterator[str]:
    yield f"*NSET, NSET={deck_label(name)}"
    numbers = [str(int(node) + 1) for node in nodes]
    for start in range(0, len(numbers), _NODES):
        yield ",".join(numbers[start : start + _NODES])


def _equation(T: sparse.csr_array, pivot: int) -> Iterator[str]:
    """One degree of freedom less what the others make of it is zero."""
    row = slice(T.indptr[pivot], T.indptr[pivot + 1])
    order = np.argsort(T.indices[row])
    columns, values = T.indices[row][order], T.data[row][order]
    kept = np.abs(values) > ROUND_OFF * np.abs(values).max(initial=0.0)
    terms = [(pivot, 1.0), *zip(columns[kept].tolist(), (-values[kept]).tolist(), strict=True)]
    yield str(len(terms))
    texts = [f"{f // 3 + 1},{f % 3 + 1},{value:.13e}" for f, value in terms]
    for start in range(0, len(texts), _TERMS):
        yield ",".join(texts[start : start + _TERMS])


def _steps(
    model: Model, plan: DeckPlan, loads: Sequence[str], solver: str, fields: bool
) -> Iterator[str]:
    asked = ["*NODE PRINT, NSET=NALL", "U", "*NODE PRINT, NSET=NREFERENCE", "U"]
    asked += ["*NODE PRINT, NSET=SUPPORTS", "RF"]
    for part in model.mesh.part_names:
        asked += [f"*EL PRINT, ELSET={deck_label(part)}, TOTALS=ONLY", "ELSE"]
    if fields:
        asked += ["*NODE FILE", "U", "*EL FILE", "S"]
    static = f"*STATIC, SOLVER={solver}" if solver else "*STATIC"
    for number, load in enumerate(loads):
        lines = ["*STEP", f"** {load}", static, "*CLOAD, OP=NEW"]
        column = plan.loads[:, number]
        where = np.flatnonzero(column)
        for dof, value in zip(where.tolist(), column[where].tolist(), strict=True):
            lines.append(f"{dof // 3 + 1},{dof % 3 + 1},{value:.13e}")
        yield "\n".join([*lines, *asked, "*END STEP", ""])
