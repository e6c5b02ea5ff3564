"""The elastic operator of nearly incompressible solids: dilatation averaged inside each element.

Near nu = 1/2 any change of volume costs more than all else, and elements that can bend only by
changing it somewhere inside do not bend: they lock. Here the bulk modulus multiplies not the
dilatation div u but its projection on few functions of each element, the mean alone or with it the
slopes. That is the mixed form with the pressure, discontinuous from element to element and
condensed out of each (Herrmann 1965; Malkus and Hughes 1978, Comput. Methods Appl. Mech. Eng. 15,
63-81, who show that it is selective reduced integration), so that the matrix has the pattern of the
plain one and goes to the same solvers. Of hexahedra the whole volumetric part is projected, as
Hughes (1980) has it; of tetrahedra that of lambda alone, see `element_matrices.split`.

How many functions an element bears is a matter of the inf-sup condition (Boffi, Brezzi and Fortin
2013, Mixed Finite Element Methods and Applications, chapter 8): the mean for hexahedra of 8 nodes
(B-bar, Hughes 1980) and tetrahedra of 10, the mean and three slopes for hexahedra of 20 and 27.
Tetrahedra of four nodes have a constant dilatation already, and no remedy in it. With the mean
alone, tetrahedra of 10 nodes lose an order of accuracy: away from nu = 1/2 they are better plain.
"""

from collections.abc import Sequence

import numpy as np
from scipy import sparse
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import CHUNK, Bools, Floats, Ints, chunks
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.shapes import ElementKind, element_kind
from fe_drivetrain.elasticity.operator import elasticity
from fe_drivetrain.elasticity.operator.elasticity import Pattern
from fe_drivetrain.elasticity.operator.element_matrices import (
    Rule,
    element_functions,
    projected,
    split,
)
from fe_drivetrain.elasticity.operator.stress import strains

AVERAGED_FROM = 0.45
"""Poisson's ratio from which parts of a scene, tetrahedra of 10 nodes, have averaged dilatations.

Bonded, plain ones lose more to locking from here on than averaged ones lose in bending, at the same
two elements across (``cases/stability/volumetric_locking.py``). Structural metals stand below.
"""

#: Functions that the dilatation of an element is projected on, by its number of nodes.
FUNCTIONS = {8: 1, 10: 1, 20: 4, 27: 4}


def assemble(
    points: Floats,
    cells: Ints,
    lame: tuple[float, float],
    n_dofs: int | None = None,
    pattern: Pattern | None = None,
) -> sparse.bsr_array:
    """Assemble the stiffness, the dilatation projected.

    Arguments and result are those of `elasticity.assemble`, for tetrahedra of 10 and hexahedra
    of 8, 20 or 27 nodes.

    Raises
    ------
    InputError
        The elements are tetrahedra of four nodes.
    """
    within, averaged = split(lame, cells.shape[1])
    plain = elasticity.assemble(points, cells, within, n_dofs, pattern)
    return _with_averaged(plain, points, cells, averaged)


