"""How a turbine runs in twenty years at a site: torques of its rotor, turns at each, and stops."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.stats import norm

from fe_drivetrain.cases.references.operated_machines import rig_of, stop_values
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.dynamics import Level, mesh_springs
from fe_drivetrain.turbine_loads.histories import Site

SITE = Site(mean_wind=10.0, years=20.0)
WINDS = np.arange(4.0, 26.0)
SCATTER = 0.1
"""Standard deviation of the torque over its mean: assumed."""

RATED_WIND = 11.4
"""Wind of rated power [m/s]; Jonkman et al. 2009 of the NREL 5 MW turbine, assumed of others."""


class Duty(NamedTuple):
    """How a turbine runs.

    Attributes
    ----------
    power : float
        Rated power [W].
    least, speed : float
        Least and rated speed of the rotor [rad/s].
    """

    power: float
    least: float
    speed: float

    @property
    def torque(self) -> float:
        """Rated torque of the rotor [N m]."""
        return self.power / self.speed


def operation(duty: Duty, levels: int = 41) -> Iterator[tuple[float, Floats, Floats]]:
    """Wind speed, torques of the rotor and its turns at each over the life, normal about means."""
    hours = SITE.hours(np.append(WINDS - 0.5, WINDS[-1] + 0.5))
    ends = np.linspace(-4.0, 4.0, levels + 1)
    share = np.diff(norm.cdf(ends)) / (norm.cdf(4.0) - norm.cdf(-4.0))
    for wind, time in zip(WINDS, hours, strict=True):
        power = duty.power * min((wind / RATED_WIND) ** 3, 1.0)
        speed = min(max(duty.speed * wind / RATED_WIND, duty.least), duty.speed)
        torque = power / speed * (1.0 + SCATTER * 0.5 * (ends[1:] + ends[:-1]))
        yield float(wind), torque, share * time * 3600.0 * speed / (2.0 * np.pi)


class MeshStop(NamedTuple):
    """What a mesh carries in a stop, sample by sample.

    Attributes
    ----------
    torque : ndarray, (n,)
        Torque of the rotor that its force stands for [N m].
    speed : ndarray, (n,)
        Speed of the rotor [rad/s].
    step : float
        Time between samples [s].
    """

    torque: Floats
    speed: Floats
    step: float


def stop_of_meshes(drivetrain: Drivetrain, torque: float) -> dict[str, MeshStop]:
    """What each mesh carries in an emergency stop.

    Parameters
    ----------
    drivetrain : Drivetrain
        Whose bodies turn in the stop; with its brake, or one by `stop_values`.
    torque : float
        Rated torque of the rotor to which that of the stop is scaled [N m].

    Raises
    ------
    InputError
        It does not state rated power and speed, or no brake gives the peak of `stop_values`.
    """
    rig = rig_of(drivetrain, Level.TORSIONAL)
    run = rig.stop(stop_values(drivetrain, rig))
    found = {}
    for mesh, springs in mesh_springs(rig.machine).items():
        names = [f"force of {spring}" for spring in springs]
        shares = [run.samples.of(name) / run.extremes[name].rated for name in names]
        speed = run.samples.of("speed of rotor")
        found[mesh] = MeshStop(torque * np.mean(shares, axis=0), speed, run.step)
    return found


def mesh_of(tooth: str) -> str:
    """Name of the mesh that a flank is of, as "stage 1 ring-planet" of "stage 1 ring"."""
    stage = " ".join(tooth.split()[:2])
    if "ring" in tooth:
        return f"{stage} ring-planet"
    return f"{stage} sun-planet" if "sun" in tooth else f"{stage} mesh"
