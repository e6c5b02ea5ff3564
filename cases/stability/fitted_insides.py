"""Insides that fit a catalogue's page: how wrong C, C0 or the width may be until none fits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing import CataloguePage, fitted_rollers
from fe_drivetrain.cases import case
from fe_drivetrain.common import InputError
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

PAGES: tuple[dict[str, float | str], ...] = (
    {"designation": "240/600", "C": 8.15e6, "C0": 17e6, "Cu": 1.1e6, "e": 0.3, "Y1": 2.3},
    {"designation": "NU 2220", "C": 3.8e5, "C0": 4.5e5, "Cu": 5.4e4},
    {"designation": "32222", "C": 4.02e5, "C0": 5.7e5, "Cu": 6.1e4, "e": 0.43, "Y": 1.4},
    {"designation": "6309", "C": 5.53e4, "C0": 3.15e4, "Cu": 1.34e3, "f0": 13},
)
FACTOR = "value over that printed"
SHARE = "insides that fit, of all tried [%]"
HERO = "Wrong catalogue values over printed ones, up to which rollers and races fit them"
REFUSED = "pages without an inside that are refused with the reason"


@dataclass(frozen=True)
class Tried:
    """A page with one value changed."""

    designation: str
    key: str
    factor: float
    share: float
    refusal: str


@case(
    "Bearings by a catalogue's page: where no inside fits",
    source="pages of SKF with one value changed",
)
def run(run: Run, page: Page) -> None:
    """Change one printed value until nothing fits, and read what is said then."""
    factors = np.geomspace(1.0 / 3.0, 3.0, 13 if run.quick else 41)
    with run.step("pages"):
        tried = [
            attempt(data, key, float(factor))
            for data in PAGES
            for key in ("C", "C0", "width")
            if key != "width" or "f0" not in data  # balls do not fill a width
            for factor in factors
        ]
    safe = safe_ranges(tried)
    check(page, tried)
    limits(page, safe)
    answer(page, tried, safe)
    rows: list[Record] = [
        {
            "bearing": f"bearing {one.designation}",
            "changed": one.key,
            FACTOR: one.factor,
            SHARE: one.share,
            "said": one.refusal,
        }
        for one in tried
    ]
    page.section("Share of insides that fit")
    for key in ("C", "C0", "width"):
        of = [row for row in rows if row["changed"] == key]
        page.sweep(f"Pages with another {key}", of, FACTOR, SHARE, by="bearing", log="x")


def attempt(data: dict[str, float | str], key: str, factor: float) -> Tried:
    """Insides of a page with one value changed, or why there are none."""
    name = str(data["designation"])
    try:
        printed = CataloguePage.read(data, name)
        width = "T" if printed.of_kind == "single_row_tapered" else "B"
        value = printed.sizes.width if key == "width" else float(data[key])
        changed = {**data, (width if key == "width" else key): factor * value}
        fit = fitted_rollers(CataloguePage.read(changed, name), 200)
    except InputError as error:
        return Tried(name, key, factor, 0.0, str(error))
    return Tried(name, key, factor, 100.0 * len(fit) / fit.tried, "")


def safe_ranges(tried: list[Tried]) -> dict[tuple[str, str], tuple[float, float]]:
    """Least and largest factor with which an inside fits, by page and value."""
    found: dict[tuple[str, str], list[float]] = {}
    for one in tried:
        if one.share > 0.0:
            found.setdefault((one.designation, one.key), []).append(one.factor)
    return {key: (min(factors), max(factors)) for key, factors in found.items()}


def check(page: Page, tried: list[Tried]) -> None:
    """Printed pages fit; each page that does not is refused with the value and what to correct."""
    refused = [one for one in tried if one.refusal]
    page.equals(
        REFUSED,
        float(sum(one.designation in one.refusal and _says(one.refusal) for one in refused)),
        float(len(refused)),
        within=0.0,
        why="counted",
        source="sentences of the program",
        basis="self-consistency",
    )
    middle = [one for one in tried if abs(np.log(one.factor)) < 1e-9]
    page.equals(
        "printed pages with an inside that fits",
        float(sum(one.share > 0.0 for one in middle)),
        float(len(middle)),
        within=0.0,
        why="counted",
        source="bearings that are sold have an inside",
    )


def _says(refusal: str) -> bool:
    """Whether a refusal says what to do."""
    return any(word in refusal for word in ("correct", "check", "ratings are in N"))


def limits(page: Page, safe: dict[tuple[str, str], tuple[float, float]]) -> None:
    """State between which values of a page a geometry fits all bearings here."""
    for key in ("C", "C0", "width"):
        ends = [ends for (_, varied), ends in safe.items() if varied == key]
        page.limit(
            "insides fitted to a catalogue's page",
            f"{key} over that printed",
            low=max(low for low, _ in ends),
            high=min(high for _, high in ends),
            criterion="a geometry of the ranges fits C, C0 and the space",
            beyond="none fits",
            program="refuses the page and names the condition that excludes most geometries",
            remedy="correct the value, or state what is known of the inside",
        )


def answer(
    page: Page, tried: list[Tried], safe: dict[tuple[str, str], tuple[float, float]]
) -> None:
    """State how wrong a value may be before it is noticed."""
    page.section("Values that are still taken")
    groups = {
        f"{key}, {end}": {
            f"bearing {name}": ends[i] for (name, varied), ends in safe.items() if varied == key
        }
        for key in ("C", "C0", "width")
        for i, end in enumerate(("least", "largest"))
    }
    page.add(bars(HERO, groups, FACTOR, least=0.3))
    spans = {
        key: max(high for (_, varied), (_, high) in safe.items() if varied == key)
        for key in ("C", "C0", "width")
    }
    page.answer(
        "How wrong may a catalogue value of a bearing be before the program rejects it?",
        f"A rating C above {formatted(spans['C'], 2)} times, or C0 above "
        f"{formatted(spans['C0'], 2)} times, the printed value is rejected with the reason; "
        "smaller mistakes may go unnoticed.",
        [
            page.value("largest factor on C that is still accepted", rounded([spans["C"]], 2)[0]),
            page.value("largest factor on C0 that is still accepted", rounded([spans["C0"]], 2)[0]),
            page.value(
                "largest factor on the width that is still accepted",
                rounded([spans["width"]], 2)[0],
            ),
        ],
        hero=HERO,
        cautions=[
            "The program looks for rollers and races that fit the catalogue values: it rejects a "
            "value only where none fit."
        ],
    )
