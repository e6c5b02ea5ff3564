"""What a picture shows is where the model says it is."""

import math
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from fe_drivetrain.mesh.measures import area
from fe_drivetrain.mesh.mesh import Mesh, boundary
from fe_drivetrain.report import pictures
from fe_drivetrain.report.pictures import SIZE, NoPictureError
from fe_drivetrain.response.model import Model
from fe_drivetrain.response.unit_loads import Response

needs_opengl = pytest.mark.skipif(not pictures.can_draw(), reason="no off-screen OpenGL here")

coordinates = st.tuples(*[st.floats(-20, 20)] * 3)


def pixels(path: Path) -> np.ndarray:
    return np.asarray(Image.open(path)).astype(float)


@given(st.lists(coordinates, min_size=2, max_size=8))
def test_a_fitting_view_shows_every_point(points: list[tuple[float, float, float]]) -> None:
    cloud = np.array(points)
    # as in any scene, there is some extent in every direction
    cloud = np.concatenate([cloud, cloud[:1] + np.array([[0.1, 0.1, 0.1], [0.1, -0.1, -0.1]])])
    view = pictures._View.fitting(cloud, top=30, bottom=20)
    across, down = view.project(cloud).T
    assert across.min() >= 0
    assert across.max() <= SIZE[0]
    assert down.min() >= 30 - 1e-6
    assert down.max() <= SIZE[1] - pictures._STRIP - 20 + 1e-6


def test_the_view_has_x_to_the_right_z_up_and_y_away() -> None:
    view = pictures._View.fitting(np.eye(3), top=0, bottom=0)
    axes = np.array([view.RIGHT, view.UP, view.FORWARD])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-14)
    origin, x, z = view.project(np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 1]]))
    assert x[0] > origin[0]
    assert z[1] < origin[1]
    assert z[0] == pytest.approx(origin[0])
    assert view.FORWARD[1] > 0


@needs_opengl
@pytest.mark.parametrize("point", [(0.0, 0.0, 0.0), (1.5, -0.8, 0.6), (-1.8, 0.9, -0.7)])
def test_labels_are_drawn_where_vtk_draws(point: tuple[float, float, float]) -> None:
    import pyvista

    corners = np.array([[-2.0, -1, -1], [2, 1, 1]])
    view = pictures._View.fitting(corners, top=40, bottom=40)
    with pictures._plotter(view) as plotter:
        ball = pyvista.Sphere(radius=0.05, center=point)
        plotter.add_mesh(ball, color="red", ambient=1.0, diffuse=0.0)
        canvas = pictures._Canvas(view, plotter)
    shown = np.asarray(canvas.image).astype(int)
    rows, columns = np.nonzero(shown[:, :, 0] - shown[:, :, 1] > 200)
    middle = np.array([columns.mean() + 0.5, rows.mean() + 0.5]) / pictures._OVERSAMPLING
    np.testing.assert_allclose(middle, view.project(np.array(point)), atol=1.0)


@given(st.floats(1e-9, 10.0), st.floats(0.1, 10.0))
def test_the_largest_displacement_is_drawn_at_about_8_percent(
    largest: float, length: float
) -> None:
    factor = pictures.exaggeration(largest, length)
    # one significant digit is off by a third at most
    assert factor * largest / length >= 2 / 3 * 0.08 * (1 - 1e-9)
    assert factor * largest / length <= 4 / 3 * 0.08 * (1 + 1e-9)
    assert factor == float(f"{factor:.0e}")


def test_what_does_not_move_is_not_exaggerated() -> None:
    assert pictures.exaggeration(0.0, 4.76) == 1.0


@given(st.floats(1e-12, 1e12), st.integers(1, 9))
def test_steps_are_round_and_not_too_many(largest: float, most: int) -> None:
    step = pictures._round_step(largest, most)
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
    assert pictures.with_prefix(value, "Pa") == text


def test_a_curved_surface_has_the_area_of_the_mesh(bonded_model: Model) -> None:
    mesh = bonded_model.mesh
    for face in ("shaft.front", "main_bearing.outer", "main_bearing.housing.base"):
        surface = pictures._curved_surface(mesh.faces[face], mesh.points)
        # flat triangles inscribed in curved ones lose a little area
        assert surface.area == pytest.approx(area(mesh, face), rel=5e-3)
        assert surface.area <= area(mesh, face) * (1 + 1e-9)


def test_a_curved_surface_is_closed_and_carries_quadratic_values(bonded_model: Model) -> None:
    mesh = bonded_model.mesh
    quadratic = np.stack([mesh.points[:, 0], mesh.points[:, 1] - 2 * mesh.points[:, 2]], axis=1)
    surface = pictures._curved_surface(boundary(mesh, "shaft"), mesh.points, quadratic)
    assert surface.n_open_edges == 0
    x, y, z = surface.points.T
    np.testing.assert_allclose(surface["values"], np.stack([x, y - 2 * z], axis=1), atol=1e-6)


