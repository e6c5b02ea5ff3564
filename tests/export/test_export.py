"""stiffness.json: round trip, and what it refuses."""

import json

import numpy as np
import pytest
from pydantic import ValidationError

from fe_drivetrain.export.formats.stiffness_file import (
    read_stiffness_json,
    stiffness_matrix,
    write_stiffness_json,
)


@pytest.fixture
def matrix(rng):
    a = rng.standard_normal((6, 6))
    return (a @ a.T + np.eye(6)) * 1e9


def test_round_trip_keeps_every_digit(tmp_path, matrix):
    path = tmp_path / "stiffness.json"
    item = stiffness_matrix("bearing", matrix, np.array([0.1, 0.2, 0.3]), "a test")
    write_stiffness_json(path, "scene", [item], 1000, {"vertical": {"energy": 1 / 3}})
    back = read_stiffness_json(path)
    np.testing.assert_array_equal(np.array(back.matrices[0].matrix), matrix)
    assert back.matrices[0].reference_point == (0.1, 0.2, 0.3)
    assert back.tilt_stiffness["vertical"]["energy"] == 1 / 3
    assert "z up" in back.frame
    data = json.loads(path.read_text())
    assert data["matrices"][0]["units"] == "N/m, N, N m/rad"


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda k: k + 1e8 * np.eye(6, k=1), "not symmetric"),
        (lambda k: -k, "not positive semidefinite"),
        (lambda k: k[:5, :5], "6x6"),
        (lambda k: k * np.nan, "finite"),
    ],
)
def test_refuses_what_is_no_stiffness(matrix, damage, message):
    with pytest.raises(ValidationError, match=message):
        stiffness_matrix("bearing", damage(matrix), np.zeros(3), "")


def test_free_rotations_are_allowed(matrix):
    matrix[3:] = matrix[:, 3:] = 0.0
    assert stiffness_matrix("spherical", matrix, np.zeros(3), "").matrix[5][5] == 0.0
