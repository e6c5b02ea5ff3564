"""The study of a scene: reactions to further loads, K_R, closed forms, files, two bearings."""

import csv
import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.command_line.study_files import write_reactions
from fe_drivetrain.common import GRAVITY, InputError
from fe_drivetrain.comparison import statistics
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.shafts.fidelity import statics_level
from fe_drivetrain.studies import StudyLoads, StudyResult, study
from fe_drivetrain.studies.model_checks import statics_error
from fe_drivetrain.turbine_loads.hub_loads import LoadHistory, PointLoads


def made_history(name: str, count: int, step: float, seed: int) -> LoadHistory:
    """A short history of hub loads about the front face."""
    size = np.array([2e5, 5e4, -3.7e5, 9e5, 3e5, 5e4])
    loads = size * (1.0 + 0.3 * np.random.default_rng(seed).standard_normal((count, 6)))
    return LoadHistory(name, step * np.arange(count), loads, about="front face")


HISTORIES = (made_history("calm", 40, 0.1, 1), made_history("storm", 60, 0.05, 2))


@pytest.fixture(scope="module")
def studied() -> StudyResult:
    return study(coarse_scene("bonded"), HISTORIES, slopes=(4.0,))


def test_reactions_to_further_loads_carry_all_weight(studied: StudyResult) -> None:
    further = made_history("further", 5, 1.0, 3)
    mass = sum(float(part.sum()) for part in studied.model.part_mass.values())
    weight = GRAVITY * mass + studied.model.scene.gearbox.weight
    found = studied.reactions(further)
    assert found.keys() == {"main_bearing", "gearbox"}
    total = found["main_bearing"] + found["gearbox"]
    expected = further.loads[:, :3] - [0.0, 0.0, weight]
    np.testing.assert_allclose(total[:, :3], expected, rtol=0, atol=1e-6 * weight)
    # another model has other shares of the same hub loads
    change = studied.reactions(further, "beam, soft housings")["gearbox"] - found["gearbox"]
    assert 1e-3 < np.abs(change[:, 2]).max() / np.abs(found["gearbox"][:, 2]).max() < 0.5
    with pytest.raises(InputError, match="'nosuch' is not one of this study: choose of beam"):
        studied.reactions(further, "nosuch")


def test_the_peak_across_the_shaft_is_a_figure(studied: StudyResult) -> None:
    across = np.vstack([studied.reactions(h)["main_bearing"] for h in HISTORIES])[:, 1:3]
    row, column = np.unravel_index(np.abs(across).argmax(), across.shape)
    figure = studied[f"peak {('Fy', 'Fz')[column]} on main_bearing"]
    assert (figure.computed, figure.unit) == (pytest.approx(across[row, column] / 1e3), "kN")
    assert figure.band is not None
    assert 0.0 < figure.band < 0.5 * abs(figure.computed)


def test_statistics_are_of_the_reactions_each_history_by_its_time(studied: StudyResult) -> None:
    samples = [studied.reactions(history)["main_bearing"] for history in HISTORIES]
    found = studied.reaction_statistics["main_bearing"]
    for one, sample in zip(found.by_history, samples, strict=True):
        expected = [sample.min(0), sample.mean(0), sample.max(0), sample.std(0)]
        np.testing.assert_allclose(one.values, np.transpose(expected), rtol=1e-9, atol=1e-3)
    mean = (40 * 0.1 * samples[0].mean(0) + 60 * 0.05 * samples[1].mean(0)) / (4.0 + 3.0)
    np.testing.assert_allclose(found.whole.values[:, 1], mean, rtol=1e-9, atol=1e-3)
    assert [one.samples for one in studied.loads.histories] == [40, 60]


