"""Stiffness of elements each for itself, of numpy alone: for processes that have no more.

What `elasticity` and `incompressible` assemble is the sum of these, which the tests show entry by
entry. Their compiled loops keep nothing of an element but its sum, and are several times faster.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.elasticity.mesh.mapping import jacobian


@dataclass(frozen=True)
class Rule:
    """Quadrature of elements of one kind.

    Attributes
    ----------
    gradients, weights : Floats
        (n_q, 3, k) reference gradients of the shape functions, and (n_q,) weights.
    values : Floats
        (n_q, k) shape functions.
    """

    gradients: Floats
    weights: Floats
    values: Floats


def element_stiffness(
    points: Floats, cells: Ints, rule: Rule, lame: tuple[float, float], functions: int = 0
) -> Floats:
    """Stiffness of each element.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints
        Node numbers (n_cells, k) in VTK's order.
    rule : Rule
        Quadrature rule of the elements.
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].
    functions : int
        Number of functions of each element that the dilatation is projected on; not projected where
        0.

    Returns
    -------
    stiffness
        Stiffness (n_cells, k, k, 3, 3): blocks of each pair of an element's nodes [N/m].
    """
    _, mu = lame
    physical, determinant = jacobian(points, cells, rule.gradients)
    n_cells, n_q, _, k = physical.shape
    rows = physical.reshape(n_cells, n_q, 3 * k)
    weighted = rows * (np.abs(determinant) * rule.weights)[..., None]
    products = (weighted.transpose(0, 2, 1) @ rows).reshape(n_cells, 3, k, 3, k)
    H = products.transpose(0, 2, 4, 1, 3)
    K = mu * H.swapaxes(3, 4)
    within, averaged = split(lame, k) if functions else (lame, 0.0)
    if within[0]:
        K += within[0] * H
    trace = mu * np.einsum("eabii->eab", H)
    for i in range(3):
        K[..., i, i] += trace
    if functions:
        R = projected(points, cells, rule, functions)[0].reshape(n_cells, functions, 3 * k)
        volumetric = (R.transpose(0, 2, 1) @ R).reshape(n_cells, k, 3, k, 3)
        K += averaged * volumetric.transpose(0, 1, 3, 2, 4)
    return np.ascontiguousarray(K)


def split(lame: tuple[float, float], k: int) -> tuple[tuple[float, float], float]:
    """Lame's constants of what stays at each point, and factor of the projected dilatation.

    In hexahedra the whole volumetric part is projected, 3 K = 3 lambda + 2 mu (Hughes 1980, Int. J.
    Numer. Meth. Eng. 15, 1413-1418: B-bar). In tetrahedra of 10 nodes it is lambda's alone: with
    the mean of the whole, u = 2 (a x) x - |x|^2 a about the middle, which has no deviatoric strain,
    would cost no energy.

    Parameters
    ----------
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].
    k : int
        Number of nodes of an element.

    Returns
    -------
    tuple[float, float]
        Lame's constants of the plain part.
    float
        Factor of the projected part [Pa].
    """
    lam, mu = lame
    whole = 0.0 if k == 10 else 2.0 * mu / 3.0
    return (-whole, mu), lam + whole


def projected(points: Floats, cells: Ints, rule: Rule, count: int) -> tuple[Floats, Floats]:
    """Dilatations of unit displacements in orthonormal functions of each cell.

    Parameters
    ----------
    points, cells, rule : Floats, Ints, Rule
        Arguments of `element_stiffness`.
    count : int
        Number of the functions.

    Returns
    -------
    rows, factor
        Coefficients (n_cells, count, k, 3), and the lower factor L (n_cells, count, count) of the
        functions' mass matrix: L^-1 makes them orthonormal.
    """
    physical, determinant = jacobian(points, cells, rule.gradients)
    volumes = np.abs(determinant) * rule.weights
    positions = np.einsum("qn,eni->eqi", rule.values, points[cells])
    functions = element_functions(points[cells], positions, count)
    weighted = volumes[..., None] * functions
    mass = np.einsum("eqp,eqr->epr", weighted, functions)
    rows = np.einsum("eqp,eqik->epki", weighted, physical, optimize=True)
    factor = np.linalg.cholesky(mass)
    shape = rows.shape
    return np.linalg.solve(factor, rows.reshape(*shape[:2], -1)).reshape(shape), factor


def element_functions(nodes: Floats, positions: Floats, count: int) -> Floats:
    """(n_cells, n_q, count): one, and x, y, z from the middle of the cell, over its size.

    In the positions themselves, not in reference coordinates: so a linear pressure is held exactly
    by distorted elements, too (Arnold, Boffi and Falk 2002, Math. Comput. 71, 909-922).
    """
    middle = nodes.mean(axis=1, keepdims=True)
    size = np.ptp(nodes, axis=1).max(axis=1)[:, None, None]
    ones = np.ones((*positions.shape[:2], 1))
    return np.concatenate([ones, (positions - middle) / size], axis=2)[..., :count]
