"""Reported quantities of a scene, by name: all from one solution at one level.

Reactions, stiffness at the hub, and the values of the exported summary for the shaft and
each bearing unit, under the same names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.bearing_unit import SPHERICAL_JOINTS
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.solve.condensation import Condensed, keep_points
from fe_drivetrain.shafts.fidelity.ladder import LevelModel
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.entering import Factors, factor_values
from fe_drivetrain.shafts.response.model import LOADS, scene_loads

#: Of the free shaft between hub and gearbox, the gearbox end held; place among six components.
SHAFT = {"axial": 0, "lateral": 2, "torsional": 3, "bending": 4}

#: A housing's mesh is not quite symmetric: reactions that are less, of a load, are zero.
NOISE = 1e-3

_CARRIES = 1e-6  # of the largest resistance: below it there is none
_LEVER = 1e-4  # [m] what springs of a unit do at this distance is no resistance to a rotation

#: Of a bearing with its housing; tilt and yaw are K_R about y and z.
UNIT = {"axial": 0, "radial_y": 1, "radial_z": 2, "tilt": 4, "yaw": 5}


@dataclass(frozen=True)
class Solved:
    """A scene at level 1 or 2, with what it was put together from, or as an assembly.

    Attributes
    ----------
    body : Condensed or None
        The free shaft; None of an assembly.
    springs : Mapping[str, Floats]
        (6, 6) stiffness of each bearing unit; empty of an assembly.
    model : LevelModel
        The shaft on them.
    """

    body: Condensed | None
    springs: Mapping[str, Floats]
    model: LevelModel


@dataclass(frozen=True)
class Number:
    """One number that is reported.

    Attributes
    ----------
    name : str
        "main_bearing.My" for the load given, "main_bearing.My of hub.Fz" for a unit of one load,
        "hub.stiffness.uz", "shaft.torsional", "main_bearing.tilt".
    unit : str
        Unit of the value.
    of : callable
        Its value for a solved scene.
    quantity : Quantity or None
        The adviser's name for it, if the adviser knows it.
    """

    name: str
    unit: str
    of: Callable[[Solved], float]
    quantity: Quantity | None = None


def shaft_numbers(body: Condensed) -> dict[str, float]:
    """Stiffness of a free shaft from hub to gearbox, that end held [N/m, N m/rad]; see `SHAFT`."""
    # what is left of the free shaft's stiffness is the hub's
    compliance = np.linalg.inv(keep_points(body, ["hub", "gearbox"]).stiffness[:6, :6])
    return {name: float(1.0 / compliance[c, c]) for name, c in SHAFT.items()}


def carried_root(stiffness: Floats) -> Floats:
    """(6, r) R with R R^T = stiffness, r of six motions being resisted."""
    size, values, vectors = _resisted(stiffness)
    return np.asarray(size[:, None] * vectors * np.sqrt(values))


def unit_numbers(stiffness: Floats) -> dict[str, float]:
    """Stiffness of a bearing unit, force over motion, all other loads zero [N/m, N m/rad].

    0 where such a force meets a motion that nothing resists; see `UNIT`.
    """
    size, values, vectors = _resisted(stiffness)
    held = (vectors**2).sum(axis=1) > 1.0 - _CARRIES
    compliance = (vectors**2 / values).sum(axis=1)
    return {
        name: float(size[c] ** 2 / compliance[c]) if held[c] else 0.0 for name, c in UNIT.items()
    }


def _resisted(stiffness: Floats) -> tuple[Floats, Floats, Floats]:
    """Sizes (6,), and eigenvalues (r,) and vectors (6, r) other than zero of K scaled by them."""
    size = np.sqrt(stiffness.diagonal())
    size[:3] *= size[:3] > _CARRIES * size[:3].max()
    size[3:] *= size[3:] > _LEVER * size[:3].max()
    scale = np.where(size > 0.0, size, np.inf)
    values, vectors = np.linalg.eigh(stiffness / np.outer(scale, scale))
    carried = values > _CARRIES * values[-1]
    return size, values[carried], vectors[:, carried]


def known_names(scene: Scene) -> list[str]:
    """All that can be asked of a scene."""
    names = [f"{name}.{c}" for name in (*scene.bearing_names, "gearbox") for c in FORCES]
    return names + stiffness_names(scene)


def stiffness_names(scene: Scene) -> list[str]:
    """Every stiffness that is reported: of the hub on its supports, of the shaft, of each unit."""
    names = [f"hub.stiffness.{motion}" for motion in MOTIONS]
    names += [f"shaft.{name}" for name in SHAFT]
    for unit in scene.bearing_units:
        carried = 3 if unit.interface in SPHERICAL_JOINTS else 6
        names += [f"{unit.bearing.name}.{name}" for name, c in UNIT.items() if c < carried]
    return names


def numbers(
    scene: Scene, names: Sequence[str], load: Factors | Floats | None = None
) -> list[Number]:
    """The numbers of these names.

    Parameters
    ----------
    scene : Scene
        The scene.
    names : Sequence[str]
        Names from `known_names`.
    load : Factors, Floats or None
        (n,) factors of `model.scene_loads`, for reactions; else a reaction stands for six
        numbers, one for a unit of each hub load.

    Raises
    ------
    InputError
        A name is unknown, or `response.factor_values` refuses the load.
    """
    known = known_names(scene)
    given = None if load is None else factor_values(scene, load)
    found: list[Number] = []
    for name in dict.fromkeys(names):
        if name not in known:
            raise InputError(f"quantity {name!r} is unknown: use one of {', '.join(known)}")
        owner, _, part = name.partition(".")
        if owner == "shaft":
            unit = "N/m" if part in ("axial", "lateral") else "N m/rad"
            found.append(Number(name, unit, _of_shaft(part)))
        elif part in UNIT:
            unit = "N m/rad" if part in ("tilt", "yaw") else "N/m"
            found.append(Number(name, unit, _of_unit(owner, part)))
        elif owner == "hub":
            found.append(_of_model(name, Quantity(name)))
        elif given is not None:
            found.append(_of_model(name, Quantity(name, given)))
        else:
            for column, of in enumerate(LOADS[:6]):
                one = np.zeros(len(scene_loads(scene)))
                one[column] = 1.0
                found.append(_of_model(f"{name} of {of}", Quantity(name, one), of))
    return found


def without_zeros(found: Sequence[Number], solved: Solved) -> list[Number]:
    """The numbers that are not zero: what is zero has no relative change.

    Raises
    ------
    InputError
        The load given makes a reaction zero, or no hub load makes it anything else.
    """
    kept = [number for number in found if not _vanishes(number, solved)]
    for number in found:
        asked = number.name.partition(" of ")[0]
        if asked not in {other.name.partition(" of ")[0] for other in kept}:
            raise InputError(
                f"quantity {asked!r} is zero at level {solved.model.level} for the load given: "
                "ask for another, or give another load"
            )
    return kept


def _vanishes(number: Number, solved: Solved) -> bool:
    value = abs(number.of(solved))
    load = None if number.quantity is None else number.quantity.factors
    if load is None:
        return value == 0.0
    # against the largest reaction to any of the loads
    size = max(
        float(np.abs(matrix[:, load != 0] * load[load != 0]).max())
        for matrix in solved.model.reaction_matrices.values()
    )
    return value <= NOISE * size


def _of_shaft(part: str) -> Callable[[Solved], float]:
    def of(solved: Solved) -> float:
        assert solved.body is not None
        return shaft_numbers(solved.body)[part]

    return of


def _of_unit(owner: str, part: str) -> Callable[[Solved], float]:
    return lambda solved: unit_numbers(solved.springs[owner])[part]


def _of_model(name: str, quantity: Quantity, per: str = "") -> Number:
    unit = quantity.unit
    if per:
        unit += " for 1 N" if per[-2] == "F" else " for 1 N m"
    # one number: no length is needed to weigh moments against forces
    return Number(name, unit, lambda solved: float(quantity.of(solved.model, 1.0)[0]), quantity)
