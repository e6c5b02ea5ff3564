"""What the strength of a shaft says: answer, figures, tables, charts, cautions, assumptions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import chart, error_bars, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.strength.din743 import LARGEST
from fe_drivetrain.studies.strength_answers import Banded, JointAnswer, SectionAnswer
from fe_drivetrain.studies.strength_options import HOURS
from fe_drivetrain.studies.strength_sections import StrengthShaft
from fe_drivetrain.studies.strength_sums import StrengthSums
from fe_drivetrain.turbine_loads.histories.sites import HOURS_A_YEAR

UNREAD = (
    "DIN 743 was not read: its equations agree with printed solutions of two independent programs. "
    "S-N slopes, knee and FKM's support factors are from memory, unverified."
)
_ROUND_OFF = 1e-6
_MOST = 6  # key figures
_SHOWN = 100.0  # safety beyond which nothing is told

History = tuple[Sequence[str], Sequence[StrengthSums], Floats]
"""Names of files, sums of each history, and how often each comes in the life."""


def safety_chart(
    sections: Sequence[SectionAnswer], required: tuple[float, float], varies: bool
) -> Chart:
    """Safety factors of all sections over those required.

    Parameters
    ----------
    sections : sequence of SectionAnswer
        Sections from front to rear.
    required : tuple of float
        Least S_D and S_F.
    varies : bool
        Whether S_D is over the cycles of a life.
    """
    over = "over the life" if varies else "of loads that stay"
    traces = []
    for number, (label, least) in enumerate(
        zip(("fatigue, S_D", "yielding, S_F"), required, strict=True)
    ):
        safeties = [(one.fatigue, one.static)[number] for one in sections]
        shown = [(one.name, s) for one, s in zip(sections, safeties, strict=True)]
        shown = [(name, s) for name, s in shown if np.isfinite(s.value)]
        value = np.array([s.value for _, s in shown]) / least
        band = np.array([s.band for _, s in shown]) / least
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": label,
                "x": rounded(value),
                "y": [name for name, _ in shown],
                "marker": {"size": 11, "symbol": ("circle", "diamond")[number]},
                **error_bars("x", value - band, value, value + band),
            }
        )
    found = chart(
        f"Safety of the shaft's sections {over}, relative to that required",
        [one for one in traces if one["x"]],
        "safety factor over that required [-]",
        "",
        events={"just enough": 1.0},
    )
    found.figure["layout"] |= {
        "height": 170 + 24 * max(len(sections), 5),
        "yaxis": {"autorange": "reversed", "automargin": True, "type": "category"},
    }
    found.figure["layout"]["xaxis"]["rangemode"] = "tozero"
    return found


def stress_chart(stations: Floats, along: Floats, sections: Sequence[SectionAnswer]) -> Chart:
    """Largest stress along the shaft: nominal, and local with bands where there is a notch.

    Parameters
    ----------
    stations, along : ndarray, (p,)
        Places [m], and nominal equivalent stress there [Pa].
    sections : sequence of SectionAnswer
        Sections from front to rear.
    """
    notched = [one for one in sections if one.rated.effect.alpha.max() > 1.0]
    local = np.array([one.local.value for one in notched]) / 1e6
    band = np.array([one.local.band for one in notched]) / 1e6
    traces: list[Any] = [trace("nominal", stations, along / 1e6)]
    if notched:
        points = trace(
            "local, at notches", [one.rated.section.x for one in notched], local, points=True
        )
        traces.append({**points, **error_bars("y", local - band, local, local + band)})
    return chart(
        "Largest equivalent stress along the shaft",
        traces,
        "x [m]",
        "von Mises stress [MPa]",
    )


def section_row(one: SectionAnswer, required: tuple[float, float]) -> Record:
    """The record of a section's safety.

    Parameters
    ----------
    one : SectionAnswer
        The section.
    required : tuple of float
        Least S_D and S_F.
    """
    section = one.rated.section
    return {
        "section": one.name,
        "x [m]": section.x,
        "kind": section.kind,
        "d [mm]": 1e3 * section.diameter,
        "S_D": _known(one.fatigue.value),
        "± S_D": _known(one.fatigue.band),
        "S_D of the largest range for ever": _known(one.endurance.value),
        "S_F": _known(one.static.value),
        "± S_F": _known(one.static.band),
        "least S_D": required[0],
        "least S_F": required[1],
        "damage of the life": one.damage,
        "local stress, second way: S": None if np.isnan(one.local_safety) else one.local_safety,
    }


def stress_row(one: SectionAnswer) -> Record:
    """The record of a section's stresses [MPa] and factors."""
    rated, nominal = one.rated, one.nominal / 1e6
    alpha, formula, beta = rated.effect.alpha, rated.formula, rated.effect.beta
    row: Record = {
        "section": one.name,
        "nominal, axial [MPa]": float(nominal[0]),
        "nominal, bending [MPa]": float(nominal[1]),
        "nominal, torsion [MPa]": float(nominal[2]),
        "largest local, von Mises [MPa]": one.local.value / 1e6,
        "± [MPa]": one.local.band / 1e6,
    }
    for k, load in enumerate(("tension", "bending", "torsion")):
        row[f"K_t in {load}"] = float(alpha[k])
        row[f"± K_t in {load}"] = float(rated.band[k]) if rated.by_elasticity else None
        row[f"by formula, {load}"] = None if np.isnan(formula[k]) else float(formula[k])
        row[f"beta in {load}"] = float(beta[k])
    row["R_m [MPa]"], row["R_e [MPa]"] = rated.strength.tensile / 1e6, rated.strength.yielding / 1e6
    for k, load in enumerate(("tension", "bending", "torsion")):
        row[f"endured reversed in {load} [MPa]"] = float(rated.strength.reversed[k]) / 1e6
    bored = ""
    if rated.of_solid:
        bored = (
            f"formula of a solid shaft; bore {rated.section.bore / rated.section.diameter:.2g} d"
        )
    row["remark"] = "; ".join(filter(None, (rated.remark, bored)))
    return row


