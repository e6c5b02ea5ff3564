"""Beams against FE over all hub-load histories: the study as records of its tables."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.main_bearing.study import (
    Solved,
    Tilt,
)
from fe_drivetrain.common import GRAVITY, Floats
from fe_drivetrain.comparison import compare, statistics
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.report.suite import Record, Run
from fe_drivetrain.shafts.beam import (
    MainBearingBeam,
    beam_of_scene,
    closed_forms,
    main_bearing_beam,
    shaft,
)
from fe_drivetrain.shafts.response import ESTIMATORS
from fe_drivetrain.studies import LinearModel
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
SIXBYSIX = "beam on the 6x6 against bonded FE"
QUANTITIES = ("Fy", "Fz", "My", "Mz")
COMPONENT = {"Fy": 1, "Fz": 2, "My": 4, "Mz": 5}
UNITS = {"Fy": "N", "Fz": "N", "My": "N m", "Mz": "N m"}


@dataclass(frozen=True, eq=False)
class Comparison:
    """What the study found.

    Attributes
    ----------
    fe : dict[str, Floats]
        (m, n, 6) reactions of the main bearing [N, N m] by kind, "spherical" and "bonded".
    pairs : dict[str, tuple[str, Floats]]
        The kind of FE that each comparison is with, and the beam's (m, n, 6) reactions.
    mean_error, correlation : dict[str, float]
        Of the resultant radial force, by comparison [%] and [-].
    headline, quantities, estimators, causes : list[Record]
        Records of tables.
    with_their_stiffness : float
        Mean error of the pinned beam against the closed form with the thesis's own K_R [%].
    seconds : float
        Wall time of turning all load steps into FE reactions [s].
    """

    fe: dict[str, Floats]
    pairs: dict[str, tuple[str, Floats]]
    mean_error: dict[str, float]
    correlation: dict[str, float]
    headline: list[Record]
    quantities: list[Record]
    estimators: list[Record]
    causes: list[Record]
    with_their_stiffness: float
    seconds: float


def compared(
    run: Run,
    hub: HubLoadSet,
    pinned_beam: MainBearingBeam,
    spherical: Solved,
    bonded: Solved,
    tilt: Tilt,
) -> Comparison:
    """Compare four pairs of beam and FE over all histories."""
    name, scene = bonded.bearing, bonded.scene
    solids = {
        "spherical": LinearModel.of_fe(spherical.scene, spherical.response),
        "bonded": LinearModel.of_fe(bonded.scene, bonded.response),
    }
    start = time.perf_counter()
    with run.step("reactions of all histories"):
        fe = {kind: solid.reaction(hub.loads) for kind, solid in solids.items()}
    seconds = time.perf_counter() - start

    springs = {
        estimator: LinearModel.of_beam(
            closed_forms.torsional_spring_model, main_bearing_beam(scene, *tilt.both(estimator))
        )
        for estimator in ESTIMATORS
    }
    unit = shaft.unit_load_response(
        beam_of_scene(scene, {name: tilt.matrix}, shear=False),
        [scene.shaft.front, scene.shaft.rear],
    )
    down = np.array([0.0, 0.0, -scene.gearbox.weight, 0.0, 0.0, 0.0])
    first, second, third = PUBLISHED
    on_matrix = LinearModel(
        unit.reaction_matrix(name)[:, 0, :].T,
        unit.solution([np.zeros(6), down]).reaction(name),
    )
    with run.step("beam models"):
        pinned = LinearModel.of_beam(closed_forms.pinned_model, pinned_beam).reaction(hub.loads)
        pairs = {
            first: ("spherical", pinned),
            second: ("bonded", pinned),
            third: ("bonded", springs["averaged seat"].reaction(hub.loads)),
            SIXBYSIX: ("bonded", on_matrix.reaction(hub.loads)),
        }

    with run.step("comparison"):
        force = {kind: _radial(reaction) for kind, reaction in fe.items()}
        beam_force = {label: _radial(model) for label, (_, model) in pairs.items()}
        error = {
            label: _mean_error(force[kind], beam_force[label]) for label, (kind, _) in pairs.items()
        }
        correlation = {
            label: float(statistics.correlation(force[kind], beam_force[label]).mean())
            for label, (kind, _) in pairs.items()
        }
        headline: list[Record] = [
            {
                "comparison": label,
                MEAN_ERROR: error[label],
                "mean |error| / mean |force| [%]": 100.0
                * float(statistics.relative_error(force[kind], beam_force[label]).mean()),
                "samples left out of the mean error [%]": 100.0
                * float(statistics.excluded_share(force[kind]).mean()),
                "correlation": f"{correlation[label]:.6f}",
                **dict(zip(THESIS, PUBLISHED.get(label, (None, None)), strict=True)),
            }
            for label, (kind, _) in pairs.items()
        ]
        quantities = [
            row
            for label, (kind, model) in pairs.items()
            for row in _by_quantity(label, fe[kind], model)
        ]
        estimators = [
            _by_estimator(estimator, tilt, fe["bonded"], force["bonded"], model, hub.loads)
            for estimator, model in springs.items()
        ]
        theirs = LinearModel.of_beam(
            closed_forms.torsional_spring_model, main_bearing_beam(scene, 145e6, 392e6)
        )
        with_their_stiffness = _mean_error(theirs.radial(hub.loads), beam_force[first])
    with run.step("causes of the difference"):
        causes = _causes(hub.loads, spherical, bonded, springs["averaged seat"], beam_force, force)
    return Comparison(
        fe,
        pairs,
        error,
        correlation,
        headline,
        quantities,
        estimators,
        causes,
        with_their_stiffness,
        seconds,
    )


def of_one_mesh(
    hub: HubLoadSet, scene: Scene, matrix: Floats, stiffness: Floats
) -> tuple[float, float, float]:
    """Errors of both beams against a bonded bearing, with what one mesh gives.

    Parameters
    ----------
    hub : HubLoadSet
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
    force = LinearModel.of_reactions(matrix, scene.gearbox.weight).radial(hub.loads)
    spring = main_bearing_beam(scene, float(stiffness[0]), float(stiffness[1]))
    pinned, sprung = (
        LinearModel.of_beam(model, spring).radial(hub.loads)
        for model in (closed_forms.pinned_model, closed_forms.torsional_spring_model)
    )
    return (
        _mean_error(force, pinned),
        _mean_error(force, sprung),
        float(statistics.correlation(force, sprung).mean()),
    )


