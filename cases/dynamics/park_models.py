"""Models and loads of Park et al. 2021 in time: torque, meshes that vary, eccentric bodies."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.references import park_2021 as park
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime
from fe_drivetrain.dynamics import (
    Equations,
    Loads,
    Meshing,
    Motion,
    State,
    System,
    equations_of,
    free_motions,
    integrate,
    library_machine,
    steady,
    summed,
    varying,
    varying_equations,
    wind_up,
)

SPEED = 6.0 * np.pi / 30.0  # rad/s
GRAVITY = 9.81
ECCENTRICITY = 0.2
#: Not printed: pairs in contact, and damping over stiffness [s].
CONTACT_RATIO, DAMPING = 1.6, 3e-5
NACELLE = 6250.0  # N
#: Not printed: spread of the nacelle's force over its mean, highest frequency of it [Hz].
SPREAD, HIGHEST = 0.3, 5.0
PLANETARY = "planetary stage [%]"
MESHES = ("stage 1 sun-planet 1", "stage 1 ring-planet 1", "stage 2 mesh", "stage 3 mesh")


class Bodies(NamedTuple):
    """What is eccentric: names in the system, radius [m] and speed over the rotor's."""

    names: tuple[str, ...]
    radius: float
    speed: float


def eccentric_bodies() -> dict[str, Bodies]:
    """The seven of the source, with speeds by the radii of Table 2."""
    r = park.RADII
    sun = 1.0 + (r["carrier"] + r["planet"]) / r["sun"]
    second = -sun * r["gear 1"] / r["gear 2_1"]
    planets = tuple(f"stage 1 planet {k}" for k in range(1, park.PLANETS + 1))
    return {
        "rotor": Bodies(("rotor",), r["carrier"], 1.0),
        "carrier": Bodies(("stage 1 carrier",), r["carrier"], 1.0),
        "planets": Bodies(planets, r["planet"], -r["carrier"] / r["planet"]),
        "sun": Bodies(("stage 1 sun",), r["sun"], sun),
        "gear 1": Bodies(("stage 2 gear",), r["gear 1"], sun),
        "gear 2": Bodies(("stage 2 pinion",), r["gear 2_1"], second),
        "gear 3": Bodies(("stage 3 pinion",), r["gear 3"], park.ratio()),
    }


def torque(system: System, share: float) -> Floats:
    """15 kN m on the rotor, and a share of it against the generator."""
    turn = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    ratio = float(library_machine("park_2021").speeds[-1])
    load = park.TORQUE * system.load_on("rotor", turn)
    against = -np.sign(ratio) * share * park.TORQUE
    return np.asarray(load + system.load_on("generator", against * turn))


def meshes(phase: float = 0.0) -> dict[str, Meshing]:
    """At the printed frequencies; planets in step, as in the source; `phase` at t = 0 of all."""
    first, second, third = park.MESH_LINES
    names = [f"stage 1 {kind}-planet {k}" for kind in ("sun", "ring") for k in (1, 2, 3)]
    found = {name: Meshing(CONTACT_RATIO, first, phase) for name in names}
    return found | {
        "stage 2 mesh": Meshing(CONTACT_RATIO, second, phase),
        "stage 3 mesh": Meshing(CONTACT_RATIO, third, phase),
    }


def varying_model(system: System, harmonics: int, phase: float = 0.0) -> Equations:
    """With meshes that vary with time."""
    return varying_equations(system, meshes(phase), SPEED, damping=DAMPING, harmonics=harmonics)


def static_forces(system: System, load: Floats) -> Floats:
    """Static forces of the meshes, with constant stiffness [N]."""
    rows = [system.spring_names.index(name) for name in MESHES]
    q = wind_up(equations_of(system), load).q
    return np.asarray((system.stiffness * (system.rows @ q))[rows])


def offset_mass(system: System, one: Bodies, times: Floats) -> Loads:
    """Centrifugal force and moment of weight of bodies whose mass is off their axes."""
    parts = []
    w = one.speed * SPEED
    for name in one.names:
        m = float(system.body_mass[system.bodies.index(name)])
        e = ECCENTRICITY * one.radius
        turn = system.load_on(name, np.array([0.0, 0.0, 0.0, -m * GRAVITY * e, 0.0, 0.0]))
        across = [system.load_on(name, m * e * w**2 * np.eye(6)[k]) for k in (1, 2)]
        parts.append(varying(turn + across[0], times, np.cos(w * times)))
        parts.append(varying(across[1], times, np.sin(w * times)))
    return summed(*parts)


