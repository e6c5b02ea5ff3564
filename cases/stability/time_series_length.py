"""Long load histories: digits lost far from zero, and memory."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Samples of the histories whose variance is taken, and how many of these.
SAMPLES, HISTORIES = 20_000, 8
SEED = 11

#: Samples of the longest history, and those compared whole.
LONGEST, QUICK_LONGEST = 100_000_000, 1_000_000
WHOLE = (100_000, 1_000_000, 3_000_000)
QUICK_WHOLE = (100_000, 1_000_000)

#: Memory that a comparison may take beside the program's own [bytes].
ALLOWED = 2 * 1024**3

#: Error of a variance that counts as safe: four digits.
SAFE = 1e-4

MIB = 1024**2


def run(run: Run) -> Any:
    """Variances against their mean, then memory against length."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        streamed_series as series,
    )
    from fe_drivetrain.compare import moments
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace

    ratios = 10.0 ** np.arange(0, 10)
    naive, plain, merged = (np.empty((len(ratios), HISTORIES)) for _ in range(3))
    rng = np.random.default_rng(SEED)
    waves = rng.standard_normal((HISTORIES, SAMPLES))
    with run.step("variances"):
        for i, ratio in enumerate(ratios):
            for k, wave in enumerate(waves):
                x = ratio + wave
                exact = _variance(x - ratio)
                origin = np.array([[x[0]], [x[0]], [0.0]])
                of = moments(x[:1, None], x[:1, None], origin)
                for start in range(1, SAMPLES, 777):
                    some = x[start : start + 777, None]
                    of = of.merged(moments(some, some, origin))
                naive[i, k] = (x @ x - x.sum() ** 2 / SAMPLES) / SAMPLES / exact - 1
                plain[i, k] = x.var() / exact - 1
                merged[i, k] = of.products[0, 0, 0] / SAMPLES / exact - 1
    size = {
        "sums of squares": np.sqrt((naive**2).mean(axis=1)),
        "two passes": np.sqrt((plain**2).mean(axis=1)),
        "merged chunks": np.sqrt((merged**2).mean(axis=1)),
    }
    lost = size["sums of squares"]
    # where digits are lost, but not yet all of them
    sloping = (ratios >= 1e2) & (lost < 0.1)
    slope = float(np.polyfit(np.log(ratios[sloping]), np.log(lost[sloping]), 1)[0])
    safe = _first_beyond(ratios, lost, SAFE)

    longest = QUICK_LONGEST if run.quick else LONGEST
    lengths = [n for n in (100_000, 1_000_000, 10_000_000, 100_000_000) if n <= longest]
    with run.step("streamed, each in a process"):
        streamed = [_measured(n, "streamed") for n in lengths]
    with run.step("whole, each in a process"):
        whole_of = QUICK_WHOLE if run.quick else WHOLE
        whole = [_measured(n, "whole") for n in whole_of]
    memory = {
        name: [one["peak"] - one["before"] for one in found]
        for name, found in (("streamed", streamed), ("whole", whole))
    }
    each = (memory["whole"][-1] - memory["whole"][-2]) / (whole_of[-1] - whole_of[-2])
    most = ALLOWED / each
    same = {
        name: abs(
            streamed[1]["statistics"][name] / whole[1]["statistics"][name] - 1
            if whole[1]["statistics"][name]
            else streamed[1]["statistics"][name]
        )
        for name in series.STATISTICS
    }
    known = series.expected()

    verdicts = [
        judge(
            "sums of squares: power of mean over standard deviation with which digits go",
            slope,
            2.0,
            tolerance=0.15,
            relative=False,
            source="rounding of a sum of squares is eps (mean / deviation)^2 of the variance: "
            "Chan, Golub and LeVeque 1983, The American Statistician 37, 242-247",
            reason=f"rounding scatters: the root mean square of {HISTORIES} histories by a "
            "quarter, 0.1 decades at either end of some five decades, three times that",
            measure="order",
        ),
        judge(
            "merged chunks: worst relative error of the variance, mean up to 1e9 deviations",
            float(size["merged chunks"].max()),
            0.0,
            tolerance=1e-12,
            relative=False,
            source="the same samples less their mean, which is exact, summed without rounding",
            reason="samples less the first are exact, and hold no mean to speak of: the same "
            "agreement as is asked of the statistics below",
            measure="identity",
        ),
        *(
            judge(
                f"{lengths[1]:,} samples in chunks: {name}, relative difference from in memory",
                value,
                0.0,
                tolerance=1e-12,
                relative=False,
                source="fe_drivetrain.compare.statistics of the whole history",
                reason="sums of a million rounded numbers: a thousand times eps and less",
                measure="identity",
            )
            for name, value in same.items()
        ),
        *(
            judge(
                f"{lengths[-1]:,} samples in chunks: {name}",
                streamed[-1]["statistics"][name],
                value,
                tolerance=10 / lengths[-1] ** 0.5,
                source="integrals over the evenly spread numbers that the history is made of",
                reason="sampling: some 1 / sqrt(n), ten times that for all figures",
                measure="identity",
                relative=value != 0.0,
            )
            for name, value in known.items()
        ),
        judge(
            f"most memory of {lengths[-1]:,} samples less that of {lengths[0]:,}, over a chunk's",
            (memory["streamed"][-1] - memory["streamed"][0]) / (2 * 8 * series.CHUNK),
            0.0,
            tolerance=4.0,
            relative=False,
            source="memory is that of a chunk, whatever the length",
            reason="a chunk's reference and model, the numbers they are made from, and one more "
            "chunk in the making while the last is still held",
            measure="identity",
        ),
    ]
    limits = [
        Limit(
            method="variance from sums and sums of squares, in one pass",
            parameter="mean over standard deviation",
            low=None,
            high=safe,
            criterion=f"relative error below {SAFE:g}",
            beyond=f"digits go as the square; at {ratios[-1]:.0e} it is {lost[-1]:.0e} times wrong",
            program="does not use it",
            remedy="chunks merged about their means (streaming): within "
            f"{size['merged chunks'].max():.0e} throughout",
        ),
        Limit(
            method="comparison of whole histories in memory",
            parameter="samples of one quantity",
            low=None,
            high=float(f"{most:.2g}"),
            criterion=f"below {ALLOWED / MIB:,.0f} MiB, at the {each:.0f} bytes a sample measured",
            beyond=f"{each * LONGEST / 1024**3:.0f} GiB at {LONGEST:.0e} samples",
            program="compare_streamed takes chunks instead",
            remedy=f"streaming: {memory['streamed'][-1] / MIB:.0f} MiB at {lengths[-1]:,} samples, "
            f"{streamed[-1]['seconds']:.1f} s",
        ),
    ]
    return CASE.results(
        run,
        seed=SEED,
        summary=[
            f"A history of {lengths[-1]:,} samples is compared in {streamed[-1]['seconds']:.1f} s "
            f"and {memory['streamed'][-1] / MIB:.0f} MiB beside the program's own memory; in "
            f"memory a sample takes {each:.0f} bytes, so that 2 GiB end at {most:.1e} samples. "
            f"Chunked and whole agree to {max(same.values()):.0e}.",
            f"The naive variance has four digits up to a mean of {safe or float('nan'):.1e} "
            "standard deviations, and loses twice as many digits as the mean gains; merged chunks "
            f"keep {size['merged chunks'].max():.0e} at {ratios[-1]:.0e}.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="A mean far from zero",
                items=[
                    chart(
                        f"Relative error of the variance of {SAMPLES:,} samples, root mean square "
                        f"of {HISTORIES} histories; shaded is where sums of squares keep four "
                        "digits. What has no error at all stands at 1e-17",
                        [
                            trace(name, ratios, np.maximum(values, 1e-17), mode="lines+markers")
                            for name, values in size.items()
                        ],
                        "mean over standard deviation",
                        "relative error",
                        ("x", "y"),
                        safe=(None, safe),
                    ),
                ],
            ),
            Section(
                title="Length",
                items=[
                    chart(
                        "Most memory beside the program's own, each in a process of its own; "
                        "shaded is where a whole history takes less than 2 GiB",
                        [
                            trace(
                                name,
                                of,
                                np.array(memory[name]) / MIB,
                                mode="lines+markers",
                            )
                            for name, of in (("streamed", lengths), ("whole", whole_of))
                        ]
                        + [
                            trace(
                                "whole, by its line",
                                [whole_of[-1], LONGEST],
                                [memory["whole"][-1] / MIB, each * LONGEST / MIB],
                                line={"dash": "dot"},
                            )
                        ],
                        "samples",
                        "memory [MiB]",
                        ("x", "y"),
                        safe=(None, most),
                    ),
                    Table(
                        caption="Time and memory, making the samples included",
                        columns=["way", "samples", "time [s]", "memory [MiB]"],
                        rows=[
                            [name, n, one["seconds"], taken / MIB]
                            for name, of, found in (
                                ("streamed", lengths, streamed),
                                ("whole", whole_of, whole),
                            )
                            for n, one, taken in zip(of, found, memory[name], strict=True)
                        ],
                    ),
                    Text(
                        text="Chunks are read twice: once for means and products about them, and "
                        "once for what hangs on the reference's size, the percentage's cut and the "
                        "residuals of the model uncertainty."
                    ),
                ],
            ),
        ],
        limits=limits,
        figures={"bytes_per_sample_in_memory": each, "slope": slope},
    )


