"""Bearings by a catalogue's page: designations, faults, and insides that fit."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import yaml

from fe_drivetrain.bearing.bearing_file import SCHEMA_FILE, bearing_schema, starting_bearings
from fe_drivetrain.bearing.catalogue import fitted_entry, read_bearing_catalogue
from fe_drivetrain.bearing.catalogue_page import CataloguePage
from fe_drivetrain.bearing.designations import read_designation
from fe_drivetrain.bearing.fitted_rollers import RATED, fitted_rollers, lattice
from fe_drivetrain.bearing.rating import ball_dynamic_rating, ratings
from fe_drivetrain.bearing_life.life.rated import page_factors, rated_entry
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import PlainLoader

ROOT = Path(__file__).parents[2]
SPHERICAL: dict[str, Any] = {
    "designation": "240/600",
    "C": 8.15e6,
    "C0": 17e6,
    "Cu": 1.1e6,
    "e": 0.3,
    "Y1": 2.3,
    "Y2": 3.4,
    "Y0": 2.2,
}
CYLINDRICAL: dict[str, Any] = {"designation": "NU 2220", "C": 3.8e5, "C0": 4.5e5, "Cu": 5.4e4}
TAPERED: dict[str, Any] = {
    "designation": "32222",
    "C": 4.02e5,
    "C0": 5.7e5,
    "Cu": 6.1e4,
    "e": 0.43,
    "Y": 1.4,
    "Y0": 0.8,
}
TWO_ROWS: dict[str, Any] = {"designation": "NN 3030", "C": 3.35e5, "C0": 5.85e5}
BALLS: dict[str, Any] = {"designation": "6309", "C": 5.53e4, "C0": 3.15e4, "f0": 13}


def page_of(data: dict[str, Any], **more: Any) -> CataloguePage:
    return CataloguePage.read({**data, **more}, "mine")


@pytest.mark.parametrize(
    ("text", "kind", "sizes"),
    [
        # as SKF's general catalogue prints them
        ("240/600 ECA/W33", "spherical_roller", (600, 870, 272)),
        ("23284 CA", "spherical_roller", (420, 760, 272)),
        ("22330 CC/W33", "spherical_roller", (150, 320, 108)),
        ("NU 2220 ECP", "cylindrical", (100, 180, 46)),
        ("NJ322", "cylindrical", (110, 240, 50)),
        ("NU 1022 ML", "cylindrical", (110, 170, 28)),
        ("32222 J2", "single_row_tapered", (110, 200, 56)),
        ("32032 X", "single_row_tapered", (160, 240, 51)),
        ("31326 XJ2", "single_row_tapered", (130, 280, 72)),
        ("6309", "ball", (45, 100, 25)),
        ("61806", "ball", (30, 42, 7)),
        ("16014-2Z", "ball", (70, 110, 13)),
        # as APB and NSK do
        ("NCF 1892 V", "cylindrical", (460, 580, 56)),
        ("NNU 4930", "cylindrical", (150, 210, 60)),
    ],
)
def test_designations_have_the_sizes_that_catalogues_print(
    text: str, kind: str, sizes: tuple[float, float, float]
) -> None:
    found = read_designation(text)
    assert found.kind == kind
    assert found.sizes is not None
    assert tuple(found.sizes) == tuple(size / 1000.0 for size in sizes)


def test_series_grow_with_their_bore_and_with_their_width_number() -> None:
    file = files("fe_drivetrain.bearing").joinpath("dimension_series.yaml")
    for name, table in yaml.safe_load(file.read_text("utf-8")).items():
        rows = [
            [np.nan if cell == "-" else float(cell) for cell in line.split()]
            for line in table["rows"].splitlines()
        ]
        cells = np.array(rows)
        assert cells.shape[1] == len(table["columns"]), name
        assert np.all(np.diff(cells[:, 0]) > 0.0), name
        assert np.all(np.diff(cells[:, 1]) > 0.0), name
        for column in cells.T[2:]:
            known = column[~np.isnan(column)]
            assert np.all(np.diff(known) >= 0.0), name
        if not name.startswith("tapered"):
            for row in cells:
                widths = row[2:][~np.isnan(row[2:])]
                assert np.all(np.diff(widths) > 0.0), (name, row)


@pytest.mark.parametrize("text", ["foo", "NU", "12345678", "240/6", "N 2"])
def test_words_that_are_no_designation_are_refused_with_examples(text: str) -> None:
    with pytest.raises(InputError, match="NU 2220"):
        read_designation(text)


def test_all_faults_of_a_page_are_in_one_message() -> None:
    with pytest.raises(InputError) as caught:
        page_of(SPHERICAL, C=8150, Y1=4, wdith=3, elements=2)
    for word in ("4 faults", "'wdith'", "elements is 2", "ratings are in N", "e is 0.3 and Y1 4"):
        assert word in str(caught.value)


def test_a_size_that_no_table_has_asks_for_what_is_missing_alone() -> None:
    with pytest.raises(InputError, match=r"D, B of this size stand in no table here: give D and B"):
        page_of(SPHERICAL, designation="240/615")
    own = page_of(SPHERICAL, designation="240/615", D=0.88, B=0.275)
    assert tuple(own.sizes) == (0.615, 0.88, 0.275)


@pytest.mark.parametrize("data", [SPHERICAL, CYLINDRICAL, TAPERED, TWO_ROWS])
def test_insides_have_the_static_rating_and_angle_of_the_page(data: dict[str, Any]) -> None:
    page = page_of(data)
    fit = fitted_rollers(page, 16)
    rows = fitted_entry(page, 0, fit).bearing("mine").rows
    assert len(rows) == (2 if data in (SPHERICAL, TWO_ROWS) else 1)
    b_m = 1.15 if page.of_kind == "spherical_roller" else 1.1
    for k in range(len(fit)):
        found = ratings(fitted_entry(page, k, fit).bearing("mine"), b_m)
        assert found.static == pytest.approx(page.C0, rel=1e-9)
        assert RATED[0] <= page.C / found.dynamic <= RATED[1]
        assert found.dynamic / page.C == pytest.approx(fit.rated[k], rel=1e-9)
        assert 1.5 * np.tan(np.radians(fit.angle_deg[k])) == pytest.approx(
            page.e or 0.0, abs=0.0051
        )


def test_balls_have_the_ratings_of_the_page() -> None:
    page = page_of(BALLS)
    fit = fitted_rollers(page, 16)
    for k in range(len(fit)):
        static = fit.elements[k] * (1e3 * fit.diameter[k]) ** 2
        assert page.C0 / static == pytest.approx(13.0, abs=0.5)
        dynamic = ball_dynamic_rating(fitted_entry(page, k, fit).bearing("mine"))
        assert dynamic / page.C == pytest.approx(fit.rated[k], rel=1e-9)


def test_more_insides_begin_with_the_same() -> None:
    few, many = fitted_rollers(page_of(CYLINDRICAL), 8), fitted_rollers(page_of(CYLINDRICAL), 40)
    assert len(few) == 8
    for name in ("elements", "diameter", "length", "pitch", "crown"):
        assert np.array_equal(getattr(few, name), getattr(many, name)[:8])


def test_lattice_fills_each_half_of_the_cube_evenly() -> None:
    points = lattice(1000, 7)
    assert np.abs((points < 0.5).sum(axis=0) - 500).max() <= 5


def test_what_is_known_of_the_inside_holds_for_all_members() -> None:
    fit = fitted_rollers(page_of(CYLINDRICAL, F=0.119, E=0.163, elements=17), 8)
    assert set(fit.elements) == {17.0}
    assert fit.diameter == pytest.approx(0.022)  # (E - F) / 2
    assert fit.pitch == pytest.approx(0.141)  # (E + F) / 2


def test_a_page_that_no_inside_fits_names_the_condition() -> None:
    with pytest.raises(InputError, match=r"no inside fits .* length of a roller over the width"):
        fitted_rollers(page_of(CYLINDRICAL, C0=9e5))


def test_equivalent_loads_are_those_of_the_page_whatever_the_inside() -> None:
    page = page_of(TAPERED)
    factors = page_factors(page)
    assert factors is not None
    assert (factors.e, factors.above, factors.static) == (0.43, (0.4, 1.4), (0.5, 0.8))
    fit, load = fitted_rollers(page, 8), np.array([[3e4, 0.0, -4e4, 0.0, 0.0]])
    for k in range(len(fit)):
        rated = rated_entry(fitted_entry(page, k, fit), "mine")
        assert rated.equivalent_load(load)[0] == pytest.approx(0.4 * 4e4 + 1.4 * 3e4)
        assert rated.three == (4.02e5, 5.7e5, 6.1e4)
        assert rated.pitch_diameter == 0.155  # mean of bore and outside diameter


def test_factors_that_are_left_out_are_those_of_the_angle() -> None:
    page = page_of(TAPERED, Y=None, Y0=None)
    factors = page_factors(page)
    assert factors is not None
    assert page.angle is not None
    cot = 1.0 / np.tan(np.radians(page.angle))
    assert factors.above == pytest.approx((0.4, 0.4 * cot))  # ISO 281
    assert factors.static == pytest.approx((0.5, 0.22 * cot))  # ISO 76
    assert page_factors(page_of(CYLINDRICAL)) is None


def test_bearing_file_to_start_from_is_read_and_follows_its_schema(tmp_path: Path) -> None:
    path = tmp_path / "bearings.yaml"
    path.write_text(starting_bearings(), "utf-8")
    known = read_bearing_catalogue(path)
    schema = json.loads(bearing_schema())
    jsonschema.Draft202012Validator.check_schema(schema)
    data = yaml.safe_load(starting_bearings())
    jsonschema.validate(data, schema)
    assert set(data) <= set(known)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"mine": {**data["main_bearing"], "wdith": 1}}, schema)


def test_published_schema_of_bearings_is_that_of_the_program() -> None:
    assert (ROOT / "docs" / SCHEMA_FILE).read_text("utf-8") == bearing_schema()


def test_entries_with_faults_are_listed_together(tmp_path: Path) -> None:
    path = tmp_path / "bearings.yaml"
    pages = {"one": {**CYLINDRICAL, "C": 380}, "two": {**TAPERED, "e": 9}}
    path.write_text(yaml.safe_dump(pages), "utf-8")
    with pytest.raises(InputError, match=r"2 entries with faults: .*one.*two"):
        read_bearing_catalogue(path)


def test_stiffness_and_life_follow_from_the_member_alone() -> None:
    page = page_of(CYLINDRICAL)
    fit = fitted_rollers(page, 4)
    one, other = (rated_entry(fitted_entry(page, k, fit), "mine") for k in (0, 1))
    assert one.bearing != other.bearing
    assert replace(one, bearing=other.bearing) == other


def test_a_known_inside_keeps_its_rollers_and_takes_the_factors_of_its_page(
    tmp_path: Path,
) -> None:
    data = yaml.safe_load(starting_bearings())["known_inside"]
    del data["ratings"], data["sources"]["ratings"]
    data["page"] = {"designation": "NJ 2232", "C": 9.3e5, "C0": 1.2e6}
    path = tmp_path / "bearings.yaml"
    path.write_text(yaml.safe_dump({"mine": data}), "utf-8")
    entry = read_bearing_catalogue(path)["mine"]
    rated = rated_entry(entry, "mine")
    assert not entry.fitted
    assert entry.elements == 16
    assert (rated.dynamic, rated.static) == (9.3e5, 1.2e6)
    assert rated.pitch_diameter == pytest.approx(0.225)
    assert fitted_entry(page_of(CYLINDRICAL)).fitted


def test_a_designation_of_digits_alone_needs_no_quotes() -> None:
    loaded = yaml.load("{designation: 6309, C: 5.53e+4, C0: 3.15e+4}", PlainLoader)
    assert page_of(loaded).designation == "6309"
    with pytest.raises(InputError, match="a truth value has no meaning"):
        page_of(BALLS, designation=True)


def test_ranges_of_ratings_are_told_in_newtons() -> None:
    with pytest.raises(InputError, match=r"must be 2.833e\+05 to 3.4e\+06 N, C0 of 1.7e\+07 N"):
        page_of(SPHERICAL, Cu=1e5)
    with pytest.raises(InputError, match=r"C0 is 1e\+06 N but must be 2.445e\+06 to 4.075e\+07 N"):
        page_of(SPHERICAL, C0=1e6)
