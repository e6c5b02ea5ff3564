"""Damped drivetrains: what the tabled dampers do, and what their damping ratios mean."""

from contextlib import nullcontext
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from fe_drivetrain.cases import case
from fe_drivetrain.cases.drivetrain.own_damping import checked_rows, own_damping
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.implied_shafts import DAMPING_RATIO, SHEAR_MODULUS, implied
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics.torsion import (
    GENERATOR,
    ROTOR,
    GeneratorState,
    Torsional,
    damped,
    damped_modes,
    gear_masses,
    mesh_damping,
    response,
    shaft_damping,
    stage_masses,
    two_masses,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

#: Section 4.1: average damping ratio of gear meshes.
MESH_RATIO = 0.1
POINTS, QUICK_POINTS = 500, 120
#: Frequency [Hz] above which the generator's spring makes no difference, for a table.
LOW = 10.0
RESPONSES = (
    "Generator's speed for a torque of 1 N m on the rotor, generator fixed, eleven masses: the "
    "tabled dampers leave the two lowest modes all but undamped"
)

TABLE = published.table("nrel_750kw")
PLANETARY, *PARALLEL = published.nrel_stages(TABLE)
Models = dict[GeneratorState, dict[str, Torsional]]


class InSeries(NamedTuple):
    """One damper for all shafts of the free drivetrain, and what it makes of two masses.

    Attributes
    ----------
    damper : float
        K^2 sum(C_i / K_i^2) [N m s/rad].
    ratio, of_five : float
        Damping ratio of two masses with it, and of five masses.
    """

    damper: float
    ratio: float
    of_five: float


@case(
    "NREL 750 kW drivetrain with damping: tabled dampers and damping ratios",
    source="Al-Hamadani 2018, Eq 4.5, 4.7, 4.18-4.22 and 4.30, Table 4.2",
    settings={"drivetrain": "FILE, or a name of the library (otherwise drivetrain D)"},
)
def run(run: Run, page: Page) -> None:
    """Eigenvalues with the dampers as tabled, and as the damping ratios of the text mean them."""
    if SETTING in run.settings:
        own_damping(run, page)
        return
    with run.step("eigenvalues"):
        meshes = mesh_rows()
        models = {state: models_of(state, meshes) for state in published.STATES}
    swinging = damped_modes(models["free"]["2 masses, as meant"]).ratios[0]
    grid = np.geomspace(0.1, 1e4, QUICK_POINTS if run.quick else POINTS)
    check_as_meant(run, page, models, float(swinging), grid)
    page.about(published.drivetrain("nrel_750kw"))
    rows = check_eigenvalues(page, models)
    series = check_series(page, models["free"])
    check_planets(page, models["fixed"]["11 masses, as tabled"])
    with run.step("frequency response"):
        curves = responses(models["fixed"], grid)
    tabled = float(damped_modes(models["free"]["2 masses, as tabled"]).ratios[0])
    behind = shafts_behind()
    lss = behind[0]
    answer(page, models["free"], tabled, lss)
    show_dampers(page, behind, meshes)
    show_series(page, models["free"], series, tabled)
    show_modes(page, curves, rows)
    page.assume(
        "J of Eq 4.5",
        "J_a J_b / (J_a + J_b) of all before and all behind the shaft",
        "kg m^2",
        "makes the ratio that of the drivetrain's own swing; the thesis gives none",
    )
    page.assume(
        "damping of the generator's field",
        0.0,
        "N m s/rad",
        "C_5 of Eq 4.35 has no value in the thesis",
    )
    page.assume("G", SHEAR_MODULUS, "Pa", "steel; not given")
    page.data("tabled_two_masses", tabled)
    page.data("low_speed_shaft_polar", lss["J [m^4]"])
    page.data("low_speed_shaft_length", lss["length G J / k [m]"])


def answer(page: Page, free: dict[str, Torsional], tabled: float, lss: Record) -> None:
    """State what the tabled dampers and the text's ratio make of the drivetrain's swing."""
    asked = 100 * DAMPING_RATIO
    ratios = {
        f"{n} masses": 100 * float(damped_modes(free[f"{n} masses, as meant"]).ratios[0])
        for n in (2, 5, 11)
    }
    holds = abs(tabled / DAMPING_RATIO - 1) < MESH_RATIO
    stated = (
        "as the thesis says"
        if holds
        else f"not {asked:g}\u00a0% as the thesis says: second moments of area were taken for "
        "inertias"
    )
    page.answer(
        "How strongly do the tabled dampers damp the drivetrain's first torsional mode?",
        f"The tabled dampers give {value_text(100 * tabled, '%')} of critical damping, {stated}.",
        [
            page.value(
                "damping ratio of the first mode, dampers as tabled [%]",
                100 * tabled,
                beside=asked,
                by="text of the thesis",
            ),
            *(
                page.value(
                    f"the same, dampers from inertias, {name} [%]", ratio, beside=asked, by="text"
                )
                for name, ratio in ratios.items()
            ),
            page.judged(
                "11 masses, as tabled: damping ratio of planets against each other",
                "damping ratio of planets against each other",
                "one oscillator",
                unit="%",
            ),
        ],
        RESPONSES,
        claim="holds" if holds else "does not hold",
    )
    page.say(
        "Eq 4.5 was evaluated with J as the shaft's second moment of area [m^4] where it needs an "
        "inertia [kg m^2]. The shafts follow from that: "
        f"C_LSS = {lss['C [N m s/rad]']:g} N m s/rad is a J of "
        f"{1e3 * lss['J [m^4]']:.3f}e-3 m^4, a solid shaft of {lss['diameter [m]']:.3f} m and, "
        f"with G = 80 GPa, {lss['length G J / k [m]']:.2f} m length.",
    )


def shafts_behind() -> list[Record]:
    """Eq 4.5 backwards: the J behind each tabled damper, and the solid shaft of that J."""
    rows = []
    for shaft in TABLE.shafts:
        solid = implied(shaft.stiffness, shaft.damping)
        rows.append(
            {
                "shaft": shaft.name,
                "k [N m/rad]": shaft.stiffness,
                "C [N m s/rad]": shaft.damping,
                "J [m^4]": solid.polar,
                "diameter [m]": solid.diameter,
                "length G J / k [m]": solid.length,
            }
        )
    return rows


def mesh_rows() -> list[Record]:
    """Mesh dampers as tabled and by the damping ratio, with the elements that they are of."""
    p = PLANETARY.planet_over_sun
    planets = range(1, PLANETARY.planets + 1)
    meshes = [
        (
            "ring-planet",
            PLANETARY.ring_planet,
            PLANETARY.ring_planet_damping,
            shaft_damping(MESH_RATIO, PLANETARY.planet, PLANETARY.ring_planet),
            [f"stage 1 ring-planet {i}" for i in planets],
        ),
        (
            "sun-planet",
            PLANETARY.sun_planet,
            PLANETARY.sun_planet_damping,
            mesh_damping(MESH_RATIO, PLANETARY.sun_planet, PLANETARY.planet, PLANETARY.sun, p),
            [f"stage 1 sun-planet {i}" for i in planets],
        ),
        *(
            (
                f"parallel {i}",
                stage.mesh,
                stage.mesh_damping,
                mesh_damping(MESH_RATIO, stage.mesh, stage.gear, stage.pinion, stage.speed_ratio),
                [f"stage {i + 1} mesh"],
            )
            for i, stage in enumerate(PARALLEL, start=1)
        ),
    ]
    return [
        {
            "mesh": name,
            "k [N m/rad]": k,
            "Table 4.2": printed,
            "computed": value,
            "ratio": printed / value,
            "elements": elements,
        }
        for name, k, printed, value, elements in meshes
    ]


def models_of(state: GeneratorState, meshes: list[Record]) -> dict[str, Torsional]:
    """Two, five and eleven masses, with the dampers as tabled and as the text means them."""
    two, five, eleven = (make(TABLE, state) for make in (two_masses, stage_masses, gear_masses))
    # Eq 4.5 with an inertia: all on the rotor's side of a shaft against all on the generator's
    cumulated = np.cumsum(stage_masses(TABLE).J)
    before, after = cumulated[:-1], cumulated[-1] - cumulated[:-1]
    speeds = TABLE.speeds
    shafts = {
        shaft.name: shaft_damping(DAMPING_RATIO, float(a * b / (a + b) / s**2), shaft.stiffness)
        for shaft, a, b, s in zip(TABLE.shafts, before, after, speeds, strict=True)
    }
    on_rotor = {
        shaft.name: s**2 * shafts[shaft.name] for shaft, s in zip(TABLE.shafts, speeds, strict=True)
    }
    of_meshes = {element: row["computed"] for row in meshes for element in row["elements"]}
    a, b = two.J
    swing = shaft_damping(DAMPING_RATIO, float(a * b / (a + b)), float(two.k[0]))
    return {
        "2 masses, as tabled": two,
        "5 masses, as tabled": five,
        "11 masses, as tabled": eleven,
        "2 masses, as meant": damped(two, {"shafts": swing}),
        "5 masses, as meant": damped(five, on_rotor),
        "11 masses, as meant": damped(eleven, shafts | of_meshes),
    }


def check_as_meant(run: Run, page: Page, models: Models, swinging: float, grid: Floats) -> None:
    """Dampers that the table does not have: of no drivetrain that is given."""
    page.equals(
        "2 masses, generator free, Eq 4.5 with J_1 J_2 / (J_1 + J_2): damping ratio",
        swinging,
        DAMPING_RATIO,
        within=1e-10,
        why="two free masses are one oscillator: exact but for rounding",
        source="Al-Hamadani 2018, section 4.1: 0.006 of critical damping",
        measure="frequency",
    )
    two = models["fixed"]["2 masses, as meant"]
    quartic = check_quartic(page, two)
    with run.step("decay in time"):
        check_decay(page, models["free"]["5 masses, as meant"])
    check_response(page, two, quartic, grid)


def check_eigenvalues(page: Page, models: Models) -> list[Record]:
    """Residual of each eigenvalue; damping ratios beside those of first order."""
    rows = []
    for state, systems in models.items():
        for name, system in systems.items():
            with nullcontext() if name.endswith("as tabled") else page.of(None):
                own = checked_rows(page, name, state, system, strict=True)
            rows += [row for row in own if state == "fixed" or row["undamped [Hz]"] <= LOW]
    return rows


def check_series(page: Page, free: dict[str, Torsional]) -> InSeries:
    """Springs in series wind in proportion to their compliance; each takes its damper along."""
    five = stage_masses(TABLE, "free")
    dampers = np.array([e.damping for e in five.elements])
    together = 1 / np.sum(1 / five.k)
    wound = float(together**2 * np.sum(dampers / five.k**2))
    two = damped(free["2 masses, as tabled"], {"shafts": wound})
    found = InSeries(
        wound,
        float(damped_modes(two).ratios[0]),
        float(damped_modes(free["5 masses, as tabled"]).ratios[0]),
    )
    gearbox = float(np.sum(five.J[1:-1]) / five.J[-1])
    page.equals(
        "2 masses, generator free, damper K^2 sum(C_i / K_i^2): damping ratio against that of 5 "
        "masses",
        found.ratio,
        found.of_five,
        within=2 * gearbox,
        why="the gearbox's masses, left out of the winding, are "
        f"{gearbox:.3f} of the generator's, and change the torque in a shaft by no more; "
        "dissipation goes with its square",
        source="5 masses, dampers as tabled",
        measure="frequency",
    )
    return found


def check_quartic(page: Page, system: Torsional) -> Floats:
    """Decay of two masses against the characteristic quartic: its coefficients."""
    (a, b), (k, g) = system.J, system.k
    c = float(system.C[0, 0])
    quartic: Floats = np.polysub(np.polymul([a, c, k], [b, c, k + g]), np.polymul([c, k], [c, k]))
    roots = np.roots(quartic)
    roots = np.sort_complex(roots[roots.imag > 0])
    roots = roots[np.argsort(roots.imag)]
    found = damped_modes(system).eigenvalues
    for m, (value, root) in enumerate(zip(found, roots, strict=True), start=1):
        page.equals(
            f"2 masses, as meant, generator fixed: decay of mode {m} [1/s]",
            float(-value.real),
            float(-root.real),
            within=1e-8,
            why="exact; decay is a hundredth of the frequency, and the roots have some twelve "
            "digits of that",
            source="roots of the characteristic quartic",
            measure="frequency",
        )
    return quartic


def check_planets(page: Page, system: Torsional) -> None:
    """Planets against each other are a single oscillator."""
    stiffness = PLANETARY.ring_planet + PLANETARY.sun_planet
    damper = PLANETARY.ring_planet_damping + PLANETARY.sun_planet_damping
    pair = float(damper / (2 * np.sqrt(stiffness * PLANETARY.planet)))
    ratios = damped_modes(system).ratios
    page.equals(
        "11 masses, as tabled: damping ratio of planets against each other",
        float(ratios[np.abs(ratios - pair).argmin()]),
        pair,
        within=1e-9,
        why="a single oscillator: exact but for rounding",
        source="(C_RP + C_SP) / 2 sqrt((K_RP + K_SP) J_P)",
        measure="frequency",
    )


def check_decay(page: Page, system: Torsional) -> None:
    """One period of free decay, integrated exactly."""
    value = damped_modes(system).eigenvalues[0]
    page.equals(
        "5 masses, as meant, generator free: share of the swing's energy kept after one period",
        kept_after_a_period(system, value),
        float(np.exp(4 * np.pi * value.real / value.imag)),
        within=1e-8,
        why="exact but for the exponential's rounding: the fastest mode turns 670 times",
        source="exponential of the state matrix over one period, from the mode's shape",
        measure="energy",
    )


def kept_after_a_period(system: Torsional, value: complex) -> float:
    """Energy of winding and turning after a period over that before, from a mode's own motion."""
    n = len(system.J)
    M, C, K = system.M, system.C, system.K
    matrix = value**2 * M + value * C + K
    shape = np.linalg.svd(matrix / np.outer(system.J, np.ones(n)))[2][-1].conj()
    state = np.concatenate([shape, value * shape]).real
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-K / system.J[:, None], -C / system.J[:, None]]])
    later = expm(A * (2 * np.pi / value.imag)) @ state

    def energy(x: Floats) -> float:
        return float(x[:n] @ K @ x[:n] + x[n:] @ M @ x[n:])

    return energy(later) / energy(state)


