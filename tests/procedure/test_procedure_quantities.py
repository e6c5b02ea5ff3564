"""Quantities to be measured at interfaces, and tables filled from channels."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.measured_quantities import filled_table, listed_quantities

STEP = 0.1
TIME = np.arange(0.0, 900.0, STEP)


def test_tables_ask_for_what_the_source_has() -> None:
    asked = listed_quantities()
    assert len({q.interface for q in asked.of("5.3")}) == 9
    assert [q.rank for q in asked.of("6.4")].count("mandatory") == 2
    assert sum(len(q.channels) for q in asked.of("6.4") if q.rank == "mandatory") == 4
    gearbox = asked.of("4.5")
    assert len({q.interface for q in gearbox}) == 5
    # bracketed in the source: six loads of the main shaft, of which three are estimated
    estimated = [q for q in gearbox if "estimated" in q.note]
    assert sum(len(q.channels) for q in estimated) == 3 + 5
    with pytest.raises(InputError, match=r"5\.3"):
        asked.of("5.9")


def test_what_is_given_is_analysed_and_what_is_not_is_a_row_that_says_so() -> None:
    torque = 5.0 + 3.0 * np.cos(2.0 * np.pi * 0.2 * TIME)
    rows = filled_table(listed_quantities().of("5.3"), {"motor torque": torque}, STEP)
    by_name = {row["channel"]: row for row in rows}
    motor, angle = by_name["motor torque"], by_name["pitch angle"]
    assert motor["given"]
    assert motor["largest"] == pytest.approx(8.0)
    assert motor["rms of 600 s"] == pytest.approx(np.sqrt(25.0 + 4.5), rel=1e-6)
    assert motor["mean"] is None
    assert not angle["given"]
    assert angle["equivalent range"] is None


def test_durations_sum_to_the_whole_and_those_of_rms_to_whole_seconds() -> None:
    given = {"pitch angle": 0.1 * np.sin(TIME), "driver current": np.sign(np.sin(TIME)) * 7.0}
    rows = filled_table(listed_quantities().of("5.3"), given, STEP)
    by_name = {row["channel"]: row for row in rows}
    assert sum(by_name["pitch angle"]["seconds"]) == pytest.approx(900.0)
    # an alternating current heats as a constant one
    current = by_name["driver current"]
    assert sum(current["seconds"]) == pytest.approx(900.0)
    assert current["rms of 600 s"] == pytest.approx(7.0, rel=1e-3)
    assert current["levels"][-1] <= 7.5 + 1e-9
