"""What results answer: a named quantity, held against the limit that a project states for it."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan

from fe_drivetrain.procedure.project import EvidenceLink
from fe_drivetrain.report.results import Figure, Results, Verdict


@dataclass(frozen=True)
class Answer:
    """A quantity of results against a limit.

    Attributes
    ----------
    quantity, unit : str
        As the results have them.
    computed : float
        Its value.
    band : float
        Half width of its numerical uncertainty; 0 where none is stated.
    loads : tuple of str
        Design loads that the results say it is a value of.
    at_most, at_least : float or None
        The limit.
    """

    quantity: str
    unit: str
    computed: float
    band: float
    loads: tuple[str, ...]
    at_most: float | None
    at_least: float | None

    @property
    def met(self) -> bool:
        """Whether the value keeps its limit with all of its band; a NaN does not."""
        low, high = self.computed - self.band, self.computed + self.band
        kept = self.at_most is None or high <= self.at_most
        held = self.at_least is None or low >= self.at_least
        return kept and held and not isnan(low)

    @property
    def value(self) -> str:
        """The value with its band and unit."""
        band = f" ± {self.band:.2g}" if self.band else ""
        return f"{self.computed:.5g}{band} {_unit(self.unit)}".strip()

    @property
    def asked(self) -> str:
        """The limit with its unit."""
        asked = [
            f"{side} {limit:.5g} {_unit(self.unit)}".strip()
            for side, limit in (("at most", self.at_most), ("at least", self.at_least))
            if limit is not None
        ]
        return " and ".join(asked) or "no limit"


def quantities_of(results: Results, drivetrain: str) -> list[Figure | Verdict]:
    """Answers and checks that are of a drivetrain, the answers first.

    Parameters
    ----------
    results : Results
        Results of one drivetrain or of several.
    drivetrain : str
        Its hash. What states no drivetrain is of the only one that there is.
    """
    alone = {record.hash for record in results.drivetrains} == {drivetrain}
    every: list[Figure | Verdict] = [*results.answers, *results.verdicts]
    return [one for one in every if one.of == drivetrain or (alone and not one.of)]


def answer_of(link: EvidenceLink, results: Results, drivetrain: str) -> Answer | None:
    """The quantity that a link names, with its limit; None where the results do not have it.

    Parameters
    ----------
    link : EvidenceLink
        With a quantity.
    results : Results
        Results of the case that it names.
    drivetrain : str
        Hash of the project's.
    """
    for one in quantities_of(results, drivetrain):
        if one.quantity == link.quantity and _unit(one.unit) == _unit(link.unit):
            loads = one.loads if isinstance(one, Figure) else ()
            band = one.band or 0.0
            return Answer(
                one.quantity, one.unit, one.computed, band, loads, link.at_most, link.at_least
            )
    return None


def _unit(text: str) -> str:
    """A unit as two files may write it: a pure number has "-" or none."""
    return "" if text == "-" else text
