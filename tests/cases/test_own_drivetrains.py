"""Cases on a user's drivetrain: what they find is right, and what a file lacks is named."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.cases.dynamics import own_sidebands
from fe_drivetrain.cases.dynamics.own_load_sharing import pressed_by, shared
from fe_drivetrain.cases.dynamics.own_torque_step import first_mode, of_step, stepped
from fe_drivetrain.cases.dynamics.park_words import MAXIMUM, MINIMUM
from fe_drivetrain.cases.dynamics.transmission_error import own_teeth
from fe_drivetrain.cases.procedure.known_drivetrain import KNOWN, Known, known_of
from fe_drivetrain.cases.procedure.measurement_cases import fitted
from fe_drivetrain.cases.procedure.own_three_points import own_three_points
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.reading import scene_text
from fe_drivetrain.dynamics import (
    Level,
    assemble,
    bodies_of,
    library_machine,
    machine_system,
    planetary_set,
    springs_of,
    static,
)
from fe_drivetrain.dynamics.bodies.bodies import Body
from fe_drivetrain.dynamics.torsion import damped_modes
from fe_drivetrain.procedure import (
    driven_motions,
    element_torques,
    protest_measurement_cases,
    write_channels,
)
from fe_drivetrain.report.suite.case import all_cases
from fe_drivetrain.report.suite.chosen import chosen_drivetrain
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run

OWN = """
title: Turbine of a user
rotor: {inertia: 5.0e5}
shaft: {name: slow, torsion: 3.0e7}
gearbox:
  stages:
    - {kind: parallel, ratio: 20, stiffness_of: axis, gear: {inertia: 20}, pinion: {inertia: 0.3},
       stiffness: 5.0e10}
  shafts:
    - {name: quick, torsion: 2.0e6}
generator: {inertia: 30}
operation: {rated_power: 7.5e5, rotor_speed: [1.0, 2.3]}
damping: {shafts: 0.02, meshes: 0.1}
"""
STOP = 1.1  # s


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("own") / "mine.yaml"
    file.write_text(OWN, "utf-8")
    return file


@pytest.fixture(scope="module")
def known(own: Path) -> Known:
    return known_of(Page(), chosen_drivetrain(str(own), "nrel_750kw"))


@pytest.fixture(scope="module")
def record(own: Path, known: Known) -> Path:
    """A stop, recorded in other units than those of the program, referred to each end's shaft."""
    step = 2e-3
    time = np.arange(5000) * step
    torque = np.interp(time, [0.0, STOP - 0.02, STOP], [known.torque, known.torque, 0.0])
    motions = driven_motions(known.system, np.stack([torque, -torque]), step)
    front, rear = (angle + known.speed * time for angle in motions.angle)
    columns = {
        "torque [kN m]": 1e-3 * known.gear * element_torques(known.system, motions)[0],
        "front [rad]": front / known.gear,
        "rear [deg]": np.degrees(rear),
    }
    write_channels(own.parent / "stop.csv", step, columns)
    return own.parent / "stop.csv"


ROLLING = {
    "gearbox.stages.0.pins.0.catalogue": "planet_nj2232",
    "gearbox.stages.0.pins.1.catalogue": "planet_nj2232",
    "gearbox.bearings.8.catalogue": "tapered_pair_32222",
}


def ran(name: str, tmp_path: Path, **settings: object) -> Page:
    page = Page()
    all_cases()[name].run(Run(settings, True, tmp_path), page)
    return page


def key_figures(page: Page) -> dict[str, float]:
    assert page.answered is not None
    return {figure.name: figure.value for figure in page.answered.figures}


def test_two_inertias_are_those_of_the_file(known: Known) -> None:
    n = 20.0
    assert known.gear == pytest.approx(n)
    assert known.torque == pytest.approx(7.5e5 / 2.3 / n)
    assert known.stiffness * n**2 == pytest.approx(1.0 / (1.0 / 3.0e7 + 1.0 / (2.0e6 * n**2)))
    assert known.front * n**2 == pytest.approx(5.0e5)
    assert known.ratio == 0.02
    assert damped_modes(known.system).ratios[0] == pytest.approx(0.02)
    assert KNOWN.slower == KNOWN.stronger == 1.0


