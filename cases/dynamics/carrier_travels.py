"""Planets that travel round the sun in time: gravity and hub moments, and an elastic ring."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.planets_on_pins import first_stage
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import ConvergenceInTime, InTime
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.dynamics import (
    Flexible,
    Level,
    Machine,
    Rim,
    State,
    System,
    TravellingCarriers,
    azimuths,
    contact_ratios,
    generalised_alpha,
    integrate,
    machine_meshing,
    machine_of,
    machine_system,
    over_a_turn,
    steady,
    steady_load,
    travelling,
    varying_equations,
)
from fe_drivetrain.dynamics.bodies.static import Turn
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Run, check_in_time

NAME, TORQUE, MOMENT, SPEED = "nrel_750kw", 3.25e5, -3e5, 2.31  # N m, N m, rad/s
RING = 99
"""Teeth of the ring: meshes in a turn of the carrier."""
STEEL = Material(youngs_modulus=2.06e11, poisson_ratio=0.3, density=7850.0)
RIM = Rim(0.563, 0.08, 0.23, STEEL)
"""Outside the published root circle, 1.047 m, as thick as the published 509 kg of the ring ask for;
not held by bolts."""
TURNING = "Radial load of a bearing of planet 1 over a turn of the carrier"
THIRD = "third harmonic of the ring: line of the mesh over those beside it, of planets passing"
RING_LINES = "lines of an elastic ring"


@dataclass(frozen=True)
class Turning:
    """A machine whose first carrier turns: torque and moment about y of the hub [N m].

    ``speed`` is the rotor's [rad/s], ``side`` the bearing of the planets that is looked at.
    """

    machine: Machine
    torque: float
    moment: float
    speed: float
    side: str

    @property
    def pin(self) -> str:
        """That bearing of the first planet."""
        return f"stage 1 pin 1 {self.side}".strip()

    @property
    def name(self) -> str:
        """That bearing in words."""
        worded = self.side.islower()
        return f"{self.side} bearing" if worded else f"bearing {self.side}".strip()

    def loads(self, system: System) -> Floats:
        """Gravity, torque and the moment that tilts the hub."""
        hub = np.array([0.0, 0.0, 0.0, 0.0, self.moment, 0.0])
        return steady_load(self.machine, system, self.torque, hub)


@case(
    "Planets that travel: loads of their bearings in time, and the mesh as the ring feels it",
    source="statics over a turn; McFadden and Smith 1985: sidebands of planets passing",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise nrel_750kw)",
        "moment": "NUMBER (kN m, against y at your own hub, otherwise as its torque)",
    },
)
def run(run: Run, page: Page) -> None:
    """A turn in time against statics at each azimuth; lines of the ring beside the mesh."""
    chosen = run.drivetrain(NAME)
    chosen.state(page)
    of = turning(run, page, chosen)
    count = 12 if run.quick else 36
    with run.step("a turn in time and at rest"):
        still = at_rest(of, count)
        steps = (6, 12, 24) if chosen.own else (3, 6, 12)
        runs = {n: a_turn(of, count, n) for n in steps}
        moving = runs[steps[-1]][0]
    mean = still.resultant(of.pin).mean()
    page.vanishes(
        f"load of {a_bearing(of)} in time from that of statics, largest over the mean",
        float(np.abs(moving.resultant(of.pin) - still.resultant(of.pin)).max() / mean),
        within=1e-3,
        why="inertia and dampers of 1e-4 s at a rotor's speed, steps of a thirtieth of a planet's "
        "path",
        source="equilibria at each azimuth",
        measure="reaction",
    )
    check_steps(page, of, runs)
    if chosen.own:
        page.skip(RING_LINES, "no drivetrain's file states the rim of its ring outside the teeth")
        answer(page, of, moving, still)
        show_turn(page, of, moving, still, count)
        return
    per_mesh = 4 if run.quick else 18
    with run.step("elastic ring"):
        lines = ring_lines(of, per_mesh)
    beside = lines[[RING - 3, RING + 3]]
    page.vanishes(
        THIRD,
        float(lines[RING] / beside.min()),
        within=0.05,
        why="meshes in phase move it as three forces that turn; the sun's gears push to one side",
        source="symmetry: planets in phase excite orders that are three from the mesh",
        measure="order",
    )
    answer(page, of, moving, still, ring=True)
    show_turn(page, of, moving, still, count)
    show_ring(page, lines, per_mesh)


def turning(run: Run, page: Page, chosen: ChosenDrivetrain) -> Turning:
    """The machine with its loads; those of a user's by the operation of its file.

    Raises
    ------
    InputError
        Its first stage is not planetary, states no bearings of planets, or the file no operation.
    """
    machine = machine_of(chosen.drivetrain)
    _, pins = first_stage(machine)
    if not chosen.own:
        return Turning(machine, TORQUE, MOMENT, SPEED, pins[0])
    torque, speed = chosen.rated_torque(), chosen.rotor_speeds()[1]
    moment = -torque
    if "moment" in run.settings:
        moment = -1e3 * run.positive("moment")
    else:
        page.assume("moment about y at the hub", moment / 1e3, "kN m", "as large as the torque")
    page.assume_all(machine.assumptions())
    return Turning(machine, torque, moment, speed, pins[0])


def a_bearing(of: Turning) -> str:
    """The bearing with its article."""
    return f"{'an' if of.name[:1] in 'aeiou' else 'a'} {of.name}"


def answer(page: Page, of: Turning, moving: Turn, still: Turn, ring: bool = False) -> None:
    """State how the load of a bearing swings in a turn, and what the ring feels."""
    loads, rest = moving.resultant(of.pin), still.resultant(of.pin)
    swing, at_rest = (100.0 * float(np.ptp(one) / one.mean()) for one in (loads, rest))
    bearing = a_bearing(of)
    apart = page.judged(
        f"load of {bearing} in time from that of statics, largest over the mean",
        "largest difference from statics, over the mean load",
        "equilibria",
        unit="%",
    )
    agrees = "agrees within" if apart.status == "good" else "differs by up to"
    lines = []
    cautions = []
    if ring:
        name = f"elastic ring: vibration at the mesh order {RING} over that at {RING - 3}"
        lines = [page.judged(THIRD, f"{name} and {RING + 3}", "symmetry: 0", unit="%")]
        felt = "hardly" if lines[0].status == "good" else "also"
        cautions = [
            f"An elastic ring vibrates {RING - 3} and {RING + 3} times in a turn of the carrier, "
            f"and {felt} at the {RING} mesh periods of a turn."
        ]
    page.answer(
        "How does the load of a planet bearing vary as the carrier turns?",
        f"{bearing[0].upper()}{bearing[1:]}'s load varies by {value_text(swing, '%')} of its mean "
        f"(peak to peak) in a carrier turn; statics at each azimuth {agrees} "
        f"{value_text(apart.value, '%')}.",
        [
            page.value(
                "variation of the load in a turn, peak to peak over mean [%]",
                swing,
                beside=at_rest,
                by="statics",
            ),
            page.value("mean load of the bearing [kN]", float(loads.mean()) / 1e3),
            page.value(
                "largest load of the bearing [kN]",
                float(loads.max()) / 1e3,
                beside=float(rest.max()) / 1e3,
                by="statics",
            ),
            apart,
            *lines,
        ],
        TURNING,
        cautions,
    )


def show_turn(page: Page, of: Turning, moving: Turn, still: Turn, count: int) -> None:
    """Show the load of a bearing over a turn, in time and at rest."""
    page.section("Over a turn")
    angles = np.degrees(azimuths(count))
    page.chart(
        TURNING,
        [
            marked("in time", angles, moving.resultant(of.pin) / 1e3),
            trace("at rest", angles, still.resultant(of.pin) / 1e3),
        ],
        "azimuth of the carrier [deg]",
        "radial load [kN]",
        beside="at rest",
    )


def show_ring(page: Page, lines: Floats, per_mesh: int) -> None:
    """Show the lines of the elastic ring, computed with `per_mesh` steps in a mesh period."""
    page.section("An elastic ring")
    page.unsettled.append(
        f"Not converged: amplitudes of the elastic ring, by {per_mesh} steps in a period of the "
        f"mesh and {max(1, per_mesh // 6)} of its harmonics; which lines there are is symmetry."
    )
    page.table(
        "Third harmonic of the ring, radial amplitude at orders of the carrier",
        [
            {"order": k, "amplitude [µm]": 1e6 * float(lines[k])}
            for k in (3, RING - 6, RING - 3, RING, RING + 3, RING + 6)
        ],
    )


def check_steps(page: Page, of: Turning, runs: dict[int, tuple[Turn, float]]) -> None:
    """Energy and convergence of the pin's load over steps from azimuth to azimuth."""
    by_step = tuple(
        InTime({"largest load of the bearing [N]": float(turn.resultant(of.pin).max())}, lost)
        for turn, lost in runs.values()
    )
    found = ConvergenceInTime(tuple(1.0 / n for n in runs), by_step)
    page.section("Steps of the turn")
    check_in_time(
        page,
        "a turn, meshes as stiff as on average",
        found,
        dict.fromkeys(found.finest.values, 1e-2),
        energy=1e-2,
        why="generalised alpha takes out what the start leaves of vibration",
    )


