"""JSON of other programs, of a depth that its reader's stack can hold.

Python's own reader calls itself for each bracket, and from 3.13 on counts on ten thousand of
those: where the stack is shorter, the process dies instead of saying why.
"""

from __future__ import annotations

import json
import re
from typing import Any

MAX_DEPTH = 100
"""Lists and objects that one may be in, each in the next."""
# a string that does not end reaches to the end of the text
_TOKENS = re.compile(r'"(?:[^"\\]|\\.)*(?:"|$)|[\[{]|[\]}]', re.DOTALL)


def plain_json(text: str) -> Any:
    """What a text in JSON says.

    Parameters
    ----------
    text : str
        The content of a file.

    Raises
    ------
    ValueError
        It is no JSON, or nested deeper than `MAX_DEPTH`.
    """
    depth = 0
    for token in _TOKENS.finditer(text):
        bracket = token[0]
        if bracket in "[{":
            depth += 1
            if depth > MAX_DEPTH:
                raise ValueError(f"lists and objects are nested deeper than {MAX_DEPTH}")
        elif bracket in "]}":
            depth -= 1
    return json.loads(text)
