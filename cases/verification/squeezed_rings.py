"""A ring between two opposite loads: exact series, curved beam with shear, thin ring."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references.loaded_blocks import face_loads, solve_block
from fe_drivetrain.cases.references.plane_rings import Lame, Plane, even_amplitudes, harmonics
from fe_drivetrain.cases.references.ring_solids import (
    plane_strain_hold,
    ring_sector,
    sector_symmetry,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.mesh import Block

ORDERS = 400
"""Even harmonics of the series: up to n = 798."""

SHEAR = 1.2
"""Shear factor of a rectangle."""

GROWTH = 1.5
"""Of the lengths of elements away from the load, up to 1.5 walls."""

LONGEST = 0.25
"""Angle of an element [rad]: stress turns with it, and its recovery is linear in an element."""

ALONG, ACROSS = "bore along the load", "bore across the load"
UNDER, OUTSIDE, STIFFNESS = "bore under the load", "outside, across", "stiffness"


@dataclass(frozen=True)
class SqueezedRing:
    """A ring under two opposite loads along y, each over one wall thickness of arc.

    Attributes
    ----------
    radius : float
        Of the middle of the wall [m].
    ratio : float
        The same over the thickness of the wall.
    force : float
        Each load per width [N/m].
    plane : Plane
        Its elasticity.
    """

    radius: float
    ratio: float
    force: float
    plane: Plane

    @property
    def inner(self) -> float:
        """Radius of the bore [m]."""
        return self.radius * (1.0 - 0.5 / self.ratio)

    @property
    def outer(self) -> float:
        """Radius of the outside [m]."""
        return self.radius * (1.0 + 0.5 / self.ratio)

    @property
    def reach(self) -> float:
        """Half of the loaded arc: half a wall thickness at the middle radius [rad]."""
        return 0.5 / self.ratio

    def pressure(self, t: Floats) -> Floats:
        """One load, as a smooth bump, so that series and elements converge fast.

        Parameters
        ----------
        t : array
            Angle from the load [rad].

        Returns
        -------
        pressure : array
            On the outside [Pa], with `force` as its resultant.
        """
        e = self.reach
        # the bump's resultant: integral of (1 + cos(pi t / e)) / 2 cos t over both sides
        p = np.pi / e
        resultant = np.sin(e) + 0.5 * (
            np.sin((p + 1) * e) / (p + 1) + np.sin((p - 1) * e) / (p - 1)
        )
        bump = np.where(np.abs(t) < e, 0.5 * (1.0 + np.cos(p * np.asarray(t))), 0.0)
        return np.asarray(self.force / (self.outer * resultant) * bump)

    def series(self) -> dict[str, float]:
        """The ring as a plane problem, by Fourier series of Michell's functions.

        Returns
        -------
        found : dict
            Changes of the bore's diameter along and across the load [m], hoop stress of the bore
            under the load and of the outside across it [Pa], stiffness W^2 / (2 U) [N/m per m].
            Timoshenko and Goodier 1970, article 43.
        """
        a, b, across = self.inner, self.outer, 0.5 * np.pi
        amplitude = even_amplitudes(self.pressure, self.reach, ORDERS)
        n = 2 * np.arange(1, ORDERS)
        ring = Lame(a, b, outside=amplitude[0])
        waves = harmonics(n, a, b, np.zeros(len(n)), amplitude[1:])

        def displacement(r: float, t: float) -> float:
            return float(
                ring.displacement(np.array(r), self.plane)
                + waves.displacement_amplitudes(r, self.plane)[0] @ np.cos(n * t)
            )

        def hoop(r: float, t: float) -> float:
            return float(ring.hoop(np.array(r)) + waves.stress_amplitudes(r)[1] @ np.cos(n * t))

        outside = waves.displacement_amplitudes(b, self.plane)[0]
        work = 2.0 * amplitude[0] * float(ring.displacement(np.array(b), self.plane))
        energy = -0.5 * np.pi * b * (work + amplitude[1:] @ outside)
        return {
            ALONG: 2.0 * displacement(a, 0.0),
            ACROSS: 2.0 * displacement(a, across),
            UNDER: hoop(a, 0.0),
            OUTSIDE: hoop(b, across),
            STIFFNESS: 0.5 * self.force**2 / energy,
        }

    def curved_beam(self) -> float:
        """Approach of the loads by the energy of a curved beam with shear [m].

        Timoshenko, Strength of Materials, part II, 1956, thick rings; integrated here.
        """
        quarter = 0.5 * np.pi
        h = self.radius / self.ratio
        e = self.radius - h / np.log((1.0 + 0.5 / self.ratio) / (1.0 - 0.5 / self.ratio))
        x, w = np.polynomial.legendre.leggauss(30)
        t, w = 0.5 * quarter * (1.0 + x), 0.5 * quarter * w
        N, V = -0.5 * self.force * np.cos(t), 0.5 * self.force * np.sin(t)
        grows = 0.5 * self.force * self.radius * (1.0 - np.cos(t))
        # no rotation between the planes of symmetry: the integral of M / e - N vanishes
        M = grows + (w @ (N - grows / e)) * e / quarter
        bending = (N**2 * self.radius - 2.0 * M * N + M**2 / e) / (2.0 * self.plane.E * h)
        shear = SHEAR * V**2 * self.radius / (2.0 * self.plane.G * h)
        return float(8.0 * (w @ (bending + shear)) / self.force)

    def thin(self) -> float:
        """Approach of the loads of a thin ring, (pi/4 - 2/pi) W R^3 / (E I) [m].

        Timoshenko, Strength of Materials, part II, 1956, thin rings.
        """
        inertia = (self.radius / self.ratio) ** 3 / 12.0
        bending = self.plane.E * inertia
        return float((np.pi / 4.0 - 2.0 / np.pi) * self.force * self.radius**3 / bending)

    def share(self, change: float) -> float:
        """A change of diameter [m], closing positive, over W R^3 / (E' I)."""
        return float(-change * self.plane.E / (12.0 * self.force * self.ratio**3))

    def solid(self, level: int, material: Material) -> tuple[int, dict[str, float]]:
        """A quarter of solids, in plane strain.

        Parameters
        ----------
        level : int
            Two elements through the wall are divided into so many; three of a thick ring, which is
            loaded over more than its radius allows to call smooth.
        material : Material
            Of the ring.

        Returns
        -------
        through, found : int, dict
            Elements through the wall, and the quantities of `series`.
        """
        a, b, quarter = self.inner, self.outer, 0.5 * np.pi
        through = (3 if self.ratio < 4.0 else 2) * level
        width = (b - a) / through
        around = self.boundaries(level) / quarter
        divisions = (through, len(around) - 1, 1)
        block = ring_sector(a, b, width, quarter, divisions, edges=(None, around, None))

        def traction(x: Floats, normal: Floats) -> Floats:
            return np.asarray(-self.pressure(np.arctan2(x[:, 2], x[:, 1]))[:, None] * normal)

        held = [*sector_symmetry(block, quarter), plane_strain_hold(block)]
        found = solve_block(block, material, face_loads(block, x1=traction), *held)
        loaded = found.node(0.0, a, 0.0)
        across, outside = (found.node(0.0, r * np.cos(quarter), r) for r in (a, b))
        return through, {
            ALONG: 2.0 * float(found.u[loaded, 1]),
            ACROSS: 2.0 * float(found.u[across, 2]),
            UNDER: float(found.polar.hoop[loaded]),
            OUTSIDE: float(found.polar.hoop[outside]),
            STIFFNESS: 0.5 * self.force**2 / (4.0 * found.energy / width),
        }

    def quarter(self) -> Block:
        """A quarter between planes of symmetry, evenly divided, to be shown."""
        return ring_sector(self.inner, self.outer, 0.1, 0.5 * np.pi, (4, 12, 1))

    def boundaries(self, level: int) -> Floats:
        """Angles [rad] that divide a quarter: one element under the load, growing ones to the end.

        Parameters
        ----------
        level : int
            Every element is divided into so many.
        """
        quarter = 0.5 * np.pi
        longest = min(1.5 / self.ratio, LONGEST)
        lengths = [self.reach]
        while sum(lengths) < quarter:
            lengths.append(min(lengths[-1] * GROWTH, longest))
        coarse = np.concatenate([[0.0], np.cumsum(lengths)])
        # the load ends at a boundary; what follows is stretched to end at the quarter
        remaining = quarter - self.reach
        coarse[1:] = self.reach + (coarse[1:] - self.reach) * remaining / (coarse[-1] - self.reach)
        divided = np.arange((len(coarse) - 1) * level + 1) / level
        fine = np.asarray(np.interp(divided, range(len(coarse)), coarse))
        fine[-1] = quarter
        return fine


def shares(
    ring: Callable[[float], SqueezedRing], ratios: Floats
) -> list[tuple[str, Floats, Floats]]:
    """By each theory, the closing along the load as `SqueezedRing.share` of rings.

    Parameters
    ----------
    ring : callable
        The ring of a mean radius over wall thickness.
    ratios : array
        (n,) of them.

    Returns
    -------
    curves : list of tuple
        Name of the theory, the ratios, and (n,) shares.
    """
    theories: dict[str, Callable[[SqueezedRing], float]] = {
        "exact series": lambda of: of.series()[ALONG],
        "curved beam with shear": lambda of: -of.curved_beam(),
        "thin ring": lambda of: -of.thin(),
    }
    rings = [ring(float(ratio)) for ratio in ratios]
    return [
        (name, ratios, np.array([of.share(change(of)) for of in rings]))
        for name, change in theories.items()
    ]
