"""Bearings of a file on the rollers of their catalogue entries, with clearance."""

import numpy as np
import pytest

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.turning_parts import BearingData
from fe_drivetrain.dynamics.bodies.advice import RUNGS, Operation, Rung
from fe_drivetrain.dynamics.bodies.catalogue_seats import bearing_of, catalogued, on_catalogue
from fe_drivetrain.dynamics.bodies.condensed_rungs import ON_ROLLERS, Rungs, with_rollers
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.dynamics.bodies.mesh_loads import MeshResponses, with_slices
from fe_drivetrain.dynamics.bodies.roller_seats import OnRollers
from fe_drivetrain.dynamics.bodies.rolling_meshes import RollingMeshes

RIGID: Rung = RUNGS[1]
LOADED = Operation(1.0e6)
HIGH_SPEED = {"gearbox.bearings.8.catalogue": "planet_nj2232"}
PINS = {
    "gearbox.stages.0.pins.0.catalogue": "planet_nj2232",
    "gearbox.stages.0.pins.1.catalogue": "planet_nj2232",
}


def rolling(changes: dict[str, object]) -> Machine:
    return machine_of(read_drivetrain("synthetic_2mw", changes))


def carried(changes: dict[str, object]) -> OnRollers:
    found = on_catalogue(rolling(changes), RIGID, LOADED)
    assert found.converged
    return found


def test_a_pinion_on_rollers_is_in_balance() -> None:
    assert list(catalogued(rolling(HIGH_SPEED))) == ["HS-B"]
    found = carried(HIGH_SPEED)
    state, wrench = found.static, found.wrench("HS-B")
    mesh = [k for k, name in enumerate(state.system.spring_names) if "stage 3 mesh" in name]
    from_gear = state.forces[mesh] @ state.system.directions[mesh]
    of_springs = state.wrench("HS-A") + state.wrench("HS-B")
    weight = np.array([0.0, 0.0, -60.0 * GRAVITY])
    left = from_gear[:3] - of_springs[:3] - wrench[:3] + weight
    assert np.abs(left).max() < 1e-6 * np.abs(from_gear).max()
    # a cylindrical bearing leaves the axial force to the spring of its row
    assert wrench[0] == 0.0
    assert state.wrench("HS-B")[0] == pytest.approx(from_gear[0], rel=1e-6)
    assert np.hypot(*wrench[1:3]) == pytest.approx(found.radial("HS-B"))


def test_clearance_of_the_row_takes_the_place_of_the_catalogues() -> None:
    tight, loose = (
        carried(HIGH_SPEED | {"gearbox.bearings.8.clearance": value}) for value in (0.0, 1e-4)
    )
    moved = [abs(found.motions[0, 1:3]).max() for found in (tight, loose)]
    assert moved[1] - moved[0] == pytest.approx(1e-4, rel=0.5)


def test_bearings_of_planets_share_by_the_rows_of_their_stage() -> None:
    found = carried(PINS)
    assert len(found.seats) == 6
    loads = [found.radial(f"stage 1 pin {k} upwind") for k in (1, 2, 3)]
    assert max(loads) < 1.2 * min(loads)
    one = on_catalogue(rolling(PINS), RIGID, LOADED, ["stage 1 pin downwind"])
    assert [seat.name for seat in one.seats] == [f"stage 1 pin {k} downwind" for k in (1, 2, 3)]


@pytest.mark.parametrize(
    ("changes", "names", "message"),
    [
        ({}, None, "no bearing has a catalogue entry"),
        (HIGH_SPEED, ["HS-A"], r"'HS-A' has no catalogue entry.*one of HS-B"),
        ({"gearbox.bearings.8.catalogue": "mine"}, None, "'mine' is in no catalogue"),
        (
            HIGH_SPEED
            | {
                "gearbox.bearings.8.stiffness": [
                    [2e8 * (i == k) * (i != 3) for k in range(6)] for i in range(6)
                ]
            },
            None,
            "six rows, in whose place",
        ),
    ],
)
def test_what_cannot_be_on_rollers_is_refused(
    changes: dict[str, object], names: list[str] | None, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        on_catalogue(rolling(changes), RIGID, LOADED, names)


def test_meshes_on_rollers_carry_the_torque_and_only_press() -> None:
    """Pins on rollers, which resist a tilt: in sum the forces of springs, spread otherwise."""
    machine = rolling(PINS)
    (rung,) = with_rollers(Rungs((RIGID,), {}), machine).rungs[1:]
    assert rung.name == ON_ROLLERS
    assert "clearance and rollers of bearings" in RIGID.neglects
    assert "clearance and rollers of bearings" not in rung.neglects
    hub = np.array([0.0, 0.0, 0.0, 0.0, 2.0e5, 0.0])
    rollers, springs = RollingMeshes(machine, rung, 2, 3), MeshResponses(machine, RIGID.level, 2, 3)
    found, linear = (one.under(1.0e6, hub) for one in (rollers, springs))
    assert rollers.under(1.0e6, hub) is found
    for name, forces in found.slices.items():
        assert forces.min() >= 0.0
        known = linear.slices[name].sum(axis=(1, 2))
        np.testing.assert_allclose(forces.sum(axis=(1, 2)), known, rtol=1e-6)
    mesh = "stage 1 sun-planet"
    each = [one.slices[mesh].max() / one.slices[mesh].mean() for one in (found, linear)]
    assert each[0] != pytest.approx(each[1], rel=1e-3)
    # an equilibrium of its own, at the second azimuth
    mine = on_catalogue(
        with_slices(machine, 3), rung, LOADED, azimuth=float(found.azimuths[1]), hub=hub
    )
    assert found.slices[mesh][1].sum(axis=1) == pytest.approx(
        [mine.static.force(f"{mesh} {k}") for k in (1, 2, 3)], rel=1e-6
    )


def test_a_lifted_rotor_is_one_without_weight() -> None:
    machine = rolling(PINS)
    (rung,) = with_rollers(Rungs((RIGID,), {}), machine).rungs[1:]
    weight = np.array([0.0, 0.0, -GRAVITY * machine.rotor.apart[0], 0.0, 0.0, 0.0])
    heavy = RollingMeshes(machine, rung, 1, 3).under(1.0e6)
    light = RollingMeshes(machine, rung, 1, 3, weight=False).under(1.0e6, weight)
    for name, forces in heavy.slices.items():
        np.testing.assert_allclose(light.slices[name], forces, rtol=1e-6, atol=1e-3)


def test_a_ladder_without_entries_has_no_rollers() -> None:
    with pytest.raises(InputError, match=r"no bearing of .* has a catalogue entry and a load"):
        with_rollers(Rungs((RIGID,), {}), rolling({}))


def test_a_row_s_mounting_gives_its_rollers_their_clearance() -> None:
    """That of the mounted bearing, per half of the diameter; beside a clearance it is refused."""
    row = {
        "name": "b",
        "holds": "shaft",
        "stiffness": [0.0, 1e9, 1e9, 0.0, 0.0, 0.0],
        "catalogue": "cylindrical_nu2220",
    }
    mounting = {"mounted_clearance": [40e-6, 60e-6]}
    found = bearing_of(BearingData.model_validate({**row, "mounting": mounting}))
    assert found.rows[0].clearance == pytest.approx(25e-6)
    with pytest.raises(InputError, match="leave one out"):
        BearingData.model_validate({**row, "mounting": mounting, "clearance": 1e-5})
