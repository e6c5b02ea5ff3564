"""``loads`` on anyone's files: mapped channels, other lengths and steps, stop and go on."""

import csv
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tiny_case import Result

from fe_drivetrain.command_line.table_files import write_tables
from fe_drivetrain.common.cache import CACHE_VARIABLE, Cache
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.remarks import VERBOSE_VARIABLE
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.report.results import read_results
from fe_drivetrain.studies import load_reactions, loads
from fe_drivetrain.studies.load_digest import LoadOptions, digest
from fe_drivetrain.studies.load_reactions import scene_reactions
from fe_drivetrain.studies.load_totals import LoadSums
from fe_drivetrain.studies.wind_statistics import bending_rows, channel_rows, wind_rows
from fe_drivetrain.turbine_loads.histories.sites import site_of_class
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import Recorded, read_recorded

HERTZ = 0.25  # of the rotor
COLUMNS = "--channel", "wind speed=Vhub", "--channel", "rotor speed=N"


def write_history(path: Path, seconds: float, step: float, wind: float) -> None:
    """A moment of 3P about y and z, a torque of 6P, the rotor's weight; columns of own names."""
    time = np.arange(0.0, seconds, step)
    turn = 2.0 * np.pi * HERTZ * time
    loads = [
        time * 0.0 + 200.0,
        time * 0.0,
        time * 0.0 - 400.0,
        900.0 + 50.0 * np.cos(6 * turn),
        100.0 + 300.0 * np.cos(3 * turn),
        300.0 * np.sin(3 * turn),
    ]
    beside = [wind + np.sin(0.3 * time), 60.0 * HERTZ + 0.0 * time]
    units = 3 * ["kN"] + 3 * ["kN m"]
    names = [f"{name} [{unit}]" for name, unit in zip(FORCES, units, strict=True)]
    header = ",".join(["time [s]", *names, "Vhub [m/s]", "N [rpm]"])
    table = np.column_stack([time, *loads, *beside])
    np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.9g")


@pytest.fixture
def histories(tmp_path: Path) -> Path:
    folder = tmp_path / "own"
    folder.mkdir()
    write_history(folder / "a.csv", 60.05, 0.05, 8.0)
    write_history(folder / "b.csv", 80.25, 0.25, 12.0)
    return folder


