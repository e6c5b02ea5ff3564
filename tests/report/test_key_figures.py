"""Key figures in units that people use."""

import pytest

from fe_drivetrain.report.suite import Page


def page_with(unit: str, value: float) -> Page:
    page = Page()
    why = {"why": "digits", "source": "closed form"}
    page.equals(f"k [{unit}]", value, 2.0 * value, within=0.5, band=0.1 * value, **why)
    return page


@pytest.mark.parametrize(
    ("unit", "value", "shown", "number"),
    [
        ("N/m", 3.2e10, "GN/m", 32.0),
        ("N m/rad", 4e8, "MN m/rad", 400.0),
        ("m", 0.002, "mm", 2.0),
        ("Pa", 5e6, "MPa", 5.0),
        ("mm", 0.25, "µm", 250.0),
        ("kN", 1500.0, "MN", 1.5),
        ("", 0.031, "%", 3.1),
    ],
)
def test_a_key_figure_is_shown_in_another_unit(
    unit: str, value: float, shown: str, number: float
) -> None:
    figure = page_with(unit, value).judged("k", unit=shown)
    expected = pytest.approx([number, 0.1 * number, 2.0 * number, number])
    assert [figure.value, figure.band, figure.limit, figure.allowed] == expected
    assert figure.unit == shown


@pytest.mark.parametrize(("unit", "shown"), [("N/m", "N m"), ("", "mm"), ("mm", "%"), ("Hz", "s")])
def test_a_unit_of_something_else_is_none(unit: str, shown: str) -> None:
    with pytest.raises(ValueError, match="cannot be shown"):
        page_with(unit, 1.0).judged("k", unit=shown)
