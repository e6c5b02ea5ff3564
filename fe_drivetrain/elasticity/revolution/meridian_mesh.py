"""Meshes of a shaft's meridian: elements of any order in the half plane of x and radius.

Quadrilaterals, each split again and again towards the sharp corners of the outline, where stress is
singular, or with fillets curved triangles too; isoparametric, all nodes of a fillet on its arc.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.threads import one_blas_thread
from fe_drivetrain.elasticity.mesh.shaft_section import shaft_quadrilaterals
from fe_drivetrain.elasticity.revolution.lagrange import Element, lagrange_element
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Shaft
from fe_drivetrain.geometry.meridian import MAX_ORDER, meridian_triangles, outline
from fe_drivetrain.geometry.shaft import Segment

Where = Callable[[Floats, Floats], NDArray[np.bool_]]
"""Function from x and radius [m], any shape, to whether a place is meant."""

MAX_QUADRILATERAL_ORDER = 12

Place = tuple[float, float]


@dataclass(frozen=True)
class Meridian:
    """A mesh of the half plane of x and radius.

    Attributes
    ----------
    nodes : Floats
        Nodes (n, 2), x and radius [m].
    cells : Ints
        Node ids (ne, m), in the order of the element's places.
    element : Element
        The element.
    """

    nodes: Floats
    cells: Ints
    element: Element

    __repr__ = short_repr

    def where(self, here: Where) -> Ints:
        """Nodes at the places meant, ascending."""
        return np.flatnonzero(here(*self.nodes.T))

    @cached_property
    def boundary(self) -> Ints:
        """(k, 2) cell and side of every side that belongs to one cell only."""
        k = self.element.corners
        ends = np.stack([self.cells[:, :k], np.roll(self.cells[:, :k], -1, axis=1)], axis=-1)
        low, high = np.sort(ends.reshape(-1, 2), axis=1).T
        keys = low * len(self.nodes) + high
        _, first, count = np.unique(keys, return_index=True, return_counts=True)
        return np.column_stack(np.divmod(np.sort(first[count == 1]), k))

    @cached_property
    def grams(self) -> Floats:
        """Integrals (ne, 3 m, 3 m) of products of a = N,x, b = N,r and c = N / r, per radian.

        They are all that any harmonic and any material needs.
        """
        element = self.element
        nodes = self.nodes[self.cells]
        m = nodes.shape[1]
        J = (element.gradients.reshape(-1, m) @ nodes).reshape(len(nodes), -1, 2, 2)
        (xs, rs), (xt, rt) = np.moveaxis(J, (2, 3), (0, 1))
        determinant = xs * rt - rs * xt
        r = nodes[..., 1] @ element.values.T
        weight = np.sqrt(determinant * element.weights * r)
        along, across = element.gradients[:, 0], element.gradients[:, 1]
        share = (weight / determinant)[..., None]
        G = np.empty((*weight.shape, 3 * m))
        G[..., :m] = (share * rt[..., None]) * along - (share * rs[..., None]) * across
        G[..., m : 2 * m] = (share * xs[..., None]) * across - (share * xt[..., None]) * along
        G[..., 2 * m :] = (weight / r)[..., None] * element.values
        with one_blas_thread():  # many small products
            return np.asarray(G.transpose(0, 2, 1) @ G)

    def sides(self, here: Where) -> Ints:
        """(k, 2) cell and side of the boundary's sides whose both ends and middle are meant."""
        sides = self.boundary
        inside = np.ones(len(sides), dtype=bool)
        for side in range(self.element.corners):
            of = sides[:, 1] == side
            values, _ = self.element.at(self.element.side_places(side, np.array([0.0, 0.5, 1.0])))
            at = np.einsum("qm,emi->eqi", values, self.nodes[self.cells[sides[of, 0]]])
            inside[of] = here(at[..., 0], at[..., 1]).all(axis=1)
        return np.asarray(sides[inside])


