"""NREL 5 MW turbine: the main shaft beside the stiffness of the whole drivetrain."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fe_drivetrain.cases.references.shaft_theory import (
    chain_frequencies,
    polar_moment,
    solid_diameter,
    two_mass_frequencies,
)
from fe_drivetrain.cases.verification.published_checks import (
    CLOSED_FORM,
    STIFFNESS,
    MainShaft,
    check_free_free,
    check_torsion,
    compare_stiffness,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import Page, Record

HIGH_SPEED = "high-speed shaft, G J n^2 / L"
BY_PART = "Torsional stiffness of the main shaft and of the whole drivetrain, on the rotor's side"


def judge(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """The shaft beside the published stiffness of the whole drivetrain."""
    found, G, length = shaft.found, shaft.G, shaft.length
    stiffness, rotor = given["stiffness"], given["rotor"]
    high = G * polar_moment(given["high"]) / given["high_length"] * given["wisdem_ratio"] ** 2
    series = 1 / (1 / shaft.closed + 1 / high)
    generator = given["generator"] * given["ratio"] ** 2
    free, fixed = two_mass_frequencies(stiffness, rotor, generator)
    soft, _ = two_mass_frequencies(series, rotor, generator)
    check_damping(page, given, rotor * generator / (rotor + generator))
    check_free_free(page, float(chain_frequencies([rotor, generator], [stiffness])[1]), free)
    check_torsion(page, "finite elements, low-speed shaft alone", found, shaft.closed, CLOSED_FORM)
    needed = solid_diameter(stiffness * length / G)
    answer(page, stiffness, (shaft.outer, needed), (free, soft))
    page.say(
        f"The shaft of WISDEM's model, {shaft.outer:g} m over {length:.2f} m, and the stiffness of "
        "the aeroelastic model do not belong to one machine: that stiffness would need the shaft "
        f"to be {length * shaft.closed / stiffness:.2f} m long, or {needed:.2f} m thick, with all "
        "else rigid."
    )
    by = {
        "published, whole drivetrain": stiffness,
        "low-speed shaft, G J / L": shaft.closed,
        "low-speed shaft, finite elements": found.stiffness,
        HIGH_SPEED: high,
        "both in series, as WISDEM does": series,
    }
    compare_stiffness(page, BY_PART, "part", by, "the published", stiffness, HIGH_SPEED)
    frequencies = [
        ("published", free),
        ("WISDEM's shafts in series", soft),
        ("published, generator held", fixed),
    ]
    page.table("Frequencies of rotor and generator", frequencies, ["stiffness", "frequency [Hz]"])
    show_by_diameter(page, stiffness, shaft)
    page.text(
        "Compliances add: a drivetrain is softer than each of its shafts. With the published "
        "figure and a shaft that takes half of the compliance, it would be "
        f"{solid_diameter(2 * stiffness * length / G):.2f} m thick over {length:.2f} m. Gearbox "
        "and generator have the other half then; no published split is known."
    )
    solid = "a wall of 0.288 m leaves 1 mm of 0.577 m: 1e-11 of J"
    page.assume("bore of the low-speed shaft", "none", "", solid)


def check_damping(page: Page, given: Mapping[str, Any], inertia: float) -> None:
    """The published damping is 5 % of critical."""
    page.equals(
        "damping ratio of the free-free mode [-]",
        float(given["damping"] / (2 * np.sqrt(given["stiffness"] * inertia))),
        0.05,
        within=0.0005,
        relative=False,
        why="the published 5 % to two figures",
        source="Jonkman et al. 2009, NREL/TP-500-38060, section 5: stiffness and damping for 5 % "
        "(second-hand: the section itself was not read)",
        measure="frequency",
        basis="second-hand",
    )


def show_by_diameter(page: Page, stiffness: float, shaft: MainShaft) -> None:
    """Stiffness of a solid shaft over its diameter, beside the published figure."""
    diameters = np.linspace(0.4, 1.2, 60)
    by_diameter = shaft.G * np.array([polar_moment(d) for d in diameters])
    curves = [trace(f"{L:g} m", diameters, by_diameter / L) for L in (1.0, 2.28, 4.0)]
    curves += [
        trace("published", diameters[[0, -1]], [stiffness] * 2),
        trace("finite elements", [shaft.outer], [shaft.found.stiffness], True, marker={"size": 10}),
    ]
    title = "Stiffness of a solid main shaft by its diameter, for several lengths, beside the "
    title += "published figure of the drivetrain"
    page.chart(title, curves, "diameter [m]", STIFFNESS, "y")


def answer(
    page: Page, stiffness: float, diameters: tuple[float, float], modes: tuple[float, float]
) -> None:
    """State whether the main shaft fits the stiffness that is published for the whole drivetrain.

    Parameters
    ----------
    page : Page
        With the check of the shaft.
    stiffness : float
        That of the whole drivetrain, published [N m/rad].
    diameters : tuple of float
        Diameter of the shaft, and what the published stiffness would need [m].
    modes : tuple of float
        Free-free frequency of rotor and generator by the published stiffness and by the shafts
        [Hz].
    """
    found = page.judged(
        "finite elements, low-speed shaft alone",
        "main shaft alone, finite elements",
        "closed form",
        unit="MN m/rad",
    )
    published = stiffness / 1e6
    fits = found.value >= published
    whole = value_text(published, "MN\u00a0m/rad")
    page.answer(
        "Does the main shaft fit the torsional stiffness published for the NREL 5 MW drivetrain?",
        f"It can fit: the shaft alone has {certain_value(found)}, not less than the {whole}."
        if fits
        else f"It does not fit: the shaft alone has {certain_value(found)}, "
        f"{published / found.value:.2f} times softer than the {whole} published for the whole "
        "drivetrain.",
        [
            found,
            page.value(
                "published for the whole drivetrain [MN m/rad]",
                published,
                beside=found.value,
                by="main shaft alone",
            ),
            page.value(
                "diameter that the published stiffness needs [m]",
                diameters[1],
                beside=diameters[0],
                by="WISDEM",
            ),
            page.value(
                "free-free frequency with WISDEM's shafts [Hz]",
                modes[1],
                beside=modes[0],
                by="published stiffness",
            ),
        ],
        hero=BY_PART,
        cautions=["Compliances add up: a whole drivetrain must be softer than its shaft alone."],
        claim="holds" if fits else "does not hold",
    )
