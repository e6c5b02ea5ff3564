"""Input that is wrong at random: one sentence, or the figures that were given; never anything else.

A fault found here is kept as an example of its own, so that it is tried each time.
"""

import contextlib
import csv
import io
import json
import math
import os
import struct
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from tiny_case import check_one

from fe_drivetrain.command_line.app import main
from fe_drivetrain.command_line.settings import parse_settings
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, parse_scene, read_scene
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.geometry.part import MAXIMUM, MINIMUM
from fe_drivetrain.report.suite import case as case_module
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.response.model import mesh_scene
from fe_drivetrain.turbine_loads.hub_loads.files import read_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.histories import MAX_LOAD

SCENE: dict[str, Any] = {
    "title": "small",
    "shaft": {
        "front": -1.0,
        "flange": {"outer_diameter": 0.5, "thickness": 0.1, "fillet": 0.02},
        "sections": [
            {"length": 1.2, "outer_diameter": 0.4, "inner_diameter": 0.1, "fillet": 0.0},
            {"length": 0.7, "outer_diameter": 0.36, "outer_diameter_end": 0.35},
        ],
        "material": "alloy",
    },
    "bearing_units": [
        {
            "bearing": {"name": "main_bearing", "x": -0.2, "width": 0.2, "kind": "spherical"},
            "housing": {"wall": 0.11, "centre_height": 0.42, "base": "fixed"},
            "interface": "sliding",
        }
    ],
    "hub": {"coupling": "averaged"},
    "gearbox": {"stiffness": [4e6, 8e7, 8e7, "rigid", 0, 0], "weight": 1000.0},
    "materials": {"alloy": {"youngs_modulus": 7e10, "poisson_ratio": 0.33, "density": 2700.0}},
    "mesh": {"shaft": 0.3, "bearing": 0.1, "housing": 0.1, "elements_per_turn": 12},
}

#: What stands in files instead of a number.
NUMBERS = ["nan", "-inf", ".nan", "1e400", "-1e-400", "0x10", "010", "1_0", "1:30", "1,5", "1e3 N"]
junk: st.SearchStrategy[Any] = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.sampled_from([0, -1, 10**400, 2**63, 1e300, -1e300, 1e-300, 5e-324, -0.0]),
    st.floats(),
    st.sampled_from(NUMBERS),
    st.text(max_size=20),
    st.just("x" * 5000),
    st.lists(st.integers(), max_size=3),
    st.dictionaries(st.text(max_size=3), st.integers(), max_size=2),
)
#: The signs that mean something to YAML, so that a random text is not just a word.
yaml_text = st.text(st.sampled_from("{}[]:,-&*!|>'\"%@`#?=<~.\\\n\t 019aefoxy\u00e4\u2028\x85\0"))


