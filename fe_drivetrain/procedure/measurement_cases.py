"""Measurement load cases as scripts, and what a drivetrain does in them.

PROTEST 2010 (section 4.6.2.5, Table 4.9) names cases that are driven by hand: starts, stops, speeds
that are held. A script is a table of corners, speed and torque of the generator; the rotor's torque
is what moves all inertias so, and the drivetrain winds up and oscillates under both. The channels
that come of it are the truth that `sensors` measure.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files as package_files
from pathlib import Path
from typing import Self

import numpy as np
from pydantic import BaseModel, ConfigDict, model_validator

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import ONE_RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping, read_text, validated
from fe_drivetrain.dynamics.torsion.system import Torsional
from fe_drivetrain.procedure.motions import driven_motions, element_torques


class _Row(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class MeasurementCase(_Row):
    """A script: corners of time [s], speed [rpm] and torque over the rated one."""

    code: str
    title: str
    corners: tuple[tuple[float, float, float], ...]

    @model_validator(mode="after")
    def _times_rise(self) -> Self:
        times = [corner[0] for corner in self.corners]
        if len(times) < 2 or times[0] != 0.0 or any(np.diff(times) <= 0.0):
            raise InputError(
                f"measurement case {self.code!r} has corners at {', '.join(map(str, times))} s: "
                "give at least two, from 0 on, each later than the one before"
            )
        return self

    @property
    def seconds(self) -> float:
        """How long it takes."""
        return self.corners[-1][0]

    def speed(self, time: Floats) -> Floats:
        """Speed of the generator [rad/s].

        Parameters
        ----------
        time : ndarray, (n,)
            [s].
        """
        times, speeds, _ = np.array(self.corners).T
        return np.asarray(np.interp(time, times, speeds * ONE_RPM))

    def torque(self, time: Floats) -> Floats:
        """Torque of the generator against the rotation, over the rated one.

        Parameters
        ----------
        time : ndarray, (n,)
            [s].
        """
        times, _, torques = np.array(self.corners).T
        return np.asarray(np.interp(time, times, torques))


class MeasurementCases(_Row):
    """Scripts of a campaign."""

    title: str
    cases: tuple[MeasurementCase, ...]

    @model_validator(mode="after")
    def _one_of_each_code(self) -> Self:
        codes = [case.code for case in self.cases]
        for code in codes:
            if codes.count(code) > 1:
                raise InputError(f"two measurement cases are called {code!r}: rename one")
        return self

    def of(self, code: str) -> MeasurementCase:
        """A case by its code.

        Parameters
        ----------
        code : str
            As in "STB".

        Raises
        ------
        InputError
            There is none.
        """
        for case in self.cases:
            if case.code == code:
                return case
        known = ", ".join(case.code for case in self.cases)
        raise InputError(f"no measurement case {code!r}: use one of {known}")


@cache
def protest_measurement_cases() -> MeasurementCases:
    """Table 4.9 of PROTEST 2010, with assumed corners."""
    name = "measurement_cases.yaml"
    text = (package_files("fe_drivetrain.procedure") / name).read_text("utf-8")
    return validated(MeasurementCases, parse_mapping(text, name), name)


def read_measurement_cases(path: str | Path) -> MeasurementCases:
    """A user's own scripts, in the form of the package's ``measurement_cases.yaml``.

    Parameters
    ----------
    path : str or Path
        Plain YAML of at most 1 MB.

    Raises
    ------
    InputError
        The file cannot be read, or a script is not one.
    """
    text = read_text(path, "measurement cases")
    return validated(MeasurementCases, parse_mapping(text, str(path)), str(path))


def case_channels(
    case: MeasurementCase, system: Torsional, rated: float, step: float
) -> dict[str, Floats]:
    """What the drivetrain does in a case.

    Parameters
    ----------
    case : MeasurementCase
        The script.
    system : Torsional
        Free, from the rotor to the generator, all in angles of the high-speed shaft; torques act at
        its first and last inertia.
    rated : float
        Torque of the generator [N m].
    step : float
        Between two samples [s].

    Returns
    -------
    dict
        "time" [s], "rotor speed", "generator speed" [rad/s], "rotor torque", "generator torque"
        [N m], "twist" [rad] and "shaft torque" (of the first element) [N m], each (n,). The mean
        speed is that of the script but for the drivetrain's own oscillations.

    Raises
    ------
    InputError
        The step is longer than the shortest part of the script.
    """
    times = np.array([corner[0] for corner in case.corners])
    if not 0.0 < step <= float(np.diff(times).min()) * (1.0 + 1e-9):
        raise InputError(
            f"a step of {step:g} s in measurement case {case.code!r}, whose shortest part is "
            f"{float(np.diff(times).min()):g} s: give a step above 0 and at most that"
        )
    time = np.arange(round(case.seconds / step) + 1, dtype=np.float64) * np.float64(step)
    braking = rated * case.torque(time)
    speed = case.speed(time)
    accelerating = float(system.J.sum()) * np.gradient(speed, step)
    accelerating[0] = 0.0
    torques = np.zeros((len(system.J), len(time)))
    torques[0], torques[-1] = braking + accelerating, -braking
    motions = driven_motions(system, torques, step)
    return {
        "time": time,
        "rotor speed": speed[0] + motions.speed[0],
        "generator speed": speed[0] + motions.speed[-1],
        "rotor torque": torques[0],
        "generator torque": braking,
        "twist": motions.angle[0] - motions.angle[-1],
        "shaft torque": element_torques(system, motions)[0],
    }
