"""Safety of each section and joint of a shaft over all its loads, with bands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.shafts.strength.din743 import BENDING, TENSION, TORSION
from fe_drivetrain.shafts.strength.fatigue import AS_IT_IS, BETWEEN, MISSED, safety_of_damage
from fe_drivetrain.shafts.strength.local_stress import fkm_safety
from fe_drivetrain.shafts.strength.rated import RatedSection, steel_of
from fe_drivetrain.studies.strength_sections import StrengthShaft
from fe_drivetrain.studies.strength_sums import StrengthSums, worst_of


@dataclass(frozen=True)
class Banded:
    """A value between two bounds, and what meshes and counting may change of it."""

    value: float
    band: float


@dataclass(frozen=True, eq=False)
class SectionAnswer:
    """One section of a shaft.

    Attributes
    ----------
    rated : RatedSection
        The section, and what it endures.
    fatigue : Banded
        S_D: over all cycles of the life where loads vary, else as if they came for ever.
    static : Banded
        S_F.
    endurance : Banded
        S_D of the largest range as if it came for ever.
    damage : float
        Damage of the life by Miner's rule, at the worst point and bound; that of torque alone where
        it is larger.
    local_safety : float
        Second way: local stress of the largest range against the fatigue limit; NaN without a
        fillet solved by elasticity.
    nominal : ndarray, (3,)
        Largest nominal stress of axial force, bending and torque [Pa].
    local : Banded
        Largest local equivalent stress, of the largest of each [Pa].
    """

    rated: RatedSection
    fatigue: Banded
    static: Banded
    endurance: Banded
    damage: float
    local_safety: float
    nominal: Floats
    local: Banded

    __repr__ = short_repr

    @property
    def name(self) -> str:
        """Name of the section."""
        return self.rated.section.name


@dataclass(frozen=True)
class JointAnswer:
    """A joint that holds by friction.

    Attributes
    ----------
    name : str
        Its name.
    slip, opening : Banded
        Least safety against slip and separation; infinite where there is none to fear.
    required : tuple of float
        Least of both that are asked for.
    pressure : float
        Pressure of a press fit [Pa]; 0 of a flange.
    """

    name: str
    slip: Banded
    opening: Banded
    required: tuple[float, float]
    pressure: float = 0.0


def section_answers(
    shaft: StrengthShaft,
    parts: Sequence[StrengthSums],
    repeats: Floats,
    hours: float,
    varies: bool,
) -> list[SectionAnswer]:
    """Safety of all sections.

    Parameters
    ----------
    shaft : StrengthShaft
        The shaft.
    parts : sequence of StrengthSums
        Sums of each history.
    repeats : ndarray, (n,)
        How often each comes in the life.
    hours : float
        Hours of the life.
    varies : bool
        Whether safety is over all cycles of the life.
    """
    damage = sum(count * one.damage for count, one in zip(repeats.tolist(), parts, strict=True))
    static, endurance = worst_of(parts, "static"), worst_of(parts, "endurance")
    stresses = worst_of(parts, "stresses")
    means = np.array([one.means for one in parts])
    mean = np.take_along_axis(means, np.abs(means).argmax(axis=0)[None], axis=0)[0]
    steel = steel_of(shaft.stated)
    found = []
    for s, rated in enumerate(shaft.rated):
        mesh = rated.relative_band
        forever = _between(endurance[:, s], mesh + (MISSED if varies else 0.0))
        over_life = _over_life(np.asarray(damage)[:, s], mesh) if varies else forever
        nominal = stresses[:, s, :3].max(axis=0)
        local = _local_stress(rated, nominal)
        at = np.asarray(damage)[:, s, :, AS_IT_IS]
        second = np.nan
        if rated.by_elasticity:
            row = stresses[:, s].max(axis=0)
            alpha, G = rated.effect.alpha, rated.gradients
            second = fkm_safety(
                steel,
                rated.strength.tensile,
                (alpha[BENDING] * row[3], alpha[TORSION] * row[4]),
                (alpha[TENSION] * float(mean[:, s].max()), alpha[TORSION] * row[5]),
                (G[BENDING], G[TORSION]),
            )
        found.append(
            SectionAnswer(
                rated,
                over_life,
                _between(static[:, s], 0.0),
                forever,
                float(at.max()) if varies else 0.0,
                second,
                nominal,
                local,
            )
        )
    return found


def joint_answers(shaft: StrengthShaft, parts: Sequence[StrengthSums]) -> list[JointAnswer]:
    """Safety of all joints.

    Parameters
    ----------
    shaft : StrengthShaft
        The shaft.
    parts : sequence of StrengthSums
        Sums of each history.
    """
    slip, opening = worst_of(parts, "slip"), worst_of(parts, "opening")
    stated, model = shaft.stated, shaft.model
    named: list[tuple[str, tuple[float, float], float]] = []
    if stated.flange is not None:
        asked = (stated.flange.slip_safety, stated.flange.opening_safety)
        named.append(("flange", asked, 0.0))
    for fit, seat in zip(stated.press_fits, model.fits, strict=True):
        named.append((fit.name, (fit.slip_safety, 0.0), seat.pressure))
    return [
        JointAnswer(name, _between(slip[:, j], 0.0), _between(opening[:, j], 0.0), asked, pressure)
        for j, (name, asked, pressure) in enumerate(named)
    ]


def _between(values: Floats, share: float) -> Banded:
    """Middle of values at both bounds, with half of what they differ by, and a share of it."""
    low, high = float(values.min()), float(values.max())
    if not np.isfinite(low):
        return Banded(np.inf, 0.0)
    if not np.isfinite(high):
        return Banded(low, share * low)
    middle = 0.5 * (low + high)
    return Banded(middle, 0.5 * (high - low) + share * middle)


def _over_life(damage: Floats, mesh: float) -> Banded:
    """S_D over all cycles from damage (b, points + 1, factors)."""
    values, fewer = [], []
    for points in damage:
        torque = safety_of_damage(points[-1])
        normal = np.array([safety_of_damage(one) for one in points[:-1]])
        both = 1.0 / np.hypot(1.0 / normal, 1.0 / torque)
        values.append(float(both.min()))
        fewer.append(float(both[::2].min()))
    found = _between(np.array(values), mesh + MISSED + BETWEEN)
    if not np.isfinite(found.value):
        return found
    apart = float(np.abs(np.array(values) - fewer).max())
    return Banded(found.value, found.band + apart)


def _local_stress(rated: RatedSection, nominal: Floats) -> Banded:
    """Largest local equivalent stress, its band by those of the factors [Pa]."""
    alpha = rated.effect.alpha
    normal = alpha[TENSION] * nominal[TENSION] + alpha[BENDING] * nominal[BENDING]
    shear = alpha[TORSION] * nominal[TORSION]
    value = float(np.hypot(normal, np.sqrt(3.0) * shear))
    return Banded(value, rated.relative_band * value)
