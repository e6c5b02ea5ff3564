"""What a flexible housing does to the load zone: rollers on races that give way."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing import (
    SOFTEST_LEFT_OUT,
    Bearing,
    Races,
    RacesEquilibrium,
    RollerRow,
    angles,
    catalogue_bearing,
    equilibrium,
    equilibrium_on_races,
    linear,
    rigid_races,
)
from fe_drivetrain.bearing_life.rings import housing_races
from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.housed_bearing import (
    ASSUMED_HOUSING,
    NAME,
    RACEWAY,
    WIDTH,
    Size,
    bearing_s,
    housed_races,
    housed_scene,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.common.typeset import MINUS
from fe_drivetrain.drivetrain_file import change_scene, joint_stiffness, library_scene
from fe_drivetrain.report import Chart, chart, roller_chart, rolling_elements, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.fidelity import unit_stiffness

#: Loads [N, N m].
LOADS = {
    "radial, down": (0.0, 0.0, -4e5, 0.0, 0.0),
    "radial, up": (0.0, 0.0, 4e5, 0.0, 0.0),
    "radial, sideways": (0.0, 4e5, 0.0, 0.0, 0.0),
    "moment about y": (0.0, 0.0, 0.0, 8e5, 0.0),
    "moment about z": (0.0, 0.0, 0.0, 0.0, 8e5),
    "combined": (2e5, 0.0, -4e5, 8e5, 0.0),
}
SHOWN = ("radial, down", "radial, up", "radial, sideways", "moment about y", "combined")
CHANGE = "flexible over rigid [%]"

#: Scenes, bearing and catalogue entry of spherical and toroidal bearings that fill their bore.
OTHERS = (
    ("nrel_5mw_main_shaft", "upwind", "nrel_5mw_upwind"),
    ("three_point_suspension", "main_bearing", "three_point_main"),
    ("nrel_750kw_low_speed_shaft", "main_bearing", "nrel_750kw_main"),
)
#: Load on them [N].
HEAVY = 1e6

#: Meshes, coarse to fine.
SIZES: tuple[Size, ...] = ((3.6, 8), (1.6, None), (1.0, None))

#: Springs of the scene's joint [N/m]: as stiff as contacts, and soft.
SPRING, SOFT = 2e9, 2e4
CONTACT_ANGLE = 20.0
ROLLERS = 36
PLACES = (-WIDTH / 4.0, WIDTH / 4.0)

#: The motions, of six, that a bearing resists.
FIVE = (0, 1, 2, 4, 5)


@dataclass(frozen=True)
class Housed:
    """Peaks of the rollers on each mesh, and all of the finest."""

    peaks: list[Floats]
    races: Races
    flexible: RacesEquilibrium
    rigid: Floats

    @property
    def band(self) -> Floats:
        """What the last refinement changed of the peaks; none of a single mesh."""
        return np.abs(self.peaks[-1] - self.peaks[-2]) if len(self.peaks) > 1 else np.zeros(0)


@case(
    "Flexible housing: peak roller and load zone against rigid rings",
    source="solid of the library's housing under the rollers of bearing S; Stirling 2023, ch. 4",
)
def run(run: Run, page: Page) -> None:
    """Condense the housing to the rollers, solve, and compare with rigid rings and with springs."""
    loads = np.array(list(LOADS.values()))
    sizes = SIZES[:1] if run.quick else SIZES
    with run.step("housing at the rollers"):
        races = [housed_races(size) for size in sizes]
    with run.step("equilibrium"):
        found = [equilibrium_on_races(one, loads) for one in races]
        rigid = equilibrium(bearing_s(), loads, tolerance=1e-12).rollers
        housed = Housed([one.rollers.max(axis=1) for one in found], races[-1], found[-1], rigid)
    with run.step("other housings"):
        others = _others(run.quick)
    _check_limits(page, housed, loads)
    with run.step("rollers as springs"):
        _check_springs(page, sizes[0])
    rows = _rows(housed)
    page.section("Rollers on the housing and between rigid rings")
    most = max(rows, key=lambda row: abs(row[CHANGE]))
    hero = f"Load of each roller on the flexible housing: {most['load']}"
    page.add(roller_chart(hero, bearing_s(), housed.flexible.rollers[rows.index(most)]))
    answer(page, rows, hero)
    page.table("Peak roller", rows)
    for name in SHOWN:
        _show(page, housed, name)
    page.section("Housings of the library")
    page.table("Radial load down, spherical and toroidal bearings", others)
    page.assume_all(ASSUMED_HOUSING)
    page.text(
        "The inner ring and its shaft are rigid. The housing, of ductile iron with the outer ring "
        "in it, stands on a fixed foot. A roller presses on a window of the bore as long as "
        "itself, that falls off evenly to its neighbours: the approach close to the contact is "
        "part of the contact's law. The housing is condensed once; a load case takes some five "
        f"Newton steps in 5 motions and {len(housed.races.shapes()[1])} shapes of the race."
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(bearing_s())))
    page.data("rollers", {n: housed.flexible.rollers[k] for k, n in enumerate(LOADS)})
    page.data("rigid", {n: housed.rigid[k] for k, n in enumerate(LOADS)})


def answer(page: Page, rows: list[Record], hero: str) -> None:
    """State what the flexible housing changes of peak rollers and load zone."""
    changes = [row[CHANGE] for row in rows]
    span = f"{min(changes):+.0f}\u00a0% to {max(changes):+.0f}\u00a0%".replace("-", MINUS)
    combined = next(row for row in rows if row["load"] == "combined")
    page.found("largest change of the peak roller [%]", max(changes, key=abs))
    loaded = [combined[f"loaded rollers, {rings}"] for rings in ("flexible", "rigid")]
    peaks = [
        page.value(
            f"peak roller, {row['load']} [kN]",
            row["flexible housing [kN]"],
            row["mesh changes it by [kN]"],
            beside=row["rigid rings [kN]"],
            by="rigid rings",
        )
        for row in rows
        if row["load"] in SHOWN
    ]
    page.answer(
        "How does a flexible housing change the peak roller load and the load zone?",
        f"A flexible housing changes the peak roller load by {span} against rigid rings; "
        f"{loaded[0]} rollers instead of {loaded[1]} carry a combined load.",
        [
            page.judged(
                "largest change of the peak roller", "largest change of the peak roller load"
            ),
            *peaks,
        ],
        hero,
        ["The dimensions of the housing are assumed; its foot is fixed."],
    )


def _rows(housed: Housed) -> list[Record]:
    rows: list[Record] = []
    for k, name in enumerate(LOADS):
        soft, hard = housed.flexible.rollers[k], housed.rigid[k]
        rows.append(
            {
                "load": name,
                "rigid rings [kN]": hard.max() / 1e3,
                "flexible housing [kN]": soft.max() / 1e3,
                "mesh changes it by [kN]": housed.band[k] / 1e3 if len(housed.band) else None,
                CHANGE: 100.0 * (soft.max() / hard.max() - 1.0),
                "loaded rollers, rigid": int((hard > 0.0).sum()),
                "loaded rollers, flexible": int((soft > 0.0).sum()),
            }
        )
    return rows


def _others(quick: bool) -> list[Record]:
    """Main bearings that fill the bore of their own scene."""
    rows: list[Record] = []
    for name, unit, part in OTHERS[: 1 if quick else None]:
        scene = library_scene(name)
        scene = scene.model_copy(update={"mesh": scene.mesh.scaled(2.0 if quick else 1.0)})
        bearing = catalogue_bearing(part, laminae=0)
        load = np.array([0.0, 0.0, -HEAVY, 0.0, 0.0])
        soft = equilibrium_on_races(housing_races(scene, unit, bearing), load).rollers[0]
        hard = equilibrium(bearing, load).rollers[0]
        rows.append(
            {
                "scene": f"{name}, {unit}",
                "load [kN]": HEAVY / 1e3,
                "rigid rings [kN]": hard.max() / 1e3,
                "flexible housing [kN]": soft.max() / 1e3,
                CHANGE: 100.0 * (soft.max() / hard.max() - 1.0),
                "loaded rollers, rigid": int((hard > 0.0).sum()),
                "loaded rollers, flexible": int((soft > 0.0).sum()),
            }
        )
    return rows


def _check_limits(page: Page, housed: Housed, loads: Floats) -> None:
    """Rigid races are the bearing by itself, and stiff ones come near it."""
    bearing, peak = housed.races.bearing, housed.rigid.max()
    page.vanishes(
        "rigid races less the bearing by itself: rollers over the largest",
        float(
            np.abs(
                equilibrium_on_races(rigid_races(bearing), loads, tolerance=1e-12).rollers
                - housed.rigid
            ).max()
            / peak
        ),
        within=1e-9,
        why="both within 1e-12 of the load at the same minimum",
        source="the bearing by itself",
    )
    ratios = []
    for factor in (1e3, 1e4):
        stiff = equilibrium_on_races(housed.races.stiffened(factor), loads, shapes=144)
        ratios.append(float(np.abs(stiff.rollers - housed.rigid).max() / peak))
    page.equals(
        "difference to rigid rings with a modulus 10 000 times, over that with 1000 times",
        ratios[1] / ratios[0],
        0.1,
        within=0.05,
        why="first order in the compliance, but for the rim of the load zone",
        source="the rigid limit",
    )
    _check_balance(page, housed, loads)
    _check_shapes(page, housed, loads)


def _check_balance(page: Page, housed: Housed, loads: Floats) -> None:
    """The inner ring is in balance."""
    arm = housed.races.bearing.arm
    size = np.array([1.0, 1.0, 1.0, arm, arm])
    page.vanishes(
        "rollers' forces less the load, over the load, the worst",
        float(
            (
                np.linalg.norm(housed.flexible.unbalanced / size, axis=1)
                / np.linalg.norm(loads / size, axis=1)
            ).max()
        ),
        within=1e-8,
        why="the solver stops at a residual of 1e-8 of the load",
        source="balance of the inner ring",
    )


def _check_shapes(page: Page, housed: Housed, loads: Floats) -> None:
    """The softest shapes are enough, and races give way by their compliance."""
    whole = equilibrium_on_races(housed.races, loads, shapes=144)
    page.vanishes(
        "peak rollers with the softest shapes less those with all, relative, the worst",
        float(np.abs(housed.flexible.rollers.max(axis=1) / whole.rollers.max(axis=1) - 1.0).max()),
        within=SOFTEST_LEFT_OUT,
        why="shapes left out add at most that share of its own softness to a contact",
        source="all 144 shapes",
        measure="reaction",
    )
    pushes = np.hstack([whole.rollers, whole.moments])
    page.vanishes(
        "recession of the races less compliance times rollers, over the largest",
        float(
            np.abs(whole.recession - pushes @ housed.races.compliance).max()
            / np.abs(whole.recession).max()
        ),
        within=1e-6,
        why="the residual of 1e-8 of the load may be one of the softest shape, which gives way a "
        "hundred times as far as they do in the mean",
        source="compliance from the solid",
    )


def _check_springs(page: Page, size: Size) -> None:
    """Rollers as springs that push and pull: the joint `rollers` of the scene."""
    unit = f"bearing_units.{NAME}"
    rows = [{"x": x, "contact_angle": -np.sign(x) * CONTACT_ANGLE} for x in PLACES]
    scene = change_scene(
        housed_scene(size),
        {
            f"{unit}.interface": "rollers",
            f"{unit}.rollers": {"count": ROLLERS, "stiffness": SPRING, "rows": rows},
        },
    )
    races = housing_races(scene, NAME, _as_springs(SPRING))
    lines = np.array(joint_stiffness(scene.bearing_unit(NAME)))
    for name, k, exact, within, why, source in (
        (
            "as stiff as contacts",
            SPRING,
            np.array(unit_stiffness(scene, NAME, ring=False)),
            1e-4,
            "the same windows on the bore, their means taken by another quadrature",
            "solid of the housing with the joint 'rollers', inner ring rigid",
        ),
        (
            "soft",
            SOFT,
            SOFT / SPRING * lines,
            1e-3,
            "the housing is more than 1e4 times as stiff",
            "the joint 'rollers' between rigid rings",
        ),
    ):
        reference = exact[np.ix_(FIVE, FIVE)]
        scale = np.sqrt(np.outer(reference.diagonal(), reference.diagonal()))
        tangent = _preloaded(Races(_as_springs(k), races.compliance))
        page.vanishes(
            f"rollers as springs, {name}: stiffness less that of {source}, over its diagonal",
            float(np.abs((tangent - reference) / scale).max()),
            within=within,
            why=why,
            source=source,
            measure="deflection",
        )


def _as_springs(stiffness: float) -> Bearing:
    """Rollers of the scene's joint, that never lift off and have no lean."""
    radius = RACEWAY / 2.0 - 0.03
    rows = []
    for x in PLACES:
        angle = float(np.radians(-np.sign(x) * CONTACT_ANGLE))
        rows.append(
            RollerRow(
                ROLLERS,
                x - 0.03 * float(np.tan(angle)),
                radius,
                angle,
                0.06,
                WIDTH / 2.0 * float(np.cos(angle)),
                linear(stiffness),
                clearance=-5e-4,
                laminae=1,
                phase=float(np.pi),  # the scene counts from the left
            )
        )
    return Bearing("rollers as springs", tuple(rows))


