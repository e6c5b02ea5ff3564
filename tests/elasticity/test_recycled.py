"""Solutions of neighbours: where an iteration starts, and that it ends where it would have."""

import numpy as np
import pytest

from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.interfaces.constraints import eliminate, fixed
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.mesh.generation import generate
from fe_drivetrain.elasticity.operator.carried_fields import change_by_shift
from fe_drivetrain.elasticity.operator.elasticity import assemble, sparsity
from fe_drivetrain.elasticity.solve import direct_solvers, multigrid
from fe_drivetrain.elasticity.solve.recycled import Recycled
from fe_drivetrain.elasticity.solve.reduction import reduce
from fe_drivetrain.geometry import MeshSizes, Section, Shaft

TOLERANCE = 1e-9


def system_of(stretch):
    """A clamped brick, longer by a factor."""
    mesh = brick((4, 2, 2))
    points = mesh.points * [stretch, 0.3, 0.3]
    held = np.flatnonzero(mesh.points[:, 0] < 1e-9)
    elimination = eliminate([fixed("held", held, points.size)], points.size)
    K = assemble(points, mesh.cells, MATERIALS["steel"].lame)
    system = reduce(points, mesh.cells, K, elimination)
    F = np.zeros((points.size, 3))
    for axis in range(3):
        F[axis::3, axis] = mesh.points[:, 0]
    return system, elimination.T.T @ F


def energy(K, x):
    return np.sqrt(np.einsum("nm,nm->m", x, K @ x))


@pytest.fixture(scope="module")
def neighbours():
    """A space of three bricks, the system of a fourth, its loads and its solutions."""
    space = Recycled()
    for stretch in (1.0, 1.03, 1.06):
        system, F = system_of(stretch)
        x = direct_solvers.factorise(system.K, "superlu").apply(F)
        space.learn(system.K, x, space.start(system.K, F))
    system, F = system_of(1.045)
    return space, system, F, direct_solvers.factorise(system.K, "superlu").apply(F)


def test_the_start_is_galerkins(neighbours):
    space, system, F, x = neighbours
    start = space.start(system.K, F)
    lacking = x - start.x
    # what is missing is orthogonal in energy, so that squares of norms add up
    np.testing.assert_allclose(
        energy(system.K, x) ** 2, start.energies + energy(system.K, lacking) ** 2, rtol=1e-10
    )
    assert (energy(system.K, lacking) < 1e-2 * energy(system.K, x)).all()
    assert (np.abs(start.x.T @ (system.K @ lacking)) < 1e-8 * (x.T @ F).max()).all()


def test_the_start_changes_nothing_at_convergence(neighbours):
    space, system, F, x = neighbours
    by = multigrid.build(system).precondition
    start = space.start(system.K, F)
    from_zero = multigrid.conjugate_gradients(system.K, F, by, TOLERANCE)
    found = multigrid.conjugate_gradients(system.K, F, by, TOLERANCE, start=start)
    assert found.iterations < from_zero.iterations
    for one in (from_zero, found):
        assert one.energy_error <= TOLERANCE
        true = energy(system.K, one.x - x) / energy(system.K, x)
        assert true.max() < TOLERANCE


def test_the_error_of_a_start_is_estimated_before_it_is_there(neighbours):
    space, system, F, x = neighbours
    by = multigrid.build(system).precondition
    ratio = multigrid.conjugate_gradients(system.K, F, by, TOLERANCE).tail_ratio
    space.least_ratio = ratio
    steps = multigrid.iterates(system.K, F, by, space.start(system.K, F))
    for found, _ in zip(steps, range(6), strict=False):
        true = (energy(system.K, found.x - x) / energy(system.K, x)).max()
        assert 0.5 * true < found.energy_error < 30.0 * true


def test_a_solution_that_is_known_adds_nothing(neighbours):
    _, system, F, x = neighbours
    space = Recycled()
    assert space.learn(system.K, x, None) == 1.0
    assert space.size == 3
    again = space.start(system.K, 3.0 * F)
    assert space.learn(system.K, 3.0 * x, again) < 1e-6
    assert space.size == 3


def test_what_is_least_used_goes():
    space = Recycled(most=7)
    for stretch in (1.0, 1.1, 1.2, 1.3):
        system, F = system_of(stretch)
        start = space.start(system.K, F)
        space.learn(system.K, direct_solvers.factorise(system.K, "superlu").apply(F), start)
        assert space.size <= 7
    system, F = system_of(1.3)
    x = direct_solvers.factorise(system.K, "superlu").apply(F)
    lacking = energy(system.K, x - space.start(system.K, F).x) / energy(system.K, x)
    assert lacking.max() < 0.05  # the solutions themselves are still there


def test_a_space_of_other_unknowns_is_left(neighbours):
    _, system, F, _ = neighbours
    space = Recycled()
    space.learn(
        assemble(np.eye(4, 3), np.arange(4)[None], (1.0, 1.0)), np.arange(12.0)[:, None], None
    )
    assert space.size == 1
    assert space.start(system.K, F) is None
    assert space.size == 0


def test_a_linear_field_is_carried_exactly(rng):
    section = Section(length=1.0, outer_diameter=0.4, inner_diameter=0.1)
    mesh = generate(Shaft(sections=[section], front=0.0), sizes=MeshSizes(shaft=0.3))
    shift = 0.01 * rng.standard_normal(mesh.points.shape)
    gradient, first = rng.standard_normal((3, 3)), rng.standard_normal(3)
    pattern = sparsity(mesh.cells, len(mesh.points) + 2)  # with a reference point's unknowns
    u = np.append((mesh.points @ gradient + first).ravel(), np.ones(6))[:, None]
    found = u + change_by_shift(mesh.points, mesh.cells, pattern, shift) @ u
    expected = np.append(((mesh.points + shift) @ gradient + first).ravel(), np.ones(6))
    np.testing.assert_allclose(found[:, 0], expected, rtol=1e-10)
