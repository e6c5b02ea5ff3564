"""Tolerances against formulas of ISO 286-1:1988 and against fits that makers of bearings print."""

from itertools import pairwise
from math import sqrt

import pytest

from fe_drivetrain.bearing.tolerances import (
    bore_limits,
    class_clearance,
    housing_limits,
    outside_limits,
    shaft_limits,
)
from fe_drivetrain.common.errors import InputError

STEPS = [3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630, 800, 1000, 1250]
PAIRS = list(pairwise(STEPS))


def microns(values: tuple[float, float]) -> tuple[int, int]:
    return round(1e6 * values[0]), round(1e6 * values[1])


@pytest.mark.parametrize(("low", "high"), PAIRS)
def test_widths_are_multiples_of_the_tolerance_unit(low: int, high: int) -> None:
    """IT5 to IT9 are 7, 10, 16, 25 and 40 units of the step's geometric mean, rounded (annex A)."""
    D = sqrt(low * high)
    unit = 0.45 * D ** (1 / 3) + 0.001 * D if high <= 500 else 0.004 * D + 2.1
    for grade, factor in ((6, 10), (7, 16), (8, 25), (9, 40)):
        width = 1e6 * shaft_limits(f"h{grade}", 1e-3 * high).width
        assert width == pytest.approx(factor * unit, rel=0.06, abs=1.0)


@pytest.mark.parametrize(("low", "high"), PAIRS)
def test_fundamental_deviations_follow_the_formulas(low: int, high: int) -> None:
    """e, f, g and n, and of more than 500 mm m, n and p (annex A), before they are rounded."""
    D, at = sqrt(low * high), 1e-3 * high
    for letter, found in (("e", 11 * D**0.41), ("f", 5.5 * D**0.41), ("g", 2.5 * D**0.34)):
        assert -1e6 * shaft_limits(f"{letter}6", at).high == pytest.approx(found, rel=0.06, abs=1.0)
    above = (
        {"n": 5 * D**0.34}
        if high <= 500
        else {"m": 0.024 * D + 12.6, "n": 0.04 * D + 21, "p": 0.072 * D + 37.8}
    )
    for letter, value in above.items():
        assert 1e6 * shaft_limits(f"{letter}6", at).low == pytest.approx(value, rel=0.06, abs=1.0)
    if high <= 500:
        m = 1e6 * (shaft_limits("h7", at).width - shaft_limits("h6", at).width)
        assert 1e6 * shaft_limits("m6", at).low == pytest.approx(m, abs=1.01)


#: Shaft, limit deviations and theoretical interference with a bearing of class Normal [um], as
#: "Shaft tolerances and resultant fits" of a bearing maker prints them (germany-bearing.com s66,
#: loyal.sg s66, scribd 663845152, original-bearing.com s71).
PRINTED = [
    ("n6", 0.1, (23, 45), (23, 65)),
    ("p6", 0.16, (43, 68), (43, 93)),
    ("r6", 0.09, (51, 73), (51, 93)),
    ("r7", 0.15, (65, 105), (65, 130)),
    ("r6", 0.24, (84, 113), (84, 143)),
    ("n6", 0.26, (34, 66), (34, 101)),
    ("f5", 0.06, (-43, -30), (-43, -15)),
    ("g6", 0.2, (-44, -15), (-44, 15)),
    ("h6", 0.045, (-16, 0), (-16, 12)),
    ("h9", 0.07, (-74, 0), (-74, 15)),
]


@pytest.mark.parametrize(("tolerance", "d", "deviations", "interference"), PRINTED)
def test_fits_on_shafts_are_those_that_a_maker_prints(
    tolerance: str, d: float, deviations: tuple[int, int], interference: tuple[int, int]
) -> None:
    shaft, bore = shaft_limits(tolerance, d), bore_limits(d)
    assert microns(shaft) == deviations
    assert microns((shaft.low - bore.high, shaft.high - bore.low)) == interference


#: The same of housings (germany-bearing.com s74): deviations, and interference.
HOUSINGS = [
    ("N6", 0.045, (-28, -12), (1, 28)),
    ("P7", 0.1, (-59, -24), (9, 59)),
    ("N7", 0.14, (-52, -12), (-6, 52)),
    ("P6", 0.17, (-61, -36), (11, 61)),
    ("N6", 0.2, (-51, -22), (-8, 51)),
    ("P7", 0.3, (-88, -36), (1, 88)),
]


@pytest.mark.parametrize(("tolerance", "D", "deviations", "interference"), HOUSINGS)
def test_fits_in_housings_are_those_that_a_maker_prints(
    tolerance: str, D: float, deviations: tuple[int, int], interference: tuple[int, int]
) -> None:
    hole, ring = housing_limits(tolerance, D), outside_limits(D)
    assert microns(hole) == deviations
    assert microns((ring.low - hole.high, ring.high - hole.low)) == interference


def test_large_r_is_that_under_it_in_a_maker_s_table() -> None:
    """r6 + IT6 of 500 to 560 mm is +194 to +238, of 1000 to 1120 mm +316 to +382 (s77)."""
    for d, low, high in ((0.53, 194, 238), (1.1, 316, 382), (0.82, 266, 322), (1.3, 378, 456)):
        r = shaft_limits("r6", d)
        assert microns((r.low + r.width, r.high + r.width)) == (low, high)


def test_each_class_of_clearance_lies_above_the_one_before() -> None:
    for kind, bores in (("ball", (0.02, 0.3)), ("cylindrical", (0.1, 0.95))):
        for bore in bores:
            found = [class_clearance(kind, name, bore) for name in ("C2", "CN", "C3", "C4")]
            assert all(a.low < b.low and a.high < b.high for a, b in pairwise(found))


@pytest.mark.parametrize(
    ("what", "message"),
    [
        (lambda: shaft_limits("q6", 0.1), "tolerance class 'q6'"),
        (lambda: shaft_limits("r6", 2.5), "reaches up to 2000 mm"),
        (lambda: housing_limits("K9", 0.1), "up to grade 8"),
        (lambda: class_clearance("spherical_roller", "CN", 0.5), "up to 400 mm"),
        (lambda: class_clearance("toroidal", "CN", 0.1), "internal_clearance"),
    ],
)
def test_what_no_table_has_is_refused(what, message) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError, match=message):
        what()
