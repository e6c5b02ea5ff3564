"""Strength of gear steels: limits, life curves, influence of oil, roughness, hardness and size.

ISO 6336-2 (flanks), -3 (roots) and -5 (limits). The standards were not read: equations stand in
IACS UR M56 and in public programs, and reproduce factors that KISSsoft 03/2017 prints for
case-hardened and through-hardened gears; life curves of nitrided ones have no such witness.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log, sqrt
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

Kind = Literal["case-hardened", "through-hardened", "nitrided"]

LONG_LIFE = 1e10
"""Cycles at which both life factors have come down to 0.85 in ISO 6336:2006."""


@dataclass(frozen=True)
class GearMaterial:
    """Steel of a gear.

    Attributes
    ----------
    kind : str
        "case-hardened" (also induction hardened), "through-hardened", or "nitrided".
    contact_limit : float
        Hertz pressure endured at the knee, sigma_Hlim [Pa].
    root_limit : float
        Nominal root stress endured at the knee, sigma_Flim [Pa]; twice that is sigma_FE.
    yield_strength : float
        Yield strength [Pa]; the notch sensitivity of through-hardened steel follows it, which must
        have it.
    brinell : float
        Hardness of the flank [HB]; counts where a through-hardened gear meets a hard one, which
        must have it.
    youngs_modulus : float
        Young's modulus [Pa].
    poisson_ratio : float
        Poisson ratio [-].
    density : float
        Density [kg/m^3].
    """

    kind: Kind
    contact_limit: float
    root_limit: float
    yield_strength: float = 0.0
    brinell: float = 0.0
    youngs_modulus: float = 206e9
    poisson_ratio: float = 0.3
    density: float = 7830.0

    def __post_init__(self) -> None:
        if self.kind not in CONTACT_LIFE:
            raise InputError(
                f"gear material of kind {self.kind!r}: give one of {', '.join(CONTACT_LIFE)}"
            )
        needed = ["contact_limit", "root_limit", "youngs_modulus", "density"]
        if self.kind == "through-hardened":
            needed += ["yield_strength", "brinell"]
        for name in needed:
            if not 0.0 < getattr(self, name) < inf:
                raise InputError(
                    f"{name.replace('_', ' ')} of a {self.kind} gear material is "
                    f"{getattr(self, name):g}: it must be positive and finite"
                )


@dataclass(frozen=True)
class LifeCurve:
    """Stress endured over cycles, straight between its points in logarithms.

    Attributes
    ----------
    cycles : tuple of float
        Rising; before the first the stress endured is that of the first.
    stresses : tuple of float
        Falling [Pa], or factors.
    endless : bool
        Whether less than the last stress is endured for ever; else the last line goes on.
    """

    cycles: tuple[float, ...]
    stresses: tuple[float, ...]
    endless: bool = True

    def __post_init__(self) -> None:
        falling = all(a >= b > 0.0 for a, b in zip(self.stresses, self.stresses[1:], strict=False))
        rising = all(0.0 < a < b for a, b in zip(self.cycles, self.cycles[1:], strict=False))
        if (
            len(self.cycles) != len(self.stresses)
            or len(self.cycles) < 2
            or not (rising and falling)
        ):
            raise InputError(
                f"life curve of stresses {self.stresses} at {self.cycles} cycles: give two points "
                "or more, with rising cycles and falling stresses"
            )

    def at(self, cycles: float) -> float:
        """Stress endured for so many cycles.

        Parameters
        ----------
        cycles : float
            Number of load cycles.

        Returns
        -------
        float
            Beyond the last point that of the last, or on its line.
        """
        if not self.endless and cycles > self.cycles[-1]:
            return float(self.stresses[-1] * (cycles / self.cycles[-1]) ** -self._last_power)
        x = np.log(self.cycles)
        return float(np.exp(np.interp(log(cycles), x, np.log(self.stresses))))

    def endured(self, stresses: ArrayLike) -> Floats:
        """Cycles until failure at each stress.

        Parameters
        ----------
        stresses : array_like, (n,)
            Stresses in the unit of the curve.

        Returns
        -------
        ndarray, (n,)
            0 above the first stress, infinite at or below the last of an endless curve.
        """
        stress = np.asarray(stresses, dtype=np.float64)
        with np.errstate(divide="ignore"):
            y = np.log(stress)
        cycles = np.exp(np.interp(-y, -np.log(self.stresses), np.log(self.cycles)))
        below = stress < self.stresses[-1]
        if self.endless:
            cycles[below | (stress == self.stresses[-1])] = np.inf
        else:
            with np.errstate(divide="ignore", over="ignore"):
                tail = (stress / self.stresses[-1]) ** (-1.0 / self._last_power)
            cycles = np.where(below, self.cycles[-1] * tail, cycles)
        return np.where(stress > self.stresses[0], 0.0, cycles)

    @property
    def _last_power(self) -> float:
        fall = log(self.stresses[-2] / self.stresses[-1])
        return fall / log(self.cycles[-1] / self.cycles[-2])


CONTACT_LIFE: dict[str, tuple[float, float, float]] = {
    "case-hardened": (1e5, 1.6, 5e7),
    "through-hardened": (1e5, 1.6, 5e7),
    "nitrided": (1e5, 1.3, 2e6),
}
"""Z_NT, where no pitting is allowed: last cycles of the static value, that value, the knee."""

ROOT_LIFE: dict[str, tuple[float, float, float]] = {
    "case-hardened": (1e3, 2.5, 3e6),
    "through-hardened": (1e4, 2.5, 3e6),
    "nitrided": (1e3, 1.6, 3e6),
}
"""Y_NT, with the same three values as `CONTACT_LIFE`."""


def life_factor(material: GearMaterial, cycles: float, root: bool = False) -> float:
    """Life factor Z_NT of the flank, or Y_NT of the root.

    Parameters
    ----------
    material : GearMaterial
        Material of the gear.
    cycles : float
        Load cycles of one flank of a tooth.
    root : bool
        Whether the root is asked for.

    Returns
    -------
    float
        1 at the knee, 0.85 from 1e10 on.
    """
    first, static, knee = (ROOT_LIFE if root else CONTACT_LIFE)[material.kind]
    return LifeCurve((first, knee, LONG_LIFE), (static, 1.0, 0.85)).at(cycles)


def lubricant_factor(contact_limit: float, viscosity: float) -> float:
    """Lubricant factor Z_L.

    Parameters
    ----------
    contact_limit : float
        sigma_Hlim of the softer gear [Pa].
    viscosity : float
        Kinematic viscosity of the oil at 40 degrees Celsius [m^2/s].

    Returns
    -------
    float
        1 near 100 mm^2/s.
    """
    C = _film_constant(contact_limit)
    return C + 4.0 * (1.0 - C) / (1.2 + 134e-6 / viscosity) ** 2


def velocity_factor(contact_limit: float, speed: float) -> float:
    """Velocity factor Z_v.

    Parameters
    ----------
    contact_limit : float
        sigma_Hlim of the softer gear [Pa].
    speed : float
        Speed at the reference circle [m/s].

    Returns
    -------
    float
        1 near 10 m/s.
    """
    C = _film_constant(contact_limit) + 0.02
    return C + 2.0 * (1.0 - C) / sqrt(0.8 + 32.0 / speed)


def roughness_factor(contact_limit: float, roughness: float, radius: float) -> float:
    """Roughness factor Z_R.

    Parameters
    ----------
    contact_limit : float
        sigma_Hlim of the softer gear [Pa].
    roughness : float
        Mean R_z of both flanks [m].
    radius : float
        Radius of relative curvature at the pitch point, rho_red [m].

    Returns
    -------
    float
        (3 um / R_z10)^C_ZR, R_z10 = R_z (10 mm / rho_red)^(1/3).
    """
    strength = min(max(1e-6 * contact_limit, 850.0), 1200.0)
    R_z10 = roughness * (0.01 / radius) ** (1.0 / 3.0)
    return float((3e-6 / R_z10) ** (0.32 - 0.0002 * strength))


def _film_constant(contact_limit: float) -> float:
    strength = min(max(1e-6 * contact_limit, 850.0), 1200.0)
    return 0.83 + 0.08 * (strength - 850.0) / 350.0


def hardness_factor(
    brinell: float, equivalent_roughness: float = 3e-6, static: bool = False
) -> float:
    """Work hardening factor Z_W of a through-hardened gear that meets a hard one.

    Parameters
    ----------
    brinell : float
        Brinell hardness of the softer gear [HB].
    equivalent_roughness : float
        R_zH of the hard one [m], counted from 3 to 16 um.
    static : bool
        Whether for static strength: 1.05 to 1 from 130 to 470 HB.

    Returns
    -------
    float
        Work hardening factor, at least 1.
    """
    hard = (min(max(brinell, 130.0), 470.0) - 130.0) / 1700.0
    if static:
        return 1.05 - 0.25 * hard
    rough = (3e-6 / min(max(equivalent_roughness, 3e-6), 16e-6)) ** 0.15
    return max(float((1.2 - hard) * rough), 1.0)


def equivalent_roughness(
    hard: float, soft: float, radius: float, viscosity: float, speed: float
) -> float:
    """Roughness R_zH of a hard gear as a through-hardened mate feels it.

    Parameters
    ----------
    hard, soft : float
        R_z of both flanks [m].
    radius : float
        Radius of relative curvature [m].
    viscosity : float
        Kinematic viscosity of the oil at 40 degrees Celsius [m^2/s].
    speed : float
        Speed at the reference circle [m/s].

    Returns
    -------
    float
        Equivalent roughness R_zH [m].
    """
    film = (1e6 * viscosity * speed / 1500.0) ** 0.33
    return float(hard * (0.01 / radius) ** 0.33 * (hard / soft) ** 0.66 / film)


SLIP_LAYERS = ((500e6, 600e6, 800e6, 1000e6), (0.0281, 0.0194, 0.0064, 0.0014))
"""Yield strength [Pa] and slip layer thickness rho' [mm] of through-hardened steel."""


