"""Manifests of folders, and folders of reports: what they list, and what of others they keep."""

import hashlib
import json
import os
import sqlite3
from pathlib import Path

import pytest
from faulty_cases import NEW
from test_faults import marked as marked_case
from test_faults import state
from test_foreign_files import OLD, add_foreign, everything

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.manifest import MANIFEST, manifest_of, read_manifest
from fe_drivetrain.report.history import FILE
from fe_drivetrain.report.index import PROBLEMS
from fe_drivetrain.report.suite.ownership import claim_reports
from fe_drivetrain.report.suite.result_folders import run_case
from fe_drivetrain.report.suite.suite import run_cases

# --- manifests ------------------------------------------------------------------------------------

OUTSIDE = ["../thesis.txt", "/etc/passwd", "a/../../thesis.txt", "", ".", "a//b", "a\0b"]


@pytest.mark.parametrize("name", OUTSIDE)
def test_a_manifest_that_names_anything_outside_is_refused(tmp_path: Path, name: str) -> None:
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    thesis = tmp_path / "thesis.txt"
    thesis.write_text("years of work")
    entry = {"bytes": 13, "sha256": hashlib.sha256(b"years of work").hexdigest()}
    content = json.loads((out / MANIFEST).read_text())
    for changed in ({"files": {**content["files"], name: entry}}, {"folders": [name]}):
        (out / MANIFEST).write_text(json.dumps(content | changed))
        before = everything(tmp_path)
        with pytest.raises(InputError, match="damaged"):
            run_case(marked_case(NEW), out)
        assert everything(tmp_path) == before


def test_a_listed_path_through_a_link_removes_nothing_there(tmp_path: Path) -> None:
    out, elsewhere = tmp_path / "b", tmp_path / "elsewhere"
    run_case(marked_case(OLD), out)
    # the same content under the same name, behind a link
    (out / "two").rename(elsewhere)
    (out / "two").symlink_to(elsewhere, target_is_directory=True)
    with pytest.warns(UserWarning, match=r"two\.kept"):
        run_case(marked_case(NEW), out)
    assert (elsewhere / "three.txt").read_text() == OLD * 1000
    assert os.readlink(out / "two.kept") == str(elsewhere)
    assert state(out, "two.kept") == NEW


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "null", '{"schema": "fe-drivetrain folder"}', "[" * 100_000, "\ud800"]
)
def test_a_damaged_manifest_is_refused_in_a_sentence(tmp_path: Path, text: str) -> None:
    run_case(marked_case(OLD), tmp_path / "b")
    (tmp_path / "b" / MANIFEST).write_bytes(text.encode("utf-8", "surrogatepass"))
    before = everything(tmp_path)
    with pytest.raises(InputError, match=r"damaged.*move the folder away"):
        run_case(marked_case(NEW), tmp_path / "b")
    assert everything(tmp_path) == before


def test_every_damage_of_a_manifest_keeps_what_is_not_listed(tmp_path: Path) -> None:
    """One bit of it turned, wherever: what it lists by mistake has another content."""
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    (out / "one.tyt").write_text("thesis")
    text = (out / MANIFEST).read_bytes()
    for place in range(0, len(text), 7):
        changed = bytearray(text)
        changed[place] ^= 1 << (place % 8)
        (out / MANIFEST).write_bytes(changed)
        try:
            own = read_manifest(out)
        except InputError:
            continue
        assert own is not None
        assert not own.has("one.tyt", out / "one.tyt")
        assert all(not name.startswith(("/", "../")) for name in own.files)


def test_a_folder_without_manifest_is_known_by_its_results(tmp_path: Path) -> None:
    """As versions before wrote them: own are what is known to be, all else is kept."""
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    (out / MANIFEST).unlink()
    with pytest.warns(UserWarning, match=r"one\.txt\.kept, two/three\.txt\.kept"):
        run_case(marked_case(NEW), out)
    assert (out / "one.txt.kept").read_text() == OLD
    assert state(out, "one.txt.kept") == NEW
    reports = tmp_path / "reports"
    run_case(marked_case(OLD), reports / "a" / "b")
    (reports / MANIFEST).unlink()
    assert claim_reports(reports)


def test_a_manifest_survives_the_round_trip(tmp_path: Path) -> None:
    add_foreign(tmp_path / "b")
    found = manifest_of(tmp_path / "b", "results")
    assert set(found.files) == {"notes.txt", "data/deep/a.csv"}
    assert found.folders == {"data", "data/deep", "data/deep/empty"}
    (tmp_path / MANIFEST).write_text(found.text())
    assert read_manifest(tmp_path) == found
    assert read_manifest(tmp_path / "b") is None


# --- folders of reports ---------------------------------------------------------------------------


@pytest.mark.filterwarnings("ignore:.*was not written by this program")
def test_pages_of_reports_replace_no_page_of_others(tmp_path: Path) -> None:
    case = marked_case(NEW)
    run_cases([case], tmp_path)
    (tmp_path / "index.html").write_text("<p>mine")
    (tmp_path / "atlas.html").write_text("<p>mine, too")
    (tmp_path / PROBLEMS).write_text('{"mine": 1}')
    edited = (tmp_path / "checks.html").read_text().replace("fe-drivetrain", "edited", 1)
    (tmp_path / "checks.html").write_text(edited)
    with pytest.warns(UserWarning, match=r"index\.html was not written by this program"):
        run_cases([case], tmp_path)
    assert (tmp_path / "index.html.kept").read_text() == "<p>mine"
    assert (tmp_path / "checks.html.kept").read_text() == edited
    assert (tmp_path / "atlas.html").read_text() == "<p>mine, too"
    assert '{"mine": 1}' in {file.read_text() for file in tmp_path.glob(f"{PROBLEMS}*")}
    before = set(os.listdir(tmp_path))
    run_cases([case], tmp_path)
    assert set(os.listdir(tmp_path)) == before


def test_a_database_of_another_program_gets_no_tables(tmp_path: Path) -> None:
    assert claim_reports(tmp_path)
    with sqlite3.connect(tmp_path / FILE) as database:
        database.execute("CREATE TABLE patients (name TEXT)")
    database.close()
    before = (tmp_path / FILE).read_bytes()
    with pytest.raises(InputError, match=r"another program, with patients.*move it away"):
        run_cases([marked_case(NEW)], tmp_path)
    assert (tmp_path / FILE).read_bytes() == before


def test_a_reports_folder_is_no_result_folder_and_the_other_way_round(tmp_path: Path) -> None:
    run_cases([marked_case(NEW)], tmp_path / "reports")
    with pytest.raises(InputError, match="above the results of several cases"):
        run_case(marked_case(NEW), tmp_path / "reports")
    with pytest.raises(InputError, match="not results"):
        run_cases([marked_case(NEW)], tmp_path / "reports" / "a" / "b")
