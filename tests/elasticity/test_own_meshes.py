"""A mesh of one's own is checked before it is used: what is wrong is named, with cell and node."""

from collections.abc import Callable

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.interfaces.constraints import fixed
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.mesh.facets import face_weights, volume_weights
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.operator import incompatible, incompressible
from fe_drivetrain.elasticity.operator.elasticity import assemble, sparsity
from fe_drivetrain.elasticity.operator.elements import check_elements
from fe_drivetrain.elasticity.operator.loads import body_loads, traction_loads
from fe_drivetrain.elasticity.operator.mass import mass_matrix
from fe_drivetrain.elasticity.operator.stress import nodal_stresses
from fe_drivetrain.elasticity.solve.coupled_solid import coupled_solid
from fe_drivetrain.elasticity.solve.solid import solve_solid

LAME = (1.2e11, 8e10)
KINDS = (4, 10, 8, 20, 27)


def solved(points, cells):
    n = 3 * len(points)
    F = np.zeros(n)
    F[2] = 1.0
    top = np.flatnonzero(points[:, 0] > points[:, 0].max() - 1e-9)
    return solve_solid(points, cells, LAME, [fixed("end", top, n)], F)


#: Where elements must be sound.
ENTRIES: dict[str, Callable[[np.ndarray, np.ndarray], object]] = {
    "solve_solid": solved,
    "check_elements": check_elements,
    "coupled_solid": lambda points, cells: coupled_solid(
        Mesh(points, cells, np.zeros(len(cells), np.int64), ("body",), {}, {}),
        {"body": MATERIALS["steel"]},
        [],
    ),
}
#: Those that sum over cells and do not mind how they are turned, beside them.
NUMBERED = ENTRIES | {
    "assemble": lambda points, cells: assemble(points, cells, LAME),
    "mass_matrix": lambda points, cells: mass_matrix(points, cells, 1.0, 3 * len(points)),
    "body_loads": lambda points, cells: body_loads(points, cells, np.array([0, 0, 1.0])),
    "sparsity": lambda points, cells: sparsity(cells, len(points)),
    "volume_weights": lambda points, cells: volume_weights(points, cells, len(points)),
    "nodal_stresses": lambda points, cells: nodal_stresses(
        points, cells, np.zeros(3 * len(points)), LAME
    ),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("entry", NUMBERED)
@pytest.mark.parametrize("wrong", [10_000, -1])
def test_a_node_that_there_is_not_is_named(kind, entry, wrong):
    block = brick((2, 2, 2), nodes=kind)
    cells = block.cells.copy()
    cells[3, 2] = wrong
    last = len(block.points) - 1
    with pytest.raises(
        InputError, match=f"cell 3 has node {wrong} but nodes are numbered 0 to {last}"
    ):
        NUMBERED[entry](block.points, cells)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("entry", ENTRIES)
def test_a_cell_turned_inside_out_is_named(kind, entry):
    block = brick((2, 2, 2), nodes=kind)
    mirrored = block.points * [1.0, 1.0, -1.0]
    with pytest.raises(InputError, match=f"cell 0 .*and {len(block.cells) - 1} more cells"):
        ENTRIES[entry](mirrored, block.cells)
    ENTRIES[entry](block.points, block.cells)


@pytest.mark.parametrize("kind", KINDS)
def test_one_corner_drawn_through_its_cell_folds_it(kind):
    """The corner at (0, 0, 0) belongs to few cells; drawn past the far one they fold."""
    block = brick((1, 1, 1), nodes=kind)
    corner = int(np.flatnonzero((np.abs(block.points) < 1e-12).all(axis=1))[0])
    points = block.points.copy()
    points[corner] = [1.1, 1.1, 1.1]
    with pytest.raises(InputError, match="folded over"):
        check_elements(points, block.cells)
    points[corner] = [0.02, 0.02, 0.02]
    check_elements(points, block.cells)


def test_a_mid_side_node_at_a_corner_folds_a_tetrahedron_that_gauss_points_pass():
    """Beyond a quarter of the edge from its end, the Jacobian is negative at that end."""
    block = brick((1, 1, 1), nodes=10)
    first = block.cells[0]
    a, b, middle = block.points[first[0]], block.points[first[1]], first[4]
    for share, sound in ((0.26, True), (0.24, False)):
        points = block.points.copy()
        points[middle] = (1 - share) * a + share * b
        if sound:
            check_elements(points, block.cells)
        else:
            with pytest.raises(InputError, match="folded over, flat"):
                check_elements(points, block.cells)


@pytest.mark.parametrize("assembly", [assemble, incompatible.assemble, incompressible.assemble])
def test_every_assembly_names_a_node_that_there_is_not(assembly):
    nodes = 8 if assembly is incompatible.assemble else 10
    block = brick((2, 2, 2), nodes=nodes)
    cells = block.cells.copy()
    cells[1, 1] = -3
    with pytest.raises(InputError, match="cell 1 has node -3"):
        assembly(block.points, cells, LAME)


def test_a_flat_cell_and_a_node_without_position_are_named():
    block = brick((1, 1, 1), nodes=4)
    with pytest.raises(InputError, match="flat"):
        check_elements(block.points * [1.0, 1.0, 0.0], block.cells)
    points = block.points.copy()
    points[5, 1] = np.nan
    with pytest.raises(InputError, match=r"node 5 is at .*nan.* must have a position"):
        check_elements(points, block.cells)


def test_a_node_in_no_cell_is_named_unless_it_is_held():
    block = brick((2, 2, 2), nodes=8)
    points = np.vstack([block.points, [[0.5, 0.5, 7.0]]])
    with pytest.raises(InputError, match=r"node 27 at \(0.5, 0.5, 7\) m belongs to no cell"):
        solved(points, block.cells)
    n = 3 * len(points)
    far = np.r_[np.flatnonzero(points[:, 0] > 1 - 1e-9), 27]
    F = np.zeros(n)
    F[2] = 1.0
    u = solve_solid(points, block.cells, LAME, [fixed("end", far, n)], F).u[:81]
    np.testing.assert_allclose(u, solved(block.points, block.cells).u, rtol=1e-9, atol=1e-20)


def test_facets_and_numbers_that_are_not_whole_are_refused():
    block = brick((2, 2, 2), nodes=8)
    facets = block.faces["x0"].copy()
    facets[1, 0] = 99
    for entry in (face_weights, lambda p, f, n: traction_loads(p, f, np.ones(3))):
        with pytest.raises(InputError, match="facet 1 has node 99"):
            entry(block.points, facets, 27)
    with pytest.raises(InputError, match="must be whole numbers of nodes"):
        assemble(block.points, block.cells.astype(float), LAME)
