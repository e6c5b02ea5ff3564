"""What a study of a drivetrain in time answers: a verdict by event, key figures, cautions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from fe_drivetrain.dynamics.time.machine_channels import Kind, of_planet
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import certain_value, percent_text, value_text
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.part_damage import PartUse
from fe_drivetrain.studies.torque_limits import BY, hardest_limit, limit_figure
from fe_drivetrain.studies.transient_digest import FileDigest
from fe_drivetrain.studies.transient_findings import ENERGY
from fe_drivetrain.studies.transient_instants import ByInstant
from fe_drivetrain.studies.transient_ladder import QUANTITIES, level_error
from fe_drivetrain.studies.transient_parts import part_figures
from fe_drivetrain.studies.transient_runs import Extreme, LevelRun, telling_torque
from fe_drivetrain.studies.transient_tables import alternating_rows

STILL = 1e-4
"""Share of the largest force below which what an offset changes or lets alternate is nothing."""

QUESTIONS = {
    "stop": "What does an emergency stop do to the drivetrain?",
    "grid_loss": "What does the loss of the grid do to the drivetrain?",
    "dip": "What does a dip of the grid's voltage do to the drivetrain?",
    "run_up": "How far do resonances load the drivetrain as it runs up?",
    "offset": "What does the offset do to bearings and meshes?",
    "base": "What does the motion of its base do to the drivetrain?",
    "operation": "What do these histories do to the drivetrain?",
}
"""What is asked, by event."""


@dataclass(frozen=True)
class Beside:
    """What stands beside extremes in an answer.

    Attributes
    ----------
    instants : ByInstant or None
        Peak of a stop by the instant of its brake.
    use : PartUse or None
        What it does to gears and bearings.
    limits : Mapping[str, float]
        Limits of torques, by channel [N m].
    """

    instants: ByInstant | None = None
    use: PartUse | None = None
    limits: Mapping[str, float] = field(default_factory=dict)


class _Answered(NamedTuple):
    """What an answer is made of."""

    found: Findings
    extremes: Mapping[str, Extreme]
    run: LevelRun

    def of_kind(self, kind: Kind) -> dict[str, Extreme]:
        """Channels of a kind that carry something at rated torque."""
        return {
            name: one
            for name, one in self.extremes.items()
            if one.kind == kind and np.isfinite(one.over_rated)
        }

    def worst(self, kind: Kind) -> str:
        """Channel of a kind with the largest value over rated."""
        of = self.of_kind(kind)
        return max(of, key=lambda name: of[name].largest / abs(of[name].rated), default="")

    def heaviest(self, by: Callable[[Extreme], float] = lambda one: one.largest) -> str:
        """Bearing that is loaded most, or by another measure; empty where there is none."""
        of = {name: one for name, one in self.extremes.items() if one.kind == "bearing"}
        return max(of, key=lambda name: by(of[name]), default="")

    def force(self, name: str) -> KeyFigure:
        """Largest force of a bearing beside that at rated torque."""
        one = self.extremes[name]
        band = None if one.most_band is None else one.most_band / 1e3
        rated = abs(_beyond_noise(one)) / 1e3
        return self.found.value(
            f"largest {name} [kN]", one.largest / 1e3, band, beside=rated, by="rated torque"
        )

    @property
    def torque(self) -> str:
        """Torque that tells what happens."""
        return telling_torque(self.extremes)

    @property
    def shaft(self) -> str:
        """The shaft of that torque, in words."""
        name = self.torque.removeprefix("torque of ")
        return name if name.isupper() or "shaft" in name.lower() else f"{name} shaft"

    def over(self, name: str, least: bool = False) -> KeyFigure:
        """Largest or least value of a channel over its rated one."""
        one = self.extremes[name]
        band = one.least_band if least else one.most_band
        share = None if band is None else band / abs(one.rated)
        return self.found.value(
            f"{'least' if least else 'largest'} {name}, over rated",
            one.least_over_rated if least else one.over_rated,
            None if share is None or share < ENERGY else share,
        )


def state_answer(
    found: Findings,
    event: str,
    extremes: Mapping[str, Extreme],
    run: LevelRun,
    runs: Sequence[LevelRun],
    number: int,
    files: Mapping[str, FileDigest],
    quantity: Kind,
    beside: Beside,
) -> None:
    """State what the event does, with the level that it needs.

    Parameters
    ----------
    found : Findings
        Takes the answer.
    event : str
        Name of the event.
    extremes : Mapping[str, Extreme]
        Extremes by channel.
    run : LevelRun
        The run that is reported.
    runs : sequence of LevelRun
        All levels.
    number : int
        Number of the level that is reported.
    files : Mapping[str, FileDigest]
        What happened over each history.
    quantity : str
        For which the level has to be enough.
    beside : Beside
        Instants of the brake, damage of gears and bearings, limits of torques.
    """
    of = _Answered(found, extremes, run)
    verdict, figures = _VERDICTS[event](of, files)
    if beside.instants is not None:
        figures.insert(2, _by_instant(found, of, beside.instants, beside.limits))
    if len(runs) > 1:
        error = level_error(runs[number], runs[-1], quantity).error
        _say_level(found, runs, number, quantity, error)
    last = [*limit_figure(found, beside.limits, extremes), *part_figures(found, beside.use)]
    shown = [*figures[: 6 - len(last)], *last]
    beyond = _beyond(of, beside)
    if beyond:  # what else happens stands in the figures
        verdict = f"{verdict.partition(';')[0].removesuffix('.')}, {beyond}."
    found.answer(
        QUESTIONS[event], verdict, shown, cautions=_cautions(event, run, files, beside.instants)
    )


def _beyond(of: _Answered, beside: Beside) -> str:
    """Which limit is passed, now or with the brake at another instant; empty where none is."""
    hardest, instants = hardest_limit(beside.limits, of.extremes), beside.instants
    if hardest is not None and of.extremes[hardest].largest > beside.limits[hardest]:
        return f"beyond the limit of the {hardest.removeprefix('torque of ')}"
    if instants is None or instants.channel not in beside.limits:
        return ""
    peak = max(instants.peaks) * abs(of.extremes[instants.channel].rated)
    return "braked at another instant beyond its limit" * (peak > beside.limits[instants.channel])


def _by_instant(
    found: Findings, of: _Answered, instants: ByInstant, limits: Mapping[str, float]
) -> KeyFigure:
    """The largest peak by the instant of the brake, with the limit of its shaft."""
    low, high = min(instants.peaks), max(instants.peaks)
    found.say(
        f"By the instant of the brake within {instants.period:.3g} s, a period of the first "
        f"mode, the {instants.channel} comes to {low:.2f} to {high:.2f} of rated after it."
    )
    name = f"largest {instants.channel} by the instant of the brake, over rated"
    limit = limits.get(instants.channel)
    if limit is None:
        return found.value(name, high)
    rated = abs(of.extremes[instants.channel].rated)
    return found.value(name, high, at_most=limit / rated, by=BY)


def _say_level(
    found: Findings, runs: Sequence[LevelRun], number: int, quantity: Kind, error: float
) -> None:
    level, what = runs[number].rung.name, QUANTITIES[quantity]
    if number == len(runs) - 1:
        found.say(f"Only the finest level, {level}, is within the tolerance for {what}.")
        return
    found.say(
        f"The level {level} is enough for {what}: its error against {runs[-1].rung.name} is "
        f"{percent_text(error)}."
    )


def _cautions(
    event: str, run: LevelRun, files: Mapping[str, FileDigest], instants: ByInstant | None
) -> list[str]:
    """What limits the verdict, most severe first."""
    said = []
    if event == "stop":
        others = ""
        if instants is not None:
            others = (
                f"; at others the {instants.channel} reaches {max(instants.peaks):.2f} of rated"
            )
        said.append(
            "Peaks and damage are of one instant of the brake within a swing of the first "
            f"mode{others}."
        )
    if event in ("stop", "grid_loss", "dip"):
        said.append("Times and controls of the event, where not stated, are assumptions.")
    if event == "dip":
        said.append("The generator's torque follows the table at any speed, without damping.")
    if event == "run_up":
        said.append("Meshes vary as square waves of their contact ratio, without tip relief.")
        said.append("Damage of teeth has K_v beside vibrations of meshes that are in the forces.")
    absent = sorted({one.absent for one in files.values() if one.absent})
    if absent:
        which = "Histories" if all(one.absent for one in files.values()) else "Some histories"
        said.append(f"{which} have no {' and no '.join(absent)}: their torque acts alone.")
    if event == "operation" and any(not one.own_generator for one in files.values()):
        said.append("A file has no torque of its generator: a line of slip stands for it.")
    if any(of_planet(name) and run.extremes[name].kind == "bearing" for name in run.extremes):
        planets = "travel with their carrier" if run.planets_travel else "stand at one azimuth"
        said.append(f"Planets {planets}: forces of bearings are of that.")
    said.append(
        "Damping is by ratios, and swings decay as these say; friction of bearings and teeth takes "
        "no torque, so that those behind the rotor are too large by it."
    )
    return said[:3]


def _stop(of: _Answered, _: Mapping[str, FileDigest]) -> tuple[str, list[KeyFigure]]:
    name = of.torque
    one, stands = of.extremes[name], of.run.marks.get("disc stands")
    turned = one.least_over_rated < -0.005
    most, least = of.over(name), of.over(name, least=True)
    verdict = (
        f"The stop loads the {of.shaft} to {certain_value(most)} of rated "
        f"torque{f' and back to {certain_value(least)}' if turned else ''}; "
        + (
            f"its disc first stands after {value_text(stands, 's')}."
            if stands
            else "it still turns."
        )
    )
    figures = [most, least, *_others(of)]
    if stands:
        figures.append(of.found.value("disc first stands at [s]", stands))
    return verdict, figures


def _grid_loss(of: _Answered, _: Mapping[str, FileDigest]) -> tuple[str, list[KeyFigure]]:
    one, speed = of.extremes[of.torque], of.extremes["speed of generator"]
    turned, least = one.least_over_rated < -0.005, of.over(of.torque, least=True)
    verdict = (
        f"Losing the grid {'reverses' if turned else 'lowers'} the torque of the "
        f"{of.shaft} to {certain_value(least)} of rated; the "
        f"generator reaches {speed.over_rated:.2f} of its speed."
    )
    figures = [least, of.over("speed of generator"), of.over(of.torque)]
    return verdict, [*figures, *_others(of)]


def _dip(of: _Answered, _: Mapping[str, FileDigest]) -> tuple[str, list[KeyFigure]]:
    most, least = of.over(of.torque), of.over(of.torque, least=True)
    verdict = (
        f"The dip swings the torque of the {of.shaft} between "
        f"{certain_value(least)} and {certain_value(most)} of rated."
    )
    figures = [most, least, *_others(of)]
    return verdict, [*figures, of.over("speed of generator")]


def _run_up(of: _Answered, _: Mapping[str, FileDigest]) -> tuple[str, list[KeyFigure]]:
    mesh = of.worst("mesh")
    one = of.extremes[mesh]
    rotor = of.extremes["speed of rotor"]
    speed = float(np.interp(one.most_at, of.run.samples.times, of.run.samples.of("speed of rotor")))
    verdict = (
        f"On the way up the {mesh} reaches {one.over_rated:.2f} of rated, at "
        f"{speed / rotor.rated:.2f} of rated speed."
    )
    figures = [of.over(mesh), of.found.value("rotor speed there, over rated", speed / rotor.rated)]
    return verdict, [*figures, of.over(of.torque), *_others(of)[1:]]


def _offset(of: _Answered, _: Mapping[str, FileDigest]) -> tuple[str, list[KeyFigure]]:
    rows = alternating_rows(of.run)
    moved = max(rows, key=lambda row: abs(float(row["change of the mean [kN]"])))
    name, by = str(moved["force"]), float(moved["change of the mean [kN]"])
    verdict = "The offset changes no mean force of a bearing or mesh"
    figures: list[KeyFigure] = []
    changes = abs(by) > _uncertain(moved)
    if changes:
        band = float(moved["± of these [kN]"])
        verdict = f"The offset changes the {name} by {value_text(by, 'kN', band, with_band=False)}"
        figures.append(of.found.value(f"{name}, change of its mean [kN]", by, band))
    swinging = [row for row in rows if _swing(row) > max(_uncertain(row), STILL * abs(by))]
    if not swinging:
        if changes:
            figures.append(of.found.value(f"{name}, largest [kN]", moved["largest [kN]"]))
        return f"{verdict}, and nothing alternates.", [*figures, *_others(of)]
    most = max(swinging, key=_swing)
    swing = value_text(_swing(most), "kN")
    verdict += f"; the {most['force']} alternates by up to {swing} each turn."
    figures += [
        of.found.value(f"{most['force']}, {key}", most[key])
        for key in ("once a turn [kN]", "twice a turn [kN]", "largest [kN]")
    ]
    return verdict, figures


def _swing(row: Record) -> float:
    """What alternates with the generator's turns [kN]."""
    return float(row["once a turn [kN]"]) + float(row["twice a turn [kN]"])


