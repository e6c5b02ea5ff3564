"""What the loads of a table or page are: one record, which headers, pages and data all quote."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.drivetrain_file.scene import Scene


@dataclass(frozen=True)
class Stated:
    """All that a reader has to know of loads besides their numbers.

    Attributes
    ----------
    load : str
        Who puts it on whom, which is its sign.
    origin : str
        Points that moments are about.
    weight : str
        Which weights are in it.
    frame : str
        Directions of the axes.
    """

    load: str
    origin: str
    weight: str
    frame: str = "x downwind along the shaft, z up, y = z cross x; it does not turn with the rotor"

    def facts(self) -> dict[str, str]:
        """Lines before a table, by their keys."""
        return {
            "load": self.load,
            "frame": self.frame,
            "origin of moments": self.origin,
            "weight": self.weight,
        }

    def sentences(self) -> str:
        """The same for a page."""
        first, rest = self.load[0].upper(), self.load[1:]
        return f"{first}{rest}. Weight: {self.weight}. Frame: {self.frame}. Moments: {self.origin}."


HUB_LOADS = Stated(
    "the rotor's on the shaft",
    "about the hub, the apex of the rotor; those of a table are taken to be so, unless the key "
    "moments_at of a mapping says another point",
    "that of the rotor as far as the files have it, and no other",
)
"""Loads at the hub as files have them, before they act on a scene."""


def stated_hub_loads(scene: Scene | None) -> Stated:
    """What hub loads of files are, beside a scene that may say which point they are about."""
    if scene is None or not scene.entrance.elsewhere:
        return HUB_LOADS
    at = f"as in the files, about x = {scene.entrance.loads_at:g} m (hub.loads_at of the scene)"
    return replace(HUB_LOADS, origin=at)


def stated_reactions(scene: Scene, masses: Mapping[str, float], gravity: float = GRAVITY) -> Stated:
    """What the reactions of a scene are.

    Parameters
    ----------
    scene : Scene
        With its bearings, and the weights of gearbox and load points [N].
    masses : Mapping
        Masses of parts whose weight reactions have, by name [kg]; "nose" is in none.
    gravity : float
        0 where all weights are left out [m/s^2].
    """
    at = {unit.bearing.name: unit.bearing.x for unit in scene.bearing_units}
    at |= {bearing.name: bearing.x for bearing in scene.nose_bearings}
    places = [f"{name} at x = {x:g} m" for name, x in at.items()]
    places.append(f"gearbox at x = {scene.shaft.rear:g} m")
    return Stated(
        "what the drivetrain puts on its supports",
        f"on the shaft's axis, about each bearing's centre: {', '.join(places)}",
        _weight(scene, masses, gravity),
    )


def _weight(scene: Scene, masses: Mapping[str, float], gravity: float) -> str:
    of_rotor = "that of the rotor as far as the hub loads have it"
    if gravity == 0.0:
        return f"left out, but for {of_rotor}"
    found = {name: gravity * mass for name, mass in masses.items() if name != "nose"}
    found |= {"gearbox": scene.gearbox.weight} | {p.name: p.weight for p in scene.load_points}
    parts = ", ".join(f"{name} {weight / 1e3:.4g} kN" for name, weight in found.items())
    words = f"included along -z: {parts}; {of_rotor}"
    if any(unit.housing_parts for unit in scene.bearing_units):
        words += (
            "; a bearing's Fz has the weight of its own ring and housing, which its rollers do not "
            "feel"
        )
    if scene.nose is not None:
        size = f", {gravity * masses['nose'] / 1e3:.4g} kN," if "nose" in masses else ""
        words += (
            f"; that of the nose{size} goes into what holds it, and its sag alone is felt by the "
            "bearings"
        )
    return words
