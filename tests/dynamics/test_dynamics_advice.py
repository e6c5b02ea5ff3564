"""Flexible carriers and housings, Park's model as printed, which level is needed."""

import numpy as np
import pytest

from fe_drivetrain.cases.references import park_2021 as park
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import point_motions
from fe_drivetrain.comparison.tolerances import digit
from fe_drivetrain.drivetrain_file.reading import library_component
from fe_drivetrain.dynamics.bodies.advice import (
    RUNGS,
    Answer,
    Asked,
    Operation,
    contact_stress,
    ladder,
    needed_level,
)
from fe_drivetrain.dynamics.bodies.flexible import Flexible, Housing, carrier_element
from fe_drivetrain.dynamics.bodies.levels import (
    Level,
    azimuths,
    machine_system,
    planetary_set,
    steady_load,
)
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.static import Turn, over_a_turn, static
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame

FIVE_MW, C = library_machine("nrel_5mw"), library_machine("synthetic_2mw")


@pytest.fixture(scope="module")
def carrier() -> Condensed:
    return carrier_frame(library_component("planet_carrier"))  # type: ignore[arg-type]


def stiff(body: Condensed, factor: float) -> Condensed:
    return Condensed(body.names, body.positions, factor * body.stiffness, body.gravity)


def test_a_carrier_element_is_free_of_rigid_motions(carrier: Condensed) -> None:
    stage = planetary_set(FIVE_MW, 1, turned=0.7)
    bodies, element, pins = carrier_element(carrier, stage, "stage 1 carrier")
    places = np.array([stage.centre(), *(b.position for b in bodies)])
    forces = element.stiffness @ point_motions(places)
    assert np.abs(forces).max() < 1e-9 * np.abs(element.stiffness).max()
    assert [pin.body for pin in pins] == [b.name for b in bodies]


def test_a_stiff_carrier_is_the_rigid_one_and_a_real_one_is_softer(carrier: Condensed) -> None:
    rigid = system_modes(machine_system(FIVE_MW, Level.RIGID)).frequencies
    hard = Flexible({1: stiff(carrier, 1e6)})
    like = system_modes(machine_system(FIVE_MW, Level.RIGID, flexible=hard)).frequencies
    real = system_modes(
        machine_system(FIVE_MW, Level.RIGID, flexible=Flexible({1: carrier}))
    ).frequencies
    assert np.allclose(like[1:40], rigid[1:40], rtol=1e-4)
    assert (real[1:] <= rigid[1:] * (1 + 1e-6)).all()
    assert real[9] < 0.99 * rigid[9]


def test_the_upwind_bearing_has_more_on_a_carrier_that_is_driven_from_there(
    carrier: Condensed,
) -> None:
    def turn(flexible: Flexible | None) -> Turn:
        def at(azimuth: float) -> System:
            return machine_system(
                FIVE_MW, Level.RIGID, azimuth, held_generator=True, flexible=flexible
            )

        def loads(system: System) -> np.ndarray:
            return steady_load(FIVE_MW, system, 3.9e6, np.zeros(6))

        return over_a_turn(at, loads, azimuths(3))

    def ratio(found: Turn) -> float:
        up, down = (found.resultant(f"stage 1 pin 1 {s}").mean() for s in ("upwind", "downwind"))
        return float(up / down)

    assert ratio(turn(None)) == pytest.approx(1.0, abs=2e-3)
    assert ratio(turn(Flexible({1: carrier}))) > 1.015


def test_a_carrier_with_pins_elsewhere_is_refused(carrier: Condensed) -> None:
    with pytest.raises(InputError, match=r"pins at equal angles on a circle of 1\.40568 m"):
        machine_system(C, Level.RIGID, flexible=Flexible({1: carrier}))
    short = Condensed(carrier.names[:3], carrier.positions[:3], np.eye(18), np.zeros((18, 3)))
    with pytest.raises(InputError, match="one pin for each planet"):
        machine_system(FIVE_MW, Level.RIGID, flexible=Flexible({1: short}))


def test_the_housing_carries_what_goes_in_less_what_goes_out() -> None:
    k = np.diag([1e8, 1e9, 1e9, 1e9, 1e9, 1e9])
    housing = Housing((2.0, 0.0, 0.0), k, 5000.0, 4000.0, 2500.0)
    system = machine_system(C, Level.RIGID, held_generator=True, flexible=Flexible(housing=housing))
    torque = 1e6
    found = static(system, system.load_on("rotor", np.array([0, 0, 0, torque, 0, 0])))
    reaction = k @ system.motion_of("housing", found.q)
    # the generator turns with the rotor's sense, at the ratio of the gearbox; bearings that are
    # not in the housing there are none, and its axis is off the rotor's
    out = torque / C.speeds[-1]
    assert reaction[3] == pytest.approx(torque - out, rel=1e-6)
    assert np.abs(reaction[:3]).max() < 1e-6 * torque


