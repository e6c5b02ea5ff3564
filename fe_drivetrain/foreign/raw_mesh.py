"""What a reader finds in a mesh file, before it is judged: nodes, blocks of elements, sets."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass
class RawMesh:
    """Contents of a mesh file as it has them; all numbers of nodes are rows of `points`.

    Attributes
    ----------
    points : ndarray, (n, 3)
        Positions of the nodes, in the file's unit.
    blocks : list of tuple
        Kind of element, as in "tetra10" or "triangle", and nodes (k, m) in VTK's order.
    cell_sets : dict
        Members of each labelled set of elements by block: {label: {block: rows}}.
    node_sets : dict
        Nodes of each labelled set.
    faces : dict
        Corners (k, 3) of each labelled surface that is no set of elements.
    left_out : dict
        How many elements of each kind are of no use to a housing: masses, springs, edges.
    """

    points: Any
    blocks: list[tuple[str, Any]]
    cell_sets: dict[str, dict[int, Any]] = field(default_factory=dict)
    node_sets: dict[str, Any] = field(default_factory=dict)
    faces: dict[str, Any] = field(default_factory=dict)
    left_out: dict[str, int] = field(default_factory=dict)
