"""The page of ``loads``: what is in anyone's histories, from statistics to load loops."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np

from fe_drivetrain.commands.loads_against import beside
from fe_drivetrain.commands.loads_counts import answer_of_counts, counts
from fe_drivetrain.commands.loads_digest import CHANNELS, LOADS, UNITS, Digest, Options
from fe_drivetrain.commands.loads_faults import faults
from fe_drivetrain.commands.loads_lifetime import Event, lifetime, mean_winds
from fe_drivetrain.commands.loads_reactions import (
    OF_REACTIONS,
    OTHER,
    SceneReactions,
    digest_with_reactions,
    others_section,
    parts,
    reactions_section,
)
from fe_drivetrain.commands.loads_shape import shape
from fe_drivetrain.commands.loads_tables import write_tables
from fe_drivetrain.commands.loads_together import Together, windows_table
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import mapped
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.histories.cycles import Cycles
from fe_drivetrain.histories.sites import WIND_BIN, Site, require_winds
from fe_drivetrain.histories.windows import COLUMNS, CaptureMatrix, capture_matrix
from fe_drivetrain.hub_loads.recorded import read_recorded
from fe_drivetrain.report.charts import trace
from fe_drivetrain.response.stated import Stated, stated_hub_loads
from fe_drivetrain.studies.unused import RPM, speed_not_used
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record
from fe_drivetrain.suite.run import Run

TURBULENCE_BIN = 0.02
"""Height of the capture matrix's rows; its columns are `WIND_BIN` wide, about whole m/s."""

_SHOWN = 20
_MOST_BINS = 60
_MANY = 8  # files for which it pays to start processes
_SCALE = {"N": (1e3, "kN"), "N m": (1e3, "kN\u00a0m"), "rad/s": (1.0, "rad/s"), "m/s": (1.0, "m/s")}
UNIT_OF = dict(zip(CHANNELS, UNITS, strict=True))


@dataclass(frozen=True)
class Target:
    """What the capture matrix should hold.

    Attributes
    ----------
    windows : int
        At each mean wind speed.
    low, high : float or None
        Least and largest mean wind speed that it should have [m/s]; those of the files where None.
    """

    windows: int
    low: float | None = None
    high: float | None = None


