"""A ring gear that bends in its plane, by harmonics beside its rigid motion.

The rim is an inextensible thin ring of mean radius R. A harmonic n of its radial displacement,
w = cos(n psi), goes with the tangential v = -sin(n psi) / n and the section's rotation
(v - w') / R. For a generalised coordinate of unit radial amplitude, its stiffness and mass are

    pi E I (n^2 - 1)^2 / R^3 + pi R (k_w + k_v / n^2),    pi rho A R (1 + 1 / n^2)

(Love 1927, art. 293; Timoshenko, Vibration Problems in Engineering, 1955, sec. 69), with I of the
rim in its plane and k_w, k_v of a foundation. Harmonics 0 and 1 are the rigid ring's.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos, pi, sin

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.dynamics.bodies.bodies import Body
from fe_drivetrain.dynamics.bodies.planetary import PlanetarySet
from fe_drivetrain.dynamics.bodies.springs import Spring

_AMPLITUDE = np.eye(6)[0]


@dataclass(frozen=True)
class Rim:
    """The rim of a ring gear, a rectangle.

    Attributes
    ----------
    radius : float
        Mean radius [m].
    thickness : float
        Radial thickness [m].
    width : float
        Width along x [m].
    material : Material
        Material of the rim.
    radial, tangential : float
        Stiffness of a foundation, such as bolts, per length of the rim [N/m^2].
    """

    radius: float
    thickness: float
    width: float
    material: Material
    radial: float = 0.0
    tangential: float = 0.0

    def stiffness(self, n: int) -> float:
        """Stiffness of harmonic n for a unit radial amplitude [N/m]."""
        inertia = self.width * self.thickness**3 / 12
        bent = self.material.youngs_modulus * inertia * (n * n - 1) ** 2 / self.radius**3
        return pi * (bent + self.radius * (self.radial + self.tangential / n**2))

    def mass(self, n: int) -> float:
        """Mass of harmonic n for a unit radial amplitude [kg]."""
        area = self.width * self.thickness
        return pi * self.material.density * area * self.radius * (1 + 1 / n**2)

    def frequency(self, n: int) -> float:
        """Frequency of the rim alone on its foundation [Hz]."""
        return float(np.sqrt(self.stiffness(n) / self.mass(n)) / (2 * pi))

    def motion(self, n: int, psi: float, radius: float) -> Floats:
        """(2, 2) radial and tangential motion at a point, by the cosine and the sine harmonic.

        Parameters
        ----------
        n : int
            Harmonic.
        psi, radius : float
            Angle and radius of the point [rad, m]; it goes with the section at its angle.
        """
        c, s = cos(n * psi), sin(n * psi)
        out = (radius - self.radius) / self.radius * (n - 1 / n)
        return np.array([[c, s], [-s / n + out * s, c / n - out * c]])


def with_rim(
    stage: PlanetarySet, springs: Sequence[Spring], rim: Rim, harmonics: Sequence[int]
) -> tuple[list[Body], list[Spring]]:
    """Coordinates of a rim's harmonics, and the stage's springs with what these move its teeth by.

    Each coordinate is a body, "NAME rim 2 cos" and so on, whose one degree of freedom "ux" is the
    radial amplitude of the harmonic [m]; it moves nothing along x.

    Parameters
    ----------
    stage : PlanetarySet
        Planetary stage whose ring it is.
    springs : sequence of Spring
        Springs of the stage, from `springs_of`.
    rim : Rim
        Rim of the stage's ring.
    harmonics : sequence of int
        Numbers of waves round the rim, from 2 on.

    Returns
    -------
    bodies : list
        The coordinates.
    springs : list
        All springs, with those of the rim itself.
    """
    bodies, own = [], []
    names = {(n, p): stage.full_name(f"rim {n} {p}") for n in harmonics for p in ("cos", "sin")}
    for (n, _), name in names.items():
        bodies.append(Body(name, mass=rim.mass(n), free=frozenset({"ux"})))
        own.append(Spring(f"{name} bending", {name: _AMPLITUDE}, rim.stiffness(n)))
    teeth = stage.centre_distance + stage.planet_ring_radius
    found = []
    for spring in springs:
        k = _planet_of(stage, spring.name)
        if k is None:
            found.append(spring)
            continue
        psi = stage.angles[k]
        # the row of the ring is minus the normal, from the planet into the ring
        normal = spring.by[stage.full_name("ring")][1:3]
        axes = np.array([[cos(psi), sin(psi)], [-sin(psi), cos(psi)]])
        along = axes @ normal
        by = dict(spring.by)
        for n in harmonics:
            moved = along @ rim.motion(n, psi, teeth)
            for part, value in zip(("cos", "sin"), moved, strict=True):
                by[names[n, part]] = value * _AMPLITUDE
        found.append(replace(spring, by=by))
    return bodies, [*found, *own]


def _planet_of(stage: PlanetarySet, name: str) -> int | None:
    for k in range(len(stage.angles)):
        mesh = stage.full_name(f"ring-planet {k + 1}")
        if name == mesh or name.startswith(f"{mesh} slice "):
            return k
    return None
