"""Work of cases in tests of several of them, as other processes import it; and such cases."""

import os
import time
from collections.abc import Callable

from tiny_case import check_one

from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.common.threads import cores
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run


def count(run: Run, page: Page) -> None:
    start = time.time()
    with run.step("count"):
        (run.folder / "one.txt").write_text("1")
        time.sleep(0.3)
    run.times.update(count=1.5, saved=-0.25)
    check_one(page)
    page.data("began", start)
    page.data("ended", time.time())
    page.data("pid", os.getpid())
    page.data("cores", cores())
    page.data("kept", user_cache().folder is not None)


def last(run: Run, page: Page) -> None:
    check_one(page)
    page.data("began", time.monotonic())


def miss(run: Run, page: Page) -> None:
    run.times.update(count=1.5, saved=-0.25)
    check_one(page, 2.0)


def refuse(run: Run, page: Page) -> None:
    (run.folder / "half.txt").write_text("half")
    raise InputError("shaft: length is -1 <m>: give a length")


def fault(run: Run, page: Page) -> None:
    check_one(page, 1 / 0)


def off(run: Run, page: Page) -> None:
    for computed in (1.25, 0.75):
        check_one(page, computed, within=1.0, measure="stiffness", band=0.05 * computed)


def wait(run: Run, page: Page) -> None:
    (run.folder / f"pid-{os.getpid()}").touch()
    with run.step("wait"):
        time.sleep(600)


def need_a_tool(run: Run, page: Page) -> None:
    raise MissingToolError("ccx is not installed: apt-get install calculix-ccx")


def read_the_index(run: Run, page: Page) -> None:
    page.say((run.folder.parents[1] / "index.html").read_text())
    count(run, page)  # which is a step
    end = time.monotonic() + 10.0
    while "1 running" not in (said := (run.folder.parents[1] / "index.html").read_text()):
        assert time.monotonic() < end
        time.sleep(0.02)
    page.say(said)


def a_case(name: str, work: Callable[[Run, Page], None], alone: bool = False) -> Case:
    return Case(name, f"Title of <{name}>", "nobody", work, alone, settings=("k",))
