"""Interference fit of two cylinders of one material: verification problem VM292 of Ansys."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.interference_fits import exact_fit, press, quarters
from fe_drivetrain.comparison import as_printed
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target

RADII = 1.25, 1.516, 1.75  # m
MISFIT = 0.02  # m, on the radius
EQUAL = Material(youngs_modulus=206e9, poisson_ratio=0.0, density=0.0)
FIT = RADII, MISFIT, (EQUAL, EQUAL)

THROUGH, PRESSURE = "elements through the outer cylinder", "contact pressure [MPa]"
MANUAL = "Ansys Mechanical APDL verification manual, VM292, as quoted"
LAME = "two Lame cylinders (Lame 1852; Timoshenko, Strength of Materials II, 1956)"


def solve(n: int) -> Record:
    """A quarter of both cylinders, the misfit closed."""
    return {THROUGH: n, PRESSURE: press(*FIT, n).pressure / 1e6}


@case(
    "Interference fit of two cylinders (VM292)",
    source="Ansys Mechanical APDL verification manual, VM292",
)
def run(run: Run, page: Page) -> None:
    """Press the cylinders together on ever finer meshes."""
    series = MeshSeries([run.timed("press", solve, n) for n in (1, 2, 4)], THROUGH)
    exact, found = exact_fit(*FIT).pressure / 1e6, series.last[PRESSURE]
    fourth = "(h/r)^4 of the finest mesh is below 1e-5; no more than 1e-4 shall be left"
    page.targets("By mesh", series, [Target(PRESSURE, exact, 1e-4, fourth, LAME)], "exact")
    printed, band = as_printed("221.638"), series.band(PRESSURE)
    page.equals(PRESSURE, found, band=band, **printed, source=MANUAL, basis="second-hand")
    page.equals(f"Lame's {PRESSURE}", exact, **printed, source=MANUAL, basis="second-hand")
    page.say(
        f"The cylinders press each other with {found:.3f} MPa; the manual has "
        f"{printed['reference']:.3f}."
    )
    page.text(
        "The problem is quoted with an interference of 0.02 m on the diameter. The printed "
        "pressure is that of 0.02 m on the radius, as it is solved here; on the diameter it would "
        f"be half, {0.5 * exact:.3f} MPa."
    )
    page.image("A quarter of both cylinders, finest mesh", run.sketch(*quarters(RADII, 0.2, 4)))
