"""Sectors of rings: planes of symmetry, polar components, sections."""

import numpy as np
import pytest
from scipy.integrate import trapezoid

from fe_drivetrain.cases.references.bar_sections import (
    round_bar,
    section_motion,
    section_stresses,
    solve_bar,
)
from fe_drivetrain.cases.references.plane_rings import Lame, Plane, Rotating
from fe_drivetrain.cases.references.ring_slices import (
    divided_sector,
    half_wave,
    slice_supports,
    wave_pressure,
)
from fe_drivetrain.cases.references.ring_solids import (
    facets_where,
    moves_as_one,
    node_at,
    polar_stresses,
    polar_traction,
    ring_sector,
    sector_symmetry,
)
from fe_drivetrain.cases.verification.quarter_disc import quarter_disc
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.interfaces.constraints import held_nodes
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.operator.loads import body_loads, pressure, traction_loads
from fe_drivetrain.elasticity.solve.solid import solve_solid

E, NU = 3.0, 0.25
LAME = (E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU)))


@pytest.mark.parametrize("angle", [np.pi / 3, np.pi / 2, 2.0])
def test_a_sector_between_planes_of_symmetry_is_the_whole_ring(angle):
    """Whatever the angle, a pressurised ring opens as Lame says."""
    block = ring_sector(1.0, 2.0, 0.1, angle, (4, 8, 1))
    n = block.points.size
    held = [*sector_symmetry(block, angle), held_nodes("side", block.face_nodes("z0"), [0], n)]
    F = traction_loads(block.points, block.faces["x0"], pressure(1.0))
    u = solve_solid(block.points, block.cells, LAME, held, F).u.reshape(-1, 3)
    r = np.hypot(block.points[:, 1], block.points[:, 2])
    radial = (u[:, 1:] * block.points[:, 1:]).sum(axis=1) / r
    exact = Lame(1.0, 2.0, inside=1.0).displacement(r, Plane(E, NU))
    np.testing.assert_allclose(radial, exact, rtol=2e-3)


def test_ends_that_move_as_one():
    block = ring_sector(1.0, 2.0, 0.5, np.pi / 2, (2, 4, 1))
    n = block.points.size
    end = block.face_nodes("z1")
    held = [
        *sector_symmetry(block, np.pi / 2),
        held_nodes("side", block.face_nodes("z0"), [0], n),
        moves_as_one("end", end, 0, n),
    ]
    F = np.zeros(n)
    F[3 * end[3]] = 1.0
    static = solve_solid(block.points, block.cells, LAME, held, F)
    moved = static.u[3 * end, 0]
    assert moved[0] > 0.0
    np.testing.assert_allclose(moved, moved[0], rtol=1e-9)
    # the force of one node is spread over the end, and its sum goes to the other side
    assert static.reactions["side"][::3].sum() == pytest.approx(-1.0, rel=1e-8)


def test_polar_components_of_a_uniform_stress():
    """Tension along y: 1 along the radius at t = 0, round it at 90 degrees, shear between."""
    t = np.radians([0.0, 45.0, 90.0])
    points = np.column_stack([np.zeros(3), 2.0 * np.cos(t), 2.0 * np.sin(t)])
    s = np.tile([0.0, 1.0, 0.0, 0.0, 0.0, 0.0], (3, 1))
    polar = polar_stresses(s, points)
    np.testing.assert_allclose(polar.radial, [1.0, 0.5, 0.0], atol=1e-15)
    np.testing.assert_allclose(polar.hoop, [0.0, 0.5, 1.0], atol=1e-15)
    np.testing.assert_allclose(polar.shear, [0.0, -0.5, 0.0], atol=1e-15)

    def field(r, t):
        return np.cos(t) ** 2, np.sin(t) ** 2, -np.sin(t) * np.cos(t)

    normal = np.array([[0.0, 0.6, 0.8]] * 3)
    found = polar_traction(field)(points, normal)
    np.testing.assert_allclose(found, [[0.0, 0.6, 0.0]] * 3, atol=1e-15)


def test_a_slice_has_nodes_on_the_radii_that_it_is_divided_at_and_a_plane_end():
    block = divided_sector((1.0, 1.2, 1.5, 2.0), (1, 2, 1), 0.5, 1.0)
    for r in (1.0, 1.2, 1.35, 1.5, 2.0):
        node_at(block.points, [0.0, r, 0.0])
    F = body_loads(block.points, block.cells, Rotating(1.0, 2.0, 1.0, Plane(E, NU)).body_force)
    ends = {}
    for plane_end in (True, False):
        held = slice_supports(block, 1.0, plane_end)
        u = solve_solid(block.points, block.cells, LAME, held, F).u[:, 0]
        assert np.abs(u[3 * block.face_nodes("z0")]).max() < 1e-12
        ends[plane_end] = u[3 * block.face_nodes("z1")]
    assert np.ptp(ends[True]) < 1e-9 * abs(ends[True][0])
    # a disc in rotation becomes thinner, and most where it is stretched most
    assert ends[False].max() < 0.0
    assert np.ptp(ends[False]) > 0.1 * abs(ends[True][0])


