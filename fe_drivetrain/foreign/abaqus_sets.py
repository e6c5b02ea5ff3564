"""Nodes, elements and sets of a deck put together: numbers of the file become rows of arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign.raw_mesh import RawMesh

#: Corners of the faces S1 to S4 of a tetrahedron (Abaqus Analysis User's Manual, 28.1.4).
_SIDES = np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])


class Entry(NamedTuple):
    """Some members of a set: numbers, names of other sets, a range, or nodes of elements.

    Attributes
    ----------
    members : tuple of int or str
        Numbers of nodes or elements, and names of sets.
    span : tuple or None
        First number, last number and step.
    elements : str
        Name of a set of elements whose nodes are meant.
    instance : str
        Name of the instance whose numbers they are, in capitals; empty of the set's own scope.
    line : int
        Where it stands.
    """

    members: tuple[int | str, ...] = ()
    span: tuple[int, int, int] | None = None
    elements: str = ""
    instance: str = ""
    line: int = 0


@dataclass
class Sets:
    """Sets by names in capitals, with each name as it was first written."""

    labels: dict[str, str] = field(default_factory=dict)
    entries: dict[str, list[Entry]] = field(default_factory=dict)

    def add(self, label: str, entry: Entry) -> None:
        """Add members to a set, which need not be there yet."""
        self.labels.setdefault(label.upper(), label)
        self.entries.setdefault(label.upper(), []).append(entry)


class Side(NamedTuple):
    """Faces of a surface: one side of an element, or of each of a set."""

    label: str
    of: int | str
    side: int
    line: int


@dataclass
class Scope:
    """The deck itself, a part of it, or an instance of a part: it has numbers of its own.

    Attributes
    ----------
    name : str
        Name of the part or instance; empty of the deck.
    nodes : list of tuple
        Numbers (n,), positions (n, 3) and lines (n,) of each section.
    elements : list of tuple
        Kind, numbers (k,), numbers of nodes (k, m) and line of each section.
    node_sets, cell_sets : Sets
        Sets of nodes and of elements.
    surfaces : list of Side
        Surfaces of elements.
    """

    name: str
    nodes: list[tuple[Any, Any, Any]] = field(default_factory=list)
    elements: list[tuple[str, Any, Any, int]] = field(default_factory=list)
    node_sets: Sets = field(default_factory=Sets)
    cell_sets: Sets = field(default_factory=Sets)
    surfaces: list[Side] = field(default_factory=list)

    def placed(self, name: str, move: Callable[[Any], Any]) -> Scope:
        """An instance of this part, whose nodes are moved; it may get more of all."""
        return replace(
            self,
            name=name,
            nodes=[(numbers, move(points), lines) for numbers, points, lines in self.nodes],
            elements=list(self.elements),
            node_sets=_copied(self.node_sets),
            cell_sets=_copied(self.cell_sets),
            surfaces=list(self.surfaces),
        )


def _copied(sets: Sets) -> Sets:
    return Sets(dict(sets.labels), {key: list(rows) for key, rows in sets.entries.items()})


class _Numbered:
    """Rows of all nodes, or of all elements, by scope and number.

    Parameters
    ----------
    found : dict
        Numbers, ascending, and their rows by the name of the scope in capitals.
    """

    def __init__(self, found: dict[str, tuple[Any, Any]]) -> None:
        self._rows = found

    def of(self, scope: str, numbers: Iterable[int]) -> Any:
        """Rows of those numbers that there are."""
        known, rows = self._rows[scope]
        wanted = np.unique(np.fromiter(numbers, dtype=np.int64))
        at = np.minimum(np.searchsorted(known, wanted), max(len(known) - 1, 0))
        return rows[at[known[at] == wanted]] if len(known) else rows

    def within(self, scope: str, span: tuple[int, int, int]) -> Any:
        """Rows of all numbers of a range that there are."""
        known, rows = self._rows[scope]
        first, last, step = span
        return rows[(known >= first) & (known <= last) & ((known - first) % step == 0)]


def flattened(name: str, scopes: list[Scope]) -> RawMesh:
    """The mesh of a deck, its nodes and elements numbered through.

    Parameters
    ----------
    name : str
        Name of the file, for messages.
    scopes : list of Scope
        The deck itself, and its instances.

    Raises
    ------
    InputError
        A number is given to two nodes or elements, an element has a node that there is not, or a
        set contains one that there is not.
    """
    return _Flat(name, scopes).mesh()


class _Flat:
    def __init__(self, name: str, scopes: list[Scope]) -> None:
        self.name = name
        self.scopes = {scope.name.upper(): scope for scope in scopes}
        self.several = len(scopes) > 2
        self.points: list[Any] = []
        self.blocks: dict[str, list[Any]] = {}
        nodes, cells = {}, {}
        for key, scope in self.scopes.items():
            nodes[key] = self._nodes(scope)
            cells[key] = self._cells(scope, nodes[key])
        self.nodes, self.cells = _Numbered(nodes), _Numbered(cells)

    def mesh(self) -> RawMesh:
        """All blocks, sets and surfaces."""
        found = RawMesh(
            np.concatenate(self.points) if self.points else np.zeros((0, 3)),
            [(kind, np.concatenate(rows)) for kind, rows in self.blocks.items()],
        )
        for key, scope in self.scopes.items():
            for label, own in self._labels(scope, scope.node_sets):
                found.node_sets[label] = self._members(key, own, False, ())
            for label, own in self._labels(scope, scope.cell_sets):
                rows = self._members(key, own, True, ())
                found.cell_sets[label] = {
                    k: rows[rows[:, 0] == k, 1] for k in np.unique(rows[:, 0])
                }
        self._surfaces(found)
        return found

    def _labels(self, scope: Scope, sets: Sets) -> Iterator[tuple[str, str]]:
        """Labels and keys of sets; of several instances each bears the name of its own."""
        for key, label in sets.labels.items():
            yield self._label(scope, label), key

    def _label(self, scope: Scope, label: str) -> str:
        return f"{scope.name}.{label}" if scope.name and self.several else label

    def _nodes(self, scope: Scope) -> tuple[Any, Any]:
        """Numbers of a scope's nodes, ascending, and their rows."""
        if not scope.nodes:
            return np.zeros(0, np.int64), np.zeros(0, np.int64)
        numbers = np.concatenate([section[0] for section in scope.nodes])
        points = np.concatenate([section[1] for section in scope.nodes])
        lines = np.concatenate([section[2] for section in scope.nodes])
        known, first, which = np.unique(numbers, return_index=True, return_inverse=True)
        other = np.flatnonzero((points != points[first[which]]).any(axis=1))
        if len(other):
            k = int(other[0])
            raise InputError(
                f"{self.name}, line {lines[k]}: node {numbers[k]} is at {_place(points[k])}, but in"
                f" line {lines[first[which[k]]]} at {_place(points[first[which[k]]])}: give each "
                "node its own number"
            )
        start = sum(map(len, self.points))
        self.points.append(points[first])
        return known, start + np.arange(len(known))

    def _cells(self, scope: Scope, nodes: tuple[Any, Any]) -> tuple[Any, Any]:
        """Numbers of a scope's elements, ascending, and their (block, row)."""
        numbers, places, own, lines = [], [], [], []
        for kind, some, nodes_of, line in scope.elements:
            rows = self._rows_of_nodes(kind, some, nodes_of, line, nodes)
            blocks = self.blocks.setdefault(kind, [])
            start = sum(map(len, blocks))
            blocks.append(rows)
            block = np.full(len(some), list(self.blocks).index(kind))
            numbers.append(some)
            places.append(np.column_stack([block, start + np.arange(len(some))]))
            own.append(nodes_of)
            lines.append(np.full(len(some), line))
        if not numbers:
            return np.zeros(0, np.int64), np.zeros((0, 2), np.int64)
        every = np.concatenate(numbers)
        known, first, count = np.unique(every, return_index=True, return_counts=True)
        if (count > 1).any():
            k = int(np.flatnonzero(count > 1)[0])
            line = int(np.concatenate(lines)[every == known[k]][1])
            raise InputError(
                f"{self.name}, line {line}: element {known[k]} is there before: give each element "
                "its own number"
            )
        return known, np.concatenate(places)[first]

    def _rows_of_nodes(
        self, kind: str, numbers: Any, nodes_of: Any, line: int, nodes: tuple[Any, Any]
    ) -> Any:
        known, rows = nodes
        at = np.minimum(np.searchsorted(known, nodes_of), max(len(known) - 1, 0))
        lost = ~np.isin(nodes_of, known)
        if lost.any():
            row, column = np.argwhere(lost)[0]
            raise InputError(
                f"{self.name}: element {numbers[row]} of the section in line {line} has the node "
                f"{nodes_of[row, column]}, which there is not: add it"
            )
        return rows[at] if len(known) else np.zeros((0, nodes_of.shape[1]), np.int64)

    def _members(self, scope: str, key: str, cells: bool, within: tuple[str, ...]) -> Any:
        """Rows of a set, ascending: of nodes (n,), of elements (n, 2)."""
        all_of = self.cells if cells else self.nodes
        sets = self.scopes[scope].cell_sets if cells else self.scopes[scope].node_sets
        if key in within:
            raise InputError(
                f"{self.name}: the set {sets.labels[key]!r} contains itself: leave it out of its "
                "own members"
            )
        found = [np.zeros((0, 2) if cells else 0, np.int64)]
        for entry in sets.entries[key]:
            home = entry.instance or scope
            found.append(all_of.of(home, (m for m in entry.members if isinstance(m, int))))
            if entry.span is not None:
                found.append(all_of.within(home, entry.span))
            if entry.elements:
                found.append(self._nodes_of_cells(home, entry))
            for label in (m for m in entry.members if isinstance(m, str)):
                there, inner = self._named(home, scope, label, cells, entry.line)
                found.append(self._members(there, inner, cells, (*within, key)))
        return np.unique(np.concatenate(found), axis=0)

    def _named(self, home: str, scope: str, label: str, cells: bool, line: int) -> tuple[str, str]:
        """Scope and key of a set that another names, which may be that of an instance."""
        inner = label.upper()
        instance, _, rest = inner.partition(".")
        for place, key in ((home, inner), (scope, inner), (instance, rest)):
            if place in self.scopes:
                of = self.scopes[place]
                if key in (of.cell_sets if cells else of.node_sets).labels:
                    return place, key
        what = "elements" if cells else "nodes"
        raise InputError(
            f"{self.name}, line {line}: there is no set of {what} {label!r}, which another set "
            "contains: correct its name, or add it"
        )

    def _nodes_of_cells(self, home: str, entry: Entry) -> Any:
        place, key = self._named(home, home, entry.elements, True, entry.line)
        blocks = list(self.blocks.values())
        rows = self._members(place, key, True, ())
        return np.unique(
            np.concatenate(
                [np.zeros(0, np.int64)]
                + [
                    np.concatenate(blocks[k])[rows[rows[:, 0] == k, 1]].ravel()
                    for k in np.unique(rows[:, 0])
                ]
            )
        )

    def _surfaces(self, found: RawMesh) -> None:
        """Corners of surfaces that are sides of tetrahedra."""
        for key, scope in self.scopes.items():
            for label, of, side, line in scope.surfaces:
                if isinstance(of, int):
                    rows = self.cells.of(key, [of])
                else:
                    rows = self._members(*self._named(key, key, of, True, line), True, ())
                whole = self._label(scope, label)
                for k in np.unique(rows[:, 0]):
                    kind, nodes = found.blocks[k]
                    if kind.startswith("tetra"):
                        corners = nodes[rows[rows[:, 0] == k, 1]][:, _SIDES[side]]
                        before = found.faces.get(whole, np.zeros((0, 3), np.int64))
                        found.faces[whole] = np.concatenate([before, corners])


def _place(point: Any) -> str:
    return f"({', '.join(f'{x:.6g}' for x in point)})"
