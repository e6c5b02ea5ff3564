"""Settings of a run: each reaches the cases that take it, and none is ignored."""

import ast
import importlib
import re
from pathlib import Path

import pytest

from fe_drivetrain.cases.performance import peer_settings
from fe_drivetrain.command_line.settings import parse_settings
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.solve.solvers import METHODS
from fe_drivetrain.report.suite.case import Case, all_cases
from fe_drivetrain.report.suite.result_folders import run_case
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.report.suite.settings import settings_by_case
from fe_drivetrain.report.suite.suite import run_cases


def nothing(run, page):
    page.answer("Is it done?", "Done.", [])


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
    assert tuple(found["performance/peers"].settings) == tuple(peer_settings.DEFAULTS)
    takers = [name for name, case in found.items() if case.changes == "scene"]
    assert {name.partition("/")[0] for name in takers} == {
        "main_bearing",
        "fidelity",
        "performance",
    }
    for name in takers:
        if name.startswith("main_bearing/"):  # the study chooses its solver by itself
            assert ("solver" in found[name].settings) == (name != "main_bearing/levels"), name


#: A default, or a word in capitals; the one of a quick run; a range.
WORDS = re.compile(
    r"(?:(?P<none>FILES?|CORES|NUMBER)|(?P<full>\S+|\[[^]]*\]))"
    r"(?: \((?:quick (?P<quick>\[[^]]*\]|[^;)]+))?"
    r"(?:(?:; )?from (?P<low>[\d.]+)(?: to (?P<high>[\d.]+))?)?(?P<more>[^;)]*)\))?"
)


def typed(text):
    return parse_settings([f"k={text}"])["k"]


def said(words):
    """Default, quick default, and range, as a declaration has it."""
    found = WORDS.fullmatch(words)
    assert found, words
    if found["none"]:
        return None, None, found["low"] and float(found["low"]), None
    full = typed(found["full"])
    quick = typed(found["quick"]) if found["quick"] else full
    return full, quick, *(typed(found[k]) if found[k] else None for k in ("low", "high"))


def read_in(file, tree):
    """Key, full and quick default, and least value of each setting that a module reads."""
    module = importlib.import_module(f"fe_drivetrain.cases.{file.parent.name}.{file.stem}")
    for call in ast.walk(tree):
        if not isinstance(call, ast.Call) or len(call.args) < 2:
            continue
        function = ast.unparse(call.func)
        if function not in ("run.count", "run.positive", "run.settings.get"):
            continue

        def value(node, quick):
            names = vars(module) | {"run": Run({}, quick, Path())}
            return eval(ast.unparse(node), names)

        least = [value(key.value, False) for key in call.keywords if key.arg == "least"]
        low = (least or [1])[0] if function == "run.count" else None
        yield (
            ast.literal_eval(call.args[0]),
            *(value(call.args[1], quick) for quick in (False, True)),
            low,
        )


def test_defaults_that_are_shown_are_those_that_are_used():
    import fe_drivetrain.cases as package

    (folder,) = map(Path, package.__path__)
    found = all_cases()
    compared = set()
    for file in sorted(folder.glob("*/*.py")):
        text = file.read_text("utf-8")
        if not re.search(r"run\.(count|positive|settings\.get)\(", text):
            continue
        own = f"{file.parent.name}/{file.stem}"
        for key, full, quick, low in read_in(file, ast.parse(text)):
            near = [own] if own in found and key in found[own].settings else list(found)
            near = [n for n in near if n.startswith(file.parent.name) and key in found[n].settings]
            for name in near:
                words = found[name].settings[key]
                compared.add((name, key))
                if words.startswith("CORES"):
                    full = quick = None
                if words.startswith(("FILE", "NAME", "NUMBER")):
                    continue
                shown = said(words)
                assert shown[:2] == (full, quick), (name, key)
                assert low is None or shown[2:] == (low, None), (name, key)
    for name, case in found.items():
        for key in case.settings:
            words = case.settings[key]
            if name == "performance/peers":
                full = peer_settings.DEFAULTS[key]
                quick = peer_settings.QUICK.get(key, full)
                assert said(words) == (
                    full,
                    quick,
                    *peer_settings.RANGES.get(key, (None, None))[:2],
                ), key
            else:
                shown = words.startswith(("FILE", "NAME", "NUMBER"))
                assert shown or (name, key) in compared, (name, key)
            if key == "solver":
                assert re.findall(r"[a-z-]+", words.replace("(or", "")) == list(METHODS)
    coverage = importlib.import_module("fe_drivetrain.cases.verification.band_coverage")
    assert [len(seeds) for seeds in coverage.chosen(Run({}, True, Path()))] == [2, 1]


@pytest.mark.parametrize("value", ["abc", True, 0, -1, 1.5, float("inf"), float("nan"), [3], None])
def test_a_number_of_things_is_a_whole_one(value):
    with pytest.raises(InputError, match=r"^k = .* must be a whole number from 1 on, as in k=5$"):
        Run({"k": value}, False, Path()).count("k", 5)


@pytest.mark.parametrize("value", ["abc", True, 0, -1, float("inf"), float("nan"), [3]])
def test_a_positive_number_is_one(value):
    with pytest.raises(InputError, match=r"^k = .* must be a number above 0, as in k=5$"):
        Run({"k": value}, False, Path()).positive("k", 5.0)
    with pytest.raises(InputError, match=r"^k has to be given for this machine, as in --set k=10$"):
        Run({}, False, Path()).positive("k")
    assert Run({"k": 2}, False, Path()).positive("k", 5.0) == 2.0


def test_a_number_of_things_may_be_written_with_an_exponent():
    assert Run(parse_settings(["k=1e9"]), False, Path()).count("k", 5) == 10**9
    assert Run({}, False, Path()).count("k", 5) == 5
    with pytest.raises(InputError, match="from 4 on"):
        Run({"k": 3}, False, Path()).count("k", 5, least=4)


@pytest.mark.parametrize(
    ("name", "key", "close"),
    [
        ("drivetrain/from_table", "drivetran", "drivetrain"),
        ("performance/peers", "sises", "sizes"),
        ("performance/work_precision", "part", "parts"),
        ("main_bearing/rmse", "sovler", "solver"),
        ("fidelity/planet_carrier", "planet_carier.pins", "planet_carrier.pins"),
        ("fidelity/housing_on_bedplate", "gearboxes.weight", "gearbox.weight"),
    ],
)
def test_the_projects_cases_name_what_was_meant(name, key, close):
    with pytest.raises(InputError, match=rf"did you mean '{close}'\?"):
        settings_by_case([all_cases()[name]], {key: 1})
