"""A user's drivetrain after a step of torque, its meshes varying: torsional and in space."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fe_drivetrain.cases.dynamics.park_models import DAMPING
from fe_drivetrain.cases.dynamics.park_words import FORCES, MAXIMUM, MINIMUM
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.comparison import ConvergenceInTime, InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import (
    Equations,
    Level,
    Machine,
    Meshing,
    Motion,
    System,
    contact_ratios,
    equations_of,
    integrate,
    machine_meshing,
    machine_of,
    machine_system,
    steady,
    system_modes,
    varying_equations,
    wind_up,
)
from fe_drivetrain.dynamics.bodies.system import springs_named
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run, check_in_time

SETTLED = 0.05
"""What step and harmonics may leave uncertain of an answer, each, over it."""
LEVELS = {"torsional": Level.TORSIONAL, "three dimensions": Level.RIGID}
PHASES = (0.25, 0.5, 0.75)
FEW = "a hundredth of the energy is half a hundredth of the forces"


@dataclass(frozen=True)
class Stepped:
    """A machine whose rotor and generator feel its rated torque from an instant on.

    ``torque`` [N m] and ``speed`` [rad/s] are the rotor's, ``meshing`` the meshes that vary,
    ``first`` the first torsional frequency [Hz].
    """

    machine: Machine
    torque: float
    speed: float
    meshing: dict[str, Meshing]
    first: float

    @property
    def meshes(self) -> list[str]:
        """One mesh of each kind, from the rotor on."""
        planets = [f" {k}" for k in range(2, 51)]
        return [name for name in self.meshing if not name.endswith(tuple(planets))]

    @property
    def shaft(self) -> str:
        """Name of the spring that the main shaft is in torsion."""
        return f"{self.machine.shafts[0].name} rx"

    def only(self, number: int) -> "Stepped":
        """The same with meshes of one stage alone that vary, by its number, from 1.

        Raises
        ------
        InputError
            There is no such stage.
        """
        kept = {n: one for n, one in self.meshing.items() if n.startswith(f"stage {number} ")}
        if not kept:
            raise InputError(
                f"stage = {number}, but {self.machine.title!r} has {len(self.machine.stages)}: "
                "name one of them"
            )
        return replace(self, meshing=kept)

    def load(self, system: System) -> Floats:
        """Torque on the rotor, and on the generator what balances it."""
        about_x = np.eye(6)[3]
        against = self.torque / self.machine.speeds[-1]
        on_rotor = system.load_on("rotor", self.torque * about_x)
        return np.asarray(on_rotor - system.load_on("generator", against * about_x))

    def equations(self, system: System, harmonics: int, phase: float = 0.0) -> Equations:
        """With meshes that vary, all by a phase later."""
        later = {
            name: replace(one, phase=(one.phase + phase) % 1.0)
            for name, one in self.meshing.items()
        }
        return varying_equations(system, later, self.speed, damping=DAMPING, harmonics=harmonics)

    def static(self, system: System) -> Floats:
        """Forces of all springs in the wound-up state [N, N m]."""
        q = wind_up(equations_of(system), self.load(system)).q
        return np.asarray(system.stiffness * (system.rows @ q))

    def moved(
        self, system: System, seconds: float, dt: float, harmonics: int, phase: float = 0.0
    ) -> Motion:
        """Motion after the step, from rest without load."""
        equations = self.equations(system, harmonics, phase)
        return integrate(equations, steady(self.load(system)), seconds, dt)


def stepped(page: Page, chosen: ChosenDrivetrain) -> Stepped:
    """The machine of a user's file at its rated operation, all meshes varying by their teeth.

    Raises
    ------
    InputError
        The file does not state its operation, or the teeth of a stage with module and shifts.
    """
    chosen.state(page)
    machine, speed = machine_of(chosen.drivetrain), chosen.rotor_speeds()[1]
    page.assume_all(machine.assumptions())
    page.assume("damping over stiffness", DAMPING, "s", "none is stated")
    meshing = machine_meshing(machine, speed, contact_ratios(machine))
    first = first_mode(machine_system(machine, Level.TORSIONAL))
    return Stepped(machine, chosen.rated_torque(), speed, meshing, first)


def first_mode(system: System) -> float:
    """Lowest frequency above zero [Hz]."""
    found = system_modes(system).frequencies
    return float(found[found > 0.0][0])


def force_of(system: System, forces: Floats, mesh: str) -> Floats:
    """Force of a mesh, of all its slices [N]; forces (..., springs)."""
    return np.asarray(forces[..., springs_named(system.spring_names, mesh)].sum(axis=-1))


def own(run: Run, page: Page, chosen: ChosenDrivetrain) -> None:
    """Forces of all meshes after a step of the rated torque, at two levels and by phase."""
    of = stepped(page, chosen)
    seconds = (1.25 if run.quick else 3.0) / of.first
    fastest = max(one.frequency for one in of.meshing.values())
    dt = 1.0 / ((16.0 if run.quick else 48.0) * fastest)
    harmonics = 4 if run.quick else 16
    page.section("Torque step with varying meshes")
    found: dict[str, ConvergenceInTime] = {}
    by_phase: dict[str, list[float]] = {}
    curves = []
    for name, level in LEVELS.items():
        system = machine_system(of.machine, level)
        with run.step(f"torque step, {name}"):
            found[name] = series = converge_in_time(
                partial(of_step, of, system, seconds), dt, harmonics
            )
        check_in_time(
            page,
            f"torque step, {name}",
            series,
            {MINIMUM: SETTLED, MAXIMUM: SETTLED},
            energy=1e-2,
            why=FEW,
            open_for=(MINIMUM, MAXIMUM),
        )
        least = [of_step(of, system, seconds, dt, harmonics, p).values[MINIMUM] for p in PHASES]
        by_phase[name] = [series.finest.values[MINIMUM], *least]
        motion = of.moved(system, seconds, dt, harmonics)
        static = of.static(system)
        rows: list[Record] = []
        for mesh in of.meshes:
            share = force_of(system, motion.forces, mesh) / force_of(system, static, mesh)
            rows.append({"mesh": mesh, "least": float(share.min()), "largest": float(share.max())})
            if mesh in (of.meshes[0], of.meshes[-1]):
                curves.append(trace(f"{mesh}, {name}", motion.times, share))
        page.table(f"Mesh forces over the static ones, {name}", rows)
    page.chart(FORCES, curves, "time [s]", "force over static")
    page.skip("eccentric bodies and the nacelle's force", "their sizes are those of the paper")
    answer(page, chosen, found, by_phase)


def of_step(
    of: Stepped, system: System, seconds: float, dt: float, harmonics: int, phase: float = 0.0
) -> InTime:
    """Largest force of all meshes over the static ones, and the least once they are loaded."""
    motion, static = of.moved(system, seconds, dt, harmonics, phase), of.static(system)
    shares = [
        force_of(system, motion.forces, mesh) / force_of(system, static, mesh) for mesh in of.meshes
    ]
    loaded = motion.times > 0.5 / of.first
    values = {
        MINIMUM: -max(peak_between(-share[loaded]) for share in shares),
        MAXIMUM: max(peak_between(share) for share in shares),
    }
    return InTime(values, motion.relative_imbalance, motion.converged)


def answer(
    page: Page,
    chosen: ChosenDrivetrain,
    found: dict[str, ConvergenceInTime],
    by_phase: dict[str, list[float]],
) -> None:
    """State the largest and least forces at both levels."""
    flat, space = (found[name] for name in LEVELS)
    low, high = min(by_phase["three dimensions"]), max(by_phase["three dimensions"])
    least, band = space.value(MINIMUM), space.band(MINIMUM)
    teeth = "part" if least + band < 0.0 else "may part" if least < band else "stay in contact"
    page.answer(
        "Which forces do meshes that vary take when the rated torque comes at once?",
        f"In three dimensions meshes carry up to {space.value(MAXIMUM):.2f} times their static "
        f"force, in the torsional model {flat.value(MAXIMUM):.2f} times; teeth {teeth}.",
        [
            *(
                page.value(f"{what}, {name}", one.value(what), one.band(what))
                for what in (MAXIMUM, MINIMUM)
                for name, one in found.items()
            ),
            page.value("the least by the phase of the meshes, lowest", low),
            page.value("the least by the phase of the meshes, highest", high),
        ],
        FORCES,
        [
            f"{chosen.title}: meshes are linear, so that a force below zero is a mesh that would "
            "part."
        ],
    )
