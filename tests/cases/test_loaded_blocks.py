"""Blocks as benchmarks use them: spacing, supports and loads by face, series of meshes."""

import numpy as np
import pytest

from fe_drivetrain.cases.references.loaded_blocks import (
    edge_nodes,
    face_loads,
    graded,
    line_of,
    solve_block,
    supports,
)
from fe_drivetrain.comparison.convergence import band_of
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.mesh.blocks import Block, brick
from fe_drivetrain.elasticity.operator.loads import pressure
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import MeshSeries
from fe_drivetrain.report.suite.targets import Target

STEEL = Material(youngs_modulus=200e9, poisson_ratio=0.3, density=0.0)


@pytest.fixture(scope="module")
def bar() -> Block:
    return brick((2, 1, 1), 27, lambda unit: unit * [2.0, 0.5, 0.5])


def test_elements_are_thinner_towards_the_named_faces() -> None:
    x, y, z = graded((4, 4, 4), 2.0, "x0", "y1", "z0", "z1")
    assert x is not None
    assert y is not None
    assert z is not None
    assert x == pytest.approx([0.0, 1 / 16, 1 / 4, 9 / 16, 1.0])
    assert y == pytest.approx(1.0 - x[::-1])
    # each half is the other's mirror image, and graded as one face is
    assert z == pytest.approx(1.0 - z[::-1])
    assert z[:3] == pytest.approx([0.0, 0.125, 0.5])
    assert graded((2, 2, 2), 1.5, "z1")[:2] == (None, None)
    assert graded((3, 1, 1), 1.0, "x0", "x1")[0] == pytest.approx([0.0, 1 / 3, 2 / 3, 1.0])


def test_grading_towards_a_face_that_there_is_not() -> None:
    with pytest.raises(ValueError, match="no face 'top'"):
        graded((2, 2, 2), 1.5, "x0", "top")


def test_a_degree_of_freedom_is_fixed_once_however_often_it_is_named(bar: Block) -> None:
    corner = edge_nodes(bar, "x0", "y0", along=2)
    held = supports(bar, (corner[0], "xyz"), (corner, "z"), x0="x", y0="y")
    assert len(np.unique(held.pivots)) == len(held.pivots)
    nodes = {axis: set(held.pivots[held.pivots % 3 == axis] // 3) for axis in range(3)}
    assert nodes[0] == set(bar.face_nodes("x0"))
    assert nodes[1] == set(bar.face_nodes("y0"))
    assert nodes[2] == set(corner)


def test_an_edge_runs_along_its_axis(bar: Block) -> None:
    edge = bar.points[edge_nodes(bar, "y1", "z0", along=0)]
    assert edge[:, 0] == pytest.approx([0.0, 0.5, 1.0, 1.5, 2.0])
    assert np.all(edge[:, 1:] == [0.5, 0.0])


def test_a_line_is_what_a_face_has_at_one_place(bar: Block) -> None:
    line = bar.points[line_of(bar, "x1", 2, 0.25)]
    assert np.all(line[:, [0, 2]] == [2.0, 0.25])
    assert sorted(line[:, 1]) == pytest.approx([0.0, 0.25, 0.5])


def test_a_bar_between_planes_of_symmetry_is_stretched_uniformly(bar: Block) -> None:
    F = face_loads(bar, x1=pressure(-1e8), y1=np.array([0.0, 0.0, 0.0]))
    assert F.reshape(-1, 3).sum(axis=0) == pytest.approx([0.25e8, 0.0, 0.0], abs=1.0)
    found = solve_block(bar, STEEL, F, supports(bar, x0="x", y0="y", z0="z"))
    strain = 1e8 / 200e9
    far = found.node(2.0, 0.5, 0.5)
    assert found.u[far] == pytest.approx(strain * np.array([2.0, -0.15, -0.15]), rel=1e-9)
    np.testing.assert_allclose(found.stress[:, 0], 1e8, rtol=1e-8)
    np.testing.assert_allclose(found.stress[:, 1:], 0.0, atol=1.0)
    # along x only: nothing in the plane of the polar components
    np.testing.assert_allclose(found.polar.hoop, 0.0, atol=1.0)
    # the corner is on the diagonal: both transverse displacements point to the axis
    transverse = -0.3 * strain * 0.5 * np.sqrt(2.0)
    assert found.polar_u[far] == pytest.approx([2.0 * strain, transverse, 0.0], rel=1e-9, abs=1e-12)
    assert found.energy == pytest.approx(0.5 * 1e8 * strain * 0.5, rel=1e-9)
    # three planes of the 45 nodes are held, of 5, 9 and 3 times as many
    assert found.unknowns == 3 * 45 - 9 - 15 - 15
    assert found.load(0) == pytest.approx(0.25e8)
    assert found.imbalance(0) == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(ValueError, match="no node"):
        found.node(0.1, 0.0, 0.0)


def test_the_finest_of_a_series_is_judged_with_the_band_of_all() -> None:
    rows = [{"elements": n, "deflection [mm]": 2.0 + 1.0 / n**2} for n in (2, 4, 8)]
    page, series = Page(), MeshSeries(rows, "elements")
    page.finest(series, Target("deflection [mm]", 2.0, 0.01, "why", "source"))
    (found,) = page.checks
    assert (found.quantity, found.unit, found.measure) == ("deflection", "mm", "deflection")
    assert found.computed == 2.0 + 1.0 / 64
    assert found.passed
    values = [row["deflection [mm]"] for row in rows]
    assert found.band == band_of([1 / 2, 1 / 4, 1 / 8], values)
    # 8, 64 and 512 unknowns of a solid are the same refinement
    cubes = [{"unknowns": row["elements"] ** 3, **row} for row in rows]
    by_unknowns = MeshSeries(cubes, "unknowns", dimension=3)
    assert by_unknowns.band("deflection [mm]") == pytest.approx(found.band, rel=1e-9)


def test_targets_are_checked_and_shown_beside_the_meshes() -> None:
    rows = [{"elements": n, "twist [mrad]": 4.0 + 1.0 / n**2, "more": n} for n in (1, 2, 4)]
    page = Page()
    printed = Target("twist [mrad]", 4.0, 0.02, "rounding", "a manual", order=2.0)
    closed = Target("twist [mrad]", 4.3, 0.1, "shear", "a book", "closed form", relative=False)
    page.targets("By mesh", MeshSeries(rows, "elements"), [printed, closed])
    assert [(v.quantity, v.passed) for v in page.checks] == [
        ("twist", True),
        ("closed form", False),
    ]
    assert {v.measure for v in page.checks} == {"rotation"}
    (table,) = page.sections[0].items
    assert [row[0] for row in table.rows] == ["twist [mrad]", "closed form [mrad]"]
    assert [row[-1] for row in table.rows] == [4.0, 4.3]
    meshes = ["1 element", "2 elements", "4 elements"]
    assert table.columns == ["quantity", *meshes, "target"]
    assert page.tables["By mesh"][0] == {"elements": 1, "twist [mrad]": 5.0}
