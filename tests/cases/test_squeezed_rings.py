"""A ring between two opposite loads: its formulas, and the load that they share."""

import numpy as np
import pytest
from scipy.integrate import quad

from fe_drivetrain.cases.references.plane_rings import plane_strain
from fe_drivetrain.cases.verification.squeezed_rings import ACROSS, ALONG, SqueezedRing

PLANE = plane_strain(206e9, 0.3)


def squeezed(ratio: float) -> SqueezedRing:
    return SqueezedRing(0.33, ratio, 1e6, PLANE)


def test_pressure_has_the_force_as_its_resultant() -> None:
    ring = squeezed(5.0)
    found, _ = quad(
        lambda t: float(ring.pressure(np.array(t))) * np.cos(t) * ring.outer,
        -ring.reach,
        ring.reach,
    )
    assert found == pytest.approx(ring.force, rel=1e-10)


def test_formulas_agree_to_the_square_of_wall_over_radius() -> None:
    for ratio in (20.0, 60.0):
        ring = squeezed(ratio)
        closing = -ring.series()[ALONG]
        assert ring.curved_beam() == pytest.approx(closing, rel=2.0 / ratio**2)
        assert ring.thin() == pytest.approx(closing, rel=4.0 / ratio**2)


def test_a_thin_ring_opens_across_as_an_inextensible_one() -> None:
    """Inextensible: 2 / pi - 1 / 2 of W R^3 / E I across, pi / 4 - 2 / pi along."""
    found = squeezed(60.0).series()
    expected = (2.0 / np.pi - 0.5) / (np.pi / 4.0 - 2.0 / np.pi)
    assert -found[ACROSS] / found[ALONG] == pytest.approx(expected, rel=4.0 / 60.0**2)


@pytest.mark.parametrize("ratio", [2.0, 20.0])
def test_elements_of_a_quarter_grow_away_from_the_load(ratio: float) -> None:
    coarse, fine = (squeezed(ratio).boundaries(level) for level in (1, 3))
    assert fine[::3] == pytest.approx(coarse, abs=1e-14)
    assert coarse[0] == 0.0
    assert coarse[1] == pytest.approx(0.5 / ratio)
    assert coarse[-1] == 0.5 * np.pi
    lengths = np.diff(coarse)
    assert lengths.min() > 0.0
    assert lengths.max() <= 1.5 / ratio * (1.0 + 1e-12)
