"""What a case or a study finds, apart from how it is shown: answer, numbers, checks, cautions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Unpack

from fe_drivetrain.report.answer import Answer, Claim, KeyFigure, worst
from fe_drivetrain.report.results import (
    AssumptionRow,
    Cell,
    DrivetrainRecord,
    Figure,
    Limit,
    Verdict,
)
from fe_drivetrain.report.suite.checks import Checks
from fe_drivetrain.report.suite.key_figures import KeyLimit, in_unit, key_figure, limited
from fe_drivetrain.report.suite.records import as_json
from fe_drivetrain.report.suite.targets import split_unit

if TYPE_CHECKING:
    from fe_drivetrain.report.seal import Described


OF_NONE = "none"
"""Stands for the hash of a drivetrain where a check is of a model that no file describes."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Found:
    """What was found, complete.

    Attributes
    ----------
    answer : Answer
        The answer to what was asked.
    details : tuple of str
        What explains the answer, in sentences.
    figures : tuple of Figure
        Values that were found, with unit and band.
    checks : tuple of Verdict
        Checks that were made.
    notes, unsettled, skipped : tuple of str
        What must be known before any figure; answers that have not converged; checks that were not
        made. In sentences.
    tables : mapping of str to object
        All numbers, by name: most are lists of records, with units in their keys.
    limits : tuple of Limit
        Where methods fail.
    assumptions : tuple of AssumptionRow
        Values that nobody stated, and where they come from.
    drivetrains : tuple of DrivetrainRecord
        What it is of.
    options : mapping of str to object
        What was asked for, as plain data.
    scene : str
        The scene as a file; empty where there is none.
    seed : int or None
        Seed of random numbers; None where there are none.
    times : mapping of str to float
        Wall time of each step [s].
    """

    answer: Answer
    details: tuple[str, ...]
    figures: tuple[Figure, ...]
    checks: tuple[Verdict, ...]
    notes: tuple[str, ...]
    unsettled: tuple[str, ...]
    skipped: tuple[str, ...]
    tables: Mapping[str, Any]
    limits: tuple[Limit, ...]
    assumptions: tuple[AssumptionRow, ...]
    drivetrains: tuple[DrivetrainRecord, ...]
    options: Mapping[str, Any]
    scene: str
    seed: int | None
    times: Mapping[str, float]

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)


