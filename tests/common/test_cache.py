"""What is kept is the same to the last bit, and a cache can do no harm."""

import os
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_scenes import COARSE, coarse_scene
from kept_entries import entry, rewrite

from fe_drivetrain.common import cache as cache_module
from fe_drivetrain.common.cache import CACHE_VARIABLE, Cache, key, switched_off, user_cache
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.elasticity.mesh import cached
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.case import Case, find_cases
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.result_folders import run_case
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

CONTENT = {"a": 0.1, "b": [1, "x", None]}


def arrays(seed: int = 0, n: int = 1000) -> dict[str, Any]:
    rng = np.random.default_rng(seed)
    return {
        "floats": rng.standard_normal((n, 3)),
        "singles": rng.standard_normal(n).astype(np.float32),
        "numbers": rng.integers(0, 9, (n, 2)),
        "names": np.array(["shaft", "Lagergehäuse α"]),
        "none": np.empty((0, 6), dtype=np.int64),
    }


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user's cache of its own."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def meshings(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """One entry for each time that gmsh meshes."""
    made: list[int] = []
    generate = cached.generate

    def counted(*arguments: Any, **named: Any) -> Mesh:
        made.append(len(made))
        return generate(*arguments, **named)

    monkeypatch.setattr(cached, "generate", counted)
    return made


# --- one process at a time ----------------------------------------------------------------------

HOLDER = """
import sys, time
from pathlib import Path
import numpy as np
from fe_drivetrain.common.cache import Cache
cache = Cache(Path(sys.argv[1]))
with cache.one_at_a_time("solutions", {"a": 1}):
    print("in", flush=True)
    sys.stdin.readline()
    cache.keep("solutions", {"a": 1}, {"x": np.arange(3)})
"""


