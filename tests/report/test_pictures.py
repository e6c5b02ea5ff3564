"""What a picture shows is where the model says it is."""

import math
import subprocess
import sys
from collections.abc import Iterator
from multiprocessing.resource_tracker import ensure_running
from multiprocessing.spawn import get_executable, set_executable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from fe_drivetrain.common.typeset import with_prefix
from fe_drivetrain.elasticity.mesh.measures import area
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary
from fe_drivetrain.report.pictures import drawing_process
from fe_drivetrain.report.pictures.deformation import (
    exaggeration,
    picture_of_deformation,
    picture_of_displacements,
)
from fe_drivetrain.report.pictures.drawing_process import NoPictureError, can_draw, drawn
from fe_drivetrain.report.pictures.model import PARTS, picture_of_model
from fe_drivetrain.report.pictures.sheet import Plan, Sheet, drawing, round_step
from fe_drivetrain.report.pictures.surfaces import curved_surface, cut_open, part_solid
from fe_drivetrain.report.pictures.view import ALONG_THE_SHAFT, SIZE, STRIP, View
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.unit_loads import Response

needs_opengl = pytest.mark.skipif("not can_draw()", reason="no off-screen OpenGL here")

coordinates = st.tuples(*[st.floats(-20, 20)] * 3)


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path).convert("RGB")).astype(float)


def solid_of(mesh: Mesh, part: str) -> Any:
    return part_solid(mesh.cells[mesh.part_cells(part)], mesh.points)


def middle_of(shown: np.ndarray) -> np.ndarray:
    """Where the pixels are, from the lower left corner, that a mask shows."""
    rows, columns = np.nonzero(shown)
    return np.array([columns.mean() + 0.5, SIZE[1] - rows.mean() - 0.5])


@given(st.lists(coordinates, min_size=2, max_size=8))
def test_a_fitting_view_shows_every_point(points: list[tuple[float, float, float]]) -> None:
    cloud = np.array(points)
    # as in any scene, there is some extent in every direction
    cloud = np.concatenate([cloud, cloud[:1] + np.array([[0.1, 0.1, 0.1], [0.1, -0.1, -0.1]])])
    view = View.fitting(cloud, ALONG_THE_SHAFT, top=30, bottom=STRIP + 20)
    across, along = view.project(cloud).T
    assert across.min() >= 0
    assert across.max() <= SIZE[0]
    assert along.min() >= STRIP + 20 - 1e-6
    assert along.max() <= SIZE[1] - 30 + 1e-6


@given(st.lists(coordinates, min_size=2, max_size=8), st.floats(0, 1600), st.floats(0, 900))
def test_what_is_in_front_is_seen_at_its_pixel_and_hidden_by_nothing(
    points: list[tuple[float, float, float]], across: float, along: float
) -> None:
    cloud = np.array(points)
    cloud = np.concatenate([cloud, cloud[:1] + np.array([[0.1, 0.1, 0.1], [0.1, -0.1, -0.1]])])
    view = View.fitting(cloud, ALONG_THE_SHAFT, top=30)
    place = view.in_front([across, along])
    np.testing.assert_allclose(view.project(place), [across, along], atol=1e-6)
    assert (cloud @ view.forward).min() > place @ view.forward


def test_the_view_has_x_to_the_right_z_up_and_y_away() -> None:
    view = View.fitting(np.eye(3), ALONG_THE_SHAFT, top=0)
    axes = np.array([view.right, view.up, view.forward])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-14)
    origin, x, z = view.project([[0.0, 0, 0], [1, 0, 0], [0, 0, 1]])
    assert x[0] > origin[0]
    assert z[1] > origin[1]
    assert z[0] == pytest.approx(origin[0])
    assert view.forward[1] > 0


@needs_opengl
@pytest.mark.parametrize("point", [(0.0, 0.0, 0.0), (1.5, -0.8, 0.6), (-1.8, 0.9, -0.7)])
def test_bodies_lines_and_text_are_drawn_where_the_view_says(
    point: tuple[float, float, float], tmp_path: Path
) -> None:
    import pyvista

    corners = np.array([[-2.0, -1, -1], [2, 1, 1]])
    view = View.fitting(corners, ALONG_THE_SHAFT, top=40, bottom=STRIP + 40)
    seen = view.project(point)
    above, below = seen + np.array([0, 60]), seen - np.array([0, 60])
    square = np.array([(-9, -9), (9, -9), (9, 9), (-9, 9)])
    with drawing(tmp_path / "marks.png", view) as sheet:
        ball = pyvista.Sphere(radius=0.05, center=point)
        sheet.plotter.add_mesh(ball, color="red", ambient=1.0, diffuse=0.0)
        sheet.area(above + square, "#00ff00")
        sheet.text(below, "HHH", "#0000ff")
    red, green, blue = np.moveaxis(pixels(tmp_path / "marks.png"), -1, 0)
    np.testing.assert_allclose(middle_of(red - green > 200), seen, atol=1.0)
    np.testing.assert_allclose(middle_of(green - red > 200), above, atol=1.0)
    # of a line of text 16 pixels high, a quarter is left free below capitals
    np.testing.assert_allclose(middle_of(blue - red > 100), below, atol=4.0)


