"""Loads of blade roots of a turbine that moves: what a pitch bearing and its drive carry.

A blade gives its root the forces of the air, its weight, and what its inertia takes, at the places
to which it is bent, coned and pitched. At azimuth psi, x is downwind out of the plane of rotation,
r outwards along the blade and t the way it turns; the root's point is on the pitch axis at the
radius of the root. Not in it: aerofoils' own pitching moment, centres of mass and of shear beside
the pitch axis, twisting blades, a surplus of mass. So torsion is that of bent blades alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.hub_loads.controller import Controller, designed_controller
from fe_drivetrain.turbine_loads.hub_loads.moving_turbine import (
    TurbineHistory,
    simulated_condition,
)
from fe_drivetrain.turbine_loads.hub_loads.surrogate import DURATION, RATE, Condition
from fe_drivetrain.turbine_loads.hub_loads.turbine import (
    IN,
    OUT,
    BladeModes,
    Physics,
    Turbine,
    blade_modes,
)
from fe_drivetrain.turbine_loads.hub_loads.turbine_parts import turbulence_of

ROOT_LOADS = (
    "root shear force y",
    "root axial force",
    "root shear force z",
    "root bending y",
    "root torsion",
    "root bending z",
)
"""Components by the names of Table 5.3 of PROTEST 2010, y downwind and z the way it turns."""


@dataclass(frozen=True, eq=False)
class BladeRoots:
    """A run of a turbine, and what its blades do to their roots.

    Attributes
    ----------
    made : TurbineHistory
        The run.
    loads : ndarray, (n, 3, 6)
        Forces and moments of each blade on the hub, along and about x (downwind), r (outwards) and
        t (the way it turns) [N, N m]; positive torsion resists pitching to feather.
    """

    made: TurbineHistory
    loads: Floats

    __repr__ = short_repr

    @property
    def bending(self) -> Floats:
        """(n, 3) tilting moment of each pitch bearing [N m]."""
        return np.asarray(np.hypot(self.loads[..., 3], self.loads[..., 5]))

    @property
    def shear(self) -> Floats:
        """(n, 3) radial force on each pitch bearing [N]."""
        return np.asarray(np.hypot(self.loads[..., 0], self.loads[..., 2]))


def blade_roots(
    condition: Condition,
    turbine: Turbine,
    controller: Controller | None = None,
    duration: float = DURATION,
    rate: float = RATE,
) -> BladeRoots:
    """Make one history with the loads of blade roots, without looking on disk.

    Parameters
    ----------
    condition : Condition
        The wind.
    turbine : Turbine
        The turbine; a surplus of mass is left out of the roots.
    controller : Controller or None
        `designed_controller` if not given.
    duration, rate : float
        Length [s], and samples per second [Hz].

    Raises
    ------
    InputError
        As `turbine_history`.
    """
    chosen = controller or designed_controller(turbine)
    field = turbulence_of(turbine, condition.wind_speed, duration, rate)
    made, beside, _ = simulated_condition(condition, turbine, chosen, Physics(), field)
    return BladeRoots(made, root_loads(turbine, beside))


@dataclass(frozen=True)
class _Blade:
    """One blade over time: where it is, how its hub moves, and its bending."""

    sin: Floats
    cos: Floats
    speed: Floats
    faster: Floats
    hub: Floats  # (2, n) acceleration, fore and to the side
    q: Floats  # (2, n) by mode
    rate: Floats
    second: Floats
    turned: Floats  # (2, 2, n) components after pitch by those before

    def by_mode(self, values: Floats, part: int) -> Floats:
        """(2, n) integrals by mode of a component after pitch."""
        return np.asarray(np.einsum("cn,ac->an", self.turned[part], values))

    def products(self, products: Floats, one: int, other: int) -> Floats:
        """(2, 2, n) integrals of two modes' components after pitch."""
        return np.asarray(
            np.einsum("cn,dn,abcd->abn", self.turned[one], self.turned[other], products)
        )


