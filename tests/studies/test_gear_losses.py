"""Losses of a drivetrain: balance of power, standstill, reversal, levels, what a file states."""

from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain import read_drivetrain
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import parse_drivetrain
from fe_drivetrain.dynamics.bodies.bearing_reactions import bearing_reactions
from fe_drivetrain.dynamics.bodies.power_losses import Film, LossModel
from fe_drivetrain.gear.losses import mean_friction, tooth_loss_factor
from fe_drivetrain.studies.gear_loads import GearLoading, loads_of
from fe_drivetrain.studies.gear_losses import (
    CONSTANT,
    LEVELS,
    DrivetrainLosses,
    _lossy,
    drivetrain_losses,
    lossy_bearings,
)
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_ratings import gears, prepared
from fe_drivetrain.studies.loss_findings import life_efficiency

OPTIONS = GearOptions(losses=True)
TORQUES = (
    (324e3, 10.0, 2.3),
    (100e3, 10.0, 1.6),
    (0.0, 5.0, 1.6),
    (-50e3, 1.0, 1.6),
    (9e4, 1.0, 0.0),
)


def found(name: str = "grc_750kw", changes: dict[str, object] | None = None) -> DrivetrainLosses:
    """Losses of a drivetrain over a spectrum with reversed torque, idling and standstill."""
    drivetrain = read_drivetrain(name, changes or {})
    loading = GearLoading((), None, None, TORQUES, False)
    train, meshes, left_out = prepared(drivetrain, None, OPTIONS, loading)
    given = loads_of(train, OPTIONS, loading, lambda _: None)
    return drivetrain_losses(drivetrain, train, meshes, left_out, given)


@pytest.fixture(scope="module")
def losses() -> DrivetrainLosses:
    return found()


def test_power_is_balanced_part_by_part(losses: DrivetrainLosses) -> None:
    for level in losses.levels:
        of = level.losses
        assert of.entering - of.leaving == pytest.approx(of.heat.sum(axis=0), rel=1e-12, abs=1e-6)
        assert (of.heat >= 0.0).all()


def test_at_standstill_nothing_is_lost_and_friction_holds(losses: DrivetrainLosses) -> None:
    of = losses.answer.losses
    still = np.flatnonzero(of.speed == 0.0)
    assert len(still) == 1
    assert of.heat[:, still] == pytest.approx(0.0)
    assert of.generator_torque[still] == pytest.approx(of.torque[still] / abs(of.ratio))
    assert (of.held[still] > 0.0).all()
    assert np.isnan(of.efficiency[still]).all()


def test_a_rotor_that_stands_all_the_time_makes_no_heat_over_the_life() -> None:
    drivetrain = read_drivetrain("grc_750kw")
    stood = gears(drivetrain, options=OPTIONS, spectrum=[(9e4, 10.0, 0.0), (5e4, 10.0, 0.0)])
    assert stood.losses is not None
    assert [one.energy for one in stood.losses.levels] == 4 * [0.0]
    assert [one.difference for one in stood.losses.levels] == 4 * [0.0]
    assert life_efficiency(stood.losses) is None


def test_reversed_power_is_lost_on_its_way_to_the_rotor(losses: DrivetrainLosses) -> None:
    of = losses.answer.losses
    motored = of.torque < 0.0
    assert (-of.leaving[motored] > -of.entering[motored]).all()
    assert (of.efficiency[motored] < 1.0).all()
    idle = (of.torque == 0.0) & (of.speed > 0.0)
    assert (of.generator_torque[idle] < 0.0).all()


def test_torque_along_the_shafts_goes_down_to_that_of_the_generator(
    losses: DrivetrainLosses,
) -> None:
    of = losses.answer.losses
    along = of.along([float(k) for k in range(len(losses.shafts))])
    assert (np.diff(along[:, 0]) < 0.0).all()
    assert along[-1] / abs(of.ratio) == pytest.approx(of.generator_torque)


def test_the_band_covers_all_levels_but_the_constant_one(losses: DrivetrainLosses) -> None:
    own = losses.answer.losses.taken.sum(axis=0)
    for level in losses.levels:
        if level.name != CONSTANT:
            away = np.abs(level.losses.taken.sum(axis=0) - own)
            assert (away <= losses.band * (1.0 + 1e-9)).all()


def test_the_constant_efficiency_is_that_of_the_reference_torque(losses: DrivetrainLosses) -> None:
    constant, factors = losses.levels[0].losses, losses.levels[1].losses
    assert constant.efficiency[0] == pytest.approx(factors.efficiency[0])
    driven = constant.entering > 0.0
    assert np.ptp(constant.efficiency[driven]) == pytest.approx(0.0, abs=1e-12)
    # at part load what does not depend on load weighs more
    assert factors.efficiency[2] < factors.efficiency[0]


def test_a_mesh_has_the_torque_that_is_left_where_it_is() -> None:
    """Without friction of bearings a mesh loses mu H_V of what rolls through it."""
    drivetrain = read_drivetrain("grc_750kw")
    train, meshes, _ = prepared(drivetrain, None, OPTIONS, GearLoading((), None, None, None, False))
    mesh = _lossy(meshes["stage 3 mesh"])
    film = Film(100e-6)
    model = LossModel({}, (), (mesh,), film, train.machine.speeds[-1])
    hub, speed = np.zeros((1, 6)), np.array([2.0])
    hub[0, 3] = 3e5
    taken = model.losses(hub, speed, "skf").taken[0, 0]
    mu = mean_friction(
        mesh.pair, 3e5 * mesh.torque_ratio, 2.0 * mesh.speed_ratio, 870.0 * 100e-6, mesh.roughness
    )
    assert taken == pytest.approx(float(mu) * tooth_loss_factor(mesh.pair) * 3e5)
    # of a planetary stage only what turns against the carrier rolls: (i - 1) / i
    planetary = _lossy(meshes["stage 1 sun-planet"])
    assert planetary.rolling == pytest.approx(1.0 - 1.0 / train.machine.stages[0].speed_ratio)


