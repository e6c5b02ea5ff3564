"""A beam on a bearing whose races give way: the limits of rigid races and of a rigid housing."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.bearing.answers import lamina_loads, laminae_of_contacts
from fe_drivetrain.bearing.catalogue import catalogue_bearing
from fe_drivetrain.bearing.races import Races, equilibrium_on_races, rigid_races, roller_motions
from fe_drivetrain.bearing_life.coupled.body import LinearBody, factors_of, in_housings, linear_body
from fe_drivetrain.bearing_life.coupled.newton import coupled_equilibrium
from fe_drivetrain.bearing_life.coupled.on_races import MINIMUM, body_on_races
from fe_drivetrain.bearing_life.rings.assembly import assembly_equilibrium
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.shafts.beam.closed_forms import MainBearingBeam, main_bearing_frame
from fe_drivetrain.shafts.beam.condensed import condensed_beam

BEARING = catalogue_bearing("bearing_s_o20", laminae=8, elements=12)
FACTORS = factors_of([[2e5, 0, -4e5, 0, 5e5, 0], [1e5, 3e4, -3e5, 0, -6e5, 4e5]], 392e3)

#: Compliance of a housing that moves as a rigid body [m/N, rad/(N m)].
SOFT = np.diag([1e-10, 2e-10, 2e-10, 5e-9, 3e-9])


@pytest.fixture(scope="module")
def body() -> LinearBody:
    beam = MainBearingBeam(shaft_diameter=0.635)
    stations = np.array([-beam.overhang, 0.0, beam.span])
    body = condensed_beam(main_bearing_frame(beam), ["hub", "bearing", "gearbox"], stations)
    return linear_body(body, ["bearing"], {"gearbox": (4e6, 8e7, 8e7, np.inf, 0.0, 0.0)})


def housed(body: LinearBody) -> LinearBody:
    K = np.full(6, 1e12)
    K[[0, 1, 2, 4, 5]] = 1.0 / np.diag(SOFT)
    return in_housings(body, {"bearing": np.diag(K)})


def as_races(compliance: Floats) -> Races:
    """Races that move as one rigid body."""
    A = np.vstack(roller_motions(BEARING))
    return Races(BEARING, A @ compliance @ A.T)


def test_on_rigid_races_it_is_the_coupled_equilibrium(body: LinearBody) -> None:
    found = assembly_equilibrium(body_on_races(body, rigid_races(BEARING)), FACTORS, shapes=48)
    exact = coupled_equilibrium(body, {"bearing": BEARING}, FACTORS)
    assert found.converged.all()
    assert_allclose(found.of("bearing"), exact.rollers("bearing"), atol=50 * MINIMUM * 1e5)
    assert_allclose(found.bearing_loads("bearing"), exact.of("bearing"), rtol=1e-4, atol=20.0)


def test_races_that_move_as_a_rigid_housing_are_one_in_series(body: LinearBody) -> None:
    exact = coupled_equilibrium(housed(body), {"bearing": BEARING}, FACTORS).rollers("bearing")
    rigid = coupled_equilibrium(body, {"bearing": BEARING}, FACTORS).rollers("bearing")
    assert np.abs(exact - rigid).max() > 0.05 * rigid.max()
    for one, races in ((body, as_races(SOFT)), (housed(body), rigid_races(BEARING))):
        found = assembly_equilibrium(body_on_races(one, races), FACTORS, shapes=48)
        assert_allclose(found.of("bearing"), exact, atol=1e-4 * exact.max())


def test_rollers_are_those_of_the_races_under_the_loads_that_the_body_puts_on_them(
    body: LinearBody,
) -> None:
    rng = np.random.default_rng(0)
    shape = rng.normal(size=(48, 6)) * np.r_[np.full(24, 1.0), np.full(24, 30.0)][:, None]
    races = Races(BEARING, 1e-10 * shape @ shape.T + as_races(SOFT).compliance)
    found = assembly_equilibrium(body_on_races(body, races), FACTORS, shapes=48)
    again = equilibrium_on_races(races, found.bearing_loads("bearing"), shapes=48)
    assert_allclose(found.of("bearing"), again.rollers, atol=1e-4 * again.rollers.max())


def test_laminae_of_contacts_are_those_of_rigid_rings_and_add_up(body: LinearBody) -> None:
    crowned = catalogue_bearing("bearing_s_o20", laminae=8, elements=12, crown=4.5e-4)
    exact = coupled_equilibrium(body, {"bearing": crowned}, FACTORS)
    u = exact.deflections[:, 0]
    approach, lean = roller_motions(crowned)
    for k, row in enumerate(crowned.rows):
        at = slice(12 * k, 12 * k + 12)
        q = laminae_of_contacts(row, u @ approach[at].T, u @ lean[at].T)
        assert_allclose(q, lamina_loads(row, u), rtol=1e-9, atol=1e-6)
        assert_allclose(q.sum(axis=2), exact.rollers("bearing")[:, at], rtol=1e-9, atol=1e-6)


def test_several_bearings_are_refused(body: LinearBody) -> None:
    from dataclasses import replace

    two = replace(body, bearings=("front", "rear"))
    with pytest.raises(InputError, match="front, rear"):
        body_on_races(two, rigid_races(BEARING))
