"""Gearbox bearings by six by six, by its diagonal, and on rollers: what the diagonal loses."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos

import numpy as np

from fe_drivetrain.bearing import forces
from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.matrix_models import (
    DIAGONAL,
    FILE,
    LINEAR,
    MATRIX,
    ROLLERS,
    Turned,
    coupling,
    frequencies,
    load_errors,
    peak_load,
    row_name,
    rungs_of_models,
    second_over_first,
    softened,
    turned,
)
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import (
    Machine,
    Operation,
    RollerMatrices,
    azimuths,
    machine_of,
    plain_rungs,
    roller_matrices,
)
from fe_drivetrain.dynamics.bodies.mesh_loads import with_slices
from fe_drivetrain.report import bars
from fe_drivetrain.report.answer import Claim
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run

NAME, MOMENT = "grc_750kw", -3e5  # N m of tilt at the hub, of the non-torque tests
CALM, TILTED = "torque and gravity", "tilt at the hub, too"
SLICES, STEP = 9, 1e-4
MATTERS = 0.05
"""Error of a load from which the couplings of a bearing matter."""
HERO = "Largest error of bearing loads against those on rollers, torque and gravity"


@dataclass(frozen=True)
class Found:
    """Loads by load case and model, matrices at rated and half torque, and frequencies."""

    turns: Mapping[tuple[str, str], Turned]
    full: RollerMatrices
    half: RollerMatrices
    frequencies: Mapping[str, list[float | None]]

    def errors(self, model: str, of: str = CALM) -> dict[str, float]:
        """Errors of loads by the name of each row."""
        return load_errors(self.turns[of, model], self.turns[of, ROLLERS])

    def worst(self, model: str, planets: bool | None = None) -> float:
        """Largest error over both load cases, of planets' bearings or all; 0 where none counts."""
        return max(
            (
                error
                for of in (CALM, TILTED)
                for name, error in self.errors(model, of).items()
                if planets is None or (" pin " in name) is planets
            ),
            default=0.0,
        )

    @property
    def planets(self) -> list[str]:
        """Names of the springs of the planets' bearings."""
        return [name for name in self.full.stiffness if " pin " in name]


@case(
    "Gearbox bearings by six by six against their diagonal, and both against rollers",
    source="Al-Hamadani 2018, section 5.2 (Eq 5.6 to 5.12) and 5.6",
    settings={"drivetrain": "FILE, or a name of the library (otherwise grc_750kw)"},
)
def run(run: Run, page: Page) -> None:
    """Loads over a turn, load over the face, sharing and frequencies, statement by statement."""
    chosen = run.drivetrain(NAME)
    chosen.state(page, topic="Gearbox bearings by six by six against their diagonal, and rollers")
    machine, torque = with_slices(machine_of(chosen.drivetrain), SLICES), chosen.rated_torque()
    moment = -torque if chosen.own else MOMENT
    page.assume("moment about y at the hub", moment / 1e3, "kN m", "for a load off that of rating")
    rungs = plain_rungs(chosen.drivetrain, machine)
    rung = rungs[min(1, len(rungs) - 1)] if run.quick else rungs[-1]
    with run.step("stiffness of rollers"):
        full = roller_matrices(machine, rung, Operation(torque))
        half = roller_matrices(machine, rung, Operation(0.5 * torque))
    models, angles, names = rungs_of_models(rung, full), azimuths(12), list(full.stiffness)
    turns: dict[tuple[str, str], Turned] = {}
    for of, tilt in ((CALM, 0.0), (TILTED, moment)):
        with run.step(of):
            load = Operation(torque, tilt)
            turns |= {(of, n): turned(machine, r, load, angles, names) for n, r in models.items()}
            turns[of, ROLLERS] = turned(machine, rung, load, angles, names, rollers=True)
    with run.step("frequencies"):
        found = Found(turns, full, half, frequencies(machine, models))
    check(page, machine, found, torque)
    show(page, found)
    answer(page, found, rung.name, chosen.own)
    page.assume_all(machine.assumptions())


