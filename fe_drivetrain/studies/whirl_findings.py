"""Answer, figures, checks and tables of the whirl of a drivetrain's shafts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.components import RPM
from fe_drivetrain.drivetrain_file.whirl_data import WhirlData
from fe_drivetrain.dynamics import Machine
from fe_drivetrain.dynamics.whirl.modes import sense_word
from fe_drivetrain.procedure.resonance import NEAR
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.mode_findings import SMALL
from fe_drivetrain.studies.whirl_record import ShaftWhirl, is_excited
from fe_drivetrain.studies.whirl_rollers import RollerTables

QUESTION = "At which speeds do the shafts whirl, and how far are these from operation?"
CRITICAL = "first critical speed of {} that unbalance excites [rpm]"
AGREE = 1e-6
"""Relative difference of criticals by both ways that is round-off: stiff supports are some
1e10 times as stiff as a shaft."""


def state_whirl(
    found: Findings, machine: Machine, whirl: WhirlData | None, shafts: Sequence[ShaftWhirl]
) -> None:
    """State what was found of the whirl of a drivetrain's shafts.

    Parameters
    ----------
    found : Findings
        Takes it.
    machine : Machine
        The drivetrain.
    whirl : WhirlData or None
        What its file states for whirl.
    shafts : sequence of ShaftWhirl
        What was found of each shaft.
    """
    for shaft in shafts:
        first = shaft.first
        if first is not None:
            k = shaft.criticals.index(first)
            band = float(shaft.bands[k]) * RPM
            found.found(
                CRITICAL.format(shaft.name), first.speed * RPM, None if np.isnan(band) else band
            )
        _check_both_ways(found, shaft)
        _check_power(found, shaft)
    found.data("critical speeds", [row for shaft in shafts for row in critical_rows(shaft)])
    found.data("shafts", [shaft_row(shaft) for shaft in shafts])
    found.data("levels", [row for shaft in shafts for row in level_rows(shaft)])
    _assume(found, machine, whirl)
    figures = _figures(found, shafts)
    cautions = []
    if machine.stages:
        cautions.append(
            "Each shaft is taken by itself: bodies of its neighbours stand still, and their gears "
            "hold it by the stiffness of the meshes."
        )
    if endless := [shaft.name for shaft in shafts if _without_bound(shaft)]:
        cautions.insert(
            0,
            f"A critical speed of {', '.join(endless)} is in operation, and the file states no "
            "damping: whirl and bearing forces of unbalance have no bound there.",
        )
    if not any(shaft.damped for shaft in shafts):
        cautions.append(
            "The file states no damping (whirl: viscous, loss_factor, bearings): nothing is known "
            "of stability, and whirl at a critical speed has no bound."
        )
    found.answer(QUESTION, _verdict(shafts), figures, cautions=cautions)


def state_rollers(found: Findings, rollers: RollerTables) -> None:
    """State at which torques rollers were put into equilibrium, and what centrifugal forces are.

    Parameters
    ----------
    found : Findings
        Takes it.
    rollers : RollerTables
        Stiffness of rollers over the speed.
    """
    found.data("rollers", list(rollers.rows))
    found.data(
        "stiffness over speed",
        [
            {
                "bearing": name,
                "speed of the rotor [rpm]": float(speed) * RPM,
                "torque of the rotor [kN m]": float(torque) / 1e3,
                **{f"{m} [N/m]": float(K[i, i]) for i, m in ((1, "along y"), (2, "along z"))},
            }
            for name, values in rollers.stiffness.items()
            for speed, torque, K in zip(rollers.speeds, rollers.torques, values, strict=True)
        ],
    )
    key = "centrifugal force over that load, at most [%]"
    shares = [float(row[key]) for row in rollers.rows if isinstance(row[key], float)]
    if shares:
        found.note(
            "Centrifugal forces of rollers are left out: at most "
            f"{formatted(max(shares), 2)}\u00a0% of the load of the most loaded roller."
        )


def critical_rows(shaft: ShaftWhirl) -> list[Record]:
    """Critical speeds of a shaft, as records."""
    return [
        {
            "shaft": shaft.name,
            "critical speed [rpm]": one.speed * RPM,
            "band [rpm]": None if np.isnan(band) else float(band) * RPM,
            "by the Campbell diagram [rpm]": other.speed * RPM,
            "whirl": sense_word(one.sense),
            "forward less backward": one.sense,
            "unbalance excites it": "yes" if is_excited(one) else "no",
            "over the largest speed of operation": one.speed / shaft.range[1],
        }
        for one, band, other in zip(shaft.criticals, shaft.bands, shaft.crossings, strict=False)
    ]


def shaft_row(shaft: ShaftWhirl) -> Record:
    """A shaft as a record: range, first critical, unbalance, stability."""
    first, found = shaft.first, shaft.response
    unstable, endless = shaft.unstable_from, _without_bound(shaft)
    return {
        "shaft": shaft.name,
        "largest speed [rpm]": shaft.range[1] * RPM,
        "first critical [rpm]": None if first is None else first.speed * RPM,
        "without gear meshes [rpm]": (
            None if shaft.without_meshes is None else shaft.without_meshes * RPM
        ),
        "in the whole drivetrain [rpm]": (
            None if shaft.in_drivetrain is None else shaft.in_drivetrain * RPM
        ),
        "margin [%]": 100.0 * shaft.margin if np.isfinite(shaft.margin) else None,
        "whirl by unbalance [um]": None if endless else 1e6 * float(found.amplitudes[0].max()),
        "largest bearing force of unbalance [N]": (
            None if endless else float(found.forces[0].max(initial=0.0))
        ),
        "whirl grows from [rpm]": None if unstable is None else unstable * RPM,
        "stability": _stability(shaft),
    }


def level_rows(shaft: ShaftWhirl) -> list[Record]:
    """Levels of a shaft's model as records, with their errors against the finest."""
    best = shaft.ladder[-1].speed
    return [
        {
            "shaft": shaft.name,
            "level": rung.name,
            "degrees of freedom": rung.degrees,
            "processor time [s]": rung.seconds,
            "first critical [rpm]": None if rung.speed is None else rung.speed * RPM,
            "error [%]": (
                None if rung.speed is None or best is None else 100.0 * (rung.speed / best - 1.0)
            ),
        }
        for rung in shaft.ladder
    ]


