"""Work that follows changes, and takes a small share of the time."""

import time

import pytest

from fe_drivetrain.common import repeated
from fe_drivetrain.common.repeated import Repeated


def test_what_is_cheap_is_done_each_time() -> None:
    done: list[int] = []
    pages = Repeated(lambda: done.append(1))
    for _ in range(5):
        pages.soon()
    assert len(done) == 5


def test_what_is_expensive_rests_and_then_shows_all_changes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(repeated, "CHEAP", -1.0)  # nothing is
    monkeypatch.setattr(repeated, "REST", 4.0)
    changes, shown = 0, list[int]()

    def show() -> None:
        shown.append(changes)
        until = time.thread_time() + 0.05
        while time.thread_time() < until:
            pass

    pages = Repeated(show)
    for _ in range(10):
        changes += 1
        pages.soon()
    end = time.monotonic() + 10.0
    while shown[-1] < changes and time.monotonic() < end:
        time.sleep(0.01)
    assert (shown[0], shown[-1]) == (1, changes)
    assert len(shown) < 5  # the others waited for one turn


def test_nothing_comes_after_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(repeated, "CHEAP", -1.0)
    monkeypatch.setattr(repeated, "REST", 1e6)
    done: list[int] = []
    pages = Repeated(lambda: done.append(len(bytes(10**7))))
    pages.soon()
    pages.soon()
    pages.stop()
    assert len(done) == 1
