"""A foot that preloaded bolts clamp: when it opens, and what the bolts then carry."""

import math
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.foreign.bolted_housing import in_scene
from fe_drivetrain.common import Cache, stiffness_transport
from fe_drivetrain.drivetrain_file import Scene, change_scene
from fe_drivetrain.foreign import ClampedFoot, FootState
from fe_drivetrain.geometry import Bearing, Housing, gmsh_session, write_step
from fe_drivetrain.geometry.bolt_preload import coarse_thread, yield_strength
from fe_drivetrain.report import chart, trace
from fe_drivetrain.report.number_text import formatted, value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.fidelity import unit_stiffness
from fe_drivetrain.shafts.response import clamped_foot, mesh_scene

NAME = "main_bearing"
SIZE, QUICK_SIZE = 0.1, 0.25  # of elements [m]
PATCHES, QUICK_PATCHES = (0.092, 0.06), (0.2,)  # sides of patches [m]
LOADS = np.linspace(0.0, 0.4, 33)  # MN m, about y
ABOUT_Y = np.eye(6)[4] * 1e6
SHARES = (0.3, 0.5, 0.7, 0.9)  # of yield
MORE = 0.05  # of the preload: a bolt that carries so much more is no longer relieved by its foot
PULLED = "moment at which a bolt carries 5 % over its preload"
FORCES = "Bolt force over moment about y"
STIFF, GROUND = 1e13, 1e9  # Pa, N/m^3: a block that is stiff against its ground
SOFTER = (0.1, 0.05)  # times ground and bolts

REST = {"bearing": 0.2, "bearing_edge": 0.2, "elements_per_turn": 8}  # of the mesh
HOLES = "hole_radius: 26, washer_diameter: 92"  # mm
BOLT, CLASS, OF_YIELD = 48, "8.8", 0.7  # diameter [mm], property class, tightened to
TIGHTENED = f"property_class: '{CLASS}', of_yield: {OF_YIELD}"
CLAMPED = f"{{{HOLES}, hold: clamped, diameter: {BOLT}, {TIGHTENED}}}"
BEAMS = f"{{{HOLES}, hold: beams, diameter: {BOLT}}}"
WASHERS = f"{{{HOLES}}}"


def block(folder: Path, size: float, bolts: str = CLAMPED) -> Scene:
    """The block in a scene, on a mesh of a size [m]."""
    file = folder / "block.step"
    if not file.exists():
        with gmsh_session():
            write_step(file, [Housing(base="bolted").build(Bearing(kind="ring")).volume])
    sizes = {f"mesh.{key}": value for key, value in ({"housing": size} | REST).items()}
    return change_scene(
        in_scene("A block clamped by four bolts M48", file, f"bolts: {bolts}"), sizes
    )


def minutes(tilt: float) -> float:
    """A tilt [rad] in minutes of arc."""
    return math.degrees(tilt) * 60.0


def where_pulled(foot: ClampedFoot) -> float:
    """The least moment [MN m] at which a bolt carries `MORE` than its preload; inf beyond 10."""
    for load in np.geomspace(1e-3, 10.0, 161).tolist():
        if (foot.state(load * ABOUT_Y).tension > (1.0 + MORE) * foot.preload).any():
            return float(load)
    return math.inf


def condensed(
    run: Run, scene: Scene, sides: tuple[float, ...], seconds: list[Record]
) -> dict[float, ClampedFoot]:
    """The foot by the side of its patches [m]; adds to the times."""
    feet = {}
    for side in sides:
        with run.step(f"condensed to patches of {side:g} m"):
            start = time.perf_counter()
            feet[side] = clamped_foot(scene, NAME, size=side, cache=Cache(None))
            seconds.append({"what": f"condense, patches of {side:g} m", "s": _since(start)})
    return feet


def linear_ways(run: Run, size: float, seconds: list[Record]) -> list[Any]:
    """Tilt over the moment where washers are fixed or bolts are alone; adds to the times."""
    traces = []
    for way, bolts in (("bolts alone", BEAMS), ("washers fixed", WASHERS)):
        with run.step(way):
            start = time.perf_counter()
            held = unit_stiffness(
                block(run.folder, size, bolts), NAME, "rigid", ring=False, cache=Cache(None)
            )
            seconds.append({"what": f"stiffness for the levels, {way}", "s": _since(start)})
        tilt = minutes(np.linalg.inv(held)[4, 4] * 1e6)
        traces.append(trace(way, LOADS, tilt * LOADS))
    return traces


