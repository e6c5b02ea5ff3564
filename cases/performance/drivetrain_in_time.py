"""A whole drivetrain in time under histories: steps a second, growth, memory, and a farm of files.

Steps of 1 ms with shafts of six degrees of freedom and planets on rollers, digests in place of
samples. Histories are made here, of a fixed seed each.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, cores, peak_memory, scratch_folder, timed_runs
from fe_drivetrain.common.processes import Processes
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.dynamics import Machine, Rung, machine_of
from fe_drivetrain.dynamics.bodies.condensed_rungs import Rungs, plain_rungs, with_rollers
from fe_drivetrain.geometry.shaft import Section
from fe_drivetrain.report import error_bars, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies.transient_digest import FileDigest, digests, driven, moving_under
from fe_drivetrain.studies.transient_events import rated_of
from fe_drivetrain.studies.transient_histories import OperationOptions
from fe_drivetrain.studies.transient_runs import Prepared, Rated
from fe_drivetrain.turbine_loads.histories.cycles import rainflow_cycles

STEP, WHOLE, MANY = 1e-3, 600.0, 100  # s, s, files
SPRINGS, ROLLERS = "on springs", "on rollers"
#: Seconds of motion: measured for steps a second, of each file, of each length for memory.
MEASURED, QUICK_MEASURED = 20.0, 0.3
EACH, QUICK_EACH = 6.0, 0.2
LENGTHS, QUICK_LENGTHS = (60.0, 180.0, 600.0), (0.2, 0.4)
FILES, QUICK_FILES = 100, 2
REFINED, QUICK_REFINED = (2, 4), (2,)
#: Seconds over which steps are compared, and the steps, the last of which is the reference [s].
SHORT, QUICK_SHORT = 2.0, 0.05
STEPS = (1e-3, 5e-4, 2.5e-4, 3.125e-5)
HEADS = "Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m],rotor speed [rad/s]"
RATE, DEGREES = "steps a second and core, median", "degrees of freedom"
GROWS = "Time of a step over the degrees of freedom; bars: least and most of all runs"
WITHIN, OF_SECOND = "error of mesh forces over the largest", "processor time for a second [s]"


def write_loads(path: Path, seed: int, seconds: float) -> Path:
    """Write a made history of rated operation: slow wind, turbulence and 3P."""
    rng, t = np.random.default_rng(seed), np.arange(0.0, seconds + 0.06, 0.05)

    def wave(low: float, high: float) -> Floats:
        f, phase = rng.uniform(low, high, 24), rng.uniform(0.0, 2.0 * np.pi, 24)
        return np.asarray(np.sin(2.0 * np.pi * np.outer(t, f) + phase).sum(axis=1) / np.sqrt(12.0))

    thrice = np.cos(3.0 * 1.267 * t)
    found = np.column_stack(
        [
            t,
            5e5 * (1.0 + 0.1 * wave(0.02, 0.5)),
            np.zeros(len(t)),
            np.full(len(t), -1.1e6),
            3.946e6 * (1.0 + 0.05 * wave(0.02, 1.0) + 0.02 * thrice),
            1e6 * wave(0.05, 1.0) + 3e5 * thrice,
            1e6 * wave(0.05, 1.0),
            1.267 * (1.0 + 0.01 * wave(0.01, 0.1)),
        ]
    )
    np.savetxt(path, found, "%.9g", ",", header=f"time [s],{HEADS}", comments="")
    return path


def drivetrain() -> tuple[Machine, Rated, dict[str, Rung]]:
    """The NREL 5 MW drivetrain with flexible shafts: bearings on springs, and on rollers."""
    stated = read_drivetrain("nrel_5mw")
    machine = machine_of(stated)
    rungs = with_rollers(Rungs(plain_rungs(stated, machine), {}), machine).rungs
    return machine, rated_of(stated, 0.0), {SPRINGS: rungs[-2], ROLLERS: rungs[-1]}


def finer_machines(machine: Machine, times: Sequence[int]) -> list[tuple[int, Machine]]:
    """The machine with so many times as many elements of each shaft."""
    return [(k, refined(machine, k)) for k in times]


def refined(machine: Machine, times: int) -> Machine:
    """The machine with so many times as many elements of each shaft."""
    shafts, count = [], 6 * times
    for shaft in machine.shafts:
        sections = shaft.sections
        if sections is None and shaft.outer is not None:
            sections = (Section(length=shaft.length, outer_diameter=shaft.outer),)
        if shaft.kind == "shaft" and sections is not None:
            pieces = tuple(
                one.model_copy(update={"length": one.length / count})
                for one in sections
                for _ in range(count)
            )
            shaft = shaft.model_copy(update={"sections": pieces, "outer": None})
        shafts.append(shaft)
    return machine.model_copy(update={"shafts": shafts})


@case(
    "A whole drivetrain in time: steps a second, growth, memory, many files",
    source="NREL 5 MW reference drivetrain, shafts with six degrees of freedom, catalogued "
    "bearings on rollers; made histories; measured in one run",
    settings={
        "files": "100 (quick 2; from 2)",
        "repeats": "5 (quick 1; from 1)",
    },
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Measure each, and check that digests are those of samples and of one process."""
    machine, rated, rungs = drivetrain()
    repeats = run.count("repeats", 1 if run.quick else 5)
    count = run.count("files", QUICK_FILES if run.quick else FILES, least=2)
    with scratch_folder() as folder:
        long = write_loads(folder / "long.csv", 0, WHOLE)
        with run.step("steps a second"):
            span = QUICK_MEASURED if run.quick else MEASURED
            rows = [
                paced(name, machine, rated, rung, long, span, repeats)
                for name, rung in rungs.items()
            ]
        with run.step("growth"):
            grown = [
                paced(f"{name}, {k} x elements", finer, rated, rung, long, span, repeats)
                for k, finer in finer_machines(machine, QUICK_REFINED if run.quick else REFINED)
                for name, rung in rungs.items()
            ]
        with run.step("memory over length"):
            lengths = QUICK_LENGTHS if run.quick else LENGTHS
            memory = [remembered(machine, rated, rungs[ROLLERS], long, one) for one in lengths]
        with run.step("digests and samples"):
            check_digest(page, machine, rated, rungs[ROLLERS], long, span)
        with run.step("files"):
            each = QUICK_EACH if run.quick else EACH
            of = [write_loads(folder / f"made_{k}.csv", k, each) for k in range(1, count + 1)]
            farm = farmed(run, page, machine, rated, rungs[ROLLERS], of)
        with run.step("error over the step"):
            errors = over_steps(
                machine, rated, rungs[ROLLERS], long, QUICK_SHORT if run.quick else SHORT
            )
    answer(page, rows, memory, farm, run.quick)
    show(page, rows, grown, memory, farm, errors)


