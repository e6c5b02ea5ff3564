"""Plates of benchmarks: their solids have the shape, and their closed forms the limits."""

import numpy as np
import pytest

from fe_drivetrain.mesh.facets import facet_points
from fe_drivetrain.validation.elliptic_plate import EllipticPlate


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
