"""Torques of shafts and mesh loads at rated torque, by models of one drivetrain: a round robin."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.dynamics import Machine, load_sharing, machine_of, plain_rungs
from fe_drivetrain.dynamics.time.machine_channels import machine_channels
from fe_drivetrain.dynamics.time.running import running
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

OWN_MODELS = ("nrel_750kw", "grc_750kw")
"""Drivetrain D in the library: torsional data of the thesis with public gears; all of it public."""
LOADS = "Force of each sun-planet mesh over what statics give, by model"
SMALL = 1e-9


class Rated(NamedTuple):
    """Values of a model at rated torque.

    Attributes
    ----------
    model : str
        Drivetrain and level.
    torques : dict
        Torque of each shaft, from the rotor on [N m].
    meshes : dict
        Force of each mesh along its line of action [N].
    """

    model: str
    torques: dict[str, float]
    meshes: dict[str, float]

    def planets(self, kind: str, stage: int = 1) -> list[float]:
        """Forces of the meshes of a stage's planets, "sun-planet" or "ring-planet" [N]."""
        begins = f"stage {stage} {kind}"
        return [force for name, force in self.meshes.items() if name.startswith(begins)]


@case(
    "Round robin at rated torque: torques of shafts and loads of meshes by level of the model",
    source="Al-Hamadani 2018, section 6.1.1, Figure 6.1",
    settings={"drivetrain": "FILE, or a name of the library (otherwise both of the 750 kW)"},
)
def run(run: Run, page: Page) -> None:
    """Every model of a drivetrain at rated torque beside statics."""
    found: list[Rated] = []
    machines: list[Machine] = []
    for name in [""] if SETTING in run.settings else OWN_MODELS:
        chosen = run.drivetrain(name, gears=True)
        if SETTING in run.settings:
            chosen.state(page, topic="Torques of shafts and loads of meshes at rated torque")
        else:
            page.about(chosen.drivetrain, name)
        machine = machine_of(chosen.drivetrain)
        machines.append(machine)
        torque, speed = chosen.rated_torque(), chosen.rotor_speeds()[1]
        with run.step(chosen.title), page.of(chosen.drivetrain, chosen.name):
            models = rated_models(chosen.drivetrain, machine, name or chosen.title, torque, speed)
            for one in models:
                check(page, one, machine, torque)
        found += models
    if SETTING in run.settings:
        own_answer(page, found, not machines[0].not_given)
    else:
        answer(page, found)
    show(page, found, machines[0])
    if SETTING not in run.settings:
        show_verdicts(page, found)


def rated_models(
    drivetrain: Drivetrain, machine: Machine, title: str, torque: float, speed: float
) -> list[Rated]:
    """A machine at each level that its file has data for, turning at rated torque.

    Parameters
    ----------
    drivetrain, machine : Drivetrain, Machine
        The drivetrain, and its table of parts.
    title : str
        What it is called.
    torque, speed : float
        Torque [N m] and speed [rad/s] of the rotor.
    """
    models = []
    for rung in plain_rungs(drivetrain, machine):
        channels = machine_channels(
            running(machine, rung.level, torque, speed, flexible=rung.flexible)
        )
        values: dict[str, dict[str, float]] = {"torque": {}, "mesh": {}}
        for name, kind, value in zip(channels.names, channels.kinds, channels.rated, strict=True):
            if kind in values:
                values[kind][name.partition(" of ")[2]] = float(value)
        models.append(Rated(f"{title}, {rung.name}", values["torque"], values["mesh"]))
    return models


def check(page: Page, one: Rated, machine: Machine, torque: float) -> None:
    """Torques, and the sum of mesh forces of planets, against statics."""
    ratios = [abs(speed) for speed in machine.speeds]
    off = [
        abs(value * ratio / torque - 1.0)
        for value, ratio in zip(one.torques.values(), ratios, strict=True)
    ]
    page.vanishes(
        f"{one.model}: torques of shafts over those of statics, less 1",
        max(off),
        within=SMALL,
        why="round-off: nothing but the ratios of teeth decides torques at rest",
        source="torque of the rotor over the ratio",
    )
    radius = sun_radius(machine)
    if radius is not None:
        first, second = ratios[:2]
        page.equals(
            f"{one.model}: sum of sun-planet forces [kN]",
            sum(one.planets("sun-planet")) / 1e3,
            torque * first / second / radius / 1e3,
            within=SMALL,
            why="round-off: the sun's torque over its base radius",
            source="statics",
            measure="reaction",
        )


