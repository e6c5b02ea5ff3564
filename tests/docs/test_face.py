"""The public names of `fe_drivetrain`: each has an example in python.md, and prints one line."""

import contextlib
import inspect
import sys
from pathlib import Path
from typing import Any

import pytest

import fe_drivetrain
from fe_drivetrain import read_drivetrain
from fe_drivetrain.common.short_repr import LONGEST
from fe_drivetrain.drivetrain_file.scene import coarser_scene
from fe_drivetrain.studies.result import Result

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))

import face_examples

pytestmark = pytest.mark.usefixtures("kept_between_runs")

Names = dict[str, Any]


@pytest.fixture(scope="module")
def names(kept_between_runs: None, tmp_path_factory: pytest.TempPathFactory) -> Names:
    """All names of the page after its last block."""
    found: Names = {}
    with (
        contextlib.chdir(tmp_path_factory.mktemp("face")),
        contextlib.redirect_stdout(None),
    ):
        *others, script = face_examples.blocks()
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(fe_drivetrain, "read_drivetrain", _coarse)
            for block in others:
                exec(compile(block, face_examples.PAGE.name, "exec"), found)
            _spare(patch, found)
            exec(compile(script, face_examples.PAGE.name, "exec"), found)
    return found


def _coarse(source: str, *more: Any) -> Any:
    """As `read_drivetrain`; examples with the library's own mesh of solids need a coarse one."""
    read = read_drivetrain(source, *more)
    fine = source in ("three_point_suspension", "main_bearing_bonded_uncertain")
    return coarser_scene(read, 3.0, 8) if fine else read


def _spare(patch: pytest.MonkeyPatch, found: Names) -> None:
    """Let the script take what the page has found of its scene before: solids need seconds."""
    before = {"check": "checked", "study": "studied", "life": "lived", "advise": "advised"}
    write = fe_drivetrain.write_page

    def write_what_turns(result: Result, folder: Path) -> Path:
        turns = result.STUDY in ("modes", "gears", "transient")
        return write(result, folder) if turns else folder

    for name, result in before.items():
        patch.setattr(fe_drivetrain, name, lambda *_, _of=found[result], **__: _of)
    patch.setattr(fe_drivetrain, "write_page", write_what_turns)
    patch.setattr("fe_drivetrain.command_line.app.main", print)


def test_the_script_from_a_file_to_a_dossier_has_thirty_lines(names: Names) -> None:
    """Results that it writes are evidence, of gears that are strong enough."""
    assert len(face_examples.blocks()[-1].splitlines()) <= 30
    states = {one.link.case: one.state for s in names["validated"].states for one in s.evidence}
    assert states["gears/mine"] == "passed"
    assert {name for name, state in states.items() if state == "missing"} == {
        *("transient/mine-offset", "transient/mine-dip", "life/mine")
    }


def test_each_public_name_has_an_example() -> None:
    shown = [name for group, _ in face_examples.examples() for name in group]
    assert sorted(shown) == fe_drivetrain.__all__
    assert 55 <= len(shown) <= 75


def test_a_name_is_not_that_of_a_room() -> None:
    """Else it is the room once anything imports from that."""
    rooms = {path.parent.name for path in Path(fe_drivetrain.__file__).parent.glob("*/__init__.py")}
    assert not rooms & set(fe_drivetrain.__all__)
    for name in fe_drivetrain.__all__:
        assert not inspect.ismodule(getattr(fe_drivetrain, name)), name


def test_the_examples_find_what_they_say(names: Names) -> None:
    assert names["checked"].mass > 0
    response = names["response"]
    assert max(response.equilibrium_error, response.superposition_error) < 1e-8
    weight = names["scene"].gearbox.weight
    loads = response.history("main_bearing", names["hub_loads"], weight, gravity=9.80665)
    assert loads.shape == (1, 6)
    assert names["again"].points == names["shaft"].points
    years = names["lived"].bearings["main_bearing"].years
    assert 0 < years["L10mr"] < float("inf")
    assert {result.STUDY for result in names.values() if isinstance(result, Result)} == {
        *("check", "study", "advise", "advise_turning", "loads", "life", "modes", "gears"),
        *("transient", "compare", "uncertainty", "validate", "part", "export", "strength"),
    }


def test_what_a_script_prints_is_one_short_line(names: Names) -> None:
    own = {
        name: value
        for name, value in names.items()
        if type(value).__module__.startswith("fe_drivetrain.")
    }
    own["life of a bearing"] = names["lived"].bearings["main_bearing"]
    own["level of the adviser"] = names["advised"].advice.results[0]
    assert len(own) > 20
    for name, value in own.items():
        for text in (repr(value), str(value)):
            assert "\n" not in text, name
            assert len(text) <= LONGEST + len(type(value).__name__) + len("(), ..."), name


def test_every_class_has_an_instance_whose_line_is_short(names: Names) -> None:
    """So that the test above leaves none out but options and errors."""
    made = {type(value) for value in names.values()}
    classes = {name for name in fe_drivetrain.__all__ if inspect.isclass(names[name])}
    without = {name for name in classes if not any(issubclass(t, names[name]) for t in made)}
    options = {"LifeOptions", "LoadOptions"}
    assert without == {"InputError", "Quantity", "Site", *options}
    for value in (names["LifeOptions"](), names["LoadOptions"](), names["Site"](mean_wind=8.5)):
        assert len(repr(value)) < 1000
