"""Catalogue of design loads, and tables of interface loads in equilibrium."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.cases.procedure import assumed
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_text, parse_scene
from fe_drivetrain.procedure.failure_modes import (
    parse_catalogue,
    protest_catalogue,
    read_catalogue,
)
from fe_drivetrain.procedure.interface_loads import (
    LoadTable,
    analysed,
    check_equilibrium,
    imbalance,
    read_load_json,
    write_load_csv,
    write_load_json,
)
from fe_drivetrain.procedure.three_points import three_point_loads, three_points_of

PLACES = replace(assumed.PLACES, ratio=95.0)


@pytest.fixture(scope="module")
def table() -> LoadTable:
    time = np.arange(50) * 0.1
    rng = np.random.default_rng(1)
    size = np.array([200e3, 50e3, 80e3, 700e3, 500e3, 500e3])
    mean = np.array([250e3, 0.0, -400e3, 800e3, 0.0, 0.0])
    return three_point_loads(PLACES, time, mean + size * rng.standard_normal((50, 6)))


def test_only_misalignment_resonance_and_voltage_dips_are_not_covered() -> None:
    found = protest_catalogue()
    assert [load.name for load in found.uncovered] == [
        "misalignment in the drivetrain",
        "low voltage ride through",
        "resonance",
    ]
    assert all(load.remedy for load in found.uncovered)
    assert len(found.of("gearbox")) == 12
    assert {load.table for load in found.of("drivetrain")} == {"4.4"}
    with pytest.raises(InputError, match="no system"):
        found.of("tower")


def test_load_cases_have_a_standard_and_an_edition() -> None:
    cases = [case for load in protest_catalogue().design_loads for case in load.cases]
    assert len(cases) == 8
    assert all(case.standard and case.edition and case.number for case in cases)


ROW = "{name: a, system: s, part: general, table: '1', kinds: [fatigue], covered: 'yes'}"


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (ROW.replace("'yes'", "'no'"), "no remedy"),
        (ROW.replace("system: s", "system: t"), "breakdown"),
        (ROW.replace("fatigue", "rust"), "kinds"),
        (f"{ROW}, {ROW}", "two design loads"),
    ],
)
def test_faults_of_a_catalogue_are_sentences(row: str, words: str, tmp_path: Path) -> None:
    text = f"title: mine\ncomponents: {{s: [p]}}\ndesign_loads: [{row}]\n"
    with pytest.raises(InputError, match=words):
        parse_catalogue(text)
    path = tmp_path / "mine.yaml"
    path.write_text(text.replace(row, ROW))
    assert read_catalogue(path).of("s")[0].name == "a"


def test_every_body_is_in_equilibrium_in_every_row(table: LoadTable) -> None:
    check_equilibrium(table)
    # all bodies together: the supports carry hub loads and weights
    total = sum(p.loads[:, :3] for p in table.interfaces if p.of == "ground")
    weights = sum(body.own[:3] for body in table.bodies)
    assert np.abs(total + weights).max() < 1e-6


@pytest.mark.parametrize("ratio", [95.0, -95.0])
def test_torque_arms_carry_the_difference_of_both_shafts(ratio: float, table: LoadTable) -> None:
    hub = table.interface("hub").loads
    found = three_point_loads(replace(PLACES, ratio=ratio), table.time, hub)
    check_equilibrium(found)
    torque = hub[:, 3]
    entrance = found.interface("gearbox entrance").loads[:, 3]
    assert entrance == pytest.approx(torque)
    left, right = (found.interface(name).loads[:, 2] for name in ("left arm", "right arm"))
    housing = 0.5 * PLACES.between_arms * (left - right)
    assert housing == pytest.approx(-torque * (1.0 - 1.0 / ratio))


def test_a_wrong_sign_is_found_in_its_row(table: LoadTable) -> None:
    loads = table.interface("left arm").loads.copy()
    loads[7, 2] *= -1.0
    parts = tuple(replace(p, loads=loads) if p.name == "left arm" else p for p in table.interfaces)
    wrong = replace(table, interfaces=parts)
    assert np.flatnonzero(np.abs(imbalance(wrong, "gearbox")).max(axis=1) > 1e-9).tolist() == [7]
    with pytest.raises(InputError, match=r"'gearbox' is not in equilibrium: at 0\.7 s Fz"):
        check_equilibrium(wrong)


def test_tables_come_back_as_they_were(table: LoadTable, tmp_path: Path) -> None:
    write_load_json(table, tmp_path / "a.json")
    back = read_load_json(tmp_path / "a.json")
    check_equilibrium(back)
    for one, two in zip(table.interfaces, back.interfaces, strict=True):
        assert (one.loads == two.loads).all()
        assert one.displacements is two.displacements is None
    write_load_csv(table, tmp_path / "a.csv")
    with (tmp_path / "a.csv").open() as file:
        rows = list(csv.reader(file))
    assert rows[0][15] == "gearbox entrance Fz [N]"
    assert np.array(rows[1:], dtype=float)[:, 15] == pytest.approx(
        table.interface("gearbox entrance").loads[:, 2], rel=0, abs=0
    )
    for wrong in ("{}", "[" * 10**5):
        (tmp_path / "b.json").write_text(wrong)
        with pytest.raises(InputError, match="cannot read a load table"):
            read_load_json(tmp_path / "b.json")


def test_analysis_scales_with_the_loads_and_its_durations_sum_to_the_whole(
    table: LoadTable,
) -> None:
    rows = analysed(table)
    assert len(rows) == 42
    doubled = replace(
        table, interfaces=tuple(replace(p, loads=2 * p.loads) for p in table.interfaces)
    )
    for one, two in zip(rows, analysed(doubled), strict=True):
        assert sum(one["seconds"]) == pytest.approx(5.0)
        assert two["equivalent, m 4"] == pytest.approx(2 * one["equivalent, m 4"])
        assert two["mean"] == pytest.approx(2 * one["mean"])


def test_faults_of_a_table_are_sentences(table: LoadTable) -> None:
    hub, *rest = table.interfaces
    for parts, words in (
        ((hub, hub), "called 'hub'"),
        ((replace(hub, on="tower"),), "no body"),
        ((replace(hub, loads=hub.loads[:3]), *rest), "50 rows"),
    ):
        with pytest.raises(InputError, match=words):
            replace(table, interfaces=parts)
    with pytest.raises(InputError, match="no interface"):
        table.interface("brake")


#: The library's drivetrain with a generator that has a mass, and stands on springs.
STANDING = (
    library_text("grc_750kw")
    .replace("generator: {inertia: 24", "generator: {mass: 4200, inertia: 24")
    .replace(
        "  bearings:\n",
        "  bearings:\n"
        "    - {name: feet, holds: generator, stiffness: [5e7, 5e7, 5e7, 0, 5e7, 5e7]}\n",
    )
)


def test_three_points_are_those_of_the_file() -> None:
    """Places by hand: the last shaft begins behind three others, beside two centre distances."""
    scene = parse_scene(STANDING)
    places = three_points_of(scene, 1.6)
    assert (places.hub, places.bearing, places.entrance) == (-0.644, 0.0, pytest.approx(1.698))
    assert places.arms == places.entrance == places.gearbox_centre
    assert places.output == pytest.approx(1.698 + 0.6 + 0.4)
    assert places.generator - places.output == pytest.approx(0.6)
    assert places.offset == pytest.approx(0.450 + 0.285 * np.cos(np.radians(60)))
    lengths, diameters = np.array([0.117, 1.054, 1.171]), np.array([0.677, 0.387, 0.29])
    volumes = np.pi / 4 * diameters**2 * lengths
    density = scene.material_of("shaft").density
    assert places.shaft_mass == pytest.approx(density * volumes.sum(), rel=1e-12)
    middles = np.cumsum(lengths) - lengths / 2
    centre = -0.644 + volumes @ middles / volumes.sum()
    assert places.shaft_centre == pytest.approx(centre, rel=1e-12)
    assert places.gearbox_mass == pytest.approx(59000 / 9.80665, rel=1e-3)
    assert places.generator_mass == 4.2e3
    assert places.ratio == pytest.approx((1 + 99 / 21) * 82 / 23 * 88 / 22, rel=1e-12)
    check_equilibrium(
        three_point_loads(
            places, np.array([0.0]), np.array([[250e3, 0.0, -122e3, 325e3, 4e4, 1e4]])
        )
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (library_text("grc_750kw"), "does not state generator.mass"),
        (STANDING.replace("  weight: 59000\n", ""), "does not state gearbox.weight"),
        (library_text("nrel_5mw"), "has 2 main bearings"),
    ],
)
def test_what_three_points_need_is_asked_for(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        three_points_of(parse_scene(text), 2.0)
