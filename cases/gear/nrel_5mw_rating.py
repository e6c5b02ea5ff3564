"""Gearbox of the NREL 5 MW turbine rated by ISO 6336, against KISSsoft reports."""

from dataclasses import replace

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear.own_rating import own_rating
from fe_drivetrain.cases.gear.printed_ratings import check_mesh
from fe_drivetrain.cases.references.rated_gears import RatedMesh, rated, rated_meshes
from fe_drivetrain.report import bars, gear_pair
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.report.suite.chosen import SETTING

SOURCE = (
    "KISSsoft 03/2017, reports of 26 February 2020 on the gearbox of Nejad, Guo, Gao and Moan 2016 "
    "(public repository gfsReboucas/Drivetrain)"
)


HERO = "Safety of the flanks S_H of all gears: ours and printed"


def answer(page: Page, prints: int, met: int, apart: list[float]) -> None:
    """State how many printed numbers come out, and the ring that decides."""
    ring, sun = (f"NREL 5 MW, stage 1, {m}" for m in ("planet and ring", "sun and planet"))
    largest = value_text(max(apart), "%") if apart else ""
    flanks = page.judged(f"{ring}: S_H, 56 teeth", "safety of the ring's flanks", "KISSsoft")
    unsafe = f"Flanks of the ring are not safe: S_H is {value_text(flanks.value)}, below 1."
    page.answer(
        "Does a rating by ISO 6336 give the numbers in the reports of the NREL 5 MW gearbox?",
        f"{met} of {prints} printed numbers are met within rounding; the other {prints - met} do "
        f"not hold: they contradict the reports' own equations by up to {largest}."
        if apart
        else f"{met} of {prints} printed numbers are met within rounding.",
        [
            page.value("printed numbers met", met, beside=prints, by="printed"),
            page.value("largest difference of the other numbers [%]", max(apart, default=0.0)),
            flanks,
            page.judged(
                f"{ring}: life of the flanks at S_H = 1.25, 56 teeth",
                "life of the ring's flanks at a safety of 1.25",
                "KISSsoft",
            ),
            page.judged(f"{sun}: sigma_H, 17 teeth", "contact stress, sun and planet", "KISSsoft"),
            page.judged(f"{sun}: S_F, 17 teeth", "root safety of the planet", "KISSsoft", "2.48"),
        ],
        hero=HERO,
        cautions=[
            *([unsafe] if flanks.value < 1.0 else []),
            "K_A, K_gamma and K_Hbeta are inputs of the reports, not computed; stiffness and "
            "deviations are taken as printed.",
        ],
        claim="holds in part" if apart else "holds",
    )


def safeties(page: Page, meshes: list[RatedMesh]) -> None:
    """Show the safety of every flank beside the printed one."""
    groups: dict[str, dict[str, float]] = {"ours": {}, "printed": {}}
    for mesh in meshes:
        gears = (mesh.pair.first, mesh.pair.second)
        for number, printed in enumerate(mesh.printed["S_H"]):
            label = f"{mesh.name.partition(', ')[2]}: {abs(gears[number].teeth)} teeth"
            groups["ours"][label] = float(rated(mesh)["S_H"][number])
            groups["printed"][label] = float(printed)
    page.add(bars(HERO, groups, "S_H"))


@case(
    "Gearbox of the NREL 5 MW turbine rated by ISO 6336",
    source="KISSsoft 03/2017 reports in gfsReboucas/Drivetrain; Nejad, Guo, Gao and Moan 2016, "
    "doi 10.1002/we.1884",
    settings={"drivetrain": "FILE, or a name of the library (otherwise the gears as printed)"},
)
def run(run: Run, page: Page) -> None:
    """Rate the five meshes of three stages: contact, root, dynamics, life."""
    if SETTING in run.settings:
        own_rating(run, page)
        return
    meshes = [m for name, m in rated_meshes().items() if name.startswith("NREL")]
    with run.step("ratings"):
        counts = [check_mesh(page, mesh, SOURCE) for mesh in meshes]
    prints, met = (sum(column) for column in zip(*counts, strict=True))
    unmet = sum(len(p) for m in meshes for p in m.unmet.values())
    page.equals(
        "printed numbers that are met",
        float(met),
        float(prints - unmet),
        within=0.5,
        relative=False,
        why="each that is not counts; those that the reports' own equations contradict are shown "
        "under their stage, with the reason",
        source=SOURCE,
        measure="identity",
    )
    apart = [
        100.0 * abs(rated(mesh)[quantity][number] / float(one) - 1.0)
        for mesh in meshes
        for quantity, values in mesh.unmet.items()
        for number, one in enumerate(values)
    ]
    answer(page, prints, met, apart)
    page.section("Safety of the flanks")
    safeties(page, meshes)
    page.section("What is given, and what is computed")
    page.text(
        "Geometry, materials, oil, roughness and speeds are those of the reports. Stiffness (c', "
        "c_gamma) and deviations of grade 6 are taken as printed. K_A, K_gamma and K_Hbeta were "
        "typed in by their user, also K_v of planet and ring of stage 1; K_v of the other meshes, "
        "K_Halpha and K_Fbeta are computed by method B. Both meshes of stage 2 are rated with the "
        "larger of two K_v. Profile shifts are those that fit the centre distance, since the "
        "reports print four digits. The report of stage 1 prints K_v 1.01 of sun and planet as "
        "typed in, and rates with 1.0054, which is that of method B."
    )
    last = meshes[-1]
    by_pitch = replace(last, deviations=(last.deviations[0], last.deviations[0]))
    (taken,), (alone,) = (rated(mesh)["K_Halpha"] for mesh in (last, by_pitch))
    page.text(
        "K_Halpha takes the larger of base pitch and profile form deviation, less the running in "
        f"of the pitch: in {last.name.partition(', ')[2]} it is {taken:.3f}, with the pitch "
        f"deviation alone {alone:.3f}. From grade 6 on tip relief does not lower K_v (B_k = 1)."
    )
    page.image("Sun and planet of stage 1", run.sketch(*gear_pair(meshes[0].pair)))