def check(page: Page, machine: Machine, found: Found, torque: float) -> None:
    """The stiffness by differences of forces, and the torque of the first stage by statics."""
    apart = []
    for seat, u in zip(found.full.found.seats, found.full.found.motions, strict=True):
        K = forces(seat.bearing, u[None])[1][0]
        size = STEP * max(float(np.abs(u[:3]).max()), 1e-9)
        steps = size * np.eye(5)
        there = (forces(seat.bearing, u + sign * steps)[0] for sign in (1.0, -1.0))
        slope = np.subtract(*there) / (2.0 * size)
        root = np.sqrt(np.maximum(K.diagonal(), K.diagonal().max() * 1e-12))
        apart.append(float(np.abs((slope - K) / np.outer(root, root)).max()))
    page.vanishes(
        "six by six against differences of the rollers' forces, on a unit diagonal",
        max(apart),
        within=1e-3,
        why="laminae that come into contact within the step",
        source="F(u + h) - F(u - h) over 2 h",
    )
    stage = machine.stages[0]
    force = stage.arm, "stage 1 mesh", 1.0
    if isinstance(stage, PlanetaryData):
        sun = stage.meshes[0]
        arm = stage.sun_radius * cos(sun.pressure_angle) * cos(sun.base_helix)
        force = arm, "stage 1 sun-planet", stage.speed_ratio
    slices = found.turns[CALM, ROLLERS].slices[force[1]]
    page.equals(
        "torque of the first stage's meshes on rollers [kN m]",
        float(slices[0].sum()) * force[0] / 1e3,
        torque / force[2] / 1e3,
        within=1e-6,
        why="solver; bearings carry no torque",
        source="statics: the torque over the ratio",
    )


def show(page: Page, found: Found) -> None:
    """Errors of loads, face load, sharing and frequencies of the models, and the statements."""
    page.section("Loads of bearings")
    groups = {model: scaled(found.errors(model)) for model in LINEAR}
    page.add(bars(HERO, groups, "largest error over a turn, over the peak on rollers [%]"))
    rows: list[Record] = []
    for of in (CALM, TILTED):
        for row in found.errors(MATRIX, of):
            names = [name for name in found.full.stiffness if row_name(name) == row]
            loads = {m: peak_load(found.turns[of, m], names) / 1e3 for m in (*LINEAR, ROLLERS)}
            rows.append({"load": of, "bearing": row} | {f"{m} [kN]": v for m, v in loads.items()})
    page.table("Peak radial loads over a turn, of planets the largest", rows)
    page.data("peak loads", rows)
    page.section("Teeth")
    page.table("Load over the face and over planets, torque and gravity", teeth(found))
    page.section("Frequencies")
    page.table("Modes of the six by six, and those like them", modes(found))
    page.section("Stiffness")
    page.table("Stiffness at rated torque", stiffness(found))
    page.section("What the thesis says")
    page.table("Printed, ours, verdict", statements(found))


def scaled(errors: Mapping[str, float]) -> dict[str, float]:
    """Errors in per cent."""
    return {name: 100.0 * error for name, error in errors.items()}


def teeth(found: Found) -> list[Record]:
    """K_Hbeta and K_gamma of each mesh by the models."""
    rows: list[Record] = []
    for mesh in found.turns[CALM, MATRIX].slices:
        for name, of in (("K_Hbeta", Turned.face_load), ("K_gamma", Turned.sharing)):
            if name == "K_gamma" and mesh.endswith(" mesh"):
                continue
            values = {m: of(found.turns[CALM, m], mesh) for m in (*LINEAR, ROLLERS)}
            rows.append({"mesh": mesh, "factor": name, **values})
    return rows


def modes(found: Found) -> list[Record]:
    """Frequencies of the models side by side [Hz]."""
    return [
        {"mode": k + 1} | {f"{m} [Hz]": found.frequencies[m][k] for m in LINEAR}
        for k in range(len(found.frequencies[MATRIX]))
    ]


def stiffness(found: Found) -> list[Record]:
    """Diagonal and couplings of each row's first bearing."""
    rows: dict[str, Record] = {}
    change = softened(found.half, found.full)
    for name, K in found.full.stiffness.items():
        row = row_name(name)
        k = K.diagonal()
        rows.setdefault(
            row,
            {
                "bearing": row,
                "along [N/um]": k[0] / 1e6,
                "across, first axis [N/um]": k[1] / 1e6,
                "across, second axis [N/um]": k[2] / 1e6,
                "tilt, first axis [N m/mrad]": k[4] / 1e3,
                "tilt, second axis [N m/mrad]": k[5] / 1e3,
                "largest coupling": coupling(K),
                "change across from half torque [%]": 100.0 * change[row],
            },
        )
    return list(rows.values())


def shifts(found: Found, model: str) -> list[float]:
    """Relative differences of frequencies from the six by six, of modes that a model has."""
    pairs = zip(found.frequencies[model], found.frequencies[MATRIX], strict=True)
    return [abs(one / best - 1.0) for one, best in pairs if one is not None and best]


