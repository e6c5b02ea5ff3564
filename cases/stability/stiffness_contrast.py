"""Stiffness contrast: a soft or stiff ring, a chain of soft and stiff bodies, many at once."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import ValidationError

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import layers
from fe_drivetrain.common import Bools, Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import FOUR_DIGITS, decades, fitted_exponent, in_words, safe_range
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report import crosses, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

#: Bodies of the chain; every other one is stiff.
COUNT = 12
STIFF = range(1, COUNT, 2)
#: Chains of random stiffness at each spread.
SAMPLES = 4

CHAINS = (
    f"Error of the compliance of {COUNT} bodies in a row over the ratio of their moduli; shaded: "
    "four digits by a direct solver, every other body stiff"
)
RING = "modulus of the ring over that of the shaft"
CHAIN = "modulus of the stiff bodies over that of the soft ones"


@dataclass(frozen=True)
class Swept:
    """Relative errors of a compliance over a contrast of moduli.

    Attributes
    ----------
    contrast, error, rigid : (n,) array
        Contrast; errors of a direct solver with all bodies elastic, NaN where it refuses, and with
        stiff bodies rigid.
    tried, iterated : (m,) array
        Contrasts tried with multigrid alone, and its errors.
    converged : (m,) array of bool
        Whether it reported that it converged.
    iterations : list of int
        That it took.
    """

    contrast: Floats
    error: Floats
    rigid: Floats
    tried: Floats
    iterated: Floats
    converged: Bools
    iterations: list[int]

    @property
    def refused(self) -> Bools:
        """Where the direct solver refuses."""
        return ~np.isfinite(self.error)

    @property
    def safe(self) -> tuple[float | None, float | None]:
        """Range with four digits, of the direct solver."""
        return safe_range(self.contrast, self.error, FOUR_DIGITS)

    @property
    def safe_iterated(self) -> tuple[float | None, float | None]:
        """Range with four digits, of multigrid where it converges."""
        error = np.where(self.converged, self.iterated, np.nan)
        return safe_range(self.tried, error, FOUR_DIGITS)

    @property
    def better(self) -> Floats:
        """Error of the better of elastic and rigid bodies."""
        return np.asarray(np.fmin(self.error, self.rigid))


def swept(
    bodies: layers.Series,
    moduli: Callable[[float], Sequence[float]],
    exact: Callable[[Floats], Floats],
    rigid: Sequence[int],
    contrast: Floats,
    tried: Floats,
) -> Swept:
    """Solve bodies in series at every contrast: elastic, with some rigid, and by multigrid."""

    def errors(answers: Sequence[layers.Answer], at: Floats) -> Floats:
        return np.asarray(np.abs(np.array([a.compliance for a in answers]) / exact(at) - 1.0))

    direct = [layers.direct(*bodies.system(moduli(c))) for c in contrast]
    stiff_rigid = [layers.direct(*bodies.system(moduli(c), rigid=rigid)) for c in contrast]
    iterated = [layers.iterated(*bodies.system(moduli(c))) for c in tried]
    return Swept(
        contrast,
        errors(direct, contrast),
        errors(stiff_rigid, contrast),
        tried,
        errors(iterated, tried),
        np.array([a.arrived for a in iterated]),
        [a.iterations for a in iterated],
    )


def ring(quick: bool) -> Swept:
    """A ring about a shaft, from soft to stiff."""
    bodies = layers.ring()
    of_ring = layers.direct(*bodies.system((1.0, 1.0), rigid=(1,))).compliance
    of_both = layers.direct(*bodies.system((1.0, 1.0))).compliance
    return swept(
        bodies,
        lambda c: (c, 1.0),
        lambda c: of_ring / c + (of_both - of_ring),
        (1,),
        decades(-16, 10, 1.0 if quick else 3.0),
        decades(-12, 10, 0.25 if quick else 0.5),
    )


def chain(quick: bool) -> Swept:
    """A chain in which every other body is stiff."""

    def moduli(c: float) -> list[float]:
        return [c if k in STIFF else 1.0 for k in range(COUNT)]

    def exact(contrast: Floats) -> Floats:
        return np.array([sum(1.0 / m for m in moduli(c)) / layers.E for c in contrast])

    return swept(
        layers.chain(COUNT),
        moduli,
        exact,
        STIFF,
        decades(0, 18, 1.0 if quick else 3.0),
        decades(0, 14, 0.25 if quick else 0.5),
    )


def random_chains(quick: bool) -> tuple[Floats, Floats]:
    """Ratios of the largest to the least modulus, and the largest error of chains drawn there."""
    bodies = layers.chain(COUNT)
    rng = np.random.default_rng(0)
    spreads = np.arange(0.0, 9.1, 1.0 if quick else 0.5)
    errors = []
    for spread in spreads:
        worst = 0.0
        for _ in range(SAMPLES):
            drawn = 10.0 ** rng.uniform(-spread, spread, COUNT)
            drawn[rng.permutation(COUNT)[:2]] = 10.0 ** np.array([-spread, spread])
            answer = layers.direct(*bodies.system(list(drawn)))
            error = abs(answer.compliance * layers.E / (1.0 / drawn).sum() - 1.0)
            worst = max(worst, error) if np.isfinite(error) else np.nan
            if np.isnan(worst):
                break
        errors.append(worst)
    return 10.0 ** (2.0 * spreads), np.array(errors)


def allowed_ratio() -> float:
    """Ratio of the stiffest modulus that a material may have to the softest."""

    def is_valid(exponent: float) -> bool:
        try:
            Material(youngs_modulus=10.0**exponent, poisson_ratio=0.3, density=0.0)
        except ValidationError:
            return False
        return True

    # from steel outwards, by halving
    ends = []
    for outside in (-30.0, 40.0):
        inside, bad = math.log10(200e9), outside
        if is_valid(bad):
            ends.append(bad)
            continue
        for _ in range(40):
            middle = 0.5 * (inside + bad)
            inside, bad = (middle, bad) if is_valid(middle) else (inside, middle)
        ends.append(inside)
    return float(10.0 ** (ends[1] - ends[0]))


@case(
    "Stiffness contrast: soft and stiff bodies in series, and rigid ones in their place",
    source="springs in series; Higham 2002, Accuracy and stability of numerical algorithms, ch. 10",
)
def run(run: Run, page: Page) -> None:
    """Sweep the stiffness of some bodies over that of others."""
    of_ring = run.timed("ring about a shaft", ring, run.quick)
    of_chain = run.timed("chain of soft and stiff bodies", chain, run.quick)
    ratios, many = run.timed("many contrasts at once", random_chains, run.quick)
    allowed = run.timed("what the program does", allowed_ratio)
    check_exponents(page, of_ring, of_chain, tolerance=0.3 if run.quick else 0.15)
    check_protection(page, of_ring, of_chain, allowed)
    _, many_high = safe_range(ratios, many, FOUR_DIGITS)
    state_limits(page, of_ring, of_chain, many_high, allowed)
    show(page, of_ring, of_chain, ratios, many)
    page.image("The ring about a shaft", run.sketch(layers.ring().bodies()))


def check_exponents(page: Page, of_ring: Swept, of_chain: Swept, tolerance: float) -> None:
    """How fast digits are lost, and gained where stiff bodies are rigid."""
    scatter = "round-off scatters by about a decade over the decades of the fit"
    soft = of_ring.contrast < 1e-4
    of_soft_ring = fitted_exponent(of_ring.contrast[soft], of_ring.error[soft], (1e-12, 0.1))
    elastic = fitted_exponent(of_chain.contrast, of_chain.error, (1e-11, 0.1))
    rigid = fitted_exponent(of_chain.contrast, of_chain.rigid, (1e-9, 1e-2))
    for quantity, (exponent, band), expected, within, why, source in (
        (
            "soft ring, direct solver: error against the ring's stiffness, exponent",
            of_soft_ring,
            -1.0,
            tolerance,
            scatter,
            "round-off of the shaft's stiffness acts as springs to ground beside the ring",
        ),
        (
            "chain, direct solver: error against the contrast, exponent",
            elastic,
            1.0,
            tolerance,
            scatter,
            "round-off of each stiff body acts as springs to ground between soft ones",
        ),
        (
            "chain, stiff bodies rigid: error against the contrast, exponent",
            rigid,
            -1.0,
            0.02,
            "exact in the discrete model, too: the next order is a hundredth of the largest error "
            "that is fitted",
            "bodies in series: the compliance that rigid ones do not have is 1 / contrast",
        ),
    ):
        page.equals(
            quantity,
            exponent,
            expected,
            within=within,
            why=why,
            source=source,
            measure="order",
            band=band,
        )


def check_protection(page: Page, of_ring: Swept, of_chain: Swept, allowed: float) -> None:
    """Elastic or rigid, one of the two is right; what a scene may contain is solved right."""
    near_one = np.abs(np.log10(of_ring.contrast)) < 0.5
    band = max(float(of_ring.error[near_one].max()), 1e-14)
    for quantity, error, why in (
        (
            "soft ring: the better of elastic and rigid shaft, worst error below a contrast of "
            "1e-5",
            np.max(of_ring.better[of_ring.contrast < 0.99e-5]),
            "four digits of stiffness",
        ),
        (
            "chain: the better of elastic and rigid bodies, worst error at any contrast",
            np.nanmax(of_chain.better),
            "four digits of stiffness",
        ),
        (
            f"largest error within the contrast of moduli that a scene may have, {allowed:.0e}",
            of_ring.error[of_ring.contrast >= 0.99 / allowed].max(),
            "four digits of stiffness: every scene that is accepted must be solved right",
        ),
    ):
        page.at_most(
            quantity,
            float(error),
            FOUR_DIGITS,
            why=why,
            source="springs in series",
            measure="identity",
            band=band,
        )
    page.holds(
        "multigrid where it is wrong: reports that it did not converge",
        bool((~of_ring.converged | (of_ring.iterated < FOUR_DIGITS)).all()),
        why="the program takes a direct factor only where it knows that the iteration failed",
        source="its own estimate of the energy error",
    )


def answer(
    page: Page, of_ring: Swept, of_chain: Swept, many_high: float | None, allowed: float
) -> None:
    """State the ratios of moduli that a direct solver and multigrid keep digits at."""

    def inverse(low: float | None) -> float | None:
        return None if low is None else 1.0 / low

    direct = {
        f"{COUNT} bodies of random stiffness": many_high,
        "chain of soft and stiff bodies": of_chain.safe[1],
        "soft ring about a shaft": inverse(of_ring.safe[0]),
    }
    iterated = {
        "chain": of_chain.safe_iterated[1],
        "ring": inverse(of_ring.safe_iterated[0]),
    }

    def least(ends: dict[str, float | None]) -> float:
        known = [end for end in ends.values() if end is not None]
        return rounded([min(known)], 2)[0] if known else math.inf

    page.answer(
        "How different may Young's moduli of bodies that share a load be?",
        "A direct solver is correct to four digits up to a ratio of moduli of "
        f"{formatted(least(direct), 2, '')}, multigrid up to {formatted(least(iterated), 2, '')}; "
        f"drivetrain files allow {formatted(allowed, 2, '')}.",
        [
            *(
                page.value(
                    f"largest ratio, direct, {name}", end, at_least=allowed, by="drivetrain files"
                )
                for name, end in direct.items()
                if end is not None
            ),
            page.value("largest ratio, multigrid, all arrangements", least(iterated)),
            page.value(
                "worst error if very stiff bodies are made rigid",
                float(np.nanmax(of_chain.better)),
                at_most=FOUR_DIGITS,
            ),
        ],
        hero=CHAINS,
        cautions=[
            "Where multigrid does not converge, the program says so and a direct solver takes over."
        ],
    )


def state_limits(
    page: Page, of_ring: Swept, of_chain: Swept, many_high: float | None, allowed: float
) -> None:
    """Answer and limits."""
    low, high = of_ring.safe
    _, chain_high = of_chain.safe
    rigid_low, _ = safe_range(of_chain.contrast, of_chain.rigid, FOUR_DIGITS)
    answer(page, of_ring, of_chain, many_high, allowed)
    page.say(
        "Beyond, round-off of the stiff bodies exceeds the stiffness of the soft ones: the error "
        "grows tenfold a decade. A ring stiffer than the shaft does no harm, however stiff.",
        "Made rigid by elimination, the stiff bodies leave the soft ones right: an error of one "
        f"over the contrast, below 1e-4 from {in_words(rigid_low)} on, where elastic bodies are "
        "still right.",
    )
    program = (
        f"moduli in a scene are limited to a ratio of {allowed:.0e}; a direct solver refuses a "
        "residual above 1e-2"
    )
    lost = of_ring.contrast[of_ring.refused]
    page.limit(
        "direct solver: ring about a shaft",
        RING,
        low=low,
        high=high,
        criterion="error of the compliance below 1e-4",
        beyond="the error grows tenfold a decade; no answer below "
        + (f"{lost.max():.0e}" if len(lost) else "the sweep"),
        program=program,
        remedy="the shaft rigid: right to "
        f"{np.max(of_ring.rigid[of_ring.contrast < (low or 0.0)]):.0e} there",
    )
    limit_iterated(page, RING, of_ring.safe_iterated)
    page.limit(
        "direct solver: chain of soft and stiff bodies",
        CHAIN,
        high=chain_high,
        criterion="error of the compliance below 1e-4",
        beyond="the error grows tenfold a decade; no answer from "
        f"{of_chain.contrast[of_chain.refused].min():.0e} on",
        program=program,
        remedy=f"stiff bodies rigid: below 1e-4 from {in_words(rigid_low)} on",
    )
    limit_iterated(page, CHAIN, of_chain.safe_iterated)
    page.limit(
        "direct solver: random stiffness of many bodies",
        "largest modulus over the least",
        high=many_high,
        criterion="error of the compliance below 1e-4",
        beyond="the error grows tenfold a decade",
        program=program,
        remedy="stiff bodies rigid",
    )


ITERATED = {
    RING: (
        "multigrid: ring about a shaft",
        "the preconditioner is no longer positive in round-off: no convergence",
        "direct factor; further down, the shaft rigid",
    ),
    CHAIN: (
        "multigrid: chain of soft and stiff bodies",
        "no convergence: stiff bodies move rigidly against each other in one aggregate",
        "direct factor; further up, stiff bodies rigid",
    ),
}


def limit_iterated(page: Page, parameter: str, safe: tuple[float | None, float | None]) -> None:
    """State the range of one contrast with multigrid."""
    method, beyond, remedy = ITERATED[parameter]
    page.limit(
        method,
        parameter,
        low=safe[0] if parameter == RING else None,
        high=safe[1],
        criterion="converged, and error below 1e-4",
        beyond=beyond,
        program="says so, and takes a direct factor",
        remedy=remedy,
    )


def show(page: Page, of_ring: Swept, of_chain: Swept, ratios: Floats, many: Floats) -> None:
    """Charts of the errors, iterations on the chain."""
    page.section("A ring about a shaft")
    page.text(
        "The ring is held outside, the shaft in it is twisted from its bore; all nodes of a circle "
        "turn equally, so the two are springs in series exactly, on the mesh, too."
    )
    page.chart(
        "Error of the compliance against the stiffness of the ring. Shaded: safe with the direct "
        "solver. Where its curve ends it refuses",
        curves(of_ring, "direct, shaft rigid"),
        RING,
        "relative error",
        "xy",
        of_ring.safe,
    )
    page.section("A chain of soft and stiff bodies")
    page.chart(
        CHAINS,
        [
            *curves(of_chain, "direct, stiff bodies rigid"),
            trace(
                f"direct, random stiffness, worst of {SAMPLES}",
                ratios[np.isfinite(many)],
                np.maximum(many[np.isfinite(many)], 1e-16),
            ),
        ],
        "largest modulus over the least",
        "relative error",
        "xy",
        (None, of_chain.safe[1]),
    )
    rows = zip(
        of_chain.tried, of_chain.iterations, of_chain.converged, of_chain.iterated, strict=True
    )
    page.table(
        "Iterations of multigrid on the chain",
        list(rows),
        ["contrast", "iterations", "converged", "error"],
    )
    page.data("ring", {"contrast": of_ring.contrast, "error": of_ring.error})
    page.data("chain", {"contrast": of_chain.contrast, "error": of_chain.error})


def curves(found: Swept, rigid: str) -> list[Any]:
    """Errors by solver, and with stiff bodies rigid."""
    answered, converged = ~found.refused, found.converged
    error, iterated = np.maximum(found.error, 1e-16), np.maximum(found.iterated, 1e-16)
    return [
        trace("direct", found.contrast[answered], error[answered]),
        trace("multigrid, converged", found.tried[converged], iterated[converged], True),
        crosses("multigrid, not converged", found.tried[~converged], found.iterated[~converged]),
        trace(rigid, found.contrast, np.maximum(found.rigid, 1e-16), line={"dash": "dash"}),
    ]
