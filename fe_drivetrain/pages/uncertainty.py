"""Effect of uncertain values on the results, as tables and charts, next to the model error."""

from __future__ import annotations

import math
from collections.abc import Sequence

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.drivetrain_file.scene import Spread
from fe_drivetrain.report.charts import chart
from fe_drivetrain.report.results import Cell, Chart, Section, Table, Text
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.uncertainty.input_study import result_at
from fe_drivetrain.shafts.uncertainty.sampling import SHARE
from fe_drivetrain.studies.input_effects import InputEffects, QuantityEffects, Scatter
from fe_drivetrain.studies.input_uncertainty import UncertaintyResult, half_bands, horizontal_bars

_MINIMUM = 1e-4  # smaller numbers in tables are round-off
_SEEN = 0.01  # smallest total Sobol index in the table


def show_uncertainty(run: Run, page: Page, result: UncertaintyResult) -> None:
    """Show bands, uncertain values, sensitivities and shares of the variance.

    Parameters
    ----------
    run : Run
        Not used: the page has no pictures.
    page : Page
        Takes charts and tables.
    result : UncertaintyResult
        What was found.
    """
    found = result.effects
    page.sections += [bands(found), inputs(found), slopes(found), _variance(found)]
    if found.advices:
        page.sections.append(_ladder(found))


def inputs(found: InputEffects) -> Section:
    """The uncertain values and their distributions."""
    rows: list[list[Cell]] = [
        [
            k,
            value.key,
            value.nominal,
            _words(value.spread),
            value.low,
            value.high,
            _short(100 * value.deviation),
        ]
        for k, value in enumerate(found.values, 1)
    ]
    table = Table(
        caption="Uncertain values",
        columns=[
            "no.",
            "value",
            "nominal [SI]",
            "distribution",
            "2.5 % [SI]",
            "97.5 % [SI]",
            "standard deviation [%]",
        ],
        rows=rows,
    )
    items: list[Table | Text] = [table]
    if found.surfaces:
        items += [_surfaces(found), Text(text=_SURFACE)]
    return Section(title="Uncertain values", items=items)


def bands(found: InputEffects) -> Section:
    """The band of every quantity, next to the error of the model level."""
    table = Table(
        caption=f"Bands of {100 * SHARE:g} % from {found.samples} samples at level "
        f"{found.level}, next to the error of the model",
        columns=[
            "quantity",
            "unit",
            "nominal",
            "2.5 %",
            "97.5 %",
            "inputs: half the band [%]",
            "its standard error [%]",
            "inputs: half the band, averaged faces [%]",
            "model: error [%]",
            "larger",
        ],
        rows=[_band_row(one) for one in found.quantities],
    )
    sources: dict[str, list[str]] = {}
    for one in found.quantities:
        sources.setdefault(one.error.source, []).append(one.name)
    origins = "; ".join(f"for {', '.join(names)}: {source}" for source, names in sources.items())
    items: list[Table | Text | Chart] = [half_bands(found), table, Text(text=_BAND)]
    if any(one.soft_half is not None for one in found.quantities):
        items.append(Text(text=_FACES))
    items.append(Text(text=f"The model error is, {origins}."))
    items += [_histogram(one, one.scatter) for one in found.charted if one.scatter]
    return Section(title="Uncertainty of the results", items=items)


def _band_row(one: QuantityEffects) -> list[Cell]:
    return [
        one.name,
        one.unit,
        *(_short(value, 5) for value in (one.nominal, one.band.low, one.band.high)),
        _short(100 * one.half),
        _short(100 * one.half_error, 2),
        None if one.soft_half is None else _short(100 * one.soft_half),
        _small(100 * one.error.share, 2),
        "inputs" if one.half > one.error.share else "model",
    ]


def slopes(found: InputEffects) -> Section:
    """First-order sensitivities of every quantity."""
    table = Table(
        caption="Relative change of each quantity per relative change of each value; columns are "
        "numbered as the uncertain values",
        columns=["quantity", *_numbered(found.keys)],
        rows=[
            [one.name, *(_small(one.sensitivities[key]) for key in found.keys)]
            for one in found.quantities
        ],
    )
    items: list[Table | Text | Chart] = [_tornado(one) for one in found.charted if one.scatter]
    return Section(title="Influence of each value", items=[*items, table, Text(text=_SLOPE)])


def _variance(found: InputEffects) -> Section:
    """Shares of the variance: of a linear fit to the samples, and Sobol indices if requested."""
    rows: list[list[Cell]] = [
        [
            one.name,
            _short(100 * one.scatter.deviation),
            _short(100 * one.scatter.first_order),
            _short(one.scatter.linear_share, 4),
            *(round(100 * share, 1) for share in one.scatter.contributions.tolist()),
        ]
        for one in found.quantities
        if one.scatter
    ]
    items: list[Table | Text] = [
        Table(
            caption="Standard deviation of the samples and of first order, share of the variance "
            "that a linear fit to the samples explains (R²), and the contribution of each value "
            "[%]; columns are numbered as the uncertain values",
            columns=[
                "quantity",
                "sampled [%]",
                "first order [%]",
                "R² [-]",
                *_numbered(found.keys),
            ],
            rows=rows,
        )
    ]
    if any(one.shares for one in found.quantities):
        items += [_sobol(found), Text(text=_SOBOL)]
    return Section(title="Contributions to the variance", items=items)


