"""Which detail of a scene matters: each one switched off by itself, ranked by its effect."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.fidelity.ladder import housing_springs, shaft_level
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.fidelity.shafts import (
    beam_shaft,
    condensed_shaft,
    meridian_shaft,
    ringed_shaft,
)


@dataclass(frozen=True)
class Effect:
    """What a quantity does when one detail is left out.

    Attributes
    ----------
    detail : str
        What was left out.
    change : float
        Change of the quantity, relative: with its sign for one load, else of the whole row.
    """

    detail: str
    change: float


def effects(
    scene: Scene,
    quantity: Quantity,
    level: int,
    housings: Mapping[str, Floats],
    report: Callable[[str], object] = lambda step: None,
) -> list[Effect]:
    """The effect of each detail at one level, largest first.

    Parameters
    ----------
    scene : Scene
        The scene.
    quantity : Quantity
        What is asked for.
    level : int
        1 or 2, see `ladder.shaft_level`.
    housings : Mapping[str, Floats]
        Stiffness of each bearing unit, faces held in shape (`bearing_units.unit_stiffness`).
    """
    length = scene.shaft.length
    whole = condensed_shaft(scene, level)
    base = shaft_level(scene, level, housings, whole)
    reference = quantity.of(base, length)
    found = []

    def add(detail: str, values: Floats) -> None:
        change = values - reference
        if len(change) == 1:
            share = float(change[0] / reference[0])
        else:
            share = float(np.linalg.norm(change) / np.linalg.norm(reference))
        found.append(Effect(detail, share))

    for detail, simpler in simplified(scene).items():
        report(f"without {detail}")
        add(detail, quantity.of(shaft_level(simpler, level, housings), length))
    report("without the housings' flexibility")
    on_bedplates = any(unit.bedplate is not None for unit in scene.bearing_units)
    under = " and bedplates" if on_bedplates else ""
    rigid = shaft_level(scene, level, body=whole)
    add(f"flexibility of housings{under}", quantity.of(rigid, length))
    if on_bedplates:
        report("without the bedplates' flexibility")
        springs = housing_springs(_on_the_ground(scene), coupling="rigid")[0]
        add(
            "flexibility of bedplates",
            quantity.of(shaft_level(scene, level, springs, whole), length),
        )
    if any(unit.ring_on_housing for unit in scene.bearing_units):
        report("with rigid bearing rings")
        springs = housing_springs(scene, "rigid", level=3)[0]  # a solid shaft has the rings
        rigid = shaft_level(scene, level, springs, whole)
        add("flexibility of bearing rings", quantity.of(rigid, length))
    for detail, stiffness in _gearboxes(scene).items():
        other = scene.gearbox.model_copy(update={"stiffness": stiffness})
        changed = scene.model_copy(update={"gearbox": other})
        try:
            add(detail, quantity.of(shaft_level(changed, level, housings, whole), length))
        except InputError:  # nothing else holds the shaft
            continue
    for detail, body in _other_bodies(scene, level).items():
        add(detail, quantity.of(shaft_level(scene, level, housings, body), length))
    for detail, load in _lighter(quantity).items():
        add(detail, Quantity(quantity.name, load).of(base, length))
    return sorted(found, key=lambda effect: -abs(effect.change))


def _other_bodies(scene: Scene, level: int) -> dict[str, Condensed]:
    """The shaft without its rings, and without shear."""
    condense = beam_shaft if level == 1 else meridian_shaft
    bodies = {}
    if ringed_shaft(scene)[1]:
        bodies["rings on the shaft"] = condense(scene, rings=False)
    if level == 1:
        bodies["shear deformation"] = beam_shaft(scene, shear=False)
    return bodies


def _lighter(quantity: Quantity) -> dict[str, Floats]:
    """Factors of the load without each weight that is in it."""
    loads: dict[str, Floats] = {}
    if (given := quantity.factors) is not None:
        for detail, columns in (("self-weight", slice(6, 9)), ("gearbox weight", slice(9, 10))):
            if np.any(given[columns]):
                loads[detail] = given.copy()
                loads[detail][columns] = 0.0
    return loads


def simplified(scene: Scene) -> dict[str, Scene]:
    """The scene without each detail of its shaft that it has."""
    shaft = scene.shaft
    found = {}
    plain = tuple(s.model_copy(update={"fillet": 0.0}) for s in shaft.sections)
    flange = shaft.flange
    if any(piece.fillet > 0 for piece in shaft.pieces):
        sharp = None if flange is None else flange.model_copy(update={"fillet": 0.0})
        found["fillets"] = {"sections": plain, "flange": sharp}
    if any(piece.inner_diameter > 0 for piece in shaft.pieces):
        solid = tuple(s.model_copy(update={"inner_diameter": 0.0}) for s in shaft.sections)
        found["bore"] = {"sections": solid}
    if flange is not None:
        first, *others = shaft.sections
        longer = first.model_copy(update={"length": first.length + flange.thickness})
        found["flange"] = {"sections": (longer, *others), "flange": None}
    return {
        detail: scene.model_copy(update={"shaft": shaft.model_copy(update=change)})
        for detail, change in found.items()
    }


def _on_the_ground(scene: Scene) -> Scene:
    """The scene with no bedplate under its housings."""
    units = [unit.model_copy(update={"bedplate": None}) for unit in scene.bearing_units]
    return scene.model_copy(update={"bearing_units": tuple(units)})


def _gearboxes(scene: Scene) -> dict[str, Sequence[float | str]]:
    """Gearbox springs taken away, and made rigid."""
    stiffness = scene.gearbox.stiffness
    springs = [k not in (0, "rigid") for k in stiffness]
    if not any(springs):
        return {}
    return {
        "gearbox springs (free)": tuple(
            0.0 if s else k for k, s in zip(stiffness, springs, strict=True)
        ),
        "flexibility of gearbox springs (rigid)": tuple(
            "rigid" if s else k for k, s in zip(stiffness, springs, strict=True)
        ),
    }
