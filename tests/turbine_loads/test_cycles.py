"""Cycles are those of the standard's example, and an equivalent load of a sine is its range."""

from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.time_weighted import (
    sample_weights,
    weighted_rms,
    weighted_statistics,
)
from fe_drivetrain.turbine_loads.histories import cycles as cycles_module
from fe_drivetrain.turbine_loads.histories.cycles import (
    Cycles,
    Residue,
    exceedance,
    gated,
    joined,
    rainflow_cycles,
    range_mean_matrix,
    reversals,
    streamed_cycles,
)
from fe_drivetrain.turbine_loads.histories.damage import (
    SLOPES,
    SNCurve,
    damage_equivalent_load,
    goodman,
    miner_damage,
)

#: ASTM E1049-85 (2017), Fig. 6.
EXAMPLE = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]


#: Whole numbers have plateaus and ties, others none.
signals = st.lists(st.integers(-5, 5).map(float), max_size=60) | st.lists(
    st.floats(-1e6, 1e6, width=32), max_size=60
)


def counted(signal: list[float], residue: Residue = "half") -> dict[float, float]:
    cycles = rainflow_cycles(signal, residue)
    total: Counter[float] = Counter()
    for size, count in zip(cycles.ranges.tolist(), cycles.counts.tolist(), strict=True):
        total[size] += count
    return dict(total)


def test_cycles_of_the_standards_example() -> None:
    assert counted(EXAMPLE) == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}


def test_what_the_end_leaves_open_counts_by_the_rule_that_is_stated() -> None:
    closed = {3.0: 1.0, 4.0: 2.0, 6.0: 1.0, 8.0: 2.0, 9.0: 1.0}
    assert counted(EXAMPLE, "closed") == closed
    assert counted(EXAMPLE, "repeated") == {3.0: 1.0, 4.0: 1.0, 7.0: 1.0, 9.0: 1.0}
    assert counted([1.0, 2.0, 3.5], "repeated") == {2.5: 1.0}
    assert counted([2.0, 2.0], "repeated") == {}
    assert "followed by itself" in rainflow_cycles(EXAMPLE, "repeated").rule
    with pytest.raises(InputError, match="choose one of half, closed, repeated"):
        rainflow_cycles(EXAMPLE, "none")  # type: ignore[arg-type]


@given(signals)
def test_a_repeated_history_adds_what_the_rule_says(signal: list[float]) -> None:
    """The second of two passes has the cycles of the rule; of many passes, the half cycles fade."""
    once, twice, thrice = (Counter(counted(n * signal)) for n in (4, 5, 6))
    added = {k: twice[k] - once[k] for k in twice if twice[k] != once[k]}
    assert added == {k: thrice[k] - twice[k] for k in thrice if thrice[k] != twice[k]}
    rule = rainflow_cycles(signal, "repeated")
    for slope in (1.0, 3.0):
        expected = sum(n * k**slope for k, n in added.items())
        assert float(rule.counts @ rule.ranges**slope) == pytest.approx(expected, rel=1e-9)


@given(signals, st.lists(st.integers(0, 60), max_size=5), st.sampled_from(["half", "repeated"]))
def test_a_history_in_pieces_has_the_cycles_of_the_whole(
    signal: list[float], cuts: list[int], residue: Residue
) -> None:
    values = np.array(signal)
    pieces = np.split(values, sorted(cut for cut in cuts if cut <= len(values)))
    whole, parts = rainflow_cycles(values, residue), joined(list(streamed_cycles(pieces, residue)))
    for name in ("ranges", "counts", "means"):
        assert getattr(whole, name).tolist() == getattr(parts, name).tolist()


@given(signals)
def test_cycles_are_those_of_the_package_on_the_plain_history(signal: list[float]) -> None:
    import rainflow

    cycles = rainflow_cycles(signal)
    found = list(zip(cycles.ranges, cycles.means, cycles.counts, strict=True))
    if len(reversals(signal)) > 2:  # of two values the package finds nothing
        assert found == [row[:3] for row in rainflow.extract_cycles(signal)]


