"""Main-bearing load from the closed forms of Stirling 2023, chapter 3, and from one beam.

All answer one question: which load does the shaft put ON the main bearing, given the hub load?
The load is (Fx, Fy, Fz, Mx, My, Mz) at the bearing's centre, in the shaft's frame (x downwind,
z up, y = z cross x; hub at x = -L1, bearing at 0, gearbox at x = +L2). The force on the shaft is
its negative.

The closed forms live in a plane, with a hub force B and a hub moment M. Moments about the gearbox
give what each plane takes from the frame:

======================  =====  =====  ===========================  ==========================
plane                   B      M      bearing force R_A            bearing moment M_T
======================  =====  =====  ===========================  ==========================
vertical (tilt)         Fz     My     Fz                           My
horizontal (yaw)        Fy     -Mz    Fy                           -Mz
======================  =====  =====  ===========================  ==========================

A force at the gearbox, G in the thesis, counts positive *in the direction of B*. With B = Fz that
is upward, so a weight W enters as G = -W; only with B positive downward is it +W. Entering +W
beside an upward B shifts the bearing force by twice the weight's share of it: 2 x 58.8 kN with
the thesis's numbers and a steel shaft.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material
from fe_drivetrain.shafts.beam.beam import Beam, Support
from fe_drivetrain.shafts.beam.sections import BeamSection

_MAY_BE_INFINITE = ("radial_stiffness", "axial_stiffness", "tilt_stiffness", "yaw_stiffness")
_MAY_BE_ZERO = ("axial_stiffness", "tilt_stiffness", "yaw_stiffness", "gearbox_weight", "bore")


@dataclass(frozen=True)
class MainBearingBeam:
    """Shaft on one main bearing and a gearbox; defaults are Table 3.1 of Stirling 2023.

    Attributes
    ----------
    overhang : float
        Length L1, hub to main bearing, m.
    span : float
        Length L2, main bearing to gearbox, m.
    radial_stiffness, axial_stiffness : float
        Stiffness K1 and K2 of the gearbox connection, N/m; `inf` is rigid.
    gearbox_weight : float
        Weight at the gearbox along -z, N, so positive is downward.
    shaft_diameter, bore : float
        Diameters, m.
    tilt_stiffness, yaw_stiffness : float
        Stiffness K_R of the bearing about y (vertical plane) and about z (horizontal plane), N
        m/rad. Defaults are the thesis's for its housing (section 3.3.1); `inf` is rigid, 0 is
        pinned.
    material : Material
        Material of the shaft. The thesis gives none: steel is an assumption.

    Raises
    ------
    InputError
        If a value is outside its range.
    """

    overhang: float = 2.145
    span: float = 2.615
    radial_stiffness: float = 8e7
    axial_stiffness: float = 4e6
    gearbox_weight: float = 392280.0
    shaft_diameter: float = 0.4
    bore: float = 0.0
    tilt_stiffness: float = 145e6
    yaw_stiffness: float = 392e6
    material: Material = MATERIALS["steel"]

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, Material):
                continue
            low_enough = value > 0.0 or (value == 0.0 and field.name in _MAY_BE_ZERO)
            if not (low_enough and (value < np.inf or field.name in _MAY_BE_INFINITE)):
                least = "0 or more" if field.name in _MAY_BE_ZERO else "positive"
                most = "(inf for rigid)" if field.name in _MAY_BE_INFINITE else "and finite"
                raise InputError(
                    f"main-bearing beam: {field.name} = {value:g} must be {least} {most}: correct "
                    "the value, in SI units."
                )
        if self.bore >= self.shaft_diameter:
            raise InputError(
                f"main-bearing beam: bore = {self.bore:g} m must be less than the shaft diameter "
                f"{self.shaft_diameter:g} m: make it smaller."
            )

    @property
    def bending_stiffness(self) -> float:
        """EI of the shaft, N m^2."""
        inertia = np.pi / 64.0 * (self.shaft_diameter**4 - self.bore**4)
        return float(self.material.youngs_modulus * inertia)


def pinned_reaction(force: ArrayLike, moment: ArrayLike, overhang: float, span: float) -> Floats:
    """Force on a main bearing that takes no moment, in one plane.

    Stirling 2023, Eq 3.1: ``F = (M + (L1 + L2) B) / L2``. Statically determinate, so neither
    stiffness nor the gearbox weight enters.

    Parameters
    ----------
    force, moment : array_like
        B (N) and M (N m) at the hub, any shapes that broadcast.
    overhang, span : float
        L1 and L2, m.

    Returns
    -------
    ndarray
        F, N, the load on the bearing in the direction of B.
    """
    B, M = np.asarray(force, dtype=float), np.asarray(moment, dtype=float)
    return np.asarray((M + (overhang + span) * B) / span)


def torsional_spring_reaction(
    force: ArrayLike,
    moment: ArrayLike,
    overhang: float,
    span: float,
    bending_stiffness: float,
    gearbox_stiffness: float,
    bearing_stiffness: float,
    gearbox_force: ArrayLike = 0.0,
) -> tuple[Floats, Floats]:
    """Force and moment on a main bearing with a tilt spring, in one plane.

    Stirling 2023, Eq 3.18 and 3.19::

        M_T = [(M + B L1) L2 / (3 EI) + ((M + B L1) - G L2) / (K1 L2^2)]
              / [1/K_R + 1/(K1 L2^2) + L2/(3 EI)]
        R_A = (M + B (L1 + L2) - M_T) / L2

    The same follows from equilibrium and compatibility. With w the gearbox's displacement and phi
    the rotation at the bearing, both positive in the sense of B and M: the gearbox spring takes
    ``K1 w = G - (M + B L1 - M_T) / L2``, the shaft bends to ``w = -phi L2 + (M + B L1 - M_T)
    L2^2 / (3 EI)``, the bearing takes ``M_T = K_R phi``. So Eq 3.18 is right as printed, provided
    that G is positive in the direction of B. R_A has no term in G, since moments are taken about
    the gearbox, but G reaches it through M_T.

    The shaft is massless, uniform and without shear (Euler-Bernoulli), the bearing rigid
    radially.

    Parameters
    ----------
    force, moment : array_like
        B (N) and M (N m) at the hub, any shapes that broadcast.
    overhang, span : float
        L1 and L2, m.
    bending_stiffness : float
        EI, N m^2, `inf` for rigid.
    gearbox_stiffness : float
        K1, N/m, greater than 0, `inf` for rigid.
    bearing_stiffness : float
        K_R, N m/rad; 0 gives `pinned_reaction`, `inf` is clamped.
    gearbox_force : array_like
        G, force on the shaft at the gearbox in the direction of B, N: minus the weight where B
        is positive upward.

    Returns
    -------
    reaction, moment : ndarray
        R_A (N) and M_T (N m): the load on the bearing, in the directions of B and M.

    Raises
    ------
    InputError
        If a stiffness is negative, K1 is 0, or all three are infinite.
    """
    for name, value, least in (
        ("bending stiffness", bending_stiffness, "greater than 0"),
        ("gearbox stiffness", gearbox_stiffness, "greater than 0"),
        ("bearing stiffness", bearing_stiffness, "0 or more"),
    ):
        if not (value > 0.0 or (value == 0.0 and least == "0 or more")):
            raise InputError(
                f"{name} {value:g} must be {least}, inf for rigid: give it in SI units."
            )
    B, M = np.asarray(force, dtype=float), np.asarray(moment, dtype=float)
    G = np.asarray(gearbox_force, dtype=float)
    arm = M + B * overhang
    if bearing_stiffness == 0.0:
        bearing_moment = np.zeros(np.broadcast_shapes(arm.shape, G.shape))
    else:
        bend, lift = span / (3.0 * bending_stiffness), 1.0 / (gearbox_stiffness * span**2)
        total = 1.0 / bearing_stiffness + lift + bend
        if total == 0.0:
            raise InputError(
                "bearing, gearbox and shaft have infinite stiffness, so that their shares of the "
                "load are indeterminate: make at least one of them finite."
            )
        bearing_moment = (arm * bend + (arm - G * span) * lift) / total
    reaction = (M + B * (overhang + span) - bearing_moment) / span
    return np.asarray(reaction), np.asarray(bearing_moment)


def pinned_model(loads: ArrayLike, parameters: MainBearingBeam) -> Floats:
    """Load on a main bearing that takes forces only, Eq 3.1 in both planes.

    Parameters
    ----------
    loads : array_like, (..., 6)
        Fx, Fy, Fz, Mx, My, Mz on the shaft at the hub, N and N m.
    parameters : MainBearingBeam
        The drivetrain.

    Returns
    -------
    ndarray, (..., 6)
        Load on the main bearing. The closed forms do not cover thrust and torque; here the
        bearing locates the shaft and takes all of Fx, and the gearbox takes all of Mx.

    Raises
    ------
    InputError
        If `loads` has another shape or a value that is not finite.
    """
    load = _hub_loads(loads)
    out = np.zeros(load.shape)
    L1, L2 = parameters.overhang, parameters.span
    out[..., 0] = load[..., 0]
    out[..., 1] = pinned_reaction(load[..., 1], -load[..., 5], L1, L2)
    out[..., 2] = pinned_reaction(load[..., 2], load[..., 4], L1, L2)
    return out


def torsional_spring_model(loads: ArrayLike, parameters: MainBearingBeam) -> Floats:
    """Load on a main bearing that takes moments too, Eq 3.18 and 3.19 in both planes.

    Parameters
    ----------
    loads : array_like, (..., 6)
        Fx, Fy, Fz, Mx, My, Mz on the shaft at the hub, N and N m.
    parameters : MainBearingBeam
        Its gearbox weight acts in the vertical plane, downward.

    Returns
    -------
    ndarray, (..., 6)
        Load on the main bearing; Fx and Mx as in `pinned_model`.

    Raises
    ------
    InputError
        If `loads` has another shape or a value that is not finite.
    """
    load = _hub_loads(loads)
    out = np.zeros(load.shape)
    shaft = (
        parameters.overhang,
        parameters.span,
        parameters.bending_stiffness,
        parameters.radial_stiffness,
    )
    out[..., 0] = load[..., 0]
    out[..., 1], yaw = torsional_spring_reaction(
        load[..., 1], -load[..., 5], *shaft, parameters.yaw_stiffness
    )
    out[..., 2], out[..., 4] = torsional_spring_reaction(
        load[..., 2], load[..., 4], *shaft, parameters.tilt_stiffness, -parameters.gearbox_weight
    )
    out[..., 5] = -yaw
    return out


def main_bearing_frame(
    parameters: MainBearingBeam, bearing: ArrayLike | None = None, shear: bool = True
) -> Beam:
    """Spatial beam of the same drivetrain, with supports "bearing" and "gearbox".

    Parameters
    ----------
    parameters : MainBearingBeam
        The drivetrain.
    bearing : array_like, (6,) or (6, 6), optional
        Stiffness of the main bearing, for instance condensed from a housing; by default rigid
        against displacement, `tilt_stiffness` and `yaw_stiffness` against rotation.
    shear : bool
        Whether shear deforms the shaft.

    Returns
    -------
    Beam
        The gearbox holds K2 along x, K1 along y and z, and the torque.
    """
    if bearing is None:
        rigid = np.inf
        bearing = (rigid, rigid, rigid, 0.0, parameters.tilt_stiffness, parameters.yaw_stiffness)
    K1, K2 = parameters.radial_stiffness, parameters.axial_stiffness
    return Beam(
        sections=[
            BeamSection(length, parameters.shaft_diameter, parameters.bore)
            for length in (parameters.overhang, parameters.span)
        ],
        supports=[
            Support("bearing", 0.0, bearing),
            Support("gearbox", parameters.span, (K2, K1, K1, np.inf, 0.0, 0.0)),
        ],
        start=-parameters.overhang,
        material=parameters.material,
        shear=shear,
    )


def _hub_loads(loads: ArrayLike) -> Floats:
    load = np.asarray(loads, dtype=float)
    if load.ndim < 1 or load.shape[-1] != 6:
        raise InputError(
            f"hub loads of shape {load.shape} must end in 6 components: give Fx, Fy, Fz, Mx, My, "
            "Mz in N and N m."
        )
    if not np.isfinite(load).all():
        raise InputError("hub loads hold a value that is not finite: remove NaN and infinity.")
    return load
