"""Loads and motions at the interfaces of one drivetrain: statics, finite elements, dynamics."""

import json

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.own_three_points import own_three_points
from fe_drivetrain.common import FORCES, Floats
from fe_drivetrain.comparison import ConvergenceInTime, InTime, converge_in_time, peak_between
from fe_drivetrain.drivetrain_file import Scene, library_scene
from fe_drivetrain.procedure import (
    LoadTable,
    Mounts,
    ThreePoints,
    analysed,
    filled_table,
    imbalance,
    level_loads,
    listed_quantities,
    moving_energy_error,
    moving_three_points,
    three_point_loads,
    write_load_csv,
    write_load_json,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time
from fe_drivetrain.report.suite.chosen import SETTING
from fe_drivetrain.shafts.fidelity import shaft_level
from fe_drivetrain.turbine_loads.hub_loads import Condition, hub_loads

SCENE, ARMS = "three_point_suspension", 2.0  # m between the arms, as the scene's source has them
MASSES = {"shaft": 8e3, "gearbox": 15e3, "generator": 7e3}  # kg
RATIO, SECONDS = 100.0, 2e-3  # -, damping over stiffness [s]
SPEED = 1.9  # rad/s, rated
HIDDEN = ("levels", "seconds", "table", "rms of 600 s", "rank")
IN_WORDS = {
    "Fx": "axial force",
    "Fy": "side force",
    "Fz": "vertical force",
    "Mx": "torque",
    "My": "tilt moment",
    "Mz": "yaw moment",
}
IN_TIME = "The load in which inertia matters most, by model"
SHOWN = ("main bearing", "gearbox entrance")
SECONDS_BETWEEN = 30.0  # of the history in which the motion is resolved between samples


@case(
    "Loads, displacements and accelerations at all interfaces: statics, finite elements, dynamics",
    source="PROTEST 2010, ECN-E--10-100, Table 4.5; three-point suspension of 1.5 MW",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise three_point_suspension)",
        "arms": "NUMBER (m, between the torque arms of your own, otherwise in proportion)",
        "generator_mass": "NUMBER (kg, where the generator of your own only turns in its file)",
    },
)
def run(run: Run, page: Page) -> None:
    """One history of hub loads through three models; each in equilibrium in every row."""
    made = hub_loads(Condition(16.0, "medium", 0.2, 1), duration=30.0 if run.quick else 600.0)
    time, hub, speed = made.time, made.loads, SPEED
    own = SETTING in run.settings
    if own:
        of = own_three_points(run, page, float(hub[:, 3].mean()))
        scene, places, mounts, speed = of.scene, of.places, of.mounts, of.speed
        hub = hub * of.hub_scale
    else:
        scene = library_scene(SCENE)
        page.about(scene)
        places, mounts = drivetrain(scene)
    with run.step("dynamics"):
        moving = moving_three_points(places, mounts, time, hub)
        without = moving_three_points(places, mounts, time, hub, weight=False)
    with run.step("finite elements"):
        elements = level_loads(scene, shaft_level(scene, 2), time, hub)
    static = three_point_loads(places, time, hub)
    # of hub loads alone: the weights are those of the first row without any load
    rest = three_point_loads(places, time[:1], np.zeros((1, 6)))
    check_equilibrium(page, {"dynamics": moving, "finite elements": elements, "statics": static})
    check_gearing(page, moving, places.ratio)
    bearing = scene.bearing_units[0]
    if bearing.interface == "sliding" and not scene.gearbox.stiffness[4]:
        check_vertical_forces(page, hub, static, elements, rest)
    worst = beside(page, hub, static, elements, without, rest)
    motions(page, moving, elements)
    with run.step("between samples"):
        peaks = between_samples(page, places, mounts, time, hub, 128.0 if own else 32.0)
    answer(page, worst, peaks, own)
    for table, name in ((moving, "interfaces"), (elements, "interfaces_elements")):
        write_load_csv(table, run.folder / f"{name}.csv")
        write_load_json(table, run.folder / f"{name}.json")
    published_table(run, page, moving, places.ratio, speed)
    show_all(page, moving)
    if own:
        return
    for name, mass in MASSES.items():
        page.assume(f"mass of the {name}", mass, "kg", "of such machines, round")
    page.assume("ratio", RATIO, "", "of such machines, round")
    page.assume("speed of the rotor", SPEED, "rad/s", "of such machines, round")
    page.assume("stiffness, inertia", "see the case", "", "all but the arms, which are the scene's")