@needs_opengl
def test_notes_keep_clear_of_each_other_and_inside_the_drawing(tmp_path: Path) -> None:
    view = View.fitting(np.array([[-2.0, -1, -1], [2, 1, 1]]), ALONG_THE_SHAFT, top=40)
    with drawing(tmp_path / "notes.png", view) as sheet:
        for k in range(4):
            sheet.note([0.01 * k, 0.0, 0.0], f"bearing {k}", (-60, 150))
        sheet.note([2.0, 1.0, 1.0], "a name longer than the room beside it", (400, 400))
        sheet.note([-2.0, -1.0, -1.0], "below", (-400, -400))
    boxes = np.array(sheet.taken)
    for k, (low, high) in enumerate(boxes):
        assert (low >= [0, STRIP]).all()
        assert (high <= SIZE).all()
        for other_low, other_high in boxes[:k]:
            assert (low >= other_high).any() or (other_low >= high).any()


@given(st.floats(1e-9, 10.0), st.floats(0.1, 10.0))
def test_the_largest_displacement_is_drawn_at_about_8_percent(
    largest: float, length: float
) -> None:
    factor = exaggeration(largest, length)
    # one significant digit is wrong by a third at most
    assert factor * largest / length >= 2 / 3 * 0.08 * (1 - 1e-9)
    assert factor * largest / length <= 4 / 3 * 0.08 * (1 + 1e-9)
    assert factor == float(f"{factor:.0e}")


def test_what_does_not_move_is_not_exaggerated() -> None:
    assert exaggeration(0.0, 4.76) == 1.0


@given(st.floats(1e-12, 1e12), st.integers(1, 9))
def test_steps_are_round_and_not_too_many(largest: float, most: int) -> None:
    step = round_step(largest, most)
    mantissa = step / 10.0 ** math.floor(math.log10(step) + 1e-9)
    assert min(abs(mantissa - m) for m in (1, 2, 5)) < 1e-6
    assert largest / step <= most * (1 + 1e-6)
    assert largest / step > most / 2.5 * (1 - 1e-6)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (4e6, "4 MPa"),
        (392280.0, "392.3 kPa"),
        (1.45e8, "145 MPa"),
        (0.5, "0.5 Pa"),
        (2e14, "200 TPa"),
    ],
)
def test_prefixes(value: float, text: str) -> None:
    assert with_prefix(value, "Pa") == text


def test_a_curved_surface_has_the_area_of_the_mesh(bonded_model: Model) -> None:
    mesh = bonded_model.mesh
    for face in ("shaft.front", "main_bearing.outer", "main_bearing.housing.base"):
        surface = curved_surface(mesh.faces[face], mesh.points)
        # flat triangles inscribed in curved ones lose a little area: sixteen chords round a turn
        lost = 1 - np.sinc(1 / 16)
        assert surface.area == pytest.approx(area(mesh, face), rel=lost)
        # and VTK keeps the points that it adds in single precision, to 6e-8 of their coordinates
        assert surface.area <= area(mesh, face) * (1 + 2e-7)


def test_a_curved_surface_is_closed_and_carries_vectors_exactly(bonded_model: Model) -> None:
    mesh = bonded_model.mesh
    x, y, z = mesh.points.T
    linear = np.stack([x, y - 2 * z, x + z], axis=1)
    surface = curved_surface(boundary(mesh, "shaft"), mesh.points, linear)
    assert surface.n_open_edges == 0
    x, y, z = surface.points.T
    expected = np.stack([x, y - 2 * z, x + z], axis=1)
    np.testing.assert_allclose(surface["vectors"], expected, atol=1e-6)


