"""Multigrid and its error estimate against direct solutions."""

from functools import cache

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from scipy import linalg, sparse

from fe_drivetrain.cases.references import layers
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.elasticity.interfaces.constraints import (
    eliminate,
    fixed,
    rigid_face,
    rigid_point,
)
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.mesh.generation import generate
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.elasticity.solve import direct_solvers, multigrid, solvers
from fe_drivetrain.elasticity.solve.reduction import reduce
from fe_drivetrain.elasticity.solve.stopping import energy_error
from fe_drivetrain.geometry import MeshSizes, Section, Shaft
from fe_drivetrain.shafts.response.model import build_model, mesh_scene

ROWS = [{"x": -0.05, "contact_angle": -20.0}, {"x": 0.05, "contact_angle": 20.0}]


def change_unit(scene, **unit):
    return change_scene(scene, {f"bearing_units.0.{key}": value for key, value in unit.items()})


@cache
def cantilever(length, size, inner=0.3, linear=False):
    """A hollow shaft held at the rear; six unit loads at the rigid front."""
    section = Section(length=length, outer_diameter=0.7, inner_diameter=inner)
    mesh = generate(
        Shaft(sections=[section], front=0.0), [], {}, MeshSizes(shaft=size, elements_per_turn=8)
    )
    points, cells = mesh.points, mesh.cells
    faces = {name: mesh.face_nodes(name) for name in ("shaft.front", "shaft.rear")}
    if linear:
        corner, cells = np.unique(cells[:, :4], return_inverse=True)
        points, cells = points[corner], cells.reshape(-1, 4)
        faces = {name: np.flatnonzero(np.isin(corner, nodes)) for name, nodes in faces.items()}
    n = points.size + 6
    front = rigid_point("front", np.zeros(3), points.size, n)
    elimination = eliminate(
        [
            rigid_face("front", faces["shaft.front"], points, front),
            fixed("rear", faces["shaft.rear"], n),
        ],
        n,
    )
    K = assemble(points, cells, MATERIALS["steel"].lame, n)
    system = reduce(points, cells, K, elimination)
    return system, elimination.T.T @ front.motion.T.toarray()


def energy_norm(K, x):
    return np.sqrt(np.einsum("nm,nm->m", x, K @ x))


@pytest.fixture(scope="module")
def chunky():
    """A short cantilever, its loads, its hierarchy and its displacements."""
    system, F = cantilever(2.0, 0.3)
    return system, F, multigrid.build(system), refined(system, F)


def refined(system, F):
    factor = direct_solvers.factorise(system.K, "superlu")
    x = factor.apply(F)
    return x + factor.apply(F - system.K @ x)


@pytest.mark.parametrize(("length", "linear"), [(2.0, False), (14.0, False), (2.0, True)])
def test_estimate_is_honest_at_every_step(length, linear):
    """Chunky and slender (L/D = 20), quadratic and linear: never below half of the true error."""
    system, F = cantilever(length, 0.3, linear=linear)
    exact = refined(system, F)
    hierarchy = multigrid.build(system)
    size = energy_norm(system.K, exact)
    ratios = []
    for found in multigrid.iterates(system.K, F, hierarchy.precondition):
        true = (energy_norm(system.K, found.x - exact) / size).max()
        if true < 1e-8:  # the slender shaft's direct solution is no better than that
            break
        ratios.append(found.energy_error / true)
    assert len(ratios) >= 4
    assert min(ratios) > 0.5
    assert np.median(ratios) < 20.0


def test_stiffness_error_is_the_energy_error_squared(chunky):
    system, F, hierarchy, exact = chunky
    found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-3)
    compliance = np.einsum("nm,nm->m", F, found.x)
    error = 1.0 - compliance / np.einsum("nm,nm->m", F, exact)
    # Galerkin: always too stiff, by the square of the energy error.
    assert (error > 0.0).all()
    true = (energy_norm(system.K, found.x - exact) / energy_norm(system.K, exact)) ** 2
    np.testing.assert_allclose(error, true, rtol=1e-3)
    assert error.max() < 1e-5


