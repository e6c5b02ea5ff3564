"""Contents of a file of solids or a mesh: what a user looks at, to pick a seat and held faces."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.mesh.measures import enclosed_volume, mass_moments, scaled_jacobians
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary
from fe_drivetrain.foreign.face_messages import nearly
from fe_drivetrain.foreign.holes import Cylinder, cylinders, planes
from fe_drivetrain.foreign.known_healing import read_step
from fe_drivetrain.foreign.picking import Surface
from fe_drivetrain.foreign.reading import read_in_process
from fe_drivetrain.geometry.foreign_housing import MESH_ENDINGS, SOLID_ENDINGS

_MAX_ROWS = 24
_SETS = (
    ("solids", "solid "),
    ("faces", "face "),
    ("sets of nodes", "nodes "),
    ("empty sets", "empty "),
)
_TURNS = {0: "", 1: "rotate: [0, 0, -90]", 2: "rotate: [0, 90, 0]"}  # of an axis to x


class Mark(NamedTuple):
    """A place to point at in a picture.

    Attributes
    ----------
    name : str
        Name as in the text.
    place : tuple[float, float, float]
        Position, in the file's unit; of a bore its middle.
    reach : tuple[float, float, float]
        Vector from the middle of a bore to one of its ends.
    normal : tuple[float, float, float]
        Outward normal of a plane; zeros of a bore.
    """

    name: str
    place: tuple[float, float, float]
    reach: tuple[float, float, float] = (0.0, 0.0, 0.0)
    normal: tuple[float, float, float] = (0.0, 0.0, 0.0)


class Bore(NamedTuple):
    """A face that may be a seat.

    Attributes
    ----------
    name : str
        As the text has it.
    kind : str
        "cylinder" or "sphere".
    hole : bool
        Whether it is hollow; else it is the outside of something round.
    radius, length : float
        In the file's unit; of a sphere its diameter is the length.
    centre, axis : tuple[float, float, float]
        Middle, in the file's unit, and direction; zeros of a sphere.
    """

    name: str
    kind: str
    hole: bool
    radius: float
    length: float
    centre: tuple[float, float, float]
    axis: tuple[float, float, float]


class Plane(NamedTuple):
    """A plane by which the part may be held.

    Attributes
    ----------
    name : str
        As the text has it.
    area : float
        In the square of the file's unit.
    point, normal : tuple[float, float, float]
        A point of it, in the file's unit, and its outward direction.
    """

    name: str
    area: float
    point: tuple[float, float, float]
    normal: tuple[float, float, float]


class Survey(NamedTuple):
    """Contents of a file.

    Attributes
    ----------
    text : str
        Text in words and numbers, for the terminal.
    points : Floats
        Points (n, 3) of its surface, in the file's unit.
    triangles : Ints
        Triangles (k, 3) of its surface.
    marks : tuple[Mark, ...]
        Seats and planes by the names that the text gives them.
    unit : str
        Unit of its lengths: "mm" of a STEP file; empty of a mesh, which does not say.
    volume : float or None
        In the cube of that unit; None where elements fold over.
    volume_band : float or None
        How far it may be wrong, where faces are splines; else None.
    bores : tuple[Bore, ...]
        The widest first; of a mesh holes before the outside of what is round.
    planes : tuple[Plane, ...]
        The largest first, as many as the text has.
    """

    text: str
    points: Floats
    triangles: Ints
    marks: tuple[Mark, ...]
    unit: str
    volume: float | None
    volume_band: float | None
    bores: tuple[Bore, ...]
    planes: tuple[Plane, ...]

    def __repr__(self) -> str:
        """One line, without the points of its surface."""
        return short_repr(self)


def surveyed(path: str | Path) -> Survey:
    """Read a file, and describe what a scene may pick of it.

    Parameters
    ----------
    path : str or Path
        A STEP or mesh file, see `SOLID_ENDINGS` and `MESH_ENDINGS`.

    Returns
    -------
    Survey

    Raises
    ------
    InputError
        It has another ending, or cannot be read.
    """
    ending = Path(path).suffix.lower()
    if ending in SOLID_ENDINGS:
        return _of_step(Path(path))
    if ending in MESH_ENDINGS:
        return _of_mesh(Path(path))
    raise InputError(
        f"{path} must end in {', '.join((*SOLID_ENDINGS, *MESH_ENDINGS))}: give a file of solids "
        "or a mesh"
    )


def _of_step(path: Path) -> Survey:
    found = read_step("look", path, {"smallest_detail": 0.0})
    data = json.loads(str(found["survey"]))
    volume, area, apart = _size(found, data["after"])
    bores, bore_marks = _bore_lines(data)
    planes = sorted(_planes(data["faces"]), key=lambda p: -p["area"])
    flat, plane_marks = _plane_lines(planes)
    lines = [*_solid_lines(path, found, data, (volume, area, apart)), *bores, *flat]
    if data["seats"] and planes:
        lines += _proposal(path, data["seats"], planes)
    return Survey(
        "\n".join(lines) + "\n",
        found["points"],
        found["triangles"],
        (*bore_marks, *plane_marks),
        "mm",
        float(volume),
        apart,
        tuple(_bore(f"S{k}", seat) for k, seat in enumerate(data["seats"], 1)),
        tuple(_plane(f"P{k}", plane) for k, plane in enumerate(planes[:_MAX_ROWS], 1)),
    )


def _size(found: Mapping[str, Any], after: Mapping[str, Any]) -> tuple[float, float, float | None]:
    """Volume [mm^3] and area [mm^2], and how far OpenCASCADE's volume is from it with splines.

    OpenCASCADE's integrals over splines are inexact, so that curved facets enclose the volume.
    """
    if "curved_triangles" not in found:
        return after["volume"], after["area"], None
    curved = found["curved_points"], found["curved_triangles"]
    volume, area = enclosed_volume(*curved), facet_points(*curved).areas.sum()
    return volume, area, float(abs(volume - after["volume"]))


def _solid_lines(
    path: Path,
    found: Mapping[str, Any],
    data: Mapping[str, Any],
    size: tuple[float, float, float | None],
) -> list[str]:
    """What the file holds, before and after healing, and its solids."""
    before, after = data["before"], data["after"]
    low, high = np.reshape(data["box"], (2, 3))
    if len(found["triangles"]):
        low, high = found["points"].min(axis=0), found["points"].max(axis=0)
    volume, area, apart = size
    large = f"{volume / 1e6:.6g} dm^3"
    if apart is not None:
        large = f"{volume / 1e6:.5g} +- {apart / 1e6:.2g} dm^3"
    lines = [
        f"{path.name}: {after['words']}, {after['faces']} faces, {after['edges']} edges, "
        f"{large}, {area / 1e6:.4g} m^2",
        f"box: {_xyz(low)} to {_xyz(high)} mm",
        data["healing"],
        f"before healing: {before['words']}, {before['faces']} faces, "
        f"{before['volume'] / 1e6:.6g} dm^3",
    ]
    if apart is not None:
        lines[-1] += f", after it {after['volume'] / 1e6:.6g} dm^3 in the same way"
        lines.append(
            "faces are splines: the volume is that within curved facets, and its band how far "
            "OpenCASCADE's, before and after healing, is from it"
        )
    if after["solids"] > 1:
        lines += ["", "Solids, glued where they touch; one alone by 'part', its name [mm]:"]
        rows = [
            (
                f"solid {number}",
                repr(solid["name"]),
                f"{solid['volume'] / 1e6:.6g} dm^3",
                f"centre {_xyz(solid['centre'])}",
            )
            for number, solid in enumerate(data["solids"][:_MAX_ROWS], 1)
        ]
        lines += _table(rows, after["solids"])
    if "unmeshed" in data:
        lines.append(f"gmsh cannot mesh it: {data['unmeshed']}")
    return lines


def _bore_lines(data: Mapping[str, Any]) -> tuple[list[str], list[Mark]]:
    """Bores of a STEP file, which may be seats, and marks at them."""
    marks: list[Mark] = []
    rows: list[tuple[str, ...]] = []
    for number, seat in enumerate(data["seats"][:_MAX_ROWS], 1):
        x, y, z = (seat["length"] / 2 * np.array(seat["axis"])).tolist()
        marks.append(Mark(f"S{number}", tuple(seat["centre"]), (x, y, z)))
        round_ = seat["kind"] == "Cylinder"
        rows.append(
            (
                f"S{number}",
                seat["kind"].lower(),
                f"radius {seat['radius']:.7g}",
                f"length {seat['length']:.6g}" if round_ else "",
                f"centre {_xyz(seat['centre'])}",
                f"axis {_xyz(seat['axis'])}" if round_ else "",
                f"of a {seat['described']}, within {seat['off']:.2g}" if seat["described"] else "",
                *_tags(seat),
            )
        )
    lines = ["", "Bores, the widest first; one of them is the seat [mm]:"]
    lines += _table(rows, len(data["seats"]))
    almost = [face for face in data["faces"] if "nearly" in face]
    return lines + [f"  no bore: {nearly(face)}" for face in almost[:_MAX_ROWS]], marks


def _plane_lines(planes: Sequence[Mapping[str, Any]]) -> tuple[list[str], list[Mark]]:
    """Planes of a STEP file, which may hold the part, and marks at them."""
    marks: list[Mark] = []
    rows: list[tuple[str, ...]] = []
    for number, plane in enumerate(planes[:_MAX_ROWS], 1):
        marks.append(Mark(f"P{number}", tuple(plane["middle"]), normal=tuple(plane["normal"])))
        rows.append(
            (
                f"P{number}",
                f"{plane['area'] / 100:.4g} cm^2",
                f"point {_xyz(plane['middle'])}",
                f"normal {_xyz(plane['normal'])}",
                *_tags(plane),
            )
        )
    title = "Planes, the largest first; the part is held by one or more of them [mm]:"
    return ["", title, *_table(rows, len(planes))], marks


def _bore(name: str, seat: Mapping[str, Any]) -> Bore:
    numbers = float(seat["radius"]), float(seat["length"])
    at = _triple(np.array(seat["centre"])), _triple(np.array(seat["axis"]))
    return Bore(name, seat["kind"].lower(), True, *numbers, *at)


def _plane(name: str, plane: Mapping[str, Any]) -> Plane:
    at = _triple(np.array(plane["middle"])), _triple(np.array(plane["normal"]))
    return Plane(name, float(plane["area"]), *at)


def _planes(faces: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Plane faces, those of one plane taken together."""
    found: dict[tuple[float, ...], dict[str, Any]] = {}
    for face in faces:
        if face["kind"] != "Plane":
            continue
        normal, middle = np.array(face["normal"]), np.array(face["middle"])
        key = (*np.round(normal, 5).tolist(), round(float(normal @ middle), 3))
        one = found.setdefault(tuple(x + 0.0 for x in key), {**face, "area": 0.0})
        if face["area"] > one["area"]:
            one["middle"] = face["middle"]
        one["area"] += face["area"]
        one["label"] = one["label"] or face["label"]
        one["colour"] = one["colour"] or face["colour"]
    return list(found.values())


