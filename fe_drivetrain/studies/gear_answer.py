"""The answer on gears: whether they are strong enough, and the one that decides."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.procedure.failure_modes import GEAR_RATING
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import certain_value, formatted, value_text
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.gear_answers import GearAnswer, MeshAnswer, Safety, safeties
from fe_drivetrain.studies.loss_findings import loss_figures
from fe_drivetrain.turbine_loads.histories.sites import HOURS_A_YEAR

LEAST_SAFETY = "least safety factor over that required"
"""Least of all flanks and roots that are rated, as projects of validation name it."""

_SHOWN = 6  # key figures
_DIGITS = 4


class Rated(NamedTuple):
    """A safety factor of a gear, "S_H" of its flank or "S_F" of its root."""

    gear: str
    of: str
    safety: Safety

    @property
    def reserve(self) -> float:
        """Safety factor over the least that is asked for."""
        return self.safety.value / self.safety.required

    @property
    def part(self) -> str:
        """In words: "flank of the stage 1 sun"; a flank of a planet has its name already."""
        if self.of == "S_H":
            return self.gear if "flank" in self.gear else f"flank of the {self.gear}"
        return f"root of the {self.gear}"


def state_answer(found: Findings, result: Mapping[str, Any]) -> None:
    """State the safety of the gear that decides; without strength the largest stress.

    Parameters
    ----------
    found : Findings
        Takes the answer.
    result : mapping of str to object
        Fields of the result.
    """
    gears: Mapping[str, GearAnswer] = result["gears"]
    ratings = [
        Rated(one.name, of, safety)
        for one in gears.values()
        for of, safety in zip(("S_H", "S_F"), safeties(one, result["varies"]), strict=True)
        if safety is not None
    ]
    spread = _spread_figures(found, result["meshes"])
    if result["losses"] is not None:
        spread = [*loss_figures(found), *spread]
    if ratings:
        _strength(found, ratings, spread, result)
    elif gears:
        _stresses(found, gears, spread)
    else:
        _loads(found, result["meshes"], spread)


def _strength(
    found: Findings, ratings: list[Rated], spread: list[KeyFigure], result: Mapping[str, Any]
) -> None:
    """Whether all gears that are rated are strong enough."""
    worst = min(ratings, key=lambda one: one.reserve)
    band = worst.safety.band / worst.safety.required
    found.found(LEAST_SAFETY, worst.reserve, band, (GEAR_RATING,))
    figures = []
    for of in ("S_H", "S_F"):
        least = [one for one in ratings if one.of == of]
        if least:
            figures.append(_figure(found, min(least, key=lambda one: one.reserve)))
    lasting = _life(found, result)
    figures += [] if lasting is None else [lasting]
    over = "over the spectrum" if result["varies"] else f"at {_torque(result['torque'])}"
    safety = worst.safety
    what = f"{worst.of}\u00a0{formatted(safety.value, _DIGITS)} {over} where "
    what += f"{formatted(safety.required)} is required"
    if worst.reserve < 1.0:
        verdict = f"The {worst.part} is too weak: {what}"
        verdict += "." if lasting is None else f"; it lasts {certain_value(lasting)}."
    else:
        count = len({one.gear for one in ratings})
        verdict = f"All {count} rated flanks are strong enough; the {worst.part} has least "
        verdict += f"reserve: {what}."
    found.answer(
        "Are the gears strong enough under these loads?", verdict, [*figures, *spread][:_SHOWN]
    )


def _life(found: Findings, result: Mapping[str, Any]) -> KeyFigure | None:
    """Life of the first gear to fail, in years at a site; None where none fails."""
    lives = [one for one in result["gears"].values() if np.isfinite(one.life_hours)]
    if not lives:
        return None
    first = min(lives, key=lambda one: one.life_hours)
    scale, unit = (1.0, "h") if result["site"] is None else (1.0 / HOURS_A_YEAR, "years")
    hours, band = first.life_hours, None
    if first.life is not None and first.bands is not None and hours > 0.0:
        band = scale * hours * first.bands.damage / first.life.damage.largest
    name, asked = f"life of the first gear to fail [{unit}]", scale * result["hours"]
    return found.value(name, scale * hours, band, at_least=asked, by="asked for")


def _torque(torque: float) -> str:
    return value_text(torque / 1e3, "kN\u00a0m")


def _figure(found: Findings, rated: Rated) -> KeyFigure:
    """A safety factor against the least that is asked for."""
    quantity, safety = f"{rated.of} of {rated.gear}", rated.safety
    one = found.value(quantity, safety.value, safety.band, at_least=safety.required, by="required")
    return one.model_copy(update={"quantity": quantity})


def _stresses(found: Findings, gears: Mapping[str, GearAnswer], spread: list[KeyFigure]) -> None:
    """The largest stresses, of gears without strength."""
    worst = max(gears.values(), key=lambda one: one.contact_stress)
    bent = max(gears.values(), key=lambda one: one.root_stress or 0.0)
    size = value_text(worst.contact_stress / 1e6, "MPa")
    figures = [found.judged(f"sigma_H of {worst.name}")]
    if bent.root_stress is not None:
        figures.append(found.judged(f"sigma_F of {bent.name}"))
    found.answer(
        "How high are the stresses of the gears under these loads?",
        f"The largest contact stress is {size}, of the {worst.name}; the file lacks what safety "
        "factors need.",
        [*figures, *spread][:_SHOWN],
    )


def _loads(found: Findings, meshes: Mapping[str, MeshAnswer], spread: list[KeyFigure]) -> None:
    """The largest local load, of gears that are not given in full."""
    worst = max(meshes.values(), key=lambda one: one.spread.sharing * one.spread.face_load)
    load = worst.spread.sharing * worst.spread.face_load
    found.answer(
        "How do the gears share their load?",
        f"The most loaded place of a flank, of {worst.name}, carries {formatted(load, 3)} times "
        "the mean; the file lacks what stresses need.",
        [*spread, found.value("largest local load over the mean", load, worst.stress_band * load)],
    )


def _spread_figures(found: Findings, meshes: Mapping[str, MeshAnswer]) -> list[KeyFigure]:
    """K_gamma and K_Hbeta of the meshes with most of either."""
    planetary = [one for one in meshes.values() if len(one.spread.share[0]) > 1]
    figures = []
    if planetary:
        most = max(planetary, key=lambda one: one.spread.sharing)
        figures.append(found.judged(f"K_gamma of {most.name}"))
    most = max(meshes.values(), key=lambda one: one.spread.face_load)
    figures.append(found.judged(f"K_Hbeta of {most.name}"))
    return figures
