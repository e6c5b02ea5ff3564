"""Shafts of a REXS model as rows of a drivetrain's file: from one stage to the next.

A file's shaft begins where the stage before stands and ends where the next one does; sections
beyond are left out, and of several shafts that turn together those of one material are taken, one
after the other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.rexs_layout import Groups, Stage
from fe_drivetrain.export.formats.rexs_model import Model, Part
from fe_drivetrain.export.formats.rexs_own import own_values
from fe_drivetrain.export.formats.rexs_places import Places

SLIVER = 1e-6
"""Length that is none [m]."""


class Piece(NamedTuple):
    """A length of shaft along x: from, to, outer diameters there, and bore [m]."""

    x0: float
    x1: float
    outer: float
    end: float
    inner: float


@dataclass(frozen=True)
class Row:
    """A shaft of a drivetrain's file, where it begins, and the sense in which it goes on.

    Attributes
    ----------
    data : dict
        Keys of the file.
    begin, sense : float
        x of its beginning [m], and 1 or -1.
    length : float or None
        Length [m], where it is known.
    parts : list of Part
        Shafts of which it is made.
    is_known : bool
        Whether the model gives its sections or its stiffness.
    """

    data: dict[str, Any]
    begin: float
    sense: float
    length: float | None
    parts: Sequence[Part]
    is_known: bool = True


def group_shafts(model: Model, groups: Groups) -> dict[str, list[Part]]:
    """Shafts that turn together, by group; planets' pins are none."""
    pins = {ends["shaft"].number for ends in model.related("planet_pin") if "shaft" in ends}
    found: dict[str, list[Part]] = {}
    for shaft in model.of_type("shaft"):
        if shaft.number not in pins:
            found.setdefault(groups.of(shaft), []).append(shaft)
    return found


def shaft_row(
    model: Model,
    places: Places,
    shafts: Sequence[Part],
    planes: tuple[float | None, float | None],
    notes: list[str],
) -> Row:
    """A shaft between two stages.

    Parameters
    ----------
    model, places : Model, Places
        The model, and where its components are.
    shafts : sequence of Part
        Shafts that turn together.
    planes : tuple
        x of the stage before and of that behind [m]; None of an end.
    notes : list of str
        Sentences on what is assumed are added to it.
    """
    pieces = {shaft.number: _pieces(model, places, shaft, notes) for shaft in shafts}
    own = next((values for s in shafts if (values := own_values(s))), {})
    known = [p for of_shaft in pieces.values() for p in of_shaft]
    low, high, sense = _range(known, planes, places, shafts)
    if not known or by_stiffness(own):
        return _without_sections(own, shafts, (low, high, sense), notes)
    chosen, used = _chosen(model, shafts, pieces, (low, high))
    if not used:
        return _without_sections(own, shafts, (low, high, sense), notes)
    for shaft in shafts:
        if shaft not in used and pieces[shaft.number]:
            notes.append(
                f"{shaft} turns with {used[0].name or used[0]}, and is taken for rigid with it: "
                "its sections and its mass are left out"
            )
    if sense < 0:
        chosen = [Piece(p.x1, p.x0, p.end, p.outer, p.inner) for p in reversed(chosen)]
    begin, end = chosen[0].x0, chosen[-1].x1
    data = _sized(chosen) | _material(model, used[0], notes) | own
    return Row(data, begin, sense, abs(end - begin), used)


def by_stiffness(own: Mapping[str, Any]) -> bool:
    """Whether values of our own are of a shaft that is known without its sections."""
    return "torsion" in own or own.get("kind") == "rigid"


def _range(
    known: Sequence[Piece],
    planes: tuple[float | None, float | None],
    places: Places,
    shafts: Sequence[Part],
) -> tuple[float, float, float]:
    """From where to where a shaft goes, and its sense along x."""
    before, behind = planes
    ends = [x for piece in known for x in (piece.x0, piece.x1)]
    if not ends:
        ends = [float(places.of(s)[0]) for s in shafts if s.has("support_vector")] or [0.0]
    if before is None and behind is None:
        return min(ends), max(ends), 1.0
    if before is None:
        upstream = behind is None or behind - min(ends) >= max(ends) - behind
        before, sense = (min(ends), 1.0) if upstream else (max(ends), -1.0)
        return min(before, behind or 0.0), max(before, behind or 0.0), sense
    if behind is None:
        downstream = max(ends) - before >= before - min(ends)
        behind, sense = (max(ends), 1.0) if downstream else (min(ends), -1.0)
    else:
        sense = 1.0 if behind >= before else -1.0
        if abs(behind - before) < SLIVER:
            raise InputError(
                f"{shafts[0]}: the gears that drive it and those that it drives are at the same "
                f"place along the axis, {before:g} m: correct their support_vector"
            )
    return min(before, behind), max(before, behind), sense


def _pieces(model: Model, places: Places, shaft: Part, notes: list[str]) -> list[Piece]:
    """Sections of a shaft along x, in the order of x."""
    sections = [
        ends["part"]
        for ends in model.related("assembly", assembly=shaft)
        if "part" in ends and ends["part"].type == "shaft_section"
    ]
    if not sections:
        return []
    origin, along = float(places.of(shaft)[0]), places.along(shaft)
    found, u = [], 0.0
    for section in sections:
        section.used = shaft.used = True
        start = section.number_of("u_coordinate_on_shaft", "length")
        u = u if start is None else start
        length = section.number_of("length", "length") or 0.0
        outer = _diameters(section, "outer")
        inner = _diameters(section, "inner", 0.0)
        if length <= SLIVER:
            continue
        if abs(inner[0] - inner[1]) > SLIVER:
            notes.append(f"{section} of {shaft}: its tapered bore is taken for one of its mean")
        piece = Piece(u, u + length, *outer, (inner[0] + inner[1]) / 2)
        if along < 0:
            piece = Piece(-piece.x1, -piece.x0, piece.end, piece.outer, piece.inner)
        found.append(piece._replace(x0=origin + piece.x0, x1=origin + piece.x1))
        u += length
    return sorted(found)


