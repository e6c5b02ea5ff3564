"""Numbers that have a noise of their own: how little is left of it, and what is said of it."""

import numpy as np
import pytest

from fe_drivetrain.cases.gear import slices
from fe_drivetrain.cases.life import uncertainty


@pytest.mark.parametrize("ratio", [1.4627260609736992, 1.2, 1.71])
def test_slices_are_in_contact_equally_often_wherever_they_begin(ratio: float) -> None:
    n = slices.even_phases(ratio, 128, 256)
    phases = (np.arange(8 * n) + 0.5) / n  # of eight periods
    begins = np.linspace(2.0, 3.0, 560, endpoint=False)
    counts = [np.count_nonzero((phases >= b) & (phases < b + ratio)) for b in begins]
    # another number of phases gives one more to a good share of the slices
    share_of_most = np.mean(np.array(counts) == np.bincount(counts).argmax())
    assert share_of_most > 0.95
    other = [np.count_nonzero(((p := phases * n / (n + 3)) >= b) & (p < b + ratio)) for b in begins]
    assert np.mean(np.array(other) == np.bincount(other).argmax()) < share_of_most


def rows(*shares: tuple[float, float]) -> list[dict[str, object]]:
    """Shares of the variance and their standard errors [%] of inputs a, b, c, ..."""
    return [
        {
            "input": f"{name} [m]",
            uncertainty.WITH_OTHERS: share,
            uncertainty.TOTAL_ERROR: error,
        }
        for name, (share, error) in zip("abcdef", shares, strict=False)
    ]


@pytest.mark.parametrize(
    ("shares", "words"),
    [
        (((20.0, 3.0), (60.0, 5.0), (10.0, 1.0)), "b decides most, then a"),
        (((55.0, 3.0), (60.0, 5.0), (10.0, 1.0)), "b and a decide most"),
        (
            ((170.0, 900.0), (105.0, 700.0), (1.0, 1.0)),
            "samples are too few to tell which of 3 inputs decides",
        ),
    ],
)
def test_an_input_decides_where_its_share_is_beyond_the_noise(
    shares: tuple[tuple[float, float], ...], words: str
) -> None:
    order, said = uncertainty.deciding(rows(*shares))
    assert said == words
    assert order[0][uncertainty.WITH_OTHERS] == max(share for share, _ in shares)
