"""Shafts of published gear tables: the geometry that their stiffness implies."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.implied_shafts import (
    SHEAR_MODULUS,
    diameter,
    implied,
    of_stiffness,
)
from fe_drivetrain.cases.references.solid_shafts import straight
from fe_drivetrain.cases.references.twisted_tubes import twisted_tube
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, Target

LENGTHS = 0.5, 1.0, 2.0
DIAMETERS = "Diameter of the solid steel shaft of each stiffness, k = G J / L (Eq 4.4), by its "
DIAMETERS += "length; and what drivetrain D's damper implies"
STIFFNESS, DIAMETER = "k [N m/rad]", "diameter at 1 m"
STRESS = "rated shear stress at 1 m [MPa]"


def solids(letter: str) -> dict[str, Record]:
    """Solid shafts with the stiffness of each shaft of a drivetrain, and stress at rated torque."""
    return {
        name: {
            "drivetrain": f"{letter}, {published.RATED[letter][1] / 1e6:g} MW",
            "shaft": name,
            STIFFNESS: shaft.stiffness,
            **{f"diameter at {L:g} m": d for L, d in shaft.diameters.items()},
            STRESS: shaft.rated_stress / 1e6,
        }
        for name, shaft in of_stiffness(letter, LENGTHS).items()
    }


def answer(page: Page, rows: dict[str, dict[str, Record]], meshed: str) -> None:
    """State which solid shafts of 1 m the published stiffnesses are."""
    of_d, of_a, of_c = (rows[letter]["LSS"] for letter in "DAC")
    page.answer(
        "Which shaft diameters do the stiffnesses in the published gear tables imply?",
        f"Solid low-speed shafts 1\u00a0m long would have diameters of {of_d[DIAMETER]:.2f}\u00a0m "
        f"(750\u00a0kW), {of_c[DIAMETER]:.2f}\u00a0m (2\u00a0MW) and {of_a[DIAMETER]:.2f}\u00a0m "
        "(3\u00a0MW); the last is rather a flange.",
        [
            *(
                page.value(f"{name}: diameter at 1 m [m]", of[DIAMETER])
                for name, of in (("D, 750 kW", of_d), ("C, 2 MW", of_c), ("A and B, 3 MW", of_a))
            ),
            page.value("stiffness of A over that of C", of_a[STIFFNESS] / of_c[STIFFNESS]),
            page.value("A and B: shear stress at rated torque [MPa]", of_a[STRESS]),
            page.judged(meshed, "D: stiffness as a solid", "Al-Hamadani", unit="MN m/rad"),
        ],
        hero=DIAMETERS,
        cautions=["The tables give only stiffnesses: lengths and solid sections are assumed here."],
    )


@case(
    "Shafts of published gear tables: geometry implied by their stiffness",
    source="Al-Hamadani 2018, Eq 4.4 and 4.5, Tables 4.1-4.3",
)
def run(run: Run, page: Page) -> None:
    """Implied diameters, and one shaft meshed."""
    rows = {letter: solids(letter) for letter in published.RATED}
    low = published.table("nrel_750kw").shafts[0]
    uniform = implied(low.stiffness, low.damping)
    tube = uniform.diameter, 0.0, uniform.length, SHEAR_MODULUS
    found = run.timed("mesh and solve", twisted_tube, *tube, run.quick)
    title = f"low-speed shaft of drivetrain D as a solid of {uniform.diameter:.4f} m over "
    title += f"{uniform.length:.4f} m, finite elements [N m/rad]"
    printed = low.stiffness, found.tolerance, found.reason, "Al-Hamadani 2018, Table 4.2"
    page.meets(found.stiffness, Target(title, *printed), found.band)
    of_a, of_c = (rows[letter]["LSS"] for letter in "AC")
    answer(page, rows, title.removesuffix(" [N m/rad]"))
    page.say(
        f"The damper of drivetrain D's low-speed shaft implies its J, {uniform.polar:.3e} m^4: a "
        f"solid of {uniform.diameter:.3f} m over {uniform.length:.2f} m."
    )
    page.section("What the stiffnesses imply")
    show_inputs(
        page,
        ("G", SHEAR_MODULUS / 1e9, "GPa", "steel; the thesis gives none"),
        ("lengths of the table", "0.5, 1, 2", "m", "chosen: it gives none"),
        ("section", "solid circle", "", "chosen: it gives none"),
        ("power, rated speed", "Table 4.1", "", "Al-Hamadani 2018"),
        ("stiffness, ratios", "Tables 4.2, 4.3, 4.7", "", "Al-Hamadani 2018"),
    )
    lengths = np.linspace(0.2, 4.0, 60)
    shown = {f"D {name}": row[STIFFNESS] for name, row in rows["D"].items()}
    shown |= {"A, B LSS": of_a[STIFFNESS], "C LSS": of_c[STIFFNESS]}
    curves = [trace(of, lengths, [diameter(k, L) for L in lengths]) for of, k in shown.items()]
    curves.append(trace("D LSS by its damper", [uniform.length], [uniform.diameter], points=True))
    page.chart(DIAMETERS, curves, "length [m]", "diameter [m]")
    title = "Diameters [m] of solid steel shafts; stress at rated torque of those of 1 m, steel "
    title += "shafts being built for some 30 to 80 MPa"
    page.table(title, [row for of in rows.values() for row in of.values()])
    thick = rows["D"]["IS2"]
    page.text(
        "No row of the tables has J, G or L, only k and the dampers of Eq 4.5, from which J "
        "follows (drivetrain/damping). Drivetrain D's second intermediate shaft is given as seven "
        "times as stiff as its low-speed shaft, though it carries a twentieth of the torque: as a "
        f"solid of 1 m it would be {thick[DIAMETER]:.2f} m thick and see {thick[STRESS]:.1f} MPa; "
        "by its damper it is short and thick. On the rotor's side it is rigid either way, and the "
        "first two frequencies do not feel it. The low-speed shaft of A and B would see "
        f"{of_a[STRESS]:.1f} MPa: a thick, short flange rather than a shaft. The frequencies of "
        "all four are found under drivetrain/."
    )
    sketch = run.sketch(straight((0.0, uniform.length), uniform.diameter))
    page.image("The low-speed shaft of drivetrain D, as its stiffness and damper imply it", sketch)
    page.data("implied_low_speed_shaft", uniform._asdict())