def holder(folder: Path) -> subprocess.Popen[str]:
    """A process that is at work on a solution, and keeps it when it is told to."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(folder)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "in\n"
    return process


def test_who_waits_for_another_process_finds_what_that_has_kept(tmp_path: Path) -> None:
    cache = Cache(tmp_path / "cache")
    entered = threading.Event()
    found: list[Any] = []

    def second() -> None:
        with cache.one_at_a_time("solutions", {"a": 1}):
            entered.set()
            found.append(cache.load("solutions", {"a": 1}))

    with holder(tmp_path / "cache") as first:
        assert first.stdin is not None
        with cache.one_at_a_time("solutions", {"a": 2}):
            pass  # of other content nobody waits
        waiting = threading.Thread(target=second)
        waiting.start()
        assert not entered.wait(0.5)
        first.stdin.write("\n")
        first.stdin.flush()
        waiting.join(60)
    (kept,) = found
    np.testing.assert_array_equal(kept["x"], np.arange(3))
    assert [path.suffix for path in (tmp_path / "cache/solutions").iterdir()] == [".arrays"]


def test_a_process_that_dies_lets_go_and_its_lock_is_removed(tmp_path: Path) -> None:
    cache = Cache(tmp_path / "cache")
    with holder(tmp_path / "cache") as first:
        first.kill()
    left = list((tmp_path / "cache/solutions").iterdir())
    assert [path.suffix for path in left] == [".lock"]
    cache.keep("solutions", {"a": 2}, {"x": np.arange(3)})
    assert not left[0].exists()
    with cache.one_at_a_time("solutions", {"a": 1}):
        assert cache.load("solutions", {"a": 1}) is None


def test_without_a_cache_nobody_waits() -> None:
    with Cache(None).one_at_a_time("solutions", {}), Cache(None).one_at_a_time("solutions", {}):
        pass


# --- arrays on disk ------------------------------------------------------------------------------


def test_what_is_loaded_is_what_was_kept(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    assert cache.load("meshes", CONTENT) is None
    cache.keep("meshes", CONTENT, arrays())
    loaded = cache.load("meshes", CONTENT)
    assert loaded is not None
    assert list(loaded) == list(arrays())
    for name, array in arrays().items():
        assert loaded[name].dtype == array.dtype
        assert loaded[name].shape == array.shape
        assert loaded[name].tobytes() == array.tobytes()
    assert cache.has("meshes", CONTENT)
    assert not cache.has("hub-loads", CONTENT)


def test_a_key_depends_on_content_alone_and_on_every_digit() -> None:
    assert key({"a": 1, "b": 2}) == key({"b": 2, "a": 1})
    tenth = 0.1
    others = [
        {"a": tenth},
        {"a": np.nextafter(tenth, 1).item()},
        {"a": "0.1"},
        {"a": [tenth]},
        {"b": tenth},
        {},
    ]
    assert len({key(content) for content in others}) == len(others)


@pytest.mark.parametrize("damage", ["cut", "empty", "text", "header", "middle", "end"])
def test_a_damaged_entry_is_ignored_and_rewritten(tmp_path: Path, damage: str) -> None:
    cache = Cache(tmp_path)
    cache.keep("meshes", CONTENT, arrays())
    (file,) = tmp_path.rglob("*.arrays")
    content = bytearray(file.read_bytes())
    if damage == "cut":
        content = content[: len(content) // 2]
    elif damage == "empty":
        content.clear()
    elif damage == "text":
        content = bytearray(b"not an archive")
    else:
        where = {"header": 60, "middle": len(content) // 2, "end": -1}
        content[where[damage]] ^= 0x55
    file.write_bytes(content)
    assert cache.load("meshes", CONTENT) is None
    cache.keep("meshes", CONTENT, arrays())
    loaded = cache.load("meshes", CONTENT)
    assert loaded is not None
    np.testing.assert_array_equal(loaded["floats"], arrays()["floats"])


def test_a_write_that_is_stopped_leaves_the_old_entry(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = Cache(tmp_path)
    cache.keep("meshes", CONTENT, arrays())

    def stopped(stream: Any, *content: Any) -> None:
        stream.write(b"half")
        raise KeyboardInterrupt

    monkeypatch.setattr(cache_module, "write_kept", stopped)
    with pytest.raises(KeyboardInterrupt):
        cache.keep("meshes", CONTENT, arrays(1))
    loaded = cache.load("meshes", CONTENT)
    assert loaded is not None
    np.testing.assert_array_equal(loaded["floats"], arrays()["floats"])
    assert len(list((tmp_path / "meshes").iterdir())) == 1


def test_a_folder_that_cannot_be_written_keeps_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    cache = Cache(tmp_path / "file")
    cache.keep("meshes", CONTENT, arrays())
    assert cache.load("meshes", CONTENT) is None


def test_beyond_the_limit_what_was_used_longest_ago_is_dropped(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    for k in range(4):
        cache.keep("meshes" if k % 2 else "hub-loads", {"k": k}, arrays(k))
    files = sorted(tmp_path.rglob("*.arrays"), key=lambda file: file.stat().st_mtime_ns)
    size = files[0].stat().st_size
    for age, file in enumerate(reversed(files)):
        os.utime(file, (1e9 - age, 1e9 - age))
    assert cache.load("hub-loads", {"k": 0}) is not None  # used now, though made first
    stranger = tmp_path / "meshes" / "thesis.npz"
    np.savez(stranger, years=np.ones(10**5))
    os.utime(stranger, (0, 0))
    Cache(tmp_path, limit=3 * size).keep("meshes", {"k": 4}, arrays(4))
    kept = [
        k for k in range(5) if cache.has("meshes" if k % 2 or k == 4 else "hub-loads", {"k": k})
    ]
    assert kept == [0, 3, 4]
    assert stranger.exists()


def test_the_variable_moves_the_cache_or_switches_it_off(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    assert user_cache().folder == tmp_path
    with switched_off():
        assert user_cache().folder is None
        user_cache().keep("meshes", CONTENT, arrays())
        assert user_cache().load("meshes", CONTENT) is None
    assert user_cache().folder == tmp_path
    assert list(tmp_path.iterdir()) == []
    for word in ("off", "OFF", "0"):
        monkeypatch.setenv(CACHE_VARIABLE, word)
        assert user_cache().folder is None
    monkeypatch.delenv(CACHE_VARIABLE)
    folder = user_cache().folder
    assert folder is not None
    assert folder.is_absolute()
    with switched_off():
        pass
    assert CACHE_VARIABLE not in os.environ


# --- meshes --------------------------------------------------------------------------------------


def same(first: Mesh, second: Mesh) -> None:
    """Equal to the last bit, and laid out in the same way in memory."""
    assert first.part_names == second.part_names
    assert list(first.faces) == list(second.faces)
    assert first.named_points == second.named_points
    pairs = [(getattr(first, name), getattr(second, name)) for name in ("points", "cells", "part")]
    pairs += [(first.faces[name], second.faces[name]) for name in first.faces]
    for a, b in pairs:
        assert (a.dtype, a.shape, a.strides) == (b.dtype, b.shape, b.strides)
        assert a.tobytes() == b.tobytes()


@pytest.mark.parametrize("kind", ["spherical", "bonded"])
def test_a_kept_mesh_is_the_mesh(folder: Path, meshings: list[int], kind: str) -> None:
    scene = coarse_scene(kind)
    made, kept = mesh_scene(scene), mesh_scene(scene)
    assert len(meshings) == 1
    assert (made.kept, kept.kept) == (False, True)
    same(made, kept)
    with switched_off():
        same(mesh_scene(scene), kept)


def test_results_are_the_same_to_the_last_bit_whether_the_mesh_was_kept_or_not(
    folder: Path,
) -> None:
    scene = coarse_scene("bonded")
    found = []
    for _ in range(2):
        model = build_model(scene, mesh_scene(scene))
        found.append((model.mesh.kept, model.stiffness, unit_load_response(model, "superlu")))
    (_, K, made), (was_kept, kept_K, kept) = found
    assert was_kept
    assert K.data.tobytes() == kept_K.data.tobytes()
    assert made.displacements.tobytes() == kept.displacements.tobytes()
    for name, reaction in made.reactions.items():
        assert reaction.tobytes() == kept.reactions[name].tobytes()


def test_what_a_mesh_does_not_depend_on_meshes_nothing(folder: Path, meshings: list[int]) -> None:
    scene = coarse_scene("spherical")
    first = mesh_scene(scene)
    for change in (
        {"title": "another"},
        {"shaft.material": "ductile_iron"},
        {"bearing_units.0.interface": "rigid"},
        {"gearbox.stiffness": [1e6, 1e6, 1e6, "rigid", 0, 0]},
        {"hub.coupling": "rigid"},
    ):
        same(mesh_scene(change_scene(scene, change)), first)
    assert len(meshings) == 1


@pytest.mark.parametrize(
    "change",
    [
        {"mesh.shaft": 0.31},
        {"mesh.elements_per_turn": 13},
        {"shaft.sections.0.outer_diameter": 0.4000000000001},
        {"bearing_units.0.housing.wall": 0.081},
    ],
)
def test_what_a_mesh_depends_on_makes_another(
    folder: Path, monkeypatch: pytest.MonkeyPatch, change: dict[str, Any]
) -> None:
    """Only the key is looked at, so that nothing needs to be meshed."""
    asked: list[str] = []
    monkeypatch.setattr(Cache, "load", lambda self, kind, content: asked.append(key(content)))
    monkeypatch.setattr(cached, "generate", lambda *arguments, **named: _mesh())
    scene = coarse_scene("spherical")
    mesh_scene(scene)
    mesh_scene(change_scene(scene, change))
    mesh_scene(coarse_scene("bonded"))
    assert len(set(asked)) == 3


def _mesh() -> Mesh:
    empty = np.empty((0, 10), dtype=np.int64)
    return Mesh(np.empty((0, 3)), empty, empty[:, 0], ("shaft",), {}, {})


def test_another_mesher_or_other_code_meshes_again(
    folder: Path, meshings: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = coarse_scene("bonded")
    mesh_scene(scene)
    made_by = cached._made_by()
    for name in ("gmsh", "code"):
        monkeypatch.setattr(cached, "_made_by", lambda n=name: {**made_by, n: "another"})
        assert not mesh_scene(scene).kept
    assert len(meshings) == 3


@pytest.mark.parametrize("damage", ["lost", "cut"])
def test_a_mesh_that_is_not_as_it_was_written_is_made_again(
    folder: Path, meshings: list[int], damage: str
) -> None:
    scene = coarse_scene("bonded")
    made = mesh_scene(scene)
    (file,) = folder.rglob("*.arrays")
    if damage == "cut":
        file.write_bytes(file.read_bytes()[:-1000])
    else:
        rewrite(file, {name: array for name, array in entry(file).items() if name != "face 2"})
    same(mesh_scene(scene), made)
    same(mesh_scene(scene), made)
    assert len(meshings) == 2


# --- cases ---------------------------------------------------------------------------------------


def test_results_say_that_a_mesh_came_from_the_cache(folder: Path, tmp_path: Path) -> None:
    case = find_cases("torsional_stiffness")[0]
    found = []
    for name in ("made", "kept"):
        run_case(case, tmp_path / name, dict(COARSE), quick=True)
        found.append(read_results(tmp_path / name / "results.json"))
    made, kept = found
    assert not any("from the cache" in step for step in made.times)
    assert any("mesh" in step and "from the cache" in step for step in kept.times)
    assert made.figures == kept.figures
    assert made.verdicts == kept.verdicts


def test_a_case_that_measures_takes_nothing_from_the_cache(folder: Path, tmp_path: Path) -> None:
    seen: dict[bool, Path | None] = {}
    for alone in (True, False):

        def work(run: Run, page: Page, alone: bool = alone) -> None:
            seen[alone] = user_cache().folder
            page.answer("Which?", "This one.", [])

        run_case(Case("a/b", "t", "s", work, alone=alone), tmp_path / "out")
    assert seen == {True: None, False: folder}
    assert user_cache().folder == folder
