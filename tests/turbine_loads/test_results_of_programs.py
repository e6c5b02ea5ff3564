"""Results of HAWC2, BHAWC, FLEX and Bladed: values of small files, and of the readers of weio."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hub_load_tables import COLUMNS, LOADS, NAMES, TIME

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.files import hub_load_files, read_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.history_table import HistoryTable
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import beside, history_table

SPEED = COLUMNS["RotSpeed"][1]
RULE = "_" * 100

#: HAWC2's usual axes of a shaft: z to the hub (upwind), y down; x is then our y.
AXES = {"Fx": ("z", -1.0), "Fy": ("x", 1.0), "Fz": ("y", -1.0)}
HAWC2 = {
    ours: f"{'-' if sign < 0 else ''}{ours[0]}{axis} shaft node 5 in shaft"
    for force, (axis, sign) in AXES.items()
    for ours in (force, force.replace("F", "M"))
}


def shaft_loads() -> dict[str, np.ndarray]:
    """The loads [kN, kN m] by component of the axes of HAWC2."""
    ours = dict(zip(NAMES, 1e-3 * LOADS.T, strict=True))
    return {
        f"{letter}{axis}": sign * ours[f"{letter}{force[1]}"]
        for letter in "FM"
        for force, (axis, sign) in AXES.items()
    }


def hawc2(folder: Path, binary: bool = False) -> Path:
    """Results with loads at two nodes of the shaft, in text or packed."""
    loads = shaft_loads()
    rows = [("Time", "s", "Time", TIME), ("bea1 angle_speed", "rpm", "shaft_rot", SPEED)]
    for node, size in ((1, 3.0), (5, 1.0)):
        for name, values in loads.items():
            word = "Force  " if name[0] == "F" else "Moment"
            about = f"{word}{name} Mbdy:shaft nodenr: {node:3} coo: shaft  main bearing"
            unit = "kN" if name[0] == "F" else "kNm"
            rows.append((f"{name} coo: shaft", unit, about, size * values))
    table = np.column_stack([values for *_, values in rows])
    head = [RULE, "  Version ID : HAWC2MB 12.9", " Time : 18:10:14", " Date : 29:06.2017", RULE]
    head += ["  Result file : ./res/a.dat", RULE, "   Scans    Channels    Time [sec]      Format"]
    kind = "BINARY" if binary else "ASCII"
    head += [f"{len(table):12}{len(rows):12}{TIME[-1] + 0.5:16.3f}      {kind}", ""]
    head += ["     Channel   Variable Description", ""]
    head += [f"{k:8}    {n:31}{u:11}{about}" for k, (n, u, about, _) in enumerate(rows, start=1)]
    if binary:
        factors = np.maximum(np.abs(table).max(axis=0), 1e-9) / 32000.0
        head += [RULE, "Scale factors:", *(f"{factor:.8E}" for factor in factors)]
        packed = np.round(table / factors).astype("<i2")
        (folder / "a.dat").write_bytes(packed.T.tobytes())
    else:
        np.savetxt(folder / "a.dat", table, fmt="%16.8e")
    (folder / "a.sel").write_text("\n".join([*head, RULE, ""]))
    return folder / "a.sel"


def bhawc(folder: Path) -> Path:
    """Results of BHAWC, in text."""
    channels = {"Time": ("s", TIME)} | {
        f"{name}s": ("kN" if name[0] == "F" else "kNm", values)
        for name, values in zip(NAMES, 1e-3 * LOADS.T, strict=True)
    }
    head = ["BHawC channel reference file (sel):", RULE, "Original BHAWC file: a", "b", "c", RULE]
    head += ["Scans\tChannels\tTime [sec]\tCoordinate convention: Siemens"]
    head += [f"{len(TIME)}\t{len(channels)}\t{TIME[-1]:.3f}", ""]
    head += ["Channel\tVariable descriptions\tLabels\tUnits"]
    head += [
        f"{k}\tMain shaft {name}\t{name}\t[{unit}]"
        for k, (name, (unit, _)) in enumerate(channels.items(), start=1)
    ]
    (folder / "a.sel").write_text("\n".join([*head, ""]))
    np.savetxt(folder / "a.dat", np.column_stack([v for _, v in channels.values()]), fmt="%16.8e")
    return folder / "a.sel"


def flex(folder: Path, version: int = 0, list_name: str = "sensor") -> Path:
    """Results of FLEX: forces along FLEX's own axes, which are ours here."""
    table = np.column_stack([SPEED, 1e-3 * LOADS])
    names = ["Omega", *NAMES]
    units = ["rpm", *["kN"] * 3, *["kNm"] * 3]
    factors = (np.abs(table).max(axis=0) / 32000.0).astype("<f4")
    packed = np.round(table / factors).astype("<i2")
    count = len(names)
    content = struct.pack("<i", 0) + struct.pack("<i", 99) + b"a run".ljust(60)
    content += struct.pack("<3i", 0, 0, count) + struct.pack(f"<{count}i", *range(1, count + 1))
    content += struct.pack("<2i", 0, version) + struct.pack("<2f", TIME[0], TIME[1] - TIME[0])
    content += factors.tobytes() + (packed.T if version == 3 else packed).tobytes()
    lines = ["Sensor list", " No  forst offset korr.c Volt Unit Navn Beskrivelse"]
    lines += [
        f"{k:3} 1.0 0.0 1.00 0.00 {unit} {name} of the shaft"
        for k, (name, unit) in enumerate(zip(names, units, strict=True), start=1)
    ]
    (folder / list_name).write_text("\n".join([*lines, ""]))
    (folder / "a.int").write_bytes(content)
    return folder / "a.int"


