"""Rotors of round beams with discs on bearings, for whirl across the axis.

A node has four motions: uy and the slope duy/dx in the first plane, uz and duz/dx in the second.
With the vectors a and b of all nodes in either plane, w = a + i b turns from y to z, as the shaft
does. Round shafts have the same mass M, gyroscopic matrix G and stiffness K in both planes, and

    M w'' - i W G w' + K (w + t (w' - i W w)) = forces of the bearings

at the speed W, where t is the time of viscous damping that turns with the shaft (Zorzi and Nelson
1977, whose term of hysteresis is not taken, see `hysteresis`). Bearings may differ in the planes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.shafts.beam.frame import CrossSection, beam_stiffness
from fe_drivetrain.shafts.beam.sections import gauss_points

Theory = Literal["euler", "rayleigh", "timoshenko"]
"""Bending alone; with the inertia of turning sections; with shear, too."""

THEORIES: tuple[Theory, ...] = ("euler", "rayleigh", "timoshenko")

#: Motions of a body across the axis, of the first and the second plane, and the signs of slopes.
ACROSS, SIGNS = (1, 5, 2, 4), np.array([1.0, 1.0, 1.0, -1.0])


@dataclass(frozen=True)
class Element:
    """A uniform piece of a shaft between two nodes.

    Attributes
    ----------
    length : float
        Length [m].
    section : CrossSection
        Its round section.
    material : Material
        Its material; one of no density has no mass.
    """

    length: float
    section: CrossSection
    material: Material

    __repr__ = short_repr


@dataclass(frozen=True)
class Joint:
    """A stiffness without mass between two nodes, the same in both planes.

    Attributes
    ----------
    length : float
        Distance of the nodes, 0 of a spline [m].
    stiffness : Floats
        (4, 4) of w and dw/dx of both nodes [N/m, N, N m].
    """

    length: float
    stiffness: Floats

    __repr__ = short_repr


@dataclass(frozen=True)
class Disc:
    """A rigid body at a node.

    Attributes
    ----------
    node : int
        Number of the node.
    mass : float
        Mass [kg].
    polar, transverse : float
        Inertia about the axis and across it [kg m^2].
    """

    node: int
    mass: float
    polar: float
    transverse: float


@dataclass(frozen=True)
class Bearing:
    """A bearing between a node and ground, whose stiffness may change with the speed.

    Attributes
    ----------
    name : str
        Name of the bearing.
    node : int
        Number of the node.
    speeds : Floats
        Speeds (k,) of the shaft, ascending [rad/s]; between them values go straight, beyond them
        they stay.
    stiffness, damping : Floats
        (k, 4, 4) of uy, duy/dx, uz, duz/dx at each speed [N/m, N, N m; and times s].
    """

    name: str
    node: int
    speeds: Floats
    stiffness: Floats
    damping: Floats

    __repr__ = short_repr

    def at(self, speed: float) -> tuple[Floats, Floats]:
        """Stiffness and damping (4, 4) at a speed of the shaft [rad/s]."""
        return _between(self.speeds, self.stiffness, speed), _between(
            self.speeds, self.damping, speed
        )


@dataclass(frozen=True)
class Rotor:
    """A rotor: one plane of what is round, and bearings.

    Attributes
    ----------
    name : str
        Name of the rotor.
    stations : Floats
        x of its nodes (n,) [m].
    mass, gyroscopic, stiffness : Floats
        (2 n, 2 n) of one plane, of w and dw/dx of each node [kg, kg m, kg m^2; N/m, N, N m].
    bearings : tuple of Bearing
        Bearings.
    viscous : float
        Damping that turns with the shaft, over stiffness [s].
    loss_factor : float
        Loss factor of damping that turns with the shaft and does not depend on frequency.
    """

    name: str
    stations: Floats
    mass: Floats
    gyroscopic: Floats
    stiffness: Floats
    bearings: tuple[Bearing, ...]
    viscous: float = 0.0
    loss_factor: float = 0.0

    __repr__ = short_repr

    @property
    def changes(self) -> bool:
        """Whether a bearing changes with the speed."""
        return any(len(bearing.speeds) > 1 for bearing in self.bearings)


@dataclass(frozen=True)
class Equations:
    """Matrices (4 n, 4 n) of both planes at a speed, a before b: M q'' + D q' + K q = f.

    Attributes
    ----------
    mass : Floats
        Mass.
    rates : Floats
        Damping and gyroscopic terms.
    stiffness : Floats
        Stiffness, and what damping of the turning shaft adds to it, which is skew.
    supports, absorbing : Floats
        Stiffness and damping of bearings alone.
    """

    mass: Floats
    rates: Floats
    stiffness: Floats
    supports: Floats
    absorbing: Floats

    __repr__ = short_repr


def rotor_of(
    name: str,
    elements: Sequence[Element | Joint],
    discs: Sequence[Disc],
    bearings: Sequence[Bearing],
    *,
    theory: Theory = "timoshenko",
    viscous: float = 0.0,
    loss_factor: float = 0.0,
) -> Rotor:
    """Assemble a rotor of uniform elements and joints in a row.

    Parameters
    ----------
    name : str
        Name of the rotor.
    elements : sequence of Element or Joint
        From front to rear.
    discs : sequence of Disc
        Rigid bodies at nodes.
    bearings : sequence of Bearing
        Bearings.
    theory : str
        "euler", "rayleigh" or "timoshenko".
    viscous, loss_factor : float
        Damping that turns with the shaft: over stiffness [s], and its loss factor.

    Raises
    ------
    InputError
        A damping is negative or not finite.
    """
    for what, value, unit in (
        ("viscous damping over stiffness", viscous, " s"),
        ("loss factor", loss_factor, ""),
    ):
        if not (np.isfinite(value) and value >= 0.0):
            raise InputError(
                f"{what} of rotor {name!r} is {value:g}{unit} but must be at least 0{unit}: "
                "change it"
            )
    stations = np.concatenate([[0.0], np.cumsum([one.length for one in elements])])
    M, G, K = (np.zeros((2 * len(stations),) * 2) for _ in range(3))
    for k, element in enumerate(elements):
        part = slice(2 * k, 2 * k + 4)
        if isinstance(element, Joint):
            K[part, part] += element.stiffness
            continue
        for whole, own in zip((M, G, K), beam_matrices(element, theory), strict=True):
            whole[part, part] += own
    for disc in discs:
        at = 2 * disc.node
        M[at, at] += disc.mass
        M[at + 1, at + 1] += disc.transverse
        G[at + 1, at + 1] += disc.polar
    return Rotor(name, stations, M, G, K, tuple(bearings), viscous, loss_factor)


def beam_matrices(element: Element, theory: Theory) -> tuple[Floats, Floats, Floats]:
    """Mass, gyroscopic matrix and stiffness (4, 4) of an element in one plane.

    Shapes are the exact static ones of Timoshenko's beam, so that with shear as without the mass
    is consistent (Nelson 1980, J. Mech. Des. 102, 793-803).

    Parameters
    ----------
    element : Element
        The element.
    theory : str
        "euler", "rayleigh" or "timoshenko".
    """
    L, section, material = element.length, element.section, element.material
    slender = CrossSection(section.area, (np.inf, np.inf), section.torsion, section.inertias)
    taken = section if theory == "timoshenko" else slender
    rows = np.array([1, 5, 7, 11])
    K = beam_stiffness(taken, L, material)[np.ix_(rows, rows)]
    EI = material.youngs_modulus * section.inertias[0]
    shear = 12.0 * EI / (material.shear_modulus * taken.shear_areas[0] * L**2)
    # four points are exact for squares of cubics
    s, weight = gauss_points(0.0, 1.0, 4)
    moved, turned = _shapes(s, L, shear)
    along = material.density * L * weight
    M = np.einsum("q,qi,qj->ij", along * section.area, moved, moved)
    J = np.einsum("q,qi,qj->ij", along * section.inertias[0], turned, turned)
    if theory == "euler":
        return M, np.zeros_like(M), K
    return M + J, 2.0 * J, K


def _shapes(s: Floats, L: float, shear: float) -> tuple[Floats, Floats]:
    """(q, 4) deflection and turn of sections at s along a beam, from 0 to 1."""
    moved = np.array(
        [
            2 * s**3 - 3 * s**2 - shear * s + 1 + shear,
            L * (s**3 - (2 + shear / 2) * s**2 + (1 + shear / 2) * s),
            -2 * s**3 + 3 * s**2 + shear * s,
            L * (s**3 - (1 - shear / 2) * s**2 - shear / 2 * s),
        ]
    )
    turned = np.array(
        [
            6 * (s**2 - s) / L,
            3 * s**2 - (4 + shear) * s + 1 + shear,
            -6 * (s**2 - s) / L,
            3 * s**2 - (2 - shear) * s,
        ]
    )
    return moved.T / (1 + shear), turned.T / (1 + shear)


def refined(
    elements: Sequence[Element | Joint], parts: int
) -> tuple[list[Element | Joint], list[int]]:
    """Elements cut into equal parts, joints as they are, and the new number of each old node.

    Parameters
    ----------
    elements : sequence of Element or Joint
        From front to rear.
    parts : int
        Parts of each element.
    """
    fine: list[Element | Joint] = []
    nodes = [0]
    for one in elements:
        if isinstance(one, Joint):
            fine.append(one)
        else:
            fine += [Element(one.length / parts, one.section, one.material)] * parts
        nodes.append(len(fine))
    return fine, nodes


def rigid_rotor(rotor: Rotor) -> Rotor:
    """The rotor as one rigid body on its bearings: a node at its front.

    Parameters
    ----------
    rotor : Rotor
        Rotor that bends.
    """
    arms = rotor.stations - rotor.stations[0]
    T = np.zeros((len(rotor.mass), 2))
    T[::2, 0], T[::2, 1], T[1::2, 1] = 1.0, arms, 1.0

    def carried(bearing: Bearing) -> Bearing:
        B = np.kron(np.eye(2), T[2 * bearing.node : 2 * bearing.node + 2])
        K, C = (B.T @ A @ B for A in (bearing.stiffness, bearing.damping))
        return Bearing(bearing.name, 0, bearing.speeds, K, C)

    return Rotor(
        rotor.name,
        rotor.stations[:1],
        np.asarray(T.T @ rotor.mass @ T),
        np.asarray(T.T @ rotor.gyroscopic @ T),
        np.zeros((2, 2)),
        tuple(carried(one) for one in rotor.bearings),
    )


def bearing_of(
    name: str,
    node: int,
    stiffness: Floats,
    damping: Floats | None = None,
    speeds: Sequence[float] = (0.0,),
    mirrored: bool = False,
) -> Bearing:
    """A bearing by its stiffness along and about the axes at each of some speeds.

    Parameters
    ----------
    name : str
        Name of the bearing.
    node : int
        Number of its node.
    stiffness, damping : ndarray, (6, 6) or (k, 6, 6)
        Rows and columns are ux to rz of its node [N/m, N, N m/rad; and times s].
    speeds : sequence of float
        Speeds (k,) of the shaft [rad/s].
    mirrored : bool
        Whether the shaft turns from z to y, so that the second plane is along -z.
    """
    K = np.broadcast_to(stiffness, (len(speeds), 6, 6))
    C = np.zeros_like(K) if damping is None else np.broadcast_to(damping, K.shape)
    at = np.ix_(ACROSS, ACROSS)
    signs = SIGNS * np.array([1.0, 1.0, -1.0, -1.0]) if mirrored else SIGNS
    sign = np.outer(signs, signs)
    return Bearing(
        name,
        node,
        np.asarray(speeds, dtype=float),
        np.array([sign * one[at] for one in K]),
        np.array([sign * one[at] for one in C]),
    )


def equations(rotor: Rotor, speed: float) -> Equations:
    """Equations of a rotor at a speed, without hysteresis.

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    speed : float
        Speed of the shaft, positive from y to z [rad/s].
    """
    size = len(rotor.mass)
    stood, absorbed = np.zeros((2 * size,) * 2), np.zeros((2 * size,) * 2)
    for bearing in rotor.bearings:
        first = 2 * bearing.node
        at = np.array([first, first + 1, size + first, size + first + 1])
        K, C = bearing.at(abs(speed))
        stood[np.ix_(at, at)] += K
        absorbed[np.ix_(at, at)] += C
    both, turned = np.eye(2), np.array([[0.0, 1.0], [-1.0, 0.0]])
    inner = rotor.viscous * rotor.stiffness
    return Equations(
        np.asarray(np.kron(both, rotor.mass), dtype=np.float64),
        absorbed + speed * np.kron(turned, rotor.gyroscopic) + np.kron(both, inner),
        stood + np.kron(both, rotor.stiffness) + speed * np.kron(turned, inner),
        stood,
        absorbed,
    )


def hysteresis(rotor: Rotor, faster: bool) -> np.ndarray:
    """Stiffness (4 n, 4 n) that hysteresis of the shaft adds for whirl of a positive frequency.

    In the turning shaft a strain of frequency v is resisted by K (1 + i e sign(v)). Whirl of
    frequency f is of f - W forward, and of -f - W backward: below the speed its forward part is
    driven, above it damped (Genta 2004, J. Vib. Acoust. 126, 459-461, unverified: derived here).

    Parameters
    ----------
    rotor : Rotor
        The rotor.
    faster : bool
        Whether the whirl is faster than the shaft, f > W.
    """
    K = rotor.loss_factor * rotor.stiffness
    if faster:
        return np.kron(np.eye(2), 1j * K)
    return np.kron(np.array([[0.0, 1.0], [-1.0, 0.0]]), K)


def _between(speeds: Floats, values: Floats, speed: float) -> Floats:
    """Matrices between those at some speeds, straight; beyond the ends those at the ends."""
    last = len(speeds) - 1
    if last == 0 or speed <= speeds[0]:
        return np.asarray(values[0])
    if speed >= speeds[-1]:
        return np.asarray(values[-1])
    k = int(np.searchsorted(speeds, speed, side="right"))
    part = (speed - speeds[k - 1]) / (speeds[k] - speeds[k - 1])
    return np.asarray((1 - part) * values[k - 1] + part * values[k])
