"""A sun on its spline: how far out of line, which teeth carry, and what floating does."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file.couplings import SplineData
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import (
    Machine,
    Operation,
    Rung,
    assemble,
    assembly,
    azimuths,
    machine_of,
    plain_rungs,
    static,
    steady_load,
)
from fe_drivetrain.dynamics.bodies.spline_loads import SplineLoad, spline_motion
from fe_drivetrain.gear import Spline, loaded_spline
from fe_drivetrain.report import trace
from fe_drivetrain.report.answer import Claim
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.key_figures import KeyLimit

NAME, MOMENT = "grc_750kw", -3e5  # N m of tilt at the hub, of the non-torque tests
SHAFT, SPLINE, JOINT = "shaft without a spline", "spline", "spline of one slice"
CALM, TILTED = "torque and gravity", "tilt at the hub, too"
PIN_ERROR = 50e-6  # m
PRINTED = 1e-4  # m, displacement of the sun of the 750 kW gearbox
UNEVEN = 0.01
"""Share of a load, or of a stiffness, that is no difference."""
COUNTS = (1, 2, 5, 10, 35, 99)
HERO = "Load of the most loaded tooth of the sun's spline over its width, shafts out of line"


@dataclass(frozen=True)
class Sun:
    """A sun, and what it does in one model over a turn.

    Attributes
    ----------
    load : SplineLoad or None
        Loads of the spline; none without one.
    moved : Floats
        Shift (a, 2) of the sun against its ring [m].
    sharing, misplaced : float
        K_gamma over the turn, and with the first pin out of place.
    """

    load: SplineLoad | None
    moved: Floats
    sharing: float
    misplaced: float

    @property
    def furthest(self) -> float:
        """Largest shift of the sun [m]."""
        return float(np.hypot(*self.moved.T).max())


@case(
    "A sun on its spline: teeth out of line, and what floating does to the planets' loads",
    source="Al-Hamadani 2018, section 5.1 (spline of 35 slices, Fig 5.7)",
    settings={"drivetrain": "FILE, or a name of the library (otherwise grc_750kw)"},
)
def run(run: Run, page: Page) -> None:
    """Statics over a turn without a spline, on one, and on a joint; teeth by hand and exactly."""
    chosen = run.drivetrain(NAME)
    chosen.state(page, topic="A sun on its spline: teeth out of line, and what floating does")
    machine, torque = machine_of(chosen.drivetrain), chosen.rated_torque()
    number = sun_stage(machine)
    data = spline_of(page, machine, number)
    moment = -torque if chosen.own else MOMENT
    page.assume("moment about y at the hub", moment / 1e3, "kN m", "it tilts the carrier")
    rungs, angles = plain_rungs(chosen.drivetrain, machine), azimuths(4 if run.quick else 12)
    models: dict[str, SplineData | None] = {
        SHAFT: None,
        SPLINE: data,
        JOINT: data.model_copy(update={"slices": 1}),
    }
    found: dict[tuple[str, str], Sun] = {}
    for load, tilt in ((CALM, 0.0), (TILTED, moment)):
        with run.step(load):
            operation = Operation(torque, tilt)
            for name, given in models.items():
                of = with_spline(machine, number, given)
                found[load, name] = over_turn(of, number, rungs[-1], operation, angles)
    spline = data.spline
    splines = {load: on_spline(found, load) for load in (CALM, TILTED)}
    check(page, spline, machine, number, found, torque)
    show(page, spline, found, splines)
    stated = machine.shafts[number].spline is not None
    answer(page, found, splines, chosen.own, stated)
    page.assume_all(machine.assumptions())


def sun_stage(machine: Machine) -> int:
    """Number of the first planetary stage, from 1.

    Raises
    ------
    InputError
        There is none with pins.
    """
    for number, stage in enumerate(machine.stages, start=1):
        if isinstance(stage, PlanetaryData) and stage.pins:
            return number
    raise InputError(
        f"{machine.title!r} has no planetary stage with bearings of its planets, whose sun could "
        "be on a spline: give gearbox.stages and their pins"
    )


def spline_of(page: Page, machine: Machine, number: int) -> SplineData:
    """The spline that the file states, or one of the sun's size at the middle of its shaft."""
    shaft, stage = machine.shafts[number], machine.stages[number - 1]
    if shaft.spline is not None:
        return shaft.spline
    assert isinstance(stage, PlanetaryData)
    across = round(1.8 * stage.sun_radius, 2)
    made = SplineData(teeth=32, diameter=across, length=across / 2, at=shaft.length / 2)
    page.assume(
        f"spline of {shaft.name}",
        f"32 teeth on {1e3 * across:g} mm, half as wide, at the middle of the shaft",
        "",
        "assumed: the file states none; of the size of the sun",
    )
    return made


