"""A kept file is what it is taken for, to the last bit, or it is not taken."""

import io
import logging
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from kept_entries import kind_and_key

from fe_drivetrain.common import kept_files
from fe_drivetrain.common.cache import Cache, Kind, key
from fe_drivetrain.common.kept_files import UnfitError, read_kept, write_kept

KEY = '{"a":0.1}'
ARRAYS = {
    "floats": np.arange(6.0).reshape(2, 3),
    "by columns": np.asfortranarray(np.arange(4).reshape(2, 2)),
    "strided": np.arange(6.0)[::2],
    "text": np.array("α\n"),
    "names": np.array(["hub", "Lagergehäuse"]),
    "none": np.empty((0, 3), dtype=np.int32),
    "complex": np.array([1.0 + 2.0j]),
    "big-endian": np.array([1, 2], dtype=">i4"),
}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "entry"
    with path.open("wb") as stream:
        write_kept(stream, "meshes", KEY, ARRAYS)
    return path


def test_arrays_come_back_to_the_last_bit_with_their_layout(file: Path) -> None:
    found = read_kept(file, "meshes", KEY)
    assert list(found) == list(ARRAYS)
    for name, array in ARRAYS.items():
        assert (found[name].dtype, found[name].shape) == (array.dtype, array.shape)
        assert found[name].tobytes("A") == array.tobytes("A")
        assert found[name].flags.forc
        assert found[name].flags.writeable
    assert not found["by columns"].flags.c_contiguous
    assert kind_and_key(file) == ("meshes", KEY)


def test_no_bit_can_turn_unnoticed(file: Path) -> None:
    content = file.read_bytes()
    for place in range(len(content)):
        for bit in range(8):
            changed = bytearray(content)
            changed[place] ^= 1 << bit
            file.write_bytes(changed)
            with pytest.raises(UnfitError):
                read_kept(file, "meshes", KEY)


def test_no_cut_and_nothing_added_goes_unnoticed(file: Path) -> None:
    content = file.read_bytes()
    for length in range(len(content)):
        file.write_bytes(content[:length])
        with pytest.raises(UnfitError):
            read_kept(file, "meshes", KEY)
    for added in (b"\0", b"\n", content):
        file.write_bytes(content + added)
        with pytest.raises(UnfitError, match="added"):
            read_kept(file, "meshes", KEY)


def test_a_file_of_another_version_kind_or_key_is_not_taken(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for kind, other in (("solutions", KEY), ("meshes", KEY.replace("1", "2"))):
        with pytest.raises(UnfitError, match="something else"):
            read_kept(file, kind, other)
    monkeypatch.setattr(kept_files, "FORM", kept_files.FORM + 1)
    with pytest.raises(UnfitError, match="another version"):
        read_kept(file, "meshes", KEY)
    with file.open("wb") as stream:
        np.savez(stream, floats=np.ones(3))  # the form of earlier versions
    with pytest.raises(UnfitError, match="another version"):
        read_kept(file, "meshes", KEY)


def test_what_has_no_plain_bytes_is_not_kept() -> None:
    for array in (np.array([None]), np.zeros(2, dtype=[("a", float)])):
        with pytest.raises(TypeError, match="cannot be kept"):
            write_kept(io.BytesIO(), "meshes", KEY, {"a": array})


def empty(file: Path, other: Path) -> None:
    file.write_bytes(b"")


def exchange(file: Path, other: Path) -> None:
    file.write_bytes(other.read_bytes())


def pipe(file: Path, other: Path) -> None:
    file.unlink()
    os.mkfifo(file)


def folder(file: Path, other: Path) -> None:
    file.unlink()
    file.mkdir()


@pytest.mark.parametrize("kind", get_args(Kind))
@pytest.mark.parametrize("damage", [empty, exchange, pipe, folder])
def test_what_does_not_fit_is_made_again_and_said(
    tmp_path: Path,
    caplog: pytest.LogCaptureFixture,
    kind: Kind,
    damage: Callable[[Path, Path], None],
) -> None:
    cache = Cache(tmp_path)
    contents: list[dict[str, Any]] = [{"file": "a"}, {"file": "b"}]
    for number, content in enumerate(contents):
        cache.keep(kind, content, {"value": np.array([number])})
    with caplog.at_level(logging.INFO, logger="fe_drivetrain"):
        assert all(cache.load(kind, content) is not None for content in contents)
        assert cache.load(kind, {"file": "c"}) is None
        assert not caplog.records  # what was never kept is no news
        first, second = (tmp_path / kind / f"{k}.arrays" for k in map(key, contents))
        damage(first, second)
        assert cache.load(kind, contents[0]) is None
    assert re.match(rf"kept {kind} are made again: {first.name}", caplog.messages[0])
    cache.keep(kind, contents[0], {"value": np.array([0])})
    again = cache.load(kind, contents[0])
    if damage in (pipe, folder):  # which somebody put there: it stays, and the work is done again
        assert again is None
    else:
        assert again is not None
        assert again["value"] == 0
