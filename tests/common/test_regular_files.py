"""No reader of a user's file waits for a pipe, or reads a device that has no end."""

import os
import signal
import socket
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from tiny_case import Result

from fe_drivetrain import export
from fe_drivetrain.bearing import catalogue
from fe_drivetrain.common import regular_files
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.provenance import file_digest
from fe_drivetrain.common.regular_files import NotRegularError, TooLargeError, opened, text_of
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.reading import read_component, read_scene
from fe_drivetrain.export.calculix_results import read_dat
from fe_drivetrain.export.formats import (
    craig_bampton_json,
    elastodyn,
    extptfm,
    stiffness_file,
    summary,
    windio,
)
from fe_drivetrain.export.limited_reading import read_limited
from fe_drivetrain.foreign.reading import read_in_process
from fe_drivetrain.foreign.survey import surveyed
from fe_drivetrain.procedure import failure_modes
from fe_drivetrain.procedure.interface_loads import read_load_json
from fe_drivetrain.procedure.iteration_log import read_log
from fe_drivetrain.procedure.measurement_cases import read_measurement_cases
from fe_drivetrain.procedure.project import read_project
from fe_drivetrain.report.results import read_results
from fe_drivetrain.turbine_loads.hub_loads.channel_map import read_channel_map
from fe_drivetrain.turbine_loads.hub_loads.files import read_hub_load_files, read_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.recorded import OWN_NAMES, read_recorded
from fe_drivetrain.turbine_loads.hub_loads.wind_boxes import read_bts, read_hawc2

#: Every reader of what a user names, with an ending that it takes.
READERS: list[tuple[str, Callable[[Path], Any]]] = [
    (".yaml", read_scene),
    (".yaml", read_component),
    (".yaml", read_drivetrain),
    (".yaml", read_project),
    (".yaml", read_measurement_cases),
    (".yaml", read_channel_map),
    (".yaml", failure_modes.read_catalogue),
    (".yaml", catalogue.read_bearing_catalogue),
    (".yaml", windio.read_torsion),
    (".csv", read_hub_loads),
    (".out", read_hub_loads),
    (".outb", read_hub_loads),
    (".out", lambda path: read_hub_load_files(str(path))),
    (".csv", lambda path: read_recorded(path, OWN_NAMES)),
    (".bts", read_bts),
    (".bin", lambda path: read_hawc2(path, (2, 2, 2), (1.0, 1.0, 1.0), 9.0, 90.0)),
    (".dat", elastodyn.read_torsion),
    (".dat", extptfm.read_release_4),
    (".dat", read_dat),
    (".json", read_load_json),
    (".json", read_log),
    (".json", read_results),
    (".json", stiffness_file.read_stiffness_json),
    (".json", summary.read_summary),
    (".json", craig_bampton_json.read_craig_bampton),
    (".step", surveyed),
    (".msh", surveyed),
    (".vtu", lambda path: read_in_process("read mesh", path, {})),
    *(
        (form.suffix, lambda path, name=name: export.read_superelement(path, name))
        for name, form in export.FORMATS.items()
        if hasattr(export.format_module(name), "read")
    ),
    (".json", lambda path: read_limited(path, "json")),
]


@pytest.fixture(autouse=True)
def soon() -> Iterator[None]:
    """A reader that waits is an error, and does not hold the tests."""
    signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.alarm(20)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)


@pytest.fixture(params=["pipe", "zero", "random", "socket", "folder"])
def irregular(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """Something that is no regular file, to be given any ending."""
    path = tmp_path / str(request.param)
    if request.param == "pipe":
        os.mkfifo(path)
    elif request.param == "socket":
        with socket.socket(socket.AF_UNIX) as server:
            server.bind(str(path))
    elif request.param == "folder":
        path.mkdir()
    else:
        path = Path("/dev") / ("zero" if request.param == "zero" else "urandom")
    return path


def test_no_reader_waits(irregular: Path, tmp_path: Path) -> None:
    for number, (ending, read) in enumerate(READERS):
        link = tmp_path / f"link_{number}{ending}"
        link.symlink_to(irregular)
        with pytest.raises((InputError, NotRegularError, IsADirectoryError)) as refused:
            read(link)
        message = str(refused.value)
        assert "which may have no end" in message or "folder" in message, (number, message)
        assert file_digest(str(link)) == ""


@pytest.mark.parametrize(
    ("command", "endings"),
    [
        ("part", (".json", ".csv", ".bdf", ".op4", ".h5", ".step", ".msh", ".inp")),
        ("check", (".yaml", ".json")),
        ("loads", (".csv", ".out", ".outb")),
        ("life {0} --loads {0}", (".yaml",)),
        ("check two_bearings --set bearing_units.0.housing.mesh={0}", (".msh",)),
        ("compare-runs {0} {0}", ("",)),
        ("validate", (".yaml",)),
    ],
)
def test_no_command_waits(
    invoke: Callable[..., Result], tmp_path: Path, command: str, endings: tuple[str, ...]
) -> None:
    for ending in endings:
        pipe = tmp_path / f"pipe{ending}"
        os.mkfifo(pipe)
        words = command.format(pipe).split() if " " in command else [command, str(pipe)]
        status, out, err = invoke(*words)
        assert (status, out) == (2, "")
        assert err.splitlines()[-1].startswith("fe-drivetrain: ")
        assert "Traceback" not in err


def test_a_file_that_grew_too_large_is_not_read_to_its_end(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"a\r\nb\rc\n")
    assert text_of(file) == "a\nb\nc\n"
    assert text_of(file, most=7) == "a\nb\nc\n"
    with pytest.raises(TooLargeError, match="more than 6 bytes"):
        text_of(file, most=6)
    with file.open("r+b") as stream:
        stream.truncate(10**13)  # it has no blocks on disk
    with pytest.raises(TooLargeError):
        text_of(file)
    with pytest.raises(InputError, match="it has more than 8000000000 bytes"):
        read_hub_loads(file.rename(tmp_path / "file.outb"))


def test_what_is_exchanged_for_a_pipe_meanwhile_is_not_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    monkeypatch.setattr(regular_files, "require_regular", lambda path: None)
    with pytest.raises(NotRegularError, match="it is a pipe"):
        opened(pipe)
