"""A drivetrain of one's own: from a file to start from to a study of its reactions."""

import json
import re
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

import jsonschema
import pytest
from tiny_case import Result

from fe_drivetrain.common.reading import parse_mapping
from fe_drivetrain.scene.arrangements import (
    ARRANGEMENTS,
    SCHEMA_FILE,
    scene_schema,
    starting_scene,
)
from fe_drivetrain.scene.reading import is_component, library_scene, parse_scene
from fe_drivetrain.scene.scene import Scene

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text("utf-8")
SCHEMA = json.loads(scene_schema())
LIBRARY = {
    path.name.removesuffix(".yaml"): path.read_text("utf-8")
    for path in sorted((files("fe_drivetrain.geometry") / "library").iterdir(), key=str)
}


def faults(text: str) -> list[str]:
    """What an editor underlines in a scene file."""
    validator = jsonschema.Draft202012Validator(SCHEMA)
    return [error.message for error in validator.iter_errors(parse_mapping(text, "scene"))]


def without(scene: Scene, *keys: str) -> dict[str, object]:
    return scene.model_dump(exclude=set(keys))


@pytest.mark.parametrize("name", ARRANGEMENTS)
def test_a_scene_to_start_from_is_the_one_of_the_library(name: str) -> None:
    text = starting_scene(name)
    assert parse_scene(text) == library_scene(ARRANGEMENTS[name].library)
    assert text.startswith(f"# yaml-language-server: $schema={SCHEMA_FILE}\n")
    assert faults(text) == []


@pytest.mark.parametrize("name", ARRANGEMENTS)
def test_what_else_a_scene_may_have_is_valid_once_its_comment_sign_is_gone(name: str) -> None:
    text, mark, rest = starting_scene(name).partition("# What else a scene may have")
    assert mark
    more = re.sub("^# ?", "", rest.partition("\n")[2], flags=re.MULTILINE)
    scene = parse_scene(text + more)
    assert faults(text + more) == []
    assert without(scene, "materials", "mesh", "uncertainty") == without(
        parse_scene(text), "materials", "mesh", "uncertainty"
    )
    assert scene.uncertainty["shaft.sections.0.outer_diameter"].uniform == 0.001
    assert scene.hub.coupling == "averaged"
    if "mesh" in more:
        assert scene.mesh == parse_scene(text).mesh  # what is shown are the defaults


def test_published_schema_of_scenes_is_that_of_the_program() -> None:
    assert (ROOT / "docs" / SCHEMA_FILE).read_text("utf-8") == scene_schema()


@pytest.mark.parametrize("name", [name for name in LIBRARY if not is_component(LIBRARY[name])])
def test_scenes_of_the_library_follow_the_schema(name: str) -> None:
    assert faults(LIBRARY[name]) == []


def test_documented_scene_follows_the_schema_and_faults_in_it_do_not() -> None:
    text = re.search(r"```yaml\n(.*?)```", (ROOT / "docs/scene.md").read_text("utf-8"), re.DOTALL)
    assert text
    assert faults(text.group(1)) == []
    for right, wrong, reason in (
        ("interface: sliding", "interface: slidng", "slidng"),
        ("  front:", "  frnt:", "frnt"),
        ("outer_diameter: 0.5", "outer_diameter: -0.5", "-0.5"),
        ("title: Example drivetrain\n", "", "title"),
    ):
        assert right in text.group(1)
        found = faults(text.group(1).replace(right, wrong))
        assert any(reason in message for message in found), wrong


def test_new_writes_a_scene_with_its_schema_and_never_over_another(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    status, out, _ = invoke("new", "my.yaml", "--arrangement", "two-bearings")
    assert status == 0
    assert "fe-drivetrain check my.yaml" in out
    file = tmp_path / "my.yaml"
    assert parse_scene(file.read_text("utf-8")) == library_scene("two_bearings")
    assert json.loads((tmp_path / SCHEMA_FILE).read_text("utf-8")) == SCHEMA

    mine = file.read_text("utf-8").replace("0.5", "0.52")
    file.write_text(mine, "utf-8")
    status, _, err = invoke("new", "my.yaml")
    assert status == 2
    assert "my.yaml exists: give another file, or add --overwrite" in err
    assert file.read_text("utf-8") == mine
    # a second scene in the same folder shares the schema
    assert invoke("new", "other.yml")[0] == 0
    assert invoke("new", "my.yaml", "--overwrite")[0] == 0
    assert parse_scene(file.read_text("utf-8")) == library_scene("three_point_suspension")


def test_new_does_not_replace_a_schema_of_another_kind(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    (tmp_path / SCHEMA_FILE).write_text("{}", "utf-8")
    status, _, err = invoke("new", "my.yaml")
    assert status == 2
    assert SCHEMA_FILE in err
    assert not (tmp_path / "my.yaml").exists()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("my.txt",), "my.txt must end in .yaml or .yml"),
        (("no/my.yaml",), "there is no folder no: create it"),
        (("my.yaml", "--arrangement", "five-point"), "use one of three-point, spherical,"),
        ((), "Missing FILE"),
    ],
)
def test_new_refuses_in_one_sentence(
    invoke: Callable[..., Result], words: tuple[str, ...], sentence: str
) -> None:
    status, _, err = invoke("new", *words)
    assert status == 2
    assert sentence in err


def test_new_lists_its_arrangements(invoke: Callable[..., Result]) -> None:
    status, out, _ = invoke("new", "--list")
    assert status == 0
    assert [line.split()[0] for line in out.splitlines()] == list(ARRANGEMENTS)
