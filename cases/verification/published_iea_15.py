"""IEA 15 MW turbine: one tube under three lengths, in OpenFAST and in HAWC2."""

from collections.abc import Mapping
from typing import Any

from fe_drivetrain.cases.references.shaft_theory import polar_moment
from fe_drivetrain.cases.verification.published_checks import (
    DIGITS,
    MainShaft,
    check_digits,
    check_torsion,
    compare_stiffness,
)
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record

BY_MODEL = "Torsional stiffness of the main shaft by model"
TURN, ERROR = "elements round a turn", "relative error"


def judge(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """Closed form, finite elements, and the arithmetic behind the HAWC2 shaft."""
    found, published, earlier = shaft.found, given["published"], given["earlier"]
    section, body = given["section_length"], given["body_length"]
    J = polar_moment(shaft.outer, shaft.inner)
    flexible = 1e9 * given["hawc2_G"] * given["polar"]
    as_filed, as_run = flexible / section, flexible / body
    ratio = as_filed / published
    check_tube(page, given, sources, shaft, J)
    check_hawc2(page, given, sources, shaft, ratio)
    answer(page, published, earlier, as_filed)
    page.say(
        "OpenFAST's stiffness is G J / L of a tube of 3.0 m, wall 0.1 m, over 2.2 m. HAWC2's "
        "differs for two reasons of length: its "
        "I_p was made from an earlier OpenFAST figure, of the same tube over 3.0 m (factor "
        f"{shaft.length / 3:.4f}), for a body of 6.130 m, and is filed with a section of 5.118 m "
        f"(factor {body / section:.4f}). Over the length of its body, it is "
        f"{100 * (1 - as_run / published):.1f} % softer.",
    )
    by = {
        "OpenFAST, today: G J over 1.0 + 1.2 m": published,
        "OpenFAST, earlier: G J over 3.0 m": earlier,
        "HAWC2, length of the body file: the earlier figure again": as_run,
        "HAWC2, length of the section file: the same I_p over 5.118 m": as_filed,
        "finite elements, 2.2 m: three meshes": found.stiffness,
    }
    compare_stiffness(page, BY_MODEL, "model", by, "OpenFAST today", published)
    show_convergence(page, shaft)
    page.text(
        f"I_p of the tube itself is {J:.4f} m^4; the HAWC2 figure is an equivalent that carries a "
        "stiffness, not a section. It serves one length and one G only. A further version of the "
        "model (commit d77070a) has a body of 5.168 m."
    )


def check_tube(
    page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft, J: float
) -> None:
    """Today's stiffness is that of the tube over 2.2 m, the earlier one over 3.0 m."""
    today, published = sources["published"], given["published"]
    check_digits(page, "G J / L of the tube [N m/rad]", shaft.closed, published, 50.0, today)
    check_torsion(page, "finite elements", shaft.found, published, today)
    over_three = f"DTTorSpr of an earlier release: {sources['earlier']}"
    title, stiffness = "the same tube over 3.0 m [N m/rad]", shaft.G * J / 3.0
    check_digits(page, title, stiffness, given["earlier"], 5.0, over_three)


def check_hawc2(
    page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft, ratio: float
) -> None:
    """The section of the HAWC2 shaft follows from stiffness, lengths and shear modulus."""
    polar, G = given["polar"], 1e9 * given["hawc2_G"]
    section, body = given["section_length"], given["body_length"]
    by_length = f"{sources['polar']}: 'I_p = DTTorSpr*ShftLen/G'; length of the body in "
    by_length += sources["body_length"]
    title = "I_p of the HAWC2 shaft from DTTorSpr times length over G [m^4]"
    check_digits(page, title, given["earlier"] * body / G, polar, 0.5e-4, by_length)
    page.equals(
        "I_p that the OpenFAST figure needs over the section file's length [m^4]",
        given["published"] * section / G,
        4.5008,
        within=0.5e-4 / 4.5008,
        why=DIGITS,
        source="a list of reference values (second-hand: its own source was not read)",
        measure="stiffness",
        basis="second-hand",
    )
    page.equals(
        "HAWC2 shaft as filed over the OpenFAST figure [-]",
        ratio,
        (shaft.length / 3.0) * (body / section),
        within=0.5e-4 / polar + 1e-8,
        why=f"{DIGITS} of I_p",
        source="2.2 m over 3.0 m, times 6.130 m over 5.118 m",
        measure="stiffness",
    )


def show_convergence(page: Page, shaft: MainShaft) -> None:
    """Finite elements over the number of elements."""
    series = shaft.found.series
    errors = [
        {TURN: 1 / size, ERROR: abs(value / shaft.closed - 1)}
        for size, value in zip(series.sizes, series.values, strict=True)
    ]
    title = "Finite elements against G J / L by elements round a turn"
    page.sweep(title, errors, TURN, ERROR, log="xy", table=False)


def answer(page: Page, published: float, earlier: float, as_filed: float) -> None:
    """State which of the two models has the tube's stiffness; all in N m/rad."""
    tube = page.judged(
        "finite elements", "the tube over 2.2 m, finite elements", "OpenFAST", unit="GN m/rad"
    )
    giga = value_text(published / 1e9, "GN\u00a0m/rad")
    softer = percent_text(1 - as_filed / published, 3)
    page.answer(
        "Why do two models of the IEA 15 MW turbine's main shaft differ in torsional stiffness?",
        f"OpenFAST's {giga} is that of the tube; HAWC2's shaft is {softer} softer because it "
        "was made from an earlier stiffness and another length."
        if tube.status == "good"
        else f"OpenFAST's {giga} is not that of the tube; HAWC2's shaft is {softer} softer.",
        [
            tube,
            page.value(
                "HAWC2 shaft as filed [GN m/rad]",
                as_filed / 1e9,
                beside=published / 1e9,
                by="OpenFAST",
            ),
            page.judged(
                "HAWC2 shaft as filed over the OpenFAST figure",
                "HAWC2 over OpenFAST",
                "ratio of the lengths",
            ),
            page.judged("the same tube over 3.0 m", by="earlier OpenFAST", unit="GN m/rad"),
        ],
        hero=BY_MODEL,
        claim="holds in part",
    )
