"""What the adviser answers: results of levels of rising cost, and the cheapest that is enough."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.geometry import MeshSizes
from fe_drivetrain.plots.figures import error_against_time
from fe_drivetrain.shafts.fidelity.assembly_bands import AssemblyBand, finer_mesh
from fe_drivetrain.shafts.fidelity.judgement import SLIGHT
from fe_drivetrain.shafts.fidelity.ladder import LevelModel
from fe_drivetrain.shafts.fidelity.quantity import Quantity


@dataclass(frozen=True)
class LevelResult:
    """Result of one model on the ladder, and its difference to the top.

    Attributes
    ----------
    model : LevelModel
        The model that was solved.
    values : Floats
        Values of the quantity.
    seconds : float
        Wall time of all that its value needs; what its estimate takes comes on top.
    waited : float
        Wall time from the beginning to its estimate: what a user waits for this answer.
    estimate : float
        Error expected before any more expensive model is run, relative: 0 where statics decides;
        half the range of its two bounds and the change from beam to meridian where housings are
        springs; the band of the mesh where it is the assembly; NaN where it has none.
    error : float
        Difference to the last result, relative.
    band : AssemblyBand or None
        What the estimate of the assembly rests on.
    """

    model: LevelModel
    values: Floats
    seconds: float
    estimate: float
    waited: float = 0.0
    error: float = float("nan")
    band: AssemblyBand | None = None

    __repr__ = short_repr


@dataclass(frozen=True)
class Advice:
    """The ladder as far as it was run.

    Attributes
    ----------
    quantity, tolerance : Quantity, float
        What was asked, the tolerance relative.
    results : Sequence[LevelResult]
        From cheap to expensive.
    chosen : int or None
        Index of the cheapest result that is within the tolerance; None where none is.
    springs : Mapping[str, Floats]
        Stiffness of the bearing units, faces held in shape, where the ladder went so far.
    share : float
        Size of a reaction over that of the largest of its kind (force or moment); 1 of a stiffness.
    sizes : MeshSizes or None
        Element sizes of the assembly.
    kept : float
        Wall time of what was solved before: it is among the times of the levels [s].
    """

    quantity: Quantity
    tolerance: float
    results: Sequence[LevelResult]
    chosen: int | None
    springs: Mapping[str, Floats] = field(default_factory=dict)
    share: float = 1.0
    sizes: MeshSizes | None = None
    kept: float = 0.0

    __repr__ = short_repr

    @property
    def top(self) -> LevelResult:
        """The most expensive model that was run."""
        return self.results[-1]

    def step(self, number: int) -> float:
        """Difference of a result to the next one, relative to that; NaN of the last."""
        if number == len(self.results) - 1:
            return float("nan")
        return relative_difference(self.results[number].values, self.results[number + 1].values)

    def plot(self) -> Any:
        """Error of each level over its time, as a Plotly figure; the chosen one drawn larger.

        Returns
        -------
        plotly.graph_objects.Figure
            See `fe_drivetrain.plots.error_against_time`; of the last level its estimated own error.
        """
        name = self.quantity.name
        return error_against_time(*self.ladder, self.tolerance, self.chosen, name, self.bands)

    @property
    def bands(self) -> list[float]:
        """Estimated own error of each level but the last, whose error that is already."""
        return [*(result.estimate for result in self.results[:-1]), 0.0]

    @property
    def ladder(self) -> tuple[list[str], list[float], list[float]]:
        """Name, time [s] and relative error of each level; of the last one its own error."""
        return (
            [f"level {result.model.level}, {result.model.title}" for result in self.results],
            [result.seconds for result in self.results],
            [*(result.error for result in self.results[:-1]), self.top.estimate],
        )

    def sentence(self) -> str:
        """The answer."""
        return self._answer() + self._slight()

    def _slight(self) -> str:
        """Note on a reaction by which a study would judge no level."""
        if not self.share < SLIGHT:
            return ""
        kind = "force" if self.quantity.unit == "N" else "moment"
        return (
            f" {self.quantity.name} is {100 * self.share:.2g} % of the largest {kind}: a study "
            f"judges no level by less than {100 * SLIGHT:g} %."
        )

    def _answer(self) -> str:
        share = f"{100 * self.tolerance:g} %"
        if self.chosen is None:
            return (
                f"{self.quantity.name}: no level is known to be within {share}; the finest, "
                f"{self.top.model.title}, has a band of {100 * self.top.estimate:.2g} %, and "
                f"{share} or less is asked: {finer_mesh(self.sizes, self.top.estimate)}"
                f"{self._of_band()}"
            )
        result = self.results[self.chosen]
        if self.chosen == len(self.results) - 1:
            return (
                f"{self.quantity.name} within {share} needs level {result.model.level}, "
                f"{result.model.title}: {_expected(result)}, found in {result.waited:.2g} s"
                f"{self._of_band()}"
            )
        ratio = self.top.seconds / result.seconds
        faster = f"{ratio:.3g} times faster" if ratio > 1 else f"{1 / ratio:.3g} times slower"
        return (
            f"{self.quantity.name} within {share}: level {result.model.level}, "
            f"{result.model.title}, is enough: {100 * result.error:.2g} % from level "
            f"{self.top.model.level}, {self.top.model.title} ({_expected(self.top)}), and {faster} "
            f"by itself; found in {self.top.waited:.2g} s"
            f"{self._of_band()}"
        )

    def _of_band(self) -> str:
        band = self.top.band
        return "." if band is None else f". On the assembly's band: {band.sentence()}."


def relative_difference(values: Floats, reference: Floats) -> float:
    """Norm of the difference of two vectors, relative to the norm of the second.

    Parameters
    ----------
    values, reference : Floats
        (k,) each.
    """
    return float(np.linalg.norm(values - reference) / np.linalg.norm(reference))


def _expected(result: LevelResult) -> str:
    if result.estimate == 0.0:
        return "decided by statics"
    return f"± {100 * result.estimate:.2g} %"