def bladed(folder: Path, form: str = "R*4") -> Path:
    """Hub loads and the rotor's speed in two groups, with one of another layout beside them."""
    rows = {
        "05": {"Rotor speed": ("A/T", SPEED * np.pi / 30.0), "LSS torque": ("FL", 0.0 * TIME)},
        "23": {
            f"Stationary hub {name}": ("F" if name[0] == "F" else "FL", values)
            for name, values in zip(NAMES, LOADS.T, strict=True)
        },
        "07": {"Hub wind speed magnitude": ("L/T", COLUMNS["Wind1VelX"][1])},
    }
    for group, channels in rows.items():
        table = np.column_stack([values for _, values in channels.values()])
        head = [f"FILE\ta.${group}", f"ACCESS\t{'S' if form == 'text' else 'D'}", "FORM\tF"]
        head += ["RECL\t4", f"FORMAT\t{'R*4' if form == 'text' else form}", "CONTENT\t'POWPROD'"]
        head += ["CONFIG\t'STATIONARY'", "NDIMENS\t2", f"DIMENS\t{table.shape[1]}\t{len(table)}"]
        head += ["GENLAB\t'Hub loads: fixed frame GL coordinates'"]
        quoted = [f"'{name}'" for name in channels]
        head += [f"VARIAB\t{' '.join(quoted[:2])}", *([" ".join(quoted[2:])] if quoted[2:] else [])]
        head += ["VARUNIT\t" + " ".join(unit for unit, _ in channels.values())]
        head += ["AXISLAB\t'Time'", "AXIUNIT\tT", "AXIMETH\t2", "MIN \t0.0000000E+000"]
        head += [f"STEP\t{np.float32(TIME[1]):.7E}", "NVARS\t0", "ULOADS  1.0 2.0", ""]
        (folder / f"a.%{group}").write_text("\n".join(head))
        if form == "text":
            np.savetxt(folder / f"a.${group}", table, fmt="%.8E")
        else:
            kind = {"R*4": "<f4", "R*8": "<f8"}[form]
            (folder / f"a.${group}").write_bytes(table.astype(kind).tobytes())
    (folder / "a.%14").write_text("NDIMENS 3\nDIMENS 2 3 4\n")
    (folder / "a.$PJ").write_text("project")
    return folder / "a.%23"


