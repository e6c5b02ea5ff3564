"""Random shafts on bearings, inside the limits of what can be built, to measure if bands hold.

Sections of random length and diameter, some tapered, solid or bored, with sharp steps and fillets;
one ring or two on seats. All follows from a seed, so that a shaft can be looked at again.
"""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file import BearingUnit, Gearbox, Scene
from fe_drivetrain.geometry import Bearing, Housing, MeshSizes, Section, Shaft

#: Least step between two diameters, over the largest one, and the range of fillets, over their
#: steps' heights: finer details are possible, and make meshes of many elements.
STEP, FILLETS = 0.08, (0.5, 0.9)
#: Elements of the solid's mesh: size over the largest diameter, and how many round a turn.
SIZES, TURNS = (0.25, 0.5), (8, 13)
#: Springs of joints and gearbox [N/m, N m/rad]: no part of a free shaft.
_JOINT = (1e9, 1e9, 1e9, 0.0, 1e7, 1e7)


def random_scene(seed: int) -> Scene:
    """A random shaft with one ring or two on it.

    Parameters
    ----------
    seed : int
        Of the random numbers; the same seed makes the same scene.

    Returns
    -------
    Scene
        Rings are cylinders of the shaft's steel on spring joints, so that meridian and solid are
        the same body.
    """
    rng = np.random.default_rng(seed)
    while True:
        try:
            return _drawn(rng, seed)
        except InputError:  # a fillet that is too large for its step, a seat beside a fillet
            continue


def _drawn(rng: np.random.Generator, seed: int) -> Scene:
    widest = float(rng.uniform(0.3, 1.0))
    count = int(rng.integers(2, 5))
    seats = sorted(rng.choice(count, size=int(rng.integers(1, min(count, 3))), replace=False))
    bore = float(rng.uniform(0.1, 0.35)) * widest if rng.random() < 0.6 else 0.0
    sections: list[Section] = []
    outer = widest * float(rng.uniform(0.6, 1.0))
    for number in range(count):
        end = None
        if number not in seats and rng.random() < 0.3:
            end = _other(rng, widest, outer)
        after = _other(rng, widest, outer if end is None else end)
        step = abs(after - (outer if end is None else end)) / 2
        filleted = number < count - 1 and rng.random() < 0.3
        sections.append(
            Section(
                length=widest * float(rng.uniform(0.4, 1.5)),
                outer_diameter=outer,
                outer_diameter_end=end,
                inner_diameter=_bore(rng, bore),
                fillet=step * float(rng.uniform(*FILLETS)) if filleted else 0.0,
            )
        )
        outer = after
    shaft = Shaft(front=0.0, sections=tuple(sections))
    units = tuple(_unit(rng, f"bearing_{k + 1}", shaft, int(seat)) for k, seat in enumerate(seats))
    size = float(rng.uniform(*SIZES)) * widest
    return Scene(
        title=f"Random shaft {seed}",
        shaft=shaft,
        bearing_units=units,
        gearbox=Gearbox(stiffness=(1e6, 1e6, 1e6, 1e6, 1e6, 1e6)),
        mesh=MeshSizes(
            shaft=size,
            bearing=0.5 * size,
            housing=size,
            bearing_edge=0.4 * size,
            elements_per_turn=int(rng.integers(*TURNS)),
        ),
    )


def _other(rng: np.random.Generator, widest: float, diameter: float) -> float:
    """A diameter at least a `STEP` away."""
    while True:
        found = widest * float(rng.uniform(0.6, 1.0))
        if abs(found - diameter) > STEP * widest:
            return found


def _bore(rng: np.random.Generator, bore: float) -> float:
    """The bore of one section: at times it is wider there."""
    return bore * float(rng.uniform(1.1, 1.3)) if bore > 0 and rng.random() < 0.25 else bore


def _unit(rng: np.random.Generator, name: str, shaft: Shaft, seat: int) -> BearingUnit:
    section, start = shaft.sections[seat], shaft.stations[seat]
    width = section.length * float(rng.uniform(0.25, 0.6))
    bearing = Bearing(
        name=name,
        x=start + section.length / 2,
        width=width,
        kind="ring",
        raceway_diameter=section.outer_diameter * float(rng.uniform(1.3, 1.6)),
    )
    shaft.seat_diameter(bearing.x, width, name)
    return BearingUnit(bearing=bearing, housing=Housing(), interface="spring", stiffness=_JOINT)
