"""Bands of a stiffness by kind of motion, and the band of the meridian by its orders."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain import export
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.stiffness_bands import KINDS, StiffnessBands
from fe_drivetrain.comparison.convergence import clipped_order
from fe_drivetrain.export.formats.statement import comment_lines, commented, element_of, statement
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.shafts.fidelity.shaft_bands import band_of_orders

#: A stiffness at one point whose kinds have sizes of their own.
K = np.diag([4e9, 2e9, 2e9, 5e7, 3e8, 3e8])


def test_each_kind_has_the_largest_difference_of_its_own_motions() -> None:
    reference = np.kron(np.eye(2), K)
    matrix = reference.copy()
    for dof, share in ((0, 0.01), (3, 0.002), (9, 0.001), (1, 0.03), (10, 0.04)):
        matrix[dof, dof] *= 1.0 + share
    found = StiffnessBands.of_difference(matrix, reference)
    assert list(found) == pytest.approx([0.01, 0.002, 0.04])
    assert found.largest == pytest.approx(0.04)
    matrix[0, 4] = matrix[4, 0] = reference[0, 4] - 0.5 * np.sqrt(K[0, 0] * K[4, 4])
    # an entry between two kinds counts in both
    assert list(StiffnessBands.of_difference(matrix, reference)) == pytest.approx([0.5, 0.002, 0.5])


def test_no_entry_of_a_semidefinite_error_is_outside_of_bands_of_the_diagonal() -> None:
    rng = np.random.default_rng(3)
    root = rng.standard_normal((12, 4)) * 10.0 ** rng.uniform(2, 4, 12)[:, None]
    stiffness = np.kron(np.eye(2), K)
    error = root @ root.T
    bands = StiffnessBands.of_motions(error.diagonal() / stiffness.diagonal())
    assert (np.abs(error) <= bands.half_widths(stiffness) * (1 + 1e-12)).all()
    assert np.abs(scaled_to_unit_diagonal(error, stiffness.diagonal())).max() <= bands.largest


def test_bands_of_two_causes_add_and_of_two_estimates_the_wider_one_holds() -> None:
    one, other = StiffnessBands(0.01, 0.2, 0.03), StiffnessBands(0.02, 0.1, 0.03)
    assert list(one + other) == pytest.approx([0.03, 0.3, 0.06])
    assert one | other == StiffnessBands(0.02, 0.2, 0.03)
    assert StiffnessBands.uniform(0.1).are_numbers
    assert not StiffnessBands(0.1, -0.1, 0.1).are_numbers
    assert not StiffnessBands(0.1, 0.1, float("inf")).are_numbers


@pytest.mark.parametrize("order", [4, 6])
@pytest.mark.parametrize("exponent", [0.5, 0.545, 2.0 / 3.0, 1.0, 2.0])
def test_the_band_of_orders_is_two_to_five_times_the_error(order: int, exponent: float) -> None:
    """Energy of singular stresses falls as (p + 0.4)^(-4 a), which is slower than at p = infinity.

    Before, the band was 1.25 times the error where a is that of a step, and the order 4.
    """
    before, here, after = ((p + 0.4) ** (-4.0 * exponent) for p in range(order - 1, order + 2))
    band = band_of_orders(order, before - here, here - after)
    assert 2.0 < band / here < 5.0


def test_orders_whose_changes_do_not_shrink_are_taken_at_half_of_a_cracks_rate() -> None:
    assert band_of_orders(4, 1e-3, 2e-3) == pytest.approx(1.25 * 2e-3 / (1 - 4 / 5))
    assert band_of_orders(4, 1e-3, 1e-9) == pytest.approx(1.25 * 1e-9 / (1 - (4 / 5) ** 2))
    assert band_of_orders(4, 1e-3, 0.0) == 0.0


def test_an_order_beyond_those_looked_for_is_taken_at_their_nearer_end() -> None:
    sizes = np.array([0.4, 0.2, 0.1])
    assert clipped_order(sizes, sizes**3.0) == pytest.approx(3.0)
    assert clipped_order(sizes, sizes**9.0) == 8.0
    assert clipped_order(sizes, sizes**0.1) == 0.2
    assert clipped_order(sizes, [3.0, 2.0, 0.0]) == 0.2


def unit() -> Superelement:
    band = StiffnessBands(0.01, 0.002, 1.0 / 3.0)
    return Superelement("unit", ("seat",), np.zeros((1, 3)), K, None, True, band)


def test_json_keeps_the_bands_and_reads_the_earlier_form(tmp_path: Path) -> None:
    file = tmp_path / "unit.json"
    export.write_superelement(file, unit(), "json")
    content = json.loads(file.read_text())
    assert content["schema_version"] == 3
    assert content["band"] == dict(zip(KINDS, (0.01, 0.002, 1.0 / 3.0), strict=True))
    assert export.read_superelement(file, "json").band == unit().band
    for stated, found in ((0.07, StiffnessBands.uniform(0.07)), (None, None)):
        file.write_text(json.dumps(content | {"schema_version": 1, "band": stated}))
        assert export.read_superelement(file, "json").band == found


def test_texts_state_the_bands_and_are_read_in_the_earlier_form(tmp_path: Path) -> None:
    said = commented(comment_lines(statement(unit()), "%"), "%")
    found = element_of(tmp_path / "unit.txt", said, K, None)
    assert found.band == unit().band
    assert element_of(tmp_path / "a", said | {"band": "0.07 of the stiffness"}, K, None).band == (
        StiffnessBands.uniform(0.07)
    )
    open_one = statement(replace(unit(), band=None))
    assert open_one["band"] == "not known"
    assert element_of(tmp_path / "b", open_one, K, None).band is None
