"""The scaling to a unit diagonal against matrices whose scaled form is known."""

import numpy as np
import pytest

from fe_drivetrain.common.scaling import (
    diagonal_roots,
    max_difference,
    min_eigenvalue,
    scaled_solve,
    scaled_to_unit_diagonal,
    symmetry_error,
)

#: Units of metres and radians with a stiff and a soft direction each.
SIZES = np.array([1e5, 3.0, 1e-4, 7e7])
UNIT = np.array([[1, 0.5, 0, 0.2], [0.5, 1, 0.1, 0], [0, 0.1, 1, -0.3], [0.2, 0, -0.3, 1]])
MATRIX = UNIT * np.outer(SIZES, SIZES)


def test_the_sizes_of_units_drop_out():
    np.testing.assert_allclose(scaled_to_unit_diagonal(MATRIX), UNIT, rtol=1e-15)
    np.testing.assert_allclose(diagonal_roots(MATRIX.diagonal()), SIZES, rtol=1e-15)
    assert min_eigenvalue(MATRIX) == pytest.approx(np.linalg.eigvalsh(UNIT)[0], rel=1e-14)


def test_rows_without_diagonal_stay_as_they_are():
    np.testing.assert_array_equal(
        scaled_to_unit_diagonal(np.diag([4.0, 0.0, -9.0])), np.diag([1.0, 0.0, -9.0])
    )
    assert min_eigenvalue(np.diag([4.0, 0.0, -9.0])) == -9.0


def test_errors_are_relative_to_the_diagonal_of_their_row_and_column():
    change = np.zeros((4, 4))
    change[1, 3] = 0.01
    assert symmetry_error((UNIT + change) * np.outer(SIZES, SIZES)) == pytest.approx(0.01)
    other = MATRIX + change * np.outer(SIZES, SIZES)
    assert max_difference(other, MATRIX) == pytest.approx(0.01)


@pytest.mark.parametrize("shape", [(4,), (4, 3)])
def test_a_scaled_solution_keeps_the_digits_of_every_unknown(shape):
    exact = np.random.default_rng(0).normal(size=shape)
    right = ((UNIT @ exact).T * SIZES).T
    found = (scaled_solve(MATRIX, right).T * SIZES).T
    np.testing.assert_allclose(found, exact, rtol=1e-13)