def _with_averaged(
    K: sparse.bsr_array, points: Floats, cells: Ints, factor: float
) -> sparse.bsr_array:
    """A stiffness and that of averaged dilatations."""
    rows = np.concatenate(
        [_projected(points, cells[chunk])[0] for chunk in chunks(len(cells), CHUNK // 4)]
    )
    return plus_products(K, factor, rows, cells, K.shape[0])


def poisson_ratio(lame: tuple[float, float]) -> float:
    """nu of Lame's constants (lambda, mu)."""
    lam, mu = lame
    return 0.5 * lam / (lam + mu)


def assemble_unlocked(
    points: Floats, cells: Ints, lame: tuple[float, float], n_dofs: int | None = None
) -> sparse.bsr_array:
    """`elasticity.assemble` below `AVERAGED_FROM`, and `assemble` from there on."""
    averaged = poisson_ratio(lame) >= AVERAGED_FROM
    return (assemble if averaged else elasticity.assemble)(points, cells, lame, n_dofs)


def assemble_materials(
    points: Floats,
    cells: Ints,
    materials: Sequence[tuple[Bools, tuple[float, float]]],
    n_dofs: int | None = None,
    others: sparse.bsr_array | None = None,
    pattern: Pattern | None = None,
) -> sparse.bsr_array:
    """Sum of `assemble_unlocked` over elements of several materials.

    Parameters
    ----------
    points, cells, n_dofs : Floats, Ints, int or None
        Arguments of `assemble`.
    materials : Sequence[tuple[Bools, tuple[float, float]]]
        Flags (n_cells,) of the elements of each material, and its Lame's constants [Pa].
    others : sparse.bsr_array or None
        Matrix (n_dofs, n_dofs) in 3x3 blocks that is added [N/m].
    pattern : Pattern or None
        See `assemble`.
    """
    averaged = [poisson_ratio(lame) >= AVERAGED_FROM for _, lame in materials]
    k = cells.shape[1]
    plain = [
        (some, split(lame, k)[0] if projects else lame)
        for (some, lame), projects in zip(materials, averaged, strict=True)
    ]
    K = elasticity.assemble_materials(points, cells, plain, n_dofs, pattern, others)
    for (some, lame), projects in zip(materials, averaged, strict=True):
        if projects:
            K = _with_averaged(K, points, cells[some], split(lame, k)[1])
    return K


def warn_of_averaging(part: str, lame: tuple[float, float]) -> tuple[str, ...]:
    """A sentence on a part that `assemble_unlocked` treats as nearly incompressible, or none."""
    nu = poisson_ratio(lame)
    if nu < AVERAGED_FROM:
        return ()
    return (
        f"{part} has nu = {nu:g}, and from {AVERAGED_FROM:g} on plain elements lock: its "
        "dilatation is averaged in each element; give it four elements through its thickness",
    )


def stresses(
    points: Floats, cells: Ints, u: Floats, lame: tuple[float, float], at: Floats
) -> Floats:
    """Stresses inside the elements with the dilatation that was assembled; see `stress.stresses`.

    Parameters
    ----------
    points, cells, lame : Floats, Ints, tuple[float, float]
        Arguments of `assemble`, with Lame's constants (lambda, mu) [Pa].
    u : Floats
        Displacements (3 n,) or longer [m].
    at : Floats
        Reference coordinates (3, n_q) in each element.

    Returns
    -------
    stresses
        Stresses (n_cells, n_q, 6) in the order of `components.STRESSES` [Pa].
    """
    kind = element_kind(cells.shape[1])
    values = kind.shape(at)[0]
    (lam, mu), averaged = split(lame, cells.shape[1])
    found = strains(points, cells, u, at)
    trace = found[:, :, :3].sum(axis=2, keepdims=True)
    found *= 2.0 * mu
    found[:, :, :3] += lam * trace
    displacements = u[: points.size].reshape(-1, 3)
    for chunk in chunks(len(cells), CHUNK // 4):
        some = cells[chunk]
        rows, factor = _projected(points, some)
        coefficients = np.einsum("epki,eki->ep", rows, displacements[some])
        positions = np.einsum("qn,eni->eqi", values, points[some])
        functions = element_functions(points[some], positions, rows.shape[1])
        orthonormal = np.linalg.solve(factor[:, None], functions[..., None])[..., 0]
        dilatation = np.einsum("eqp,ep->eq", orthonormal, coefficients)
        found[chunk, :, :3] += averaged * dilatation[..., None]
    return found


def plus_products(
    K: sparse.bsr_array, factor: float, rows: Floats, cells: Ints, n_dofs: int
) -> sparse.bsr_array:
    """K + factor R^T R, each row of R over the degrees of freedom of one cell.

    Parameters
    ----------
    K : sparse.bsr_array
        (n_dofs, n_dofs) in 3x3 blocks.
    rows : Floats
        (n_cells, p, k, 3): p rows a cell, over the displacements of its nodes.
    cells : Ints
        (n_cells, k) node numbers.
    """
    n_cells, p, k, _ = rows.shape
    columns = np.repeat(cells[:, None], p, axis=1).astype(np.int32)
    R = sparse.bsr_array(
        (rows.reshape(-1, 1, 3), columns.ravel(), k * np.arange(n_cells * p + 1, dtype=np.int32)),
        shape=(n_cells * p, n_dofs),
    )
    total = K + factor * (R.T @ R)
    total.sort_indices()
    indices, indptr = (i.astype(np.int32, copy=False) for i in (total.indices, total.indptr))
    return sparse.bsr_array((total.data, indices, indptr), shape=K.shape)


def _projected(points: Floats, cells: Ints) -> tuple[Floats, Floats]:
    """Rows and factor of `projected`, with as many functions as these elements bear."""
    k = cells.shape[1]
    return projected(points, cells, full_rule(element_kind(k)), _functions(k))


def full_rule(kind: ElementKind) -> Rule:
    """Quadrature rule of curved elements."""
    at, weights = get_quadrature(kind.element.refdom, kind.degree)
    values, gradients = kind.shape(at)
    return Rule(gradients, weights, values)


def unlocked_functions(k: int, lame: tuple[float, float]) -> int:
    """Functions that `assemble_unlocked` projects dilatations on; 0 where it leaves them.

    Parameters
    ----------
    k : int
        Nodes of an element.
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].

    Raises
    ------
    InputError
        The elements are tetrahedra of four nodes, and nu is `AVERAGED_FROM` or more.
    """
    return _functions(k) if poisson_ratio(lame) >= AVERAGED_FROM else 0


def _functions(k: int) -> int:
    if k not in FUNCTIONS:
        raise InputError(
            "nearly incompressible solids cannot be made of tetrahedra of 4 nodes, which lock "
            "whatever is averaged inside them: use tetrahedra of 10 nodes, or hexahedra of 8, 20 "
            "or 27"
        )
    return FUNCTIONS[k]