def test_a_stream_keeps_one_block_of_cycles(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    pieces = rng.standard_normal((20, 50))
    whole = rainflow_cycles(pieces.ravel())
    monkeypatch.setattr(cycles_module, "BLOCK", 10)
    blocks = list(streamed_cycles(pieces))
    assert max(len(block.ranges) for block in blocks) <= 10
    assert len(blocks) > 10
    np.testing.assert_array_equal(joined(blocks).ranges, whole.ranges)


@pytest.mark.needs("rfcnt")
def test_a_peer_that_counts_in_classes_finds_the_same_within_a_class(
    rng: np.random.Generator,
) -> None:
    import rfcnt

    signal = np.cumsum(rng.standard_normal(3000))
    signal -= np.linspace(0.0, signal[-1], 3000)
    width = float(np.ptp(signal)) / 1000.0
    found = rfcnt.rfc(
        signal,
        class_width=width,
        class_count=1020,
        class_offset=signal.min() - 5.0 * width,
        hysteresis=0.0,
        residual_method=rfcnt.ResidualMethod.HALFCYCLES,
    )["rp"]
    for slope in (1.0, 3.0, 10.0):
        cycles = rainflow_cycles(signal)
        ours = damage_equivalent_load([cycles], 1.0, slope)
        peer = float((found[:, 1] @ found[:, 0] ** slope) ** (1.0 / slope))
        # Minkowski: each range is displaced by up to a class
        assert ours == pytest.approx(peer, abs=width * cycles.counts.sum() ** (1.0 / slope))


@pytest.mark.needs("pylife")
def test_a_peer_of_four_points_has_the_same_cycles_with_its_residue_as_halves(
    rng: np.random.Generator,
) -> None:
    from pylife.stress.rainflow import FourPointDetector, LoopValueRecorder

    signal = np.cumsum(rng.standard_normal(3000))
    recorder = LoopValueRecorder()
    residue = np.asarray(FourPointDetector(recorder).process(signal).residuals)
    whole = np.abs(np.asarray(recorder.values_from) - np.asarray(recorder.values_to))
    half = np.abs(np.diff(residue))
    cycles = rainflow_cycles(signal)
    found = np.sort(np.repeat(cycles.ranges, (2 * cycles.counts).astype(int)))
    np.testing.assert_allclose(found, np.sort([*whole, *whole, *half]), rtol=1e-12)


def test_published_equivalent_loads_within_their_classes() -> None:
    """wetb's test of the standard's series in 50 classes, of the openfast_toolbox @d34b283."""
    cycles = rainflow_cycles(EXAMPLE)
    half = 0.5 * 9.0 / 50  # of a class: by Minkowski the load moves by no more than this allows
    for cycles_of_sine, published in (
        (1.0, (10.348414123746581, 9.635653414943068, 9.122399471334054)),
        (17.0, (4.024613313976801, 4.745357541147315, 5.68897815218057)),
    ):
        for slope, value in zip((3.0, 4.0, 6.0), published, strict=True):
            allowed = half * (cycles.counts.sum() / cycles_of_sine) ** (1.0 / slope)
            found = damage_equivalent_load([cycles], cycles_of_sine, slope)
            assert found == pytest.approx(value, abs=allowed)


def test_published_life_by_the_elementary_rule() -> None:
    """Haibach, Betriebsfestigkeit, 3rd ed. 2006, p. 271."""
    loads = np.array([100.0, 150, 200, 250, 300, 350])
    counts = -np.diff([1e6, 1e5, 1e4, 1e3, 100, 10, 0])
    damage = miner_damage(loads, counts, SNCurve(125.0, 2e6, 7.0))
    assert counts.sum() / damage == pytest.approx(2_167_330, rel=5e-6)
    harmless = SNCurve(125.0, 2e6, 7.0, np.inf)  # an endurance limit
    assert miner_damage(loads[:1], counts[:1], harmless) == 0.0
    assert miner_damage(loads, counts, harmless) < damage


def test_goodman_shifts_the_mean_at_equal_damage() -> None:
    cycles = rainflow_cycles(10.0 + np.array(EXAMPLE))
    shifted = goodman(cycles, 40.0)
    np.testing.assert_allclose(shifted.ranges, cycles.ranges * 40.0 / (40.0 - cycles.means))
    np.testing.assert_allclose(goodman(shifted, 40.0).ranges, shifted.ranges)
    back = goodman(replace(shifted, means=cycles.means * 0.0), 40.0, 10.0)
    np.testing.assert_allclose(back.ranges, shifted.ranges * 0.75)
    with pytest.raises(InputError, match="reach the ultimate load 10"):
        goodman(cycles, 10.0)


def test_goodman_takes_negative_means_as_positive_ones() -> None:
    history = 10.0 + np.array(EXAMPLE)
    for target in (0.0, 10.0, -10.0):
        one, other = (goodman(rainflow_cycles(s * history), 40.0, target) for s in (1.0, -1.0))
        np.testing.assert_allclose(other.ranges, one.ranges)
        cycles = rainflow_cycles(history)
        expected = cycles.ranges * (40.0 - abs(target)) / (40.0 - cycles.means)
        np.testing.assert_allclose(one.ranges, expected)
    both = goodman(Cycles(np.ones(2), np.ones(2), np.array([-15.0, 15.0])), 40.0)
    np.testing.assert_allclose(both.ranges, 1.6)


def test_exceedance_matrix_and_gate_hold_every_cycle(rng: np.random.Generator) -> None:
    cycles = rainflow_cycles(rng.standard_normal(400))
    ranges, counts = exceedance(cycles)
    assert (np.diff(ranges) < 0.0).all()
    assert counts[-1] == pytest.approx(cycles.counts.sum())
    table = range_mean_matrix(cycles, np.linspace(0, 10, 21), np.linspace(-5, 5, 11))
    assert table.sum() == pytest.approx(cycles.counts.sum())
    with pytest.raises(InputError, match="let them hold every cycle"):
        range_mean_matrix(cycles, [0.0, 1.0], [-5.0, 5.0])
    kept = gated(cycles, 1.0)
    assert kept.ranges.min() >= 1.0
    assert kept.counts.sum() + kept.left_out == pytest.approx(cycles.counts.sum())
    assert "of a range below 1 are left out" in kept.rule
    with pytest.raises(InputError, match="different rules"):
        joined([cycles, kept])


def test_a_gate_keeps_the_cycles_that_reach_it() -> None:
    cycles = rainflow_cycles(EXAMPLE)
    kept = gated(cycles, 4.0)
    assert kept.ranges.min() == 4.0
    assert kept.left_out == cycles.counts[cycles.ranges < 4.0].sum()


def test_what_lies_between_two_reversals_does_not_count(rng: np.random.Generator) -> None:
    fine: list[float] = [EXAMPLE[0]]
    for a, b in pairwise(EXAMPLE):
        fine += [*(a + (b - a) * np.sort(rng.uniform(size=5))), b, b]  # and plateaus
    assert reversals(fine).tolist() == EXAMPLE
    assert counted(fine) == counted(EXAMPLE)


@pytest.mark.parametrize("size", [1e-313, 1e-200, 1.0, 1e200, 8e307])
def test_turns_are_seen_whatever_the_unit(size: float) -> None:
    """Of a product of two differences neither underflow nor overflow."""
    cycles = rainflow_cycles(size * np.array([0.0, 1.0, 0.0, 1.0, -1.0]))
    np.testing.assert_array_equal(cycles.ranges, size * np.array([1.0, 1.0, 1.0, 2.0]))
    assert cycles.counts.sum() == 2.0


def test_a_ramp_is_half_a_cycle_and_a_constant_none() -> None:
    assert counted([1.0, 2.0, 3.5]) == {2.5: 0.5}
    assert counted([1.0, 2.0]) == {1.0: 0.5}
    for flat in ([3.0], [3.0, 3.0, 3.0]):
        assert counted(flat) == {}
        assert damage_equivalent_load([rainflow_cycles(flat)], 10.0, 3.0) == 0.0


@pytest.mark.parametrize("slope", [1.0, *SLOPES, 20.0])
@pytest.mark.parametrize("frequency", [0.25, 1.0, 2.0])
def test_the_equivalent_load_of_a_sine_is_exact(slope: float, frequency: float) -> None:
    time = np.arange(0, 8001) / 100.0  # peaks are sampled, the first and the last included
    wave = 1e6 + 3e5 * np.cos(2 * np.pi * frequency * time)
    cycles = rainflow_cycles(wave)
    assert cycles.counts.sum() == pytest.approx(80 * frequency)
    found = damage_equivalent_load([cycles], 80.0, slope)
    assert found == pytest.approx(6e5 * frequency ** (1.0 / slope), rel=1e-9)
    assert damage_equivalent_load([cycles], 80.0, slope, frequency) == pytest.approx(6e5)


def test_histories_add_their_damage_and_their_time(rng: np.random.Generator) -> None:
    one, other = (rainflow_cycles(rng.standard_normal(500)) for _ in range(2))
    loads = [damage_equivalent_load([c], t, 4.0) for c, t in ((one, 100.0), (other, 50.0))]
    both = damage_equivalent_load([one, other], 150.0, 4.0)
    assert both**4 == pytest.approx((100 * loads[0] ** 4 + 50 * loads[1] ** 4) / 150)


def test_a_wrong_slope_or_time_is_refused() -> None:
    cycles = rainflow_cycles(EXAMPLE)
    for slope in (0.5, 21.0, float("nan")):
        with pytest.raises(InputError, match="must be from 1 to 20"):
            damage_equivalent_load([cycles], 10.0, slope)
    with pytest.raises(InputError, match="must be above 0"):
        damage_equivalent_load([cycles], 0.0, 3.0)
    with pytest.raises(InputError, match="not finite"):
        rainflow_cycles([0.0, np.nan, 1.0])


def test_histories_count_by_the_time_they_last(rng: np.random.Generator) -> None:
    """A history written at half the step has twice the samples and the same weight."""
    coarse, other = rng.standard_normal((100, 3)), 5.0 + rng.standard_normal((40, 3))
    fine = np.repeat(coarse, 2, axis=0)
    statistics = []
    for first, step in ((coarse, 0.2), (fine, 0.1)):
        weights = sample_weights([len(first), len(other)], [step, 0.5])
        assert weights.sum() == pytest.approx(1.0)
        samples = np.vstack([first, other])
        statistics.append(weighted_statistics(samples, weights))
        np.testing.assert_allclose(
            weighted_rms(samples, weights) ** 2,
            statistics[-1][:, 1] ** 2 + statistics[-1][:, 3] ** 2,
        )
    np.testing.assert_allclose(*statistics)
    # half of the time each
    np.testing.assert_allclose(statistics[0][:, 1], (coarse.mean(axis=0) + other.mean(axis=0)) / 2)
    equal = weighted_statistics(coarse, sample_weights([100], [0.1]))
    np.testing.assert_allclose(equal[:, 3], coarse.std(axis=0))


def test_a_repeated_history_that_ends_where_it_began_has_no_cycle_of_rounding() -> None:
    rng = np.random.default_rng(2)
    for _ in range(50):
        signal = np.concatenate([[0.8], rng.normal(0.8, 0.1, 40), [0.8]])
        found = rainflow_cycles(signal, "repeated")
        assert found.ranges.min() > 1e-9
        turning = reversals(np.append(signal[:-1], signal))
        assert found.counts.sum() == len(turning) // 2 // 2
