"""What each section of a shaft endures: notch factors by formula and by elasticity, strength."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.drivetrain_file.shaft_strength import ShaftStrength
from fe_drivetrain.shafts.strength.din743 import (
    NotchEffect,
    SectionStrength,
    SteelData,
    section_strength,
)
from fe_drivetrain.shafts.strength.fillet_stress import LOADS, fillet_factor
from fe_drivetrain.shafts.strength.notches import (
    LEAST_RADIUS,
    by_support,
    hole_effect,
    measured_effect,
    turned_factors,
    turned_gradients,
)
from fe_drivetrain.shafts.strength.sections import ShaftSection

_NONE = np.zeros(3)


@dataclass(frozen=True, eq=False)
class RatedSection:
    """A section with all that its strength needs.

    Attributes
    ----------
    section : ShaftSection
        The section.
    effect : NotchEffect
        What its notch does.
    strength : SectionStrength
        What it endures.
    formula : ndarray, (3,)
        Stress concentration factors by the formulas of DIN 743-2; NaN where these have none.
    band : ndarray, (3,)
        Bands of the stress concentration factors by elasticity; zero where formulas gave them.
    gradients : ndarray, (3,)
        Relative stress gradients at the peak [1/m]; zero where there is none.
    by_elasticity : bool
        Whether elasticity gave the factors.
    remark : str
        Why not, or where formulas end; empty where there is nothing to say.
    """

    section: ShaftSection
    effect: NotchEffect
    strength: SectionStrength
    formula: Floats
    band: Floats
    gradients: Floats
    by_elasticity: bool = False
    remark: str = ""

    __repr__ = short_repr

    @property
    def of_solid(self) -> bool:
        """Whether a bored section has the stress concentration factors of a solid shaft."""
        return self.section.hollow and not self.by_elasticity and bool(self.effect.alpha.max() > 1)

    @property
    def relative_band(self) -> float:
        """Largest share by which the mesh of a fillet may change what is endured."""
        return float((self.band / self.effect.alpha).max())


def steel_of(stated: ShaftStrength) -> SteelData:
    """The steel of a shaft, with the fatigue limits of DIN 743-3 where none is stated.

    Parameters
    ----------
    stated : ShaftStrength
        As the file has it.
    """
    shares = (0.4, 0.5, 0.3)
    given = (stated.tension_limit, stated.bending_limit, stated.torsion_limit)
    tension, bending, torsion = (
        share * stated.tensile_strength if limit is None else limit
        for share, limit in zip(shares, given, strict=True)
    )
    return SteelData(
        stated.steel,
        stated.tensile_strength,
        stated.yield_strength,
        (tension, bending, torsion),
        stated.reference_diameter,
        stated.roughness,
        stated.hardening,
        stated.surface == "hardened",
    )


def rated_section(
    section: ShaftSection, steel: SteelData, material: Material, elastic: bool = True
) -> RatedSection:
    """Notch factors and strength of a section.

    Parameters
    ----------
    section : ShaftSection
        The section.
    steel : SteelData
        Strength of the shaft.
    material : Material
        Its elasticity.
    elastic : bool
        Whether fillets are solved in their meridian; formulas alone where False.
    """
    of_tensile, of_yield = steel.size_factors(section.raw)
    tensile, yielding = of_tensile * steel.tensile, of_yield * steel.yielding
    formula, band, gradients = np.full(3, np.nan), _NONE, _NONE
    solved, remark = False, ""
    if section.kind in ("shoulder", "groove"):
        size = (section.diameter, section.depth, section.radius)
        formula = turned_factors(section.kind, *size)
        gradients = turned_gradients(section.kind, *size)
        alpha = formula
        if section.radius < LEAST_RADIUS * section.depth:
            remark = f"formulas end at r/t {LEAST_RADIUS:g}"
        if elastic and section.kind == "shoulder":
            try:
                found = [fillet_factor(load, section.shoulder, material) for load in LOADS]
            except InputError as error:
                remark = f"formulas alone: {error}"
            else:
                solved, remark = True, ""
                alpha = np.array([one.peak.factor for one in found])
                band = np.array([one.band for one in found])
                gradients = np.array([one.peak.gradient for one in found])
        beta = by_support(alpha, gradients, yielding, steel.hard_surface)
        effect = NotchEffect(alpha, beta)
    elif section.kind == "hole":
        effect = hole_effect(section.diameter, section.radius, yielding, steel.hard_surface)
        formula = effect.alpha
    elif section.kind == "plain":
        effect = NotchEffect(np.ones(3), np.ones(3), turned=False)
    else:
        effect = measured_effect(section.kind, section.diameter, tensile)
    strength = section_strength(steel, section.diameter, effect, section.raw, section.hollow)
    return RatedSection(section, effect, strength, formula, band, gradients, solved, remark)
