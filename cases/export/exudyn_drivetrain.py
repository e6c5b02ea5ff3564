"""Exudyn on drivetrains of scenes: flexible, with modes, and of rigid bodies and springs."""

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.export.rotor_scenes import ORDER, QUICK_SCENES, SCENES, scene_and_units
from fe_drivetrain.cases.export.samples import show
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.export import (
    CraigBampton,
    Superelement,
    craig_bampton_shaft,
    free_frequencies,
    lumped_superelement,
    natural_frequencies,
)
from fe_drivetrain.export.programs import exudyn_system
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column
from fe_drivetrain.shafts.fidelity import scene_supports, shaft_level

#: Fixed-interface modes of the flexible body, and of the convergence study.
MODES = 12
STUDY, QUICK_STUDY = (0, 4, 8, 16, 32), (0, 8)

#: Allowed relative differences: of reactions, of natural frequencies, and of those of the shaft in
#: a floating frame.
REACTIONS, DENSE, FLOATING = 1e-6, 1e-8, 1e-5
IN_FRAME = "floating frame"
DIFFERENCES = "Largest differences of Exudyn from this project, by the form of the shaft"

#: Natural frequencies of the free shaft in the study.
FREE = 6

_Body = CraigBampton | Superelement


def answer(page: Page, version: str, rows: list[Record]) -> None:
    """State how far Exudyn's reactions and natural frequencies are from this project's."""
    reactions, frequencies = (max(column(rows, key)) for key in ("reactions", "frequencies"))
    framed, others = (
        max(row["frequencies"] for row in rows if (row["shaft"] == IN_FRAME) is is_framed)
        for is_framed in (True, False)
    )
    project = "this project"
    page.answer(
        "Does Exudyn find the reactions and natural frequencies of a drivetrain from a scene?",
        f"Exudyn {version}'s reactions differ from this project's by at most "
        f"{formatted(reactions, 2, '')} and its natural frequencies by "
        f"{formatted(frequencies, 2, '')}, whatever form the shaft has.",
        [
            page.value("largest difference of reactions", reactions, at_most=REACTIONS, by=project),
            page.value(
                "largest difference of natural frequencies, floating frame",
                framed,
                at_most=FLOATING,
                by=project,
            ),
            page.value(
                "largest difference of natural frequencies, other forms",
                others,
                at_most=DENSE,
                by=project,
            ),
            page.value(
                f"lowest natural frequency, scene {rows[0]['scene'].replace('_', ' ')} [Hz]",
                rows[0]["mode 1 [Hz]"],
            ),
            page.value("scenes and forms compared", len(rows)),
        ],
        hero=DIFFERENCES,
    )


@case(
    "Exudyn: multibody drivetrains from scenes",
    source="Exudyn (Gerstmayr 2023, Multibody System Dynamics 60, 553-596), run here",
)
def run(run: Run, page: Page) -> None:
    """Build multibody systems, let Exudyn solve them, compare."""
    version = exudyn_system.exudyn_version()
    rows: list[Record] = []
    for name in QUICK_SCENES if run.quick else SCENES:
        with run.step(f"bearing units of {name}"):
            scene, units = scene_and_units(name)
        rows += scene_rows(run, name, scene, units)
    for row in rows:
        label = f"{row['scene']}, {row['shaft']}"
        floating = row["shaft"] == IN_FRAME
        page.at_most(
            f"{label}: reactions of all supports to six unit loads at the hub, largest difference "
            "over the largest of the support",
            row["reactions"],
            REACTIONS,
            why="Newton's method leaves 1e-8 of the load; what the shaft turns under it goes with "
            "its square, for it is applied both ways",
            source=f"level {row['level']} of this project, with the same matrices",
            measure="reaction",
        )
        page.vanishes(
            f"{label}: all {row['count']} natural frequencies, largest relative difference",
            row["frequencies"],
            within=FLOATING if floating else DENSE,
            why="Exudyn takes the stiffness of a floating frame by differences: of steps of 1e-8 "
            "m, springs ten thousand times stiffer than others lose 1e-16 m"
            if floating
            else "the same small dense matrices, put together by Exudyn: half of the digits of a "
            "square root at least",
            source="eigenvalues of the condensed matrices with the supports",
        )
        page.data(label, row["lowest"])
    answer(page, version, rows)
    page.say(
        "The shaft is a flexible body, one in a floating frame, or rigid bodies with 6x6 "
        "connectors; natural frequencies are compared with those of the condensed matrices."
    )
    show(run, page, scene)
    labels = [f"{row['scene']}, {row['shaft']}" for row in rows]
    differences = {
        name: dict(zip(labels, column(rows, name), strict=True))
        for name in ("reactions", "frequencies")
    }
    page.add(bars(DIFFERENCES, differences, "largest relative difference [-]", least=1e-17))
    page.section("Natural frequencies on the scene's supports")
    modes = [f"mode {k} [Hz]" for k in range(1, 5)]
    page.table("The lowest, by Exudyn", rows, ["scene", "shaft", *modes])
    modes_study(run, page, scene)


