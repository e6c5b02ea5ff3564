"""Superelements that the export cases write, and how two matrices are compared."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.export import Superelement, superelement_of
from fe_drivetrain.scene import library_scene
from fe_drivetrain.suite import Run

SCENE = "two_bearings"

#: Coarsening of the bearing's mesh: its matrix is written, whatever it is.
FACTOR = 2.0


def samples(run: Run) -> dict[str, Superelement]:
    """The free shaft with its mass, and the first bearing in its housing, of a library scene.

    A quick run has the shaft alone.
    """
    scene = library_scene(SCENE)
    scene = scene.model_copy(update={"mesh": scene.mesh.scaled(FACTOR)})
    with run.step("free shaft"):
        shaft = superelement_of(scene, "shaft")
    if run.quick:
        return {"free shaft": shaft}
    with run.step("bearing with housing"):
        bearing = superelement_of(scene, scene.bearing_units[0].bearing.name)
    return {"free shaft": shaft, "bearing with housing": bearing}


def difference(found: Floats, expected: Floats) -> float:
    """Largest difference, of a unit diagonal: lengths and angles count alike."""
    diagonal = expected.diagonal()
    size = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    return float(np.abs((found - expected) / np.outer(size, size)).max())


def frequencies(stiffness: Floats, mass: Floats, count: int) -> Floats:
    """The lowest natural frequencies other than those of rigid motions [Hz]."""
    from scipy.linalg import eigh

    size = 1.0 / np.sqrt(np.outer(mass.diagonal(), mass.diagonal()))
    squares = eigh(stiffness * size, mass * size, eigvals_only=True)
    elastic = squares[squares > 1e-6 * squares[-1]]
    return np.asarray(np.sqrt(elastic[:count]) / (2.0 * np.pi))
