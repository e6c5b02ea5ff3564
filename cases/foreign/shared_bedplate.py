"""Two housings on one bedplate from STEP: coupled supports against separate ones and the solid."""

from collections.abc import Mapping

import gmsh
import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.foreign.seats import picture_under_hub_load
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene, change_scene, parse_scene
from fe_drivetrain.geometry import gmsh_session, write_step
from fe_drivetrain.report import bars
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.fidelity import LevelModel, housing_springs, shaft_level, unit_stiffness
from fe_drivetrain.shafts.response import (
    Response,
    build_model,
    mesh_scene,
    unit_load_response,
)

SCENE = """
title: two housings on one bedplate
shaft: {front: -1.0, sections: [{length: 3.2, outer_diameter: 0.4}]}
bearing_units:
  - bearing: {name: front, kind: ring, raceway_diameter: 0.6}
    interface: bonded
    housing: {}
  - bearing: {name: rear, x: 1.5, kind: ring, raceway_diameter: 0.6}
    interface: bonded
    housing: {}
gearbox: {stiffness: [0, 0, 0, rigid, 0, 0]}
mesh: {shaft: 0.3, bearing: 0.2, housing: 0.3, bearing_edge: 0.2, elements_per_turn: 8}
"""
UNITS, X = ("front", "rear"), (0.0, 1.5)
TOP = {"point": [0, 0, -420], "normal": [0, 0, 1]}  # mm
END = {"point": [-400, 0, -500], "normal": [-1, 0, 0]}  # the bedplate hangs on its front end
ON_REAR = "Force on the rear bearing for 1 N or 1 N m at the hub, by how supports are modelled"
LOADS = {"Fy": 1, "Fz": 2, "My": 4, "Mz": 5}


def on_bedplate(scene: Scene, file: str) -> Scene:
    """The scene with both housings on one part, held at its front end."""
    ties = [{"face": TOP, "to": to} for to in ("housing", "rear.housing")]
    part = {"name": "bedplate", "step": file, "material": "steel", "tied": ties, "held": [END]}
    keys = {f"bearing_units.{name}.stands_on": "parts" for name in UNITS}
    return change_scene(scene, keys | {"bearing_units.front.parts": [part]})


def alone(coupled: dict[str, Floats]) -> dict[str, Floats]:
    """Each unit as if the other did not load the bedplate: the inverse of its own compliance."""
    C = np.linalg.inv(np.vstack([coupled[name] for name in UNITS]))
    blocks = [slice(6 * k, 6 * k + 6) for k in range(len(UNITS))]
    return {n: np.asarray(np.linalg.inv(C[b, b])) for n, b in zip(UNITS, blocks, strict=True)}


def share(reactions: Mapping[str, Floats], load: str) -> float:
    """Force on the rear bearing for a load at the hub, along it, or across a moment."""
    row = LOADS[load] if load[0] == "F" else {"My": 2, "Mz": 1}[load]
    return float(reactions["rear"][row, LOADS[load]])


def levels(scene: Scene, ground: Scene) -> dict[str, LevelModel]:
    """Shafts on bearing units that are coupled by the bedplate, apart, or on the ground."""
    stiff, soft = (housing_springs(scene, way)[0] for way in ("rigid", "averaged"))
    fixed = {name: unit_stiffness(ground, name, "rigid") for name in UNITS}
    return {
        "coupled, rigid faces": shaft_level(scene, 2, stiff),
        "coupled, averaged faces": shaft_level(scene, 2, soft),
        "not coupled": shaft_level(ground, 2, alone(stiff)),
        "rigid ground": shaft_level(ground, 2, fixed),
    }


def check(page: Page, found: dict[str, LevelModel], solid: Response) -> None:
    """The assembly of solids lies between both ways to couple, and is in balance."""
    for load in LOADS:
        unit = "-" if load[0] == "F" else "1/m"
        low, high = sorted(share(found[f"coupled, {w} faces"].reaction_matrices, load)
                           for w in ("rigid", "averaged"))  # fmt: skip
        page.equals(
            f"force on the rear bearing for {load} at the hub, coupled [{unit}]",
            (low + high) / 2,
            share(solid.reactions, load),
            within=(high - low) / 2 / abs(share(solid.reactions, load)),
            why="a face between ring and shaft keeps its shape or moves on average: the solid lies "
            "between the two",
            source="shaft, bearings, housings and bedplate as one assembly of solids",
        )
    page.vanishes(
        "forces and moments of both feet, shaft and gearbox, less what is applied, relative",
        solid.equilibrium_error,
        within=1e-8,
        why="of a solution in balance round-off is left",
        source="equilibrium",
    )


def answer(page: Page, on_rear: dict[str, float]) -> None:
    """State the force on the rear bearing [kN] under a pitching moment of 1 MN m, by supports."""
    solids, apart, ground = (
        on_rear[name] for name in ("assembly of solids", "not coupled", "rigid ground")
    )
    page.answer(
        "How do two bearings on one bedplate share the loads of the hub?",
        f"Under a pitching moment of 1\u00a0MN\u00a0m the rear bearing carries "
        f"{solids:.3g}\u00a0kN; supports that are not coupled would give {apart:.3g}\u00a0kN, a "
        f"rigid ground {ground:.3g}\u00a0kN.",
        [
            page.value("rear bearing, assembly of solids [kN]", solids),
            *(
                page.value(f"rear bearing, {name} [kN]", on_rear[name], beside=solids, by="solids")
                for name in on_rear
                if name != "assembly of solids"
            ),
            page.judged(
                "force on the rear bearing for Fz at the hub, coupled",
                "rear bearing, share of a vertical hub force Fz",
                "solids",
            ),
        ],
        hero=ON_REAR,
        cautions=["Tied faces are glued all over: no joint opens or slides."],
    )


@case(
    "Two housings on one bedplate: supports that are coupled",
    source="equilibrium; the assembly of solids; the bearing units on the ground",
)
def run(run: Run, page: Page) -> None:
    """Share the hub loads between two bearings on a bedplate: coupled, apart, and as solids."""
    file, size = str(run.folder / "bedplate.step"), 0.3 if run.quick else 0.15
    with gmsh_session():
        write_step(file, [gmsh.model.occ.addBox(-0.4, -0.8, -0.72, 2.3, 1.6, 0.3)])
    ground = change_scene(parse_scene(SCENE), {"mesh.housing": size})
    scene = on_bedplate(ground, file)
    with run.step("assembly of solids"):
        model = build_model(scene, mesh_scene(scene))
        solid = unit_load_response(model)
    found = run.timed("bearing units, solved together and apart", levels, scene, ground)
    check(page, found, solid)
    answers = {name: model_.reaction_matrices for name, model_ in found.items()}
    answers["assembly of solids"] = dict(solid.reactions)
    rows: list[Record] = [
        {"supports": name} | {f"{load} at the hub": share(of, load) for load in LOADS}
        for name, of in answers.items()
    ]
    page.section("Force on the rear bearing")
    page.table("Of 1 N [-] and of 1 N m [1/m], along z for Fz and My, y for Fy and Mz", rows)
    picture_under_hub_load(run, page, model, solid)
    of_load = {name: {load: abs(share(of, load)) for load in LOADS} for name, of in answers.items()}
    page.add(bars(ON_REAR, of_load, "force [N]"))
    answer(page, {name: 1e3 * of["My"] for name, of in of_load.items()})
