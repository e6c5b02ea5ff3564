"""Results of CalculiX: tables of a .dat file, and the response of a deck's model."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.regular_files import text_of
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import resultant, wrench_transport
from fe_drivetrain.export.calculix_plan import DeckPlan, deck_label, plan_deck
from fe_drivetrain.shafts.response.model import Model

DIGITS = 7
"""Significant digits in a .dat file (Fortran's 1p,e13.6)."""

ROUNDING = 0.5 * 10.0 ** (1 - DIGITS)
"""Largest relative rounding error of a number in a .dat file."""

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
    quantity : str
        "displacements", "forces" or "total internal energy".
    set_name : str
        Name of the set of nodes or elements.
    time : float
        Total time, which counts the steps.
    nodes : Ints
        (n,) node numbers of the deck, from 1 on; empty for totals.
    values : Floats
        (n, 3) [m, N], or (1, 1) [J].
    """

    quantity: str
    set_name: str
    time: float
    nodes: Ints
    values: Floats


@dataclass(frozen=True)
class DeckResponse:
    """Response of ccx to the m unit loads of a deck, one load a column.

    As in `response.Response`, in the digits of the .dat file.

    Attributes
    ----------
    displacements : Floats
        (n_nodes, 3, m) [m].
    motions : Mapping[str, Floats]
        (6, m) by reference point [m, rad].
    reactions : Mapping[str, Floats]
        (6, m) by name, "NAME" of each bearing and "gearbox": what the drivetrain puts on its
        surroundings [N, N m]; moments about the bearing's centre, or the gearbox.
    base_forces : Mapping[str, Floats]
        (n, 3, m) by bearing: forces that the support puts on the nodes of the housing's base,
        in the order of ``mesh.face_nodes`` [N].
    strain_energy : Mapping[str, Floats]
        (m,) by part [J].
    """

    displacements: Floats
    motions: Mapping[str, Floats]
    reactions: Mapping[str, Floats]
    base_forces: Mapping[str, Floats]
    strain_energy: Mapping[str, Floats]

    __repr__ = short_repr


def read_dat(path: str | Path) -> list[Printed]:
    """Displacements, forces and energies of a .dat file, in the order of the file."""
    text = text_of(path, encoding="ascii")
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


def read_response(
    model: Model, path: str | Path, loads: Sequence[str] | None = None
) -> DeckResponse:
    """Response of a model from a .dat file, for comparison with `response.unit_load_response`.

    Parameters
    ----------
    model : Model
        The model that the deck was written from.
    path : str or Path
        The .dat file.
    loads : Sequence[str] or None
        Those of its deck; all where not given.

    Raises
    ------
    InputError
        The file is not complete, or not of this model.
    """
    loads = model.loads if loads is None else loads
    plan = plan_deck(model, loads)
    n, n_loads = len(plan.positions), len(loads)
    U, forces = np.zeros((n, 3, n_loads)), np.zeros((n, 3, n_loads))
    energy = {part: np.full(n_loads, np.nan) for part in model.mesh.part_names}
    part_of = {deck_label(part): part for part in energy}
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
    # is left at degrees of freedom that follow a held one by an equation is carried there.
    flat = plan.T.T @ (forces.reshape(3 * n, n_loads) - plan.loads)
    forces = flat.reshape(forces.shape)
    reactions, base_forces = {}, {}
    for unit in model.scene.bearing_units:
        name = unit.bearing.name
        centre = model.points[f"{name}.seat"].position
        standing = model.standing(name)
        if not standing:
            base = model.mesh.face_nodes(f"{name}.housing.base")
            base_forces[name] = forces[base]
            reactions[name] = -resultant(model.mesh.points[base], forces[base], centre)
        else:
            reactions[name] = np.zeros((6, n_loads))
            for key in standing:
                arm = model.points[key].position - centre
                carried = _carried_at(model, plan, key, motions, flat)
                reactions[name] += wrench_transport(arm) @ carried
    for bearing in model.scene.nose_bearings:
        reactions[bearing.name] = _carried_at(model, plan, f"{bearing.name}.joint", motions, flat)
    reactions["gearbox"] = _carried_at(model, plan, "gearbox", motions, flat)
    return DeckResponse(U[: len(model.mesh.points)], motions, reactions, base_forces, energy)


def _carried_at(
    model: Model, plan: DeckPlan, name: str, motions: Mapping[str, Floats], flat: Floats
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
