"""Hub loads of the study, the user's or the surrogate's, and the charts over them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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
    LoadHistory,
    assumptions,
    different_turbines,
    hub_load_set,
    not_kept,
    read_hub_load_files,
    surrogate_grid,
    vertical_forces,
)
from fe_drivetrain.report import rounded, trace
from fe_drivetrain.response import at_front
from fe_drivetrain.scene import Scene
from fe_drivetrain.suite import Jobs, Page, Run, RunJob

#: Seeds of each group under --quick: the least that has a standard deviation.
QUICK_SEEDS = 2

Pairs = Mapping[str, tuple[str, Floats]]
_PLANES = (("horizontal", "Fy", 1), ("vertical", "Fz", 2))
_STAND_IN = "They stand in for the thesis's Bladed histories, which are not public."


class UnequalHistoriesError(InputError):
    """The user's histories cannot be stacked: they have different numbers of samples."""


@dataclass(frozen=True, eq=False)
class HubLoads:
    """Histories stacked for one matrix product.

    Attributes
    ----------
    times : Floats
        (m, n) [s]: each history its own.
    loads : Floats
        (m, n, 6) about the shaft's front face [N, N m].
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
    channels : tuple[str, ...]
        (m,) which channels were read, with their sign and rotation; empty for a surrogate.
    """

    times: Floats
    loads: Floats
    names: tuple[str, ...]
    conditions: tuple[Condition, ...]
    statement: str
    assumptions: list[tuple[str, float, str, str]]
    seed: int | None
    channels: tuple[str, ...] = ()


def own_hub_loads(run: Run, scene: Scene) -> HubLoads | None:
    """The user's files: ``--set loads=FILE``, a folder, or a pattern; None where not given.

    ``--set skip=SECONDS`` leaves out the beginning of each; the scene says which point of the shaft
    they are about.
    """
    if "loads" not in run.settings:
        skip_without_loads(run)
        return None
    with run.step("hub loads"):
        return _read(str(run.settings["loads"]), skip_of(run), scene)


def skip_without_loads(run: Run) -> None:
    """Refuse to leave out the beginning of histories that are not there."""
    skip = skip_of(run)
    if skip:
        raise InputError(
            f"skip = {skip:g} leaves out the beginning of your own histories, and there are "
            "none: give them with --set loads=FOLDER, or leave out skip"
        )


def skip_of(run: Run) -> float:
    """What the user leaves out at the beginning of each history [s]."""
    skip = run.settings.get("skip", 0.0)
    if isinstance(skip, bool) or not isinstance(skip, int | float) or not 0.0 <= skip < np.inf:
        raise InputError(
            f"skip = {skip!r} must be a number of seconds from 0 on: what is left out at the "
            "beginning of each history, as in --set skip=60"
        )
    return float(skip)


def start_surrogate(run: Run, jobs: Jobs) -> list[RunJob[None]]:
    """Make those hub loads that were not made before, beside everything else."""
    groups: dict[float, list[Condition]] = {}
    for condition in not_kept(_grid(run)):
        groups.setdefault(condition.wind_speed, []).append(condition)
    return [jobs.start(_make, wind_speed, group) for wind_speed, group in groups.items()]


def _grid(run: Run) -> list[Condition]:
    return [c for c in surrogate_grid() if not run.quick or c.seed <= QUICK_SEEDS]


def surrogate_hub_loads(run: Run, making: Sequence[RunJob[None]]) -> HubLoads:
    """Made hub loads, where `start_surrogate` has begun to make them."""
    grid_of = "a" if "scene" in run.settings else "the thesis's"
    stand_in = "" if "scene" in run.settings else f" {_STAND_IN}"
    grid = _grid(run)
    for job in making:
        job.result()
    with run.step("hub loads") as step:
        histories = hub_load_set(
            grid, progress=lambda done, of: run.report(f"hub loads ({done} of {of})")
        )
        if not making and user_cache().folder is not None:
            step.name += ", from the cache"
    return HubLoads(
        np.broadcast_to(histories.time, histories.loads.shape[:2]),
        histories.loads,
        tuple(c.name for c in histories.conditions),
        histories.conditions,
        f"Hub loads are a surrogate: {len(grid)} ten-minute histories at 20 Hz of a 2 MW, 80 m, "
        f"three-bladed rotor, quasi-steady blade elements in Kaimal turbulence, over {grid_of} "
        f"grid of wind speed, turbulence and shear.{stand_in} The same comparison on your own "
        "histories: `--set loads=FOLDER`.",
        list(assumptions()),
        1,
    )


def _make(run: Run, wind_speed: float, conditions: Sequence[Condition]) -> None:
    """Make histories, which the cache keeps."""
    name = f"hub loads, {wind_speed:g} m/s"
    with run.step(name):
        hub_load_set(conditions, progress=lambda done, of: run.report(f"{name} ({done} of {of})"))


def own_histories(run: Run, scene: Scene) -> tuple[list[LoadHistory], str] | None:
    """The user's files, of any length and step, and what they are; see `own_hub_loads`."""
    if "loads" not in run.settings:
        skip_without_loads(run)
        return None
    pattern, skip = str(run.settings["loads"]), skip_of(run)
    with run.step("hub loads"):
        histories = _histories(pattern, skip, scene)
    count, samples = len(histories), sum(map(len, histories))
    seconds = sum(history.seconds for history in histories)
    return histories, (
        f"Load cases: {samples:,} samples over {seconds:,.6g} s of {count} "
        f"file{'s' if count > 1 else ''} of your own, each sample by the time that it stands for."
        + _left_out(skip, scene, histories)
    )