def test_cutting_a_ring_open_takes_a_quarter_and_closes_the_cut(bonded_model: Model) -> None:
    mesh, bearing = bonded_model.mesh, bonded_model.scene.bearing_units[0].bearing
    surface = curved_surface(boundary(mesh, bearing.name), mesh.points)
    cut, edges = cut_open(surface, solid_of(mesh, bearing.name))
    inner, outer = 0.2, bearing.raceway_diameter / 2
    section = bearing.width * (outer - inner)
    whole = 2 * np.pi * (inner + outer) * bearing.width + 2 * np.pi * (outer**2 - inner**2)
    # the coarse mesh inscribes polygons of 24 sides in the circles
    assert cut.area == pytest.approx(0.75 * whole + 2 * section, rel=1e-2)
    for shape in (cut, edges):
        _, y, z = np.asarray(shape.points).T
        assert ((y >= -1e-6) | (z <= 1e-6)).all()


def test_the_section_of_a_solid_follows_its_curved_elements(bonded_model: Model) -> None:
    mesh, shaft = bonded_model.mesh, bonded_model.scene.shaft
    radius = shaft.sections[0].outer_diameter / 2
    section = solid_of(mesh, "shaft").slice("x", origin=(shaft.front + 0.37, 0.0, 0.0))
    corners = 12  # of the mesh around the shaft; with mid-side nodes there are twice as many
    polygon = 0.5 * radius**2 * 2 * corners * np.sin(np.pi / corners)
    assert polygon < 0.99 * np.pi * radius**2
    assert section.area == pytest.approx(np.pi * radius**2, rel=0.03)


@pytest.fixture
def without_display(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)


def parts_seen(path: Path) -> set[str]:
    """Kinds of part whose hue covers at least a tenth of a percent of the picture."""
    image = pixels(path)[: SIZE[1] - STRIP]
    shade = image.reshape(-1, 3)
    shade = shade[shade.min(axis=1) < 200]
    shade = shade / np.linalg.norm(shade, axis=1, keepdims=True).clip(1e-9)
    seen = set()
    for kind, colour in PARTS.items():
        hue = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)], dtype=float)
        same = shade @ (hue / np.linalg.norm(hue)) > 0.9995
        if same.sum() > 0.001 * SIZE[0] * SIZE[1]:
            seen.add(kind)
    return seen


@needs_opengl
@pytest.mark.usefixtures("without_display")
def test_the_model_is_drawn_with_all_its_parts(bonded_model: Model, tmp_path: Path) -> None:
    picture_of_model(bonded_model, tmp_path / "model.png").wait()
    assert pixels(tmp_path / "model.png").shape == (SIZE[1], SIZE[0], 3)
    assert parts_seen(tmp_path / "model.png") == {"shaft", "bearing", "housing"}


@needs_opengl
@pytest.mark.usefixtures("without_display")
def test_the_deformation_is_drawn_and_its_factor_follows_the_load(
    bonded_model: Model, bonded_response: Response, tmp_path: Path
) -> None:
    loads = np.zeros(10)
    loads[2], loads[9] = -5e5, 392280.0
    first, _ = picture_of_deformation(
        bonded_model, bonded_response, loads, tmp_path / "1.png", "down"
    )
    tenfold, drawn = picture_of_deformation(
        bonded_model, bonded_response, 10 * loads, tmp_path / "10.png", "down"
    )
    drawn.wait()  # pictures are drawn one after the other
    assert tenfold == pytest.approx(first / 10)
    # the same shape: only what is written about it differs
    difference = np.abs(pixels(tmp_path / "1.png") - pixels(tmp_path / "10.png")).max(axis=2)
    assert (difference > 60).mean() < 0.01
    assert pixels(tmp_path / "1.png").std() > 10


@needs_opengl
def test_no_load_is_no_deformation(
    bonded_model: Model, bonded_response: Response, tmp_path: Path
) -> None:
    path = tmp_path / "still.png"
    factor, drawn = picture_of_deformation(bonded_model, bonded_response, np.zeros(10), path)
    drawn.wait()
    assert factor == 1
    assert path.exists()


@needs_opengl
def test_a_component_is_drawn_in_the_colours_of_its_displacements(
    spherical_mesh: Mesh, tmp_path: Path
) -> None:
    path = tmp_path / "component.png"
    u = np.zeros_like(spherical_mesh.points)
    u[:, 2] = 1e-3 * (spherical_mesh.points[:, 0] - spherical_mesh.points[:, 0].min())
    length = np.ptp(spherical_mesh.points, axis=0).max()
    factor, drawn = picture_of_displacements(spherical_mesh, u, path)
    drawn.wait()
    assert factor == exaggeration(1e-3 * length, length) == 80
    image = pixels(path)
    assert image.shape == (SIZE[1], SIZE[0], 3)
    # the upwind end, which does not move, is in front and dark violet; the other is yellow
    red, green, blue = np.moveaxis(image[:-180], -1, 0)
    yellow, violet = (red > 150) & (blue < 80), (blue > green + 30) & (red > green + 20)
    assert violet.sum() > 1000
    assert yellow.sum() > 1000
    assert middle_of(np.pad(violet, ((0, 180), (0, 0))))[0] > SIZE[0] / 2
    assert middle_of(np.pad(yellow, ((0, 180), (0, 0))))[0] < SIZE[0] / 2


