"""Winds, bearings and lives that the studies of a main bearing's life share."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    RollerRow,
    catalogue_bearing,
    lamina_loads,
    read_bearing_catalogue,
)
from fe_drivetrain.bearing_life.coupled import LinearBody, coupled_equilibrium, factors_of
from fe_drivetrain.bearing_life.life import (
    LifeRules,
    RatedBearing,
    RowLoads,
    equivalent_life,
    row_loads,
    step_lives,
    years,
)
from fe_drivetrain.cases.references.thesis_beam import BEAM, beam_body, housed_body
from fe_drivetrain.common import Floats
from fe_drivetrain.common.components import RPM
from fe_drivetrain.turbine_loads.histories import Site, site_life
from fe_drivetrain.turbine_loads.hub_loads import (
    Condition,
    Rotor,
    designed_controller,
    hub_load_set,
    similar_turbine,
    turbine_histories,
)

#: Mean wind speeds of Stirling 2023, section 5.1, and limits of their bins [m/s].
SPEEDS = np.arange(4.0, 25.0, 2.0)
EDGES = np.arange(3.0, 26.0, 2.0)

#: Factor of the rollers' logarithmic profile in ISO/TS 16281, over their diameter.
PROFILE = 4.5e-4

#: K_R of the thesis's housing about y and z [N m/rad], section 3.3.1.
HOUSING = (145e6, 392e6)

LAMINAE = 30
EVEN = np.ones(LAMINAE)

#: Load cases whose laminae are held in memory together.
CHUNK = 256

#: A load of usual proportions: thrust, weight, moment [N, N m].
LOAD = np.array([1.5e5, 0.0, -4e5, 3e5, 0.0])

#: What a choice may change of a life.
ENOUGH = 0.05

PITCH = read_bearing_catalogue()["bearing_s"].pitch_diameter


@dataclass(frozen=True)
class Winds:
    """Histories of one set: turbulence, shear, seeds, their length [s] and rate [Hz]."""

    turbulence: str = "medium"
    shear: float = 0.2
    seeds: int = 6
    duration: float = 600.0
    rate: float = 1.0

    def hub_loads(self) -> Floats:
        """(winds, steps, 6) [N, N m], the seeds of a wind speed one after another."""
        return hub_loads_of([self])[0]


def hub_loads_of(sets: Sequence[Winds]) -> list[Floats]:
    """Hub loads (winds, steps, 6) of sets that have seeds, length and rate in common."""
    seeds = range(1, sets[0].seeds + 1)
    conditions = [
        Condition(v, one.turbulence, one.shear, s) for one in sets for v in SPEEDS for s in seeds
    ]
    # made at 4 Hz, where 3P is resolved, and then thinned
    every = round(4.0 / sets[0].rate)
    loads = hub_load_set(conditions, sets[0].duration, 4.0).loads[:, ::every]
    return list(loads.reshape(len(sets), len(SPEEDS), -1, 6))


class Hub(NamedTuple):
    """Hub loads of a set of winds, and how fast the rotor turns.

    Attributes
    ----------
    loads : Floats
        (winds, steps, 6) [N, N m].
    speed : Floats
        (winds, steps) of the rotor [1/min].
    """

    loads: Floats
    speed: Floats


def pitch_held(sets: Sequence[Winds]) -> list[Hub]:
    """Hub loads of the surrogate, whose pitch and speed are those of the mean wind."""
    return [
        Hub(loads, np.repeat(rotor_speed()[:, None], loads.shape[1], axis=1))
        for loads in hub_loads_of(sets)
    ]


def with_controller(
    sets: Sequence[Winds], progress: Callable[[int], None] | None = None
) -> list[Hub]:
    """Hub loads of the turbine that moves, under the same seeds, with the speed of each step.

    Parameters
    ----------
    sets : sequence of Winds
        With seeds, length and rate in common.
    progress : callable, optional
        Called with the number of histories done.
    """
    turbine = similar_turbine(Rotor())
    conditions = [
        Condition(v, one.turbulence, one.shear, s)
        for one in sets
        for v in SPEEDS
        for s in range(1, sets[0].seeds + 1)
    ]
    made = turbine_histories(
        conditions,
        turbine,
        designed_controller(turbine),
        duration=sets[0].duration,
        progress=progress,
    )
    loads, speeds = [], []
    for history in made:
        every = round(1.0 / (sets[0].rate * history.history.step))
        loads.append(history.history.loads[::every])
        speeds.append(np.abs(history.rotor_speed[::every]) * RPM)
    shape = (len(sets), len(SPEEDS), -1)
    return [
        Hub(*both)
        for both in zip(
            np.array(loads).reshape(*shape, 6), np.array(speeds).reshape(shape), strict=True
        )
    ]


@dataclass(frozen=True)
class Setup:
    """A bearing in the beam, and how its life is rated.

    Attributes
    ----------
    bearing, body : Bearing, LinearBody
        With laminae; the beam in its housing.
    riser : Floats or None
        Stress riser of the laminae; that of ISO/TS 16281 if None.
    edge : float
        Reduction for edge stress that C holds, lambda nu.
    fatigue : float
        C_u that a row's equivalent load is set against [N].
    """

    bearing: Bearing
    body: LinearBody
    riser: Floats | None = None
    edge: float = 0.83
    fatigue: float = 0.5 * 1.1e6
    capacity: float = 6.71e6

    def deflections(self, hub_loads: Floats) -> Floats:
        """(..., 5) of the inner ring [m, rad], of hub loads (..., 6)."""
        factors = factors_of(hub_loads.reshape(-1, 6), BEAM.gearbox_weight)
        found = coupled_equilibrium(self.body, {self.body.bearings[0]: self.bearing}, factors)
        if not found.converged.all():
            raise RuntimeError("a load case of the beam has no equilibrium")
        return found.deflections[:, 0].reshape(*hub_loads.shape[:-1], 5)

    @property
    def rated(self) -> RatedBearing:
        """The bearing with its ratings."""
        assumed = ("Stirling 2023, Table 4.1", "not used", "Stirling 2023, Table 4.1")
        return RatedBearing(self.bearing, self.capacity, 1.66e7, self.fatigue, assumed)

    @property
    def rules(self) -> LifeRules:
        """How basic lives are rated."""
        return LifeRules(riser="standard" if self.riser is None else "none", edge=self.edge)

    def lives(self, laminae: Sequence[Floats]) -> Floats:
        """L10r (n,) [million revolutions] of (n, rollers, laminae) of each row."""
        return step_lives(self.rated, laminae, self.rules)

    def rows(self, laminae: list[Floats]) -> list[RowLoads]:
        """Equivalent loads of the laminae of both rows, of (n, rollers, laminae) each."""
        return [
            row_loads(row, q, self.capacity, rows=2, edge=self.edge, riser=self.riser)
            for row, q in zip(roller_rows(self.bearing), laminae, strict=True)
        ]


def bearing_s(name: str, profile: bool, elements: int = 36) -> Bearing:
    """Bearing S of an arrangement, with straight or profiled rollers of 30 laminae."""
    crown = PROFILE if profile else 0.0
    return catalogue_bearing(name, laminae=LAMINAE, crown=crown, elements=elements)


def thesis_setup(name: str = "bearing_s") -> Setup:
    """What Stirling 2023, chapter 5, chooses: rigid housing, straight rollers, no stress riser."""
    return Setup(bearing_s(name, False), beam_body(), EVEN, fatigue=1.1e6)


def own_setup() -> Setup:
    """Ours: back to back, profile and stress riser of ISO/TS 16281, housing in series."""
    return Setup(bearing_s("bearing_s_o20", True), housed_body(*HOUSING))


def roller_rows(bearing: Bearing) -> list[RollerRow]:
    """Its rows, all of rollers."""
    return [row for row in bearing.rows if isinstance(row, RollerRow)]


def on_rigid_rings(bearing: Bearing, deflections: Floats) -> Callable[[slice], list[Floats]]:
    """Loads of the laminae of each row, for some of the load cases (n, 5)."""
    return lambda part: [lamina_loads(row, deflections[part]) for row in roller_rows(bearing)]


def by_chunks(
    count: int,
    laminae: Callable[[slice], list[Floats]],
    result: Callable[[list[Floats]], Mapping[str, Floats]],
) -> dict[str, Floats]:
    """Results (count, ...) by name, of load cases a few at a time."""
    parts = [result(laminae(slice(i, i + CHUNK))) for i in range(0, count, CHUNK)]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def basic_lives(setup: Setup, deflections: Floats) -> Floats:
    """L10r at each step, (winds, steps) [million revolutions], of deflections (winds, steps, 5)."""
    flat = deflections.reshape(-1, 5)
    found = by_chunks(
        len(flat),
        on_rigid_rings(setup.bearing, flat),
        lambda q: {"L": setup.lives(q)},
    )
    return found["L"].reshape(deflections.shape[:-1])


def rotor_speed(rotor: Rotor | None = None) -> Floats:
    """Rotor speed at each mean wind speed [1/min], of the surrogate of 2 MW or another."""
    turning = Rotor() if rotor is None else rotor
    return np.array([turning.rotor_speed(v) * RPM for v in SPEEDS])


def by_wind(lives: Floats, speed: Floats | None = None) -> Floats:
    """Years at each wind speed, of lives (winds, steps) in million revolutions.

    At the rotor's speed of the mean wind, or at that of each step [1/min].
    """
    turning = rotor_speed()[:, None] if speed is None else speed
    return equivalent_life(years(lives, turning))


def at_site(of_winds: Floats, mean_wind: float) -> float:
    """Years at a Weibull site with exponent 2."""
    return site_life(of_winds, Site(mean_wind).shares(EDGES))


def shares(of_winds: Floats, mean_wind: float) -> Floats:
    """Share of the damage at each wind speed [%]."""
    weights = Site(mean_wind).shares(EDGES)
    return 100.0 * weights / of_winds * at_site(of_winds, mean_wind)


def scatter_of_seeds(
    lives: Floats, seeds: int, mean_wind: float | None = None, speed: Floats | None = None
) -> Floats:
    """Standard error of the logarithm of life, at each wind speed or at a site.

    From lives (winds, steps) with each of the seeds left out in turn (Efron 1979); ``speed`` is as
    that of `by_wind`.
    """
    steps = lives.reshape(len(SPEEDS), seeds, -1)
    left = [by_wind(np.delete(steps, k, 1).reshape(len(SPEEDS), -1), speed) for k in range(seeds)]
    found = left if mean_wind is None else [at_site(one, mean_wind) for one in left]
    return np.asarray(np.sqrt((seeds - 1) * np.var(np.log(found), axis=0)))