def answer(page: Page, worst: Record, peaks: ConvergenceInTime, own: bool) -> None:
    """State where inertia matters most, and peaks at the interfaces."""
    component, _, unit = str(worst["component"]).partition(" ")
    unit = unit.strip("[]")
    place = f"{IN_WORDS[component]} at the {worst['interface']}"
    moves, rests = (float(worst[f"{model}: deviation"]) for model in ("dynamics", "statics"))
    small = rests < 0.1 * moves
    page.answer(
        "Is a static calculation enough for the loads at a drivetrain's interfaces?",
        f"{'No' if small else 'Yes'}: the {place} varies by {value_text(moves, unit)} (standard "
        f"deviation) in a dynamic calculation, by {value_text(rests, unit)} in a static one.",
        [
            page.value(
                f"standard deviation of {place} [{unit}]", moves, beside=rests, by="statics"
            ),
            page.value(
                "the same by finite elements [" + unit + "]",
                float(worst["finite elements: deviation"]),
                beside=rests,
                by="statics",
            ),
            *(
                page.value(f"peak {key}", peaks.value(key), peaks.step_band(key))
                for key in list(peaks.finest.values)[:1] + list(peaks.finest.values)[3:]
            ),
        ][:6],
        hero=IN_TIME,
        cautions=[
            "What the file does not state is that of a machine of 1.5 MW, in proportion."
            if own
            else "All masses, stiffnesses and inertias are assumed, except those of the arms.",
            "Peaks are those of the load history's first "
            f"{SECONDS_BETWEEN:g} s, resolved between samples.",
        ],
    )


def check_equilibrium(page: Page, tables: dict[str, LoadTable]) -> None:
    """Every body of each model is in equilibrium in every row."""
    for name, table in tables.items():
        page.vanishes(
            f"{name}: largest error of equilibrium of any body in any row",
            max(float(np.abs(imbalance(table, body.name)).max()) for body in table.bodies),
            within=1e-9,
            why="rounding, relative to the largest load on the body",
            source="forces and moments of all interfaces, weight and inertia",
        )


def check_gearing(page: Page, moving: LoadTable, ratio: float) -> None:
    """Torques of both sides of the gearbox have its ratio."""
    entrance = moving.interface("gearbox entrance").loads[:, 3]
    output = moving.interface("high-speed shaft").loads[:, 3]
    page.vanishes(
        "dynamics: torque of the entrance and ratio times that of the high-speed shaft, difference",
        float(np.abs(entrance + ratio * output).max() / np.abs(entrance).max()),
        within=1e-12,
        why="rounding: both come of one spring",
        source="gearing, without losses",
        basis="self-consistency",
    )


def check_vertical_forces(
    page: Page, hub: Floats, static: LoadTable, elements: LoadTable, rest: LoadTable
) -> None:
    """Vertical forces are determined: elements have those of statics."""
    determined = [
        float(
            np.abs(
                sign * elements.interface(name).loads[:, 2]
                - static.interface(name).loads[:, 2]
                + rest.interface(name).loads[:, 2]
            ).max()
            / np.abs(hub[:, 2]).max()
        )
        for name, sign in (("main bearing", -1.0), ("gearbox entrance", 1.0))
    ]
    page.vanishes(
        "vertical forces of finite elements and statics, largest difference over that of the hub",
        max(determined),
        within=1e-6,
        why="the arms do not resist a turn about y: vertical forces follow from equilibrium",
        source="statics",
        measure="identity",
    )


def show_all(page: Page, moving: LoadTable) -> None:
    """Statistics of the loads and motions at all interfaces."""
    page.section("All interfaces")
    rows = [
        {k: v for k, v in row.items() if not isinstance(v, list) and k != "source"}
        for row in analysed(moving)
        if max(abs(row["least"]), abs(row["largest"])) > 0.0
    ]
    page.table("Dynamics, at samples: mean, extremes and equivalent values at 1 Hz by slope", rows)
    page.text(
        "The files hold each row, and interfaces.json also the duration distribution and the "
        "rainflow cycles of each component. Displacements are from steady turning."
    )


