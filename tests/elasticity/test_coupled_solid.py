"""A shaft coupled to points: free and condensed against held, and motions against rigid ones."""

import numpy as np
import pytest

from fe_drivetrain.common.spatial import point_motions, rigid_motions
from fe_drivetrain.drivetrain_file.component import Attachment
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.interfaces.constraints import fixed
from fe_drivetrain.elasticity.mesh.generation import generate
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.solve.condensation import supported
from fe_drivetrain.elasticity.solve.coupled_solid import (
    condensed_solid,
    coupled_solid,
    point_motions_of,
)
from fe_drivetrain.geometry import MeshSizes, Section, Shaft

MATERIAL = {"shaft": MATERIALS["steel"]}


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    section = Section(length=1.0, outer_diameter=0.4, inner_diameter=0.1)
    return generate(Shaft(front=-0.5, sections=[section]), sizes=MeshSizes(shaft=0.2))


def attachments(front: str, rear: str) -> list[Attachment]:
    return [
        Attachment("hub", "shaft.front", np.array([-0.5, 0.0, 0.0]), front),
        Attachment("gearbox", "shaft.rear", np.array([0.5, 0.1, 0.0]), rear),
    ]


@pytest.mark.parametrize("front", ["averaged", "rigid"])
def test_the_free_body_held_at_its_rigid_rear_is_the_solid_held_there(mesh: Mesh, front: str):
    hub, gearbox = attachments(front, "rigid")
    body = condensed_solid(mesh, MATERIAL, [hub, gearbox]).body
    held = supported(body, {"gearbox": np.diag(np.full(6, np.inf))}).motions[:6, :6]
    solid = coupled_solid(mesh, MATERIAL, [hub])
    rear = fixed("rear", mesh.face_nodes("shaft.rear"), solid.n_dofs)
    compliance = point_motions_of(solid, [rear])[1]
    size = np.sqrt(compliance.diagonal())
    np.testing.assert_allclose(
        held / np.outer(size, size), compliance / np.outer(size, size), rtol=0, atol=1e-8
    )


@pytest.mark.parametrize(("front", "rear"), [("averaged", "rigid"), ("rigid", "averaged")])
def test_points_that_move_as_one_body_move_all_nodes_so(mesh: Mesh, front: str, rear: str):
    found = condensed_solid(mesh, MATERIAL, attachments(front, rear))
    positions = found.body.positions
    motion = np.random.default_rng(0).normal(size=6)
    u = found.displacements(point_motions(positions, positions[0]) @ motion)
    expected = rigid_motions(mesh.points, positions[0]) @ motion
    np.testing.assert_allclose(u.ravel(), expected, rtol=0, atol=1e-8)


def test_a_spring_to_ground_at_a_point_adds_to_its_stiffness(mesh: Mesh):
    hub, _ = attachments("rigid", "rigid")
    solid = coupled_solid(mesh, MATERIAL, [hub])
    rear = fixed("rear", mesh.face_nodes("shaft.rear"), solid.n_dofs)
    bare = np.linalg.inv(point_motions_of(solid, [rear])[1])
    spring = np.diag([1e9, 2e9, 3e9, 4e8, 5e8, 6e8])
    sprung = np.linalg.inv(point_motions_of(solid, [rear], [(solid.points[0], spring)])[1])
    size = np.sqrt(sprung.diagonal())
    np.testing.assert_allclose(
        sprung / np.outer(size, size), (bare + spring) / np.outer(size, size), rtol=0, atol=1e-8
    )


def test_a_compliance_is_right_to_the_square_of_what_its_displacements_are(mesh: Mesh):
    hub, _ = attachments("rigid", "rigid")
    solid = coupled_solid(mesh, MATERIAL, [hub])
    rear = fixed("rear", mesh.face_nodes("shaft.rear"), solid.n_dofs)
    exact = point_motions_of(solid, [rear])[1]
    iterated = point_motions_of(solid, [rear], method="multigrid")
    size = np.sqrt(np.outer(exact.diagonal(), exact.diagonal()))
    first = np.abs((solid.loads.T @ iterated[0] - exact) / size).max()
    second = np.abs((iterated[1] - exact) / size).max()
    assert second < 1e-9
    assert second < 0.1 * first