def _proposal(
    path: Path, seats: Sequence[Mapping[str, Any]], planes: Sequence[Mapping[str, Any]]
) -> list[str]:
    """Lines for a scene, with the widest bore and the largest plane."""
    seat, plane = seats[0], planes[0]
    alone = sum(abs(s["radius"] - seat["radius"]) < 1e-3 * seat["radius"] for s in seats) == 1
    pick = f"radius: {seat['radius']:.7g}"
    turn = ""
    if seat["kind"] == "Cylinder":
        turn = _TURNS[int(np.argmax(np.abs(seat["axis"])))]
        if not alone:
            pick += f", axis: {_list(seat['axis'])}, point: {_list(seat['centre'])}"
    elif not alone:
        pick += f", centre: {_list(seat['centre'])}"
    kind = "ring" if seat["kind"] == "Cylinder" else "spherical"
    return [
        "",
        f"In a scene, beside a bearing of kind {kind} and raceway_diameter "
        f"{2e-3 * seat['radius']:.7g} (check what is proposed):",
        "    housing:",
        f"      step: {path.name}",
        *([f"      {turn}   # so that the seat's axis is x"] if turn else []),
        f"      seat: {{{pick}}}   # S1",
        f"      held: [{{point: {_list(plane['middle'])}, normal: {_list(plane['normal'])}}}] # P1",
    ]