class Findings(Checks):
    """Collects what is found, under the names that it has in `Found`.

    Attributes
    ----------
    notes : list of str
        What must be known before any figure, in sentences.
    unsettled : list of str
        Answers that have not converged, in sentences.
    checks : list of Verdict
        Checks so far.
    sentences : list of str
        The answer, which `answer` adds to.
    figures : list of Figure
        Values that answer what was asked.
    limits : list of Limit
        Where methods fail.
    assumptions : list of AssumptionRow
        Values that the sources do not give.
    tables : dict
        Named numbers for other programs.
    scene : str
        The scene as a file.
    drivetrains : list of DrivetrainRecord
        What the findings are of, by `about`.
    skipped : list of str
        Checks that were not made, by `skip`.
    seed : int or None
        Seed of random numbers; None where there are none.
    """

    def __init__(self) -> None:
        super().__init__()
        self.scene = ""
        self.notes: list[str] = []
        self.unsettled: list[str] = []
        self.answered: Answer | None = None
        self.sentences: list[str] = []
        self.figures: list[Figure] = []
        self.limits: list[Limit] = []
        self.assumptions: list[AssumptionRow] = []
        self.tables: dict[str, Any] = {}
        self.drivetrains: list[DrivetrainRecord] = []
        self.skipped: list[str] = []
        self.seed: int | None = 0

    def frozen(self, times: Mapping[str, float], **options: Any) -> dict[str, Any]:
        """All that was found, as the fields of `Found`.

        Parameters
        ----------
        times : mapping of str to float
            Wall time of each step [s].
        **options : object
            What was asked for.

        Raises
        ------
        RuntimeError
            No answer was given.
        """
        if self.answered is None:
            raise RuntimeError("what was found has no answer: call `answer` before `frozen`")
        return {
            "answer": self.answered,
            "details": tuple(self.sentences),
            "figures": tuple(self.figures),
            "checks": tuple(self.checks),
            "notes": tuple(self.notes),
            "unsettled": tuple(self.unsettled),
            "skipped": tuple(self.skipped),
            "tables": MappingProxyType(dict(self.tables)),
            "limits": tuple(self.limits),
            "assumptions": tuple(self.assumptions),
            "drivetrains": tuple(self.drivetrains),
            "options": MappingProxyType(as_json(options)),
            "scene": self.scene,
            "seed": self.seed,
            "times": MappingProxyType(dict(times)),
        }

    def about(self, drivetrain: Described, name: str = "") -> None:
        """State what drivetrain the checks and answers from here on are of, by its hash.

        Parameters
        ----------
        drivetrain : Described
            A drivetrain's file or what is made of it, with all changes made; a file is kept as one.
        name : str
            As the results call it, where they are of several.
        """
        from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
        from fe_drivetrain.drivetrain_file.reading import scene_text

        self._of = self.concerns(drivetrain, name)
        if isinstance(drivetrain, Drivetrain):
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
            A drivetrain's file or what is made of it, with all changes made.
        name : str
            As the results call it.
        """
        from fe_drivetrain.report.seal import drivetrain_record

        record = drivetrain_record(drivetrain, name)
        if record not in self.drivetrains:
            self.drivetrains.append(record)
        return record.hash

    def answer(
        self,
        question: str,
        verdict: str,
        figures: Sequence[KeyFigure],
        hero: str = "",
        cautions: Sequence[str] = (),
        claim: Claim = "",
    ) -> None:
        """The answer to what was asked: what page, terminal, JSON and index show first.

        Parameters
        ----------
        question : str
            In the words of the user, with a question mark.
        verdict : str
            One sentence of at most 25 words: subject, number with unit, what follows from it. What
            is wrong or cannot be used says so here.
        figures : sequence of KeyFigure
            Three to six of `judged` and `value`, that which answers first. A check of the program
            on itself is none.
        hero : str
            Caption of the chart or picture of the page that shows the verdict.
        cautions : sequence of str
            What limits the verdict, most severe first, in sentences.
        claim : str
            How a statement of the source stands: "holds", "holds in part", "does not hold"; the
            verdict says it, too. Empty where no statement was tested.
        """
        figures = list(figures)
        self.answered = Answer(
            question=question,
            verdict=verdict,
            figures=figures,
            hero=hero,
            cautions=list(cautions),
            claim=claim,
            status=worst(figures, claim),
        )

    def say(self, *sentences: str) -> None:
        """Explain the answer: sentences that stand below it."""
        self.sentences.extend(sentences)

    def judged(
        self, quantity: str, name: str = "", by: str = "", printed: str = "", unit: str = ""
    ) -> KeyFigure:
        """A key figure that is a check or a value of these findings, so that it stands once.

        Parameters
        ----------
        quantity : str
            Quantity of the check, or of the value by `found`, without its unit.
        name : str
            In the words of the reader; the quantity where left out.
        by : str
            Whose reference it is, in a word or two, as in "NAFEMS", "closed form", "thesis".
        printed : str
            The reference as its source prints it, as in "727.0".
        unit : str
            In which it is shown, where people use another: "GN/m" of a check in N/m; "%" of a
            share.

        Returns
        -------
        KeyFigure

        Raises
        ------
        KeyError
            There is no such check or value, or there are several.
        ValueError
            The unit is not that of the check with another prefix.
        """
        every: list[Figure | Verdict] = [*self.figures, *self.checks]
        found = [one for one in every if one.quantity == quantity]
        if len(found) != 1:
            known = ", ".join(repr(one.quantity) for one in every)
            raise KeyError(f"{quantity!r} stands {len(found)} times among: {known}")
        figure = key_figure(found[0], name, by, printed)
        return in_unit(figure, unit) if unit else figure

    def value(
        self, name: str, value: float, band: float | None = None, **limit: Unpack[KeyLimit]
    ) -> KeyFigure:
        """A key figure that no check or value of these findings is.

        Parameters
        ----------
        name : str
            What it is, with its unit: "peak roller load [kN]"; a pure number has none.
        value, band : float
            In that unit; `band` as for `equals`.
        **limit : object
            At most one of ``at_most``, ``at_least``, ``between`` (a pair), which judge the value,
            and ``beside``, another's value to compare with; ``by``: whose it is, in a word or
            two; ``printed``: the limit as its source prints it.

        Returns
        -------
        KeyFigure
        """
        quantity, unit = split_unit(name)
        return limited(quantity, unit, value, band, **limit)

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
        self.figures.append(figure.model_copy(update={"of": self._of, "loads": loads}))

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

    def note(self, sentence: str, first: bool = False) -> None:
        """State what must be known before any figure; the same sentence once.

        Parameters
        ----------
        sentence : str
            The caution.
        first : bool
            Whether it stands before all others: what was given does not belong together, or is not
            used.
        """
        if sentence not in self.notes:
            self.notes.insert(0 if first else len(self.notes), sentence)

    def data(self, name: str, value: Any) -> None:
        """Keep numbers for other programs in results.json, under a name with its unit."""
        self.tables[name] = as_json(value)

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
