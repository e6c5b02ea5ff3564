"""Example 1 of ISO/TR 6336-30: contact stress and what is endured."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear.printed_ratings import check_mesh
from fe_drivetrain.cases.references.rated_gears import rated, rated_meshes
from fe_drivetrain.report import gear_pair
from fe_drivetrain.report.suite import Page, Run

SOURCE = "ISO/TR 6336-30:2017, example 1, as the public repository gfsReboucas/Drivetrain quotes it"
PRINTED = {"sigma_H [MPa]": (1301.35343, 1301.35343), "S_H": (1.02853, 1.08696)}


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
    page.say(
        f"sigma_H0 is {found['sigma_H0 [MPa]'][0]:.2f} MPa (1206.58 printed), sigma_H "
        f"{found['sigma_H [MPa]'][0]:.1f} MPa (1301.35), S_H {found['S_H'][0]:.4f} and "
        f"{found['S_H'][1]:.4f} (1.02853 and 1.08696).",
    )
    page.section("What is given")
    page.text(
        "Teeth 17 and 103, m_n 8 mm, 15.8 degrees, shift 0.145, face 100 mm, centre distance "
        "500 mm, 9000 N m at 360 1/min over 50 000 h, oil of 320 mm^2/s, R_z 6 um. K_v, K_Hbeta "
        "and K_Halpha = 1 are inputs: deviations and shafts of the example are not public, nor are "
        "its root factors Y."
    )
    page.image("The pair of 17 and 103 teeth", run.sketch(*gear_pair(mesh.pair)))
