"""Local stress of a fillet against the fatigue limit of its steel, after the FKM guideline.

The guideline was not read. Its surface factor K_R (constant 0.22, least strength 400 MPa) and the
mean stress sensitivity of steel (0.35, -0.1) are those of public texts; support factors (a_G 0.5,
b_G 2700 MPa), the notch factor 2 beside the roughness, the fatigue limit 0.45 R_m and the share of
shear 0.577 are from memory, UNVERIFIED: a second way beside DIN 743, and no proof.
"""

from __future__ import annotations

import math

import numpy as np

from fe_drivetrain.shafts.strength.din743 import MM, MPA, SteelData, roughness_factor

SHEAR = 0.577
"""Fatigue limit of shear over that of tension."""

LIMIT = 0.45
"""Fatigue limit of tension and compression over the tensile strength."""

_A_G, _B_G = 0.5, 2700.0  # of steel; the second in MPa
_A_M, _B_M = 0.35, -0.1  # of steel
_ESTIMATED_NOTCH = 2.0


def fkm_support(gradient: float, tensile: float) -> float:
    """Support factor n of a relative stress gradient.

    Parameters
    ----------
    gradient : float
        Relative stress gradient normal to the surface [1/m].
    tensile : float
        Tensile strength, in shear times `SHEAR` [Pa].
    """
    G, power = gradient * MM, _A_G + tensile / MPA / _B_G
    if G <= 0.1:
        return float(1.0 + G * 10.0 ** -(power - 0.5))
    if G <= 1.0:
        return float(1.0 + np.sqrt(G) * 10.0**-power)
    return float(1.0 + G**0.25 * 10.0**-power)


def mean_factor(mean_over_amplitude: float, sensitivity: float) -> float:
    """Factor K_AK of a mean stress that grows with the amplitude (overload case F2).

    Parameters
    ----------
    mean_over_amplitude : float
        Mean stress over amplitude.
    sensitivity : float
        Mean stress sensitivity M.
    """
    t, M = mean_over_amplitude, sensitivity
    if t < -1.0:
        return 1.0 / (1.0 - M)
    if t <= 1.0:
        return 1.0 / (1.0 + M * t)
    bent = (1.0 + M / 3.0) / (1.0 + M)
    return bent / (1.0 + M / 3.0 * min(t, 3.0))


def fkm_safety(
    steel: SteelData,
    tensile: float,
    amplitudes: tuple[float, float],
    means: tuple[float, float],
    gradients: tuple[float, float],
) -> float:
    """Safety of local stresses against the fatigue limit.

    Parameters
    ----------
    steel : SteelData
        The steel.
    tensile : float
        Tensile strength of the section [Pa].
    amplitudes, means : tuple of float
        Local normal and shear stress [Pa].
    gradients : tuple of float
        Their relative gradients into the shaft [1/m].

    Returns
    -------
    float
        Infinite without amplitude. The guideline asks for 1.5 where a failure does great harm.
    """
    rough = roughness_factor(steel.roughness, tensile)
    sensitivity = max(_A_M * tensile / MPA / 1000.0 + _B_M, 0.0)
    mean = float(np.sqrt(max(means[0], 0.0) ** 2 + 3.0 * means[1] ** 2))
    used = []
    for k, share in enumerate((1.0, SHEAR)):
        amplitude = abs(amplitudes[k])
        if amplitude == 0.0:
            used.append(0.0)
            continue
        n = fkm_support(gradients[k], share * tensile)
        surface = 1.0 - share * (1.0 - rough)
        weakened = (1.0 + (1.0 / surface - 1.0) / _ESTIMATED_NOTCH) / (n * steel.hardening)
        acting = mean if k == 0 else mean / np.sqrt(3.0)
        factor = mean_factor(float(acting / amplitude), share * sensitivity)
        used.append(amplitude / (factor * share * LIMIT * tensile / weakened))
    both = math.hypot(*used)
    return math.inf if both == 0.0 else 1.0 / both
