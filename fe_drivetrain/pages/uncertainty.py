"""Effect of uncertain values on the results, as tables and charts, next to the model error."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.drivetrain_file.scene import Spread
from fe_drivetrain.report.charts import chart
from fe_drivetrain.report.results import Cell, Chart, Section, Table, Text
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.fidelity.quantities import Number
from fe_drivetrain.shafts.uncertainty.input_study import Study, result_at
from fe_drivetrain.shafts.uncertainty.numbers import first_order, half_band, relative_spread
from fe_drivetrain.shafts.uncertainty.sampling import SHARE, Samples, distribution, nominal_value
from fe_drivetrain.studies.input_uncertainty import (
    UncertaintyResult,
    charted,
    half_bands,
    horizontal_bars,
    sample_count,
)

_BINS = 16
_LEAST = 1e-4  # smaller numbers in tables are round-off
_SEEN = 0.01  # smallest total Sobol index in the table


def show_uncertainty(run: Run, page: Page, result: UncertaintyResult) -> None:
    """Show bands, uncertain values, sensitivities and shares of the variance.

    Parameters
    ----------
    run : Run
        Not used: the page needs no files.
    page : Page
        Takes charts and tables.
    result : UncertaintyResult
        What was found.
    """
    found = result.study
    page.sections += [bands(found), inputs(found), slopes(found), variance(found)]
    if found.advices:
        page.sections.append(ladder(found))


def inputs(found: Study) -> Section:
    """The uncertain values and their distributions."""
    rows: list[list[Cell]] = []
    for k, (key, spread) in enumerate(found.scene.uncertainty.items(), 1):
        nominal = nominal_value(found.scene, key)
        known = distribution(spread, nominal)
        low, high = (float(known.ppf(q)) for q in ((1 - SHARE) / 2, (1 + SHARE) / 2))
        share = _short(100 * relative_spread(spread))
        rows.append([k, key, nominal, _words(spread), low, high, share])
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


def bands(found: Study) -> Section:
    """The band of every quantity, next to the error of the model level."""
    rows: list[list[Cell]] = []
    for number in found.numbers:
        samples, error = found.samples[number.name], found.errors[number.name]
        band, size = samples.band(), abs(samples.nominal)
        half = half_band(samples)
        sure = math.hypot(band.low_error, band.high_error) / 2 / size
        soft = found.soft_samples.get(number.name)
        rows.append(
            [
                number.name,
                number.unit,
                *(_short(v, 5) for v in (samples.nominal, band.low, band.high)),
                _short(100 * half),
                _short(100 * sure, 2),
                None if soft is None else _short(100 * half_band(soft)),
                _small(100 * error.share, 2),
                "inputs" if half > error.share else "model",
            ]
        )
    table = Table(
        caption=f"Bands of {100 * SHARE:g} % from {sample_count(found)} samples at level "
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
        rows=rows,
    )
    sources: dict[str, list[str]] = {}
    for number in found.numbers:
        sources.setdefault(found.errors[number.name].source, []).append(number.name)
    origins = "; ".join(f"for {', '.join(names)}: {source}" for source, names in sources.items())
    items: list[Table | Text | Chart] = [half_bands(found), table, Text(text=_BAND)]
    items.append(Text(text=f"The model error is, {origins}."))
    items += [_histogram(n, found.samples[n.name]) for n in charted(found) if _varies(found, n)]
    return Section(title="Uncertainty of the results", items=items)


def slopes(found: Study) -> Section:
    """First-order sensitivities of every quantity."""
    keys = list(found.scene.uncertainty)
    table = Table(
        caption="Relative change of each quantity per relative change of each value; columns are "
        "numbered as the uncertain values",
        columns=["quantity", *_numbered(keys)],
        rows=[
            [n.name, *(_small(found.slopes[n.name][key]) for key in keys)] for n in found.numbers
        ],
    )
    items: list[Table | Text | Chart] = [
        _tornado(found, number) for number in charted(found) if _varies(found, number)
    ]
    return Section(title="Influence of each value", items=[*items, table, Text(text=_SLOPE)])


def variance(found: Study) -> Section:
    """Shares of the variance: of a linear fit to the samples, and Sobol indices if requested."""
    varying = [n for n in found.numbers if _varies(found, n)]
    keys = list(found.scene.uncertainty)
    rows: list[list[Cell]] = []
    for number in varying:
        samples = found.samples[number.name]
        first = first_order(found, number)
        rows.append(
            [
                number.name,
                _short(100 * float(samples.values.std(ddof=1)) / abs(samples.nominal)),
                _short(100 * first),
                _short(samples.linear_share, 4),
                *(round(100 * share, 1) for share in samples.contributions().tolist()),
            ]
        )
    items: list[Table | Text] = [
        Table(
            caption="Standard deviation of the samples and of first order, share of the variance "
            "that a linear fit to the samples explains (R²), and the contribution of each value "
            "[%]; columns are numbered as the uncertain values",
            columns=["quantity", "sampled [%]", "first order [%]", "R² [-]", *_numbered(keys)],
            rows=rows,
        )
    ]
    if found.shares:
        items += [_sobol(found, varying), Text(text=_SOBOL)]
    return Section(title="Contributions to the variance", items=items)


def ladder(found: Study) -> Section:
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
    "standard error of the band is from resampling the samples as if they were independent. The "
    "bands are for housings with a rigid face; the column for averaged faces is the other bound, "
    "and the true support of the shaft is between the two."
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


def _surfaces(found: Study) -> Table:
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


def _tornado(found: Study, number: Number) -> Chart:
    moved = {
        key: 100 * found.slopes[number.name][key] * relative_spread(spread)
        for key, spread in found.scene.uncertainty.items()
    }
    order = sorted(moved, key=lambda key: abs(moved[key]))
    return horizontal_bars(
        f"Change of {number.name} for one standard deviation of each value",
        {"": [moved[key] for key in order]},
        order,
        "change [%]",
    )


def _histogram(number: Number, samples: Samples) -> Chart:
    counts, edges = np.histogram(samples.values, bins=_BINS)
    band = samples.band()
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
            ("nominal", samples.nominal, "solid"),
            ("2.5 %", band.low, "dash"),
            ("97.5 %", band.high, "dash"),
        )
    ]
    return chart(
        f"{number.name} over the samples",
        [bars, *lines],
        x=f"{number.name} [{number.unit}]",
        y="samples",
    )


def _sobol(found: Study, varying: Sequence[Number]) -> Table:
    rows: list[list[Cell]] = []
    for number in varying:
        shares = found.shares[number.name]
        for k, key in enumerate(shares.keys):
            if shares.total[k] < _SEEN:
                continue
            values = (shares.first, shares.first_error, shares.total, shares.total_error)
            rows.append([number.name, key, *(_small(float(v[k])) for v in values)])
    return Table(
        caption=f"Sobol indices (shares of the variance) with a total of at least {_SEEN:g}",
        columns=["quantity", "value", "first [-]", "±", "total [-]", "± "],
        rows=rows,
    )


def _varies(found: Study, number: Number) -> bool:
    return found.samples[number.name].varies


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
    return 0.0 if abs(value) < _LEAST else _short(value, digits)


def _percent(share: float) -> Cell:
    return 100 * share if math.isfinite(share) else None
