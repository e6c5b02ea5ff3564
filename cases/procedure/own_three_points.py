"""A user's drivetrain on three points: what its file states, and the rest in proportion."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.drivetrain_file.turning_parts import diagonal
from fe_drivetrain.dynamics import machine_of, torsional
from fe_drivetrain.dynamics.torsion import GENERATOR, ROTOR, static_stiffness
from fe_drivetrain.procedure import Mounts, ThreePoints, three_points_of
from fe_drivetrain.report.suite import Page, Run

REFERENCE = 8.0e5  # N m, rated torque of the machine of 1.5 MW whose round numbers are scaled
ARMS, SECONDS = 2.0, 2e-3  # m, s
ENTRANCE = (2e9, 2e9, 2e9, 2e8, 2e8)  # N/m, N m/rad
SUPPORTS = (5e7, 5e7, 5e7, 5e7, 5e7)
GRID = 3e4  # N m/rad
SHAFT, GEARBOX, ACROSS = (3e3, 6e3), (9e3, 1e4), 3e3  # kg m^2; the last of the generator


@dataclass(frozen=True)
class OnThreePoints:
    """A user's drivetrain: places, mounts, the rotor's rated speed [rad/s].

    ``hub_scale`` (6,) is what takes simulated hub loads to its rated torque.
    """

    scene: Scene
    places: ThreePoints
    mounts: Mounts
    speed: float
    hub_scale: Floats


def own_three_points(run: Run, page: Page, torque: float) -> OnThreePoints:
    """The drivetrain that the user names, its loads beside a mean torque that is simulated [N m].

    Raises
    ------
    InputError
        The file has no main shaft with sections, not one main bearing, no springs under the
        gearbox, or no mass of gearbox or generator.
    """
    chosen = run.drivetrain("")
    chosen.state(page)
    scene = chosen.drivetrain
    if not isinstance(scene, Scene):
        raise InputError(
            f"{scene.title!r} has no main shaft with sections and bearings: give shaft.sections "
            "and bearing_units"
        )
    rated, speed = chosen.rated_torque(), chosen.rotor_speeds()[1]
    size = (rated / REFERENCE) ** (1.0 / 3.0)
    given = scene.gearbox.stiffness[:3]
    arm = [0.5 * value if isinstance(value, float) else np.inf for value in given]
    if not 0.0 < min(arm) <= max(arm) < np.inf:
        raise InputError(
            f"gearbox.stiffness of {scene.title!r} is {given} along x, y and z: torque arms "
            "need a number above 0 N/m for each"
        )
    arms = run.positive("arms") if "arms" in run.settings else size * ARMS
    mass = run.positive("generator_mass") if "generator_mass" in run.settings else None
    places = three_points_of(scene, arms, mass)
    machine = machine_of(scene)
    whole = static_stiffness(torsional(machine), ROTOR, GENERATOR) / places.ratio**2
    bearing = diagonal(machine.bearings[0].stiffness)
    mounts = Mounts(
        bearing=(bearing[0], bearing[1], bearing[2]),
        entrance=scaled(ENTRANCE, size),
        arm=(arm[0], arm[1], arm[2]),
        supports=scaled(SUPPORTS, size),
        torsion=whole,
        grid=machine.generator.stiffness or GRID * size**3,
        shaft=(SHAFT[0] * size**5, SHAFT[1] * size**5),
        gearbox=(GEARBOX[0] * size**5, GEARBOX[1] * size**5),
        generator=(machine.generator.inertia, ACROSS * size**5),
        seconds=SECONDS,
    )
    if "arms" not in run.settings:
        page.assume("distance of the torque arms", arms, "m", "in proportion to 1.5 MW")
    for name in (
        "stiffness of the gearbox's entrance and of the generator's supports",
        "inertias of shaft, gearbox and generator across",
    ):
        page.assume(name, "in proportion to 1.5 MW", "", "the file states none")
    page.assume("loads at the hub", "simulated, scaled to the rated torque", "", "16 m/s")
    page.assume("damping over stiffness", SECONDS, "s", "the file states none")
    page.assume_all(machine.assumptions())
    share = rated / torque
    hub_scale = np.array([share ** (2.0 / 3.0)] * 3 + [share] * 3)
    return OnThreePoints(scene, places, mounts, speed, hub_scale)


def scaled(
    stiffness: tuple[float, float, float, float, float], size: float
) -> tuple[float, float, float, float, float]:
    """Stiffness of a mount of another size: N/m with it, N m/rad with its cube."""
    x, y, z, about_y, about_z = stiffness
    return x * size, y * size, z * size, about_y * size**3, about_z * size**3
