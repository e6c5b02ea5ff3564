"""Statistics of load histories where they break: zero crossings, outliers, constants, NaN."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import erf

from fe_drivetrain.cases import case
from fe_drivetrain.common import FORCES, Floats, InputError, scratch_folder
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import fitted_exponent, statistics
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.hub_loads import UNITS, read_hub_loads

#: Samples of a history: ten minutes at 20 Hz.
SAMPLES = 12_000
SEED = 5

#: Error of the model, over the reference's standard deviation.
NOISE = 0.05

CUTS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
#: Safe is what keeps to this much of its value where nothing is near zero, or no outlier is there.
KEPT = 1.25

PERCENTAGES = (
    "Mean percentage error and relative error over the mean of the load; shaded: the percentage "
    f"within {100 * (KEPT - 1):.0f} % of what is expected"
)
EXPECTED = "E|d| / E|r| of normal samples"


@dataclass(frozen=True)
class Crossing:
    """Histories about means from far away to near zero, and at a mean of zero.

    Attributes
    ----------
    means : (n,) array
        Of the reference, over its standard deviation.
    near_zero : (n,) array
        Share of samples within 0.1 standard deviations of zero.
    percent, relative : (n, histories) array
        Mean percentage error and relative error [%].
    expected : (n,) array
        E|d| / E|r| [%].
    cut : (cuts, histories) array
        Mean percentage error at a mean of zero, by what is left out [%].
    """

    means: Floats
    near_zero: Floats
    percent: Floats
    relative: Floats
    expected: Floats
    cut: Floats

    @property
    def excess(self) -> Floats:
        """(n,) mean percentage error over that expected, median of the histories."""
        return np.asarray(np.median(self.percent, axis=1) / self.expected)

    @property
    def relative_excess(self) -> Floats:
        """(n, histories) relative error over that expected."""
        return np.asarray(self.relative / self.expected[:, None])

    @property
    def safe(self) -> float | None:
        """Mean down to which the mean percentage error is safe."""
        return last_safe(self.means, self.excess - 1, KEPT - 1)

    @property
    def slope(self) -> float:
        """Growth of the mean percentage error for each factor e less left out [%]."""
        return float(np.polyfit(-np.log(CUTS), self.cut.mean(axis=1), 1)[0])


def crossing(wave: Floats, noise: Floats, means: Floats) -> Crossing:
    """Statistics of normal samples (histories, samples) and of models of these with noise."""
    # in percent of the reference's own size, so that both would be flat without zeros
    percent, relative = (
        np.array([statistic(m + wave, m + wave + noise) for m in means]) * scale
        for statistic, scale in (
            (statistics.mean_percentage_error, 1.0),
            (statistics.relative_error, 100.0),
        )
    )
    near_zero = np.array([(np.abs(m + wave) < 0.1).mean() for m in means])
    cut = np.array([statistics.mean_percentage_error(wave, wave + noise, c) for c in CUTS])
    # E|noise| / E|r| for normal samples about a mean
    expected = 100 * NOISE * np.sqrt(2 / np.pi) / mean_absolute(means)
    return Crossing(means, near_zero, percent, relative, expected, cut)


@dataclass(frozen=True)
class Outlier:
    """One sample of the model wrong by more and more.

    Attributes
    ----------
    sizes : (n,) array
        Its error over the standard deviation of the reference.
    rms, bias, median : (n,) array
        Root mean square error, bias without its sign, median error.
    rms_alone, median_alone : float
        The same without it.
    """

    sizes: Floats
    rms: Floats
    bias: Floats
    median: Floats
    rms_alone: float
    median_alone: float

    @property
    def safe(self) -> float | None:
        """Size up to which the RMSE is safe."""
        return last_safe(self.sizes, self.rms / self.rms_alone - 1, KEPT - 1)

    @property
    def median_excess(self) -> float:
        """Largest relative change of the median error."""
        return float(np.abs(self.median / self.median_alone - 1).max())


def outlier(reference: Floats, errors: Floats) -> Outlier:
    """Statistics of one history with an outlier in its middle."""
    sizes = np.geomspace(1.0, 1e6, 13)
    found = []
    for size in sizes:
        model = reference + errors
        model[SAMPLES // 2] += size
        found.append(
            (
                statistics.rmse(reference, model),
                np.abs(statistics.bias(reference, model)),
                statistics.median_error(reference, model),
            )
        )
    rms, bias, median = np.array(found, dtype=float).T
    alone = reference + errors
    return Outlier(
        sizes,
        rms,
        bias,
        median,
        float(statistics.rmse(reference, alone)),
        float(statistics.median_error(reference, alone)),
    )


@case(
    "Statistics of load histories: zero crossings, outliers, constants and NaN",
    source="Stirling 2023, section 3.2; Huber 1981, Robust Statistics, section 1.4",
)
def run(run: Run, page: Page) -> None:
    """Sweep the mean of the reference, what is left out, and one outlier; then what is refused."""
    histories = 20 if run.quick else 80
    rng = np.random.default_rng(SEED)
    wave = rng.standard_normal((histories, SAMPLES))
    noise = NOISE * rng.standard_normal((histories, SAMPLES))
    means = np.geomspace(100.0, 0.1, 9 if run.quick else 13)
    found = run.timed("zero crossings", crossing, wave, noise, means)
    spoilt = run.timed("outlier", outlier, wave[0], noise[0])
    refused = run.timed("constants, NaN and short histories", refusals)
    theory = check_crossing(page, found)
    check_outlier(page, spoilt)
    check_refusals(page, wave[0], refused)
    state_limits(page, found, spoilt)
    show_crossing(page, found, theory)
    page.section("One outlier")
    page.chart(
        f"One of {SAMPLES:,} samples of the model with a larger and larger error; shaded is where "
        "the RMSE is safe",
        [
            marked("RMSE", spoilt.sizes, spoilt.rms),
            trace("bias without its sign", spoilt.sizes, spoilt.bias),
            marked("median error", spoilt.sizes, spoilt.median),
        ],
        "outlier over the standard deviation of the reference",
        "error over the standard deviation",
        "xy",
        (None, spoilt.safe),
    )
    page.section("What is refused")
    page.table("What is given, and what the program says", refused)
    page.text(
        "The correlation of a constant signal (constant to 1e-12 of its largest value) and "
        "percentages of a reference that is zero throughout are NaN: undefined, and marked so on "
        "every page."
    )
    page.data("means", found.means)
    page.data("excess", found.excess)
    page.data("slope", found.slope)


def check_crossing(page: Page, found: Crossing) -> float:
    """The mean percentage error without a limit, and the relative error with one.

    Returns
    -------
    slope : float
        Growth of the first for each factor e less left out, by theory [%].
    """
    histories = found.cut.shape[1]
    slopes = [np.polyfit(-np.log(CUTS), one, 1)[0] for one in found.cut.T]
    # each factor e of the cut adds twice the density at zero
    theory = float(100 * NOISE * np.sqrt(2 / np.pi) * 2 / np.sqrt(2 * np.pi))
    page.equals(
        "zero mean: growth of the mean percentage error for each factor e less left out [%]",
        found.slope,
        theory,
        within=3 * float(np.std(slopes) / np.sqrt(histories)),
        relative=False,
        why=f"three standard errors of the mean of {histories} histories",
        source="E|d| times the integral of the normal density over |r|, which is 2 / sqrt(2 pi) "
        "for each factor e: the mean of 1 / |r| does not exist",
        measure="identity",
    )
    page.equals(
        "relative error / expected error at the smallest mean, "
        f"{found.means[-1]:g} standard deviations",
        float(np.median(found.relative_excess[-1])),
        1.0,
        within=3 / np.sqrt(SAMPLES),
        why=f"three of the sampling errors of {SAMPLES} samples, some 1 / sqrt(n)",
        source=EXPECTED,
        measure="identity",
    )
    page.vanishes(
        "relative error / expected error, less one: worst of all means and histories",
        float(np.abs(found.relative_excess - 1).max()),
        within=5 / np.sqrt(SAMPLES),
        why="five sampling errors: of thousands of histories none is beyond",
        source=EXPECTED,
    )
    page.holds(
        "mean percentage error / expected error at the smallest mean is outside the safe range",
        bool(found.excess[-1] > KEPT),
        why=f"a sweep that never reaches {KEPT:g} times the expected error finds no limit",
        source="the thesis's metric breaks down where the reference passes zero",
    )
    return theory


def check_outlier(page: Page, spoilt: Outlier) -> None:
    """The RMSE grows with an outlier, the median error does not."""
    ends = [-3, -1]
    page.equals(
        "one outlier: power of its size with which the RMSE grows",
        fitted_exponent(spoilt.sizes[ends], spoilt.rms[ends])[0],
        1.0,
        within=1e-3,
        relative=False,
        why="at these sizes the other samples are a ten-thousandth of it and less, squared",
        source="sqrt(rms^2 + size^2 / n)",
        measure="order",
    )
    page.vanishes(
        "one outlier of any size: median error over that without it, less one",
        spoilt.median_excess,
        within=10 / SAMPLES,
        why="a place is 1.2 / n wide on the mean at the median's density, and as widths are "
        "distributed exponentially, beyond 10 / n once in some thousand cases",
        source="one sample moves the median by one place of n at most",
    )


def check_refusals(page: Page, wave: Floats, refused: list[Record]) -> None:
    """What has no answer gets none."""
    constant = np.full(SAMPLES, 1e5)
    undefined = [
        statistics.correlation(constant, wave),
        statistics.correlation(wave, constant * (1 + 1e-15)),
        statistics.relative_error(0 * constant, wave),
        statistics.mean_percentage_error(0 * constant, wave),
    ]
    page.holds(
        "a constant signal and a zero reference: correlation and percentages are undefined",
        bool(np.isnan(undefined).all()),
        why="a number there would be a ratio of rounding errors",
        source="fe_drivetrain.comparison.statistics",
    )
    page.holds(
        "one sample, NaN, infinity, different shapes: refused in one sentence",
        all(row["message"] for row in refused),
        why="statistics of such histories would be NaN, or of other samples than intended",
        source="fe_drivetrain.comparison.statistics and "
        "fe_drivetrain.turbine_loads.hub_loads.histories",
    )


def answer(page: Page, found: Crossing, spoilt: Outlier) -> None:
    """State where the thesis's percentage, and the root mean square, stop to be trustworthy."""
    least, worst = found.means[-1], 100 * float(np.abs(found.relative_excess - 1).max())
    figures = [
        page.value(
            f"mean percentage error over its expected value, mean of {least:g} deviations",
            found.excess[-1],
            beside=1.0,
            by="theory",
        ),
        page.value("worst difference of the relative error from its expected value [%]", worst),
        page.value(
            "largest change of the median error by one outlier [%]", 100 * spoilt.median_excess
        ),
    ]
    ends = {
        "least mean over standard deviation for the mean percentage error": found.safe,
        "largest outlier over standard deviation for the RMS error": spoilt.safe,
    }
    figures[:0] = [
        page.value(name, rounded([end], 2)[0]) for name, end in ends.items() if end is not None
    ]
    page.answer(
        "Which error measures may be trusted for loads that pass zero?",
        "The thesis's mean percentage error can be trusted "
        + (
            f"only where the mean load exceeds {formatted(found.safe, 2)} standard deviations"
            if found.safe is not None
            else f"down to a mean load of {least:g} standard deviations"
        )
        + "; the relative error can be trusted everywhere.",
        figures,
        hero=PERCENTAGES,
        cautions=[
            "The limit is for normally distributed loads and an error of constant size; for a mean "
            "near zero the percentage depends on which samples near zero are left out."
        ],
    )