def _without_bound(shaft: ShaftWhirl) -> bool:
    """Whether nothing bounds the whirl of unbalance in operation."""
    low, high = shaft.range
    excited = [one.speed for one in shaft.criticals if one.sense > -1.0 + 1e-6]
    return not shaft.damped and any(low <= speed <= high for speed in excited)


def _stability(shaft: ShaftWhirl) -> str:
    """Stability in words."""
    if not shaft.damped:
        return "no damping is stated"
    if shaft.unstable_from is None:
        return f"stable up to {shaft.limit * RPM:.4g} rpm"
    return "whirl grows beyond" if shaft.unstable_from > 0 else "whirl grows at any speed"


def _check_both_ways(found: Findings, shaft: ShaftWhirl) -> None:
    """Check that one eigenproblem and the Campbell diagram have the same criticals."""
    one, other = ([c.speed for c in way] for way in (shaft.criticals, shaft.crossings))
    same = len(one) == len(other)
    apart = max((abs(a / b - 1.0) for a, b in zip(one, other, strict=False)), default=0.0)
    found.vanishes(
        f"{shaft.name}: critical speeds of one eigenproblem less those of the Campbell diagram, "
        "largest relative difference, 1 where one is missing",
        apart if same else 1.0,
        within=AGREE,
        why="round-off of eigenproblems on stiff supports",
        source="crossings of damped-free whirl with once a turn, by bisection",
        basis="self-consistency",
    )


def _check_power(found: Findings, shaft: ShaftWhirl) -> None:
    """Check that the power of unbalance is what damping takes."""
    response = shaft.response
    if not shaft.damped:
        return
    apart = response.power - response.absorbed - response.inner
    found.vanishes(
        f"{shaft.name}: power of unbalance less what bearings and shaft take, over what goes to "
        "and fro",
        float(np.abs(apart / response.swinging).max()),
        within=1e-9,
        why="round-off of one system of equations at each speed",
        source="balance of power of steady whirl",
        basis="self-consistency",
    )


