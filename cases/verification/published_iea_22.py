"""IEA 22 MW turbine: a thin tube by closed forms, in its meridian and as a solid."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fe_drivetrain.cases.references import solid_shafts
from fe_drivetrain.cases.references.shaft_theory import polar_moment
from fe_drivetrain.cases.references.twisted_tubes import material_of
from fe_drivetrain.cases.verification.published_checks import (
    CLOSED_FORM,
    STIFFNESS,
    USUAL_G,
    MainShaft,
    check_torsion,
    compare_stiffness,
)
from fe_drivetrain.elasticity.revolution import end_stiffness
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import Page, Record, Target

BY_METHOD = "Torsional stiffness of the main shaft by each method, and in the released model"


def judge(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """The thin tube by finite elements and by its closed forms."""
    found, wall, G, length = shaft.found, given["wall"], shaft.G, shaft.length
    placeholder, earlier, closed = given["placeholder"], given["earlier"], shaft.closed
    radius = (shaft.outer - wall) / 2
    thin = float(G * 2 * np.pi * radius**3 * wall / length)
    tube = solid_shafts.straight((0.0, length), shaft.outer, shaft.inner)
    by_meridian = float(end_stiffness(tube, material_of(G))[9, 9])
    low, high = closed * USUAL_G / G
    same = "the same formula with the same inputs, all digits given: round-off"
    linear = "the angle of twist is linear, which the elements hold exactly: round-off"
    square = "it leaves out terms of the square of wall over radius"
    thick, title = (wall / radius) ** 2, "thin-walled formula 2 pi G r^3 t / L [N m/rad]"
    filed = Target("G J / L of the tube [N m/rad]", earlier, 1e-9, same, sources["earlier"])
    meridian = "Fourier harmonics in the meridian [N m/rad]"
    page.meets(closed, filed)
    check_torsion(page, "finite elements", found, earlier, sources["earlier"])
    page.meets(by_meridian, Target(meridian, closed, 1e-8, linear, CLOSED_FORM))
    page.meets(thin, Target(title, closed, thick, square, CLOSED_FORM))
    answer(page, placeholder, (low, high))
    page.say(
        "The released model has the degree of freedom off. Shear moduli of usual steels give "
        f"{low / 1e9:.2f} to {high / 1e9:.2f} GN m/rad."
    )
    by = {
        "finite elements": found.stiffness,
        "meridian": by_meridian,
        "G J / L": closed,
        "thin-walled formula": thin,
        "earlier release": earlier,
        "placeholder": placeholder,
    }
    compare_stiffness(page, BY_METHOD, "by", by, "G J / L", closed)
    walls = np.array([0.01, 0.02, 0.05, 0.1, 0.2, 0.3])
    by_wall = [G * polar_moment(shaft.outer, shaft.outer - 2 * w) / length for w in walls]
    curves = [
        trace("G J / L", walls, by_wall),
        trace("finite elements", [wall], [found.stiffness], True, marker={"size": 10}),
        trace("placeholder", walls[[0, -1]], [placeholder] * 2),
    ]
    title = "G J / L of the shaft by its wall, and what other walls would give"
    page.chart(title, curves, "wall [m]", STIFFNESS, "xy")
    page.text(
        "A wall of 20 mm on 3.1 m is thin enough to buckle or ovalise before it yields; torsion "
        "between rigid ends knows nothing of that."
    )


def answer(page: Page, placeholder: float, usual: tuple[float, float]) -> None:
    """State the shaft's stiffness, and that the released one is none of it.

    `usual` is the stiffness for the least and the largest modulus of usual steels; all in N m/rad.
    """
    found = page.judged(
        "finite elements", "main shaft, finite elements", "earlier release", unit="GN m/rad"
    )
    released = value_text(placeholder / 1e9, "GN\u00a0m/rad")
    times = 1e9 * found.value
    is_placeholder = placeholder > 1.1 * usual[1]
    page.answer(
        "Which torsional stiffness has the main shaft of the IEA 22 MW turbine?",
        f"The shaft's thin tube has {certain_value(found)}; the released model has {released}, "
        f"{placeholder / times:.0f} times as much, which is not this shaft's stiffness."
        if is_placeholder
        else f"The shaft's thin tube has {certain_value(found)}, beside {released} of the released "
        "model.",
        [
            found,
            page.value(
                "released model [GN m/rad]", placeholder / 1e9, beside=found.value, by="this shaft"
            ),
            page.judged(
                "thin-walled formula 2 pi G r^3 t / L",
                "thin-walled formula",
                "closed form",
                unit="GN m/rad",
            ),
            page.value("the shaft with G = 79.3 GPa [GN m/rad]", usual[0] / 1e9),
            page.value("the shaft with G = 80.8 GPa [GN m/rad]", usual[1] / 1e9),
        ],
        hero=BY_METHOD,
        cautions=["Ends turn as rigid planes: a thin wall that buckles or ovalises is softer."],
        claim="does not hold" if is_placeholder else "holds",
    )