def notch_factor(material: GearMaterial, notch: float) -> float:
    """Relative notch sensitivity factor Y_delta_relT.

    Parameters
    ----------
    material : GearMaterial
        Material of the gear.
    notch : float
        Notch parameter q_s.

    Returns
    -------
    float
        1 at q_s = 2.5, that of the test gear.
    """
    layer = {"case-hardened": 0.0030, "nitrided": 0.1005}.get(material.kind)
    if layer is None:
        layer = float(np.interp(material.yield_strength, *SLIP_LAYERS))
    return (1.0 + sqrt(0.2 * layer * (1.0 + 2.0 * notch))) / (1.0 + sqrt(1.2 * layer))


def surface_factor(material: GearMaterial, roughness: float) -> float:
    """Relative surface factor Y_R_relT of the root.

    Parameters
    ----------
    material : GearMaterial
        Material of the gear; through-hardened with a tensile strength of 800 MPa at least.
    roughness : float
        R_z of the fillet [m], counted from 1 to 40 um.

    Returns
    -------
    float
        1 near 10 um.
    """
    R_z = min(max(1e6 * roughness, 1.0), 40.0)
    if material.kind == "nitrided":
        return float(4.299 - 3.259 * (R_z + 1.0) ** 0.0058)
    return float(1.674 - 0.529 * (R_z + 1.0) ** 0.1)


def size_factor(material: GearMaterial, normal_module: float) -> float:
    """Size factor Y_X of the root.

    Parameters
    ----------
    material : GearMaterial
        Material of the gear.
    normal_module : float
        Normal module [m].

    Returns
    -------
    float
        1 up to 5 mm. IACS UR M56 prints 0.06 in place of 0.006 for through-hardened steel.
    """
    m = max(1e3 * normal_module, 5.0)
    if material.kind == "through-hardened":
        return max(1.03 - 0.006 * m, 0.85)
    return max(1.05 - 0.01 * m, 0.80)
