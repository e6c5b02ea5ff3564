"""Friction of a bearing from standstill to starvation: where film and lubricant decide."""

from dataclasses import replace
from math import log

import numpy as np

from fe_drivetrain.bearing import (
    catalogue_entry,
    friction_bearing,
    palmgren_friction,
    ratings,
    roller_friction,
    skf_friction,
    sliding_coefficient,
)
from fe_drivetrain.bearing.skf_friction import BOUNDARY, MINERAL_FILM
from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

BEARING = "spherical_23180"
#: Share of boundary friction below which a film carries, and of rolling that starvation may take.
CARRIED, STARVED = 0.05, 0.5
OIL = 100e-6
PARAMETER = "viscosity times speed [mm2/s 1/min]"
HERO = (
    "Friction moment from standstill to starvation, at a tenth of the rating; shaded: oil film and "
    "enough oil"
)


@case(
    "Friction of a bearing: standing still, without a film, and starved",
    source="SKF, Rolling bearings (2016); Juenemann 2010; Zhou and Hoeprich 1991",
)
def run(run: Run, page: Page) -> None:
    """Moments over viscosity times speed; where the film breaks down, and where oil is missing."""
    entry = catalogue_entry(BEARING)
    sizes = friction_bearing(BEARING, entry)
    load = 0.1 * ratings(entry.bearing(BEARING)).dynamic
    count = 25 if run.quick else 121
    product = np.geomspace(1.0, 1e8, count)  # mm2/s times 1/min
    speed = product / (1e6 * OIL) * np.pi / 30.0
    forces = (np.full(count, load), np.zeros(count))
    with run.step("speeds"):
        skf = skf_friction(sizes, *forces, speed, OIL)
        factors = palmgren_friction(sizes, *forces, speed, OIL)
        mu = sliding_coefficient(sizes, speed, OIL)
        rollers = roller_friction(entry.bearing(BEARING), *forces, speed, OIL, mu)
    with run.step("standstill"):
        check_standstill(page, load)
    low = film_bound(1e3 * sizes.mean_diameter)
    high = fed_bound(skf.viscous, product)
    check_bounds(page, sizes.mean_diameter, low)
    page.limit(
        "friction of a rolling bearing by SKF's model",
        PARAMETER,
        low=low,
        high=high,
        criterion=f"boundary friction below {100 * CARRIED:g} %, rolling above "
        f"{100 * STARVED:g} % of that of a fed, cool inlet",
        beyond="below, sliding without a film decides, up to the starting moment; above, rolling "
        "falls again as oil comes back too late, and no model was fitted there",
        program="computes it at any speed without a division by zero, and states no band beyond "
        "the difference of models",
        remedy="a thicker oil below, a thinner one above",
    )
    page.section("Friction over viscosity times speed")
    page.chart(
        HERO,
        [
            trace("SKF's model", product, skf.total),
            trace("of it sliding", product, skf.loaded, line={"dash": "dot"}),
            trace("factors f0 and f1", product, factors.total),
            trace("sum over rollers", product, rollers.total),
        ],
        PARAMETER,
        "friction moment [N m]",
        ("x", "y"),
        safe=(low, high),
    )
    page.data("friction", {PARAMETER: product, "SKF's model [N m]": skf.total})
    known = (product >= low) & (product <= high)
    apart = rollers.total / skf.total
    answer(page, low, high, (float(apart[known].max()), float(apart.max())))


def film_bound(diameter: float) -> float:
    """nu n from which boundary friction has less than its share, by the closed form of phi_bl."""
    return float((log(1.0 / CARRIED) / (2.6e-8 * diameter)) ** (1.0 / 1.4))


def fed_bound(rolling: Floats, product: Floats) -> float:
    """nu n up to which rolling has its share of (nu n)^0.6 as without heating and starvation."""
    shares = rolling / product**0.6
    return float(np.exp(np.interp(-STARVED, -shares / shares[0], np.log(product))))


def check_standstill(page: Page, load: float) -> None:
    """At standstill and at speeds next to it moments are finite, and SKF's is that of boundary."""
    entry = catalogue_entry(BEARING)
    sizes = friction_bearing(BEARING, entry)
    speeds = np.array([0.0, 1e-300, 1e-12, 1e-6])
    forces = (np.full(4, load), np.zeros(4))
    found = {
        "SKF's model": skf_friction(sizes, *forces, speeds, OIL),
        "factors f0 and f1": palmgren_friction(sizes, *forces, speeds, OIL),
        "sum over rollers": roller_friction(
            entry.bearing(BEARING), *forces, speeds, OIL, sliding_coefficient(sizes, speeds, OIL)
        ),
    }
    for name, of in found.items():
        page.holds(
            f"{name}: moments are finite and above 0 at standstill and next to it",
            bool(np.isfinite(of.total).all() and (of.total > 0.0).all()),
            why="a bearing under load resists the beginning of motion by a finite moment",
            source="no speed is divided by",
            basis="self-consistency",
        )
    moved = found["SKF's model"].total
    page.equals(
        "SKF's model: moment to begin over that of slow motion",
        float(moved[0] / moved[2]),
        0.15 / BOUNDARY,
        within=1e-6,
        why="the same variable G_sl with both published coefficients",
        source="SKF, Rolling bearings (2016): mu_bl 0.15 for starting, 0.12 in motion",
        basis="second-hand",
    )


def check_bounds(page: Page, diameter: float, low: float) -> None:
    """The sliding coefficient has its share of boundary friction at the bound that was found."""
    sizes = friction_bearing(BEARING, catalogue_entry(BEARING))
    speed = low / (1e6 * OIL) * np.pi / 30.0
    mu = float(sliding_coefficient(sizes, speed, OIL))
    page.equals(
        "share of boundary friction at the lower bound",
        (mu - MINERAL_FILM) / (BOUNDARY - MINERAL_FILM),
        CARRIED,
        within=1e-9,
        why="round-off of a logarithm and a power",
        source="closed form of phi_bl",
        basis="self-consistency",
    )
    # the bound goes with the size to the power -1 / 1.4: a larger bearing has a film earlier
    larger = replace(sizes, bore=2.0 * sizes.bore, outside=2.0 * sizes.outside)
    page.equals(
        "lower bound of a bearing of twice the size over that of this one",
        film_bound(1e3 * larger.mean_diameter) / film_bound(1e3 * diameter),
        0.5 ** (1.0 / 1.4),
        within=1e-12,
        why="round-off",
        source="exponent of phi_bl",
        basis="self-consistency",
    )


def answer(page: Page, low: float, high: float, apart: tuple[float, float]) -> None:
    """State between which products of viscosity and speed models of friction can be trusted."""
    page.answer(
        "In which range may models of the friction of a bearing be trusted?",
        "Bearing 23180 has an oil film and enough oil where viscosity times speed is "
        f"{formatted(low, 3)} to {formatted(high, 3)}\u00a0mm²/s\u00a0×\u00a01/min; below, "
        "boundary friction dominates; above, friction models disagree.",
        [
            page.value(f"oil film from, {PARAMETER}", rounded([low], 3)[0]),
            page.value(f"enough oil up to, {PARAMETER}", rounded([high], 3)[0]),
            page.judged(
                "SKF's model: moment to begin over that of slow motion",
                "friction moment at the start over that in slow rotation",
            ),
            page.value(
                "largest ratio of two models (sum over rollers, SKF) in that range", apart[0]
            ),
            page.value("largest ratio of the two models up to 1e8 mm2/s 1/min", apart[1]),
        ],
        hero=HERO,
        cautions=["The bounds follow from published formulas; no measurement confirms them."],
    )
