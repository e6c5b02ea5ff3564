"""Stiffness contrast: a soft or stiff ring, a chain of soft and stiff bodies, many at once."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Bodies of the chain.
COUNT = 12
#: Chains of random stiffness at each spread.
SAMPLES = 4


def run(run: Run) -> Any:
    """Sweep the stiffness of some bodies over what others have."""
    import numpy as np

    from fe_drivetrain.cases.stability.decades import (
        FOUR_DIGITS,
        crosses,
        decades,
        safe_range,
        shown,
        slope,
    )
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import Material
    from fe_drivetrain.validation import (
        layers,
    )

    per_decade = 1.0 if run.quick else 3.0
    tolerance = 0.3 if run.quick else 0.15
    iterated_per_decade = 0.25 if run.quick else 0.5

    def errors(answers: list[Any], exact: Any) -> Any:
        return np.abs(np.array([a.compliance for a in answers]) / exact - 1.0)

    with run.step("ring about a shaft"):
        ring = layers.ring()
        compliance_of_ring = layers.direct(*ring.system((1.0, 1.0), rigid=(1,))).compliance
        both = layers.direct(*ring.system((1.0, 1.0))).compliance
        contrasts = decades(-16, 10, per_decade)
        exact = compliance_of_ring / contrasts + (both - compliance_of_ring)
        found = [layers.direct(*ring.system((c, 1.0))) for c in contrasts]
        ring_error = errors(found, exact)
        remedy = [layers.direct(*ring.system((c, 1.0), rigid=(1,))) for c in contrasts]
        ring_remedy = errors(remedy, exact)
        some = decades(-12, 10, iterated_per_decade)
        iterated = [layers.iterated(*ring.system((c, 1.0))) for c in some]
        iterated_error = errors(iterated, compliance_of_ring / some + (both - compliance_of_ring))
        arrived = np.array([a.arrived for a in iterated])
    low, high = safe_range(contrasts, ring_error, FOUR_DIGITS)
    m_low, m_high = safe_range(some, np.where(arrived, iterated_error, np.nan), FOUR_DIGITS)
    soft = contrasts < 1e-4
    ring_slope = slope(contrasts[soft], ring_error[soft], (1e-12, 0.1))
    hybrid = np.fmin(ring_error, ring_remedy)

    with run.step("chain of soft and stiff bodies"):
        chain = layers.chain(COUNT)
        stiffer = decades(0, 18, per_decade)
        stiff = [k for k in range(COUNT) if k % 2]
        moduli = [[c if k in stiff else 1.0 for k in range(COUNT)] for c in stiffer]
        chain_exact = np.array([sum(1.0 / m for m in some_) / layers.E for some_ in moduli])
        chain_error = errors([layers.direct(*chain.system(m)) for m in moduli], chain_exact)
        chain_remedy = errors(
            [layers.direct(*chain.system(m, rigid=stiff)) for m in moduli], chain_exact
        )
        some_stiffer = decades(0, 14, iterated_per_decade)
        some_moduli = [[c if k in stiff else 1.0 for k in range(COUNT)] for c in some_stiffer]
        chain_iterated = [layers.iterated(*chain.system(m)) for m in some_moduli]
        chain_iterated_error = errors(
            chain_iterated, np.array([sum(1.0 / m for m in ms) / layers.E for ms in some_moduli])
        )
        chain_arrived = np.array([a.arrived for a in chain_iterated])
    _, chain_high = safe_range(stiffer, chain_error, FOUR_DIGITS)
    chain_slope = slope(stiffer, chain_error, (1e-11, 0.1))
    rigid_slope = slope(stiffer, chain_remedy, (1e-9, 1e-2))
    rigid_low, _ = safe_range(stiffer, chain_remedy, FOUR_DIGITS)
    _, chain_m_high = safe_range(
        some_stiffer, np.where(chain_arrived, chain_iterated_error, np.nan), FOUR_DIGITS
    )

    with run.step("many contrasts at once"):
        rng = np.random.default_rng(0)
        spreads = np.arange(0.0, 9.1, 1.0 if run.quick else 0.5)
        many_error = []
        for spread in spreads:
            worst = 0.0
            for _ in range(SAMPLES):
                drawn = 10.0 ** rng.uniform(-spread, spread, COUNT)
                drawn[rng.permutation(COUNT)[:2]] = 10.0 ** np.array([-spread, spread])
                answer = layers.direct(*chain.system(list(drawn)))
                error = abs(answer.compliance * layers.E / (1.0 / drawn).sum() - 1.0)
                worst = max(worst, error) if np.isfinite(error) else np.nan
                if np.isnan(worst):
                    break
            many_error.append(worst)
        ratios = 10.0 ** (2.0 * spreads)
    many = np.array(many_error)
    _, many_high = safe_range(ratios, many, FOUR_DIGITS)

    with run.step("what the program does"):
        allowed = _allowed(Material)
        within = float(ring_error[contrasts >= 0.99 / allowed].max())

    band = max(float(ring_error[np.abs(np.log10(contrasts)) < 0.5].max()), 1e-14)
    reason = "round-off scatters by about a decade over the decades of the fit"
    verdicts = [
        judge(
            "soft ring, direct solver: error against the ring's stiffness, exponent",
            ring_slope,
            -1.0,
            tolerance=tolerance,
            source="round-off of the shaft's stiffness acts as springs to ground beside the ring",
            reason=reason,
            measure="order",
            band=tolerance / 2,
        ),
        judge(
            "chain, direct solver: error against the contrast, exponent",
            chain_slope,
            1.0,
            tolerance=tolerance,
            source="the same, for each stiff body between soft ones",
            reason=reason,
            measure="order",
            band=tolerance / 2,
        ),
        judge(
            "chain, stiff bodies rigid: error against the contrast, exponent",
            rigid_slope,
            -1.0,
            tolerance=0.02,
            source="bodies in series: what rigid ones do not give is 1 / contrast",
            reason="exact in the discrete model, too",
            measure="order",
            band=0.01,
        ),
        judge(
            "soft ring: the better of elastic and rigid shaft, worst error below a contrast of "
            "1e-5",
            float(np.max(hybrid[contrasts < 0.99e-5])),
            0.0,
            tolerance=FOUR_DIGITS,
            relative=False,
            source="springs in series",
            reason="four digits of stiffness",
            measure="identity",
            band=band,
        ),
        judge(
            "chain: the better of elastic and rigid bodies, worst error at any contrast",
            float(np.nanmax(np.fmin(chain_error, chain_remedy))),
            0.0,
            tolerance=FOUR_DIGITS,
            relative=False,
            source="springs in series",
            reason="four digits of stiffness",
            measure="identity",
            band=band,
        ),
        judge(
            f"largest error within the contrast of moduli that a scene may have, {allowed:.0e}",
            within,
            0.0,
            tolerance=FOUR_DIGITS,
            relative=False,
            source="springs in series",
            reason="four digits of stiffness: what a scene may say must be solved right",
            measure="identity",
            band=band,
        ),
        judge(
            "multigrid where it is wrong: says that it did not converge",
            float((~arrived | (iterated_error < FOUR_DIGITS)).all()),
            1.0,
            tolerance=0.0,
            source="its own estimate of the energy error",
            reason="yes or no",
            measure="identity",
        ),
    ]
    refused = ~np.isfinite(ring_error)
    chain_refused = ~np.isfinite(chain_error)
    program = (
        f"moduli in a scene are held to a ratio of {allowed:.0e}; a direct solver refuses a "
        "residual above 1e-2"
    )
    limits = [
        Limit(
            method="direct solver: ring about a shaft",
            parameter="modulus of the ring over that of the shaft",
            low=low,
            high=high,
            criterion="error of the compliance below 1e-4",
            beyond="the error grows tenfold a decade; no answer below "
            f"{_largest(contrasts, refused)}",
            program=program,
            remedy="the shaft rigid: right to "
            f"{np.max(ring_remedy[contrasts < (low or 0.0)]):.0e} there",
        ),
        Limit(
            method="multigrid: ring about a shaft",
            parameter="modulus of the ring over that of the shaft",
            low=m_low,
            high=m_high,
            criterion="converged, and error below 1e-4",
            beyond="the preconditioner is no longer positive in round-off: no convergence",
            program="says so, and takes a direct factor",
            remedy="direct factor; further down, the shaft rigid",
        ),
        Limit(
            method="direct solver: chain of soft and stiff bodies",
            parameter="modulus of the stiff bodies over that of the soft ones",
            high=chain_high,
            criterion="error of the compliance below 1e-4",
            beyond="the error grows tenfold a decade; no answer from "
            f"{stiffer[chain_refused].min():.0e} on",
            program=program,
            remedy=f"stiff bodies rigid: below 1e-4 from {shown(rigid_low)} on",
        ),
        Limit(
            method="multigrid: chain of soft and stiff bodies",
            parameter="modulus of the stiff bodies over that of the soft ones",
            high=chain_m_high,
            criterion="converged, and error below 1e-4",
            beyond="no convergence: stiff bodies move rigidly against each other in one aggregate",
            program="says so, and takes a direct factor",
            remedy="direct factor; further up, stiff bodies rigid",
        ),
        Limit(
            method="direct solver: random stiffness of many bodies",
            parameter="largest modulus over the least",
            high=many_high,
            criterion="error of the compliance below 1e-4",
            beyond="the error grows tenfold a decade",
            program=program,
            remedy="stiff bodies rigid",
        ),
    ]
    return CASE.results(
        run,
        summary=[
            f"Four digits of stiffness survive a ring down to {shown(low)} of the shaft's modulus "
            f"with a direct factor and {shown(m_low)} with multigrid, stiff bodies up to "
            f"{shown(chain_high)} and {shown(chain_m_high)} times that of soft ones between them, "
            f"and {COUNT} bodies of random stiffness a ratio of {shown(many_high)}.",
            "Beyond, round-off of what is stiff drowns what is soft: the error grows tenfold a "
            "decade. A ring stiffer than the shaft does no harm, however stiff.",
            "Made rigid by elimination, the stiff bodies leave the soft ones right: an error of "
            f"one over the contrast, below 1e-4 from {shown(rigid_low)} on, where elastic bodies "
            "are still right.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="A ring about a shaft",
                items=[
                    Text(
                        text="The ring is held outside, the shaft in it is twisted from its bore; "
                        "all nodes of a circle turn alike, so the two are springs in series "
                        "exactly, on the mesh, too."
                    ),
                    chart(
                        "Error of the compliance against the stiffness of the ring. Shaded: safe "
                        "with the direct solver. Where its curve ends it refuses",
                        [
                            trace("direct", contrasts[~refused], ring_error[~refused]),
                            trace(
                                "multigrid, converged", some[arrived], iterated_error[arrived], True
                            ),
                            crosses(
                                "multigrid, not converged", some[~arrived], iterated_error[~arrived]
                            ),
                            trace(
                                "direct, shaft rigid",
                                contrasts,
                                np.maximum(ring_remedy, 1e-16),
                                line={"dash": "dash"},
                            ),
                        ],
                        "modulus of the ring over that of the shaft",
                        "relative error",
                        ("x", "y"),
                        (low, high),
                    ),
                ],
            ),
            Section(
                title="A chain of soft and stiff bodies",
                items=[
                    chart(
                        f"Error of the compliance of {COUNT} bodies in a row, every other one "
                        "stiff, and of as many of random stiffness. Shaded: safe with the direct "
                        "solver and elastic bodies, every other one stiff",
                        [
                            trace(
                                "direct",
                                stiffer[~chain_refused],
                                np.maximum(chain_error[~chain_refused], 1e-16),
                            ),
                            trace(
                                "multigrid, converged",
                                some_stiffer[chain_arrived],
                                np.maximum(chain_iterated_error[chain_arrived], 1e-16),
                                True,
                            ),
                            crosses(
                                "multigrid, not converged",
                                some_stiffer[~chain_arrived],
                                chain_iterated_error[~chain_arrived],
                            ),
                            trace(
                                "direct, stiff bodies rigid",
                                stiffer,
                                np.maximum(chain_remedy, 1e-16),
                                line={"dash": "dash"},
                            ),
                            trace(
                                f"direct, random stiffness, worst of {SAMPLES}",
                                ratios[np.isfinite(many)],
                                np.maximum(many[np.isfinite(many)], 1e-16),
                            ),
                        ],
                        "largest modulus over the least",
                        "relative error",
                        ("x", "y"),
                        (None, chain_high),
                    ),
                    Table(
                        caption="Iterations of multigrid on the chain",
                        columns=["contrast", "iterations", "converged", "error"],
                        rows=[
                            [float(c), a.iterations, a.arrived, float(e)]
                            for c, a, e in zip(
                                some_stiffer, chain_iterated, chain_iterated_error, strict=True
                            )
                        ],
                    ),
                ],
            ),
        ],
        limits=limits,
        figures={
            "ring": {"contrast": contrasts.tolist(), "error": ring_error.tolist()},
            "chain": {"contrast": stiffer.tolist(), "error": chain_error.tolist()},
        },
    )


def _largest(x: Any, chosen: Any) -> str:
    return f"{x[chosen].max():.0e}" if chosen.any() else "the sweep"


def _allowed(material: Any) -> float:
    """Ratio of the stiffest modulus that a material may have to the softest."""
    import math

    from pydantic import ValidationError

    def valid(exponent: float) -> bool:
        try:
            material(youngs_modulus=10.0**exponent, poisson_ratio=0.3, density=0.0)
        except ValidationError:
            return False
        return True

    # from steel outwards, by halving
    ends = []
    for outside in (-30.0, 40.0):
        inside, bad = math.log10(200e9), outside
        if valid(bad):
            ends.append(bad)
            continue
        for _ in range(40):
            middle = 0.5 * (inside + bad)
            inside, bad = (middle, bad) if valid(middle) else (inside, middle)
        ends.append(inside)
    return float(10.0 ** (ends[1] - ends[0]))


CASE = Case(
    name="stability/stiffness_contrast",
    title="Stiffness contrast: soft and stiff bodies in series, and rigid ones in their place",
    source="springs in series; Higham 2002, Accuracy and stability of numerical algorithms, ch. 10",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
