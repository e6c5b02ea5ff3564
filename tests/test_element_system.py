"""Rows that each process makes of its own elements are those of the default's assembly."""

import numpy as np
import pytest
from conftest import coarse_scene
from scipy import sparse

from fe_drivetrain.interfaces.constraints import eliminate, fixed, held_nodes
from fe_drivetrain.interfaces.mortar import mortar_tie
from fe_drivetrain.mesh.blocks import brick
from fe_drivetrain.mesh.shapes import element_kind
from fe_drivetrain.operator.element_matrices import element_stiffness
from fe_drivetrain.operator.incompressible import (
    assemble_unlocked,
    full_rule,
    unlocked_functions,
)
from fe_drivetrain.response.model import build_model, mesh_scene
from fe_drivetrain.scene.materials import MATERIALS
from fe_drivetrain.solve.element_system import Cut, ElementSystem, cut
from fe_drivetrain.solve.own_rows import assembled, keep, kept, own_rows, own_trace
from fe_drivetrain.solve.reduction import GROUND

RUBBER = (4.95e9, 5e7)  # nu = 0.495


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


def of_scene(*arguments, **changes):
    scene = coarse_scene(*arguments, **changes)
    model = build_model(scene, mesh_scene(scene))
    return model, ElementSystem(
        model.mesh.points,
        [
            (model.mesh.cells[model.mesh.part_cells(p)], scene.material_of(p).lame)
            for p in model.mesh.part_names
        ],
        eliminate(model.constraints, model.n_dofs),
        model.springs,
    )


def tied_blocks():
    """Two blocks of two materials and meshes, tied by a mortar; held at one end."""
    one = brick((3, 3, 2), 10, lambda x: x * [1.0, 1.0, 0.7])
    other = brick((2, 2, 2), 10, lambda x: x * [1.0, 1.0, 0.8] - [0.0, 0.0, 0.8])
    points = np.vstack([one.points, other.points])
    shift = len(one.points)
    n = points.size
    tie = mortar_tie("tie", points, one.faces["z0"], other.faces["z1"] + shift, n)
    bottom = fixed("bottom", np.unique(other.faces["z0"]) + shift, n)
    side = held_nodes("side", np.unique(one.faces["z1"])[:3], (0,), n)
    materials = MATERIALS["steel"].lame, RUBBER
    cells = [(one.cells, materials[0]), (other.cells + shift, materials[1])]
    return ElementSystem(points, cells, eliminate([tie, bottom, side], n))


SYSTEMS = {
    "bonded": lambda: of_scene("bonded")[1],
    "sliding": lambda: of_scene("spherical")[1],
    "averaged": lambda: of_scene("spherical", **{"bearing_units.0.interface": "averaged"})[1],
    "rigid": lambda: of_scene("spherical", **{"bearing_units.0.interface": "rigid"})[1],
    "rollers": lambda: of_scene("spherical", **{"bearing_units.0.interface": "rollers"})[1],
    "mortar": tied_blocks,
}


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
