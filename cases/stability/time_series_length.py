"""Long load histories: digits lost far from zero, and memory."""

import math

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.stability import streamed_series as series
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import moments
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column

#: Samples of the histories whose variance is taken, and how many of these.
SAMPLES, HISTORIES = 20_000, 8
SEED = 11
RATIOS: Floats = np.logspace(0, 9, 10)

#: Samples of histories that are compared in chunks, and of those compared whole.
LENGTHS = (100_000, 1_000_000, 10_000_000, 100_000_000)
QUICK_LENGTHS = LENGTHS[:2]
WHOLE = (100_000, 1_000_000, 3_000_000)
QUICK_WHOLE = (100_000, 1_000_000)

#: Memory that a comparison may take beside the program's own [bytes].
ALLOWED = 2 * 1024**3

#: Error of a variance that counts as safe: four digits.
SAFE = 1e-4

MIB = 1024**2

MEMORY = (
    "Most memory beside the program's own over the samples, each in a process of its own; shaded: "
    "a whole history below 2 GiB"
)
NAIVE, TWO_PASSES, MERGED = "sums of squares", "two passes", "merged chunks"


def variance_errors() -> dict[str, Floats]:
    """Relative errors of the variance at each of `RATIOS`, root mean square of the histories."""
    naive, plain, merged = (np.empty((len(RATIOS), HISTORIES)) for _ in range(3))
    waves = np.random.default_rng(SEED).standard_normal((HISTORIES, SAMPLES))
    for i, ratio in enumerate(RATIOS):
        for k, wave in enumerate(waves):
            x = ratio + wave
            exact = exact_variance(x - ratio)
            origin = np.array([[x[0]], [x[0]], [0.0]])
            of = moments(x[:1, None], x[:1, None], origin)
            for start in range(1, SAMPLES, 777):
                some = x[start : start + 777, None]
                of = of.merged(moments(some, some, origin))
            naive[i, k] = (x @ x - x.sum() ** 2 / SAMPLES) / SAMPLES / exact - 1
            plain[i, k] = x.var() / exact - 1
            merged[i, k] = of.products[0, 0, 0] / SAMPLES / exact - 1
    errors = {NAIVE: naive, TWO_PASSES: plain, MERGED: merged}
    return {name: np.sqrt((error**2).mean(axis=1)) for name, error in errors.items()}


def exact_variance(x: Floats) -> float:
    """Variance of samples near zero, summed without rounding."""
    mean = math.fsum(x) / len(x)
    return math.fsum((x - mean) ** 2) / len(x)


def measured(samples: int, way: str) -> Record:
    """Time and memory of one comparison in a process of its own, and its statistics."""
    found = series.in_own_process(samples, way)
    return {
        "way": way,
        "samples": samples,
        "time [s]": found["seconds"],
        "memory [MiB]": ((found["peak"] or math.nan) - (found["before"] or math.nan)) / MIB,
        "statistics": found["statistics"],
    }