def statements(found: Found) -> list[Record]:
    """The thesis's statements about bearings, each with a verdict."""
    all_of, shaft, planet = (found.worst(DIAGONAL, which) for which in (None, False, True))
    couplings = [coupling(K) for K in found.full.stiffness.values()]
    changes = softened(found.half, found.full).values()
    downwind = [e for n, e in found.errors(DIAGONAL).items() if n.endswith("downwind")]
    rows = [
        (
            "off-diagonal terms should be included for good fidelity (5.2.1)",
            f"without them loads of bearings err by up to {100 * all_of:.2g} %, with them by "
            f"{100 * found.worst(MATRIX):.2g} %; frequencies move by up to "
            f"{100 * max(shifts(found, DIAGONAL)):.2g} %",
            "holds" if all_of > MATTERS else "does not hold",
        ),
        (
            "the diagonal assumes that strain by forces and moments across is negligible (5.2.1)",
            f"couplings of {min(couplings):.2g} to {max(couplings):.2g} of the diagonal's roots",
            "holds" if max(couplings) < MATTERS else "does not hold for all bearings",
        ),
        (
            "constant terms are fair where displacements are small (5.2.2)",
            f"from half to all of the torque stiffness across changes by {100 * min(changes):.2g} "
            f"to {100 * max(changes):.2g} %",
            "holds" if max(changes) < MATTERS else "holds in part",
        ),
        (
            "it is important especially for the downwind bearings of planets (5.6)",
            f"planets {100 * planet:.2g} %, downwind {100 * max(downwind, default=0.0):.2g} %; "
            f"shafts {100 * shaft:.2g} %",
            "holds" if planet > shaft else "does not hold",
        ),
    ]
    if found.planets:
        rows.insert(2, harmonics(found))
    else:
        rows.pop()
    return [{"statement": s, "ours": ours, "verdict": v} for s, ours, v in rows]


def harmonics(found: Found) -> tuple[str, str, str]:
    """The statement that couplings bring additional harmonics."""
    printed = "off-diagonal terms can be responsible for additional harmonics (5.2.1)"
    of = found.planets[-1]
    each = [second_over_first(found.turns[CALM, m], of) for m in (DIAGONAL, MATRIX, ROLLERS)]
    said = ", ".join(f"{value:.2g}" for value in each)
    return (
        printed,
        f"2P over 1P of a planet's bearing: {said} by diagonal, six by six, rollers",
        "holds" if each[1] > 2.0 * each[0] and each[1] > 0.01 else "does not hold in statics",
    )


def answer(page: Page, found: Found, level: str, own: bool) -> None:
    """State the errors of the diagonal and of the six by six, and what of his argument holds."""
    worst, matrix = found.worst(DIAGONAL), found.worst(MATRIX)
    planet = found.worst(DIAGONAL, planets=True)
    met = (worst > MATTERS) + (planet > MATTERS)
    claims: tuple[Claim, ...] = ("does not hold", "holds in part", "holds")
    claim = claims[met]
    ends = f"the thesis's advice to include it {claim}"
    if own:
        ends = f"it {('does not matter', 'matters for some bearings', 'matters')[met]}"
    mesh = next(iter(found.turns[CALM, MATRIX].slices))
    face = {m: found.turns[CALM, m].face_load(mesh) for m in (*LINEAR, ROLLERS)}
    page.answer(
        "How wrong are bearing loads without the off-diagonal terms of bearing stiffness?",
        f"Without off-diagonal stiffness, gearbox-bearing loads err by up to {percent(worst)}, "
        f"those of planet bearings by {percent(planet)}: {ends}.",
        [
            page.value("error of bearing loads, diagonal stiffness alone [%]", 100 * worst),
            page.value(
                "error of bearing loads, full 6 × 6 matrix [%]",
                100 * matrix,
                at_most=100 * MATTERS,
            ),
            page.value("error of planet-bearing loads, diagonal alone [%]", 100 * planet),
            page.value(
                f"face load factor K_Hbeta of {mesh}, bearings on rollers",
                face[ROLLERS],
                beside=face[MATRIX],
                by="6 × 6 matrix",
            ),
            page.value(f"the same, {FILE}", face[FILE], beside=face[DIAGONAL], by="diagonal alone"),
            page.value(
                "largest change of a natural frequency by off-diagonal terms [%]",
                100 * max(shifts(found, DIAGONAL)),
            ),
        ],
        HERO,
        [
            "Rollers are assumed: they fill the published outlines of the bearings."
            if not own
            else "Rollers are those of the catalogue entries that the drivetrain file names.",
            f"Static model of level '{level}' with rigid bearing rings; stiffness is that at rated "
            "torque and one azimuth of the carrier.",
        ],
        claim="" if own else claim,
    )


def percent(share: float) -> str:
    """A share in per cent, in two digits."""
    return value_text(float(f"{100 * share:.2g}"), "%")
