"""Checks of the models of a study: equilibrium, linearity, balance, and what statics decides."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.shafts.fidelity.ladder import statics_level
from fe_drivetrain.shafts.fidelity.over_loads import Levels, imbalance
from fe_drivetrain.shafts.response.unit_loads import Response


def check_solution(found: Findings, response: Response, label: str) -> None:
    """Check equilibrium and linearity of a solution.

    Parameters
    ----------
    found : Findings
        Takes the checks.
    response : Response
        Unit loads on an assembly.
    label : str
        What the checks call it.
    """
    found.vanishes(
        f"{label}: total equilibrium, applied less reacted",
        response.equilibrium_error,
        within=1e-8,
        why="reactions come from the residual on constrained degrees of freedom: solver accuracy",
        source="exact",
    )
    found.vanishes(
        f"{label}: linearity, a random load solved directly against superposed",
        response.superposition_error,
        within=1e-8,
        why="the scene is linear: solver accuracy",
        source="exact",
    )


def check_models(found: Findings, scene: Scene, response: Response, levels: Levels) -> None:
    """Check equilibrium and linearity of the assembly, and the balance of every level.

    Parameters
    ----------
    found : Findings
        Takes the checks.
    scene : Scene
        The scene.
    response : Response
        Unit loads on its assembly.
    levels : Levels
        Every model.
    """
    check_solution(found, response, "assembly")
    found.vanishes(
        "every level: reactions to unit hub loads balance the load, the worst",
        max(imbalance(scene, model) for model in levels.models.values()),
        within=1e-6,
        why="each level must be in equilibrium, whatever its stiffness",
        source="statics",
    )
    worst, count = statics_error(scene, response)
    if count:
        found.vanishes(
            f"{count} reactions to unit hub loads that statics decides, assembly against statics",
            worst,
            within=1e-6,
            why="solver accuracy; the nodes of a curved raceway meet at its centre to the mesh's "
            "order",
            source="statics: what has no stiffness in it",
        )


def statics_error(scene: Scene, response: Response) -> tuple[float, int]:
    """Largest error of the reactions to unit hub loads that equilibrium alone decides.

    Parameters
    ----------
    scene : Scene
        The scene.
    response : Response
        Unit loads on its assembly.

    Returns
    -------
    worst, count : float, int
        Error, relative to a unit load with moments divided by the length of the shaft, and how
        many of these reactions are not zero.
    """
    worst, count = 0.0, 0
    size = np.array([1.0, 1.0, 1.0, *3 * (scene.shaft.length,)])
    for name, matrix in statics_level(scene).reaction_matrices.items():
        exact = matrix[:, :6]
        known = np.isfinite(exact)
        count += int((known & (exact != 0.0)).sum())
        error = np.abs(response.reactions[name][:, :6] - exact)[known]
        scale = np.outer(size, 1.0 / size)[known]
        worst = max(worst, float((error / scale).max(initial=0.0)))
    return worst, count
