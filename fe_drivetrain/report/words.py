"""Words that a page explains: each leads to the glossary from the first place where it stands.

The glossary is ``glossary.md`` beside this module, which the documentation shows, too.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from markupsafe import Markup, escape

from fe_drivetrain.report.rendering import printed

#: Words that pages lead from, and how they stand in sentences. Others of the glossary are known,
#: or mean something else in most sentences, as "case" and "assembly" do.
_IN_SENTENCES = {
    "adviser": r"advisers?",
    "band": r"(?<!mm.)(?<!sliding.)(?<!loaded.)(?<!narrow.)(?<!rigid.)(?<!frequency.)bands?",
    "bonded": r"bonded",
    "closed form": r"closed forms?",
    "damage-equivalent load": r"damage-equivalent loads?",
    "hub loads": r"hub loads?",
    "K_R": r"K_R",
    "L10, L10m, L10r, L10mr": r"L10m?r?",
    "lamina": r"lamina|laminae",
    "level": r"(?<!time.at.)(?<!load.)levels?",
    "meridian": r"meridians?",
    "scene": r"scenes?",
    "seat": r"seats?",
    "static safety": r"static safety|S0",
    "surrogate": r"surrogates?",
    "unit load": r"unit loads?",
}
_SEE = re.compile(r" ?See \[.*?\)\.(?= |$)")  # pages of the documentation, which are elsewhere
_CODE = re.compile(r"(<code>.*?</code>)", re.DOTALL)


class Word(NamedTuple):
    """A word of the glossary.

    Attributes
    ----------
    name : str
        The word, as the glossary has it.
    anchor : str
        Identifier of its place on a page.
    meaning : str
        What it means, in plain sentences; code between backticks.
    """

    name: str
    anchor: str
    meaning: str


@lru_cache(maxsize=1)
def glossary() -> dict[str, Word]:
    """All words of the glossary, by name."""
    text = (Path(__file__).parent / "glossary.md").read_text(encoding="utf-8")
    found = {}
    for entry in text.strip().split("\n\n"):
        name, _, meaning = entry.partition("\n: ")
        anchor = "word-" + re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
        found[name] = Word(name, anchor, _SEE.sub("", " ".join(meaning.split())))
    return found


@lru_cache(maxsize=1)
def _patterns() -> dict[str, re.Pattern[str]]:
    """What finds each word in a sentence, at its beginning, too."""
    return {
        name: re.compile(rf"(?<![\w.])(?:{pattern})(?!\w)", re.IGNORECASE)
        for name, pattern in _IN_SENTENCES.items()
    }


def words_in(texts: Iterable[str]) -> list[Word]:
    """Words of the glossary that stand in texts, in its order.

    Parameters
    ----------
    texts : iterable of str
        Sentences and names of a page.

    Returns
    -------
    list of Word
    """
    text = "\n".join(texts).replace("\u00a0", " ")
    found = {name for name, pattern in _patterns().items() if pattern.search(text)}
    return [word for name, word in glossary().items() if name in found]


class FirstUses:
    """Prints sentences of a page, the first use of each word a link to what it means there.

    Parameters
    ----------
    words : iterable of Word
        Those that the page explains.
    """

    def __init__(self, words: Iterable[Word]) -> None:
        self._left = {word.name: word for word in words}

    def __call__(self, text: str) -> Markup:
        """The text as a page prints it, with links where words stand for the first time."""
        parts = _CODE.split(str(escape(printed(text))))
        parts[::2] = [self._linked(part) for part in parts[::2]]
        return Markup("".join(parts))

    def _linked(self, part: str) -> str:
        """Escaped text without tags, with links."""
        links = []
        for name, word in list(self._left.items()):
            found = _patterns()[name].search(part.replace("\u00a0", " "))
            if found is None:
                continue
            del self._left[name]
            link = Markup('<a class="word" href="#{}" title="{}">{}</a>').format(
                word.anchor, word.meaning.replace("`", ""), Markup(part[slice(*found.span())])
            )
            links.append(str(link))
            # what stands in for it holds no word, so that no link is made inside of another
            mark = f"\x00{len(links) - 1}\x00"
            part = part[: found.start()] + mark + part[found.end() :]
        return re.sub("\x00(\\d+)\x00", lambda found: links[int(found[1])], part)
