"""Stiffness of a bearing unit: tilt (the "torsional spring" K_R of beam models) and the 6x6 matrix.

"Torsional" here is resistance to tilt about y (vertical plane) and to yaw about z (horizontal
plane) at the bearing, as in Stirling 2023, section 3.3; not twist about the shaft.
"""

import warnings
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.bearing_unit import SPHERICAL_JOINTS
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.unit_loads import Response


@dataclass(frozen=True)
class Plane:
    """One of the two planes of bending.

    Attributes
    ----------
    name : str
        "vertical" or "horizontal".
    force, moment : int
        Components (0-5) of the force and of the moment that bend the shaft in this plane.
    sign : int
        Sign of the moment: a positive force at the hub and a positive sign * moment load the
        bearing in the same direction.
    nodes : tuple[str, str]
        The two named points of the housing whose displacement along x gives its rotation.
    """

    name: str
    force: int
    moment: int
    sign: int
    nodes: tuple[str, str]


VERTICAL = Plane("vertical", 2, 4, 1, ("top", "bedplate"))
HORIZONTAL = Plane("horizontal", 1, 5, -1, ("side_right", "side_left"))
PLANES = (VERTICAL, HORIZONTAL)

ESTIMATORS = ("four nodes", "averaged seat", "energy")
"""Of K_R; see `tilt_stiffness`."""

#: Share by which four nodes may differ from the averaged seat before a warning.
MISLEADS = 0.05


def without_gearbox(scene: Scene) -> Scene:
    """The scene with its gearbox springs removed, as K_R is measured (Stirling 2023, 3.3.1)."""
    free = scene.gearbox.model_copy(update={"stiffness": (0.0,) * 6})
    return scene.model_copy(update={"gearbox": free})


def check_one_tilting_bearing(scene: Scene) -> None:
    """Refuse a scene whose bearing unit has no tilt stiffness that a moment could measure.

    Parameters
    ----------
    scene : Scene
        The scene, with or without its gearbox springs.

    Raises
    ------
    InputError
        It has another number of bearing units, or a bearing that carries no moment, or a housing
        that is a stiffness alone.
    """
    if len(scene.bearing_units) != 1:
        raise InputError(
            f"tilt stiffness needs a scene with one bearing, not {len(scene.bearing_units)}: "
            "a second one carries part of the moment; take it out of the scene"
        )
    (unit,) = scene.bearing_units
    name = unit.bearing.name
    if unit.interface in SPHERICAL_JOINTS:
        raise InputError(
            f"{name!r} has no tilt stiffness: its interface {unit.interface!r} carries no moment; "
            "take the interface bonded, rollers or spring"
        )
    if unit.condensed is not None:
        raise InputError(
            f"the housing of {name!r} is a stiffness alone: its tilt stiffness is that of the "
            "scene: read it there"
        )


def tilt_stiffness(
    model: Model, response: Response, bearing: str, plane: Plane
) -> dict[str, float]:
    """K_R = M / theta of a bearing unit by three estimators.

    Parameters
    ----------
    model, response : Model, Response
        Scene without gearbox springs, so that the bearing carries the whole moment; its response.
    bearing : str
        Name of the bearing.
    plane : Plane
        The plane in which the moment at the hub acts.

    Returns
    -------
    stiffness
        [N m/rad] by estimator: "four nodes" (rotation of the line between two housing nodes; two
        nodes in each plane, Stirling 2023, Figs 3.13-3.14), "averaged seat" (least-squares
        rotation of the bearing seat), "energy" (M^2 / 2U with the strain energy U of bearing and
        housing). Four nodes miss the give between the seat and where they sit, whatever the mesh;
        of a beam model's spring the averaged seat is the better estimate.

    Raises
    ------
    InputError
        The gearbox still carries part of the load, or `check_one_tilting_bearing` refuses the
        scene.

    Warns
    -----
    UserWarning
        The four nodes differ from the averaged seat by more than `MISLEADS`.
    """
    check_one_tilting_bearing(model.scene)
    if any(k != 0 for k in model.scene.gearbox.stiffness):
        raise InputError(
            "tilt stiffness needs a scene without gearbox stiffness, else the bearing does not "
            "carry the whole moment: set gearbox.stiffness to zeros"
        )
    load = plane.moment
    parts = [bearing, *model.scene.bearing_unit(bearing).housing_parts]
    energy = sum(response.strain_energy[part][load, load] for part in parts)
    found = {
        "averaged seat": float(1.0 / response.motions[f"{bearing}.seat"][load, load]),
        "energy": float(1.0 / energy),
    }
    if f"{bearing}.housing.{plane.nodes[0]}" not in model.mesh.named_points:
        return found
    upper, lower = (model.mesh.named_points[f"{bearing}.housing.{p}"] for p in plane.nodes)
    arm = np.linalg.norm(model.mesh.points[upper] - model.mesh.points[lower])
    slide = response.displacements[upper, 0, load] - response.displacements[lower, 0, load]
    found = {"four nodes": float(arm / slide), **found}
    excess = found["four nodes"] / found["averaged seat"] - 1.0
    if abs(excess) > MISLEADS:
        warnings.warn(
            f"tilt stiffness of {bearing!r}, {plane.name} plane: four nodes of the housing give "
            f"{found['four nodes']:.3g} N m/rad, {100.0 * abs(excess):.0f} % "
            f"{'above' if excess > 0 else 'below'} the averaged seat: take that, or the condensed "
            "stiffness, for a beam model",
            stacklevel=2,
        )
    return found


