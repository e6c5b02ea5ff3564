"""Shape and compliance of spur teeth: rack, energy, and plane finite elements."""

from dataclasses import replace
from math import cos, pi, tan

import numpy as np
import pytest

from fe_drivetrain.cases.gear.plane_teeth import (
    MeshedPair,
    compliances,
    mesh_teeth,
    meshed_pair,
    pressed_surface,
)
from fe_drivetrain.cases.references.plane_rings import Plane, plane_strain
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.energy import (
    Steel,
    contact_depths,
    contact_half_width,
    energy_law,
    line_contact,
    tooth_compliance,
    yang_sun_contact,
)
from fe_drivetrain.gear.involute import Gear, Rack, meshing_without_backlash
from fe_drivetrain.gear.iso import iso_gear_stiffness
from fe_drivetrain.gear.pair_stiffness import kuang_yang_law
from fe_drivetrain.gear.profile import fillet_points, flank_normals, flank_points, tooth_outline

PINION, WHEEL = Gear(20, 1e-2, 0.1), Gear(40, 1e-2, 0.1)
PAIR = meshing_without_backlash(PINION, WHEEL)
HUBS = (0.04, 0.09)
STEEL = Steel()
STRESS = Plane(206e9, 0.3)
LOAD = 4e5


@pytest.mark.parametrize("gear", [PINION, Gear(17, 1e-2, 0.1, shift=0.6), Gear(90, 5e-3, 0.1)])
def test_outline_is_cut_by_the_rack(gear: Gear) -> None:
    fillet = fillet_points(gear, 40)
    start = flank_points(gear, np.array([gear.form_curvature]))[0]
    assert fillet[-1] == pytest.approx(start, abs=1e-12)  # fillet and involute meet, smoothly
    slopes = [
        np.arctan2(*(b - a)) for a, b in ((fillet[-2], start), (start, tooth_outline(gear)[30]))
    ]
    assert slopes[0] == pytest.approx(slopes[1], abs=0.08)
    assert np.hypot(*fillet[0]) == pytest.approx(gear.root_radius)
    radii = np.hypot(*tooth_outline(gear).T)
    assert (np.diff(radii) > -1e-12).all()
    assert radii[-1] == pytest.approx(gear.tip_radius)
    at = gear.base_radius * tan(gear.pressure_angle)
    x, y = flank_points(gear, np.array([at]))[0]
    assert 2.0 * np.arctan2(x, y) * gear.reference_radius == pytest.approx(
        gear.thickness_at(gear.reference_radius)
    )


def test_no_point_of_the_rack_enters_the_fillet() -> None:
    # the rounded tip of the rack, rolled along, keeps outside the tooth and touches all of it
    gear = PINION
    m, rack = gear.normal_module, gear.rack
    radius, alpha = rack.fillet * m, gear.pressure_angle
    depth = -(rack.dedendum - rack.fillet) * m
    aside = 0.25 * pi * m - depth * tan(alpha) + radius / cos(alpha)
    roll = np.linspace(-2.0 * m, 4.0 * m, 4001)
    x, y = aside - roll, np.full(roll.shape, depth + gear.reference_radius)
    angle = roll / gear.reference_radius
    centres = np.column_stack(
        [np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x]
    )
    for point in fillet_points(gear, 9):
        assert np.hypot(*(centres - point).T).min() == pytest.approx(radius, abs=1e-7)


def test_pushes_are_along_the_line_of_action() -> None:
    rho = np.linspace(PINION.form_curvature, PINION.tip_curvature, 5)
    points, pushes = flank_points(PINION, rho), flank_normals(PINION, rho)
    assert np.hypot(*pushes.T) == pytest.approx(np.ones(5))
    moments = points[:, 0] * pushes[:, 1] - points[:, 1] * pushes[:, 0]
    assert moments == pytest.approx(np.full(5, PINION.base_radius))
    # on along the line by the radius of curvature: the base circle
    touching = points + rho[:, None] * pushes
    assert np.hypot(*touching.T) == pytest.approx(np.full(5, PINION.base_radius))


def test_energy_of_a_tooth() -> None:
    rho = np.linspace(PINION.form_curvature * 1.2, PINION.tip_curvature, 6)
    found = tooth_compliance(PINION, rho, HUBS[0])
    for part in (found.bending, found.shear, found.axial, found.body):
        assert (part > 0.0).all()
    assert (np.diff(found.bending) > 0.0).all()
    # a plane compliance knows no length, and goes with 1 / E
    large = replace(PINION, normal_module=0.03)
    scaled = tooth_compliance(large, 3.0 * rho, 3.0 * HUBS[0], Steel(103e9))
    assert scaled.total == pytest.approx(2.0 * found.total)
    with pytest.raises(InputError, match=r"holds for hubs of 12\.5 to"):
        tooth_compliance(PINION, rho, 0.001)
    with pytest.raises(InputError, match="only external spur gears"):
        fillet_points(Gear(20, 1e-2, 0.1, helix=0.1))
    with pytest.raises(InputError, match="a tip wider than its tooth"):
        fillet_points(Gear(20, 1e-2, 0.1, rack=Rack(fillet=0.6)))


