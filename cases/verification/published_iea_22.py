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
from fe_drivetrain.report.suite import Page, Record, Target


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
    page.say(
        f"DTTorSpr for the main shaft alone: {found.stiffness:.5g} N m/rad (numerical band "
        f"± {found.band:.1g}; {low:.4g} to {high:.4g} for any usual G). The released model holds "
        f"{placeholder:.0e} with the degree of freedom off, {placeholder / found.stiffness:.0f} "
        f"times as much; one before it held {earlier:,.0f}, which is G J / L to round-off."
    )
    by = {
        "finite elements": found.stiffness,
        "meridian": by_meridian,
        "G J / L": closed,
        "thin-walled formula": thin,
        "earlier release": earlier,
        "placeholder": placeholder,
    }
    compare_stiffness(page, "Torsional stiffness", "by", by, "G J / L", closed)
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