@case(
    "Preloaded bolts: when a foot opens, and what the linear answer misses",
    source="rigid body on an elastic ground and on bolts; terms of VDI 2230 Part 1 (2003): "
    "preload, load factor, a joint that opens",
)
def run(run: Run, page: Page) -> None:
    """Tilt a block that four bolts clamp, with contact of its foot and linear beside."""
    size = QUICK_SIZE if run.quick else SIZE
    sides = QUICK_PATCHES if run.quick else PATCHES
    scene = block(run.folder, size)
    seconds: list[Record] = []
    feet = condensed(run, scene, sides, seconds)
    foot = feet[sides[-1]]
    with run.step("contact under all loads"):
        start = time.perf_counter()
        opened = foot.path(ABOUT_Y, LOADS.tolist())
        seconds.append({"what": "contact of one load", "s": _since(start) / len(LOADS)})
        linear = [foot.linear(load * ABOUT_Y) for load in LOADS]
    check_rigid(run, page, scene, sides[0])
    check_balance(page, foot)
    lengths = {"with opening": opened, "linear": linear}
    page.section("Tilt of the seat")
    traces = [
        trace(name, LOADS, [minutes(s.motion[4]) for s in states])
        for name, states in lengths.items()
    ]
    if not run.quick:
        traces += linear_ways(run, size, seconds)
    page.add(chart("Tilt over moment about y", traces, "moment [MN m]", "tilt [arcmin]"))
    show_forces(page, lengths)
    page.table("The same loads", table(foot))
    show_preload(page, feet)
    page.image("The block and the shaft in it, as meshed", run.sketch(mesh_scene(scene)))
    page.table("Time on this machine, with others at work", seconds)
    page.found(f"{PULLED} [kN m]", 1e3 * where_pulled(foot))
    answer(page, foot, opened[-1], linear[-1])


def answer(page: Page, foot: ClampedFoot, opened: FootState, linear: FootState) -> None:
    """State when a bolt is pulled, and what it carries under the largest moment."""
    pulled = page.judged(PULLED, "moment at which a bolt carries 5 % over its preload")
    most, expected = opened.tension.max() / 1e3, linear.tension.max() / 1e3
    limit = yield_strength(CLASS) * coarse_thread(BOLT / 1e3).area / 1e3
    at = value_text(1e3 * LOADS[-1], "kN\u00a0m")
    page.answer(
        "When does a foot on preloaded bolts open, and what does the linear answer miss?",
        f"The foot opens at {formatted(pulled.value, 3)}\u00a0kN\u00a0m, when a bolt exceeds its "
        f"preload by {100 * MORE:g}\u00a0%; at {at} it carries {formatted(most, 3)}\u00a0kN"
        f"{', beyond yield' if most > limit else ''}; a linear model says "
        f"{formatted(expected, 3)}\u00a0kN.",
        [
            pulled,
            page.value(f"most pulled bolt at {at} [kN]", most, at_most=limit, by="yield"),
            page.value(f"most pulled bolt at {at}, linear model [kN]", expected),
            page.value("preload of a bolt [kN]", foot.preload[0] / 1e3),
            page.value(
                f"tilt at {at}, over that of the linear model", opened.motion[4] / linear.motion[4]
            ),
            page.judged(
                "stiff block: moment at which its foot opens, over that of a rigid one",
                "moment at which a stiff block opens, over a rigid one's",
                "rigid body",
            ),
        ],
        hero=FORCES,
        cautions=[
            f"A bolt M{BOLT} of class {CLASS} yields at {formatted(limit, 3)}\u00a0kN of tension; "
            "beyond it the computed forces and tilts do not hold.",
            f"Patches pressed least lift earlier; the foot counts as open where a bolt carries "
            f"{100 * MORE:g}\u00a0% over its preload.",
            f"The four bolts are tightened to {100 * OF_YIELD:g}\u00a0% of yield.",
        ],
    )


def show_forces(page: Page, lengths: dict[str, list[FootState]]) -> None:
    """Forces of the bolts over the moment."""
    page.section("Forces of the bolts")
    traces = [
        trace(f"most pulled, {name}", LOADS, [s.tension.max() / 1e3 for s in states])
        for name, states in lengths.items()
    ]
    opened = lengths["with opening"]
    traces.append(trace("least pulled", LOADS, [s.tension.min() / 1e3 for s in opened]))
    page.add(chart(FORCES, traces, "moment [MN m]", "force [kN]"))


def show_preload(page: Page, feet: dict[float, ClampedFoot]) -> None:
    """Moments at which the foot opens and bolts are pulled, over preload and patches."""
    page.section("Preload and patches")
    page.table(
        f"Moments about y; pulled: a bolt carries {100 * MORE:g} % over preload", limits(feet)
    )
    page.text(
        "All states grow with preload and load together, so that one condensed foot answers for "
        "every preload. The foot slides while it is tightened, and lifts between its bolts where "
        "it is thin. Linear is what the levels solve: patches that are pressed after tightening "
        "stay so. Those pressed least open first, at small loads, and that depends on the size of "
        "patches; what the open foot does depends on it much less."
    )


def _since(start: float) -> float:
    return float(f"{time.perf_counter() - start:.2g}")


