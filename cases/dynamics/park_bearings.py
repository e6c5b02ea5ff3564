"""Where varying meshes make an undisturbed drivetrain grow by itself: bearings, contact, speed."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.own_torque_step import stepped
from fe_drivetrain.cases.dynamics.park_models import DAMPING, SPEED, meshes
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import (
    Equations,
    Level,
    Machine,
    Meshing,
    State,
    integrate,
    library_machine,
    machine_system,
    parametric_growth,
    steady,
    varying_equations,
)
from fe_drivetrain.dynamics.time.parametric_growth import KEPT, TURN
from fe_drivetrain.report import heat_map, marked
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run

GROWS = 0.01
"""Rate from which a drivetrain counts as unstable [1/s]: 100 s at one speed make it e-fold."""
BARELY = 0.3
"""Rate that an integration over some seconds sees [1/s]: threefold in 4 s."""
OVER = "stiffness of all bearings over the stated one"
RATIO, OF_RATIO = "contact ratio over the stated one", "contact ratio"
SPEEDS = "speed over the stated one"
RATE = "growth of an undisturbed drivetrain [1/s]"
CHART = "Growth over bearings and speed, at the worst contact ratio; white: none"
BY_BEARINGS = "Growth at the stated speed over the stiffness of all bearings"
IN_TIME = "growth in time, its meshes alone [1/s]"


@dataclass(frozen=True)
class Swept:
    """A machine whose meshes vary at a speed of the rotor [rad/s]."""

    machine: Machine
    meshing: dict[str, Meshing]
    speed: float

    def equations(self, at: "Point", only: float | None = None) -> Equations:
        """With bearings, contact ratios and speed of a point; meshes of one frequency alone."""
        system = machine_system(on_bearings(self.machine, at.bearings), Level.RIGID)
        return self.of_system(system, at, only)

    def of_system(self, system: Any, at: "Point", only: float | None = None) -> Equations:
        """The same on a system with its bearings."""
        varying = {
            name: Meshing(
                max(1.0, at.ratio * one.contact_ratio), at.speed * one.frequency, one.phase
            )
            for name, one in self.meshing.items()
            if only is None or np.isclose(at.speed * one.frequency, only, rtol=1e-9)
        }
        return varying_equations(system, varying, at.speed * self.speed, damping=DAMPING)

    def stage_of(self, frequency: float, speed: float) -> str:
        """The stage whose meshes have a frequency."""
        closest = min(
            self.meshing, key=lambda name: abs(speed * self.meshing[name].frequency - frequency)
        )
        return " ".join(closest.split()[:2])


class Point(NamedTuple):
    """Bearings, contact ratios and speed, each over the stated ones."""

    bearings: float
    ratio: float
    speed: float


STATED = Point(1.0, 1.0, 1.0)


class Found(NamedTuple):
    """Growth of the fastest motion [1/s], and the mesh frequency that makes it grow [Hz]."""

    rate: float
    frequency: float


@case(
    "Bearings, contact ratio and speed: where varying meshes make a drivetrain unstable",
    source="Park et al. 2021, Front. Energy Res. 8:604414, Table 2, sections 4 and 5; bearings and "
    "contact ratios are not printed",
    settings={"drivetrain": "FILE, or a name of the library (otherwise park_2021)"},
)
def run(run: Run, page: Page) -> None:
    """Growth of a small disturbance by Floquet, over bearings, contact ratio and speed."""
    chosen = run.drivetrain("park_2021", gears=True)
    of = swept(page, chosen)
    bearings, ratios, speeds = grid(run.quick)
    found: dict[Point, Found] = {}
    for factor in bearings:
        with run.step(f"bearings times {factor:g}"):
            system = machine_system(on_bearings(of.machine, factor), Level.RIGID)
            for ratio, speed in product(ratios, speeds):
                at = Point(factor, ratio, speed)
                rates = parametric_growth(of.of_system(system, at))
                frequency = max(rates, key=lambda one: rates[one])
                found[at] = Found(rates[frequency], frequency)
    with run.step("in time"):
        rows = check_in_time(page, of, found)
    show(page, of, found, rows)
    answer(page, chosen, found)
    for quantity, value, unit in (
        ("damping over stiffness", DAMPING, "s"),
        ("harmonics of the meshes", 8, "-"),
    ):
        page.assume(quantity, value, unit, "none is stated" if chosen.own else "not printed")
    if not chosen.own:
        page.assume("bearings", "3e8 to 1.2e9 N/m times the factor", "", "not printed")
        page.assume("contact ratios", "1.6 times the factor", "", "not printed")


def swept(page: Page, chosen: ChosenDrivetrain) -> Swept:
    """The printed machine at 6 rpm, or a user's at its rated speed."""
    if chosen.own:
        own = stepped(page, chosen)
        page.subject, page.topic = chosen.drivetrain.title, "stability of its varying meshes"
        return Swept(own.machine, own.meshing, own.speed)
    machine = library_machine("park_2021")
    page.about(machine)
    return Swept(machine, meshes(), SPEED)