def rows_of(file: Path) -> list[dict[str, str]]:
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def test_the_page_of_own_files(invoke: Callable[..., Result], histories: Path) -> None:
    out = histories.parent / "out"
    status, printed, _ = invoke(
        "loads", str(histories), "--out", str(out), *COLUMNS, "--site", "IIB"
    )
    assert status == 0, printed
    assert printed.startswith("Bending at the hub reaches 400 kN m; ")
    said = " ".join(read_results(out / "results.json").details)
    assert "2 files, 1,522 samples over 140.3 s" in said
    assert "half cycles of the residue count as halves" in said
    equivalent = rows_of(out / "equivalent_loads.csv")
    of_a = {
        (row["channel"], row["slope"]): float(row["DEL at 1 Hz"])
        for row in equivalent
        if row["file"] == "a"
    }
    # 0.75 Hz for 60 s, sampled at its peaks but for one part in a thousand; two half cycles open
    assert of_a["My", "3"] == pytest.approx(600e3 * 0.75 ** (1 / 3), rel=0.02)
    assert of_a["bending moment", "3"] < of_a["My", "3"]
    assert of_a["Fz", "3"] == 0.0
    windows = rows_of(out / "windows.csv")
    assert {row["channel"] for row in windows} >= {"rotor speed", "wind speed", "Mx"}
    speed = next(row for row in windows if row["channel"] == "rotor speed")
    assert float(speed["mean"]) == pytest.approx(2 * np.pi * HERTZ)
    levels = rows_of(out / "levels.csv")
    for word, total in (("seconds", 140.3), ("turns", 140.3 * HERTZ)):
        amounts = [float(r["amount"]) for r in levels if (r["channel"], r["of"]) == ("Mx", word)]
        assert sum(amounts) == pytest.approx(total)
    sorted_by = rows_of(out / "wind_and_turbulence.csv")
    assert {row["wind [m/s]"] for row in sorted_by} == {"8", "12"}
    assert sum(int(row["windows"]) for row in sorted_by if row["channel"] == "Mx") == 2
    site = rows_of(out / "site.csv")
    assert [float(row["mean wind speed [m/s]"]) for row in site] == [8.0, 12.0]
    reach = np.exp(-np.pi / 4 * (np.array([6.0, 14.0]) / 8.5) ** 2)  # Rayleigh's, of 6 to 14 m/s
    hours = sum(float(row["hours"]) for row in site)
    assert hours == pytest.approx(-float(np.diff(reach)[0]) * 175200, rel=1e-6)
    results = read_results(out / "results.json")
    first = results.answers[0]
    assert first.quantity.startswith("equivalent load of My, slope 3")
    my = [r for r in equivalent if (r["channel"], r["slope"]) == ("My", "3")]
    of_b = float(next(r["DEL at 1 Hz"] for r in my if r["file"] == "b"))
    damage = 60.05 * of_a["My", "3"] ** 3 + 80.25 * of_b**3
    assert first.computed == pytest.approx(1e-3 * (damage / 140.3) ** (1 / 3), rel=1e-4)  # kN m
    # were all cycles half ones, whole ones would do twice the damage
    assert first.band is not None
    assert 0.0 < first.band / first.computed < 2 ** (1 / 3) - 1
    assert results.answer is not None
    assert "equivalent load of My, slope 3" in results.answer.verdict
    assert results.figures["capture"]["windows"]
    # 9P is 2.25 Hz, and half the sampling rate of b is 2 Hz
    assert any("9P appears at 1.75 Hz" in note for note in results.notes)
    captions = [item.caption for s in results.sections for item in s.items if item.kind == "table"]
    multiples = next(s for s in captions if s.startswith("Amplitude at multiples"))
    table = next(
        item
        for s in results.sections
        for item in s.items
        if item.kind == "table" and item.caption == multiples
    )
    moment = next(row for row in table.rows if str(row[0]).startswith("My"))
    assert moment[2] == pytest.approx(300.0, rel=0.01)  # 3P
    assert moment[1] == pytest.approx(0.0, abs=1.0)  # 1P


