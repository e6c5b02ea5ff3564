"""Misalignment and voltage dips in time, in six degrees of freedom: forces inside the gearbox."""

from collections.abc import Mapping, Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.gap_sentences import (
    CHANGE,
    DIP,
    MOUNT,
    PEAK,
    YEARLY,
    Misaligned,
    main_channels,
    of_dips,
    of_misalignment,
    peak_of,
)
from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.dynamics import Level, machine_of
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted, value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies import TransientResult, transient

DEFAULT = "nrel_750kw"
TILT, ANISOTROPY = 1e-3, 0.2  # rad, of the coupling
SHAPES = ((0.8, 0.15), (0.5, 0.25))  # depth, s
MORE = ((1.0, 0.5), (0.8, 0.5), (0.2, 0.15), (1.0, 0.15))
SECONDS = 2.5
"""Length of a dip in a quick run [s]: the swing decays for longer, below its first peaks."""
HERO = "Force of {} in a voltage dip, gearbox aligned and beside its axis"
TURN = "Force of {} over one turn of the rotor"


@case(
    "Misalignment and voltage dips in time: forces inside the gearbox, in six degrees of freedom",
    source="PROTEST 2010, ECN-E--10-100, sections 4.2 and 4.3",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise nrel_750kw)",
        "offset": "1 (mm, of gearbox or generator)",
        "coupling": "1000000 (N/m, radial stiffness of the generator's coupling)",
    },
)
def run(run: Run, page: Page) -> None:
    """Each sentence of the report on misalignment and dips, beside what the drivetrain does."""
    chosen = run.drivetrain(DEFAULT, gears=True)
    chosen.state(page)
    drivetrain = chosen.drivetrain
    offset, coupling = 1e-3 * run.positive("offset", 1.0), run.positive("coupling", 1e6)
    found = []
    for name, values in misalignments(offset, coupling, run.quick).items():
        with run.step(name):
            moves = Level.RIGID if run.quick else Level.FLEXIBLE
            found.append(Misaligned(name, values, misaligned(drivetrain, values, moves)))
    shapes, first = SHAPES if run.quick else SHAPES + MORE, SHAPES[0]
    seconds = SECONDS if run.quick else None
    dips: dict[tuple[float, float], TransientResult] = {}
    for depth, length in shapes:
        with run.step(DIP.format(100 * depth, length)):
            dips[depth, length] = dipped(drivetrain, depth, length, seconds)
    with run.step("dip of a misaligned gearbox"):
        level = dips[first].level
        both = dipped(drivetrain, *first, seconds, level=level, gearbox_uz=offset)
        still = dipped(drivetrain, 0.0, first[1], seconds, level=level)
    mains = main_channels(drivetrain)
    rows = [*of_misalignment(page, found, mains), *of_dips(page, dips, both, still, found[0])]
    check(page, found, dips, both)
    show(page, found, dips, both)
    page.section("What the report says, and what the drivetrain does")
    page.table("Sentences of section 4.2 and 4.3", rows)
    page.data("sentences", rows)
    answer(page, found, dips, rows, offset)
    assume(page, coupling)


def misalignments(offset: float, coupling: float, quick: bool) -> dict[str, dict[str, float]]:
    """Values of the event by name: gearbox beside the main shaft, generator beside the gearbox."""
    words = f"{1e3 * offset:g} mm"
    found: dict[str, dict[str, float]] = {
        f"gearbox {words} too high": {"gearbox_uz": offset},
        f"generator {words} aside, uneven coupling": {
            "coupling": coupling,
            "y": offset,
            "anisotropy": ANISOTROPY,
        },
    }
    if not quick:
        found |= {
            f"gearbox tilted by {1e3 * TILT:g} mrad": {"gearbox_ry": TILT},
            f"generator {words} aside, even coupling": {"coupling": coupling, "y": offset},
            f"gearbox {words} aside": {"gearbox_uy": offset},
            f"gearbox turned by {1e3 * TILT:g} mrad": {"gearbox_rz": TILT},
            f"generator {words} too high": {"coupling": coupling, "y": 0.0, "z": offset},
            f"hub of the coupling {words} eccentric": {
                "coupling": coupling,
                "y": 0.0,
                "run_out": offset,
            },
        }
    return found


def misaligned(
    drivetrain: Drivetrain, values: Mapping[str, float], level: Level
) -> TransientResult:
    """Steady turning under rated torque over a turn of the rotor; planets go with their carrier."""
    planetary = any(s.kind == "planetary" for s in machine_of(drivetrain).stages)
    of = drivetrain.operation
    turn = 2.0 * np.pi / of.rotor_speed[1] if of is not None and of.rotor_speed else 2.0
    return transient(
        drivetrain,
        "offset",
        dict(values),
        level=level.name.lower(),
        planets="travel" if planetary else "stand",
        duration=float(turn),
        damage=None,
    )


def dipped(
    drivetrain: Drivetrain,
    depth: float,
    length: float,
    seconds: float | None,
    *,
    level: str | None = None,
    **moved: float,
) -> TransientResult:
    """A dip; at all levels where none is given."""
    values = {"depth": depth, "length": length, "start": 0.5, **moved}
    return transient(drivetrain, "dip", values, level=level, quantity="bearing", duration=seconds)