def sun_radius(machine: Machine) -> float | None:
    """Lever of a sun mesh's force on the sun's axis, its base radius over the helix [m].

    None of a machine whose first stage has no planets or no module.
    """
    stage = machine.stages[0]
    if stage.kind != "planetary" or stage.module is None or stage.teeth is None:
        return None
    helix, angle = np.radians(stage.helix), np.radians(stage.pressure_angle)
    across = np.arctan(np.tan(angle) / np.cos(helix))
    base = 0.5 * stage.module * stage.teeth.sun / np.cos(helix) * np.cos(across)
    along = np.arcsin(np.sin(helix) * np.cos(angle))
    return float(base * np.cos(along))


def spread(found: list[Rated], kind: str) -> float:
    """Largest share by which a planet's mesh carries more than the mean, of all models."""
    return max(load_sharing(np.array(one.planets(kind))) - 1.0 for one in found)


def answer(page: Page, found: list[Rated]) -> None:
    """State what can differ between models at rated torque."""
    rounding = of_rounding(found[0])
    sun, ring = spread(found, "sun-planet"), spread(found, "ring-planet")
    decides = sun > 10.0 * rounding
    first = found[0]
    page.answer(
        "What does it prove that models agree at rated torque, as in the thesis's round robin?",
        "Agreement of models at rated torque proves little: statics fixes all shaft torques; only "
        f"planet sharing differs, by {value_text(100 * sun, '%')} of the mean mesh force."
        if decides
        else "Agreement of models at rated torque proves nothing: statics fixes all torques, and "
        f"mesh forces differ by {value_text(100 * sun, '%')}.",
        [
            *(
                page.value(f"torque of {name} [kN m]", value / 1e3)
                for name, value in list(first.torques.items())[:4]
            ),
            page.value("mean force of a sun-planet mesh [kN]", mean(first) / 1e3),
            page.value(
                "largest excess of a sun-planet mesh force over the mean [%]",
                100.0 * sun,
                beside=100.0 * ring,
                by="ring-planet",
            ),
        ],
        LOADS,
        [
            f"Computed torques have the printed ratios within {percent_text(rounding)}, which is "
            "the rounding of the print.",
            "Results of the partners A to F are printed as a figure alone, and are not compared.",
            "The rated torque that the partners used is not printed: Table 4.1 has 18.6 rpm, the "
            "machine 22.1 rpm.",
        ],
    )


def own_answer(page: Page, found: list[Rated], sized: bool) -> None:
    """State torques and mesh loads of a user's drivetrain at rated torque."""
    first, last = found[0], found[-1]
    torques = list(first.torques.values())
    figures = [
        page.value("torque of the generator over that of the rotor", torques[-1] / torques[0]),
        *(
            page.value(f"torque of {name} [kN m]", value / 1e3)
            for name, value in list(first.torques.items())[:3]
        ),
    ]
    if not sized:
        words = "loads of meshes need sizes of gears, which the file does not give"
        hero = TORQUES
    else:
        most = max(last.meshes, key=lambda name: last.meshes[name] / first.meshes[name])
        over = last.meshes[most] / first.meshes[most] - 1.0
        figures.append(page.value(f"largest force, {most} [kN]", last.meshes[most] / 1e3))
        words = f"the {most} carries up to {percent_text(over)} more than in torsion"
        if first.planets("sun-planet"):
            more = 1.0 + spread(found, "sun-planet")
            figures.append(page.value("largest sun-planet force over the mean", more))
        hero = LOADS if first.planets("sun-planet") else MESHES
    page.answer(
        "Which torques and mesh loads does the drivetrain have at rated torque?",
        f"The rotor has {torques[0] / 1e3:.4g}\u00a0kN\u00a0m, the generator "
        f"{torques[-1] / 1e3:.4g}\u00a0kN\u00a0m; {words}.",
        figures,
        hero,
    )


