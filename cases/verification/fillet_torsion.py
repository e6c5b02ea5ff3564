"""Stress concentration of a shoulder fillet in torsion, against the published fits."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: D/d and r/d of the sweep.
WIDES = (1.1, 1.3, 1.6, 2.0)
RADII = (0.03, 0.05, 0.12, 0.2, 0.3)
#: Those judged one by one: a low, a middle and a high step.
JUDGED = ((1.1, 0.05), (1.6, 0.12), (2.0, 0.2))


def run(run: Run) -> Any:
    """Sweep the step and the fillet."""
    import numpy as np

    from fe_drivetrain.cases.verification import fillets
    from fe_drivetrain.validation import (
        fillet_factors,
    )

    pairs = [(wide, radius) for wide in WIDES for radius in RADII]
    factors = fillets.sweep(run, "torsion", JUDGED if run.quick else pairs)
    published = {
        fillet_factors.PETERSON: (
            fillet_factors.peterson,
            fillet_factors.of_a_fit,
            "the fit of a chart that was computed, not measured (Matthews and Hooke 1971; "
            "recalled, not re-read), within 5 % of it",
        ),
    }
    deviation = 100.0 * fillets.deviations("torsion", factors, fillet_factors.peterson)
    worst = int(np.abs(deviation).argmax())
    f = factors[worst]
    summary = [
        f"Over {len(factors)} shoulders Peterson's fit is {deviation.mean():+.1f} % off the "
        f"finite elements on average and at worst {deviation[worst]:+.1f} % "
        f"(D/d = {f.wide:g}, r/d = {f.radius:g}: K_t = {f.peak.factor:.4f}, band {f.band:.1g}).",
    ]

    return CASE.results(
        run,
        summary=summary,
        verdicts=fillets.verdicts("torsion", factors, published, JUDGED),
        sections=fillets.sections("torsion", factors),
        figures=fillets.figures("torsion", factors),
    )


CASE = Case(
    name="verification/fillet_torsion",
    title="Shoulder fillet of a shaft in torsion: stress concentration",
    source="Pilkey and Pilkey 2008, Peterson's Stress Concentration Factors, chart 3.12",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
