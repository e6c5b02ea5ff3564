"""A bedplate and a torque arm from STEP, tied to a housing, against one file and a beam."""

import gmsh
import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.foreign.seats import (
    MOTIONS,
    check_compliance,
    compliance_rows,
    picture_under_hub_load,
)
from fe_drivetrain.common import Floats, stiffness_transport
from fe_drivetrain.drivetrain_file import MATERIALS, Scene, change_scene, library_scene
from fe_drivetrain.foreign import bolt_stiffness
from fe_drivetrain.geometry import bedplate, gmsh_session, write_sample, write_step
from fe_drivetrain.report import bars
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.fidelity import unit_stiffness
from fe_drivetrain.shafts.response import build_model, mesh_scene, unit_load_response

NAME, UNIT = "main_bearing", "bearing_units.main_bearing"
TILT = "What the seat tilts by under 1 MN m, by what the housing stands on"
SIZES, QUICK_SIZES = (0.2, 0.1), (0.3, 0.25)  # m, the finer last
STIFF = (5e12, 1e13)  # Pa: moduli of bedplates that hardly give
BAR, ROOT, END = 0.2, np.array([0.0, 0.41, -0.15]), np.array([0.0, 1.61, -0.15])  # m: a round arm
FOOT, GROUND = ({"point": [0, 0, z], "normal": [0, 0, 1]} for z in (-420, -800))  # mm


def with_part(scene: Scene, file: str, tied: Record, held: Record, material: str) -> Scene:
    """The scene with a further part that alone carries the housing."""
    part = {"name": "part", "step": file, "material": material}
    ties = {"tied": [{"face": tied}], "held": [held]}
    return change_scene(scene, {f"{UNIT}.stands_on": "parts", f"{UNIT}.parts": [part | ties]})


def with_modulus(scene: Scene, key: str, modulus: float) -> Scene:
    """The scene with another modulus of its housing or part."""
    given = {"youngs_modulus": modulus, "poisson_ratio": 0.3, "density": 7100}
    return change_scene(scene, {"materials.stiff": given, f"{UNIT}.{key}.material": "stiff"})


def give(scene: Scene) -> Floats:
    """(6, 6) compliance of the unit, its seat held in shape."""
    return np.asarray(np.linalg.inv(unit_stiffness(scene, NAME, "rigid")))


def beyond(one: Floats, other: Floats) -> float:
    """Largest relative difference of the diagonals."""
    return float(np.abs(np.diag(one) / np.diag(other) - 1.0).max())


@case(
    "Parts beside a housing: a bedplate and a torque arm from STEP, tied",
    source="the same two solids in one STEP file, glued; a Timoshenko beam (Cowper 1966)",
)
def run(run: Run, page: Page) -> None:
    """Stand the library's housing on a bedplate and on an arm, and compare with what is known."""
    coarse, fine = QUICK_SIZES if run.quick else SIZES
    ground = on_ground(fine, run.quick)
    files = {n: str(run.folder / f"{n}.step") for n in "pob"}
    on_plate, glued = on_bedplate(ground, files["p"], files["o"])
    with run.step("bedplate, tied and glued"):
        K, whole = give(on_plate), give(glued)
        coarser = np.diag(give(change_scene(glued, {"mesh.housing": coarse})))
        by_mesh = coarser / np.diag(whole) - 1.0
    for k in (2, 4, 5):
        check_compliance(
            page,
            "on the bedplate, tied",
            k,
            np.diag(K),
            np.diag(whole),
            within=abs(float(by_mesh[k])),
            why=f"what a mesh of {coarse:g} m in place of {fine:g} m changes of the reference: "
            "nodes of the joint that both sides have are a change of mesh, too",
            source="both solids in one STEP file, glued where they touch",
        )
    with run.step("stiff bedplates"):
        fixed = give(ground)
        stiff = [give(with_modulus(on_plate, "parts.0", E)) for E in STIFF]
    check_stiff(page, fixed, K, stiff)
    found = {"fixed foot": fixed, "bedplate": K}
    if not run.quick:
        found["arm, stiff housing"] = check_arm(run, page, ground, files["b"])
        model = build_model(on_plate, mesh_scene(on_plate))
        picture_under_hub_load(run, page, model, unit_load_response(model))
    else:
        page.image("The housing on its bedplate, as meshed", run.sketch(mesh_scene(on_plate)))
    rows = compliance_rows("stands on", {name: np.diag(c) for name, c in found.items()})
    page.section("Compliance at the seat")
    page.table("Seat held in shape [mm/MN, mrad/MN m]", rows)
    tilts = {
        name: dict(zip(MOTIONS[3:], 1e9 * np.diag(c)[3:], strict=True)) for name, c in found.items()
    }
    page.add(bars(TILT, tilts, "compliance [mrad/MN m]"))
    answer(page, K[4, 4] / fixed[4, 4], 100 * beyond(K, whole), 100 * abs(by_mesh).max())