def table(foot: ClampedFoot) -> list[Record]:
    """Tilt, bolt forces and pressed patches under some moments."""
    rows: list[Record] = []
    for load in (0.025, 0.05, 0.1, 0.2, 0.4):
        opened, linear = foot.state(load * ABOUT_Y), foot.linear(load * ABOUT_Y)
        rows.append(
            {
                "moment [MN m]": load,
                "tilt [arcmin]": minutes(opened.motion[4]),
                "linear [arcmin]": minutes(linear.motion[4]),
                "error of linear [%]": 100 * (linear.motion[4] / opened.motion[4] - 1),
                "most pulled bolt [kN]": opened.tension.max() / 1e3,
                "linear [kN]": linear.tension.max() / 1e3,
                "pressed area [%]": 100 * foot.areas[opened.closed].sum() / foot.areas.sum(),
            }
        )
    return rows


def limits(feet: dict[float, ClampedFoot]) -> list[Record]:
    """For each size of patches and share of yield."""
    rows: list[Record] = []
    for side, foot in feet.items():
        pulled, first = where_pulled(foot), foot.opening(ABOUT_Y)[0]
        full = foot.preload[0] / OF_YIELD
        for share in SHARES:
            rows.append(
                {
                    "patches [m]": side,
                    "of yield": share,
                    "preload [kN]": share * full / 1e3,
                    "first patch opens [kN m]": share / OF_YIELD * first * 1e3,
                    "pulled [kN m]": share / OF_YIELD * pulled * 1e3,
                }
            )
    return rows


def check_rigid(run: Run, page: Page, scene: Scene, side: float) -> None:
    """A block that does not give opens as a rigid body on springs does."""
    stiff = {"youngs_modulus": STIFF, "poisson_ratio": 0.3, "density": 7100}
    part = f"bearing_units.{NAME}.housing.material"
    with run.step("a stiff block on an elastic ground"):
        foot = clamped_foot(
            change_scene(scene, {"materials.stiff": stiff, part: "stiff"}),
            NAME,
            size=side,
        )
    softer = [replace(foot, ground=t * GROUND, bolts=t * foot.bolts) for t in SOFTER]
    ratios = [f.opening(ABOUT_Y)[0] / opening_of_rigid(f) for f in softer]
    page.equals(
        "stiff block: moment at which its foot opens, over that of a rigid one",
        2 * ratios[1] - ratios[0],
        1.0,
        within=1e-3,
        why=f"continued from two, {ratios[0]:.5f} and {ratios[1]:.5f}, with ground and bolts half "
        "as stiff: what the block gives falls with these, and its square is left",
        source="rigid body on an elastic ground, on four Timoshenko beams",
    )


def opening_of_rigid(foot: ClampedFoot) -> float:
    """The moment [MN m] at which a rigid body on the same ground and bolts opens."""
    heads = foot.rigid[3 * len(foot.areas) :].reshape(-1, 6, 6)
    springs = sum(h.T @ k @ h for h, k in zip(heads, foot.bolts, strict=True))
    ground = sum(
        stiffness_transport(np.diag([foot.ground * a] * 3 + [0.0] * 3), p)
        for a, p in zip(foot.areas, foot.places, strict=True)
    )
    # z, and about x and y: the foot slides while it is tightened, and bolts of one length
    # do not bend a body that settles evenly
    lever = np.column_stack([np.ones(len(foot.places)), foot.places[:, 1], -foot.places[:, 0]])
    each = zip(heads, foot.axes, foot.preload, strict=True)
    pulls = np.array([-h[:3].T @ axis * f for h, axis, f in each])
    stiffness = (lever.T * foot.ground * foot.areas) @ lever
    pressed = -lever @ np.linalg.solve(stiffness, pulls.sum(axis=0)[2:5])
    turned = lever @ np.linalg.solve(springs + ground, ABOUT_Y)[2:5]
    lifting = turned > 0
    return float((pressed[lifting] / turned[lifting]).min())


def check_balance(page: Page, foot: ClampedFoot) -> None:
    """Ground and bolts balance the load, and nothing is pulled to the ground."""
    state = foot.state(ABOUT_Y)
    forces = np.concatenate([state.forces.ravel(), state.bolts.ravel()])
    page.vanishes(
        "force and moment left over under 1 MN m [N, N m]",
        float(np.abs(foot.rigid.T @ forces + ABOUT_Y).max()),
        within=1e-3,
        why="round-off of forces of a meganewton",
        source="balance of the housing",
    )
    page.holds(
        "nothing is pulled, and what lifts carries nothing",
        bool(
            state.forces[:, 0].min() > -1e-6 * state.forces[:, 0].max()
            and not state.forces[~state.closed].any()
            and not state.closed.all()
        ),
        why="contact takes pressure alone",
        source="complementarity",
    )