def loaded(
    run: Run,
    page: Page,
    files: Sequence[Path],
    options: Options,
    target: Target,
    site: Site | None = None,
    transients: Sequence[tuple[float, Sequence[Path]]] = (),
    against: Sequence[Path] = (),
    resume: bool = False,
    parquet: ModuleType | None = None,
    reactions: SceneReactions | None = None,
) -> None:
    """Read files one by one, add up what they hold, and show it.

    Parameters
    ----------
    run : Run
        Its folder takes the tables.
    page : Page
        Takes tables and charts.
    files : sequence of Path
        Histories, of any length and step.
    options : Options
        How they are counted.
    target : Target
        What the capture matrix should hold.
    site : Site, optional
        Whose winds a lifetime has.
    transients : sequence of (float, sequence of Path)
        Events of its lifetime: how many a year, and histories of one each.
    against : sequence of Path
        Another set of histories, to be compared.
    resume : bool
        Take digests that an earlier run kept.
    parquet : module, optional
        Writer of Parquet.
    reactions : SceneReactions, optional
        Of a scene, which are shown and compared, too.

    Raises
    ------
    InputError
        A file cannot be read, or holds no loads, or a site is given and files have no wind speed.
    """
    page.seed = None
    if reactions is not None:
        page.about(reactions.scene)
    every = {name: Together() for name in ("", *(reactions.names if reactions else ()))}
    found = every[""]
    own: list[Digest] = []
    with run.step("files"):
        for file, one in _digests(run, files, options, resume, "files", reactions):
            for name, part in parts(one).items():
                every.setdefault(name, Together()).add(_name(file, files), part)
            if against:
                own.append(one)
    _require_loads(found)
    if site is not None:
        require_winds(files, mean_winds(found))
    rule = Cycles(np.zeros(0), np.zeros(0), np.zeros(0), options.residue).rule
    if options.gate:
        rule += (
            f"; cycles of a range below {100 * options.gate:g} % of the largest of the channel in "
            "its file are left out"
        )
    said = answer_of_counts(page, found, options)
    page.answer(
        f"{said}{len(files)} file{'s' * (len(files) > 1)}, {found.samples:,} samples over "
        f"{found.seconds:,.6g} s; {rule}."
    )
    tables: dict[str, list[Record]] = {"files": found.files}
    faults(page, found, options)
    _channels(page, found, _at_hub(reactions))
    _statistics(page, found)
    tables["windows"] = windows_table(found, UNIT_OF)
    tables["wind_and_turbulence"] = _by_turbulence(found)
    tables["capture_matrix"] = _capture(page, found, target)
    tables |= shape(page, found)
    tables |= counts(page, found, options, rule)
    if reactions is not None:
        of_scene = {name: every[name] for name in reactions.names}
        tables |= reactions_section(page, of_scene, options, reactions, rule)
    others = {name: one for name, one in every.items() if name.startswith(OTHER)}
    tables |= others_section(page, others, options, rule)
    speeds = [*found.own_speeds]
    if site is not None:
        with run.step("transients"):
            events = [
                Event(a_year, [d for _, d in _digests(run, of, options, resume, "transients")], of)
                for a_year, of in transients
            ]
        tables |= lifetime(page, found, options, site, events)
        speeds += [one["own speeds"] for event in events for one in event.digests]
    if against:
        with run.step("the others"):
            made = _digests(run, against, options, resume, "the others", reactions)
            theirs = [d for _, d in made]
            tables["beside"] = beside(page, own, theirs, options)
            speeds += [one["own speeds"] for one in theirs]
    given = None if options.rotor_speed is None else options.rotor_speed * RPM
    if unused := speed_not_used(given, speeds):
        page.note(unused)
    _checks(page, found)
    facts = {
        "units": "N, N m, s, Hz, rad/s, m/s",
        "channels": " | ".join(found.read),
        "cycles": rule,
    }
    write_tables(run.folder, tables, _facts_of(tables, facts, reactions), parquet)
    page.section("Files")
    names = [name for name, rows in tables.items() if rows]
    page.text(
        f"Tables beside this page: {', '.join(f'{name}.csv' for name in names)}"
        + (", each as .parquet, too." if parquet else ".")
    )
    page.table(
        "Histories" + (f": the first {_SHOWN}" if len(files) > _SHOWN else ""),
        found.files[:_SHOWN],
    )
    page.text(
        "A file that has no wind speed or rotor speed under a known name leaves these cells empty: "
        "name its channels with --channel, as in --channel 'wind speed=Vhub'."
    )


def _at_hub(reactions: SceneReactions | None) -> Stated:
    return stated_hub_loads(None if reactions is None else reactions.scene)


def _facts_of(
    tables: Iterable[str], shared: Mapping[str, str], reactions: SceneReactions | None
) -> dict[str, Mapping[str, str]]:
    """Lines before each table, by its name: of hub loads, of reactions, or of other channels."""
    found: dict[str, Mapping[str, str]] = {}
    at_hub = _at_hub(reactions)
    for name in tables:
        if name.startswith("other_"):
            found[name] = {**shared, "units": "of channels, those of the files"}
        elif reactions is not None and name in OF_REACTIONS:
            found[name] = {**reactions.stated.facts(), **shared, "model": reactions.model.title}
        else:
            found[name] = {**at_hub.facts(), **shared}
    if reactions is not None and "beside" in found:
        of_reactions = {f"{k}, of reactions": v for k, v in reactions.stated.facts().items()}
        found["beside"] = {**found["beside"], **of_reactions}
    return found


def _digests(
    run: Run,
    files: Sequence[Path],
    options: Options,
    resume: bool,
    step: str,
    reactions: SceneReactions | None = None,
) -> Iterator[tuple[Path, Digest]]:
    """File by file, several at a time where there are cores; each kept as soon as it is done."""
    items = ((file, options, resume, reactions) for file in files)
    made = mapped(kept_digest, items, len(files) if len(files) >= _MANY else 1, run.report)
    for number, file in enumerate(files, 1):
        run.report(f"{step} ({number} of {len(files)})")
        yield file, next(made)


