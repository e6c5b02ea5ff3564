"""Symbols of loads and supports, as bodies in the scene."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.report.pictures.sheet import Sheet
from fe_drivetrain.report.pictures.surfaces import curved_surface

FORCE = "#b3261e"
MOMENT = "#6b3fa0"
SPRING = "#25567b"
GROUND = "#5b4636"


def add_plate(sheet: Sheet, facets: Ints, points: Floats, thickness: float, lift: float) -> None:
    """Draw the ground under a face, or washers on it: as thick as given, and lifted [m]."""
    plate = curved_surface(facets, points).extrude((0.0, 0.0, thickness), capping=True)
    if lift:
        plate = plate.translate((0.0, 0.0, lift))
    sheet.plotter.add_mesh(plate, color=GROUND, ambient=0.3)


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


def add_hub_loads(sheet: Sheet, hub: Floats, a: float) -> None:
    """Draw the arrows of the six hub loads, each of length `a` [m]."""
    for name, tail, tip in hub_arrows(hub, a):
        moment = name.startswith("M")
        _add_arrow(sheet.plotter, tail, tip, MOMENT if moment else FORCE, 2 if moment else 1)


def add_load_point(
    sheet: Sheet, span: Sequence[float], weighs: bool, radius: float, a: float
) -> None:
    """Draw a band round the shaft where loads enter, and an arrow for its weight, if any."""
    import pyvista

    band = pyvista.Tube(
        pointa=(span[0], 0.0, 0.0),
        pointb=(span[1], 0.0, 0.0),
        radius=1.01 * radius,
        n_sides=48,
    )
    sheet.plotter.add_mesh(band, color=FORCE, ambient=0.3)
    if weighs:
        top = np.array([0.5 * (span[0] + span[1]), 0.0, radius])
        _add_arrow(sheet.plotter, top + a * np.eye(3)[2], top, FORCE, 1)


def add_gearbox(
    sheet: Sheet,
    stiffness: Sequence[float | str],
    weighs: bool,
    rear: Floats,
    radius: float,
    a: float,
) -> None:
    """Springs (coils), rigid supports (rods) and the weight (an arrow from above)."""
    import pyvista

    x, y, z = np.eye(3)
    # towards the viewer and down, where they hide nothing
    starts = ((x, 0.0), (-y, radius), (-z, radius))
    for (way, start), k in zip(starts, stiffness[:3], strict=True):
        if k == 0:
            continue
        foot, ground = rear + start * way, rear + (start + a) * way
        if k == "rigid":
            shape = pyvista.Tube(pointa=foot, pointb=ground, radius=0.06 * a)
        else:
            shape = _coil(foot, ground, 0.13 * a).tube(radius=0.022 * a, n_sides=16)
        sheet.plotter.add_mesh(shape, color=SPRING, ambient=0.3)
        plate_x, plate_y, plate_z = np.where(way != 0, 0.06 * a, 0.45 * a)
        plate = pyvista.Cube(center=ground, x_length=plate_x, y_length=plate_y, z_length=plate_z)
        sheet.plotter.add_mesh(plate, color=GROUND, ambient=0.3)
    if weighs:
        tip = rear + radius * z
        _add_arrow(sheet.plotter, tip + a * z, tip, FORCE)


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
