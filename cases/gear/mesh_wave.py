"""Square wave of mesh stiffness as Fourier series: a printed sign, and what it does."""

from dataclasses import replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear.own_meshes import given_meshes
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import machine_of
from fe_drivetrain.gear import square_wave, square_wave_series
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, Target
from fe_drivetrain.report.suite.chosen import SETTING

RATIOS = (1.2, 1.5, 1.7)
ORDERS = 400
PLUS, MINUS = "plus", "minus, as printed"
MEASURED = ("upper level [pairs]", "lower level [pairs]", "share of time above", "mean [pairs]")


def measured(wave: Floats, ratio: float) -> dict[str, float]:
    """Levels, share of time and mean of a wave about its contact ratio."""
    high = wave > ratio
    found = np.median(wave[high]), np.median(wave[~high]), high.mean(), wave.mean()
    return dict(zip(MEASURED, map(float, found), strict=True))


@case(
    "Mesh stiffness as a Fourier series: the printed sign, and the right one",
    source="Park et al. 2021, Front. Energy Res. 8:604414, Eq 4 to 9",
    settings={"drivetrain": "FILE, or a name of the library (otherwise three contact ratios)"},
)
def run(run: Run, page: Page) -> None:
    """Compare levels and shares of time of the series, with both signs, with one and two pairs."""
    if SETTING in run.settings:
        own(run, page)
        return
    rows: list[Record] = []
    for ratio in RATIOS:
        with run.step(f"contact ratio {ratio:g}"):
            series = square_wave_series(1.0, ratio, ORDERS)
            printed = replace(series, cosines=-series.cosines, sines=-series.sines)
            at = (np.arange(4000) + 0.5) / 4000
            for sign, wave in ((PLUS, series.at(at)), (MINUS, printed.at(at))):
                rows.append({"contact ratio": ratio, "sign": sign} | measured(wave, ratio))
    jumps = f"a series of {ORDERS} orders next to its jumps"
    mirrored = "one pair always, two for the share C - 1 of a period; with the other sign the wave "
    mirrored += "is mirrored about its mean"
    for row in rows:
        ratio, sign = row["contact ratio"], row["sign"]
        levels = (2.0, 1.0) if sign == PLUS else (2 * ratio - 1, 2 * ratio - 2)
        share = ratio - 1.0 if sign == PLUS else 2.0 - ratio
        for key, expected in zip(MEASURED, (*levels, share, ratio), strict=True):
            name = key.partition(" [")[0]
            target = Target(
                name, expected, 5e-3, jumps, mirrored, relative=False, measure="identity"
            )
            page.meets(row[key], target, of=f"contact ratio {ratio:g}, {sign}")
    overshoot = float(square_wave_series(1.0, 1.5, ORDERS).at(np.arange(40000) / 40000).max()) - 2
    why, gibbs = "sampled at 40,000 phases", "Gibbs: Si(pi) / pi - 1/2"
    title = "overshoot of the series, over the jump"
    target = Target(title, 0.08949, 1e-3, why, gibbs, relative=False, measure="identity")
    page.meets(overshoot, target)
    page.section("Waves")
    eight = square_wave_series(1.0, 1.7, 8)
    shown = np.arange(0.0, 1.0001, 0.002)
    minus, dashed = 2.0 * eight.mean - eight.at(shown), {"dash": "dash"}
    curves = [
        trace("exact", shown, square_wave(1.0, 1.7, shown)),
        trace("8 orders, plus", shown, eight.at(shown)),
        trace("8 orders, minus as printed", shown, minus, line=dashed),
    ]
    title = "Contact ratio 1.7: pairs in contact over a period"
    page.chart(title, curves, "phase [periods]", "stiffness [pairs]")
    page.table("Levels and shares of time, by sign", rows)
    answer(page, title, *rows[-2:])
    low = next(row for row in rows if row["sign"] == MINUS)
    page.text(
        "The paper prints a_l = -2 / (l pi) sin(l pi (C - 2 g)) sin(l pi C), b_l with a cosine, "
        "in a sum from l = 0 and with the order missing in sin(w t). With that minus a wave of "
        f"contact ratio {low['contact ratio']:g} has {low[MEASURED[0]]:.1f} pairs for "
        f"{100.0 * low[MEASURED[2]]:.0f} % of the time and {low[MEASURED[1]]:.1f} pairs for the "
        "rest. Both signs agree at C = 1.5 alone, but for half a period. With a plus there is one "
        "pair always, and two for the share C - 1 of a period; as printed, 2 C - 1 and 2 C - 2 "
        "pairs."
    )


