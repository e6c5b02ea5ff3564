"""Sentences of the library name arguments of Python; the terminal shows options in their place."""

import ast
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from inspect import signature
from pathlib import Path
from typing import Any

import pytest
from coarse_scenes import coarse_scene
from typer.main import get_command

import fe_drivetrain
from fe_drivetrain.command_line import app, option_names
from fe_drivetrain.command_line.option_names import (
    OPTIONS,
    WORDS,
    result_with_options,
    sections_with_options,
    with_options,
)
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import change_scene, library_scene
from fe_drivetrain.geometry import MeshSizes
from fe_drivetrain.report.results import AssumptionRow, Table, Text
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.shafts.fidelity.assembly_bands import finer_mesh
from fe_drivetrain.studies import (
    CaptureTarget,
    GearOptions,
    LifeOptions,
    LoadOptions,
    StrengthOptions,
    check,
    prepare_export,
)
from fe_drivetrain.studies.load_winds import winds_not_used
from fe_drivetrain.studies.rolling_bearings import bearings_of
from fe_drivetrain.studies.unused import require_samples
from fe_drivetrain.turbine_loads.histories.sites import require_winds

SCENE = "main_bearing_spherical"
LIBRARY = Path(fe_drivetrain.__file__).parent

OWNERS = {
    "GearOptions": GearOptions,
    "LifeOptions": LifeOptions,
    "LoadOptions": LoadOptions,
    "StrengthOptions": StrengthOptions,
    "CaptureTarget": CaptureTarget,
    "change_scene": change_scene,
}

# what runs cases and writes files has options of its own alone
OF_THE_TERMINAL = {"suite", "report", "cases", Path(option_names.__file__).parent.name}
OPTION = r"(?<![\w-])--[a-z]"

OF_OTHER_PROGRAMS = {"cluster.py", "direct_solvers.py", "files.py"}
#: Pages whose content is what to type.
TO_BE_TYPED = {LIBRARY / "pages" / "export.py", LIBRARY / "bearing" / "bearing_file.py"}


def sentence(work: Callable[[], object]) -> str:
    with pytest.raises(InputError) as caught:
        work()
    return str(caught.value)


def of_bearings(**options: Any) -> object:
    return bearings_of(library_scene(SCENE), LifeOptions(**options).choices)


@pytest.mark.parametrize(
    ("work", "python", "terminal"),
    [
        (
            lambda: LifeOptions(reliability_percent=91.0),
            "`LifeOptions(reliability_percent=91.0)`: choose one of 90",
            "--reliability 91: choose one of 90",
        ),
        (
            lambda: LifeOptions(lubricant="oil"),
            "mm2/s, as `LifeOptions(lubricant=(460.0, 30.5))`",
            "mm2/s, as --lubricant 460,30.5",
        ),
        (
            lambda: of_bearings(support="soft"),
            "`LifeOptions(support='soft')`: choose rollers",
            "--support soft: choose rollers",
        ),
        (
            lambda: of_bearings(bearings={"rear": "x"}),
            "`LifeOptions(bearings={'rear': 'x'})`: the scene has no bearing 'rear'",
            "--bearing rear=x: the scene has no bearing 'rear'",
        ),
        (
            lambda: require_samples(Path("a.csv"), 20, 10, 3),
            "`LifeOptions(every=10)` leaves 2 of 20 samples",
            "--every 10 leaves 2 of 20 samples",
        ),
        (
            lambda: require_winds([Path("a.csv")], [float("nan")]),
            "as in `ChannelMap(channels={'wind speed': 'Vhub'})`, or leave `site` out",
            "as in --channel 'wind speed=Vhub', or leave --site out",
        ),
        (
            lambda: prepare_export(library_scene(SCENE), "summary", at=["hub", "gearbox"]),
            "`at=['hub', 'gearbox']` is not used by `kind='summary'`",
            "--at hub,gearbox is not used by --what summary",
        ),
        (
            lambda: prepare_export(library_scene(SCENE), "modes", "seats"),
            "`kind='modes'` is for the free shaft, not for `what='seats'`: leave `what` out",
            "--modes is for the free shaft, not for --what seats: leave --what out",
        ),
    ],
)
def test_a_mistake_names_the_argument_and_the_terminal_its_option(
    work: Callable[[], object], python: str, terminal: str
) -> None:
    found = sentence(work)
    assert python in found
    assert "--" not in found
    assert terminal in with_options(found)
    assert "`" not in with_options(found)


def test_the_terminal_shows_options_in_place_of_arguments(
    tmp_path: Path, invoke: Callable[..., Any]
) -> None:
    status, _, error = invoke("part", str(tmp_path / "any.vtu"), "--held", "left,right")
    assert status == 2
    assert "--held left,right names points of a superelement" in error
    assert "leave --held out" in error


def test_what_is_set_for_a_finer_mesh_can_be_typed() -> None:
    words = finer_mesh(MeshSizes(shaft=0.1), 0.031)
    assert "`change_scene(changes={'mesh.shaft': 0.05, " in words
    typed = with_options(words)
    assert "--set mesh.shaft=0.05 --set " in typed
    assert typed.endswith("or ask for --tolerance 3.1%")


