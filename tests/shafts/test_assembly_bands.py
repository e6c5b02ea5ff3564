"""Bands of assemblies: influence functions, recovered errors, and what a series of meshes shows."""

from pathlib import Path

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.cache import Cache
from fe_drivetrain.comparison.convergence import grid_convergence, scattered_band
from fe_drivetrain.elasticity.solve.error_estimate import SAFETY, recovered_work, recovery_estimate
from fe_drivetrain.geometry import MeshSizes
from fe_drivetrain.shafts.fidelity.assembly_bands import (
    assembly_band,
    cached_reaction_errors,
    motion_error,
    reaction_error,
)
from fe_drivetrain.shafts.fidelity.assembly_series import recovered_errors
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.influence_fields import (
    influences_of_all_reactions,
    reaction_influences,
)
from fe_drivetrain.shafts.response.model import Model, build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import Response, unit_load_response

BEDPLATE = [1e9, "rigid", 1e9, 1e7, "rigid", 1e7]


def solved_scene(**changes: object) -> tuple[Model, Response]:
    """A bonded bearing and springs, so that statics decides nothing."""
    scene = coarse_scene("bonded", **changes)
    model = build_model(scene, mesh_scene(scene))
    return model, unit_load_response(model)


@pytest.fixture(scope="module")
def solved() -> tuple[Model, Response]:
    return solved_scene()


def test_ground_that_moves_lifts_each_load_by_its_reaction(solved: tuple[Model, Response]) -> None:
    """Betti: displacements by the moved ground, at each load, are the reactions to that load."""
    on_bedplate = solved_scene(**{"bearing_units.main_bearing.bedplate": BEDPLATE})
    for name, (model, response) in (
        ("main_bearing", solved),
        ("gearbox", on_bedplate),
        ("main_bearing", on_bedplate),
    ):
        found = reaction_influences(model, name, range(6)).T @ model.unit_loads()
        expected = response.reactions[name]
        np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-8 * np.abs(expected).max())


def test_the_last_supports_influences_are_what_the_others_leave_of_rigid_motions(
    solved: tuple[Model, Response],
) -> None:
    """Each against its own solution; a motion of ground that nothing holds does nothing."""
    model, _ = solved
    together = influences_of_all_reactions(model)
    assert list(together) == ["main_bearing", "gearbox"]
    for name, found in together.items():
        own = reaction_influences(model, name, range(6))[: model.mesh.points.size]
        np.testing.assert_allclose(found, own, atol=1e-7 * np.abs(own).max())


def test_errors_of_all_reactions_are_those_of_each_and_are_kept(
    solved: tuple[Model, Response], tmp_path: Path
) -> None:
    model, response = solved
    first, kept = cached_reaction_errors(model, response, Cache(tmp_path))
    assert not kept
    again, kept = cached_reaction_errors(model, response, Cache(tmp_path))
    assert kept
    for name, found in first.items():
        np.testing.assert_array_equal(found, again[name])
        each = reaction_error(model, response, name, range(6), np.eye(10))
        np.testing.assert_allclose(found, each, atol=1e-6 * each.max())


def test_work_of_errors_is_their_energy_on_themselves(solved: tuple[Model, Response]) -> None:
    model, response = solved
    mesh, load = model.mesh, np.eye(10)[:, [4]]
    parts = [
        (mesh.cells[mesh.part_cells(p)], model.scene.material_of(p).lame) for p in mesh.part_names
    ]
    u = response.displacements.reshape(-1, 10) @ load
    energy = recovery_estimate(mesh.points, parts, u[:, 0]).error_energy
    assert motion_error(model, response, load)[0, 0] == pytest.approx(2 * energy, rel=1e-9)


def test_the_band_is_the_larger_of_series_and_recovered_stresses() -> None:
    sizes, values = [1.8, 1.35, 1.0], [np.array([5.0 + h]) for h in (1.8, 1.35, 1.0)]
    narrow, wide = (assembly_band(sizes, values, np.array([e])) for e in (0.01, 10.0))
    assert narrow.series == wide.series == narrow.half_width
    assert narrow.half_width * 6.0 > 1.0  # the error is 1 of 6
    assert wide.half_width == pytest.approx(SAFETY * 10.0 / 6.0)
    assert "three meshes converge" in narrow.sentence()
    assert "recovered stresses of the finest mesh (the larger" in wide.sentence()


@pytest.mark.parametrize(
    ("values", "words"), [((1.0, 1.2, 1.1), "go up and down"), ((1.0, 1.1, 1.3), "do not converge")]
)
def test_a_series_without_order_says_so_and_is_wide(values: tuple[float, ...], words: str) -> None:
    """Its band is that of Eca and Hoekstra, at least, and more than twice the range."""
    sizes = [1.8, 1.35, 1.0]
    found = assembly_band(sizes, [np.array([v]) for v in values], np.array([0.0]))
    assert words in found.sentence()
    band = found.half_width * values[-1]
    assert band >= scattered_band(sizes, values) * (1 - 1e-12)
    assert band > 2.0 * np.ptp(values)