TORQUES = "Torque of each shaft at rated torque"
MESHES = "Force of each mesh over that in torsion, by model"


def mean(one: Rated) -> float:
    """Mean force of the first stage's sun-planet meshes [N]."""
    return float(np.mean(one.planets("sun-planet")))


def of_rounding(one: Rated) -> float:
    """Largest share by which ratios as printed in Table 4.2 move a torque."""
    speeds = published.table("nrel_750kw").speeds
    torques = list(one.torques.values())
    return max(
        abs(torques[0] / speed / torque - 1.0)
        for speed, torque in zip(speeds, torques, strict=True)
    )


def show(page: Page, found: list[Rated], machine: Machine) -> None:
    """Torques and forces of all models."""
    page.section("At rated torque")
    shafts = {one.model: {k: v / 1e3 for k, v in one.torques.items()} for one in found}
    page.table(
        "Torques of shafts [kN m]",
        [{"model": model, **torques} for model, torques in shafts.items()],
    )
    page.data("models", [one._asdict() for one in found])
    if machine.not_given:
        page.add(bars(TORQUES, shafts, "torque [kN m]"))
        return
    page.table(
        "Forces of meshes along their lines of action [kN]",
        [
            {"model": one.model, **{name: value / 1e3 for name, value in one.meshes.items()}}
            for one in found
        ],
    )
    if found[0].planets("sun-planet"):
        page.add(bars(LOADS, by_planet(found), "force over that of statics"))
    else:
        first = found[0].meshes
        shares = {one.model: {k: v / first[k] for k, v in one.meshes.items()} for one in found}
        page.add(bars(MESHES, shares, "force over that in torsion"))
    page.text(
        "The sum of the meshes of all planets is fixed by the sun's torque in every model. What "
        "bearings, gravity and shafts that bend decide is how planets share it, here with the "
        f"carrier at one angle; the {machine.title.partition(' (')[0]} turns on, and each planet "
        "comes to every place."
    )


def by_planet(found: list[Rated]) -> dict[str, dict[str, float]]:
    """Force of each sun-planet mesh over the mean, by model."""
    return {
        one.model: {
            f"planet {k}": force / mean(one)
            for k, force in enumerate(one.planets("sun-planet"), start=1)
        }
        for one in found
    }


def show_verdicts(page: Page, found: list[Rated]) -> None:
    """Show statements on the round robin beside ours."""
    rounding = of_rounding(found[0])
    _, power, speed = published.RATED["D"]
    rated = power / (speed * np.pi / 30.0) / found[0].torques[next(iter(found[0].torques))]
    rows: list[Record] = [
        {
            "statement": "torque levels were close to those of the partners A to F",
            "ours": f"any model of these teeth has them; rounded ratios move them by "
            f"{percent_text(rounding)}",
            "verdict": "not testable against the partners; agreement tests the ratios alone",
            "missing, and what a guess moves": "the partners' values; rated torque: at the 18.6 "
            f"rpm of Table 4.1 all are {rated:.2f} times as large",
        },
        {
            "statement": "ring-planet and sun-planet loads were close to those of the partners",
            "ours": f"means are fixed by the base radius; planets differ by up to "
            f"{percent_text(spread(found, 'sun-planet'))} with gravity and bearings",
            "verdict": "not testable; a torsional model has no sharing to compare",
            "missing, and what a guess moves": "the partners' values, and which planet and angle "
            "they are of",
        },
        {
            "statement": "small errors are due to assumptions of the gearbox model",
            "ours": f"models with other stiffnesses and bearings differ by {apart(found):.0e} in "
            "torques and mean loads",
            "verdict": "does not hold for torques and mean loads"
            if apart(found) < SMALL
            else "holds",
            "missing, and what a guess moves": "nothing",
        },
    ]
    page.section("Printed, ours, verdict")
    page.table("Statements on the round robin", rows)


def apart(found: list[Rated]) -> float:
    """Largest share by which models differ in a torque or in the mean load of planets' meshes."""
    values = np.array([[*one.torques.values(), mean(one)] for one in found])
    return float((np.ptp(values, axis=0) / values.mean(axis=0)).max())
