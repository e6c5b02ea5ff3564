"""Uncertain inputs by both approaches of PROTEST's step 4: on frequencies, on loads and damage."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.gap_sentences import sentence
from fe_drivetrain.cases.procedure.two_stages import (
    RATE,
    Driving,
    Stages,
    detailed_torques,
    driving_of,
    stages_of,
    turbine_of,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import peak_between
from fe_drivetrain.dynamics import Machine, machine_of
from fe_drivetrain.dynamics.torsion import GENERATOR, ROTOR, Torsional, changed, natural_modes
from fe_drivetrain.procedure import Dip
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import damage_equivalent_load, rainflow_cycles
from fe_drivetrain.turbine_loads.hub_loads import Condition, turbine_history

DEFAULT = "synthetic_2mw"
MASSES = 0.03
"""Half width of masses, Table 4.7; inertias of the same shape go with them."""
WIND, DAMPING, STEP = 7.0, 0.05, 1e-2  # m/s, of the first mode, relative step of a sensitivity
SETTLED = 10.0
"""Left out at the beginning [s]: swings of the first mode have decayed to a thousandth."""
SLOPE = 6.6
"""Slope of the pitting of case-hardened gears, ISO 6336-2."""
SECONDS, FINE = 1.5, 1e-3  # s, of a dip
FIRST, SECOND = "first frequency", "second frequency"
LOAD, PEAK, DAMAGE = "DEL of the main shaft", "peak in a dip", "damage of the high-speed shaft"
QUANTITIES = (FIRST, SECOND, LOAD, PEAK, DAMAGE)
HERO = "What each uncertain input alone makes uncertain, half widths"
WIDE = 1.959964 / np.sqrt(3.0)
"""Half width of 95 % of a Gaussian sum, over the root of the sum of squares of even half widths."""
NEAR = 0.25
"""How far first order may be from samples to be of use, over these."""


@dataclass(frozen=True)
class Uncertain:
    """An input of Table 4.7: its row, parts that it is of, and its half width as a share."""

    name: str
    row: str
    parts: tuple[str, ...]
    spread: float

    def on(self, system: Torsional, share: float) -> Torsional:
        """The system with the input larger by a share."""
        if self.row.startswith("damping"):
            more = [replace(e, damping=e.damping * (1.0 + share)) for e in system.elements]
            return Torsional(system.inertias, tuple(more))
        known = {one.name: one.inertia for one in system.inertias}
        known |= {one.name: one.stiffness for one in system.elements}
        return changed(system, {name: known[name] * (1.0 + share) for name in self.parts})


@case(
    "Uncertain inputs by both approaches: frequencies, loads and damage of a drivetrain",
    source="PROTEST 2010, ECN-E--10-100, section 4.6.2.4, Table 4.7",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise synthetic_2mw)",
        "spread": "10 (%, half width of what Table 4.7 has a question mark for)",
    },
)
def run(run: Run, page: Page) -> None:
    """Vary each input: modes (approach 1), load cases and counts (approach 2), side by side."""
    chosen = run.drivetrain(DEFAULT, gears=True)
    chosen.state(page)
    machine = machine_of(chosen.drivetrain)
    spread = run.positive("spread", 10.0) / 100.0
    stages = stages_of(machine, DAMPING)
    speed, torque = chosen.rotor_speeds()[1], chosen.rated_torque()
    inputs = inputs_of(machine, stages.detailed, spread)
    with run.step("turbine"):
        driving = driven(stages, torque * speed, speed, 40.0 if run.quick else 600.0)
    with run.step("one by one"):
        nominal = outcome(stages, driving, torque)
        slopes = {one.name: slopes_of(one, stages, driving, torque, nominal) for one in inputs}
    with run.step("all together"):
        count = 16 if run.quick else 128
        samples = together(inputs, stages, driving, torque, count)
    check(page, stages, inputs, slopes)
    widths = bands(inputs, slopes, samples, nominal)
    show(page, inputs, slopes, widths)
    rows = sentences(machine, stages, inputs, slopes, widths)
    page.section("What the report says, and what the drivetrain does")
    page.table("Sentences of section 4.6.2.4", rows)
    page.data("sentences", rows)
    answer(page, inputs, slopes, widths, rows, spread)
    page.assume("inputs with a question mark", f"{100 * spread:g}", "%", "no half width is printed")
    page.assume("samples", count, "", "Latin hypercube of even distributions")


def inputs_of(machine: Machine, system: Torsional, spread: float) -> tuple[Uncertain, ...]:
    """Inputs of Table 4.7 that a drivetrain from the hub on has."""
    gears = tuple(name for name in system.names if name not in (ROTOR, GENERATOR))
    found = [
        Uncertain("blades and hub, by mass", "mass of blades", (ROTOR,), MASSES),
        Uncertain("inertia of the gears", "inertia of drivetrain parts", gears, spread),
        Uncertain("inertia of the generator", "inertia of drivetrain parts", (GENERATOR,), spread),
    ]
    elements = [element.name for element in system.elements]
    for shaft in machine.shafts:
        if shaft.name in elements:
            name = f"stiffness of {shaft.name}"
            found.append(Uncertain(name, "stiffness of shafts", (shaft.name,), spread))
    shafts = {shaft.name for shaft in machine.shafts}
    for number in range(1, len(machine.stages) + 1):
        begins = f"stage {number} "
        meshes = tuple(n for n in elements if n.startswith(begins) and n not in shafts)
        if meshes:
            name = f"meshes of stage {number}"
            found.append(Uncertain(name, "stiffness of meshes", meshes, spread))
    return (*found, Uncertain("damping", "damping of shafts and meshes", (), spread))


def driven(stages: Stages, power: float, speed: float, seconds: float) -> Driving:
    """DLC 1.2: what drives the drivetrain at 7 m/s; the same whatever its inputs are."""
    turbine, controller = turbine_of(stages, power, speed)
    condition = Condition(WIND, "medium", 0.2, 1)
    made = turbine_history(condition, turbine, controller, duration=SETTLED + seconds, rate=RATE)
    return driving_of(made.history.loads, made.rotor_speed, made.generator_torque, stages)


def outcome(stages: Stages, driving: Driving, torque: float) -> dict[str, float]:
    """Frequencies [Hz], loads [N m] and damage (no unit) of a drivetrain, by name."""
    frequencies = natural_modes(stages.detailed).frequencies
    found = detailed_torques(stages, driving)
    after = slice(round(SETTLED * RATE), None)
    low, high = (rainflow_cycles(of[after]) for of in (found.low, found.high))
    seconds = len(found.low[after]) / RATE
    time = np.arange(0.0, SECONDS, FINE)
    front = np.full(len(time), torque)
    dip = Driving(front, torque * Dip(0.2, 0.8, 0.15).shares(time), front, front)
    return {
        FIRST: float(frequencies[1]),
        SECOND: float(frequencies[2]),
        LOAD: damage_equivalent_load([low], seconds, 4.0),
        PEAK: float(peak_between(detailed_torques(stages, dip, FINE).low)),
        DAMAGE: float(high.counts @ (high.ranges / torque) ** SLOPE),
    }


def slopes_of(
    one: Uncertain, stages: Stages, driving: Driving, torque: float, nominal: Mapping[str, float]
) -> dict[str, float]:
    """Relative change of each quantity for the relative change of an input, central difference."""
    low, high = (
        outcome(replace(stages, detailed=one.on(stages.detailed, sign * STEP)), driving, torque)
        for sign in (-1.0, 1.0)
    )
    return {name: (high[name] - low[name]) / (2.0 * STEP * nominal[name]) for name in QUANTITIES}


def together(
    inputs: Sequence[Uncertain], stages: Stages, driving: Driving, torque: float, count: int
) -> dict[str, Floats]:
    """Samples of all inputs at once, even over their half widths."""
    from scipy.stats import qmc

    drawn = 2.0 * qmc.LatinHypercube(len(inputs), seed=1).random(count) - 1.0
    found: dict[str, list[float]] = {name: [] for name in QUANTITIES}
    for row in drawn:
        system = stages.detailed
        for one, share in zip(inputs, row, strict=True):
            system = one.on(system, one.spread * float(share))
        values = outcome(replace(stages, detailed=system), driving, torque)
        for name in QUANTITIES:
            found[name].append(values[name])
    return {name: np.array(values) for name, values in found.items()}


@dataclass(frozen=True)
class Width:
    """Half of the band that holds 95 %, over the value: by first order, and of samples."""

    first_order: float
    sampled: float
    count: int

    @property
    def band(self) -> float:
        """What so many samples leave uncertain of their width, 19 times of 20."""
        return 1.959964 * self.sampled / float(np.sqrt(2.0 * (self.count - 1)))


def bands(
    inputs: Sequence[Uncertain],
    slopes: Mapping[str, Mapping[str, float]],
    samples: Mapping[str, Floats],
    nominal: Mapping[str, float],
) -> dict[str, Width]:
    """Both widths of each quantity; of samples by their deviation, as of a Gaussian."""
    found = {}
    for name in QUANTITIES:
        parts = [slopes[one.name][name] * one.spread for one in inputs]
        deviation = float(samples[name].std(ddof=1)) / nominal[name]
        first = WIDE * float(np.hypot.reduce(parts))
        found[name] = Width(first, 1.959964 * deviation, len(samples[name]))
    return found


def check(
    page: Page,
    stages: Stages,
    inputs: Sequence[Uncertain],
    slopes: Mapping[str, Mapping[str, float]],
) -> None:
    """Sensitivities of the first frequency by the energies of its mode."""
    shares = natural_modes(stages.detailed).energy_shares
    apart = []
    for one in inputs:
        share = sum(float(shares[part][1]) for part in one.parts)
        exact = 0.5 * share if one.row.startswith("stiffness") else -0.5 * share
        apart.append(abs(slopes[one.name][FIRST] - exact))
    page.vanishes(
        "sensitivity of the first frequency, central difference less that of its energies",
        max(apart),
        within=STEP**2,
        why="of a step h a central difference leaves h^2 times the third derivative over 6",
        source="Rayleigh: half of the share of a spring, less half of that of an inertia",
    )


def show(
    page: Page,
    inputs: Sequence[Uncertain],
    slopes: Mapping[str, Mapping[str, float]],
    widths: Mapping[str, Width],
) -> None:
    """Both approaches in one table and one chart, and all inputs together."""
    rows: list[Record] = []
    groups: dict[str, dict[str, float]] = {name: {} for name in (FIRST, LOAD, PEAK, DAMAGE)}
    for one in inputs:
        alone = {name: 100.0 * abs(slopes[one.name][name]) * one.spread for name in QUANTITIES}
        row: Record = {"input": one.name, "Table 4.7": one.row, "± [%]": 100.0 * one.spread}
        row |= {f"approach 1: {name} ± [%]": alone[name] for name in (FIRST, SECOND)}
        row |= {f"approach 2: {name} ± [%]": alone[name] for name in (LOAD, PEAK, DAMAGE)}
        rows.append(row)
        for name, group in groups.items():
            group[one.name] = alone[name]
    page.section("Both approaches")
    page.add(bars(HERO, groups, "half width [%]"))
    page.table("Approach 1, modes, beside approach 2, load cases and rainflow counts", rows)
    page.data("inputs", rows)
    both: list[Record] = [
        {
            "quantity": name,
            "first order ± [%]": 100.0 * width.first_order,
            "samples ± [%]": 100.0 * width.sampled,
        }
        for name, width in widths.items()
    ]
    page.table("All inputs together: half of the band that holds 95 %", both)
    page.data("widths", both)
    page.text(
        "The turbine's torque is the same for all inputs, as the report lets global loads be. "
        "Blades and tower that bend are left out: the model begins at the hub. The command "
        "uncertainty propagates the spreads that a drivetrain's file states to any quantity of "
        "modes, gears, events and lives, at any level."
    )


def weightiest(
    inputs: Sequence[Uncertain], slopes: Mapping[str, Mapping[str, float]], name: str
) -> Uncertain:
    """The input that alone makes a quantity most uncertain."""
    return max(inputs, key=lambda one: abs(slopes[one.name][name]) * one.spread)


def sentences(
    machine: Machine,
    stages: Stages,
    inputs: Sequence[Uncertain],
    slopes: Mapping[str, Mapping[str, float]],
    widths: Mapping[str, Width],
) -> list[Record]:
    """What the report says of uncertain inputs, beside ours."""
    low, high = (slopes[f"stiffness of {machine.shafts[k].name}"][FIRST] for k in (0, -1))
    damping = inputs[-1]
    of_damping = {name: abs(slopes[damping.name][name]) * damping.spread for name in QUANTITIES}
    of = {name: width.first_order / width.sampled for name, width in widths.items()}
    far = {
        name: abs(width.first_order - width.sampled) > max(NEAR * width.sampled, width.band)
        for name, width in widths.items()
    }
    ranks = [weightiest(inputs, slopes, name).name for name in (FIRST, DAMAGE)]
    stiff = {element.name: element.stiffness for element in stages.detailed.elements}
    by_ratio = stiff[stages.low] / (stiff[stages.high] * stages.ratio**2)
    return [
        sentence(
            "stiffness of the high-speed shaft counts with the square of the ratio",
            "4.6.2.4",
            f"1 % of {machine.shafts[0].name} moves the first frequency by {low:.3g} %, 1 % of "
            f"{machine.shafts[-1].name} by {high:.3g} %; stiffnesses by the square of the ratio "
            f"would have {by_ratio * low:.3g} %, if both carried the same torque",
            "holds" if high < 2.0 * by_ratio * low else "does not hold",
        ),
        sentence(
            "identical uncertainty of parts can have very different effects",
            "4.6.2.4",
            f"the same 1 % of two shafts: {low / max(high, 1e-12):.3g} times as much",
            "holds" if low / max(high, 1e-12) > 2.0 else "does not hold",
        ),
        sentence(
            "it is not practical to compute the uncertainty of results analytically",
            "4.6.2.4",
            "half widths by first order are "
            + ", ".join(f"{share:.2f} ({name})" for name, share in of.items())
            + " of those of samples",
            "does not hold" if not any(far.values()) else "holds in part",
        ),
        sentence(
            "damping is the input that is hardest to know",
            "4.6.2.4",
            f"modes do not show it; ± {100 * damping.spread:g} % of it are ± "
            f"{100 * of_damping[PEAK]:.2g} % of the peak in a dip, ± "
            f"{100 * of_damping[DAMAGE]:.2g} % of damage",
            "holds" if of_damping[FIRST] < 1e-9 else "does not hold",
        ),
        sentence(
            "either approach shows what uncertainty is acceptable",
            "4.6.2.4",
            f"by modes {ranks[0]} matters most, by damage {ranks[1]}",
            "holds" if ranks[0] == ranks[1] else "holds in part",
        ),
    ]


def answer(
    page: Page,
    inputs: Sequence[Uncertain],
    slopes: Mapping[str, Mapping[str, float]],
    widths: Mapping[str, Width],
    rows: Sequence[Record],
    spread: float,
) -> None:
    """State how uncertain frequency, load and damage are, and what matters most."""
    hold = sum(row["verdict"] == "holds" for row in rows)
    most = {name: weightiest(inputs, slopes, name) for name in (FIRST, DAMAGE)}
    wide = {name: 100.0 * width.sampled for name, width in widths.items()}
    page.answer(
        "How uncertain are frequencies, loads and damage if the inputs are uncertain?",
        f"With most inputs uncertain by ±\u00a0{100 * spread:g}\u00a0%, the first frequency is "
        f"uncertain by ±\u00a0{formatted(wide[FIRST], 2)}\u00a0%, high-speed shaft damage by "
        f"±\u00a0{formatted(wide[DAMAGE], 2)}\u00a0%, mainly through {most[DAMAGE].name}.",
        [
            *(
                page.value(
                    f"{name}, uncertainty ± [%]",
                    100.0 * widths[name].sampled,
                    100.0 * widths[name].band,
                    beside=100.0 * widths[name].first_order,
                    by="first order",
                )
                for name in (FIRST, LOAD, PEAK, DAMAGE)
            ),
            page.value("statements that hold as they stand", hold, beside=len(rows), by="tested"),
        ],
        hero=HERO,
        cautions=[
            f"The {100 * spread:g} % are assumed, since Table 4.7 of PROTEST gives values for "
            "masses alone; results are nearly proportional to them.",
            f"The first frequency depends most on the {most[FIRST].name}, damage on the "
            f"{most[DAMAGE].name}.".replace("LSS", "low-speed shaft"),
            "Inputs are independent and uniformly distributed; damage is the sum of torque ranges "
            "to the power of 6.6.",
        ],
        claim="holds" if hold == len(rows) else "holds in part",
    )
