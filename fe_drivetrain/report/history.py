"""The history of a folder of reports: every run with its checks, in one SQLite file.

The file is read with any SQLite, too: table ``runs`` has a row for each run of a case, ``checks``
one for each of its key figures, other values and checks, in the order of the page.
"""

from __future__ import annotations

import json
import math
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import file_to_write
from fe_drivetrain.report.headline import values_found
from fe_drivetrain.report.results import Environment, Figure, Results, Verdict, verdict_sentence

FILE = "history.sqlite"
"""Its name, beside the pages that share it."""

_WAIT = 60.0  # seconds for another run to finish its writing
_TABLES = """
CREATE TABLE IF NOT EXISTS runs (
    run INTEGER PRIMARY KEY,
    date TEXT NOT NULL,
    name TEXT NOT NULL,
    code TEXT NOT NULL,
    version TEXT NOT NULL,
    quick INTEGER NOT NULL,
    settings TEXT NOT NULL,
    headline INTEGER,
    checks INTEGER NOT NULL,
    failed INTEGER NOT NULL,
    seconds REAL NOT NULL,
    verdict TEXT NOT NULL DEFAULT '',
    status TEXT NOT NULL DEFAULT ''
);
CREATE TABLE IF NOT EXISTS checks (
    run INTEGER NOT NULL REFERENCES runs,
    place INTEGER NOT NULL,
    quantity TEXT NOT NULL,
    unit TEXT NOT NULL,
    computed REAL,
    band REAL,
    allowed REAL NOT NULL,
    passed INTEGER NOT NULL,
    PRIMARY KEY (run, place)
) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS runs_of_a_case ON runs (name, quick, settings);
"""

_ADDED = ("verdict", "status")
"""Columns of runs, with words, that files of older programs do not have."""


class Point(NamedTuple):
    """One quantity in one run.

    Attributes
    ----------
    date : str
        When the run began.
    code : str
        SHA-256 of the program's sources.
    computed : float
        The value; not a number where it was none.
    passed : bool
        Whether its check passed.
    allowed : float
        Error that the check tolerates, in the unit; 0 where that is relative to a reference.
    """

    date: str
    code: str
    computed: float
    passed: bool
    allowed: float = 0.0


class PastRun(NamedTuple):
    """A run of a case.

    Attributes
    ----------
    date : str
        When it ended.
    name : str
        "GROUP/NAME" of the case.
    code : str
        SHA-256 of the program's sources.
    version : str
        Of the program.
    quick : bool
        Whether it was coarser and smaller.
    settings : mapping
        Of the user.
    checks, failed : int
        How many checks there were, and how many of them failed.
    seconds : float
        Wall time of all steps.
    quantity, unit : str
        Of the check that answers what was asked; empty where there is none.
    computed, band : float or None
        Its value, and half width of the numerical uncertainty.
    allowed : float
        As in `Point`.
    verdict, status : str
        Those of the answer; empty of a run without one.
    """

    date: str
    name: str
    code: str
    version: str
    quick: bool
    settings: Mapping[str, Any]
    checks: int
    failed: int
    seconds: float
    quantity: str
    unit: str
    computed: float | None
    band: float | None
    allowed: float
    verdict: str = ""
    status: str = ""


def check_history(folder: Path) -> None:
    """Refuse a folder to whose history no run could be added, before any work.

    Parameters
    ----------
    folder : Path
        The folder of reports; it need not have a history.

    Raises
    ------
    InputError
        The file there is something else, or cannot be written.
    """
    if (folder / FILE).exists():
        file_to_write(folder / FILE)
        with _opened(folder):
            pass


def carry_history(before: Path, after: Path) -> None:
    """Copy the history of a result folder that is about to be replaced.

    Parameters
    ----------
    before : Path
        The folder; it need not have a history.
    after : Path
        What takes its place.

    Raises
    ------
    InputError
        As in `check_history`.
    """
    file = before / FILE
    while (number := _number(file)) is not None:
        try:
            # not as a file: what a killed run has left unfinished is taken back first
            with _opened(before) as source, _opened(after) as target:
                source.backup(target)
            return
        except InputError:
            # another run may have put its folder in place meanwhile: then that one's is copied
            if _number(file) == number:
                raise


def _number(file: Path) -> int | None:
    """That of its inode, which another file in its place has not; None where there is none."""
    try:
        return file.stat().st_ino
    except FileNotFoundError:
        return None


def record_run(folder: Path, results: Results) -> None:
    """Add a run to the history of a folder.

    Parameters
    ----------
    folder : Path
        The folder of reports.
    results : Results
        Of the run.

    Raises
    ------
    InputError
        As in `check_history`.
    """
    environment, found = results.environment, values_found(results)
    with _opened(folder) as database:
        cursor = database.execute(
            "INSERT INTO runs (date, name, code, version, quick, settings, headline, checks, "
            "failed, seconds, verdict, status) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
            (
                environment.date,
                results.case,
                environment.code,
                environment.versions.get("fe-drivetrain", ""),
                environment.quick,
                _settings(environment),
                0 if found else None,
                len(results.verdicts),
                sum(not verdict.passed for verdict in results.verdicts),
                sum(results.times.values()),
                verdict_sentence(results),
                results.answer.status if results.answer else "",
            ),
        )
        database.executemany(
            "INSERT INTO checks VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
            [
                (
                    cursor.lastrowid,
                    place,
                    v.quantity,
                    v.unit,
                    _finite(v.computed),
                    v.band,
                    tolerated(v),
                    not isinstance(v, Verdict) or v.passed,
                )
                for place, v in enumerate(found)
            ],
        )


