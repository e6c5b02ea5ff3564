"""Bearings of a file on the rollers of their catalogue entries, with clearance."""

import numpy as np
import pytest

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.dynamics.bodies.advice import RUNGS, Operation, Rung
from fe_drivetrain.dynamics.bodies.catalogue_seats import catalogued, on_catalogue
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.dynamics.bodies.roller_seats import OnRollers

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
