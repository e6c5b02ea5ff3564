"""What the site is built from: formulas, results of a run, kept runs of notebooks."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from test_docs_pages import BLOCK, DOCS, PAGES
from test_report import results

from fe_drivetrain.command_line.dossier import TITLES
from fe_drivetrain.drivetrain_file import library_names
from fe_drivetrain.report import Results
from fe_drivetrain.report.answer import Answer
from fe_drivetrain.report.suite import Case

sys.path.insert(0, str(DOCS))

import dossier_pages
import result_pages

VERDICT = "The force is 1 N < 2 N, and that is enough."


def needs(*packages: str) -> None:
    """Skip a test where the extra ``docs`` is not installed, as it need not be for exports."""
    for package in packages:
        pytest.importorskip(package)


def answered() -> Results:
    """Results whose checks pass, with an answer."""
    answer = Answer(question="How large?", verdict=VERDICT, figures=[], status="none")
    return results("a/one", answer=answer, verdicts=[])


def run_folder(folder: Path) -> Path:
    """A folder of results with one case, and what belongs to the folder alone."""
    case = folder / "a" / "one"
    case.mkdir(parents=True)
    for name in ("index.html", "checks.html", "history.sqlite", "a/one/model.png"):
        (folder / name).write_text(name)
    (case / "results.json").write_text(answered().model_dump_json())
    (case / "report.html").write_text("the page")
    return folder


# --- formulas ---


def test_every_formula_becomes_mathml() -> None:
    needs("latex2mathml", "sphinx")
    from formulas import formulas, mathml

    found = [each for page in PAGES for each in formulas(page.read_text("utf-8"))]
    assert len(found) > 300
    for formula, block in found:
        assert mathml(formula, block).startswith("<math "), formula


def test_a_formula_has_its_parts_and_a_wrong_one_is_refused() -> None:
    needs("latex2mathml", "sphinx")
    from formulas import mathml

    text = mathml(r"\frac{a}{b} \cos\alpha x_\mathrm{max}", True)
    assert 'display="block"' in text
    assert re.search(r"<mfrac><mrow><mi>a</mi></mrow><mrow><mi>b</mi></mrow></mfrac>", text)
    assert re.search(r"<mo [^>]*>cos</mo>", text)
    assert "<mtext>max</mtext>" in text
    assert "<mtable" in mathml(r"\begin{aligned} a &= b \\ c &= d \end{aligned}", True)
    for wrong in (r"\frac{a}{b} \folly x", r"\left( a", r"a_{b"):
        with pytest.raises(ValueError, match=re.escape(repr(wrong))):
            mathml(wrong)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.name)
def test_no_formula_stands_as_plain_text(page: Path) -> None:
    text = BLOCK.sub("", page.read_text("utf-8"))
    text = re.sub(r"`[^`]*`|\$[^$]*\$", "", text)
    plain = re.findall(r"\w\^[\w(-]|\bsqrt\(|\b(?:alpha|omega|sigma)_\w+|[A-Z] cross [A-Z]", text)
    assert not plain


# --- results of a run ---


def test_pages_of_a_run_are_in_the_site_and_those_of_an_older_one_are_not(tmp_path: Path) -> None:
    folder, site = run_folder(tmp_path / "run"), tmp_path / "site"
    older = site / "results" / "a" / "gone" / "report.html"
    older.parent.mkdir(parents=True)
    older.write_text("of an older run")
    result_pages.copy_pages(folder, site)
    found = {file.relative_to(site).as_posix() for file in site.rglob("*") if file.is_file()}
    assert found == {
        *("results/index.html", "results/checks.html", "results/a/one/model.png"),
        *("results/a/one/results.json", "results/a/one/report.html"),
    }
    # a report that is replaced later leaves the site as it was built
    new = folder / "new.html"
    new.write_text("a later page")
    os.replace(new, folder / "a/one/report.html")
    assert (site / "results/a/one/report.html").read_text() == "the page"
    (tmp_path / "empty").mkdir()
    result_pages.copy_pages(tmp_path / "empty", site)
    assert not (site / "results").exists()


def test_the_answer_of_a_case_leads_to_its_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = run_folder(tmp_path)
    monkeypatch.setenv("FE_DRIVETRAIN_QUICK_RUNS", str(folder))
    found = result_pages.results()
    answer = result_pages.answer_of("a/one", found)
    assert answer == (
        '<a href="../results/a/one/report.html">The force is 1 N &lt; 2 N, and that is enough.</a>'
    )
    assert result_pages.answer_of("a/two", found) == ""
    said = result_pages.of_the_run(found)
    assert "cases with results: 1." in said
    assert "another state of the program: 1." in said
    assert 'href="../results/index.html"' in said
    assert "atlas.html" not in said  # the run has none
    (folder / "a/one/report.html").unlink()
    assert "<a" not in result_pages.answer_of("a/one", found)


def test_the_validation_index_has_answers_or_says_that_there_are_none(tmp_path: Path) -> None:
    needs("sphinx")
    from written_pages import validation_index

    case = Case("verification/one", "A title", "a book", lambda run, page: None)
    without = validation_index([case], {})
    assert "built without results" in without
    assert "<a" not in without
    (tmp_path / "report.html").touch()
    page = validation_index([case], {"verification/one": (answered(), tmp_path)})
    assert "built without results" not in page
    assert 'results/verification/one/report.html">The force is 1 N' in page


def test_the_gallery_has_a_card_for_each_notebook() -> None:
    needs("sphinx")
    from written_pages import cards_of_notebooks

    cards = "\n".join(cards_of_notebooks())
    for notebook in (DOCS / "notebooks").glob("*.ipynb"):
        assert f":link: ../notebooks/{notebook.stem}\n" in cards
    for picture in re.findall(r":img-top: \.\./(.*)", cards):
        assert (DOCS / picture).is_file()


# --- notebooks ---


def test_runs_of_notebooks_are_kept_until_the_program_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    needs("jupyter_cache")
    import notebook_runs

    monkeypatch.setattr(notebook_runs, "program_hash", lambda: "one")
    kept = Path(notebook_runs.kept_runs(tmp_path))
    (kept / "found").touch()
    assert Path(notebook_runs.kept_runs(tmp_path)) == kept
    assert (kept / "found").exists()
    monkeypatch.setattr(notebook_runs, "program_hash", lambda: "two")
    other = Path(notebook_runs.kept_runs(tmp_path))
    assert other != kept
    assert list(tmp_path.iterdir()) == [other]
    assert not (other / "found").exists()


# --- the dossier ---


def ended(program: str) -> subprocess.Popen[bytes]:
    """A process that does what Python is given, in place of making a dossier."""
    return subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )


def test_a_dossier_is_put_into_the_site_where_its_page_leads(tmp_path: Path) -> None:
    made, site = tmp_path / "made", tmp_path / "site"
    site.mkdir()
    for name in dossier_pages.PAGES:
        page = made / "dossier" / name / "report.html"
        page.parent.mkdir(parents=True)
        page.write_text(name)
    (made / "plotly-1.js").write_text("draws")
    dossier_pages.finish(ended("pass"), made, site)
    links = re.findall(r'href="\.\./([^"]+)"', dossier_pages.dossier_page())
    assert len(links) == len(dossier_pages.PAGES)
    assert all((site / link).is_file() for link in links)
    # two folders above a page, where it looks for it
    assert (site / links[0] / "../../../plotly-1.js").resolve().is_file()


def test_a_dossier_that_is_not_made_ends_the_build(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match="not made: no such turbine"):
        dossier_pages.finish(ended("exit('no such turbine')"), tmp_path, tmp_path)


def test_the_dossier_is_one_of_the_library_with_the_pages_of_the_command() -> None:
    assert dossier_pages.DRIVETRAIN in library_names()
    assert dossier_pages.PAGES.keys() <= TITLES.keys()
