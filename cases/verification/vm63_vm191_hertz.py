"""Hertz contacts of a sphere on a flat and of two cylinders: problems VM63 and VM191 of Ansys."""

import numpy as np

from fe_drivetrain.bearing import point_contact
from fe_drivetrain.cases import case
from fe_drivetrain.comparison import as_printed, round_off
from fe_drivetrain.gear import LineContact, reduced_modulus
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import Page, Run

# mm, N and MPa, as the manual has them
SPHERE, SOFT, POISSON, FORCE = 8.0, 1000.0, 0.3, 60.0 * np.pi
CYLINDERS, MODULI, RATIOS, PER_LENGTH = (10.0, 13.0), (30000.0, 29120.0), (0.25, 0.30), 3200.0
BETWEEN = "Pressure between the cylinders"
MANUAL = "Ansys Mechanical APDL verification manual, {}, as quoted"
HALF_WIDTH, RADIUS = "cylinders: half width [mm]", "sphere: radius of the contact [mm]"
PRESSURE = "cylinders: largest pressure [MPa]"


def answer(page: Page, half_width: float) -> None:
    """State the sizes of both contacts; `half_width` is that of the cylinders [mm]."""
    sphere, closed = (
        page.judged(f"{start}{RADIUS.partition(' [')[0]}", "radius of the sphere's contact", by, of)
        for start, by, of in (("", "VM63", "1.010"), ("closed form, ", "closed form", ""))
    )
    width = page.value(
        "half width of the cylinders' contact [mm]",
        half_width,
        beside=1.2,
        by="VM191",
        printed="1.20",
    )
    pressure = page.judged(
        PRESSURE.partition(" [")[0], "largest pressure of the cylinders", "VM191", "1698.06"
    )
    same = "as" if all(check.passed for check in page.checks) else "not as"
    page.answer(
        "How large are the Hertz contacts of Ansys's VM63 (sphere) and VM191 (cylinders)?",
        f"The sphere's contact has a radius of {certain_value(sphere)}, the cylinders' a half "
        f"width of {certain_value(width)} and a pressure of {certain_value(pressure)}, {same} the "
        "manual prints.",
        [sphere, closed, width, pressure],
        hero=BETWEEN,
    )


@case(
    "Hertz contacts of a sphere on a rigid flat and of two cylinders (VM63, VM191)",
    source="Ansys Mechanical APDL verification manual, VM63 and VM191; Johnson, Contact mechanics, "
    "1985",
)
def run(run: Run, page: Page) -> None:
    """Press a ball on a flat, as bearings have it, and two cylinders, as teeth have them."""
    # against a rigid flat the sphere alone gives way: as two bodies of twice its modulus
    ball = point_contact((1.0 / SPHERE, 1.0 / SPHERE), 2.0 * SOFT, POISSON)
    axes = np.cbrt(FORCE) * np.array(ball.half_axes)
    # each of two unlike bodies gives way by half of what two like it would
    gives = [1.0 / reduced_modulus(E, nu) for E, nu in zip(MODULI, RATIOS, strict=True)]
    radius = 1.0 / sum(1.0 / r for r in CYLINDERS)
    line = LineContact(PER_LENGTH, radius, 1.0 / (0.5 * sum(gives)))
    for number, quantity, value, prints in (
        ("VM63", RADIUS, axes[0], ("1.010",)),
        ("VM191", HALF_WIDTH, line.half_width, ("1.20", "1.19971")),
        ("VM191", PRESSURE, line.pressure, ("1698.06",)),
    ):
        for printed in prints:
            source = MANUAL.format(number) if printed != "1.19971" else "Hertz, in another program"
            of = as_printed(printed)
            page.equals(quantity, float(value), **of, source=source, basis="second-hand")
    closed = float(np.cbrt(0.75 * FORCE * SPHERE * (1.0 - POISSON**2) / SOFT))
    rounded = round_off(1e3, "a cube root and elliptic integrals of a circle")
    source = "a^3 = 3 F R / (4 E*): Johnson 1985, Eq 4.22"
    page.equals(f"closed form, {RADIUS}", float(axes[1]), closed, **rounded, source=source)
    x = np.linspace(-line.half_width, line.half_width, 401)
    carried = float(np.trapezoid(line.pressure_at(x), x))
    steep = "trapezoids of a root that begins steeply miss some (2 / 400)^1.5"
    title = "cylinders: integral of the pressure [N/mm]"
    page.equals(title, carried, PER_LENGTH, within=(2 / 400) ** 1.5, why=steep, source="balance")
    answer(page, line.half_width)
    page.chart(
        BETWEEN,
        [trace("Hertz", x, line.pressure_at(x))],
        "from the middle of the strip [mm]",
        "pressure [MPa]",
    )
