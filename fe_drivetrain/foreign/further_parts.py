"""Further parts from files, under or beside a housing: meshed, placed, and tied to what they touch.

Which facets of housing and part lie on one another is found from the meshes: of the two faces one
must be covered whole by the other.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.elasticity.interfaces.constraints import Constraint
from fe_drivetrain.elasticity.interfaces.mortar import mortar_tie
from fe_drivetrain.elasticity.interfaces.overlap import (
    Pieces,
    common_pieces,
    curvature,
    left_by_rims,
)
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary
from fe_drivetrain.elasticity.mesh.shared_facets import are_among
from fe_drivetrain.foreign.bolted import SIDES
from fe_drivetrain.foreign.from_file import (
    PlacedPart,
    body_of_mesh,
    kept_part,
    mesh_facts,
    meshed_step,
    named_arrays,
    pick_data,
    step_facts,
)
from fe_drivetrain.foreign.holes import pressed_facets
from fe_drivetrain.geometry import Bearing, FurtherPart, MeshSizes

_WHOLE = 1e-5  # share of a facet that may be left uncovered: files have round-off
_TOUCHED = 1e-3  # share of a facet: less of it is round-off at an edge
_GAP = 1e-3  # of a face's radius: faces further apart do not touch


def placed_part(
    part: FurtherPart, bearing: Bearing, sizes: MeshSizes, cache: Cache | None = None
) -> PlacedPart:
    """Read a further part's file, mesh it where it is no mesh, and put it beside its bearing.

    Parameters
    ----------
    part : FurtherPart
        The part.
    bearing : Bearing
        Bearing of the part's unit.
    sizes : MeshSizes
        Element sizes of the scene; "housing" and "elements_per_turn" are used for a STEP file.
    cache : Cache or None
        Cache that the mesh may come from; the user's if not given.

    Returns
    -------
    PlacedPart
        Part in the scene's frame, in m: "BEARING.PART", with the faces "tie 1", "tie 2" ... as
        picked, or where they are bolted round their bolts and "open 1" ... elsewhere, and "held".

    Raises
    ------
    InputError
        The file cannot be read or meshed, or a face is not found.

    Warns
    -----
    UserWarning
        Healing has removed small details.
    """
    content = {
        "x": bearing.x,
        "sizes": sizes.model_dump(mode="json") if part.step else None,
    }
    shift = np.array(part.translate) + np.array([bearing.x, 0.0, 0.0])
    return kept_part(
        part,
        f"{bearing.name}.{part.name}",
        content,
        lambda: _of_step(part, shift, sizes) if part.step else _of_mesh(part, shift),
        cache,
    )


def _of_step(part: FurtherPart, shift: Floats, sizes: MeshSizes) -> dict[str, NDArray[Any]]:
    request = {
        "part": part.part,
        "smallest_detail": part.smallest_detail,
        "tied": [pick_data(tie.face) for tie in part.tied],
        "to": [tie.to for tie in part.tied],
        "bolted": [t.bolted.model_dump(mode="json") if t.bolted else None for t in part.tied],
        "held": [pick_data(pick) for pick in part.held],
        "size": sizes.housing / part.scale,
        "per_turn": sizes.elements_per_turn,
        "optimise": False,
    }
    mesh, survey = meshed_step("mesh further part", part, request, lambda _: shift)
    return named_arrays(survey["name"], mesh, step_facts(survey, part.scale))


def _of_mesh(part: FurtherPart, shift: Floats) -> dict[str, NDArray[Any]]:
    body, surface = body_of_mesh(part)
    picked = [surface.picked(tie.face, "tied face") for tie in part.tied]
    held = surface.picked_all(part.held, "held face")
    faces = {f"body.tie {k}": surface.facets[found] for k, found in enumerate(picked, 1)}
    # several parts may lie on one face, each once
    by_part = {to: [held] for to in (tie.to for tie in part.tied)}
    for tie, found in zip(part.tied, picked, strict=True):
        by_part[tie.to].append(found)
    if any(len(np.unique(n := np.concatenate(all_))) < len(n) for all_ in by_part.values()):
        raise InputError(
            f"{surface.name}: a face of {part.what()} is picked twice, to be tied or held: pick "
            "each face once"
        )
    if len(held):
        faces["body.held"] = surface.facets[held]
    for k, (tie, found) in enumerate(zip(part.tied, picked, strict=True), 1):
        if tie.bolted is not None:
            pressed = pressed_facets(surface, found, tie.bolted, part.unit or "")
            faces[f"body.tie {k}"] = surface.facets[pressed]
            faces[f"body.open {k}"] = surface.facets[np.setdiff1d(found, pressed)]
    points = np.asarray(part.scale * (body.points @ part.rotation.T) + shift, dtype=np.float64)
    mesh = Mesh(points, body.cells, body.part, ("body",), faces, {})
    return named_arrays(surface.name, mesh, mesh_facts(mesh))


def touching(name: str, points: Floats, face: Ints, outside: Ints) -> Ints:
    """Facets of another part's outside that a face of a part lies on.

    Parameters
    ----------
    name : str
        Names of what is tied, for messages.
    points : Floats
        Nodes (n, 3) [m].
    face, outside : Ints
        Facets (nf, 6) of the part's face, and of the other part's whole outside.

    Returns
    -------
    Ints
        Facets (m, 6) of the outside: they cover the face whole, or are covered whole by it.

    Raises
    ------
    InputError
        They do not touch, or each reaches beyond the other.
    """
    near = _near(points, face, outside)
    pieces = common_pieces(points, face, near) if len(near) else None
    if pieces is None or not len(pieces.area):
        middle = points[np.unique(face)].mean(axis=0)
        away = np.linalg.norm(points[np.unique(outside)] - middle, axis=1).min()
        raise InputError(
            f"{name}: the face round {_xyz(middle)} m touches nothing there, the nearest node is "
            f"{away:.3g} m from its middle: correct 'translate', 'rotate', 'unit' or the picked "
            "face"
        )
    under = near[np.unique(pieces.master)]
    allowed = _WHOLE + curvature(points, face) + curvature(points, under)
    own, left = _shares(points, face, under, pieces)
    share, other_left = _shares(points, under, face, common_pieces(points, under, face))
    on = share > _TOUCHED
    covered = (own > 1.0 - allowed - left).all()
    whole = on.any() and (share > 1.0 - allowed - other_left)[on].all()
    if covered or whole:
        return under[on] if whole else under
    areas = facet_points(points, face).areas.sum(axis=1)
    raise InputError(
        f"{name}: {100 * float(own @ areas) / float(areas.sum()):.4g} % of the face lies on it, "
        "and neither covers the other whole: divide the larger face along the outline of the "
        "smaller one in the CAD program, or pick the one that is covered"
    )


def slave_first(points: Floats, one: Ints, two: Ints) -> tuple[Ints, Ints]:
    """The slave and the master of two faces: the one that is covered; of equal ones the finer.

    Parameters
    ----------
    points : Floats
        Nodes (n, 3) [m].
    one, two : Ints
        Facets (nf, 6) of both faces.
    """
    first, second = (float(facet_points(points, f).areas.sum()) for f in (one, two))
    if abs(first - second) > _WHOLE * max(first, second):
        return (one, two) if first < second else (two, one)
    return (one, two) if len(np.unique(one)) >= len(np.unique(two)) else (two, one)


def tie_faces(unit: BearingUnit) -> list[tuple[str, str]]:
    """Names of the faces that are tied, of each further part and of what it lies on.

    Parameters
    ----------
    unit : BearingUnit
        Bearing unit with its parts.
    """
    name = unit.bearing.name
    return [
        (
            f"{name}.{part.name}.tie {k}",
            f"{tie.to if tie.to.endswith('.housing') else f'{name}.{tie.to}'}.tie {part.name} {k}",
        )
        for part in unit.parts
        for k, tie in enumerate(part.tied, 1)
    ]


def open_faces(unit: BearingUnit) -> list[tuple[str, str]]:
    """Names of the faces beside the bolts of bolted ties: of each further part, and opposite.

    Parameters
    ----------
    unit : BearingUnit
        Bearing unit with its parts; where bolts press all of a tied face, a mesh has no such faces.
    """
    bolted = [tie.bolted for part in unit.parts for tie in part.tied]
    pairs = zip(tie_faces(unit), bolted, strict=True)
    return [
        (own.replace(".tie ", ".open "), other.replace(".tie ", ".open "))
        for (own, other), joint in pairs
        if joint is not None
    ]


def open_sides(units: Iterable[BearingUnit]) -> list[tuple[str, str]]:
    """Names of faces of a mesh that lie on one another without being joined.

    Parameters
    ----------
    units : Iterable[BearingUnit]
        Bearing units of a scene; where bolts press all of a joint, a mesh has no such faces.
    """
    found = []
    for unit in units:
        if unit.foreign is not None and unit.foreign.bolted is not None:
            one, two = (f"{unit.bearing.name}.housing.{side}" for side in SIDES)
            found.append((one, two))
        found += open_faces(unit)
    return found


def joined(mesh: Mesh, unit: BearingUnit) -> Mesh:
    """Name what the further parts of a unit lie on, and where the unit stands.

    Parameters
    ----------
    mesh : Mesh
        Mesh with the housing and all parts of the unit, and housings of others that stand on these.
    unit : BearingUnit
        The unit.

    Returns
    -------
    Mesh
        Mesh with the faces of `tie_faces` and `open_faces`; "NAME.housing.base" is all that the
        ground holds, and there is none where that holds nothing.

    Raises
    ------
    InputError
        Faces do not touch, or one that is tied is held, too.
    """
    name = unit.bearing.name
    faces = dict(mesh.faces)
    targets = {other.rpartition(".")[0] for _, other in tie_faces(unit)}
    sides = {part: boundary(mesh, part) for part in sorted(targets)}
    for own, other in tie_faces(unit):
        part, target = own.rpartition(".")[0], other.rpartition(".")[0]
        faces[other] = touching(f"{part} tied to {target}", mesh.points, faces[own], sides[target])
    for own, other in open_faces(unit):
        if own in faces:
            opposite = _near(mesh.points, faces[own], sides[other.rpartition(".")[0]])
            pieces = common_pieces(mesh.points, faces[own], opposite)
            faces[other] = opposite[np.unique(pieces.master)]
    ground = [faces.pop(f"{name}.housing.base")] if f"{name}.housing.base" in faces else []
    held = [faces.pop(f"{name}.{part.name}.held") for part in unit.parts if part.held]
    none = np.zeros((0, 6), dtype=np.int64)
    base = np.concatenate([none, *(ground if unit.stands_on == "ground" else []), *held])
    n = len(mesh.points)
    for own, other in tie_faces(unit):
        for face in (own, other):
            if are_among(faces[face], base, n).any():
                raise InputError(
                    f"{own.rpartition('.')[0]} is tied to {other.rpartition('.')[0]} in a face "
                    "that the ground holds, too: give stands_on: parts where parts alone carry "
                    f"the housing of {name!r}, or hold another face"
                )
    return replace(mesh, faces=faces | ({f"{name}.housing.base": base} if len(base) else {}))


def tie_of(name: str, points: Floats, one: Ints, two: Ints) -> Constraint:
    """Tie of two faces that touch, see `fe_drivetrain.elasticity.interfaces.mortar.mortar_tie`.

    Parameters
    ----------
    name : str
        Name of the tie.
    points : Floats
        Nodes (n, 3) [m].
    one, two : Ints
        Facets (nf, 6), of which one face covers the other.

    Raises
    ------
    InputError
        The faces lie apart.
    """
    slave, master = slave_first(points, one, two)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".* lie up to")  # is refused below
        tie = mortar_tie(name, points, slave, master, points.size, "dual")
    own = points[np.unique(slave)]
    radius = float(np.linalg.norm(own - own.mean(axis=0), axis=1).max())
    gap = float(np.linalg.norm((tie.rows @ points.ravel()).reshape(-1, 3), axis=1).max())
    allowed = radius * (_GAP + curvature(points, slave) + curvature(points, master))
    if gap > allowed:
        raise InputError(
            f"{name}: the two faces lie {gap:.3g} m apart, but must touch within {allowed:.2g} m: "
            "correct 'translate', 'rotate' or the file, or pick other faces"
        )
    return tie


def _near(points: Floats, face: Ints, outside: Ints) -> Ints:
    """Facets of the outside that are not away from the face's box."""
    low, high = points[face].min(axis=(0, 1)), points[face].max(axis=(0, 1))
    boxes = points[outside]
    reach = np.ptp(boxes, axis=1).max()
    beside = (boxes.max(axis=1) < low - reach) | (boxes.min(axis=1) > high + reach)
    return np.asarray(outside[~beside.any(axis=1)], dtype=np.int64)


def _shares(points: Floats, face: Ints, other: Ints, pieces: Pieces) -> tuple[Floats, Floats]:
    """Shares of a face's facets that another face covers, and that rims may leave uncovered."""
    areas = facet_points(points, face).areas.sum(axis=1)
    covered = np.bincount(pieces.slave, pieces.area, len(face))
    return covered / areas, left_by_rims(points, face, other) / areas


def _xyz(place: Floats) -> str:
    return "({:.4g}, {:.4g}, {:.4g})".format(*place.tolist())