def options(step: float, until: float | None = None) -> OperationOptions:
    """How histories are counted."""
    return OperationOptions(step=step, until=until)


def paced(
    name: str, machine: Machine, rated: Rated, rung: Rung, file: Path, span: float, repeats: int
) -> Record:
    """Processor time of a step, digest included, on one core."""
    asked = options(STEP, span)
    history = asked.read(file)
    begin = time.process_time()
    prepared = Prepared(machine, rung, rated, hub_loads=True)
    moving = moving_under(prepared.of, history, rated.slip)
    before = time.process_time() - begin
    driven(prepared, history, options(STEP, 2.0 * STEP), moving)  # loads compiled code
    until = float(history.time[0]) + span
    _, times = timed_runs(
        lambda: driven(prepared, history, asked, moving), repeats, clock=time.process_time
    )
    _, alone = timed_runs(
        lambda: sum(len(one.times) for one in moving.pieces(STEP, until)),
        repeats,
        clock=time.process_time,
    )
    steps = round(span / STEP)
    return {
        "level": name,
        DEGREES: len(prepared.of.system.names),
        RATE: steps / times.median,
        "steps a second, least": steps / times.most,
        "steps a second, most": steps / times.least,
        "step, least [µs]": 1e6 * times.least / steps,
        "step, median [µs]": 1e6 * times.median / steps,
        "step, most [µs]": 1e6 * times.most / steps,
        "of it the motion [%]": 100.0 * alone.median / times.median,
        "to begin [s]": before,
    }


def peak(
    _report: Progress, machine: Machine, rated: Rated, rung: Rung, file: Path, span: float
) -> tuple[float, float]:
    """Largest memory of this process [MB], and its energy from nowhere, after a history."""
    asked = options(STEP, span)
    prepared = Prepared(machine, rung, rated, hub_loads=True)
    found, _ = driven(prepared, asked.read(file), asked)
    return (peak_memory() or np.nan) / 1e6, found.imbalance