def meridian(
    shaft: Shaft,
    size: float | None = None,
    *,
    order: int | None = None,
    layers: int = 4,
    per_fillet: int = 6,
    corners: Sequence[Place] = (),
) -> Meridian:
    """Mesh the meridian of a shaft.

    Parameters
    ----------
    shaft : Shaft
        Shaft of any kind: solid or bored, stepped, tapered, with a flange or fillets or without.
    size : float or None
        Maximum edge length [m]; a third of the maximum diameter where not given.
    order : int or None
        Order of the elements: 2 to 12 of quadrilaterals, 2 to 6 of triangles; 6 and 4 where not
        given.
    layers : int
        Number of layers of ever smaller elements, each at 0.15 of the one before, at every
        re-entrant corner of the outline and at the corners of its ends.
    per_fillet : int
        Number of elements along each fillet: triangles, but for 2, which are quadrilaterals where
        they can be had, at fillets that are smaller than the elements; few, and enough for
        stiffness.
    corners : Sequence[Place]
        Places x and radius [m] of more points on the outline, at corners of the sections, towards
        which elements are graded: ends of a seat. Triangles are not.

    Raises
    ------
    InputError
        A setting is out of its range.
    """
    widest = max(max(p.outer_diameter, p.end_diameter) for p in shaft.pieces)
    size = widest / 3 if size is None else size
    _check_settings((("size", size, 0 < size < math.inf, "greater than 0"),))
    filleted = any(piece.fillet > 0 for piece in shaft.pieces)
    plan = None
    if not filleted or per_fillet == 2:
        plan = _quadrilaterals(shaft, size, layers, corners)
    highest = MAX_ORDER if plan is None else MAX_QUADRILATERAL_ORDER
    order = (4 if plan is None else 6) if order is None else order
    _check_settings(
        (
            ("order", order, 2 <= order <= highest, f"between 2 and {highest}"),
            ("layers", layers, 0 <= layers <= 40, "between 0 and 40"),
        )
    )
    if plan is not None:
        return _raised(plan, order)
    thinnest = min(
        (min(p.outer_diameter, p.end_diameter) - p.inner_diameter) / 2 for p in shaft.pieces
    )
    corner = min(size, thinnest / 2) * RATIO ** min(layers, 4)
    nodes, cells, places = meridian_triangles(shaft, size, order, per_fillet, corner)
    return _checked(Meridian(_on_axis(nodes), cells, lagrange_element(3, order, places.tobytes())))


def _check_settings(settings: Sequence[tuple[str, float, bool, str]]) -> None:
    for name, value, right, allowed in settings:
        if not right:
            raise InputError(f"meridian: {name} is {value:g} but must be {allowed}: change it")


@dataclass(frozen=True)
class _Plan:
    """Quadrilaterals with straight sides, but for those on arcs.

    Attributes
    ----------
    nodes, cells : Floats, Ints
        Nodes (n, 2) and cells (ne, 4), anticlockwise.
    arcs : tuple[tuple[int, int, Place], ...]
        Two nodes of each curved side, and the centre of its arc.
    """

    nodes: Floats
    cells: Ints
    arcs: tuple[tuple[int, int, Place], ...]


def _quadrilaterals(
    shaft: Shaft, size: float, layers: int, corners: Sequence[Place]
) -> _Plan | None:
    """Quadrilaterals of the outline, graded to its corners; None where a fillet does not fit."""
    sharp = _sharp(shaft)
    nodes, quads = shaft_quadrilaterals(sharp, size)
    used, local = np.unique(quads[:, ::2, ::2][:, [0, 1, 1, 0], [0, 0, 1, 1]], return_inverse=True)
    mesh = _Quads([(x, r) for x, r in nodes[used].tolist()], local.reshape(-1, 4).tolist())
    arcs = [arc for arc in outline(shaft) if arc.centre is not None]
    feet = [_foot(arc) for arc in arcs]
    graded = [(x, r) for x, r in _sharp_corners(sharp).tolist()]
    graded = [c for c in graded if all(math.dist(c, foot) > LENGTH_TOLERANCE for foot in feet)]
    graded += [c for c in corners if all(math.dist(c, s) > LENGTH_TOLERANCE for s in graded)]
    curved: list[tuple[int, int, Place]] = []
    for arc, foot in zip(arcs, feet, strict=True):
        added = mesh.round_off(foot, arc)
        if added is None:
            return None
        curved += added
    for corner in graded:
        centre = mesh.nearest(corner)
        for _ in range(layers):
            mesh.split(centre, lambda _: RATIO)
    nodes, cells = _on_axis(np.array(mesh.at)), np.array(mesh.quads, dtype=np.int64)
    if curved and not _convex(nodes[cells]):
        return None
    return _Plan(nodes, cells, tuple(curved))


def _convex(corners: Floats) -> bool:
    """Whether each quadrilateral (ne, 4, 2) is: one beside a foot that moved may not be."""
    edges = np.roll(corners, -1, axis=1) - corners
    before = np.roll(edges, 1, axis=1)
    return bool((before[..., 0] * edges[..., 1] > before[..., 1] * edges[..., 0]).all())


