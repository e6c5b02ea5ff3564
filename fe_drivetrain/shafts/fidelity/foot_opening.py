"""Whether hub loads open feet that bolts clamp, so that the linear levels do not hold."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.response.entering import Loads
from fe_drivetrain.shafts.response.foot_contact import clamped_foot, is_clamped
from fe_drivetrain.shafts.response.unit_loads import Response

NOTABLE = 0.01
"""Of a motion of the seat: what opening changes less goes unmentioned."""

_MOTIONS = ("along x", "along y", "along z", "about x", "about y", "about z")


def foot_warnings(
    scene: Scene, response: Response, loads: Loads, weights: Floats, gravity: float
) -> tuple[str, ...]:
    """A sentence for each clamped foot that loads open enough to move its seat otherwise.

    Parameters
    ----------
    scene : Scene
        The scene.
    response : Response
        Response of its assembly, which is linear: no patch of a foot opens or closes.
    loads : LoadHistory, PointLoads or array_like
        (N, 6 + 6 m) at the hub and at load points, see `Response.history`.
    weights : Floats
        (N,) of the samples, their sum 1.
    gravity : float
        Acceleration along -z that gives all parts their weight [m/s^2].

    Returns
    -------
    tuple[str, ...]
        The motions with the largest linear values are compared with those of the foot that opens;
        what the housing itself weighs is left out.
    """
    found = []
    for unit in scene.bearing_units:
        if not is_clamped(unit):
            continue
        name = unit.bearing.name
        foot = clamped_foot(scene, name)
        wrenches = response.history(f"{name}.outer", loads, scene.gearbox.weight, gravity)
        opened = foot.opened_by(wrenches)
        if not opened.any():
            continue
        linear = wrenches @ np.linalg.inv(foot.stiffness).T
        change, at = 0.0, 0
        for k in range(6):
            step = int(np.argmax(np.abs(linear[:, k])))
            if (largest := abs(linear[step, k])) == 0.0:
                continue
            moved = foot.state(wrenches[step]).motion[k]
            if (now := abs(abs(moved) / largest - 1.0)) > change:
                change, at = float(now), k
        if change > NOTABLE:
            found.append(
                f"{name}: hub loads open its foot for {100 * weights[opened].sum():.3g} % of the "
                f"time, and its seat then moves up to {100 * change:.2g} % other than here "
                f"({_MOTIONS[at]}), since all levels are linear: raise the preload, or see "
                "clamped_foot in the API"
            )
    return tuple(found)
