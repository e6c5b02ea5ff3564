"""Shares and differences as sentences say them."""

import pytest

from fe_drivetrain.report.number_text import difference_text, percent_text
from fe_drivetrain.report.suite import Page

PERCENT = "\u00a0%"


@pytest.mark.parametrize(
    ("share", "digits", "text"),
    [
        (0.000834, 2, "0.083"),
        (-0.000834, 2, "0.083"),
        (0.0189421, 3, "1.89"),
        (0.208, 2, "21"),
        (-4.4e-6, 2, "4.4\u00a0×\u00a010⁻⁴"),
        (0.0, 2, "0"),
    ],
)
def test_a_share_is_told_in_percent_without_its_sign(share: float, digits: int, text: str) -> None:
    assert percent_text(share, digits) == text + PERCENT


def test_a_difference_is_in_percent_of_the_reference() -> None:
    figure = Page().value("stress [MPa]", -51.66, beside=-51.9)
    assert difference_text(figure) == "0.46" + PERCENT


@pytest.mark.parametrize("limit", [{}, {"at_most": 60.0}, {"beside": 0.0}])
def test_without_a_reference_there_is_no_difference(limit: dict[str, float]) -> None:
    figure = Page().value("stress [MPa]", 51.66, **limit)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="no reference to be compared with"):
        difference_text(figure)