def _of_mesh(path: Path) -> Survey:
    found = read_in_process("read mesh", path, {})
    points, cells = found["points"], found["cells"]
    worst = float(scaled_jacobians(points, cells).min())
    sound = worst > 0.0
    volume = float(mass_moments(points, cells)[0]) if sound else None
    used = points[np.unique(cells)]
    body = Mesh(points, cells, np.zeros(len(cells), dtype=np.int64), ("body",), {}, {})
    outside = boundary(body)
    low, high = used.min(axis=0), used.max(axis=0)
    kind = "of 4 nodes, which get straight edges" if found["linear"] else "of 10 nodes"
    lines = [
        f"{path.name}: {len(cells)} tetrahedra {kind}, {len(used)} nodes",
        f"box: {_xyz(low)} to {_xyz(high)}, "
        f"volume {'unknown' if volume is None else f'{volume:.6g}'}, in the file's unit",
        f"worst scaled Jacobian: {worst:.3g}" + (": elements fold over" if worst <= 0 else ""),
    ]
    if beside := str(found["beside"]):
        lines.append(f"left out, as it carries nothing in a housing: {beside}")
    surface = Surface(path.name, points, outside, {})
    round_faces, flat = (cylinders(surface), planes(surface)) if sound else ([], [])
    lines += [*_cylinder_lines(round_faces), *_flat_lines(flat), ""]
    for what, prefix in _SETS:
        names = sorted(key.removeprefix(prefix) for key in found if key.startswith(prefix))
        more = f" and {len(names) - _MAX_ROWS} more" if len(names) > _MAX_ROWS else ""
        if names or prefix != "empty ":
            lines.append(f"{what} by label: {', '.join(names[:_MAX_ROWS]) or 'none'}{more}")
    bores, faces = _bores_of(round_faces), _planes_of(flat)
    marks = [
        Mark(bore.name, bore.centre, _triple(one.length / 2 * one.axis))
        for bore, one in zip(bores[:_MAX_ROWS], round_faces, strict=False)
    ]
    marks += [Mark(face.name, face.point, normal=face.normal) for face in faces]
    return Survey(
        "\n".join(lines) + "\n",
        points,
        outside[:, :3],
        tuple(marks),
        "",
        volume,
        None,
        bores,
        faces,
    )


