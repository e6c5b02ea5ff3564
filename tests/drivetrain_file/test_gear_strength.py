"""Strength of a stage's gears as a file states it."""

from typing import Any

import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_strength import GearStrength

HARD = {"steel": "case-hardened", "quality": "MQ"}
SOFT = {
    "steel": "through-hardened",
    "contact_limit": 700e6,
    "root_limit": 290e6,
    "yield_strength": 1000e6,
    "brinell": 240,
}
PAIR = {"gear": HARD, "pinion": HARD}


def test_a_quality_or_numbers_give_the_limits() -> None:
    strength = GearStrength(gears={"gear": SOFT, "pinion": {**HARD, "quality": "ME"}})
    assert strength.gears["gear"].limits == (700e6, 290e6)
    assert strength.gears["pinion"].limits == (1650e6, 525e6)


def test_what_is_assumed_is_named_by_gear() -> None:
    given = GearStrength(gears={"gear": {**HARD, "flank_roughness": 6e-6}, "pinion": HARD})
    assumed = {row.name for row in given.assumptions() if row.is_assumed}
    assert "pinion: flank_roughness" in assumed
    assert "gear: flank_roughness" not in assumed
    assert {"contact_safety", "root_safety"} <= assumed


def test_limits_by_quality_are_named_as_unverified() -> None:
    rows = GearStrength(gears={"gear": SOFT, "pinion": HARD}).assumptions()
    limits = {row.name: row for row in rows if row.name.endswith("_limit")}
    assert {name: row.value for name, row in limits.items()} == {
        "pinion: contact_limit": 1500e6,
        "pinion: root_limit": 425e6,
    }
    assert all(row.is_assumed and "unverified" in row.source for row in limits.values())


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ({"gears": {"gear": HARD}}, "has the gears gear but must have ring, planet and sun"),
        ({"gears": {**PAIR, "gear": {"steel": "nitrided"}}}, "gear: .* needs contact_limit and"),
        (
            {"gears": {**PAIR, "gear": {**HARD, "contact_limit": 1e9}}},
            "quality MQ and a limit of its own",
        ),
        (
            {"gears": {**PAIR, "gear": {"steel": "through-hardened", "quality": "MQ"}}},
            "depend on its hardness",
        ),
        (
            {"gears": {**PAIR, "gear": {**SOFT, "brinell": None}}},
            "needs its yield_strength in Pa and its hardness",
        ),
        ({"gears": PAIR, "face_load": {"sun_planet": 1.2}}, "its meshes are mesh: name these"),
        ({"gears": PAIR, "application": 0.5}, "application"),
        ({"gears": PAIR, "grade": 13}, "grade"),
    ],
)
def test_a_wrong_strength_is_refused_in_one_sentence(data: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        GearStrength.model_validate(data)