@needs_opengl
@pytest.mark.parametrize("shift", [0.0, 1e-3])
def test_a_component_that_moves_as_a_whole_is_drawn(
    shift: float, spherical_mesh: Mesh, tmp_path: Path
) -> None:
    u = np.full_like(spherical_mesh.points, shift)
    factor, drawn = picture_of_displacements(spherical_mesh, u, tmp_path / "component.png")
    drawn.wait()
    assert (factor == 1) == (shift == 0)
    assert (tmp_path / "component.png").exists()


def test_a_displacement_that_is_not_finite_is_refused(
    bonded_model: Model, bonded_response: Response, tmp_path: Path
) -> None:
    loads = np.full(10, np.nan)
    with pytest.raises(ValueError, match="finite"):
        picture_of_deformation(bonded_model, bonded_response, loads, tmp_path / "x.png")


@needs_opengl
def test_vtk_is_loaded_by_the_process_that_draws_and_never_by_its_parent(tmp_path: Path) -> None:
    script = tmp_path / "draw.py"
    script.write_text(
        "import sys\n"
        "from pathlib import Path\n"
        "from fe_drivetrain.drivetrain_file import library_scene\n"
        "from fe_drivetrain.report import drawing_ready, picture_of_model\n"
        "from fe_drivetrain.shafts.response import build_model, mesh_scene\n"
        "from fe_drivetrain.studies.scene_description import quick_scene\n"
        "with drawing_ready():\n"
        "    scene = quick_scene(library_scene('main_bearing_bonded'))\n"
        "    picture_of_model(build_model(scene, mesh_scene(scene)), Path('model.png')).wait()\n"
        "assert not {'pyvista', 'vtkmodules', 'matplotlib'} & set(sys.modules)\n"
    )
    done = subprocess.run([sys.executable, script], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert parts_seen(tmp_path / "model.png") == {"shaft", "bearing", "housing"}


@needs_opengl
def test_what_goes_wrong_in_drawing_is_raised_when_the_picture_is_asked_for(
    tmp_path: Path,
) -> None:
    view = View.fitting(np.eye(3), ALONG_THE_SHAFT, top=0)
    plan = Plan(view)
    plan.add(Sheet.area, "no corners", "#000000")
    path = tmp_path / "none.png"
    with pytest.raises(TypeError):
        drawn(plan, path).wait()
    assert not path.exists()
    drawn(Plan(view), path).wait()  # the process has outlived it
    assert path.exists()


@pytest.fixture
def crashing_renderer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """An interpreter that dies as VTK does where there is no OpenGL at all."""
    interpreter = tmp_path / "python"
    interpreter.write_text("#!/bin/sh\nkill -SEGV $$\n")
    interpreter.chmod(0o755)
    ensure_running()  # multiprocessing's own process does not draw
    before = get_executable()
    set_executable(str(interpreter))
    with monkeypatch.context() as patch:
        patch.setattr(drawing_process, "_process", None)
        yield
        drawing_process._process.end()
    set_executable(before)


@pytest.mark.usefixtures("crashing_renderer")
def test_a_machine_that_cannot_draw_says_so(bonded_model: Model, tmp_path: Path) -> None:
    assert not can_draw()
    with pytest.raises(NoPictureError, match="OpenGL"):
        picture_of_model(bonded_model, tmp_path / "model.png")
    with pytest.raises(NoPictureError, match="OpenGL"):
        picture_of_displacements(
            bonded_model.mesh, np.zeros_like(bonded_model.mesh.points), tmp_path / "model.png"
        )
    assert not (tmp_path / "model.png").exists()


def test_the_mesh_is_left_as_it_was(spherical_mesh: Mesh) -> None:
    before = spherical_mesh.points.copy()
    solid = solid_of(spherical_mesh, "shaft")
    solid.points += 1.0
    surface = curved_surface(boundary(spherical_mesh), spherical_mesh.points)
    surface.points += 1.0
    np.testing.assert_array_equal(spherical_mesh.points, before)
