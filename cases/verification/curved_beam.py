"""Thick curved bar, as of a hook, in bending and under an end force, against exact solutions."""

from collections.abc import Callable

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.compare import band_of
from fe_drivetrain.interfaces import Constraint, held_dofs
from fe_drivetrain.operator import nodal_stresses, traction_loads
from fe_drivetrain.report import Measure, trace
from fe_drivetrain.scene import Material
from fe_drivetrain.solve import Static, solve_solid
from fe_drivetrain.suite import Page, Run, column
from fe_drivetrain.validation.plane_rings import CurvedBar, plane_strain
from fe_drivetrain.validation.ring_solids import (
    Polar,
    node_at,
    on_plane,
    plane_strain_hold,
    polar_stresses,
    polar_traction,
    ring_sector,
)

INNER, OUTER = 0.1, 0.3  # m
BAR = CurvedBar(INNER, OUTER)
MOMENT = 1e5  # N, per width
FORCE = 1e6  # N/m, per width
E, NU = 200e9, 0.3
LAME = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0).lame
QUARTER = 0.5 * np.pi

#: Elements through the height.
DIVISIONS = (4, 8, 16)
QUICK_DIVISIONS = (3, 6, 12)

INSIDE = "bending: hoop stress inside [MPa]"
OUTSIDE = "bending: hoop stress outside [MPa]"
PULLED = "force: hoop stress inside, t = 90 deg [MPa]"
MEASURES: dict[str, Measure] = {"mrad": "rotation", "J/m": "energy", "MPa": "stress"}


def bending(r: Floats, t: Floats) -> tuple[Floats, Floats, Floats]:
    """Radial, hoop and shear stress under end moments."""
    return (*BAR.bending(r, MOMENT), np.zeros_like(r))


def end_force(r: Floats, t: Floats) -> tuple[Floats, Floats, Floats]:
    """Radial, hoop and shear stress under an end force."""
    return BAR.end_force(r, t, FORCE)


#: Hoop stresses that are judged: along the radius [MPa], and where.
HOOP: dict[str, tuple[Callable[[Floats], Floats], float]] = {
    INSIDE: (lambda r: BAR.bending(r, MOMENT)[1] / 1e6, INNER),
    OUTSIDE: (lambda r: BAR.bending(r, MOMENT)[1] / 1e6, OUTER),
    PULLED: (
        lambda r: BAR.end_force(r, np.array(QUARTER), FORCE)[1] / 1e6,
        INNER,
    ),
}


def solve(n: int) -> tuple[dict[str, float], tuple[Floats, Floats, Floats]]:
    """Both loads on one mesh; radius, hoop and radial stress [m, Pa] of one end in bending."""
    width = (OUTER - INNER) / n
    block = ring_sector(INNER, OUTER, width, QUARTER, (n, 2 * n, 1))
    points, size = block.points, block.points.size
    here, there = (
        [node_at(points, [0.0, r * np.cos(t), r * np.sin(t)]) for r in (INNER, OUTER)]
        for t in (0.0, QUARTER)
    )
    middle = node_at(points, [0.0, *(0.5 * (INNER + OUTER) * np.array([np.cos(QUARTER), 1.0]))])
    flat = plane_strain_hold(block)

    def answer(
        loaded: tuple[str, ...],
        stresses: Callable[[Floats, Floats], tuple[Floats, Floats, Floats]],
        held: list[Constraint],
    ) -> tuple[Static, Polar]:
        traction = polar_traction(stresses)
        F = np.zeros(size)
        for face in loaded:
            F += traction_loads(points, block.faces[face], traction)
        static = solve_solid(points, block.cells, LAME, [flat, *held], F)
        s = nodal_stresses(points, block.cells, static.u[:, 0], LAME)
        return static, polar_stresses(s, points)

    # In bending, sections stay plane: that at t = 0 is held on its plane.
    symmetric = on_plane("symmetry", block.face_nodes("y0"), [0.0, 0.0, 1.0], size)
    still = held_dofs("translation", np.array([3 * here[0] + 1]), size)
    moment, bent = answer(("y1",), bending, [symmetric, still])
    u = moment.u[:, 0].reshape(-1, 3)
    # Under the force they warp: both ends carry the exact tractions, and three degrees of freedom
    # at t = 90 degrees hold the bar without force.
    three = np.array([3 * middle + 1, 3 * middle + 2, 3 * there[1] + 1])
    force, pulled = answer(("y0", "y1"), end_force, [held_dofs("support", three, size)])
    end = np.flatnonzero(
        (np.abs(points[:, 0]) < 1e-12) & (np.abs(points[:, 1]) < 1e-9) & (points[:, 2] > 0.0)
    )
    end = end[np.argsort(points[end, 2])]
    return {
        "bending: rotation of the ends [mrad]": 1e3
        * float(abs(u[there[1], 1] - u[there[0], 1]) / (OUTER - INNER)),
        "bending: strain energy per width [J/m]": float(moment.energy[0]) / width,
        INSIDE: float(bent.hoop[there[0]]) / 1e6,
        OUTSIDE: float(bent.hoop[there[1]]) / 1e6,
        "force: strain energy per width [J/m]": float(force.energy[0]) / width,
        PULLED: float(pulled.hoop[there[0]]) / 1e6,
    }, (points[end, 2], bent.hoop[end], bent.radial[end])


