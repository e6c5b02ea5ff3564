"""What each of the six steps of a project lacks before it is complete: rules, and nothing else.

A step is complete when it has a decision, all of its evidence counts, and its own rules hold:
PROTEST 2010, section 3, with Tables 4.1 to 4.10 behind them. What it lacks stands in sentences.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any

from fe_drivetrain.procedure.certainty import lacks_of_inputs
from fe_drivetrain.procedure.evidence import Claim, Found
from fe_drivetrain.procedure.failure_modes import NUMBERS, Catalogue, DesignLoad
from fe_drivetrain.procedure.methods import MethodAnswer
from fe_drivetrain.procedure.project import (
    SECTIONS,
    Identified,
    Need,
    Project,
)
from fe_drivetrain.procedure.sensors import sampling_rates
from fe_drivetrain.procedure.tolerances import WIDEST, is_guess, why_vacuous
from fe_drivetrain.report.results import DrivetrainRecord, Results, Verdict
from fe_drivetrain.shafts.fidelity.quantity import ERROR_AGAINST_LAST, LEVEL_ERRORS, OWN_ERROR

Evidence = Mapping[Claim, Found]

_NEEDED = "model.needs: tolerance"
_ACCURACY = "campaign.signals: accuracy"
_COMPARED = "comparison.quantities: tolerance"
_DETERMINED = "comparison.identified: tolerance"


@dataclass(frozen=True)
class Measured:
    """What files of channels gave.

    Attributes
    ----------
    windows : Mapping[int, int] or None
        Windows by mean wind in whole m/s, of those that are wanted; None without a capture matrix.
    verdicts : tuple of Verdict
        Comparisons of step 6.
    missing : Mapping[int, str]
        Files that are not there, in a sentence, by the step that needs them.
    faults : tuple of str
        Why files of campaign and comparison are none of a measurement, in sentences.
    spreads : Mapping[str, float]
        Half width, as a share, of inputs that signals determine, by the input's name.
    methods : Mapping[str, tuple[MethodAnswer, ...]]
        What each method of identification finds, by the channel of the torque.
    """

    windows: Mapping[int, int] | None = None
    verdicts: tuple[Verdict, ...] = ()
    missing: Mapping[int, str] = field(default_factory=dict)
    faults: tuple[str, ...] = ()
    spreads: Mapping[str, float] = field(default_factory=dict)
    methods: Mapping[str, tuple[MethodAnswer, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class StepState:
    """A step of a project.

    Attributes
    ----------
    number : int
        From 1 to 6.
    decision : str
        As the project has it; empty where it was not begun.
    lacks : tuple of str
        What is missing, in sentences.
    evidence : tuple of Found
        All of it.
    """

    number: int
    decision: str
    lacks: tuple[str, ...]
    evidence: tuple[Found, ...]

    @property
    def begun(self) -> bool:
        """Whether the project has it."""
        return bool(self.decision)

    @property
    def complete(self) -> bool:
        """Whether nothing is missing."""
        return not self.lacks


def claims_of(project: Project) -> tuple[tuple[Claim, ...], ...]:
    """All links of each step with what they stand for, each once.

    Parameters
    ----------
    project : Project
        With steps begun or not.
    """
    found = []
    for step, key in zip(project.steps, SECTIONS, strict=True):
        claims = [Claim(link) for link in (step.evidence if step else ())]
        if key == "failure_modes" and project.failure_modes:
            gaps = project.failure_modes.gaps
            claims += [Claim(link, (gap.load,), True) for gap in gaps for link in gap.evidence]
        if key == "load_cases" and project.load_cases:
            cases = project.load_cases.cases
            claims += [Claim(link, case.loads) for case in cases for link in case.evidence]
        found.append(tuple(dict.fromkeys(claims)))
    return tuple(found)


def assessed(
    project: Project, catalogue: Catalogue, evidence: Evidence, measured: Measured
) -> tuple[StepState, ...]:
    """The six steps, and what each lacks.

    Parameters
    ----------
    project : Project
        As read.
    catalogue : Catalogue
        Design loads.
    evidence : mapping of Claim to Found
        Evidence of all `claims_of` the project.
    measured : Measured
        Measurements in its files.

    Returns
    -------
    tuple of StepState

    Raises
    ------
    InputError
        The project names a system that the catalogue does not have.
    """
    loads = {load.name: load for system in project.systems for load in catalogue.of(system)}
    rules: Sequence[Callable[[], list[str]]] = (
        lambda: _failure_modes(project, loads),
        lambda: _model(project, evidence),
        lambda: _load_cases(project, loads, evidence),
        lambda: lacks_of_inputs(project, measured.spreads),
        lambda: _campaign(project, measured),
        lambda: _comparison(project, measured),
    )
    states = []
    for number, (step, claims, rule) in enumerate(
        zip(project.steps, claims_of(project), rules, strict=True), start=1
    ):
        found = tuple(evidence[claim] for claim in claims)
        if step is None:
            key = SECTIONS[number - 1]
            states.append(StepState(number, "", (f"it was not begun: add the section {key}",), ()))
            continue
        files = [measured.missing[number]] if number in measured.missing else []
        lacks = [
            *rule(),
            *files,
            *(f"{one.claim.name}: {one.why}" for one in found if not one.counts),
        ]
        states.append(StepState(number, step.decision, tuple(lacks), found))
    return tuple(states)


def _failure_modes(project: Project, loads: Mapping[str, DesignLoad]) -> list[str]:
    step = project.failure_modes
    assert step is not None
    lacks = []
    if not step.critical:
        lacks.append("no design load is critical: name those that matter under critical")
    for one in step.critical:
        if one.load not in loads:
            lacks.append(_unknown(one.load, loads))
        elif not (one.variables or loads[one.load].variables):
            lacks.append(f"{one.load!r} has no critical design variable: name one under variables")
    answered = {gap.load: gap for gap in step.gaps}
    for name in answered:
        if name not in loads:
            lacks.append(_unknown(name, loads))
    for load in loads.values():
        gap = answered.get(load.name)
        dismissed = gap is not None and not is_guess(gap.dismissed)
        if load.covered != "yes" and (gap is None or not (gap.evidence or dismissed)):
            lacks.append(
                f"{load.name!r} is covered by no load case: run {load.remedy} and link it under "
                "gaps, or state there why it is dismissed"
            )
    return lacks


def _unknown(name: str, loads: Mapping[str, DesignLoad]) -> str:
    close = get_close_matches(name, loads, n=1, cutoff=0.6)
    if close:
        return f"{name!r} is no design load of these systems: did you mean {close[0]!r}?"
    names = ", ".join(f"{load!r}" for load in loads)
    return f"{name!r} is no design load of these systems: use one of {names}"


def _model(project: Project, evidence: Evidence) -> list[str]:
    step = project.model
    assert step is not None
    lacks = [] if step.needs else ["no quantity decides the level: name one under needs"]
    own = [f for link in step.evidence if (f := evidence[Claim(link)]).record is not None]
    for need in step.needs:
        if why := why_vacuous(f"the tolerance of {need.quantity!r}", need.tolerance, _NEEDED):
            lacks.append(why)
        found = [
            needed
            for f in own
            if f.results and f.record and (needed := needed_of(f.results, f.record, need))
        ]
        wanted = f"{need.quantity} within {100 * need.tolerance:g} %"
        if not found and len(own) < len(step.evidence):
            continue  # that is said of the evidence
        if not found:
            lacks.append(
                f"no evidence says which level {wanted} needs: link results of fe-drivetrain "
                "modes for frequencies, gears for K_gamma and K_Hbeta, transient for torques and "
                "forces in time, or advise for any one quantity, whose name it must have"
            )
            continue
        # of several results the one that asks for most
        levels, least = max(found, key=lambda one: len(one[0]) if one[1] is None else one[1])
        chosen = _place(step.level, levels)
        if chosen is None:
            names = ", ".join(name for _, name in levels)
            lacks.append(f"level {step.level!r} is not on the ladder: use one of {names}")
        elif least is None:
            lacks.append(
                f"no level is known to give {wanted}: run its evidence again with a finer mesh, "
                f"or under model.needs set tolerance above {need.tolerance:g} and below "
                f"{WIDEST:.3g}"
            )
        elif chosen < least:
            lacks.append(f"level {step.level!r} is too simple: {wanted} needs {levels[least][1]!r}")
    return lacks


def _place(level: str, levels: Sequence[tuple[str, str]]) -> int | None:
    return next((k for k, names in enumerate(levels) if level in names), None)


def needed_of(
    results: Results, record: DrivetrainRecord, need: Need
) -> tuple[list[tuple[str, str]], int | None] | None:
    """Which level a quantity needs, by the adviser's or the ladder's results.

    Parameters
    ----------
    results : Results
        Results of ``fe-drivetrain advise`` or ``modes``, or of the case of levels of a drivetrain.
    record : DrivetrainRecord
        How the results call the drivetrain.
    need : Need
        Quantity and tolerance.

    Returns
    -------
    levels : list of tuple
        Number and name of each, from the simplest.
    needed : int or None
        Place of the simplest that is good enough; None where none is known to be. All of it is None
        where the results say nothing of the quantity.
    """
    figures = results.figures
    if (stated := figures.get(LEVEL_ERRORS, {}).get(need.quantity)) is not None:
        names = [(str(k), str(name)) for k, name in enumerate(stated["levels"])]
        return names, _of_errors(stated[ERROR_AGAINST_LAST], stated[OWN_ERROR], need.tolerance)
    ladder = figures.get(f"ladder_{record.name}")
    rows = ladder or figures.get("levels")
    machine = bool(ladder or (rows and need.quantity in rows[0]))
    if not rows or (not machine and figures.get("quantity") != need.quantity):
        return None
    if not machine and OWN_ERROR not in rows[0]:  # of an older program
        return None
    if machine:
        levels = [(str(k), str(row["level"])) for k, row in enumerate(rows)]
        return levels, _of_ladder([row.get(need.quantity) for row in rows], need.tolerance)
    levels = [(str(row["level"]), str(row["title"])) for row in rows]
    return levels, _of_advice(rows, need.tolerance)


def _of_ladder(values: Sequence[float | None], tolerance: float) -> int | None:
    """The least level from which on all are good enough, as of `dynamics.needed_level`."""
    finest, least = values[-1], None
    for k in range(len(values) - 1, -1, -1):
        value = values[k]
        if finest is None or value is None or abs(value - finest) > tolerance * abs(finest):
            break
        least = k
    return least


def _of_errors(errors: Sequence[float | None], own: float, tolerance: float) -> int | None:
    """The least level from which on all are within the tolerance, with the last one's own error."""
    least = None
    for k in range(len(errors) - 1, -1, -1):
        error = errors[k]
        if error is None or not error + own <= tolerance:
            break
        least = k
    return least


