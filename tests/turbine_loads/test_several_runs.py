"""Two runs in one file, and files of two turbines in one set, are named."""

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from test_hub_loads import rotating_columns, write_out, write_outb
from tiny_case import Result

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.csv_table import write_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.files import read_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded
from fe_drivetrain.turbine_loads.hub_loads.turbines import different_turbines, vertical_forces

REAL_FOLDER = Path(os.environ.get("FE_DRIVETRAIN_OPENFAST", "no folder is given"))


@pytest.mark.parametrize("read", [read_hub_loads, read_recorded])
@pytest.mark.parametrize(
    ("name", "write", "message"),
    [
        ("a.out", write_out, "line 415 has the names of channels again, .* a file of its own"),
        (
            "a.outb",
            write_outb,
            "a second run begins after the 400 samples .* a file of its own",
        ),
    ],
)
def test_a_second_run_in_a_file_is_refused(
    read: Callable[[Path], object],
    name: str,
    write: Callable[..., Path],
    message: str,
    tmp_path: Path,
) -> None:
    file = write(tmp_path / name, rotating_columns())
    read(file)
    file.write_bytes(2 * file.read_bytes())
    with pytest.raises(InputError, match=message):
        read(file)


def made(name: str, weight: float, seed: int, sway: float = 0.1) -> LoadHistory:
    rng = np.random.default_rng(seed)
    loads = 1e5 * rng.normal(size=(100, 6))
    loads[:, 2] = -weight * (1.0 + sway * rng.normal(size=100))
    return LoadHistory(name, 0.1 * np.arange(100.0), loads)


def test_rotors_of_different_weight_are_named_and_winds_are_not() -> None:
    one, like, other = made("one", 1e6, 1), made("like", 1.1e6, 2), made("other", 4.5e5, 3)
    air = made("air", 1e5, 4, sway=2.0)
    assert different_turbines(vertical_forces([one, like, air])) == ""
    assert different_turbines({}) == ""
    sentence = different_turbines(vertical_forces([one, like, other, air]))
    assert "kN in other and -1,1" in sentence
    assert "kN in like" in sentence


def test_commands_name_a_set_of_two_turbines(
    invoke: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for history in (made("small", 4.5e5, 1), made("large", 1e6, 2)):
        write_hub_loads(history, f"{history.name}.csv", {"rotor speed [rad/s]": np.full(100, 1.2)})
    for words in (
        ("loads", "*.csv", "--out", "a"),
        ("life", "main_bearing_bonded", "--loads", "*.csv", "--out", "b"),
    ):
        extra = ("--bearing", "main_bearing=bearing_s_o20") if words[0] == "life" else ()
        status, printed, error = invoke(*words, *extra)
        assert status == 0, error
        assert "seem to be of different turbines" in " ".join(printed.split())


@pytest.mark.skipif(not REAL_FOLDER.is_dir(), reason="no folder with real files is named")
def test_real_files_of_two_turbines_are_told_apart() -> None:
    of_5mw = [read_hub_loads(file) for file in sorted(REAL_FOLDER.glob("nrel5mw_*.outb"))]
    of_2p8 = [read_hub_loads(REAL_FOLDER / "nrel2p8_w11B.outb")]
    assert different_turbines(vertical_forces(of_5mw)) == ""
    assert "different turbines" in different_turbines(vertical_forces([*of_5mw, *of_2p8]))
