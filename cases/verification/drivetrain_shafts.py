"""Shafts of published gear tables: the geometry that their stiffness implies."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.report import trace
from fe_drivetrain.suite import Page, Record, Run
from fe_drivetrain.validation import published_drivetrains as published
from fe_drivetrain.validation.implied_shafts import SHEAR_MODULUS, implied
from fe_drivetrain.validation.shaft_theory import solid_diameter
from fe_drivetrain.validation.twisted_tubes import twisted_tube

#: Power [W] and rated speed [rpm], Table 4.1.
RATED = {"D": (750e3, 18.6), "A": (3e6, 14.8), "B": (3e6, 16.1), "C": (2e6, 16.0)}
LENGTHS = 0.5, 1.0, 2.0

STIFFNESS, DIAMETER = "k [N m/rad]", "diameter at 1 m"
STRESS = "rated shear stress at 1 m [MPa]"


@case(
    "Shafts of published gear tables: geometry implied by their stiffness",
    source="Al-Hamadani 2018, Eq 4.4 and 4.5, Tables 4.1-4.3",
)
def run(run: Run, page: Page) -> None:
    """Implied diameters, and one shaft meshed."""
    tables = {
        "D": published.table("nrel_750kw"),
        **{letter: published.table(f"drivetrain_{letter.lower()}") for letter in "ABC"},
    }
    rows: dict[tuple[str, str], Record] = {}
    for letter, table in tables.items():
        power, rpm = RATED[letter]
        torque = power / (rpm * 2 * np.pi / 60)
        for shaft, ratio in zip(table.shafts, table.speeds, strict=True):
            diameters = {
                f"diameter at {L:g} m": solid_diameter(shaft.stiffness * L / SHEAR_MODULUS)
                for L in LENGTHS
            }
            rows[letter, shaft.name] = {
                "drivetrain": f"{letter}, {power / 1e6:g} MW",
                "shaft": shaft.name,
                STIFFNESS: shaft.stiffness,
                **diameters,
                STRESS: float(16 * torque / ratio / (np.pi * diameters[DIAMETER] ** 3) / 1e6),
            }
    low = tables["D"].shafts[0]
    uniform = implied(low.stiffness, low.damping)
    found = run.timed(
        "mesh and solve",
        twisted_tube,
        uniform.diameter,
        0.0,
        uniform.length,
        SHEAR_MODULUS,
        run.quick,
    )
    page.equals(
        f"low-speed shaft of drivetrain D as a solid of {uniform.diameter:.4f} m over "
        f"{uniform.length:.4f} m, finite elements [N m/rad]",
        found.stiffness,
        low.stiffness,
        within=found.tolerance,
        why=found.reason,
        source="Al-Hamadani 2018, Table 4.2",
        band=found.band,
    )
    of_d, of_a, of_c = (rows[letter, "LSS"] for letter in "DAC")
    page.answer(
        f"As solid steel over 1 m, the low-speed shafts are {of_d[DIAMETER]:.2f} m (D), "
        f"{of_a[DIAMETER]:.2f} m (A, B) and {of_c[DIAMETER]:.2f} m (C); the 3 MW one is "
        f"{of_a[STIFFNESS] / of_c[STIFFNESS]:.0f} times as stiff as the 2 MW one.",
        f"The damper of drivetrain D's low-speed shaft implies its J: {uniform.polar:.3e} m^4, a "
        f"solid of {uniform.diameter:.3f} m over {uniform.length:.2f} m, which finite elements "
        f"give {found.stiffness:.4g} N m/rad.",
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
    shown = {f"D {shaft.name}": shaft.stiffness for shaft in tables["D"].shafts}
    shown |= {"A, B LSS": of_a[STIFFNESS], "C LSS": of_c[STIFFNESS]}
    page.chart(
        "Diameter of the solid steel shaft of each stiffness, k = G J / L (Eq 4.4), by its length; "
        "and what drivetrain D's damper implies",
        [
            trace(label, lengths, [solid_diameter(k * L / SHEAR_MODULUS) for L in lengths])
            for label, k in shown.items()
        ]
        + [trace("D LSS by its damper", [uniform.length], [uniform.diameter], points=True)],
        "length [m]",
        "diameter [m]",
    )
    page.table(
        "Diameters [m] of solid steel shafts; stress at rated torque of those of 1 m, steel shafts "
        "being built for some 30 to 80 MPa",
        list(rows.values()),
    )
    thick = rows["D", "IS2"]
    page.text(
        "No row of the tables has J, G or L: only k is given, and the dampers of Eq 4.5, from "
        "which J follows (drivetrain/damping). Drivetrain D's second intermediate shaft is given "
        "as seven times as stiff as its low-speed shaft, though it carries a twentieth of the "
        f"torque: as a solid of 1 m it would be {thick[DIAMETER]:.2f} m thick and see "
        f"{thick[STRESS]:.1f} MPa; by its damper it is short and thick. On the rotor's side it is "
        "rigid either way, and the first two frequencies do not feel it. The low-speed shaft of A "
        f"and B would see {of_a[STRESS]:.1f} MPa: a thick, short flange rather than a shaft. The "
        "frequencies of all four are found under drivetrain/."
    )
    page.data("implied_low_speed_shaft", uniform._asdict())
