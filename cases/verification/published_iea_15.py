"""IEA 15 MW turbine: one tube under three lengths, in OpenFAST and in HAWC2."""

from collections.abc import Mapping
from typing import Any

from fe_drivetrain.cases.verification.published_checks import (
    DIGITS,
    STIFFNESS,
    MainShaft,
    check_digits,
    check_torsion,
)
from fe_drivetrain.report import trace
from fe_drivetrain.suite import Page, Record
from fe_drivetrain.validation.shaft_theory import polar_moment


def judge(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """Closed form, finite elements, and the arithmetic behind the HAWC2 shaft."""
    found, published, earlier = shaft.found, given["published"], given["earlier"]
    polar, G = given["polar"], 1e9 * given["hawc2_G"]
    section, body = given["section_length"], given["body_length"]
    J = polar_moment(shaft.outer, shaft.inner)
    as_filed, as_run = G * polar / section, G * polar / body
    ratio = as_filed / published
    check_digits(
        page,
        "G J / L of the tube",
        shaft.closed,
        published,
        50.0,
        sources["published"],
        shown=" (100 N m/rad)",
    )
    check_torsion(page, "finite elements", found, published, sources["published"])
    check_digits(
        page,
        "the same tube over 3.0 m",
        shaft.G * J / 3.0,
        earlier,
        5.0,
        f"DTTorSpr of an earlier release: {sources['earlier']}",
        shown=" (10 N m/rad)",
    )
    check_digits(
        page,
        "I_p of the HAWC2 shaft from DTTorSpr times length over G",
        earlier * body / G,
        polar,
        0.5e-4,
        f"{sources['polar']}: 'I_p = DTTorSpr*ShftLen/G'; length of the body in "
        f"{sources['body_length']}",
        unit="m^4",
    )
    page.equals(
        "I_p that the OpenFAST figure needs over the section file's length [m^4]",
        published * section / G,
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
    page.answer(
        f"The published {published:,.0f} N m/rad is G J / L of a tube of 3.0 m, wall 0.1 m, "
        f"over 2.2 m; finite elements give {found.stiffness:,.0f} (± {found.band:.1g}).",
        f"The HAWC2 shaft is {100 * (1 - ratio):.1f} % softer for two reasons of length: its "
        "I_p was made from an earlier OpenFAST figure, of the same tube over 3.0 m (factor "
        f"{shaft.length / 3:.4f}), for a body of 6.130 m, and is filed with a section of 5.118 m "
        f"(factor {body / section:.4f}). Over the length of its body, it is "
        f"{100 * (1 - as_run / published):.1f} % softer.",
    )
    page.table(
        "Torsional stiffness of the main shaft",
        [
            {"model": name, STIFFNESS: k, "over OpenFAST today": k / published, "what": what}
            for name, k, what in (
                ("OpenFAST, today", published, "G J over 1.0 + 1.2 m"),
                ("OpenFAST, earlier", earlier, "G J over 3.0 m"),
                ("HAWC2, length of the body file", as_run, "the earlier figure again"),
                ("HAWC2, length of the section file", as_filed, "the same I_p over 5.118 m"),
                ("finite elements, 2.2 m", found.stiffness, "three meshes"),
            )
        ],
    )
    page.chart(
        "Finite elements against G J / L by elements round a turn",
        [
            trace(
                "three meshes",
                [1 / s for s in found.series.sizes],
                [abs(v / shaft.closed - 1) for v in found.series.values],
                marker={"size": 9},
            )
        ],
        "elements round a turn",
        "relative error",
        "xy",
    )
    page.text(
        f"I_p of the tube itself is {J:.4f} m^4; the HAWC2 figure is an equivalent that carries a "
        "stiffness, not a section. It serves one length and one G only. A further version of the "
        "model (commit d77070a) has a body of 5.168 m."
    )