def test_notes_of_a_result_have_options_where_a_page_shows_them() -> None:
    found = check(coarse_scene("bonded"))
    misfit = f"name another entry with {argument('bearings', {'main_bearing': 'ENTRY'})}"
    note, *_ = winds_not_used(CaptureTarget(6, 4.0, 24.0), None)
    source = argument("LifeOptions.supply")
    row = AssumptionRow(name="lubrication", value="grease", unit="", source=source)
    shown = result_with_options(
        replace(found, details=(misfit,), notes=(note,), assumptions=(row,))
    )
    assert shown.notes[0].startswith("--winds 4:24 m/s is not used")
    assert shown.assumptions[0].source == "--supply"
    assert misfit == "name another entry with `bearings={'main_bearing': 'ENTRY'}`"
    assert shown.details == ("name another entry with --bearing main_bearing=ENTRY",)


def test_paragraphs_and_captions_of_a_page_have_options() -> None:
    page = Page()
    page.text(f"see {argument('LifeOptions.rings')}")
    page.table(f"by {argument('CaptureTarget.windows')}", [{"`site`": 1}])
    (section,) = sections_with_options(page.sections)
    text, table = section.items
    assert isinstance(text, Text)
    assert text.text == "see --rings"
    assert isinstance(table, Table)
    assert (table.caption, table.columns) == ("by --target", ["`site`"])


def test_only_arguments_that_have_an_option_are_exchanged() -> None:
    for text in ("`nosuch=3`", "`f(`", "``", "`3`", "`laminae=30`", "`level.number`", "`f()`"):
        assert with_options(text) == text
    assert with_options(argument("every", 3) + argument("every")) == "--every 3--every"
    assert with_options(argument("held", ["a`b", "c d"])) == "--held 'a`b,c d'"
    assert with_options(argument("catalogues", ["a", "b"])) == "--catalogue a --catalogue b"
    assert with_options(argument("LifeOptions.profile", False)) == "--straight"


def test_every_option_is_one_of_a_command() -> None:
    group: Any = get_command(app.app)
    known = {
        option
        for command in group.commands.values()
        for parameter in command.params
        for option in (*parameter.opts, *parameter.secondary_opts)
    }
    assert {*OPTIONS.values(), *(words.split()[0] for words in WORDS.values())} <= known


def files_with(pattern: str) -> Iterator[tuple[Path, ast.Module]]:
    """Modules of the library whose text has a pattern."""
    for file in sorted(LIBRARY.rglob("*.py")):
        text = file.read_text("utf-8")
        if re.search(pattern, text):
            yield file, ast.parse(text)


def sentences_of_the_library() -> Iterator[tuple[Path, ast.Constant]]:
    """Texts in the code that name an option and are no docstring, where Python calls it, too."""
    for file, tree in files_with(OPTION):
        if OF_THE_TERMINAL & set(file.relative_to(LIBRARY).parts):
            continue
        docs = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        for node in ast.walk(tree):
            if (
                isinstance(node, ast.Constant)
                and isinstance(node.value, str)
                and id(node) not in docs
            ):
                yield file, node


def test_no_sentence_of_the_library_names_an_option() -> None:
    found = [
        f"{file.name}:{node.lineno}: {node.value}"
        for file, node in sentences_of_the_library()
        if re.search(OPTION, node.value)
        and file.name not in OF_OTHER_PROGRAMS
        and file not in TO_BE_TYPED
    ]
    assert found == []


def test_every_argument_that_is_named_exists_and_has_an_option() -> None:
    named = set()
    for _, tree in files_with(r"\bargument\("):
        for node in ast.walk(tree):
            called = isinstance(node, ast.Call) and getattr(node.func, "id", "") == "argument"
            if called and isinstance(node.args[0], ast.Constant):
                named.add(node.args[0].value)
    assert len(named) > 12
    for name in named:
        owner, _, field = name.rpartition(".")
        assert field in OPTIONS or any(field == key for key, _ in WORDS), name
        if owner:
            assert field in signature(OWNERS[owner]).parameters, name


def test_an_unknown_quantity_is_refused_before_what_computes_it_is_loaded(tmp_path: Path) -> None:
    program = (
        "import atexit, sys\n"
        "from fe_drivetrain.command_line import main\n"
        "studies = lambda: {m.rpartition('.')[2] for m in sys.modules if '.studies.' in m}\n"
        "known = lambda: print({'turning_quantities', 'level_advice'} & studies())\n"
        "atexit.register(known)\n"
        f"main(['advise', 'two_bearings', '--quantity', 'frnt.Fz', '--out', {str(tmp_path)!r}])\n"
    )
    done = subprocess.run([sys.executable, "-P", "-c", program], capture_output=True, text=True)
    assert done.returncode == 2
    assert "'frnt.Fz' is unknown: did you mean 'front.Fz'" in done.stderr
    assert done.stdout == "set()\n"
