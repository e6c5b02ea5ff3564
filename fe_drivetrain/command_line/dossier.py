"""A dossier: its parts are made side by side in processes, or in order where there is one core."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fe_drivetrain.command_line.dossier_works import dossier_works, main_reaction
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.terminal import as_typed
from fe_drivetrain.common.processes import Processes
from fe_drivetrain.common.progress import Progress

if TYPE_CHECKING:
    from fe_drivetrain.command_line.dossier_works import Work
    from fe_drivetrain.command_line.report_request import ReportRequest
    from fe_drivetrain.drivetrain_file.scene import Scene
    from fe_drivetrain.report.results import Results
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.studies.study_loads import StudyLoads

GROUP, OVERVIEW = "dossier", "overview"
TITLES: Mapping[str, str] = {
    OVERVIEW: "Overview",
    "loads": "Loads",
    "reactions": "Reactions",
    "life": "Life",
    "strength": "Shaft strength",
    "modes": "Modes",
    "gears": "Gears",
    "stop": "Emergency stop",
    "model": "Which model",
    "check": "The drivetrain",
    "export": "Export",
}
"""Parts of a dossier as its menu has them."""

PROCESSES = 2
"""Most processes side by side: the longest chain takes about half of the work of all."""

_CHAINS = (
    ("reactions", "model"),  # which takes the assembly that the other has solved
    ("stop",),
    ("life",),
    ("gears",),
    ("strength",),
    ("modes",),
    ("check",),
    ("loads",),
    ("export",),
)
"""Parts that follow one another in a process, those chains first that take longest."""


@dataclass(frozen=True)
class Dossier:
    """A dossier that is being made.

    Attributes
    ----------
    folder : Path
        Where it goes.
    asked : ReportRequest
        What was asked for.
    scene : Scene
        The drivetrain.
    names : tuple of str
        Its parts, in order.
    command : str
        What was typed.
    """

    folder: Path
    asked: ReportRequest
    scene: Scene
    names: tuple[str, ...]
    command: str

    def place(self, name: str) -> Path:
        """The folder of a part."""
        return self.folder / GROUP / name

    def case(self, name: str, work: Work, content: Mapping[str, Any]) -> Case:
        """A part as a case, with links to all others; see `content_of`."""
        from fe_drivetrain.report.results import PageLink
        from fe_drivetrain.report.suite.case import Case

        links = tuple(
            PageLink(title=TITLES[one], address="" if one == name else f"../{one}/report.html")
            for one in self.names
        )
        return Case(
            f"{GROUP}/{name}",
            f"{self.scene.title}: {TITLES[name].lower()}",
            "the user's drivetrain and files",
            work,
            settings=tuple(content),
            command=self.command,
            links=links,
        )


def make_dossier(
    folder: Path, asked: ReportRequest, scene: Scene, own: StudyLoads, report: Progress
) -> Results:
    """Make every part that is not kept, and the first page of all.

    Parameters
    ----------
    folder : Path
        Where it goes.
    asked : ReportRequest
        What was asked for.
    scene : Scene
        The drivetrain.
    own : StudyLoads
        The loads as read.
    report : Progress
        Called with what is being done.

    Returns
    -------
    Results
        Those of the first page.
    """
    from fe_drivetrain.pages.dossier import show_dossier
    from fe_drivetrain.studies.dossier_overview import dossier

    works = dossier_works(asked, scene, own)
    made = Dossier(folder, asked, scene, (OVERVIEW, *works), as_typed())
    content = content_of(asked, scene)
    parts = _made_parts(made, works, own, content, report)
    of_parts = {**content, "parts": {name: part.digest for name, part in parts.items()}}
    overview = Shown(lambda run: dossier(scene, parts), show_dossier)
    kept = _kept(made, [OVERVIEW], of_parts)
    return kept.get(OVERVIEW) or _made_here(made, OVERVIEW, overview, of_parts, report)


def content_of(asked: ReportRequest, scene: Scene) -> dict[str, Any]:
    """All that the pages of a dossier depend on beside the program.

    Parameters
    ----------
    asked : ReportRequest
        Names the files.
    scene : Scene
        The drivetrain.

    Returns
    -------
    dict
        Hash of the drivetrain and of the content of its files, SHA-256 of each file of loads by
        path, and the options.
    """
    from fe_drivetrain.common.provenance import file_digest
    from fe_drivetrain.report.seal import content_hash
    from fe_drivetrain.shafts.response.cached import whole_content
    from fe_drivetrain.turbine_loads.hub_loads.recorded import recorded_files
    from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_digest

    files = {str(path): history_digest(path) for path in recorded_files(asked.loads)}
    beside = [path for path in (asked.mapping, *(asked.catalogue or ())) if path is not None]
    return {
        "drivetrain": content_hash(whole_content(scene)),
        "files": files | {str(path): file_digest(str(path)) for path in beside},
        "site": asked.site or "",
        "skip": asked.skip,
        "rotor speed": asked.rotor_speed or 0.0,
    }


def _kept(dossier: Dossier, names: Sequence[str], content: Mapping[str, Any]) -> dict[str, Results]:
    """Results that are there, made by the same program of the same content."""
    from fe_drivetrain.report.results import read_results
    from fe_drivetrain.report.suite.resuming import finished_cases

    cases = [dossier.case(name, _nothing, content) for name in names]
    kept = finished_cases(cases, dossier.folder, content, dossier.asked.quick)
    return {
        name: read_results(dossier.place(name) / "results.json")
        for name, case in zip(names, cases, strict=True)
        if case.name in kept
    }


def _nothing(run: Any, page: Any) -> None:
    """The work of a part that is made elsewhere, or not at all."""


def _made_parts(
    dossier: Dossier,
    works: Mapping[str, Work],
    own: StudyLoads,
    content: Mapping[str, Any],
    report: Progress,
) -> dict[str, Results]:
    """Results of all parts in order, kept or made now."""
    parts = _kept(dossier, list(works), content)
    chains = chains_of([name for name in works if name not in parts])
    with Processes(min(PROCESSES, len(chains)), report) as processes:
        if processes.count:
            parts |= _side_by_side(dossier, chains, own, content, processes)
        elif chains:
            parts |= _in_order(dossier, works, parts, content, report)
    return {name: parts[name] for name in works}


def chains_of(names: Sequence[str]) -> list[list[str]]:
    """Parts that are to be made, as chains for processes, those first that take longest.

    Parameters
    ----------
    names : sequence of str
        The parts.

    Returns
    -------
    list of list of str
        The parts of a chain follow one another.
    """
    found = [[name for name in chain if name in names] for chain in _CHAINS]
    return [chain for chain in found if chain]


def _in_order(
    dossier: Dossier,
    works: Mapping[str, Work],
    kept: Mapping[str, Results],
    content: Mapping[str, Any],
    report: Progress,
) -> dict[str, Results]:
    """Parts that are not kept, made by this process one after the other."""
    from fe_drivetrain.elasticity.compiled_ahead import compiled_ahead
    from fe_drivetrain.report.pictures.drawing_process import drawing_ready

    with compiled_ahead("solver", "meridian", "bearing"), drawing_ready():
        return {
            name: _made_here(dossier, name, work, content, report)
            for name, work in works.items()
            if name not in kept
        }


def _made_here(
    dossier: Dossier, name: str, work: Work, content: Mapping[str, Any], report: Progress
) -> Results:
    from fe_drivetrain.report.suite.result_folders import run_case

    report(TITLES[name])
    case = dossier.case(name, work, content)
    return run_case(case, dossier.place(name), content, dossier.asked.quick, report)


def _side_by_side(
    dossier: Dossier,
    chains: Sequence[Sequence[str]],
    own: StudyLoads,
    content: Mapping[str, Any],
    processes: Processes,
) -> dict[str, Results]:
    """Parts that processes make; their folders are this one's, which puts them in place."""

    def follow(chain: Sequence[str]) -> dict[str, Results]:
        return {name: _made_there(dossier, name, own, content, processes) for name in chain}

    def solve(*arguments: Any) -> dict[str, Results]:
        processes.start(_solve_coarser, *arguments).result()
        return {}

    works: list[Callable[[], dict[str, Results]]] = [partial(follow, chain) for chain in chains]
    if "reactions" in chains[0]:
        from fe_drivetrain.shafts.fidelity.adviser import is_decided_by_statics
        from fe_drivetrain.shafts.fidelity.assembly_bands import COARSER
        from fe_drivetrain.shafts.fidelity.quantity import Quantity
        from fe_drivetrain.studies.scene_description import quick_scene

        coarsest, coarser = COARSER
        scene = quick_scene(dossier.scene) if dossier.asked.quick else dossier.scene
        # when the first two are at work; the process of reactions comes to it later
        works.insert(processes.count, partial(solve, scene, coarser))
        asked = Quantity(main_reaction(dossier.scene))
        if "model" in chains[0] and not is_decided_by_statics(dossier.scene, asked):
            works.append(partial(solve, dossier.scene, coarsest))
    with ThreadPoolExecutor(processes.count, "chain") as threads:
        waiting = [threads.submit(work) for work in works]
        try:
            found = [job.result() for job in as_completed(waiting)]
        except BaseException as error:
            for job in waiting:
                job.cancel()
            processes.end(error)  # for what the threads wait for
            raise
    return {name: results for one in found for name, results in one.items()}


