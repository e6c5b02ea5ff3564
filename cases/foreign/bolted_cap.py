"""A split housing from STEP whose cap is bolted on: its joint glued, or pressed round its bolts."""

import itertools
from pathlib import Path

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.foreign.bolted_housing import in_scene
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene, change_scene
from fe_drivetrain.foreign import mesh_parts
from fe_drivetrain.geometry import write_sample
from fe_drivetrain.report import chart, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.fidelity import unit_stiffness

HOLE = 18  # mm, radius of the holes of the sample's four bolts M33
PRESSED, QUICK_PRESSED = (60, 75, 90, 110), (60, 90)  # mm
SIZES, QUICK_SIZES = (0.1, 0.07), (0.2, 0.16)  # m
MOTIONS = ("along x", "along y", "along z", "about x", "about y", "about z")
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
    with run.step("cap and base, glued"):
        glued = give(split(run.folder, fine, None, turn))
    found = {"one solid": one, "cap and base glued": glued}
    with run.step("pressed round the bolts"):
        for wide in reversed(widths):
            found[f"pressed {wide} mm"] = give(split(run.folder, fine, wide, turn))
    by_mesh = float(np.abs(coarser / one - 1.0).max())
    for k, unit in ((2, "mm/MN"), (4, "mrad/MN m")):
        page.equals(
            f"cap and base glued: compliance {MOTIONS[k]} [{unit}]",
            float(glued[k]) * 1e9,
            float(one[k]) * 1e9,
            within=by_mesh,
            why=f"what a mesh of {coarse:g} m in place of {fine:g} m changes of the one solid: the "
            "joint is a change of mesh, too",
            source="the split housing as one solid",
        )
    order = [glued, *(found[f"pressed {wide} mm"] for wide in reversed(widths))]
    page.holds(
        "the less of the joint is pressed, the more it gives along y and z and about y",
        all((a < b)[[1, 2, 4]].all() for a, b in itertools.pairwise(order)),
        why="each joins less than the one before",
        source="minimum of the potential energy: a constraint taken away softens",
    )
    page.section("Compliance of ring and housing")
    rows: list[Record] = [
        {"joint": name} | dict(zip(MOTIONS, (c * 1e9).tolist(), strict=True))
        for name, c in found.items()
    ]
    page.table("The ring's inside moves on average [mm/MN, mrad/MN m]", rows)
    more = {
        k: [100 * float(found[f"pressed {w} mm"][k] / glued[k] - 1.0) for w in widths]
        for k in (1, 2, 4, 5)
    }
    page.add(
        chart(
            "More compliance than with the joint glued",
            [trace(MOTIONS[k], widths, values) for k, values in more.items()],
            "diameter that each bolt keeps pressed [mm]",
            "more than glued [%]",
        )
    )
    page.text(
        "The joint is linear: it gives as much when it is pushed as when it is pulled. Pushed, the "
        "free sides close and the glued answer is the nearer one; pulled up, or sideways, the "
        "cap hangs on what its bolts keep pressed. The truth of a preloaded joint lies between."
    )
    meshed = split(run.folder, fine, widths[0], turn)
    alone = meshed.bearing_units[0]
    bearing = alone.bearing.model_copy(update={"bore_diameter": 0.4})
    mesh = mesh_parts(None, [alone.model_copy(update={"bearing": bearing})], meshed.mesh)
    page.image("Cap and base with the bearing's ring, as meshed", run.sketch(mesh))
    least, most = (100 * (found[f"pressed {w} mm"] / glued - 1.0) for w in (widths[-1], widths[0]))
    page.found(f"more tilt about y where bolts press {widths[0]} mm than glued [%]", most[4])
    page.answer(
        f"A cap whose four bolts keep {widths[-1]} mm each pressed lets ring and housing tilt "
        f"{least[4]:.2g} % more about y than a glued one, with {widths[0]} mm {most[4]:.2g} %; "
        f"along z they give {least[2]:.2g} and {most[2]:.2g} % more."
    )
    page.data("rows", rows)
