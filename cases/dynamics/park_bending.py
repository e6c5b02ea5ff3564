"""Park et al. 2021: 36 degrees of freedom as printed, and hinges that couple bending to meshes."""

from dataclasses import replace

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
from fe_drivetrain.dynamics.bodies.machine_shafts import in_series, shaft_slices
from fe_drivetrain.dynamics.bodies.static import static
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import percent_text, value_text
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
#: The joint between the two halves of each shaft: what its springs are.
BAR = "one shaft in all directions: E I / L about the middle, and across"
TILT_ALONE = "Eq 15 in tilt, the shaft's own across"
SPHERICAL = "spherical joint with Eq 15, as printed: rigid across"
ONCE = "spherical joint, its rotation counted once: half of Eq 15"
RIGID = 1e13  # N/m, across a spherical joint: some 1e4 times a shaft
BENT = 0.3  # share of a mode's strain energy from which it bends shafts
ROTOR, ABOVE = "first bending mode [Hz]", "lowest mode above 300 Hz that bends shafts [Hz]"
TORSION = "first torsional mode [Hz]"
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
    with run.step("joints"):
        joints = show_joints(page, corrected)
    printed_reading, balance, _ = paradox(page)
    answer(page, loose, forces, SPEED / -printed_reading[ACCELERATION], -balance[SHARE], joints)
    for text in machine.assumed:
        page.assume(text.partition(":")[0], "", "", text.partition(":")[2].strip() or text)


def answer(
    page: Page, loose: int, forces: float, stops: float, share: float, joints: dict[str, Record]
) -> None:
    """State what the printed equations leave free [-], and what hinges add [kN]."""
    bar, printed = joints[BAR], joints[SPHERICAL]
    tilts = loose - 1
    page.answer(
        "Does shaft bending reach the gear meshes by the equations of Park et al. 2021?",
        "By the printed equations shaft bending does not reach the gear meshes; with hinges added, "
        f"100\u00a0kN\u00a0m of bending change mesh forces by {value_text(forces, 'kN')}."
        if tilts
        else "Shaft bending reaches the meshes: 100\u00a0kN\u00a0m of bending change mesh forces "
        f"by {value_text(forces, 'kN')}.",
        [
            page.value("largest mesh force by 100 kN m of bending, with hinges [kN]", forces),
            page.value(
                "motions without any stiffness, as printed", loose, beside=1, by="with hinges"
            ),
            page.value(
                "generator torque that balances the rotor, of the rotor's [%]",
                share,
                beside=30.0,
                by="as printed",
            ),
            page.value("time to standstill with the printed 30 % [s]", stops),
            page.judged("speed ratio", by="Table 2", printed=str(park.RATIO)),
            page.value(
                f"{ABOVE.partition(' [')[0]}, shafts solid bars [Hz]",
                bar[ABOVE],
                beside=printed[ABOVE],
                by="joint of Eq 15",
            ),
        ],
        BENDING,
        [
            f"As printed, {tilts} tilts of the bodies have no stiffness at all.",
            "The joint of Eq 15 counts its rotation twice: the first bending mode is "
            f"{percent_text(printed[ROTOR] / bar[ROTOR] - 1.0)} higher with it.",
            f"The printed generator torque, 30\u00a0% of the rotor's, would stop the machine after "
            f"{stops:.0f}\u00a0s: balance needs {share:.1f}\u00a0%, so that 3\u00a0% may have been "
            "meant.",
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


def joint_stiffness(system: System, joint: str) -> System:
    """The system with another joint at the middle of each shaft."""
    stiffness = system.stiffness.copy()
    for shaft, printed in park.BENDING.items():
        tilts, across = (
            [system.spring_names.index(f"{shaft} {motion}") for motion in motions]
            for motions in (("ry", "rz"), ("uy", "uz"))
        )
        if joint != BAR:
            stiffness[tilts] = printed / 2.0 if joint == ONCE else printed
        if joint in (SPHERICAL, ONCE):
            stiffness[across] = RIGID
    return replace(system, stiffness=stiffness)


def show_joints(page: Page, system: System) -> dict[str, Record]:
    """What the joint between the halves of a shaft does to frequencies."""
    check_sag(page)
    found: dict[str, Record] = {}
    for joint in (BAR, TILT_ALONE, SPHERICAL, ONCE):
        own = bending_modes(joint_stiffness(system, joint))
        found[joint] = {"joint of each shaft": joint, **own}
    page.section("The spherical joint of a shaft")
    page.table("Frequencies by the joint, bearings as assumed", [*found.values()])
    apart = [float(row[ABOVE]) for row in found.values()]
    page.holds(
        "shafts bend above 300 Hz with every joint",
        min(apart) > 300.0,
        why="the source puts what it sees above 300 Hz down to bearings and shaft bending",
        source=f"{park.SOURCE}, section 4",
    )
    page.text(
        "The springs of Table 2 are those of Eq 15, whose Eq 14 has the energy of one rotation "
        "twice: at the middle of a shaft they are twice what the deflection of its end needs, and "
        f"{2.0 * park_over_beam():.3g} of its E I / L. A spherical joint does not give across, and "
        "one spring cannot have both the deflection and the rotation of an end "
        "(verification/link_and_springs). The library's shafts are one solid bar each, the one "
        "that has both tabled stiffnesses, in all directions. The mesh force of a moment on the "
        "rotor is decided by statics, whatever the joint; nor do torsion, the printed period of "
        "0.4 s and the printed mesh lines feel it."
    )
    return found


def bending_modes(system: System) -> Record:
    """Modes that bend shafts, and the first torsional one."""
    modes = system_modes(system)
    ends = tuple(f"{shaft} {m}" for shaft in park.SHAFTS for m in ("uy", "uz", "ry", "rz"))
    bent = [k for k, name in enumerate(system.spring_names) if name in ends]
    turned = [k for k, name in enumerate(system.spring_names) if name.endswith(" rx")]
    shares, f = modes.strain_shares, modes.frequencies
    bending, torsion = shares[bent].sum(axis=0), shares[turned].sum(axis=0)
    high = (f > 300.0) & (bending > BENT)
    return {
        ROTOR: float(f[bending > BENT].min()),
        TORSION: float(f[(torsion > 0.1) & (bending < BENT)].min()),
        ABOVE: float(f[high].min()),
    }


def park_over_beam() -> float:
    """Half of the low-speed shaft's tabled spring over E I / L of the bar that it is of."""
    shaft = library_machine("park_2021").shafts[0]
    bar = in_series(shaft_slices(shaft, 0.0, shaft.length), shaft.material)[1][4]
    return 0.5 * park.BENDING["LSS"] / bar


def check_sag(page: Page) -> None:
    """The library's low-speed shaft as a cantilever against Timoshenko's beam."""
    shaft = library_machine("park_2021").shafts[0]
    (piece,) = shaft_slices(shaft, 0.0, shaft.length)
    section, L, steel = piece.section, shaft.length, shaft.material
    bend = L**3 / (3.0 * steel.youngs_modulus * section.inertias[0])
    sheared = L / (steel.shear_modulus * section.shear_areas[0])
    k = in_series([piece], steel)[1]
    page.equals(
        "low-speed shaft as a cantilever: deflection of its end by 1 N [m]",
        1.0 / k[1] + (L / 2.0) ** 2 / k[4],
        bend + sheared,
        **round_off(50, "a few sums of flexibilities"),
        source="Timoshenko's beam: F L^3 / (3 E I) + F L / (G A_s)",
    )


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
