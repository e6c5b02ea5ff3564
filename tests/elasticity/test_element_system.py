"""Rows that each process makes of its own elements are those of the default's assembly."""

from itertools import pairwise

import numpy as np
import pytest
from element_systems import RUBBER, SYSTEMS
from scipy import sparse

from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator.element_matrices import element_stiffness
from fe_drivetrain.elasticity.operator.incompressible import (
    assemble_unlocked,
    full_rule,
    unlocked_functions,
)
from fe_drivetrain.elasticity.solve.element_system import Cut, cut, parts
from fe_drivetrain.elasticity.solve.rank_rows import assembled, keep, kept, own_rows, own_trace
from fe_drivetrain.elasticity.solve.reduction import GROUND


def bent(x):
    """A mapping that no edge stays straight under."""
    return x + 0.07 * np.sin(2.0 * x[:, [1, 2, 0]]) * [1.0, 2.0, -1.0]


@pytest.mark.parametrize("nodes", [4, 8, 10, 20, 27])
@pytest.mark.parametrize("lame", [MATERIALS["steel"].lame, RUBBER])
@pytest.mark.parametrize("shape", [None, bent])
def test_elements_are_those_that_the_default_assembles(nodes, lame, shape):
    if nodes == 4 and lame is RUBBER:
        pytest.skip("refused")
    block = brick((2, 1, 1), nodes, shape or (lambda x: x))
    cells = block.cells.astype(np.int64)
    rule = full_rule(element_kind(nodes))
    functions = unlocked_functions(nodes, lame)
    K = element_stiffness(block.points, cells, rule, lame, functions)
    total = np.zeros((len(block.points), 3, len(block.points), 3))
    for some, each in zip(cells, K, strict=True):
        for a, i in enumerate(some):
            for b, j in enumerate(some):
                total[i, :, j, :] += each[a, b]
    n = block.points.size
    exact = assemble_unlocked(block.points, cells, lame).toarray()
    assert np.abs(total.reshape(n, n) - exact).max() < 1e-13 * np.abs(exact).max()


@pytest.fixture(scope="module", params=SYSTEMS)
def system(request):
    return SYSTEMS[request.param]()


def stacked(whole: Cut, folder, number: int):
    """All rows that parts make, each of its file, in the order of the default."""
    shares = []
    for part, (share, reductions) in enumerate(whole.shares()):
        keep(folder / f"{part}.npz", share, reductions)
        shares.append(kept(folder / f"{part}.npz"))
    made = [assembled(share) for share, _ in shares]
    trace = sum(own_trace(K, share) for K, (share, _) in zip(made, shares, strict=True))
    n = 3 * whole.system.n_blocks
    total = trace + shares[0][1][0].trace
    ground = GROUND * total / n
    rows = []
    for K, (share, reductions) in zip(made, shares, strict=True):
        reduction = reductions[number]
        mean = (trace + reduction.trace) / n
        rows.append(own_rows(K, share, reduction, mean, ground if number else 0.0))
    place = np.empty_like(whole.order)
    place[whole.order] = np.arange(len(place))
    dofs = (3 * place[:, None] + np.arange(3)).ravel()
    return sparse.vstack(rows, format="csr")[dofs][:, dofs]


@pytest.mark.parametrize("count", [1, 2, 5])
def test_rows_are_those_of_the_default(system, count, tmp_path):
    found = stacked(cut(system, count), tmp_path, 0)
    exact = system.whole().K.tocsr()
    assert abs(found - exact).max() < 1e-13 * abs(exact).max()
    joints = system.whole().joints
    assert (joints is None) == (system.sums is None)
    if joints is not None:
        found, exact = stacked(cut(system, count), tmp_path, 1), joints().bodies.K.tocsr()
        assert abs(found - exact).max() < 1e-13 * abs(exact).max()


def test_parts_are_equal_and_compact(rng):
    points = rng.uniform(size=(1003, 3)) * [10.0, 1.0, 1.0]
    order = parts(points, 5)
    assert sorted(order) == list(range(1003))
    runs = np.split(order, np.cumsum([201, 201, 201, 200]))
    assert [len(run) for run in runs] == [201, 201, 201, 200, 200]
    # along the long axis
    ends = [(points[run, 0].min(), points[run, 0].max()) for run in runs]
    assert all(high <= low for (_, high), (low, _) in pairwise(ends))
