"""A linear body as its bearings feel it: stiffness and loads at the bearings' centres.

The body is a shaft of any level, condensed to its reference points and on its linear supports. Five
motions of each bearing's centre are kept, (u_x, u_y, u_z, theta_y, theta_z): a bearing turns freely
about the axis. With q all of them, f the loads that the body puts on the bearings and p the factors
of the loads, ``K q + f = L p``. K may be singular: where only the bearings hold the body, its
compliance does not exist.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import overload

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import min_eigenvalue, scaled_solve
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.entrance import AT_HUB, Entrance
from fe_drivetrain.elasticity.solve.condensation import Condensed, on_supports
from fe_drivetrain.shafts.response.entering import Factors
from fe_drivetrain.shafts.response.model import LOADS
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads

#: Motions of a point, of six, that a bearing may resist.
FIVE = np.array([0, 1, 2, 4, 5])

# Stiffness on a unit diagonal below which nothing holds the torque.
_FREE = 1e-13


@dataclass(frozen=True, eq=False)
class LinearBody:
    """A condensed body at its bearings.

    Attributes
    ----------
    bearings : tuple of str
        Names of the k bearings.
    stiffness : Floats
        Stiffness (5 k, 5 k) of the body on its linear supports, over the bearings' deflections
        [N/m, N, N m/rad].
    loads : Floats
        Loads (5 k, 10) on clamped bearings for a unit of each load of `response.LOADS` [N, N m];
        six columns more for each load point.
    body : Condensed
        The free body.
    supports : Mapping
        Stiffness (6, 6) of the points on linear supports, inf on the diagonal for rigid.
    motions_of_loads, motions_of_bearings : Floats
        Motions (6 n, 10) and (6 n, 5 k) of all points of the body for unit loads with the bearings'
        centres held, and for unit motions of these.
    housings : Floats
        Compliance (5 k, 5 k) between the bearings' outer rings and the ground.
    load_points : tuple of str
        Points where other loads enter.
    entrance : Entrance
        Point where loads enter the scene.
    sliding : tuple of str
        Bearings whose outer ring slides along x in its housing, and holds no axial force.
    """

    bearings: tuple[str, ...]
    stiffness: Floats
    loads: Floats
    body: Condensed
    supports: Mapping[str, Floats]
    motions_of_loads: Floats
    motions_of_bearings: Floats
    housings: Floats
    load_points: tuple[str, ...] = ()
    entrance: Entrance = AT_HUB
    sliding: tuple[str, ...] = ()

    __repr__ = short_repr

    def forces(self, factors: Floats, deflections: Floats) -> Floats:
        """Loads (n, k, 5) on the bearings, from the body's side.

        Parameters
        ----------
        factors, deflections : Floats
            Factors (n, 10) of the loads, and deflections (n, k, 5) of the bearings [m, rad].

        Returns
        -------
        forces : Floats
            Forces (n, k, 5) [N, N m].
        """
        f = factors @ self.loads.T - deflections.reshape(len(factors), -1) @ self.stiffness
        return f.reshape(deflections.shape)

    def motions(self, factors: Floats, forces: Floats, deflections: Floats) -> Floats:
        """Motions (n, points, 6) of all points of the body.

        Parameters
        ----------
        factors, forces, deflections : Floats
            Factors (n, 10) of the loads, and forces and deflections (n, k, 5) of the bearings.

        Returns
        -------
        motions : Floats
            Motions (n, points, 6) [m, rad].
        """
        n = len(factors)
        q = deflections.reshape(n, -1) + forces.reshape(n, -1) @ self.housings
        found = factors @ self.motions_of_loads.T + q @ self.motions_of_bearings.T
        return found.reshape(n, -1, 6)

    def reactions(self, factors: Floats, forces: Floats, deflections: Floats) -> dict[str, Floats]:
        """Reactions (n, 6) of the body on its linear supports, by name [N, N m].

        Parameters
        ----------
        factors, forces, deflections : Floats
            Factors (n, 10) of the loads, and forces and deflections (n, k, 5) of the bearings.

        Returns
        -------
        reactions : dict
            Reactions at the supports' own points.
        """
        u = self.motions(factors, forces, deflections).reshape(len(factors), -1)
        carried = factors @ applied(self.body, self.load_points).T - u @ self.body.stiffness
        return {name: carried[:, self.body.rows(name)] for name in self.supports}

    def imbalance(self, factors: Floats, forces: Floats, deflections: Floats) -> Floats:
        """Sum (n, 6) of all loads and reactions about the hub; zero but for round-off.

        Parameters
        ----------
        factors, forces, deflections : Floats
            Factors (n, 10) of the loads, and forces and deflections (n, k, 5) of the bearings.

        Returns
        -------
        sums : Floats
            Sums (n, 6) [N, N m].
        """
        body = self.body
        about = body.positions[body.names.index("hub")]
        T = {
            name: wrench_transport(place - about)
            for name, place in zip(body.names, body.positions, strict=True)
        }
        whole = applied(body, self.load_points).reshape(len(body.names), 6, -1)
        moved = [T[name] @ part for name, part in zip(body.names, whole, strict=True)]
        total = np.asarray(factors @ np.sum(moved, axis=0).T)
        for name, reaction in self.reactions(factors, forces, deflections).items():
            total -= reaction @ T[name].T
        for name, force in zip(self.bearings, np.moveaxis(forces, 1, 0), strict=True):
            total -= force @ T[name][:, FIVE].T
        return total


def linear_body(
    body: Condensed,
    bearings: Sequence[str],
    supports: Mapping[str, ArrayLike],
    load_points: Sequence[str] = (),
) -> LinearBody:
    """A condensed body at its bearings, in housings that do not give.

    Parameters
    ----------
    body : Condensed
        A shaft of any level; its points "hub" and "gearbox" are those of the loads.
    bearings : Sequence[str]
        Points where bearings hold it.
    supports : Mapping
        Linear stiffness (6,) or (6, 6) to ground of other points by name; inf is rigid.
    load_points : Sequence[str]
        Points where other loads enter.

    Returns
    -------
    found : LinearBody
        Body as the bearings feel it.

    Raises
    ------
    InputError
        A point is unknown, or nothing but bearings holds the torque.
    """
    for name in (*bearings, *load_points, "hub", "gearbox"):
        if name not in body.names:
            raise InputError(
                f"point {name!r} is unknown: the body has {', '.join(body.names)}; name one of them"
            )
    springs = {name: np.asarray(k, dtype=float) for name, k in supports.items()}
    springs = {name: np.diag(k) if k.ndim == 1 else k for name, k in springs.items()}
    K, left = on_supports(body.names, body.stiffness, springs)
    kept = np.concatenate([6 * body.names.index(name) + FIVE for name in bearings])
    at = np.searchsorted(left, kept)
    if not np.isin(kept, left).all():
        raise InputError("a bearing's point stands on a rigid support besides: leave one out")
    others = np.setdiff1d(np.arange(len(left)), at)
    inner = K[np.ix_(others, others)]
    if min_eigenvalue(inner) < _FREE:
        raise InputError(
            "the shaft turns freely about its axis: bearings hold no torque, so give the gearbox "
            "a stiffness against rotation about x"
        )
    F = applied(body, load_points)
    inside = scaled_solve(inner, np.hstack([K[np.ix_(others, at)], F[left[others]]]))
    k = len(kept)
    reduced = K[np.ix_(at, at)] - K[np.ix_(at, others)] @ inside[:, :k]
    of_loads = np.zeros((len(body.stiffness), F.shape[1]))
    of_bearings = np.zeros((len(body.stiffness), k))
    of_loads[left[others]] = inside[:, k:]
    of_bearings[left[others]] = -inside[:, :k]
    of_bearings[kept] = np.eye(k)
    return LinearBody(
        tuple(bearings),
        0.5 * (reduced + reduced.T),
        F[kept] - K[np.ix_(at, others)] @ inside[:, k:],
        body,
        springs,
        of_loads,
        of_bearings,
        np.zeros((k, k)),
        tuple(load_points),
    )


def in_housings(body: LinearBody, housings: Mapping[str, ArrayLike]) -> LinearBody:
    """The body with the stiffness of housings in series with its bearings.

    With C their compliance, a deflection d of a bearing is its shaft's motion less C f, so that K
    becomes ``K (I + C K)^-1`` and the loads ``(I + K C)^-1 L``: compliances add.

    Parameters
    ----------
    body : LinearBody
        Body in rigid housings.
    housings : Mapping
        Stiffness (6, 6) between outer ring and ground of some bearings by name [N/m, N, N m/rad];
        rigid where not given.

    Returns
    -------
    found : LinearBody
        The same body over the bearings' own deflections.

    Raises
    ------
    InputError
        A bearing is unknown, or a housing has no stiffness against some motion.
    """
    C = np.zeros_like(body.housings)
    for name, stiffness in housings.items():
        if name not in body.bearings:
            raise InputError(
                f"housing of {name!r}: there is no such bearing; name one of "
                f"{', '.join(body.bearings)}"
            )
        k = np.asarray(stiffness, dtype=float)
        if k.shape != (6, 6) or not np.isfinite(k).all() or not min_eigenvalue(k) > _FREE:
            raise InputError(
                f"the housing of {name!r} must have a finite 6x6 stiffness that resists every "
                "motion: take it with the bearing bonded, without the joint that the rollers are"
            )
        rows = 5 * body.bearings.index(name) + np.arange(5)
        C[np.ix_(rows, rows)] = scaled_solve(0.5 * (k + k.T), np.eye(6))[np.ix_(FIVE, FIVE)]
    K = body.stiffness
    whole = np.eye(len(K)) + K @ C
    series = np.linalg.solve(whole, K)
    return replace(
        body,
        stiffness=0.5 * (series + series.T),
        loads=np.asarray(np.linalg.solve(whole, body.loads)),
        housings=body.housings + C,
    )


def applied(body: Condensed, load_points: Sequence[str] = ()) -> Floats:
    """Forces and moments at the points of a body, of the unit loads of `response.scene_loads`.

    Parameters
    ----------
    body : Condensed
        Body with the points "hub" and "gearbox".
    load_points : Sequence[str]
        Other points where loads enter.

    Returns
    -------
    loads : Floats
        (6 n, 10 + 6 m) [N, N m].
    """
    F = np.zeros((len(body.stiffness), len(LOADS) + 6 * len(load_points)))
    for k, name in enumerate(load_points):
        first = len(LOADS) + 6 * k
        F[body.rows(name), first : first + 6] = np.eye(6)
    F[body.rows("hub"), :6] = np.eye(6)
    F[:, 6:9] = body.gravity
    F[6 * body.names.index("gearbox") + 2, 9] = -1.0
    return F


@overload
def factors_of(
    hub_loads: PointLoads, gearbox_weight: float = 0.0, gravity: float = 0.0
) -> Factors: ...


@overload
def factors_of(
    hub_loads: ArrayLike, gearbox_weight: float = 0.0, gravity: float = 0.0
) -> Floats: ...


def factors_of(
    hub_loads: PointLoads | ArrayLike, gearbox_weight: float = 0.0, gravity: float = 0.0
) -> Factors | Floats:
    """Factors of the loads of `response.scene_loads`.

    Parameters
    ----------
    hub_loads : PointLoads or array_like
        Loads from `shafts.response.entering` of a history and a scene. An array, (n, 6) or (6,),
        has Fx, Fy, Fz [N], Mx, My, Mz [N m] on the shaft at the hub; then, six more each, at the
        load points of a body that has such, with their weights.
    gearbox_weight, gravity : float
        Weight [N] and acceleration [m/s^2], both along -z.

    Returns
    -------
    factors : Factors or Floats
        Factors (n, 10), or (n, 10 + 6 m) for m load points; an array for an array, which a scene
        refuses that states another point than its front face.

    Raises
    ------
    InputError
        The loads have another shape, one is no number, or they are a history.
    """
    if isinstance(hub_loads, PointLoads):
        return Factors(factors_of(hub_loads.values, gearbox_weight, gravity))
    if isinstance(hub_loads, LoadHistory):
        raise InputError(
            f"{hub_loads.name}: a history has no factors before it acts on a scene: give "
            "entering(scene, history)"
        )
    hub = np.atleast_2d(np.asarray(hub_loads, dtype=float))
    if hub.ndim != 2 or hub.shape[1] == 0 or hub.shape[1] % 6:
        raise InputError(
            f"hub loads have the shape {np.shape(hub_loads)}: give (n, 6), the columns being "
            "Fx, Fy, Fz, Mx, My, Mz, and six more for each load point"
        )
    if not np.isfinite(hub).all():
        case, column = np.argwhere(~np.isfinite(hub))[0]
        point, component = divmod(int(column), 6)
        where = f"load point {point}: " if point else ""
        raise InputError(
            f"{where}{LOADS[component].removeprefix('hub.' if point else '')} of load case {case} "
            f"is {hub[case, column]}: give finite numbers"
        )
    factors = np.zeros((len(hub), len(LOADS) + hub.shape[1] - 6))
    factors[:, :6] = hub[:, :6]
    factors[:, len(LOADS) :] = hub[:, 6:]
    factors[:, 8] = -gravity
    factors[:, 9] = gearbox_weight
    return factors
