"""Contact stresses of a 2 MW and a 5 MW gearbox and their depths, beside ratios of the thesis."""

from math import sqrt

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.dynamics import (
    Level,
    Machine,
    library_machine,
    machine_of,
    machine_pairs,
    machine_system,
    pitch_contacts,
    static,
    steady_load,
)
from fe_drivetrain.gear import reduced_modulus, tooth_contact
from fe_drivetrain.report import Chart, bars
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

TORQUES = {"synthetic_2mw": 1.055e6, "nrel_5mw": 3.946e6}  # N m, rated, of the rotor
STEEL = reduced_modulus()
PRINTED = {"ring-planet": 2.32, "sun-planet": 1.32, "stage 2": 1.22}
"""High-speed stage over others, Al-Hamadani 2018, section 7.4."""
NEAR = 0.05  # of a printed ratio
PRESSURES = "Contact pressure of each mesh at rated torque"
DERIVED = {"ring-planet": 332, "sun-planet": 743, "stage 2": 794, "stage 3": 985}
"""Of the 2 MW gearbox, MPa, computed independently of this program from the same teeth."""


@case(
    "Contact stresses of gears and their depths: 2 MW and 5 MW gearboxes at rated torque",
    source="Al-Hamadani 2018, sections 5.3, 7.4 and 7.5; Hertz",
    settings={"drivetrain": "FILE, or a name of the library (otherwise synthetic_2mw, nrel_5mw)"},
)
def run(run: Run, page: Page) -> None:
    """Forces of meshes by statics in three dimensions, cylinders at the pitch point, ratios."""
    if SETTING in run.settings:
        own(run, page)
        return
    rows: list[Record] = []
    for name, torque in TORQUES.items():
        with run.step(name):
            rows += rows_of(name, library_machine(name), torque)
    two = {str(row["mesh"]): row for row in rows if row["machine"] == "synthetic_2mw"}
    pressures = {key: float(str(two[mesh_of(key)]["pressure [MPa]"])) for key in DERIVED}
    check(page, rows, pressures)
    page.section("Meshes")
    page.add(pressure_chart(rows, {"synthetic_2mw": "2 MW", "nrel_5mw": "5 MW"}))
    page.table("Contact at the pitch point, one pair of teeth, the whole face", rows)
    page.data("contacts", rows)
    page.table("Printed, ours, verdict", verdicts(pressures, two))
    page.text(
        f"The thesis's 2.32 and 1.32 make sun over ring {2.32 / 1.32:.3f}. For its teeth, 29, 58 "
        "and 145, with equal forces and faces, Hertz leaves exactly the root of 5, "
        f"{np.sqrt(5.0):.3f}: the two printed ratios contradict each other, and no module meets "
        "both with one face width."
    )
    page.text(
        "Its Eq 5.13, half the sum of curvatures, is 1 over a length where the half width of Eq "
        "5.14 needs the radius 1 / (1/R1 + 1/R2). Taken as a radius it has no unit that fits."
    )
    answer(page, pressures)
    for text in library_machine("synthetic_2mw").assumed:
        page.assume(text.partition(":")[0][:60], "", "", text)


def own(run: Run, page: Page) -> None:
    """Contacts of a user's drivetrain at the torque of its rated power."""
    chosen = run.drivetrain("", gears=True)
    chosen.state(page, topic="Contact stresses of gears and their depths at rated torque")
    machine = machine_of(chosen.drivetrain)
    with run.step("contacts"):
        rows = rows_of(chosen.name, machine, chosen.rated_torque())
    check_radii(page, chosen.title, rows, machine)
    page.section("Meshes")
    page.add(pressure_chart(rows, {chosen.name: chosen.title}))
    page.table("Contact at the pitch point, one pair of teeth, the whole face", rows)
    page.data("contacts", rows)
    highest = max(rows, key=lambda row: float(str(row["pressure [MPa]"])))
    depth = float(str(highest["depth of it [mm]"]))
    page.answer(
        "How high are the contact stresses of the gears at rated torque?",
        f"{highest['mesh']} has the highest contact pressure, "
        f"{value_text(float(str(highest['pressure [MPa]'])), 'MPa')}; its largest shear stress is "
        f"{depth:.2g}\u00a0mm deep.",
        [
            *(
                page.value(f"pressure, {row['mesh']} [MPa]", float(str(row["pressure [MPa]"])))
                for row in sorted(rows, key=lambda row: -float(str(row["pressure [MPa]"])))[:4]
            ),
            page.value("depth of the largest shear stress [mm]", depth),
        ],
        PRESSURES,
        ["One pair of teeth carries the whole force, along the whole face: no load factors."],
    )
    for text in machine.assumed:
        page.assume(text.partition(":")[0][:60], "", "", text)
    page.assume_all(machine.assumptions())


def answer(page: Page, pressures: dict[str, float]) -> None:
    """State pressures [MPa] of the 2 MW gearbox, and how they stand to the thesis's ratios."""
    high = pressures["stage 3"]
    ours = {key: high / pressures[key] for key in PRINTED}
    astray = [key for key, one in ours.items() if abs(one / PRINTED[key] - 1) > NEAR]
    names = {"ring-planet": "the ring-planet mesh's", "sun-planet": "the sun-planet mesh's"}
    names["stage 2"] = "the intermediate stage's"
    worst = max(ours, key=lambda key: abs(ours[key] / PRINTED[key] - 1))
    ends = f"the thesis's {PRINTED[worst]:g} {'does not hold' if astray else 'holds'}"
    page.answer(
        "How high are the contact stresses of the gears at rated torque?",
        "The high-speed stage of the 2\u00a0MW gearbox has a contact pressure of "
        f"{value_text(high, 'MPa')}, {ours[worst]:.2f} times {names[worst]}: {ends}.",
        [
            page.judged(
                f"2 MW, {mesh_of('stage 3')}: pressure", "pressure, high-speed stage", "by hand"
            ),
            page.judged(
                f"2 MW, {mesh_of('ring-planet')}: pressure", "pressure, ring and planet", "by hand"
            ),
            *(
                page.value(
                    f"pressure of the high-speed stage over {names[key]}",
                    one,
                    beside=PRINTED[key],
                    by="thesis",
                )
                for key, one in ours.items()
            ),
            page.judged(
                "2 MW, sun over ring: pressures of equal forces and faces",
                "pressure of the sun-planet mesh over the ring-planet mesh's",
                "Hertz: root of 5",
            ),
        ],
        PRESSURES,
        ["Modules and face widths of the 2 MW gearbox are not printed: they are assumed."],
        claim="holds in part" if astray else "holds",
    )