def with_peaks(system: Torsional, grid: Floats) -> Floats:
    """Frequencies of a grid, and the damped ones of a system [Hz]."""
    return np.unique(np.concatenate([grid, damped_modes(system).frequencies]))


def responses(systems: dict[str, Torsional], grid: Floats) -> dict[str, tuple[Floats, Floats]]:
    """Speed of the generator per torque on the rotor [rad/s / (N m)] over the frequency [Hz]."""
    curves = {}
    for name, system in systems.items():
        x = with_peaks(system, grid)
        turned = response(system, ROTOR, x)[:, system.place(GENERATOR)]
        scale = TABLE.speeds[-1] if name.startswith(("2", "5")) else 1.0
        curves[name] = x, np.abs(turned) * 2 * np.pi * x * scale
    return curves


def check_response(page: Page, system: Torsional, quartic: Floats, grid: Floats) -> None:
    """Two masses against their transfer function."""
    x = with_peaks(system, grid)
    turned = response(system, ROTOR, x)[:, system.place(GENERATOR)]
    s = 2j * np.pi * x
    exact = (float(system.C[0, 0]) * s + system.k[0]) / np.polyval(quartic, s)
    page.vanishes(
        "2 masses, as meant: largest relative distance of the response at the generator from "
        "Cramer's rule",
        float(np.abs(turned / exact - 1).max()),
        within=1e-9,
        why="exact but for rounding; at resonance the quartic cancels to a hundredth",
        source="transfer function (C s + K) / quartic",
    )


