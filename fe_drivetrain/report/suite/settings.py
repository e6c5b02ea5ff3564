"""Which settings of a run reach which case: those that it takes, and no other without a word."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.report.suite.case import Case

#: Commands that take what no setting of these cases is.
_OF_STUDIES = {
    "scene": "fe-drivetrain study FILE",
    "loads": "fe-drivetrain study FILE --loads FILES",
    "skip": "fe-drivetrain study FILE --loads FILES --skip SECONDS",
    "self_weight": "fe-drivetrain study FILE --no-weight",
}


def settings_by_case(
    cases: Sequence[Case], settings: Mapping[str, Any]
) -> dict[str, dict[str, Any]]:
    """Settings of a run, given to the cases that take them.

    A setting that is a case's own goes to all cases that have it; any other to those whose scene
    has a value of that name.

    Parameters
    ----------
    cases : sequence of Case
        Of the run.
    settings : mapping
        The user's values by key.

    Returns
    -------
    dict
        Values by key, by the name of the case.

    Raises
    ------
    InputError
        No case takes a setting.
    """
    found: dict[str, dict[str, Any]] = {case.name: {} for case in cases}
    for key, value in settings.items():
        first = key.partition(".")[0]
        takers = [case for case in cases if key in case.settings]
        takers = takers or [case for case in cases if first in changeable(case)]
        if not takers:
            raise _unknown(key, cases)
        for case in takers:
            found[case.name][key] = value
    return found


def changeable(case: Case) -> Sequence[str]:
    """First parts of the dotted keys by which a case's scene or component can be changed."""
    if not case.changes:
        return ()
    from fe_drivetrain.drivetrain_file.component import COMPONENTS
    from fe_drivetrain.drivetrain_file.scene import Scene

    model = Scene if case.changes == "scene" else COMPONENTS[case.changes]
    return tuple(model.model_fields)


def settings_in_words(case: Case) -> str:
    """What ``--set`` takes for a case, with what each setting is otherwise; empty for nothing."""
    given = case.settings
    if isinstance(given, Mapping):
        ways = [f"{key}={otherwise}" for key, otherwise in given.items()]
    else:
        ways = [", ".join(given)] if given else []
    if case.changes:
        ways.append(f"any value of its {case.changes.replace('_', ' ')} by its dotted key")
    return "; ".join(ways)


def _unknown(key: str, cases: Sequence[Case]) -> InputError:
    which = cases[0].name if len(cases) == 1 else f"all {len(cases)} cases"
    own = list(dict.fromkeys(name for case in cases for name in case.settings))
    values = list(dict.fromkeys(name for case in cases for name in changeable(case)))
    if not own and not values:
        takes = "takes no settings" if len(cases) == 1 else "take no settings"
        return InputError(f"setting {shown(key)}: {which} {takes}: leave it out")
    first, dot, rest = key.partition(".")
    hint = ""
    for close in get_close_matches(first, [*own, *values], n=1):
        meant = close + dot + rest if close in values else close
        hint = f" (did you mean {shown(meant)}?)"
    ways = [f"one of {', '.join(own)}"] if own else []
    if values:
        ways.append(f"a value of {', '.join(values)} by its dotted key")
    if key in _OF_STUDIES:
        hint = f" (a drivetrain of your own is studied by {_OF_STUDIES[key]})"
    return InputError(f"setting {shown(key)} is unknown to {which}{hint}: use {', or '.join(ways)}")