def grid(quick: bool) -> tuple[list[float], list[float], list[float]]:
    """Bearings, contact ratios and speeds over the stated ones."""
    if quick:
        return [0.2, 0.5, 1.0], [0.875, 1.0], [0.8, 1.0]
    bearings = [0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0]
    return bearings, [0.75, 0.875, 1.0, 1.125], np.round(np.linspace(0.4, 1.6, 13), 3).tolist()


def on_bearings(machine: Machine, factor: float) -> Machine:
    """A machine with all its bearings, pins with them, that many times as stiff."""

    def stiffer(one: Any) -> Any:
        stiffness = (factor * np.asarray(one.stiffness, dtype=float)).tolist()
        return one.model_copy(update={"stiffness": stiffness})

    def of_stage(stage: Any) -> Any:
        if not isinstance(stage, PlanetaryData):
            return stage
        return stage.model_copy(update={"pins": tuple(stiffer(pin) for pin in stage.pins)})

    bearings = tuple(stiffer(one) for one in machine.bearings)
    stages = tuple(of_stage(stage) for stage in machine.stages)
    return machine.model_copy(update={"bearings": bearings, "stages": stages})


def growth(equations: Equations, expected: float) -> float:
    """Rate at which the strain of a small disturbance grows, late in an integration [1/s].

    Parameters
    ----------
    equations : Equations
        Equations with meshes that vary.
    expected : float
        Rate that is looked for, which says how long to look [1/s].
    """
    s, n = equations.springs, len(equations.mass)
    duration = float(np.clip(6.0 / expected, 2.0, 4.0)) if expected > BARELY else 2.0
    step = 1.0 / (100.0 * float(s.frequency.max()))
    begin = State(1e-5 * np.random.default_rng(1).standard_normal(n), np.zeros(n), np.zeros(n))
    motion = integrate(equations, steady(np.zeros(n)), duration, step, start=begin)
    stiffness = np.where(s.stiffness > 0.0, s.stiffness, np.inf)
    strain = (motion.forces**2 / stiffness).sum(axis=1)
    share = motion.times / duration
    early, late = strain[(share > 0.5) & (share < 0.6)].max(), strain[share > 0.9].max()
    return float(np.log(late / early) / (2.0 * 0.4 * duration))


def check_in_time(page: Page, of: Swept, found: dict[Point, Found]) -> list[Record]:
    """Growth at the worst point, the stated one and a stable one, integrated in time."""
    worst = max(found, key=lambda at: found[at].rate)
    stable = min(found, key=lambda at: found[at].rate)
    rows: list[Record] = []
    for at in dict.fromkeys((worst, STATED, stable)):
        one = found[at]
        alone = growth(of.equations(at, one.frequency), one.rate) if at == worst else None
        together = growth(of.equations(at), one.rate)
        row = {OVER: at.bearings, RATIO: at.ratio, SPEEDS: at.speed, RATE: one.rate}
        rows.append({**row, IN_TIME: alone, "all meshes together [1/s]": together})
        name = f"bearings times {at.bearings:g}, contact {at.ratio:g}, speed {at.speed:g}"
        if alone is not None and one.rate > BARELY:
            page.equals(
                f"{name}: growth in time",
                alone,
                one.rate,
                within=0.05,
                why="other motions have not died out, and steps are of finite length",
                source="largest of Floquet's multipliers",
                measure="frequency",
                basis="self-consistency",
            )
        elif one.rate < GROWS:
            page.at_most(
                f"{name}: growth in time, all meshes together",
                together,
                BARELY,
                why="stable by each frequency alone; some seconds see no slower growth",
                source="Floquet's multipliers of each frequency alone",
                measure="identity",
            )
    finer = max(parametric_growth(of.equations(worst), 2.0 * KEPT, 0.5 * TURN).values())
    page.equals(
        "growth at the worst point, twice the modes and half the step [1/s]",
        found[worst].rate,
        finer,
        within=max(2e-4, 1e-3 * abs(finer)),
        relative=False,
        why="steps are of second order, higher modes follow at once",
        source="the same with more modes and steps",
        basis="self-consistency",
    )
    return rows