PACKED = 1.1 * np.abs(LOADS).max(axis=0) / 32000.0
OF_FLEX = ChannelMap(channels={name: name for name in NAMES})
OF_HAWC2 = ChannelMap(channels={**HAWC2, "rotor speed": "bea1 angle_speed"})
RUNS: dict[str, tuple[Callable[[Path], Path], ChannelMap, np.ndarray | float]] = {
    "HAWC2, text": (hawc2, OF_HAWC2, 1e-2),
    "HAWC2, packed": (lambda p: hawc2(p, binary=True), OF_HAWC2, PACKED),
    "HAWC2, by its samples": (lambda p: hawc2(p).with_suffix(".dat"), OF_HAWC2, 1e-2),
    "BHAWC": (bhawc, ChannelMap(channels={name: f"{name}s" for name in NAMES}), 1e-2),
    "FLEX": (flex, OF_FLEX, PACKED),
    "FLEX, version 3": (lambda p: flex(p, 3), OF_FLEX, PACKED),
    "FLEX, a list of its own": (lambda p: flex(p, 2, "sensor_a"), OF_FLEX, PACKED),
    "Bladed": (bladed, ChannelMap(), 0.1),
    "Bladed, double": (lambda p: bladed(p, "R*8"), ChannelMap(), 1e-6),
    "Bladed, text": (lambda p: bladed(p, "text"), ChannelMap(), 0.1),
    "Bladed, samples": (lambda p: bladed(p).with_suffix(".$23"), ChannelMap(), 0.1),
    "Bladed, project": (lambda p: bladed(p).with_suffix(".$PJ"), ChannelMap(), 0.1),
}


@pytest.mark.parametrize("kind", RUNS)
def test_loads_are_those_that_were_written(tmp_path: Path, kind: str) -> None:
    write, mapping, tolerance = RUNS[kind]
    found = read_recorded(write(tmp_path), mapping)
    np.testing.assert_allclose(found.history.time, TIME, atol=1e-4 if "packed" in kind else 1e-9)
    assert (np.abs(found.history.loads - LOADS) <= tolerance).all()
    if "BHAWC" not in kind:
        np.testing.assert_allclose(found.rotor_speed, SPEED * np.pi / 30.0, rtol=1e-4)
    assert (found.wind_speed is not None) is kind.startswith("Bladed")


def test_what_bladed_calls_its_frame_is_stated(tmp_path: Path) -> None:
    attributes = read_hub_loads(bladed(tmp_path)).attributes
    assert attributes["frame of hub loads"] == (
        "stationary hub: x along the shaft downwind, z up, y = z cross x; about the hub's centre"
    )
    assert "Fx = Stationary hub Fx [N]" in str(attributes["channels"])


@pytest.mark.parametrize(
    ("write", "says"),
    [
        (hawc2, r"depends on the model: state it in .*'-Fz shaft node 1 in shaft'.*it has Fz sh"),
        (bhawc, r"state it in `ChannelMap`.*it has Fxs \[kN\], Fys"),
        (flex, "no column Fx, Fy, Fz, Mx, My, Mz; which channels are hub loads, in which frame"),
    ],
)
def test_loads_whose_frame_is_of_the_model_are_asked_for(
    tmp_path: Path, write: Callable[[Path], Path], says: str
) -> None:
    file = write(tmp_path)
    with pytest.raises(InputError, match=says):
        read_hub_loads(file)


def fault(name: str, old: str, new: str) -> Callable[[Path], None]:
    def change(folder: Path) -> None:
        file = folder / name
        content = file.read_text(encoding="latin-1")
        assert old in content
        file.write_text(content.replace(old, new, 1), encoding="latin-1")

    return change