def check(
    page: Page,
    found: Sequence[Misaligned],
    dips: Mapping[tuple[float, float], TransientResult],
    both: TransientResult,
) -> None:
    """Checks of each run, and that a dip and an offset add up where nothing is nonlinear."""
    runs = {one.name: one.result for one in found}
    runs |= {DIP.format(100 * depth, length): one for (depth, length), one in dips.items()}
    for name, result in runs.items():
        page.checks += [
            v.model_copy(update={"quantity": f"{name}: {v.quantity}"}) for v in result.checks
        ]
    dip = dips[SHAPES[0]]
    names = [name for name, one in dip.extremes.items() if one.kind == "torque"]
    apart = []
    for name in names:
        change = both.samples.of(name) - dip.samples.of(name)
        apart.append(float(np.ptp(change)) / abs(dip.extremes[name].rated))
    page.vanishes(
        "torques in a dip of a misaligned gearbox, beyond those of dip and offset, over rated",
        max(apart),
        within=1e-6,
        why="planets stand and teeth touch: equations are linear, so that both add up, to the "
        "round-off of so many steps",
        source="superposition",
    )


def show(
    page: Page,
    found: Sequence[Misaligned],
    dips: Mapping[tuple[float, float], TransientResult],
    both: TransientResult,
) -> None:
    """Forces over time, and tables of changes and peaks."""
    page.section("Misalignment")
    curves = []
    for moved in found:
        times, values = moved.result.samples.course(found[0].worst, 1500)
        curves.append(trace(moved.name, times, values / 1e3))
    page.chart(TURN.format(bearing_of(found)), curves, "time [s]", "force [kN]")
    page.table("Largest changes of forces of bearings", changed_rows(found))
    page.section("Voltage dips")
    dip = dips[SHAPES[0]]
    page.chart(
        HERO.format(bearing_of(found)),
        [
            trace(name, times, values / 1e3)
            for name, one in (("aligned", dip), (found[0].name, both))
            for times, values in (one.samples.course(found[0].worst, 2000),)
        ],
        "time [s]",
        "force [kN]",
        events=dip.marks,
    )
    rows: list[Record] = []
    for (depth, length), one in dips.items():
        row: Record = {"depth": depth, "length [s]": length, "level": one.level}
        for kind in ("torque", "mesh", "bearing"):
            name, over = peak_of(one, kind)
            row |= {f"{kind}": name, f"{kind} over rated": over}
        rows.append(row)
    page.table("Largest value over rated, of torques, meshes and bearings", rows)
    page.data("dips", rows)
    page.add(next(iter(dips.values())).over_time("bearing"))


def bearing_of(found: Sequence[Misaligned]) -> str:
    """The bearing that the first misalignment loads most."""
    return found[0].worst.removeprefix("force of ")


def changed_rows(found: Sequence[Misaligned]) -> list[Record]:
    """Change of each bearing's force by each misalignment."""
    names = list(found[0].changes("bearing"))
    rows: list[Record] = []
    for name in names:
        row: Record = {"channel": name, "aligned [kN]": found[0].result.extremes[name].rated / 1e3}
        for one in found:
            row[f"{one.name} [kN]"] = one.changes("bearing").get(name, 0.0) / 1e3
        rows.append(row)
    return rows


def answer(
    page: Page,
    found: Sequence[Misaligned],
    dips: Mapping[tuple[float, float], TransientResult],
    rows: Sequence[Record],
    offset: float,
) -> None:
    """State what an offset and a dip do inside the gearbox, and how many sentences hold."""
    worst = max(found, key=lambda one: max(one.changes("bearing").values()))
    change = page.judged(CHANGE, f"change of the force on {worst.worst.removeprefix('force of ')}")
    peak = page.judged(PEAK, "largest torque in a dip, over rated", "rated")
    hold = sum(row["verdict"] == "holds" for row in rows)
    bearing = max(peak_of(one, "bearing")[1] for one in dips.values())
    mesh = max(peak_of(one, "mesh")[1] for one in dips.values())
    aligned = abs(worst.result.extremes[worst.worst].rated) / 1e3
    mounted = MOUNT in worst.result.extremes
    name = worst.name.replace(" mm", "\u00a0mm").replace(" mrad", "\u00a0mrad")
    page.answer(
        "What do misalignment and voltage dips do inside the gearbox, over time?",
        f"With the {name}, a bearing's force changes by "
        f"{value_text(change.value or 0.0, 'kN')}; dips reach "
        f"{formatted(peak.value or 0.0, 3)} times rated torque; {hold} of {len(rows)} statements "
        "hold.",
        [
            change,
            page.value("force of that bearing, aligned [kN]", aligned),
            peak,
            page.value("largest force of a mesh in a dip, over rated", mesh),
            page.value("largest force of a bearing in a dip, over rated", bearing),
            page.value("statements that hold as they stand", hold, beside=len(rows), by="tested"),
        ],
        hero=HERO.format(bearing_of(found)),
        cautions=[
            f"The report states no size of misalignment: {1e3 * offset:g} mm is assumed, and "
            "forces are proportional to it.",
            f"Bearings have no clearance here, and the housing stands "
            f"{'on its mount' if mounted else 'on the ground'}: clearance"
            f"{'' if mounted else ' and a mount'} would take up a part of an offset.",
            "Stiffness of the coupling, shape of dips and damping are assumed.",
            "The generator's torque follows the table of a dip; its electrics are not modelled.",
        ],
        claim="holds" if hold == len(rows) else "holds in part",
    )


def assume(page: Page, coupling: float) -> None:
    """State what the report does not print."""
    page.assume("radial stiffness of the coupling", coupling, "N/m", "of the case; proportional")
    page.assume("unevenness of the coupling", ANISOTROPY, "", "of the case")
    page.assume("tilt of the gearbox", TILT, "rad", "of the case; forces are proportional to it")
    page.assume("dips in a year", YEARLY, "", "of the case: no grid code is named")
