"""Exudyn on drivetrains of scenes: flexible, with modes, and of rigid bodies and springs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Fixed-interface modes of the flexible body, and of the convergence study.
MODES = 12
STUDY, QUICK_STUDY = (0, 4, 8, 16, 32), (0, 8)

#: Allowed relative difference of the floating frame's frequencies.
FLOATING = 1e-5

#: Natural frequencies of the free shaft in the study.
FREE = 6


def run(run: Run) -> Any:
    """Build multibody systems, let Exudyn solve them, compare."""
    from itertools import pairwise

    import numpy as np

    from fe_drivetrain.cases.export import (
        rotor_scenes,
    )
    from fe_drivetrain.export import (
        craig_bampton_shaft,
        free_frequencies,
        lumped_superelement,
        natural_frequencies,
    )
    from fe_drivetrain.export.programs import exudyn_system
    from fe_drivetrain.fidelity import scene_supports, shaft_level
    from fe_drivetrain.report import Section, Table, Text, judge

    version = exudyn_system.exudyn_version()
    verdicts: list[Any] = []
    rows: list[list[Any]] = []
    figures: dict[str, Any] = {}
    worst = {"reactions": 0.0, "frequencies": 0.0}
    for name in rotor_scenes.QUICK_SCENES if run.quick else rotor_scenes.SCENES:
        with run.step(f"bearing units of {name}"):
            scene, units = rotor_scenes.scene_and_units(name)
        supports = scene_supports(scene, units)
        with run.step(f"shaft of {name}"):
            modal = craig_bampton_shaft(scene, MODES, order=rotor_scenes.ORDER)
            guyan = modal.with_modes(0)
            points = modal.superelement
            lumped = lumped_superelement(scene)
            levels = {
                1: shaft_level(scene, 1, units),
                2: shaft_level(scene, 2, units, modal.condensed),
            }
        shafts: list[tuple[str, int, Any, Any]] = [
            ("flexible, Guyan", 2, guyan, exudyn_system.flexible_system),
            (f"flexible, {MODES} modes", 2, modal, exudyn_system.flexible_system),
            ("floating frame", 2, points, exudyn_system.floating_system),
            ("rigid bodies", 1, lumped, exudyn_system.rigid_bodies_system),
        ]
        for label, level, body, build in shafts:
            with run.step(f"Exudyn on {name}"):
                system = build(body, supports)
                found = system.reaction_matrix("hub")
                frequencies = system.frequencies()
            expected = natural_frequencies(body.points, body.stiffness, body.mass, supports)
            matrices = levels[level].reaction_matrices
            # a unit load of each kind puts a force of 1 or so on a support, moments by the arm
            off = max(
                float(np.abs(found[at] - matrices[at][:, :6]).max() / np.abs(matrices[at]).max())
                for at in supports
            )
            apart = float(np.abs(frequencies / expected - 1).max())
            worst["reactions"] = max(worst["reactions"], off)
            worst["frequencies"] = max(worst["frequencies"], apart)
            verdicts += [
                judge(
                    f"{name}, {label}: reactions of all supports to six unit loads at the hub, "
                    "largest difference over the largest of the support",
                    off,
                    0.0,
                    tolerance=1e-6,
                    relative=False,
                    source=f"level {level} of this project, with the same matrices",
                    reason="Newton's method leaves 1e-8 of the load; what the shaft turns under it "
                    "goes with its square, for it is applied both ways",
                    measure="reaction",
                ),
                judge(
                    f"{name}, {label}: all {len(expected)} natural frequencies, largest relative "
                    "difference",
                    apart,
                    0.0,
                    tolerance=FLOATING if body is points else 1e-8,
                    relative=False,
                    source="eigenvalues of the condensed matrices with the supports",
                    reason="Exudyn takes the stiffness of a floating frame by differences: of "
                    "steps of 1e-8 m, springs ten thousand times stiffer than others lose 1e-16 m"
                    if body is points
                    else "the same small dense matrices, put together by Exudyn: half of the "
                    "digits of a square root at least",
                    measure="identity",
                ),
            ]
            rows.append([name, label, *(float(f) for f in frequencies[:4])])
            figures[f"{name}, {label}"] = frequencies[:6].tolist()

    with run.step("modes of Craig and Bampton"):
        # the last scene's shaft, free, its ends kept
        whole = free_frequencies(scene, FREE, order=rotor_scenes.ORDER)[:FREE]
        study: list[list[Any]] = []
        series = []
        counts = QUICK_STUDY if run.quick else STUDY
        most = craig_bampton_shaft(scene, counts[-1], ("hub", "gearbox"), order=rotor_scenes.ORDER)
        for modes in counts:
            body = most.with_modes(modes)
            f = natural_frequencies(body.points, body.stiffness, body.mass)[6 : 6 + FREE]
            series.append(f)
            found_at = [float(100 * (a / b - 1)) for a, b in zip(f, whole, strict=True)]
            study.append([len(body.omega), *found_at])
    below = sum(int((f < whole * (1 - 1e-7)).sum()) for f in series)
    rising = sum(int((b > a * (1 + 1e-9)).sum()) for a, b in pairwise(series))
    for what, count, reason in (
        ("below the whole meridian's", below, "Rayleigh and Ritz: a reduction is too stiff"),
        ("that rise with more modes", rising, "the fewer modes are among the more"),
    ):
        verdicts.append(
            judge(
                f"Craig-Bampton, frequencies {what}",
                float(count),
                0.0,
                tolerance=0.5,
                relative=False,
                source="Courant and Fischer",
                reason=f"a count; {reason}",
                measure="identity",
            )
        )
    figures["study"] = study
    return CASE.results(
        run,
        summary=[
            f"Exudyn {version} carries loads at the hub to the bearings as this project does, to "
            f"{worst['reactions']:.1e}, whether the shaft is a flexible body, one in a floating "
            "frame, or rigid bodies with 6x6 connectors.",
            "Its natural frequencies are those of the condensed matrices to "
            f"{worst['frequencies']:.1e}.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Natural frequencies on the scene's supports",
                items=[
                    Table(
                        caption="The lowest, by Exudyn",
                        columns=["scene", "shaft", *(f"mode {k} [Hz]" for k in range(1, 5))],
                        rows=rows,
                    )
                ],
            ),
            Section(
                title="How many modes",
                items=[
                    Table(
                        caption=f"Free shaft of {scene.title}, hub and gearbox kept: error of its "
                        "natural frequencies against the meridian that is not condensed [%]",
                        columns=["modes", *(f"{f:.1f} Hz" for f in whole)],
                        rows=study,
                    ),
                    Text(
                        text="Points move as the mean of a face, and stand still as such; the face "
                        "itself goes on to vibrate. No modes at all is Guyan's condensation."
                    ),
                ],
            ),
        ],
        figures=figures,
    )


CASE = Case(
    name="export/exudyn_drivetrain",
    title="Exudyn: multibody drivetrains from scenes",
    source="Exudyn (Gerstmayr 2023, Multibody System Dynamics 60, 553-596), run here",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
