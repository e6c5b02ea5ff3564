"""Main shaft by finite elements, and checks, shared by the cases of published turbines."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references.shaft_theory import polar_moment
from fe_drivetrain.cases.references.twisted_tubes import TwistedTube, twisted_tube
from fe_drivetrain.report import bars
from fe_drivetrain.report.suite import Page, Run, Target

DIGITS = "half of the last published digit"
CLOSED_FORM = "closed form G J / L"
#: Least and largest shear modulus of steels [Pa].
USUAL_G = np.array([79.3e9, 80.8e9])

STIFFNESS = "stiffness [N m/rad]"


@dataclass(frozen=True)
class MainShaft:
    """A uniform main shaft [m, Pa], its stiffness in closed form [N m/rad] and by elements."""

    outer: float
    inner: float
    length: float
    G: float
    closed: float
    found: TwistedTube


def main_shaft(run: Run, given: Mapping[str, float]) -> MainShaft:
    """The main shaft of a turbine by finite elements."""
    outer, G = given["outer"], 1e9 * given["G"]
    inner = outer - 2 * given["wall"] if "wall" in given else 0.0
    length = given["length"] if "length" in given else given["to_bearing"] + given["between"]
    found = run.timed("mesh and solve", twisted_tube, outer, inner, length, G, run.quick)
    return MainShaft(outer, inner, length, G, G * polar_moment(outer, inner) / length, found)


def check_torsion(page: Page, name: str, found: TwistedTube, reference: float, source: str) -> None:
    """The stiffness by finite elements against a closed form or a published figure."""
    key = f"{name} [N m/rad]"
    page.meets(
        found.stiffness, Target(key, reference, found.tolerance, found.reason, source), found.band
    )


def check_digits(
    page: Page, key: str, computed: float, published: float, half: float, source: str
) -> None:
    """A closed form against a published figure, to half of its last digit."""
    digit = f" ({2 * half:g} N m/rad)" if half >= 0.5 else ""
    why = f"{DIGITS}{digit}"
    page.meets(computed, Target(key, published, half / published, why, source, measure="stiffness"))


def check_free_free(page: Page, by_eigenvalues: float, closed: float) -> None:
    """The free-free frequency of rotor and generator, by eigenvalues and in closed form."""
    of = "the eigenvalues of two masses"
    formula = "sqrt(k (1 / J_rotor + 1 / n^2 J_generator)) / 2 pi"
    check_frequency(page, "free-free", by_eigenvalues, closed, of, formula)


def check_frequency(
    page: Page, name: str, by_eigenvalues: float, closed: float, of: str, formula: str
) -> None:
    """A frequency by eigenvalues and in closed form."""
    page.vanishes(
        f"{name} frequency by eigenvalues against the closed form",
        by_eigenvalues / closed - 1,
        within=1e-9,
        why=f"round-off of {of}: both are the same formula",
        source=formula,
        basis="self-consistency",
    )


def compare_stiffness(
    page: Page,
    caption: str,
    heading: str,
    by: Mapping[str, float],
    over: str,
    reference: float,
    without: str = "",
) -> None:
    """Bars and a table of stiffness by description, and each over a reference of that name.

    The one description `without` has no bar.
    """
    giga = {name: k / 1e9 for name, k in by.items() if name != without}
    page.add(bars(caption, {"stiffness": giga}, "stiffness [GN m/rad]"))
    page.table(
        "The same in numbers",
        [{heading: name, STIFFNESS: k, f"over {over}": k / reference} for name, k in by.items()],
    )