def show_dampers(page: Page, behind: list[Record], meshes: list[Record]) -> None:
    """The dampers of Table 4.2, and what they mean."""
    page.section("The dampers of Table 4.2")
    page.table(
        "J of Eq 4.5, (C / 2 zeta)^2 / k with zeta = 0.006, and the solid shaft of that second "
        "moment of area, with G = 80 GPa",
        behind,
    )
    hss = behind[-1]
    diameter, length = hss["diameter [m]"], hss["length G J / k [m]"]
    page.text(
        f"Three of them are plausible shafts. The high-speed one would be {diameter:.2f} m thick "
        f"and {length:,.0f} m long; with a damper of a hundredth, {hss['C [N m s/rad]'] / 100:g}, "
        f"it would be {diameter / 10:.3f} m and {length / 1e4:.2f} m. In kg m^2 that of the "
        "low-speed shaft would be a hundredth of the least gear's."
    )
    page.table(
        "Mesh dampers [N m s/rad] about the planet's and gear's axis: as tabled, and "
        "2 zeta sqrt(k J) with zeta = 0.1 and J what the two gears oppose to each other",
        meshes,
        ["mesh", "k [N m/rad]", "Table 4.2", "computed", "ratio"],
    )


def show_series(page: Page, free: dict[str, Torsional], series: InSeries, tabled: float) -> None:
    """What Eq 4.30 and Eq 4.7 leave open."""
    page.text(
        "Eq 4.30 adds dampers as if they stood in series alone. Beside springs they do not: in a "
        "slow swing each shaft winds by its own share of the torque, so that C = K^2 "
        f"sum(C_i / K_i^2) dissipates what all of them do: {series.damper:.3g} N m s/rad here "
        f"where Eq 4.30 has {free['2 masses, as tabled'].elements[0].damping:.3g}, a ratio of "
        f"{series.ratio:.3g} (five masses: {series.of_five:.3g}) instead of {tabled:.3g}."
    )
    page.text(
        "Eq 4.7 cannot be evaluated as printed: the thesis gives no base radii, and its "
        "r_1^2 r_2^2 J_1 J_2 / (r_1^2 J_1 + r_2^2 J_2) is a length squared more than an inertia, "
        "in which each inertia has the other's radius: with the driven gear held (J_2 infinite) "
        "it must leave J_1, and does with r_1^2 J_2 + r_2^2 J_1 below. The tabled mesh dampers are "
        "of the right size."
    )


def show_modes(page: Page, curves: dict[str, tuple[Floats, Floats]], rows: list[Record]) -> None:
    """Responses and damping ratios."""
    page.section("Damped modes")
    for caption, word in (
        (
            "Generator's speed for a torque of 1 N m on the rotor, generator fixed: two, five and "
            "eleven masses with dampers as meant",
            "meant",
        ),
        (
            RESPONSES,
            "11",
        ),
    ):
        page.chart(
            caption,
            [trace(name, x, y) for name, (x, y) in curves.items() if word in name],
            "frequency [Hz]",
            "speed per torque [rad/s / (N m)]",
            "xy",
        )
    page.table(
        "Damping ratios: exact eigenvalues, and to first order, phi^T C phi / 2 omega; above "
        f"{LOW:g} Hz the free generator's are the same",
        rows,
    )