def _of_advice(rows: Sequence[Mapping[str, Any]], tolerance: float) -> int | None:
    """Choice of the adviser: statics decides, or difference and band of the last are small."""
    top = rows[-1][OWN_ERROR]
    for k, row in enumerate(rows):
        if row[OWN_ERROR] == 0.0:
            return k
        difference = 0.0 if row is rows[-1] else row[ERROR_AGAINST_LAST]
        if None not in (difference, top) and difference + top <= tolerance:
            return k
    return None


def _load_cases(project: Project, loads: Mapping[str, DesignLoad], evidence: Evidence) -> list[str]:
    step = project.load_cases
    assert step is not None
    lacks = [] if step.cases else ["no load case is named: add some under cases"]
    for case in step.cases:
        name = f"{case.standard} {case.edition} {case.number}"
        known = NUMBERS.get((case.standard, case.edition))
        if known and case.number not in known:
            lacks.append(
                f"{case.standard} edition {case.edition} has no load case {case.number}: use one "
                f"of {', '.join(known)}, or 'own' as standard"
            )
        if not case.loads:
            lacks.append(f"{name} brings no design load about: name some under loads")
        if not case.evidence:
            lacks.append(f"{name} was not run: link where it was under evidence")
        lacks += [f"{name}: {_unknown(one, loads)}" for one in case.loads if one not in loads]
        found = [evidence[Claim(link, case.loads)] for link in case.evidence]
        answered = {load for one in found if one.answer for load in one.answer.loads}
        lacks += [
            f"{name}: no evidence answers {one!r}: link a quantity of that load with its limit"
            for one in case.loads
            if one in loads and found and one not in answered and all(f.counts for f in found)
        ]
    modes = project.failure_modes
    brought = {load for case in step.cases for load in case.loads}
    brought |= {gap.load for gap in modes.gaps} if modes else set()
    for one in modes.critical if modes else ():
        if one.load not in brought:
            lacks.append(f"no load case brings {one.load!r} about, which step 1 calls critical")
    return lacks


