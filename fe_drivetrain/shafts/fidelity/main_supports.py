"""Stiffness of a drivetrain's main bearings with their housings, between its two bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.steps import Clock, Steps
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.fidelity.bearing_units import unit_bounds


@dataclass(frozen=True, eq=False)
class MainSupports:
    """Main bearings with their housings, as `fe_drivetrain.drivetrain_file.main_bearings` takes.

    Attributes
    ----------
    soft : Mapping[str, Floats]
        Stiffness (6, 6) by bearing, the seat moving on average (RBE3): a lower bound for the mesh
        [N/m, N, N m/rad].
    stiff : Mapping[str, Floats]
        The same with a seat that keeps its shape (RBE2): an upper bound.
    meshes : Mapping[str, StiffnessBands]
        Bands of the meshes, relative: by them both may be too stiff.
    left_out : Mapping[str, str]
        Bearings that are their joint alone, in a rigid housing, and why.
    """

    soft: Mapping[str, Floats]
    stiff: Mapping[str, Floats]
    meshes: Mapping[str, StiffnessBands]
    left_out: Mapping[str, str]

    __repr__ = short_repr


def main_supports(
    scene: Scene, cache: Cache | None = None, steps: Clock | None = None
) -> MainSupports:
    """Condense each main bearing's housing to the bearing's seat, by both ways to couple it.

    The shaft keeps the seat in shape, but not wholly: a seat that moves on average is too soft and
    one that is rigid too stiff; that holds for the seats of spring joints, too. Joint, housing,
    further parts and bedplate are in series, see `fe_drivetrain.shafts.fidelity.unit_bounds`. Where
    the joint is "averaged" or "rigid", or the housing is a stiffness alone, both are the same.

    Parameters
    ----------
    scene : Scene
        The drivetrain; its shaft has no part in this but for its seats.
    cache : Cache or None
        Where they may come from, the same to the last bit; the user's if not given.
    steps : Clock or None
        Times the step of each bearing.

    Raises
    ------
    InputError
        A housing cannot be meshed.
    """
    clock = Steps() if steps is None else steps
    left_out = {
        bearing.name: "its nose is rigid here: the joint alone holds the shaft"
        for bearing in scene.nose_bearings
    }
    for group in scene.coupled_units:
        why = f"housings of {', '.join(group)} stand on the same parts, and give together"
        left_out |= dict.fromkeys(group, why)
    soft, stiff, meshes = {}, {}, {}
    for unit in scene.bearing_units:
        name = unit.bearing.name
        if name in left_out:
            continue
        with clock.step(f"housing of {name}"):
            soft[name], stiff[name], meshes[name] = unit_bounds(scene, name, cache, of_springs=True)
    return MainSupports(soft, stiff, meshes, left_out)
