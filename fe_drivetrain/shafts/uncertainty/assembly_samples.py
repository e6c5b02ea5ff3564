"""Samples at level 4: assemblies of solids, each solved from what its neighbours have left.

Samples lie near each other. Their meshes are the nominal one's with nodes that move as dimensions
do, and moduli, densities and springs need no other mesh at all; see
`fe_drivetrain.shafts.response.neighbours`. Only those unit loads are solved that are asked for.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.fidelity.assembly_bands import AssemblyBand
from fe_drivetrain.shafts.fidelity.assembly_series import banded_assembly
from fe_drivetrain.shafts.fidelity.ladder import TITLES, Cost, LevelModel
from fe_drivetrain.shafts.fidelity.quantities import Number, Solved, numbers, without_zeros
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.entering import Factors
from fe_drivetrain.shafts.response.model import scene_loads
from fe_drivetrain.shafts.response.neighbours import Neighbours, Reuse
from fe_drivetrain.shafts.response.prepared import STOP_AT
from fe_drivetrain.shafts.response.unit_loads import some_responses

SAMPLED_ERROR = 1e-6
"""Error of a sampled number by its iteration, relative: far below any band of samples."""

_HUB = tuple(f"hub.stiffness.{motion}" for motion in MOTIONS)


@dataclass(frozen=True, eq=False)
class AssemblySamples:
    """An assembly of solids that is solved again and again.

    Attributes
    ----------
    numbers : Sequence[Number]
        What is reported, first what was asked for.
    bands : Sequence[AssemblyBand]
        How far each is from element size zero, without any uncertain value.
    columns : tuple[int, ...]
        Unit loads that are solved.
    neighbours : Neighbours
        What samples so far have left.
    """

    numbers: Sequence[Number]
    bands: Sequence[AssemblyBand]
    columns: tuple[int, ...]
    neighbours: Neighbours

    def sampled(self, scene: Scene) -> dict[str, float]:
        """The numbers of a sampled scene by name, each with an error of about `SAMPLED_ERROR`."""
        return self.evaluate(
            scene, SAMPLED_ERROR if self._has_reactions else math.sqrt(SAMPLED_ERROR)
        )

    def evaluate(self, scene: Scene, tolerance: float = STOP_AT) -> dict[str, float]:
        """The numbers of a scene, by name.

        Parameters
        ----------
        scene : Scene
            The scene.
        tolerance : float
            Error of its solutions, relative in the energy norm. That of a stiffness is its square.

        Raises
        ------
        InputError
            It is no scene that can be meshed and solved.
        """
        model = self.neighbours.model(scene, tolerance)
        reactions, motions = some_responses(model, self.columns, forces=self._has_reactions)
        names = (*scene.bearing_names, "gearbox")
        level = LevelModel(
            4,
            TITLES[4],
            (),
            Cost(0.0, model.n_dofs),
            {name: reactions[name] for name in names if name in reactions},
            ("hub",),
            motions["hub"][:, :6],
            scene.entrance,
        )
        solved = Solved(None, {}, level)
        return {number.name: number.of(solved) for number in self.numbers}

    @property
    def _has_reactions(self) -> bool:
        return any(not number.name.startswith("hub.") for number in self.numbers)


def assembly_of(
    scene: Scene,
    asked: Sequence[str] = (),
    load: Factors | Floats | None = None,
    report: Progress = silent,
) -> AssemblySamples:
    """Solve the assembly without any uncertain value, with the bands of its numbers.

    Parameters
    ----------
    scene : Scene
        The scene.
    asked : Sequence[str]
        Reactions and stiffnesses at the hub, before all stiffnesses at the hub.
    load : Factors, Floats or None
        (n,) factors of `model.scene_loads`, for reactions.
    report : Progress
        Called with what is being done.

    Raises
    ------
    InputError
        A name is unknown, its number is zero, or it is none of an assembly.
    """
    found = numbers(scene, [*asked, *(name for name in _HUB if name not in asked)], load)
    alone = [number.name for number in found if number.quantity is None]
    if alone:
        raise InputError(
            f"{argument('level', 4)} has no stiffness of a part by itself, {alone[0]}: ask for a "
            "reaction or a stiffness at the hub, or use 1 (beam) or 2 (meridian)"
        )
    quantities = [q for number in found if (q := number.quantity) is not None]
    level, _, bands = banded_assembly(scene, quantities, report)
    kept = without_zeros(found, Solved(None, {}, level))
    names = [number.name for number in kept]
    columns = sorted({int(c) for q in quantities for c in np.flatnonzero(_columns(scene, q))})
    return AssemblySamples(
        kept,
        [band for number, band in zip(found, bands, strict=True) if number.name in names],
        tuple(columns),
        Neighbours(Reuse(known=SAMPLED_ERROR)),
    )


def _columns(scene: Scene, quantity: Quantity) -> Floats:
    """(n,) sizes of the unit loads that a quantity needs; a stiffness that of all at the hub."""
    n = len(scene_loads(scene))
    return np.asarray(np.abs(quantity.columns(scene.shaft.length, n)).sum(axis=1))
