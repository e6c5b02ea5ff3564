"""What a validation case is, and how the cases of the package are found."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import json
import pkgutil
import re
import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.near_words import did_you_mean

if TYPE_CHECKING:
    from fe_drivetrain.report.results import PageLink, Results
    from fe_drivetrain.report.suite.page import Page
    from fe_drivetrain.report.suite.run import Run

QUICK = (
    "Quick run: coarser and smaller than the case, for a first look; its figures and bands are not "
    "those of the case."
)
BESIDE_OTHERS = (
    "Its times, and the memory of its process, are for a first look, too: other cases may have run "
    "at the same time, or before in that process."
)


@dataclass(frozen=True)
class Case:
    """A validation case: it describes, runs and judges.

    Attributes
    ----------
    name : str
        "GROUP/NAME", as under ``cases/``.
    title : str
        One line.
    source : str
        Where the problem and its reference come from.
    run : callable
        Does the work: takes a `Run` and fills a `Page`.
    alone : bool or "full"
        It measures time or memory: nothing may run beside it, and nothing it uses comes from the
        cache. "full" where no check of its quick form depends on time: that may run beside others.
    settings : mapping or tuple of str
        Keys of ``--set`` that are the case's own, and of each what it is where nobody sets it, in
        the words that ``--help`` shows after it.
    changes : str
        What its other keys change: "scene", or a kind of component, as in "planet_carrier"; empty
        where it takes no others.
    command : str
        What to type to run it again; that of ``fe-drivetrain run`` where left out.
    links : tuple of PageLink
        Pages that belong to that of a dossier.
    """

    name: str
    title: str
    source: str
    run: Callable[[Run, Page], None]
    alone: bool | Literal["full"] = False
    settings: Mapping[str, str] | tuple[str, ...] = ()
    changes: str = ""
    command: str = ""
    links: tuple[PageLink, ...] = ()

    def runs_alone(self, quick: bool) -> bool:
        """Whether nothing may run beside its quick form, or beside its full one."""
        return self.alone is True or (self.alone == "full" and not quick)

    def results(self, run: Run) -> Results:
        """Run the case; what it found."""
        from fe_drivetrain.report.environment import environment
        from fe_drivetrain.report.results import Results
        from fe_drivetrain.report.seal import sealed
        from fe_drivetrain.report.suite.page import Page

        page = Page()
        self.run(run, page)
        if page.answered is None:
            raise RuntimeError(f"case {self.name} has no answer: call `page.answer` in its work")
        found = Results(
            case=self.name,
            title=f"{page.subject}: {page.topic or self.title}" if page.subject else self.title,
            source=self.source,
            notes=[
                *self._of_quick_runs(run.quick),
                *page.notes,
                *(f"Not checked: {one}." for one in page.skipped),
            ],
            unsettled=page.unsettled,
            answer=page.answered,
            details=page.sentences,
            answers=page.figures,
            verdicts=page.checks,
            sections=page.sections,
            limits=page.limits,
            assumptions=page.assumptions,
            times=run.times,
            figures=page.tables,
            scene=page.scene,
            drivetrains=page.drivetrains,
            links=list(self.links),
            skipped=page.skipped,
            environment=environment(
                run.settings, page.seed, run.quick, self.command or self._typed(run)
            ),
        )
        return sealed(found)

    def _of_quick_runs(self, quick: bool) -> list[str]:
        beside = self.alone and not self.runs_alone(quick)
        return [*([QUICK] if quick else []), *([BESIDE_OTHERS] if beside else [])]

    def _typed(self, run: Run) -> str:
        """What runs it with the same settings."""
        values = (
            f"{key}={value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)}"
            for key, value in run.settings.items()
        )
        sets = (word for value in values for word in ("--set", value))
        quick = ["--quick"] if run.quick else []
        return shlex.join(["fe-drivetrain", "run", self.name, *quick, *sets])


def all_cases() -> dict[str, Case]:
    """Every case by name, in order.

    What a script declares is read from its source: importing all of them, and the solvers with
    them, would take many times as long as a list may.
    """
    return dict(_found())


@cache
def _found() -> Mapping[str, Case]:
    """All cases, read once: a run of many cases asks for them around each."""
    package = "fe_drivetrain.cases"  # found by its name: the suite does not build on the cases
    spec = importlib.util.find_spec(package)
    places = list(spec.submodule_search_locations or ()) if spec else []
    found: dict[str, Case] = {}
    for info in pkgutil.walk_packages(places, package + "."):
        if not info.ispkg:
            for case in _declared_in(info.name):
                found[case.name] = case
    return dict(sorted(found.items()))


_DECLARATION = re.compile(r"^@(cases?)\((.*?)\)\ndef (\w+)\(", re.MULTILINE | re.DOTALL)


def _declared_in(module: str) -> list[Case]:
    """The cases that a module declares, without importing it."""
    spec = importlib.util.find_spec(module)
    if spec is None or spec.origin is None:
        return []
    file = Path(spec.origin)
    declaration = _DECLARATION.search(file.read_text(encoding="utf-8"))
    if declaration is None:
        return []
    kind, call, function = declaration.groups()
    *_, group, script = module.split(".")
    arguments = ast.parse(f"f({call})", mode="eval").body
    assert isinstance(arguments, ast.Call)
    (first,) = [ast.literal_eval(value) for value in arguments.args]
    named = {str(key.arg): ast.literal_eval(key.value) for key in arguments.keywords}
    if kind == "case":
        run = partial(_run_declared, module, function)
        name = named.pop("name", script)
        return [Case(f"{group}/{name}", first, run=run, **named)]
    import yaml

    from fe_drivetrain.common.strict_yaml import PlainLoader

    rows = yaml.load(file.with_name(first).read_text(encoding="utf-8"), Loader=PlainLoader)
    return [
        Case(
            f"{group}/{key}",
            row["title"],
            row["source"],
            partial(_run_declared, module, function, row=row),
            row.get("alone", False),
            **named,
        )
        for key, row in rows.items()
    ]


def _run_declared(module: str, function: str, run: Run, page: Page, **more: Any) -> None:
    getattr(importlib.import_module(module), function)(run, page, **more)


def find_cases(name: str) -> list[Case]:
    """The case of that name, its last part being enough where it is unique; or a group's cases.

    Raises
    ------
    InputError
        There is none, or there are several.
    """
    cases = all_cases()
    group = [c for full, c in cases.items() if full.partition("/")[0] == name]
    if group:
        return group
    matches = [c for full, c in cases.items() if name in (full, full.rpartition("/")[2])]
    if len(matches) > 1:
        known = ", ".join(match.name for match in matches)
        raise InputError(f"case {name!r} is ambiguous: use one of {known}")
    if not matches:
        groups = {full.partition("/")[0] for full in cases}
        near = did_you_mean(name, [*cases, *sorted(groups)]) or "none is like it;"
        raise InputError(f"case {name!r} is unknown: {near} fe-drivetrain list shows all")
    return matches
