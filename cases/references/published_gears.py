"""Gears of published gearboxes, and the figures printed for them.

NREL 5 MW reference gearbox: Nejad, Guo, Gao and Moan 2016, Wind Energy 19 (10.1002/we.1884);
figures of the KISSsoft 03/2017 reports (ISO 6336:2006 method B) in the public repository
gfsReboucas/Drivetrain. NREL 750 kW gearbox: teeth, modules, helix angles, centre distance and root
diameters as published with the NREL Gearbox Reliability Collaborative; shifts and tips follow from
them here. ISO/TR 6336-30:2017, example 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

from fe_drivetrain.dynamics import library_machine, machine_pairs
from fe_drivetrain.gear import Gear, Pair, Rack


@dataclass(frozen=True)
class PrintedMesh:
    """What a report prints for a mesh.

    Attributes
    ----------
    torque : float or None
        On the first gear in this mesh [N m].
    force : float
        Tangential, at the reference circle [N].
    transverse_ratio, overlap_ratio : float
        Contact ratios.
    single, mesh, misaligned : float
        c', c_gamma_alpha and c_gamma_beta [N/(mm um)].
    blank : float
        Factor of the gear blank, C_R, with three digits as printed.
    """

    torque: float | None
    force: float
    transverse_ratio: float
    overlap_ratio: float
    single: float
    mesh: float
    misaligned: float
    blank: float


NREL_5MW_PRINTED = {
    "sun 1": PrintedMesh(999650.9 / 3, 779454.877, 1.115, 0.0, 12.362, 13.426, 11.412, 0.862),
    "ring 1": PrintedMesh(None, 779454.877, 1.278, 0.0, 13.289, 16.063, 13.653, 0.862),
    "sun 2": PrintedMesh(162105.5 / 3, 285900.438, 1.370, 0.0, 12.240, 15.640, 13.294, 0.862),
    "ring 2": PrintedMesh(None, 285900.438, 1.618, 0.0, 14.053, 20.563, 17.479, 0.862),
    "stage 3": PrintedMesh(40953.0, 240064.4, 1.463, 1.421, 13.832, 18.632, 15.837, 0.898),
}
"""Torque of a sun's mesh is a third of the sun's; a ring's force is that of the sun's mesh."""

ISO_EXAMPLE_1 = {
    "virtual teeth of the pinion": 18.905,
    "virtual teeth of the wheel": 114.543,
    "tangential force [kN]": 127.352,
    "theoretical stiffness [N/(mm µm)]": 17.85584,
    "single stiffness [N/(mm µm)]": 12.37047,
    "mesh stiffness [N/(mm µm)]": 17.46485,
    "misaligned stiffness [N/(mm µm)]": 14.84512,
}
"""Printed in ISO/TR 6336-30, example 1; the pinion has 9000 N m."""


def nrel_5mw() -> dict[str, Pair]:
    """Five meshes of the NREL 5 MW gearbox, tip diameters as its KISSsoft reports print them."""
    m = 1e-3
    sun = Gear(19, 45 * m, 491 * m, shift=0.617, tip_diameter=978.808 * m)
    planet = Gear(17, 45 * m, 491 * m, shift=0.8021, tip_diameter=905.470 * m)
    ring = Gear(-56, 45 * m, 491 * m, shift=-0.5013, tip_diameter=2475.118 * m)
    sun_2 = Gear(18, 21 * m, 550 * m, shift=0.389, tip_diameter=432.838 * m)
    planet_2 = Gear(36, 21 * m, 550 * m, shift=0.5039, tip_diameter=815.663 * m)
    ring_2 = Gear(-93, 21 * m, 550 * m, shift=0.1171, tip_diameter=1906.081 * m)
    ten = radians(10.0)
    pinion = Gear(24, 14 * m, 360 * m, ten, 0.480, tip_diameter=380.747 * m)
    wheel = Gear(95, 14 * m, 360 * m, -ten, 0.6691, tip_diameter=1395.376 * m)
    return {
        "sun 1": Pair(sun, planet, 0.863),
        "ring 1": Pair(planet, ring, 0.863),
        "sun 2": Pair(sun_2, planet_2, 0.584),
        "ring 2": Pair(planet_2, ring_2, 0.584),
        "stage 3": Pair(pinion, wheel, 0.861),
    }


OTHERS_750KW = (
    ("Guo et al. 2012", 16.9e9, "N/m", "sun", ""),
    ("Guo et al. 2012", 19.2e9, "N/m", "ring", ""),
    ("Link et al. 2013", 4.35e12, "N m/rad", "ring", "the unit cannot be right"),
    ("Hong et al. 2014", 5e8, "N/m", "sun", ""),
    ("Bruce et al. 2015", 13.1e9, "N/m^2", "sun", "per face width, one pair at a time"),
    ("Bruce et al. 2015", 13.1e9, "N/m^2", "ring", "per face width, one pair at a time"),
    ("thesis, Table 4.2", 5.86e7, "N m/rad", "ring", "about the planet's axis"),
)
"""Mesh stiffness that others took for the planetary stage of the NREL 750 kW gearbox.

Source, value, unit, mesh and remark, as Al-Hamadani 2018 has them in Tables 4.2 and 6.3.
"""


def nrel_750kw() -> dict[str, Pair]:
    """Four meshes of the NREL 750 kW gearbox, as the table of that machine has them.

    Published root circles and centre distances fix shifts and dedenda; tips are assumed at a
    clearance of 0.4 modules from the other's roots.
    """
    pairs = machine_pairs(library_machine("nrel_750kw"))
    return dict(zip(("sun", "ring", "intermediate", "high speed"), pairs.values(), strict=True))


def iso_example_1() -> Pair:
    """Pair of ISO/TR 6336-30, example 1; tip diameters as they come of the rack, to 0.01 mm."""
    rack = Rack(dedendum=1.4, fillet=0.39)
    helix = radians(15.8)
    pinion = Gear(17, 8e-3, 0.1, helix, 0.145, rack=rack, tip_diameter=0.15966)
    return Pair(pinion, Gear(103, 8e-3, 0.1, -helix, 0.0, rack=rack, tip_diameter=0.87235), 0.5)