def _diameters(section: Part, which: str, default: float | None = None) -> tuple[float, float]:
    first = section.number_of(f"{which}_diameter_begin", "length")
    last = section.number_of(f"{which}_diameter_end", "length")
    first = last if first is None else first
    first = default if first is None else first
    if first is None:
        raise InputError(f"{section} has no {which}_diameter_begin: give it")
    return first, first if last is None else last


def _chosen(
    model: Model,
    shafts: Sequence[Part],
    pieces: dict[str, list[Piece]],
    span: tuple[float, float],
) -> tuple[list[Piece], list[Part]]:
    """Pieces from one end to the other, and the shafts that they are of."""
    cut = {s.number: _cut(pieces[s.number], *span) for s in shafts}
    order = sorted(shafts, key=lambda s: -sum(p.x1 - p.x0 for p in cut[s.number]))
    order = [s for s in order if cut[s.number]]
    found: list[Piece] = []
    used: list[Part] = []
    for shaft in order:
        same = not used or _material_of(model, shaft) == _material_of(model, used[0])
        clear = all(
            p.x1 <= q.x0 + SLIVER or q.x1 <= p.x0 + SLIVER for p in cut[shaft.number] for q in found
        )
        if same and clear:
            found = sorted([*found, *cut[shaft.number]])
            used.append(shaft)
    return _joined(found), used


def _cut(pieces: Sequence[Piece], low: float, high: float) -> list[Piece]:
    """What of pieces is between two places; what a later one has in common with one is left out."""
    found: list[Piece] = []
    for piece in pieces:
        x0 = max(piece.x0, low, found[-1].x1 if found else low)
        x1 = min(piece.x1, high)
        if x1 - x0 <= SLIVER:
            continue
        slope = (piece.end - piece.outer) / (piece.x1 - piece.x0)
        outer = piece.outer + slope * (x0 - piece.x0) if x0 != piece.x0 else piece.outer
        end = piece.outer + slope * (x1 - piece.x0) if x1 != piece.x1 else piece.end
        found.append(Piece(x0, x1, outer, end, piece.inner))
    return found


def _joined(pieces: Sequence[Piece]) -> list[Piece]:
    """Pieces without gaps: one goes on to the next."""
    found: list[Piece] = []
    for piece in pieces:
        if found and piece.x0 - found[-1].x1 > SLIVER:
            last = found[-1]
            found.append(Piece(last.x1, piece.x0, last.end, last.end, last.inner))
        found.append(piece)
    return found


def _sized(pieces: Sequence[Piece]) -> dict[str, Any]:
    """Diameters of one cylinder, or sections."""
    if len(pieces) == 1 and pieces[0].outer == pieces[0].end:
        (one,) = pieces
        bore = {"inner": one.inner} if one.inner else {}
        return {"length": abs(one.x1 - one.x0), "outer": one.outer, **bore}
    sections = []
    for piece in pieces:
        section = {"length": abs(piece.x1 - piece.x0), "outer_diameter": piece.outer}
        if piece.inner:
            section["inner_diameter"] = piece.inner
        if piece.end != piece.outer:
            section["outer_diameter_end"] = piece.end
        sections.append(section)
    # a kind is stated, by which a file's main shaft may have sections without bearing units
    return {"kind": "shaft", "sections": sections}


def _material_of(model: Model, shaft: Part) -> str | None:
    for ends in model.related("reference", origin=shaft):
        if ends.get("referenced", shaft).type == "material":
            return ends["referenced"].number
    return None


def _material(model: Model, shaft: Part, notes: list[str]) -> dict[str, Any]:
    number = _material_of(model, shaft)
    if number is None:
        return {}
    part = model.parts[number]
    values = {
        "youngs_modulus": part.number_of("elastic_modulus", "modulus"),
        "poisson_ratio": part.number_of("poisson_ratio", "number"),
        "density": part.number_of("density", "density"),
    }
    absent = [key for key, value in values.items() if value is None]
    if absent:
        notes.append(f"{part} of {shaft} has no {' and no '.join(absent)}: steel instead")
        return {}
    return {"material": values}


def _without_sections(
    own: dict[str, Any],
    shafts: Sequence[Part],
    span: tuple[float, float, float],
    notes: list[str],
) -> Row:
    """A shaft by its stiffness, of our own attributes, or a rigid one."""
    low, high, sense = span
    shaft = shafts[0]
    shaft.used = True
    begin = low if sense > 0 else high
    if by_stiffness(own):
        given = own.get("length")
        length = float(given) if isinstance(given, int | float) else None
        return Row(own, begin, sense, length, [shaft])
    notes.append(f"{shaft} has no shaft_section between the stages: it is taken for rigid")
    length = high - low if high - low > SLIVER else None
    data: dict[str, Any] = {"kind": "rigid"} | ({"length": length} if length else {})
    return Row(data, begin, sense, length, [shaft], is_known=False)


def planes_of(places: Places, stages: Sequence[Stage]) -> list[tuple[float, float]]:
    """Where each stage's driven and driving gear stand along x [m]."""
    found = []
    for stage in stages:
        slow = stage.gears["planet" if stage.is_planetary else "gear"]
        fast = stage.gears["sun" if stage.is_planetary else "pinion"]
        found.append((float(places.of(slow)[0]), float(places.of(fast)[0])))
    return found
