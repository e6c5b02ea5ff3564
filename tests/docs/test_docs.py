"""The documentation says what the program does."""

import re
from pathlib import Path
from typing import Any

import pytest

from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.drivetrain_file.reading import parse_scene
from fe_drivetrain.drivetrain_file.scene import Gearbox, Hub, Scene, Spread
from fe_drivetrain.geometry import Bearing, Flange, Housing, MeshSizes, Section, Shaft
from fe_drivetrain.shafts.response.model import mesh_scene
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap, read_channel_map

pytestmark = pytest.mark.usefixtures("kept_between_runs")

ROOT = Path(__file__).parents[2]
SCENE_DOC = (ROOT / "docs" / "scene.md").read_text(encoding="utf-8")
MODELS = (
    Scene,
    Shaft,
    Section,
    Flange,
    BearingUnit,
    Bearing,
    Housing,
    Hub,
    Gearbox,
    MeshSizes,
    Material,
    Spread,
)


@pytest.mark.parametrize("model", MODELS, ids=lambda m: m.__name__)
def test_every_key_of_a_scene_is_documented(model):
    for key in model.model_fields:
        assert re.search(rf"`([a-z_]+\.)?{key}`", SCENE_DOC), f"{model.__name__}.{key}"


def test_the_example_scene_is_valid_and_can_be_meshed():
    text = re.search(r"```yaml\n(.*?)```", SCENE_DOC, re.DOTALL).group(1)
    changes = {"mesh.shaft": 0.3, "mesh.bearing": 0.12, "mesh.housing": 0.12}
    changes |= {"mesh.bearing_edge": 0.12, "mesh.elements_per_turn": 8}
    mesh = mesh_scene(parse_scene(text, changes))
    assert set(mesh.part_names) == {"shaft", "main_bearing", "main_bearing.housing"}


def test_the_library_example_of_the_readme_runs(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    code = re.search(r"```python\n(.*?)```", readme, re.DOTALL).group(1)
    names: dict[str, Any] = {}
    exec(compile(code, "example", "exec"), names)
    result = names["result"]
    assert all(check.passed for check in result.checks)
    figure = result["K_R about y of main_bearing"]
    assert 0 < figure.band < figure.computed
    assert capsys.readouterr().out == f"{result!r}\n"
    assert names["errors"].data
    assert (tmp_path / "errors.html").is_file()


def test_the_example_of_load_histories_runs_and_the_mapping_is_valid(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (ROOT / "docs" / "loads.md").read_text(encoding="utf-8")
    code = re.search(r"```python\n(import numpy.*?)```", text, re.DOTALL).group(1)
    exec(compile(code, "example", "exec"), {"__name__": "__main__"})
    printed = capsys.readouterr().out
    # a sine of 1 rad/s: 95.5 cycles of a range of 2 MN m in 600 s
    size = 2e6 * (600.0 / (2.0 * 3.14159) / 600.0) ** 0.1
    assert float(printed.split()[0]) == pytest.approx(size, rel=0.01)
    (tmp_path / "map.yaml").write_text(re.search(r"```yaml\n(.*?)```", text, re.DOTALL).group(1))
    mapping = read_channel_map(tmp_path / "map.yaml")
    assert mapping.rotating
    for key in ChannelMap.model_fields:
        assert f"`{key}`" in text or f"{key}:" in text


def test_the_example_of_gear_rating_runs(capsys: pytest.CaptureFixture[str]) -> None:
    text = (ROOT / "docs" / "gear_rating.md").read_text(encoding="utf-8")
    code = re.search(r"```python\n(.*?)```", text, re.DOTALL).group(1)
    exec(compile(code, "example", "exec"), {"__name__": "__main__"})
    printed = capsys.readouterr().out
    K_Hbeta, S_H, flank, back = (float(x) for x in printed.split())
    assert 1.0 < K_Hbeta < 2.0
    assert S_H > 1.0
    assert flank > back >= 0.0
