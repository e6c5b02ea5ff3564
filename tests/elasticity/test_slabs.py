"""Elements in slabs: threads never meet, and the matrix is the same whatever threads there are."""

from itertools import pairwise

import numba
import numpy as np
import pytest

from fe_drivetrain.common import threads
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.operator import elasticity
from fe_drivetrain.elasticity.operator.slabs import slabs


@pytest.fixture(scope="module")
def bar():
    """Thirteen thousand hexahedra, long along z."""
    return brick((8, 8, 200), 8, lambda p: p * [1.0, 1.0, 9.0])


def test_parts_of_a_round_share_no_node_and_no_element_is_left_out(bar):
    rounds = slabs(bar.points, bar.cells)
    assert [len(parts) for parts in rounds] == [4, 5, 1]
    everything = np.concatenate([some for parts in rounds for some in parts])
    np.testing.assert_array_equal(np.sort(everything), np.arange(len(bar.cells)))
    for parts in rounds:
        owner = np.full(len(bar.points), -1)
        for number, some in enumerate(parts):
            nodes = np.unique(bar.cells[some])
            assert (owner[nodes] == -1).all()
            owner[nodes] = number
    first, around_cuts, left = rounds
    assert 0 < sum(map(len, around_cuts)) <= 3 * 3 * 64  # the layer of each cut, and its neighbours
    assert sum(map(len, left)) == 0
    middles = bar.points[bar.cells, 2].mean(axis=1)
    assert all(middles[a].max() < middles[b].min() for a, b in pairwise(first))


def test_elements_at_the_same_place_are_one_part():
    layer = brick((30, 30, 1), 8, lambda p: p * [1.0, 1.0, 40.0])
    parts = [some for parts in slabs(layer.points, layer.cells) for some in parts if len(some)]
    assert [len(some) for some in parts] == [900]


def test_a_small_mesh_is_one():
    block = brick((3, 3, 3), 8, lambda p: p)
    ((every,),) = slabs(block.points, block.cells)
    np.testing.assert_array_equal(every, np.arange(27))


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
    monkeypatch.setattr(elasticity, "slabs", lambda points, corners: [[np.arange(len(corners))]])
    serial = elasticity.assemble(bar.points, bar.cells, (1.0, 1.0))
    np.testing.assert_allclose(K.data, serial.data, rtol=0.0, atol=1e-14 * np.abs(K.data).max())
