"""Public functions take SI: what has another unit says so in its name (CONTRIBUTING, Rules)."""

import ast
import importlib
import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import BaseModel

ROOT = Path(__file__).parents[2] / "fe_drivetrain"
ROOMS = sorted(
    ".".join(file.parent.relative_to(ROOT).parts) for file in ROOT.glob("*/**/__init__.pyi")
)

ENDINGS = {
    "rpm": "_rpm",
    "1/min": "_rpm",
    "deg": "_deg",
    "deg/s": "_deg_s",
    "mm": "_mm",
    "um": "_um",
    "kN": "_kn",
    "MN": "_mn",
    "kN m": "_knm",
    "MPa": "_mpa",
    "GPa": "_gpa",
    "kW": "_kw",
    "MW": "_mw",
    "kg/h": "_kg_h",
    "h": "_h",
    "min": "_min",
    "%": "_percent",
}
"""How a name ends whose unit is not of the SI; temperatures are in degC everywhere."""


def public(room: str) -> Iterator[tuple[str, object]]:
    """What a room's face has, with the methods of its classes."""
    tree = ast.parse(ROOT.joinpath(*room.split("."), "__init__.pyi").read_text(encoding="utf-8"))
    module = importlib.import_module(f"fe_drivetrain.{room}")
    for node in tree.body:
        for alias in node.names if isinstance(node, ast.ImportFrom) else ():
            found = getattr(module, alias.asname or alias.name)
            yield alias.name, found
            if inspect.isclass(found):
                for name, member in vars(found).items():
                    if inspect.isfunction(member) and not name.startswith("_"):
                        yield f"{alias.name}.{name}", member


def stated_units(thing: object) -> Iterator[tuple[str, str]]:
    """Names of arguments and attributes, and every unit in brackets that their lines state."""
    if not callable(thing) or (inspect.isclass(thing) and issubclass(thing, BaseModel)):
        return  # keys of files, whose schema states them
    from numpydoc.docscrape import NumpyDocString  # not among what tests install

    said = NumpyDocString(inspect.getdoc(thing) or "")
    for section in ("Parameters", "Attributes"):
        for entry in said[section]:
            # what stands in quotes is an example of a title, like "BldPitch1 [deg]"
            text = re.sub(r'"[^"]*"', "", " ".join([entry.type, *entry.desc]))
            groups = re.findall(r"\[([^\]]*)\]", text)
            units = [unit.strip() for group in groups for unit in group.split(",")]
            names = [name.strip() for name in entry.name.split(",")]
            for k, name in enumerate(names):
                # "start, stop : ... [s] and [rpm]": one unit for each, or all for all
                own = [units[k]] if len(units) == len(names) else units
                for unit in own:
                    yield name, unit


def offences(room: str) -> list[str]:
    found = []
    for owner, thing in public(room):
        for name, unit in stated_units(thing):
            ending = ENDINGS.get(unit)
            if ending and not f"_{name}".lower().endswith(ending):
                found.append(f"{room}.{owner}: {name} [{unit}] should end with {ending}")
    return found


@pytest.fixture(autouse=True)
def reader_of_docstrings() -> None:
    """Skip where numpydoc, which the checks of the text install, is not there."""
    pytest.importorskip("numpydoc")


def test_a_unit_of_another_kind_is_found() -> None:
    def turned(speed: float, angle_deg: float, step: float) -> None:
        """Turn.

        Parameters
        ----------
        speed, step : float
            [rpm] and [s].
        angle_deg : float
            A title like "Azimuth [rpm]" [deg].
        """

    assert list(stated_units(turned)) == [("speed", "rpm"), ("step", "s"), ("angle_deg", "deg")]


@pytest.mark.parametrize("room", ROOMS)
def test_a_public_argument_is_of_the_si_or_names_its_unit(room: str) -> None:
    assert offences(room) == []
