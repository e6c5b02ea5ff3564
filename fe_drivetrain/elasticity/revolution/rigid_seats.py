"""Stiffness of a shaft between rigid seats or end faces, condensed harmonic by harmonic."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.linalg import block_diag

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.revolution import frontal
from fe_drivetrain.elasticity.revolution.element_order import dissection
from fe_drivetrain.elasticity.revolution.harmonics import (
    material_law,
    on_axis,
    rigid_motions_at,
    turn,
)
from fe_drivetrain.elasticity.revolution.meridian_mesh import Meridian, meridian
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Shaft


def end_stiffness(
    shaft: Shaft,
    material: Material,
    size: float | None = None,
    *,
    order: int | None = None,
    layers: int = 4,
    per_fillet: int = 6,
) -> Floats:
    """Stiffness of a shaft between its two end faces, each rigid.

    Parameters
    ----------
    shaft, size, order, layers, per_fillet : Shaft, float or None, int or None, int, int
        Arguments of `fe_drivetrain.elasticity.revolution.meridian`. With the default size stiffness
        is right to some 1e-5 where diameters are equal, to 2e-4 where they differ by 2.5 to 1. For
        a shaft with fillets 2 per fillet is many times quicker.
    material : Material
        Material of the shaft.

    Returns
    -------
    (12, 12) from displacements [m] and rotations [rad] along and about x, y, z at the middle of the
    front face, then of the rear face, to the forces [N] and moments [N m] there.
    """
    mesh = meridian(shaft, size, order=order, layers=layers, per_fillet=per_fillet)
    return stiffness_between_ends(mesh, material)


def seat_stiffness(
    shaft: Shaft,
    material: Material,
    seats: Sequence[tuple[float, float]],
    size: float | None = None,
    *,
    order: int | None = None,
    layers: int = 4,
    per_fillet: int = 6,
) -> Floats:
    """Stiffness of a shaft between any of its seats, each rigid.

    Parameters
    ----------
    shaft, size, order, layers, per_fillet : Shaft, float or None, int or None, int, int
        Arguments of `meridian`. Quadrilaterals are graded towards the seats' ends, triangles are
        not: for a shaft with fillets give 2 per fillet.
    material : Material
        Material of the shaft.
    seats : Sequence[tuple[float, float]]
        Axial places x of both ends of each seat [m]: the outer surface of one section between them;
        twice the x of the shaft's front or rear for that end face.

    Returns
    -------
    (6 s, 6 s) from displacements [m] and rotations [rad] along and about x, y, z at the middle of
    each seat, on the axis, to the forces [N] and moments [N m] there.

    Raises
    ------
    InputError
        A seat is not on the shaft, reaches over a step, or meets another.
    """
    radii = [_seat(shaft, seat) for seat in seats]
    wide = [(seat, radius) for seat, radius in zip(seats, radii, strict=True) if _wide(seat)]
    mesh = meridian(
        shaft.cut(x for seat, _ in wide for x in seat),
        size,
        order=order,
        layers=layers,
        per_fillet=per_fillet,
        corners=[end for seat, radius in wide for end in zip(seat, radius, strict=True)],
    )
    x, r = mesh.nodes.T
    nodes = []
    for seat, radius in zip(seats, radii, strict=True):
        low, high = seat[0] - LENGTH_TOLERANCE, seat[1] + LENGTH_TOLERANCE
        here = (x > low) & (x < high)
        if _wide(seat):
            here &= np.abs(r - np.interp(x, seat, radius)) < LENGTH_TOLERANCE
        nodes.append((np.flatnonzero(here), 0.5 * (seat[0] + seat[1])))
    return stiffness_between_seats(mesh, material, nodes)


def stiffness_between_ends(mesh: Meridian, material: Material) -> Floats:
    """End stiffness of a meridian whose ends are its nodes of minimum and maximum x."""
    x = mesh.nodes[:, 0]
    ends = [(np.flatnonzero(np.abs(x - end) < LENGTH_TOLERANCE), end) for end in (x.min(), x.max())]
    return stiffness_between_seats(mesh, material, ends)


def stiffness_between_seats(
    mesh: Meridian, material: Material, seats: Sequence[tuple[Ints, float]]
) -> Floats:
    """Stiffness between rigid sets of nodes of a meridian.

    Parameters
    ----------
    mesh, material : Meridian, Material
        The meridian and what it is of.
    seats : Sequence[tuple[Ints, float]]
        Nodes (k,) of each, and the x of its reference point on the axis [m].

    Returns
    -------
    (6 s, 6 s) as of `seat_stiffness`.

    Raises
    ------
    InputError
        Two seats share a node.
    """
    met = np.concatenate([nodes for nodes, _ in seats])
    if len(np.unique(met)) < len(met):
        raise InputError("two seats meet: leave some of the shaft's surface between them")
    order = dissection(mesh.nodes[mesh.cells].mean(axis=1))

    def between(n: int, components: slice, which: slice) -> Floats:
        motions = [
            (nodes, rigid_motions_at(mesh.nodes[nodes] - [x, 0.0], n)[:, components, which])
            for nodes, x in seats
        ]
        law = material_law(material.lame, n)[components, components]
        return turn(n) * _between(mesh, law, order, n, motions, components)

    K = np.zeros((6 * len(seats), 6 * len(seats)))
    first: Ints = 6 * np.arange(len(seats))
    K[np.ix_(first, first)] = between(0, slice(0, 2), slice(0, 1))
    K[np.ix_(first + 3, first + 3)] = between(0, slice(2, 3), slice(1, 2))
    flexural = between(1, slice(0, 3), slice(0, 2))
    # along y, and about z
    rows: Ints = np.add.outer(first, np.array([1, 5])).ravel()
    K[np.ix_(rows, rows)] = flexural
    # along z, and about y: a rotation about y lifts z's side the other way
    rows = np.add.outer(first, np.array([2, 4])).ravel()
    signs = np.tile([1.0, -1.0], len(seats))
    K[np.ix_(rows, rows)] = flexural * np.outer(signs, signs)
    return K


def _wide(seat: tuple[float, float]) -> bool:
    return seat[1] - seat[0] > LENGTH_TOLERANCE


def _seat(shaft: Shaft, seat: tuple[float, float]) -> tuple[float, float]:
    """Outer radius of a seat at its ends [m]; of an end face what stands there twice."""
    low, high = seat
    if not _wide(seat):
        if min(abs(low - shaft.front), abs(low - shaft.rear)) > LENGTH_TOLERANCE or high < low:
            raise InputError(
                f"seat from x = {low:g} m to {high:g} m has no width: give its two ends in "
                f"ascending order, or twice {shaft.front:g} m or {shaft.rear:g} m for an end face"
            )
        return 0.0, 0.0
    for piece, (start, end) in zip(shaft.pieces, pairwise(shaft.stations), strict=True):
        if start - LENGTH_TOLERANCE <= low and high <= end + LENGTH_TOLERANCE:
            widths = np.interp(seat, [start, end], [piece.outer_diameter, piece.end_diameter])
            return float(widths[0] / 2), float(widths[1] / 2)
    raise InputError(
        f"seat from x = {low:g} m to {high:g} m is not on one section of the shaft, which ends or "
        f"steps at x = {', '.join(f'{x:g}' for x in shaft.stations)} m: move or shorten it"
    )


def _between(
    mesh: Meridian,
    law: Floats,
    order: Ints,
    n: int,
    seats: Sequence[tuple[Ints, Floats]],
    components: slice,
) -> Floats:
    """Stiffness per radian between rigid motions, all else eliminated.

    Parameters
    ----------
    mesh, n : Meridian, int
        Meridian and harmonic.
    law, order : Floats, Ints
        Law and order of elimination, see `frontal.condensed`; the law of the components only.
    seats : Sequence[tuple[Ints, Floats]]
        Nodes (k,) and their motions (k, components, m).
    components : slice
        Components that the harmonic has.
    """
    # what is kept goes first
    kept, held, rows = 0, [], []
    for nodes, motions in seats:
        follows = motions != 0.0
        moved = follows.any(axis=2)
        if (follows.sum(axis=2) <= 1).all():  # each degree of freedom follows one motion
            number, share, row = follows.argmax(axis=2), motions.sum(axis=2), np.eye(len(motions.T))
        else:
            number, share, row = (
                moved.cumsum().reshape(moved.shape) - 1,
                1.0 * moved,
                motions[moved],
            )
        held.append((nodes, np.where(moved, kept + number, -1), share))
        rows.append(row)
        kept += len(row)
    _, coefficient = on_axis(mesh, n)
    shares = coefficient.reshape(-1, 3)[:, components].copy()
    ids = np.where(shares != 0.0, kept + np.arange(shares.size).reshape(shares.shape), -1)
    if n == 1:
        axis = np.flatnonzero(mesh.nodes[:, 1] == 0.0)
        ids[axis, 2] = ids[axis, 1]
    for nodes, number, share in held:
        ids[nodes], shares[nodes] = number, share
    ids = ids[mesh.cells].transpose(0, 2, 1).reshape(len(mesh.cells), -1)
    shares = shares[mesh.cells].transpose(0, 2, 1).reshape(len(mesh.cells), -1)
    T = block_diag(*rows)
    return np.asarray(T.T @ frontal.condensed(mesh.grams, law, ids, shares, kept, order) @ T)
