"""Natural frequencies of a condensed shaft, and of the solids that nothing was condensed of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy import linalg

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.operator.mass import mass_matrix
from fe_drivetrain.elasticity.solve.condensation import on_supports
from fe_drivetrain.elasticity.solve.vibration import held_modes
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.prepared import prepared


def natural_frequencies(
    points: Sequence[str],
    stiffness: Floats,
    mass: Floats,
    supports: Mapping[str, Floats] | None = None,
    inertia: Mapping[str, Floats] | None = None,
) -> Floats:
    """Natural frequencies, ascending, those of free motions among them as about 0 [Hz].

    Parameters
    ----------
    points, stiffness, supports : Sequence[str], Floats, Mapping[str, Floats] or None
        The same as for `condensation.on_supports`.
    mass : Floats
        Mass of the same degrees of freedom as the stiffness.
    inertia : Mapping[str, Floats] or None
        (6, 6) mass of supports that moves with a point [kg, kg m, kg m^2], by point, as of
        `fe_drivetrain.shafts.fidelity.unit_matrices`.

    Raises
    ------
    InputError
        A support or its mass is at no point.
    """
    K, left = on_supports(points, stiffness, supports or {})
    M = with_inertia(points, mass, inertia or {})[np.ix_(left, left)]
    # lengths and angles, points and modes equally: a unit diagonal keeps the digits of all
    values = linalg.eigh(
        scaled_to_unit_diagonal(K, M.diagonal()), scaled_to_unit_diagonal(M), eigvals_only=True
    )
    return np.asarray(np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi))


def with_inertia(points: Sequence[str], mass: Floats, inertia: Mapping[str, Floats]) -> Floats:
    """A mass with that of supports added.

    Parameters
    ----------
    points : Sequence[str]
        Names of n points.
    mass : Floats
        (6 n + m, 6 n + m): six degrees of freedom of each point first, then m of anything.
    inertia : Mapping[str, Floats]
        (6, 6) by point [kg, kg m, kg m^2].

    Raises
    ------
    InputError
        A mass is at no point.
    """
    M = np.array(mass)
    for name, own in inertia.items():
        if name not in points:
            raise InputError(
                f"mass of {name!r} is at none of the points {', '.join(points)}: keep its point"
            )
        rows = slice(6 * points.index(name), 6 * points.index(name) + 6)
        M[rows, rows] += own
    return M


def assembly_frequencies(scene: Scene, count: int) -> Floats:
    """The lowest natural frequencies [Hz] of a scene's solids, shaft and housings, not condensed.

    They are from above: those of the mesh, which is too stiff. For small models, as reference.

    Parameters
    ----------
    scene : Scene
        The scene; its weights and hub have no inertia, nor have springs.
    count : int
        How many.

    Returns
    -------
    Floats
        (count,) ascending.
    """
    model = build_model(scene, mesh_scene(scene))
    mesh = model.mesh
    found = prepared(model, "auto", 4 * count)
    M = sum(
        mass_matrix(
            mesh.points,
            mesh.cells[mesh.part_cells(part)],
            scene.material_of(part).density,
            model.n_dofs,
        )
        for part in mesh.part_names
    )
    values, _ = held_modes(found.solver, found.elimination, M, count)
    return np.asarray(np.sqrt(values) / (2.0 * np.pi))
