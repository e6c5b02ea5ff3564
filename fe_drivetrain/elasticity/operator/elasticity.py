"""The elastic operator: stiffness of tetrahedra and hexahedra, straight into 3x3 node blocks.

scikit-fem's shape functions and quadrature, but an assembly of its own: sparsity first, then each
element adds its blocks in place. Tetrahedra with straight edges take one reference tensor, only the
curved ones are integrated. Checked against scikit-fem's generic assembly in the tests.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numba import get_num_threads
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.elasticity.mesh.numbering import check_nodes
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator import element_loops
from fe_drivetrain.elasticity.operator.slabs import slabs


@dataclass(frozen=True)
class Pattern:
    """Which nodes share a cell: stays as long as the cells do, whatever material or shape.

    Attributes
    ----------
    indptr, indices : NDArray[np.int32]
        Block rows and columns, as in ``scipy.sparse.bsr_array``.
    slots : NDArray[np.int32]
        (n_cells, k, k) the place in ``indices`` of each pair of a cell's nodes.
    """

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    slots: NDArray[np.int32]


def sparsity(cells: Ints, n_nodes: int) -> Pattern:
    """The sparsity of the stiffness of these cells.

    Parameters
    ----------
    cells : Ints
        (n_cells, k) node numbers in VTK's order.
    n_nodes : int
        Number of block rows.

    Raises
    ------
    InputError
        A cell has a node that there is not.
    """
    check_nodes(cells, n_nodes)
    return Pattern(*element_loops.sparsity(np.ascontiguousarray(cells, dtype=np.int32), n_nodes))


def assemble(
    points: Floats,
    cells: Ints,
    lame: tuple[float, float],
    n_dofs: int | None = None,
    pattern: Pattern | None = None,
) -> sparse.bsr_array:
    """Assemble the stiffness of the given elements.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints
        (n_cells, k) node numbers in VTK's order; tetrahedra of 4 or 10, hexahedra of 8, 20 or 27
        nodes.
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].
    n_dofs : int or None
        Order of the matrix, a multiple of three; degree of freedom 3 i + k is displacement k of
        node i, what comes after 3 n belongs to reference points and is left empty. 3 n where not
        given.
    pattern : Pattern or None
        Pattern from `sparsity` for the same cells and n_dofs / 3 nodes, to spare making it again.

    Returns
    -------
    stiffness
        Symmetric (n_dofs, n_dofs) in 3x3 blocks [N/m].

    Raises
    ------
    InputError
        A cell has a node that there is not.
    """
    everywhere = np.ones(len(cells), dtype=bool)
    return assemble_materials(points, cells, [(everywhere, lame)], n_dofs, pattern)


def assemble_materials(
    points: Floats,
    cells: Ints,
    materials: Sequence[tuple[Bools, tuple[float, float]]],
    n_dofs: int | None = None,
    pattern: Pattern | None = None,
    others: sparse.bsr_array | None = None,
) -> sparse.bsr_array:
    """Sum of `assemble` over elements of several materials, with one sparsity.

    Parameters
    ----------
    points, cells, n_dofs, pattern : Floats, Ints, int or None, Pattern or None
        Arguments of `assemble`.
    materials : Sequence[tuple[Bools, tuple[float, float]]]
        Flags (n_cells,) of the elements of each material, and its Lame's constants [Pa].
    others : sparse.bsr_array or None
        Matrix (n_dofs, n_dofs) in 3x3 blocks that is added [N/m]: at little cost where all of its
        rows come after those of the nodes.

    Raises
    ------
    InputError
        A cell has a node that there is not.
    """
    check_nodes(cells, len(points))
    n_blocks = len(points) if n_dofs is None else n_dofs // 3
    kind = element_kind(cells.shape[1])
    pattern = pattern or sparsity(cells, n_blocks)
    indptr, indices = pattern.indptr, pattern.indices
    nodes = np.ascontiguousarray(cells, dtype=np.int32)
    last = None
    if others is not None and others.indptr[len(points)] == 0:
        last = others.sorted_indices()  # adding it afterwards would copy all
        indptr = (indptr + last.indptr).astype(np.int32)
        indices = np.concatenate([indices, last.indices.astype(np.int32)])
    # NumPy asks for large pages for `empty`, not for `zeros`, whose small ones cost a third of all
    data = np.empty((len(indices), 3, 3))
    with ThreadPoolExecutor(get_num_threads()) as pool:
        clears = [pool.submit(some.fill, 0.0) for some in np.array_split(data, get_num_threads())]
        # Gradients of straight tetrahedra are linear at most: a rule of degree 2 is exact.
        affine = np.full(len(cells), kind.name == "tetra")
        if kind.name == "tetra10":
            affine = element_loops.is_straight(points, nodes)
        rules = [
            (of & straight, rule, lame)
            for of, lame in materials
            for straight, rule in ((affine, kind.table(2)), (~affine, kind.table(kind.degree)))
        ]

        def add(some: Ints) -> None:
            for of, rule, lame in rules:
                element_loops.add_elements(
                    points, nodes, some[of[some]], *rule, *lame, pattern.slots, data
                )

        rounds = slabs(points, cells[:, : kind.n_corners])
        for clear in clears:
            clear.result()
        for parts in rounds:
            list(pool.map(add, parts))
    if last is not None:
        data[len(pattern.indices) :] = last.data
    total = sparse.bsr_array((data, indices, indptr), shape=(3 * n_blocks, 3 * n_blocks))
    return total if others is None or last is not None else total + others
