"""Two sets of histories: seeds alone are not a difference, other physics are."""

from collections.abc import Iterable

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.load_comparison import Feature, LoadSet, compare_sets, features
from fe_drivetrain.studies.load_digest import LoadOptions, digest
from fe_drivetrain.studies.load_reactions import FileDigest
from fe_drivetrain.turbine_loads.histories.sets import differences
from fe_drivetrain.turbine_loads.histories.spectra import spectrum
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import Recorded

OPTIONS = LoadOptions(slopes=(3.0, 10.0), rotor_speed_rpm=45.0 / np.pi)


def set_of(histories: Iterable[Recorded]) -> LoadSet:
    found = LoadSet(OPTIONS.slopes)
    for history in histories:
        found.add(FileDigest(digest(history, OPTIONS)))
    return found


def test_seeds_alone_are_named_as_often_as_chance_has_it(rng: np.random.Generator) -> None:
    draws = rng.standard_normal((800, 7))
    for first in (1, 3):
        named = 0
        for row in draws:
            histories = [{"x": float(v)} for v in row]
            named += differences(histories[:first], histories[first:], 0.05)[0].beyond
        # of 800 at 5 %: 40, with a standard deviation of 6
        assert 16 <= named <= 64


def test_a_shift_beyond_the_scatter_is_named_and_nothing_else() -> None:
    one = [{"a": 10.0 + k, "b": 5.0, "only": 1.0} for k in (-1.0, 0.0, 1.0)]
    other = [{"a": 20.0 + k, "b": 5.0} for k in (-1.0, 0.0, 1.0)]
    found = {d.quantity: d for d in differences(one, other)}
    assert found.keys() == {"a", "b"}
    assert found["a"].beyond
    assert found["a"].ratio == 0.5
    assert found["a"].scatter == pytest.approx(1.0)
    # t of 4 degrees of freedom at 99.5 %: 4.604
    assert found["a"].allowed == pytest.approx(4.604 * np.sqrt(2 / 3), rel=1e-3)
    assert not found["b"].beyond
    with pytest.raises(InputError, match="three or more together"):
        differences(one[:1], other[:1])


def test_features_of_a_history_are_what_its_samples_have(rng: np.random.Generator) -> None:
    time = np.arange(0.0, 61.0, 0.2)

    def history(seed: int, scale: float, wind: Floats) -> Recorded:
        noise = np.random.default_rng(seed).standard_normal((len(time), 6))
        wave = np.cos(3 * 1.5 * time)[:, None] * [0, 0, 0, 0, 1, 0]
        return Recorded(LoadHistory("x", time, 1e4 * scale * (noise + 5.0 * wave)), None, wind)

    wind = np.full(len(time), 8.0)
    one = set_of(history(seed, 1.0, wind) for seed in range(3))
    other = set_of(history(seed, 2.0, wind) for seed in range(3, 6))
    found = features(digest(history(0, 1.0, wind), OPTIONS), OPTIONS.slopes)
    assert one.features["8 m/s"][0] == found
    values = history(0, 1.0, wind).history.loads[:, 4]
    by_name = {str(feature): value for feature, value in found.items()}
    assert by_name["My, mean [kN m]"] == pytest.approx(values.mean() / 1e3)
    assert found[Feature("", "My", "standard deviation", "kN m")] == pytest.approx(
        values.std() / 1e3
    )
    assert by_name["My, 3P [kN m]"] == pytest.approx(50.0, rel=0.1)
    compared = compare_sets(one, other, ("old", "new"))
    (at_wind,) = compared.winds
    assert at_wind.wind == "8 m/s"
    named = {one.quantity: one.ratio for one in at_wind.beyond}
    assert named["My, standard deviation [kN m]"] == pytest.approx(0.5, rel=0.1)
    assert "My, mean [kN m]" not in named
    assert "quantities differ between old (3) and new (3)" in compared.sentences[0]
    spectra = [
        spectrum(history(seed, 1.0, wind).history.loads[:, 4], 0.2).density for seed in range(3)
    ]
    np.testing.assert_allclose(at_wind.spectra["My"][0], np.mean(spectra, axis=0)[:150], rtol=1e-12)
    storm = set_of(history(seed, 1.0, 2.0 * wind) for seed in range(3))
    with pytest.raises(InputError, match="no mean wind speed"):
        compare_sets(one, storm)
