"""Hub loads of the study, the user's or the surrogate's, and the charts over them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common import (
    FORCES,
    Floats,
    InputError,
    user_cache,
)
from fe_drivetrain.compare import statistics
from fe_drivetrain.hub_loads import (
    Condition,
    assumptions,
    hub_load_set,
    not_kept,
    read_hub_loads,
    surrogate_grid,
)
from fe_drivetrain.report import Chart, rounded, trace
from fe_drivetrain.suite import Jobs, Page, Run

#: Seeds of each group under --quick: the least that has a standard deviation.
QUICK_SEEDS = 2

Pairs = Mapping[str, tuple[str, Floats]]
_PLANES = (("horizontal", "Fy", 1), ("vertical", "Fz", 2))


@dataclass(frozen=True, eq=False)
class HubLoads:
    """Histories stacked for one matrix product.

    Attributes
    ----------
    time : Floats
        (n,) [s].
    loads : Floats
        (m, n, 6) [N, N m].
    names : tuple[str, ...]
        (m,) of the histories.
    conditions : tuple[Condition, ...]
        (m,) of a surrogate; empty for the user's own files.
    statement : str
        What the loads are, for the page.
    assumptions : list[tuple[str, float, str, str]]
        (name, value, unit, source) of the surrogate.
    seed : int or None
        None for the user's own files.
    """

    time: Floats
    loads: Floats
    names: tuple[str, ...]
    conditions: tuple[Condition, ...]
    statement: str
    assumptions: list[tuple[str, float, str, str]]
    seed: int | None


def own_hub_loads(run: Run) -> HubLoads | None:
    """The user's files: ``--set loads=FILE``, a folder, or a pattern; None where not given."""
    if "loads" not in run.settings:
        return None
    with run.step("hub loads"):
        return _read(str(run.settings["loads"]))


def surrogate_hub_loads(run: Run, jobs: Jobs) -> HubLoads:
    """Made hub loads; those that were not made before are made side by side."""
    grid = surrogate_grid()
    if run.quick:
        grid = [c for c in grid if c.seed <= QUICK_SEEDS]
    groups: dict[float, list[Condition]] = {}
    for condition in not_kept(grid):
        groups.setdefault(condition.wind_speed, []).append(condition)
    making = [jobs.start(_make, wind_speed, group) for wind_speed, group in groups.items()]
    for job in making:
        job.result()
    with run.step("hub loads") as step:
        histories = hub_load_set(
            grid, progress=lambda done, of: run.report(f"hub loads ({done} of {of})")
        )
        if not groups and user_cache().folder is not None:
            step.name += ", from the cache"
    return HubLoads(
        histories.time,
        histories.loads,
        tuple(c.name for c in histories.conditions),
        histories.conditions,
        f"Hub loads are a surrogate: {len(grid)} ten-minute histories at 20 Hz of a 2 MW, 80 m, "
        "three-bladed rotor, quasi-steady blade elements in Kaimal turbulence, over the thesis's "
        "grid of wind speed, turbulence and shear. They stand in for the thesis's Bladed "
        "histories, which are not public; the same comparison on your own histories: "
        "--set loads=FOLDER.",
        list(assumptions()),
        1,
    )


def _make(run: Run, wind_speed: float, conditions: Sequence[Condition]) -> None:
    """Make histories, which the cache keeps."""
    name = f"hub loads, {wind_speed:g} m/s"
    with run.step(name):
        hub_load_set(conditions, progress=lambda done, of: run.report(f"{name} ({done} of {of})"))


def _read(pattern: str) -> HubLoads:
    path = Path(pattern)
    suffixes = (".out", ".outb", ".csv")
    if path.is_dir():
        files = sorted(f for f in path.iterdir() if f.suffix.lower() in suffixes)
    elif path.exists() or not any(c in pattern for c in "*?["):
        files = [path]
    else:
        files = sorted(path.parent.glob(path.name))
    if not files:
        raise InputError(f"loads = {pattern!r}: no {', '.join(suffixes)} file is there")
    histories = [read_hub_loads(f) for f in files]
    first = histories[0]
    for file, history in zip(files, histories, strict=True):
        if len(history.time) != len(first.time):
            raise InputError(
                f"{file} has {len(history.time)} samples and {files[0]} has {len(first.time)}: "
                "cut the histories to one length"
            )
    loads = np.stack([history.loads for history in histories])
    if not loads.any():
        raise InputError(f"loads = {pattern!r}: all hub loads are zero: give histories with loads")
    return HubLoads(
        np.asarray(first.time),
        loads,
        tuple(history.name for history in histories),
        (),
        f"Hub loads: {len(files)} file{'s' if len(files) > 1 else ''} of your own, "
        f"{len(first.time):,} samples each.",
        [],
        None,
    )


def load_table(page: Page, hub: HubLoads) -> None:
    """Range of each component, where a wrong sign or unit shows."""
    flat = hub.loads.reshape(-1, 6) / 1e3
    units = 3 * ["kN"] + 3 * ["kN\u00a0m"]
    page.table(
        "Hub loads over all histories, in the non-rotating shaft frame at the hub",
        [
            {
                "component": f"{component} [{unit}]",
                "least": flat[:, k].min(),
                "mean": flat[:, k].mean(),
                "largest": flat[:, k].max(),
                "standard deviation": flat[:, k].std(),
            }
            for k, (component, unit) in enumerate(zip(FORCES, units, strict=True))
        ],
    )


