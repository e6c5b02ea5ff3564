"""The pages of a folder of many cases: a row for each case, one for each check, and the atlas."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.regular_files import text_of
from fe_drivetrain.report.headline import answer_sentence, headline
from fe_drivetrain.report.history import Point, points_over_runs
from fe_drivetrain.report.number_text import value_with_band
from fe_drivetrain.report.rendering import policy_hash, read_template, templates
from fe_drivetrain.report.results import (
    Figure,
    Limit,
    Problem,
    Results,
    Verdict,
    bias_and_scatter,
    read_results,
    results_below,
    share_of_tolerance,
    verdict_sentence,
)
from fe_drivetrain.report.sealed import clear_of_others, remove_sealed, write_sealed
from fe_drivetrain.report.trend import change_text, sparkline

WORDS = {
    "fail": "FAIL",
    "failed": "no result",
    "not run": "not run",
    "running": "running",
    "planned": "planned",
    "skipped": "skipped",
    "unsettled": "open",
    "refuted": "refuted",
    "in part": "in part",
    "beyond": "beyond",
    "near": "near",
    "pass": "pass",
}
"""Verdicts of cases, worst first, as the page prints them. After "open" all checks pass, but a
statement of the source does not hold, or not wholly, or a key figure is beyond a limit or near."""

_PASSING = ("refuted", "in part", "beyond", "near", "pass")
_KEY_FIGURES = 3  # of a case, in its row
_OPEN = ("not run", "running", "planned")

PROBLEMS = "problems.json"
"""Beside the pages: why cases have no results, for who writes the pages next."""

_MAXIMUM = 1e9  # share of a tolerance, as the page sorts it


@dataclass(frozen=True)
class Row:
    """A case as the index lists it.

    Attributes
    ----------
    name : str
        "GROUP/NAME".
    state : str
        Key of `WORDS`.
    problem : str
        Why there are no results; empty where there are.
    results : Results or None
        What was found.
    worst : Verdict or None
        The check that uses up most of what it allows.
    answer : Figure, Verdict or None
        The value that answers what was asked.
    points : sequence of Point
        Its quantity over the runs so far.
    checks : sequence of (Verdict, Markup)
        Every check, and its row of the page of checks from the first cell's content on.
    """

    name: str
    state: str
    problem: str = ""
    results: Results | None = None
    worst: Verdict | None = None
    answer: Figure | Verdict | None = None
    points: Sequence[Point] = ()
    checks: Sequence[tuple[Verdict, Markup]] = ()

    @property
    def group(self) -> str:
        """Folder of the case."""
        return self.name.partition("/")[0]

    @property
    def quick(self) -> bool:
        """Whether the run was coarser and smaller."""
        return self.results is not None and self.results.environment.quick

    @property
    def badness(self) -> tuple[int, float]:
        """Sorts rows worst first."""
        share = share_of_tolerance(self.worst) if self.worst else 0.0
        return list(WORDS).index(self.state), -share


def write_index(
    folder: Path, problems: Mapping[str, Problem] | None = None, known: Iterable[str] = ()
) -> Path:
    """Write the pages of all results below a folder.

    index.html has a row for each case, worst first; checks.html beside it one for each check;
    where there are limits of methods among them, atlas.html lists these.

    Parameters
    ----------
    folder : Path
        Holds GROUP/NAME/results.json of any number of cases.
    problems : Mapping[str, Problem] or None
        Why a case has no results now, or none of this run, by its name; it is listed with that.
    known : Iterable[str]
        Names of all cases of the program: those that are not in the folder are named apart.

    Returns
    -------
    page
        Path of index.html in the same folder; each page appears whole or not at all.
    """
    folder = Path(folder)
    rows = sorted(_rows(folder, problems or {}), key=lambda row: (row.badness, row.name))
    _keep_problems(folder, problems or {})
    limits = _limits(rows)
    here = {row.name for row in rows}
    # a folder of commands alone lacks no case
    missing = set(known) - here if here & set(known) else set()
    _write_list(folder, rows, missing, bool(limits))
    checks = [check for row in rows for check in row.checks]
    checks.sort(key=lambda check: (check[0].passed, -share_of_tolerance(check[0])))
    _write(folder / "checks.html", "checks.html", checks=checks)
    if limits:
        _write(
            folder / "atlas.html",
            "atlas.html",
            limits=[limit for limit, _ in limits],
            pages=[name for _, name in limits],
            quick=sorted({name for _, name in limits} & {row.name for row in rows if row.quick}),
        )
    else:
        remove_sealed(folder / "atlas.html")
    return folder / "index.html"


def _limits(rows: Iterable[Row]) -> list[tuple[Limit, str]]:
    """Limits of methods, each with the case that found it, by the cases' names."""
    return [
        (limit, row.name)
        for row in sorted(rows, key=lambda row: row.name)
        if row.results
        for limit in row.results.limits
    ]


