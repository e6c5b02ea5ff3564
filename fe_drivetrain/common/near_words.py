"""Words that are nearest to a misspelt one."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

_MOST = 3


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """A question that names the known words nearest to one that is not known.

    Parameters
    ----------
    word : str
        As typed.
    known : iterable of str
        All that may be typed; of names with a folder, as in GROUP/NAME, each part counts, too.

    Returns
    -------
    str
        "did you mean 'a', 'b' or 'c'?"; three at most, empty where none is near.
    """
    of: dict[str, list[str]] = {}
    for full in known:
        for part in dict.fromkeys((full, full.rpartition("/")[2])):
            of.setdefault(part.lower(), []).append(full)
    close = get_close_matches(word.lower(), of, n=_MOST, cutoff=0.5)
    names = list(dict.fromkeys(full for part in close for full in of[part]))[:_MOST]
    if not names:
        return ""
    *first, last = map(repr, names)
    return f"did you mean {', '.join(first)} or {last}?" if first else f"did you mean {last}?"