def _sharp(shaft: Shaft) -> Shaft:
    """The shaft without its fillets."""
    plain = {"fillet": 0.0}
    return shaft.model_copy(
        update={
            "sections": tuple(section.model_copy(update=plain) for section in shaft.sections),
            "flange": shaft.flange and shaft.flange.model_copy(update=plain),
        }
    )


def _foot(arc: Segment) -> Place:
    """Meeting point of the step's face and the thinner surface, equally far from both ends."""
    on_thin, (x, high) = sorted((arc.start, arc.end), key=lambda place: place[1])
    along, down = on_thin[0] - x, high - on_thin[1]
    return x, high - (along**2 + down**2) / (2.0 * down)


RATIO = 0.15
"""Size of an element at a sharp corner over that of the one that it was split from."""


def _sharp_corners(shaft: Shaft) -> Floats:
    """(k, 2) corners where stress is singular: re-entrant ones, and those of the rigid ends."""
    at = np.array([segment.start for segment in outline(shaft)])
    before, after = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    bend = cross / (np.hypot(*before.T) * np.hypot(*after.T))
    end = np.abs(at[:, :1] - [shaft.front, shaft.rear]).min(axis=1) < LENGTH_TOLERANCE
    return np.asarray(at[(at[:, 1] > LENGTH_TOLERANCE) & ((bend < -1e-6) | (end & (bend > 1e-6)))])


class _Quads:
    """Quadrilaterals as they are split."""

    def __init__(self, at: list[Place], quads: list[list[int]]) -> None:
        self.at = at
        self._at_first = np.array(at)
        self._quads: dict[int, list[int]] = {}  # by number, in the order in which they were made
        self._around: dict[int, list[int]] = defaultdict(list)  # numbers of those at each node
        self._made = 0
        self._add(quads)

    @property
    def quads(self) -> list[list[int]]:
        """Those that there are, in the order in which they were made."""
        return list(self._quads.values())

    def _add(self, quads: Iterable[list[int]]) -> None:
        for quad in quads:
            self._quads[self._made] = quad
            for node in quad:
                self._around[node].append(self._made)
            self._made += 1

    def at_node(self, node: int) -> list[list[int]]:
        """The quadrilaterals at a node."""
        return [self._quads[k] for k in self._around[node]]

    def nearest(self, place: Place) -> int:
        """The node there, of those that stood before the first split."""
        return int(np.hypot(*(self._at_first - place).T).argmin())

    def split(self, centre: int, share: Callable[[int], float]) -> dict[int, int]:
        """Split each quadrilateral at a node into a small one there and two around it.

        Parameters
        ----------
        centre : int
            The node.
        share : callable
            Share of the edge from it to another node at which to split it. No other edge is split,
            so that neighbours still match.

        Returns
        -------
        The new node on the edge to each.
        """
        fan = self.at_node(centre)
        for number in list(self._around[centre]):
            for node in self._quads.pop(number):
                self._around[node].remove(number)
        on_edge: dict[int, int] = {}
        for quad in fan:
            k = quad.index(centre)
            _, b, c, d = quad[k:] + quad[:k]
            for end in (b, d):
                if end not in on_edge:
                    on_edge[end] = len(self.at)
                    self.at.append(_towards(self.at[centre], self.at[end], share(end)))
            middle = len(self.at)
            self.at.append(_inside([self.at[i] for i in (centre, b, c, d)], share(b), share(d)))
            self._add(
                (
                    [centre, on_edge[b], middle, on_edge[d]],
                    [on_edge[b], b, c, middle],
                    [middle, c, d, on_edge[d]],
                )
            )
        return on_edge

    def round_off(self, foot: Place, arc: Segment) -> list[tuple[int, int, Place]] | None:
        """Move the node at a step's foot onto its fillet; None where the fillet does not fit.

        Returns the two curved sides that meet there.
        """
        if arc.centre is None:
            return None
        centre = self.nearest(foot)
        reach = math.dist(foot, arc.start)
        lengths = {
            end: math.dist(foot, self.at[end])
            for quad in self.at_node(centre)
            for end in (quad[quad.index(centre) - 1], quad[(quad.index(centre) + 1) % 4])
        }
        # the two edges that the arc's ends lie on
        on = [
            end
            for tip in (arc.start, arc.end)
            for end, length in lengths.items()
            if math.dist(_towards(foot, self.at[end], reach / length), tip) < LENGTH_TOLERANCE
        ]
        if len(on) != 2 or reach > _ROOM * min(lengths[end] for end in on):
            return None
        if reach < RATIO * _ROOM * min(lengths[end] for end in on):
            # a small fillet in large elements: towards it as towards a corner
            self.split(centre, lambda _: RATIO)
            return self.round_off(foot, arc)
        on_edge = self.split(
            centre,
            lambda end: reach / lengths[end] if end in on else min(0.5, reach / lengths[end]),
        )
        tips = [on_edge[end] for end in on]
        x, r = (0.5 * (a + b) for a, b in zip(arc.start, arc.end, strict=True))
        radius, gap = math.dist(arc.start, arc.centre), math.dist((x, r), arc.centre)
        self.at[centre] = _towards(arc.centre, (x, r), radius / gap)
        return [(tip, centre, arc.centre) for tip in tips]


