"""The six steps of PROTEST 2010 (section 3) as a log: visits, loops back, and when it is complete.

Steps may be taken in any order so long as each is taken once; going back is a loop, and is
logged with the reason. A procedure is complete only when each step was taken, with evidence or a
decision.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from fe_drivetrain.common.errors import InputError

STEPS = (
    "critical failure modes and design variables",
    "model and its level of detail",
    "load cases",
    "inputs, and how certain each is",
    "measurement campaign",
    "processing, comparison, improvement",
)


@dataclass(frozen=True)
class Evidence:
    """What a decision rests on.

    Attributes
    ----------
    case : str
        As in "procedure/identification".
    quantity : str
        Quantity of one of its checks.
    passed : bool
        Its verdict.
    band : float or None
        Numerical uncertainty of the computed value, in its unit; None where there is none.
    """

    case: str
    quantity: str
    passed: bool
    band: float | None = None


@dataclass(frozen=True)
class Visit:
    """A step, taken once.

    Attributes
    ----------
    step : int
        From 1 to 6.
    decision : str
        What came of it, or why it is taken again.
    evidence : tuple of Evidence
        What that rests on.
    """

    step: int
    decision: str
    evidence: tuple[Evidence, ...] = ()

    def __post_init__(self) -> None:
        if not 1 <= self.step <= len(STEPS):
            raise InputError(f"step {self.step} is not one of 1 to {len(STEPS)}: give one of these")
        if not self.decision.strip():
            raise InputError(
                f"step {self.step} ({STEPS[self.step - 1]}) has no decision: state in words what "
                "came of it"
            )


@dataclass(frozen=True)
class Procedure:
    """A procedure so far.

    Attributes
    ----------
    subject : str
        As in "drivetrain of turbine 12".
    visits : tuple of Visit
        In their order.
    """

    subject: str
    visits: tuple[Visit, ...] = ()

    def after(self, visit: Visit) -> Procedure:
        """The procedure with one more visit.

        Parameters
        ----------
        visit : Visit
            Visit of any step.
        """
        return replace(self, visits=(*self.visits, visit))

    @property
    def missing(self) -> tuple[int, ...]:
        """Steps that were not taken."""
        taken = {visit.step for visit in self.visits}
        return tuple(step for step in range(1, len(STEPS) + 1) if step not in taken)

    @property
    def loops(self) -> tuple[tuple[int, int, str], ...]:
        """Each time it went back: from which step, to which, and why."""
        pairs = zip(self.visits[:-1], self.visits[1:], strict=True)
        return tuple((a.step, b.step, b.decision) for a, b in pairs if b.step <= a.step)

    @property
    def failed(self) -> tuple[tuple[int, Evidence], ...]:
        """Evidence that did not pass in the last visit of its step."""
        last = {visit.step: visit for visit in self.visits}
        return tuple(
            (step, found)
            for step, visit in sorted(last.items())
            for found in visit.evidence
            if not found.passed
        )


def require_complete(procedure: Procedure) -> None:
    """Refuse a procedure in which a step was not taken, or the last evidence of one did not pass.

    Parameters
    ----------
    procedure : Procedure
        To be signed.

    Raises
    ------
    InputError
        Names the steps.
    """
    if procedure.missing:
        names = ", ".join(f"{step} ({STEPS[step - 1]})" for step in procedure.missing)
        raise InputError(
            f"{procedure.subject!r} is not complete: steps {names} were not taken: take them"
        )
    if procedure.failed:
        step, found = procedure.failed[0]
        raise InputError(
            f"{procedure.subject!r} is not complete: in step {step} {found.case}, "
            f"{found.quantity!r} did not pass: improve model or campaign, and take the step again"
        )