def with_spline(machine: Machine, number: int, spline: SplineData | None) -> Machine:
    """The machine with another spline behind a stage, or none."""
    shafts = list(machine.shafts)
    shafts[number] = shafts[number].model_copy(update={"spline": spline})
    return machine.model_copy(update={"shafts": tuple(shafts)})


def over_turn(
    machine: Machine, number: int, rung: Rung, operation: Operation, angles: Floats
) -> Sun:
    """Statics of a machine at one azimuth after the other."""
    stage, shaft = machine.stages[number - 1], machine.shafts[number]
    assert isinstance(stage, PlanetaryData)
    pins = [f"stage {number} pin 1 {pin.name}".strip() for pin in stage.pins]
    motions, moved, each = [], [], []
    for azimuth in angles.tolist():
        parts = assembly(machine, rung.level, azimuth, held_generator=True, flexible=rung.flexible)
        system = assemble(parts.bodies, parts.springs, parts.superelements)
        hub = np.array([0.0, 0.0, 0.0, 0.0, operation.moment, 0.0])
        load = steady_load(machine, system, operation.torque, hub)
        state, gaps = static(system, load), {f"{pin} uz": PIN_ERROR for pin in pins}
        shift = np.subtract(
            *(system.motion_of(f"stage {number} {part}", state.q)[1:3] for part in ("sun", "ring"))
        )
        moved.append(shift)
        forces = [
            [one.force(f"stage {number} sun-planet {k + 1}") for k in range(stage.planets)]
            for one in (state, static(system, load, gaps))
        ]
        each.append(forces)
        if shaft.spline is not None:
            motions.append(spline_motion(state, shaft.name, shaft.spline))
    spline = None
    if shaft.spline is not None:
        sizes, motion = zip(*motions, strict=True)
        spline = SplineLoad(shaft.spline, max(sizes), np.array(motion))
    loads = np.array(each)
    sharing = (loads.max(axis=2) / loads.mean(axis=2)).max(axis=0)
    return Sun(spline, np.array(moved), *map(float, sharing))


def on_spline(found: Mapping[tuple[str, str], Sun], load: str) -> SplineLoad:
    """Loads of the spline of all its slices."""
    one = found[load, SPLINE].load
    assert one is not None
    return one


def check(
    page: Page,
    spline: Spline,
    machine: Machine,
    number: int,
    found: Mapping[tuple[str, str], Sun],
    torque: float,
) -> None:
    """The limit by hand, and the torque of the spline by statics."""
    sun = on_spline(found, CALM)
    edge = (0.0, 0.0, 0.0, spline.capacity(sun.torque))
    at_limit = loaded_spline(spline, sun.torque, edge if spline.edge else (0.0,) * 4)
    page.equals(
        "peak over mean of the teeth's loads at the tilt that lifts the first",
        at_limit.peak_over_mean,
        2.0 if spline.edge else 1.0,
        within=1e-9,
        why="round-off",
        source="by hand: the tilt takes the indentation at one edge and adds it at the other",
    )
    ratio = abs(machine.speeds[number] / machine.speeds[0])
    page.equals(
        "torque of the spline [kN m]",
        sun.torque / 1e3,
        torque / ratio / 1e3,
        within=1e-6,
        why="solver; bearings carry no torque",
        source="statics: the torque over the ratio",
    )


def show(
    page: Page,
    spline: Spline,
    found: Mapping[tuple[str, str], Sun],
    splines: Mapping[str, SplineLoad],
) -> None:
    """Loads over the width, models side by side, slices, and the thesis's statements."""
    page.section("Teeth out of line")
    torque = splines[CALM].torque
    x = 1e3 * spline.length * ((np.arange(spline.slices) + 0.5) / spline.slices - 0.5)
    lines = []
    limit = spline.capacity(torque) if spline.edge else 0.0
    for share in (0.0, 0.5, 1.0, 2.0):
        of = loaded_spline(spline, torque, (0.0, 0.0, 0.0, share * limit))
        lines.append(trace(f"{share:g} of the limit", x, of.forces[:, 0] / of.forces.mean()))
    for load, one in splines.items():
        of = one.worst
        tooth = int(of.forces.max(axis=0).argmax())
        lines.append(trace(f"at {load}", x, of.forces[:, tooth] / of.forces.mean()))
    page.chart(HERO, lines, "x from the middle of the width [mm]", "load over the mean of all")
    page.table("Tilt stiffness by the number of slices", slice_rows(spline))
    page.section("What floating does")
    page.table("Sun and planets over a turn", model_rows(found))
    page.section("What the thesis says")
    page.table("Printed, ours, verdict", statements(found, splines))


def slice_rows(spline: Spline) -> list[Record]:
    """Tilt stiffness of some numbers of slices, over that of a whole width."""
    whole = 0.5 * spline.flanks * spline.length**2 / 12.0
    rows: list[Record] = []
    for count in COUNTS:
        data = {**vars(spline), "slices": count}
        tilt = Spline(**data).springs[2]
        rows.append(
            {
                "slices": count,
                "tilt stiffness [kN m/mrad]": tilt / 1e6,
                "of that without slices [%]": 100 * tilt / whole,
            }
        )
    return rows


