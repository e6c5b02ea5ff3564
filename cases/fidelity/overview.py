"""All scenes side by side: what the beam itself costs, and what its supports do."""

from dataclasses import asdict

from fe_drivetrain.cases import case
from fe_drivetrain.cases.fidelity.side_by_side import (
    FORCE,
    QUANTITIES,
    Compared,
    compared,
    hero,
    show,
    titled,
)
from fe_drivetrain.drivetrain_file import library_scene
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

SCENES = (
    "main_bearing_spherical",
    "main_bearing_bonded",
    "three_point_suspension",
    "two_bearings",
    "short_thick_shaft",
    "stepped_shaft",
    "nrel_750kw_low_speed_shaft",
    "nrel_750kw_high_speed_shaft",
    "nrel_5mw_main_shaft",
    "iea_15mw_main_shaft",
)
#: Coarsening of the housings: bounds of their faces are far wider than what that costs. A quick run
#: has every third scene.
COARSER, QUICK = 1.5, 2.0
#: Of the meridian of a shaft without fillets.
MERIDIAN = 1e-4
#: An error that most questions can bear.
BEARABLE = 0.05


def compared_scene(run: Run, page: Page, name: str) -> Compared:
    """A scene at levels 1 and 2; what is checked from now on is of it."""
    with run.step(name):
        scene = library_scene(name)
        mesh = scene.mesh.scaled(QUICK if run.quick else COARSER)
        scene = scene.model_copy(update={"mesh": mesh})
        page.about(scene, name)
        return compared(name, scene)


def check(page: Page, one: Compared) -> None:
    """What energy principles say of a scene."""
    page.at_most(
        f"{one.scene}: hub stiffer on softer supports, relative",
        one.stiffer_on_softer,
        1e-6,
        why="housings are solved to 1e-9, and their inverses cost three digits",
        source="a softer support makes the hub softer (Rayleigh)",
        measure="identity",
    )
    page.at_most(
        f"{one.scene}: free meridian stiffer in torsion than the beam, no fillets, relative",
        one.stiffer_than_beam,
        MERIDIAN,
        why="the error that the meridian itself may have",
        source="a beam keeps its sections plane and round (least potential energy)",
        measure="identity",
    )


def answer(page: Page, found: list[Compared]) -> None:
    """State for how many shafts the beam is enough, and for which it is not."""
    bending, torsion, _ = QUANTITIES
    enough = {
        key: [one.scene for one in found if one.changes[key].beam <= BEARABLE] for key in QUANTITIES
    }
    poor = [one.scene for one in found if one.scene not in enough[bending]]
    worst = max(found, key=lambda one: one.changes[torsion].beam)
    share = f"{100 * BEARABLE:g} %"
    worst_bending = max(found, key=lambda one: one.changes[bending].beam)
    page.answer(
        "For which shafts is a beam enough?",
        f"A beam is accurate within {100 * BEARABLE:g}\u00a0% in bending for "
        f"{len(enough[bending])} of {len(found)} shafts; its largest error is "
        f"{formatted(100 * worst_bending.changes[bending].beam, 3)}\u00a0% "
        f"({titled(worst_bending.scene)}).",
        [
            *(
                page.value(
                    f"shafts within {share} in {words}",
                    len(enough[key]),
                    beside=len(found),
                    by="all",
                )
                for key, words in (
                    (bending, "bending"),
                    (torsion, "torsion"),
                    (FORCE, "the first bearing's force"),
                )
            ),
            page.value(
                f"largest error in bending, {titled(worst_bending.scene)} [%]",
                100 * worst_bending.changes[bending].beam,
            ),
            page.value(
                f"largest error in torsion, {titled(worst.scene)} [%]",
                100 * worst.changes[torsion].beam,
            ),
            page.value("shafts whose housings matter more than beam theory", supported_more(found)),
        ],
        hero=hero(bending),
        cautions=[
            "Errors are those of beam theory alone: the supports are the same in both models, and "
            "may matter more.",
            *(
                [f"In bending a beam is not enough for {', '.join(map(titled, poor))}."]
                if poor
                else []
            ),
        ],
    )


def supported_more(found: list[Compared]) -> int:
    """In how many scenes the housings do more to the bending stiffness than beam theory does."""
    bending = next(iter(QUANTITIES))
    return sum(
        max(one.changes[bending].housings, one.changes[bending].faces) > one.changes[bending].beam
        for one in found
    )


def explain(page: Page, found: list[Compared]) -> None:
    """State what else counts: rings, housings, and how the shaft holds their faces."""
    bending = next(iter(QUANTITIES))
    uncertain = [one.scene for one in found if one.changes[FORCE].faces > BEARABLE]
    bare = [one.scene for one in found if one.changes[bending].bare > BEARABLE]
    share = f"{100 * BEARABLE:g} %"
    page.say(
        "A beam counts the rings of its bearings as wholly part of the shaft: of the same shafts "
        f"without rings, its bending stiffness has an error of more than {share} in "
        f"{', '.join(bare) or 'no scene'}.",
        f"In {supported_more(found)} of {len(found)} scenes the housings do more to the bending "
        "stiffness than beam theory does: whether they give, or how the shaft holds their faces, "
        "which only the assembly of solids decides.",
        f"The force of the first bearing depends on that by more than {share} in "
        f"{', '.join(uncertain) or 'no scene'}.",
    )


@case(
    "For which shafts is the beam enough?",
    source="the scenes of the library; sources stand in each",
)
def run(run: Run, page: Page) -> None:
    """Levels 1 and 2 of every scene, housings rigid and as springs."""
    found = []
    for name in SCENES[::3] if run.quick else SCENES:
        found.append(compared_scene(run, page, name))
        check(page, found[-1])
    answer(page, found)
    explain(page, found)
    page.section("What is compared")
    page.text(
        "Changes are relative to the meridian on housings as springs whose faces keep in "
        "shape. Beam instead of meridian: the shaft's theory alone, supports the same; then both "
        "without the rings that stand on the shaft. Rigid housings: the supports alone. How the "
        "shaft holds their faces: from kept in shape to moving on average. A beam is held at the "
        "middle of a seat, a solid over its width: where a bonded bearing takes moments, that "
        "alone makes the beam softer."
    )
    for key in QUANTITIES:
        show(page, key, found)
    for one in found:
        page.data(one.scene, {key: asdict(changes) for key, changes in one.changes.items()})
