"""Hundreds of machines with slips of the pen: each is refused with a sentence, or right."""

import json
from collections import Counter
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.verification.machine_facts import (
    Outcome,
    machine_facts,
    table_facts,
    tried,
)
from fe_drivetrain.cases.verification.mutated_tables import mutated
from fe_drivetrain.common.reading import validated
from fe_drivetrain.drivetrain_file import (
    Drivetrain,
    LumpedDrivetrain,
    MachineTable,
    parse_drivetrain,
    read_drivetrain,
)
from fe_drivetrain.dynamics import MACHINES, Machine, gear_table, library_machine, machine_of
from fe_drivetrain.dynamics.torsion import GearTable
from fe_drivetrain.report import bars
from fe_drivetrain.report.suite import Page, Record, Run

MACHINES_TRIED, TABLES_TRIED, QUICK, FEWEST = 300, 200, 40, 20
TABLES = ("drivetrain_a", "drivetrain_b", "drivetrain_c", "nrel_750kw")
SEED = 20163
#: Of those that are tried: so many are taken, and so many refused, or the case would test little.
MINIMUM = 0.1
FATES = "Machines and gear tables with typing errors: rejected, read and right, or wrong"
FACTS = (
    "mass symmetric and positive, stiffness symmetric and not negative, no motion of 0 Hz beside "
    "turning, Rayleigh's quotients, twice the frequencies of four times the stiffness, turning at "
    "the ratio of the teeth without any spring wound, its kinetic energy, and power"
)


@case(
    "Machines with slips of the pen: refused with one sentence, or right by physics",
    source="mechanics: what every drivetrain must do, of its table alone",
    settings={
        "machines": "300 (quick 40; from 20)",
        "tables": "200 (quick 40; from 20)",
    },
)
def run(run: Run, page: Page) -> None:
    """Change tables at random, read them, and hold what is taken to facts."""
    every: dict[str, list[Record]] = {}
    for name, given, count, attempt in (
        (
            "machines",
            [plain(read_drivetrain(name)) for name in MACHINES],
            run.count("machines", QUICK if run.quick else MACHINES_TRIED, least=FEWEST),
            try_machine,
        ),
        (
            "gear tables",
            [plain(published.drivetrain(name)) for name in TABLES],
            run.count("tables", QUICK if run.quick else TABLES_TRIED, least=FEWEST),
            try_table,
        ),
    ):
        with run.step(name):
            rows = slips(given, count, attempt)
        check(page, name, rows)
        show(page, name, rows)
        every[name] = rows
    control(page)
    answer(page, every)


def answer(page: Page, every: dict[str, list[Record]]) -> None:
    """State what became of all tables with slips, and show it."""
    fates = {
        "rejected": lambda row: not row["taken"] and not row["wrong"],
        "read and right": lambda row: row["taken"] and not row["wrong"],
        "wrong": lambda row: bool(row["wrong"]),
    }
    counts = {
        fate: {name: sum(map(is_so, rows)) for name, rows in every.items()}
        for fate, is_so in fates.items()
    }
    refused, right, wrong = (sum(of.values()) for of in counts.values())
    page.answer(
        "What happens to a machine file with a typing error?",
        f"Of {refused + right + wrong} machine files and gear tables with a typing error, "
        f"{refused} are rejected with one sentence, {right} obey mechanics, {wrong} go wrong.",
        [
            page.value("files that go wrong", wrong, at_most=0),
            *(page.value(f"{name} rejected", n) for name, n in counts["rejected"].items()),
            *(
                page.value(f"{name} read that obey mechanics", n)
                for name, n in counts["read and right"].items()
            ),
        ],
        hero=FATES,
        cautions=[
            "Files that are read are checked by laws of mechanics: what their author meant is "
            "unknown."
        ],
    )
    page.section("What became of them")
    page.add(bars(FATES, counts, "tables", stacked=True))


