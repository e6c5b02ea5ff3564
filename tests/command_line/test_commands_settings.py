"""Values of --set, --load and --tolerance, and options as one record."""

import re
from dataclasses import dataclass
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from fe_drivetrain.command_line.options import left_out, with_options
from fe_drivetrain.command_line.settings import parse_loads, parse_settings, parse_tolerance
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.shafts.response.model import LOADS


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e6", 1e6),
        ("-2.5E-3", -2.5e-3),
        ("4", 4),
        (".5", 0.5),
        ("010", 10.0),
        ("true", True),
        ("null", None),
        ("", None),
        ("rigid", "rigid"),
        ("'1e6'", "1e6"),
        ("a=b", "a=b"),
        ("12:30", "12:30"),
        ("2026-01-31", "2026-01-31"),
        ("runs/*.outb", "runs/*.outb"),
        ("[4e6, 8e7, rigid, [0]]", [4e6, 8e7, "rigid", [0]]),
    ],
)
def test_settings_are_numbers_words_and_lists(text: str, value: object) -> None:
    parsed = parse_settings([f"key.0.name={text}"])
    assert parsed == {"key.0.name": value}
    assert isinstance(parsed["key.0.name"], type(value))


def test_a_file_pattern_is_a_word() -> None:
    """To YAML a leading asterisk is an alias; to a user it is all files."""
    assert parse_settings(["loads=*.csv", "mesh.shaft=1e-1"]) == {
        "loads": "*.csv",
        "mesh.shaft": 0.1,
    }


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["k"], "--load 'k' must be KEY=VALUE: write it as in --load gearbox.weight=4e5"),
        (["hub.Fq=1"], "--load 'hub.Fq' is unknown: use one of hub.Fx"),
        (["hub.Fz=large"], "--load hub.Fz: 'large' must be a number"),
        (["hub.Fz=true"], "--load hub.Fz: True must be a number"),
        (["hub.Fz=.nan"], "must be a number"),
        (["hub.Fz=0", "hub.My=0"], "all loads are zero"),
        (["hub.Fz=1", "hub.Fz=2"], "--load hub.Fz is given twice, but must be given once"),
    ],
)
def test_wrong_loads_are_refused(texts: list[str], message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        parse_loads(texts, LOADS)


def test_of_a_setting_that_is_given_twice_the_last_counts() -> None:
    assert parse_settings(["mesh.shaft=0.1", "mesh.shaft=0.2"]) == {"mesh.shaft": 0.2}


def test_loads_are_numbers_by_name() -> None:
    assert parse_loads([], LOADS) is None
    found = parse_loads(["gearbox.weight=4", "hub.Fz=-2e5"], LOADS)
    assert found == {"gearbox.weight": 4.0, "hub.Fz": -2e5}


@pytest.mark.parametrize(("text", "share"), [("1%", 0.01), ("0.05", 0.05), ("2.5 %", 0.025)])
def test_a_tolerance_is_a_share(text: str, share: float) -> None:
    assert parse_tolerance(text) == pytest.approx(share, rel=1e-15)


@pytest.mark.parametrize(
    "text", ["", "%", "much", "0", "100%", "1", "-1%", "5%%", "5% of it", "nan"]
)
def test_a_tolerance_is_between_0_and_100_percent(text: str) -> None:
    with pytest.raises(InputError, match="must be between 0 and 100 %"):
        parse_tolerance(text)


@dataclass(frozen=True)
class Asked:
    name: Annotated[str, typer.Argument(metavar="NAME", help="Whom to greet.")]
    count: Annotated[int, typer.Option("--count", min=1, help="How often.")] = 2


@with_options(Asked)
def greet(context: typer.Context, asked: Asked) -> int:
    """Greet somebody."""
    if asked.name == "nobody":
        raise InputError("nobody is there: name somebody")
    typer.echo(f"{asked}, by default: {left_out(context, 'count')}")
    return asked.count


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (["Ann"], 2, "Asked(name='Ann', count=2), by default: True"),
        (["Ann", "--count", "1"], 1, "Asked(name='Ann', count=1), by default: False"),
        (["Ann", "--count", "0"], 2, "--count"),
        (["nobody", "--count", "1"], 2, "fe-drivetrain: nobody is there: name somebody"),
        (["--help"], 0, "Greet somebody."),
        ([], 2, "NAME"),
    ],
)
def test_a_command_takes_its_options_as_one_record(
    words: list[str], status: int, said: str
) -> None:
    app = typer.Typer()
    app.command()(greet)
    found = CliRunner().invoke(app, words)
    assert found.exit_code == status
    assert said in found.output
