"""Charts of the thesis's study: RMSE by wind speed, time series, beams against FE."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import statistics
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page
from fe_drivetrain.turbine_loads.hub_loads import Condition, HubLoadSet

Pairs = Mapping[str, tuple[str, Floats]]
_PLANES = (("horizontal", "Fy", 1), ("vertical", "Fz", 2))

ROUND_OFF = 1e-9
"""Share of the largest force: what solvers leave in reactions that statics decides, and far below
what any other model leaves."""


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


def series_caption(
    hub: HubLoadSet, kind: str, plane: str, quantity: str, seconds: float = 60.0
) -> str:
    """Caption of one of `series_charts`.

    Parameters
    ----------
    hub : HubLoadSet
        The load histories, of which the one in the middle is shown.
    kind : str
        "spherical" or "bonded".
    plane, quantity : str
        "horizontal" and "Fy", or "vertical" and "Fz".
    seconds : float
        How much of the history is shown, at most.

    Returns
    -------
    str
    """
    of_history = min(seconds, float(hub.time[-1] - hub.time[0]))
    return (
        f"Load on the {kind} main bearing, {plane} plane ({quantity}): first {of_history:.0f} s of "
        f"{hub.conditions[len(hub) // 2].name}"
    )


def series_charts(
    page: Page, hub: HubLoadSet, fe: Mapping[str, Floats], pairs: Pairs, seconds: float = 60.0
) -> None:
    """The beginning of one history, FE and beams, per plane."""
    chosen = len(hub) // 2
    time = hub.time
    shown = time - time[0] <= seconds
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
                series_caption(hub, kind, plane, quantity, seconds),
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
