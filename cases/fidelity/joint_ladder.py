"""One drivetrain with its bearing's joint exchanged: solved as an assembly, and on springs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene, change_scene, joint_stiffness
from fe_drivetrain.elasticity.interfaces import in_series
from fe_drivetrain.elasticity.solve import Condensed
from fe_drivetrain.shafts.fidelity import shaft_level, unit_stiffness
from fe_drivetrain.shafts.response import Model, Response, build_model, cached_response, mesh_scene

BEARING = "main_bearing"
HELD: tuple[Any, ...] = ("rigid", "rigid", "rigid")


@dataclass(frozen=True)
class Solved:
    """A joint as an assembly of solids.

    Attributes
    ----------
    model : Model
    response : Response
        Of the finite elements.
    seconds : float
        Set-up and solve, when it was solved.
    """

    model: Model
    response: Response
    seconds: float

    @property
    def tilt_moment(self) -> float:
        """Moment about y that the bearing takes, for 1 N m at the hub."""
        return float(self.response.reactions[BEARING][4, 4])

    @property
    def hub_motions(self) -> Floats:
        """(6, 6) of the hub for unit hub loads."""
        return self.response.motions["hub"][:, :6]


def with_joint(scene: Scene, **unit: Any) -> Scene:
    """The scene with other values of its bearing unit."""
    keys = {f"bearing_units.{BEARING}.{key}": value for key, value in unit.items()}
    return change_scene(scene, keys)


def tilting(scene: Scene, stiffness: float | str) -> Scene:
    """The scene with its bearing held in place, and on springs against tilt and yaw."""
    spring = [*HELD, 0.0, stiffness, stiffness]
    return with_joint(scene, interface="spring", stiffness=spring)


def solved(scene: Scene) -> Solved:
    """Solve the assembly; what was solved before comes from the cache, a stopped sweep too."""
    model = build_model(scene, mesh_scene(scene))
    response = cached_response(model)
    return Solved(model, response, response.diagnostics.seconds)


def housing_alone(scene: Scene) -> Floats:
    """(6, 6) stiffness of the housing, its bore moving on average."""
    held = with_joint(scene, interface="spring", stiffness=["rigid"] * 6)
    return unit_stiffness(held, BEARING)


def on_springs(scene: Scene, housing: Floats, shaft: Condensed) -> Floats:
    """(6, 10) reaction of the bearing of a condensed shaft, on joint and housing in series."""
    spring = in_series(housing, joint_stiffness(scene.bearing_unit(BEARING)))
    return shaft_level(scene, 2, {BEARING: spring}, shaft).reaction_matrices[BEARING]


def difference(one: Floats, other: Floats) -> float:
    """Difference of two compliances (6, 6), relative to the other's diagonal."""
    size = np.sqrt(other.diagonal())
    return float((np.abs(one - other) / np.outer(size, size)).max())


def roller_imbalance(response: Response, lines: Floats, loads: Floats) -> float:
    """Sum of roller loads (n, 10) along lines (n, 6), less what the joint carries, relative."""
    total = lines.T @ loads
    carried = response.reactions[f"{BEARING}.outer"]
    return float(np.abs(total - carried).max() / np.abs(carried).max())
