"""Geometry and mesh stiffness of the NREL 5 MW reference gearbox against printed reports."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear.rows import mesh_row, stiffness_row
from fe_drivetrain.cases.references.published_gears import NREL_5MW_PRINTED, nrel_5mw
from fe_drivetrain.dynamics import machine_of, machine_pairs
from fe_drivetrain.gear import (
    constant_law,
    iso_gear_stiffness,
    mesh_stiffness,
    ring_after_sun,
    sequence,
    sun_phases,
)
from fe_drivetrain.report import bars, gear_pair, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run, Target
from fe_drivetrain.report.suite.chosen import SETTING

REPORTS = "KISSsoft 03/2017 reports of the gearbox, ISO 6336:2006 method B"
DIGITS = "half a unit of the last printed digit"
BLANK = "the factor of the gear blank is printed with three digits"


@case(
    "NREL 5 MW reference gearbox: five meshes against printed geometry and stiffness",
    source="Nejad, Guo, Gao, Moan 2016, Wind Energy 19, 10.1002/we.1884; KISSsoft 03/2017 reports",
    settings={"drivetrain": "FILE, or a name of the library (otherwise the gears as printed)"},
)
def run(run: Run, page: Page) -> None:
    """Compute contact ratios, forces and ISO 6336-1 stiffness; phases of both planetary stages."""
    if SETTING in run.settings:
        own(run, page)
        return
    pairs = nrel_5mw()
    rows: list[Record] = []
    for name, pair in pairs.items():
        printed = NREL_5MW_PRINTED[name]
        found = run.timed(name, iso_gear_stiffness, pair, blank=printed.blank)
        backlash = {"backlash [µm]": 1e6 * pair.backlash}
        rows.append(mesh_row(name, pair) | backlash | stiffness_row(found))
        for quantity, value, expected in (
            ("transverse contact ratio", pair.transverse_ratio, printed.transverse_ratio),
            ("overlap ratio", pair.overlap_ratio, printed.overlap_ratio),
        ):
            if expected:
                half = 5e-4, DIGITS, REPORTS
                target = Target(quantity, expected, *half, relative=False, measure="identity")
                page.meets(value, target, of=name)
        if printed.torque is not None:
            force, why = pair.tangential_force(printed.torque), "torques are printed to 0.1 N m"
            target = Target("tangential force [kN]", printed.force / 1e3, 1.3e-6, why, REPORTS)
            page.meets(force / 1e3, target, of=name)
        for quantity, value, expected in (
            ("one pair, c'", found.single, printed.single),
            ("mesh, c_gamma_alpha", found.mesh, printed.mesh),
            ("over the face, c_gamma_beta", found.misaligned, printed.misaligned),
        ):
            key = f"{quantity} [N/(mm µm)]"
            target = Target(key, expected, 6e-4, BLANK, REPORTS, measure="stiffness")
            page.meets(value / 1e9, target, of=name)
    page.section("Meshes")
    page.table("Five meshes of the gearbox", rows)
    page.text(
        "Without the rim's thickness the factor of the gear blank is taken as printed, 0.862 and "
        "0.898. Shifts are printed with four digits, which leaves micrometres of backlash at the "
        "given centre distances. Rings have an infinite number of virtual teeth in ISO 6336-1 and "
        "their own shift; the pinion of the sun's mesh of stage 1 is the planet, which has fewer "
        "teeth."
    )
    phases(page)
    answer(page, list(pairs))
    page.image("Sun and planet of stage 1", run.sketch(*gear_pair(pairs["sun 1"])))


def own(run: Run, page: Page) -> None:
    """Geometry and stiffness of all meshes of a user's drivetrain, from its teeth."""
    chosen = run.drivetrain("", gears=True)
    chosen.state(page, topic="Geometry and stiffness of all meshes of gears")
    machine = machine_of(chosen.drivetrain)
    pairs = machine_pairs(machine)
    rows: list[Record] = []
    stiffness: dict[str, float] = {}
    for name, pair in pairs.items():
        stage = machine.stages[int(name.split()[1]) - 1]
        found = run.timed(name, iso_gear_stiffness, pair, blank=stage.blank)
        stiffness[name] = found.mesh * pair.face_width / 1e9
        backlash = {"backlash [µm]": 1e6 * pair.backlash}
        rows.append(mesh_row(name, pair) | backlash | stiffness_row(found))
        if pair.second.teeth > 0:
            page.at_least(
                f"{name}: transverse contact ratio",
                pair.transverse_ratio,
                1.0,
                why="below 1 teeth part before the next ones touch",
                source="kinematics",
            )
    page.section("Meshes")
    page.add(bars(OWN, {chosen.title: stiffness}, "mesh stiffness [GN/m]"))
    page.table("All meshes, from their teeth", rows)
    softest = min(stiffness, key=lambda name: stiffness[name])
    page.answer(
        "How stiff are the meshes of the gearbox by their teeth?",
        f"By ISO 6336-1, {softest} is the softest mesh, with "
        f"{value_text(stiffness[softest], 'GN/m')} along its line of action.",
        [
            page.value(f"mesh stiffness, {name} [GN/m]", value)
            for name, value in list(stiffness.items())[:6]
        ],
        OWN,
    )
    page.assume_all(machine.assumptions())