def remembered(
    machine: Machine, rated: Rated, rung: Rung, file: Path, span: float
) -> tuple[float, float, float]:
    """Length [s], memory of a process of its own [MB], and energy from nowhere."""
    with Processes(1, silent, always=True) as one:
        return (span, *one.start(peak, machine, rated, rung, file, span).result())


def check_digest(
    page: Page, machine: Machine, rated: Rated, rung: Rung, file: Path, span: float
) -> None:
    """Compare the digest of a history in pieces with all of its samples."""
    asked = options(STEP, span)
    history = asked.read(file)
    prepared = Prepared(machine, rung, rated, hub_loads=True)
    found, _ = driven(prepared, history, asked)
    moving, channels = moving_under(prepared.of, history, rated.slip), prepared.channels
    parts = [channels.of(one) for one in moving.pieces(STEP, float(history.time[0]) + span)]
    values = np.concatenate([parts[0], *(one[1:] for one in parts[1:])])
    slope, worst, most = float(asked.slopes[-1]), 0.0, 0.0
    for name, samples in zip(channels.names, values.T, strict=True):
        digest, cycles = found.channels[name], rainflow_cycles(samples)
        damage = float((cycles.counts * cycles.ranges**slope).sum())
        worst = max(worst, abs(digest.damage[-1] / damage - 1.0) if damage else 0.0)
        most = max(most, abs(digest.most - samples.max()), abs(digest.least - samples.min()))
    page.vanishes(
        f"sums of n r^{slope:g} of {len(channels.names)} channels by the digest, over those of all "
        "samples, less 1, the largest",
        worst,
        within=1e-9,
        why="rounding of sums of many powers",
        source="rainflow_cycles of all samples at once",
    )
    page.vanishes(
        "extremes by the digest less those of all samples",
        most,
        within=0.0,
        why="the same samples",
        source="largest and least of all samples",
    )
    page.vanishes(
        "energy from nowhere over the largest",
        found.imbalance,
        within=1e-5,
        why="a rotor in motion holds nearly all energy, so that forces need far less than 1 %",
        source="work of loads, dampers and generator against motion and strain",
    )
    page.holds(
        "Newton's method converged in every step",
        found.not_converged == 0,
        why="forces of rollers would be wrong else",
        source="its residual",
    )


def farmed(
    run: Run, page: Page, machine: Machine, rated: Rated, rung: Rung, files: Sequence[Path]
) -> Record:
    """Digests of many files on all cores, beside those of the first ones in this process."""
    asked = options(STEP)
    begin = time.perf_counter()
    found = list(digests(files, machine, rung, rated, asked, False, run.report))
    wall = time.perf_counter() - begin
    again: list[FileDigest] = []
    begin = time.process_time()
    for file in files[:2]:
        prepared = Prepared(machine, rung, rated, hub_loads=True)
        again.append(driven(prepared, asked.read(file), asked)[0])
    alone = (time.process_time() - begin) / len(again)
    apart = max(
        max(
            np.abs(np.array(one.damage) - other.damage).max() / max(*one.damage, 1e-300),
            abs(one.most - other.most) / size,
            abs(one.mean - other.mean) / size,
        )
        for mine, theirs in zip(found, again, strict=False)
        for one, other in zip(mine.channels.values(), theirs.channels.values(), strict=True)
        if (size := max(abs(one.most), abs(one.least))) > 0.0
    )
    page.vanishes(
        "digests of files on all cores less those of this process, relative",
        apart,
        within=1e-5,
        why="the same operations, but sums in another order where a process has more threads; "
        "rollers are solved to a tolerance, and a damage has the power of its slope",
        source="the same files, one by one in this process",
    )
    seconds = sum(one.seconds for one in found)
    import resource  # which Windows does not have

    return {
        "files": len(files),
        "cores": cores(),
        "seconds of each": seconds / len(found),
        "wall time [s]": wall,
        "steps a second, all cores": seconds / STEP / wall,
        "processor time of a file, one process [s]": alone,
        "largest memory of a process [MB]": resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        / 1e3,
    }