def state_limits(page: Page, found: Crossing, spoilt: Outlier) -> None:
    """Answer and limits."""
    within = f"{100 * (KEPT - 1):.0f} %"
    least, last = found.means[-1], found.percent[-1]
    answer(page, found, spoilt)
    page.say(
        f"At a mean of {least:g} standard deviations the mean percentage error is from "
        f"{last.min():.0f} to {last.max():.0f} % by chance alone, and at a mean of zero each "
        f"decade less left out near zero adds {found.slope * np.log(10):.1f} %: it has no limit.",
        f"One sample of {SAMPLES:,} with an error of {spoilt.safe or float('nan'):.2g} standard "
        f"deviations spoils the RMSE by {within}; the median error does not change.",
    )
    page.limit(
        "mean percentage error (mean of |difference| / |reference|)",
        "mean of the reference over its standard deviation",
        low=found.safe,
        criterion=f"within {within} of mean |difference| / mean |reference|",
        beyond=f"{found.excess[-1]:.1f} times at {least:g}, and it grows with the logarithm of "
        "what is left out",
        program="leaves out |reference| up to 0.001 of its rms and says how many; NaN where all is "
        "zero",
        remedy="relative_error, mean |difference| / mean |reference|: within "
        f"{100 * np.abs(found.relative_excess - 1).max():.1f} % of its expectation throughout",
    )
    page.limit(
        "root mean square error",
        f"one outlier over the standard deviation of the reference, of {SAMPLES:,} samples",
        high=spoilt.safe,
        criterion=f"within {within} of that without it",
        beyond="grows in proportion to the outlier over the root of the number of samples",
        program="refuses loads beyond 1e12 N or N m as typing errors; others stay in",
        remedy=f"median_error: within {100 * spoilt.median_excess:.2g} % of itself for any size",
    )


