"""Records of arrays show shapes and names in one line, and never their numbers."""

from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy import sparse

from fe_drivetrain.common.short_repr import LONGEST, in_short, short_repr


@dataclass(frozen=True)
class Record:
    values: np.ndarray
    names: dict[str, int]
    hidden: int = field(default=1, repr=False)
    more: tuple[str, ...] = ()

    __repr__ = short_repr


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (np.zeros((60, 6)), "60x6 array"),
        (sparse.csr_array((9, 9)), "9x9 array"),
        (np.arange(5.0), "[0, 1, 2, ... 5 in all]"),
        (np.float64(1.25), "1.25"),
        (1 / 3, "0.333333"),
        ("a" * 100, repr("a" * 57 + "...")),
        ({"front": 1, "rear": 2}, "{front, rear}"),
        (dict.fromkeys(range(9)), "{0, 1, 2, ... 9 in all}"),
        ((1, None, "x"), "[1, None, 'x']"),
        ((), "[]"),
        ([Record(np.zeros(1), {})] * 4, "[4 of Record]"),
        (Record(np.zeros(1), {}), "Record"),
    ],
)
def test_a_value_in_a_few_words(value: object, text: str) -> None:
    assert in_short(value) == text


def test_a_record_is_one_line() -> None:
    record = Record(np.zeros((2, 3)), {"a": 1})
    assert repr(record) == "Record(values=2x3 array, names={a}, more=[])"
    assert str(record) == repr(record)


def test_a_line_that_is_full_ends_in_dots() -> None:
    names = {f"{letter}" * 200: 1 for letter in "abc"}
    found = repr(Record(np.ones(10**6), names, more=("x" * 90,) * 300))
    assert len(found) < LONGEST + len("Record()")
    many = dataclass_of(40)
    assert len(repr(many)) < LONGEST + len("Many(), ...")
    assert repr(many).endswith(", ...)")


def dataclass_of(count: int) -> object:
    """A record of so many fields."""
    names = {f"field_{i}": i for i in range(count)}
    body = {"__annotations__": dict.fromkeys(names, int), "__repr__": short_repr}
    return dataclass(type("Many", (), body))(**names)