def _variance(x: Any) -> float:
    """Of samples near zero, summed without rounding."""
    import math

    mean = math.fsum(x) / len(x)
    return math.fsum((x - mean) ** 2) / len(x)


def _first_beyond(x: Any, error: Any, allowed: float) -> float | None:
    """Where an error first passes what is allowed, by straight lines in logarithms."""
    import numpy as np

    beyond = np.flatnonzero(error > allowed)
    if not len(beyond) or beyond[0] == 0:
        return None
    k = int(beyond[0])
    share = np.log(allowed / error[k - 1]) / np.log(error[k] / error[k - 1])
    return float(np.exp(np.log(x[k - 1]) + share * np.log(x[k] / x[k - 1])))


def _measured(samples: int, way: str) -> Any:
    """What a comparison took in a process of its own."""
    import json

    from fe_drivetrain.common import run_python

    program = "fe_drivetrain.cases.stability.streamed_series"
    done = run_python("-m", program, str(samples), way)
    done.check_returncode()
    return json.loads(done.stdout)


CASE = Case(
    name="stability/time_series_length",
    title="Long load histories: digits far from zero, time and memory",
    source="Welford 1962, Technometrics 4, 419-420; Chan, Golub and LeVeque 1983, The American "
    "Statistician 37, 242-247",
    run=run,
    alone=True,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
