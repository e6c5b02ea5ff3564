"""Figures from Python show the numbers that they are made of, in the style of the pages."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.solve.solvers import Diagnostics
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.plots.figures import (
    MINIMUM,
    error_range,
    error_traces,
    figure,
    load_lines,
    stiffness_map,
)
from fe_drivetrain.plots.style import PALETTE
from fe_drivetrain.shafts.fidelity.advice import Advice, LevelResult
from fe_drivetrain.shafts.fidelity.ladder import Cost, LevelModel
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory

DIRECT = Diagnostics(0.0, 0.0, 0.0, 0, "superlu", "small", 0.0, 0.0, 0, 0)
LOADS = np.array([1e5, 2e4, -3e5, 8e5, 4e5, -1e5])


def test_a_history_has_a_line_for_each_component_in_thousands() -> None:
    time = np.linspace(0.0, 1.0, 11)
    shown = LoadHistory("wave", time, np.outer(time, LOADS)).plot()
    assert [trace.name for trace in shown.data] == ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]
    assert [trace.y[-1] for trace in shown.data] == pytest.approx(LOADS / 1e3)
    assert {trace.yaxis for trace in shown.data[3:]} == {"y2"}
    assert len({trace.line.color for trace in shown.data}) == 6
    assert shown.layout.title.text == "wave"
    assert shown.layout.template.layout.yaxis.exponentformat == "power"
    with pytest.raises(InputError, match=r"\(n, 6\)"):
        load_lines(time, np.ones((4, 6)))


def test_bars_of_a_response_balance_the_load() -> None:
    whole = np.eye(6, 10)
    reactions = {"main_bearing": 0.7 * whole, "gearbox": 0.3 * whole, "main_bearing.seat": whole}
    shown = Response(reactions, {}, {}, {}, np.zeros((0, 3, 10)), 0.0, 0.0, DIRECT).plot(LOADS)
    assert {trace.name for trace in shown.data} == {"main_bearing", "gearbox"}
    forces = [trace.y for trace in shown.data if trace.x[0] == "Fx"]
    assert np.sum(forces, axis=0) == pytest.approx(LOADS[:3] / 1e3)
    colours = {trace.name: set() for trace in shown.data}
    for trace in shown.data:
        colours[trace.name].add(trace.marker.color)
    assert [len(used) for used in colours.values()] == [1, 1]


def test_couplings_are_shares_of_the_diagonal_and_a_missing_stiffness_is_none() -> None:
    K = np.diag([1e9, 2e9, 2e9, 0.0, 5e7, 5e7])
    K[1, 5] = K[5, 1] = 0.5 * np.sqrt(2e9 * 5e7)
    (shown,) = Superelement("unit", ("a",), np.zeros((1, 3)), K).plot().data
    assert np.asarray(shown.z)[1, 5] == pytest.approx(0.5)
    assert np.asarray(shown.z)[3, 3] == 0.0
    assert np.asarray(shown.z)[0, 0] == pytest.approx(1.0)
    assert (shown.customdata[0][0], shown.customdata[1][5]) == ("N/m", "N")
    assert shown.customdata[5][5] == "N m/rad"
    assert shown.text[4][4] == "5\u00a0×\u00a010⁷"
    (two,) = stiffness_map(("a", "b"), np.eye(12)).data
    assert (two.y[6], two.x[11], two.customdata[9][9]) == ("b Fx", "b rz", "N m/rad")
    assert two.texttemplate is None
    with pytest.raises(InputError, match="12 rows"):
        stiffness_map(("a", "b"), np.eye(6))


def test_the_ladder_is_drawn_with_its_tolerance_and_what_is_enough() -> None:
    def result(level: int, seconds: float, error: float, estimate: float) -> LevelResult:
        model = LevelModel(level, "t", (), Cost(seconds, 1), {})
        return LevelResult(model, np.ones(1), seconds, estimate, error=error)

    nan = float("nan")
    results = [result(0, 1e-3, nan, nan), result(1, 0.1, 0.2, nan), result(2, 1.0, 0.0, 0.01)]
    shown = Advice(Quantity("gearbox.Fz"), 0.05, results, 2).plot()
    assert [trace.name for trace in shown.data] == ["level 1, t", "level 2, t", "tolerance"]
    assert [trace.y[0] for trace in shown.data] == pytest.approx([20.0, 1.0, 5.0])
    assert shown.data[1].marker.size > shown.data[0].marker.size
    exact = Advice(Quantity("gearbox.Fz"), 0.05, [result(0, 1e-3, 0.0, 0.0)], 0).plot()
    assert exact.data[0].y[0] == 100 * MINIMUM


def test_bands_of_errors_are_bars_and_the_axis_is_not_stretched_to_zero_by_them() -> None:
    times, errors, bands = [1.0, 2.0, 3.0], [0.5, 0.01, 0.03], [0.03, 0.03, 0.0]
    first, second, last, _ = error_traces(["a", "b", "c"], times, errors, 0.05, 1, bands)
    assert first["error_y"]["array"] == first["error_y"]["arrayminus"] == pytest.approx([3.0])
    # a band larger than the error itself reaches to zero, which has no place
    assert second["error_y"]["array"] == pytest.approx([3.0])
    assert 0.0 < second["error_y"]["arrayminus"][0] < 1.0
    assert "error_y" not in last
    assert "error_y" not in error_traces(["a"], [1.0], [0.5], 0.05)[0]
    low, high = error_range([*errors, float("nan")], 0.05, 0.03)
    assert 0.1 < 10.0**low < 1.0
    assert 53.0 < 10.0**high < 200.0


def test_own_traces_take_the_colours_of_the_pages() -> None:
    shown = figure([{"type": "scatter", "name": "mine", "x": [1], "y": [float("nan")]}], {})
    assert shown.data[0].line.color == PALETTE[0]
    assert shown.data[0].y[0] is None or np.isnan(shown.data[0].y[0])
