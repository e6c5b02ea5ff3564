"""What a file states of the bearing units in its stiffness: which bound they are, and rollers."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.drivetrain_file.joint_springs import spring_matrix
from fe_drivetrain.drivetrain_file.scene import Coupling, Scene
from fe_drivetrain.shafts.fidelity.unit_faces import face_of

_MOVES: dict[Coupling, str] = {
    "rigid": "keeps its shape (RBE2)",
    "averaged": "moves on average (RBE3)",
}


def stated_bound(scene: Scene, names: Sequence[str], ring: bool = True) -> str:
    """Which of its two bounds the stiffness of bearing units is written at, in words.

    Parameters
    ----------
    scene : Scene
        The scene.
    names : Sequence[str]
        Names of bearings whose units are written at the stiff bound, where they have two.
    ring : bool
        Whether their rings give, see `fe_drivetrain.shafts.fidelity.bearing_units.unit_stiffness`.
    """

    def of_unit(name: str) -> str:
        if scene.bearing_unit(name).condensed is not None:
            return "the only one, for the stiffness of the housing is taken as it is given"
        stiff, soft = (face_of(scene, name, ring, way)[1] for way in ("rigid", "averaged"))
        if stiff == soft:
            return f"the only one, for the joint itself says that its face {_MOVES[stiff]}"
        return (
            f"stiff: the face to the shaft {_MOVES[stiff]}; at the soft bound, which the band "
            f"reaches to, it {_MOVES[soft]}"
        )

    return _of_each(names, of_unit)


def stated_rollers(scene: Scene, names: Sequence[str]) -> str:
    """Whether rollers give in the stiffness of bearing units, in words.

    Parameters
    ----------
    scene : Scene
        The scene.
    names : Sequence[str]
        Names of their bearings.
    """
    return _of_each(names, lambda name: _rollers(scene.bearing_unit(name)))


def stated_of_drivetrain(scene: Scene, level: int) -> tuple[str, str]:
    """Bound and rollers of the units of a whole drivetrain; empty without units.

    Parameters
    ----------
    scene : Scene
        The scene.
    level : int
        Level of the ladder; up to 3 each unit is at its stiff bound.
    """
    names = [unit.bearing.name for unit in scene.bearing_units]
    if not names:
        return "", ""
    bound = "the only one, for shaft, bearings and housings are solved together"
    if level < 4:
        bound = stated_bound(scene, names, ring=level < 3)
    return bound, stated_rollers(scene, names)


def _rollers(unit: BearingUnit) -> str:
    if (rollers := unit.rollers) is not None:
        rows = len(rollers.rows)
        return (
            f"in the stiffness: {rows} row{'s' * (rows > 1)} of {rollers.count}, each roller a "
            f"spring of {rollers.stiffness:g} N/m along its line of contact"
        )
    if unit.interface == "spring":
        if any(value < float("inf") for value in spring_matrix(unit).diagonal()):
            return "in the stiffness only as the drivetrain file's spring of the joint has them"
        return "not in the stiffness: the joint is rigid"
    if unit.interface == "bonded":
        return "not in the stiffness: the ring is bonded to the housing"
    return "not in the stiffness: the joint carries forces without giving, and no moment"


def _of_each(names: Sequence[str], of_unit: Callable[[str], str]) -> str:
    """What holds of each unit, once for all of which it is the same."""
    found: dict[str, list[str]] = {}
    for name in names:
        found.setdefault(of_unit(name), []).append(name)
    if len(found) == 1:
        return next(iter(found))
    return "; ".join(f"of {', '.join(whose)} {text}" for text, whose in found.items())
