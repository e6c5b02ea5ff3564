"""Thick curved bar, as of a hook, in bending and under an end force, against exact solutions."""

from collections.abc import Callable

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.loaded_blocks import fourth_power, within_surface
from fe_drivetrain.cases.references.plane_rings import CURVED_BAR, CurvedBar, plane_strain
from fe_drivetrain.cases.verification.curved_bars import bent_and_pulled, curvature_of, quarter_of
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target

INNER, OUTER = 0.1, 0.3  # m
BAR = CurvedBar(INNER, OUTER)
MOMENT, FORCE = 1e5, 1e6  # per width: N, N/m
STEEL = Material(youngs_modulus=200e9, poisson_ratio=0.3, density=0.0)
PLANE = plane_strain(STEEL.youngs_modulus, STEEL.poisson_ratio)
QUARTER = 0.5 * np.pi

THROUGH_HEIGHT = "Hoop stress through the height of the bent bar"
THROUGH = "elements through the height"
TURNED = "bending: rotation of the ends [mrad]"
INSIDE, OUTSIDE = "bending: hoop stress inside [MPa]", "bending: hoop stress outside [MPa]"
PULLED = "force: hoop stress inside, t = 90 deg [MPa]"
ENERGIES = [f"{load}: strain energy per width [J/m]" for load in ("bending", "force")]
#: Hoop stresses that are judged: along the radius [MPa], and where; a force at t = 90 degrees.
HOOP: dict[str, tuple[Callable[[Floats], Floats], float]] = {
    INSIDE: (lambda r: BAR.bending(r, MOMENT)[1] / 1e6, INNER),
    OUTSIDE: (lambda r: BAR.bending(r, MOMENT)[1] / 1e6, OUTER),
    PULLED: (lambda r: BAR.end_force(r, np.array(QUARTER), FORCE)[1] / 1e6, INNER),
}
ROTATION = abs(BAR.bending_rotation(MOMENT, PLANE) * QUARTER)  # rad
#: The closed forms.
EXACT = {
    TURNED: 1e3 * ROTATION,
    ENERGIES[0]: 0.5 * MOMENT * ROTATION,
    ENERGIES[1]: BAR.end_force_energy(FORCE, QUARTER, PLANE),
    **{key: float(along(np.array(r))) for key, (along, r) in HOOP.items()},
}


def solve(n: int) -> Record:
    """Both loads on one mesh."""
    bar = bent_and_pulled(BAR, STEEL, MOMENT, FORCE, n)
    return {
        THROUGH: n,
        TURNED: 1e3 * bar.rotation,
        ENERGIES[0]: bar.bent.energy / bar.width,
        INSIDE: float(bar.bent.polar.hoop[bar.inside]) / 1e6,
        OUTSIDE: float(bar.bent.polar.hoop[bar.outside]) / 1e6,
        ENERGIES[1]: bar.pulled.energy / bar.width,
        PULLED: float(bar.pulled.polar.hoop[bar.inside]) / 1e6,
    }


def target(key: str, within: float, h: float) -> Target:
    """One quantity, and what a finest mesh of elements of size h may miss of it."""
    if key not in HOOP:
        why = f"{fourth_power(h, INNER)}, and weighs only there"
        return Target(key, EXACT[key], within, why, CURVED_BAR)
    recovered = within_surface(curvature_of(*HOOP[key], 1e-3 * INNER), h)
    return Target(key, EXACT[key], *recovered, CURVED_BAR, relative=False)


def answer(page: Page) -> None:
    """State the stress inside, beside what simpler formulae make of it."""
    inside, outside = (
        page.judged(key.removesuffix(" [MPa]"), f"hoop stress {where}", "exact")
        for key, where in ((INSIDE, "inside"), (OUTSIDE, "outside"))
    )
    straight = 6.0 * MOMENT / (OUTER - INNER) ** 2 / 1e6
    winkler = float(BAR.winkler(np.array(INNER), MOMENT)) / 1e6
    by_hook, by_beam = (100 * (of / EXACT[INSIDE] - 1) for of in (winkler, straight))
    beam_off, hook_off = (
        f"{abs(off):.2g}\u00a0% too {'low' if off < 0 else 'high'}" for off in (by_beam, by_hook)
    )
    page.answer(
        "Which hoop stress does the inside of a thick curved bar, such as a hook, carry?",
        f"The inside carries {certain_value(inside)} and the outside {certain_value(outside)}; "
        f"inside, a straight beam's formula is {beam_off}, Winkler's formula for hooks {hook_off}.",
        [
            inside,
            outside,
            page.value(
                "hoop stress inside, straight-beam formula [MPa]",
                straight,
                beside=EXACT[INSIDE],
                by="exact",
            ),
            page.value(
                "hoop stress inside, Winkler's formula [MPa]",
                winkler,
                beside=EXACT[INSIDE],
                by="exact",
            ),
            page.judged(TURNED.removesuffix(" [mrad]"), "rotation of the ends", "exact"),
            page.judged(
                PULLED.removesuffix(" [MPa]"), "hoop stress inside, under an end force", "exact"
            ),
        ],
        hero=THROUGH_HEIGHT,
        cautions=["The ends carry the exact tractions: a clamp would disturb the stress near it."],
    )


def show_hoop(page: Page, finest: Record) -> None:
    """Hoop stress of the bent bar over the radius, exact and by simpler formulae."""
    r = np.linspace(INNER, OUTER, 60)
    half = 0.5 * (OUTER - INNER)
    straight = 6.0 * MOMENT / (OUTER - INNER) ** 2 * (INNER + half - r) / half
    surfaces = [1e3 * INNER, 1e3 * OUTER]
    curves = [
        trace("exact", 1e3 * r, BAR.bending(r, MOMENT)[1] / 1e6),
        trace("Winkler's hook", 1e3 * r, BAR.winkler(r, MOMENT) / 1e6, line={"dash": "dash"}),
        trace("straight beam", 1e3 * r, straight / 1e6, line={"dash": "dot"}),
        trace("solid, at the surfaces", surfaces, [finest[INSIDE], finest[OUTSIDE]], points=True),
    ]
    page.chart(THROUGH_HEIGHT, curves, "radius [mm]", "hoop stress [MPa]")


@case(
    "Thick curved bar in bending and under an end force",
    source="theory: Golovin's bar of 1881, in equilibrium, compatible, free on its surfaces and "
    "with the given resultant (tests/cases/test_plane_rings.py)",
)
def run(run: Run, page: Page) -> None:
    """Solve a quarter circle of the bar under the exact tractions on its ends."""
    divisions = (3, 6, 12) if run.quick else (4, 8, 16)
    series = MeshSeries([run.timed(f"{n} {THROUGH}", solve, n) for n in divisions], THROUGH)
    within, h = 1e-3 if run.quick else 1e-4, (OUTER - INNER) / divisions[-1]
    page.targets("By mesh", series, [target(key, within, h) for key in EXACT], "exact")
    answer(page)
    show_hoop(page, series.last)
    page.text(
        "Plane strain, hexahedra of 27 nodes, a quarter circle. The ends carry the exact "
        "tractions, so no clamp disturbs the stress."
    )
    page.image("The quarter circle that is solved, of one mesh", run.sketch(quarter_of(BAR, 4)))
