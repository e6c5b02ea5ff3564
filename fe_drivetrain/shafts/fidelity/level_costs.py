"""What each level of the ladder will take for a scene: unknowns, seconds, memory.

Levels without a large system are run, for they take less than a forecast could save. Of the others
the systems are made and the solver's cost is predicted
(`fe_drivetrain.elasticity.solve.cost_model`).
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Ints
from fe_drivetrain.elasticity.interfaces.constraints import eliminate, fixed
from fe_drivetrain.elasticity.operator.incompressible import assemble_materials
from fe_drivetrain.elasticity.solve.cost_model import predict
from fe_drivetrain.elasticity.solve.reduction import System, reduce
from fe_drivetrain.shafts.fidelity.ladder import TITLES, shaft_level, statics_level
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft
from fe_drivetrain.shafts.response.model import Model

_BOUNDS = 2  # of a unit's stiffness: its face in shape, and on average
_OF_A_POINT = 6  # right-hand sides


@dataclass(frozen=True)
class Forecast:
    """What a level takes.

    Attributes
    ----------
    level : int
        0 to 4.
    title : str
        Title of the level, with what its housings are.
    unknowns : int
        Number of unknowns of its largest system.
    seconds : float
        Duration of the solution, without mesh and assembly where predicted.
    bytes : float or None
        Memory of its largest system, with what the solver keeps; None where it was run.
    solver : str
        That is predicted to be fastest; empty where the level was run.
    fits : bool
        Whether there is the memory for it now.
    """

    level: int
    title: str
    unknowns: int
    seconds: float
    bytes: float | None
    solver: str
    fits: bool


def forecast(model: Model) -> list[Forecast]:
    """What the levels of the ladder take, from cheap to expensive.

    Units are solved apart on nearly the mesh that they have in the assembly, so their cost is
    predicted from that.

    Parameters
    ----------
    model : Model
        The assembled model of the scene, see `fe_drivetrain.shafts.response.build_model`.

    Returns
    -------
    list of Forecast

    Raises
    ------
    InputError
        A level refuses the scene.
    """
    scene = model.scene
    statics, beam = statics_level(scene), shaft_level(scene, 1)
    start = time.perf_counter()
    body = condensed_shaft(scene, 2)
    meridian = shaft_level(scene, 2, body=body)
    seconds = time.perf_counter() - start
    units = []
    for unit in scene.bearing_units:
        name = unit.bearing.name
        if unit.condensed is not None or name in scene.guests:
            continue
        parts = [*([name] if unit.ring_on_housing else []), *unit.housing_parts]
        for other in next((g[1:] for g in scene.coupled_units if g[0] == name), ()):
            parts += scene.bearing_unit(other).housing_parts
        system = _of_parts(model, parts, model.mesh.face_nodes(f"{name}.housing.base"))
        units.append(_predicted(1, TITLES[1], system, _OF_A_POINT))
    if units:
        on_springs = [
            _together(
                level,
                f"{TITLES[level]}, housings as springs between two bounds",
                units,
                own,
                _BOUNDS,
            )
            for level, own in ((1, beam.cost.seconds), (2, seconds))
        ]
    else:
        on_springs = [Forecast(2, meridian.title, meridian.cost.unknowns, seconds, None, "", True)]
    rings = [u.bearing.name for u in scene.bearing_units]
    solids = {"shaft": ["shaft", *rings]} | ({} if scene.nose is None else {"nose": ["nose"]})
    alone = [
        _predicted(
            3,
            f"solid {part}",
            _of_parts(model, parts, model.mesh.face_nodes(f"{part}.rear")),
            _OF_A_POINT * len(body.names),
        )
        for part, parts in solids.items()
    ]
    elimination = eliminate(model.constraints, model.n_dofs)
    whole = reduce(model.mesh.points, model.mesh.cells, model.stiffness, elimination, model.springs)
    return [
        Forecast(0, statics.title, statics.cost.unknowns, statics.cost.seconds, None, "", True),
        Forecast(1, beam.title, beam.cost.unknowns, beam.cost.seconds, None, "", True),
        *on_springs,
        _together(3, f"{' and '.join(one.title for one in alone)} alone", alone),
        _predicted(4, TITLES[4], whole, len(model.loads) + 1),
    ]


def _together(
    level: int, title: str, solved: Sequence[Forecast], more: float = 0.0, times: int = 1
) -> Forecast:
    """What several systems take, one after the other, each so many times; and more seconds."""
    largest = max(solved, key=lambda one: one.unknowns)
    return Forecast(
        level,
        title,
        largest.unknowns,
        times * sum(one.seconds for one in solved) + more,
        largest.bytes,
        largest.solver,
        all(one.fits for one in solved),
    )


def _predicted(level: int, title: str, system: System, n_rhs: int) -> Forecast:
    best = predict(system, n_rhs)[0]
    K = system.K
    held = K.data.nbytes + K.indices.nbytes + K.indptr.nbytes
    return Forecast(
        level, title, system.n_free, best.seconds, held + best.bytes, best.method, best.fits
    )


def _of_parts(model: Model, parts: Sequence[str], held: Ints) -> System:
    """The system of some parts alone, held at some of their nodes."""
    mesh = model.mesh
    of_parts = [mesh.cells[mesh.part_cells(part)] for part in parts]
    cells = np.concatenate(of_parts)
    nodes, local = np.unique(cells, return_inverse=True)
    local, points, n = local.reshape(cells.shape), mesh.points[nodes], 3 * len(nodes)
    owner = np.repeat(np.arange(len(parts)), [len(of) for of in of_parts])
    materials = [(owner == k, model.scene.material_of(part).lame) for k, part in enumerate(parts)]
    base = fixed("held", np.searchsorted(nodes, np.intersect1d(held, nodes)), n)
    K = assemble_materials(points, local, materials, n)
    return reduce(points, local, K, eliminate([base], n), overwrite=True)
