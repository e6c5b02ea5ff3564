"""Lives of a bearing whose inside is not known: bands over all insides that fit its page.

Each inside is a what-if of `fe_drivetrain.studies.life_assumptions`: the same sample of load steps
is rated again with it, and ratios of damage and pressure stand for those of the whole file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.bearing.catalogue import changed_entry, fitted_entry
from fe_drivetrain.bearing.catalogue_page import MEMBERS
from fe_drivetrain.bearing.fitted_rollers import FittedRollers, fitted_rollers
from fe_drivetrain.bearing.geometry import Bearing, RollerRow
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.studies.life_assumptions import WhatIf, effects
from fe_drivetrain.studies.rolling_bearings import PROFILE, Choices, OneBearing
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads

INSIDES = MEMBERS
"""Insides that a life is computed with: of all that fit, 92 % lie between the least and the largest
of 24. `bearing/by_designation` shows what more would change."""

TAKEN = 0
"""Row of the inside that is taken, among the effects of all."""


@dataclass(frozen=True)
class InsideBand:
    """Least and largest values over the insides that fit a bearing's page.

    Attributes
    ----------
    insides : int
        Number of insides, the one taken with them.
    years : Mapping[str, tuple of float]
        L10r and L10mr [years].
    pressure : tuple of float
        Largest contact pressure [Pa]; NaN of balls.
    stiffness : tuple of float
        Radial stiffness on rigid rings at the load that does most damage [N/m], that of the inside
        taken, least and largest.
    rated, limited : tuple of float
        C and Cu of ISO 281 over those printed [-]; NaN where none is printed.
    """

    insides: int
    years: Mapping[str, tuple[float, float]]
    pressure: tuple[float, float]
    stiffness: tuple[float, float, float]
    rated: tuple[float, float]
    limited: tuple[float, float]

    __repr__ = short_repr


def insides_of(one: OneBearing, profiled: bool) -> list[Bearing]:
    """The insides that fit a bearing's page; none of a bearing without one.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    profiled : bool
        Whether rollers have a profile, that of the standard times each member's factor.
    """
    if one.entry.page is None or not one.entry.fitted:
        return []
    fitted = fitted_rollers(one.entry.page, INSIDES)
    return [inside_of(one, fitted, k, profiled) for k in range(len(fitted))]


def inside_of(one: OneBearing, fitted: FittedRollers, k: int, profiled: bool) -> Bearing:
    """One of the insides, with the clearance of the bearing that is taken.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    fitted : FittedRollers
        The insides.
    k : int
        Which of them.
    profiled : bool
        See `insides_of`.
    """
    entry = fitted_entry(fitted.page, k, fitted)
    if profiled and entry.kind in PROFILE:
        crown = PROFILE[entry.kind] * float(fitted.crown[k])
        entry = changed_entry(entry, one.name, crown=crown)
    own, made = one.rated.bearing, entry.bearing(one.name)
    if isinstance(own.rows[0], RollerRow):
        made = made.with_rows(clearance=own.rows[0].clearance)
    return made


def inside_effects(
    one: OneBearing,
    rules: LifeRules,
    choices: Choices,
    loads: PointLoads,
    speed_rpm: Floats,
    weights: Floats,
) -> Floats:
    """What each inside that fits the page does, over the one that is taken.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    rules : LifeRules
        Choices that change its life.
    choices : Choices
        Whether rollers have a profile.
    loads : PointLoads
        Load steps as they enter the body, (n, 6) or more [N, N m].
    speed_rpm, weights : Floats
        (n,) as in `fe_drivetrain.studies.life_assumptions.effects`.

    Returns
    -------
    effects : Floats
        (1 + insides, 4), the one that is taken first: damage by L10r, by L10mr and largest pressure
        over those of the one taken, and radial stiffness [N/m]. Empty without a page.
    """
    insides = insides_of(one, choices.profiled)
    if not insides:
        return np.zeros((0, 0))
    ifs = [WhatIf("", "", replace(one.rated, bearing=inside), rules) for inside in insides]
    found = np.vstack([np.ones(3), effects(one, rules, ifs, loads, speed_rpm, weights)])
    heaviest = int(np.argmax(weights))
    step = next(iter(one.path.steps(loads[[heaviest]], speed_rpm[[heaviest]], np.ones(1))))
    at = step.loads[int(np.argmax(np.hypot(step.loads[:, 1], step.loads[:, 2])))]
    stiff = [radial_stiffness(inside, at) for inside in (one.rated.bearing, *insides)]
    return np.column_stack([found, stiff])


def radial_stiffness(bearing: Bearing, load: Floats) -> float:
    """Radial load over radial displacement of the inner ring, on rigid rings [N/m].

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    load : Floats
        (5,) [N, N m]; what its rolling elements do not resist is left out.

    Returns
    -------
    stiffness : float
        NaN where nothing carries the load.
    """
    carried = np.array(load, dtype=float)
    rows = bearing.rows
    if all(isinstance(row, RollerRow) and row.aligning for row in rows):
        carried[3:] = 0.0
    if all(abs(row.angle) < 1e-6 and isinstance(row, RollerRow) for row in rows):
        carried[0] = 0.0
    found = equilibrium(bearing, carried)
    moved = float(np.hypot(*found.displacements[0, 1:3]))
    if not found.converged.all() or moved == 0.0:
        return float("nan")
    return float(np.hypot(*carried[1:3])) / moved


def inside_band(
    one: OneBearing,
    lives: Sequence[Mapping[str, float]],
    changes: Floats,
    pressures: Floats,
) -> InsideBand:
    """Bands over all insides, of files together.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    lives : sequence of Mapping[str, float]
        Lives [years] with each inside, the one taken first.
    changes : Floats
        (files, insides, 4) of `inside_effects`.
    pressures : Floats
        (files,) largest pressure with the inside taken [Pa].
    """
    assert one.entry.page is not None
    fitted = fitted_rollers(one.entry.page, INSIDES)
    years = {kind: _ends(np.array([life[kind] for life in lives])) for kind in ("L10r", "L10mr")}
    pressed = (changes[:, :, 2] * pressures[:, None]).max(axis=0)
    stiff = changes[int(np.argmax(pressures)), :, 3]
    ends = _ends(stiff)
    nothing = (float("nan"), float("nan"))
    return InsideBand(
        changes.shape[1],
        years,
        nothing if one.rated.balls else _ends(pressed),
        (float(stiff[TAKEN]), *ends),
        _ends(fitted.rated),
        _ends(fitted.limited),
    )


def beyond(value: float, ends: tuple[float, float]) -> float:
    """How far the farther end of a band is from a value; 0 of a band or value without end.

    Parameters
    ----------
    value : float
        With the inside that is taken.
    ends : tuple of float
        Least and largest over all insides.
    """
    far = max(value - ends[0], ends[1] - value)
    return far if np.isfinite(far) else 0.0


def _ends(values: Floats) -> tuple[float, float]:
    """Least and largest of those that are numbers."""
    known = values[~np.isnan(values)]
    return (float(known.min()), float(known.max())) if len(known) else (float("nan"),) * 2
