"""What results of a run add to the site: pages and answers of cases, limits of methods, pictures.

The folder of results is that of ``FE_DRIVETRAIN_QUICK_RUNS``, or ``reports`` of the clone.
"""

from __future__ import annotations

import html
import os
import re
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path

from fe_drivetrain.common.provenance import program_hash
from fe_drivetrain.report import (
    Image,
    Limit,
    Results,
    Solid,
    read_results,
    results_below,
    verdict_sentence,
)

ROOT = Path(__file__).parents[1]

SITE = "results"
"""Folder of the site that has the pages of the run."""

LISTS = {
    "index.html": "All cases, worst first",
    "checks.html": "every check",
    "atlas.html": "limits of methods",
}
"""Pages of a run beside those of its cases, and what they are called."""

LEFT_OUT = shutil.ignore_patterns(".*", "*.sqlite", "fe-drivetrain-files.json")
"""What belongs to a folder of reports and not to its pages."""


def results_folder() -> Path:
    """The folder of results, which may be empty."""
    return Path(os.environ.get("FE_DRIVETRAIN_QUICK_RUNS") or ROOT / "reports")


def results() -> dict[str, tuple[Results, Path]]:
    """Results by the name of their case, and the folder of each; none that cannot be read."""
    found = {}
    for name, file in results_below(results_folder()).items():
        try:
            found[name] = read_results(file), file.parent
        except ValueError:  # of another version
            continue
    return found


def plain(text: str) -> str:
    """Text in which Markdown finds no marks, but for code in backticks, on one line."""
    pieces = re.split(r"(`+[^`]*`+)", " ".join(text.split()))
    pieces[::2] = [re.sub(r"([\\*_\[\]<>|#$~])", r"\\\1", piece) for piece in pieces[::2]]
    return "".join(pieces)


# --- Pages of a run ---


def copy_pages(folder: Path, site: Path) -> None:
    """Copy a run's pages, with all that they show, into the site.

    Parameters
    ----------
    folder : Path
        Folder of results; where it has none, those of an earlier build are taken out of the site.
    site : Path
        Folder of the site.
    """
    to = site / SITE
    shutil.rmtree(to, ignore_errors=True)
    cases = [file.parent for file in results_below(folder).values()]
    if not cases:
        return
    to.mkdir(parents=True)
    for file in (*folder.glob("*.html"), *folder.glob("*.js")):
        linked(file, to / file.name)
    for case in cases:
        at = to / case.relative_to(folder)
        shutil.copytree(case, at, ignore=LEFT_OUT, copy_function=linked)


def linked(file: str | Path, to: str | Path) -> None:
    """Let a file stand in a second place, without a second copy where the disk allows it.

    Reports are replaced, not changed, so that the site keeps what it was built with.
    """
    try:
        os.link(file, to)
    except OSError:  # another disk
        shutil.copyfile(file, to)


def of_the_run(found: Mapping[str, tuple[Results, Path]]) -> str:
    """The run whose results the site has, with links to its lists; or that it has none."""
    if not found:
        return (
            "This site was built without results of a run: `fe-drivetrain run --all`, and build it "
            "again. Then each case has its answer here, and a link to its page."
        )
    environments = [each.environment for each, _ in found.values()]
    days = sorted({environment.date[:10] for environment in environments})
    quick = sum(environment.quick for environment in environments)
    when = days[0] if len(days) == 1 else f"{days[0]} to {days[-1]}"
    coarse = f" Quick runs, coarser and smaller than the case: {quick}." if quick else ""
    now = program_hash()
    if older := sum(environment.code != now for environment in environments):
        coarse += f" Results of another state of the program: {older}."
    links = [
        f'<a href="../{SITE}/{name}">{what}</a>'
        for name, what in LISTS.items()
        if (results_folder() / name).is_file()
    ]
    return (
        f"Answers are those of the last run, of {when}; cases with results: {len(found)}.{coarse} "
        + (f"{', '.join(links)}." if links else "")
    )


def answer_of(name: str, found: Mapping[str, tuple[Results, Path]]) -> str:
    """The answer of a case as a link to its page; empty where the run has none."""
    if name not in found:
        return ""
    each, folder = found[name]
    sentence = html.escape(verdict_sentence(each) or "Page of this case", quote=False)
    if not (folder / "report.html").is_file():
        return sentence
    return f'<a href="../{SITE}/{name}/report.html">{sentence}</a>'


# --- Limits ---


def limits_page(found: Mapping[str, tuple[Results, Path]]) -> str:
    """Every limit that the cases have measured, by case."""
    limits = {name: each.limits for name, (each, _) in sorted(found.items()) if each.limits}
    count = sum(map(len, limits.values()))
    lines = [
        "# Where methods stop",
        "",
        "Each case of `fe-drivetrain run stability` drives one parameter until a method fails. "
        "What no method here models at all is in [What this does not model](../limits.md).",
        "",
    ]
    if not limits:
        return "\n".join(
            [
                *lines,
                "This site was built without results: run the cases into `reports`, and build it "
                "again.",
                "",
            ]
        )
    quick = any(found[name][0].environment.quick for name in limits)
    lines += [
        f"{count} limit{'s' * (count != 1)} of {len(limits)} case{'s' * (len(limits) != 1)}"
        + (", from quick runs: coarser and smaller than the cases." if quick else "."),
        "",
    ]
    for name, of in limits.items():
        lines += [f"## {plain(found[name][0].title)}", "", f"`fe-drivetrain run {name}`", ""]
        for limit in of:
            lines += [*_limit(limit), ""]
    return "\n".join(lines)


def _limit(limit: Limit) -> Iterator[str]:
    low, high = (None if end is None else f"{end:.3g}" for end in (limit.low, limit.high))
    if low is None:
        safe = "over the whole sweep" if high is None else f"up to {high}"
    else:
        safe = f"from {low}" if high is None else f"from {low} to {high}"
    yield f"{plain(limit.method)}"
    yield f": Safe {safe}: {plain(limit.parameter)} ({plain(limit.criterion)})."
    yield f"  *Beyond:* {plain(limit.beyond)}. *The program:* {plain(limit.program)}."
    yield f"  *What holds there:* {plain(limit.remedy)}."


# --- Pictures ---


def cards_of_cases(found: Mapping[str, tuple[Results, Path]], pictures: Path) -> list[str]:
    """A card for each case that has drawn its model, deformed where it can be; copies pictures."""
    shutil.rmtree(pictures, ignore_errors=True)
    pictures.mkdir(parents=True)
    lines = []
    for name, (each, folder) in sorted(found.items()):
        drawn = _picture(each)
        if not drawn or not (folder / drawn).is_file():
            continue
        file = f"{name.replace('/', '-')}.png"
        shutil.copyfile(folder / drawn, pictures / file)
        said = [plain(verdict_sentence(each)), ""] if each.answer else []
        lines += [
            f":::{{grid-item-card}} {plain(each.title)}",
            f":img-top: {pictures.name}/{file}",
            f":img-alt: model of {name}",
            f":link: ../{SITE}/{name}/report.html",
            "",
            *said,
            f"`fe-drivetrain run {name}`",
            ":::",
            "",
        ]
    return lines


def _picture(results: Results) -> str:
    """The picture of the answer, or the last one; empty where there is none."""
    items = [item for section in results.sections for item in section.items]
    drawn = [item for item in items if isinstance(item, Image | Solid)]
    hero = [item for item in drawn if results.answer and item.caption == results.answer.hero]
    files = [item.still if isinstance(item, Solid) else item.file for item in [*drawn, *hero]]
    return files[-1] if files else ""
