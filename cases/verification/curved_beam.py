"""Thick curved bar, as of a hook, in bending and under an end force, against exact solutions."""

from collections.abc import Callable

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.report import trace
from fe_drivetrain.scene import Material
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target
from fe_drivetrain.validation.loaded_blocks import edge_nodes, face_loads, solve_block, supports
from fe_drivetrain.validation.plane_rings import CurvedBar, plane_strain
from fe_drivetrain.validation.ring_solids import (
    node_at,
    on_plane,
    plane_strain_hold,
    polar_traction,
    ring_sector,
)

INNER, OUTER = 0.1, 0.3  # m
BAR = CurvedBar(INNER, OUTER)
MOMENT = 1e5  # N, per width
FORCE = 1e6  # N/m, per width
E, NU = 200e9, 0.3
STEEL = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0)
QUARTER = 0.5 * np.pi

THROUGH = "elements through the height"
TURNED = "bending: rotation of the ends [mrad]"
INSIDE, OUTSIDE = "bending: hoop stress inside [MPa]", "bending: hoop stress outside [MPa]"
PULLED = "force: hoop stress inside, t = 90 deg [MPa]"
ENERGIES = [f"{load}: strain energy per width [J/m]" for load in ("bending", "force")]


def bent_hoop(r: Floats) -> Floats:
    """Hoop stress under end moments [MPa]."""
    return BAR.bending(r, MOMENT)[1] / 1e6


def pulled_hoop(r: Floats) -> Floats:
    """Hoop stress under an end force, at t = 90 degrees [MPa]."""
    return BAR.end_force(r, np.array(QUARTER), FORCE)[1] / 1e6


#: Hoop stresses that are judged: along the radius [MPa], and where.
HOOP = {INSIDE: (bent_hoop, INNER), OUTSIDE: (bent_hoop, OUTER), PULLED: (pulled_hoop, INNER)}

PLANE = plane_strain(E, NU)
ROTATION = abs(BAR.bending_rotation(MOMENT, PLANE) * QUARTER)  # rad
#: The closed forms, in the order of the page.
EXACT = {
    TURNED: 1e3 * ROTATION,
    ENERGIES[0]: 0.5 * MOMENT * ROTATION,
    INSIDE: float(bent_hoop(np.array(INNER))),
    OUTSIDE: float(bent_hoop(np.array(OUTER))),
    ENERGIES[1]: BAR.end_force_energy(FORCE, QUARTER, PLANE),
    PULLED: float(pulled_hoop(np.array(INNER))),
}


def solve(n: int) -> Record:
    """Both loads on one mesh; radius, hoop and radial stress [m, MPa] of one end in bending."""
    width = (OUTER - INNER) / n
    bar = ring_sector(INNER, OUTER, width, QUARTER, (n, 2 * n, 1))
    here, there = (
        [node_at(bar.points, [0.0, r * np.cos(t), r * np.sin(t)]) for r in (INNER, OUTER)]
        for t in (0.0, QUARTER)
    )
    middle = node_at(bar.points, [0.0, *(0.5 * (INNER + OUTER) * np.array([np.cos(QUARTER), 1.0]))])
    flat = plane_strain_hold(bar)

    # in bending, sections stay plane: that at t = 0 is held on its plane
    bending = polar_traction(lambda r, t: (*BAR.bending(r, MOMENT), np.zeros_like(r)))
    plane = on_plane("symmetry", bar.face_nodes("y0"), [0.0, 0.0, 1.0], bar.points.size)
    still = supports(bar, (here[0], "y"))
    bent = solve_block(bar, STEEL, face_loads(bar, y1=bending), flat, plane, still)
    # under the force they warp: both ends carry the exact tractions, and three degrees of freedom
    # at t = 90 degrees hold the bar without force
    pull = polar_traction(lambda r, t: BAR.end_force(r, t, FORCE))
    F = face_loads(bar, y0=pull, y1=pull)
    pulled = solve_block(bar, STEEL, F, flat, supports(bar, (middle, "yz"), (there[1], "y")))
    end = edge_nodes(bar, "y1", "z0", along=2)
    turned = abs(bent.u[there[1], 1] - bent.u[there[0], 1]) / (OUTER - INNER)
    return {
        THROUGH: n,
        TURNED: 1e3 * float(turned),
        ENERGIES[0]: bent.energy / width,
        INSIDE: float(bent.polar.hoop[there[0]]) / 1e6,
        OUTSIDE: float(bent.polar.hoop[there[1]]) / 1e6,
        ENERGIES[1]: pulled.energy / width,
        PULLED: float(pulled.polar.hoop[there[0]]) / 1e6,
        "end": (bar.points[end, 2], bent.polar.hoop[end] / 1e6, bent.polar.radial[end] / 1e6),
    }


