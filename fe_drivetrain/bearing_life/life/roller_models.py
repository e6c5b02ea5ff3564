"""How the load of a bearing is shared by its laminae: a function for each level of the bearing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.answers import by_row, lamina_loads, laminae_of_contacts
from fe_drivetrain.bearing.geometry import LAMINAE, BallRow, Bearing, RollerRow
from fe_drivetrain.bearing.races import Races, equilibrium_on_races, ring_loads, roller_motions
from fe_drivetrain.bearing.rolling import Equilibrium, equilibrium, free_motions, three_degrees
from fe_drivetrain.bearing_life.life.steps import Steps
from fe_drivetrain.common.arrays import Bools, Floats, chunks
from fe_drivetrain.common.errors import InputError

LaminaLoads = tuple[tuple[Floats, ...], Bools]
"""For each row (n, elements, laminae) [N], and which of n steps are in equilibrium."""

RollerModel = Callable[[Floats], LaminaLoads]
"""From loads (n, 5) on the inner ring [N, N m] to those of its laminae."""

CHUNK = 512
"""Steps at a time: of 72 rollers with 30 laminae 9 MB an array."""


def rigid_rings(bearing: Bearing) -> RollerModel:
    """Rollers between rigid rings, in equilibrium in five degrees of freedom.

    Parameters
    ----------
    bearing : Bearing
        Rollers without laminae get 30.

    Returns
    -------
    model : callable
        See `RollerModel`. As all of these it can be sent to another process.
    """
    sliced = with_laminae(bearing)
    return partial(_in_equilibrium, equilibrium, sliced)


def three_degree_rings(bearing: Bearing) -> RollerModel:
    """The same, reduced to three degrees of freedom (Stirling 2023); see `three_degrees`.

    Parameters
    ----------
    bearing : Bearing
        That resists axial and radial displacement and tilt.

    Returns
    -------
    model : callable
        See `RollerModel`.

    Raises
    ------
    InputError
        The bearing does not resist one of these.
    """
    sliced = with_laminae(bearing)
    if not free_motions(sliced)[1].all():
        raise InputError(
            f"three degrees of freedom of {bearing.name}: it does not resist all of axial and "
            "radial displacement and tilt; take rigid rings"
        )
    return partial(_in_equilibrium, three_degrees, sliced)


def flexible_rings(races: Races, shapes: int | None = None) -> RollerModel:
    """Rollers on races that give way.

    Parameters
    ----------
    races : Races
        Races, see `fe_drivetrain.bearing_life.rings.housing_races`.
    shapes : int, optional
        How many shapes of the races to take, see `Races.shapes`.

    Returns
    -------
    model : callable
        See `RollerModel`. Rollers in closed form are cut into 30 laminae afterwards.
    """
    return partial(_on_races, races, shapes)


def with_laminae(bearing: Bearing) -> Bearing:
    """The bearing with 30 laminae where its rollers are in closed form.

    Parameters
    ----------
    bearing : Bearing
        Bearing with rollers, or with balls, which have none.

    Returns
    -------
    bearing : Bearing
        The same, where it has them.
    """
    if any(isinstance(row, RollerRow) and not row.laminae for row in bearing.rows):
        return bearing.with_rows(laminae=LAMINAE)
    return bearing


def steps_of(
    model: RollerModel,
    loads: ArrayLike,
    speed_rpm: ArrayLike,
    seconds: ArrayLike,
    chunk: int = CHUNK,
) -> Iterator[Steps]:
    """Load steps of a bearing, some hundred at a time.

    Parameters
    ----------
    model : callable
        How they are shared by its laminae.
    loads : array_like
        (n, 5) on the inner ring [N, N m].
    speed_rpm, seconds : array_like
        (n,) or one for all: of the turning ring [1/min], and how long each lasts [s].
    chunk : int
        Steps at a time.

    Yields
    ------
    steps : Steps
        In order.

    Raises
    ------
    InputError
        Shapes that do not fit each other.
    """
    F = np.atleast_2d(np.asarray(loads, dtype=float))
    n = len(F)
    try:
        turns, lasting = (np.broadcast_to(np.asarray(v, float), (n,)) for v in (speed_rpm, seconds))
    except ValueError as error:
        raise InputError(
            f"{n} load steps with speeds of shape {np.shape(speed_rpm)} and durations of shape "
            f"{np.shape(seconds)}: give one for each step, or one for all"
        ) from error
    for part in chunks(n, chunk):
        laminae, converged = model(F[part])
        kept = balanced(laminae, converged)
        yield Steps(F[part], kept, turns[part], lasting[part], converged)


def balanced(laminae: tuple[Floats, ...], converged: Bools) -> tuple[Floats, ...]:
    """Loads of laminae, zero in steps without equilibrium, where they may be no numbers.

    Parameters
    ----------
    laminae : tuple of Floats
        For each row (n, elements, laminae) [N].
    converged : Bools
        (n,).

    Returns
    -------
    laminae : tuple of Floats
        The same where all are in equilibrium.
    """
    if converged.all():
        return laminae
    return tuple(np.where(converged[:, None, None], q, 0.0) for q in laminae)


def unbalanced(bearing: Bearing, steps: Steps) -> float:
    """Largest part of a load that the sum of its laminae leaves, over the load.

    The sum is taken along the motions that the bearing resists, of the steps that are in
    equilibrium.

    Parameters
    ----------
    bearing : Bearing
        Bearing with rollers; contacts of balls turn under load, and are not added up here.
    steps : Steps
        Its load steps.

    Returns
    -------
    part : float
        Next to zero where the laminae hold the ring; not a number of a bearing with balls.
    """
    if any(isinstance(row, BallRow) for row in bearing.rows):
        return np.nan
    along = [row.places for row in with_laminae(bearing).rows if isinstance(row, RollerRow)]
    rollers = np.hstack([q.sum(axis=2) for q in steps.laminae])
    moments = np.hstack([q @ x for q, x in zip(steps.laminae, along, strict=True)])
    carried = ring_loads(bearing, rollers, moments)
    motions, _ = free_motions(bearing)
    size = np.linalg.norm(steps.loads @ motions, axis=1)
    left = np.linalg.norm((carried - steps.loads) @ motions, axis=1)
    judged = steps.converged & (size > 0.0)
    return float((left[judged] / size[judged]).max(initial=0.0))


def _on_races(races: Races, shapes: int | None, loads: Floats) -> LaminaLoads:
    """Laminae of rollers on races that give way."""
    approach, lean = roller_motions(races.bearing)
    sliced = with_laminae(races.bearing)
    total = len(approach)
    found = equilibrium_on_races(races, loads, shapes=shapes)
    u, gone = found.displacements, found.recession
    middles = by_row(sliced, u @ approach.T - gone[:, :total])
    leans = by_row(sliced, u @ lean.T - gone[:, total:])
    laminae = []
    for row, middle, t in zip(sliced.rows, middles, leans, strict=True):
        assert isinstance(row, RollerRow)
        laminae.append(laminae_of_contacts(row, middle, t))
    return tuple(laminae), found.converged


def _in_equilibrium(
    solve: Callable[[Bearing, Floats], Equilibrium], bearing: Bearing, loads: Floats
) -> LaminaLoads:
    """Laminae between rigid rings; a ball is one."""
    found = solve(bearing, loads)
    laminae: list[Floats] = []
    for row, Q in zip(found.bearing.rows, by_row(found.bearing, found.rollers), strict=True):
        laminae.append(
            Q[..., None] if isinstance(row, BallRow) else lamina_loads(row, found.displacements)
        )
    return tuple(laminae), found.converged
