"""What the choice of model does to the life of a main bearing: from a pinned beam to solids."""

import time
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.bearing import (
    Races,
)
from fe_drivetrain.bearing_life.coupled import scene_body
from fe_drivetrain.bearing_life.rings import (
    RollerAssembly,
    housing_races,
    roller_assembly,
)
from fe_drivetrain.cases import case
from fe_drivetrain.cases.life import models
from fe_drivetrain.cases.life.operating import state_assumptions, state_meaning
from fe_drivetrain.cases.life.second_ways import second_ways
from fe_drivetrain.cases.references.housed_bearing import ASSUMED_HOUSING, NAME, Size, housed_scene
from fe_drivetrain.cases.references.studied_lives import (
    SPEEDS,
    Setup,
    Winds,
    at_site,
    bearing_s,
    by_wind,
    scatter_of_seeds,
    shares,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.report import Chart, trace
from fe_drivetrain.report.suite import Page, Record, Run

MEAN_WIND = 8.0

#: Meshes of the solids, coarse to fine.
SIZES: tuple[Size, ...] = ((3.6, 8), (1.6, None))

#: Load steps that times are given for: 330 histories of ten minutes, each step two seconds.
MANY = 100_000

#: Error of life that is near enough [%].
NEAR = 20.0

HERO = "Error of life against time, by model and ground of the housing"

LIFE = "life at the site [years]"
OVER = "life over that of the best model"
WRONG = "life at the site wrong by [%]"
ALONG = "life wrong over wind speeds by [%]"
LOAD = "equivalent load wrong by [%]"
TIME = "processor time of 100 000 load steps, with what is solved once [s]"
MESH = "mesh changes it by [%]"
STEP = "processor time of a step [us]"
ONCE = "solved once [s]"

#: Models that know the housing, whose solid has to be solved once.
OF_HOUSING = (
    models.SPRING,
    models.SERIES,
    models.THREE,
    models.STRAIGHT,
    models.FIVE_DEGREES,
    models.FLEXIBLE,
)


@dataclass(frozen=True)
class Solved:
    """A housing's mesh: races and solids, and the processor time of each [s]."""

    races: Races
    solids: RollerAssembly | None
    races_time: float
    solids_time: float


@dataclass(frozen=True)
class Found:
    """Lives (winds, steps) of all models on one ground, and processor time of a load step [s]."""

    lives: dict[str, Floats]
    times: dict[str, float]

    def years(self, model: str) -> Floats:
        """At each wind speed."""
        return by_wind(self.lives[model])


@case(
    "What the choice of model does to the life of a main bearing",
    source="bearing S in the library's housing; Stirling 2023, chapters 3 to 5",
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Lives of eleven models over eleven wind speeds on two grounds, against solids on rollers."""
    state_assumptions(page)
    page.assume_all(ASSUMED_HOUSING)
    elements = 12 if run.quick else 36
    bearing = bearing_s("bearing_s_o20", True, elements)
    winds = Winds(seeds=2, duration=20.0, rate=0.2) if run.quick else Winds(seeds=3, rate=0.25)
    with run.step("hub loads"):
        hub = winds.hub_loads()
    setup = Setup(bearing, scene_body(housed_scene(SIZES[0]), level=1))
    meshes = []
    for size in SIZES[:1] if run.quick else SIZES:
        with run.step(f"solids, mesh {size[0]:g}"):
            meshes.append(solved(setup, size, with_solids=not run.quick))
    rows: list[Record] = []
    by_ground: dict[str, tuple[Found, str]] = {}
    for ground, compliance in models.GROUNDS.items():
        world = models.World(setup, meshes[-1].races, meshes[-1].solids, compliance)
        with run.step(f"lives, {ground}"):
            found = every_model(world, hub)
        best = models.FLEXIBLE if run.quick else models.SOLIDS
        of_ground = records(found, ground, best, meshes[-1])
        rows += of_ground
        if not run.quick:
            coarse = replace(world, solids=meshes[0].solids)
            with run.step(f"coarser mesh, {ground}"):
                band(page, coarse, hub, ground, of_ground)
        by_ground[ground] = (found, best)
        some = hub[:: 5 if run.quick else 2, :: max(1, hub.shape[1] // 10)].reshape(-1, 6)
        if not (run.quick and compliance.any()):
            with run.step(f"second ways, {ground}"):
                second_ways(page, world, some, ground)
        error = float(scatter_of_seeds(found.lives[best], winds.seeds, MEAN_WIND))
        page.data(f"standard error of the best model's logarithm of life, {ground} [-]", error)
    ladder(page, rows)
    for ground, (found, best) in by_ground.items():
        by_wind_speed(page, found, ground, best)
    if not run.quick:
        with run.step("face to face"):
            other = face_to_face(page, setup, hub[:, ::3], rows)
    answers(page, rows)
    if not run.quick:
        page.say(other)
    state_meaning(page)


def solved(setup: Setup, size: Size, with_solids: bool) -> Solved:
    """Solve the housing, and the whole scene, at the rollers."""
    scene, begin = housed_scene(size), time.process_time()
    races = housing_races(scene, NAME, setup.bearing)
    middle = time.process_time()
    solids = roller_assembly(scene, {NAME: setup.bearing}) if with_solids else None
    return Solved(races, solids, middle - begin, time.process_time() - middle)


def every_model(world: models.World, hub: Floats) -> Found:
    """Lives and times of all models."""
    flat = hub.reshape(-1, 6)
    shape = hub.shape[:2]
    begin = time.process_time()
    lives = {models.CATALOGUE: models.catalogue_lives(world.setup, flat).reshape(shape)}
    times = {models.CATALOGUE: (time.process_time() - begin) / len(flat)}
    for name, model in models.MODELS.items():
        if name in (models.SOFTEST, models.SOLIDS) and world.solids is None:
            continue
        model(world, flat[:3])  # compiles, and fills caches
        begin = time.process_time()
        laminae = model(world, flat)
        times[name] = (time.process_time() - begin) / len(flat)
        lives[name] = models.lives(world.setup, len(flat), laminae).reshape(shape)
    return Found(lives, times)


def records(found: Found, ground: str, best: str, mesh: Solved) -> list[Record]:
    """Life, error and time of each model on a ground."""
    rows: list[Record] = []
    exact = at_site(found.years(best), MEAN_WIND)
    for name, seconds in found.times.items():
        life = at_site(found.years(name), MEAN_WIND)
        once = mesh.races_time if name in OF_HOUSING else 0.0
        once = mesh.solids_time if name in (models.SOFTEST, models.SOLIDS) else once
        rows.append(
            {
                "housing on": ground,
                "model": name,
                LIFE: life,
                OVER: life / exact,
                WRONG: wrong(life / exact),
                ALONG: along(found.years(name), found.years(best)),
                LOAD: 100.0 * ((life / exact) ** -0.25 - 1.0),
                STEP: 1e6 * seconds,
                ONCE: once,
                TIME: once + MANY * seconds,
            }
        )
    return rows


def wrong(ratio: float) -> float:
    """How far a life is wrong, too long or too short [%]: a factor of two is 100 %."""
    return 100.0 * (max(ratio, 1.0 / ratio) - 1.0)


def along(life: Floats, exact: Floats) -> float:
    """How far lives at all wind speeds are wrong [%]: root mean square by share of damage.

    A model whose life at a site is right by chance, too long here and too short there, is not.
    """
    mean = np.average(np.log(life / exact) ** 2, weights=shares(exact, MEAN_WIND))
    return 100.0 * float(np.expm1(np.sqrt(mean)))


def band(page: Page, coarse: models.World, hub: Floats, ground: str, rows: list[Record]) -> None:
    """What the mesh changes of the best model, and whether that could reorder the others."""
    flat = hub.reshape(-1, 6)
    lives = models.lives(coarse.setup, len(flat), models.solids(coarse, flat))
    life = at_site(by_wind(lives.reshape(hub.shape[:2])), MEAN_WIND)
    best = next(row for row in rows if row["model"] == models.SOLIDS)
    change = wrong(life / best[LIFE])
    best[MESH] = change
    rigid = next(row for row in rows if row["model"] == models.RIGID)
    page.at_most(
        f"{ground}: what the mesh changes of the best life, over the error of a rigid housing",
        change / rigid[WRONG],
        0.25,
        why="a mesh that changed more would leave the order of models open",
        source=f"meshes {SIZES[0][0]:g} and {SIZES[1][0]:g} times the size of the scene's",
        measure="identity",
    )


def by_wind_speed(page: Page, found: Found, ground: str, best: str) -> None:
    """Life of each model over that of the best, at each wind speed."""
    page.section(f"Life error by wind speed, {ground}")
    exact = found.years(best)
    page.chart(
        f"Life over that of the best model ({best}), housing on {ground}",
        [
            trace(
                name,
                SPEEDS,
                found.years(name) / exact,
                mode="lines+markers",
                line={"color": COLORS[name]},
            )
            for name in found.lives
            if name != best
        ]
        + [trace("best model", SPEEDS[[0, -1]], [1.0, 1.0], line={"dash": "dot", "color": "#000"})],
        "mean wind speed [m/s]",
        "life over that of the best model",
        "y",
    )
    tall(page)
    rows: list[Record] = [
        {"model": name, **{f"{v:g} m/s": float(life) for v, life in zip(SPEEDS, of, strict=True)}}
        for name in found.lives
        for of in [found.years(name)]
    ]
    page.table(f"Basic reference life [years] by mean wind speed, housing on {ground}", rows)
    page.data(f"life by wind speed [years], {ground}", rows)


def face_to_face(page: Page, setup: Setup, hub: Floats, rows: list[Record]) -> str:
    """The same ladder with the other arrangement, on the coarser mesh and a third of the steps."""
    other = replace(setup, bearing=bearing_s("bearing_s_x20", True))
    mesh = solved(other, SIZES[0], with_solids=True)
    ratios: dict[str, Record] = {
        name: {"model": name} for name in [models.CATALOGUE, *models.MODELS]
    }
    for ground, compliance in models.GROUNDS.items():
        found = every_model(models.World(other, mesh.races, mesh.solids, compliance), hub)
        best = found.years(models.SOLIDS)
        own = {row["model"]: row for row in rows if row["housing on"] == ground}
        for name, record in ratios.items():
            life = found.years(name)
            record[f"back to back, {ground}"] = own[name][OVER]
            record[f"face to face, {ground}"] = at_site(life, MEAN_WIND) / at_site(best, MEAN_WIND)
            record[f"its error over wind speeds, {ground} [%]"] = along(life, best)
    page.section("Face to face")
    page.table(
        "Life at the site over that of the best model, of both arrangements at 20 deg",
        [*ratios.values()],
    )
    page.data("face to face", [*ratios.values()])

    def errors(name: str) -> str:
        return " and ".join(
            f"{ratios[name][f'its error over wind speeds, {ground} [%]']:.0f}"
            for ground in models.GROUNDS
        )

    return (
        f"Face to face flexible rings matter more: five degrees with the housing in series are "
        f"wrong by {errors(models.FIVE_DEGREES)} % on the two grounds, a beam on flexible rings by "
        f"{errors(models.FLEXIBLE)} %."
    )


def tall(page: Page) -> None:
    """Give the chart that was added last room for its many curves, their names beside it."""
    drawn = page.sections[-1].items[-1]
    assert isinstance(drawn, Chart)
    beside = {"orientation": "v", "x": 1.01, "xanchor": "left", "y": 1.0, "yanchor": "top"}
    drawn.figure["layout"] |= {"height": 520, "legend": beside}


COLORS = {
    models.CATALOGUE: "#999999",
    models.PINNED: "#555555",
    models.SPRING: "#e69f00",
    models.SERIES: "#b59a00",
    models.THREE: "#7f5f00",
    models.RIGID: "#d55e00",
    models.STRAIGHT: "#cc79a7",
    models.FIVE_DEGREES: "#0072b2",
    models.FLEXIBLE: "#009e73",
    models.SOFTEST: "#56b4e9",
    models.SOLIDS: "#000000",
}


def ladder(page: Page, rows: list[Record]) -> None:
    """Error against time of all models on both grounds."""
    page.section("Error against time")
    grounds = list(models.GROUNDS)
    traces = []
    chosen = [nearest(rows, ground) for ground in grounds]
    # of the softest shapes what is left is far below what the mesh changes
    shown = [row for row in rows if row[ALONG] > 0.0 and row["model"] != models.SOFTEST]
    for name in dict.fromkeys(row["model"] for row in shown):
        of = [row for row in shown if row["model"] == name]
        symbols = ["circle" if row["housing on"] == grounds[0] else "diamond-open" for row in of]
        sizes = [20 if row in chosen else 12 for row in of]
        traces.append(
            trace(
                name,
                [row[TIME] for row in of],
                [row[ALONG] for row in of],
                mode="lines+markers",
                line={"color": COLORS[name], "width": 1, "dash": "dot"},
                marker={"size": sizes, "color": COLORS[name], "symbol": symbols},
            )
        )
    meshes = [row for row in rows if row.get(MESH)]
    ends = [min(row[TIME] for row in shown), max(row[TIME] for row in shown)]
    for row, dash in zip(meshes, ("dash", "dot"), strict=False):
        words = f"mesh of the best model, {row['housing on']}"
        line = {"color": "#999999", "dash": dash}
        traces.append(trace(words, ends, [row[MESH]] * 2, line=line))
    page.chart(HERO, traces, TIME, ALONG, "xy")
    tall(page)
    page.text(
        f"Filled circles: housing on a {grounds[0]}; open diamonds: on {grounds[1]}, which tilts "
        "by 145 and 392 MN m/rad; large: the cheapest that is near enough. Dashed: what the mesh "
        "changes of the best model. 100 % is twice or half the life; root mean square over wind "
        f"speeds, each by its share of the damage at a site of {MEAN_WIND:g} m/s."
    )
    columns = [key for key in rows[0] if key not in (TIME, WRONG)]
    if meshes:
        columns.append(MESH)
    page.table("Models, cheap to expensive", rows, columns)
    page.data("models", rows)
    page.text(
        "All models have the same bearing, profile, stress riser, hub loads and, where they have a "
        "place for one, housing. K_R of the housing is that of its solid with the races held in "
        "shape; K_R of housing and rollers is the slope of moments over tilts of five degrees with "
        "the housing in series, over all loads. The best model has all "
        "solids between the rollers: shaft, inner ring, housing; the beam on flexible rings has a "
        "rigid inner ring. The ground is a rigid body on springs below the foot; the soft one has "
        "the K_R of the thesis's housing, 145 and 392 MN m/rad. Times leave out "
        "what is common to all, from laminae to lives."
    )


def answers(page: Page, rows: list[Record]) -> None:
    """What each step of the ladder brings."""
    for ground in models.GROUNDS:
        at = {row["model"]: row for row in rows if row["housing on"] == ground}

        def times(name: str, at: dict[str, Record] = at) -> str:
            ratio = at[name][OVER]
            return f"{ratio:.2g} times" if ratio < 10.0 else f"{ratio:.0f} times"

        page.say(
            f"Housing on a {ground}: of the best model's life a pinned beam has "
            f"{times(models.PINNED)}, a beam on K_R of the housing {times(models.SPRING)}, on K_R "
            f"of housing and rollers {times(models.SERIES)}, five degrees in a rigid housing "
            f"{times(models.RIGID)}, with the housing in series {times(models.FIVE_DEGREES)}, on "
            f"flexible rings {times(models.FLEXIBLE)}."
        )
    rigid, soft = (
        next(r for r in rows if (r["housing on"], r["model"]) == (g, models.RIGID))
        for g in models.GROUNDS
    )
    page.say(
        "A pinned beam leaves out the moment, and promises too much; a rigid housing takes too "
        f"much of it: {rigid[LOAD]:+.0f} and {soft[LOAD]:+.0f} % in equivalent load are lives of "
        f"{rigid[OVER]:.2f} and {soft[OVER]:.2f}."
    )
    answer(page, rows)


def in_words(model: str) -> str:
    """Name of a model within a sentence."""
    article = "a " if model.startswith("beam") else ""
    return article + model.replace(",", " with").replace("five degrees", "five degrees of freedom")


def nearest(rows: list[Record], ground: str) -> Record:
    """The cheapest model on a ground whose lives are near enough at all wind speeds."""
    near = (row for row in rows if row["housing on"] == ground and row[ALONG] <= NEAR)
    return min(near, key=lambda row: float(row[TIME]))


def answer(page: Page, rows: list[Record]) -> None:
    """State which model is enough, and what the simple ones promise."""
    fixed, soft = models.GROUNDS
    of = {(row["housing on"], row["model"]): row for row in rows}
    near = {ground: nearest(rows, ground) for ground in models.GROUNDS}
    names = {ground: in_words(str(row["model"])) for ground, row in near.items()}
    pinned = of[fixed, models.PINNED]
    shown = {
        f"{words}, {ground}": of[ground, name]
        for ground in (fixed, soft)
        for words, name in (("pinned beam", models.PINNED), ("rigid housing", models.RIGID))
    }
    page.answer(
        f"Which is the cheapest model whose lives are within {NEAR:g}\u00a0% of the best one's?",
        f"Within {NEAR:g}\u00a0%, the cheapest model is {names[fixed]}"
        + (
            ", on a fixed foot and on soft ground."
            if names[fixed] == names[soft]
            else f" (fixed foot) or {names[soft]} (soft ground)."
        ),
        [
            *(
                page.value(f"error of life, {row['model']}, {ground} [%]", row[ALONG], at_most=NEAR)
                for ground, row in near.items()
            ),
            *(
                page.value(f"life over the best model's, {words}", row[OVER], beside=1.0, by="best")
                for words, row in shown.items()
            ),
        ],
        hero=HERO,
        cautions=[
            f"A pinned beam promises {pinned[OVER]:.2g} times the life of the best model on a "
            f"fixed foot, {of[soft, models.PINNED][OVER]:.2g} times on soft ground.",
            "A model counts if lives at all wind speeds are near, each weighted by its damage: "
            "over a whole site errors may cancel.",
            "Rows are back to back; face to face flexible rings matter more. In five degrees of "
            "freedom the bearing moves and tilts in all directions, but turns freely.",
        ],
    )
