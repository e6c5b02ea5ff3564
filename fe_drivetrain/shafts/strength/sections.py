"""Sections of a shaft that are assessed: steps, seats, notches, and the shaft between them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.shaft_strength import ShaftStrength
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Shaft
from fe_drivetrain.shafts.strength.fillet_stress import Shoulder
from fe_drivetrain.shafts.strength.notches import moduli

NO_FILLET = "no fillet is stated, and stress at a sharp corner has no limit"


@dataclass(frozen=True)
class ShaftSection:
    """A section that is assessed.

    Attributes
    ----------
    name : str
        Name, with its place.
    x : float
        Where it is [m].
    kind : str
        "plain", "shoulder", "groove", "hole", "keyway", "two keyways" or "press fit".
    diameter, bore : float
        Those of the nominal stress [m].
    raw : float
        Diameter at the heat treatment, the largest of those beside it [m].
    depth, radius : float
        Size of the notch [m]; 0 where it has none.
    wide_bore : float
        Bore beside a shoulder, under its wider side [m].
    """

    name: str
    x: float
    kind: str
    diameter: float
    bore: float
    raw: float
    depth: float = 0.0
    radius: float = 0.0
    wide_bore: float = 0.0

    @property
    def hollow(self) -> bool:
        """Whether the shaft is bored there."""
        return self.bore > 0.0

    @property
    def moduli(self) -> Floats:
        """(3,) area [m^2], section moduli of bending and torsion [m^3]."""
        return moduli(self.diameter, self.bore, self.radius if self.kind == "hole" else 0.0)

    @property
    def shoulder(self) -> Shoulder:
        """The step, of a shoulder."""
        wide = self.diameter + 2.0 * self.depth
        return Shoulder(self.diameter, wide, self.radius, self.bore, self.wide_bore)


def shaft_sections(
    scene: Scene, strength: ShaftStrength
) -> tuple[list[ShaftSection], dict[str, str]]:
    """Sections of the main shaft that are assessed, from front to rear.

    Parameters
    ----------
    scene : Scene
        The scene.
    strength : ShaftStrength
        Names notches and press fits beside the steps, and how seats of bearings count.

    Returns
    -------
    sections : list of ShaftSection
        Those that can be rated.
    left_out : dict of str to str
        Why others cannot, by name.
    """
    found, left_out = list[ShaftSection](), dict[str, str]()
    for section in _steps(scene.shaft):
        if section.radius > 0.0:
            found.append(section)
        else:
            left_out[section.name] = NO_FILLET
    found += _seats(scene, strength)
    found += _notches(scene.shaft, strength)
    found += [
        _plain(scene.shaft, f"shaft in the middle of {unit.bearing.name}", unit.bearing.x)
        for unit in scene.bearing_units
    ]
    found += [
        _plain(scene.shaft, f"shaft over the middle of {bearing.name}", bearing.x)
        for bearing in scene.nose_bearings
    ]
    return sorted(found, key=lambda one: one.x), left_out


def _steps(shaft: Shaft) -> Iterator[ShaftSection]:
    for (one, two), x in zip(pairwise(shaft.pieces), shaft.stations[1:], strict=False):
        before, after = one.end_diameter, two.outer_diameter
        if abs(before - after) < LENGTH_TOLERANCE:
            continue
        thin, wide = (two, one) if before > after else (one, two)
        low, high = min(before, after), max(before, after)
        yield ShaftSection(
            f"step at x = {x:.4g} m",
            x,
            "shoulder",
            low,
            thin.inner_diameter,
            high,
            (high - low) / 2.0,
            one.fillet,
            wide.inner_diameter,
        )


def _seats(scene: Scene, strength: ShaftStrength) -> Iterator[ShaftSection]:
    """Ends of seats of bearings, and of hubs on press fits, where they are on the shaft."""
    spans = [
        (fit.name, fit.x - fit.length / 2, fit.x + fit.length / 2) for fit in strength.press_fits
    ]
    if strength.bearing_seats == "press fit":
        spans += [(unit.bearing.name, *unit.bearing.span) for unit in scene.bearing_units]
    shaft = scene.shaft
    for name, low, high in spans:
        diameter = shaft.seat_diameter((low + high) / 2, high - low, name)
        for word, x in (("front", low), ("rear", high)):
            if shaft.front + LENGTH_TOLERANCE < x < shaft.rear - LENGTH_TOLERANCE:
                bore = 2.0 * shaft.inner_radius(x)
                yield ShaftSection(
                    f"{word} end of {name}'s seat", x, "press fit", diameter, bore, diameter
                )


def _notches(shaft: Shaft, strength: ShaftStrength) -> Iterator[ShaftSection]:
    for notch in strength.notches:
        outer, bore = 2.0 * shaft.outer_radius(notch.x), 2.0 * shaft.inner_radius(notch.x)
        depth = notch.depth or 0.0
        yield ShaftSection(
            notch.name,
            notch.x,
            notch.kind,
            outer - 2.0 * depth,
            bore,
            outer,
            depth,
            notch.radius or 0.0,
        )


def _plain(shaft: Shaft, name: str, x: float) -> ShaftSection:
    outer = 2.0 * shaft.outer_radius(x)
    return ShaftSection(name, x, "plain", outer, 2.0 * shaft.inner_radius(x), outer)