def root_loads(turbine: Turbine, beside: Floats) -> Floats:
    """Loads of blade roots from what `simulate` gives beside the hub loads.

    Parameters
    ----------
    turbine : Turbine
        The turbine that was simulated.
    beside : ndarray, (n, 68)
        Its second result.

    Returns
    -------
    ndarray, (n, 3, 6)
        As `BladeRoots` has them.
    """
    from fe_drivetrain.turbine_loads.hub_loads import turbine_air as air

    modes = blade_modes(turbine)
    pitch, state = beside[:, 0], beside[:, 4 : 4 + air.STATES].T
    rates = beside[:, 4 + air.STATES : 4 + 2 * air.STATES].T
    sums = beside[:, 4 + 2 * air.STATES :].reshape(len(beside), 3, air.SUMS)
    found = np.empty((len(beside), 3, 6))
    for i in range(3):
        angle = state[air.PSI] + 2.0 * np.pi * i / 3.0
        c, s = (of(pitch + turbine.pitch_errors[i]) for of in (np.cos, np.sin))
        at = [air.MODES + i, air.MODES + 6 + i]
        blade = _Blade(
            np.sin(angle),
            np.cos(angle),
            state[air.SPEED],
            rates[air.SPEED],
            rates[[air.FORE_RATE, air.SIDE_RATE]],
            state[at],
            state[[k + air.RATES - air.MODES for k in at]],
            rates[[k + air.RATES - air.MODES for k in at]],
            np.array([[c, -s], [s, c]]),
        )
        found[:, i] = _root_of(turbine, modes, blade, sums[:, i].T).T
    return found


def _root_of(turbine: Turbine, modes: BladeModes, blade: _Blade, sums: Floats) -> Floats:
    """(6, n) of one blade; sums (8, n) of the air over it."""
    m, first, second = turbine.blade_mass, modes.first_moment, modes.second_moment
    root, cone, W, q = turbine.blade_root, turbine.cone, blade.speed, blade.q
    g, tilt = turbine.rotor.gravity, turbine.rotor.shaft_tilt
    arm, inertia = first - root * m, second - root * first  # of r - root, with m and with m r
    # what acts on each kilogram beside what its place adds, along x, r and t
    out = g * np.sin(tilt) - blade.hub[0]
    pull = -g * np.cos(tilt) * blade.cos + blade.sin * blade.hub[1]
    drive = g * np.cos(tilt) * blade.sin + blade.cos * blade.hub[1]
    FX, FT = (blade.by_mode(modes.force, part) for part in (OUT, IN))
    RX, RT = (blade.by_mode(modes.moment, part) for part in (OUT, IN))
    AX, AT = RX - root * FX, RT - root * FT
    XT, TT = (blade.products(modes.products, one, IN) for one in (OUT, IN))
    gone = W**2 * q - blade.second  # of each mode in the plane
    swept = 2.0 * W * blade.rate

    def bent(one: Floats, by: Floats) -> Floats:
        return np.asarray(np.einsum("an,an->n", one, by))

    def both(of: Floats, one: Floats, other: Floats) -> Floats:
        return np.asarray(np.einsum("abn,an,bn->n", of, one, other))

    Fx = sums[0] + m * out - bent(FX, blade.second)
    Ft = sums[2] + m * drive - first * blade.faster + bent(FT, gone)
    Fr = m * pull + W**2 * first + bent(FT, swept)
    flap = sums[1] - root * sums[0] + arm * out - bent(AX, blade.second)
    flap -= bent(q, W**2 * RX + pull * FX) + both(XT, q, swept)
    flap += cone * (W**2 * inertia + pull * arm + bent(AT, swept))
    driven = sums[3] - root * sums[2] + arm * drive - inertia * blade.faster + bent(AT, gone)
    edge = driven - (bent(q, W**2 * RT + pull * FT) + both(TT, q, swept))
    torsion = bent(q, sums[6:8]) + bent(q, FT * out) - both(XT, blade.second, q)
    torsion -= bent(q, FX * drive - RX * blade.faster) + both(XT, q, gone)
    torsion += cone * driven
    return np.stack([Fx, Fr, Ft, edge, torsion, -flap])
