"""Chunks cover every row once, in order."""

import numpy as np
import pytest

from fe_drivetrain.common.arrays import CHUNK, chunks


@pytest.mark.parametrize("n", [0, 1, 6, 7, 8, 21])
def test_chunks_cover_every_row_once_and_in_order(n: int) -> None:
    rows = np.arange(n)
    parts = [rows[some] for some in chunks(n, 7)]
    assert [*map(len, parts)] == [7] * (n // 7) + [n % 7] * (n % 7 > 0)
    np.testing.assert_array_equal(np.concatenate([rows[:0], *parts]), rows)


def test_chunks_are_of_the_common_size_where_none_is_given() -> None:
    assert [some.stop for some in chunks(CHUNK + 1)] == [CHUNK, CHUNK + 1]
