"""A user's gearbox rated by ISO 6336 as that of the NREL 5 MW turbine is, at its rated torque."""

from math import isinf

from fe_drivetrain.cases.gear.own_meshes import TORSIONAL, OwnMeshes, OwnRating, own_ratings
from fe_drivetrain.cases.references.rated_gears import HOURS, rated
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import ChosenDrivetrain
from fe_drivetrain.studies import gears

HERO = "Safety of the flanks S_H of all gears at rated torque"


def own_rating(run: Run, page: Page) -> None:
    """Rate the meshes of a user's drivetrain: contact, root, dynamics, over twenty years."""
    chosen = run.drivetrain("", gears=True)
    chosen.state(page, topic="Gears rated by ISO 6336")
    own, ratings = own_ratings(chosen, page)
    with run.step("ratings"):
        found = {one.mesh.name: rated(one.rated) for one in ratings}
    flanks = flank_rows(ratings, found)
    with run.step("study of gears"):
        check_study(page, chosen, flanks)
    page.section("Safety of the flanks")
    page.add(bars(HERO, {"S_H": {str(r["flank"]): float(r["S_H"]) for r in flanks}}, "S_H"))
    page.table("Stresses and safeties at rated torque over twenty years", flanks)
    for one in ratings:
        page.section(one.mesh.name)
        page.table("Its rating in numbers", number_rows(one, found[one.mesh.name]))
    answer(page, own, flanks)


def flank_rows(
    ratings: list[OwnRating], found: dict[str, dict[str, tuple[float, ...]]]
) -> list[Record]:
    """Stress and safety of each flank."""
    rows: list[Record] = []
    for one in ratings:
        of, strength = found[one.mesh.name], one.mesh.strength
        for number, flank in enumerate(one.mesh.flanks):
            row: Record = {"flank": flank.name, "mesh": one.mesh.name}
            for key in ("sigma_H [MPa]", "S_H", "sigma_F [MPa]", "S_F"):
                row[key] = of[key][number]
            if strength is not None:
                row |= {"S_H asked": strength.contact_safety, "S_F asked": strength.root_safety}
            rows.append(row)
    return rows


def number_rows(one: OwnRating, found: dict[str, tuple[float, ...]]) -> list[Record]:
    """Every number of a rating of a mesh: of both gears, or of the mesh."""
    names = [f"{abs(gear.teeth)} teeth" for gear in (one.mesh.pair.first, one.mesh.pair.second)]
    return [
        {"quantity": quantity + (f", {name}" if len(values) == 2 else ""), "value": value}
        for quantity, values in found.items()
        for name, value in zip(names, values, strict=False)
        if not isinf(value)
    ]


def check_study(page: Page, chosen: ChosenDrivetrain, flanks: list[Record]) -> None:
    """The study of gears, which rates each place of the face, has the same safeties."""
    study = gears(chosen.drivetrain, options=TORSIONAL).gears
    for row in flanks:
        of = study[str(row["flank"])]
        for key, value in (("S_H", of.contact_safety), ("S_F", of.root_safety)):
            if value is not None:
                page.equals(
                    f"{row['flank']}: {key}",
                    float(row[key]),
                    value,
                    within=1e-9,
                    why="the same factors in another order: rounding",
                    source="study of gears at its torsional level",
                    basis="self-consistency",
                )


def answer(page: Page, own: OwnMeshes, flanks: list[Record]) -> None:
    """State which gear has least to spare, and whether all have what is asked for."""

    def spare(row: Record, key: str) -> float:
        return float(row[key]) / float(row[f"{key} asked"])

    flank, root = (min(flanks, key=lambda row: spare(row, key)) for key in ("S_H", "S_F"))
    least = min(spare(flank, "S_H"), spare(root, "S_F"))
    of_flank = spare(flank, "S_H") <= spare(root, "S_F")
    worst, key, what = (flank, "S_H", "flank") if of_flank else (root, "S_F", "root")
    has = f"{what} safety {float(worst[key]):.3g} where {float(worst[f'{key} asked']):g} is asked"
    page.answer(
        "Are the gears safe by ISO 6336 at rated torque over twenty years?",
        f"All gears are safe: the {worst['flank']} has least to spare, with a {has}."
        if least >= 1.0
        else f"Not all gears are safe: the {worst['flank']} has a {has}.",
        [
            page.value(
                f"safety of flanks, {flank['flank']}",
                float(flank["S_H"]),
                at_least=float(flank["S_H asked"]),
            ),
            page.value(
                f"safety of roots, {root['flank']}",
                float(root["S_F"]),
                at_least=float(root["S_F asked"]),
            ),
            page.value(f"contact stress, {flank['flank']} [MPa]", float(flank["sigma_H [MPa]"])),
            page.value(f"root stress, {root['flank']} [MPa]", float(root["sigma_F [MPa]"])),
            page.value("rated torque of the rotor [kN m]", own.train.torque / 1e3),
        ],
        HERO,
        [
            "K_gamma and K_Hbeta are those of the file, or by number of planets and accuracy "
            "grade: how the drivetrain itself spreads its load, the command gears tells.",
        ],
    )
    page.assume("hours at rated torque", HOURS, "h", "of the case: twenty years")
    page.say(f"Rated at {value_text(own.train.torque / 1e3, 'kN m')} of the rotor.")
