"""Mesh stiffness of the first example of ISO/TR 6336-30."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.published_gears import ISO_EXAMPLE_1, iso_example_1
from fe_drivetrain.gear import iso_gear_stiffness
from fe_drivetrain.report import gear_pair
from fe_drivetrain.report.suite import Page, Run

SOURCE = "ISO/TR 6336-30:2017, example 1"
TORQUE = 9000.0  # N m


@case(
    "ISO/TR 6336-30, example 1: geometry and stiffness to the printed digits",
    source="ISO/TR 6336-30:2017, example 1",
)
def run(run: Run, page: Page) -> None:
    """Compute what the example prints of geometry and stiffness."""
    pair = iso_example_1()
    force = pair.tangential_force(TORQUE)
    with run.step("stiffness"):
        found = iso_gear_stiffness(pair, specific_load=force / pair.face_width)
    computed = {
        "virtual teeth of the pinion": pair.first.virtual_teeth,
        "virtual teeth of the wheel": pair.second.virtual_teeth,
        "tangential force [kN]": force / 1e3,
        "theoretical stiffness [N/(mm µm)]": found.theoretical / 1e9,
        "single stiffness [N/(mm µm)]": found.single / 1e9,
        "mesh stiffness [N/(mm µm)]": found.mesh / 1e9,
        "misaligned stiffness [N/(mm µm)]": found.misaligned / 1e9,
    }
    for quantity, printed in ISO_EXAMPLE_1.items():
        geometry = "[N/(" not in quantity
        mesh = quantity.startswith(("mesh", "misaligned"))
        page.equals(
            quantity,
            computed[quantity],
            printed,
            within=5e-6 if not geometry and not mesh else 1e-5 if mesh else 3e-5,
            why="the printed digits, with tip diameters rounded to 0.01 mm; 1.3e-4 without rounding"
            if mesh
            else "half a unit of the last printed digit",
            source=SOURCE,
            measure="identity" if geometry else "stiffness",
        )
    page.table(
        "Example 1: 17 and 103 teeth of module 8 mm, helix 15.8 degrees",
        [
            {"quantity": name, "printed": printed, "here": computed[name]}
            for name, printed in ISO_EXAMPLE_1.items()
        ],
    )
    page.say(
        f"The mean mesh stiffness is {found.mesh / 1e9:.5f} N/(mm µm) with tip diameters of 159.66 "
        "and 872.35 mm; the example prints 17.46485."
    )
    page.image("The pair of 17 and 103 teeth", run.sketch(*gear_pair(pair)))
