"""Gears with published figures, for the tests of several rooms."""

from math import radians

from fe_drivetrain.gear.involute import Gear, Pair, Rack


def nrel_5mw() -> dict[str, Pair]:
    """Gearbox of Nejad, Guo, Gao and Moan 2016, tip diameters as its KISSsoft reports print."""
    m = 1e-3
    sun = Gear(19, 45 * m, 491 * m, shift=0.617, tip_diameter=978.808 * m)
    planet = Gear(17, 45 * m, 491 * m, shift=0.8021, tip_diameter=905.470 * m)
    ring = Gear(-56, 45 * m, 491 * m, shift=-0.5013, tip_diameter=2475.118 * m)
    sun_2 = Gear(18, 21 * m, 550 * m, shift=0.389, tip_diameter=432.838 * m)
    planet_2 = Gear(36, 21 * m, 550 * m, shift=0.5039, tip_diameter=815.668 * m)
    ring_2 = Gear(-93, 21 * m, 550 * m, shift=0.1171, tip_diameter=1906.086 * m)
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


def example_1() -> Pair:
    """Pair of ISO/TR 6336-30, example 1; tip diameters as they come of the rack, to 0.01 mm."""
    rack = Rack(dedendum=1.4, fillet=0.39)
    helix = radians(15.8)
    pinion = Gear(17, 8e-3, 0.1, helix, 0.145, rack=rack, tip_diameter=0.15966)
    return Pair(pinion, Gear(103, 8e-3, 0.1, -helix, 0.0, rack=rack, tip_diameter=0.87235), 0.5)
