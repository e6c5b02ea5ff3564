"""Error against time on a flexible housing: rigid rings, few shapes, all shapes, gap springs."""

import time

import numpy as np

from fe_drivetrain.bearing import (
    SOFTEST_LEFT_OUT,
    Races,
    catalogue_bearing,
    equilibrium_on_races,
)
from fe_drivetrain.bearing_life.rings import housing_races, housing_solid
from fe_drivetrain.cases import case
from fe_drivetrain.cases.bearing.gap_springs import PART, calculix_rollers
from fe_drivetrain.cases.bearing.peak_rollers import (
    CROWN,
    ERROR,
    FIVE,
    LOADS,
    TIME,
    WORST_CHART,
    Rung,
    Solve,
    closed_form,
    error_against_time,
    largest_of_loads,
    peak_row,
    peaks,
    timed_rungs,
)
from fe_drivetrain.cases.references.housed_bearing import (
    ASSUMED_HOUSING,
    NAME,
    bearing_s,
    housed_scene,
)
from fe_drivetrain.common import Floats, MissingToolError
from fe_drivetrain.export import find_calculix
from fe_drivetrain.report import rolling_elements
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run

SIZE, QUICK_SIZE = (1.6, None), (3.6, 8)
ALL = 144
REFERENCE_LAMINAE = 200

RIGID, PROFILED = "rigid rings, straight rollers", "rigid rings, 30 laminae with profile"
FEW = "40 shapes"
CHOSEN = "40 shapes, 30 laminae with profile"
SPRINGS = "gap springs in CalculiX, rollers without length"


def on_races(compliance: Floats, shapes: int) -> Solve:
    """A rung of the ladder: peaks on races with so many shapes."""
    return peaks(
        lambda bearing, loads: (
            equilibrium_on_races(
                Races(bearing, compliance), loads, shapes=shapes, warm=False
            ).rollers
        )
    )


def rungs(compliance: Floats) -> tuple[Rung, ...]:
    """Name, changes of the bearing, and how its peak roller is found, cheap to expensive."""
    profile = {"laminae": 30, "crown": CROWN}
    return (
        ("closed form, loads added", {}, closed_form),
        (RIGID, {"laminae": 0}, FIVE),
        (PROFILED, profile, FIVE),
        ("10 shapes", {"laminae": 0}, on_races(compliance, 10)),
        ("20 shapes", {"laminae": 0}, on_races(compliance, 20)),
        (FEW, {"laminae": 0}, on_races(compliance, 40)),
        (CHOSEN, profile, on_races(compliance, 40)),
        ("all shapes, 30 laminae with profile", profile, on_races(compliance, ALL)),
    )


@case(
    "Flexible housing: error against time, from closed form to gap springs of a solid",
    source="bearing S in the library's housing, all shapes and profiled rollers as reference",
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Time each rung over many load cases of each kind; compare with the finest."""
    n = 20 if run.quick else 500
    size = QUICK_SIZE if run.quick else SIZE
    with run.step("condense the housing"):
        begin = time.perf_counter()
        # not `housed_races`, which another case of this process may have found
        C = housing_races(housed_scene(size), NAME, bearing_s()).compliance
        condensed = time.perf_counter() - begin
    finest = catalogue_bearing("bearing_s_o20", laminae=REFERENCE_LAMINAE, crown=CROWN)
    rows: list[Record] = []
    for kind, load in LOADS.items():
        loads = np.array([load] * n, dtype=float)
        with run.step(kind):
            exact = float(on_races(C, ALL)(finest, loads[:1])[0])
            rows += timed_rungs(kind, rungs(C), "bearing_s_o20", loads, exact)
            rows += _springs(run, kind, C, size, exact)
    check(page, {(r["load"], r["model"]): r[ERROR] for r in rows})
    answer(page, rows, condensed)
    error_against_time(page, rows, CHOSEN)
    page.assume_all(ASSUMED_HOUSING)
    page.text(
        "Gap springs have rollers without length, and their time is that of CalculiX for one load "
        "case with the motion of the inner ring given, which has to be found besides."
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(finest)))


def answer(page: Page, rows: list[Record], condensed: float) -> None:
    """State the error and the time of the model to choose, beside rigid rings."""
    of_model = {row["model"]: row for row in largest_of_loads(rows)}
    worst = {name: of_model[name][ERROR] for name in (RIGID, PROFILED, FEW, CHOSEN)}
    micro = of_model[CHOSEN][TIME]
    short = {RIGID: "rigid rings, straight rollers", PROFILED: "rigid rings, profiled rollers"}
    short |= {FEW: "40 shapes, straight rollers", CHOSEN: "40 shapes, profiled rollers"}
    page.answer(
        "Which model of a bearing in a flexible housing is accurate, and how fast is it?",
        "40 ring shapes and profiled rollers give the peak roller load within "
        f"{percent_text(worst[CHOSEN] / 100.0)} in {micro / 1e3:.2g}\u00a0ms; rigid rings and "
        f"straight rollers within {percent_text(worst[RIGID] / 100.0)}.",
        [
            page.value("time per load case, 40 shapes, profiled rollers [ms]", micro / 1e3),
            *(page.value(f"largest error, {short[n]} [%]", worst[n]) for n in reversed(worst)),
            page.value("time to condense the housing, once [s]", condensed),
        ],
        WORST_CHART,
        [
            f"Errors are differences from all {ALL} shapes with {REFERENCE_LAMINAE} laminae per "
            "roller, on the same mesh: the error of the mesh is not in them."
        ],
    )


def check(page: Page, at: dict[tuple[str, str], float]) -> None:
    """Errors [%] by load and model: of the finest rung, and of shapes that are left out."""
    for kind in LOADS:
        page.at_most(
            f"{kind}: error of all shapes and 30 laminae with profile",
            at[kind, "all shapes, 30 laminae with profile"],
            0.5,
            why="midpoint rule with 30 laminae on rollers that lean",
            source=f"{REFERENCE_LAMINAE} laminae",
            unit="%",
            basis="self-consistency",
        )
        page.at_most(
            f"{kind}: 40 shapes less all, with profile",
            abs(at[kind, CHOSEN] - at[kind, "all shapes, 30 laminae with profile"]),
            100.0 * SOFTEST_LEFT_OUT,
            why="shapes left out add at most that share of its own softness to a contact",
            source="all shapes",
            unit="%",
            basis="self-consistency",
        )


def _springs(
    run: Run, kind: str, C: Floats, size: tuple[float, int | None], exact: float
) -> list[Record]:
    """The contact of the whole solid, where CalculiX is installed; one load in a quick run."""
    try:
        find_calculix()
    except MissingToolError:
        return []
    if run.quick and kind != "radial":
        return []
    scene = housed_scene(size)
    bearing = catalogue_bearing("bearing_s_o20", laminae=1)
    solid = housing_solid(scene, NAME, bearing)
    u = equilibrium_on_races(Races(bearing, C), LOADS[kind], shapes=ALL).displacements[0]
    begin = time.perf_counter()
    deck = run.folder / f"{kind.replace(' ', '_').replace(',', '')}.inp"
    rollers = calculix_rollers(deck, solid, bearing, scene.material_of(PART), u)
    seconds = time.perf_counter() - begin
    return [peak_row(kind, SPRINGS, seconds, float(rollers.max()), exact)]
