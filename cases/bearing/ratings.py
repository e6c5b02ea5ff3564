"""Every bearing of the catalogue: what is assumed, and whether its insides fit its load ratings."""

from fe_drivetrain.bearing import read_bearing_catalogue
from fe_drivetrain.bearing_life.life import rated_bearing
from fe_drivetrain.cases import case
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run

#: Assumed rollers were sized to fit the printed ratings to this.
FITS = 0.03

NAMES = (("C", "dynamic"), ("C0", "static"), ("Cu", "fatigue"))


@case(
    "Bearings of the catalogue, and their load ratings by ISO 281 and ISO 76",
    source="Stirling 2023, Table 4.1; MASTA in a public study of a 26 MW drivetrain",
)
def run(run: Run, page: Page) -> None:
    """Ratings from rollers, beside those printed; all values that are assumed."""
    rows: list[Record] = []
    with run.step("catalogue"):
        entries = read_bearing_catalogue()
    for name, entry in entries.items():
        bearing = entry.bearing(name)
        own = rated_bearing(bearing, b_m=1.15 if entry.kind == "spherical_roller" else 1.1)
        record: Record = {
            "bearing": name,
            "kind": entry.kind.replace("_", " "),
            "elements": sum(bearing.counts),
            "contact angle [deg]": entry.contact_angle or 0.0,
            "assumed": ", ".join(entry.assumed).replace("_", " "),
        }
        for key, field in NAMES:
            printed = getattr(entry.ratings, key) if entry.ratings else None
            record[f"{key}, from its insides [kN]"] = getattr(own, field) / 1e3
            record[f"{key}, printed [kN]"] = printed / 1e3 if printed else None
            if printed and name != "bearing_s":
                page.equals(
                    f"{name}: {key}",
                    getattr(own, field) / 1e3,
                    printed / 1e3,
                    within=1e-3 if name == "masta_single" else FITS,
                    why="f_c of ISO 281 from the formula behind its rounded table"
                    if name == "masta_single"
                    else "rollers of bearing S are assumed, such that they fit all three to 3 %",
                    source=entry.sources["ratings"],
                    unit="kN",
                    measure="reaction",
                )
        for field in entry.assumed:
            value = getattr(entry, field)
            unit = {"elements": "-", "contact_angle": "deg"}.get(field, "m")
            page.assume(f"{name}: {field.replace('_', ' ')}", value, unit, entry.sources[field])
        rows.append(record)
    fitted = next(
        row for row in rows if row["bearing"].startswith("bearing_s_") and row["C, printed [kN]"]
    )
    misfits = [
        abs(fitted[f"{key}, from its insides [kN]"] / fitted[f"{key}, printed [kN]"] - 1.0)
        for key, _ in NAMES
    ]
    misfit = next(row for row in rows if row["bearing"] == "bearing_s")
    answer(page, fitted, misfit, max(misfits))
    page.section("Catalogue")
    page.table("Ratings from rollers beside printed ones; empty where none is printed", rows)


def answer(page: Page, fitted: Record, misfit: Record, largest: float) -> None:
    """State how well the assumed rollers fit printed ratings, and that 38 deg do not."""
    own, printed = "C, from its insides [kN]", "C, printed [kN]"
    of, angle = fitted["bearing"], f"{fitted['contact angle [deg]']:.0f}°"
    other = f"{misfit['contact angle [deg]']:.0f}°"
    figures = [
        page.judged(f"{of}: C", f"C of bearing S, contact angle {angle}", "Table 4.1", "6710"),
        page.judged(f"{of}: C0", f"C0 of bearing S, contact angle {angle}", "Table 4.1", "16600"),
        page.judged(f"{of}: Cu", f"C_u of bearing S, contact angle {angle}", "Table 4.1", "1100"),
        page.value(
            f"C of bearing S, contact angle {other} [kN]",
            misfit[own],
            beside=misfit[printed],
            by="Table 4.1",
        ),
        page.judged("masta_single: C", "C of the tapered bearing of 26 MW", "MASTA"),
        page.judged("masta_single: Cu", "C_u of the tapered bearing of 26 MW", "MASTA"),
    ]
    fit = "fits" if largest <= FITS else "does not fit"
    hero = "Ratings from rollers: differences from printed ones, over what is allowed"
    page.answer(
        "Do the rollers that are assumed inside bearings give their printed load ratings?",
        f"With a contact angle of {angle} bearing S {fit} its ratings within "
        f"{percent_text(largest)} ({percent_text(FITS)} allowed), but stiffness needs {other}, "
        f"where C is {value_text(misfit[own], 'kN')}, not {value_text(misfit[printed], 'kN')}.",
        figures,
        hero,
        [
            f"The two angles contradict each other: {angle} gives the printed ratings, {other} "
            "roughly the thesis's tilting stiffness, rows face to face. It prints no angle.",
            f"The rollers were sized to fit the ratings at {angle}: this is no independent check.",
        ],
    )
    page.section("Differences from printed ratings")
    page.errors(hero, figures)
