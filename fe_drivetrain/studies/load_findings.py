"""What load histories say in sentences and numbers: answer, cautions, tables and checks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.procedure.failure_modes import ROTOR_TORQUE
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.load_cautions import cautions
from fe_drivetrain.studies.load_comparison import Comparison
from fe_drivetrain.studies.load_digest import CHANNELS, UNIT_OF, LoadOptions
from fe_drivetrain.studies.load_records import (
    loop_rows,
    slope_rows,
    statistics_rows,
    torque_rows,
)
from fe_drivetrain.studies.load_totals import LoadTotals
from fe_drivetrain.studies.load_winds import Capture, CaptureTarget, winds_not_used
from fe_drivetrain.studies.shown_units import in_large_unit, shown_unit
from fe_drivetrain.studies.torque_limits import BY
from fe_drivetrain.studies.unused import speed_not_used
from fe_drivetrain.turbine_loads.histories.level_sums import POWER
from fe_drivetrain.turbine_loads.histories.sets import CHANCE
from fe_drivetrain.turbine_loads.histories.spectra import MULTIPLES

_PEAKS = {
    "bending moment": "peak bending moment",
    "Mx": "peak torque Mx",
    "Fx": "peak thrust Fx",
    "radial force": "peak radial force",
}
_NAMED = 3  # files that are sampled too slowly


def hub_findings(
    found: Findings,
    hub: LoadTotals,
    options: LoadOptions,
    target: CaptureTarget,
    capture: Capture | None,
) -> None:
    """State answer, cautions and numbers of the hub loads.

    Parameters
    ----------
    found : Findings
        Takes them.
    hub : LoadTotals
        Hub loads of all files.
    options : LoadOptions
        How they were counted.
    target : CaptureTarget
        What the capture matrix should hold.
    capture : Capture or None
        What it holds; None where no file has a wind speed.
    """
    _equivalent(found, hub, options)
    if capture is not None:
        found.say(capture.sentence)
    for sentence in cautions(hub, options):
        found.note(sentence)
    for sentence in winds_not_used(target, capture):
        found.note(sentence, first=True)
    for sentence in _aliased(hub):
        found.note(sentence)
    _data(found, hub, options, capture)


def note_unused_speed(
    found: Findings, options: LoadOptions, stated: Sequence[Sequence[Floats]]
) -> None:
    """Note files that state a speed of their own where another one is given.

    Parameters
    ----------
    found : Findings
        Takes the note.
    options : LoadOptions
        How files were read.
    stated : sequence of sequence of ndarray, (2,)
        Min and max rotor speed that files of each set state [1/min]; NaN where one states none.
    """
    given = options.rotor_speed_rpm
    if unused := speed_not_used(given, [speeds for own in stated for speeds in own]):
        found.note(unused, first=True)


def _equivalent(found: Findings, hub: LoadTotals, options: LoadOptions) -> None:
    """The equivalent tilting moment and torque, or those of other loads, and what they are of."""
    slope, hertz = options.slopes[0], options.frequency
    for name in [name for name in ("My", "Mx") if name in hub.loads] or hub.loads[:2]:
        one = hub.equivalent_load(name, slope, options)
        if not one.load:
            continue
        band = None if one.band is None else one.band / 1e3
        quantity = f"equivalent load of {name}, slope {slope:g} [{shown_unit(UNIT_OF[name])}]"
        of_rotor = name == "Mx" and not hub.files.torque_of
        found.found(quantity, one.load / 1e3, band, (ROTOR_TORQUE,) if of_rotor else ())
    open_ends = ", \u00b1 what whole cycles in place of half ones would add"
    rule = open_ends if options.residue == "half" else ""
    if found.figures:
        found.say(
            f"Equivalent loads are ranges of a sine of {hertz:g} Hz that does the same damage"
            f"{rule}."
        )
    files = hub.files
    count = len(files.names)
    found.say(
        f"{count} file{'s' * (count > 1)}, {files.samples:,} samples over {files.seconds:,.6g} s; "
        f"{options.counted}."
    )


def state_answer(
    found: Findings,
    hub: LoadTotals,
    comparison: Comparison | None,
    limit: float | None = None,
) -> None:
    """State extremes and equivalent loads at the hub, or how two sets differ.

    Parameters
    ----------
    found : Findings
        Has the equivalent loads among its values, and takes the answer.
    hub : LoadTotals
        Hub loads of all files.
    comparison : Comparison or None
        The files beside another set, where one is given.
    limit : float or None
        Limit of the torque, where a drivetrain's file states it [N m].
    """
    figures = [
        *(found.judged(one.quantity) for one in found.figures),
        *(
            _peak(found, hub, load, name, limit)
            for load, name in _PEAKS.items()
            if load in hub.loads
        ),
    ]
    if "bending moment" in hub.loads:
        figures.insert(0, figures.pop(len(found.figures)))
    if comparison is not None:
        _answer_of_two(found, figures, comparison)
    elif hub.loads == ("Mx",):
        _answer_of_torque(found, hub, limit)
    elif hub.absent:
        _answer_of_some(found, hub, limit)
    else:
        fatigue = "no moment has a cycle"
        if found.figures:
            fatigue = f"the {figures[1].name}, is {certain_value(figures[1])}"
        found.answer(
            "Which loads act at the hub, at their extremes and in fatigue?",
            f"Bending at the hub reaches {certain_value(figures[0])}; {fatigue}.",
            figures,
        )


def _answer_of_torque(found: Findings, hub: LoadTotals, limit: float | None) -> None:
    """State extremes, mean and equivalents of a torque that is there alone."""
    mean, deviation = (hub.statistics.overall[CHANNELS.index("Mx"), k] / 1e3 for k in (1, 3))
    torque = hub.torque
    over = "time", torque.equivalent_over_time(hub.files.seconds)
    if torque.equivalent_over_turns is not None:
        over = "turns", torque.equivalent_over_turns
    peak, average = _peak(found, hub, "Mx", "peak torque Mx", limit), "mean torque [kN m]"
    figures = [
        peak,
        found.value(average, float(mean)),
        found.value("standard deviation of the torque [kN m]", float(deviation)),
        *(found.judged(one.quantity) for one in found.figures),
        found.value(
            f"equivalent torque over {over[0]}, exponent {POWER:.3g} [kN m]", over[1] / 1e3
        ),
        found.value("torque reversals", torque.reversals),
    ]
    shaft = hub.files.torque_of
    fatigue = "it has no cycle"
    if found.figures:
        name = found.figures[0].quantity.removeprefix("equivalent load of Mx, ")
        fatigue = f"its equivalent load, {name}, is {certain_value(figures[3])}"
    found.answer(
        f"Which torque acts at the {shaft or 'hub'}, at its extremes and in fatigue?",
        f"Torque alone{f', of the {shaft}' if shaft else ''}: it reaches {certain_value(peak)}, "
        f"{certain_value(figures[1])} on average; {fatigue}.",
        figures,
    )


def _answer_of_some(found: Findings, hub: LoadTotals, limit: float | None) -> None:
    """State extremes and equivalent loads of the components that are there."""
    named = [name for name in FORCES if name in hub.loads]
    peaks = {
        load: _peak(found, hub, load, name, limit)
        for load, name in (
            _PEAKS | {name: f"peak {name}" for name in named if name not in _PEAKS}
        ).items()
        if load in hub.loads
    }
    whole = [load for load in peaks if load in _PEAKS]
    first = peaks[whole[0] if whole else named[0]]
    equivalent = [found.judged(one.quantity) for one in found.figures]
    fatigue = "none has a cycle"
    if equivalent:
        fatigue = f"the {equivalent[0].name}, is {certain_value(equivalent[0])}"
    found.answer(
        f"Which loads act at the hub, of {', '.join(named)}?",
        f"{', '.join(named)} alone: {first.name} is {certain_value(first)}; {fatigue}.",
        [first, *equivalent, *(one for one in peaks.values() if one is not first)][:6],
    )


def _answer_of_two(found: Findings, figures: Sequence[KeyFigure], comparison: Comparison) -> None:
    """State how many quantities of two sets of histories differ."""
    mine, its = comparison.names
    beyond = sum(len(one.beyond) for one in comparison.winds)
    number = sum(len(one.differences) for one in comparison.winds)
    chance = CHANCE * number
    name = f"quantities of {number} beyond the scatter of seeds"
    found.answer(
        f"Do the loads of {mine} differ from those of {its}?",
        f"{beyond} of {number} quantities differ between {mine} and {its} by more than the scatter "
        f"of seeds; {chance:.2g} would by chance.",
        [found.value(name, beyond, beside=chance, by="by chance"), *figures[:3]],
    )


def _peak(
    found: Findings, hub: LoadTotals, channel: str, name: str, limit: float | None
) -> KeyFigure:
    """The value of a load that is farthest from zero; of the torque with its limit [N m]."""
    quantity, value = _extreme(hub, channel, name)
    if channel != "Mx" or limit is None:
        return found.value(quantity, value)
    most, _ = in_large_unit(limit, UNIT_OF[channel])
    return found.value(quantity, value, between=(-most, most), by=BY)


def _extreme(hub: LoadTotals, channel: str, name: str) -> tuple[str, float]:
    """What a load is, with its unit, and its value that is farthest from zero."""
    low, _, high, _ = hub.statistics.overall[CHANNELS.index(channel)].tolist()
    value, unit = in_large_unit(high if abs(high) >= abs(low) else low, UNIT_OF[channel])
    return f"{name} [{unit}]", value


def _aliased(hub: LoadTotals) -> list[str]:
    """Sentences on files that are sampled too slowly for multiples of their rotor's speed."""
    turning = dict(zip(hub.files.names, hub.statistics.mean_of("rotor speed"), strict=True))
    said = []
    for one in hub.spectra.aliased[:_NAMED]:
        # less a little for round-off
        hertz = float(turning[one.file]) / (2.0 * np.pi) * (1.0 - 1e-6)
        shown = ", ".join(
            f"{n}P appears at {at:.3g} Hz"
            for n, at in zip(MULTIPLES, one.appears_at.tolist(), strict=True)
            if at < hertz * n
        )
        said.append(
            f"{one.file} is sampled every {one.step:g} s, too slowly for its multiples of rotor "
            f"speed: {shown}. What stands there in its spectra is not there in the load; sample "
            "faster."
        )
    return said


