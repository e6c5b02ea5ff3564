"""Statistics of load histories where they break: zero crossings, outliers, constants, NaN."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Samples of a history: ten minutes at 20 Hz.
SAMPLES = 12_000
SEED = 5

#: What a model of the sweeps is off by, as a share of the reference's standard deviation.
NOISE = 0.05

CUTS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
#: Safe is what keeps to this much of its value where nothing is near zero, or no outlier is there.
KEPT = 1.25


def run(run: Run) -> Any:
    """Sweep the mean of the reference, what is left out, and one outlier; then what is refused."""
    import numpy as np

    from fe_drivetrain.common import InputError
    from fe_drivetrain.compare import statistics as cp
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace

    histories = 20 if run.quick else 80
    rng = np.random.default_rng(SEED)
    wave = rng.standard_normal((histories, SAMPLES))
    noise = NOISE * rng.standard_normal((histories, SAMPLES))
    means = np.geomspace(100.0, 0.1, 9 if run.quick else 13)

    with run.step("zero crossings"):
        # in percent of the reference's own size, so that both would be flat without zeros
        percent, robust = (
            np.array([statistic(m + wave, m + wave + noise) for m in means]) * scale
            for statistic, scale in ((cp.mean_percentage_error, 1.0), (cp.relative_error, 100.0))
        )
        shares = np.array([(np.abs(m + wave) < 0.1).mean() for m in means])
        # and at a mean of zero, by what is left out
        cut = np.array([cp.mean_percentage_error(wave, wave + noise, c) for c in CUTS])
    # E|noise| / E|r| for normal samples about a mean
    expected = 100 * NOISE * np.sqrt(2 / np.pi) / _mean_absolute(means)
    excess = np.median(percent, axis=1) / expected
    spread = percent.max(axis=1) / percent.min(axis=1)
    robust_excess = robust / expected[:, None]
    slope = np.polyfit(-np.log(CUTS), cut.mean(axis=1), 1)[0]
    # each factor e of the cut adds twice the density at zero
    theory = 100 * NOISE * np.sqrt(2 / np.pi) * 2 / np.sqrt(2 * np.pi)
    slopes = [np.polyfit(-np.log(CUTS), one, 1)[0] for one in cut.T]

    with run.step("outlier"):
        sizes = np.geomspace(1.0, 1e6, 13)
        quiet, errors = wave[0], noise[0]
        rms = np.empty(len(sizes))
        median, mean = np.empty_like(rms), np.empty_like(rms)
        for k, size in enumerate(sizes):
            model = quiet + errors
            model[SAMPLES // 2] += size
            rms[k], mean[k] = cp.rmse(quiet, model), np.abs(cp.bias(quiet, model))
            median[k] = cp.median_error(quiet, model)
    alone = {
        "rms": float(cp.rmse(quiet, quiet + errors)),
        "median": float(cp.median_error(quiet, quiet + errors)),
    }
    growth = float(np.log(rms[-1] / rms[-3]) / np.log(sizes[-1] / sizes[-3]))

    with run.step("constants, NaN and short histories"):
        refused = _refused(cp, InputError)
        constant = np.full(SAMPLES, 1e5)
        undefined = [
            bool(np.isnan(cp.correlation(constant, wave[0]))),
            bool(np.isnan(cp.correlation(wave[0], constant * (1 + 1e-15)))),
            bool(np.isnan(cp.relative_error(0 * constant, wave[0]))),
            bool(np.isnan(cp.mean_percentage_error(0 * constant, wave[0]))),
        ]

    three_sigma = 3 * float(np.std(slopes) / np.sqrt(histories))
    verdicts = [
        judge(
            "zero mean: growth of the mean percentage error for each factor e less left out",
            float(slope),
            float(theory),
            tolerance=three_sigma,
            relative=False,
            unit="%",
            source="E|d| times the integral of the normal density over |r|, which is "
            "2 / sqrt(2 pi) for each factor e: the mean of 1 / |r| does not exist",
            reason=f"three standard errors of the mean of {histories} histories",
            measure="identity",
        ),
        judge(
            f"relative error at the least mean, {means[-1]:g} standard deviations, over that "
            "expected",
            float(np.median(robust_excess[-1])),
            1.0,
            tolerance=3 / np.sqrt(SAMPLES),
            source="E|d| / E|r| of normal samples",
            reason=f"three of the sampling errors of {SAMPLES} samples, some 1 / sqrt(n)",
            measure="identity",
        ),
        judge(
            "relative error: worst of all means and histories over that expected",
            float(np.abs(robust_excess - 1).max()),
            0.0,
            tolerance=5 / np.sqrt(SAMPLES),
            relative=False,
            source="E|d| / E|r| of normal samples",
            reason="five sampling errors: of thousands of histories none is beyond",
            measure="identity",
        ),
        judge(
            "mean percentage error over that expected, at the least mean: beyond its safe range",
            float(excess[-1] > KEPT),
            1.0,
            tolerance=0.0,
            relative=False,
            source="the thesis's metric breaks down where the reference passes zero",
            reason=f"yes or no: more than {KEPT:g} times",
            measure="identity",
        ),
        judge(
            "one outlier: power of its size with which the RMSE grows",
            growth,
            1.0,
            tolerance=1e-3,
            relative=False,
            source="sqrt(rms^2 + size^2 / n)",
            reason="at these sizes the other samples are a ten-thousandth of it and less, squared",
            measure="order",
        ),
        judge(
            "one outlier of any size: median error over that without it",
            float(np.abs(median / alone["median"] - 1).max()),
            0.0,
            tolerance=10 / SAMPLES,
            relative=False,
            source="one sample moves the median by one place of n at most",
            reason="a place is 1.2 / n wide on the mean at the median's density, and as widths go "
            "exponentially, beyond 10 / n once in some thousand cases",
            measure="identity",
        ),
        judge(
            "a constant signal and a zero reference: correlation and percentages are undefined",
            float(all(undefined)),
            1.0,
            tolerance=0.0,
            relative=False,
            source="fe_drivetrain.compare.statistics",
            reason="yes or no: NaN, and never a ratio of rounding errors",
            measure="identity",
        ),
        judge(
            "one sample, NaN, infinity, unlike shapes: refused in one sentence",
            float(sum(bool(words) for _, words in refused) / len(refused)),
            1.0,
            tolerance=0.0,
            relative=False,
            source="fe_drivetrain.compare.statistics and fe_drivetrain.hub_loads.histories",
            reason="all of them",
            measure="identity",
        ),
    ]
    safe_mean = _last_safe(means, excess - 1, KEPT - 1)
    safe_size = _last_safe(sizes, rms / alone["rms"] - 1, KEPT - 1)
    limits = [
        Limit(
            method="mean percentage error (mean of |difference| / |reference|)",
            parameter="mean of the reference over its standard deviation",
            low=safe_mean,
            high=None,
            criterion=f"within {100 * (KEPT - 1):.0f} % of mean |difference| / mean |reference|",
            beyond=f"{excess[-1]:.1f} times at {means[-1]:g}, and it grows with the logarithm of "
            "what is left out",
            program="leaves out |reference| up to 0.001 of its rms and says how many; NaN where "
            "all is zero",
            remedy="relative_error, mean |difference| / mean |reference|: within "
            f"{100 * np.abs(robust_excess - 1).max():.1f} % of its expectation throughout",
        ),
        Limit(
            method="root mean square error",
            parameter="one outlier over the standard deviation of the reference, of "
            f"{SAMPLES:,} samples",
            low=None,
            high=safe_size,
            criterion=f"within {100 * (KEPT - 1):.0f} % of that without it",
            beyond="grows in proportion to the outlier over the root of the number of samples",
            program="refuses loads beyond 1e12 N or N m as slips of the pen; others stay in",
            remedy="median_error: within "
            f"{100 * np.abs(median / alone['median'] - 1).max():.2g} % of itself for any size",
        ),
    ]
    return CASE.results(
        run,
        summary=[
            "The thesis's mean percentage error is within "
            f"{100 * (KEPT - 1):.0f} % of mean |difference| over mean |reference| only where the "
            f"reference's mean is {safe_mean or float('nan'):.2g} standard deviations or more; at "
            f"{means[-1]:g} it is {excess[-1]:.1f} times that, from {percent[-1].min():.0f} to "
            f"{percent[-1].max():.0f} % by chance alone, and at a mean of zero each decade less "
            f"left out near zero adds {slope * np.log(10):.1f} %: it has no limit. The relative "
            "error stays.",
            f"One sample of {SAMPLES:,} that is off by {safe_size or float('nan'):.2g} standard "
            f"deviations spoils the RMSE by {100 * (KEPT - 1):.0f} %; the median error does not "
            "feel it.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="A reference that passes zero",
                items=[
                    Text(
                        text="Here the mean percentage error is 100 times the mean of |model - "
                        "reference| / |reference| over the samples whose |reference| is above "
                        "0.001 of the reference's root mean square; the share that is left out "
                        "stands beside it. The thesis takes it over resultants, which are seldom "
                        "near zero; of a component that passes zero, 1 / |reference| has no mean, "
                        "so that the figure is set by the few samples nearest to zero and by the "
                        "cut. The relative error, mean |model - reference| over mean |reference|, "
                        "counts every newton alike and needs no cut."
                    ),
                    chart(
                        f"Median of {histories} histories: normal samples about a mean, the model "
                        f"off by {100 * NOISE:g} % of their standard deviation; shaded is where "
                        "the percentage is safe",
                        [
                            trace(
                                "mean percentage error",
                                means,
                                np.median(percent, axis=1),
                                mode="lines+markers",
                            ),
                            trace("its largest of all histories", means, percent.max(axis=1)),
                            trace(
                                "relative error",
                                means,
                                np.median(robust, axis=1),
                                mode="lines+markers",
                            ),
                            trace("its largest of all histories ", means, robust.max(axis=1)),
                        ],
                        "mean of the reference over its standard deviation",
                        "error [%]",
                        ("x", "y"),
                        safe=(safe_mean, None),
                    ),
                    chart(
                        "At a mean of zero: the mean percentage error against the cut below which "
                        "samples are left out; it rises for ever",
                        [
                            trace("mean percentage error", CUTS, cut.mean(axis=1), True),
                            trace(
                                "theory's slope",
                                CUTS,
                                cut.mean() - theory * (np.log(CUTS) - np.mean(np.log(CUTS))),
                            ),
                        ],
                        "left out up to, over the rms of the reference",
                        "mean percentage error [%]",
                        ("x",),
                    ),
                    Table(
                        caption="By the reference's mean",
                        columns=[
                            "mean over standard deviation",
                            "samples within 0.1 standard deviations of zero [%]",
                            "mean percentage error over expected",
                            "largest over least of the histories",
                            "relative error over expected",
                        ],
                        rows=[
                            [float(v) for v in row]
                            for row in zip(
                                means,
                                100 * shares,
                                excess,
                                spread,
                                np.median(robust_excess, axis=1),
                                strict=True,
                            )
                        ],
                    ),
                ],
            ),
            Section(
                title="One outlier",
                items=[
                    chart(
                        f"One of {SAMPLES:,} samples of the model off by more and more; shaded is "
                        "where the RMSE is safe",
                        [
                            trace("RMSE", sizes, rms, mode="lines+markers"),
                            trace("bias without its sign", sizes, mean),
                            trace("median error", sizes, median, mode="lines+markers"),
                        ],
                        "outlier over the standard deviation of the reference",
                        "error over the standard deviation",
                        ("x", "y"),
                        safe=(None, safe_size),
                    ),
                ],
            ),
            Section(
                title="What is refused",
                items=[
                    Table(
                        caption="What is given, and what the program says",
                        columns=["given", "said"],
                        rows=[list(row) for row in refused],
                    ),
                    Text(
                        text="The correlation of a constant signal (constant to 1e-12 of its "
                        "largest value) and percentages of a reference that is zero throughout are "
                        "NaN: undefined, and marked so on every page."
                    ),
                ],
            ),
        ],
        limits=limits,
        figures={
            "means": means.tolist(),
            "excess": excess.tolist(),
            "slope": float(slope),
        },
    )


def _mean_absolute(mean: Any) -> Any:
    """E|r| of normal samples of unit deviation about a mean."""
    import numpy as np
    from scipy.special import erf

    return np.sqrt(2 / np.pi) * np.exp(-(mean**2) / 2) + mean * erf(mean / np.sqrt(2))


def _last_safe(x: Any, excess: Any, allowed: float) -> float | None:
    """The x, walking from the first, at which an excess first passes what is allowed."""
    import numpy as np

    beyond = np.flatnonzero(excess > allowed)
    if not len(beyond):
        return None
    k = max(int(beyond[0]), 1)
    # between points by a straight line in logarithms
    low, high = (np.log(max(float(v), 1e-300)) for v in excess[k - 1 : k + 1])
    share = (np.log(allowed) - low) / (high - low)
    return float(np.exp(np.log(x[k - 1]) + share * np.log(x[k] / x[k - 1])))


def _refused(cp: Any, refusal: type[Exception]) -> list[tuple[str, str]]:
    """What is given, and the sentence; empty where there is none."""
    import tempfile
    from pathlib import Path

    import numpy as np

    from fe_drivetrain.common import FORCES
    from fe_drivetrain.hub_loads import UNITS, read_hub_loads

    def said(call: Any) -> str:
        try:
            call()
        except refusal as error:
            return str(error)
        return ""

    good = np.array([1.0, 2.0, 4.0])
    rows = [
        ("one sample", said(lambda: cp.rmse([1.0], [1.0]))),
        ("NaN in the model", said(lambda: cp.rmse(good, [1.0, np.nan, 2.0]))),
        ("infinity in the reference", said(lambda: cp.correlation([1.0, np.inf, 2.0], good))),
        ("2 samples against 3", said(lambda: cp.bias(good[:2], good))),
    ]
    heading = ",".join(
        ["time [s]", *(f"{name} [{unit}]" for name, unit in zip(FORCES, UNITS, strict=True))]
    )
    files = {
        "a file with NaN": ["0,1,2,3,4,5,6", "1,1,nan,3,4,5,6", "2,1,2,3,4,5,7"],
        "a file of one sample": ["0,1,2,3,4,5,6"],
        "a file of a heading": [],
        "a file whose loads never vary": [f"{t},1,2,3,4,5,6" for t in range(3)],
        "a file that lacks a sample": [f"{t},{t},2,3,4,5,6" for t in (0, 1, 2, 4, 5)],
    }
    with tempfile.TemporaryDirectory() as folder:
        for what, lines in files.items():
            file = Path(folder, "loads.csv")
            file.write_text("\n".join([heading, *lines]), encoding="utf-8")
            words = said(lambda file=file: read_hub_loads(file))
            rows.append((what, words.replace(str(file), "loads.csv")))
    return rows


CASE = Case(
    name="stability/time_series",
    title="Statistics of load histories: zero crossings, outliers, constants and NaN",
    source="Stirling 2023, section 3.2; Huber 1981, Robust Statistics, section 1.4",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
