"""Spectra of a raceway's load: readings, peaks and labels, and what a thesis says of them."""

from types import SimpleNamespace

import numpy as np
import pytest

from fe_drivetrain.cases.histories.operating_appendix import show, show_imbalance, statements
from fe_drivetrain.cases.histories.operating_loads import BASE
from fe_drivetrain.cases.histories.operating_spectra import (
    OfSet,
    Raceway,
    labels,
    of_sets,
    on_turning_race,
    peaks,
    raceway_spectra,
)
from fe_drivetrain.cases.histories.operating_words import FLAT, HIGH_SET, LOW_SET, STEEP
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.turbine_loads.histories.spectra import Spectrum, spectrum
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition

TURN = 0.25  # Hz
STEP = 0.05
TIME = np.arange(0.0, 600.0, STEP)
PLACES = 2.0 * np.pi * np.arange(36) / 36
MODES = {"flap": 3.6 * TURN, "edge": 6.6 * TURN}


def history(speed: float = 2.0 * np.pi * TURN) -> object:
    return SimpleNamespace(
        history=SimpleNamespace(step=STEP),
        rotor_speed=np.full(len(TIME), speed),
        azimuth=speed * TIME,
    )


def test_a_zone_that_stands_is_felt_once_a_turn_by_the_race_that_turns() -> None:
    zone = np.maximum(np.cos(PLACES + 0.5 * np.pi), 0.0)  # at the bottom
    row = 100.0 * np.tile(zone, (len(TIME), 1))
    found = raceway_spectra(row, history())  # type: ignore[arg-type]
    assert found.speed == pytest.approx(TURN)
    assert found.stands.density.max() < 1e-12
    assert found.turns.amplitude(TURN) == pytest.approx(50.0, rel=0.02)  # of a half wave
    seen = [peak.at for peak in peaks(found.turns, TURN) if peak.height > 1.0]
    assert seen[:2] == pytest.approx([1.0, 2.0], abs=0.04)
    assert found.turns.frequency[-1] <= 12.0 * TURN
    felt = on_turning_race(row, np.array([0.5 * np.pi] * len(TIME)))
    assert felt[0] == pytest.approx(100.0)  # a quarter turn about +x takes the right to the bottom


def test_a_load_of_all_places_is_felt_at_its_own_frequency_by_both() -> None:
    row = np.outer(1.0 + 0.3 * np.sin(6.0 * np.pi * TURN * TIME), np.ones(36))
    found = raceway_spectra(row, history())  # type: ignore[arg-type]
    assert found.stands.amplitude(3.0 * TURN) == pytest.approx(36 * 0.3, rel=0.02)
    assert found.turns.amplitude(3.0 * TURN) == pytest.approx(0.3, rel=0.02)


def hill(order: float, height: float, breadth: float) -> np.ndarray:
    at = np.arange(0.0, 12.0, 0.02)
    return height**2 * np.exp(-np.pi * ((at - order) / breadth) ** 2)


def test_a_peak_has_its_place_height_and_breadth() -> None:
    ground = np.full(600, 0.01)
    density = ground + hill(3.0, 20.0, 0.2) + hill(6.0, 0.09, 0.2)
    found = peaks(Spectrum(TURN * np.arange(0.0, 12.0, 0.02), density, 100), TURN)
    (one,) = found  # the other does not stand out
    assert one.at == pytest.approx(3.0, abs=0.01)
    assert one.height == pytest.approx(20.0, rel=1e-3)
    assert one.breadth == pytest.approx(0.2, rel=1e-3)


def of(reading_peaks: dict[str, list[tuple[float, float, float]]]) -> OfSet:
    spectra = {}
    for reading, hills in reading_peaks.items():
        density = np.full(600, 0.01) + sum(hill(*one) for one in hills)
        spectra[reading] = Spectrum(TURN * np.arange(0.0, 12.0, 0.02), density, 100)
    return OfSet(spectra, {r: peaks(one, TURN) for r, one in spectra.items()}, TURN)


def test_statements_follow_the_peaks() -> None:
    def both(scale: float, breadth: float) -> OfSet:
        stands = [(3.0, 20.0 * scale, breadth), (6.0, 3.0, 0.1), (7.6, 5.0, 0.1), (9.0, 1.0, 0.1)]
        return of({"stands": stands, "turns": [(1.0, 8.0 * scale, breadth)]})

    sets = {
        BASE: both(1.0, 0.2),
        FLAT: both(1.0, 0.2),
        STEEP: both(1.5, 0.2),
        LOW_SET: both(1.0, 0.2),
        HIGH_SET: both(1.0, 0.3),
    }
    said = statements(sets, labels(MODES, TURN))
    stands = {words: agrees["stands"] for words, _, agrees in said}
    turns = {words: agrees["turns"] for words, _, agrees in said}
    assert len(said) == 12
    missing = {"a peak at the rotor's speed (1P)", "a peak at the first flapwise mode"}
    assert {words for words, agrees in stands.items() if not agrees} == missing
    assert turns["a peak at the rotor's speed (1P)"]
    assert not turns["a peak at blade passing (3P)"]
    worse = statements(
        {**sets, STEEP: both(0.8, 0.2), HIGH_SET: both(1.5, 0.15)}, labels(MODES, TURN)
    )
    denied = {words for words, _, agrees in worse if not agrees["stands"]} - missing
    assert denied == {
        "shear raises amplitudes",
        "turbulence makes peaks broader",
        "their amplitudes stay similar with turbulence",
    }


def test_means_are_of_winds_from_rated_on_and_few_segments_name_no_peak() -> None:
    grid = [Condition(wind, "medium", 0.2, 1) for wind in (4.0, 12.0, 24.0)]
    found = [
        Raceway(
            *2 * (spectrum(np.full(400, 1.0) * (TIME[:400] % 1.0) * k, STEP, 20.0),), speed=TURN
        )
        for k in (100.0, 1.0, 3.0)
    ]
    sets = of_sets(grid, [BASE] * 3, found)
    mean = sets[BASE].spectra["stands"].density
    one = found[1].stands.density[: len(mean)]
    assert mean == pytest.approx(5.0 * one)  # of 1 and 9
    page = Page()
    show(page, sets, MODES, of_thesis=True)
    assert any("too few to tell" in getattr(i, "text", "") for s in page.sections for i in s.items)


def test_imbalance_stands_at_the_speed_of_the_rotor() -> None:
    balanced = of({"stands": [(3.0, 20.0, 0.2)], "turns": []})
    spoilt = of({"stands": [(1.0, 5.0, 0.1), (3.0, 20.0, 0.2)], "turns": []})
    page = Page()
    page.section("Statements")
    show_imbalance(page, balanced, spoilt, 16.0)
    before, after = page.tables["imbalance in raceway loads"]
    assert before["peak at 1P [kN/Hz^0.5]"] is None
    assert after["peak at 1P [kN/Hz^0.5]"] == pytest.approx(5.0, rel=1e-2)
    assert after["peak at 3P [kN/Hz^0.5]"] == before["peak at 3P [kN/Hz^0.5]"]