def exact_values() -> dict[str, float]:
    """The closed forms, in the order of the page."""
    plane = plane_strain(E, NU)
    rotation = BAR.bending_rotation(MOMENT, plane) * QUARTER
    hoop = {name: float(field(np.array(r))) for name, (field, r) in HOOP.items()}
    return {
        "bending: rotation of the ends [mrad]": 1e3 * abs(rotation),
        "bending: strain energy per width [J/m]": 0.5 * MOMENT * abs(rotation),
        INSIDE: hoop[INSIDE],
        OUTSIDE: hoop[OUTSIDE],
        "force: strain energy per width [J/m]": BAR.end_force_energy(FORCE, QUARTER, plane),
        PULLED: hoop[PULLED],
    }


def missed(field: Callable[[Floats], Floats], r: float, h: float) -> float:
    """What a linear field through the Gauss points misses at the surface, s'' h^2 / 12."""
    step = 1e-3 * INNER
    around = field(np.array([r - step, r, r + step]))
    return float(abs(around[0] - 2.0 * around[1] + around[2]) / step**2 * h**2 / 12.0)


@case(
    "Thick curved bar in bending and under an end force",
    source="Golovin 1881; Timoshenko and Goodier 1970, Theory of Elasticity, art 29 and 33",
)
def run(run: Run, page: Page) -> None:
    """Solve a quarter circle of the bar under the exact tractions on its ends."""
    divisions = QUICK_DIVISIONS if run.quick else DIVISIONS
    found = []
    for n in divisions:
        values, profile = run.timed(f"{n} elements through the height", solve, n)
        found.append(values)
    last, exact = found[-1], exact_values()
    h = (OUTER - INNER) / divisions[-1]
    for key, reference in exact.items():
        name, unit = key.rstrip("]").split(" [")
        within = 1e-3 if run.quick else 1e-4
        why = f"(h/r)^4 at the inside of the finest mesh is {(h / INNER) ** 4:.0e}, and weighs "
        why += "only there"
        if key in HOOP:
            miss = missed(*HOOP[key], h)
            within = 4.0 * miss
            why = f"four times s'' h^2 / 12 = {miss:.2g} MPa, what a linear stress through the "
            why += "Gauss points misses at a surface; the element's own error is of that size"
        page.equals(
            name,
            last[key],
            reference,
            within=within,
            relative=key not in HOOP,
            why=why,
            source="Golovin 1881; Timoshenko and Goodier 1970, art "
            + ("29 and 31" if name.startswith("bending") else "33"),
            unit=unit,
            measure=MEASURES[unit],
            band=band_of(1.0 / np.array(divisions), column(found, key)),
        )
    r = np.linspace(INNER, OUTER, 80)
    radial, hoop = BAR.bending(r, MOMENT)
    straight = -12.0 * MOMENT * (r - 0.5 * (INNER + OUTER)) / (OUTER - INNER) ** 3
    winkler = float(BAR.winkler(np.array(INNER), MOMENT)) / 1e6
    page.answer(
        f"A bar with b/a = {OUTER / INNER:g} carries {last[INSIDE]:.3f} MPa inside (exact "
        f"{exact[INSIDE]:.3f}); the error of Winkler's hook is "
        f"{100 * (winkler / exact[INSIDE] - 1):+.1f} %, that of a straight beam "
        f"{100 * (straight[0] / 1e6 / exact[INSIDE] - 1):+.0f} %."
    )
    page.section("Stress across the height, in bending")
    page.chart(
        "Hoop and radial stress under end moments",
        [
            trace("hoop, exact", r, hoop / 1e6),
            trace("hoop, Winkler", r, BAR.winkler(r, MOMENT) / 1e6),
            trace("hoop, straight beam", r, straight / 1e6),
            trace("radial, exact", r, radial / 1e6),
            trace("hoop, nodes", profile[0], profile[1] / 1e6, points=True),
            trace("radial, nodes", profile[0], profile[2] / 1e6, points=True),
        ],
        "radius [m]",
        "stress [MPa]",
    )
    page.table(
        "By mesh: elements through the height",
        [[key, *column(found, key), exact[key]] for key in exact],
        ["quantity", *map(str, divisions), "exact"],
    )
    page.text(
        "Plane strain, hexahedra of 27 nodes, a quarter circle. The ends carry the exact "
        "tractions, so no clamp disturbs the stress."
    )
    page.data("divisions", divisions)
    page.data("values", found)
    page.data("exact", exact)
