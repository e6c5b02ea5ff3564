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
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.comparison import statistics
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.beam import closed_forms, shaft
from fe_drivetrain.shafts.beam.closed_forms import MainBearingBeam
from fe_drivetrain.shafts.beam.of_scene import beam_of_scene, main_bearing_beam
from fe_drivetrain.shafts.fidelity.bearing_units import UnitBounds
from fe_drivetrain.shafts.fidelity.quantities import unit_numbers
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.studies.seat_stiffness import SeatStiffness
from fe_drivetrain.studies.study_loads import EnteredLoads
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads

PINNED = "pinned beam"
SPRUNG = "torsional-spring beam, {}"
"""Name of a beam on torsional springs, with the source of its K_R."""
SIXBYSIX = "beam on the 6x6"

_KEPT = 6  # models whose forces over all histories are kept: a million load steps are 8 MB


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

    __repr__ = short_repr

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
    def on_springs(cls, scene: Scene, vertical: float, horizontal: float) -> LinearModel:
        """The beam on torsional springs, with K_R of both planes [N m/rad]."""
        beam = main_bearing_beam(scene, vertical, horizontal)
        return cls.of_beam(closed_forms.torsional_spring_model, beam)

    @classmethod
    def on_matrix(cls, scene: Scene, stiffness: Floats) -> LinearModel:
        """A Bernoulli beam on the (6, 6) stiffness of the bearing unit [N/m, N, N m/rad]."""
        name = scene.bearing_units[0].bearing.name
        unit = shaft.unit_load_response(
            beam_of_scene(scene, {name: stiffness}, shear=False),
            [scene.shaft.front, scene.shaft.rear],
        )
        down = np.array([0.0, 0.0, -scene.gearbox.weight, 0.0, 0.0, 0.0])
        return cls(
            unit.reaction_matrix(name)[:, 0, :].T,
            unit.solution([np.zeros(6), down]).reaction(name),
        )

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
    left_out_percent : float
        Samples near a zero of F_FE, which the mean error leaves out [%].
    """

    mean_error_percent: float
    relative_error_percent: float
    correlation: float
    left_out_percent: float


def closed_form_models(
    scene: Scene, units: Mapping[str, UnitBounds], seat: SeatStiffness | None = None
) -> dict[str, LinearModel]:
    """Closed forms of one bearing on a uniform shaft.

    Parameters
    ----------
    scene : Scene
        The scene.
    units : Mapping[str, UnitBounds]
        Stiffness of the bearing unit by itself, a source of K_R; may be empty.
    seat : SeatStiffness, optional
        Stiffness of the bearing unit in the assembly, a further source of K_R.

    Returns
    -------
    dict of str to LinearModel
        By beam: the pinned one, one on torsional springs for each K_R, and with `seat` one on the
        full 6x6; empty where the closed forms do not apply: they need one bearing on a uniform
        shaft, loads at the hub alone, and a gearbox that is the same along y and z.
    """
    try:
        pinned = main_bearing_beam(scene)
    except InputError:
        return {}
    models = {PINNED: LinearModel.of_beam(closed_forms.pinned_model, pinned)}
    for bound in ("stiff", "soft"):
        for unit in units.values():
            found = unit_numbers(getattr(unit, bound))
            if found["tilt"] > 0.0 and found["yaw"] > 0.0:
                models[SPRUNG.format(f"{bound} housing")] = LinearModel.on_springs(
                    scene, found["tilt"], found["yaw"]
                )
    if seat is not None:
        for estimator in seat.by_plane["vertical"]:
            models[SPRUNG.format(estimator)] = LinearModel.on_springs(scene, *seat.both(estimator))
        models[SIXBYSIX] = LinearModel.on_matrix(scene, seat.matrix)
    return models


def closed_form_errors(
    scene: Scene,
    response: Response,
    models: Mapping[str, LinearModel],
    loads: EnteredLoads,
) -> dict[str, ForceErrors]:
    """Errors of the closed forms over load histories, each by the time that it lasts.

    Parameters
    ----------
    scene : Scene
        The scene.
    response : Response
        Unit loads on its assembly, taken without the weight of shaft, bearing and housing, which
        the closed forms do not have.
    models : Mapping[str, LinearModel]
        Closed forms; none where they do not apply.
    loads : EnteredLoads
        Hub loads.

    Returns
    -------
    dict of str to ForceErrors
        By beam.
    """
    if not models:
        return {}
    solid = LinearModel.of_fe(scene, response)
    seconds = np.array([len(h) * h.step for h in loads.given.histories])
    histories = [history.values for history in loads.each]
    over = ForceComparison(histories, seconds / seconds.sum())
    return {name: over.errors(solid, beam) for name, beam in models.items()}


class ForceComparison:
    """Errors of beams over load histories, each pair of models once.

    Parameters
    ----------
    histories : sequence of ndarray, (n, 6)
        Hub loads [N, N m].
    share : ndarray, (m,), optional
        What each history counts, their sum 1; all the same where not given.
    """

    def __init__(self, histories: Sequence[Floats], share: Floats | None = None) -> None:
        self.histories = histories
        count = len(histories)
        self._weights = np.full(count, 1.0 / count) if share is None else share
        self._forces: dict[tuple[bytes, ...], list[Floats]] = {}  # of the models used last
        self._errors: dict[tuple[bytes, ...], ForceErrors] = {}

    def errors(self, solid: LinearModel, beam: LinearModel) -> ForceErrors:
        """Errors of a beam's resultant radial force.

        Parameters
        ----------
        solid, beam : LinearModel
            The reference and the model.
        """
        key = (*_key(solid), *_key(beam))
        if key not in self._errors:
            found = []
            for both in zip(self._radial(solid), self._radial(beam), strict=True):
                errors = statistics.errors_at_once(*both)
                found.append(
                    [
                        float(errors.mean_percentage_error),
                        100.0 * float(errors.relative_error),
                        float(errors.correlation),
                        100.0 * float(errors.excluded_share),
                    ]
                )
            self._errors[key] = ForceErrors(*(self._weights @ np.array(found)).tolist())
        return self._errors[key]

    def _radial(self, model: LinearModel) -> list[Floats]:
        """(n,) resultant radial force in each history [N]; those of a few models are kept."""
        key = _key(model)
        forces = self._forces.pop(key, None) or [model.radial(h) for h in self.histories]
        self._forces[key] = forces  # the last, now
        for old in list(self._forces)[:-_KEPT]:
            del self._forces[old]
        return forces


def _key(model: LinearModel) -> tuple[bytes, bytes]:
    return model.matrix.tobytes(), model.constant.tobytes()


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
