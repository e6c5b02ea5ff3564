"""What rounding does, against matrices whose entries were changed in their last digits."""

import numpy as np

from fe_drivetrain.elasticity.interfaces.constraints import eliminate, fixed
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.elasticity.solve.reduction import reduce
from fe_drivetrain.elasticity.solve.rounding import judged, round_off


def rod(slenderness):
    block = brick((10, 1, 1), 27, lambda p: p * [slenderness, 1.0, 1.0])
    K = assemble(block.points, block.cells, (1.0, 1.0))
    elimination = eliminate([fixed("wall", block.face_nodes("x0"), block.points.size)], K.shape[0])
    system = reduce(block.points, block.cells, K, elimination)
    F = np.zeros((K.shape[0], 1))
    F[3 * block.face_nodes("x1") + 2] = 1.0
    return system, F


def test_bounds_what_a_change_of_the_last_digits_does(rng):
    system, F = rod(30.0)
    K = system.K.toarray()
    x = np.linalg.solve(K, F)
    bound = round_off(system.K, x)
    work = float(F[:, 0] @ x[:, 0])
    eps = 4.0 * np.finfo(float).eps
    for _ in range(5):
        noise = 1e4 * eps * rng.choice([-1.0, 1.0], size=K.shape)
        other = K * (1.0 + np.triu(noise) + np.triu(noise, 1).T)
        changed = float(F[:, 0] @ np.linalg.solve(other, F)[:, 0]) / work - 1.0
        assert abs(changed) < 1.05 * 1e4 * bound
    # the worst signs reach it
    signs = np.sign(np.outer(x, x) * K)
    worst = K * (1.0 - 1e3 * eps * signs)
    changed = float(F[:, 0] @ np.linalg.solve(worst, F)[:, 0]) / work - 1.0
    np.testing.assert_allclose(changed, 1e3 * bound, rtol=0.01)


def test_grows_as_the_fourth_power_of_slenderness():
    """More precisely: energy of one element over that of bending."""
    bounds = []
    for slenderness in (50.0, 100.0):
        system, F = rod(slenderness)
        bounds.append(round_off(system.K, np.linalg.solve(system.K.toarray(), F)))
    assert 3.5 < np.log2(bounds[1] / bounds[0]) < 4.5


def test_nothing_moves_and_nothing_is_lost():
    system, F = rod(5.0)
    assert round_off(system.K, np.zeros_like(F)) == 0.0


def test_one_pass_says_the_residual_of_the_worst_column(rng):
    system, F = rod(5.0)
    x = rng.standard_normal((F.shape[0], 3))
    right = np.hstack([F, system.K @ x[:, 1:2], np.zeros_like(F)])
    found = judged(system.K, x, right)
    left = np.linalg.norm(right - system.K @ x, axis=0)
    np.testing.assert_allclose(found.residual, max(left[0] / np.linalg.norm(F), left[2]))
    assert left[1] < 1e-9 * left[0]
    assert found.round_off == round_off(system.K, x)