def joint_row(one: JointAnswer) -> Record:
    """The record of a joint."""
    return {
        "joint": one.name,
        "safety against slip": _known(one.slip.value),
        "± slip": _known(one.slip.band),
        "least against slip": one.required[0],
        "safety against separation": _known(one.opening.value),
        "± separation": _known(one.opening.band),
        "least against separation": one.required[1] or None,
        "pressure [MPa]": one.pressure / 1e6 or None,
    }


def _known(value: float) -> float | None:
    return value if np.isfinite(value) else None


def state_findings(
    found: Findings,
    shaft: StrengthShaft,
    sections: Sequence[SectionAnswer],
    joints: Sequence[JointAnswer],
    histories: History,
    hours: float,
    varies: bool,
) -> None:
    """State all that was found.

    Parameters
    ----------
    found : Findings
        Takes it.
    shaft : StrengthShaft
        The shaft.
    sections, joints : sequences
        Their safety.
    histories : History
        What loaded it.
    hours : float
        Hours of the life.
    varies : bool
        Whether S_D is over the cycles of that life.
    """
    required = (shaft.stated.fatigue_safety, shaft.stated.static_safety)
    for one in sections:
        for name, safety in (("S_D", one.fatigue), ("S_F", one.static)):
            if np.isfinite(safety.value):
                found.found(f"{name} of {one.name}", safety.value, safety.band)
        found.found(
            f"local stress at {one.name} [MPa]", one.local.value / 1e6, one.local.band / 1e6
        )
    found.data("sections", [section_row(one, required) for one in sections])
    found.data("stresses", [stress_row(one) for one in sections])
    found.data("joints", [joint_row(one) for one in joints])
    found.data("not rated", [{"section": n, "why": why} for n, why in shaft.left_out.items()])
    found.data("histories", _history_rows(histories, shaft))
    imbalance = max(one.imbalance for one in shaft.model.bounds)
    found.vanishes(
        "force that is left behind the rear face, over the load",
        imbalance,
        within=_ROUND_OFF,
        why="loads, weights and reactions of the shaft are one equilibrium; round-off of springs "
        "whose stiffness differs by 1e6",
        source="statics",
        basis="self-consistency",
    )
    _cautions(found, shaft, sections, varies)
    for row in shaft.stated.assumptions():
        if row.is_assumed:
            found.assume(*row._replace(name=f"strength: {row.name}"))
    if varies and hours == HOURS:
        found.assume("hours of the life asked for", HOURS, "h", "assumed: twenty years")
    _answer(found, sections, joints, required, hours if varies else 0.0)


def _history_rows(histories: History, shaft: StrengthShaft) -> list[Record]:
    names, parts, repeats = histories
    rows: list[Record] = []
    for k, (one, count) in enumerate(zip(parts, repeats.tolist(), strict=True)):
        worst = int(one.static.min(axis=0).argmin())
        rows.append(
            {
                "history": names[k] if k < len(names) else f"class {k + 1}",
                "wind [m/s]": None if np.isnan(one.wind) else one.wind,
                "time [h]": one.seconds / 3600.0,
                "times in the life": count,
                "turns": one.turns,
                "least S_F": _known(float(one.static.min())),
                "of": shaft.rated[worst].section.name,
            }
        )
    return rows