def test_hotter_oil_stirs_less() -> None:
    cold, hot = (found(changes={"operation.temperature": t}) for t in (30.0, 80.0))
    idle = 3
    for name in ("factors f0 and f1",):
        one, other = (
            next(level for level in of.levels if level.name == name).losses.taken.sum(axis=0)[idle]
            for of in (cold, hot)
        )
        assert other < one


def test_bearings_without_an_entry_are_named_and_not_counted() -> None:
    drivetrain = read_drivetrain("nrel_5mw")
    result = gears(drivetrain, options=replace(OPTIONS, azimuths=4, slices=3))
    assert result.losses is not None
    assert {"INP-A", "HS-C"} <= result.losses.left_out.keys()
    assert any("lower bound" in text for text in result.notes)
    assert gears(drivetrain, options=GearOptions(azimuths=4, slices=3)).losses is None


def test_a_seal_of_the_file_rubs() -> None:
    seal = {"name": "lip", "shaft": "HSS", "diameter": 0.15}
    without, with_seal = found(), found(changes={"gearbox.seals": [seal]})
    more = with_seal.answer.losses.heat.sum(axis=0) - without.answer.losses.heat.sum(axis=0)
    own = with_seal.answer.losses
    assert more[0] == pytest.approx(own.heat[own.names.index("lip"), 0], rel=1e-6)
    n = own.speed[0] * abs(own.ratio) * 30.0 / np.pi
    assert more[0] == pytest.approx(7.69e-6 * 150.0**2 * n, rel=1e-6)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"operation.lubricant": "VG 5000"}, "lubricant 'VG 5000' is no grade that is known"),
        (
            {"gearbox.seals": [{"name": "lip", "shaft": "axle", "diameter": 0.15}]},
            "rubs on shaft 'axle', which is none",
        ),
    ],
)
def test_faults_are_one_sentence(changes: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        found(changes=changes)


def test_all_bearings_have_a_place_on_the_way_of_the_torque() -> None:
    machine = prepared(
        read_drivetrain("grc_750kw"), None, OPTIONS, GearLoading((), None, None, None, False)
    )[0].machine
    bearings, unknown = lossy_bearings(machine, Film(1e-4))
    places = {one.name: one.place for one in bearings}
    assert not unknown
    assert places["main_bearing"] == 0.0
    assert (places["stage 1 pin upwind"], places["LSS-A"]) == (0.5, 1.0)
    assert (places["ISS-A"], places["ISS-B"], places["HSS-A"]) == (2.0, 2.0, 3.0)
    assert bearing_reactions(machine, count=1).keys() == places.keys()
    assert list(LEVELS.values()) == ["palmgren", "skf", "rollers"]


def test_a_mesh_behind_losses_loses_less() -> None:
    drivetrain = read_drivetrain("grc_750kw")
    loading = GearLoading((), None, None, None, False)
    train, meshes, _ = prepared(drivetrain, None, OPTIONS, loading)
    first, last = (_lossy(meshes[name]) for name in ("stage 1 sun-planet", "stage 3 mesh"))
    hub, speed = np.zeros((1, 6)), np.array([2.0])
    hub[0, 3] = 3e5
    alone, behind = (
        LossModel({}, (), of, Film(100e-6), train.machine.speeds[-1]).losses(hub, speed, "skf")
        for of in ((last,), (first, last))
    )
    # mu goes with the torque to the power 0.2, so that the loss goes with the power 1.2
    left = 1.0 - behind.taken[0, 0] / 3e5
    assert behind.taken[1, 0] / alone.taken[0, 0] == pytest.approx(left**1.2)


def test_a_drivetrain_that_only_turns_is_refused_before_any_work() -> None:
    drivetrain = parse_drivetrain(ONLY_TURNS)
    with pytest.raises(InputError, match="states what turns alone"):
        prepared(drivetrain, None, OPTIONS, GearLoading((), None, None, None, False))


ONLY_TURNS = """
title: Turbine of a user
rotor: {inertia: 5.0e5}
shaft: {name: slow, torsion: 3.0e7}
gearbox:
  stages:
    - {kind: parallel, teeth: {gear: 88, pinion: 22}, stiffness_of: axis, gear: {inertia: 20},
       pinion: {inertia: 0.3}, stiffness: 5.0e7}
  shafts:
    - {name: quick, torsion: 2.0e6}
generator: {inertia: 30}
operation: {rated_power: 7.5e5, rotor_speed: [1.0, 2.3]}
"""


def test_efficiency_over_the_life_is_that_of_the_energy(losses: DrivetrainLosses) -> None:
    share, band = life_efficiency(losses) or (0.0, 0.0)
    of = losses.answer.losses
    hours = np.array([10.0, 10.0])  # of the two classes that are driven
    given, left = of.entering[1:3] @ hours, of.leaving[1:3] @ hours
    assert share == pytest.approx(left / given, rel=1e-12)
    assert of.efficiency[2] < share < of.efficiency[1]
    shares = losses.efficiency_band[1:3]
    assert shares.min() < band < shares.max()


def test_a_grade_without_a_data_sheet_has_an_index_of_95() -> None:
    of = found(changes={"operation.lubricant": "VG 150"})
    assert "viscosity index" in of.assumed
    assert of.oil.viscosity_40 == 150.0
    assert of.oil.viscosity_100 == pytest.approx(14.7, rel=0.02)
