"""K_R of a bonded bearing unit as the assembly shows it, the gearbox springs removed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.steps import Clock
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.response.bearing_stiffness import (
    bearing_unit_stiffness,
    check_one_tilting_bearing,
    tilt_by_plane,
    without_gearbox,
)
from fe_drivetrain.studies.solved_assembly import Assembly, solved_assembly


@dataclass(frozen=True, eq=False)
class SeatStiffness:
    """Stiffness of a bonded bearing unit, measured with the gearbox springs removed.

    Attributes
    ----------
    by_plane : Mapping[str, Mapping[str, float]]
        K_R [N m/rad] by plane ("vertical", "horizontal") and estimator, see
        `fe_drivetrain.shafts.response.tilt_stiffness`.
    matrix : ndarray, (6, 6)
        Condensed stiffness at the bearing's centre [N/m, N, N m/rad].
    free : Assembly
        The solution without gearbox springs; not part of the JSON.
    """

    by_plane: Mapping[str, Mapping[str, float]]
    matrix: Floats
    free: Assembly

    def both(self, estimator: str) -> tuple[float, float]:
        """K_R of the vertical and of the horizontal plane [N m/rad].

        Parameters
        ----------
        estimator : str
            One of `fe_drivetrain.shafts.response.ESTIMATORS`.
        """
        return self.by_plane["vertical"][estimator], self.by_plane["horizontal"][estimator]

    def spread(self, plane: str) -> float:
        """Largest estimate less the smallest, over their median [%].

        Parameters
        ----------
        plane : str
            "vertical" or "horizontal".
        """
        found = list(self.by_plane[plane].values())
        return 100.0 * (max(found) - min(found)) / float(np.median(found))

    def rows(self) -> list[Record]:
        """Records of K_R by plane and estimator [MN m/rad], and their spread [%]."""
        return [
            {
                "plane": plane,
                **{f"{estimator} [MN m/rad]": k / 1e6 for estimator, k in values.items()},
                "spread [%]": self.spread(plane),
            }
            for plane, values in self.by_plane.items()
        ]


def seat_stiffness(
    steps: Clock, scene: Scene, label: str = "", mesh: Mesh | None = None, method: str = "auto"
) -> SeatStiffness:
    """K_R of a bonded bearing unit, as Stirling 2023, section 3.3.1, measures it.

    Parameters
    ----------
    steps : Clock
        Times each step.
    scene : Scene
        The scene, with its gearbox springs; it has one bearing unit, which carries moments.
    label : str
        Added to the names of the steps in brackets.
    mesh : Mesh, optional
        The mesh of the scene, where there is one already.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solve`.

    Raises
    ------
    InputError
        `fe_drivetrain.shafts.response.bearing_stiffness.check_one_tilting_bearing` refuses the
        scene, or it is a mechanism without its gearbox springs.
    """
    check_one_tilting_bearing(scene)  # before what takes long
    free = solved_assembly(steps, without_gearbox(scene), label, mesh, method)
    return SeatStiffness(
        tilt_by_plane(free.model, free.response, free.bearing),
        bearing_unit_stiffness(free.response, free.bearing),
        free,
    )
