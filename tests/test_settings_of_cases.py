"""Settings of a run: each reaches the cases that take it, and none is ignored."""

from pathlib import Path

import pytest

from fe_drivetrain.cases.performance import peer_settings
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.suite.case import Case, all_cases
from fe_drivetrain.suite.result_folders import run_case
from fe_drivetrain.suite.settings import settings_by_case
from fe_drivetrain.suite.suite import run_cases


def nothing(run, page):
    page.answer("done")


PLAIN = Case("g/plain", "t", "s", nothing)
OWN = Case("g/own", "t", "s", nothing, settings=("loads", "solver"))
SCENE = Case("g/scene", "t", "s", nothing, settings=("solver",), changes="scene")
CARRIER = Case("g/carrier", "t", "s", nothing, changes="planet_carrier")


def test_a_setting_reaches_those_that_take_it_and_no_other():
    settings = {"solver": "schwarz", "gearbox.weight": 1.0, "planet_carrier.x": 2.0, "loads": "f"}
    assert settings_by_case([PLAIN, OWN, SCENE, CARRIER], settings) == {
        "g/plain": {},
        "g/own": {"solver": "schwarz", "loads": "f"},
        "g/scene": {"solver": "schwarz", "gearbox.weight": 1.0},
        "g/carrier": {"planet_carrier.x": 2.0},
    }


@pytest.mark.parametrize(
    ("cases", "key", "message"),
    [
        ([PLAIN], "solver", "'solver': g/plain takes no settings: leave it out"),
        ([PLAIN, PLAIN], "k", "all 2 cases take no settings"),
        ([OWN], "lods", r"'lods' is unknown to g/own \(did you mean 'loads'\?\): use one of"),
        ([OWN], "gearbox.weight", "use one of loads, solver"),
        (
            [SCENE],
            "gearbx.weight",
            r"did you mean 'gearbox\.weight'\?.*bearing_units.* dotted",
        ),
        ([SCENE], "solvr", "did you mean 'solver'"),
        ([CARRIER], "gearbox.weight", "'gearbox.weight' is unknown to g/carrier"),
        ([PLAIN, OWN, SCENE], "colour", "unknown to all 3 cases: use one of loads, solver, or a"),
    ],
)
def test_a_setting_that_nobody_takes_is_refused_before_any_work(tmp_path, cases, key, message):
    with pytest.raises(InputError, match=message):
        settings_by_case(cases, {key: 1})
    with pytest.raises(InputError, match=message):
        run_cases(cases, tmp_path / "out", {key: 1})
    assert not (tmp_path / "out").exists()
    if len(cases) == 1:
        with pytest.raises(InputError, match=message):
            run_case(cases[0], tmp_path / "out", {key: 1})


def test_pages_list_what_counted(tmp_path):
    run_cases([PLAIN, OWN], tmp_path, {"loads": "f"})
    assert "Settings of this run" in (tmp_path / "g/own/report.html").read_text()
    assert "Settings of this run" not in (tmp_path / "g/plain/report.html").read_text()


def test_cases_that_read_settings_declare_them():
    """Where the source of a case asks for a setting, its declaration names it, and only then."""
    import fe_drivetrain.cases as package

    (folder,) = map(Path, package.__path__)
    for name, case in all_cases().items():
        file = folder / f"{name}.py"
        if file.is_file() and "run.settings" in file.read_text("utf-8"):
            assert case.settings or case.changes, name
    found = all_cases()
    assert found["performance/peers"].settings == tuple(peer_settings.DEFAULTS)
    takers = [name for name, case in found.items() if case.changes == "scene"]
    assert {name.partition("/")[0] for name in takers} == {"main_bearing", "fidelity"}
    for name in takers:
        if name.startswith("main_bearing/"):
            assert "solver" in found[name].settings


@pytest.mark.parametrize(
    ("name", "key", "close"),
    [
        ("drivetrain/from_table", "tabel", "table"),
        ("performance/peers", "sises", "sizes"),
        ("performance/work_precision", "part", "parts"),
        ("main_bearing/rmse", "self_wieght", "self_weight"),
        ("fidelity/planet_carrier", "planet_carier.pins", "planet_carrier.pins"),
        ("fidelity/housing_on_bedplate", "gearboxes.weight", "gearbox.weight"),
    ],
)
def test_the_projects_cases_name_what_was_meant(name, key, close):
    with pytest.raises(InputError, match=rf"did you mean '{close}'\?"):
        settings_by_case([all_cases()[name]], {key: 1})
