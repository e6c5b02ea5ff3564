"""Fatigue of a section over cycles: damage at a series of load factors, by Miner's rule.

The safety over a spectrum is the factor of all loads that just brings failure: so damage is summed
at factors that are fixed beforehand, which adds up over histories in little memory, and loses
neither the means of cycles nor their sizes to classes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from fe_drivetrain.common.arrays import Floats, chunks
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.shafts.strength.din743 import BENDING, TENSION, TORSION, SectionStrength
from fe_drivetrain.turbine_loads.histories.cycles import Cycles, gated, streamed_cycles
from fe_drivetrain.turbine_loads.histories.damage import SNCurve

FACTORS = np.exp(0.015 * np.arange(-154, 228))
"""Load factors at which damage is summed, 0.1 to 30 in steps of 1.5 %, 1 among them."""

AS_IT_IS = 154
"""Number of the factor 1."""

BETWEEN = 0.0025
"""Share by which the factor may be wrong that is interpolated between two of `FACTORS`: a quarter
of a step where all cycles are at the knee of the S-N curve (5 % of its slope 9 less 5), no more."""

SMALLEST = 0.05
"""Cycles of a smaller share of the largest are left out: their damage is less than 1e-6 of one."""

_AT_ONCE = 2048  # cycles, each at all factors

WIDEST_STEP = np.radians(10.0)
"""Largest turn of the shaft from one sample to the next: peaks of bending are then missed by less
than 1 - cos(5 deg) = 0.4 %."""

MISSED = float(1.0 - np.cos(WIDEST_STEP / 2.0))
"""Share of an amplitude that samples may miss."""


@dataclass(frozen=True)
class Rule:
    """How cycles are assessed.

    Attributes
    ----------
    case : int
        Case of DIN 743-1: 1, the mean stress stays as loads grow; 2, both grow.
    slopes : tuple of float
        Exponents of the S-N curves of normal and of shear stress.
    knee : float
        Cycles at the knee of both.
    haibach : bool
        Whether the slope below the knee is 2 k - 1; k elsewhere.
    """

    case: int = 2
    slopes: tuple[float, float] = (5.0, 8.0)
    knee: float = 1e6
    haibach: bool = True

    def curve(self, shear: bool) -> SNCurve:
        """S-N curve over the share of the endured amplitude."""
        k = self.slopes[int(shear)]
        return SNCurve(1.0, self.knee, k, 2.0 * k - 1.0 if self.haibach else k)


def damage_at_factors(
    strength: SectionStrength,
    rule: Rule,
    cycles: Cycles,
    beside: float,
    shear: bool = False,
) -> Floats:
    """Damage of cycles at each of `FACTORS` of all loads.

    Parameters
    ----------
    strength : SectionStrength
        What the section endures.
    rule : Rule
        How cycles are assessed.
    cycles : Cycles
        Cycles of the nominal normal stress, or of the shear stress [Pa].
    beside : float
        Mean of the other of both stresses, which acts beside them [Pa].
    shear : bool
        Whether they are of shear stress.

    Returns
    -------
    ndarray, (len(FACTORS),)
        Infinite where cycles have a mean stress that alone is not endured.
    """
    kind = TORSION if shear else BENDING
    curve, found = rule.curve(shear), np.zeros(len(FACTORS))
    # what never comes does no damage, whatever its mean
    come = np.flatnonzero(cycles.counts > 0.0)
    WK, FK = strength.reversed[kind], strength.yields[kind]
    psi = strength.sensitivity[kind]
    for part in chunks(len(come), _AT_ONCE):
        rows = come[part]
        half, count, mean = 0.5 * cycles.ranges[rows], cycles.counts[rows], cycles.means[rows]
        normal, torsion = (beside, mean) if shear else (mean, beside)
        square = np.sign(normal) * np.square(normal) + 3.0 * np.square(torsion)
        mv = np.sqrt(np.maximum(square, 0.0)) / (np.sqrt(3.0) if shear else 1.0)
        means = mv[:, None] * (np.ones_like(FACTORS) if rule.case == 1 else FACTORS)
        endured = np.minimum(WK - psi * means, FK - means)
        held = endured > 0.0
        acting = half[:, None] * FACTORS
        share = np.where(held, acting / np.where(held, endured, 1.0), np.inf)
        with np.errstate(divide="ignore"):
            found += count @ (1.0 / curve.endured(share))
    return found


def safety_of_damage(damage: Floats) -> float:
    """Factor of all loads at which the damage is 1, from damage at `FACTORS`.

    Parameters
    ----------
    damage : ndarray, (len(FACTORS),)
        Rising; zero where there is no cycle.

    Returns
    -------
    float
        Infinite without damage; the first or the last of `FACTORS` beyond these.
    """
    known = (damage > 0.0) & np.isfinite(damage)
    if not known.any():
        return float("inf") if not (damage > 0.0).any() else float(FACTORS[0])
    first = int(np.argmax(known))
    if damage[first] >= 1.0:
        return float(FACTORS[first])
    x, y = np.log(FACTORS[known]), np.log(damage[known])
    if y[-1] < 0.0:  # a mean stress is not endured beyond
        return float(np.exp(x[-1]))
    above = int(np.searchsorted(y, 0.0))
    around = slice(max(above - 4, 0), above + 4)
    steps = np.flatnonzero(np.diff(y[around]) > 0.0)
    xs, ys = x[around], y[around]
    keep = np.append(steps, steps[-1] + 1)
    return float(np.exp(PchipInterpolator(ys[keep], xs[keep])(0.0)))


@dataclass(frozen=True, eq=False)
class TurningStress:
    """Nominal stresses of a section over time, with the angle that the shaft has turned.

    Attributes
    ----------
    tension, bending_y, bending_z, torsion : ndarray, (n,)
        Stresses of axial force, of the moment about -y, which pulls above, of that about z, which
        pulls at +y, and of torque [Pa].
    angle : ndarray, (n,)
        Angle of the shaft about x [rad].
    """

    tension: Floats
    bending_y: Floats
    bending_z: Floats
    torsion: Floats
    angle: Floats

    __repr__ = short_repr

    @property
    def bending(self) -> Floats:
        """(n,) largest bending stress round the section [Pa]."""
        return np.hypot(self.bending_y, self.bending_z)

    def of_point(self, place: float) -> Floats:
        """(n,) bending stress at a point of the surface that turns with the shaft [Pa].

        Parameters
        ----------
        place : float
            Its angle from y to z where the shaft has not turned [rad].
        """
        at = self.angle + place
        return np.asarray(self.bending_z * np.cos(at) + self.bending_y * np.sin(at))


def turning_stress(forces: Floats, moduli: Floats, angle: Floats) -> TurningStress:
    """Nominal stresses of a section, refined where the shaft turns far from sample to sample.

    Parameters
    ----------
    forces : ndarray, (n, 6)
        Forces of the part in front on the part behind [N, N m].
    moduli : ndarray, (3,)
        Area [m^2] and section moduli of bending and torsion [m^3].
    angle : ndarray, (n,)
        Angle that the shaft has turned [rad].
    """
    columns = np.column_stack(
        [
            -forces[:, 0] / moduli[TENSION],
            -forces[:, 4] / moduli[BENDING],
            forces[:, 5] / moduli[BENDING],
            forces[:, 3] / moduli[TORSION],
            angle,
        ]
    )
    steps = np.abs(np.diff(angle)).max(initial=0.0)
    parts = int(np.ceil(steps / WIDEST_STEP - 1e-9))
    if parts > 1:
        at = np.arange(len(columns))
        fine = np.linspace(0.0, len(columns) - 1.0, parts * (len(columns) - 1) + 1)
        columns = np.column_stack([np.interp(fine, at, column) for column in columns.T])
    return TurningStress(*(np.ascontiguousarray(column) for column in columns.T))


def damage_of_point(
    stress: TurningStress, strength: SectionStrength, rule: Rule, place: float
) -> Floats:
    """Damage at `FACTORS` of the normal stress at a point that turns with the shaft.

    Axial force and bending count together: the axial stress as bending that does the same.

    Parameters
    ----------
    stress : TurningStress
        Stress of the section over time.
    strength : SectionStrength
        What it endures.
    rule : Rule
        How cycles are assessed.
    place : float
        Angle of the point [rad].
    """
    as_bending = float(strength.reversed[BENDING] / strength.reversed[TENSION])
    constant = float(stress.tension.mean())
    varying = stress.tension - constant
    signal = stress.of_point(place) + as_bending * varying + constant
    beside = float(stress.torsion.mean())
    return _over(signal, strength, rule, beside, shear=False)


def damage_of_torque(stress: TurningStress, strength: SectionStrength, rule: Rule) -> Floats:
    """Damage at `FACTORS` of the shear stress of the torque; see `damage_of_point`."""
    beside = float(stress.tension.mean())
    return _over(stress.torsion, strength, rule, beside, shear=True)


def _over(
    signal: Floats, strength: SectionStrength, rule: Rule, beside: float, shear: bool
) -> Floats:
    found, least = np.zeros(len(FACTORS)), SMALLEST * float(np.ptp(signal))
    for cycles in streamed_cycles([signal]):
        found += damage_at_factors(strength, rule, gated(cycles, least), beside, shear)
    return found
