"""Rollers between races that give way: limits, balance, and other ways to the same answer."""

from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.bearing.arrangements import cylindrical
from fe_drivetrain.bearing.catalogue import catalogue_bearing
from fe_drivetrain.bearing.contact import linear
from fe_drivetrain.bearing.geometry import Bearing, RollerRow, angles
from fe_drivetrain.bearing.races import Races, equilibrium_on_races, rigid_races, roller_motions
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.bearing_life.rings.housing import contact_compliance, contact_rows
from fe_drivetrain.bearing_life.rings.of_revolution import races_of_revolution
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.mesh.generation import generate
from fe_drivetrain.elasticity.revolution.harmonics import dofs
from fe_drivetrain.elasticity.revolution.influence import roller_forces
from fe_drivetrain.elasticity.revolution.meridian_mesh import meridian
from fe_drivetrain.geometry import Bearing as Ring
from fe_drivetrain.geometry import Housing, MeshSizes, Section, Shaft

BEARING = catalogue_bearing("bearing_s_o20", laminae=0)
LOADS = np.array(
    [[0, 0, -4e5, 0, 0], [0, 0, 0, 8e5, 0], [0, 0, 0, 0, 8e5], [2e5, 1e5, -4e5, 8e5, 3e5]]
)
BORE, OUTSIDE, WIDTH = 0.424, 0.5, 0.22


def annulus(bearing: Bearing, order: int = 4, harmonics: int | None = None) -> Races:
    """A ring about the bearing, clamped outside."""
    section = Section(length=WIDTH, outer_diameter=2 * OUTSIDE, inner_diameter=2 * BORE)
    mesh = meridian(Shaft(front=-WIDTH / 2, sections=(section,)), 0.06, order=order, layers=0)
    outside = np.flatnonzero(np.abs(mesh.nodes[:, 1] - OUTSIDE) < 1e-9)
    held = np.concatenate([dofs(outside, c) for c in range(3)])
    return races_of_revolution(
        bearing, mesh, MATERIALS["steel"], BORE, held=held, harmonics=harmonics
    )


@pytest.fixture(scope="module")
def soft() -> Races:
    """Races much softer than their contacts."""
    return annulus(BEARING).stiffened(0.02)


def test_tapered_rollers_pull_their_ring_to_the_side_that_they_lean_to() -> None:
    """A tube on its upwind end, pulled away from that, contracts (Poisson): it gives less to
    rollers that press outward and downwind than to those that press outward and upwind."""
    section = Section(length=0.8, outer_diameter=1.0, inner_diameter=0.94)
    mesh = meridian(Shaft(front=-0.5, sections=(section,)), 0.03, order=3, layers=0)
    end = np.flatnonzero(np.abs(mesh.nodes[:, 0] + 0.5) < 1e-9)
    held = np.concatenate([dofs(end, 0), dofs(end, 2), dofs(end[:1], 1)])
    row = BEARING.rows[0]
    assert isinstance(row, RollerRow)
    given = {}
    for angle in (-0.3, 0.3):
        lone = Bearing("row", (replace(row, place=0.0, radius=0.47, angle=angle),))
        races = races_of_revolution(lone, mesh, MATERIALS["steel"], 0.47, held=held, harmonics=6)
        count = row.rollers
        given[angle] = float(races.compliance[:count, :count].sum())
    # a thin tube of area A and radius R under unit loads: where its tension F begins, half of
    # nu F R / (E A) is lost, which the radial loads feel
    R, A = 0.485, np.pi * 0.97 * 0.03
    E, nu = MATERIALS["steel"].youngs_modulus, MATERIALS["steel"].poisson_ratio
    cross = row.rollers**2 * np.sin(0.3) * np.cos(0.3) * nu * R / (2.0 * E * A)
    thickness = 0.03 / R
    assert given[-0.3] - given[0.3] == pytest.approx(4.0 * cross, rel=2.0 * thickness)


def test_rigid_races_are_the_bearing_by_itself() -> None:
    alone = equilibrium(BEARING, LOADS, tolerance=1e-12)
    found = equilibrium_on_races(rigid_races(BEARING), LOADS, tolerance=1e-12)
    assert found.converged.all()
    assert np.abs(found.rollers - alone.rollers).max() < 1e-9 * alone.rollers.max()
    assert np.abs(found.displacements - alone.displacements).max() < 1e-12


def test_stiffer_races_come_to_rigid_ones_in_proportion(soft: Races) -> None:
    alone = equilibrium(BEARING, LOADS, tolerance=1e-12).rollers
    hard, harder = (
        np.abs(equilibrium_on_races(soft.stiffened(f), LOADS, shapes=200).rollers - alone).max()
        for f in (1e4, 1e5)
    )
    assert harder / hard == pytest.approx(0.1, rel=0.01)