PAIRS = "Pairs of teeth in contact over a period, by mesh"
CLEAR = 0.02
"""Share of a period that a level needs to be told from the jumps of the series."""


def own(run: Run, page: Page) -> None:
    """Waves of the meshes of a user's drivetrain, at their contact ratios, with the right sign."""
    chosen = run.drivetrain("", gears=True)
    chosen.state(page, topic="Pairs of teeth in contact over a period")
    meshes = given_meshes(chosen, machine_of(chosen.drivetrain), {}, page)
    at = (np.arange(4000) + 0.5) / 4000
    rows: list[Record] = []
    for name, mesh in meshes.items():
        ratio = mesh.pair.contact_ratio
        low, share = float(np.floor(ratio)), ratio - float(np.floor(ratio))
        rows.append(
            {
                "mesh": name,
                "contact ratio": ratio,
                **dict(zip(MEASURED, (low + 1.0, low, share, ratio), strict=True)),
            }
        )
        found = measured(square_wave_series(1.0, ratio, ORDERS).at(at), ratio)
        for key in MEASURED if CLEAR < share < 1.0 - CLEAR else MEASURED[3:]:
            title = key.partition(" [")[0]
            jumps = f"a series of {ORDERS} orders next to its jumps"
            target = Target(
                title,
                float(rows[-1][key]),
                5e-3,
                jumps,
                "whole pairs at the contact ratio",
                relative=False,
                measure="identity",
            )
            page.meets(found[key], target, of=f"{name}, Fourier series")
    page.section("Waves")
    shown = np.arange(0.0, 1.0001, 0.002)
    waves = [
        trace(str(row["mesh"]), shown, square_wave(1.0, float(row["contact ratio"]), shown))
        for row in rows
    ]
    page.chart(PAIRS, waves, "phase [periods]", "stiffness [pairs]")
    page.table("Levels and shares of time", rows)
    page.text(
        "The contact ratio is the whole one, with the overlap of a helix: a square wave takes all "
        "pairs that touch as equally stiff, so that helical meshes jump in it where contact lines "
        "really grow and shrink."
    )
    least = min(rows, key=lambda row: float(row["contact ratio"]))
    page.answer(
        "How many pairs of teeth are in contact in the meshes, and for how long?",
        f"{least['mesh']} has fewest: {float(least[MEASURED[0]]):.0f} pairs are in contact for "
        f"{100.0 * float(least[MEASURED[2]]):.0f}\u00a0% of the time, otherwise "
        f"{float(least[MEASURED[1]]):.0f}.",
        [
            page.value(f"contact ratio, {row['mesh']}", float(row["contact ratio"]))
            for row in rows[:6]
        ],
        hero=PAIRS,
        cautions=["Next to each jump the Fourier series overshoots by 9 % of the jump."],
    )


def answer(page: Page, hero: str, plus: Record, minus: Record) -> None:
    """State what the printed sign does at one contact ratio."""
    ratio = float(plus["contact ratio"])
    expected = dict(zip(MEASURED[:3], (2.0, 1.0, ratio - 1.0), strict=True))
    right = all(abs(float(minus[key]) - value) < 5e-3 for key, value in expected.items())
    levels = f"{float(minus[MEASURED[0]]):.1f} and {float(minus[MEASURED[1]]):.1f} tooth pairs"
    page.answer(
        "Are the Fourier coefficients of mesh stiffness that Park et al. print right?",
        f"The printed equations hold: {levels} in contact at a contact ratio of {ratio:g}."
        if right
        else f"The printed minus sign does not hold: at contact ratio {ratio:g} it gives {levels}; "
        f"a plus sign gives {float(plus[MEASURED[0]]):.0f} and {float(plus[MEASURED[1]]):.0f}.",
        [
            page.value(
                f"{key.partition(' [')[0]}, {sign}{unit}".replace("above", "at the upper level"),
                row[key],
                beside=value,
                by="true",
            )
            for sign, row in (("as printed", minus), ("with a plus sign", plus))
            for key, value in expected.items()
            for unit in [" [pairs]" if key.endswith("[pairs]") else ""]
        ],
        hero=hero,
        cautions=[
            "Next to each jump the Fourier series overshoots by 9 % of the jump, with either sign."
        ],
        claim="holds" if right else "does not hold",
    )
