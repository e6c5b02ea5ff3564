"""Samples of a study that was stopped are not evaluated again."""

from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.shafts.uncertainty import kept_rows
from fe_drivetrain.shafts.uncertainty.kept_rows import evaluated_rows

ROWS = np.random.default_rng(1).uniform(size=(20, 3))
CONTENT = {"scene": "a"}


def exact(row: Floats) -> dict[str, float]:
    return {"sum": float(row.sum()), "product": float(row.prod())}


class Stopped:
    """Evaluates so many samples, and then is stopped."""

    def __init__(self, count: int) -> None:
        self.left, self.done = count, 0

    def __call__(self, row: Floats) -> dict[str, float]:
        if self.done == self.left:
            raise KeyboardInterrupt
        self.done += 1
        return exact(row)


@pytest.mark.parametrize("every", [0.0, 1e9])  # seconds between writes: each sample, the stop alone
def test_a_study_that_was_stopped_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, every: float
) -> None:
    monkeypatch.setattr(kept_rows, "EVERY", every)
    cache = Cache(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        evaluated_rows(ROWS, Stopped(7), CONTENT, cache=cache)
    rest, counted = Stopped(13), []
    found = evaluated_rows(ROWS, rest, CONTENT, counted.append, cache)
    assert counted == list(range(8, 21))
    whole = evaluated_rows(ROWS, exact, None)
    assert list(found) == list(whole) == ["sum", "product"]
    for name in whole:
        assert found[name].tobytes() == whole[name].tobytes()
    assert evaluated_rows(ROWS, Stopped(0), CONTENT, cache=cache).keys() == whole.keys()


def test_other_samples_or_another_scene_are_evaluated(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    evaluated_rows(ROWS, exact, CONTENT, cache=cache)
    for rows, content in ((ROWS + 1e-15, CONTENT), (ROWS, {"scene": "b"}), (ROWS, None)):
        counted = Stopped(20)
        evaluated_rows(rows, counted, content, cache=cache)
        assert counted.done == 20
