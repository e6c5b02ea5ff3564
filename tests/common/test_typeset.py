import pytest

from fe_drivetrain.common.typeset import typeset


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("kg m^2", "kg m²"),
        ("N/mm^1.5", "N/mm¹·⁵"),
        ("x^-1", "x⁻¹"),
        ("5% of it", "5\u00a0% of it"),
        ("x^(1/2)", "x¹ᐟ²"),
        ("h^p and h^k of it", "hᵖ and hᵏ of it"),
        ("cells^-1/2, or l^3/3EI", "cells⁻¹ᐟ², or l³/3EI"),
        ("|e|^(n + 1)", "|e|ⁿ⁺¹"),
        ("kN^2/Hz", "kN²/Hz"),
        ("k w w^T over", "k w wᵀ over"),
        ("x^y and a^name", "x^y and a^name"),
        ("L/D = 2e+02", "L/D = 200"),
        ("1.222e+08 N", "1.222\u00a0×\u00a010⁸ N"),
        ("converged to 1e-8", "converged to 10⁻⁸"),
        ("5.4e-07 of it", "5.4\u00a0×\u00a010⁻⁷ of it"),
        ("(3.657 ± 0.016)e7 N", "(3.657 ± 0.016)\u00a0×\u00a010⁷ N"),
        ("200 um of clearance [um], not umbra", "200 µm of clearance [µm], not umbra"),
        ("-8.4 to +2.2 %", "\u22128.4 to +2.2\u00a0%"),
    ],
)
def test_powers_and_signs_are_printed_as_such(text: str, printed: str) -> None:
    assert typeset(text) == printed


@pytest.mark.parametrize(
    "text",
    [
        "--set gearbox.weight=4e5",
        "--set x=-2",
        "2026-11-23 03:01 UTC",
        "Eq 4.36-4.37",
        "vm25_1e6",
        "#009e73",
    ],
)
def test_commands_dates_ranges_and_names_stay(text: str) -> None:
    assert typeset(text) == text
