"""Gears of the NREL 750 kW machine: geometry from published roots, and mesh stiffness of others."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear.own_stiffness import own_stiffness
from fe_drivetrain.cases.gear.rows import mesh_row, stiffness_row
from fe_drivetrain.cases.references import published_gears as published
from fe_drivetrain.dynamics import library_machine
from fe_drivetrain.gear import iso_gear_stiffness, parabolic_mean, rack_factor
from fe_drivetrain.report import bars, gear_pair
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run, Target
from fe_drivetrain.report.suite.chosen import SETTING

#: Diameters of root circles as published, whole millimetres; by teeth.
ROOTS = {21: 186, 39: 372, -99: 1047, 23: 174, 82: 678, 22: 100, 88: 440}
PUBLISHED = "drawings of the NREL Gearbox Reliability Collaborative"
#: What shifts that follow from root circles may miss of that of the centre distance.
SHIFTS = Target(
    "shifts from root circles against that of the centre distance [modules]",
    0.0,
    2e-3,
    "root circles are known to half a millimetre, shifts to 1e-3",
    PUBLISHED,
    basis="self-consistency",
)


HERO = "Mesh stiffness that others took, over that of ISO 6336-1"


def answer(
    page: Page, stiffness: dict[str, float], meshes: list[Record], others: list[Record]
) -> None:
    """State the mesh stiffness of the planetary stage beside what others took for it."""
    over_iso = [float(row["over ISO 6336-1"]) for row in others if not row["remark"]]
    guo = {row["mesh"]: row for row in others if row["source"] == "Guo et al. 2012"}
    along = "along the line of action [GN/m]"
    roots = max(
        abs(check.computed - check.reference) for check in page.checks if "root" in check.quantity
    )
    sun = value_text(stiffness["sun"] / 1e9, "GN/m")
    page.answer(
        "How stiff are the gear meshes of the NREL 750 kW gearbox?",
        f"The sun-planet mesh has a stiffness of {sun} by ISO 6336-1; across all meshes, other "
        f"authors took {min(over_iso):.2g} to {max(over_iso):.2g} times the standard's value.",
        [
            *(
                page.value(
                    f"mesh stiffness, {'planet and ring' if name == 'ring' else 'sun and planet'} "
                    "[GN/m]",
                    stiffness[name] / 1e9,
                    beside=float(guo[name][along]),
                    by="Guo et al. 2012",
                )
                for name in ("sun", "ring")
            ),
            page.value(
                "mesh stiffness, intermediate stage [GN/m]", stiffness["intermediate"] / 1e9
            ),
            page.value("mesh stiffness, high speed [GN/m]", stiffness["high speed"] / 1e9),
            page.value(
                "stiffness of one pair, sun and planet [N/(mm µm)]",
                float(next(r for r in meshes if r["mesh"] == "sun")["c' [N/(mm µm)]"]),
                beside=14.0,
                by="thesis",
            ),
            page.value("largest difference of a root diameter [mm]", roots, at_most=0.6),
        ],
        hero=HERO,
        cautions=[
            "Tip circles are assumed, with a clearance of 0.4 modules: drawings give root circles "
            "only.",
            "The value of Link et al. 2013 is left out of the comparison, because its unit cannot "
            "be right.",
        ],
    )
    shown = {f"{row['source']}, {row['mesh']}": float(row["over ISO 6336-1"]) for row in others}
    page.add(bars(HERO, {"over ISO 6336-1": shown}, "of ISO 6336-1 [-]", least=1e-2))


@case(
    "NREL 750 kW gearbox: shifts from root circles, and mesh stiffness beside that of others",
    source="NREL Gearbox Reliability Collaborative, NREL/TP-5000-47773; Al-Hamadani 2018, Eq 5.4, "
    "Tables 4.2 and 6.3",
    settings={"drivetrain": "FILE, or a name of the library (otherwise the NREL 750 kW)"},
)
def run(run: Run, page: Page) -> None:
    """Check root circles and shifts; show ISO 6336-1 beside 14 N/(mm µm) and Table 6.3."""
    if SETTING in run.settings:
        own_stiffness(run, page)
        return
    pairs = published.nrel_750kw()
    page.about(library_machine("nrel_750kw"))
    rows: list[Record] = []
    stiffness = {}
    for name, pair in pairs.items():
        found = run.timed(name, iso_gear_stiffness, pair)
        stiffness[name] = found.mesh * pair.face_width
        rows.append(
            {
                **mesh_row(name, pair),
                **stiffness_row(found),
                "Eq 5.2 to 5.4, SR 0.8 [N/(mm µm)]": parabolic_mean(pair, 0.8) / 1e9,
                "mesh stiffness [GN/m]": stiffness[name] / 1e9,
            }
        )
        page.meets(pair.first.shift + pair.second.shift - pair.shift_sum, SHIFTS, of=name)
        for gear in (pair.first, pair.second):
            title = f"root diameter of {abs(gear.teeth)} teeth [mm]"
            why = "published in whole millimetres"
            target = Target(title, ROOTS[gear.teeth], 0.6, why, PUBLISHED, relative=False)
            page.meets(2e3 * gear.root_radius, target, of=name)
    page.section("Meshes")
    page.table("Four meshes; tips are assumed at a clearance of 0.4 modules", rows)
    page.section("Mesh stiffness of others")
    table: list[Record] = []
    for source, value, unit, name, remark in published.OTHERS_750KW:
        pair = pairs[name]
        planet = pair.second if name == "sun" else pair.first
        factors = {"N/m": 1.0, "N/m^2": pair.face_width, "N m/rad": planet.base_radius**-2}
        per_metre = value * factors[unit]
        table.append(
            {
                "source": source,
                "mesh": name,
                "printed": value,
                "unit": unit,
                "along the line of action [GN/m]": per_metre / 1e9,
                "over ISO 6336-1": per_metre / stiffness[name],
                "remark": remark,
            }
        )
    page.table("Values of Al-Hamadani 2018, Tables 4.2 and 6.3, beside ISO 6336-1", table)
    page.text(
        "The deep teeth of this gearbox (dedendum 1.47 modules) take a rack factor C_B of "
        f"{rack_factor(pairs['sun'].first):.2g} between sun and planet, so that c' is below the "
        "14 N/(mm µm) that the thesis takes for all. Its Eq 5.4 states "
        "neither the shape factor nor the stiffness ratio: here 1 and 0.8. Dedendum and shifts "
        "are those with which all published root circles and centre distances fit."
    )
    answer(page, stiffness, rows, [row for row in table if "cannot" not in str(row["remark"])])
    page.image("Sun and planet", run.sketch(*gear_pair(pairs["sun"])))
