"""Example 1 of ISO/TR 6336-30: contact stress and what is endured."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear.printed_ratings import check_mesh
from fe_drivetrain.cases.references.rated_gears import rated, rated_meshes
from fe_drivetrain.report import gear_pair
from fe_drivetrain.report.number_text import value_text, value_with_band
from fe_drivetrain.report.suite import Page, Run

SOURCE = "ISO/TR 6336-30:2017, example 1, as the public repository gfsReboucas/Drivetrain quotes it"
PRINTED = {"sigma_H [MPa]": (1301.35343, 1301.35343), "S_H": (1.02853, 1.08696)}


HERO = "Contact rating of the pair: difference from the printed digits"


def answer(page: Page, of: str) -> None:
    """State the contact stress and the safety of the pair beside those printed."""
    stress = page.judged("sigma_H, 17 teeth", "contact stress sigma_H", "ISO/TR", "1301.35")
    safety = page.judged("S_H, 17 teeth", "safety S_H, 17 teeth", "ISO/TR", "1.02853")
    figures = [
        stress,
        safety,
        page.judged("S_H, 103 teeth", "safety S_H, 103 teeth", "ISO/TR", "1.08696"),
        page.judged(f"{of}: sigma_H0", "nominal contact stress sigma_H0", "ISO/TR", "1206.58"),
        page.judged(f"{of}: sigma_HG, 17 teeth", "endured stress sigma_HG, 17 teeth", "ISO/TR"),
        page.judged(f"{of}: sigma_HG, 103 teeth", "endured stress sigma_HG, 103 teeth", "ISO/TR"),
    ]
    largest = max(100.0 * abs(one.value / (one.limit or 1.0) - 1.0) for one in figures)
    page.answer(
        "Does the program rate the tooth flanks of example 1 as ISO/TR 6336-30 does?",
        f"The contact stress is {value_with_band(stress)} and the safety "
        f"{value_with_band(safety)}; all {len(figures)} values agree with the printed ones "
        f"within {value_text(largest, '%')}.",
        figures,
        hero=HERO,
        cautions=[
            "The example is quoted from a secondary source; K_v, K_Hbeta and K_Halpha are taken as "
            "printed, and the root stress cannot be compared."
        ],
    )
    page.section("Beside the printed digits")
    page.errors(HERO, figures)


@case(
    "Example 1 of ISO/TR 6336-30",
    source="ISO/TR 6336-30:2017, example 1, quoted in gfsReboucas/Drivetrain",
)
def run(run: Run, page: Page) -> None:
    """Rate the helical pair of 17 and 103 teeth."""
    mesh = rated_meshes()["ISO/TR 6336-30, example 1"]
    with run.step("rating"):
        check_mesh(page, mesh, SOURCE, "second-hand")
        found = rated(mesh)
    for quantity, prints in PRINTED.items():
        for number, (ours, printed) in enumerate(zip(found[quantity], prints, strict=True)):
            teeth = (mesh.pair.first if number == 0 else mesh.pair.second).teeth
            name, _, unit = quantity.partition(" [")
            page.equals(
                f"{name}, {teeth} teeth" + (f" [{unit}" if unit else ""),
                ours,
                printed,
                within=6e-4,
                why="K_v = 1.003 and K_Hbeta = 1.16 have four and three digits: half of the last "
                "leaves 4.5e-4 of the root of their product, tip diameters that are not public "
                "1e-4",
                source=SOURCE,
                basis="second-hand",
            )
    answer(page, mesh.name)
    page.section("What is given")
    page.text(
        "Teeth 17 and 103, m_n 8 mm, 15.8 degrees, shift 0.145, face 100 mm, centre distance "
        "500 mm, 9000 N m at 360 1/min over 50 000 h, oil of 320 mm^2/s, R_z 6 um. K_v, K_Hbeta "
        "and K_Halpha = 1 are inputs: deviations and shafts of the example are not public, nor are "
        "its root factors Y."
    )
    page.image("The pair of 17 and 103 teeth", run.sketch(*gear_pair(mesh.pair)))
