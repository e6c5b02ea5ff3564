"""Timoshenko shaft on springs in space, solved by the force method (level 1 of the ladder).

A shaft is a chain of sections, so statics fixes its internal forces as soon as the support
reactions are known. The unknowns are therefore the reactions and the six rigid-body motions, a
system of about twenty equations whatever the number of sections:

- a support stiffness enters as a compliance, so a rigid support is exactly zero compliance: no
  penalty number, and a very stiff spring tends to it without loss of digits;
- tapered sections enter through their flexibility, integrated to machine precision, so a cone is
  one exact element;
- equilibrium is one of the equations and holds to machine precision.

Frame: x along the shaft, z up, y = z cross x. Vectors of six are ordered Fx, Fy, Fz, Mx, My, Mz
and ux, uy, uz, rx, ry, rz. A *reaction* is the load that the shaft puts ON the support, at the
support's station; the force on the shaft is its negative.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import along_x, wrench_transport
from fe_drivetrain.shafts.beam.beam import SAME_STATION, Beam, stations_on
from fe_drivetrain.shafts.beam.sections import element_integrals, stiffness_of_ends

# A rigid-body motion held by less than this share of a unit support is free.
_FREE = 1e-9
# A spring this many times softer than the shaft leaves no digit of what it does.
_SOFT = 1e12
_MOTION_GROUPS = (
    ((0,), "move along x"),
    ((3,), "turn about x"),
    ((1, 5), "move along y and turn about z"),
    ((2, 4), "move along z and turn about y"),
)
_AXES = ("x", "y", "z", "rotation x", "rotation y", "rotation z")


@dataclass(frozen=True, eq=False)
class BeamSolution:
    """Displacements and reactions of load cases.

    Attributes
    ----------
    stations : ndarray, (S,) or ()
        Stations where displacements are given, m; for a scalar they have no axis S.
    supports : tuple of str, (m,)
        Names, in the order of the reactions.
    displacements : ndarray, (..., S, 6)
        m and rad.
    reactions : ndarray, (..., m, 6)
        Load on each support at its station, N and N m.
    """

    stations: Floats
    supports: tuple[str, ...]
    displacements: Floats
    reactions: Floats

    __repr__ = short_repr

    def reaction(self, support: str) -> Floats:
        """Load on one support, (..., 6).

        Raises
        ------
        InputError
            If no support has that name.
        """
        return np.asarray(self.reactions[..., _support_index(self.supports, support), :])


@dataclass(frozen=True, eq=False)
class UnitLoadResponse:
    """The beam's whole linear answer: displacements and reactions for unit loads.

    The axis L, or S, is there when the stations were given as a sequence, not for a scalar.

    Attributes
    ----------
    load_stations : ndarray, (L,) or ()
        Stations where loads may act, m.
    stations : ndarray, (S,) or ()
        Stations where displacements are given, m.
    supports : tuple of str, (m,)
        Names, in the order of the reactions.
    displacement : ndarray, (S, 6, L, 6)
        Displacement per unit load: the compliance, m/N and so on.
    reaction : ndarray, (m, 6, L, 6)
        Load on each support per unit load.
    gravity_displacement : ndarray, (S, 6, 3)
        Displacement per m/s^2 of gravity along x, y, z.
    gravity_reaction : ndarray, (m, 6, 3)
        Reaction per m/s^2 of gravity along x, y, z.
    """

    load_stations: Floats
    stations: Floats
    supports: tuple[str, ...]
    displacement: Floats
    reaction: Floats
    gravity_displacement: Floats
    gravity_reaction: Floats

    __repr__ = short_repr

    def solution(self, loads: ArrayLike, gravity: ArrayLike = (0.0, 0.0, 0.0)) -> BeamSolution:
        """Answer to load cases, as one matrix product.

        Parameters
        ----------
        loads : array_like, (..., L, 6), or (..., 6) for a scalar load station
            N and N m on the shaft.
        gravity : array_like, (3,)
            Acceleration, m/s^2: (0, 0, -9.81) for a level shaft.

        Returns
        -------
        BeamSolution

        Raises
        ------
        InputError
            If a shape does not fit or a value is not finite.
        """
        load = np.asarray(loads, dtype=float)
        one = (*self.load_stations.shape, 6)
        if load.ndim < len(one) or load.shape[load.ndim - len(one) :] != one:
            raise InputError(
                f"loads of shape {load.shape} must end in {one}: give six components for each load "
                "station."
            )
        _check_finite("loads", load)
        g = np.asarray(gravity, dtype=float)
        if g.shape != (3,):
            raise InputError(f"gravity of shape {g.shape} must be 3 components in m/s^2.")
        _check_finite("gravity", g)
        flat = load.reshape(-1, int(np.prod(one)))
        cases = load.shape[: load.ndim - len(one)]

        def respond(unit: Floats, constant: Floats) -> Floats:
            out = flat @ unit.reshape(-1, flat.shape[1]).T
            out += (constant @ g).ravel()
            return out.reshape(*cases, *constant.shape[:-1])

        return BeamSolution(
            self.stations,
            self.supports,
            respond(self.displacement, self.gravity_displacement),
            respond(self.reaction, self.gravity_reaction),
        )

    def reaction_matrix(self, support: str) -> Floats:
        """Load on one support per unit load, (6, L, 6), or (6, 6) for a scalar load station.

        Raises
        ------
        InputError
            If no support has that name.
        """
        return np.asarray(self.reaction[_support_index(self.supports, support)])


def unit_load_response(
    beam: Beam, load_stations: ArrayLike, at: ArrayLike | None = None
) -> UnitLoadResponse:
    """Displacements and reactions for a unit of each load component at each load station.

    Parameters
    ----------
    beam : Beam
        The shaft on its supports.
    load_stations : array_like, (L,) or scalar
        m.
    at : array_like, (S,) or scalar, optional
        Stations of the displacements, m; by default every section end, support and load station,
        in ascending order.

    Returns
    -------
    UnitLoadResponse

    Raises
    ------
    InputError
        If a station is not on the beam, the supports leave the beam free to move (the motion is
        named), or two rigid supports share a load indeterminately.
    """
    loaded = stations_on(beam, "load station", load_stations)
    wanted = stations_on(beam, "output station", [] if at is None else at)
    held = np.array([support.x for support in beam.supports])
    nodes = _merged_stations(
        np.concatenate([beam.ends, held, loaded.ravel(), wanted.ravel()]), beam.length
    )
    if at is None:
        wanted = nodes

    vectors, compliance, owner = _held_directions(beam, _nearest(nodes, held))
    directions = np.zeros((nodes.size, 6, owner.size))
    directions[_nearest(nodes, held)[owner], :, np.arange(owner.size)] = vectors
    rigid_body = np.swapaxes(wrench_transport(along_x(nodes - nodes[0])), -1, -2)
    grip = np.einsum("nca,ncq->aq", directions, rigid_body)
    _refuse_mechanism(grip, nodes[0], beam.length)

    flexibility, sag, weight = _elements(beam, nodes)
    loads = np.zeros((nodes.size, 6, loaded.size, 6))
    for j, node in enumerate(_nearest(nodes, loaded.ravel())):
        loads[node, :, j, :] = np.eye(6)
    gravity = np.zeros((nodes.size, 6, 3))
    gravity[:-1] = weight
    forces = np.concatenate([loads.reshape(nodes.size, 6, -1), gravity], axis=2)
    free = np.zeros((nodes.size - 1, 6, forces.shape[2]))
    free[:, :, -3:] = sag

    clamped = _clamped_displacements(nodes, flexibility, forces, free)
    yielding = _clamped_displacements(nodes, flexibility, directions)
    stiff = np.einsum("nca,ncb->ab", directions, yielding) + np.diag(compliance)
    tip = np.zeros_like(directions)
    tip[-1] = vectors.T
    tip_compliance = np.einsum(
        "ac,ca->a", vectors, _clamped_displacements(nodes, flexibility, tip)[-1]
    )
    reaction, motion = _solve_saddle(
        stiff,
        grip,
        np.einsum("nca,ncl->al", directions, clamped),
        np.einsum("ncq,ncl->ql", rigid_body, forces),
        tip_compliance,
        beam,
    )
    displacement = (clamped + rigid_body @ motion - yielding @ reaction)[_nearest(nodes, wanted)]
    on_support = np.zeros((len(beam.supports), 6, forces.shape[2]))
    np.add.at(on_support, owner, vectors[:, :, None] * reaction[:, None, :])
    split = loaded.size * 6
    per_load = (6, *loaded.shape, 6)
    return UnitLoadResponse(
        load_stations=loaded,
        stations=wanted,
        supports=tuple(support.name for support in beam.supports),
        displacement=displacement[..., :split].reshape(*wanted.shape, *per_load),
        reaction=on_support[..., :split].reshape(-1, *per_load),
        gravity_displacement=displacement[..., split:],
        gravity_reaction=on_support[..., split:],
    )


def solve(
    beam: Beam,
    load_stations: ArrayLike,
    loads: ArrayLike,
    at: ArrayLike | None = None,
    gravity: ArrayLike = (0.0, 0.0, 0.0),
) -> BeamSolution:
    """Displacements and reactions of any number of load cases.

    Parameters
    ----------
    beam : Beam
        The shaft on its supports.
    load_stations : array_like, (L,) or scalar
        m.
    loads : array_like, (..., L, 6), or (..., 6) for a scalar load station
        N and N m on the shaft.
    at : array_like, (S,) or scalar, optional
        Stations of the displacements, see `unit_load_response`.
    gravity : array_like, (3,)
        m/s^2; zero leaves the shaft's own weight out.

    Returns
    -------
    BeamSolution

    Raises
    ------
    InputError
        See `unit_load_response` and `UnitLoadResponse.solution`.
    """
    return unit_load_response(beam, load_stations, at).solution(loads, gravity)


def shaft_stiffness(beam: Beam, first: float, second: float) -> Floats:
    """Stiffness between two stations of the shaft, its supports left aside.

    Parameters
    ----------
    beam : Beam
        The shaft on its supports.
    first, second : float
        Stations, m, first < second.

    Returns
    -------
    ndarray, (12, 12)
        Forces on the shaft at `first` and `second` against the displacements there. Exact for
        loads at the two stations, tapers included.

    Raises
    ------
    InputError
        If the stations are off the beam or in the wrong order, or the shaft between is rigid.
    """
    stations_on(beam, "stiffness station", [first, second])
    if not second - first > SAME_STATION * beam.length:
        raise InputError(
            f"stiffness station {second:g} m must lie downwind of {first:g} m: swap the two."
        )
    inner = beam.ends[(beam.ends > first) & (beam.ends < second)]
    nodes = _merged_stations(np.array([first, *inner, second]), beam.length)
    flexibility, _, _ = _elements(beam, nodes)
    forces = np.zeros((nodes.size, 6, 6))
    forces[-1] = np.eye(6)
    compliance = _clamped_displacements(nodes, flexibility, forces)[-1]
    if not np.all(np.diag(compliance) > 0.0):
        raise InputError(
            f"shaft between {first:g} m and {second:g} m is rigid in some direction and has no "
            "finite stiffness: give its sections finite rigidities."
        )
    return stiffness_of_ends(compliance, second - first)


def _elements(beam: Beam, nodes: Floats) -> tuple[Floats, Floats, Floats]:
    """Flexibility (e, 6, 6), sag (e, 6, 3) and weight (e, 6, 3) between neighbouring nodes."""
    ends = beam.ends
    parts = []
    for a, b in pairwise(nodes.tolist()):
        index = int(np.searchsorted(ends, (a + b) / 2.0)) - 1
        origin = float(ends[index])
        parts.append(
            element_integrals(
                beam.sections[index], beam.material, beam.shear, a - origin, b - origin
            )
        )
    return (
        np.array([part.flexibility for part in parts]),
        np.array([part.sag for part in parts]),
        np.array([part.weight for part in parts]),
    )


def _clamped_displacements(
    nodes: Floats, flexibility: Floats, forces: Floats, free: Floats | None = None
) -> Floats:
    """Motion of every node, (n, 6, c), with the first one clamped and no other support.

    `forces` (n, 6, c) act at the nodes; `free` (n - 1, 6, c) is what each element's right end
    moves of itself.
    """
    carry = wrench_transport(along_x(np.diff(nodes)))
    inside = np.array(forces[1:], dtype=float)
    for e in range(len(carry) - 2, -1, -1):
        inside[e] += carry[e + 1] @ inside[e + 1]
    stretch = flexibility @ inside
    if free is not None:
        stretch += free
    motion = np.zeros_like(forces)
    for e in range(len(carry)):
        motion[e + 1] = carry[e].T @ motion[e] + stretch[e]
    return motion


def _held_directions(
    beam: Beam, node_of: NDArray[np.intp]
) -> tuple[Floats, Floats, NDArray[np.intp]]:
    """Directions that the supports hold (a, 6), their compliances (a,) and supports (a,)."""
    vectors, compliances, owner = [np.zeros((0, 6))], [np.zeros(0)], []
    rigid: dict[tuple[int, int], str] = {}
    for index, (support, node) in enumerate(zip(beam.supports, node_of, strict=True)):
        vector, compliance = support.directions
        for axis in np.argmax(vector[compliance == 0.0], axis=1):
            key = int(node), int(axis)
            if key in rigid:
                raise InputError(
                    f"supports '{rigid[key]}' and '{support.name}' are both rigid in "
                    f"{_AXES[axis]} at x = {support.x:g} m and their shares are indeterminate: "
                    "give at least one of them a finite stiffness."
                )
            rigid[key] = support.name
        vectors.append(vector)
        compliances.append(compliance)
        owner += [index] * len(compliance)
    return np.vstack(vectors), np.concatenate(compliances), np.array(owner, dtype=np.intp)


def _refuse_mechanism(grip: Floats, origin: float, length: float) -> None:
    """Raise an error that names each rigid-body motion which no support holds."""
    # Rotations measured by the travel of an arm as long as the beam, rows of unit size: how stiff
    # a support is must not decide whether it holds.
    scaled = grip / np.array([1.0, 1.0, 1.0, length, length, length])
    scaled = scaled / np.linalg.norm(scaled, axis=1, keepdims=True)

    def free_motions(columns: tuple[int, ...]) -> Floats:
        # Rows of zeros make the decomposition square for a beam with few supports.
        part = np.vstack([scaled[:, columns], np.zeros((len(columns), len(columns)))])
        _, value, vector = np.linalg.svd(part, full_matrices=False)
        return np.asarray(vector[value <= _FREE])

    total = len(free_motions((0, 1, 2, 3, 4, 5)))
    if total == 0:
        return
    found: list[str] = []
    counted = 0
    for columns, both in _MOTION_GROUPS:
        motions = free_motions(columns)
        counted += len(motions)
        if len(motions) == len(columns):
            found.append(both)
        elif len(motions) == 1:
            move, turn = motions[0][0], motions[0][1] / length
            axis = both.split(" and ")
            if abs(turn) * length <= _FREE**0.5:
                found.append(axis[0])
            else:
                sign = 1.0 if columns == (2, 4) else -1.0
                found.append(f"{axis[1]} at x = {origin + sign * move / turn:.6g} m")
    if counted < total:
        found.append("make a coupled motion of several directions")
    raise InputError(
        f"the beam is free to {' and to '.join(found)} because no support holds it: give a "
        "support a stiffness greater than 0 in that direction."
    )


def _solve_saddle(
    compliance: Floats, grip: Floats, gap: Floats, resultant: Floats, scale: Floats, beam: Beam
) -> tuple[Floats, Floats]:
    """Reactions (a, c) and rigid-body motions (6, c).

    ``compliance rho - grip q = gap`` (each support stays on its spring) and
    ``grip^T rho = resultant`` (equilibrium).
    """
    size = np.diag(compliance) + scale
    size = np.where(size > 0.0, size, size.max() if size.max() > 0.0 else 1.0)
    row = 1.0 / np.sqrt(size)
    held = row[:, None] * grip
    column = 1.0 / np.linalg.norm(held, axis=0)
    held = held * column
    n = len(row)
    matrix = np.zeros((n + 6, n + 6))
    matrix[:n, :n] = row[:, None] * compliance * row
    matrix[:n, n:] = -held
    matrix[n:, :n] = held.T
    if np.linalg.cond(matrix) > 1e14:
        # scale is what the shaft gives where the support stands, along the support's direction
        soft = float(
            np.max(np.diag(compliance) / np.where(scale > 0.0, scale, np.inf), initial=0.0)
        )
        if soft > _SOFT:
            raise InputError(
                f"a spring of the supports is {soft:.1g} times softer than the shaft, too soft to "
                "be distinguished from no support: remove it or make it stiffer."
            )
        names = ", ".join(f"'{support.name}'" for support in beam.supports)
        raise InputError(
            f"supports {names} are rigid and so is the shaft between them, and their shares "
            "are indeterminate: give a support or a section a finite stiffness."
        )
    right = np.vstack([row[:, None] * gap, column[:, None] * resultant])
    solved = np.linalg.solve(matrix, right)
    return row[:, None] * solved[:n], column[:, None] * solved[n:]


def _merged_stations(stations: Floats, length: float) -> Floats:
    ordered = np.sort(stations)
    keep = np.append(True, np.diff(ordered) > SAME_STATION * length)
    return np.asarray(ordered[keep])


def _nearest(nodes: Floats, stations: Floats) -> NDArray[np.intp]:
    return np.asarray(np.argmin(np.abs(nodes - stations[..., None]), axis=-1), dtype=np.intp)


def _support_index(names: tuple[str, ...], name: str) -> int:
    if name not in names:
        raise InputError(f"support '{name}' is not on the beam: choose one of {', '.join(names)}.")
    return names.index(name)


def _check_finite(what: str, values: Floats) -> None:
    if not np.isfinite(values).all():
        raise InputError(f"{what} hold a value that is not finite: remove NaN and infinity.")