def balanced(equations: Equations, names: list[str]) -> Floats:
    """15 kN m on the rotor, and on the generator what keeps the free turn at its speed."""
    free = free_motions(equations)[:, 0]
    rotor, generator = names.index("rotor rx"), names.index("generator rx")
    load = np.zeros(len(names))
    load[rotor] = park.TORQUE
    load[generator] = -park.TORQUE * free[rotor] / free[generator]
    return load


def mean_period(t: Floats, values: Floats) -> float:
    """Between crossings of the mean upwards."""
    swing = values - values.mean()
    up = np.flatnonzero((swing[:-1] < 0.0) & (swing[1:] >= 0.0))
    # the first crossing of each swing, past those of higher modes
    kept = [up[0]]
    for at in up[1:]:
        if t[at] - t[kept[-1]] > 0.2:
            kept.append(at)
    return float((t[kept[-1]] - t[kept[0]]) / (len(kept) - 1))


def turning_inertia() -> float:
    """All that turns, seen from the rotor, with inertias of Table 2 [kg m^2]."""
    speeds = {name: one.speed for name, one in eccentric_bodies().items()}
    speeds["planet"], speeds["generator"] = speeds.pop("planets"), park.ratio()
    times = {"planet": park.PLANETS}
    return sum(J * times.get(name, 1) * speeds[name] ** 2 for name, J in park.INERTIAS.items())


def shaft_torque(share: float) -> float:
    """Torque of the low-speed shaft without vibration, by statics of a turning chain [N m]."""
    left = park.TORQUE * (1.0 - share * park.ratio())
    return abs(park.TORQUE - left * park.INERTIAS["rotor"] / turning_inertia())


def operating(
    system: System, dt: float, duration: float, harmonics: int, more: Loads | None = None
) -> Motion:
    """From the wound-up state under balanced torque, and under what else acts."""
    load = torque(system, 1.0 / park.ratio())
    begin = wind_up(equations_of(system), load)
    start = State(begin.q, np.zeros(len(load)), np.zeros(len(load)))
    acting = steady(load) if more is None else summed(steady(load), more)
    return integrate(varying_model(system, harmonics), acting, duration, dt, start=start)


def pushed(system: System, duration: float) -> Loads:
    """The nacelle's force on the rotor: its mean, and noise about it."""
    rng = np.random.default_rng(0)
    slow = np.arange(0.0, duration + 0.05, 0.02)
    f = rng.uniform(0.05, HIGHEST, 40)
    noise = np.cos(2 * np.pi * np.outer(slow, f) + rng.uniform(0, 2 * np.pi, 40)).sum(axis=1)
    push = system.load_on("rotor", np.array([0.0, NACELLE, 0.0, 0.0, 0.0, 0.0]))
    return varying(push, slow, 1.0 + SPREAD * noise / noise.std())


def changes_by(
    system: System, acting: dict[str, Loads], dt: float, duration: float, harmonics: int
) -> InTime:
    """RMS change of the mesh forces over their mean by each load [%]."""
    of = [system.spring_names.index(mesh) for mesh in MESHES]

    def forces(motion: Motion) -> Floats:
        return np.asarray(motion.forces[motion.times > 0.25 * duration][:, of])

    bare = operating(system, dt, duration, harmonics)
    plain, lost, values = forces(bare), bare.relative_imbalance, {}
    mean = np.abs(plain.mean(axis=0))
    for name, more in acting.items():
        motion = operating(system, dt, duration, harmonics, more)
        change = 100.0 * np.sqrt(((forces(motion) - plain) ** 2).mean(axis=0)) / mean
        lost = max(lost, motion.relative_imbalance)
        values[f"{name}: {PLANETARY}"] = float(change[:2].max())
        values[f"{name}: gears 1-2 [%]"] = float(change[2])
        values[f"{name}: gears 2-3 [%]"] = float(change[3])
    return InTime(values, lost)