def _ladder(found: InputEffects) -> Section:
    """The errors of the model levels, and the level that was chosen."""
    rows: list[list[Cell]] = []
    for advice in found.advices:
        for result in advice.results:
            rows.append(
                [
                    advice.quantity.name,
                    f"{result.model.level} {result.model.title}",
                    _percent(result.error),
                    _percent(result.estimate),
                    result.seconds,
                    "sampled" if result is result_at(advice, found.level) else "",
                ]
            )
    table = Table(
        caption="Model levels for the requested quantities",
        columns=[
            "quantity",
            "level",
            "error relative to the last level [%]",
            "estimated own error ± [%]",
            "time [s]",
            "",
        ],
        rows=rows,
    )
    answers = [Text(text=advice.sentence()) for advice in found.advices]
    return Section(title="Model level", items=[*answers, table])


_BAND = (
    "Half the band of the inputs is compared with the error of the model: if that of the inputs is "
    "larger, better input data help; if that of the model is larger, a better model helps. The "
    "standard error of the band is from resampling the samples as if they were independent."
)
_FACES = (
    "The bands are for housings with a rigid face; the column for averaged faces is the other "
    "bound, and the true support of the shaft is between the two."
)
_SLOPE = (
    "Central differences at the level that was sampled. A bar of a chart is the change of the "
    "quantity for one standard deviation of the value."
)
_SOBOL = (
    "First: share of the variance that would vanish if this value were known. Total: share that "
    "would remain if all other values were known. Standard errors are from resampling; because of "
    "them an estimate may be below 0 or above 1."
)
_SURFACE = (
    "Bearing units that depend on uncertain values were solved at the nominal values and at two "
    "other values of each. Between these, the logarithm of the stiffness is interpolated as a sum "
    "of quadratic functions of one value each. Further solutions at values drawn from the "
    "distributions check the interpolation; its error includes the noise of remeshing. Everything "
    "else was solved again for each sample."
)


def _surfaces(found: InputEffects) -> Table:
    return Table(
        caption="Bearing units as response surfaces",
        columns=[
            "bearing unit",
            "face",
            "values",
            "solid solutions",
            "largest error at the checks [%]",
            "largest error of a sensitivity [-]",
        ],
        rows=[
            [
                s.name,
                s.coupling,
                ", ".join(s.keys),
                s.solutions,
                _short(100 * s.error),
                _short(s.slope_error),
            ]
            for s in found.surfaces
        ],
    )


def _tornado(one: QuantityEffects) -> Chart:
    return horizontal_bars(
        f"Change of {one.name} for one standard deviation of each value",
        {"": [100 * change for change in one.changes.values()]},
        list(one.changes),
        "change [%]",
    )


def _histogram(one: QuantityEffects, scatter: Scatter) -> Chart:
    counts, edges = scatter.counts, scatter.edges
    bars = {
        "type": "bar",
        "name": "samples",
        "x": rounded((edges[1:] + edges[:-1]) / 2),
        "y": counts.tolist(),
        "width": float(edges[1] - edges[0]),
        "showlegend": False,
    }
    lines = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": name,
            "x": rounded([x, x]),
            "y": [0, int(counts.max())],
            "line": {"dash": dash},
        }
        for name, x, dash in (
            ("nominal", one.nominal, "solid"),
            ("2.5 %", one.band.low, "dash"),
            ("97.5 %", one.band.high, "dash"),
        )
    ]
    return chart(
        f"{one.name} over the samples", [bars, *lines], x=f"{one.name} [{one.unit}]", y="samples"
    )


def _sobol(found: InputEffects) -> Table:
    rows: list[list[Cell]] = []
    for one in found.quantities:
        shares = one.shares
        if shares is None or not one.scatter:
            continue
        for k, key in enumerate(shares.keys):
            if shares.total[k] < _SEEN:
                continue
            values = (shares.first, shares.first_error, shares.total, shares.total_error)
            rows.append([one.name, key, *(_small(float(v[k])) for v in values)])
    return Table(
        caption=f"Sobol indices (shares of the variance) with a total of at least {_SEEN:g}",
        columns=["quantity", "value", "first [-]", "±", "total [-]", "± "],
        rows=rows,
    )


def _words(spread: Spread) -> str:
    if spread.uniform is not None:
        return f"uniform, ± {100 * spread.uniform:g} %"
    if spread.normal is not None:
        return f"normal, standard deviation {100 * spread.normal:g} %"
    return f"lognormal, coefficient of variation {100 * float(spread.lognormal or 0):g} %"


def _numbered(keys: Sequence[str]) -> list[str]:
    return [str(k + 1) for k in range(len(keys))]


def _short(value: float, digits: int = 3) -> float:
    return float(f"{value:.{digits}g}")


def _small(value: float, digits: int = 3) -> float:
    """The same, with 0 instead of round-off."""
    return 0.0 if abs(value) < _MINIMUM else _short(value, digits)


def _percent(share: float) -> Cell:
    return 100 * share if math.isfinite(share) else None
