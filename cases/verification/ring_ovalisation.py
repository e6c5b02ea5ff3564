"""Ring under pressure that varies as cos(n t): ovalisation and higher waves, against Michell."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.loaded_blocks import face_loads, solve_block
from fe_drivetrain.cases.references.plane_rings import harmonics, inextensible_ring, plane_strain
from fe_drivetrain.cases.references.ring_slices import half_wave, wave_pressure
from fe_drivetrain.cases.references.ring_solids import plane_strain_hold, sector_symmetry
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, targets_of

INNER, OUTER = 0.3175, 0.348  # m
PRESSURE = 1e6  # Pa, amplitude
STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=0.0)
PLANE = plane_strain(STEEL.youngs_modulus, STEEL.poisson_ratio)
ORDERS = (2, 3, 4, 8)

THROUGH = "elements through the wall"
RADIAL = "radial displacement of the bore [µm]"
TANGENTIAL = "tangential displacement of the bore [µm]"
HOOP, OUTSIDE = "hoop stress of the bore [MPa]", "hoop stress of the outside [MPa]"
ENERGY = "strain energy of the whole ring [J/m]"
OVER_THIN = "Radial displacement of the bore over that of a thin ring, by the waves of the pressure"
#: Factors from SI.
SHOWN = {RADIAL: 1e6, TANGENTIAL: 1e6, HOOP: 1e-6, OUTSIDE: 1e-6, ENERGY: 1.0}
MICHELL = "Michell 1899: four powers of the radius for each harmonic (Timoshenko and Goodier "
MICHELL += "1970, art 43)"


def shown(*values: float) -> Record:
    """What is judged, in the units shown."""
    return {key: SHOWN[key] * float(value) for key, value in zip(SHOWN, values, strict=True)}


def exact(n: int) -> Record:
    """By Michell."""
    ring = harmonics(np.array([n]), INNER, OUTER, np.zeros(1), np.array([PRESSURE]))
    inside, outside = (ring.displacement_amplitudes(r, PLANE)[:, 0] for r in (INNER, OUTER))
    hoop = [ring.stress_amplitudes(r)[1, 0] for r in (INNER, OUTER)]
    return shown(*inside, *hoop, -0.5 * np.pi * OUTER * PRESSURE * outside[0])


def solve(n: int, level: int) -> Record:
    """The same from a half wave of solids."""
    block, angle = half_wave(INNER, OUTER, n, level), np.pi / n
    held = [*sector_symmetry(block, angle), plane_strain_hold(block)]
    found = solve_block(block, STEEL, face_loads(block, x1=wave_pressure(PRESSURE, n)), *held)
    crest, outside = (found.node(0.0, r, 0.0) for r in (INNER, OUTER))
    zero = found.node(0.0, INNER * np.cos(0.5 * angle), INNER * np.sin(0.5 * angle))
    moved = found.polar_u[crest, 1], found.polar_u[zero, 2]
    # a sector is the 2 n-th part of the ring
    energy = 2 * n * found.energy / float(np.ptp(block.points[:, 0]))
    return {THROUGH: 2 * level} | shown(*moved, *found.polar.hoop[[crest, outside]], energy)


def answer(page: Page, ratio: Floats) -> None:
    """State how far the ring ovalises, and how far off a thin ring is.

    `ratio` is the exact displacement over that of a thin ring, from two waves on.
    """
    radial, hoop = "radial displacement of the bore", "hoop stress of the bore"
    oval = page.judged(f"n = 2: {radial}", f"{radial}, two waves", "Michell", unit="mm")
    page.answer(
        "How far does a ring ovalise under a pressure that varies round it?",
        f"Two waves of 1\u00a0MPa of pressure move a ring's bore by "
        f"{value_text(-oval.value, oval.unit)}, {percent_text(ratio[0] - 1)} more than in "
        f"thin-ring theory; eight waves give {percent_text(ratio[6] - 1)} more.",
        [
            oval,
            page.judged(f"n = 2: {hoop}", f"{hoop}, two waves", "Michell"),
            page.judged(f"n = 3: {radial}", f"{radial}, three waves", "Michell", unit="mm"),
            page.value("more than a thin ring, eight waves [%]", 100 * (ratio[6] - 1)),
        ],
        hero=OVER_THIN,
    )


@case(
    "Ring under circumferentially varying pressure",
    source="Michell 1899, Proc. London Math. Soc. 31, 100-124; Timoshenko and Goodier 1970, art 43",
)
def run(run: Run, page: Page) -> None:
    """Solve one half wave of the ring for each order."""
    thick = {n: exact(n) for n in range(2, 13)}
    stress = "recovered stress: bending is linear through the wall but for its curvature, h/R = "
    stress += "0.09, and eight elements are across it"
    moved = "elements of second order, eight or more to a half wave: the fourth power of their "
    moved += "length in waves is below 1e-4"
    orders = ORDERS[:2] if run.quick else ORDERS
    found = {n: [run.timed(f"n = {n}", solve, n, level) for level in (1, 2, 4)] for n in orders}
    for n, rows in found.items():
        targets = targets_of(thick[n], {"stress": (5e-3, stress), "": (1e-4, moved)}, MICHELL)
        page.targets(f"By mesh, n = {n}", MeshSeries(rows, THROUGH), targets, "exact", f"n = {n}")
    thin = inextensible_ring(np.array(list(thick)), INNER, OUTER, PRESSURE, PLANE)
    ratio = np.array([of[RADIAL] for of in thick.values()]) / (1e6 * thin)
    by_elements = [rows[-1][RADIAL] / (1e6 * thin[n - 2]) for n, rows in found.items()]
    curves = [
        trace("Michell, exact", list(thick), ratio),
        trace("finite elements", orders, by_elements, True, marker={"size": 10}),
    ]
    page.chart(OVER_THIN, curves, "waves round the ring", "over that of a thin ring")
    answer(page, ratio)
    page.text(
        "Plane strain. The pressure acts on the outside, positive at t = 0; the bore is free. "
        "One half wave is meshed, between planes of symmetry."
    )
    bearing = "bore and d1 of SKF 331555B (Stirling 2023, chapter 4) as the ring's wall"
    page.image(
        "Half a wave of the ring at n = 2, coarsest mesh", run.sketch(half_wave(INNER, OUTER, 2, 1))
    )
    page.assume("bore and outside of the ring", "0.635 / 0.696", "m", bearing)
    page.data("exact over thin ring", ratio)
