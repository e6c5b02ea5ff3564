"""Shafts as condensed solids, housings of several points, rims of rings, in a machine."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from fe_drivetrain.bearing.arrangements import cylindrical
from fe_drivetrain.cases.references.machine_shafts import shaft_scene
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import point_motions
from fe_drivetrain.drivetrain_file.turning_parts import STEEL
from fe_drivetrain.dynamics.bodies.advice import Operation, Rung, ladder
from fe_drivetrain.dynamics.bodies.elastic_ring import Rim
from fe_drivetrain.dynamics.bodies.flexible import ElasticHousing, Flexible, Housing
from fe_drivetrain.dynamics.bodies.levels import Level, assembly, machine_system, steady_load
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.roller_seats import machine_seat
from fe_drivetrain.dynamics.bodies.static import static
from fe_drivetrain.dynamics.time.travelling import travelling
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.fidelity.shafts import beam_shaft, meridian_shaft

FIVE_MW = library_machine("nrel_5mw")


@pytest.fixture(scope="module")
def beam() -> Condensed:
    return beam_shaft(shaft_scene(FIVE_MW, "LSS"), rings=False)


@pytest.fixture(scope="module")
def solid() -> Condensed:
    return meridian_shaft(shaft_scene(FIVE_MW, "LSS"), 1.4, 4, rings=False, layers=1)


def frequencies(flexible: Flexible | None = None, elements: int = 1) -> Floats:
    return system_modes(
        machine_system(FIVE_MW, Level.FLEXIBLE, elements=elements, flexible=flexible)
    ).frequencies


def test_a_condensed_beam_is_the_beam_of_the_machine(beam: Condensed) -> None:
    same = frequencies(Flexible(shafts={"LSS": beam}))
    own = frequencies()
    assert len(same) == len(own)
    assert same[1:] == pytest.approx(own[1:], rel=1e-8)


def test_a_solid_shaft_gives_modes_between_those_of_softer_and_stiffer_beams(
    beam: Condensed, solid: Condensed
) -> None:
    """Rayleigh: all frequencies are within those of the beam times bounds of its stiffness."""
    # how stiff the solid is over the beam, in all motions but rigid ones
    bends = np.linalg.svd(beam.rigid_motions.T)[2][6:].T
    over = eigh(
        bends.T @ solid.stiffness @ bends, bends.T @ beam.stiffness @ bends, eigvals_only=True
    )
    assert over[0] < 1.0  # a seat in the solid gives, a section of the beam does not
    light = replace(solid, mass=None)
    found = frequencies(Flexible(shafts={"LSS": light}))
    low, high = (
        frequencies(Flexible(shafts={"LSS": replace(beam, stiffness=factor * beam.stiffness)}))
        for factor in (over[0], over[-1])
    )
    assert np.all(found[1:] >= low[1:] * (1 - 1e-9))
    assert np.all(found[1:] <= high[1:] * (1 + 1e-9))
    # and, to first order, no further from the beam's than its share of the strain lets them be
    system = machine_system(
        FIVE_MW, Level.FLEXIBLE, elements=1, flexible=Flexible(shafts={"LSS": beam})
    )
    softer = replace(beam, stiffness=0.999 * beam.stiffness)
    other = machine_system(
        FIVE_MW, Level.FLEXIBLE, elements=1, flexible=Flexible(shafts={"LSS": softer})
    )
    own = system_modes(system)
    x = own.shapes[:, 1:11]
    share = (
        np.einsum("ni,nm,mi->i", x, (system.K - other.K) / 0.001, x)
        / (2 * np.pi * own.frequencies[1:11]) ** 2
    )
    band = 0.5 * share * max(1.0 - over[0], over[-1] - 1.0)
    assert np.all(np.abs(found[1:11] / own.frequencies[1:11] - 1) <= band + 1e-9)
    assert band.max() < 0.2
    assert share.max() > 0.1


def test_weight_of_a_solid_shaft_is_on_the_bearings(solid: Condensed) -> None:
    given = Flexible(shafts={"LSS": solid})
    loads = {}
    for name, flexible in (("beam", None), ("solid", given)):
        system = machine_system(
            FIVE_MW, Level.FLEXIBLE, elements=1, held_generator=True, flexible=flexible
        )
        found = static(system, steady_load(FIVE_MW, system, 3.9e6, np.zeros(6)))
        loads[name] = found
    weights = {
        name: float(
            one.system.gravity(np.array([0.0, 0.0, -9.80665])) @ translation(one.system.names)
        )
        for name, one in loads.items()
    }
    # densities are the same, so that the whole weighs the same
    assert weights["solid"] == pytest.approx(weights["beam"], rel=1e-6)
    forces = [loads[n].force("INP-A uz") for n in ("beam", "solid")]
    assert forces[1] == pytest.approx(forces[0], rel=0.02)


def translation(names: tuple[str, ...]) -> Floats:
    return np.array([1.0 if name.endswith(" uz") else 0.0 for name in names])


def test_the_ladder_has_a_rung_with_a_solid_shaft(solid: Condensed) -> None:
    rungs = [
        Rung(Level.FLEXIBLE, Flexible(), "beams"),
        Rung(Level.FLEXIBLE, Flexible(shafts={"LSS": solid}), "a solid shaft"),
    ]
    one, two = ladder(FIVE_MW, Operation(3.9e6, 2e6), rungs)
    for question, value in one.values.items():
        assert value is not None
        assert two.values[question] == pytest.approx(value, rel=0.02)
    assert one.values != two.values


def test_shafts_that_do_not_fit_are_refused(beam: Condensed) -> None:
    long = replace(beam, positions=1.01 * beam.positions)
    with pytest.raises(InputError, match=r"2\.02 m long between .* must be 2 m long"):
        frequencies(Flexible(shafts={"LSS": long}))
    moved = beam.positions.copy()
    moved[1, 0] += 0.05
    with pytest.raises(
        InputError, match="no point of its condensed body is at the bearing 'INP-A'"
    ):
        frequencies(Flexible(shafts={"LSS": replace(beam, positions=moved)}))
    with pytest.raises(InputError, match="no shaft 'HSS' that bends"):
        frequencies(Flexible(shafts={"HSS": beam}))


ROOT = np.array([1e9, 2e9, 3e9, 4e9, 2e9, 1e9])
PLACE = (2.0, 0.0, 0.0)


def spread_housing(inside: float) -> ElasticHousing:
    """On the same root as a rigid one, with such a stiffness between its points."""
    found = assembly(FIVE_MW)
    points = {"stage 1 ring": (2.0, 0.0, 0.0), "stage 2 ring": (2.5, 0.0, 0.0)}
    points |= {name: found.seats[name][1] for name in found.seats}
    positions = np.array(list(points.values()))
    R = point_motions(positions, np.array(PLACE))
    onto = np.linalg.pinv(R)
    K = onto.T @ np.diag(ROOT) @ onto + inside * (np.eye(len(R)) - R @ onto)
    return ElasticHousing(tuple(points), positions, (K + K.T) / 2)


def test_a_stiff_housing_of_many_points_is_the_rigid_one_and_a_soft_one_is_softer() -> None:
    rigid = frequencies(Flexible(housing=Housing(PLACE, np.diag(ROOT), 0.0, 0.0, 0.0)))
    stiff, soft = (frequencies(Flexible(housing=spread_housing(k))) for k in (1e15, 1e9))
    assert stiff[1:40] == pytest.approx(rigid[1:40], rel=1e-4)
    assert np.all(soft[1:] <= stiff[1:] * (1 + 1e-9))
    assert soft[3] < 0.999 * stiff[3]


def test_bearings_are_held_by_their_points_of_the_housing() -> None:
    housing = spread_housing(1e12)
    found = assembly(FIVE_MW, flexible=Flexible(housing=housing))
    holder = found.holders["HS-A"]
    assert holder is not None
    assert holder.body == "housing at HS-A"
    few = ElasticHousing(housing.points[:2], housing.positions[:2], housing.stiffness[:12, :12])
    nearest = assembly(FIVE_MW, flexible=Flexible(housing=few)).holders["INP-A"]
    assert nearest is not None
    assert nearest.body == "housing at stage 1 ring"
    one = machine_seat(found, "HS-A", cylindrical("b", 16, 0.04, 0.05, 0.225))
    assert set(one.motions[0].by) == {"stage 3 pinion", "housing at HS-A"}


def rim(thickness: float) -> Flexible:
    return Flexible(rims={1: (Rim(1.4, thickness, 0.491, STEEL), (2, 3))})


def test_a_stiff_rim_is_a_rigid_ring_and_a_real_one_lowers_the_modes() -> None:
    def rigid_level(flexible: Flexible | None) -> Floats:
        return system_modes(machine_system(FIVE_MW, flexible=flexible)).frequencies

    rigid, stiff, real = (rigid_level(f) for f in (None, rim(40.0), rim(0.15)))
    assert len(real) == len(rigid) + 4
    assert stiff[1:30] == pytest.approx(rigid[1:30], rel=1e-4)
    assert np.all(real[1 : len(rigid)] <= rigid[1:] * (1 + 1e-9))
    assert real[20] < rigid[20]
    # planets that pass bend it: rows of degree 4 in the azimuth
    carriers = travelling(FIVE_MW, held_generator=True, flexible=rim(0.15))
    at = {1: 0.9, 2: 0.9 * FIVE_MW.speeds[1]}
    exact = machine_system(FIVE_MW, azimuth=at, held_generator=True, flexible=rim(0.15)).rows
    assert carriers.at(0.9)[0] == pytest.approx(exact, abs=1e-12 * np.abs(exact).max())
