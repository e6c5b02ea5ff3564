"""A coarser level by smoothed aggregation, beside pyamg's own."""

import numpy as np
import pytest
from pyamg.aggregation.aggregate import standard_aggregation
from pyamg.aggregation.smooth import jacobi_prolongation_smoother
from pyamg.aggregation.tentative import fit_candidates
from pyamg.strength import symmetric_strength_of_connection
from scipy import sparse

from fe_drivetrain.elasticity.interfaces.constraints import eliminate, fixed
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.elasticity.solve import multigrid
from fe_drivetrain.elasticity.solve.aggregates import coarsened, of_nodes
from fe_drivetrain.elasticity.solve.coarse_product import coarse_product
from fe_drivetrain.elasticity.solve.reduction import diagonal_blocks, in_blocks, reduce


@pytest.fixture(scope="module")
def system():
    """A block of linear hexahedra on a wall."""
    block = brick((6, 6, 6), 8, lambda p: p)
    K = assemble(block.points, block.cells, (1.0, 1.0))
    elimination = eliminate([fixed("wall", block.face_nodes("x0"), K.shape[0])], K.shape[0])
    return reduce(block.points, block.cells, K, elimination)


def level(K, motions, smoother):
    blocks = in_blocks(K)
    inverse = np.linalg.inv(diagonal_blocks(blocks))
    largest = float(np.abs(np.linalg.eigvals(scaled(blocks, inverse).toarray())).max())
    connected = symmetric_strength_of_connection(K, 0.0)
    return coarsened(K, motions, connected, smoother, inverse, largest), connected


def scaled(K, inverse):
    rows = np.repeat(np.arange(len(K.indptr) - 1), np.diff(K.indptr))
    found = K.copy()
    found.data = inverse[rows] @ K.data
    return found


def test_aggregates_carry_the_rigid_motions(system):
    (P, coarse), _ = level(system.K, system.near_nullspace, None)
    np.testing.assert_allclose(P @ coarse, system.near_nullspace, atol=1e-12)


def test_the_step_is_block_jacobi_as_pyamg_has_it(system):
    """On the level below, too, where a node has six degrees of freedom and two blocks."""
    (P, coarse), connected = level(system.K, system.near_nullspace, "jacobi")
    T, B = fit_candidates(standard_aggregation(connected)[0], system.near_nullspace)
    np.random.seed(0)  # noqa: NPY002
    peer = jacobi_prolongation_smoother(system.K, T, connected, B, weighting="block")
    # pyamg's eigenvalue is an estimate
    np.testing.assert_allclose(P.toarray(), peer.toarray(), atol=0.02)
    below = P.T @ system.K @ P
    assert below.blocksize == (6, 6)
    (next_one, motions), connected = level(below, coarse, "jacobi")
    T, _ = fit_candidates(standard_aggregation(connected)[0], coarse)
    blocks = in_blocks(below)
    step = scaled(blocks, np.linalg.inv(diagonal_blocks(blocks))) @ T.toarray()
    moved = next_one.toarray() - T.toarray()
    share = -float((moved * step).sum() / (step * step).sum())
    np.testing.assert_allclose(moved, -share * step, atol=1e-12)
    assert motions.shape[1] == 6


def test_blocks_of_zeros_do_not_connect_aggregates(system):
    """Between nodes of which one is held, whose blocks stay in the pattern of the stiffness."""
    (P, coarse), connected = level(system.K, system.near_nullspace, "jacobi")
    T, _ = fit_candidates(standard_aggregation(connected)[0], system.near_nullspace)
    every = (system.K @ T).tobsr((3, 6))
    assert abs(P.data).reshape(len(P.data), -1).max(axis=1).min() > 0.0
    assert len(P.indices) < len(every.indices)
    below = coarse_product(system.K, P.tocsr())
    wide = below.tobsr((6, 6)).sorted_indices()
    indptr, indices, body = of_nodes(below, 2)
    assert (indptr == wide.indptr).all()
    assert (indices == wide.indices).all()
    assert len(body) == len(coarse) // 6
    assert indptr.dtype == indices.dtype == np.int32


def test_iterations_are_few_with_it_and_many_without(system, rng):
    F = np.where(system.K.diagonal()[:, None] > 0, rng.standard_normal((system.K.shape[0], 1)), 0.0)
    counts = {}
    for smoother in ("jacobi", None):
        options = multigrid.Options(prolongation_smoother=smoother, coarsest=20)
        made = multigrid.build(system, options)
        found = multigrid.conjugate_gradients(system.K, F, made.precondition, 1e-8)
        counts[smoother] = found.iterations
    assert counts["jacobi"] < counts[None]


@pytest.mark.parametrize("plain", [True, False])
def test_the_coarse_product_is_that_of_sparse_matrices(system, rng, plain):
    """Products of blocks that are a number times the identity, and of full ones."""
    n, n_coarse = system.K.shape[0] // 3, 40
    some = sparse.random_array((n, n_coarse), density=0.05, rng=rng, format="csr")
    blocks = np.eye(3) if plain else rng.standard_normal((3, 3))
    P = sparse.kron(some, blocks, format="csr")
    found = coarse_product(system.K, P)
    wanted = (P.T @ system.K.tocsr() @ P).toarray()
    np.testing.assert_allclose(found.toarray(), wanted, atol=1e-13 * np.abs(wanted).max())
    assert abs(found - found.T).max() == 0.0
    assert found.has_canonical_format
    again = coarse_product(system.K, P, P.T.tocsr())
    assert (again.data == found.data).all()


@pytest.mark.parametrize(
    "options",
    [
        multigrid.Options(coarsest=10, **changed)
        for changed in (
            {},
            {"apart": False},
            {"strength": 0.02},
            {"prolongation_smoother": None},
            {"prolongation_smoother": "energy"},
            {"linear_level": False},
            {"single": False},
        )
    ],
    ids=str,
)
@pytest.mark.parametrize(("cuts", "nodes"), [((6, 6, 6), 8), ((4, 4, 4), 10)])
def test_every_option_solves(options, cuts, nodes):
    block = brick(cuts, nodes, lambda p: p)
    K = assemble(block.points, block.cells, (1.0, 1.0))
    elimination = eliminate([fixed("wall", block.face_nodes("x0"), K.shape[0])], K.shape[0])
    system = reduce(block.points, block.cells, K, elimination)
    F = np.zeros((K.shape[0], 1))
    F[3 * block.face_nodes("x1") + 2] = 1.0
    hierarchy = multigrid.build(system, options)
    assert len(hierarchy.levels) >= 2
    found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-9)
    left = np.linalg.norm(F - system.K @ found.x) / np.linalg.norm(F)
    assert found.energy_error < 1e-9
    assert left < 1e-6