@case(
    "Long load histories: digits far from zero, time and memory",
    source="Welford 1962, Technometrics 4, 419-420; Chan, Golub and LeVeque 1983, The American "
    "Statistician 37, 242-247",
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Variances against their mean, then memory against length."""
    page.seed = SEED
    errors = run.timed("variances", variance_errors)
    with run.step("streamed, each in a process"):
        lengths = QUICK_LENGTHS if run.quick else LENGTHS
        streamed = [measured(n, "streamed") for n in lengths]
    with run.step("whole, each in a process"):
        whole = [measured(n, "whole") for n in (QUICK_WHOLE if run.quick else WHOLE)]
    before, last = whole[-2:]
    grown = MIB * (last["memory [MiB]"] - before["memory [MiB]"])
    each = grown / (last["samples"] - before["samples"])
    exponent = check_variances(page, errors)
    with run.step("each statistic by itself"):
        by_itself = series.one_by_one(streamed[1]["samples"])
    differences = {
        name: difference(streamed[1]["statistics"][name], value)
        for name, value in by_itself.items()
    }
    check_chunks(page, streamed, differences)
    state_limits(page, errors, streamed, max(differences.values()), each)
    show(page, errors, streamed, whole, each)
    page.data("bytes_per_sample_in_memory", each)
    page.data("slope", exponent)


def difference(value: float, reference: float) -> float:
    """Relative difference; of a reference of zero the value itself."""
    return abs(value / reference - 1 if reference else value)


def check_variances(page: Page, errors: dict[str, Floats]) -> float:
    """Digits lost with the mean: with sums of squares, by an exponent, which is returned."""
    lost = errors[NAIVE]
    # where digits are lost, but not yet all of them
    sloping = (RATIOS >= 1e2) & (lost < 0.1)
    exponent = page.exponent(
        "sums of squares: power of mean over standard deviation with which digits are lost",
        RATIOS[sloping],
        lost[sloping],
        2.0,
        within=0.15,
        relative=False,
        why=f"rounding scatters: the root mean square of {HISTORIES} histories by a quarter, 0.1 "
        "decades at either end of some five decades, three times that",
        source="rounding of a sum of squares is eps (mean / deviation)^2 of the variance: Chan, "
        "Golub and LeVeque 1983, The American Statistician 37, 242-247",
    )
    page.vanishes(
        "merged chunks: worst relative error of the variance, mean up to 1e9 deviations",
        float(errors[MERGED].max()),
        within=1e-12,
        why="samples less the first are exact, and have hardly any mean: the same agreement as is "
        "required of the statistics below",
        source="the same samples less their mean, which is exact, summed without rounding",
    )
    return exponent


def check_chunks(page: Page, streamed: list[Record], differences: dict[str, float]) -> None:
    """Chunks give the same as the whole, and as theory, in the memory of a chunk."""
    for name, value in differences.items():
        page.vanishes(
            f"{streamed[1]['samples']:,} samples in chunks: {name}, relative difference from in "
            "memory",
            value,
            within=1e-12,
            why="sums of a million rounded numbers: a thousand times eps and less",
            source="fe_drivetrain.comparison.statistics: each of the whole history by itself",
        )
    shortest, longest = streamed[0], streamed[-1]
    for name, value in series.expected().items():
        page.equals(
            f"{longest['samples']:,} samples in chunks: {name}",
            longest["statistics"][name],
            value,
            within=10 / longest["samples"] ** 0.5,
            relative=value != 0.0,
            why="sampling: some 1 / sqrt(n), ten times that for all figures",
            source="integrals over the uniform numbers that the history is made of",
            measure="identity",
        )
    page.at_most(
        f"most memory of {longest['samples']:,} samples less that of {shortest['samples']:,}, over "
        "a chunk's",
        MIB * (longest["memory [MiB]"] - shortest["memory [MiB]"]) / (2 * 8 * series.CHUNK),
        4.0,
        why="a chunk's reference and model, the numbers they are made from, and one more chunk in "
        "the making while the last is still held",
        source="memory is that of a chunk, whatever the length",
        measure="identity",
    )


def answer(page: Page, errors: dict[str, Floats], longest: Record, each: float) -> None:
    """State how long a history may be, and how far from zero; bytes that each sample takes."""
    safe, merged = first_beyond(RATIOS, errors[NAIVE], SAFE), float(errors[MERGED].max())
    seconds, memory, samples = longest["time [s]"], longest["memory [MiB]"], longest["samples"]
    figures = [
        page.value("memory beyond the program's own, in chunks [MiB]", round(memory)),
        page.value("time, in chunks [s]", seconds),
        page.value("samples that fit into 2 GiB at once", ALLOWED / each),
        page.value("worst relative error of the variance, merged chunks", merged, at_most=SAFE),
    ]
    if safe is not None:
        name = "largest mean over standard deviation, by sums of squares"
        figures.append(page.value(name, rounded([safe], 2)[0]))
    page.answer(
        "How long may a load history be, and how far from zero?",
        f"In chunks, {formatted(samples)} samples take {memory:.0f}\u00a0MiB and the variance is "
        + ("always" if merged <= SAFE else "not always")
        + " correct to four digits; sums of squares only up to means of "
        f"{formatted(rounded([safe or RATIOS[-1]], 2)[0], unit='')} deviations.",
        figures,
        hero=MEMORY,
        cautions=[
            "Deviations are standard deviations of the load.",
            "Times and memory are of this machine; a history that is read at once takes "
            f"{each:.0f}\u00a0bytes per sample.",
        ],
    )


def state_limits(
    page: Page, errors: dict[str, Floats], streamed: list[Record], different: float, each: float
) -> None:
    """Answer and limits."""
    lost, kept = errors[NAIVE], f"{errors[MERGED].max():.0e}"
    safe, longest, most = first_beyond(RATIOS, lost, SAFE), streamed[-1], ALLOWED / each
    seconds, memory = longest["time [s]"], longest["memory [MiB]"]
    answer(page, errors, longest, each)
    page.say(
        f"Chunked and whole agree to {different:.0e}.",
        "The variance from sums of squares loses twice as many digits as the mean gains.",
    )
    page.limit(
        "variance from sums and sums of squares, in one pass",
        "mean over standard deviation",
        high=safe,
        criterion=f"relative error below {SAFE:g}",
        beyond=f"digits are lost as the square; at {RATIOS[-1]:.0e} the error is {lost[-1]:.0e} "
        "times the variance",
        program="does not use it",
        remedy=f"chunks merged about their means (streaming): within {kept} throughout",
    )
    page.limit(
        "comparison of whole histories in memory",
        "samples of one quantity",
        high=float(f"{most:.2g}"),
        criterion=f"below {ALLOWED / MIB:,.0f} MiB, at the {each:.0f} bytes a sample measured",
        beyond=f"{each * LENGTHS[-1] / 1024**3:.0f} GiB at {LENGTHS[-1]:.0e} samples",
        program="compare_streamed takes chunks instead",
        remedy=f"streaming: {memory:.0f} MiB at {longest['samples']:,} samples, {seconds:.1f} s",
    )


def show(
    page: Page,
    errors: dict[str, Floats],
    streamed: list[Record],
    whole: list[Record],
    each: float,
) -> None:
    """Charts of errors and of memory, table of time and memory."""
    page.section("A mean far from zero")
    page.chart(
        f"Relative error of the variance of {SAMPLES:,} samples, root mean square of {HISTORIES} "
        "histories; shaded is where sums of squares keep four digits. No error at all is drawn at "
        "1e-17",
        [marked(name, RATIOS, np.maximum(values, 1e-17)) for name, values in errors.items()],
        "mean over standard deviation",
        "relative error",
        "xy",
        (None, first_beyond(RATIOS, errors[NAIVE], SAFE)),
    )
    page.section("Length")
    last = whole[-1]
    page.chart(
        MEMORY,
        [
            *(
                marked(rows[0]["way"], column(rows, "samples"), column(rows, "memory [MiB]"))
                for rows in (streamed, whole)
            ),
            trace(
                "whole, by its line",
                [last["samples"], LENGTHS[-1]],
                [last["memory [MiB]"], each * LENGTHS[-1] / MIB],
                line={"dash": "dot"},
            ),
        ],
        "samples",
        "memory [MiB]",
        "xy",
        (None, ALLOWED / each),
    )
    page.table(
        "Time and memory, making the samples included",
        [*streamed, *whole],
        ["way", "samples", "time [s]", "memory [MiB]"],
    )
    page.text(
        "Chunks are read twice: once for means and products about them, and once for what depends "
        "on the reference's size, the percentage's cut and the residuals of the model uncertainty."
    )


def first_beyond(x: Floats, error: Floats, allowed: float) -> float | None:
    """Where an error first passes what is allowed, by straight lines in logarithms."""
    beyond = np.flatnonzero(error > allowed)
    if not len(beyond) or beyond[0] == 0:
        return None
    k = int(beyond[0])
    share = np.log(allowed / error[k - 1]) / np.log(error[k] / error[k - 1])
    return float(np.exp(np.log(x[k - 1]) + share * np.log(x[k] / x[k - 1])))
