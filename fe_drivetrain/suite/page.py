"""What a case finds, in the order in which its page shows it: checks, sweeps, charts, words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from fe_drivetrain.report.charts import chart, instead_of_chart, rounded, trace
from fe_drivetrain.report.results import (
    AssumptionRow,
    Cell,
    Chart,
    DrivetrainRecord,
    Figure,
    Image,
    Limit,
    Section,
    Solid,
    Table,
    Text,
)
from fe_drivetrain.suite.checks import Checks
from fe_drivetrain.suite.records import (
    MeshSeries,
    Record,
    as_json,
    column,
    counted,
    curves,
    plain_cells,
)
from fe_drivetrain.suite.targets import Target, split_unit

if TYPE_CHECKING:
    from fe_drivetrain.report.seal import Described


OF_NONE = "none"
"""Stands for the hash of a drivetrain where a check is of a model that no file describes."""


class Page(Checks):
    """Collects what a case finds.

    Checks stand in a table of their own, whatever section is open; what else is added goes below
    the heading of the last `section`.

    Attributes
    ----------
    subject, source : str
        What a page is about, and from where, if the user gave it; empty where it is the case's own.
    notes : list of str
        What must be known before any figure, in sentences.
    unsettled : list of str
        Answers that have not converged, in sentences.
    verdicts : list of Verdict
        Of all checks so far.
    summary : list of str
        The answer, in sentences.
    answers : list of Figure
        Values that answer what was asked.
    sections : list of Section
        Headings, and what stands under them.
    limits : list of Limit
        Where methods fail.
    assumptions : list of AssumptionRow
        Values that the sources do not give.
    figures : dict
        Named numbers for other programs.
    scene, headline : str
        The scene as a file; quantity of the check that answers, or empty for the first value.
    drivetrains : list of DrivetrainRecord
        What the page is of, by `about`.
    skipped : list of str
        Checks that were not made, by `skip`.
    seed : int or None
        Of random numbers; None where there are none.
    """

    def __init__(self) -> None:
        super().__init__()
        self.subject = self.source = self.scene = self.headline = ""
        self.notes: list[str] = []
        self.unsettled: list[str] = []
        self.summary: list[str] = []
        self.answers: list[Figure] = []
        self.sections: list[Section] = []
        self.limits: list[Limit] = []
        self.assumptions: list[AssumptionRow] = []
        self.figures: dict[str, Any] = {}
        self.drivetrains: list[DrivetrainRecord] = []
        self.skipped: list[str] = []
        self.seed: int | None = 0

    def about(self, drivetrain: Described, name: str = "") -> None:
        """State what drivetrain the checks and answers from here on are of, by its hash.

        Parameters
        ----------
        drivetrain : Described
            A scene, machine or gear table, with all changes made; a scene is kept as a file, too.
        name : str
            As the results call it, where they are of several.
        """
        from fe_drivetrain.scene.reading import scene_text
        from fe_drivetrain.scene.scene import Scene

        self._of = self.concerns(drivetrain, name)
        if isinstance(drivetrain, Scene):
            self.scene = scene_text(drivetrain)

    @contextmanager
    def of(self, drivetrain: Described | None, name: str = "") -> Iterator[None]:
        """Let checks and answers within be of another drivetrain than those around them.

        Parameters
        ----------
        drivetrain : Described or None
            As for `about`; None of a model that no file describes, as one that a source prints.
        name : str
            As the results call it, where they are of several.
        """
        outside = self._of
        self._of = OF_NONE if drivetrain is None else self.concerns(drivetrain, name)
        try:
            yield
        finally:
            self._of = outside

    def concerns(self, drivetrain: Described, name: str = "") -> str:
        """State one of several drivetrains that the results compare; its hash.

        Parameters
        ----------
        drivetrain : Described
            A scene, machine or gear table, with all changes made.
        name : str
            As the results call it.
        """
        from fe_drivetrain.report.seal import drivetrain_record

        record = drivetrain_record(drivetrain, name)
        if record not in self.drivetrains:
            self.drivetrains.append(record)
        return record.hash

    def answer(self, *sentences: str) -> None:
        """The answer first: added to the summary on top of the page."""
        self.summary.extend(sentences)

    def found(
        self,
        quantity: str,
        value: float,
        band: float | None = None,
        loads: tuple[str, ...] = (),
    ) -> None:
        """A value that answers what was asked, and is not judged; `band` as for `equals`.

        Parameters
        ----------
        quantity : str
            With its unit.
        value, band : float
            In that unit.
        loads : tuple of str
            Design loads of the catalogue that it is a value of: `validate` holds it against a limit
            where a project names it for one of these.
        """
        quantity, unit = split_unit(quantity)
        figure = Figure(quantity=quantity, unit=unit, computed=value, band=band)
        self.answers.append(figure.model_copy(update={"of": self._of, "loads": loads}))

    def skip(self, check: str, why: str) -> None:
        """State that a check was not made; results with such a gap are no evidence of a project.

        Parameters
        ----------
        check : str
            Which, as its quantity.
        why : str
            As "NGSolve is not installed".
        """
        self.skipped.append(f"{check}: {why}")

    def note(self, sentence: str) -> None:
        """State, above all else, what must be known before any figure; the same sentence once."""
        if sentence not in self.notes:
            self.notes.append(sentence)

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
    ) -> None:
        """Add a chart of traces, or a sentence if they have but one point; see `report.chart`."""
        words = instead_of_chart(caption, traces, x, y)
        self.add(Text(text=words) if words else chart(caption, traces, x, y, logarithmic, safe))

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

    def sweep(
        self,
        caption: str,
        rows: Sequence[Record],
        x: str,
        y: str | Mapping[str, str],
        *,
        by: str | None = None,
        log: str = "",
        reference: Mapping[str, float] | None = None,
        safe: tuple[float | None, float | None] | None = None,
        points: bool = False,
        table: Sequence[str] | bool = True,
        axis: str = "",
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
        log : str
            Which axes are logarithmic: "", "x", "y" or "xy".
        reference : dict, optional
            Horizontal lines: name and value of y.
        safe : tuple, optional
            Range of x that is shaded as safe.
        points : bool
            Points without lines.
        table : bool or sequence of str
            Whether there is a table, or which keys it shows.
        axis : str
            Title of the vertical axis, with its unit; the key of the first curve where left out.
        """
        mode = "markers" if points else "lines+markers"
        keys = {y: ""} if isinstance(y, str) else y
        traces = curves(rows, x, keys, by, mode)
        ends = rounded([min(column(rows, x)), max(column(rows, x))])
        traces += [
            trace(name, ends, [value, value], line={"dash": "dot"})
            for name, value in (reference or {}).items()
        ]
        self.chart(caption, traces, x, axis or next(iter(keys)), tuple(log), safe)
        plain = [key for key, value in rows[0].items() if np.ndim(value) == 0]
        if table is not False:
            self.table("The same in numbers", rows, plain if table is True else table)
        self.data(caption, [{key: row[key] for key in plain} for row in rows])

    def data(self, name: str, value: Any) -> None:
        """Keep numbers for other programs in results.json, under a name with its unit."""
        self.figures[name] = as_json(value)

    def limit(self, method: str, parameter: str, **more: Any) -> None:
        """State how far a method can be trusted; `more` is the rest of `report.Limit`."""
        self.limits.append(Limit(method=method, parameter=parameter, **more))

    def assume(self, name: str, value: Cell, unit: str, source: str) -> None:
        """State a value that the sources do not give, and where it comes from."""
        self.assumptions.append(AssumptionRow(name=name, value=value, unit=unit, source=source))

    def assume_all(self, rows: Iterable[tuple[str, Cell, str, str]]) -> None:
        """State several such values, each as `assume` takes it."""
        for row in rows:
            self.assume(*row)