def tolerated(found: Figure | Verdict) -> float:
    """The error that a check tolerates, in its unit; 0 where there is none or it is relative."""
    return found.tolerance if isinstance(found, Verdict) and not found.relative else 0.0


def points_over_runs(
    folder: Path, results: Results, found: Figure | Verdict, most: int = 40
) -> list[Point]:
    """One quantity of a case in the runs so far with the same settings in the same mode.

    Parameters
    ----------
    folder : Path
        The folder of reports.
    results : Results
        Of the case.
    found : Figure or Verdict
        The answer or check whose quantity it is.
    most : int
        How many of the last runs.

    Returns
    -------
    list of Point
        Oldest first; empty where there is no history.
    """
    if not (folder / FILE).is_file():
        return []
    environment = results.environment
    with _opened(folder) as database:
        rows = database.execute(
            "SELECT date, code, computed, passed, allowed FROM runs JOIN checks USING (run) "
            "WHERE name = ? AND quick = ? AND settings = ? AND quantity = ? AND unit = ? "
            "ORDER BY run DESC LIMIT ?",
            (
                results.case,
                environment.quick,
                _settings(environment),
                found.quantity,
                found.unit,
                most,
            ),
        ).fetchall()
    return [
        Point(date, code, math.nan if computed is None else computed, bool(passed), allowed)
        for date, code, computed, passed, allowed in reversed(rows)
    ]


def past_runs(folder: Path, name: str = "") -> list[PastRun]:
    """The runs of a folder, oldest first.

    Parameters
    ----------
    folder : Path
        The folder of reports.
    name : str
        A case, "GROUP/NAME"; empty for all.

    Returns
    -------
    list of PastRun

    Raises
    ------
    InputError
        There is no history.
    """
    if not (folder / FILE).is_file():
        raise InputError(f"{folder} has no {FILE}: run a case into it, or name another with --out")
    with _opened(folder) as database:
        rows = database.execute(
            "SELECT date, name, code, version, quick, settings, runs.checks, failed, seconds, "
            "coalesce(quantity, ''), coalesce(unit, ''), computed, band, coalesce(allowed, 0.0), "
            "verdict, status "
            "FROM runs LEFT JOIN checks ON checks.run = runs.run AND checks.place = runs.headline "
            "WHERE ? IN ('', name) ORDER BY runs.run",
            (name,),
        ).fetchall()
    return [PastRun._make([*row[:4], bool(row[4]), json.loads(row[5]), *row[6:]]) for row in rows]


def seconds_before(folder: Path, quick: bool) -> dict[str, float]:
    """How long cases took when they last ran in one of the two modes.

    Parameters
    ----------
    folder : Path
        The folder of reports; it need not have a history.
    quick : bool
        Whether the run was coarser and smaller.

    Returns
    -------
    dict
        Wall time of all steps by the name of the case [s].
    """
    if not (folder / FILE).is_file():
        return {}
    with _opened(folder) as database:
        rows = database.execute(
            "SELECT name, seconds FROM runs WHERE quick = ? ORDER BY run", (quick,)
        ).fetchall()
    return dict(rows)


@contextmanager
def _opened(folder: Path) -> Iterator[sqlite3.Connection]:
    """The database, closed at the end; what is written is written as a whole."""
    file = folder / FILE
    try:
        with closing(sqlite3.connect(file, timeout=_WAIT)) as database, database:
            _refuse_of_others(file, database)
            database.executescript(_TABLES)
            _add_columns(database)
            yield database
    except sqlite3.DatabaseError as error:
        # the extended codes of SQLite have the kind in their last byte
        code = getattr(error, "sqlite_errorcode", 0) & 0xFF
        if code in (sqlite3.SQLITE_IOERR, sqlite3.SQLITE_FULL):
            raise InputError(
                f"{file} cannot be read or written ({error}): see whether its disk is full"
            ) from error
        raise InputError(
            f"{file} cannot be used as history of the runs ({error}): move it away, and the next "
            "run begins another"
        ) from error


def _add_columns(database: sqlite3.Connection) -> None:
    """Give a file of an older program the columns that it does not have."""

    def missing() -> list[str]:
        known = {row[1] for row in database.execute("PRAGMA table_info(runs)")}
        return [name for name in _ADDED if name not in known]

    if not missing():
        return
    database.execute("BEGIN IMMEDIATE")  # another run may be at the same
    for name in missing():
        database.execute(f"ALTER TABLE runs ADD COLUMN {name} TEXT NOT NULL DEFAULT ''")
    database.execute("COMMIT")


def _refuse_of_others(file: Path, database: sqlite3.Connection) -> None:
    """Refuse a database in which another program has its tables."""
    names = {name for (name,) in database.execute("SELECT name FROM sqlite_master")}
    others = sorted(names - {"runs", "checks", "runs_of_a_case"})
    if others or (names and "runs" not in names):
        raise InputError(
            f"{file} is a database of another program, with {', '.join(others or names)}, and no "
            "history of runs: move it away, or name another folder with --out"
        )


def _settings(environment: Environment) -> str:
    return json.dumps(environment.settings, sort_keys=True, default=str)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