def _solve_coarser(report: Progress, scene: Scene, factor: float) -> None:
    """Solve what reactions or the choice of a model take from the cache when they come to it."""
    from fe_drivetrain.shafts.fidelity.assembly_series import solve_coarser

    report("coarser mesh")
    solve_coarser(scene, factor)


def _made_there(
    dossier: Dossier,
    name: str,
    own: StudyLoads,
    content: Mapping[str, Any],
    processes: Processes,
) -> Results:
    """A part that a process makes."""
    from fe_drivetrain.report.results import read_results
    from fe_drivetrain.report.suite.result_folders import run_case

    def into(
        case: Case,
        folder: Path,
        settings: Mapping[str, Any],
        quick: bool,
        report: Progress,
        shared: Path | None = None,
    ) -> Results:
        loads = own if name == "reactions" else None
        processes.start(_make, dossier, name, loads, folder, dict(settings), shared).result()
        return read_results(folder / "results.json")

    case = dossier.case(name, _nothing, content)
    return run_case(case, dossier.place(name), content, dossier.asked.quick, into=into)


def _make(
    report: Progress,
    dossier: Dossier,
    name: str,
    own: StudyLoads | None,
    folder: Path,
    content: Mapping[str, Any],
    shared: Path | None,
) -> None:
    """Make a part in a process of its own, and name it with each step."""
    from fe_drivetrain.report.suite.result_folders import run_into

    def named(step: str, lane: int = 0) -> None:
        report(f"{TITLES[name]}: {step}" if step else "", lane)

    report(TITLES[name])
    work = dossier_works(dossier.asked, dossier.scene, own)[name]
    case = dossier.case(name, work, content)
    run_into(case, folder, content, dossier.asked.quick, named, shared)