def tilt_by_plane(model: Model, response: Response, bearing: str) -> dict[str, dict[str, float]]:
    """K_R of a bearing unit by plane and estimator, without a word where four nodes mislead.

    Parameters
    ----------
    model, response : Model, Response
        Model and response of a scene without gearbox springs.
    bearing : str
        Name of the bearing.

    Returns
    -------
    dict of str to dict of str to float
        [N m/rad] by plane ("vertical", "horizontal") and estimator, see `tilt_stiffness`.

    Raises
    ------
    InputError
        As `tilt_stiffness`.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the averaged seat stands beside the four nodes
        return {plane.name: tilt_stiffness(model, response, bearing, plane) for plane in PLANES}


def bearing_unit_stiffness(response: Response, bearing: str) -> Floats:
    """Condensed 6x6 stiffness of a bearing and its housing, as the shaft feels it.

    Without gearbox springs the shaft behind the bearing carries no load and follows the seat as a
    rigid body. Its motion, carried to the bearing's centre, against the load on the bearing is
    the compliance. No average over the seat enters, and by reciprocity the compliance of a
    housing that is the same fore and aft is symmetric but for terms that change sign from one side
    of the bearing to the other; these are left out.

    Parameters
    ----------
    response : Response
        Response of a scene without gearbox springs; of a spherical joint, which carries no moment,
        the response with its gearbox.
    bearing : str
        Name of the bearing.

    Returns
    -------
    stiffness
        (6, 6) symmetric, from displacements and rotations at the bearing's centre to forces and
        moments on the housing, in the global frame [N/m, N, N m/rad]. Zero for the rotations
        that a spherical joint leaves free; its translations come from the strain energy of
        bearing and housing under a pure force at the centre.
    """
    others = [name for name in response.reactions if "." not in name and name != bearing]
    wrench = response.reactions[bearing][:, :6]
    if np.abs(wrench[3:]).max() > 1e-6:  # carries moments
        for other in others:
            if np.abs(response.reactions[other][:, :6]).max() > 1e-6 * np.abs(wrench).max():
                raise InputError(
                    f"the stiffness of bonded bearing {bearing!r} needs a scene in which it "
                    f"carries everything, but {other!r} carries a part: remove the gearbox "
                    "stiffness and other bearings"
                )
        arm = response.positions["gearbox"] - response.positions[bearing]
        to_rear = wrench_transport(arm).T
        motion = np.linalg.solve(to_rear, response.motions["gearbox"][:, :6])
        compliance = motion @ np.linalg.inv(wrench)
    else:
        energies = response.strain_energy
        own = [part for part in energies if part == bearing or part.startswith(f"{bearing}.")]
        energy = np.sum([energies[part] for part in own], axis=0)
        # Hub loads that make a pure force at the bearing's centre: with a bending moment there,
        # the ring would store more energy by stiffening the shaft than all else by its give.
        arm = response.positions["hub"] - response.positions[bearing]
        load = wrench_transport(-arm)[:, :3]
        compliance = load.T @ energy[:6, :6] @ load
    n = len(compliance)
    inverse = np.linalg.inv(0.5 * (compliance + compliance.T))
    stiffness = np.zeros((6, 6))
    stiffness[:n, :n] = 0.5 * (inverse + inverse.T)
    return stiffness
