"""Plates of benchmarks: their solids have the shape, and their closed forms the limits."""

import numpy as np
import pytest

from fe_drivetrain.cases.references.loaded_blocks import solve_block
from fe_drivetrain.cases.verification.elliptic_plate import EllipticPlate
from fe_drivetrain.cases.verification.pressed_plate import PressedPlate
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.mesh.facets import facet_points

STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=0.0)


def test_a_quarter_of_an_elliptic_plate_lies_between_its_ellipses():
    plate = EllipticPlate((2.0, 1.0), (3.25, 2.75), 0.6)
    block = plate.quarter((2, 6, 1), 27)
    for face, (a, b) in (("x0", plate.inner), ("x1", plate.outer)):
        x, y, _ = block.points[block.face_nodes(face)].T
        np.testing.assert_allclose((x / a) ** 2 + (y / b) ** 2, 1.0, rtol=1e-12)
    assert np.abs(block.points[block.face_nodes("y0"), 1]).max() < 1e-12
    assert np.abs(block.points[block.face_nodes("y1"), 0]).max() < 1e-12
    for face, height in (("z0", -0.3), ("z1", 0.3)):
        np.testing.assert_allclose(block.points[block.face_nodes(face), 2], height)
        area = facet_points(block.points, block.faces[face]).areas.sum()
        assert area == pytest.approx(plate.quarter_area, rel=1e-4)


@pytest.mark.parametrize(("clamped", "stiffer"), [(True, 1.0), (False, 5.3 / 1.3)])
def test_a_thin_pressed_plate_sinks_as_plate_theory_says(clamped, stiffer):
    plate = PressedPlate(1.0, 0.05, STEEL)
    disc = plate.quarter(4, 1)
    loads, held = plate.loads(disc), plate.supports(disc, clamped)
    # the rim carries what presses, so that nothing is left for the point
    assert loads[::3].sum() == pytest.approx(0.0, abs=1e-12)
    found = solve_block(disc, STEEL, 1e5 * loads, held)
    edge, middle = plate.edge_node(disc), found.node(0.025, 0.0, 0.0)
    thin, shear = plate.thin_deflection(1e5, clamped), plate.shear_deflection(1e5)
    assert thin == pytest.approx(stiffer * plate.thin_deflection(1e5, True))
    assert found.u[middle, 0] - found.u[edge, 0] == pytest.approx(thin + shear, rel=0.01)
    assert found.u[edge, 0] == pytest.approx(0.0, abs=1e-12)


def test_shear_of_a_plate_falls_with_the_square_of_its_slenderness():
    thick, thin = (PressedPlate(1.0, thickness, STEEL) for thickness in (0.2, 0.1))
    shares = [of.shear_deflection(1.0) / of.thin_deflection(1.0, True) for of in (thick, thin)]
    assert shares[0] == pytest.approx(4.0 * shares[1])
