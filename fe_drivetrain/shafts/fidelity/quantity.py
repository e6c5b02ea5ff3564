"""A quantity that a level is asked for: a reaction, or a stiffness at the hub."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.quantity_names import check_reaction
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.fidelity.ladder import LevelModel
from fe_drivetrain.shafts.response.entering import Factors, factor_values
from fe_drivetrain.shafts.response.model import scene_loads

#: Errors of a level in the results of an advice: its own, and that against the last level.
OWN_ERROR = "own error [-]"
ERROR_AGAINST_LAST = "error against the last level [-]"
LEVEL_ERRORS = "errors of levels"


class Reported(Protocol):
    """A quantity that is reported: its name, and the unit of its value."""

    @property
    def name(self) -> str:
        """Name of the quantity."""

    @property
    def unit(self) -> str:
        """Unit of the value."""


@dataclass(frozen=True)
class Quantity:
    """A requested quantity, as a row of numbers that is linear in the loads, or a stiffness.

    Attributes
    ----------
    name : str
        "NAME.Fx" to "NAME.Mz", a reaction of a bearing or of the gearbox; "hub.stiffness.ux" to
        "hub.stiffness.rz", force over motion of the hub, all others of its loads zero.
    load : Factors, Floats or None
        (n,) factors of `model.scene_loads`; None for a reaction to all hub loads, one at a time.
    """

    name: str
    load: Factors | Floats | None = None

    @property
    def factors(self) -> Floats | None:
        """(n,) factors of the load, as an array."""
        return self.load.values if isinstance(self.load, Factors) else self.load

    def check(self, scene: Scene) -> None:
        """Refuse what the scene does not have.

        Raises
        ------
        InputError
            The name is none of the scene's, or `response.factor_values` refuses the load.
        """
        if self.load is not None:
            factor_values(scene, self.load)
        check_reaction(self.name, scene)

    @property
    def unit(self) -> str:
        """Unit of the value."""
        component = self.name.rpartition(".")[2]
        if self.name.startswith("hub.stiffness"):
            return "N/m" if component[0] == "u" else "N m/rad"
        return "N" if component[0] == "F" else "N m"

    def columns(self, length: float, n: int) -> Floats:
        """(n, k) factors of the n unit loads of the scene that each value is of, see `of`."""
        if self.name.startswith("hub.stiffness"):
            return np.eye(n)[:, [MOTIONS.index(self.name.rpartition(".")[2])]]
        if self.factors is not None:
            return self.factors[:, None]
        scale = np.array([1.0, 1.0, 1.0, length, length, length])
        return np.asarray(np.eye(n)[:, :6] * scale)

    def of(self, model: LevelModel, length: float) -> Floats:
        """(k,) its values: one, or one for each hub load, moments counting as length times 1 N."""
        owner, _, component = self.name.partition(".")
        if owner == "hub":
            motion = MOTIONS.index(component.rpartition(".")[2])
            if "hub" not in model.points:
                return np.array([np.nan])
            row = 6 * model.points.index("hub") + motion
            return np.array([1.0 / model.compliance[row, row]])
        row = model.reaction_matrices[owner][FORCES.index(component)]
        if (load := self.factors) is not None:
            # 0 times what is not known is 0
            return np.array([row[load != 0] @ load[load != 0]])
        return np.asarray(row[:6] * np.array([1.0, 1.0, 1.0, length, length, length]))


def named_load(scene: Scene, load: Mapping[str, float]) -> Factors:
    """Factors of the unit loads of a scene, of a load that is given by their names.

    Parameters
    ----------
    scene : Scene
        The scene.
    load : mapping of str to float
        By names of `fe_drivetrain.shafts.response.scene_loads` [N, N m, m/s^2], those at the hub
        about the point where loads enter; those left out are zero.

    Raises
    ------
    InputError
        A name is unknown, or a value is no finite number.
    """
    names = scene_loads(scene)
    for name, value in load.items():
        if name not in names:
            raise InputError(f"load {name!r} is unknown: use one of {', '.join(names)}")
        if not np.isfinite(value):
            raise InputError(f"load {name!r} is {value} but must be finite: give a number")
    return Factors(np.array([load.get(name, 0.0) for name in names]))