def scene_rows(run: Run, name: str, scene: Scene, units: dict[str, Floats]) -> list[Record]:
    """One scene with its shaft in four forms: largest errors, and the lowest frequencies."""
    supports = scene_supports(scene, units)
    with run.step(f"shaft of {name}"):
        modal = craig_bampton_shaft(scene, MODES, order=ORDER)
        guyan = modal.with_modes(0)
        points = modal.superelement
        lumped = lumped_superelement(scene)
        levels = {
            1: shaft_level(scene, 1, units),
            2: shaft_level(scene, 2, units, modal.condensed),
        }
    flexible = exudyn_system.flexible_system
    floating, chain = exudyn_system.floating_system, exudyn_system.rigid_bodies_system
    forms: list[tuple[str, int, _Body, Callable[[], exudyn_system.System]]] = [
        ("flexible, Guyan", 2, guyan, partial(flexible, guyan, supports)),
        (f"flexible, {MODES} modes", 2, modal, partial(flexible, modal, supports)),
        (IN_FRAME, 2, points, partial(floating, points, supports)),
        ("rigid bodies", 1, lumped, partial(chain, lumped, supports)),
    ]
    rows = []
    for label, level, body, build in forms:
        with run.step(f"Exudyn on {name}"):
            system = build()
            found = system.reaction_matrix("hub")
            frequencies = system.frequencies()
        assert body.mass is not None
        expected = natural_frequencies(body.points, body.stiffness, body.mass, supports)
        exact = levels[level].reaction_matrices
        rows.append(
            {
                "scene": name,
                "shaft": label,
                "level": level,
                "count": len(expected),
                # a unit load of each kind puts a force of 1 or so on a support, moments by the arm
                "reactions": max(
                    float(np.abs(found[at] - exact[at][:, :6]).max() / np.abs(exact[at]).max())
                    for at in supports
                ),
                "frequencies": float(np.abs(frequencies / expected - 1).max()),
                "lowest": frequencies[:6],
                **{f"mode {k + 1} [Hz]": frequencies[k] for k in range(4)},
            }
        )
    return rows


def modes_study(run: Run, page: Page, scene: Scene) -> None:
    """How many modes the free shaft of a scene needs, its ends kept."""
    counts = QUICK_STUDY if run.quick else STUDY
    with run.step("modes of Craig and Bampton"):
        whole = free_frequencies(scene, FREE, order=ORDER)[:FREE]
        most = craig_bampton_shaft(scene, counts[-1], ("hub", "gearbox"), order=ORDER)
        bodies = [most.with_modes(count) for count in counts]
        series = [
            natural_frequencies(body.points, body.stiffness, body.mass)[6 : 6 + FREE]
            for body in bodies
        ]
    study = [
        [len(body.omega), *(100 * (f / whole - 1)).tolist()]
        for body, f in zip(bodies, series, strict=True)
    ]
    below = sum(int((f < whole * (1 - 1e-7)).sum()) for f in series)
    rising = sum(int((b > a * (1 + 1e-9)).sum()) for a, b in pairwise(series))
    page.equals(
        "Craig-Bampton, frequencies below the whole meridian's",
        below,
        0,
        within=0.0,
        relative=False,
        why="Rayleigh and Ritz: a reduction is too stiff",
        source="Courant and Fischer",
        measure="identity",
    )
    page.equals(
        "Craig-Bampton, frequencies that rise with more modes",
        rising,
        0,
        within=0.0,
        relative=False,
        why="the fewer modes are among the more",
        source="Courant and Fischer",
        measure="identity",
    )
    page.section("How many modes")
    page.table(
        f"Free shaft of {scene.title}, hub and gearbox kept: error of its natural frequencies "
        "against the meridian that is not condensed [%]",
        study,
        ["modes", *(f"{f:.1f} Hz" for f in whole)],
    )
    page.text(
        "Points move as the mean of a face, and stand still as such; the face itself goes on to "
        "vibrate. No modes at all is Guyan's condensation."
    )
    page.data("study", study)
