"""Marking takes the fewest cells that matter, and the next mesh is finer there and nowhere else."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fe_drivetrain.cases.verification.adaptivity import cell_sizes, marked, refined_sizes
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.generation import generate
from fe_drivetrain.elasticity.mesh.measures import volume
from fe_drivetrain.geometry import MeshSizes, Section, Shaft

TUBE = Shaft(front=-1.0, sections=(Section(length=2.0, outer_diameter=0.6, inner_diameter=0.2),))
SIZES = MeshSizes(shaft=0.25, elements_per_turn=8)


@given(st.lists(st.floats(1e-6, 1.0), min_size=1, max_size=30), st.floats(0.05, 1.0))
def test_marked_cells_are_the_fewest_that_hold_the_share(indicators, share):
    values = np.array(indicators)
    chosen = marked(values, share)
    assert values[chosen].sum() >= share * values.sum() * (1 - 1e-12)
    # without the last of them the share is missed, and no other cell is larger
    assert values[chosen[:-1]].sum() < share * values.sum() * (1 + 1e-12)
    rest = np.delete(values, chosen)
    assert not len(rest) or rest.max() <= values[chosen].min()


@pytest.mark.parametrize("share", [0.0, -1.0, 1.5])
def test_share_outside_its_range_is_refused(share):
    with pytest.raises(InputError, match="share"):
        marked(np.ones(3), share)


def test_size_of_a_regular_tetrahedron_is_its_edge():
    points = 0.3 * np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    assert cell_sizes(points, np.arange(4)[None]) == pytest.approx(0.6 * np.sqrt(2), rel=1e-12)


def test_next_mesh_is_finer_where_cells_are_marked():
    mesh = generate(TUBE, sizes=SIZES)
    middle = mesh.points[mesh.cells[:, :4]].mean(axis=1)
    chosen = np.flatnonzero(np.abs(middle[:, 0]) < 0.3)
    finer = generate(TUBE, sizes=SIZES, local=refined_sizes(mesh, chosen))

    def sizes_at(m, low, high):
        x = np.abs(m.points[m.cells[:, :4]].mean(axis=1)[:, 0])
        return cell_sizes(m.points, m.cells)[(low <= x) & (x < high)].mean()

    assert sizes_at(finer, 0.0, 0.2) < 0.7 * sizes_at(mesh, 0.0, 0.2)
    assert sizes_at(finer, 0.7, 1.0) > 0.75 * sizes_at(mesh, 0.7, 1.0)
    # the shape is meshed again: curved surfaces are no worse
    exact = np.pi / 4 * (0.6**2 - 0.2**2) * 2.0
    assert abs(volume(finer) - exact) <= abs(volume(mesh) - exact)


def test_factor_that_does_not_refine_is_refused():
    mesh = generate(TUBE, sizes=SIZES)
    with pytest.raises(InputError, match="factor"):
        refined_sizes(mesh, np.array([0]), factor=1.0)