def pressure_chart(rows: list[Record], machines: dict[str, str]) -> Chart:
    """Pressure of each mesh of gearboxes, by their titles."""
    groups = {
        title: {
            str(row["mesh"]): float(str(row["pressure [MPa]"]))
            for row in rows
            if row["machine"] == name
        }
        for name, title in machines.items()
    }
    return bars(PRESSURES, groups, "contact pressure [MPa]")


def check(page: Page, rows: list[Record], pressures: dict[str, float]) -> None:
    """Check pressures against Hertz's formula, and radii against the gears' own pairs."""
    page.about(read_drivetrain("synthetic_2mw"), "synthetic_2mw")
    for key, expected in DERIVED.items():
        page.equals(
            f"2 MW, {mesh_of(key)}: pressure [MPa]",
            pressures[key],
            expected,
            within=0.5 / expected + 2e-3,
            why="three digits, and a torque of four",
            source="Hertz's formula by hand, one pair of teeth, the whole face",
        )
    page.equals(
        "2 MW, sun over ring: pressures of equal forces and faces",
        pressures["sun-planet"] / pressures["ring-planet"],
        sqrt((1 / 29 + 1 / 58) / (1 / 58 - 1 / 145)),
        within=1e-9,
        why="round-off of the forces",
        source="Hertz: root of 5 for 29, 58 and 145 teeth",
    )
    page.about(read_drivetrain("nrel_5mw"), "nrel_5mw")
    five = [row for row in rows if str(row["machine"]) == "nrel_5mw"]
    check_radii(page, "5 MW", five, library_machine("nrel_5mw"))


def check_radii(page: Page, title: str, rows: list[Record], machine: Machine) -> None:
    """Check radii of cylinders against those of the gears' own pairs."""
    pairs = machine_pairs(machine)
    for row in rows:
        pair = pairs[str(row["mesh"]).removesuffix(" 1")]
        page.equals(
            f"{title}, {row['mesh']}: radius against that of the gears' own pair [mm]",
            float(str(row["radius [mm]"])),
            1e3 * tooth_contact(pair, pair.path.pitch, 1.0, STEEL).radius,
            within=1e-9,
            why="round-off: two ways to the same cylinders",
            source="Pair.curvatures at the pitch point",
        )


def mesh_of(key: str) -> str:
    """Name of a mesh."""
    return f"stage 1 {key} 1" if "planet" in key else f"{key} mesh"


def rows_of(name: str, machine: Machine, torque: float) -> list[Record]:
    """All meshes of a machine, the first planet's of planetary stages."""
    system = machine_system(machine, Level.TORSIONAL, held_generator=True)
    found = static(system, steady_load(machine, system, torque, np.zeros(6)))
    rows: list[Record] = []
    for pair, pitch in pitch_contacts(machine).items():
        mesh = pair if pair.endswith("mesh") else f"{pair} 1"
        force = abs(found.force(mesh))
        contact = pitch.under(force)
        rows.append(
            {
                "machine": name,
                "mesh": mesh,
                "force [kN]": force / 1e3,
                "radius [mm]": 1e3 * pitch.radius,
                "half width [mm]": 1e3 * contact.half_width,
                "pressure [MPa]": contact.pressure / 1e6,
                "largest shear stress [MPa]": contact.max_shear[0] / 1e6,
                "depth of it [mm]": 1e3 * contact.max_shear[1],
            }
        )
    return rows


def verdicts(pressures: dict[str, float], two: dict[str, Record]) -> list[Record]:
    """Printed figures beside ours."""
    high = pressures["stage 3"]
    rows: list[Record] = []
    for key, printed in PRINTED.items():
        ours = high / pressures[key]
        rows.append(
            {
                "figure": f"high-speed stage over {mesh_of(key)}",
                "printed": f"{printed}",
                "ours": f"{ours:.3f}",
                "difference [%]": 100 * (ours / printed - 1),
                "verdict": "contradicts the sun's"
                if key == "ring-planet"
                else f"{100 * abs(ours / printed - 1):.1f} % apart",
                "reason": "equal forces on both meshes of a planet"
                if key == "ring-planet"
                else "modules and faces were chosen, not read",
            }
        )
    depths = {key: float(str(two[mesh_of(key)]["depth of it [mm]"])) for key in pressures}
    rows.append(
        {
            "figure": "depth of the largest shear stress [mm]",
            "printed": "about 1, high-speed stage 0.4",
            "ours": f"{max(depths.values()):.2f} to {min(depths.values()):.2f}",
            "difference [%]": None,
            "verdict": "agrees for the least"
            if min(depths, key=lambda key: depths[key]) == "stage 3"
            and round(depths["stage 3"], 1) == 0.4
            else "differs",
            "reason": "0.786 of the half width; ring, sun, stages 2 and 3: "
            + ", ".join(f"{d:.2f}" for d in depths.values()),
        }
    )
    return rows