def paths(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every place in nested mappings and lists."""
    if path:
        yield path
    items: Any = node.items() if isinstance(node, dict) else ()
    for key, value in enumerate(node) if isinstance(node, list) else items:
        yield from paths(value, (*path, key))


PATHS = list(paths(SCENE))


def at(node: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        node = node[key]
    return node


def one_sentence(error: InputError, most: int = 1000) -> None:
    """What an error may look like, whatever it quotes."""
    text = str(error)
    assert text.isprintable()
    assert 10 < len(text) < most
    text.encode()


def refused_or_sound(read: Callable[[], Scene]) -> Scene | None:
    try:
        scene = read()
    except InputError as error:
        one_sentence(error)
        return None
    assert change_scene(scene, {}) == scene
    for path in paths(scene.model_dump(mode="json")):
        value = at(scene.model_dump(mode="json"), path)
        assert not isinstance(value, float) or math.isfinite(value)
    return scene


# --- scenes --------------------------------------------------------------------------------------


@given(st.sampled_from(PATHS), junk)
@example(("shaft", "sections", 0, "length"), True)
@example(("gearbox", "weight"), False)
@example(("materials", "alloy", "density"), True)
@example(("gearbox", "weight"), 10**400)
@example(("shaft", "front"), "\ud800")
@example(("mesh", "shaft"), 1e-300)
@example(("shaft", "sections", 0, "outer_diameter"), 1e300)
def test_a_wrong_value_is_refused_or_taken_as_it_is(path: tuple[Any, ...], value: Any) -> None:
    data = json.loads(json.dumps(SCENE))
    at(data, path[:-1])[path[-1]] = value
    scene = refused_or_sound(lambda: parse_scene(json.dumps(data)))
    if scene is None:
        return
    assert not isinstance(value, bool)
    found = at(scene.model_dump(mode="json"), path)
    if isinstance(found, float) or (isinstance(found, int) and value is not None):
        assert float(value) == found  # not another number
    if path[-1] in ("length", "outer_diameter", "width", "shaft", "wall") and path[:1] != (
        "title",
    ):
        assert not isinstance(found, float) or MINIMUM <= found <= MAXIMUM


@given(st.sampled_from(PATHS), st.text(max_size=12))
@example(("gearbox",), "we\night")
@example(("shaft",), "\x1b[31m")
@example(("shaft",), "x" * 5000)
def test_a_missing_or_unknown_key_is_named(path: tuple[Any, ...], name: str) -> None:
    data = json.loads(json.dumps(SCENE))
    parent = at(data, path[:-1])
    old = parent.pop(path[-1])
    refused_or_sound(lambda: parse_scene(json.dumps(data)))
    if isinstance(parent, dict) and name not in (SCENE | parent | {path[-1]: 0}):
        parent[name] = old
        scene = refused_or_sound(lambda: parse_scene(json.dumps(data)))
        assert scene is None or path[0] == "materials" or path[-1] == "title" or name in str(scene)


@given(yaml_text)
@example("? [1, 2]\n: 3\n")
@example("<<: 5")
@example("a: 0x" + "f" * 5000)
@example("a: " + ":".join(["59"] * 2000))
@example('a: "\\ud800"')
@example("1: 2")
@example("a: &b 1")
@example("a: !!binary abc")
@example("a: 2024-99-99")
def test_a_text_of_yamls_own_signs_is_one_sentence(text: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    one_sentence(caught.value)


@given(st.binary(max_size=300))
def test_a_file_of_any_bytes_is_one_sentence(content: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "scene.yaml")
        file.write_bytes(content)
        with pytest.raises(InputError) as caught:
            read_scene(file)
    one_sentence(caught.value)


@pytest.mark.parametrize("text", ["[" * 5000, "{a: " * 5000, "- " * 5000, "'" * 99_999])
def test_deep_and_long_texts_end_at_once(text: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    one_sentence(caught.value)


def test_numbers_are_read_as_they_are_written_and_not_as_yaml_1_1_has_them() -> None:
    """010 was 8, 1:30 was 90 and true was 1."""

    def weight(text: str) -> float:
        scene = json.dumps(SCENE).replace("1000.0", text)
        return parse_scene(scene).gearbox.weight

    assert weight("010") == 10.0
    for text in ("1:30", "true", "0x10", "2026-01-31"):
        with pytest.raises(InputError):
            weight(text)


@given(
    st.one_of(
        st.text(max_size=30),
        st.lists(
            st.sampled_from(
                ["shaft", "sections", "0", "-1", "7", "\u00b2", "\u0660", "", "9" * 5000]
            ),
            max_size=4,
        ).map(".".join),
    ),
    junk,
)
@example("shaft.sections.\u00b2", 1)
@example("shaft.sections.\u0660.length", 1)
@example("shaft.sections." + "9" * 5000, 1)
def test_a_change_of_any_key_is_made_or_refused(key: str, value: Any) -> None:
    refused_or_sound(lambda: parse_scene(json.dumps(SCENE), {key: value}))


@pytest.mark.parametrize("name", ["a\0b", "/", "x" * 5000, "/proc/self/mem", ""])
def test_a_name_that_is_no_scene_file_is_one_sentence(name: str) -> None:
    with pytest.raises(InputError) as caught:
        read_scene(name)
    one_sentence(caught.value, 11_000)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"mesh.bearing_edge": 1e-5}, "bearing_edge"),
        ({"mesh.bearing": 1e-4}, "mesh size 'bearing'"),
        ({"shaft.sections.0.inner_diameter": 1e-4}, "part 'shaft'"),
        ({"mesh.shaft": 0.005}, "part 'shaft'"),
    ],
)
def test_sizes_that_would_mesh_for_ever_are_refused_before(
    changes: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=f"{words}.*elements, but must make at most") as caught:
        mesh_scene(parse_scene(json.dumps(SCENE), {"mesh.housing": 0.1, **changes}))
    one_sentence(caught.value)


# --- hub loads -----------------------------------------------------------------------------------

HEADER = "time [s],Fx [kN],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]"


def read(content: str | bytes, suffix: str) -> Any:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, f"x{suffix}")
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        try:
            history = read_hub_loads(file)
        except InputError as error:
            one_sentence(error)
            return None
    assert np.isfinite(history.loads).all()
    assert np.abs(history.loads).max() <= MAX_LOAD
    assert (np.diff(history.time) > 0.0).all()
    return history


cell = st.one_of(
    st.floats().map(repr),
    st.sampled_from(
        [*NUMBERS, "", " ", '"1"', '"', "1;2", "\u0661", "1\u00a0", "1\0", "--1", "1d3"]
    ),
    st.text(st.characters(codec="utf-8"), max_size=6),
)


@given(st.integers(0, 4), st.integers(1, 6), cell)
@example(2, 1, "0,1")
@example(2, 1, "1_0")
@example(2, 1, "\u0661")
@example(2, 1, "1" * 200_000)
def test_a_cell_of_a_table_is_the_number_that_it_says(row: int, column: int, text: str) -> None:
    rows = [[str(i), *"123456"] for i in range(5)]
    rows[row][column] = text
    history = read("\n".join([HEADER, *map(",".join, rows)]), ".csv")
    if history is not None:
        (said,) = next(csv.reader([text]))
        factor = 1e3 if column == 1 else 1.0
        assert history.loads[row, column - 1] == float(said) * factor
        assert "_" not in text
        assert len(history) == 5


def test_decimal_commas_do_not_shift_numbers_into_other_columns() -> None:
    """0,1 in place of 0.1 made eight cells for seven columns, and all were read, one off."""
    rows = [f"{i},0,1,2,3,4,5,6" for i in range(5)]
    assert read("\n".join([HEADER, *rows]), ".csv") is None


@given(st.text(st.sampled_from('time[s],FxyzM Nmk0123456789.e-+"#=\n\r;'), max_size=200), st.data())
def test_any_table_is_read_or_refused(text: str, data: st.DataObject) -> None:
    where = data.draw(st.integers(0, len(HEADER)))
    rows = "".join(f"\n{i},1,2,3,4,5,6" for i in range(4))
    for content in (text, HEADER[:where] + text + HEADER[where:] + rows, HEADER + "\n" + text):
        read(content, ".csv")
        read("\n" * 6 + content.replace(",", " "), ".out")


def outb(identifier: int = 2, channels: int = 6, samples: int = 5) -> bytes:
    """An OpenFAST binary file of six channels."""
    names = ["LSShftFxa", "LSShftFys", "LSShftFzs", "LSShftMxa", "LSSTipMys", "LSSTipMzs"]
    units = ["(kN)"] * 3 + ["(kN-m)"] * 3
    out = struct.pack(
        "<hii2d",
        identifier,
        channels,
        samples,
        *((10.0, 0.0) if identifier == 1 else (0.0, 0.1)),
    )
    out += struct.pack("<12f", *[1.0] * 6, *[0.0] * 6) + struct.pack("<i", 4) + b"test"
    out += b"".join(n.ljust(10).encode() for n in ["Time", *names])
    out += b"".join(u.ljust(10).encode() for u in ["(s)", *units])
    if identifier == 1:
        out += struct.pack("<5i", *range(5))
    return out + struct.pack("<30h", *range(30))


@pytest.mark.parametrize("identifier", [1, 2])
def test_the_binary_file_that_is_damaged_below_is_sound(identifier: int) -> None:
    history = read(outb(identifier), ".outb")
    np.testing.assert_array_equal(history.loads, 1e3 * np.arange(30.0).reshape(5, 6))


@given(st.sampled_from([1, 2]), st.integers(0, 10**6), st.integers(0, 255), st.booleans())
def test_a_damaged_binary_file_is_read_or_refused(
    identifier: int, place: int, value: int, cut: bool
) -> None:
    content = bytearray(outb(identifier))
    place %= len(content)
    content[place] = value
    with np.errstate(all="ignore"):
        read(bytes(content[: place + 1] if cut else content), ".outb")


@pytest.mark.parametrize("identifier", [1, 2, 3, 4])
@pytest.mark.parametrize("counts", [(2**31 - 1, 2**31 - 1), (7, 2**31 - 1), (-1, -1), (0, 0)])
def test_counts_that_the_file_cannot_hold_take_no_memory(
    identifier: int, counts: tuple[int, int]
) -> None:
    """Their reader asked for 38 s and for all memory."""
    start = (
        struct.pack("<h", identifier) + b"\n\0" * (identifier == 4) + struct.pack("<2i", *counts)
    )
    assert read(start + bytes(3000), ".outb") is None


# --- the command line ----------------------------------------------------------------------------


def tiny(run: Run, page: Page) -> None:
    (run.folder / "half.txt").write_text("half")
    check_one(page)


CASES = {name: Case(name, "A tiny case", "nobody", tiny) for name in ("group/tiny", "group/other")}


def invoke(arguments: list[str]) -> tuple[int, str, set[str]]:
    """Run the command line in a folder of its own: status, what it said, and what it left."""
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as top, contextlib.ExitStack() as stack:
        folder = Path(top, "a", "b", "c")
        folder.mkdir(parents=True)
        (folder / "file").write_text("x")
        (folder / "scene.yaml").write_text("shaft: 5")
        os.chdir(folder)
        stack.callback(os.chdir, before)
        said = io.StringIO()
        stack.enter_context(contextlib.redirect_stdout(said))
        stack.enter_context(contextlib.redirect_stderr(said))
        stack.enter_context(mock.patch.object(sys, "argv", ["fe-drivetrain", *arguments]))
        stack.enter_context(mock.patch.object(case_module, "all_cases", return_value=CASES))
        with pytest.raises(SystemExit) as end:
            main()
        left = {str(p.relative_to(top)) for p in Path(top).rglob("*")}
        code = end.value.code
    return (0 if code is None else int(code)), said.getvalue(), left


# no slash, so that nothing is written outside of the folder
word = st.text(
    st.characters(exclude_characters="/\0", codec=None, max_codepoint=0x2100), max_size=12
)
argument = st.one_of(
    st.sampled_from(
        ["run", "export", "list", "tiny", "group", "--all", "--quick", "--set", "--out", "--junit"]
    ),
    st.sampled_from(["file", "scene.yaml", "x.vtu", "x.inp", "new", "k=1", "k=[1", "=", "-", "--"]),
    word,
    st.tuples(word, st.one_of(word, yaml_text.filter(lambda t: "\0" not in t))).map("=".join),
)


@given(st.lists(argument, max_size=6))
@example(["run", "tiny", "--set", "k=\udcff"])
@example(["run", "tiny", "--set", 'k="\\ud800"'])
@example(["run", "tiny", "--set", "\udcff=1"])
@example(["run", "tiny", "--set", "k=1e400"])
@example(["run", "tiny", "--out", "\udcff"])
@example(["export", "scene.yaml", "--out", "x.vtu"])
@example(["export", "scene.yaml", "--out", "\udcff.vtu"])
@example(["run", "tiny", "--out", "x\n\x1b[31m"])
@example(["run", "\udcff"])
def test_any_arguments_end_with_a_status_and_leave_nothing_half_written(
    arguments: list[str],
) -> None:
    status, said, left = invoke(arguments)
    assert status in (0, 1, 2)
    assert "Traceback" not in said
    assert (status == 0) or said
    assert not [name for name in left if Path(name).name.startswith(".")] or any(
        argument.startswith(".") for argument in arguments
    )
    for name in left:
        assert not name.endswith("half.txt") or str(Path(name).with_name("results.json")) in left


def test_the_command_line_that_is_fuzzed_can_run() -> None:
    status, _, left = invoke(["run", "tiny", "--out", "x"])
    assert status == 0
    assert "a/b/c/x/results.json" in left


@given(st.lists(st.one_of(word, yaml_text, st.tuples(word, yaml_text).map("=".join)), max_size=3))
def test_settings_are_plain_values_or_refused(texts: list[str]) -> None:
    try:
        settings = parse_settings(texts)
    except InputError as error:
        one_sentence(error)
        return
    json.dumps(settings, allow_nan=False, ensure_ascii=False).encode()


def test_a_mesh_is_a_mesh() -> None:
    """The scene that is made wrong above is right: its mesh can be built."""
    mesh = mesh_scene(parse_scene(json.dumps(SCENE)))
    assert isinstance(mesh, Mesh)
    assert len(mesh.cells) > 500