def _cautions(
    found: Findings, shaft: StrengthShaft, sections: Sequence[SectionAnswer], varies: bool
) -> None:
    if shaft.left_out:
        names = ", ".join(shaft.left_out)
        found.note(f"Not rated: {names}: no fillet is stated there (key fillet).", first=True)
    thick = max(one.rated.section.raw for one in sections)
    if thick > max(LARGEST, shaft.stated.reference_diameter or 0.0):
        found.note(
            f"DIN 743's size factors end at {1e3 * LARGEST:.0f} mm; up to {1e3 * thick:.0f} mm "
            "they are taken as there: state strength at the shaft's own diameter "
            "(reference_diameter)."
        )
    bored = [one for one in shaft.rated if one.of_solid]
    if bored:
        most = max(one.section.bore / one.section.diameter for one in bored)
        names = ", ".join(one.section.name for one in bored)
        found.note(
            f"K_t of {names} is by formulas of solid shafts, and the shaft is bored, up to "
            f"{formatted(most, 2)} of its diameter: nominal stress has the bore, K_t may err to "
            "either side, the more the thinner the wall."
        )
    found.note(
        "Nominal stress has no shear of shear force, and a section in the middle of a bearing is "
        "in front of its force."
    )
    if varies:
        found.note("Starts and stops between histories are not counted as cycles.")
    found.say(_stress_level(shaft), f"Housings of the bearings: {shaft.housings}.", UNREAD)


def _stress_level(shaft: StrengthShaft) -> str:
    """By which level stress at notches was found, and why that is enough."""
    solved = [one for one in shaft.rated if one.by_elasticity]
    notched = [one for one in shaft.rated if not one.by_elasticity and one.effect.alpha.max() > 1]
    said = []
    if solved:
        band = 100.0 * max(one.relative_band for one in solved)
        said.append(
            f"{len(solved)} by elasticity of the meridian in harmonics, each with the band of two "
            f"meshes, up to {formatted(band, 1)}\u00a0%, which is enough: the step is of "
            "revolution, and force, bending and torque are harmonics 0 and 1 alone, so that solids "
            "add nothing but their coarser mesh"
        )
    if notched:
        said.append(f"{len(notched)} by formulas of DIN 743-2, without a band")
    return (
        f"Stress at notches: {'; '.join(said)}." if said else "Stress at notches: there are none."
    )


def _answer(
    found: Findings,
    sections: Sequence[SectionAnswer],
    joints: Sequence[JointAnswer],
    required: tuple[float, float],
    hours: float,
) -> None:
    tired = min(sections, key=lambda one: one.fatigue.value)
    yields = min(sections, key=lambda one: one.static.value)
    figures = [
        *_safety(found, f"S_D of {tired.name}", tired.fatigue, required[0]),
        *_safety(found, f"S_F of {yields.name}", yields.static, required[1]),
    ]
    weak = [one for one in figures if one.status == "bad"]
    figures.append(found.judged(f"local stress at {_most(sections).name}"))
    if hours:
        figures.append(
            found.value(f"damage of the life of {hours / HOURS_A_YEAR:.3g} years", tired.damage)
        )
    for one in joints:
        for word, safety, least in (
            ("slip", one.slip, one.required[0]),
            ("separation", one.opening, one.required[1]),
        ):
            if least and np.isfinite(safety.value):
                figure = _joint_figure(found, f"safety of {one.name} against {word}", safety, least)
                figures.append(figure)
                weak += [figure] if figure.status == "bad" else []
    reserve = f"S_D\u00a0{_size(tired.fatigue)} where {formatted(required[0])} is required"
    if weak:
        worst = min(weak, key=lambda one: one.value / (one.limit or 1.0))
        part = "The shaft" if worst in figures[:2] else "A joint"
        verdict = (
            f"{part} is too weak: {worst.name} is {formatted(worst.value, 3)} where "
            f"{formatted(worst.limit or 0.0)} is required."
        )
    else:
        static = f"against yielding S_F\u00a0{_size(yields.static)}"
        verdict = f"The {tired.name} decides: {reserve}; {static}."
    found.answer(
        "Is the main shaft strong enough under these loads?",
        verdict,
        sorted(figures, key=lambda one: one.status != "bad")[:_MOST],
    )


def _most(sections: Sequence[SectionAnswer]) -> SectionAnswer:
    return max(sections, key=lambda one: one.local.value)


def _size(safety: Banded) -> str:
    return f"over {_SHOWN:g}" if safety.value > _SHOWN else formatted(safety.value, 3)


def _safety(found: Findings, name: str, safety: Banded, least: float) -> list[KeyFigure]:
    """A safety factor against the least that is asked for; none that is infinite."""
    if not np.isfinite(safety.value):
        return []
    one = found.value(name, safety.value, safety.band, at_least=least, by="required")
    return [one.model_copy(update={"quantity": name})]


def _joint_figure(found: Findings, name: str, safety: Banded, least: float) -> KeyFigure:
    found.found(name, safety.value, safety.band)
    one = found.value(name, safety.value, safety.band, at_least=least, by="required")
    return one.model_copy(update={"quantity": name})