OWN = "Mesh stiffness by ISO 6336-1, along the line of action"
HERO = "Mesh stiffness and tangential force: difference from the printed reports"


def answer(page: Page, names: list[str]) -> None:
    """State how far geometry, force and stiffness are from what is printed."""
    apart = {check.quantity: check for check in page.checks if check.source == REPORTS}
    largest = {
        what: max(
            abs(check.computed - check.reference) / (abs(check.reference) if relative else 1.0)
            for name, check in apart.items()
            if any(word in name for word in words)
        )
        for what, words, relative in (
            ("stiffness", ("one pair", "mesh,", "over the face"), True),
            ("force", ("tangential force",), True),
            ("ratio", ("ratio",), False),
        )
    }
    mesh = [
        page.judged(
            f"{name}: mesh, c_gamma_alpha",
            f"mesh stiffness, {name}",
            "KISSsoft",
            f"{NREL_5MW_PRINTED[name].mesh:.3f}",
        )
        for name in names
    ]
    forces = [
        page.judged(f"{name}: tangential force", f"tangential force, {name}", "KISSsoft")
        for name in names
        if NREL_5MW_PRINTED[name].torque is not None
    ]
    worst = 100.0 * largest["stiffness"]
    page.answer(
        "Do geometry and mesh stiffness of the NREL 5 MW gearbox agree with the printed reports?",
        f"All {len(apart)} printed numbers of the five meshes are met: stiffness differs by "
        f"{worst:.2g}\u00a0% at most, which rounding of the printed digits explains."
        if all(check.passed for check in apart.values())
        else f"Not all of {len(apart)} printed numbers are met: stiffness differs by up to "
        f"{worst:.2g}\u00a0%.",
        [
            page.value("largest difference of a stiffness [%]", worst, at_most=0.06, by="rounding"),
            page.value(
                "largest difference of a contact ratio",
                largest["ratio"],
                at_most=5e-4,
                by="rounding",
            ),
            page.value("largest difference of a force [%]", 100.0 * largest["force"]),
            *(mesh[names.index(name)] for name in ("sun 1", "ring 1", "stage 3")),
        ],
        hero=HERO,
        cautions=[
            "The factor of the gear blank is taken as printed, with three digits: this limits how "
            "well stiffness can agree."
        ],
    )
    page.errors(HERO, [*mesh, *forces])


def phases(page: Page) -> None:
    """Show the phases of the planets' meshes, and the length of contact lines of stage 3."""
    pairs = nrel_5mw()
    page.section("Phases")
    rows: list[Record] = []
    for stage, sun, ring in ((1, 19, 56), (2, 18, 93)):
        behind = sun_phases(sun, ring, 2 * np.pi * np.arange(3) / 3)
        rows.append(
            {
                "stage": stage,
                "planets": sequence(sun, ring, 3),
                "second planet behind the first [periods]": float(behind[1]),
                "third [periods]": float(behind[2]),
                "ring behind sun [periods]": ring_after_sun(
                    pairs[f"sun {stage}"], pairs[f"ring {stage}"]
                ),
            }
        )
    page.table("Phases of meshes, from teeth and flanks", rows)
    lines = mesh_stiffness(pairs["stage 3"], constant_law(1.0), points=400)
    title, why = "stage 3: mean length of contact, in face widths", "trapezoids of a constant"
    mean = "total length of contact lines is the contact ratio times the face, on average"
    ratio = pairs["stage 3"].transverse_ratio
    exact = Target(title, ratio, 1e-6, why, mean, measure="identity")
    page.meets(lines.mean / pairs["stage 3"].face_width, exact)
    at = np.append(lines.phases, 1.0)
    total = lines.at(at) / pairs["stage 3"].face_width
    title, y = "Stage 3: width of face in contact, of all pairs", "face in contact [face widths]"
    page.chart(title, [trace("all pairs", at, total)], "phase [periods]", y)
