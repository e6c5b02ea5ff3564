"""Dataclasses as arrays by path, and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pytest

from fe_drivetrain.common.array_records import as_arrays, from_arrays
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.kept_files import UnfitError


@dataclass(frozen=True, eq=False)
class Inner:
    values: Floats
    first: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Outer:
    name: str
    number: int
    share: float
    sure: bool
    by_name: Mapping[str, Inner]
    perhaps: Inner | None
    maybe: Floats | None


def made(perhaps: Inner | None = None) -> Outer:
    inner = Inner(np.array([[1.0, np.nan]]), (3, -4))
    names = {"a/b": inner, "~1": inner, "": inner}
    return Outer("text", 7, 0.1, True, names, perhaps, None)


def test_what_is_taken_apart_is_put_together_again() -> None:
    for whole in (made(), made(Inner(np.zeros((0, 3)), ()))):
        found = from_arrays(Outer, as_arrays(whole))
        assert (found.name, found.number, found.share, found.sure) == ("text", 7, 0.1, True)
        assert list(found.by_name) == ["a/b", "~1", ""]
        for one in found.by_name.values():
            np.testing.assert_array_equal(one.values, [[1.0, np.nan]])
            assert one.first == (3, -4)
        assert (found.perhaps is None) == (whole.perhaps is None)
        assert found.maybe is None
    assert found.perhaps is not None
    assert found.perhaps.values.shape == (0, 3)
    assert "by_name/a~1b/values" in as_arrays(made())


def test_arrays_of_another_form_are_unfit() -> None:
    sound = as_arrays(made())
    for put, taken, said in (
        ({"more": np.zeros(1)}, "", "with 'more'"),
        ({}, "number", "without an array 'number'"),
        ({}, "by_name/a~1b/first", "without an array 'by_name/a/b/first'"),
        ({"by_name": np.zeros(1)}, "", "it has another form"),
        ({"perhaps": np.zeros(1)}, "", "with an array 'perhaps'"),
    ):
        arrays = {name: array for name, array in {**put, **sound}.items() if name != taken}
        with pytest.raises(UnfitError, match=said):
            from_arrays(Outer, arrays)


@dataclass(frozen=True, eq=False)
class Several:
    rows: tuple[Floats, ...]
    parts: tuple[Inner, ...]
    ends: tuple[float, float]


def test_tuples_of_arrays_and_of_records_keep_their_order_and_shapes() -> None:
    rows = tuple(np.full((k, 2), float(k)) for k in range(12))
    whole = Several(rows, (Inner(np.ones(1), (1,)), Inner(np.zeros(2), ())), (0.5, np.inf))
    found = from_arrays(Several, as_arrays(whole))
    for one, other in zip(found.rows, rows, strict=True):
        np.testing.assert_array_equal(one, other)
    assert [part.first for part in found.parts] == [(1,), ()]
    assert found.ends == (0.5, np.inf)
    assert from_arrays(Several, as_arrays(Several((), (), (0.0, 1.0)))).rows == ()
    lacking = {name: array for name, array in as_arrays(whole).items() if name != "rows/3"}
    with pytest.raises(UnfitError, match="without an array"):
        from_arrays(Several, lacking)
