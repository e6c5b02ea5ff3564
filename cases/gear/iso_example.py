"""Mesh stiffness of the first example of ISO/TR 6336-30."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.published_gears import ISO_EXAMPLE_1, iso_example_1
from fe_drivetrain.gear import iso_gear_stiffness
from fe_drivetrain.report import gear_pair
from fe_drivetrain.report.number_text import value_text, value_with_band
from fe_drivetrain.report.suite import Page, Run

SOURCE = "ISO/TR 6336-30:2017, example 1"
TORQUE = 9000.0  # N m
HERO = "Stiffness by ISO 6336-1: difference from the printed digits"


def answer(page: Page, computed: dict[str, float]) -> None:
    """State the mesh stiffness, and how far all numbers are from those printed."""
    kinds = ("mesh", "single", "misaligned", "theoretical")
    figures = [
        page.judged(f"{kind} stiffness", by="ISO/TR", printed=f"{printed:.5f}")
        for kind in kinds
        for printed in [ISO_EXAMPLE_1[f"{kind} stiffness [N/(mm µm)]"]]
    ]
    largest = max(
        100.0 * abs(computed[name] / printed - 1.0) for name, printed in ISO_EXAMPLE_1.items()
    )
    page.answer(
        "Does the program give the mesh stiffness that ISO/TR 6336-30 prints for example 1?",
        f"The mean mesh stiffness is {value_with_band(figures[0])}, and all {len(ISO_EXAMPLE_1)} "
        f"printed numbers agree within {value_text(largest, '%')}.",
        [
            *figures,
            page.value("largest difference from a printed number [%]", largest),
            page.value("printed numbers compared", len(ISO_EXAMPLE_1)),
        ],
        hero=HERO,
        cautions=[
            "Tip diameters are rounded to 0.01 mm, 159.66 and 872.35 mm, as in the example; "
            "without rounding the mesh stiffness differs by 0.013 %."
        ],
    )
    page.errors(HERO, figures)


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
    answer(page, computed)
    page.image("The pair of 17 and 103 teeth", run.sketch(*gear_pair(pair)))
