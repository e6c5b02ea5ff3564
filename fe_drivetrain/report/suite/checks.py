"""Checks of a case: a computed value against a reference or a bound, with the reason."""

from __future__ import annotations

import math
from typing import Unpack

from numpy.typing import ArrayLike

from fe_drivetrain.report.results import Basis, JudgedFacts, ValueFacts, Verdict, judge
from fe_drivetrain.report.suite.records import MeshSeries
from fe_drivetrain.report.suite.targets import MEASURES, Target, split_unit


class Checks:
    """Collects the checks of a case.

    Attributes
    ----------
    checks : list of Verdict
        Of all checks so far.
    """

    def __init__(self) -> None:
        self.checks: list[Verdict] = []
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
        relative: bool = True,
        **more: Unpack[ValueFacts],
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
        relative : bool
            False where `within` is in the unit.
        **more : object
            ``unit`` of both, where the quantity is stated without it. ``measure``: kind of
            quantity, for bias and scatter over all cases; that of the unit in brackets where left
            out. ``basis``: "self-consistency" of what is true by construction, "second-hand" of a
            source that was not read itself; both are shown as such, and stay out of bias and
            scatter. ``band``: half width of the numerical uncertainty of `computed`, in its unit.
            It is computed, from a series of meshes or an error estimate; where there is none, it
            is left out.
        """
        self._judge(
            quantity,
            computed,
            reference,
            why=why,
            source=source,
            tolerance=within,
            relative=relative,
            **more,
        )

    def exponent(
        self,
        quantity: str,
        x: ArrayLike,
        y: ArrayLike,
        expected: float,
        *,
        within: float,
        why: str,
        source: str,
        between: tuple[float, float] = (0.0, math.inf),
        relative: bool = True,
    ) -> float:
        """The exponent of a power of x that fits y best is the expected one, with its own band.

        Parameters
        ----------
        quantity : str
            What grows with what.
        x, y : (n,) array
            The points; see `fe_drivetrain.comparison.fitted_exponent`.
        expected : float
            The exponent by theory.
        within : float
            Allowed difference, as for `equals`.
        why, source : str
            As for `equals`.
        between : tuple of float
            Only points with y between these are fitted.
        relative : bool
            False where `within` is that of the exponent itself.

        Returns
        -------
        exponent : float
            That of the points.
        """
        from fe_drivetrain.comparison.sweeps import fitted_exponent

        exponent, band = fitted_exponent(x, y, between)
        self.equals(
            quantity,
            exponent,
            expected,
            within=within,
            relative=relative,
            why=why,
            source=source,
            measure="order",
            band=band,
        )
        return exponent

    def vanishes(
        self,
        quantity: str,
        computed: float,
        *,
        within: float,
        why: str,
        source: str,
        **more: Unpack[ValueFacts],
    ) -> None:
        """The computed value is zero, but for `within`, in its unit; see `equals`."""
        more.setdefault("measure", "identity")
        self._judge(
            quantity,
            computed,
            0.0,
            why=why,
            source=source,
            tolerance=within,
            check="vanishes",
            **more,
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
            f"{of}: {quantity}" if of else quantity,
            computed,
            target.value,
            why=target.why,
            source=target.source,
            tolerance=target.within,
            check="vanishes" if zero else "equals",
            relative=target.relative and not zero,
            unit=unit,
            measure=target.measure or MEASURES.get(unit) or ("identity" if zero else None),
            basis=target.basis,
            band=band,
        )

    def at_most(
        self,
        quantity: str,
        computed: float,
        bound: float,
        *,
        why: str,
        source: str,
        **more: Unpack[ValueFacts],
    ) -> None:
        """The computed value is no larger than a bound; `more` is unit, measure, basis, band."""
        self._judge(quantity, computed, bound, why=why, source=source, check="at most", **more)

    def at_least(
        self,
        quantity: str,
        computed: float,
        bound: float,
        *,
        why: str,
        source: str,
        **more: Unpack[ValueFacts],
    ) -> None:
        """The computed value is no smaller than a bound; `more` is unit, measure, basis, band."""
        self._judge(quantity, computed, bound, why=why, source=source, check="at least", **more)

    def between(
        self,
        quantity: str,
        computed: float,
        low: float,
        high: float,
        *,
        why: str,
        source: str,
        **more: Unpack[ValueFacts],
    ) -> None:
        """The computed value is no smaller than `low`, and no larger than `high`."""
        self._judge(
            quantity, computed, low, why=why, source=source, check="between", upper=high, **more
        )

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
            As in `equals`.
        """
        self._judge(
            statement,
            float(bool(condition)),
            1.0,
            why=why,
            source=source,
            check="holds",
            measure="identity",
            basis=basis,
        )

    def _judge(
        self,
        quantity: str,
        computed: float,
        reference: float,
        *,
        why: str,
        source: str,
        tolerance: float = 0.0,
        **more: Unpack[JudgedFacts],
    ) -> None:
        if not more.get("unit"):
            quantity, unit = split_unit(quantity)
            more["unit"] = unit
            more["measure"] = more.get("measure") or MEASURES.get(unit)
        more.setdefault("relative", False)
        self.checks.append(
            judge(
                quantity,
                computed,
                reference,
                tolerance=tolerance,
                reason=why,
                source=source,
                of=self._of,
                **more,
            )
        )
