"""Blocks of the documentation: each of Python runs somewhere, each command has its options."""

import ast
import contextlib
import shlex
from pathlib import Path

import pytest
import typer.main
from test_docs_pages import BLOCK, DOCS, PAGES, ROOT

from fe_drivetrain.command_line.app import app
from fe_drivetrain.elasticity.solve import petsc

pytestmark = pytest.mark.usefixtures("kept_between_runs")

HERE = Path(__file__).parent
#: Pages whose blocks of Python run below, in order, in one empty folder.
REFERENCE = {"bearing", "clusters", "dynamics", "gears", "life", "procedure", "transients"}
REFERENCE |= {"limits", "turbine"}
#: Blocks that tests of these files take out of their pages.
ELSEWHERE = {"../README": "test_docs.py", "gear_rating": "test_docs.py", "loads": "test_docs.py"}
ELSEWHERE |= {"python": "test_face.py"}
#: What a block needs that no machine of the tests has; its words are compiled all the same.
NEEDS = {
    "import submitit": "a scheduler beside it: test_cluster.py runs it",
    'read_bts("wind.bts")': "a wind of TurbSim",
}


def name_of(page: Path) -> str:
    """As `run_page` has it, without its ending."""
    inside = page.is_relative_to(DOCS)
    return (page.relative_to(DOCS) if inside else Path("..", page.name)).with_suffix("").as_posix()


def blocks(page: Path, kind: str) -> list[str]:
    return [block for of, block in BLOCK.findall(page.read_text("utf-8")) if of == kind]


def pages_that_run() -> set[str]:
    """Pages that `test_docs_pages.py` hands to `run_page`."""
    tree = ast.parse((HERE / "test_docs_pages.py").read_text("utf-8"))
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    named = [c.args[0] for c in calls if isinstance(c.func, ast.Name) and c.func.id == "run_page"]
    return {str(a.value).removesuffix(".md") for a in named if isinstance(a, ast.Constant)}


def test_every_page_with_python_runs_in_a_test() -> None:
    with_python = {name_of(page) for page in PAGES if blocks(page, "python")}
    assert len(with_python) > 20
    for name, file in ELSEWHERE.items():
        assert f"{Path(name).name}.md" in (HERE / file).read_text("utf-8")
    assert with_python == pages_that_run() | REFERENCE | set(ELSEWHERE)
    # what is left out is on a page
    text = "".join(block for page in PAGES for block in blocks(page, "python"))
    assert all(words in text for words in NEEDS)


@pytest.mark.parametrize("name", sorted(REFERENCE))
def test_the_blocks_of_a_page_run(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    ran = 0
    for block in blocks(DOCS / f"{name}.md", "python"):
        code = compile(block, name, "exec")
        if '"petsc"' in block and petsc.interpreter() is None:
            pytest.skip(f"no Python here has petsc4py: {petsc.INSTALL}")
        if not any(words in block for words in NEEDS):
            with contextlib.redirect_stdout(None):
                exec(code, names)
            ran += 1
    assert ran
    found = names.get("found")
    assert getattr(found, "converged", True)


def test_every_command_of_a_page_has_the_options_that_it_is_given() -> None:
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    seen = set()
    for page in PAGES:
        for line in "".join(blocks(page, "sh")).replace("\\\n", " ").splitlines():
            words = shlex.split(line, comments=True)
            if not words or Path(words[0]).name != "fe-drivetrain":
                continue
            where = f"{page.relative_to(ROOT)}: {line}"
            command = commands[words[1]]
            known = {"--help", *(option for each in command.params for option in each.opts)}
            given = {word.partition("=")[0] for word in words[2:] if word.startswith("--")}
            assert given <= known, where
            seen.add(words[1])
    assert len(seen) > 8
