"""The rule by which levels are judged, for studies and for the adviser."""

import numpy as np
import pytest
import yaml

from fe_drivetrain.command_line.option_names import with_options
from fe_drivetrain.command_line.settings import parse_tolerance
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.drivetrain_file.scene import Scene, coarser_scene
from fe_drivetrain.geometry import MeshSizes
from fe_drivetrain.shafts.fidelity.advice import Advice, LevelResult
from fe_drivetrain.shafts.fidelity.adviser import advise
from fe_drivetrain.shafts.fidelity.assembly_bands import finer_mesh
from fe_drivetrain.shafts.fidelity.judgement import Judged, judge_levels
from fe_drivetrain.shafts.fidelity.ladder import Cost, LevelModel
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.studies.level_errors import enough

LENGTH = 3.8
BOUNDS = {"1 beam": ["beam"], "2 meridian": ["meridian"]}


def force(name: str, size: float, beam: float, meridian: float, band: float = 0.0) -> Judged:
    return Judged(f"{name}, force", "force", size, {"1 beam": beam, "2 meridian": meridian}, band)


def moment(name: str, size: float, beam: float, meridian: float) -> Judged:
    return Judged(f"{name}, moment", "moment", size, {"1 beam": beam, "2 meridian": meridian})


def test_what_is_below_a_hundredth_of_the_largest_of_its_kind_does_not_decide() -> None:
    found = judge_levels(
        [force("front", 1.74e6, 0.004, 0.002), force("gearbox", 3e3, 0.44, 0.3)], 0.05, LENGTH
    )
    assert found.level == "1 beam"
    assert [q.name for q in found.slight] == ["gearbox, force"]
    # a hundredth and a little more does
    found = judge_levels(
        [force("front", 1.74e6, 0.004, 0.002), force("gearbox", 17.5e3, 0.44, 0.3)], 0.05, LENGTH
    )
    assert found.level is None
    assert not found.slight


def test_moments_are_compared_with_moments() -> None:
    # 50 kN m beside 2 MN count: over the length of the shaft they are 0.7 % of that force
    front, own = force("front", 2e6, 0.0, 0.0), moment("front", 50e3, 0.2, 0.01)
    found = judge_levels([front, own], 0.05, LENGTH)
    assert (found.level, found.failing.name) == ("2 meridian", "front, moment")
    # but not beside a moment a hundred times as large, nor where they are next to nothing
    assert judge_levels([front, own, moment("rear", 6e6, 0.0, 0.0)], 0.05, LENGTH).level == "1 beam"
    assert judge_levels([front, moment("front", 5e3, 0.2, 0.2)], 0.05, LENGTH).level == "1 beam"


def test_the_quantity_that_fails_is_named_with_its_size_and_band() -> None:
    fails = force("rear", 3.21e5, 0.2, 0.11, band=0.02)
    found = judge_levels([force("front", 1.74e6, 0.3, 0.004), fails], 0.05, LENGTH)
    sentence = enough(found, BOUNDS)
    assert "at the nearest, meridian, rear, force (321 kN root mean square, beside 1,740 kN)" in (
        sentence
    )
    assert "differs by 11 % (± 2 % of the assembly's mesh)" in sentence


def test_the_band_of_the_assembly_counts_against_every_level() -> None:
    known, uncertain = (force("front", 1e6, 0.04, 0.03, band) for band in (0.0, 0.015))
    assert judge_levels([known], 0.05, LENGTH).level == known.cheapest(0.05) == "1 beam"
    assert judge_levels([uncertain], 0.05, LENGTH).level == uncertain.cheapest(0.05) == "2 meridian"


def self_aligning() -> Scene:
    """Two bearings that carry no moment, and a gearbox on springs a hundred times as soft."""
    scene = library_scene("two_bearings")
    front = scene.bearing_units[0].model_copy(update={"interface": "averaged", "catalogue": None})
    return scene.model_copy(update={"bearing_units": (front, *scene.bearing_units[1:])})


def test_the_adviser_says_of_a_slight_reaction_what_a_study_makes_of_it() -> None:
    scene = coarser_scene(self_aligning(), 6.0, 6)
    # a wide tolerance, for which the assembly need not be solved
    main = advise(scene, Quantity("front.Fz"), 0.9, shafts=(1,))
    slight = advise(scene, Quantity("gearbox.Fz"), 0.05, shafts=(1,))
    assert main.share == 1.0
    assert 0.0 < slight.share < 0.01
    assert "a study judges no level by less than 1 %" in slight.sentence()
    assert "a study judges no level" not in main.sentence()
    # the share is that of what supports carry in balance, whatever the level
    R = slight.top.model.reaction_matrices
    scale = np.array([1.0, 1.0, 1.0, *3 * (scene.shaft.length,)])
    sizes = [np.linalg.norm(m[c, :6] * scale) for m in R.values() for c in range(3)]
    own = np.linalg.norm(R["gearbox"][2, :6] * scale)
    assert slight.share == pytest.approx(own / max(sizes), rel=1e-12)


def test_an_assembly_that_is_too_coarse_is_told_with_the_sizes_to_set() -> None:
    scene = library_scene("main_bearing_spherical")
    nan = float("nan")
    model = LevelModel(4, "assembly of solids", (), Cost(1.0, 1), {})
    results = [LevelResult(model, np.ones(1), 1.0, 0.0312, error=nan)]
    sizes = scene.mesh
    said = Advice(Quantity("gearbox.Fz"), 0.01, results, None, sizes=sizes).sentence()
    assert (
        "has a band of 3.1 %, and 1 % or less is asked: make the element sizes under mesh" in said
    )
    assert said.endswith("or ask for `tolerance=0.032`.")
    assert "instance half of those here, `change_scene(changes={'mesh.shaft': " in said
    typed = with_options(said)
    assert typed.endswith("or ask for --tolerance 3.2%.")
    words = [word for word in typed.split() if word.startswith("mesh.")]
    halves = change_scene(
        scene, dict(yaml.safe_load(w.replace("=", ": ")).popitem() for w in words)
    )
    for key in ("shaft", "bearing", "bearing_edge", "housing"):
        assert getattr(halves.mesh, key) == pytest.approx(0.5 * getattr(sizes, key), rel=5e-3)
    assert halves.mesh.elements_per_turn == 2 * sizes.elements_per_turn
    # the wider tolerance is one that the finest result meets
    assert parse_tolerance("3.2%") >= 0.0312


def test_sizes_and_tolerances_that_are_named_can_be_given() -> None:
    most = MeshSizes(elements_per_turn=300)
    assert "--set mesh.elements_per_turn=360 " in with_options(finer_mesh(most, 0.02))
    assert finer_mesh(most, 0.02).endswith("or ask for `tolerance=0.02`")
    assert "tolerance" not in finer_mesh(most, 1.2)  # it must be below 100 %
    assert finer_mesh(None, 0.101) == "ask for `tolerance=0.11`"
