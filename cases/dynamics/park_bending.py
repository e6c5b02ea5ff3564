"""Park et al. 2021: 36 degrees of freedom as printed, and hinges that couple bending to meshes."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.park_models import SPEED, turning_inertia
from fe_drivetrain.cases.references import park_2021 as park
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.comparison import as_printed, round_off
from fe_drivetrain.dynamics import (
    Level,
    Machine,
    System,
    direction_kinds,
    library_machine,
    machine_system,
    system_modes,
)
from fe_drivetrain.dynamics.bodies.static import static
from fe_drivetrain.report import bars
from fe_drivetrain.report.suite import Page, Record, Run

COSINE = float(np.cos(np.radians(20.0)) ** 2)
#: The reading of the meshes, their factor, whether the planetary ones are there along both axes.
READINGS = (
    ("as printed, one spring a mesh along x", 1.0, False),
    ("times cos^2 of the pressure angle", COSINE, False),
    ("all meshes twice, along x and y", 2.0, False),
    ("planetary meshes twice, as Eq 25 reads", 1.0, True),
)
BENDING = "Mesh forces of a bending moment of 100 kN m on the rotor, as printed and with hinges"
PERIOD = "period of the first mode [s]"
SHARE, ACCELERATION = "over the rotor's torque [%]", "acceleration [rad/s^2]"


@case(
    "Park et al. 2021: what 36 degrees of freedom as printed can do, and what hinges add",
    source="Park et al. 2021, Front. Energy Res. 8:604414, Eq 13-25, Tables 2 and 3",
)
def run(run: Run, page: Page) -> None:
    """Nullity, spectra, loads of a bending moment, torque balance; as printed and corrected."""
    printed = park.printed_model(1e9, both=True)
    machine = library_machine("park_2021")
    page.about(machine)
    with run.step("corrected model"):
        corrected = machine_system(machine, Level.RIGID)
    check_ratios(page, machine)
    loose = park.nullity(printed)
    with page.of(None):
        page.holds(
            "as printed: 36 degrees of freedom, 7 motions that no spring feels",
            (len(printed.names), loose) == (36, 7),
            why="the machine turns freely; six more are tilts of whole shafts, which nothing holds",
            source="Eq 17-25: no bearing holds tilts, and nothing couples them to translations",
        )
    page.holds(
        "with hinges between bodies: one motion that no spring feels",
        park.nullity(corrected) == 1,
        why="the machine turns freely",
        source="a hinge moves with the bodies' tilts: x_a + l_a psi_a = x_b - l_b psi_b",
    )
    forces = moments(page, machine)
    with page.of(None):
        spectra(run, page)
    show_modes(page, corrected)
    printed_reading, balance, _ = paradox(page)
    answer(page, loose, forces, SPEED / -printed_reading[ACCELERATION], -balance[SHARE])
    for text in machine.assumed:
        page.assume(text.partition(":")[0], "", "", text.partition(":")[2].strip() or text)


def answer(page: Page, loose: int, forces: float, stops: float, share: float) -> None:
    """State what the printed equations leave free [-], and what hinges add [kN]."""
    tilts = loose - 1
    page.answer(
        "Does shaft bending reach the gear meshes by the equations of Park et al. 2021?",
        f"Shaft bending does not reach a mesh as printed: {tilts} tilts are free; hinges let "
        f"100\u00a0kN\u00a0m change mesh forces by {forces:.2f}\u00a0kN."
        if tilts
        else "Shaft bending reaches the meshes: 100\u00a0kN\u00a0m change mesh forces by "
        f"{forces:.2f}\u00a0kN.",
        [
            page.value("largest mesh force of 100 kN m, with hinges [kN]", forces),
            page.value(
                "motions that no spring feels, as printed", loose, beside=1, by="with hinges"
            ),
            page.value(
                "generator torque that balances the rotor [%]", share, beside=30.0, by="as printed"
            ),
            page.value("standstill with the printed 30 % after [s]", stops),
            page.judged("speed ratio", by="Table 2", printed=str(park.RATIO)),
        ],
        BENDING,
        [
            f"A generator torque of 30 % of the rotor's would stop the machine after {stops:.0f} "
            f"s: balance needs {share:.1f} %, so that 3 % may have been meant."
        ],
        claim="does not hold" if tilts else "holds",
    )


def check_ratios(page: Page, machine: Machine) -> None:
    """Table 3 and the ratio of the gearbox."""
    page.equals(
        "speed ratio",
        park.ratio(),
        **as_printed(str(park.RATIO)),
        source=f"{park.SOURCE}, Table 2",
    )
    page.equals(
        "speed ratio of the assembled machine",
        machine.speeds[-1],
        park.ratio(),
        **round_off(50, "products of eight ratios of radii, in either order"),
        source="radii of Table 2",
        basis="self-consistency",
    )
    for large, small, value in park.TABLE_3:
        page.equals(
            f"ratio of radii, {large} to {small}",
            park.RADII[large] / park.RADII[small],
            **as_printed(str(value)),
            source=f"{park.SOURCE}, Table 3",
        )


def moments(page: Page, machine: Machine) -> float:
    """Mesh forces [kN] of a bending moment of 100 kN m on the rotor, in either model."""
    load = np.array([0.0, 0.0, 0.0, 0.0, 1e5, 0.0])
    with page.of(None):
        refused = moment_as_printed(page, load)
    system = machine_system(machine, Level.RIGID, held_generator=True)
    found = static(system, system.load_on("rotor", load))
    springs = [n for n in system.spring_names if "planet" in n or "mesh" in n]
    meshes_of = sorted(springs)
    rows: list[Record] = [
        {
            "mesh": n,
            "force with hinges [kN]": found.force(n) / 1e3,
            "force as printed [kN]": "no equilibrium" if refused else "an equilibrium",
        }
        for n in meshes_of
    ]
    page.section("A bending moment of 100 kN m on the rotor")
    hinged = {n: abs(found.force(n)) / 1e3 for n in meshes_of}
    printed = {"as printed: none": dict.fromkeys(hinged, 0.0)} if refused else {}
    page.add(bars(BENDING, {"with hinges": hinged, **printed}, "size of the force [kN]"))
    page.table("Static mesh forces along the lines of action", rows)
    return max(abs(found.force(n)) for n in meshes_of) / 1e3


def moment_as_printed(page: Page, load: Floats) -> bool:
    """What the printed model feels of a moment on the rotor; whether it has no equilibrium."""
    printed = park.printed_model(1e9, both=True)
    row = printed.load_on("rotor", load)
    # in what the springs of the meshes feel there is nothing of it, whatever holds the tilts
    held = printed.K + 1e-3 * np.diag(printed.K.diagonal())
    q = np.linalg.solve(held, row)
    names = enumerate(printed.spring_names)
    meshes = [k for k, name in names if "planet " in name or "gears" in name]
    felt = float(np.abs(printed.rows[meshes] @ q).max())
    page.vanishes(
        "as printed: elongation of the meshes by a moment on the rotor [m]",
        felt,
        within=0.0,
        why="exact: the tilts are in no row of a mesh",
        source="Eq 17-25",
    )
    try:
        static(printed, row)
        refused = False
    except InputError:
        refused = True
    page.holds(
        "as printed: a moment on the rotor has no equilibrium",
        refused,
        why="nothing holds the shaft against tilt",
        source="Eq 25",
    )
    return refused


def spectra(run: Run, page: Page) -> None:
    """The torsional spectrum under four readings of the meshes, against the period of Fig 7."""
    rows: list[Record] = []
    for name, factor, twice in READINGS:
        f = run.timed(name, park.spectrum, factor, twice)
        rows.append(
            {
                "meshes": name,
                PERIOD: 1 / float(f[1]),
                "frequencies [Hz]": ", ".join(f"{value:.5g}" for value in f[1:]),
            }
        )
    page.section("Torsional spectrum")
    page.table("Frequencies, planets in step, by how the meshes of Eq 20-25 are read", rows)
    page.text(
        "The source sees a contact force with a constant period of about 0.4 s (section 4). No "
        "mesh passes that slowly; the first torsional mode does, swinging after a torque step: "
        f"{rows[0][PERIOD]:.3f} s with the meshes as printed, {rows[2][PERIOD]:.3f} s with all of "
        f"them wound along both axes, {rows[3][PERIOD]:.3f} s with the planetary ones alone."
    )
    page.holds(
        "every reading puts the first mode at 0.4 to 0.54 s",
        all(0.4 < float(str(row[PERIOD])) < 0.54 for row in rows),
        why="else Fig 7 would be something else than this mode",
        source=f"{park.SOURCE}, section 4: 'about 0.4 s'",
    )
    page.data("spectra", rows)


def show_modes(page: Page, corrected: System) -> None:
    """The first modes of the corrected model."""
    found = system_modes(corrected)
    kinds = direction_kinds(corrected, found)
    rows: list[Record] = []
    for number in range(16):
        kinetic = found.kinetic_shares[:, number]
        strain = found.strain_shares[:, number]
        rows.append(
            {
                "frequency [Hz]": float(found.frequencies[number]),
                "kind": kinds[number],
                "most kinetic energy": corrected.bodies[int(kinetic.argmax())],
                "its share": float(kinetic.max()),
                "most strain energy": corrected.spring_names[int(strain.argmax())]
                if strain.max() > 0
                else "none",
                "share of it": float(strain.max()),
            }
        )
    page.section("Modes with hinges, each planet apart")
    page.table("The first sixteen modes; bearings and masses are assumed", rows)


def paradox(page: Page) -> list[Record]:
    """What torque of the generator balances the rotor's."""
    ratio, torque = park.ratio(), park.TORQUE
    rows: list[Record] = []
    inertia = turning_inertia()
    for name, generator in (
        ("-30 % of 15 kN m at the generator, as printed", -0.3 * torque),
        ("balanced: -15 kN m over the ratio", -torque / ratio),
        ("-30 % of 15 kN m over the ratio", -0.3 * torque / ratio),
    ):
        net = torque + generator * ratio
        rows.append(
            {
                "reading": name,
                "generator [N m]": generator,
                SHARE: 100 * generator / torque,
                "net on the rotor [kN m]": net / 1e3,
                ACCELERATION: net / inertia,
            }
        )
    page.section("Torque of the generator")
    page.table("Three readings of 'electromagnetic torque -30 %'", rows)
    page.equals(
        "share of the rotor's torque that the generator needs for balance [%]",
        100 / ratio,
        **as_printed("2.886"),
        source="1 over the speed ratio",
        basis="self-consistency",
    )
    return rows
