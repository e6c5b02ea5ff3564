"""XML of other programs without entities: no document type, no bombs, no other files.

An entity may stand for a gigabyte, or for a file of this machine; formats that are read here have
none, so that a document type is refused by itself. Prefixes of name spaces are left out.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any
from xml.parsers import expat

from fe_drivetrain.common.errors import InputError

MAX_ELEMENTS = 1_000_000
"""Elements that a file may have: each takes some hundred bytes of memory."""
MAX_DEPTH = 100
"""Elements that one may be in, each in the next."""


def plain_root(content: bytes, source: str) -> ET.Element:
    """The root of an XML file, with its comments.

    Parameters
    ----------
    content : bytes
        The file; its encoding is that of its own declaration.
    source : str
        The file and what it should be, for messages, as in "a.rexs is no REXS model".

    Raises
    ------
    InputError
        It is not well-formed, has a document type or entities, or is too deep or too long.
    """
    parser = expat.ParserCreate(namespace_separator=" ")
    builder = ET.TreeBuilder(insert_comments=True)
    counts = {"all": 0, "open": 0}

    def begin(tag: str, attributes: dict[str, str]) -> None:
        counts["all"] += 1
        counts["open"] += 1
        if counts["all"] > MAX_ELEMENTS:
            raise InputError(f"{source}: it has more than {MAX_ELEMENTS:,} elements: shorten it")
        if counts["open"] > MAX_DEPTH:
            raise InputError(f"{source}: elements are nested deeper than {MAX_DEPTH}: correct it")
        builder.start(_local(tag), {_local(key): value for key, value in attributes.items()})

    def end(tag: str) -> None:
        counts["open"] -= 1
        builder.end(_local(tag))

    def refuse(*_: Any) -> None:
        raise InputError(
            f"{source}: it has a document type (<!DOCTYPE ...>), by which entities enter: remove it"
        )

    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = begin, end
    parser.CharacterDataHandler = builder.data
    parser.CommentHandler = lambda text: builder.comment(text) if counts["open"] else None
    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(content, True)
        return builder.close()
    except (expat.ExpatError, ValueError, LookupError, AssertionError) as error:
        raise InputError(f"{source}: {error}: export it again, or correct it") from error


def _local(name: str) -> str:
    return name.rpartition(" ")[2]
