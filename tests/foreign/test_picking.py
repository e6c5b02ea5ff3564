"""Faces of a mesh are picked where they are: on a plane, on the inside of a cylinder."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.mesh.facets import outside
from fe_drivetrain.foreign.picking import Surface
from fe_drivetrain.geometry import Pick


def half_ring(points):
    """Radius 0.5 to 1 about x, upper half, 0.8 long."""
    r, t = 0.5 + 0.5 * points[:, 0], np.pi * points[:, 1]
    return np.column_stack([0.8 * points[:, 2], r * np.cos(t), r * np.sin(t)])


def surface(block) -> Surface:
    return Surface("block", block.points, outside(block.cells), {})


def test_a_plane_holds_what_is_on_it_and_neither_what_is_above_nor_below() -> None:
    block = brick((2, 2, 3), 10)
    found = surface(block)
    for height in (0.0, 1.0):
        for normal in ((0.0, 0.0, 1.0), (0.0, 0.0, -2.0)):
            chosen = found.picked(Pick(normal=normal, point=(0.3, 0.1, height)), "foot")
            assert len(chosen) == 8
            assert (block.points[found.facets[chosen], 2] == height).all()
    with pytest.raises(InputError, match="no face for the foot"):
        found.picked(Pick(normal=(0.0, 0.0, 1.0), point=(0.0, 0.0, 0.4)), "foot")


def test_a_cylinder_is_a_bore_and_no_pin() -> None:
    block = brick((2, 24, 2), 10, half_ring)
    found = surface(block)
    axis = {"axis": (1.0, 0.0, 0.0), "point": (0.2, 0.0, 0.0)}
    chosen = found.picked(Pick(radius=0.5, **axis), "bore")
    radii = np.hypot(*block.points[found.facets[chosen, :3]][..., 1:].reshape(-1, 2).T)
    np.testing.assert_allclose(radii, 0.5, rtol=1e-12)
    assert len(chosen) == 2 * 24 * 2
    with pytest.raises(InputError, match="no face for the bore"):
        found.picked(Pick(radius=1.0, **axis), "bore")
