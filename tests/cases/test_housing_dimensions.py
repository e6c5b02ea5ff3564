"""Housings by a few dimensions: what follows from what, and K_R on a stub of the shaft."""

import numpy as np
import pytest

from fe_drivetrain.cases.main_bearing import housing_dimensions as housings
from fe_drivetrain.cases.main_bearing.housing_dimensions import BOLTED, ONE_BODY, STEEL, WIDTH
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene

PLATE = np.array([0.14, 0.11, 0.5, 0.95, 0.1])


@pytest.fixture(scope="module")
def scene():
    return library_scene("main_bearing_bonded")


def test_the_librarys_housing_is_among_them(scene):
    """The foot and the bolts that follow are those of the library's own dimensions."""
    own = scene.bearing_units[0].housing
    x = np.array([getattr(own, d.name) for d in housings.DIMENSIONS])
    made = housings.housed(scene, BOLTED, x).bearing_units[0]
    for name in ("foot_length", "foot_width", "bolt_spacing_x", "bolt_spacing_y"):
        assert getattr(made.housing, name) == pytest.approx(getattr(own, name))
    assert made.bearing.width == scene.bearing_units[0].bearing.width


def test_no_housing_is_narrower_than_its_ring(scene):
    assert BOLTED.low[WIDTH] == BOLTED.ring
    made = housings.housed(scene, ONE_BODY, PLATE).bearing_units[0]
    assert made.bearing.width == made.housing.width


def test_all_moduli_twice_as_large_double_the_stiffness(scene):
    plate = housings.housed(scene, ONE_BODY, PLATE)
    once = housings.solved(plate, housings.COARSE)
    twice = housings.solved(housings.with_moduli(plate, 2.0), housings.COARSE)
    np.testing.assert_allclose(twice.K_R, 2.0 * once.K_R, rtol=1e-8)


def test_a_steel_housing_is_stiffer_by_no_more_than_its_modulus(scene):
    iron, steel = (
        housings.solved(housings.housed(scene, form, PLATE), housings.COARSE).K_R
        for form in (ONE_BODY, STEEL)
    )
    assert (steel > iron).all()
    # a plate that cannot contract sideways is stiffer by 1 / (1 - nu^2): the ratios differ
    sideways = (1 - 0.275**2) / (1 - 0.3**2)
    assert (steel < 200.0 / 169.0 * sideways * iron).all()


def test_a_stub_of_the_shaft_is_enough(scene):
    """K_R belongs to the unit: another length of shaft before and behind it changes little."""
    plate = housings.housed(scene, ONE_BODY, PLATE)
    stub = housings.solved(plate, housings.COARSE).K_R
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(housings, "_STUB", 0.9)
        long = housings.solved(plate, housings.COARSE).K_R
    np.testing.assert_allclose(stub, long, rtol=0.02)


def test_the_mass_is_that_of_the_mesh(scene):
    from fe_drivetrain.shafts.response.model import build_model, mesh_scene

    plate = housings.housed(scene, ONE_BODY, PLATE)
    stub = housings.stub(plate, housings.COARSE)
    model = build_model(stub, mesh_scene(stub))
    mesh = model.mesh
    cells = mesh.cells[mesh.part_cells("main_bearing.housing")][:, :4]
    corners = mesh.points[cells]
    volume = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])).sum() / 6.0
    density = plate.material_of("main_bearing.housing").density
    # straight edges of a coarse mesh: chords of the bore, 12 or more a turn
    assert housings.mass(plate) == pytest.approx(density * volume, rel=0.05)


def test_the_nominal_stress_is_that_of_a_rectangular_beam(scene):
    plate = housings.housed(scene, ONE_BODY, PLATE)
    inertia = 0.95 * 0.14**3 / 12.0
    assert housings.stress_at_foot(plate, 2e6) == pytest.approx(2e6 * 0.07 / inertia)


def test_a_housing_whose_bore_breaks_through_is_left_out(scene):
    from fe_drivetrain.cases.main_bearing.calibration import fitted, hypercube

    wide = {"bearing.raceway_diameter": 0.9, "housing.centre_height": 0.6}
    low = change_scene(scene, {f"bearing_units.0.{key}": value for key, value in wide.items()})
    x = hypercube(housings.LOW, housings.HIGH, 12)
    surface = fitted(x, np.ones((12, 2)), 1)
    assert housings.Aim(scene, ONE_BODY, surface, np.ones(2), 0.005).met_by(PLATE)
    assert not housings.Aim(scene, ONE_BODY, surface, np.full(2, 2.0), 0.005).met_by(PLATE)
    lower = housings.Aim(low, ONE_BODY, surface, np.ones(2), 0.005)
    assert not lower.met_by(PLATE * [1, 1, 0.85, 1, 1])
    with pytest.raises(InputError):
        housings.solved(housings.housed(low, ONE_BODY, PLATE * [1, 1, 0.85, 1, 1]), housings.COARSE)
