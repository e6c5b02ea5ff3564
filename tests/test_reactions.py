"""Reactions to hub-load histories: their weight, what their files state, and their statistics."""

import csv
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.cases.main_bearing import reactions
from fe_drivetrain.cases.main_bearing.loads import HubLoads
from fe_drivetrain.cases.main_bearing.study import Solved, solve_scene
from fe_drivetrain.common.components import FORCES, GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.hub_loads.csv_table import read_csv
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.run import Run


@pytest.fixture(scope="module")
def solved(tmp_path_factory) -> Solved:
    run = Run({}, True, tmp_path_factory.mktemp("solved"))
    return solve_scene(run, coarse_scene("spherical"), "spherical")


@pytest.fixture
def hub(rng) -> HubLoads:
    """Two histories that begin and step at different times."""
    times = np.array([0.05 * np.arange(50), 60.0 + 0.1 * np.arange(50)])
    loads = rng.normal(size=(2, 50, 6)) * 1e5
    return HubLoads(times, loads, ("a", "b"), (), "Hub loads: two.", [], None, ("of a", "of b"))


def weight_of(solved: Solved, *parts: str) -> float:
    """Weight of parts by their geometry [N]."""
    return GRAVITY * sum(float(solved.model.part_mass[part].sum()) for part in parts)


def test_all_weight_is_carried(solved, hub):
    """Bearing and gearbox carry hub force, gearbox and, if it is in, the weight of all parts."""
    own = weight_of(solved, "shaft", "main_bearing", "main_bearing.housing")
    assert own > 1e3
    for self_weight, parts in ((True, own), (False, 0.0)):
        carried = sum(
            reactions.reaction_of(solved, name, hub.loads, self_weight)[..., 2]
            for name in ("main_bearing", "gearbox")
        )
        expected = hub.loads[..., 2] - solved.scene.gearbox.weight - parts
        np.testing.assert_allclose(carried, expected, rtol=1e-8, atol=1e-3)


def test_housing_weighs_on_its_base_and_not_on_the_bearing(solved, hub):
    base, outer, seat = (
        reactions.reaction_of(solved, f"main_bearing{face}", hub.loads, True)[..., 2]
        for face in ("", ".outer", ".seat")
    )
    np.testing.assert_allclose(
        outer - base, weight_of(solved, "main_bearing.housing"), rtol=1e-6, atol=1e-2
    )
    np.testing.assert_allclose(seat - outer, weight_of(solved, "main_bearing"), rtol=1e-6, atol=0.1)


@pytest.mark.parametrize("self_weight", [True, False])
def test_each_file_states_what_is_in_it_and_has_its_own_times(solved, hub, tmp_path, self_weight):
    reactions.write_files(tmp_path, hub, {"spherical": solved}, self_weight)
    for k, name in enumerate(hub.names):
        found = read_csv(tmp_path / f"reactions_spherical_{name}.csv")
        np.testing.assert_allclose(found.time, hub.times[k], rtol=1e-8)
        reaction = reactions.reaction_of(solved, "main_bearing", hub.loads[k], self_weight)
        np.testing.assert_allclose(found.loads, reaction, rtol=1e-8)
        weight = str(found.attributes["weight"])
        assert weight.startswith("included along -z: shaft" if self_weight else "left out: shaft")
        assert f"shaft {weight_of(solved, 'shaft') / 1e3:.4g} kN" in weight
        assert "x downwind along the shaft, z up" in str(found.attributes["frame"])
        assert found.attributes["origin of moments"] == (
            "centre of main_bearing at x = 0 m, y = 0 m, z = 0 m"
        )
        assert found.attributes["channels"] == f"of {name}"


def test_statistics_are_those_of_every_reaction_and_history(solved, hub, tmp_path):
    run, page = Run({}, True, tmp_path), Page()
    reactions.statistics_section(run, page, hub, {"spherical": solved}, True)
    lines = (tmp_path / reactions.STATISTICS).read_text("utf-8").splitlines()
    facts = [line for line in lines if line.startswith("#")]
    assert any("weight" in line and "included" in line for line in facts)
    assert any("gearbox" in line and "centre of the rear face" in line for line in facts)
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert len(rows) == 3 * 6 * len(solved.response.reactions)
    for row in rows:
        chosen = slice(None) if row["history"] == "all" else hub.names.index(row["history"])
        samples = reactions.reaction_of(solved, row["reaction"], hub.loads[chosen], True)[
            ..., FORCES.index(row["component"])
        ]
        found = [float(row[key]) for key in ("least", "mean", "largest", "standard deviation")]
        expected = [samples.min(), samples.mean(), samples.max(), samples.std()]
        np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-3)
    shown = page.figures["reaction_statistics_kN"]
    assert {row["reaction"] for row in shown} == set(solved.response.reactions)
    assert page.sections[-1].items[0].text.startswith("Weight included along -z: shaft")


def test_self_weight_is_a_word_of_yes_or_no():
    for value in (0, "no", None):
        with pytest.raises(InputError, match=r"self_weight = .* must be true or false"):
            reactions.has_self_weight(Run({"self_weight": value}, False, Path()))
    assert reactions.has_self_weight(SimpleNamespace(settings={}))
