"""Ring under pressure that varies as cos(n t): ovalisation and higher waves, against Michell."""

from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.report import trace
from fe_drivetrain.scene import Material
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target
from fe_drivetrain.validation.loaded_blocks import face_loads, solve_block
from fe_drivetrain.validation.plane_rings import Harmonics, harmonics, plane_strain
from fe_drivetrain.validation.ring_solids import plane_strain_hold, ring_sector, sector_symmetry

INNER, OUTER = 0.3175, 0.348  # m
WALL, MIDDLE = OUTER - INNER, 0.5 * (INNER + OUTER)
PRESSURE = 1e6  # Pa, amplitude
STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=0.0)
PLANE = plane_strain(STEEL.youngs_modulus, STEEL.poisson_ratio)

ORDERS = (2, 3, 4, 8)
THROUGH = "elements through the wall"
RADIAL = "radial displacement of the bore [µm]"
TANGENTIAL = "tangential displacement of the bore [µm]"
HOOP, OUTSIDE = "hoop stress of the bore [MPa]", "hoop stress of the outside [MPa]"
ENERGY = "strain energy of the whole ring [J/m]"


def waves(n: int) -> Harmonics:
    """Michell's solution."""
    return harmonics(np.array([n]), INNER, OUTER, np.zeros(1), np.array([PRESSURE]))


def exact(n: int) -> dict[str, float]:
    """What is judged, by Michell."""
    ring = waves(n)
    inside, outside = (ring.displacement_amplitudes(r, PLANE)[:, 0] for r in (INNER, OUTER))
    hoop = [ring.stress_amplitudes(r)[1, 0] for r in (INNER, OUTER)]
    return {
        RADIAL: 1e6 * float(inside[0]),
        TANGENTIAL: 1e6 * float(inside[1]),
        HOOP: 1e-6 * float(hoop[0]),
        OUTSIDE: 1e-6 * float(hoop[1]),
        ENERGY: float(-0.5 * np.pi * OUTER * PRESSURE * outside[0]),
    }


def thin_ring(n: Any) -> Any:
    """Amplitude of an inextensible thin ring, p R^4 / (E' I (n^2 - 1)^2), inwards [m]."""
    stiffness = PLANE.E * WALL**3 / 12.0 * (np.asarray(n) ** 2 - 1.0) ** 2
    return -PRESSURE * MIDDLE**4 / stiffness


def solve(n: int, level: int) -> Record:
    """The same from a half wave of solids."""
    angle = np.pi / n
    # an even number, so that there is a node in the middle, and no element longer than the wall
    around = 2 * max(2, int(np.ceil(angle * MIDDLE / (2.0 * WALL)))) * level
    width = WALL / (2 * level)
    block = ring_sector(INNER, OUTER, width, angle, (2 * level, around, 1))

    def traction(x: Floats, normal: Floats) -> Floats:
        return np.asarray(-PRESSURE * np.cos(n * np.arctan2(x[:, 2], x[:, 1]))[:, None] * normal)

    held = [*sector_symmetry(block, angle), plane_strain_hold(block)]
    found = solve_block(block, STEEL, face_loads(block, x1=traction), *held)
    t = 0.5 * angle
    crest, outside = (found.node(0.0, r, 0.0) for r in (INNER, OUTER))
    node = found.node(0.0, INNER * np.cos(t), INNER * np.sin(t))
    return {
        THROUGH: 2 * level,
        RADIAL: 1e6 * float(found.u[crest, 1]),
        TANGENTIAL: 1e6 * float(found.u[node, 2] * np.cos(t) - found.u[node, 1] * np.sin(t)),
        HOOP: 1e-6 * float(found.polar.hoop[crest]),
        OUTSIDE: 1e-6 * float(found.polar.hoop[outside]),
        # a sector is the 2 n-th part of the ring
        ENERGY: 2 * n * found.energy / width,
    }


def target(key: str, value: float, name: str) -> Target:
    """One quantity by Michell's solution."""
    source = "Michell 1899: four powers of the radius for each harmonic (Timoshenko and Goodier "
    source += "1970, art 43)"
    name = f"{name}: {key.split(' [')[0]}"
    if "stress" in key:
        why = "recovered stress: bending is linear through the wall but for its curvature, h/R = "
        return Target(
            key, value, 5e-3, why + "0.09, and eight elements are across it", source, name
        )
    why = "elements of second order, eight or more to a half wave: the fourth power of their "
    return Target(key, value, 1e-4, why + "length in waves is below 1e-4", source, name)


@case(
    "Ring under circumferentially varying pressure",
    source="Michell 1899, Proc. London Math. Soc. 31, 100-124; Timoshenko and Goodier 1970, art 43",
)
def run(run: Run, page: Page) -> None:
    """Solve one half wave of the ring for each order."""
    orders = ORDERS[:2] if run.quick else ORDERS
    found: dict[int, MeshSeries] = {}
    for n in orders:
        with run.step(f"n = {n}"):
            found[n] = MeshSeries([solve(n, level) for level in (1, 2, 4)], THROUGH)
        for key, value in exact(n).items():
            page.finest(found[n], target(key, value, f"n = {n}"))
    many = np.arange(2, 13)
    ratio = [waves(int(n)).displacement_amplitudes(INNER, PLANE)[0, 0] / thin_ring(n) for n in many]
    oval, michell = found[2].rows[-1], exact(2)
    page.answer(
        f"Under p cos 2t the bore ovalises by {oval[RADIAL]:.3f} µm a MPa (exact "
        f"{michell[RADIAL]:.3f}), with {oval[HOOP]:.2f} MPa of hoop stress (exact "
        f"{michell[HOOP]:.2f}). That is {100 * (ratio[0] - 1):.1f} % more than a thin ring's at "
        f"n = 2; at n = 8 it is {100 * (ratio[6] - 1):.0f} %."
    )
    page.section("Exact and finite elements")
    solid = [of.rows[-1][RADIAL] / 1e6 / thin_ring(n) for n, of in found.items()]
    page.chart(
        "Radial displacement of the bore over that of a thin ring",
        [trace("Michell", many, ratio), trace("finite elements", orders, solid, points=True)],
        "waves round the ring n",
        "displacement / thin ring",
    )
    for n, of in found.items():
        page.meshes(f"By mesh, n = {n}", of, exact(n), "exact")
    page.text(
        "Plane strain. The pressure stands on the outside, positive at t = 0; the bore is free. "
        "One half wave is meshed, between planes of symmetry."
    )
    page.assume(
        "bore and outside of the ring",
        "0.635 / 0.696",
        "m",
        "bore and d1 of SKF 331555B (Stirling 2023, chapter 4) as the ring's wall",
    )
    page.data("exact over thin ring", ratio)
