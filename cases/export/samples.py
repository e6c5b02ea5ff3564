"""Superelements that the export cases write, and their natural frequencies."""

import numpy as np
from scipy.linalg import eigh

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene, library_scene
from fe_drivetrain.export import Superelement, superelement_of
from fe_drivetrain.report import shaft_with_rings
from fe_drivetrain.report.suite import Page, Run

#: Name of the shaft among them.
FREE = "free shaft"
SCENE = "two_bearings"

#: Coarsening of the bearing's mesh: its matrix is written, whatever it is.
FACTOR = 2.0


def samples(run: Run) -> dict[str, Superelement]:
    """The free shaft with its mass, and the first bearing in its housing, of a library scene.

    A quick run has the shaft alone.
    """
    scene = library_scene(SCENE)
    scene = scene.model_copy(update={"mesh": scene.mesh.scaled(FACTOR)})
    found = {FREE: run.timed(FREE, superelement_of, scene, "shaft")}
    if not run.quick:
        bearing = scene.bearing_units[0].bearing.name
        label = "bearing with housing"
        found[label] = run.timed(label, superelement_of, scene, bearing)
    return found


def show(run: Run, page: Page, scene: Scene | None = None) -> None:
    """A picture of what is written: the shaft of a scene, here of `samples`, with its bearings."""
    scene = scene or library_scene(SCENE)
    title = "The shaft that is written, and the rings of the bearings on it"
    page.image(title, run.sketch(*shaft_with_rings(scene)))


def matrices(element: Superelement) -> dict[str, Floats]:
    """Its stiffness, and its mass if it has one."""
    found = {"stiffness": element.stiffness}
    return found if element.mass is None else found | {"mass": element.mass}


def frequencies(stiffness: Floats, mass: Floats, count: int) -> Floats:
    """The lowest natural frequencies other than those of rigid motions [Hz]."""
    size = 1.0 / np.sqrt(np.outer(mass.diagonal(), mass.diagonal()))
    squares = eigh(stiffness * size, mass * size, eigvals_only=True)
    elastic = squares[squares > 1e-6 * squares[-1]]
    return np.asarray(np.sqrt(elastic[:count]) / (2.0 * np.pi))
