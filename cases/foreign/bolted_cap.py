"""A split housing from STEP whose cap is bolted on: its joint glued, or pressed round its bolts."""

import itertools
from pathlib import Path

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.foreign.bolted_housing import in_scene
from fe_drivetrain.cases.foreign.seats import MOTIONS, check_compliance, compliance_rows
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene, change_scene
from fe_drivetrain.foreign import mesh_parts
from fe_drivetrain.geometry import write_sample
from fe_drivetrain.report import chart, trace
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.shafts.fidelity import unit_stiffness

HOLE = 18  # mm, radius of the holes of the sample's four bolts M33
PRESSED, QUICK_PRESSED = (60, 75, 90, 110), (60, 90)  # mm
SIZES, QUICK_SIZES = (0.1, 0.07), (0.2, 0.16)  # m
GLUED = "cap and base glued"
MORE = "More compliance than with the joint glued"
UNIT = "bearing_units.main_bearing.housing"


def split(folder: Path, size: float, pressed: float | None, turn: int = 12) -> Scene:
    """The cap on its base in a scene, pressed round its bolts [mm], or glued."""
    scene = in_scene("a bolted cap", folder / "cap_and_base.step", "")
    ring = 1.0 / turn  # coarser ones fold over where they are tied
    sizes = {"housing": size, "bearing": ring, "bearing_edge": ring, "elements_per_turn": turn}
    changes: dict[str, object] = {f"mesh.{key}": value for key, value in sizes.items()}
    if pressed is not None:
        changes[f"{UNIT}.bolted"] = {"hole_radius": HOLE, "pressed_diameter": pressed}
    return change_scene(scene, changes)


def give(scene: Scene) -> Floats:
    """(6,) compliance of ring and housing, the ring's inside moving on average."""
    K = unit_stiffness(scene, "main_bearing", "averaged")
    return np.asarray(np.diag(np.linalg.inv(K)), dtype=np.float64)


def joined(run: Run, size: float, widths: tuple[int, ...], turn: int) -> dict[str, Floats]:
    """Compliance with the joint glued, then pressed in ever smaller places round its bolts."""
    with run.step("cap and base, glued"):
        found = {GLUED: give(split(run.folder, size, None, turn))}
    with run.step("pressed round the bolts"):
        for wide in reversed(widths):
            found[f"pressed {wide} mm"] = give(split(run.folder, size, wide, turn))
    return found


@case(
    "A bolted cap: its joint glued, or pressed round the bolts alone",
    source="the same housing as one solid",
)
def run(run: Run, page: Page) -> None:
    """Condense the split housing with its cap joined in ever smaller places."""
    write_sample("cap_and_base", run.folder / "cap_and_base.step")
    write_sample("split_housing", run.folder / "split_housing.step")
    (coarse, fine), turn = (QUICK_SIZES, 8) if run.quick else (SIZES, 12)
    widths = QUICK_PRESSED if run.quick else PRESSED
    whole = {f"{UNIT}.step": str(run.folder / "split_housing.step")}
    with run.step("one solid"):
        scenes = [change_scene(split(run.folder, s, None, turn), whole) for s in (coarse, fine)]
        coarser, one = map(give, scenes)
    found = {"one solid": one} | joined(run, fine, widths, turn)
    check(page, found, coarser, (coarse, fine))
    page.section("Compliance of ring and housing")
    rows = compliance_rows("joint", found)
    page.table("The ring's inside moves on average [mm/MN, mrad/MN m]", rows)
    more = {w: 100 * (found[f"pressed {w} mm"] / found[GLUED] - 1.0) for w in widths}
    show_joint(page, more)
    meshed = split(run.folder, fine, widths[0], turn)
    alone = meshed.bearing_units[0]
    bearing = alone.bearing.model_copy(update={"bore_diameter": 0.4})
    mesh = mesh_parts(None, [alone.model_copy(update={"bearing": bearing})], meshed.mesh)
    page.image("Cap and base with the bearing's ring, as meshed", run.sketch(mesh))
    page.found(
        f"more tilt about y where bolts press {widths[0]} mm than glued [%]", more[widths[0]][4]
    )
    answer(page, more)
    page.data("rows", rows)


def answer(page: Page, more: dict[int, Floats]) -> None:
    """State how much more ring and housing give [%] than glued, by what stays pressed [mm]."""
    narrow, wide = min(more), max(more)
    page.answer(
        "How much softer is a housing whose cap is bolted than one that is glued?",
        f"The bolted housing tilts {more[narrow][4]:.2g}\u00a0% more than the glued one if its "
        f"joint is pressed {narrow}\u00a0mm wide round each bolt, {more[wide][4]:.2g}\u00a0% more "
        f"if {wide}\u00a0mm wide.",
        [
            page.judged(
                f"more tilt about y where bolts press {narrow} mm than glued",
                f"more tilt than glued, {narrow} mm pressed",
            ),
            page.value(f"more tilt than glued, {wide} mm pressed [%]", more[wide][4]),
            page.value(
                f"more displacement along z than glued, {narrow} mm pressed [%]", more[narrow][2]
            ),
            page.judged(f"{GLUED}: compliance about y", "compliance about y, glued", "one solid"),
            page.judged(f"{GLUED}: compliance along z", "compliance along z, glued", "one solid"),
        ],
        hero=MORE,
        cautions=[
            "The joint is linear, as soft when it is pushed as when it is pulled: a real preloaded "
            "joint lies between bolted and glued."
        ],
    )


def check(
    page: Page, found: dict[str, Floats], coarser: Floats, sizes: tuple[float, float]
) -> None:
    """A glued joint is one solid; the less of a joint is pressed, the softer it is."""
    solid, order = found["one solid"], [c for name, c in found.items() if name != "one solid"]
    for k in (2, 4):
        check_compliance(
            page,
            GLUED,
            k,
            found[GLUED],
            solid,
            within=float(np.abs(coarser / solid - 1.0).max()),
            why=f"what a mesh of {sizes[0]:g} m in place of {sizes[1]:g} m changes of the one "
            "solid: the joint is a change of mesh, too",
            source="the split housing as one solid",
        )
    page.holds(
        "the less of the joint is pressed, the more it gives along y and z and about y",
        all((a < b)[[1, 2, 4]].all() for a, b in itertools.pairwise(order)),
        why="each joins less than the one before",
        source="minimum of the potential energy: a constraint taken away softens",
    )


def show_joint(page: Page, more: dict[int, Floats]) -> None:
    """More compliance than glued [%], by what stays pressed [mm]."""
    page.add(
        chart(
            MORE,
            [
                trace(MOTIONS[k], list(more), [float(c[k]) for c in more.values()])
                for k in (1, 2, 4, 5)
            ],
            "diameter that each bolt keeps pressed [mm]",
            "more than glued [%]",
        )
    )
    page.text(
        "The joint is linear: it gives as much when it is pushed as when it is pulled. Pushed, the "
        "free sides close and the glued answer is the nearer one; pulled up, or sideways, the "
        "cap hangs on what its bolts keep pressed. The truth of a preloaded joint lies between."
    )