def _histories(pattern: str, skip: float, scene: Scene) -> list[LoadHistory]:
    histories = [at_front(scene, history) for history in read_hub_load_files(pattern, skip)]
    if not any(history.loads.any() for history in histories):
        raise InputError(f"loads = {pattern!r}: all hub loads are zero: give histories with loads")
    return histories


def _left_out(skip: float, scene: Scene, histories: Sequence[LoadHistory]) -> str:
    left_out = f" The first {skip:g} s of each are left out." if skip else ""
    if scene.loads_at != scene.shaft.front:
        left_out += f" Their moments, about x = {scene.loads_at:g} m, are moved to the front face."
    unlike = different_turbines(vertical_forces(histories))
    return f"{left_out} {unlike}" if unlike else left_out


def _read(pattern: str, skip: float, scene: Scene) -> HubLoads:
    histories = _histories(pattern, skip, scene)
    first = histories[0]
    for history in histories:
        if len(history) != len(first):
            raise UnequalHistoriesError(
                f"hub loads: {history.name} has {len(history)} samples and {first.name} has "
                f"{len(first)}{f' without the first {skip:g} s' if skip else ''}: cut the "
                "histories to one number of samples"
            )
    loads = np.stack([history.loads for history in histories])
    count = len(histories)
    return HubLoads(
        np.stack([history.time for history in histories]),
        loads,
        tuple(history.name for history in histories),
        (),
        f"Hub loads: {count} file{'s' if count > 1 else ''} of your own, "
        f"{len(first):,} samples each.{_left_out(skip, scene, histories)}",
        [],
        None,
        tuple(str(history.attributes["channels"]) for history in histories),
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
    if hub.channels:
        by_channels: dict[str, list[str]] = {}
        for name, channels in zip(hub.names, hub.channels, strict=True):
            by_channels.setdefault(channels, []).append(name)
        page.table(
            "Channels that were read, in the units of the file",
            [
                {
                    "histories": ", ".join(names[:3])
                    + (f" and {len(names) - 3} more" if len(names) > 3 else ""),
                    "channels": channels,
                }
                for channels, names in by_channels.items()
            ],
        )


ROUND_OFF = 1e-9
"""Of the largest force: what solvers leave in reactions that statics decides, and far below what
any other model leaves."""


def is_round_off(reference: Floats, model: Floats) -> bool:
    """Whether radial forces of two models (..., 6) differ by no more than round-off at any time."""
    forces = reference[..., 1:3]
    return bool(np.abs(forces - model[..., 1:3]).max() <= ROUND_OFF * np.abs(forces).max())


def rmse_charts(
    page: Page, conditions: Sequence[Condition], fe: Mapping[str, Floats], pairs: Pairs
) -> None:
    """RMSE per plane against mean wind speed: mean and standard deviation of each seed group.

    Where a beam and the FE model differ by round-off alone, a sentence says so instead.
    """
    for label, (kind, model) in pairs.items():
        if is_round_off(fe[kind], model):
            page.text(
                f"{label}: the two differ by less than {ROUND_OFF:g} of the largest radial force "
                "at any time, which is round-off: there is no error to draw."
            )
            continue
        for plane, quantity, component in _PLANES:
            rmse = statistics.rmse(fe[kind][..., component], model[..., component]) / 1e3
            group_chart(
                page,
                f"RMSE, {label}, {plane} plane ({quantity})",
                conditions,
                rmse,
                f"RMSE of {quantity} [kN]",
            )


def group_chart(
    page: Page, caption: str, conditions: Sequence[Condition], values: Floats, y: str
) -> None:
    """A number of each history against mean wind speed, by turbulence and shear.

    Parameters
    ----------
    page : Page
        Where to.
    caption : str
        What it is; how it is shown is added.
    conditions : Sequence[Condition]
        (m,) of the histories.
    values : Floats
        (m,) numbers.
    y : str
        Their name, with the unit.
    """
    groups = [(c.wind_speed, c.turbulence, c.shear) for c in conditions]
    by_group = statistics.by_group(values, groups)
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
    page.chart(
        f"{caption}: mean and standard deviation over the seeds of each group, staggered about the "
        "mean wind speed",
        traces,
        "mean wind speed [m/s]",
        y,
    )


def series_charts(
    page: Page, hub: HubLoads, fe: Mapping[str, Floats], pairs: Pairs, seconds: float = 60.0
) -> None:
    """The beginning of one history, FE and beams, per plane."""
    chosen = len(hub.names) // 2
    time = hub.times[chosen]
    shown = time - time[0] <= seconds
    shown_seconds = min(seconds, float(time[-1] - time[0]))
    for plane, quantity, component in _PLANES:
        for kind in ("spherical", "bonded"):
            traces = [
                trace(
                    f"{kind} FE",
                    time[shown],
                    fe[kind][chosen, shown, component] / 1e3,
                    line={"width": 3},
                )
            ]
            traces += [
                trace(
                    label.partition(" against")[0],
                    time[shown],
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