def test_preconditioner_is_symmetric_and_positive(chunky, rng):
    _, F, hierarchy, _ = chunky
    a, b = rng.standard_normal((2, len(F), 3))
    Ma, Mb = hierarchy.precondition(a), hierarchy.precondition(b)
    scale = np.abs(a.T @ Ma).max()
    np.testing.assert_allclose(a.T @ Mb, Ma.T @ b, atol=1e-10 * scale)
    assert (np.einsum("nm,nm->m", a, Ma) > 0.0).all()


def test_iterations_hardly_grow_with_the_mesh():
    counts = []
    for size in (0.4, 0.2, 0.1):
        system, F = cantilever(2.0, size)
        hierarchy = multigrid.build(system)
        found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-8)
        counts.append(found.iterations)
    assert max(counts) < 30


def test_joined_bodies_converge_like_one(spherical_responses):
    """The sliding joint: without modes of its own for each body this takes hundreds of steps."""
    model, _ = spherical_responses["sliding"]
    elimination = eliminate(model.constraints, model.n_dofs)
    system = reduce(model.mesh.points, model.mesh.cells, model.stiffness, elimination)
    F = elimination.T.T @ model.unit_loads()
    hierarchy = multigrid.build(system)
    found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-9)
    assert found.energy_error <= 1e-9
    assert found.iterations < 60
    exact = refined(system, F)
    true = energy_norm(system.K, found.x - exact) / energy_norm(system.K, exact)
    assert true.max() < 1e-9


@pytest.fixture(scope="module", params=["averaged", "spring", "rollers"])
def jointed(request, spherical_mesh):
    """A shaft whose bearing sits in its housing by means over faces, and its unit loads."""
    if request.param == "rollers":
        unit = {"interface": "rollers", "rollers": {"count": 20, "stiffness": 1e9, "rows": ROWS}}
        scene = change_unit(coarse_scene("bonded"), **unit)
        model = build_model(scene, mesh_scene(scene))
    else:
        stiffness = [1e9, 1e9, 1e9, 0.0, 5e7, 5e7]
        unit = {"spring": {"stiffness": stiffness}, "averaged": {}}[request.param]
        scene = change_unit(coarse_scene("spherical"), interface=request.param, **unit)
        model = build_model(scene, spherical_mesh)
    elimination = eliminate(model.constraints, model.n_dofs)
    system = reduce(
        model.mesh.points, model.mesh.cells, model.stiffness, elimination, model.springs
    )
    return system, elimination.T.T @ model.unit_loads(), multigrid.build(system)


def test_joints_over_faces_cost_no_iterations(jointed):
    """As penalties on the coarse levels they take hundreds, or do not converge."""
    system, F, made = jointed
    found = multigrid.conjugate_gradients(system.K, F, made.precondition, 1e-9)
    assert found.energy_error <= 1e-9
    assert found.iterations < 60
    exact = refined(system, F)
    true = energy_norm(system.K, found.x - exact) / energy_norm(system.K, exact)
    assert true.max() < 1e-8


def test_a_joined_preconditioner_is_symmetric_and_positive(jointed, rng):
    system, F, made = jointed
    free = system.joints().free
    a, b = rng.standard_normal((2, len(F), 3)) * free[:, None]
    Ma, Mb = made.precondition(a), made.precondition(b)
    assert not Ma[~free].any()
    scale = np.abs(a.T @ Ma).max()
    np.testing.assert_allclose(a.T @ Mb, Ma.T @ b, atol=1e-10 * scale)
    assert (np.einsum("nm,nm->m", a, Ma) > 0.0).all()


def test_columns_do_not_disturb_each_other(chunky):
    """A zero column, one of 1e-9 and one of 1e9 beside the others."""
    system, F, hierarchy, exact = chunky
    scale = np.array([1.0, 0.0, 1e-9, 1e9, 1.0, 1.0])
    found = multigrid.conjugate_gradients(system.K, F * scale, hierarchy.precondition, 1e-9)
    assert np.abs(found.x[:, 1]).max() == 0.0
    for k in (0, 2, 3, 4, 5):
        x = found.x[:, [k]] / scale[k]
        error = energy_norm(system.K, x - exact[:, [k]]) / energy_norm(system.K, exact[:, [k]])
        assert error < 1e-8


def test_hierarchy_is_the_same_every_time(chunky):
    system, F, hierarchy, _ = chunky
    once, again = (made.precondition(F) for made in (hierarchy, multigrid.build(system)))
    assert np.array_equal(once, again)


