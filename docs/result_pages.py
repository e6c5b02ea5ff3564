"""What results of a run add to the site: where methods fail, and pictures of cases.

The folder of results is that of ``FE_DRIVETRAIN_QUICK_RUNS``, or ``reports`` of the clone.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path

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


def results() -> dict[str, tuple[Results, Path]]:
    """Results by the name of their case, and the folder of each; none that cannot be read."""
    folder = Path(os.environ.get("FE_DRIVETRAIN_QUICK_RUNS") or ROOT / "reports")
    found = {}
    for name, file in results_below(folder).items():
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