def _uncertain(row: Record) -> float:
    """What a force has to change by, or alternate, to count [kN]."""
    return max(float(row["± of these [kN]"]), STILL * abs(float(row["largest [kN]"])))


def _base(of: _Answered, _: Mapping[str, FileDigest]) -> tuple[str, list[KeyFigure]]:
    worst = of.heaviest(lambda one: max(one.most - one.rated, one.rated - one.least))
    one = of.extremes[worst]
    values = one.least, one.most, _beyond_noise(one)
    least, most, rated = (value_text(v / 1e3, "kN") for v in values)
    verdict = f"As the base moves, the {worst} is between {least} and {most}, beside {rated}."
    return verdict, [of.force(worst), of.over(of.torque), *_others(of)[:1]]


def _beyond_noise(one: Extreme) -> float:
    """Value at rated torque; 0 where it is as good as that."""
    return one.rated if abs(one.rated) > 1e-6 * one.largest else 0.0


def _operation(of: _Answered, files: Mapping[str, FileDigest]) -> tuple[str, list[KeyFigure]]:
    most, least = of.over(of.torque), of.over(of.torque, least=True)
    count = len(files)
    verdict = (
        f"In {count} histor{'y' if count == 1 else 'ies'} the torque of the "
        f"{of.shaft} is between {certain_value(least)} and "
        f"{certain_value(most)} of rated."
    )
    apart = max(digest.against_file for digest in files.values())
    against = of.found.value("torque against the files, RMS [% of rated]", 100.0 * apart)
    return verdict, [most, least, *_others(of), against]


def _others(of: _Answered) -> list[KeyFigure]:
    """Mesh that is loaded most over rated, and bearing that is loaded most."""
    mesh, bearing = of.worst("mesh"), of.heaviest()
    return [*([of.over(mesh)] if mesh else []), *([of.force(bearing)] if bearing else [])]


_VERDICTS = {
    "stop": _stop,
    "grid_loss": _grid_loss,
    "dip": _dip,
    "run_up": _run_up,
    "offset": _offset,
    "base": _base,
    "operation": _operation,
}
