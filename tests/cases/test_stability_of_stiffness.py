"""What the cases on stiffness contrast, penalties and precision stand on."""

import numpy as np
import pytest
from scipy import sparse

from fe_drivetrain.cases.references import layers
from fe_drivetrain.cases.stability import fingerprints, other_precisions, penalised_couplings
from fe_drivetrain.comparison.sweeps import decades, fitted_exponent, safe_range
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.operator.elasticity import assemble


def test_safe_range_is_the_run_about_the_least_error():
    x = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    assert safe_range(x, [0.1, 0.5, 0.1, 0.01, 0.2, 0.9], 0.3) == (3.0, 5.0)
    assert safe_range(x, [0.1, 0.1, 0.1, 0.01, 0.2, np.nan], 0.3) == (None, 5.0)
    assert safe_range(x, [0.1] * 6, 0.3) == (None, None)


def test_no_safe_point_is_an_error():
    with pytest.raises(ValueError, match="no point"):
        safe_range([1.0, 2.0], [0.5, np.nan], 0.3)


def test_exponent_of_a_power_within_bounds():
    x = decades(0, 6, 2)
    y = 3.0 * x**-1.5
    y[0], y[-1] = 1e9, 1e-30  # outside of the bounds
    assert fitted_exponent(x, y, (1e-20, 1e3))[0] == pytest.approx(-1.5, rel=1e-12)
    assert np.isnan(fitted_exponent([1.0], [1.0])[0])


def test_assembly_in_any_precision_is_the_library_s():
    """Two implementations, one operator; in 32 bits to 32 bits."""
    solid = other_precisions.tube(3.0, 4, 2)
    n = solid.points.size
    own = assemble(solid.points.astype(float), solid.cells, MATERIALS["steel"].lame).tocsr()
    own = own[solid.free][:, solid.free]
    size = abs(own).max()
    for kind, tolerance in ((np.float64, 1e-13), (np.float32, 1e-4)):
        K = other_precisions.summed(solid, kind)
        assert K.dtype == kind
        assert abs(sparse.csr_array(K.astype(float)) - own).max() < tolerance * size
    assert n > len(solid.free)


def test_refined_solution_fulfils_its_equations_beyond_double_precision():
    solid = other_precisions.tube(3.0, 4, 2)
    K, long = (other_precisions.summed(solid, kind) for kind in (np.float64, np.longdouble))
    u = other_precisions.refined(long, K, solid.load, 10)
    f = solid.load.astype(np.longdouble)
    residual = np.abs(f - other_precisions._product(long, u)).max() / np.abs(f).max()
    once = np.abs(
        f
        - other_precisions._product(
            long, other_precisions.solved(K, solid.load).astype(np.longdouble)
        )
    )
    assert residual < 1e-2 * once.max() / np.abs(f).max()


@pytest.mark.parametrize("contrast", [1e-3, 1.0, 1e3])
def test_shaft_in_a_ring_is_two_springs_in_series(contrast):
    ring = layers.ring()
    whole = layers.direct(*ring.system((1.0, 1.0))).compliance
    alone = layers.direct(*ring.system((1.0, 1.0), rigid=(1,))).compliance
    expected = alone / contrast + (whole - alone)
    assert layers.direct(*ring.system((contrast, 1.0))).compliance == pytest.approx(
        expected, rel=1e-9
    )
    # plane shear between cylinders, within what so few straight elements leave
    a, b, width, G = 0.2, 0.3, 0.1, layers.E / 2.6
    assert alone == pytest.approx((1 / a**2 - 1 / b**2) / (4 * np.pi * G * width), rel=0.02)


def test_chain_is_springs_in_series_and_rigid_ones_give_nothing():
    chain = layers.chain(4)
    moduli = [1.0, 7.0, 0.3, 20.0]
    found = layers.direct(*chain.system(moduli)).compliance
    assert found == pytest.approx(sum(1.0 / m for m in moduli) / layers.E, rel=1e-12)
    rigid = layers.direct(*chain.system(moduli, rigid=(1, 3))).compliance
    assert rigid == pytest.approx((1.0 + 1.0 / 0.3) / layers.E, rel=1e-12)


@pytest.mark.parametrize("kind", penalised_couplings.KINDS)
def test_a_penalty_is_too_soft_and_tends_to_elimination(kind):
    bar = penalised_couplings.bar(kind, 1 if kind != "tie" else 2)
    exact = penalised_couplings.work(*penalised_couplings.eliminated(bar), "superlu")
    soft, stiff = (
        penalised_couplings.work(*penalised_couplings.penalised(bar, p), "superlu")
        for p in (1e2, 1e5)
    )
    assert (soft > exact).all()
    assert (stiff > exact).all()
    assert ((stiff / exact - 1.0) < 2e-3 * (soft / exact - 1.0)).all()


def test_bits_are_told_apart():
    a = {"x": np.array([1.0, 2.0]), "y": np.array([3.0])}
    b = {"x": np.array([1.0, np.nextafter(2.0, 3.0)]), "y": np.array([3.0])}
    assert fingerprints.different(a, b) == ["x"]
    assert fingerprints.different(a, a) == []
