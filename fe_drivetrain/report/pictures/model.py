"""A picture of a model: its parts cut open, with loads, supports and dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.typeset import with_prefix
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary
from fe_drivetrain.report.pictures.bodies import add_open_part, add_part
from fe_drivetrain.report.pictures.drawing_process import Picture, drawn
from fe_drivetrain.report.pictures.sheet import FAINT, INK, Plan, Sheet
from fe_drivetrain.report.pictures.symbols import (
    FORCE,
    GROUND,
    MOMENT,
    SPRING,
    add_gearbox,
    add_hub_loads,
    add_load_point,
    add_plate,
    hub_arrows,
)
from fe_drivetrain.report.pictures.view import ALONG_THE_SHAFT, STRIP, View

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
    from fe_drivetrain.shafts.response.model import Model

PARTS = {"shaft": "#9fb4c7", "bearing": "#e8a33d", "housing": "#6ba292", "nose": "#b3bf72"}
"""Colour of each kind of part."""

_SYMBOL = 0.11  # length of an arrow, of the length of the shaft
_STROKES = 5  # for the springs of a bearing that has no solid
_INTERFACES = {
    "bonded": "bonded",
    "spring": "6x6 spring",
    "rollers": "ring of rollers as springs",
    "sliding": "spherical joint (sliding)",
    "averaged": "spherical joint (averaged)",
    "rigid": "spherical joint (rigid faces)",
}


def picture_of_model(model: Model, path: Path) -> Picture:
    """Draw what a model consists of, cut open by a quarter, with loads, supports and dimensions.

    It is drawn beside what follows: `Picture.wait` returns when the file is there.

    Parameters
    ----------
    model : Model
        The model; it need not be solved.
    path : Path
        PNG to write, of `view.SIZE`.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    """
    mesh, scene = model.mesh, model.scene
    hub, rear = model.points["hub"].position, model.points["gearbox"].position
    a = _SYMBOL * scene.shaft.length
    radius = float(np.abs(mesh.points[mesh.face_nodes("shaft.rear")][:, 1:]).max())
    symbols = [
        hub + a * np.array([[-2.4, 0, 0], [0, 2.4, 0], [0, 0, 2.4]]),
        rear + a * np.array([[1.2, 0, 0], [0, -1.2, 0], [0, 0, -1.2]]),
        rear + np.array([[0, 0, radius + 1.2 * a]]),
    ]
    between = [unit.bearing.x for unit in scene.bearing_units]
    between += [bearing.x for bearing in scene.nose_bearings]
    between += [point.x for point in scene.load_points]
    stations = [hub[0], *sorted(between), rear[0]]
    under = _line_under(mesh, stations)
    seen = np.concatenate([mesh.points, *symbols, under])
    view = View.fitting(seen, ALONG_THE_SHAFT, top=60, bottom=STRIP + 60)
    plan = Plan(view)
    for part in mesh.part_names:
        facets, colour = boundary(mesh, part), PARTS[_kind(part)]
        # a solid shaft stays whole, as in any drawing
        if part == "shaft" and "shaft.bore" not in mesh.faces:
            plan.add(add_part, facets, mesh.points, colour)
        else:
            plan.add(add_open_part, facets, mesh.cells[mesh.part_cells(part)], mesh.points, colour)
    plan.add(add_hub_loads, hub, a)
    plan.add(add_gearbox, scene.gearbox.stiffness, scene.gearbox.weight > 0, rear, radius, a)
    for unit in scene.bearing_units:
        _fixed_base(plan, mesh, unit, 0.06 * a)
    for point in scene.load_points:
        plan.add(
            add_load_point, point.span, bool(point.weight), scene.shaft.outer_radius(point.x), a
        )
    _dimensions(plan, stations, under, mesh)
    _label_hub_loads(plan, hub, a)
    _label_parts(plan, model)
    plan.add(Sheet.triad)
    for left, rows in zip((190, 530, 910, 1250), _legend(model), strict=True):
        plan.add(Sheet.column, left, rows)
    return drawn(plan, path)


def _fixed_base(plan: Plan, mesh: Mesh, unit: BearingUnit, thickness: float) -> None:
    """Show where a housing is held: a plate under its base, or washers on its foot."""
    name = f"{unit.bearing.name}.housing"
    if unit.condensed is not None or f"{name}.base" not in mesh.faces:
        return  # no solid, or one that stands on parts of another unit
    heads = [face for face in mesh.faces if face.startswith(f"{name}.head ")]
    bolted = unit.foreign is None and not unit.parts and unit.block.base == "bolted"
    lift = unit.block.foot_thickness + thickness if bolted else 0.0
    for face in heads or [f"{name}.base"]:
        thick = thickness if heads else -thickness
        plan.add(add_plate, mesh.faces[face], mesh.points, thick, lift)


def _kind(part: str) -> str:
    if part in ("shaft", "nose"):
        return part
    return "housing" if "." in part else "bearing"


def _line_under(mesh: Mesh, stations: Sequence[float]) -> Floats:
    """Points (n, 3) under the axis at each station, on a line that no solid is below as seen."""
    view = View.fitting(mesh.points, ALONG_THE_SHAFT, top=0)
    slope = view.up[0] / view.right[0]
    depth = (slope * (mesh.points @ view.right) - mesh.points @ view.up).max()
    axis = np.outer(stations, np.eye(3)[0])
    points: Floats = axis - depth * view.up
    return points


def _dimensions(plan: Plan, stations: Sequence[float], under: Floats, mesh: Mesh) -> None:
    """A chain of dimensions along x, next to the line under the solids."""
    line = plan.view.project(under) - np.array([0.0, 34.0])
    for x, end in zip(stations, line, strict=True):
        near = mesh.points[np.abs(mesh.points[:, 0] - x) < 0.03 * np.ptp(stations)]
        start = plan.view.project([x, 0.0, near[:, 2].min()])
        end = end - np.array([0.0, 8.0])
        dashes = np.arange(0.0, np.linalg.norm(end - start), 4.5)
        way = (end - start) / np.linalg.norm(end - start)
        plan.add(Sheet.line, (start + dashes[:, None] * way)[: len(dashes) // 2 * 2], FAINT, 1.6)
    for (x0, p), (x1, q) in pairwise(zip(stations, line, strict=True)):
        way = (q - p) / np.linalg.norm(q - p)
        across = np.array([-way[1], way[0]])
        plan.add(Sheet.line, [p, q])
        for tip, sign in ((p, 1.0), (q, -1.0)):
            back = tip + 13 * sign * way
            plan.add(Sheet.area, [tip, back + 4 * across, back - 4 * across], INK)
        plan.add(Sheet.text, (p + q) / 2, f" {x1 - x0:.4g} m ", size=18, background=True)


def _label_hub_loads(plan: Plan, hub: Floats, a: float) -> None:
    sides = {"x": (0.0, -26.0), "y": (-2.0, 24.0), "z": (30.0, -10.0)}
    for name, tail, tip in hub_arrows(hub, a):
        # beside the head of an arrow is the most room; that of Fx is inside the shaft
        place = (tail + tip) / 2 if name.endswith("x") else tip
        colour = MOMENT if name.startswith("M") else FORCE
        plan.add(
            Sheet.text,
            plan.view.project(place) + sides[name[1]],
            name,
            colour,
            size=20,
            background=True,
        )


def _label_parts(plan: Plan, model: Model) -> None:
    mesh = model.mesh
    plan.add(Sheet.note, model.points["hub"].position, "hub", (-90, -150))
    plan.add(Sheet.note, model.points["gearbox"].position, "gearbox", (100, 115))
    for point in model.scene.load_points:
        top = [point.x, 0.0, model.scene.shaft.outer_radius(point.x)]
        plan.add(Sheet.note, top, point.name.replace("_", " "), (40, 110))
    for bearing in model.scene.nose_bearings:
        # between the two faces, where the cut is upright
        faces = (f"shaft.band.{bearing.name}", f"nose.band.{bearing.name}")
        top, bottom = (mesh.points[mesh.face_nodes(face)][:, 2].max() for face in faces)
        for x in np.linspace(*bearing.span, _STROKES):
            plan.add(Sheet.line, plan.view.project([[x, 0.0, top], [x, 0.0, bottom]]), SPRING, 2.5)
        height = (top + bottom) / 2
        plan.add(Sheet.note, [bearing.x, 0.0, height], bearing.name.replace("_", " "), (-60, 190))
    if model.scene.nose is not None:
        plan.add(Sheet.note, model.points["nose.root"].position, "nose, held", (60, -150), GROUND)
    for unit in model.scene.bearing_units:
        name = unit.bearing.name
        # the upright face of the cut shows the bearing at y = 0, between seat and outer face
        faces = (f"{name}.outer", f"shaft.seat.{name}")
        height = np.mean([mesh.points[mesh.face_nodes(face)][:, 2].max() for face in faces])
        plan.add(Sheet.note, [unit.bearing.x, 0.0, height], name.replace("_", " "), (-60, 150))
        if unit.condensed is not None:
            foot = [unit.bearing.x, 0.0, -unit.bearing.raceway_diameter / 2]
            plan.add(Sheet.note, foot, "on a stiffness, to ground", (-140, -60), GROUND)
            continue
        if f"{name}.housing.base" not in mesh.faces:
            continue  # it stands on parts of another unit
        base = mesh.points[mesh.face_nodes(f"{name}.housing.base")]
        corner = base[np.argmin(base @ [1.0, 1.0, 0.0])]
        if unit.parts or unit.foreign is not None:
            how = "held faces fixed" if unit.foreign is None else unit.foreign.held_by
            stands = how if unit.bedplate is None else "on a bedplate"
            plan.add(Sheet.note, corner, stands, (-140, -14), GROUND)
        elif unit.block.base == "bolted":
            top = corner + unit.block.foot_thickness * np.eye(3)[2]
            bolts = "fixed at the bolts" if unit.bedplate is None else "bolted to a bedplate"
            plan.add(Sheet.note, top, bolts, (-170, -24), GROUND)
        else:
            stands = "fixed base" if unit.bedplate is None else "on a bedplate"
            plan.add(Sheet.note, corner, stands, (-140, -14), GROUND)


def _legend(model: Model) -> list[list[tuple[str, str | None]]]:
    """Four columns: parts, interfaces, hub loads, gearbox."""
    scene = model.scene
    materials: dict[tuple[str, str], None] = {}
    for part in model.mesh.part_names:
        kind = _kind(part)
        name = scene.material_name(part).replace("_", " ")
        modulus = with_prefix(scene.material_of(part).youngs_modulus, "Pa")
        materials[kind, f"{kind}: {name}, E = {modulus}"] = None
    parts = [(text, PARTS[kind]) for kind, text in materials]
    interfaces: list[tuple[str, str | None]] = [
        (f"{unit.bearing.name.replace('_', ' ')}: {_INTERFACES[unit.interface]}", None)
        for unit in scene.bearing_units
    ]
    interfaces += [
        (f"{bearing.name.replace('_', ' ')}: springs, shaft on nose", SPRING)
        for bearing in scene.nose_bearings
    ]
    gearbox: list[tuple[str, str | None]] = []
    for name, k in zip(("x", "y", "z", "rx", "ry", "rz"), scene.gearbox.stiffness, strict=True):
        unit_name = "N m/rad" if name.startswith("r") else "N/m"
        value = "held" if k == "rigid" else f"k = {with_prefix(k, unit_name)}" if k else "free"
        gearbox.append((f"{name}: {value}", SPRING if k else None))
    if scene.gearbox.weight:
        gearbox.append((f"weight: {with_prefix(scene.gearbox.weight, 'N')}", FORCE))
    hub = [
        (f"forces ({scene.hub.coupling} over the face)", FORCE),
        ("moments (two heads)", MOMENT),
    ]
    hub += [
        (
            f"{point.name.replace('_', ' ')}"
            + (f": weight {with_prefix(point.weight, 'N')}" if point.weight else ""),
            FORCE,
        )
        for point in scene.load_points
    ]
    return [
        [("Parts", "head"), *parts, ("fixed to the ground", GROUND)],
        [("Interfaces", "head"), *interfaces],
        [("Loads" if scene.load_points else "Loads at the hub", "head"), *hub],
        [("Gearbox", "head"), *gearbox],
    ]
