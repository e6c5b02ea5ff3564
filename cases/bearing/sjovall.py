"""Load distribution of discrete rollers against Sjovall's integrals."""

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    ContactLaw,
    RollerRow,
    catalogue_bearing,
    cylindrical,
    equilibrium,
    load_zones,
    sjovall,
)
from fe_drivetrain.cases import case
from fe_drivetrain.report import rolling_elements, trace
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run

#: 1 / J_r at half a circle of load, as printed in tables of the integral.
FACTORS = {"Houpert 1.1": (1.1, 4.0766), "ISO 10/9": (10 / 9, 4.0850), "Hertz 3/2": (1.5, 4.3701)}

#: Peak of discrete rollers times Z / F_r, exponent 10/9, computed independently.
DISCRETE = {8: 4.0770, 14: 4.0860, 20: 4.0846, 36: 4.0849, 72: 4.0850}

FORCE = 4e5  # N

#: Loaded shares of the diameter in the chart.
SHARES = [0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.5, 5.0]
HERO = "Peaks, reactions and tilt of discrete rollers: differences from closed forms"
SOURCE = "Sjovall 1933, as in Harris, Rolling bearing analysis, ch. 7"


def with_exponent(bearing: Bearing, exponent: float) -> Bearing:
    """The same bearing with another exponent of its contact law."""
    return bearing.with_rows(law=ContactLaw(bearing.rows[0].law.stiffness, exponent))


def check_laws(page: Page, bearing: Bearing) -> list[Record]:
    """Peak of a radial force, by the exponent of the contact law."""
    Z, cosine = bearing.counts[0], float(np.cos(bearing.rows[1].angle))
    rows = []
    for name, (exponent, factor) in FACTORS.items():
        found = equilibrium(with_exponent(bearing, exponent), [0, 0, -FORCE, 0, 0], tolerance=1e-12)
        peak = float(found.rollers.max()) * Z * cosine / (0.5 * FORCE)
        page.equals(
            f"{name}: peak roller times Z cos(alpha) over the row's force",
            peak,
            factor,
            within=1e-4,
            why="36 rollers in place of infinitely many: 1e-5; the reference has five digits",
            source=SOURCE,
            measure="reaction",
        )
        rows.append({"law": name, "peak factor": peak, "1 / J_r": 1 / sjovall(0.5, exponent)[0]})
    return rows


def check_counts(page: Page) -> float:
    """Peak of a radial force, by the number of rollers; the largest difference, relative."""
    apart = 0.0
    for n, factor in DISCRETE.items():
        one = cylindrical("one row", n, 0.01, 0.03, 0.6)
        found = equilibrium(one, [0, -FORCE, 0, 0, 0], tolerance=1e-12)
        peak = float(found.rollers.max()) * n / FORCE
        apart = max(apart, abs(peak / factor - 1.0))
        page.equals(
            f"{n} rollers, one under the load: peak times Z / F_r",
            peak,
            factor,
            within=2e-5,
            why="the reference is rounded to five digits",
            source="sums over discrete rollers, computed independently",
            measure="reaction",
        )
    return apart


def check_axial(page: Page, bearing: Bearing) -> None:
    """All rollers of one row carry an axial force, and none of the other."""
    Z, row = bearing.counts[0], bearing.rows[1]
    axial = equilibrium(bearing, [FORCE, 0, 0, 0, 0], tolerance=1e-12).rollers[0]
    page.equals(
        "axial force: each roller of one row",
        float(axial[Z:].min()) / 1e3,
        FORCE / (Z * np.sin(row.angle)) / 1e3,
        within=1e-10,
        why="round-off: all rollers are equal",
        source="F / (Z sin(alpha))",
        unit="kN",
        measure="reaction",
    )
    page.vanishes(
        "axial force: the other row",
        float(axial[:Z].max()),
        within=0.0,
        why="it lifts off",
        source="equilibrium",
        unit="N",
    )