def show_crossing(page: Page, found: Crossing, theory: float) -> None:
    """Charts and table of a reference that passes zero."""
    page.section("A reference that passes zero")
    page.text(
        "Here the mean percentage error is 100 times the mean of |model - reference| / |reference| "
        "over the samples whose |reference| is above 0.001 of the reference's root mean square; "
        "the share that is left out is shown beside it. The thesis takes it over resultants, which "
        "are seldom near zero; of a component that passes zero, 1 / |reference| has no mean, so "
        "that the figure is set by the few samples nearest to zero and by the cut. The relative "
        "error, mean |model - reference| over mean |reference|, counts every newton equally and "
        "needs no cut."
    )
    show_percentages(page, found)
    means = found.means
    by_theory = found.cut.mean() - theory * (np.log(CUTS) - np.mean(np.log(CUTS)))
    page.chart(
        "At a mean of zero: the mean percentage error against the cut below which samples are left "
        "out; it rises without limit",
        [
            trace("mean percentage error", CUTS, found.cut.mean(axis=1), True),
            trace("theory's slope", CUTS, by_theory),
        ],
        "left out up to, over the rms of the reference",
        "mean percentage error [%]",
        "x",
    )
    page.table(
        "By the reference's mean",
        np.column_stack(
            [
                means,
                100 * found.near_zero,
                found.excess,
                found.percent.max(axis=1) / found.percent.min(axis=1),
                np.median(found.relative_excess, axis=1),
            ]
        ).tolist(),
        [
            "mean over standard deviation",
            "samples within 0.1 standard deviations of zero [%]",
            "mean percentage error over expected",
            "largest over least of the histories",
            "relative error over expected",
        ],
    )


