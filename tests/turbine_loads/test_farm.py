"""Histories in pieces are counted as in one go: every cycle, sum and sample, to the last digit."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.exact_sums import ExactSum, exact_sum
from fe_drivetrain.common.jobs import AT_ONCE
from fe_drivetrain.turbine_loads.histories.classes import MAXIMUM
from fe_drivetrain.turbine_loads.histories.cycles import rainflow_cycles
from fe_drivetrain.turbine_loads.histories.farm import (
    LONGEST_RUN,
    Counting,
    _runs,
    counted_histories,
    piece,
)

COUNTING = Counting(-3, (3.0, 10.0))


def test_a_history_far_beyond_its_classes_takes_wider_ones() -> None:
    """A swing of 1e12 is not counted in 8e12 classes of an eighth."""
    far, near = (piece(k * np.array([0.0, 1.0, 0.0]), COUNTING) for k in (1e12, 3.0))
    assert far.count.levels.amount.size <= MAXIMUM
    assert far.count.levels.amount.sum() == 3
    assert far.count.levels.edges()[-1] > 1e12 >= far.count.levels.edges()[-2]
    assert near.count.levels.powers == (-3,)


def same(one, other):
    assert one.samples == other.samples
    assert one.damage == other.damage
    for a, b in ((one.cycles, other.cycles), (one.levels, other.levels)):
        assert (a.powers, a.first) == (b.powers, b.first)
        assert a.amount.tobytes() == b.amount.tobytes()


def cut(values, places):
    return [part for part in np.split(values, sorted(places)) if len(part)]


def summed(values, places):
    parts = [piece(part, COUNTING) for part in cut(values, places)]
    found = parts[0]
    for part in parts[1:]:
        found = found + part
    return found


#: Ties, plateaus and equal extremes: few values; and ordinary ones.
SIGNALS = st.one_of(
    st.lists(st.integers(-3, 3), min_size=1, max_size=60),
    st.lists(st.floats(-100.0, 100.0), min_size=1, max_size=40),
)


@settings(max_examples=150, deadline=None)
@given(SIGNALS, st.lists(st.integers(0, 60), max_size=6), st.sampled_from(["half", "repeated"]))
@example([2.2250738585e-313, 0.0, 2.2250738585e-313], [], "half")
def test_pieces_hold_the_cycles_of_the_standard(signal, places, residue):
    """Not only of itself: as `rainflow_cycles` counts the whole by three points."""
    values = np.array(signal, dtype=float)
    found = summed(values, places).whole(residue)
    exact = rainflow_cycles(values, residue)
    for slope, damage in zip(COUNTING.slopes, found.damage, strict=True):
        assert damage == exact_sum(exact.counts * exact.ranges**slope)
    assert found.cycles.amount.sum() == exact.counts.sum()
    assert found.levels.amount.sum() == found.samples == len(values)


def test_any_cut_and_any_grouping_give_the_same(rng):
    values = np.cumsum(rng.standard_normal(5000)) + rng.standard_normal(5000)
    whole = piece(values, COUNTING).whole()
    for size in (77, 1234):
        same(summed(values, range(size, 5000, size)).whole(), whole)
    same(summed(values[:99], range(1, 99)).whole(), piece(values[:99], COUNTING).whole())
    one, two, three, four = (piece(part, COUNTING) for part in np.split(values, 4))
    same(((one + two) + (three + four)).whole(), whole)
    same((one + ((two + three) + four)).whole(), whole)
    assert len(piece(values, COUNTING).open) < 300


def test_levels_far_from_zero_keep_their_width():
    values = 5e6 + np.linspace(0.0, 1.0, 9)
    levels = summed(values, [3, 5]).whole().levels
    assert levels.powers == (COUNTING.power,)
    np.testing.assert_array_equal(levels.edges()[[0, -1]], [5e6, 5e6 + 1.125])
    assert summed(1e4 * np.arange(5.0), [2]).whole().levels.powers[0] > COUNTING.power


def test_equal_amplitudes_leave_little_open():
    assert len(piece(np.tile([0.0, 1.0], 100_000), COUNTING).open) <= 4


def sine(seed: int, number: int):
    return np.sin(0.1 * (np.arange(1000) + 1000 * number)) + 0.1 * np.random.default_rng(
        [seed, number]
    ).standard_normal(1000)


def test_histories_one_after_the_other_do_not_touch():
    names = ("a", "b", "c")
    pieces = [(name, (seed, number)) for seed, name in enumerate(names) for number in range(5)]
    found = dict(counted_histories(sine, pieces, COUNTING))
    assert tuple(found) == names
    for seed, name in enumerate(names):
        values = np.concatenate([sine(seed, number) for number in range(5)])
        same(found[name], piece(values, COUNTING).whole())
    both = found["a"] + found["b"]
    same(both, found["b"] + found["a"])
    assert both.samples == 10_000


def test_runs_grow_and_stay_within_a_history():
    pieces = [("a", (k,)) for k in range(5 * AT_ONCE)] + [("b", (k,)) for k in range(3)]
    runs = list(_runs(pieces))
    assert [(name, one) for name, several in runs for one in several] == pieces
    lengths = [len(several) for _, several in runs]
    assert lengths[:AT_ONCE] == [1] * AT_ONCE
    assert lengths[AT_ONCE : 2 * AT_ONCE] == [2] * AT_ONCE
    assert lengths[-2:] == [4, 3]
    many = [len(several) for _, several in _runs(("a", (k,)) for k in range(20_000))]
    assert max(many) == LONGEST_RUN
    assert len(many) < 20_000 / LONGEST_RUN + 5 * AT_ONCE


def test_many_pieces_are_counted_as_one_go():
    number = 3 * AT_ONCE + 7
    values = np.concatenate([short(k) for k in range(number)])
    found = dict(counted_histories(short, (("a", (k,)) for k in range(number)), COUNTING))
    same(found["a"], piece(values, COUNTING).whole())


def short(number: int):
    return np.random.default_rng(number).standard_normal(50)


def test_what_cannot_be_counted_in_pieces_is_refused():
    with pytest.raises(InputError, match="choose half or repeated"):
        piece([0.0, 1.0], COUNTING).whole("closed")
    with pytest.raises(InputError, match="no samples"):
        piece([], COUNTING)
    with pytest.raises(InputError, match="not finite"):
        piece([0.0, np.nan], COUNTING)


@settings(max_examples=100, deadline=None)
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), max_size=50))
def test_sums_are_exact(values):
    try:
        exact = math.fsum(values)
    except OverflowError:
        return
    found = exact_sum(values)
    assert float(found) == exact
    assert sum((exact_sum([value]) for value in reversed(values)), ExactSum()) == found