def test_the_first_minute_has_the_radial_force_of_the_assembly_and_of_beams(
    studied: StudyResult,
) -> None:
    history = HISTORIES[len(HISTORIES) // 2]
    beginning = studied.beginning
    count = len(beginning.time)
    assert beginning.name == history.name
    np.testing.assert_array_equal(beginning.time, history.time[:count])
    forces = beginning.radial_forces["main_bearing"]
    beams = [names for level, names in studied.levels.bounds.items() if level.startswith("1")]
    assert list(forces) == ["assembly", *beams[-1]]
    for model, force in forces.items():
        reaction = studied.reactions(history, model)["main_bearing"][:count]
        np.testing.assert_allclose(force, np.hypot(reaction[:, 1], reaction[:, 2]), rtol=1e-12)


def test_stiffness_of_a_unit_is_between_its_bounds(studied: StudyResult) -> None:
    for axis, at in (("y", 4), ("z", 5)):
        figure = studied[f"K_R about {axis} of main_bearing"]
        assert figure.unit == "MN m/rad"
        assert figure.band is not None
        unit = studied.units["main_bearing"]
        stiff, soft = (1e-6 / np.linalg.inv(k)[at, at] for k in (unit.stiff, unit.soft))
        assert figure.computed + figure.band == pytest.approx(stiff)
        assert figure.computed - figure.band == pytest.approx(soft * (1.0 - unit.mesh.largest))


def test_secants_in_the_drivetrain_are_those_of_the_samples(studied: StudyResult) -> None:
    scene, response = studied.model.scene, studied.response
    assert [(one.bearing, one.axis) for one in studied.secants] == [
        ("main_bearing", "y"),
        ("main_bearing", "z"),
    ]
    both = np.zeros((2, 2))  # M theta and theta^2 about both axes
    for history in HISTORIES:
        factors = np.zeros((len(history), 10))
        factors[:, :6], factors[:, 9] = history.loads, scene.gearbox.weight
        moments = factors @ response.reactions["main_bearing"][4:].T
        tilts = factors @ response.motions["main_bearing.seat"][4:].T
        both += history.step * np.array([(moments * tilts).sum(0), (tilts**2).sum(0)])
    for one, (product, square) in zip(studied.secants, both.T, strict=True):
        assert one.stiffness == pytest.approx(product / square, rel=1e-9)
        soft, stiff = one.bounds
        assert 0.3 * soft < one.stiffness < 1.5 * stiff
        assert "K_R about" in one.statement


def test_closed_forms_are_compared_with_the_solid_without_its_weight(studied: StudyResult) -> None:
    assert list(studied.closed_forms) == [
        "pinned beam",
        "torsional-spring beam, stiff housing",
        "torsional-spring beam, soft housing",
    ]
    scene, errors = studied.model.scene, []
    front = scene.shaft.front
    for history in HISTORIES:
        solid = studied.response.history(
            "main_bearing", PointLoads(history.loads, front), scene.gearbox.weight
        )
        # Eq 3.1: moments about the gearbox's end, which holds none in bending
        fy, fz, my, mz = history.loads[:, [1, 2, 4, 5]].T
        bearing, rear = scene.bearing_units[0].bearing.x, scene.shaft.rear
        pinned = np.hypot(
            (fy * (rear - front) - mz) / (rear - bearing),
            (fz * (rear - front) + my) / (rear - bearing),
        )
        force = np.hypot(solid[:, 1], solid[:, 2])
        errors.append(float(statistics.mean_percentage_error(force, pinned)))
    expected = (4.0 * errors[0] + 3.0 * errors[1]) / 7.0
    assert studied.closed_forms["pinned beam"].mean_error_percent == pytest.approx(
        expected, rel=1e-9
    )


def test_a_solid_that_statics_contradicts_is_noticed(studied: StudyResult) -> None:
    scene = coarse_scene("spherical")
    exact = {
        name: np.hstack([np.nan_to_num(matrix[:, :6]), np.zeros((6, 4))])
        for name, matrix in statics_level(scene).reaction_matrices.items()
    }
    response = dataclasses.replace(studied.response, reactions=exact)
    worst, count = statics_error(scene, response)
    assert worst == 0.0
    assert count > 5
    exact["main_bearing"][2, 2] *= 1.001
    assert statics_error(scene, response)[0] > 1e-4


def test_reactions_over_time_are_written_with_all_weight(tmp_path: Path) -> None:
    """A shaft on a spherical bearing and a gearbox: statics says what each of them carries."""
    found = study(coarse_scene("spherical"), HISTORIES)
    write_reactions(tmp_path, found, HISTORIES[:1])
    lines = (tmp_path / "reactions_calm.csv").read_text("utf-8").splitlines()
    facts = dict(line[2:].split(" = ", 1) for line in lines if line[0] == "#")
    stated = {p: 1e3 * float(w) for p, w in re.findall(r"([\w.]+) ([\d.]+) kN", facts["weight"])}
    weight = {p: GRAVITY * float(mass.sum()) for p, mass in found.model.part_mass.items()}
    for part, own in weight.items():
        assert stated[part] == pytest.approx(own, rel=5e-4)  # four digits
    rows = list(csv.DictReader(line for line in lines if line[0] != "#"))
    force = [float(row["main_bearing Fz [N]"]) for row in rows]
    # the shaft reaches from 1 m before the bearing to 1.2 m behind it, where the gearbox is
    loads = HISTORIES[0].loads
    without_weight = (2.2 * loads[:, 2] + loads[:, 4]) / 1.2
    unit = weight["main_bearing"] + weight["main_bearing.housing"]
    nodes = found.model.part_mass["shaft"]
    centre = float(nodes @ found.model.mesh.points[:, 0]) / float(nodes.sum())
    assert centre == pytest.approx(0.1, abs=1e-3)  # of a coarse mesh
    expected = without_weight - unit - weight["shaft"] * (1.2 - centre) / 1.2
    np.testing.assert_allclose(force, expected, rtol=1e-6, atol=0.1)
    assert facts["model"] == "the assembly of solids"
    assert "x downwind along the shaft, z up" in facts["frame"]
    assert "main_bearing at x = 0 m" in facts["origin of moments"]


def test_two_bearings_and_a_brake_are_studied(tmp_path: Path) -> None:
    sizes = {"mesh.housing": 0.15, "mesh.bearing": 0.12}
    front, rear = (
        coarse_scene(kind, **sizes).model_dump(mode="json") for kind in ("bonded", "spherical")
    )
    units = [scene["bearing_units"][0] for scene in (front, rear)]
    for unit, name, x in zip(units, ("front", "rear"), (-0.4, 0.7), strict=True):
        unit["bearing"] |= {"name": name, "x": x}
    brake = {"name": "brake", "x": 1.0, "width": 0.1, "weight": 2e4}
    scene = Scene.model_validate(front | {"bearing_units": units, "load_points": [brake]})
    found = study(scene, HISTORIES)
    assert found.passed
    assert found.closed_forms == {}  # of one bearing
    assert {one.bearing for one in found.secants} == {"front"}  # the rear one slides on a sphere
    models = found.levels.models
    for model in models.values():
        # a force at the brake goes into the supports as one at the hub does
        for load in (2, 12):
            total = sum(matrix[2, load] for matrix in model.reaction_matrices.values())
            assert total == pytest.approx(1.0, abs=1e-6)
    hub = {
        name: models[f"beam, {name} housings"].compliance.diagonal()[:6]
        for name in ("rigid", "stiff", "soft")
    }
    # a housing that deforms makes the hub softer
    assert (hub["rigid"][[1, 2, 4, 5]] < hub["stiff"][[1, 2, 4, 5]]).all()
    assert (hub["stiff"][[1, 2, 4, 5]] < hub["soft"][[1, 2, 4, 5]]).all()


def test_the_json_has_histories_skip_and_what_reactions_are(studied: StudyResult) -> None:
    found = studied.to_dict()
    assert found["options"]["histories"] == ["calm", "storm"]
    assert found["options"]["skip"] == 0.0
    rows = found["tables"]["histories"]
    assert [row["history"] for row in rows] == ["calm", "storm"]
    assert sum(row["share of the time [%]"] for row in rows) == pytest.approx(100.0)
    assert found["tables"]["reactions_stated"] == studied.stated.facts()
    assert (found["seed"], found["options"]["seeds of the loads"]) == (None, [])


def test_the_seed_is_that_of_the_samples_not_of_made_wind() -> None:
    made = StudyLoads(HISTORIES, "Made for a test.", False, seeds=(1, 2))
    spread = {"gearbox.stiffness.2": {"uniform": 0.1}}
    scene = coarse_scene("bonded", uncertainty=spread)
    found = study(scene, made, slopes=(4.0,), quick=True)
    assert found.uncertainty is not None
    assert found.seed == 0
    assert found.options["seeds of the loads"] == [1, 2]
    assert found.options["skip"] == 0.0


def test_histories_without_loads_are_refused_before_any_work() -> None:
    still = LoadHistory("still", np.arange(4.0), np.zeros((4, 6)), about="front face")
    for histories in ([still], []):
        with pytest.raises(InputError, match=r"give (histories with loads|one or more)"):
            study(coarse_scene("bonded"), histories)
    with pytest.raises(InputError, match="slope"):
        study(coarse_scene("bonded"), HISTORIES, slopes=(-1.0,))
