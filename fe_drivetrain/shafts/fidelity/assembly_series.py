"""An assembly of solids on its mesh and on two coarser ones, which give its values their bands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.kept_time import working_time
from fe_drivetrain.common.progress import silent
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.measures import mean_size
from fe_drivetrain.shafts.fidelity.assembly_bands import (
    COARSER,
    AssemblyBand,
    motion_error,
    reaction_error,
)
from fe_drivetrain.shafts.fidelity.change_bands import OnMeshes
from fe_drivetrain.shafts.fidelity.ladder import LevelModel, solved_assembly
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.cached import is_kept
from fe_drivetrain.shafts.response.model import Model, mesh_scene
from fe_drivetrain.shafts.response.neighbours import EVERYTHING, Neighbours, Reuse
from fe_drivetrain.shafts.response.solved_arrays import kept_arrays
from fe_drivetrain.shafts.response.unit_loads import Response


def banded_assembly(
    scene: Scene,
    quantities: Sequence[Quantity],
    report: Callable[[str], object] = silent,
    cache: Cache | None = None,
) -> tuple[LevelModel, float, list[AssemblyBand]]:
    """Solve the assembly, and two on coarser meshes that give its values their bands.

    For the arguments see `assembly_series`.

    Returns
    -------
    LevelModel
        The assembly on the finest mesh.
    float
        Wall time of that alone [s]; where it was kept, that of its solution then.
    list[AssemblyBand]
        Band of each quantity.
    """
    level, seconds, series = assembly_series(scene, quantities, report, cache)
    return level, seconds, [of.band for of in series]


def assembly_series(
    scene: Scene,
    quantities: Sequence[Quantity],
    report: Callable[[str], object] = silent,
    cache: Cache | None = None,
    neighbours: Sequence[Neighbours] | None = None,
) -> tuple[LevelModel, float, list[OnMeshes]]:
    """Solve the assembly on its mesh and on two coarser ones, and estimate its errors.

    Parameters
    ----------
    scene : Scene
        The scene; its mesh sizes are the finest.
    quantities : Sequence[Quantity]
        What is asked for.
    report : callable
        Called with what is being done.
    cache : Cache or None
        Where solutions may come from; the user's if not given.
    neighbours : Sequence[Neighbours] or None
        What designs before have left of each mesh, the coarsest first, see `mesh_neighbours`.

    Returns
    -------
    LevelModel
        The assembly on the finest mesh.
    float
        Wall time of that alone [s]; where it was kept, that of its solution then.
    list[OnMeshes]
        Each quantity on all meshes.
    """
    length = scene.shaft.length
    sizes, levels, factors = [], [], []
    near = [None] * (len(COARSER) + 1) if neighbours is None else neighbours
    for number, factor in enumerate(COARSER, 1):
        report(f"level 4: assembly of solids ({number} of {len(COARSER) + 1})")
        coarser = scene.model_copy(update={"mesh": scene.mesh.scaled(factor)})
        try:
            level, coarse, _ = solved_assembly(coarser, cache, near[number - 1])
        except InputError:  # too coarse for a wall
            continue
        sizes.append(mean_size(coarse.mesh))
        levels.append(level)
        factors.append(factor)
    report(f"level 4: assembly of solids ({len(COARSER) + 1} of {len(COARSER) + 1})")
    start = working_time()
    level, model, response = solved_assembly(scene, cache, near[-1])
    seconds = working_time() - start
    sizes.append(mean_size(model.mesh))
    levels.append(level)
    factors.append(1.0)
    report("level 4: errors estimated from recovered stresses")
    if neighbours is None:
        errors = kept_errors(quantities, model, response, length, cache)
    else:  # whose mesh may be a moved one
        errors = recovered_errors(quantities, model, response, length)
    series = [
        OnMeshes(
            tuple(sizes),
            tuple(quantity.of(level, length) for level in levels),
            error,
            tuple(factors),
        )
        for quantity, error in zip(quantities, errors, strict=True)
    ]
    return level, seconds, series


def solve_coarser(scene: Scene, factor: float) -> None:
    """Solve an assembly on a coarser mesh, for who takes it from the cache later.

    Nothing is done where it is kept already, or nothing can be, nor of a mesh too coarse for a
    wall.

    Parameters
    ----------
    scene : Scene
        The scene.
    factor : float
        On its mesh sizes, as of `COARSER`.
    """
    coarser = scene.model_copy(update={"mesh": scene.mesh.scaled(factor)})
    with suppress(InputError):
        if not is_kept(coarser, mesh_scene(coarser)):
            solved_assembly(coarser)


def mesh_neighbours(reuse: Reuse = EVERYTHING) -> tuple[Neighbours, ...]:
    """Nothing yet of the meshes that `assembly_series` solves an assembly on.

    Parameters
    ----------
    reuse : Reuse
        What of a design is used for the next.
    """
    return tuple(Neighbours(reuse) for _ in range(len(COARSER) + 1))


def recovered_errors(
    quantities: Sequence[Quantity], model: Model, response: Response, length: float
) -> list[Floats]:
    """Errors of the values of an assembly, estimated from recovered stresses.

    What quantities have in common is solved and recovered once.

    Parameters
    ----------
    quantities : Sequence[Quantity]
        What is asked for.
    model, response : Model, Response
        The solved assembly.
    length : float
        Length of the shaft [m], see `Quantity.of`.

    Returns
    -------
    list[Floats]
        (k,) of each quantity, as its values.
    """
    n, found = len(model.loads), dict[int, Floats]()
    together: dict[tuple[str, bytes], list[int]] = {}
    for number, quantity in enumerate(quantities):
        owner = quantity.name.partition(".")[0]
        loads = b"" if owner == "hub" else quantity.columns(length, n).tobytes()
        together.setdefault((owner, loads), []).append(number)
    for (owner, _), numbers in together.items():
        components = [quantities[k].name.rpartition(".")[2] for k in numbers]
        if owner == "hub":
            motions = [MOTIONS.index(c) for c in components]
            errors = motion_error(model, response, np.eye(n)[:, motions]).diagonal()
            given = response.motions["hub"].diagonal()[motions]
            found |= zip(numbers, (errors / given**2)[:, None], strict=True)
        else:
            rows = [FORCES.index(c) for c in components]
            columns = quantities[numbers[0]].columns(length, n)
            each = reaction_error(model, response, owner, rows, columns)
            found |= zip(numbers, each, strict=True)
    return [found[k] for k in range(len(quantities))]


def kept_errors(
    quantities: Sequence[Quantity],
    model: Model,
    response: Response,
    length: float,
    cache: Cache | None = None,
) -> list[Floats]:
    """`recovered_errors` of an assembly on the mesh of its scene, from the cache where they are.

    Parameters
    ----------
    quantities : Sequence[Quantity]
        What is asked for.
    model, response : Model, Response
        The solved assembly.
    length : float
        Length of the shaft [m].
    cache : Cache or None
        Where they may come from; the user's if not given.

    Returns
    -------
    list[Floats]
        (k,) of each quantity.
    """
    n = len(model.loads)
    hub = [q.name.partition(".")[0] == "hub" for q in quantities]
    content = {
        "recovered errors": [
            [q.name, [] if of_hub else q.columns(length, n).tolist()]
            for q, of_hub in zip(quantities, hub, strict=True)
        ],
        "length": length,
    }
    own = {"assembly_series.py", "assembly_bands.py", "quantity.py"}
    rooms = {"fe_drivetrain.shafts.fidelity": own}

    def solve() -> dict[str, Floats]:
        errors = recovered_errors(quantities, model, response, length)
        return {str(k): error for k, error in enumerate(errors)}

    arrays = kept_arrays(model.scene, content, rooms, solve, cache)
    return [arrays[str(k)] for k in range(len(quantities))]