def between_samples(
    page: Page,
    places: ThreePoints,
    mounts: Mounts,
    time: Floats,
    hub: Floats,
    steps: float,
) -> ConvergenceInTime:
    """Energy of the dynamics, and peaks that fall between samples of the loads."""
    sample = float(time[1] - time[0])
    upto = float(min(SECONDS_BETWEEN, time[-1] - time[0]))

    def run(step: float, _: int) -> InTime:
        fine = np.asarray(step * np.arange(round(upto / step) + 1), dtype=np.float64)
        loads = np.column_stack([np.interp(fine, time - time[0], c) for c in hub.T])
        lost = moving_energy_error(places, mounts, fine, loads)
        return InTime(peaks_of(moving_three_points(places, mounts, fine, loads)), lost)

    found = converge_in_time(run, sample / steps)
    at_samples = run(sample, 0).values
    page.section("Between samples")
    check_in_time(
        page,
        "dynamics",
        found,
        dict.fromkeys(at_samples, 0.01),
        energy=1e-4,
        why="integrals of the fourth order of the step, over what springs hold",
    )
    missed = {key: found.value(key) / at_samples[key] - 1.0 for key in at_samples}
    worst = max(missed, key=lambda key: missed[key])
    page.text(
        "Files and tables have a row at each sample of the hub's loads, where the motion is exact. "
        f"In the first {upto:g} s, {worst.rpartition(' [')[0]} is {100.0 * missed[worst]:.2g} % "
        f"larger between samples, {1e3 * sample:g} ms apart, than at any of them; of "
        f"{len(missed)} peaks it is the one that is missed most."
    )
    return found


def peaks_of(moving: LoadTable) -> dict[str, float]:
    """Largest values of what the dynamics gives at interfaces."""
    bearing = moving.interface("main bearing").loads
    arm, hub = moving.interface("left arm"), moving.interface("hub")
    assert arm.accelerations is not None
    assert hub.displacements is not None
    return {
        "radial force of the main bearing [kN]": peak_between(np.hypot(*bearing[:, 1:3].T)) / 1e3,
        "vertical force of the left arm, upwards [kN]": peak_between(arm.loads[:, 2]) / 1e3,
        "vertical force of the left arm, downwards [kN]": peak_between(-arm.loads[:, 2]) / 1e3,
        "torque of the high-speed shaft [kN m]": peak_between(
            np.abs(moving.interface("high-speed shaft").loads[:, 3])
        )
        / 1e3,
        "vertical acceleration at the left arm [m/s^2]": peak_between(
            np.abs(arm.accelerations[:, 2])
        ),
        "vertical displacement of the hub [mm]": 1e3
        * peak_between(np.abs(hub.displacements[:, 2])),
    }


def published_table(run: Run, page: Page, moving: LoadTable, ratio: float, speed: float) -> None:
    """Table 4.5 of the report, filled from the dynamics."""
    step = float(moving.time[1] - moving.time[0])
    rows = filled_table(listed_quantities().of("4.5"), channels_of(moving, ratio, speed), step)
    page.section("Table 4.5")
    shown: list[Record] = [
        {key: value for key, value in row.items() if key not in HIDDEN}
        | {"given": "yes" if row["given"] else "no"}
        for row in rows
    ]
    page.table("What the table asks for; durations are in table_4_5.json", shown)
    (run.folder / "table_4_5.json").write_text(json.dumps(rows), encoding="utf-8")
    page.text(
        "The coupling carries torque alone, so that the high-speed shaft has no other loads here; "
        "status, power, wind and temperatures are those of a turbine. Speeds are the rated one and "
        "what the dynamics adds."
    )
    asked = [row for row in rows if row["seconds"]]
    page.equals(
        "Table 4.5: shortest load duration, sum over levels [s]",
        min(sum(row["seconds"]) for row in asked),
        step * len(moving.time),
        within=1e-9,
        why="every sample is at one level",
        source="duration of the simulation",
        measure="identity",
    )


def channels_of(moving: LoadTable, ratio: float, speed: float) -> dict[str, Floats]:
    """Channels of Table 4.5 that a drivetrain in motion has."""
    step = float(moving.time[1] - moving.time[0])

    def moved(name: str) -> tuple[Floats, Floats]:
        part = moving.interface(name)
        assert part.displacements is not None
        assert part.accelerations is not None
        return part.displacements, part.accelerations

    entrance = moving.interface("gearbox entrance").loads
    names = ("axial force", "shear force y", "shear force z", "torque", "bending y", "bending z")
    found = {f"main shaft {n}": entrance[:, c] for c, n in enumerate(names)}
    found["high-speed shaft torque"] = moving.interface("high-speed shaft").loads[:, 3]
    for shaft, at, by in (
        ("main shaft", "main bearing", 1.0),
        ("high-speed shaft", "generator supports", ratio),
    ):
        u, _ = moved(at)
        found[f"{shaft} angle"] = by * speed * moving.time + u[:, 3]
        found[f"{shaft} speed"] = by * speed + np.gradient(u[:, 3], step)
        found[f"{shaft} axial displacement"] = u[:, 0]
    for side in ("left", "right"):
        u, _ = moved(f"{side} arm")
        for c, direction in enumerate(("axial", "tangential", "vertical")):
            found[f"{side} arm {direction} displacement"] = u[:, c]
    for place, at in (("entrance", "gearbox entrance"), ("output", "high-speed shaft")):
        _, a = moved(at)
        found |= {f"acceleration at {place} {axis}": a[:, c] for c, axis in ((1, "y"), (2, "z"))}
    found["azimuth"] = found["main shaft angle"] % (2.0 * np.pi)
    return found | {"rotor speed": found["main shaft speed"]}


