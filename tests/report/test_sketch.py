"""Sketches of bodies: closed surfaces turned outward, and what is in front hides what is behind."""

import io
import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from fe_drivetrain.bearing import Bearing, RollerRow, ball_row, catalogue_bearing
from fe_drivetrain.bearing.geometry import count
from fe_drivetrain.cases.references.fillet_factors import shouldered
from fe_drivetrain.cases.references.manufactured import quarter_ring
from fe_drivetrain.cases.references.published_gears import iso_example_1
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.geometry.shaft import Section, Shaft
from fe_drivetrain.report.pictures.rollers import rolling_elements
from fe_drivetrain.report.pictures.sketch import (
    WIDTH,
    Faces,
    revolved,
    shaft_with_rings,
    sketch,
    surface,
)
from fe_drivetrain.report.pictures.teeth import gear_pair
from fe_drivetrain.report.suite.run import Run

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


def test_a_fillet_is_drawn_where_it_is() -> None:
    wide, radius = 1.6, 0.25
    shaft = shouldered(wide, radius)
    # by Pappus: a square of the fillet's radius less eight triangles to its centre
    turn = math.pi / 16
    triangle, away = radius**2 / 2 * math.sin(turn), 2 / 3 * radius * math.cos(turn / 2)
    centroids = 0.5 + radius - away * np.sin(turn * (np.arange(8) + 0.5))
    moment = radius**2 * (0.5 + radius / 2) - triangle * centroids.sum()
    exact = math.pi / 4 * sum(s.length * s.outer_diameter**2 for s in shaft.sections)
    exact += 2 * math.pi * moment
    polygon = math.sin(2 * math.pi / 48) / (2 * math.pi / 48)  # over the circle
    assert_allclose(volume(revolved(shaft)), polygon * exact, rtol=1e-9)


def test_rollers_and_balls_have_their_volume_and_place() -> None:
    rollers = catalogue_bearing("bearing_s_o20")
    balls = Bearing("ball", (ball_row(7, 0.0115, 0.0435),))
    polygon = math.sin(math.pi / 8) / (math.pi / 8)  # of sixteen sides, over the circle
    # frusta of a ball whose half circle is eight chords
    r = np.sin(np.linspace(0.0, math.pi, 9))
    heights = -np.diff(np.cos(np.linspace(0.0, math.pi, 9)))
    ball = math.pi / 3 * (heights * (r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2)).sum()
    for bearing, own in ((rollers, math.pi / 4), (balls, ball / 8)):
        for row, faces in zip(bearing.rows, rolling_elements(bearing), strict=True):
            length = row.length if isinstance(row, RollerRow) else row.diameter
            exact = polygon * count(row) * own * row.diameter**2 * length
            assert_allclose(volume(faces), exact, rtol=1e-9)
            points = faces[0].loops.reshape(-1, 3)
            assert_allclose(points.mean(axis=0), [row.place, 0.0, 0.0], atol=1e-9)
    # an axis at right angles to the contact normal: raised on one side by sin(angle)
    row = rollers.rows[0]
    loops = rolling_elements(rollers)[0][0].loops
    first = loops[: len(loops) // row.rollers].reshape(-1, 3) - [row.place, row.radius, 0.0]
    along = [math.cos(row.angle), -math.sin(row.angle), 0.0]
    assert_allclose(np.abs(first @ along).max(), 0.5 * row.length, rtol=1e-9)


def test_gears_are_drawn_in_mesh_and_do_not_enter_one_another() -> None:
    pair = iso_example_1()
    first, second = gear_pair(pair)
    for gear, faces, at in (
        (pair.first, first, 0.0),
        (pair.second, second, sum(pair.working_radii)),
    ):
        ends = faces[0].loops
        radii = np.hypot(ends[..., 1] - at, ends[..., 2])
        assert_allclose(radii.max(), gear.tip_radius, rtol=1e-9)
        assert_allclose(radii.min(), gear.root_radius, rtol=1e-9)
        between = math.pi * pair.face_width * np.array([gear.root_radius, gear.tip_radius]) ** 2
        assert between[0] < volume(faces) < between[1]
    # at one end, where the tooth in the middle of the first gear stands in a space of the second
    tips = first[0].loops[1][:, 1:]
    shape = second[0].loops[1][:, 1:]
    assert not inside(tips, shape).any()
    assert not inside(shape, tips).any()


def inside(points: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Whether points lie in a polygon, by the crossings of a ray."""
    found = np.zeros(len(points), dtype=bool)
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        crosses = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
        share = (points[:, 1] - a[1]) / np.where(b[1] == a[1], 1.0, b[1] - a[1])
        found ^= crosses & (points[:, 0] < a[0] + share * (b[0] - a[0]))
    return found


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