def over_steps(machine: Machine, rated: Rated, rung: Rung, file: Path, span: float) -> list[Record]:
    """Error of mesh forces, and processor time, over the step, against the shortest step."""
    history = options(STEPS[0]).read(file)
    prepared = Prepared(machine, rung, rated, hub_loads=True)
    meshes = [k for k, kind in enumerate(prepared.channels.kinds) if kind == "mesh"]
    moving = moving_under(prepared.of, history, rated.slip)
    until = float(history.time[0]) + span

    def forces(step: float) -> Floats:
        parts = [prepared.channels.of(one)[:, meshes] for one in moving.pieces(step, until)]
        whole = np.concatenate([parts[0], *(one[1:] for one in parts[1:])])
        return np.asarray(whole[:: round(STEPS[0] / step)])

    exact = forces(STEPS[-1])
    rows: list[Record] = []
    for step in STEPS[:-1]:
        found, times = timed_runs(partial(forces, step), 1, clock=time.process_time)
        apart = np.abs(found - exact).max(axis=0) / np.abs(exact).max(axis=0)
        rows.append({"step [s]": step, WITHIN: float(apart.max()), OF_SECOND: times.median / span})
    return rows


def answer(
    page: Page,
    rows: list[Record],
    memory: list[tuple[float, float, float]],
    farm: Record,
    quick: bool,
) -> None:
    """State steps a second, memory, and what a hundred files of ten minutes take."""
    springs, rollers = rows
    begins = float(rollers["to begin [s]"])
    whole = WHOLE / STEP / float(rollers[RATE]) + begins
    plain = WHOLE / STEP / float(springs[RATE]) + float(springs["to begin [s]"])
    hours = MANY * whole / 2.0 / 3600.0
    more = memory[-1][1] / memory[0][1] - 1.0
    if not quick:
        page.at_most(
            f"memory of {memory[-1][0]:g} s over that of {memory[0][0]:g} s, less 1",
            more,
            0.2,
            why="pieces of equal size; what is kept for a chart is bounded",
            source="largest resident memory of a process of its own",
        )
    page.answer(
        "How fast is a whole drivetrain simulated in time?",
        f"Ten minutes at 1\u00a0kHz take {whole:.3g}\u00a0s on one core with bearings modelled "
        f"roller by roller, {plain:.3g}\u00a0s with bearings as springs.",
        [
            page.value("steps a second and core, roller by roller", float(rollers[RATE])),
            page.value("steps a second and core, bearings as springs", float(springs[RATE])),
            page.value(f"{MANY} files of ten minutes on two cores, roller by roller [h]", hours),
            page.value(f"memory after {memory[-1][0]:g} s [MB]", memory[-1][1]),
            page.value("steps a second of many files, all cores", float(farm[_ALL])),
        ],
        hero=GROWS,
        cautions=[
            f"The time of {MANY} files is extrapolated from the processor time of a step and of "
            "the start.",
            "Gear meshes have their mean stiffness; planets do not travel round.",
        ],
    )


_ALL = "steps a second, all cores"


def show(
    page: Page,
    rows: list[Record],
    grown: list[Record],
    memory: list[tuple[float, float, float]],
    farm: Record,
    errors: list[Record],
) -> None:
    """Show all that was measured."""
    page.section("Steps a second, and growth")
    page.table("Processor time of a step of 1 ms, digest included, on one core", [*rows, *grown])
    every = [*rows, *grown]
    traces = []
    for name in (SPRINGS, ROLLERS):
        of = [one for one in every if str(one["level"]).startswith(name)]
        ends = [[one[f"step, {end} [µs]"] for one in of] for end in ("least", "median", "most")]
        traces.append(
            trace(
                name,
                [one[DEGREES] for one in of],
                ends[1],
                mode="lines+markers",
                **error_bars("y", *ends),
            )
        )
    page.chart(GROWS, traces, DEGREES, "processor time of a step [µs]", "xy")
    page.data("paces", every)
    page.section("Memory over the length of a history, on rollers")
    page.table(
        "Largest memory of a process of its own",
        [
            {"length [s]": s, "memory [MB]": m, "energy from nowhere over the largest": e}
            for s, m, e in memory
        ],
    )
    page.section("Many files")
    page.table("Files on rollers, one after the other on each core, digests kept", [farm])
    page.data("farm", farm)
    page.section("Error over the step")
    page.table(f"Against a step of {STEPS[-1]:g} s, on rollers", errors)
    page.chart(
        "Error of mesh forces over the processor time of a second of motion",
        [
            trace(
                ROLLERS,
                [one[OF_SECOND] for one in errors],
                [one[WITHIN] for one in errors],
                mode="lines+markers",
            )
        ],
        OF_SECOND,
        WITHIN,
        "xy",
    )
    page.data("errors", errors)