def _write_list(
    folder: Path, rows: Sequence[Row], missing: Collection[str], has_atlas: bool
) -> None:
    """Write index.html: a row for each case, and the names of those that are not there."""
    verdicts = [v for row in rows if row.results for v in row.results.verdicts]
    states = Counter(row.state for row in rows)
    _write(
        folder / "index.html",
        "index.html",
        rows=rows,
        missing=sorted(missing),
        words=WORDS,
        states={state: states[state] for state in WORDS if states[state]},
        groups=_by_group(rows),
        quick=sum(row.quick for row in rows),
        unfinished=sum(states[state] for state in _OPEN),
        passed=sum(states[state] for state in _PASSING),
        standing=_standing_of_all(states),
        total=len(rows) - states["skipped"],
        verdicts=verdicts,
        statistics=bias_and_scatter(verdicts),
        has_atlas=has_atlas,
        most_figures=_KEY_FIGURES,
    )


def _by_group(rows: Iterable[Row]) -> dict[str, Counter[str]]:
    """How many cases of each group are in each state, worst first."""
    rows = list(rows)
    groups = {name: Counter[str]() for name in sorted({row.group for row in rows})}
    for state in WORDS:
        for row in rows:
            if row.state == state:
                groups[row.group][state] += 1
    return groups


def _standing_of_all(states: Mapping[str, int]) -> str:
    """The colour of all cases together: that a run goes on is no failure."""
    found = {state for state in states if states[state]}
    if found & {"fail", "failed", "not run"}:
        return "fail"
    if found & {"running", "planned"}:
        return "running"
    return "pass" if found <= {"pass", "skipped"} else "unsettled"


def problems_before(folder: Path) -> dict[str, Problem]:
    """Why cases had no results when the pages of a folder were last written.

    Parameters
    ----------
    folder : Path
        As in `write_index`.

    Returns
    -------
    dict
        By the name of the case; empty where nothing is known.
    """
    try:
        found = json.loads(text_of(folder / PROBLEMS))
        return {name: Problem(**said) for name, said in found.items() if said["state"] in WORDS}
    except (OSError, ValueError, TypeError, KeyError, AttributeError):  # none, or none of ours
        return {}


def _keep_problems(folder: Path, problems: Mapping[str, Problem]) -> None:
    if not problems:
        if problems_before(folder):
            (folder / PROBLEMS).unlink(missing_ok=True)
        return
    clear_of_others(folder / PROBLEMS, lambda file: bool(problems_before(file.parent)))
    with atomic_path(folder / PROBLEMS) as unfinished:
        said = {name: problem._asdict() for name, problem in problems.items()}
        unfinished.write_text(json.dumps(said, indent=1), encoding="utf-8")


def _rows(folder: Path, problems: Mapping[str, Problem]) -> Sequence[Row]:
    rows = [Row(name, p.state, problem=p.message) for name, p in problems.items()]
    for name, file in results_below(folder).items():
        if name in problems:
            continue
        try:
            status = file.stat()
            of_file = file, status.st_mtime_ns, status.st_size, status.st_ino
            results, checks = _read(*of_file), _checks(name, *of_file)
        except (OSError, ValueError):  # of another version, say
            problem = "its results.json cannot be read: run it again"
            rows.append(Row(name, "failed", problem=problem))
            continue
        worst = max(results.verdicts, key=share_of_tolerance, default=None)
        state = _state(results)
        answer = headline(results)
        points = points_over_runs(folder, results, answer) if answer else []
        rows.append(Row(name, state, "", results, worst, answer, points, checks))
    return rows


def _state(results: Results) -> str:
    """Key of `WORDS` of results."""
    if not results.passed:
        return "fail"
    if results.unsettled:
        return "unsettled"
    if results.answer is None:
        return "pass"
    claims = {"does not hold": "refuted", "holds in part": "in part"}
    statuses = {"bad": "beyond", "watch": "near"}
    return claims.get(results.answer.claim) or statuses.get(results.answer.status, "pass")


@lru_cache(maxsize=1024)
def _read(file: Path, *_state: int) -> Results:
    """Results of a file, read once: a run of many cases writes its index after each of them."""
    return read_results(file)


@lru_cache(maxsize=1024)
def _checks(name: str, file: Path, *state: int) -> Sequence[tuple[Verdict, Markup]]:
    """Checks as `Row` has them, printed once: of some thousand checks few are new."""
    results = _read(file, *state)
    template, quick = _listings().get_template("check.html"), results.environment.quick
    return [
        (verdict, Markup(template.render(name=name, quick=quick, verdict=verdict)))
        for verdict in results.verdicts
    ]


def _write(page: Path, template: str, **content: Any) -> None:
    script = read_template("listing.js")
    found = _listings().get_template(template)
    write_sealed(page, found.render(script=script, script_hash=policy_hash(script), **content))


@lru_cache(maxsize=1)
def _listings() -> jinja2.Environment:
    environment = templates()
    environment.filters |= {
        "share": lambda verdict: min(share_of_tolerance(verdict), _MAXIMUM),
        "share_text": lambda share: f"{100 * share:.3g}\u00a0%" if share < _MAXIMUM else "∞",
        "answer": answer_sentence,
        "with_band": value_with_band,
        "verdict_of": verdict_sentence,
        "sparkline": sparkline,
        "change": change_text,
    }
    return environment