@pytest.mark.parametrize(
    ("kind", "change", "says"),
    [
        ("HAWC2, text", lambda p: (p / "a.dat").unlink(), r"a\.dat': there is no such file"),
        ("HAWC2, text", fault("a.dat", "\n", "\n1 2\n"), "line 2 has 2 values for 14 channels"),
        ("HAWC2, text", fault("a.dat", "2.00000000e+02", "oops"), "channel Fz shaft node 5 .*oops"),
        ("HAWC2, text", fault("a.sel", "  24 ", "  25 "), r"a\.dat has 24 of 25 scans: run the"),
        ("HAWC2, text", fault("a.sel", "  14 ", "  15 "), "channel 15 of 15 is missing.*again"),
        ("HAWC2, packed", fault("a.sel", "Scale", "Some"), "cannot be read as a list of channels"),
        ("BHAWC", fault("a.sel", "Scans", "Scas"), "cannot be read as a list of channels"),
        ("FLEX", lambda p: (p / "sensor").unlink(), "list of its sensors is missing: put the file"),
        (
            "FLEX",
            fault("sensor", "  7 1.0 0.0 1.00", ""),
            "cannot be read as a result",
        ),
        ("Bladed", lambda p: (p / "a.$23").unlink(), r"a\.\$23': there is no such file"),
        ("Bladed", fault("a.%23", "STEP", "STAP"), "as a header of Bladed .STEP is missing.: name"),
        ("Bladed", fault("a.%23", "DIMENS\t6", "DIMENS\t7"), "7 channels of 24 samples, with 6 na"),
        (
            "Bladed",
            fault("a.%23", "Stationary", "Rotating"),
            "no column Fx.*map others in `Ch",
        ),
    ],
)
def test_a_fault_of_a_result_is_named(
    tmp_path: Path, kind: str, change: Callable[[Path], None], says: str
) -> None:
    write, mapping, _ = RUNS[kind]
    file = write(tmp_path)
    change(tmp_path)
    with pytest.raises(InputError, match=says):
        read_recorded(file, mapping)


def test_a_run_is_found_once(tmp_path: Path) -> None:
    run = hawc2(tmp_path)
    assert hub_load_files(str(tmp_path)) == hub_load_files(str(tmp_path / "*")) == [run]
    assert beside(run) == [run, run.with_suffix(".dat")]
    (tmp_path / "b").mkdir()
    group = bladed(tmp_path / "b")
    project = [group.with_suffix(".$PJ")]
    assert hub_load_files(str(tmp_path / "b")) == hub_load_files(f"{tmp_path}/b/*") == project
    assert hub_load_files(str(tmp_path / "b" / "*.%23")) == [group]
    with pytest.raises(InputError, match="two files of one Bladed run, which would count twice"):
        hub_load_files(str(tmp_path / "b" / "*.%*"))
    assert {one.name for one in beside(group)} >= {"a.%23", "a.$23", "a.%05", "a.$05"}
    flexed = flex(tmp_path / "b")
    assert beside(flexed) == [flexed, flexed.with_name("sensor")]


def test_kinds_that_are_not_read_say_what_to_write(tmp_path: Path) -> None:
    (tmp_path / "a.hdf5").write_bytes(b"any")
    for read in (read_hub_loads, read_recorded):
        with pytest.raises(InputError, match=r"'\.hdf5' is not read: let HAWC2 write hawc_binary"):
            read(tmp_path / "a.hdf5")


# --- a peer --------------------------------------------------------------------------------------


def opened(file: Path) -> tuple[HistoryTable, np.ndarray]:
    table = history_table(file)
    columns = table.columns(range(len(table.titles)), [0]).values
    return table, np.column_stack([columns[k] for k in range(len(table.titles))])


@pytest.mark.needs("weio")
@pytest.mark.parametrize("kind", [k for k in RUNS if "its" not in k and "proj" not in k])
def test_all_channels_are_those_that_weio_reads(tmp_path: Path, kind: str) -> None:
    from weio.bladed_out_file import BladedFile
    from weio.flex_out_file import FLEXOutFile
    from weio.hawc2_dat_file import HAWC2DatFile

    file = RUNS[kind][0](tmp_path)
    if "Bladed" in kind:
        for other in tmp_path.glob("a.*[0457]"):
            other.unlink()
    read = {"HAWC2": HAWC2DatFile, "BHAWC": HAWC2DatFile, "FLEX": FLEXOutFile}
    peer = read.get(kind.split(",")[0], BladedFile)(str(file)).toDataFrame()
    if isinstance(peer, dict):
        (peer,) = peer.values()
    table, values = opened(file)
    assert len(table.titles) == peer.shape[1]
    packed = 1 if kind == "HAWC2, packed" else 0  # time, which weio leaves coarse
    np.testing.assert_allclose(
        values[:, packed:], peer.to_numpy()[:, packed:], rtol=2e-6, atol=1e-6
    )
    np.testing.assert_allclose(values[:, 0], TIME, atol=1e-4)
