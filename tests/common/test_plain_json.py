"""JSON of other programs: what it says, and how deep it may be."""

import json
import sys

import pytest

from fe_drivetrain.common.plain_json import MAX_DEPTH, plain_json


@pytest.mark.parametrize(
    "value", [3, "a[[{", '"\\"[[', {"a": [1, {"b": []}], "[": "]"}, [[]] * 300, {"\\": ["{"]}]
)
def test_what_was_written_is_read(value: object) -> None:
    assert plain_json(json.dumps(value)) == value
    assert plain_json(json.dumps([value] * 200, indent=1)) == [value] * 200


def test_the_deepest_is_read_and_one_more_refused() -> None:
    assert plain_json("[" * MAX_DEPTH + "]" * MAX_DEPTH)
    with pytest.raises(ValueError, match=f"nested deeper than {MAX_DEPTH}"):
        plain_json("[" * (MAX_DEPTH + 1) + "]" * (MAX_DEPTH + 1))


@pytest.mark.parametrize("bracket", ["[", '{"a":'])
def test_depth_is_counted_before_the_stack_is_used(bracket: str) -> None:
    with pytest.raises(ValueError, match="nested deeper"):
        plain_json(bracket * 100 * sys.getrecursionlimit())


@pytest.mark.parametrize("text", ["", "[", '"', '"' + "[" * 1000, "[]]", '{"a": "\\"}'])
def test_what_is_no_json_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="line 1"):
        plain_json(text)