def test_a_stopped_run_goes_on(
    invoke: Callable[..., Result], histories: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[str] = []
    # what is in files counts, and other tests have counted the same
    monkeypatch.setenv(CACHE_VARIABLE, str(histories.parent / "cache"))

    def counted(path: Path, *more: object) -> Recorded:
        read.append(path.name)
        if path.name == "b.csv" and len(read) == 2:
            raise KeyboardInterrupt
        return read_recorded(path, *more)  # type: ignore[arg-type]

    monkeypatch.setattr(load_reactions, "read_recorded", counted)
    command = ("loads", str(histories), "--out", str(histories.parent / "out"), *COLUMNS)
    status, _, err = invoke(*command)
    assert status == 130
    assert "run again with --resume" in err
    status, _, _ = invoke(*command, "--resume")
    assert (status, read) == (0, ["a.csv", "b.csv", "b.csv"])
    status, _, _ = invoke(*command, "--resume", "--slope", "5")  # other options: read again
    assert (status, read[3:]) == (0, ["a.csv", "b.csv"])


def test_what_is_kept_of_a_file_is_known_by_its_content(
    invoke: Callable[..., Result], histories: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not by its name, size and time, which a copy may have in common with another file."""
    read: list[str] = []
    monkeypatch.setenv(CACHE_VARIABLE, str(histories.parent / "cache"))

    def counted(path: Path, *more: object) -> Recorded:
        read.append(path.name)
        return read_recorded(path, *more)  # type: ignore[arg-type]

    monkeypatch.setattr(load_reactions, "read_recorded", counted)
    command = ("loads", str(histories), "--out", str(histories.parent / "out"), *COLUMNS)
    assert invoke(*command)[0] == 0
    file = histories / "b.csv"
    content, status = file.read_bytes(), file.stat()
    place = content.rindex(b"1")
    file.write_bytes(content[:place] + b"2" + content[place + 1 :])
    os.utime(file, ns=(status.st_atime_ns, status.st_mtime_ns))
    assert file.stat().st_size == status.st_size
    file.rename(histories / "a_moved.csv").rename(file)
    (histories / "a.csv").rename(histories / "moved.csv")
    assert invoke(*command, "--resume")[0] == 0
    assert read == ["a.csv", "b.csv", "b.csv"]


def test_a_digest_of_another_file_is_made_again_and_said(
    invoke: Callable[..., Result], histories: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache, out = histories.parent / "cache", histories.parent / "out"
    monkeypatch.setenv(CACHE_VARIABLE, str(cache))
    monkeypatch.setenv(VERBOSE_VARIABLE, "")
    command = ("loads", str(histories), "--out", str(out), *COLUMNS)
    assert invoke(*command)[0] == 0
    sound = read_results(out / "results.json").figures
    one, other = (cache / "load-digests").iterdir()
    content = one.read_bytes()
    one.write_bytes(other.read_bytes())
    status, _, err = invoke(*command, "--resume")
    assert (status, "made again" in err) == (0, False)
    assert one.read_bytes() == content
    one.write_bytes(other.read_bytes())
    status, _, err = invoke(*command, "--resume", "-v")
    assert status == 0
    assert err.count(f"fe-drivetrain: kept load-digests are made again: {one.name} of ") == 1
    assert "it is of something else" in err
    assert read_results(out / "results.json").figures == sound


def test_a_digest_of_another_form_is_made_again_and_said(
    invoke: Callable[..., Result], histories: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever an earlier program has kept under the same key."""
    out, cache = histories.parent / "out", Cache(histories.parent / "cache")
    monkeypatch.setenv(CACHE_VARIABLE, str(cache.folder))
    monkeypatch.setenv(VERBOSE_VARIABLE, "")
    command = ("loads", str(histories / "a.csv"), "--out", str(out), *COLUMNS)
    assert invoke(*command)[0] == 0
    sound = read_results(out / "results.json").figures
    channels = ChannelMap(channels={"wind speed": "Vhub", "rotor speed": "N"})
    content = LoadOptions(channels=channels).content(histories / "a.csv")
    kept = cache.load("load-digests", content)
    assert kept is not None
    del kept["hub/torque/turns"]
    cache.keep("load-digests", content, kept)
    status, _, err = invoke(*command, "--resume", "-v")
    assert status == 0
    assert "kept load-digests are made again" in err
    assert "it has another form, without an array 'hub/torque/turns'" in err
    assert read_results(out / "results.json").figures == sound
    status, _, err = invoke(*command, "--resume", "-v")
    assert (status, "made again" in err) == (0, False)


def test_the_study_finds_what_the_command_writes(
    invoke: Callable[..., Result], histories: Path
) -> None:
    out = histories.parent / "out"
    assert invoke("loads", str(histories), "--out", str(out), *COLUMNS, "--site", "IIB")[0] == 0
    files = [histories / "a.csv", histories / "b.csv"]
    channels = ChannelMap(channels={"wind speed": "Vhub", "rotor speed": "N"})
    options = LoadOptions(channels=channels)
    found = loads(files, options, site=site_of_class("IIB"))
    results = read_results(out / "results.json")
    assert results.details == list(found.details)
    assert results.answers == list(found.figures)
    assert results.figures == found.to_dict()["tables"]
    for name, rows in found.file_tables().items():
        written = rows_of(out / f"{name}.csv")
        assert len(written) == len(rows), name
        for row, cells in zip(rows, written, strict=True):
            for key, value in row.items():
                if isinstance(value, float):
                    assert float(cells[key]) == pytest.approx(value, rel=1e-8), name


def test_another_set_is_compared_by_wind(invoke: Callable[..., Result], histories: Path) -> None:
    others = histories.parent / "others"
    others.mkdir()
    command = ("loads", str(histories), "--out", "out", *COLUMNS, "--against", str(others))
    write_history(others / "c.csv", 70.1, 0.1, 8.0)
    status, _, err = invoke(*command)
    assert status == 2
    assert "three or more together" in err
    write_history(others / "d.csv", 65.1, 0.1, 8.0)
    status, printed, _ = invoke(*command)
    assert status == 0
    assert " quantities differ between these files and the others " in printed.splitlines()[0]
    rows = rows_of(histories.parent / "out" / "beside.csv")
    assert {row["wind"] for row in rows} == {"8 m/s"}
    (torque,) = [row for row in rows if row["quantity"] == "Mx, max [kN m]"]
    assert float(torque["these files"]) == pytest.approx(float(torque["the others"]))


def test_reactions_of_a_scene_are_shown_and_compared(
    invoke: Callable[..., Result], histories: Path
) -> None:
    out = histories.parent / "out"
    others = histories.parent / "others"
    others.mkdir()
    for name in "cd":
        write_history(others / f"{name}.csv", 70.1, 0.1, 8.0)
    status, printed, err = invoke(
        *("loads", str(histories), "--out", str(out), *COLUMNS, "--against", str(others)),
        *("--scene", "main_bearing_spherical"),
    )
    assert status == 0, err
    rows = {row["reaction"]: row for row in rows_of(out / "reactions.csv")}
    # the bearing takes the whole thrust, and the torque goes on to the gearbox
    assert float(rows["main_bearing, Fx [kN]"]["mean"]) == pytest.approx(200.0, rel=1e-6)
    assert "main_bearing, Mx [kN m]" not in rows
    assert float(rows["gearbox, Mx [kN m]"]["mean"]) == pytest.approx(900.0, rel=1e-3)
    three = float(rows["main_bearing, Fz [kN]"]["3P"])
    assert float(rows["gearbox, Fz [kN]"]["3P"]) == pytest.approx(three, rel=1e-3)  # one couple
    compared = {row["quantity"] for row in rows_of(out / "beside.csv")}
    assert {"My, 3P [kN m]", "main_bearing: Fz, DEL of m = 4 at 1 Hz [kN]"} <= compared
    assert "main_bearing: loops of force, share of time [%]" in compared
    assert " quantities differ between these files and the others " in printed.splitlines()[0]
    status, _, err = invoke("loads", str(histories), "--scene", "bonded", "--level", "3")
    assert status == 2
    assert "choose 1, a beam, or 4" in err


def test_any_other_channel_has_statistics_in_its_own_unit(
    invoke: Callable[..., Result], histories: Path
) -> None:
    out, others = histories.parent / "out", histories.parent / "others"
    others.mkdir()
    for name in "cd":
        write_history(others / f"{name}.csv", 70.1, 0.1, 8.0)
    command = ("loads", str(histories), "--out", str(out), *COLUMNS, "--also", "vhub")
    status, _, err = invoke(*command, "--also", "N", "--against", str(others))
    assert status == 0, err
    rows = {row["channel"]: row for row in rows_of(out / "other_channels.csv")}
    assert float(rows["N [rpm]"]["mean"]) == pytest.approx(60.0 * HERTZ)
    assert float(rows["N [rpm]"]["DEL, m = 3"]) == 0.0
    wind = rows["Vhub [m/s]"]
    assert float(wind["min"]) == pytest.approx(7.0, abs=0.01)
    # 0.3 rad/s and a range of 2 m/s
    assert float(wind["DEL, m = 3"]) == pytest.approx(2.0 * (0.3 / 2 / np.pi) ** (1 / 3), rel=0.05)
    windows = rows_of(out / "other_windows.csv")
    assert {row["file"] for row in windows} == {"a", "b"}
    compared = {row["quantity"]: row for row in rows_of(out / "beside.csv")}
    assert float(compared["N [rpm], mean"]["these files"]) == pytest.approx(60.0 * HERTZ)
    status, _, err = invoke(*command, "--also", "Q")
    assert status == 2
    assert "there is no channel 'Q'" in err


def test_reactions_balance_hub_loads_and_weights(rng: np.random.Generator) -> None:
    found = scene_reactions(library_scene("main_bearing_bonded"), 1)
    loads = 1e5 * rng.standard_normal((50, 6))
    history = LoadHistory("random", np.arange(50.0), loads)
    forces = sum(reaction[:, :3] for reaction in found.of(history).values()) - loads[:, :3]
    weights = forces.mean(axis=0)
    np.testing.assert_allclose(forces, np.broadcast_to(weights, (50, 3)), atol=1e-2)
    assert weights[2] < -100e3
    np.testing.assert_allclose(weights[:2], 0.0, atol=1e-2)


def test_files_together_are_what_they_are_apart(rng: np.random.Generator) -> None:
    options = LoadOptions(slopes=(3.0,), rotor_speed_rpm=45.0 / np.pi)
    walk = 1e5 * rng.standard_normal((2400, 6)).cumsum(axis=0)
    parts = [walk[:1200], walk[1200:]]
    sums, first = LoadSums(), LoadSums()
    for k, part in enumerate(parts):
        history = LoadHistory(str(k), np.arange(1200) * 0.1, part)
        sums.add(str(k), digest(Recorded(history), options))
    together = sums.totals()
    np.testing.assert_allclose(
        together.statistics.overall[:6],
        np.column_stack([walk.min(0), walk.mean(0), walk.max(0), walk.std(0)]),
    )
    one = digest(Recorded(LoadHistory("0", np.arange(1200) * 0.1, parts[0])), options)
    first.add("0", one)
    single = first.totals()
    assert (together.cycles.damage >= single.cycles.damage).all()
    np.testing.assert_allclose(together.damages.sum(axis=0), together.cycles.damage)
    assert together.levels.turns["Mx"].amount.sum() == pytest.approx(240.0 * 1.5 / 2 / np.pi)


def test_statistics_of_a_wave_are_those_of_a_sine() -> None:
    time, samples = np.arange(3000) * 0.1, np.zeros((3000, 6))
    samples[:, 4] = 1e3 * np.sin(2.0 * np.pi * time / 10.0)
    sums = LoadSums()
    sums.add("wave", digest(Recorded(LoadHistory("wave", time, samples)), LoadOptions()))
    statistics = sums.totals().statistics
    rows = {row["channel"]: row for row in channel_rows(statistics)}
    found = rows["My [kN m]"]
    assert list(found.values())[1:] == pytest.approx([-1.0, 0.0, 1.0, np.sqrt(0.5)], abs=1e-6)
    assert not [name for name in rows if name.startswith(("wind speed", "rotor speed"))]
    assert wind_rows(statistics) == bending_rows(statistics) == []


def test_mistakes_are_one_sentence(invoke: Callable[..., Result], histories: Path) -> None:
    for arguments, said in (
        (["--channel", "torque=Q"], "NAME one of time, Fx"),
        (["--channel", "wind speed=Q"], "there is no channel 'Q'; it has time, Fx"),
        (["--residue", "full"], "choose one of half, closed, repeated"),
        (["--gate", "150%"], "from 0 to below 1"),
        (["--skip", "100"], "skip less"),
        (["--site", "VII"], "choose I, II, III"),
        (["--slope", "50"], "must be from 1 to 20"),
        (["--ultimate", "My=3 kN"], "as in 'My=25 MNm'"),
        (["--ultimate", "My=2 kNm"], "give the load that breaks the part"),
        (["--winds", "24:4"], "as in 4:24"),
        (["--transient", "a.csv=3"], "give --site, too"),
        (["--transient", "a.csv=often", "--site", "I"], "as in 'stops/*.outb=700'"),
    ):
        status, _, err = invoke("loads", str(histories), *arguments)
        assert status == 2, arguments
        assert said in err


def test_a_site_needs_the_winds_of_all_files(
    invoke: Callable[..., Result], histories: Path
) -> None:
    """It weights files by their winds, in `loads` as in `life`; nothing is written otherwise."""
    out = histories.parent / "out"
    calm = histories.parent / "calm.csv"  # without a wind speed
    calm.write_text(
        "\n".join(line.rsplit(",", 2)[0] for line in (histories / "a.csv").read_text().splitlines())
    )
    for files, channels, said in (
        ([histories], [], f"{histories / 'a.csv'}': there is no wind speed, by which --site"),
        (
            [histories / "a.csv"],
            COLUMNS,
            "the one file has a mean wind of 8 m/s: give files of two",
        ),
        ([histories / "a.csv", calm], [], "there is no wind speed"),
    ):
        words = ("--site", "IIB", "--rotor-speed", "15", *channels, "--out", str(out))
        status, _, err = invoke("loads", *map(str, files), *words)
        assert status == 2, said
        assert said in err
        assert not out.exists()


def test_a_lifetime_has_the_hours_of_its_winds_and_the_events_of_its_years(
    invoke: Callable[..., Result], histories: Path
) -> None:
    out = histories.parent / "out"
    write_history(histories.parent / "stop.csv", 30.05, 0.05, 9.0)
    more = ("--site", "9", "--shape", "2.2", "--years", "25", "--winds", "4:14", "--target", "2")
    events = ("--transient", f"{histories.parent}/stop.csv=700", "--ultimate", "My=5 MN m")
    command = ("loads", str(histories), "--out", str(out), *COLUMNS, "--frequency", "2")
    status, _, err = invoke(*command, *more, *events)
    assert status == 0, err
    missing = "Capture matrix: 20 windows are missing at 11 of 11 wind speeds."
    assert missing in read_results(out / "results.json").details
    hours = sum(float(row["hours"]) for row in rows_of(out / "site.csv"))
    levels = rows_of(out / "lifetime_levels.csv")
    of_torque = [r for r in levels if r["channel"] == "Mx" and r["of"] == "hours [h]"]
    with_stops = hours + 25 * 700 * 30.05 / 3600
    assert sum(float(r["amount"]) for r in of_torque) == pytest.approx(with_stops)
    shares = rows_of(out / "lifetime_damage.csv")
    own = [r for r in shares if (r["channel"], r["slope"]) == ("Mx", "4")]
    assert {r["from"] for r in own} == {"8 m/s", "12 m/s", "stop"}
    assert sum(float(r["share of damage [%]"]) for r in own) == pytest.approx(100.0)
    figures = read_results(out / "results.json").figures
    about_zero, as_counted = (
        next(r for r in figures[name] if (r["channel"], r["slope"]) == ("My", 4.0))["DEL at 2 Hz"]
        for name in ("equivalent_loads_about_zero", "equivalent_loads")
    )
    # cycles of a range of 600 kN m about 100: Goodman's factor is 5000 / 4900
    assert about_zero / as_counted == pytest.approx(50.0 / 49.0, rel=1e-3)
    equivalent = rows_of(out / "equivalent_loads.csv")
    my = next(r for r in equivalent if (r["file"], r["channel"], r["slope"]) == ("a", "My", "3"))
    assert float(my["DEL at 2 Hz"]) == pytest.approx(600e3 * (0.75 / 2.0) ** (1 / 3), rel=0.02)


def test_parquet_without_its_package_is_one_sentence(
    invoke: Callable[..., Result], histories: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pyarrow.parquet", None)
    status, _, err = invoke("loads", str(histories), "--parquet")
    assert status == 2
    assert "pip install 'fe-drivetrain[parquet]'" in err


@pytest.mark.needs("pyarrow")
def test_parquet_holds_what_the_csv_holds(tmp_path: Path) -> None:
    import pyarrow.parquet

    rows = [{"file": "a", "value": 1.5}, {"file": "b", "value": None}]
    write_tables(tmp_path, {"t": rows, "none": []}, {"t": {"unit": "N"}}, pyarrow.parquet)
    table = pyarrow.parquet.read_table(tmp_path / "t.parquet")
    assert table.to_pylist() == rows
    assert table.schema.metadata[b"unit"] == b"N"
    assert not (tmp_path / "none.csv").exists()


def test_loads_under_other_names_are_read(tmp_path: Path) -> None:
    file = tmp_path / "own.csv"
    file.write_text(
        "t [s],a [kN],b [N],c [N],d [N m],e [N m],f [N m]\n"
        + "".join(f"{k},{k},2,3,4,5,{k * k}\n" for k in range(5))
    )
    names = dict(zip(("time", *FORCES), "tabcdef", strict=True))
    mapped = ChannelMap(channels=names)
    found = read_recorded(file, mapped).history
    assert found.loads[:, 0].tolist() == [0.0, 1e3, 2e3, 3e3, 4e3]
    assert found.loads[2, 1:].tolist() == [2.0, 3.0, 4.0, 5.0, 4.0]
    twice = tmp_path / "twice.csv"
    twice.write_text(file.read_text().replace("f [N m]", "f [N m],a [kN]").replace("\n", ",9\n"))
    assert read_recorded(twice, mapped).history.loads[1, 0] == 1e3  # the first of that name
    file.write_text(file.read_text().replace("\n3,3", "\n3,three"))
    with pytest.raises(InputError, match="line 5, column a: 'three' is not a number: correct it"):
        read_recorded(file, mapped)
