"""A project of the six steps that is complete, on results and files that are made here."""

import copy
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.procedure.certainty import TABLE_4_7
from fe_drivetrain.procedure.channels import write_channels
from fe_drivetrain.procedure.motions import band_torque
from fe_drivetrain.report.environment import environment
from fe_drivetrain.report.results import Figure, Results, Verdict, judge
from fe_drivetrain.report.seal import drivetrain_record, sealed

REVERSALS = "torque oscillation with reversals of the high-speed shaft"
MACHINE = "nrel_750kw"
OWN = drivetrain_record(read_drivetrain(MACHINE), MACHINE)
OTHER = drivetrain_record(read_drivetrain("park_2021"), "park_2021")
Content = dict[str, Any]


def check_of(passed: bool = True, **more: Any) -> Verdict:
    given = {"tolerance": 0.1, "reason": "r", "source": "s", "unit": "N", "band": 0.01}
    return judge("load", 1.0 if passed else 2.0, 1.0, **(given | more))


def value_of(quantity: str, computed: float, load: str, unit: str = "", **more: Any) -> Figure:
    return Figure(quantity=quantity, unit=unit, computed=computed, loads=(load,), **more)


def write_case(reports: Path, name: str, passed: bool = True, **more: Any) -> None:
    """Results of a case on the project's machine, as a run of this program leaves them."""
    quick = more.pop("quick", False)
    code = more.pop("code", None)
    command = more.pop("command", "")
    made = environment({}, quick=quick).model_copy(update={"command": command})
    given = {
        "verdicts": [check_of(passed)],
        "answers": [
            value_of("margin", 0.2, "resonance"),
            value_of("range", 80.0, REVERSALS, "kN m", band=2.0),
        ],
        "drivetrains": [OWN],
    }
    results = Results(
        case=name,
        title="t",
        source="s",
        details=[],
        sections=[],
        environment=made if code is None else made.model_copy(update={"code": code}),
        **(given | more),
    )
    folder = reports.joinpath(*name.split("/"))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "results.json").write_text(sealed(results).model_dump_json(indent=1))


MARGIN = {
    "case": "group/run",
    "quantity": "margin",
    "at_least": 0.1,
    "limit_from": "Campbell diagram, report 12",
}
RANGE = {
    "case": "group/run",
    "quantity": "range",
    "unit": "kN m",
    "at_most": 100,
    "limit_from": "data sheet 7 of the coupling",
}


def small_project(folder: Path) -> Content:
    """A project that is complete, on evidence made here."""
    reports = folder / "reports"
    write_case(reports, "group/run")
    ladder = [
        {"level": "torsional", "frequency [Hz]": 1.1},
        {"level": "rigid bodies", "frequency [Hz]": 1.01},
        {"level": "flexible shafts", "frequency [Hz]": 1.0},
    ]
    write_case(reports, "group/levels", figures={f"ladder_{MACHINE}": ladder})
    wind = np.concatenate([v + band_torque(600, 1.0, (0.01, 0.2), 0.5, v) for v in (6, 7)])
    write_channels(folder / "wind.csv", 1.0, {"wind speed [m/s]": wind})
    torque = 300.0 + band_torque(1200, 1.0, (0.01, 0.4), 10.0, 1)
    write_channels(folder / "mine.csv", 1.0, {"gauge [kN m]": -torque})
    write_channels(folder / "model.csv", 1.0, {"torque [N m]": 1.01e3 * torque})
    content = {
        "subject": "mine",
        "systems": ["drivetrain"],
        "failure_modes": {
            "decision": "torque",
            "critical": [
                {"load": REVERSALS},
                {"load": "resonance", "variables": ["torque"]},
            ],
            "gaps": [{"load": "resonance", "evidence": [MARGIN]}],
        },
        "model": {
            "decision": "rigid",
            "drivetrain": MACHINE,
            "level": "rigid bodies",
            "needs": [{"quantity": "frequency [Hz]", "tolerance": 0.05}],
            "evidence": [{"case": "group/levels"}],
        },
        "load_cases": {
            "decision": "production",
            "cases": [
                {
                    "standard": "IEC 61400-1",
                    "edition": "3",
                    "number": "1.2",
                    "loads": [REVERSALS],
                    "evidence": [RANGE],
                }
            ],
        },
        "inputs": {
            "decision": "as stated",
            "values": [
                {
                    "name": "stiffness of shafts: LSS",
                    "value": 3.69e7,
                    "unit": "N m/rad",
                    "band": 0.05,
                    "known_by": "drawing",
                    "source": "drawing 12, rev. B",
                }
            ],
            "waived": [
                {"name": name, "reason": "the decision does not rest on it"}
                for name in TABLE_4_7
                if name != "stiffness of shafts"
            ],
        },
        "campaign": {
            "decision": "torque",
            "signals": [
                {"name": "torque", "interface": "hub", "rate": 10, "highest": 1, "accuracy": 0.05}
            ],
            "capture": {"files": {"file": "wind.csv"}, "winds": [6, 7], "target": 1},
        },
        "comparison": {
            "decision": "the model holds",
            "measured": {"file": "mine.csv", "channels": {"torque": "-gauge"}},
            "computed": {"file": "model.csv"},
            "quantities": [
                {"channel": "torque", "statistic": kind, "tolerance": 0.02}
                for kind in ("mean", "standard deviation", "least", "largest", "equivalent load")
            ],
        },
    }
    return copy.deepcopy(content)  # a test may change links, which are constants here


def change(content: Content, key: str, value: Any) -> None:
    *path, last = key.split(".")
    target: Any = content
    for part in path:
        target = target[int(part) if part.isdigit() else part]
    target[int(last) if last.isdigit() else last] = value
