"""What is said of the share of bands that hold."""

import pytest

from fe_drivetrain.cases.verification.bands_over_errors import (
    HOLDS,
    share_that_holds,
    words_of_share,
)
from fe_drivetrain.report.suite import Page, Record


def rows(holding: int, count: int) -> list[Record]:
    return [{HOLDS: k < holding} for k in range(count)]


@pytest.mark.parametrize(
    ("holding", "quick", "judged", "status"),
    [
        (39, False, "97.5\u00a0%: 95\u00a0% are asked for", "good"),
        (36, False, "90\u00a0%: not the 95\u00a0% that are asked for", "bad"),
        (36, True, "90\u00a0%: too few to confirm 95\u00a0%", "none"),
    ],
)
def test_the_share_of_bands_that_hold_is_judged(
    holding: int, quick: bool, judged: str, status: str
) -> None:
    found = rows(holding, 40)
    said = f"{holding} of 40 uncertainty bands contain the true value ({judged})"
    assert words_of_share(found, quick) == said
    figure = share_that_holds(Page(), found, quick)
    assert (figure.value, figure.status) == (pytest.approx(2.5 * holding), status)
