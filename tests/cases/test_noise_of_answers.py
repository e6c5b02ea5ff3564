"""Numbers that have a noise of their own: how little is left of it, and what is said of it."""

import pytest

from fe_drivetrain.cases.life import uncertainty


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