def _preloaded(races: Races) -> Floats:
    """(5, 5) stiffness at rest, from small loads."""
    k = races.bearing.rows[0].law.stiffness
    load = 1e-6 * k  # small beside the preload
    loads = np.vstack([np.zeros(5), load * np.eye(5)])
    u = equilibrium_on_races(races, loads, shapes=144, tolerance=1e-13).displacements
    return np.asarray(np.linalg.inv((u[1:] - u[0]).T / load))


def _show(page: Page, housed: Housed, name: str) -> None:
    """Polar chart of both rows."""
    k, bearing = list(LOADS).index(name), housed.races.bearing
    traces, first = [], 0
    for row, of in zip(bearing.rows, ("upwind", "downwind"), strict=True):
        psi, n = angles(row), len(angles(row))
        for rings, loads, dash in (
            ("rigid rings", housed.rigid[k], "dot"),
            ("flexible housing", housed.flexible.rollers[k], "solid"),
        ):
            Q = loads[first : first + n] / 1e3
            if Q.max() > 0.0:
                closed = np.r_[np.arange(n), 0]
                right, up = (Q * np.cos(psi))[closed], (Q * np.sin(psi))[closed]
                traces.append(trace(f"{of}, {rings}", right, up, line={"dash": dash}))
        first += n
    page.add(
        _square(
            chart(
                f"Load of each roller towards its place, {name}",
                traces,
                "to the right, looking downwind [kN]",
                "upwards [kN]",
            )
        )
    )


def _square(drawn: Chart) -> Chart:
    """The same scale on both axes."""
    drawn.figure["layout"]["yaxis"]["scaleanchor"] = "x"
    return drawn
