"""Beams against FE over all hub-load histories: the study as records of its tables."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.main_bearing import shown
from fe_drivetrain.common import GRAVITY, Floats
from fe_drivetrain.comparison import compare, statistics
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.report.suite import Record, Run
from fe_drivetrain.shafts.response import ESTIMATORS
from fe_drivetrain.studies import Assembly, ForceErrors, LinearModel, SeatStiffness
from fe_drivetrain.studies.closed_forms import (
    PINNED,
    SIXBYSIX,
    SPRUNG,
    ForceComparison,
    closed_form_models,
)
from fe_drivetrain.turbine_loads.hub_loads import HubLoadSet

#: Mean error [%] and correlation of the resultant force over all histories (Stirling 2023, lines
#: on Figures 3.6, 3.8 and 3.15), for other hub loads and another housing than here.
PUBLISHED = {
    "pinned beam against spherical FE": (1.54, 0.9996),
    "pinned beam against bonded FE": (22.74, 0.7781),
    "torsional-spring beam against bonded FE": (1.61, 0.9996),
}
MEAN_ERROR = "mean error [%]"
THESIS = ("thesis: mean error [%]", "thesis: correlation")
ON_MATRIX = f"{SIXBYSIX} against bonded FE"
QUANTITIES = ("Fy", "Fz", "My", "Mz")
COMPONENT = {"Fy": 1, "Fz": 2, "My": 4, "Mz": 5}
UNITS = {"Fy": "N", "Fz": "N", "My": "N m", "Mz": "N m"}


@dataclass(frozen=True, eq=False)
class Comparison:
    """What the study found.

    Attributes
    ----------
    over : ForceComparison
        Errors over all histories.
    fe : dict[str, Floats]
        (m, n, 6) reactions of the main bearing [N, N m] by kind, "spherical" and "bonded".
    pairs : dict[str, tuple[str, Floats]]
        The kind of FE that each comparison is with, and the beam's (m, n, 6) reactions.
    errors : dict[str, ForceErrors]
        Errors of the resultant radial force, by comparison.
    headline, quantities, estimators, causes : list[Record]
        Records of tables.
    with_their_stiffness : float
        Mean error of the pinned beam against the closed form with the thesis's own K_R [%].
    seconds : float
        Wall time of turning all load steps into FE reactions [s].
    """

    over: ForceComparison
    fe: dict[str, Floats]
    pairs: dict[str, tuple[str, Floats]]
    errors: dict[str, ForceErrors]
    headline: list[Record]
    quantities: list[Record]
    estimators: list[Record]
    causes: list[Record]
    with_their_stiffness: float
    seconds: float

    @property
    def mean_error(self) -> dict[str, float]:
        """Mean error of the resultant radial force, by comparison [%]."""
        return {label: one.mean_error_percent for label, one in self.errors.items()}

    @property
    def correlation(self) -> dict[str, float]:
        """Correlation of the resultant radial force, by comparison."""
        return {label: one.correlation for label, one in self.errors.items()}


def compared(
    run: Run, hub: HubLoadSet, spherical: Assembly, bonded: Assembly, tilt: SeatStiffness
) -> Comparison:
    """Compare four pairs of beam and FE over all histories."""
    solids = {
        "spherical": LinearModel.of_fe(spherical.scene, spherical.response),
        "bonded": LinearModel.of_fe(bonded.scene, bonded.response),
    }
    start = time.perf_counter()
    with run.step("reactions of all histories"):
        fe = {kind: solid.reaction(hub.loads) for kind, solid in solids.items()}
    seconds = time.perf_counter() - start
    beams = closed_form_models(bonded.scene, {}, tilt)
    of_pairs = _beams_of_pairs()
    with run.step("beam models"):
        reactions = {beam: beams[beam].reaction(hub.loads) for _, beam in of_pairs.values()}
        pairs = {label: (kind, reactions[beam]) for label, (kind, beam) in of_pairs.items()}
    over = ForceComparison(list(hub.loads))
    with run.step("comparison"):
        errors = {
            label: over.errors(solids[kind], beams[beam])
            for label, (kind, beam) in of_pairs.items()
        }
        theirs = LinearModel.on_springs(bonded.scene, *(1e6 * k for k in shown.PUBLISHED.values()))
        return Comparison(
            over=over,
            fe=fe,
            pairs=pairs,
            errors=errors,
            headline=[_headline(label, one) for label, one in errors.items()],
            quantities=[
                row
                for label, (kind, model) in pairs.items()
                for row in _by_quantity(label, fe[kind], model)
            ],
            estimators=[
                _by_estimator(estimator, tilt, solids["bonded"], beams, over)
                for estimator in ESTIMATORS
            ],
            causes=_causes(over, spherical, bonded, beams),
            with_their_stiffness=over.errors(theirs, beams[PINNED]).mean_error_percent,
            seconds=seconds,
        )


def _beams_of_pairs() -> dict[str, tuple[str, str]]:
    """The kind of FE and the closed form of each comparison."""
    first, second, third = PUBLISHED
    return {
        first: ("spherical", PINNED),
        second: ("bonded", PINNED),
        third: ("bonded", SPRUNG.format("averaged seat")),
        ON_MATRIX: ("bonded", SIXBYSIX),
    }


def of_one_mesh(
    over: ForceComparison, scene: Scene, matrix: Floats, stiffness: Floats
) -> tuple[float, float, float]:
    """Errors of both beams against a bonded bearing, with what one mesh gives.

    Parameters
    ----------
    over : ForceComparison
        The load histories.
    scene : Scene
        The bonded scene.
    matrix, stiffness : array
        (6, 10) reactions, and (2,) K_R from the averaged seat.

    Returns
    -------
    pinned, sprung : float
        Mean error of the pinned and of the torsional-spring beam [%].
    correlation : float
        Of the torsional-spring beam.
    """
    solid = LinearModel.of_reactions(matrix, scene.gearbox.weight)
    beams = (
        closed_form_models(scene, {})[PINNED],
        LinearModel.on_springs(scene, float(stiffness[0]), float(stiffness[1])),
    )
    pinned, sprung = (over.errors(solid, beam) for beam in beams)
    return pinned.mean_error_percent, sprung.mean_error_percent, sprung.correlation


def _headline(label: str, errors: ForceErrors) -> Record:
    """Errors of one comparison beside those of the thesis."""
    return {
        "comparison": label,
        MEAN_ERROR: errors.mean_error_percent,
        "mean |error| / mean |force| [%]": errors.relative_error_percent,
        "samples left out of the mean error [%]": errors.left_out_percent,
        "correlation": f"{errors.correlation:.6f}",
        **dict(zip(THESIS, PUBLISHED.get(label, (None, None)), strict=True)),
    }


def _by_quantity(label: str, reference: Floats, model: Floats) -> list[Record]:
    """Usable as a model uncertainty: means over all histories, one row a quantity."""
    columns = [COMPONENT[q] for q in QUANTITIES]
    result = compare(
        reference[..., columns],
        model[..., columns],
        QUANTITIES,
        [UNITS[q] for q in QUANTITIES],
        # A spherical joint carries no moment: what stands there is rounding.
        negligible=(1.0, 1.0, 1.0, 1.0),
    )
    rows: list[Record] = []
    for k, quantity in enumerate(QUANTITIES):
        if np.isnan(result.correlation[:, k]).any():
            continue
        rows.append(
            {
                "comparison": label,
                "quantity": f"{quantity} [k{UNITS[quantity]}]",
                "rms of FE": float(result.reference_rms[:, k].mean()) / 1e3,
                "RMSE": float(result.rmse[:, k].mean()) / 1e3,
                "bias, beam less FE": float(result.bias[:, k].mean()) / 1e3,
                "relative scatter [%]": 100.0 * float(result.relative_scatter[:, k].mean()),
                "slope FE/beam [-]": float(result.slope[:, k].mean()),
                "CoV [-]": float(result.cov[:, k].mean()),
                "correlation": f"{float(result.correlation[:, k].mean()):.6f}",
            }
        )
    return rows


def _by_estimator(
    estimator: str,
    tilt: SeatStiffness,
    solid: LinearModel,
    beams: Mapping[str, LinearModel],
    over: ForceComparison,
) -> Record:
    """The torsional-spring beam with K_R of one estimator against bonded FE."""
    beam = beams[SPRUNG.format(estimator)]
    found = over.errors(solid, beam)
    vertical, horizontal = tilt.both(estimator)
    row: Record = {
        "estimator": estimator,
        "K_R vertical [MN m/rad]": vertical / 1e6,
        "K_R horizontal [MN m/rad]": horizontal / 1e6,
        "mean error of the resultant [%]": found.mean_error_percent,
        "correlation": f"{found.correlation:.6f}",
    }
    for quantity in ("Fy", "Fz"):
        k = COMPONENT[quantity]
        rmse = [
            statistics.rmse(
                *(h @ model.matrix[:, k] + model.constant[k] for model in (solid, beam))
            )
            for h in over.histories
        ]
        row[f"RMSE {quantity} [kN]"] = float(np.mean(rmse)) / 1e3
    return row


def _causes(
    over: ForceComparison,
    spherical: Assembly,
    bonded: Assembly,
    beams: Mapping[str, LinearModel],
) -> list[Record]:
    """Beam against FE with one load at a time taken out or put in."""
    first, _, third = PUBLISHED
    plain = "all hub loads, no self-weight"
    heavy = "self-weight of shaft, bearing and housing in FE, none in the beam"
    ahead = "FE loads 50 mm in front of the shaft"
    pinned, spring = beams[PINNED], beams[SPRUNG.format("averaged seat")]
    determinate = LinearModel.of_fe(spherical.scene, spherical.response)
    solid = LinearModel.of_fe(bonded.scene, bonded.response)
    cases = [
        (first, plain, determinate, pinned),
        (first, heavy, LinearModel.of_fe(spherical.scene, spherical.response, GRAVITY), pinned),
        (first, ahead, determinate.ahead(0.05), pinned),
        (third, plain, solid, spring),
        (third, "without thrust Fx", solid.without(0), spring.without(0)),
        (third, "without torque Mx", solid.without(3), spring.without(3)),
        (third, heavy, LinearModel.of_fe(bonded.scene, bonded.response, GRAVITY), spring),
    ]
    rows: list[Record] = []
    for label, what, reference, beam in cases:
        found = over.errors(reference, beam)
        rows.append(
            {
                "comparison": label,
                "loads": what,
                MEAN_ERROR: found.mean_error_percent,
                "correlation": f"{found.correlation:.6f}",
            }
        )
    return rows