def test_rollers_balance_the_load_and_deflect_the_races(soft: Races) -> None:
    found = equilibrium_on_races(soft, LOADS, shapes=200, tolerance=1e-12)
    assert found.converged.all()
    size = np.array([1.0, 1.0, 1.0, BEARING.arm, BEARING.arm])
    assert np.abs(found.unbalanced / size).max() < 1e-6 * 1e5
    given = np.hstack([found.rollers, found.moments]) @ soft.compliance
    assert np.abs(found.recession - given).max() < 1e-9 * np.abs(given).max()


def test_loads_times_two_are_rollers_times_two_where_contacts_are_linear(soft: Races) -> None:
    rows = BEARING.with_rows(law=linear(2e9))
    races = Races(rows, soft.compliance)
    one, two = (equilibrium_on_races(races, f * LOADS).rollers for f in (1.0, 2.0))
    assert np.abs(two - 2.0 * one).max() < 1e-6 * one.max()


def test_rollers_at_a_given_motion_are_those_of_newton_on_their_own_approaches(soft: Races) -> None:
    short = BEARING.with_rows(laminae=1)
    races = Races(short, soft.compliance)
    found = equilibrium_on_races(races, LOADS, shapes=200, tolerance=1e-12)
    approach, _ = roller_motions(short)
    total, law = sum(short.counts), short.rows[0].law
    for u, rollers in zip(found.displacements, found.rollers, strict=True):
        C = races.compliance[:total, :total]
        other = roller_forces(C, approach @ u, law.stiffness, law.exponent)
        assert np.abs(rollers - other).max() < 1e-6 * other.max()


def test_preloaded_linear_contacts_are_springs_in_series_with_the_races(soft: Races) -> None:
    k, total = 2e9, sum(BEARING.counts)
    rows = BEARING.with_rows(law=linear(k), clearance=-5e-4)
    assert isinstance(BEARING.rows[0], RollerRow)
    lean = k * BEARING.rows[0].length ** 2 / 12.0
    softness = np.diag(np.r_[np.full(total, 1 / k), np.full(total, 1 / lean)])
    H = np.vstack(roller_motions(rows))
    series = H.T @ np.linalg.solve(softness + soft.compliance, H)
    races = Races(rows, soft.compliance)
    rest, moved = (
        equilibrium_on_races(races, F, shapes=200, tolerance=1e-13).displacements
        for F in (np.zeros(5), 1e-2 * LOADS)
    )
    assert (moved - rest) @ series == pytest.approx(1e-2 * LOADS, rel=1e-5, abs=0.1)


def test_few_shapes_and_few_harmonics_are_enough(soft: Races) -> None:
    races = annulus(BEARING)
    whole = equilibrium_on_races(races, LOADS, shapes=200).rollers.max(axis=1)
    few = equilibrium_on_races(races, LOADS).rollers.max(axis=1)
    assert len(races.shapes()[1]) < 80
    assert few == pytest.approx(whole, rel=3e-3)
    low = equilibrium_on_races(annulus(BEARING, harmonics=18), LOADS, shapes=200)
    assert low.rollers.max(axis=1) == pytest.approx(whole, rel=2e-3)


def test_solids_come_to_the_compliance_of_the_harmonics() -> None:
    part = Ring(
        kind="ring", width=WIDTH, raceway_diameter=2 * OUTSIDE, bore_diameter=2 * BORE, x=0.0
    )
    block = {part.name: Housing(centre_height=0.7, foot_length=1.6)}
    # loads that go as harmonics 0, 2 and 4; a slope would need a finer mesh
    rollers = cylindrical("cylindrical", 36, 0.06, 0.12, 0.7874, laminae=0)
    waves = np.zeros((72, 3))
    waves[:36] = np.cos(np.outer(angles(rollers.rows[0]), [0, 2, 4]))
    exact = waves.T @ annulus(rollers, order=6).compliance @ waves
    errors = []
    for h in (0.1, 0.06):
        sizes = MeshSizes(bearing=h, bearing_edge=h, housing=0.3, elements_per_turn=24)
        mesh = generate(None, [part], block, sizes, frozenset())
        rows = contact_rows(mesh, f"{part.name}.bore", 0.0, rollers) @ waves
        C = contact_compliance(mesh, part.name, MATERIALS["steel"], rows, f"{part.name}.outer")
        errors.append(np.abs(C.diagonal() / exact.diagonal() - 1.0))
    assert (errors[1] < errors[0]).all()
    assert errors[1].max() < 0.05


def test_what_is_no_compliance_is_refused() -> None:
    size = 2 * sum(BEARING.counts)
    with pytest.raises(InputError, match="no negative eigenvalue"):
        Races(BEARING, -np.eye(size))
    with pytest.raises(InputError, match="shape"):
        Races(BEARING, np.eye(3))
    with pytest.raises(InputError, match="row of balls"):
        Races(catalogue_bearing("masta_ball"), np.eye(14))
