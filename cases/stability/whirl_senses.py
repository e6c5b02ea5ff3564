"""Where whirl has no sense, and where damping of the shaft drives it: three sweeps of one rotor."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.dynamics.whirl import (
    Disc,
    Element,
    Rotor,
    bearing_of,
    rotor_of,
    stability_limit,
    whirl_modes,
)
from fe_drivetrain.report import heat_map, marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.shafts.beam import round_section

POLAR, ACROSS, MASS = 0.2, 0.1, 1.0  # a thin disc [kg m^2, kg]
TILT, SHIFT = 1e5, 1e9  # stiffness about and along the axes across [N m/rad, N/m]
W0 = float(np.sqrt(TILT / ACROSS))
SORTED = 0.1
"""Share of whirl of one sense over the other, of all, at which a mode has that sense."""

UNEVEN = "difference of the supports' stiffness in two planes over the gyroscopic split"
SENSES = "Sense of whirl over how uneven supports are: 1 is forward; shaded: sorted"
SLOW = "Difference of the sense from forward over the speed, equal supports"
MAP = "Growth of whirl by speed and damping of the bearings: negative damping ratio, in thousandths"


@dataclass(frozen=True)
class Swept:
    """Results of the three sweeps.

    ``uneven`` are differences of stiffness over the split, ``senses`` and ``exact`` those of the
    forward mode; ``slow`` speeds over the frequency, ``lost`` what the sense lacks of 1; ``shares``
    of outer over inner damping, ``limits`` speeds over the frequency from which whirl grows;
    ``growth`` (shares, speeds) negative damping ratios at ``speeds``.
    """

    uneven: Floats
    senses: Floats
    exact: Floats
    slow: Floats
    lost: Floats
    shares: Floats
    limits: Floats
    speeds: Floats
    growth: Floats


def tilting(difference: float) -> Rotor:
    """A disc that tilts on supports, stiffer about z and softer about y by a share."""
    K = np.diag([0.0, SHIFT, SHIFT, 0.0, TILT * (1 - difference), TILT * (1 + difference)])
    return rotor_of("disc", [], [Disc(0, MASS, POLAR, ACROSS)], [bearing_of("support", 0, K)])


def exact_sense(difference: float, split: float) -> float:
    """Sense of the faster of both tilts at a gyroscopic term W J_p / (J w0), in closed form.

    a'' + g b' + (1 + d) a = 0 and b'' - g a' + (1 - d) b = 0: with f^2 the larger root of
    f^4 - (2 + g^2) f^2 + 1 - d^2 = 0, b = i r a with r = (1 + d - f^2) / (g f), and the sense is
    -2 r / (1 + r^2).

    Parameters
    ----------
    difference, split : float
        d and g.
    """
    half = 1 + split**2 / 2
    square = half + np.sqrt(half**2 - 1 + difference**2)
    r = (1 + difference - square) / (split * np.sqrt(square))
    return float(-2 * r / (1 + r**2))


def sense_of_faster(rotor: Rotor, speed: float) -> float:
    """Sense of the faster of both tilts, which are slower than all shifts."""
    return float(whirl_modes(rotor, speed, 2).senses[1])


def damped_disc(share: float) -> Rotor:
    """A disc between two light halves of a shaft, damped as it turns and, by a share, from outside.

    Parameters
    ----------
    share : float
        Outer over inner damping.
    """
    steel = Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=0.0)
    section, half = round_section(0.05, 0.3), 0.5
    stiffness = 48 * steel.youngs_modulus * section.inertias[0]
    seconds = 1e-2 / np.sqrt(stiffness / MASS)
    held = np.diag([0.0, 1e8 * stiffness, 1e8 * stiffness, 0.0, 0.0, 0.0])
    outer = share * seconds * stiffness * np.diag([0.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    bearings = [bearing_of("front", 0, held), bearing_of("rear", 2, held)]
    bearings.append(bearing_of("air", 1, np.zeros((6, 6)), outer))
    return rotor_of(
        "Jeffcott",
        [Element(half, section, steel)] * 2,
        [Disc(1, MASS, 0.0, 0.0)],
        bearings,
        theory="euler",
        viscous=float(seconds),
    )


def jeffcott_frequency() -> float:
    """Its frequency [rad/s]."""
    return float(np.sqrt(48 * 2.1e11 * round_section(0.05, 0.3).inertias[0] / MASS))


def swept(points: int) -> Swept:
    """The three sweeps.

    Parameters
    ----------
    points : int
        Points of each.
    """
    split = 1e-3
    uneven = np.geomspace(1e-2, 30.0, points)
    speed = split * W0 * ACROSS / POLAR
    senses = [sense_of_faster(tilting(float(u) * split), speed) for u in uneven]
    exact = [exact_sense(float(u) * split, split) for u in uneven]
    slow = np.geomspace(1e-16, 1.0, points)
    lost = [1 - sense_of_faster(tilting(0.0), float(s) * W0) for s in slow]
    w0, shares = jeffcott_frequency(), np.linspace(0.0, 3.0, max(points // 4, 4))
    limits = [(stability_limit(damped_disc(float(s)), 6 * w0) or np.nan) / w0 for s in shares]
    speeds = np.linspace(0.2, 5.0, max(points // 2, 6))
    growth = [
        [whirl_modes(damped_disc(float(s)), float(v) * w0).growth for v in speeds] for s in shares
    ]
    return Swept(
        uneven,
        np.array(senses),
        np.array(exact),
        slow,
        np.array(lost),
        shares,
        np.array(limits),
        speeds,
        np.array(growth),
    )


@case(
    "Senses of whirl on nearly equal supports, at rest, and with damping of the shaft",
    source="closed forms of a tilting disc and of Jeffcott's rotor with inner damping (Smith 1933)",
)
def run(run: Run, page: Page) -> None:
    """Three sweeps against closed forms."""
    with run.step("sweeps"):
        found = swept(17 if run.quick else 49)
    page.vanishes(
        "sense of whirl on uneven supports, largest difference from its closed form",
        float(np.abs(found.senses - found.exact).max()),
        within=1e-9,
        why="round-off of shapes whose neighbour is a thousandth away",
        source="two equations in closed form",
    )
    bound = float(np.interp(-SORTED, -found.senses, found.uneven))
    page.equals(
        "unevenness over the split at which a tenth of the whirl has a sense",
        bound,
        np.sqrt(1 / SORTED**2 - 1),
        within=0.05,
        why="straight between points of the sweep; of first order in both",
        source="sense g / sqrt(g^2 + d^2) for a small difference d and a small split g",
    )
    page.vanishes(
        "speed from which whirl grows, largest relative difference from 1 + outer over inner "
        "damping, over the frequency",
        float(np.abs(found.limits / (1 + found.shares) - 1).max()),
        within=1e-3,
        why="damping ratios of a hundredth: of the second order in these",
        source="Jeffcott's rotor with inner and outer damping, Smith 1933",
    )
    slowest = float(found.slow[found.lost < SORTED].min())
    state_limits(page, bound, slowest)
    answer(page, found, bound, slowest)
    show(page, found)


def state_limits(page: Page, bound: float, slowest: float) -> None:
    """Where whirl has no sense."""
    page.limit(
        "forward and backward whirl on nearly equal supports",
        UNEVEN,
        high=bound,
        criterion=f"{SORTED:g} of the whirl or more has one sense",
        beyond="modes are straight motions, each in its plane, and unbalance excites both",
        program="states the sense as a number from -1 to 1, and calls small ones neither",
        remedy="read the share of forward whirl, not the word",
    )
    page.limit(
        "forward and backward whirl of a slow shaft",
        "speed over the frequency",
        low=slowest,
        criterion=f"{SORTED:g} of the whirl or more has one sense",
        beyond="both whirls have one frequency, and round-off mixes them",
        program="states no sense at rest, and follows modes from the first speed above",
        remedy="none is needed: frequencies are right",
    )


def answer(page: Page, found: Swept, bound: float, slowest: float) -> None:
    """State where senses and stability are lost."""
    equal = float(np.interp(1.0, found.uneven, found.senses))
    page.answer(
        "When can forward and backward whirl not be told apart?",
        "Forward and backward whirl can be told apart until the supports' stiffnesses differ by "
        f"{formatted(bound, 2)} times the frequency split from gyroscopic effects.",
        [
            page.value("difference of stiffness over the gyroscopic split", rounded([bound], 2)[0]),
            page.value("slowest speed over the natural frequency, equal supports", slowest),
            page.value("sense of whirl (1: forward) where difference and split are equal", equal),
            page.value(
                "speed from which whirl grows, equal dampings, over the frequency",
                float(np.interp(1.0, found.shares, found.limits)),
                beside=2.0,
                by="closed form",
            ),
        ],
        hero=SENSES,
        cautions=[
            "On equal supports whirl has a sense down to the slowest speeds.",
            "The difference is that of each plane's stiffness from the mean, relative; the split "
            "is that of the two whirl frequencies on equal supports, over the natural frequency.",
        ],
    )


def show(page: Page, found: Swept) -> None:
    """Charts of the sweeps."""
    page.section("Uneven supports")
    page.chart(
        SENSES,
        [
            marked("computed", found.uneven, found.senses),
            trace("closed form", found.uneven, found.exact, line={"dash": "dot"}),
        ],
        UNEVEN,
        "sense of the faster tilt",
        logarithmic=("x",),
        safe=(None, float(np.sqrt(1 / SORTED**2 - 1))),
    )
    page.section("Slow shafts")
    page.chart(
        SLOW,
        [marked("computed", found.slow, np.maximum(found.lost, 1e-17))],
        "speed over the frequency",
        "1 less the sense",
        logarithmic=("x", "y"),
    )
    page.section("Damping of the shaft and of bearings")
    page.add(
        heat_map(
            MAP,
            found.speeds,
            found.shares,
            1e3 * found.growth,
            (
                "speed over the frequency",
                "outer over inner damping",
                "growth [1e-3]",
            ),
        )
    )
    rows = [
        {"outer over inner damping": float(s), "whirl grows from, over the frequency": float(v)}
        for s, v in zip(found.shares, found.limits, strict=True)
    ]
    page.table("Speed from which whirl grows", rows)