def write_reactions(folder: Path, hub: HubLoads, fe: Mapping[str, Floats]) -> None:
    """FE reactions of the user's own histories as CSV, one file a history and bearing type."""
    for kind, reaction in fe.items():
        for name, history in zip(hub.names, reaction, strict=True):
            np.savetxt(
                folder / f"reactions_{kind}_{name}.csv",
                np.column_stack([hub.time, history]),
                delimiter=",",
                fmt="%.9g",
                header="time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]",
                comments="",
            )


def rmse_charts(
    page: Page, conditions: Sequence[Condition], fe: Mapping[str, Floats], pairs: Pairs
) -> None:
    """RMSE per plane against mean wind speed: mean and standard deviation of each seed group."""
    groups = [(c.wind_speed, c.turbulence, c.shear) for c in conditions]
    for label, (kind, model) in pairs.items():
        for plane, quantity, component in _PLANES:
            rmse = statistics.rmse(fe[kind][..., component], model[..., component]) / 1e3
            by_group = statistics.by_group(rmse, groups)
            traces = []
            found: list[Any] = list(by_group.groups)
            order = ("low", "medium", "high")
            series = sorted({g[1:] for g in found}, key=lambda s: (s[1], order.index(s[0])))
            for k, (turbulence, shear) in enumerate(series):
                rows = [i for i, g in enumerate(found) if g[1:] == (turbulence, shear)]
                # Staggered about the mean wind speed, as in the thesis, for clarity.
                wind = [found[i][0] + 0.25 * (k - (len(series) - 1) / 2) for i in rows]
                traces.append(
                    trace(
                        f"{turbulence} turbulence, shear {shear:g}",
                        wind,
                        by_group.mean[rows],
                        mode="markers",
                        marker={"symbol": "circle" if shear < 0.4 else "diamond", "size": 8},
                        error_y={"type": "data", "array": rounded(by_group.std[rows])},
                    )
                )
            page.add(
                Chart(
                    caption=f"RMSE, {label}, {plane} plane ({quantity}): mean and standard "
                    "deviation over the seeds of each group, staggered about the mean wind speed",
                    figure={
                        "data": traces,
                        "layout": {
                            "xaxis": {
                                "title": {"text": "mean wind speed [m/s]"},
                                "tickvals": sorted({g[0] for g in groups}),
                            },
                            "yaxis": {
                                "title": {"text": f"RMSE of {quantity} [kN]"},
                                "rangemode": "tozero",
                            },
                        },
                    },
                )
            )


def series_charts(
    page: Page, hub: HubLoads, fe: Mapping[str, Floats], pairs: Pairs, seconds: float = 60.0
) -> None:
    """The beginning of one history, FE and beams, per plane."""
    chosen = len(hub.names) // 2
    shown = hub.time - hub.time[0] <= seconds
    shown_seconds = min(seconds, float(hub.time[-1] - hub.time[0]))
    for plane, quantity, component in _PLANES:
        for kind in ("spherical", "bonded"):
            traces = [
                trace(
                    f"{kind} FE",
                    hub.time[shown],
                    fe[kind][chosen, shown, component] / 1e3,
                    line={"width": 3},
                )
            ]
            traces += [
                trace(
                    label.partition(" against")[0],
                    hub.time[shown],
                    model[chosen, shown, component] / 1e3,
                    line={"dash": dash},
                )
                for (label, (of, model)), dash in zip(
                    pairs.items(), ("dash", "dash", "dot", "dashdot"), strict=True
                )
                if of == kind
            ]
            page.chart(
                f"Load on the {kind} main bearing, {plane} plane ({quantity}): first "
                f"{shown_seconds:.0f} s of {hub.names[chosen]}",
                traces,
                "time [s]",
                f"{quantity} [kN]",
            )


def scatter_charts(
    page: Page, fe: Mapping[str, Floats], pairs: Pairs, points: int = 1500, seed: int = 0
) -> None:
    """FE against beam for each quantity of the bonded bearing, on a random choice of samples."""
    reference = fe["bonded"].reshape(-1, 6)
    generator = np.random.default_rng(seed)
    chosen = generator.choice(len(reference), min(points, len(reference)), replace=False)
    for quantity, component in (("Fy", 1), ("Fz", 2), ("My", 4), ("Mz", 5)):
        x = reference[chosen, component] / 1e3
        unit = "kN" if component < 3 else "kN m"
        ends = np.array([x.min(), x.max()])
        traces = [trace("equal", ends, ends, line={"color": "#888888", "width": 1})]
        traces += [
            trace(
                label.partition(" against")[0],
                x,
                model.reshape(-1, 6)[chosen, component] / 1e3,
                mode="markers",
                marker={"size": 4, "opacity": 0.6},
            )
            for label, (kind, model) in pairs.items()
            if kind == "bonded"
        ]
        page.chart(
            f"{quantity} on the bonded main bearing, beams against FE: "
            f"{len(chosen):,} of {len(reference):,} samples, chosen at random",
            traces,
            f"{quantity}, FE [{unit}]",
            f"{quantity}, beam [{unit}]",
        )
