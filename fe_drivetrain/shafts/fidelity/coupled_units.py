"""Bearing units that stand on the same parts, condensed together to one spring to the ground.

Bearings, housings and the parts under them are one solid, solved without the shaft for unit loads
at all bearings at once: what one housing carries moves the other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.drivetrain_file.joint_springs import joint_stiffness
from fe_drivetrain.drivetrain_file.scene import Coupling, Scene
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.interfaces.joints import in_series
from fe_drivetrain.elasticity.solve.coupled_solid import coupled_solid, point_motions_of
from fe_drivetrain.shafts.fidelity.unit_faces import (
    attached,
    face_of,
    parts_left_out,
    without_shaft,
)
from fe_drivetrain.shafts.response.cached import solved_content
from fe_drivetrain.shafts.response.solved_arrays import kept_together


def coupled_stiffness(
    scene: Scene,
    group: Sequence[str],
    coupling: Coupling = "averaged",
    method: str = "auto",
    ring: bool = True,
    cache: Cache | None = None,
) -> dict[str, Floats]:
    """Stiffness of bearing units on the same parts, solved together without the shaft.

    Parameters
    ----------
    scene : Scene
        The scene.
    group : Sequence[str]
        Names of the k bearings, one of `scene.coupled_units`.
    coupling, method, ring, cache : Coupling, str, bool, Cache or None
        See `fe_drivetrain.shafts.fidelity.bearing_units.unit_stiffness`.

    Returns
    -------
    dict[str, Floats]
        (6, 6 k) by bearing: rows of the stiffness at all k centres, in the order of the group, of
        joints and solids in series [N/m, N, N m/rad].
    """
    ways = {name: face_of(scene, name, ring, coupling) for name in group}
    content = {"coupled stiffness of": list(group), "ways": ways, "method": method}
    depends = solved_content(scene) | {"shaft": [scene.seat_diameter(name) for name in group]}
    rooms = {"fe_drivetrain.shafts.fidelity": {"bearing_units.py", "coupled_units.py"}}

    def solved() -> list[dict[str, Floats]]:
        return [{"0": _solved(scene, ways, method)}]

    (found,) = kept_together(scene, [content], rooms, solved, cache, depends)
    return dict(zip(group, np.split(found["0"], len(group)), strict=True))


def _solved(scene: Scene, ways: dict[str, tuple[bool, Coupling]], method: str) -> Floats:
    """(6 k, 6 k) stiffness of k units at their centres."""
    together, parts = without_shaft(scene, {name: ring for name, (ring, _) in ways.items()})
    mesh, at = together.mesh, [attached(scene, name, *way) for name, way in ways.items()]
    solid = coupled_solid(mesh, {part: scene.material_of(part) for part in parts}, at)
    bases = [base for name in ways if (base := f"{name}.housing.base") in mesh.faces]
    held = [constraints.fixed(base, mesh.face_nodes(base), solid.n_dofs) for base in bases]
    held += [parts_left_out(solid, at), *together.conditions(solid.n_dofs)]
    stiffness = np.linalg.inv(point_motions_of(solid, held, (), method)[1])
    joints = np.zeros(stiffness.shape)
    for k, name in enumerate(ways):
        rows = slice(6 * k, 6 * k + 6)
        joints[rows, rows] = joint_stiffness(scene.bearing_unit(name))
    return in_series(0.5 * (stiffness + stiffness.T), joints)