def test_cutting_a_ring_open_takes_a_quarter_and_closes_the_cut(bonded_model: Model) -> None:
    mesh, bearing = bonded_model.mesh, bonded_model.scene.bearing_units[0].bearing
    surface = pictures._curved_surface(boundary(mesh, bearing.name), mesh.points)
    grid, owner = pictures._linear_grid(mesh)
    number = mesh.part_names.index(bearing.name)
    cut, edges = pictures._cut_open(surface, grid.extract_cells(np.flatnonzero(owner == number)))
    inner, outer = 0.2, bearing.raceway_diameter / 2
    section = bearing.width * (outer - inner)
    whole = 2 * np.pi * (inner + outer) * bearing.width + 2 * np.pi * (outer**2 - inner**2)
    # the coarse mesh inscribes polygons of 24 sides in the circles
    assert cut.area == pytest.approx(0.75 * whole + 2 * section, rel=1e-2)
    for shape in (cut, edges):
        _, y, z = np.asarray(shape.points).T
        assert ((y >= -1e-6) | (z <= 1e-6)).all()


def test_straight_pieces_fill_the_elements(bonded_model: Model) -> None:
    mesh = bonded_model.mesh
    grid, owner = pictures._linear_grid(mesh)
    assert grid.n_cells == len(owner) == 8 * len(mesh.cells)
    # which way round a piece is does not matter for drawing
    volumes = np.abs(grid.compute_cell_sizes(length=False, area=False, volume=True)["Volume"])
    # by part: twice as many sides of the polygon as the corners alone make
    shaft = bonded_model.scene.shaft
    exact = np.pi / 4 * shaft.sections[0].outer_diameter ** 2 * shaft.length
    assert volumes.min() > 0
    assert volumes[owner == mesh.part_names.index("shaft")].sum() == pytest.approx(exact, rel=0.03)


@pytest.fixture
def without_display(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)


def parts_seen(path: Path) -> set[str]:
    """Kinds of part whose hue covers at least a tenth of a percent of the picture."""
    image = pixels(path)[: SIZE[1] - pictures._STRIP]
    shade = image.reshape(-1, 3)
    shade = shade[shade.min(axis=1) < 200]
    shade = shade / np.linalg.norm(shade, axis=1, keepdims=True).clip(1e-9)
    seen = set()
    for kind, colour in pictures._PARTS.items():
        hue = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)], dtype=float)
        alike = shade @ (hue / np.linalg.norm(hue)) > 0.9995
        if alike.sum() > 0.001 * SIZE[0] * SIZE[1]:
            seen.add(kind)
    return seen


@needs_opengl
@pytest.mark.usefixtures("without_display")
def test_the_model_is_drawn_with_all_its_parts(bonded_model: Model, tmp_path: Path) -> None:
    pictures.picture_of_model(bonded_model, tmp_path / "model.png")
    assert pixels(tmp_path / "model.png").shape == (SIZE[1], SIZE[0], 3)
    assert parts_seen(tmp_path / "model.png") == {"shaft", "bearing", "housing"}


@needs_opengl
@pytest.mark.usefixtures("without_display")
def test_the_deformation_is_drawn_and_its_factor_follows_the_load(
    bonded_model: Model, bonded_response: Response, tmp_path: Path
) -> None:
    loads = np.zeros(10)
    loads[2], loads[9] = -5e5, 392280.0
    first = pictures.picture_of_deformation(
        bonded_model, bonded_response, loads, tmp_path / "1.png", "down"
    )
    tenfold = pictures.picture_of_deformation(
        bonded_model, bonded_response, 10 * loads, tmp_path / "10.png", "down"
    )
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
    assert pictures.picture_of_deformation(bonded_model, bonded_response, np.zeros(10), path) == 1
    assert path.exists()


def test_a_displacement_that_is_not_finite_is_refused(
    bonded_model: Model, bonded_response: Response, tmp_path: Path
) -> None:
    loads = np.full(10, np.nan)
    with pytest.raises(ValueError, match="finite"):
        pictures.picture_of_deformation(bonded_model, bonded_response, loads, tmp_path / "x.png")


@pytest.fixture
def crashing_renderer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """An interpreter that dies as VTK does where there is no OpenGL at all."""
    interpreter = tmp_path / "python"
    interpreter.write_text("#!/bin/sh\nkill -SEGV $$\n")
    interpreter.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(interpreter))
    pictures._refusal.cache_clear()
    yield
    pictures._refusal.cache_clear()


@pytest.mark.usefixtures("crashing_renderer")
def test_a_machine_that_cannot_draw_says_so(bonded_model: Model, tmp_path: Path) -> None:
    assert not pictures.can_draw()
    with pytest.raises(NoPictureError, match="OpenGL"):
        pictures.picture_of_model(bonded_model, tmp_path / "model.png")
    assert not (tmp_path / "model.png").exists()


def test_the_mesh_is_left_as_it_was(spherical_mesh: Mesh) -> None:
    before = spherical_mesh.points.copy()
    grid, _ = pictures._linear_grid(spherical_mesh)
    grid.points += 1.0
    surface = pictures._curved_surface(boundary(spherical_mesh), spherical_mesh.points)
    surface.points += 1.0
    np.testing.assert_array_equal(spherical_mesh.points, before)