def check_moment(page: Page, bearing: Bearing) -> None:
    """The tilt under the moment that Sjovall's integral gives for it."""
    row = bearing.rows[1]
    assert isinstance(row, RollerRow)
    tilt = 1e-3
    moment = 2 * bearing.counts[0] * sjovall(0.5, 1.1)[0] * row.law.stiffness
    arms = np.abs(row.arm + row.places)
    moment *= float(np.mean(arms**2.1)) * tilt**1.1
    back = equilibrium(bearing, [0, 0, 0, moment, 0], tolerance=1e-12).displacements[0]
    page.equals(
        "moment of a tilt of 1 mrad, returned",
        float(back[3]) * 1e3,
        tilt * 1e3,
        within=3e-5,
        why="36 rollers in place of infinitely many",
        source="M = 2 Z J_r K mean(|e|^2.1) theta^1.1, e the arm of each lamina (Stirling 2023, Eq "
        "4.13-4.18)",
        unit="mrad",
        measure="rotation",
    )


@case(
    "Load distribution of discrete rollers against Sjovall's integrals",
    source="Sjovall 1933, as in Harris, Rolling bearing analysis, ch. 7",
)
def run(run: Run, page: Page) -> None:
    """Radial, axial and tilting loads of bearing S, and clearance, each in closed form."""
    bearing = catalogue_bearing("bearing_s")
    rows = run.timed("radial force", check_laws, page, bearing)
    apart = run.timed("number of rollers", check_counts, page)
    with run.step("axial force and moment"):
        check_axial(page, bearing)
        check_moment(page, bearing)
    with run.step("clearance"):
        swept = [clearance(float(um)) for um in range(0, 201, 50 if run.quick else 10)]
    figures = answer(page, rows, apart, swept)
    page.section("Peak factors")
    page.errors(HERO, figures)
    page.table("Bearing S under a radial force", rows)
    page.section("Load zone")
    page.chart(
        "J_r and J_a over the loaded share of the diameter",
        [
            trace(f"{label}, {name}", SHARES, [sjovall(e, exponent)[i] for e in SHARES])
            for name, (exponent, _) in FACTORS.items()
            for i, label in enumerate(("J_r", "J_a"))
        ],
        "epsilon",
        "integral",
    )
    page.section("Clearance")
    page.sweep(
        "Peak roller of a planet bearing (16 rollers, 178 kN) over its clearance",
        swept,
        "diametral clearance [µm]",
        "peak roller [kN]",
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(bearing)))


def answer(page: Page, rows: list[Record], apart: float, swept: list[Record]) -> list[KeyFigure]:
    """State how close discrete rollers are to Sjovall's peak, and what clearance changes."""
    row = "peak roller times Z cos(alpha) over the row's force"
    peaks = [record["peak roller [kN]"] for record in (swept[0], swept[-1])]
    figures = [
        page.judged(f"Houpert 1.1: {row}", "peak load factor, exponent 1.1", "Sjovall", "4.0766"),
        page.judged(f"ISO 10/9: {row}", "peak load factor, exponent 10/9", "Sjovall", "4.0850"),
        page.judged(f"Hertz 3/2: {row}", "peak load factor, exponent 3/2", "Sjovall", "4.3701"),
        page.judged(
            "axial force: each roller of one row", "load of each roller, axial force", "closed form"
        ),
        page.judged(
            "moment of a tilt of 1 mrad, returned",
            "tilt under the moment of a tilt of 1 mrad",
            "Sjovall",
        ),
        page.value(
            "peak roller load of a planet bearing, clearance of 0.2 mm [kN]",
            peaks[1],
            beside=peaks[0],
            by="without clearance",
        ),
    ]
    carry = "give" if all(check.passed for check in page.checks) else "do not give"
    worst = max([apart, *(abs(f.value / f.limit - 1.0) for f in figures[:3] if f.limit)])
    page.answer(
        "Does a sum over discrete rollers give the peak load of Sjovall's integrals?",
        f"Discrete rollers {carry} Sjovall's peak load factor, {rows[0]['peak factor']:.4f} for a "
        f"contact exponent of 1.1; the largest difference is {percent_text(worst)}.",
        figures,
        HERO,
        [
            "The peak load factor multiplies the row's radial force over the number of its rollers "
            "and the cosine of the contact angle."
        ],
    )
    return figures[:5]


def clearance(um: float) -> Record:
    """The planet bearing of Al-Hamadani's size under 178 kN with a diametral clearance."""
    bearing = catalogue_bearing("planet_nj2232", clearance=0.5e-6 * float(um))
    (zone,) = load_zones(bearing, equilibrium(bearing, [0, 0, -178e3, 0, 0]).displacements)
    return {
        "diametral clearance [µm]": float(um),
        "peak roller [kN]": float(zone.peak[0]) / 1e3,
        "loaded rollers": int(zone.loaded[0]),
    }
