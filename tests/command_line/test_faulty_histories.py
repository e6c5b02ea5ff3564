"""Samples that stand alone are named, and what a page notes of short, still and open histories."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tiny_case import Result

from fe_drivetrain.report.number_text import THIN_SPACE
from fe_drivetrain.report.results import read_results
from fe_drivetrain.turbine_loads.histories.faults import lone_samples, times_as_far
from fe_drivetrain.turbine_loads.hub_loads.csv_table import write_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory

TIME = np.arange(0.0, 120.0, 0.05)
WAVE = np.sin(2.0 * np.pi * 0.6 * TIME) + 0.3 * np.sin(2.0 * np.pi * 1.2 * TIME)


def test_a_sample_that_stands_alone_is_found(rng: np.random.Generator) -> None:
    noisy = WAVE + 0.05 * rng.standard_normal(len(TIME))
    assert lone_samples(noisy).tolist() == []
    for sign in (1.0, -1.0):
        spoilt = noisy.copy()
        spoilt[[700, 1500]] += sign * 8.0
        assert lone_samples(spoilt).tolist() == [700, 1500]


def test_how_far_a_lone_sample_is_over_what_is_usual(rng: np.random.Generator) -> None:
    """White noise of deviation s is sqrt(3/2) s from the middle of its neighbours."""
    noise = 0.1 * rng.standard_normal(20_000)
    for size in (10.0, 4e6):
        spoilt = noise.copy()
        spoilt[700] += size
        found = times_as_far(spoilt, lone_samples(spoilt))
        assert found == pytest.approx([size / (0.1 * np.sqrt(1.5))], rel=0.05)
    still = np.where(np.arange(50) == 20, 1.0, 0.0)
    assert times_as_far(still, lone_samples(still)).tolist() == [np.inf]


def test_a_jump_that_stays_noise_and_constants_are_no_lone_samples(
    rng: np.random.Generator,
) -> None:
    assert lone_samples(WAVE + 20.0 * (TIME > 50.0)).size == 0
    assert lone_samples(rng.standard_normal(10_000)).size == 0
    assert lone_samples(np.full(10, 3.0)).size == 0
    assert lone_samples([1.0, 2.0]).size == 0


def test_the_page_notes_what_may_mislead(invoke: Callable[..., Result], tmp_path: Path) -> None:
    loads = 1e5 * np.column_stack([WAVE, WAVE, WAVE - 4.0, 0.0 * WAVE, WAVE, WAVE])
    loads[1000, 4] += 3e6
    write_hub_loads(LoadHistory("spoilt", TIME, loads), tmp_path / "spoilt.csv")
    status, _, err = invoke("loads", str(tmp_path / "spoilt.csv"), "--out", str(tmp_path / "out"))
    assert status == 0, err
    notes = " ".join(read_results(tmp_path / "out" / "results.json").notes)
    assert "spoilt: one sample stands alone in My" in notes
    assert "the first at 50 s" in notes
    my = loads[:, 4]
    usual = 1.4826 * np.median(np.abs(my[1:-1] - 0.5 * (my[:-2] + my[2:])))
    said = notes.split("alone in My, ")[1].split(" times as far from both neighbours")[0]
    assert float(said.replace(THIN_SPACE, "")) == pytest.approx(3e6 / usual, rel=0.05)  # two digits
    assert "Mx does not vary in 1 of 1 files" in notes
    assert "1 of 1 files are shorter than ten minutes" in notes
    share = float(notes.split(" % of the damage is of half cycles")[0].split()[-1])
    assert share == pytest.approx(100.0, abs=5.0)  # the spike's range is one half cycle or two