def show(page: Page, of: Swept, found: dict[Point, Found], rows: Sequence[Record]) -> None:
    """Maps of growth, the limit of bearings, and growth in time."""
    bearings, ratios, speeds = (sorted({at[k] for at in found}) for k in range(3))
    page.section("Growth by Floquet's multipliers")
    for caption, kept in [
        (CHART, ratios),
        *((f"The same at {ratio:g} times the contact ratio", [ratio]) for ratio in ratios),
    ]:
        rates = [
            [max(found[Point(factor, r, speed)].rate for r in kept) for factor in bearings]
            for speed in speeds
        ]
        page.add(growth_map(caption, bearings, speeds, np.array(rates)))
    safe = safe_bearings(found)
    page.chart(
        BY_BEARINGS,
        [
            marked(
                f"{ratio:g} times the contact ratio",
                np.array(bearings),
                np.array([found[Point(factor, ratio, 1.0)].rate for factor in bearings]),
            )
            for ratio in ratios
        ],
        OVER,
        RATE,
        "x",
        None if safe is None else (safe, None),
    )
    page.table(
        "Points that grow",
        [
            {
                OVER: at.bearings,
                RATIO: at.ratio,
                SPEEDS: at.speed,
                RATE: one.rate,
                "by the meshes of": of.stage_of(one.frequency, at.speed),
            }
            for at, one in sorted(found.items(), key=lambda item: -item[1].rate)[:20]
            if one.rate > GROWS
        ]
        or [{"point": "none"}],
    )
    page.table("The same in time", list(rows))
    page.data("growth", [{**at._asdict(), **one._asdict()} for at, one in found.items()])
    state_limit(page, found, safe)


def growth_map(caption: str, bearings: Sequence[float], speeds: Sequence[float], z: Floats) -> Any:
    """Growth over bearings and speed; what does not grow stays empty."""
    names = [f"{factor:g}" for factor in bearings], [f"{speed:g}" for speed in speeds]
    each = {"type": "category"}
    titles = (OVER, SPEEDS, "growth [1/s]")
    return heat_map(caption, *names, np.where(z > GROWS, z, np.nan), titles, xaxis=each, yaxis=each)


def safe_bearings(found: dict[Point, Found]) -> float | None:
    """Least bearings from which on nothing grows at the stated speed; None where there are none."""
    grow = {at.bearings for at, one in found.items() if at.speed == 1.0 and one.rate > GROWS}
    stable = [f for f in sorted({at.bearings for at in found}) if f > max(grow, default=0.0)]
    return stable[0] if stable else None


def state_limit(page: Page, found: dict[Point, Found], safe: float | None) -> None:
    """State in the atlas from which bearings on meshes that vary leave the drivetrain stable."""
    worst = max(found, key=lambda at: found[at].rate)
    if safe is None or found[worst].rate <= GROWS:
        return
    page.limit(
        f"varying meshes of {page.subject or 'Park et al. 2021'}",
        OVER,
        low=safe,
        criterion="no growth of an undisturbed motion at the stated speed, at any contact ratio",
        beyond=f"a motion without any load grows by up to {formatted(found[worst].rate, 2)} 1/s",
        program="integrates it as stated; parametric_growth says at which speeds it grows",
        remedy="bearings that are known, more damping, other speeds, or teeth that part",
    )


def answer(page: Page, chosen: ChosenDrivetrain, found: dict[Point, Found]) -> None:
    """State where the drivetrain grows by itself, and whether it does as stated."""
    worst = max(found, key=lambda at: found[at].rate)
    grows = [at for at, one in found.items() if one.rate > GROWS]
    stated = max(found[at].rate for at in found if at.bearings == 1.0 and at.speed == 1.0)
    others = max(found[at].rate for at in found if at.bearings == 1.0)
    whose = "as its file states it" if chosen.own else "as assumed"
    rate = formatted(found[worst].rate, 2)
    bearings = f"with bearings {formatted(worst.bearings, 2)} times as stiff"
    ends = f"{whose}, it {'does not' if stated < GROWS else 'grows, too'}"
    if worst.bearings == 1.0:
        bearings = f"with bearings {whose}"
        ends = f"at the stated speed it {'does not' if stated < GROWS else 'grows, too'}"
    page.answer(
        f"Is the drivetrain of {'this file' if chosen.own else 'Park et al.'} stable for every "
        "bearing stiffness, contact ratio and speed?",
        (
            f"No: {bearings}, vibration grows at a rate of {rate}\u00a01/s at "
            f"{formatted(worst.speed, 2)} times the stated speed; {ends}."
        )
        if grows
        else "Yes: with none of the bearings, contact ratios and speeds tried does vibration grow: "
        f"all rates stay below {GROWS:g}\u00a01/s.",
        [
            page.value("largest rate of growth [1/s]", found[worst].rate),
            page.value("its bearing stiffness over the stated one", worst.bearings),
            page.value("its speed over the stated one", worst.speed),
            page.value(
                f"largest rate of growth {whose}, stated speed [1/s]", stated, at_most=GROWS
            ),
            page.value(
                f"largest rate of growth {whose}, all speeds tried [1/s]", others, at_most=GROWS
            ),
            page.value(
                "combinations tried in which vibration grows [%]", 100.0 * len(grows) / len(found)
            ),
        ],
        hero=CHART if grows else BY_BEARINGS,
        cautions=[
            *(
                []
                if chosen.own
                else [
                    "Bearings, contact ratios and damping are not printed: figures 10 to 12 of the "
                    "source rest on them."
                ]
            ),
            "The drivetrain is unloaded; meshes of one frequency at a time vary as square waves; "
            "linear springs pull as well as push, so that nothing limits growth.",
        ],
    )
