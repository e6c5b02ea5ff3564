"""Extremes over histories: their size, file and time, and what is around the largest."""

import numpy as np
import pytest

from fe_drivetrain.studies.load_extremes import AROUND, around_largest, load_extremes
from fe_drivetrain.turbine_loads.hub_loads import LoadHistory


def history(name: str, start: float, peaks: dict[int, tuple[int, float]]) -> LoadHistory:
    """Two minutes at 10 Hz of a load of 1, with a peak in some components."""
    time = start + np.arange(0.0, 120.0, 0.1)
    loads = np.ones((len(time), 6))
    for component, (sample, value) in peaks.items():
        loads[sample, component] = value
    return LoadHistory(name, time, loads)


HISTORIES = [
    history("calm", 0.0, {0: (100, 5e3)}),
    history("storm", 60.0, {0: (300, -9e3), 4: (500, 2e6)}),
]
#: A bearing that carries twice the hub's load, and no moment.
REACTIONS = {"front": [np.hstack([2 * h.loads[:, :3], 0 * h.loads[:, 3:]]) for h in HISTORIES]}


def test_the_largest_keeps_its_sign_its_file_and_the_clock_of_that_file() -> None:
    found = {(e.place, e.load): e for e in load_extremes(HISTORIES, REACTIONS)}
    hub, moment, bearing = (
        found[key] for key in [("hub", "Fx"), ("hub", "My"), ("front", "axial force Fx")]
    )
    assert (hub.value, hub.unit, hub.history, hub.time) == (-9.0, "kN", "storm", 90.0)
    assert (moment.value, moment.unit, moment.time) == (2e3, "kN m", 110.0)
    assert bearing.value == -18.0
    assert ("front", "tilting moment") not in found
    assert hub.row()["largest [kN m]"] is None


def test_a_radial_force_is_the_resultant_of_both_components() -> None:
    (radial,) = [e for e in load_extremes(HISTORIES, REACTIONS) if e.load == "radial force"]
    assert radial.value == pytest.approx(np.hypot(2.0, 2.0) / 1e3)


def test_what_is_shown_around_the_largest_is_its_history_within_half_a_minute() -> None:
    peaked = {"front": [r.copy() for r in REACTIONS["front"]]}
    peaked["front"][1][700, 2] = -8e3
    around = around_largest(HISTORIES, peaked, load_extremes(HISTORIES, peaked))
    assert around.history == "storm"
    assert around.peak.time == pytest.approx(130.0)
    assert around.time[0] == pytest.approx(130.0 - AROUND)
    assert around.time[-1] == pytest.approx(130.0 + AROUND)
    assert around.radial["front"].max() == pytest.approx(8e3, rel=1e-6)
