"""Park et al. 2021: the model as printed, with 36 degrees of freedom, and what its tables imply.

Axes are those of this program: x along the shafts; the source's x, y, theta, psi, phi are y, z and
the rotations about y, z, x.
"""

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble, disc
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.springs import Spring
from fe_drivetrain.dynamics.bodies.system import System

SOURCE = "Park et al. 2021, Front. Energy Res. 8:604414"
#: Table 2: inertias about the axes [kg m^2].
INERTIAS = {
    "rotor": 4.18e6,
    "carrier": 57.72,
    "planet": 1.12,
    "sun": 0.86,
    "gear 1": 14.32,
    "gear 2": 1.62,
    "gear 3": 0.20,
    "generator": 93.22,
}
#: Table 2: bending and torsion of the shafts [N m/rad].
BENDING = {"LSS": 1.34e8, "IS": 2.48e7, "HSS": 2.83e6}
TORSION = {"LSS": 7.19e7, "IS": 1.40e7, "HSS": 0.15e7}
SHAFTS = {"LSS": ("rotor", "carrier"), "IS": ("sun", "gear 1"), "HSS": ("gear 3", "generator")}
#: Table 2: meshes [N/m] and radii [m].
MESHES = {"sun-planet": 0.73e8, "ring-planet": 0.73e8, "gears 1-2": 2.02e9, "gears 2-3": 0.11e8}
RADII = {
    "carrier": 0.27,
    "planet": 0.16,
    "sun": 0.11,
    "gear 1": 0.29,
    "gear 2_1": 0.095,
    "gear 2_2": 0.185,
    "gear 3": 0.08,
}
RATIO = 34.654
#: Table 3, ratios of radii, as printed, and the bodies.
TABLE_3 = (
    ("planet", "sun", 1.4545),
    ("gear 1", "gear 2_1", 3.0526),
    ("gear 2_2", "gear 3", 2.3125),
)
#: Mesh lines in the spectra at 6 rpm [Hz]: planetary, gears 1-2, gears 2-3 (section 4).
MESH_LINES = (18.30, 63.06, 128.50)
TORQUE = 15e3  # N m, aerodynamic
PLANETS = 3


def ratio() -> float:
    """Speed of the generator over the rotor's, of the radii."""
    r = RADII
    ring = r["carrier"] + r["planet"]
    planetary = 1 + ring / r["sun"]
    return planetary * r["gear 1"] / r["gear 2_1"] * r["gear 2_2"] / r["gear 3"]


def _row(**by: tuple[float, float, float]) -> dict[str, Floats]:
    """Row of a spring by (move along y, move along z, turning about x) of each body."""
    return {
        name.replace("_", " "): np.array([0.0, y, z, turn, 0.0, 0.0])
        for name, (y, z, turn) in by.items()
    }


def printed_model(bearing: float, both: bool, mesh_factor: float = 1.0) -> System:
    """Eq 17-25 as printed, in 36 degrees of freedom, one planet with threefold terms.

    The tilts of a shaft's bodies are in its bending springs and nowhere else: nothing couples them
    to translations. Eq 25 has d_y in each planetary mesh, too, which is never written: taken as d_x
    with y in place of x, winding included, or left out.

    Parameters
    ----------
    bearing : float
        Stiffness of the bearing of every body, across the shaft [N/m].
    both : bool
        Whether d_y of the planetary meshes is there.
    mesh_factor : float
        On all mesh stiffnesses, such as cos^2 of the pressure angle.
    """
    r = RADII  # of the ring there is nothing: it stands still
    five = frozenset({"uy", "uz", "rx", "ry", "rz"})
    three = frozenset({"uy", "uz", "rx"})
    bodies = []
    for name, inertia in INERTIAS.items():
        times = PLANETS if name == "planet" else 1
        radius = r.get(name, r.get(f"{name}_2", 1.0))
        mass = 3e4 if name == "rotor" else 1e3 if name == "generator" else 2 * inertia / radius**2
        across = disc(mass, radius, 0.1)[1]
        free = three if name in ("planet", "gear 2") else five
        bodies.append(Body(name, (0.0, 0.0, 0.0), times * mass, times * inertia, across, free=free))
    springs = []
    for shaft, (one, two) in SHAFTS.items():
        for motion, k in ((3, TORSION[shaft]), (4, BENDING[shaft]), (5, BENDING[shaft])):
            unit = np.eye(6)[motion]
            springs.append(Spring(f"{shaft} {motion}", {one: unit, two: -unit}, k))
    planetary = PLANETS * mesh_factor
    for axis, (y, z) in (("x", (1.0, 0.0)), ("y", (0.0, 1.0))):
        if axis == "x" or both:
            sun_row = _row(
                carrier=(0, 0, -r["carrier"]), planet=(y, z, r["planet"]), sun=(y, z, r["sun"])
            )
            ring_row = _row(carrier=(0, 0, r["carrier"]), planet=(y, z, r["planet"]))
            own = planetary * MESHES["sun-planet"], planetary * MESHES["ring-planet"]
            springs.append(Spring(f"sun-planet {axis}", sun_row, own[0]))
            springs.append(Spring(f"ring-planet {axis}", ring_row, own[1]))
    one_two = _row(gear_1=(1, 0, r["gear 1"]), gear_2=(1, 0, r["gear 2_1"]))
    two_three = _row(gear_2=(1, 0, r["gear 2_2"]), gear_3=(1, 0, r["gear 3"]))
    springs.append(Spring("gears 1-2", one_two, mesh_factor * MESHES["gears 1-2"]))
    springs.append(Spring("gears 2-3", two_three, mesh_factor * MESHES["gears 2-3"]))
    for body in bodies:
        times = PLANETS if body.name == "planet" else 1
        for motion, name in ((1, "y"), (2, "z")):
            row = {body.name: np.eye(6)[motion]}
            springs.append(Spring(f"{body.name} bearing {name}", row, times * bearing))
    return assemble(bodies, springs)


def nullity(system: System, within: float = 1e-10) -> int:
    """Number of motions that no spring feels, lengths and angles scaled to a unit diagonal."""
    weighted = np.sqrt(system.stiffness)[:, None] * system.rows
    size = np.linalg.norm(weighted, axis=0)
    sizes = np.linalg.svd(weighted / np.where(size > 0, size, 1.0), compute_uv=False)
    return len(system.names) - int((sizes > within * sizes[0]).sum())


def spectrum(mesh_factor: float, planetary_twice: bool = False) -> Floats:
    """Torsional frequencies [Hz] with the planets in step and the carrier's inertia as tabled.

    Parameters
    ----------
    mesh_factor : float
        On the meshes: 1 as printed, cos^2 of the pressure angle, 2 where x and y both wind them.
    planetary_twice : bool
        Whether the planetary meshes are there along both axes, as Eq 25 reads.
    """
    system = printed_model(1e18, planetary_twice, mesh_factor)
    modes = system_modes(system)
    energy = modes.shapes * (system.mass @ modes.shapes)
    turning = np.array([name.endswith("rx") for name in system.names])
    return np.asarray(modes.frequencies[energy[turning].sum(axis=0) > 0.5])
