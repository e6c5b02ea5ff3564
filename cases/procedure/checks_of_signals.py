"""Checks of signals: capture matrices, cycles, load durations, sampling."""

import numpy as np

from fe_drivetrain.cases.procedure.checks_of_parts import Found
from fe_drivetrain.cases.references import published_campaigns
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import round_off
from fe_drivetrain.procedure import sampling_rates
from fe_drivetrain.turbine_loads.histories import (
    alias,
    capture_matrix,
    damage_equivalent_load,
    equivalent_level,
    even_levels,
    rainflow_cycles,
    time_at_level,
)


def captured() -> list[Found]:
    """Windows and mean turbulence of the capture matrices."""
    found = []
    for of, mean in (
        (published_campaigns.MONITORING, 9.73),
        (published_campaigns.IDENTIFICATION, 7.30),
    ):
        matrix = capture_matrix(*of.each, *of.edges)
        found += [
            Found(
                f"{of.where}: windows",
                float(matrix.counts.sum()),
                float(of.windows),
                "printed",
                0.0,
                "windows are counted, one by one",
            ),
            Found(
                f"{of.where}: mean turbulence [%], {100 * of.turbulence:.2f} printed",
                100.0 * matrix.mean_turbulence,
                mean,
                "middles of the printed classes",
                5e-3,
                "half of the last digit that is printed",
            ),
        ]
    return found


def counted() -> list[Found]:
    """Rainflow, equivalent loads, load durations."""
    signal = np.random.default_rng(1).standard_normal(5000)
    return [*cycles(), *equivalent_loads(signal), *durations(signal), mean_level(signal)]


def cycles() -> list[Found]:
    """Cycles of a standard's example, and of a sine."""
    example = rainflow_cycles(np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0]))
    counts = {float(r): float(example.counts[example.ranges == r].sum()) for r in example.ranges}
    expected = {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}
    wave = rainflow_cycles(3.0 * np.cos(np.linspace(0.0, 20.0 * np.pi, 4001)))
    return [
        Found(
            "cycles of the example of ASTM E1049, largest difference",
            max(abs(counts.get(r, 0.0) - expected.get(r, 0.0)) for r in {*counts, *expected}),
            0.0,
            "ASTM E1049: 3 x 0.5, 4 x 1.5, 6 x 0.5, 8 x 1, 9 x 0.5",
            0.0,
            "halves of cycles are counted, which doubles hold exactly",
        ),
        Found(
            "equivalent range of ten periods of a sine of range 6",
            damage_equivalent_load([wave], 10.0, 4.0),
            6.0,
            "ten cycles",
        ),
    ]


def equivalent_loads(signal: Floats) -> list[Found]:
    """Equivalent loads of a signal twice as large, and of blocks in another order."""
    one, two = (damage_equivalent_load([rainflow_cycles(s * signal)], 1.0, 4.0) for s in (1.0, 2.0))
    blocks = [np.tile([0.0, size], 50) for size in (4.0, 9.0, 6.0)]
    orders = [
        damage_equivalent_load([rainflow_cycles(np.concatenate([*which, [0.0]]))], 150.0, 4.0)
        for which in (blocks, blocks[::-1])
    ]
    return [
        Found("equivalent load of twice the load, over it", two / one, 2.0, "m"),
        Found(
            "equivalent load of blocks from rest in reversed order, over it",
            orders[1] / orders[0],
            1.0,
            "blocks are closed: no residue",
        ),
    ]


def durations(signal: Floats) -> list[Found]:
    """Time at levels of a signal, and of the same scaled and shifted."""
    found = time_at_level(signal, 0.1, even_levels(-6.0, 6.0))
    moved = time_at_level(2.0 * signal + 3.0, 0.1, 2.0 * even_levels(-6.0, 6.0) + 3.0)
    return [
        Found(
            "load durations of a signal scaled and shifted with its levels, largest difference [s]",
            float(np.abs(moved.amount - found.amount).max()),
            0.0,
            "the same classes",
            0.1,
            "one sample at the edge of a class",
        ),
        Found(
            "load durations [s]",
            float(found.amount.sum()),
            500.0,
            "T",
            **round_off(500.0 * len(signal), "a sum of the times of all samples, to 500 s"),
        ),
    ]


def mean_level(signal: Floats) -> Found:
    """The level of the same damage lies between mean and maximum."""
    level = equivalent_level(np.abs(signal), 10.0 / 3.0)
    inside = float(np.abs(signal).mean()) <= level <= float(np.abs(signal).max())
    name, why = "equivalent level from mean to maximum", "1: it lies between"
    return Found(name, float(inside), 1.0, "p > 1", 0.0, why)


def sampling() -> list[Found]:
    """Sampling rates and aliases."""
    f = 2.546
    slow, good = sampling_rates(f)
    return [
        Found(
            "rates over the frequency, difference from 3 and 5",
            abs(slow / f - 3.0) + abs(good / f - 5.0),
            0.0,
            "3 to 5 x",
        ),
        Found("at 3 x it appears at itself, over it", alias(f, 1.0 / slow) / f, 1.0, "above 2 x"),
        Found("at 1.5 x it appears at half of it", alias(f, 1.0 / (1.5 * f)) / f, 0.5, "|f - f_s|"),
    ]
