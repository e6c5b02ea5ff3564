"""Ring under two diametrically opposite loads: exact series, curved beam and thin ring."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.report import Measure, trace
from fe_drivetrain.scene import Material
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target
from fe_drivetrain.validation.plane_rings import plane_strain
from fe_drivetrain.validation.squeezed_rings import (
    ACROSS,
    ALONG,
    ORDERS,
    OUTSIDE,
    STIFFNESS,
    UNDER,
    SqueezedRing,
    shares,
)

RADIUS = 0.33  # m, of the wall's middle
STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=0.0)
PLANE = plane_strain(STEEL.youngs_modulus, STEEL.poisson_ratio)
FORCE = 1e6  # N/m of width

#: Mean radius over wall thickness, from a thick ring to a thin one.
RATIOS = (2.0, 5.0, 10.0, 20.0)
QUICK_RATIOS = (2.0, 20.0)

THROUGH = "elements through the wall"
CLOSING = "change of the bore's diameter along the load [µm]"
#: Title with the unit shown, and its factor from SI.
SHOWN = {
    ALONG: (CLOSING, 1e6),
    ACROSS: ("change of the bore's diameter across it [µm]", 1e6),
    UNDER: ("hoop stress of the bore under the load [MPa]", 1e-6),
    OUTSIDE: ("hoop stress, outside, across [MPa]", 1e-6),
    STIFFNESS: ("stiffness W^2 / (2 U) per width [MN/m/m]", 1e-6),
}
SERIES = "Fourier series of Michell's stress functions (Timoshenko and Goodier 1970, art 43)"
BEAMS = "Timoshenko, Strength of Materials, part II, 1956, thick and thin rings; integrated here"


def ring(ratio: float) -> SqueezedRing:
    """The ring of that mean radius over wall thickness."""
    return SqueezedRing(RADIUS, ratio, FORCE, PLANE)


def shown(found: dict[str, float]) -> Record:
    """Quantities in SI by their titles, in the units shown."""
    return {title: factor * found[key] for key, (title, factor) in SHOWN.items()}


def solve(ratio: float, level: int) -> Record:
    """A quarter of solids."""
    through, found = ring(ratio).solid(level, STEEL)
    return {THROUGH: through, **shown(found)}


def target(title: str, value: float, quick: bool) -> Target:
    """One quantity of a ring by the series."""
    if "[MPa]" in title:
        why = "recovered stress with eight elements through the wall (six in a quick run), where "
        why += "the load bends it over its own thickness"
        return Target(title, value, 0.02 if quick else 0.01, why, SERIES)
    why = "elements of second order, h / 8 long at the load: their error is of the fourth power in "
    stiff: Measure = "stiffness" if title == SHOWN[STIFFNESS][0] else "deflection"
    return Target(title, value, 1e-3, why + "energy", SERIES, measure=stiff)


@case(
    "Ring under two diametrically opposite loads",
    source="Fourier series of Michell's stress functions (Timoshenko and Goodier 1970, art 43); "
    "thin ring: Timoshenko, Strength of Materials, part II, 1956",
)
def run(run: Run, page: Page) -> None:
    """Squeeze rings of several thicknesses, by finite elements and by four formulas."""
    ratios = QUICK_RATIOS if run.quick else RATIOS
    page.section("Closing along the load")
    found: dict[float, MeshSeries] = {}
    exact: dict[float, Record] = {}
    for ratio in ratios:
        exact[ratio] = shown(run.timed("series", ring(ratio).series))
        with run.step(f"elements, R/h = {ratio:g}"):
            rows = [solve(ratio, level) for level in ((1, 2, 3) if run.quick else (1, 2, 4))]
        found[ratio] = MeshSeries(rows, THROUGH)
        name = f"R/h = {ratio:g}"
        targets = [target(*of, run.quick) for of in exact[ratio].items()]
        page.targets(f"By mesh against the series, {name}", found[ratio], targets, "series", name)
    thinnest = ratios[-1]
    beam = "a beam leaves out radial stress and the spread of the load over half a wall, both of "
    beam += "the order of (h/R)^2 = 0.25 %; twice that"
    thin = "a thin ring leaves out shear besides, pi/4 1.2 E'/(12 G) / 0.1488 (h/R)^2 = 1.5 "
    thin += "(h/R)^2; with the rest of the curved beam 4 (h/R)^2 = 1 %"
    for formula, closing, share, why in (
        ("curved beam with shear", ring(thinnest).curved_beam(), 2.0, beam),
        ("thin ring, 0.1488 W R^3 / (E' I)", ring(thinnest).thin(), 4.0, thin),
    ):
        name = f"change of the bore's diameter along the load, {formula}"
        of_formula = Target(CLOSING, -1e6 * closing, share / thinnest**2, why, BEAMS, name)
        page.finest(found[thinnest], of_formula, of=f"R/h = {thinnest:g}")
    points = [ring(ratio).share(of.rows[-1][CLOSING] / 1e6) for ratio, of in found.items()]
    of_series = [ring(ratio).share(of[CLOSING] / 1e6) for ratio, of in exact.items()]
    page.answer(
        f"A ring with R/h = {thinnest:g} closes by {points[-1]:.5f} W R^3/(E' I) along the load "
        f"(exact series {of_series[-1]:.5f}, thin ring 0.14878); one with R/h = {ratios[0]:g} by "
        f"{points[0]:.4f} (exact {of_series[0]:.4f}): there the thin ring is of no use."
    )
    with run.step("series"):
        lines = [trace(*line) for line in shares(ring, np.geomspace(1.5, 30.0, 25))]
    title = "Change of the bore's diameter along the load over W R^3 / (E' I)"
    curves = [*lines, trace("finite elements", ratios, points, points=True)]
    x, y = "mean radius over wall thickness", "diameter change E' I / (W R^3)"
    page.chart(title, curves, x, y, "x")
    page.text(
        "Plane strain, E' = E / (1 - nu^2). Each load is a smooth bump of pressure over one wall "
        f"thickness of arc, the same for elements and series ({ORDERS} even harmonics). A quarter "
        "of the ring is meshed."
    )
    page.data("curved beam [m]", [ring(ratio).curved_beam() for ratio in ratios])
    page.data("thin ring [m]", [ring(ratio).thin() for ratio in ratios])
