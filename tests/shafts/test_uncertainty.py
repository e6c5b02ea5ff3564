"""Sensitivities, samples and shares against what closed forms say."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from numpy.testing import assert_allclose
from scipy import stats

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.uncertainty.sampling import (
    Samples,
    nominal_value,
    sample,
    sensitivities,
    sobol_shares,
    variance_shares,
    with_values,
)

DIAMETER = "shaft.sections.0.outer_diameter"
LENGTH = "shaft.sections.0.length"
MODULUS = "materials.steel.youngs_modulus"
SMALL = {DIAMETER: {"normal": 0.002}, MODULUS: {"uniform": 0.01}}
#: Variances of the two first-order terms of a power law with exponents 4 and 1.
PARTS = np.array([(4 * 0.002) ** 2, 0.01**2 / 3])


def torsion(scene: Scene) -> dict[str, float]:
    """G J / L of the shaft, and its modulus."""
    G = scene.material_of("shaft").shear_modulus
    twists = [
        section.length / (section.outer_diameter**4 - section.inner_diameter**4)
        for section in scene.shaft.sections
    ]
    return {"stiffness": float(G * np.pi / 32 / sum(twists)), "modulus": G}


def uncertain(spreads: object) -> Scene:
    return change_scene(coarse_scene("spherical"), {"uncertainty": spreads})


@pytest.fixture(scope="module")
def scene() -> Scene:
    return coarse_scene("spherical")


def test_torsion_goes_with_the_fourth_power_of_the_diameter(scene: Scene) -> None:
    found = sensitivities(scene, torsion, [DIAMETER, LENGTH, MODULUS])
    assert found["stiffness"][DIAMETER] == pytest.approx(4.0, rel=1e-4)
    assert found["stiffness"][LENGTH] == pytest.approx(-1.0, rel=1e-4)
    assert found["stiffness"][MODULUS] == pytest.approx(1.0, rel=1e-4)
    assert found["modulus"] == pytest.approx({DIAMETER: 0.0, LENGTH: 0.0, MODULUS: 1.0}, abs=1e-9)


def test_first_order_variance_of_a_power_law() -> None:
    """Small spreads: the variance is that of the first-order terms."""
    count = 256
    found = sample(uncertain(SMALL), torsion, count)["stiffness"]
    # two standard errors of a deviation, and three of a share, from independent samples
    allowed = 2 / np.sqrt(2 * count)
    assert found.values.std() / found.nominal == pytest.approx(np.sqrt(PARTS.sum()), rel=allowed)
    assert found.linear_share > 0.999
    np.testing.assert_allclose(found.contributions(), PARTS / PARTS.sum(), atol=1.5 * allowed)
    assert found.band().low < found.nominal < found.band().high


def test_a_band_is_within_its_own_error_of_the_true_one() -> None:
    """One lognormal value to the first power: its quantiles are known."""
    found = sample(uncertain({MODULUS: {"lognormal": 0.05}}), torsion, count=400)["modulus"]
    band = found.band()
    edge = np.exp(1.959964 * np.sqrt(np.log1p(0.05**2)))
    # independent samples would be within three errors; a hypercube is closer
    assert abs(band.high - found.nominal * edge) < 3 * band.high_error
    assert abs(band.low - found.nominal / edge) < 3 * band.low_error
    assert 0 < band.high_error < 0.2 * (band.high - found.nominal)


def test_more_samples_make_a_band_more_certain(rng: np.random.Generator) -> None:
    values = rng.normal(1.0, 0.1, 6400)
    few, many = (
        Samples(("x",), values[:n, None], values[:n], 1.0).band().high_error for n in (100, 6400)
    )
    # as the root of their number; of 100 the tail has a few values only
    assert few / many == pytest.approx(8.0, rel=0.5)


def test_shares_of_sobol_agree_with_the_plane() -> None:
    found = sobol_shares(uncertain(SMALL), torsion, ["stiffness"], count=256)["stiffness"]
    expected = PARTS / PARTS.sum()
    assert (found.first_error > 0).all()
    assert (np.abs(found.first - expected) < 3 * found.first_error + 1e-3).all()
    assert (np.abs(found.total - expected) < 3 * found.total_error + 1e-3).all()


def test_shares_of_an_interaction_are_seen() -> None:
    """x y, both even within a share w of their mean: first 1 / (2 + w^2 / 3) each."""

    def product(scene: Scene) -> dict[str, float]:
        material = scene.material_of("shaft")
        return {"xy": material.youngs_modulus / 200e9 * material.density / 7850}

    w = 0.99
    even = {"uniform": w}
    first = 1 / (2 + w**2 / 3)
    scene = uncertain({MODULUS: even, "materials.steel.density": even})
    found = sobol_shares(scene, product, ["xy"], count=1024)["xy"]
    assert (np.abs(found.first - first) < 3 * found.first_error).all()
    assert (np.abs(found.total - (1 - first)) < 3 * found.total_error).all()
    assert found.first_error.max() < 0.05


def test_the_same_seed_gives_the_same_to_the_last_bit() -> None:
    scene = uncertain(SMALL)
    one, two, other = (sample(scene, torsion, 64, seed)["stiffness"] for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.values, two.values)
    assert one.band() == two.band()
    assert one.band() != other.band()
    a, b = (sobol_shares(scene, torsion, ["stiffness"], 16, 1)["stiffness"] for _ in range(2))
    np.testing.assert_array_equal(a.first_error, b.first_error)


def test_what_does_not_vary_says_so() -> None:
    found = sample(uncertain({DIAMETER: {"uniform": 0.01}}), torsion, count=50)
    assert found["stiffness"].varies
    assert not found["modulus"].varies
    assert found["modulus"].band().high_error == 0.0


def test_values_by_key(scene: Scene) -> None:
    assert nominal_value(scene, MODULUS) == 200e9
    assert nominal_value(scene, "bearing_units.main_bearing.housing.wall") == 0.11
    assert nominal_value(scene, "gearbox.stiffness.1") == 8e7
    changed = with_values(scene, {MODULUS: 210e9})
    assert changed.material_of("shaft").youngs_modulus == 210e9
    assert changed.material_of("shaft").density == 7850.0


@pytest.mark.parametrize("key", ["shaft.material", "shaft.nothing", "gearbox.stiffness.3", "x.9"])
def test_what_is_no_number_is_refused(scene: Scene, key: str) -> None:
    with pytest.raises(InputError, match="has no number there"):
        nominal_value(scene, key)


@pytest.mark.parametrize(
    ("spread", "message"),
    [
        ({}, "give one of uniform, normal and lognormal, not none"),
        ({"uniform": 0.1, "normal": 0.1}, "not uniform and normal"),
        ({"uniform": -1}, "must be greater than 0"),
        ({"even": 0.1}, "unknown key"),
    ],
)
def test_a_wrong_spread_gets_one_sentence(scene: Scene, spread: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        change_scene(scene, {"uncertainty": {MODULUS: spread}})


def test_a_scene_without_uncertainty_says_how_to_add_some(scene: Scene) -> None:
    with pytest.raises(InputError, match="add some under 'uncertainty'"):
        sample(scene, torsion)


def test_a_spread_of_zero_is_refused() -> None:
    with pytest.raises(InputError, match="the value is 0"):
        uncertain({"bearing_units.main_bearing.bearing.x": {"uniform": 0.1}})


def test_a_sample_that_is_no_scene_names_what_is_wrong() -> None:
    """A bore that may be wider than the shaft."""
    scene = change_scene(
        coarse_scene("spherical"),
        {
            "shaft.sections.0.inner_diameter": 0.3,
            "mesh.shaft": 0.14,
            "uncertainty": {"shaft.sections.0.inner_diameter": {"uniform": 0.9}},
        },
    )
    with pytest.raises(
        InputError, match=r"within its uncertainty gives no valid scene: .*inner_di"
    ):
        sample(scene, torsion)


def test_a_sample_whose_wall_is_thinner_than_the_mesh_allows_has_a_finer_mesh() -> None:
    scene = change_scene(
        coarse_scene("spherical"),
        {"shaft.sections.0.inner_diameter": 0.3, "mesh.shaft": 0.15},
    )
    sizes = [
        with_values(scene, {"shaft.sections.0.inner_diameter": bore}).mesh.shaft
        for bore in (0.29, 0.32)
    ]
    assert sizes == [0.15, 0.075]
    with pytest.raises(InputError, match=r"mesh size 'shaft' is 0\.15 m"):
        with_values(scene, {"shaft.sections.0.inner_diameter": 0.399})


def test_shares_of_any_function_are_those_of_ishigami() -> None:
    """Ishigami and Homma 1990, a = 7, b = 0.1: shares in closed form (Saltelli et al. 2008)."""
    a, b, pi = 7.0, 0.1, np.pi

    def results(rows: np.ndarray) -> np.ndarray:
        x, y, z = rows.T
        return np.array([np.sin(x) + a * np.sin(y) ** 2 + b * z**4 * np.sin(x), 2.0 * x + y])

    inputs = {name: stats.uniform(-pi, 2.0 * pi) for name in "xyz"}
    rough, plane = variance_shares(results, inputs, 1024)
    parts = np.array([0.5 * (1 + b * pi**4 / 5) ** 2, a**2 / 8, 0.0, 8 * b**2 * pi**8 / 225])
    assert_allclose(rough.first, parts[:3] / parts.sum(), atol=0.05)
    with_third = parts[:3] + parts[3] * np.array([1, 0, 1])
    assert_allclose(rough.total, with_third / parts.sum(), atol=0.05)
    assert_allclose(plane.first, [0.8, 0.2, 0.0], atol=0.02)
    assert plane.keys == ("x", "y", "z")