_ROOM = 0.9
"""Maximum share of an edge that a fillet may take."""


def _towards(a: Place, b: Place, share: float) -> Place:
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])


def _inside(corners: Sequence[Place], s: float, t: float) -> Place:
    """The bilinear place of a quadrilateral at shares of both edges from its first corner."""
    weights = ((1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t)
    x, r = (sum(w * at[i] for w, at in zip(weights, corners, strict=True)) for i in (0, 1))
    return x, r


def _on_axis(nodes: Floats) -> Floats:
    nodes = nodes.copy()
    nodes[np.abs(nodes[:, 1]) < LENGTH_TOLERANCE, 1] = 0.0
    return nodes


def _raised(plan: _Plan, order: int) -> Meridian:
    """Nodes of higher order on quadrilaterals, numbered by neighbours in the same way."""
    nodes, quads = plan.nodes, plan.cells
    element = lagrange_element(4, order)
    inner = order - 1
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    ordered = np.sort(ends, axis=1)
    _, edge = np.unique(ordered[:, 0] * len(nodes) + ordered[:, 1], return_inverse=True)
    along = np.arange(inner)
    on_edge = len(nodes) + edge.reshape(-1, 1) * inner + along
    backwards = ends[:, 0] > ends[:, 1]
    on_edge[backwards] = on_edge[backwards, ::-1]
    first = len(nodes) + (edge.max() + 1) * inner
    inside = first + np.arange(len(quads) * inner**2).reshape(len(quads), -1)
    cells = np.hstack([quads, on_edge.reshape(len(quads), -1), inside])
    s, t = element.places.T
    bilinear = np.column_stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
    places = np.empty((first + inside.size, 2))
    places[cells] = np.einsum("mk,eki->emi", bilinear, nodes[quads])
    places[: len(nodes)] = nodes
    for a, b, middle in plan.arcs:
        (cell,) = np.flatnonzero((quads == a).any(axis=1) & (quads == b).any(axis=1))
        corner = quads[cell].tolist()
        side = next(k for k in range(4) if {corner[k], corner[(k + 1) % 4]} == {a, b})
        along, away = ((s, t), (t, 1 - s), (1 - s, 1 - t), (1 - t, s))[side]
        first, last = nodes[corner[side]], nodes[corner[(side + 1) % 4]]
        bulge = _on_arc(first, last, middle, along) - np.outer(1 - along, first)
        places[cells[cell]] += (1 - away)[:, None] * (bulge - np.outer(along, last))
    return _checked(Meridian(places, cells, element))


def _on_arc(first: Floats, last: Floats, centre: Place, along: Floats) -> Floats:
    """(m, 2) places on an arc below half a turn, at shares of its angle."""
    (x0, r0), (x1, r1) = first - centre, last - centre
    turned = math.atan2(x0 * r1 - r0 * x1, x0 * x1 + r0 * r1)
    angle = math.atan2(r0, x0) + turned * along
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    return np.asarray(centre + math.hypot(x0, r0) * circle)


def _checked(mesh: Meridian) -> Meridian:
    """The mesh, none of whose elements is inside out."""
    gradients = mesh.element.gradients
    J = gradients.reshape(-1, gradients.shape[2]) @ mesh.nodes[mesh.cells]
    (xs, rs), (xt, rt) = np.moveaxis(J.reshape(len(mesh.cells), -1, 2, 2), (2, 3), (0, 1))
    if (xs * rt <= rs * xt).any():
        raise InputError(
            "meridian: an element folds over: give a smaller size, or more elements per fillet"
        )
    return mesh
