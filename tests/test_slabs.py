"""Elements in slabs: threads never meet, and the matrix is the same whatever threads there are."""

from itertools import pairwise

import numba
import numpy as np
import pytest

from fe_drivetrain.common import threads
from fe_drivetrain.mesh.blocks import brick
from fe_drivetrain.operator import elasticity
from fe_drivetrain.operator.slabs import slabs


@pytest.fixture(scope="module")
def bar():
    """Thirteen thousand hexahedra, long along z."""
    return brick((8, 8, 200), 8, lambda p: p * [1.0, 1.0, 9.0])


def test_slabs_share_no_node_and_leave_no_element_out(bar):
    apart, between = slabs(bar.points, bar.cells)
    assert len(apart) == 4
    everything = np.concatenate([*apart, between])
    np.testing.assert_array_equal(np.sort(everything), np.arange(len(bar.cells)))
    owner = np.full(len(bar.points), -1)
    for number, some in enumerate(apart):
        nodes = np.unique(bar.cells[some])
        assert (owner[nodes] == -1).all()
        owner[nodes] = number
    assert 0 < len(between) <= 3 * 3 * 64  # the layer of each cut, and its neighbours
    middles = bar.points[bar.cells, 2].mean(axis=1)
    assert all(middles[a].max() < middles[b].min() for a, b in pairwise(apart))


def test_a_small_mesh_is_one():
    block = brick((3, 3, 3), 8, lambda p: p)
    apart, between = slabs(block.points, block.cells)
    assert apart == []
    np.testing.assert_array_equal(between, np.arange(27))


def test_the_stiffness_is_that_of_one_element_after_the_other(bar, monkeypatch):
    before = numba.get_num_threads()
    numba.set_num_threads(numba.config.NUMBA_NUM_THREADS)
    try:
        K = elasticity.assemble(bar.points, bar.cells, (1.0, 1.0))
    finally:
        numba.set_num_threads(before)
    with threads.held_to_one_thread():
        alone = elasticity.assemble(bar.points, bar.cells, (1.0, 1.0))
    assert K.data.tobytes() == alone.data.tobytes()
    monkeypatch.setattr(elasticity, "slabs", lambda points, corners: ([], np.arange(len(corners))))
    serial = elasticity.assemble(bar.points, bar.cells, (1.0, 1.0))
    np.testing.assert_allclose(K.data, serial.data, rtol=0.0, atol=1e-14 * np.abs(K.data).max())
