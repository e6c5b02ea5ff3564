"""Checks of what is computed in time: error of the energy, convergence over step and harmonics."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from fe_drivetrain.comparison.in_time import ConvergenceInTime
from fe_drivetrain.report.number_text import with_unit
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.targets import split_unit

_ENERGY = "work of loads, clocks and dampers is kinetic and strain energy"
_STEP, _WAVE = "step", "number of harmonics"
_SERIES = {
    _STEP: "a step, twice and four times it",
    _WAVE: "all harmonics, a half and a quarter of them",
}


def check_in_time(
    page: Page,
    of: str,
    found: ConvergenceInTime,
    within: Mapping[str, float],
    *,
    energy: float,
    why: str,
    open_for: Collection[str] = (),
    scale: Mapping[str, float] | None = None,
) -> None:
    """Check the energy of runs in time, and that their values have converged; show all of them.

    A value that has not converged fails a check, or is said to be open: it never stands under
    checks that pass alone.

    Parameters
    ----------
    page : Page
        Takes checks, table, and what has not converged.
    of : str
        What was run, put before each quantity.
    found : ConvergenceInTime
        The runs.
    within : mapping of str to float
        By quantity how much of its size step and harmonics may leave uncertain, each.
    energy : float
        Energy that may appear from nowhere, over the largest.
    why : str
        Why as much of it may.
    open_for : collection of str
        Quantities that no number of harmonics settles: where their band is larger than allowed,
        the page has no check of it but says that the value has not converged.
    scale : mapping of str to float, optional
        Size by which the band of a quantity is measured, in place of its value.
    """
    page.at_most(
        f"{of}: energy that appears from nowhere, over the largest",
        found.energy_error,
        energy,
        why=why,
        source=_ENERGY,
        measure="identity",
    )
    if not found.converged:
        page.unsettled.append(f"Not converged: {of}, iterations of some steps.")
    settled: dict[str, list[tuple[float, float, str]]] = {}
    every = {key: _bands(found, key) for key in within}
    for key, allowed in within.items():
        bands, size = every[key], abs((scale or {}).get(key, found.value(key)))
        shares = {by: band / size if size else float("inf") for by, band in bands.items()}
        beyond = [by for by, share in shares.items() if key in open_for and not share <= allowed]
        if beyond:
            page.unsettled.append(_still_open(f"{of}: {key}", {by: bands[by] for by in beyond}))
        for by, share in shares.items():
            if by not in beyond:
                settled.setdefault(by, []).append((share, allowed, key))
    for by, each in settled.items():
        _check_worst(page, of, by, each)
    _show(page, of, [_row(key, found, bands) for key, bands in every.items()])


def _show(page: Page, of: str, rows: list[Record]) -> None:
    page.table(f"{of}: convergence", rows)
    page.data(f"{of}: convergence", rows)


def _bands(found: ConvergenceInTime, key: str) -> dict[str, float]:
    """Bands of a quantity by the step, and by the number of harmonics where there are some."""
    bands = {_STEP: found.step_band(key)}
    if found.harmonics:
        bands[_WAVE] = found.harmonics_band(key)
    return bands


def _still_open(name: str, bands: Mapping[str, float]) -> str:
    """What has not converged, in a sentence."""
    quantity, unit = split_unit(name)
    parts = [f"± {with_unit(f'{band:.2g}', unit)} by the {by}" for by, band in bands.items()]
    return f"Not converged: {quantity}, uncertain by {' and '.join(parts)}."


def _check_worst(page: Page, of: str, by: str, each: list[tuple[float, float, str]]) -> None:
    """The quantity that uses most of what it is allowed, in place of them all."""
    share, allowed, key = max(each, key=lambda one: one[0] / one[1])
    what = split_unit(key)[0] if len(each) == 1 else f"{len(each)} quantities, the worst"
    page.at_most(
        f"{of}: left uncertain by the {by}, of {what}, over it",
        share,
        allowed,
        why=f"the answer would be one of the {by}, not of the drivetrain",
        source=f"{_SERIES[by]}: {key}",
        measure="identity",
    )


def _row(key: str, found: ConvergenceInTime, bands: Mapping[str, float]) -> Record:
    """A quantity, its bands, and what each run gave."""
    return {
        "quantity": key,
        "value": found.value(key),
        **{f"band by {name}": band for name, band in bands.items()},
        **{
            f"{count} harmonics": one.values[key]
            for count, one in zip(found.harmonics, found.by_harmonics, strict=True)
        },
        **{
            f"step {1e3 * dt:.3g} ms": one.values[key]
            for dt, one in zip(found.steps, found.by_step, strict=True)
        },
    }
