"""The mesh in a deck of Abaqus or CalculiX (.inp): nodes, elements, sets, surfaces, instances.

What is said of nodes and elements anywhere in the file is taken together. What would change the
mesh and is not read here (other files, generated nodes, other coordinates) is refused by its name.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.regular_files import text_of
from fe_drivetrain.foreign.abaqus_cards import Card, cards, fields, integer, real
from fe_drivetrain.foreign.abaqus_sets import Entry, Scope, Sets, Side, flattened
from fe_drivetrain.foreign.raw_mesh import RawMesh

#: Kinds of elements by their types: solids, faces of them, and what a housing is not made of.
_KINDS = (
    ("tetra", 4, r"DC3D4|C3D4[A-Z]*"),
    ("tetra10", 10, r"DC3D10|C3D10[A-Z]*"),
    ("triangle", 3, r"S3[A-Z]*|STRI3|CP[SE]3[A-Z]*|M3D3|SFM3D3|R3D3|DS3|DC2D3|CAX3[A-Z]*"),
    ("triangle6", 6, r"S6|STRI65|CP[SE]6[A-Z]*|M3D6|SFM3D6|DS6|DC2D6|CAX6[A-Z]*"),
)
_LEFT_OUT = re.compile(
    r"MASS|ROTARYI|HEATCAP|(SPRING|DASHPOT|CONN|JOINT|GAP|DCOUP|T[23]D|B[23][123]|PIPE|RB?[23]D2"
    r"|D(C1D)[23]|DIST).*"
)
_REFUSED = {
    "NGEN": "generates nodes",
    "NFILL": "generates nodes",
    "NCOPY": "copies nodes",
    "NMAP": "moves nodes",
    "ELGEN": "generates elements",
    "ELCOPY": "copies elements",
    "SYSTEM": "gives nodes in other coordinates",
    "SUBSTRUCTURE PATH": "takes a part from another file",
}


def read_deck(path: str) -> RawMesh:
    """Read the mesh of a deck.

    Parameters
    ----------
    path : str
        File ending in .inp.

    Raises
    ------
    InputError
        The deck takes its mesh from elsewhere, or a line of it is wrong; the message names it.
    """
    name = Path(path).name
    deck = _Deck(name)
    # headings may be in any encoding; what is read of the rest is plain ASCII
    for card in cards(text_of(path, encoding="latin-1")):
        deck.take(card)
    return deck.mesh()


class _Deck:
    """What was read so far; `scope` is the part or instance that a card belongs to."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.root = self.scope = Scope("")
        self.parts: dict[str, Scope] = {}
        self.instances: dict[str, Scope] = {}
        self.left_out: dict[str, int] = {}
        self.takes: dict[str, Callable[[Card], None]] = {
            "NODE": self._nodes,
            "ELEMENT": self._elements,
            "NSET": lambda card: self._set(card, "NSET", self.scope.node_sets),
            "ELSET": lambda card: self._set(card, "ELSET", self.scope.cell_sets),
            "SURFACE": self._surface,
            "PART": self._part,
            "END PART": self._end,
            "INSTANCE": self._instance,
            "END INSTANCE": self._end,
        }

    def take(self, card: Card) -> None:
        """Read one card, if it says anything about the mesh."""
        self._refuse_elsewhere(card)
        if card.keyword in self.takes:
            self.takes[card.keyword](card)

    def mesh(self) -> RawMesh:
        """All that was read, with nodes by rows."""
        if self.parts and not self.instances:
            raise InputError(
                f"{self.name} has parts but no *INSTANCE that places them: write the assembly"
            )
        scopes = [self.root, *self.instances.values()]
        found = flattened(self.name, scopes)
        found.left_out = self.left_out
        return found

    def where(self, line: int) -> str:
        """A place in the file, for messages."""
        return f"{self.name}, line {line}"

    def _refuse_elsewhere(self, card: Card) -> None:
        """Refuse what takes a part of the mesh from another file, or makes it otherwise."""
        word, where = card.keyword, self.where(card.line)
        if word == "INCLUDE" or ("INPUT" in card.parameters and word in self.takes):
            raise InputError(
                f"{where}: *{word} takes {card.parameters.get('INPUT') or 'another file'!r}: "
                "write the whole mesh into one file"
            )
        if word in _REFUSED:
            raise InputError(
                f"{where}: *{word} {_REFUSED[word]}, which is not read: write every node and "
                "element by itself"
            )

    def _nodes(self, card: Card) -> None:
        system = card.parameters.get("SYSTEM", "R").upper()
        if system != "R":
            raise InputError(
                f"{self.where(card.line)}: *NODE, SYSTEM={system} gives other coordinates than "
                "x, y and z: write these"
            )
        numbers, places = [], []
        for line, text in card.data:
            where, row = self.where(line), fields(text)
            numbers.append(integer(row[0], where))
            places.append([real(cell, where) for cell in (*row[1:4], "", "", "")[:3]])
        lines = [line for line, _ in card.data]
        self.scope.nodes.append((np.array(numbers, int), np.reshape(places, (-1, 3)), lines))
        if label := card.parameters.get("NSET"):
            self.scope.node_sets.add(label, Entry(tuple(numbers), line=card.line))

    def _elements(self, card: Card) -> None:
        kind = card.parameters.get("TYPE", "").upper()
        found = next(((k, n) for k, n, types in _KINDS if re.fullmatch(types, kind)), None)
        if found is None:
            self._other_elements(card, kind)
            return
        numbers = self._table(card, kind, found[1] + 1)
        self.scope.elements.append((found[0], numbers[:, 0], numbers[:, 1:], card.line))
        if label := card.parameters.get("ELSET"):
            self.scope.cell_sets.add(label, Entry(tuple(numbers[:, 0].tolist()), line=card.line))

    def _other_elements(self, card: Card, kind: str) -> None:
        """Leave out masses, springs and edges; anything else is part of no housing."""
        if not _LEFT_OUT.fullmatch(kind):
            raise InputError(
                f"{self.where(card.line)}: elements of kind {kind or 'none'} are no tetrahedra of "
                "4 or 10 nodes (C3D4, C3D10), nor faces or edges of them: mesh the part so"
            )
        self.left_out[kind] = self.left_out.get(kind, 0) + len(card.data)
        if label := card.parameters.get("ELSET"):
            self.scope.cell_sets.add(label, Entry(line=card.line))

    def _table(self, card: Card, kind: str, width: int) -> Any:
        """Numbers (k, width) of elements; each begins on a line of its own, and may go on."""
        flat: list[int] = []
        for line, text in card.data:
            where = self.where(line)
            row = [integer(cell, where) for cell in fields(text)]
            if len(flat) % width + len(row) > width:
                raise InputError(
                    f"{where}: an element of type {kind} has more numbers than its own and those "
                    f"of {width - 1} nodes: correct it"
                )
            flat += row
        if len(flat) % width:
            raise InputError(
                f"{self.where(card.data[-1][0])}: an element of type {kind} has {len(flat) % width}"
                f" numbers, but must have its own and those of {width - 1} nodes: write it whole"
            )
        return np.array(flat, int).reshape(-1, width)

    def _set(self, card: Card, key: str, sets: Sets) -> None:
        label = card.parameters.get(key)
        if not label:
            raise InputError(f"{self.where(card.line)}: *{key} has no name: add {key}=NAME")
        entry = Entry(instance=self._instance_of(card), line=card.line)
        if key == "NSET" and (source := card.parameters.get("ELSET")):
            sets.add(label, entry._replace(elements=source))
        elif "GENERATE" in card.parameters:
            for line, text in card.data:
                sets.add(label, entry._replace(span=self._range(line, text), line=line))
        else:
            members = [
                self._member(cell, line)
                for line, text in card.data
                for cell in fields(text)
                if cell
            ]
            sets.add(label, entry._replace(members=tuple(members)))

    def _member(self, cell: str, line: int) -> int | str:
        """A number, or the name of a set."""
        member = cell.strip("\"'").strip()
        if re.match(r"[-+.\d]", member):
            return integer(member, self.where(line))
        return member

    def _range(self, line: int, text: str) -> tuple[int, int, int]:
        row = [integer(cell, self.where(line)) for cell in fields(text) if cell]
        if not 2 <= len(row) <= 3 or row[1] < row[0] or (len(row) == 3 and row[2] < 1):
            raise InputError(
                f"{self.where(line)}: a generated set has the line {text[:60]!r} but must have its "
                "first number, its last and a step of at least 1: correct it"
            )
        return row[0], row[1], row[2] if len(row) == 3 else 1

    def _instance_of(self, card: Card) -> str:
        """Instance whose numbers a set has, in capitals; empty of the open scope."""
        name = card.parameters.get("INSTANCE", "")
        if name and name.upper() not in self.instances:
            raise InputError(
                f"{self.where(card.line)}: *{card.keyword} is of the instance {name!r}, which there"
                f" is not: use one of {', '.join(self.instances) or 'none'}"
            )
        return name.upper()

    def _surface(self, card: Card) -> None:
        label = card.parameters.get("NAME")
        if not label:
            return
        of_nodes = card.parameters.get("TYPE", "ELEMENT").upper() == "NODE"
        for line, text in card.data:
            row = [*fields(text), ""]
            if of_nodes:
                self.scope.node_sets.add(label, Entry((self._member(row[0], line),), line=line))
            elif re.fullmatch(r"S[1-4]", row[1].upper()):
                side = int(row[1][1]) - 1
                self.scope.surfaces.append(Side(label, self._member(row[0], line), side, line))

    def _part(self, card: Card) -> None:
        name = card.parameters.get("NAME", "")
        self.scope = self.parts[name.upper()] = Scope(name)

    def _instance(self, card: Card) -> None:
        """Place a part: shifted, then turned about an axis through two points [degrees]."""
        name, part = card.parameters.get("NAME", ""), card.parameters.get("PART", "")
        source = self.parts.get(part.upper())
        if source is None:
            raise InputError(
                f"{self.where(card.line)}: the instance {name!r} is of the part {part!r}, which "
                f"there is not: use one of {', '.join(self.parts) or 'none'}"
            )
        numbers = [
            [real(cell, self.where(line)) for cell in fields(text)] for line, text in card.data
        ]
        shift = (*(numbers[0] if numbers else ()), 0.0, 0.0, 0.0)[:3]
        turn = numbers[1] if len(numbers) > 1 else []
        if turn and len(turn) != 7:
            raise InputError(
                f"{self.where(card.data[1][0])}: an instance is turned by {len(turn)} numbers but "
                "must be by 7, two points of an axis and degrees: correct it"
            )
        self.scope = self.instances[name.upper()] = source.placed(
            name, lambda points: _turned(points + np.array(shift), turn)
        )

    def _end(self, card: Card) -> None:
        self.scope = self.root


def _turned(points: Any, turn: list[float]) -> Any:
    """Points (n, 3) turned about the axis from a to b by degrees (right-handed, Rodrigues)."""
    if not turn:
        return points
    start, along = np.array(turn[:3]), np.array(turn[3:6]) - np.array(turn[:3])
    length = float(np.linalg.norm(along))
    if not length > 0.0:
        return points
    axis, angle = along / length, math.radians(turn[6])
    arm = points - start
    across = np.cross(axis, arm)
    lengthwise = (arm @ axis)[:, None] * axis
    turned = math.cos(angle) * (arm - lengthwise) + math.sin(angle) * across + lengthwise
    return start + turned