def test_a_users_own_record_gives_back_stiffness_and_damping(
    own: Path, known: Known, record: Path, tmp_path: Path
) -> None:
    page = ran(
        "procedure/identification",
        tmp_path,
        drivetrain=str(own),
        measured=str(record),
        stop=STOP + 0.02,
    )
    found = key_figures(page)
    assert found["stiffness"] == pytest.approx(known.stiffness * known.gear**2, rel=1e-5)
    assert found["damping"] == pytest.approx(known.damping * known.gear**2, rel=1e-3)
    assert found["damping ratio by the decrement"] == pytest.approx(2.0, rel=0.01)
    assert found["frequency of the decay"] == pytest.approx(known.omega / (2 * np.pi), rel=1e-3)
    assert found["lowest damping by methods A to C"] != pytest.approx(found["damping"], rel=0.1)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"measured": "x.csv"}, "name it, as in drivetrain=mine.yaml"),
        ({"stop": 3}, "name it, as in drivetrain=mine.yaml"),
        ({"drivetrain": "OWN", "measured": 3}, "measured = 3 must be a file"),
        ({"drivetrain": "OWN", "measured": "x.csv"}, "there is no file x.csv"),
        ({"drivetrain": "OWN", "measured": "RECORD", "rear_column": "back"}, "no column 'back'"),
        ({"drivetrain": "OWN", "measured": "RECORD", "torque_column": "rear"}, "rad, not in N m"),
        ({"drivetrain": "OWN", "measured": "RECORD", "shaft": 3}, "has 2: count from the rotor"),
        ({"drivetrain": "OWN", "measured": "RECORD", "stop": 9.999}, "is at the end of a record"),
    ],
)
def test_a_record_that_cannot_be_taken_is_refused(
    settings: dict[str, object], message: str, own: Path, record: Path, tmp_path: Path
) -> None:
    files = {"OWN": str(own), "RECORD": str(record)}
    given = {key: files.get(str(value), value) for key, value in settings.items()}
    with pytest.raises(InputError, match=message):
        ran("procedure/identification", tmp_path, **given)


def test_scripts_of_measurement_cases_have_a_users_speeds(known: Known) -> None:
    cases = protest_measurement_cases()
    own = fitted(cases.of("STB"), known)
    assert own.speed(np.array([5.0]))[0] == pytest.approx(known.speed)
    assert own.torque(np.array([5.0]))[0] == 1.0
    assert not [one.title for one in cases.cases if re.search(r"\d", fitted(one, known).title)]


def test_a_pin_out_of_place_presses_as_much_as_a_planet_between_bodies_that_stand() -> None:
    machine, error = library_machine("park_2021"), 20e-6
    stage = machine.stages[0]
    assert isinstance(stage, PlanetaryData)
    built = planetary_set(machine, 1)
    held = [
        body if "planet" in body.name else Body(body.name, body.position, free=frozenset())
        for body in bodies_of(built)
    ]
    system = assemble(held, springs_of(built))
    found = static(system, np.zeros(len(system.names)), {"stage 1 pin 1 uz": error})
    for mesh in ("stage 1 sun-planet 1", "stage 1 ring-planet 1"):
        assert found.force(mesh) == pytest.approx(pressed_by(stage, error), rel=1e-9)


def test_planets_of_a_whole_drivetrain_share_an_error_within_the_closed_forms() -> None:
    found = shared(library_machine("park_2021"), 15e3, 20e-6)
    assert abs(found.change.sum()) < 1e-6 * np.abs(found.change).max()
    assert 0.0 < found.change[0] < found.fixed
    assert found.floating == 0.0
    # at that share of the torque one planet carries nothing
    assert (found.parts * found.rated + found.change).min() == pytest.approx(0.0, abs=1e-6)
    assert found.sharing(1e6) == pytest.approx(found.rated.max() / found.rated.mean(), rel=1e-4)


@pytest.mark.parametrize(
    ("name", "drivetrain"),
    [
        ("dynamics/carrier_travels", "synthetic_2mw"),
        ("dynamics/elastic_ring", "nrel_750kw"),
        ("dynamics/load_sharing", "synthetic_2mw"),
        ("dynamics/bearing_matrices", "ROLLING"),
        ("dynamics/planet_bearings", "grc_750kw"),
        ("dynamics/sun_spline", "synthetic_2mw"),
    ],
)
def test_a_case_answers_for_another_whole_drivetrain(
    name: str, drivetrain: str, tmp_path: Path
) -> None:
    file = tmp_path / "rolling.yaml"
    file.write_text(scene_text(read_drivetrain("synthetic_2mw", ROLLING)), "utf-8")
    page = ran(name, tmp_path, drivetrain=str(file) if drivetrain == "ROLLING" else drivetrain)
    assert page.checks
    assert all(check.passed for check in page.checks)
    assert page.answered is not None
    assert "thesis" not in page.answered.model_dump_json()


def test_sidebands_stand_off_by_the_ringing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(own_sidebands, "SWINGS", 10)
    page = Page()
    whole = stepped(page, chosen_drivetrain("nrel_5mw", "park_2021"))
    of = whole.only(1)
    system = machine_system(of.machine, Level.TORSIONAL)
    line = own_sidebands.line_of(of)
    assert line == pytest.approx(
        of.speed * abs(of.machine.meshing[0][1][0]) / (2.0 * np.pi), rel=1e-9
    )
    row, _ = own_sidebands.after_step(page, of, "torsional", system, line)
    assert row[own_sidebands.RINGING] == pytest.approx(first_mode(system), rel=0.05)
    assert all(check.passed for check in page.checks)
    with pytest.raises(InputError, match="has 3: name one"):
        whole.only(4)


