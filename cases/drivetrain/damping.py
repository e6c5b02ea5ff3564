"""Damped drivetrains: what the tabled dampers do, and what their damping ratios mean."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Section 4.1: average damping ratios of shafts and of gear meshes.
SHAFT_RATIO, MESH_RATIO = 0.006, 0.1
SHEAR_MODULUS = 80e9
POINTS, QUICK_POINTS = 500, 120
#: Frequency [Hz] above which the generator's spring makes no difference, for a table.
LOW = 10.0


def run(run: Run) -> Any:
    """Eigenvalues with the dampers as tabled, and as the damping ratios of the text mean them."""
    import numpy as np
    from scipy.linalg import expm

    from fe_drivetrain.cases.drivetrain import (
        published,
    )
    from fe_drivetrain.report import AssumptionRow, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.torsion import (
        GENERATOR,
        ROTOR,
        damped,
        damped_modes,
        gear_masses,
        mesh_damping,
        modal_damping,
        natural_modes,
        response,
        shaft_damping,
        stage_masses,
        two_masses,
    )

    table = published.table("nrel_750kw")
    planetary, *parallel = published.nrel_stages(table)
    verdicts: list[Any] = []

    # Eq 4.5 backwards: the J behind each tabled damper
    behind = []
    for shaft in table.shafts:
        J = (shaft.damping / (2 * SHAFT_RATIO)) ** 2 / shaft.stiffness
        behind.append(
            [
                shaft.name,
                shaft.stiffness,
                shaft.damping,
                J,
                float((32 * J / np.pi) ** 0.25),
                J * SHEAR_MODULUS / shaft.stiffness,
            ]
        )

    # Eq 4.5 with an inertia: all on the rotor's side of a shaft against all on the generator's
    lumped = stage_masses(table)
    cumulated = np.cumsum(lumped.J)
    before, after = cumulated[:-1], cumulated[-1] - cumulated[:-1]
    speeds = table.speeds
    meant = {
        shaft.name: shaft_damping(SHAFT_RATIO, float(a * b / (a + b) / s**2), shaft.stiffness)
        for shaft, a, b, s in zip(table.shafts, before, after, speeds, strict=True)
    }
    gear_meant = dict(meant)
    mesh_rows = []
    p = planetary.planet_over_sun
    meshes = [
        (
            "ring-planet",
            planetary.ring_planet,
            planetary.ring_planet_damping,
            shaft_damping(MESH_RATIO, planetary.planet, planetary.ring_planet),
            [f"stage 1 ring-planet {i + 1}" for i in range(planetary.planets)],
        ),
        (
            "sun-planet",
            planetary.sun_planet,
            planetary.sun_planet_damping,
            mesh_damping(MESH_RATIO, planetary.sun_planet, planetary.planet, planetary.sun, p),
            [f"stage 1 sun-planet {i + 1}" for i in range(planetary.planets)],
        ),
        *(
            (
                f"parallel {i}",
                stage.mesh,
                stage.mesh_damping,
                mesh_damping(MESH_RATIO, stage.mesh, stage.gear, stage.pinion, stage.speed_ratio),
                [f"stage {i + 1} mesh"],
            )
            for i, stage in enumerate(parallel, start=1)
        ),
    ]
    for name, k, printed, value, elements in meshes:
        mesh_rows.append([name, k, printed, value, printed / value])
        gear_meant |= dict.fromkeys(elements, value)

    def on_rotor(dampings: Any) -> dict[str, float]:
        return {
            shaft.name: s**2 * dampings[shaft.name]
            for shaft, s in zip(table.shafts, speeds, strict=True)
        }

    models: dict[Any, dict[str, Any]] = {}
    with run.step("eigenvalues"):
        for state in published.STATES:
            two, five, eleven = (
                make(table, state) for make in (two_masses, stage_masses, gear_masses)
            )
            a, b = two.J
            models[state] = {
                "2 masses, as tabled": two,
                "5 masses, as tabled": five,
                "11 masses, as tabled": eleven,
                "2 masses, as meant": damped(
                    two,
                    {"shafts": shaft_damping(SHAFT_RATIO, float(a * b / (a + b)), float(two.k[0]))},
                ),
                "5 masses, as meant": damped(five, on_rotor(meant)),
                "11 masses, as meant": damped(eleven, gear_meant),
            }
    swinging = models["free"]["2 masses, as meant"]
    verdicts.append(
        judge(
            "2 masses, generator free, Eq 4.5 with J_1 J_2 / (J_1 + J_2): damping ratio",
            float(damped_modes(swinging).ratios[0]),
            SHAFT_RATIO,
            tolerance=1e-10,
            source="Al-Hamadani 2018, section 4.1: 0.006 of critical damping",
            reason="two free masses are one oscillator: exact but for rounding",
            measure="frequency",
        )
    )
    rows = []
    for state, systems in models.items():
        for name, system in systems.items():
            found = damped_modes(system)
            worst = max(_residual(system, value, np) for value in found.eigenvalues)
            verdicts.append(
                judge(
                    f"{name}, generator {state}: largest residual of lambda^2 M + lambda C + K",
                    worst,
                    0.0,
                    tolerance=1e-9,
                    relative=False,
                    source="least over largest singular value, each row and column over sqrt J, "
                    "times the stiffest over the mode's own",
                    reason="an eigenvalue makes it singular; ten digits of each are asked for",
                    measure="identity",
                )
            )
            undamped = natural_modes(system).frequencies
            first = modal_damping(system)
            moving = np.flatnonzero(undamped > 0)
            for m, value, f in zip(moving, found.ratios, found.frequencies, strict=True):
                if state == "free" and undamped[m] > LOW:
                    continue
                rows.append(
                    [name, state, float(undamped[m]), float(f), float(value), float(first[m])]
                )
    # springs in series wind in proportion to their compliance, and each takes its damper along
    grounded = stage_masses(table, "free")
    k_each = grounded.k
    c_each = np.array([e.damping for e in grounded.elements])
    together = 1 / np.sum(1 / k_each)
    wound = float(together**2 * np.sum(c_each / k_each**2))
    in_series = models["free"]["2 masses, as tabled"]
    by_winding = damped_modes(damped(in_series, {"shafts": wound})).ratios[0]
    of_five = damped_modes(models["free"]["5 masses, as tabled"]).ratios[0]
    gearbox = float(np.sum(grounded.J[1:-1]) / grounded.J[-1])
    verdicts.append(
        judge(
            "2 masses, generator free, damper K^2 sum(C_i / K_i^2): damping ratio against that of "
            "5 masses",
            float(by_winding),
            float(of_five),
            tolerance=2 * gearbox,
            source="5 masses, dampers as tabled",
            reason="the gearbox's masses, left out of the winding, are "
            f"{gearbox:.3f} of the generator's, and change the torque in a shaft by no more; "
            "dissipation goes with its square",
            measure="frequency",
        )
    )
    # the quartic of two masses
    system = models["fixed"]["2 masses, as meant"]
    (a, b), (k, g) = system.J, system.k
    c = float(system.C[0, 0])
    quartic: Any = np.polysub(np.polymul([a, c, k], [b, c, k + g]), np.polymul([c, k], [c, k]))
    roots = np.roots(quartic)
    roots = np.sort_complex(roots[roots.imag > 0])
    roots = roots[np.argsort(roots.imag)]
    for m, (value, root) in enumerate(
        zip(damped_modes(system).eigenvalues, roots, strict=True), start=1
    ):
        verdicts.append(
            judge(
                f"2 masses, as meant, generator fixed: decay of mode {m}",
                float(-value.real),
                float(-root.real),
                tolerance=1e-8,
                unit="1/s",
                source="roots of the characteristic quartic",
                reason="exact; decay is a hundredth of the frequency, and the roots have some "
                "twelve digits of that",
                measure="frequency",
            )
        )
    eleven = models["fixed"]["11 masses, as tabled"]
    stiffness = planetary.ring_planet + planetary.sun_planet
    damper = planetary.ring_planet_damping + planetary.sun_planet_damping
    pair = damper / (2 * np.sqrt(stiffness * planetary.planet))
    ratios = damped_modes(eleven).ratios
    closest = float(ratios[np.abs(ratios - pair).argmin()])
    verdicts.append(
        judge(
            "11 masses, as tabled: damping ratio of planets against each other",
            closest,
            float(pair),
            tolerance=1e-9,
            source="(C_RP + C_SP) / 2 sqrt((K_RP + K_SP) J_P)",
            reason="a single oscillator: exact but for rounding",
            measure="frequency",
        )
    )
    # one period of free decay, integrated exactly
    with run.step("decay in time"):
        five = models["free"]["5 masses, as meant"]
        value = damped_modes(five).eigenvalues[0]
        kept = _kept_after_a_period(five, value, np, expm)
        verdicts.append(
            judge(
                "5 masses, as meant, generator free: share of the swing's energy kept after one "
                "period",
                kept,
                float(np.exp(4 * np.pi * value.real / value.imag)),
                tolerance=1e-8,
                source="exponential of the state matrix over one period, from the mode's shape",
                reason="exact but for the exponential's rounding: the fastest mode turns 670 times",
                measure="energy",
            )
        )
    with run.step("frequency response"):
        grid = np.geomspace(0.1, 1e4, QUICK_POINTS if run.quick else POINTS)
        curves, twos = [], []
        for name, system in models["fixed"].items():
            peaks = damped_modes(system).frequencies
            x = np.unique(np.concatenate([grid, peaks]))
            turned = response(system, ROTOR, x)[:, system.place(GENERATOR)]
            scale = speeds[-1] if name.startswith(("2", "5")) else 1.0
            amplitude = np.abs(turned) * 2 * np.pi * x * scale
            curves.append((name, x, amplitude))
            if name == "2 masses, as meant":
                s = 2j * np.pi * x
                det = np.polyval(quartic, s)
                exact = (c * s + k) / det
                twos.append(float(np.abs(turned / exact - 1).max()))
        verdicts.append(
            judge(
                "2 masses, as meant: largest relative distance of the response at the generator "
                "from Cramer's rule",
                twos[0],
                0.0,
                tolerance=1e-9,
                relative=False,
                source="transfer function (C s + K) / quartic",
                reason="exact but for rounding; at resonance the quartic cancels to a hundredth",
                measure="identity",
            )
        )
    tabled_two = damped_modes(models["free"]["2 masses, as tabled"]).ratios[0]
    lss = behind[0]
    hss = behind[-1]
    return CASE.results(
        run,
        summary=[
            f"The shaft dampers of Table 4.2 damp the drivetrain's swing by {tabled_two:.1g} of "
            f"critical damping, not by the {SHAFT_RATIO:g} that the text asks for: Eq 4.5 was "
            "evaluated with J as the shaft's second moment of area [m^4] where it needs an inertia "
            "[kg m^2].",
            f"That gives away the shafts: C_LSS = {lss[2]:g} N m s/rad is a J of {lss[3]:.3e} m^4, "
            f"a solid shaft of {lss[4]:.3f} m and, with G = 80 GPa, {lss[5]:.2f} m length.",
            "With inertias in Eq 4.5 two free masses are damped by "
            f"{damped_modes(swinging).ratios[0]:.4f}, the first mode of five by "
            f"{damped_modes(models['free']['5 masses, as meant']).ratios[0]:.4f} and of eleven by "
            f"{damped_modes(models['free']['11 masses, as meant']).ratios[0]:.4f}.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="The dampers of Table 4.2",
                items=[
                    Table(
                        caption="J of Eq 4.5, (C / 2 zeta)^2 / k with zeta = 0.006, and the solid "
                        "shaft of that second moment of area, with G = 80 GPa",
                        columns=[
                            "shaft",
                            "k [N m/rad]",
                            "C [N m s/rad]",
                            "J [m^4]",
                            "diameter [m]",
                            "length G J / k [m]",
                        ],
                        rows=behind,
                    ),
                    Text(
                        text="Three shafts come out as shafts. The high-speed one would be "
                        f"{hss[4]:.2f} m thick and {hss[5]:,.0f} m long; with a damper of a "
                        f"hundredth, {hss[2] / 100:g}, it would be {hss[4] / 10:.3f} m and "
                        f"{hss[5] / 1e4:.2f} m. In kg m^2 that of the low-speed shaft would be a "
                        "hundredth of the least gear's."
                    ),
                    Table(
                        caption="Mesh dampers [N m s/rad] about the planet's and gear's axis: as "
                        "tabled, and 2 zeta sqrt(k J) with zeta = 0.1 and J what the two gears "
                        "oppose to each other",
                        columns=["mesh", "k [N m/rad]", "Table 4.2", "computed", "ratio"],
                        rows=mesh_rows,
                    ),
                    Text(
                        text="Eq 4.30 adds dampers as if they stood in series alone. Beside "
                        "springs they do not: in a slow swing each shaft winds by its own share of "
                        "the torque, so that C = K^2 sum(C_i / K_i^2) dissipates what all of them "
                        f"do: {wound:.3g} N m s/rad here where Eq 4.30 has "
                        f"{in_series.elements[0].damping:.3g}, a ratio of {by_winding:.3g} (five "
                        f"masses: {of_five:.3g}) instead of {tabled_two:.3g}."
                    ),
                    Text(
                        text="Eq 4.7 cannot be evaluated as printed: the thesis gives no base "
                        "radii, and its r_1^2 r_2^2 J_1 J_2 / (r_1^2 J_1 + r_2^2 J_2) is a length "
                        "squared more than an inertia, in which each inertia has the other's "
                        "radius: with the driven gear held (J_2 infinite) it must leave J_1, and "
                        "does with r_1^2 J_2 + r_2^2 J_1 below. The tabled mesh dampers are of the "
                        "right size."
                    ),
                ],
            ),
            Section(
                title="Damped modes",
                items=[
                    chart(
                        "Generator's speed for a torque of 1 N m on the rotor, generator fixed: "
                        "two, five and eleven masses with dampers as meant",
                        [trace(n, x, y) for n, x, y in curves if "meant" in n],
                        "frequency [Hz]",
                        "speed per torque [rad/s / (N m)]",
                        logarithmic=("x", "y"),
                    ),
                    chart(
                        "The same of eleven masses with dampers as tabled and as meant: the tabled "
                        "ones leave the two lowest modes all but undamped",
                        [trace(n, x, y) for n, x, y in curves if "11" in n],
                        "frequency [Hz]",
                        "speed per torque [rad/s / (N m)]",
                        logarithmic=("x", "y"),
                    ),
                    Table(
                        caption="Damping ratios: exact eigenvalues, and to first order, "
                        f"phi^T C phi / 2 omega; above {LOW:g} Hz the free generator's are the "
                        "same",
                        columns=[
                            "model",
                            "generator",
                            "undamped [Hz]",
                            "damped [Hz]",
                            "damping ratio",
                            "to first order",
                        ],
                        rows=rows,
                    ),
                ],
            ),
        ],
        assumptions=[
            AssumptionRow(
                name="J of Eq 4.5",
                value="J_a J_b / (J_a + J_b) of all before and all behind the shaft",
                unit="kg m^2",
                source="makes the ratio that of the drivetrain's own swing; the thesis gives none",
            ),
            AssumptionRow(
                name="damping of the generator's field",
                value=0.0,
                unit="N m s/rad",
                source="C_5 of Eq 4.35 has no value in the thesis",
            ),
            AssumptionRow(name="G", value=SHEAR_MODULUS, unit="Pa", source="steel; not given"),
        ],
        figures={
            "tabled_two_masses": float(tabled_two),
            "low_speed_shaft_polar": lss[3],
            "low_speed_shaft_length": lss[5],
        },
    )


def _residual(system: Any, value: complex, np: Any) -> float:
    """How far lambda^2 M + lambda C + K is from singular, as a relative error of lambda^2."""
    root = np.sqrt(system.J)
    scaled = np.outer(root, root)
    matrix = value**2 * np.eye(len(root)) + (value * system.C + system.K) / scaled
    return float(np.linalg.svd(matrix, compute_uv=False)[-1] / abs(value) ** 2)


def _kept_after_a_period(system: Any, value: complex, np: Any, expm: Any) -> float:
    """Energy of winding and turning after a period over that before, from a mode's own motion."""
    n = len(system.J)
    M, C, K = system.M, system.C, system.K
    matrix = value**2 * M + value * C + K
    shape = np.linalg.svd(matrix / np.outer(system.J, np.ones(n)))[2][-1].conj()
    state = np.concatenate([shape, value * shape]).real
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-K / system.J[:, None], -C / system.J[:, None]]])
    later = expm(A * (2 * np.pi / value.imag)) @ state

    def energy(x: Any) -> float:
        return float(x[:n] @ K @ x[:n] + x[n:] @ M @ x[n:])

    return energy(later) / energy(state)


CASE = Case(
    name="drivetrain/damping",
    title="NREL 750 kW drivetrain with damping: tabled dampers and damping ratios",
    source="Al-Hamadani 2018, Eq 4.5, 4.7, 4.18-4.22 and 4.30, Table 4.2",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