def test_half_a_wave_of_pressure_pushes_and_pulls_equally():
    block = half_wave(1.0, 1.2, 3, 1)
    x, y, z = block.points.T
    assert np.arctan2(z, y).max() == pytest.approx(np.pi / 3)
    assert np.ptp(x) == pytest.approx(0.1)
    F = traction_loads(block.points, block.faces["x1"], wave_pressure(2.0, 3)).reshape(-1, 3)
    # positive pressure at t = 0 pushes inwards: the integral of p cos(3t) e_r over half a wave
    t = np.linspace(0.0, np.pi / 3, 20001)
    along_y = -2.0 * 1.2 * 0.1 * trapezoid(np.cos(3 * t) * np.cos(t), t)
    assert F[:, 1].sum() == pytest.approx(along_y, rel=1e-3)
    assert F[block.face_nodes("y0"), 1].sum() < 0.0


def test_node_at_wants_a_node():
    block = ring_sector(1.0, 2.0, 0.5, 1.0, (1, 1, 1))
    assert block.points[node_at(block.points, [0.0, 1.5, 0.0])] == pytest.approx([0.0, 1.5, 0.0])
    with pytest.raises(ValueError, match="no node"):
        node_at(block.points, [0.0, 1.4, 0.0])


def test_a_section_inside_a_bar_moves_as_the_bar_does():
    bar = round_bar(0.2, 3.0, 8, 4)
    facets = facets_where(bar.cells, bar.root)
    area = facet_points(bar.points, facets).areas.sum()
    assert area == pytest.approx(0.01 * np.pi, rel=1e-3)
    assert np.abs(bar.points[bar.end, 0] - 3.0).max() < 1e-12
    motion = np.array([0.1, -0.2, 0.3, 1e-3, 2e-3, -3e-3])
    at = np.array([3.0, 0.0, 0.0])
    u = rigid_motions(bar.points, at) @ motion
    found = section_motion(bar.points, bar.cells, bar.root, u, at)
    np.testing.assert_allclose(found, motion, rtol=1e-10, atol=1e-12)


def test_stress_of_a_section_in_bending_is_exact_up_to_lateral_contraction():
    """Axial stress E k z of pure bending, with no lateral contraction to be missed at nu = 0."""
    bar = round_bar(0.2, 3.0, 8, 4)
    x, _, z = bar.points.T
    u = np.column_stack([1e-3 * x * z, 0.0 * x, -0.5e-3 * x**2]).ravel()
    s = section_stresses(bar.points, bar.cells, bar.root, u, (0.0, 0.5 * E))
    np.testing.assert_allclose(s[:, 0], 1e-3 * E * z[bar.root], atol=1e-12)


def test_a_pulled_bar_stretches_from_its_root_and_is_free_of_its_clamp_there():
    steel = Material(youngs_modulus=200e9, poisson_ratio=0.3, density=0.0)
    found = solve_bar(round_bar(0.2, 3.0, 12, 4), steel, np.array([1e8, 0.0, 0.0]))
    motion = found.end_motion(3.0, 0.0, 0.0)
    assert motion[0] == pytest.approx(3.0 * 1e8 / 200e9, rel=1e-3)
    np.testing.assert_allclose(motion[1:] / motion[0], 0.0, atol=1e-6)
    s = found.stresses_at(found.bar.root)
    np.testing.assert_allclose(s[:, 0], 1e8, rtol=2e-2)


@pytest.mark.parametrize("n", [1, 3])
def test_quarter_disc_is_a_quarter_of_a_disc(n):
    disc = quarter_disc(2.0, 0.5, n, 2)
    quarter = 0.25 * np.pi * 4.0
    areas = {name: facet_points(disc.points, disc.faces[name]) for name in disc.faces}
    area = {name: at.areas.sum() for name, at in areas.items()}
    rough = 1e-3 if n == 1 else 2e-5
    assert area["front"] == pytest.approx(quarter, rel=rough)
    assert area["rear"] == pytest.approx(quarter, rel=rough)
    assert area["rim"] == pytest.approx(0.5 * np.pi, rel=rough)
    assert area["y"] == pytest.approx(1.0, rel=1e-12)
    assert area["z"] == pytest.approx(1.0, rel=1e-12)
    # the blocks are one: the surface is closed, and no node is there twice
    total = sum((at.normals * at.areas[:, :, None]).sum(axis=(0, 1)) for at in areas.values())
    np.testing.assert_allclose(total, 0.0, atol=1e-12)
    assert len(np.unique(disc.points.round(9), axis=0)) == len(disc.points)
    assert np.abs(disc.points[disc.face_nodes("y"), 1]).max() < 1e-12
    rim = disc.points[disc.face_nodes("rim")]
    np.testing.assert_allclose(np.hypot(rim[:, 1], rim[:, 2]), 2.0, rtol=1e-12)
