"""What a case finds, in the order in which its page shows it: checks, sweeps, charts, words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Unpack, cast

import numpy as np

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.chart_parts import ChartParts
from fe_drivetrain.report.charts import chart, instead_of_chart, trace
from fe_drivetrain.report.error_chart import error_chart
from fe_drivetrain.report.results import (
    Cell,
    Chart,
    Image,
    Section,
    Solid,
    Table,
    Text,
)
from fe_drivetrain.report.suite.findings import Findings, Found
from fe_drivetrain.report.suite.records import (
    MeshSeries,
    Record,
    column,
    counted,
    curves,
    plain_cells,
    ring,
)
from fe_drivetrain.report.suite.targets import Target


class Look(ChartParts, total=False):
    """How the chart of a sweep looks; beside what every chart may show, see `ChartParts`.

    Attributes
    ----------
    log : str
        Which axes are logarithmic: "", "x", "y" or "xy".
    reference : dict
        Horizontal lines: name and value of y.
    safe : tuple
        Range of x that is shaded as safe.
    points : bool
        Points without lines.
    axis : str
        Title of the vertical axis, with its unit; the key of the first curve where left out.
    bands : dict
        Key of a curve, and that of its band, which is drawn as error bars.
    chosen : int
        Number of the record that is good enough: its points are marked.
    chosen_curve : str
        Name of the curve that was chosen: its points are drawn as large stars.
    """

    log: str
    reference: Mapping[str, float] | None
    safe: tuple[float | None, float | None] | None
    points: bool
    axis: str
    bands: Mapping[str, str]
    chosen: int
    chosen_curve: str


class Page(Findings):
    """Collects what a case finds, and how it is shown.

    Checks stand in a table of their own, whatever section is open; what else is added goes below
    the heading of the last `section`.

    Attributes
    ----------
    subject : str
        What a page is about, if the user gave it; empty where it is the case's own.
    topic : str
        What the page asks of it; empty where the case's title says that.
    sections : list of Section
        Headings, and what stands under them.
    """

    def __init__(self) -> None:
        super().__init__()
        self.subject = ""
        self.topic = ""
        self.sections: list[Section] = []

    def take(self, found: Found) -> None:
        """Show what a study has found, beside what the page has already.

        Parameters
        ----------
        found : Found
            Its answer, unless the page has one, numbers, checks, cautions, and what it is of.
        """
        self.answered = self.answered or found.answer
        self.sentences += found.details
        self.figures += found.figures
        self.checks += found.checks
        self.unsettled += found.unsettled
        self.skipped += found.skipped
        self.limits += found.limits
        self.assumptions += found.assumptions
        for sentence in found.notes:
            self.note(sentence)
        self.drivetrains += [one for one in found.drivetrains if one not in self.drivetrains]
        self.tables |= found.tables
        self.scene = found.scene or self.scene
        self.seed = found.seed

    def hero(self, caption: str) -> None:
        """Let a picture or chart of this page show the verdict, in place of the study's chart.

        Parameters
        ----------
        caption : str
            Caption of the picture.

        Raises
        ------
        RuntimeError
            The page has no answer.
        """
        if self.answered is None:
            raise RuntimeError(f"{caption!r} shows no verdict: the page has no answer")
        self.answered = self.answered.model_copy(update={"hero": caption})

    def section(self, title: str) -> None:
        """Begin a section; what is added from now on stands under its heading."""
        self.sections.append(Section(title=title, items=[]))

    def add(self, *items: Text | Table | Chart | Image | Solid) -> None:
        """Add to the section that was begun last; without one, to a section "Results"."""
        if not self.sections:
            self.section("Results")
        last = self.sections[-1]
        self.sections[-1] = Section(title=last.title, items=[*last.items, *items])

    def text(self, text: str) -> None:
        """Add a paragraph."""
        self.add(Text(text=text))

    def table(
        self,
        caption: str,
        rows: Sequence[Record] | Sequence[Sequence[Cell]],
        columns: Sequence[str] | None = None,
    ) -> None:
        """Add a table.

        Parameters
        ----------
        caption : str
            What it shows.
        rows : sequence of dict, or of sequences of cells
            Records, whose keys are the headings, with units; or plain rows.
        columns : sequence of str, optional
            Headings: of plain rows, or which keys of the records are shown; all of the first one's
            where left out.
        """
        if columns is None:
            first = rows[0] if rows else {}
            if not isinstance(first, Mapping):
                raise TypeError(f"table {caption!r}: rows without keys need columns")
            columns = list(first)
        cells = [
            [row.get(name) for name in columns] if isinstance(row, Mapping) else list(row)
            for row in rows
        ]
        self.add(
            Table(caption=caption, columns=list(columns), rows=[plain_cells(c) for c in cells])
        )

    def image(self, caption: str, file: str) -> None:
        """Add a PNG of the run's folder."""
        self.add(Image(caption=caption, file=file))

    def chart(
        self,
        caption: str,
        traces: Sequence[Any],
        x: str,
        y: str,
        logarithmic: Iterable[str] = (),
        safe: tuple[float | None, float | None] | None = None,
        **parts: Unpack[ChartParts],
    ) -> None:
        """Add a chart of traces, or a sentence if they have but one point; see `report.chart`."""
        if words := instead_of_chart(caption, traces, x, y):
            self.add(Text(text=words))
        else:
            self.add(chart(caption, traces, x, y, logarithmic, safe, **parts))

    def targets(
        self,
        caption: str,
        series: MeshSeries,
        targets: Sequence[Target],
        heading: str = "target",
        of: str = "",
    ) -> None:
        """Check the finest of several meshes against targets, and show all meshes beside them.

        Parameters
        ----------
        caption : str
            Of the table; the records stand under it among `figures`.
        series : MeshSeries
            What each mesh gave.
        targets : sequence of Target
            In the order of the checks.
        heading : str
            Of the targets' column.
        of : str
            Whose quantities they are, put before each of them in the checks.
        """
        self.finest(series, *targets, of=of)
        rows = []
        for target in targets:
            unit = target.key.partition(" [")[2]
            shown = f"{target.name} [{unit}" if target.name and unit else target.name
            rows.append((shown or target.key, target.key, target.value))
        meshes, by = series.rows, series.by
        columns = ["quantity", *(counted(mesh[by], by) for mesh in meshes), heading]
        cells = [[shown, *column(meshes, key), value] for shown, key, value in rows]
        self.table(caption, cells, columns)
        keys = [by, *dict.fromkeys(target.key for target in targets)]
        self.data(caption, [{key: mesh[key] for key in keys} for mesh in meshes])

    def errors(self, caption: str, figures: Sequence[KeyFigure]) -> None:
        """Add a chart of values against their references; see `report.error_chart`."""
        self.add(error_chart(caption, figures))

    def sweep(
        self,
        caption: str,
        rows: Sequence[Record],
        x: str,
        y: str | Mapping[str, str],
        *,
        by: str | None = None,
        table: Sequence[str] | bool = True,
        **look: Unpack[Look],
    ) -> None:
        """One list of records, of which chart, table and data are made.

        Parameters
        ----------
        caption : str
            What was varied, and what came of it; the records stand under it among `figures`.
        rows : sequence of dict
            One for each point, the same keys in each, with units in the keys; table and data take
            the keys of numbers and words, not of arrays.
        x : str
            Key of the horizontal axis.
        y : str or dict
            Key of the vertical axis; or of several curves the key of each, and its name.
        by : str, optional
            Key that tells the curves apart; of several `y` each has its own for every value.
        table : bool or sequence of str
            Whether there is a table, or which keys it shows.
        **look : object
            How the chart looks, see `Look`.
        """
        mode = "markers" if look.get("points") else "lines+markers"
        keys = {y: ""} if isinstance(y, str) else y
        traces = curves(rows, x, keys, by, mode, look.get("bands"))
        if "chosen" in look:
            traces.append(ring(rows[look["chosen"]], x, keys))
        for one in traces:
            if one["name"] == look.get("chosen_curve"):
                one["marker"] = {"size": 16, "symbol": "star"}
        ends = rounded([min(column(rows, x)), max(column(rows, x))])
        traces += [
            trace(name, ends, [value, value], line={"dash": "dot"})
            for name, value in (look.get("reference") or {}).items()
        ]
        axis = look.get("axis") or next(iter(keys))
        parts = cast(
            "ChartParts", {k: v for k, v in look.items() if k in ChartParts.__annotations__}
        )
        log, safe = tuple(look.get("log", "")), look.get("safe")
        self.chart(caption, traces, x, axis, log, safe, **parts)
        plain = [key for key, value in rows[0].items() if np.ndim(value) == 0]
        if table is not False:
            self.table("The same in numbers", rows, plain if table is True else table)
        self.data(caption, [{key: row[key] for key in plain} for row in rows])