def _data(found: Findings, hub: LoadTotals, options: LoadOptions, capture: Capture | None) -> None:
    """Numbers of the hub loads for other programs."""
    found.data("statistics", statistics_rows(hub))
    if capture is not None:
        found.data(
            "capture",
            {
                "wind [m/s]": capture.matrix.wind,
                "turbulence [-]": capture.matrix.turbulence,
                "windows": capture.matrix.counts,
                "missing windows": capture.missing,
            },
        )
    found.data("loops", loop_rows(hub))
    found.data("equivalent_loads", slope_rows(hub.equivalent_loads(options), options))
    if options.ultimate:
        about_zero = slope_rows(hub.equivalent_loads_about_zero(options), options)
        found.data("equivalent_loads_about_zero", about_zero)
    found.data("torque", {row["quantity"]: row["value"] for row in torque_rows(hub)})


def check_classes(found: Findings, hub: LoadTotals) -> None:
    """Check that classes of levels and planes hold the time of all samples.

    Parameters
    ----------
    found : Findings
        Takes the checks.
    hub : LoadTotals
        Hub loads of all files.
    """
    for what, classes in (
        ("time at the levels", list(hub.levels.seconds.values())),
        (
            "time in the planes of force and moment",
            [plane.positions for plane in hub.planes.values()],
        ),
    ):
        if not classes:
            continue
        worst = max(abs(one.amount.sum() / hub.files.seconds - 1.0) for one in classes)
        found.vanishes(
            f"{what}, less that of all samples, as a share",
            worst,
            within=1e-9,
            why="each sample is in one class: rounding of the sums",
            source="number of samples times their step",
            basis="self-consistency",
        )
