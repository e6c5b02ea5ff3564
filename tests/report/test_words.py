"""Words of the glossary on pages: each leads from its first use to what it means."""

import re
from pathlib import Path

import pytest

from fe_drivetrain.report.words import _IN_SENTENCES, FirstUses, glossary, words_in


def names(*texts: str) -> list[str]:
    return [word.name for word in words_in(texts)]


def test_every_word_that_pages_look_for_is_in_the_glossary() -> None:
    assert _IN_SENTENCES.keys() <= glossary().keys()
    # in order, since people look there, too
    assert sorted(glossary(), key=str.lower) == list(glossary())
    assert len({word.anchor for word in glossary().values()}) == len(glossary())
    for word in glossary().values():
        assert word.meaning.endswith("."), word.name
        assert "](" not in word.meaning, word.name


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("Bonded seats of the meridian", ["bonded", "meridian", "seat"]),
        ("K_R at level 2, ±3 MN m/rad", ["K_R", "level"]),
        ("L10r is 20 years, S0 1.4", ["L10, L10m, L10r, L10mr", "static safety"]),
        ("time at level, load levels, a sliding band, a 2 mm band, leveling, unbonded", []),
        ("rainflow, hub_loads, results.scene", []),
    ],
)
def test_words_stand_in_sentences_as_words(text: str, found: list[str]) -> None:
    assert names(text) == found


def test_the_first_use_is_a_link_and_no_other() -> None:
    linked = FirstUses(words_in(["seat", "band"]))
    first, second = linked("The seat & its <seat>"), linked("Seats, and m^2 of a band")
    assert first.startswith('The <a class="word" href="#word-seat" title="The face where')
    assert first.endswith(">seat</a> &amp; its &lt;seat&gt;")
    assert second.startswith("Seats, and m² of a <a ")
    assert str(second).count("<a ") == 1


def test_code_and_meanings_are_not_led_from() -> None:
    linked = FirstUses(words_in(["seat", "K_R", "bonded"]))
    # what K_R means names the seat, in an attribute
    text = str(linked("`seat` of K_R: bonded"))
    assert text.startswith("<code>seat</code> of <a ")
    assert re.findall(r">(\w+)</a>", text) == ["K_R", "bonded"]
    assert 'href="#word-seat"' in linked("a seat")


def test_the_documentation_shows_the_same_glossary() -> None:
    page = Path(__file__).parents[2] / "docs" / "glossary.md"
    included = re.search(r"```\{include\} (\S+)", page.read_text("utf-8"))
    assert included is not None
    text = (page.parent / included[1]).read_text("utf-8")
    assert all(name in text for name in glossary())