def kept_digest(
    _report: Progress,
    file: Path,
    options: Options,
    resume: bool,
    reactions: SceneReactions | None = None,
) -> Digest:
    """The digest of a file, or that of an earlier run where it is kept and asked for.

    Parameters
    ----------
    _report : callable
        Of a job in a process; what takes this long shows no steps.
    file : Path
        With the history.
    options : Options
        How it is counted.
    resume : bool
        Take what is kept.
    reactions : SceneReactions, optional
        Of a scene.
    """
    cache, content = user_cache(), options.content(file)
    if reactions is not None:
        content |= {"reactions": reactions.content()}
    kept: Digest | None = cache.load("load-digests", content) if resume else None
    if kept is not None:
        return kept
    recorded = read_recorded(file, options.names, options.skip, options.also)
    found = digest_with_reactions(recorded, options, reactions)
    cache.keep("load-digests", content, found)
    return found


def _channels(page: Page, found: Together, stated: Stated) -> None:
    """Frame and origin, and what was read."""
    page.section("Frame and channels")
    page.text(stated.sentences())
    page.table(
        "What the loads were read from",
        [
            {"channels": channels, "files": number}
            for channels, number in list(found.read.items())[:_SHOWN]
        ],
    )


def _require_loads(found: Together) -> None:
    """Refuse files that hold zeros alone."""
    if found.cycles is None or not found.cycles[:, 0].any():
        values = found.values[:, : len(LOADS)] if found.windows else np.zeros(1)
        if not np.abs(values).max() > 0.0:
            raise InputError("all hub loads of all files are zero: give histories with loads")


def _name(file: Path, files: Sequence[Path]) -> str:
    """Its stem, or its whole path where another has the same."""
    return str(file) if sum(other.stem == file.stem for other in files) > 1 else file.stem


def _statistics(page: Page, found: Together) -> None:
    page.section("Statistics")
    overall = found.overall()
    rows = [_row(name, values) for name, values in zip(CHANNELS, overall, strict=True)]
    page.table("All samples together", [row for row in rows if row is not None])
    page.data("statistics", dict(zip(CHANNELS, overall.tolist(), strict=True)))
    wind = found.values[:, CHANNELS.index("wind speed"), 1]
    if np.isnan(wind).all():
        return
    middle = WIND_BIN * np.round(wind / WIND_BIN)
    by_wind: list[Record] = []
    for speed in np.unique(middle[~np.isnan(middle)]).tolist():
        chosen = middle == speed
        values = found.overall(chosen)
        for name in ("Fx", "Mx", "radial force", "bending moment"):
            row = _row(name, values[CHANNELS.index(name)])
            if row is not None:
                by_wind.append({"wind [m/s]": speed, "windows": int(chosen.sum()), **row})
    page.table(f"By mean wind speed in {WIND_BIN:g} m/s", by_wind)
    _shown_turbulence(page, found)
    place = CHANNELS.index("bending moment")
    values = found.values[:, place] / 1e3
    page.chart(
        "Bending moment at the hub in each window of ten minutes",
        [trace(name, wind, values[:, k], points=True) for k, name in enumerate(COLUMNS[:3])],
        "mean wind speed [m/s]",
        "bending moment [kN m]",
    )


def _shown_turbulence(page: Page, found: Together) -> None:
    """The bending moment by wind and turbulence; all channels are in a file."""
    rows = [
        {
            "wind [m/s]": row["wind [m/s]"],
            "turbulence [%]": 100.0 * float(row["turbulence [-]"]),
            "windows": row["windows"],
            **{f"{name} [kN m]": float(row[name]) / 1e3 for name in COLUMNS},
        }
        for row in _by_turbulence(found)
        if row["channel"] == "bending moment"
    ]
    page.table(
        f"Bending moment by mean wind speed and turbulence intensity in {100 * TURBULENCE_BIN:g} "
        "%; every channel is in wind_and_turbulence.csv",
        rows[:_MOST_BINS],
    )


def _by_turbulence(found: Together) -> list[Record]:
    """Statistics of each channel by mean wind speed and turbulence intensity, for a file."""
    wind = found.values[:, CHANNELS.index("wind speed")]
    bins = np.column_stack(
        [
            WIND_BIN * np.round(wind[:, 1] / WIND_BIN),
            TURBULENCE_BIN * (np.floor(wind[:, 3] / wind[:, 1] / TURBULENCE_BIN) + 0.5),
        ]
    )
    rows: list[Record] = []
    for speed, turbulence in np.unique(bins[~np.isnan(bins).any(axis=1)], axis=0).tolist():
        chosen = (bins == [speed, turbulence]).all(axis=1)
        for name, values in zip(CHANNELS, found.overall(chosen), strict=True):
            if not np.isnan(values).any():
                rows.append(
                    {
                        "wind [m/s]": speed,
                        "turbulence [-]": turbulence,
                        "windows": int(chosen.sum()),
                        "channel": name,
                        "unit": UNIT_OF[name],
                        **dict(zip(COLUMNS, values.tolist(), strict=True)),
                    }
                )
    return rows


