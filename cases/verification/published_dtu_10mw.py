"""DTU 10 MW turbine: frequencies of two masses, and the shaft behind the stiffness."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fe_drivetrain.cases.references.shaft_theory import (
    chain_frequencies,
    polar_moment,
    rod_frequency,
    two_mass_frequencies,
)
from fe_drivetrain.cases.verification.published_checks import (
    DIGITS,
    STIFFNESS,
    MainShaft,
    check_digits,
    check_free_free,
    check_frequency,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import certain_value, percent_text
from fe_drivetrain.report.suite import Page, Record, Target

BY_STIFFNESS = "Frequencies of the two masses by the stiffness between them"
STEEL_DENSITY = 7850.0  # kg/m^3


def judge(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """Two masses in closed form, by eigenvalues, and with the shaft's own inertia."""
    stiffness, rotor, polar = given["stiffness"], given["rotor"], given["polar"]
    generator = given["generator"] * given["ratio"] ** 2
    free, fixed = two_mass_frequencies(stiffness, rotor, generator)
    by_eigenvalues = float(chain_frequencies([rotor, generator], [stiffness])[1])
    held = float(chain_frequencies([rotor], [], stiffness)[0])
    own = STEEL_DENSITY * polar * shaft.length
    with_shaft = rod_frequency(stiffness, own, rotor, generator)
    published = [given["free_free"], given["free_fixed"]]
    check_frequencies(page, sources["stiffness"], (free, fixed), published)
    check_free_free(page, by_eigenvalues, free)
    formula = "sqrt(k / J_rotor) / 2 pi"
    check_frequency(page, "free-fixed", held, fixed, "one eigenvalue", formula)
    check_shaft(page, given, sources, shaft)
    answer(page, shaft, with_shaft, free)
    page.say(
        f"The stiffness is K G / L of a solid shaft of {shaft.outer:g} m over {shaft.length:g} m "
        "to its last digit; that shaft's own inertia would lower the first frequency by "
        f"{percent_text(1 - with_shaft / free)}."
    )
    show_by_stiffness(page, given, (rotor, generator), published)
    page.table(
        "Frequencies [Hz]",
        [
            ["free-free", free, by_eigenvalues, published[0]],
            ["free-fixed (generator held)", fixed, held, published[1]],
            ["free-free with the shaft's inertia", with_shaft, None, None],
        ],
        ["case", "closed form", "eigenvalues", "published"],
    )
    page.text(
        "The IEA 10 MW turbine's OpenFAST model holds the same stiffness, rounded: see that case."
    )
    page.assume("density of the shaft", STEEL_DENSITY, "kg/m^3", "steel")
    page.data("free_free", free)
    page.data("free_fixed", fixed)


def answer(page: Page, shaft: MainShaft, with_shaft: float, free: float) -> None:
    """State the frequencies of rotor and generator, and the shaft that they belong to."""
    wang = "Wang et al."
    swings = page.judged("free-free frequency, two masses", "free-free frequency", wang, "4.003")
    held = page.judged(
        "free-fixed frequency, two masses", "frequency with the generator locked", wang, "0.612"
    )
    same = "as published" if swings.status == held.status == "good" else "other than published"
    page.answer(
        "At which frequencies do rotor and generator of the DTU 10 MW turbine swing?",
        f"Rotor and generator swing against each other at {certain_value(swings)}, the rotor alone "
        f"at {certain_value(held)} with the generator locked: {same}.",
        [
            swings,
            held,
            page.value(
                "free-free frequency with the shaft's own inertia [Hz]",
                with_shaft,
                beside=free,
                by="shaft without mass",
            ),
            page.judged(
                f"finite elements, solid shaft of {shaft.outer:g} m",
                f"torsional stiffness of a solid shaft of {shaft.outer:g} m",
                wang,
                unit="GN m/rad",
            ),
        ],
        hero=BY_STIFFNESS,
    )


def check_frequencies(
    page: Page, source: str, computed: tuple[float, float], published: list[float]
) -> None:
    """Frequencies of the two masses, as published."""
    for name, found, value in zip(("free-free", "free-fixed"), computed, published, strict=True):
        key = f"{name} frequency, two masses [Hz]"
        page.meets(found, Target(key, value, 0.0005, DIGITS, source, relative=False))


def check_shaft(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """The published stiffness is that of a solid shaft."""
    polar, stiffness = given["polar"], given["stiffness"]
    source, found = sources["stiffness"], shaft.found
    title = "stiffness from K G / L of the turbine's HAWC2 shaft [N m/rad]"
    check_digits(page, title, polar * shaft.G / shaft.length, stiffness, 0.5, source)
    title = f"polar moment of a solid shaft of {shaft.outer:g} m [m^4]"
    check_digits(page, title, polar_moment(shaft.outer), polar, 0.5e-4, sources["polar"])
    title = f"finite elements, solid shaft of {shaft.outer:g} m [N m/rad]"
    arcs = f"{found.per_turn} parabolic arcs round a turn, and {DIGITS} of K"
    within = found.tolerance + 0.5e-4 / polar
    page.meets(found.stiffness, Target(title, stiffness, within, arcs, source), found.band)


def show_by_stiffness(
    page: Page, given: Mapping[str, Any], masses: tuple[float, float], published: list[float]
) -> None:
    """Frequencies over the stiffness between the masses."""
    sweep = np.logspace(8.5, 11, 60)
    lines = np.array([two_mass_frequencies(k, *masses) for k in sweep])
    curves = [
        trace("free-free", sweep, lines[:, 0]),
        trace("free-fixed", sweep, lines[:, 1]),
        trace("published", [given["stiffness"]] * 2, published, True, marker={"size": 10}),
    ]
    page.chart(BY_STIFFNESS, curves, STIFFNESS, "frequency [Hz]", "xy")
