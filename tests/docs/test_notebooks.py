"""Notebooks run as they stand, and what they say is so; the gallery shows the library as it is."""

import contextlib
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from fe_drivetrain import reaction_history, shaft_level
from fe_drivetrain.common.components import GRAVITY

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))
sys.path.insert(0, str(DOCS))

import stills  # noqa: E402

pytestmark = pytest.mark.usefixtures("kept_between_runs")


def run(name: str) -> dict[str, Any]:
    """The names of a notebook after its last cell; Jupyter runs it when the site is built."""
    names: dict[str, Any] = {}
    cells = json.loads((DOCS / "notebooks" / f"{name}.ipynb").read_text("utf-8"))["cells"]
    for cell in cells:
        if cell["cell_type"] == "code":
            with contextlib.redirect_stdout(None):
                exec(compile("".join(cell["source"]), name, "exec"), names)
    return names


def test_the_beam_is_too_stiff_at_a_step(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = run("first-stiffness")
    excess = names["excess"]
    assert 0.2 < excess[2] < 0.4
    assert (excess[[1, 2, 3, 4, 5]] > 0).all()
    assert np.array_equal(names["again"].stiffness, names["shaft"].stiffness)


def test_heat_and_moments_cost_life() -> None:
    names = run("loads-to-life")
    years = names["life"].years
    assert years["L10mr"] < years["L10r"] < years["L10"]
    assert 0 < names["ratio"] < 1
    phases = (names["time"][::13] * 0.6) % 1.0
    assert np.histogram(phases, 4, (0, 1))[0].min() >= 3  # no phase of the blades is left out


def test_a_bore_costs_life_once_it_is_wide(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = run("bore-and-life")
    bores, years = np.array(list(names["lives"])), np.array(names["years"])
    left = 1.0 - (bores / 0.4) ** 4  # of the bending stiffness
    assert left[[1, 3, 5]] == pytest.approx([0.996, 0.94, 0.68], abs=0.005)
    assert abs(years[1] / years[0] - 1.0) < 0.02
    assert (np.diff(years) < 0).all()
    assert 0.5 < years[-1] / years[0] < 0.7
    by_forces = np.array([bearing.years["L10"] for bearing in names["lives"].values()])
    assert (np.diff(by_forces) > 0).all()
    scene, history = names["scene"], names["history"]
    moments = []
    for shaft in (scene, names["bored"]):
        weight = shaft.gearbox.weight
        reaction = reaction_history(shaft_level(shaft, 1), "main_bearing", history, weight, GRAVITY)
        moments.append(np.hypot(*reaction[:, 4:].T).mean())
    assert moments[1] > 1.1 * moments[0]


def test_statics_is_enough_for_a_force_and_not_for_a_stiffness() -> None:
    names = run("choosing-a-level")
    assert names["force"].results[names["force"].chosen].model.level == 0
    assert np.isnan(names["values"][0])
    assert names["found"]["large step"] > 5 * names["found"]["three-point suspension"] > 0


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_notebook_has_no_results_and_is_reached(path: Path) -> None:
    cells = json.loads(path.read_text("utf-8"))["cells"]
    assert not any(cell.get("outputs") for cell in cells)
    index = (DOCS / "index.md").read_text("utf-8")
    assert f"(notebooks/{path.name})" in index
    assert f"\nnotebooks/{path.stem}\n" in index


def test_the_gallery_shows_the_scenes_of_the_library_as_they_are() -> None:
    drawn = json.loads(stills.HASHES.read_text("utf-8"))
    now = {name: stills.hash_of(scene) for name, scene in stills.library().items()}
    assert drawn == now, "python docs/stills.py draws what has changed"
    assert {path.stem for path in stills.FOLDER.glob("*.webp")} == now.keys()
    for path in stills.FOLDER.glob("*.webp"):
        assert Image.open(path).size == stills.SIZE