def _row(name: str, values: Sequence[float]) -> Record | None:
    if np.isnan(values).any():
        return None
    factor, unit = _SCALE[UNIT_OF[name]]
    shown = [float(v) / factor for v in values]
    return {"channel": f"{name} [{unit}]", **dict(zip(COLUMNS, shown, strict=True))}


def _capture(page: Page, found: Together, target: Target) -> list[Record]:
    """Windows by wind speed and turbulence."""
    page.section("Capture matrix")
    wind = found.values[:, CHANNELS.index("wind speed")]
    known = ~np.isnan(wind).any(axis=1)
    if not known.any():
        page.text("No file has a wind speed, so that windows cannot be sorted by it.")
        if target.low is not None:
            page.note(
                f"--winds {target.low:g}:{target.high:g} m/s is not used: no file has a wind "
                "speed. Name its channel, as in --channel 'wind speed=Vhub'."
            )
        return []
    mean, deviation = wind[known, 1], wind[known, 3]
    least = min(float(mean.min()), np.inf if target.low is None else target.low)
    highest = max(float(mean.max()), -np.inf if target.high is None else target.high)
    low = WIND_BIN * np.floor(least / WIND_BIN + 0.5) - 0.5 * WIND_BIN
    columns = np.arange(low, highest + WIND_BIN, WIND_BIN)
    most = float((deviation / mean).max())
    rows = TURBULENCE_BIN * np.arange(np.floor(most / TURBULENCE_BIN) + 2)
    matrix = capture_matrix(mean, deviation, columns, rows)
    sums = matrix.counts.sum(axis=0)
    middles = 0.5 * (columns[1:] + columns[:-1])
    asked = np.where(
        (middles >= (target.low or -np.inf)) & (middles <= (target.high or np.inf)),
        target.windows,
        0,
    )
    missing = np.maximum(asked - sums, 0)
    table = _matrix_rows(matrix, middles, missing)
    page.table(
        f"Windows by mean wind speed and turbulence intensity; {target.windows} of each wind speed "
        "are asked for (IEC 61400-1 asks for six ten-minute series; --target takes another number, "
        "--winds the range of wind speeds)",
        table,
    )
    if missing.any():
        page.answer(
            f"Capture matrix: {int(missing.sum())} windows are missing at "
            f"{int(np.count_nonzero(missing))} of {int(np.count_nonzero(asked))} wind speeds."
        )
    else:
        page.answer(f"Capture matrix: every wind speed has {target.windows} windows or more.")
    if (~known).any():
        page.text(f"{int((~known).sum())} windows have no wind speed.")
    page.data(
        "capture",
        {
            "wind": matrix.wind,
            "turbulence": matrix.turbulence,
            "counts": matrix.counts,
            "missing": missing,
        },
    )
    return table


def _matrix_rows(matrix: CaptureMatrix, middles: Floats, missing: Ints) -> list[Record]:
    """A row for each wind speed, without turbulence that no window has."""
    filled = np.flatnonzero(matrix.counts.any(axis=1)).tolist()
    limits = 100.0 * matrix.turbulence
    rows: list[Record] = []
    for c, middle in enumerate(middles.tolist()):
        row: Record = {"wind [m/s]": middle}
        for r in filled:
            row[f"{limits[r]:g} to {limits[r + 1]:g} %"] = int(matrix.counts[r, c])
        row |= {"all": int(matrix.counts[:, c].sum()), "missing": int(missing[c])}
        rows.append(row)
    return rows


def _checks(page: Page, found: Together) -> None:
    for what, names in (
        ("time at the levels", [f"time at {name}" for name in LOADS]),
        ("time in the planes of force and moment", ["plane of force", "plane of moment"]),
    ):
        worst = max(abs(found.classes[n].amount.sum() / found.seconds - 1.0) for n in names)
        page.vanishes(
            f"{what}, less that of all samples, as a share",
            worst,
            within=1e-9,
            why="each sample is in one class: rounding of the sums",
            source="number of samples times their step",
            basis="self-consistency",
        )