def _assume(found: Findings, machine: Machine, whirl: WhirlData | None) -> None:
    """State what the file does not."""
    for text in machine.assumed:
        found.assume(text.partition(":")[0], "", "", text)
    found.assume_all(machine.assumptions())
    for row in (whirl or WhirlData()).assumptions():
        found.assume(f"whirl: {row.name}", row.value, row.unit, row.source)
    meshes = (
        "Gear meshes act across the shaft without its turning; planets follow without mass of "
        "their own, which the carrier has. "
    )
    found.note(f"{meshes if machine.stages else ''}The rotor's blades are rigid.")


def _figures(found: Findings, shafts: Sequence[ShaftWhirl]) -> list[KeyFigure]:
    """What answers first."""
    nearest = min(shafts, key=lambda one: one.margin)
    figures = []
    if nearest.first is not None:
        figures.append(_critical(found, nearest))
    if np.isfinite(nearest.margin):
        margin = 100.0 * nearest.margin
        name = f"least margin of a critical speed to operation, {nearest.name} [%]"
        figures.append(found.value(name, margin, at_least=100.0 * NEAR, by="margin asked for"))
    if nearest.without_meshes is not None:
        name = f"first critical of {nearest.name} without gear meshes [rpm]"
        figures.append(found.value(name, nearest.without_meshes * RPM))
    if nearest.in_drivetrain is not None:
        name = f"first critical of {nearest.name} in the whole drivetrain [rpm]"
        figures.append(found.value(name, nearest.in_drivetrain * RPM))
    fastest = max(shafts, key=lambda one: one.range[1])
    if fastest is not nearest and fastest.first is not None:
        figures.append(_critical(found, fastest))
    bounded = [one for one in shafts if not _without_bound(one)]
    if bounded:
        largest = max(bounded, key=lambda one: float(one.response.forces[0].max(initial=0.0)))
        name = f"largest bearing force of unbalance in operation, {largest.name} [kN]"
        force = float(largest.response.forces[0].max(initial=0.0)) / 1e3
        figures.append(found.value(name, force))
    growing = [shaft for shaft in shafts if shaft.unstable_from is not None]
    if growing:
        worst = min(growing, key=lambda one: (one.unstable_from or 0.0) / one.range[1])
        figures.append(
            found.value(
                f"speed from which {worst.name} is unstable [rpm]",
                (worst.unstable_from or 0.0) * RPM,
                at_least=worst.range[1] * RPM,
                by="largest speed",
            )
        )
    figures.append(found.value("shafts that whirl", len(shafts)))
    return figures[:6]


def _critical(found: Findings, shaft: ShaftWhirl) -> KeyFigure:
    """The first critical of a shaft, without a band that is below the digits that are shown."""
    figure = found.judged(CRITICAL.format(shaft.name).partition(" [")[0])
    small = figure.band is not None and figure.band < SMALL * figure.value
    return figure.model_copy(update={"band": None}) if small else figure


def _verdict(shafts: Sequence[ShaftWhirl]) -> str:
    """Say which critical speed is nearest to operation."""
    nearest = min(shafts, key=lambda one: one.margin)
    if not np.isfinite(nearest.margin) or nearest.first is None:
        return "No shaft has a critical speed that unbalance excites in the range looked at."
    inside = [shaft for shaft in shafts if shaft.margin == 0.0]
    high = formatted(nearest.range[1] * RPM, 3)
    if inside:
        return (
            f"Unbalance meets a critical speed of {nearest.name} in operation, which goes up to "
            f"{high}\u00a0rpm."
        )
    at = formatted(nearest.first.speed * RPM, 4)
    return (
        f"Unbalance excites no critical speed in the operating range: the nearest, {at}\u00a0rpm "
        f"of {nearest.name}, is {formatted(nearest.first.speed / nearest.range[1], 2)} times its "
        "highest operating speed."
    )
