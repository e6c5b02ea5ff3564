"""Shafts with one step and a fillet in it, on one ring: where bands of the meridian have least."""

from __future__ import annotations

from typing import NamedTuple

from fe_drivetrain.drivetrain_file import BearingUnit, Gearbox, Scene, library_scene
from fe_drivetrain.geometry import Bearing, Housing, MeshSizes, Section, Shaft

_DIAMETER = 0.4  # [m]; all else is relative to it
_SPRINGS = (1e9, 1e9, 1e9, 0.0, 1e7, 1e7)  # no part of a free shaft


class OneFillet(NamedTuple):
    """Dimensions over the smaller diameter.

    Attributes
    ----------
    step : float
        Larger diameter.
    radius : float
        Radius of the fillet; at most half of what the diameters differ by.
    bore : float
        Diameter.
    length : float
        Length of each of both sections.
    seat : float
        Middle of the bearing on the thinner section, over the length of that.
    """

    step: float = 1.3
    radius: float = 0.05
    bore: float = 0.4
    length: float = 1.0
    seat: float = 0.6

    def __str__(self) -> str:
        """The dimensions in words."""
        return (
            f"D/d {self.step:g}, r/d {self.radius:g}, bore {self.bore:g}, L/d {self.length:g}, "
            f"seat at {self.seat:g}"
        )


SHAFTS = (
    OneFillet(),
    *(OneFillet(step, radius) for step in (1.05, 1.6, 2.5) for radius in (0.005, 0.02)),
    *(OneFillet(step, radius) for step in (1.6, 2.5) for radius in (0.1, 0.2)),
    *(OneFillet(bore=bore) for bore in (0.0, 0.8)),
    *(OneFillet(length=length) for length in (0.6, 3.0)),
    *(OneFillet(seat=seat) for seat in (0.4, 0.7)),
)
"""Step ratios, radii, bores, lengths and places of the bearing."""


def filleted_scene(of: OneFillet) -> Scene:
    """A free shaft of two sections with a ring on the thinner one.

    Parameters
    ----------
    of : OneFillet
        Its dimensions.

    Raises
    ------
    InputError
        The fillet does not fit.
    """
    d = _DIAMETER
    thick, thin = (
        Section(
            length=of.length * d,
            outer_diameter=outer * d,
            inner_diameter=of.bore * d,
            fillet=fillet * d,
        )
        for outer, fillet in ((of.step, of.radius), (1.0, 0.0))
    )
    ring = Bearing(
        name="bearing",
        x=of.length * d * (1.0 + of.seat),
        width=0.3 * of.length * d,
        kind="ring",
        raceway_diameter=1.4 * d,
    )
    unit = BearingUnit(bearing=ring, housing=Housing(), interface="spring", stiffness=_SPRINGS)
    return Scene(
        title=f"Shaft with one fillet, {of}",
        shaft=Shaft(front=0.0, sections=(thick, thin)),
        bearing_units=(unit,),
        gearbox=Gearbox(stiffness=(1e6,) * 6),
        mesh=MeshSizes(shaft=0.25 * d),  # within what the thinnest wall allows
    )


def filleted_two_bearings(radius: float) -> Scene:
    """The library's shaft on two bearings with a fillet in its step.

    Parameters
    ----------
    radius : float
        Radius of the fillet [m].
    """
    scene = library_scene("two_bearings")
    first, *others = scene.shaft.sections
    sections = (first.model_copy(update={"fillet": radius}), *others)
    return scene.model_copy(update={"shaft": scene.shaft.model_copy(update={"sections": sections})})


def filleted_scenes() -> dict[str, Scene]:
    """All of `SHAFTS`, and that on two bearings with two radii, by their dimensions in words."""
    found = {str(of): filleted_scene(of) for of in SHAFTS}
    for radius in (0.005, 0.02):
        found[f"two_bearings, radius {radius:g} m"] = filleted_two_bearings(radius)
    return found