def test_values_that_agree_by_chance_get_no_narrow_band() -> None:
    """Two meshes that differ by a hundredth of what the first two do show no convergence."""
    for last in (1.0999, 1.1, 1.1001):
        found = grid_convergence([1.8, 1.35, 1.0], [1.0, 1.1, last], min_order=0.5)
        assert found.uncertainty > 0.25


def test_meshes_of_nearly_one_size_count_once() -> None:
    """Where elements fold over, a mesh is made finer than asked for, and may be no coarser one."""
    values = [np.array([v]) for v in (1.4, 1.2, 1.19)]
    two = assembly_band([1.8, 1.01, 1.0], values, np.array([0.0]))
    assert two.sizes == (1.8, 1.0)
    assert two.half_width == pytest.approx(3.0 * (0.21 / 0.8) / 1.19)
    one = assembly_band([0.9, 1.01, 1.0], values, np.array([0.1]))
    assert np.isnan(one.series)
    assert one.half_width == pytest.approx(SAFETY * 0.1 / 1.19)
    assert "no series of coarser meshes" in one.sentence()


@pytest.mark.parametrize("coarse", [[1.1], [1.25, 1.1]])
def test_meshes_that_are_hardly_coarser_are_no_series(coarse: list[float]) -> None:
    """What two topologies do to a value is not multiplied by 1 / (ratio - 1)."""
    values = [np.array([1.0 + 0.01 * (-1) ** k]) for k in range(len(coarse) + 1)]
    found = assembly_band([*coarse, 1.0], values, np.array([0.1]))
    assert np.isnan(found.series)
    assert found.half_width == pytest.approx(SAFETY * 0.1 / values[-1][0])
    assert "no series of coarser meshes" in found.sentence()
    wider = assembly_band([1.4, *coarse, 1.0], [np.array([1.1]), *values], np.array([0.1]))
    assert np.isfinite(wider.series)


def test_errors_of_several_quantities_are_those_of_each(solved: tuple[Model, Response]) -> None:
    model, response = solved
    names = ("main_bearing.My", "hub.stiffness.rz", "gearbox.Fz", "main_bearing.Fz")
    asked = [Quantity(name) for name in (*names, "hub.stiffness.uy")]
    asked.append(Quantity("main_bearing.Fz", np.eye(10)[2]))
    for quantity, found in zip(asked, recovered_errors(asked, model, response, 2.0), strict=True):
        (alone,) = recovered_errors([quantity], model, response, 2.0)
        assert found.shape == quantity.columns(2.0, 10).shape[1:]
        np.testing.assert_allclose(found, alone, rtol=1e-6)


@pytest.mark.parametrize("factor", [0.5, 1.35, 1.5])
def test_all_sizes_scale(factor: float) -> None:
    sizes = MeshSizes(elements_per_turn=18)
    scaled = sizes.scaled(factor)
    for name in ("shaft", "bearing", "housing", "bearing_edge"):
        assert getattr(scaled, name) == pytest.approx(factor * getattr(sizes, name))
    assert scaled.elements_per_turn == pytest.approx(18 / factor, abs=0.5)
    assert sizes.scaled(factor, 11).elements_per_turn == 11
    # fewer fold over, but those that were asked for stay
    assert sizes.scaled(9.0).elements_per_turn == 8
    assert MeshSizes(elements_per_turn=6).scaled(9.0).elements_per_turn == 6


def test_the_error_of_a_sum_of_loads_is_at_most_that_of_each(
    solved: tuple[Model, Response],
) -> None:
    model, response = solved
    load = np.zeros(10)
    load[[2, 4]] = 1.0, -2.0
    columns = np.column_stack([load, np.eye(10)[:, [2, 4]]])
    found = reaction_error(model, response, "main_bearing", [4], columns)[0]
    both, force, moment = np.abs(found)
    assert 0 < both <= force + 2.0 * moment
    assert pytest.approx(columns[:, :1].T) == Quantity("main_bearing.My", load).columns(1.0, 10).T


def test_thrust_by_loads_to_a_side_has_no_more_error_than_scatter(
    solved: tuple[Model, Response],
) -> None:
    """It vanishes by symmetry, and so does the sum of the works; their sizes do not."""
    model, response = solved
    mesh, thrust, sideways = model.mesh, [0], [1, 3, 5]
    parts = [
        (mesh.cells[mesh.part_cells(p)], model.scene.material_of(p).lame) for p in mesh.part_names
    ]
    u = response.displacements.reshape(-1, 10)
    work = recovered_work(mesh.points, parts, reaction_influences(model, "gearbox", thrust), u)
    found = reaction_error(model, response, "gearbox", thrust, np.eye(10))
    np.testing.assert_allclose(found, work.estimate, rtol=1e-6)
    size, scatter = (np.abs(of)[0, sideways] for of in (found, work.scatter))
    assert (scatter <= size).all()
    assert (size < 1.5 * scatter).all()
    assert (size < 0.25 * work.sizes[0, sideways]).all()
    # its own load's works are of one sign
    assert found[0, 0] == pytest.approx(work.sizes[0, 0], rel=1e-2)
