"""The page of ``strength``: safety of sections, stress along the shaft, factors, joints."""

from __future__ import annotations

from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.shaft_strength import StrengthResult
from fe_drivetrain.studies.strength_findings import stress_chart

_SAFETY = ("section", "S_D", "± S_D", "S_D of the largest range for ever", "S_F", "± S_F")
_STRESS = (
    *("section", "nominal, axial [MPa]", "nominal, bending [MPa]", "nominal, torsion [MPa]"),
    *("largest local, von Mises [MPa]", "± [MPa]"),
)
_FACTORS = tuple(
    f"{what}{load}"
    for load in ("tension", "bending", "torsion")
    for what in ("K_t in ", "± K_t in ", "by formula, ", "beta in ")
)
_ENDURED = (
    *("section", "R_m [MPa]", "R_e [MPa]", "endured reversed in tension [MPa]"),
    *("endured reversed in bending [MPa]", "endured reversed in torsion [MPa]", "remark"),
)


def show_strength(run: Run, page: Page, result: StrengthResult) -> None:
    """Show how safe the sections and joints of a shaft are, and what stresses them.

    Parameters
    ----------
    run : Run
        Not used: the page has no pictures.
    page : Page
        Takes charts and tables.
    result : StrengthResult
        What was found.
    """
    tables = result.tables
    page.section("Safety of all sections")
    page.add(result.chart())
    damage = ["damage of the life"] if result.varies else []
    second = "local stress, second way: S"
    page.table(
        f"S_D against fatigue (required {result.required[0]:g}) and S_F against yielding "
        f"(required {result.required[1]:g}), by DIN 743",
        tables["sections"],
        [*_SAFETY, *damage, second],
    )
    if tables["not rated"]:
        page.table("Sections that are not rated", tables["not rated"])
    page.text(
        "S_D is the factor of all loads that just brings failure. Bands: both bounds of the "
        "housings, the mesh of fillets, every other point round the shaft, and what samples of a "
        "turning shaft miss. The second way is the local stress of the largest range against the "
        "fatigue limit, after the FKM guideline, where 1.5 is usual; its constants are in part "
        "unverified, so nothing is judged by it."
    )
    page.section("Stress along the shaft")
    page.add(stress_chart(result.stations, result.along, list(result.sections.values())))
    page.table("Largest stresses, and bands of local ones", tables["stresses"], list(_STRESS))
    page.section("Joints")
    if tables["joints"]:
        page.table("Safety of joints that hold by friction", tables["joints"])
    else:
        page.text("The file states none: keys strength.flange and strength.press_fits.")
    page.section("Factors")
    page.table(
        "Stress concentration by elasticity (with its band) or by formula, and fatigue notch "
        "factors",
        tables["stresses"],
        ["section", *_FACTORS],
    )
    page.table("What the sections endure in nominal stress", tables["stresses"], list(_ENDURED))
    page.table("What loaded the shaft", tables["histories"])