def show_percentages(page: Page, found: Crossing) -> None:
    """Chart of both errors over the mean of the reference."""
    page.text(
        f"The curves are medians of {found.cut.shape[1]} histories: normal samples about a mean, "
        f"the model with an error of {100 * NOISE:g} % of their standard deviation."
    )
    means = found.means
    page.chart(
        PERCENTAGES,
        [
            marked("mean percentage error", means, np.median(found.percent, axis=1)),
            trace("its largest of all histories", means, found.percent.max(axis=1)),
            marked("relative error", means, np.median(found.relative, axis=1)),
            trace("its largest of all histories ", means, found.relative.max(axis=1)),
        ],
        "mean of the reference over its standard deviation",
        "error [%]",
        "xy",
        (found.safe, None),
    )


def mean_absolute(mean: Floats) -> Floats:
    """E|r| of normal samples of unit deviation about a mean."""
    return np.asarray(np.sqrt(2 / np.pi) * np.exp(-(mean**2) / 2) + mean * erf(mean / np.sqrt(2)))


def last_safe(x: Floats, excess: Floats, allowed: float) -> float | None:
    """Where an excess first passes what is allowed, starting from the first x."""
    beyond = np.flatnonzero(excess > allowed)
    if not len(beyond):
        return None
    k = max(int(beyond[0]), 1)
    # between points by a straight line in logarithms
    low, high = (np.log(max(float(v), 1e-300)) for v in excess[k - 1 : k + 1])
    share = (np.log(allowed) - low) / (high - low)
    return float(np.exp(np.log(x[k - 1]) + share * np.log(x[k] / x[k - 1])))


def refusals() -> list[Record]:
    """What is given, and the sentence that refuses it; empty where there is none."""

    def message(call: Callable[[], object]) -> str:
        try:
            call()
        except InputError as error:
            return str(error)
        return ""

    good = np.array([1.0, 2.0, 4.0])
    rows = {
        "one sample": message(lambda: statistics.rmse([1.0], [1.0])),
        "NaN in the model": message(lambda: statistics.rmse(good, [1.0, np.nan, 2.0])),
        "infinity in the reference": message(
            lambda: statistics.correlation([1.0, np.inf, 2.0], good)
        ),
        "2 samples against 3": message(lambda: statistics.bias(good[:2], good)),
    }
    heading = ",".join(
        ["time [s]", *(f"{name} [{unit}]" for name, unit in zip(FORCES, UNITS, strict=True))]
    )
    files = {
        "a file with NaN": ["0,1,2,3,4,5,6", "1,1,nan,3,4,5,6", "2,1,2,3,4,5,7"],
        "a file of one sample": ["0,1,2,3,4,5,6"],
        "a file of a heading": [],
        "a file whose loads never vary": [f"{t},1,2,3,4,5,6" for t in range(3)],
        "a file with a missing sample": [f"{t},{t},2,3,4,5,6" for t in (0, 1, 2, 4, 5)],
    }
    with scratch_folder() as folder:
        file = folder / "loads.csv"
        for what, lines in files.items():
            file.write_text("\n".join([heading, *lines]), encoding="utf-8")
            rows[what] = message(lambda: read_hub_loads(file)).replace(str(file), "loads.csv")
    return [{"given": given, "message": words} for given, words in rows.items()]