def answer(page: Page, times: float, apart: float, by_mesh: float) -> None:
    """State how much softer the seat is on its bedplate.

    Parameters
    ----------
    page : Page
        With its checks.
    times : float
        Tilt about y over that on a fixed foot.
    apart : float
        Largest difference of tied from glued [%].
    by_mesh : float
        What a coarser mesh changes at most [%].
    """
    page.answer(
        "How much softer is a housing on its bedplate than on a fixed foot?",
        f"On its bedplate the bearing seat tilts {times:.2g} times as much as on a fixed foot; "
        f"tied and glued bedplates agree within {apart:.2g}\u00a0%.",
        [
            page.value("tilt about y, over that on a fixed foot", times),
            *(
                page.judged(
                    f"on the bedplate, tied: compliance {motion}", f"{what} {motion}", "glued"
                )
                for what, motion in (
                    ("seat's compliance", "along z"),
                    ("seat's compliance", "about y"),
                    ("seat's compliance", "about z"),
                )
            ),
            page.value("largest difference of tied and glued [%]", apart),
        ],
        hero=TILT,
        cautions=[
            "Tied faces are glued all over: no joint opens or slides.",
            f"A coarser mesh changes the compliance by up to {by_mesh:.2g} %.",
        ],
    )


def on_ground(size: float, quick: bool) -> Scene:
    """The library's housing on the ground, on a mesh of a size [m]."""
    sizes = {"housing": size, "bearing": 0.2, "bearing_edge": 0.2, "shaft": 0.3}
    sizes |= {"elements_per_turn": 8 if quick else 12}
    scene = library_scene("main_bearing_bonded")
    return change_scene(scene, {f"mesh.{key}": value for key, value in sizes.items()})


def on_bedplate(ground: Scene, plate: str, both: str) -> tuple[Scene, Scene]:
    """The housing tied to a bedplate from a file, and both glued as one solid from another."""
    unit = ground.bearing_units[0]
    write_sample("bedplate", plate)
    with gmsh_session():
        write_step(both, [unit.block.build(unit.bearing).volume, bedplate()])
    one = {"step": both, "seat": {"radius": 300}, "held": [GROUND]}
    tied = with_part(ground, plate, FOOT, GROUND, "ductile_iron")
    return tied, change_scene(ground, {f"{UNIT}.housing": one})


def check_stiff(page: Page, fixed: Floats, K: Floats, stiff: list[Floats]) -> None:
    """A bedplate that does not give is a fixed foot."""
    away = [beyond(found, fixed) for found in (K, *stiff)]
    page.holds(
        "the stiffer the bedplate, the nearer to the fixed foot",
        away[0] > away[1] > away[2],
        why="what holds the foot gives less",
        source="minimum of the potential energy",
    )
    page.vanishes(
        "compliance on a bedplate that does not give, less that of the fixed foot, relative",
        beyond((STIFF[1] * stiff[1] - STIFF[0] * stiff[0]) / (STIFF[1] - STIFF[0]), fixed),
        within=away[1] * away[2],
        why="extrapolated from two moduli: of a series in one over the modulus, the remainder is "
        "of the order of the product of what is left at each",
        source="the same housing, held at its foot",
    )


def check_arm(run: Run, page: Page, ground: Scene, file: str) -> Floats:
    """A stiff housing on a round torque arm alone, which is a beam."""
    with gmsh_session():
        write_step(file, [gmsh.model.occ.addCylinder(*ROOT, *(END - ROOT), BAR / 2)])
    ends = [{"point": (1000 * x).tolist(), "normal": [0, 1, 0]} for x in (ROOT, END)]
    with run.step("torque arm"):
        arm = with_part(with_modulus(ground, "housing", STIFF[1]), file, ends[0], ends[1], "steel")
        found = give(arm)
    root = bolt_stiffness(BAR, ROOT, END, MATERIALS["steel"])
    exact, length = np.linalg.inv(stiffness_transport(root, ROOT)), float((END - ROOT)[1])
    bending = length**3 / (3 * MATERIALS["steel"].youngs_modulus * np.pi * BAR**4 / 64)
    for k in (2, 3):
        check_compliance(
            page,
            "stiff housing on an arm",
            k,
            np.diag(found),
            np.diag(exact),
            within=float(1.0 - bending / np.linalg.inv(root)[2, 2]),
            why="the share of shear in the beam's deflection, by which a beam knows its clamped "
            "ends at best",
            source="a round cantilever with Cowper's shear coefficient",
        )
    return found