def test_a_step_of_torque_on_meshes_that_hardly_vary_brings_twice_the_static_forces() -> None:
    whole = stepped(Page(), chosen_drivetrain("nrel_5mw", "park_2021"))
    even = {name: replace(one, contact_ratio=2.0) for name, one in whole.meshing.items()}
    of = replace(whole, meshing=even)
    system = machine_system(of.machine, Level.TORSIONAL)
    assert of.load(system)[system.place("rotor rx")] == of.torque
    found = of_step(of, system, 1.0 / of.first, 1.0 / (200.0 * of.first), 1)
    assert found.values[MAXIMUM] == pytest.approx(2.0, rel=0.1)
    assert found.values[MINIMUM] == pytest.approx(0.0, abs=0.1)


def test_a_pair_of_a_users_stage_has_its_torque_and_mass(tmp_path: Path) -> None:
    chosen = chosen_drivetrain("nrel_750kw", "")
    machine = library_machine("nrel_750kw")
    teeth, rated = own_teeth(Run({"stage": 2}, True, tmp_path), Page(), chosen)
    stage = machine.stages[1]
    assert isinstance(stage, ParallelData)
    assert teeth.torque == pytest.approx(chosen.rated_torque() / abs(machine.speeds[2]))
    first, second = teeth.pair.first.base_radius, teeth.pair.second.base_radius
    mass = 1.0 / (first**2 / stage.pinion.inertia + second**2 / stage.gear.inertia)
    assert teeth.mass == pytest.approx(mass)
    assert first < second
    deflection = teeth.error(0.0)
    assert teeth.relief == pytest.approx(deflection.force / deflection.stiffness.mean, abs=5.1e-7)
    speed = chosen.rotor_speeds()[1] * abs(machine.speeds[1]) * machine.meshing[1][1][0]
    assert rated == pytest.approx(speed / np.sqrt(deflection.stiffness.mean / mass))
    with pytest.raises(InputError, match="stage = 4, but"):
        own_teeth(Run({"stage": 4}, True, tmp_path), Page(), chosen)


def test_three_points_are_those_of_the_file(tmp_path: Path) -> None:
    settings = {"drivetrain": "grc_750kw", "generator_mass": 4000, "arms": 1.8}
    of = own_three_points(Run(settings, True, tmp_path), Page(), 1e5)
    assert of.places.between_arms == 1.8
    assert of.places.generator_mass == 4000.0
    assert of.mounts.arm[1] == 0.5 * float(of.scene.gearbox.stiffness[1])
    assert of.hub_scale[3] ** (2 / 3) == pytest.approx(of.hub_scale[0])


@pytest.mark.parametrize(
    ("name", "drivetrain", "message"),
    [
        ("dynamics/bearing_matrices", "OWN", r"give gearbox\.bearings or pins a catalogue"),
        ("dynamics/carrier_travels", "OWN", r"give gearbox\.stages\.0\.pins"),
        ("dynamics/elastic_ring", "OWN", "no planetary stage"),
        ("dynamics/load_sharing", "OWN", r"give gearbox\.stages\.0\.pins"),
        ("dynamics/park_time", "OWN", "without teeth|full data of its gears"),
        ("dynamics/planet_bearings", "synthetic_2mw", r"give gearbox\.stages\.0\.pins\.0\.catal"),
        ("dynamics/sun_spline", "OWN", "no planetary stage with bearings of its planets"),
        ("dynamics/transmission_error", "OWN", "full data of its gears"),
        ("dynamics/upwind_bearing", "OWN", r"give gearbox\.stages\.0\.pins"),
        ("dynamics/upwind_bearing", "park_2021", "which shares with none"),
        ("procedure/campaign", "NO_OPERATION", "does not state operation"),
        ("procedure/gaps", "NO_OPERATION", r"does not state operation\.rotor_speed"),
        ("procedure/interfaces", "OWN", r"give shaft\.sections and bearing_units"),
        ("procedure/measurement_cases", "NO_OPERATION", "does not state operation"),
    ],
)
def test_what_a_file_lacks_is_named(
    name: str, drivetrain: str, message: str, own: Path, tmp_path: Path
) -> None:
    bare = tmp_path / "bare.yaml"
    bare.write_text(re.sub("operation:.*", "", OWN), "utf-8")
    file = {"OWN": str(own), "NO_OPERATION": str(bare)}.get(drivetrain, drivetrain)
    with pytest.raises(InputError, match=message):
        ran(name, tmp_path, drivetrain=file)
