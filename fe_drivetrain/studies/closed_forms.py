"""Closed forms of one bearing on a uniform shaft against the assembly, over load histories.

The pinned beam and the beam on torsional springs of Stirling 2023, Eq 3.1, 3.18 and 3.19, as
matrices, so that a million load steps cost a product.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison import statistics
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.beam import closed_forms
from fe_drivetrain.shafts.beam.closed_forms import MainBearingBeam
from fe_drivetrain.shafts.beam.of_scene import main_bearing_beam
from fe_drivetrain.shafts.fidelity.bearing_units import UnitBounds
from fe_drivetrain.shafts.fidelity.quantities import unit_numbers
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.studies.study_loads import EnteredLoads
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads


@dataclass(frozen=True, eq=False)
class LinearModel:
    """A model of the load on the main bearing: each one, FE or beam, is linear in the hub loads.

    Attributes
    ----------
    matrix : Floats
        (6, 6): row i is what the hub load i puts on the bearing.
    constant : Floats
        (6,) what it carries without hub loads [N, N m].
    """

    matrix: Floats
    constant: Floats

    @classmethod
    def of_fe(cls, scene: Scene, response: Response, gravity: float = 0.0) -> LinearModel:
        """The solid of a scene, with its gearbox weight and under gravity [m/s^2]."""
        name, weight = scene.bearing_units[0].bearing.name, scene.gearbox.weight
        front = scene.shaft.front
        nothing, units = PointLoads(np.zeros(6), front), PointLoads(np.eye(6), front)
        constant = response.history(name, nothing, weight, gravity)
        return cls(response.history(name, units), constant)

    @classmethod
    def of_beam(
        cls, model: Callable[[Floats, MainBearingBeam], Floats], beam: MainBearingBeam
    ) -> LinearModel:
        """A closed form of `shafts.beam.closed_forms`."""
        constant = model(np.zeros(6), beam)
        # loads as large as the weight in the constant, which would swallow digits of a unit load's
        size = 1e6
        return cls((model(size * np.eye(6), beam) - constant) / size, constant)

    @classmethod
    def of_reactions(cls, matrix: Floats, weight: float) -> LinearModel:
        """A solid known by its (6, 10) reactions to unit loads, and its gearbox weight [N]."""
        return cls(matrix[:, :6].T, weight * matrix[:, 9])

    def reaction(self, loads: Floats) -> Floats:
        """(..., 6) reactions [N, N m] to (..., 6) hub loads."""
        result = loads @ self.matrix
        result += self.constant
        return result

    def radial(self, loads: Floats) -> Floats:
        """(...) resultant radial force [N]."""
        return statistics.resultant(
            loads @ self.matrix[:, 1] + self.constant[1],
            loads @ self.matrix[:, 2] + self.constant[2],
        )

    def without(self, component: int) -> LinearModel:
        """The same, blind to one component of the hub loads."""
        matrix = self.matrix.copy()
        matrix[component] = 0.0
        return LinearModel(matrix, self.constant)

    def ahead(self, arm: float) -> LinearModel:
        """The same, for loads that act an arm [m] in front of the hub."""
        matrix = self.matrix.copy()
        matrix[2] += arm * self.matrix[4]
        matrix[1] -= arm * self.matrix[5]
        return LinearModel(matrix, self.constant)


@dataclass(frozen=True)
class ForceErrors:
    """Errors of a model's resultant radial force against the assembly, means over histories.

    Attributes
    ----------
    mean_error_percent : float
        Mean of |F_model - F_FE| / |F_FE| over the samples, the metric of Stirling 2023 [%].
    relative_error_percent : float
        Mean |F_model - F_FE| over mean |F_FE|, which zero crossings do no harm [%].
    correlation : float
        Pearson's coefficient; NaN where a load never changes.
    """

    mean_error_percent: float
    relative_error_percent: float
    correlation: float


def closed_form_errors(
    scene: Scene, response: Response, units: Mapping[str, UnitBounds], loads: EnteredLoads
) -> dict[str, ForceErrors]:
    """Errors of the closed forms over load histories, each by the time that it lasts.

    Parameters
    ----------
    scene : Scene
        The scene.
    response : Response
        Unit loads on its assembly, taken without the weight of shaft, bearing and housing, which
        the closed forms do not have.
    units : Mapping[str, UnitBounds]
        Stiffness of the bearing unit, the source of K_R.
    loads : EnteredLoads
        Hub loads.

    Returns
    -------
    dict of str to ForceErrors
        By beam; empty where the closed forms do not apply: they need one bearing on a uniform
        shaft, loads at the hub alone, and a gearbox that is the same along y and z.
    """
    try:
        pinned = main_bearing_beam(scene)
    except InputError:
        return {}
    beams = {"pinned beam": LinearModel.of_beam(closed_forms.pinned_model, pinned)}
    for bound in ("stiff", "soft"):
        (unit,) = units.values()
        found = unit_numbers(getattr(unit, bound))
        if found["tilt"] > 0.0 and found["yaw"] > 0.0:
            beam = main_bearing_beam(scene, found["tilt"], found["yaw"])
            beams[f"torsional-spring beam, {bound} housing"] = LinearModel.of_beam(
                closed_forms.torsional_spring_model, beam
            )
    solid = LinearModel.of_fe(scene, response)
    seconds = np.array([len(h) * h.step for h in loads.given.histories])
    return {
        name: _errors(solid, beam, loads.each, seconds / seconds.sum())
        for name, beam in beams.items()
    }


def _errors(
    solid: LinearModel, beam: LinearModel, histories: Sequence[PointLoads], share: Floats
) -> ForceErrors:
    """Errors of a beam, histories counting by their share of the time."""
    found = []
    for history in histories:
        both = solid.radial(history.values), beam.radial(history.values)
        found.append(
            [
                float(statistics.mean_percentage_error(*both)),
                100.0 * float(statistics.relative_error(*both)),
                float(statistics.correlation(*both)),
            ]
        )
    return ForceErrors(*(share @ np.array(found)).tolist())


def closed_form_rows(found: Mapping[str, ForceErrors]) -> list[Record]:
    """Records of the errors of closed forms.

    Parameters
    ----------
    found : Mapping[str, ForceErrors]
        Errors by beam.
    """
    return [
        {
            "closed form": name,
            "mean error [%]": one.mean_error_percent,
            "mean |error| / mean |force| [%]": one.relative_error_percent,
            "correlation [-]": None if np.isnan(one.correlation) else one.correlation,
        }
        for name, one in found.items()
    ]
