"""Options of the command line in place of arguments that sentences of the library name."""

from __future__ import annotations

import ast
import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from fe_drivetrain.report.answer import Answer
    from fe_drivetrain.report.results import Section
    from fe_drivetrain.studies.result import Result

    _R = TypeVar("_R", bound="Result")

OPTIONS: Mapping[str, str] = {
    "ChannelMap": "--mapping",
    "against": "--against",
    "at": "--at",
    "azimuths": "--azimuths",
    "bearings": "--bearing",
    "bore": "--bore",
    "catalogues": "--catalogue",
    "changes": "--set",
    "channels": "--channel",
    "cleanliness": "--cleanliness",
    "condensed": "--condensed",
    "duration": "--duration",
    "events": "--event",
    "every": "--every",
    "generator": "--generator",
    "grids": "--grids",
    "gearbox_cleanliness": "--gearbox-cleanliness",
    "gearbox_lubricant": "--gearbox-lubricant",
    "gearbox_temperature": "--gearbox-temperature",
    "held": "--held",
    "high": "--winds",
    "hours": "--hours",
    "hub": "--load",
    "level": "--level",
    "loads": "--loads",
    "low": "--winds",
    "lubricant": "--lubricant",
    "mass_name": "--mass",
    "modes": "--modes",
    "only": "--only",
    "planets": "--planets",
    "points": "--point",
    "profile": "--profile",
    "quantity": "--quantity",
    "reliability_percent": "--reliability",
    "residue": "--residue",
    "rings": "--rings",
    "riser": "--riser",
    "rotor_speed_rpm": "--rotor-speed",
    "series": "--series",
    "site": "--site",
    "slices": "--slices",
    "slopes": "--slope",
    "speeds": "--speeds",
    "spectrum": "--spectrum",
    "step": "--step",
    "stiffness_name": "--stiffness",
    "supply": "--supply",
    "support": "--support",
    "temperature": "--temperature",
    "tolerance": "--tolerance",
    "torque": "--torque",
    "transients": "--transient",
    "turning": "--turning",
    "units": "--units",
    "values": "--value",
    "what": "--what",
    "windows": "--target",
    "winds": "--winds",
}
"""Option by argument."""

WORDS: Mapping[tuple[str, object], str] = {
    ("profile", True): "--profile",
    ("profile", False): "--straight",
    ("kind", "summary"): "--what summary",
    ("kind", "turning"): "--what turning",
    ("kind", "modes"): "--modes",
}
"""What is typed for a value of an argument that is no option with the value behind it."""

_BETWEEN = {"at": ",", "held": ",", "low": ":", "lubricant": ",", "gearbox_lubricant": ","}
"""What stands between items of one option; others are repeated."""


def with_options(text: str) -> str:
    """The text with options of the command line in place of the arguments that it names.

    Parameters
    ----------
    text : str
        A sentence of the library, see `fe_drivetrain.common.arguments`.
    """
    return re.sub("`([^`]+)`", lambda found: typed(found[1]) or found[0], text)


def result_with_options(result: _R) -> _R:
    """The result of a study with options in place of the arguments that its sentences name.

    Parameters
    ----------
    result : Result
        As the study returns it.
    """
    rows = [
        one.model_copy(update={"source": with_options(one.source)}) for one in result.assumptions
    ]
    return replace(
        result,
        answer=_answer_with_options(result.answer),
        details=tuple(map(with_options, result.details)),
        notes=tuple(map(with_options, result.notes)),
        unsettled=tuple(map(with_options, result.unsettled)),
        skipped=tuple(map(with_options, result.skipped)),
        assumptions=tuple(rows),
    )


def _answer_with_options(answer: Answer) -> Answer:
    """An answer with options in its verdict and cautions."""
    return answer.model_copy(
        update={
            "verdict": with_options(answer.verdict),
            "cautions": [with_options(one) for one in answer.cautions],
        }
    )


def sections_with_options(sections: Sequence[Section]) -> list[Section]:
    """Sections of a page with options in place of the arguments that paragraphs and tables name.

    Parameters
    ----------
    sections : sequence of Section
        As the page has them.
    """
    return [
        section.model_copy(update={"items": [_item_with_options(item) for item in section.items]})
        for section in sections
    ]


def _item_with_options(item: Any) -> Any:
    """A paragraph, or a table with its caption; charts and pictures as they are."""
    named = {"text": "text", "table": "caption"}.get(item.kind)
    if named is None:
        return item
    return item.model_copy(update={named: with_options(getattr(item, named))})


def typed(code: str) -> str | None:
    """What is typed for an argument.

    Parameters
    ----------
    code : str
        As Python has it: a name, "name=value", or a class of options that is called with it.

    Returns
    -------
    words : str or None
        None where no option stands for it.
    """
    try:
        tree: ast.expr = ast.parse(f"_({code})", mode="eval").body
    except SyntaxError:
        return None
    name = ""
    while isinstance(tree, ast.Call):
        if len(tree.keywords) > 1:  # both ends of a range
            name = tree.keywords[0].arg or ""
            tree = ast.Tuple([one.value for one in tree.keywords])
        elif tree.keywords:
            name, tree = tree.keywords[0].arg or "", tree.keywords[0].value
        elif tree.args:
            tree = tree.args[0]
        else:
            return None
    if isinstance(tree, ast.Name) and not name:
        return OPTIONS.get(tree.id)
    return _with_value(name, ast.literal_eval(tree)) if _is_plain(tree) else OPTIONS.get(name)


def _is_plain(tree: ast.expr) -> bool:
    try:
        ast.literal_eval(tree)
    except ValueError:
        return False
    return True


def _with_value(name: str, value: object) -> str | None:
    """The option with its value, or what stands for that value."""
    if isinstance(value, str | bool) and (name, value) in WORDS:
        return WORDS[name, value]
    option = OPTIONS.get(name)
    if option is None or value is ...:
        return option
    items = [f"{100.0 * value:g}%" if name == "tolerance" and isinstance(value, float) else value]
    if isinstance(value, Mapping):
        items = [f"{key}={_shown(one)}" for key, one in value.items()]
    elif isinstance(value, list | tuple):
        items = list(value)
        if name in _BETWEEN:
            items = [_BETWEEN[name].join(map(_shown, value))]
    return " ".join(f"{option} {shlex.quote(_shown(item))}" for item in items)


def _shown(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