def _campaign(project: Project, measured: Measured) -> list[str]:
    step = project.campaign
    assert step is not None
    lacks = [] if step.signals else ["no signal is recorded: add some under signals"]
    for signal in step.signals:
        least, _ = sampling_rates(signal.highest)
        if signal.rate < least:
            lacks.append(
                f"{signal.name!r} is sampled at {signal.rate:g} Hz, but {signal.highest:g} Hz need "
                f"{least:g} Hz or more"
            )
        if why := why_vacuous(f"the accuracy of {signal.name!r}", signal.accuracy, _ACCURACY):
            lacks.append(why)
    if step.capture is None:
        lacks.append("there is no capture matrix: add capture")
    elif measured.windows is not None:
        for wind, count in measured.windows.items():
            if count < step.capture.target:
                lacks.append(
                    f"{wind} m/s has {count} of {step.capture.target} windows of ten minutes"
                )
    return lacks


def _comparison(project: Project, measured: Measured) -> list[str]:
    step = project.comparison
    assert step is not None
    lacks = []
    if not (step.quantities or step.identified):
        lacks.append("nothing is compared: add quantities or identified")
    compared = [(f"{one.channel}: {one.statistic}", one.tolerance) for one in step.quantities]
    determined = [(f"what {one.torque!r} determines", one.tolerance) for one in step.identified]
    for wide, key in ((compared, _COMPARED), (determined, _DETERMINED)):
        whys = (why_vacuous(f"the tolerance of {what!r}", share, key) for what, share in wide)
        lacks += filter(None, whys)
    for one in step.identified:
        lacks += _other_inputs(project, one)
    lacks += measured.faults
    lacks += [
        f"{v.quantity} is {v.computed:.4g} {v.unit} in the model and {v.reference:.4g} {v.unit} "
        f"as measured, {100 * v.tolerance:g} % are allowed: improve model or campaign"
        for v in measured.verdicts
        if not v.passed
    ]
    return lacks


def _other_inputs(project: Project, one: Identified) -> list[str]:
    """Inputs of step 4 that signals are said to determine, where these are other values."""
    values = {value.name: value for value in project.inputs.values} if project.inputs else {}
    lacks = []
    for name, model, unit in (
        (one.stiffness_of, one.stiffness, "N m/rad"),
        (one.damping_of, one.damping, "N m s/rad"),
    ):
        value = values.get(name)
        if name and value is None:
            lacks.append(f"{name!r} is identified but is no input of step 4: add it there")
        elif value is not None and (value.value, value.unit) != (model, unit):
            lacks.append(
                f"{name!r} is {value.value} {value.unit} in step 4 and {model} {unit} where it is "
                "identified: state the model's in both"
            )
    return lacks
