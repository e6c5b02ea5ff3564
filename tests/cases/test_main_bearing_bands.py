"""Bands of a case's figures come from coarser meshes of the same scene, or are not given at all."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.cases.main_bearing import (
    bands,
)
from fe_drivetrain.cases.main_bearing.bands import (
    FACTORS,
    MIN_ORDER,
    Series,
)
from fe_drivetrain.cases.main_bearing.shown import check_series
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run


def series_of_order(order, limit=5.0):
    levels = [
        {
            "K_R": np.array([[limit, limit + 0.1 * size**order]]),
            "checks": np.array([1e-10, 1e-12]),
            "size": np.array(size),
        }
        for size in (*FACTORS, 1.0)
    ]
    return Series(tuple(levels))


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 4.0])
def test_band_holds_the_limit_whatever_the_order(order):
    series = series_of_order(order)
    band = series.band(lambda f: float(f["K_R"][0, 1]))
    assert band >= 0.1
    assert series.percent(lambda f: float(f["K_R"][0, 1])) == pytest.approx(100 * band / 5.1)
    # and reaches to the limit at the least order
    difference = 0.1 * (FACTORS[1] ** order - 1.0)
    assert band >= 0.999 * difference / (FACTORS[1] ** MIN_ORDER - 1.0)
    # what no mesh changes has none
    assert series.band(lambda f: float(f["K_R"][0, 0])) < 1e-10
    assert "at most" in series.largest("K_R")


def test_no_coarser_mesh_gives_no_band():
    series = Series(series_of_order(1.0).levels[-1:])
    assert not series.complete
    assert series.band(lambda f: float(f["K_R"][0, 1])) is None
    assert checks_of(series) == []
    assert "No bands" in series.note()


def checks_of(series):
    page = Page()
    check_series(page, series, "bonded")
    return page.checks


def test_coarser_solutions_out_of_balance_are_reported():
    good = series_of_order(1.0)
    assert [v.passed for v in checks_of(good)] == [True]
    spoiled = Series(({**good.levels[0], "free checks": np.array([1e-3, 0.0])}, *good.levels[1:]))
    assert [v.passed for v in checks_of(spoiled)] == [False]


def test_mesh_too_coarse_for_the_walls_is_left_out(tmp_path):
    scene = coarse_scene("bonded")
    sizes = scene.mesh.model_copy(update={"bearing": 1.0})
    scene = scene.model_copy(update={"mesh": sizes})  # as a coarser mesh is made of a sound one
    assert bands.solve_coarser(Run({}, True, tmp_path), scene, "x", True, True) is None


def test_coarser_scene_has_larger_elements_and_enough_a_turn():
    scene = change_scene(coarse_scene("bonded"), {"mesh.elements_per_turn": 12})
    for factor in FACTORS:
        sizes = bands.coarser(scene, factor).mesh
        assert sizes.housing == pytest.approx(factor * scene.mesh.housing)
        assert 8 <= sizes.elements_per_turn < 12


def test_figures_of_a_coarser_mesh_are_those_of_the_case(tmp_path):
    """Solved on the same mesh, a figure is the same; K_R stands under its plane and estimator."""
    from fe_drivetrain.cases.main_bearing import bearing_scenes

    scene = coarse_scene("bonded")
    run = Run({}, True, tmp_path)
    found = bands.solve_coarser(run, scene, "x", solved=True, tilted=True)
    assert found is not None
    solved, tilt = bearing_scenes.solve_both(run, scene, "x")
    own = bands.of_solved(solved) | bands.of_tilt(tilt)
    assert set(found) == set(own)
    assert found["K_R"][0, 1] == pytest.approx(tilt.by_plane["vertical"]["averaged seat"], rel=1e-9)
    name = solved.bearing
    np.testing.assert_allclose(
        found[f"reaction {name}"], solved.response.reactions[name], rtol=1e-6, atol=1e-6
    )


def test_the_sizes_of_a_series_are_those_that_elements_have() -> None:
    """A mesh that is no coarser than the next ends the series; so does one that cannot be made."""

    class Job:
        def __init__(self, found: dict[str, np.ndarray] | None) -> None:
            self.result = lambda: found

    coarse, middle, own = series_of_order(1.0).levels
    stopped = bands.Coarser([Job(coarse), Job({**middle, "size": np.array(1.02)})]).below(own)  # type: ignore[list-item]
    assert not stopped.complete
    nearer = {**middle, "size": np.array(1.16)}
    narrow, wide = (
        bands.Coarser([Job(coarse), Job(m)]).below(own).band(lambda f: float(f["K_R"][0, 1]))  # type: ignore[list-item]
        for m in (middle, nearer)
    )
    assert wide > 1.5 * narrow


def test_recovered_stresses_give_the_tilt_stiffness_a_band_whatever_the_meshes() -> None:
    series = series_of_order(1.0)
    recovered = {**series.levels[-1], "recovered": np.array([0.2])}
    for levels in ((recovered,), (*series.levels[:-1], recovered)):
        band = Series(levels).band(lambda f: float(f["K_R"][0, 1]))
        assert band == pytest.approx(5.1 * (1 - 1 / 1.2))
    assert Series((recovered,)).band(lambda f: float(f["checks"][0])) is None


def test_recovered_stresses_give_reactions_a_band_whatever_the_meshes() -> None:
    series = series_of_order(1.0)
    levels = [{**level, "reaction b": np.array([[2.0, -3.0]])} for level in series.levels]
    levels[-1] |= {"recovered reaction b": np.array([[0.01, 0.02]])}
    for given in (levels[-1:], levels):
        found = Series(tuple(given))
        band = [found.band(lambda f, k=k: float(f["reaction b"][0, k])) for k in (0, 1)]
        assert band == pytest.approx([3 * 0.01, 3 * 0.02])
        # of what is made of several, that of all of them larger or smaller
        assert found.band(lambda f: float(np.ptp(f["reaction b"]))) == pytest.approx(3 * 0.03)
        assert "reactions" in found.note()
        assert "K_R are" not in found.note()


def test_errors_of_reactions_are_those_of_the_assembly(tmp_path) -> None:
    """What equilibrium decides has none; what stiffness shares has one, far below the share."""
    from fe_drivetrain.cases.main_bearing import bearing_scenes

    scene = coarse_scene("bonded")
    solved = bearing_scenes.solve(Run({}, True, tmp_path), scene, "x", with_errors=True)
    name = solved.bearing
    errors, reactions = solved.errors[name], solved.response.reactions[name]
    assert set(solved.errors) == {name, "gearbox"}
    # both supports share a force at the hub: what one gets more, the other gets less
    np.testing.assert_allclose(errors[2, 2], -solved.errors["gearbox"][2, 2], rtol=1e-5)
    # its mesh is too stiff against tilting, and takes too much of the moment
    assert 1e-4 < -errors[4, 4] / reactions[4, 4] < 0.2
    figures = bands.of_solved(solved)
    assert figures[f"recovered reaction {name}"] is errors
