"""Peak of a stop by the instant of its brake: within a swing of the first mode it may be any."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.comparison.in_time import peak_between
from fe_drivetrain.dynamics.bodies.levels import torsional
from fe_drivetrain.dynamics.torsion.system import natural_modes
from fe_drivetrain.procedure.drivetrain_events import EmergencyStop, Event
from fe_drivetrain.studies.transient_runs import Prepared

COUNT = 8
"""Instants in a period of the first mode."""

AFTER = 2.5
"""Periods of the first mode after the brake's full torque in which its peak comes."""


@dataclass(frozen=True)
class ByInstant:
    """Peak of a channel by the instant of the brake.

    Attributes
    ----------
    channel : str
        Its name.
    period : float
        Period of the first mode with a free generator [s].
    delays : tuple of float
        How much later the brake comes [s].
    peaks : tuple of float
        Largest size for each, of either sign, over the rated one.
    """

    channel: str
    period: float
    delays: tuple[float, ...]
    peaks: tuple[float, ...]


def by_instant(of: Prepared, event: Event, channel: str, step: float) -> ByInstant | None:
    """Stop a drivetrain with its brake at several instants; None of what is no stop with a brake.

    Parameters
    ----------
    of : Prepared
        The drivetrain at a level.
    event : Event
        The stop.
    channel : str
        Channel whose peak is asked for.
    step : float
        Step [s].
    """
    if not isinstance(event, EmergencyStop) or not (event.brake or event.brake_torque):
        return None
    frequencies = natural_modes(torsional(of.of.machine)).frequencies
    period = 1.0 / float(frequencies[frequencies > 0.0][0])
    k = of.channels.names.index(channel)
    delays = tuple(float(period * n / COUNT) for n in range(COUNT))
    peaks = []
    for late in delays:
        braked = event.braked + late
        end = max(braked + event.rise + AFTER * period, event.pitched + 1e-3)
        planned = replace(event, braked=braked).plan(of.of, end, of.rated.slip)
        run = of.event(planned, step, counts=False)
        values = run.samples.values[run.samples.times >= braked, k]
        # a brake between rotor and gears winds what is behind it up backwards
        largest = max(peak_between(values), peak_between(-values))
        peaks.append(largest / abs(float(of.channels.rated[k])))
    return ByInstant(channel, period, delays, tuple(np.asarray(peaks).tolist()))
