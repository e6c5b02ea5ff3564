"""Defect frequencies of bearings: kinematic identities, published numbers, planets."""

from math import pi
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from fe_drivetrain.bearing import BallRow, ball_row, cylindrical, spherical_roller
from fe_drivetrain.bearing.defect_frequencies import defect_frequencies
from fe_drivetrain.bearing.geometry import Row, count
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.dynamics import Level, machine_system, system_modes
from fe_drivetrain.dynamics.bodies.bearing_reactions import BearingModel
from fe_drivetrain.dynamics.bodies.machine import library_machine, machine_of
from fe_drivetrain.procedure import bearing_defects
from fe_drivetrain.procedure.bearing_defects import ring_speeds
from fe_drivetrain.studies import modes

TURN = 2.0 * pi
INCH = 0.0254
SPEEDS = st.floats(-300.0, 300.0)
ROWS = (
    ball_row(9, 0.3126 * INCH, 1.537 * INCH),
    cylindrical("cylindrical", 17, 0.024, 0.034, 0.140).rows[0],
    spherical_roller("spherical", 28, 0.07, 0.072, 0.735, 8.5).rows[0],
)


@given(inner=SPEEDS, outer=SPEEDS, row=st.sampled_from(ROWS))
def test_elements_pass_both_rings_as_often_as_the_rings_pass_each_other(
    inner: float, outer: float, row: Row
) -> None:
    found = defect_frequencies(row, inner, outer)
    assert found.outer + found.inner == pytest.approx(
        count(row) * abs(inner - outer) / TURN, abs=1e-9
    )


@given(inner=SPEEDS, outer=SPEEDS, frame=SPEEDS, row=st.sampled_from(ROWS))
def test_only_the_cage_depends_on_the_frame(
    inner: float, outer: float, frame: float, row: Row
) -> None:
    one = defect_frequencies(row, inner, outer)
    other = defect_frequencies(row, inner + frame, outer + frame)
    for name in ("outer", "inner", "element"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), abs=1e-9)


def test_a_cage_moves_as_the_mean_of_both_surfaces_and_an_element_rolls_on_both() -> None:
    """Surface speeds at both contacts, from the radii alone."""
    row, inner, outer = ROWS[2], 3.0, -0.7
    across = 0.5 * row.diameter * np.cos(row.angle)
    surface = np.array([inner * (row.radius - across), outer * (row.radius + across)])
    found = defect_frequencies(row, inner, outer)
    assert found.cage * TURN == pytest.approx(surface.mean() / row.radius)
    cage = surface.mean() / row.radius
    against = (outer - cage) * (row.radius + across)
    assert found.element * TURN == pytest.approx(abs(against) / (0.5 * row.diameter))


# SKF 6205-2RS of the Case Western Reserve University rig (its 4.7135 is twice BSF), and MB ER-16K
# of the Curtin University rig, as both print them
PUBLISHED = (
    (ROWS[0], {"outer": 3.5848, "inner": 5.4152, "element": 0.5 * 4.7135}, 1e-4),
    (ball_row(9, 7.9375e-3, 38.5e-3), {"outer": 3.572, "inner": 5.428, "cage": 0.3969}, 5e-4),
)


@pytest.mark.parametrize(("row", "printed", "last"), PUBLISHED)
def test_published_multiples_of_the_speed(
    row: BallRow, printed: dict[str, float], last: float
) -> None:
    found = defect_frequencies(row, TURN)
    for name, value in printed.items():
        assert getattr(found, name) == pytest.approx(value, abs=last)


@pytest.mark.parametrize("name", ["grc_750kw", "nrel_5mw", "synthetic_2mw"])
def test_rings_turn_as_the_bodies_of_the_model_do(name: str) -> None:
    machine = library_machine(name)
    expected = {
        of.name: of.speed_ratio for of in BearingModel(machine, count=1).reactions().values()
    }
    found = ring_speeds(machine)
    assert found.keys() == expected.keys()
    for bearing, ratio in found.items():
        assert abs(ratio) == pytest.approx(expected[bearing], rel=1e-12)


def test_defects_act_at_springs_of_their_bearing_and_planets_together() -> None:
    machine = library_machine("grc_750kw")
    known, unknown = bearing_defects(machine)
    parts = system_modes(machine_system(machine, Level.RIGID)).energy_shares
    by_name = {one.name: one for one in known}
    assert not unknown
    found = by_name["stage 1 pin upwind"].excitations(parts)
    assert [one.at for one in found] == [tuple(f"stage 1 pin {k} upwind" for k in (1, 2, 3))] * 4
    # a torsional model has no pins, so that nothing is excited there
    torsional = system_modes(machine_system(machine, Level.TORSIONAL)).energy_shares
    assert by_name["stage 1 pin upwind"].excitations(torsional) == ()
    # the pin stands still in the carrier: the cage turns as a part of the planet, on its outer side
    planet = by_name["stage 1 pin upwind"]
    assert 0.5 < planet.per_turn.cage / planet.speed_ratio < 1.0
    assert by_name["HSS-A"].per_turn.cage / by_name["HSS-A"].speed_ratio < 0.5


PAGE = {"designation": "NU 2220", "C": 3.8e5, "C0": 4.5e5, "Cu": 5.4e4}


def test_defects_of_a_page_have_the_range_of_all_insides_that_fit_it() -> None:
    """More elements are known of one page, so that its range is a part of the other's."""
    spans = []
    for page in (PAGE, {**PAGE, "elements": 18}):
        machine = machine_of(read_drivetrain("nrel_5mw", {"gearbox.bearings.2.catalogue": page}))
        (own,) = (one for one in bearing_defects(machine)[0] if one.entry == "NU 2220")
        for kind, value in own.per_turn.by_name().items():
            low, high = own.ends(kind) or (0.0, 0.0)
            assert 0.0 < low <= value <= high
        low, high = own.ends("BPFO") or (0.0, 0.0)
        assert own.per_turn.outer + own.per_turn.inner == pytest.approx(
            own.elements * own.speed_ratio
        )
        spans.append(high / low)
    assert 1.0 < spans[1] < spans[0]
    known = bearing_defects(library_machine("grc_750kw"))[0]
    assert all(one.ends("BPFO") is None for one in known)


def test_modes_take_defects_of_catalogues_of_the_user(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump({"mine": PAGE}))
    drivetrain = read_drivetrain("nrel_5mw", {"gearbox.bearings.2.catalogue": "mine"})
    without = modes(drivetrain, level="torsional")
    found = modes(drivetrain, level="torsional", catalogues=[file])
    assert "mine" not in {one.entry for one in without.bearing_defects}
    assert "mine" in {one.entry for one in found.bearing_defects}
    rows = {row["catalogue entry"]: row for row in found.tables["bearing defects"]}
    assert rows["mine"]["BPFO in a turn, least of all insides"] is not None
    assert rows["nrel_5mw_planet"]["BPFO in a turn, least of all insides"] is None
    assert any("does not print what is inside" in note for note in found.notes)
