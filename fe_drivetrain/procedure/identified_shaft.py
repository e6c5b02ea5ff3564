"""What measured channels determine of a shaft, against a project's model: K, D, by each method."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.channels import Channels
from fe_drivetrain.procedure.identification import Fit
from fe_drivetrain.procedure.methods import (
    MethodAnswer,
    answers_by_methods,
    damping_of_decay,
    decay_after,
    twist_of,
)
from fe_drivetrain.procedure.project import Identified
from fe_drivetrain.procedure.spectral_fit import spectral_fit
from fe_drivetrain.report.results import Verdict, judge


@dataclass(frozen=True)
class Outcome:
    """What measured channels say of a model.

    Attributes
    ----------
    verdicts : tuple of Verdict
        Computed against measured.
    spreads : Mapping[str, float]
        Half width, as a share of the value, of each input that signals determine, by its name.
    methods : Mapping[str, tuple[MethodAnswer, ...]]
        What each method of identification finds, by the channel of the torque.
    """

    verdicts: tuple[Verdict, ...] = ()
    spreads: Mapping[str, float] = field(default_factory=dict)
    methods: Mapping[str, tuple[MethodAnswer, ...]] = field(default_factory=dict)


def identified(one: Identified, measured: Channels) -> Outcome:
    """K and D of ``T = K x + D x'``: the torque is that in the shaft, so that I comes out as 0.

    Printed methods are listed and not judged, as they do not hold; the decrement of a stop is, as a
    damper of the shaft.

    Parameters
    ----------
    one : Identified
        Channels, and the model's values.
    measured : Channels
        The record.

    Raises
    ------
    InputError
        A channel is in another unit, or the record is too short for what is asked of it.
    """
    for name, unit in ((one.torque, "N m"), (one.front, "rad"), (one.rear, "rad")):
        if measured.units[name] != unit:
            raise InputError(
                f"{measured.source}: channel {name!r} is in {measured.units[name]!r} but must be "
                f"in {unit} or a multiple: map another column"
            )
    _require_turn(one, measured)
    torque = measured.of(one.torque)
    angle = measured.of(one.front) - measured.of(one.rear) / one.ratio
    fit = spectral_fit(torque, angle, measured.step, one.band)
    names = {2: one.stiffness_of, 1: one.damping_of}
    spreads = {
        name: float(abs(fit.bands[place] / fit.values[place]))
        for place, name in names.items()
        if name
    }
    methods = {}
    if one.turn is not None:
        twist = twist_of(torque, angle, measured.step)
        methods[one.torque] = answers_by_methods(twist, one.turn, fit, one.band)
    verdicts = _by_spectra(one, fit, measured)
    if one.stop is not None:
        decay, _ = decay_after(angle, measured.step, one.stop)
        damping, band = damping_of_decay(decay, one.stiffness)
        words = f"decrement {decay.decrement:.4g} at {decay.frequency:.4g} Hz"
        methods[one.torque] = (
            *methods.get(one.torque, ()),
            MethodAnswer("decrement", None, damping, None, f"{words}, band {band:.2g}"),
        )
        if one.damping is not None:
            verdicts.append(
                judge(
                    f"damping by the decrement of {one.front}, {one.rear}",
                    one.damping,
                    damping,
                    tolerance=one.tolerance,
                    reason=f"the project's tolerance; peaks determine it within {band:.3g} N m "
                    "s/rad",
                    source=f"{words} of {Path(measured.source).name}, with the model's stiffness",
                    unit="N m s/rad",
                )
            )
    return Outcome(tuple(verdicts), spreads, methods)


def _require_turn(one: Identified, measured: Channels) -> None:
    """Refuse a ratio of 0, and a turn that two windows of a record cannot have."""
    if one.ratio == 0.0:
        raise InputError("ratio of identified is 0 but must not be: give that of both speeds")
    if one.turn is None:
        return
    low, high = 2.0 * measured.step, 0.5 * len(measured.of(one.torque)) * measured.step
    if not low <= one.turn <= high:
        raise InputError(
            f"{measured.source}: turn is {one.turn:g} s but must be from {low:g} s, two samples, "
            f"to {high:g} s, half of the record: give the time of a turn of the rotor"
        )


def _by_spectra(one: Identified, fit: Fit, measured: Channels) -> list[Verdict]:
    """The model's stiffness and damping against those of the spectra."""
    wanted = [("stiffness", one.stiffness, 2, "N m/rad")]
    if one.damping is not None:
        wanted.append(("damping", one.damping, 1, "N m s/rad"))
    return [
        judge(
            f"{name} from {one.torque}, {one.front}, {one.rear}",
            model,
            float(fit.values[place]),
            tolerance=one.tolerance,
            reason=f"the project's tolerance; the signals determine it within "
            f"{fit.bands[place]:.3g} {unit}",
            source=f"identified from lines of the spectra of {Path(measured.source).name}, "
            f"{one.band[0]:g} to {one.band[1]:g} Hz",
            unit=unit,
        )
        for name, model, place, unit in wanted
    ]
