"""A superelement of another program or hand: what is wrong in it is named, within limits."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tiny_case import Result

from fe_drivetrain import export
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.export.formats.superelement_json import read
from fe_drivetrain.export.limited_reading import read_limited
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.foreign.reading import LIMITS

#: A strut of 2 m between two points, free: bar, twisted bar, and beam of Euler and Bernoulli.
LENGTH, EA, EI, GI = 2.0, 1e9, 1e7, 8e6


def strut() -> Superelement:
    K = np.zeros((12, 12))
    for first, k in ((0, EA / LENGTH), (3, GI / LENGTH)):
        K[np.ix_([first, first + 6], [first, first + 6])] += k * np.array([[1, -1], [-1, 1]])
    a, b, c, d = (EI * f for f in (12 / LENGTH**3, 6 / LENGTH**2, 4 / LENGTH, 2 / LENGTH))
    for places, s in (([1, 5, 7, 11], 1.0), ([2, 4, 8, 10], -1.0)):
        rows = [[a, s * b, -a, s * b], [s * b, c, -s * b, d]]
        rows += [[-a, -s * b, a, -s * b], [s * b, d, -s * b, c]]
        K[np.ix_(places, places)] += np.array(rows)
    return Superelement("strut", ("bore", "foot"), np.array([[0, 0, 0], [LENGTH, 0, 0.0]]), K)


@pytest.fixture
def content(tmp_path: Path) -> dict[str, Any]:
    export.write_superelement(tmp_path / "sound.json", strut(), "json")
    found: dict[str, Any] = json.loads((tmp_path / "sound.json").read_text())
    return found


def changed(*keys: str | int, to: Any) -> Callable[[dict[str, Any]], None]:
    def change(content: dict[str, Any]) -> None:
        *path, last = keys
        inner: Any = content
        for key in path:
            inner = inner[key]
        inner[last] = to(inner[last]) if callable(to) else to

    return change


def scaled(factor: float) -> Callable[[list[list[float]]], list[list[float]]]:
    return lambda rows: [[factor * value for value in row] for row in rows]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (changed("stiffness", 2, to=lambda row: row[:-1]), "stiffness: row 3 has 11 values but"),
        (changed("stiffness", to=lambda rows: rows[:-1]), r"its stiffness of shape \(11, 12\)"),
        (changed("stiffness", to=[]), r"its stiffness of shape \(0,\) must be \(12, 12\)"),
        (changed("stiffness", 2, 3, to=float("nan")), "stiffness.2.3 is nan but must be a finite"),
        (changed("stiffness", 2, 3, to=float("inf")), "stiffness.2.3 is inf but must be a finite"),
        (changed("stiffness", 2, 2, to=True), "stiffness.2.2 is True but must be a number"),
        (changed("stiffness", 2, 2, to="1e9"), "stiffness.2.2 is .*1e9.* but must be a number"),
        (changed("stiffness", 0, 1, to=1e9), "its stiffness is not symmetric"),
        (changed("stiffness", to=scaled(-1.0)), "its stiffness has a negative eigenvalue"),
        (changed("stiffness", 2, 2, to=10**400), "stiffness.2.2"),
        (changed("mass", to=[[1.0, 2.0], [1.0]]), "mass: row 2 has 1 values but must have 2"),
        (changed("mass", to=[[1.0]]), r"its mass of shape \(1, 1\) must be \(12, 12\)"),
        (changed("positions", 1, 0, to=float("nan")), "positions.1.0 is nan but must be a finite"),
        (changed("positions", 1, 0, to=float("-inf")), "positions.1.0 is -inf but must be"),
        (changed("positions", 1, to=[0.0, 0.0]), r"positions.1.2 .* is missing"),
        (
            changed("positions", to=scaled(1e3)),
            r"position of foot is \(2000, 0, 0\) .* give metres",
        ),
        (changed("positions", to=scaled(25.4)), "resists a rigid motion .* are in metres"),
        (changed("positions", to=lambda p: p[:1]), r"positions of shape \(1, 3\) for the points"),
        (changed("points", to=["bore", "bore"]), "give each point once"),
        (changed("band", to=-1), "its band is axial -1.0, .* must be from 0 on"),
        (changed("band", to=float("nan")), "band is nan but must be a finite number"),
        (changed("band", to=True), "band is True but must be a number"),
        (changed("band", to={"axial": 0.1, "bending": 0.1}), "band.torsion .* is missing: add it"),
        (
            changed("band", to={"axial": 0.1, "torsion": True, "bending": 0.1}),
            "band.torsion is True but must be a number",
        ),
        (changed("units", to="N/mm; t; mm"), "units is .*N/mm; t; mm.* but must be"),
        (changed("frame", to="z up"), "frame is .*z up.* but must be"),
        (changed("degrees_of_freedom", to=lambda f: f[::-1]), "degrees_of_freedom is"),
        (changed("supported", to="maybe"), "supported"),
        (changed("schema_version", to=4), "schema_version is 4 but must be 1, 2 or 3"),
        (changed("stiff", to=1), "unknown key 'stiff'"),
        (lambda content: content.pop("stiffness"), "stiffness is missing: add it"),
    ],
)
def test_what_is_wrong_in_json_is_named_by_its_key(
    tmp_path: Path,
    content: dict[str, Any],
    change: Callable[[dict[str, Any]], None],
    says: str,
) -> None:
    change(content)
    file = tmp_path / "changed.json"
    file.write_text(json.dumps(content))
    with pytest.raises(InputError, match=says) as refused:
        read(file)
    assert len(str(refused.value)) < 600


@pytest.mark.parametrize("text", ["", "[1", "[]", "null", "\x00", "[" * 100_000, '{"a": 1}'])
def test_what_is_no_json_of_ours_is_one_sentence(tmp_path: Path, text: str) -> None:
    file = tmp_path / "x.json"
    file.write_text(text)
    with pytest.raises(InputError, match="is no superelement in JSON") as refused:
        read(file)
    assert len(str(refused.value)) < 600


def test_the_limited_process_hands_back_the_superelement_to_the_last_bit(tmp_path: Path) -> None:
    element = replace(strut(), mass=np.eye(12), band=StiffnessBands(0.1, 0.02, 0.3))
    export.write_superelement(tmp_path / "one.json", element, "json")
    found = read_limited(tmp_path / "one.json", "json")
    assert found.stiffness.tobytes() == element.stiffness.tobytes()
    assert found.positions.tobytes() == element.positions.tobytes()
    assert found.mass is not None
    assert found.mass.tobytes() == np.eye(12).tobytes()
    same = ("name", "points", "supported", "band", "origin")
    assert [getattr(found, key) for key in same] == [getattr(element, key) for key in same]


def test_reading_takes_no_more_than_its_limits(tmp_path: Path) -> None:
    file = tmp_path / "one.json"
    export.write_superelement(file, strut(), "json")
    with pytest.raises(InputError, match="bytes but must have 1 to 100"):
        read_limited(file, "json", replace(LIMITS, file=100))
    # two million times the smallest number: 6 MB of text, far more once it is read
    rows = ", ".join(["[" + ", ".join(["0"] * 1000) + "]"] * 2000)
    file.write_text(file.read_text().replace('"stiffness": [', f'"stiffness": [{rows},', 1))
    with pytest.raises(InputError, match=r"one\.json (takes more than|makes its reader fail)"):
        read_limited(file, "json", replace(LIMITS, memory=150_000_000))


def test_the_command_names_what_is_wrong(
    invoke: Callable[..., Result], tmp_path: Path, content: dict[str, Any]
) -> None:
    content["stiffness"][4].pop()
    (tmp_path / "ragged.json").write_text(json.dumps(content))
    words = ("--bore", "bore", "--held", "foot")
    status, out, err = invoke("part", "ragged.json", *words)
    assert (status, out) == (2, "")
    assert err.splitlines()[-1] == (
        "fe-drivetrain: ragged.json is no superelement in JSON: stiffness: row 5 has 11 values but "
        "must have 12, as row 1 has: write it whole"
    )
    status, out, err = invoke("part", "sound.json", *words)
    assert (status, err) == (0, "read ...\n")
    assert f"- [{EA / LENGTH:.15e}, " in out