def model_rows(found: Mapping[tuple[str, str], Sun]) -> list[Record]:
    """One row for each load and model."""
    return [
        {
            "load": load,
            "model": model,
            "shift of the sun in its ring [um]": 1e6 * sun.furthest,
            "shift of the spline [um]": None if sun.load is None else 1e6 * sun.load.shift,
            "tilt of the spline [urad]": None
            if sun.load is None or model == JOINT
            else 1e6 * sun.load.tilt,
            "share of the limit": sun.load.used if sun.load and model == SPLINE else None,
            "K_gamma": sun.sharing,
            "K_gamma, a pin 50 um out of place": sun.misplaced,
        }
        for (load, model), sun in found.items()
    ]


def statements(
    found: Mapping[tuple[str, str], Sun],
    splines: Mapping[str, SplineLoad],
) -> list[Record]:
    """The thesis's statements about the spline, each with a verdict."""
    stiff, free = found[CALM, SHAFT], found[CALM, JOINT]
    shifts = [1e6 * found[load, JOINT].furthest for load in (CALM, TILTED)]
    left = 1.0 / 35**2
    peaks = [one.worst.peak_over_mean for one in splines.values()]
    return [
        {
            "statement": "displacements of the sun are small, around 0.1 mm",
            "ours": f"{shifts[0]:.3g} um in its ring, {shifts[1]:.3g} um with tilt at the hub",
            "verdict": "holds" if near(shifts) else "does not hold",
        },
        {
            "statement": "a sun that moves centres within the planets and promotes load sharing",
            "ours": f"K_gamma with a pin 50 um out of place: {stiff.misplaced:.3f} without a "
            f"spline, {free.misplaced:.3f} on a joint",
            "verdict": "holds" if free.misplaced < stiff.misplaced else "does not hold",
        },
        {
            "statement": "contact forces are uneven over the width where the shafts are tilted",
            "ours": f"peak over mean {peaks[0]:.2f}, {peaks[1]:.2f} with tilt at the hub; 2 at the "
            "limit",
            "verdict": "holds" if max(peaks) > 1.0 + UNEVEN else "does not hold",
        },
        {
            "statement": "35 slices are accurate",
            "ours": f"they miss {100 * left:.2g} % of the tilt stiffness, 5 slices 4 %",
            "verdict": "holds" if left < UNEVEN else "does not hold",
        },
    ]


def near(shifts: list[float]) -> bool:
    """Whether the largest shift of the sun [um] is that printed, within a factor of two."""
    return 0.5e6 * PRINTED <= max(shifts) <= 2e6 * PRINTED


def answer(
    page: Page,
    found: Mapping[tuple[str, str], Sun],
    splines: Mapping[str, SplineLoad],
    own: bool,
    stated: bool,
) -> None:
    """State how near teeth are to lifting, and what floating does to the planets."""
    most = max(one.used for one in splines.values())
    stiff, on, free = (found[CALM, model] for model in (SHAFT, SPLINE, JOINT))
    helps = free.misplaced < stiff.misplaced
    shifts = [1e6 * found[load, JOINT].furthest for load in (CALM, TILTED)]
    claim: Claim = (
        "holds" if helps and near(shifts) else "holds in part" if helps else "does not hold"
    )
    said = "" if own else f": the thesis {claim}"
    teeth = f"Spline teeth {'stay in' if most < 1.0 else 'lose'} contact at"
    word = "lowers" if helps else "does not lower"
    printed: KeyLimit = {} if own else {"beside": 1e6 * PRINTED, "by": "thesis"}
    page.answer(
        "Do the sun's spline teeth lose contact, and does the spline help planets share the load?",
        f"{teeth} {value_text(float(f'{100 * most:.2g}'), '%')} of the limit; a floating sun "
        f"{word} the load-sharing factor from {stiff.misplaced:.3f} to {free.misplaced:.3f}{said}.",
        [
            page.value("share used of the limit of contact [%]", 100 * most, at_most=100.0),
            page.value(
                "peak over mean of the spline teeth's loads",
                max(x.worst.peak_over_mean for x in splines.values()),
            ),
            page.value(
                "load-sharing factor K_gamma, pin 50 µm out of place, sun on a joint",
                free.misplaced,
                beside=stiff.misplaced,
                by="no spline",
            ),
            page.value(
                "the same, sun on its spline", on.misplaced, beside=stiff.misplaced, by="no spline"
            ),
            page.value("shift of the sun in its ring, tilt at the hub [µm]", shifts[1], **printed),
        ],
        HERO,
        [
            *([] if stated else ["The spline is assumed, of the sun's size: the file has none."]),
            "Flanks of all teeth are perfect, without crowning and friction.",
            "Bearings are linear, and the carrier is rigid.",
        ],
        claim="" if own else claim,
    )
