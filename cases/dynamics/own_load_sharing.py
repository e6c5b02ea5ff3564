"""Load sharing of a user's planets with a pin out of place, between two closed forms."""

from dataclasses import dataclass
from math import cos, sin

import numpy as np

from fe_drivetrain.cases.dynamics.planets_on_pins import first_stage
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.turning_parts import diagonal
from fe_drivetrain.dynamics import (
    Level,
    Machine,
    load_sharing,
    machine_of,
    machine_system,
    static,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Run

SHARING = "Load sharing K_gamma of the first stage by the torque, one pin out of place"
SHARES = np.geomspace(0.1, 1.5, 25)
"""Torques over the rated one."""
ENDS = "change of the load of planet 1 by the pin's error [kN]"


@dataclass(frozen=True)
class Shared:
    """Normal forces of the sun's meshes at rated torque [N], and what a pin's error changes.

    ``fixed`` and ``floating`` are the changes of planet 1 by the closed forms with a sun that only
    turns, and one that moves in its plane, too.
    """

    rated: Floats
    change: Floats
    fixed: float
    floating: float

    def sharing(self, share: float) -> float:
        """K_gamma at a share of the rated torque."""
        return load_sharing(share * self.rated + self.change)

    def closed(self, share: float, change: float) -> float:
        """The same by a closed form."""
        return 1.0 + change / (share * float(self.rated.mean()))

    @property
    def parts(self) -> float:
        """Share of the rated torque below which a planet would lose contact."""
        return float(np.max(-self.change / self.rated))


def shared(machine: Machine, torque: float, error: float) -> Shared:
    """Statics of a whole machine at level "rigid", without gravity.

    Parameters
    ----------
    machine : Machine
        The machine, its first stage planetary with bearings on the pins.
    torque : float
        Rated torque on the rotor [N m].
    error : float
        By which the first pin is ahead of its place [m].
    """
    stage, pins = first_stage(machine)
    system = machine_system(machine, Level.RIGID, held_generator=True)
    load = system.load_on("rotor", torque * np.eye(6)[3])
    ahead = {f"stage 1 pin 1 {pin}".strip() + " uz": error for pin in pins}
    meshes = [f"stage 1 sun-planet {k + 1}" for k in range(stage.planets)]
    still, moved = static(system, load), static(system, 0.0 * load, ahead)
    rated = np.array([still.force(mesh) for mesh in meshes])
    change = np.array([moved.force(mesh) for mesh in meshes])
    pressed = pressed_by(stage, error)
    N = stage.planets
    return Shared(rated, change, pressed * (1.0 - 1.0 / N), pressed * max(0.0, 1.0 - 3.0 / N))


def pressed_by(stage: PlanetaryData, error: float) -> float:
    """Normal force of a mesh by a pin's error [m] while sun, ring and carrier stand still [N].

    Both meshes carry F, since the planet turns freely, and the pin what is left of both: along the
    tangent F cos(beta_b) times the sum of the cosines of the pressure angles, along the radius the
    difference of their sines.
    """
    sun, ring = stage.meshes
    radial, tangential = (
        sum(diagonal(pin.stiffness)[axis] for pin in stage.pins) for axis in (1, 2)
    )
    along = cos(sun.base_helix) * (cos(sun.pressure_angle) + cos(ring.pressure_angle))
    across = cos(sun.base_helix) * (sin(sun.pressure_angle) - sin(ring.pressure_angle))
    meshes = 1.0 / stage.along_line(stage.sun_planet) + 1.0 / stage.along_line(stage.ring_planet)
    gives = meshes + along**2 / tangential + (across**2 / radial if across else 0.0)
    return along * error / gives


def own(run: Run, page: Page) -> None:
    """What a pin out of place does to the planets of a user's first stage.

    Raises
    ------
    InputError
        The first stage is not planetary, states no bearings of planets, or the file no operation.
    """
    chosen = run.drivetrain("")
    chosen.state(page)
    machine, torque = machine_of(chosen.drivetrain), chosen.rated_torque()
    error = run.positive("error", 50)
    with run.step("pin out of place"):
        found = shared(machine, torque, 1e-6 * error)
    check(page, machine, found, torque)
    page.section("By the torque")
    page.chart(
        SHARING,
        [
            trace("this drivetrain", SHARES, [found.sharing(s) for s in SHARES]),
            *(
                trace(name, SHARES, [found.closed(s, c) for s in SHARES], line={"dash": "dot"})
                for name, c in (
                    ("closed form, sun that only turns", found.fixed),
                    ("closed form, floating sun", found.floating),
                )
            ),
        ],
        "torque over rated",
        "load sharing K_gamma",
        "x",
    )
    page.table(
        f"Normal forces of the sun's meshes at rated torque, pin 1 {error:g} µm ahead",
        [
            {"planet": k, "without [kN]": float(one) / 1e3, "with [kN]": float(one + more) / 1e3}
            for k, (one, more) in enumerate(zip(found.rated, found.change, strict=True), start=1)
        ],
    )
    answer(page, chosen, found, error)
    page.assume_all(machine.assumptions())


def check(page: Page, machine: Machine, found: Shared, torque: float) -> None:
    """Torque of all meshes, and a change that adds no torque and stays below its bound."""
    stage, _ = first_stage(machine)
    sun = stage.meshes[0]
    arm = stage.sun_radius * cos(sun.pressure_angle) * cos(sun.base_helix)
    page.equals(
        "torque of the sun's meshes [kN m]",
        float(found.rated.sum()) * arm / 1e3,
        torque / stage.speed_ratio / 1e3,
        within=1e-6,
        why="solver; bearings of carrier and sun carry no torque",
        source="statics: the torque over the ratio",
    )
    page.vanishes(
        "sum of the changes of all planets over the largest",
        float(abs(found.change.sum()) / np.abs(found.change).max()),
        within=1e-6,
        why="solver; an error of a pin adds no torque",
        source="statics",
    )
    page.at_most(
        ENDS,
        float(found.change[0]) / 1e3,
        found.fixed / 1e3,
        why="whatever gives besides makes a misfit press less",
        source="closed form of parallel branches, a sun that only turns: K e (1 - 1/N)",
        measure="reaction",
    )


def answer(page: Page, chosen: ChosenDrivetrain, found: Shared, error: float) -> None:
    """State the load sharing at rated torque, and when a planet loses contact."""
    still, moved = load_sharing(found.rated), found.sharing(1.0)
    page.answer(
        "How unevenly do the planets share the load when one pin is out of place?",
        f"A pin {error:g}\u00a0µm ahead raises K_gamma at rated torque from {still:.3f} to "
        f"{moved:.3f}; a planet loses contact below {100 * found.parts:.2g}\u00a0% of that torque.",
        [
            page.value(
                "K_gamma at rated torque, pin out of place", moved, beside=still, by="without"
            ),
            page.value("K_gamma by a sun that only turns", found.closed(1.0, found.fixed)),
            page.value("K_gamma by a floating sun", found.closed(1.0, found.floating)),
            page.judged(ENDS.partition(" [")[0], "change of planet 1 by the error", "fixed sun"),
            page.value(
                "torque below which a planet loses contact, of rated [%]", 100 * found.parts
            ),
        ],
        SHARING,
        [
            f"{chosen.title}: level rigid, no gravity; carrier and housing do not bend, teeth are "
            "as stiff as on average."
        ],
    )
