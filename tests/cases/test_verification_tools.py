"""What the code-verification cases measure with can tell right from wrong."""

import numpy as np
import pytest

from fe_drivetrain.cases.references import distorted_blocks, manufactured
from fe_drivetrain.cases.verification import condensed_bodies
from fe_drivetrain.cases.verification.round_shafts import Bush
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.operator.loads import body_loads


@pytest.mark.parametrize("waves", [manufactured.three_waves(), manufactured.plane_waves()])
def test_closed_forms_are_the_derivatives_and_a_wrong_one_is_seen(waves):
    x = np.random.default_rng(1).uniform(-1.0, 1.0, (50, 3))
    assert max(waves.derivative_errors(x)) < 1e-13

    class Wrong(manufactured.PlaneWaves):
        def body_force(self, x):
            return 1.001 * super().body_force(x)

    wrong = Wrong(waves.amplitudes, waves.wave_vectors, waves.phases, waves.lame)
    gradient, force = wrong.derivative_errors(x)
    assert gradient < 1e-13
    assert force == pytest.approx(1e-3, rel=1e-6)


def test_force_in_the_volume_balances_the_tractions_on_the_surface():
    # independent of pointwise derivatives: the divergence theorem on a curved body
    waves = manufactured.three_waves()
    block = brick((6, 12, 6), 27, manufactured.quarter_ring)
    on_faces = np.zeros(3)
    for facets in block.faces.values():
        at = facet_points(block.points, facets)
        traction = np.einsum("fqij,fqj->fqi", waves.stress(at.positions), at.normals)
        on_faces += np.einsum("fq,fqi->i", at.areas, traction)
    inside = body_loads(block.points, block.cells, waves.body_force).reshape(-1, 3).sum(axis=0)
    assert np.abs(inside + on_faces).max() < 1e-6 * np.abs(on_faces).max()


@pytest.mark.parametrize("nodes", [4, 8, 10, 20, 27])
def test_error_norms_of_a_field_that_is_five_percent_too_large(nodes):
    block = distorted_blocks.patch("any", nodes, 0.1, 0.03).block
    gradient = np.array([[1.0, 2.0, 0.0], [0.5, -1.0, 3.0], [0.0, 0.7, 0.2]])

    class Linear:
        def displacement(self, x):
            return x @ gradient.T

        def gradient(self, x):
            return np.broadcast_to(gradient, (*x.shape, 3))

    u = 1.05 * (block.points @ gradient.T).ravel()
    errors = manufactured.relative_errors(
        block.points, block.cells, u, Linear(), manufactured.LAME, degree=4
    )
    assert errors == pytest.approx((0.05, 0.05), rel=1e-10)


def test_gradient_is_that_of_the_displacement():
    exact = Bush()
    x, step = np.array([[0.2, 0.25, -0.1]]), 1e-6
    columns = [
        (exact.displacement(x + step * e) - exact.displacement(x - step * e)) / (2 * step)
        for e in np.eye(3)
    ]
    found, expected = exact.gradient(x)[0], np.column_stack([c[0] for c in columns])
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()


def test_rank_is_decided_by_the_widest_gap():
    values = np.array([0.0, -3e-16, 1e-15, 0.0, 2e-15, 1e-16, 1e-3, 0.1, 0.5, 0.9, 1.0, 1.0])
    assert condensed_bodies.zeros_by_gap(values)[0] == 6
    values[5] = 1e-4  # one zero mode too few: the body is held somewhere
    assert condensed_bodies.zeros_by_gap(values)[0] == 5


def test_order_of_a_series_of_known_order():
    sizes = [0.4, 0.2, 0.1]
    errors = {"L2 norm": [3.0 * h**3 for h in sizes], "energy norm": [h**1.5 for h in sizes]}
    series = manufactured.Series("any", sizes, [1, 2, 3], errors, dict.fromkeys(errors, 2.0))
    assert series.order("L2 norm") == pytest.approx((3.0, 0.0))
    assert series.order("energy norm") == pytest.approx((1.5, 0.0))


@pytest.mark.parametrize("nodes", [10, 20, 27])
def test_under_integration_fails_the_patch_test_only_where_elements_are_curved(nodes):
    straight, curved = (distorted_blocks.patch("any", nodes, 0.1, by) for by in (0.0, 0.05))
    stress = np.diag([1.0, 0.0, 0.0])
    assert distorted_blocks.inner_forces(curved, stress, 6) < 1e-13
    assert distorted_blocks.inner_forces(curved, stress, 2) > 1e-4
    assert distorted_blocks.inner_forces(straight, stress, 2) < 1e-13
    low, high = distorted_blocks.forces_by_degree(curved, (2, 6))
    assert high < 1e-13 < distorted_blocks.inner_forces(curved, stress, 2) <= low
