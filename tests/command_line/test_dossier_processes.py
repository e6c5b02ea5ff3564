"""A dossier in two processes: it finds what one finds, fails in one sentence, and stops at once."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from hub_load_tables import swinging_loads

from fe_drivetrain.command_line.dossier import chains_of
from fe_drivetrain.common.cache import CACHE_VARIABLE
from fe_drivetrain.common.threads import CORES_VARIABLE

SCENE = "main_bearing_spherical"
COARSE = ("mesh.shaft=0.5", "mesh.bearing=0.2", "mesh.housing=0.3", "mesh.elements_per_turn=6")
# -P: the package that is installed, not one in this folder
PROGRAM = [sys.executable, "-P", "-c", "from fe_drivetrain.command_line.entry import main; main()"]

PARTS = {"overview", "loads", "reactions", "life", "model", "check", "export"}


@pytest.fixture
def loads(tmp_path: Path) -> Path:
    """Half a minute of loads that swing, and the rotor's speed."""
    return swinging_loads(tmp_path / "gust.csv", 30.0)


def words(loads: Path, out: Path, *changes: str) -> list[str]:
    given = [*PROGRAM, "report", SCENE, "--loads", str(loads), "--quick", "--out", str(out)]
    return given + [word for change in (*COARSE, *changes) for word in ("--set", change)]


def environment(cores: int, cache: Path) -> dict[str, str]:
    return {**os.environ, CORES_VARIABLE: str(cores), CACHE_VARIABLE: str(cache)}


def timeless(found: Any) -> Any:
    """Results without what a clock has measured."""
    if isinstance(found, Mapping):
        return {k: timeless(v) for k, v in found.items() if "time" not in k}
    return [timeless(one) for one in found] if isinstance(found, list) else found


def hidden(folder: Path) -> list[str]:
    return [path.name for path in folder.rglob(".*") if path.is_dir()]


def test_two_processes_find_what_one_finds_to_the_last_digit(loads: Path, tmp_path: Path) -> None:
    found, said = {}, {}
    for cores in (1, 2):
        out = tmp_path / str(cores)
        run = subprocess.run(
            words(loads, out),
            env=environment(cores, tmp_path / f"cache {cores}"),
            capture_output=True,
            text=True,
            check=False,
        )
        assert run.returncode == 0, run.stderr
        said[cores] = run.stderr.splitlines()
        parts = {}
        for file in (out / "dossier").glob("*/results.json"):
            results = json.loads(file.read_text())
            parts[file.parent.name] = (results["answer"]["verdict"], timeless(results["figures"]))
        found[cores] = parts
        assert hidden(out) == []
    assert found[1].keys() == PARTS
    assert found[1] == found[2]
    # in two processes each step is named with its part
    assert "mesh ..." in said[1]
    assert "mesh ..." not in said[2]
    assert "Reactions: mesh ..." in said[2]


@pytest.mark.parametrize("cores", [1, 2])
def test_a_fault_that_a_part_finds_is_one_sentence(loads: Path, tmp_path: Path, cores: int) -> None:
    out = tmp_path / "boss"
    run = subprocess.run(
        words(loads, out, "bearing_units.0.housing.wall=1e-3"),
        env=environment(cores, tmp_path / "cache"),
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 2, run.stderr
    assert "Traceback" not in run.stderr
    (said,) = [line for line in run.stderr.splitlines() if not line.rstrip().endswith("...")]
    assert said
    assert hidden(out) == []


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_a_stop_ends_all_processes_and_leaves_nothing_half_written(
    loads: Path, tmp_path: Path, sent: signal.Signals
) -> None:
    out = tmp_path / "boss"
    with subprocess.Popen(
        words(loads, out),
        env=environment(2, tmp_path / "cache"),
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
    ) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if line == "Reactions: mesh ...\n":
                break
        process.send_signal(sent)
        said = process.stderr.read()  # which ends when no process holds it any more
        assert process.wait(60) == (130 if sent == signal.SIGINT else 143)
    assert "Traceback" not in said
    assert hidden(out) == []
    assert not (out / "dossier/reactions").exists()


def test_what_takes_longest_begins_first_and_models_follow_reactions() -> None:
    chains = chains_of(["loads", "reactions", "life", "model", "check"])
    assert chains == [["reactions", "model"], ["life"], ["check"], ["loads"]]
    assert chains_of(["model", "export"]) == [["model"], ["export"]]
    assert chains_of([]) == []
