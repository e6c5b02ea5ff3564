"""Ring under two diametrically opposite loads: exact series, curved beam and thin ring."""

from functools import partial

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.plane_rings import plane_strain
from fe_drivetrain.cases.verification import squeezed_rings as rings
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target, targets_of

RADIUS, FORCE = 0.33, 1e6  # m, of the wall's middle; N/m of width
STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=0.0)
PLANE = plane_strain(STEEL.youngs_modulus, STEEL.poisson_ratio)
#: The ring of a mean radius over wall thickness; those that are solved, from thick to thin.
ring = partial(rings.SqueezedRing, RADIUS, force=FORCE, plane=PLANE)
RATIOS, QUICK_RATIOS = (2.0, 5.0, 10.0, 20.0), (2.0, 20.0)
THROUGH, CLOSING = "elements through the wall", "change of the bore's diameter along the load [µm]"
BY_RATIO = "Change of the bore's diameter along the load over W R^3 / (E' I)"
CURVED = "change of the bore's diameter along the load, curved beam with shear"
THIN = "change of the bore's diameter along the load, thin ring, 0.1488 W R^3 / (E' I)"
#: Title with the unit shown, and its factor from SI.
SHOWN = {
    rings.ALONG: (CLOSING, 1e6),
    rings.ACROSS: ("change of the bore's diameter across it [µm]", 1e6),
    rings.UNDER: ("hoop stress of the bore under the load [MPa]", 1e-6),
    rings.OUTSIDE: ("hoop stress, outside, across [MPa]", 1e-6),
    rings.STIFFNESS: ("stiffness W^2 / (2 U) per width [MN/m/m]", 1e-6),
}
SERIES = "Fourier series of Michell's stress functions (Timoshenko and Goodier 1970, art 43)"
BEAMS = "Timoshenko, Strength of Materials, part II, 1956, thick and thin rings; integrated here"


def shown(found: dict[str, float]) -> Record:
    """Quantities in SI by their titles, in the units shown."""
    return {title: factor * found[key] for key, (title, factor) in SHOWN.items()}


def answer(page: Page, ratios: tuple[float, ...], exact: dict[float, Record]) -> None:
    """State how far rings close, and how far a thin ring's formula is from that."""
    closing = "change of the bore's diameter along the load"
    thick, thin = (
        page.judged(
            f"R/h = {ratio:g}: {closing}",
            f"change of diameter along the load, R/h = {ratio:g}",
            "exact series",
            unit="mm",
        )
        for ratio in (ratios[0], ratios[-1])
    )
    misses = [
        -1e6 * ring(ratio).thin() / exact[ratio][CLOSING] - 1 for ratio in (ratios[0], ratios[-1])
    ]
    page.answer(
        "How far do two opposite loads close a ring, and when is the thin-ring formula good?",
        f"A ring with a radius of {ratios[-1]:g} wall thicknesses closes by "
        f"{value_text(-thin.value, thin.unit)} under 1\u00a0MN/m; the thin-ring formula errs by "
        f"{percent_text(misses[1])}, at {ratios[0]:g} thicknesses by {percent_text(misses[0])}.",
        [
            thin,
            thick,
            *(
                page.value(f"error of the thin-ring formula, R/h = {ratio:g} [%]", 100 * miss)
                for ratio, miss in zip((ratios[-1], ratios[0]), reversed(misses), strict=True)
            ),
            page.judged(
                f"R/h = {ratios[0]:g}: hoop stress of the bore under the load",
                f"hoop stress of the bore under the load, R/h = {ratios[0]:g}",
                "exact series",
            ),
        ],
        hero=BY_RATIO,
        cautions=["R is the mean radius and h the thickness of the wall."],
    )


@case(
    "Ring under two diametrically opposite loads",
    source="Fourier series of Michell's stress functions (Timoshenko and Goodier 1970, art 43); "
    "thin ring: Timoshenko, Strength of Materials, part II, 1956",
)
def run(run: Run, page: Page) -> None:
    """Squeeze rings of several thicknesses, by finite elements and by four formulas."""
    ratios = QUICK_RATIOS if run.quick else RATIOS
    page.section("Closing along the load")
    exact = {ratio: shown(run.timed("series", ring(ratio).series)) for ratio in ratios}
    found: dict[float, MeshSeries] = {}
    stress = "recovered stress with eight elements through the wall (six in a quick run), where "
    stress += "the load bends it over its own thickness"
    smooth = "second-order elements h / 8 long at the load: the energy's error is of fourth power"
    allowed = {"stress": (0.02 if run.quick else 0.01, stress), "": (1e-3, smooth)}
    for ratio, of_series in exact.items():
        name, levels = f"R/h = {ratio:g}", ((1, 2, 3) if run.quick else (1, 2, 4))
        meshes = [run.timed(f"elements, {name}", ring(ratio).solid, n, STEEL) for n in levels]
        found[ratio] = MeshSeries([{THROUGH: n, **shown(of)} for n, of in meshes], THROUGH)
        targets = targets_of(of_series, allowed, SERIES)
        page.targets(f"By mesh against the series, {name}", found[ratio], targets, "series", name)
    thinnest, over = ring(ratios[-1]), ratios[-1] ** 2
    beam = "a beam leaves out radial stress and the spread of the load over half a wall, both of "
    beam += "the order of (h/R)^2 = 0.25 %; twice that"
    thin = "a thin ring leaves out shear besides, pi/4 1.2 E'/(12 G) / 0.1488 (h/R)^2 = 1.5 "
    thin += "(h/R)^2; with the rest of the curved beam 4 (h/R)^2 = 1 %"
    curved = Target(CLOSING, -1e6 * thinnest.curved_beam(), 2 / over, beam, BEAMS, CURVED)
    straight = Target(CLOSING, -1e6 * thinnest.thin(), 4 / over, thin, BEAMS, THIN)
    page.finest(found[thinnest.ratio], curved, straight, of=f"R/h = {ratios[-1]:g}")
    answer(page, ratios, exact)
    points = [ring(ratio).share(of.last[CLOSING] / 1e6) for ratio, of in found.items()]
    by_series = [ring(ratio).share(of[CLOSING] / 1e6) for ratio, of in exact.items()]
    page.say(
        f"Over W R^3/(E' I), a ring with R/h = {ratios[-1]:g} closes by {points[-1]:.5f} along "
        f"the load (exact series {by_series[-1]:.5f}, thin ring "
        f"{np.pi / 4.0 - 2.0 / np.pi:.5f}); one with R/h = {ratios[0]:g} by {points[0]:.4f} "
        f"(exact {by_series[0]:.4f})."
    )
    lines = run.timed("series", rings.shares, ring, np.geomspace(1.5, 30.0, 25))
    curves = [*(trace(*of) for of in lines), trace("finite elements", ratios, points, True)]
    x, y = "mean radius over wall thickness", "diameter change E' I / (W R^3)"
    page.chart(BY_RATIO, curves, x, y, "x")
    page.text(
        "Plane strain, E' = E / (1 - nu^2), a quarter of the ring. Each load is a smooth bump of "
        "pressure over one wall thickness of arc, the same for elements and series "
        f"({rings.ORDERS} even harmonics)."
    )
    page.image("A quarter of the thickest ring", run.sketch(ring(ratios[0]).quarter()))
    page.data("curved beam [m]", [ring(ratio).curved_beam() for ratio in ratios])
    page.data("thin ring [m]", [ring(ratio).thin() for ratio in ratios])
