"""The library's two main-bearing scenes, on coarse meshes: balances hold on any mesh."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene, library_scene
from fe_drivetrain.elasticity.mesh import Mesh
from fe_drivetrain.report.suite import Run
from fe_drivetrain.shafts.response import Model, Response, build_model, cached_response, mesh_scene

KINDS = ("spherical", "bonded")

#: Factor on the library's mesh sizes, and that of a quick run.
COARSER, QUICK = 2.0, 3.0


def meshed(run: Run, kind: str, factor: float | None = None) -> tuple[Scene, Mesh]:
    """One of the scenes with its mesh; the factor on the sizes is that of the run if not given."""
    scene = library_scene(f"main_bearing_{kind}")
    sizes = scene.mesh.scaled(factor or (QUICK if run.quick else COARSER))
    scene = scene.model_copy(update={"mesh": sizes})
    with run.step(f"mesh ({kind})"):
        return scene, mesh_scene(scene)


def solved(run: Run, kind: str) -> tuple[Model, Response]:
    """One of the scenes with its response to unit loads."""
    scene, mesh = meshed(run, kind)
    with run.step(f"assembly and solve ({kind})") as step:
        model = build_model(scene, mesh)
        response = cached_response(model)
        if response.kept:
            step.name += ", from the cache"
    return model, response


def work(model: Model, response: Response) -> Floats:
    """(10, 10) work of each unit load (row) on the displacements under each other (column) [J].

    The loads themselves on the displacements of the nodes: no stiffness is in it.

    Raises
    ------
    ValueError
        The scene has reference points with degrees of freedom of their own.
    """
    F = model.unit_loads()
    U = response.displacements.reshape(-1, F.shape[1])
    if len(U) != len(F):
        raise ValueError("work is summed over nodes: couple hub and gearbox by averages")
    return np.asarray(F.T @ U)
