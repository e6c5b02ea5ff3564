"""Tolerances by accuracy grade, and load factors that follow from them."""

import pytest

from fe_drivetrain.cases.references.rated_gears import rated_meshes
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.accuracy import gear_tolerances
from fe_drivetrain.gear.involute import Gear


@pytest.mark.parametrize(
    "mesh",
    [name for name, one in rated_meshes().items() if one.deviations != (0.0, 0.0)],
)
def test_deviations_of_grade_6_are_those_that_kisssoft_prints(mesh: str) -> None:
    """Base pitch with one decimal in um, profile form in whole ones, of the worse gear."""
    rated = rated_meshes()[mesh]
    both = [gear_tolerances(gear, 6) for gear in (rated.pair.first, rated.pair.second)]
    pitch, profile = rated.deviations
    assert max(one.base_pitch for one in both) == pytest.approx(pitch, abs=0.05e-6)
    assert max(one.profile_form for one in both) == pytest.approx(profile, abs=1e-9)


def test_two_grades_more_are_twice_as_much() -> None:
    """Each grade is sqrt(2) of the one before (ISO 1328-1), to whole micrometres."""
    gear = Gear(40, 0.02, 0.3)
    fine, coarse = gear_tolerances(gear, 6), gear_tolerances(gear, 8)
    assert coarse.helix_slope == pytest.approx(2.0 * fine.helix_slope, abs=1.01e-6)
    assert coarse.profile_form == pytest.approx(2.0 * fine.profile_form, abs=1.01e-6)


@pytest.mark.parametrize(
    ("gear", "grade", "words"),
    [
        (Gear(40, 0.02, 0.3), 13, "grade of a gear is 13 but must be 1 to 12"),
        (Gear(40, 0.09, 0.3), 6, "normal module of a gear with an accuracy grade is 90 mm"),
        (Gear(40, 0.02, 1.3), 6, "face width of a gear with an accuracy grade is 1300 mm"),
    ],
)
def test_what_the_standard_does_not_cover_is_refused(gear: Gear, grade: int, words: str) -> None:
    with pytest.raises(InputError, match=words):
        gear_tolerances(gear, grade)
