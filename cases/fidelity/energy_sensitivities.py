"""Sensitivity of a solved assembly to its moduli and springs, from its strain energy alone.

With displacements U under unit loads F, compliance C = F^T U = U^T K U, and a part's stiffness
proportional to its modulus E, the adjoint of a compliance is the solution itself:

    dC / d ln E = -U^T K_part U,

less the part's share of strain energy (Haftka and Guerdal 1992, Elements of Structural
Optimization, 7.2). No further solution is needed, whatever the number of parts. Shares add up to
the whole: stiffness is homogeneous of degree one in all moduli and springs together (Euler).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.shafts.response.model import LOADS, Model
from fe_drivetrain.shafts.response.unit_loads import Response


def compliance(response: Response) -> Floats:
    """(7, 10) work of the hub's unit loads, and of the gearbox's weight, on what each load does."""
    return np.vstack([response.motions["hub"], -response.motions["gearbox"][2]])


def energy_slopes(model: Model, response: Response) -> dict[str, Floats]:
    """Derivative of the compliance between unit loads by the logarithm of each value.

    Parameters
    ----------
    model, response : Model, Response
        A solved scene.

    Returns
    -------
    slopes
        (10, 10) by dotted key of the scene: moduli of materials, springs of the gearbox, of
        bedplates and of bearings on a nose one by one, a 6x6 joint and rollers as a whole.
    """
    found: dict[str, Floats] = {}

    def add(key: str, energy: Floats) -> None:
        found[key] = found.get(key, np.zeros_like(energy)) - energy

    scene = model.scene
    for part, energy in response.strain_energy.items():
        add(f"materials.{scene.material_name(part)}.youngs_modulus", energy)
    on_nose = [bearing.name for bearing in scene.nose_bearings]
    for point, k in model.springs:
        moved = response.motions[point.name]
        name, _, kind = point.name.partition(".")
        if kind in ("", "base") or name in on_nose:
            where = f"bearing_units.{name}.bedplate" if kind else "gearbox.stiffness"
            if name in on_nose:
                where = f"nose.bearings.{on_nose.index(name)}.stiffness"
            for c in np.flatnonzero(k.diagonal()).tolist():
                add(f"{where}.{c}", k[c, c] * np.outer(moved[c], moved[c]))
        else:
            where = "stiffness" if kind == "joint" else "rollers.stiffness"
            add(f"bearing_units.{name}.{where}", moved.T @ k @ moved)
    return found


def hub_elasticities(model: Model, response: Response) -> dict[str, Floats]:
    """(6,) relative change of each hub stiffness, all other loads zero, for that of each value."""
    given = compliance(response)[:, :6].diagonal()
    return {
        key: -slope[:6, :6].diagonal() / given
        for key, slope in energy_slopes(model, response).items()
    }


def moment_elasticities(model: Model, response: Response, load: str) -> dict[str, float]:
    """Relative change of the moment My of a single bearing for that of each value.

    The gearbox's weight is a unit load where its spring along z acts, and so the solution that
    belongs to that spring's force is there; the bearing carries the rest.

    Parameters
    ----------
    model, response : Model, Response
        A scene with one bearing, a gearbox spring along z, and none about y.
    load : str
        Of `model.LOADS`.

    Raises
    ------
    InputError
        The scene is another.
    """
    scene = model.scene
    spring, about = scene.gearbox.stiffness[2], scene.gearbox.stiffness[4]
    if len(scene.bearing_units) != 1 or spring in (0, "rigid") or about != 0:
        raise InputError(
            "the moment's sensitivity needs one bearing, and a gearbox that is a spring along z "
            "and free about y: change the scene, or take differences"
        )
    name = scene.bearing_units[0].bearing.name
    arm = scene.shaft.rear - scene.bearing_units[0].bearing.x
    column = LOADS.index(load)
    moment = response.reactions[name][FORCES.index("My"), column]
    k = float(spring)
    lift = -response.motions["gearbox"][2, column]  # work of the weight
    found = {}
    for key, slope in energy_slopes(model, response).items():
        force = -k * slope[LOADS.index("gearbox.weight"), column]
        if key == "gearbox.stiffness.2":
            force -= k * lift
        # a force along z behind the bearing turns it about -y: less of it, more is left
        found[key] = float(arm * force / moment)
    return found


def total(slopes: Mapping[str, Floats]) -> Floats:
    """Sum over all values: minus the compliance, where moduli and springs are all that gives."""
    return np.asarray(np.sum(list(slopes.values()), axis=0))
