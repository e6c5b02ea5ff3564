"""What Stirling 2023, appendix B says of spectra of raceway loads, beside ours."""

from collections.abc import Mapping

from fe_drivetrain.cases.histories.operating_loads import BASE
from fe_drivetrain.cases.histories.operating_spectra import (
    FEWEST,
    RATED_ON,
    READINGS,
    SEGMENT,
    STANDS_OUT,
    OfSet,
    Peak,
    labels,
)
from fe_drivetrain.cases.histories.operating_words import FLAT, HIGH_SET, LOW_SET, STEEP
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.suite import Page, Record

SIMILAR = 0.2
"""What height or breadth of a peak may differ by and still be similar, over it."""
STRONGEST = {"stands": "3P", "turns": "1P"}
"""The strongest peak of each reading."""
WORDS = {
    "stands": "sum of the upwind row's contacts (a race that stands)",
    "turns": "contact load at a point of the upwind inner race (which turns)",
}
Statement = tuple[str, dict[str, str], dict[str, bool | None]]
"""Sentence of the appendix; by reading what stands here, and whether it agrees (None: no word)."""


def show(
    page: Page, sets: Mapping[str, OfSet], modes: Mapping[str, float], of_thesis: bool
) -> None:
    """Spectra by set, labelled peaks, and statements.

    Parameters
    ----------
    page : Page
        Takes them.
    sets : mapping of str to OfSet
        Sets of conditions in the first arrangement.
    modes : mapping of str to float
        "flap" and "edge" of a turning blade [Hz].
    of_thesis : bool
        Whether the thesis's statements are judged.
    """
    base = sets[BASE]
    at = labels(modes, base.speed)
    page.section("Spectra of raceway loads")
    _spectra(page, sets, at)
    segments = base.spectra[READINGS[0]].segments
    if segments < FEWEST:
        page.text(
            f"{segments} segments of a set are too few to tell its peaks from scatter: "
            f"{FEWEST} at least are asked for."
        )
        return
    rows = [row for reading in READINGS for row in _rows(sets, at, reading)]
    page.table(
        f"Peaks that stand out {STANDS_OUT:g} times over the valleys beside them; modes of a blade "
        "are looked for at their own frequency and one turn below and above it",
        rows,
    )
    page.data("peaks of raceway loads", rows)
    if of_thesis:
        _statements(page, sets, at)


