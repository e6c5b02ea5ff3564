"""A solution from the cache is the one that would be solved, to the last bit."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from kept_entries import entry, rewrite

from fe_drivetrain.common import provenance
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.provenance import arithmetic, source_hash
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.shafts.fidelity import bearing_units
from fe_drivetrain.shafts.fidelity.bearing_units import unit_bounds, unit_stiffness
from fe_drivetrain.shafts.response import cached, solution_keys
from fe_drivetrain.shafts.response.cached import cached_response, solved_content
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.unit_loads import Response

GROUPS = ("reactions", "positions", "motions", "strain_energy")


@pytest.fixture
def solves(monkeypatch: pytest.MonkeyPatch, bonded_response: Response) -> list[Model]:
    """One entry for each time that a system is solved; what is found was solved once a session."""
    made: list[Model] = []

    def counted(model: Model, method: str, seed: int) -> Response:
        made.append(model)
        return bonded_response

    monkeypatch.setattr(cached, "unit_load_response", counted)
    return made


def assert_same(a: Response, b: Response) -> None:
    for group in GROUPS:
        one, other = getattr(a, group), getattr(b, group)
        assert list(one) == list(other)  # reactions are stacked in this order
        for name in one:
            assert one[name].shape == other[name].shape
            assert one[name].tobytes() == other[name].tobytes()
    assert a.displacements.tobytes() == b.displacements.tobytes()
    assert a.diagnostics == b.diagnostics
    assert a.equilibrium_error == b.equilibrium_error
    assert a.superposition_error == b.superposition_error


def test_a_kept_solution_is_the_one_that_was_solved(
    tmp_path: Path, bonded_model: Model, bonded_response: Response, solves: list[Model]
) -> None:
    cache = Cache(tmp_path)
    none, first, again = (
        cached_response(bonded_model, cache=c) for c in (Cache(None), cache, cache)
    )
    assert len(solves) == 2
    assert [r.kept for r in (none, first, again)] == [False, False, True]
    for response in (none, first, again):
        assert_same(response, bonded_response)
    # histories, too, to the last digit: arrays lie in memory in the same way
    loads = np.random.default_rng(1).standard_normal((500, 6)) * 1e5
    for name in bonded_response.reactions:
        reactions = [r.history(name, loads, 1e5, 9.81) for r in (none, first, again)]
        assert reactions[0].tobytes() == reactions[1].tobytes() == reactions[2].tobytes()


@pytest.mark.parametrize(
    "change",
    [
        {"shaft.material": "ductile_iron"},
        {"gearbox.stiffness": [0.0, 3e7, 2e7, "rigid", 0.0, 0.0]},
        {"hub.coupling": "rigid"},
    ],
)
def test_what_a_solution_depends_on_is_in_its_key(change: dict[str, Any]) -> None:
    scene = coarse_scene("bonded")
    assert solved_content(scene) != solved_content(change_scene(scene, change))


@pytest.mark.parametrize(
    "change",
    [
        {"title": "another"},
        {"gearbox.weight": 3e5},
        {"bearing_units.0.catalogue": "bearing_x"},
        {"uncertainty": {"shaft.front": {"uniform": 0.001}}},
    ],
)
def test_what_a_solution_does_not_depend_on_is_not(change: dict[str, Any]) -> None:
    scene = coarse_scene("bonded")
    assert solved_content(scene) == solved_content(change_scene(scene, change))


def test_another_mesh_solver_or_maker_is_solved_again(
    tmp_path: Path,
    bonded_model: Model,
    solves: list[Model],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cache = Cache(tmp_path)
    cached_response(bonded_model, cache=cache)
    points = bonded_model.mesh.points.copy()
    points[0, 0] = np.nextafter(points[0, 0], 10.0)
    moved = replace(bonded_model, mesh=replace(bonded_model.mesh, points=points))
    assert not cached_response(moved, cache=cache).kept
    assert not cached_response(bonded_model, "superlu", cache=cache).kept
    assert not cached_response(bonded_model, seed=1, cache=cache).kept
    monkeypatch.setattr(solution_keys, "_programs", lambda: {"code": "of an older version"})
    assert not cached_response(bonded_model, cache=cache).kept
    assert len(solves) == 5


def cut(file: Path, arrays: dict[str, Any]) -> None:
    file.write_bytes(file.read_bytes()[:5000])


def incomplete(file: Path, arrays: dict[str, Any]) -> None:
    rewrite(file, {k: v for k, v in arrays.items() if k != "reactions 1"})


def other_diagnostics(file: Path, arrays: dict[str, Any]) -> None:
    rewrite(file, arrays | {"diagnostics": np.array('{"of": "another form"}')})


@pytest.mark.parametrize("damage", [cut, incomplete, other_diagnostics])
def test_an_entry_that_is_not_sound_is_solved_again(
    tmp_path: Path,
    bonded_model: Model,
    bonded_response: Response,
    solves: list[Model],
    damage: Callable[[Path, dict[str, Any]], None],
) -> None:
    cache = Cache(tmp_path)
    cached_response(bonded_model, cache=cache)
    (file,) = tmp_path.rglob("*.arrays")
    damage(file, entry(file))
    again = cached_response(bonded_model, cache=cache)
    assert not again.kept
    assert_same(again, bonded_response)
    assert cached_response(bonded_model, cache=cache).kept
    assert len(solves) == 2


def test_solutions_count_for_the_bound_in_size(
    tmp_path: Path, bonded_model: Model, solves: list[Model]
) -> None:
    cache = Cache(tmp_path, limit=0)
    cached_response(bonded_model, cache=cache)
    assert list(tmp_path.rglob("*.arrays")) == []


def test_bounds_of_a_bearing_unit_are_kept_to_the_last_bit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = coarse_scene("bonded", **{"mesh.elements_per_turn": 8, "mesh.housing": 0.2})
    cache = Cache(tmp_path)
    first = unit_bounds(scene, "main_bearing", cache)
    soft = unit_stiffness(scene, "main_bearing", cache=cache)
    monkeypatch.setattr(bearing_units, "_solved_unit", None)  # would fail if it were called
    again = unit_bounds(scene, "main_bearing", cache)
    assert unit_stiffness(scene, "main_bearing", cache=cache).tobytes() == soft.tobytes()
    assert soft.tobytes() == first.soft.tobytes()
    assert first.mesh == again.mesh
    assert first.soft.tobytes() == again.soft.tobytes()
    assert first.stiff.tobytes() == again.stiff.tobytes()
    with pytest.raises(TypeError):
        unit_bounds(change_scene(scene, {"mesh.housing": 0.21}), "main_bearing", cache)


def test_of_the_shaft_a_bearing_unit_depends_on_its_seat_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache, scene = Cache(tmp_path), coarse_scene("bonded")
    found = unit_stiffness(scene, "main_bearing", cache=cache)
    section = "shaft.sections.0"
    bored = change_scene(scene, {f"{section}.inner_diameter": 0.2, "shaft.front": -1.0})
    fresh = unit_stiffness(bored, "main_bearing", cache=Cache(None))
    assert fresh.tobytes() == found.tobytes()

    def solved(*_: object, **__: object) -> None:
        raise AssertionError("solved again")

    monkeypatch.setattr(bearing_units, "_solved_unit", solved)
    kept = unit_stiffness(bored, "main_bearing", cache=cache)
    assert kept.tobytes() == found.tobytes()
    wider = change_scene(scene, {f"{section}.outer_diameter": 0.45})
    with pytest.raises(AssertionError, match="solved again"):
        unit_stiffness(wider, "main_bearing", cache=cache)


def test_threads_and_code_are_in_the_key(monkeypatch: pytest.MonkeyPatch) -> None:
    import numba

    before = arithmetic()
    monkeypatch.setattr(numba, "get_num_threads", lambda: 17)
    assert arithmetic() != before
    room = "fe_drivetrain.shafts.response"
    assert source_hash({room: {"model.py"}}) != source_hash({room: {"unit_loads.py"}})


def test_a_program_has_one_hash_wherever_its_cases_lie(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the repository cases and geometry stand beside the package, installed within it."""
    found = []
    for layout in ("beside", "within"):
        root = tmp_path / layout
        around = root / "fe_drivetrain" if layout == "within" else root
        folders = {"fe_drivetrain": root / "fe_drivetrain"}
        folders |= {f"fe_drivetrain.{name}": around / name for name in ("geometry", "cases")}
        for package, folder in folders.items():
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "one.py").write_text(package)
        monkeypatch.setattr(provenance, "files", folders.__getitem__)
        found.append(provenance.program_hash.__wrapped__())
        (folders["fe_drivetrain.cases"] / "one.py").write_text("changed")
        assert provenance.program_hash.__wrapped__() != found[-1]
    assert found[0] == found[1]
