"""Checks of a case: a computed value against a reference or a bound, with the reason."""

from __future__ import annotations

from typing import Any

from fe_drivetrain.report.results import Basis, Measure, Verdict, judge
from fe_drivetrain.report.suite.records import MeshSeries
from fe_drivetrain.report.suite.targets import MEASURES, Target, split_unit


class Checks:
    """Collects the checks of a case.

    Attributes
    ----------
    verdicts : list of Verdict
        Of all checks so far.
    """

    def __init__(self) -> None:
        self.verdicts: list[Verdict] = []
        self._of = ""

    def equals(
        self,
        quantity: str,
        computed: float,
        reference: float,
        *,
        within: float,
        why: str,
        source: str,
        unit: str = "",
        relative: bool = True,
        measure: Measure | None = None,
        basis: Basis = "independent",
        band: float | None = None,
    ) -> None:
        """The computed value is the reference, within a tolerance.

        Parameters
        ----------
        quantity : str
            What was computed, with its unit: "deflection [mm]"; a pure number has none.
        computed, reference : float
            In that unit.
        within : float
            Allowed difference, relative to the reference.
        why : str
            Why the tolerance is what it is: a physical or numerical reason.
        source : str
            Where the reference comes from.
        unit : str
            Of both, where the quantity is stated without it.
        relative : bool
            False where `within` is in the unit.
        measure : str, optional
            Kind of quantity, for bias and scatter over all cases; that of the unit in brackets
            where left out.
        basis : str
            "self-consistency" of what is true by construction, "second-hand" of a source that was
            not read itself: both are shown as such, and stay out of bias and scatter.
        band : float, optional
            Half width of the numerical uncertainty of `computed`, in its unit. It is computed, from
            a series of meshes or an error estimate; where there is none, it is left out.
        """
        self._judge(
            "equals",
            quantity,
            computed,
            reference,
            why,
            source,
            tolerance=within,
            relative=relative,
            unit=unit,
            measure=measure,
            basis=basis,
            band=band,
        )

    def vanishes(
        self,
        quantity: str,
        computed: float,
        *,
        within: float,
        why: str,
        source: str,
        unit: str = "",
        measure: Measure | None = "identity",
        basis: Basis = "independent",
        band: float | None = None,
    ) -> None:
        """The computed value is zero, but for `within`, in its unit; see `equals`."""
        self._judge(
            "vanishes",
            quantity,
            computed,
            0.0,
            why,
            source,
            tolerance=within,
            relative=False,
            unit=unit,
            measure=measure,
            basis=basis,
            band=band,
        )

    def finest(self, series: MeshSeries, *targets: Target, of: str = "") -> None:
        """The finest of several meshes meets targets; the band of each value is that of them all.

        Parameters
        ----------
        series : MeshSeries
            What each mesh gave.
        *targets : Target
            What the finest should give.
        of : str
            Whose quantities they are, put before each of them: "solid shaft".
        """
        for target in targets:
            band = series.band(target.key, target.order)
            self.meets(series.last[target.key], target, band, of)

    def settled(self, series: MeshSeries, *targets: Target, of: str = "") -> None:
        """Check the finest mesh as `finest` does, but the band is the change from the mesh before.

        For what has no steady order of convergence, as the largest error of a field.
        """
        for target in targets:
            self.meets(series.last[target.key], target, series.change(target.key), of)

    def meets(
        self, computed: float, target: Target, band: float | None = None, of: str = ""
    ) -> None:
        """The computed value meets a target; `band` as for `equals`, `of` as for `finest`."""
        quantity, unit = split_unit(target.key)
        quantity = target.name or quantity
        zero = target.value == 0.0
        self._judge(
            "vanishes" if zero else "equals",
            f"{of}: {quantity}" if of else quantity,
            computed,
            target.value,
            target.why,
            target.source,
            tolerance=target.within,
            relative=target.relative and not zero,
            unit=unit,
            measure=target.measure or MEASURES.get(unit) or ("identity" if zero else None),
            basis=target.basis,
            band=band,
        )

    def at_most(
        self, quantity: str, computed: float, bound: float, *, why: str, source: str, **more: Any
    ) -> None:
        """The computed value is no larger than a bound; `more` is unit, measure, basis, band."""
        self._judge("at most", quantity, computed, bound, why, source, **more)

    def at_least(
        self, quantity: str, computed: float, bound: float, *, why: str, source: str, **more: Any
    ) -> None:
        """The computed value is no smaller than a bound; `more` is unit, measure, basis, band."""
        self._judge("at least", quantity, computed, bound, why, source, **more)

    def between(
        self,
        quantity: str,
        computed: float,
        low: float,
        high: float,
        *,
        why: str,
        source: str,
        **more: Any,
    ) -> None:
        """The computed value is no smaller than `low`, and no larger than `high`."""
        self._judge("between", quantity, computed, low, why, source, upper=high, **more)

    def holds(
        self,
        statement: str,
        condition: bool,
        *,
        why: str,
        source: str,
        basis: Basis = "independent",
    ) -> None:
        """A statement is true.

        Parameters
        ----------
        statement : str
            In words, as a sentence that is true or false.
        condition : bool
            Whether it is.
        why : str
            What would follow if it were not.
        source : str
            Where the statement comes from.
        basis : str
            As of `equals`.
        """
        truth = float(bool(condition))
        self._judge("holds", statement, truth, 1.0, why, source, measure="identity", basis=basis)

    def _judge(
        self,
        check: Any,
        quantity: str,
        computed: float,
        reference: float,
        why: str,
        source: str,
        tolerance: float = 0.0,
        relative: bool = False,
        unit: str = "",
        measure: Measure | None = None,
        **more: Any,
    ) -> None:
        if not unit:
            quantity, unit = split_unit(quantity)
            measure = measure or MEASURES.get(unit)
        self.verdicts.append(
            judge(
                quantity,
                computed,
                reference,
                check=check,
                tolerance=tolerance,
                relative=relative,
                reason=why,
                source=source,
                unit=unit,
                measure=measure,
                of=self._of,
                **more,
            )
        )
