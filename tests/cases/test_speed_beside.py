"""What packages are compared by: the damage of a count, and the values of a file."""

import numpy as np
import pytest

from fe_drivetrain.cases.histories import speed_beside
from fe_drivetrain.turbine_loads.histories import rainflow_cycles


def test_every_count_of_equal_cycles_has_the_damage_of_these():
    """Ten swings between -1 and 1 are ten cycles of a range of 2."""
    load = np.tile([-1.0, 1.0], 10)
    load = np.append(load, -1.0)
    exact = 10 * 2.0**speed_beside.EXPONENT
    ours = speed_beside.summed(speed_beside.OURS, rainflow_cycles(load))
    assert ours == pytest.approx(exact, rel=1e-12)
    for name, count in speed_beside.counters(load).items():
        if name in speed_beside.PLAIN:
            assert speed_beside.summed(name, count()) == pytest.approx(exact, rel=1e-12)


def test_every_reader_finds_what_was_written(tmp_path):
    values = np.random.default_rng(1).integers(
        -32768, 32767, (50, speed_beside.CHANNELS), dtype=np.int16
    )
    file = tmp_path / "made.outb"
    speed_beside.write_outb(file, values)
    expected = speed_beside.unpacked(values)
    for name, read in speed_beside.readers(file).items():
        np.testing.assert_allclose(speed_beside.channels_of(name, read()), expected, rtol=1e-6)


def test_tasks_take_turns_and_each_ratio_is_of_one_round():
    order: list[str] = []
    tasks = {name: lambda name=name: order.append(name) for name in ("this project", "other")}
    _, seconds = speed_beside.in_turns(tasks, 2)
    first, second = "this project", "other"
    # a round that is not counted, and two in which the order turns
    assert order == [first, second, first, second, second, first]
    assert [len(of) for of in seconds.values()] == [2, 2]
    row = speed_beside.beside("other", {first: [1.0, 2.0], second: [3.0, 4.0]}, "error", 0.0)
    assert [row[f"{speed_beside.RATIO}, {which}"] for which in ("least", "median", "most")] == [
        2.0,
        2.5,
        3.0,
    ]
