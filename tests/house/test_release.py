"""What a release states stands in one place, or is the same in two."""

import re
import tomllib
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def test_the_citation_names_the_version_and_licence_of_the_package() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["version"] == PROJECT["version"]
    assert citation["license"] == PROJECT["license"]


def test_the_version_is_written_in_the_project_and_the_citation_alone() -> None:
    version = PROJECT["version"]
    literal = re.compile(rf"['\"]{re.escape(version)}['\"]")
    package = [
        path
        for room in ("fe_drivetrain", "geometry", "cases")
        for path in (ROOT / room).rglob("*.py")
    ]
    assert not [path for path in package if literal.search(path.read_text())]


def test_a_base_install_has_no_package_that_only_an_extra_needs() -> None:
    names = {re.split(r"[<>=\[ ]", one)[0].lower() for one in PROJECT["dependencies"]}
    extras = PROJECT["optional-dependencies"]
    for extra in ("excel", "exudyn", "frames", "hdf5", "openfast", "parquet", "wisdem"):
        assert not names & {re.split(r"[<>=\[ ]", one)[0].lower() for one in extras[extra]}
