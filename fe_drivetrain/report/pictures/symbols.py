"""Symbols of loads and supports, as bodies in the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.report.pictures.surfaces import curved_surface

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
    from fe_drivetrain.drivetrain_file.scene import Gearbox, LoadPoint

FORCE = "#b3261e"
MOMENT = "#6b3fa0"
SPRING = "#25567b"
GROUND = "#5b4636"


def add_fixed_base(plotter: Any, mesh: Mesh, unit: BearingUnit, thickness: float) -> None:
    """Show where a housing is held: a plate under its base, or washers on its foot."""
    name = f"{unit.bearing.name}.housing"
    if unit.condensed is not None or f"{name}.base" not in mesh.faces:
        return  # no solid, or one that stands on parts of another unit
    heads = [face for face in mesh.faces if face.startswith(f"{name}.head ")]
    for face in heads or [f"{name}.base"]:
        surface = curved_surface(mesh.faces[face], mesh.points)
        plate = surface.extrude((0.0, 0.0, thickness if heads else -thickness), capping=True)
        if unit.foreign is None and not unit.parts and unit.block.base == "bolted":
            plate = plate.translate((0.0, 0.0, unit.block.foot_thickness + thickness))
        plotter.add_mesh(plate, color=GROUND, ambient=0.3)


def hub_arrows(hub: Floats, a: float) -> list[tuple[str, Floats, Floats]]:
    """Name, tail and tip of the arrows of the six hub loads: moments beyond forces.

    All point along the positive axes. Those along x stand upstream, outside the shaft.
    """
    arrows = []
    for axis, e in zip("xyz", np.eye(3), strict=True):
        tails = (-1.0, -2.3) if axis == "x" else (0.0, 1.3)
        for letter, at in zip("FM", tails, strict=True):
            arrows.append((f"{letter}{axis}", hub + a * at * e, hub + a * (at + 1.0) * e))
    return arrows


def add_hub_loads(plotter: Any, hub: Floats, a: float) -> None:
    """Draw the arrows of the six hub loads, each of length `a` [m]."""
    for name, tail, tip in hub_arrows(hub, a):
        moment = name.startswith("M")
        _add_arrow(plotter, tail, tip, MOMENT if moment else FORCE, 2 if moment else 1)


def add_load_point(plotter: Any, point: LoadPoint, radius: float, a: float) -> None:
    """Draw a band round the shaft where loads enter, and an arrow for its weight, if any."""
    import pyvista

    band = pyvista.Tube(
        pointa=(point.span[0], 0.0, 0.0),
        pointb=(point.span[1], 0.0, 0.0),
        radius=1.01 * radius,
        n_sides=48,
    )
    plotter.add_mesh(band, color=FORCE, ambient=0.3)
    if point.weight:
        top = np.array([point.x, 0.0, radius])
        _add_arrow(plotter, top + a * np.eye(3)[2], top, FORCE, 1)


def add_gearbox(plotter: Any, gearbox: Gearbox, rear: Floats, radius: float, a: float) -> None:
    """Springs (coils), rigid supports (rods) and the weight (an arrow from above)."""
    import pyvista

    x, y, z = np.eye(3)
    # towards the viewer and down, where they hide nothing
    starts = ((x, 0.0), (-y, radius), (-z, radius))
    for (way, start), k in zip(starts, gearbox.stiffness[:3], strict=True):
        if k == 0:
            continue
        foot, ground = rear + start * way, rear + (start + a) * way
        if k == "rigid":
            shape = pyvista.Tube(pointa=foot, pointb=ground, radius=0.06 * a)
        else:
            shape = _coil(foot, ground, 0.13 * a).tube(radius=0.022 * a, n_sides=16)
        plotter.add_mesh(shape, color=SPRING, ambient=0.3)
        plate_x, plate_y, plate_z = np.where(way != 0, 0.06 * a, 0.45 * a)
        plate = pyvista.Cube(center=ground, x_length=plate_x, y_length=plate_y, z_length=plate_z)
        plotter.add_mesh(plate, color=GROUND, ambient=0.3)
    if gearbox.weight > 0:
        tip = rear + radius * z
        _add_arrow(plotter, tip + a * z, tip, FORCE)


def _add_arrow(plotter: Any, tail: Floats, tip: Floats, colour: str, heads: int = 1) -> None:
    """An arrow of cylinder and cones; two heads for a moment."""
    import pyvista

    way = tip - tail
    length = float(np.linalg.norm(way))
    way = way / length
    head = 0.26 * length
    end = tip - head * (1.0 + 0.75 * (heads - 1)) * way
    shank = pyvista.Cylinder(
        center=(tail + end) / 2,
        direction=way,
        radius=0.045 * length,
        height=float(np.linalg.norm(end - tail)),
        resolution=32,
    )
    plotter.add_mesh(shank, color=colour, ambient=0.3)
    for k in range(heads):
        middle = tip - (0.5 + 0.75 * k) * head * way
        cone = pyvista.Cone(
            center=middle, direction=way, height=head, radius=0.115 * length, resolution=48
        )
        plotter.add_mesh(cone, color=colour, ambient=0.3)


def _coil(start: Floats, end: Floats, radius: float, turns: int = 6) -> Any:
    """A helical spring with straight ends, as a line."""
    import pyvista

    length = float(np.linalg.norm(end - start))
    way = (end - start) / length
    side = np.cross(way, [0.3, 0.5, 0.8])
    side /= np.linalg.norm(side)
    other = np.cross(way, side)
    s = np.linspace(0.0, 1.0, 40 * turns)
    r = radius * np.clip(np.minimum(s, 1.0 - s) / 0.12 - 0.6, 0.0, 1.0)
    angle = 2 * np.pi * turns * s
    points = start + np.outer(length * s, way)
    points += (r * np.cos(angle))[:, None] * side + (r * np.sin(angle))[:, None] * other
    return pyvista.lines_from_points(points)