def drivetrain(scene: Scene) -> tuple[ThreePoints, Mounts]:
    """The scene's places and arms; the rest is assumed."""
    rear = scene.shaft.front + scene.shaft.length
    places = ThreePoints(
        hub=scene.shaft.front,
        bearing=0.0,
        entrance=rear,
        arms=rear,
        output=rear + 1.5,
        generator=rear + 3.0,
        between_arms=ARMS,
        offset=0.5,
        shaft_mass=MASSES["shaft"],
        shaft_centre=0.3,
        gearbox_mass=MASSES["gearbox"],
        gearbox_centre=rear + 0.4,
        generator_mass=MASSES["generator"],
        ratio=RATIO,
    )
    k = [float(value) for value in scene.gearbox.stiffness]
    mounts = Mounts(
        bearing=(3e9, 3e9, 3e9),
        entrance=(2e9, 2e9, 2e9, 2e8, 2e8),
        arm=(k[0] / 2, k[1] / 2, k[2] / 2),
        supports=(5e7, 5e7, 5e7, 5e7, 5e7),
        torsion=1e4,
        grid=3e4,
        shaft=(3e3, 6e3),
        gearbox=(9e3, 1e4),
        generator=(60.0, 3e3),
        seconds=SECONDS,
    )
    return places, mounts


def beside(
    page: Page,
    hub: Floats,
    static: LoadTable,
    elements: LoadTable,
    moving: LoadTable,
    rest: LoadTable,
) -> Record:
    """Statistics of loads that the hub's bring about, by model; where inertia matters most."""
    rows: list[Record] = []
    found: list[dict[str, Floats]] = []
    for name in SHOWN:
        sign = -1.0 if name == "main bearing" else 1.0  # of the shaft on the bearing, by the levels
        by_model = {
            "statics": static.interface(name).loads - rest.interface(name).loads,
            "finite elements": sign * elements.interface(name).loads,
            "dynamics": moving.interface(name).loads,
        }
        for c, component in enumerate(FORCES):
            unit, size = ("kN", 1e3) if c < 3 else ("kN m", 1e3)
            deviations = {m: float(v[:, c].std()) / size for m, v in by_model.items()}
            if max(deviations.values()) < 1e-3 * float(hub.std()) / size:
                continue
            row: Record = {"interface": name, "component": f"{component} [{unit}]"}
            row |= {
                f"{m}: mean": round(float(v[:, c].mean()) / size, 3) for m, v in by_model.items()
            }
            row |= {f"{m}: deviation": round(d, 3) for m, d in deviations.items()}
            rows.append(row)
            found.append({m: v[:, c] / size for m, v in by_model.items()})
    page.section("One load in three models")
    worst = max(rows, key=lambda row: row["dynamics: deviation"] - row["statics: deviation"])
    shown = slice(0, min(len(moving.time), 400))
    page.chart(
        IN_TIME,
        [trace(m, moving.time[shown], v[shown]) for m, v in found[rows.index(worst)].items()],
        "time [s]",
        f"{worst['interface']}: {worst['component']}",
    )
    page.table("Loads at main bearing and gearbox entrance of those at the hub", rows)
    page.data("models", rows)
    page.text(
        "Statics takes the arms as vertical and lateral supports; the finite elements have their "
        "axial stiffness and what it resists of a turn about z, too; in the dynamics gearbox and "
        "shaft have inertia."
    )
    return worst


def motions(page: Page, moving: LoadTable, elements: LoadTable) -> None:
    """Displacements of the hub in both models, and accelerations of the gearbox."""
    shown = slice(0, min(len(moving.time), 400))
    page.section("Displacements and accelerations")
    page.chart(
        "Vertical displacement of the hub against its mean",
        [
            trace(name, moving.time[shown], 1e3 * (u - u.mean())[shown])
            for name, table in (("finite elements", elements), ("dynamics", moving))
            if (found := table.interface("hub").displacements) is not None
            for u in (found[:, 2],)
        ],
        "time [s]",
        "uz [mm]",
    )
    curves = []
    for side in ("left", "right"):
        a = moving.interface(f"{side} arm").accelerations
        assert a is not None
        curves.append(trace(f"{side} arm", moving.time[shown], a[shown, 2]))
    page.chart("Vertical acceleration at the arms", curves, "time [s]", "az [m/s^2]")