def test_energy_error_of_a_geometric_sequence():
    """Terms that fall by a constant factor: the rest of the series is known."""
    terms = 0.25 ** np.arange(12.0)[:, None]
    rest = 0.25**12 / (1 - 0.25)
    total = 1.0 / (1 - 0.25)
    estimate = energy_error(terms)
    assert estimate >= np.sqrt(rest / total)
    assert estimate < 3.0 * np.sqrt(rest / total)


@pytest.mark.parametrize("q", [0.5, 0.9, 0.99])
def test_energy_error_of_a_slow_sequence_is_one_step_behind_at_most(q):
    """Terms q^k for ever: after n of them the rest is q^n of all, and q^(n - 1) one step before."""
    n = round(np.log(1e-12) / np.log(q))
    estimate = energy_error(q ** np.arange(n, dtype=float)[:, None])
    # steps of the last hundredth of all are judged by: so many terms of the sum are not in it
    assert q ** (0.5 * n) * (1.0 - 1e-2) <= estimate <= q ** (0.5 * (n - 1)) * (1.0 + 1e-9)


@pytest.mark.parametrize("flatness", [0.0, 0.9, 0.99])
def test_smoother_knows_the_largest_eigenvalue(flatness):
    """Also that of one all but flat element, which a random vector hardly sees."""
    block = brick((4, 4, 4), 4)
    points = block.points.copy()
    middle = int(np.argmin(np.abs(points - 0.5).max(axis=1)))
    points[middle, 2] += 0.25 * flatness
    K = assemble(points, block.cells, MATERIALS["steel"].lame)
    blocks = K.toarray().reshape(len(points), 3, len(points), 3)
    inverse = np.linalg.inv(np.einsum("ninj->nij", blocks))
    D = linalg.block_diag(*np.linalg.inv(inverse))
    true = linalg.eigh(K.toarray(), D, eigvals_only=True)[-1]
    bound = multigrid.max_eigenvalue(K, inverse)
    assert true <= bound < 1.5 * true


def test_a_hierarchy_that_is_not_positive_is_found_out(monkeypatch):
    """A smoother told a third of its largest eigenvalue: the direct solver answers, and says so."""
    system, F = cantilever(2.0, 0.3)
    right = multigrid.max_eigenvalue
    monkeypatch.setattr(multigrid, "max_eigenvalue", lambda *given: right(*given) / 3.0)
    solution = solvers.factorise(system, "multigrid").solve(F)
    assert solution.diagnostics.method != "multigrid"
    assert "multigrid stopped" in solution.diagnostics.reason
    assert solution.diagnostics.residual < 1e-9


@pytest.mark.parametrize("contrast", [1e-6, 1e-4, 1e5])
def test_the_smoother_knows_the_largest_eigenvalue_where_a_ring_is_soft_or_stiff(contrast):
    """Few nodes have it; with eight steps of Lanczos, which missed it, nothing converged."""
    system, F = layers.ring().system((contrast, 1.0))
    hierarchy = multigrid.build(system)
    finest = hierarchy.levels[0]
    blocks = linalg.block_diag(*np.linalg.inv(finest.inverse))
    last = len(blocks) - 1
    (largest,) = linalg.eigh(
        system.K.toarray(), blocks, eigvals_only=True, subset_by_index=[last, last]
    )
    # beyond this a smoother of degree one makes errors larger
    assert largest < (1.0 + multigrid.DEFAULTS.smoothed) * finest.largest
    found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-9)
    assert found.energy_error <= 1e-9
    assert found.iterations < 30


@pytest.mark.parametrize(("foreseen", "converges"), [(0, False), (60, True), (200, False)])
def test_a_few_soft_motions_are_waited_for_where_so_many_iterations_were_foreseen(
    foreseen, converges
):
    values = np.concatenate([np.geomspace(1e-5, 1e-4, 3), np.linspace(0.05, 1.0, 297)])
    K = sparse.diags_array(values).tobsr((3, 3))
    energy = np.concatenate([np.full(3, 1e-3 / 3), np.full(297, 1 / 300)])
    F = np.sqrt(values * energy)[:, None]
    found = multigrid.conjugate_gradients(K, F, np.copy, 1e-5, lambda: foreseen)
    assert (found.energy_error <= 1e-5) == converges
    assert (found.iterations == 40) != converges
