"""Where hub loads and the scene that they act on meet: all loads go through `entering`.

A history of a file is about the point that the scene states (hub.loads_at), others name the point
themselves. An array of six columns does not, and is refused where the scene states another point
than the front face.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.entrance import AT_HUB, Entrance
from fe_drivetrain.turbine_loads.hub_loads.files import require_points
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory, require_all_loads
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads


class Entered(Protocol):
    """A scene, or what was solved of one: it knows where loads enter."""

    @property
    def entrance(self) -> Entrance:
        """Where loads enter, and which point they are about."""


@dataclass(frozen=True)
class AtFront:
    """A drivetrain of which nothing is known but where hub loads enter, at its front by default.

    Attributes
    ----------
    entrance : Entrance
        Where loads enter.
    """

    entrance: Entrance = AT_HUB


@dataclass(frozen=True, eq=False)
class Factors:
    """Factors of the unit loads of a scene whose hub loads are about the point that they enter at.

    Attributes
    ----------
    values : Floats
        (n, 10 + 6 m) of the loads of `scene_loads`, those at the hub at the front face.
    """

    values: Floats

    __repr__ = short_repr

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, rows: Any) -> Factors:
        return replace(self, values=self.values[rows])


Loads = LoadHistory | PointLoads | ArrayLike
"""Loads that may act on a scene, see `entering`."""


def entering(where: Entered, loads: Loads) -> PointLoads:
    """Loads as they enter a scene: about its front face, with those at its load points.

    Parameters
    ----------
    where : Scene, or what was solved of one
        With m load points.
    loads : LoadHistory, PointLoads or array_like
        Loads; of a history, those at load points that it does not have are zero, and the weights of
        load points are added. `PointLoads` name the point that they are about. An array, (..., 6)
        or (..., 6 + 6 m) [N, N m], is about the front face.

    Returns
    -------
    loads : PointLoads
        (..., 6 + 6 m), or (..., 6) of an array of six columns.

    Raises
    ------
    InputError
        An array does not say which point it is about, and the scene states another than the front
        face; or a history has loads at a point that the scene does not have.
    """
    entrance = where.entrance
    if isinstance(loads, PointLoads):
        return loads.moved(entrance.front)
    if not isinstance(loads, LoadHistory):
        if entrance.elsewhere:
            raise _no_origin(entrance, "an array of hub loads does")
        return PointLoads(np.asarray(loads, dtype=np.float64), entrance.front)
    history = at_front(where, loads)
    columns = [history.loads]
    for name, weight in zip(entrance.points, entrance.weights, strict=True):
        found = np.array(history.at.get(name, np.zeros_like(history.loads)))
        found[:, 2] -= weight
        columns.append(found)
    whole = np.hstack(columns) if entrance.points else history.loads
    return PointLoads(whole, entrance.front)


def at_front(where: Entered, history: LoadHistory) -> LoadHistory:
    """A history with moments about the front face of a scene, where hub loads enter.

    Parameters
    ----------
    where : Scene, or what was solved of one
        States which point a history is about that names none.
    history : LoadHistory
        History from a file, or made.

    Raises
    ------
    InputError
        It has loads at a point that the scene does not have, or lacks components at the hub.
    """
    entrance = where.entrance
    require_all_loads(history)
    require_points([history], entrance.points)
    about = entrance.loads_at if history.about is None else history.about
    start = entrance.front if isinstance(about, str) else about
    return history.moved(start, entrance.front)


def joined(loads: Sequence[PointLoads]) -> PointLoads:
    """Load steps of several loads that are about one point, one after the other."""
    return PointLoads(np.concatenate([one.values for one in loads]), loads[0].x)


def factor_values(where: Entered, factors: Factors | ArrayLike) -> Floats:
    """Factors (..., n) of the unit loads of a scene, as an array.

    Parameters
    ----------
    where : Scene, or what was solved of one
        That they act on.
    factors : Factors or array_like
        An array is about the front face.

    Raises
    ------
    InputError
        It is an array, and the scene states that hub loads are about another point.
    """
    if isinstance(factors, Factors):
        return factors.values
    if where.entrance.elsewhere:
        raise _no_origin(where.entrance, "an array of factors of loads does")
    return np.asarray(factors, dtype=np.float64)


def _no_origin(entrance: Entrance, what: str) -> InputError:
    return InputError(
        f"{what} not say which point it is about, and hub.loads_at of the scene is "
        f"x = {entrance.loads_at:g} m where the front face is at {entrance.front:g} m: give a "
        "LoadHistory, which is taken about hub.loads_at, or name the point, as in "
        f"PointLoads(loads, x={entrance.loads_at:g}) (of factors: factors_of(entering(scene, ...)))"
    )