def test_bending_is_that_of_a_cantilever() -> None:
    # a rack-like tooth of a very large gear, against a prism of its width at half the height
    gear = Gear(400, 1e-2, 0.1)
    found = tooth_compliance(gear, np.array([gear.tip_curvature]), gear.root_radius / 5.0)
    length = gear.tip_radius - gear.root_radius
    widths = [2.0 * tooth_outline(gear)[n, 0] for n in (0, -1)]
    bounds = [4.0 * length**3 / (206e9 * w**3) for w in widths]
    assert bounds[0] < found.bending[0] < bounds[1]


def test_figures_of_ross() -> None:
    # test_gear_element.py of ROSS: 62 teeth of module 2 mm, face 20 mm, E 206 GPa
    gear = Gear(62, 2e-3, 0.02)
    pair = meshing_without_backlash(gear, gear)
    assert round(pair.transverse_ratio, 5) == 1.78978
    assert 0.02 / yang_sun_contact() == pytest.approx(3.555869e9, rel=1e-6)


def test_line_contact() -> None:
    one = (np.array([0.03]), np.array([0.05]))
    depths = (np.array([8e-3]), np.array([9e-3]))
    soft, half = (line_contact(f, one, depths, STEEL)[0] for f in (LOAD, 4.0 * LOAD))
    # four times the load: twice the width, and 2 (1 - nu^2) / (pi E) 2 ln 2 less
    assert soft - half == pytest.approx(4.0 * np.log(2.0) * 0.91 / (pi * 206e9))
    wide = contact_half_width(LOAD, one)[0]
    modulus, relative = 206e9 / 0.91, 1.0 / (1.0 / 0.03 + 1.0 / 0.05)
    # p_max = a E / (4 R (1 - nu^2)) for two equal bodies
    assert 2.0 * LOAD / (pi * wide) == pytest.approx(wide * modulus / (4.0 * relative))


@pytest.fixture(scope="module")
def meshed() -> MeshedPair:
    return meshed_pair(PAIR, HUBS, STRESS, STEEL, steps=8, size=0.2)


def test_elements_converge_and_loads_are_reciprocal(meshed: MeshedPair) -> None:
    n = np.arange(0, len(meshed.places), 4)
    rho = PAIR.curvatures(meshed.places[n])[0]
    fine = compliances(mesh_teeth(PINION, rho, HUBS[0], 0.1), STRESS)
    coarse = meshed.first[:, n][..., n]
    own = np.arange(len(n))
    assert coarse[0, own, 0, own] == pytest.approx(fine[0, own, 0, own], rel=3e-3)
    # both teeth are the same, on meshes of their own
    assert fine[0, own, 0, own] == pytest.approx(fine[1, own, 1, own], rel=5e-4)
    # what one tooth does to the other; measured at some depth, so not exactly reciprocal
    assert fine[0][:, 1] == pytest.approx(fine[1][:, 0].T, rel=0.005)


def test_methods_agree_as_far_as_they_do(meshed: MeshedPair) -> None:
    elements = meshed.single(LOAD)
    energy = energy_law(PAIR, HUBS, LOAD)(meshed.places)
    assert energy == pytest.approx(elements, rel=0.06)
    assert (energy < elements).all()
    # without contact, stiffer
    kuang = kuang_yang_law(PAIR)(meshed.places)
    assert (kuang > elements).all()
    assert kuang == pytest.approx(elements, rel=0.16)
    # c' of ISO 6336-1 is the greatest over the path; from tests of discs
    assert iso_gear_stiffness(PAIR).single == pytest.approx(elements.max(), rel=0.03)


def test_bodies_couple_two_pairs_in_contact(meshed: MeshedPair) -> None:
    coupled, apart = meshed.mesh(LOAD), meshed.mesh(LOAD, coupled=False)
    two = np.arange(8) + 8 < len(meshed.places)
    assert coupled[~two] == pytest.approx(apart[~two])
    assert (coupled[two] < 0.9 * apart[two]).all()
    single = meshed.single(LOAD)
    # each tooth has a mesh of its own, and these differ by so much
    own = np.arange(len(meshed.places))
    bodies = (meshed.first, meshed.second)
    by_mesh = max(np.abs(b[0, own, 0, own] / b[1, own, 1, own] - 1.0).max() for b in bodies)
    assert by_mesh < 5e-3
    assert apart[0] == pytest.approx(single[0] + single[8], rel=by_mesh)


def test_contact_apart_from_the_tooth_against_pressure_on_its_surface() -> None:
    rho = [r[0] for r in PAIR.curvatures(np.array([PAIR.path.pitch]))]
    width = float(contact_half_width(LOAD, (rho[0], rho[1])))
    plane = plane_strain(206e9, 0.3)
    direct = pressed_surface(PINION, float(rho[0]), HUBS[0], width, plane)
    at = np.array([rho[0]])
    mesh = mesh_teeth(PINION, at, HUBS[0], 0.1)
    misses = {}
    for share in (0.3, 0.6, 1.0):
        body = compliances(mesh, plane, share)[0, 0, 0, 0]
        depth = share * contact_depths(PINION, at)[0]
        near = (2.0 * np.log(2.0 * depth / width) - plane.nu) / (pi * plane.E)
        misses[share] = (body + near) / direct - 1.0
    # a tooth is a half plane near its surface only: the error goes with the depth
    assert misses[1.0] == pytest.approx(-0.02, abs=0.004)
    assert abs(misses[0.3]) < 0.006
    assert 2.0 * misses[0.3] - misses[0.6] == pytest.approx(0.0, abs=0.005)
