"""Tolerances of printed numbers and of round-off."""

import numpy as np
import pytest

from fe_drivetrain.comparison.tolerances import as_printed, digit, round_off
from fe_drivetrain.report.suite.page import Page


@pytest.mark.parametrize(
    ("printed", "unit"), [("3.69e7", 1e5), ("145.6", 0.1), ("1411", 1.0), ("2.45e4", 1e2)]
)
def test_the_last_digit_is_that_which_is_printed(printed: str, unit: float) -> None:
    assert digit(printed) == pytest.approx(unit)


@pytest.mark.parametrize(("computed", "passed"), [(2.8864, True), (2.8866, False)])
def test_what_rounds_to_the_printed_number_passes(computed: float, passed: bool) -> None:
    page = Page()
    page.equals("share [%]", computed, **as_printed("2.886"), source="s")
    assert page.checks[0].passed == passed


def test_a_sum_of_a_thousand_terms_is_within_a_thousand_roundings() -> None:
    terms = np.random.default_rng(0).uniform(1.0, 2.0, 1000)
    backwards = sum(reversed(terms.tolist())) / sum(terms.tolist()) - 1.0
    assert abs(backwards) <= round_off(1000, "a sum")["within"] < 1e-12