def _radial(reaction: Floats) -> Floats:
    """(m, n) resultant radial force [N] of (m, n, 6) reactions."""
    return statistics.resultant(reaction[..., 1], reaction[..., 2])


def _mean_error(reference: Floats, found: Floats) -> float:
    """The thesis's metric, mean over the histories [%]."""
    return float(statistics.mean_percentage_error(reference, found).mean())


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
                "quantity": f"{quantity} [k{UNITS[quantity]}]".replace("N m", "N\u00a0m"),
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
    estimator: str, tilt: Tilt, reference: Floats, force: Floats, model: LinearModel, loads: Floats
) -> Record:
    """The torsional-spring beam with K_R of one estimator against bonded FE."""
    fy, fz = (loads @ model.matrix[:, k] + model.constant[k] for k in (1, 2))
    found = statistics.resultant(fy, fz)
    vertical, horizontal = tilt.both(estimator)
    return {
        "estimator": estimator,
        "K_R vertical [MN m/rad]": vertical / 1e6,
        "K_R horizontal [MN m/rad]": horizontal / 1e6,
        "mean error of the resultant [%]": _mean_error(force, found),
        "correlation": f"{float(statistics.correlation(force, found).mean()):.6f}",
        "RMSE Fy [kN]": float(statistics.rmse(reference[..., 1], fy).mean()) / 1e3,
        "RMSE Fz [kN]": float(statistics.rmse(reference[..., 2], fz).mean()) / 1e3,
    }


def _causes(
    loads: Floats,
    spherical: Solved,
    bonded: Solved,
    spring: LinearModel,
    beam_force: dict[str, Floats],
    force: dict[str, Floats],
) -> list[Record]:
    """Beam against FE with one load at a time taken out or put in."""
    first, _, third = PUBLISHED
    plain = "all hub loads, no self-weight"
    heavy = "self-weight of shaft, bearing and housing in FE, none in the beam"
    ahead = "FE loads 50 mm in front of the shaft"
    of_first = [
        (plain, force["spherical"]),
        (heavy, LinearModel.of_fe(spherical.scene, spherical.response, GRAVITY).radial(loads)),
        (ahead, LinearModel.of_fe(spherical.scene, spherical.response).ahead(0.05).radial(loads)),
    ]
    cases = [(first, what, reference, beam_force[first]) for what, reference in of_first]
    cases.append((third, plain, force["bonded"], beam_force[third]))
    solid = LinearModel.of_fe(bonded.scene, bonded.response)
    for what, component in (("without thrust Fx", 0), ("without torque Mx", 3)):
        less = [model.without(component).radial(loads) for model in (solid, spring)]
        cases.append((third, what, less[0], less[1]))
    heavy_force = LinearModel.of_fe(bonded.scene, bonded.response, GRAVITY).radial(loads)
    cases.append((third, heavy, heavy_force, beam_force[third]))
    return [
        {
            "comparison": label,
            "loads": what,
            MEAN_ERROR: _mean_error(reference, found),
            "correlation": f"{float(statistics.correlation(reference, found).mean()):.6f}",
        }
        for label, what, reference, found in cases
    ]
