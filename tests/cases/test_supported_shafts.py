"""Solid shafts under exact loads and on supports: what theory says of them, on coarse meshes."""

import numpy as np
import pytest

from fe_drivetrain.cases.references import solid_shafts
from fe_drivetrain.cases.references.exact_shafts import (
    bent,
    flexed,
    neutral_shear,
    pulled,
    tip_deflection,
    twisted,
)
from fe_drivetrain.cases.references.shaft_theory import Tube, sag
from fe_drivetrain.cases.references.supported_shafts import Load, SupportedShaft
from fe_drivetrain.cases.references.torsion_meridian import series_stiffness, torsion_bounds
from fe_drivetrain.drivetrain_file.materials import MATERIALS

STEEL = MATERIALS["steel"]
TUBE = Tube(0.4, 0.28, 0.8, STEEL)
FORCE = 1e6
SPAN = Tube(0.4, 0.0, 2.4, STEEL)
PINNED = SupportedShaft(SPAN, (0.0, 1.2, 2.4), ((np.inf, 0.0), (0.0, 0.0), (np.inf, 0.0)))


def test_linear_displacements_are_exact_on_any_mesh() -> None:
    assert pulled(TUBE, 1e8, 1).error < 1e-8


def test_bending_tractions_carry_the_moment_of_the_curvature() -> None:
    shaft = bent(TUBE, 1e-3, 2)
    assert shaft.rear_moment == pytest.approx(1e-3 * TUBE.EI, rel=0.01)
    assert shaft.error < 0.01
    assert np.all(np.diff(shaft.angle) > 0)


def test_flexure_bends_and_shears_as_cowper_has_it() -> None:
    shaft = flexed(TUBE, FORCE, 2)
    closed = FORCE * (TUBE.length**3 / (3 * TUBE.EI) + TUBE.length / TUBE.kGA)
    assert tip_deflection(shaft) == pytest.approx(closed, rel=0.01)


def test_a_thin_tube_has_twice_the_mean_shear_on_its_neutral_axis() -> None:
    thin = Tube(0.4, 0.39, 0.8, STEEL)
    found, exact, largest = neutral_shear(flexed(thin, FORCE, 1), FORCE)
    assert exact == pytest.approx(2 * FORCE / thin.area, rel=0.02)
    assert largest == pytest.approx(exact, rel=0.05)
    assert found == pytest.approx(exact, rel=0.5)


def test_a_twist_stores_the_work_of_its_torque() -> None:
    shaft, by_torque, by_energy = twisted(TUBE, 1e-3, 1)
    assert by_torque == pytest.approx(by_energy, rel=1e-8)
    assert shaft.exact[:, 0] == pytest.approx(0.0)
    assert shaft.error < 0.05


def test_frame_and_brackets_are_one_beam() -> None:
    for load in (Load(1, force=FORCE), Load(2, moment=FORCE), Load(1, gravity=-9.81)):
        frame, beam = PINNED.frame(load), PINNED.beam(load)
        assert frame.motions == pytest.approx(beam.motions, rel=1e-9, abs=1e-15)
        assert frame.reactions == pytest.approx(beam.reactions, rel=1e-9, abs=1e-6)


def test_the_solid_is_the_beam_that_is_held_evenly() -> None:
    load = Load(1, force=FORCE)
    _, C = PINNED.compliance(2)
    found, evenly, softer = PINNED.solid(C, load), PINNED.evenly(load), PINNED.softer(load)
    assert found.motions[1, 0] == pytest.approx(evenly.motions[1, 0], rel=0.02)
    assert found.reactions[[0, 2], 0] == pytest.approx(-FORCE / 2, rel=1e-6)
    # softer supports move mid span farther, and determinate reactions not at all
    assert softer.motions[1, 0] > evenly.motions[1, 0]
    assert softer.reactions == pytest.approx(evenly.reactions)


def test_a_fixed_shaft_sags_as_a_cantilever() -> None:
    shaft = SupportedShaft(SPAN, (0.0, 2.4), ((np.inf, np.inf), (0.0, 0.0)))
    q = STEEL.density * SPAN.area * -9.81
    tip = shaft.frame(Load(1, gravity=-9.81)).motions[1, 0]
    assert tip == pytest.approx(sag(q, SPAN.EI, SPAN.kGA, 2.4), rel=1e-9)


def test_plane_sections_are_stiffer_than_both_bounds() -> None:
    G = STEEL.shear_modulus
    for shaft in (
        solid_shafts.stepped((0.6, 0.4), 0.6),
        solid_shafts.cone((0.15, 0.3), 20.0),
    ):
        bounds = torsion_bounds(shaft, G, 0.1, 1)
        assert bounds.lower < bounds.upper < series_stiffness(shaft, G)


def test_a_slight_cone_is_as_stiff_as_the_cylinder_between() -> None:
    G = STEEL.shear_modulus
    cone = solid_shafts.cone((0.2, 0.2001), 0.01)
    tube = Tube(0.4001, 0.0, cone.length, STEEL)
    cylinder = tube.GJ / tube.length
    assert series_stiffness(cone, G) == pytest.approx(cylinder, rel=1e-5)