def missed(field: Callable[[Floats], Floats], r: float, h: float) -> float:
    """What a linear field through the Gauss points misses at the surface, s'' h^2 / 12."""
    step = 1e-3 * INNER
    around = field(np.array([r - step, r, r + step]))
    return float(abs(around[0] - 2.0 * around[1] + around[2]) / step**2 * h**2 / 12.0)


def target(key: str, within: float, h: float) -> Target:
    """One quantity, and what a finest mesh of elements of size h may miss of it."""
    source = "Golovin 1881; Timoshenko and Goodier 1970, art "
    source += "29 and 31" if key.startswith("bending") else "33"
    if key not in HOOP:
        why = f"(h/r)^4 at the inside of the finest mesh is {(h / INNER) ** 4:.0e}, and weighs "
        return Target(key, EXACT[key], within, why + "only there", source)
    miss = missed(*HOOP[key], h)
    why = f"four times s'' h^2 / 12 = {miss:.2g} MPa, what a linear stress through the Gauss "
    why += "points misses at a surface; the element's own error is of that size"
    return Target(key, EXACT[key], 4.0 * miss, why, source, relative=False)


@case(
    "Thick curved bar in bending and under an end force",
    source="Golovin 1881; Timoshenko and Goodier 1970, Theory of Elasticity, art 29 and 33",
)
def run(run: Run, page: Page) -> None:
    """Solve a quarter circle of the bar under the exact tractions on its ends."""
    divisions = (3, 6, 12) if run.quick else (4, 8, 16)
    rows = [run.timed(f"{n} {THROUGH}", solve, n) for n in divisions]
    series, last = MeshSeries(rows, THROUGH), rows[-1]
    r = np.linspace(INNER, OUTER, 80)
    radial, hoop = BAR.bending(r, MOMENT)
    winkler = BAR.winkler(r, MOMENT)
    straight = -12.0 * MOMENT * (r - 0.5 * (INNER + OUTER)) / (OUTER - INNER) ** 3
    errors = [100 * (of[0] / 1e6 / EXACT[INSIDE] - 1) for of in (winkler, straight)]
    page.answer(
        f"A bar with b/a = {OUTER / INNER:g} carries {last[INSIDE]:.3f} MPa inside (exact "
        f"{EXACT[INSIDE]:.3f}); the error of Winkler's hook is {errors[0]:+.1f} %, that of a "
        f"straight beam {errors[1]:+.0f} %."
    )
    page.section("Stress across the height, in bending")
    at, *of_nodes = last["end"]
    page.chart(
        "Hoop and radial stress under end moments",
        [
            trace("hoop, exact", r, hoop / 1e6),
            trace("hoop, Winkler", r, winkler / 1e6),
            trace("hoop, straight beam", r, straight / 1e6),
            trace("radial, exact", r, radial / 1e6),
            trace("hoop, nodes", at, of_nodes[0], points=True),
            trace("radial, nodes", at, of_nodes[1], points=True),
        ],
        "radius [m]",
        "stress [MPa]",
    )
    within, h = 1e-3 if run.quick else 1e-4, (OUTER - INNER) / divisions[-1]
    page.targets("By mesh", series, [target(key, within, h) for key in EXACT], "exact")
    page.text(
        "Plane strain, hexahedra of 27 nodes, a quarter circle. The ends carry the exact "
        "tractions, so no clamp disturbs the stress."
    )