def _spectra(page: Page, sets: Mapping[str, OfSet], at: Mapping[str, list[float]]) -> None:
    """Spectra of both readings, the labels marked."""
    lines = {name: orders[len(orders) // 2] for name, orders in at.items()}
    for reading, words in WORDS.items():
        drawn = chart(
            f"Spectrum of the {words}, from {RATED_ON:g} m/s on",
            [
                trace(
                    own,
                    of.spectra[reading].frequency[1:] / of.speed,
                    of.spectra[reading].density[1:],
                )
                for own, of in sets.items()
            ],
            "frequency over the rotor's speed [-]",
            "density [kN^2/Hz]",
            logarithmic=("y",),
        )
        page.add(mark_events(drawn, lines))
    page.text(
        f"Densities are means over winds from {RATED_ON:g} m/s on, where the rotor keeps its "
        f"speed, by Welch's method with segments of {SEGMENT:g} s; breadth is that of a rectangle "
        "of the same height and power. A balanced rotor of three blades passes on 3P, 6P and 9P to "
        "what stands; a point of the race that turns passes the load zone once a turn."
    )


def _rows(sets: Mapping[str, OfSet], at: Mapping[str, list[float]], reading: str) -> list[Record]:
    rows: list[Record] = []
    for own, of in sets.items():
        for label, orders in at.items():
            peak = of.near(reading, orders)
            rows.append(
                {
                    "load": reading,
                    "set": own,
                    "label": label,
                    "peak at [P]": None if peak is None else peak.at,
                    "height [kN/Hz^0.5]": None if peak is None else peak.height,
                    "breadth [P]": None if peak is None else peak.breadth,
                }
            )
    return rows


def _statements(page: Page, sets: Mapping[str, OfSet], at: Mapping[str, list[float]]) -> None:
    said = statements(sets, at)
    page.section("Statements of appendix B")
    page.table(
        "The thesis, of its upwind inner race, and ours by two readings of its load",
        [
            [words, *(part for r in READINGS for part in (ours[r], _word(agrees[r])))]
            for words, ours, agrees in said
        ],
        ["thesis", WORDS["stands"], "agrees", WORDS["turns"], "agrees, turning"],
    )
    held = [sum(bool(agrees[r]) for *_, agrees in said) for r in READINGS]
    either = sum(any(agrees.values()) for *_, agrees in said)
    page.text(
        f"Of {len(said)} statements {held[0]} hold for the load that stands, {held[1]} for the one "
        f"that turns, {either} for one of them: the thesis does not say which load it transforms. "
        "Blades of the thesis's turbine are private: our modes are those of the NREL 5 MW blade in "
        "proportion. Our rotor is balanced: what imbalance and a mispitched blade add is beside it."
    )


def show_imbalance(page: Page, balanced: OfSet, spoilt: OfSet, wind: float) -> None:
    """What imbalance and a mispitched blade, which the thesis does not state, add at 1P.

    Parameters
    ----------
    page : Page
        Takes it, in the section of the statements.
    balanced, spoilt : OfSet
        At one wind, of the same seeds.
    wind : float
        That wind [m/s].
    """
    rows: list[Record] = []
    for name, one in (("balanced", balanced), ("imbalance, one blade 0.3 deg off", spoilt)):
        row: Record = {"rotor": name}
        for order in (1, 3):
            peak = one.near("stands", [float(order)])
            row[f"peak at {order}P [kN/Hz^0.5]"] = None if peak is None else peak.height
            amplitude = one.spectra["stands"].amplitude(order * one.speed)
            row[f"amplitude about {order}P [kN]"] = amplitude
        rows.append(row)
    page.table(
        f"Load of the race that stands at {wind:g} m/s, {BASE}: a rotor whose imbalance nobody "
        "states, and one of balance grade G16",
        rows,
    )
    page.data("imbalance in raceway loads", rows)


def _word(agrees: bool | None) -> str:
    return "not resolved" if agrees is None else "yes" if agrees else "no"


def statements(sets: Mapping[str, OfSet], at: Mapping[str, list[float]]) -> list[Statement]:
    """Sentences of the appendix, what stands here, and whether it agrees, by reading."""
    parts = [
        {reading: one for reading, one in zip(READINGS, pair, strict=True)}
        for pair in zip(*(_of_reading(sets, at, reading) for reading in READINGS), strict=True)
    ]
    return [
        (
            next(iter(part.values()))[0],
            {reading: one[1] for reading, one in part.items()},
            {reading: one[2] for reading, one in part.items()},
        )
        for part in parts
    ]


def _of_reading(
    sets: Mapping[str, OfSet], at: Mapping[str, list[float]], reading: str
) -> list[tuple[str, str, bool | None]]:
    found = {label: sets[BASE].near(reading, orders) for label, orders in at.items()}
    said: list[tuple[str, str, bool | None]] = [
        (f"a peak at {_long(label)}", _where(found[label]), found[label] is not None)
        for label in at
    ]
    three, six, edge, nine = (found[label] for label in ("3P", "6P", "edge", "9P"))
    said.append(
        (
            "the edgewise peak is larger than that of 6P",
            f"{_height(edge)} and {_height(six)}",
            bool(edge and edge.height > (six.height if six else 0.0)),
        )
    )
    others = [peak.height for peak in (six, edge, nine) if peak]
    said.append(
        (
            "peaks above 3P are small",
            f"up to {max(others, default=0.0):.3g}, 3P {_height(three)}",
            bool(three and max(others, default=0.0) < 0.5 * three.height),
        )
    )
    return said + _of_sets(sets, at[STRONGEST[reading]], reading)


def _of_sets(
    sets: Mapping[str, OfSet], orders: list[float], reading: str
) -> list[tuple[str, str, bool | None]]:
    """What shear and turbulence do to the strongest peak."""
    flat, steep, low, high = (
        sets[own].near(reading, orders) for own in (FLAT, STEEP, LOW_SET, HIGH_SET)
    )
    # a window makes a line two spacings wide
    spacing = sets[BASE].spectra[reading].spacing / sets[BASE].speed
    label = STRONGEST[reading]
    rows: list[tuple[str, str, bool | None]] = []
    for words, one, other, what, expected in (
        ("shear raises amplitudes", flat, steep, "height", "more"),
        ("their breadth stays similar with shear", flat, steep, "breadth", "same"),
        ("turbulence makes peaks broader", low, high, "breadth", "more"),
        ("their amplitudes stay similar with turbulence", low, high, "height", "same"),
    ):
        if one is None or other is None:
            rows.append((words, f"no peak at {label}", False))
            continue
        ratio = getattr(other, what) / getattr(one, what)
        agrees: bool | None = ratio > 1.0 if expected == "more" else abs(ratio - 1.0) < SIMILAR
        if what == "breadth" and min(one.breadth, other.breadth) < 2.0 * spacing:
            agrees = None
        rows.append((words, f"{label}: {ratio:.2f} times", agrees))
    return rows


def _long(label: str) -> str:
    return {
        "flap": "the first flapwise mode",
        "edge": "the first edgewise mode",
        "1P": "the rotor's speed (1P)",
        "3P": "blade passing (3P)",
    }.get(label, label)


def _where(peak: Peak | None) -> str:
    return "none" if peak is None else f"at {peak.at:.2f}P, {_height(peak)}"


def _height(peak: Peak | None) -> str:
    return "none" if peak is None else f"{peak.height:.3g} kN/Hz^0.5"
