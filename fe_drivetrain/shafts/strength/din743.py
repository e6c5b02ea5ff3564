"""Strength of a shaft's section by nominal stresses: size, surface, notch, mean stress (DIN 743).

DIN 743:2012 itself was not read. Equations are those that two independent open programs have in
common (hanslhansl/din743, commit c38c5c6; Schulz and Huss, ME_Wellennachweis, commit 45cfc59),
whose printed examples the case ``verification/din_743`` computes again. Of its S-N curves (part 4)
no public text was found: slopes and knee are those of the FKM guideline, from memory, UNVERIFIED.

Vectors of three are tension, bending, torsion; stresses are in Pa and lengths in m.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr

MPA = 1e6
MM = 1e-3
MICRON = 1e-6

LARGEST = 0.5
"""Diameter [m] at which the size factors of DIN 743 end; thicker sections take theirs of it."""

TENSION, BENDING, TORSION = range(3)

# K_1 of each steel: diameter from which it falls [mm], slope per decade, end [mm], value there
_TENSILE = {
    "quenched and tempered": (16.0, 0.26, 300.0, 0.67),
    "case-hardened CrNiMo": (16.0, 0.26, 300.0, 0.67),
    "case-hardened": (16.0, 0.41, 150.0, 0.6),
    "structural": (100.0, 0.23, 300.0, 0.89),
    "nitrided": (100.0, 0.23, 300.0, 0.89),
}
_YIELD = {
    **_TENSILE,
    "quenched and tempered": (16.0, 0.34, 300.0, 0.57),
    "structural": (32.0, 0.26, 300.0, 0.75),
}


def size_factor(steel: str, diameter: float, of_yield: bool = False) -> float:
    """Technological size factor K_1 (DIN 743-2, Eq 10 to 14).

    Parameters
    ----------
    steel : str
        Kind of steel, see `fe_drivetrain.drivetrain_file.shaft_strength.Steel`.
    diameter : float
        Diameter d_eff at the heat treatment [m]; above `LARGEST` the factor stays.
    of_yield : bool
        Whether it is of the yield strength, not of the tensile strength.
    """
    start, slope, end, last = (_YIELD if of_yield else _TENSILE)[steel]
    d = diameter / MM
    if d <= start:
        return 1.0
    return 1.0 - slope * float(np.log10(d / start)) if d < end else last


def geometric_size_factor(diameter: float) -> float:
    """Size factor K_2 of bending and torsion: 1 at 7.5 mm, 0.8 from 150 mm (DIN 743-2, Eq 16)."""
    d = min(max(diameter / MM, 7.5), 150.0)
    return 1.0 - 0.2 * float(np.log10(d / 7.5) / np.log10(20.0))


def roughness_factor(roughness: float, tensile: float) -> float:
    """Surface factor K_F of normal stress (DIN 743-2, Eq 18); the FKM guideline's K_R, too.

    Parameters
    ----------
    roughness : float
        R_z [m]; smooth below 1 um.
    tensile : float
        Tensile strength of the section [Pa].
    """
    rz = max(roughness / MICRON, 1.0)
    return 1.0 - 0.22 * float(np.log10(rz) * (np.log10(tensile / MPA / 20.0) - 1.0))


@dataclass(frozen=True, eq=False)
class NotchEffect:
    """What a notch does to a section.

    Attributes
    ----------
    alpha : ndarray, (3,)
        Stress concentration factors of elasticity; 1 where a notch has measured factors alone.
    beta : ndarray, (3,)
        Fatigue notch factors.
    turned : bool
        Whether it goes round the shaft, so that it hinders yielding.
    rough : bool
        Whether the roughness counts beside it; measured factors of hubs and keys include it.
    """

    alpha: Floats
    beta: Floats
    turned: bool = True
    rough: bool = True

    __repr__ = short_repr


@dataclass(frozen=True)
class SteelData:
    """Steel of a shaft as its file states it, all limits given.

    Attributes
    ----------
    steel : str
        Kind of steel.
    tensile, yielding : float
        Strengths at the reference diameter [Pa].
    limits : tuple of float
        Fatigue limits at the reference diameter of tension, bending and torsion, reversed [Pa].
    reference : float or None
        The reference diameter [m]; that of the tables of DIN 743-3 where None.
    roughness : float
        R_z [m].
    hardening : float
        K_V.
    hard_surface : bool
        Whether the surface is hardened.
    """

    steel: str
    tensile: float
    yielding: float
    limits: tuple[float, float, float]
    reference: float | None = None
    roughness: float = 12.5e-6
    hardening: float = 1.0
    hard_surface: bool = False

    def size_factors(self, diameter: float) -> tuple[float, float]:
        """K_1 of tensile and of yield strength at a diameter [m], over those at the reference."""
        found = []
        for of_yield in (False, True):
            whole = size_factor(self.steel, diameter, of_yield)
            at = (
                1.0 if self.reference is None else size_factor(self.steel, self.reference, of_yield)
            )
            found.append(min(whole / at, 1.0))
        return found[0], found[1]


@dataclass(frozen=True, eq=False)
class SectionStrength:
    """What a section endures in nominal stress.

    Attributes
    ----------
    tensile, yielding : float
        Strengths of the section [Pa].
    reversed : ndarray, (3,)
        Amplitudes endured without a mean stress, sigma_WK and tau_WK [Pa].
    yields : ndarray, (3,)
        Nominal stresses at which it yields, sigma_FK and tau_FK [Pa].
    influence : ndarray, (3,)
        K_sigma and K_tau: by how much notch, size and surface reduce the fatigue limit.
    """

    tensile: float
    yielding: float
    reversed: Floats
    yields: Floats
    influence: Floats

    __repr__ = short_repr

    @property
    def sensitivity(self) -> Floats:
        """(3,) mean stress sensitivity psi (DIN 743-1, Eq 20 to 22)."""
        return np.asarray(self.reversed / (2.0 * self.tensile - self.reversed))


def section_strength(
    steel: SteelData, diameter: float, effect: NotchEffect, raw: float, hollow: bool = False
) -> SectionStrength:
    """Strength of a section (DIN 743-1, Eq 5 to 9, 31, 32, tables 2 and 3).

    Parameters
    ----------
    steel : SteelData
        The steel.
    diameter : float
        Diameter of the section at the notch [m].
    effect : NotchEffect
        What the notch does.
    raw : float
        Diameter at the heat treatment [m].
    hollow : bool
        Whether the shaft is bored, which leaves less to yield.
    """
    of_tensile, of_yield = steel.size_factors(raw)
    tensile, yielding = of_tensile * steel.tensile, of_yield * steel.yielding
    smooth = roughness_factor(steel.roughness, tensile) if effect.rough else 1.0
    surface = np.array([smooth, smooth, 0.575 * smooth + 0.425])
    bent = geometric_size_factor(diameter)
    geometry = np.array([1.0, bent, bent])
    influence = (effect.beta / geometry + 1.0 / surface - 1.0) / steel.hardening
    hinders = effect.turned and not steel.hard_surface
    gamma = [yield_increase(a) if hinders else 1.0 for a in effect.alpha[:2]] + [1.0]
    if steel.hard_surface:
        support = np.ones(3)
    else:
        support = np.array([1.0, 1.1, 1.0]) if hollow else np.array([1.0, 1.2, 1.2])
    shear = np.array([1.0, 1.0, 1.0 / np.sqrt(3.0)])
    return SectionStrength(
        tensile,
        yielding,
        of_tensile * np.asarray(steel.limits) / influence,
        support * np.asarray(gamma) * yielding * shear,
        influence,
    )


def yield_increase(alpha: float) -> float:
    """Factor gamma_F by which a notch round the shaft raises the yield point (table 2)."""
    return float(1.0 + 0.05 * np.searchsorted([1.5, 2.0, 3.0], alpha, side="right"))


def equivalent_mean(tension: ArrayLike, bending: ArrayLike, torsion: ArrayLike) -> Floats:
    """Equivalent mean stress sigma_mv of mean stresses (DIN 743-1, Eq 23).

    Compression on the whole helps in DIN 743; here it counts as no mean stress.

    Parameters
    ----------
    tension, bending, torsion : array_like
        Mean nominal stresses of any shape [Pa].
    """
    normal = np.asarray(tension, dtype=float) + np.asarray(bending, dtype=float)
    shear = 3.0 * np.square(torsion)
    square = np.where(normal < 0.0, shear - normal**2, shear + normal**2)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))


def endured_amplitudes(
    strength: SectionStrength, amplitudes: Floats, mean: ArrayLike, case: int
) -> Floats:
    """Amplitudes endured beside a mean stress, sigma_ADK and tau_ADK (DIN 743-1, Eq 10 to 19).

    Parameters
    ----------
    strength : SectionStrength
        The section.
    amplitudes : ndarray, (..., 3)
        Amplitudes that act [Pa]; where one is zero, case 2 has no limit but zero, and gives that.
    mean : array_like, (...,)
        Equivalent mean stress sigma_mv [Pa].
    case : int
        1: the mean stays as amplitudes grow; 2: both grow.

    Returns
    -------
    ndarray, (..., 3)
        Never below 0 [Pa].
    """
    mv = np.asarray(mean, dtype=float)[..., None] * np.array([1.0, 1.0, 1.0 / np.sqrt(3.0)])
    WK, FK, psi = strength.reversed, strength.yields, strength.sensitivity
    if case == 1:
        return np.asarray(np.maximum(np.minimum(WK - psi * mv, FK - mv), 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(mv > 0.0, mv / np.asarray(amplitudes, dtype=float), 0.0)
    return np.asarray(np.minimum(WK / (1.0 + psi * ratio), FK / (1.0 + ratio)))


def combined_safety(amplitudes: Floats, endured: Floats) -> Floats:
    """Safety of stresses that act together (DIN 743-1, Eq 2 and 25).

    Parameters
    ----------
    amplitudes, endured : ndarray, (..., 3)
        Nominal stresses that act, and what is endured of each alone [Pa].

    Returns
    -------
    ndarray, (...)
        Infinite where nothing acts.
    """
    acting = np.abs(amplitudes)
    with np.errstate(divide="ignore", invalid="ignore"):
        used = np.where(acting > 0.0, acting / endured, 0.0)
        return np.asarray(1.0 / np.hypot(used[..., 0] + used[..., 1], used[..., 2]))
