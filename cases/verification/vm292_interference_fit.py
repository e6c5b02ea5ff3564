"""Interference fit of two cylinders of one material: verification problem VM292 of Ansys."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.interference_fits import (
    exact_fit,
    press,
    quarters,
    stress_by_radius,
)
from fe_drivetrain.comparison import as_printed
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target

RADII = 1.25, 1.516, 1.75  # m
MISFIT = 0.02  # m, on the radius
EQUAL = Material(youngs_modulus=206e9, poisson_ratio=0.0, density=0.0)
FIT = RADII, MISFIT, (EQUAL, EQUAL)

PRESSURES = "Contact pressure with 0.02 m of misfit on the radius, and on the diameter"
BY_RADIUS = "Stress by the radius: finest mesh against Lame's cylinders"
PRINTED = "221.638"  # MPa
THROUGH, PRESSURE = "elements through the outer cylinder", "contact pressure [MPa]"
MANUAL = "Ansys Mechanical APDL verification manual, VM292, as quoted"
LAME = "two Lame cylinders (Lame 1852; Timoshenko, Strength of Materials II, 1956)"


def answer(page: Page, found: float, band: float, exact: float) -> None:
    """State the pressure [MPa], and the misfit that the printed one belongs to."""
    pressed = page.value(PRESSURE, found, band, beside=float(PRINTED), by="VM292", printed=PRINTED)
    same = "as" if all(check.passed for check in page.checks) else "not as"
    half = value_text(0.5 * exact, "MPa")
    page.answer(
        "How hard do the two cylinders of Ansys's VM292 press on each other?",
        f"With 0.02\u00a0m of interference on the radius they press with {certain_value(pressed)}, "
        f"{same} VM292 prints; on the diameter, as quoted, it is not that but {half}.",
        [
            pressed,
            page.judged("Lame's contact pressure", by="VM292", printed=PRINTED),
            page.value("contact pressure with 0.02 m on the diameter [MPa]", 0.5 * exact),
        ],
        hero=PRESSURES,
        claim="holds in part",
    )


@case(
    "Interference fit of two cylinders (VM292)",
    source="Ansys Mechanical APDL verification manual, VM292",
)
def run(run: Run, page: Page) -> None:
    """Press the cylinders together on ever finer meshes."""
    meshes = {n: run.timed("press", press, *FIT, n) for n in (1, 2, 4)}
    rows: list[Record] = [{THROUGH: n, PRESSURE: of.pressure / 1e6} for n, of in meshes.items()]
    series, fit = MeshSeries(rows, THROUGH), exact_fit(*FIT)
    exact, found = fit.pressure / 1e6, series.last[PRESSURE]
    fourth = "(h/r)^4 of the finest mesh is below 1e-5; no more than 1e-4 shall be left"
    page.targets("By mesh", series, [Target(PRESSURE, exact, 1e-4, fourth, LAME)], "exact")
    printed, band = as_printed(PRINTED), series.band(PRESSURE)
    page.equals(PRESSURE, found, band=band, **printed, source=MANUAL, basis="second-hand")
    page.equals(f"Lame's {PRESSURE}", exact, **printed, source=MANUAL, basis="second-hand")
    answer(page, found, band, exact)
    pressures = {
        "finest mesh": found,
        "Lame": exact,
        "VM292, printed": float(PRINTED),
        "Lame, 0.02 m on the diameter": 0.5 * exact,
    }
    page.add(bars(PRESSURES, {"pressure": pressures}, PRESSURE))
    curves = stress_by_radius(fit, meshes[4], ("inner cylinder", "outer cylinder"))
    page.chart(BY_RADIUS, curves, "radius [m]", "stress [MPa]")
    page.text(
        "The problem is quoted with an interference of 0.02 m on the diameter. The printed "
        "pressure is that of 0.02 m on the radius, as it is solved here; on the diameter it would "
        f"be half, {0.5 * exact:.3f} MPa."
    )
    page.image("A quarter of both cylinders, finest mesh", run.sketch(*quarters(RADII, 0.2, 4)))