def a_turn(of: Turning, count: int, steps: int) -> tuple[Turn, float]:
    """Loads in the second turn, meshes as stiff as on average, and the error of the energy."""
    carriers = travelling(of.machine, held_generator=True)
    load = of.loads(carriers.system)
    zero = np.zeros(len(load))
    found = integrate(
        varying_equations(carriers.system, {}, damping=1e-4),
        [steady(load), TravellingCarriers(carriers, of.speed)],
        4 * np.pi / of.speed,
        2 * np.pi / of.speed / (steps * count),
        generalised_alpha(0.3),
        State(np.asarray(np.linalg.solve(carriers.system.K, load), dtype=np.float64), zero, zero),
        every=steps,
    )
    assert found.converged
    second = slice(count, 2 * count)
    names, directions = carriers.system.spring_names, carriers.system.directions
    turn = Turn(found.azimuth[second], names, found.forces[second], directions)
    return turn, found.relative_imbalance


def at_rest(of: Turning, count: int) -> Turn:
    """Equilibria at azimuths."""

    def at(azimuth: float) -> System:
        return machine_system(of.machine, Level.RIGID, azimuth, held_generator=True)

    return over_a_turn(at, of.loads, azimuths(count))


def ring_lines(of: Turning, steps: int) -> Floats:
    """Amplitudes of the third harmonic of an elastic ring by orders of the carrier [m]."""
    rim = Flexible(rims={1: (RIM, (3,))})
    carriers = travelling(of.machine, held_generator=True, flexible=rim)
    system = carriers.system
    meshing = machine_meshing(of.machine, of.speed, contact_ratios(of.machine))
    planetary = {name: mesh for name, mesh in meshing.items() if name.startswith("stage 1")}
    load = system.load_on("rotor", of.torque * np.eye(6)[3])
    zero, turn = np.zeros(len(load)), 2 * np.pi / of.speed
    count = steps * RING
    found = integrate(
        varying_equations(system, planetary, damping=3e-5, harmonics=max(1, steps // 6)),
        [steady(load), TravellingCarriers(carriers, of.speed)],
        1.2 * turn,
        turn / count,
        generalised_alpha(0.2),
        State(np.asarray(np.linalg.solve(system.K, load), dtype=np.float64), zero, zero),
    )
    last = found.q[-count - 1 : -1, system.place("stage 1 rim 3 cos ux")]
    return np.asarray(np.abs(np.fft.rfft(last)) * 2 / count)
