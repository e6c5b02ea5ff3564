"""Averaged dilatations and incompatible modes: exact fields, symmetries, and what must not lock."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from pydantic import ValidationError

from fe_drivetrain.common.components import STRESSES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.drivetrain_file.materials import MAX_POISSON_RATIO, Material
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.elasticity.interfaces.constraints import held_nodes
from fe_drivetrain.elasticity.mesh.blocks import Block, brick
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator import elasticity, incompatible, incompressible, stress
from fe_drivetrain.elasticity.operator.loads import pressure, traction_loads
from fe_drivetrain.elasticity.solve.solid import solve_solid
from fe_drivetrain.shafts.response.model import build_model, mesh_scene

KINDS = [
    (incompressible.assemble, 8),
    (incompressible.assemble, 10),
    (incompressible.assemble, 20),
    (incompressible.assemble, 27),
    (incompatible.assemble, 8),
]
LAME = Material(youngs_modulus=2e11, poisson_ratio=0.3, density=0.0).lame


def distorted(nodes: int, rng: np.random.Generator) -> Block:
    """A cube of three elements each way, all its inner nodes off their places."""
    block = brick((3, 3, 3), nodes)
    inside = (np.abs(block.points - 0.5) < 0.49).all(axis=1)
    block.points[inside] += rng.uniform(-0.02, 0.02, (inside.sum(), 3))
    return block


@pytest.mark.parametrize(("assemble", "nodes"), KINDS)
def test_symmetric_and_without_force_under_rigid_motions_alone(assemble, nodes, rng):
    block = distorted(nodes, rng)
    K = assemble(block.points, block.cells, LAME)
    assert K.blocksize == (3, 3)
    assert K.indices.dtype == np.int32
    assert abs(K - K.T).max() <= 1e-14 * abs(K).max()
    assert np.abs(K @ rigid_motions(block.points)).max() <= 1e-13 * abs(K).max()
    values = np.linalg.eigvalsh(K.toarray())
    assert values[5] < 1e-12 * values[-1] < 1e-6 * values[6]


@pytest.mark.parametrize(("assemble", "nodes"), KINDS)
def test_uniform_strain_is_exact_in_distorted_elements(assemble, nodes, rng):
    block = distorted(nodes, rng)
    gradient = rng.normal(size=(3, 3))
    u = (block.points @ gradient.T).ravel()
    K = assemble(block.points, block.cells, LAME)
    strain = 0.5 * (gradient + gradient.T)
    energy = 0.5 * (LAME[0] * np.trace(strain) ** 2 + 2.0 * LAME[1] * (strain**2).sum())
    assert 0.5 * u @ K @ u == pytest.approx(energy, rel=1e-12)
    inside = (np.abs(block.points - 0.5) < 0.49).all(axis=1)
    assert np.abs((K @ u).reshape(-1, 3)[inside]).max() <= 1e-13 * abs(K).max()


@pytest.mark.parametrize(("assemble", "nodes"), KINDS)
def test_never_stiffer_than_plain_elements(assemble, nodes, rng):
    block = distorted(nodes, rng)
    gain = elasticity.assemble(block.points, block.cells, LAME) - assemble(
        block.points, block.cells, LAME
    )
    values = np.linalg.eigvalsh(gain.toarray())
    assert values[0] >= -1e-13 * values[-1]


@pytest.mark.parametrize(("assemble", "nodes"), KINDS)
def test_same_stiffness_in_any_frame(assemble, nodes, rng):
    block = distorted(nodes, rng)
    Q = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    Q *= np.linalg.det(Q)
    here, there = (assemble(p, block.cells, LAME) for p in (block.points, block.points @ Q.T))
    u = rng.normal(size=block.points.shape)
    turned = (there @ (u @ Q.T).ravel()).reshape(-1, 3) @ Q
    assert turned.ravel() == pytest.approx(here @ u.ravel(), rel=1e-9, abs=1e-11 * abs(here).max())


def test_degrees_of_freedom_beyond_the_nodes_stay_empty():
    block = brick((1, 1, 1), 27)
    n = block.points.size
    K = incompressible.assemble(block.points, block.cells, LAME, n + 6)
    assert K.shape == (n + 6, n + 6)
    assert abs(K.tocsr()[n:]).sum() == 0.0


@pytest.mark.parametrize("nodes", [8, 20, 27, 10])
def test_shear_alone_does_not_feel_lambda(nodes, rng):
    # u = (z, 0, 0) of a cube has no dilatation anywhere
    block = distorted(nodes, rng)
    u = np.zeros_like(block.points)
    u[:, 0] = block.points[:, 2]
    forces = [
        incompressible.assemble(block.points, block.cells, (lam, 1.0)) @ u.ravel()
        for lam in (1.0, 1e4)
    ]
    assert forces[0] == pytest.approx(forces[1], abs=1e-10)


@pytest.mark.parametrize("nodes", [8, 20, 27, 10])
def test_stiffness_of_a_bonded_block_has_a_limit(nodes):
    # Held on two faces, free on four: nearly incompressible, it bulges, and stays finite.
    block = brick((2, 4, 4), nodes, lambda p: p * [0.5, 1.0, 1.0])
    ends = np.concatenate([block.face_nodes("x0"), block.face_nodes("x1")])
    dofs = (3 * ends[:, None] + np.arange(3)).ravel()
    pulled = np.where(np.isin(dofs, 3 * block.face_nodes("x1")), 1.0, 0.0)

    def energy(nu: float, assembly) -> float:
        lame = Material(youngs_modulus=1e9, poisson_ratio=nu, density=0.0).lame
        found = solve_solid(
            block.points,
            block.cells,
            lame,
            [],
            np.zeros(block.points.size),
            (dofs, pulled),
            "superlu",
            assembly,
        )
        return float(found.energy[0])

    # K = 1 / (a + b / lambda): ten times lambda changes what is left by a tenth
    first, second, third = (energy(nu, incompressible.assemble) for nu in (0.499, 0.4999, 0.49999))
    assert 0.0 < third - second < 0.2 * (second - first)
    assert energy(0.4999, elasticity.assemble) > 1.02 * second


@pytest.mark.parametrize("nodes", [8, 20, 27, 10])
def test_stresses_of_a_pressed_block_are_exact(nodes):
    block = brick((2, 2, 2), nodes)
    lame = Material(youngs_modulus=1e9, poisson_ratio=0.4999, density=0.0).lame
    n = block.points.size
    held = [
        held_nodes(face, block.face_nodes(face), (axis,), n)
        for axis, face in enumerate(("x0", "y0", "z0"))
    ]
    F = traction_loads(block.points, block.faces["z1"], pressure(1e6))
    found = solve_solid(
        block.points, block.cells, lame, held, F, None, "superlu", incompressible.assemble
    )
    at = element_kind(nodes).places.T
    s = incompressible.stresses(block.points, block.cells, found.u[:, 0], lame, at)
    expected = np.zeros_like(s)
    expected[..., STRESSES.index("zz")] = -1e6
    assert s == pytest.approx(expected, abs=1e-3)


def test_stresses_are_those_of_the_energy(rng):
    # A displacement at random: work of the stresses at Gauss points is twice the energy.
    from skfem.quadrature import get_quadrature

    block = distorted(27, rng)
    u = rng.normal(size=block.points.size)
    kind = element_kind(27)
    at, weights = get_quadrature(kind.element.refdom, kind.degree)
    s = incompressible.stresses(block.points, block.cells, u, LAME, at)
    e = stress.strains(block.points, block.cells, u, at)
    volumes = jacobian(block.points, block.cells, kind.shape(at)[1])[1] * weights
    work = float(np.einsum("eq,eqc,eqc,c->", volumes, s, e, [1, 1, 1, 2, 2, 2]))
    K = incompressible.assemble(block.points, block.cells, LAME)
    assert work == pytest.approx(u @ K @ u, rel=1e-10)


def test_incompatible_bricks_bend_exactly():
    block = brick((3, 1, 1), 8, lambda p: p * [6.0, 0.5, 0.5] - [0.0, 0.25, 0.25])
    nu, E, curvature = 0.3, 2e11, 1e-3
    x, y, z = block.points.T
    exact = np.column_stack(
        [
            -curvature * x * z,
            nu * curvature * y * z,
            0.5 * curvature * (x**2 + nu * (z**2 - y**2)),
        ]
    )
    K = incompatible.assemble(block.points, block.cells, LAME)
    u = exact.ravel()
    energy = 0.5 * E * 0.5**4 / 12.0 * curvature**2 * 6.0
    assert 0.5 * u @ K @ u == pytest.approx(energy, rel=1e-10)
    # nodes between the ends carry no force
    inside = np.isin(x, (2.0, 4.0))
    forces = (K @ u).reshape(-1, 3)
    assert np.abs(forces[inside]).max() <= 1e-9 * np.abs(forces).max()


def test_elements_without_a_remedy_are_refused():
    block = brick((1, 1, 1), 4)
    with pytest.raises(InputError, match="10 nodes"):
        incompressible.assemble(block.points, block.cells, LAME)
    with pytest.raises(InputError, match="8 nodes"):
        incompatible.assemble(block.points, block.cells, LAME)


def test_nearer_to_a_half_than_digits_allow_is_refused():
    highest = MAX_POISSON_RATIO
    assert Material(youngs_modulus=1e9, poisson_ratio=highest, density=0.0).lame[0] > 1e14
    for nu in (0.4999995, 0.5 - 1e-16, 0.5):
        with pytest.raises(ValidationError, match="less than or equal to"):
            Material(youngs_modulus=1e9, poisson_ratio=nu, density=0.0)


def test_poisson_ratio_of_lames_constants():
    for nu in (-0.5, 0.0, 0.3, 0.4999):
        lame = Material(youngs_modulus=1e9, poisson_ratio=nu, density=0.0).lame
        assert incompressible.poisson_ratio(lame) == pytest.approx(nu, abs=1e-12)


def test_a_nearly_incompressible_part_is_averaged_and_warned_of():
    rubber = {"youngs_modulus": 1e9, "poisson_ratio": 0.49, "density": 1000.0}
    scene = change_scene(
        coarse_scene("bonded"),
        {"materials": {"rubber": rubber}, "bearing_units.0.housing.material": "rubber"},
    )
    model = build_model(scene, mesh_scene(scene))
    housing = f"{scene.bearing_units[0].bearing.name}.housing"
    said = [warning for warning in model.warnings if "nu = 0.49" in warning]
    assert len(said) == 1
    assert said[0].startswith(housing)
    mesh = model.mesh
    expected = incompressible.assemble(
        mesh.points,
        mesh.cells[mesh.part_cells(housing)],
        scene.material_of(housing).lame,
        model.n_dofs,
    )
    assert abs(model.part_stiffness[housing] - expected).max() <= 1e-14 * abs(expected).max()


def test_a_steel_part_stays_plain(bonded_model):
    mesh, scene = bonded_model.mesh, bonded_model.scene
    assert not any("nu =" in warning for warning in bonded_model.warnings)
    expected = elasticity.assemble(
        mesh.points,
        mesh.cells[mesh.part_cells("shaft")],
        scene.material_of("shaft").lame,
        bonded_model.n_dofs,
    )
    assert abs(bonded_model.part_stiffness["shaft"] - expected).max() == 0.0