def _cylinder_lines(round_faces: Sequence[Cylinder]) -> list[str]:
    rows = [
        (
            f"S{number}",
            "hole" if one.hole else "outside",
            f"radius: {one.radius:.7g}",
            f"axis: {_list(one.axis)}",
            f"point: {_list(one.centre)}",
            f"length {one.length:.6g}",
        )
        for number, one in enumerate(round_faces[:_MAX_ROWS], 1)
    ]
    title = "Cylinders, holes first, the widest first, in the file's unit:"
    return ["", title, *_table(rows, len(round_faces))]


def _flat_lines(flat: Sequence[tuple[float, Floats, Floats]]) -> list[str]:
    rows = [
        (
            f"P{number}",
            f"area {size:.4g}",
            f"point: {_list(middle)}",
            f"normal: {_list(normal)}",
        )
        for number, (size, middle, normal) in enumerate(flat[:_MAX_ROWS], 1)
    ]
    title = "Planes, the largest first; the part is held by one or more of them:"
    return ["", title, *_table(rows, len(flat))]


def _bores_of(round_faces: Sequence[Cylinder]) -> tuple[Bore, ...]:
    return tuple(
        Bore(
            f"S{number}",
            "cylinder",
            one.hole,
            float(one.radius),
            float(one.length),
            _triple(one.centre),
            _triple(one.axis),
        )
        for number, one in enumerate(round_faces, 1)
    )


def _planes_of(flat: Sequence[tuple[float, Floats, Floats]]) -> tuple[Plane, ...]:
    return tuple(
        Plane(f"P{number}", float(size), _triple(middle), _triple(normal))
        for number, (size, middle, normal) in enumerate(flat[:_MAX_ROWS], 1)
    )


def _triple(values: Floats) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z


def _tags(face: Mapping[str, Any]) -> tuple[str, str]:
    return (
        f"label {face['label']}" if face["label"] else "",
        f"colour {face['colour']}" if face["colour"] else "",
    )


def _table(rows: Sequence[Sequence[str]], count: int) -> list[str]:
    if not rows:
        return ["  none"]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  " + "  ".join(f"{c:<{w}}" for c, w in zip(row, widths, strict=True) if w).rstrip()
        for row in rows
    ]
    return [*lines, *([f"  and {count - len(rows)} more"] if count > len(rows) else [])]


def _xyz(values: Any) -> str:
    return "(" + ", ".join(f"{_rounded(v):.6g}" for v in values) + ")"


def _list(values: Any) -> str:
    return "[" + ", ".join(f"{_rounded(v):.7g}" for v in values) + "]"


def _rounded(value: float) -> float:
    return round(float(value), 5) + 0.0
