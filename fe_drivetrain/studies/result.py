"""What every study returns: numbers with units and bands, answer, checks, and what they are of."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, ClassVar

from pydantic import BaseModel

from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.report.results import Chart, Figure
from fe_drivetrain.report.suite.findings import Found
from fe_drivetrain.report.suite.records import strict_json

if TYPE_CHECKING:
    import pandas as pd
    import plotly.graph_objects as go


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Result(Found):
    """What a study found.

    `answer` is the answer, ``result["L10mr of bearing front"]`` a figure, `to_frame` a table,
    `plot` the chart that answers; `to_json` holds all of it for other programs. Samples of
    histories are not in it.
    """

    STUDY: ClassVar[str] = ""
    """Name of the study, in the schema of its JSON."""
    SCHEMA_VERSION: ClassVar[int] = 2
    """Raised where a key of the JSON changes its meaning, or goes."""

    def __post_init__(self) -> None:
        """Let the chart show the verdict where the answer names no other picture."""
        if not self.answer.hero:
            shown = self.answer.model_copy(update={"hero": self.chart().caption})
            object.__setattr__(self, "answer", shown)

    def __getitem__(self, quantity: str) -> Figure:
        """The figure of that name; KeyError where there is none, with the names that there are."""
        for figure in self.figures:
            if figure.quantity == quantity:
                return figure
        known = ", ".join(repr(figure.quantity) for figure in self.figures) or "none"
        raise KeyError(f"{quantity!r} is no figure of this result; its figures are: {known}")

    def __repr__(self) -> str:
        """One line: what it is of, the verdict, and how its checks stand."""
        of = " and ".join(dict.fromkeys(one.title for one in self.drivetrains))
        passed = sum(check.passed for check in self.checks)
        parts = [f"{self.STUDY} of {of}" if of else self.STUDY]
        parts.append(self.answer.verdict.removesuffix("."))
        parts += [f"{passed} of {len(self.checks)} checks pass"] if self.checks else []
        return f"<{'; '.join(parts)}>"

    def to_dict(self) -> dict[str, Any]:
        """The content of `to_json` as plain data; NaN and infinity as strings."""
        return {
            "schema": f"fe-drivetrain/{self.STUDY}/{self.SCHEMA_VERSION}",
            "version": version("fe-drivetrain"),
            "drivetrains": _models(self.drivetrains),
            "options": strict_json(self.options),
            "answer": strict_json(self.answer.model_dump()),
            "details": list(self.details),
            "figures": _models(self.figures),
            "checks": _models(self.checks),
            "notes": list(self.notes),
            "unsettled": list(self.unsettled),
            "skipped": list(self.skipped),
            "assumptions": _models(self.assumptions),
            "limits": _models(self.limits),
            "tables": strict_json(self.all_tables()),
            "seed": self.seed,
            "times": dict(self.times),
        }

    def to_json(self) -> str:
        """All of it for other programs, as JSON with the schema's name and version in it."""
        return json.dumps(self.to_dict(), ensure_ascii=False, indent=1, allow_nan=False)

    def to_frame(self, table: str = "") -> pd.DataFrame:
        """A table as a pandas frame; without a name the figures.

        Parameters
        ----------
        table : str
            A name of `frames` that holds records.

        Raises
        ------
        MissingToolError
            pandas is not installed.
        InputError
            There is no such table of records.
        """
        try:
            import pandas as pd
        except ModuleNotFoundError as error:
            raise MissingToolError(
                'to_frame needs pandas: install it with pip install "fe-drivetrain[frames]"'
            ) from error
        if not table:
            columns = ["quantity", "computed", "band", "unit"]
            return pd.DataFrame([one.model_dump() for one in self.figures], columns=columns)
        tables = self.frames()
        rows = tables.get(table)
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            known = [name for name, value in tables.items() if isinstance(value, list)]
            raise InputError(f"{table!r} is no table: choose of {', '.join(known) or 'none'}")
        return pd.DataFrame(rows)

    def all_tables(self) -> Mapping[str, Any]:
        """Tables by name: those of the page, and of some studies longer ones."""
        return self.tables

    def frames(self) -> Mapping[str, Any]:
        """Tables that `to_frame` gives, by name: those of `all_tables`, and longer ones."""
        return self.all_tables()

    def chart(self) -> Chart:
        """The chart that shows the answer, as its page has it."""
        raise NotImplementedError

    def plot(self) -> go.Figure:
        """The chart that shows the answer, as a Plotly figure."""
        import plotly.graph_objects as go

        chart = self.chart()
        return go.Figure(chart.figure).update_layout(title={"text": chart.caption})


def _models(records: Iterable[BaseModel]) -> list[Any]:
    """Records as plain JSON data."""
    return [strict_json(one.model_dump()) for one in records]
