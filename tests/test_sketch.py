"""Sketches of bodies: closed surfaces turned outward, and what is in front hides what is behind."""

import io
import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from fe_drivetrain.geometry.shaft import Section, Shaft
from fe_drivetrain.mesh.blocks import brick
from fe_drivetrain.report.pictures.sketch import (
    WIDTH,
    Faces,
    revolved,
    shaft_with_rings,
    sketch,
    surface,
)
from fe_drivetrain.scene.reading import library_scene
from fe_drivetrain.suite.run import Run
from fe_drivetrain.validation.manufactured import quarter_ring

STEPPED = Shaft(
    front=-1.0,
    sections=(
        Section(length=0.5, outer_diameter=0.6, inner_diameter=0.2),
        Section(length=1.0, outer_diameter=0.4, outer_diameter_end=0.3),
    ),
)


def volume(groups: list[Faces]) -> float:
    """By the divergence theorem, of pieces turned outward."""
    total = 0.0
    for group in groups:
        first = group.loops[:, 0]
        for k in range(1, group.loops.shape[1] - 1):
            spanned = np.cross(group.loops[:, k] - first, group.loops[:, k + 1] - first)
            total += float((first * spanned).sum()) / 6.0
    return total


def pixels(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


@pytest.mark.parametrize("nodes", [4, 8, 10, 20, 27])
def test_the_surface_of_a_mesh_encloses_its_volume(nodes: int) -> None:
    straight, curved = (brick((2, 3, 2), nodes, shape) for shape in (None, quarter_ring))
    assert_allclose(volume(surface(straight.points, straight.cells)), 1.0, rtol=1e-12)
    body = surface(curved.points, curved.cells)
    fine = brick((6, 12, 6), 27, quarter_ring)
    assert_allclose(volume(body), volume(surface(fine.points, fine.cells)), rtol=0.05)


def test_the_surface_of_a_shaft_encloses_its_volume() -> None:
    tube = math.pi / 4 * (0.6**2 - 0.2**2) * 0.5
    cone = math.pi / 12 * (0.4**2 + 0.4 * 0.3 + 0.3**2)
    polygon = math.sin(2 * math.pi / 48) / (2 * math.pi / 48)  # over the circle
    assert_allclose(volume(revolved(STEPPED)), polygon * (tube + cone), rtol=1e-9)


def test_the_near_body_hides_the_far_one() -> None:
    near = brick((1, 1, 1), 8, lambda p: p - [0.0, 1.5, 0.0])
    far = brick((1, 1, 1), 8, lambda p: 0.3 * p + [1.26, 0.5, -0.56])

    def orange(*bodies: object) -> int:
        shown = pixels(sketch(*bodies))  # the second body's colour
        return int((shown[..., 0] - shown[..., 2] > 20).sum())

    assert orange(far, near) > 1000
    assert orange(near, far) < 0.2 * orange(far, near)


def test_a_sketch_is_a_small_picture_on_white(tmp_path: Path) -> None:
    scene = library_scene("two_bearings")
    bodies = shaft_with_rings(scene)
    assert len(bodies) == 1 + len(scene.bearing_units)
    run = Run({}, True, tmp_path)
    assert run.sketch(*bodies) == "model.png"
    png = (tmp_path / "model.png").read_bytes()
    assert len(png) < 60_000
    shown = pixels(png)
    assert shown.shape[1] == WIDTH
    assert (shown[0] == 255).all()
    assert 0.02 < (shown < 250).any(axis=2).mean() < 0.9