def test_a_stiff_housing_is_the_ground() -> None:
    k = np.diag([1e16, 1e16, 1e16, 1e16, 1e16, 1e16])
    housing = Flexible(housing=Housing((2.0, 0.0, 0.0), k, 5000.0, 4000.0, 2500.0))
    rigid = system_modes(machine_system(C, Level.RIGID)).frequencies
    like = system_modes(machine_system(C, Level.RIGID, flexible=housing)).frequencies
    assert np.allclose(like[1:30], rigid[1:30], rtol=1e-4)


def test_the_printed_model_of_park() -> None:
    for both in (True, False):
        model = park.printed_model(1e9, both)
        assert len(model.names) == 36
        assert park.nullity(model) == 7
    assert park.nullity(machine_system(library_machine("park_2021"))) == 1
    assert park.ratio() == pytest.approx(34.65431, abs=5e-6)


@pytest.mark.parametrize(
    ("factor", "expected"),
    [
        (1.0, "1.9486 58.92 210.96 279.05 446.48 685.40 800.65"),
        (2.0, "2.429 79.25 235.3 376.8 456.8 776.1 1094.7"),
    ],
)
def test_the_printed_spectrum_is_that_of_eight_inertias(factor: float, expected: str) -> None:
    found = park.spectrum(factor)
    assert found[0] < 1e-3
    for value, printed in zip(found[1:], expected.split(), strict=True):
        assert abs(value - float(printed)) <= 0.5001 * digit(printed)
    # the same by inertias and windings alone
    r, J, k = park.RADII, park.INERTIAS, park.MESHES
    names = list(J)
    rows, stiff_of = [], []
    for shaft, (one, two) in park.SHAFTS.items():
        rows.append({one: 1.0, two: -1.0})
        stiff_of.append(park.TORSION[shaft])
    rows.append({"carrier": -r["carrier"], "planet": r["planet"], "sun": r["sun"]})
    rows.append({"carrier": r["carrier"], "planet": r["planet"]})
    rows.append({"gear 1": r["gear 1"], "gear 2": r["gear 2_1"]})
    rows.append({"gear 2": r["gear 2_2"], "gear 3": r["gear 3"]})
    stiff_of += [3 * factor * k["sun-planet"], 3 * factor * k["ring-planet"]]
    stiff_of += [factor * k["gears 1-2"], factor * k["gears 2-3"]]
    B = np.array([[row.get(name, 0.0) for name in names] for row in rows])
    M = np.array([3 * J[n] if n == "planet" else J[n] for n in names])
    w2 = np.linalg.eigvalsh((B.T * stiff_of) @ B / np.sqrt(np.outer(M, M)))
    assert np.allclose(found[1:], np.sqrt(w2[1:]) / (2 * np.pi), rtol=1e-6)


def test_what_is_asked_of_each_level() -> None:
    answers = ladder(C, Operation(1e6, 5e5), RUNGS[:2])
    assert [a.name for a in answers] == ["torsional", "rigid bodies"]
    assert answers[0].values["load sharing of the planets"] is None
    assert needed_level(answers, "load sharing of the planets", 0.5) == "rigid bodies"
    stress = "largest contact stress of a gear [MPa]"
    assert needed_level(answers, stress, 0.5) == "torsional"
    low, high = (answer.values[stress] for answer in answers)
    assert low is not None
    assert high is not None
    assert high > low  # planets and slices do not share equally
    assert needed_level(answers, "first torsional frequency [Hz]", 0.1) == "torsional"
    assert needed_level(answers, "first torsional frequency [Hz]", 1e-6) == "rigid bodies"
    with pytest.raises(InputError, match="was asked"):
        needed_level(answers, "noise", 0.1)


def test_contact_stress_of_a_torsional_level_is_that_of_equal_shares() -> None:
    # 985 MPa by hand of the high-speed stage of C at rated torque, the largest of its meshes
    rated = contact_stress(Asked(C, RUNGS[0], Operation(1.055e6)))
    assert rated == pytest.approx(985.0, rel=2.5e-3)
    assert contact_stress(Asked(C, RUNGS[0], Operation(4 * 1.055e6))) == pytest.approx(2 * rated)
    # a moment of the hub reaches bodies in space alone
    assert contact_stress(Asked(C, RUNGS[0], Operation(1.055e6, 1e6))) == rated
    still, tilted = (contact_stress(Asked(C, RUNGS[1], Operation(1.055e6, m))) for m in (0, 1e6))
    assert still != tilted


def test_a_level_in_between_that_is_wrong_rules_out_those_below() -> None:
    values = [{"f": 1.0}, {"f": 2.0}, {"f": 1.01}]
    answers = [Answer(str(k), 1, 0.0, v) for k, v in enumerate(values)]
    assert needed_level(answers, "f", 0.05) == "2"