def slips(
    given: list[dict[str, Any]],
    count: int,
    attempt: Callable[[dict[str, Any], bool], Outcome],
) -> list[Record]:
    """What became of each changed table, which is read as data and as text by turns."""
    random = np.random.default_rng(SEED)
    rows: list[Record] = []
    for k in range(count):
        data, said = mutated(given[k % len(given)], random)
        outcome = attempt(data, k // len(given) % 2 == 1)
        rows.append(
            {
                "table": str(given[k % len(given)]["title"]),
                "changed": said,
                "taken": not outcome.refused,
                "refused with": outcome.refused,
                "wrong": "; ".join(outcome.wrong),
            }
        )
    return rows


def plain(table: Drivetrain | Machine) -> dict[str, Any]:
    """Mappings, lists and values, as in a file."""
    return table.model_dump(mode="json", exclude_none=True)


def as_text(data: dict[str, Any]) -> str:
    """The table as a file; JSON is YAML."""
    return json.dumps(data)


def try_machine(data: dict[str, Any], text: bool) -> Outcome:
    """A machine from data, or from text."""

    def made() -> Machine:
        return machine_of(read(data, text))

    return tried(made, machine_facts)


def try_table(data: dict[str, Any], text: bool) -> Outcome:
    """A gear table from data, or from text."""

    def made() -> GearTable:
        return gear_table(read(data, text))

    return tried(made, table_facts)


def read(data: dict[str, Any], text: bool) -> Drivetrain:
    """The drivetrain of data, or of text."""
    if text:
        return parse_drivetrain(as_text(data))
    return validated(LumpedDrivetrain, data, "drivetrain")


def check(page: Page, name: str, rows: list[Record]) -> None:
    """None is wrong, and enough are of each kind."""
    taken = sum(bool(row["taken"]) for row in rows)
    page.vanishes(
        f"{len(rows)} {name} with slips: neither refused with one sentence nor right",
        sum(bool(row["wrong"]) for row in rows),
        within=0.0,
        why="counted; one wrong answer without a word is one too many",
        source=FACTS if name == "machines" else "the same of masses that turn, of the table alone",
    )
    for what, share in (("taken", taken / len(rows)), ("refused", 1 - taken / len(rows))):
        page.at_least(
            f"{name} with slips: share that is {what}",
            share,
            MINIMUM,
            why="else the slips would be too large, or too small, to test anything",
            source="counted",
        )


#: Slips that once were taken without a word, of the library's machine of radii: keys and values.
WRONG: dict[str, dict[str, Any]] = {
    "ring of 60 teeth inside its planets of 39": {"radii": None, "teeth": (60, 39, 21)},
    "ring of 120 teeth around planets of 39 and a sun of 21": {
        "radii": None,
        "teeth": (120, 39, 21),
    },
    "radii of 0.11 and 0.36 m at a centre distance of 0.27 m": {"radii": (0.11, 0.36)},
    "planets without any pin": {"pins": ()},
}


def control(page: Page) -> None:
    """Without the gate, the facts find what is wrong."""
    for name, changes in WRONG.items():
        data = plain(library_machine("park_2021"))
        data["stages"][0] |= changes
        outcome = tried(partial(MachineTable.model_validate, data), machine_facts)
        page.holds(
            f"control, without the gate: {name} is found wrong by the facts",
            bool(outcome.wrong),
            why="else a wrong machine would pass for a right one here",
            source="; ".join(outcome.wrong)[:200] or "nothing was found",
        )


def show(page: Page, name: str, rows: list[Record]) -> None:
    """Tables."""
    taken = [row for row in rows if row["taken"]]
    wrong = [row for row in rows if row["wrong"]]
    page.section(name.capitalize())
    if wrong:
        page.table("Wrong", wrong)
    kinds = Counter(str(row["table"]) for row in taken)
    page.table(
        "How many are taken, by table",
        [{"table": table, "taken": count} for table, count in sorted(kinds.items())],
    )
    page.table(
        "Refused",
        [
            {key: str(row[key])[:200] for key in ("table", "changed", "refused with")}
            for row in rows
            if not row["taken"]
        ][:60],
    )
    page.table(
        "Taken",
        [{key: str(row[key])[:200] for key in ("table", "changed")} for row in taken][:60],
    )
    page.data(name, rows)
