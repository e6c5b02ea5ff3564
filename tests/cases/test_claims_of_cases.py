"""Verdicts on statements of sources turn with what is found."""

from typing import Any

import pytest

from fe_drivetrain.cases.bearing import displacement_drivers
from fe_drivetrain.cases.dynamics import campbell_table
from fe_drivetrain.cases.dynamics.park_words import PERIOD, PUSHED, Range, answer
from fe_drivetrain.report.suite import Page


def drivers(thrust: float, overhanging: float) -> dict[str, Any]:
    return {
        "with thrust": thrust,
        "with radial force": -0.9,
        "with My": 0.95,
        "of these with overhanging moment [%]": overhanging,
        "upwind [%]": 25.0,
    }


@pytest.mark.parametrize(
    ("thrust", "overhanging", "claim"),
    [(0.05, 100.0, "holds"), (0.35, 100.0, "holds in part"), (0.05, 80.0, "holds in part")],
)
def test_drivers_of_displacement(thrust: float, overhanging: float, claim: str) -> None:
    page = Page()
    displacement_drivers.answer(page, drivers(thrust, overhanging))
    assert page.answered is not None
    assert page.answered.claim == claim
    assert ("where the thesis states none" in page.answered.verdict) == (claim != "holds")


@pytest.mark.parametrize(("excess", "claim"), [(0.0, "holds"), (20.0, "does not hold")])
def test_printed_mesh_orders(excess: float, claim: str) -> None:
    page = Page()
    row = {"kind": "planetary", "Table 4.8": "146", "right": 122.0, "drivetrain": "A"}
    counts = {"right": [1, 3, 2, 0], "printed": [1, 3, 1, 0]}
    campbell_table.answer(page, [row | {"stage": "stage 1"}], [excess], counts, 0)
    assert page.answered is not None
    assert page.answered.claim == claim
    assert "drivetrain B" in page.answered.hero


@pytest.mark.parametrize(("nacelle", "claim"), [(0.1, "holds in part"), (20.0, "holds")])
def test_nacelle_against_eccentricity(nacelle: float, claim: str) -> None:
    page = Page()
    page.equals(
        f"torque step, as printed: {PERIOD}", 0.51, 0.51, within=0.01, why="made", source="made"
    )
    steps = [{"meshes": "as printed", PERIOD: period} for period in (0.51, 0.52, 0.41)]
    least = dict.fromkeys(("torsional", "three dimensions"), Range(-1.0, 0.1, -1.2, -0.8))
    answer(page, steps, least, {"sun": 9.0, PUSHED: nacelle})
    assert page.answered is not None
    assert page.answered.claim == claim
