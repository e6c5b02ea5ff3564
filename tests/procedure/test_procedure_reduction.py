"""Springs that are locked: what can still move, which matter, and what a signal needs."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.bodies import Body, Superelement, assemble
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.springs import Place, directed
from fe_drivetrain.dynamics.bodies.system import System, with_proportional_damping, with_stiffness
from fe_drivetrain.dynamics.torsion.system import Inertia, chain
from fe_drivetrain.procedure.motions import driven_motions
from fe_drivetrain.procedure.reduction import (
    frequencies_on,
    frequency_that_holds,
    influences,
    locked_basis,
    mode_error,
    one_after_another,
    spring_groups,
    threshold_share,
    torque_signal,
)

TURN = np.eye(6)[3]


def shafts(stiffness: dict[str, float], inertias: list[float], grounded: bool = False) -> System:
    """Inertias in a row that only turn, shafts between them; the last one to ground."""
    names = [f"body {k}" for k in range(len(inertias))]
    bodies = [
        Body(n, polar=J, transverse=J, mass=1.0, free=frozenset({"rx"}))
        for n, J in zip(names, inertias, strict=True)
    ]
    others = [*names[1:], *([None] if grounded else [])]
    springs = [
        directed(
            f"{name} rx",
            Place(one, (0, 0, 0)),
            None if other is None else Place(other, (0, 0, 0)),
            (0, 0, 0),
            TURN,
            k,
        )
        for (name, k), one, other in zip(stiffness.items(), names, others, strict=False)
    ]
    return assemble(bodies, springs)


@pytest.fixture(scope="module")
def gearbox() -> System:
    return machine_system(library_machine("nrel_750kw"), Level.RIGID)


def test_groups_are_parts_with_their_kinds_and_hold_each_spring_once(gearbox: System) -> None:
    groups = spring_groups(gearbox)
    assert {"LSS torsion", "LSS bending", "stage 1 sun-planet", "stage 1 pin across"} <= set(groups)
    assert {"stage 2 mesh", "main bearing axial", "HSS torsion"} <= set(groups)
    assert not [name for name in groups if "slice" in name or "pin 1" in name]
    numbers = sorted(k for springs in groups.values() for k in springs)
    assert numbers == list(range(len(gearbox.spring_names)))
    torsional = machine_system(library_machine("nrel_750kw"), Level.TORSIONAL)
    assert "LSS bending" not in spring_groups(torsional)


def test_what_is_locked_does_not_stretch_and_is_the_limit_of_a_stiff_spring(
    gearbox: System,
) -> None:
    springs = spring_groups(gearbox)["HSS torsion"]
    basis = locked_basis(gearbox, springs)
    assert basis.shape == (61, 60)
    stretch = gearbox.rows[springs] @ basis
    assert np.abs(stretch).max() < 1e-12 * np.abs(gearbox.rows @ basis).max()
    assert basis.T @ gearbox.mass @ basis == pytest.approx(np.eye(60), abs=1e-9)
    name = gearbox.spring_names[springs[0]]
    stiff = with_stiffness(gearbox, {name: 1e6 * gearbox.stiffness[springs[0]]})
    low = frequencies_on(gearbox, basis)[:20]
    assert system_modes(stiff).frequencies[:20] == pytest.approx(low, rel=1e-4)


def test_with_nothing_locked_the_modes_are_those_of_the_system(gearbox: System) -> None:
    found = frequencies_on(gearbox, locked_basis(gearbox, ()))
    assert found == pytest.approx(system_modes(gearbox).frequencies, rel=1e-9)
    with_extra = machine_system(library_machine("nrel_750kw"), Level.TORSIONAL)
    eye = np.eye(len(with_extra.names))
    more = System(**{**vars(with_extra), "extra": 1e9 * eye})
    assert frequencies_on(more, locked_basis(more, ()))[0] > 0.0


@pytest.mark.parametrize("stiffer", [2.0, 10.0, 50.0])
def test_of_two_springs_in_series_the_error_is_that_of_the_share(stiffer: float) -> None:
    # an inertia on two springs, with next to no inertia between them
    system = shafts({"soft": 1e4, "stiff": stiffer * 1e4}, [10.0, 1e-9], grounded=True)
    (least, _) = influences(system, spring_groups(system), 100.0)
    assert least.group == "stiff torsion"
    assert least.share == pytest.approx(1.0 / (1.0 + stiffer), rel=1e-6)
    assert least.error == pytest.approx((1.0 - least.share) ** -0.5 - 1.0, rel=1e-6)
    assert least.error == pytest.approx(1.0 / (2.0 * stiffer), rel=0.6 / stiffer)
    assert threshold_share(0.02) == pytest.approx(0.039, abs=5e-4)
    assert threshold_share(least.error) == pytest.approx(least.share, rel=1e-6)


def test_a_soft_spring_beside_a_stiff_one_has_no_share_and_matters_all_the_same() -> None:
    bodies = [Body("one", polar=10.0, transverse=1.0, mass=1.0, free=frozenset({"rx"}))]
    place = Place("one", (0, 0, 0))
    both = [
        directed(f"{name} rx", place, None, (0, 0, 0), TURN, k)
        for name, k in (("stiff", 1e6), ("soft", 1.0))
    ]
    system = assemble(bodies, both)
    by_name = {one.group: one for one in influences(system, spring_groups(system), 1e3)}
    assert by_name["soft torsion"].share == pytest.approx(1e-6, rel=1e-5)
    assert by_name["soft torsion"].error == by_name["stiff torsion"].error == float("inf")


def test_errors_only_grow_as_more_is_locked(gearbox: System) -> None:
    found = influences(gearbox, spring_groups(gearbox), 60.0)
    assert [one.error for one in found] == sorted(one.error for one in found)
    springs: list[int] = []
    errors = []
    for number, one in enumerate(found[:32]):
        springs += one.springs
        if number % 4 == 3:
            errors.append(mode_error(gearbox, springs, 60.0))
            assert one.error <= errors[-1] + 1e-9
    assert (np.diff(errors) > -1e-9).all()
    assert errors[0] > -1e-9
    with pytest.raises(InputError, match="no mode is at or below"):
        influences(gearbox, {}, 1e-3)


def test_the_torque_of_a_shaft_is_that_of_the_torsional_model() -> None:
    step, count = 2e-3, 400
    history = np.interp(np.arange(count), [0, 100, 150, count], [0.0, 0.0, 1.0, 1.0])
    J, k, seconds = [150.0, 3.0, 24.0], {"LSS": 5e3, "HSS": 4e4}, 1e-3
    system = with_proportional_damping(shafts(k, J), seconds)
    load = system.load_on("body 2", -700.0 * TURN)
    found = torque_signal(system, load, history, step, "LSS")(locked_basis(system, ()))
    parts = [Inertia(f"body {i}", value) for i, value in enumerate(J)]
    other = chain(parts, [(n, value, seconds * value) for n, value in k.items()])
    torques = np.zeros((3, count))
    torques[2] = -700.0 * history
    angle = driven_motions(other, torques, step).angle
    expected = 5e3 * (angle[0] - angle[1])
    assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()
    with pytest.raises(InputError, match="no shaft 'IMS'"):
        torque_signal(system, load, history, step, "IMS")


def test_a_condensed_shaft_has_the_torque_of_the_spring_that_it_replaces() -> None:
    k, J = {"LSS": 5e3, "HSS": 4e4}, [150.0, 3.0, 24.0]
    springs = shafts(k, J)
    only = shafts({"HSS": 4e4}, J[1:])
    bodies = [
        Body(f"body {i}", polar=j, transverse=j, mass=1.0, free=frozenset({"rx"}))
        for i, j in enumerate(J)
    ]
    between = np.kron([[1.0, -1.0], [-1.0, 1.0]], np.diag(5e3 * TURN))
    hss = directed(
        "HSS rx", Place("body 1", (0, 0, 0)), Place("body 2", (0, 0, 0)), (0, 0, 0), TURN, 4e4
    )
    condensed = assemble(bodies, [hss], [Superelement("LSS", ("body 0", "body 1"), between)])
    history = np.minimum(np.arange(200) / 20.0, 1.0)
    one, other = (
        torque_signal(s, s.load_on("body 2", -700.0 * TURN), history, 5e-3, "LSS", front="body 0")(
            locked_basis(s, ())
        )
        for s in (springs, condensed)
    )
    assert np.abs(one - other).max() < 1e-9 * np.abs(one).max()
    with pytest.raises(InputError, match="no shaft 'LSS' with a torsion spring"):
        torque_signal(only, only.load_on("body 1", TURN), history, 5e-3, "LSS", front="body 0")


def test_one_after_another_keeps_what_the_signal_does_not_see() -> None:
    k = {"LSS": 5e3, "stiff": 1e8, "HSS": 6e3}
    system = with_proportional_damping(shafts(k, [150.0, 3.0, 3.0, 24.0]), 1e-3)
    history = np.minimum(np.arange(300) / 20.0, 1.0)
    load = system.load_on("body 3", -700.0 * TURN)
    signal = torque_signal(system, load, history, 5e-3, "LSS")
    groups = {n: s for n, s in spring_groups(system).items() if n != "LSS torsion"}
    order = influences(system, groups, 10.0)
    trials = one_after_another(system, order, signal, 0.02)
    assert [(t.group, t.stays, t.degrees) for t in trials] == [
        ("", True, 4),
        ("stiff torsion", True, 3),
        ("HSS torsion", False, 2),
    ]
    assert trials[1].signal_error < 1e-3
    assert trials[2].signal_error > 0.1
    with pytest.raises(InputError, match="does not vary"):
        one_after_another(system, order, lambda basis: np.ones(5), 0.02)


def test_the_power_of_a_signal_is_held_below_its_highest_frequency() -> None:
    t = np.arange(1000) * 0.01
    signal = 7.0 + np.sin(2 * np.pi * 2.0 * t) + 0.1 * np.sin(2 * np.pi * 9.0 * t)
    assert frequency_that_holds(signal, 0.01, 0.98) == pytest.approx(2.0)
    assert frequency_that_holds(signal, 0.01, 0.999) == pytest.approx(9.0)
    with pytest.raises(InputError, match="does not vary"):
        frequency_that_holds(np.ones(10), 0.01)
